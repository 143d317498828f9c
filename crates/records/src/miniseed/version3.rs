//! Headers of records of miniSEED 3: little-endian, with a sum over every byte.

use super::decode::{Encoding, STEIM1, STEIM2};
use super::{DataRecord, nanoseconds};
use crate::bytes::{Bytes, Order, f64_at, u8_at, u16_at, u32_at};
use slipstick_dynamics::error::RecordError;

/// Bytes of the fixed part.
const FIXED: usize = 40;
/// Where the sum stands.
const SUM: usize = 28;

/// Whether a record of version 3 begins here.
pub(super) fn is_record(bytes: &[u8]) -> bool {
    bytes.starts_with(b"MS\x03")
        && bytes.get(12).is_some_and(|&hour| hour < 24)
        && bytes.get(13).is_some_and(|&minute| minute < 60)
}

/// The header of the record that begins at an offset; `None` where the file ends within the record.
pub(super) fn header(bytes: &Bytes, offset: usize) -> Result<Option<DataRecord>, RecordError> {
    let rest = &bytes.all()[offset..];
    let order = Order::Little;
    let Some(fixed) = rest.get(..FIXED) else { return Ok(None) };
    let number = |at| u32_at(fixed, at, order).and_then(|n| usize::try_from(n).ok()).unwrap_or(0);
    let id_length = usize::from(fixed[33]);
    let extra = u16_at(fixed, 34, order).map_or(0, usize::from);
    let data_at = FIXED + id_length + extra;
    let length = data_at.saturating_add(number(36));
    let Some(record) = rest.get(..length) else { return Ok(None) };
    let stated = u32_at(fixed, SUM, order).unwrap_or(0);
    let found = castagnoli(record);
    if stated != found {
        let expected = format!("a record whose sum (CRC-32C) is {stated:08X}");
        return Err(bytes.error(offset, expected, &format!("{found:08X}")));
    }
    let time = [fixed[12], fixed[13], fixed[14]];
    let (year, day) = (u16_at(fixed, 8, order).unwrap_or(0), u16_at(fixed, 10, order).unwrap_or(0));
    let nanosecond = u32_at(fixed, 4, order).map_or(0, i64::from);
    let Some(start_ns) = nanoseconds(year, day, time, nanosecond) else {
        return Err(bytes.error(offset + 8, "a time", &format!("{year}, day {day}")));
    };
    let rate = f64_at(fixed, 16, order).filter(|rate| rate.is_finite() && *rate != 0.0);
    // A negative rate is a step in s.
    let dt_s = rate.map(|rate| if rate < 0.0 { -rate } else { 1.0 / rate });
    let code = u8_at(fixed, 15).unwrap_or(0);
    // The difference codings are big-endian always.
    let order = if matches!(code, STEIM1 | STEIM2) { Order::Big } else { Order::Little };
    let id = String::from_utf8_lossy(&record[FIXED..FIXED + id_length]).into_owned();
    Ok(Some(DataRecord {
        offset,
        length,
        id: short_id(&id),
        start_ns,
        dt_s: dt_s.filter(|dt_s| dt_s.is_finite()),
        count: number(24),
        encoding: Encoding { code, order },
        data: offset + data_at..offset + length,
        clipped: false,
    }))
}

/// `FDSN:NET_STA_LOC_B_S_S` as `NET.STA.LOC.BSS`; other identifiers as they are.
fn short_id(id: &str) -> String {
    let parts: Vec<&str> = id.strip_prefix("FDSN:").unwrap_or(id).split('_').collect();
    match parts.as_slice() {
        [network, station, location, band, source, position] => {
            format!("{network}.{station}.{location}.{band}{source}{position}")
        }
        _ => id.to_owned(),
    }
}

/// CRC-32C of a record with its own four bytes taken as zero.
fn castagnoli(record: &[u8]) -> u32 {
    let mut sum = u32::MAX;
    for (i, &byte) in record.iter().enumerate() {
        let byte = if (SUM..SUM + 4).contains(&i) { 0 } else { byte };
        sum = (sum >> 8) ^ TABLE[usize::from(sum.to_le_bytes()[0] ^ byte)];
    }
    !sum
}

/// Remainders of the reflected Castagnoli polynomial, one a byte.
const TABLE: [u32; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut remainder = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            let odd = remainder & 1 == 1;
            remainder >>= 1;
            if odd {
                remainder ^= 0x82F6_3B78;
            }
            bit += 1;
        }
        table[byte] = remainder;
        byte += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The check value of the polynomial's catalogue, over nine digits; four bytes that count as
    /// zero lie past them.
    #[test]
    fn check_value() {
        assert_eq!(castagnoli(b"123456789"), 0xE306_9283);
        let mut record = [7; 40];
        let sum = castagnoli(&record);
        record[SUM..SUM + 4].copy_from_slice(&sum.to_le_bytes());
        assert_eq!(castagnoli(&record), sum);
        record[5] = 6;
        assert_ne!(castagnoli(&record), sum);
    }

    #[test]
    fn source_identifiers_are_taken_apart() {
        assert_eq!(short_id("FDSN:CI_CLC__H_N_E"), "CI.CLC..HNE");
        assert_eq!(short_id("FDSN:XX_A_B"), "FDSN:XX_A_B");
    }
}
