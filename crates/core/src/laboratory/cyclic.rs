//! Friction, spring and viscous part from cyclic tests: displacement and force over time.
//!
//! While the block slides, the force that a test needs is
//!
//! ```text
//! F = f⁺ (towards +x) or −f⁻ (towards −x)  +  K x  +  C ẋ
//! ```
//!
//! with friction forces `f = μ_k N`. Each cycle (one stroke each way) is fitted by least squares over
//! the samples that slide; estimates are means over cycles with Student's interval, so that they
//! need no assumption on the noise within a cycle, only that cycles are independent. An offset of a
//! sensor adds to `f⁺` what it takes from `f⁻`: friction by direction is told only where the zero is
//! known, and a zero that moves from cycle to cycle is a drift, which is looked for. The static
//! friction is read where a stroke breaks away: the force rises while the block is stuck, then drops.
//! Breakaway falls between two samples; the curve of the last samples before it is carried on to
//! the middle between the two.
//!
//! Kinetic friction that follows the speed ([`KineticLaw::SlowFastRate`]) is read in classes of speed
//! within each cycle, and a curve is laid through those of all cycles. Tests under several normal forces
//! ([`BearingLoads`]) tell how friction follows the pressure.

mod curve;
mod pressure;
mod stroke;

use super::estimate::{Estimate, mean_interval, mean_interval_with_common};
use crate::notice::{Notice, NoticeKind};
use crate::numerics::algebra::linear_fit;
use crate::numerics::distribution::student_quantile;
use crate::numerics::fractile::upper_median;
use curve::{ClassFriction, CurveCycle, CurveFit, Follows};
pub use curve::{CurvePoint, RateFit};
use pressure::pressure_law;
pub use pressure::{BearingLoads, PressureFit, PressurePoint};
use stroke::{Breakaway, Stroke, strokes};

/// Fewest cycles that give an interval.
pub const LEAST_CYCLES: usize = 3;
/// Sliding samples are those faster than this part of the stroke's peak speed.
const SLOWEST: f64 = 0.2;
/// A drop at breakaway counts where it is this many times the noise of the force, and twice the
/// rise of the force between two samples.
const CLEAR_DROP: f64 = 4.0;

/// The part of the cycles of one frequency that must show a breakaway.
const MOST_SHOW: f64 = 0.7;

/// Friction counts where its mean is this many of its standard errors.
const CLEAR_WIDTH: f64 = 6.0;

/// Classes of speed in a cycle whose speed varies, at most.
const CLASSES: usize = 6;
/// The speed of a stroke varies where its standard deviation is this part of its mean.
const VARIES: f64 = 0.1;

/// How kinetic friction follows the sliding speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KineticLaw {
    /// Not at all.
    #[default]
    Coulomb,
    /// `μ = fast − (fast − slow) e^(−rate |v|)`.
    SlowFastRate,
}

impl KineticLaw {
    /// Every law, by its name.
    pub const ALL: [Self; 2] = [Self::Coulomb, Self::SlowFastRate];

    /// Its name in options.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Coulomb => "coulomb",
            Self::SlowFastRate => "slow-fast-rate",
        }
    }
}

/// What a cyclic test measured.
#[derive(Clone, Copy, Debug)]
pub struct CyclicTest<'a> {
    /// Times in s, increasing.
    pub times_s: &'a [f64],
    /// Displacement of the block relative to what it slides on, in m.
    pub displacement_m: &'a [f64],
    /// Force that moves it, positive along the displacement, in N.
    pub force_n: &'a [f64],
    /// Travel after each reversal that is left out, in m: backlash and elastic deformation. `None`:
    /// found from the force.
    pub slack_m: Option<f64>,
    /// Whether a spring is fitted beside friction.
    pub spring: bool,
    /// Whether a damper is; never beside friction that follows the speed, from which it cannot be told.
    pub damper: bool,
    /// How kinetic friction follows the speed.
    pub law: KineticLaw,
    /// Whether the zeros of force and displacement are known: without them friction by direction
    /// cannot be told from an offset.
    pub zero_known: bool,
}

/// One cycle: a stroke towards +x and one towards −x.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    /// From its first reversal to its last, in s.
    pub span_s: [f64; 2],
    /// One over the time from its first turn to its last, in Hz.
    pub frequency_hz: f64,
    /// Mean of both strokes in m.
    pub stroke_m: f64,
    /// Largest speed in m/s.
    pub peak_velocity_m_per_s: f64,
    /// Kinetic friction towards +x and −x in N, the mean over speeds.
    pub kinetic_n: [f64; 2],
    /// The same by speed, from slow to fast; one entry where friction does not follow the speed, or where
    /// the speed hardly varies.
    pub by_speed: Vec<AtSpeed>,
    /// Static friction towards +x and −x in N, where a breakaway shows.
    pub static_n: [Option<f64>; 2],
    /// `K` in N/m, where it was fitted.
    pub spring_n_per_m: Option<f64>,
    /// `C` in N s/m, where it was fitted; it is not where the speed hardly changes.
    pub damper_n_s_per_m: Option<f64>,
    /// Root mean square of what the fit leaves of the force, in N.
    pub residual_n: f64,
}

impl Cycle {
    /// Kinetic friction in N, the mean of both ways.
    #[must_use]
    pub fn mean_kinetic_n(&self) -> f64 {
        0.5 * (self.kinetic_n[0] + self.kinetic_n[1])
    }
}

/// A figure of a cycle: one description for tables of columns, JSON and what people read.
#[derive(Clone, Copy, Debug)]
pub struct CycleColumn {
    /// Its column in tables and its key in JSON.
    pub key: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// Its value; `None` where the cycle does not tell it.
    pub value: fn(&Cycle) -> Option<f64>,
    /// What people read of it.
    pub shown: CycleCell,
}

/// What people read of a figure of a cycle.
#[derive(Clone, Copy, Debug)]
pub enum CycleCell {
    /// Nothing.
    None,
    /// The figure times a factor, under a head that states its unit, to some significant digits.
    Number {
        /// The head.
        head: &'static str,
        /// What one in SI is.
        factor: f64,
        /// Significant digits.
        digits: usize,
    },
    /// Friction one way, a coefficient where the normal force is known; of both ways where they cannot be told apart.
    Friction {
        /// Which.
        head: &'static str,
        /// Whether towards +x, which the figure of the other way follows.
        is_positive: bool,
    },
}

