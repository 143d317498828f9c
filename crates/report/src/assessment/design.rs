//! A design over a suite: front, choice, sensitivity, robustness.

mod figures;

use serde::Serialize;
use slipstick::assessment::design::{Bounded, DesignRun, Figures, Point, Target};
use slipstick::assessment::grid::Axis;
use slipstick::assessment::sensitivity::Index;
use slipstick::notice::{Notice, NoticeKind};
use slipstick::study::travel_used_up;

use super::key::{path_label, path_words, title};
use super::sheet::{Sheet, cell, counted_as, failed};
use crate::display::{DisplayUnits, Quantity, Unit};
use crate::json::{each, pretty};
use crate::number::compact;
use crate::view;

/// What a design is told from.
#[derive(Clone, Debug)]
pub struct DesignReport<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// Number of records.
    pub records: usize,
    /// How the records were scaled, in words.
    pub scaled: &'a str,
    /// What was asked.
    pub target: Target,
    /// What came of it.
    pub run: &'a DesignRun,
    /// Key of the acceleration, such as `storey1_peak_acceleration_m_per_s2`.
    pub acceleration: &'a str,
    /// Factors on friction with which the front (or the nearest design) was run.
    pub bounds: Option<[f64; 2]>,
    /// Confidence of intervals.
    pub confidence: f64,
    /// What reading the records gave notice of.
    pub warnings: &'a [Notice],
    /// Units to show results in.
    pub display: DisplayUnits,
}

