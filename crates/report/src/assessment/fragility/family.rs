//! Fragilities of the same table by the values of a path.

use slipstick::assessment::observed::{Averaged, FragilityGroup, FragilityRun};
use slipstick::assessment::suite::condensed;
use slipstick::notice::{Notice, NoticeKind};
use slipstick::table::Table;

use super::{FragilityReport, POINTS, add_curve};
use crate::assessment::key::{about_curve, group_value};
use crate::assessment::lines::{group_style, line, panel, single};
use crate::assessment::sheet::{Sheet, cell};
use crate::display::{DisplayUnits, Unit};
use crate::json::{each, pretty};
use crate::legend::PROBABILITY;
use crate::number::compact;
use crate::plot::Axis;
use crate::view;

/// What several fragilities are told from.
#[derive(Clone, Debug)]
pub struct FragilityFamily<'a> {
    /// Where the data came from, as a person calls it.
    pub name: &'a str,
    /// The path by which the rows were taken apart.
    pub by: &'a str,
    /// The SI unit of its values.
    pub by_unit: &'a str,
    /// A fragility for each value, or why there is none.
    pub groups: &'a [FragilityGroup],
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on it, SI.
    pub limit: Option<f64>,
    /// Confidence of intervals and bands.
    pub confidence: f64,
    /// Units to show results in.
    pub display: DisplayUnits,
}

