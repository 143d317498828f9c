//! The force of friction over a step of a slip, by its direction at Gauss' nodes.
//!
//! All else is linear, so that the velocity at the nodes is linear in the forces there, over `M1` in m/s²:
//!
//! ```text
//! w_j = w°_j − Σ_k G_jk f_k u_k        n_j·w_j = 0,  n ⟂ u        f_k = μ_k(|w_k|) N_k/M1
//! ```
//!
//! with `w°` that without friction and `G_jk = ∫ H(c_j h − t) L_k(t) dt` from the derivatives `H^(l)(0)` of what a
//! push does to the velocity. The unknowns of Newton's method are the angles, and the speeds where friction follows them.

use super::nodes::{AtNodes, NODES, Nodes, Square, nodes};
use super::series::{Kind, PlaneSeries};
use super::system::{Loads, State, System};
use super::terms::Scales;
use super::vector::{cross, inner, norm};
use crate::linear::polynomial::{DEGREE, Polynomial, ZERO, derivative, value};
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;
use crate::slider::IsotropicFriction;

/// Most passes of Newton's method.
const MOST_PASSES: usize = 24;

/// A turn, in radians, that is rounding.
const NO_TURN: f64 = 1e-15;

/// A matrix is kept while a pass leaves less than this part of what the last one left.
const KEPT: f64 = 0.03;

/// Lengths that differ by less than this part of them have one influence.
const SAME: f64 = 1e-13;

/// Terms of the influence below this part of the first are rounding.
const NEGLIGIBLE: f64 = 1e-18;

/// What forces at the nodes do to velocities there.
pub(super) struct Influence {
    instructions: InstructionSet,
    /// The velocity after a push of 1 m/s² s along x and along y, by powers of the time over a unit, and `N/R` for which
    /// it is so.
    pushed: [[Polynomial; 2]; 2],
    unit_s: f64,
    pressed_n_per_m: Option<f64>,
    step_s: f64,
    /// `G`: of forces along the second axis on velocities along the first.
    of: [[Square; 2]; 2],
    /// Whether axes feel each other.
    crosses: bool,
    /// The length of the step that comes again and again, if there is one, and of that the velocities at the nodes without
    /// friction: of a unit of each part of the state, of the table and of its rate.
    again_s: Option<f64>,
    free: Vec<[AtNodes; 2]>,
}

impl Influence {
    /// With the length of the step that comes again and again.
    pub(super) fn new(instructions: InstructionSet, again_s: Option<f64>) -> Self {
        Self {
            instructions,
            again_s,
            free: Vec::new(),
            pushed: [[ZERO; 2]; 2],
            unit_s: 0.0,
            pressed_n_per_m: None,
            step_s: 0.0,
            of: [[[[0.0; NODES]; NODES]; 2]; 2],
            crosses: false,
        }
    }

    /// For a step of a length under loads; a series to work with.
    pub(super) fn prepare(
        &mut self,
        system: &System,
        (loads, step_s): (&Loads, f64),
        series: &mut PlaneSeries,
    ) {
        let pressed_n_per_m = loads.normal[0] * system.per_radius;
        if self.pressed_n_per_m != Some(pressed_n_per_m) {
            self.push(system, loads, series);
            (self.pressed_n_per_m, self.step_s) = (Some(pressed_n_per_m), 0.0);
            self.free.clear();
        }
        if (step_s - self.step_s).abs() > SAME * step_s {
            self.step_s = step_s;
            vectorize!(self.instructions, _simd => self.integrate(nodes()));
        }
    }

    /// Velocities at the nodes without friction over a step that comes again and again, and is none of a pendulum under a
    /// vertical motion; a series to work with.
    pub(super) fn free(
        &mut self,
        system: &System,
        (state, loads): (&State, &Loads),
        step_s: f64,
        series: &mut PlaneSeries,
    ) -> Option<[AtNodes; 2]> {
        let again_s = self.again_s.filter(|own_s| (own_s - step_s).abs() <= SAME * step_s)?;
        let pressed_n_per_m = loads.normal[0] * system.per_radius;
        if self.pressed_n_per_m != Some(pressed_n_per_m)
            || loads.normal[1] * system.per_radius != 0.0
        {
            return None;
        }
        if self.free.is_empty() && !self.follow_units(system, loads.normal[0], again_s, series) {
            self.again_s = None;
            return None;
        }
        let [x, y] = loads.table;
        let mut free = [[0.0; NODES]; 2];
        vectorize!(self.instructions, _simd => {
            let table = [[x[0], y[0]], [x[1], y[1]]];
            let parts = state.s.iter().chain(&state.w).chain(&state.eta).chain(&state.rate);
            for (part, of) in parts.chain(table.iter().flatten()).zip(&self.free) {
                for axis in 0..2 {
                    for j in 0..NODES {
                        free[axis][j] += part * of[axis][j];
                    }
                }
            }
        });
        Some(free)
    }

