//! What follows an instant at which interfaces have no velocity or reach their bounds.
//!
//! A lone slider goes by the force that it is asked for, unless that is ambiguous. Else interfaces without
//! velocity are decided together, by their series: of the assignments in which each that sticks is within
//! its bound and each that slides moves off and could not be held, that in which most of them stick, the
//! slider first.
//! Contents let go make the acceleration of their floor larger, never smaller: so for each mode of the
//! slider all contents are held at first and those beyond their bounds released until none is.
//! What has reached its bound in motion slides, if it moves off.
//!
//! A jump is walked as the steep ramp that it is the limit of; what it releases has so reached its bound.
//! A lone slider needs no such walk: its distance from a bound is linear in the ramp's parameter, so that it
//! is released if it is beyond its bound at the end.

use super::super::course::{AMBIGUOUS, Release};
use super::super::ground::{Stretch, jump};
use super::super::phase::{LinePhase, Of, Segment};
use super::super::slider::{ROUNDING, Start, falls_below, first_crossing, leading};
use super::{Line, Walk};
use crate::error::SolveError;
use crate::linear::polynomial::{Polynomial, curvature_bound, value};
use crate::response::{EventKind, Mode};
use crate::slider::{Direction, Memory};

/// Factors on what is rounding, one after the other where none of the assignments holds: that a force is at its bound
/// and that what it lets go of has no acceleration is the same to within rounding, and not the same number.
const DOUBTS: [f64; 4] = [8.0, 64.0, 512.0, 4096.0];

/// Modes of all interfaces, with what follows from them.
struct Assignment {
    in_force: InForce,
    start: Vec<Option<Start>>,
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

impl<'a, P: LinePhase<'a> + ?Sized> Walk<'a, P> {
    /// What is rounding of the velocity of an interface at a part of a series: of `Σ |c_k| x^k`, or of the
    /// largest so far.
    #[inline(always)]
    pub(super) fn rounding_m_per_s(&self, i: usize, velocity: &Polynomial, part: f64) -> f64 {
        let terms = value(&velocity.map(f64::abs), part);
        let largest = if self.walks_jump { 0.0 } else { self.phase.peak_velocity(i) };
        ROUNDING * terms.max(largest)
    }

    /// What is rounding of the time over a series, in its unit.
    fn rounding_of_time(&self, of: Of) -> f64 {
        let Segment { from_s, unit_s, .. } = self.phase.segment(of);
        if unit_s > 0.0 { ROUNDING * (from_s / unit_s) } else { 0.0 }
    }

    /// What is rounding of the distance of a stuck interface from its bound.
    fn rounding_of_distance(&self, of: Of, i: usize, distance: &Polynomial) -> f64 {
        let mut of_terms = self.phase.rounding_m_per_s2(&self.course, of, i);
        if i == 0 {
            let [normal, rise] = self.phase.normal(of, i).map(f64::abs);
            let normal_n = normal + self.phase.segment(of).part * rise;
            let hold = self.phase.hold(&self.course, i);
            of_terms = of_terms * self.phase.block_kg() + ROUNDING * hold.largest_n(normal_n);
        }
        self.doubt * (of_terms + self.rounding_of_time(of) * distance[1].abs())
    }

    /// Distance of a stuck interface from the bound at which it slides in a direction, positive where it
    /// is held; none where nothing lets it go that way.
    fn distance(&self, of: Of, i: usize, to: Direction) -> Option<Polynomial> {
        let hold = self.phase.hold(&self.course, i);
        let normal = self.phase.normal(of, i);
        hold.gives(to).then(|| hold.distance(self.phase.required_friction(of, i), normal, to))
    }

    /// Whether there is a slider alone, without rigid stops.
    #[inline(always)]
    pub(super) fn is_lone(&self) -> bool {
        self.course.contents.is_empty() && self.course.slider.law.walls_m().is_none()
    }

