//! What moves with the block in a plane: a mass in every direction, which may join x and y, and the oscillators that
//! the modes of a structure are.
//!
//! With `A` over a mass, `push = (forces − A a)` over it and `u = w/|w|`:
//!
//! ```text
//! stick  |push| ≤ μ_s N/M1        slip  A ẇ = push − f u
//! ```

use super::frame::{Pair, cross, dot, norm, times, unit};
use crate::model::Structure;

/// Part of a radian by which a way to rest is followed, and by which the end of its turn is looked for.
const STEP: f64 = 0.1;
const LOOK: f64 = 0.02;
/// Radians of a step by which a slip that comes to rest turns no more.
const STRAIGHT: f64 = 1e-10;
/// Part of the speed to which its time is told.
const FOLLOWED: f64 = 1e-10;
const MOST_STEPS: usize = 10_000;

/// `A` over the mass of the block, and its inverse.
#[derive(Clone, Copy)]
pub(super) struct Body {
    rows: [Pair; 2],
    inverse: [Pair; 2],
    /// Whether it is the identity.
    is_one: bool,
}

fn product(rows: &[Pair; 2], x: Pair) -> Pair {
    [dot(rows[0], x), dot(rows[1], x)]
}

/// The larger eigenvalue of a symmetric matrix.
fn larger_eigenvalue(&[[a, b], [_, d]]: &[Pair; 2]) -> f64 {
    0.5 * (a + d) + libm::hypot(0.5 * (a - d), b)
}

impl Body {
    /// One mass.
    pub(super) const ONE: Self =
        Self { rows: [[1.0, 0.0], [0.0, 1.0]], inverse: [[1.0, 0.0], [0.0, 1.0]], is_one: true };

    pub(super) fn new(rows: [Pair; 2]) -> Self {
        let [[a, b], [c, d]] = rows;
        let determinant = cross(rows[0], rows[1]);
        let inverse = [[d, -b], [-c, a]].map(|row| times(row, 1.0 / determinant));
        Self { rows, inverse, is_one: false }
    }

    pub(super) fn is_one(&self) -> bool {
        self.is_one
    }

    /// `A x`.
    pub(super) fn carried(&self, x: Pair) -> Pair {
        if self.is_one { x } else { product(&self.rows, x) }
    }

    /// `A⁻¹ x`.
    pub(super) fn moved(&self, x: Pair) -> Pair {
        if self.is_one { x } else { product(&self.inverse, x) }
    }

    /// Largest eigenvalue of `A⁻¹`.
    pub(super) fn most_compliant(&self) -> f64 {
        if self.is_one { 1.0 } else { larger_eigenvalue(&self.inverse) }
    }

    /// The direction in which a slip begins under a push: `(ρ A + f) u = push` for one ρ ≥ 0, by Newton's method on
    /// `1/|u| = 1`, which is concave in ρ.
    pub(super) fn departure(&self, push: Pair, slowing: f64) -> Option<Pair> {
        if self.is_one || norm(push) <= slowing {
            return unit(push);
        }
        if slowing == 0.0 {
            return unit(self.moved(push));
        }
        let mut rho = 0.0;
        let mut u = push;
        for _ in 0..100 {
            let [[a, b], [c, d]] = self.rows;
            let shifted = Self::new([[rho * a + slowing, rho * b], [rho * c, rho * d + slowing]]);
            u = product(&shifted.inverse, push);
            // d|u|/dρ = −u·(ρA + f)⁻¹A u/|u|
            let size = norm(u);
            let slope = dot(u, product(&shifted.inverse, self.carried(u))) / size;
            let step = size * (size - 1.0) / slope;
            rho += step;
            if step.abs() <= f64::EPSILON * rho {
                break;
            }
        }
        unit(u)
    }

    /// How a slip turns and slows down where the push lasts: rates of the angle and of `ln|w|` by `dτ = dt/|w|`.
    fn rates(&self, angle: f64, push: Pair, slowing: f64) -> Pair {
        let u = [libm::cos(angle), libm::sin(angle)];
        let rate = self.moved([push[0] - slowing * u[0], push[1] - slowing * u[1]]);
        [cross(u, rate), dot(u, rate)]
    }

