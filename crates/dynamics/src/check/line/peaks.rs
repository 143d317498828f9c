//! Peaks of the outputs between knots.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::collocation::{NODES, POINTS};
use super::super::lane::{Eight, LANES, all, both, inlined, larger, smaller};
use super::super::law::UNBOUNDED;
use super::super::outputs::{Outputs, raise_size};
use super::super::structure::larger as greatest;
use super::group::Group;
use super::knots::LaneJudge;
use super::maps::{Maps, Spread};
use super::work::{Pass, Work};
use crate::numerics::instructions::vectorize;

/// All lanes.
const ALL: u64 = (1 << LANES) - 1;

impl LaneJudge<'_> {
    /// Raises the peaks by the paths of a step where some output may pass them.
    #[inline(always)]
    pub(super) fn peaks<S: Simd>(
        &self,
        simd: S,
        group: &Group,
        (maps, spread): (Option<&Maps>, Option<&Spread>),
        pass: &mut Pass<'_, '_>,
    ) {
        let leans = self.leans(simd, group);
        let loud = spread.map_or(u64::MAX, |spread| spread.loud(&group.knots));
        if leans == 0 && loud == 0 {
            return;
        }
        let passes = leans
            | match spread {
                Some(spread) if leans != ALL => self.passing(simd, group, (spread, loud), pass),
                _ => {
                    for end in 0..2 {
                        self.end((group, end), pass.outputs, pass.work);
                    }
                    ALL
                }
            };
        if passes == 0 {
            return;
        }
        let Pass { work, attained, outputs, .. } = pass;
        if let Some(maps) = maps {
            let Work { input, active, trace, .. } = &mut **work;
            maps.places.apply(simd, (input, active), trace);
        }
        self.trace(group, outputs, work);
        for (g, nodes) in work.values.chunks_exact(NODES).enumerate() {
            let ends = both!(|end| work.ends[end][g].load(simd));
            self.seek(simd, passes, ends, nodes, &mut attained[g]);
        }
    }

    /// In which lanes the outputs are not known from the knots: where the spring of a pendulum follows `N`
    /// or a rigid stop holds.
    #[inline(always)]
    fn leans<S: Simd>(&self, simd: S, group: &Group) -> u64 {
        if self.law.is_pendulum() {
            return ALL;
        } else if self.law.restitution().is_none() {
            return 0;
        }
        let [low, high] = both!(|i| group.taken[i].load(simd).abs());
        smaller(low, high).simd_lt(all(simd, UNBOUNDED)).to_bitmask()
    }

    /// In which lanes a loud output may pass its peak: by its values at the ends of a step, and how far it may
    /// leave the chord.
    #[inline(always)]
    pub(super) fn passing<S: Simd>(
        &self,
        simd: S,
        group: &Group,
        (spread, loud): (&Spread, u64),
        pass: &mut Pass<'_, '_>,
    ) -> u64 {
        let Pass { work, attained, outputs, .. } = pass;
        for end in 0..2 {
            self.end((group, end), outputs, work);
        }
        let share = group.step_s.load(simd) * all(simd, 1.0 / spread.longest_s);
        self.sizes(simd, work);
        // Of longer steps nothing is known.
        let mut passes = share.simd_gt(all(simd, 1.0 + 1e-9)).to_bitmask();
        for (g, bounds) in spread.leaving.iter().filter(|(g, _)| loud >> (g % 64) & 1 == 1) {
            let mut off = all(simd, 0.0);
            for &(input, bound) in bounds {
                off += all(simd, bound) * work.active[input].load(simd);
            }
            let [first, last] = both!(|end| work.ends[end][*g].load(simd).abs());
            let limit = all(simd, attained[*g] * (1.0 + 1e-12));
            passes |= (larger(first, last) + share * off).simd_gt(limit).to_bitmask();
        }
        passes
    }

    /// Outputs at the nodes of a step.
    pub(super) fn trace(&self, group: &Group, outputs: &Outputs, work: &mut Work) {
        vectorize!(self.instructions, simd => self.trace_of(simd, group, outputs, work));
    }

    #[inline(always)]
    fn trace_of<S: Simd>(&self, simd: S, group: &Group, outputs: &Outputs, work: &mut Work) {
        let (d, n) = (self.structure.degrees(), self.structure.masses_kg.len());
        let Work { input, path, bodies, trace: traced, values, .. } = work;
        for i in 0..NODES {
            let now = self.at(simd, group, input, self.rule.c[i]);
            let x = inlined!(|k: usize| traced[i * d + k].load(simd));
            let v = inlined!(|k: usize| path[i * d + k].load(simd));
            self.outputs(
                simd,
                n,
                (group, outputs, now),
                (x, v),
                input,
                bodies,
                inlined!(|g: usize, value: f64x8<S>| values[g * NODES + i].store(value)),
            );
        }
    }

    /// Raises a peak to the largest size of an output in the lanes that may pass it, from its values at the
    /// ends and the nodes.
    #[inline(always)]
    fn seek<S: Simd>(
        &self,
        simd: S,
        passes: u64,
        ends: [f64x8<S>; 2],
        nodes: &[Eight],
        peak: &mut f64,
    ) {
        let (mut least, mut most) = (smaller(ends[0], ends[1]), larger(ends[0], ends[1]));
        for node in nodes {
            let value = node.load(simd);
            (least, most) = (smaller(least, value), larger(most, value));
        }
        let size = larger(most.abs(), least.abs());
        let sizes = size.to_array();
        for lane in (0..LANES).filter(|lane| passes & (1 << lane) != 0) {
            *peak = greatest(*peak, sizes[lane]);
        }
        // Between two points the polynomial rises above both by less than a tenth of its range.
        let bound = size + (most - least) * all(simd, 0.1);
        let open = bound.simd_gt(all(simd, *peak * (1.0 + 1e-12))).to_bitmask() & passes;
        if open == 0 {
            return;
        }
        let (first, last) = (ends[0].to_array(), ends[1].to_array());
        for lane in (0..LANES).filter(|lane| open & (1 << lane) != 0) {
            let mut points = [0.0; POINTS];
            (points[0], points[POINTS - 1]) = (first[lane], last[lane]);
            for (point, node) in points[1..].iter_mut().zip(nodes) {
                *point = node.0[lane];
            }
            raise_size(self.rule, peak, &points, false);
        }
    }
}