    /// The first part of the series at which a stuck interface is released.
    #[inline(always)]
    pub(super) fn first_release(&self, i: usize, part: f64) -> Option<(f64, Direction)> {
        let (phase, motion) = (&self.phase, Of::Motion);
        let (asked, [normal, rise]) = (phase.required_friction(motion, i), phase.normal(motion, i));
        let hold = phase.hold(&self.course, i);
        let hidden = 0.125 * curvature_bound(asked) * (part * part);
        let last = [value(asked, part), normal + rise * part];
        let mut first: Option<(f64, Direction)> = None;
        for to in [Direction::Negative, Direction::Positive] {
            let ends = [[asked[0], normal], last];
            let ends = ends.map(|[asked, n]| hold.against_n(to, n) + to.sign() * asked);
            if ends[0].min(ends[1]) > hidden + hold.bend_n(to, [normal, rise], part) {
                continue;
            }
            if let Some(at) = self.release_towards(i, to, part)
                && first.is_none_or(|(first, _)| at < first)
            {
                first = Some((at, to));
            }
        }
        first
    }

    /// The same in a direction.
    #[inline(always)]
    fn release_towards(&self, i: usize, to: Direction, part: f64) -> Option<f64> {
        let mut distance = self.distance(Of::Motion, i, to)?;
        let at = first_crossing(&distance, part)?;
        // What does not go further below zero than rounding is held.
        let rounding = self.rounding_of_distance(Of::Motion, i, &distance);
        let order = leading(&distance, rounding)?;
        distance[..order].fill(0.0);
        falls_below(&distance, rounding, part).then_some(())?;
        if order == 0 { Some(at) } else { first_crossing(&distance, part) }
    }
}

impl<'a, P: LinePhase<'a>> Walk<'a, P> {
    /// Finds all stuck interfaces that reach their bounds at a part of the series, where one does.
    #[inline(always)]
    pub(super) fn find_released(&mut self, first: Release, part: f64) {
        self.course.released.push(first);
        if self.course.interfaces() > 1 {
            self.line().find_released_with(first, part);
        }
    }

    /// Decides about a lone slider by the force that it is asked for; none where that is ambiguous.
    #[inline(always)]
    pub(super) fn decide_beyond_doubt(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        at_sample: bool,
    ) -> Option<bool> {
        if !self.is_lone() {
            return None;
        }
        let stopped = self.has_stopped(0);
        if !stopped && self.course.block.mode != Mode::Stick {
            return Some(false);
        }
        let at = self.instant(stretch, at_s);
        if !(at.normal_n > 0.0) {
            return None;
        }
        if let [Release { direction, .. }] = *self.course.released {
            self.course.released.clear();
            self.note_before(stretch, at_s, at_sample);
            let hold = self.course.hold(at.place_m);
            self.course.release(&at, &hold, direction, 1);
            self.phase.update_branch(&self.course);
            return Some(true);
        }
        if !stopped {
            let hold = self.course.hold(at.place_m);
            let demand_n =
                self.phase.required_friction_n(&hold, [stretch.acceleration_at(at_s), at.normal_n]);
            let [excess_n, width_n] = hold.excess_and_width_n(demand_n, at.normal_n);
            if excess_n < -AMBIGUOUS * width_n {
                return Some(false);
            }
            let direction = hold.gives_way(demand_n, at.normal_n)?;
            if !(excess_n > AMBIGUOUS * width_n) {
                return None;
            }
            self.note_before(stretch, at_s, at_sample);
            self.course.give_way(&at, demand_n, direction);
            self.phase.update_branch(&self.course);
            return Some(true);
        }
        let memory = self.course.slider.memory.clone();
        self.course.slider.settle(at.place_m);
        let hold = self.course.hold(at.place_m);
        let demand_n =
            self.phase.required_friction_n(&hold, [stretch.acceleration_at(at_s), at.normal_n]);
        if !hold.margin(demand_n, at.normal_n).is_some_and(|margin| margin > AMBIGUOUS) {
            self.course.slider.memory = memory;
            return None;
        }
        self.note_before(stretch, at_s, at_sample);
        self.course.stop(&at, &hold, demand_n, true);
        self.phase.update_branch(&self.course);
        Some(true)
    }

    #[inline(never)]
    pub(super) fn walk_ramps(
        &mut self,
        sample: usize,
        from: [f64; 2],
        to: [f64; 2],
    ) -> Result<(), SolveError> {
        let (was, state, near) = (self.line().in_force(), self.phase.state(), self.course.near);
        let (start, unit_s) = (self.line().starts(), self.phase.unit_s());
        let resting: Vec<bool> = (0..was.modes.len())
            .map(|i| was.modes[i] == Mode::Stick || self.has_stopped(i))
            .collect();
        self.walks_jump = true;
        for stretch in jump(sample, from, to) {
            let mut at_s = stretch.from_s;
            self.phase.set_unit_s(stretch.to_s - at_s);
            while at_s < stretch.to_s {
                let due = !self.course.released.is_empty()
                    || self.has_any_stopped()
                    || self.line().is_any_at_bound(&stretch, at_s);
                if due {
                    let reached = core::mem::take(&mut self.course.released);
                    let next = self.line().choose(&stretch, at_s, &reached);
                    self.course.events_in_interval += 1;
                    self.limit_events(self.ground.times_s[sample])?;
                    self.line().put_in_force(&next.in_force);
                    self.line().put_start(&next.start);
                }
                let (segment, end) = self.advance(&stretch, at_s);
                self.follow(segment.part, end);
                at_s = segment.to_s;
            }
        }
        self.walks_jump = false;
        let slides = |i: usize| match self.course.mode(i) {
            Mode::Slip(direction) if resting[i] && !self.has_stopped(i) => {
                Some(Release { interface: i, direction })
            }
            _ => None,
        };
        self.course.released = (0..resting.len()).filter_map(slides).collect();
        self.phase.set_state(&state);
        self.course.near = near;
        self.phase.set_unit_s(unit_s);
        self.line().put_start(&start);
        self.line().put_in_force(&was);
        Ok(())
    }
}

