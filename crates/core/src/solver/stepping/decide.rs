//! What follows an instant at which interfaces have no velocity, and impacts.
//!
//! Interfaces without velocity are decided together: of the assignments in which each that sticks is
//! within its bound and each that slides moves off and could not be held, that in which most of them
//! stick, the slider first.
//! Contents let go make the acceleration of their floor larger, never smaller: so for each mode of the
//! slider all contents are held at first and those beyond their bounds let go until none is.
//! What has reached its bound in motion slides, if it moves off.
//!
//! A jump is walked as the steep ramp that it is the limit of; what it lets go has so reached its bound.

use super::super::ground::{Stretch, jump};
use super::super::outputs::output;
use super::super::slider::{ROUNDING, falls_below, first_crossing};
use super::body::Expansion;
use super::{Near, SLOWEST_IMPACT_M_PER_S, Stepping};
use crate::error::SolveError;
use crate::linear::polynomial::{DEGREE, Polynomial, derivative, value};
use crate::response::{EventKind, Mode};
use crate::slider::{Direction, Hold, Memory};

/// Where a bounce is below the rounding of `s`: parts of the stop's distance.
const LEAST_BOUNCE: f64 = 4.0 * f64::EPSILON;

/// Longest remaining time of infinitely many bounces, as a part of the whole time: it is left out.
const LONGEST_REST: f64 = 8.0 * f64::EPSILON;

/// An interface that slides from rest, and where.
pub(super) type LetGo = (usize, Direction);

/// Modes of all interfaces, with what follows from them.
struct Assignment {
    in_force: InForce,
    start: Vec<Option<usize>>,
    sticking: usize,
    /// Whether each that sticks is within its bound and each that slides moves off.
    holds: bool,
}

/// What is in force of the modes and of the slider.
#[derive(Clone)]
struct InForce {
    modes: Vec<Mode>,
    memory: Memory,
}

/// Order of the first coefficient that is more than rounding.
fn leading(p: &Polynomial, rounding: f64) -> Option<usize> {
    (0..=DEGREE).find(|&k| p[k].abs() > rounding)
}

/// What is rounding of a number that changes so over a series: that of its terms, and of the time.
fn and_of_time(rounding: f64, number: &Polynomial, series: &Expansion) -> f64 {
    if series.unit_s > 0.0 {
        rounding + ROUNDING * (series.from_s / series.unit_s) * number[1].abs()
    } else {
        rounding
    }
}

/// Size of the first two coefficients.
fn size(p: &Polynomial) -> f64 {
    p[0].abs() + p[1].abs()
}

