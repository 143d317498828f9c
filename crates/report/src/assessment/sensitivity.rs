//! Derivatives of demands: which key changes what, and by how much.

use serde::Serialize;
use slipstick::assessment::derivative::{Derivative, DerivativeRun, Key};
use slipstick::notice::{Notice, NoticeKind};
use slipstick::response::DemandColumn;

use super::key::{path_words, quantity, title};
use super::lines::{line, panel};
use super::sheet::{Sheet, cell, failed};
use crate::display::DisplayUnits;
use crate::figures::Drawn;
use crate::json::{each, pretty};
use crate::legend::change;
use crate::number::{compact, significant};
use crate::plot::{Axis, Figure, Layout, PlotSeries, Shape, Style};
use crate::view;

/// Demands that are drawn and told first, where they are among those asked for.
const FIRST: [&str; 3] =
    ["peak_sliding_displacement_m", "residual_sliding_displacement_m", "sliding_path_m"];

/// Most demands that are all told where none is asked for.
const MOST_TOLD: usize = 4;

/// The residual.
const RESIDUAL: &str = FIRST[1];

/// The peak that it is measured by.
const PEAK: &str = FIRST[0];

/// Share of the peak below which a residual is next to nothing.
const LEAST_RESIDUAL: f64 = 0.05;

/// Bars of a key that makes a demand larger, and smaller.
const BARS: [&str; 2] = ["#8fa8c4", "#d9a98a"];

/// What derivatives are told from.
#[derive(Clone, Debug)]
pub struct SensitivityReport<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// How the records were scaled, in words.
    pub scaled: &'a str,
    /// What came of it.
    pub run: &'a DerivativeRun,
    /// What reading the records gave notice of.
    pub warnings: &'a [Notice],
    /// Units to show results in.
    pub display: DisplayUnits,
}

