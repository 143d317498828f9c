//! Incremental dynamic analyses of the same records by the values of a path.

use serde::Serialize;
use slipstick::assessment::FailedRun;
use slipstick::assessment::ida::{IdaGroup, IdaRun, level_fractiles};
use slipstick::motion::intensity::LevelMeasure;
use slipstick::notice::Notice;

use super::IdaReport;
use crate::assessment::key::{about_curve, group_value, title};
use crate::assessment::lines::{clipped, group_style, line, panel, share_names, single};
use crate::assessment::sheet::{Sheet, cell, counted_as, failed};
use crate::display::DisplayUnits;
use crate::figures::Drawn;
use crate::json::{each, pretty};
use crate::legend::{LIMIT, ONE_RECORD};
use crate::number::compact;
use crate::plot::{Axis, PlotSeries};
use crate::view;

/// What an incremental dynamic analysis of one or several designs is told from.
#[derive(Clone, Debug)]
pub struct IdaFamily<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// The intensity measure.
    pub measure: &'a LevelMeasure,
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on the demand, SI, where one is asked for.
    pub limit: Option<f64>,
    /// Whether the levels are the same for all records; else they were hunted.
    pub fixed_levels: bool,
    /// What came of it.
    pub run: &'a IdaRun,
    /// What reading the records gave notice of.
    pub warnings: &'a [Notice],
    /// Units to show results in.
    pub display: DisplayUnits,
}

impl IdaFamily<'_> {
    /// The result laid out: one analysis, or one for each value of the path.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let measure = self.measure.to_string();
        let reports: Vec<IdaReport<'_>> =
            self.run.groups.iter().map(|group| self.report(group, &measure)).collect();
        match (&self.run.by, &reports[..]) {
            (None, [one]) => {
                let warnings = [&self.run.warnings[..], self.warnings].concat();
                IdaReport { failures: &self.run.failures, warnings: &warnings, ..one.clone() }
                    .sheet()
            }
            (by, _) => {
                let (by, unit) = by.as_ref().map_or(("", ""), |(by, unit)| (by, unit));
                Groups { family: self, by, unit, reports: &reports }.sheet(&measure)
            }
        }
    }

    fn report<'b>(&'b self, group: &'b IdaGroup, measure: &'b str) -> IdaReport<'b> {
        const NONE: &[FailedRun] = &[];
        IdaReport {
            name: self.name,
            measure,
            measure_unit: self.measure.unit(),
            demand: self.demand,
            limit: self.limit,
            records: &group.names,
            curves: &group.curves,
            averaged: &group.averaged,
            fixed_levels: self.fixed_levels,
            fit: group.fit.as_ref(),
            failures: NONE,
            warnings: &[],
            display: self.display,
        }
    }
}

/// One analysis for each value.
struct Groups<'a> {
    family: &'a IdaFamily<'a>,
    by: &'a str,
    unit: &'a str,
    reports: &'a [IdaReport<'a>],
}

