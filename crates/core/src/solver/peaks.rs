//! Peaks of the tracked outputs: what has been attained, and where more may hide.
//!
//! While loads are linear `ẍ` has the energy norm of its start at most, so an output of dual norm `c`
//! departs from the chord between two of its values by no more than `c ‖ẍ‖ h²/8`. Where that may
//! exceed the peak attained so far the place is kept as a candidate; what is still in question at the
//! end, or when too many have gathered, is settled sample by sample and by the Taylor series.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::event::{Segment, output_series};
use super::ground::Stretch;
use super::run::{Curvature, InForce, Run};
use super::tables::{Batch, Phase};
use crate::linear::lanes::{Eight, Width, eight, greatest, larger, largest_lane};
use crate::linear::polynomial::{Polynomial, curvature_bound, largest};
use crate::linear::{BATCH, Force};
use crate::response::Mode;

/// Candidates that are kept before they are settled, besides one an output.
const ROOM: usize = 512;

/// Numbers of the samples of a batch.
const SAMPLES: Eight = Eight([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);

/// Peaks attained, and the candidates for more.
#[derive(Debug, Default)]
pub(super) struct Peaks {
    pub(super) peak: Vec<Eight>,
    /// Sizes that are no news: the peaks, or infinite where a size cannot grow.
    pub(super) limit: Vec<Eight>,
    /// Bounds on the outputs in the place just weighed; zero where it cannot hold a peak.
    pub(super) above: Vec<Eight>,
    candidates: Vec<Candidate>,
    /// State at the start of each candidate, and its bounds.
    states: Vec<f64>,
    bounds: Vec<Eight>,
    outputs: usize,
    /// For each output of a candidate the samples that may hold its peak, as bits.
    samples: Vec<u8>,
    /// Room for a state.
    x: Vec<f64>,
}

/// A place that may hold a peak.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    sample: usize,
    extent: Extent,
    mode: Mode,
    /// Number of the phase.
    phase: usize,
    /// As in [`InForce`](super::run::InForce).
    friction: f64,
    stop: f64,
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
    /// Makes the room serve so many outputs of states of so many numbers, none attained.
    pub(super) fn serve(&mut self, groups: usize, outputs: usize, stride: usize) {
        for list in [&mut self.peak, &mut self.limit, &mut self.above] {
            list.clear();
            list.resize(groups, Eight::ZERO);
        }
        self.outputs = outputs;
        self.x.clear();
        self.x.resize(stride, 0.0);
        self.forget_from(0);
    }

    /// What an output has attained.
    pub(super) fn attained(&self, j: usize) -> f64 {
        self.peak[j / 8].0[j % 8]
    }

    /// Raises a peak to the largest size of an output over a part of its series.
    fn raise(&mut self, j: usize, p: &Polynomial, part: f64) {
        let peak = &mut self.peak[j / 8].0[j % 8];
        *peak = largest(&p.map(|c| -c), part, largest(p, part, *peak));
    }

    /// Whether the bounds of a candidate are above the peaks attained since.
    #[inline(always)]
    fn in_question<S: Simd>(&self, simd: S, i: usize) -> bool {
        let groups = self.peak.len();
        let above = &self.bounds[i * groups..][..groups];
        for g in 0..groups {
            if above[g].load(simd).simd_gt(self.peak[g].load(simd)).any_true() {
                return true;
            }
        }
        false
    }

    /// Whether an output may have its peak in one of the samples of a candidate.
    #[inline(always)]
    fn asks(&self, i: usize, j: usize, sample: u8) -> bool {
        let (g, lane) = (j / 8, j % 8);
        let first = i * self.peak.len();
        let bound = self.bounds[first + g].0[lane];
        self.samples[8 * first + j] & sample != 0 && bound > self.peak[g].0[lane]
    }

    /// Forgets the candidates that are not; the samples of all are still alike.
    fn drop_overtaken<S: Simd>(&mut self, simd: S) {
        let (groups, stride) = (self.peak.len(), self.x.len());
        let mut used = 0;
        for i in 0..self.candidates.len() {
            if self.in_question(simd, i) {
                self.candidates[used] = self.candidates[i];
                self.states.copy_within(i * stride..(i + 1) * stride, used * stride);
                self.bounds.copy_within(i * groups..(i + 1) * groups, used * groups);
                used += 1;
            }
        }
        self.forget_from(used);
    }

    fn forget_from(&mut self, used: usize) {
        self.candidates.truncate(used);
        self.states.truncate(used * self.x.len());
        self.bounds.truncate(used * self.peak.len());
        self.samples.truncate(8 * used * self.peak.len());
    }
}

