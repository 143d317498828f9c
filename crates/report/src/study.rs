//! A study in figures: every demand at every level, as CSV and as the table that the command prints.

use std::fmt::Write as _;

use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use crate::display::{DisplayUnits, Quantity};
use crate::markup::shortened;
use crate::number::{compact, count, rounded, significant};

/// Demands that the printed table shows, of those that a study has; `storeys` means that of each.
const SHOWN: [&str; 8] = [
    "peak_sliding_displacement_m",
    "residual_sliding_displacement_m",
    "gap_ratio",
    "peak_sliding_velocity_m_per_s",
    "block.peak_acceleration_m_per_s2",
    "storeys.peak_acceleration_m_per_s2",
    "storeys.peak_drift_m",
    "base_shear_coefficient",
];

/// One demand at one level.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSummary {
    /// Index of the level, from 0.
    pub level: u64,
    /// Value of the measure at the level, in SI; `None` where levels are factors.
    pub value: Option<f64>,
    /// The factor of the level, where levels are factors.
    pub scale: Option<f64>,
    /// The demand's column.
    pub demand: String,
    /// Its SI unit.
    pub unit: &'static str,
    /// Runs of the level.
    pub runs: u64,
    /// Those that failed.
    pub failures: u64,
    /// Mean of the runs that have a value; NaN where none has.
    pub mean: f64,
    /// 16 %, 50 % and 84 % quantiles, linear between neighbours of the sorted values.
    pub quantiles: [f64; 3],
    /// The value largest in size.
    pub max: f64,
    /// Its run; `None` where no run has a value.
    pub max_run: Option<u64>,
    /// The record of that run.
    pub max_record: String,
}

/// A study in figures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudySummary {
    /// Name of the study.
    pub name: String,
    /// The measure that levels are values of, with its SI unit.
    pub measure: Option<(String, &'static str)>,
    /// Level by level, demand by demand.
    pub rows: Vec<LevelSummary>,
}

