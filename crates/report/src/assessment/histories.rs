//! Models on the records of suites, side by side, and what governs.

use slipstick::assessment::FailedRun;
use slipstick::assessment::histories::{Histories, ModelHistories, OnRecord, RECORDS_OF_A_MEAN};
use slipstick::assessment::lateral::{LEAST_TOTAL, LateralForce};
use slipstick::assessment::suite::{Recorded, condensed};
use slipstick::input::{Bound, Names};
use slipstick::notice::{Notice, NoticeKind};
use slipstick::response::{DemandColumn, DemandOf};
use slipstick::table::{Cells, Column, Table};

use super::lines::{GROUPS, RECORD, line, panel, stacked};
use super::pairs;
use super::sheet::{Sheet, cell, failed, record_table};
use crate::display::{DisplayUnits, Quantity, Unit};
use crate::figures::Drawn;
use crate::json::Json;
use crate::number::compact;
use crate::plot::{Axis, Limit, Panel, Series, Shape, Style};

/// What the histories of a suite are told from.
#[derive(Clone, Debug)]
pub struct HistoriesReport<'a> {
    /// The runs.
    pub histories: &'a Histories,
    /// How the records were scaled, in words.
    pub scaled: &'a str,
    /// Units to show results in.
    pub display: DisplayUnits,
}

/// A column of a table: its head, the model, its demand and the bound of friction; none where no record of
/// the model has the demand.
type Shown<'a> = (String, Option<(&'a ModelHistories, DemandColumn, usize)>);

/// Factors on records beyond which it is said: FEMA P-1050 and the guidance on ground motions to ASCE/SEI 7.
const FACTORS: core::ops::RangeInclusive<f64> = 0.25..=4.0;

/// Demands that have a table, of those that there are; the last one of models with storeys alone.
const SHOWN: [&str; 5] = [
    "peak_sliding_displacement_m",
    "residual_sliding_displacement_m",
    "gap_ratio",
    "block.peak_acceleration_m_per_s2",
    "base_shear_coefficient",
];

