//! What follows an instant at which interfaces have no velocity, and impacts.
//!
//! Interfaces without velocity are held; one whose demand is beyond its bound is let go and the others
//! are asked again, as its start changes what they are asked for: what static friction can hold stays.

use super::super::ground::Stretch;
use super::super::slider::{Start, first_crossing, leaving_order};
use super::{Near, SLOWEST_IMPACT_M_PER_S, Stepping};
use crate::friction::Direction;
use crate::linear::polynomial::Polynomial;
use crate::response::{EventKind, Mode};

/// Where a bounce is below the rounding of `s`: parts of the stop's distance.
const LEAST_BOUNCE: f64 = 4.0 * f64::EPSILON;

/// Longest remaining time of infinitely many bounces, in s: it is left out.
const LONGEST_REST_S: f64 = 1e-13;

/// What friction is asked for and what it holds, over one unit where from is a series.
#[derive(Clone, Copy)]
struct Asked {
    /// Force asked for.
    demand: f64,
    /// What holds.
    low: f64,
    high: f64,
    /// Measure of both.
    scale: f64,
}

impl Asked {
    fn gives_way(&self) -> Option<Direction> {
        if self.demand > self.high {
            Some(Direction::Negative)
        } else if self.demand < self.low {
            Some(Direction::Positive)
        } else {
            None
        }
    }

    /// How far the demand is beyond what holds.
    fn beyond(&self) -> f64 {
        (self.demand - self.high).max(self.low - self.demand) / self.scale
    }
}