impl Cycle {
    /// Its figures, in their order; kinetic friction by speed is not among them.
    pub const COLUMNS: [CycleColumn; 12] = [
        CycleColumn::new("from_s", "s", |c| Some(c.span_s[0])),
        CycleColumn::new("to_s", "s", |c| Some(c.span_s[1])),
        CycleColumn::new("frequency_hz", "Hz", |c| Some(c.frequency_hz)).number("f (Hz)", 1.0, 4),
        CycleColumn::new("stroke_m", "m", |c| Some(c.stroke_m)).number("stroke (mm)", 1e3, 4),
        CycleColumn::new("peak_velocity_m_per_s", "m/s", |c| Some(c.peak_velocity_m_per_s)),
        CycleColumn::new("kinetic_positive_n", "N", |c| Some(c.kinetic_n[0]))
            .friction("kinetic", true),
        CycleColumn::new("kinetic_negative_n", "N", |c| Some(c.kinetic_n[1]))
            .friction("kinetic", false),
        CycleColumn::new("static_positive_n", "N", |c| c.static_n[0]).friction("static", true),
        CycleColumn::new("static_negative_n", "N", |c| c.static_n[1]).friction("static", false),
        CycleColumn::new("spring_n_per_m", "N/m", |c| c.spring_n_per_m).number(
            "spring (N/m)",
            1.0,
            4,
        ),
        CycleColumn::new("damper_n_s_per_m", "N s/m", |c| c.damper_n_s_per_m).number(
            "damper (N s/m)",
            1.0,
            4,
        ),
        CycleColumn::new("residual_n", "N", |c| Some(c.residual_n)).number("rms left (N)", 1.0, 3),
    ];
}

impl CycleColumn {
    const fn new(key: &'static str, unit: &'static str, value: fn(&Cycle) -> Option<f64>) -> Self {
        Self { key, unit, value, shown: CycleCell::None }
    }

    const fn number(self, head: &'static str, factor: f64, digits: usize) -> Self {
        Self { shown: CycleCell::Number { head, factor, digits }, ..self }
    }

    const fn friction(self, head: &'static str, is_positive: bool) -> Self {
        Self { shown: CycleCell::Friction { head, is_positive }, ..self }
    }
}

/// Kinetic friction of a cycle in one class of speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtSpeed {
    /// Mean speed in m/s.
    pub speed_m_per_s: f64,
    /// Standard deviation of the speeds in m/s.
    pub spread_m_per_s: f64,
    /// Friction towards +x and −x in N.
    pub kinetic_n: [f64; 2],
}

/// What one test says.
#[derive(Clone, Debug, PartialEq)]
pub struct CyclicFit {
    /// Its complete cycles.
    pub cycles: Vec<Cycle>,
    /// Travel after each reversal that was left out, in m.
    pub slack_m: f64,
    /// Strokes left out because they are shorter than half the usual one, or incomplete.
    pub strokes_left_out: usize,
    /// The fitted force at every sample that was used, NaN at the others.
    pub fitted_n: Vec<f64>,
    /// Whether a damper was to be fitted.
    pub damper_sought: bool,
    /// How kinetic friction was taken to follow the speed.
    pub law: KineticLaw,
    /// Its cycles by frequency, one after the other.
    pub runs: Vec<Run>,
    /// Whether the zeros of the sensors are known.
    pub zero_known: bool,
    /// How the middle of the force loop drifts, where it does.
    pub drift: Option<Drift>,
}

/// Consecutive cycles of one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Which cycles.
    pub cycles: core::ops::Range<usize>,
    /// How far a value of the static friction may be off for want of samples, in N (standard
    /// deviation).
    pub sampling_n: f64,
    /// How far its cycles share that error, from 0 to 1: all of it where samples fall on the same part of
    /// every cycle; the second how far the mean of both ways does.
    pub shared: [f64; 2],
}

/// A drift of the middle of the force loop, `(f⁺ − f⁻)/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Its rate in N/s.
    pub n_per_s: f64,
    /// Ends of its 95 % interval in N/s.
    pub interval_n_per_s: [f64; 2],
    /// What it makes from the first sample to the last, in N.
    pub over_test_n: f64,
}

impl CyclicFit {
    /// What a reader must know of it.
    #[must_use]
    pub fn warnings(&self) -> Vec<Notice> {
        self.drift_warning().into_iter().chain(self.unit_warning()).collect()
    }

    /// Strokes that no test rig has.
    fn unit_warning(&self) -> Option<Notice> {
        let stroke_m = self.cycles.iter().fold(0.0, |most: f64, cycle| most.max(cycle.stroke_m));
        (stroke_m > LONGEST_STROKE_M).then(|| {
            let message = format!(
                "the strokes are {stroke_m:.1} m long: if the displacement is in mm, say so with the mapping \
                 \"displacement=… [mm]\""
            );
            Notice::new(NoticeKind::UnitSuspect, message)
        })
    }

    fn drift_warning(&self) -> Option<Notice> {
        let Drift { n_per_s, interval_n_per_s: [low, high], over_test_n } = self.drift?;
        let message = format!(
            "the middle of the force loop drifts by {over_test_n:.3} N over the test ({:.3} N/min, 95 % \
             from {:.3} to {:.3}): the zero of the force cell moves, and friction by direction cannot \
             be determined",
            60.0 * n_per_s,
            60.0 * low,
            60.0 * high
        );
        Some(Notice::new(NoticeKind::ForceDrift, message))
    }
}

/// Why a cyclic test says nothing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CyclicError {
    /// Too few samples, or lists of different lengths.
    #[error("expected at least 32 samples of displacement and force, found {found}")]
    TooShort {
        /// Number found.
        found: usize,
    },
    /// A displacement that is noise.
    #[error(
        "no sliding in the record: the displacement moves by {range_m:.3e} m, which is not clear of \
         its noise of {noise_m:.1e} m"
    )]
    NoSliding {
        /// From its least to its largest value, in m.
        range_m: f64,
        /// Standard deviation of its noise, in m.
        noise_m: f64,
    },
    /// A force that pushes where it should brake.
    #[error(
        "friction comes out negative, {friction_n:.4} N in the mean: the force points the other way; \
         say so with the mapping \"force=… * -1\""
    )]
    Reversed {
        /// Mean kinetic friction in N.
        friction_n: f64,
    },
    /// Too few strokes.
    #[error("too few cycles: {found}, at least {LEAST_CYCLES} complete ones are needed")]
    TooFewCycles {
        /// Complete cycles.
        found: usize,
    },
}

