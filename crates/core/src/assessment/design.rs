//! Choice of a design over a suite of records: a gap kept with a stated probability, and the least
//! floor acceleration.
//!
//! Every design is judged by two figures over the suite, both counted
//! (`numerics/fractile.rs`): the sliding displacement that a share
//! `probability` of the records does not exceed, and the floor acceleration that a share
//! `acceleration_share` of them does not. A design is *feasible* where the first is within the gap.
//! The *front* is the feasible designs that no other feasible design beats: none is at least as good in
//! both figures and better in one.
//!
//! The search looks at every design of its grid and leaves out only runs that cannot change the front.
//! With some records run, the others' demands taken as 0 give lower bounds of both figures; a design
//! is dropped when its bound of displacement is beyond the gap, or when a design of the front is
//! better than both bounds. So the front equals that of the full grid, run for run.

use std::collections::HashMap;

use super::grid::Axis;
use super::models::Models;
use super::proportion::Proportion;
use super::sensitivity::{self, Index};
use super::suite::{Scaling, Suite};
use super::{AssessmentError, FailedRun};
use crate::error::{FitError, RunError, Stopped};
use crate::input::{Bound, Parts};
use crate::notice::Notice;
use crate::numerics::fractile::{held_by, needed, sorted};
use crate::numerics::sort;
use crate::numerics::unit_points;
use crate::response::{Response, demand_values};
use crate::study::cases::{Case, CaseRun, Runs, add_answers};
use crate::study::certified::{Certified, same_bits};
use crate::study::engine::Engine;
use crate::study::kept::InNumbers;
use crate::study::{Demanded, SLIDING};
use crate::table::Table;

/// What is asked of a design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Sliding displacement that must be kept, in m, > 0.
    pub gap_m: f64,
    /// Share of the records in which it must be, in (0, 1].
    pub probability: f64,
    /// Share of the records that must not exceed the floor acceleration to be made least, in (0, 1]:
    /// 0.5 for the median.
    pub acceleration_share: f64,
}

/// Peak demands of one run, SI: infinite where the run is known to be beyond the gap, NaN where nothing is known,
/// which is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demand {
    /// Peak sliding displacement in m.
    pub displacement_m: f64,
    /// Peak floor acceleration in m/s².
    pub acceleration_m_per_s2: f64,
}

/// A design over the whole suite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Peak sliding displacement that the asked share of the records does not exceed, in m.
    pub displacement_m: f64,
    /// Peak floor acceleration that the asked share of the records does not exceed, in m/s².
    pub acceleration_m_per_s2: f64,
    /// Records in which the gap is kept.
    pub within: Proportion,
}

/// A design of the front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Number of the design.
    pub design: usize,
    /// Its figures.
    pub figures: Figures,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchResult {
    /// The front, by rising displacement; the last has the least acceleration.
    pub front: Vec<Point>,
    /// Runs made, of designs × records.
    pub runs: u64,
    /// Designs dropped because they exceed the gap too often.
    pub beyond_gap: usize,
    /// Where no design is feasible, the one with the least displacement of all.
    pub nearest: Option<Point>,
}

impl SearchResult {
    /// The feasible design with the least acceleration, and of those the least displacement.
    #[must_use]
    pub fn chosen(&self) -> Option<Point> {
        self.front.last().copied()
    }
}

impl Target {
    /// Checks every number.
    ///
    /// # Errors
    /// [`FitError::OutOfRange`].
    pub fn check(&self) -> Result<(), FitError> {
        if !(self.gap_m.is_finite() && self.gap_m > 0.0) {
            let expected = "a finite gap > 0";
            return Err(FitError::OutOfRange { quantity: "gap", expected, found: self.gap_m });
        }
        for (quantity, found) in
            [("probability", self.probability), ("acceleration share", self.acceleration_share)]
        {
            if !(found > 0.0 && found <= 1.0) {
                let expected = "a share above 0, at most 1";
                return Err(FitError::OutOfRange { quantity, expected, found });
            }
        }
        Ok(())
    }

