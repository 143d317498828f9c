//! Elastic response spectra of a piecewise-linear acceleration, exact.
//!
//! The oscillator `ü + 2ξω u̇ + ω² u = −a(t)` is written in the phase `τ = ωt`, with `α = a/ω²`:
//!
//! ```text
//! u' = w      w' = −u − 2ξ w − α(τ)      α linear over an interval of phase θ = ωh
//! ```
//!
//! so that one interval is a matrix of numbers that depend on `θ` and `ξ` only. Its exact solution
//! is `u = −α0 + 2ξ σ − σ τ` with `σ = (α1 − α0)/θ`, plus a damped sinusoid.

//!
//! Peaks are looked for at the samples first; between two samples only where a bound with a proof
//! ([`oscillator::Overshoot`](super::oscillator)) does not exclude a higher one.

mod lanes;

use core::f64::consts::TAU;

use super::figures::peak;
use super::oscillator::{Interval, Overshoot, Peaks, State, Steps};
use crate::error::MotionError;

/// Peaks of one oscillator: displacement relative to its support, and total acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ordinates {
    /// Sd: largest relative displacement in m.
    pub sd_m: f64,
    /// Sv: largest relative velocity in m/s.
    pub sv_m_per_s: f64,
    /// PSv = ω Sd in m/s.
    pub psv_m_per_s: f64,
    /// PSa = ω² Sd in m/s².
    pub psa_m_per_s2: f64,
    /// Sa: largest total acceleration in m/s².
    pub sa_m_per_s2: f64,
}

/// Ordinates for every period and every damping ratio.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Periods in s, as asked for.
    pub periods_s: Vec<f64>,
    /// Damping ratios, as asked for.
    pub damping_ratios: Vec<f64>,
    /// Period by period for the first damping ratio, then for the next.
    pub ordinates: Vec<Ordinates>,
}

impl Spectrum {
    /// Ordinates of one damping ratio, by its index, one a period.
    #[must_use]
    pub fn of_damping(&self, index: usize) -> &[Ordinates] {
        let n = self.periods_s.len();
        &self.ordinates[index * n..(index + 1) * n]
    }
}

/// Periods of a spectrum of a record where nothing else is asked for: from, to (in s), number.
pub const USUAL_PERIODS: (f64, f64, usize) = (0.01, 10.0, 200);

/// `count` periods in s, two or more, from one to another, both > 0, evenly spaced by their
/// logarithm.
#[must_use]
pub fn logarithmic_periods(from_s: f64, to_s: f64, count: usize) -> Vec<f64> {
    let last = count.max(2) - 1;
    let step = libm::log(to_s / from_s) / last as f64;
    let mut periods_s: Vec<f64> = (0..last).map(|k| from_s * libm::exp(k as f64 * step)).collect();
    periods_s.push(to_s);
    periods_s
}

/// Elastic response spectrum of an acceleration in m/s² that is linear between `times_s`, where a
/// repeated time is a jump; the oscillator starts from rest at the first.
///
/// Exact to rounding: peaks are those of the continuous motion from the first time to the last,
/// between samples included. Free vibration after the end counts only where the history has a
/// tail. The period 0 is the rigid oscillator: Sd = PSv = 0, PSa = Sa = the largest acceleration.
///
/// # Errors
/// [`MotionError`] for fewer than two samples or unequal lists; for values that are not finite;
/// for times that decrease; for a period that is negative or shorter than a ten-millionth of the
/// duration; for a damping ratio outside `0 ≤ ξ < 1`.
///
/// # Examples
/// ```
/// use slipstick_dynamics::motion::{logarithmic_periods, spectrum};
///
/// let (times_s, acceleration) = (vec![0.0, 0.1, 0.2, 0.3], vec![0.0, 2.0, -1.0, 0.0]);
/// let periods_s = logarithmic_periods(0.05, 5.0, 100);
/// let spectrum = spectrum(&times_s, &acceleration, &periods_s, &[0.05])?;
/// let stiffest = spectrum.of_damping(0)[0];
/// assert!((1.0..4.0).contains(&stiffest.sa_m_per_s2));
/// # Ok::<(), slipstick_dynamics::error::MotionError>(())
/// ```
pub fn spectrum(
    times_s: &[f64],
    acceleration_m_per_s2: &[f64],
    periods_s: &[f64],
    damping_ratios: &[f64],
) -> Result<Spectrum, MotionError> {
    check(times_s, acceleration_m_per_s2, periods_s, damping_ratios)?;
    let oscillators = damping_ratios.iter().flat_map(|&xi| {
        periods_s.iter().map(move |&period_s| Oscillator { omega: TAU / period_s, xi })
    });
    let oscillators: Vec<Oscillator> = oscillators.collect();
    let elastic: Vec<Oscillator> = oscillators.iter().copied().filter(|o| o.is_elastic()).collect();
    let from_0: Vec<f64> = times_s.iter().map(|t| t - times_s[0]).collect();
    let slowly = |o: &Oscillator| o.peaks(times_s, acceleration_m_per_s2);
    let peaks: Vec<Peaks> = match super::constant_step(&from_0) {
        Some(dt_s) => {
            let quickly = lanes::peaks(dt_s, acceleration_m_per_s2, &elastic);
            let either =
                |(quick, o): (Option<Peaks>, &Oscillator)| quick.unwrap_or_else(|| slowly(o));
            quickly.into_iter().zip(&elastic).map(either).collect()
        }
        None => elastic.iter().map(slowly).collect(),
    };
    let mut peaks = peaks.into_iter();
    let pga = peak(acceleration_m_per_s2);
    let rigid = Ordinates { psa_m_per_s2: pga, sa_m_per_s2: pga, ..Ordinates::default() };
    let of = |o: &Oscillator| match o.is_elastic() {
        true => peaks.next().map_or(rigid, |peaks| o.ordinates(peaks)),
        false => rigid,
    };
    Ok(Spectrum {
        periods_s: periods_s.to_vec(),
        damping_ratios: damping_ratios.to_vec(),
        ordinates: oscillators.iter().map(of).collect(),
    })
}

