//! The motion near rest: by powers of `τ`, `dt = |w| dτ`, with `w = z²` as complex numbers.
//!
//! ```text
//! z' = (p z̄ − f z)/2    t' = |z|²    s' = |z|² z²    η' = |z|² η̇    η̇' = −|z|² g − Lᵀ (|z|² P − f z²)
//! ```
//!
//! The right sides are polynomials: nothing is singular at `w = 0`, and rest is `τ → ∞`.

use super::series::{Kind, Series, product, square};
use super::system::{Loads, State, System};
use super::terms::Scales;
use super::vector::norm;
use crate::linear::polynomial::{DEGREE, Polynomial, value};

/// Radians of `(f + |p|)/2` that a series of the usual degree takes.
const RADIANS: f64 = 1.6;

/// The unit of `τ` for a speed, `f + |p|` and the time that is left.
pub(super) fn unit(speed: f64, rate: f64, left_s: f64) -> f64 {
    let reach = 2.0 * RADIANS / rate;
    reach.min(4.0 * left_s / speed)
}

/// The root of `w`.
fn root([x, y]: [f64; 2]) -> [f64; 2] {
    let r = norm([x, y]);
    if x >= 0.0 {
        let a = (0.5 * (r + x)).sqrt();
        [a, 0.5 * y / a]
    } else {
        let b = (0.5 * (r - x)).sqrt();
        let b = if y < 0.0 { -b } else { b };
        [0.5 * y / b, b]
    }
}

/// Factors of the modes' series by `r`: coefficient `k` of `r x` of all modes.
#[inline(always)]
fn times(r: &Polynomial, list: &[f64], k: usize, sums: &mut [f64]) {
    let modes = sums.len();
    sums.fill(0.0);
    for i in 0..=k {
        let of_k = &list[(k - i) * modes..][..modes];
        for (sum, x) in sums.iter_mut().zip(of_k) {
            *sum += r[i] * x;
        }
    }
}

impl Series {
    /// Expands by powers of `τ`.
    pub(super) fn expand_near_rest(
        &mut self,
        system: &System,
        state: &State,
        (loads, unit): (Loads, f64),
        scales: &Scales,
        sums: &mut [f64],
    ) {
        self.begin(Kind::NearRest, state, loads, unit);
        let z = root(state.w);
        (self.root[0][0], self.root[1][0]) = (z[0], z[1]);
        let mut push = [[0.0; DEGREE + 4]; 2];
        for k in 0..=DEGREE {
            let per = unit / (k + 1) as f64;
            self.restore(system, k);
            let [a, b] = &self.root;
            let squares = [square(a, k), square(b, k)];
            self.speed[k] = squares[0] + squares[1];
            self.w[0][k] = squares[0] - squares[1];
            self.w[1][k] = 2.0 * product(a, b, k);
            self.find_slowing(system, k);
            let time = self.time[k];
            for axis in 0..2 {
                let pull = self.pull_of(system, axis, k);
                self.pull[axis][k] = pull;
                let [table, rate] = loads.table[axis];
                push[axis][k] = pull - (rate * time + if k == 0 { table } else { 0.0 });
            }
            if k == DEGREE {
                break;
            }
            // p z̄ − f z, and f w
            let ([p, q], [a, b]) = (&push, &self.root);
            let turned = [product(p, a, k) + product(q, b, k), product(q, a, k) - product(p, b, k)];
            let of_friction = [a, b].map(|z| self.slowed(system, z, k));
            let taken = [0, 1].map(|axis| self.slowed(system, &self.w[axis], k));
            let mut block = [0.0; 2];
            for axis in 0..2 {
                block[axis] = product(&self.speed, &self.pull[axis], k) - taken[axis];
                self.s[axis][k + 1] = per * product(&self.speed, &self.w[axis], k);
                self.root[axis][k + 1] = 0.5 * per * (turned[axis] - of_friction[axis]);
            }
            self.time[k + 1] = per * self.speed[k];
            self.integrate_modes(system, k, (per, block), sums);
        }
        self.degree = DEGREE;
        self.part = self.fitting_part(scales).min(1.0);
    }

    /// Coefficient `k` of `P` along an axis by powers of `τ`, in which `N` follows the time.
    #[inline(always)]
    pub(super) fn pull_of(&self, system: &System, axis: usize, k: usize) -> f64 {
        let (s, normal) = (&self.s[axis], self.loads.normal);
        let mut pressed = normal[0] * s[k];
        if normal[1] != 0.0 && system.per_radius > 0.0 {
            pressed += normal[1] * product(&self.time, s, k);
        }
        system.pull(self.shear[axis][k], s[k], self.w[axis][k], pressed)
    }

    /// Order `k + 1` of the modes by powers of `τ`: `η' = r η̇` and `η̇' = −r (g + Lᵀ b)`, of `r b`.
    #[inline(always)]
    pub(super) fn integrate_modes(
        &mut self,
        system: &System,
        k: usize,
        (per, block): (f64, [f64; 2]),
        sums: &mut [f64],
    ) {
        let modes = system.modes();
        let next = (k + 1) * modes;
        times(&self.speed, &self.rate, k, sums);
        for (into, sum) in self.eta[next..next + modes].iter_mut().zip(&*sums) {
            *into = per * sum;
        }
        times(&self.speed, &self.g, k, sums);
        for (j, sum) in sums.iter().enumerate() {
            let l = [system.participation[0][j], system.participation[1][j]];
            self.rate[next + j] = -per * (sum + l[0] * block[0] + l[1] * block[1]);
        }
    }

    /// The part at which a time is reached, none where that is beyond its end.
    pub(super) fn part_at(&self, time_s: f64) -> Option<f64> {
        let end = value(&self.time, self.part);
        if end < time_s {
            return None;
        }
        // t' = |w| > 0.
        let [mut low, mut high] = [0.0, self.part];
        let mut x = self.part * (time_s / end);
        for _ in 0..200 {
            let excess = value(&self.time, x) - time_s;
            if excess > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let next = x - excess / (self.unit * value(&self.speed, x));
            if next == x || (next - x).abs() <= 2.0 * f64::EPSILON * x {
                return Some(next.clamp(low, high));
            }
            x = if next > low && next < high { next } else { 0.5 * (low + high) };
            if x <= low || x >= high {
                break;
            }
        }
        Some(high)
    }
}