impl FragilityFamily<'_> {
    fn report<'b>(&'b self, run: &'b FragilityRun) -> FragilityReport<'b> {
        FragilityReport {
            name: self.name,
            demand: self.demand,
            limit: self.limit,
            run,
            confidence: self.confidence,
            display: self.display,
        }
    }

    /// The fragilities that there are, with their values.
    fn reports(&self) -> Vec<(&FragilityGroup, FragilityReport<'_>)> {
        let report = |run| self.report(run);
        self.groups.iter().filter_map(|g| Some((g, report(g.run.as_ref().ok()?)))).collect()
    }

    /// A value as people read it: `2 m`.
    fn label(&self, group: &FragilityGroup) -> String {
        if group.value.is_nan() {
            return group.text.clone();
        }
        format!("{} {}", compact(group.value), self.by_unit).trim_end().to_owned()
    }

    /// The curves as a table, below one another, each row with the value of its curve.
    #[must_use]
    pub fn table(&self) -> Table {
        let of = |(group, report): (_, FragilityReport<'_>)| {
            report.curve().into_iter().map(move |row| (group, row)).collect::<Vec<_>>()
        };
        let curves: Vec<(&FragilityGroup, [f64; 4])> =
            self.reports().into_iter().flat_map(of).collect();
        let mut table = Table::default();
        if curves.iter().any(|(group, _)| group.value.is_nan()) {
            table.texts(self.by, curves.iter().map(|(group, _)| group.text.clone()).collect());
        } else {
            let values = curves.iter().map(|(group, _)| group.value);
            table.numbers(self.by, self.by_unit, values.collect());
        }
        let unit = self.reports().first().map_or("", |(_, first)| &first.run.measure_unit);
        let rows: Vec<[f64; 4]> = curves.into_iter().map(|(_, row)| row).collect();
        add_curve(&mut table, unit, &rows);
        table
    }

    /// The result laid out; empty where no value has a fragility.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let reports = self.reports();
        let Some((_, first)) = reports.first() else { return Sheet::default() };
        let unit = first.unit();
        let fitted = first.fitted();
        let fitted = fitted.split("; averaged").next().unwrap_or(&fitted);
        let labels: Vec<String> = reports.iter().map(|(group, _)| self.label(group)).collect();
        let of_curve = |i: usize| (labels[i].as_str(), &reports[i].1.run.warnings[..]);
        let mut warnings = condensed("curves", (0..reports.len()).map(of_curve));
        for group in self.groups {
            if let Err(error) = &group.run {
                let message = format!("{} = {}: {error}", self.by, self.label(group));
                warnings.push(Notice::new(NoticeKind::NoCurve, message));
            }
        }
        let averaged = |averaged: &Averaged| match averaged.designs {
            0 | 1 => String::new(),
            _ => format!("; each {averaged}"),
        };
        Sheet {
            kind: "Fragility",
            name: self.name.to_owned(),
            first: Some((
                "Fitted",
                format!("{fitted}; by {}{}", self.by, averaged(&first.run.averaged)),
            )),
            line: format!(
                "{} over {}, one curve for each of {} values of {}",
                first.exceedance(),
                first.run.measure,
                reports.len(),
                self.by
            ),
            display: self.display,
            verdict: reports
                .iter()
                .map(|(group, report)| {
                    about_curve(self.by, &self.label(group), &report.verdict(unit))
                })
                .take(6)
                .collect(),
            warnings,
            tables: vec![self.parameters(&reports, unit)],
            figures: vec![self.figure(&reports, unit)],
            method: first.method(),
            complete: reports.iter().all(|(_, report)| report.complete()),
            json: self.json(),
            ..Sheet::default()
        }
    }

    /// A row a curve.
    fn parameters(
        &self,
        reports: &[(&FragilityGroup, FragilityReport<'_>)],
        unit: Unit,
    ) -> (String, Vec<Vec<String>>) {
        let percent = compact(100.0 * self.confidence);
        let heads = [
            self.by,
            "Designs",
            &unit.label("Median θ"),
            "se of ln θ",
            &format!("{percent} % from"),
            "to",
            "Dispersion β",
            "from",
            "to",
        ];
        let mut rows = vec![heads.map(str::to_owned).to_vec()];
        for (group, report) in reports {
            let fragility = &report.run.fragility;
            let end = |end: Option<f64>, by: f64| end.map_or("open".to_owned(), |v| cell(v / by));
            let [low, high] = fragility.median_interval(self.confidence);
            let [least, most] = fragility.dispersion_interval(self.confidence);
            rows.push(vec![
                self.label(group),
                report.run.averaged.designs.to_string(),
                cell(unit.of(fragility.curve().median)),
                cell(fragility.standard_errors()[0]),
                end(low, unit.in_si),
                end(high, unit.in_si),
                cell(fragility.curve().dispersion),
                end(least, 1.0),
                end(most, 1.0),
            ]);
        }
        (format!("Lognormal fragility by {}", self.by), rows)
    }

    fn figure(
        &self,
        reports: &[(&FragilityGroup, FragilityReport<'_>)],
        unit: Unit,
    ) -> crate::figures::Drawn {
        let last = reports
            .iter()
            .filter_map(|(_, report)| report.curve().last().map(|row| row[0]))
            .fold(0.0, f64::max);
        let series = reports
            .iter()
            .enumerate()
            .map(|(i, (group, report))| {
                let curve = report.run.fragility.curve();
                let at = |i: usize| last * i as f64 / (POINTS - 1) as f64;
                let points = (0..POINTS)
                    .map(|i| {
                        let p = if i == 0 { 0.0 } else { curve.probability(at(i)) };
                        [unit.of(at(i)), p]
                    })
                    .collect();
                line(self.label(group), group_style(i), points)
            })
            .collect();
        let (x, y) = (
            Axis::linear(unit.label(&reports[0].1.run.measure), 0.0, unit.of(last)),
            Axis::linear(PROBABILITY.alone(Unit::NONE), 0.0, 1.0),
        );
        let caption = format!(
            "Probability of exceedance ({}) for each value of {}.",
            reports[0].1.exceedance(),
            self.by
        );
        single("fragility", "Fragility curves", caption, panel(x, y, 300.0, series))
    }

    fn json(&self) -> String {
        let reports = each(self.groups, |group| group.run.as_ref().map(|run| self.report(run)));
        pretty(&view! {
            name: self.name,
            by: self.by,
            by_unit: self.by_unit,
            demand: self.demand,
            limit: self.limit,
            curves: each(self.groups.iter().zip(&reports), |(group, found)| {
                let fragility = found.as_ref().ok().map(FragilityReport::json);
                let error = found.as_ref().err().map(ToString::to_string);
                view! {
                    value: group_value(group.value, &group.text),
                    #[serde(flatten)] fragility: fragility.map(|fragility| view! { fragility }),
                    #[serde(flatten)] error: error.map(|error| view! { error }),
                }
            }),
        })
    }
}
