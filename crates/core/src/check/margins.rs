//! Decisions within an interval: margins of what sticks, speeds of what slides.

use fearless_simd::prelude::*;
use fearless_simd::{dispatch, f64x8};

use super::collocation::{NODES, POINTS};
use super::equations::state_of;
use super::group::{Group, Step};
use super::knots::LaneJudge;
use super::lane::{Eight, Places, all, both, larger, smaller};
use super::outputs::FRICTION;
use super::path::{Pass, Work};
use crate::error::Stopped;

/// What the points of intervals say of a margin or a speed, one after another.
#[derive(Clone, Default)]
pub(super) struct Extremes {
    first: Eight,
    least: Eight,
    most: Eight,
    last: Eight,
    /// 1 where it has risen, and fallen.
    rises: Eight,
    falls: Eight,
}

/// What is told of the decisions of an interface in an interval: its margin in stick, its speed in slip.
#[derive(Clone, Copy, Default)]
pub(super) struct Watch<T> {
    /// At both ends.
    pub(super) ends: [T; 2],
    /// The least at any point, and what it cannot fall below in between where it is not monotone.
    pub(super) least: T,
    pub(super) low: T,
    /// Largest speed.
    pub(super) fastest: T,
}

/// The points of a step: `T` or the acceleration of contents in stick, the speed in the direction claimed
/// in slip, interface by interface; then `s` and `ṡ`.
pub(super) struct Points {
    pub(super) knot: usize,
    pub(super) step: Step,
    pub(super) values: Vec<[f64; POINTS]>,
}

impl Watch<Eight> {
    pub(super) fn lane(&self, lane: usize) -> Watch<f64> {
        Watch {
            ends: [self.ends[0].0[lane], self.ends[1].0[lane]],
            least: self.least.0[lane],
            low: self.low.0[lane],
            fastest: self.fastest.0[lane],
        }
    }
}