    /// The figures of a design from its demands, one a record.
    ///
    /// # Errors
    /// [`FitError`] for no demands.
    pub fn figures(&self, demands: &[Demand]) -> Result<Figures, FitError> {
        // What no run tells is beyond everything.
        let told = |bound: f64| if bound < 0.0 { f64::INFINITY } else { bound };
        let [displacement_m, acceleration_m_per_s2] = self.bounds(demands, 0).map(told);
        let within = demands.iter().filter(|d| d.displacement_m <= self.gap_m).count() as u64;
        let known = demands.iter().filter(|d| !d.displacement_m.is_nan()).count() as u64;
        let within = match known {
            0 => Proportion::new(0, demands.len() as u64)?,
            _ => Proportion::new(within, known)?,
        };
        Ok(Figures { displacement_m, acceleration_m_per_s2, within })
    }

    /// Lower bounds of both figures with `missing` records not yet run, their demands taken as 0.
    fn bounds(&self, demands: &[Demand], missing: usize) -> [f64; 2] {
        let of = |pick: fn(&Demand) -> f64, share: f64| {
            let none = std::iter::repeat_n(0.0, missing);
            let values: Vec<f64> = demands.iter().map(pick).chain(none).collect();
            held_by(&sorted(&values), share)
        };
        [
            of(|d| d.displacement_m, self.probability),
            of(|d| d.acceleration_m_per_s2, self.acceleration_share),
        ]
    }
}

/// Designs judged together: the front found so far bounds the next batch. Few, so that small grids have several;
/// enough for the threads of a large machine.
const BATCH: usize = 32;
/// Parts in which a batch's records are run.
const PARTS: usize = 6;

/// Searches `designs × records` runs for the front.
///
/// `run` gives the demands of pairs (design, record), in their order; it may run them in any order and
/// in parallel. The result depends on nothing else: batches are fixed.
///
/// # Errors
/// [`FitError`] for a target out of range, no designs or no records; and those of `run`.
pub fn search<E: From<FitError>>(
    target: &Target,
    designs: usize,
    records: usize,
    mut run: impl FnMut(&[(usize, usize)]) -> Result<Vec<Demand>, E>,
) -> Result<SearchResult, E> {
    target.check()?;
    for (what, found) in [("designs", designs), ("records", records)] {
        if found == 0 {
            return Err(FitError::TooFew { what, expected: 1, found }.into());
        }
    }
    let mut found = SearchResult { front: Vec::new(), runs: 0, beyond_gap: 0, nearest: None };
    // What a design must keep to be of interest: the gap, or while none keeps that, the least so far.
    let mut kept_m = f64::INFINITY;
    let part = records.div_ceil(PARTS);
    for batch in spread(designs).chunks(BATCH) {
        let mut active: Vec<(usize, Vec<Demand>)> =
            batch.iter().map(|&design| (design, Vec::with_capacity(records))).collect();
        for first in (0..records).step_by(part) {
            let last = (first + part).min(records);
            let pairs: Vec<(usize, usize)> = active
                .iter()
                .flat_map(|(design, _)| (first..last).map(|record| (*design, record)))
                .collect();
            found.runs += pairs.len() as u64;
            let demands = run(&pairs)?;
            for ((_, known), new) in active.iter_mut().zip(demands.chunks(last - first)) {
                known.extend_from_slice(new);
            }
            let missing = records - last;
            active.retain(|(_, known)| {
                let bounds = target.bounds(known, missing);
                if missing > 0 && bounds[0] > kept_m {
                    found.beyond_gap += 1;
                    return false;
                }
                missing == 0 || !found.front.iter().any(|point| beats(point, bounds))
            });
        }
        for (design, demands) in active {
            let point = Point { design, figures: target.figures(&demands)? };
            if point.figures.displacement_m <= target.gap_m {
                insert(&mut found.front, point);
            } else {
                found.beyond_gap += 1;
                let least = |nearest: &Point| {
                    let (new, old) = (point.figures.displacement_m, nearest.figures.displacement_m);
                    new < old || (new == old && point.design < nearest.design)
                };
                if found.nearest.as_ref().is_none_or(least) {
                    found.nearest = Some(point);
                }
            }
            kept_m = kept_m.min(point.figures.displacement_m).max(target.gap_m);
        }
    }
    // Equal figures stand together, the first design first; the last has the least acceleration.
    sort(&mut found.front, |a, b| {
        let (of_a, of_b) = (&a.figures, &b.figures);
        of_a.displacement_m
            .total_cmp(&of_b.displacement_m)
            .then(of_b.acceleration_m_per_s2.total_cmp(&of_a.acceleration_m_per_s2))
            .then(b.design.cmp(&a.design))
    });
    if !found.front.is_empty() {
        found.nearest = None;
    }
    Ok(found)
}

