//! Incremental dynamic analysis: demands over rising intensity, record by record.
//!
//! Terms and the hunt-and-fill search follow D. Vamvatsikos and C. A. Cornell (*Earthquake Engineering
//! and Structural Dynamics* 31, 2002; *Earthquake Spectra* 20, 2004). Demands need not grow with
//! intensity: a curve may cross the limit, come back below it (they call it resurrection) and cross
//! again. The capacity of a record is its **first** crossing; what comes back is told, not used.

use super::fragility::{Capacity, Fragility};
use super::models::Models;
use super::spectrum::status;
use super::suite::Suite;
use super::{AssessmentError, FailedRun, refuse};
use crate::error::{FitError, RunError, Stopped};
use crate::motion::intensity::Measure;
use crate::numerics::fractile;
use crate::response::demand_values;
use crate::study::engine::{Engine, Running, Shaking};
use crate::table::Table;

/// Runs that a hunt on one record is thought to take, for those who wait.
const RUNS_OF_A_HUNT: u64 = 30;

/// Demands of one record at rising intensities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Intensities, rising, > 0.
    pub levels: Vec<f64>,
    /// The demand at each; not finite where the run failed, which counts as above any limit.
    pub demands: Vec<f64>,
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
    /// A level beyond the crossing at which the demand is below the limit again.
    pub returns: Option<f64>,
}

impl Curve {
    /// Adds a point in its place; a level that is there already is replaced.
    pub fn insert(&mut self, level: f64, demand: f64) {
        let at = self.levels.partition_point(|known| *known < level);
        if self.levels.get(at) == Some(&level) {
            self.demands[at] = demand;
        } else {
            self.levels.insert(at, level);
            self.demands.insert(at, demand);
        }
    }

    fn reaches(&self, index: usize, limit: f64) -> bool {
        // What failed is NaN, and reaches.
        !(self.demands[index] < limit)
    }

