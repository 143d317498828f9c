//! Incremental dynamic analysis.

mod family;

use serde::Serialize;
use slipstick::assessment::FailedRun;
use slipstick::assessment::SHARES;
use slipstick::assessment::fragility::Fragility;
use slipstick::assessment::ida::{Crossing, Curve, demand_fractiles, level_fractiles};
use slipstick::assessment::observed::Averaged;
use slipstick::notice::{Notice, NoticeKind};
use slipstick::study::{Demanded, travel_used_up};

pub use family::IdaFamily;

use super::key::{of_measure, quantity, title};
use super::lines::{FRACTILES, clipped, line, panel, share_names, single};
use super::sheet::{Sheet, cell, counted, counted_as, failed};
use crate::display::{DisplayUnits, Unit};
use crate::figures::Drawn;
use crate::json::{each, pretty};
use crate::legend::{LIMIT, ONE_RECORD};
use crate::plot::{Axis, PlotSeries};
use crate::view;

/// What an incremental dynamic analysis is told from.
#[derive(Clone, Debug)]
pub struct IdaReport<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// The intensity measure, as `Sa(1.2 s, 5 %)`.
    pub measure: &'a str,
    /// Its SI unit.
    pub measure_unit: &'a str,
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on the demand, SI, where one is asked for.
    pub limit: Option<f64>,
    /// What each curve is of: a record, with its design where there are several.
    pub records: &'a [String],
    /// The curves.
    pub curves: &'a [Curve],
    /// Designs that it averages over.
    pub averaged: &'a Averaged,
    /// Whether the levels are the same for all records; else they were hunted.
    pub fixed_levels: bool,
    /// A lognormal fit of the capacities, or why there is none.
    pub fit: Option<&'a Result<Fragility, slipstick::error::FitError>>,
    /// Runs without an answer.
    pub failures: &'a [FailedRun],
    /// What reading the records gave notice of.
    pub warnings: &'a [Notice],
    /// Units to show results in.
    pub display: DisplayUnits,
}

