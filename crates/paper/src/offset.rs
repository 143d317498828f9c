//! Where an offset of the sliding displacement comes from.

use crate::claims::Finding;
use crate::curves::{crossing, linspace, range};
use crate::fill;
use crate::library::{Experiment, Library, Shake, with_asymmetry, with_tilt};
use crate::{Grid, PaperError};
use slipstick::model::Model;
use slipstick::motion::{GroundMotion, Sine};
use slipstick::response::Demands;
use slipstick::solver;
use slipstick::study::Random;

/// Steps of the stepwise program in s.
const STEPS_S: [f64; 5] = [0.001, 0.002, 0.005, 0.01, 0.02];

/// The coarsest step that a data acquisition for such tests would have, in s.
const COARSE_S: f64 = 0.01;

/// Parts of the residual sliding displacement of one test, all in mm.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetRow {
    /// What was tested.
    pub name: String,
    /// Stiffness of the spring in kN/m, 0 without.
    pub spring_kn_per_m: f64,
    /// Residual of the level, symmetric mock-up: what the start and the motion leave.
    pub residual_mm: f64,
    /// Peak sliding displacement of the same.
    pub peak_mm: f64,
    /// Tilt in mrad, and what it adds to the residual.
    pub tilt: Vec<[f64; 2]>,
    /// Asymmetry in %, and what it adds.
    pub asymmetry: Vec<[f64; 2]>,
    /// Standard deviation of white noise on the table record in m/s², and that of the residual.
    pub noise: Vec<[f64; 2]>,
    /// Constant error of the table record in m/s², and what it adds.
    pub baseline: Vec<[f64; 2]>,
    /// Growth a cycle under 1 mrad, late in the motion; `None` for a record.
    pub growth_mm_per_cycle: Option<f64>,
}

/// Residual by both solvers on the same samples, in mm.
#[derive(Clone, Debug, PartialEq)]
pub struct StepDrift {
    /// What was tested.
    pub name: String,
    /// Stiffness of the spring in kN/m, 0 without.
    pub spring_kn_per_m: f64,
    /// Peak sliding displacement at the finest step.
    pub peak_mm: f64,
    /// Step in s, exact residual, stepwise residual (`None` where the iteration fails).
    pub steps: Vec<(f64, f64, Option<f64>)>,
}

/// Mid-line of the last cycle of the 124 kg block without a spring, in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartPhase {
    /// Phase at which the sine starts in degrees.
    pub phase_deg: f64,
    /// Cycles over which its amplitude rises.
    pub ramp_cycles: f64,
    /// Mid-line of the last cycle.
    pub midline_mm: f64,
    /// Half of its peak-to-peak.
    pub half_range_mm: f64,
}

/// The tests that offsets and sensitivities are studied on; the first six come in threes with
/// the same table motion: no spring, the weak one, the strong one.
pub(crate) fn studied(library: &Library) -> Result<Vec<Experiment>, PaperError> {
    let mut all = Vec::new();
    let sine = library.experiment("section3-124kg-free-sine")?;
    for spring in ["free", "spring19", "spring143"] {
        let other = library.experiment(&format!("section3-124kg-{spring}-sine"))?;
        let name = other.name.replace("a 3.5 Hz sine", "a 1.5 Hz sine");
        all.push(Experiment { name, ..sine.with_model(other.model.clone()) });
    }
    for spring in ["free", "spring19", "spring143"] {
        all.push(library.experiment(&format!("section3-124kg-{spring}-taft"))?.clone());
    }
    for id in [
        "section6-45kg-1_625hz-sine",
        "section6-201kg-1_125hz-sine",
        "section6-201kg-2_65hz-sine",
        "section6-201kg-1_125hz-taft",
    ] {
        all.push(library.drawn(id)?);
    }
    Ok(all)
}

/// Stiffness of an experiment's spring in kN/m.
pub(crate) fn spring_kn_per_m(experiment: &Experiment) -> f64 {
    1e-3 * experiment.model.slider_stiffness_n_per_m()
}

/// The table record of a test with white noise and a constant error, in m/s².
pub(crate) fn disturbed(
    experiment: &Experiment,
    noise: f64,
    baseline: f64,
    seed: u64,
) -> Result<GroundMotion, PaperError> {
    let mut random = Random::new(seed);
    let motion = match &experiment.shake {
        Shake::Sine(sine) => sine.motion()?,
        Shake::Record(motion) => motion.clone(),
    };
    let values = motion.horizontal_m_per_s2().iter();
    let values = values.map(|a| a + baseline + noise * random.normal()).collect();
    let disturbed = GroundMotion::new(motion.times_s().to_vec(), values, None)?;
    Ok(disturbed.with_tail(experiment.tail_s)?)
}

