//! Screened propagation: evenly spaced samples eight at a time, as far as a bound shows that nothing
//! happens in them.
//!
//! A batch's end follows from its start by one map. Over a chord of length `H` a number of dual norm
//! `c` departs from the chord by no more than `c ‖ẍ‖ H²/8`, which shows for the whole batch, else
//! sample by sample, that the block slides on, or is held, and that no output passes its peak.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::ground::Normal;
use super::outputs::output;
use super::run::{Curvature, Run};
use super::tables::{Batch, Phase};
use crate::friction::Direction;
use crate::linear::lanes::{Width, dot, eight, larger, least};
use crate::linear::{BATCH, Force, QUIET, Window};
use crate::response::Mode;

/// A chord over a sample is off by this part of what one over a batch is.
const PER_SAMPLE: f64 = 1.0 / (BATCH * BATCH) as f64;

/// What bounds outputs over a batch without looking at it: the energy norm of the state, the size of
/// the acceleration and of the friction force.
struct Coarse {
    norm: f64,
    size: f64,
    friction: f64,
}

impl<'a, S: Simd, W: Width> Run<'a, S, W> {
    /// Takes samples up to the end of the evenly spaced ones; the first that the bounds leave open.
    #[inline(always)]
    pub(super) fn screened(&mut self, sample: usize, end: usize) -> usize {
        let phase = self.phase();
        let Some(batch) = &phase.batch else { return sample };
        if self.start.is_some() || sample + BATCH > end {
            return sample;
        }
        match self.mode {
            Mode::Slip(_) if self.x[1] == 0.0 => sample,
            Mode::Slip(direction) => self.slide((phase, batch), sample, end, direction),
            Mode::Stick => self.rest((phase, batch), sample, end),
        }
    }

