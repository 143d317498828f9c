//! The motion by powers of the time, in stick and in slip: linear once the force of friction is known.

use super::rows::Rows;
use super::system::{Loads, State, System};
use super::terms::{NEGLIGIBLE, Scales, Sizes, lowest};
use super::vector::inner;
use crate::linear::polynomial::{DEGREE, Polynomial, ZERO, value};
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;

/// By what a motion is expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// `w = 0`, `b = a`.
    Stick,
    /// Slip without friction, `b = C P`.
    Frictionless,
    /// Slip under a given force of friction.
    Slip,
}

/// The motion from an instant on, by powers of the time over a unit in s.
pub(super) struct PlaneSeries {
    pub(super) kind: Kind,
    pub(super) instructions: InstructionSet,
    pub(super) modes: usize,
    pub(super) loads: Loads,
    pub(super) unit: f64,
    /// What of it is exact.
    pub(super) part: f64,
    /// The last order that is more than rounding.
    pub(super) degree: usize,
    pub(super) s: [Polynomial; 2],
    pub(super) w: [Polynomial; 2],
    pub(super) pull: [Polynomial; 2],
    /// In stick `p`; in slip what friction takes, by the polynomial through its values at the nodes.
    pub(super) friction: [Polynomial; 2],
    /// In slip: `u` at the start, and the last of Legendre's coefficients of that polynomial.
    pub(super) from: [f64; 2],
    pub(super) tail: f64,
    pub(super) shear: [Polynomial; 2],
    /// What the stop around the block takes over `M1`, which is given.
    pub(super) stopped: [Polynomial; 2],
    /// The sign of the turn about the centre in which a block goes along a stop that does not give way.
    pub(super) along_stop: Option<f64>,
    /// `η`, `η̇` and `g`, order by order.
    pub(super) eta: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) g: Vec<f64>,
}

