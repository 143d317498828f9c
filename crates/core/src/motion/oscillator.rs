//! One elastic oscillator over one interval of a piecewise-linear acceleration, exact.
//!
//! The equations, in the phase `τ = ωt`, are those of [`super::spectrum`].

use core::f64::consts::PI;

/// Relative displacement `u` and its derivative by phase, `w = u̇/ω`; both in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub u: f64,
    pub w: f64,
}

/// State after a phase `θ`, linear in the state before and in `α` at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    by_u: State,
    by_w: State,
    by_alpha0: State,
    by_alpha1: State,
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
        let column = |u, w, alpha0, alpha1| {
            let start = State { u, w };
            let at = Interval { xi, theta, start, alpha0, alpha1 };
            let sigma = at.sigma();
            State {
                u: at.displacement().at(theta) - alpha1 + 2.0 * xi * sigma,
                w: at.velocity().at(theta) - sigma,
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

/// One interval of the history, seen by one oscillator.
pub(super) struct Interval {
    /// Damping ratio.
    pub xi: f64,
    /// Phase `ωh`.
    pub theta: f64,
    /// State at its start.
    pub start: State,
    /// `α` at its start.
    pub alpha0: f64,
    /// `α` at its end.
    pub alpha1: f64,
}

impl Interval {
    /// Slope of `α` by phase.
    fn sigma(&self) -> f64 {
        (self.alpha1 - self.alpha0) / self.theta
    }

    /// The damped sinusoid in `u`.
    fn displacement(&self) -> Sinusoid {
        let y0 = self.start.u + self.alpha0 - 2.0 * self.xi * self.sigma();
        let z0 = self.start.w + self.sigma();
        Sinusoid::from_start(self.xi, y0, z0)
    }

    /// The damped sinusoid in `w`.
    fn velocity(&self) -> Sinusoid {
        self.displacement().derivative()
    }

    /// Raises the peak of |w| by those inside the interval: where `w'`, a damped sinusoid, is 0.
    pub fn velocity_peaks(&self, end: State, sv: &mut f64) {
        let slope = |s: State, alpha: f64| -s.u - 2.0 * self.xi * s.w - alpha;
        let dw = [slope(self.start, self.alpha0), slope(end, self.alpha1)];
        if self.theta >= PI || dw[0] * dw[1] <= 0.0 {
            self.velocity().turns(self.theta, |tau| *sv = sv.max(self.at(tau).w.abs()));
        }
    }

    /// Raises the peaks of |u| and |u + 2ξw| by those inside the interval.
    ///
    /// `u` is extreme where `w = 0`, and `w` is monotone between the zeros of `w'`, a damped
    /// sinusoid without a constant, whose zeros are known. The same holds of `u + 2ξw`, whose
    /// derivative is `w + 2ξw'`. Below half a period at most one such zero lies inside, and signs
    /// at the two ends say whether there can be an extreme.
    pub fn peaks(&self, end: State, sd: &mut f64, sa: &mut f64) {
        let (xi, sigma) = (self.xi, self.sigma());
        let slope = |s: State, alpha: f64| -s.u - 2.0 * xi * s.w - alpha;
        let w = [self.start.w, end.w];
        let dw = [slope(self.start, self.alpha0), slope(end, self.alpha1)];
        if self.theta >= PI || may_vanish(w, dw) {
            let velocity = self.velocity();
            velocity.zeros_with(-sigma, self.theta, |tau| *sd = sd.max(self.at(tau).u.abs()));
        }
        let ddw = [0, 1].map(|i| -w[i] - 2.0 * xi * dw[i] - sigma);
        let g = [0, 1].map(|i| w[i] + 2.0 * xi * dw[i]);
        let dg = [0, 1].map(|i| dw[i] + 2.0 * xi * ddw[i]);
        if self.theta >= PI || may_vanish(g, dg) {
            let velocity = self.velocity();
            let rate = velocity.plus(2.0 * xi, velocity.derivative());
            rate.zeros_with(-sigma, self.theta, |tau| {
                let s = self.at(tau);
                *sa = sa.max((s.u + 2.0 * xi * s.w).abs());
            });
        }
    }

    /// State at a phase inside.
    fn at(&self, tau: f64) -> State {
        let alpha = self.alpha0 + (self.alpha1 - self.alpha0) * (tau / self.theta);
        Step::new(tau, self.xi).apply(self.start, self.alpha0, alpha)
    }
}

/// Whether a function with these values and slopes at the ends of an interval can be 0 inside, if
/// its slope changes sign at most once: its ends differ in sign, or it turns on the way to 0.
fn may_vanish(value: [f64; 2], slope: [f64; 2]) -> bool {
    value[0] * value[1] <= 0.0 || (slope[0] * slope[1] <= 0.0 && value[0] * slope[0] <= 0.0)
}

/// `e^(−ξτ) (p cos ω_d τ + q sin ω_d τ)` with `ω_d = √(1 − ξ²)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sinusoid {
    xi: f64,
    omega_d: f64,
    p: f64,
    q: f64,
}

impl Sinusoid {
    /// The one with value `y0` and slope `z0` at 0.
    pub fn from_start(xi: f64, y0: f64, z0: f64) -> Self {
        let omega_d = libm::sqrt((1.0 - xi) * (1.0 + xi));
        Self { xi, omega_d, p: y0, q: (z0 + xi * y0) / omega_d }
    }

    pub fn derivative(self) -> Self {
        let Self { xi, omega_d, p, q } = self;
        Self { p: omega_d * q - xi * p, q: -omega_d * p - xi * q, ..self }
    }

    /// This one plus `factor` times another of the same damping.
    fn plus(self, factor: f64, other: Self) -> Self {
        Self { p: self.p + factor * other.p, q: self.q + factor * other.q, ..self }
    }

    pub fn at(&self, tau: f64) -> f64 {
        let phase = self.omega_d * tau;
        libm::exp(-self.xi * tau) * (self.p * libm::cos(phase) + self.q * libm::sin(phase))
    }

    /// Calls `found` at each phase in `(0, theta)` where the slope is 0.
    pub fn turns(&self, theta: f64, mut found: impl FnMut(f64)) {
        let slope = self.derivative();
        let first = libm::atan2(-slope.p, slope.q);
        let mut turn = first - PI * libm::floor(first / PI);
        while turn < self.omega_d * theta {
            found(turn / self.omega_d);
            turn += PI;
        }
    }

    /// Calls `found` at each phase in `(0, theta)` where this plus `constant` changes sign.
    fn zeros_with(&self, constant: f64, theta: f64, mut found: impl FnMut(f64)) {
        let slope = self.derivative();
        // Zeros of the slope: p cos φ + q sin φ = 0 at φ = atan2(−p, q) + kπ.
        let first = libm::atan2(-slope.p, slope.q);
        let mut turn = first - PI * libm::floor(first / PI);
        let value = |tau: f64| self.at(tau) + constant;
        let (mut left, mut at_left) = (0.0, value(0.0));
        while left < theta {
            let right = (turn / self.omega_d).min(theta);
            turn += PI;
            if right <= left {
                continue;
            }
            let at_right = value(right);
            if at_left * at_right < 0.0 {
                found(root(value, left, right, at_left));
            } else if at_right == 0.0 && right < theta {
                found(right);
            }
            (left, at_left) = (right, at_right);
        }
    }
}

/// Root of a function that is monotone between `left` and `right` and changes sign there.
///
/// Near an extreme the value is quadratic in the error of the root, which 1e-9 of the interval
/// makes smaller than rounding. Regula falsi with the Illinois rule, at most 100 steps.
fn root(value: impl Fn(f64) -> f64, left: f64, right: f64, at_left: f64) -> f64 {
    let (mut a, mut b, mut fa, mut fb) = (left, right, at_left, value(right));
    for _ in 0..100 {
        let c = b - fb * ((b - a) / (fb - fa));
        let c = if c > a.min(b) && c < a.max(b) { c } else { 0.5 * (a + b) };
        let fc = value(c);
        if fc == 0.0 || (b - a).abs() <= 1e-9 * (right - left) || (c - b).abs() <= 1e-12 * right {
            return c;
        }
        if fc * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (c, fc);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Series and closed form are two derivations of one matrix.
    #[test]
    fn exact_series_and_closed_form_agree() {
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
}
