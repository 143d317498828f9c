//! One elastic oscillator over one interval of a piecewise-linear acceleration, exact.
//!
//! The equations, in the phase `τ = ωt`, are those of [`super::spectrum`].

use core::f64::consts::TAU;

use crate::linear::polynomial::{self, DEGREE, Polynomial};

/// Relative displacement `u` and its derivative by phase, `w = u̇/ω`; both in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub u: f64,
    pub w: f64,
}

/// State after a phase `θ`, linear in the state before and in `α` at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub by_u: State,
    pub by_w: State,
    pub by_alpha0: State,
    pub by_alpha1: State,
}

impl Step {
    pub fn new(theta: f64, xi: f64) -> Self {
        // Below one radian the closed form loses digits and the series has few terms.
        if theta <= 1.0 { Self::by_series(theta, xi) } else { Self::by_closed_form(theta, xi) }
    }

    fn by_series(theta: f64, xi: f64) -> Self {
        let column = |u, w, alpha0: f64, alpha1: f64| series(theta, xi, u, w, alpha0, alpha1);
        Self {
            by_u: column(1.0, 0.0, 0.0, 0.0),
            by_w: column(0.0, 1.0, 0.0, 0.0),
            by_alpha0: column(0.0, 0.0, 1.0, 0.0),
            by_alpha1: column(0.0, 0.0, 0.0, 1.0),
        }
    }

    fn by_closed_form(theta: f64, xi: f64) -> Self {
        let column = |u, w, alpha0: f64, alpha1: f64| {
            let sigma = (alpha1 - alpha0) / theta;
            let sinusoid = Sinusoid::from_start(xi, u + alpha0 - 2.0 * xi * sigma, w + sigma);
            State {
                u: sinusoid.at(theta) - alpha1 + 2.0 * xi * sigma,
                w: sinusoid.derivative().at(theta) - sigma,
            }
        };
        Self {
            by_u: column(1.0, 0.0, 0.0, 0.0),
            by_w: column(0.0, 1.0, 0.0, 0.0),
            by_alpha0: column(0.0, 0.0, 1.0, 0.0),
            by_alpha1: column(0.0, 0.0, 0.0, 1.0),
        }
    }

    pub fn apply(&self, start: State, alpha0: f64, alpha1: f64) -> State {
        let [u, w] = [|s: State| s.u, |s: State| s.w].map(|part| {
            part(self.by_u) * start.u
                + part(self.by_w) * start.w
                + (part(self.by_alpha0) * alpha0 + part(self.by_alpha1) * alpha1)
        });
        State { u, w }
    }
}

/// Taylor series of the solution at `theta ≤ 1`: `(k+2)(k+1) c[k+2] = −2ξ(k+1) c[k+1] − c[k] − α[k]`.
fn series(theta: f64, xi: f64, u: f64, w: f64, alpha0: f64, alpha1: f64) -> State {
    // Terms θᵏ c[k]; all but the first two columns of α are 0.
    let mut terms = [0.0; 26];
    terms[0] = u;
    terms[1] = w * theta;
    for k in 0..terms.len() - 2 {
        let alpha = match k {
            0 => alpha0,
            1 => alpha1 - alpha0,
            _ => 0.0,
        };
        let (k1, k2) = ((k + 1) as f64, (k + 2) as f64);
        let square = theta * theta * (terms[k] + alpha);
        terms[k + 2] = -(2.0 * xi * theta * k1 * terms[k + 1] + square) / (k1 * k2);
    }
    let mut end = State { u: 0.0, w: 0.0 };
    for (k, term) in terms.iter().enumerate().rev() {
        end.u += term;
        end.w += k as f64 * term;
    }
    end.w /= theta;
    end
}

/// Steps already made: evenly spaced times differ in a few last bits only.
pub(super) struct Steps {
    xi: f64,
    known: Vec<(f64, Step)>,
    next: usize,
}

impl Steps {
    const KEPT: usize = 16;

    pub fn new(xi: f64) -> Self {
        Self { xi, known: Vec::with_capacity(Self::KEPT), next: 0 }
    }