/// How many of `records` must keep the gap.
#[must_use]
pub fn records_needed(target: &Target, records: usize) -> usize {
    needed(target.probability, records)
}

/// Whether a point is at least as good in both figures and better in one.
fn beats(point: &Point, [displacement, acceleration]: [f64; 2]) -> bool {
    let Figures { displacement_m: d, acceleration_m_per_s2: a, .. } = point.figures;
    d <= displacement && a <= acceleration && (d < displacement || a < acceleration)
}

fn insert(front: &mut Vec<Point>, point: Point) {
    let figures = [point.figures.displacement_m, point.figures.acceleration_m_per_s2];
    if front.iter().any(|other| beats(other, figures)) {
        return;
    }
    front.retain(|other| {
        let of_other = [other.figures.displacement_m, other.figures.acceleration_m_per_s2];
        !beats(&point, of_other)
    });
    front.push(point);
}

/// All numbers below `n`, every start of the list spread over the whole: steps of the golden ratio.
fn spread(n: usize) -> Vec<usize> {
    let rough = libm::round(n as f64 * 0.618_033_988_749_894_9) as usize;
    let step = (rough.max(1)..=n.max(1)).find(|step| gcd(*step, n) == 1).unwrap_or(1);
    (0..n)
        .scan(0, |at, _| {
            let now = *at;
            *at = (*at + step) % n.max(1);
            Some(now)
        })
        .collect()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// A design to be searched for.
#[derive(Clone, Copy, Debug)]
pub struct DesignRequest<'a> {
    /// The models; their grid is what is searched.
    pub models: &'a Models,
    /// The records.
    pub suite: &'a Suite,
    /// How they are scaled.
    pub scaling: &'a Scaling,
    /// What is asked for.
    pub target: Target,
    /// Key of the acceleration to be made least.
    pub acceleration: &'a str,
    /// Factors on friction of the lower and the upper bound, where the front is to be run with them.
    pub bounds: Option<[f64; 2]>,
    /// Sample points of the sensitivity; 0 for none.
    pub sensitivity: u32,
    /// Seed of those points.
    pub seed: u64,
    /// Confidence of intervals.
    pub confidence: f64,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct DesignRun {
    /// What was varied, the last fastest.
    pub variables: Vec<Axis>,
    /// The front, and how many runs it took.
    pub found: SearchResult,
    /// The front (or the nearest design) with lower and upper friction.
    pub bounded: Option<Vec<Bounded>>,
    /// Sensitivity, or why there is none.
    pub sensitivity: Option<Result<Sensitivity, SensitivityError>>,
    /// Runs of the search without an answer.
    pub failures: Vec<FailedRun>,
    /// How many runs of the search and of its front under bounds of friction were certified. One that the check
    /// does not confirm chooses nothing.
    pub certified: Certified,
    /// What was noticed of runs of the search.
    pub warnings: Vec<Notice>,
    /// Both figures over the two main variables; `None` where fewer than two vary.
    pub map: Option<DesignMap>,
    /// The front, a row a design.
    pub front: Table,
    /// The runs of the designs on the front: record, level, values and both demands.
    pub runs: Table,
}

/// Displacement and acceleration over two variables, the others as in the chosen design.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignMap {
    /// Numbers of the two variables: those that matter most, by the total indices of the sensitivity
    /// where there are some, else the first two.
    pub variables: [usize; 2],
    /// Values of the first, in SI, rising.
    pub x: Vec<f64>,
    /// Values of the second, in SI, rising.
    pub y: Vec<f64>,
    /// Displacement that the asked share of the records keeps, in m, at `x[i]` and `y[j]`:
    /// `i * y.len() + j`.
    pub displacement_m: Vec<f64>,
    /// The same of the acceleration, in m/s².
    pub acceleration_m_per_s2: Vec<f64>,
}

/// A design with friction at its lower and upper bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded {
    /// Number of the design.
    pub design: usize,
    /// Its figures with lower friction.
    pub lower: Figures,
    /// Its figures with upper friction.
    pub upper: Figures,
}

/// Indices of every variable for displacement and acceleration.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Number of sample points `N`.
    pub points: usize,
    /// For the displacement that the asked share keeps.
    pub displacement: Vec<Index>,
    /// For the acceleration.
    pub acceleration: Vec<Index>,
}

/// Why there is no sensitivity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SensitivityError {
    /// Too few points, or outputs that do not vary.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A run of it failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Searches for a design; the engine is told of every run.
