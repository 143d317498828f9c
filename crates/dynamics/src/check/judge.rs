//! Goes from knot to knot of a history in order of time, in one horizontal direction or in two, and keeps the
//! worst of everything.

use super::collocation::{POINTS, Rule};
use super::demands::{Comparison, Rounding, Totals};
use super::energy::EnergyBalance;
use super::events::Events;
use super::ground::{Ground, Load};
use super::law::{Law, StickDemand};
use super::near::{LocalMinima, dip};
use super::outputs::Outputs;
use super::structure::{excess, larger};
use super::{Certificate, ClosestCall, DecisionKind};
use crate::error::Stopped;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::progress::Pulse;
use crate::response::{Contact, History, Mode, Response};
use crate::slider::Direction;

/// A sliding velocity below this part of its peak has no sign: the depth of a dip through zero that
/// the exact method may miss.
pub(super) const STILL: f64 = 1e-12;

/// Largest defects so far, each with the scale it is measured by.
#[derive(Default)]
pub(super) struct Figures {
    pub(super) displacement: [f64; 2],
    pub(super) velocity: [f64; 2],
    pub(super) force: [f64; 2],
    pub(super) table: [f64; 2],
    pub(super) excess: f64,
}

impl Figures {
    /// The largest defect over its scale; that of the table is over its own peak.
    pub(super) fn equilibrium(&self, table: f64) -> f64 {
        let all = [self.displacement, self.velocity, self.force, [self.table[0], table]];
        all.map(relative).into_iter().fold(0.0, larger)
    }
}

/// The largest defect over its scale, where `pair` is `[defect, scale]`.
pub(super) fn relative(pair: [f64; 2]) -> f64 {
    if pair[0] == 0.0 { 0.0 } else { pair[0] / pair[1] }
}

/// Knots of constant modes and contact, and the intervals between them.
#[derive(Clone, Copy)]
pub(super) struct Run {
    pub(super) from: usize,
    pub(super) to: usize,
}

/// Largest sizes at knots.
#[derive(Default)]
pub(super) struct Sizes {
    pub(super) displacement_m: f64,
    pub(super) storey_m: f64,
    pub(super) velocity: f64,
    pub(super) sliding: f64,
    pub(super) acceleration: f64,
    /// Of the frame on a block that rests, in rad/s.
    pub(super) frequency: f64,
}

/// What is judged.
pub(super) struct JudgeInput<'a> {
    pub(super) model: &'a Model,
    pub(super) motion: &'a GroundMotion,
    pub(super) response: &'a Response,
    pub(super) history: &'a History,
    pub(super) law: &'a Law,
    pub(super) outputs: &'a Outputs,
    pub(super) pulse: Pulse<'a>,
}

/// What is to be judged, and the worst of it so far.
pub(super) struct Judge<'a, A> {
    pub(super) model: &'a Model,
    pub(super) response: &'a Response,
    pub(super) h: &'a History,
    pub(super) law: &'a Law,
    pub(super) outputs: &'a Outputs,
    /// The table along x.
    pub(super) ground: Ground<'a>,
    /// Largest `N` and `|Ü|`.
    pub(super) largest: (f64, f64),
    /// Velocities below this are zero to within rounding.
    pub(super) zero_velocity: f64,
    /// Rounding of a time.
    pub(super) instant_s: f64,
    /// What it makes of a force at an event at most.
    pub(super) unsure_n: f64,
    /// Velocity that the largest acceleration gives in that time.
    pub(super) velocity_rounding: f64,
    /// What the rounding of `N` makes of places and velocities in an interval.
    pub(super) state_rounding: [f64; 2],
    pub(super) figures: Figures,
    pub(super) books: EnergyBalance,
    pub(super) runs: Vec<Run>,
    /// Modes before the first knot: a block with a velocity slides on.
    pub(super) at_start: Vec<Mode>,
    /// Near decisions of the phases under way, by interface.
    pub(super) dips: Vec<LocalMinima>,
    pub(super) closest: Option<ClosestCall>,
    pub(super) totals: Totals,
    pub(super) events: Events,
    /// Asks whether to go on.
    pub(super) pulse: Pulse<'a>,
    pub(super) axes: A,
}

