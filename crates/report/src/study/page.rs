//! A study as a page: the answer, how demands grow with the level, the tables.

use serde::Serialize;
use slipstick::notice::{Notice, NoticeKind};
use slipstick::response::DemandColumn;
use slipstick::study::{Certified, LevelSummary, Study, StudySummary};

use super::{level, level_number, level_unit, said};
use crate::assessment::lines::{BAND, FRACTILES, band, group_style, line, panel, stacked};
use crate::assessment::pairs;
use crate::assessment::sheet::{Sheet, SheetTable, cell};
use crate::display::{DisplayUnits, Unit};
use crate::figures::Drawn;
use crate::json::pretty;
use crate::markup::shortened;
use crate::number::{compact, count};
use crate::plot::{Axis, Panel, PlotSeries, Style};
use crate::view;

/// What the page of a study is told from.
#[derive(Clone, Copy, Debug)]
pub struct StudyReport<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its figures.
    pub summary: &'a StudySummary,
    /// How many rows were run again alone and judged.
    pub certified: &'a Certified,
    /// What was noticed.
    pub notices: &'a [String],
    /// Units to show results in.
    pub display: DisplayUnits,
}

impl StudyReport<'_> {
    /// The result laid out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let cases = self.study.cases();
        let times = |n: u64, what: &str| match n {
            1 => format!("1 {what}"),
            n => format!("{} {what}s", count(n)),
        };
        let mut line = format!(
            "{} runs: {} × {} × {}",
            count(self.study.runs()),
            times(cases.records, "record"),
            times(cases.levels, "level"),
            times(cases.samples, "sample")
        );
        if self.study.has_bounds() {
            line.push_str(&format!(" × {} of friction", times(cases.bounds, "bound")));
        }
        Sheet {
            kind: "Study",
            name: self.summary.name.clone(),
            line,
            display: self.display,
            verdict: self.verdict(),
            warnings: self.warnings(),
            tables: self.tables(),
            figures: self.figures(),
            method: self.method(),
            complete: true,
            json: pretty(&self.json()),
            ..Sheet::default()
        }
        .certified(Some(self.certified.clone()))
    }

    /// The rows of a demand that have values.
    fn rows(&self, demand: DemandColumn) -> Vec<&LevelSummary> {
        super::rows(self.summary, demand)
    }

    fn unit(&self, demand: DemandColumn) -> Unit {
        self.display.unit(demand.dimension().into(), super::largest(&self.rows(demand)))
    }

    /// What is asked for first: displacement, acceleration at the top, drift of the lowest storey.
    fn answers(&self) -> Vec<DemandColumn> {
        let displacement = DemandColumn::of_name("peak_sliding_displacement_m");
        let drift = DemandColumn::of_name("storey1_peak_drift_m");
        let all = [displacement, Some(self.study.shape().roof_acceleration()), drift];
        let there = |demand: &DemandColumn| !self.rows(*demand).is_empty();
        all.into_iter().flatten().filter(there).collect()
    }

    /// The row of a demand that governs: of the last level, the bound with the largest median.
    fn governs(&self, demand: DemandColumn) -> Option<&LevelSummary> {
        let rows = self.rows(demand);
        let last = rows.iter().map(|row| row.level).max()?;
        let of_last = rows.into_iter().filter(|row| row.level == last);
        of_last.reduce(|a, b| if b.quantiles[1].abs() > a.quantiles[1].abs() { b } else { a })
    }

    fn at(&self, row: &LevelSummary) -> String {
        let what = match &self.summary.measure {
            Some((measure, _)) => {
                format!("at {measure} = {}", level(self.summary, row, self.display))
            }
            None if self.study.cases().levels > 1 => {
                format!("with the records × {}", level(self.summary, row, self.display))
            }
            None => "over all runs".to_owned(),
        };
        match row.friction {
            Some("nominal") | None => what,
            Some(bound) => format!("{what} with {bound} friction, which governs"),
        }
    }

    /// Displacement, gap and acceleration at the highest level.
    fn verdict(&self) -> Vec<String> {
        let say = |demand: DemandColumn| {
            let row = self.governs(demand)?;
            let unit = self.unit(demand);
            let told = |value: f64| match value.is_infinite() {
                true => "beyond the travel".to_owned(),
                false => format!("{} {}", cell(unit.of(value)), unit.symbol).trim_end().to_owned(),
            };
            let [low, middle, high] = row.quantiles;
            let low = if low.is_finite() { cell(unit.of(low)) } else { told(low) };
            let record = shortened(super::file_name(&row.max_record), 40);
            let run = row.max_run.map_or_else(String::new, count);
            let largest = match row.beyond {
                0 => format!("largest {} ({record}, run {run})", told(row.max)),
                beyond => {
                    let all = count(row.runs - row.failures + beyond);
                    format!(
                        "{} of {all} runs used up the travel, the first of them {record}, run {run}",
                        count(beyond)
                    )
                }
            };
            Some(format!(
                "{} {}: median {} (16 to 84 %: {low} to {}), {largest}.",
                self.summary.names.title(&demand),
                self.at(row),
                told(middle),
                told(high),
            ))
        };
        let mut said: Vec<String> = self.answers().into_iter().filter_map(say).take(2).collect();
        if let Some(row) = DemandColumn::of_name("gap_ratio").and_then(|gap| self.governs(gap)) {
            let percent = |ratio: f64| compact(libm::round(100.0 * ratio));
            said.insert(
                said.len().min(1),
                format!(
                    "Of the gap {} % is used {} in the median, and at most {} %.",
                    percent(row.quantiles[1]),
                    self.at(row),
                    percent(row.max)
                ),
            );
        }
        said
    }

    fn warnings(&self) -> Vec<Notice> {
        let warn = |kind, message| Notice::new(kind, message);
        let failed = super::without_answer(self.summary).map(|message| {
            let message = format!("{message}: see the column status of the parts");
            warn(NoticeKind::FailedRuns, message)
        });
        let rows: u64 = {
            let first = self.summary.rows.first().map(|row| row.demand);
            let of_first = self.summary.rows.iter().filter(|row| Some(row.demand) == first);
            of_first.map(|row| row.runs).sum()
        };
        let missing = (rows < self.study.runs()).then(|| {
            let all = count(self.study.runs());
            warn(NoticeKind::Incomplete, format!("{} of {all} runs are in the folder", count(rows)))
        });
        let noticed = self.notices.iter().map(|notice| warn(NoticeKind::Inputs, notice.clone()));
        let all = failed.into_iter().chain(missing).chain(said(self.summary)).chain(noticed);
        let mut all: Vec<Notice> = all.collect();
        Notice::sort(&mut all);
        all
    }

    fn tables(&self) -> Vec<SheetTable> {
        let matched = self.study.matched().map(|matched| pairs::table(self.pairs(), matched));
        super::tables(self.summary, self.display).into_iter().chain(matched).collect()
    }

    fn figures(&self) -> Vec<Drawn> {
        let moves = |demand: &DemandColumn| self.rows(*demand).iter().any(|row| row.max != 0.0);
        let drawn: Vec<DemandColumn> = self.answers().into_iter().filter(moves).collect();
        let mut figures = self.demands_figure(&drawn);
        figures.extend(self.study.matched().map(pairs::figure));
        figures
    }

    fn demands_figure(&self, drawn: &[DemandColumn]) -> Vec<Drawn> {
        if drawn.is_empty() {
            return Vec::new();
        }
        if self.study.cases().levels > 1 {
            let panels = drawn.iter().map(|demand| self.over_levels(*demand)).collect();
            let caption = if self.study.has_bounds() {
                "Demands over all records and samples as the level rises, for each bound of friction: \
                 median (thick), 16 and 84 % fractiles (thin)."
            } else {
                "Demands over all records and samples as the level rises: median, 16 and 84 % fractiles, \
                 and the largest of all runs."
            }
            .to_owned();
            return vec![stacked("levels", "Demands over levels", caption, panels)];
        }
        let panels = drawn.iter().map(|demand| self.distribution(*demand)).collect();
        let caption = "Share of the runs in which a demand is not exceeded.".to_owned();
        vec![stacked("distributions", "Distributions of demands", caption, panels)]
    }

    /// Names of the pairs, those of their first components.
    fn pairs(&self) -> impl Iterator<Item = &str> {
        let components = 1 + usize::from(self.study.has_pairs());
        self.study.records().iter().step_by(components).map(|record| super::file_name(&record.name))
    }

    /// Names of the bounds of friction; one empty name without them.
    fn bounds(&self) -> Vec<Option<&'static str>> {
        if !self.study.has_bounds() {
            return vec![None];
        }
        self.study.bounds().iter().map(|bound| Some(bound.name)).collect()
    }

    fn over_levels(&self, demand: DemandColumn) -> Panel {
        let (unit, at) = (self.unit(demand), level_unit(self.summary, self.display));
        let bounds = self.bounds();
        let many = bounds.len() > 1;
        let mut series: Vec<PlotSeries> = Vec::new();
        let rows = self.rows(demand);
        for (i, bound) in bounds.iter().enumerate() {
            let mut own: Vec<&LevelSummary> =
                rows.iter().copied().filter(|row| row.friction == *bound).collect();
            own.sort_by(|a, b| level_number(a).total_cmp(&level_number(b)));
            let x: Vec<f64> = own.iter().map(|row| at.of(level_number(row))).collect();
            let of = |pick: &dyn Fn(&LevelSummary) -> f64| -> Vec<f64> {
                own.iter().map(|row| unit.of(pick(row))).collect()
            };
            let points = |y: Vec<f64>| {
                let known = x.iter().copied().zip(y).filter(|(_, y)| y.is_finite());
                known.map(|(x, y)| [x, y]).collect()
            };
            let (low, high) = (of(&|row| row.quantiles[0]), of(&|row| row.quantiles[2]));
            if !many {
                series.push(band(&x, &low, &high, "16 to 84 %", BAND));
            }
            let style = if many { group_style(i) } else { FRACTILES[1] };
            let label = bound.map_or("median".to_owned(), |bound| format!("{bound} friction"));
            if many {
                let thin = Style { width: 0.6, ..style };
                series.push(line("", thin, points(low)));
                series.push(line("", thin, points(high)));
            } else {
                let largest = of(&|row| row.max.abs());
                series.push(line("largest", Style::DOTTED, points(largest)));
            }
            series.push(line(label, style, points(of(&|row| row.quantiles[1]))));
        }
        let name = match &self.summary.measure {
            Some((measure, _)) => measure.clone(),
            None => "Factor on the records".to_owned(),
        };
        let x = Axis::from_zero(at.label(&name), rows.iter().map(|row| at.of(level_number(row))));
        let all = series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).collect::<Vec<_>>();
        let y = Axis::from_zero(unit.label(&self.summary.names.title(&demand)), all);
        panel(x, y, 170.0, series)
    }

    fn distribution(&self, demand: DemandColumn) -> Panel {
        let unit = self.unit(demand);
        let rows = self.rows(demand);
        let mut series = Vec::new();
        for (i, bound) in self.bounds().iter().enumerate() {
            for row in rows.iter().filter(|row| row.friction == *bound) {
                let known = row.distribution.iter().filter(|[_, value]| value.is_finite());
                let points = known.map(|[p, value]| [unit.of(*value), 100.0 * p]).collect();
                let label = bound.map_or(String::new(), |bound| format!("{bound} friction"));
                series.push(line(label, group_style(i), points));
            }
        }
        let all: Vec<f64> = series.iter().flat_map(|s| s.points.iter().map(|p| p[0])).collect();
        let x = Axis::from_zero(unit.label(&self.summary.names.title(&demand)), all);
        panel(x, Axis::linear("Share of the runs (%)".to_owned(), 0.0, 100.0), 150.0, series)
    }

    fn method(&self) -> Vec<String> {
        let mut method = vec![
            "Quantiles are exact, over all records and samples of a level, and linear between \
             neighbours of the sorted values; failed runs are left out."
                .to_owned(),
            match self.certified.certified {
                0 => "No run was run again alone and judged: slipstick study does so with one of a thousand and \
                      the first of each kind."
                    .to_owned(),
                _ => "One run of a thousand and the first of each kind of structure and directions were run \
                      again alone: the same bits, and a certificate that holds."
                    .to_owned(),
            },
        ];
        if self.study.has_bounds() {
            let factor = |bound: &slipstick::input::Bound| {
                format!("{} (× {})", bound.name, compact(bound.friction_factor))
            };
            let names: Vec<String> = self.study.bounds().iter().map(factor).collect();
            method.push(format!("Both coefficients of friction: {}.", names.join(", ")));
        }
        if let Some(matched) = self.study.matched() {
            method.push(pairs::method(matched));
        }
        if self.study.is_in_plane() {
            let both =
                "Both components of a pair move the table at once; demands are of the resultants.";
            method.push(both.to_owned());
        }
        let pairs = self.study.has_pairs() || self.study.is_in_plane();
        if pairs && self.study.level(0).is_some() {
            method.push(
                "Both components of a pair take one factor; a measure of a component is the geometric \
                 mean of both."
                    .to_owned(),
            );
        }
        if self.study.cases().samples > 1 {
            method.push(
                "All samples have equal weight; quantiles mix records and samples, so that they are \
                 those of both together."
                    .to_owned(),
            );
        }
        method
    }

    fn json(&self) -> impl Serialize {
        let cases = self.study.cases();
        view! {
            name: &self.summary.name,
            runs: self.study.runs(),
            records: cases.records,
            levels: cases.levels,
            samples: cases.samples,
        }
    }
}