    /// Follows a unit of each part of a state, of the table and of its rate; whether series take the step.
    fn follow_units(
        &mut self,
        system: &System,
        normal_n: f64,
        step_s: f64,
        series: &mut PlaneSeries,
    ) -> bool {
        let modes = system.modes();
        let scales = Scales { w: 1.0, ..Scales::default() };
        for i in 0..4 + 2 * modes + 4 {
            let is = |place: usize| if place == i { 1.0 } else { 0.0 };
            let list = |from: usize| (from..from + modes).map(is).collect();
            let state = State::free([is(0), is(1)], [is(2), is(3)], list(4), list(4 + modes));
            let [a, rate] = [0, 2].map(|from| [0, 1].map(|axis| is(4 + 2 * modes + from + axis)));
            let table = [[a[0], rate[0]], [a[1], rate[1]]];
            let loads = Loads { table, normal: [normal_n, 0.0] };
            series.expand(system, (Kind::Frictionless, &state), (loads, step_s), &scales);
            if !(series.part >= 1.0) {
                self.free.clear();
                return false;
            }
            let at_nodes = |w: &Polynomial| nodes().at.map(|x| value(w, x));
            self.free.push(series.w.each_ref().map(at_nodes));
        }
        true
    }

    /// Follows a push along each axis.
    fn push(&mut self, system: &System, loads: &Loads, series: &mut PlaneSeries) {
        let rate = system.rate_rad_per_s;
        self.unit_s = if rate > 0.0 { 4.0 / rate } else { 1.0 };
        let still = Loads { table: [[0.0; 2]; 2], normal: [loads.normal[0], 0.0] };
        for axis in 0..2 {
            let mut force = [0.0; 2];
            force[axis] = 1.0;
            let w = system.moved(force);
            let of_mode = |j: usize| -inner(system.participation_of(j), w);
            let rate = (0..system.modes()).map(of_mode).collect();
            let state = State::free([0.0; 2], w, vec![0.0; system.modes()], rate);
            let scales = Scales { w: 1.0, ..Scales::default() };
            series.expand(system, (Kind::Frictionless, &state), (still, self.unit_s), &scales);
            self.pushed[axis] = series.w;
        }
        let [[_, across], [other, _]] = &self.pushed;
        self.crosses = across.iter().chain(other).any(|c| *c != 0.0);
    }

    /// `G = h Σ_l c_l (h/unit)^l ∫₀^c (c − x)^l L_k(x) dx`, with the coefficients of what was pushed.
    #[inline(always)]
    fn integrate(&mut self, nodes: &Nodes) {
        let part = self.step_s / self.unit_s;
        for (to, row) in self.of.iter_mut().enumerate() {
            for (from, block) in row.iter_mut().enumerate() {
                *block = [[0.0; NODES]; NODES];
                if to != from && !self.crosses {
                    continue;
                }
                let pushed = &self.pushed[from][to];
                let (mut power, mut size) = (self.step_s, 0.0_f64);
                for l in 0..=DEGREE {
                    let factor = pushed[l] * power;
                    size = size.max(factor.abs());
                    power *= part;
                    let is_last = (pushed[(l + 1).min(DEGREE)] * power).abs() <= NEGLIGIBLE * size;
                    if factor != 0.0 {
                        for (row, of_l) in block.iter_mut().zip(&nodes.integrals[l]) {
                            for (sum, x) in row.iter_mut().zip(of_l) {
                                *sum += factor * x;
                            }
                        }
                    }
                    if is_last && factor.abs() <= NEGLIGIBLE * size {
                        break;
                    }
                }
            }
        }
    }
}

