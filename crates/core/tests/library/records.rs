//! Real records, compared with the table that came with them. They are not part of the repository:
//! the tests look in `$SLIPSTICK_RECORDS`, else `../shared/records`; without them each prints
//! `skipped: <name>`.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use slipstick::notice::NoticeKind;
use slipstick::record::{self, Channel, Format, Options, Quantity, Record, Sampling, Units};

const G: f64 = 9.80665;

/// The folder, or `None` and a line that says so.
#[allow(clippy::disallowed_macros, reason = "tests say what they skip on their own output")]
fn folder(test: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/records");
    let folder = std::env::var_os("SLIPSTICK_RECORDS").map_or(beside, PathBuf::from);
    if folder.join("index.csv").is_file() {
        return Some(folder);
    }
    println!("skipped: {test}");
    None
}

/// One channel of the index.
#[derive(Debug)]
struct Row {
    file: String,
    channel: String,
    units: String,
    dt_s: f64,
    npts: usize,
    pga_g: f64,
    pgv_cm_per_s: f64,
    end_velocity_cm_per_s: f64,
    peak_native: f64,
}

/// Rows of the index under a folder that hold a time history.
fn index(folder: &Path, under: &str) -> Vec<Row> {
    let text = fs::read_to_string(folder.join("index.csv")).unwrap();
    let mut rows = Vec::new();
    for line in text.lines().skip(1) {
        let cells = cells(line);
        // Cells are counted from the end: a few rows have a text with commas in the middle.
        let at = |back: usize| cells[cells.len() - back].clone();
        let number = |back: usize| at(back).parse::<f64>().unwrap_or(f64::NAN);
        let npts = at(6).split_whitespace().next().and_then(|n| n.parse().ok());
        if let (true, Some(npts)) = (cells[0].starts_with(under), npts) {
            rows.push(Row {
                file: cells[0].clone(),
                channel: at(9),
                units: at(8),
                dt_s: number(7),
                npts,
                pga_g: number(5),
                pgv_cm_per_s: number(4),
                end_velocity_cm_per_s: number(2),
                peak_native: number(1),
            });
        }
    }
    rows
}

/// Cells of a CSV line; quoted ones may hold commas.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().unwrap().push(c),
        }
    }
    cells
}

/// Reads a file with no more than it needs: nothing, units, or units and step.
fn read(folder: &Path, row: &Row) -> Record {
    let bytes = fs::read(folder.join(&row.file)).unwrap();
    let units = Units::parse(&row.units);
    let nothing = Options::default();
    let with_units = Options { units, ..Options::default() };
    let with_both = Options { units, dt_s: Some(row.dt_s), ..Options::default() };
    record::read(&row.file, &bytes, &nothing)
        .or_else(|error| {
            assert!(error.expected.contains("add units = "), "{error}");
            record::read(&row.file, &bytes, &with_units)
        })
        .or_else(|error| {
            assert!(error.expected.contains("add dt = "), "{error}");
            record::read(&row.file, &bytes, &with_both)
        })
        .unwrap_or_else(|error| panic!("{error}"))
}

fn compare(record: &Record, channel: &Channel, row: &Row) {
    let place = format!("{} {}: {}", row.file, row.channel, record.describe(channel));
    // The index counts two rows more than this file states; they repeat the last.
    let npts = if row.file.contains("unam_asa2") { 17_500 } else { row.npts };
    assert_eq!(channel.values.len(), npts, "{place}");
    // Digitised film has no step; the index has one all the same.
    match &channel.sampling {
        Sampling::Times(_) => assert!(row.file.ends_with("017m30ah.m0a"), "{place}"),
        sampling => assert_eq!(*sampling, Sampling::Dt(row.dt_s), "{place}"),
    }
    let peak = channel.values.iter().fold(0.0_f64, |peak, value| value.abs().max(peak));
    let native = peak / channel.units.si();
    // The index has six digits.
    assert!((native - row.peak_native).abs() <= 1e-5 * row.peak_native, "{place}: {native}");
    if channel.units.quantity() != Quantity::Acceleration {
        return;
    }
    assert!((peak / G - row.pga_g).abs() <= 1e-5 * row.pga_g, "{place}: {}", peak / G);
    let motion = channel.motion().unwrap().unwrap();
    let figures = motion.figures();
    if channel.sampling != Sampling::Dt(row.dt_s) {
        // The index integrated this one as if its steps were equal.
        return;
    }
    // The index has the largest velocity at samples; between them there is a little more.
    let pgv = 100.0 * largest_sampled_velocity(&channel.values, motion.times_s());
    assert!((pgv - row.pgv_cm_per_s).abs() <= 0.001 * row.pgv_cm_per_s, "{place}: {pgv}");
    let exact = 100.0 * figures.pgv_m_per_s;
    assert!((0.999_999 * pgv..=1.1 * pgv).contains(&exact), "{place}: {exact} {pgv}");
    let end = 100.0 * figures.end_velocity_m_per_s;
    assert!((end - row.end_velocity_cm_per_s).abs() <= 0.01 * row.pgv_cm_per_s, "{place}: {end}");
}