impl Stepping<'_> {
    /// Whether an interface slides without a velocity.
    pub(super) fn has_stopped(&self, interface: usize) -> bool {
        matches!(self.modes[interface], Mode::Slip(_))
            && self.start[interface].is_none()
            && self.velocity(interface) == 0.0
    }

    // ---- rounding -------------------------------------------------------------------------------

    /// What is rounding of the acceleration of the slider over the ground or of the floor that contents
    /// stand on, and of the bounds of these: of its terms now, or of the largest so far.
    fn rounding_m_per_s2(&self, p: &Expansion, interface: usize) -> f64 {
        let y = &self.peaks.values;
        let floor = if interface == 0 { 0 } else { self.body.contents[interface - 1].floor };
        let mass_kg = self.body.joined_kg(floor, &self.modes);
        let mut terms = size(&p.ground);
        if interface > 0 {
            terms = self.body.contents[interface - 1].static_friction * size(&p.press);
        }
        if floor > 0 {
            let restoring = self.body.restoring_size(&self.x, floor) / mass_kg;
            let largest = y[output::acceleration(self.body.storeys(), floor - 1)];
            terms += restoring.max(largest) + size(&p.floors[floor - 1]);
        } else if self.modes[0] == Mode::Stick && interface > 0 {
            terms += size(&p.ground);
        } else {
            let shear = size(&p.shear).max(y[output::BASE_SHEAR]);
            terms += (self.slider_terms_n(p) + shear) / mass_kg + size(&p.u);
        }
        ROUNDING * terms
    }

    /// What is rounding of the force that the slider is asked for, in N.
    fn rounding_n(&self, p: &Expansion) -> f64 {
        self.rounding_m_per_s2(p, 0) * self.body.joined_kg(0, &self.modes)
    }

    /// Sum of the sizes of the forces in the slider in N.
    fn slider_terms_n(&self, p: &Expansion) -> f64 {
        let force = self.force(self.modes[0]);
        let springs = force.restraint.stiffness_n_per_m * self.x.s;
        size(&p.slider) + size(&p.friction) + springs.abs() + force.force_n.abs()
    }

    /// What is rounding of the velocity of an interface at a part of a series: of `Σ |c_k| x^k`, or of the
    /// largest so far.
    fn rounding_m_per_s(&self, interface: usize, velocity: &Polynomial, part: f64) -> f64 {
        let largest = self.peaks.values[self.velocity_output(interface)];
        let terms = value(&velocity.map(f64::abs), part);
        ROUNDING * if self.walks_jump { terms } else { terms.max(largest) }
    }

    // ---- bounds ---------------------------------------------------------------------------------

    /// Distance of a stuck interface from the bound at which it slides in a direction, positive where it
    /// is held; none where nothing lets it go that way.
    fn distance(&self, p: &Expansion, interface: usize, to: Direction) -> Option<Polynomial> {
        // Too large a force slides towards −x.
        let sign = -to.sign();
        let (demand, bound) = if interface == 0 {
            (&p.friction, self.held().series_against(to, &p.normal)?)
        } else {
            let mu = self.body.contents[interface - 1].static_friction;
            (&p.carried[interface - 1], p.press.map(|n| mu * n))
        };
        Some(core::array::from_fn(|k| bound[k] - sign * demand[k]))
    }

    /// What is rounding of that distance.
    fn rounding_of_distance(&self, p: &Expansion, interface: usize, distance: &Polynomial) -> f64 {
        let of_terms = if interface == 0 {
            self.rounding_n(p) + ROUNDING * self.held().largest_n(size(&p.normal))
        } else {
            self.rounding_m_per_s2(p, interface)
        };
        and_of_time(of_terms, distance, p)
    }

    /// Where a stuck interface is about to slide by the series: the first derivative of demand − bound
    /// that does not vanish is positive.
    fn leaving(&self, interface: usize) -> Option<Direction> {
        let p = &self.series;
        [Direction::Negative, Direction::Positive].into_iter().find(|&to| {
            self.distance(p, interface, to).is_some_and(|distance| {
                let rounding = self.rounding_of_distance(p, interface, &distance);
                leading(&distance, rounding).is_some_and(|k| distance[k] < 0.0)
            })
        })
    }

    /// Whether a stuck interface is at its bound or beyond it.
    fn is_any_at_bound(&mut self, stretch: &Stretch, at_s: f64) -> bool {
        if !self.modes.contains(&Mode::Stick) {
            return false;
        }
        self.look_at_instant(&Self::loads(stretch, at_s));
        self.instant.from_s = at_s;
        let p = &self.instant;
        let stuck = (0..self.modes.len()).filter(|&i| self.modes[i] == Mode::Stick);
        let mut sides = stuck.flat_map(|i| [(i, Direction::Negative), (i, Direction::Positive)]);
        sides.any(|(i, to)| {
            let distance = self.distance(p, i, to);
            distance.is_some_and(|d| !(d[0] > self.rounding_of_distance(p, i, &d)))
        })
    }

    /// The first part of the series at which a stuck interface is let go.
    pub(super) fn first_release(&self, interface: usize) -> Option<(f64, Direction)> {
        let of = |to: Direction| {
            let mut distance = self.distance(&self.series, interface, to)?;
            first_crossing(&distance, self.series.part)?;
            // What does not go further below zero than rounding is held.
            let rounding = self.rounding_of_distance(&self.series, interface, &distance);
            let order = leading(&distance, rounding)?;
            distance[..order].fill(0.0);
            let falls = falls_below(&distance, rounding, self.series.part);
            falls.then_some(())?;
            Some((first_crossing(&distance, self.series.part)?, to))
        };
        let both = [Direction::Negative, Direction::Positive].map(of);
        both.into_iter().flatten().reduce(|a, b| if b.0 < a.0 { b } else { a })
    }

    /// All stuck interfaces that reach their bounds at a part of the series.
    pub(super) fn released(&self, part: f64) -> Vec<LetGo> {
        let stuck = (0..self.modes.len()).filter(|&i| self.modes[i] == Mode::Stick);
        let at_part = |i: usize| {
            let (at, to) = self.first_release(i)?;
            let distance = self.distance(&self.series, i, to)?;
            let rounding = self.rounding_of_distance(&self.series, i, &distance);
            (at <= part || value(&distance, part) <= rounding).then_some((i, to))
        };
        stuck.filter_map(at_part).collect()
    }

    /// Stops what slides, at a part of the series, with no more velocity than rounding and no
    /// acceleration.
    pub(super) fn stop_within_rounding(&mut self, part: f64) {
        for i in 0..self.modes.len() {
            let Mode::Slip(direction) = self.modes[i] else { continue };
            let speed = self.series.speed(i, direction);
            let here = direction.sign() * self.velocity(i);
            if here <= 0.0
                || (here <= self.rounding_m_per_s(i, &speed, part)
                    && value(&derivative(&speed), part) <= 0.0)
            {
                self.stand(i);
            }
        }
    }

    // ---- decisions ------------------------------------------------------------------------------

    /// Decides all that is due at an instant; whether something was.
    pub(super) fn decide(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) -> bool {
        let stopped = (0..self.modes.len()).any(|i| self.has_stopped(i));
        let reached = core::mem::take(&mut self.pending);
        let due = stopped || !reached.is_empty();
        if !(due || self.is_any_at_bound(stretch, at_s)) {
            return false;
        }
        let was = self.in_force();
        let margins = self.has_stopped(0).then(|| {
            self.hold(0);
            self.look_at_instant(&Self::loads(stretch, at_s));
            let (asked_n, normal_n) = (self.instant.friction[0], self.instant.normal[0]);
            [self.held_at_rest(), self.held()].map(|hold| hold.margin(asked_n, normal_n))
        });
        let chosen = self.choose(stretch, at_s, &reached);
        let mode = chosen.in_force.modes[0];
        if let Some([sticks, slides]) = margins.filter(|_| mode != was.modes[0]) {
            self.sliding[0].decide(if mode == Mode::Stick { sticks } else { slides });
        }
        self.put_in_force(&was);
        if chosen.in_force.modes == was.modes {
            self.events_in_interval += 1;
            if !due {
                return false;
            }
        }
        self.note_before(stretch, at_s, at_sample);
        self.put_in_force(&chosen.in_force);
        self.start = chosen.start;
        self.tell(stretch, at_s, &was);
        true
    }

    fn in_force(&self) -> InForce {
        InForce { modes: self.modes.clone(), memory: self.slider.memory.clone() }
    }

    fn put_in_force(&mut self, what: &InForce) {
        self.modes.clone_from(&what.modes);
        self.slider.memory.clone_from(&what.memory);
    }

    /// Decides about all interfaces without velocity; those that have `reached` their bounds slide, if
    /// they move off.
    fn choose(&mut self, stretch: &Stretch, at_s: f64, reached: &[LetGo]) -> Assignment {
        for i in 0..self.modes.len() {
            if self.has_stopped(i) {
                self.hold(i);
            }
        }
        let held = self.in_force();
        let at = (stretch, at_s);
        let first = self.assign(at, &held, reached);
        let is_slider_free = held.modes[0] == Mode::Stick && reached.iter().all(|(i, _)| *i > 0);
        if !is_slider_free {
            return if first.holds || reached.is_empty() {
                first
            } else {
                self.choose_anew(at, &held)
            };
        }
        let demand = self.series.friction[0];
        if first.holds && first.sticking == held.modes.len() - reached.len() {
            return first;
        }
        let against = if demand > 0.0 { Direction::Negative } else { Direction::Positive };
        let towards = self.leaving(0).unwrap_or(against);
        // Contents that slide while the slider sticks.
        let with: Vec<LetGo> = (1..held.modes.len())
            .filter(|&i| held.modes[i] == Mode::Stick)
            .filter_map(|i| match first.in_force.modes[i] {
                Mode::Slip(direction) => Some((i, direction)),
                Mode::Stick => None,
            })
            .collect();
        let mut best = Some(first).filter(|first| first.holds);
        for direction in [towards, towards.opposite()] {
            let slides: Vec<LetGo> = [(0, direction)].iter().chain(reached).copied().collect();
            let mut next = self.assign(at, &held, &slides);
            if !next.holds {
                let slides: Vec<LetGo> = [(0, direction)].iter().chain(&with).copied().collect();
                next = self.assign(at, &held, &slides);
            }
            let better = best.as_ref().is_none_or(|best| next.sticking > best.sticking);
            if next.holds && better && self.must_slide(at, &next, direction) {
                best = Some(next);
            }
        }
        match best {
            Some(best) => best,
            None if !reached.is_empty() => self.choose_anew(at, &held),
            None => self.assign(at, &held, &[(0, towards)]),
        }
    }

    /// Whether friction could not hold the slider, with all else as assigned.
    fn must_slide(
        &mut self,
        at: (&Stretch, f64),
        assignment: &Assignment,
        direction: Direction,
    ) -> bool {
        self.put_in_force(&assignment.in_force);
        self.hold(0);
        self.expand_at(at);
        self.leaving(0) == Some(direction)
    }

    /// The same with nothing that has reached its bound.
    fn choose_anew(&mut self, (stretch, at_s): (&Stretch, f64), held: &InForce) -> Assignment {
        self.put_in_force(held);
        self.choose(stretch, at_s, &[])
    }

    /// The assignment in which these slide, the slider else sticks, and as many contents as can.
    fn assign(&mut self, at: (&Stretch, f64), held: &InForce, slides: &[LetGo]) -> Assignment {
        self.put_in_force(held);
        let mut let_go = slides.to_vec();
        loop {
            let_go.drain(..).for_each(|(i, direction)| self.let_go(i, direction));
            self.expand_at(at);
            let stuck = (1..self.modes.len()).filter(|&i| self.modes[i] == Mode::Stick);
            let_go = stuck.filter_map(|i| Some((i, self.leaving(i)?))).collect();
            if let_go.is_empty() {
                break;
            }
        }
        let mut holds = self.modes[0] != Mode::Stick || self.leaving(0).is_none();
        let count = self.modes.len();
        let mut start = self.start.clone();
        for i in (0..count).filter(|&i| held.modes[i] == Mode::Stick) {
            if let Mode::Slip(direction) = self.modes[i] {
                let acceleration = self.acceleration(i, direction);
                let of_terms = self.rounding_m_per_s2(&self.series, i);
                let order =
                    leading(&acceleration, and_of_time(of_terms, &acceleration, &self.series));
                holds &= order.is_some_and(|k| acceleration[k] > 0.0);
                start[i] = Some(1 + order.unwrap_or(0));
            }
        }
        let sticking = self.modes.iter().filter(|mode| **mode == Mode::Stick).count();
        Assignment { in_force: self.in_force(), start, sticking, holds }
    }

    /// Expands the motion from an instant. What is rounding depends on the unit: all decisions of an
    /// instant, and the segment after them, take the same.
    fn expand_at(&mut self, (stretch, at_s): (&Stretch, f64)) {
        let unit_s = self.unit_s;
        self.expand(stretch, at_s);
        self.unit_s = unit_s;
    }

    /// Acceleration of an interface by the series, positive along a direction.
    fn acceleration(&self, interface: usize, direction: Direction) -> Polynomial {
        let (p, sign) = (&self.series, direction.sign());
        let (own, under) = match interface {
            0 => (&p.u, &p.ground),
            contents => match self.body.contents[contents - 1].floor {
                0 => (&p.carried[contents - 1], &p.u),
                floor => (&p.carried[contents - 1], &p.floors[floor - 1]),
            },
        };
        core::array::from_fn(|k| sign * (own[k] - under[k]))
    }

    /// Holds an interface.
    fn hold(&mut self, interface: usize) {
        self.modes[interface] = Mode::Stick;
        self.start[interface] = None;
        if interface == 0 {
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
        if interface == 0
            && let Some(contact) = self.slider.begin(self.x.s, direction)
        {
            self.slider.memory.contact = contact;
        }
    }

    /// Goes through a jump of the loads: what it lets go has reached its bound. Displacements and
    /// velocities are what they were.
    pub(super) fn walk_jump(
        &mut self,
        sample: usize,
        from: [f64; 2],
        to: [f64; 2],
    ) -> Result<(), SolveError> {
        let (was, x, near, unit_s) = (self.in_force(), self.x.clone(), self.near, self.unit_s);
        let start = self.start.clone();
        let resting: Vec<bool> = (0..was.modes.len())
            .map(|i| was.modes[i] == Mode::Stick || self.has_stopped(i))
            .collect();
        self.walks_jump = true;
        for stretch in jump(sample, from, to) {
            let mut at_s = stretch.from_s;
            self.unit_s = stretch.to_s - at_s;
            while at_s < stretch.to_s {
                let due = !self.pending.is_empty()
                    || (0..resting.len()).any(|i| self.has_stopped(i))
                    || self.is_any_at_bound(&stretch, at_s);
                if due {
                    let reached = core::mem::take(&mut self.pending);
                    let next = self.choose(&stretch, at_s, &reached);
                    self.events_in_interval += 1;
                    self.limit_events(self.ground.times_s[sample])?;
                    self.put_in_force(&next.in_force);
                    self.start = next.start;
                }
                let (to_s, part, end) = self.walk(&stretch, at_s);
                self.follow(part, end);
                at_s = to_s;
            }
        }
        self.walks_jump = false;
        let slides = |i: usize| match self.modes[i] {
            Mode::Slip(direction) if resting[i] && !self.has_stopped(i) => Some((i, direction)),
            _ => None,
        };
        self.pending = (0..resting.len()).filter_map(slides).collect();
        (self.x, self.near, self.unit_s, self.start) = (x, near, unit_s, start);
        self.put_in_force(&was);
        Ok(())
    }

    /// Tells of the changes at an instant.
    fn tell(&mut self, stretch: &Stretch, at_s: f64, was: &InForce) {
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        let contact = core::mem::replace(&mut self.slider.memory.contact, was.memory.contact);
        for (i, before) in was.modes.iter().enumerate() {
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
        if contact != was.memory.contact {
            let kind = self.slider.change_contact(time_s, self.x.w.abs(), contact);
            self.push_event(time_s, 0, kind);
        }
    }

    /// The rigid stop that the block is off by no more than the rounding of `s`: where it comes to rest,
    /// it is at it.
    fn stop_within_reach(&self) -> Option<f64> {
        let is_at_it = |near: &Near| near.offset.abs() <= 8.0 * f64::EPSILON * near.place.abs();
        self.near.filter(is_at_it).map(|near| near.place)
    }

    /// What holds the slider if it comes to rest here.
    fn held_at_rest(&self) -> Hold {
        self.stop_within_reach().map_or_else(|| self.held(), |place| self.slider.hold(place))
    }

    fn come_to_stop(&mut self) {
        if self.modes[0] == Mode::Stick
            && let Some(place) = self.stop_within_reach()
        {
            (self.x.s, self.near) = (place, None);
            self.slider.law.settle(&mut self.slider.memory, place);
        }
    }

    /// Begins or ends the time at rest at a rigid stop.
    pub(super) fn lean(&mut self, time_s: f64) {
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
        let Some(e) = self.slider.law.restitution() else { return };
        let (place, before) = (self.x.s, self.x.w);
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
        let q = inward.sign() * (self.instant.u[0] - loads.acceleration[0]);
        self.modes[0] = Mode::Slip(inward);
        self.slider.law.resume(&mut self.slider.memory, 0.0, inward);
        self.look_at_instant(&loads);
        let p = inward.sign() * (self.instant.u[0] - loads.acceleration[0]);
        (self.modes[0], self.slider.memory) = (away, memory);
        if !(p > 0.0 && q > 0.0) {
            return false;
        }
        let r = e * (p / q).sqrt();
        let rest_s = speed / q * (1.0 + (q / p).sqrt()) / (1.0 - r);
        let bounce = 0.5 * speed * speed / q;
        let end_s = self.ground.times_s[self.ground.times_s.len() - 1];
        r < 1.0 && bounce < LEAST_BOUNCE * self.x.s.abs() && rest_s < LONGEST_REST * end_s
    }
}
