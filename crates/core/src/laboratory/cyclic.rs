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

mod stroke;

use super::estimate::{Estimate, mean_interval, mean_interval_with_common};
use crate::numerics::algebra::linear_fit;
use crate::numerics::fractile::upper_median;
use crate::response::Warning;
use stroke::{Breakaway, Stroke, strokes};

/// Fewest cycles that give an interval.
pub const LEAST_CYCLES: usize = 3;
/// Sliding samples are those faster than this part of the stroke's peak speed.
const SLOWEST: f64 = 0.2;
/// A drop at breakaway counts where it is this many times the noise of the force, and twice the
/// rise of the force between two samples.
const CLEAR_DROP: f64 = 4.0;

/// Friction counts where its mean is this many of its standard errors.
const CLEAR_WIDTH: f64 = 6.0;

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
    /// Whether a damper is.
    pub damper: bool,
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
    /// Kinetic friction towards +x and −x in N.
    pub kinetic_n: [f64; 2],
    /// Static friction towards +x and −x in N, where a breakaway shows.
    pub static_n: [Option<f64>; 2],
    /// `K` in N/m, where it was fitted.
    pub spring_n_per_m: Option<f64>,
    /// `C` in N s/m, where it was fitted; it is not where the speed hardly changes.
    pub damper_n_s_per_m: Option<f64>,
    /// Root mean square of what the fit leaves of the force, in N.
    pub residual_n: f64,
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
    /// How far a value of the static friction may be off for want of samples, in N (standard
    /// deviation).
    pub sampling_n: f64,
    /// Whether samples fall on the same part of every cycle, so that the sampling of the breakaway
    /// is one error for all of them; the second of every half cycle.
    pub locked: [bool; 2],
    /// Whether the zeros of the sensors are known.
    pub zero_known: bool,
    /// How the middle of the force loop drifts, where it does.
    pub drift: Option<Drift>,
}

/// A drift of the middle of the force loop, `(f⁺ − f⁻)/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Its rate in N/s.
    pub n_per_s: f64,
    /// Ends of its 95 % interval in N/s.
    pub interval_n_per_s: [f64; 2],
    /// What it makes from the first cycle to the last, in N.
    pub over_test_n: f64,
}

