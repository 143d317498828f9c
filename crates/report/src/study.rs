//! A study in figures: the table that the command prints.

mod page;

pub use page::StudyReport;

use slipstick::notice::{Notice, NoticeKind};
use slipstick::response::DemandColumn;
use slipstick::study::{LevelSummary, StudySummary};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use crate::VERSION;
use crate::assessment::sheet::{SheetTable, cell};
use crate::display::{DisplayUnits, Quantity, Unit};
use crate::laboratory::text::aligned;
use crate::markup::shortened;
use crate::number::{compact, count, rounded};

/// What the runs give notice of, a line a kind with the first run that does, the gravest first.
#[must_use]
pub fn said(summary: &StudySummary) -> Vec<Notice> {
    let of = |(kind, runs, first): &(String, u64, u64)| {
        let known = NoticeKind::from_name(kind);
        let what = if known.is_some() { String::new() } else { format!("{kind}: ") };
        let message = match runs {
            1 => format!("{what}run {first}"),
            _ => format!("{what}{} runs, the first of them run {first}", count(*runs)),
        };
        Notice::new(known.unwrap_or(NoticeKind::Runs), message)
    };
    let mut all: Vec<Notice> = summary.warned.iter().map(of).collect();
    Notice::sort(&mut all);
    all
}

/// What the command prints: the demands that engineers ask for first, level by level.
#[must_use]
pub fn table(summary: &StudySummary, display: DisplayUnits) -> String {
    let mut text = format!("{}  (slipstick {VERSION})\n", summary.name);
    for (heading, rows) in tables(summary, display) {
        text.push_str(&format!("\n{heading}\n{}", aligned(&rows)));
    }
    if let Some(message) = without_answer(summary) {
        text.push_str(&format!("\n{message}: see the column status\n"));
    }
    text
}

/// A table a demand, of those that engineers ask for first: a row a level.
fn tables(summary: &StudySummary, display: DisplayUnits) -> Vec<SheetTable> {
    let bounded = summary.rows.iter().any(|row| row.friction.is_some());
    let measure = summary.measure.as_ref().map_or("Scale", |(name, _)| name.as_str());
    let heads = ["Runs", "16 %", "Median", "84 %", "Mean", "Largest", "Record", "Run"];
    let friction = bounded.then_some("Friction");
    let heads = [measure].into_iter().chain(friction).chain(heads);
    let heads: Vec<String> = heads.map(str::to_owned).collect();
    let of_demand = |demand: DemandColumn| {
        let rows = rows(summary, demand);
        let unit = display.unit(demand.dimension().into(), largest(&rows));
        let number = |si: f64| match si.is_infinite() {
            true => "beyond".to_owned(),
            false => cell(unit.of(si)),
        };
        let of_level = |row: &&LevelSummary| {
            let [low, median, high] = row.quantiles.map(number);
            let cells = [
                count(row.runs - row.failures + row.beyond),
                low,
                median,
                high,
                number(row.mean),
                number(row.max),
                shortened(file_name(&row.max_record), 24),
                row.max_run.map_or_else(String::new, |run| run.to_string()),
            ];
            let friction = row.friction.map(str::to_owned);
            [level(summary, row, display)].into_iter().chain(friction).chain(cells).collect()
        };
        let lines = core::iter::once(heads.clone()).chain(rows.iter().map(of_level)).collect();
        (!rows.is_empty()).then(|| (unit.label(&summary.names.title(&demand)), lines))
    };
    shown(summary).into_iter().filter_map(of_demand).collect()
}

/// The rows of a demand that have values.
fn rows(summary: &StudySummary, demand: DemandColumn) -> Vec<&LevelSummary> {
    let of = |row: &&LevelSummary| row.demand == demand && row.max_run.is_some();
    summary.rows.iter().filter(of).collect()
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
        assert!(table.contains("\nResidual sliding displacement (mm)\n"), "{table}");
        assert!(table.contains("\nDeck peak drift (mm)\n"), "{table}");
        assert!(table.contains("0.102 g") && table.contains("-500.0"), "{table}");
        assert!(!table.contains("Gap ratio"), "{table}");
        assert!(
            table.ends_with("\n2 runs failed and are left out: see the column status\n"),
            "{table}"
        );
    }

    /// Every kind is one line under its own name and weight; what changes no decision stands last.
    #[test]
    fn notices_of_runs_are_a_line_a_kind() {
        let warned =
            [("first_sample_small", 42, 0), ("gap_exceeded", 1200, 3), ("flat_geometry", 1, 7)];
        let warned = warned.map(|(kind, runs, first)| (kind.to_owned(), runs, first)).to_vec();
        let (name, rows, names) = ("Tank".to_owned(), Vec::new(), Names::default());
        let all = said(&StudySummary { name, measure: None, rows, names, warned });
        let lines: Vec<String> = all
            .iter()
            .map(|notice| format!("{} {}: {}", notice.label(), notice.kind, notice.message))
            .collect();
        assert_eq!(
            lines,
            [
                "Severe gap_exceeded: 1200 runs, the first of them run 3",
                "Warning flat_geometry: run 7",
                "Note first_sample_small: 42 runs, the first of them run 0",
            ]
        );
    }
}
