//! The motion by powers of the time: in stick, in slip, and in slip from rest.

use super::system::{Loads, State, System};
use super::terms::{LOW, NEGLIGIBLE, Scales, Sizes};
use super::vector::{inner, norm};
use crate::linear::polynomial::{DEGREE, Polynomial, ZERO, deflated, first_root, value};
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;

/// By what a motion is expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// `w = 0`, `b = a`.
    Stick,
    /// Slip without friction, `b = P`.
    Frictionless,
    /// Slip at `w ≠ 0`.
    Slip,
    /// Slip from `w = 0` along `p`, `|p| ≥ f`.
    Start,
    /// Slip in the variable `τ`, `dt = |w| dτ`.
    NearRest,
    /// The same by `|w|` and `u`, of a block with a mass in each direction.
    Turning,
}

/// The motion from an instant on, by powers of a variable over its unit.
pub(super) struct Series {
    pub(super) kind: Kind,
    instructions: InstructionSet,
    pub(super) modes: usize,
    pub(super) loads: Loads,
    /// Unit of the variable: in s, of `τ` in s²/m.
    pub(super) unit: f64,
    /// What of it is exact.
    pub(super) part: f64,
    /// The last order that is more than rounding.
    pub(super) degree: usize,
    /// The time in s, `|w|`, and near rest the root of `w` as a complex number.
    pub(super) time: Polynomial,
    pub(super) speed: Polynomial,
    pub(super) root: [Polynomial; 2],
    pub(super) s: [Polynomial; 2],
    pub(super) w: [Polynomial; 2],
    /// `P`, and what friction takes of it, `f u`: in stick `p`; not near rest.
    pub(super) pull: [Polynomial; 2],
    pub(super) friction: [Polynomial; 2],
    /// `μ_k/M1` and `f` in slip.
    pub(super) kinetic_per_kg: Polynomial,
    pub(super) slowing: Polynomial,
    /// `u` in slip; not near rest.
    pub(super) direction: [Polynomial; 2],
    pub(super) shear: [Polynomial; 2],
    /// `η`, `η̇` and `g`, order by order.
    pub(super) eta: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) g: Vec<f64>,
}

