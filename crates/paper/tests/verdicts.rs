//! The paper, reproduced on a reduced grid: no verdict changes, no claim is left out, two runs give
//! the same bytes.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use std::sync::OnceLock;
use std::thread;

use slipstick::study::engine::Engine;
use slipstick_paper::chapter::{chapter, claims_json, listing};
use slipstick_paper::{Grid, Paper, Shake, Verdict, paper_library, reproduce};

/// Two runs of their own.
fn papers() -> &'static [Paper; 2] {
    static PAPERS: OnceLock<[Paper; 2]> = OnceLock::new();
    PAPERS.get_or_init(|| {
        let run = || {
            let library = paper_library().expect("a library");
            reproduce(&library, Grid::Quick, &Engine::unwatched()).expect("a paper")
        };
        thread::scope(|scope| {
            let other = scope.spawn(run);
            [run(), other.join().expect("the other run")]
        })
    })
}

/// Verdicts of the full grid, which the book shows.
const VERDICTS: &str = include_str!("verdicts.txt");

fn verdicts(paper: &Paper) -> String {
    paper.claims.iter().map(|c| format!("{}: {}\n", c.id, c.verdict.words())).collect()
}

#[test]
fn paper_no_verdict_changes() {
    assert_eq!(verdicts(&papers()[0]), VERDICTS);
}

#[test]
fn two_runs_give_the_same_bytes() {
    let [one, other] = papers();
    assert_eq!(claims_json(one), claims_json(other));
    assert_eq!(listing(one), listing(other));
    assert!(chapter(one).expect("a chapter") == chapter(other).expect("a chapter"));
}

#[test]
fn every_claim_stands_in_the_chapter_once() {
    let paper = &papers()[0];
    let on_one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let text = on_one_line(&chapter(paper).expect("a chapter").markdown);
    for claim in &paper.claims {
        let sentence = on_one_line(&format!("** — {} (", claim.claim));
        assert_eq!(text.matches(&sentence).count(), 1, "{}: {sentence}", claim.id);
    }
    let ids: std::collections::BTreeSet<&str> =
        paper.claims.iter().map(|c| c.id.as_str()).collect();
    assert_eq!(ids.len(), paper.claims.len());
}

/// What a verdict owes its reader: the difference and its cause, or the missing datum.
#[test]
fn every_verdict_has_its_reason() {
    for claim in &papers()[0].claims {
        assert!(claim.why.len() > 30, "{}: {}", claim.id, claim.why);
        assert!(!claim.why.contains("NaN") && !claim.why.contains("inf "), "{}", claim.why);
        let computed = claim.computed_value.is_some_and(f64::is_finite);
        assert_eq!(computed, claim.verdict != Verdict::CannotBeChecked, "{}", claim.id);
    }
}

#[test]
fn the_first_table_counts_the_verdicts() {
    let paper = &papers()[0];
    let all = [Verdict::Agrees, Verdict::Differs, Verdict::CannotBeChecked];
    let [agrees, differs, unchecked] = all.map(|verdict| paper.count(verdict));
    assert_eq!(agrees + differs + unchecked, paper.claims.len());
    let row = format!("| **all** | **{agrees}** | **{differs}** | **{unchecked}** |");
    assert!(chapter(paper).expect("a chapter").markdown.contains(&row));
}

#[test]
fn every_figure_that_is_shown_is_drawn() {
    let chapter = chapter(&papers()[0]).expect("a chapter");
    for (name, svg) in &chapter.figures {
        assert!(chapter.markdown.contains(&format!("](figures/{name})")), "{name}");
        assert!(svg.as_str().starts_with("<svg ") && !svg.as_str().contains("NaN"), "{name}");
    }
    assert_eq!(chapter.markdown.matches("](figures/").count(), chapter.figures.len());
}

/// Every certificate of the exact responses holds.
#[test]
fn every_test_is_certified() {
    for test in &papers()[0].tests {
        assert!(test.certified, "{}: {}", test.id, test.certificate);
    }
}

/// Prose names the sine that the offset of the start is shown for: it is that of the example.
#[test]
fn file_prose_speaks_of_the_examples() {
    let library = paper_library().expect("a library");
    let named = |id: &str| library.experiments().iter().find(|e| e.id == id).map(|e| &e.shake);
    match named("section3-124kg-free-sine") {
        Some(Shake::Sine(sine)) => {
            let found = (sine.frequency_hz, sine.amplitude_m_per_s2, sine.duration_s);
            assert_eq!(found, (1.5, 3.0, 10.0));
        }
        other => panic!("{other:?}"),
    }
}
