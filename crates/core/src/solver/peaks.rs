//! Peaks of the tracked outputs: what has been attained, and where more may hide.
//!
//! While loads are linear `ẍ` has the energy norm of its start at most, so an output of dual norm `c`
//! departs from the chord between two of its values by no more than `c ‖ẍ‖ h²/8`. Where that may
//! exceed the peak attained so far the place is kept as a candidate; what is still in question at the
//! end, or when too many have gathered, is settled by the Taylor series.

use fearless_simd::prelude::*;

use super::event::{Segment, output_series};
use super::ground::Stretch;
use super::run::{Curvature, Run};
use super::tables::{Batch, Phase};
use crate::friction::Contact;
use crate::linear::lanes::{Eight, Width, eight, greatest, larger};
use crate::linear::polynomial::largest;
use crate::linear::{BATCH, Force, Window};
use crate::response::Mode;

/// Candidates that are kept before they are settled, besides one an output.
const ROOM: usize = 16;

/// Peaks attained, and the places that may hold more.
pub(super) struct Peaks {
    pub(super) peak: Vec<Eight>,
    /// Sizes that are no news: the peaks, or infinite where a size cannot grow.
    pub(super) limit: Vec<Eight>,
    candidates: Vec<Candidate>,
    /// What one is made from, and how many there may be.
    model: Candidate,
    room: usize,
    /// How many of them are in use.
    used: usize,
    outputs: usize,
}

/// A place that may hold a peak.
#[derive(Clone)]
struct Candidate {
    sample: usize,
    /// Whole samples, or a segment of one.
    segment: Option<Segment>,
    mode: Mode,
    contact: Contact,
    /// State at its start.
    x: Vec<f64>,
    /// Bounds on the outputs; zero where it cannot hold a peak.
    above: Vec<Eight>,
    /// For each output the samples of a batch that may hold the peak, as bits.
    samples: Vec<u8>,
}

impl Peaks {
    pub(super) fn new(groups: usize, outputs: usize, stride: usize) -> Self {
        let candidate = Candidate {
            sample: 0,
            segment: None,
            mode: Mode::Stick,
            contact: Contact::Free,
            x: vec![0.0; stride],
            above: vec![Eight::ZERO; groups],
            samples: vec![0; 8 * groups],
        };
        Self {
            peak: vec![Eight::ZERO; groups],
            limit: vec![Eight::ZERO; groups],
            candidates: Vec::new(),
            model: candidate,
            room: ROOM + outputs,
            used: 0,
            outputs,
        }
    }

    /// The peaks one by one.
    pub(super) fn attained(&self) -> Vec<f64> {
        self.peak.iter().flat_map(|peak| peak.0).take(self.outputs).collect()
    }

    fn in_question(&self, candidate: &Candidate) -> bool {
        let all = candidate.above.iter().zip(&self.peak);
        all.flat_map(|(above, peak)| above.0.into_iter().zip(peak.0)).any(|(a, p)| a > p)
    }

    fn drop_overtaken(&mut self) {
        let mut i = 0;
        while i < self.used {
            if self.in_question(&self.candidates[i]) {
                i += 1;
            } else {
                self.used -= 1;
                self.candidates.swap(i, self.used);
            }
        }
    }
}

