//! A study in figures: the table that the command prints.

mod page;

pub use page::StudyReport;

use std::fmt::Write as _;

use slipstick::response::DemandColumn;
use slipstick::study::{LevelSummary, StudySummary};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use crate::display::{DisplayUnits, Quantity, Unit};
use crate::markup::shortened;
use crate::number::{compact, count, rounded, significant};

/// What the runs warn of, a sentence a kind with the first run that does.
#[must_use]
pub fn said(summary: &StudySummary) -> Vec<String> {
    let of = |(kind, runs, first): &(String, u64, u64)| match runs {
        1 => format!("run {first} gave the warning {kind}"),
        _ => {
            format!("{} runs gave the warning {kind}, the first of them run {first}", count(*runs))
        }
    };
    summary.warned.iter().map(of).collect()
}

/// The table that the command prints: the demands that engineers ask for first, level by level.
#[must_use]
pub fn table(summary: &StudySummary, display: DisplayUnits) -> String {
    let mut text = format!("{}  (slipstick {})\n", summary.name, env!("CARGO_PKG_VERSION"));
    let bounded = summary.rows.iter().any(|row| row.friction.is_some());
    for demand in shown(summary) {
        let rows: Vec<&LevelSummary> = summary
            .rows
            .iter()
            .filter(|row| row.demand == demand && row.max_run.is_some())
            .collect();
        if rows.is_empty() {
            continue;
        }
        let unit = display.unit(demand.dimension().into(), largest(&rows));
        let show = |si: f64| match si.is_infinite() {
            true => "beyond".to_owned(),
            false => significant(unit.of(si), 4),
        };
        let words = demand.demand.words;
        let name = match demand.demand.of.part() {
            None => words.to_owned(),
            Some(_) => summary.names.title(&demand),
        };
        let _ = writeln!(text, "\n{}", unit.label(&name));
        let friction = |text: &str| if bounded { format!("  {text:<8}") } else { String::new() };
        let _ = writeln!(
            text,
            "{:>12}{} {:>9} {:>10} {:>10} {:>10} {:>10} {:>10}  {:<20} {:>9}",
            summary.measure.as_ref().map_or("scale", |(name, _)| name.as_str()),
            friction("friction"),
            "runs",
            "16 %",
            "median",
            "84 %",
            "mean",
            "max",
            "of record",
            "run"
        );
        for row in rows {
            let [low, median, high] = row.quantiles.map(show);
            let run = row.max_run.map_or_else(String::new, |run| run.to_string());
            let _ = writeln!(
                text,
                "{:>12}{} {:>9} {low:>10} {median:>10} {high:>10} {:>10} {:>10}  {:<20} {run:>9}",
                level(summary, row, display),
                friction(row.friction.unwrap_or_default()),
                count(row.runs - row.failures + row.beyond),
                show(row.mean),
                show(row.max),
                shortened(file_name(&row.max_record), 20),
            );
        }
    }
    if let Some(message) = without_answer(summary) {
        let _ = writeln!(text, "\n{message}: see the column status");
    }
    text
}

/// Largest of the values that are known, from which a unit follows.
fn largest(rows: &[&LevelSummary]) -> f64 {
    let known = |row: &&LevelSummary| {
        let all = row.quantiles.into_iter().chain([row.max]).filter(|value| value.is_finite());
        all.fold(0.0, |largest: f64, value| largest.max(value.abs()))
    };
    rows.iter().map(known).fold(0.0, f64::max)
}

/// How many runs have no answer, and what they count as.
fn without_answer(summary: &StudySummary) -> Option<String> {
    let (failures, beyond) = (summary.failures(), summary.beyond_travel());
    if failures == 0 {
        return None;
    }
    let (of_beyond, left) = (count(beyond), count(failures - beyond));
    Some(match (beyond, failures - beyond) {
        (0, _) => format!("{left} runs failed and are left out"),
        (_, 0) => format!(
            "{of_beyond} runs used up their travel: their sliding displacement counts as beyond all others, and their \
             other demands are left out"
        ),
        _ => format!(
            "{} runs failed: of {of_beyond} that used up their travel the sliding displacement counts as beyond all \
             others, and all else is left out",
            count(failures)
        ),
    })
}

