//! Peaks of the tracked outputs: what has been attained, and where more may hide.
//!
//! While loads are linear `ẍ` has the energy norm of its start at most, so an output of dual norm `c`
//! departs from the chord between two of its values by no more than `c ‖ẍ‖ h²/8`. Where that may
//! exceed the peak attained so far the place is kept as a candidate; what is still in question at the
//! end, or when too many have gathered, is settled (`settle`).

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::chords::bound_between;
use super::super::course::WalkState;
use super::super::ground::Stretch;
use super::super::phase::Segment;
use super::series::output_series;
use super::settle::Scratch;
use super::{Curvature, How, InForce, Modal};
use crate::linear::lanes::{Eight, Width, eight, greatest, larger};
use crate::linear::polynomial::{Polynomial, curvature_bound, largest, raise_to_size};
use crate::response::Mode;

/// Candidates that are kept before they are settled, besides one an output.
const CANDIDATES: usize = 512;

/// Peaks attained, and the candidates for more.
#[derive(Debug, Default)]
pub(in crate::solver) struct Peaks {
    pub(super) peak: Vec<Eight>,
    /// Sizes that are no news: the peaks, or infinite where a size cannot grow.
    pub(super) limit: Vec<Eight>,
    /// Bounds on the outputs in the place just weighed; zero where it cannot hold a peak.
    pub(super) above: Vec<Eight>,
    /// The outputs at the ends of that place, where it can.
    between: Vec<[Eight; 2]>,
    pub(super) candidates: Vec<Candidate>,
    /// State at the start of each candidate, its bounds, and the outputs at its ends.
    pub(super) states: Vec<f64>,
    pub(super) bounds: Vec<Eight>,
    pub(super) ends: Vec<[Eight; 2]>,
    pub(super) outputs: usize,
    /// Numbers of a state.
    pub(super) stride: usize,
    pub(super) scratch: Scratch,
}

/// A place that may hold a peak.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) sample: usize,
    pub(super) extent: Extent,
    pub(super) mode: Mode,
    /// Number of the phase.
    pub(super) phase: usize,
    /// As in [`InForce`].
    pub(super) friction: f64,
    pub(super) stop: f64,
}

/// How far a candidate reaches.
#[derive(Clone, Copy, Debug)]
pub(super) enum Extent {
    /// A segment of one sample.
    Segment(Segment),
    /// So many samples of a batch.
    Samples(usize, Curvature),
}

impl Peaks {
    /// Makes them serve so many outputs of states of so many numbers, none attained.
    pub(super) fn serve(&mut self, groups: usize, outputs: usize, stride: usize) {
        for list in [&mut self.peak, &mut self.limit, &mut self.above] {
            list.clear();
            list.resize(groups, Eight::ZERO);
        }
        self.between.clear();
        self.between.resize(groups, [Eight::ZERO; 2]);
        self.outputs = outputs;
        self.stride = stride;
        self.scratch.serve(stride);
        self.forget_from(0);
    }

    /// What an output has attained.
    pub(in crate::solver) fn attained(&self, j: usize) -> f64 {
        self.peak[j / 8].0[j % 8]
    }

    /// Raises a peak to the largest size of an output over a part of its series.
    pub(super) fn raise(&mut self, j: usize, p: &Polynomial, part: f64) {
        raise_to_size(&mut self.peak[j / 8].0[j % 8], p, part);
    }

    /// Whether the bounds of a candidate are above the peaks attained since.
    #[inline(always)]
    pub(super) fn in_question<S: Simd>(&self, simd: S, i: usize) -> bool {
        let groups = self.peak.len();
        let above = &self.bounds[i * groups..][..groups];
        for g in 0..groups {
            if above[g].load(simd).simd_gt(self.peak[g].load(simd)).any_true() {
                return true;
            }
        }
        false
    }

    /// Whether an output may have its peak in a candidate.
    #[inline(always)]
    pub(super) fn asks(&self, i: usize, j: usize) -> bool {
        self.bounds[i * self.peak.len() + j / 8].0[j % 8] > self.attained(j)
    }

    /// Forgets the candidates that are not.
    fn drop_overtaken<S: Simd>(&mut self, simd: S) {
        let (groups, stride) = (self.peak.len(), self.stride);
        let mut used = 0;
        for i in 0..self.candidates.len() {
            if self.in_question(simd, i) {
                self.candidates[used] = self.candidates[i];
                self.states.copy_within(i * stride..(i + 1) * stride, used * stride);
                self.bounds.copy_within(i * groups..(i + 1) * groups, used * groups);
                self.ends.copy_within(i * groups..(i + 1) * groups, used * groups);
                used += 1;
            }
        }
        self.forget_from(used);
    }

    pub(super) fn forget_from(&mut self, used: usize) {
        self.candidates.truncate(used);
        self.states.truncate(used * self.stride);
        self.bounds.truncate(used * self.peak.len());
        self.ends.truncate(used * self.peak.len());
    }
}

