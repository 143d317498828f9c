//! Rigid stops: impacts, bounces that come to rest, and the time at rest against them.

use super::super::course::{Near, Sliding};
use super::super::ground::Stretch;
use super::super::phase::Of;
use super::Line;
use crate::linear::polynomial::{Polynomial, deflated, first_root, value};
use crate::response::{EventKind, Mode};
use crate::slider::{Direction, Hold};

/// Impacts slower than this are neither listed nor counted, in m/s.
pub(in crate::solver) const SLOWEST_IMPACT_M_PER_S: f64 = 1e-3;

/// Where a bounce is below the rounding of `s`: parts of the stop's distance, or of the largest `s` at a stop without one.
pub(in crate::solver) const LEAST_BOUNCE: f64 = 4.0 * f64::EPSILON;

/// Longest remaining time of infinitely many bounces, as a part of the whole time: it is left out.
pub(in crate::solver) const LONGEST_REST: f64 = 8.0 * f64::EPSILON;

impl<'a> Line<'a> {
    /// Moves to a part of the series beside a stop that has just been struck; further away `s` itself has
    /// the digits.
    #[inline(never)]
    pub(super) fn move_near(&mut self, part: f64) {
        let mut moved = *self.phase.displacement();
        moved[0] = 0.0;
        if let Some(near) = &mut self.course.near {
            near.offset += value(&moved, part);
            let [_, w] = self.phase.position_and_velocity(0);
            self.phase.set_position_and_velocity(0, [near.place + near.offset, w]);
        }
        self.course.near =
            self.course.near.filter(|near| near.offset.abs() <= 1e-3 * near.place.abs());
    }

    /// The rigid stop that the block is off by no more than the rounding of `s`: where it comes to rest,
    /// it is at it.
    fn stop_within_reach(&self) -> Option<f64> {
        let is_at_it = |near: &Near| near.offset.abs() <= 8.0 * f64::EPSILON * near.place.abs();
        self.course.near.filter(is_at_it).map(|near| near.place)
    }

    /// What holds the slider if it comes to rest here.
    pub(super) fn hold_at_rest(&self) -> Hold {
        match self.stop_within_reach() {
            Some(place) => self.course.slider.hold(place),
            None => self.phase.hold(&self.course, 0),
        }
    }

    /// A block held within reach of a rigid stop is at it.
    pub(super) fn come_to_stop(&mut self) {
        if self.course.block.mode == Mode::Stick
            && let Some(place) = self.stop_within_reach()
        {
            self.stop_at(place);
            let slider = &mut self.course.slider;
            slider.law.settle(&mut slider.memory, place);
        }
    }

    /// The block rests at a stop.
    fn stop_at(&mut self, place: f64) {
        self.course.near = None;
        let [_, w] = self.phase.position_and_velocity(0);
        self.phase.set_position_and_velocity(0, [place, w]);
    }

    /// Begins or ends the time at rest at a rigid stop.
    pub(in crate::solver) fn begin_bearing_on_stop(&mut self, time_s: f64) {
        self.end_bearing_on_stop(time_s);
        let is_stuck = self.course.block.mode == Mode::Stick;
        if is_stuck && self.phase.hold(&self.course, 0).bears_on_stop != [false; 2] {
            self.bears_on_stop_since_s = Some(time_s);
        }
    }

    pub(in crate::solver) fn end_bearing_on_stop(&mut self, time_s: f64) {
        if let Some(since_s) = self.bears_on_stop_since_s.take() {
            self.course.slider.stopping.demands.contact_time_s += time_s - since_s;
        }
    }

    /// Where friction takes all of the push against a rigid stop, or no longer does.
    #[inline(never)]
    pub(super) fn first_change_of_bearing(&mut self, part: f64) -> Option<f64> {
        let beyond = self.phase.beyond_friction(&self.course);
        let mut sides: Vec<Polynomial> = beyond.into_iter().map(|(_, beyond)| beyond).collect();
        if core::mem::take(&mut self.bearing_changed) {
            let least = sides.iter().fold(f64::INFINITY, |least, p| least.min(p[0].abs()));
            sides.iter_mut().filter(|p| p[0].abs() <= least).for_each(|p| p[0] = 0.0);
        }
        let root = |beyond: &Polynomial| {
            let order = beyond.iter().position(|c| *c != 0.0)?;
            let sign = beyond[order].signum();
            let p = deflated(&beyond.map(|c| sign * c), order);
            first_root(&p, part).filter(|at| *at > 0.0)
        };
        sides.iter().filter_map(root).reduce(f64::min)
    }