impl CyclicFit {
    /// What a reader must know of it.
    #[must_use]
    pub fn warning(&self) -> Option<Warning> {
        let Drift { n_per_s, interval_n_per_s: [low, high], over_test_n } = self.drift?;
        let message = format!(
            "the middle of the force loop drifts by {over_test_n:.3} N over the test ({:.3} N/min, 95 % \
             from {:.3} to {:.3}): the zero of the force cell moves, and friction by direction is not \
             told",
            60.0 * n_per_s,
            60.0 * low,
            60.0 * high
        );
        Some(Warning { kind: "force_drift", time_s: None, message })
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
    let mut sampling: Vec<f64> = Vec::new();
    let mut cycles = Vec::new();
    for ((fit, sides), pair) in fits.into_iter().zip(&breakaways).zip(&pairs) {
        let Some(mut cycle) = fit else { continue };
        for side in 0..2 {
            // Read again with the final spring and damper.
            let Some(_) = sides[side] else { continue };
            let read = pair[side].breakaway(test, &cycle, slack_m);
            if let Some(b) = read.filter(|b| b.is_clear(cycle.residual_n)) {
                cycle.static_n[usize::from(pair[side].sign < 0.0)] = Some(b.force_n);
                sampling.push(b.sampling_n);
            }
        }
        cycles.push(cycle);
    }
    if cycles.len() < LEAST_CYCLES {
        return Err(CyclicError::TooFewCycles { found: cycles.len() });
    }
    let sampling_n = upper_median(sampling).unwrap_or(0.0);
    let damper_sought = test.damper;
    let (locked, drift) = (locked(test, &cycles), drift(&cycles));
    let zero_known = test.zero_known;
    Ok(CyclicFit {
        cycles,
        slack_m,
        strokes_left_out,
        fitted_n,
        damper_sought,
        sampling_n,
        locked,
        zero_known,
        drift,
    })
}

/// Whether the samples move by less than a step through the cycles of a test, and through its half
/// cycles: then every breakaway falls on the same part of a step.
fn locked(test: &CyclicTest, cycles: &[Cycle]) -> [bool; 2] {
    let n = test.times_s.len();
    let dt_s = (test.times_s[n - 1] - test.times_s[0]) / (n - 1) as f64;
    let count = cycles.len() as f64;
    let steps = cycles.iter().map(|cycle| 1.0 / cycle.frequency_hz).sum::<f64>() / count / dt_s;
    let off = |steps: f64| (steps - libm::round(steps)).abs();
    let all = off(steps) * (count - 1.0) < 1.0;
    [all, all && off(0.5 * steps) < 0.25]
}

/// Fewest standard errors of a drift, and least part of the friction that it makes over a test.
const CLEAR_DRIFT: (f64, f64) = (4.0, 0.005);

/// The slope of the middle of the force loop over time, where it is clear of the cycles' scatter.
fn drift(cycles: &[Cycle]) -> Option<Drift> {
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
    let over_test_n = n_per_s * rows.last().map_or(0.0, |(x, _)| x[1]);
    let kinetic_n = |cycle: &Cycle| 0.5 * (cycle.kinetic_n[0] + cycle.kinetic_n[1]);
    let mean_n = cycles.iter().map(kinetic_n).sum::<f64>() / cycles.len() as f64;
    let clear =
        n_per_s.abs() > CLEAR_DRIFT.0 * error && over_test_n.abs() > CLEAR_DRIFT.1 * mean_n.abs();
    let half = crate::numerics::distribution::student_quantile(0.95, freedom) * error;
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
    let mut rows: Vec<([f64; 4], f64)> = Vec::new();
    let mut used = Vec::new();
    for (stroke, start) in pair.into_iter().zip(starts) {
        for i in stroke.sliding(start, SLOWEST) {
            let up = f64::from(u8::from(stroke.sign > 0.0));
            let velocity = stroke.velocity(i);
            rows.push(([up, up - 1.0, test.displacement_m[i], velocity], test.force_n[i]));
            used.push(i);
        }
    }
    let speeds: Vec<f64> = rows.iter().map(|(x, _)| x[3].abs()).collect();
    let mean = speeds.iter().sum::<f64>() / speeds.len().max(1) as f64;
    let spread = speeds.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / speeds.len() as f64;
    // At one speed a viscous force is a friction force.
    let damper = test.damper && spread.sqrt() > 0.1 * mean;
    let wanted = [true, true, test.spring, damper];
    let chosen = |x: &[f64; 4]| -> Vec<f64> {
        x.iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|(x, _)| *x).collect()
    };
    let chosen: Vec<(Vec<f64>, f64)> = rows.iter().map(|(x, y)| (chosen(x), *y)).collect();
    let fit = linear_fit(&chosen)?;
    let mut found = fit.coefficients.iter().copied();
    let coefficients = wanted.map(|wanted| if wanted { found.next() } else { None });
    let unknowns = fit.coefficients.len();
    if rows.len() < 4 * unknowns {
        return None;
    }
    for (i, (x, _)) in used.iter().zip(&chosen) {
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
        kinetic_n: [coefficients[0]?, coefficients[1]?],
        static_n: [None, None],
        spring_n_per_m: coefficients[2],
        damper_n_s_per_m: coefficients[3],
        residual_n: (fit.sse / (rows.len() - unknowns) as f64).sqrt(),
    })
}