    pub fn of(&mut self, theta: f64) -> Step {
        if let Some((_, step)) = self.known.iter().find(|(known, _)| *known == theta) {
            return *step;
        }
        let step = Step::new(theta, self.xi);
        if self.known.len() < Self::KEPT {
            self.known.push((theta, step));
        } else {
            self.known[self.next] = (theta, step);
            self.next = (self.next + 1) % Self::KEPT;
        }
        step
    }
}

/// Largest |u|, |w| and |u + 2ξw| so far; times ω², ω and ω² they are PSa, Sv and Sa.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Peaks {
    pub u: f64,
    pub w: f64,
    pub total: f64,
}

impl Peaks {
    /// With those of a state.
    pub fn raise(&mut self, state: State, xi: f64) {
        let higher = |peak: &mut f64, value: f64| {
            let value = value.abs();
            *peak = if value > *peak { value } else { *peak };
        };
        higher(&mut self.u, state.u);
        higher(&mut self.w, state.w);
        higher(&mut self.total, state.u + 2.0 * xi * state.w);
    }
}

/// How far a peak between two samples can stand above both: a bound with a proof.
///
/// `u`, `w` and `U = u + 2ξw` all follow `y″ = −y − 2ξ y′ − f` with `f` linear over an interval of
/// phase θ: `f` is `α` for `u`, its slope `σ` for `w`, `α + 2ξσ` for `U`. Let `|y|` be largest, `M`,
/// inside, so that `y′ = 0` there, and let `F` bound `|f|` and `B` the larger of `|y|` at the ends.
/// Then `|y′| ≤ θ sup|y″|`, hence `sup|y″| ≤ D = (M + F)/(1 − 2ξθ)` where `2ξθ < 1`; the nearer end
/// is at most θ/2 away, so that Taylor's theorem gives `B ≥ M − D θ²/8`, and
///
/// ```text
/// M ≤ (B + cF)/(1 − c)      c = θ²/(8 (1 − 2ξθ)) < 1
/// ```
#[derive(Clone, Copy, Debug)]
pub(super) struct Overshoot {
    theta: f64,
    xi: f64,
    /// `1 − 2ξθ`.
    room: f64,
    /// 1 where the bound says nothing.
    c: f64,
}

impl Overshoot {
    pub fn new(theta: f64, xi: f64) -> Self {
        let room = 1.0 - 2.0 * xi * theta;
        let c = theta * theta / (8.0 * room);
        Self { theta, xi, room, c: if room > 0.0 && c < 1.0 { c } else { 1.0 } }
    }

    /// How many parts an interval needs for the bound to be a close one.
    pub fn parts(theta: f64, xi: f64) -> f64 {
        // c ≤ 0.15 where θ² ≤ 1.2 (1 − 2ξθ).
        let longest = libm::sqrt(1.44 * xi * xi + 1.2) - 1.2 * xi;
        libm::ceil(theta / longest).max(1.0)
    }

    /// What a value at an end has to exceed for the peak inside to be above `attained`.
    #[inline(always)]
    pub fn limit(&self, attained: f64, forcing: f64) -> f64 {
        // Where the bound says nothing, `c = 1`, every value but 0 exceeds it.
        (1.0 - self.c) * attained - self.c * forcing
    }

    /// Whether `−y` and `y` may be above `attained` inside an interval whose values and slopes at
    /// both ends are known: a sharper bound.
    ///
    /// The cubic `H` through both departs from `y` by at most `θ⁴/384 sup|y⁗|`. As `f` is linear,
    /// `y‴ = −y′ − 2ξ y″ − f′` and `y⁗ = −y″ − 2ξ y‴`, where `|y″| ≤ D` and `|y′| ≤ θD` as above.
    fn sides(&self, attained: f64, line: &Line, end: [f64; 2]) -> [bool; 2] {
        let Self { theta, xi, room, c } = *self;
        if c >= 1.0 {
            return line.sides_by_amplitude(attained);
        }
        let ([y0, slope0], [y1, slope1]) = ([line.y, line.slope], end);
        let forcing = line.f[0].abs().max(line.f[1].abs());
        let highest = (y0.abs().max(y1.abs()) + c * forcing) / (1.0 - c);
        let bend = (highest + forcing) / room;
        // From its value at one end to 0 and on to that at the other y′ needs this much bend.
        if slope0 * slope1 > 0.0 && slope0.abs() + slope1.abs() > bend * theta {
            return [false; 2];
        }
        let third = (theta + 2.0 * xi) * bend + (line.f[1] - line.f[0]).abs() / theta;
        let square = theta * theta;
        let error = square * square / 384.0 * (bend + 2.0 * xi * third);
        let [lowest, highest] = cubic_extremes(y0, y1, theta * slope0, theta * slope1);
        [-lowest + error > attained, highest + error > attained]
    }
}