///
/// # Errors
/// [`AssessmentError`] for a demand that is none, a target out of range, scaling without an answer,
/// and where it is stopped. A run without an answer counts as beyond the gap where it used up a travel as long as
/// that; else it is left out.
pub fn run_design(
    request: &DesignRequest<'_>,
    engine: &Engine<'_>,
) -> Result<DesignRun, AssessmentError> {
    let DesignRequest { models, suite, target, .. } = *request;
    target.check()?;
    let runner = Runner::new(request, engine)?;
    let records = suite.records.len();
    let grid = models.grid();
    let parts = models.all(records, engine)?;
    let label = |design: usize| grid.label(design);
    let in_words = suite.in_words(&[], &label);
    let mut ran: Vec<CaseRun<Demand>> = Vec::new();
    let mut found = runner.searched(&target, &parts, &mut ran)?;
    let mut certified = runner.certify(&mut ran, &parts, &|case| in_words.case(case))?;
    if !certified.unconfirmed.is_empty() {
        // A run that is not confirmed has chosen nothing.
        found = runner.searched(&target, &parts, &mut ran)?;
        certified.runs = ran.len() as u64;
    }
    let (mut failed, mut warnings) = (in_words.failures(&ran), in_words.noticed(&ran));
    let bounded = match request.bounds {
        None => None,
        Some(factors) => {
            let designs: Vec<usize> =
                found.front.iter().chain(&found.nearest).map(|point| point.design).collect();
            let bounds = ["lower", "upper"].into_iter().zip(factors);
            let bounds = bounds.map(|(name, friction_factor)| Bound { name, friction_factor });
            let bounds: Vec<Bound> = bounds.collect();
            let in_words = suite.in_words(&bounds, &label);
            let name = |case: &Case| in_words.case(case);
            let (bounded, ran, of_bounds) =
                runner.bounded((&designs, &parts), factors, &target, &name)?;
            failed.extend(in_words.failures(&ran));
            warnings.extend(in_words.noticed(&ran));
            certified.join(of_bounds);
            Some(bounded)
        }
    };
    let sensitivity = if request.sensitivity > 0 { runner.sensitivity(request)? } else { None };
    let variables = grid.axes().to_vec();
    let map = runner.map(request, &found, sensitivity.as_ref())?;
    let front = table(request, &variables, &found, bounded.as_deref());
    ran.retain(|ran| found.front.iter().any(|point| point.design == ran.case.design));
    sort(&mut ran, |a, b| (a.case.design, a.case.record).cmp(&(b.case.design, b.case.record)));
    let runs = rows(request, &runner, &ran)?;
    Ok(DesignRun {
        variables,
        found,
        bounded,
        sensitivity,
        failures: failed,
        certified,
        warnings,
        map,
        front,
        runs,
    })
}

/// A row for each run of a design and a record.
fn rows(
    request: &DesignRequest<'_>,
    runner: &Runner<'_>,
    ran: &[CaseRun<Demand>],
) -> Result<Table, AssessmentError> {
    let (suite, grid) = (request.suite, request.models.grid());
    let records: Vec<usize> = ran.iter().map(|ran| ran.case.record).collect();
    let mut rows = Table::default();
    rows.texts("record", records.iter().map(|&i| suite.records[i].name.clone()).collect());
    let intensities =
        suite.intensities(request.scaling, &runner.factors, &records, runner.engine)?;
    rows.columns.extend(intensities.columns);
    rows.numbers("scale", "", records.iter().map(|&i| runner.factors[i]).collect());
    for (i, axis) in grid.axes().iter().enumerate() {
        let value = |ran: &CaseRun<Demand>| grid.values(ran.case.design)[i];
        rows.numbers(&axis.path, &axis.unit, ran.iter().map(value).collect());
    }
    let all: Vec<Demand> = ran.iter().map(|ran| *ran.kept.as_ref().unwrap_or(&UNKNOWN)).collect();
    let displacements = all.iter().map(|demand| demand.displacement_m).collect();
    rows.numbers(SLIDING, "m", displacements);
    let accelerations = all.iter().map(|demand| demand.acceleration_m_per_s2).collect();
    rows.numbers(request.acceleration, "m/s2", accelerations);
    add_answers(&mut rows, ran, request.models.shape().surfaces > 0);
    Ok(rows)
}