impl DesignReport<'_> {
    /// Values of a design, one a variable, SI.
    #[must_use]
    pub fn values(&self, design: usize) -> Vec<f64> {
        let mut rest = design;
        let mut values: Vec<f64> = Vec::with_capacity(self.run.variables.len());
        for variable in self.run.variables.iter().rev() {
            let n = variable.values.len().max(1);
            values.push(variable.values.get(rest % n).copied().unwrap_or(f64::NAN));
            rest /= n;
        }
        values.reverse();
        values
    }

    /// The design of the front with the least nominal acceleration that keeps the gap with lower and
    /// upper friction too.
    #[must_use]
    pub fn robust(&self) -> Option<Point> {
        let (_, bounded) = self.bounded()?;
        let keeps = |point: &&Point| {
            bounded.iter().any(|b| {
                b.design == point.design
                    && b.lower.displacement_m <= self.target.gap_m
                    && b.upper.displacement_m <= self.target.gap_m
            })
        };
        self.run.found.front.iter().rev().find(keeps).copied()
    }

    /// Those factors with the designs.
    fn bounded(&self) -> Option<([f64; 2], &[Bounded])> {
        self.bounds.zip(self.run.bounded.as_deref())
    }

    fn length(&self) -> Unit {
        self.display.unit(Quantity::Length, self.target.gap_m)
    }

    fn acceleration_unit(&self) -> Unit {
        let all = self.run.found.front.iter().map(|p| p.figures.acceleration_m_per_s2);
        self.display.unit(Quantity::Acceleration, all.fold(0.0, f64::max))
    }

    /// The result laid out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let designs: usize = self.run.variables.iter().map(|v| v.values.len()).product();
        Sheet {
            kind: "Design over a suite",
            name: self.name.to_owned(),
            line: format!(
                "{designs} designs, {} records{}; {} runs of {} were needed{}",
                self.records,
                self.scaled,
                self.run.found.runs,
                designs * self.records,
                match self.run.failures.len() {
                    0 => String::new(),
                    failed => format!(", {failed} of them without an answer"),
                }
            ),
            display: self.display,
            verdict: self.verdict(),
            complete: !self.run.found.front.is_empty() && self.run.failures.is_empty(),
            warnings: self.all_warnings(),
            tables: self.tables(),
            notes: self.notes(),
            figures: self.figures(),
            method: self.method(),
            json: pretty(&self.json()),
            ..Sheet::default()
        }
    }

    /// The chosen design with its figures, or that there is none.
    fn verdict(&self) -> Vec<String> {
        let (l, a) = (self.length(), self.acceleration_unit());
        let design = |what: &str, point: &Point| {
            let values = self.values(point.design).into_iter().zip(&self.run.variables);
            let values = values.map(|(value, variable)| {
                let value = crate::number::rounded(value, 4);
                format!("{} {value} {}", name(variable), variable.unit).trim_end().to_owned()
            });
            format!(
                "{what}: {}. Displacement {} {} of {} {}, acceleration {} {}.",
                values.collect::<Vec<_>>().join(", "),
                cell(l.of(point.figures.displacement_m)),
                l.symbol,
                compact(l.of(self.target.gap_m)),
                l.symbol,
                cell(a.of(point.figures.acceleration_m_per_s2)),
                a.symbol
            )
        };
        let Some(chosen) = self.run.found.chosen() else {
            let none = "No design of the grid keeps the gap.".to_owned();
            let nearest = self.run.found.nearest.map(|point| design("Nearest", &point));
            return std::iter::once(none).chain(nearest).collect();
        };
        let mut verdict = vec![design("Chosen design", &chosen)];
        if let Some(robust) = self.robust() {
            verdict.push(if robust == chosen {
                "It keeps the gap with lower- and upper-bound friction too.".to_owned()
            } else {
                design("Robust to lower- and upper-bound friction", &robust)
            });
        }
        verdict
    }

    fn failed_runs(&self) -> Option<Notice> {
        let records = self.records as u64;
        let bounded = self.bounded().map_or(0, |(_, bounded)| 2 * bounded.len() as u64 * records);
        failed(&self.run.failures, self.run.found.runs + bounded, &counted_as(&self.run.failures))
    }

    fn all_warnings(&self) -> Vec<Notice> {
        let mut all: Vec<Notice> = self.failed_runs().into_iter().collect();
        let mut warn = |kind, message| all.push(Notice::new(kind, message));
        if self.run.found.front.is_empty() {
            warn(
                NoticeKind::NoFeasibleDesign,
                format!(
                    "no design of the grid keeps the gap in {} % of the records; the least \
                     displacement that any design reaches is given instead",
                    compact(100.0 * self.target.probability)
                ),
            );
        }
        if let Some(chosen) = self.run.found.chosen() {
            let values = self.values(chosen.design);
            let edges: Vec<String> = self
                .run
                .variables
                .iter()
                .zip(&values)
                .filter(|(v, x)| {
                    v.values.len() > 1
                        && (v.values.first() == Some(x) || v.values.last() == Some(x))
                })
                .map(|(v, _)| name(v))
                .collect();
            if !edges.is_empty() {
                let message = format!(
                    "the chosen design lies at an end of the range of {}: a better one may lie beyond",
                    edges.join(" and ")
                );
                warn(NoticeKind::EdgeOfRange, message);
            }
            let robust = self.robust();
            if self.bounds.is_some() && robust != Some(chosen) {
                warn(
                    NoticeKind::NotRobust,
                    match robust {
                        Some(_) => "the chosen design exceeds the gap with lower- or upper-bound friction; \
                                    the robust one keeps it"
                            .to_owned(),
                        None => "no design of the front keeps the gap with lower- and upper-bound friction"
                            .to_owned(),
                    },
                );
            }
        }
        let needed = slipstick::assessment::design::records_needed(&self.target, self.records);
        if needed == self.records && self.target.probability < 1.0 {
            warn(
                NoticeKind::FewRecords,
                format!(
                    "with {} records a share of {} asks all of them to keep the gap",
                    self.records,
                    compact(self.target.probability)
                ),
            );
        }
        all.extend(self.run.warnings.iter().chain(self.warnings).cloned());
        all
    }

    fn heads(&self) -> Vec<String> {
        let (l, a) = (self.length(), self.acceleration_unit());
        std::iter::once("Design".to_owned())
            .chain(self.run.variables.iter().map(label))
            .chain([
                l.label("D"),
                a.label("A"),
                "Gap kept".to_owned(),
                format!("{} % interval", compact(100.0 * self.confidence)),
            ])
            .collect()
    }

    fn row(&self, name: &str, design: usize, figures: &Figures) -> Vec<String> {
        let (l, a) = (self.length(), self.acceleration_unit());
        let values = self.values(design).into_iter().map(|v| crate::number::rounded(v, 4));
        let [low, high] = figures.within.wilson(self.confidence);
        let percent = |p: f64| compact(libm::round(1000.0 * p) / 10.0);
        std::iter::once(name.to_owned())
            .chain(values)
            .chain([
                cell(l.of(figures.displacement_m)),
                cell(a.of(figures.acceleration_m_per_s2)),
                format!("{} %", percent(figures.within.estimate())),
                format!("{} to {} %", percent(low), percent(high)),
            ])
            .collect()
    }

    /// The row of a design, and those with its bounds of friction where they were run.
    fn with_bounds(&self, name: &str, point: &Point) -> Vec<Vec<String>> {
        let mut rows = vec![self.row(name, point.design, &point.figures)];
        if let Some((factors, bounded)) = self.bounded()
            && let Some(b) = bounded.iter().find(|b| b.design == point.design)
        {
            let bounds = factors.into_iter().zip([&b.lower, &b.upper]);
            let row = |(factor, figures)| {
                self.row(&format!("  friction × {}", compact(factor)), b.design, figures)
            };
            rows.extend(bounds.map(row));
        }
        rows
    }

    fn tables(&self) -> Vec<(String, Vec<Vec<String>>)> {
        let mut rows = vec![self.heads()];
        let main = self.run.found.chosen().or(self.run.found.nearest);
        let row = if self.run.found.front.is_empty() { "nearest" } else { "chosen" };
        if let Some(point) = main {
            rows.extend(self.with_bounds(row, &point));
        }
        if let Some(robust) = self.robust()
            && main != Some(robust)
        {
            rows.extend(self.with_bounds("robust", &robust));
        }
        let mut tables = vec![("Choice".to_owned(), rows)];
        if self.run.found.front.len() > 1 {
            const SHOWN: usize = 12;
            let n = self.run.found.front.len();
            let mut shown: Vec<usize> = if n <= SHOWN {
                (0..n).collect()
            } else {
                (0..SHOWN).map(|i| i * (n - 1) / (SHOWN - 1)).collect()
            };
            shown.dedup();
            let mut rows = vec![self.heads()];
            for i in shown.into_iter().rev() {
                let point = &self.run.found.front[i];
                rows.push(self.row(&(n - i).to_string(), point.design, &point.figures));
            }
            let heading = if n > SHOWN {
                format!("Front: {SHOWN} of {n} designs, all in front.csv")
            } else {
                "Front".to_owned()
            };
            tables.push((heading, rows));
        }
        if let Some(Ok(sensitivity)) = self.run.sensitivity.as_ref() {
            let heads = ["", "First order", "from", "to", "Total", "from", "to"].map(str::to_owned);
            for (what, indices) in [
                ("displacement", &sensitivity.displacement),
                ("acceleration", &sensitivity.acceleration),
            ] {
                let row = |(v, i): (&Axis, &Index)| {
                    let numbers = [
                        i.first,
                        i.first_interval[0],
                        i.first_interval[1],
                        i.total,
                        i.total_interval[0],
                        i.total_interval[1],
                    ];
                    let numbers = numbers.map(|x| format!("{x:.3}"));
                    std::iter::once(name(v)).chain(numbers).collect()
                };
                let rows = std::iter::once(heads.to_vec())
                    .chain(self.run.variables.iter().zip(indices).map(row))
                    .collect();
                tables.push((format!("Sobol' indices of the {what}"), rows));
            }
        }
        tables
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let needed = slipstick::assessment::design::records_needed(&self.target, self.records);
        let percent = |share: f64| compact(100.0 * share);
        notes.push(format!(
            "D: peak sliding displacement that {} % of the records do not exceed. A: {} that {} % of \
             them do not exceed. Gap kept: share of the records, with its interval.",
            percent(self.target.probability),
            title(self.acceleration).to_lowercase(),
            percent(self.target.acceleration_share)
        ));
        notes.push(format!(
            "The gap of {} {} must be kept in at least {needed} of {} records.",
            compact(self.length().of(self.target.gap_m)),
            self.length().symbol,
            self.records
        ));
        if let Some(Err(error)) = self.run.sensitivity.as_ref() {
            notes.push(format!("No sensitivity: {error}."));
        }
        notes
    }

    fn method(&self) -> Vec<String> {
        let mut method = vec![
            "Both figures are counted: the value that the stated share of the records does not exceed. \
             The front is that of the full grid: runs were left out only where lower bounds of both \
             figures show that they cannot change it."
                .to_owned(),
            "The probability is that of the suite as it is scaled, each record counting the same; its \
             interval (Wilson's) is what so few records can tell of all that might come."
                .to_owned(),
        ];
        if self.bounds.is_some() {
            method.push(
                "Robustness: every design of the front is run again with both coefficients of friction \
                 times the lower and the upper factor. The robust design is the best of the front that \
                 keeps the gap each time; one off the nominal front might be better still."
                    .to_owned(),
            );
        }
        if self.run.sensitivity.is_some() {
            method.push(
                "Sobol' indices by Saltelli's and Jansen's estimators from scrambled Sobol' points, the \
                 variables uniform between their ends; intervals by the bootstrap."
                    .to_owned(),
            );
        }
        method
    }

    fn json(&self) -> impl Serialize {
        let figures = |f: &Figures| {
            view! {
                displacement_m: f.displacement_m,
                acceleration_m_per_s2: f.acceleration_m_per_s2,
                probability_within_gap: f.within.estimate(),
                wilson: f.within.wilson(self.confidence),
                clopper_pearson: f.within.clopper_pearson(self.confidence),
            }
        };
        let point = |p: Point| {
            let bounded =
                self.bounded().and_then(|(_, all)| all.iter().find(|b| b.design == p.design));
            view! {
                values: self.values(p.design),
                nominal: figures(&p.figures),
                lower: bounded.map(|b| figures(&b.lower)),
                upper: bounded.map(|b| figures(&b.upper)),
            }
        };
        let DesignRun { variables, found, failures, sensitivity, .. } = self.run;
        let indices = |all: &[Index]| {
            each(variables.iter().zip(all), |(v, i)| {
                view! {
                    path: v.path.clone(),
                    first: i.first,
                    first_interval: i.first_interval,
                    total: i.total,
                    total_interval: i.total_interval,
                }
            })
        };
        let sensitivity = sensitivity.as_ref().and_then(|s| s.as_ref().ok());
        view! {
            model: self.name,
            records: self.records,
            gap_m: self.target.gap_m,
            probability: self.target.probability,
            acceleration: self.acceleration,
            acceleration_share: self.target.acceleration_share,
            confidence: self.confidence,
            variables: each(variables, |Axis { path, unit, values, .. }| {
                view! { path, unit, values }
            }),
            runs: found.runs,
            failed: failures.len(),
            used_up_travel: travel_used_up(failures),
            designs_beyond_gap: found.beyond_gap,
            chosen: found.chosen().map(point),
            robust: self.robust().map(point),
            nearest: found.nearest.map(point),
            front: each(found.front.iter().copied(), point),
            sensitivity: sensitivity.map(|s| {
                view! {
                    points: s.points,
                    displacement: indices(&s.displacement),
                    acceleration: indices(&s.acceleration),
                }
            }),
        }
    }
}

/// What is varied, as people read it.
fn name(variable: &Axis) -> String {
    path_words(&variable.path)
}

/// The same with its unit: `kinetic friction`, `radius (m)`.
fn label(variable: &Axis) -> String {
    path_label(&variable.path, &variable.unit)
}
