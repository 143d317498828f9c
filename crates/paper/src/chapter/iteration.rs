//! The stepwise iteration.

use crate::Paper;

use super::doc::{Doc, fixed};
use slipstick_report::number::{compact, typeset};

pub fn write(doc: &mut Doc, paper: &Paper) {
    doc.heading(2, "The iteration");
    doc.paragraph(
        "The paper's program iterates the accelerations of each step until they change by less than \
         δ, and needs about six turns. All mock-ups and motions by δ and step: mean number a step, \
         the largest in one step, and runs given up after 200 in one step. The last two columns are \
         the oscillators held by the table, where the iteration is linear.",
    );
    let rows = paper.iterations.iter().map(|cell| {
        vec![
            compact(1e3 * cell.dt_s),
            typeset(&format!("{:.0e}", cell.tolerance_m_per_s2)).replace("1\u{202f}×\u{202f}", ""),
            fixed(cell.mean, 2),
            cell.max.to_string(),
            format!("{} of {}", cell.failures, cell.runs),
            format!("{}, {}", fixed(cell.held_mean, 2), cell.held_max),
            cell.held_failures.to_string(),
        ]
    });
    doc.table(
        &[
            "step, ms",
            "δ, m/s²",
            "mean",
            "largest",
            "given up",
            "held: mean, largest",
            "held: given up",
        ],
        0,
        rows.collect(),
    );
    doc.claims(paper.claims_of(&["six-", "usually-converges", "instability"]));
}