/// By the trapezium rule, which is exact for straight lines.
fn largest_sampled_velocity(acceleration: &[f64], times_s: &[f64]) -> f64 {
    let (mut velocity, mut peak) = (0.0, 0.0_f64);
    for (a, t) in acceleration.windows(2).zip(times_s.windows(2)) {
        velocity += (t[1] - t[0]) * (a[0] + a[1]) / 2.0;
        peak = peak.max(f64::abs(velocity));
    }
    peak
}

#[test]
fn records_motions_read_as_their_index_says() {
    let Some(folder) = folder("records_motions_read_as_their_index_says") else { return };
    let rows = index(&folder, "motions/");
    assert!(rows.len() >= 110, "{}", rows.len());
    let mut channel = 0;
    for (i, row) in rows.iter().enumerate() {
        let record = read(&folder, row);
        let again = i > 0 && rows[i - 1].file == row.file;
        channel = if again { channel + 1 } else { 0 };
        compare(&record, &record.channels[channel], row);
    }
}

/// Every channel of every sample that the index lists with its number of values.
#[test]
fn records_samples_read_as_their_index_says() {
    let Some(folder) = folder("records_samples_read_as_their_index_says") else { return };
    let rows = index(&folder, "formats/");
    let mut channel = 0;
    let mut compared = 0;
    for (i, row) in rows.iter().enumerate() {
        let again = i > 0 && rows[i - 1].file == row.file;
        channel = if again { channel + 1 } else { 0 };
        if row.file.contains("truncated") {
            continue;
        }
        let record = read(&folder, row);
        let quantity = Units::parse(&row.units).unwrap().quantity();
        let mut channels = record.channels.iter().filter(|c| c.units.quantity() == quantity);
        compare(&record, channels.nth(channel).unwrap(), row);
        compared += 1;
    }
    assert!(compared >= 40, "{compared}");
}

/// What the samples are taken for, and the files that hold no time history.
#[test]
fn records_samples_are_recognised() {
    let Some(folder) = folder("records_samples_are_recognised") else { return };
    for (path, format) in [
        ("peer_at2", Format::Peer),
        ("csmip_v1_v2", Format::Csmip),
        ("cosmos", Format::Cosmos),
        ("smc", Format::Smc),
        ("usc_caltech", Format::Usc),
        ("renadic", Format::Renadic),
        ("bhrc", Format::Bhrc),
        ("knet_kiknet", Format::Knet),
        ("esm_dyna", Format::Dyna),
        ("afad", Format::Dyna),
        ("itaca_sisma_acc", Format::Itaca),
        ("afad_old_nsmn", Format::Nsmn),
        ("geonet", Format::GeoNet),
        ("unam_asa2", Format::Asa),
        ("csmnc_china", Format::Csmnc),
        ("cwa_taiwan", Format::Cwa),
        ("csv_columns", Format::Delimited),
        ("single_column", Format::Delimited),
    ] {
        for file in fs::read_dir(folder.join("formats").join(path)).unwrap().map(Result::unwrap) {
            let name = file.file_name().into_string().unwrap();
            let bytes = fs::read(file.path()).unwrap();
            let units = Units::parse("g");
            let plain = record::read(&name, &bytes, &Options::default());
            let result = plain
                .or_else(|_| record::read(&name, &bytes, &Options { units, ..Options::default() }))
                .or_else(|_| {
                    let dt_s = Some(0.01);
                    record::read(&name, &bytes, &Options { units, dt_s, ..Options::default() })
                });
            match result {
                Ok(record) => assert_eq!(record.format, format, "{name}"),
                Err(error) if name == "chan001.v3" => {
                    assert!(error.expected.contains("not the spectra of a volume III"), "{error}");
                }
                Err(error) => assert!(name.starts_with("truncated"), "{error}"),
            }
        }
    }
    let spectra = folder.join("formats/seismosignal/SeismoSignal_Imperial_Valley.txt");
    let error = record::read("s", &fs::read(spectra).unwrap(), &Options::default()).unwrap_err();
    assert_eq!(error.expected, "a time history, not a spectrum");
}