/// Fits one test. A drift of the force that shows is taken off, and the test is fitted again.
///
/// # Errors
/// [`CyclicError`] where nothing slides or there are too few cycles.
pub fn cyclic(test: &CyclicTest) -> Result<CyclicFit, CyclicError> {
    let n = test.times_s.len();
    if n < 32 || test.displacement_m.len() != n || test.force_n.len() != n {
        return Err(CyclicError::TooShort { found: n });
    }
    let fit = of_steady_zero(test)?;
    let Some(drift) = fit.drift else { return Ok(fit) };
    let middle_s = 0.5 * (test.times_s[0] + test.times_s[n - 1]);
    let drifted: Vec<f64> = test.times_s.iter().map(|t| drift.n_per_s * (t - middle_s)).collect();
    let force_n: Vec<f64> = test.force_n.iter().zip(&drifted).map(|(f, d)| f - d).collect();
    let mut steady = of_steady_zero(&CyclicTest { force_n: &force_n, ..*test })?;
    steady.fitted_n.iter_mut().zip(&drifted).for_each(|(fitted, d)| *fitted += d);
    Ok(CyclicFit { drift: Some(drift), ..steady })
}

/// The fit of a test whose force cell keeps its zero.
fn of_steady_zero(test: &CyclicTest) -> Result<CyclicFit, CyclicError> {
    let n = test.times_s.len();
    let (strokes, strokes_left_out) = strokes(test)?;
    let pairs: Vec<[&Stroke; 2]> = strokes
        .windows(2)
        .step_by(2)
        .filter(|pair| pair[0].last == pair[1].first)
        .map(|pair| [&pair[0], &pair[1]])
        .collect();
    if pairs.len() < LEAST_CYCLES {
        return Err(CyclicError::TooFewCycles { found: pairs.len() });
    }
    // Where sliding begins in each stroke depends on the fit, and the fit on where it begins.
    let mut slack_m = test.slack_m.unwrap_or(0.0);
    let mut fits: Vec<Option<Cycle>> = Vec::new();
    let mut starts: Vec<[usize; 2]> =
        pairs.iter().map(|pair| pair.map(|stroke| stroke.after(test, slack_m))).collect();
    let mut fitted_n = vec![f64::NAN; n];
    let noise_n = stroke::noise(test.force_n);
    let mut breakaways: Vec<[Option<Breakaway>; 2]> = vec![[None, None]; pairs.len()];
    for turn in 0..3 {
        fitted_n.fill(f64::NAN);
        let fit_one = |(pair, start): (&[&Stroke; 2], &[usize; 2])| {
            fit_cycle(test, *pair, *start, &mut fitted_n)
        };
        fits = pairs.iter().zip(&starts).map(fit_one).collect();
        if turn == 2 {
            break;
        }
        let built: Vec<f64> = pairs
            .iter()
            .zip(&fits)
            .map(|(pair, fit)| pair.map(|stroke| stroke.build_up_m(test, fit.as_ref()?)))
            .filter_map(|[a, b]| Some(a?.max(b?)))
            .collect();
        if test.slack_m.is_none() {
            slack_m = built.into_iter().fold(0.0, f64::max);
        }
        for (i, (pair, fit)) in pairs.iter().zip(&fits).enumerate() {
            let Some(fit) = fit else { continue };
            for side in 0..2 {
                // Stuck samples that slipped in spoil the fit, so its residuals cannot judge here.
                let breakaway = pair[side].breakaway(test, fit, slack_m);
                let clear = breakaway.filter(|b| b.is_clear(noise_n));
                let after = pair[side].after(test, slack_m);
                starts[i][side] =
                    clear.map_or(after, |b| after.max(b.sample + pair[side].smoothing + 2));
                breakaways[i][side] = clear;
            }
        }
    }
    let mut sampling: Vec<(usize, f64)> = Vec::new();
    let mut cycles: Vec<Cycle> = Vec::new();
    for ((fit, sides), pair) in fits.into_iter().zip(&breakaways).zip(&pairs) {
        let Some(mut cycle) = fit else { continue };
        for side in 0..2 {
            // Read again with the final spring and damper.
            let Some(_) = sides[side] else { continue };
            let read = pair[side].breakaway(test, &cycle, slack_m);
            if let Some(b) = read.filter(|b| b.is_clear(cycle.residual_n)) {
                cycle.static_n[usize::from(pair[side].sign < 0.0)] = Some(b.force_n);
                sampling.push((cycles.len(), b.sampling_n));
            }
        }
        cycles.push(cycle);
    }
    if cycles.len() < LEAST_CYCLES {
        return Err(CyclicError::TooFewCycles { found: cycles.len() });
    }
    let friction_n =
        cycles.iter().flat_map(|cycle| cycle.kinetic_n).sum::<f64>() / (2 * cycles.len()) as f64;
    let left_n = cycles.iter().fold(0.0, |most: f64, cycle| most.max(cycle.residual_n));
    if friction_n < -left_n {
        return Err(CyclicError::Reversed { friction_n });
    }
    let duration_s = test.times_s[n - 1] - test.times_s[0];
    let (runs, drift) = (runs(test, &cycles, &sampling), drift(&cycles, duration_s));
    Ok(CyclicFit {
        cycles,
        slack_m,
        strokes_left_out,
        fitted_n,
        damper_sought: test.damper && test.law == KineticLaw::Coulomb,
        law: test.law,
        runs,
        zero_known: test.zero_known,
        drift,
    })
}

/// Consecutive cycles whose frequencies are within a tenth of the first of them.
fn runs(test: &CyclicTest, cycles: &[Cycle], sampling: &[(usize, f64)]) -> Vec<Run> {
    let mut starts: Vec<usize> = Vec::new();
    for (i, cycle) in cycles.iter().enumerate() {
        let same = starts
            .last()
            .and_then(|start| cycles.get(*start))
            .is_some_and(|first| (cycle.frequency_hz / first.frequency_hz - 1.0).abs() < 0.1);
        if !same {
            starts.push(i);
        }
    }
    let ends = starts.iter().skip(1).copied().chain([cycles.len()]);
    let run = |(start, end): (&usize, usize)| {
        let here = sampling.iter().filter(|(cycle, _)| (*start..end).contains(cycle));
        let sampling_n = upper_median(here.map(|(_, n)| *n)).unwrap_or(0.0);
        let shared = shared(test, &cycles[*start..end], sampling_n);
        Run { cycles: *start..end, sampling_n, shared }
    };
    starts.iter().zip(ends).map(run).collect()
}

/// What a breakaway is read with, over the noise of the force: a parabola of 14 samples goes on for half
/// a step to two steps.
const READING: f64 = 2.0;

