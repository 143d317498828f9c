//! Records that are none: one message with its place.

use super::support::{BLOCK, Folder, RECORD, RECORDED};

const AT2: &str = "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1999\n\
                   ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   5, DT=   .0100 SEC\n\
                   0.1E+00 0.2E+00 0.3E+00 0.4E+00 0.5E+00\n";

/// The message for a record, run with an output folder that must not stay.
fn of_record(test: &str, bytes: impl AsRef<[u8]>) -> String {
    let folder = Folder::with_model(test, RECORDED);
    folder.write("record.csv", bytes);
    folder.refused(&["run", "model.toml", "--out", "out"])
}

#[test]
fn record_that_is_no_text() {
    for (test, bytes, expected) in [
        ("empty", b"" as &[u8], "record.csv:1:1: expected a record, found \"an empty file\""),
        ("blank", b" \r\n\n", "record.csv:1:1: expected a record, found \"an empty file\""),
        (
            "utf16",
            b"\xff\xfet\0i\0m\0e\0\n\0",
            // Read as the text that it is, which has no numbers.
            "record.csv:1:5: expected numbers, found \"the end of the file\"",
        ),
        (
            "binary",
            b"\x7fELF\x02\x01\x01\0\0\0\0",
            "record.csv:1:5: expected a text file, found \"byte 0x02 (a binary file?)\"",
        ),
    ] {
        assert_eq!(of_record(&format!("record-{test}"), bytes), expected);
    }
}

#[test]
fn record_with_wrong_values() {
    for (test, text, place) in [
        ("nan", RECORD.replace("-5", "nan"), "record.csv:4:3: "),
        ("infinity", RECORD.replace("-5", "inf"), "record.csv:4:3: "),
        ("overflow", RECORD.replace("-5", "1e999"), "record.csv:4:3: "),
        ("word", RECORD.replace("-5", "five"), "record.csv:4:3: "),
        ("backwards", RECORD.replace("\n2,", "\n0.5,"), "record.csv:4:1: "),
        ("ragged", RECORD.replace("2,-5", "2"), "record.csv:"),
        ("one", RECORD.replace("1,5\n2,-5\n3,0\n", ""), "record.csv:"),
        ("points", AT2.replace("NPTS=   5", "NPTS=   6"), "record.csv:5:40: "),
        ("more", AT2.replace("NPTS=   5", "NPTS=   4"), "record.csv:5:33: "),
        ("step", AT2.replace(".0100", ".0000"), "record.csv:4:18: "),
        ("count", AT2.replace("NPTS=   5", "NPTS=  5O"), "record.csv:4:8: "),
        ("huge", AT2.replace("NPTS=   5", "NPTS=1000000000000"), "record.csv:"),
        ("cut", AT2.replace("0.5E+00\n", "0.5"), "record.csv:5:"),
    ] {
        let found = of_record(&format!("record-{test}"), text);
        assert!(found.starts_with(place) && found.contains("expected"), "{test}: {found}");
    }
}

#[test]
fn record_with_fewer_points_than_its_header_says() {
    assert_eq!(
        of_record("fewer", AT2.replace("NPTS=   5", "NPTS=   6")),
        "record.csv:5:40: expected 6 values, as line 4 says, found \"the end after 5\""
    );
}

#[test]
fn record_that_cannot_be_scaled() {
    let folder = Folder::with_model("zero", &format!("{RECORDED}scale_to = \"0.3 g\"\n"));
    folder.write("record.csv", "time_s,acceleration_m_per_s2\n0,0\n1,0\n2,0\n");
    assert_eq!(
        folder.refused(&["run", "model.toml", "--out", "out"]),
        "model.toml:10:12: motion.scale_to: expected a record that is not zero throughout, found a \
         peak of 0 m/s²"
    );
    assert_eq!(
        folder.refused(&["run", "model.toml", "--motion", "record.csv", "--scale-to", "1 g"]),
        "record.csv: scale_to: expected a motion that is not zero throughout, its peak is 0 m/s²"
    );
}

