//! The plain reference against the cases: it must be right before anything is compared with it.

mod common;

use common::cases::all;
use common::values::{judged, values};
use common::compare::{by_reference, differences};

/// Every time history within its stated tolerances.
#[test]
fn reference_plain_agrees_with_every_time_history() {
    let mut failures = Vec::new();
    for case in all().iter().filter(|c| c.is_history() && !c.is_harmonic()) {
        let start = std::time::Instant::now();
        for line in differences(case, by_reference) {
            failures.push(format!("{}: {line}", case.id));
        }
        println!("{} {:.3} s", case.id, start.elapsed().as_secs_f64());
    }
    assert!(failures.is_empty(), "{} differences:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn reference_plain_values() {
    for case in all().iter().filter(|c| !c.is_history()) {
        let start = std::time::Instant::now();
        let x = values(case, by_reference, 200);
        for (name, error, tolerance) in judged(case, &x, 200) {
            println!("{} {} {name}: {error:.2e} {tolerance:.2e}", if error <= tolerance {"ok"} else {"BAD"}, case.id);
        }
        println!("{} {:.3} s", case.id, start.elapsed().as_secs_f64());
    }
}
