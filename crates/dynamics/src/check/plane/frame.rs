//! What is linear in two horizontal directions, and the push on the block.
//!
//! Letters as in the book: `x = (s, q)` and `v = (w, q̇)` have one pair (x, y) for the block and one a storey;
//! `p` is what drives the block over the table but for friction, `f = μ_k N/M1`, `u = w/|w|`:
//!
//! ```text
//! p = [1ᵀ(K q + C q̇) − K1 s − C1 w − N s/R]/M1 − a          ẇ = p − f u
//! q̈_i = −(K q + C q̇)_i/m_i − a − ẇ
//! ```
//!
//! A structure by its modes has one part a mode, an oscillator along a direction of its own that rides on the block. What
//! the modes lack of the mass may be other along x than along y, and join both: `carried` in [`body`](super::body).

use super::super::collocation::{Column, add};
use super::super::ground::Load;
use super::super::law::Law;
use super::super::rate::SpeedLine;
use super::super::structure::{Phase, StoreyDamping, Structure};
use super::body::{Body, PointOfModes, parts_of};
use crate::model::{Model, StopKind, Structure as ByModes};
use crate::slider::Direction;

/// A vector (x, y).
pub(super) type Pair = [f64; 2];

pub(super) fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross(a: Pair, b: Pair) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn norm(a: Pair) -> f64 {
    libm::sqrt(dot(a, a))
}

pub(super) fn times(a: Pair, factor: f64) -> Pair {
    [factor * a[0], factor * a[1]]
}

/// The direction of a vector that is not 0.
pub(super) fn unit(a: Pair) -> Option<Pair> {
    let size = norm(a);
    (size > 0.0).then(|| [a[0] / size, a[1] / size])
}

/// The vector at one of some instants.
pub(super) fn pair<const N: usize>(columns: &[Column<N>; 2], at: usize) -> Pair {
    [columns[0][at], columns[1][at]]
}

/// What the table does along x and along y at one instant, on one side of it.
pub(super) type Loads = [Load; 2];

/// `a` and `N` at some instants.
#[derive(Clone, Copy)]
pub(super) struct Under<const N: usize> {
    pub(super) a: [Column<N>; 2],
    pub(super) normal: Column<N>,
    /// Whether the block presses the stop around it.
    pub(super) pressed: bool,
}

impl Under<1> {
    pub(super) fn new(loads: &Loads, pressed: bool) -> Self {
        Self { a: loads.map(|load| [load.a]), normal: [loads[0].normal], pressed }
    }
}

/// Between two instants.
pub(super) fn between(loads: &[Loads; 2], part: f64) -> Loads {
    [0, 1].map(|axis| super::super::ground::between([loads[0][axis], loads[1][axis]], part))
}

/// Forces that states ask for.
#[derive(Clone, Copy)]
pub(super) struct Forces<const N: usize> {
    /// `1ᵀ(K q + C q̇)`.
    pub(super) base: [Column<N>; 2],
    /// `K1 s + N s/R`.
    pub(super) spring: [Column<N>; 2],
    /// `C1 w`.
    pub(super) damper: [Column<N>; 2],
    /// What the stop around the block takes.
    pub(super) stop: [Column<N>; 2],
    pub(super) push: [Column<N>; 2],
}

/// A stop around the block: with `ρ = |s|`, `n = s/ρ` and `δ = ρ − d` it takes `(k δ + c ρ̇) n` where it is pressed. One
/// that does not give way takes what keeps `ρ̈ = 0`: `M1 (n·p + |w|²/ρ) n`.
#[derive(Clone, Copy)]
pub(super) struct Ring {
    pub(super) stiffness: f64,
    pub(super) damper: f64,
    pub(super) gap_m: f64,
    pub(super) is_rigid: bool,
}

impl Ring {
    fn of(model: &Model) -> Option<Self> {
        let stop = model.stop()?;
        let gap_m = stop.gap_towards(Direction::Positive)?;
        let (stiffness, damper, is_rigid) = match stop.kind {
            StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => {
                (stiffness_n_per_m, damper_n_s_per_m, false)
            }
            StopKind::Rigid { .. } => (0.0, 0.0, true),
        };
        Some(Self { stiffness, damper, gap_m, is_rigid })
    }

