//! Screened propagation: evenly spaced samples eight at a time, as far as a bound shows that nothing
//! happens in them.
//!
//! A batch's end follows from its start by one map. Over a chord of length `H` a number of dual norm
//! `c` departs from the chord by no more than `c ‖ẍ‖ H²/8`, which shows for the whole batch, else
//! sample by sample, that the block slides on, or is held, and that no output passes its peak.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::chords::clear_steps;
use super::super::course::WalkState;
use super::super::ground::{Normal, largest_size};
use super::super::recorder::Knot;
use super::super::tables::{Batch, PhaseTables};
use super::peaks::Extent;
use super::{Curvature, How, InForce, Modal};
use crate::linear::lanes::{Eight, Width, eight, greatest, least};
use crate::linear::{BATCH, Force, QUIET, Window};
use crate::progress::Pulse;
use crate::response::{Mode, output};
use crate::slider::{Direction, Hold};

/// A chord over a sample is off by this part of what one over a batch is.
const PER_SAMPLE: f64 = 1.0 / (BATCH * BATCH) as f64;

/// What bounds outputs over samples of stick without looking at them, besides the amplitudes: `∫|a| dt`
/// and the size of the acceleration. Of the first group the bound is known.
struct Coarse<S: Simd> {
    impulse: f64,
    size: f64,
    first: f64x8<S>,
}

/// Groups of outputs of which something is known; a group beyond the last bit never is.
#[derive(Clone, Copy, Default)]
struct Known(u128);

impl Known {
    #[inline(always)]
    fn bit(group: usize) -> u128 {
        u32::try_from(group).ok().and_then(|group| 1_u128.checked_shl(group)).unwrap_or(0)
    }

    #[inline(always)]
    fn has(self, group: usize) -> bool {
        self.0 & Self::bit(group) != 0
    }

    #[inline(always)]
    fn note(&mut self, group: usize) {
        self.0 |= Self::bit(group);
    }
}

