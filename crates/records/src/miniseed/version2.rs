//! Headers of data records of SEED 2.

use super::decode::Encoding;
use super::{DataRecord, nanoseconds};
use crate::bytes::{Bytes, Order, decimal, f32_at, i16_at, i32_at, text_at, u8_at, u16_at};
use slipstick_dynamics::error::RecordError;

/// Bytes of the fixed part.
const FIXED: usize = 48;

/// Six digits or blanks, the letter of a data record, a blank, and a time of day.
pub(super) fn is_record(bytes: &[u8]) -> bool {
    let Some(fixed) = bytes.get(..28) else { return false };
    let number = fixed[..6].iter().all(|b| b.is_ascii_digit() || matches!(b, b' ' | 0));
    number
        && matches!(fixed[6], b'D' | b'R' | b'Q' | b'M')
        && matches!(fixed[7], b' ' | 0)
        && fixed[24] < 24
        && fixed[25] < 60
        && fixed[26] <= 60
}

/// The control header of a whole SEED volume.
pub(super) fn is_volume(bytes: &[u8]) -> bool {
    let Some(start) = bytes.get(..11) else { return false };
    start[..6].iter().all(u8::is_ascii_digit)
        && matches!(start[6], b'V' | b'A' | b'S' | b'T')
        && matches!(start[7], b' ' | b'*')
        && start[8..].iter().all(u8::is_ascii_digit)
}

/// The header of the record that begins at an offset; `None` where the file ends within it.
pub(super) fn header(bytes: &Bytes, offset: usize) -> Result<Option<DataRecord>, RecordError> {
    let rest = &bytes.all()[offset..];
    if is_volume(rest) {
        let found = "a control header of a SEED volume (extract its data records)";
        return Err(bytes.error(offset, "a MiniSEED data record", found));
    }
    if !is_record(rest) {
        let found: String = rest.iter().take(8).map(|b| b.escape_ascii().to_string()).collect();
        return Err(bytes.error(offset, "a MiniSEED data record", &found));
    }
    read(bytes, offset, rest)
}

fn read(bytes: &Bytes, offset: usize, rest: &[u8]) -> Result<Option<DataRecord>, RecordError> {
    let year = |order| u16_at(rest, 20, order).filter(|year| (1900..=2100).contains(year));
    let order = if year(Order::Big).is_some() { Order::Big } else { Order::Little };
    let short = |at: usize| u16_at(rest, at, order).map(usize::from);
    let (Some(year), Some(day), Some(ticks)) =
        (year(order), u16_at(rest, 22, order), u16_at(rest, 28, order))
    else {
        return Err(bytes.error(offset + 20, "a year from 1900 to 2100", "another"));
    };
    let (Some(count), Some(data_at), Some(first_blockette)) = (short(30), short(44), short(46))
    else {
        return Ok(None);
    };
    let blockettes = match Blockettes::read(bytes, offset, rest, order, first_blockette)? {
        Some(blockettes) => blockettes,
        None => return Ok(None),
    };
    let length = blockettes.length;
    if count > 0 && !(FIXED..length).contains(&data_at) {
        let expected = format!("samples that begin at byte {FIXED} to {length} of the record");
        return Err(bytes.error(offset + 44, expected, &data_at.to_string()));
    }
    // The correction counts where it has not been made already.
    let made = rest[36] & 2 != 0;
    let correction = i32_at(rest, 40, order).filter(|_| !made).unwrap_or(0);
    let rest_ns = 100_000 * (i64::from(ticks) + i64::from(correction))
        + 1_000 * i64::from(blockettes.microseconds);
    let time = [rest[24], rest[25], rest[26]];
    let Some(start_ns) = nanoseconds(year, day, time, rest_ns) else {
        return Err(bytes.error(offset + 20, "a time", &format!("{year}, day {day}")));
    };
    let text = |at, length| text_at(rest, at, length).unwrap_or_default();
    let id = [text(18, 2), text(8, 5), text(13, 2), text(15, 3)].join(".");
    let data_end = offset + length;
    Ok(Some(DataRecord {
        offset,
        length,
        id,
        start_ns,
        dt_s: step(rest, order, blockettes.rate_hz),
        count,
        encoding: Encoding { code: blockettes.encoding, order: blockettes.order },
        data: (offset + data_at).min(data_end)..data_end,
        // Bit 0, saturated amplifier; bit 1, digitiser clipping.
        clipped: rest[38] & 3 != 0,
    }))
}

