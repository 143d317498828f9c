//! The plain reference against the cases: it must be right before anything is compared with it.

use crate::common::cases::all;
use crate::common::compare::{by_reference, judged};

/// Every time history of straight lines, within its stated tolerances. (Sines would only cost a
/// million samples.)
#[test]
fn reference_plain_agrees_with_every_time_history() {
    let mut failures = Vec::new();
    for case in all().iter().filter(|c| c.is_history() && !c.is_harmonic()) {
        for line in judged(case, by_reference).wrong {
            failures.push(format!("{}: {line}", case.id));
        }
    }
    assert!(failures.is_empty(), "{} differences:\n{}", failures.len(), failures.join("\n"));
}
