//! The small files of every format in `data/records`, and those that the examples run.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use slipstick::record::{self, Options, Record, Sampling, Units};

const G: f64 = 9.80665;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn g_at(dt_s: Option<f64>) -> Options {
    Options { units: Units::parse("g"), dt_s, ..Options::default() }
}

fn read(name: &str, options: &Options) -> Record {
    let bytes = fs::read(root().join("data/records").join(name)).unwrap();
    record::read(name, &bytes, options).unwrap()
}

/// The made-up motion in g.
fn motion_g() -> Vec<f64> {
    use std::f64::consts::{PI, TAU};
    let value = |k: f64| 0.2 * libm::sin(TAU * k / 24.0) * libm::sin(PI * k / 23.0);
    (0..24).map(|k| (value(f64::from(k)) * 1e6).round() / 1e6).collect()
}

#[test]
fn exact_every_sample_is_the_same_motion() {
    let nothing = Options::default();
    for (name, options, understood) in [
        ("nga-west2.AT2", &nothing, "PEER AT2, 24 values, 0.02 s, g"),
        ("nga-west1.AT2", &nothing, "PEER AT2, 24 values, 0.02 s, g"),
        ("peer-1999.AT2", &nothing, "PEER AT2, 24 values, 0.02 s, g"),
        ("poles.AT2", &nothing, "PEER AT2, 24 values, 0.02 s, g"),
        ("tabs.AT2", &nothing, "PEER AT2, 24 values, 0.02 s, g"),
        ("one-column.txt", &g_at(Some(0.02)), "text with one column, 24 values, 0.02 s, g"),
        ("count-and-step.txt", &g_at(None), "text with one column, 24 values, 0.02 s, g"),
        ("two-columns.txt", &g_at(None), "text with 2 columns, 24 values, 0.02 s, g"),
        ("along-lines.txt", &g_at(Some(0.02)), "text with 7 values a line, 24 values, 0.02 s, g"),
        ("named-columns.csv", &nothing, "text with 3 columns, 24 values, 0.02 s, m/s²"),
        ("bom-and-brackets.csv", &nothing, "text with 3 columns, 24 values, 0.02 s, g"),
        ("decimal-comma.csv", &nothing, "text with 2 columns, 24 values, 0.02 s, g"),
        ("rounded-times.txt", &g_at(None), "text with 2 columns, 24 values, 0.02 s, g"),
    ] {
        let record = read(name, options);
        let channel = &record.channels[0];
        assert_eq!(record.describe(channel), understood, "{name}");
        for (found, expected) in channel.values.iter().zip(motion_g()) {
            // The file has seven digits; conversion to SI rounds once more.
            assert!((found - expected * G).abs() < 1e-15, "{name}: {found} {expected}");
        }
        assert_eq!(channel.motion().unwrap().unwrap().dt_s(), Some(0.02), "{name}");
    }
}

#[test]
fn exact_what_the_samples_say_beside_their_values() {
    let record = read("peer-1999.AT2", &Options::default());
    let channel = &record.channels[0];
    assert_eq!(channel.event.as_deref(), Some("MADE UP 01/01/00 0000"));
    assert_eq!(channel.station.as_deref(), Some("NOWHERE"));
    assert_eq!((channel.name.as_str(), channel.azimuth_deg), ("067", Some(67.0)));
    assert_eq!(channel.filter.high_pass_hz.zip(channel.filter.low_pass_hz), Some((0.2, 12.5)));
    assert_eq!(read("poles.AT2", &Options::default()).channels[0].name, "UP");
    let record = read("named-columns.csv", &Options::default());
    let [along, up] = record.channels.as_slice() else { panic!("two channels") };
    assert_eq!(
        (along.name.as_str(), up.values[1]),
        ("acceleration_m_per_s2", -along.values[1] / 2.0)
    );
    assert_eq!(read("rounded-times.txt", &g_at(None)).warnings[0].kind, "times_rounded");
}

#[test]
fn exact_velocity_file_is_the_integral_of_the_acceleration_file() {
    let velocity = read("velocity.VT2", &Options::default());
    assert_eq!(velocity.layout, "PEER VT2");
    let mut integral = 0.0;
    let a = motion_g();
    for k in 1..24 {
        integral += 0.02 * (a[k - 1] + a[k]) / 2.0 * G;
        assert!((velocity.channels[0].values[k] - integral).abs() < 1e-7, "{k}");
    }
}

#[test]
fn exact_rectangle_keeps_its_jumps() {
    let record = read("rectangle.csv", &Options::default());
    let times_s = vec![0.0, 0.5, 0.5, 1.5, 1.5, 2.25];
    assert_eq!(record.channels[0].sampling, Sampling::Times(times_s));
    let figures = record.channels[0].motion().unwrap().unwrap().figures();
    assert_eq!((figures.pgv_m_per_s, figures.pgd_m), (2.0, 2.5));
}

#[test]
fn exact_truncated_sample_is_refused() {
    let bytes = fs::read(root().join("data/records/truncated.AT2")).unwrap();
    let error = record::read("truncated.AT2", &bytes, &Options::default()).unwrap_err();
    assert_eq!((error.line, error.expected.as_str()), (9, "24 values, as line 4 says"));
}

/// Values of the USGS collection, and the figures that its readers know these records by.
#[test]
fn exact_records_of_the_examples() {
    for (name, values, pga_g, pgv_cm_per_s) in [
        ("taft-111.txt", 5211, 0.177_794, 17.87),
        ("taft-021.txt", 5266, 0.155_955, 15.45),
        ("el-centro-180.txt", 3949, 0.312_881, 29.68),
    ] {
        let bytes = fs::read(root().join("examples/records").join(name)).unwrap();
        let record = record::read(name, &bytes, &g_at(Some(0.01))).unwrap();
        let motion = record.channels[0].motion().unwrap().unwrap();
        assert_eq!(motion.len(), values);
        let figures = motion.figures();
        assert!((figures.pga_m_per_s2 / G - pga_g).abs() < 1e-9, "{name}");
        assert!((100.0 * figures.pgv_m_per_s / pgv_cm_per_s - 1.0).abs() < 0.01, "{name}");
    }
}