type Results = (Vec<OffsetRow>, Vec<StepDrift>, Vec<StartPhase>);

pub(crate) fn run(
    library: &Library,
    grid: Grid,
    findings: &mut Vec<Finding>,
) -> Result<Results, PaperError> {
    let seeds = grid.pick(20, 5);
    let mut rows = Vec::new();
    let mut step_drifts = Vec::new();
    for experiment in studied(library)? {
        rows.push(row(&experiment, seeds)?);
        step_drifts.push(drift(&experiment)?);
    }
    let (start_phases, start) = start_phases(library)?;
    findings.extend([start, tolerance(&rows), integration(&step_drifts)]);
    findings.extend([spring(&rows), reproduced(&rows)]);
    Ok((rows, step_drifts, start_phases))
}

fn row(experiment: &Experiment, seeds: u64) -> Result<OffsetRow, PaperError> {
    let motion = experiment.motion()?;
    let demands =
        |model: &Model| Ok::<Demands, PaperError>(solver::exact_demands(model, &motion)?.demands);
    let level = demands(&experiment.model)?;
    let residual_mm = 1e3 * level.residual_sliding_displacement_m;
    let added = |d: &Demands| 1e3 * d.residual_sliding_displacement_m - residual_mm;
    let mut tilt = Vec::new();
    for mrad in [0.1, 0.2, 0.5, 1.0, 2.0] {
        tilt.push([mrad, added(&demands(&with_tilt(&experiment.model, 1e-3 * mrad)?)?)]);
    }
    let mut asymmetry = Vec::new();
    for percent in [1.0, 2.0, 5.0, 10.0] {
        let model = with_asymmetry(&experiment.model, 0.01 * percent)?;
        asymmetry.push([percent, added(&demands(&model)?)]);
    }
    let mut noise = Vec::new();
    for level in [0.005, 0.02, 0.05] {
        let mut squares = 0.0;
        for seed in 1..=seeds {
            let motion = disturbed(experiment, level, 0.0, seed)?;
            let change = added(&solver::exact_demands(&experiment.model, &motion)?.demands);
            squares += change * change;
        }
        noise.push([level, (squares / seeds as f64).sqrt()]);
    }
    let mut baseline = Vec::new();
    for level in [0.001, 0.003, 0.01] {
        let motion = disturbed(experiment, 0.0, level, 0)?;
        let demands = solver::exact_demands(&experiment.model, &motion)?.demands;
        baseline.push([level, added(&demands)]);
    }
    Ok(OffsetRow {
        name: experiment.name.clone(),
        spring_kn_per_m: spring_kn_per_m(experiment),
        residual_mm,
        peak_mm: 1e3 * level.peak_sliding_displacement_m,
        tilt,
        asymmetry,
        noise,
        baseline,
        growth_mm_per_cycle: growth(experiment)?,
    })
}

/// Growth a cycle under 1 mrad over the second half of a sine, by its mid-lines.
fn growth(experiment: &Experiment) -> Result<Option<f64>, PaperError> {
    let Shake::Sine(sine) = &experiment.shake else { return Ok(None) };
    let model = with_tilt(&experiment.model, 1e-3)?;
    let level = Experiment { tail_s: 0.0, ..experiment.with_model(model) };
    let cycles = libm::floor(sine.duration_s * sine.frequency_hz);
    let middle = libm::floor(0.5 * cycles);
    let early = midline(&level, middle - 1.0)?[0];
    let late = midline(&level, cycles - 1.0)?[0];
    Ok(Some((late - early) / (cycles - middle)))
}

/// Mid-line and half range of the sliding displacement in a cycle of a sine, counted from 0, in mm.
fn midline(experiment: &Experiment, cycle: f64) -> Result<[f64; 2], PaperError> {
    let sine = experiment.sine()?;
    let from_s = cycle / sine.frequency_hz;
    let to_s = (cycle + 1.0) / sine.frequency_hz;
    let response = solver::exact(&experiment.model, &experiment.motion()?)?;
    let history = response.history.unwrap_or_default();
    let inside = history.time_s.iter().zip(&history.sliding_displacement_m);
    let inside = inside.filter(|(t, _)| (from_s..=to_s).contains(*t)).map(|(_, s)| 1e3 * s);
    let [low, high] = range(inside);
    Ok([0.5 * (low + high), 0.5 * (high - low)])
}

