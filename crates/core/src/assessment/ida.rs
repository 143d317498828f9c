//! Incremental dynamic analysis: demands over rising intensity, record by record.
//!
//! Terms and the hunt-and-fill search follow D. Vamvatsikos and C. A. Cornell (*Earthquake Engineering
//! and Structural Dynamics* 31, 2002; *Earthquake Spectra* 20, 2004). Demands need not grow with
//! intensity: a curve may cross the limit, come back below it (they call it resurrection) and cross
//! again. The capacity of a record is its **first** crossing; what comes back is told, not used.

use super::fragility::{Capacity, Fragility};
use super::models::Models;
use super::observed::{Averaged, DesignGroup, FRICTION, design_groups};
use super::suite::Suite;
use super::{AssessmentError, FailedRun, refuse};
use crate::error::{FitError, RunError, Stopped};
use crate::input::{Bound, Parts};
use crate::motion::GroundMotion;
use crate::motion::intensity::LevelMeasure;
use crate::notice::Notice;
use crate::numerics::fractile;
use crate::numerics::sort;
use crate::response::{Response, demand_values};
use crate::study::cases::{Case, CaseRun, OneThread, add_answers, status};
use crate::study::certified::{Certified, same_bits};
use crate::study::engine::Engine;
use crate::study::{Demanded, Record};
use crate::table::{Cells, Column, Table};

/// Runs that a hunt on one record is thought to take, for those who wait.
const RUNS_OF_A_HUNT: u64 = 30;

/// Demands of one record at rising intensities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Intensities, rising, > 0.
    pub levels: Vec<f64>,
    /// What is known of the demand at each.
    pub demands: Vec<Demanded>,
}

/// Where a record's curve crosses a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The level: reached there, or not reached up to there.
    pub level: f64,
    /// Whether the limit is reached.
    pub reached: bool,
    /// Highest level not reaching the limit, and lowest reaching it, between which the crossing lies.
    pub between: [f64; 2],
    /// Whether the limit is not reached because runs beyond the level have no answer.
    pub cut_short: bool,
    /// A level beyond the crossing at which the demand is below the limit again.
    pub returns: Option<f64>,
}

impl Crossing {
    /// Whether anything is known of it: of a curve none of whose runs has an answer nothing is.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.level > 0.0
    }

    /// The capacity that it is.
    #[must_use]
    pub fn capacity(&self) -> Capacity {
        Capacity { level: self.level, reached: self.reached }
    }
}

impl Curve {
    /// Adds a point in its place; a level that is there already is replaced.
    pub fn insert(&mut self, level: f64, demand: impl Into<Demanded>) {
        let demand = demand.into();
        let at = self.levels.partition_point(|known| *known < level);
        if self.levels.get(at) == Some(&level) {
            self.demands[at] = demand;
        } else {
            self.levels.insert(at, level);
            self.demands.insert(at, demand);
        }
    }

    /// The first crossing of a limit > 0 on the curve's points joined by straight lines from the
    /// origin; where a run is only known to have reached the limit, the crossing is put at its level. Runs of
    /// which nothing is known are no points: a curve that ends in such runs is known up to them.
    #[must_use]
    pub fn first_crossing(&self, limit: f64) -> Crossing {
        let known: Vec<(f64, bool, f64)> = self
            .levels
            .iter()
            .zip(&self.demands)
            .filter_map(|(level, demand)| Some((*level, demand.reaches(limit)?, demand.value())))
            .collect();
        let Some(at) = known.iter().position(|(_, reaches, _)| *reaches) else {
            let level = known.last().map_or(0.0, |(level, ..)| *level);
            let cut_short = self.levels.last().is_some_and(|last| *last > level);
            let between = [level, f64::INFINITY];
            return Crossing { level, reached: false, between, cut_short, returns: None };
        };
        let (low, below) = at.checked_sub(1).map_or((0.0, 0.0), |i| (known[i].0, known[i].2));
        let (high, _, above) = known[at];
        let level = if above > below {
            low + (high - low) * ((limit - below) / (above - below)).clamp(0.0, 1.0)
        } else {
            high
        };
        let returns = known[at..].iter().find(|(_, reaches, _)| !reaches).map(|(at, ..)| *at);
        Crossing { level, reached: true, between: [low, high], cut_short: false, returns }
    }
}