impl<'a> Line<'a> {
    /// Where a stuck interface is about to slide by the series: the first derivative of demand − bound
    /// that does not vanish is positive.
    fn leaving(&self, i: usize) -> Option<Direction> {
        Direction::BOTH.into_iter().rev().find(|&to| {
            self.distance(Of::Motion, i, to).is_some_and(|distance| {
                let rounding = self.rounding_of_distance(Of::Motion, i, &distance);
                leading(&distance, rounding).is_some_and(|k| distance[k] < 0.0)
            })
        })
    }

    /// Whether a stuck interface is at its bound or beyond it.
    fn is_any_at_bound(&mut self, stretch: &Stretch, at_s: f64) -> bool {
        if self.course.stuck().next().is_none() {
            return false;
        }
        self.phase.look_at_instant(&self.course, stretch, at_s);
        let instant = Of::Instant;
        let mut sides = self.course.stuck().flat_map(|i| Direction::BOTH.map(|to| (i, to)));
        sides.any(|(i, to)| {
            let distance = self.distance(instant, i, to);
            distance.is_some_and(|d| !(d[0] > self.rounding_of_distance(instant, i, &d)))
        })
    }

    #[inline(never)]
    fn find_released_with(&mut self, first: Release, part: f64) {
        let mut released = core::mem::take(&mut self.course.released);
        let others = self.course.stuck().filter(|&i| i != first.interface);
        released.extend(others.filter_map(|i| self.released(i, part)));
        self.course.released = released;
    }

    /// Where a stuck interface has reached its bound at a part of the series.
    fn released(&self, interface: usize, part: f64) -> Option<Release> {
        let motion = Of::Motion;
        let (at, direction) = self.first_release(interface, self.phase.segment(motion).part)?;
        let distance = self.distance(motion, interface, direction)?;
        let rounding = self.rounding_of_distance(motion, interface, &distance);
        let is_reached = at <= part || value(&distance, part) <= rounding;
        is_reached.then_some(Release { interface, direction })
    }

    /// Decides about all interfaces by their series.
    #[inline(never)]
    pub(super) fn decide_by_series(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        at_sample: bool,
    ) -> bool {
        let stopped = self.has_any_stopped();
        let reached = core::mem::take(&mut self.course.released);
        let due = stopped || !reached.is_empty();
        if !(due || self.is_any_at_bound(stretch, at_s)) {
            return false;
        }
        let was = self.in_force();
        let margins = self.has_stopped(0).then(|| {
            self.stick(0);
            self.phase.update_branch(&self.course);
            self.phase.look_at_instant(&self.course, stretch, at_s);
            let phase = &self.phase;
            let asked_n = phase.required_friction(Of::Instant, 0)[0];
            let [normal_n, _] = phase.normal(Of::Instant, 0);
            let holds = [self.hold_at_rest(), phase.hold(&self.course, 0)];
            holds.map(|hold| hold.margin(asked_n, normal_n))
        });
        let chosen = self.choose(stretch, at_s, &reached);
        let mode = chosen.in_force.modes[0];
        if let Some([sticks, slides]) = margins.filter(|_| mode != was.modes[0]) {
            self.course.block.sliding.decide(if mode == Mode::Stick { sticks } else { slides });
        }
        self.put_in_force(&was);
        if chosen.in_force.modes == was.modes {
            self.course.events_in_interval += 1;
            if !due {
                return false;
            }
        }
        self.note_before(stretch, at_s, at_sample);
        self.put_in_force(&chosen.in_force);
        self.put_start(&chosen.start);
        self.emit(stretch, at_s, &was);
        self.phase.update_branch(&self.course);
        true
    }