impl Groups<'_> {
    fn each(&self) -> impl Iterator<Item = (String, &IdaReport<'_>)> {
        let label = |group: &IdaGroup| match group.value.is_nan() {
            true => group.text.clone(),
            false => format!("{} {}", compact(group.value), self.unit).trim_end().to_owned(),
        };
        self.family.run.groups.iter().map(label).zip(self.reports)
    }

    fn sheet(&self, measure: &str) -> Sheet {
        let family = self.family;
        let runs: usize = self.reports.iter().map(IdaReport::runs).sum();
        let first = self.reports.first();
        let averaged = first.map(|report| report.averaged).filter(|averaged| averaged.designs > 1);
        let averaged = averaged.map_or_else(String::new, |averaged| format!("; each {averaged}"));
        let mut warnings: Vec<Notice> =
            failed(&family.run.failures, runs as u64, &counted_as(&family.run.failures))
                .into_iter()
                .collect();
        for (label, report) in self.each() {
            let of_group = |warning: Notice| Notice {
                message: format!("{} = {label}: {}", self.by, warning.message),
                ..warning
            };
            warnings.extend(report.all_warnings().into_iter().map(of_group));
        }
        warnings.extend(family.run.warnings.iter().chain(family.warnings).cloned());
        let verdict = |(label, report): (String, &IdaReport<'_>)| {
            let said = report.verdict().into_iter().next()?;
            Some(about_curve(self.by, &label, &said))
        };
        let mut notes: Vec<String> = Vec::new();
        if family.limit.is_some() {
            notes.push(
                "Lognormal capacities by maximum likelihood; slipstick fragility on ida.csv gives \
                 their certainty."
                    .to_owned(),
            );
        }
        Sheet {
            kind: "Incremental dynamic analysis",
            name: family.name.to_owned(),
            first: Some(("Curves", format!("by {}{averaged}", self.by))),
            line: format!(
                "{}, {runs} runs, {} over {measure}, {}, {} values of {}",
                first.map_or_else(String::new, IdaReport::of_what),
                title(family.demand),
                if family.fixed_levels { "fixed levels" } else { "hunt and fill" },
                self.reports.len(),
                self.by
            ),
            display: family.display,
            verdict: self.each().filter_map(verdict).take(6).collect(),
            warnings,
            tables: self.tables(),
            notes,
            figures: vec![self.figure()],
            method: first.map_or_else(Vec::new, IdaReport::method),
            complete: family.run.failures.is_empty(),
            json: pretty(&self.json(measure)),
            ..Sheet::default()
        }
    }

    fn largest(&self) -> f64 {
        self.reports.iter().map(IdaReport::largest_demand).fold(0.0, f64::max)
    }

    fn tables(&self) -> Vec<(String, Vec<Vec<String>>)> {
        let Some(first) = self.reports.first() else { return Vec::new() };
        let (im, edp) = (first.measure_unit(), first.demand_unit());
        let mut tables = Vec::new();
        if let Some(limit) = self.family.limit {
            let heads = [self.by.to_owned()].into_iter().chain(share_names());
            let heads = heads.chain([im.label("Median θ"), "Dispersion β".to_owned()]).collect();
            let row = |(label, report): (String, &IdaReport<'_>)| {
                let shares = level_fractiles(report.curves, limit).map(|v| cell(im.of(v)));
                let fit = match report.fit {
                    Some(Ok(fit)) => {
                        let curve = fit.curve();
                        [cell(im.of(curve.median)), cell(curve.dispersion)]
                    }
                    _ => [cell(f64::NAN), cell(f64::NAN)],
                };
                [label].into_iter().chain(shares).chain(fit).collect()
            };
            let rows = std::iter::once(heads).chain(self.each().map(row)).collect();
            let reached = format!("{} {}", cell(edp.of(limit)), edp.symbol);
            tables.push((
                im.label(&format!("Intensity at which {} is first reached", reached.trim_end())),
                rows,
            ));
        }
        let by_level = first.demands_by_level();
        if !by_level.is_empty() {
            let heads: Vec<String> =
                [im.label(first.measure)].into_iter().chain(self.each().map(|e| e.0)).collect();
            let medians: Vec<_> = self.reports.iter().map(IdaReport::demands_by_level).collect();
            let row = |(i, (level, _)): (usize, &(f64, [f64; 3]))| {
                let of = |report: &Vec<(f64, [f64; 3])>| cell(edp.of(report[i].1[1]));
                std::iter::once(cell(im.of(*level))).chain(medians.iter().map(of)).collect()
            };
            let rows = std::iter::once(heads).chain(by_level.iter().enumerate().map(row)).collect();
            let what = title(self.family.demand);
            tables.push((edp.label(&format!("{what}, median, by {}", self.by)), rows));
        }
        tables
    }

    fn figure(&self) -> Drawn {
        let first = &self.reports[0];
        let (im, edp) = (first.measure_unit(), first.demand_unit());
        let largest = self.largest();
        let limit = self.family.limit;
        let x_end = edp.of(if limit.is_some() { 1.6 * largest } else { largest });
        let points = |report: &IdaReport<'_>| -> f64 {
            let all = report.curves.iter().flat_map(|c| c.levels.iter().zip(&c.demands));
            let shown = all.filter(|(_, demand)| demand.value() <= 1.6 * largest);
            shown.map(|(level, _)| im.of(*level)).fold(0.0, f64::max)
        };
        let top = self.reports.iter().map(points).fold(0.0, f64::max);
        let ends = [x_end, if top > 0.0 { 1.05 * top } else { 1.0 }];
        let mut series: Vec<PlotSeries> = Vec::new();
        for report in self.reports {
            for curve in report.curves {
                let points = curve.levels.iter().zip(&curve.demands);
                let points = points.filter(|(_, demand)| !demand.value().is_nan());
                let points = points.map(|(level, demand)| [edp.of(demand.value()), im.of(*level)]);
                let points: Vec<_> = std::iter::once([0.0, 0.0]).chain(points).collect();
                let label = if series.is_empty() { ONE_RECORD.label } else { "".into() };
                series.push(line(label, ONE_RECORD.style, clipped(&points, ends)));
            }
        }
        for (i, (label, report)) in self.each().enumerate() {
            let medians = report.levels_by_demand().into_iter();
            let points: Vec<_> =
                medians.map(|(demand, levels)| [edp.of(demand), im.of(levels[1])]).collect();
            series.push(line(label, group_style(i), clipped(&points, ends)));
        }
        if let Some(limit) = limit {
            let x = edp.of(limit);
            series.push(line(LIMIT.label, LIMIT.style, vec![[x, 0.0], [x, ends[1]]]));
        }
        let x = Axis::linear(edp.label(&title(self.family.demand)), 0.0, ends[0]);
        let y = Axis::linear(im.label(first.measure), 0.0, ends[1]);
        let caption = format!(
            "{} of every record (thin) as its {} rises, and for each value of {} the intensity that \
             half of the records need to reach a demand.",
            title(self.family.demand),
            first.measure,
            self.by
        );
        single("ida", "Incremental dynamic analysis", caption, panel(x, y, 300.0, series))
    }

    fn json(&self, measure: &str) -> impl Serialize {
        view! {
            model: self.family.name,
            measure,
            measure_unit: self.family.measure.unit(),
            demand: self.family.demand,
            limit: self.family.limit,
            by: self.by,
            by_unit: self.unit,
            groups: each(self.family.run.groups.iter().zip(self.reports), |(group, report)| {
                view! { value: group_value(group.value, &group.text), ida: report.json() }
            }),
        }
    }
}