impl SensitivityReport<'_> {
    /// The result laid out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let run = self.run;
        let records = match &run.records[..] {
            [one] => one.name.clone(),
            many => format!("{} records", many.len()),
        };
        let refuted: Vec<&str> = run
            .records
            .iter()
            .filter(|record| record.holds == Some(false))
            .map(|record| &record.name[..])
            .collect();
        let refuted = (!refuted.is_empty()).then(|| {
            let message = format!(
                "the independent check does not confirm the model as it stands on {}",
                refuted.join(", ")
            );
            Notice::new(NoticeKind::CheckFailed, message)
        });
        let shown = self.shown();
        let figures = shown.iter().enumerate().filter_map(|(i, demand)| {
            let number = if i == 0 { String::new() } else { format!("-{}", i + 1) };
            self.figure(*demand, &format!("tornado{number}"))
        });
        Sheet {
            kind: "Sensitivity",
            name: self.name.to_owned(),
            line: format!("{} runs: {records}{}", run.runs, self.scaled),
            display: self.display,
            verdict: shown.first().and_then(|demand| self.verdict(*demand)).into_iter().collect(),
            complete: run.failures.is_empty() && refuted.is_none(),
            warnings: refuted
                .into_iter()
                .chain(failed(&run.failures, run.runs, "leave their derivatives out"))
                .chain(run.warnings.iter().chain(self.warnings).cloned())
                .collect(),
            tables: shown.iter().map(|demand| self.table(*demand)).collect(),
            notes: self.notes(),
            figures: figures.collect(),
            method: vec![
                "Differences of exact runs at the value of a key and a step to both sides, chosen from the \
                 rounding that two runs with all keys moved by their last digits show."
                    .to_owned(),
                "The error is half the difference of the two slopes and the rounding over the step: a bound where \
                 the demand bends one way within the step. Where order or number of events changes within the \
                 step the derivative is marked."
                    .to_owned(),
            ],
            json: pretty(&self.json()),
            ..Sheet::default()
        }
    }

    /// Derivatives of a demand: key by key, those of all records.
    fn of(&self, demand: usize) -> Vec<(&Key, Vec<&Derivative>)> {
        let of_key = |(place, key): (usize, _)| {
            let own = self.run.derivatives.iter();
            (key, own.filter(|d| d.demand == demand && d.key == place).collect())
        };
        self.run.keys.iter().enumerate().map(of_key).collect()
    }

    /// Relative change of a demand over that of a key; NaN of a residual that is next to nothing beside the peak of its
    /// run, of which a percentage would say nothing.
    fn relative(&self, of: &Derivative, key: &Key) -> f64 {
        let place = |name: &str| self.run.demands.iter().position(|d| d.name() == name);
        let peak = place(PEAK).filter(|_| place(RESIDUAL) == Some(of.demand));
        let same = |d: &&Derivative| d.record == of.record && Some(d.demand) == peak;
        let peak = self.run.derivatives.iter().find(same).map_or(0.0, |d| d.value.abs());
        if of.value.abs() < LEAST_RESIDUAL * peak { f64::NAN } else { of.relative(key) }
    }

    /// Demands that are told in tables and figures: those that are asked for, else the first.
    fn shown(&self) -> Vec<usize> {
        let demands = &self.run.demands;
        if self.run.are_asked_for || demands.len() <= MOST_TOLD {
            return (0..demands.len()).collect();
        }
        let place = |name: &str| demands.iter().position(|demand| demand.name() == name);
        let mut shown: Vec<usize> = FIRST.iter().filter_map(|name| place(name)).collect();
        let ends = |demand: &DemandColumn| demand.name().ends_with("peak_acceleration_m_per_s2");
        shown.extend(demands.iter().rposition(ends));
        shown
    }

    /// The keys with their relative change, median over the records, the strongest first; without those of which
    /// there is none.
    fn ranked(&self, demand: usize) -> Vec<(&Key, f64, bool)> {
        let of = self.of(demand).into_iter().filter_map(|(key, all)| {
            let relative = all.iter().map(|d| self.relative(d, key)).collect::<Vec<_>>();
            let change = median(&relative)?;
            Some((key, change, all.iter().any(|d| d.events_change)))
        });
        let mut ranked: Vec<_> = of.collect();
        ranked.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        ranked
    }

    fn verdict(&self, demand: usize) -> Option<String> {
        let (key, change, _) = self.ranked(demand).into_iter().next()?;
        let what = title(&self.run.demands[demand].name());
        let what = if self.run.records.len() > 1 {
            format!("Median {}", what.to_lowercase())
        } else {
            what
        };
        let more = if change < 0.0 { "less" } else { "more" };
        Some(format!(
            "{what}: {} % {more} for 1 % more {}, the strongest of {}.",
            significant(change.abs(), 3),
            path_words(&key.path),
            self.run.keys.len()
        ))
    }

    fn table(&self, demand: usize) -> (String, Vec<Vec<String>>) {
        let column = &self.run.demands[demand];
        let unit = self.run.derivatives.iter().filter(|d| d.demand == demand);
        let largest = unit.map(|d| d.value.abs()).filter(|v| v.is_finite()).fold(0.0, f64::max);
        let unit = self.display.unit(quantity(&column.name()), largest);
        let whole = |unit: &str| {
            if unit.contains(['/', ' ']) { format!("({unit})") } else { unit.to_owned() }
        };
        let per = |key: &Key| match (unit.symbol, key.unit.as_str()) {
            (of, "") => of.to_owned(),
            ("", per) => format!("1/{}", whole(per)),
            (of, per) => format!("{}/{}", whole(of), whole(per)),
        };
        let heads = ["", "Value", "Derivative", "Error", "Unit", "% for 1 %", ""];
        let mut rows = vec![heads.map(str::to_owned).to_vec()];
        for (key, all) in self.of(demand) {
            let values = |of: &dyn Fn(&Derivative) -> f64| {
                let values: Vec<f64> = all.iter().map(|d| of(d)).collect();
                median(&values).unwrap_or(f64::NAN)
            };
            let change = if all.iter().any(|d| d.events_change) { "events change" } else { "" };
            rows.push(vec![
                path_words(&key.path),
                format!("{} {}", compact(key.value), key.unit).trim_end().to_owned(),
                cell(unit.of(values(&|d| d.derivative))),
                cell(unit.of(values(&|d| d.error))),
                per(key),
                cell(values(&|d| self.relative(d, key))),
                change.to_owned(),
            ]);
        }
        let of_records = if self.run.records.len() > 1 { ", medians over the records" } else { "" };
        (format!("{}{of_records}", title(&column.name())), rows)
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.shown().len() < self.run.demands.len() {
            notes.push(format!(
                "{} of {} demands are shown; all are in sensitivity.csv.",
                self.shown().len(),
                self.run.demands.len()
            ));
        }
        let tiny = |d: &&Derivative| {
            let key = &self.run.keys[d.key];
            d.relative(key).is_finite() && self.relative(d, key).is_nan()
        };
        if self.run.derivatives.iter().any(|d| tiny(&d)) {
            notes.push(format!(
                "No percentage is given of residuals below {} % of the peak sliding displacement.",
                compact(100.0 * LEAST_RESIDUAL)
            ));
        }
        let changed = self.run.derivatives.iter().filter(|d| d.events_change).count();
        if changed > 0 {
            notes.push(format!(
                "{changed} of {} derivatives are of a step within which the order or number of events changes.",
                self.run.derivatives.len()
            ));
        }
        let closest = self.run.records.iter().filter_map(|r| Some((r, r.closest_call?)));
        if let Some((record, call)) = closest.min_by(|a, b| a.1.margin.total_cmp(&b.1.margin)) {
            notes.push(format!(
                "The closest call of the model as it stands has a margin of {} ({}).",
                significant(call.margin, 2),
                record.name
            ));
        }
        notes
    }

    /// Bars of the relative changes, the longest on top.
    fn figure(&self, demand: usize, id: &str) -> Option<Drawn> {
        let mut ranked = self.ranked(demand);
        ranked.truncate(20);
        ranked.reverse();
        if ranked.is_empty() {
            return None;
        }
        let what = title(&self.run.demands[demand].name());
        let names = ranked.iter().map(|(key, ..)| path_words(&key.path)).collect();
        let bar = |(i, (_, change, _)): (usize, &(&Key, f64, bool))| {
            let (low, high) = (i as f64 + 0.68, i as f64 + 1.32);
            let fill = BARS[usize::from(*change < 0.0)];
            let points = vec![[0.0, low], [*change, low], [*change, high], [0.0, high]];
            PlotSeries {
                label: String::new(),
                style: Style::MAIN,
                shape: Shape::Band(fill),
                points,
            }
        };
        let changes = ranked.iter().map(|(_, change, _)| *change);
        let x = Axis::symmetric(change(&self.run.demands[demand].name()), changes);
        let count = ranked.len() as f64;
        let axis = Style { colour: "#1a1a1a", width: 0.8, dashes: "" };
        let zero = line("", axis, vec![[0.0, 0.5], [0.0, count + 0.5]]);
        let series = ranked.iter().enumerate().map(bar).chain([zero]).collect();
        let panel = panel(x, Axis::named("", names), 24.0 * count + 16.0, series);
        let most = ranked.last().map_or(String::new(), |(key, ..)| path_words(&key.path));
        let caption = format!(
            "{what}: what 1 % more of each key changes, in %; the strongest, {most}, on top."
        );
        let figure = Figure {
            id: id.to_owned(),
            title: format!("Sensitivity of the {}", what.to_lowercase()),
            description: caption.clone(),
            layout: Layout::Stacked,
            panels: vec![panel],
            shaded: Vec::new(),
        };
        Some(Drawn::new(figure, caption))
    }

    fn json(&self) -> impl Serialize {
        let run = self.run;
        view! {
            model: self.name,
            keys: each(&run.keys, |Key { path, unit, value, .. }| view! { path, unit, value }),
            records: each(&run.records, |of| {
                view! {
                    name: &of.name,
                    scale: of.scale,
                    holds: of.holds,
                    closest_call: of.closest_call.map(|call| call.margin),
                    analyses: of.analyses,
                }
            }),
            runs: run.runs,
            failed: run.failures.len(),
            derivatives: each(&run.derivatives, |d| {
                view! {
                    record: &run.records[d.record].name,
                    path: &run.keys[d.key].path,
                    demand: run.demands[d.demand].name(),
                    value: d.value,
                    derivative: d.derivative,
                    error: d.error,
                    relative: d.relative(&run.keys[d.key]),
                    step: d.step,
                    events_change: d.events_change,
                }
            }),
        }
    }
}

/// The middle of the numbers among them.
fn median(values: &[f64]) -> Option<f64> {
    let mut finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    let n = finite.len();
    match n {
        0 => None,
        _ if n % 2 == 1 => finite.get(n / 2).copied(),
        _ => Some(0.5 * (finite[n / 2 - 1] + finite[n / 2])),
    }
}
