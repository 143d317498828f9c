//! What the chapter is, its verdicts, and both solvers on every test.

use crate::{Grid, Paper, Verdict};

use super::doc::{Doc, computed_value, fixed, paper_value, short, signed};
use super::histories;
use slipstick_report::number::{compact, printed};

/// Claims of this part, by the beginnings of their names.
const CLAIMS: [&str; 10] = [
    "eq1",
    "fig3",
    "fig4",
    "fig5",
    "fig6",
    "fig9-histories",
    "fig10-histories",
    "fig11-histories",
    "fig12",
    "measured-agreement",
];

pub fn write(doc: &mut Doc, paper: &Paper) {
    doc.heading(1, "The paper, reproduced");
    doc.paragraph(
        "The model of this program comes from one paper ([SDS](references.md)): shaking-table \
         tests of a sliding block, alone and with an oscillator on it, and a program that \
         predicted them. This chapter computes its experiments again and judges its claims, one by \
         one. `slipstick paper -o DIR` writes the chapter with its figures and `claims.json`; every \
         number below was put there by that command, and two runs give the same bytes.",
    );
    if paper.grid == Grid::Quick {
        doc.paragraph("**Written with `--quick`**: the ranges are scanned more coarsely.");
    }
    doc.heading(2, "Verdicts");
    verdicts(doc, paper);
    doc.paragraph(
        "*Agrees*: the computed number lies within half a unit of the last printed digit, or within \
         the band that the claim's rule states for words such as \"about\"; a statement without a \
         number is judged by a figure and a band that its rule names. *Differs*: it does not; the \
         size of the difference and what it comes from are computed. *Cannot be checked*: the paper \
         leaves out a datum; it is named, with what its range would do.",
    );
    doc.paragraph(
        "Much is lost. The text has no figure left, so no measured history; it states neither \
         amplitude, duration nor start of any table motion, no step of its program, no scatter of \
         its coefficients. Sliding displacements are drawn here as U − X1, the paper's way; \
         elsewhere s = X1 − U.",
    );
    doc.paragraph("What differs; the reasons stand with each claim further down:");
    let rows = paper.claims.iter().filter(|claim| claim.verdict == Verdict::Differs).map(|claim| {
        vec![
            claim.section.to_owned(),
            claim.claim.clone(),
            paper_value(claim),
            computed_value(claim),
        ]
    });
    doc.table(&["section", "claim", "paper", "computed"], 2, rows.collect());
    doc.heading(2, "Both solvers on every test");
    tests(doc, paper);
    doc.claims(paper.claims_of(&["eq1"]));
    doc.heading(2, "Figures 3 to 6 and 9 to 12");
    doc.paragraph(
        "The measured lines are lost; what remains are two predictions: exact, and stepwise as the \
         paper's program made it. Where they cover each other the figure shows one line. The paper \
         states no size of any table motion: the amplitudes are ours. Of the two certified springs \
         figure 3 shows the one with pre-stress. In figures 4, 6 and 12 Taft 111 stands for the \
         paper's Kern County motion, and in figure 12 the oscillator is ours too.",
    );
    for test in &paper.drawn {
        let figure = histories::figure(test);
        let exact = &test.exact.demands;
        let stepwise = test.stepwise.as_ref().map_or_else(
            || "; the stepwise iteration fails".to_owned(),
            |response| {
                let s = response.demands.residual_sliding_displacement_m;
                format!(", stepwise {} mm", signed(-1e3 * s, 2))
            },
        );
        let table = test.exact.history.as_ref().map_or(0.0, |history| {
            history.table_acceleration_m_per_s2.iter().fold(0.0, |peak: f64, a| peak.max(a.abs()))
        });
        let caption = format!(
            "As figure {}: {}. Table peak {} m/s². Residual U − X1 of the whole run: exact {} mm{stepwise}.",
            test.figure,
            test.name,
            fixed(table, 2),
            signed(-1e3 * exact.residual_sliding_displacement_m, 2),
        );
        doc.figure(&figure, &caption);
    }
    doc.claims(paper.claims_of(&CLAIMS[1..]).filter(|claim| is_history(&claim.id)));
}

/// `fig5` is a test of this part, `fig5-no-offset` is not.
fn is_history(id: &str) -> bool {
    !id.starts_with("fig") || !id.contains('-') || id.ends_with("-histories")
}

fn verdicts(doc: &mut Doc, paper: &Paper) {
    let mut sections: Vec<&str> = Vec::new();
    for claim in &paper.claims {
        let first = claim.section.split(',').next().unwrap_or_default();
        if !sections.contains(&first) {
            sections.push(first);
        }
    }
    let all = [Verdict::Agrees, Verdict::Differs, Verdict::CannotBeChecked];
    let mut rows: Vec<Vec<String>> = sections
        .iter()
        .map(|section| {
            let of = |verdict: Verdict| {
                let here = paper.claims.iter().filter(|claim| {
                    claim.verdict == verdict && claim.section.split(',').next() == Some(section)
                });
                here.count().to_string()
            };
            std::iter::once((*section).to_owned()).chain(all.map(of)).collect()
        })
        .collect();
    let total = all.map(|verdict| format!("**{}**", paper.count(verdict)));
    rows.push(std::iter::once("**all**".to_owned()).chain(total).collect());
    doc.table(&["section", "agrees", "differs", "cannot be checked"], 1, rows);
}

fn tests(doc: &mut Doc, paper: &Paper) {
    let worst = paper.tests.iter().map(|t| t.certificate).fold(0.0, f64::max);
    let held = paper.tests.iter().filter(|t| t.certified).count();
    doc.paragraph(&format!(
        "All {} models of `examples/paper`, as they stand there. Each cell gives the exact value \
         and what the stepwise program adds to it. {held} of {} exact responses pass the check, the \
         worst figure of a certificate being {}.",
        paper.tests.len(),
        paper.tests.len(),
        printed(worst, 2),
    ));
    let rows = paper.tests.iter().map(|test| {
        let exact = &test.exact;
        let other = test.stepwise.as_ref().ok().map(|(demands, _)| demands);
        let pair = |of: &dyn Fn(&slipstick::response::Demands) -> f64, decimals: usize| {
            let base = of(exact);
            let added = other.map_or("–".to_owned(), |d| signed(of(d) - base, decimals));
            format!("{} {added}", fixed(base, decimals))
        };
        let storey = exact.storeys.first().map_or_else(String::new, |_| {
            pair(&|d| d.storeys.first().map_or(0.0, |s| s.peak_acceleration_m_per_s2), 3)
        });
        let iterations = match &test.stepwise {
            Ok((_, iterations)) => format!("{}, {}", fixed(iterations.mean, 2), iterations.max),
            Err(_) => "fails".to_owned(),
        };
        vec![
            short(&test.name),
            compact((test.pga_m_per_s2 * 1e3).round() / 1e3),
            pair(&|d| d.peak_block_acceleration_m_per_s2, 3),
            storey,
            pair(&|d| 1e3 * d.peak_sliding_displacement_m, 2),
            pair(&|d| 1e3 * d.residual_sliding_displacement_m, 2),
            iterations,
        ]
    });
    doc.table(
        &[
            "test",
            "table, m/s²",
            "block, m/s²",
            "storey, m/s²",
            "peak sliding, mm",
            "residual, mm",
            "iterations mean, max",
        ],
        1,
        rows.collect(),
    );
    for test in &paper.tests {
        if let Err(reason) = &test.stepwise {
            doc.paragraph(&format!("The stepwise program fails on {}: {reason}.", test.name));
        }
    }
}
