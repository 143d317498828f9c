//! The stepwise iteration: how many turns it takes, and where it fails.

use crate::claims::Finding;
use crate::fill::{Values, values};
use crate::library::{Library, fixed};
use crate::{Grid, ITERATION, PaperError, piece};
use slipstick::error::SolveError;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::solver::stepwise_within;
use slipstick::study::engine::Engine;

/// `δ` of the paper in m/s².
const PAPER_TOLERANCE: f64 = 1e-5;

/// The longest step of an ordinary table record in s.
const USUAL_STEP_S: f64 = 0.01;

/// Iterations at one `δ` and step, over every mock-up and motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IterationCell {
    /// `δ` in m/s².
    pub tolerance_m_per_s2: f64,
    /// Step in s.
    pub dt_s: f64,
    /// Mean of the runs' mean iterations a step, over those that converged.
    pub mean: f64,
    /// Largest number in a step of a run that converged.
    pub max: u32,
    /// Runs.
    pub runs: usize,
    /// Runs given up because a step did not converge in 200 iterations.
    pub failures: usize,
    /// Mean iterations a step of the same mock-ups held by the table, where nothing slides.
    pub held_mean: f64,
    /// Largest number in a step of those.
    pub held_max: u32,
    /// Failures of those.
    pub held_failures: usize,
}

pub(crate) fn run(
    library: &Library,
    grid: Grid,
    engine: &Engine<'_>,
    findings: &mut Vec<Finding>,
) -> Result<Vec<IterationCell>, PaperError> {
    let steps_s: &[f64] = grid.pick(&[0.001, 0.002, 0.005, 0.01, 0.02], &[0.005, 0.01, 0.02]);
    let tolerances: &[f64] =
        grid.pick(&[1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10], &[1e-3, 1e-5, 1e-10]);
    let mut cells = Vec::new();
    for &dt_s in steps_s {
        let mut systems: Vec<(Model, GroundMotion)> = Vec::new();
        for experiment in library.experiments() {
            systems.push((experiment.model.clone(), experiment.motion_at(dt_s)?));
        }
        let done = cells.len();
        let count = steps_s.len() * tolerances.len();
        let more = engine.map(tolerances.len(), |i| {
            let cell = cell(&systems, tolerances[i], dt_s);
            engine.done(piece(ITERATION, done + i, count))?;
            Ok(cell)
        })?;
        cells.extend(more.into_iter().collect::<Result<Vec<_>, PaperError>>()?);
    }
    findings.extend(six(&cells, &coarse(library)?));
    findings.extend([small_tolerance(&cells), instability(&cells)]);
    Ok(cells)
}

fn cell(
    systems: &[(Model, GroundMotion)],
    tolerance_m_per_s2: f64,
    dt_s: f64,
) -> Result<IterationCell, PaperError> {
    let mut sliding = Tally::default();
    let mut held = Tally::default();
    for (model, motion) in systems {
        sliding.add(model, motion, tolerance_m_per_s2)?;
        if model.storeys() > 0 {
            held.add(&fixed(model)?, motion, tolerance_m_per_s2)?;
        }
    }
    Ok(IterationCell {
        tolerance_m_per_s2,
        dt_s,
        mean: sliding.mean(),
        max: sliding.max,
        runs: systems.len(),
        failures: sliding.failures,
        held_mean: held.mean(),
        held_max: held.max,
        held_failures: held.failures,
    })
}

/// The step, in whole 10 ms, at which the sines first take six iterations in the mean; records are
/// too coarse by then to be themselves.
fn coarse(library: &Library) -> Result<IterationCell, PaperError> {
    let mut dt_s = USUAL_STEP_S;
    loop {
        dt_s += 0.01;
        let mut systems = Vec::new();
        for experiment in library.experiments().iter().filter(|e| !e.is_record()) {
            systems.push((experiment.model.clone(), experiment.motion_at(dt_s)?));
        }
        let cell = cell(&systems, PAPER_TOLERANCE, dt_s)?;
        if cell.mean >= 6.0 || dt_s > 0.095 {
            return Ok(cell);
        }
    }
}