/// How the level is sought at which a demand reaches its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hunt {
    /// The limit on the demand, > 0.
    pub limit: f64,
    /// First level tried, > 0.
    pub start: f64,
    /// Highest level tried; a record that does not reach the limit there is known only from below.
    pub top: f64,
    /// Largest ratio, less one, of neighbouring levels below the crossing: how close together two
    /// crossings may lie and still be told apart. The default is 0.05.
    pub resolution: f64,
    /// Largest distance of the two levels around the crossing over its level; the default is 0.01.
    pub tolerance: f64,
}

/// Levels this far below the first that reaches the limit are not searched for an earlier crossing.
pub const SEARCHED_SPAN: f64 = 10.0;
const GROWTH: f64 = 2.0;
const MOST_RUNS: usize = 2_000;

impl Hunt {
    /// The usual search for a limit between two levels.
    ///
    /// # Errors
    /// [`FitError::OutOfRange`] unless all are finite, > 0, and `start ≤ top`.
    pub fn new(limit: f64, start: f64, top: f64) -> Result<Self, FitError> {
        for (quantity, found) in [("limit", limit), ("first level", start), ("highest level", top)]
        {
            if !(found.is_finite() && found > 0.0) {
                let expected = "a finite value > 0";
                return Err(FitError::OutOfRange { quantity, expected, found });
            }
        }
        if start > top {
            let expected = "at most the highest level";
            return Err(FitError::OutOfRange { quantity: "first level", expected, found: start });
        }
        Ok(Self { limit, start, top, resolution: 0.05, tolerance: 0.01 })
    }

    /// Runs one record: `demand` gives its demand at a level, infinite where it is beyond the limit without
    /// being known, NaN where the run has no answer. The search goes no higher beyond either.
    ///
    /// *Hunt*: the level is doubled from `start` until the demand reaches the limit or `top` is
    /// passed (halved first, where `start` already reaches it). *Fill*: every gap from a tenth of the
    /// first level found up to the highest tried is divided until neighbouring levels differ by
    /// `resolution`; what crosses earlier is found there. *Close*: the gap around the first crossing
    /// is halved to `tolerance`. Two crossings within one gap of the fill cancel unseen.
    pub fn run(&self, mut demand: impl FnMut(f64) -> f64) -> Curve {
        match self.try_run(|level| Ok::<_, core::convert::Infallible>(demand(level))) {
            Ok(curve) => curve,
            Err(never) => match never {},
        }
    }

    /// As [`Hunt::run`], for runs that may be stopped.
    ///
    /// # Errors
    /// The first of `demand`.
    pub fn try_run<E>(&self, mut demand: impl FnMut(f64) -> Result<f64, E>) -> Result<Curve, E> {
        let mut curve = Curve::default();
        let mut try_at = |curve: &mut Curve, level: f64| -> Result<bool, E> {
            let found = demand(level)?;
            curve.insert(level, found);
            Ok(!(found < self.limit))
        };
        let mut level = self.start;
        let mut reached = try_at(&mut curve, level)?;
        if reached {
            let mut below = level / GROWTH;
            while below > self.start * 1e-6 && try_at(&mut curve, below)? {
                below /= GROWTH;
            }
        }
        while !reached && level < self.top {
            level = (level * GROWTH).min(self.top);
            reached = try_at(&mut curve, level)?;
        }
        let first = curve.first_crossing(self.limit);
        let from = if first.reached { first.between[1] } else { self.start } / SEARCHED_SPAN;
        let widest = 1.0 + self.resolution;
        // From the lowest gap up; each division halves its ratio.
        let mut i = 0;
        while i + 1 < curve.levels.len() && curve.levels.len() < MOST_RUNS {
            let (low, high) = (curve.levels[i], curve.levels[i + 1]);
            if high <= from || high <= low * widest {
                i += 1;
                continue;
            }
            let middle = (low.max(from / widest) * high).sqrt();
            try_at(&mut curve, middle)?;
        }
        if first.reached {
            for _ in 0..200 {
                let crossing = curve.first_crossing(self.limit);
                let [low, high] = crossing.between;
                if high - low <= self.tolerance * high {
                    break;
                }
                try_at(&mut curve, 0.5 * (low + high))?;
            }
        }
        Ok(curve)
    }
}

/// Fractiles of 16, 50 and 84 % of the demand at one level, over the records' demands there: what is only known
/// to have reached a value counts as above all, and that of which nothing is known is left out.
#[must_use]
pub fn demand_fractiles(demands: &[Demanded]) -> [f64; 3] {
    fractile::fractiles(&demands.iter().map(|demand| demand.or_beyond()).collect::<Vec<_>>())
}