/// Friction over a step: its directions at the nodes, the velocities there, and its sizes.
pub(super) struct Force {
    pub(super) u: [AtNodes; 2],
    pub(super) w: [AtNodes; 2],
    pub(super) speeds: AtNodes,
    sizes: AtNodes,
    /// `w` without friction and stop, what the stop around the block takes over `M1`, and `N` at the nodes.
    pub(super) free: [AtNodes; 2],
    pub(super) stopped: [AtNodes; 2],
    /// The way along a stop that does not give way, where the block bears on one.
    pub(super) along_stop: Option<[AtNodes; 2]>,
    normal_n: AtNodes,
    /// `w` without friction from the start of the step on, by powers of the time over a unit, how far that is exact, and
    /// the part of it that is a step.
    series: [Polynomial; 2],
    unit_s: f64,
    reach_s: f64,
    part: f64,
}

impl Force {
    pub(super) fn new() -> Self {
        let none = [0.0; NODES];
        Self {
            u: [none; 2],
            w: [none; 2],
            speeds: none,
            sizes: none,
            free: [none; 2],
            stopped: [none; 2],
            along_stop: None,
            normal_n: none,
            series: [ZERO; 2],
            unit_s: 1.0,
            reach_s: 0.0,
            part: 1.0,
        }
    }

    /// Another step begins: what is known of the motion without friction is of the last.
    pub(super) fn forget(&mut self) {
        self.reach_s = 0.0;
    }

    /// Whether the motion without friction is known so far.
    pub(super) fn reaches(&self, step_s: f64) -> bool {
        step_s <= self.reach_s
    }

    /// Keeps the motion without friction.
    pub(super) fn keep(&mut self, series: &PlaneSeries) {
        (self.series, self.unit_s) = (series.w, series.unit);
        self.reach_s = if series.part > 0.0 { series.part * series.unit } else { 0.0 };
    }

    /// `N` that friction follows over a step.
    pub(super) fn press(&mut self, law: &IsotropicFriction, loads: &Loads, step_s: f64) {
        let [normal_n, rate] = loads.normal;
        let normal_n = nodes().at.map(|x| (normal_n + rate * (step_s * x)).max(0.0));
        self.normal_n = normal_n.map(|n| law.pressing_n(n));
    }

    /// Without friction over a step, by what is kept.
    pub(super) fn free_over(&mut self, step_s: f64) {
        self.part = step_s / self.unit_s;
        self.free = self.series.each_ref().map(|w| nodes().at.map(|x| value(w, self.part * x)));
    }

    /// Directions to begin with: those of the velocity under friction along one direction.
    pub(super) fn guess(
        &mut self,
        law: &IsotropicFriction,
        along: [f64; 2],
        speed: f64,
        influence: &Influence,
    ) {
        self.sizes = self.normal_n.map(|n| law.at(speed) * n);
        self.speeds = [speed; NODES];
        self.u = along.map(|u| [u; NODES]);
        self.move_by(influence);
        for j in 0..NODES {
            let w = [self.w[0][j], self.w[1][j]];
            if inner(w, along) > 0.0 {
                let size = norm(w);
                (self.u[0][j], self.u[1][j]) = (w[0] / size, w[1] / size);
            }
        }
    }

    /// Directions to begin with, node by node, from rest, by how the velocity without friction and stop changes there, and by
    /// what the stop takes.
    pub(super) fn guess_each(
        &mut self,
        law: &IsotropicFriction,
        along: impl Fn([f64; 2], [f64; 2]) -> [f64; 2],
    ) {
        self.sizes = self.normal_n.map(|n| law.at(0.0) * n);
        self.speeds = [0.0; NODES];
        let changes = self.series.each_ref().map(derivative);
        for (j, x) in nodes().at.iter().enumerate() {
            let stopped = self.stopped.each_ref().map(|stopped| stopped[j]);
            let change = changes.each_ref().map(|change| value(change, self.part * x));
            let u = along(change, stopped.map(|stopped| self.unit_s * stopped));
            (self.u[0][j], self.u[1][j]) = (u[0], u[1]);
        }
    }