impl Stepping<'_> {
    /// Whether an interface slides without a velocity.
    pub(super) fn has_stopped(&self, interface: usize) -> bool {
        matches!(self.modes[interface], Mode::Slip(_))
            && self.start[interface].is_none()
            && self.velocity(interface) == 0.0
    }

    /// What a stuck interface is asked for at the instant last looked at.
    fn asked(&self, interface: usize) -> Asked {
        if interface == 0 {
            let hold = self.held();
            let normal = self.instant.normal[0];
            let [low, high] = hold.holds_n(normal);
            let [a, b] = hold.bounds.map(|bound| (bound * normal).abs());
            let size = a.max(b).min(f64::MAX);
            let scale = if size > 0.0 { size } else { self.model.weight_n() };
            Asked { demand: self.instant.friction[0], low, high, scale }
        } else {
            let contents = &self.body.contents[interface - 1];
            let press = self.instant.press[0];
            let bound = contents.static_friction * press;
            let scale = if bound > 0.0 { bound } else { self.model.gravity_m_per_s2() };
            let demand = self.instant.carried[interface - 1][0];
            Asked { demand, low: -bound, high: bound, scale }
        }
    }

    /// Acceleration of an interface at the instant last looked at.
    fn acceleration(&self, interface: usize, a: f64) -> f64 {
        if interface == 0 {
            return self.instant.u[0] - a;
        }
        let floor = self.body.contents[interface - 1].floor;
        let under = if floor == 0 { self.instant.u[0] } else { self.instant.floors[floor - 1][0] };
        self.instant.carried[interface - 1][0] - under
    }

    /// By how much static friction of an interface is above the kinetic one in a direction, over the
    /// normal force.
    fn drop(&self, interface: usize, direction: Direction) -> f64 {
        if interface > 0 {
            let contents = &self.body.contents[interface - 1];
            return contents.static_friction - contents.kinetic_friction;
        }
        self.slider.drop(&self.held(), self.x.s, direction)
    }

    /// Decides all that is due at an instant; whether something was.
    pub(super) fn decide(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) -> bool {
        let stopped = (0..self.modes.len()).any(|i| self.has_stopped(i));
        let mut noted = false;
        if stopped || self.pending.is_some() {
            self.note_before(stretch, at_s, at_sample && self.pending.is_none());
            noted = true;
            self.decide_stops(stretch, at_s);
        }
        if self.modes.contains(&Mode::Stick) {
            noted |= self.release_if_due(stretch, at_s, at_sample, noted);
        }
        noted
    }

    /// Decides about all interfaces that have stopped, or reached a bound.
    pub(super) fn decide_stops(&mut self, stretch: &Stretch, at_s: f64) {
        let loads = Self::loads(stretch, at_s);
        let pending = self.pending.take();
        let was = self.modes.clone();
        let stopped: Vec<usize> = (0..was.len()).filter(|&i| self.has_stopped(i)).collect();
        stopped.iter().for_each(|&i| self.hold(i));
        if was[0] != self.modes[0] {
            self.look_at_instant(&loads);
            let margin = self.held().margin(self.instant.friction[0], self.instant.normal[0]);
            self.sliding[0].decide(margin);
        }
        if let Some((i, direction)) = pending {
            let drop = self.drop(i, direction);
            self.let_go(i, direction);
            self.look_at_instant(&loads);
            let acceleration = direction.sign() * self.acceleration(i, loads.acceleration[0]);
            let order = if drop > 0.0 { 1 } else { 2 };
            self.start[i] = Some(Start { order, acceleration });
        }
        self.share_out(stretch, at_s, pending.map(|(i, _)| i), &stopped);
        self.tell(stretch, at_s, &was);
    }

    /// Lets interfaces go one by one, until the others are held: first those that have just `stopped`,
    /// the slider before contents, then the one furthest beyond its bound.
    fn share_out(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        pending: Option<usize>,
        stopped: &[usize],
    ) {
        let loads = Self::loads(stretch, at_s);
        let mut let_go: Vec<usize> = pending.into_iter().collect();
        for _ in 0..4 * self.modes.len() {
            self.look_at_instant(&loads);
            // A start against its own direction sticks again.
            let back = let_go.iter().copied().find(|&i| {
                let Mode::Slip(direction) = self.modes[i] else { return false };
                let along = direction.sign() * self.acceleration(i, loads.acceleration[0]);
                let started = self.start[i].is_some_and(|start| start.order == 1);
                started && along < 0.0 && Some(i) != pending
            });
            if let Some(i) = back {
                let_go.retain(|&other| other != i);
                self.hold(i);
                continue;
            }
            let worst = (0..self.modes.len())
                .filter(|&i| self.modes[i] == Mode::Stick)
                .map(|i| (i, self.asked(i)))
                .filter_map(|(i, asked)| {
                    let later = (!stopped.contains(&i), i > 0);
                    Some((later, asked.beyond(), i, asked.gives_way()?))
                })
                .reduce(|a, b| if b.0 < a.0 || (b.0 == a.0 && b.1 > a.1) { b } else { a });
            let Some((.., i, direction)) = worst else { break };
            self.let_go(i, direction);
            self.look_at_instant(&loads);
            let acceleration = direction.sign() * self.acceleration(i, loads.acceleration[0]);
            self.start[i] = Some(Start { order: 1, acceleration });
            let_go.push(i);
        }
        // The accelerations of all that started, with the others as they are now.
        self.look_at_instant(&loads);
        for i in let_go {
            if let (Mode::Slip(direction), Some(start)) = (self.modes[i], self.start[i]) {
                let acceleration = direction.sign() * self.acceleration(i, loads.acceleration[0]);
                self.start[i] = Some(Start { acceleration, ..start });
            }
        }
    }

    /// In stick: lets go what is asked for more than it holds, or as much and about to be more.
    fn release_if_due(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        at_sample: bool,
        noted: bool,
    ) -> bool {
        let loads = Self::loads(stretch, at_s);
        self.look_at_instant(&loads);
        let stuck = || (0..self.modes.len()).filter(|&i| self.modes[i] == Mode::Stick);
        let due = stuck().any(|i| self.asked(i).gives_way().is_some());
        let level: Vec<(usize, Direction)> = stuck()
            .filter_map(|i| {
                let asked = self.asked(i);
                if asked.demand == asked.high {
                    Some((i, Direction::Negative))
                } else if asked.demand == asked.low {
                    Some((i, Direction::Positive))
                } else {
                    None
                }
            })
            .collect();
        if !due && level.is_empty() {
            return false;
        }
        let was = self.modes.clone();
        if due {
            if !noted {
                self.note_before(stretch, at_s, at_sample);
            }
            self.share_out(stretch, at_s, None, &[]);
            self.tell(stretch, at_s, &was);
            return true;
        }
        for (i, direction) in level {
            self.expand(stretch, at_s);
            let distance = self.distance(i, direction);
            let Some(order) = leaving_order(&distance) else { continue };
            if !noted {
                self.note_before(stretch, at_s, at_sample);
            }
            let drop = self.drop(i, direction);
            self.let_go(i, direction);
            self.look_at_instant(&loads);
            let acceleration = direction.sign() * self.acceleration(i, loads.acceleration[0]);
            let order = if drop > 0.0 { 1 } else { order + 1 };
            self.start[i] = Some(Start { order, acceleration });
            self.share_out(stretch, at_s, Some(i), &[]);
            self.tell(stretch, at_s, &was);
            return true;
        }
        false
    }

    /// Distance of a stuck interface from the bound at which it slides in a direction, positive where
    /// it is held.
    fn distance(&self, interface: usize, direction: Direction) -> Polynomial {
        // Too large a force slides towards −x.
        let sign = -direction.sign();
        let side = if direction == Direction::Positive { 0 } else { 1 };
        let (demand, normal, bound) = if interface == 0 {
            let hold = self.held();
            let bound = if hold.leans[side] { f64::INFINITY } else { sign * hold.bounds[side] };
            (&self.series.friction, &self.series.normal, bound)
        } else {
            let contents = &self.body.contents[interface - 1];
            let carried = &self.series.carried[interface - 1];
            (carried, &self.series.press, contents.static_friction)
        };
        core::array::from_fn(|k| {
            // Nothing is beyond a stop that leans on it.
            let held = if normal[k] == 0.0 { 0.0 } else { bound * normal[k] };
            held - sign * demand[k]
        })
    }

    /// The first part of the series at which a stuck interface is let go.
    pub(super) fn first_release(&self, interface: usize) -> Option<(f64, Direction)> {
        let of = |direction: Direction| {
            let distance = self.distance(interface, direction);
            if !distance[0].is_finite() {
                return None;
            }
            Some((first_crossing(&distance, self.series.part)?, direction))
        };
        let both = [Direction::Negative, Direction::Positive].map(of);
        both.into_iter().flatten().reduce(|a, b| if b.0 < a.0 { b } else { a })
    }

    /// Holds an interface.
    fn hold(&mut self, interface: usize) {
        self.modes[interface] = Mode::Stick;
        self.start[interface] = None;
        if interface == 0 {
            self.begun = None;
            let s = self.x.s;
            match self.near {
                Some(near) if near.offset > 0.0 => self.slider.turn(s, Direction::Positive),
                Some(near) if near.offset < 0.0 => self.slider.turn(s, Direction::Negative),
                _ => self.slider.settle(s),
            }
        }
    }

    /// Lets an interface slide from hold.
    fn let_go(&mut self, interface: usize, direction: Direction) {
        self.modes[interface] = Mode::Slip(direction);
        if interface == 0 {
            self.begun = self.slider.begin(self.x.s, direction);
        }
    }

    /// Tells of the changes of modes at an instant.
    fn tell(&mut self, stretch: &Stretch, at_s: f64, was: &[Mode]) {
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        for (i, before) in was.iter().enumerate() {
            let kind = match (*before, self.modes[i]) {
                (Mode::Stick, Mode::Stick) => continue,
                (Mode::Stick, Mode::Slip(_)) => EventKind::Slip,
                (Mode::Slip(_), Mode::Stick) => EventKind::Stick,
                (Mode::Slip(from), Mode::Slip(to)) if from == to => continue,
                (Mode::Slip(_), Mode::Slip(_)) => EventKind::Reversal,
            };
            let place = self.place(i);
            if matches!(before, Mode::Slip(_)) {
                self.sliding[i].end(time_s, place);
            }
            if self.modes[i] != Mode::Stick {
                self.sliding[i].begin(time_s, place);
            }
            self.push_event(time_s, i, kind);
            if i == 0 {
                self.come_to_stop();
                self.lean(time_s);
            }
        }
        if let Some(contact) = self.begun.take()
            && self.modes[0] != Mode::Stick
        {
            let kind = self.slider.change_contact(time_s, self.x.w.abs(), contact);
            self.push_event(time_s, 0, kind);
        }
    }

    /// A block held within the rounding of `s` off a rigid stop is at it.
    fn come_to_stop(&mut self) {
        if self.modes[0] == Mode::Stick
            && let Some(near) = self.near
            && near.offset.abs() <= 8.0 * f64::EPSILON * near.place.abs()
        {
            (self.x.s, self.near) = (near.place, None);
            self.slider.law.settle(&mut self.slider.memory, near.place);
        }
    }

    /// Begins or ends the time at rest at a rigid stop.
    fn lean(&mut self, time_s: f64) {
        self.end_leaning(time_s);
        let leans = self.held().leans;
        if self.modes[0] == Mode::Stick && leans != [false; 2] {
            self.leans_since_s = Some(time_s);
        }
    }

    pub(super) fn end_leaning(&mut self, time_s: f64) {
        if let Some(since_s) = self.leans_since_s.take() {
            self.slider.stopping.demands.contact_time_s += time_s - since_s;
        }
    }

    /// The block strikes a rigid stop, moving in a direction: `ṡ⁺ = −e ṡ⁻`; what does not touch the
    /// stop keeps its absolute velocity.
    pub(super) fn strike(&mut self, stretch: &Stretch, at_s: f64, direction: Direction) {
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        let Some(rigid) = self.slider.law.rigid else { return };
        let (place, before, e) = (self.x.s, self.x.w, rigid.restitution);
        let fast = before.abs() >= SLOWEST_IMPACT_M_PER_S;
        let turn = self.turn.take();
        if !fast && let Some(turn) = turn {
            self.events.remove(turn);
        }
        let peak = &mut self.slider.stopping.demands.peak_impact_speed_m_per_s;
        *peak = peak.max(before.abs());
        if fast && self.first_impact_s.is_none() {
            self.first_impact_s = Some(time_s);
        }
        self.sliding[0].end(time_s, place);
        self.slider.law.strike(&mut self.slider.memory, place, direction);
        let after = -e * before;
        self.jump(time_s, before, after);
        if after == 0.0 {
            self.rest_at_stop(time_s, place);
            return;
        }
        let away = direction.opposite();
        self.modes[0] = Mode::Slip(away);
        self.sliding[0].begin(time_s, place);
        self.slider.law.resume(&mut self.slider.memory, after.abs(), away);
        self.near = Some(Near { place, offset: 0.0 });
        if fast {
            self.push_event(time_s, 0, EventKind::Impact);
            self.turn = None;
        } else {
            self.events_in_interval += 1;
        }
        if self.comes_to_rest(stretch, at_s, direction, e) {
            self.jump(time_s, after, 0.0);
            self.sliding[0].end(time_s, place);
            self.rest_at_stop(time_s, place);
        }
    }

    /// Gives the block another velocity; floors and contents keep their absolute velocities.
    fn jump(&mut self, time_s: f64, before: f64, after: f64) {
        let change = before - after;
        self.x.w = after;
        self.x.v.iter_mut().for_each(|v| *v += change);
        for i in 0..self.body.contents.len() {
            if self.body.contents[i].floor != 0 {
                continue;
            }
            let interface = 1 + i;
            self.x.p[i] += change;
            self.start[interface] = None;
            let p = self.x.p[i];
            let direction = match p {
                p if p > 0.0 => Direction::Positive,
                p if p < 0.0 => Direction::Negative,
                _ => continue,
            };
            let was = self.modes[interface];
            let kind = match was {
                Mode::Slip(was) if was == direction => continue,
                Mode::Slip(_) => EventKind::Reversal,
                Mode::Stick => EventKind::Slip,
            };
            let place = self.x.r[i];
            if was != Mode::Stick {
                self.sliding[interface].end(time_s, place);
            }
            self.modes[interface] = Mode::Slip(direction);
            self.sliding[interface].begin(time_s, place);
            self.push_event(time_s, interface, kind);
        }
    }

    fn rest_at_stop(&mut self, time_s: f64, place: f64) {
        (self.x.s, self.near) = (place, None);
        self.hold(0);
        self.push_event(time_s, 0, EventKind::Rest);
        self.lean(time_s);
    }

    /// Whether infinitely many bounces are left, all below rounding.
    ///
    /// With `P` and `Q` the accelerations towards the stop on the way in and out, speeds shrink by
    /// `r = e √(P/Q)` a bounce and `T∞ = (w⁺/Q) (1 + √(Q/P)) / (1 − r)`.
    fn comes_to_rest(&mut self, stretch: &Stretch, at_s: f64, inward: Direction, e: f64) -> bool {
        let loads = Self::loads(stretch, at_s);
        let speed = self.x.w.abs();
        let (away, memory) = (self.modes[0], self.slider.memory.clone());
        self.look_at_instant(&loads);
        let q = inward.sign() * self.acceleration(0, loads.acceleration[0]);
        self.modes[0] = Mode::Slip(inward);
        self.slider.law.resume(&mut self.slider.memory, 0.0, inward);
        self.look_at_instant(&loads);
        let p = inward.sign() * self.acceleration(0, loads.acceleration[0]);
        (self.modes[0], self.slider.memory) = (away, memory);
        if !(p > 0.0 && q > 0.0) {
            return false;
        }
        let r = e * (p / q).sqrt();
        let rest_s = speed / q * (1.0 + (q / p).sqrt()) / (1.0 - r);
        let bounce = 0.5 * speed * speed / q;
        r < 1.0 && bounce < LEAST_BOUNCE * self.x.s.abs() && rest_s < LONGEST_REST_S
    }
}