/// Fractiles of 16, 50 and 84 % of the intensity at which the records first reach a limit; a record
/// that does not reach it counts as above all, so a fractile may be infinite. One whose curve is cut short by
/// runs without an answer is left out.
#[must_use]
pub fn level_fractiles(curves: &[Curve], limit: f64) -> [f64; 3] {
    let of = |curve: &Curve| {
        let crossing = curve.first_crossing(limit);
        match (crossing.reached, crossing.cut_short) {
            (true, _) => crossing.level,
            (false, false) => f64::INFINITY,
            (false, true) => f64::NAN,
        }
    };
    fractile::fractiles(&curves.iter().map(of).collect::<Vec<_>>())
}

/// How levels are chosen.
#[derive(Clone, Debug, PartialEq)]
pub enum IdaLevels {
    /// The same for all records, in SI, rising.
    Fixed(Vec<f64>),
    /// Sought for each record, between these two.
    Hunt {
        /// First level tried.
        start: f64,
        /// Highest level tried.
        top: f64,
    },
}

/// An incremental dynamic analysis to be run.
#[derive(Clone, Debug)]
pub struct IdaRequest<'a> {
    /// The models: every design of their grid is run.
    pub models: &'a Models,
    /// Bounds of friction with which every design is run; empty where it is run as it stands.
    pub bounds: &'a [Bound],
    /// The records.
    pub suite: &'a Suite,
    /// The measure; that of a component is of a pair the geometric mean.
    pub measure: LevelMeasure,
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on it, SI; a hunt needs one.
    pub limit: Option<f64>,
    /// The levels.
    pub levels: IdaLevels,
    /// Designs that are run: `PATH=VALUE` or `PATH=FROM..TO`, all of them.
    pub keep: &'a [String],
    /// The path whose values have curves of their own; over the others is averaged. Bounds of
    /// friction, `friction`, where several are run and nothing else is asked for.
    pub by: Option<&'a str>,
}

