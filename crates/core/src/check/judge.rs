//! Goes through the knots of a history and keeps the worst of everything.

use super::collocation::{NODES, POINTS, Path, Rule, Scheme};
use super::energy::Energy;
use super::ground::{Ground, Load};
use super::law::{Dips, Law};
use super::structure::{Phase, Structure, excess, larger};
use super::{Certificate, ClosestCall};
use crate::friction::Direction;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::response::{History, Mode};

/// A sliding velocity below this part of its peak has no sign: the depth of a dip through zero that
/// the exact method may miss.
const STILL: f64 = 1e-12;

/// Largest defects so far, and what they are measured by.
#[derive(Default, Debug)]
struct Figures {
    displacement: [f64; 2],
    velocity: [f64; 2],
    force: [f64; 2],
    table: [f64; 2],
    excess: f64,
}

/// The largest defect over its scale, where `pair` is `[defect, scale]`.
fn relative(pair: [f64; 2]) -> f64 {
    if pair[0] == 0.0 { 0.0 } else { pair[0] / pair[1] }
}

pub(super) struct Judge<'a> {
    model: &'a Model,
    history: &'a History,
    structure: &'a Structure,
    ground: Ground<'a>,
    law: Law,
    scheme: Scheme<'a>,
    /// Velocities below this are zero to within rounding.
    still: f64,
    /// Rounding of a time.
    instant_s: f64,
    /// Within an interval: the largest velocity of the wrong sign, the largest excess by such.
    astray: [f64; 2],
    figures: Figures,
    energy: Energy,
    /// Near decisions of the phase under way.
    dips: Dips,
    closest: Option<ClosestCall>,
    /// `(x, v)` along an interval.
    state: Vec<f64>,
    /// `(x, v)` of the knot last looked at.
    stored: Vec<f64>,
    scratch: Vec<f64>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(
        model: &'a Model,
        motion: &'a GroundMotion,
        history: &'a History,
        structure: &'a Structure,
    ) -> Self {
        let d = structure.degrees();
        let end_s = history.time_s.last().copied().unwrap_or(0.0);
        let instant_s = 8.0 * f64::EPSILON * end_s;
        let mut judge = Self {
            model,
            history,
            structure,
            ground: Ground::new(model, motion),
            law: Law::new(model),
            scheme: Scheme::new(structure, 2.0 * instant_s),
            still: 0.0,
            instant_s,
            astray: [0.0; 2],
            figures: Figures::default(),
            energy: Energy::default(),
            dips: Dips::new(0.0),
            closest: None,
            state: vec![0.0; 2 * d],
            stored: vec![0.0; 2 * d],
            scratch: vec![0.0; 2 * d],
        };
        judge.measure();
        judge
    }

    /// Scales of displacement and velocity from the stored knots, and what counts as rest.
    fn measure(&mut self) {
        let h = self.history;
        let peak = |values: &[f64]| values.iter().fold(0.0, |p, &v| larger(p, v));
        let storey = peak(&h.storey_displacement_m);
        let sliding = peak(&h.sliding_velocity_m_per_s);
        let speed = larger(sliding, peak(&h.storey_velocity_m_per_s));
        // A frame held at rest by its weight on a slope moves by rounding alone: its velocities
        // are measured by the static displacement, not by themselves.
        let rest = 1e-4 * self.structure.frame_frequency() * storey;
        self.figures.displacement[1] = larger(storey, peak(&h.sliding_displacement_m));
        self.figures.velocity[1] = larger(speed, rest);
        self.still = STILL * sliding + 64.0 * f64::EPSILON * speed;
    }

    /// Judges everything.
    pub(super) fn run(mut self, bound: f64) -> Certificate {
        let times = &self.history.time_s;
        let knots = times.len();
        self.load_state(0);
        self.start();
        self.energy.start(self.structure.kinetic(self.v()) + self.structure.strain(self.x()));
        self.dips = self.fresh_dips(0);
        let mut arriving = None;
        for k in 0..knots {
            if k > 0 {
                self.join(k, arriving.is_none());
            }
            self.load_state(k);
            self.energy.knot(self.structure.kinetic(self.v()), self.structure.strain(self.x()));
            let leaves = k + 1 < knots && times[k + 1] > times[k];
            let (departing, next) = if leaves {
                let (from, to) = self.interval(k);
                (Some(from), Some(to))
            } else {
                (None, None)
            };
            self.load_state(k);
            self.knot(k, [arriving, departing]);
            arriving = next;
        }
        self.close(self.history.mode[knots - 1]);
        self.certificate(bound)
    }

    fn certificate(self, bound: f64) -> Certificate {
        let weight = self.model.weight_n();
        let end_s = self.history.time_s.last().copied().unwrap_or(0.0);
        let (normal, table) = self.ground.largest(end_s);
        let f = &self.figures;
        let equilibrium = [f.displacement, f.velocity, f.force, [f.table[0], table]].map(relative);
        let energy_balance_error = self.energy.error();
        Certificate {
            equilibrium_residual: equilibrium.into_iter().fold(0.0, larger),
            friction_excess: relative([f.excess, self.law.scale(normal, weight)]),
            energy_balance_error,
            closest_call: self.closest,
            bound,
            energy: self.energy.history,
        }
    }

    fn x(&self) -> &[f64] {
        &self.stored[..self.stored.len() / 2]
    }

    fn v(&self) -> &[f64] {
        &self.stored[self.stored.len() / 2..]
    }

    /// Reads the stored state of a knot.
    fn load_state(&mut self, k: usize) {
        let h = self.history;
        let (x, v) = self.stored.split_at_mut(self.structure.degrees());
        x[0] = h.sliding_displacement_m[k];
        v[0] = h.sliding_velocity_m_per_s[k];
        x[1..].copy_from_slice(h.storey_displacements(k));
        v[1..].copy_from_slice(h.storey_velocities(k));
    }

    /// Compares the stored state with another, entry by entry.
    fn compare(&mut self, other: &[f64]) {
        let d = self.structure.degrees();
        for (i, (stored, other)) in self.stored.iter().zip(other).enumerate() {
            let figure =
                if i < d { &mut self.figures.displacement } else { &mut self.figures.velocity };
            figure[0] = larger(figure[0], stored - other);
        }
    }

    /// The first knot has the model's initial state, and a block at rest that slides was pushed.
    fn start(&mut self) {
        let initial = self.model.initial();
        let mut state = vec![initial.sliding_displacement_m];
        state.extend(self.model.initial_storey_displacement_m());
        state.push(initial.sliding_velocity_m_per_s);
        state.extend(self.model.initial_storey_velocity_m_per_s());
        self.compare(&state);
        if initial.sliding_velocity_m_per_s == 0.0 {
            self.change(0, Mode::Stick, self.history.mode[0]);
        }
    }

    /// Passes from the knot before `k` to `k`; `abreast` where both have the same time.
    fn join(&mut self, k: usize, abreast: bool) {
        let (before, after) = (self.history.mode[k - 1], self.history.mode[k]);
        if abreast {
            self.load_state(k - 1);
            let other = self.stored.clone();
            self.load_state(k);
            self.compare(&other);
        }
        if before != after {
            self.load_state(k);
            let speed = self.stored[self.structure.degrees()];
            self.figures.velocity[0] = larger(self.figures.velocity[0], speed);
            self.close(before);
            self.change(k, before, after);
            self.dips = self.fresh_dips(k);
        }
    }

    /// Judges the decision between two modes at the knot `k`, where the block has no velocity.
    ///
    /// The knot's own side of a jump decides.
    fn change(&mut self, k: usize, before: Mode, after: Mode) {
        if before == after {
            return;
        }
        let h = self.history;
        let table = h.table_acceleration_m_per_s2[k];
        let loads = self.ground.instant(h.time_s[k]);
        let nearest =
            loads.iter().map(|load| (load.table - table).abs()).fold(f64::INFINITY, f64::min);
        let judged = |load: &Load| {
            let demand = self.structure.demand(self.x(), self.v(), load.a);
            (self.law.forbids(after, demand, load.normal), self.law.margin(demand, load.normal))
        };
        let candidates = loads.iter().filter(|load| (load.table - table).abs() <= nearest);
        let best = candidates.map(judged).reduce(|a, b| if b.0 < a.0 { b } else { a });
        // Distances that are not numbers leave no candidate.
        let (excess, margin) = best.unwrap_or((f64::INFINITY, None));
        self.figures.excess = larger(self.figures.excess, excess);
        if let (true, Some(margin)) = (before != Mode::Stick, margin) {
            self.nearest(ClosestCall { margin, time_s: h.time_s[k], kind: "stop" });
        }
    }

    /// Keeps the least margin; rounding may leave one a little below 0.
    fn nearest(&mut self, call: ClosestCall) {
        let call = ClosestCall { margin: call.margin.abs(), ..call };
        if self.closest.is_none_or(|closest| call.margin < closest.margin) {
            self.closest = Some(call);
        }
    }

    fn fresh_dips(&self, k: usize) -> Dips {
        Dips::new(if self.history.mode[k] == Mode::Stick { 1e-12 } else { self.still })
    }

    /// Ends a phase: its near decisions are known.
    fn close(&mut self, mode: Mode) {
        let call = match mode {
            Mode::Stick => self.dips.least(),
            Mode::Slip(direction) if self.law.drops(direction) => self.dips.least_of_peak(),
            Mode::Slip(_) => None,
        };
        if let Some(call) = call {
            self.nearest(call);
        }
    }

    /// Judges the stored values of a knot with the loads of the intervals that end and begin there.
    fn knot(&mut self, k: usize, sides: [Option<Load>; 2]) {
        let h = self.history;
        let (table, block) = (h.table_acceleration_m_per_s2[k], h.block_acceleration_m_per_s2[k]);
        let force = h.friction_force_n[k];
        let slope = self.model.slope_m_per_s2();
        let storeys = h.storey_accelerations(k).iter().map(|a| a + slope);
        let split = self.structure.degrees();
        let (x, v) = self.stored.split_at(split);
        let (defect, term) =
            self.structure.imbalance((x, v), block + slope, storeys, force, &mut self.scratch);
        self.figures.force =
            [larger(self.figures.force[0], defect), larger(self.figures.force[1], term)];

        let off = |load: &Load| {
            // The stored time is rounded, the acceleration stored with it need not be.
            ((load.table - table).abs() - self.instant_s * load.slope.abs()).max(0.0)
        };
        let beyond = |load: &Load| match h.mode[k] {
            Mode::Stick => 0.0,
            Mode::Slip(claimed) => {
                let direction = if v[0].abs() <= self.still {
                    claimed
                } else if v[0] > 0.0 {
                    Direction::Positive
                } else {
                    Direction::Negative
                };
                self.law.sliding_excess(force, direction, load.normal)
            }
        };
        let (off, beyond) = if sides == [None, None] {
            let loads = self.ground.instant(h.time_s[k]);
            let least =
                |f: &dyn Fn(&Load) -> f64| loads.iter().map(f).fold(f64::INFINITY, f64::min);
            (least(&off), least(&beyond))
        } else {
            let worst = |f: &dyn Fn(&Load) -> f64| sides.iter().flatten().map(f).fold(0.0, larger);
            (worst(&off), worst(&beyond))
        };
        self.figures.table[0] =
            larger(self.figures.table[0], if table.is_nan() { table } else { off });
        self.figures.excess = larger(self.figures.excess, beyond);
        if h.mode[k] == Mode::Stick {
            let split_force = self.model.block().mass_kg * (block - table);
            self.figures.velocity[0] = larger(self.figures.velocity[0], v[0]);
            self.figures.force[0] = larger(self.figures.force[0], split_force);
        }
    }

    /// Integrates from the knot `k` to the next and returns the loads at both ends.
    fn interval(&mut self, k: usize) -> (Load, Load) {
        let mode = self.history.mode[k];
        let phase = if mode == Mode::Stick { Phase::Stick } else { Phase::Slip };
        let d = self.structure.degrees();
        self.state.copy_from_slice(&self.stored);
        if phase == Phase::Stick {
            self.state[d] = 0.0;
        }
        let (mut from_s, end_s) = (self.history.time_s[k], self.history.time_s[k + 1]);
        self.astray = [0.0; 2];
        let mut first = None;
        loop {
            let piece = self.ground.piece(from_s, end_s);
            let steps = self.scheme.begin(phase, piece.to_s - from_s);
            let step_s = (piece.to_s - from_s) / steps as f64;
            for j in 0..steps {
                let loads = [j, j + 1].map(|j| between(piece.loads, j as f64 / steps as f64));
                self.step(mode, from_s + j as f64 * step_s, step_s, loads);
            }
            let first = *first.get_or_insert(piece.loads[0]);
            from_s = piece.to_s;
            if from_s >= end_s {
                self.load_state(k + 1);
                let end = core::mem::take(&mut self.state);
                self.compare(&end);
                // What the knot's own defect explains is no sign of the velocity.
                let defect = (self.stored[d] - end[d]).abs();
                if self.astray[0] > self.still + defect {
                    self.figures.excess = larger(self.figures.excess, self.astray[1]);
                }
                self.state = end;
                return (first, piece.loads[1]);
            }
        }
    }

    /// One collocation step: advances the state, its energies, and judges friction on the way.
    fn step(&mut self, mode: Mode, from_s: f64, step_s: f64, loads: [Load; 2]) {
        let d = self.structure.degrees();
        let forces = match mode {
            Mode::Stick => [0.0; 2],
            Mode::Slip(direction) => {
                loads.map(|load| self.law.sliding_force(direction, load.normal))
            }
        };
        let demand = |state: &[f64], a: f64| self.structure.demand(&state[..d], &state[d..], a);
        let first = if mode == Mode::Stick { demand(&self.state, loads[0].a) } else { 0.0 };
        let path = self.scheme.step(&self.state, [loads.map(|load| load.a), forces]);
        let mut values = [0.0; POINTS];
        match mode {
            Mode::Stick => {
                values[0] = first;
                values[1..=NODES].copy_from_slice(path.demands());
                values[NODES + 1] = demand(path.end(), loads[1].a);
            }
            Mode::Slip(direction) => {
                let sign = direction.sign();
                values[0] = sign * self.state[d];
                for (value, node) in values[1..].iter_mut().zip(0..NODES) {
                    *value = sign * path.velocity(node)[0];
                }
                values[NODES + 1] = sign * path.end()[d];
            }
        }
        self.state.copy_from_slice(path.end());
        self.spend(step_s, loads, forces);
        match mode {
            Mode::Stick => self.held(from_s, step_s, loads, &values),
            Mode::Slip(direction) => self.sliding(direction, from_s, step_s, loads, &values),
        }
    }

    /// Adds up work and losses of the step just made.
    fn spend(&mut self, step_s: f64, loads: [Load; 2], forces: [f64; 2]) {
        let path: &Path = self.scheme.path();
        let rule: &Rule = &self.scheme.rule;
        let (mut work, mut size, mut damping, mut friction) = (0.0, 0.0, 0.0, 0.0);
        let (mut sliding, mut speed) = (0.0_f64, self.figures.velocity[1]);
        for node in 0..NODES {
            let (v, c) = (path.velocity(node), rule.points[node + 1]);
            sliding = v[0].abs().max(sliding);
            speed = v.iter().fold(speed, |speed, v| v.abs().max(speed));
            let weight = step_s * rule.weights[node];
            let a = loads[0].a + (loads[1].a - loads[0].a) * c;
            let force = forces[0] + (forces[1] - forces[0]) * c;
            let power = -self.structure.momentum(v) * a;
            work += weight * power;
            size += weight * power.abs();
            damping += weight * self.structure.dissipation(v);
            friction -= weight * force * v[0];
        }
        self.energy.spend(work, size, damping, friction);
        // Between two knots the motion may be faster and go farther than at any.
        self.figures.velocity[1] = speed;
        self.still = (STILL * sliding).max(self.still);
        let x = path.end()[..self.structure.degrees()].iter();
        self.figures.displacement[1] = x.fold(self.figures.displacement[1], |p, x| x.abs().max(p));
    }

    /// Judges a step of a stick from the demand at its points.
    fn held(&mut self, from_s: f64, step_s: f64, loads: [Load; 2], demands: &[f64; POINTS]) {
        let rule = &self.scheme.rule;
        let normal = |t: f64| between(loads, t).normal;
        let mut margins = [f64::NAN; POINTS];
        for i in 0..POINTS {
            let n = normal(rule.points[i]);
            let beyond = self.law.beyond(demands[i], n);
            self.figures.excess = larger(self.figures.excess, excess(beyond));
            margins[i] = self.law.margin(demands[i], n).unwrap_or(f64::NAN);
        }
        if margins.iter().any(|m| m.is_nan()) {
            self.dips.interrupt();
            return;
        }
        let inner = dip(&margins);
        let flat = margins.iter().all(|m| (m - margins[0]).abs() <= 1e-12);
        for i in 0..POINTS {
            let (mut t, mut margin) = (rule.points[i], margins[i]);
            if inner == Some(i) {
                let law = &self.law;
                let cost =
                    |t: f64, demand: f64| law.margin(demand, normal(t)).unwrap_or(f64::INFINITY);
                (t, margin) = rule.least(demands, i, cost);
                let beyond = -margin * self.law.bound(demands[i], normal(t));
                self.figures.excess = larger(self.figures.excess, excess(beyond));
            }
            self.dips.feed(from_s + t * step_s, margin);
        }
        // A plateau near the bound is as close a call as a maximum, if it is no sliver of one.
        let long = step_s > 1e-9 * self.instant_s / (8.0 * f64::EPSILON);
        if flat && long && margins[0] < 1.0 {
            self.dips.take(from_s, margins[0]);
        }
    }

    /// Judges a step of a slip from the velocity, in the direction claimed, at its points.
    fn sliding(
        &mut self,
        direction: Direction,
        from_s: f64,
        step_s: f64,
        loads: [Load; 2],
        speeds: &[f64; POINTS],
    ) {
        let rule = &self.scheme.rule;
        let inner = dip(speeds);
        for i in 0..POINTS {
            let (mut t, mut speed) = (rule.points[i], speeds[i]);
            if inner == Some(i) {
                (t, speed) = rule.least(speeds, i, |_, speed| speed);
            }
            if speed < -self.still || speed.is_nan() {
                let excess = self.law.wrong_way(direction, between(loads, t).normal);
                self.astray = [larger(self.astray[0], speed), larger(self.astray[1], excess)];
            }
            self.dips.feed(from_s + t * step_s, speed);
        }
    }
}

/// The least of the inner values, if it is below both ends.
fn dip(values: &[f64; POINTS]) -> Option<usize> {
    let least = (0..POINTS).fold(0, |best, i| if values[i] < values[best] { i } else { best });
    (least > 0 && least + 1 < POINTS).then_some(least)
}

/// The load at a fraction of a stretch.
fn between([from, to]: [Load; 2], t: f64) -> Load {
    let linear = |from: f64, to: f64| from + (to - from) * t;
    Load {
        table: linear(from.table, to.table),
        a: linear(from.a, to.a),
        normal: linear(from.normal, to.normal),
        slope: from.slope,
    }
}