fn drift(experiment: &Experiment) -> Result<StepDrift, PaperError> {
    let mut steps = Vec::new();
    let mut peak_mm = 0.0;
    for dt_s in STEPS_S {
        let motion = experiment.motion_at(dt_s)?;
        let exact = solver::exact_demands(&experiment.model, &motion)?.demands;
        let stepwise = solver::stepwise(&experiment.model, &motion).ok();
        if dt_s == STEPS_S[0] {
            peak_mm = 1e3 * exact.peak_sliding_displacement_m;
        }
        let mm = |d: &Demands| 1e3 * d.residual_sliding_displacement_m;
        steps.push((dt_s, mm(&exact), stepwise.map(|r| mm(&r.demands))));
    }
    let name = experiment.name.clone();
    Ok(StepDrift { name, spring_kn_per_m: spring_kn_per_m(experiment), peak_mm, steps })
}

/// The offset that the start of a sine leaves, on the 124 kg block without a spring.
fn start_phases(library: &Library) -> Result<(Vec<StartPhase>, Finding), PaperError> {
    let test = library.experiment("section3-124kg-free-sine")?;
    let sine = test.sine()?;
    let cycles = sine.duration_s * sine.frequency_hz;
    let at = |phase_deg: f64, ramp_cycles: f64| -> Result<StartPhase, PaperError> {
        let phase_rad = phase_deg.to_radians();
        let ramp_s = ramp_cycles / sine.frequency_hz;
        let shake = Shake::Sine(Sine { phase_rad, ramp_s, ..sine });
        let started = Experiment { shake, tail_s: 0.0, ..test.clone() };
        let [midline_mm, half_range_mm] = midline(&started, cycles - 1.0)?;
        Ok(StartPhase { phase_deg, ramp_cycles, midline_mm, half_range_mm })
    };
    let mut all = Vec::new();
    for phase_deg in linspace(0.0, 180.0, 37) {
        all.push(at(phase_deg, 0.0)?);
    }
    for ramp_cycles in [1.0, 2.0, 5.0, 10.0] {
        all.push(at(0.0, ramp_cycles)?);
    }
    let from_zero = all[0];
    let level = crossing([0.0, 180.0], |phase| Ok::<_, PaperError>(at(phase, 0.0)?.midline_mm))?;
    let ramped = at(0.0, 5.0)?;
    let finding = Finding::new("fig5-no-offset", from_zero.midline_mm)
        .within(0.1 * from_zero.half_range_mm)
        .quoting("half_range", from_zero.half_range_mm)
        .quoting("phase", level.unwrap_or(f64::NAN))
        .quoting("ramped", ramped.midline_mm);
    Ok((all, finding))
}

fn at(pairs: &[[f64; 2]], level: f64) -> f64 {
    pairs.iter().find(|p| p[0] == level).map_or(f64::NAN, |p| p[1])
}

fn tolerance(rows: &[OffsetRow]) -> Finding {
    let free = || rows.iter().filter(|r| r.spring_kn_per_m == 0.0);
    let share = |r: &OffsetRow| 100.0 * (at(&r.tilt, 1.0) / r.peak_mm).abs();
    let shares = range(free().map(share));
    Finding::new("offset-tolerances", shares[0])
        .quoting("shares", shares)
        .quoting("tilt", range(free().map(|r| at(&r.tilt, 1.0))))
        .quoting("asymmetry", range(free().map(|r| at(&r.asymmetry, 5.0))))
}

/// Largest |stepwise − exact| over the peak at steps up to a limit, in %, and in mm.
fn added_by_steps(drift: &StepDrift, limit_s: f64) -> [f64; 2] {
    let differences = drift.steps.iter().filter(|(dt_s, ..)| *dt_s <= limit_s);
    let largest = differences
        .filter_map(|(_, exact, stepwise)| stepwise.map(|s| (s - exact).abs()))
        .fold(0.0, f64::max);
    [100.0 * largest / drift.peak_mm, largest]
}