/// What differs between one horizontal direction and two.
pub(super) trait Directions {
    /// Entries of `x` and of `v`.
    fn degrees(&self) -> usize;
    /// Displacement and velocity of a degree stored at a knot.
    fn stored(&self, k: usize, degree: usize) -> [f64; 2];
    /// Displacement and velocity of a degree with which the model starts.
    fn initial(&self, degree: usize) -> [f64; 2];
    /// Speed of an interface's sliding stored at a knot.
    fn speed_at(&self, k: usize, interface: usize) -> f64;
    /// Looks at every knot by itself: scales, energies. `false` where something stored is not finite.
    fn measure(&mut self) -> Result<bool, Stopped>;
    /// Judges the changes of mode at these knots.
    fn decide(&mut self, changes: &[usize]);
    /// Judges the intervals of a run in order of time.
    fn go_through(&mut self, run: Run) -> Result<(), Stopped>;
    /// Judges a knot at which no interval ends or begins.
    fn isolated_knot(&mut self, k: usize);
    /// Judges what happens between a knot and the one before at the same time; whether a rigid stop is struck.
    fn at_same_time(&mut self, k: usize) -> bool;
    /// The closest call of a slip of an interface that has ended.
    fn closest_call_of_slip(&mut self, i: usize, direction: Direction) -> Option<ClosestCall>;
    /// Where the block is to a stop at a knot, and how fast it goes there: on one side of it a negative place.
    fn at_stop(&self, k: usize) -> [f64; 2] {
        self.stored(k, 0)
    }
    /// Whether the block is at a rigid stop at a knot, which it leans on if it rests.
    fn leans(&self, k: usize) -> bool;
    /// Judges the knot at which contact with a stop has changed.
    fn touched(&mut self, _: usize) {}
    /// Judges the knot at which some mode has changed.
    fn changed(&mut self, _: usize) {}
    /// A phase of an interface begins.
    fn begins(&mut self, _: usize) {}
    /// Largest inertia that cancels out of what is found, in N.
    fn carried_n(&self) -> f64 {
        0.0
    }
    /// Compares the printed demands with those of the path.
    fn compare_demands(&self, c: &mut Comparison, rounding: &Rounding);
}

