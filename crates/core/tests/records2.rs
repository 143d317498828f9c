//! Real files of networks, SAC and MiniSEED, compared with the table that came with them. They are
//! not part of the repository: see `records.rs`.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use slipstick::record::{self, Channel, Options, Record, Sampling, Units};

const G: f64 = 9.80665;
const NOTHING: Options = Options { format: None, units: None, dt_s: None };

/// The folder, or `None` and a line that says so.
#[allow(clippy::disallowed_macros, reason = "tests say what they skip on their own output")]
fn folder(test: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/records");
    let folder = std::env::var_os("SLIPSTICK_RECORDS").map_or(beside, PathBuf::from);
    if folder.join("index.csv").is_file() {
        return Some(folder.join("formats"));
    }
    println!("skipped: {test}");
    None
}

fn bytes(folder: &Path, file: &str) -> Vec<u8> {
    fs::read(folder.join(file)).unwrap()
}

fn read(folder: &Path, file: &str, options: &Options) -> Record {
    record::read(file, &bytes(folder, file), options).unwrap_or_else(|error| panic!("{error}"))
}

fn given(units: &str) -> Options {
    Options { units: Units::parse(units), ..NOTHING }
}

/// Largest size of a channel's values in its units.
fn peak(channel: &Channel) -> f64 {
    channel.values.iter().fold(0.0_f64, |peak, v| peak.max(v.abs())) / channel.units.si()
}

fn kinds(channel: &Channel) -> Vec<&str> {
    channel.warnings.iter().map(|w| w.kind).collect()
}