impl<'a, S: Simd, W: Width> Run<'a, S, W> {
    /// Looks at the segment that the last series has covered: `next` is its start, `x` its end.
    #[inline(always)]
    pub(super) fn look(&mut self, phase: &Phase, stretch: &Stretch, segment: &Segment) {
        let simd = self.simd;
        let d = self.width.components();
        let second = &self.series.order(2)[..d];
        // Twice the second coefficient is ẍ times the unit squared.
        let part = segment.part;
        let (norm, bend) = if self.now.fading.is_some() {
            (0.5 * self.series.second_bound(), curvature_bound(&self.series.fade))
        } else {
            (phase.growth * phase.system.energy_norm(second), 0.0)
        };
        let reach = eight(simd, 0.25 * norm * (part * part));
        let bend = eight(simd, 0.125 * bend * (part * part));
        let stop = self.now.stop;
        let input = |at_s: f64, w: f64| {
            let friction_n = self.now.friction_n(stretch.normal_at(at_s), w);
            [friction_n, stretch.acceleration_at(at_s), stop]
        };
        let (first, last) = (input(segment.from_s, self.next[1]), input(segment.to_s, self.x[1]));
        if self.slider.law.stop.is_some() {
            self.look_at_stop(part);
        }
        let stride = 4 * self.width.fours();
        let mut open = false;
        for g in 0..self.groups(phase) {
            let a = Self::group_at(simd, phase, g, &self.next[..stride], first);
            let b = Self::group_at(simd, phase, g, &self.x[..stride], last);
            let group = &phase.outputs.groups[g];
            let slack = if self.now.fading.is_none() {
                group.norm.load(simd) * reach
            } else {
                group.norm.load(simd) * reach + group.size_of_friction.load(simd) * bend
            };
            open |= self.weigh(g, [a, b], slack, None);
        }
        if open && self.now.fading.is_some() {
            self.settle_fading(phase, stretch, segment);
        } else if open {
            self.keep(stretch.interval, Extent::Segment(*segment), true);
        }
    }

