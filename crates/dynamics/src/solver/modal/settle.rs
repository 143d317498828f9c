//! Settles the candidates for peaks: half by half of their samples, and by the Taylor series.
//!
//! A candidate of a batch is halved as long as the chord over a part of it leaves an output open, down to
//! single samples. Of those that are left the series of the highest bound of each output come first:
//! what they attain is mostly above the others.

use core::ops::Range;

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::chords::bound_between;
use super::super::ground::{Roughness, Stretch, largest_size};
use super::super::phase::Segment;
use super::super::tables::{Batch, PhaseTables};
use super::peaks::{Candidate, Extent};
use super::series::output_series;
use super::{Curvature, How, Modal};
use crate::linear::lanes::{Width, eight, greatest, larger};
use crate::linear::{BATCH, Force, Load, Window};
use crate::response::Mode;

/// Chords over two, four and eight samples.
const CHORDS: usize = 3;

/// Scratch for settling.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// The samples that may hold a peak, candidate by candidate.
    places: Vec<Place>,
    /// For each output the one of them with the largest bound.
    highest: Vec<usize>,
    /// A state.
    x: Vec<f64>,
    /// The states of a candidate's samples.
    states: Vec<f64>,
    /// Departures of the modes from the chords of a batch, and of a sample.
    departures: Vec<f64>,
    near_departures: Vec<f64>,
}

/// A sample of a candidate that may hold the peak of an output.
#[derive(Clone, Copy, Debug)]
struct Place {
    candidate: usize,
    sample: usize,
    output: usize,
    bound: f64,
}

/// A candidate of whole samples.
struct Samples<'a> {
    phase: &'a PhaseTables,
    batch: &'a Batch,
    a: &'a Window,
    force: Force<'a>,
    stop: f64,
    count: usize,
    curvature: Curvature,
    /// `h²/8` of a sample.
    near: f64,
    /// Whether its modes depart from chords each by itself.
    by_mode: bool,
}

impl Scratch {
    /// Makes it serve states of so many numbers.
    pub(super) fn serve(&mut self, stride: usize) {
        let lists = [
            (&mut self.x, stride),
            (&mut self.states, (BATCH + 1) * stride),
            (&mut self.departures, CHORDS * stride),
            (&mut self.near_departures, stride),
        ];
        for (list, count) in lists {
            list.clear();
            list.resize(count, 0.0);
        }
        self.places.clear();
    }

    /// Finds for each of so many outputs the place with the largest bound.
    fn find_highest(&mut self, outputs: usize) {
        self.highest.clear();
        self.highest.resize(outputs, usize::MAX);
        for (at, place) in self.places.iter().enumerate() {
            let highest = &mut self.highest[place.output];
            if self.places.get(*highest).is_none_or(|highest| place.bound > highest.bound) {
                *highest = at;
            }
        }
    }

    /// State at the `k`-th sample of a candidate, whose start is the first of the states; `known` has a
    /// bit for each that stands there.
    #[inline(always)]
    fn state<S: Simd>(
        &mut self,
        simd: S,
        known: &mut u32,
        samples: &Samples<'_>,
        k: usize,
        stride: usize,
    ) -> &[f64] {
        let Samples { batch, a, force, .. } = *samples;
        if *known & (1 << k) == 0 {
            let (start, later) = self.states.split_at_mut(stride);
            batch.maps.after(simd, k, start, a, force, &mut later[(k - 1) * stride..][..stride]);
            *known |= 1 << k;
        }
        &self.states[k * stride..][..stride]
    }
}