impl<S: Simd, W: Width> Run<'_, S, W> {
    /// Looks at the segment that the last series has covered: `next` is its start, `x` its end.
    #[inline(always)]
    pub(super) fn look(&mut self, phase: &Phase, stretch: &Stretch, segment: &Segment) {
        let simd = self.simd;
        let d = self.width.components();
        let second = &self.series.order(2)[..d];
        // Twice the second coefficient is ẍ times the unit squared.
        let part = segment.part;
        let reach = 0.25 * phase.system.energy_norm(second) * (part * part);
        let coefficient = self.friction_of(self.mode, self.contact);
        let stop = self.stop_input(self.mode, self.contact, self.x[0]);
        let (from_s, to_s) = (segment.from_s, segment.to_s);
        let first =
            [coefficient * stretch.normal_at(from_s), stretch.acceleration_at(from_s), stop];
        let last = [coefficient * stretch.normal_at(to_s), stretch.acceleration_at(to_s), stop];
        if self.law.has_stop() {
            self.look_at_stop(part);
        }
        let reach_all = eight(simd, reach);
        let stride = 4 * self.width.fours();
        let mut news = false;
        for g in 0..self.groups(phase) {
            let a = Self::group_at(simd, phase, g, &self.next[..stride], first);
            let b = Self::group_at(simd, phase, g, &self.x[..stride], last);
            a.store_slice(&mut self.values[g].0);
            b.store_slice(&mut self.next_values[g].0);
            let slack = phase.outputs.norm[g].load(simd) * reach_all;
            let limit = self.peaks.limit[g].load(simd);
            news |= !(larger(a.abs(), b.abs()) + slack).simd_le(limit).all_true();
        }
        if news {
            self.look_closer(phase, stretch, segment, reach);
        }
    }

    #[inline(never)]
    fn look_closer(&mut self, phase: &Phase, stretch: &Stretch, segment: &Segment, reach: f64) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || self.look_at_ends(phase, stretch, segment, reach),
        );
    }

    #[inline(always)]
    fn look_at_ends(&mut self, phase: &Phase, stretch: &Stretch, segment: &Segment, reach: f64) {
        let simd = self.simd;
        let mut in_question = false;
        let mut above = core::mem::take(&mut self.next_values);
        for g in 0..phase.outputs.groups() {
            let (a, b) = (self.values[g].load(simd), above[g].load(simd));
            let slack = phase.outputs.norm[g].load(simd) * eight(simd, reach);
            let attained = larger(a.abs(), b.abs());
            let peak = larger(self.peaks.peak[g].load(simd), attained);
            peak.store_slice(&mut self.peaks.peak[g].0);
            // An extreme lies inside only where the ends are less than four times the slack apart:
            // |y| ≤ max + (slack − |Δ|/4)² / slack.
            let zero = eight(simd, 0.0);
            let inside = slack - (b - a).abs() * eight(simd, 0.25);
            let bulge = inside.simd_gt(zero).select(inside * (inside / slack), zero);
            let bound = attained + bulge;
            // A few ulp are no more than the rounding of the ends.
            let open = bound.simd_gt(peak + peak * eight(simd, 1e-15));
            open.select(bound, zero).store_slice(&mut above[g].0);
            in_question |= open.any_true();
        }
        self.next_values = above;
        self.set_limits();
        if in_question {
            let open = self.peaks.limit.iter().zip(&self.next_values);
            let news = open.flat_map(|(limit, above)| above.0.into_iter().zip(limit.0));
            if news.into_iter().any(|(above, limit)| above > limit) {
                self.keep(stretch.interval, Some(*segment), &[]);
            }
        }
    }

    /// Looks at the force of the stop in the last series.
    #[inline(never)]
    fn look_at_stop(&mut self, part: f64) {
        let mut force_n = self.law.stop_force_n(self.contact, self.x[0], self.x[1]);
        let (s, w) = (self.series.component(self.width, 0), self.series.component(self.width, 1));
        if let Some([of_s, of_w, constant]) = self.law.stop_row(self.contact) {
            let mut p = core::array::from_fn(|k| of_s * s[k] + of_w * w[k]);
            p[0] += constant;
            force_n = largest(&p, part, force_n);
        }
        let peak = &mut self.stopping.demands.peak_force_n;
        *peak = greatest(*peak, force_n);
    }

    /// Looks at the outputs of `open` over the first samples of a batch, by their rows; `near` is `h²/8`
    /// of a sample.
    #[inline(never)]
    pub(super) fn look_at_batch(
        &mut self,
        (phase, batch): (&Phase, &Batch),
        (sample, steps): (usize, usize),
        (a, force): (&Window, Force<'_>),
        curvature: &Curvature,
        near: f64,
    ) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                let stop = self.stop_input(self.mode, self.contact, self.x[0]);
                let mut kept = Vec::new();
                let mut news = false;
                let mut changed = false;
                for g in 0..self.groups(phase) {
                    let mut bits = self.open[g];
                    let mut above = Eight::ZERO;
                    let slacks = curvature.slack(simd, phase, g, near).to_array();
                    while bits != 0 {
                        let i = bits.trailing_zeros() as usize;
                        bits &= bits - 1;
                        let j = 8 * g + i;
                        if j >= self.peaks.outputs {
                            break;
                        }
                        let limit = self.peaks.limit[g].0[i];
                        if limit == f64::INFINITY {
                            continue;
                        }
                        let row = &phase.outputs.rows[j];
                        let constant = row.constant + row.of_stop * stop;
                        let stride = 4 * self.width.fours();
                        let values = batch.rows[j].values(simd, &self.x[..stride], a, force)
                            + eight(simd, constant);
                        let slack = slacks[i];
                        let sizes = values.abs();
                        let hits = sizes.simd_gt(eight(simd, limit - slack)).to_bitmask();
                        let first = self.values[g].0[i];
                        if hits & ((1 << steps) - 1) == 0 && first.abs() <= limit - slack {
                            continue;
                        }
                        let mut all = [first; BATCH + 1];
                        all[1..].copy_from_slice(&values.to_array());
                        let attained =
                            all[..=steps].iter().fold(limit, |peak, y| greatest(peak, y.abs()));
                        changed |= attained > limit;
                        self.peaks.peak[g].0[i] = greatest(self.peaks.peak[g].0[i], attained);
                        let (mask, bound) = samples_above(&all[..=steps], slack, attained);
                        if mask != 0 {
                            if kept.is_empty() {
                                kept.resize(8 * phase.outputs.groups(), 0);
                            }
                            above.0[i] = bound;
                            kept[j] = mask;
                            news = true;
                        }
                    }
                    self.next_values[g] = above;
                }
                if changed {
                    self.set_limits();
                }
                if news {
                    self.keep(sample, None, &kept);
                }
            },
        );
    }

    /// Keeps a candidate whose bounds stand in `next_values`: the segment that `next` is the start
    /// of, or whole samples from `x`.
    #[inline(never)]
    fn keep(&mut self, sample: usize, segment: Option<Segment>, samples: &[u8]) {
        let room = self.peaks.room;
        if self.peaks.used == room {
            self.peaks.drop_overtaken();
            if self.peaks.used > room / 2 {
                self.settle_peaks();
            }
        }
        let peaks = &mut self.peaks;
        if peaks.used == peaks.candidates.len() {
            peaks.candidates.push(peaks.model.clone());
        }
        let candidate = &mut peaks.candidates[peaks.used];
        peaks.used += 1;
        (candidate.sample, candidate.segment) = (sample, segment);
        (candidate.mode, candidate.contact) = (self.mode, self.contact);
        let start = if segment.is_some() { &self.next } else { &self.x };
        candidate.x.copy_from_slice(start);
        candidate.above.copy_from_slice(&self.next_values);
        candidate.samples[..samples.len()].copy_from_slice(samples);
    }

    /// Settles all candidates that are still in question.
    #[inline(never)]
    pub(super) fn settle_peaks(&mut self) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                self.peaks.drop_overtaken();
                let (used, mut candidates) =
                    (self.peaks.used, core::mem::take(&mut self.peaks.candidates));
                for candidate in &mut candidates[..used] {
                    if self.peaks.in_question(candidate) {
                        self.settle(candidate);
                    }
                }
                (self.peaks.used, self.peaks.candidates) = (0, candidates);
                self.set_limits();
            },
        );
    }

    #[inline(always)]
    fn settle(&mut self, candidate: &mut Candidate) {
        let (mode, contact) = (candidate.mode, candidate.contact);
        let phase = self.phase_of(mode, contact);
        if let Some(segment) = candidate.segment {
            let stretch = self.ground.stretch(candidate.sample, segment.from_s, segment.to_s);
            self.settle_segment(candidate, phase, &stretch, &segment, 1);
            return;
        }
        let Some(batch) = &phase.batch else { return };
        let open = |peaks: &Peaks, bit: u8| {
            let all = candidate.above.iter().zip(&peaks.peak).enumerate();
            all.flat_map(|(g, (above, peak))| {
                (0..8).map(move |i| (8 * g + i, above.0[i], peak.0[i]))
            })
            .any(|(j, above, peak)| above > peak && candidate.samples[j] & bit != 0)
        };
        let start = candidate.x.clone();
        let coefficient = self.friction_of(mode, contact);
        let force = match mode {
            Mode::Stick => Force::Constant(0.0),
            Mode::Slip(_) => self.batch_force(coefficient, candidate.sample),
        };
        let Some(a) = self.ground.acceleration[candidate.sample..].first_chunk() else { return };
        let unit_s = phase.unit_s;
        for k in 0..BATCH {
            let bit = 1 << k;
            if !open(&self.peaks, bit) {
                continue;
            }
            if k == 0 {
                candidate.x.copy_from_slice(&start);
            } else {
                batch.maps.after(self.simd, k, &start, a, force, &mut candidate.x);
            }
            let stretch = self.ground.stretch(candidate.sample + k, 0.0, batch.dt_s);
            let units = (batch.dt_s / unit_s).round().max(1.0);
            for unit in 0..units as usize {
                let from_s = unit as f64 * unit_s;
                let segment = Segment { from_s, to_s: from_s + unit_s, part: 1.0 };
                self.settle_segment(candidate, phase, &stretch, &segment, bit);
                let s = candidate.x[0];
                self.series.state_at(self.simd, 1.0, &mut candidate.x);
                if mode == Mode::Stick {
                    candidate.x[0] = s;
                }
            }
        }
    }

    /// Looks for the peaks of a candidate in one segment by the series of its outputs.
    #[inline(always)]
    fn settle_segment(
        &mut self,
        candidate: &Candidate,
        phase: &Phase,
        stretch: &Stretch,
        segment: &Segment,
        bit: u8,
    ) {
        let (mode, contact) = (candidate.mode, candidate.contact);
        let coefficient = self.friction_of(mode, contact);
        let mut load = self.load(phase, stretch, segment.from_s, coefficient);
        let friction = load.force;
        let stop = self.stop_input(mode, contact, candidate.x[0]);
        if mode != Mode::Stick {
            load.force -= stop;
        }
        Self::expand(self.simd, self.width, phase, &candidate.x, &load, &mut self.series);
        load.force = friction;
        for j in 0..self.peaks.outputs {
            let (g, i) = (j / 8, j % 8);
            let asked = candidate.segment.is_some() || candidate.samples[j] & bit != 0;
            let peak = self.peaks.peak[g].0[i];
            if !asked || candidate.above[g].0[i] <= peak {
                continue;
            }
            let p = output_series(self.width, phase, j, &self.series, &load, stop);
            let peak = largest(&p, segment.part, peak);
            self.peaks.peak[g].0[i] = largest(&p.map(|c| -c), segment.part, peak);
        }
    }
}

/// The samples between neighbouring values that may hold more than a peak, as bits, and the largest
/// of their bounds.
fn samples_above(values: &[f64], slack: f64, peak: f64) -> (u8, f64) {
    let (mut mask, mut most) = (0, 0.0);
    for (k, pair) in values.windows(2).enumerate() {
        let inside = slack - 0.25 * (pair[1] - pair[0]).abs();
        let bulge = if inside > 0.0 { inside * (inside / slack) } else { 0.0 };
        let bound = greatest(pair[0].abs(), pair[1].abs()) + bulge;
        // A few ulp are no more than the rounding of the values.
        if bound > peak + 1e-15 * peak {
            mask |= 1 << k;
            most = greatest(most, bound);
        }
    }
    (mask, most)
}