impl HistoriesReport<'_> {
    /// The result laid out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let models = &self.histories.models;
        let names: Vec<&str> = models.iter().map(|model| model.name.as_str()).collect();
        let runs: usize = models.iter().map(|model| model.records.len() * model.bounds.len()).sum();
        let most = models.iter().max_by_key(|model| model.counted());
        let records =
            most.map_or_else(String::new, |model| match (model.counted(), model.has_pairs()) {
                (1, false) => "one record".to_owned(),
                (1, true) => "one pair of components".to_owned(),
                (n, false) => format!("{n} records"),
                (n, true) => format!("{n} pairs of components"),
            });
        let broken = |run: &&Result<_, FailedRun>| matches!(run, Ok((_, false)));
        let broken = models.iter().flat_map(ModelHistories::runs).filter(broken).count();
        let certificate = match broken {
            0 => "every certificate holds".to_owned(),
            n => format!("{n} certificates do not hold"),
        };
        let unanswered = models.iter().flat_map(ModelHistories::failures).count();
        let complete = unanswered == 0 && broken == 0;
        let certificate = match unanswered {
            0 => certificate,
            n => format!("{n} without an answer; {certificate}"),
        };
        Sheet {
            kind: "Response histories",
            name: names.join(", "),
            model_hash: Some(models.iter().map(|m| &m.hash[..]).collect::<Vec<_>>().join(", ")),
            suite: self.recorded(),
            first: Some(("Governs", self.governing())),
            line: format!("{runs} runs: {records}{}; {certificate}", self.scaled),
            complete,
            display: self.display,
            warnings: self.warnings(),
            tables: self.tables(),
            notes: self.notes(),
            figures: self.figures(),
            method: self.method(),
            json: self.json(),
            ..Sheet::default()
        }
    }

    /// The demands that have a table, each as the column of every model: those of the block, and the
    /// acceleration of the roof and the drift of the first storey where there are storeys.
    fn columns(&self) -> Vec<Vec<DemandColumn>> {
        let (shape, models) = (self.histories.shape, &self.histories.models);
        let roofs = models.iter().map(|model| model.shape().roof_acceleration()).collect();
        let drift = "storey1_peak_drift_m";
        let (block, rest) = SHOWN.split_at(SHOWN.len() - 1);
        let named = |name: &&str| Some(vec![shape.find(name)?.1; models.len()]);
        let mut columns: Vec<Vec<DemandColumn>> = block.iter().filter_map(named).collect();
        if shape.storeys > 0 {
            columns.push(roofs);
            columns.extend([drift].iter().chain(rest).filter_map(named));
        }
        // What the slider strikes, and what slides on the floors.
        let met = shape.columns().into_iter().filter(|column| {
            let of =
                matches!(column.demand.of, DemandOf::Stop | DemandOf::Surface | DemandOf::Contents);
            of && column.demand.row.is_some_and(|row| row.governs)
        });
        columns.extend(met.map(|column| vec![column; models.len()]));
        let has = |columns: &Vec<DemandColumn>| {
            models.iter().zip(columns).any(|(model, column)| {
                (0..model.bounds.len()).any(|i| model.sizes(column, i).iter().any(|s| !s.is_nan()))
            })
        };
        columns.retain(has);
        columns
    }

    fn unit_of(&self, columns: &[DemandColumn]) -> Unit {
        let models = self.histories.models.iter().zip(columns);
        let sizes = models.flat_map(|(m, c)| (0..m.bounds.len()).flat_map(|i| m.sizes(c, i)));
        let largest = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
        let dimension = columns.first().and_then(DemandColumn::dimension);
        self.display.unit(Quantity::from(dimension), largest)
    }

    /// Peak sliding displacements, the first demand of all.
    fn peaks(&self) -> Vec<DemandColumn> {
        self.columns().into_iter().next().unwrap_or_default()
    }

    /// `Peak sliding displacement 182 mm (lower friction, mean of 11 records)`, a model a clause.
    fn governing(&self) -> String {
        let peaks = self.peaks();
        let unit = self.unit_of(&peaks);
        let of = |model: &ModelHistories| {
            let name = if self.histories.models.len() > 1 {
                format!("{}: ", model.name)
            } else {
                String::new()
            };
            if let Some(failed) = model.failures().next() {
                let (count, statistic) = (model.failures().count(), model.statistic());
                let of = model.runs().count();
                return Some(format!(
                    "{name}no {statistic}: {count} of {of} runs have no answer, the first {failed}"
                ));
            }
            let (bound, value) = model.governs(peaks.first()?)?;
            let friction = match model.bounds.len() {
                1 => String::new(),
                _ => format!("{} friction, ", bound.name),
            };
            let gap = model.gap_m.map_or(String::new(), |gap_m| {
                format!(", {} % of the gap", cell(100.0 * value / gap_m))
            });
            let records = match model.records.as_slice() {
                [one] => one.record.clone(),
                _ if model.has_pairs() => {
                    format!("{} of {} pairs", model.statistic(), model.counted())
                }
                all => format!("{} of {} records", model.statistic(), all.len()),
            };
            Some(format!(
                "{name}peak sliding displacement {} {} ({friction}{records}){gap}",
                cell(unit.of(value)),
                unit.symbol
            ))
        };
        self.histories.models.iter().filter_map(of).collect::<Vec<_>>().join("; ")
    }

    /// A demand: a row a record, and what governs below. Of one model a column a bound of friction, of
    /// several a column a model with the bound that governs.
    fn table(&self, demand: &[DemandColumn]) -> (String, Vec<Vec<String>>) {
        let (unit, models) = (self.unit_of(demand), &self.histories.models);
        let columns: Vec<Shown<'_>> = match models.as_slice() {
            [model] => {
                let bounds = model.bounds.iter().enumerate();
                let of = |(i, bound): (usize, &Bound)| {
                    (bound.name.to_owned(), Some((model, demand[0], i)))
                };
                bounds.map(of).collect()
            }
            _ => {
                let each = models.iter().zip(demand);
                let of = each.map(|(m, column)| {
                    // Of records without an answer none governs: all are shown as they stand.
                    let nominal = m.bounds.iter().position(|bound| *bound == Bound::NOMINAL);
                    let governs = m.governing_bound(column).or(nominal);
                    let head = match governs.filter(|_| m.bounds.len() > 1) {
                        Some(i) => format!("{} ({})", m.name, m.bounds[i].name),
                        None => m.name.clone(),
                    };
                    (head, governs.map(|i| (m, *column, i)))
                });
                of.collect()
            }
        };
        let mut names: Vec<&str> = Vec::new();
        for on in models.iter().flat_map(|model| &model.records) {
            if !names.contains(&on.record.as_str()) {
                names.push(&on.record);
            }
        }
        let shown = |value: Option<f64>| cell(unit.of(value.unwrap_or(f64::NAN)));
        let row = |name: &str, cells: &mut dyn Iterator<Item = String>| {
            core::iter::once(name.to_owned()).chain(cells).collect::<Vec<_>>()
        };
        let mut rows = vec![row("Record", &mut columns.iter().map(|(head, ..)| head.clone()))];
        for name in &names {
            let of = |(_, of): &Shown<'_>| {
                let (model, column, bound) = (*of)?;
                let on = model.records.iter().find(|on| on.record == **name)?;
                Some(on.size(&column, bound))
            };
            let value = |column: &Shown<'_>| shown(of(column));
            rows.push(row(name, &mut columns.iter().map(value)));
        }
        if names.len() > 1 {
            let mut statistics: Vec<&str> = models.iter().map(ModelHistories::statistic).collect();
            statistics.dedup();
            let name = match statistics.as_slice() {
                ["mean"] => "Mean",
                ["maximum"] => "Maximum",
                _ => "Mean or maximum",
            };
            let pairs = models.iter().any(ModelHistories::has_pairs);
            let name = if pairs { format!("{name}, larger of each pair") } else { name.to_owned() };
            let value = |(_, of): &Shown<'_>| {
                let value = shown(of.map(|(model, column, bound)| model.governing(&column, bound)));
                let governs = of.is_some_and(|(model, column, bound)| {
                    models.len() == 1
                        && model.bounds.len() > 1
                        && model.governing_bound(&column) == Some(bound)
                });
                if governs { format!("{value}*") } else { value }
            };
            rows.push(row(&name, &mut columns.iter().map(value)));
        }
        let alike = demand.iter().all(|column| *column == demand[0]);
        let title =
            if alike { self.title(&demand[0]) } else { "Roof peak acceleration".to_owned() };
        (unit.label(&title), rows)
    }

    /// A demand's title, with what the block or the storey is called in all models.
    fn title(&self, column: &DemandColumn) -> String {
        let title = column.title();
        let (what, storey) = match column.demand.of {
            DemandOf::Storey => (format!("Storey {}", column.part), column.part),
            _ => ("Block".to_owned(), 0),
        };
        let name = |names: &Names| match storey {
            0 => names.block.clone(),
            storey => names.storeys.get(storey - 1).cloned().flatten(),
        };
        let mut names = self.histories.models.iter().map(|model| name(&model.names));
        let first = names.next().flatten();
        match (first, title.strip_prefix(&what)) {
            (Some(first), Some(rest)) if names.all(|other| other.as_ref() == Some(&first)) => {
                format!("{first}{rest}")
            }
            _ => title,
        }
    }

    /// What was run, what governs beside the hand's calculation, a table a demand, and how pairs were brought
    /// to a spectrum.
    fn tables(&self) -> Vec<(String, Vec<Vec<String>>)> {
        let demands = self.columns();
        let demands = demands.iter().map(|columns| self.table(columns));
        let matched = self.histories.matched.iter();
        let of_pairs = matched.map(|(m, names)| pairs::table(names.iter().map(String::as_str), m));
        let lateral = self.histories.models.iter().filter_map(|model| self.lateral(model));
        let records = record_table(&self.recorded()).filter(|_| !self.scaled.is_empty());
        let records = records.map(|rows| ("Records".to_owned(), rows));
        records.into_iter().chain(lateral).chain(demands).chain(of_pairs).collect()
    }

    /// The records under their factors, each once.
    fn recorded(&self) -> Vec<Recorded> {
        let mut all: Vec<Recorded> = Vec::new();
        for on in self.histories.models.iter().flat_map(|model| &model.records) {
            let known = |seen: &&mut Recorded| seen.name == on.record;
            if let Some(seen) = all.iter_mut().find(known) {
                let new = on.notices.iter().filter(|notice| !seen.notices.contains(notice));
                let new: Vec<Notice> = new.cloned().collect();
                seen.notices.extend(new);
                continue;
            }
            all.push(Recorded {
                name: on.record.clone(),
                origin: on.origin.clone(),
                factor: Some(on.scale),
                pga_m_per_s2: on.pga_m_per_s2,
                notices: on.notices.clone(),
            });
        }
        all
    }

    /// The equivalent-lateral-force displacement with each bound, beside that of the runs.
    fn lateral(&self, model: &ModelHistories) -> Option<(String, Vec<Vec<String>>)> {
        let found = model.lateral.iter().flatten();
        let largest = found.clone().map(|found| found.displacement_m).reduce(f64::max)?;
        let stiffest = found.map(|found| found.stiffness_n_per_m).fold(0.0, f64::max);
        let (length, stiffness) = (
            self.display.unit(Quantity::Length, largest),
            self.display.unit(Quantity::Stiffness, stiffest),
        );
        let peak = model.shape().find(SHOWN[0])?.1;
        let runs = |bound: usize| model.governing(&peak, bound);
        type Value<'b> = Box<dyn Fn(&LateralForce, usize) -> f64 + 'b>;
        let rows: [(String, Value<'_>); 8] = [
            (
                stiffness.label("Effective stiffness k_M"),
                Box::new(|found, _| stiffness.of(found.stiffness_n_per_m)),
            ),
            (
                "Effective damping β_M (%)".to_owned(),
                Box::new(|found, _| 100.0 * found.damping_ratio),
            ),
            ("Damping factor B_M".to_owned(), Box::new(|found, _| found.damping_factor)),
            ("Effective period T_M (s)".to_owned(), Box::new(|found, _| found.period_s)),
            (
                length.label("Displacement D_M"),
                Box::new(|found, _| length.of(found.displacement_m)),
            ),
            (
                length.label("1.15 D_M, the least D_TM"),
                Box::new(|found, _| length.of(LEAST_TOTAL * found.displacement_m)),
            ),
            (
                length.label(&format!("Runs, {}", model.statistic())),
                Box::new(|_, bound| length.of(runs(bound))),
            ),
            ("  over D_M".to_owned(), Box::new(|found, bound| runs(bound) / found.displacement_m)),
        ];
        let heads = model.bounds.iter().map(|bound| bound.name.to_owned());
        let heads = core::iter::once(String::new()).chain(heads).collect();
        let row = |(name, value): &(String, Value<'_>)| {
            let of = |(bound, found): (usize, &Option<LateralForce>)| {
                cell(found.map_or(f64::NAN, |found| value(&found, bound)))
            };
            let cells = model.lateral.iter().enumerate().map(of);
            core::iter::once(name.clone()).chain(cells).collect()
        };
        let mut heading = "Equivalent lateral force beside the runs".to_owned();
        if self.histories.models.len() > 1 {
            heading.push_str(&format!(", {}", model.name));
        }
        Some((heading, core::iter::once(heads).chain(rows.iter().map(row)).collect()))
    }

    /// Factors that no longer make another earthquake of a record.
    fn far_factors(&self) -> Option<Notice> {
        let records = &self.histories.models.first()?.records;
        let far = |on: &&OnRecord| !FACTORS.contains(&on.scale.abs());
        let count = records.iter().filter(far).count();
        let distance = |on: &OnRecord| libm::log(on.scale.abs()).abs();
        let farthest =
            records.iter().filter(far).max_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let message = format!(
            "{count} of {} factors are outside {} to {}, {} × {} farthest: records so much weaker or \
             stronger have other durations and frequencies than the motion that is meant",
            records.len(),
            FACTORS.start(),
            FACTORS.end(),
            farthest.record,
            cell(farthest.scale)
        );
        Some(Notice::new(NoticeKind::FactorFar, message))
    }

    /// How it was computed.
    fn method(&self) -> Vec<String> {
        let mut method = method();
        if self.histories.models.iter().any(ModelHistories::has_pairs) {
            method.push(
                "The model moves in one direction: each component of a pair is run by itself, under the \
                 factor of the pair, and the larger of its two peaks counts as that of the pair. A measure \
                 of a component is the geometric mean of both."
                    .to_owned(),
            );
        }
        method.extend(self.histories.matched.iter().map(|(matched, _)| pairs::method(matched)));
        if self.histories.models.iter().any(|model| model.lateral.iter().any(Option::is_some)) {
            method.push(
                "The equivalent-lateral-force displacement is that of ASCE/SEI 7, section 17.5, worked out for \
                 each bound: D_M = Sa(T_M) (T_M/2π)²/B_M under the target spectrum, with the stiffness and the \
                 damping of the friction loop at D_M, all mass moving together and B_M of table 17.5-1. The \
                 ends of travel and the difference of static and kinetic friction are not in it."
                    .to_owned(),
            );
        }
        method
    }

    /// What the tables leave out.
    fn notes(&self) -> Vec<String> {
        let models = &self.histories.models;
        if models.iter().all(|model| model.bounds.len() == 1) {
            return Vec::new();
        }
        if models.len() == 1 {
            return vec!["* governs: the bound of friction with the larger value.".to_owned()];
        }
        vec![
            "Each column is of the bound of friction that governs, named in its head; runs.csv has every \
             run."
                .to_owned(),
        ]
    }

    /// What was noticed of the records and the runs, each kind once with the record that gave it first.
    fn warnings(&self) -> Vec<Notice> {
        let models = &self.histories.models;
        let runs =
            models.iter().map(|model| model.records.len() * model.bounds.len()).sum::<usize>();
        let unanswered: Vec<FailedRun> =
            models.iter().flat_map(ModelHistories::failures).cloned().collect();
        let count_as = "leave their model without a mean or maximum";
        let unanswered = failed(&unanswered, runs as u64, count_as);
        let far = self.far_factors().filter(|_| !self.scaled.is_empty());
        let records = models.iter().flat_map(|model| &model.records);
        let of_records = condensed(records.map(|on| (&on.record[..], &on.notices[..])));
        let of_suite = self.histories.notices.iter().cloned();
        let all = unanswered.into_iter().chain(far).chain(of_suite).chain(of_records);
        let mut all: Vec<Notice> = all.collect();
        Notice::sort(&mut all);
        all
    }

    /// Sliding displacement over time, a panel a model; and the share of records that stay below a peak.
    fn figures(&self) -> Vec<Drawn> {
        let models = &self.histories.models;
        let peaks = self.peaks();
        let unit = self.unit_of(&peaks);
        let label = unit.label("Sliding displacement");
        let end_s = models.iter().flat_map(|model| &model.records);
        let end_s = end_s.filter_map(|on| on.sliding[0].last()).fold(0.0, |a: f64, b| a.max(*b));
        let all = models.iter().flat_map(|model| &model.records);
        let nominal = all.map(|on| &on.sliding);
        let governing =
            models.iter().filter_map(|model| Some(&model.governing_history.as_ref()?.2));
        let all: Vec<f64> = nominal
            .chain(governing)
            .flat_map(|[_, sliding]| sliding.iter().map(|s| unit.of(*s)))
            .collect();
        // A gap far away would flatten every curve.
        let largest = all.iter().fold(0.0, |largest: f64, s| largest.max(s.abs()));
        let gaps = models
            .iter()
            .flat_map(|model| model.gap_m.into_iter().chain(model.stop_m.into_iter().flatten()));
        let gaps = gaps.map(|gap_m| unit.of(gap_m));
        let y =
            Axis::symmetric(label, all.into_iter().chain(gaps.filter(|gap| *gap < 2.0 * largest)));
        let panels = models.iter().map(|model| self.history_panel(model, &y, end_s, &unit));
        let caption = if models.iter().any(|model| model.records.len() > 1) {
            "Sliding displacement: every record with nominal friction thin; bold the largest with the bound of \
             friction that governs."
        } else {
            "Sliding displacement: thin with nominal friction, bold with the bound that governs."
        };
        let target = self.histories.matched.iter().map(|(matched, _)| pairs::figure(matched));
        let mut figures: Vec<Drawn> = target.collect();
        figures.push(stacked(
            "histories",
            "Sliding displacement",
            caption.to_owned(),
            panels.collect(),
        ));
        if models.iter().any(|model| model.records.len() > 1) {
            figures.extend(peaks.first().map(|peak| self.shares(peak, &unit)));
        }
        figures
    }

    fn history_panel(&self, model: &ModelHistories, y: &Axis, end_s: f64, unit: &Unit) -> Panel {
        let curve = |[times_s, s]: &[Vec<f64>; 2], label: String, style: Style| {
            let points = times_s.iter().zip(s).map(|(t, s)| [*t, unit.of(*s)]).collect();
            Series { label, style, shape: Shape::History, points }
        };
        let nominal = model.records.iter().map(|on| curve(&on.sliding, String::new(), RECORD));
        let governs = model.governing_history.as_ref().map(|(record, bound, history)| {
            let name = &model.records[*record].record;
            let label = match model.bounds.len() {
                1 => name.clone(),
                _ => format!("{name}, {} friction", model.bounds[*bound].name),
            };
            curve(history, label, GROUPS[0])
        });
        let limit = |value: f64, label: &str| Limit {
            value: unit.of(value),
            label: label.to_owned(),
            style: Style::LIMIT,
        };
        let of_gap =
            model.gap_m.into_iter().flat_map(|gap_m| [limit(gap_m, "gap"), limit(-gap_m, "")]);
        let [ahead, behind] = model.stop_m;
        let of_stop = ahead.map(|stop_m| limit(stop_m, "stop"));
        let of_stop = of_stop.into_iter().chain(behind.map(|stop_m| limit(-stop_m, "")));
        let near = |limit: &Limit| limit.value.abs() < y.max;
        let note = if self.histories.models.len() > 1 { model.name.clone() } else { String::new() };
        Panel {
            limits: of_gap.chain(of_stop).filter(near).collect(),
            note,
            ..panel(
                Axis::linear("Time (s)", 0.0, end_s),
                y.clone(),
                150.0,
                nominal.chain(governs).collect(),
            )
        }
    }

    /// Share of the records whose peak is at most a value, with every bound of friction.
    fn shares(&self, column: &DemandColumn, unit: &Unit) -> Drawn {
        let mut series = Vec::new();
        let mut largest = Vec::new();
        for (model, style) in self.histories.models.iter().zip(GROUPS.iter().cycle()) {
            for (i, bound) in model.bounds.iter().enumerate() {
                let mut sizes: Vec<f64> =
                    model.sizes(column, i).iter().map(|size| unit.of(*size)).collect();
                sizes.retain(|size| !size.is_nan());
                sizes.sort_by(f64::total_cmp);
                largest.extend(sizes.last().copied());
                let mut points = vec![[0.0, 0.0]];
                for (k, size) in sizes.iter().enumerate() {
                    points.push([*size, k as f64 / sizes.len() as f64]);
                    points.push([*size, (k + 1) as f64 / sizes.len() as f64]);
                }
                let nominal = bound.name == "nominal";
                let style = if nominal { *style } else { Style { width: 0.7, ..*style } };
                let label = match (nominal, self.histories.models.len()) {
                    (true, 1) => "nominal friction".to_owned(),
                    (true, _) => model.name.clone(),
                    _ => String::new(),
                };
                series.push(line(label, style, points));
            }
        }
        let bounds = if self.histories.models.iter().any(|model| model.bounds.len() > 1) {
            " Thin: lower- and upper-bound friction."
        } else {
            ""
        };
        let x = Axis::from_zero(unit.label(&column.title()), largest);
        let y = Axis::linear("Share of the records", 0.0, 1.0);
        let caption = format!(
            "Share of the records whose peak sliding displacement is at most a value.{bounds}"
        );
        stacked("shares", "Peaks over the suite", caption, vec![panel(x, y, 190.0, series)])
    }

    fn json(&self) -> Vec<(&'static str, Json)> {
        let names = self.histories.models.iter().map(|model| model.name.as_str().into());
        let of_bounds = self.histories.models.iter().flat_map(|model| {
            let each = model.bounds.iter().zip(&model.lateral);
            each.filter_map(|(bound, found)| Some((&model.name, bound, found.as_ref()?)))
        });
        let lateral = of_bounds.map(|(model, bound, found)| {
            Json::Object(vec![
                ("model", model.as_str().into()),
                ("friction", bound.name.into()),
                ("displacement_m", found.displacement_m.into()),
                ("stiffness_n_per_m", found.stiffness_n_per_m.into()),
                ("damping_ratio", found.damping_ratio.into()),
                ("damping_factor", found.damping_factor.into()),
                ("period_s", found.period_s.into()),
            ])
        });
        vec![
            ("models", Json::List(names.collect())),
            ("scaled", self.scaled.trim().into()),
            ("runs", columns(&self.histories.runs)),
            ("governing", columns(&self.histories.governing)),
            ("lateral_force", Json::List(lateral.collect())),
        ]
    }
}

