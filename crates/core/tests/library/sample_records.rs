//! The small files of every format in `data/records`, and those that the examples run.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use slipstick::notice::{Notice, NoticeKind};
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
fn every_sample_is_the_same_motion() {
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
        ("words-below.txt", &g_at(Some(0.02)), "text with 8 values a line, 24 values, 0.02 s, g"),
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
fn what_the_samples_say_beside_their_values() {
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
    assert_eq!(read("rounded-times.txt", &g_at(None)).warnings[0].kind, NoticeKind::TimesRounded);
}

#[test]
fn velocity_file_is_the_integral_of_the_acceleration_file() {
    let velocity = read("velocity.VT2", &Options::default());
    assert_eq!(velocity.layout, "PEER VT2");
    let mut integral = 0.0;
    let a = motion_g();
    for k in 1..24 {
        integral += 0.02 * (a[k - 1] + a[k]) / 2.0 * G;
        assert!((velocity.channels[0].values[k] - integral).abs() < 1e-7, "{k}");
    }
}

/// The acceleration channels of the files of networks are the same motion, to the digits that their
/// formats have; vertical ones are minus half of it.
#[test]
fn every_format_holds_the_same_motion() {
    let nothing = Options::default();
    for (name, layout, channel, factor, digit_g) in [
        ("csmip.V1", "CSMIP V1, 2 channels", "90 Deg", 1.0, 1e-6),
        ("csmip.V1", "CSMIP V1, 2 channels", "Up", -0.5, 1e-6),
        ("csmip-1983.V2", "CSMIP V2, 1 channel", "90 DEG", 1.0, 1.1e-6),
        ("csmip-touching.V2", "CSMIP V2, 1 channel", "Up", 1.0, 1.1e-8),
        ("cosmos.V2c", "COSMOS v1, 2 channels", "352 deg", 1.0, 1.1e-7),
        ("made-up.smc", "SMC", "352", 1.0, 1.1e-5),
        ("eight-digits.smc", "SMC", "352", 1.0, 1.1e-8),
        ("usc.m0a", "USC/Caltech volume I", "N08W", 1.0, 1e-4),
        ("usc.s0a", "USC/Caltech volume II", "N08W", 1.0, 1.1e-6),
        ("usc-no-units.s0a", "USC/Caltech volume II", "N08W", 1.0, 1.1e-6),
        ("text-columns.csv", "text with 6 columns", "Acc (%g)", 1.0, 1e-6),
        ("exsim.acc", "text with 2 columns", "acc(cm/s**2)", 1.0, 1.1e-5),
        ("sdsu.bbp", "text with 4 columns", "N-S(cm/s/s)", 1.0, 1.1e-7),
        ("sdsu.bbp", "text with 4 columns", "U-D(cm/s/s)", 0.25, 1.1e-7),
        ("knet.csv", "text with 5 columns", "E-W(gal)", -0.5, 1.1e-7),
        ("jma.csv", "JMA CSV", "NS", 1.0, 1.1e-7),
        ("jma.csv", "JMA CSV", "UD", 0.25, 1.1e-7),
        ("renadic.v1", "RENADIC V1", "EW", 1.0, 1e-4),
        ("renadic.v1", "RENADIC V1", "Z", -0.5, 1e-4),
        ("bhrc.V1", "BHRC V1", "L1", 1.0, 1e-7),
        ("bhrc.V1", "BHRC V1", "V2", -0.5, 1e-7),
        ("seismosignal.txt", "SeismoSignal text", "acc(g)", 1.0, 1e-8),
    ] {
        let record = read(name, &nothing);
        assert_eq!(record.layout, layout, "{name}");
        let channel = record.channel(channel).unwrap_or_else(|| panic!("{name}"));
        assert_eq!(channel.sampling, Sampling::Dt(0.02), "{name}");
        assert_eq!(channel.values.len(), 24, "{name}");
        for (found, expected) in channel.values.iter().zip(motion_g()) {
            let (found, expected) = (found / G, factor * expected);
            assert!((found - expected).abs() <= 0.501 * digit_g, "{name}: {found} {expected}");
        }
        let rest = |w: &Notice| record::REST_KINDS.contains(&w.kind);
        assert!(channel.warnings.iter().all(rest), "{name}: {:?}", channel.warnings);
    }
}

/// Velocity and displacement of a corrected volume are channels of their own.
#[test]
fn parts_of_a_volume_are_channels() {
    let mut velocity = vec![0.0];
    let a = motion_g();
    for k in 1..24 {
        velocity.push(velocity[k - 1] + 0.02 * (a[k - 1] + a[k]) / 2.0 * G);
    }
    for (name, channel, digit_m_per_s) in [
        ("csmip-1983.V2", "90 DEG velocity", 1e-5),
        ("csmip-touching.V2", "up velocity", 1e-6),
        ("cosmos.V2c", "352 DEG velocity", 1e-7),
        ("usc.s0a", "N08W velocity", 1e-5),
    ] {
        let record = read(name, &Options::default());
        let channel = record.channel(channel).unwrap_or_else(|| panic!("{name}"));
        assert!(channel.motion().is_none());
        for (found, expected) in channel.values.iter().zip(&velocity) {
            assert!((found - expected).abs() <= 0.501 * digit_m_per_s, "{name} {found} {expected}");
        }
    }
    let record = read("usc.s0a", &Options::default());
    let names: Vec<_> = record.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["N08W", "N08W velocity", "N08W displacement"]);
}

