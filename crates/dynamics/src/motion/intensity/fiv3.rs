//! Filtered incremental velocity, FIV3: H. Dávalos and E. Miranda, "Filtered incremental velocity:
//! A novel approach in intensity measures for seismic collapse estimation", Earthquake Engineering
//! and Structural Dynamics 48 (2019) 1384–1405.
//!
//! ```text
//! V(t) = ∫_t^{t + αT} a_f dτ      FIV3 = max(the three largest maxima of V, summed;
//!                                            the three smallest minima of V, summed, absolute)
//! ```
//!
//! `a_f` is the acceleration behind a Butterworth low-pass filter of the second order with its
//! corner at `β/T`. That filter, `ω_c²/(s² + √2 ω_c s + ω_c²)`, is the oscillator of the response
//! spectra with a damping ratio of `1/√2`: `a_f = −ω_c² u`, exact for the piecewise-linear motion
//! and without the warping of a digital filter.

use core::f64::consts::{FRAC_1_SQRT_2, TAU};

use crate::motion::GroundMotion;
use crate::motion::oscillator::{State, Step, Steps};

/// Least number of points a period at which the slope of `V` is looked at, and most of all.
const POINTS_PER_PERIOD: f64 = 50.0;
const MOST_POINTS: f64 = 4e6;
/// Total variation of the filter's response to an impulse over ω, by which a bounded acceleration bounds
/// the rate of the filtered one: 2 e^{−π/4}/(1 − e^{−π}) = 0.9530, rounded up.
const VARIATION: f64 = 0.954;
/// Steps that differ by less than this are one and a remainder of the first order, whose square is lost
/// to rounding.
const NEAR: f64 = 1e-9;
/// Steps that are kept: evenly spaced samples have two or three.
const KEPT: usize = 4;

/// FIV3 in m/s; extremes are those of `V` inside the time from 0 to the end of the motion less
/// the window. Where there are fewer than three, those there are.
pub(super) fn fiv3(motion: &GroundMotion, period_s: f64, alpha: f64, beta: f64) -> f64 {
    let window_s = alpha * period_s;
    let end_s = motion.duration_s() - window_s;
    if !(end_s > 0.0) {
        return 0.0;
    }
    let filtered = Filtered::new(motion, TAU * beta / period_s);
    let times_s = motion.times_s();
    // V is smooth between these: its slope a_f(t + αT) − a_f(t) has kinks where either has. Samples that
    // lie a window apart but for rounding are one kink.
    let mut kinks_s: Vec<f64> = times_s.iter().flat_map(|t| [*t, t - window_s]).collect();
    kinks_s.retain(|t| *t > 0.0 && *t < end_s);
    kinks_s.push(end_s);
    kinks_s.sort_by(f64::total_cmp);
    kinks_s.dedup_by(|later, kept| *later - *kept <= 4.0 * f64::EPSILON * end_s);

    let longest_s = (period_s / beta.max(1.0) / POINTS_PER_PERIOD).max(end_s / MOST_POINTS);
    let mut window =
        Window { filtered: &filtered, window_s, cursors: [0, 0], known: Vec::with_capacity(KEPT) };
    let mut largest = Largest::default();
    let largest_a = motion.horizontal_m_per_s2().iter().fold(0.0, |m: f64, a| m.max(a.abs()));
    let bend = VARIATION * filtered.omega * largest_a;
    let mut left = window.point(0.0);
    let mut last_sign = left.slope;
    let mut from_s = 0.0;
    for to_s in kinks_s {
        let parts = libm::ceil((to_s - from_s) / longest_s).max(1.0);
        for part in 1..=parts as usize {
            let t = from_s + (to_s - from_s) * (part as f64 / parts);
            let right = if part == parts as usize { window.kink(t) } else { window.point(t) };
            if right.slope * last_sign < 0.0 {
                let is_maximum = last_sign > 0.0;
                // |V″| ≤ 2 VARIATION ω max|a|, so |V(t) − V(left)| ≤ |V′(left)| h + VARIATION ω max|a| h².
                let h = right.t - left.t;
                let beyond = (left.slope.abs() + bend * h) * h;
                let end = left.value + if is_maximum { beyond } else { -beyond };
                if largest.takes(end, is_maximum) {
                    let at = if left.slope == 0.0 { left.t } else { window.root(left, right) };
                    largest.add(window.point(at).value, is_maximum);
                }
            }
            if right.slope != 0.0 {
                last_sign = right.slope;
            }
            left = right;
        }
        from_s = to_s;
    }
    largest.fiv3()
}

/// `V` and its slope at a time.
#[derive(Clone, Copy)]
struct Point {
    t: f64,
    slope: f64,
    value: f64,
}