/// Least and largest value of a cubic on [0, 1] by its values and slopes at both ends.
fn cubic_extremes(y0: f64, y1: f64, d0: f64, d1: f64) -> [f64; 2] {
    let rise = y1 - y0;
    let (c2, c3) = (3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise);
    // 3 c3 x² + 2 c2 x + d0 = 0, in the form that does not cancel.
    let discriminant = c2 * c2 - 3.0 * c3 * d0;
    let (mut lowest, mut highest) = (y0.min(y1), y0.max(y1));
    if discriminant >= 0.0 {
        let s = -(c2 + libm::copysign(discriminant.sqrt(), c2));
        for x in [s / (3.0 * c3), d0 / s] {
            if x > 0.0 && x < 1.0 {
                let y = y0 + x * (d0 + x * (c2 + x * c3));
                (lowest, highest) = (lowest.min(y), highest.max(y));
            }
        }
    }
    [lowest, highest]
}

/// One interval of the history, seen by one oscillator.
pub(super) struct Interval {
    /// Damping ratio.
    pub xi: f64,
    /// Phase `ωh`.
    pub theta: f64,
    /// State at its start.
    pub start: State,
    /// State at its end.
    pub end: State,
    /// `α` at its start.
    pub alpha0: f64,
    /// `α` at its end.
    pub alpha1: f64,
}

impl Interval {
    /// Raises the peaks, which hold those of both ends already, by those inside.
    pub fn raise(&self, overshoot: Overshoot, peaks: &mut Peaks) {
        let Self { xi, theta, start, end, alpha0, alpha1 } = *self;
        let sigma = (alpha1 - alpha0) / theta;
        let shift = 2.0 * xi * sigma;
        let total = |s: State| s.u + 2.0 * xi * s.w;
        let totals = [total(start), total(end)];
        let raise = |peak: &mut f64, y: [f64; 2], f: [f64; 2], slopes: &dyn Fn() -> [f64; 2]| {
            let limit = overshoot.limit(*peak, f[0].abs().max(f[1].abs()));
            if y[0].abs() > limit || y[1].abs() > limit {
                let slopes = slopes();
                let line = Line { xi, theta, y: y[0], slope: slopes[0], f };
                let sides = overshoot.sides(*peak, &line, [y[1], slopes[1]]);
                if sides != [false; 2] {
                    line.raise(sides, peak);
                }
            }
        };
        // w′ = −(U + α), U′ = w + 2ξ w′.
        let slopes_of_w = || [-(totals[0] + alpha0), -(totals[1] + alpha1)];
        let slopes_of_total = || {
            let [d0, d1] = slopes_of_w();
            [start.w + 2.0 * xi * d0, end.w + 2.0 * xi * d1]
        };
        raise(&mut peaks.u, [start.u, end.u], [alpha0, alpha1], &|| [start.w, end.w]);
        raise(&mut peaks.w, [start.w, end.w], [sigma, sigma], &slopes_of_w);
        raise(&mut peaks.total, totals, [alpha0 + shift, alpha1 + shift], &slopes_of_total);
    }
}

/// A solution of `y″ = −y − 2ξ y′ − f` over one interval, `f` linear.
struct Line {
    xi: f64,
    theta: f64,
    y: f64,
    slope: f64,
    f: [f64; 2],
}

impl Line {
    /// Longest phase that one Taylor polynomial spans: what it leaves out is below 1e-15.
    const LONGEST: f64 = 0.375;