    /// Looks for peaks in the last series, of friction that fades, in those outputs whose bounds in
    /// `above` leave one.
    #[inline(never)]
    fn settle_fading(&mut self, phase: &Phase, stretch: &Stretch, segment: &Segment) {
        let load = stretch.load(segment.from_s, segment.unit_s, self.now.friction);
        for j in 0..self.peaks.outputs {
            let (g, lane) = (j / 8, j % 8);
            if self.peaks.above[g].0[lane] <= self.peaks.peak[g].0[lane] {
                continue;
            }
            let mut p = output_series(self.width, phase, j, &self.series, &load, self.now.stop);
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
    pub(super) fn weigh(
        &mut self,
        g: usize,
        [a, b]: [f64x8<S>; 2],
        slack: f64x8<S>,
        most: Option<f64x8<S>>,
    ) -> bool {
        let simd = self.simd;
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
        // An extreme lies inside only where the ends are less than four times the slack apart:
        // |y| ≤ max + (slack − |Δ|/4)² / slack.
        let inside = slack - (b - a).abs() * eight(simd, 0.25);
        let bulge = inside.simd_gt(zero).select(inside * (inside / slack), zero);
        let bound = attained + bulge;
        let bound = most.map_or(bound, |most| most.simd_lt(bound).select(most, bound));
        // A few ulp are no more than the rounding of the values.
        let open = bound.simd_gt(limit + limit * eight(simd, 1e-15));
        open.select(bound, zero).store_slice(&mut self.peaks.above[g].0);
        open.any_true()
    }

    /// Looks at the force of the stop in the last series.
    #[inline(never)]
    fn look_at_stop(&mut self, part: f64) {
        let contact = self.slider.memory.contact;
        let mut force_n = self.slider.law.stop_force_n(contact, self.x[0], self.x[1]);
        if let Some(row) = self.slider.law.stop_row(contact) {
            let p = self.series.of_sliding(self.width, row);
            force_n = largest(&p, part, force_n);
        }
        let peak = &mut self.slider.stopping.demands.peak_force_n;
        *peak = greatest(*peak, force_n);
    }

    /// Keeps a candidate whose bounds stand in `above`; its start is `next` where the state has moved.
    #[inline(never)]
    pub(super) fn keep(&mut self, sample: usize, extent: Extent, moved: bool) {
        let room = ROOM + self.peaks.outputs;
        if self.peaks.candidates.len() == room {
            self.peaks.drop_overtaken(self.simd);
            if self.peaks.candidates.len() > room / 2 {
                self.settle_peaks();
            }
        }
        let InForce { mode, phase, friction, stop, .. } = self.now;
        let phase = phase.number;
        let peaks = &mut self.peaks;
        peaks.candidates.push(Candidate { sample, extent, mode, phase, friction, stop });
        peaks.states.extend_from_slice(if moved { &self.next } else { &self.x });
        peaks.bounds.extend_from_slice(&peaks.above);
        peaks.samples.resize(8 * peaks.bounds.len(), u8::MAX);
    }

    /// Settles all candidates that are still in question.
    #[inline(never)]
    pub(super) fn settle_peaks(&mut self) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                for i in 0..self.peaks.candidates.len() {
                    if self.peaks.in_question(simd, i) {
                        self.look_at_samples(i);
                    }
                }
                for i in 0..self.peaks.candidates.len() {
                    if self.peaks.in_question(simd, i) {
                        self.settle(i);
                    }
                }
                self.peaks.forget_from(0);
                self.set_limits();
            },
        );
    }

    /// Looks at the outputs of a candidate at its samples, and bounds them between.
    #[inline(always)]
    fn look_at_samples(&mut self, i: usize) {
        let simd = self.simd;
        let Candidate { sample, extent, phase, stop, .. } = self.peaks.candidates[i];
        let phase = self.tables.phase(phase);
        let (Extent::Samples(steps, curvature), Some(batch)) = (extent, &phase.batch) else {
            return;
        };
        let Some(a) = self.ground.acceleration[sample..].first_chunk() else { return };
        let force = self.candidate_force(i);
        let (groups, stride) = (self.peaks.peak.len(), 4 * self.width.fours());
        let x = &self.peaks.states[i * self.peaks.x.len()..][..stride];
        let near = 0.125 * batch.dt_s * batch.dt_s;
        for g in 0..groups {
            let bounds = self.peaks.bounds[i * groups + g];
            if bounds.load(simd).simd_le(self.peaks.peak[g].load(simd)).all_true() {
                continue;
            }
            let slack = curvature.slack(simd, &phase.outputs.groups[g], near).to_array();
            let first = Self::group_at(simd, phase, g, x, [force.at(0), a[0], stop]).to_array();
            for lane in 0..8 {
                let (j, peak) = (8 * g + lane, self.peaks.peak[g].0[lane]);
                if bounds.0[lane] <= peak {
                    continue;
                }
                let row = &phase.outputs.rows[j];
                let values = batch.rows[j].values(simd, x, a, force)
                    + eight(simd, row.constant + row.of_stop * stop);
                let (samples, bound, peak) =
                    samples_above(simd, (first[lane], values), steps, slack[lane], peak);
                self.peaks.peak[g].0[lane] = peak;
                self.peaks.samples[8 * i * groups + j] = samples;
                self.peaks.bounds[i * groups + g].0[lane] = bound;
            }
        }
    }

    /// Friction force over a candidate of whole samples.
    #[inline(always)]
    fn candidate_force(&self, i: usize) -> Force<'a> {
        let Candidate { sample, mode, friction, .. } = self.peaks.candidates[i];
        match mode {
            Mode::Stick => Force::Constant(0.0),
            Mode::Slip(_) => self.batch_force(friction, sample),
        }
    }

    /// Settles a candidate by the series of the segment, or of the samples, that may hold a peak.
    #[inline(always)]
    fn settle(&mut self, i: usize) {
        let Candidate { sample, extent, mode, phase, .. } = self.peaks.candidates[i];
        let phase = self.tables.phase(phase);
        let mut x = core::mem::take(&mut self.peaks.x);
        let stride = x.len();
        x.copy_from_slice(&self.peaks.states[i * stride..][..stride]);
        match (extent, &phase.batch) {
            (Extent::Segment(segment), _) => {
                let stretch = self.ground.stretch(sample, segment.from_s, segment.to_s);
                self.settle_segment((i, u8::MAX), phase, (&stretch, &segment), &x);
            }
            (Extent::Samples(steps, _), Some(batch)) => {
                for k in 0..steps {
                    if (0..self.peaks.outputs).any(|j| self.peaks.asks(i, j, 1 << k)) {
                        self.state_of(i, k, batch, &mut x);
                        self.settle_sample((i, k), (phase, batch), mode, &mut x);
                    }
                }
            }
            _ => {}
        }
        self.peaks.x = x;
    }

    /// State at a sample of a candidate.
    #[inline(always)]
    fn state_of(&self, i: usize, k: usize, batch: &Batch, x: &mut [f64]) {
        let start = &self.peaks.states[i * x.len()..][..x.len()];
        let Some(a) = self.ground.acceleration[self.peaks.candidates[i].sample..].first_chunk()
        else {
            return;
        };
        if k == 0 {
            x.copy_from_slice(start);
        } else {
            batch.maps.after(self.simd, k, start, a, self.candidate_force(i), x);
        }
    }

    /// Settles the sample after the `k`-th of a candidate, by as many series as a step has.
    #[inline(always)]
    fn settle_sample(
        &mut self,
        (i, k): (usize, usize),
        (phase, batch): (&Phase, &Batch),
        mode: Mode,
        x: &mut [f64],
    ) {
        let stretch = self.ground.stretch(self.peaks.candidates[i].sample + k, 0.0, batch.dt_s);
        let units = (batch.dt_s / phase.unit_s).round().max(1.0) as usize;
        for unit in 0..units {
            let from_s = unit as f64 * phase.unit_s;
            let unit_s = phase.unit_s;
            let segment = Segment { from_s, to_s: from_s + unit_s, unit_s, part: 1.0 };
            self.settle_segment((i, 1 << k), phase, (&stretch, &segment), x);
            if unit + 1 < units {
                let s = x[0];
                self.series.state_at(self.simd, 1.0, x);
                if mode == Mode::Stick {
                    x[0] = s;
                }
            }
        }
    }

    /// Looks for the peaks of a candidate in one segment from `x` by the series of those outputs that
    /// have one of the bits.
    #[inline(always)]
    fn settle_segment(
        &mut self,
        (i, bits): (usize, u8),
        phase: &Phase,
        (stretch, segment): (&Stretch, &Segment),
        x: &[f64],
    ) {
        let Candidate { mode, friction: coefficient, stop, .. } = self.peaks.candidates[i];
        let mut load = stretch.load(segment.from_s, segment.unit_s, coefficient);
        let friction = load.force;
        if mode != Mode::Stick {
            load.force -= stop;
        }
        Self::expand(self.simd, self.width, phase, x, &load, &mut self.series);
        load.force = friction;
        for j in 0..self.peaks.outputs {
            if self.peaks.asks(i, j, bits) {
                let p = output_series(self.width, phase, j, &self.series, &load, stop);
                self.peaks.raise(j, &p, segment.part);
            }
        }
    }
}

