//! The small samples, all of one motion.

use slipstick::notice::NoticeKind;
use slipstick::record::{self, Sampling};

use super::{G, NOTHING, given, kinds, read, samples};

/// The made-up motion in g, as in the other samples.
fn motion_g() -> Vec<f64> {
    use std::f64::consts::{PI, TAU};
    let value = |k: f64| 0.2 * libm::sin(TAU * k / 24.0) * libm::sin(PI * k / 23.0);
    (0..24).map(|k| (value(f64::from(k)) * 1e6).round() / 1e6).collect()
}

/// File, units to give, what is understood of a channel, its name and its share of the motion, and
/// the last digit of the file in m/s².
type Sample = (&'static str, Option<&'static str>, &'static str, &'static str, f64, f64);

#[rustfmt::skip]
const SAMPLES: [Sample; 33] = [
    ("esm.ASC", None, "ESM DYNA, 24 values, 0.02 s, cm/s²", "HNE", 1.0, 1e-8),
    ("afad.asc", None, "AFAD DYNA, 24 values, 0.02 s, cm/s²", "HNN", 1.0, 1e-8),
    ("itaca.acc", None, "ITACA .acc, 24 values, 0.02 s, m/s²", "N90E", 1.0, 1e-7),
    ("nsmn.txt", None, "NSMN text, 24 values, 0.02 s, cm/s²", "N-S", 1.0, 1e-8),
    ("nsmn.txt", None, "NSMN text, 24 values, 0.02 s, cm/s²", "E-W", -0.5, 1e-8),
    ("nsmn.txt", None, "NSMN text, 24 values, 0.02 s, cm/s²", "U-D", 0.25, 1e-8),
    ("geonet.V1A", None, "GeoNet V1A, 24 values, 0.02 s, mm/s²", "S14E", 0.5, 1e-6),
    ("geonet.V1A", None, "GeoNet V1A, 24 values, 0.02 s, mm/s²", "Up", 0.25, 1e-6),
    ("geonet.V1A", None, "GeoNet V1A, 24 values, 0.02 s, mm/s²", "N76E", 0.5, 1e-6),
    ("geonet.V2A", None, "GeoNet V2A, 24 values, 0.02 s, mm/s²", "S16W", 0.5, 1e-6),
    ("geonet.V2A", None, "GeoNet V2A, 24 values, 0.02 s, mm/s²", "Up", -0.25, 1e-6),
    ("geonet.V2A", None, "GeoNet V2A, 24 values, 0.02 s, mm/s²", "S74E", 0.5, 1e-6),
    ("unam.asa", None, "UNAM ASA 2.0, 24 values, 0.02 s, cm/s²", "V", 0.25, 1e-5),
    ("unam.asa", None, "UNAM ASA 2.0, 24 values, 0.02 s, cm/s²", "N90E", 1.0, 1e-5),
    ("unam.asa", None, "UNAM ASA 2.0, 24 values, 0.02 s, cm/s²", "N00E", -0.5, 1e-5),
    ("csmnc.dat", None, "CSMNC, 24 values, 0.02 s, cm/s²", "EW", 1.0, 1e-6),
    ("csmnc-fixed.dat", None, "CSMNC, 24 values, 0.02 s, cm/s²", "EW", 1.0, 1e-5),
    ("cwa.dat", None, "CWA, 24 values, 0.02 s, cm/s²", "U", 0.25, 1e-5),
    ("cwa.dat", None, "CWA, 24 values, 0.02 s, cm/s²", "N", 1.0, 1e-5),
    ("cwa.dat", None, "CWA, 24 values, 0.02 s, cm/s²", "E", -0.5, 1e-5),
    ("little.sac", Some("m/s2"), "SAC, 24 values, 0.02 s, m/s²", "XX.XXXX.00.HNE", 1.0, 1e-6),
    ("big.sac", Some("m/s2"), "SAC, 24 values, 0.02 s, m/s²", "XX.XXXX.00.HNE", 1.0, 1e-6),
    ("version7.sac", Some("m/s2"), "SAC, 24 values, 0.02 s, m/s²", "XX.XXXX.00.HNE", 1.0, 1e-6),
    ("uneven.sac", Some("m/s2"), "SAC, 24 values, at uneven times over 0.47 s, m/s²", "XX.XXXX.00.HNE", 1.0, 1e-6),
    ("text.sac", Some("m/s2"), "SAC alphanumeric, 24 values, 0.02 s, m/s²", "XX.XXXX.00.HNE", 1.0, 1e-6),
    ("steim1.mseed", Some("1e-5 g"), "MiniSEED 2, 24 values, 0.02 s, 1e-5 g", "XX.XXXX.00.HNE", 1.0, 1e-4),
    ("steim2.mseed", Some("1e-5 g"), "MiniSEED 2, 24 values, 0.02 s, 1e-5 g", "XX.XXXX.00.HNE", 1.0, 1e-4),
    ("steim2-little.mseed", Some("1e-5 g"), "MiniSEED 2, 24 values, 0.02 s, 1e-5 g", "XX.XXXX.00.HNE", 1.0, 1e-4),
    ("numbers.mseed", Some("1e-5 g"), "MiniSEED 2, 24 values, 0.02 s, 1e-5 g", "XX.XXXX.00.HNE", 1.0, 1e-4),
    ("numbers.mseed", Some("1e-5 g"), "MiniSEED 2, 24 values, 0.02 s, 1e-5 g", "XX.XXXX.00.HNN", 1.0, 1e-4),
    ("numbers.mseed", Some("1e-5 g"), "MiniSEED 2, 24 values, 0.02 s, 1e-5 g", "XX.XXXX.00.HNZ", 1.0, 1e-4),
    ("numbers.mseed", Some("1e-5 g"), "MiniSEED 2, 24 values, 0.02 s, 1e-5 g", "XX.XXXX.00.HN1", 1.0, 1e-4),
    ("version3.mseed", Some("1e-5 g"), "MiniSEED 3, 24 values, 0.02 s, 1e-5 g", "XX.XXXX.00.HNE", 1.0, 1e-4),
];