/// The designs in which a path has one value.
#[derive(Clone, Debug)]
pub struct IdaGroup {
    /// The value, in SI; NaN of a text, and where nothing is taken apart.
    pub value: f64,
    /// The value as a text, such as a bound of friction; empty for numbers.
    pub text: String,
    /// Designs that it averages over.
    pub averaged: Averaged,
    /// What each curve is of: the record, and the design where there are several.
    pub names: Vec<String>,
    /// The curves of the demand, design by design, record by record.
    pub curves: Vec<Curve>,
    /// A lognormal fit of the capacities, where there is a limit.
    pub fit: Option<Result<Fragility, FitError>>,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct IdaRun {
    /// The path that tells the groups apart, and its SI unit.
    pub by: Option<(String, String)>,
    /// The groups in rising order, one where nothing is taken apart.
    pub groups: Vec<IdaGroup>,
    /// Runs without an answer.
    pub failures: Vec<FailedRun>,
    /// How many runs were certified. One that the check does not confirm is no point of its curve.
    pub certified: Certified,
    /// What was noticed of runs.
    pub warnings: Vec<Notice>,
    /// A row a run: record, level, scale, design, all demands.
    pub rows: Table,
    /// A row a record and design, where there is a limit.
    pub capacities: Option<Table>,
}

/// Runs an incremental dynamic analysis.
///
/// # Errors
/// [`AssessmentError`] for a demand that is none, levels that do not rise, a hunt without a limit,
/// records that cannot be scaled, values that make no model, paths that are not varied, and where it is
/// stopped.
pub fn run_ida(request: &IdaRequest<'_>, engine: &Engine<'_>) -> Result<IdaRun, AssessmentError> {
    let IdaRequest { models, suite, measure, .. } = request;
    let column = models.column(request.demand)?;
    let hunt = match &request.levels {
        IdaLevels::Fixed(levels) => {
            let rise = levels.windows(2).all(|pair| pair[0] < pair[1]);
            if levels.is_empty() || !rise || !(levels[0] > 0.0) {
                return Err(refuse("scale-to", "levels > 0 that rise", format!("{levels:?}")));
            }
            None
        }
        IdaLevels::Hunt { start, top } => {
            let Some(limit) = request.limit else {
                return Err(refuse("limit", "the limit to hunt for, or slider.gap", "nothing"));
            };
            Some(Hunt::new(limit, *start, *top)?)
        }
    };
    let designs = Designs::of(request)?;
    let numbered = designs.numbered();
    let mut by = request.by;
    let (mut groups, mut by_unit) = design_groups(&numbered, request.keep, by)?;
    let averages = |group: &DesignGroup| group.averaged.paths.iter().any(|path| path == FRICTION);
    if by.is_none() && groups.iter().any(averages) {
        // Nobody averages over bounds of friction.
        by = Some(FRICTION);
        (groups, by_unit) = design_groups(&numbered, request.keep, by)?;
    }
    // The designs that are kept, in their own order.
    let mut kept: Vec<usize> = groups.iter().flat_map(|group| group.designs.clone()).collect();
    kept.sort_unstable();
    let unscaled = suite.measure(measure, engine)?;
    let clusters = suite.clusters();
    let parts = kept.iter().map(|&design| Ok(Ok(designs.parts(design)?)));
    let parts = parts.collect::<Result<Vec<Result<Parts, RunError>>, AssessmentError>>()?;
    let all_runs = suite.runs(&[], 0.0, engine)?;
    let design = |case: &Case| &parts[kept.partition_point(|&of| of < designs.number(case))];
    let keep = |_: &Case, response: &Response, _: &GroundMotion| demand_values(&response.demands);
    let demanded = |ran: &CaseRun<Vec<f64>>| {
        let size = ran.kept.as_ref().map_or(f64::NAN, |values| values[column].abs());
        Demanded::of(request.demand, size, ran.travel_used_up_m())
    };
    let records = suite.records.len();
    let curves_count = kept.len() * records;
    // Curve `i` is that of the record `i % records` under the design `i / records` of those kept.
    let case = |curve: usize, (level, value): (usize, f64)| {
        let record = curve % records;
        let (design, bound) = designs.split(kept[curve / records]);
        Case { record, level, design, bound, scale: value / unscaled[record] }
    };
    let ran: Vec<Vec<(f64, CaseRun<Vec<f64>>)>> = match (&request.levels, &hunt) {
        (IdaLevels::Fixed(levels), _) => {
            let of =
                |curve| levels.iter().copied().enumerate().map(move |level| case(curve, level));
            let all: Vec<Case> = (0..curves_count).flat_map(of).collect();
            let mut ran = all_runs.all(&all, design, keep)?.into_iter();
            let curve = |_| levels.iter().copied().zip(ran.by_ref()).collect();
            (0..curves_count).map(curve).collect()
        }
        (_, Some(hunt)) => {
            engine.plan(curves_count as u64 * RUNS_OF_A_HUNT);
            let samples = |curve: usize| suite.records[curve % records].motion.len();
            engine.map_costliest_first(curves_count, samples, |curve| {
                let mut runs: Vec<(f64, CaseRun<Vec<f64>>)> = Vec::new();
                let mut thread = OneThread::new(&all_runs);
                let parts = &parts[curve / records];
                hunt.try_run(|level| {
                    let ran = thread.run(case(curve, (0, level)), (parts, None), keep);
                    let demand = demanded(&ran).against(hunt.limit);
                    runs.push((level, ran));
                    engine.done(1)?;
                    Ok::<_, Stopped>(demand)
                })?;
                engine.replan(RUNS_OF_A_HUNT, runs.len() as u64);
                sort(&mut runs, |a, b| a.0.total_cmp(&b.0));
                Ok(runs)
            })?
        }
        (IdaLevels::Hunt { .. }, None) => Vec::new(),
    };
    let lengths: Vec<usize> = ran.iter().map(Vec::len).collect();
    let (levels, mut flat): (Vec<f64>, Vec<CaseRun<Vec<f64>>>) = ran.into_iter().flatten().unzip();
    let label = |design: usize| models.grid().label(design);
    let in_words = suite.in_words(request.bounds, &label);
    let same = |values: &Vec<f64>, response: &Response| {
        same_bits(values, &demand_values(&response.demands))
    };
    let certified = all_runs.certify(&mut flat, design, same, |case| in_words.case(case))?;
    let mut points = levels.iter().copied().zip(&flat);
    let curve = |&length: &usize| {
        let runs: Vec<(f64, &CaseRun<Vec<f64>>)> = points.by_ref().take(length).collect();
        Curve {
            levels: runs.iter().map(|(level, _)| *level).collect(),
            demands: runs.iter().map(|(_, ran)| demanded(ran)).collect(),
        }
    };
    let curves: Vec<Curve> = lengths.iter().map(curve).collect();
    let (failures, warnings) = (in_words.failures(&flat), in_words.noticed(&flat));
    let record = |curve: usize| &suite.records[curve % records].name;
    let group = |group: DesignGroup| {
        let DesignGroup { value, text, designs: of_group, averaged } = group;
        let mut names = Vec::new();
        let mut own: Vec<Curve> = Vec::new();
        for design in &of_group {
            let at = kept.partition_point(|other| other < design);
            let label = designs.label(*design, &averaged);
            let name = |record: &Record| format!("{}{label}", record.name);
            names.extend(suite.records.iter().map(name));
            own.extend_from_slice(&curves[at * records..(at + 1) * records]);
        }
        let of_curves: Vec<usize> = (0..own.len()).map(|curve| clusters[curve % records]).collect();
        let fit = request.limit.map(|limit| fit_of(&own, limit, &of_curves));
        IdaGroup { value, text, averaged, names, curves: own, fit }
    };
    let groups = groups.into_iter().map(group).collect();
    let capacities = request.limit.map(|limit| {
        let crossings: Vec<(usize, Crossing)> =
            curves.iter().map(|curve| curve.first_crossing(limit)).enumerate().collect();
        let told: Vec<(usize, Crossing)> =
            crossings.into_iter().filter(|(_, crossing)| crossing.is_known()).collect();
        let names: Vec<String> = told.iter().map(|(curve, _)| record(*curve).clone()).collect();
        let of_curves: Vec<usize> = told.iter().map(|(curve, _)| kept[curve / records]).collect();
        let mut table = capacities(&told, &names, measure);
        let of_pairs = told.iter().map(|(curve, _)| clusters[curve % records]);
        table.columns.extend(suite.pair_column(of_pairs));
        table.columns.extend(designs.table(&of_curves).columns);
        table
    });
    let mut rows = Table::default();
    let of_rows = |pick: &dyn Fn(&Case) -> String| flat.iter().map(|ran| pick(&ran.case)).collect();
    rows.texts("record", of_rows(&|case| record(case.record).clone()));
    rows.texts("measure", vec![measure.to_string(); flat.len()]);
    rows.texts("measure_unit", vec![measure.unit().to_owned(); flat.len()]);
    rows.columns.extend(suite.pair_column(flat.iter().map(|ran| clusters[ran.case.record])));
    let choice = if hunt.is_some() { "hunted" } else { "given" };
    rows.texts("level_choice", vec![choice.to_owned(); flat.len()]);
    rows.numbers("level", measure.unit(), levels);
    rows.numbers("scale", "", flat.iter().map(|ran| ran.case.scale).collect());
    let of_runs: Vec<usize> = flat.iter().map(|ran| designs.number(&ran.case)).collect();
    rows.columns.extend(designs.table(&of_runs).columns);
    for (i, column) in models.columns().iter().enumerate() {
        let of = |ran: &CaseRun<Vec<f64>>| ran.kept.as_ref().map_or(f64::NAN, |values| values[i]);
        rows.numbers(&column.name(), column.unit(), flat.iter().map(of).collect());
    }
    add_answers(&mut rows, &flat, models.shape().surfaces > 0);
    rows.texts("status", flat.iter().map(|ran| status(ran.kept.as_ref().err())).collect());
    let by = by.map(|by| (by.to_owned(), by_unit));
    Ok(IdaRun { by, groups, failures, certified, warnings, rows, capacities })
}

/// The designs of an analysis: the models of its grid with each bound of friction, those fastest.
struct Designs<'a> {
    models: &'a Models,
    bounds: &'a [Bound],
}