    /// What one that does not give way takes over the mass of the block, under a push without it; a block at rest is not
    /// held on it.
    fn bears(&self, s: Pair, w: Pair, push: Pair) -> Pair {
        let n = times(s, 1.0 / norm(s));
        let bears = dot(n, push) + dot(w, w) / norm(s);
        times(n, if w == [0.0; 2] { bears.max(0.0) } else { bears })
    }

    /// What it takes of a force on the block.
    pub(super) fn force(&self, s: Pair, w: Pair) -> Pair {
        let rho = norm(s);
        let n = times(s, 1.0 / rho);
        times(n, self.stiffness * (rho - self.gap_m) + self.damper * dot(n, w))
    }

    /// How that grows with `w` and with `s`, row by row:
    /// `c n nᵀ` and `k n nᵀ + c n (w − ρ̇ n)ᵀ/ρ + (k δ + c ρ̇)(1 − n nᵀ)/ρ`.
    pub(super) fn slopes(&self, s: Pair, w: Pair) -> [[Pair; 2]; 2] {
        let rho = norm(s);
        let n = times(s, 1.0 / rho);
        let rate = dot(n, w);
        let across = [0, 1].map(|i| (w[i] - rate * n[i]) / rho);
        let hoop = (self.stiffness * (rho - self.gap_m) + self.damper * rate) / rho;
        let by_w = n.map(|a| n.map(|b| self.damper * a * b));
        let by_s = [0, 1].map(|i| {
            [0, 1].map(|j| {
                let one = if i == j { 1.0 } else { 0.0 };
                n[i] * (self.stiffness * n[j] + self.damper * across[j])
                    + hoop * (one - n[i] * n[j])
            })
        });
        [by_w, by_s]
    }
}

/// Displacements and velocities, the block's first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct State {
    pub(super) x: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// Whether the block presses the stop around it.
    pub(super) pressed: bool,
}

impl State {
    /// `w`.
    pub(super) fn speed(&self) -> Pair {
        [self.v[0], self.v[1]]
    }

    /// The block comes to rest in no time, the floors go on: `q̇_i += w`, then `w = 0`.
    pub(super) fn lose_speed(&mut self, frame: &PlaneFrame<'_>) {
        let w = self.speed();
        for (i, v) in self.v.iter_mut().skip(2).enumerate() {
            *v += frame.ridden(i, w);
        }
        self.v[..2].fill(0.0);
    }
}

/// Masses, springs, dampers and friction in two horizontal directions.
pub(super) struct PlaneFrame<'a> {
    law: &'a Law,
    pub(super) block_kg: f64,
    /// What moves with the block, over that.
    pub(super) body: Body,
    pub(super) total_kg: f64,
    pub(super) spring: f64,
    pub(super) damper: f64,
    /// `1/R` of a spring that follows `N`.
    pub(super) curvature_per_m: f64,
    pub(super) stop: Option<Ring>,
    /// `g sin θ` along x and y: in all accelerations, not in what is told of them.
    pub(super) slope: Pair,
    /// One over `M_tot g width/2` along x and y, where both are given and a moment is asked for.
    pub(super) per_resisted: Option<Pair>,
    /// Mass of each part of `q`, and along what it moves: floors along x and y in turn from the first up, or
    /// oscillators.
    pub(super) masses_kg: Vec<f64>,
    pub(super) along: Vec<Pair>,
    /// Points of a structure by its modes; `None` of a frame.
    pub(super) points: Option<Vec<PointOfModes>>,
    /// `K` and `C` of `q`, and what a unit of each part of `q` and of `q̇` does to the block.
    stiffness: Rows,
    damping: Rows,
    on_block: [Vec<Pair>; 2],
    /// Upper bounds on the fastest rate where the block rests and where it slides, in 1/s; of what is linear, and with
    /// what friction by speed and a spring that follows `N` add.
    pub(super) linear_rates: [f64; 2],
    pub(super) rates: [f64; 2],
    /// Upper bound on the largest undamped frequency on a block that rests, in rad/s.
    pub(super) frequency: f64,
    /// `μ_s`, and the larger of it and any `μ_k`.
    pub(super) fixed: f64,
    pub(super) most: f64,
}

