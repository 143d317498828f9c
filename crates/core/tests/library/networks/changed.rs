//! Headers, digits and bytes that are changed, and files that are cut.

use std::fs;

use slipstick::notice::NoticeKind;
use slipstick::record::{self, Format, Options, Record};

use super::{NOTHING, ROWS, bytes, folder, given, kinds, samples};

/// A header that is changed is refused, or what was read is not as if it had not been.
#[test]
#[rustfmt::skip]
fn changed_headers_are_noticed() {
    let mut wrong = Vec::new();
    for (file, from, to, expected) in [
        ("knet.EW", "3920(gal)", "3920(cal)", "a scale factor such as 3920(gal)/6182761"),
        ("knet.EW", "3920(gal)/6182761", "3920(gal)/618276", "a peak of"),
        ("knet.EW", "0.48\n", "0.46\n", "7 values on this line"),
        ("knet.EW", "0.48\n", "0.50\n", "25 values, as line 12 says"),
        ("knet.EW", "0.48\n", "1e12\n", "a duration of 2 to 100 000 000 values"),
        ("knet.EW", "50Hz", "50kHz", "a sampling frequency such as 100Hz"),
        ("esm.ASC", "NDATA: 24", "NDATA: 23", "no more than 23 values, as line 30 says"),
        ("esm.ASC", "NDATA: 24", "NDATA: 25", "25 values, as line 30 says"),
        ("esm.ASC", "NDATA: 24", "NDATA: 1000000000000", "2 to 100 000 000"),
        ("esm.ASC", "UNITS: cm/s^2", "UNITS: mm/s^2", "a peak of"),
        ("esm.ASC", "UNITS: cm/s^2", "UNITS: cm/s", "\"velocity\", as the units say"),
        ("esm.ASC", "UNITS: cm/s^2", "UNITS: cn/s^2", "units of acceleration, velocity or displacement"),
        ("esm.ASC", "DATA_TYPE: ACCELERATION", "DATA_TYPE: PSEUDO-ACCELERATION SPECTRUM", "a time history"),
        ("afad.asc", "UNITS: cm/s^2", "UNITS: g", "a peak of"),
        ("itaca.acc", "in m/s/s", "in cm/s/s", "a peak of"),
        ("itaca.acc", "in m/s/s", "in m/s", "units of the quantity named on this line"),
        ("itaca.acc", "of Data                : 24", "of Data                : 23", "3 values on this line"),
        ("nsmn.txt", ": 24", ": 23", "no more than 69 values"),
        ("geonet.V1A", "1.00 mm/s/s", "2.00 mm/s/s", "a peak of"),
        ("geonet.V1A", "units of 1.00 mm", "units of 1.00 cm", "a peak of"),
        ("geonet.V1A", "points     24", "points     25", "the number of points that line 10"),
        ("geonet.V2A", "at 0.020 sec", "at 0.010 sec", "the step of 0.01 s that line 11 states"),
        ("unam.asa", "/24/24/24", "/24/27/24", "81 values, as line 72 says"),
        ("unam.asa", "/24/24/24", "/23/23/23", "no more than 23 values, as line 72 says"),
        ("unam.asa", "Gal (cm", "g (cm", "a peak of"),
        ("unam.asa", "/0.02/0.02/0.02", "/0.01/0.01/0.01", "the rate of a step of 0.01 s"),
        ("unam.asa", ": 3\r", ": 2\r", "as many channels as orientations, 3"),
        ("csmnc.dat", "POINTS:    24", "POINTS:    23", "7 values on this line"),
        ("csmnc.dat", "POINTS:    24", "POINTS:    32", "32 values, as line 12 says"),
        ("cwa.dat", "(Hz): 50", "(Hz): 25", "no more than 48 values"),
        ("cwa.dat", "U(+); N(+); E(+)", "U(+); N(-); E(+)", "columns such as"),
        ("cwa.dat", "(sec): 0.48", "(sec): 1e15", "a length of 2 to 100 000 000 values"),
        ("text.sac", "        24", "        23", "3 values on this line"),
    ] {
        let text = bytes(&samples(), file);
        let at = text.windows(from.len()).position(|w| w == from.as_bytes());
        let at = at.unwrap_or_else(|| panic!("{file}: {from}"));
        let changed = [&text[..at], to.as_bytes(), &text[at + from.len()..]].concat();
        let options = if file == "text.sac" { given("g") } else { NOTHING };
        match record::read(file, &changed, &options) {
            Err(error) if format!("{} {}", error.expected, error.found).contains(expected) => (),
            other => wrong.push(format!("{file} {to}: {:?}", other.err().map(|e| e.to_string()))),
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    // What the caller says of a file that says it itself.
    for file in ["esm.ASC", "knet.EW", "geonet.V2A", "unam.asa", "csmnc.dat", "cwa.dat", "nsmn.txt", "itaca.acc"] {
        let text = bytes(&samples(), file);
        let error = |options: &Options| record::read(file, &text, options).unwrap_err().expected;
        assert!(error(&given("ft/s2")).contains("(leave them out)"), "{file}");
        assert!(error(&Options { dt_s: Some(0.01), ..NOTHING }).contains("(leave it out)"), "{file}");
    }
}

/// A second count in a header that is not the number of values is said: integers of Caltech's volumes and
/// of COSMOS, lines above the count of PEER.
#[test]
fn second_counts_are_compared() {
    let integers = |text: &str, row: usize, place: usize, stated: &str| -> String {
        let full = |line: &str| {
            line.len() > 60 && line.bytes().all(|b| b.is_ascii_digit() || b.is_ascii_whitespace())
        };
        let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
        let at = lines.iter().position(|line| full(line)).unwrap() + row;
        lines[at].replace_range(5 * (place - 1)..5 * place, stated);
        lines.concat()
    };
    let caltech = |row, place, stated| move |text: &str| integers(text, row, place, stated);
    type Change = Box<dyn Fn(&str) -> String>;
    let cases: [(&str, Change, &str); 10] = [
        ("csmip.V1", Box::new(caltech(1, 12, "   25")), "states 25 values, 24 stand there"),
        ("csmip-1983.V2", Box::new(caltech(3, 5, "   23")), "states 23 values, 24 stand there"),
        ("bhrc.V1", Box::new(caltech(1, 12, "   25")), "integer 12 of line"),
        ("renadic.v1", Box::new(caltech(1, 12, " 9999")), "states 9999 values, 24 stand there"),
        ("usc.m0a", Box::new(caltech(1, 12, "   25")), "states 25 values, 24 stand there"),
        ("usc.s0a", Box::new(caltech(3, 5, "   25")), "states 25 values, 24 stand there"),
        (
            "cosmos.V2c",
            Box::new(|text: &str| {
                let at = text.find(" 100 Real-header").unwrap() - 3 * 81;
                format!("{}      25{}", &text[..at - 9], &text[at - 1..])
            }),
            "integer 70 of the header states 25 values",
        ),
        (
            "nga-west2.AT2",
            Box::new(|text: &str| text.replace("Made Up,", "25 points of Made Up,")),
            "line 2 states 25 values, line 4 24, which stand there",
        ),
        (
            "nga-west2.AT2",
            Box::new(|text: &str| text.replace("Made Up,", "25 0.0200000 1. Made Up,")),
            "line 2 states 25 values, line 4 24, which stand there",
        ),
        (
            "nga-west1.AT2",
            Box::new(|text: &str| text.replace("MADE UP", "23 points of MADE UP")),
            "line 2 states 23 values, line 4 24, which stand there",
        ),
    ];
    for (file, change, expected) in cases {
        let text = String::from_utf8(bytes(&samples(), file)).unwrap();
        let differs = |text: &str| {
            let record = record::read(file, text.as_bytes(), &NOTHING).unwrap();
            let all = record.channels[0].warnings.clone().into_iter();
            all.filter(|w| w.kind == NoticeKind::HeaderDiffers)
                .map(|w| w.message)
                .collect::<Vec<_>>()
        };
        assert_eq!(differs(&text), Vec::<String>::new(), "{file}");
        let changed = change(&text);
        assert_ne!(changed, text, "{file}");
        let said = differs(&changed);
        assert!(said.len() == 1 && said[0].contains(expected), "{file}: {said:?}");
    }
}

/// A file that ends with a whole block and lacks the ones after it says that it may be cut.
#[test]
fn files_cut_at_the_end_of_a_channel_say_so() {
    let truncated = |file: &str, text: &str| {
        let record = record::read(file, text.as_bytes(), &NOTHING).unwrap();
        let all = record.channels.iter().flat_map(kinds).collect::<Vec<_>>();
        (record.channels.len(), all.iter().filter(|kind| **kind == "truncated").count())
    };
    let usc = String::from_utf8(bytes(&samples(), "usc.s0a")).unwrap();
    assert_eq!(truncated("usc.s0a", &usc), (3, 0));
    for (block, left) in [("POINTS OF VEL", 1), ("POINTS OF DIS", 2)] {
        let at = usc.find(block).unwrap();
        let end = usc[..at].rfind('\n').unwrap() + 1;
        assert_eq!(truncated("usc.s0a", &usc[..end]), (left, 1), "{block}");
    }
    let Some(folder) = folder("files_cut_at_the_end_of_a_channel_say_so") else { return };
    let file = "geonet/20180212_211557_WPWS_20.V2A";
    let geonet = String::from_utf8(bytes(&folder, file)).unwrap();
    assert_eq!(truncated(file, &geonet), (9, 0));
    let titles: Vec<usize> =
        geonet.match_indices("Corrected accelerogram").map(|(at, _)| at).collect();
    assert_eq!(titles.len(), 3);
    assert_eq!(truncated(file, &geonet[..titles[2]]), (6, 1));
    assert_eq!(truncated(file, &geonet[..titles[1]]), (3, 1));
}

/// A header of SAC that promises more or fewer values than there are, or other steps.
#[test]
fn changed_sac_headers_are_noticed() {
    let plain = bytes(&samples(), "little.sac");
    let changed = |at: usize, word: [u8; 4]| {
        let mut bytes = plain.clone();
        bytes[at..at + 4].copy_from_slice(&word);
        record::read("f", &bytes, &given("g"))
    };
    let message = |at: usize, word: i32| changed(at, word.to_le_bytes()).unwrap_err().to_string();
    assert_eq!(
        message(316, 25),
        "f, byte 316: expected 732 bytes for 25 values, found \"728 bytes\""
    );
    assert_eq!(
        message(316, 23),
        "f, byte 316: expected 724 bytes for 23 values, found \"728 bytes\""
    );
    assert!(message(316, i32::MAX).contains("2 to 100 000 000 values"));
    assert!(message(340, 4).contains("found \"4, x against y\""));
    assert!(message(632, f32::NAN.to_bits().cast_signed()).contains("a finite number"));
    let longer = changed(0, 0.04_f32.to_le_bytes()).unwrap();
    assert!(kinds(&longer.channels[0]).contains(&"duration_differs"));
    let larger = changed(632, 9.0_f32.to_le_bytes()).unwrap();
    assert!(kinds(&larger.channels[0]).contains(&"peak_differs"));
}

/// A header without its lines of text, and bytes that are no text where units are stated.
#[test]
fn headers_of_numbers_and_of_no_text() {
    let volume = bytes(&samples(), "bhrc.V1");
    let full = |line: &&[u8]| {
        line.len() > 60 && line.iter().all(|b| b.is_ascii_digit() || b.is_ascii_whitespace())
    };
    let lines: Vec<&[u8]> = volume.split_inclusive(|b| *b == b'\n').collect();
    let at = lines.iter().position(full).unwrap();
    let options = Options { format: Some(Format::Bhrc), ..NOTHING };
    let error = record::read("f", &lines[at..].concat(), &options).unwrap_err().to_string();
    assert!(error.contains("expected lines of text before the header of integers"), "{error}");

    let plain = bytes(&samples(), "cosmos.V2c");
    let at = plain.windows(6).position(|w| w == b"units=").unwrap() + 6;
    let changed = [&plain[..at], &[0xFF; 40], &plain[at + 9..]].concat();
    let error = record::read("f", &changed, &NOTHING).unwrap_err().to_string();
    assert!(error.contains("expected units of"), "{error}");
}

/// Bytes of every sample, and what is given with them.
fn all_samples() -> Vec<(String, Vec<u8>, Options)> {
    let mut all: Vec<_> = fs::read_dir(samples())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e != "md"))
        .map(|path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let units = if name.ends_with("mseed") { "1e-5 g" } else { "m/s2" };
            let options = if name.ends_with("mseed") || name.ends_with("sac") {
                given(units)
            } else {
                NOTHING
            };
            (name, fs::read(path).unwrap(), options)
        })
        .collect();
    all.sort_by(|a, b| a.0.cmp(&b.0));
    all
}

