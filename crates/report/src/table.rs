//! The table that `slipstick run` prints: plain characters, aligned, without colour.

use slipstick::error::visible;
use slipstick::model::Model;
use slipstick::motion::Figures;
use slipstick::record::rest;
use slipstick::response::Method;

use crate::describe::{model_line, value};
use crate::display::{DisplayUnits, Quantity};
use crate::floors;
use crate::laboratory::text::aligned;
use crate::markup::shortened;
use crate::number::{compact, rounded, significant};
use crate::peaks::{self, Row};
use crate::summary::{Summary, method_name};

/// Columns of a text that stays readable on a terminal.
const WIDTH: usize = 96;

/// The table of one analysis, with lower and upper friction beside it where they were run.
///
/// `record` is what was understood of the ground motion (`PEER AT2, 2800 values, 0.005 s, g`). Lines
/// end in a line feed and carry no control characters; the largest of several values is starred.
#[must_use]
pub fn table(summary: &Summary, model: &Model, record: &str, display: DisplayUnits) -> String {
    let mut out = Lines::default();
    let method = method_name(summary.method);
    let hash = summary.model_hash.iter().map(|hash| format!(", model {hash}"));
    let hash: String = hash.collect();
    out.line(&format!("{}  (slipstick {}, {method}{hash})", summary.model, summary.slipstick));
    out.field("Record", record);
    let said: Vec<String> =
        summary.origin.said().iter().map(|(name, text)| format!("{name} {text}")).collect();
    if !said.is_empty() {
        out.field("", &said.join(", "));
    }
    out.field("", &record_figures(summary, display));
    out.field("Model", &model_line(model, display));
    out.line("");
    let mut rows = peaks::rows(summary, display);
    rows.extend(peaks::count_rows(summary));
    rows.extend(check_rows(summary));
    grid(&mut out, summary, &rows);
    let spectra = summary.floor_spectra.as_ref();
    let spectra = spectra.and_then(|spectra| floors::table(spectra, &summary.names, display));
    if let Some((heading, rows)) = spectra {
        out.line("");
        out.line(&heading);
        aligned(&rows).lines().for_each(|line| out.line(line));
    }
    out.line("");
    verdict(&mut out, summary);
    let warnings = summary.all_warnings();
    if !warnings.is_empty() {
        out.line("");
        for (run, warning) in warnings {
            let run = run.map_or(String::new(), |name| format!(" ({name} friction)"));
            let time = warning.time_s.map_or(String::new(), |t| format!(" at {} s", compact(t)));
            let told =
                format!("{}{run}{time}: {}", warning.kind, display.sentence(&warning.message));
            out.field(warning.label(), &told);
        }
    }
    out.0
}

/// Whether the displacement of a motion grows with its length: its peak is no peak of the ground.
pub(crate) fn drifts(figures: &Figures) -> bool {
    let Figures { pga_m_per_s2, pgv_m_per_s, end_velocity_m_per_s, .. } = *figures;
    !rest(0.0, pga_m_per_s2, end_velocity_m_per_s, pgv_m_per_s).is_empty()
}

fn record_figures(summary: &Summary, display: DisplayUnits) -> String {
    let record = &summary.record;
    // The end velocity is read against the peak, so it has the unit of the peak.
    let show_as = |quantity, largest: f64, si: f64| {
        let unit = display.unit(quantity, largest);
        format!("{} {}", significant(unit.of(si), 4), unit.symbol)
    };
    let show = |quantity, si: f64| show_as(quantity, si, si);
    let dt = summary.dt_s.map_or("uneven samples".to_owned(), |dt| format!("step {dt} s"));
    format!(
        "{}PGA {}, PGV {}, PGD {}{}, end velocity {}, {dt}, {} in all",
        match summary.record_factor {
            1.0 => String::new(),
            factor => format!("× {}: ", significant(factor, 4)),
        },
        show(Quantity::Acceleration, record.pga_m_per_s2),
        show(Quantity::Velocity, record.pgv_m_per_s),
        show(Quantity::Length, record.pgd_m),
        if drifts(record) { " (the record drifts)" } else { "" },
        show_as(Quantity::Velocity, record.pgv_m_per_s, record.end_velocity_m_per_s),
        value(display, Quantity::Time, summary.duration_s),
    )
}