    fn in_force(&self) -> InForce {
        let modes = (0..self.course.interfaces()).map(|i| self.course.mode(i)).collect();
        InForce { modes, memory: self.course.slider.memory.clone() }
    }

    fn put_in_force(&mut self, what: &InForce) {
        self.course.set_modes(&what.modes);
        self.course.slider.memory.clone_from(&what.memory);
        self.phase.update_branch(&self.course);
    }

    fn starts(&self) -> Vec<Option<Start>> {
        (0..self.course.interfaces()).map(|i| self.course.interface(i).start).collect()
    }

    fn put_start(&mut self, start: &[Option<Start>]) {
        for (i, start) in start.iter().enumerate() {
            self.course.interface_mut(i).start = *start;
        }
    }

    /// Decides about all interfaces without velocity; those that have `reached` their bounds slide, if
    /// they move off.
    fn choose(&mut self, stretch: &Stretch, at_s: f64, reached: &[Release]) -> Assignment {
        for i in 0..self.course.interfaces() {
            if self.has_stopped(i) {
                self.stick(i);
            }
        }
        let held = self.in_force();
        let at = (stretch, at_s);
        let chosen = self.choose_from(at, &held, reached);
        if chosen.holds {
            return chosen;
        }
        let in_doubt = DOUBTS.into_iter().find_map(|doubt| {
            self.doubt = doubt;
            Some(self.choose_from(at, &held, reached)).filter(|next| next.holds)
        });
        self.doubt = 1.0;
        in_doubt.unwrap_or(chosen)
    }

