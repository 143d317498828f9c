//! Decisions within an interval: margins of what sticks, speeds of what slides.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::collocation::{NODES, POINTS};
use super::super::lane::{Eight, Places, all, both, smaller};
use super::equations::state_of;
use super::group::Group;
use super::knots::LaneJudge;
use super::watch::Points;
use super::work::{Pass, Work};
use crate::error::Stopped;
use crate::numerics::instructions::vectorize;
use crate::response::output::FRICTION;

impl LaneJudge<'_> {
    /// The margin of an interface that sticks, which is asked for from a least to a largest part of `N`.
    #[inline(always)]
    pub(super) fn margin<S: Simd>(
        &self,
        simd: S,
        i: usize,
        group: &Group,
        [least, most]: [f64x8<S>; 2],
    ) -> f64x8<S> {
        let [hold, scale] = match i.checked_sub(1).map(|e| &self.structure.contents[e]) {
            None => [both!(|k| group.hold[k].load(simd)), both!(|k| group.scale[k].load(simd))],
            Some(contents) => {
                let fixed = contents.static_friction / self.structure.total_kg;
                [[all(simd, -fixed), all(simd, fixed)], [all(simd, 1.0 / fixed); 2]]
            }
        };
        smaller((hold[1] - most) * scale[1], (least - hold[0]) * scale[0])
    }

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
            let [from, to] = both!(|end| group.normal[end].load(simd));
            let normal = from + (to - from) * all(simd, part);
            for i in 0..work.seen.len() {
                let [asked, speed] = self.at_point(i, point, work);
                let [stuck, sign] = group.interface(i);
                let mut value = sign.load(simd) * speed.load(simd);
                if stuck.0 != Eight::ZERO.0 {
                    let per_n = asked.load(simd) / normal;
                    let margin = self.margin(simd, i, group, [per_n; 2]);
                    value = stuck.load(simd).simd_gt(zero).select(margin, value);
                }
                if point == 0 {
                    work.seen[i].start(value);
                } else {
                    work.seen[i].take(simd, value);
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
        vectorize!(self.instructions, simd => self.points_of(simd, group, pass, out))
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
            for point in 0..POINTS {
                let node = point.checked_sub(1).filter(|node| *node < NODES);
                let end = usize::from(point > 0);
                if node.is_none() {
                    self.ask(simd, n, group, end, pass.work);
                }
                for (i, row) in rows[..interfaces].iter_mut().enumerate() {
                    let [asked, speed] = self.at_point(i, point, pass.work);
                    let [stuck, sign] = group.interface(i);
                    let speed = speed.load(simd) * sign.load(simd);
                    let sticks = stuck.load(simd).simd_gt(all(simd, 0.0));
                    row[point].store(sticks.select(asked.load(simd), speed));
                }
                let Work { input, path, trace, .. } = &*pass.work;
                [rows[interfaces][point], rows[interfaces + 1][point]] = match node {
                    Some(node) => [trace[node * d], path[node * d]],
                    None => both!(|i| state_of(input, path, end, i * d, d)),
                };
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

    /// What is asked of an interface at a point of a step of which the end was asked, and its speed.
    #[inline(always)]
    fn at_point(&self, i: usize, point: usize, work: &Work) -> [Eight; 2] {
        let (d, at) = (self.structure.degrees(), self.structure.degree_of(i));
        let Work { input, path, bodies, ends, .. } = work;
        if let Some(node) = point.checked_sub(1).filter(|node| *node < NODES) {
            return [path[(NODES + 2) * d + i * NODES + node], path[node * d + at]];
        }
        let end = usize::from(point > 0);
        let asked = if i == 0 { ends[end][FRICTION] } else { bodies[at] };
        [asked, state_of(input, path, end, d + at, d)]
    }
}