/// The mean correlation of the sampling errors of any two cycles of a run, and of the means of both ways.
///
/// Where in a step a breakaway falls moves by the part `d` of a step from cycle to cycle. The error is
/// uniform over the step, so that of cycles `k` apart correlates by `1 − 6x(1 − x)`, `x = kd mod 1`; where
/// the static friction itself scatters by the part `j` of what the force rises in a step, by `e^(−4π²j²)`
/// of that (its first harmonic). Where the samples move by more than a step through the run the error
/// averages out. From `d` two standard errors are taken off, which the noise of the displacement at the
/// turns makes.
fn shared(test: &CyclicTest, cycles: &[Cycle], sampling_n: f64) -> [f64; 2] {
    let n = test.times_s.len();
    let dt_s = (test.times_s[n - 1] - test.times_s[0]) / (n - 1) as f64;
    let count = cycles.len() as f64;
    let steps = cycles.iter().map(|cycle| 1.0 / cycle.frequency_hz).sum::<f64>() / count / dt_s;
    let speed = cycles.iter().map(|cycle| cycle.peak_velocity_m_per_s).fold(0.0, f64::max);
    // Turns are where 5 % of the stroke are passed: on a sine at 0.44 of the peak speed.
    let turn_steps = stroke::noise(test.displacement_m) / (0.44 * speed * dt_s);
    let off = ((steps - libm::round(steps)).abs() - 2.0 * turn_steps / count).max(0.0);
    if cycles.len() < 2 || !(off * (count - 1.0) < 1.0) {
        return [0.0; 2];
    }
    let correlation = |shift: f64| {
        let x = shift - libm::floor(shift);
        1.0 - 6.0 * x * (1.0 - x)
    };
    let pairs = (1..cycles.len()).map(|k| (count - k as f64) * correlation(k as f64 * off));
    let one = (2.0 * pairs.sum::<f64>() / (count * (count - 1.0))).max(0.0);
    let variance = |way: usize| {
        let values: Vec<f64> = cycles.iter().filter_map(|cycle| cycle.static_n[way]).collect();
        let (n, mean) = (values.len() as f64, values.iter().sum::<f64>() / values.len() as f64);
        values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0).max(1.0)
    };
    let reading_n = READING * stroke::noise(test.force_n);
    let scatter = 0.5 * (variance(0) + variance(1)) - reading_n * reading_n;
    let step_n = 12.0_f64.sqrt() * sampling_n;
    let jitter = scatter.max(0.0) / (step_n * step_n);
    // Without a rise, or without breakaways, nothing is shared.
    let part = libm::exp(-4.0 * core::f64::consts::PI * core::f64::consts::PI * jitter);
    let one = if part.is_finite() { one * part } else { 0.0 };
    [one, one * 0.5 * (1.0 + correlation(0.5 * steps))]
}

/// Strokes of test rigs are shorter than this, in m.
const LONGEST_STROKE_M: f64 = 5.0;

/// How sure a drift must be: one of a hundred tests whose cell holds its zero shows one nevertheless.
const SURE_OF_DRIFT: f64 = 0.99;
/// Least part of the friction that a drift makes over a test.
const LEAST_DRIFT: f64 = 0.005;

/// The slope of the middle of the force loop over time, where it is clear of the cycles' scatter.
fn drift(cycles: &[Cycle], duration_s: f64) -> Option<Drift> {
    let middle = |cycle: &Cycle| 0.5 * (cycle.kinetic_n[0] - cycle.kinetic_n[1]);
    let time_s = |cycle: &Cycle| 0.5 * (cycle.span_s[0] + cycle.span_s[1]);
    let start_s = cycles.first().map(time_s)?;
    let rows: Vec<([f64; 2], f64)> =
        cycles.iter().map(|cycle| ([1.0, time_s(cycle) - start_s], middle(cycle))).collect();
    if rows.len() < LEAST_CYCLES + 1 {
        return None;
    }
    let fit = linear_fit(&rows)?;
    let freedom = rows.len() as f64 - 2.0;
    let error = (fit.sse / freedom * fit.covariance[1][1]).sqrt();
    let n_per_s = fit.coefficients[1];
    let over_test_n = n_per_s * duration_s;
    let mean_n = cycles.iter().map(Cycle::mean_kinetic_n).sum::<f64>() / cycles.len() as f64;
    let half = |confidence: f64| student_quantile(confidence, freedom) * error;
    let clear =
        n_per_s.abs() > half(SURE_OF_DRIFT) && over_test_n.abs() > LEAST_DRIFT * mean_n.abs();
    let half = half(0.95);
    let interval_n_per_s = [n_per_s - half, n_per_s + half];
    clear.then_some(Drift { n_per_s, interval_n_per_s, over_test_n })
}