/// What headers say beside their values.
#[test]
fn records_headers_of_samples_are_understood() {
    let Some(folder) = folder("records_headers_of_samples_are_understood") else { return };
    for (file, channel, component, azimuth_deg, filter, station) in [
        (
            "csmip_v1_v2/ce36456p_CE36456.V2",
            "90 DEG",
            "90 DEG",
            Some(90.0),
            (Some(0.1), Some(23.0)),
            "PARKFIELD FAULT ZONE 14",
        ),
        (
            "csmip_v1_v2/chan001.v2",
            "Up velocity",
            "Up",
            None,
            (Some(0.3), Some(40.0)),
            "Hayward - Hwy 580/238 Interchange Bridge",
        ),
        ("csmip_v1_v2/CE89146.V1", "360 deg", "360 Deg", Some(360.0), (None, None), "Willow Creek"),
        (
            "cosmos/Cosmos12TimeSeriesTest.v1",
            "340 deg",
            "340 deg",
            Some(340.0),
            (Some(0.3), Some(40.0)),
            "CE-J2236 CDMG Yucaipa - Bryant & Oak Glen",
        ),
        (
            "smc/0111a.smc",
            "360",
            "360",
            Some(360.0),
            (Some(0.1), None),
            "San Francisco, 1295 Shafter, F",
        ),
        (
            "usc_caltech/017m30bt.s0a",
            "N08W displacement",
            "N08W",
            Some(352.0),
            (Some(0.325), Some(25.0)),
            "BIG TUJUNGA STATION, ANGELES NATIONAL FOREST, CA",
        ),
        ("bhrc/5526-1.V1", "T3", "T3", Some(140.0), (None, None), "Avin"),
        ("renadic/vallenar1002271.v1", "NS", "NS", None, (None, None), "QDR S/N 0"),
    ] {
        let bytes = fs::read(folder.join("formats").join(file)).unwrap();
        let record = record::read(file, &bytes, &Options::default()).unwrap();
        let channel = record.channel(channel).unwrap_or_else(|| panic!("{file}"));
        assert_eq!(channel.component.as_deref(), Some(component), "{file}");
        assert_eq!(channel.azimuth_deg, azimuth_deg, "{file}");
        let corners = (channel.filter.high_pass_hz, channel.filter.low_pass_hz);
        assert_eq!(corners, filter, "{file}");
        assert_eq!(channel.station.as_deref(), Some(station), "{file}");
        let other = |kind: NoticeKind| !record::REST_KINDS.contains(&kind);
        assert!(channel.warnings.iter().all(|w| !other(w.kind)), "{file}: {:?}", channel.warnings);
    }
    let bytes = fs::read(folder.join("formats/smc/0111a.smc")).unwrap();
    let record = record::read("s", &bytes, &Options::default()).unwrap();
    assert_eq!(record.channels[0].event.as_deref(), Some("Loma Prieta, CA"));
}

/// Cut in the middle of a number: its last value would be a peak of 0.475 g that never was.
#[test]
fn records_truncated_record_is_refused() {
    let Some(folder) = folder("records_truncated_record_is_refused") else { return };
    let file = "formats/peer_at2/truncated_HECTOR_HEC000.AT2";
    let bytes = fs::read(folder.join(file)).unwrap();
    let error = record::read("HEC000.AT2", &bytes, &Options::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "HEC000.AT2:329:10: expected 4531 values, as line 4 says, found \"the end after 1621\""
    );
}

/// The time column of this file is rounded to a step of 0.003 s; the truth is 0.0025 s.
#[test]
fn records_rounded_times_are_doubted_and_can_be_replaced() {
    let Some(folder) = folder("records_rounded_times_are_doubted_and_can_be_replaced") else {
        return;
    };
    let file = "formats/csv_columns/SortedEQFile_120921.txt";
    let bytes = fs::read(folder.join(file)).unwrap();
    let options = Options { units: Units::parse("g"), ..Options::default() };
    let record = record::read(file, &bytes, &options).unwrap();
    assert_eq!(record.warnings[0].kind, NoticeKind::TimesRounded);
    let record = record::read(file, &bytes, &Options { dt_s: Some(0.0025), ..options }).unwrap();
    assert_eq!(record.channels[0].sampling, Sampling::Dt(0.0025));
    assert_eq!(record.warnings[0].kind, NoticeKind::TimesReplaced);
}