/// Most values of a variable in a map: 25 by 25 designs give smooth lines.
const MAP_VALUES: usize = 25;

impl InNumbers for Demand {
    fn numbers(&self) -> Option<Vec<f64>> {
        Some(vec![self.displacement_m, self.acceleration_m_per_s2])
    }

    fn of(numbers: Vec<f64>) -> Option<Self> {
        let [displacement_m, acceleration_m_per_s2] = numbers[..] else { return None };
        Some(Self { displacement_m, acceleration_m_per_s2 })
    }
}

/// A run of which nothing is known.
const UNKNOWN: Demand = Demand { displacement_m: f64::NAN, acceleration_m_per_s2: f64::NAN };

/// What a run says where a gap is to be kept.
fn demand(ran: &CaseRun<Demand>, gap_m: f64) -> Demand {
    ran.kept.as_ref().copied().unwrap_or_else(|error| {
        let sliding = Demanded::of(SLIDING, f64::NAN, error.travel_used_up_m());
        Demand { displacement_m: sliding.against(gap_m), ..UNKNOWN }
    })
}

/// The same of several.
fn demands(ran: &[CaseRun<Demand>], gap_m: f64) -> Vec<Demand> {
    ran.iter().map(|ran| demand(ran, gap_m)).collect()
}

/// Designs with friction at its bounds, their runs, and how many of those were certified.
type BoundedRuns = (Vec<Bounded>, Vec<CaseRun<Demand>>, Certified);

/// What all runs of a search share.
struct Runner<'a> {
    models: &'a Models,
    engine: &'a Engine<'a>,
    factors: Vec<f64>,
    runs: Runs<'a>,
    displacement: usize,
    acceleration: usize,
}

impl<'a> Runner<'a> {
    fn new(request: &DesignRequest<'a>, engine: &'a Engine<'a>) -> Result<Self, AssessmentError> {
        let (models, suite) = (request.models, request.suite);
        let factors = suite.scaled(request.scaling, engine)?.factors;
        let first = models.parts(&models.grid().values(0));
        let tail_s = first.map_or(0.0, |parts| parts.tail_s);
        Ok(Self {
            displacement: models.column("peak_sliding_displacement_m")?,
            acceleration: models.column(request.acceleration)?,
            runs: suite.runs(&factors, tail_s, engine)?,
            models,
            engine,
            factors,
        })
    }

    /// Runs of cases of these designs, in their order; those of one design stand together.
    fn run(
        &self,
        cases: &[Case],
        designs: &[Result<Parts, RunError>],
    ) -> Result<Vec<CaseRun<Demand>>, Stopped> {
        self.runs.all(
            cases,
            |case| &designs[case.design],
            |_, response, _| {
                let values = demand_values(&response.demands);
                Demand {
                    displacement_m: values[self.displacement],
                    acceleration_m_per_s2: values[self.acceleration],
                }
            },
        )
    }

    /// The front of a target; runs that were made already are not made again, those that are made are kept.
    fn searched(
        &self,
        target: &Target,
        parts: &[Result<Parts, RunError>],
        ran: &mut Vec<CaseRun<Demand>>,
    ) -> Result<SearchResult, AssessmentError> {
        let of = |ran: &CaseRun<Demand>| (ran.case.design, ran.case.record);
        let mut places: HashMap<(usize, usize), usize> =
            ran.iter().enumerate().map(|(place, ran)| (of(ran), place)).collect();
        search(target, parts.len(), self.factors.len(), |pairs: &[(usize, usize)]| {
            let lacking = pairs.iter().filter(|pair| !places.contains_key(pair));
            let case = |&(design, record): &(usize, usize)| Case {
                design,
                record,
                scale: self.factors[record],
                ..Case::default()
            };
            for run in self.run(&lacking.map(case).collect::<Vec<_>>(), parts)? {
                places.insert(of(&run), ran.len());
                ran.push(run);
            }
            let of_pairs = pairs.iter().map(|pair| demand(&ran[places[pair]], target.gap_m));
            Ok::<_, AssessmentError>(of_pairs.collect())
        })
    }

    /// Judges some runs of designs; `name` is what a run is called.
    fn certify(
        &self,
        ran: &mut [CaseRun<Demand>],
        designs: &[Result<Parts, RunError>],
        name: &dyn Fn(&Case) -> String,
    ) -> Result<Certified, Stopped> {
        let same = |demand: &Demand, response: &Response| {
            let values = demand_values(&response.demands);
            let again = [values[self.displacement], values[self.acceleration]];
            same_bits(&[demand.displacement_m, demand.acceleration_m_per_s2], &again)
        };
        self.runs.certify(ran, |case| &designs[case.design], same, name)
    }