    /// How long a slip lasts under a push that does, `|push| < f`; a bound where the way is longer than asked for.
    pub(super) fn time_to_rest(
        &self,
        w: Pair,
        push: Pair,
        slowing: f64,
        longest_m: f64,
    ) -> Option<f64> {
        let (r, p) = (norm(w), norm(push));
        if !(p < slowing) {
            return None;
        }
        let least_s = r / (self.most_compliant() * (slowing + p));
        if !(r * least_s < longest_m) {
            return Some(least_s);
        }
        // Runge and Kutta's method of fourth order.
        let step = STEP / (self.most_compliant() * (slowing + p));
        let (mut angle, mut left, mut time_s) = (libm::atan2(w[1], w[0]), 1.0_f64, 0.0);
        for _ in 0..MOST_STEPS {
            if left < FOLLOWED {
                break;
            }
            let a = self.rates(angle, push, slowing);
            if a[0].abs() * step <= STRAIGHT && a[1] < 0.0 {
                // It turns no more: its speed falls like an exponential of τ.
                time_s -= left / a[1];
                break;
            }
            let b = self.rates(angle + 0.5 * step * a[0], push, slowing);
            let c = self.rates(angle + 0.5 * step * b[0], push, slowing);
            let d = self.rates(angle + step * c[0], push, slowing);
            let [turn, slow] = [0, 1].map(|i| step / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
            let next = left * libm::exp(slow);
            // ∫ left dτ by Simpson's rule.
            let half = step / 24.0 * (5.0 * a[1] + 4.0 * (b[1] + c[1]) - d[1]);
            time_s += step / 6.0 * (left + 4.0 * left * libm::exp(half) + next);
            angle += turn;
            left = next.max(f64::MIN_POSITIVE);
        }
        Some(r * time_s)
    }

    /// The direction at which a slip turns no more under a push that lasts: rates depend on the direction alone, so it
    /// turns one way until there is none, however slow it is by then.
    pub(super) fn end_of_turn(&self, from: Pair, push: Pair, slowing: f64) -> Pair {
        let start = libm::atan2(from[1], from[0]);
        let rate = |angle: f64| self.rates(angle, push, slowing)[0];
        let first = rate(start);
        if first == 0.0 {
            return from;
        }
        let step = LOOK.copysign(first);
        let (mut before, mut after) = (start, start + step);
        while rate(after) * first > 0.0 {
            if (after - start).abs() > 2.0 * core::f64::consts::PI {
                return from;
            }
            (before, after) = (after, after + step);
        }
        // By halves: a chord may end beside the side at which it turns least.
        loop {
            let middle = 0.5 * (before + after);
            if middle == before || middle == after {
                return [libm::cos(after), libm::sin(after)];
            }
            if rate(middle) * first > 0.0 {
                before = middle;
            } else {
                after = middle;
            }
        }
    }
}

/// An oscillator on the block.
pub(super) struct Part {
    pub(super) mass_kg: f64,
    pub(super) along: Pair,
    pub(super) frequency: f64,
    pub(super) damping_ratio: f64,
}

/// The parts that the modes of a structure are: `d = η/|L|`, so that `d̈ + 2ξω ḋ + ω² d = −(L/|L|)·(s̈ + a)`.
pub(super) fn parts_of(structure: &Structure) -> Vec<Part> {
    let taking_part = structure.in_plane.iter().filter_map(|mode| {
        let along = unit(mode.participation)?;
        Some(Part {
            mass_kg: dot(mode.participation, mode.participation),
            along,
            frequency: mode.frequency_rad_per_s,
            damping_ratio: mode.damping_ratio,
        })
    });
    taking_part.collect()
}

/// How a point moves with the oscillators, `Σ φ|L| d`, and with the block, `b − Σ φ L·b`.
pub(super) struct PointOfModes {
    of_parts: Vec<Pair>,
    with_block: [Pair; 2],
}

impl PointOfModes {
    pub(super) fn all(structure: &Structure) -> Vec<Self> {
        let of = |i: usize| {
            let taking_part = || structure.in_plane.iter().filter(|m| norm(m.participation) > 0.0);
            let rest = |axis: usize, by: usize| {
                let whole = if axis == by { 1.0 } else { 0.0 };
                let given = taking_part().map(|mode| mode.points[i][axis] * mode.participation[by]);
                whole - given.sum::<f64>()
            };
            Self {
                of_parts: taking_part()
                    .map(|mode| times(mode.points[i], norm(mode.participation)))
                    .collect(),
                with_block: [[rest(0, 0), rest(0, 1)], [rest(1, 0), rest(1, 1)]],
            }
        };
        (0..structure.points.len()).map(of).collect()
    }

    /// Of the oscillators' displacements or accelerations, and the block's acceleration.
    pub(super) fn vector(&self, of_part: impl Fn(usize) -> f64, block: Pair) -> Pair {
        let start = product(&self.with_block, block);
        self.of_parts.iter().enumerate().fold(start, |[x, y], (j, factors)| {
            let value = of_part(j);
            [x + factors[0] * value, y + factors[1] * value]
        })
    }
}