impl<'a> PlaneFrame<'a> {
    pub(super) fn new(model: &Model, vertical: bool, law: &'a Law, normal: f64) -> Self {
        if let Some(structure) = model.structure() {
            return Self::of_modes((model, structure), vertical, law, normal);
        }
        let along_y = model.along_y();
        let other = (&along_y.stiffnesses_n_per_m[..], &along_y.damping);
        let axes = [Structure::new(model, vertical), Structure::of(model, other, vertical)];
        let n = axes[0].masses_kg.len();
        let width = 2 * n;
        let (mut stiffness, mut damping) = (vec![0.0; width * width], vec![0.0; width * width]);
        for (axis, structure) in axes.iter().enumerate() {
            let full = match &structure.damping {
                StoreyDamping::Chain(c) => chain(c),
                StoreyDamping::Full(c) => c.clone(),
            };
            for (to, from) in
                [(&mut stiffness, chain(&structure.stiffnesses)), (&mut damping, full)]
            {
                for i in 0..n {
                    for j in 0..n {
                        to[(2 * i + axis) * width + 2 * j + axis] = from[i * n + j];
                    }
                }
            }
        }
        let along = [[1.0, 0.0], [0.0, 1.0]].repeat(n);
        let [x, y] = &axes;
        let curvature_per_m = law.curvature_per_m();
        let added = libm::sqrt(normal / x.block_kg * curvature_per_m);
        let fastest = |phase| x.rate(phase).max(y.rate(phase));
        let by_speed =
            law.rate.as_ref().map_or(0.0, |rate| rate.rate(normal / x.block_kg, 0.0, 0.0));
        Self {
            law,
            block_kg: x.block_kg,
            body: Body::ONE,
            total_kg: x.total_kg,
            spring: x.spring,
            damper: x.damper,
            curvature_per_m,
            stop: Ring::of(model),
            slope: model.slope_in_plane_m_per_s2(),
            per_resisted: per_resisted(model),
            masses_kg: x.masses_kg.iter().flat_map(|mass| [*mass; 2]).collect(),
            points: None,
            on_block: [&stiffness, &damping].map(|rows| on_block(rows, &along)),
            stiffness: Rows::new(width, &stiffness),
            damping: Rows::new(width, &damping),
            along,
            linear_rates: [fastest(Phase::Stick), fastest(Phase::Slip)],
            rates: [
                fastest(Phase::Stick),
                fastest(Phase::Slip).max(fastest(Phase::Pressed)) + added + by_speed,
            ],
            frequency: x.frame_frequency().max(y.frame_frequency()),
            fixed: law.most(),
            most: law.most().max(law.most_sliding()),
        }
    }