impl<'a> Designs<'a> {
    fn of(request: &IdaRequest<'a>) -> Result<Self, AssessmentError> {
        let designs = Self { models: request.models, bounds: request.bounds };
        if designs.count() > MOST_DESIGNS {
            let expected = format!("at most {MOST_DESIGNS} designs");
            return Err(refuse("vary", expected, designs.count().to_string()));
        }
        Ok(designs)
    }

    fn count(&self) -> usize {
        self.models.grid().len().saturating_mul(self.bounds.len().max(1))
    }

    /// All of them with their numbers.
    fn numbered(&self) -> Table {
        let all: Vec<usize> = (0..self.count()).collect();
        let numbers = Cells::Counts(all.iter().map(|&design| Some(design as i64)).collect());
        let column = Column { name: "design".to_owned(), unit: String::new(), cells: numbers };
        let mut table = Table { columns: vec![column] };
        table.columns.extend(self.table(&all).columns);
        table
    }

    /// The place in the grid of a design, and the number of its bound.
    fn split(&self, design: usize) -> (usize, usize) {
        let bounds = self.bounds.len().max(1);
        (design / bounds, design % bounds)
    }

    /// The number of a case's design.
    fn number(&self, case: &Case) -> usize {
        case.design * self.bounds.len().max(1) + case.bound
    }