#[test]
fn vertical_record_is_named() {
    let folder = Folder::with_model("vertical", &format!("{RECORDED}vertical = \"up.csv\"\n"));
    folder.write("record.csv", RECORD);
    assert_eq!(
        folder.refused(&["run", "model.toml"]),
        "model.toml:10:12: motion.vertical: expected a file that can be read, found up.csv: there \
         is no such file or folder"
    );
    folder.write("up.csv", "");
    let found = folder.refused(&["run", "model.toml"]);
    assert_eq!(found, "up.csv:1:1: expected a record, found \"an empty file\"");
}

fn at2(event: &str, station: &str, component: &str, peak: f64) -> String {
    format!(
        "PEER NGA STRONG MOTION DATABASE RECORD\n{event}, {station}, {component}\nACCELERATION TIME SERIES IN UNITS OF G\n\
         NPTS=   5, DT=   .1000 SEC\n 0.0 {peak} -{peak} {peak} 0.0\n"
    )
}

/// A folder that holds all three components of a station is no suite of horizontal motions.
#[test]
fn vertical_components_are_no_records_of_a_suite() {
    let folder = Folder::with_model("records-vertical", BLOCK);
    folder.write("all/RSN68_PEL090.AT2", at2("San Fernando", "LA - Hollywood", "090", 0.2));
    folder.write("all/RSN68_PEL-UP.AT2", at2("San Fernando", "LA - Hollywood", "UP", 0.1));
    folder.write(
        "plan.toml",
        "model = \"model.toml\"\n[records]\nfiles = [\"all/*.AT2\"]\nscale = [1.0]\n",
    );
    let up = "all/RSN68_PEL-UP.AT2: expected a horizontal component";
    let suite = ["run", "model.toml", "--records", "all"];
    let spectrum =
        ["spectrum", "model.toml", "--records", "all", "--over", "slider.spring=1,2 kN/m"];
    for arguments in [&suite[..], &spectrum, &["study", "plan.toml", "--out", "out"]] {
        let refused = folder.refused(arguments);
        assert!(refused.starts_with(up), "{refused}");
    }
    let beside = ["run", "model.toml", "--records", "all/*090.AT2", "--vertical", "all/*UP.AT2"];
    folder.stdout(&beside);
}

/// The components of a pair are of one earthquake and two files.
#[test]
fn pairs_are_of_one_event_and_two_files() {
    let folder = Folder::with_model("records-pairs", BLOCK);
    folder.write("x.AT2", at2("KOBE 01/16/95", "SHIN-OSAKA", "000", 0.2));
    folder.write("y.AT2", at2("KOBE 01/16/95", "SHIN-OSAKA", "090", 0.15));
    folder.write("other.AT2", at2("KOCAELI 08/17/99", "ARCELIK", "090", 0.15));
    folder.write("copy.AT2", at2("KOBE 01/16/95", "SHIN-OSAKA", "000", 0.2));
    let pair = |second: &str| {
        folder.refused(&["run", "model.toml", "--records", "x.AT2", "--second", second])
    };
    assert_eq!(
        pair("x.AT2"),
        "x.AT2: expected the other component of x.AT2, found the same motion"
    );
    assert_eq!(
        pair("copy.AT2"),
        "copy.AT2: expected the other component of x.AT2, found the same motion"
    );
    assert_eq!(
        pair("other.AT2"),
        "other.AT2: expected the other component of x.AT2, found components of the earthquakes \
         \"KOBE 01/16/95\" and \"KOCAELI 08/17/99\""
    );
    folder.stdout(&["run", "model.toml", "--records", "x.AT2", "--second", "y.AT2"]);
    // The same motion under two names counts twice in every share: said, not refused.
    let text = folder.stdout(&["run", "model.toml", "--records", "x.AT2", "y.AT2", "copy.AT2"]);
    let words: Vec<&str> = text.split_whitespace().collect();
    let said = "x.AT2 and copy.AT2 are the same motion";
    assert!(words.join(" ").contains(said), "{text}");
}
