//! Real records, compared with the table that came with them. They are not part of the repository:
//! the tests look in `$SLIPSTICK_RECORDS`, else `../shared/records`; without them each prints
//! `skipped: <name>`.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use slipstick::record::{self, Channel, Options, Quantity, Record, Sampling, Units};

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
    assert_eq!(channel.values.len(), row.npts, "{place}");
    assert_eq!(channel.sampling, Sampling::Dt(row.dt_s), "{place}");
    let peak = channel.values.iter().fold(0.0_f64, |peak, value| value.abs().max(peak));
    let native = peak / channel.units.si();
    // The index has six digits.
    assert!((native - row.peak_native).abs() <= 1e-5 * row.peak_native, "{place}: {native}");
    if channel.units.quantity() != Quantity::Acceleration {
        return;
    }
    assert!((peak / G - row.pga_g).abs() <= 1e-5 * row.pga_g, "{place}: {}", peak / G);
    let figures = channel.motion().unwrap().unwrap().figures();
    // The index has the largest velocity at samples; between them there is a little more.
    let pgv = 100.0 * largest_sampled_velocity(&channel.values, row.dt_s);
    assert!((pgv - row.pgv_cm_per_s).abs() <= 0.001 * row.pgv_cm_per_s, "{place}: {pgv}");
    let exact = 100.0 * figures.pgv_m_per_s;
    assert!((0.999_999 * pgv..=1.03 * pgv).contains(&exact), "{place}: {exact} {pgv}");
    let end = 100.0 * figures.end_velocity_m_per_s;
    assert!((end - row.end_velocity_cm_per_s).abs() <= 0.01 * row.pgv_cm_per_s, "{place}: {end}");
}

/// By the trapezium rule, which is exact for straight lines.
fn largest_sampled_velocity(acceleration: &[f64], dt_s: f64) -> f64 {
    let (mut velocity, mut peak) = (0.0, 0.0_f64);
    for a in acceleration.windows(2) {
        velocity += dt_s * (a[0] + a[1]) / 2.0;
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

#[test]
fn records_peer_samples_read_as_their_index_says() {
    let Some(folder) = folder("records_peer_samples_read_as_their_index_says") else { return };
    for row in index(&folder, "formats/peer_at2/") {
        if row.file.contains("truncated") {
            continue;
        }
        let record = read(&folder, &row);
        let words = ["PEER AT2", "PEER VT2", "PEER DT2"];
        assert!(words.contains(&record.layout.as_str()), "{}", record.layout);
        compare(&record, &record.channels[0], &row);
    }
}

#[test]
fn records_text_samples_read_as_their_index_says() {
    let Some(folder) = folder("records_text_samples_read_as_their_index_says") else { return };
    for under in ["formats/csv_columns/", "formats/single_column/"] {
        for row in index(&folder, under) {
            let record = read(&folder, &row);
            compare(&record, &record.channels[0], &row);
        }
    }
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
    assert_eq!(record.warnings[0].kind, "times_rounded");
    let record = record::read(file, &bytes, &Options { dt_s: Some(0.0025), ..options }).unwrap();
    assert_eq!(record.channels[0].sampling, Sampling::Dt(0.0025));
    assert_eq!(record.warnings[0].kind, "times_replaced");
}

/// Files of formats that are not read yet are refused, whatever the caller says of them.
#[test]
fn records_other_formats_are_refused() {
    let Some(folder) = folder("records_other_formats_are_refused") else { return };
    // Columns under a few lines of comment are delimited text in any language.
    let text = ["csv_columns", "single_column", "peer_at2", "cwa_taiwan"];
    let options = Options { units: Units::parse("g"), dt_s: Some(0.01), ..Options::default() };
    for format in fs::read_dir(folder.join("formats")).unwrap().map(Result::unwrap) {
        if text.contains(&format.file_name().to_str().unwrap()) {
            continue;
        }
        for file in fs::read_dir(format.path()).unwrap().map(Result::unwrap) {
            let bytes = fs::read(file.path()).unwrap();
            let name = file.file_name().into_string().unwrap();
            let result = record::read(&name, &bytes, &options);
            assert!(result.is_err(), "{name}: {:?}", result.unwrap().layout);
        }
    }
}

/// Any prefix and any changed byte of a sample gives a record or an error, never a panic; and the
/// start of an AT2 file is never the whole.
#[test]
fn records_damaged_samples_never_panic() {
    let Some(folder) = folder("records_damaged_samples_never_panic") else { return };
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let options = Options { units: Units::parse("g"), dt_s: Some(0.01), ..Options::default() };
    for format in ["peer_at2", "csv_columns", "single_column", "seismosignal", "cwa_taiwan"] {
        for file in fs::read_dir(folder.join("formats").join(format)).unwrap() {
            let mut bytes = fs::read(file.unwrap().path()).unwrap();
            for _ in 0..60 {
                // Mostly near the start, where headers are.
                let n = bytes.len();
                let near = if random(2) == 0 { n } else { n.min(600) };
                let at = random(near);
                let _ = record::read("prefix", &bytes[..at], &options);
                let byte = bytes[at];
                bytes[at] = random(256) as u8;
                let _ = record::read("changed", &bytes, &options);
                bytes[at] = byte;
            }
        }
    }
}