/// Refuses what [`spectrum`] cannot be of.
pub(super) fn check(
    times_s: &[f64],
    acceleration_m_per_s2: &[f64],
    periods_s: &[f64],
    damping_ratios: &[f64],
) -> Result<(), MotionError> {
    super::check_values(times_s.len(), acceleration_m_per_s2, None)?;
    for (index, t) in times_s.windows(2).enumerate() {
        if !(t[0] <= t[1] && (t[1] - t[0]).is_finite()) {
            let (previous_s, found_s) = (t[0], t[1]);
            return Err(MotionError::TimeOrder { index: index + 1, previous_s, found_s });
        }
    }
    let duration_s = times_s[times_s.len() - 1] - times_s[0];
    for &found in periods_s {
        if !(found == 0.0 || (found.is_finite() && found >= 1e-7 * duration_s && found > 0.0)) {
            let expected = "0, or a finite period of at least a ten-millionth of the duration";
            return Err(MotionError::OutOfRange { quantity: "period in s", expected, found });
        }
    }
    for &found in damping_ratios {
        if !(0.0..1.0).contains(&found) {
            let expected = "a ratio ξ with 0 ≤ ξ < 1";
            return Err(MotionError::OutOfRange { quantity: "damping ratio", expected, found });
        }
    }
    Ok(())
}

/// An oscillator: ω in rad/s, infinite for the period 0, and its damping ratio.
#[derive(Clone, Copy, Debug)]
struct Oscillator {
    omega: f64,
    xi: f64,
}

impl Oscillator {
    fn is_elastic(&self) -> bool {
        self.omega.is_finite()
    }

    fn compliance(&self) -> f64 {
        1.0 / (self.omega * self.omega)
    }

    /// Peaks over samples at any times, one by one.
    fn peaks(&self, times_s: &[f64], acceleration: &[f64]) -> Peaks {
        let Self { omega, xi } = *self;
        let compliance = self.compliance();
        let mut steps = Steps::new(xi);
        let mut state = State { u: 0.0, w: 0.0 };
        let mut peaks = Peaks::default();
        for (t, a) in times_s.windows(2).zip(acceleration.windows(2)) {
            let h = t[1] - t[0];
            if h == 0.0 {
                continue;
            }
            let (theta, alpha0, alpha1) = (omega * h, compliance * a[0], compliance * a[1]);
            let end = steps.of(theta).apply(state, alpha0, alpha1);
            peaks.raise(end, xi);
            let interval = Interval { xi, theta, start: state, end, alpha0, alpha1 };
            interval.raise(Overshoot::new(theta, xi), &mut peaks);
            state = end;
        }
        peaks
    }