/// Every prefix of the small samples: none panics, and none but the whole file reads as the whole,
/// unless all that is missing are blanks or the rest of the line that ends the data.
#[test]
fn prop_no_prefix_reads_as_the_whole() {
    for (name, bytes, options) in all_samples() {
        let whole = record::read(&name, &bytes, &options).ok();
        let of_others = ["AT2", "VT2", "csv", "txt"].iter().any(|e| name.ends_with(e));
        let of_columns = ["exsim.acc", "sdsu.bbp"].contains(&name.as_str());
        if (of_others && name != "nsmn.txt") || of_columns {
            continue;
        }
        let step = (bytes.len() / 2000).max(1);
        for end in (0..bytes.len()).step_by(step) {
            let Ok(read) = record::read(&name, &bytes[..end], &options) else { continue };
            let blank = bytes[end..].iter().all(|b| b.is_ascii_whitespace() || *b == 0);
            // Rows that repeat the last one are not read.
            let repeats = name == "unam.asa" && end + 64 > bytes.len();
            // "End-of-data for Chan 1 …" and "/& --- END OF DATA …" have said all with their first
            // words.
            let said = bytes[..end].trim_ascii_end().rsplit(|b| *b == b'\n').next();
            let ended = [&b"End-of-data"[..], b"/&"]
                .iter()
                .any(|mark| said.is_some_and(|line| line.starts_with(mark)));
            assert!(blank || repeats || ended || Some(&read) != whole.as_ref(), "{name} to {end}");
        }
    }
}