/// Fits the sliding samples of two strokes; `None` where they do not determine the unknowns.
fn fit_cycle(
    test: &CyclicTest,
    pair: [&Stroke; 2],
    starts: [usize; 2],
    fitted_n: &mut [f64],
) -> Option<Cycle> {
    let used: Vec<(&Stroke, Vec<usize>)> = pair
        .into_iter()
        .zip(starts)
        .map(|(stroke, start)| (stroke, stroke.sliding(start, SLOWEST).collect()))
        .collect();
    let speeds = || used.iter().flat_map(|(s, at)| at.iter().map(|i| s.velocity(*i).abs()));
    let count = speeds().count();
    let mean = speeds().sum::<f64>() / count.max(1) as f64;
    let spread = speeds().map(|v| (v - mean) * (v - mean)).sum::<f64>() / count as f64;
    // At one speed a viscous force is a friction force.
    let varies = spread.sqrt() > VARIES * mean;
    let by_speed = test.law == KineticLaw::SlowFastRate;
    let damper = test.damper && varies && !by_speed;
    let classes = if by_speed && varies { CLASSES.min(count / 32).max(1) } else { 1 };
    let of_class = used.iter().map(|(stroke, at)| stroke.classes(at, classes));
    let of_class: Vec<Vec<usize>> = of_class.collect();
    let mut members = vec![Vec::new(); classes];
    for ((stroke, at), of_class) in used.iter().zip(&of_class) {
        for (i, class) in at.iter().zip(of_class) {
            members[*class].push(stroke.velocity(*i).abs());
        }
    }
    let mean_and_spread = |speeds: &Vec<f64>| {
        let n = speeds.len() as f64;
        let mean = speeds.iter().sum::<f64>() / n;
        (mean, (speeds.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt())
    };
    let members: Vec<(f64, f64)> = members.iter().map(mean_and_spread).collect();
    // Both ways of each class; within it friction follows a line about its mean.
    let lines = if classes > 1 { classes } else { 0 };
    let mut rows: Vec<(Vec<f64>, f64)> = Vec::with_capacity(count);
    for ((stroke, at), of_class) in used.iter().zip(&of_class) {
        let up = f64::from(u8::from(stroke.sign > 0.0));
        for (i, class) in at.iter().zip(of_class) {
            let velocity = stroke.velocity(*i);
            let mut x = vec![0.0; 2 * classes + lines];
            [x[2 * class], x[2 * class + 1]] = [up, up - 1.0];
            if lines > 0 {
                x[2 * classes + class] = stroke.sign * (velocity.abs() - members[*class].0);
            }
            x.extend(test.spring.then_some(test.displacement_m[*i]));
            x.extend(damper.then_some(velocity));
            rows.push((x, test.force_n[*i]));
        }
    }
    let fit = linear_fit(&rows)?;
    let unknowns = fit.coefficients.len();
    if rows.len() < 4 * unknowns {
        return None;
    }
    let (friction, others) = fit.coefficients.split_at(2 * classes);
    let by_speed: Vec<AtSpeed> = friction
        .chunks_exact(2)
        .zip(&members)
        .map(|(both, (speed_m_per_s, spread_m_per_s))| AtSpeed {
            speed_m_per_s: *speed_m_per_s,
            spread_m_per_s: *spread_m_per_s,
            kinetic_n: [both[0], both[1]],
        })
        .collect();
    let kinetic_n =
        [0, 1].map(|way| by_speed.iter().map(|at| at.kinetic_n[way]).sum::<f64>() / classes as f64);
    let mut others = others[lines..].iter().copied();
    let spring_n_per_m = if test.spring { others.next() } else { None };
    let damper_n_s_per_m = if damper { others.next() } else { None };
    for (i, (x, _)) in used.iter().flat_map(|(_, at)| at).zip(&rows) {
        fitted_n[*i] = fit.coefficients.iter().zip(x).map(|(c, x)| c * x).sum();
    }
    let [first, second] = pair;
    let span_s = [test.times_s[first.first], test.times_s[second.last]];
    let [from_s, to_s] = [(first, first.first), (second, second.last)]
        .map(|(stroke, sample)| stroke::turning_s(test, sample, stroke.length_m(test)));
    Some(Cycle {
        span_s,
        frequency_hz: 1.0 / (to_s - from_s),
        stroke_m: 0.5 * (first.length_m(test) + second.length_m(test)),
        peak_velocity_m_per_s: first.peak_velocity().max(second.peak_velocity()),
        kinetic_n,
        by_speed,
        static_n: [None, None],
        spring_n_per_m,
        damper_n_s_per_m,
        residual_n: (fit.sse / (rows.len() - unknowns) as f64).sqrt(),
    })
}

/// What several tests say together.
#[derive(Clone, Debug, PartialEq)]
pub struct CyclicEstimates {
    /// Kinetic friction (both ways together, towards +x, towards −x; or slow, fast and rate), static
    /// friction, the exponent of the pressure where it was sought, then spring and damper where they were fitted.
    /// Friction is a coefficient where the normal force is known, else a force in N.
    pub estimates: Vec<Estimate>,
    /// How the kinetic friction (mean of both ways) changes with frequency, per Hz; `None` for tests
    /// at one frequency, and where friction was taken to follow the speed.
    pub per_hz: Option<Estimate>,
    /// Kinetic friction over speed, where it was taken to follow it.
    pub rate: Option<RateFit>,
    /// Friction over pressure, where it was taken to follow it.
    pub pressure: Option<PressureFit>,
}

/// What some tests say together of the law that was fitted to them: means over all cycles, and a curve
/// through all cycles where kinetic friction follows the speed.
///
/// `normal_force_n` turns forces into coefficients. Refused are: friction that is not clear of 0
/// (less than 2 % of the largest force or six standard errors), which means that nothing slid;
/// static friction where fewer than three strokes show a breakaway. Friction by direction is left out
/// where the zeros of the sensors are not known ([`zero_not_stated`]), and refused where one drifts.
/// Slow and fast friction and the rate are those of both ways together; [`RateFit`] says when they are
/// refused.
#[must_use]
pub fn estimates(
    fits: &[&CyclicFit],
    largest_force_n: f64,
    normal_force_n: Option<f64>,
) -> CyclicEstimates {
    let tests = TestLoads::even(fits, largest_force_n, normal_force_n);
    estimates_of(law_of(fits), &tests, None)
}

/// The same as means over all cycles, whatever law was fitted.
#[must_use]
pub fn means(
    fits: &[&CyclicFit],
    largest_force_n: f64,
    normal_force_n: Option<f64>,
) -> CyclicEstimates {
    let tests = TestLoads::even(fits, largest_force_n, normal_force_n);
    estimates_of(KineticLaw::Coulomb, &tests, None)
}

/// What tests of a bearing under normal forces of their own say together: coefficients at the reference pressure, with
/// the exponent by which all of them follow the pressure.
///
/// The exponent and the kinetic friction are fitted together to all cycles ([`PressureFit`] says when the exponent is
/// refused); static friction and friction by direction are the means of what that exponent makes of each cycle at the
/// reference pressure, and their intervals include that of the exponent. Where it is refused for normal forces that are
/// all alike, coefficients are those at that pressure; else they are refused too. `largest_forces_n` are those of each
/// test, as in [`estimates`].
#[must_use]
pub fn estimates_at_loads(
    fits: &[&CyclicFit],
    largest_forces_n: &[f64],
    loads: &BearingLoads<'_>,
) -> CyclicEstimates {
    let (pressures_pa, reference_pa) = (loads.pressures_pa(), loads.coefficients_at_pa());
    let of_tests = fits.iter().zip(largest_forces_n).zip(loads.normal_n).zip(pressures_pa);
    let tests = of_tests.map(|(((fit, largest_force_n), normal_n), pressure_pa)| {
        let is_apart = loads.are_apart();
        let ln_pressure = if is_apart { libm::log(pressure_pa / reference_pa) } else { 0.0 };
        TestLoad { fit, largest_force_n: *largest_force_n, normal_n: *normal_n, ln_pressure }
    });
    let tests = TestLoads { tests: tests.collect(), is_coefficient: true };
    estimates_of(law_of(fits), &tests, Some(loads))
}

fn law_of(fits: &[&CyclicFit]) -> KineticLaw {
    let by_speed = fits.iter().any(|fit| fit.law == KineticLaw::SlowFastRate);
    if by_speed { KineticLaw::SlowFastRate } else { KineticLaw::Coulomb }
}

/// A test and what presses the block in it.
struct TestLoad<'a> {
    fit: &'a CyclicFit,
    /// The largest force of the test in N, or of all that are at one normal force.
    largest_force_n: f64,
    /// Normal force in N; 1 where it is not known, and friction a force.
    normal_n: f64,
    /// `ln(p/p_ref)`; 0 where friction is not taken to follow the pressure.
    ln_pressure: f64,
}