    /// Of a structure by its modes.
    fn of_modes(
        (model, structure): (&Model, &ByModes),
        vertical: bool,
        law: &'a Law,
        normal: f64,
    ) -> Self {
        // Slider and block are those of one direction.
        let slider = Structure::new(model, vertical);
        let parts = parts_of(structure);
        let total_kg = model.total_mass_kg();
        let mut own = [[total_kg, 0.0], [0.0, total_kg]];
        for part in &parts {
            for (row, of) in own.iter_mut().zip(part.along) {
                row.iter_mut().zip(part.along).for_each(|(m, by)| *m -= part.mass_kg * of * by);
            }
        }
        let block_kg = 0.5 * (own[0][0] + own[1][1]);
        let body = Body::new(own.map(|row| row.map(|m| m / block_kg)));
        let least_kg = block_kg / body.most_compliant();
        let n = parts.len();
        let rows = |of: &dyn Fn(usize) -> f64| {
            let mut rows = vec![0.0; n * n];
            (0..n).for_each(|i| rows[i * n + i] = parts[i].mass_kg * of(i));
            rows
        };
        let omega = |i: usize| parts[i].frequency;
        let stiffness = rows(&|i| omega(i) * omega(i));
        let damping = rows(&|i| 2.0 * parts[i].damping_ratio * omega(i));
        let along: Vec<Pair> = parts.iter().map(|part| part.along).collect();
        // Gershgorin's rows, as of a structure in one direction.
        let most = |of: &dyn Fn(usize) -> f64| (0..n).map(of).fold(0.0, f64::max);
        let sum = |rows: &[f64]| rows.iter().step_by(n + 1).sum::<f64>();
        let frequency = most(&|i| core::f64::consts::SQRT_2 * omega(i));
        let decay = most(&|i| 4.0 * parts[i].damping_ratio * omega(i));
        let curvature_per_m = law.curvature_per_m();
        let by_speed = law.rate.as_ref().map_or(0.0, |rate| rate.rate(normal / least_kg, 0.0, 0.0));
        let pull = libm::sqrt((slider.spring + 2.0 * sum(&stiffness)) / least_kg);
        let drag = (slider.damper + 2.0 * sum(&damping)) / least_kg;
        let added = libm::sqrt(normal / least_kg * curvature_per_m) + by_speed;
        let stopped = Ring::of(model)
            .map_or(0.0, |stop| libm::sqrt(stop.stiffness / least_kg) + stop.damper / least_kg);
        let linear_rates = [frequency.max(decay), frequency.max(pull).max(decay.max(drag))];
        Self {
            law,
            block_kg,
            body,
            total_kg,
            spring: slider.spring,
            damper: slider.damper,
            curvature_per_m,
            stop: Ring::of(model),
            slope: model.slope_in_plane_m_per_s2(),
            per_resisted: per_resisted(model),
            masses_kg: parts.iter().map(|part| part.mass_kg).collect(),
            points: Some(PointOfModes::all(structure)),
            on_block: [&stiffness, &damping].map(|rows| on_block(rows, &along)),
            stiffness: Rows::new(n, &stiffness),
            damping: Rows::new(n, &damping),
            along,
            linear_rates,
            rates: [linear_rates[0], linear_rates[1] + added + stopped],
            frequency,
            fixed: law.most(),
            most: law.most().max(law.most_sliding()),
        }
    }

    /// Where an oscillator of a structure by its modes starts: as given, or held by the slope's pull at rest.
    pub(super) fn held_m(&self, part: usize, model: &Model) -> f64 {
        let given = model.along_y().initial.storey_displacement_m;
        given.map_or_else(
            || -self.masses_kg[part] * self.ridden(part, self.slope) / self.stiffness.own(part),
            |list| list[part],
        )
    }

    /// What rides on the block of a vector of it, part by part.
    pub(super) fn ridden(&self, part: usize, of_block: Pair) -> f64 {
        dot(self.along[part], of_block)
    }

    /// What moves with the block times an acceleration, in N.
    pub(super) fn inertia(&self, acceleration: Pair) -> Pair {
        times(self.body.carried(acceleration), self.block_kg)
    }

    /// Parts of `x` and of `v`.
    pub(super) fn degrees(&self) -> usize {
        2 + self.masses_kg.len()
    }

    /// `f = μ_k N/M1` at a sliding speed, and its slope.
    pub(super) fn slowing_and_slope(&self, normal: f64, speed: f64) -> [f64; 2] {
        let pressed = self.law.pressed(normal);
        self.law.kinetic_at(speed).map(|mu| mu * pressed / self.block_kg)
    }

    /// Friction on a straight line by the speed, wherever the speed is.
    pub(super) fn slowing_on(
        &self,
        line: Option<SpeedLine>,
        (normal, speed): (f64, f64),
    ) -> [f64; 2] {
        let Some(SpeedLine { from, mu, slope, .. }) = line else {
            return self.slowing_and_slope(normal, speed);
        };
        let pressed = self.law.pressed(normal);
        [mu + slope * (speed - from), slope].map(|mu| mu * pressed / self.block_kg)
    }