/// `Σ a_j b_{n−1−j}` over lists of length n.
#[inline(always)]
pub(super) fn convolved(a: &[f64], b: &[f64]) -> f64 {
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

/// Coefficient `k` of a product.
#[inline(always)]
pub(super) fn product(a: &Polynomial, b: &Polynomial, k: usize) -> f64 {
    convolved(&a[..=k], &b[..=k])
}

/// Coefficient `k` of a square.
#[inline(always)]
pub(super) fn square(a: &Polynomial, k: usize) -> f64 {
    let half = k.div_ceil(2);
    let sides = convolved(&a[..half], &a[k + 1 - half..=k]);
    let middle = if k.is_multiple_of(2) { a[k / 2] * a[k / 2] } else { 0.0 };
    2.0 * sides + middle
}

/// A start by components along and across `p` at its beginning.
#[derive(Default)]
pub(super) struct Along {
    pub(super) axes: [[f64; 2]; 2],
    pub(super) cosine: Polynomial,
    pub(super) sine: Polynomial,
    pub(super) w: [Polynomial; 2],
}

impl Series {
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
            time: ZERO,
            speed: ZERO,
            root: pair(),
            s: pair(),
            w: pair(),
            pull: pair(),
            friction: pair(),
            kinetic_per_kg: ZERO,
            slowing: ZERO,
            direction: pair(),
            shear: pair(),
            eta: list(),
            rate: list(),
            g: list(),
        }
    }

    /// Begins anew at a state.
    pub(super) fn begin(&mut self, kind: Kind, state: &State, loads: Loads, unit: f64) {
        let modes = state.eta.len();
        (self.kind, self.loads, self.unit) = (kind, loads, unit);
        let lists = [&mut self.s, &mut self.w, &mut self.pull, &mut self.friction, &mut self.shear];
        lists.into_iter().for_each(|list| *list = [ZERO; 2]);
        match kind {
            Kind::Slip | Kind::Start | Kind::Turning => self.direction = [ZERO; 2],
            Kind::NearRest => self.root = [ZERO; 2],
            Kind::Stick | Kind::Frictionless => {}
        }
        (self.time, self.speed) = (ZERO, ZERO);
        (self.kinetic_per_kg, self.slowing) = (ZERO, ZERO);
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
    pub(super) fn restore(&mut self, system: &System, k: usize) {
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
        self.time[1] = unit_s;
        let normal = [loads.normal[0], loads.normal[1] * unit_s];
        let mut along = Along::default();
        self.degree = DEGREE;
        let mut sizes = Sizes::default();
        for k in 0..=DEGREE {
            self.restore(system, k);
            for axis in 0..2 {
                let s = &self.s[axis];
                let before = if k > 0 { s[k - 1] } else { 0.0 };
                let pressed = normal[0] * s[k] + normal[1] * before;
                self.pull[axis][k] =
                    system.pull(self.shear[axis][k], s[k], self.w[axis][k], pressed);
            }
            self.find_friction(system, &mut along, k);
            if k >= LOW && sizes.are_negligible(self, scales, k) {
                self.degree = k;
                break;
            }
            if k < DEGREE {
                self.integrate(system, k);
            }
        }
        self.fit(scales);
    }

    /// Coefficient `k` of `a`.
    #[inline(always)]
    pub(super) fn table(&self, axis: usize, k: usize) -> f64 {
        match k {
            0 => self.loads.table[axis][0],
            1 => self.loads.table[axis][1] * self.unit,
            _ => 0.0,
        }
    }

    /// Coefficient `k` of `p`, where the variable is the time.
    #[inline(always)]
    pub(super) fn push(&self, system: &System, k: usize) -> [f64; 2] {
        let pull = [self.pull[0][k], self.pull[1][k]];
        system.push(pull, [self.table(0, k), self.table(1, k)])
    }

    /// Coefficient `k` of `f u`, or of `p` in stick.
    #[inline(always)]
    fn find_friction(&mut self, system: &System, along: &mut Along, k: usize) {
        match self.kind {
            Kind::Frictionless | Kind::NearRest | Kind::Turning => return,
            Kind::Stick => {
                let push = self.push(system, k);
                (self.friction[0][k], self.friction[1][k]) = (push[0], push[1]);
                return;
            }
            Kind::Slip => {
                self.find_direction(k);
                self.find_slowing(system, k);
            }
            Kind::Start => match &system.mass {
                None => self.find_start(system, along, k),
                Some(mass) => self.find_start_of(system, mass, along, k),
            },
        }
        for axis in 0..2 {
            self.friction[axis][k] = self.slowed(system, &self.direction[axis], k);
        }
    }

    /// Coefficient `k` of `f = μ_k N/M1`, from `|w|` and the time up to `k`.
    #[inline(always)]
    pub(super) fn find_slowing(&mut self, system: &System, k: usize) {
        let [normal, rate] = self.loads.normal;
        let law = &system.kinetic_per_kg;
        self.kinetic_per_kg[k] = law.expand(&self.speed, &self.kinetic_per_kg, k);
        let change = match rate {
            0.0 => 0.0,
            rate if law.is_constant() => rate * self.kinetic_per_kg[0] * self.time[k],
            rate => rate * product(&self.kinetic_per_kg, &self.time, k),
        };
        self.slowing[k] = normal * self.kinetic_per_kg[k] + change;
    }

    /// Coefficient `k` of `f` times a series.
    #[inline(always)]
    pub(super) fn slowed(&self, system: &System, of: &Polynomial, k: usize) -> f64 {
        let f = &self.slowing;
        if !system.kinetic_per_kg.is_constant() {
            return product(f, of, k);
        }
        match self.kind {
            Kind::NearRest | Kind::Turning if self.loads.normal[1] != 0.0 => product(f, of, k),
            // Linear in the time.
            _ if k > 0 => f[0] * of[k] + f[1] * of[k - 1],
            _ => f[0] * of[0],
        }
    }

    /// `r² = w·w` and `r u = w`.
    #[inline(always)]
    fn find_direction(&mut self, k: usize) {
        let w = &self.w;
        if k == 0 {
            let r = norm([w[0][0], w[1][0]]);
            self.speed[0] = r;
            for axis in 0..2 {
                self.direction[axis][0] = w[axis][0] / r;
            }
            return;
        }
        // 2 r_0 r_k = (w·w)_k − Σ_{0<j<k} r_j r_{k−j}
        let r = &self.speed;
        let per_speed = 1.0 / r[0];
        let within = if k > 1 { convolved(&r[1..k], &r[1..k]) } else { 0.0 };
        let r_k = 0.5 * per_speed * ((square(&w[0], k) + square(&w[1], k)) - within);
        self.speed[k] = r_k;
        // r_0 u_k = w_k − Σ_{0<j≤k} r_j u_{k−j}
        for axis in 0..2 {
            let u = &self.direction[axis];
            let rest = convolved(&self.speed[1..=k], &u[..k]);
            self.direction[axis][k] = per_speed * (w[axis][k] - rest);
        }
    }

    /// The derivatives of an order.
    #[inline(always)]
    fn integrate(&mut self, system: &System, k: usize) {
        let (modes, per) = (system.modes(), self.unit / (k + 1) as f64);
        let force = [0, 1].map(|axis| self.pull[axis][k] - self.friction[axis][k]);
        let mut block = system.moved(force);
        for axis in 0..2 {
            let table = self.table(axis, k);
            if self.kind == Kind::Stick {
                block[axis] = table;
                continue;
            }
            self.s[axis][k + 1] = per * self.w[axis][k];
            self.w[axis][k + 1] = per * (block[axis] - table);
        }
        if self.kind == Kind::Start && k == 0 {
            // w_1 = r_1 u_0, where the difference above is rounding.
            for axis in 0..2 {
                self.w[axis][1] = self.speed[1] * self.direction[axis][0];
            }
        }
        let (at, next) = (k * modes, (k + 1) * modes);
        for j in 0..modes {
            let l = [system.participation[0][j], system.participation[1][j]];
            self.eta[next + j] = per * self.rate[at + j];
            self.rate[next + j] = -per * (self.g[at + j] + inner(l, block));
        }
    }

    /// How much of the unit the last terms allow, and that the direction is that of `w` on all of it; NaN where
    /// the terms are beyond all numbers, over a unit far too long.
    fn fit(&mut self, scales: &Scales) {
        let mut part = self.fitting_part(scales);
        if matches!(self.kind, Kind::Slip | Kind::Start) {
            if !self.is_finite() {
                self.part = f64::NAN;
                return;
            }
            // |w| > 0 on all of it.
            let order = self.speed.iter().position(|r| *r != 0.0).unwrap_or(0);
            let speed = deflated(&self.speed, order);
            let end = part.min(1.0);
            if let Some(root) = first_root(&up_to(&speed, end), 1.0) {
                part = part.min(0.5 * root * end);
            }
            for _ in 0..60 {
                if self.is_true_at(part.min(1.0)) {
                    break;
                }
                part *= 0.5;
            }
        }
        self.part = part.min(1.0);
    }

    /// Whether no term has overflown: what has, does so in all orders that follow.
    fn is_finite(&self) -> bool {
        let lists = [&self.w, &self.direction, &self.friction];
        let terms = lists.into_iter().flatten().map(|list| list[self.degree]);
        terms.chain([self.speed[self.degree]]).sum::<f64>().is_finite()
    }

    /// Whether `u` is that of `w`.
    fn is_true_at(&self, x: f64) -> bool {
        let [w, u] = [&self.w, &self.direction].map(|v| [value(&v[0], x), value(&v[1], x)]);
        let r = norm(w);
        (0..2).all(|axis| (u[axis] * r - w[axis]).abs() <= 1e-12 * r)
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
        if self.kind == Kind::NearRest {
            // w = z²
            let [a, b] = [value(&self.root[0], x), value(&self.root[1], x)];
            return [(a - b) * (a + b), 2.0 * a * b];
        }
        [value(&self.w[0], x), value(&self.w[1], x)]
    }
}

/// A polynomial in parts of a first part of its unit: beyond that its terms say nothing.
fn up_to(c: &Polynomial, end: f64) -> Polynomial {
    let mut scaled = *c;
    let mut power = 1.0;
    for c in &mut scaled {
        *c *= power;
        power *= end;
    }
    scaled
}