/// Step in s of the rate's factor and multiplier, each a division where negative; the rate of
/// blockette 100 is the same or better known.
fn step(rest: &[u8], order: Order, rate_hz: Option<f32>) -> Option<f64> {
    let factor = f64::from(i16_at(rest, 32, order)?);
    let multiplier = f64::from(i16_at(rest, 34, order)?);
    let (up, down) = match (factor > 0.0, multiplier > 0.0) {
        (true, true) => (1.0, factor * multiplier),
        (true, false) => (-multiplier, factor),
        (false, true) => (-factor, multiplier),
        (false, false) => (factor * multiplier, 1.0),
    };
    let nominal_s = (factor != 0.0 && multiplier != 0.0).then_some(up / down);
    let actual_hz = rate_hz.filter(|hz| hz.is_finite() && *hz > 0.0);
    match (nominal_s, actual_hz) {
        (Some(dt_s), Some(hz)) if (dt_s * f64::from(hz) - 1.0).abs() < 1e-6 => Some(dt_s),
        (Some(_), Some(hz)) => Some(1.0 / decimal(hz)),
        (nominal_s, _) => nominal_s,
    }
}

/// What the blockettes after the fixed header say.
struct Blockettes {
    encoding: u8,
    order: Order,
    length: usize,
    microseconds: i8,
    rate_hz: Option<f32>,
}

impl Blockettes {
    /// `None` where the file ends within them.
    fn read(
        bytes: &Bytes,
        offset: usize,
        rest: &[u8],
        order: Order,
        first: usize,
    ) -> Result<Option<Self>, RecordError> {
        let mut at = first;
        let (mut coding, mut microseconds, mut rate_hz) = (None, 0, None);
        let mut passed = FIXED;
        while at != 0 {
            if at < passed {
                let expected =
                    format!("the next blockette at byte {passed} of the record or later");
                return Err(bytes.error(offset + at, expected, &at.to_string()));
            }
            let (Some(kind), Some(next)) = (u16_at(rest, at, order), u16_at(rest, at + 2, order))
            else {
                return Ok(None);
            };
            match kind {
                1000 => {
                    let fields = (u8_at(rest, at + 4), u8_at(rest, at + 5), u8_at(rest, at + 6));
                    let (Some(code), Some(word_order), Some(exponent)) = fields else {
                        return Ok(None);
                    };
                    if !(7..=20).contains(&exponent) || word_order > 1 {
                        let expected = "a byte order of 0 or 1 and a record of 2^7 to 2^20 bytes";
                        let found = format!("{word_order}, 2^{exponent}");
                        return Err(bytes.error(offset + at + 5, expected, &found));
                    }
                    let word_order = if word_order == 0 { Order::Little } else { Order::Big };
                    coding = Some((code, word_order, 1_usize << exponent));
                }
                1001 => microseconds = rest.get(at + 5).map_or(0, |&b| i8::from_le_bytes([b])),
                100 => rate_hz = f32_at(rest, at + 4, order),
                _ => (),
            }
            passed = at + 4;
            at = usize::from(next);
        }
        let Some((encoding, word_order, length)) = coding else {
            let expected = "blockette 1000, which states encoding and length";
            return Err(bytes.error(offset + 46, expected, "none (SEED before 2.3)"));
        };
        Ok(Some(Self { encoding, order: word_order, length, microseconds, rate_hz }))
    }
}