    /// Whether `−y` and `y` may be above `attained`: `y` is a straight line, `−f + 2ξf′`, and a
    /// sinusoid whose amplitude does not grow.
    fn sides_by_amplitude(&self, attained: f64) -> [bool; 2] {
        let Self { xi, theta, y, slope, f } = *self;
        let rise = (f[1] - f[0]) / theta;
        let [l0, l1] = f.map(|f| 2.0 * xi * rise - f);
        let sinusoid = Sinusoid::from_start(xi, y - l0, slope + rise);
        let amplitude = libm::sqrt(sinusoid.p * sinusoid.p + sinusoid.q * sinusoid.q);
        let limit = attained * (1.0 - 1e-9);
        [(-l0).max(-l1) + amplitude > limit, l0.max(l1) + amplitude > limit]
    }

    /// Raises the peak by the largest `−y` and `y`, each where asked for.
    ///
    /// It is in the first or the last period `P = 2π/√(1 − ξ²)`: `y = L + e^(−ξτ) c` with `L` straight
    /// and `c` of period `P`, so that `y(τ + kP) = a + bk + C rᵏ` with `0 < r ≤ 1`. Where `C ≥ 0` that
    /// is convex in `k`, and largest at the first or the last. Where `C < 0` it is below `L`, and
    /// less than `P/2` away, where `L` is no lower, `c = 0` and `y = L` is higher.
    fn raise(&self, sides: [bool; 2], peak: &mut f64) {
        let Self { xi, theta, y, slope, f: [f0, f1] } = *self;
        let period = TAU / libm::sqrt((1.0 - xi) * (1.0 + xi));
        if theta <= 2.0 * period {
            return self.raise_throughout(sides, peak);
        }
        let at = |tau: f64| f0 + (f1 - f0) * (tau / theta);
        let first = Self { theta: period, f: [f0, at(period)], ..*self };
        first.raise_throughout(sides, peak);
        let before = theta - period;
        let start = Step::new(before, xi).apply(State { u: y, w: slope }, f0, at(before));
        let f = [at(before), f1];
        Self { xi, theta: period, y: start.u, slope: start.w, f }.raise_throughout(sides, peak);
    }

    /// Raises a peak by looking at all parts of a step.
    fn raise_throughout(&self, [below, above]: [bool; 2], peak: &mut f64) {
        let parts = libm::ceil(self.theta / Self::LONGEST).max(1.0);
        let theta = self.theta / parts;
        let (mut y, mut slope) = (self.y, self.slope);
        let [f0, f1] = self.f;
        for part in 0..parts as u64 {
            let at = |k: u64| f0 + (f1 - f0) * (k as f64 / parts);
            let c = taylor(theta, self.xi, y, slope, [at(part), at(part + 1)]);
            if above {
                *peak = polynomial::largest(&c, 1.0, *peak);
            }
            if below {
                *peak = polynomial::largest(&c.map(|c| -c), 1.0, *peak);
            }
            y = polynomial::value(&c, 1.0);
            slope = polynomial::value(&polynomial::derivative(&c), 1.0) / theta;
        }
    }
}

/// Taylor polynomial of `y` in `τ/θ`.
fn taylor(theta: f64, xi: f64, y: f64, slope: f64, [f0, f1]: [f64; 2]) -> Polynomial {
    let mut c = polynomial::ZERO;
    c[0] = y;
    c[1] = slope * theta;
    let (square, double) = (theta * theta, 2.0 * xi * theta);
    let f = [f0, f1 - f0];
    for k in 0..=DEGREE - 2 {
        let forcing = if k < 2 { f[k] } else { 0.0 };
        let (k1, k2) = ((k + 1) as f64, (k + 2) as f64);
        c[k + 2] = -(double * k1 * c[k + 1] + square * (c[k] + forcing)) / (k1 * k2);
    }
    c
}

/// `e^(−ξτ) (p cos ω_d τ + q sin ω_d τ)` with `ω_d = √(1 − ξ²)`.
#[derive(Clone, Copy, Debug)]
struct Sinusoid {
    xi: f64,
    omega_d: f64,
    p: f64,
    q: f64,
}

impl Sinusoid {
    /// The one with value `y0` and slope `z0` at 0.
    fn from_start(xi: f64, y0: f64, z0: f64) -> Self {
        let omega_d = libm::sqrt((1.0 - xi) * (1.0 + xi));
        Self { xi, omega_d, p: y0, q: (z0 + xi * y0) / omega_d }
    }