impl StudySummary {
    /// The rows as CSV, SI, shortest digits that read back as the same number.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text =
            "level,scale,demand,unit,runs,failures,mean,median,p16,p84,max,max_record,max_run\n"
                .to_owned();
        let number =
            |value: f64| if value.is_finite() { format!("{value:?}") } else { String::new() };
        let optional = |value: Option<f64>| value.map_or_else(String::new, number);
        for row in &self.rows {
            let [low, median, high] = row.quantiles.map(number);
            let (record, run) = match row.max_run {
                Some(run) => (cell(&row.max_record), run.to_string()),
                None => Default::default(),
            };
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{median},{low},{high},{},{record},{run}",
                optional(row.value),
                optional(row.scale),
                cell(&row.demand),
                row.unit,
                row.runs,
                row.failures,
                number(row.mean),
                number(row.max),
            );
        }
        text
    }

    /// The table that the command prints: the demands that engineers ask for first, level by level.
    #[must_use]
    pub fn to_table(&self, display: DisplayUnits) -> String {
        let mut text = format!("{}  (slipstick {})\n", self.name, env!("CARGO_PKG_VERSION"));
        for demand in self.shown() {
            let rows: Vec<&LevelSummary> = self
                .rows
                .iter()
                .filter(|row| row.demand == demand && row.max_run.is_some())
                .collect();
            let Some(first) = rows.first() else { continue };
            let largest = rows.iter().fold(0.0, |l: f64, row| l.max(row.max.abs()));
            let unit = display.unit(quantity(first.unit), largest);
            let show = |si: f64| significant(unit.of(si), 4);
            let name = demand.trim_end_matches(suffix(&demand)).replace(['_', '.'], " ");
            let _ = writeln!(text, "\n{}", unit.label(&name));
            let _ = writeln!(
                text,
                "{:>12} {:>9} {:>10} {:>10} {:>10} {:>10} {:>10}  {:<20} {:>9}",
                self.measure.as_ref().map_or("scale", |(name, _)| name.as_str()),
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
                    "{:>12} {:>9} {low:>10} {median:>10} {high:>10} {:>10} {:>10}  {:<20} {run:>9}",
                    self.level(row, display),
                    count(row.runs - row.failures),
                    show(row.mean),
                    show(row.max),
                    shortened(file_name(&row.max_record), 20),
                );
            }
        }
        let failures: u64 = self.failures();
        if failures > 0 {
            let _ = writeln!(text, "\n{} runs failed: see the column status", count(failures));
        }
        text
    }

    /// Runs that failed.
    #[must_use]
    pub fn failures(&self) -> u64 {
        let first = self.rows.first().map(|row| row.demand.as_str());
        let of_first = self.rows.iter().filter(|row| Some(row.demand.as_str()) == first);
        of_first.map(|row| row.failures).sum()
    }

    fn level(&self, row: &LevelSummary, display: DisplayUnits) -> String {
        match (row.value, &self.measure) {
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
    fn shown(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for shown in SHOWN {
            for row in &self.rows {
                let named = match shown.strip_prefix("storeys.") {
                    None => row.demand == shown,
                    Some(of_storey) => row
                        .demand
                        .strip_prefix("storey")
                        .and_then(|rest| rest.split_once('_'))
                        .is_some_and(|(number, rest)| {
                            number.bytes().all(|b| b.is_ascii_digit()) && rest == of_storey
                        }),
                };
                if named && !names.contains(&row.demand) {
                    names.push(row.demand.clone());
                }
            }
        }
        names
    }
}

/// The last part of a path.
fn file_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// The end of a column's name that is its unit.
fn suffix(name: &str) -> &'static str {
    ["_m_per_s2", "_m_per_s", "_m", "_s", "_n"]
        .into_iter()
        .find(|suffix| name.ends_with(suffix))
        .unwrap_or("")
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

/// A text as a cell of CSV.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        return format!("\"{}\"", text.replace('"', "\"\""));
    }
    text.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(level: u64, demand: &str, unit: &'static str) -> LevelSummary {
        LevelSummary {
            level,
            value: Some(1.0 + level as f64),
            scale: None,
            demand: demand.to_owned(),
            unit,
            runs: 10,
            failures: 1,
            mean: 0.25,
            quantiles: [0.1, 0.2, 0.3],
            max: -0.5,
            max_run: Some(7),
            max_record: "a,b.AT2".to_owned(),
        }
    }

    #[test]
    fn exact_csv_and_table() {
        let rows = vec![
            row(0, "residual_sliding_displacement_m", "m"),
            LevelSummary { max_run: None, mean: f64::NAN, ..row(0, "gap_ratio", "") },
            row(0, "storey2_peak_drift_m", "m"),
            row(1, "residual_sliding_displacement_m", "m"),
        ];
        let measure = Some(("PGA".to_owned(), "m/s2"));
        let summary = StudySummary { name: "Tank".to_owned(), measure, rows };
        let csv = summary.to_csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(
            lines[1],
            "1.0,,residual_sliding_displacement_m,m,10,1,0.25,0.2,0.1,0.3,-0.5,\"a,b.AT2\",7"
        );
        assert!(lines[2].ends_with(",gap_ratio,,10,1,,0.2,0.1,0.3,-0.5,,"), "{}", lines[2]);
        assert_eq!(lines.len(), 5);
        let table = summary.to_table(DisplayUnits::Si);
        assert!(table.contains("\nresidual sliding displacement (mm)\n"), "{table}");
        assert!(table.contains("\nstorey2 peak drift (mm)\n"), "{table}");
        assert!(table.contains("0.102 g") && table.contains("-500.0"), "{table}");
        assert!(!table.contains("gap ratio"), "{table}");
        assert!(table.ends_with("\n2 runs failed: see the column status\n"), "{table}");
    }
}