/// What several tests say together.
#[derive(Clone, Debug, PartialEq)]
pub struct CyclicEstimates {
    /// Kinetic and static friction (both ways together, towards +x, towards −x), then spring and
    /// damper where they were fitted.
    /// Friction is a coefficient where the normal force is known, else a force in N.
    pub estimates: Vec<Estimate>,
    /// How the kinetic friction (mean of both ways) changes with frequency, per Hz; `None` for tests
    /// at one frequency.
    pub per_hz: Option<Estimate>,
}

/// Means over all cycles of some tests.
///
/// `normal_force_n` turns forces into coefficients. Refused are: friction that is not clear of 0
/// (less than 2 % of the largest force or six standard errors), which means that nothing slid;
/// static friction where fewer than three strokes show a breakaway. Friction by direction is left out
/// where the zeros of the sensors are not known ([`zero_not_stated`]), and refused where one drifts.
#[must_use]
pub fn estimates(
    fits: &[&CyclicFit],
    largest_force_n: f64,
    normal_force_n: Option<f64>,
) -> CyclicEstimates {
    let cycles: Vec<&Cycle> = fits.iter().flat_map(|fit| &fit.cycles).collect();
    let sampling_n = fits.iter().map(|fit| fit.sampling_n).fold(0.0, f64::max);
    let (over_n, unit) = normal_force_n.map_or((1.0, "N"), |n| (n, ""));
    let name = |what: &str, way: &str| {
        let force = if normal_force_n.is_some() { "" } else { "_force" };
        format!("slider.{what}_friction{force}{way}")
    };
    let mean = |cycle: &&Cycle| 0.5 * (cycle.kinetic_n[0] + cycle.kinetic_n[1]);
    let widths: Vec<f64> = cycles.iter().map(mean).collect();
    let why_not = not_sliding(&widths, largest_force_n);
    let slides = why_not.is_none();
    let by_way = by_way(fits);
    let told_ways = if fits.iter().all(|fit| fit.zero_known) { 3 } else { 1 };
    let mut estimates = Vec::new();
    let ways = ["", ".positive", ".negative"];
    for way in 0..told_ways {
        let values: Vec<f64> = cycles
            .iter()
            .map(|cycle| if way == 0 { mean(cycle) } else { cycle.kinetic_n[way - 1] } / over_n)
            .collect();
        let path = name("kinetic", ways[way]);
        estimates.push(match (mean_interval(&values, 0.0), &by_way) {
            (_, Err(why)) if way > 0 && slides => Estimate::refused(path, unit, *why),
            (Some((value, ends)), _) if slides => Estimate::told(path, unit, value, ends),
            _ => Estimate::refused(path, unit, why_not.clone().unwrap_or_default()),
        });
    }
    for way in 0..told_ways {
        let values: Vec<f64> = cycles
            .iter()
            .filter_map(|cycle| match way {
                0 => Some(0.5 * (cycle.static_n[0]? + cycle.static_n[1]?)),
                _ => cycle.static_n[way - 1],
            })
            .map(|force_n| force_n / over_n)
            .collect();
        let path = name("static", ways[way]);
        let enough = values.len() >= LEAST_CYCLES;
        let floor = if way == 0 { sampling_n / 2.0_f64.sqrt() } else { sampling_n } / over_n;
        // Half a step of the rise before breakaway, in which all cycles of a locked test agree; the two
        // ways are half a cycle apart, and where that is no whole number of steps they share half of it.
        let half_step = 3.0_f64.sqrt() * sampling_n / over_n;
        let locked = |half: usize| fits.iter().any(|fit| fit.locked[half]);
        let interval = match (locked(0), way == 0 && !locked(1)) {
            (false, _) => mean_interval(&values, floor),
            (true, true) => mean_interval_with_common(&values, 0.5 * half_step),
            (true, false) => mean_interval_with_common(&values, half_step),
        };
        estimates.push(match (interval, &by_way) {
            (Some(_), Err(why)) if way > 0 && slides && enough => {
                Estimate::refused(path, unit, *why)
            }
            (Some((value, ends)), _) if slides && enough => Estimate::told(path, unit, value, ends),
            _ => {
                let why = format!(
                    "only {} of {} cycles show a breakaway that is clear of noise and sampling",
                    values.len(),
                    cycles.len()
                );
                Estimate::refused(path, unit, why)
            }
        });
    }
    let springs: Vec<f64> = cycles.iter().filter_map(|cycle| cycle.spring_n_per_m).collect();
    if let Some((value, ends)) = mean_interval(&springs, 0.0) {
        estimates.push(Estimate::told("slider.spring", "N/m", value, ends));
    }
    let dampers: Vec<f64> = cycles.iter().filter_map(|cycle| cycle.damper_n_s_per_m).collect();
    match mean_interval(&dampers, 0.0) {
        Some((value, ends)) if dampers.len() >= LEAST_CYCLES => {
            estimates.push(Estimate::told("slider.damper", "N s/m", value, ends));
        }
        _ if fits.iter().any(|fit| fit.damper_sought) => {
            let why =
                "the speed hardly changes within a stroke: a viscous force looks like friction";
            estimates.push(Estimate::refused("slider.damper", "N s/m", why));
        }
        _ => {}
    }
    CyclicEstimates { estimates, per_hz: per_hz(&cycles, over_n, unit) }
}

