//! What moves with the block, where it is not as much along x as along y or joins both.
//!
//! With the mass `A` over a number `M1`, `Ĉ = A/M1` and `C = Ĉ⁻¹`, all forces over `M1`:
//!
//! ```text
//! push  p = P − Ĉ a        stick while |p| ≤ μ_s N/M1        slip  ẇ = C (p − f u)
//! ```
//!
//! Friction is as it is of one mass, along the velocity and in its circle; the acceleration is along neither.

use super::vector::{cross, inner, norm};

/// A matrix by its rows.
pub(super) type Matrix = [[f64; 2]; 2];

/// `A x`.
#[inline(always)]
pub(super) fn times(matrix: &Matrix, x: [f64; 2]) -> [f64; 2] {
    matrix.map(|row| row[0] * x[0] + row[1] * x[1])
}

/// Steps of a turn in which it is followed to rest, in radians.
const TURN: f64 = 0.01;

/// Sine of the angle between `w` and `−p` below which a motion is straight.
pub(super) const STRAIGHT: f64 = 1e-6;

/// Part of the speed to which a way to rest is followed.
const FOLLOWED: f64 = 1e-9;

/// Parts of a full turn that are looked at for the last direction of a slip: it turns no more at four of them at most.
const LOOKS: usize = 512;

/// Most steps of that.
const MOST_STEPS: usize = 20_000;

/// `Ĉ`, symmetric and positive, and `C`.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Mass {
    pub(super) relative: Matrix,
    pub(super) inverse: Matrix,
}

impl Mass {
    /// Of what moves with the block over a mass, in kg.
    pub(super) fn new(of_kg: Matrix, block_kg: f64) -> Self {
        let relative = of_kg.map(|row| row.map(|m| m / block_kg));
        let [[a, b], [_, d]] = relative;
        let per = 1.0 / (a * d - b * b);
        Self { relative, inverse: [[d * per, -b * per], [-b * per, a * per]] }
    }

    /// The largest eigenvalue of `C`.
    pub(super) fn compliance(&self) -> f64 {
        largest(&self.inverse)
    }

    /// The largest eigenvalue of `Ĉ`.
    pub(super) fn inertia(&self) -> f64 {
        largest(&self.relative)
    }

    /// How a slip begins under a push `|p| ≥ f`: along `u` with `ẇ = ρ u`, of which both follow from
    ///
    /// ```text
    /// (ρ Ĉ + f) u = p,   |u| = 1
    /// ```
    ///
    /// whose left side grows with ρ.
    pub(super) fn departure(&self, push: [f64; 2], friction: f64) -> ([f64; 2], f64) {
        if friction == 0.0 {
            let rate = times(&self.inverse, push);
            let size = norm(rate);
            return (rate.map(|x| x / size), size);
        }
        // The first is not above the root, the second not below.
        let beyond = norm(push) - friction;
        let (mut low, mut high) = (beyond.max(0.0) / self.inertia(), beyond * self.compliance());
        let of = |rho: f64| {
            let [[a, b], [_, d]] = self.relative;
            let [a, b, d] = [rho * a + friction, rho * b, rho * d + friction];
            let per = 1.0 / (a * d - b * b);
            [(d * push[0] - b * push[1]) * per, (a * push[1] - b * push[0]) * per]
        };
        if !(high > 0.0) {
            let size = norm(push);
            return (push.map(|x| x / size), 0.0);
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if norm(of(middle)) > 1.0 { low = middle } else { high = middle }
        }
        let u = of(high);
        let size = norm(u);
        (u.map(|x| x / size), high)
    }

    /// How a direction turns and a speed changes by the angle `dτ = dt/|w|`, `θ'` and `(ln |w|)'`.
    fn turns(&self, u: [f64; 2], push: [f64; 2], friction: f64) -> [f64; 2] {
        let rate = times(&self.inverse, [0, 1].map(|k| push[k] - friction * u[k]));
        [cross(u, rate), inner(u, rate)]
    }

    /// Whether a slip against a push is straight: it hardly turns, and what it turns grows.
    pub(super) fn is_straight(&self, u: [f64; 2], push: [f64; 2], friction: f64) -> bool {
        let across = [-u[1], u[0]];
        let [of_push, of_u, of_across] = [push, u, across].map(|x| times(&self.inverse, x));
        // Of u × C (p − f u), and its slope.
        let turn = cross(u, of_push) - friction * cross(u, of_u);
        let slope = cross(across, of_push) - friction * (cross(across, of_u) + cross(u, of_across));
        slope > 0.0 && turn.abs() < STRAIGHT * (norm(of_push) + friction * cross(u, of_u).abs())
    }

    /// The direction to which a slip turns under a push that lasts, at the latest at rest: the first at which it turns no
    /// more, `u × C (p − f u) = 0`, on the side to which it turns. However little it turns until its speed is below
    /// all that counts, at rest it has turned to that.
    pub(super) fn last_direction(&self, from: [f64; 2], push: [f64; 2], friction: f64) -> [f64; 2] {
        let first = libm::atan2(from[1], from[0]);
        let at = |turned: f64| [libm::cos(first + turned), libm::sin(first + turned)];
        let turn = |turned: f64| self.turns(at(turned), push, friction)[0];
        let side = turn(0.0);
        if side == 0.0 {
            return from;
        }
        let step = (core::f64::consts::TAU / LOOKS as f64).copysign(side);
        let goes_on = |turned: f64| turn(turned) * side > 0.0;
        let Some(beyond) = (1..LOOKS).find(|i| !goes_on(step * *i as f64)) else { return from };
        let [mut low, mut high] = [beyond - 1, beyond].map(|i| step * i as f64);
        loop {
            let middle = 0.5 * (low + high);
            if middle == low || middle == high {
                return at(high);
            }
            if goes_on(middle) { low = middle } else { high = middle }
        }
    }

    /// The time to rest of a slip under a push that lasts, `|p| < f`: there is no closed form as there is for one mass.
    pub(super) fn time_to_rest(&self, w: [f64; 2], push: [f64; 2], friction: f64) -> f64 {
        let (mut angle, mut log, mut time) = (libm::atan2(w[1], w[0]), 0.0_f64, 0.0_f64);
        let speed = norm(w);
        let at = |angle: f64| [libm::cos(angle), libm::sin(angle)];
        let rates = |angle: f64, log: f64| {
            let [turn, growth] = self.turns(at(angle), push, friction);
            [turn, growth, libm::exp(log)]
        };
        let step = TURN / (self.compliance() * (friction + norm(push)));
        let last = libm::log(FOLLOWED);
        for _ in 0..MOST_STEPS {
            if log < last {
                break;
            }
            // The classical rule of fourth order.
            let a = rates(angle, log);
            let b = rates(angle + 0.5 * step * a[0], log + 0.5 * step * a[1]);
            let c = rates(angle + 0.5 * step * b[0], log + 0.5 * step * b[1]);
            let d = rates(angle + step * c[0], log + step * c[1]);
            let mean = |k: usize| (a[k] + 2.0 * (b[k] + c[k]) + d[k]) / 6.0;
            angle += step * mean(0);
            log += step * mean(1);
            time += step * mean(2);
        }
        let [_, slowing] = self.turns(at(angle), push, friction);
        let left = if slowing < 0.0 { libm::exp(log) / -slowing } else { 0.0 };
        speed * (time + left)
    }
}

/// The larger eigenvalue of a symmetric matrix.
fn largest(&[[a, b], [_, d]]: &Matrix) -> f64 {
    0.5 * (a + d) + libm::hypot(0.5 * (a - d), b)
}