impl<'a, A> Judge<'a, A>
where
    Self: Directions,
{
    /// `slides`: whether the block starts with a velocity.
    pub(super) fn new(given: JudgeInput<'a>, slides: bool, axes: A) -> Self {
        let JudgeInput { model, motion, response, history, law, outputs, pulse } = given;
        let end_s = history.time_s.last().copied().unwrap_or(0.0);
        let ground = Ground::new(model, motion, end_s);
        let mut at_start = vec![Mode::Stick; history.interfaces];
        if slides {
            at_start[0] = history.mode[0];
        }
        Self {
            model,
            response,
            h: history,
            law,
            outputs,
            largest: ground.largest(end_s),
            ground,
            zero_velocity: 0.0,
            instant_s: 8.0 * f64::EPSILON * end_s,
            unsure_n: 0.0,
            velocity_rounding: 0.0,
            state_rounding: [0.0; 2],
            figures: Figures::default(),
            books: EnergyBalance::default(),
            runs: find_runs(history),
            at_start,
            dips: vec![LocalMinima::new(0.0); history.interfaces],
            closest: None,
            totals: Totals::new(history.interfaces),
            events: Events::default(),
            pulse,
            axes,
        }
    }

    /// Judges everything; `None` where something stored is not finite.
    pub(super) fn run(mut self, bound: f64) -> Result<Option<Certificate>, Stopped> {
        if !self.measure()? {
            return Ok(None);
        }
        self.go_on()?;
        Ok(Some(self.certificate(bound)))
    }

    /// Judges what comes after the knots by themselves.
    pub(super) fn go_on(&mut self) -> Result<(), Stopped> {
        for degree in 0..self.degrees() {
            self.compare(0, degree, self.initial(degree), [0.0; 2]);
        }
        let begin = self.runs.iter().map(|run| run.from);
        let changes: Vec<usize> = begin.filter(|&k| self.before(k) != self.h.modes(k)).collect();
        self.decide(&changes);
        self.walk()
    }

    /// Takes what defects are measured by.
    pub(super) fn take_sizes(&mut self, sizes: &Sizes) {
        // What the rounding of a time makes of the largest acceleration is no motion.
        self.velocity_rounding = self.instant_s * sizes.acceleration;
        // A frame held at rest by its weight on a slope moves by rounding alone: its velocities
        // are measured by the static displacement, not by themselves.
        let rest = 1e-4 * sizes.frequency * sizes.storey_m;
        self.figures.displacement[1] =
            sizes.displacement_m.max(self.instant_s * self.velocity_rounding);
        self.figures.velocity[1] = sizes.velocity.max(rest).max(self.velocity_rounding);
        self.zero_velocity = STILL * sizes.sliding + 64.0 * f64::EPSILON * sizes.velocity;
    }

    /// Modes before a knot.
    pub(super) fn before(&self, k: usize) -> &[Mode] {
        k.checked_sub(1).map_or(&self.at_start[..], |k| self.h.modes(k))
    }

    /// Contact with the stop at a knot.
    pub(super) fn contact(&self, k: usize) -> Contact {
        self.h.contact.get(k).copied().unwrap_or(Contact::Free)
    }

    /// Compares the stored state of a degree at a knot with another, less what is rounding of it.
    pub(super) fn compare(
        &mut self,
        k: usize,
        degree: usize,
        [x, v]: [f64; 2],
        [rounding_m, rounding]: [f64; 2],
    ) {
        let [stored_m, stored] = self.stored(k, degree);
        let f = &mut self.figures;
        f.displacement[0] = larger(f.displacement[0], excess((stored_m - x).abs() - rounding_m));
        f.velocity[0] = larger(f.velocity[0], excess((stored - v).abs() - rounding));
    }

    /// What the rounding of `N` makes of a place and a velocity in an interval of a length, from the acceleration that it
    /// may be.
    pub(super) fn take_state_rounding(&mut self, acceleration: f64, length_s: f64) -> [f64; 2] {
        let state_rounding = acceleration * length_s;
        let drift_m = 0.5 * length_s * state_rounding;
        self.state_rounding =
            [self.state_rounding[0].max(drift_m), self.state_rounding[1].max(state_rounding)];
        [drift_m, state_rounding]
    }

    /// Compares the end of a path with the knot stored there, degree by degree: displacement and velocity, less what the
    /// rounding of times makes of the largest velocity and the largest rate on the way, and that of `N`. Between two
    /// knots the motion may be faster and go farther than at any.
    pub(super) fn arrive(
        &mut self,
        (k, degree): (usize, usize),
        end: [f64; 2],
        [fastest, rate]: [f64; 2],
        state_rounding: [f64; 2],
    ) {
        let rounding = [
            self.instant_s * fastest + state_rounding[0],
            self.instant_s * rate + state_rounding[1],
        ];
        self.compare(k, degree, end, rounding);
        let f = &mut self.figures;
        f.displacement[1] = larger(f.displacement[1], end[0]);
        f.velocity[1] = larger(f.velocity[1], fastest);
    }

    /// Goes from run to run in order of time.
    fn walk(&mut self) -> Result<(), Stopped> {
        let (h, last) = (self.h, self.h.len() - 1);
        let [s, w] = self.at_stop(0);
        let contact = match self.contact(0) {
            // A start at a rigid stop, along it.
            bears if w == 0.0 && self.law.bears_on_stop(s) != [false; 2] => bears,
            _ => self.law.contact_at_start(s, w),
        };
        let touched = self.events.begin(h, &self.at_start, (contact, w.abs()));
        if self.at_start != h.modes(0) {
            self.changed(0);
        }
        if touched {
            self.touched(0);
        }
        for i in 0..h.interfaces {
            self.begin(i, 0);
        }
        let runs = core::mem::take(&mut self.runs);
        let mut arrived = None;
        for &run in &runs {
            let Run { from, to } = run;
            if let Some(arrived) = arrived {
                self.join(from, arrived);
            }
            if from < to {
                let bears_on_stop = self.leans(from);
                let length_s = h.time_s[to] - h.time_s[from];
                self.totals.add(h.modes(from), self.contact(from), length_s, bears_on_stop);
                self.go_through(run)?;
            } else if arrived != Some(from) {
                self.isolated_knot(from);
            }
            arrived = Some(to);
        }
        self.runs = runs;
        for (i, mode) in h.modes(last).iter().enumerate() {
            self.close(i, *mode);
        }
        for call in self.near_misses() {
            self.nearest(call);
        }
        Ok(())
    }

    /// Passes from the end of a run to the knot `k`, at which the next begins: the same, or one abreast.
    fn join(&mut self, k: usize, arrived: usize) {
        let h = self.h;
        let (before, after) = (h.modes(k - 1), h.modes(k));
        let changed = |i: &usize| before[*i] != after[*i];
        let struck = arrived < k && self.at_same_time(k);
        for i in (0..after.len()).filter(changed) {
            if !struck {
                self.figures.velocity[0] = larger(self.figures.velocity[0], self.speed_at(k, i));
            }
            self.close(i, before[i]);
        }
        let touched = (struck || before != after || !h.contact.is_empty()) && {
            let [before, speed] = [k - 1, k].map(|k| self.at_stop(k)[1].abs());
            self.events.pass(h, k, struck.then_some(before), speed)
        };
        if before != after {
            self.changed(k);
        }
        if touched {
            self.touched(k);
        }
        for i in (0..after.len()).filter(changed) {
            self.begin(i, k);
        }
    }

    /// Begins a phase of an interface at a knot.
    fn begin(&mut self, i: usize, k: usize) {
        let slack = if self.h.modes(k)[i] == Mode::Stick { 1e-12 } else { self.zero_velocity };
        self.dips[i] = LocalMinima::new(slack);
        self.begins(i);
    }

    /// Ends a phase of an interface: its near decisions are known.
    fn close(&mut self, i: usize, mode: Mode) {
        let call = match mode {
            Mode::Stick => self.dips[i].least(DecisionKind::Stick, i),
            Mode::Slip(direction) => self.closest_call_of_slip(i, direction),
        };
        if let Some(call) = call {
            self.nearest(call);
        }
    }

    /// Judges a step of a stick, from a time on and of a length: what an interface is asked for at its points, and
    /// between two of them, by the part of the step, where that comes closest to what holds.
    pub(super) fn held(
        &mut self,
        i: usize,
        (from_s, step_s): (f64, f64),
        rounding_n: f64,
        at_points: &[StickDemand; POINTS],
        between: impl Fn(&Self, f64) -> StickDemand,
    ) {
        let rule = Rule::get();
        let mut margins = [f64::NAN; POINTS];
        for (margin, asked) in margins.iter_mut().zip(at_points) {
            self.figures.excess = larger(self.figures.excess, excess(asked.beyond() - rounding_n));
            *margin = asked.margin().unwrap_or(f64::NAN);
        }
        if margins.iter().any(|margin| margin.is_nan()) {
            self.dips[i].interrupt();
            return;
        }
        let least = dip(&margins);
        for (point, mut found) in rule.points.into_iter().zip(margins).enumerate() {
            if least == Some(point) {
                let margin = |t: f64| between(self, t).margin().unwrap_or(f64::INFINITY);
                found = rule.least_of((point, found.1), margin);
                let broken = excess(-found.1 * between(self, found.0).bound() - rounding_n);
                self.figures.excess = larger(self.figures.excess, broken);
            }
            let (t, margin) = found;
            self.dips[i].feed(from_s + t * step_s, margin);
        }
        // A plateau near the bound is as close a call as a maximum, if it is no sliver of one.
        let flat = margins.iter().all(|margin| (margin - margins[0]).abs() <= 1e-12);
        if flat && step_s > 1e6 * self.instant_s && margins[0] < 1.0 {
            self.dips[i].take(from_s, margins[0]);
        }
    }

    /// Keeps the least margin; rounding may leave one a little below 0.
    pub(super) fn nearest(&mut self, call: ClosestCall) {
        let call = ClosestCall { margin: call.margin.abs(), ..call };
        if self.closest.is_none_or(|closest| call.margin < closest.margin) {
            self.closest = Some(call);
        }
    }

    /// Turns of the block short of a rigid stop: how far, over the gap, or over the largest displacement where the gap
    /// is 0.
    fn near_misses(&self) -> Vec<ClosestCall> {
        let h = self.h;
        let place = |k: usize| self.at_stop(k)[0];
        let largest_m = || (0..h.len()).fold(0.0, |most, k| larger(most, place(k)));
        let mut calls = Vec::new();
        for side in Direction::BOTH {
            let Some(wall) = self.law.wall(side) else { continue };
            let gap_m = wall.abs();
            // Where the block came to a halt on its way there.
            let halts = (0..h.len().saturating_sub(1)).filter(|&k| {
                h.modes(k)[0] == Mode::Slip(side)
                    && h.modes(k + 1)[0] != Mode::Slip(side)
                    && self.speed_at(k, 0) == 0.0
            });
            let turns = halts.map(|k| (side.sign() * place(k), k));
            let turns = turns.filter(|(s, _)| *s < gap_m);
            if let Some((s, k)) = turns.reduce(|a, b| if b.0 > a.0 { b } else { a }) {
                let scale_m = if gap_m > 0.0 { gap_m } else { largest_m() };
                let (margin, time_s) = ((gap_m - s) / scale_m, h.time_s[k]);
                calls.push(ClosestCall { margin, time_s, kind: DecisionKind::Miss, interface: 0 });
            }
        }
        calls
    }

    /// Of a change of mode of an interface at a knot, at which it has no velocity: by how much the demand forbids
    /// it, by the load and the place that do so least, and the margin of its first place with the rounding of it.
    /// There are loads before, at and after the knot, and places of what else has changed by then.
    pub(super) fn weigh(
        &self,
        (k, i): (usize, usize),
        nearest: [bool; 4],
        places: usize,
        asked: impl Fn(usize, usize) -> (StickDemand, f64),
    ) -> (f64, Option<(f64, f64)>) {
        let (was, is) = (self.before(k)[i], self.h.modes(k)[i]);
        let (mut least, mut closest) = (f64::INFINITY, f64::INFINITY);
        let mut margin = None;
        // What a jump passes on its way lets go too.
        for load in (0..4).filter(|&load| nearest[load] || was == Mode::Stick) {
            for place in 0..places {
                let (asked, rounding) = asked(load, place);
                let beyond = match is {
                    Mode::Stick => asked.beyond(),
                    Mode::Slip(Direction::Positive) => asked.demand - asked.low,
                    Mode::Slip(Direction::Negative) => asked.high - asked.demand,
                };
                let beyond = excess(beyond - rounding);
                if place == 0 && beyond <= closest {
                    closest = beyond;
                    margin = asked.margin().map(|m| (m.abs(), rounding / asked.bound()));
                }
                least = least.min(beyond);
            }
        }
        (least, margin)
    }

    /// What the rounding of `N` makes of what the slider's friction follows, in N.
    pub(super) fn pressed_rounding(&self, load: &Load) -> f64 {
        let rounding = load.normal_rounding(self.ground.load_rounding());
        self.law.pressed_rounding(load.normal, rounding)
    }

    /// Takes what a change of mode has been found to be.
    pub(super) fn decided(
        &mut self,
        (k, i): (usize, usize),
        (excess, margin): (f64, Option<(f64, f64)>),
    ) {
        self.figures.excess = larger(self.figures.excess, excess);
        if let Some((margin, rounding)) = margin.filter(|_| self.before(k)[i] != Mode::Stick) {
            if i == 0 {
                self.totals.decided(margin, rounding);
            }
            let (time_s, kind) = (self.h.time_s[k], DecisionKind::Stop);
            self.nearest(ClosestCall { margin, time_s, kind, interface: i });
        }
    }

    /// What all tells.
    fn certificate(self, bound: f64) -> Certificate {
        let (normal, table) = self.largest;
        let f = &self.figures;
        // 64 ε of what a difference is made of is rounding.
        let near = |scale: f64| 64.0 * f64::EPSILON * scale;
        let blur_n = self.law.rounding(&self.ground, self.instant_s, normal);
        let rounding = Rounding {
            instant_s: self.instant_s,
            displacement_m: near(f.displacement[1]) + self.state_rounding[0],
            velocity_m_per_s: near(f.velocity[1]) + self.velocity_rounding + self.state_rounding[1],
            force_n: near(larger(f.force[1], self.carried_n())) + self.unsure_n + blur_n,
        };
        let mut demands = Comparison::default();
        self.compare_demands(&mut demands, &rounding);
        let jolt_j = self.model.total_mass_kg() * self.velocity_rounding * self.velocity_rounding;
        Certificate {
            equilibrium_residual: f.equilibrium(table),
            friction_excess: relative([f.excess, self.law.scale(normal, self.model.weight_n())]),
            energy_balance_error: self
                .books
                .error(jolt_j, |k| unsure(&self.h.time_s, self.instant_s, k)),
            demands_error: demands.worst,
            demand_in_error: demands.worst_of(),
            closest_call: self.closest,
            bound,
            books: self.books,
        }
    }
}

