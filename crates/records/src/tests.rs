use proptest::prelude::*;

use super::*;
use slipstick_dynamics::notice::{Notice, NoticeKind};

const NOTHING: Options = Options { format: None, units: None, dt_s: None };

fn g() -> Options {
    Options { units: Units::parse("g"), ..NOTHING }
}

fn g_at(dt_s: f64) -> Options {
    Options { dt_s: Some(dt_s), ..g() }
}

fn ok(text: &str, options: &Options) -> Record {
    read("f", text.as_bytes(), options).unwrap_or_else(|error| panic!("{error}"))
}

fn message(text: &str, options: &Options) -> String {
    read("f", text.as_bytes(), options).expect_err("must be refused").to_string()
}

/// Values in the file's units.
fn values(channel: &Channel) -> Vec<f64> {
    channel.values.iter().map(|v| (v / channel.units.si() * 1e9).round() / 1e9).collect()
}

const HEAD: &str = "PEER NGA STRONG MOTION DATABASE RECORD\n\
    Borrego Mtn, 4/9/1968, El Centro Array #9, 180 (USGS STATION 117)\n\
    ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.2 Hz LP=unknown\n";

fn peer(last: &str) -> String {
    format!("{HEAD}{last}\n  .1E-01 -.2E-01\n 0.3D-01\n")
}

#[test]
fn every_way_to_write_count_and_step() {
    for last in [
        "NPTS=  3, DT= .01000 SEC",
        "NPTS=   3, dt=  .01000",
        "3    0.0100    NPTS, DT",
        "3 .0100 NPTS, DT",
        "NPTS=   3, DT=   .0100 SEC,                 ",
        "NPTS=   3, DT=   .0100 SEC,  -5 POLE @ .03000 HZ,   0 POLE @ .00000",
        "NPTS= 3,\tDT=\t0.0100\tSEC",
        "NPTS=3, DT=0.01SEC\r",
        "NPTS = 3 , DT = 0.01 sec",
    ] {
        let record = ok(&peer(last), &NOTHING);
        let channel = &record.channels[0];
        assert_eq!(values(channel), [0.01, -0.02, 0.03], "{last}");
        assert_eq!(channel.sampling, Sampling::Dt(0.01), "{last}");
        assert_eq!(record.describe(channel), "PEER AT2, 3 values, 0.01 s, g", "{last}");
        assert_eq!(channel.values[0], 0.01 * 9.80665);
    }
}

#[test]
fn what_a_peer_header_says() {
    let record = ok(&peer("NPTS=  3, DT= .01000 SEC"), &NOTHING);
    let channel = &record.channels[0];
    assert_eq!(channel.event.as_deref(), Some("Borrego Mtn, 4/9/1968"));
    assert_eq!(channel.station.as_deref(), Some("El Centro Array #9"));
    assert_eq!((channel.name.as_str(), channel.azimuth_deg), ("180", Some(180.0)));
    let corners = FilterCorners { high_pass_hz: Some(0.2), low_pass_hz: None };
    assert_eq!(channel.filter, corners);
    assert_eq!(record.channel("180"), Some(channel));
    assert_eq!(record.channel("1"), Some(channel));
    assert_eq!(record.channel("2"), None);
}

#[test]
fn velocity_and_displacement() {
    for (quantity, units, layout) in
        [("VELOCITY", "CM/S", "PEER VT2"), ("DISPLACEMENT", "CM", "PEER DT2")]
    {
        let text = peer("NPTS=  3, DT= .01 SEC")
            .replace("ACCELERATION", quantity)
            .replace("UNITS OF G", &format!("UNITS OF {units}"));
        let record = ok(&text, &NOTHING);
        assert_eq!(record.layout, layout);
        assert!(record.channels[0].motion().is_none());
        assert_eq!(record.channels[0].values[1], -0.02 * 0.01);
    }
}

