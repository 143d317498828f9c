//! The chapter "The paper, reproduced": Markdown with figures, and the claims as JSON.
//!
//! Every number of the chapter comes from [`Paper`]; the same paper gives the same bytes.

mod doc;
mod friction;
mod graphs;
mod histories;
mod iteration;
mod offset;
mod opening;
mod storey;
mod suite;
mod window;

use crate::{Claim, Paper, Verdict};

use doc::Doc;
use slipstick_report::json::Json;
use slipstick_report::number::significant;
use slipstick_report::plot::Svg;

/// The chapter and its figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Chapter {
    /// Markdown; it shows its figures from the folder `figures` beside it.
    pub markdown: String,
    /// File names and drawings.
    pub figures: Vec<(String, Svg)>,
}

/// Writes the chapter.
#[must_use]
pub fn chapter(paper: &Paper) -> Chapter {
    let mut doc = Doc::default();
    opening::write(&mut doc, paper);
    storey::write(&mut doc, paper);
    window::write(&mut doc, paper);
    offset::write(&mut doc, paper);
    friction::write(&mut doc, paper);
    iteration::write(&mut doc, paper);
    suite::write(&mut doc, paper);
    let (markdown, figures) = doc.finish();
    Chapter { markdown: format!("{}\n", markdown.trim_end()), figures }
}

/// The claims as an array of `{id, section, claim, paper_value, computed_value, unit, rule, verdict,
/// why}`, in the order of the paper; values are null where there is none.
#[must_use]
pub fn claims_json(paper: &Paper) -> String {
    Json::List(paper.claims.iter().map(object).collect()).to_pretty()
}

/// The verdicts as plain text: their counts, then one line a claim.
#[must_use]
pub fn listing(paper: &Paper) -> String {
    let mut text = String::new();
    for verdict in [Verdict::Agrees, Verdict::Differs, Verdict::CannotBeChecked] {
        text.push_str(&format!("{:>4}  {}\n", paper.count(verdict), verdict.words()));
    }
    text.push('\n');
    for claim in &paper.claims {
        let value = |value: Option<f64>| value.map_or_else(String::new, |v| significant(v, 4));
        text.push_str(&format!(
            "{:<18} {:<26} {:>9} {:>9} {}\n",
            claim.verdict.words(),
            claim.id,
            value(claim.paper_value),
            value(claim.computed_value),
            claim.unit
        ));
    }
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    format!("{}\n", lines.join("\n"))
}

fn object(claim: &Claim) -> Json {
    Json::Object(vec![
        ("id", claim.id.as_str().into()),
        ("section", claim.section.into()),
        ("claim", claim.claim.as_str().into()),
        ("paper_value", claim.paper_value.into()),
        ("computed_value", claim.computed_value.into()),
        ("unit", claim.unit.into()),
        ("rule", claim.rule.as_str().into()),
        ("verdict", claim.verdict.words().into()),
        ("why", claim.why.as_str().into()),
    ])
}
