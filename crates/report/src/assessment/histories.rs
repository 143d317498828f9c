//! Models on the records of suites, side by side, and what governs.

mod code;
mod figures;
mod floors;
mod forces;
mod judged;
mod profiles;

use serde::Serialize;
use slipstick::assessment::FailedRun;
use slipstick::assessment::code::{Judgement, Plan, PropertyFactors};
use slipstick::assessment::histories::left_out::LeftOut;
use slipstick::assessment::histories::{Histories, ModelHistories, OnRecord, RECORDS_OF_A_MEAN};
use slipstick::assessment::suite::{Recorded, condensed};
use slipstick::input::Bound;
use slipstick::notice::{Notice, NoticeKind, Severity};
use slipstick::requests::AtHazard;
use slipstick::response::{DemandColumn, DemandOf};
use slipstick::study::USUAL_FACTORS;
use slipstick::table::{self, Column};

use self::code::{LATERAL, LateralFigure};
use super::pairs;
use super::sheet::{Sheet, SheetTable, cell, failed, record_table};
use crate::display::{DisplayUnits, Quantity, Unit};
use crate::json::{Members, cell_values, each, pretty};
use crate::number::compact;
use crate::view;

/// What the histories of a suite are told from.
#[derive(Clone, Debug)]
pub struct HistoriesReport<'a> {
    /// The runs.
    pub histories: &'a Histories,
    /// How the records were scaled, in words.
    pub scaled: &'a str,
    /// What the intensity is called: `MCE_R`, `DE`.
    pub hazard: Option<&'a str>,
    /// Property modification factors that the bounds of friction come from.
    pub factors: Option<PropertyFactors>,
    /// Plan of the building, for the total displacement.
    pub plan: Option<Plan>,
    /// What a code makes of each model; none without a code.
    pub judgements: &'a [Judgement],
    /// The same at further intensities.
    pub others: &'a [AtHazard],
    /// Whether it is itself of a further intensity, beside the first.
    pub is_further: bool,
    /// Units to show results in.
    pub display: DisplayUnits,
}