fn method() -> Vec<String> {
    vec![
        "Every run is an exact analysis of its own, judged by an independent check of its whole history."
            .to_owned(),
        format!(
            "Of {} records or more the mean of the peaks governs, of fewer the maximum, each with the \
             bound of friction that gives the larger value, as chapter 17 of ASCE/SEI 7 has it for \
             isolated structures. Residual displacements are taken without their sign.",
            compact(RECORDS_OF_A_MEAN as f64)
        ),
    ]
}

/// A table as its columns: name, unit, values.
fn columns(table: &Table) -> Json {
    let values = |cells: &Cells| -> Vec<Json> {
        match cells {
            Cells::Texts(texts) => texts.iter().map(|text| text.as_str().into()).collect(),
            Cells::Flags(flags) => {
                flags.iter().map(|flag| flag.map_or(Json::Null, Json::Bool)).collect()
            }
            Cells::Counts(counts) => {
                counts.iter().map(|count| Json::from(count.map(|n| n as f64))).collect()
            }
            Cells::Numbers(numbers) => numbers.iter().map(|number| Json::from(*number)).collect(),
        }
    };
    let column = |column: &Column| {
        Json::Object(vec![
            ("name", column.name.as_str().into()),
            ("unit", column.unit.as_str().into()),
            ("values", Json::List(values(&column.cells))),
        ])
    };
    Json::List(table.columns.iter().map(column).collect())
}
