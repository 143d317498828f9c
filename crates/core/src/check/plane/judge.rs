//! Goes through the knots of a history in a plane in order of time and keeps the worst of everything.

use super::super::collocation::Rule;
use super::super::demands::Totals;
use super::super::energy::Books;
use super::super::events::Events;
use super::super::ground::{Ground, Load};
use super::super::judge::{Figures, STILL};
use super::super::law::{Law, StickDemand};
use super::super::near::Dips;
use super::super::outputs::Outputs;
use super::super::structure::{excess, larger};
use super::super::{Certificate, ClosestCall};
use super::decisions::{Place, Speed, Turn};
use super::frame::{Forces, Loads, Pair, PlaneFrame, norm, unit};
use super::peaks::{Acting, Peaks, Tracked};
use super::step::{State, Stepper};
use crate::error::Stopped;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::progress::Pulse;
use crate::response::{Contact, History, HistoryAlongY, InPlane, Mode, Response};

/// A history in a plane, and what it is of.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    pub(super) model: &'a Model,
    pub(super) motion: &'a GroundMotion,
    /// `Ü` along y at the samples.
    pub(super) table_y: &'a [f64],
    pub(super) response: &'a Response,
    pub(super) plane: &'a InPlane,
    pub(super) h: &'a History,
    pub(super) along_y: &'a HistoryAlongY,
}

/// What is to be judged, and the worst of it so far.
pub(super) struct PlaneJudge<'a> {
    pub(super) given: Given<'a>,
    pub(super) h: &'a History,
    pub(super) law: &'a Law,
    pub(super) stepper: Stepper<'a>,
    pub(super) outputs: &'a Outputs,
    /// The table along x and along y.
    pub(super) grounds: [Ground<'a>; 2],
    /// Largest `N` and `|Ü|`.
    pub(super) largest: (f64, f64),
    /// Rounding of a time, and the velocity that the largest acceleration gives in it.
    pub(super) instant_s: f64,
    pub(super) jolt: f64,
    /// What it makes of a force at an event at most.
    pub(super) unsure_n: f64,
    /// What the rounding of `N` makes of places and velocities in an interval.
    pub(super) drift: [f64; 2],
    pub(super) figures: Figures,
    pub(super) peaks: Peaks,
    pub(super) books: Books,
    pub(super) totals: Totals,
    pub(super) events: Events,
    /// What the events are in the plane, in their order.
    pub(super) turns: Vec<Turn>,
    pub(super) closest: Option<ClosestCall>,
    /// Margins of the stick under way.
    pub(super) dips: Dips,
    /// Speeds of the slip under way.
    pub(super) speed: Speed,
    /// Least local minimum of the sliding speed.
    pub(super) least_speed: Option<f64>,
    /// Near rest, whether the slip was straight when it came there.
    pub(super) near_rest: Option<bool>,
    /// The last direction of sliding, and the speed that was left where the last interval ended.
    pub(super) heading: Option<Pair>,
    pub(super) arrived: f64,
    /// Where `s` is at the printed time of its peak.
    pub(super) at_peak: Option<Pair>,
    pub(super) pulse: Pulse<'a>,
}

impl<'a> PlaneJudge<'a> {
    pub(super) fn new(
        given: Given<'a>,
        (frame, law): (&'a PlaneFrame<'a>, &'a Law),
        outputs: &'a Outputs,
        pulse: Pulse<'a>,
    ) -> Self {
        let Given { model, motion, table_y, h, .. } = given;
        let end_s = h.time_s.last().copied().unwrap_or(0.0);
        let grounds = [motion.horizontal_m_per_s2(), table_y]
            .map(|table| Ground::of(model, motion, table, end_s));
        let [x, y] = [0, 1].map(|axis| grounds[axis].largest(end_s));
        let tracked = Tracked { frame, outputs };
        Self {
            given,
            h,
            law,
            stepper: Stepper { frame, rule: Rule::get() },
            outputs,
            largest: (x.0, x.1.max(y.1)),
            grounds,
            instant_s: 8.0 * f64::EPSILON * end_s,
            jolt: 0.0,
            unsure_n: 0.0,
            drift: [0.0; 2],
            figures: Figures::default(),
            peaks: Peaks::new(&tracked),
            books: Books::default(),
            totals: Totals::new(1),
            events: Events::default(),
            turns: Vec::new(),
            closest: None,
            dips: Dips::new(1e-12),
            speed: Speed::new(0.0),
            least_speed: None,
            near_rest: None,
            heading: None,
            arrived: 0.0,
            at_peak: None,
            pulse,
        }
    }

    pub(super) fn frame(&self) -> &'a PlaneFrame<'a> {
        self.stepper.frame
    }

    pub(super) fn tracked(&self) -> Tracked<'a> {
        Tracked { frame: self.frame(), outputs: self.outputs }
    }