/// `Σ a_j b_{n−1−j}` over lists of length n.
#[inline(always)]
fn convolved(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len();
    let b = &b[..n];
    let mut sums = [0.0; 4];
    let fours = n / 4;
    for four in 0..fours {
        let j = 4 * four;
        let (x, y) = (&a[j..j + 4], &b[n - 4 - j..n - j]);
        sums[0] += x[0] * y[3];
        sums[1] += x[1] * y[2];
        sums[2] += x[2] * y[1];
        sums[3] += x[3] * y[0];
    }
    for j in 4 * fours..n {
        sums[j - 4 * fours] += a[j] * b[n - 1 - j];
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Coefficient `k` of a square.
#[inline(always)]
pub(super) fn square(a: &Polynomial, k: usize) -> f64 {
    let half = k.div_ceil(2);
    let sides = convolved(&a[..half], &a[k + 1 - half..=k]);
    let middle = if k.is_multiple_of(2) { a[k / 2] * a[k / 2] } else { 0.0 };
    2.0 * sides + middle
}

impl PlaneSeries {
    pub(super) fn new(system: &System, instructions: InstructionSet) -> Self {
        let list = || vec![0.0; system.modes() * (DEGREE + 1)];
        let pair = || [ZERO; 2];
        Self {
            kind: Kind::Stick,
            instructions,
            modes: system.modes(),
            loads: Loads { table: [[0.0; 2]; 2], normal: [0.0; 2] },
            unit: 0.0,
            part: 0.0,
            degree: 0,
            s: pair(),
            w: pair(),
            pull: pair(),
            friction: pair(),
            from: [0.0; 2],
            tail: 0.0,
            shear: pair(),
            stopped: pair(),
            along_stop: None,
            eta: list(),
            rate: list(),
            g: list(),
        }
    }

    /// Begins anew at a state; in slip the force of friction is what has been given.
    fn begin(&mut self, kind: Kind, state: &State, loads: Loads, unit: f64) {
        let modes = state.eta.len();
        (self.kind, self.loads, self.unit) = (kind, loads, unit);
        let lists = [&mut self.s, &mut self.w, &mut self.pull, &mut self.shear];
        lists.into_iter().for_each(|list| *list = [ZERO; 2]);
        if kind != Kind::Slip {
            self.friction = [ZERO; 2];
        }
        for k in 0..2 {
            (self.s[k][0], self.w[k][0]) = (state.s[k], state.w[k]);
        }
        self.eta[..modes].copy_from_slice(&state.eta);
        self.rate[..modes].copy_from_slice(&state.rate);
    }

    /// `|p|²` of a stick, from which the release is found: coefficient `k` as a size.
    pub(super) fn push_squared(&self, k: usize) -> f64 {
        (square(&self.friction[0], k) + square(&self.friction[1], k)).abs()
    }

    /// `g` and the shear of an order, from the states of that order.
    #[inline(always)]
    fn restore(&mut self, system: &System, k: usize) {
        let modes = system.modes();
        let at = k * modes..(k + 1) * modes;
        system.restoring(&self.eta[at.clone()], &self.rate[at.clone()], &mut self.g[at.clone()]);
        let shear_n = system.shear_n(&self.g[at]);
        (self.shear[0][k], self.shear[1][k]) = (shear_n[0], shear_n[1]);
    }

    /// Expands by powers of the time over a unit in s; what of it is exact is at most 1.
    pub(super) fn expand(
        &mut self,
        system: &System,
        of: (Kind, &State),
        over: (Loads, f64),
        scales: &Scales,
    ) {
        vectorize!(self.instructions, _simd => self.expand_here(system, of, over, scales));
    }

    #[inline(always)]
    fn expand_here(
        &mut self,
        system: &System,
        (kind, state): (Kind, &State),
        (loads, unit_s): (Loads, f64),
        scales: &Scales,
    ) {
        self.begin(kind, state, loads, unit_s);
        let normal = [loads.normal[0], loads.normal[1] * unit_s];
        self.degree = DEGREE;
        let mut sizes = Sizes::default();
        for k in 0..=DEGREE {
            self.restore(system, k);
            for axis in 0..2 {
                let s = &self.s[axis];
                let before = if k > 0 { s[k - 1] } else { 0.0 };
                let pressed = normal[0] * s[k] + normal[1] * before;
                self.pull[axis][k] =
                    system.pull(self.shear[axis][k], s[k], self.w[axis][k], pressed)
                        - self.stopped[axis][k];
            }
            if kind == Kind::Stick {
                let push = self.push(system, k);
                (self.friction[0][k], self.friction[1][k]) = (push[0], push[1]);
            }
            if k >= lowest(kind) && sizes.are_negligible(self, scales, k) {
                self.degree = k;
                break;
            }
            if k < DEGREE {
                self.integrate(system, k);
            }
        }
        self.part = self.fitting_part(scales).min(1.0);
    }

    /// Coefficient `k` of `a`.
    #[inline(always)]
    fn table(&self, axis: usize, k: usize) -> f64 {
        match k {
            0 => self.loads.table[axis][0],
            1 => self.loads.table[axis][1] * self.unit,
            _ => 0.0,
        }
    }

    /// Coefficient `k` of `p`.
    #[inline(always)]
    fn push(&self, system: &System, k: usize) -> [f64; 2] {
        let pull = [self.pull[0][k], self.pull[1][k]];
        system.push(pull, [self.table(0, k), self.table(1, k)])
    }

    /// The derivatives of an order.
    #[inline(always)]
    fn integrate(&mut self, system: &System, k: usize) {
        let (modes, per) = (system.modes(), self.unit / (k + 1) as f64);
        let is_stuck = self.kind == Kind::Stick;
        let mut block = [self.table(0, k), self.table(1, k)];
        if !is_stuck {
            let table = block;
            block = system.moved([0, 1].map(|axis| self.pull[axis][k] - self.friction[axis][k]));
            for axis in 0..2 {
                self.s[axis][k + 1] = per * self.w[axis][k];
                self.w[axis][k + 1] = per * (block[axis] - table[axis]);
            }
        }
        let (at, next) = (k * modes, (k + 1) * modes);
        for j in 0..modes {
            let l = [system.participation[0][j], system.participation[1][j]];
            self.eta[next + j] = per * self.rate[at + j];
            self.rate[next + j] = -per * (self.g[at + j] + inner(l, block));
        }
    }

    /// How much of the unit the last terms allow, perhaps above 1.
    pub(super) fn fitting_part(&self, scales: &Scales) -> f64 {
        let k = self.degree;
        if k < DEGREE {
            return 1.0;
        }
        let sizes = Sizes::of(self, scales);
        let root = |k: usize| {
            let term = sizes.term(self, k);
            if term > NEGLIGIBLE { libm::pow(NEGLIGIBLE / term, 1.0 / k as f64) } else { 4.0 }
        };
        root(k - 1).min(root(k))
    }

    /// How far each mode's series of a list departs from its chord over a part of the unit at most.
    pub(super) fn bends(&self, list: &[f64], to: f64, bends: &mut [f64]) {
        bends.fill(0.0);
        for k in (2..=self.degree).rev() {
            let factor = 0.125 * (k * (k - 1)) as f64;
            let of_k = &list[k * self.modes..][..self.modes];
            for (bend, c) in bends.iter_mut().zip(of_k) {
                *bend = *bend * to + factor * c.abs();
            }
        }
        bends.iter_mut().for_each(|bend| *bend *= to * to);
    }

    /// What a row along x and y makes of a list of the modes.
    pub(super) fn combined(
        &self,
        (of, point, list): (&[Rows; 2], usize, &[f64]),
    ) -> [Polynomial; 2] {
        of.each_ref().map(|rows| rows.series(point, self.modes, list, self.degree))
    }

    /// The state at a part of the unit.
    pub(super) fn state_at(&self, x: f64, state: &mut State) {
        if self.kind != Kind::Stick {
            for axis in 0..2 {
                state.s[axis] = value(&self.s[axis], x);
            }
            state.w = self.velocity_at(x);
        }
        let modes = state.eta.len();
        for (into, list) in [(&mut state.eta, &self.eta), (&mut state.rate, &self.rate)] {
            for (j, into) in into.iter_mut().enumerate() {
                let mut sum = 0.0;
                for k in (0..=self.degree).rev() {
                    sum = sum * x + list[k * modes + j];
                }
                *into = sum;
            }
        }
    }

    /// `w`.
    pub(super) fn velocity_at(&self, x: f64) -> [f64; 2] {
        [value(&self.w[0], x), value(&self.w[1], x)]
    }
}