impl LaneJudge<'_> {
    /// Margins of what sticks and speeds of what slides at the points of a step.
    #[inline(always)]
    pub(super) fn watch<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        first: bool,
        work: &mut Work,
    ) {
        let (s, d) = (self.structure, self.structure.degrees());
        let asks = group.asks();
        let zero = all(simd, 0.0);
        for point in 0..POINTS {
            if point == 0 && !first {
                continue;
            }
            let end = if point == 0 { 0 } else { 1 };
            let is_node = (1..=NODES).contains(&point);
            if !is_node && asks {
                self.ask(simd, n, group, end, work);
            }
            let part = self.rule.points[point];
            let Work { input, path, bodies, ends, seen, .. } = &mut *work;
            let [from, to] = both!(|end| group.normal[end].load(simd));
            let normal = from + (to - from) * all(simd, part);
            for (i, seen) in seen.iter_mut().enumerate() {
                let at = s.degree_of(i);
                let (asked, speed) = if is_node {
                    let asked = path[(NODES + 2) * d + i * NODES + point - 1];
                    (asked, path[(point - 1) * d + at])
                } else {
                    let asked = if i == 0 { ends[end][FRICTION] } else { bodies[at] };
                    (asked, state_of(input, path, end, d + at, d))
                };
                let (stuck, sign) = match i.checked_sub(1) {
                    None => (group.stuck, group.sign),
                    Some(e) => (group.carried[e].stuck, group.carried[e].sign),
                };
                let mut value = sign.load(simd) * speed.load(simd);
                if stuck.0 != Eight::ZERO.0 {
                    let per_n = asked.load(simd) / normal;
                    let margin = match i.checked_sub(1) {
                        None => {
                            let [low, high] = both!(|i| group.hold[i].load(simd));
                            let below = (per_n - low) * group.scale[0].load(simd);
                            smaller((high - per_n) * group.scale[1].load(simd), below)
                        }
                        Some(e) => {
                            let fixed = s.contents[e].static_friction / s.total_kg;
                            all(simd, 1.0) - per_n.abs() * all(simd, 1.0 / fixed)
                        }
                    };
                    value = stuck.load(simd).simd_gt(zero).select(margin, value);
                }
                if point == 0 {
                    seen.start(value);
                } else {
                    seen.take(simd, value);
                }
            }
        }
    }

    /// The points of every step of a group.
    pub(super) fn points(
        &self,
        group: &mut Group,
        pass: &mut Pass<'_, '_>,
        out: &mut Vec<Points>,
    ) -> Result<(), Stopped> {
        dispatch!(self.level, simd => self.points_of(simd, group, pass, out))
    }

    #[inline(always)]
    fn points_of<S: Simd>(
        &self,
        simd: S,
        group: &mut Group,
        pass: &mut Pass<'_, '_>,
        out: &mut Vec<Points>,
    ) -> Result<(), Stopped> {
        let n = self.structure.masses_kg.len();
        let d = self.structure.degrees();
        let places = Places::new(group.knots);
        self.read(simd, n, &places, &mut pass.work.input);
        let mut first = true;
        while group.next(self, pass.ground) {
            pass.pulse.beat(32 * d as u32)?;
            self.load(simd, n, group, first, pass.work);
            self.solve(group, Some(&places), pass.work);
            first = false;
            let interfaces = 1 + self.structure.contents.len();
            let blank = [Eight::ZERO; POINTS];
            let mut rows = vec![blank; interfaces + 2];
            for end in 0..2 {
                let point = end * (POINTS - 1);
                self.ask(simd, n, group, end, pass.work);
                for (i, row) in rows[..interfaces].iter_mut().enumerate() {
                    let Work { input, path, bodies, .. } = &*pass.work;
                    let asked = if i == 0 {
                        pass.work.ends[end][FRICTION]
                    } else {
                        bodies[self.structure.degree_of(i)]
                    };
                    let speed = state_of(input, path, end, d + self.structure.degree_of(i), d);
                    row[point] = self.of_interface(simd, group, i, asked, speed);
                }
                let Work { input, path, .. } = &*pass.work;
                rows[interfaces][point] = state_of(input, path, end, 0, d);
                rows[interfaces + 1][point] = state_of(input, path, end, d, d);
            }
            for node in 0..NODES {
                let Work { path, trace, .. } = &*pass.work;
                for (i, row) in rows[..interfaces].iter_mut().enumerate() {
                    let asked = path[(NODES + 2) * d + i * NODES + node];
                    let speed = path[node * d + self.structure.degree_of(i)];
                    row[1 + node] = self.of_interface(simd, group, i, asked, speed);
                }
                rows[interfaces][1 + node] = trace[node * d];
                rows[interfaces + 1][1 + node] = path[node * d];
            }
            for lane in 0..group.count {
                let step = group.steps[lane];
                if step.step_s > 0.0 {
                    let values = rows.iter().map(|row| row.map(|point| point.0[lane])).collect();
                    out.push(Points { knot: group.knots[lane], step, values });
                }
            }
        }
        Ok(())
    }

    /// What is asked of an interface in stick, its speed in the direction claimed in slip.
    #[inline(always)]
    fn of_interface<S: Simd>(
        &self,
        simd: S,
        group: &Group,
        i: usize,
        asked: Eight,
        speed: Eight,
    ) -> Eight {
        let (stuck, sign) = match i.checked_sub(1) {
            None => (group.stuck, group.sign),
            Some(e) => (group.carried[e].stuck, group.carried[e].sign),
        };
        let speed = speed.load(simd) * sign.load(simd);
        let mut value = Eight::ZERO;
        let stuck = stuck.load(simd).simd_gt(all(simd, 0.0));
        value.store(stuck.select(asked.load(simd), speed));
        value
    }
}

impl Extremes {
    #[inline(always)]
    fn start<S: Simd>(&mut self, first: f64x8<S>) {
        for place in [&mut self.first, &mut self.least, &mut self.most, &mut self.last] {
            place.store(first);
        }
        (self.rises, self.falls) = (Eight::ZERO, Eight::ZERO);
    }

    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, value: f64x8<S>) {
        let (one, last) = (all(simd, 1.0), self.last.load(simd));
        self.least.store(smaller(self.least.load(simd), value));
        self.most.store(larger(self.most.load(simd), value));
        self.rises.store(value.simd_gt(last).select(one, self.rises.load(simd)));
        self.falls.store(value.simd_lt(last).select(one, self.falls.load(simd)));
        self.last.store(value);
    }

    /// The least, and what it cannot fall below in between.
    #[inline(always)]
    pub(super) fn tell<S: Simd>(&self, simd: S, told: &mut Watch<Eight>) {
        let least = self.least.load(simd);
        let range = self.most.load(simd) - least;
        let flat = range.simd_le(all(simd, 4e-12));
        // Between two points the polynomial falls below both by less than a tenth of its range.
        let low = (self.rises.load(simd) * self.falls.load(simd))
            .simd_gt(all(simd, 0.0))
            .select(least - range * all(simd, 0.1), all(simd, f64::INFINITY));
        told.low.store(flat.select(least, low));
        (told.least, told.ends) = (self.least, [self.first, self.last]);
    }
}