    /// The mode at a knot.
    pub(super) fn mode(&self, k: usize) -> Mode {
        self.h.modes(k)[0]
    }

    /// The state stored at a knot.
    pub(super) fn stored(&self, k: usize) -> State {
        let (h, y, n) = (self.h, self.given.along_y, self.h.storeys);
        let mut x = vec![h.sliding_displacement_m[k], y.sliding_displacement_m[k]];
        let mut v = vec![h.sliding_velocity_m_per_s[k], y.sliding_velocity_m_per_s[k]];
        if self.frame().points.is_some() {
            x.extend(h.storey_displacements(k));
            v.extend(h.storey_velocities(k));
            return State { x, v };
        }
        for i in k * n..(k + 1) * n {
            x.extend([h.storey_displacement_m[i], y.storey_displacement_m[i]]);
            v.extend([h.storey_velocity_m_per_s[i], y.storey_velocity_m_per_s[i]]);
        }
        State { x, v }
    }

    /// `s` at a knot.
    pub(super) fn place(&self, k: usize) -> Pair {
        [self.h.sliding_displacement_m[k], self.given.along_y.sliding_displacement_m[k]]
    }

    /// Judges everything; `None` where something stored is not finite.
    pub(super) fn run(mut self, bound: f64) -> Result<Option<Certificate>, Stopped> {
        if !self.measure() {
            return Ok(None);
        }
        self.go_through()?;
        Ok(Some(self.certificate(bound)))
    }

    /// Goes through all knots.
    pub(super) fn go_through(&mut self) -> Result<(), Stopped> {
        let (h, last) = (self.h, self.h.len() - 1);
        let initial = self.initial();
        self.compare(0, &initial, [0.0; 2]);
        let slides = norm(initial.speed()) > 0.0;
        let at_start = if slides { self.mode(0) } else { Mode::Stick };
        self.events.begin(h, &[at_start], Contact::Free);
        if at_start != self.mode(0) {
            self.change(0, at_start);
        }
        self.begin(self.mode(0));
        for k in 0..last {
            let length_s = h.time_s[k + 1] - h.time_s[k];
            if length_s > 0.0 {
                self.interval(k)?;
                self.totals.add(h.modes(k), Contact::Free, length_s, false);
            } else {
                if k == 0 || h.time_s[k - 1] == h.time_s[k] {
                    self.alone(k);
                }
                let before = self.stored(k);
                self.compare(k + 1, &before, [0.0, self.jolt]);
                self.turn_between(k);
            }
            let (before, after) = (self.mode(k), self.mode(k + 1));
            if before != after {
                self.close(before);
                self.events.pass(h, k + 1, false);
                self.change(k + 1, before);
                self.begin(after);
            }
        }
        if last == 0 || h.time_s[last - 1] == h.time_s[last] {
            self.alone(last);
        }
        self.close(self.mode(last));
        Ok(())
    }

    /// Scales and energies from the knots; whether all is finite.
    pub(super) fn measure(&mut self) -> bool {
        let (h, y) = (self.h, self.given.along_y);
        let lists = [
            &h.friction_force_n,
            &h.block_acceleration_m_per_s2,
            &h.table_acceleration_m_per_s2,
            &h.storey_acceleration_m_per_s2,
            &y.friction_force_n,
            &y.block_acceleration_m_per_s2,
            &y.table_acceleration_m_per_s2,
            &y.storey_acceleration_m_per_s2,
        ];
        let mut finite = lists.into_iter().flatten().all(|value| value.is_finite());
        let (mut kinetic, mut strain) = (Vec::new(), Vec::new());
        let (mut far, mut fast, mut storey, mut sliding) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        for k in 0..h.len() {
            let state = self.stored(k);
            finite &= state.x.iter().chain(&state.v).all(|value| value.is_finite());
            let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            far = far.max(most(&state.x));
            storey = storey.max(most(&state.x[2..]));
            fast = fast.max(most(&state.v));
            sliding = sliding.max(norm(state.speed()));
            kinetic.push(self.frame().kinetic_energy(&state.v));
            strain.push(self.frame().strain(&state.x));
        }
        let blocks = h.block_acceleration_m_per_s2.iter().chain(&y.block_acceleration_m_per_s2);
        let sharp = blocks.fold(self.largest.1, |most: f64, b| most.max(b.abs()));
        self.jolt = self.instant_s * sharp;
        let rest = 1e-4 * self.frame().frequency * storey;
        self.figures.displacement[1] = far.max(self.instant_s * self.jolt);
        self.figures.velocity[1] = fast.max(rest).max(self.jolt);
        self.speed = Speed::new(STILL * sliding + 64.0 * f64::EPSILON * fast);
        let varies = self.grounds[0].has_vertical();
        self.books = Books::new([kinetic, strain], 0.0, [varies, self.law.follows()]);
        finite
    }