/// One changed byte at a time in the values of a sample of each network: a digit that is changed
/// changes the value or is refused.
#[test]
fn prop_a_changed_digit_changes_the_value() {
    let files = [
        "knet.EW",
        "esm.ASC",
        "itaca.acc",
        "nsmn.txt",
        "geonet.V1A",
        "unam.asa",
        "csmnc.dat",
        "csmnc-fixed.dat",
        "cwa.dat",
        "text.sac",
    ];
    for (name, bytes, options) in all_samples() {
        if !files.contains(&name.as_str()) {
            continue;
        }
        let whole = record::read(&name, &bytes, &options).unwrap();
        let values = |record: &Record| -> Vec<Vec<f64>> {
            record.channels.iter().map(|c| c.values.clone()).collect()
        };
        // The last 180 bytes are values; rows that repeat the last one follow in one of them.
        let end = bytes.len() - if name == "unam.asa" { 3 * 32 } else { 0 };
        for at in end - 180..end {
            // Zero times any power of ten is zero.
            let of_zero = bytes[at - 14..at].windows(8).any(|w| w == b"0.000000");
            if !bytes[at].is_ascii_digit() || of_zero {
                continue;
            }
            let mut changed = bytes.clone();
            changed[at] = if bytes[at] == b'9' { b'1' } else { bytes[at] + 1 };
            // Times of a table are checked against the step, and are no values.
            if let Ok(read) = record::read(&name, &changed, &options) {
                let same = values(&read) == values(&whole);
                let of_time = name == "cwa.dat" && read.channels.len() == 3;
                assert!(!same || of_time, "{name} at {at}");
            }
        }
    }
}