#[test]
fn peer_faults_are_refused_with_their_place() {
    for (last, expected) in [
        (
            "NPTS=  28OO, DT= .005 SEC",
            r#"f:4:8: expected sample count after "NPTS=", found "28OO""#,
        ),
        (
            "NPTS=  4, DT= .01 SEC",
            r#"f:6:9: expected 4 values, as line 4 says, found "the end after 3""#,
        ),
        (
            "NPTS=  2, DT= .01 SEC",
            r#"f:6:2: expected no more than 2 values, as line 4 says, found "0.3D-01""#,
        ),
        ("NPTS=  3, DT= 0.0 SEC", r#"f:4:15: expected a time step > 0 s after "DT=", found "0.0""#),
        ("NPTS=  3, DT= .01 MIN", r#"f:4:19: expected "SEC" after the time step, found "MIN""#),
        ("NPTS=  3", r#"f:4:9: expected "DT=" and the time step, found "the end of the line""#),
        (
            "NPTS= 1000000000000, DT= .01",
            r#"f:4:7: expected 2 to 100 000 000 values, found "1000000000000""#,
        ),
        (
            "NPTS= 99999999, DT= .01",
            r#"f:6:9: expected 99999999 values, as line 4 says, found "the end after 3""#,
        ),
        ("NPTS= 0, DT= .01", r#"f:4:7: expected 2 to 100 000 000 values, found "0""#),
    ] {
        assert_eq!(message(&peer(last), &NOTHING), expected);
    }
    let good = peer("NPTS=  3, DT= .01 SEC");
    for (from, to, expected) in [
        ("-.2E-01", "nan", r#"f:5:10: expected a finite number, found "nan""#),
        ("-.2E-01", "-.2E-O1", r#"f:5:10: expected a finite number, found "-.2E-O1""#),
        ("-.2E-01", "1e999", r#"f:5:10: expected a finite number, found "1e999""#),
        ("UNITS OF G.", "UNITS OF H.", r#"f:3:39: expected units of acceleration, found "H.""#),
        ("UNITS OF G.", "UNITS OF CM.", r#"f:3:39: expected units of acceleration, found "CM.""#),
    ] {
        assert_eq!(message(&good.replace(from, to), &NOTHING), expected);
    }
}

/// A number cut in the middle is another number: any start of a file is refused.
#[test]
fn no_start_of_a_peer_file_is_the_whole() {
    let whole =
        format!("{HEAD}NPTS=  6, DT= .01 SEC\n .1E-01 -.2E-01  .3E-01\n .1E-01 -.2E-01  .3E-01");
    assert_eq!(ok(&whole, &NOTHING).channels[0].values.len(), 6);
    for n in 0..whole.len() {
        assert!(read("f", &whole.as_bytes()[..n], &NOTHING).is_err(), "{}", &whole[..n]);
    }
    assert_eq!(
        message(&whole[..whole.len() - 1], &NOTHING),
        "f:6:23: expected a last value written as those before it (a truncated file?), found \
         \".3E-0\""
    );
}

#[test]
fn what_a_peer_file_states_is_not_overruled() {
    let text = peer("NPTS=  3, DT= .0067 SEC");
    ok(&text, &g_at(0.0067));
    // The header has four decimals: 1/150 s is what they round.
    let finer = Options { dt_s: Some(1.0 / 150.0), ..NOTHING };
    assert_eq!(ok(&text, &finer).channels[0].sampling, Sampling::Dt(1.0 / 150.0));
    assert_eq!(
        message(&text, &g_at(0.01)),
        r#"f:4:15: expected the time step given, 0.01 s (leave it out), found ".0067""#
    );
    let gal = Options { units: Units::parse("gal"), ..NOTHING };
    assert_eq!(
        message(&text, &gal),
        r#"f:3:39: expected the units given, cm/s² (leave them out), found "G.""#
    );
    // A header that states none needs them.
    let text = "1 2 3\nNPTS= 3, DT= .01 SEC\n1 2 3\n";
    assert_eq!(ok(text, &gal).channels[0].values, [0.01, 0.02, 0.03]);
    assert!(message(text, &NOTHING).contains("add units = \"g\" to [motion] (or --units g)"));
}

#[test]
fn one_column() {
    let record = ok("0.1\n-0.2\n+.3E+000\n", &g_at(0.01));
    assert_eq!(values(&record.channels[0]), [0.1, -0.2, 0.3]);
    let described = record.describe(&record.channels[0]);
    assert_eq!(described, "text with one column, 3 values, 0.01 s, g");
    assert_eq!(
        message("0.1\n0.2\n", &NOTHING),
        "f:1:1: expected units and time step, which this file does not state: add units = \"g\" \
         and dt = \"0.01 s\" to [motion] (or --units g --dt \"0.01 s\"), found \"0.1\""
    );
    assert!(message("0.1\n0.2\n", &g()).contains("add dt = \"0.01 s\" to [motion] (or --dt"));
}

#[test]
fn count_and_step_on_the_first_line() {
    for text in ["m1\n3 0.01\n0.1\n-0.2\n0.3\n", "3 0.01\n0.01 0.1\n0.02 -0.2\n0.03 0.3\n"] {
        let record = ok(text, &g());
        assert_eq!(values(&record.channels[0]), [0.1, -0.2, 0.3]);
        assert_eq!(record.channels[0].sampling, Sampling::Dt(0.01));
    }
    assert_eq!(
        message("4 0.01\n0.1\n0.2\n0.3\n", &g()),
        r#"f:4:4: expected 4 values, as line 1 says, found "the end after 3""#
    );
    assert!(message("3 0.01\n1\n2\n3\n", &g_at(0.02)).contains("the time step given, 0.02 s"));
}

/// The header of the manual needs no other key, whatever divides it.
#[test]
fn named_columns() {
    let text = "time_s,acceleration_m_per_s2,vertical_acceleration_m_per_s2\r\n\
        0,0.0,1\r\n0.01,0.5,2\r\n0.02,-0.5,3\r\n";
    for text in [
        text.to_owned(),
        format!("\u{feff}{text}"),
        text.replace(',', ";"),
        text.replace(',', "\t"),
        text.replace(',', " , "),
        text.replace(',', ";").replace('.', ","),
        text.replace(',', "\t").replace('.', ","),
        format!("Some text, with a comma\n# and a comment\n{text}"),
        format!("{text}# the end\n\n\n"),
    ] {
        let record = ok(&text, &NOTHING);
        let [along, up] = record.channels.as_slice() else { panic!("{record:?}") };
        assert_eq!(along.name, "acceleration_m_per_s2", "{text}");
        assert_eq!(along.values, [0.0, 0.5, -0.5], "{text}");
        assert_eq!(up.name, "vertical_acceleration_m_per_s2");
        assert_eq!(up.values, [1.0, 2.0, 3.0]);
        assert_eq!(along.sampling, Sampling::Dt(0.01), "{text}");
    }
}

#[test]
fn units_in_brackets() {
    let text = "Time [ms],Acceleration [g],Velocity [m/s],Temperature [C]\n0,1,2,3\n10,4,5.0,6\n";
    let record = ok(text, &NOTHING);
    let [a, v] = record.channels.as_slice() else { panic!("{record:?}") };
    assert_eq!((a.values[1], v.values[1]), (4.0 * 9.80665, 5.0));
    assert_eq!(a.sampling, Sampling::Dt(0.01));
    assert_eq!(record.warnings[0].kind, NoticeKind::ColumnSkipped);
    assert!(message(text, &Options { units: Units::parse("gal"), ..NOTHING }).contains("leave"));
    let record = ok("# Time (s),Acceleration (g's)\n0.0,1E-4\n0.01,2E-4\n", &NOTHING);
    assert_eq!(values(&record.channels[0]), [1e-4, 2e-4]);
}

#[test]
fn jumps_and_uneven_times() {
    let record = ok("0 1\n1 1\n1 -1\n3 -1\n", &g());
    assert_eq!(record.channels[0].sampling, Sampling::Times(vec![0.0, 1.0, 1.0, 3.0]));
    let described = record.describe(&record.channels[0]);
    assert_eq!(described, "text with 2 columns, 4 values, at uneven times over 3 s, g");
    let motion = record.channels[0].motion().unwrap().unwrap();
    assert_eq!(motion.len(), 4);
}

#[test]
fn clock_starts_at_the_first_sample() {
    let record = ok("0.02 1\n0.04 2\n0.06 3\n", &g());
    assert_eq!(record.channels[0].sampling, Sampling::Dt(0.02));
}

#[test]
fn values_along_the_lines() {
    let record = ok("1 2 3 4\n3 2 1 0\n-1 0 1 2\n1 0\n*** End Data ***\n", &g_at(0.5));
    assert_eq!(
        values(&record.channels[0]),
        [1., 2., 3., 4., 3., 2., 1., 0., -1., 0., 1., 2., 1., 0.]
    );
    assert_eq!(record.warnings[0].kind, NoticeKind::ReadAlongLines);
    // Components side by side are not one series.
    let text = "1 90 -50\n2 91 -51\n1 92 -52\n2 90 -51\n";
    assert!(message(text, &g_at(0.5)).contains("look like components side by side"));
}

#[test]
fn text_faults_are_refused_with_their_place() {
    for (text, expected) in [
        ("0 1\n0.1 2\n0.2\n", r#"f:3:1: expected 2 numbers, as in the rows before, found "1""#),
        ("0 1\n0.1 2\n0.2 3 4\n", r#"f:3:1: expected 2 numbers, as in the rows before, found "3""#),
        ("0 1\n0.1 nan\n", r#"f:2:5: expected a finite number, found "nan""#),
        ("nan\n1\n", r#"f:1:1: expected a finite number, found "nan""#),
        ("1\n2\n-inf\n", r#"f:3:1: expected a finite number, found "-inf""#),
        ("1\n2\n********\n", r#"f:3:1: expected a finite number, found "********""#),
        ("1\n\n2\n", r#"f:2:1: expected a row of numbers, found "an empty line""#),
        ("0,0.5\n0.1,\n", r#"f:2:5: expected a finite number, found "the end of the line""#),
        ("1;2,5\n2;3.5\n", r#"f:2:3: expected a finite number, found "3.5""#),
        (
            "0,5\n0,7\n",
            "f:1:1: expected decimal points, or a semicolon, tab or blank between columns (this \
             may be one number or two), found \"0,5\"",
        ),
        (
            "0 1\n0.1 2\n0.2 1\n0.3 1\n0.4 1\n0.35 1\n0.5 0\n",
            r#"f:6:1: expected a time after 0.4 s (or once the same, for a jump), found "0.35""#,
        ),
        (
            "0 1\n1 1\n1 2\n1 3\n2 3\n",
            r#"f:4:1: expected a time after 1 s (or once the same, for a jump), found "1""#,
        ),
        (
            "0.5 1\n0.1 2\n0.3 1\n0.2 0\n",
            "f:2:1: expected times that increase in the first of two columns, or a header that \
             names the columns, found \"0.1\"",
        ),
        (
            "a_g,b_g,c_g\n1,2.5\n3,4.5\n",
            r#"f:1:1: expected 2 names, one a column of numbers, found "3 names""#,
        ),
        (
            "Period [sec]\tAcc [g]\n0.1\t1\n0.2\t2\n",
            "f:1:1: expected a time history, not a spectrum, found \"Period [sec]\\tAcc [g]\"",
        ),
        ("0.5\n", r#"f:1:4: expected 2 to 100 000 000 values, found "1""#),
        ("only\ntext\n", r#"f:2:5: expected numbers, found "the end of the file""#),
    ] {
        assert_eq!(message(text, &g_at(0.1)), expected, "{text}");
    }
}

/// The end-of-file mark of old systems is white space, wherever it stands.
#[test]
fn end_of_file_mark() {
    for text in ["1\n2\n\x1a", "1\n2\x1a", "1\n2\n\x1a\n", "\x1a\n1\n2\n"] {
        assert_eq!(values(&ok(text, &g_at(0.1)).channels[0]), [1.0, 2.0], "{text:?}");
    }
    assert!(message("\x1a", &g_at(0.1)).contains("an empty file"));
}

#[test]
fn dt_of_zero_is_refused() {
    for dt_s in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        assert!(message("1\n2\n", &g_at(dt_s)).contains("a time step > 0 s given as dt"));
    }
}

#[test]
fn format_can_be_forced() {
    let text = peer("NPTS=  3, DT= .01000 SEC");
    for format in Format::ALL {
        assert_eq!(Format::from_keyword(format.keyword()), Some(format));
    }
    let forced = Options { format: Some(Format::Peer), ..g_at(0.1) };
    assert!(message("1\n2\n", &forced).contains("\"NPTS=\" and \"DT=\""));
    let forced = Options { format: Some(Format::Delimited), ..g_at(0.1) };
    assert!(read("f", text.as_bytes(), &forced).is_err());
}

/// Pieces of which damaged files are made.
fn pieces() -> impl Strategy<Value = Vec<u8>> {
    const WORDS: &[&str] = &[
        "NPTS=",
        "DT=",
        "SEC",
        "UNITS OF",
        "G",
        "CM/S",
        "3",
        "0.01",
        "-1e-3",
        "1,5",
        ";",
        ",",
        "\t",
        " ",
        "\n",
        "\r\n",
        "time_s",
        "acc_g",
        "#",
        "*",
        "nan",
        "1e999",
        "99999999999999999",
        "(",
        "]",
        "\u{feff}",
        "é",
        "0",
        "0",
        "\n",
        "\n",
        "\n",
    ];
    let piece = prop_oneof![
        8 => proptest::sample::select(WORDS).prop_map(|w| w.as_bytes().to_vec()),
        1 => proptest::collection::vec(any::<u8>(), 0..4),
    ];
    proptest::collection::vec(piece, 0..60).prop_map(|pieces| pieces.concat())
}

proptest! {
    /// Whatever the bytes: a record that makes sense, or an error with a place.
    #[test]
    fn prop_any_bytes_give_a_record_or_an_error(
        bytes in prop_oneof![pieces(), proptest::collection::vec(any::<u8>(), 0..200)],
        units in any::<bool>(),
        dt_s in prop_oneof![Just(None), Just(Some(0.01)), Just(Some(f64::NAN))],
        format in prop_oneof![Just(None), Just(Some(Format::Peer)), Just(Some(Format::Delimited))],
    ) {
        let options = Options { format, units: units.then(|| Units::parse("g").unwrap()), dt_s };
        match read("f", &bytes, &options) {
            Ok(record) => {
                prop_assert!(!record.channels.is_empty());
                for channel in &record.channels {
                    prop_assert!(channel.values.len() >= 2);
                    prop_assert!(channel.values.len() <= bytes.len());
                    let _ = (record.describe(channel), channel.motion());
                }
            }
            Err(error) => prop_assert!(error.line >= 1 && error.column >= 1),
        }
    }

    /// Numbers survive being written and read, to the last bit.
    #[test]
    fn prop_written_values_read_back(values in proptest::collection::vec(-1e3..1e3_f64, 2..50)) {
        let text: String = values.iter().map(|v| format!("{v}\n")).collect();
        let options = Options { units: Units::parse("m/s2"), dt_s: Some(0.01), format: None };
        prop_assert_eq!(&ok(&text, &options).channels[0].values, &values);
        let text: String = values.iter().map(|v| format!("{v:e} ")).collect();
        let text = format!("ACCELERATION IN UNITS OF M/S2\nNPTS={},DT=.1\n{text}", values.len());
        prop_assert_eq!(&ok(&text, &NOTHING).channels[0].values, &values);
    }
}

/// Cells without anything in them are no table.
#[test]
fn rows_of_empty_cells_are_refused() {
    for text in [",,,\n", "a,b\n,\n,\n", ";;\n;;\n", "4 0.01\n,,\n,,\n", "a,b\n1,2\n,\n"] {
        assert!(read("t", text.as_bytes(), &Options::default()).is_err(), "{text:?}");
        assert!(columns("t", text.as_bytes()).is_err() || text.ends_with("1,2\n,\n"), "{text:?}");
    }
}

/// Separators, digits, quotes and words in any order are a table or an error, never a panic.
#[test]
fn prop_any_cells_give_a_table_or_an_error() {
    let words = [
        ",",
        ";",
        "\t",
        " ",
        "\n",
        "\n",
        "0",
        "1.5",
        "-2",
        "0,5",
        "a",
        "acc (g)",
        "t",
        "\"",
        "#",
        "10:00:01",
        "2025-01-02",
        "1.000",
        "nan",
        "\r\n",
        "T",
        "Sa [g]",
        ",,",
        "45000.1",
    ];
    let mut state = 1_u64;
    for _ in 0..40_000 {
        let mut text = String::new();
        for _ in 0..24 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            text.push_str(words[(state >> 33) as usize % words.len()]);
        }
        for options in [
            Options::default(),
            Options { dt_s: Some(0.01), units: Units::parse("g"), format: None },
        ] {
            let _ = read("t", text.as_bytes(), &options);
        }
        let _ = (columns("t", text.as_bytes()), target_spectrum("t", text.as_bytes()));
        let _ = text_rows("t", text.as_bytes());
    }
}

/// An SMC file of a film that was digitised where it bends: no samples a second, pairs of time and value.
#[test]
fn smc_of_uneven_times() {
    let file = |counted: usize, numbers: &[f64]| {
        let unknown = "1.7000000E+38";
        let mut text = "1 UNCORRECTED ACCELEROGRAM\n".to_owned() + &"*\n".repeat(10);
        for i in 0..48 {
            let integer = match i {
                15 => 0,
                16 => counted as i64,
                _ => -32768,
            };
            text += &format!("{integer:10}");
            text += if i % 8 == 7 { "\n" } else { "" };
        }
        for i in 0..50 {
            text += &format!("{unknown:>15}");
            text += if i % 5 == 4 { "\n" } else { "" };
        }
        for line in numbers.chunks(8) {
            line.iter().for_each(|number| text += &format!("{number:10.4}"));
            text += "\n";
        }
        text
    };
    let pairs = [0.0, 1.5, 0.02, -12.5, 0.05, 3.25, 0.0625, 0.5, 0.1, 0.0];
    let record = ok(&file(10, &pairs), &NOTHING);
    let channel = &record.channels[0];
    assert_eq!(channel.sampling, Sampling::Times(vec![0.0, 0.02, 0.05, 0.0625, 0.1]));
    assert_eq!(values(channel), [1.5, -12.5, 3.25, 0.5, 0.0]);
    // A line that is not counted stands below.
    let more = file(10, &pairs) + "    1.5000    2.0000    1.6000    3.0000\n";
    let channel = &ok(&more, &NOTHING).channels[0];
    assert_eq!(channel.values.len(), 5);
    let skipped =
        |w: &Notice| w.kind == NoticeKind::ColumnSkipped && w.message.contains("line 30,");
    assert!(channel.warnings.iter().any(skipped), "{:?}", channel.warnings);
    // Values of even steps whose rate is lost are no pairs.
    let found = message(&file(10, &[1.5, 0.2, -3.0, 0.4, 2.0, 0.1, 0.0, 0.0, 1.0, 1.0]), &NOTHING);
    assert!(found.contains("pairs of time and value") && found.contains("do not rise"), "{found}");
    assert!(read("f", file(10, &pairs[..8]).as_bytes(), &NOTHING).is_err());
}