    /// The state with which the model starts.
    pub(super) fn initial(&self) -> State {
        let model = self.given.model;
        let along_y = model.along_y();
        let (x, y, n) = (model.initial(), along_y.initial, model.storeys());
        let or_zeros = |list: Option<Vec<f64>>| list.unwrap_or_else(|| vec![0.0; n]);
        let pairs = |x: f64, y: f64, storeys: [Vec<f64>; 2]| {
            let mut list = vec![x, y];
            let [x, y] = storeys;
            list.extend(x.into_iter().zip(y).flat_map(|(x, y)| [x, y]));
            list
        };
        if self.frame().points.is_some() {
            let of = |x: f64, y: f64, parts: Option<Vec<f64>>| {
                let zeros = || vec![0.0; self.frame().masses_kg.len()];
                [vec![x, y], parts.unwrap_or_else(zeros)].concat()
            };
            let [s, w] = [
                [x.sliding_displacement_m, y.sliding_displacement_m],
                [x.sliding_velocity_m_per_s, y.sliding_velocity_m_per_s],
            ];
            return State {
                x: of(s[0], s[1], y.storey_displacement_m),
                v: of(w[0], w[1], y.storey_velocity_m_per_s),
            };
        }
        let q = [model.initial_storey_displacement_m(), or_zeros(y.storey_displacement_m)];
        let v = [model.initial_storey_velocity_m_per_s(), or_zeros(y.storey_velocity_m_per_s)];
        State {
            x: pairs(x.sliding_displacement_m, y.sliding_displacement_m, q),
            v: pairs(x.sliding_velocity_m_per_s, y.sliding_velocity_m_per_s, v),
        }
    }

    /// Compares the state stored at a knot with another, less what is rounding of it.
    pub(super) fn compare(&mut self, k: usize, own: &State, rounding: [f64; 2]) {
        let stored = self.stored(k);
        let lists = [(&own.x, &stored.x), (&own.v, &stored.v)];
        let figures = [&mut self.figures.displacement, &mut self.figures.velocity];
        for ((figure, (own, stored)), rounding) in figures.into_iter().zip(lists).zip(rounding) {
            for (own, stored) in own.iter().zip(stored) {
                figure[0] = larger(figure[0], excess((own - stored).abs() - rounding));
            }
        }
    }

    /// All that the table does at one instant, from left to right.
    pub(super) fn instant(&self, t: f64) -> [Loads; 4] {
        let [x, y] = [0, 1].map(|axis| self.grounds[axis].instant(t));
        core::array::from_fn(|i| [x[i], y[i]])
    }

    /// What a block at rest is asked for, and the rounding of it.
    pub(super) fn asked(&self, push: Pair, loads: &Loads) -> (StickDemand, f64) {
        let high = self.frame().fixed * loads[0].normal;
        let demand = StickDemand { demand: self.frame().block_kg * norm(push), low: -high, high };
        (demand, self.rounding(loads))
    }

    /// What the rounding of times makes of what a block at rest is asked for, less what holds it.
    pub(super) fn rounding(&self, loads: &Loads) -> f64 {
        let blur = self.grounds[0].blur();
        let table = |load: &Load, mu| load.rounding(blur, self.frame().block_kg, mu);
        table(&loads[0], self.frame().fixed) + table(&loads[1], 0.0)
    }

    /// Forces in the state stored at a knot.
    pub(super) fn forces(&self, state: &State, loads: &Loads) -> (Forces, Vec<f64>) {
        let mut floors = vec![0.0; self.frame().masses_kg.len()];
        let forces = self.frame().forces(&state.x, &state.v, loads, &mut floors);
        (forces, floors)
    }