/// Numbers that are a little random and the same on every machine.
fn random_numbers() -> impl FnMut(usize) -> usize {
    let mut state = 1_u64;
    move |below| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below.max(1)
    }
}

/// All samples, with the folder of each.
fn samples(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut samples = Vec::new();
    for format in fs::read_dir(folder.join("formats")).unwrap().map(Result::unwrap) {
        for file in fs::read_dir(format.path()).unwrap().map(Result::unwrap) {
            let name = format!(
                "/{}/{}",
                format.file_name().into_string().unwrap(),
                file.file_name().into_string().unwrap()
            );
            samples.push((name, fs::read(file.path()).unwrap()));
        }
    }
    samples.sort();
    samples
}

/// Any prefix and any changed byte of a sample gives a record or an error, never a panic.
#[test]
fn records_damaged_samples_never_panic() {
    let Some(folder) = folder("records_damaged_samples_never_panic") else { return };
    let mut random = random_numbers();
    let options = Options { units: Units::parse("g"), dt_s: Some(0.01), ..Options::default() };
    let nothing = Options::default();
    for (_, mut bytes) in samples(&folder) {
        let n = bytes.len();
        // Every prefix where headers are, one in some hundreds beyond.
        let step = (n / 40).max(1);
        let prefixes = (0..n.min(4000)).step_by(37).chain((0..n).step_by(step));
        for end in prefixes {
            let _ = record::read("prefix", &bytes[..end], &nothing);
        }
        for i in 0..60 {
            let near = if i % 3 == 0 { n } else { n.min(4000) };
            let at = random(near);
            let byte = bytes[at];
            bytes[at] = random(256) as u8;
            let options = if i % 2 == 0 { &nothing } else { &options };
            let _ = record::read("changed", &bytes, options);
            bytes[at] = byte;
        }
    }
}

/// A changed digit of a value, or of a line that announces values, is another record or none.
#[test]
fn records_changed_digits_are_never_overlooked() {
    let Some(folder) = folder("records_changed_digits_are_never_overlooked") else { return };
    let mut random = random_numbers();
    let mut changes = 0;
    for (name, mut bytes) in samples(&folder) {
        if name.contains("/sac/") {
            // Its alphanumeric header is numbers too.
            continue;
        }
        let read = |bytes: &[u8]| {
            let units = Units::parse("g");
            record::read("f", bytes, &Options::default())
                .or_else(|_| record::read("f", bytes, &Options { units, ..Options::default() }))
                .or_else(|_| {
                    let dt_s = Some(0.01);
                    record::read("f", bytes, &Options { units, dt_s, ..Options::default() })
                })
        };
        let Ok(whole) = read(&bytes) else { continue };
        for _ in 0..60 {
            // Past the first header, before the second.
            let n = bytes.len();
            let at = n / 8 + random(n / 6);
            let line = bytes[..at].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
            let end = bytes[at..].iter().position(|&b| b == b'\n').map_or(n, |i| at + i);
            let is_values = bytes[line..end]
                .iter()
                .all(|&b| !b.is_ascii_alphabetic() || b == b'E' || b == b'e');
            // Times may be rounded: only the last column of those tables.
            let is_table = name.contains("csv_columns");
            let rest = bytes[at..end].trim_ascii_end();
            let in_last = !rest.iter().any(|b| matches!(b, b' ' | b',' | b'\t'));
            if !bytes[at].is_ascii_digit() || !is_values || (is_table && !in_last) {
                continue;
            }
            let byte = bytes[at];
            bytes[at] = b'0' + (byte - b'0' + 1 + random(9) as u8) % 10;
            if let Ok(changed) = read(&bytes) {
                let text = String::from_utf8_lossy(&bytes[line..end]).into_owned();
                assert!(changed.channels != whole.channels, "{name}, byte {at}: {text}");
            }
            bytes[at] = byte;
            changes += 1;
        }
    }
    assert!(changes > 500, "{changes}");
}