impl<'a> Modal<'a> {
    /// Settles all candidates that are still in question.
    #[inline(never)]
    pub(super) fn settle_peaks<S: Simd, W: Width>(&mut self, how: How<S, W>) {
        let simd = how.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                for i in 0..self.peaks.candidates.len() {
                    if self.peaks.in_question(simd, i) {
                        self.look_at_samples(how, i);
                    }
                }
                self.peaks.scratch.find_highest(self.peaks.outputs);
                for only_highest in [true, false] {
                    self.settle_places(how, only_highest);
                }
                self.peaks.scratch.places.clear();
                for i in 0..self.peaks.candidates.len() {
                    if let Extent::Segment(segment) = self.peaks.candidates[i].extent
                        && self.peaks.in_question(simd, i)
                    {
                        self.settle_segment(how, i, &segment);
                    }
                }
                self.peaks.forget_from(0);
                self.set_limits();
            },
        );
    }

    /// Looks at the outputs of a candidate at its samples as far as it must, and keeps the samples that may
    /// hold a peak.
    #[inline(always)]
    fn look_at_samples<S: Simd, W: Width>(&mut self, how: How<S, W>, i: usize) {
        let simd = how.simd;
        let Candidate { sample, extent, phase, stop, .. } = self.peaks.candidates[i];
        let phase = self.tables.phase(phase);
        let (Extent::Samples(count, curvature), Some(batch)) = (extent, phase.batch()) else {
            return;
        };
        let Some(a) = self.ground.acceleration[sample..].first_chunk() else { return };
        let force = self.candidate_force(i);
        let (groups, stride) = (self.peaks.peak.len(), 4 * how.width.fours());
        let near = 0.125 * batch.dt_s * batch.dt_s;
        let by_mode = how.width.modes() > 1 && phase.system.has_modes(phase.slip);
        let samples = Samples { phase, batch, a, force, stop, count, curvature, near, by_mode };
        let start = &self.peaks.states[i * stride..][..stride];
        self.peaks.scratch.states[..stride].copy_from_slice(start);
        if by_mode {
            let kinks = Roughness::new(simd, a).kinks * batch.per_dt;
            let impulse = largest_size(simd, a) * (BATCH as f64 * batch.dt_s);
            let load = [a[0], (a[1] - a[0]) * batch.per_dt];
            let reaches = [4.0 * near, 16.0 * near, 64.0 * near];
            let out = &mut self.peaks.scratch.departures;
            phase.system.departures(simd, start, load, [kinks, impulse], reaches, out);
        }
        let mut known = 1;
        for g in 0..groups {
            self.look_at_group(how, (i, g), &samples, &mut known);
        }
    }

    /// Looks at one group of outputs of a candidate at its samples.
    #[inline(always)]
    fn look_at_group<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        (i, g): (usize, usize),
        samples: &Samples<'_>,
        known: &mut u32,
    ) {
        let (simd, stride, at) = (how.simd, 4 * how.width.fours(), i * self.peaks.peak.len() + g);
        let whole = self.peaks.bounds[at].load(simd);
        let mut peak = self.peaks.peak[g].load(simd);
        let asked = whole.simd_gt(peak);
        if !asked.any_true() {
            return;
        }
        let Samples { phase, a, force, stop, count, curvature, near, by_mode, .. } = *samples;
        let (zero, group) = (eight(simd, 0.0), &phase.outputs.groups[g]);
        let near_slack = curvature.slack(simd, group, near);
        let near_bend = curvature.bend(simd, group) * eight(simd, 1.0 / BATCH as f64);
        let (mut by_modes, mut by_modes_known) = ([zero; CHORDS], 0_u32);
        let [first, last] = self.peaks.ends[at];
        let mut spans = [(0, 0, [zero; 2]); 4];
        spans[0] = (0, count, [first.load(simd), last.load(simd)]);
        let mut left = 1;
        while left > 0 {
            left -= 1;
            let (from, to, [first, last]) = spans[left & 3];
            // All samples together were open by this bound when they were kept.
            if by_mode || to - from < count || count == 1 {
                let length = (to - from) as f64;
                let mut slack = near_slack * eight(simd, length * length);
                if to > from + 1 {
                    slack += near_bend * eight(simd, length);
                }
                let attained = larger(first.abs(), last.abs());
                if !((attained + slack).simd_gt(peak) & asked).any_true() {
                    continue;
                }
                if to == from + 1 {
                    let own = self.sample_slack(how, samples, g, from);
                    slack = own.simd_lt(slack).select(own, slack);
                } else if by_mode {
                    // The shortest of the chords that is as long.
                    let chord = (to - from - 1).ilog2() as usize;
                    if by_modes_known & (1 << chord) == 0 {
                        let modes = phase.system.padded_modes();
                        let departures = &self.peaks.scratch.departures[chord * modes..][..modes];
                        by_modes[chord] = phase.outputs.of_amplitudes(simd, g, departures);
                        by_modes_known |= 1 << chord;
                    }
                    let own = by_modes[chord] + near_bend * eight(simd, length);
                    slack = own.simd_lt(slack).select(own, slack);
                }
                let bound = bound_between(simd, [first, last], slack);
                let bound = whole.simd_lt(bound).select(whole, bound);
                // A few ulp are no more than the rounding of the values.
                let open = bound.simd_gt(peak + peak * eight(simd, 1e-15)) & asked;
                if !open.any_true() {
                    continue;
                }
                if to == from + 1 {
                    let (bound, mut open) = (bound.to_array(), open.to_bitmask());
                    while open != 0 {
                        let lane = open.trailing_zeros() as usize;
                        let (output, bound) = (8 * g + lane, bound[lane]);
                        let place = Place { candidate: i, sample: from, output, bound };
                        self.peaks.scratch.places.push(place);
                        open &= open - 1;
                    }
                    continue;
                }
            }
            let middle = from + (to - from).next_power_of_two() / 2;
            let inputs = [force.at(middle), a[middle], stop];
            let x = self.peaks.scratch.state(simd, known, samples, middle, stride);
            let between = Self::group_at(simd, phase, g, x, inputs);
            let attained = between.abs();
            peak = (attained.simd_gt(peak) & asked).select(attained, peak);
            spans[left & 3] = (middle, to, [between, last]);
            spans[(left + 1) & 3] = (from, middle, [first, between]);
            left += 2;
        }
        peak.store_slice(&mut self.peaks.peak[g].0);
    }

    /// How far outputs of a group depart from the chord over the sample from the `k`-th, whose state is known.
    #[inline(always)]
    fn sample_slack<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        samples: &Samples<'_>,
        g: usize,
        k: usize,
    ) -> f64x8<S> {
        let (simd, stride) = (how.simd, 4 * how.width.fours());
        let Samples { phase, batch, a, force, near, by_mode, .. } = *samples;
        let (system, scratch) = (&phase.system, &mut self.peaks.scratch);
        let x = &scratch.states[k * stride..][..stride];
        let load = [a[k], (a[k + 1] - a[k]) * batch.per_dt];
        if by_mode {
            let impulse = greatest(a[k].abs(), a[k + 1].abs()) * batch.dt_s;
            let departures = &mut scratch.near_departures[..system.padded_modes()];
            system.departures(simd, x, load, [0.0, impulse], [near], departures);
            return phase.outputs.of_amplitudes(simd, g, departures);
        }
        let force = [force.at(k), (force.at(k + 1) - force.at(k)) * batch.per_dt];
        let [_, second] = Self::derivative_norms(how, phase, x, [load, force], &mut self.scratch);
        phase.outputs.groups[g].norm.load(simd) * eight(simd, second * batch.growth * near)
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

    /// Settles the samples that may hold a peak, or the highest of each output alone.
    #[inline(always)]
    fn settle_places<S: Simd, W: Width>(&mut self, how: How<S, W>, only_highest: bool) {
        let mut from = 0;
        while from < self.peaks.scratch.places.len() {
            let i = self.peaks.scratch.places[from].candidate;
            let mut to = from + 1;
            while self.peaks.scratch.places.get(to).is_some_and(|place| place.candidate == i) {
                to += 1;
            }
            for k in 0..BATCH {
                if (from..to).any(|at| self.is_due(at, k, only_highest)) {
                    self.settle_sample(how, (i, k), from..to, only_highest);
                }
            }
            from = to;
        }
    }

    /// Whether a place is one of a sample and may still hold a peak, and perhaps is the highest of its
    /// output.
    #[inline(always)]
    fn is_due(&self, at: usize, sample: usize, only_highest: bool) -> bool {
        let place = &self.peaks.scratch.places[at];
        place.sample == sample
            && place.bound > self.peaks.attained(place.output)
            && (!only_highest || self.peaks.scratch.highest[place.output] == at)
    }

    /// State at a sample of a candidate.
    #[inline(always)]
    fn state_of<S: Simd, W: Width>(
        &self,
        how: How<S, W>,
        i: usize,
        k: usize,
        batch: &Batch,
        x: &mut [f64],
    ) {
        let start = &self.peaks.states[i * x.len()..][..x.len()];
        let Some(a) = self.ground.acceleration[self.peaks.candidates[i].sample..].first_chunk()
        else {
            return;
        };
        if k == 0 {
            x.copy_from_slice(start);
        } else {
            batch.maps.after(how.simd, k, start, a, self.candidate_force(i), x);
        }
    }

    /// Settles those places of a candidate's `k`-th sample that are due, by as many series as a step has.
    #[inline(always)]
    fn settle_sample<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        (i, k): (usize, usize),
        places: Range<usize>,
        only_highest: bool,
    ) {
        let Candidate { sample, mode, phase, stop, .. } = self.peaks.candidates[i];
        let phase = self.tables.phase(phase);
        let Some(batch) = phase.batch() else { return };
        let mut x = core::mem::take(&mut self.peaks.scratch.x);
        self.state_of(how, i, k, batch, &mut x);
        let stretch = self.ground.stretch(sample + k, 0.0, batch.dt_s);
        let units = (batch.dt_s / phase.unit_s).round().max(1.0) as usize;
        for unit in 0..units {
            let from_s = unit as f64 * phase.unit_s;
            let unit_s = phase.unit_s;
            let segment = Segment { from_s, to_s: from_s + unit_s, unit_s, part: 1.0 };
            let load = self.expand_candidate(how, i, phase, (&stretch, &segment), &x);
            for at in places.clone() {
                if self.is_due(at, k, only_highest) {
                    let place = &mut self.peaks.scratch.places[at];
                    let j = place.output;
                    if unit + 1 == units {
                        place.bound = 0.0;
                    }
                    let p = output_series(how, phase, j, &self.series, &load, stop);
                    self.peaks.raise(j, &p, segment.part);
                }
            }
            if unit + 1 < units {
                let s = x[0];
                self.series.state_at(how.simd, 1.0, &mut x);
                if mode == Mode::Stick {
                    x[0] = s;
                }
            }
        }
        self.peaks.scratch.x = x;
    }

    /// Settles a candidate that is one segment by its series.
    #[inline(always)]
    fn settle_segment<S: Simd, W: Width>(&mut self, how: How<S, W>, i: usize, segment: &Segment) {
        let Candidate { sample, phase, stop, .. } = self.peaks.candidates[i];
        let phase = self.tables.phase(phase);
        let mut x = core::mem::take(&mut self.peaks.scratch.x);
        let stride = x.len();
        x.copy_from_slice(&self.peaks.states[i * stride..][..stride]);
        let stretch = self.ground.stretch(sample, segment.from_s, segment.to_s);
        let load = self.expand_candidate(how, i, phase, (&stretch, segment), &x);
        for j in 0..self.peaks.outputs {
            if self.peaks.asks(i, j) {
                let p = output_series(how, phase, j, &self.series, &load, stop);
                self.peaks.raise(j, &p, segment.part);
            }
        }
        self.peaks.scratch.x = x;
    }

    /// Expands a candidate's motion from `x` over one segment; its load, as the outputs take it.
    #[inline(always)]
    fn expand_candidate<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        i: usize,
        phase: &PhaseTables,
        (stretch, segment): (&Stretch, &Segment),
        x: &[f64],
    ) -> Load {
        let Candidate { mode, friction: coefficient, stop, .. } = self.peaks.candidates[i];
        let load = stretch.load(segment.from_s, segment.unit_s, coefficient);
        let mut with_stop = load;
        if mode != Mode::Stick {
            with_stop.force -= stop;
        }
        phase.solution.expand(how.simd, &phase.system, x, &with_stop, &mut self.series);
        load
    }
}
