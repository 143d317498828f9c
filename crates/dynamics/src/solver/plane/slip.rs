//! A step of a slip under friction.

use super::Plane;
use super::nodes::{NODES, nodes};
use super::peaks::squared;
use super::ring::MOST_CORRECTIONS;
use super::series::Kind;
use super::stop::Instant;
use super::system::Loads;
use super::vector::{apart, inner, norm};
use crate::linear::polynomial::{ZERO, value};
use crate::slider::{Contact, IsotropicFriction};
use crate::solver::ground::Stretch;
use crate::solver::slider::first_crossing;

/// The last Legendre coefficients of friction over a step, times its length: of the largest speed, and of the least in the
/// step, which has a direction. What they leave out is theirs squared at the end of a step, and a hundredth within.
const TAIL: [f64; 2] = [1e-7, 1e-8];

/// Tolerance of the tail where friction follows straight lines: on a steep one it is off by as much as a slow speed is within a step.
const TAIL_OF_LINES: [f64; 2] = [1e-7, 1e-10];

/// What of these coefficients over friction is rounding.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Part of the time to rest under the push as it is that a step takes.
const OF_TIME_TO_REST: f64 = 0.75;

/// Part of the time in which the velocity changes by itself that a step takes of a slip that slows down.
const OF_CHANGE: f64 = 0.5;

/// A speed below this part of those at the ends of a step is too near rest for it.
const DIP: f64 = 0.05;

/// A push above friction by less than this part is at it.
const AT_BOUND: f64 = 1e-9;

/// A speed is at a corner of friction by straight lines if it is as near to it as this part of it.
const AT_CORNER: f64 = 16.0 * f64::EPSILON;

/// A part of a step that is all of it.
const WHOLE: f64 = 1.0 - 4.0 * f64::EPSILON;

/// Most cuts of a step to a corner: each comes nearer to it by the digits that the velocity has within a step.
const MOST_CUTS: usize = 8;

/// Most lengths that are tried for a step.
const MOST_LENGTHS: usize = 100;

/// What became of a step that was tried.
enum Tried {
    /// The step stands, and one so many times as long would.
    Stands(f64),
    /// One so many times as long may stand.
    Shorter(f64),
}