    /// Every one of some designs on every record, the records fastest.
    fn all(&self, parts: &[Result<Parts, RunError>]) -> Result<Vec<CaseRun<Demand>>, Stopped> {
        self.run(&Case::every(parts.len(), 1, &self.factors), parts)
    }

    /// Figures of designs, those of these numbers, with friction times the lower and the upper factor, those runs,
    /// and how many of them were certified; `name` is what a run is called.
    fn bounded(
        &self,
        (designs, parts): (&[usize], &[Result<Parts, RunError>]),
        factors: [f64; 2],
        target: &Target,
        name: &dyn Fn(&Case) -> String,
    ) -> Result<BoundedRuns, AssessmentError> {
        let with = |(design, factor): (usize, f64)| -> Result<Parts, RunError> {
            let parts = parts[design].as_ref().map_err(Clone::clone)?;
            Ok(Parts { model: parts.model.with_friction_times(factor)?, ..parts.clone() })
        };
        let both = designs.iter().flat_map(|design| factors.map(|factor| (*design, factor)));
        let with_factors = both.map(with).collect::<Vec<_>>();
        let mut ran = self.all(&with_factors)?;
        let of_bound = |case: &Case| Case {
            design: designs[case.design / 2],
            bound: case.design % 2,
            ..*case
        };
        let certified = self.certify(&mut ran, &with_factors, &|case| name(&of_bound(case)))?;
        for CaseRun { case, .. } in &mut ran {
            *case = of_bound(case);
        }
        let of_bounds = demands(&ran, target.gap_m);
        let of_bounds: Vec<&[Demand]> = of_bounds.chunks(self.factors.len()).collect();
        let bounded = |(pair, &design): (&[&[Demand]], &usize)| {
            let (lower, upper) = (target.figures(pair[0])?, target.figures(pair[1])?);
            Ok(Bounded { design, lower, upper })
        };
        let bounded = of_bounds.chunks(2).zip(designs).map(bounded);
        Ok((bounded.collect::<Result<_, AssessmentError>>()?, ran, certified))
    }

    /// Figures over the two main variables, at no more than [`MAP_VALUES`] values of each.
    fn map(
        &self,
        request: &DesignRequest<'_>,
        found: &SearchResult,
        sensitivity: Option<&Result<Sensitivity, SensitivityError>>,
    ) -> Result<Option<DesignMap>, AssessmentError> {
        let grid = self.models.grid();
        let vary = |i: &usize| grid.axes()[*i].values.len() > 1;
        let mut main: Vec<usize> = (0..grid.axes().len()).filter(vary).collect();
        if let Some(Ok(sensitivity)) = sensitivity {
            let total = |i: usize| {
                let largest =
                    sensitivity.displacement[i].total.max(sensitivity.acceleration[i].total);
                if largest.is_finite() { largest } else { 0.0 }
            };
            sort(&mut main, |a, b| total(*b).total_cmp(&total(*a)));
        }
        main.truncate(2);
        main.sort_unstable();
        let Some(design) = found.chosen().or(found.nearest).map(|point| point.design) else {
            return Ok(None);
        };
        let [first, second] = main[..] else { return Ok(None) };
        let places = |i: usize| {
            let values = &grid.axes()[i].values;
            let mut places: Vec<usize> = (0..values.len()).collect();
            sort(&mut places, |a, b| values[*a].total_cmp(&values[*b]));
            let (count, all) = (places.len().min(MAP_VALUES), places.len());
            (0..count).map(|k| places[k * (all - 1) / (count - 1).max(1)]).collect::<Vec<_>>()
        };
        let (of_x, of_y) = (places(first), places(second));
        let chosen = grid.values(design);
        let parts = |k: usize| {
            let mut values = chosen.clone();
            values[first] = grid.axes()[first].values[of_x[k / of_y.len()]];
            values[second] = grid.axes()[second].values[of_y[k % of_y.len()]];
            Ok(self.models.parts(&values).map_err(RunError::from))
        };
        let parts = self.engine.map(of_x.len() * of_y.len(), parts)?;
        // What makes no model, or fails, has no figures, and no line goes through it.
        let demands = demands(&self.all(&parts)?, request.target.gap_m);
        let figures = demands.chunks(self.factors.len()).map(|demands| {
            request.target.figures(demands).map_or([f64::NAN; 2], |figures| {
                [figures.displacement_m, figures.acceleration_m_per_s2]
            })
        });
        let figures: Vec<[f64; 2]> = figures.collect();
        let value = |axis: usize| move |place: &usize| grid.axes()[axis].values[*place];
        Ok(Some(DesignMap {
            variables: [first, second],
            x: of_x.iter().map(value(first)).collect(),
            y: of_y.iter().map(value(second)).collect(),
            displacement_m: figures.iter().map(|pair| pair[0]).collect(),
            acceleration_m_per_s2: figures.iter().map(|pair| pair[1]).collect(),
        }))
    }