/// A column of a table: its head, the model, its demand and the bound of friction; none where no record of
/// the model has the demand.
type Shown<'a> = (String, Option<(&'a ModelHistories, DemandColumn, usize)>);

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
        let of_models = |models: &[ModelHistories]| -> usize {
            models.iter().map(|model| model.records.len() * model.bounds.len()).sum()
        };
        let runs = of_models(models)
            + self.others.iter().map(|at| of_models(&at.histories.models)).sum::<usize>();
        let every = || self.others.iter().map(|at| &at.histories.models).chain([models]).flatten();
        let most = models.iter().max_by_key(|model| model.counted());
        let records =
            most.map_or_else(String::new, |model| match (model.counted(), model.of_pairs()) {
                (1, false) => "one record".to_owned(),
                (1, true) => "one pair of components".to_owned(),
                (n, false) => format!("{n} records"),
                (n, true) => format!("{n} pairs of components"),
            });
        let directions = match models.iter().any(ModelHistories::is_in_plane) {
            true => " in two directions",
            false => "",
        };
        let broken = every().flat_map(ModelHistories::unconfirmed).count();
        let certificate = match broken {
            0 if !models.iter().all(|model| model.certifying) => "no run certified".to_owned(),
            0 => "every certificate holds".to_owned(),
            n => format!("{n} certificates do not hold"),
        };
        let unanswered = every().flat_map(ModelHistories::failures).count();
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
            first: Some(("Governs", self.at_each(|at| at.governing()).join(". "))),
            verdicts: self.at_each(|at| at.verdicts()).concat(),
            line: format!(
                "{runs} runs: {records}{directions}{}{}; {certificate}",
                self.scaled,
                self.at()
            ),
            complete,
            failed: broken > 0,
            display: self.display,
            warnings: self.warnings(),
            first_tables: self.first_tables(),
            tables: self.tables(),
            notes: self.notes(),
            not_modelled: forces::not_modelled(self.torsion(0).is_some()),
            figures: self.figures(),
            formulas: self.formulas(),
            method: self.method(),
            json: pretty(&self.json()),
            ..Sheet::default()
        }
    }

    /// The same at a further intensity, alone.
    fn at_hazard<'a>(&'a self, at: &'a AtHazard) -> HistoriesReport<'a> {
        HistoriesReport {
            histories: &at.histories,
            hazard: Some(&at.name),
            judgements: &at.judgements,
            others: &[],
            is_further: true,
            ..self.clone()
        }
    }

    /// What is told at each intensity, the first first.
    fn at_each<T>(&self, of: impl Fn(&HistoriesReport<'_>) -> T) -> Vec<T> {
        let others = self.others.iter().map(|at| of(&self.at_hazard(at)));
        core::iter::once(of(self)).chain(others).collect()
    }

    /// What governs at each intensity, side by side: a row a demand, with the bound that governs.
    fn side_by_side(&self) -> Vec<SheetTable> {
        if self.others.is_empty() {
            return Vec::new();
        }
        let of_model = |(place, model): (usize, &ModelHistories)| {
            let names = self.hazard.into_iter().chain(self.others.iter().map(|at| &at.name[..]));
            let heads = core::iter::once(String::new()).chain(names.map(str::to_owned)).collect();
            let mut rows: Vec<Vec<String>> = vec![heads];
            for columns in self.columns() {
                let column = columns[place];
                let unit = self.unit_of(&columns);
                let shown = |report: &HistoriesReport<'_>, factor: f64| {
                    let of = &report.histories.models[place];
                    let friction = |bound: &Bound| match of.bounds.len() {
                        1 => String::new(),
                        _ => format!(" ({})", bound.name),
                    };
                    of.governs(&column).map_or("—".to_owned(), |(bound, value)| {
                        format!("{}{}", cell(unit.of(factor * value)), friction(bound))
                    })
                };
                let title = unit.label(&model.names.title(&column));
                let row = |name: String, factor: f64| {
                    let cells = self.at_each(|report| shown(report, factor));
                    core::iter::once(name).chain(cells).collect::<Vec<String>>()
                };
                rows.push(row(title, 1.0));
                if column.name() == SHOWN[0] {
                    let torsion = self.torsion(place);
                    rows.extend(torsion.map(|torsion| {
                        row(format!("  with torsion × {}", cell(torsion)), torsion)
                    }));
                    rows.extend(model.gap_m.map(|gap_m| {
                        let share = 100.0 * unit.in_si * torsion.unwrap_or(1.0) / gap_m;
                        row("  of the gap (%)".to_owned(), share)
                    }));
                }
            }
            let heading = format!("{} at each intensity", capital(model.statistic()));
            (self.of_model(&heading, model), rows)
        };
        self.histories.models.iter().enumerate().map(of_model).collect()
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
        } else if shape.points > 0 {
            columns.push(roofs);
            columns.extend(["point1_peak_drift_m"].iter().chain(rest).filter_map(named));
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
        let of = |(place, model): (usize, &ModelHistories)| {
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
            let unconfirmed = self.unconfirmed(model);
            let Some((bound, value)) = model.governs(peaks.first()?) else {
                return unconfirmed.map(|unconfirmed| format!("{name}{unconfirmed}"));
            };
            let name = name + &unconfirmed.map_or_else(String::new, |said| said + "; without it ");
            let friction = match model.bounds.len() {
                1 => String::new(),
                _ => format!("{} friction, ", bound.name),
            };
            let total = self.torsion(place).map_or(value, |torsion| torsion * value);
            let torsion = self.torsion(place).map_or(String::new(), |torsion| {
                let (total, factor) = (cell(unit.of(total)), cell(torsion));
                format!(", with torsion (× {factor}) {total} {}", unit.symbol)
            });
            let gap = model.gap_m.map_or(String::new(), |gap_m| {
                format!("{torsion}, {} % of the gap", cell(100.0 * total / gap_m))
            });
            let gap = if gap.is_empty() { torsion } else { gap };
            let records = match model.records.as_slice() {
                [one] => one.record.clone(),
                _ if model.has_pairs() && model.counted() == 1 => {
                    "larger of both components".to_owned()
                }
                _ if model.of_pairs() => {
                    format!("{} of {} pairs", model.statistic(), model.counted())
                }
                _ => format!("{} of {} records", model.statistic(), model.counted()),
            };
            let beyond = self.beyond_gap(place, bound, &unit);
            Some(format!(
                "{name}peak sliding displacement {} {} ({friction}{records}){gap}{beyond}",
                cell(unit.of(value)),
                unit.symbol
            ))
        };
        let all: Vec<String> = self.histories.models.iter().enumerate().filter_map(of).collect();
        let hazard = self.hazard.map_or(String::new(), |hazard| format!("{hazard}: "));
        hazard + &all.join("; ")
    }

    /// `, and 17 of 42 records exceed the gap, A_TMZ000 farthest with 412 mm`: over a suite, with the bound that governs.
    fn beyond_gap(&self, place: usize, bound: &Bound, unit: &Unit) -> String {
        let model = &self.histories.models[place];
        let torsion = self.torsion(place).unwrap_or(1.0);
        let bound = model.bounds.iter().position(|other| other == bound);
        let (Some(peak), Some(bound), Some(gap_m)) =
            (self.peaks().get(place).copied(), bound, model.gap_m)
        else {
            return String::new();
        };
        let Some((count, farthest, most)) = model
            .beyond(gap_m / torsion, |on| on.size(&peak, bound))
            .filter(|_| model.counted() > 1)
        else {
            return String::new();
        };
        let of = if model.of_pairs() { "pairs" } else { "records" };
        let all = model.counted();
        let exceed = match count {
            0 => format!("none of {all} {of} exceeds"),
            1 => format!("1 of {all} {of} exceeds"),
            count => format!("{count} of {all} {of} exceed"),
        };
        let far = if count == 0 { "nearest" } else { "farthest" };
        let (record, most) = (&farthest.record, cell(unit.of(torsion * most)));
        format!(", and {exceed} the gap, {record} {far} with {most} {}", unit.symbol)
    }

    /// That the check does not confirm runs: how many, the first of them, and the demand.
    fn unconfirmed(&self, model: &ModelHistories) -> Option<String> {
        let (on, bound, defect) = model.unconfirmed().next()?;
        let friction = match model.bounds.len() {
            1 => String::new(),
            _ => format!(" with {} friction", bound.name),
        };
        Some(format!(
            "CHECK FAILED for {} of {} runs, the first {}{friction}: {defect}",
            model.unconfirmed().count(),
            model.runs().count(),
            on.record
        ))
    }

    /// ` at MCE_R`.
    fn at(&self) -> String {
        self.hazard.map_or(String::new(), |hazard| format!(" at {hazard}"))
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
        let mut names: Vec<(&str, usize)> = Vec::new();
        for name in models.iter().flat_map(|model| numbered(&model.records)).map(|(name, _)| name) {
            if !names.contains(&name) {
                names.push(name);
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
                let on = numbered(&model.records).find(|(other, _)| other == name)?.1;
                Some(on.size(&column, bound))
            };
            let values: Vec<Option<f64>> = columns.iter().map(of).collect();
            // Of one model the bound with which this record governs.
            let sizes = || values.iter().flatten();
            let most = sizes().copied().reduce(f64::max).filter(|most| {
                models.len() == 1 && sizes().all(|s| s.is_finite()) && sizes().any(|s| s < most)
            });
            let value = |value: &Option<f64>| match most {
                Some(most) if *value == Some(most) => format!("{}*", shown(*value)),
                _ => shown(*value),
            };
            rows.push(row(name.0, &mut values.iter().map(value)));
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
        let mut titles = self.histories.models.iter().map(|model| model.names.title(column));
        let first = titles.next().filter(|first| titles.all(|other| other == *first));
        first.unwrap_or_else(|| column.title())
    }

    /// What is read first: what governs at each intensity, what a code requires.
    fn first_tables(&self) -> Vec<SheetTable> {
        let judged = self.at_each(|at| at.judged_tables()).concat();
        self.side_by_side().into_iter().chain(judged).collect()
    }

    /// What was run, what governs beside the hand's calculation, a table a demand, and how pairs were brought
    /// to a spectrum.
    fn tables(&self) -> Vec<(String, Vec<Vec<String>>)> {
        let demands = self.columns();
        let demands = demands.iter().map(|columns| self.table(columns));
        let matched = self.histories.matched.iter();
        let of_pairs = matched.map(|(m, names)| pairs::table(names.iter().map(String::as_str), m));
        let lateral = self.histories.models.iter().filter_map(|model| self.lateral(model));
        let alone = self.histories.models.iter().filter_map(|model| self.alone(model));
        let over_height = self.profile_tables().into_iter().chain(self.floor_tables());
        let records = record_table(&self.recorded()).filter(|_| !self.scaled.is_empty());
        let records = records.map(|rows| ("Records".to_owned(), rows));
        let capacity = self.histories.models.iter().filter_map(|model| self.capacity(model));
        let factors = self.factors.iter().map(code::factor_table);
        let forces = self.histories.models.iter().map(|model| self.force_table(model));
        let of_others = self.others.iter().flat_map(|at| {
            let report = self.at_hazard(at);
            let capacity = at.histories.models.iter().filter_map(|model| {
                report
                    .capacity(model)
                    .map(|(heading, rows)| (format!("{heading}{}", report.at()), rows))
            });
            let forces = at.histories.models.iter().map(|model| report.force_table(model));
            capacity.chain(forces).collect::<Vec<_>>()
        });
        let governs = capacity.chain(forces).chain(of_others).chain(factors);
        let hidden = lateral.chain(alone);
        // What answers stands first.
        let all = governs.chain(records).chain(hidden).chain(demands);
        all.chain(over_height).chain(of_pairs).collect()
    }

    /// The records under their factors, each once.
    fn recorded(&self) -> Vec<Recorded> {
        let mut all: Vec<Recorded> = Vec::new();
        let mut names: Vec<(&str, usize)> = Vec::new();
        let of_models = self.histories.models.iter();
        for (name, on) in of_models.flat_map(|model| numbered(&model.records)) {
            if let Some(place) = names.iter().position(|known| *known == name) {
                let seen = &mut all[place];
                let new = on.notices.iter().filter(|notice| !seen.notices.contains(notice));
                let new: Vec<Notice> = new.cloned().collect();
                seen.notices.extend(new);
                continue;
            }
            names.push(name);
            all.push(Recorded {
                name: on.record.clone(),
                origin: on.origin.clone(),
                motion_hash: Some(on.motion_hash.clone()),
                factor: Some(on.scale),
                pga_m_per_s2: on.pga_m_per_s2,
                notices: on.notices.clone(),
            });
        }
        all
    }

    /// Factors that no longer make another earthquake of a record.
    fn far_factors(&self) -> Option<Notice> {
        let records = &self.histories.models.first()?.records;
        let far = |on: &&OnRecord| !USUAL_FACTORS.contains(&on.scale.abs());
        let count = records.iter().filter(far).count();
        let distance = |on: &OnRecord| libm::log(on.scale.abs()).abs();
        let farthest =
            records.iter().filter(far).max_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let message = format!(
            "{count} of {} factors are outside {} to {}, {} × {} farthest: records so much weaker or \
             stronger have other durations and frequencies than the motion that is meant",
            records.len(),
            USUAL_FACTORS.start(),
            USUAL_FACTORS.end(),
            farthest.record,
            cell(farthest.scale)
        );
        Some(Notice::new(NoticeKind::FactorFar, message))
    }

    /// How it was computed.
    fn method(&self) -> Vec<String> {
        let mut method = method();
        if self.histories.models.iter().any(ModelHistories::is_in_plane) {
            method.push(
                "Both components of a pair act at once, the first along x and the second along y, under one \
                 factor; the coefficient of friction is the same in all directions. Peaks are of vector sums \
                 at each instant, the PGA as well. Beside them stand the peaks of each component by itself \
                 and their combination by 100 % + 30 %, the longer of the vectors (x, 0.3 y) and (0.3 x, y). \
                 A measure of a component is the geometric mean of both."
                    .to_owned(),
            );
        }
        if self.histories.models.iter().any(ModelHistories::has_pairs) {
            method.push(
                "Pairs separate: each component of a pair is run by itself, under the \
                 factor of the pair, and the larger of its two peaks counts as that of the pair. A measure \
                 of a component is the geometric mean of both."
                    .to_owned(),
            );
        }
        for model in &self.histories.models {
            method.extend(model.left_out.as_ref().map(|left_out| apart(&model.name, left_out)));
        }
        method.extend(self.of_codes());
        if self.factors.is_some() {
            method.push(
                "The bounds of friction are products of property modification factors, of the least and of \
                 the largest: λ = (1 + 0.75 (λ_ae − 1)) λ_test λ_spec, ASCE/SEI 7, section 17.2.8.4."
                    .to_owned(),
            );
        }
        if self.histories.floor_spectra.is_some() {
            method.push(
                "Floor spectra are those of the acceleration of the place at the samples and both sides of every event, \
                 straight in between. Means are arithmetic, ordinate by ordinate over the records; fractiles are \
                 interpolated between them."
                    .to_owned(),
            );
        }
        method.extend(self.histories.matched.iter().map(|(matched, _)| pairs::method(matched)));
        if self.histories.models.iter().any(|model| model.lateral.iter().any(Option::is_some)) {
            method.push(
                "The equivalent-lateral-force displacement is that of ASCE/SEI 7, section 17.5, worked out for \
                 each bound: D_M = Sa(T_M) (T_M/2π)²/B_M under the target spectrum, with the stiffness and the \
                 damping of the friction loop at D_M, all mass moving together and B_M of table 17.5-1. A \
                 surface in series whose travel is used up slides no further; stops and the difference of static \
                 and kinetic friction are not in it."
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
        let governs = match models.len() {
            1 => {
                "* governs: the bound of friction with the larger value, of each record and of all."
            }
            _ => {
                "Each column is of the bound of friction that governs, named in its head; runs.csv has \
                 every run."
            }
        };
        vec![governs.to_owned()]
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
        let passed = models.iter().flat_map(|model| self.passed(model));
        let records: Vec<&OnRecord> = models.iter().flat_map(|model| &model.records).collect();
        let of_records = self.of_records(&records);
        let of_suite = self.histories.notices.iter().cloned();
        let milder = self.factors.and_then(code::milder_than_code);
        let unconfirmed = models.iter().filter_map(|model| {
            let left = model.of_earthquakes() - model.counted();
            let what = if model.of_pairs() { "pairs" } else { "records" };
            let message = format!(
                "{}; {left} of {} {what} are left out of the {}",
                self.unconfirmed(model)?,
                model.of_earthquakes(),
                model.statistic()
            );
            Some(Notice::new(NoticeKind::CheckFailed, message))
        });
        let all = unanswered
            .into_iter()
            .chain(unconfirmed)
            .chain(passed)
            .chain(milder)
            .chain(far)
            .chain(of_suite)
            .chain(of_records);
        let mut all: Vec<Notice> = all.collect();
        for at in self.others {
            let told = self.at_hazard(at).warnings().into_iter();
            let severe = told.filter(|notice| notice.severity() == Severity::Severe);
            all.extend(severe.map(|notice| Notice {
                message: format!("at {}: {}", at.name, notice.message),
                ..notice
            }));
        }
        Notice::sort(&mut all);
        all
    }

    /// What several records give notice of, each kind once: of what the slider comes to the end of, the record that
    /// slides farthest is cited, else the first.
    fn of_records(&self, records: &[&OnRecord]) -> Vec<Notice> {
        let peak = self.histories.shape.find(SHOWN[0]).map(|(_, column)| column);
        let reached_m = |on: &OnRecord| {
            let sizes = (0..on.runs.len()).filter_map(|bound| Some(on.size(peak.as_ref()?, bound)));
            sizes.fold(0.0, f64::max)
        };
        let mut farthest = records.to_vec();
        farthest.sort_by(|a, b| reached_m(b).total_cmp(&reached_m(a)));
        let told = |records: &[&OnRecord], of_reach: bool| {
            let own = |on: &OnRecord| -> Vec<Notice> {
                let wanted = |notice: &&Notice| is_of_reach(notice.kind) == of_reach;
                on.notices.iter().filter(wanted).cloned().collect()
            };
            let all: Vec<(&str, Vec<Notice>)> =
                records.iter().map(|on| (&on.record[..], own(on))).collect();
            condensed("records", all.iter().map(|(name, notices)| (*name, &notices[..])))
        };
        told(&farthest, true).into_iter().chain(told(records, false)).collect()
    }

    fn json(&self) -> impl Serialize {
        let models = &self.histories.models;
        let of_bounds = models.iter().flat_map(|model| {
            let each = model.bounds.iter().zip(&model.lateral);
            each.filter_map(|(bound, found)| Some((&model.name, bound, found.as_ref()?)))
        });
        let total = self.total_over_displacement();
        view! {
            models: each(models, |model| &model.name),
            scaled: self.scaled.trim(),
            hazard: self.hazard,
            runs: columns(&self.histories.runs),
            governing: columns(&self.histories.governing),
            lateral_force: each(of_bounds, |(model, bound, found)| {
                let figure = |of: &LateralFigure| (of.key, (of.value)(found, total));
                view! {
                    model,
                    friction: bound.name,
                    #[serde(flatten)] figures: Members(each(&LATERAL, figure)),
                    passes: found.passes.map(|(what, _)| what),
                    passes_m: found.passes.map(|(_, reach_m)| reach_m),
                }
            }),
            #[serde(flatten)] further: (!self.others.is_empty()).then(|| {
                view! { hazards: each(self.others, |at| view! {
                    name: &at.name[..],
                    factor: at.factor,
                    runs: columns(&at.histories.runs),
                    governing: columns(&at.histories.governing),
                    code: each(at.histories.models.iter().zip(&at.judgements), |(model, of)| {
                        judged::json(&model.name, of)
                    }),
                }) }
            }),
            #[serde(flatten)] requirements: (!self.judgements.is_empty()).then(|| {
                let of_models = models.iter().zip(self.judgements);
                view! { code: each(of_models, |(model, of)| judged::json(&model.name, of)) }
            }),
            #[serde(flatten)] profiles: self.profile_json().map(|profiles| view! { profiles }),
            #[serde(flatten)] floor_spectrum:
                self.floor_json().map(|floor_spectrum| view! { floor_spectrum }),
        }
    }
}