fn level(summary: &StudySummary, row: &LevelSummary, display: DisplayUnits) -> String {
    match (row.value, &summary.measure) {
        // Levels of acceleration are spoken of in g.
        (Some(value), Some((_, "m/s2"))) => {
            format!("{} g", rounded(value / STANDARD_GRAVITY_M_PER_S2, 4))
        }
        (Some(value), Some((_, unit))) => {
            let unit = display.unit(quantity(unit), value);
            format!("{} {}", rounded(unit.of(value), 4), unit.symbol)
        }
        _ => row.scale.map_or_else(String::new, compact),
    }
}

/// The demands of the table that this study has, in its order.
fn shown(summary: &StudySummary) -> Vec<DemandColumn> {
    let mut shown: Vec<DemandColumn> = Vec::new();
    for row in &summary.rows {
        if row.demand.demand.study_place > 0 && !shown.contains(&row.demand) {
            shown.push(row.demand);
        }
    }
    shown.sort_by_key(|column| column.demand.study_place);
    shown
}

/// The last part of a path.
fn file_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

fn quantity(unit: &str) -> Quantity {
    match unit {
        "m" => Quantity::Length,
        "m/s" => Quantity::Velocity,
        "m/s2" => Quantity::Acceleration,
        "N" => Quantity::Force,
        "s" => Quantity::Time,
        _ => Quantity::Ratio,
    }
}

/// The value of a level in SI, or its factor.
fn level_number(row: &LevelSummary) -> f64 {
    row.value.or(row.scale).unwrap_or(f64::NAN)
}

/// The unit of levels in a figure: accelerations in g.
fn level_unit(summary: &StudySummary, display: DisplayUnits) -> Unit {
    let largest = summary.rows.iter().map(level_number).fold(0.0, f64::max);
    match &summary.measure {
        Some((_, "m/s2")) => Unit { in_si: STANDARD_GRAVITY_M_PER_S2, symbol: "g" },
        Some((_, unit)) => display.unit(quantity(unit), largest),
        None => Unit { in_si: 1.0, symbol: "" },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipstick::input::Names;

    fn row(level: usize, demand: &str) -> LevelSummary {
        LevelSummary {
            level,
            value: Some(1.0 + level as f64),
            scale: None,
            friction: None,
            demand: DemandColumn::of_name(demand).unwrap(),
            runs: 10,
            failures: 1,
            beyond: 0,
            mean: 0.25,
            quantiles: [0.1, 0.2, 0.3],
            distribution: Vec::new(),
            max: -0.5,
            max_run: Some(7),
            max_record: "a,b.AT2".to_owned(),
        }
    }

    #[test]
    fn table_of_a_study() {
        let rows = vec![
            row(0, "residual_sliding_displacement_m"),
            LevelSummary { max_run: None, mean: f64::NAN, ..row(0, "gap_ratio") },
            row(0, "storey2_peak_drift_m"),
            row(1, "residual_sliding_displacement_m"),
        ];
        let measure = Some(("PGA".to_owned(), "m/s2"));
        let names = Names { storeys: vec![None, Some("Deck".to_owned())], ..Names::default() };
        let name = "Tank".to_owned();
        let summary = StudySummary { name, measure, rows, names, warned: Vec::new() };
        let table = super::table(&summary, DisplayUnits::Si);
        assert!(table.contains("\nresidual sliding displacement (mm)\n"), "{table}");
        assert!(table.contains("\nDeck peak drift (mm)\n"), "{table}");
        assert!(table.contains("0.102 g") && table.contains("-500.0"), "{table}");
        assert!(!table.contains("gap ratio"), "{table}");
        assert!(
            table.ends_with("\n2 runs failed and are left out: see the column status\n"),
            "{table}"
        );
    }
}