    /// The first crossing of a limit > 0 on the curve's points joined by straight lines from the
    /// origin; where a run failed, the crossing is put at its level.
    #[must_use]
    pub fn first_crossing(&self, limit: f64) -> Crossing {
        let n = self.levels.len();
        let Some(at) = (0..n).find(|&i| self.reaches(i, limit)) else {
            let last = self.levels.last().copied().unwrap_or(0.0);
            let between = [last, f64::INFINITY];
            return Crossing { level: last, reached: false, between, returns: None };
        };
        let (low, below) =
            if at == 0 { (0.0, 0.0) } else { (self.levels[at - 1], self.demands[at - 1]) };
        let (high, above) = (self.levels[at], self.demands[at]);
        let level = if above.is_finite() && above > below {
            low + (high - low) * ((limit - below) / (above - below)).clamp(0.0, 1.0)
        } else {
            high
        };
        let returns = (at..n).find(|&i| !self.reaches(i, limit)).map(|i| self.levels[i]);
        Crossing { level, reached: true, between: [low, high], returns }
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

    /// Runs one record: `demand` gives its demand at a level, NaN where the run fails.
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

/// Fractiles of 16, 50 and 84 % of the demand at one level, over the records' demands there.
#[must_use]
pub fn demand_fractiles(demands: &[f64]) -> [f64; 3] {
    fractile::fractiles(demands)
}

/// Fractiles of 16, 50 and 84 % of the intensity at which the records first reach a limit; a record
/// that does not reach it counts as above all, so a fractile may be infinite.
#[must_use]
pub fn level_fractiles(curves: &[Curve], limit: f64) -> [f64; 3] {
    let of = |curve: &Curve| {
        let crossing = curve.first_crossing(limit);
        if crossing.reached { crossing.level } else { f64::INFINITY }
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
    /// The model: a grid of one.
    pub models: &'a Models,
    /// The records.
    pub suite: &'a Suite,
    /// The measure.
    pub measure: Measure,
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on it, SI; a hunt needs one.
    pub limit: Option<f64>,
    /// The levels.
    pub levels: IdaLevels,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct IdaRun {
    /// The records' curves of the demand.
    pub curves: Vec<Curve>,
    /// A lognormal fit of the capacities, where there is a limit.
    pub fit: Option<Result<Fragility, FitError>>,
    /// Runs without an answer.
    pub failures: Vec<FailedRun>,
    /// A row a run: record, level, scale, all demands.
    pub rows: Table,
    /// A row a record, where there is a limit.
    pub capacities: Option<Table>,
}

/// A run of a record: its level and factor, demands or the reason why there are none.
struct Run {
    level: f64,
    scale: f64,
    demands: Result<Vec<f64>, RunError>,
}

/// Runs an incremental dynamic analysis.
///
/// # Errors
/// [`AssessmentError`] for a demand that is none, levels that do not rise, a hunt without a limit,
/// records that cannot be scaled, and where it is stopped. A run that fails counts as above any limit.
pub fn run_ida(request: &IdaRequest<'_>, engine: &Engine<'_>) -> Result<IdaRun, AssessmentError> {
    let IdaRequest { models, suite, measure, .. } = request;
    let column = models.column(request.demand)?;
    let hunt = match &request.levels {
        IdaLevels::Fixed(levels) => {
            let rise = levels.windows(2).all(|pair| pair[0] < pair[1]);
            if levels.is_empty() || !rise || !(levels[0] > 0.0) {
                return Err(refuse("levels", "levels > 0 that rise", format!("{levels:?}")));
            }
            None
        }
        IdaLevels::Hunt { start, top } => {
            let Some(limit) = request.limit else {
                return Err(refuse("to", "the limit to hunt for, or slider.gap", "nothing"));
            };
            Some(Hunt::new(limit, *start, *top)?)
        }
    };
    let unscaled = suite.measure(measure, engine)?;
    let parts = models.parts(&[])?;
    let one = |running: &mut Running<'_>, record: usize, level: f64| -> Run {
        let scale = level / unscaled[record];
        let motion = suite.motion_of(record, scale, &parts);
        let demands = motion.and_then(|motion| {
            let response = running.on(&Shaking::new(&motion))?;
            Ok(demand_values(&response.demands))
        });
        Run { level, scale, demands }
    };
    let records = suite.records.len();
    let all: Vec<Vec<Run>> = match (&request.levels, &hunt) {
        (IdaLevels::Fixed(levels), _) => {
            let n = levels.len();
            let mut runs = engine
                .runs(records * n, |i| one(&mut Running::new(&parts.model), i / n, levels[i % n]))?
                .into_iter();
            (0..records).map(|_| runs.by_ref().take(n).collect()).collect()
        }
        (_, Some(hunt)) => {
            engine.plan(records as u64 * RUNS_OF_A_HUNT);
            engine.map(records, |record| {
                let mut runs: Vec<Run> = Vec::new();
                let mut running = Running::new(&parts.model);
                hunt.try_run(|level| {
                    let run = one(&mut running, record, level);
                    let demand = run.demands.as_ref().map_or(f64::NAN, |values| values[column]);
                    runs.push(run);
                    engine.done(1)?;
                    Ok::<_, Stopped>(demand.abs())
                })?;
                engine.replan(RUNS_OF_A_HUNT, runs.len() as u64);
                runs.sort_by(|a, b| a.level.total_cmp(&b.level));
                Ok(runs)
            })?
        }
        (IdaLevels::Hunt { .. }, None) => Vec::new(),
    };
    let curves: Vec<Curve> = all
        .iter()
        .map(|runs| {
            let demand = |run: &Run| run.demands.as_ref().map_or(f64::NAN, |v| v[column].abs());
            Curve {
                levels: runs.iter().map(|run| run.level).collect(),
                demands: runs.iter().map(demand).collect(),
            }
        })
        .collect();
    let names = suite.names();
    let failures = all
        .iter()
        .zip(&names)
        .flat_map(|(runs, name)| {
            let failed = |run: &Run| {
                let error = run.demands.as_ref().err()?.clone();
                Some(FailedRun { record: name.clone(), error })
            };
            runs.iter().filter_map(failed).collect::<Vec<_>>()
        })
        .collect();
    let (fit, capacities) = match request.limit {
        None => (None, None),
        Some(limit) => {
            let (fit, table) = capacities(&curves, limit, &names, measure);
            (Some(fit), Some(table))
        }
    };
    let flat: Vec<(&String, &Run)> = all
        .iter()
        .zip(&names)
        .flat_map(|(runs, name)| runs.iter().map(move |run| (name, run)))
        .collect();
    let mut rows = Table::default();
    rows.texts("record", flat.iter().map(|(name, _)| (*name).clone()).collect());
    rows.texts("measure", vec![measure.to_string(); flat.len()]);
    rows.texts("measure_unit", vec![measure.unit().to_owned(); flat.len()]);
    let choice = if hunt.is_some() { "hunted" } else { "given" };
    rows.texts("level_choice", vec![choice.to_owned(); flat.len()]);
    rows.numbers("level", measure.unit(), flat.iter().map(|(_, run)| run.level).collect());
    rows.numbers("scale", "", flat.iter().map(|(_, run)| run.scale).collect());
    for (i, column) in models.columns().iter().enumerate() {
        let of = |(_, run): &(&String, &Run)| run.demands.as_ref().map_or(f64::NAN, |v| v[i]);
        rows.numbers(&column.name(), column.unit(), flat.iter().map(of).collect());
    }
    rows.texts("status", flat.iter().map(|(_, run)| status(&run.demands)).collect());
    Ok(IdaRun { curves, fit, failures, rows, capacities })
}

/// The lognormal fit of the first crossings, and their table.
fn capacities(
    curves: &[Curve],
    limit: f64,
    names: &[String],
    measure: &Measure,
) -> (Result<Fragility, FitError>, Table) {
    let crossings: Vec<_> = curves.iter().map(|curve| curve.first_crossing(limit)).collect();
    let of = |c: &Crossing| Capacity { level: c.level, reached: c.reached };
    let fit = Fragility::of_capacities(&crossings.iter().map(of).collect::<Vec<_>>());
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
    (fit, table)
}
