//! The chapter "The paper, reproduced": Markdown with figures, and the claims as JSON.
//!
//! Its prose is `chapter/paper.md`; every number comes from [`Paper`]; the same paper gives the same
//! bytes.

mod graphs;
mod histories;
mod markdown;
mod tables;

use crate::fill::fill;
use crate::{Claim, Paper, PaperError, Verdict};

use slipstick_report::json::{each, pretty};
use slipstick_report::number::significant;
use slipstick_report::plot::{Figure, Svg};
use slipstick_report::view;

const TEMPLATE: &str = include_str!("chapter/paper.md");

/// The chapter and its figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Chapter {
    /// Markdown; it shows its figures from the folder `figures` beside it.
    pub markdown: String,
    /// File names and drawings.
    pub figures: Vec<(String, Svg)>,
}

/// Writes the chapter.
///
/// # Errors
/// [`PaperError::Text`] for a template that does not fit the paper, which tests rule out.
pub fn chapter(paper: &Paper) -> Result<Chapter, PaperError> {
    let histories: Vec<Figure> = paper.drawn.iter().map(histories::drawn).collect();
    let windows = graphs::windows(paper);
    let single = graphs::single(paper);
    let mut values = tables::values(paper, &histories, &windows);
    for figure in &single {
        values.push((figure.id.to_owned(), markdown::image(figure).into()));
    }
    for line in TEMPLATE.lines().filter(|line| line.starts_with("{claims ")) {
        let list = line.trim_start_matches('{').trim_end_matches('}');
        values.push((list.to_owned(), markdown::claims(listed(paper, list)?).into()));
    }
    let markdown = markdown::refilled(&fill("paper.md", TEMPLATE, &values)?);
    let figures = histories.iter().chain(windows.iter().map(|(_, figure)| figure)).chain(&single);
    let figures = figures.map(|figure| (format!("{}.svg", figure.id), figure.to_svg())).collect();
    Ok(Chapter { markdown, figures })
}

/// The claims of a list, `claims fig3 steel-*`, in the order of the paper.
fn listed<'a>(paper: &'a Paper, list: &str) -> Result<Vec<&'a Claim>, PaperError> {
    let fits = |claim: &Claim, id: &str| match id.strip_suffix('*') {
        Some(start) => claim.id.starts_with(start),
        None => claim.id == id,
    };
    let ids: Vec<&str> = list.split(' ').skip(1).collect();
    for id in &ids {
        if !paper.claims.iter().any(|claim| fits(claim, id)) {
            return Err(PaperError::text("paper.md", format!("a claim {id}"), "none"));
        }
    }
    Ok(paper.claims.iter().filter(|claim| ids.iter().any(|id| fits(claim, id))).collect())
}

/// The claims as an array of `{id, section, claim, paper_value, computed_value, unit, rule, verdict,
/// why}`, in the order of the paper; values are null where there is none.
#[must_use]
pub fn claims_json(paper: &Paper) -> String {
    pretty(&each(&paper.claims, |claim| {
        view! {
            id: &claim.id,
            section: &claim.section,
            claim: &claim.claim,
            paper_value: claim.paper_value,
            computed_value: claim.computed_value,
            unit: &claim.unit,
            rule: &claim.rule,
            verdict: claim.verdict.words(),
            why: &claim.why,
        }
    }))
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
