//! Goes through the knots of a history and keeps the worst of everything.

use super::collocation::Scheme;
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
pub(super) const STILL: f64 = 1e-12;

/// Largest defects so far, each with the scale it is measured by.
#[derive(Default)]
pub(super) struct Figures {
    pub(super) displacement: [f64; 2],
    pub(super) velocity: [f64; 2],
    force: [f64; 2],
    table: [f64; 2],
    pub(super) excess: f64,
}

/// The largest defect over its scale, where `pair` is `[defect, scale]`.
fn relative(pair: [f64; 2]) -> f64 {
    if pair[0] == 0.0 { 0.0 } else { pair[0] / pair[1] }
}

pub(super) struct Judge<'a> {
    model: &'a Model,
    history: &'a History,
    pub(super) structure: &'a Structure,
    ground: Ground<'a>,
    pub(super) law: Law,
    pub(super) scheme: Scheme<'a>,
    /// Velocities below this are zero to within rounding.
    pub(super) still: f64,
    /// Rounding of a time.
    pub(super) instant_s: f64,
    /// Velocity that the largest acceleration gives in that time.
    jolt: f64,
    /// Within an interval: the largest velocity of the wrong sign, the largest excess by such.
    pub(super) astray: [f64; 2],
    /// Within an interval: the largest size of each velocity.
    pub(super) fastest: Vec<f64>,
    pub(super) figures: Figures,
    pub(super) energy: Energy,
    /// Near decisions of the phase under way.
    pub(super) dips: Dips,
    closest: Option<ClosestCall>,
    /// `(x, v)` along an interval.
    pub(super) state: Vec<f64>,
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
            jolt: 0.0,
            astray: [0.0; 2],
            fastest: vec![0.0; d],
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
        // What the rounding of a time makes of the largest acceleration is no motion either.
        let acceleration =
            larger(peak(&h.block_acceleration_m_per_s2), peak(&h.table_acceleration_m_per_s2));
        self.jolt = self.instant_s * acceleration;
        let distance = larger(storey, peak(&h.sliding_displacement_m));
        self.figures.displacement[1] = larger(distance, self.instant_s * self.jolt);
        self.figures.velocity[1] = larger(larger(speed, rest), self.jolt);
        self.still = STILL * sliding + 64.0 * f64::EPSILON * speed;
    }

    /// Judges everything.
    pub(super) fn run(mut self, bound: f64) -> Certificate {
        let times = &self.history.time_s;
        let knots = times.len();
        self.load_state(0);
        self.start();
        let initial_j = self.structure.kinetic(self.v()) + self.structure.strain(self.x());
        self.energy.start(initial_j, self.model.total_mass_kg() * self.jolt * self.jolt);
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

    /// Compares the state integrated from the knot `k` with the stored one at the next, less what
    /// the motion changes within the rounding of their times.
    fn arrive(&mut self, k: usize, end: &[f64]) {
        let d = self.structure.degrees();
        for i in 0..d {
            let [from, to] = [k, k + 1].map(|k| self.stored_acceleration(k, i).abs());
            for (at, rate, figure) in [
                (i, self.fastest[i], &mut self.figures.displacement),
                (d + i, from.max(to), &mut self.figures.velocity),
            ] {
                let defect = (self.stored[at] - end[at]).abs() - self.instant_s * rate;
                figure[0] = larger(figure[0], excess(defect));
            }
        }
    }

    /// `s̈` or `q̈_i` from the accelerations stored at a knot.
    fn stored_acceleration(&self, k: usize, degree: usize) -> f64 {
        let block = self.history.block_acceleration_m_per_s2[k];
        match degree.checked_sub(1) {
            None => block - self.history.table_acceleration_m_per_s2[k],
            Some(storey) => self.history.storey_accelerations(k)[storey] - block,
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
        self.fastest.fill(0.0);
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
                self.arrive(k, &end);
                // What the knot's own defect and the rounding of times explain is no sign.
                let defect = (self.stored[d] - end[d]).abs();
                let jerked = [k, k + 1].map(|k| self.stored_acceleration(k, 0).abs());
                let blur = defect + self.instant_s * jerked[0].max(jerked[1]);
                if self.astray[0] > self.still + blur {
                    self.figures.excess = larger(self.figures.excess, self.astray[1]);
                }
                self.state = end;
                return (first, piece.loads[1]);
            }
        }
    }
}

/// The load at a fraction of a stretch.
pub(super) fn between([from, to]: [Load; 2], t: f64) -> Load {
    let linear = |from: f64, to: f64| from + (to - from) * t;
    Load {
        table: linear(from.table, to.table),
        a: linear(from.a, to.a),
        normal: linear(from.normal, to.normal),
        slope: from.slope,
    }
}