    /// Sobol' indices of both figures, the variables uniform between their ends.
    fn sensitivity(
        &self,
        request: &DesignRequest<'_>,
    ) -> Result<Option<Result<Sensitivity, SensitivityError>>, Stopped> {
        let axes = self.models.grid().axes();
        let inputs = axes.len();
        let points = unit_points(2 * inputs, request.sensitivity, request.seed);
        let rows = match sensitivity::design(&points, inputs) {
            Ok(rows) => rows,
            Err(error) => return Ok(Some(Err(error.into()))),
        };
        let parts = self.engine.map(rows.len(), |i| {
            let value = |(axis, u): (&Axis, &f64)| {
                let [low, high] = axis.ends();
                (low + u * (high - low)).clamp(low, high)
            };
            let values: Vec<f64> = axes.iter().zip(&rows[i]).map(value).collect();
            Ok(self.models.parts(&values).map_err(RunError::from))
        })?;
        let ran = self.all(&parts)?;
        let figures = |of_row: &[CaseRun<Demand>]| -> Result<[f64; 2], SensitivityError> {
            let demands =
                of_row.iter().map(|ran| ran.kept.clone()).collect::<Result<Vec<_>, _>>()?;
            let figures = request.target.figures(&demands)?;
            Ok([figures.displacement_m, figures.acceleration_m_per_s2])
        };
        let indices = || -> Result<Sensitivity, SensitivityError> {
            let figures = ran.chunks(self.factors.len()).map(figures);
            let figures = figures.collect::<Result<Vec<_>, _>>()?;
            let of = |which: usize| {
                let outputs: Vec<f64> = figures.iter().map(|pair| pair[which]).collect();
                sensitivity::indices(&outputs, inputs, request.confidence)
            };
            Ok(Sensitivity { points: points.len(), displacement: of(0)?, acceleration: of(1)? })
        };
        Ok(Some(indices()))
    }
}

fn table(
    request: &DesignRequest,
    variables: &[Axis],
    found: &SearchResult,
    bounded: Option<&[Bounded]>,
) -> Table {
    let points = &found.front;
    let mut table = Table::default();
    for (i, variable) in variables.iter().enumerate() {
        let of = |design: usize| request.models.grid().values(design)[i];
        let cells = points.iter().map(|point| of(point.design)).collect();
        table.numbers(&variable.path, &variable.unit, cells);
    }
    let mut figures = |suffix: &str, all: Vec<Figures>| {
        let name = |name: &str| format!("{name}{suffix}");
        let column = |pick: &dyn Fn(&Figures) -> f64| all.iter().map(pick).collect::<Vec<_>>();
        table.numbers(&name("displacement_m"), "m", column(&|f| f.displacement_m));
        table.numbers(&name("acceleration_m_per_s2"), "m/s2", column(&|f| f.acceleration_m_per_s2));
        table.numbers(&name("probability_within_gap"), "", column(&|f| f.within.estimate()));
        let confidence = request.confidence;
        table.numbers(&name("wilson_low"), "", column(&|f| f.within.wilson(confidence)[0]));
        table.numbers(&name("wilson_high"), "", column(&|f| f.within.wilson(confidence)[1]));
    };
    figures("", points.iter().map(|point| point.figures).collect());
    if let Some(bounded) = bounded {
        let of = |pick: fn(&Bounded) -> Figures| {
            let find = |design: usize| bounded.iter().find(|b| b.design == design).map(pick);
            points.iter().filter_map(|point| find(point.design)).collect::<Vec<_>>()
        };
        figures("_lower_friction", of(|b| b.lower));
        figures("_upper_friction", of(|b| b.upper));
    }
    table
}