impl<'a> Modal<'a> {
    /// Looks at a segment from `next` to `x`.
    #[inline(always)]
    pub(super) fn look_at_outputs<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        stretch: &Stretch,
        segment: &Segment,
    ) {
        let (simd, load) = (how.simd, self.motion.load);
        let phase = self.now.tables.get();
        // ‖ẍ‖ and the rate of what fades, times the unit squared.
        let part = segment.part;
        let (norm, bend) = if self.now.fading.is_some() {
            (self.series.second_bound(), curvature_bound(&self.series.fade))
        } else {
            let per_unit = 1.0 / segment.unit_s;
            let of_a = [load.acceleration, load.acceleration_change * per_unit];
            let of_force = [load.force, load.force_change * per_unit];
            let [_, second] =
                Self::derivative_norms(how, phase, &self.next, [of_a, of_force], &mut self.scratch);
            (phase.growth * second * (segment.unit_s * segment.unit_s), 0.0)
        };
        let reach = eight(simd, 0.125 * norm * (part * part));
        let bend = eight(simd, 0.125 * bend * (part * part));
        let stop = self.now.stop;
        let input = |at_s: f64, w: f64| {
            let friction_n = self.now.friction_n(stretch.normal_at(at_s), w);
            [friction_n, stretch.acceleration_at(at_s), stop]
        };
        let (first, last) = (input(segment.from_s, self.next[1]), input(segment.to_s, self.x[1]));
        let stride = 4 * how.width.fours();
        let mut open = false;
        for g in 0..phase.outputs.groups.len() {
            let a = Self::group_at(simd, phase, g, &self.next[..stride], first);
            let b = Self::group_at(simd, phase, g, &self.x[..stride], last);
            let group = &phase.outputs.groups[g];
            let slack = if self.now.fading.is_none() {
                group.norm.load(simd) * reach
            } else {
                group.norm.load(simd) * reach + group.size_of_friction.load(simd) * bend
            };
            open |= self.weigh(how, g, [a, b], slack, None);
        }
        if open && self.now.fading.is_some() {
            self.settle_fading(how, stretch, segment);
        } else if open {
            self.keep(how, stretch.interval, Extent::Segment(*segment), true);
        }
    }

    /// Looks for peaks in the last series, of friction that fades, in those outputs whose bounds in
    /// `above` leave one.
    #[inline(never)]
    fn settle_fading<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        stretch: &Stretch,
        segment: &Segment,
    ) {
        let phase = self.now.tables.get();
        let load = stretch.load(segment.from_s, segment.unit_s, self.now.friction);
        for j in 0..self.peaks.outputs {
            let (g, lane) = (j / 8, j % 8);
            if self.peaks.above[g].0[lane] <= self.peaks.peak[g].0[lane] {
                continue;
            }
            let mut p = output_series(how, phase, j, &self.series, &load, self.now.stop);
            for (p, fade) in p.iter_mut().zip(&self.series.fade) {
                *p += phase.outputs.rows[j].of_friction * fade;
            }
            self.peaks.raise(j, &p, segment.part);
        }
        self.set_limits();
    }

    /// Weighs the outputs of a group against their limits, from two values, how far they may depart
    /// from the chord between, and perhaps another bound. Leaves its bounds in `above`; whether one is
    /// above its limit.
    #[inline(always)]
    pub(super) fn weigh<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        g: usize,
        [a, b]: [f64x8<S>; 2],
        slack: f64x8<S>,
        most: Option<f64x8<S>>,
    ) -> bool {
        let simd = how.simd;
        let (zero, limit) = (eight(simd, 0.0), self.peaks.limit[g].load(simd));
        let attained = larger(a.abs(), b.abs());
        if (attained + slack).simd_le(limit).all_true() {
            self.peaks.above[g] = Eight::ZERO;
            return false;
        }
        let grown = attained.simd_gt(limit);
        let limit = grown.select(attained, limit);
        if grown.any_true() {
            let peak = grown.select(attained, self.peaks.peak[g].load(simd));
            peak.store_slice(&mut self.peaks.peak[g].0);
            self.set_limits();
        }
        let bound = bound_between(simd, [a, b], slack);
        let bound = most.map_or(bound, |most| most.simd_lt(bound).select(most, bound));
        // A few ulp are no more than the rounding of the values.
        let open = bound.simd_gt(limit + limit * eight(simd, 1e-15));
        open.select(bound, zero).store_slice(&mut self.peaks.above[g].0);
        let [first, last] = &mut self.peaks.between[g];
        a.store_slice(&mut first.0);
        b.store_slice(&mut last.0);
        open.any_true()
    }

    /// Looks at the force of the stop in `x` and, in slip, over a part of the series.
    #[inline(never)]
    pub(super) fn look_at_stop(&mut self, course: &mut WalkState<'a>, part: f64) {
        let InForce { mode, contact, .. } = self.now;
        let mut force_n = self.law.stop_force_n(contact, self.x[0], self.x[1]);
        if let (Some([of_s, of_w, constant]), Mode::Slip(_)) = (self.law.stop_row(contact), mode) {
            let (s, w) = (&self.motion.displacement, &self.motion.number);
            let mut p: Polynomial = core::array::from_fn(|k| of_s * s[k] + of_w * w[k]);
            p[0] += constant;
            force_n = largest(&p, part, force_n);
        }
        let peak = &mut course.slider.stopping.demands.peak_force_n;
        *peak = greatest(*peak, force_n);
    }

    /// Keeps a candidate whose bounds stand in `above`; its start is `next` where the state has moved.
    #[inline(never)]
    pub(super) fn keep<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        sample: usize,
        extent: Extent,
        moved: bool,
    ) {
        let capacity = CANDIDATES + self.peaks.outputs;
        if self.peaks.candidates.len() == capacity {
            self.peaks.drop_overtaken(how.simd);
            if self.peaks.candidates.len() > capacity / 2 {
                self.settle_peaks(how);
            }
        }
        let InForce { mode, tables, friction, stop, .. } = self.now;
        let phase = tables.number;
        let peaks = &mut self.peaks;
        peaks.candidates.push(Candidate { sample, extent, mode, phase, friction, stop });
        peaks.states.extend_from_slice(if moved { &self.next } else { &self.x });
        peaks.bounds.extend_from_slice(&peaks.above);
        peaks.ends.extend_from_slice(&peaks.between);
    }
}