    /// The accelerations that a batch from a sample touches.
    #[inline(always)]
    fn window(&self, sample: usize) -> &'a Window {
        self.ground.acceleration[sample..].first_chunk().unwrap_or(&[0.0; BATCH + 1])
    }

    /// Takes samples of sliding.
    #[inline(always)]
    fn slide(
        &mut self,
        (phase, batch): (&'a Phase, &'a Batch),
        mut sample: usize,
        end: usize,
        direction: Direction,
    ) -> usize {
        let (simd, sign, stride) = (self.simd, direction.sign(), 4 * self.width.fours());
        let near = 0.125 * batch.dt_s * batch.dt_s;
        let far = (BATCH * BATCH) as f64 * near;
        let exits = self.law.exits(self.contact, direction);
        if exits.iter().flatten().any(|exit| exit.level_m.is_none()) {
            return sample;
        }
        let varying = matches!(self.ground.normal, Normal::Varying(_));
        let coefficient = self.friction_of(self.mode, self.contact);
        let system = &phase.system;
        let batch_s = BATCH as f64 * batch.dt_s;
        while sample + BATCH <= end {
            if varying && !(self.ground.normal_range(sample)[0] > 0.0) {
                break;
            }
            let (a, force) = (self.window(sample), self.batch_force(coefficient, sample));
            batch.maps.after(simd, BATCH, &self.x[..stride], a, force, &mut self.next[..stride]);
            let x = &self.x[..stride];
            let (w, next_w) = (sign * x[1], sign * self.next[1]);
            let curvature = self.curvature(phase, coefficient, sample, batch.per_dt);
            let hidden = curvature.slack(simd, phase, 0, far).as_array()[output::VELOCITY];
            let mut steps = BATCH;
            let x = &self.x[..stride];
            if !(w > hidden && next_w > hidden) {
                let speed = batch.rows[output::VELOCITY].values(simd, x, a, force);
                let hidden = hidden * PER_SAMPLE;
                let clear = (eight(simd, sign) * speed).simd_gt(eight(simd, hidden)).to_bitmask();
                steps = clear_steps(clear, w > hidden);
            }
            for exit in exits.iter().flatten() {
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
            // Of one storey the group is looked at for less than the bound takes.
            let coarse = (self.width.modes() > 1).then(|| {
                let [size, _] = self.ground.sizes(sample);
                let friction = coefficient.abs() * self.ground.normal_range(sample)[1];
                let growth = system.root_total_mass * size + friction * system.per_root_block;
                let norm = system.energy_norm(&x[..self.width.components()]) + batch_s * growth;
                Coarse { norm, size, friction }
            });
            let inputs = [[force.at(0), a[0], 0.0], [force.at(BATCH), a[BATCH], 0.0]];
            if self.outputs_open(phase, coarse.as_ref(), inputs, &curvature, far, varying) {
                self.look_at_batch((phase, batch), (sample, steps), (a, force), &curvature, near);
            }
            self.record_batch(batch, sample, steps, a, force);
            sample += steps;
            if steps < BATCH {
                let (x, next) = (&self.x[..stride], &mut self.next[..stride]);
                batch.maps.after(simd, steps, x, a, force, next);
            }
            core::mem::swap(&mut self.x, &mut self.next);
            if steps < BATCH {
                break;
            }
        }
        sample
    }

    /// Takes samples of stick.
    #[inline(always)]
    fn rest(
        &mut self,
        (phase, batch): (&'a Phase, &'a Batch),
        mut sample: usize,
        end: usize,
    ) -> usize {
        let (simd, stride) = (self.simd, 4 * self.width.fours());
        let system = &phase.system;
        let hold = self.law.hold(self.contact, self.x[0]);
        let [low, high] = hold.bounds;
        let stop = self.stop_input(Mode::Stick, self.contact, self.x[0]);
        // Of the demand without the springs' part.
        let norm_of_demand = phase.outputs.norm[0].0[output::FRICTION];
        let size_of_a = phase.outputs.size_of_a[0].0[output::FRICTION];
        let growth = [BATCH, QUIET].map(|n| n as f64 * batch.dt_s * system.root_storey_mass);
        let near = 0.125 * batch.dt_s * batch.dt_s;
        let far = (BATCH * BATCH) as f64 * near;
        let force = Force::Constant(0.0);
        while sample + BATCH <= end {
            let sizes = self.ground.sizes(sample);
            let [normal, _] = self.ground.normal_range(sample);
            let norm = self.norm_of_structure(phase);
            let holds = least(high, -low) * normal - hold.force_n.abs();
            let coarse = [0, 1].map(|i| Coarse {
                norm: norm + growth[i] * sizes[i],
                size: sizes[i],
                friction: 0.0,
            });
            let [within, quiet] = [0, 1]
                .map(|i| norm_of_demand * coarse[i].norm + size_of_a * coarse[i].size <= holds);
            let within = within && self.below_limits(phase, &coarse[0], stop);
            if within
                && quiet
                && sample + QUIET <= end
                && matches!(self.ground.normal, Normal::Constant(_))
                && self.below_limits(phase, &coarse[1], stop)
            {
                self.take_quiet(batch, sample);
                sample += QUIET;
                continue;
            }
            let a = self.window(sample);
            let (x, next) = (&self.x[..stride], &mut self.next[..stride]);
            batch.maps.after(simd, BATCH, x, a, force, next);
            if within {
                self.record_batch(batch, sample, BATCH, a, force);
                self.swap_in_stick();
                sample += BATCH;
                continue;
            }
            let curvature = self.curvature(phase, 0.0, sample, batch.per_dt);
            let hidden = curvature.slack(simd, phase, 0, near).as_array()[output::FRICTION];
            let row = &phase.outputs.rows[output::FRICTION];
            let constant = row.of_stop * stop + row.constant;
            let x = &self.x[..stride];
            let demand =
                batch.rows[output::FRICTION].values(simd, x, a, force) + eight(simd, constant);
            let first = dot(&row.state[..stride], x) + (row.of_a * a[0] + constant);
            let steps = match self.ground.normal {
                Normal::Constant(normal) => {
                    let (low, high) = (low * normal, high * normal);
                    let clear = demand.simd_gt(eight(simd, low + hidden))
                        & demand.simd_lt(eight(simd, high - hidden));
                    let holds = first > low + hidden && first < high - hidden;
                    clear_steps(clear.to_bitmask(), holds)
                }
                Normal::Varying(normal) => {
                    let Some([n0, n @ ..]) = normal[sample..].first_chunk::<{ BATCH + 1 }>() else {
                        break;
                    };
                    let n = f64x8::from_slice(simd, n);
                    let clear = demand.simd_gt(n * eight(simd, low) + eight(simd, hidden))
                        & demand.simd_lt(n * eight(simd, high) - eight(simd, hidden))
                        & n.simd_gt(eight(simd, 0.0));
                    let holds =
                        *n0 > 0.0 && first > low * n0 + hidden && first < high * n0 - hidden;
                    clear_steps(clear.to_bitmask(), holds)
                }
            };
            if steps == 0 {
                break;
            }
            let inputs = [[0.0, a[0], stop], [0.0, a[BATCH], stop]];
            if self.outputs_open(phase, Some(&coarse[0]), inputs, &curvature, far, false) {
                self.look_at_batch((phase, batch), (sample, steps), (a, force), &curvature, near);
            }
            self.record_batch(batch, sample, steps, a, force);
            sample += steps;
            if steps < BATCH {
                let (x, next) = (&self.x[..stride], &mut self.next[..stride]);
                batch.maps.after(simd, steps, x, a, force, next);
            }
            self.swap_in_stick();
            if steps < BATCH {
                break;
            }
        }
        sample
    }

    /// Energy norm of the structure's part of the state, which is all that moves in stick.
    #[inline(always)]
    fn norm_of_structure(&self, phase: &Phase) -> f64 {
        let n = self.width.modes();
        let (eta, rate) = (&self.x[2..2 + n], &self.x[2 + n..2 + 2 * n]);
        let mut sums = [0.0; 4];
        for (j, omega2) in phase.system.omega2[..n].iter().enumerate() {
            sums[j % 4] += omega2 * (eta[j] * eta[j]) + rate[j] * rate[j];
        }
        ((sums[0] + sums[1]) + (sums[2] + sums[3])).sqrt()
    }

    /// Finds the outputs that no bound keeps below their limits over a batch from `x` to `next`: not a
    /// bound on the state, nor, unless they have kinks, the chord.
    #[inline(always)]
    fn outputs_open(
        &mut self,
        phase: &Phase,
        coarse: Option<&Coarse>,
        [first, last]: [[f64; 3]; 2],
        curvature: &Curvature,
        far: f64,
        varying: bool,
    ) -> bool {
        let (simd, stride) = (self.simd, 4 * self.width.fours());
        let outputs = &phase.outputs;
        let mut news = 0;
        for g in 0..self.groups(phase) {
            let mut open = match coarse {
                Some(coarse) => self.coarse_open(phase, g, coarse, first[2]),
                None => 0xff,
            };
            if open != 0 {
                let y = Self::group_at(simd, phase, g, &self.x[..stride], first);
                let next_y = Self::group_at(simd, phase, g, &self.next[..stride], last);
                y.store_slice(&mut self.values[g].0);
                let limit = self.peaks.limit[g].load(simd);
                let slack = curvature.slack(simd, phase, g, far);
                let below = (larger(y.abs(), next_y.abs()) + slack).simd_le(limit);
                let mut chord = !below.to_bitmask();
                if !phase.slip {
                    chord |= outputs.kinked_by_a[g];
                } else if varying {
                    chord |= outputs.kinked_by_normal[g];
                }
                open &= chord;
            }
            self.open[g] = open;
            news |= open;
        }
        news != 0
    }

    /// Outputs of a group that a bound on the state and the loads does not keep below their limits.
    #[inline(always)]
    fn coarse_open(&self, phase: &Phase, g: usize, coarse: &Coarse, stop: f64) -> u64 {
        let (simd, outputs) = (self.simd, &phase.outputs);
        let mut constant =
            outputs.constant[g].load(simd) + outputs.of_stop[g].load(simd) * eight(simd, stop);
        if !phase.slip {
            constant += outputs.of_s[g].load(simd) * eight(simd, self.x[0]);
        }
        let loads = outputs.size_of_a[g].load(simd) * eight(simd, coarse.size)
            + outputs.size_of_friction[g].load(simd) * eight(simd, coarse.friction);
        let most = (outputs.norm[g].load(simd) * eight(simd, coarse.norm) + loads) + constant.abs();
        !most.simd_le(self.peaks.limit[g].load(simd)).to_bitmask() & 0xff
    }

    #[inline(always)]
    fn below_limits(&self, phase: &Phase, coarse: &Coarse, stop: f64) -> bool {
        for g in 0..self.groups(phase) {
            if self.coarse_open(phase, g, coarse, stop) != 0 {
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
    fn take_quiet(&mut self, batch: &Batch, sample: usize) {
        if self.recorder.is_some() {
            let start = self.x.clone();
            for from in (sample..sample + QUIET).step_by(BATCH) {
                let a = self.window(from);
                let force = Force::Constant(0.0);
                self.record_batch(batch, from, BATCH, a, force);
                batch.maps.after(self.simd, BATCH, &self.x, a, force, &mut self.next);
                self.swap_in_stick();
            }
            self.x = start;
        }
        if let Some(a) = self.ground.acceleration[sample..].first_chunk() {
            let stride = 4 * self.width.fours();
            let (x, next) = (&self.x[..stride], &mut self.next[..stride]);
            batch.maps.after_quiet(self.simd, x, a, next);
            self.swap_in_stick();
        }
    }

    /// Records the samples of a batch as rows of the history, if one is wanted.
    #[inline(always)]
    fn record_batch(
        &mut self,
        batch: &Batch,
        sample: usize,
        steps: usize,
        a: &Window,
        force: Force<'_>,
    ) {
        if self.recorder.is_none() {
            return;
        }
        let mut x = self.x.clone();
        for k in 0..steps {
            if k > 0 {
                batch.maps.after(self.simd, k, &self.x, a, force, &mut x);
                if self.mode == Mode::Stick {
                    (x[0], x[1]) = (self.x[0], 0.0);
                }
            }
            let (time_s, normal) =
                (self.ground.times_s[sample + k], self.ground.normal_at(sample + k).max(0.0));
            let table = self.ground.table[sample + k];
            self.record_knot(time_s, &x, [table, a[k], normal], true);
        }
    }
}

/// Samples up to the last before the first that is not clear: both ends of each must be.
#[inline(always)]
fn clear_steps(clear: u64, first: bool) -> usize {
    let ends = (clear << 1) | u64::from(first);
    ((!ends).trailing_zeros() as usize).saturating_sub(1).min(BATCH)
}