/// Tests under their normal forces.
struct TestLoads<'a> {
    tests: Vec<TestLoad<'a>>,
    /// Whether the normal force is known.
    is_coefficient: bool,
}

impl<'a> TestLoads<'a> {
    /// All under one normal force.
    fn even(fits: &[&'a CyclicFit], largest_force_n: f64, normal_force_n: Option<f64>) -> Self {
        let normal_n = normal_force_n.unwrap_or(1.0);
        let test =
            |fit: &&'a CyclicFit| TestLoad { fit, largest_force_n, normal_n, ln_pressure: 0.0 };
        Self { tests: fits.iter().map(test).collect(), is_coefficient: normal_force_n.is_some() }
    }

    fn cycles(&self) -> impl Iterator<Item = (&TestLoad<'a>, &'a Cycle)> {
        self.tests.iter().flat_map(|test| test.fit.cycles.iter().map(move |cycle| (test, cycle)))
    }

    /// Kinetic friction of every cycle, by class of speeds or as one mean.
    fn for_curve(&self, law: KineticLaw) -> Vec<CurveCycle> {
        let of_cycle = |(test, cycle): (&TestLoad<'_>, &Cycle)| {
            let class = |at: &AtSpeed| ClassFriction {
                speed_m_per_s: at.speed_m_per_s,
                spread_m_per_s: at.spread_m_per_s,
                friction: 0.5 * (at.kinetic_n[0] + at.kinetic_n[1]) / test.normal_n,
            };
            let mean = || ClassFriction {
                speed_m_per_s: 0.0,
                spread_m_per_s: 0.0,
                friction: cycle.mean_kinetic_n() / test.normal_n,
            };
            let classes = match law {
                KineticLaw::SlowFastRate => cycle.by_speed.iter().map(class).collect(),
                KineticLaw::Coulomb => vec![mean()],
            };
            CurveCycle { classes, ln_pressure: test.ln_pressure }
        };
        self.cycles().map(of_cycle).collect()
    }

    /// Why friction does not show, if it does not.
    fn not_sliding(&self, law: KineticLaw, at_loads: bool) -> Option<String> {
        if at_loads {
            // What scatters between loads is the law.
            return self.tests.iter().find_map(|test| {
                let widths: Vec<f64> = test.fit.cycles.iter().map(Cycle::mean_kinetic_n).collect();
                not_sliding(&widths, test.largest_force_n, law)
            });
        }
        let widths: Vec<f64> = self.cycles().map(|(_, cycle)| cycle.mean_kinetic_n()).collect();
        not_sliding(&widths, self.tests.first()?.largest_force_n, law)
    }
}

/// The exponent of the pressure, 0 where friction does not follow it, and half its 95 % interval.
#[derive(Clone, Copy)]
struct Exponent {
    value: f64,
    half: f64,
}

impl Exponent {
    const NONE: Self = Self { value: 0.0, half: 0.0 };

    /// What turns a force of a test into friction at the reference pressure.
    fn over_n(self, test: &TestLoad<'_>) -> f64 {
        test.normal_n * libm::exp(-self.value * test.ln_pressure)
    }

    /// An interval of a mean of values at the reference pressure, each with its `ln(p/p_ref)`, to which that of the exponent
    /// is added: the values follow it by their share of `ln(p/p_ref)`.
    fn widened(self, values: &[[f64; 2]], mean: f64, ends: [f64; 2]) -> [f64; 2] {
        if self.half == 0.0 {
            return ends;
        }
        let moved: f64 = values.iter().map(|[value, ln_pressure]| value * ln_pressure).sum();
        let by_exponent = self.half * moved / values.len() as f64;
        ends.map(|end| mean + libm::hypot(end - mean, by_exponent).copysign(end - mean))
    }
}

fn estimates_of(
    law: KineticLaw,
    loaded: &TestLoads<'_>,
    loads: Option<&BearingLoads<'_>>,
) -> CyclicEstimates {
    let fits: Vec<&CyclicFit> = loaded.tests.iter().map(|test| test.fit).collect();
    let why_not = loaded.not_sliding(law, loads.is_some());
    let by_speed = law == KineticLaw::SlowFastRate;
    let for_curve = if by_speed || loads.is_some() { loaded.for_curve(law) } else { Vec::new() };
    let (pressure, mut curve) = loads
        .map(|loads| pressure_law(&for_curve, by_speed, loads, why_not.as_deref()))
        .map_or((None, None), |(pressure, curve)| (Some(pressure), curve));
    let exponent = curve.as_ref().and_then(|curve| curve.exponent);
    let exponent = exponent.map_or(Exponent::NONE, |(value, interval)| {
        let [low, high] = interval.ends;
        Exponent { value, half: 0.5 * (high - low) }
    });
    let lacks_exponent = curve.is_none() && loads.is_some_and(BearingLoads::are_apart);
    let why_not = why_not.or_else(|| lacks_exponent.then(|| NO_EXPONENT.to_owned()));
    let friction =
        FrictionEstimates { loaded, exponent, why_not, lacks_exponent, by_way: by_way(&fits) };
    let rate = by_speed.then(|| {
        let fitted = match (&friction.why_not, curve.take()) {
            (Some(why), _) => Err(why.clone()),
            (None, Some(curve)) => Ok(curve),
            (None, None) => CurveFit::new(&for_curve, Follows { speed: true, pressure: false }),
        };
        RateFit::new(fitted.as_ref().map_err(String::as_str), loaded.is_coefficient)
    });
    let mut estimates = Vec::new();
    estimates.extend(rate.iter().flat_map(|rate| rate.estimates.clone()));
    let fitted = curve.and_then(|curve| curve.friction.into_iter().next()?.ok());
    let ways = if fits.iter().all(|fit| fit.zero_known) { 0..3 } else { 0..1 };
    if rate.is_none() {
        estimates.extend(ways.clone().map(|way| friction.kinetic(way, fitted)));
    }
    estimates.extend(ways.map(|way| friction.at_rest(way)));
    estimates.extend(pressure.iter().map(|pressure| pressure.exponent.clone()));
    estimates.extend(restoring(loaded, loads));
    estimates.extend(damper(loaded));
    let told = rate.is_none() && !lacks_exponent;
    let per_hz = if told { friction.per_hz() } else { None };
    CyclicEstimates { estimates, per_hz, rate, pressure }
}

/// Why coefficients are not told where the exponent of the pressure is not.
const NO_EXPONENT: &str = "the exponent of the pressure is not determined, and with it what holds at the reference pressure";

/// What estimates of static and kinetic friction have in common; `way` is 0 for both ways together, 1 towards +x,
/// 2 towards −x.
struct FrictionEstimates<'a> {
    loaded: &'a TestLoads<'a>,
    exponent: Exponent,
    /// Why kinetic friction is not told, if so.
    why_not: Option<String>,
    /// Whether that is for want of the exponent.
    lacks_exponent: bool,
    /// Why friction by direction is not told, if so.
    by_way: Result<(), &'static str>,
}