    /// The straight line of friction by the speed on which a slip of a velocity goes on, where there are such: a speed is at
    /// a corner within a part of it.
    pub(super) fn line_of(&self, w: Pair, change: Pair, near: f64) -> Option<SpeedLine> {
        let rate = self.law.rate.as_ref()?;
        rate.line(norm(w), w == [0.0; 2] || dot(w, change) >= 0.0, near)
    }

    /// `f = μ_k N/M1` at a sliding speed.
    pub(super) fn slowing(&self, loads: &Loads, speed: f64) -> f64 {
        let [f, _] = self.slowing_and_slope(loads[0].normal, speed);
        f
    }

    /// Whether a velocity is against the one before it at a speed that the rounding of a time takes or gives: friction
    /// does not turn a slip about, it has come to rest.
    pub(super) fn has_turned_about(
        &self,
        [w, before]: [Pair; 2],
        (time_s, loads, push): (f64, &Loads, Pair),
    ) -> bool {
        let rounding = || 2.0 * f64::EPSILON * time_s * (norm(push) + self.slowing(loads, 0.0));
        dot(w, before) < 0.0 && norm(w) <= rounding()
    }

    /// Whether there is no friction at any speed.
    pub(super) fn is_free(&self, loads: &Loads) -> bool {
        self.law.has_no_kinetic() || self.law.pressed(loads[0].normal) == 0.0
    }

    /// `μ_s N/M1`.
    pub(super) fn holding(&self, loads: &Loads) -> f64 {
        self.most_held_n(loads[0].normal) / self.block_kg
    }

    /// `K q + C q̇`, floor by floor, and all that acts on the block.
    #[inline(always)]
    pub(super) fn forces<const N: usize>(
        &self,
        [x, v]: [&[Column<N>]; 2],
        under: &Under<N>,
        floors: &mut [Column<N>],
    ) -> Forces<N> {
        let mut base = [[0.0; N]; 2];
        for (i, floor) in floors.iter_mut().enumerate() {
            *floor = self.stiffness.times(i, &x[2..]);
            add(floor, 1.0, &self.damping.times(i, &v[2..]));
            (0..2).for_each(|axis| add(&mut base[axis], self.along[i][axis], floor));
        }
        let none = [[0.0; N]; 2];
        let mut forces = Forces { base, spring: none, damper: none, stop: none, push: none };
        for at in 0..N {
            let own = [[x[0][at], x[1][at]], [v[0][at], v[1][at]]];
            let loads = (pair(&under.a, at), under.normal[at]);
            let [spring, damper, stop, push] =
                self.driven((pair(&base, at), under.pressed), own, loads);
            for axis in 0..2 {
                forces.spring[axis][at] = spring[axis];
                forces.damper[axis][at] = damper[axis];
                forces.stop[axis][at] = stop[axis];
                forces.push[axis][at] = push[axis];
            }
        }
        forces
    }

    /// A stop around the block that does not give way.
    pub(super) fn wall(&self) -> Option<Ring> {
        self.stop.filter(|stop| stop.is_rigid)
    }

    /// What a stop around the block takes that gives way.
    #[inline(always)]
    pub(super) fn stopped(&self, pressed: bool, [s, w]: [Pair; 2]) -> Pair {
        self.stop.filter(|_| pressed).map_or([0.0; 2], |stop| stop.force(s, w))
    }

    /// `K1 s + N s/R`, `C1 w`, what the stop takes, and `p`, where the structure pulls.
    #[inline(always)]
    fn driven(
        &self,
        (base, pressed): (Pair, bool),
        [s, w]: [Pair; 2],
        (a, normal): (Pair, f64),
    ) -> [Pair; 4] {
        let stop = self.stopped(pressed, [s, w]);
        let stiffness = self.spring + self.curvature_per_m * normal;
        let (spring, damper) = (s.map(|s| stiffness * s), w.map(|w| self.damper * w));
        let a = self.body.carried(a);
        let push =
            [0, 1].map(|k| (base[k] - spring[k] - damper[k] - stop[k]) / self.block_kg - a[k]);
        let Some(ring) = self.wall().filter(|_| pressed) else {
            return [spring, damper, stop, push];
        };
        let taken = ring.bears(s, w, push);
        [spring, damper, times(taken, self.block_kg), [push[0] - taken[0], push[1] - taken[1]]]
    }