    /// `w_j`.
    #[inline(always)]
    fn move_by(&mut self, influence: &Influence) {
        let mut w = self.free;
        for (from, u) in self.u.iter().enumerate() {
            let stopped = &self.stopped[from];
            let force: AtNodes = core::array::from_fn(|k| self.sizes[k] * u[k] + stopped[k]);
            for (to, w) in w.iter_mut().enumerate() {
                if to != from && !influence.crosses {
                    continue;
                }
                for (w, row) in w.iter_mut().zip(&influence.of[to][from]) {
                    let mut sum = 0.0;
                    for k in 0..NODES {
                        sum += row[k] * force[k];
                    }
                    *w -= sum;
                }
            }
        }
        self.w = w;
    }

    /// Takes directions that are given, and finds the speeds along them; whether all are ahead of rest.
    pub(super) fn keep_to(
        &mut self,
        along: [AtNodes; 2],
        law: &IsotropicFriction,
        influence: &Influence,
    ) -> bool {
        self.u = along;
        for _ in 0..MOST_PASSES {
            self.sizes = core::array::from_fn(|j| law.at(self.speeds[j]) * self.normal_n[j]);
            self.move_by(influence);
            let before = self.speeds;
            if !self.is_ahead() {
                return false;
            }
            let stays = |(a, b): (&f64, &f64)| (a - b).abs() <= 4.0 * f64::EPSILON * b;
            if law.is_constant() || before.iter().zip(&self.speeds).all(stays) {
                return true;
            }
        }
        false
    }

    /// Finds the directions; whether they are those of the velocities, ahead of rest.
    pub(super) fn settle(&mut self, law: &IsotropicFriction, influence: &Influence) -> bool {
        vectorize!(influence.instructions, _simd => if law.is_constant() {
            self.settle_here::<NODES>(law, influence)
        } else {
            self.settle_here::<{ 2 * NODES }>(law, influence)
        })
    }

    #[inline(always)]
    fn settle_here<const N: usize>(
        &mut self,
        law: &IsotropicFriction,
        influence: &Influence,
    ) -> bool {
        let mut factors: Option<Factors<N>> = None;
        let mut last = f64::INFINITY;
        self.move_by(influence);
        for pass in 0..MOST_PASSES {
            let mut rest = [0.0; N];
            for j in 0..NODES {
                let (u, w) = self.at(j);
                rest[j] = cross(u, w);
                if N > NODES {
                    rest[NODES + j] = inner(u, w) - self.speeds[j];
                }
            }
            let is_new = factors.is_none();
            if is_new {
                factors = Factors::of(self.slopes::<N>(law, influence));
            }
            let Some(kept) = &factors else { return false };
            kept.solve(&mut rest);
            let mut turn = 0.0_f64;
            for j in 0..NODES {
                let by = rest[j].clamp(-1.0, 1.0);
                turn = turn.max(rest[j].abs());
                if rest[j].is_nan() {
                    return false;
                }
                let (u, per) = (self.at(j).0, 1.0 / (1.0 + by * by).sqrt());
                self.u[0][j] = (u[0] - by * u[1]) * per;
                self.u[1][j] = (u[1] + by * u[0]) * per;
                if N > NODES {
                    let speed = self.speeds[j] + rest[NODES + j];
                    let speed = if speed > 0.0 { speed } else { 0.1 * self.speeds[j] };
                    turn = turn.max(rest[NODES + j].abs() / (speed + f64::MIN_POSITIVE));
                    self.speeds[j] = speed;
                    self.sizes[j] = law.at(speed) * self.normal_n[j];
                }
            }
            self.move_by(influence);
            let gain = if is_new { turn } else { turn / last };
            if turn * gain.min(1.0) <= NO_TURN {
                return self.is_ahead();
            }
            if pass > 6 && turn > 0.9 * last && turn > 1e-9 {
                return false;
            }
            if pass > 10 && turn < 1e-11 {
                return self.is_ahead();
            }
            if !is_new && turn > KEPT * last {
                factors = None;
            }
            last = turn;
        }
        false
    }

    #[inline(always)]
    fn at(&self, j: usize) -> ([f64; 2], [f64; 2]) {
        ([self.u[0][j], self.u[1][j]], [self.w[0][j], self.w[1][j]])
    }

    /// Whether velocities are along their directions, not against them; notes the speeds.
    #[inline(always)]
    fn is_ahead(&mut self) -> bool {
        for j in 0..NODES {
            let (u, w) = self.at(j);
            self.speeds[j] = inner(u, w);
        }
        self.speeds.iter().all(|speed| *speed > 0.0)
    }

