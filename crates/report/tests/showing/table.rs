//! The plain-text table: aligned, complete, safe for a terminal.

use crate::support::{frame_model, rough_motion, run, run_times};
use slipstick_report::DisplayUnits;
use slipstick_report::table::table;

#[test]
fn columns_are_aligned_and_lines_fit() {
    let nominal = run("mock-up", frame_model(2, 1.0), rough_motion(10.0, 0.01));
    let bound = |factor| {
        run_times("mock-up", frame_model(2, factor), rough_motion(10.0, 0.01), factor).summary
    };
    let summary = nominal.summary.clone().with_bounds(bound(0.8), bound(1.3));
    for display in [DisplayUnits::Si, DisplayUnits::SiG, DisplayUnits::KnMm, DisplayUnits::Us] {
        let text = table(&summary, &nominal.model, "PEER AT2, 1001 values, 0.01 s, g", display);
        let head = text.lines().find(|line| line.contains("nominal")).expect("a head");
        let end = head.chars().count();
        let mut rows = 0;
        for line in text.lines() {
            assert!(line.chars().count() <= 100, "{line}");
            assert!(!line.ends_with(' ') && !line.contains('\t'), "{line}");
            if line.starts_with("Peak") || line.starts_with("Storey") {
                rows += 1;
                assert_eq!(line.trim_end_matches('*').chars().count(), end, "{line}");
            }
        }
        assert!(rows >= 14, "{rows} rows");
        for needed in ["x 0.8", "x 1.3", "* governs", "Check    passed", "gap_exceeded", "1e-10"] {
            assert!(text.contains(needed), "{needed}\n{text}");
        }
    }
}

#[test]
fn one_run_has_one_column_and_its_units() {
    let case = run("mock-up", frame_model(1, 1.0), rough_motion(10.0, 0.01));
    let text = table(&case.summary, &case.model, "a record", DisplayUnits::Us);
    assert!(!text.contains("nominal") && !text.contains('*'));
    let line = text.lines().find(|line| line.starts_with("Peak sliding displacement")).expect("it");
    let inches = case.summary.demands.peak_sliding_displacement_m / 0.0254;
    let words: Vec<&str> = line.split_whitespace().collect();
    assert_eq!(words[3], "in");
    let shown: f64 = words[4].parse().expect("a number");
    assert!((shown - inches).abs() < 1e-3 * inches);
}

#[test]
fn names_cannot_drive_a_terminal() {
    let case = run("evil \u{1b}[2J\nname", frame_model(0, 1.0), rough_motion(2.0, 0.01));
    let text = table(&case.summary, &case.model, "record \u{7}", DisplayUnits::Si);
    assert!(text.chars().all(|c| c == '\n' || !c.is_control()));
    assert!(text.starts_with(r"evil \u{1b}[2J\nname  (slipstick "), "{text}");
    assert!(text.is_char_boundary(text.len()) && text.ends_with('\n'));
}