impl IdaReport<'_> {
    /// Number of runs.
    #[must_use]
    pub fn runs(&self) -> usize {
        self.curves.iter().map(|curve| curve.levels.len()).sum()
    }

    /// First crossings of the limit, one a record.
    #[must_use]
    pub fn crossings(&self) -> Vec<Crossing> {
        let limit = self.limit.unwrap_or(f64::INFINITY);
        self.curves.iter().map(|curve| curve.first_crossing(limit)).collect()
    }

    fn demand_unit(&self) -> Unit {
        self.display.unit(quantity(self.demand), self.largest_demand())
    }

    fn largest_demand(&self) -> f64 {
        if let Some(limit) = self.limit {
            return limit;
        }
        let all = self.curves.iter().flat_map(|c| c.demands.iter().map(|demand| demand.value()));
        all.filter(|d| d.is_finite()).fold(0.0, f64::max)
    }

    fn measure_unit(&self) -> Unit {
        let all = self.curves.iter().flat_map(|c| c.levels.iter().copied());
        of_measure(self.measure_unit, self.display, all.fold(0.0, f64::max))
    }

    /// Levels and the fractiles of the demand there, where the levels are the same for all records.
    #[must_use]
    pub fn demands_by_level(&self) -> Vec<(f64, [f64; 3])> {
        if !self.fixed_levels {
            return Vec::new();
        }
        let levels = self.curves.first().map_or(&[][..], |curve| &curve.levels[..]);
        let of = |(i, level): (usize, &f64)| {
            let there: Vec<Demanded> = self
                .curves
                .iter()
                .map(|curve| curve.demands.get(i).copied().unwrap_or(Demanded::Unknown))
                .collect();
            (*level, demand_fractiles(&there))
        };
        levels.iter().enumerate().map(of).collect()
    }

    /// Demands from 0 to the limit (or the largest), and the fractiles of the intensity that first
    /// reaches each.
    #[must_use]
    pub fn levels_by_demand(&self) -> Vec<(f64, [f64; 3])> {
        const STEPS: usize = 60;
        let last = self.largest_demand();
        if !(last > 0.0) {
            return Vec::new();
        }
        let of = |i: usize| {
            let demand = last * i as f64 / STEPS as f64;
            (demand, level_fractiles(self.curves, demand))
        };
        (1..=STEPS).map(of).collect()
    }

    /// The result laid out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let what = if self.fixed_levels { "fixed levels" } else { "hunt and fill" };
        Sheet {
            kind: "Incremental dynamic analysis",
            name: self.name.to_owned(),
            first: self.first(),
            line: format!(
                "{}, {} runs, {} over {}, {what}",
                self.of_what(),
                self.runs(),
                title(self.demand),
                self.measure
            ),
            display: self.display,
            verdict: self.verdict(),
            complete: self.failures.is_empty(),
            warnings: self.all_warnings(),
            tables: self.tables(),
            notes: self.notes(),
            figures: vec![self.figure()],
            method: self.method(),
            json: pretty(&self.json()),
            ..Sheet::default()
        }
    }

    /// Records, and designs where there are several.
    fn of_what(&self) -> String {
        let designs = self.averaged.designs.max(1);
        let records = format!("{} records", self.records.len() / designs);
        if designs == 1 { records } else { format!("{records} × {designs} designs") }
    }

    /// What the curves are called that fractiles are taken of.
    fn each(&self) -> &'static str {
        if self.averaged.designs > 1 { "curves" } else { "records" }
    }

    /// Over what it averages.
    fn first(&self) -> Option<(&'static str, String)> {
        (self.averaged.designs > 1).then(|| ("Fitted", format!("to all curves, {}", self.averaged)))
    }

    /// The intensity at which records reach the limit, or the demand at the highest level.
    fn verdict(&self) -> Vec<String> {
        let (im, edp) = (self.measure_unit(), self.demand_unit());
        let what = title(self.demand).to_lowercase();
        if let Some(limit) = self.limit {
            let [low, middle, high] = level_fractiles(self.curves, limit).map(|v| cell(im.of(v)));
            let limit = format!("{} {}", cell(edp.of(limit)), edp.symbol);
            return vec![format!(
                "Half of the {} reach a {what} of {} at {} = {middle} {} (16 to 84 %: {low} to \
                 {high} {}).",
                self.each(),
                limit.trim_end(),
                self.measure,
                im.symbol,
                im.symbol
            )];
        }
        let by_level = self.demands_by_level();
        let of = |(level, values): &(f64, [f64; 3])| {
            let [low, middle, high] = values.map(|v| cell(edp.of(v)));
            format!(
                "Median {what} at {} = {} {}: {middle} {} (16 to 84 %: {low} to {high}).",
                self.measure,
                cell(im.of(*level)),
                im.symbol,
                edp.symbol
            )
        };
        by_level.last().map(of).into_iter().collect()
    }

    fn all_warnings(&self) -> Vec<Notice> {
        let mut all: Vec<Notice> =
            failed(self.failures, self.runs() as u64, &counted_as(self.failures))
                .into_iter()
                .collect();
        if self.limit.is_some() {
            let back: Vec<String> = self
                .crossings()
                .iter()
                .zip(self.records)
                .filter_map(|(crossing, record)| {
                    let level = self.measure_unit();
                    crossing.returns.map(|at| {
                        format!(
                            "{record}: the demand is below the limit again at {} {}; the first \
                             crossing counts",
                            cell(level.of(at)),
                            level.symbol
                        )
                    })
                })
                .collect();
            all.extend(counted(NoticeKind::Resurrection, &back));
            let crossings = self.crossings();
            let cut_short = crossings.iter().filter(|crossing| crossing.cut_short).count();
            if cut_short > 0 {
                let message = format!(
                    "{cut_short} of {} {} end in runs of which nothing is known below the limit: they are left out of \
                     the fractiles, and their capacity is known up to those runs only",
                    self.records.len(),
                    self.each()
                );
                all.push(Notice::new(NoticeKind::LimitNotReached, message));
            }
            let never = crossings
                .iter()
                .filter(|crossing| !crossing.reached && !crossing.cut_short)
                .count();
            if never > 0 {
                let message = format!(
                    "{never} of {} {} do not reach the limit at their highest level: their \
                     capacity is known from below only",
                    self.records.len(),
                    self.each()
                );
                all.push(Notice::new(NoticeKind::LimitNotReached, message));
            }
        }
        all.extend(self.warnings.iter().cloned());
        all
    }

    fn tables(&self) -> Vec<(String, Vec<Vec<String>>)> {
        let (im, edp) = (self.measure_unit(), self.demand_unit());
        let mut tables = Vec::new();
        let by_level = self.demands_by_level();
        let names = share_names();
        if !by_level.is_empty() {
            let heads = std::iter::once(im.label(self.measure)).chain(names.clone()).collect();
            let row = |(level, values): &(f64, [f64; 3])| {
                let numbers = values.iter().map(|value| cell(edp.of(*value)));
                std::iter::once(cell(im.of(*level))).chain(numbers).collect()
            };
            let rows = std::iter::once(heads).chain(by_level.iter().map(row)).collect();
            tables.push((edp.label(&title(self.demand)), rows));
        }
        if let Some(limit) = self.limit {
            let [low, middle, high] = level_fractiles(self.curves, limit).map(|v| cell(im.of(v)));
            let heads = [im.label(self.measure)].into_iter().chain(names).collect();
            let row = vec![format!("at {} {}", cell(edp.of(limit)), edp.symbol), low, middle, high];
            tables.push((
                "Intensity at which the limit is first reached".to_owned(),
                vec![heads, row],
            ));
            let mut rows = vec![vec![
                "Record".to_owned(),
                im.label("Capacity"),
                "between".to_owned(),
                "and".to_owned(),
            ]];
            for (crossing, record) in self.crossings().iter().zip(self.records) {
                let above = if crossing.reached { "" } else { "> " };
                rows.push(vec![
                    record.clone(),
                    format!("{above}{}", cell(im.of(crossing.level))),
                    cell(im.of(crossing.between[0])),
                    cell(im.of(crossing.between[1])),
                ]);
            }
            tables.push(("Capacities".to_owned(), rows));
        }
        tables
    }

    fn notes(&self) -> Vec<String> {
        let im = self.measure_unit();
        match self.fit {
            None => Vec::new(),
            Some(Ok(fragility)) => {
                let curve = fragility.curve();
                vec![format!(
                    "Lognormal capacity by maximum likelihood: median {} {}, dispersion {}. \
                     slipstick fragility on ida.csv gives its certainty.",
                    cell(im.of(curve.median)),
                    im.symbol,
                    cell(curve.dispersion)
                )]
            }
            Some(Err(error)) => vec![format!("No lognormal fit of the capacities: {error}.")],
        }
    }

    fn figure(&self) -> Drawn {
        let (im, edp) = (self.measure_unit(), self.demand_unit());
        let largest = self.largest_demand();
        let x_end = edp.of(if self.limit.is_some() { 1.6 * largest } else { largest });
        let top = self
            .curves
            .iter()
            .flat_map(|curve| curve.levels.iter().zip(&curve.demands))
            .filter(|(_, demand)| demand.value() <= 1.6 * largest)
            .map(|(level, _)| im.of(*level))
            .fold(0.0, f64::max);
        let y_end = if top > 0.0 { 1.05 * top } else { 1.0 };
        let ends = [x_end, y_end];
        let of_curve = |curve: &Curve| -> Vec<[f64; 2]> {
            let points = curve.levels.iter().zip(&curve.demands);
            let known = points.filter(|(_, demand)| !demand.value().is_nan());
            let points = known.map(|(level, demand)| [edp.of(demand.value()), im.of(*level)]);
            std::iter::once([0.0, 0.0]).chain(points).collect()
        };
        let mut series: Vec<PlotSeries> = Vec::new();
        for (i, curve) in self.curves.iter().enumerate() {
            let label = if i == 0 { ONE_RECORD.label } else { "".into() };
            series.push(line(label, ONE_RECORD.style, clipped(&of_curve(curve), ends)));
        }
        let by_demand = self.levels_by_demand();
        for (i, (style, name)) in FRACTILES.iter().zip(share_names()).enumerate() {
            let points: Vec<[f64; 2]> = std::iter::once([0.0, 0.0])
                .chain(by_demand.iter().map(|(demand, levels)| [edp.of(*demand), im.of(levels[i])]))
                .collect();
            // The start is not at rest but at the level that first moves it.
            let points = if points.len() > 1 { &points[1..] } else { &points[..] };
            series.push(line(name, *style, clipped(points, ends)));
        }
        if let Some(limit) = self.limit {
            let x = edp.of(limit);
            series.push(line(LIMIT.label, LIMIT.style, vec![[x, 0.0], [x, y_end]]));
        }
        let axes = [
            Axis::linear(edp.label(&title(self.demand)), 0.0, x_end),
            Axis::linear(im.label(self.measure), 0.0, y_end),
        ];
        let [x, y] = axes;
        let caption = format!(
            "{} of every record (thin) as its {} rises, and the intensity that 16, 50 and 84 % of the \
             records need to reach a demand.",
            title(self.demand),
            self.measure
        );
        single("ida", "Incremental dynamic analysis", caption, panel(x, y, 300.0, series))
    }

    fn method(&self) -> Vec<String> {
        let mut method = vec![
            "Each record is scaled by one factor, its vertical component with it, so that its measure \
             takes the level. Scaling changes amplitude only, not frequency content or duration: the \
             higher the factor, the less the record is like one that was ever recorded."
                .to_owned(),
            "A capacity is the first crossing of the limit as intensity rises, on straight lines between \
             runs; a return below the limit beyond it is reported above and not used."
                .to_owned(),
            "Fractiles interpolate linearly between sorted values, at position p (n − 1) counted from 0; \
             a record that does not reach, and the sliding displacement of a run that used up its travel, count as \
             above all. A run without an answer for another reason is left out."
                .to_owned(),
        ];
        if !self.fixed_levels {
            method.push(
                "Hunt and fill: the level is doubled until the limit is reached; gaps down to a tenth of \
                 that level are divided until neighbours differ by 5 %; the gap around the first crossing \
                 is halved to 1 %. Two crossings inside one gap of 5 % cancel unseen."
                    .to_owned(),
            );
        }
        method
    }

    fn json(&self) -> impl Serialize {
        let crossings = self.crossings();
        let fractiles = |[p16, p50, p84]: [f64; 3]| view! { p16, p50, p84 };
        let fit = self.fit.and_then(|fit| fit.as_ref().ok()).map(Fragility::curve);
        let records = self.records.iter().zip(self.curves).zip(&crossings);
        view! {
            model: self.name,
            measure: self.measure,
            measure_unit: self.measure_unit,
            demand: self.demand,
            limit: self.limit,
            runs: self.runs(),
            failed: self.failures.len(),
            used_up_travel: travel_used_up(self.failures),
            shares: SHARES,
            capacity: self.limit.map(|limit| fractiles(level_fractiles(self.curves, limit))),
            lognormal: fit.map(|fit| view! { median: fit.median, dispersion: fit.dispersion }),
            demand_by_level: each(self.demands_by_level(), |(level, demands)| {
                view! { level, #[serde(flatten)] demands: fractiles(demands) }
            }),
            level_by_demand: each(self.levels_by_demand(), |(demand, levels)| {
                view! { demand, #[serde(flatten)] levels: fractiles(levels) }
            }),
            averaged: view! { paths: &self.averaged.paths, designs: self.averaged.designs },
            records: each(records, |((record, curve), crossing)| {
                let of_limit = self.limit.map(|_| {
                    view! {
                        capacity: crossing.level,
                        reached: crossing.reached,
                        between: crossing.between,
                        returns_at: crossing.returns,
                    }
                });
                view! {
                    record,
                    levels: &curve.levels,
                    demands: each(&curve.demands, |demand| demand.value()),
                    #[serde(flatten)] of_limit,
                }
            }),
        }
    }
}
