//! Binary records: numbers at offsets, errors with the offset.

use super::RecordError;

/// The bytes and the caller's name for them.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    source_name: &'a str,
    bytes: &'a [u8],
}

/// Which byte of a number stands first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// The most significant.
    Big,
    /// The least significant.
    Little,
}

impl<'a> Bytes<'a> {
    pub fn new(source_name: &'a str, bytes: &'a [u8]) -> Self {
        Self { source_name, bytes }
    }

    /// All of them.
    pub fn all(&self) -> &'a [u8] {
        self.bytes
    }

    /// An error at an offset.
    pub fn error(&self, offset: usize, expected: impl Into<String>, found: &str) -> RecordError {
        RecordError {
            source_name: self.source_name.to_owned(),
            line: 1,
            column: 1,
            offset: Some(offset),
            expected: expected.into(),
            found: found.chars().take(40).collect(),
        }
    }
}

/// `N` bytes at an offset, the least significant first; `None` past the end.
fn array<const N: usize>(bytes: &[u8], at: usize, order: Order) -> Option<[u8; N]> {
    let mut array: [u8; N] = bytes.get(at..at.checked_add(N)?)?.try_into().ok()?;
    if order == Order::Big {
        array.reverse();
    }
    Some(array)
}

/// A number of 8 bits at an offset, if it is there.
pub(super) fn u8_at(bytes: &[u8], at: usize) -> Option<u8> {
    bytes.get(at).copied()
}

/// A number of 16 bits.
pub(super) fn u16_at(bytes: &[u8], at: usize, order: Order) -> Option<u16> {
    array(bytes, at, order).map(u16::from_le_bytes)
}

/// A number of 16 bits with sign.
pub(super) fn i16_at(bytes: &[u8], at: usize, order: Order) -> Option<i16> {
    array(bytes, at, order).map(i16::from_le_bytes)
}

/// A number of 32 bits.
pub(super) fn u32_at(bytes: &[u8], at: usize, order: Order) -> Option<u32> {
    array(bytes, at, order).map(u32::from_le_bytes)
}

/// A number of 32 bits with sign.
pub(super) fn i32_at(bytes: &[u8], at: usize, order: Order) -> Option<i32> {
    array(bytes, at, order).map(i32::from_le_bytes)
}

/// A number of 32 bits with a point.
pub(super) fn f32_at(bytes: &[u8], at: usize, order: Order) -> Option<f32> {
    array(bytes, at, order).map(f32::from_le_bytes)
}

/// A number of 64 bits with a point.
pub(super) fn f64_at(bytes: &[u8], at: usize, order: Order) -> Option<f64> {
    array(bytes, at, order).map(f64::from_le_bytes)
}

/// The number as it is written in decimals: 0.01 for the 32 bits nearest to it.
pub(super) fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

/// Text padded with blanks or ended by a NUL; `None` where there is none. Bytes that are no ASCII
/// are replaced.
pub(super) fn text_at(bytes: &[u8], at: usize, length: usize) -> Option<String> {
    let bytes = bytes.get(at..at.checked_add(length)?)?;
    let text = bytes.split(|&b| b == 0).next()?.trim_ascii();
    let printable = |&b: &u8| if (b' '..0x7F).contains(&b) { char::from(b) } else { '\u{FFFD}' };
    (!text.is_empty()).then(|| text.iter().map(printable).collect())
}