    fn derivative(self) -> Self {
        let Self { xi, omega_d, p, q } = self;
        Self { p: omega_d * q - xi * p, q: -omega_d * p - xi * q, ..self }
    }

    fn at(&self, tau: f64) -> f64 {
        let phase = self.omega_d * tau;
        libm::exp(-self.xi * tau) * (self.p * libm::cos(phase) + self.q * libm::sin(phase))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Series and closed form are two derivations of one matrix.
    #[test]
    fn series_and_closed_form_agree() {
        for xi in [0.0, 0.05, 0.5, 0.99] {
            for theta in [0.3, 0.7, 1.0] {
                let (a, b) = (Step::by_series(theta, xi), Step::by_closed_form(theta, xi));
                for (x, y) in [
                    (a.by_u, b.by_u),
                    (a.by_w, b.by_w),
                    (a.by_alpha0, b.by_alpha0),
                    (a.by_alpha1, b.by_alpha1),
                ] {
                    assert!((x.u - y.u).abs() < 1e-13 && (x.w - y.w).abs() < 1e-13, "{xi} {theta}");
                }
            }
        }
    }

    /// Over intervals of many periods the first and the last give what a search all along gives.
    #[test]
    fn prop_long_intervals_peak_in_the_first_or_the_last_period() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for k in 0..4000 {
            let xi = if k % 3 == 0 { 0.0 } else { 0.2 * (random() + 1.0) };
            let theta = 13.0 + 60.0 * (random() + 1.0);
            // Small slopes and large, so that either the line or the sinusoid decides.
            let scale = libm::pow(10.0, 2.0 * random());
            let f = [scale * random(), scale * random()];
            let line = Line { xi, theta, y: random(), slope: random(), f };
            for sides in [[true, false], [false, true]] {
                let (mut quick, mut slow) = (0.0, 0.0);
                line.raise(sides, &mut quick);
                line.raise_throughout(sides, &mut slow);
                assert!((quick - slow).abs() <= 1e-13 * (1.0 + scale), "{k} {quick} {slow}");
                let may = line.sides_by_amplitude(slow * (1.0 - 1e-12));
                assert!(may[usize::from(sides[1])] || slow == 0.0, "{k}");
            }
        }
    }

    /// The worst a peak can do: the bounds hold for random intervals, and the first is reached by
    /// a constant force but for its higher terms.
    #[test]
    fn prop_bounds_hold() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let mut tight = 0.0_f64;
        for _ in 0..20_000 {
            let (theta, xi) = (0.525 * (random() + 1.0) + 1e-3, 0.25 * (random() + 1.0));
            let overshoot = Overshoot::new(theta, xi);
            let line =
                Line { xi, theta, y: random(), slope: 2.0 * random(), f: [random(), random()] };
            let steps = 200;
            let step = Step::new(theta / f64::from(steps), xi);
            let mut state = State { u: line.y, w: line.slope };
            let mut signed = state.u;
            for k in 0..steps {
                let at =
                    |k: i32| line.f[0] + (line.f[1] - line.f[0]) * f64::from(k) / f64::from(steps);
                state = step.apply(state, at(k), at(k + 1));
                signed = if state.u.abs() > signed.abs() { state.u } else { signed };
            }
            let largest = signed.abs();
            let ends = line.y.abs().max(state.u.abs());
            let forcing = line.f[0].abs().max(line.f[1].abs());
            if largest > ends {
                let below = largest * (1.0 - 1e-14);
                assert!(ends > overshoot.limit(below, forcing), "{theta} {xi}");
                let sides = overshoot.sides(below, &line, [state.u, state.w]);
                assert!(sides[usize::from(signed > 0.0)], "{theta} {xi}");
                let bound = (ends + overshoot.c * forcing) / (1.0 - overshoot.c);
                tight = tight.max((largest - ends) / (bound - ends));
            }
            let mut peak = ends;
            line.raise([true; 2], &mut peak);
            assert!(peak >= largest * (1.0 - 1e-13) && peak <= largest + 1e-4, "{peak} {largest}");
        }
        assert!(tight > 0.8, "{tight}");
    }
}
