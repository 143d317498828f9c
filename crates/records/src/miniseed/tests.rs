use super::decode::differences;
use super::nanoseconds;
use crate::bytes::Order;
use crate::{Options, Record, RecordError, Units, read};
use slipstick_dynamics::notice::NoticeKind;

/// A frame of 16 words: the first from codes of two bits, the others as given.
fn frame(codes: &[u32], words: &[u32], order: Order) -> Vec<u8> {
    let control = codes.iter().enumerate().fold(0, |c, (i, code)| c | code << (28 - 2 * i));
    let mut all = vec![control];
    all.extend(words);
    all.resize(16, 0);
    all.iter()
        .flat_map(|word| match order {
            Order::Big => word.to_be_bytes(),
            Order::Little => word.to_le_bytes(),
        })
        .collect()
}

/// By hand: from 100, differences of four bytes, two halves and one word; the first one is of the
/// record before and leads nowhere.
#[test]
fn steim1_by_hand() {
    let words = [100, (-30_000_i32).cast_unsigned(), 0x7F01_FF80, 0x0100_FF00, 0xFFFF_8A3A];
    let data = frame(&[0, 0, 1, 2, 3], &words, Order::Big);
    // 127 (unused), +1, −1, −128; +256, −256; −30150.
    let expected = vec![100.0, 101.0, 100.0, -28.0, 228.0, -28.0, -30_178.0];
    let fault = differences(&data, 7, false, Order::Big).unwrap_err();
    assert_eq!((fault.at, fault.found.as_str()), (8, "-30178"));
    let words = [100, (-30_178_i32).cast_unsigned(), 0x7F01_FF80, 0x0100_FF00, 0xFFFF_8A3A];
    let data = frame(&[0, 0, 1, 2, 3], &words, Order::Big);
    assert_eq!(differences(&data, 7, false, Order::Big), Ok(expected));
    let fault = differences(&data, 8, false, Order::Big).unwrap_err();
    assert_eq!(fault.found, "differences for 7");
}

/// By hand: every division that Steim 2 knows, with the largest and least of each.
#[test]
fn steim2_by_hand() {
    let ones = u32::MAX;
    let words = [
        (-7_i32).cast_unsigned(),
        0,
        // 4 of 8 bits: 0 (unused), 127, -128, -1.
        0x007F_80FF,
        // 1 of 30: -1.
        1 << 30 | ones >> 2,
        // 2 of 15: 16383, -16384.
        2 << 30 | 0x3FFF << 15 | 0x4000,
        // 3 of 10: 511, -512, -1.
        3 << 30 | 0x1FF << 20 | 0x200 << 10 | 0x3FF,
        // 5 of 6: 31, -32, 0, 0, 1.
        0x1F << 24 | 0x20 << 18 | 1,
        // 6 of 5: 15, -16, 0, 0, 0, 2.
        1 << 30 | 0xF << 25 | 0x10 << 20 | 2,
        // 7 of 4: 7, -8, 0, 0, 0, 0, 3.
        2 << 30 | 7 << 24 | 8 << 20 | 3,
    ];
    let steps = [
        0, 127, -128, -1, -1, 16_383, -16_384, 511, -512, -1, 31, -32, 0, 0, 1, 15, -16, 0, 0, 0,
        2, 7, -8, 0, 0, 0, 0, 3,
    ];
    let mut sample = -7_i32;
    let expected: Vec<f64> = steps
        .iter()
        .map(|step| {
            sample += step;
            f64::from(sample)
        })
        .collect();
    let codes = [0, 0, 1, 2, 2, 2, 3, 3, 3];
    for order in [Order::Big, Order::Little] {
        let mut words = words;
        words[1] = sample.cast_unsigned();
        let mut data = frame(&codes, &words, order);
        if order == Order::Little {
            // Bytes stand as they come, in either order.
            data[12..16].reverse();
        }
        assert_eq!(differences(&data, 28, true, order), Ok(expected.clone()));
        words[1] = words[1].wrapping_add(1000);
        let data = frame(&codes, &words, order);
        assert_eq!(differences(&data, 28, true, order).unwrap_err().at, 8);
        // A division that is none.
        words[3] &= ones >> 2;
        let data = frame(&codes, &words, order);
        assert_eq!(differences(&data, 28, true, order).unwrap_err().at, 16);
    }
    assert!(differences(&[0; 63], 1, true, Order::Big).is_err());
    assert!(differences(&[0; 64], usize::MAX, true, Order::Big).is_err());
}

