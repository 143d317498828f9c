//! What names a text or a file by its content.

use sha2::{Digest, Sha256};

/// SHA-256 of some bytes in hexadecimal digits.
///
/// # Examples
/// ```
/// // FIPS 180-4, example of one block.
/// let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
/// assert_eq!(slipstick::hash::sha256_hex(b"abc"), expected);
/// ```
#[must_use]
pub fn sha256_hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