    fn parts(&self, design: usize) -> Result<Parts, AssessmentError> {
        let (place, bound) = self.split(design);
        let mut parts = self.models.parts(&self.models.grid().values(place))?;
        if let Some(bound) = self.bounds.get(bound) {
            parts.model = bound.of(&parts.model);
        }
        Ok(parts)
    }

    /// Columns of what is varied, a row for each of some designs.
    fn table(&self, designs: &[usize]) -> Table {
        let mut table = Table::default();
        let grid = self.models.grid();
        for (i, axis) in grid.axes().iter().enumerate() {
            let value = |design: &usize| grid.values(self.split(*design).0)[i];
            table.numbers(&axis.path, &axis.unit, designs.iter().map(value).collect());
        }
        if !self.bounds.is_empty() {
            let name = |design: &usize| self.bounds[self.split(*design).1].name.to_owned();
            let names = designs.iter().map(name).collect();
            table.texts(FRICTION, names);
        }
        table
    }

    /// What tells a design from the others that are averaged with it.
    fn label(&self, design: usize, averaged: &Averaged) -> String {
        let (place, bound) = self.split(design);
        let grid = self.models.grid();
        let values = grid.axes().iter().zip(grid.values(place));
        let mut label = String::new();
        for (axis, value) in values.filter(|(axis, _)| averaged.paths.contains(&axis.path)) {
            label.push_str(format!(", {value} {}", axis.unit).trim_end());
        }
        let bound = self.bounds.get(bound);
        if let Some(bound) = bound.filter(|_| averaged.paths.iter().any(|path| path == FRICTION)) {
            label.push_str(&format!(", {}", bound.name));
        }
        label
    }
}

/// Most designs of one analysis: a curve of each record for each of them is kept.
const MOST_DESIGNS: usize = 100_000;

/// The fit of the first crossings; clustered where several curves share what they are clustered by. A curve of
/// which nothing is known is left out.
fn fit_of(curves: &[Curve], limit: f64, clusters: &[usize]) -> Result<Fragility, FitError> {
    let of = |(curve, cluster): (&Curve, &usize)| {
        let crossing = curve.first_crossing(limit);
        crossing.is_known().then(|| (crossing.capacity(), *cluster))
    };
    let (capacities, clusters): (Vec<Capacity>, Vec<usize>) =
        curves.iter().zip(clusters).filter_map(of).unzip();
    // Numbered without those that are left out.
    let mut numbers: Vec<usize> = clusters.clone();
    numbers.sort_unstable();
    numbers.dedup();
    let shared = numbers.len() < clusters.len();
    let number = |cluster: &usize| numbers.partition_point(|other| other < cluster);
    let clusters: Vec<usize> = clusters.iter().filter(|_| shared).map(number).collect();
    Fragility::of_capacities_by_record(&capacities, &clusters)
}

/// The first crossings, a row a curve.
fn capacities(of_curves: &[(usize, Crossing)], names: &[String], measure: &LevelMeasure) -> Table {
    let crossings: Vec<Crossing> = of_curves.iter().map(|(_, crossing)| *crossing).collect();
    let unit = measure.unit();
    let mut table = Table::default();
    table
        .texts("record", names.to_vec())
        .texts("measure", vec![measure.to_string(); names.len()])
        .texts("measure_unit", vec![unit.to_owned(); names.len()])
        .numbers("capacity", unit, crossings.iter().map(|c| c.level).collect())
        .numbers("reached", "", crossings.iter().map(|c| f64::from(u8::from(c.reached))).collect())
        .numbers("below", unit, crossings.iter().map(|c| c.between[0]).collect())
        .numbers("above", unit, crossings.iter().map(|c| c.between[1]).collect())
        .numbers(
            "returns",
            unit,
            crossings.iter().map(|c| c.returns.unwrap_or(f64::NAN)).collect(),
        );
    table
}
