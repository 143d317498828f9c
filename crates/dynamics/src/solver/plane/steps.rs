//! Steps of a motion in two horizontal directions.

use super::Plane;
use super::series::{Kind, square};
use super::speed::{path_m, slope_of, turns};
use super::stop::{Instant, REST};
use super::system::Loads;
use super::vector::{inner, norm};
use crate::linear::polynomial::{DEGREE, Polynomial, value};
use crate::slider::Contact;
use crate::solver::ground::Stretch;
use crate::solver::slider::{ROUNDING, falls_below, first_crossing, leading};

impl Plane<'_> {
    /// One step of a stick, perhaps to its release; the time reached.
    pub(super) fn hold(&mut self, stretch: &Stretch, at_s: f64) -> f64 {
        let left_s = stretch.to_s - at_s;
        let loads = self.loads(stretch, at_s);
        self.expand_stick(loads, left_s);
        let change_n = loads.normal[1] * self.series.unit;
        let mut part = self.series.part.min(self.system.hold.reach([loads.normal[0], change_n]));
        let distance = self.distance();
        if let Some(release) = self.first_release(&distance, part) {
            (part, self.is_released) = (release, true);
        }
        self.move_by(stretch, at_s, part)
    }

    pub(super) fn expand_stick(&mut self, loads: Loads, left_s: f64) {
        self.hold_stop();
        let unit_s = self.system.within_reach(left_s);
        self.expand(Kind::Stick, (loads, unit_s));
        self.lean_on_stop();
    }

    /// `(μ_s N/M1)² − |p|²` in stick.
    pub(super) fn distance(&self) -> Polynomial {
        let p = &self.series.friction;
        let [normal, rate] = self.series.loads.normal;
        let mut distance = self.system.hold.squared_radius([normal, rate * self.series.unit]);
        let last = DEGREE.min(2 * self.series.degree);
        for (k, distance) in distance[..=last].iter_mut().enumerate() {
            *distance -= square(&p[0], k) + square(&p[1], k);
        }
        distance
    }

    /// What of that is rounding at an instant of a stick, with `g` of that instant.
    pub(super) fn rounding_of_distance(&self, loads: &Loads, push: [f64; 2], g: &[f64]) -> f64 {
        let (terms, holds) = (self.terms(loads, g), self.system.hold.radius(loads.normal[0]));
        2.0 * ROUNDING * (holds * holds + norm(push).max(holds) * terms)
    }

    /// The size of the terms of the push at an instant, with `g` of that instant.
    pub(super) fn terms(&self, loads: &Loads, g: &[f64]) -> f64 {
        let (system, mut terms) = (&self.system, 0.0);
        let [_, inertia] = system.stretches();
        let [stop, _] = system.stop_per_kg(self.state.contact);
        for axis in 0..2 {
            let l = &system.participation[axis];
            let shear: f64 = l.iter().zip(g).map(|(l, g)| (l * g).abs()).sum();
            let springs = system.stiffness_n_per_m + loads.normal[0] * system.per_radius;
            let slider = (springs + stop * system.block_kg) * self.state.s[axis].abs();
            terms += (shear + slider) / system.block_kg + inertia * loads.table[axis][0].abs();
        }
        terms
    }

    /// The first part of a stick at which it is released.
    fn first_release(&self, distance: &Polynomial, part: f64) -> Option<f64> {
        let mut distance = *distance;
        let at = first_crossing(&distance, part)?;
        let series = &self.series;
        let push = [series.friction[0][0], series.friction[1][0]];
        let rounding = self.rounding_of_distance(&series.loads, push, &series.g);
        // What does not go further below zero than rounding is held.
        let order = leading(&distance, rounding)?;
        distance[..order].fill(0.0);
        falls_below(&distance, rounding, part).then_some(())?;
        if order == 0 { Some(at) } else { first_crossing(&distance, part) }
    }

    /// One step of a slip; the time reached.
    pub(super) fn slide(&mut self, stretch: &Stretch, at_s: f64) -> f64 {
        let left_s = stretch.to_s - at_s;
        let loads = self.loads(stretch, at_s);
        if self.is_let_go(&loads) {
            self.reached = Some(Contact::Free);
            return at_s;
        }
        let is_pressed = loads.normal[0] > 0.0 || loads.normal[1] > 0.0;
        let has_friction = is_pressed && !self.system.kinetic_per_kg.is_none();
        if !has_friction {
            if !core::mem::take(&mut self.starts) && self.rests_without_friction(&loads) {
                self.state.w = [0.0; 2];
                return at_s;
            }
            return match self.state.contact {
                Contact::Pressed(_) => self.press_freely((stretch, at_s), loads),
                _ => self.step_freely((stretch, at_s), loads),
            };
        }
        let at = self.instant(&loads);
        if at.speed > 0.0 {
            let rest_s = at.time_to_rest(&self.system, &self.state, &loads, &self.g);
            if let Some(time_s) = rest_s.filter(|time_s| *time_s <= left_s) {
                self.rest(&at, (&loads, time_s));
                return at_s + time_s;
            }
            if at.is_at_rest(self.state.w, self.peak_speed) {
                self.rest(&at, (&loads, 0.0));
                return at_s;
            }
        }
        self.step_slip(&at, (stretch, at_s), loads)
    }

    /// One step without friction.
    fn step_freely(&mut self, (stretch, at_s): (&Stretch, f64), loads: Loads) -> f64 {
        self.hold_stop();
        let mut unit_s = self.system.within_reach(stretch.to_s - at_s);
        loop {
            self.expand(Kind::Frictionless, (loads, unit_s));
            let part = self.series.part;
            // Far beyond what a series takes its terms lose their digits, and overflow.
            if part >= 1e-3 || part == 0.0 || !(unit_s > 0.0) {
                break;
            }
            unit_s *= if part.is_nan() { 1e-4 } else { 4.0 * part };
        }
        self.end_freely(stretch, at_s)
    }

    /// Moves to the end of a series without friction, or to where the block rests or its contact with the stop changes.
    pub(super) fn end_freely(&mut self, stretch: &Stretch, at_s: f64) -> f64 {
        let change = self.contact_change(self.series.part);
        let rest = self.part_to_rest().filter(|rest| change.is_none_or(|(part, _)| *rest <= part));
        if let Some(part) = rest {
            let to_s = self.move_by(stretch, at_s, part);
            self.state.w = [0.0; 2];
            return to_s;
        }
        let part = change.map_or(self.series.part, |(part, _)| part);
        self.reached = change.map(|(_, to)| to);
        self.move_by(stretch, at_s, part)
    }

    /// Expands the motion from the state.
    pub(super) fn expand(&mut self, kind: Kind, over: (Loads, f64)) {
        self.series.expand(&self.system, (kind, &self.state), over, &self.scales);
    }

    /// Whether a slip without friction is at rest where the block would be held.
    fn rests_without_friction(&mut self, loads: &Loads) -> bool {
        let speed = norm(self.state.w);
        if !(speed > 0.0 && speed <= REST * self.peak_speed) {
            return false;
        }
        let at = self.instant(loads);
        norm(at.push) <= at.holds
    }

    /// The part of a series without friction at which straight motion comes to rest where the block is held.
    fn part_to_rest(&self) -> Option<f64> {
        let series = &self.series;
        let [normal, rate] = series.loads.normal;
        if self.system.hold.radius(1.0) == 0.0 || (normal == 0.0 && rate == 0.0) {
            return None;
        }
        let mut peak = self.peak_speed;
        for (x, is_least) in turns(slope_of(series), series.part) {
            let speed = norm(series.velocity_at(x));
            peak = peak.max(speed);
            if is_least && speed <= REST * peak {
                let loads = series.loads.after(series.unit * x);
                let push =
                    loads.push(&self.system, [0, 1].map(|axis| value(&series.pull[axis], x)));
                if self.system.hold.excess(norm(push), loads.normal[0]) <= 0.0 {
                    return Some(x);
                }
            }
        }
        None
    }

    /// Comes to rest after a time too short to move in.
    fn rest(&mut self, at: &Instant, (loads, time_s): (&Loads, f64)) {
        let (w, from) = (self.state.w, (at.pull, self.system.shear_n(&self.g)));
        // ∫ b dt = −w + a Θ
        let impulse = [0, 1].map(|k| loads.table[k][0] * time_s - self.state.w[k]);
        for j in 0..self.system.modes() {
            let l = [self.system.participation[0][j], self.system.participation[1][j]];
            self.state.eta[j] += self.state.rate[j] * time_s;
            self.state.rate[j] -= self.g[j] * time_s + inner(l, impulse);
        }
        self.state.w = [0.0; 2];
        let to = self.instant(&loads.after(time_s));
        let arc = at.arc(&self.system, w, &to);
        let shear_n = self.system.shear_n(&self.g);
        let of = ([from.0, to.pull], [from.1, shear_n]);
        self.peaks.note_arc(&self.system, &arc, of, &self.g);
        self.direction = arc.to;
        self.is_near_rest = false;
    }

    /// Moves to a part of a series in the time; the time reached.
    pub(super) fn move_by(&mut self, stretch: &Stretch, at_s: f64, part: f64) -> f64 {
        let to_s = at_s + part * self.series.unit;
        let is_whole = part == 1.0 && to_s >= stretch.to_s * (1.0 - 1e-15);
        self.move_part(stretch, at_s, part);
        if is_whole { stretch.to_s } else { to_s.min(stretch.to_s) }
    }

    /// Moves to a part of the series, and keeps what it tells.
    fn move_part(&mut self, stretch: &Stretch, at_s: f64, part: f64) {
        self.series.state_at(part, &mut self.state);
        self.keep_on_stop(part);
        self.look(stretch, at_s, part);
        self.scales.note(&self.state);
        if self.series.kind != Kind::Stick {
            let speed = norm(self.state.w);
            self.peak_speed = self.peak_speed.max(speed);
            if speed > 0.0 {
                self.direction = self.state.w.map(|w| w / speed);
            }
        }
    }

    /// Looks for peaks up to the state, and adds to the path.
    fn look(&mut self, stretch: &Stretch, at_s: f64, part: f64) {
        self.look_for_peaks(stretch, at_s, part);
        self.look_at_stop(part);
        self.path_m += path_m(&self.series, (part, &self.force.speeds));
        self.least.look(&self.series, (part, &self.force.speeds));
    }

    /// Looks for peaks in the first part of the series, up to the state.
    pub(super) fn look_for_peaks(&mut self, stretch: &Stretch, at_s: f64, part: f64) {
        let from_s = self.ground.times_s[stretch.interval] + at_s;
        let g = &mut self.g;
        self.system.restoring(&self.state.eta, &self.state.rate, g);
        self.peaks.look(&self.system, (&self.series, part), from_s, (&self.state, g));
    }
}
