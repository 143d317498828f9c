//! Decisions at knots: what lets go, what stops, what strikes, and how close it was.

use super::super::events::SLOWEST_IMPACT_M_PER_S;
use super::super::ground::{Load, nearest};
use super::super::judge::{Directions, Judge};
use super::super::law::{BOUNDLESS, StickDemand, UNBOUNDED, either};
use super::super::structure::larger;
use super::super::{ClosestCall, DecisionKind};
use super::Line;
use super::equations::Drive;
use crate::response::Mode;
use crate::slider::Direction;

impl<'a> Judge<'a, Line<'a>> {
    /// Judges all decisions at knots, of which modes change at some.
    pub(super) fn judge_changes(&mut self, changes: &[usize]) {
        for run in 1..self.runs.len() {
            if self.strikes(self.runs[run].from) {
                self.impact(self.runs[run].from);
            }
        }
        for &k in changes {
            if !self.strikes(k) {
                self.changes(k);
                self.releases(k);
            }
        }
    }

    /// Modes after a knot, of which what has no velocity sticks.
    fn at_rest(&self, k: usize) -> Vec<Mode> {
        let one = |(i, mode): (usize, &Mode)| {
            if self.speed_at(k, i) == 0.0 { Mode::Stick } else { *mode }
        };
        self.h.modes(k).iter().enumerate().map(one).collect()
    }

    /// What an interface at rest is asked for by a demand or an acceleration of contents.
    pub(super) fn required_friction_in(
        &self,
        i: usize,
        value: f64,
        hold: [f64; 2],
        normal: f64,
    ) -> StickDemand {
        let Some(contents) = i.checked_sub(1).map(|e| &self.structure().contents[e]) else {
            let ([low, high], normal) = (hold, self.law.pressed(normal));
            let low = if low <= -UNBOUNDED { f64::NEG_INFINITY } else { low * normal };
            let high = if high >= UNBOUNDED { f64::INFINITY } else { high * normal };
            return StickDemand { demand: value, low, high };
        };
        let share = contents.mass_kg / self.structure().total_kg;
        let high = contents.static_friction * share * normal;
        StickDemand { demand: contents.mass_kg * value, low: -high, high }
    }

    /// What the rounding of times makes of what an interface at rest is asked for, less what holds it.
    pub(super) fn rounding(&self, i: usize, mass_kg: f64, load: &Load) -> f64 {
        let mu = match i.checked_sub(1).map(|e| &self.structure().contents[e]) {
            None => self.law.most(),
            Some(c) => c.static_friction * c.mass_kg / self.structure().total_kg,
        };
        let load_rounding = self.ground.load_rounding();
        let normal =
            if i == 0 { self.pressed_rounding(load) } else { load.normal_rounding(load_rounding) };
        load.rounding_of_mass(load_rounding.0, mass_kg) + mu * normal
    }

    /// Between which `T/N` the slider is held after what it did before a knot; `bears_on_stop` where rigid stops hold
    /// too.
    fn hold_at(&self, k: usize, bears_on_stop: bool) -> [f64; 2] {
        let stored = self.h.surface_displacements(k);
        let hold = match self.before(k)[0] {
            Mode::Slip(slid) if self.law.series.is_some() => {
                self.law.hold(&self.law.off_ends(stored, slid))
            }
            _ => self.law.hold(stored),
        };
        let stops = self
            .law
            .bears_on_stop(self.h.sliding_displacement_m[k])
            .map(|stop| stop && bears_on_stop);
        either(stops, BOUNDLESS, hold)
    }

    /// What an interface at rest is asked for at a knot in modes, of which it perhaps sticks, with the rounding of it.
    fn required_friction(
        &self,
        (k, i): (usize, usize),
        (modes, sticks): (&[Mode], bool),
        hold: [f64; 2],
        load: &Load,
    ) -> (StickDemand, f64) {
        let mut modes = modes.to_vec();
        if sticks {
            modes[i] = Mode::Stick;
        }
        let (drive, state) = self.at_knot(k, &modes, load);
        let acting = self.axes.stepper.instant(&drive, [&state[0], &state[1]]);
        let (value, mass_kg) = match i.checked_sub(1) {
            None => (acting.friction[0], self.axes.stepper.equations.mass(&drive, 0)),
            Some(e) => (
                acting.bodies[self.structure().degree_of(i)][0],
                self.structure().contents[e].mass_kg,
            ),
        };
        (self.required_friction_in(i, value, hold, load.normal), self.rounding(i, mass_kg, load))
    }

    /// What drives an instant at a knot in modes under a load, and the state stored there; what sticks has no velocity.
    pub(super) fn at_knot<'m>(
        &self,
        k: usize,
        modes: &'m [Mode],
        load: &Load,
    ) -> (Drive<'m>, [Vec<f64>; 2]) {
        let drive = self.drive(&self.in_force(k, modes), &[*load; 2], None);
        let all = (0..self.structure().degrees()).map(|degree| self.stored(k, degree));
        let (x, mut v): (Vec<f64>, Vec<f64>) = all.map(|[x, v]| (x, v)).unzip();
        for i in (0..modes.len()).filter(|i| modes[*i] == Mode::Stick) {
            v[self.structure().degree_of(i)] = 0.0;
        }
        (drive, [x, v])
    }

    /// Judges the changes of mode at a knot, at which what changes has no velocity.
    fn changes(&mut self, k: usize) {
        let (h, time_s) = (self.h, self.h.time_s[k]);
        let after = h.modes(k);
        let all = self.ground.instant(time_s);
        let table = h.table_acceleration_m_per_s2[k];
        let nearest_s = nearest(all.map(|load| (load.table - table).abs()));
        let at_rest = self.at_rest(k);
        for i in 0..after.len() {
            let before = self.before(k);
            let was = before[i];
            if was == after[i] {
                continue;
            }
            // A bounce below the rounding of s turns back to the stop: that does not hold it.
            let hold = self.hold_at(k, after[i] == Mode::Stick);
            // The others may have changed before it or after it, or been held meanwhile.
            let others = [before, after, &at_rest];
            let places = if after.len() == 1 { 1 } else { 3 };
            let found = self.weigh((k, i), nearest_s, places, |load, place| {
                self.required_friction((k, i), (others[place], true), hold, &all[load])
            });
            self.decided((k, i), found);
        }
        let was = self.before(k)[0];
        if was != Mode::Stick
            && was != after[0]
            && let Some(margin) = self.law.next_join(h.surface_displacements(k), was)
        {
            self.nearest(ClosestCall { margin, time_s, kind: DecisionKind::Join, interface: 0 });
        }
    }

    /// Interfaces that let go at one knot: a close call where one of them, had it let go first, would have
    /// held the other back. Along a jump each reaches its bound at a part of the way.
    fn releases(&mut self, k: usize) {
        let after = self.h.modes(k);
        let before = self.before(k);
        let gone = gone(before, after);
        if gone.len() < 2 {
            return;
        }
        let all = self.ground.instant(self.h.time_s[k]);
        let side = |table: f64| {
            let off = all.map(|load| (load.table - table).abs());
            let place = nearest(off).iter().position(|is| *is);
            all[place.unwrap_or(0)]
        };
        let to = side(self.h.table_acceleration_m_per_s2[k]);
        let from = match k.checked_sub(1).filter(|&j| self.h.time_s[j] == self.h.time_s[k]) {
            Some(j) => side(self.h.table_acceleration_m_per_s2[j]),
            None => all[0],
        };
        let jumps = (from.table, from.normal) != (to.table, to.normal);
        let hold = self.hold_at(k, false);
        let at = |load: &Load, modes: &[Mode], i| {
            self.required_friction((k, i), (modes, false), hold, load).0
        };
        let reached = |i: usize| {
            let [first, last] = [&from, &to].map(|load| at(load, before, i));
            if !jumps {
                return last.margin().map_or(f64::INFINITY, f64::abs);
            }
            let part = |from: f64, to: f64| if to > from { -from / (to - from) } else { 1.0 };
            let above = part(first.demand - first.high, last.demand - last.high);
            let below = part(first.low - first.demand, last.low - last.demand);
            above.clamp(0.0, 1.0).min(below.clamp(0.0, 1.0))
        };
        let mut calls = Vec::new();
        for &i in &gone {
            let modes = release(before, after, i);
            for &j in gone.iter().filter(|&&j| j != i) {
                if at(&to, &modes, j).beyond() <= 0.0 {
                    let (a, b) = (reached(i), reached(j));
                    let margin = if jumps { (a - b).abs() } else { a.max(b) };
                    let time_s = self.h.time_s[k];
                    calls.push(ClosestCall {
                        margin,
                        time_s,
                        kind: DecisionKind::Release,
                        interface: j,
                    });
                }
            }
        }
        for call in calls {
            self.nearest(call);
        }
    }

    /// Whether the block strikes a rigid stop between the knot before `k` and `k`.
    pub(super) fn strikes(&self, k: usize) -> bool {
        let h = self.h;
        if self.law.restitution().is_none() || k == 0 || h.time_s[k] != h.time_s[k - 1] {
            return false;
        }
        let ([_, w0], [s, w1]) = (self.stored(k - 1, 0), self.stored(k, 0));
        let direction = if w0 > 0.0 { Direction::Positive } else { Direction::Negative };
        let [slack_m, _] = self.slack(w0);
        w0 != w1 && self.law.wall(direction).is_some_and(|wall| (s - wall).abs() <= slack_m)
    }

    /// Judges an impact: `ṡ⁺ = −e ṡ⁻`, absolute velocities of floors and contents as before.
    fn impact(&mut self, k: usize) {
        let e = self.law.restitution().unwrap_or(0.0);
        let [[_, before], [_, after]] = [k - 1, k].map(|k| self.stored(k, 0));
        self.figures.velocity[0] = larger(self.figures.velocity[0], after + e * before);
        let n = self.h.storeys;
        for i in 0..self.structure().degrees() {
            let [[x0, v0], [x1, v1]] = [k - 1, k].map(|k| self.stored(k, i));
            self.figures.displacement[0] = larger(self.figures.displacement[0], x1 - x0);
            let on_block = i > n && self.structure().contents[i - 1 - n].floor == 0;
            let change = if (1..=n).contains(&i) || on_block { before - after } else { 0.0 };
            if i > 0 {
                self.figures.velocity[0] = larger(self.figures.velocity[0], v1 - v0 - change);
            }
        }
        if before.abs() >= SLOWEST_IMPACT_M_PER_S {
            let margin = before.abs() / self.figures.velocity[1];
            let time_s = self.h.time_s[k];
            self.nearest(ClosestCall { margin, time_s, kind: DecisionKind::Impact, interface: 0 });
        }
    }

    /// Energy that an impact takes, in J.
    pub(super) fn lost_in_impact(&self, k: usize) -> f64 {
        let [[_, before], [_, after]] = [k - 1, k].map(|k| self.stored(k, 0));
        0.5 * self.structure().block_kg * (before * before - after * after)
    }
}

/// Modes before a knot, but for one interface, which has let go.
fn release(before: &[Mode], after: &[Mode], i: usize) -> Vec<Mode> {
    let mut modes = before.to_vec();
    modes[i] = after[i];
    modes
}

/// Interfaces that let go.
fn gone(before: &[Mode], after: &[Mode]) -> Vec<usize> {
    (0..after.len()).filter(|&i| before[i] == Mode::Stick && after[i] != Mode::Stick).collect()
}