    /// `p` alone.
    pub(super) fn push(&self, state: &State, loads: &Loads) -> Pair {
        let [_, _, _, push] = self.driven_in(state, loads);
        push
    }

    /// What a stop that does not give way takes over the mass of the block.
    pub(super) fn borne(&self, state: &State, loads: &Loads) -> Pair {
        let [_, _, stop, _] = self.driven_in(state, loads);
        times(stop, 1.0 / self.block_kg)
    }

    fn driven_in(&self, State { x, v, pressed }: &State, loads: &Loads) -> [Pair; 4] {
        let mut base = [0.0; 2];
        for (list, units) in [&x, &v].into_iter().zip(&self.on_block) {
            for (value, unit) in list[2..].iter().zip(units) {
                (0..2).for_each(|axis| base[axis] += unit[axis] * value);
            }
        }
        let (under, own) =
            ((loads.map(|load| load.a), loads[0].normal), [[x[0], x[1]], [v[0], v[1]]]);
        self.driven((base, *pressed), own, under)
    }

    /// The largest acceleration that the terms of `K q + C q̇` would give by their sizes, to a floor each and to the block
    /// together: what of an acceleration is rounding is a part of it, and not of the acceleration, where a soft and a
    /// stiff storey meet.
    pub(super) fn largest_terms(&self, x: &[f64], v: &[f64]) -> f64 {
        let (mut most, mut of_block) = (0.0_f64, 0.0);
        for (i, mass_kg) in self.masses_kg.iter().enumerate() {
            let terms = self.stiffness.sizes(i, &x[2..]) + self.damping.sizes(i, &v[2..]);
            most = most.max(terms / mass_kg);
            of_block += terms;
        }
        most.max(of_block * self.body.most_compliant() / self.block_kg)
    }

    /// Accelerations of all degrees, of the block over the table, under a table's acceleration and a force on the block
    /// over its mass, where nothing presses it; of a block that rests or slides.
    pub(super) fn accelerations(
        &self,
        [x, v]: [&[f64]; 2],
        [a, force]: [Pair; 2],
        slips: bool,
    ) -> Vec<f64> {
        let mut floors = vec![[0.0]; self.masses_kg.len()];
        let under = Under { a: a.map(|a| [a]), normal: [0.0], pressed: false };
        let states = [x, v].map(|list| list.as_chunks().0);
        let push = pair(&self.forces(states, &under, &mut floors).push, 0);
        let block = match slips {
            true => self.body.moved([push[0] + force[0], push[1] + force[1]]),
            false => [0.0; 2],
        };
        let of_part = |i: usize| {
            -floors[i][0] / self.masses_kg[i] - self.ridden(i, a) - self.ridden(i, block)
        };
        block.into_iter().chain((0..floors.len()).map(of_part)).collect()
    }

    /// What friction holds under a normal force, in N.
    pub(super) fn most_held_n(&self, normal: f64) -> f64 {
        self.fixed * self.law.pressed(normal)
    }

    /// `C1 w² + q̇ᵀ C q̇`.
    #[inline(always)]
    pub(super) fn dissipation<const N: usize>(&self, v: &[Column<N>]) -> Column<N> {
        let mut sum = self.damping.form(&v[2..]);
        for at in 0..N {
            sum[at] += self.damper * (v[0][at] * v[0][at] + v[1][at] * v[1][at]);
        }
        sum
    }

    /// `(K1 s² + qᵀ K q)/2`.
    pub(super) fn strain(&self, x: &[f64]) -> f64 {
        let [form] = self.stiffness.form(x[2..].as_chunks().0);
        0.5 * (self.spring * (x[0] * x[0] + x[1] * x[1]) + form)
    }

