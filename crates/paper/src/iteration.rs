//! The stepwise iteration: how many turns it takes, and where it fails.

use crate::library::{Library, fixed};
use crate::{Claim, Grid, ITERATION, PaperError, Verdict, piece};
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
) -> Result<(Vec<IterationCell>, Vec<Claim>), PaperError> {
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
    let coarse = coarse(library)?;
    let claims = vec![
        six(&cells, &coarse),
        sufficient(&cells),
        small_tolerance(&cells),
        instability(&cells),
    ];
    Ok((cells, claims))
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

fn six(cells: &[IterationCell], coarse: &IterationCell) -> Claim {
    let at_paper: Vec<&IterationCell> = of(cells, PAPER_TOLERANCE).collect();
    let mean = at_paper.iter().map(|c| c.mean).sum::<f64>() / at_paper.len() as f64;
    let by_step = at_paper
        .iter()
        .map(|c| format!("{:.2} at {} ms", c.mean, 1e3 * c.dt_s))
        .collect::<Vec<_>>()
        .join(", ");
    let tightest = cells.iter().map(|c| c.tolerance_m_per_s2).fold(1.0, f64::min);
    let (sum, count) = of(cells, tightest).fold((0.0, 0.0), |(s, n), c| (s + c.mean, n + 1.0));
    Claim::banded(
        (
            "six-iterations",
            "5",
            "About six iterations a step at δ = 1e-5 m/s² (read as: in the mean)",
        ),
        Some(6.0),
        (mean, ""),
        ([5.0, 7.0], "mean over all mock-ups, motions and steps from 5 to 7"),
        |verdict| {
            let cause = match verdict {
                Verdict::Agrees => String::new(),
                _ => format!(
                    "; {:+.2} iterations off. The paper does not state its step. At δ = {:.0e} \
                     m/s² the mean over the same steps is {:.2}; under the sines, at δ = 1e-5 m/s², it \
                     passes six at a step of {:.0} ms ({:.2}, with {} of {} runs given up)",
                    mean - 6.0,
                    tightest,
                    sum / count,
                    1e3 * coarse.dt_s,
                    coarse.mean,
                    coarse.failures,
                    coarse.runs,
                ),
            };
            format!("By step {by_step}{cause}.")
        },
    )
}

/// The other reading: six are enough for any step.
fn sufficient(cells: &[IterationCell]) -> Claim {
    let usual = || of(cells, PAPER_TOLERANCE).filter(|c| c.dt_s <= USUAL_STEP_S);
    let largest = usual().map(|c| c.max).max().unwrap_or(0);
    Claim::banded(
        (
            "six-sufficient",
            "5",
            "About six iterations a step at δ = 1e-5 m/s² (read as: enough for any step)",
        ),
        Some(6.0),
        (f64::from(largest), ""),
        (
            [5.0, 7.0],
            "largest number in a step, over the runs that converge at steps up to 10 ms, \
                      from 5 to 7",
        ),
        |_| {
            let text = of(cells, PAPER_TOLERANCE)
                .map(|c| format!("{} at {} ms", c.max, 1e3 * c.dt_s))
                .collect::<Vec<_>>()
                .join(", ");
            format!("Largest by step: {text}.")
        },
    )
}

/// δ = 1e-5 as "usually satisfied": runs that converge.
fn small_tolerance(cells: &[IterationCell]) -> Claim {
    let (runs, failures) = of(cells, PAPER_TOLERANCE)
        .fold((0, 0), |(runs, failures), c| (runs + c.runs, failures + c.failures));
    let share = 100.0 * (1.0 - failures as f64 / runs as f64);
    Claim::banded(
        ("usually-converges", "5", "The criterion δ = 1e-5 m/s² is usually satisfied"),
        None,
        (share, "%"),
        ([50.0, 100.0], "more than half of the runs converge in every step"),
        |_| {
            let smallest = cells.iter().map(|c| c.tolerance_m_per_s2).fold(1.0, f64::min);
            let (r, f) = of(cells, smallest).fold((0, 0), |(r, f), c| (r + c.runs, f + c.failures));
            format!(
                "{failures} of {runs} runs were given up after 200 iterations in one step; with δ = \
                 {smallest:.0e} m/s² {f} of {r}."
            )
        },
    )
}

/// Without sliding the iteration is linear: what it needs beyond that comes from the sign.
fn instability(cells: &[IterationCell]) -> Claim {
    let held_failures: usize = cells.iter().map(|c| c.held_failures).sum();
    let failures: usize = cells.iter().map(|c| c.failures).sum();
    let held_max = cells.iter().map(|c| c.held_max).max().unwrap_or(0);
    let largest = cells.iter().map(|c| c.max).max().unwrap_or(0);
    Claim::banded(
        (
            "instability",
            "5",
            "The iteration becomes unstable only where the sign of the sliding velocity flips \
             between two iterations",
        ),
        Some(0.0),
        (held_failures as f64, ""),
        ([0.0, 0.0], "no run of a mock-up held by the table, where no sign can flip, fails"),
        |_| {
            format!(
                "Held by the table no step takes more than {held_max} iterations and {held_failures} \
                 runs fail; sliding, one step takes {largest} and {failures} runs fail over all δ \
                 and steps."
            )
        },
    )
}