/// Of a batch's first samples, so many steps, those that may hold more than a peak, as bits, the largest
/// of their bounds, and the peak with the values themselves; from the first value and the eight after it.
#[inline(always)]
fn samples_above<S: Simd>(
    simd: S,
    (first, values): (f64, f64x8<S>),
    steps: usize,
    slack: f64,
    peak: f64,
) -> (u8, f64, f64) {
    let mut before = [first; BATCH];
    before[1..].copy_from_slice(&values.as_array()[..BATCH - 1]);
    let before = f64x8::load_array_ref(simd, &before);
    let (zero, taken) = (eight(simd, 0.0), SAMPLES.load(simd).simd_lt(eight(simd, steps as f64)));
    let ends = taken.select(larger(before.abs(), values.abs()), zero);
    let peak = greatest(peak, largest_lane(simd, ends));
    let inside = eight(simd, slack) - (values - before).abs() * eight(simd, 0.25);
    let bulge = inside * (inside / eight(simd, slack));
    let bound = ends + inside.simd_gt(zero).select(bulge, zero);
    // A few ulp are no more than the rounding of the values.
    let open = bound.simd_gt(eight(simd, peak + 1e-15 * peak)) & taken;
    let most = largest_lane(simd, open.select(bound, zero));
    let open = open.to_bitmask();
    (open as u8, most, peak)
}