/// Runs of knots in order: one begins where the last has ended, or abreast of it.
fn find_runs(h: &History) -> Vec<Run> {
    let t = &h.time_s[..];
    let last = h.len() - 1;
    let same = |k: usize| h.modes(k) == h.modes(k + 1) && h.contact.get(k) == h.contact.get(k + 1);
    let alone = h.interfaces == 1 && h.contact.is_empty();
    let mut runs = Vec::new();
    let (mut from, mut k) = (0, 0);
    while k < last {
        let goes_on = if alone { h.mode[k] == h.mode[k + 1] } else { same(k) };
        if t[k + 1] > t[k] && goes_on {
            k += 1;
            continue;
        }
        // An interval has the modes of its start.
        let to = if t[k + 1] > t[k] { k + 1 } else { k };
        runs.push(Run { from, to });
        (from, k) = (k + 1, k + 1);
    }
    runs.push(Run { from, to: last });
    runs
}

/// The part of the interval from a knot that the rounding of an event's time may be, where one is beside it.
pub(super) fn unsure(times_s: &[f64], instant_s: f64, k: usize) -> f64 {
    let stands_twice = |k: usize| times_s.get(k + 1) == Some(&times_s[k]);
    if (k > 0 && stands_twice(k - 1)) || stands_twice(k + 1) {
        (instant_s / (times_s[k + 1] - times_s[k])).min(1.0)
    } else {
        0.0
    }
}