#[test]
fn every_sample_is_the_same_motion() {
    for (file, units, understood, name, share, last_digit) in SAMPLES {
        let options = units.map_or(NOTHING, given);
        let record = read(&samples(), file, &options);
        let channel = record.channel(name).unwrap_or_else(|| panic!("{file} {name}"));
        assert_eq!(record.describe(channel), understood, "{file}");
        for (found, g) in channel.values.iter().zip(motion_g()) {
            let expected = share * g * G;
            assert!((found - expected).abs() <= 0.51 * last_digit, "{file}: {found} {expected}");
        }
        let known = ["first_sample_not_zero", "record_drift", "duplicate_rows", "times_rounded"];
        assert!(
            kinds(channel).iter().all(|kind| known.contains(kind)),
            "{file}: {:?}",
            channel.warnings
        );
    }
}

/// Counts with their mean taken off, one count being 6.3e-6 m/s².
#[test]
fn knet_samples() {
    let mean = motion_g().iter().sum::<f64>() / 24.0;
    for (file, layout, name, azimuth, share) in
        [("knet.EW", "K-NET", "E-W", Some(90.0), 1.0), ("kiknet.UD2", "KiK-net", "UD2", None, -0.5)]
    {
        let record = read(&samples(), file, &NOTHING);
        let channel = &record.channels[0];
        let understood = format!("{layout}, 24 values, 0.02 s, cm/s²");
        assert_eq!(record.describe(channel), understood);
        assert_eq!((channel.name.as_str(), channel.azimuth_deg), (name, azimuth));
        assert!(channel.values.iter().sum::<f64>().abs() < 1e-9);
        for (found, g) in channel.values.iter().zip(motion_g()) {
            let expected = share * (g - mean) * G;
            assert!((found - expected).abs() < 6.4e-6, "{file}: {found} {expected}");
        }
        assert_eq!(channel.warnings[0].kind, NoticeKind::MeanRemoved);
        assert_eq!(channel.event.as_deref(), Some("2000/01/01 00:00:00 M5.0"));
    }
}

#[test]
fn what_the_samples_say_beside_their_values() {
    let record = read(&samples(), "esm.ASC", &NOTHING);
    let channel = &record.channels[0];
    assert_eq!(channel.event.as_deref(), Some("NOWHERE 20000101 Mw5.0"));
    assert_eq!(channel.station.as_deref(), Some("XX ABC Made up: a station"));
    assert_eq!(channel.filter.high_pass_hz.zip(channel.filter.low_pass_hz), Some((0.1, 20.0)));
    let afad = read(&samples(), "afad.asc", &NOTHING);
    assert_eq!(afad.channels[0].filter, record::FilterCorners::default());
    let velocity = read(&samples(), "esm-velocity.ASC", &NOTHING);
    assert_eq!(velocity.describe(&velocity.channels[0]), "ESM DYNA, 24 values, 0.02 s, cm/s");
    let integral = |a: &[f64], v: &[f64], digit: f64| {
        let mut sum = 0.0;
        for k in 1..a.len() {
            sum += 0.01 * (a[k - 1] + a[k]);
            assert!((sum - v[k]).abs() < digit, "{k}: {sum} {}", v[k]);
        }
    };
    integral(&channel.values, &velocity.channels[0].values, 2e-8);
    let geonet = read(&samples(), "geonet.V2A", &NOTHING);
    let names: Vec<&str> = geonet.channels.iter().map(|c| c.name.as_str()).collect();
    let up = ["Up", "Up velocity", "Up displacement"];
    assert_eq!((names.len(), &names[3..6]), (9, &up[..]));
    integral(&geonet.channels[0].values, &geonet.channels[1].values, 1e-6);
    let unam = read(&samples(), "unam.asa", &NOTHING);
    assert_eq!(kinds(&unam.channels[1])[0], "duplicate_rows");
    let gap = read(&samples(), "gap.mseed", &given("1e-5 g"));
    let segments: Vec<(&str, usize)> =
        gap.channels.iter().map(|c| (c.name.as_str(), c.values.len())).collect();
    let expected = [("XX.XXXX.00.HNE 1", 10), ("XX.XXXX.00.HNE 2", 14), ("XX.XXXX.00.HNZ", 24)];
    assert_eq!(segments, expected);
    assert_eq!(kinds(&gap.channels[0])[..2], ["gap", "gap"]);
    let numbers = read(&samples(), "numbers.mseed", &NOTHING);
    assert_eq!(numbers.warnings[0].message, "ASCII text in XX.XXXX.00.LOG, left out");
    let times = match &read(&samples(), "uneven.sac", &given("g")).channels[0].sampling {
        Sampling::Times(times_s) => times_s.clone(),
        Sampling::Dt(dt_s) => vec![*dt_s],
    };
    assert_eq!((times.len(), times[11], times[12]), (24, 0.22, 0.25));
}
