//! Decisions at knots: what lets go, what stops, what strikes, and how close it was.

use core::ops::Range;

use super::super::events::SLOWEST_IMPACT_M_PER_S;
use super::super::ground::{Load, nearest};
use super::super::judge::{Directions, Judge};
use super::super::law::{BOUNDLESS, StickDemand, UNBOUNDED, either};
use super::super::structure::larger;
use super::super::{ClosestCall, DecisionKind};
use super::Line;
use super::group::{Feed, Group};
use super::work::Work;
use crate::response::Mode;
use crate::response::output::{FRICTION, OF_BLOCK};
use crate::slider::Direction;

/// Changes of modes at knots, and what is asked there in modes and under loads that may have led to them.
#[derive(Default)]
struct ChangeDemands {
    changes: Vec<Change>,
    /// Lists of modes, one after another, and loads.
    modes: Vec<Mode>,
    loads: Vec<Load>,
    /// Of every list of modes of a change under every load: `T`, the mass of the block with what sticks to
    /// it, the accelerations of contents.
    forces: Vec<f64>,
    interfaces: usize,
}

/// A knot at which something changes its mode: which lists of modes and loads belong to it.
struct Change {
    knot: usize,
    modes: Range<usize>,
    loads: Range<usize>,
    /// The first of its forces.
    forces: usize,
}

impl ChangeDemands {
    fn modes(&self, list: usize) -> &[Mode] {
        &self.modes[list * self.interfaces..][..self.interfaces]
    }

    /// Adds modes of which one interface perhaps sticks to those of the change from a list on.
    fn ask(&mut self, first: usize, modes: &[Mode], sticks: Option<usize>) {
        let from = self.modes.len();
        self.modes.extend_from_slice(modes);
        if let Some(i) = sticks {
            self.modes[from + i] = Mode::Stick;
        }
        let last = from / self.interfaces;
        if (first..last).any(|list| self.modes(list) == self.modes(last)) {
            self.modes.truncate(from);
        }
    }

    /// The forces of a change in modes, of which one interface perhaps sticks, under a load.
    fn forces(
        &self,
        change: &Change,
        modes: &[Mode],
        sticks: Option<usize>,
        load: &Load,
    ) -> &[f64] {
        let same = |list: usize| {
            let pairs = self.modes(list).iter().zip(modes).enumerate();
            pairs
                .into_iter()
                .all(|(i, (own, mode))| *own == if sticks == Some(i) { Mode::Stick } else { *mode })
        };
        let lists = change.modes.clone().position(same);
        let load = self.loads[change.loads.clone()].iter().position(|own| own == load);
        let (Some(list), Some(load)) = (lists, load) else { return &[] };
        let stride = 1 + self.interfaces;
        let at = change.forces + (list * change.loads.len() + load) * stride;
        self.forces.get(at..at + stride).unwrap_or(&[])
    }
}

