//! Intervals in order of time: near decisions, paths, surfaces, stops.

use super::super::collocation::{POINTS, Rule};
use super::super::ground::between;
use super::super::judge::{Directions, Judge, Run};
use super::super::near::dip;
use super::super::structure::{excess, larger};
use super::Line;
use super::group::{Feed, Group};
use super::knots::rates_of;
use super::watch::{Points, Watch};
use super::work::Work;
use crate::response::output::VELOCITY;
use crate::response::{Contact, Mode};
use crate::slider::Direction;

impl<'a> Judge<'a, Line<'a>> {
    /// Adds up the paths of a run.
    pub(super) fn add_up(&mut self, Run { from, to }: Run) {
        let h = self.h;
        let modes = h.modes(from);
        for (i, _) in modes.iter().enumerate().filter(|(_, mode)| **mode != Mode::Stick) {
            let at = self.axes.structure.degree_of(i);
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

    /// Looks again at intervals that begin before a knot.
    pub(super) fn recall_until(&mut self, to: usize) {
        let mut watched = core::mem::take(&mut self.axes.watched);
        let interfaces = self.h.interfaces;
        while let Some(&k) = watched.knots.get(watched.recalled).filter(|k| **k < to) {
            let watch = &watched.watch[watched.recalled * interfaces..][..interfaces];
            let points = &watched.points[watched.looked_at..];
            let count = points.iter().take_while(|points| points.knot == k).count();
            self.recall(k, watch, &points[..count]);
            watched.recalled += 1;
            watched.looked_at += count;
        }
        self.axes.watched = watched;
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
                    Mode::Stick => near.iter().for_each(|points| self.stays(i, points)),
                    Mode::Slip(direction) => self.slid(i, *direction, near),
                }
                continue;
            }
            let least = self.dips[i].so_far();
            let floor = match mode {
                Mode::Stick => self.axes.floor.min(least).max(0.0),
                Mode::Slip(direction) if self.drops(i, *direction) => {
                    (self.axes.floor * self.speed(i)).min(least)
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
        let fastest = self.axes.attained[VELOCITY];
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
    fn stays(&mut self, i: usize, points: &Points) {
        let (k, step) = (points.knot, &points.step);
        let hold = self.course(k, self.h.modes(k), Feed::default()).hold;
        let rounding = self.rounding(i, self.stuck_mass(k, i), &step.loads[0]);
        self.held(i, (step.from_s, step.step_s), rounding, |judge, t| {
            let value = Rule::get().interpolate(&points.values[i], t);
            judge.asked_in(i, value, hold, between(step.loads, t).normal)
        });
    }

    /// Judges the steps of a slip from the speed, in the direction claimed, at their points.
    fn slid(&mut self, i: usize, direction: Direction, near: &[Points]) {
        let rule = Rule::get();
        let mut astray = [0.0; 2];
        let per_n = match i.checked_sub(1).map(|e| &self.axes.structure.contents[e]) {
            None => self.law.wrong_way(),
            Some(contents) => {
                let mu = contents.kinetic_friction.max(0.5 * contents.static_friction);
                2.0 * mu * contents.mass_kg / self.axes.structure.total_kg
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
        let at = self.axes.structure.degree_of(i);
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
        let rates = rates_of(self.h, self.axes.structure, self.h.storeys, degree);
        let [own, under] = rates.map(|(list, [stride, i])| list[k * stride + i]);
        own - under
    }

    /// Raises the peaks by the outputs at the first or the last knot, where no interval tells those that
    /// are not stored.
    pub(super) fn beside_jump(&mut self, k: usize) {
        let load = self.ground.instant(self.h.time_s[k])[if k == 0 { 1 } else { 2 }];
        let bench = self.bench();
        let mut work = Work::new(&bench, self.outputs.len());
        let mut group = Group::new(&bench);
        group.push(&bench, &self.course(k, self.h.modes(k), Feed::instant(load)));
        group.fill();
        bench.outputs_at(&mut group, (&self.ground, self.outputs), &mut work);
        for (peak, value) in self.axes.attained.iter_mut().zip(&work.ends[0]) {
            *peak = larger(*peak, value.0[0]);
        }
    }
}