fn integration(drifts: &[StepDrift]) -> Finding {
    let free: Vec<&StepDrift> = drifts.iter().filter(|d| d.spring_kn_per_m == 0.0).collect();
    let largest = |limit_s: f64| {
        free.iter()
            .map(|d| (added_by_steps(d, limit_s), d.name.as_str()))
            .reduce(|a, b| if b.0[0] > a.0[0] { b } else { a })
            .unwrap_or(([f64::NAN; 2], ""))
    };
    let ([percent, mm], name) = largest(COARSE_S);
    let ([fine_percent, fine_mm], fine_name) = largest(0.002);
    Finding::new("offset-integration", percent)
        .quoting("mm", mm)
        .quoting("name", name)
        .quoting("fine_mm", fine_mm)
        .quoting("fine_percent", fine_percent)
        .quoting("fine_name", fine_name)
}

fn spring(rows: &[OffsetRow]) -> Finding {
    // Threes with the same table: no spring, weak, strong.
    let mut ratios = Vec::new();
    for three in rows[..6].chunks(3) {
        let of = |r: &OffsetRow| [at(&r.tilt, 1.0), at(&r.asymmetry, 5.0), at(&r.noise, 0.02)];
        let (free, strong) = (of(&three[0]), of(&three[2]));
        ratios.extend((0..3).map(|i| (strong[i] / free[i]).abs()));
    }
    let ratios = range(ratios);
    let tests =
        ["sine_free", "sine_weak", "sine_strong", "taft_free", "taft_weak", "taft_strong"].iter();
    let finding = Finding::new("offset-spring", ratios[1]).quoting("ratios", ratios);
    tests.zip(rows).fold(finding, |finding, (name, row)| finding.quoting(name, at(&row.tilt, 1.0)))
}

fn reproduced(rows: &[OffsetRow]) -> Finding {
    let sines = rows[6..9].iter().map(|r| {
        fill::values([
            ("name", r.name[..].into()),
            ("level", r.residual_mm.into()),
            ("tilted", [at(&r.tilt, 0.1), at(&r.tilt, 2.0)].into()),
        ])
    });
    Finding::unchecked("offset-reproduced").quoting("tests", sines.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn free_block() -> Library {
        let text = include_str!("../../../examples/paper/section3-124kg-free-sine.toml");
        Library::read(&[("section3-124kg-free-sine", text)], &[]).unwrap()
    }

    /// The block slides without stopping: half of its peak-to-peak is
    /// `(A/ω²) √(1 − (π η/2)²)` with `η = μ_k g/A`, and a small tilt θ moves it by
    /// `−π² (A/ω²) (θ/μ_k) √(1 − (π η/2)²)` every cycle.
    #[test]
    fn range_and_growth_of_a_block_that_never_stops() {
        let library = free_block();
        let test = library.experiment("section3-124kg-free-sine").unwrap();
        let sine = test.sine().unwrap();
        let rate = core::f64::consts::TAU * sine.frequency_hz;
        let mu_k = test.model.kinetic_friction()[0];
        let eta = mu_k * test.model.gravity_m_per_s2() / sine.amplitude_m_per_s2;
        let half_pi = core::f64::consts::FRAC_PI_2;
        let root = (1.0 - (half_pi * eta) * (half_pi * eta)).sqrt();
        let half_mm = 1e3 * sine.amplitude_m_per_s2 / (rate * rate) * root;
        let found = midline(&Experiment { tail_s: 0.0, ..test.clone() }, 14.0).unwrap()[1];
        // 133 samples a cycle: a sine of straight lines is weaker by 2e-4.
        assert!((found / half_mm - 1.0).abs() < 1e-3, "{found} {half_mm}");
        let drift_mm = -4.0 * half_pi * half_pi * half_mm * (1e-3 / mu_k);
        let found = growth(test).unwrap().unwrap();
        assert!((found / drift_mm - 1.0).abs() < 5e-3, "{found} {drift_mm}");
    }

    /// A constant error of the table record is a tilt, but for cos θ and the start.
    #[test]
    fn constant_error_is_a_tilt() {
        let library = free_block();
        let test = library.experiment("section3-124kg-free-sine").unwrap();
        let gravity = test.model.gravity_m_per_s2();
        let error = disturbed(test, 0.0, 1e-3 * gravity, 0).unwrap();
        let residual = |model: &Model, motion: &GroundMotion| {
            let demands = solver::exact_demands(model, motion).unwrap().demands;
            1e3 * demands.residual_sliding_displacement_m
        };
        let level = residual(&test.model, &test.motion().unwrap());
        let by_error = residual(&test.model, &error) - level;
        let tilted = with_tilt(&test.model, 1e-3).unwrap();
        let by_tilt = residual(&tilted, &test.motion().unwrap()) - level;
        assert!((by_error / by_tilt - 1.0).abs() < 0.01, "{by_error} {by_tilt}");
    }
}