/// What a reader must know of tests whose sensors may be off by a constant.
#[must_use]
pub fn zero_not_stated(fits: &[&CyclicFit]) -> Option<Warning> {
    let message = "friction by direction is not told: an offset of the force cell, or of the \
                   displacement of a spring, looks the same; state the zeros of the sensors with \
                   --map \"zero=first 2 s\", \"force=COLUMN - 12 N\" or \"zero=as measured\"";
    fits.iter().any(|fit| !fit.zero_known).then(|| Warning {
        kind: "zero_not_stated",
        time_s: None,
        message: message.to_owned(),
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
fn not_sliding(widths: &[f64], largest_force_n: f64) -> Option<String> {
    let (width, [low, _]) = mean_interval(widths, 0.0)?;
    if !(width > 0.02 * largest_force_n) {
        return Some("the loop of force over displacement has no width: nothing slid".to_owned());
    }
    let t = crate::numerics::distribution::student_quantile(0.95, widths.len() as f64 - 1.0);
    let error = (width - low) / t;
    (!(width > CLEAR_WIDTH * error)).then(|| {
        format!(
            "cycles scatter too much: {width:.4e} N with a standard error of {error:.1e} N; look at \
             the tests one by one"
        )
    })
}

/// The slope of the kinetic friction over frequency, where frequencies differ by a fifth or more.
fn per_hz(cycles: &[&Cycle], over_n: f64, unit: &'static str) -> Option<Estimate> {
    let hz = || cycles.iter().map(|cycle| cycle.frequency_hz);
    let (low, high) = hz().fold((f64::INFINITY, 0.0_f64), |(l, h), f| (l.min(f), h.max(f)));
    if !(high > 1.2 * low) || cycles.len() < LEAST_CYCLES {
        return None;
    }
    let rows: Vec<([f64; 2], f64)> = cycles
        .iter()
        .map(|cycle| {
            let mean = 0.5 * (cycle.kinetic_n[0] + cycle.kinetic_n[1]) / over_n;
            ([1.0, cycle.frequency_hz], mean)
        })
        .collect();
    let fit = linear_fit(&rows)?;
    let freedom = rows.len() as f64 - 2.0;
    let half = crate::numerics::distribution::student_quantile(0.95, freedom)
        * (fit.sse / freedom * fit.covariance[1][1]).sqrt();
    let slope = fit.coefficients[1];
    let unit = if unit.is_empty() { "1/Hz" } else { "N/Hz" };
    Some(Estimate::told(
        "kinetic friction over frequency",
        unit,
        slope,
        [slope - half, slope + half],
    ))
}

#[cfg(test)]
mod tests;
