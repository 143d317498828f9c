//! Modes as other programs write them: what is understood of their tables, and what is refused.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used, clippy::panic)]

use proptest::prelude::*;
use slipstick::input::{ModalOptions, ModalTable, Share, read_modes};

const SAP2000: &str = include_str!("../../../../examples/structures/sap2000-layout.csv");
const ETABS: &str = include_str!("../../../../examples/structures/etabs-layout.csv");
const REPORT: &str = include_str!("../../../../examples/structures/opensees-modal.txt");
const EIGENVECTORS: &str =
    include_str!("../../../../examples/structures/opensees-eigenvectors.csv");

fn read(text: &str) -> ModalTable {
    read_modes(&[("export.csv", text)], &ModalOptions::default()).expect("a table")
}

fn refused(text: &str) -> String {
    read_modes(&[("export.csv", text)], &ModalOptions::default()).expect_err("a fault").to_string()
}

fn participation(table: &ModalTable, mode: usize, axis: usize) -> f64 {
    match table.modes[mode].shares[axis] {
        Some(Share::Participation(l)) => l,
        other => panic!("no participation but {other:?}"),
    }
}

/// The building of csi-layouts.py: nine modes, all of its mass; `Σ L φ = 1` along and 0 across at every point.
fn is_the_building(table: &ModalTable, of_mass: f64, of_sums: f64) {
    assert_eq!((table.modes.len(), table.points.len()), (9, 3));
    for mass_kg in table.mass_kg {
        let mass_kg = mass_kg.expect("from factors and ratios");
        assert!((mass_kg / 1200e3 - 1.0).abs() < of_mass, "{mass_kg}");
    }
    for point in &table.points {
        for (along, wanted) in [(0, 1.0), (1, 0.0)] {
            for axis in 0..2 {
                let shape = point.shapes[axis].as_ref().expect("both directions");
                let sum: f64 = (0..9).map(|j| participation(table, j, along) * shape[j]).sum();
                let wanted = if axis == 0 { wanted } else { 1.0 - wanted };
                assert!((sum - wanted).abs() < of_sums, "{}: {sum}", point.name);
            }
        }
    }
}

#[test]
fn modes_in_the_layout_of_sap2000() {
    let table = read(SAP2000);
    // Nine ratios of six decimals; factors of six decimals times shapes of nine.
    is_the_building(&table, 4.5e-6, 1e-6);
    assert_eq!(table.modes[0].period_s, 0.326394);
    let l = -2.363389e3 / 1000f64.sqrt();
    assert!((participation(&table, 0, 0) - l).abs() < 1e-9 * l.abs());
    let names: Vec<&str> = table.points.iter().map(|point| point.name.as_str()).collect();
    assert_eq!(names, ["c1", "c2", "c3"]);
    assert_eq!(
        table.read[0],
        "Modal Periods And Frequencies: 9 rows; Sec, Cyc/sec, rad/sec, rad2/sec2"
    );
}

#[test]
fn modes_in_the_layout_of_etabs_with_decimals_after_a_comma() {
    let table = read(ETABS);
    // Nine ratios of four decimals.
    is_the_building(&table, 4.5e-4, 1e-6);
    assert_eq!(table.modes[0].period_s, 0.326);
    // Two of its joints, one by its story and label, by other names.
    let options = ModalOptions {
        points: vec![
            ("Top".to_owned(), "Roof 7".to_owned()),
            ("Base floor".to_owned(), "107".to_owned()),
        ],
        ..Default::default()
    };
    let table = read_modes(&[("e.csv", ETABS)], &options).expect("a table");
    let names: Vec<&str> = table.points.iter().map(|point| point.name.as_str()).collect();
    assert_eq!(names, ["base_floor", "top"]);
}

#[test]
fn tables_may_stand_in_several_files() {
    let parts: Vec<String> =
        SAP2000.split("TABLE:").skip(1).map(|part| format!("TABLE:{part}")).collect();
    let files: Vec<(&str, &str)> = parts.iter().map(|part| ("part.csv", part.as_str())).collect();
    let table = read_modes(&files, &ModalOptions::default()).expect("a table");
    assert_eq!(table, read(SAP2000));
}

#[test]
fn ratios_alone_have_no_signs_and_say_so() {
    let start = SAP2000.find("TABLE:  \"Modal Participating").expect("ratios");
    let end = SAP2000.find("TABLE:  \"Modal Participation F").expect("factors");
    let table = read(&SAP2000[start..end]);
    assert_eq!(table.modes[1].shares[0], Some(Share::Ratio(0.804896)));
    assert_eq!(table.mass_kg, [None; 2]);
    assert!(table.notes.iter().any(|note| note.contains("modes 1, 2, 3")), "{:?}", table.notes);
    let csv = table.to_csv();
    let header = "period_s,effective_mass_ratio_x,effective_mass_ratio_y\n0.326394,0.004655,0.8759";
    assert!(csv.starts_with(header), "{csv}");
}