/// The three largest maxima, and the three smallest minima with their sign turned.
#[derive(Default)]
struct Largest {
    maxima: [Option<f64>; 3],
    minima: [Option<f64>; 3],
}

impl Largest {
    fn add(&mut self, value: f64, is_maximum: bool) {
        let (list, value) =
            if is_maximum { (&mut self.maxima, value) } else { (&mut self.minima, -value) };
        let mut value = Some(value);
        for kept in list {
            if *kept < value {
                core::mem::swap(kept, &mut value);
            }
        }
    }

    /// Whether a value would be among the three.
    fn takes(&self, value: f64, is_maximum: bool) -> bool {
        let (list, value) = if is_maximum { (&self.maxima, value) } else { (&self.minima, -value) };
        list[2].is_none_or(|third| value > third)
    }

    fn fiv3(&self) -> f64 {
        let sum = |list: &[Option<f64>; 3]| list.iter().flatten().sum::<f64>().abs();
        sum(&self.maxima).max(sum(&self.minima))
    }
}

/// The acceleration behind the filter, and its integral.
struct Filtered<'a> {
    times_s: &'a [f64],
    acceleration: &'a [f64],
    omega: f64,
    /// State of the oscillator and integral of the acceleration at every sample.
    states: Vec<(State, f64)>,
}

impl<'a> Filtered<'a> {
    fn new(motion: &'a GroundMotion, omega: f64) -> Self {
        let (times_s, acceleration) = (motion.times_s(), motion.horizontal_m_per_s2());
        let mut steps = Steps::new(FRAC_1_SQRT_2);
        let mut state = (State { u: 0.0, w: 0.0 }, 0.0);
        let mut states = Vec::with_capacity(times_s.len());
        states.push(state);
        let compliance = 1.0 / (omega * omega);
        for (t, a) in times_s.windows(2).zip(acceleration.windows(2)) {
            let h = t[1] - t[0];
            if h > 0.0 {
                let step = steps.of(omega * h);
                let next = step.apply(state.0, compliance * a[0], compliance * a[1]);
                state = (next, state.1 + 0.5 * h * (a[0] + a[1]));
            }
            states.push(state);
        }
        Self { times_s, acceleration, omega, states }
    }

    /// `a_f` and `∫ a_f dt` at a time; `cursor` is a sample, best one near it.
    ///
    /// The integral of the oscillator's equation gives `∫ a_f dt = ∫ a dt + u̇ + 2ξω u`.
    /// Where `known` is given, it holds steps that occur again and again.
    fn at(&self, t: f64, cursor: &mut usize, known: Option<&mut Vec<(f64, Step)>>) -> [f64; 2] {
        let last = self.times_s.len() - 1;
        while *cursor > 0 && self.times_s[*cursor] > t {
            *cursor -= 1;
        }
        while *cursor < last && self.times_s[*cursor + 1] <= t {
            *cursor += 1;
        }
        let i = *cursor;
        let tau = t - self.times_s[i];
        let (mut state, mut velocity) = self.states[i];
        if tau > 0.0 && i < last {
            let [a, b] = [self.acceleration[i], self.acceleration[i + 1]];
            let here = a + (b - a) * (tau / (self.times_s[i + 1] - self.times_s[i]));
            let compliance = 1.0 / (self.omega * self.omega);
            let theta = self.omega * tau;
            let (step, rest) = match known {
                None => (Step::new(theta, FRAC_1_SQRT_2), 0.0),
                Some(known) => near(known, theta),
            };
            // The load at the end of the step, and on by the rest: u' = w, w' = −u − 2ξw − load.
            let rate = (b - a) / (self.times_s[i + 1] - self.times_s[i]);
            let load = compliance * (here - rate * (rest / self.omega));
            state = step.apply(state, compliance * a, load);
            let bent = -state.u - 2.0 * FRAC_1_SQRT_2 * state.w - load;
            state = State { u: state.u + rest * state.w, w: state.w + rest * bent };
            velocity += 0.5 * tau * (a + here);
        }
        let omega = self.omega;
        let integral = velocity + omega * (state.w + 2.0 * FRAC_1_SQRT_2 * state.u);
        [-omega * omega * state.u, integral]
    }
}

/// The step nearest to an angle, made where none is near, and what is left of the angle.
fn near(known: &mut Vec<(f64, Step)>, theta: f64) -> (Step, f64) {
    if let Some((angle, step)) = known.iter().find(|(angle, _)| (angle - theta).abs() < NEAR) {
        return (*step, theta - angle);
    }
    let step = Step::new(theta, FRAC_1_SQRT_2);
    if known.len() == KEPT {
        known.remove(0);
    }
    known.push((theta, step));
    (step, 0.0)
}