    /// How `n·w` and `u·w − r` change with the turns and with the speeds, both with the opposite sign.
    #[inline(always)]
    fn slopes<const N: usize>(
        &self,
        law: &IsotropicFriction,
        influence: &Influence,
    ) -> [[f64; N]; N] {
        let mut a = [[0.0; N]; N];
        let g = &influence.of;
        for j in 0..NODES {
            let (u_j, w) = self.at(j);
            let n_j = [-u_j[1], u_j[0]];
            for k in 0..NODES {
                let of = |x: [f64; 2], y: [f64; 2]| {
                    let own = x[0] * g[0][0][j][k] * y[0] + x[1] * g[1][1][j][k] * y[1];
                    if !influence.crosses {
                        return own;
                    }
                    own + x[0] * g[0][1][j][k] * y[1] + x[1] * g[1][0][j][k] * y[0]
                };
                let u_k = [self.u[0][k], self.u[1][k]];
                let turned = [-u_k[1], u_k[0]].map(|n| self.sizes[k] * n);
                a[j][k] = of(n_j, turned);
                if N > NODES {
                    let slope = law.slope_at(self.speeds[k]) * self.normal_n[k];
                    let faster = u_k.map(|u| slope * u);
                    a[j][NODES + k] = of(n_j, faster);
                    a[NODES + j][k] = of(u_j, turned);
                    a[NODES + j][NODES + k] = of(u_j, faster);
                }
            }
            a[j][j] += inner(u_j, w);
            if N > NODES {
                a[NODES + j][j] -= cross(u_j, w);
                a[NODES + j][NODES + j] += 1.0;
            }
        }
        a
    }

    /// What friction takes, as a polynomial along each axis, and the last of its Legendre coefficients.
    pub(super) fn polynomial(&self) -> ([Polynomial; 2], f64) {
        let nodes = nodes();
        let coefficients = self.u.each_ref().map(|u| {
            let values: AtNodes = core::array::from_fn(|k| self.sizes[k] * u[k]);
            nodes.coefficients(&values)
        });
        let [x, y] = &coefficients;
        let last = |l: usize| norm([x[l], y[l]]);
        let tail = last(NODES - 1).max(last(NODES - 2));
        (coefficients.each_ref().map(|of| nodes.polynomial(of)), tail)
    }

    /// The largest of what friction takes at the nodes.
    pub(super) fn largest(&self) -> f64 {
        self.sizes.iter().fold(0.0, |most: f64, f| most.max(*f))
    }

    /// The least speed at the nodes.
    pub(super) fn slowest(&self) -> f64 {
        self.speeds.iter().fold(f64::INFINITY, |least, r| least.min(*r))
    }
}

/// A matrix by its factors, with the rows in the order of their pivots.
struct Factors<const N: usize> {
    matrix: [[f64; N]; N],
    rows: [usize; N],
}

impl<const N: usize> Factors<N> {
    #[inline(always)]
    fn of(mut a: [[f64; N]; N]) -> Option<Self> {
        let mut rows: [usize; N] = core::array::from_fn(|i| i);
        for c in 0..N {
            let mut pivot = c;
            for i in c + 1..N {
                if a[i][c].abs() > a[pivot][c].abs() {
                    pivot = i;
                }
            }
            a.swap(c, pivot);
            rows.swap(c, pivot);
            let per = 1.0 / a[c][c];
            if !per.is_finite() {
                return None;
            }
            let row = a[c];
            for below in &mut a[c + 1..] {
                let factor = below[c] * per;
                below[c] = factor;
                for j in c + 1..N {
                    below[j] -= factor * row[j];
                }
            }
            a[c][c] = per;
        }
        Some(Self { matrix: a, rows })
    }

    #[inline(always)]
    fn solve(&self, right: &mut [f64; N]) {
        let mut x = self.rows.map(|row| right[row]);
        for i in 0..N {
            for j in 0..i {
                x[i] -= self.matrix[i][j] * x[j];
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                x[i] -= self.matrix[i][j] * x[j];
            }
            x[i] *= self.matrix[i][i];
        }
        *right = x;
    }
}