#[derive(Default)]
struct Tally {
    sum: f64,
    converged: usize,
    max: u32,
    failures: usize,
}

impl Tally {
    fn add(
        &mut self,
        model: &Model,
        motion: &GroundMotion,
        tolerance_m_per_s2: f64,
    ) -> Result<(), PaperError> {
        match stepwise_within(model, motion, tolerance_m_per_s2) {
            Ok(response) => {
                if let Some(iterations) = response.iterations {
                    self.sum += iterations.mean;
                    self.max = self.max.max(iterations.max);
                    self.converged += 1;
                }
            }
            Err(SolveError::NoConvergence { .. }) => self.failures += 1,
            Err(error) => return Err(error.into()),
        }
        Ok(())
    }

    fn mean(&self) -> f64 {
        self.sum / self.converged as f64
    }
}

fn of(cells: &[IterationCell], tolerance: f64) -> impl Iterator<Item = &IterationCell> {
    cells.iter().filter(move |cell| cell.tolerance_m_per_s2 == tolerance)
}

/// The smallest `δ`.
fn tightest(cells: &[IterationCell]) -> f64 {
    cells.iter().map(|c| c.tolerance_m_per_s2).fold(1.0, f64::min)
}

/// Six in the mean, and the other reading: six are enough for any step.
fn six(cells: &[IterationCell], coarse: &IterationCell) -> [Finding; 2] {
    let mean = |tolerance: f64| {
        let (sum, count) = of(cells, tolerance).fold((0.0, 0.0), |(s, n), c| (s + c.mean, n + 1.0));
        sum / count
    };
    let steps = |name: &str, value: fn(&IterationCell) -> f64| -> Vec<Values> {
        let step =
            |c: &IterationCell| values([(name, value(c).into()), ("ms", (1e3 * c.dt_s).into())]);
        of(cells, PAPER_TOLERANCE).map(step).collect()
    };
    let tightest = tightest(cells);
    let usual = of(cells, PAPER_TOLERANCE).filter(|c| c.dt_s <= USUAL_STEP_S);
    let largest = usual.map(|c| c.max).max().unwrap_or(0);
    [
        Finding::new("six-iterations", mean(PAPER_TOLERANCE))
            .quoting("steps", steps("mean", |c| c.mean))
            .quoting("tightest", format!("{tightest:.0e}"))
            .quoting("tightest_mean", mean(tightest))
            .quoting("coarse_ms", 1e3 * coarse.dt_s)
            .quoting("coarse_mean", coarse.mean)
            .quoting("failures", coarse.failures)
            .quoting("runs", coarse.runs),
        Finding::new("six-sufficient", f64::from(largest))
            .quoting("steps", steps("largest", |c| f64::from(c.max))),
    ]
}

/// δ = 1e-5 as "usually satisfied": runs that converge.
fn small_tolerance(cells: &[IterationCell]) -> Finding {
    let count = |tolerance: f64| {
        of(cells, tolerance).fold((0, 0), |(runs, fails), c| (runs + c.runs, fails + c.failures))
    };
    let (runs, failures) = count(PAPER_TOLERANCE);
    let tightest = tightest(cells);
    let (tightest_runs, tightest_failures) = count(tightest);
    Finding::new("usually-converges", 100.0 * (1.0 - failures as f64 / runs as f64))
        .quoting("failures", failures)
        .quoting("runs", runs)
        .quoting("tightest", format!("{tightest:.0e}"))
        .quoting("tightest_failures", tightest_failures)
        .quoting("tightest_runs", tightest_runs)
}

/// Without sliding the iteration is linear: what it needs beyond that comes from the sign.
fn instability(cells: &[IterationCell]) -> Finding {
    let held_failures: usize = cells.iter().map(|c| c.held_failures).sum();
    let largest =
        |of: fn(&IterationCell) -> u32| f64::from(cells.iter().map(of).max().unwrap_or(0));
    Finding::new("instability", held_failures as f64)
        .quoting("held_largest", largest(|c| c.held_max))
        .quoting("largest", largest(|c| c.max))
        .quoting("failures", cells.iter().map(|c| c.failures).sum::<usize>())
}
