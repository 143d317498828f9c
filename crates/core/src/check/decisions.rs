//! Decisions at knots: what lets go, what stops, what strikes, and how close it was.

use fearless_simd::dispatch;

use super::events::SLOWEST_IMPACT_M_PER_S;
use super::ground::{Load, of_side};
use super::group::{Feed, Group, UNBOUNDED, Work};
use super::judge::Judge;
use super::lane::LANES;
use super::law::StickDemand;
use super::outputs::{FRICTION, STOREYS};
use super::structure::{excess, larger};
use super::{ClosestCall, DecisionKind};
use crate::response::Mode;
use crate::slider::Direction;

/// A knot at which something changes its mode, and what is asked in modes and under loads that may have
/// led to it.
struct Change {
    knot: usize,
    before: Vec<Mode>,
    modes: Vec<Vec<Mode>>,
    loads: Vec<Load>,
    /// Of every load in every list of modes: `T`, the mass of the block with what sticks to it, the
    /// accelerations of contents.
    forces: Vec<Vec<f64>>,
}

impl Change {
    /// Takes modes that are to be asked about.
    fn ask(&mut self, modes: Vec<Mode>) {
        if !self.modes.contains(&modes) {
            self.modes.push(modes);
        }
    }

    fn forces(&self, modes: &[Mode], load: &Load) -> &[f64] {
        let of = |modes: Option<usize>, load: Option<usize>| {
            self.forces.get(modes? * self.loads.len() + load?)
        };
        let modes = self.modes.iter().position(|own| own == modes);
        let load = self.loads.iter().position(|own| own == load);
        of(modes, load).map_or(&[], |forces| &forces[..])
    }
}

/// Modes of which one interface sticks.
fn held(modes: &[Mode], i: usize) -> Vec<Mode> {
    let mut modes = modes.to_vec();
    modes[i] = Mode::Stick;
    modes
}