impl Plane<'_> {
    /// One step; the time reached.
    pub(super) fn step_slip(
        &mut self,
        at: &Instant,
        (stretch, at_s): (&Stretch, f64),
        loads: Loads,
    ) -> f64 {
        let left_s = stretch.to_s - at_s;
        let starts = core::mem::take(&mut self.starts) || at.speed == 0.0;
        let mut near_s = f64::INFINITY;
        if starts {
            self.next_s = f64::INFINITY;
        } else {
            near_s = self.reach_s(at);
            // As rest comes nearer the direction turns faster.
            if self.near_s.is_finite() && near_s < self.near_s {
                self.next_s *= near_s / self.near_s;
            }
        }
        self.near_s = near_s;
        self.force.forget();
        let (law, band) = self.law_at(at);
        let pressed_s = self.system.hold.reach(loads.normal);
        let whole_s = self.within_reach_of_stop(left_s).min(near_s).min(pressed_s);
        let (mut step_s, mut cuts, mut aimed_at) = (whole_s.min(self.next_s), 0, None);
        for _ in 0..MOST_LENGTHS {
            match self.try_slip((at, &law), starts, (loads, step_s)) {
                Tried::Shorter(part) => step_s *= part,
                Tried::Stands(part) => {
                    let corner = self.part_within(band);
                    let change = self.contact_change(1.0);
                    let contact = change.map(|(part, _)| part).filter(|part| *part < WHOLE);
                    let first = corner.into_iter().chain(contact).reduce(f64::min);
                    if let Some(first) = first.filter(|_| cuts < MOST_CUTS) {
                        (step_s, cuts) = (step_s * first, cuts + 1);
                        aimed_at = change.filter(|(part, _)| *part == first).map(|(_, to)| to);
                        continue;
                    }
                    self.reached = change.map(|(_, to)| to).or(aimed_at);
                    let longer_s = step_s * part;
                    // What has been cut says nothing about how long a step may be.
                    let was_cut = step_s < self.next_s && self.next_s.is_finite();
                    self.next_s = if was_cut { longer_s.max(self.next_s) } else { longer_s };
                    self.is_near_rest = starts || step_s >= near_s || self.next_s < 0.5 * left_s;
                    return self.move_by(stretch, at_s, 1.0);
                }
            }
            self.next_s = step_s;
        }
        at_s
    }

    /// The law of friction on the line of the speed on which a slip goes on, and the speeds between which it lies.
    fn law_at(&self, at: &Instant) -> (IsotropicFriction, [f64; 2]) {
        let law = &self.system.kinetic_per_kg;
        if !law.has_corners() {
            return (law.clone(), [0.0, f64::INFINITY]);
        }
        let w = self.state.w;
        let along = if at.speed > 0.0 { w.map(|w| w / at.speed) } else { self.direction };
        let change = self.system.moved([0, 1].map(|k| at.push[k] - at.friction * along[k]));
        law.line_of(at.speed, inner(along, change) >= 0.0, AT_CORNER)
    }

    /// The part of the series at whose end the speed leaves a line of the law of friction, where that is before its end.
    ///
    /// Within a step the velocity is known less well than at its end: a step to the corner is another.
    fn part_within(&self, [low, high]: [f64; 2]) -> Option<f64> {
        let square = squared(&self.series.w);
        let distance = |corner: f64, sign: f64| {
            let beyond = corner * (1.0 + sign * AT_CORNER);
            let mut distance = square.map(|c| -sign * c);
            distance[0] = (distance[0] + sign * (beyond * beyond)).max(0.0);
            first_crossing(&distance, 1.0)
        };
        let up = if high.is_finite() { distance(high, 1.0) } else { None };
        let down = if low > 0.0 { distance(low, -1.0) } else { None };
        let first = up.into_iter().chain(down).reduce(f64::min)?;
        (first > 0.0 && first < WHOLE).then_some(first)
    }

    /// How far a step may reach of a slip that slows down.
    fn reach_s(&self, at: &Instant) -> f64 {
        let (w, friction) = (self.state.w, at.friction);
        let u = w.map(|w| w / at.speed);
        let change = self.system.moved([0, 1].map(|k| at.push[k] - friction * u[k]));
        if inner(u, change) >= 0.0 {
            return f64::INFINITY;
        }
        let push = norm(at.push);
        if self.system.mass.is_none() && push < friction {
            let rest_s =
                (friction * at.speed + inner(at.push, w)) / ((friction - push) * (friction + push));
            return OF_TIME_TO_REST * rest_s;
        }
        OF_CHANGE * at.speed / norm(change)
    }

    /// Tries a step of a length, leaving its series.
    fn try_slip(
        &mut self,
        (at, law): (&Instant, &IsotropicFriction),
        starts: bool,
        over: (Loads, f64),
    ) -> Tried {
        self.series.stopped = [ZERO; 2];
        self.guess_stop(over);
        if let Some(part) = self.go_freely(starts, over) {
            return Tried::Shorter(fitting(part));
        }
        self.influence.prepare(&self.system, (&over.0, over.1), &mut self.series);
        let w = self.state.w;
        let along = if at.speed > 0.0 { w.map(|w| w / at.speed) } else { self.direction };
        if self.force.along_stop.is_some() {
            self.force.speeds = [at.speed; NODES];
        } else if starts && norm(at.push) <= at.friction * (1.0 + AT_BOUND) {
            // At its bound a block follows the push as that turns.
            let system = &self.system;
            self.force.guess_each(law, |change, stopped| {
                let p = apart(system.required_friction(change), stopped);
                let size = norm(p);
                if size > 0.0 { p.map(|p| p / size) } else { along }
            });
        } else {
            self.force.guess(law, along, at.speed, &self.influence);
        }
        let longer = match self.settle((at, law), starts, over, along) {
            Ok(longer) => longer,
            Err(part) => return Tried::Shorter(part),
        };
        if !(self.series.part >= 1.0) {
            return Tried::Shorter(fitting(self.series.part));
        }
        if !self.is_ahead_of_rest() {
            return Tried::Shorter(0.6);
        }
        Tried::Stands(longer.clamp(0.5, 4.0))
    }

    /// Finds the velocities at the nodes of a step without friction; the part of it that a series takes, if that is less.
    fn go_freely(&mut self, starts: bool, (loads, step_s): (Loads, f64)) -> Option<f64> {
        self.force.press(&self.system.kinetic_per_kg, &loads, step_s);
        if !starts {
            let of = (&self.state, &loads);
            if let Some(free) = self.influence.free(&self.system, of, step_s, &mut self.series) {
                self.force.free = free;
                return None;
            }
        }
        if !self.force.reaches(step_s) {
            self.expand(Kind::Frictionless, (loads, step_s));
            self.force.keep(&self.series);
            if !(self.series.part >= 1.0) {
                return Some(self.series.part);
            }
        }
        self.force.free_over(step_s);
        None
    }

    /// Finds the force at the nodes, and the series of the motion under it; how much longer a step may be, or shorter where
    /// this one does not stand.
    fn settle(
        &mut self,
        (at, law): (&Instant, &IsotropicFriction),
        starts: bool,
        (loads, step_s): (Loads, f64),
        along: [f64; 2],
    ) -> Result<f64, f64> {
        // Of a pendulum under a vertical motion the influence changes along the step, which the series knows.
        let varies = loads.normal[1] != 0.0 && self.system.per_radius > 0.0;
        let is_pressed = matches!(self.state.contact, Contact::Pressed(_));
        let most = match (is_pressed, varies) {
            (true, _) => MOST_CORRECTIONS,
            (_, true) => 12,
            _ => 1,
        };
        let mut longer = 0.0;
        for pass in 1..=most {
            let ahead = match self.force.along_stop {
                Some(along) => self.force.keep_to(along, law, &self.influence),
                None => self.force.settle(law, &self.influence),
            };
            if !ahead {
                return Err(if starts { 0.3 } else { 0.5 });
            }
            let (friction, tail) = self.force.polynomial();
            longer = self.longer(tail, starts, step_s);
            if longer < 1.0 {
                return Err((0.9 * longer).clamp(0.05, 0.7));
            }
            (self.series.friction, self.series.tail) = (friction, tail);
            self.series.from = along;
            if is_pressed {
                let by_stop = self.press_series();
                if by_stop < 1.0 {
                    return Err((0.9 * by_stop).clamp(0.05, 0.7));
                }
                longer = longer.min(by_stop);
            }
            self.expand(Kind::Slip, (loads, step_s));
            if !(varies || is_pressed) {
                break;
            }
            let mut off = 0.0_f64;
            for axis in 0..2 {
                for (j, x) in nodes().at.iter().enumerate() {
                    let more = value(&self.series.w[axis], *x) - self.force.w[axis][j];
                    self.force.free[axis][j] += more;
                    off = off.max(more.abs());
                }
            }
            let rounding = if is_pressed { 4.0 * f64::EPSILON } else { 1e-16 };
            let fastest = self.force.speeds.iter().fold(at.speed, |most, r| most.max(*r));
            // From rest the velocity is a difference of what pushes and what holds.
            let pushed = match is_pressed {
                true => step_s * (norm(at.pull) + self.force.largest() + self.borne_terms),
                false => 0.0,
            };
            let settled = off <= rounding * (fastest + pushed);
            if (!is_pressed || self.correct_stop()) && settled {
                break;
            }
            if is_pressed && pass == most {
                return Err(0.5);
            }
        }
        Ok(0.9 * longer)
    }

    /// By how much the last coefficients allow a step to be longer.
    fn longer(&self, last: f64, starts: bool, step_s: f64) -> f64 {
        let size = self.peak_speed.max(self.speed_scale);
        let friction = self.force.largest();
        // From rest the direction is that of the force, else that of the velocity.
        let slowest = if starts { 0.1 * friction * step_s } else { self.force.slowest() };
        let tail = if self.system.kinetic_per_kg.has_corners() { TAIL_OF_LINES } else { TAIL };
        let most = (tail[0] * size).min(tail[1] * slowest) / step_s;
        let most = most.max(ROUNDING * friction);
        // The eighth root: as many as there are nodes.
        (most / last).sqrt().sqrt().sqrt()
    }

    /// Whether the velocity keeps clear of rest up to the end of the step.
    fn is_ahead_of_rest(&self) -> bool {
        let (series, u) = (&self.series, &self.force.u);
        let end = series.velocity_at(1.0);
        let last = u.each_ref().map(|u| u[NODES - 1]);
        let (from, to) = (norm(self.state.w), norm(end));
        let least = if from > 0.0 { from.min(to) } else { 0.0 };
        inner(end, last) > 0.0 && self.force.slowest() >= DIP * least
    }
}

/// How much shorter a step is tried whose series takes a part of it.
fn fitting(part: f64) -> f64 {
    if part.is_nan() { 1e-4 } else { part.clamp(1e-3, 0.95) }
}
