//! The plain reference against the cases: it must be right before anything is compared with it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::disallowed_methods,
    clippy::disallowed_macros,
    reason = "a test may panic, print, read the clock and compare with the platform's functions"
)]

mod common;

use common::cases::all;
use common::compare::{by_reference, comparisons, failures};

/// Every time history of straight lines, within its stated tolerances. (Sines would only cost a
/// million samples.)
#[test]
fn reference_plain_agrees_with_every_time_history() {
    let mut found = Vec::new();
    for case in all().iter().filter(|c| c.is_history() && !c.is_harmonic()) {
        for line in failures(&comparisons(case, by_reference)) {
            found.push(format!("{}: {line}", case.id));
        }
    }
    assert!(found.is_empty(), "{} differences:\n{}", found.len(), found.join("\n"));
}
