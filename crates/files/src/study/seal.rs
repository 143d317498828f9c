//! A hash over every byte of a part, kept in the part itself.
//!
//! It is the SHA-256 of the file with zeros where the hash stands. So a part is judged by itself: a
//! study that was killed has no manifest yet.

use slipstick::hash::sha256_hex;

/// Key of the hash among the notes of a file.
pub(super) const SEAL_KEY: &str = "slipstick.sha256";

/// Number of hexadecimal digits of a hash.
const DIGITS: usize = 64;

/// What stands in the place of the hash while it is computed.
pub(super) fn blank() -> String {
    "0".repeat(DIGITS)
}

/// Writes the hash into a file that has zeros for it.
pub(super) fn seal(bytes: &mut [u8]) {
    if let Some(place) = place(bytes) {
        let hash = sha256_hex(bytes);
        bytes[place..place + DIGITS].copy_from_slice(hash.as_bytes());
    }
}

/// Whether a file is what it was when it was sealed.
pub(super) fn is_sealed(mut bytes: Vec<u8>) -> bool {
    let Some(place) = place(&bytes) else { return false };
    let stated = bytes[place..place + DIGITS].to_vec();
    bytes[place..place + DIGITS].fill(b'0');
    sha256_hex(&bytes).as_bytes() == stated
}

/// Where the hash starts: the notes stand at the end of the file, each value after its key, a byte
/// for its type and one for its length.
fn place(bytes: &[u8]) -> Option<usize> {
    let key = SEAL_KEY.as_bytes();
    let at = bytes.windows(key.len()).rposition(|window| window == key)?;
    let start = at + key.len() + 2;
    (start + DIGITS <= bytes.len()).then_some(start)
}