/// `V` and its slope.
struct Window<'a> {
    filtered: &'a Filtered<'a>,
    window_s: f64,
    cursors: [usize; 2],
    known: Vec<(f64, Step)>,
}

impl Window<'_> {
    fn point(&mut self, t: f64) -> Point {
        let [from, to] = &mut self.cursors;
        let [a, after] = self.filtered.at(t + self.window_s, to, None);
        let [b, before] = self.filtered.at(t, from, None);
        Point { t, slope: a - b, value: after - before }
    }

    /// The window at a kink, which is as far from a sample as many others are.
    fn kink(&mut self, t: f64) -> Point {
        let [from, to] = &mut self.cursors;
        let [a, after] = self.filtered.at(t + self.window_s, to, Some(&mut self.known));
        let [b, before] = self.filtered.at(t, from, Some(&mut self.known));
        Point { t, slope: a - b, value: after - before }
    }

    /// Where the slope is 0 between two points at which its signs differ, by bisection to 1e-9 of
    /// their distance: an extreme is flat, so that its value is exact to rounding.
    fn root(&mut self, left: Point, right: Point) -> f64 {
        let (mut a, mut b) = (left.t, right.t);
        while b - a > 1e-9 * (right.t - left.t) {
            let middle = 0.5 * (a + b);
            if middle <= a || middle >= b {
                break;
            }
            if self.point(middle).slope * left.slope > 0.0 {
                a = middle;
            } else {
                b = middle;
            }
        }
        0.5 * (a + b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A long step of 2 m/s² from rest: behind the filter it settles at 2, so that `V` has no
    /// extreme but those of the overshoot; a pulse much longer than the filter's memory has one
    /// maximum, close to 2 times the window.
    #[test]
    fn no_extreme_and_one() {
        let quiet = GroundMotion::evenly_spaced(0.1, vec![0.0; 100], None).unwrap();
        assert_eq!(fiv3(&quiet, 1.0, 0.7, 0.85), 0.0);
        let short = GroundMotion::evenly_spaced(0.1, vec![0.0, 1.0, 0.0], None).unwrap();
        assert_eq!(fiv3(&short, 1.0, 0.7, 0.85), 0.0);
    }

    /// The filter passes a slow sine almost as it is: `V` swings between ±(2A/ω) sin(ωαT/2), so
    /// that three of each make six times A/ω sin(ωαT/2). The gain is that of the second order,
    /// 1/√(1 + (f/f_c)⁴).
    #[test]
    fn slow_sine() {
        let (period_s, amplitude) = (10.0, 1.5);
        let omega = TAU / period_s;
        // It grows into its amplitude from below, so that the last extremes are the largest.
        let grown = |t: f64| amplitude * (1.0 - libm::exp(-t / 5.0)) * libm::sin(omega * t);
        let a = (0..=20_000).map(|k| grown(0.01 * f64::from(k)));
        let motion = GroundMotion::evenly_spaced(0.01, a.collect(), None).unwrap();
        for filter_s in [0.5, 2.0, 5.0] {
            let ratio = filter_s / 0.85 / period_s;
            let gain = 1.0 / (1.0 + ratio * ratio * ratio * ratio).sqrt();
            let each = gain * 2.0 * amplitude / omega * libm::sin(omega * 0.7 * filter_s / 2.0);
            let found = fiv3(&motion, filter_s, 0.7, 0.85);
            // The samples' straight lines take 3e-6 off a sine of 1000 samples a period.
            assert!((found / (3.0 * each) - 1.0).abs() < 2e-5, "{found} {}", 3.0 * each);
        }
    }

    /// Subdividing the motion changes nothing.
    #[test]
    fn subdivided_motion() {
        let a: Vec<f64> = (0..300).map(|k| libm::sin(f64::from(k * k))).collect();
        let fine: Vec<f64> = a
            .windows(2)
            .flat_map(|p| (0..5).map(|k| p[0] + (p[1] - p[0]) * f64::from(k) / 5.0))
            .collect();
        let coarse = GroundMotion::evenly_spaced(0.05, a[..299].to_vec(), None).unwrap();
        let fine = GroundMotion::evenly_spaced(0.01, fine[..298 * 5 + 1].to_vec(), None).unwrap();
        for period_s in [0.05, 0.3, 1.0, 4.0] {
            let (c, f) = (fiv3(&coarse, period_s, 0.7, 0.85), fiv3(&fine, period_s, 0.7, 0.85));
            assert!((c - f).abs() < 1e-10 * c, "{period_s}: {c} {f}");
        }
    }
}