impl FrictionEstimates<'_> {
    fn unit(&self) -> &'static str {
        if self.loaded.is_coefficient { "" } else { "N" }
    }

    fn path(&self, what: &str, way: usize) -> String {
        let force = if self.loaded.is_coefficient { "" } else { "_force" };
        let way = ["", ".positive", ".negative"][way];
        format!("slider.{what}_friction{force}{way}")
    }

    /// Kinetic friction: the mean over cycles, or what was fitted together with the exponent.
    fn kinetic(&self, way: usize, fitted: Option<(f64, [f64; 2])>) -> Estimate {
        let (path, unit) = (self.path("kinetic", way), self.unit());
        if let Some(why) = &self.why_not {
            return Estimate::refused(path, unit, why.as_str());
        }
        let at_reference = |(test, cycle): (&TestLoad<'_>, &Cycle)| {
            let force_n = if way == 0 { cycle.mean_kinetic_n() } else { cycle.kinetic_n[way - 1] };
            [force_n / self.exponent.over_n(test), test.ln_pressure]
        };
        let values: Vec<[f64; 2]> = self.loaded.cycles().map(at_reference).collect();
        let plain: Vec<f64> = values.iter().map(|[value, _]| *value).collect();
        match (fitted, mean_interval(&plain, 0.0), self.by_way) {
            (_, _, Err(why)) if way > 0 => Estimate::refused(path, unit, why),
            (Some((value, ends)), ..) if way == 0 => Estimate::determined(path, unit, value, ends),
            (_, Some((value, ends)), _) => {
                let ends = self.exponent.widened(&values, value, ends);
                Estimate::determined(path, unit, value, ends)
            }
            _ => Estimate::refused(path, unit, ""),
        }
    }

    /// Static friction.
    fn at_rest(&self, way: usize) -> Estimate {
        let (path, unit) = (self.path("static", way), self.unit());
        let (values, interval) = static_friction(&self.loaded.tests, way, self.exponent);
        let cycles = self.loaded.cycles().count();
        let is_told = self.why_not.is_none() && values >= LEAST_CYCLES;
        match (interval, self.by_way, &self.why_not) {
            (_, _, Some(why)) if self.lacks_exponent => Estimate::refused(path, unit, why.as_str()),
            (Some(_), Err(why), _) if way > 0 && is_told => Estimate::refused(path, unit, why),
            (Some((value, ends)), ..) if is_told => Estimate::determined(path, unit, value, ends),
            _ => {
                let why = format!(
                    "only {values} of {cycles} cycles show a breakaway that is clear of noise and sampling: sample \
                     faster, or with a rig that is less stiff"
                );
                Estimate::refused(path, unit, why)
            }
        }
    }

    /// The slope of the kinetic friction over frequency.
    fn per_hz(&self) -> Option<Estimate> {
        let of_cycle = |(test, cycle): (&TestLoad<'_>, &Cycle)| {
            (cycle.frequency_hz, cycle.mean_kinetic_n() / self.exponent.over_n(test))
        };
        per_hz(&self.loaded.cycles().map(of_cycle).collect::<Vec<_>>(), self.unit())
    }
}

/// The damper, where one was sought.
fn damper(loaded: &TestLoads<'_>) -> Option<Estimate> {
    let (path, unit) = ("slider.damper", "N s/m");
    let dampers = loaded.cycles().filter_map(|(_, cycle)| cycle.damper_n_s_per_m);
    let dampers: Vec<f64> = dampers.collect();
    match mean_interval(&dampers, 0.0) {
        Some((value, ends)) if dampers.len() >= LEAST_CYCLES => {
            Some(Estimate::determined(path, unit, value, ends))
        }
        _ if loaded.tests.iter().any(|test| test.fit.damper_sought) => {
            let why =
                "the speed hardly changes within a stroke: a viscous force looks like friction";
            Some(Estimate::refused(path, unit, why))
        }
        _ => None,
    }
}

/// The spring that was fitted beside friction. Under normal forces that differ a pendulum has several, and one radius,
/// `N/K`: that is told where it scatters less over the cycles than the spring.
fn restoring(loaded: &TestLoads<'_>, loads: Option<&BearingLoads<'_>>) -> Option<Estimate> {
    let springs = loaded.cycles().filter_map(|(_, cycle)| cycle.spring_n_per_m);
    let spring = mean_interval(&springs.collect::<Vec<f64>>(), 0.0)?;
    let scatter = |(mean, [_, high]): (f64, [f64; 2])| ((high - mean) / mean).abs();
    let radii =
        loaded.cycles().filter_map(|(test, cycle)| Some(test.normal_n / cycle.spring_n_per_m?));
    let radius = loads
        .filter(|loads| loads.are_apart())
        .and_then(|_| mean_interval(&radii.collect::<Vec<f64>>(), 0.0))
        .filter(|radius| scatter(*radius) < scatter(spring));
    Some(match radius {
        Some((value, ends)) => Estimate::determined("slider.radius", "m", value, ends),
        None => Estimate::determined("slider.spring", "N/m", spring.0, spring.1),
    })
}