    fn ordinates(&self, peaks: Peaks) -> Ordinates {
        let stiffness = self.omega * self.omega;
        Ordinates {
            sd_m: peaks.u,
            sv_m_per_s: self.omega * peaks.w,
            psv_m_per_s: self.omega * peaks.u,
            psa_m_per_s2: stiffness * peaks.u,
            sa_m_per_s2: stiffness * peaks.total,
        }
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::*;

    /// The bar for closed forms.
    const TOLERANCE: f64 = 1e-10;

    fn one(times_s: &[f64], a: &[f64], period_s: f64, xi: f64) -> Ordinates {
        spectrum(times_s, a, &[period_s], &[xi]).unwrap().ordinates[0]
    }

    fn close(found: f64, expected: f64) {
        assert!(
            (found - expected).abs() <= TOLERANCE * expected.abs(),
            "found {found}, expected {expected}, off by {:e}",
            (found - expected).abs() / expected.abs()
        );
    }

    /// Constant acceleration from rest: Sd = (a/ω²)(1 + exp(−ξπ/ω_d)), whatever the sampling.
    #[test]
    fn the_response_to_a_step_is_its_closed_form() {
        for xi in [0.0, 0.02, 0.05, 0.3, 0.7] {
            for samples in [2, 3, 10, 1000] {
                let times_s: Vec<f64> =
                    (0..samples).map(|i| 5.0 * i as f64 / (samples - 1) as f64).collect();
                let found = one(&times_s, &vec![3.0; samples], 0.8, xi);
                let omega = TAU / 0.8;
                let omega_d = (1.0 - xi * xi).sqrt();
                let sd = 3.0 / (omega * omega) * (1.0 + libm::exp(-xi * PI / omega_d));
                close(found.sd_m, sd);
                close(found.psv_m_per_s, omega * sd);
                close(found.psa_m_per_s2, omega * omega * sd);
                // Total acceleration a [1 − e^(−ξτ)(cos − ξ/ω_d sin)] is largest at
                // tan φ = −2ξω_d/(1 − 2ξ²).
                let phi = libm::atan2(2.0 * xi * omega_d, -(1.0 - 2.0 * xi * xi));
                let decay = libm::exp(-xi * phi / omega_d);
                let form = 1.0 - decay * (libm::cos(phi) - xi / omega_d * libm::sin(phi));
                close(found.sa_m_per_s2, 3.0 * form);
            }
        }
    }

    /// A rise over t_r to a constant, undamped: Sd = (a/ω²)(1 + |sin(πt_r/T)|/(πt_r/T)).
    #[test]
    fn ramp_to_constant() {
        for rise_s in [0.1, 0.37, 1.0, 2.35] {
            let found = one(&[0.0, rise_s, rise_s + 3.0], &[0.0, 2.0, 2.0], 1.3, 0.0);
            let x = PI * rise_s / 1.3;
            let omega = TAU / 1.3;
            close(found.sd_m, 2.0 / (omega * omega) * (1.0 + libm::sin(x).abs() / x));
            close(found.sa_m_per_s2, found.psa_m_per_s2);
        }
    }

    /// A ramp, undamped: u = −(j/ω³)(ωt − sin ωt), largest at the end; tiny and huge phases.
    #[test]
    fn the_response_to_a_ramp_is_its_closed_form() {
        for (period_s, end_s) in [(1.0, 1e-3), (1.0, 0.4), (1.0, 7.7), (100.0, 1.0)] {
            let omega = TAU / period_s;
            let x: f64 = omega * end_s;
            let terms = if x < 0.1 {
                x * x * x / 6.0 * (1.0 - x * x / 20.0 * (1.0 - x * x / 42.0))
            } else {
                x - libm::sin(x)
            };
            let found = one(&[0.0, end_s], &[0.0, 5.0 * end_s], period_s, 0.0);
            close(found.sd_m, 5.0 / (omega * omega * omega) * terms);
        }
    }

    /// A square wave at the oscillator's period, undamped: 2nA/ω² after n half periods.
    #[test]
    fn resonance_with_jumps() {
        let (mut times_s, mut a) = (vec![0.0], vec![1.5]);
        for k in 1..=20 {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            times_s.extend([0.25 * k as f64; 2]);
            a.extend([-1.5 * sign, 1.5 * sign]);
        }
        let omega = TAU / 0.5;
        close(one(&times_s, &a, 0.5, 0.0).sd_m, 20.0 * 2.0 * 1.5 / (omega * omega));
    }

    /// A sine at resonance, from rest, undamped, sampled finely: u = −(A/2ω²)(sin ωt − ωt cos ωt).
    /// Straight lines between samples act as a sine smaller by sinc²(ωh/2).
    #[test]
    fn resonance_with_a_sampled_sine() {
        let n = 4000;
        let (cycles, period_s) = (10.0, 1.0);
        let times_s: Vec<f64> = (0..=n).map(|i| cycles * i as f64 / n as f64).collect();
        let a: Vec<f64> = times_s.iter().map(|t| libm::sin(TAU * t)).collect();
        let half = TAU * cycles / n as f64 / 2.0;
        let smaller = libm::sin(half) / half * (libm::sin(half) / half);
        // At t = 10 the envelope ωt/2ω² is reached exactly; harmonics add far less than 1e-6.
        let expected = smaller * TAU * cycles / 2.0 / (TAU * TAU);
        let found = one(&times_s, &a, period_s, 0.0).sd_m;
        assert!((found - expected).abs() < 1e-6 * expected, "{found} {expected}");
    }

    /// Several extremes in one interval, the largest not next to an end.
    #[test]
    fn many_extremes_in_one_interval() {
        // One jump from 0 to −a at rest position of +a: u from 2·swing; then 50 periods of decay.
        let omega = TAU / 0.1;
        let xi = 0.01;
        let found = one(&[0.0, 5.0, 5.0, 10.0], &[1.0, 1.0, -1.0, -1.0], 0.1, xi);
        let omega_d = (1.0 - xi * xi).sqrt();
        // After 50 periods the first step has decayed to e^(−ξ 100π), phase 100π ω_d.
        let start = libm::exp(-xi * 100.0 * PI);
        let phase = 100.0 * PI * omega_d;
        let u0 = -(1.0 - start * (libm::cos(phase) + xi / omega_d * libm::sin(phase)));
        let w0 = -start / omega_d * libm::sin(phase);
        // The largest of the second step, looked for point by point in the next period.
        let (p, q) = (u0 - 1.0, (w0 + xi * (u0 - 1.0)) / omega_d);
        let largest = (0..2_000_000)
            .map(|i| {
                let tau = TAU * f64::from(i) / 2e6;
                let (sin, cos) = (libm::sin(omega_d * tau), libm::cos(omega_d * tau));
                (libm::exp(-xi * tau) * (p * cos + q * sin) + 1.0).abs()
            })
            .fold(0.0, f64::max);
        close(found.sd_m, largest / (omega * omega));
    }

    /// Subdividing a piecewise-linear history changes nothing; nor does shifting its clock.
    #[test]
    fn subdivided_history_has_the_same_spectrum() {
        let coarse_s: Vec<f64> = (0..60).map(|i| 0.13 * f64::from(i)).collect();
        let a: Vec<f64> = (0..60).map(|i| libm::sin(f64::from(i * i))).collect();
        let (mut fine_s, mut b) = (vec![], vec![]);
        for i in 0..59 {
            for k in 0..7 {
                let x = f64::from(k) / 7.0;
                fine_s.push(coarse_s[i] + x * (coarse_s[i + 1] - coarse_s[i]));
                b.push(a[i] + x * (a[i + 1] - a[i]));
            }
        }
        fine_s.push(coarse_s[59]);
        b.push(a[59]);
        let periods_s = [0.02, 0.05, 0.1, 0.2, 0.26, 0.5, 1.0, 3.0, 20.0];
        let damping = [0.0, 0.05, 0.5, 0.9];
        let coarse = spectrum(&coarse_s, &a, &periods_s, &damping).unwrap();
        let fine = spectrum(&fine_s, &b, &periods_s, &damping).unwrap();
        for (c, f) in coarse.ordinates.iter().zip(&fine.ordinates) {
            close(c.sd_m, f.sd_m);
            close(c.sa_m_per_s2, f.sa_m_per_s2);
        }
        assert_eq!(coarse.of_damping(1), &coarse.ordinates[9..18]);
    }

    #[test]
    fn rigid_oscillator_follows_the_ground() {
        let rigid = one(&[0.0, 1.0, 2.0], &[1.0, -4.0, 2.0], 0.0, 0.05);
        assert_eq!((rigid.sd_m, rigid.psa_m_per_s2, rigid.sa_m_per_s2), (0.0, 4.0, 4.0));
        // Next to rigid it nearly does.
        let stiff = one(&[0.0, 1.0, 2.0], &[0.0, -4.0, 2.0], 1e-3, 0.05);
        assert!((stiff.psa_m_per_s2 - 4.0).abs() < 0.01, "{stiff:?}");
    }

    #[test]
    fn nonsense_is_refused() {
        let (t, a) = ([0.0, 1.0], [1.0, 1.0]);
        for period_s in [-1.0, f64::NAN, f64::INFINITY, 1e-9] {
            assert!(spectrum(&t, &a, &[period_s], &[0.05]).is_err(), "{period_s}");
        }
        for xi in [-0.1, 1.0, f64::NAN] {
            assert!(spectrum(&t, &a, &[1.0], &[xi]).is_err(), "{xi}");
        }
        assert!(spectrum(&[0.0], &[1.0], &[1.0], &[0.05]).is_err());
        assert!(spectrum(&[1.0, 0.0], &a, &[1.0], &[0.05]).is_err());
        assert!(spectrum(&t, &[1.0, f64::NAN], &[1.0], &[0.05]).is_err());
    }
}
