//! Codings of samples: whole numbers, numbers with a point, and differences (Steim 1 and 2).

use super::DataRecord;
use crate::bytes::{Bytes, Order, f32_at, f64_at, i16_at, i32_at, u32_at};
use slipstick_dynamics::error::RecordError;

/// Codes of encodings in blockette 1000 and in version 3.
pub(super) const TEXT: u8 = 0;
const INT16: u8 = 1;
const INT32: u8 = 3;
const FLOAT32: u8 = 4;
const FLOAT64: u8 = 5;
pub(super) const STEIM1: u8 = 10;
pub(super) const STEIM2: u8 = 11;

/// How samples are coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Encoding {
    /// The code of the format.
    pub code: u8,
    /// Order of the bytes of each number or word.
    pub order: Order,
}

impl Encoding {
    /// Whether samples so coded are read.
    pub fn is_read(self) -> bool {
        matches!(self.code, INT16 | INT32 | FLOAT32 | FLOAT64 | STEIM1 | STEIM2)
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self.code {
            TEXT => "ASCII text",
            INT16 => "16-bit integers",
            2 => "24-bit integers",
            INT32 => "32-bit integers",
            FLOAT32 => "32-bit floats",
            FLOAT64 => "64-bit floats",
            STEIM1 => "Steim 1",
            STEIM2 => "Steim 2",
            12 => "GEOSCOPE, 24 bits",
            13 | 14 => "GEOSCOPE, gain ranged",
            16 => "CDSN, gain ranged",
            19 => "Steim 3",
            30 => "SRO, gain ranged",
            32 => "DWWSSN",
            _ => "an unknown encoding",
        }
    }
}

/// The samples of a record.
///
/// # Errors
/// Where its bytes hold fewer than its header says, one is not finite, or the last of a coding by
/// differences is not the one that the record states.
pub(super) fn samples(bytes: &Bytes, record: &DataRecord) -> Result<Vec<f64>, RecordError> {
    let data = bytes.all().get(record.data.clone()).unwrap_or_default();
    let Encoding { code, order } = record.encoding;
    if matches!(code, STEIM1 | STEIM2) {
        let found = differences(data, record.count, code == STEIM2, order);
        return found.map_err(|fault| {
            bytes.error(record.data.start + fault.at, fault.expected, &fault.found)
        });
    }
    let size = match code {
        INT16 => 2,
        FLOAT64 => 8,
        _ => 4,
    };
    if data.len() / size < record.count {
        let expected = format!("{} samples in the record at byte {}", record.count, record.offset);
        let found = format!("room for {}", data.len() / size);
        return Err(bytes.error(record.data.start, expected, &found));
    }
    let number = |i: usize| match code {
        INT16 => i16_at(data, i * size, order).map(f64::from),
        INT32 => i32_at(data, i * size, order).map(f64::from),
        FLOAT32 => f32_at(data, i * size, order).map(f64::from),
        _ => f64_at(data, i * size, order),
    };
    let values: Vec<f64> = (0..record.count).map_while(number).collect();
    match values.iter().position(|value| !value.is_finite()) {
        Some(i) => {
            let at = record.data.start + i * size;
            Err(bytes.error(at, "a finite number", &values[i].to_string()))
        }
        None => Ok(values),
    }
}

/// What is wrong with a block of differences, and at which of its bytes.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Fault {
    pub at: usize,
    pub expected: String,
    pub found: String,
}

/// Bytes of a frame: 16 words, of which the first says how the others are divided.
const FRAME: usize = 64;

/// Samples coded as differences. The first frame states the first sample and the last one.
pub(super) fn differences(
    data: &[u8],
    count: usize,
    second: bool,
    order: Order,
) -> Result<Vec<f64>, Fault> {
    let ends = i32_at(data, 4, order).zip(i32_at(data, 8, order));
    let Some((first, last)) = ends.filter(|_| data.len() >= FRAME) else {
        let found = format!("{} bytes", data.len());
        return Err(Fault { at: 0, expected: "a frame of 64 bytes".to_owned(), found });
    };
    // No word holds more than seven differences.
    let mut values = Vec::with_capacity(count.min(2 * data.len()));
    let mut sample = first;
    for (f, frame) in data.chunks_exact(FRAME).enumerate() {
        let control = u32_at(frame, 0, order).unwrap_or(0);
        let from = if f == 0 { 3 } else { 1 };
        for w in from..16 {
            let code = (control >> (30 - 2 * w)) & 3;
            let word = Word { bytes: &frame[4 * w..4 * w + 4], order };
            let Some(steps) = word.differences(code, second) else {
                let expected = "a word that Steim 2 knows".to_owned();
                let found = format!("code {code}");
                return Err(Fault { at: FRAME * f + 4 * w, expected, found });
            };
            for step in steps.as_slice() {
                if values.len() == count {
                    break;
                }
                // The first difference leads here from the record before.
                if !values.is_empty() {
                    sample = sample.wrapping_add(*step);
                }
                values.push(f64::from(sample));
            }
        }
        if values.len() == count {
            break;
        }
    }
    if values.len() < count {
        let expected = format!("{count} samples in the record");
        let found = format!("differences for {}", values.len());
        return Err(Fault { at: 0, expected, found });
    }
    if sample != last {
        let expected = format!("{last} as the last sample, which the record states");
        return Err(Fault { at: 8, expected, found: sample.to_string() });
    }
    Ok(values)
}

/// Differences of one word, seven at most.
struct Steps {
    values: [i32; 7],
    count: usize,
}

impl Steps {
    fn as_slice(&self) -> &[i32] {
        &self.values[..self.count]
    }
}

struct Word<'a> {
    bytes: &'a [u8],
    order: Order,
}

impl Word<'_> {
    /// What the word holds under its two bits of the frame's first word; `None` where Steim 2 has
    /// no such division.
    fn differences(&self, code: u32, second: bool) -> Option<Steps> {
        let mut values = [0; 7];
        let count = match (code, second) {
            (0, _) => 0,
            (1, _) => {
                for (value, &byte) in values.iter_mut().zip(self.bytes) {
                    *value = i32::from(i8::from_le_bytes([byte]));
                }
                4
            }
            (2, false) => {
                for (i, value) in values.iter_mut().take(2).enumerate() {
                    *value = i32::from(i16_at(self.bytes, 2 * i, self.order)?);
                }
                2
            }
            (3, false) => {
                values[0] = i32_at(self.bytes, 0, self.order)?;
                1
            }
            _ => {
                let word = u32_at(self.bytes, 0, self.order)?;
                let (count, bits) = match (code, word >> 30) {
                    (2, 1) => (1, 30),
                    (2, 2) => (2, 15),
                    (2, 3) => (3, 10),
                    (3, 0) => (5, 6),
                    (3, 1) => (6, 5),
                    (3, 2) => (7, 4),
                    _ => return None,
                };
                for (i, value) in values.iter_mut().take(count).enumerate() {
                    // To the top of the word and back, which carries the sign along.
                    let up = word << (32 - bits * (count - i));
                    *value = up.cast_signed() >> (32 - bits);
                }
                count
            }
        };
        Some(Steps { values, count })
    }
}