/// Whether a notice is of how far the block slides.
fn is_of_reach(kind: NoticeKind) -> bool {
    use NoticeKind::{FlatGeometry, GapExceeded, StopStruck, TravelReached};
    matches!(kind, FlatGeometry | GapExceeded | StopStruck | TravelReached)
}

/// The same with a capital first.
fn capital(words: &str) -> String {
    let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
    format!("{}{rest}", first.to_uppercase())
}

/// The records of a model, each with its name and how many before it share that: two records of one name are two.
fn numbered(records: &[OnRecord]) -> impl Iterator<Item = ((&str, usize), &OnRecord)> {
    records.iter().enumerate().map(|(i, on)| {
        let before = records[..i].iter().filter(|other| other.record == on.record).count();
        ((&on.record[..], before), on)
    })
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
fn columns(table: &table::Table) -> impl Serialize {
    each(&table.columns, |Column { name, unit, cells }| {
        view! { name, unit, values: cell_values(cells) }
    })
}

/// What components that are run by themselves leave out, by how much for a block on one pendulum.
fn apart(name: &str, left_out: &LeftOut) -> String {
    let [median, least, most] = left_out.spread().map(|ratio| format!("{ratio:.2}"));
    let slider = left_out.simple.slider();
    let [friction, _] = left_out.simple.kinetic_friction();
    let on = match slider.radius_m() {
        Some(radius_m) => format!("a pendulum of R = {} m", compact(radius_m)),
        None if slider.stiffness_n_per_m(0.0) > 0.0 => "a spring".to_owned(),
        None => "a flat surface".to_owned(),
    };
    let pairs = match left_out.ratios.len() {
        1 => "in the one pair that says so".to_owned(),
        count => format!("the median of {count} pairs, {least} to {most}"),
    };
    format!(
        "{name} cannot be run in two directions, and each axis by itself leaves out that sliding along one weakens what \
         friction holds along the other. A rigid block on {on} and a friction of {}, which has the stiffness and the \
         friction of the slider, goes {median} times as far under both components at once as under the worse of \
         them by itself: {pairs}. The displacements of these tables are short by something of that order.",
        compact(friction)
    )
}