impl<'a> Modal<'a> {
    /// Takes samples up to the end of the evenly spaced ones; the first that the bounds leave open.
    #[inline(always)]
    pub(super) fn screened<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        (course, pulse): (&WalkState<'a>, &mut Pulse<'a>),
        sample: usize,
        end: usize,
    ) -> usize {
        let tables = self.now.tables.get();
        if course.block.start.is_some() || self.now.fading.is_some() || sample + BATCH > end {
            return sample;
        }
        let Some(batch) = tables.batch() else { return sample };
        match self.now.mode {
            Mode::Slip(_) if self.x[1] == 0.0 => sample,
            // Each is a function of its own, which compiles faster than both in one.
            Mode::Slip(direction) => how.simd.vectorize(
                #[inline(always)]
                || {
                    let of = (tables, batch);
                    self.screen_slip(how, (course, pulse), of, [sample, end], direction)
                },
            ),
            Mode::Stick => how.simd.vectorize(
                #[inline(always)]
                || self.screen_stick(how, (course, pulse), (tables, batch), [sample, end]),
            ),
        }
    }

    /// The accelerations that a batch from a sample touches.
    #[inline(always)]
    pub(super) fn window(&self, sample: usize) -> &'a Window {
        self.ground.acceleration[sample..].first_chunk().unwrap_or(&[0.0; BATCH + 1])
    }

    /// Takes samples of sliding.
    #[inline(always)]
    fn screen_slip<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        (course, pulse): (&WalkState<'a>, &mut Pulse<'a>),
        (phase, batch): (&'a PhaseTables, &'a Batch),
        [mut sample, end]: [usize; 2],
        direction: Direction,
    ) -> usize {
        let (simd, sign, stride) = (how.simd, direction.sign(), 4 * how.width.fours());
        let near = 0.125 * batch.dt_s * batch.dt_s;
        let far = (BATCH * BATCH) as f64 * near;
        let exits = self.exits;
        if exits.iter().flatten().any(|exit| exit.of_s != 0.0 && exit.of_w != 0.0) {
            return sample;
        }
        let varying = matches!(self.ground.normal, Normal::Varying(_));
        let coefficient = self.now.friction;
        let mut known = Known::default();
        while sample + BATCH <= end {
            if pulse.tick(self.units).is_err() {
                break;
            }
            if varying && !(self.ground.normal.least(simd, sample) > 0.0) {
                break;
            }
            let (a, force) = (self.window(sample), self.batch_force(coefficient, sample));
            batch.maps.after(simd, BATCH, &self.x[..stride], a, force, &mut self.next[..stride]);
            let (w, next_w) = (sign * self.x[1], sign * self.next[1]);
            let curvature = self.curvature(how, phase, coefficient, sample, batch);
            let slack = curvature.slack_over_batch(simd, &phase.outputs.groups[0], far);
            let hidden = slack.as_array()[output::VELOCITY];
            let mut steps = BATCH;
            let x = &self.x[..stride];
            if !(w > hidden && next_w > hidden) {
                let speed = batch.rows[output::VELOCITY].values(simd, x, a, force);
                let hidden = hidden * PER_SAMPLE;
                let clear = (eight(simd, sign) * speed).simd_gt(eight(simd, hidden)).to_bitmask();
                steps = clear_steps(clear, w > hidden);
            }
            for exit in exits.iter().flatten() {
                if exit.of_w != 0.0 {
                    let start = exit.value(0.0, self.x[1]);
                    if !(start > hidden && exit.value(0.0, self.next[1]) > hidden) {
                        let speed = batch.rows[output::VELOCITY].values(simd, x, a, force);
                        let value = speed * eight(simd, exit.of_w) + eight(simd, exit.constant);
                        let hidden = hidden * PER_SAMPLE;
                        let clear = value.simd_gt(eight(simd, hidden)).to_bitmask();
                        steps = steps.min(clear_steps(clear, start > hidden));
                    }
                    continue;
                }
                // s is monotone while the block slides: its value at a sample speaks for all before.
                if steps < BATCH || !(exit.value(self.next[0], self.next[1]) > 0.0) {
                    let s = batch.displacement.values(simd, x, a, force);
                    let value = s * eight(simd, exit.of_s) + eight(simd, exit.constant);
                    let clear = value.simd_gt(eight(simd, 0.0)).to_bitmask();
                    steps = steps.min(clear_steps(clear, true));
                }
            }
            if steps == 0 {
                break;
            }
            if steps < BATCH {
                batch.maps.after(simd, steps, x, a, force, &mut self.next[..stride]);
            }
            let inputs = [[force.at(0), a[0], 0.0], [force.at(steps), a[steps], 0.0]];
            let reach = (steps * steps) as f64 * near;
            let group = (slack, None, reach);
            self.look_over(
                how,
                (phase, None),
                (sample, steps, curvature),
                inputs,
                group,
                &mut known,
            );
            self.record_batch(how, course, batch, [sample, steps], (a, force));
            sample += steps;
            core::mem::swap(&mut self.x, &mut self.next);
            if steps < BATCH {
                break;
            }
        }
        sample
    }

    /// Takes samples of stick.
    #[inline(always)]
    fn screen_stick<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        (course, pulse): (&WalkState<'a>, &mut Pulse<'a>),
        (phase, batch): (&'a PhaseTables, &'a Batch),
        [mut sample, end]: [usize; 2],
    ) -> usize {
        let (simd, stride) = (how.simd, 4 * how.width.fours());
        let hold = self.hold;
        let stop = self.now.stop;
        let near = 0.125 * batch.dt_s * batch.dt_s;
        let far = (BATCH * BATCH) as f64 * near;
        let force = Force::Constant(0.0);
        let row = &phase.outputs.rows[output::FRICTION];
        let constant = row.of_stop * stop + row.constant;
        let mut known = Known::default();
        while sample + BATCH <= end {
            if pulse.tick(self.units).is_err() {
                break;
            }
            let a = self.window(sample);
            let normal = self.ground.normal.least(simd, sample);
            let count = self.amplitude_count(how, phase);
            let amplitudes = &mut self.amplitudes[..count];
            phase.system.amplitudes(simd, &self.x[..stride], amplitudes);
            let holds = hold.least_n(normal) - hold.force_n.abs();
            let size = largest_size(simd, a);
            let by_batch = self.coarse(how, phase, size, BATCH as f64 * batch.dt_s);
            if self.is_quiet(how, phase, &by_batch, stop, holds) {
                known = Known::default();
                let later = (1..QUIET / BATCH).map(|i| sample + i * BATCH);
                if sample + QUIET <= end
                    && matches!(self.ground.normal, Normal::Constant(_))
                    && let size = later
                        .fold(size, |size, i| greatest(size, largest_size(simd, self.window(i))))
                    && let coarse = self.coarse(how, phase, size, QUIET as f64 * batch.dt_s)
                    && self.is_quiet(how, phase, &coarse, stop, holds)
                {
                    self.take_quiet(how, course, batch, sample);
                    sample += QUIET;
                    continue;
                }
                let (x, next) = (&self.x[..stride], &mut self.next[..stride]);
                batch.maps.after(simd, BATCH, x, a, force, next);
                self.record_batch(how, course, batch, [sample, BATCH], (a, force));
                self.swap_in_stick();
                sample += BATCH;
                continue;
            }
            let (x, next) = (&self.x[..stride], &mut self.next[..stride]);
            batch.maps.after(simd, BATCH, x, a, force, next);
            let curvature = self.curvature(how, phase, 0.0, sample, batch);
            let slack = curvature.slack_over_batch(simd, &phase.outputs.groups[0], far);
            let [before, after] = [[0.0, a[0], stop], [0.0, a[BATCH], stop]];
            let y = self.outputs_known(how, phase, 0, before, &mut known);
            let mut next_y = Self::group_at(simd, phase, 0, &self.next[..stride], after);
            let [first, last] = [y, next_y].map(|y| y.as_array()[output::FRICTION]);
            let hidden = slack.as_array()[output::FRICTION];
            let steps = match self.ground.normal {
                Normal::Constant(normal)
                    if let [low, high] = hold.friction_n(normal)
                        && least(first, last) > low + hidden
                        && greatest(first, last) < high - hidden =>
                {
                    BATCH
                }
                normal => {
                    let hidden = curvature.slack(simd, &phase.outputs.groups[0], near);
                    let hidden = hidden.as_array()[output::FRICTION];
                    let x = &self.x[..stride];
                    let demand = batch.rows[output::FRICTION].values(simd, x, a, force)
                        + eight(simd, constant);
                    let normal = normal.values(simd, sample);
                    held_steps(simd, (demand, first), normal, &hold, hidden)
                }
            };
            if steps == 0 {
                break;
            }
            let after = [0.0, a[steps], stop];
            if steps < BATCH {
                let (x, next) = (&self.x[..stride], &mut self.next[..stride]);
                batch.maps.after(simd, steps, x, a, force, next);
                next_y = Self::group_at(simd, phase, 0, next, after);
            }
            let group = (slack, Some(next_y), (steps * steps) as f64 * near);
            let coarse = (how.width.modes() > 1).then_some(&by_batch);
            self.look_over(
                how,
                (phase, coarse),
                (sample, steps, curvature),
                [before, after],
                group,
                &mut known,
            );
            self.record_batch(how, course, batch, [sample, steps], (a, force));
            sample += steps;
            self.swap_in_stick();
            if steps < BATCH {
                break;
            }
        }
        sample
    }

    /// Looks at the outputs of samples from `x` to `next`: where neither a bound on the state nor the
    /// chord keeps them below their limits the samples are kept. Of the first group the slack over a whole
    /// batch is known and perhaps the outputs in `next`; `reach` is `h²/8` of all samples.
    #[inline(always)]
    fn look_over<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        (phase, coarse): (&PhaseTables, Option<&Coarse<S>>),
        (sample, steps, curvature): (usize, usize, Curvature),
        [first, last]: [[f64; 3]; 2],
        (slack, first_group, reach): (f64x8<S>, Option<f64x8<S>>, f64),
        known: &mut Known,
    ) {
        let (simd, stride) = (how.simd, 4 * how.width.fours());
        let (mut open, mut known_next) = (false, Known::default());
        for g in 0..phase.outputs.groups.len() {
            let most = coarse.map(|coarse| {
                let reach = if g == 0 { coarse.first } else { self.reach(how, phase, g, coarse) };
                self.most(how, phase, g, reach, first[2])
            });
            if most.is_some_and(|most| most.simd_le(self.peaks.limit[g].load(simd)).all_true()) {
                self.peaks.above[g] = Eight::ZERO;
                continue;
            }
            let y = self.outputs_known(how, phase, g, first, known);
            let next = match first_group {
                Some(next) if g == 0 => next,
                _ => Self::group_at(simd, phase, g, &self.next[..stride], last),
            };
            next.store_slice(&mut self.values[g].0);
            known_next.note(g);
            let slack = if g == 0 && steps == BATCH {
                slack
            } else {
                curvature.slack_over_batch(simd, &phase.outputs.groups[g], reach)
            };
            open |= self.weigh(how, g, [y, next], slack, most);
        }
        *known = known_next;
        if open {
            self.keep(how, sample, Extent::Samples(steps, curvature), false);
        }
    }

    /// Outputs of a group in `x`; `known` are those groups whose outputs stand in `values`.
    #[inline(always)]
    fn outputs_known<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        phase: &PhaseTables,
        g: usize,
        inputs: [f64; 3],
        known: &mut Known,
    ) -> f64x8<S> {
        if !known.has(g) {
            let x = &self.x[..4 * how.width.fours()];
            let y = Self::group_at(how.simd, phase, g, x, inputs);
            y.store_slice(&mut self.values[g].0);
            known.note(g);
            return y;
        }
        self.values[g].load(how.simd)
    }

    /// Bounds under an acceleration of a size over a length of time.
    #[inline(always)]
    fn coarse<S: Simd, W: Width>(
        &self,
        how: How<S, W>,
        phase: &PhaseTables,
        size: f64,
        length_s: f64,
    ) -> Coarse<S> {
        let first = eight(how.simd, 0.0);
        let mut coarse = Coarse { impulse: length_s * size, size, first };
        coarse.first = self.reach(how, phase, 0, &coarse);
        coarse
    }

    /// Bound on what state and loads do to the outputs of a group over that time.
    #[inline(always)]
    fn reach<S: Simd, W: Width>(
        &self,
        how: How<S, W>,
        phase: &PhaseTables,
        g: usize,
        coarse: &Coarse<S>,
    ) -> f64x8<S> {
        let (simd, group) = (how.simd, &phase.outputs.groups[g]);
        let amplitudes = &self.amplitudes[..self.amplitude_count(how, phase)];
        let reach = group.size_of_a.load(simd) * eight(simd, coarse.size)
            + group.of_impulse.load(simd) * eight(simd, coarse.impulse);
        reach + phase.outputs.of_amplitudes(simd, g, amplitudes)
    }

    /// Number of amplitudes that the outputs of a phase have factors of; those of one storey one.
    #[inline(always)]
    fn amplitude_count<S: Simd, W: Width>(&self, how: How<S, W>, phase: &PhaseTables) -> usize {
        if how.width.modes() == 1 { 1 } else { phase.outputs.amplitude_count }
    }

    /// Largest sizes that the outputs of a group may have, from their reach.
    #[inline(always)]
    fn most<S: Simd, W: Width>(
        &self,
        how: How<S, W>,
        phase: &PhaseTables,
        g: usize,
        reach: f64x8<S>,
        stop: f64,
    ) -> f64x8<S> {
        let (simd, group) = (how.simd, &phase.outputs.groups[g]);
        let constant = (group.constant.load(simd) + group.of_stop.load(simd) * eight(simd, stop))
            + group.of_s.load(simd) * eight(simd, self.x[0]);
        reach + constant.abs()
    }

    /// Whether in stick the demand changes by no more than `holds`, and no output passes its limit.
    #[inline(always)]
    fn is_quiet<S: Simd, W: Width>(
        &self,
        how: How<S, W>,
        phase: &PhaseTables,
        coarse: &Coarse<S>,
        stop: f64,
        holds: f64,
    ) -> bool {
        for g in 0..phase.outputs.groups.len() {
            let reach = if g == 0 { coarse.first } else { self.reach(how, phase, g, coarse) };
            if g == 0 && !(reach.as_array()[output::FRICTION] <= holds) {
                return false;
            }
            let most = self.most(how, phase, g, reach, stop);
            if !most.simd_le(self.peaks.limit[g].load(how.simd)).all_true() {
                return false;
            }
        }
        true
    }

    /// In stick the block stays where it is, to the last bit.
    #[inline(always)]
    fn swap_in_stick(&mut self) {
        (self.next[0], self.next[1]) = (self.x[0], 0.0);
        core::mem::swap(&mut self.x, &mut self.next);
    }

    /// Moves the state on over quiet stick.
    #[inline(always)]
    fn take_quiet<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        course: &WalkState<'a>,
        batch: &Batch,
        sample: usize,
    ) {
        if self.recorder.is_some() {
            let start = self.x.clone();
            for from in (sample..sample + QUIET).step_by(BATCH) {
                let a = self.window(from);
                let force = Force::Constant(0.0);
                self.record_batch(how, course, batch, [from, BATCH], (a, force));
                batch.maps.after(how.simd, BATCH, &self.x, a, force, &mut self.next);
                self.swap_in_stick();
            }
            self.x = start;
        }
        if let Some(a) = self.ground.acceleration[sample..].first_chunk() {
            let stride = 4 * how.width.fours();
            let (x, next) = (&self.x[..stride], &mut self.next[..stride]);
            batch.maps.after_quiet(how.simd, x, a, next);
            self.swap_in_stick();
        }
    }

    /// Records the samples of a batch as rows of the history, if one is wanted.
    #[inline(always)]
    fn record_batch<S: Simd, W: Width>(
        &mut self,
        how: How<S, W>,
        course: &WalkState<'a>,
        batch: &Batch,
        [sample, steps]: [usize; 2],
        (a, force): (&Window, Force<'_>),
    ) {
        let Some(recorder) = &mut self.recorder else { return };
        let InForce { mode, contact, tables, .. } = self.now;
        let samples = sample..sample + steps;
        let (times_s, table) = (&self.ground.times_s[samples.clone()], &self.ground.table[samples]);
        recorder.store_samples([times_s, table], mode, contact);
        let stride = 4 * how.width.fours();
        let mut x = core::mem::take(&mut recorder.state);
        x.clone_from(&self.x);
        for k in 0..steps {
            if k > 0 {
                batch.maps.after(how.simd, k, &self.x[..stride], a, force, &mut x[..stride]);
                if mode == Mode::Stick {
                    (x[0], x[1]) = (self.x[0], 0.0);
                }
            }
            let normal = self.ground.normal_at(sample + k).max(0.0);
            let [friction_n, force_n] = self.now.forces(&self.hold, normal, &x);
            let (time_s, table, acceleration, state) = (times_s[k], table[k], a[k], &x[..stride]);
            let knot =
                Knot { time_s, mode, contact, table, acceleration, state, friction_n, force_n };
            recorder.motion(&tables.system, &knot);
            recorder.surfaces(&course.slider, x[0]);
        }
        recorder.state = x;
    }
}

/// Samples of stick: the demand at the first and at the eight after it stays between its bounds.
#[inline(always)]
fn held_steps<S: Simd>(
    simd: S,
    (demand, first): (f64x8<S>, f64),
    (n, n0): (f64x8<S>, f64),
    hold: &Hold,
    hidden: f64,
) -> usize {
    let [low, high] = hold.friction_of_eight(simd, n);
    let clear = demand.simd_gt(low + eight(simd, hidden))
        & demand.simd_lt(high - eight(simd, hidden))
        & n.simd_gt(eight(simd, 0.0));
    let [low, high] = hold.friction_n(n0);
    let holds = n0 > 0.0 && first > low + hidden && first < high - hidden;
    clear_steps(clear.to_bitmask(), holds)
}
