//! All intervals: even ones by sweeps, the others and what may be near or a peak by their paths.

use super::super::collocation::{MAX_TURN, terms};
use super::super::judge::{Judge, Run, STILL};
use super::super::lane::LANES;
use super::super::law::{StickDemand, UNBOUNDED};
use super::Line;
use super::group::{Course, Group, Key};
use super::knots::{LaneJudge, Worst};
use super::maps::{Maps, Spread};
use super::sweep::{Even, EvenRun, Floors, Kind, MOST_STEPS};
use super::watch::{Watch, Watched};
use super::work::{Pass, Work};
use crate::error::Stopped;
use crate::numerics::instructions::vectorize;
use crate::response::output::{FRICTION, Output, SLIDER};
use crate::response::{Contact, Mode};
use crate::slider::Direction;

/// Most kinds of intervals that are judged by maps.
const MOST_KEYS: usize = 16;
/// Buckets of intervals by the power of two of their steps.
const BUCKETS: usize = 34;

impl<'a> Judge<'a, Line<'a>> {
    /// Judges all intervals eight at a time; looks for peaks where there may be some.
    pub(super) fn side_by_side(&mut self) -> Result<(), Stopped> {
        let (h, bench) = (self.h, self.bench());
        let mut worst = Worst::default();
        let mut work = Work::new(&bench, self.outputs.len());
        let mut kinds: Vec<Kind> = Vec::new();
        let (even, mut others) = self.even_runs(&mut kinds, &mut work);
        let floors = self.look_at_batches(&mut kinds);
        let mut pass = self.pass(&mut work, &mut worst);
        let to = (&mut pass, &mut others);
        let instructions = bench.instructions;
        vectorize!(instructions, simd => bench.sweep(simd, &even, &mut kinds, &floors, to))?;
        others.sort_unstable();
        others.dedup();
        #[cfg(test)]
        {
            self.axes.swept = even.iter().map(|run| run.count).sum();
        }
        let watch = vec![Watch::default(); others.len() * h.interfaces];
        let mut watched = Watched { knots: others, watch, ..Watched::default() };
        let mut rest: Vec<Option<Group>> = (0..BUCKETS).map(|_| None).collect();
        for place in 0..watched.knots.len() {
            let k = watched.knots[place];
            let length_s = h.time_s[k + 1] - h.time_s[k];
            let course = self.interval(k);
            let steps = course.feed.steps();
            let kind = self.kind_of(&course, &mut kinds, &mut work);
            let (group, how) = match kind.map(|i| &mut kinds[i]) {
                Some(kind) => {
                    let even = (length_s - self.axes.even_s).abs() <= 2.0 * self.instant_s;
                    match kind.maps.as_ref().filter(|_| even) {
                        Some(maps) => (&mut kind.mapped, (Some(maps), Some(&kind.spread))),
                        None => (&mut kind.odd, (None, Some(&kind.spread))),
                    }
                }
                None => {
                    let bucket = (usize::BITS - steps.leading_zeros()) as usize;
                    let bucket = if course.feed.is_single() { bucket } else { BUCKETS - 1 };
                    let group =
                        rest[bucket.min(BUCKETS - 1)].get_or_insert_with(|| Group::new(&bench));
                    (group, (None, None))
                }
            };
            if group.push(&bench, &course) {
                let mut pass = self.pass(&mut work, &mut worst);
                flush(&bench, group, how, &mut pass, &mut watched)?;
            }
        }
        let mut pass = self.pass(&mut work, &mut worst);
        for Kind { mapped, odd, maps, spread, .. } in &mut kinds {
            flush(&bench, mapped, (maps.as_ref(), Some(spread)), &mut pass, &mut watched)?;
            flush(&bench, odd, (None, Some(spread)), &mut pass, &mut watched)?;
        }
        for group in rest.iter_mut().flatten() {
            flush(&bench, group, (None, None), &mut pass, &mut watched)?;
        }
        worst.enter(&mut self.figures);
        self.drift = worst.drift.map(|drift| drift.largest());
        self.still = (STILL * worst.sliding.largest()).max(self.still);
        self.axes.watched = watched;
        Ok(())
    }

    /// Runs of even intervals that a sweep judges, and the intervals left.
    fn even_runs(
        &mut self,
        kinds: &mut Vec<Kind>,
        work: &mut Work,
    ) -> (Vec<EvenRun<'a>>, Vec<usize>) {
        let h = self.h;
        let (mut runs, mut others) = (Vec::new(), Vec::new());
        let step_s = [self.axes.even_s, 2.0 * self.instant_s];
        for place in 0..self.runs.len() {
            let Run { from, to } = self.runs[place];
            if from == to {
                continue;
            }
            let course = self.interval(from);
            let slips = course.modes[0] != Mode::Stick;
            let [low, high] = course.taken;
            let plain = match slips {
                true => self.law.series.is_none() && self.contact(from) == Contact::Free,
                false => low <= -UNBOUNDED && high >= UNBOUNDED,
            };
            let plain = plain && !self.law.is_pendulum();
            let mut knot = from;
            while knot < to {
                // How far the course goes: with friction by speed as far as its straight piece.
                let (mut part, mut end) = (Some(course), to);
                if slips && self.law.rate.is_some() {
                    part = self.in_piece(&course, knot);
                    let same = |k: &usize| {
                        let next = self.in_piece(&course, *k);
                        next.is_some() && next.map(|c| c.piece) == part.map(|c| c.piece)
                    };
                    end = knot + (knot..to).take_while(same).count();
                }
                let part = part.filter(|_| plain);
                let kind = part.and_then(|part| self.kind_of(&part, kinds, work));
                let kind = kind.filter(|&kind| kinds[kind].even.is_some());
                let (Some(kind), Some(course)) = (kind, part) else {
                    let end = end.max(knot + 1);
                    others.extend(knot..end);
                    knot = end;
                    continue;
                };
                while knot < end {
                    let (sample, count) = self.ground.even(&h.time_s[knot..=end], step_s);
                    if count > 0 {
                        runs.push(EvenRun { kind, course, knot, sample, count });
                        knot += count;
                    } else {
                        others.push(knot);
                        knot += 1;
                    }
                }
            }
        }
        (runs, others)
    }

    /// The kind of an interval whose path is a linear map of its inputs, made where there is room.
    fn kind_of(
        &self,
        course: &Course<'_>,
        kinds: &mut Vec<Kind>,
        work: &mut Work,
    ) -> Option<usize> {
        let key = self.key(course)?;
        let known = kinds.iter().position(|kind| kind.key == key);
        if known.is_none() && kinds.len() < MOST_KEYS {
            kinds.push(self.kind(key, course.feed.rate(), work));
            return Some(kinds.len() - 1);
        }
        known
    }

    /// What is known of the intervals of a key at a rate of the motion.
    fn kind(&self, key: Key, rate: f64, work: &mut Work) -> Kind {
        let bench = self.bench();
        let groups = || Group::new(&bench);
        let turn = rate * self.axes.even_s;
        let steps = if turn > MAX_TURN { libm::ceil(turn / MAX_TURN * (1.0 - 1e-9)) } else { 1.0 };
        let units = |length_s: f64, steps: usize, terms: usize, work: &mut Work| {
            bench.units((&key, self.outputs), (length_s, steps), terms, work)
        };
        if !self.axes.even_s.is_nan() && steps <= MOST_STEPS as f64 {
            let terms = terms(turn);
            let all = units(self.axes.even_s, steps as usize, terms, work);
            let even = Some(Even::new(&bench, &key, self.axes.even_s, terms, all.sums));
            let step = (steps > 1.0).then(|| units(self.axes.even_s / steps, 1, 0, work).maps);
            let (maps, spread) = (step.or(Some(all.maps)), all.spread);
            return Kind { key, even, mapped: groups(), odd: groups(), maps, spread };
        }
        let longest_s = if rate > 0.0 { MAX_TURN / rate } else { f64::INFINITY };
        let longest_s = longest_s.min(self.axes.longest_s / steps);
        let spread = units(longest_s, 1, 0, work).spread;
        let maps =
            (!self.axes.even_s.is_nan()).then(|| units(self.axes.even_s / steps, 1, 0, work).maps);
        Kind { key, even: None, mapped: groups(), odd: groups(), maps, spread }
    }

    /// Bounds the outputs of all kinds batch by batch; says what is near.
    fn look_at_batches(&self, kinds: &mut [Kind]) -> Floors {
        let (n, d, normal) = (self.h.storeys, self.axes.structure.degrees(), self.largest.0);
        let slope = self.model.slope_m_per_s2().abs();
        let load = self.law.most_sliding() * normal;
        let pulls = self.axes.structure.contents.iter().flat_map(|contents| {
            [contents.kinetic_friction / self.axes.structure.total_kg * normal; 2]
        });
        let pulls: Vec<f64> = pulls.collect();
        let mut fastest: Vec<f64> = (0..self.h.interfaces).map(|i| self.speed(i)).collect();
        let margin = self.axes.floor.max(0.0);
        let known = self.law.restitution().is_none() && self.law.series.is_none();
        for kind in kinds {
            let Some(even) = &mut kind.even else { continue };
            let batches = self.axes.knots.batches().map(|(outputs, sizes)| {
                let table = sizes[2 * d] + slope;
                let mut inputs = sizes[..2 * d].to_vec();
                let [forces, rates] = [0, n].map(|first| &sizes[2 * d + 1 + first..][..n]);
                inputs[1..=n].copy_from_slice(forces);
                inputs[d + 1..=d + n].copy_from_slice(rates);
                inputs.extend([table, table, load, load]);
                inputs.extend(&pulls);
                (outputs, inputs)
            });
            // What is held with a margin passes no peak of `T` that is as near to what holds at most. The
            // springs of surfaces in series add to that without limit.
            let held_n = (1.0 - margin) * self.law.most() * normal;
            let alike = self.axes.structure.spring == 0.0 && kind.key.push == [0.0; 2];
            let outputs = if alike { &[FRICTION, SLIDER][..] } else { &[FRICTION] };
            let holds = even.holds() && self.law.series.is_none();
            let settled = outputs.iter().filter(|&&g| holds && self.axes.attained[g] >= held_n);
            even.settle(settled);
            let (off, largest) = kind.spread.look(batches, &self.axes.attained);
            even.bound(&off);
            for (i, fastest) in fastest.iter_mut().enumerate() {
                *fastest = fastest.max(largest[self.place_of_speed(i)]);
            }
            if !known || kind.key.push != [0.0; 2] {
                kind.spread.forget();
            }
        }
        let ways = Direction::BOTH;
        let drops = (0..self.h.interfaces).map(|i| ways.iter().any(|way| self.drops(i, *way)));
        let drops: Vec<bool> = drops.collect();
        let speeds = fastest.iter().zip(&drops).map(|(fastest, drops)| match drops {
            true => (self.axes.floor * fastest).max(-self.still),
            false => -self.still,
        });
        Floors { margin, speeds: speeds.collect(), drops }
    }

    fn pass<'p>(&'p mut self, work: &'p mut Work, worst: &'p mut Worst) -> Pass<'p, 'a> {
        Pass {
            ground: &mut self.ground,
            outputs: self.outputs,
            attained: &mut self.axes.attained,
            books: &mut self.books,
            work,
            worst,
            pulse: &mut self.pulse,
        }
    }

    /// Looks at maxima of the demand at knots, beside the decisions already made: only what comes closer
    /// is worth a search between knots.
    pub(super) fn find_floor(&mut self) {
        let h = self.h;
        self.axes.floor = self.closest.map_or(f64::INFINITY, |call| call.margin);
        if self.ground.has_vertical() || self.law.series.is_some() {
            return;
        }
        let [low, high] = self.law.hold(&[]).map(|per_n| per_n * self.largest.0);
        let margin = |demand: f64| StickDemand { demand, low, high }.margin();
        let sticks = |run: &&Run| {
            let contact = h.contact.get(run.from);
            h.modes(run.from)[0] == Mode::Stick && contact.is_none_or(|c| *c == Contact::Free)
        };
        for run in self.runs.iter().filter(sticks) {
            for three in h.friction_force_n[run.from..=run.to].windows(3) {
                // A maximum of the demand, of this size or a larger one next to it.
                let [before, here, after] = [0, 1, 2].map(|i| margin(three[i]));
                if let (Some(before), Some(here), Some(after)) = (before, here, after)
                    && here <= before
                    && here <= after
                {
                    self.axes.floor = self.axes.floor.min(here.max(0.0) + 1e-9);
                }
            }
        }
    }

    /// The largest speed of an interface.
    pub(super) fn speed(&self, i: usize) -> f64 {
        self.axes.attained[self.place_of_speed(i)]
    }

    fn place_of_speed(&self, i: usize) -> usize {
        self.outputs.place(i.checked_sub(1).map_or(Output::Velocity, Output::ContentsVelocity))
    }

    /// Whether an interface could stick where it slides, without slowing down to it smoothly.
    pub(super) fn drops(&self, i: usize, direction: Direction) -> bool {
        match i.checked_sub(1).map(|e| &self.axes.structure.contents[e]) {
            None => self.law.drops(direction),
            Some(contents) => contents.static_friction > contents.kinetic_friction,
        }
    }

    /// Whether the points of an interval are needed: a decision may have been closer than any so far, or
    /// a law is broken.
    fn is_near(&self, k: usize, watch: &[Watch<f64>]) -> bool {
        let h = self.h;
        let contact = self.contact(k) != Contact::Free && h.modes(k)[0] != Mode::Stick;
        let near = |(i, (watch, mode)): (usize, (&Watch<f64>, &Mode))| match mode {
            Mode::Stick => !(watch.least >= 0.0) || watch.low < self.axes.floor,
            Mode::Slip(direction) => {
                let floor = self.axes.floor * self.speed(i);
                let wrong = !(watch.least.min(watch.low) >= -self.still);
                wrong || self.drops(i, *direction) && watch.low < floor
            }
        };
        contact || watch.iter().zip(h.modes(k)).enumerate().any(near)
    }

    /// The points of intervals in which a decision may have been close, in order of time.
    pub(super) fn look_again(&mut self) -> Result<(), Stopped> {
        let bench = self.bench();
        let mut found = Vec::new();
        let mut work = Work::new(&bench, self.outputs.len());
        let mut worst = Worst::default();
        let mut group = Group::new(&bench);
        let Watched { knots, watch, .. } = &self.axes.watched;
        let watch = watch.chunks_exact(self.h.interfaces);
        let near = knots.iter().zip(watch).filter(|(k, watch)| self.is_near(**k, watch));
        let near: Vec<usize> = near.map(|(k, _)| *k).collect();
        for eight in near.chunks(LANES) {
            for &k in eight {
                let course = self.interval(k);
                group.push(&bench, &course);
            }
            group.fill();
            let mut pass = self.pass(&mut work, &mut worst);
            bench.points(&mut group, &mut pass, &mut found)?;
            group.count = 0;
        }
        // Steps of one interval stand in their order.
        found.sort_by_key(|points| points.knot);
        self.axes.watched.points = found;
        Ok(())
    }
}

/// Judges a group and empties it.
fn flush(
    bench: &LaneJudge<'_>,
    group: &mut Group,
    how: (Option<&Maps>, Option<&Spread>),
    pass: &mut Pass<'_, '_>,
    watched: &mut Watched,
) -> Result<(), Stopped> {
    if group.count == 0 {
        return Ok(());
    }
    group.fill();
    bench.group(group, how, pass)?;
    let interfaces = pass.work.watch.len();
    for lane in 0..group.count {
        let place = watched.knots.binary_search(&group.knot(lane));
        if let Ok(place) = place {
            let own = &mut watched.watch[place * interfaces..][..interfaces];
            for (own, watch) in own.iter_mut().zip(&pass.work.watch) {
                *own = watch.lane(lane);
            }
        }
    }
    group.count = 0;
    Ok(())
}
