//! Whole blocks of samples in which a bound shows that nothing happens.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::lanes::{BLOCK, Four, combine4, eight, four, greatest, larger4, least, times4};
use super::peaks::Block;
use super::tables::QUIET;
use super::view::{ACCELERATION, DISPLACEMENT};
use super::walk::Walk;
use crate::friction::Direction;
use crate::solver::outputs::output as tracked;

/// A chord over a sample is off by this part of what one over a block is.
const PER_SAMPLE: f64 = 1.0 / (BLOCK * BLOCK) as f64;

/// Tracked quantities that follow from each gate.
const BEHIND: [u64; 4] = [
    1 << tracked::VELOCITY,
    1 << DISPLACEMENT,
    1 << tracked::BASE_SHEAR | 1 << ACCELERATION,
    1 << tracked::BLOCK,
];

/// All of them.
const BEHIND_ANY: u64 = BEHIND[0] | BEHIND[1] | BEHIND[2] | BEHIND[3];

impl<S: Simd> Walk<'_, S> {
    /// Takes samples of sliding; the first that the bounds do not vouch for.
    #[inline(always)]
    pub(super) fn slide(&mut self, mut sample: usize, end: usize, direction: Direction) -> usize {
        let (simd, tables) = (self.simd, self.tables);
        let bend = &tables.slip.gates.bend;
        let (sign, force) = (direction.sign(), self.force(direction));
        let by_force = times4(simd, &bend.of_force, force.abs());
        let mut x = self.state();
        let mut view = self.gates::<true>(x, force);
        while sample + BLOCK <= end {
            let a = self.block_at(sample);
            let window = self.windows.at(sample);
            let start = x.to_array();
            let norm = tables.plant.norm(&start);
            let size = window.block + self.ground.slope_size;
            let slack = (times4(simd, &bend.of_norm, norm)
                + times4(simd, &bend.of_acceleration, size))
                + (times4(simd, &bend.of_rate, window.rate) + by_force);
            let next = self.end::<true>(BLOCK, x, a, force);
            let next_view = self.gates::<true>(next, force);
            let quiet = self.inside(view, slack) & self.inside(next_view, slack);
            let hidden = slack.as_array()[0];
            let slides = sign * start[1] > hidden && sign * next.as_array()[1] > hidden;
            let mut hits = 0;
            if self.careful {
                let most = larger4(view.abs(), next_view.abs()) + slack;
                let s = greatest(start[0].abs(), next.as_array()[0].abs());
                hits = self.beside(most.to_array(), s, force);
                // Where it may stop within the block the ends do not bound s.
                hits |= u64::from(!slides) << tracked::SLIDER;
            }
            if slides && quiet.all_true() && hits == 0 {
                self.record::<true>(sample, BLOCK, x, force);
                (x, view) = (next, next_view);
                sample += BLOCK;
                continue;
            }
            let open = !quiet.to_bitmask() & 0b1111;
            let mut steps = BLOCK;
            let mut speed = eight(simd, 0.0);
            if !slides || open & 1 != 0 {
                speed = self.row::<true>(&tables.slip.rows[1], start, a, force);
            }
            if !slides {
                let hidden = PER_SAMPLE * hidden;
                let clear = (eight(simd, sign) * speed).simd_gt(eight(simd, hidden)).to_bitmask();
                steps = clear_steps(clear, sign * start[1] > hidden);
                if steps == 0 {
                    break;
                }
            }
            let slack = slack * four(simd, PER_SAMPLE);
            hits |= self.hits_in_slip(start, a, force, [open, steps as u64], speed, slack);
            hits |= BEHIND_ANY * u64::from(!self.inside(view, slack).all_true());
            if hits != 0 {
                let block = Block { sample, steps, direction: Some(direction), x: start };
                self.watch::<true>(&block, hits, slack);
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

    /// Tracked quantities behind no gate that may pass their peaks where the gates and `s` are at
    /// most so large: the slider force `T − K1 s − C1 ṡ` and the overturning moment.
    #[inline(always)]
    fn beside(&self, most: [f64; 4], s: f64, force: f64) -> u64 {
        let (plant, [arm, half]) = (&self.tables.plant, self.tables.arm);
        let peak = self.peak.as_array();
        let slider = force.abs() + plant.stiffness_n_per_m * s + plant.damper_n_s_per_m * most[0];
        let moment = arm.abs() * most[2] + half.abs() * most[3];
        u64::from(!(slider <= peak[tracked::SLIDER])) << tracked::SLIDER
            | u64::from(!(moment <= peak[tracked::OVERTURNING])) << tracked::OVERTURNING
    }

    /// Tracked quantities behind the `open` gates that a sample of a block passes.
    #[inline(always)]
    fn hits_in_slip(
        &self,
        start: [f64; 4],
        a: &[f64; BLOCK + 1],
        force: f64,
        [open, steps]: [u64; 2],
        speed: f64x8<S>,
        slack: f64x4<S>,
    ) -> u64 {
        let (simd, rows, plant) = (self.simd, &self.tables.slip.rows, &self.tables.plant);
        let (low, high) = ((self.low + slack).to_array(), (self.high - slack).to_array());
        let mut hits = 0;
        if open & 0b0001 != 0 && self.outside(speed, low[0], high[0], steps) {
            hits |= BEHIND[0];
        }
        if open & 0b0010 != 0 {
            let eta = self.row::<true>(&rows[2], start, a, force);
            if self.outside(eta, low[1], high[1], steps) {
                hits |= BEHIND[1];
            }
        }
        if open & 0b1100 != 0 {
            let f = self.row::<true>(&rows[3], start, a, force);
            if self.outside(f, low[2], high[2], steps) {
                hits |= BEHIND[2];
            }
            let mut push = eight(simd, plant.participation) * f + eight(simd, force);
            if plant.stiffness_n_per_m != 0.0 {
                let s = self.row::<true>(&rows[0], start, a, force);
                push -= eight(simd, plant.stiffness_n_per_m) * s;
            }
            if plant.damper_n_s_per_m != 0.0 {
                let w = self.row::<true>(&rows[1], start, a, force);
                push -= eight(simd, plant.damper_n_s_per_m) * w;
            }
            let u = push * eight(simd, plant.per_block_mass);
            if self.outside(u, low[3], high[3], steps) {
                hits |= BEHIND[3];
            }
        }
        hits
    }

    /// Whether one of the first samples of a block is outside some limits.
    #[inline(always)]
    fn outside(&self, values: f64x8<S>, low: f64, high: f64, steps: u64) -> bool {
        let simd = self.simd;
        let inside = values.simd_ge(eight(simd, low)) & values.simd_le(eight(simd, high));
        !inside.to_bitmask() & ((1 << steps) - 1) != 0
    }

    /// Takes samples of stick; the first that the bounds do not vouch for.
    #[inline(always)]
    pub(super) fn hold(&mut self, mut sample: usize, end: usize) -> usize {
        let (simd, tables) = (self.simd, self.tables);
        let (bend, quiet, plant) = (&tables.stick.gates.bend, &tables.quiet, &tables.plant);
        let [low, high] = self.ground.bounds;
        let mut x = self.state();
        let spring_n = plant.stiffness_n_per_m * self.carry.x[0];
        let holds = least(high, -low) - spring_n.abs();
        let mut limit = self.stick_limits(spring_n);
        while sample + BLOCK <= end {
            let window = self.windows.at(sample);
            let start = x.to_array();
            let norm = plant.norm_of_structure(&start);
            let size = window.block + self.ground.slope_size;
            let base = times4(simd, &quiet.of_norm, norm);
            let reach = base + times4(simd, &quiet.of_acceleration[0], size);
            let within = reach.simd_le(limit);
            let quiet_block = within.all_true() && self.moment_stays(reach);
            if quiet_block && reach.as_array()[0] <= holds {
                let far = window.quiet + self.ground.slope_size;
                let reach = base + times4(simd, &quiet.of_acceleration[1], far);
                let all = reach.simd_le(limit).all_true() && reach.as_array()[0] <= holds;
                if sample + QUIET <= end && all && self.moment_stays(reach) {
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
            let slack = (times4(simd, &bend.of_norm, norm)
                + times4(simd, &bend.of_acceleration, size))
                + times4(simd, &bend.of_rate, window.rate);
            let hidden = plant.participation * slack.as_array()[2];
            // Of the demand without the spring's part.
            let demand = self.row::<false>(&tables.stick.rows[0], start, a, 0.0);
            let clear = demand.simd_gt(eight(simd, (low - spring_n) + hidden))
                & demand.simd_lt(eight(simd, (high - spring_n) - hidden));
            let first = plant.demand_n(&start, a[0]);
            let holds_first = first > low + hidden && first < high - hidden;
            let steps = clear_steps(clear.to_bitmask(), holds_first);
            if steps == 0 {
                break;
            }
            if !quiet_block {
                let open = !within.to_bitmask() & 0b1111;
                let n = steps as u64;
                let (lows, highs) = ((self.low + slack).to_array(), (self.high - slack).to_array());
                let view = self.gates::<false>(x, a[0]);
                let mut hits = BEHIND_ANY * u64::from(!self.inside(view, slack).all_true());
                hits |= u64::from(!self.moment_stays(reach)) << tracked::OVERTURNING;
                if open & 0b0001 != 0 {
                    let most = self.most_friction - hidden;
                    let friction = demand + eight(simd, spring_n);
                    if first.abs() > most || self.outside(friction, -most, most, n) {
                        hits |= 1 << tracked::FRICTION;
                    }
                    let most = self.most_slider - hidden;
                    if (first - spring_n).abs() > most || self.outside(demand, -most, most, n) {
                        hits |= 1 << tracked::SLIDER;
                    }
                }
                if open & 0b0010 != 0 {
                    let eta = self.row::<false>(&tables.stick.rows[2], start, a, 0.0);
                    if self.outside(eta, lows[1], highs[1], n) {
                        hits |= BEHIND[1];
                    }
                }
                if open & 0b0100 != 0 {
                    let f = self.row::<false>(&tables.stick.rows[3], start, a, 0.0);
                    if self.outside(f, lows[2], highs[2], n) {
                        hits |= BEHIND[2];
                    }
                }
                let table = f64x8::from_slice(simd, &a[1..]);
                if open & 0b1000 != 0 && self.outside(table, lows[3], highs[3], n) {
                    hits |= BEHIND[3];
                }
                if hits != 0 {
                    let block = Block { sample, steps, direction: None, x: start };
                    self.watch::<false>(&block, hits, slack);
                    limit = self.stick_limits(spring_n);
                }
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

    /// Sizes below which nothing new is told in stick: of the demand without the spring's part, `η`,
    /// `f` and `a`.
    #[inline(always)]
    fn stick_limits(&self, spring_n: f64) -> f64x4<S> {
        let (low, high) = (self.low.to_array(), self.high.to_array());
        let limits = [
            least(self.most_friction - spring_n.abs(), self.most_slider),
            high[1],
            least(high[2], -low[2]),
            least(high[3], -low[3]),
        ];
        Four(limits).load(self.simd)
    }

    /// Whether in stick the overturning moment stays below its peak.
    #[inline(always)]
    fn moment_stays(&self, reach: f64x4<S>) -> bool {
        if !self.tells_moment {
            return true;
        }
        let [arm, half] = self.tables.arm;
        let reach = reach.to_array();
        arm.abs() * reach[2] + half.abs() * reach[3] <= self.peak.as_array()[tracked::OVERTURNING]
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
                sums[i] += tap * four(simd, a[1 + m + i]);
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