impl Judge<'_> {
    /// Judges all decisions at knots.
    pub(super) fn decide(&mut self) {
        let mut changes = Vec::new();
        let before = self.modes_at_start();
        if before != self.h.modes(0) {
            changes.push(self.change(0, before));
        }
        for k in 1..self.h.len() {
            let before = self.h.modes(k - 1);
            if self.strikes(k) {
                self.impact(k);
            } else if before != self.h.modes(k) {
                changes.push(self.change(k, before.to_vec()));
            }
        }
        self.ask(&mut changes);
        for change in &changes {
            self.changes(change);
            self.releases(change);
        }
    }

    /// What is to be asked at a knot.
    fn change(&self, knot: usize, before: Vec<Mode>) -> Change {
        let mut loads: Vec<Load> = Vec::with_capacity(4);
        for load in self.ground.instant(self.h.time_s[knot]) {
            if !loads.contains(&load) {
                loads.push(load);
            }
        }
        let after = self.h.modes(knot);
        let at_rest = self.at_rest(knot);
        let mut change =
            Change { knot, before: before.clone(), modes: Vec::new(), loads, forces: Vec::new() };
        for i in (0..after.len()).filter(|&i| before[i] != after[i]) {
            for others in [&before[..], after, &at_rest] {
                change.ask(held(others, i));
            }
        }
        let gone = gone(&before, after);
        if gone.len() > 1 {
            change.ask(before.clone());
            for &i in &gone {
                let mut modes = before.clone();
                modes[i] = after[i];
                change.ask(modes);
            }
        }
        change
    }

    /// Modes after a knot, of which what has no velocity sticks.
    fn at_rest(&self, k: usize) -> Vec<Mode> {
        let one = |(i, mode): (usize, &Mode)| {
            let [_, v] = self.stored(k, self.structure.degree_of(i));
            if v == 0.0 { Mode::Stick } else { *mode }
        };
        self.h.modes(k).iter().enumerate().map(one).collect()
    }

    /// Finds the forces of all changes, eight at a time.
    fn ask(&self, changes: &mut [Change]) {
        let bench = self.bench();
        let mut work = Work::new(&bench, STOREYS);
        let mut group = Group::new(&bench);
        let all: Vec<(usize, usize, usize)> = changes
            .iter()
            .enumerate()
            .flat_map(|(c, change)| {
                let loads = change.loads.len();
                (0..change.modes.len()).flat_map(move |m| (0..loads).map(move |l| (c, m, l)))
            })
            .collect();
        for part in all.chunks(LANES) {
            for &(c, m, l) in part {
                let change = &changes[c];
                let feed = Feed::instant(change.loads[l]);
                group.push(&bench, &self.course(change.knot, &change.modes[m], feed));
            }
            group.fill();
            let (level, ground) = (self.level, &self.ground);
            dispatch!(level, simd => bench.instants(simd, &mut group, ground, &mut work));
            for (lane, &(c, _, _)) in part.iter().enumerate() {
                let mut forces =
                    vec![work.ends[0][FRICTION].0[lane], bench.block_mass(&group, lane)];
                let contents = 0..self.structure.contents.len();
                forces.extend(contents.map(|e| bench.acceleration(&work, e, lane)));
                changes[c].forces.push(forces);
            }
            group.count = 0;
        }
    }

    /// What an interface at rest is asked for by a demand or an acceleration of contents.
    pub(super) fn asked_in(
        &self,
        i: usize,
        value: f64,
        hold: [f64; 2],
        normal: f64,
    ) -> StickDemand {
        let Some(contents) = i.checked_sub(1).map(|e| &self.structure.contents[e]) else {
            let [low, high] = hold;
            let low = if low <= -UNBOUNDED { f64::NEG_INFINITY } else { low * normal };
            let high = if high >= UNBOUNDED { f64::INFINITY } else { high * normal };
            return StickDemand { demand: value, low, high };
        };
        let share = contents.mass_kg / self.structure.total_kg;
        let high = contents.static_friction * share * normal;
        StickDemand { demand: contents.mass_kg * value, low: -high, high }
    }

    /// What the rounding of times makes of what an interface at rest is asked for, less what holds it.
    pub(super) fn rounding(&self, i: usize, mass_kg: f64, load: &Load) -> f64 {
        let mu = match i.checked_sub(1).map(|e| &self.structure.contents[e]) {
            None => self.law.most(),
            Some(c) => c.static_friction * c.mass_kg / self.structure.total_kg,
        };
        load.rounding(self.ground.blur(), mass_kg, mu)
    }

    /// Mass of an interface's own body with what sticks to it at a knot.
    pub(super) fn stuck_mass(&self, k: usize, i: usize) -> f64 {
        let contents = &self.structure.contents;
        match i.checked_sub(1) {
            Some(e) => contents[e].mass_kg,
            None => contents.iter().zip(&self.h.modes(k)[1..]).fold(
                self.structure.block_kg,
                |sum, (contents, mode)| match mode {
                    Mode::Stick if contents.floor == 0 => sum + contents.mass_kg,
                    _ => sum,
                },
            ),
        }
    }

    /// What an interface held at rest is asked for at a change, with the rounding of it; `leans` where
    /// rigid stops hold too.
    fn asked(
        &self,
        change: &Change,
        modes: &[Mode],
        (i, leans): (usize, bool),
        load: &Load,
    ) -> (StickDemand, f64) {
        let forces = change.forces(modes, load);
        let of = |place: usize| forces.get(place).copied().unwrap_or(f64::NAN);
        let (value, mass_kg) = match i.checked_sub(1) {
            None => (of(0), of(1)),
            Some(e) => (of(2 + e), self.structure.contents[e].mass_kg),
        };
        let stored = self.h.surface_displacements(change.knot);
        let mut hold = match change.before[0] {
            Mode::Slip(slid) => self.law.hold(&self.law.off_ends(stored, slid)),
            Mode::Stick => self.law.hold(stored),
        };
        if leans {
            let [positive, negative] = self.law.leans(self.h.sliding_displacement_m[change.knot]);
            if positive {
                hold[0] = -UNBOUNDED;
            }
            if negative {
                hold[1] = UNBOUNDED;
            }
        }
        (self.asked_in(i, value, hold, load.normal), self.rounding(i, mass_kg, load))
    }

    /// Judges the changes of mode at a knot, at which what changes has no velocity.
    fn changes(&mut self, change: &Change) {
        let (k, before, after) = (change.knot, &change.before[..], self.h.modes(change.knot));
        let all = self.ground.instant(self.h.time_s[k]);
        let loads = of_side(&all, self.h.table_acceleration_m_per_s2[k]);
        let at_rest = self.at_rest(k);
        let time_s = self.h.time_s[k];
        for i in (0..after.len()).filter(|&i| before[i] != after[i]) {
            // The others may have changed before it or after it, or been held meanwhile.
            let (mut least, mut nearest) = (f64::INFINITY, f64::INFINITY);
            let mut margin = None;
            // What a jump passes on its way lets go too.
            let passed = if before[i] == Mode::Stick { &all[..] } else { &loads[..] };
            for load in passed {
                let others = [before, after, &at_rest];
                let alone = if after.len() == 1 { 1 } else { others.len() };
                for (place, others) in others.into_iter().take(alone).enumerate() {
                    // A bounce below the rounding of s turns back to the stop: that does not hold it.
                    let leans = after[i] == Mode::Stick;
                    let (asked, rounding) = self.asked(change, &held(others, i), (i, leans), load);
                    let beyond = match after[i] {
                        Mode::Stick => asked.beyond(),
                        Mode::Slip(Direction::Positive) => asked.demand - asked.low,
                        Mode::Slip(Direction::Negative) => asked.high - asked.demand,
                    };
                    let beyond = excess(beyond - rounding);
                    if place == 0 && beyond <= nearest {
                        nearest = beyond;
                        margin = asked.margin().map(|m| (m.abs(), rounding / asked.bound()));
                    }
                    least = least.min(beyond);
                }
            }
            // Distances that are not numbers leave no candidate.
            self.figures.excess = larger(self.figures.excess, least);
            if let (true, Some((margin, drift))) = (before[i] != Mode::Stick, margin) {
                if i == 0 {
                    self.totals.decided(margin, drift);
                }
                self.nearest(ClosestCall {
                    margin,
                    time_s,
                    kind: DecisionKind::Stop,
                    interface: i,
                });
            }
        }
        if before[0] != Mode::Stick
            && before[0] != after[0]
            && let Some(margin) = self.law.next_join(self.h.surface_displacements(k), before[0])
        {
            self.nearest(ClosestCall { margin, time_s, kind: DecisionKind::Join, interface: 0 });
        }
    }

    /// Interfaces that let go at one knot: a close call where one of them, had it let go first, would have
    /// held the other back. Along a jump each reaches its bound at a part of the way.
    fn releases(&mut self, change: &Change) {
        let (k, before, after) = (change.knot, &change.before, self.h.modes(change.knot));
        let gone = gone(before, after);
        if gone.len() < 2 {
            return;
        }
        let all = self.ground.instant(self.h.time_s[k]);
        let side = |table: f64| of_side(&all, table)[0];
        let to = side(self.h.table_acceleration_m_per_s2[k]);
        let from = match k.checked_sub(1).filter(|&j| self.h.time_s[j] == self.h.time_s[k]) {
            Some(j) => side(self.h.table_acceleration_m_per_s2[j]),
            None => all[0],
        };
        let jumps = (from.table, from.normal) != (to.table, to.normal);
        let at = |load: &Load, modes: &[Mode], i| self.asked(change, modes, (i, false), load).0;
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
            let mut modes = before.clone();
            modes[i] = after[i];
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
        for i in 0..self.structure.degrees() {
            let [[x0, v0], [x1, v1]] = [k - 1, k].map(|k| self.stored(k, i));
            self.figures.displacement[0] = larger(self.figures.displacement[0], x1 - x0);
            let on_block = i > n && self.structure.contents[i - 1 - n].floor == 0;
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
        0.5 * self.structure.block_kg * (before * before - after * after)
    }

    /// Turns of the block short of a rigid stop: how far, over the gap.
    pub(super) fn near_misses(&self) -> Vec<ClosestCall> {
        let h = self.h;
        let mut calls = Vec::new();
        for side in [Direction::Positive, Direction::Negative] {
            let Some(wall) = self.law.wall(side) else { continue };
            let gap_m = wall.abs();
            // Where the block came to a halt on its way there.
            let halts = (0..h.len().saturating_sub(1)).filter(|&k| {
                h.modes(k)[0] == Mode::Slip(side)
                    && h.modes(k + 1)[0] != Mode::Slip(side)
                    && h.sliding_velocity_m_per_s[k] == 0.0
            });
            let turns = halts.map(|k| (side.sign() * h.sliding_displacement_m[k], k));
            let turns = turns.filter(|(s, _)| *s < gap_m);
            if let Some((s, k)) = turns.reduce(|a, b| if b.0 > a.0 { b } else { a }) {
                let (margin, time_s) = (1.0 - s / gap_m, h.time_s[k]);
                calls.push(ClosestCall { margin, time_s, kind: DecisionKind::Miss, interface: 0 });
            }
        }
        calls
    }
}

/// Interfaces that let go.
fn gone(before: &[Mode], after: &[Mode]) -> Vec<usize> {
    (0..after.len()).filter(|&i| before[i] == Mode::Stick && after[i] != Mode::Stick).collect()
}