impl<'a> Judge<'a, Line<'a>> {
    /// Judges all decisions at knots, of which modes change at some.
    pub(super) fn judge_changes(&mut self, changes: &[usize]) {
        for run in 1..self.runs.len() {
            if self.strikes(self.runs[run].from) {
                self.impact(self.runs[run].from);
            }
        }
        let mut asked = ChangeDemands { interfaces: self.h.interfaces, ..ChangeDemands::default() };
        for &k in changes.iter().filter(|&&k| !self.strikes(k)) {
            self.change(k, &mut asked);
        }
        self.ask(&mut asked);
        for change in &asked.changes {
            self.changes(change, &asked);
            self.releases(change, &asked);
        }
    }

    /// What is to be asked at a knot.
    fn change(&self, knot: usize, asked: &mut ChangeDemands) {
        let (list, load) = (asked.modes.len() / asked.interfaces, asked.loads.len());
        for now in self.ground.instant(self.h.time_s[knot]) {
            if !asked.loads[load..].contains(&now) {
                asked.loads.push(now);
            }
        }
        let (before, after) = (self.before(knot), self.h.modes(knot));
        let at_rest = self.at_rest(knot);
        for i in (0..after.len()).filter(|&i| before[i] != after[i]) {
            for others in [before, after, &at_rest] {
                asked.ask(list, others, Some(i));
            }
        }
        let gone = gone(before, after);
        if gone.len() > 1 {
            asked.ask(list, before, None);
            for &i in &gone {
                asked.ask(list, &release(before, after, i), None);
            }
        }
        let (modes, loads) = (list..asked.modes.len() / asked.interfaces, load..asked.loads.len());
        asked.changes.push(Change { knot, modes, loads, forces: 0 });
    }

    /// Modes after a knot, of which what has no velocity sticks.
    fn at_rest(&self, k: usize) -> Vec<Mode> {
        let one = |(i, mode): (usize, &Mode)| {
            if self.speed_at(k, i) == 0.0 { Mode::Stick } else { *mode }
        };
        self.h.modes(k).iter().enumerate().map(one).collect()
    }

    /// Finds the forces of all changes, eight at a time.
    fn ask(&self, asked: &mut ChangeDemands) {
        let bench = self.bench();
        let mut work = Work::new(&bench, OF_BLOCK);
        let mut group = Group::new(&bench);
        let stride = 1 + asked.interfaces;
        let mut count = 0;
        for change in &mut asked.changes {
            change.forces = count * stride;
            count += change.modes.len() * change.loads.len();
        }
        let mut forces = Vec::with_capacity(count * stride);
        let mut find = |group: &mut Group| {
            let lanes = group.count;
            group.fill();
            bench.instants(group, &self.ground, &mut work);
            for lane in 0..lanes {
                forces.extend([work.ends[0][FRICTION].0[lane], bench.block_mass(group, lane)]);
                let contents = 0..self.axes.structure.contents.len();
                forces.extend(contents.map(|e| bench.acceleration(&work, e, lane)));
            }
            group.count = 0;
        };
        for change in &asked.changes {
            for list in change.modes.clone() {
                for load in &asked.loads[change.loads.clone()] {
                    let course = self.course(change.knot, asked.modes(list), Feed::instant(*load));
                    if group.push(&bench, &course) {
                        find(&mut group);
                    }
                }
            }
        }
        if group.count > 0 {
            find(&mut group);
        }
        asked.forces = forces;
    }

    /// What an interface at rest is asked for by a demand or an acceleration of contents.
    pub(super) fn asked_in(
        &self,
        i: usize,
        value: f64,
        hold: [f64; 2],
        normal: f64,
    ) -> StickDemand {
        let Some(contents) = i.checked_sub(1).map(|e| &self.axes.structure.contents[e]) else {
            let [low, high] = hold;
            let low = if low <= -UNBOUNDED { f64::NEG_INFINITY } else { low * normal };
            let high = if high >= UNBOUNDED { f64::INFINITY } else { high * normal };
            return StickDemand { demand: value, low, high };
        };
        let share = contents.mass_kg / self.axes.structure.total_kg;
        let high = contents.static_friction * share * normal;
        StickDemand { demand: contents.mass_kg * value, low: -high, high }
    }

    /// What the rounding of times makes of what an interface at rest is asked for, less what holds it.
    pub(super) fn rounding(&self, i: usize, mass_kg: f64, load: &Load) -> f64 {
        let mu = match i.checked_sub(1).map(|e| &self.axes.structure.contents[e]) {
            None => self.law.most(),
            Some(c) => c.static_friction * c.mass_kg / self.axes.structure.total_kg,
        };
        load.rounding(self.ground.blur(), mass_kg, mu)
    }

    /// Mass of an interface's own body with what sticks to it at a knot.
    pub(super) fn stuck_mass(&self, k: usize, i: usize) -> f64 {
        let contents = &self.axes.structure.contents;
        match i.checked_sub(1) {
            Some(e) => contents[e].mass_kg,
            None => contents.iter().zip(&self.h.modes(k)[1..]).fold(
                self.axes.structure.block_kg,
                |sum, (contents, mode)| match mode {
                    Mode::Stick if contents.floor == 0 => sum + contents.mass_kg,
                    _ => sum,
                },
            ),
        }
    }

    /// Between which `T/N` the slider is held after what it did before a knot; `leans` where rigid stops hold
    /// too.
    fn hold_at(&self, k: usize, leans: bool) -> [f64; 2] {
        let stored = self.h.surface_displacements(k);
        let hold = match self.before(k)[0] {
            Mode::Slip(slid) if self.law.series.is_some() => {
                self.law.hold(&self.law.off_ends(stored, slid))
            }
            _ => self.law.hold(stored),
        };
        let stops = self.law.leans(self.h.sliding_displacement_m[k]).map(|stop| stop && leans);
        either(stops, BOUNDLESS, hold)
    }

    /// What an interface at rest is asked for by the forces at a change, with the rounding of it.
    fn asked(&self, i: usize, forces: &[f64], hold: [f64; 2], load: &Load) -> (StickDemand, f64) {
        let of = |place: usize| forces.get(place).copied().unwrap_or(f64::NAN);
        let (value, mass_kg) = match i.checked_sub(1) {
            None => (of(0), of(1)),
            Some(e) => (of(2 + e), self.axes.structure.contents[e].mass_kg),
        };
        (self.asked_in(i, value, hold, load.normal), self.rounding(i, mass_kg, load))
    }

    /// Judges the changes of mode at a knot, at which what changes has no velocity.
    fn changes(&mut self, change: &Change, asked: &ChangeDemands) {
        let k = change.knot;
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
                let forces = asked.forces(change, others[place], Some(i), &all[load]);
                self.asked(i, forces, hold, &all[load])
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
    fn releases(&mut self, change: &Change, list: &ChangeDemands) {
        let (k, after) = (change.knot, self.h.modes(change.knot));
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
            self.asked(i, list.forces(change, modes, None, load), hold, load).0
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
        for i in 0..self.axes.structure.degrees() {
            let [[x0, v0], [x1, v1]] = [k - 1, k].map(|k| self.stored(k, i));
            self.figures.displacement[0] = larger(self.figures.displacement[0], x1 - x0);
            let on_block = i > n && self.axes.structure.contents[i - 1 - n].floor == 0;
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
        0.5 * self.axes.structure.block_kg * (before * before - after * after)
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