    /// Compares what is stored at a knot with the loads on one side of it: the accelerations of the table, the
    /// law of friction, the balance of forces. At the start of a slip from rest friction is against the
    /// push, at its end it has any direction.
    pub(super) fn side(&self, k: usize, loads: &Loads, place: Place) -> Side {
        let (h, y, frame) = (self.h, self.given.along_y, self.frame());
        let state = self.stored(k);
        let (forces, floors) = self.forces(&state, loads);
        let at = |x: &[f64], y: &[f64], i: usize| [x[i], y[i]];
        let own = at(&h.table_acceleration_m_per_s2, &y.table_acceleration_m_per_s2, k);
        let block = at(&h.block_acceleration_m_per_s2, &y.block_acceleration_m_per_s2, k);
        let friction = at(&h.friction_force_n, &y.friction_force_n, k);
        let mut side = Side::default();
        for (load, own) in loads.iter().zip(own) {
            let off = (load.table - own).abs() - self.instant_s * load.slope.abs();
            side.table = larger(side.table, excess(off));
        }
        let normal_n = loads[0].normal_rounding(self.grounds[0].blur());
        let follows_n = frame.curvature_per_m * normal_n * norm([state.x[0], state.x[1]]);
        if self.mode(k) == Mode::Stick {
            side.speed = norm(state.speed());
            let split = [0, 1].map(|i| frame.block_kg * (block[i] - own[i]));
            side.defect = norm(split);
        } else {
            let slid = frame.block_kg * frame.slowing(loads, norm(state.speed()));
            let departs = || frame.body.departure(forces.push, frame.slowing(loads, 0.0));
            let at_rest = (place == Place::Start).then(departs).flatten();
            let off = match unit(state.speed()).or(at_rest) {
                Some(u) => norm([0, 1].map(|i| friction[i] + slid * u[i])),
                None => (norm(friction) - slid).abs(),
            };
            side.excess = excess(off - frame.most * normal_n);
        }
        let Forces { base, spring, damper, .. } = forces;
        let inertia = frame.inertia(block);
        let balance = [0, 1].map(|i| inertia[i] - base[i] + spring[i] + damper[i] - friction[i]);
        side.defect = larger(side.defect, excess(norm(balance) - follows_n));
        for vector in [inertia, base, spring, damper, friction] {
            side.term = larger(side.term, norm(vector));
        }
        let n = h.storeys;
        for (i, (force, mass)) in floors.iter().zip(&frame.masses_kg).enumerate() {
            let lists = [&h.storey_acceleration_m_per_s2, &y.storey_acceleration_m_per_s2];
            let own = match frame.points {
                Some(_) => lists[0][k * n + i],
                None => lists[i % 2][k * n + i / 2],
            };
            let inertia = mass * own;
            side.defect = larger(side.defect, inertia + force);
            side.term = larger(side.term, inertia);
        }
        side
    }

    /// Takes up what one side of a knot tells.
    pub(super) fn take(&mut self, side: &Side) {
        let f = &mut self.figures;
        f.table[0] = larger(f.table[0], side.table);
        f.excess = larger(f.excess, side.excess);
        f.velocity[0] = larger(f.velocity[0], side.speed);
        f.force[0] = larger(f.force[0], side.defect);
        f.force[1] = larger(f.force[1], side.term);
    }

    /// Judges a knot at which no interval ends or begins by the load that suits it best.
    fn alone(&mut self, k: usize) {
        let all = self.instant(self.h.time_s[k]);
        let sides = all.map(|loads| self.side(k, &loads, Place::Alone));
        let off = |side: &Side| [side.table, side.excess + side.defect];
        let better = |a: usize, b: usize| if off(&sides[b]) < off(&sides[a]) { b } else { a };
        let best = (1..4).fold(0, better);
        self.take(&sides[best]);
        if k == 0 || k + 1 == self.h.len() {
            let state = self.stored(k);
            let loads = all[if k == 0 { 1 } else { 2 }];
            let (forces, floors) = self.forces(&state, &loads);
            let slips = self.mode(k) != Mode::Stick;
            let departs = || {
                let frame = self.frame();
                frame.body.departure(forces.push, frame.slowing(&loads, 0.0))
            };
            let direction = unit(state.speed()).or_else(departs).filter(|_| slips);
            let acting = Acting { state: &state, loads, forces, floors: &floors, direction };
            self.peaks.see(&self.tracked(), &acting);
        }
    }

    /// Keeps the least margin; rounding may leave one a little below 0.
    pub(super) fn nearest(&mut self, call: ClosestCall) {
        let call = ClosestCall { margin: call.margin.abs(), ..call };
        if self.closest.is_none_or(|closest| call.margin < closest.margin) {
            self.closest = Some(call);
        }
    }
}

/// What one side of a knot tells.
#[derive(Clone, Copy, Default)]
pub(super) struct Side {
    table: f64,
    excess: f64,
    /// Velocity in stick.
    speed: f64,
    defect: f64,
    term: f64,
}