#[test]
fn start_times_are_read() {
    let at = |year, day, hour| nanoseconds(year, day, [hour, 0, 0], 5);
    assert_eq!(at(1970, 1, 0), Some(5));
    // `date -u -d 2000-03-01 +%s`; 2000 was a leap year, 1900 was none.
    assert_eq!(at(2000, 61, 0), Some(951_868_800_000_000_005));
    assert_eq!(at(1900, 60, 0), Some(-2_203_891_200_000_000_000 + 5));
    assert_eq!(at(2024, 366, 12), Some(1_735_646_400_000_000_005));
    assert_eq!((at(1899, 1, 0), at(2000, 0, 0), at(2000, 1, 24)), (None, None, None));
}

/// A record of 256 bytes with 16-bit samples.
fn record(start: u16, samples: &[i16], year: u16, rate: [i16; 2]) -> Vec<u8> {
    let mut bytes = b"000001D XXXX 00HNEXX".to_vec();
    bytes.extend(year.to_be_bytes());
    bytes.extend([0, 1, 0, 0, 0, 0]);
    bytes.extend(start.to_be_bytes());
    bytes.extend((samples.len() as u16).to_be_bytes());
    bytes.extend(rate.iter().flat_map(|r| r.to_be_bytes()));
    bytes.extend([0, 0, 0, 1, 0, 0, 0, 0, 0, 64, 0, 48]);
    bytes.extend([0x03, 0xE8, 0, 0, 1, 1, 8, 0]);
    bytes.resize(64, 0);
    bytes.extend(samples.iter().flat_map(|s| s.to_be_bytes()));
    bytes.resize(256, 0);
    bytes
}

fn counts(bytes: &[u8]) -> Result<Record, RecordError> {
    read("f", bytes, &Options::default())
}

#[test]
fn sample_rates_are_read() {
    for (rate, dt_s) in [
        ([100, 1], 0.01),
        ([50, 2], 0.01),
        ([32_760, -819], 0.025),
        ([-10, 1], 10.0),
        ([-5, -2], 10.0),
        ([-5, 20], 0.25),
    ] {
        let record = counts(&record(0, &[1, 2, 3], 2000, rate)).unwrap();
        assert_eq!(record.channels[0].sampling, crate::Sampling::Dt(dt_s), "{rate:?}");
    }
    let error = counts(&record(0, &[1, 2, 3], 2000, [0, 1])).unwrap_err().to_string();
    assert_eq!(
        error,
        "f, byte 0: expected samples coded as numbers, found \"16-bit integers in XX.XXXX.00.HNE, left \""
    );
}

/// Records at 100 Hz of three samples each: 0.0001 s is the unit of their times.
#[test]
fn gaps_overlaps_order_and_repetitions() {
    let at = |start, samples: [i16; 3]| record(start, &samples, 2000, [100, 1]);
    let join = |records: &[Vec<u8>]| counts(&records.concat()).unwrap();
    let kinds = |record: &Record, i: usize| -> Vec<&str> {
        record.channels[i].warnings.iter().map(|w| w.kind.name()).collect()
    };
    let [a, b, c] = [at(0, [0, 1, 2]), at(300, [3, 4, 5]), at(600, [6, 7, 0])];
    let whole = join(&[a.clone(), b.clone(), c.clone()]);
    assert_eq!(whole.channels.len(), 1);
    assert_eq!(whole.channels[0].values, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 0.0]);
    assert_eq!(whole.channels[0].name, "XX.XXXX.00.HNE");
    assert_eq!(kinds(&whole, 0), Vec::<&str>::new());
    // Half a step late is no gap, more is one.
    assert_eq!(join(&[a.clone(), at(350, [3, 4, 5])]).channels.len(), 1);
    let gap = join(&[a.clone(), at(351, [3, 4, 5])]);
    assert_eq!((kinds(&gap, 0), kinds(&gap, 1)), (vec!["gap", "gap"], vec!["gap"]));
    assert_eq!(gap.channels[1].name, "XX.XXXX.00.HNE 2");
    assert_eq!(gap.channels[0].warnings[0].message, "after its 3 samples a gap of 0.005100 s");
    let overlap = join(&[a.clone(), at(200, [3, 4, 5])]);
    assert_eq!(kinds(&overlap, 0), ["overlap", "gap"]);
    let sorted = join(&[b.clone(), c.clone(), a.clone()]);
    assert_eq!(sorted.channels[0].values, whole.channels[0].values);
    assert_eq!(kinds(&sorted, 0), ["records_sorted"]);
    let twice = join(&[a.clone(), b.clone(), b.clone(), c.clone()]);
    assert_eq!(twice.channels[0].values, whole.channels[0].values);
    assert_eq!(kinds(&twice, 0), ["duplicate_records"]);
    // Each 0.4 steps late: no gap anywhere, but more than half a step in all.
    let late = join(&[a.clone(), at(340, [3, 4, 5]), at(680, [6, 7, 0])]);
    assert_eq!((late.channels.len(), kinds(&late, 0)), (1, vec!["clock_drift"]));
    // A record that is cut is left out, and blanks after the last are none.
    let mut cut = [a.clone(), b.clone()].concat();
    cut.truncate(400);
    let cut = counts(&cut).unwrap();
    assert_eq!((cut.channels[0].values.len(), cut.warnings[0].kind), (3, NoticeKind::Truncated));
    assert!(counts(&[a.clone(), vec![b' '; 256]].concat()).unwrap().warnings.is_empty());
    let garbage = counts(&[a.clone(), vec![b'x'; 256]].concat()).unwrap_err().to_string();
    assert_eq!(garbage, "f, byte 256: expected a MiniSEED data record, found \"xxxxxxxx\"");
}