/// File, channel, units, step, count, PGA in g and peak in the file's units: rows of the index.
type Row = (&'static str, &'static str, &'static str, f64, usize, f64, f64);

#[rustfmt::skip]
const ROWS: [Row; 27] = [
    ("knet_kiknet/CHB0021412312349.EW", "E-W", "cm/s²", 0.01, 6800, 0.006_981_75, 6.846_76),
    ("knet_kiknet/CHB0021412312349.NS", "N-S", "cm/s²", 0.01, 6800, 0.003_944_42, 3.868_16),
    ("knet_kiknet/CHB0021412312349.UD", "U-D", "cm/s²", 0.01, 6800, 0.008_014_2, 7.859_24),
    ("knet_kiknet/NGNH311106302345.EW1", "EW1", "cm/s²", 0.01, 12_000, 0.000_195_642, 0.191_86),
    ("knet_kiknet/NGNH311106302345.EW2", "EW2", "cm/s²", 0.01, 12_000, 0.000_722_106, 0.708_144),
    ("knet_kiknet/test.knet", "E-W", "cm/s²", 0.01, 5900, 0.004_469_7, 4.383_28),
    ("esm_dyna/HL.DLFA..HNE.D.20190728.160908.C.ACC.ASC", "HNE", "cm/s²", 0.005, 13_876, 0.000_232_468, 0.227_973),
    ("esm_dyna/HL.DLFA..HNN.D.20190728.160908.C.ACC.ASC", "HNN", "cm/s²", 0.005, 13_876, 0.000_193_921, 0.190_172),
    ("esm_dyna/HL.DLFA..HNZ.D.20190728.160908.C.ACC.ASC", "HNZ", "cm/s²", 0.005, 13_876, 0.000_212_924, 0.208_807),
    ("afad/20101114230825_3104_ap_RawAcc_E.asc", "HNE", "cm/s²", 0.01, 5600, 0.001_664_15, 1.631_97),
    ("afad/20230206011732_0131_ap_Acc_E.asc", "HNE", "cm/s²", 0.01, 12_500, 0.166_899, 163.672),
    ("afad/20230206011732_0131_ap_Acc_N.asc", "HNN", "cm/s²", 0.01, 12_500, 0.147_525, 144.673),
    ("afad/20230206011732_0131_ap_Acc_U.asc", "HNZ", "cm/s²", 0.01, 12_500, 0.048_501, 47.5632),
    ("afad_old_nsmn/20170720223109_0921.txt", "N-S", "cm/s²", 0.01, 28_683, 0.013_460_6, 13.2003),
    ("afad_old_nsmn/20170720223109_0921.txt", "E-W", "cm/s²", 0.01, 28_683, 0.012_403_7, 12.1638),
    ("afad_old_nsmn/20170720223109_0921.txt", "U-D", "cm/s²", 0.01, 28_683, 0.010_034_6, 9.840_57),
    ("itaca_sisma_acc/16840_H1.cor.acc", "NS", "m/s²", 0.005, 12_400, 0.001_021_96, 0.010_022),
    ("geonet/20180212_211557_WPWS_20.V2A", "S16W", "mm/s²", 0.02, 5800, 0.004_242_02, 41.6),
    ("geonet/20180212_211557_WPWS_20.V2A", "S74E", "mm/s²", 0.02, 5800, 0.019_782_5, 194.0),
    ("geonet/20180212_211557_WPWS_20.V2A", "Up", "mm/s²", 0.02, 5800, 0.002_783_83, 27.3),
    ("unam_asa2/CUP50401.012", "V", "cm/s²", 0.004, 17_500, 0.000_479_267, 0.47),
    ("unam_asa2/CUP50401.012", "N90E", "cm/s²", 0.004, 17_500, 0.001_212_44, 1.189),
    ("unam_asa2/CUP50401.012", "N00E", "cm/s²", 0.004, 17_500, 0.001_239_97, 1.216),
    ("csmnc_china/ua0004.dat", "EW", "cm/s²", 0.005, 8800, 0.003_326_78, 3.262_46),
    ("cwa_taiwan/2-ECU.dat", "U", "cm/s²", 0.02, 6000, 0.001_219_58, 1.196),
    ("cwa_taiwan/2-ECU.dat", "N", "cm/s²", 0.02, 6000, 0.002_988_79, 2.931),
    ("cwa_taiwan/2-ECU.dat", "E", "cm/s²", 0.02, 6000, 0.002_866_42, 2.811),
];

/// The header of the Mexican file states 17500 rows: the index counts two more, which repeat.
#[test]
fn records_networks_read_as_their_index_says() {
    let Some(folder) = folder("records_networks_read_as_their_index_says") else { return };
    for (file, name, units, dt_s, npts, pga_g, native) in ROWS {
        let record = read(&folder, file, &NOTHING);
        let channel = record.channel(name).unwrap_or_else(|| panic!("{file} {name}"));
        let place = format!("{file}: {}", record.describe(channel));
        assert_eq!(channel.values.len(), npts, "{place}");
        assert_eq!(channel.sampling, Sampling::Dt(dt_s), "{place}");
        assert_eq!(channel.units.to_string(), units, "{place}");
        assert!((peak(channel) / native - 1.0).abs() < 1e-5, "{place}: {}", peak(channel));
        let pga = peak(channel) * channel.units.si() / G;
        assert!((pga / pga_g - 1.0).abs() < 1e-5, "{place}: {pga}");
    }
}

/// Velocity and displacement of a corrected file are channels of their own; the file's velocity is
/// the integral of its acceleration but for what printing rounds.
#[test]
fn records_corrected_file_has_all_its_blocks() {
    let Some(folder) = folder("records_corrected_file_has_all_its_blocks") else { return };
    let record = read(&folder, "geonet/20180212_211557_WPWS_20.V2A", &NOTHING);
    let names: Vec<&str> = record.channels.iter().map(|c| c.name.as_str()).collect();
    let of =
        |name: &str| [name.to_owned(), format!("{name} velocity"), format!("{name} displacement")];
    assert_eq!(names, ["S16W", "S74E", "Up"].map(of).concat());
    let stated = [41.6, 1.65, 0.131, 194.0, 5.09, 0.279, 27.3, 0.91, 0.042];
    let last_digits = [0.1, 0.01, 0.001].into_iter().cycle();
    for ((channel, stated), last_digit) in record.channels.iter().zip(stated).zip(last_digits) {
        assert!(
            (peak(channel) - stated).abs() <= 0.501 * last_digit,
            "{}: {}",
            channel.name,
            peak(channel)
        );
        assert_eq!(channel.values.len(), 5800);
        assert_eq!(channel.filter.high_pass_hz, Some(0.175));
    }
    assert_eq!(record.channels[0].azimuth_deg, Some(196.0));
    let [a, v] = [&record.channels[3].values, &record.channels[4].values];
    let (mut integral, mut worst) = (v[0], 0.0_f64);
    for k in 1..a.len() {
        integral += 0.01 * (a[k - 1] + a[k]);
        worst = worst.max((integral - v[k]).abs());
    }
    // Of 5.1 mm/s: the network filters velocity once more.
    assert!(worst < 3e-4, "{worst}");
}

/// Counts, first and last samples and their sum as ObsPy 1.5.1 reads them (`obspy.read(file)`).
#[test]
#[rustfmt::skip]
fn obspy_miniseed_samples() {
    let Some(folder) = folder("obspy_miniseed_samples") else { return };
    type Expected = (&'static str, usize, f64, [f64; 3], [f64; 2], f64);
    let one_to_50 = |file| (file, 50, 1.0, [1.0, 2.0, 3.0], [49.0, 50.0], 1275.0);
    let files: Vec<(&str, Vec<Expected>)> = vec![
        ("CI.CLC..HNE.mseed", vec![("CI.CLC..HNE", 39_001, 0.01, [-37_966.0, -38_147.0, -38_181.0], [-40_282.0, -37_299.0], -1_484_833_333.0)]),
        ("brokenlastrecord.mseed", vec![("NL.HGN.00.BHZ", 5980, 0.025, [2787.0, 2776.0, 2774.0], [2857.0, 2863.0], 16_640_837.0)]),
        ("gaps.mseed", vec![
            ("BW.BGLD..EHE 1", 412, 0.005, [-363.0, -382.0, -388.0], [-360.0, -389.0], -165_813.0),
            ("BW.BGLD..EHE 2", 824, 0.005, [-427.0, -416.0, -393.0], [-393.0, -388.0], -323_433.0),
            ("BW.BGLD..EHE 3", 824, 0.005, [-396.0, -399.0, -387.0], [-395.0, -390.0], -322_497.0),
            ("BW.BGLD..EHE 4", 50_668, 0.005, [-389.0, -428.0, -409.0], [-432.0, -405.0], -19_969_707.0),
        ]),
        ("float32_Float32_bigEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
        ("float32_Float32_littleEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
        ("int16_INT16_bigEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
        ("int32_INT32_littleEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
        ("int32_Steim1_bigEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
        ("int32_Steim1_littleEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
        ("int32_Steim2_bigEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
        ("int32_Steim2_littleEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
        ("float64_Float64_bigEndian.mseed", vec![one_to_50("XX.TEST..BHE")]),
    ];
    for (file, expected) in files {
        let record = read(&folder, &format!("miniseed/{file}"), &NOTHING);
        let found: Vec<&str> = record.channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(found, expected.iter().map(|e| e.0).collect::<Vec<_>>(), "{file}");
        for (channel, (name, count, dt_s, first, last, sum)) in record.channels.iter().zip(expected) {
            let v = &channel.values;
            assert_eq!((v.len(), &channel.sampling), (count, &Sampling::Dt(dt_s)), "{file} {name}");
            assert_eq!((&v[..3], &v[v.len() - 2..]), (&first[..], &last[..]), "{file} {name}");
            assert_eq!(v.iter().sum::<f64>(), sum, "{file} {name}");
        }
    }
    // 213945 counts per m/s² (StationXML); 0.343 g after the mean, as the index says.
    let clc = read(&folder, "miniseed/CI.CLC..HNE.mseed", &given("4.674098e-6 m/s2"));
    let v = &clc.channels[0].values;
    let mean = v.iter().sum::<f64>() / v.len() as f64;
    let pga = v.iter().fold(0.0_f64, |p, v| p.max((v - mean).abs()));
    assert!((pga - 3.367).abs() < 5e-4, "{pga}");
}

#[test]
fn records_miniseed_traps() {
    let Some(folder) = folder("records_miniseed_traps") else { return };
    let gaps = read(&folder, "miniseed/gaps.mseed", &NOTHING);
    assert!(gaps.channels.iter().all(|c| kinds(c).contains(&"gap")));
    let broken = read(&folder, "miniseed/brokenlastrecord.mseed", &NOTHING);
    assert_eq!(broken.warnings[0].kind, "truncated");
    let message = |file: &str| {
        record::read(file, &bytes(&folder, &format!("miniseed/{file}")), &NOTHING)
            .unwrap_err()
            .to_string()
    };
    assert!(message("not.mseed").contains("control header of a SEED volume"));
    assert!(message("fullASCII_bigEndian.mseed").contains("ASCII text"));
    assert!(record::read("CI.CLC.xml", &bytes(&folder, "miniseed/CI.CLC.xml"), &NOTHING).is_err());
}

/// Counts, values and headers as ObsPy 1.5.1 reads them.
#[test]
fn obspy_sac_samples() {
    let Some(folder) = folder("obspy_sac_samples") else { return };
    let unknown = record::read("f", &bytes(&folder, "sac/test.sac"), &NOTHING).unwrap_err();
    assert!(unknown.expected.contains("add units = "), "{unknown}");
    for (file, name, dt_s, count, first, last, largest) in [
        (
            "20190706031952.CJ.T001230.HNE.sac",
            "CJ.T001230..HNE",
            0.02,
            15_001,
            0.022_479_3,
            0.021_762_65,
            0.043_384,
        ),
        ("null_terminated.sac", "GD.PIN1..LYE", 1.0, 10, -22_859.0, -22_498.0, 25_646.0),
        ("test.sac", ".STA..Q", 1.0, 100, -8.742_277_7e-8, 0.309_007_35, 1.0),
        ("test.sac.swap", ".STA..Q", 1.0, 100, -8.742_277_7e-8, 0.309_007_35, 1.0),
        // README of the collection calls it uneven; its header says equal steps, as ObsPy reads it.
        ("testxy.sac", ".sta..Q", 1.0, 100, -8.742_278e-8, 0.309_007_3, 1.0),
    ] {
        let record = read(&folder, &format!("sac/{file}"), &given("m/s2"));
        let channel = &record.channels[0];
        assert_eq!(
            (channel.name.as_str(), &channel.sampling),
            (name, &Sampling::Dt(dt_s)),
            "{file}"
        );
        let v = &channel.values;
        assert_eq!(
            (v.len(), v[0] as f32, v[count - 1] as f32, peak(channel) as f32),
            (count, first, last, largest),
            "{file}"
        );
        assert!(!kinds(channel).contains(&"peak_differs"), "{file}");
    }
    let csn = read(&folder, "sac/20190706031952.CJ.T001230.HNE.sac", &given("g"));
    assert_eq!(
        (csn.channels[0].azimuth_deg, csn.channels[0].values[0]),
        (Some(90.0), f64::from(0.022_479_3_f32) * G)
    );
    let pin = read(&folder, "sac/null_terminated.sac", &given("m/s2"));
    assert!(kinds(&pin.channels[0]).contains(&"quantity_differs"));
    let none = record::read("f", &bytes(&folder, "sac/non_ascii.sac"), &given("g")).unwrap_err();
    assert_eq!(
        none.to_string(),
        "f, byte 316: expected 2 to 100 000 000 values (NPTS), found \"0\""
    );
}

/// The made-up motion in g, as in the other samples.
fn motion_g() -> Vec<f64> {
    use std::f64::consts::{PI, TAU};
    let value = |k: f64| 0.2 * libm::sin(TAU * k / 24.0) * libm::sin(PI * k / 23.0);
    (0..24).map(|k| (value(f64::from(k)) * 1e6).round() / 1e6).collect()
}

fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/records")
}

/// File, units to give, what is understood of a channel, its name and its share of the motion, and
/// the last digit of the file in m/s².
type Sample = (&'static str, Option<&'static str>, &'static str, &'static str, f64, f64);

#[rustfmt::skip]
const SAMPLES: [Sample; 31] = [
    ("esm.ASC", None, "ESM DYNA, 24 values, 0.02 s, cm/s²", "HNE", 1.0, 1e-8),
    ("afad.asc", None, "AFAD DYNA, 24 values, 0.02 s, cm/s²", "HNN", 1.0, 1e-8),
    ("itaca.acc", None, "ITACA .acc, 24 values, 0.02 s, m/s²", "N90E", 1.0, 1e-7),
    ("nsmn.txt", None, "NSMN text, 24 values, 0.02 s, cm/s²", "N-S", 1.0, 1e-8),
    ("nsmn.txt", None, "NSMN text, 24 values, 0.02 s, cm/s²", "E-W", -0.5, 1e-8),
    ("nsmn.txt", None, "NSMN text, 24 values, 0.02 s, cm/s²", "U-D", 0.25, 1e-8),
    ("geonet.V1A", None, "GeoNet V1A, 24 values, 0.02 s, mm/s²", "S14E", 0.5, 1e-6),
    ("geonet.V1A", None, "GeoNet V1A, 24 values, 0.02 s, mm/s²", "Up", 0.25, 1e-6),
    ("geonet.V2A", None, "GeoNet V2A, 24 values, 0.02 s, mm/s²", "S16W", 0.5, 1e-6),
    ("geonet.V2A", None, "GeoNet V2A, 24 values, 0.02 s, mm/s²", "Up", -0.25, 1e-6),
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
fn exact_every_sample_is_the_same_motion() {
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
fn exact_knet_samples() {
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
        assert_eq!(channel.warnings[0].kind, "mean_removed");
        assert_eq!(channel.event.as_deref(), Some("2000/01/01 00:00:00 M5.0"));
    }
}

#[test]
fn exact_what_the_samples_say_beside_their_values() {
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
    assert_eq!((names.len(), &names[3..]), (6, &up[..]));
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

/// A header that is changed is refused, or what was read is not as if it had not been.
#[test]
#[rustfmt::skip]
fn exact_changed_headers_are_noticed() {
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
        ("itaca.acc", "of Data                : 24", "of Data                : 23", "23 values"),
        ("nsmn.txt", "(gal)", "(g)", "a peak of"),
        ("nsmn.txt", ": 24", ": 23", "no more than 69 values"),
        ("geonet.V1A", "1.00 mm/s/s", "2.00 mm/s/s", "a peak of"),
        ("geonet.V1A", "units of 1.00 mm", "units of 1.00 cm", "a peak of"),
        ("geonet.V1A", "points     24", "points     25", "the number of points that line 10"),
        ("geonet.V2A", "at 0.020 sec", "at 0.010 sec", "the step of 0.01 s that line 11 states"),
        ("unam.asa", "/24/24/24", "/24/25/24", "75 values, as line 72 says"),
        ("unam.asa", "/24/24/24", "/23/23/23", "no more than 23 values, as line 72 says"),
        ("unam.asa", "Gal (cm", "g (cm", "a peak of"),
        ("unam.asa", "/0.02/0.02/0.02", "/0.01/0.01/0.01", "the rate of a step of 0.01 s"),
        ("unam.asa", ": 3\r", ": 2\r", "as many channels as orientations, 3"),
        ("csmnc.dat", "CM/SEC/SEC", "MM/SEC/SEC", "a peak of"),
        ("csmnc.dat", "POINTS:    24", "POINTS:    23", "7 values on this line"),
        ("csmnc.dat", "POINTS:    24", "POINTS:    32", "32 values, as line 12 says"),
        ("cwa.dat", "(Hz): 50", "(Hz): 25", "no more than 48 values"),
        ("cwa.dat", "gal.", "g.", "a peak of"),
        ("cwa.dat", "U(+); N(+); E(+)", "U(+); N(-); E(+)", "columns such as"),
        ("cwa.dat", "(sec): 0.48", "(sec): 1e15", "a length of 2 to 100 000 000 values"),
        ("text.sac", "        24", "        23", "4 values on this line"),
    ] {
        let text = bytes(&samples(), file);
        let at = text.windows(from.len()).position(|w| w == from.as_bytes());
        let at = at.unwrap_or_else(|| panic!("{file}: {from}"));
        let changed = [&text[..at], to.as_bytes(), &text[at + from.len()..]].concat();
        let options = if file == "text.sac" { given("g") } else { NOTHING };
        let error = record::read(file, &changed, &options).err();
        let error = error.unwrap_or_else(|| panic!("{file}: {to} is read"));
        let all = format!("{} {}", error.expected, error.found);
        assert!(all.contains(expected), "{file} {to}: {error}");
    }
    // What the caller says of a file that says it itself.
    for file in ["esm.ASC", "knet.EW", "geonet.V2A", "unam.asa", "csmnc.dat", "cwa.dat", "nsmn.txt", "itaca.acc"] {
        let text = bytes(&samples(), file);
        let error = |options: &Options| record::read(file, &text, options).unwrap_err().expected;
        assert!(error(&given("ft/s2")).contains("(leave them out)"), "{file}");
        assert!(error(&Options { dt_s: Some(0.01), ..NOTHING }).contains("(leave it out)"), "{file}");
    }
}

/// A header of SAC that promises more or fewer values than there are, or other steps.
#[test]
fn exact_changed_sac_headers_are_noticed() {
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
/// unless all that is missing are blanks.
#[test]
fn prop_no_prefix_reads_as_the_whole() {
    for (name, bytes, options) in all_samples() {
        let whole = record::read(&name, &bytes, &options).ok();
        let of_others = ["AT2", "VT2", "csv", "txt"].iter().any(|e| name.ends_with(e));
        if of_others && name != "nsmn.txt" {
            continue;
        }
        let step = (bytes.len() / 2000).max(1);
        for end in (0..bytes.len()).step_by(step) {
            let Ok(read) = record::read(&name, &bytes[..end], &options) else { continue };
            let blank = bytes[end..].iter().all(|b| b.is_ascii_whitespace() || *b == 0);
            // Rows that repeat the last one are not read.
            let repeats = name == "unam.asa" && end + 64 > bytes.len();
            assert!(blank || repeats || Some(&read) != whole.as_ref(), "{name} to {end}");
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
