//! What names a text or a file by its content.

use sha2::{Digest, Sha256};

use crate::motion::GroundMotion;

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

/// Digits of the short hashes by which answers name models and motions.
pub(crate) const SHORT: usize = 12;

/// SHA-256 of the times and accelerations of a motion, bit by bit, each component after its length.
#[must_use]
pub fn sha256_of_motion(motion: &GroundMotion) -> String {
    let lists = [
        motion.times_s(),
        motion.horizontal_m_per_s2(),
        motion.horizontal_y_m_per_s2().unwrap_or_default(),
        motion.vertical_m_per_s2().unwrap_or_default(),
    ];
    let numbers = lists.into_iter().flat_map(|list| {
        core::iter::once(list.len() as u64).chain(list.iter().map(|value| value.to_bits()))
    });
    let bytes: Vec<u8> = numbers.flat_map(u64::to_le_bytes).collect();
    sha256_hex(&bytes)
}

/// A short hash of a motion, by which an answer says what it is of: the first 12 digits of [`sha256_of_motion`].
///
/// # Examples
/// ```
/// use slipstick::hash::motion_hash;
/// use slipstick::motion::GroundMotion;
/// let motion = |last| GroundMotion::evenly_spaced(0.1, vec![0.0, 1.0, last], None);
/// let [one, same, other] = [0.0, 0.0, 1e-9].map(|last| motion_hash(&motion(last).expect("a motion")));
/// assert_eq!((one.len(), &one == &same, one == other), (12, true, false));
/// ```
#[must_use]
pub fn motion_hash(motion: &GroundMotion) -> String {
    let mut hash = sha256_of_motion(motion);
    hash.truncate(SHORT);
    hash
}
