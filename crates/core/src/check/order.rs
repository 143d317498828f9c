//! The knots in order of time: events, near decisions, sums.

use super::ClosestCall;
use super::collocation::{POINTS, Rule};
use super::energy::Books;
use super::ground::between;
use super::group::{Feed, Group};
use super::intervals::{Run, Watched};
use super::judge::Judge;
use super::margins::{Points, Watch};
use super::near::{Dips, dip};
use super::outputs::VELOCITY;
use super::path::Work;
use super::structure::{excess, larger};
use crate::response::{Contact, Mode};
use crate::slider::Direction;

impl Judge<'_> {
    /// Goes through the runs in order of time.
    pub(super) fn in_order(&mut self, books: &mut Books, watched: &Watched, near: &[Points]) {
        let h = self.h;
        let [s, w] = self.stored(0, 0);
        self.events.begin(h, &self.at_start, self.law.contact_at_start(s, w));
        for i in 0..h.interfaces {
            self.start_phase(0, i);
        }
        let watch = watched.watch.chunks_exact(h.interfaces);
        let mut watched = watched.knots.iter().copied().zip(watch).peekable();
        let mut near = near;
        let runs = core::mem::take(&mut self.runs);
        let mut arrived = None;
        for &Run { from, to } in &runs {
            let abreast = arrived != Some(from);
            if let Some(last) = arrived {
                self.join(from, last, books);
            }
            if from < to {
                self.add_up(from, to);
            } else if abreast {
                self.alone(from);
            }
            while let Some((k, watch)) = watched.next_if(|(k, _)| *k < to) {
                let count = near.iter().take_while(|points| points.knot == k).count();
                let (own, later) = near.split_at(count);
                near = later;
                self.recall(k, watch, own);
            }
            arrived = Some(to);
        }
        self.runs = runs;
        let last = h.len() - 1;
        for (i, mode) in h.modes(last).iter().enumerate() {
            self.close(i, *mode, last);
        }
        for call in self.near_misses() {
            self.nearest(call);
        }
    }

    /// Passes from the end of a run to the knot `k`, at which the next begins: the same, or one abreast.
    fn join(&mut self, k: usize, arrived: usize, books: &mut Books) {
        let h = self.h;
        let (before, after) = (h.modes(k - 1), h.modes(k));
        let abreast = arrived < k;
        let struck = abreast && self.strikes(k);
        if abreast {
            if !struck {
                for i in 0..self.structure.degrees() {
                    self.compare(k, i, self.stored(k - 1, i));
                }
            }
            let surfaces = h.surface_displacements(k).iter();
            for (a, b) in surfaces.zip(h.surface_displacements(k - 1)) {
                self.figures.displacement[0] = larger(self.figures.displacement[0], a - b);
            }
        }
        for i in 0..after.len() {
            if before[i] != after[i] {
                let [_, v] = self.stored(k, self.structure.degree_of(i));
                if !struck {
                    self.figures.velocity[0] = larger(self.figures.velocity[0], v);
                }
                self.close(i, before[i], arrived);
                self.start_phase(k, i);
            }
        }
        if struck {
            books.damping[k - 1] = self.lost_in_impact(k);
        }
        if struck || before != after || !h.contact.is_empty() {
            self.events.pass(h, k, struck);
        }
    }

    /// Adds up a run: what slides in it, and the paths.
    fn add_up(&mut self, from: usize, to: usize) {
        let h = self.h;
        let modes = h.modes(from);
        let leans = self.law.restitution().is_some()
            && self.law.leans(h.sliding_displacement_m[from]) != [false; 2];
        self.totals.add(modes, self.contact(from), h.time_s[to] - h.time_s[from], leans);
        for (i, _) in modes.iter().enumerate().filter(|(_, mode)| **mode != Mode::Stick) {
            let at = self.structure.degree_of(i);
            // Without contact a slip may turn back.
            for k in from..to {
                let [[start, _], [end, _]] = [k, k + 1].map(|k| self.stored(k, at));
                self.totals.interfaces[i].path_m += (end - start).abs();
            }
        }
        for k in if h.surfaces > 0 { from..to } else { 0..0 } {
            self.surfaces(k);
        }
    }

    /// Looks at the points of an interval where a decision may have been close.
    fn recall(&mut self, k: usize, watch: &[Watch<f64>], near: &[Points]) {
        let h = self.h;
        let (modes, times_s) = (h.modes(k), [h.time_s[k], h.time_s[k + 1]]);
        for (i, mode) in modes.iter().enumerate() {
            let watch = watch[i];
            if !near.is_empty() {
                self.dips[i].resume(times_s);
                match mode {
                    Mode::Stick => near.iter().for_each(|points| self.held(i, points)),
                    Mode::Slip(direction) => self.slid(i, *direction, near),
                }
                continue;
            }
            let least = self.dips[i].so_far();
            let floor = match mode {
                Mode::Stick => self.floor.min(least).max(0.0),
                Mode::Slip(direction) if self.drops(i, *direction) => {
                    (self.floor * self.speed(i)).min(least)
                }
                Mode::Slip(_) => f64::NEG_INFINITY,
            };
            let [first, last] = watch.ends;
            if first.min(last) < floor {
                self.dips[i].resume(times_s);
                self.dips[i].feed(times_s[0], first);
                self.dips[i].feed(times_s[1], last);
            }
            self.dips[i].see(watch.fastest);
        }
        if self.contact(k) != Contact::Free && modes[0] != Mode::Stick {
            self.against_stop(k, near);
        }
    }

    /// Judges surfaces in series from the knot `k` to the next.
    fn surfaces(&mut self, k: usize) {
        let h = self.h;
        let [from, to] = [k, k + 1].map(|k| h.surface_displacements(k));
        let Some(sliding) = self.sliding(k, h.modes(k)[0]) else {
            for (own, stored) in from.iter().zip(to) {
                self.figures.displacement[0] = larger(self.figures.displacement[0], own - stored);
            }
            return;
        };
        let moved = h.sliding_displacement_m[k + 1] - h.sliding_displacement_m[k];
        let own = sliding.displacements(from, moved);
        let fastest = self.attained[VELOCITY];
        for (own, stored) in own.iter().zip(to) {
            let off = (own - stored).abs() - self.instant_s * fastest - self.drift[0];
            self.figures.displacement[0] = larger(self.figures.displacement[0], excess(off));
        }
        let normal = self.ground.instant(h.time_s[k + 1])[0].normal;
        let broken = self.law.series_excess(&sliding, &own, moved);
        self.figures.excess = larger(self.figures.excess, excess(normal * broken));
        self.events.slides_on(h, k, sliding.active());
    }

    /// Judges an elastic stop that acts or is left at the points of an interval.
    fn against_stop(&mut self, k: usize, near: &[Points]) {
        for points in near {
            let [s, w] = [0, 1].map(|i| points.values[self.h.interfaces + i]);
            let fastest = w.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
            for (s, w) in s.into_iter().zip(w) {
                let broken = self.law.contact_excess(self.contact(k), (s, w), self.slack(fastest));
                self.figures.excess = larger(self.figures.excess, broken);
            }
        }
    }

    /// Judges a step of a stick from what is asked at its points.
    fn held(&mut self, i: usize, points: &Points) {
        let rule = Rule::get();
        let step = &points.step;
        let values = &points.values[i];
        let load = |t: f64| between(step.loads, t);
        let k = points.knot;
        let hold = self.course(k, self.h.modes(k), Feed::default()).hold;
        let mass_kg = self.stuck_mass(k, i);
        let rounding = self.rounding(i, mass_kg, &step.loads[0]);
        let mut margins = [f64::NAN; POINTS];
        for point in 0..POINTS {
            let normal = load(rule.points[point]).normal;
            let asked = self.asked_in(i, values[point], hold, normal);
            self.figures.excess = larger(self.figures.excess, excess(asked.beyond() - rounding));
            margins[point] = asked.margin().unwrap_or(f64::NAN);
        }
        if margins.iter().any(|m| m.is_nan()) {
            self.dips[i].interrupt();
            return;
        }
        let inner = dip(&margins);
        let flat = margins.iter().all(|m| (m - margins[0]).abs() <= 1e-12);
        for point in 0..POINTS {
            let (mut t, mut margin) = (rule.points[point], margins[point]);
            if inner == Some(point) {
                let cost = |t: f64, value: f64| {
                    self.asked_in(i, value, hold, load(t).normal).margin().unwrap_or(f64::INFINITY)
                };
                (t, margin) = rule.least(values, point, cost);
                let bound = self.asked_in(i, values[point], hold, load(t).normal).bound();
                self.figures.excess =
                    larger(self.figures.excess, excess(-margin * bound - rounding));
            }
            self.dips[i].feed(step.from_s + t * step.step_s, margin);
        }
        // A plateau near the bound is as close a call as a maximum, if it is no sliver of one.
        let long = step.step_s > 1e6 * self.instant_s;
        if flat && long && margins[0] < 1.0 {
            self.dips[i].take(step.from_s, margins[0]);
        }
    }

    /// Judges the steps of a slip from the speed, in the direction claimed, at their points.
    fn slid(&mut self, i: usize, direction: Direction, near: &[Points]) {
        let rule = Rule::get();
        let mut astray = [0.0; 2];
        let per_n = match i.checked_sub(1).map(|e| &self.structure.contents[e]) {
            None => self.law.wrong_way(),
            Some(contents) => {
                let mu = contents.kinetic_friction.max(0.5 * contents.static_friction);
                2.0 * mu * contents.mass_kg / self.structure.total_kg
            }
        };
        for points in near {
            let (step, speeds) = (&points.step, &points.values[i]);
            let inner = dip(speeds);
            for point in 0..POINTS {
                let (mut t, mut speed) = (rule.points[point], speeds[point]);
                if inner == Some(point) {
                    (t, speed) = rule.least(speeds, point, |_, speed| speed);
                }
                if speed < -self.still || speed.is_nan() {
                    let force = per_n * between(step.loads, t).normal;
                    astray = [larger(astray[0], speed), larger(astray[1], force)];
                }
                self.dips[i].feed(step.from_s + t * step.step_s, speed);
            }
        }
        // What the knot's own defect and the rounding of times explain is no sign.
        let (Some(first), Some(last)) = (near.first(), near.last()) else { return };
        let at = self.structure.degree_of(i);
        let k = first.knot;
        let [_, stored] = self.stored(k + 1, at);
        let defect = (direction.sign() * stored - last.values[i][POINTS - 1]).abs();
        let jerked = [k, k + 1].map(|k| self.acceleration(k, at).abs());
        let blur = defect + self.instant_s * jerked[0].max(jerked[1]);
        if astray[0] > self.still + blur {
            self.figures.excess = larger(self.figures.excess, astray[1]);
        }
    }

    /// `ẍ` of a degree from the accelerations stored at a knot.
    fn acceleration(&self, k: usize, degree: usize) -> f64 {
        let (h, n) = (self.h, self.h.storeys);
        let floor = |floor: usize| match floor {
            0 => h.block_acceleration_m_per_s2[k],
            i => h.storey_accelerations(k)[i - 1],
        };
        match degree {
            0 => floor(0) - h.table_acceleration_m_per_s2[k],
            i if i <= n => floor(i) - floor(0),
            i => {
                let e = i - 1 - n;
                h.contents_state(k, e)[2] - floor(self.structure.contents[e].floor)
            }
        }
    }

    /// Judges a knot at which no interval ends or begins by the load that suits it best.
    fn alone(&mut self, k: usize) {
        let h = self.h;
        let w = h.sliding_velocity_m_per_s[k];
        let per_n = match h.modes(k)[0] {
            Mode::Stick => None,
            Mode::Slip(direction) => Some(match self.sliding(k, h.modes(k)[0]) {
                Some(sliding) => -sliding.force(0.0),
                None => {
                    let factor =
                        self.law.rate.as_ref().map_or(1.0, |rate| rate.coefficient(w.abs()));
                    self.law.sliding_load(direction) * factor
                }
            }),
        };
        let (mut table, mut force) = (f64::INFINITY, f64::INFINITY);
        for load in self.ground.instant(h.time_s[k]) {
            let off = (load.table - h.table_acceleration_m_per_s2[k]).abs();
            table = table.min((off - self.instant_s * load.slope.abs()).max(0.0));
            let off =
                per_n.map_or(0.0, |per_n| (h.friction_force_n[k] - per_n * load.normal).abs());
            let rounding = self.law.most() * load.normal_rounding(self.ground.blur());
            force = force.min(excess(off - rounding));
        }
        self.figures.table[0] = larger(self.figures.table[0], table);
        self.figures.excess = larger(self.figures.excess, force);
        if k == 0 || k + 1 == h.len() {
            self.beside_jump(k);
        }
    }

    /// Raises the peaks by the outputs at the first or the last knot, where no interval tells those that
    /// are not stored.
    fn beside_jump(&mut self, k: usize) {
        let load = self.ground.instant(self.h.time_s[k])[if k == 0 { 1 } else { 2 }];
        let bench = self.bench();
        let mut work = Work::new(&bench, self.outputs.len());
        let mut group = Group::new(&bench);
        group.push(&bench, &self.course(k, self.h.modes(k), Feed::instant(load)));
        group.fill();
        bench.outputs_at(&mut group, (&self.ground, &self.outputs), &mut work);
        for (peak, value) in self.attained.iter_mut().zip(&work.ends[0]) {
            *peak = larger(*peak, value.0[0]);
        }
    }

    /// Keeps the least margin; rounding may leave one a little below 0.
    pub(super) fn nearest(&mut self, call: ClosestCall) {
        let call = ClosestCall { margin: call.margin.abs(), ..call };
        if self.closest.is_none_or(|closest| call.margin < closest.margin) {
            self.closest = Some(call);
        }
    }

    /// Begins a phase of an interface at a knot.
    fn start_phase(&mut self, k: usize, i: usize) {
        let slack = if self.h.modes(k)[i] == Mode::Stick { 1e-12 } else { self.still };
        (self.dips[i], self.since[i]) = (Dips::new(slack), k);
    }

    /// Ends a phase of an interface at a knot: its near decisions are known.
    fn close(&mut self, i: usize, mode: Mode, to: usize) {
        let call = match mode {
            Mode::Stick => self.dips[i].least(i),
            Mode::Slip(direction) if self.drops(i, direction) => {
                if self.dips[i].so_far() < f64::INFINITY {
                    let fastest = self.fastest(i, self.since[i], to);
                    self.dips[i].see(fastest);
                }
                self.dips[i].least_of_peak(i)
            }
            Mode::Slip(_) => None,
        };
        if let Some(call) = call {
            self.nearest(call);
        }
    }

    /// The largest speed of an interface at knots.
    fn fastest(&self, i: usize, from: usize, to: usize) -> f64 {
        let at = self.structure.degree_of(i);
        (from..=to).fold(0.0, |most, k| most.max(self.stored(k, at)[1].abs()))
    }
}
