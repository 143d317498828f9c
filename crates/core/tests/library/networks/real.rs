//! Real files.

use slipstick::notice::NoticeKind;
use slipstick::record::{self, Sampling};

use super::{G, NOTHING, ROWS, bytes, folder, given, kinds, peak, read};

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
    assert_eq!(broken.warnings[0].kind, NoticeKind::Truncated);
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
        ("test.sac", ".STA..Q", 1.0, 100, -8.742_278e-8, 0.309_007_35, 1.0),
        ("test.sac.swap", ".STA..Q", 1.0, 100, -8.742_278e-8, 0.309_007_35, 1.0),
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