/// Changed bytes anywhere: nothing panics. The places follow from a fixed seed.
#[test]
fn prop_no_changed_byte_panics() {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = |n: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).unwrap() % n
    };
    let mut files = all_samples();
    if let Some(folder) = folder("prop_no_changed_byte_panics, of real files") {
        for file in [
            "sac/null_terminated.sac",
            "miniseed/int32_Steim2_bigEndian.mseed",
            "miniseed/brokenlastrecord.mseed",
        ] {
            files.push((file.to_owned(), bytes(&folder, file), given("g")));
        }
    }
    for (name, mut bytes, options) in files {
        for _ in 0..1500 {
            let (at, byte) = (next(bytes.len()), u8::try_from(next(256)).unwrap());
            let before = std::mem::replace(&mut bytes[at], byte);
            let _ = record::read(&name, &bytes, &options);
            let _ = record::read(&name, &bytes, &Options { dt_s: Some(0.02), ..NOTHING });
            bytes[at] = before;
        }
    }
}

/// Real files, cut at places that follow from a fixed seed and with bytes changed.
#[test]
fn records_prefixes_and_changed_bytes_of_real_files() {
    let Some(folder) = folder("records_prefixes_and_changed_bytes_of_real_files") else { return };
    let mut state = 1_u64;
    let mut next = |n: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).unwrap() % n
    };
    let mut seen = "";
    for (file, ..) in ROWS {
        if std::mem::replace(&mut seen, file) == file {
            continue;
        }
        let mut bytes = bytes(&folder, file);
        let count = record::read(file, &bytes, &NOTHING).unwrap().channels[0].values.len();
        for _ in 0..25 {
            let end = next(bytes.len() - 64);
            let read = record::read(file, &bytes[..end], &NOTHING);
            let duplicate = file.starts_with("unam");
            assert!(read.is_err() || duplicate, "{file} cut at {end} of {count}");
            let (at, byte) = (next(bytes.len()), u8::try_from(next(256)).unwrap());
            let before = std::mem::replace(&mut bytes[at], byte);
            let _ = record::read(file, &bytes, &NOTHING);
            bytes[at] = before;
        }
    }
}