/// Counts are no motion until the caller says what one of them is.
#[test]
fn counts_need_the_value_of_one() {
    let record = read("cosmos-counts.V0c", &Options::default());
    let channel = &record.channels[0];
    assert_eq!(record.describe(channel), "COSMOS v1, 1 channel, 24 values, 0.02 s, counts");
    assert!(channel.motion().is_none());
    assert!((channel.values[5] - (motion_g()[5] * 1e6).round()).abs() < 0.5);
    let options = Options { units: Units::parse("1e-6 g"), ..Options::default() };
    let record = read("cosmos-counts.V0c", &options);
    assert!((record.channels[0].values[5] / G - motion_g()[5]).abs() < 1e-9);
    assert!(record.channels[0].motion().is_some());
}

/// Every count, step and unit that a header states, changed: refused, another channel, or a
/// warning; never the same record.
#[test]
fn changed_headers_are_never_overlooked() {
    for (name, changes) in [
        (
            "csmip.V1",
            &[
                ("Points =  24 ", "Points =  25 "),
                ("at  50 Samples", "at  51 Samples"),
                ("sec and g .", "sec and mg ."),
                ("    24 Accel", "    23 Accel"),
                ("    24 Accel", "    25 Accel"),
                ("    24 Accel", " 99999 Accel"),
                ("at  50 pts", "at  60 pts"),
                ("units of g .", "units of m/s2 ."),
                ("Max  =   .158", "Max  =   .258"),
            ][..],
        ),
        (
            "csmip-1983.V2",
            &[
                ("    24 POINTS OF INS", "    34 POINTS OF INS"),
                ("INTERVALS OF    .020", "INTERVALS OF    .010"),
                ("24 POINTS OF ACCEL", "26 POINTS OF ACCEL"),
                ("24 POINTS OF ACCEL", "16 POINTS OF ACCEL"),
                ("24 POINTS OF VELOC", "16 POINTS OF VELOC"),
                ("AT  .020 SEC.  (UNITS: CM/SEC/SEC", "AT  .030 SEC.  (UNITS: CM/SEC/SEC"),
                ("(UNITS: CM/SEC/SEC)", "(UNITS: CM/SEC)"),
                ("(UNITS: CM/SEC/SEC)", "(UNITS: MM/SEC/SEC)"),
                ("PEAK ACCELERATION =   154.774", "PEAK ACCELERATION =   254.774"),
            ],
        ),
        (
            "cosmos.V2c",
            &[
                ("     24 acc", "     25 acc"),
                ("     24 acc", "     23 acc"),
                ("approx    0", "approx    9"),
                ("cm/sec2(04)", "cm/sec2(02)"),
                ("cm/sec2(04)", "g(04)"),
                ("cm/sec2(04)", "g(02)"),
                ("cm/sec2(04)", "cm(06)"),
                ("20.000000       0.480000", "30.000000       0.480000"),
                ("20.000000       0.480000", "20.000000       0.980000"),
                ("   1 Comment", "   2 Comment"),
                ("on  20 lines", "on  19 lines"),
                ("100 Real", "090 Real"),
            ],
        ),
        (
            "made-up.smc",
            &[
                ("        24", "        25"),
                ("        24", "        23"),
                ("        24    -32768", " 100000000    -32768"),
                ("5.0000000E+01", "5.1000000E+01"),
                ("2 CORRECTED ACCELEROGRAM", "3 VELOCITY"),
                ("  1.5477", "  1.8477"),
                ("-32768         2", "-32768         3"),
            ],
        ),
        (
            "usc.m0a",
            &[
                ("POINTS =     24", "POINTS =     25"),
                ("POINTS =     24", "POINTS =     23"),
                ("G/10    ", "G/20    "),
            ],
        ),
        (
            "renadic.v1",
            &[
                ("POINTS =     24", "POINTS =     30"),
                ("POINTS =     24", "POINTS =     20"),
                ("G/10.", "MG.  "),
                ("MAX  =  0.158", "MAX  =  0.358"),
            ],
        ),
        (
            "bhrc.V1",
            &[
                ("POINTS =     24", "POINTS =     30"),
                ("POINTS =     24", "POINTS =     23"),
                ("DURATION =   .480", "DURATION =   .680"),
                (".500000E+02", ".600000E+02"),
                ("AND G/10", "AND M/10"),
            ],
        ),
        ("seismosignal.txt", &[("Step: 0.02 s", "Step: 0.01 s"), ("Acc(g)", "Acc(mg)")]),
    ] {
        let whole = fs::read(root().join("data/records").join(name)).unwrap();
        let whole = String::from_utf8(whole).unwrap();
        let record = record::read(name, whole.as_bytes(), &Options::default()).unwrap();
        for (from, to) in changes {
            assert!(whole.contains(from), "{name}: {from}");
            let changed = whole.replacen(from, to, 1);
            if let Ok(other) = record::read(name, changed.as_bytes(), &Options::default()) {
                assert!(other.channels != record.channels, "{name}: {from} -> {to}");
            }
        }
        // A count of 10¹² allocates nothing, and no start of a file is the whole.
        let promised = whole.replacen("24", "1000000000000", 30);
        let result = record::read(name, promised.as_bytes(), &Options::default());
        assert!(result.is_err(), "{name}");
        // Columns of text do not say how many rows they have.
        let last = if name == "seismosignal.txt" { "" } else { whole.as_str() };
        for end in 0..last.trim_end_matches(['\r', '\n', '\x1a']).len() {
            if let Ok(start) = record::read(name, &whole.as_bytes()[..end], &Options::default()) {
                let channels = &start.channels;
                let said = channels
                    .iter()
                    .any(|c| c.warnings.iter().any(|w| w.kind == NoticeKind::Truncated));
                // A file cut between two channels is whole files of fewer.
                assert!(said || record.channels.starts_with(channels), "{name}: {end}");
            }
        }
    }
}

#[test]
fn rectangle_keeps_its_jumps() {
    let record = read("rectangle.csv", &Options::default());
    let times_s = vec![0.0, 0.5, 0.5, 1.5, 1.5, 2.25];
    assert_eq!(record.channels[0].sampling, Sampling::Times(times_s));
    let figures = record.channels[0].motion().unwrap().unwrap().figures();
    assert_eq!((figures.pgv_m_per_s, figures.pgd_m), (2.0, 2.5));
}

#[test]
fn truncated_sample_is_refused() {
    let bytes = fs::read(root().join("data/records/truncated.AT2")).unwrap();
    let error = record::read("truncated.AT2", &bytes, &Options::default()).unwrap_err();
    assert_eq!((error.line, error.expected.as_str()), (9, "24 values, as line 4 says"));
}

/// Values of the USGS collection, and the figures that its readers know these records by.
#[test]
fn records_of_the_examples() {
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