    /// `(M1 w² + Σ m_i (w + q̇_i)²)/2`.
    pub(super) fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let w = [v[0], v[1]];
        let floors = self.masses_kg.iter().zip(&v[2..]).enumerate();
        let floors = floors.map(|(i, (mass, own))| {
            let whole = self.ridden(i, w) + own;
            mass * whole * whole
        });
        0.5 * (dot(w, self.inertia(w)) + floors.sum::<f64>())
    }

    /// `M1 w + Σ m_i (w + q̇_i)`.
    #[inline(always)]
    pub(super) fn momentum<const N: usize>(&self, v: &[Column<N>]) -> [Column<N>; 2] {
        [0, 1].map(|axis| {
            let mut sum = v[axis].map(|w| self.total_kg * w);
            for (i, mass) in self.masses_kg.iter().enumerate() {
                add(&mut sum, mass * self.along[i][axis], &v[2 + i]);
            }
            sum
        })
    }

    /// The least mass of the block and the floors.
    pub(super) fn least_kg(&self) -> f64 {
        let block_kg = self.block_kg / self.body.most_compliant();
        self.masses_kg.iter().fold(block_kg, |least, mass| mass.min(least))
    }
}

fn per_resisted(model: &Model) -> Option<Pair> {
    let widths_m = [model.block().width_m?, model.along_y().width_m?];
    model.lever_arms()?;
    Some(widths_m.map(|width_m| 2.0 / (width_m * model.weight_n())))
}

/// A square matrix: row by row what is not 0, and in which column.
struct Rows(Vec<Vec<(usize, f64)>>);

impl Rows {
    fn new(n: usize, matrix: &[f64]) -> Self {
        let row = |i: usize| (0..n).map(move |j| (j, matrix[i * n + j])).filter(|(_, c)| *c != 0.0);
        Self((0..n).map(|i| row(i).collect()).collect())
    }

    /// What stands on the diagonal of a row.
    fn own(&self, row: usize) -> f64 {
        self.0[row].iter().filter(|(j, _)| *j == row).map(|(_, c)| c).sum()
    }

    /// A row times values at some instants.
    #[inline(always)]
    fn times<const N: usize>(&self, row: usize, z: &[Column<N>]) -> Column<N> {
        let mut sum = [0.0; N];
        self.0[row].iter().for_each(|(j, c)| add(&mut sum, *c, &z[*j]));
        sum
    }

    /// The sizes of the terms of a row, together.
    fn sizes(&self, row: usize, z: &[f64]) -> f64 {
        self.0[row].iter().map(|(j, c)| (c * z[*j]).abs()).sum()
    }

    /// `zᵀ A z`.
    #[inline(always)]
    fn form<const N: usize>(&self, z: &[Column<N>]) -> Column<N> {
        let mut sum = [0.0; N];
        for (i, own) in z.iter().enumerate() {
            let row = self.times(i, z);
            (0..N).for_each(|at| sum[at] += own[at] * row[at]);
        }
        sum
    }
}

/// What a unit of each part does to the block: the columns of a matrix, each part along its direction.
fn on_block(matrix: &[f64], along: &[Pair]) -> Vec<Pair> {
    let n = along.len();
    let of = |j: usize, axis: usize| (0..n).map(|i| along[i][axis] * matrix[i * n + j]).sum();
    (0..n).map(|j| [of(j, 0), of(j, 1)]).collect()
}

/// The matrix of a chain of springs or dampers from the block up, row by row.
fn chain(links: &[f64]) -> Vec<f64> {
    let n = links.len();
    let mut rows = vec![0.0; n * n];
    for (i, link) in links.iter().enumerate() {
        rows[i * n + i] += link;
        if let Some(below) = i.checked_sub(1) {
            rows[below * n + below] += link;
            rows[below * n + i] -= link;
            rows[i * n + below] -= link;
        }
    }
    rows
}