#[test]
fn what_a_record_must_have() {
    let bytes = record(0, &[1, 2, 3], 2000, [100, 1]);
    let changed = |at: usize, byte: u8| {
        let mut bytes = bytes.clone();
        bytes[at] = byte;
        counts(&bytes).map(|r| r.channels[0].values.len()).map_err(|e| e.to_string())
    };
    assert_eq!(changed(0, b'0'), Ok(3));
    for (at, byte, expected) in [
        (
            52,
            16,
            "f, byte 0: expected samples coded as numbers, found \"CDSN, gain ranged in XX.XXXX.00.HNE, lef\"",
        ),
        (
            52,
            0,
            "f, byte 0: expected samples coded as numbers, found \"ASCII text in XX.XXXX.00.HNE, left out\"",
        ),
        (
            53,
            7,
            "f, byte 53: expected a byte order of 0 or 1 and a record of 2^7 to 2^20 bytes, found \"7, 2^8\"",
        ),
        (
            54,
            255,
            "f, byte 53: expected a byte order of 0 or 1 and a record of 2^7 to 2^20 bytes, found \"1, 2^255\"",
        ),
        (54, 9, "f, byte 256: expected the whole of the first record, found \"256 bytes\""),
        (
            49,
            1,
            "f, byte 46: expected blockette 1000, which states encoding and length, found \"none (SEED before 2.3)\"",
        ),
        (
            51,
            20,
            "f, byte 20: expected the next blockette at byte 52 of the record or later, found \"20\"",
        ),
        (30, 9, "f, byte 64: expected 2307 samples in the record at byte 0, found \"room for 96\""),
        (
            45,
            7,
            "f, byte 44: expected samples that begin at byte 48 to 256 of the record, found \"7\"",
        ),
    ] {
        assert_eq!(changed(at, byte), Err(expected.to_owned()), "{at}");
    }
    let volume = counts(b"000001V 010009402.3121970,001,00:00:00.0000~").unwrap_err().to_string();
    assert!(volume.contains("a control header of a SEED volume"), "{volume}");
}

/// Counts become what the caller says one is; a different step is refused.
#[test]
fn counts_and_their_value() {
    let bytes = record(0, &[0, -200, 50], 2000, [100, 1]);
    let record = counts(&bytes).unwrap();
    assert_eq!(record.describe(&record.channels[0]), "MiniSEED 2, 3 values, 0.01 s, counts");
    assert!(record.channels[0].motion().is_none());
    let units = Units::parse("1.5e-3 m/s2");
    let options = Options { units, ..Options::default() };
    let record = read("f", &bytes, &options).unwrap();
    assert_eq!(record.channels[0].values, [0.0, -200.0 * 1.5e-3, 50.0 * 1.5e-3]);
    assert_eq!(record.describe(&record.channels[0]), "MiniSEED 2, 3 values, 0.01 s, 0.0015 m/s²");
    let error = read("f", &bytes, &Options { dt_s: Some(0.02), ..options }).unwrap_err();
    assert!(error.to_string().contains("the time step given, 0.02 s (leave it out)"), "{error}");
}