/// How many cycles tell the static friction of both ways (`way` 0) or one, and their mean at the reference pressure
/// with its interval.
fn static_friction(
    tests: &[TestLoad<'_>],
    way: usize,
    exponent: Exponent,
) -> (usize, Option<(f64, [f64; 2])>) {
    let value = |cycle: &Cycle, over_n: f64| match way {
        0 => Some(0.5 * (cycle.static_n[0]? + cycle.static_n[1]?) / over_n),
        _ => Some(cycle.static_n[way - 1]? / over_n),
    };
    let mut values: Vec<[f64; 2]> = Vec::new();
    let (mut floor, mut common, mut locked) = (0.0, 0.0, 0);
    for (test, run) in
        tests.iter().flat_map(|test| test.fit.runs.iter().map(move |run| (test, run)))
    {
        let (before, over_n) = (values.len(), exponent.over_n(test));
        let of_run = test.fit.cycles[run.cycles.clone()].iter();
        values.extend(of_run.filter_map(|cycle| Some([value(cycle, over_n)?, test.ln_pressure])));
        // Where few cycles show it, those are the ones that noise and the place of the samples lifted.
        if ((values.len() - before) as f64) < MOST_SHOW * run.cycles.len() as f64 {
            values.truncate(before);
        }
        let count = (values.len() - before) as f64;
        let sampling = run.sampling_n / over_n;
        floor += count * sampling * sampling / if way == 0 { 2.0 } else { 1.0 };
        // Half a step of the rise before breakaway, which two cycles of a run share.
        let half_step = 3.0_f64.sqrt() * sampling;
        let shared = run.shared[usize::from(way == 0)];
        if shared > 0.0 && count > 0.0 {
            common += count * (count - 1.0) * shared * half_step * half_step;
            locked += 1;
        }
    }
    let plain: Vec<f64> = values.iter().map(|[value, _]| *value).collect();
    let n = values.len() as f64;
    let (floor, common) = ((floor / n).sqrt(), (common / (n * (n - 1.0))).sqrt());
    let interval = match locked {
        0 => mean_interval(&plain, floor),
        1 => mean_interval_with_common(&plain, common),
        // Runs do not agree in their part of a step: their errors add up to a normal one.
        _ => mean_interval(&plain, 0.0).map(|(mean, [_, high])| {
            let normal = crate::numerics::distribution::normal_quantile(0.975);
            let half = libm::hypot(high - mean, normal * common / 3.0_f64.sqrt());
            (mean, [mean - half, mean + half])
        }),
    };
    let interval = interval.map(|(mean, ends)| (mean, exponent.widened(&values, mean, ends)));
    (values.len(), interval)
}

/// What a reader must know of tests whose sensors may be off by a constant.
#[must_use]
pub fn zero_not_stated(fits: &[&CyclicFit]) -> Option<Notice> {
    let message = "friction by direction cannot be determined: an offset of the force cell, or of the \
                   displacement of a spring, looks the same; state the zeros of the sensors with \
                   the mapping \"zero=first 2 s\", \"force=COLUMN - 12 N\" or \"zero=as measured\"";
    fits.iter().any(|fit| !fit.zero_known).then(|| Notice::new(NoticeKind::ZeroNotStated, message))
}

/// The doubt about a force cell that is said to be right as measured, where friction differs by direction as an
/// offset of it makes it.
#[must_use]
pub fn zero_doubted(fit: &CyclicFit) -> Option<Notice> {
    /// Least difference of both ways over their mean.
    const LEAST: f64 = 0.04;
    if fit.drift.is_some() {
        return None;
    }
    let halves: Vec<f64> =
        fit.cycles.iter().map(|c| 0.5 * (c.kinetic_n[0] - c.kinetic_n[1])).collect();
    let (half, [low, high]) = mean_interval(&halves, 0.0)?;
    let mean = fit.cycles.iter().map(Cycle::mean_kinetic_n).sum::<f64>() / halves.len() as f64;
    let is_clear = low > 0.0 || high < 0.0;
    (is_clear && (2.0 * half / mean).abs() > LEAST).then(|| {
        let message = format!(
            "friction towards +x is {:.0} % {} than towards −x, which a force cell that is off by {half:.3} N makes too: \
             the mapping says that its zero is right as measured; if that is not known, say \"zero=first 2 s\" or leave \
             it out",
            100.0 * (2.0 * half / mean).abs(),
            if half > 0.0 { "higher" } else { "lower" }
        );
        Notice::new(NoticeKind::SensorOffset, message)
    })
}

/// Whether friction by direction can be told from a drift of the force.
fn by_way(fits: &[&CyclicFit]) -> Result<(), &'static str> {
    if fits.iter().any(|fit| fit.drift.is_some()) {
        return Err(
            "the zero of the force drifts, which looks like friction that differs by direction",
        );
    }
    Ok(())
}

/// Why friction (one value a cycle, in N) does not show, if it does not.
fn not_sliding(widths: &[f64], largest_force_n: f64, law: KineticLaw) -> Option<String> {
    let (width, [low, _]) = mean_interval(widths, 0.0)?;
    if !(width > 0.02 * largest_force_n) {
        return Some("the loop of force over displacement has no width: nothing slid".to_owned());
    }
    // Friction that follows the speed differs from cycle to cycle.
    if law == KineticLaw::SlowFastRate {
        return None;
    }
    let t = student_quantile(0.95, widths.len() as f64 - 1.0);
    let error = (width - low) / t;
    (!(width > CLEAR_WIDTH * error)).then(|| {
        format!(
            "cycles scatter too much: {width:.4e} N with a standard error of {error:.1e} N; look at \
             the tests one by one"
        )
    })
}

/// The slope of the kinetic friction over frequency, of cycles with both, where frequencies differ by a fifth or more.
fn per_hz(cycles: &[(f64, f64)], unit: &'static str) -> Option<Estimate> {
    let hz = || cycles.iter().map(|(hz, _)| *hz);
    let (low, high) = hz().fold((f64::INFINITY, 0.0_f64), |(l, h), f| (l.min(f), h.max(f)));
    if !(high > 1.2 * low) || cycles.len() < LEAST_CYCLES {
        return None;
    }
    let rows: Vec<([f64; 2], f64)> =
        cycles.iter().map(|(hz, friction)| ([1.0, *hz], *friction)).collect();
    let fit = linear_fit(&rows)?;
    let freedom = rows.len() as f64 - 2.0;
    let half = student_quantile(0.95, freedom) * (fit.sse / freedom * fit.covariance[1][1]).sqrt();
    let slope = fit.coefficients[1];
    let unit = if unit.is_empty() { "1/Hz" } else { "N/Hz" };
    Some(Estimate::determined(
        "kinetic friction over frequency",
        unit,
        slope,
        [slope - half, slope + half],
    ))
}

#[cfg(test)]
mod tests;