/// Rows with one column a run.
fn grid(out: &mut Lines, summary: &Summary, rows: &[Row]) {
    let runs = summary.runs();
    let label = rows.iter().map(|row| length(&row.label)).max().unwrap_or(0);
    let unit = rows.iter().map(|row| length(row.unit)).max().unwrap_or(0);
    let line = |name: &str, symbol: &str, cells: String| {
        format!("{}  {}  {cells}", pad(name, label), pad(symbol, unit))
    };
    if runs.len() > 1 {
        out.line(&line("", "", runs.iter().map(|(name, _)| format!("{name:>11} ")).collect()));
        let factors = runs.iter().map(|(_, run)| format!("x {}", compact(run.friction_factor)));
        out.line(&line("Friction", "", factors.map(|text| format!("{text:>11} ")).collect()));
    }
    for row in rows {
        let cells = row.values.iter().enumerate().map(|(i, value)| {
            let star = if row.governing == Some(i) { '*' } else { ' ' };
            format!("{value:>11}{star}")
        });
        out.line(&line(&row.label, row.unit, cells.collect()));
    }
    if rows.iter().any(|row| row.governing.is_some()) {
        out.line("* governs: the largest of the runs");
    }
}

fn check_rows(summary: &Summary) -> Vec<Row> {
    let figure = |value| significant(value, 2);
    let mut rows = vec![
        plain_row(summary, "Check: equilibrium residual", |run| {
            figure(run.checks.equilibrium_residual)
        }),
        plain_row(summary, "Check: friction excess", |run| figure(run.checks.friction_excess)),
        plain_row(summary, "Check: energy balance error", |run| {
            figure(run.checks.energy_balance_error)
        }),
        plain_row(summary, "Check: demands error", |run| figure(run.checks.demands_error)),
    ];
    if summary.method == Method::Exact {
        rows.push(plain_row(summary, "Closest call: margin", |run| {
            run.checks.closest_call.map_or("none".to_owned(), |call| figure(call.margin))
        }));
    }
    if summary.iterations.is_some() {
        rows.push(plain_row(summary, "Iterations a step, mean", |run| {
            run.iterations.map_or("n/a".to_owned(), |i| significant(i.mean, 3))
        }));
        rows.push(plain_row(summary, "Iterations a step, at most", |run| {
            run.iterations.map_or("n/a".to_owned(), |i| i.max.to_string())
        }));
    }
    rows
}

fn plain_row(summary: &Summary, label: &str, value: impl Fn(&Summary) -> String) -> Row {
    let values = summary.runs().into_iter().map(|(_, run)| value(run)).collect();
    Row { label: label.to_owned(), unit: "", values, governing: None }
}

fn verdict(out: &mut Lines, summary: &Summary) {
    let checks = &summary.checks;
    let bound = rounded(checks.bound, 2);
    out.field(
        "Check",
        &match checks.holds {
            Some(_) if summary.check_failed() => {
                format!("FAILED: not every figure is within {bound}; do not use this response")
            }
            Some(_) => format!("passed: every figure is within {bound}"),
            None => "stepwise figures are reported, not judged".to_owned(),
        },
    );
}

/// Lines of text, trailing spaces taken off.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn line(&mut self, text: &str) {
        // Names come from users: a control character must not reach a terminal.
        self.0.push_str(shortened(&visible(text), 400).trim_end());
        self.0.push('\n');
    }

    /// A name and a text beside it, wrapped at spaces.
    fn field(&mut self, name: &str, text: &str) {
        const INDENT: usize = 9;
        let mut row = pad(name, INDENT);
        let mut empty = true;
        for word in text.split_whitespace() {
            if !empty && length(&row) + 1 + length(word) > WIDTH {
                self.line(&row);
                row = pad("", INDENT);
                empty = true;
            }
            if !empty {
                row.push(' ');
            }
            row.push_str(word);
            empty = false;
        }
        self.line(&row);
    }
}

fn length(text: &str) -> usize {
    text.chars().count()
}

fn pad(text: &str, width: usize) -> String {
    format!("{text:<width$}")
}