    /// The block strikes a rigid stop, moving in a direction: `ṡ⁺ = −e ṡ⁻`; what does not touch the
    /// stop keeps its absolute velocity.
    pub(super) fn strike(&mut self, stretch: &Stretch, at_s: f64, direction: Direction) {
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        let Some(e) = self.course.slider.law.restitution() else { return };
        let [place, before] = self.phase.position_and_velocity(0);
        let fast = before.abs() >= SLOWEST_IMPACT_M_PER_S;
        let turn = self.turn.take();
        if !fast && let Some(turn) = turn {
            self.course.events.remove(turn);
        }
        let slider = &mut self.course.slider;
        let peak = &mut slider.stopping.demands.peak_impact_speed_m_per_s;
        *peak = peak.max(before.abs());
        if fast && self.first_impact_s.is_none() {
            self.first_impact_s = Some(time_s);
        }
        self.course.block.sliding.end(time_s, place);
        slider.law.strike(&mut slider.memory, place, direction);
        let after = -e * before;
        self.jump(time_s, before, after);
        if after == 0.0 {
            self.rest_at_stop(time_s, place);
            return;
        }
        let away = direction.opposite();
        self.course.block.mode = Mode::Slip(away);
        self.course.block.sliding.begin(time_s, place);
        let slider = &mut self.course.slider;
        slider.law.resume(&mut slider.memory, after.abs(), away);
        self.course.near = Some(Near { place, offset: 0.0 });
        if fast {
            self.push_event(time_s, 0, EventKind::Impact);
            self.turn = None;
        } else {
            self.course.events_in_interval += 1;
        }
        if self.comes_to_rest(stretch, at_s, direction, e) {
            self.jump(time_s, after, 0.0);
            self.course.block.sliding.end(time_s, place);
            self.rest_at_stop(time_s, place);
        }
    }

    /// Gives the block another velocity; floors and contents keep their absolute velocities.
    fn jump(&mut self, time_s: f64, before: f64, after: f64) {
        let velocities = |walk: &Self| -> Vec<f64> {
            (0..walk.course.interfaces()).map(|i| walk.phase.position_and_velocity(i)[1]).collect()
        };
        let was = velocities(self);
        let [s, _] = self.phase.position_and_velocity(0);
        self.phase.set_position_and_velocity(0, [s, after]);
        self.phase.apply_impulse(before - after);
        for (i, (was, now)) in was.into_iter().zip(velocities(self)).enumerate().skip(1) {
            // What is on another floor moves on as before.
            if was == now {
                continue;
            }
            let interface = self.course.interface_mut(i);
            interface.start = None;
            let direction = match now {
                p if p > 0.0 => Direction::Positive,
                p if p < 0.0 => Direction::Negative,
                _ => continue,
            };
            let kind = match interface.mode {
                Mode::Slip(before) if before == direction => continue,
                Mode::Slip(_) => EventKind::Reversal,
                Mode::Stick => EventKind::Slip,
            };
            let [place, _] = self.phase.position_and_velocity(i);
            let interface = self.course.interface_mut(i);
            if interface.mode != Mode::Stick {
                interface.sliding.end(time_s, place);
            }
            interface.mode = Mode::Slip(direction);
            interface.sliding.begin(time_s, place);
            self.push_event(time_s, i, kind);
        }
    }

    fn rest_at_stop(&mut self, time_s: f64, place: f64) {
        self.stop_at(place);
        self.stick(0);
        self.push_event(time_s, 0, EventKind::Rest);
        self.begin_bearing_on_stop(time_s);
    }

    /// Whether infinitely many bounces are left, all below rounding.
    ///
    /// With `P` and `Q` the accelerations towards the stop on the way in and out, speeds shrink by
    /// `r = e √(P/Q)` a bounce and `T∞ = (w⁺/Q) (1 + √(Q/P)) / (1 − r)`.
    fn comes_to_rest(&mut self, stretch: &Stretch, at_s: f64, inward: Direction, e: f64) -> bool {
        let [s, w] = self.phase.position_and_velocity(0);
        let speed = w.abs();
        let (away, memory) = (self.course.block.mode, self.course.slider.memory.clone());
        let q = inward.sign() * self.acceleration_at(stretch, at_s);
        self.course.block.mode = Mode::Slip(inward);
        let slider = &mut self.course.slider;
        slider.law.resume(&mut slider.memory, 0.0, inward);
        let p = inward.sign() * self.acceleration_at(stretch, at_s);
        (self.course.block.mode, self.course.slider.memory) = (away, memory);
        self.phase.update_branch(&self.course);
        if !(p > 0.0 && q > 0.0) {
            return false;
        }
        let r = e * (p / q).sqrt();
        let rest_s = speed / q * (1.0 + (q / p).sqrt()) / (1.0 - r);
        let bounce = 0.5 * speed * speed / q;
        let end_s = self.ground.times_s[self.ground.times_s.len() - 1];
        let Sliding { max_m, min_m, .. } = self.course.block.sliding;
        let size_m = if s == 0.0 { max_m.max(-min_m) } else { s.abs() };
        r < 1.0 && bounce < LEAST_BOUNCE * size_m && rest_s < LONGEST_REST * end_s
    }

    /// Acceleration of the block over the ground at an instant.
    fn acceleration_at(&mut self, stretch: &Stretch, at_s: f64) -> f64 {
        self.phase.update_branch(&self.course);
        self.phase.look_at_instant(&self.course, stretch, at_s);
        self.phase.acceleration(Of::Instant, 0)[0]
    }
}