#[test]
fn table_of_ours_reads_back_as_it_was_written() {
    let written = read(SAP2000);
    let read = read_modes(&[("modes.csv", &written.to_csv())], &ModalOptions::default());
    let read = read.expect("a table");
    assert_eq!((read.format.as_str(), read.modes.len(), read.points.len()), ("modes.csv", 9, 3));
    for (one, other) in written.modes.iter().zip(&read.modes) {
        assert!((one.period_s / other.period_s - 1.0).abs() < 1e-15);
    }
    for j in 0..9 {
        let [one, other] = [&written, &read].map(|table| participation(table, j, 0));
        assert!((one.abs() / other - 1.0).abs() < 1e-14);
        // A mode may be turned round.
        for (point, back) in written.points.iter().zip(&read.points) {
            let [x, again] = [point, back].map(|p| p.shapes[0].as_ref().expect("along x")[j]);
            assert!((x * one - again * other).abs() < 1e-14 * (x * one).abs());
        }
    }
    let text = "period_s,damping_ratio,effective_mass_ratio\n0.5,0.05,0.8\n";
    let read = read_modes(&[("modes.csv", text)], &ModalOptions::default()).expect("a table");
    assert!((read.sum(0, None).expect("a ratio") - 0.8).abs() < 1e-15);
}

/// Four digits are printed: the sum of what was rounded is divided away, and that is said.
#[test]
fn sums_that_rounding_alone_lifts_above_one() {
    let text = "Case,Mode,Period,UX,UY,SumUX\n,,sec,,,\nModal,1,0.5,0.9001,0.9,0.9\nModal,2,0.1,0.1000,0,1\n";
    let table = read(text);
    assert_eq!(table.modes[1].shares[0], Some(Share::Ratio(0.1 / (0.9001 + 0.1))));
    assert!(table.notes.iter().any(|note| note.contains("rounding")), "{:?}", table.notes);
}

#[test]
fn faults_of_exported_tables_are_told_where_they_are() {
    let good = "TABLE: Modal Participating Mass Ratios\nCase,Mode,Period,UX,UY,UZ\n,,sec,,,\n\
                Modal,1,0.5,0.8,0,0\nModal,2,0.2,0.15,0,0\n";
    assert_eq!(read(good).modes.len(), 2);
    for (name, from, to, place) in [
        (
            "negative",
            "0.8",
            "-0.8",
            "4:13: expected a ratio of effective mass from 0 to 1, found \"-0.8\"",
        ),
        (
            "sum",
            "0.15",
            "0.35",
            "5:13: expected ratios of effective mass along x that sum to at most 1",
        ),
        ("short", ",0.15,0,0", ",0.15,0", "5:1: expected 6 values, as the header has, found 5"),
        ("order", "0.2,", "0.6,", "5:9: expected a period of at most 0.5 s"),
        (
            "skipped",
            "Modal,2",
            "Modal,3",
            "5:7: expected mode 2: modes stand in their order, found mode 3",
        ),
        ("zero", "0.5,", "0,", "4:9: expected a finite period > 0, found 0 s"),
        ("complex", "0.2,", "0.2+1i,", "5:9: expected a finite number, found \"0.2+1i\""),
        (
            "unit",
            ",,sec,,,\n",
            "",
            "2:11: expected a unit of \"period\" in the line below the names",
        ),
        ("unit", "sec", "ells", "2:11: expected a unit of \"period\", such as sec, found \"ells\""),
        (
            "case",
            "Modal,2",
            "Ritz,2",
            "5:1: expected one modal case, \"Modal\" or \"Ritz\": add --case",
        ),
        ("none", "UX,UY,", "A,B,", "2:1: expected a column UX or UY"),
    ] {
        let message = refused(&good.replacen(from, to, 1));
        assert!(message.starts_with(&format!("export.csv:{place}")), "{name}: {message}");
    }
    let lacking = SAP2000.lines().filter(|line| !line.contains("C2,MODAL,LinModal,Mode,9"));
    let message = refused(&lacking.collect::<Vec<_>>().join("\n"));
    assert!(
        message.contains("expected 9 modes at this joint, as the other tables have, found 8"),
        "{message}"
    );
    let factors = SAP2000.find("TABLE:  \"Modal Participation F").expect("factors");
    let shapes = SAP2000.find("TABLE:  \"Joint").expect("shapes");
    let message = refused(&format!("{}{}", &SAP2000[..factors], &SAP2000[shapes..]));
    assert!(
        message.contains("expected beside it the table \"Modal Participation Factors\""),
        "{message}"
    );
    let message = refused("a,b\n1,2\n");
    assert!(
        message
            .starts_with("export.csv:1:1: expected the table \"Modal Participating Mass Ratios\""),
        "{message}"
    );
}

