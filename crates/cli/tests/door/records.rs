//! Records that are none: one message with its place.

use super::support::{Folder, RECORD, RECORDED};

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
fn exact_record_that_is_no_text() {
    for (test, bytes, expected) in [
        ("empty", b"" as &[u8], "record.csv:1:1: expected a record, found \"an empty file\""),
        ("blank", b" \r\n\n", "record.csv:1:1: expected a record, found \"an empty file\""),
        (
            "utf16",
            b"\xff\xfet\0i\0m\0e\0\n\0",
            "record.csv:1:1: expected text in UTF-8 or ASCII, found \"UTF-16\"",
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
fn exact_record_with_wrong_values() {
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
fn exact_record_with_fewer_points_than_its_header_says() {
    assert_eq!(
        of_record("fewer", AT2.replace("NPTS=   5", "NPTS=   6")),
        "record.csv:5:40: expected 6 values, as line 4 says, found \"the end after 5\""
    );
}

#[test]
fn exact_record_that_cannot_be_scaled() {
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
fn exact_vertical_record_is_named() {
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
