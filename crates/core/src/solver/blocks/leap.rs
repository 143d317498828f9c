//! Whole blocks of samples in which a bound shows that nothing happens.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::lanes::{BLOCK, Eight, combine4, eight, four, times4, times8};
use super::peaks::Block;
use super::tables::QUIET;
use super::walk::Walk;
use crate::friction::Direction;
use crate::solver::extremes::tracked;

/// All samples of a block.
const ALL: u64 = (1 << BLOCK) - 1;

/// A chord over a sample is off by this part of what one over a block is.
const PER_SAMPLE: f64 = 1.0 / (BLOCK * BLOCK) as f64;

impl<S: Simd> Walk<'_, S> {
    /// Takes samples of sliding; the first that the bounds do not vouch for.
    #[inline(always)]
    pub(super) fn slide(&mut self, mut sample: usize, end: usize, direction: Direction) -> usize {
        let (simd, tables) = (self.simd, self.tables);
        let bend = &tables.slip.bend;
        let (sign, force) = (direction.sign(), self.force(direction));
        let by_force = times8(simd, &bend.of_force, force.abs());
        let mut x = self.state();
        let mut view = self.view::<true>(self.carry.x, 0.0, force);
        while sample + BLOCK <= end {
            let a = self.block_at(sample);
            let window = self.windows.at(sample);
            let start = x.to_array();
            let norm = tables.plant.norm(&start);
            let size = window.block + self.ground.slope_size;
            let slack = (times8(simd, &bend.of_norm, norm)
                + times8(simd, &bend.of_acceleration, size))
                + (times8(simd, &bend.of_rate, window.rate) + by_force);
            let next = self.end::<true>(BLOCK, x, a, force);
            let ahead = next.to_array();
            let next_view = self.view::<true>(ahead, 0.0, force);
            let within = self.peak - slack;
            let quiet = view.abs().simd_le(within) & next_view.abs().simd_le(within);
            let hidden = slack.as_array()[tracked::VELOCITY];
            let slides = sign * start[1] > hidden && sign * ahead[1] > hidden;
            if slides && quiet.all_true() {
                self.record::<true>(sample, BLOCK, x, force);
                (x, view) = (next, next_view);
                sample += BLOCK;
                continue;
            }
            let mut steps = BLOCK;
            if !slides {
                let hidden = PER_SAMPLE * hidden;
                let w = self.row::<true>(&tables.slip.rows[1], start, a, force);
                let clear = (eight(simd, sign) * w).simd_gt(eight(simd, hidden)).to_bitmask();
                steps = clear_steps(clear, sign * start[1] > hidden);
                if steps == 0 {
                    break;
                }
            }
            let block = Block { sample, steps, direction: Some(direction), x: start };
            let open = !quiet.to_bitmask() & ALL;
            if open != 0 {
                self.watch::<true>(&block, open, view, slack * eight(simd, PER_SAMPLE));
            }
            self.record::<true>(sample, steps, x, force);
            sample += steps;
            if steps < BLOCK {
                x = self.end::<true>(steps, x, a, force);
                break;
            }
            (x, view) = (next, next_view);
        }
        self.carry.x = x.to_array();
        sample
    }

    /// Takes samples of stick; the first that the bounds do not vouch for.
    #[inline(always)]
    pub(super) fn hold(&mut self, mut sample: usize, end: usize) -> usize {
        let (simd, tables) = (self.simd, self.tables);
        let (bend, quiet, plant) = (&tables.stick.bend, &tables.quiet, &tables.plant);
        let [low, high] = self.ground.bounds;
        let mut holds = Eight([f64::INFINITY; 8]);
        holds.0[tracked::FRICTION] = high.min(-low);
        let holds = holds.load(simd);
        let of_norm = quiet.of_norm.load(simd);
        let constant = times8(simd, &quiet.of_s, self.carry.x[0].abs()) + quiet.of_slope.load(simd);
        let mut x = self.state();
        let spring_n = plant.stiffness_n_per_m * self.carry.x[0];
        while sample + BLOCK <= end {
            let window = self.windows.at(sample);
            let start = x.to_array();
            let norm = plant.norm(&start);
            let size = window.block + self.ground.slope_size;
            let base = of_norm * eight(simd, norm) + constant;
            let reach = base + times8(simd, &quiet.of_acceleration[0], size);
            let within = reach.simd_le(self.peak);
            if (within & reach.simd_lt(holds)).all_true() {
                let long = base
                    + quiet.of_acceleration[1].load(simd)
                        * eight(simd, window.quiet + self.ground.slope_size);
                let all = long.simd_le(self.peak) & long.simd_lt(holds);
                if sample + QUIET <= end && all.all_true() {
                    let next = self.after_quiet(sample, x);
                    if self.records {
                        self.record_quiet(sample, x);
                    }
                    x = next;
                    sample += QUIET;
                    continue;
                }
                self.record::<false>(sample, BLOCK, x, 0.0);
                x = self.end::<false>(BLOCK, x, self.block_at(sample), 0.0);
                sample += BLOCK;
                continue;
            }
            let a = self.block_at(sample);
            let slack = (times8(simd, &bend.of_norm, norm)
                + times8(simd, &bend.of_acceleration, size))
                + times8(simd, &bend.of_rate, window.rate);
            let hidden = slack.as_array()[tracked::FRICTION];
            let f = self.row::<false>(&tables.stick.rows[3], start, a, 0.0);
            let table = f64x8::from_slice(simd, &a[1..]);
            let demand = (eight(simd, plant.block_mass_kg) * table + eight(simd, spring_n))
                - eight(simd, plant.participation) * f;
            let clear = demand.simd_gt(eight(simd, low + hidden))
                & demand.simd_lt(eight(simd, high - hidden));
            let demand = plant.demand_n(&start, a[0]);
            let first = demand > low + hidden && demand < high - hidden;
            let steps = clear_steps(clear.to_bitmask(), first);
            if steps == 0 {
                break;
            }
            let open = !within.to_bitmask() & ALL;
            if open != 0 {
                let block = Block { sample, steps, direction: None, x: start };
                let view = self.view::<false>(start, a[0], 0.0);
                self.watch::<false>(&block, open, view, slack);
            }
            self.record::<false>(sample, steps, x, 0.0);
            sample += steps;
            x = self.end::<false>(steps, x, a, 0.0);
            if steps < BLOCK {
                break;
            }
        }
        self.carry.x = x.to_array();
        sample
    }

    /// Records a stretch of quiet stick.
    #[inline(always)]
    fn record_quiet(&mut self, sample: usize, mut x: f64x4<S>) {
        for from in (sample..sample + QUIET).step_by(BLOCK) {
            self.record::<false>(from, BLOCK, x, 0.0);
            x = self.end::<false>(BLOCK, x, self.block_at(from), 0.0);
        }
    }

    /// State after a stretch of quiet stick.
    #[inline(always)]
    fn after_quiet(&self, sample: usize, x: f64x4<S>) -> f64x4<S> {
        let (simd, quiet) = (self.simd, &self.tables.quiet);
        let Some(a) = self.ground.acceleration[sample..].first_chunk::<{ QUIET + 1 }>() else {
            return x;
        };
        let mut sums = [four(simd, 0.0); 4];
        for m in (0..QUIET).step_by(4) {
            for i in 0..4 {
                let tap = quiet.tap[QUIET - 1 - m - i].load(simd);
                sums[i] = sums[i] + tap * four(simd, a[1 + m + i]);
            }
        }
        let load = (sums[0] + sums[1]) + (sums[2] + sums[3]);
        combine4(simd, &quiet.power, x) + (times4(simd, &quiet.first, a[0]) + load)
    }
}

/// Samples up to the last before the first that is not clear: both ends of each must be.
#[inline(always)]
fn clear_steps(clear: u64, first: bool) -> usize {
    let ends = (clear << 1) | u64::from(first);
    ((!ends).trailing_zeros() as usize).saturating_sub(1).min(BLOCK)
}