fn opensees(report: &str) -> Result<ModalTable, slipstick::error::InputError> {
    let options = ModalOptions { mass_unit_kg: Some(1e3), ..Default::default() };
    read_modes(&[("modal.txt", report), ("eigenvectors.csv", EIGENVECTORS)], &options)
}

/// The frame of opensees-frame.py: of unit modal mass in t, so that L is Γ √(1000 kg).
#[test]
fn opensees_report_and_eigenvectors() {
    let table = opensees(REPORT).expect("a table");
    assert_eq!((table.modes.len(), table.points.len()), (8, 5));
    assert_eq!(table.mass_kg, [Some(242.4e3); 2]);
    let root = 1000f64.sqrt();
    // Six digits are printed.
    assert!((participation(&table, 0, 1) / (-12.9 * root) - 1.0).abs() < 1e-5);
    assert!((participation(&table, 4, 0) / (-6.8511 * root) - 1.0).abs() < 1e-5);
    let shape = table.points[0].shapes[1].as_ref().expect("along y");
    assert!((shape[0] / (-0.015137882910162853 / root) - 1.0).abs() < 1e-5);
    // Eight of its modes, which lack 2 % of the mass along x and y.
    let top = &table.points[3];
    assert_eq!(top.name, "40");
    let shape = top.shapes[0].as_ref().expect("along x");
    let sum: f64 = (0..8).map(|j| participation(&table, j, 0) * shape[j]).sum();
    assert!((sum - 1.0).abs() < 0.1, "{sum}");
    let csv = table.to_csv();
    assert!(csv.starts_with("period_s,participation_x,participation_y,10_x,10_y,20_x,"), "{csv}");
}

/// A report of all modes, whose masses of six digits sum to a little more than there is.
#[test]
fn modes_that_sum_to_more_by_their_last_digit_have_all_of_the_mass() {
    let more = REPORT.replacen("166.41 ", "169.819 ", 1);
    let table = opensees(&more).expect("a table");
    let sum = table.sum(1, None).expect("a mass");
    assert!((sum - 1.0).abs() < 1e-15, "{sum}");
    let note = table.notes.last().expect("a note");
    assert!(note.starts_with("the effective masses along y sum to 1.0000"), "{note}");
}

#[test]
fn opensees_faults_are_told_where_they_are() {
    let message = |report: &str| opensees(report).expect_err("a fault").to_string();
    for (from, to, said) in [
        ("0.731758", "inf", "modal.txt:11:64: expected a finite number, found \"inf\""),
        ("0.731758", "0.531758", "modal.txt:12:64: expected a period of at most 0.531758 s"),
        (
            "* 7. MODAL PARTICIPATION MASSES:",
            "* 7. OTHER:",
            "expected the section \"MODAL PARTICIPATION MASSES\"",
        ),
        (
            "166.41 ",
            "266.41 ",
            "expected participation masses that sum to at most the total free mass",
        ),
        ("172.486", "-172.486", "expected a mass ≥ 0, found -172.486"),
    ] {
        let message = message(&REPORT.replacen(from, to, 1));
        assert!(message.contains(said), "{from}: {message}");
    }
    let options = ModalOptions::default();
    let error = read_modes(&[("modal.txt", REPORT)], &options).expect_err("no unit");
    assert!(error.to_string().contains("add --mass-unit"), "{error}");
}

proptest! {
    /// Whatever becomes of a file on its way, there is an answer or an error.
    #[test]
    fn prop_damaged_files_never_panic(
        which in 0..3_usize, at in 0..20_000_usize, length in 0..200_usize, put in "[-0-9.,;*#\"eTé\n ]{0,6}",
    ) {
        let text = [SAP2000, ETABS, REPORT][which];
        let mut chars: Vec<char> = text.chars().collect();
        let at = at % chars.len();
        let end = (at + length).min(chars.len());
        chars.splice(at..end, put.chars());
        let damaged: String = chars.into_iter().collect();
        let options = ModalOptions { mass_unit_kg: Some(1.0), ..Default::default() };
        let _ = read_modes(&[("damaged", &damaged)], &options);
        let _ = read_modes(&[("report", REPORT), ("damaged", &damaged)], &options);
    }
}