    /// The same from what is held at first.
    fn choose_from(
        &mut self,
        at: (&Stretch, f64),
        held: &InForce,
        reached: &[Release],
    ) -> Assignment {
        let first = self.assign(at, held, reached);
        let is_slider_free =
            held.modes[0] == Mode::Stick && reached.iter().all(|release| release.interface > 0);
        if !is_slider_free {
            return if first.holds || reached.is_empty() {
                first
            } else {
                self.choose_from(at, held, &[])
            };
        }
        let demand = self.phase.required_friction(Of::Motion, 0)[0];
        if first.holds && first.sticking == held.modes.len() - reached.len() {
            return first;
        }
        let against = if demand > 0.0 { Direction::Negative } else { Direction::Positive };
        let towards = self.leaving(0).unwrap_or(against);
        // Contents that slide while the slider sticks.
        let with: Vec<Release> = (1..held.modes.len())
            .filter(|&i| held.modes[i] == Mode::Stick)
            .filter_map(|i| match first.in_force.modes[i] {
                Mode::Slip(direction) => Some(Release { interface: i, direction }),
                Mode::Stick => None,
            })
            .collect();
        let mut best = Some(first).filter(|first| first.holds);
        for direction in [towards, towards.opposite()] {
            let slides: Vec<Release> =
                [Release { interface: 0, direction }].iter().chain(reached).copied().collect();
            let mut next = self.assign(at, held, &slides);
            if !next.holds {
                let slides: Vec<Release> =
                    [Release { interface: 0, direction }].iter().chain(&with).copied().collect();
                next = self.assign(at, held, &slides);
            }
            let better = best.as_ref().is_none_or(|best| next.sticking > best.sticking);
            if next.holds && better && self.must_slide(at, &next, direction) {
                best = Some(next);
            }
        }
        match best {
            Some(best) => best,
            None if !reached.is_empty() => self.choose_from(at, held, &[]),
            None => self.assign(at, held, &[Release { interface: 0, direction: towards }]),
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
        self.stick(0);
        self.expand_at(at);
        self.leaving(0) == Some(direction)
    }

    /// The assignment in which these slide, the slider else sticks, and as many contents as can.
    fn assign(&mut self, at: (&Stretch, f64), held: &InForce, slides: &[Release]) -> Assignment {
        self.put_in_force(held);
        let mut released = slides.to_vec();
        loop {
            released.drain(..).for_each(|release| self.release(release));
            self.expand_at(at);
            let stuck = self.course.stuck().filter(|&i| i > 0);
            let leaving = |interface| {
                let direction = self.leaving(interface)?;
                Some(Release { interface, direction })
            };
            released = stuck.filter_map(leaving).collect();
            if released.is_empty() {
                break;
            }
        }
        let mut holds = self.course.block.mode != Mode::Stick || self.leaving(0).is_none();
        let mut start = self.starts();
        for i in (0..held.modes.len()).filter(|&i| held.modes[i] == Mode::Stick) {
            if let Mode::Slip(direction) = self.course.mode(i) {
                let acceleration = self.phase.acceleration(Of::Motion, i);
                let acceleration = acceleration.map(|c| direction.sign() * c);
                let rounding = self.doubt
                    * (self.phase.rounding_m_per_s2(&self.course, Of::Motion, i)
                        + self.rounding_of_time(Of::Motion) * acceleration[1].abs());
                let order = leading(&acceleration, rounding);
                holds &= order.is_some_and(|k| acceleration[k] > 0.0);
                let order = 1 + order.unwrap_or(0);
                start[i] = Some(Start { order, acceleration: acceleration[0] });
            }
        }
        let sticking = self.course.stuck().count();
        Assignment { in_force: self.in_force(), start, sticking, holds }
    }

    /// Expands the motion from an instant. What is rounding depends on the unit: all decisions of an
    /// instant, and the segment after them, take the same.
    fn expand_at(&mut self, (stretch, at_s): (&Stretch, f64)) {
        let unit_s = self.phase.unit_s();
        self.phase.update_branch(&self.course);
        self.phase.expand(&self.course, stretch, at_s);
        self.phase.set_unit_s(unit_s);
    }

    /// Holds an interface.
    pub(super) fn stick(&mut self, i: usize) {
        let interface = self.course.interface_mut(i);
        (interface.mode, interface.start) = (Mode::Stick, None);
        if i == 0 {
            let [s, _] = self.phase.position_and_velocity(0);
            match self.course.near {
                Some(near) if near.offset > 0.0 => self.course.slider.turn(s, Direction::Positive),
                Some(near) if near.offset < 0.0 => self.course.slider.turn(s, Direction::Negative),
                _ => self.course.slider.settle(s),
            }
        }
    }

    /// Lets an interface slide from rest.
    fn release(&mut self, Release { interface, direction }: Release) {
        self.course.interface_mut(interface).mode = Mode::Slip(direction);
        if interface == 0
            && let Some(contact) =
                self.course.slider.begin(self.phase.position_and_velocity(0)[0], direction)
        {
            self.course.slider.memory.contact = contact;
        }
    }

    /// Emits the events of what has changed at an instant.
    fn emit(&mut self, stretch: &Stretch, at_s: f64, was: &InForce) {
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        let slider = &mut self.course.slider;
        let contact = core::mem::replace(&mut slider.memory.contact, was.memory.contact);
        for (i, before) in was.modes.iter().enumerate() {
            let kind = match (*before, self.course.mode(i)) {
                (Mode::Stick, Mode::Stick) => continue,
                (Mode::Stick, Mode::Slip(_)) => EventKind::Slip,
                (Mode::Slip(_), Mode::Stick) => EventKind::Stick,
                (Mode::Slip(from), Mode::Slip(to)) if from == to => continue,
                (Mode::Slip(_), Mode::Slip(_)) => EventKind::Reversal,
            };
            let [place_m, _] = self.phase.position_and_velocity(i);
            let interface = self.course.interface_mut(i);
            if *before != Mode::Stick {
                interface.sliding.end(time_s, place_m);
            }
            if interface.mode != Mode::Stick {
                interface.sliding.begin(time_s, place_m);
            }
            self.push_event(time_s, i, kind);
            if i == 0 {
                self.come_to_stop();
                self.begin_bearing_on_stop(time_s);
            }
        }
        if contact != was.memory.contact {
            let speed = self.phase.position_and_velocity(0)[1].abs();
            let kind = self.course.slider.change_contact(time_s, speed, contact);
            self.push_event(time_s, 0, kind);
        }
    }
}
