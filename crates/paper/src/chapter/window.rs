//! The amplification window.

use crate::{Paper, Ratio, SCANNED_HZ, TESTED_HZ, Window};

use super::doc::{Doc, fixed};
use super::graphs;
use slipstick_report::number::compact;

/// Identifiers of the figures, one a mock-up in their order.
const FIGURES: [&str; 5] =
    ["paper-window-1", "paper-window-2", "paper-window-3", "paper-window-4", "paper-window-5"];

pub fn write(doc: &mut Doc, paper: &Paper) {
    doc.heading(2, "The amplification window");
    doc.paragraph(
        "The abstract says that sliding makes the storey's response smaller except in a narrow \
         window just above its fixed-base frequency f2; the body never shows it. \"Amplified\" can \
         mean above the table or above the same storey on a fixed block. Both ratios were \
         computed for every oscillator, amplitude and frequency, in 20 s from rest and in the \
         steady state. The storey on the freely sliding block has the frequency \
         f_ff = f2 √(1 + M2/M1).",
    );
    let points: usize = paper.windows.iter().map(|w| w.points.len()).sum();
    let unsettled: Vec<(&Window, f64)> = paper
        .windows
        .iter()
        .flat_map(|w| w.unsettled().map(move |p| (w, p.frequency_hz)))
        .collect();
    let sub: usize = paper.windows.iter().map(Window::subharmonic).sum();
    let drifting = paper.windows.iter().flat_map(|w| &w.points);
    let drifting = drifting.filter(|p| p.period.is_some() && p.drift_m.abs() > 1e-9).count();
    let ends = |values: Vec<f64>| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        format!("{} to {}", compact(round3(low)), compact(round3(high)))
    };
    let where_unsettled = if unsettled.is_empty() {
        String::new()
    } else {
        format!(
            " Those that did not settle lie at tables of {} m/s² and {} Hz; of them the peaks of the \
             last six periods are shown. Small differences grow in them without end, those of \
             rounding too, so that another order of the same sums gives other peaks.",
            ends(unsettled.iter().map(|(w, _)| w.amplitude_m_per_s2).collect()),
            ends(unsettled.iter().map(|(_, hz)| *hz).collect()),
        )
    };
    doc.paragraph(&format!(
        "A steady state is one whose periods agree to 1e-9. Of {points} motions {} settled to the \
         period of the table, {sub} to a multiple of it, and {} did not settle; {drifting} of those \
         that settled drift by the same amount every period.{where_unsettled}",
        points - unsettled.len() - sub,
        unsettled.len(),
    ));
    over_table(doc, paper);
    over_fixed(doc, paper);
    for (mock_up, id) in mock_ups(paper).into_iter().zip(FIGURES) {
        if let Some(figure) = graphs::window(id, &mock_up) {
            let caption = format!(
                "{} kg at {} Hz: the four ratios at 0.1, 1 and 5 m/s². Dotted: f2; dashed: f_ff; \
                 red: one.",
                compact(mock_up[0].mass_kg),
                frequency(mock_up[0].frequency_hz),
            );
            doc.figure(&figure, &caption);
        }
    }
    doc.claims(paper.claims_of(&["sliding-", "window-"]));
}

fn mock_ups(paper: &Paper) -> Vec<Vec<&Window>> {
    let mut all: Vec<Vec<&Window>> = Vec::new();
    for window in &paper.windows {
        match all.last_mut().filter(|group| group[0].id == window.id) {
            Some(group) => group.push(window),
            None => all.push(vec![window]),
        }
    }
    all
}

fn round3(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

fn frequency(hz: f64) -> String {
    compact((hz * 1e6).round() / 1e6)
}

fn name(window: &Window) -> Vec<String> {
    vec![
        format!("{} kg, {} Hz", compact(window.mass_kg), frequency(window.frequency_hz)),
        compact(window.amplitude_m_per_s2),
    ]
}

/// Where a ratio exceeds one; many stretches by their number and ends.
fn above(window: &Window, ratio: Ratio, band_hz: [f64; 2]) -> String {
    let stretches = window.above_one(ratio, band_hz);
    match (stretches.first(), stretches.last()) {
        (Some(first), Some(last)) if stretches.len() > 2 => format!(
            "{} stretches, {} to {}",
            stretches.len(),
            fixed(first[0], 2),
            fixed(last[1], 2)
        ),
        _ => window.above_one_text(ratio, band_hz),
    }
}

/// From rest and steady.
type Pair = [Ratio; 2];

fn over_table(doc: &mut Doc, paper: &Paper) {
    let pair: Pair = [|p| p.rest_over_table, |p| p.steady_over_table];
    doc.paragraph("Where the peak storey acceleration exceeds that of the table, in Hz:");
    stretches(doc, paper, pair);
    doc.paragraph(
        "The largest ratio above 0.75 f2, and the frequency of the table there over f2 and over \
         f_ff:",
    );
    peaks(doc, paper, pair);
}

fn over_fixed(doc: &mut Doc, paper: &Paper) {
    let pair @ [_, steady]: Pair = [|p| p.rest_over_fixed, |p| p.steady_over_fixed];
    doc.paragraph(
        "Where the peak storey acceleration exceeds that of the same storey on a fixed block, in \
         Hz; where the block sticks throughout the ratio is one:",
    );
    stretches(doc, paper, pair);
    doc.paragraph("The largest of this ratio above 0.75 f2, and where, as before:");
    peaks(doc, paper, pair);
    doc.paragraph(
        "The largest in the steady state below 0.75 f2. The square wave of friction carries the odd \
         multiples of the table's frequency, and one of them meets f_ff: the last column is f_ff \
         over the frequency of the table.",
    );
    let rows = paper.windows.iter().map(|window| {
        let [hz, value] = window.peak(steady, window.below_hz());
        let mut cells = name(window);
        cells.extend([fixed(value, 2), fixed(hz, 3), fixed(window.free_free_hz / hz, 2)]);
        cells
    });
    doc.table(
        &["oscillator", "table, m/s²", "largest", "at, Hz", "f_ff over it"],
        1,
        rows.collect(),
    );
}

/// Where ratios exceed one, as tested and as scanned.
fn stretches(doc: &mut Doc, paper: &Paper, pair: Pair) {
    let rows = paper.windows.iter().map(|window| {
        let mut cells = name(window);
        for band_hz in [TESTED_HZ, SCANNED_HZ] {
            cells.extend(pair.map(|ratio| above(window, ratio, band_hz)));
        }
        cells
    });
    let head =
        |[from, to]: [f64; 2], what: &str| format!("{}–{} Hz, {what}", compact(from), compact(to));
    let heads = [TESTED_HZ, SCANNED_HZ].map(|band| [head(band, "rest"), head(band, "steady")]);
    let mut header = vec!["oscillator", "table, m/s²"];
    header.extend(heads.iter().flatten().map(String::as_str));
    doc.table(&header, 1, rows.collect());
}

/// The largest ratios about the storey's own resonance, and where.
fn peaks(doc: &mut Doc, paper: &Paper, pair: Pair) {
    let rows = paper.windows.iter().map(|window| {
        let mut cells = name(window);
        for ratio in pair {
            let [hz, value] = window.peak(ratio, window.near_hz());
            cells.push(fixed(value, 2));
            cells.extend([window.frequency_hz, window.free_free_hz].map(|f| fixed(hz / f, 3)));
        }
        cells
    });
    let header = [
        "oscillator",
        "table, m/s²",
        "rest",
        "over f2",
        "over f_ff",
        "steady",
        "over f2",
        "over f_ff",
    ];
    doc.table(&header, 1, rows.collect());
}
