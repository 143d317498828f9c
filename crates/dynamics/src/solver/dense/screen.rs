//! Screened propagation: batches of samples in which a bound shows that nothing happens.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::ahead::Ahead;
use super::lanes::{Abreast, BATCH, Five, eight, greatest, least, times4};
use super::outputs::{BEHIND, behind};
use super::peaks::Samples;
use crate::linear::{QUIET, Window};
use crate::response::Mode;
use crate::response::output;
use crate::slider::Direction;
use crate::solver::chords::clear_steps;
use crate::solver::windows::Extent;

/// A chord over a sample is off by this part of what one over a batch is.
const PER_SAMPLE: f64 = 1.0 / (BATCH * BATCH) as f64;

impl<S: Simd> Ahead<'_, '_, S> {
    /// Takes samples of sliding; the first that the bounds leave open.
    #[inline(always)]
    pub(super) fn screen_slip(
        &mut self,
        mut sample: usize,
        end: usize,
        direction: Direction,
    ) -> usize {
        let (simd, tables) = (self.simd, self.of.tables);
        let of = &tables.slip.gates.slack;
        let mode = Mode::Slip(direction);
        let (sign, force_n) = (direction.sign(), self.force_n(mode));
        let by_force = [0, 1].map(|i| of.of_force[i].times(simd, force_n.abs()));
        let mut x = self.state();
        let mut gates = self.gates::<true>(x, force_n);
        // Where the gates have passed by far, one slack serves many samples: it is made from here on, and
        // serves up to there.
        let (mut far, mut far_from, mut far_to) = (Five::ZERO.load(simd), end, 0);
        while sample + BATCH <= end {
            let a = self.window(sample);
            let start = x.to_array();
            let (mut next, mut next_gates) = (x, gates);
            if sample >= far_from {
                let extent = self.of.windows.many(sample);
                far = self.slack_in_slip(start, extent, (&of.of_acceleration[1], by_force[1]));
                let goes_far = self.slides_within(gates, far, sign);
                far_from = sample + QUIET;
                far_to = if goes_far { far_from } else { 0 };
            }
            if sample < far_to {
                next = self.after::<true>(BATCH, x, a, force_n);
                next_gates = self.gates::<true>(next, force_n);
                if self.slides_within(next_gates, far, sign) {
                    self.record::<true>(sample, BATCH, x, force_n);
                    (x, gates) = (next, next_gates);
                    sample += BATCH;
                    continue;
                }
                far_to = 0;
            }
            let extent = self.of.windows.batch(sample);
            let slack = self.slack_in_slip(start, extent, (&of.of_acceleration[0], by_force[0]));
            // (i) |ṡ| ≥ min of the ends − H²/8 max|g″|: it slides through.
            let hidden = slack.four.as_array()[0];
            let u = gates.four.as_array()[3];
            let is_likely =
                sign * (start[1] + tables.batch_s * (u - 0.5 * (a[0] + a[BATCH]))) > 0.0;
            let (mut slides, mut open_gates, mut open) = (false, 0, 0);
            if is_likely {
                next = self.after::<true>(BATCH, x, a, force_n);
                next_gates = self.gates::<true>(next, force_n);
                slides = sign * start[1] > hidden && sign * next.as_array()[1] > hidden;
                (open_gates, open) =
                    self.open_in_slip([gates, next_gates], [x, next], slack, force_n);
                if slides && open_gates | open == 0 {
                    self.record::<true>(sample, BATCH, x, force_n);
                    (x, gates) = (next, next_gates);
                    sample += BATCH;
                    if far_from == end && !self.several {
                        far_from = sample;
                    }
                    continue;
                }
            }
            let mut steps = BATCH;
            let mut speed = eight(simd, 0.0);
            if !slides {
                speed = self.row::<true>(&tables.slip.rows[1], start, a, force_n);
                let hidden = PER_SAMPLE * hidden;
                let clear = (eight(simd, sign) * speed).simd_gt(eight(simd, hidden)).to_bitmask();
                steps = clear_steps(clear, sign * start[1] > hidden);
                if steps == 0 {
                    break;
                }
                next = self.after::<true>(steps, x, a, force_n);
                next_gates = self.gates::<true>(next, force_n);
                (open_gates, open) =
                    self.open_in_slip([gates, next_gates], [x, next], slack, force_n);
            }
            if open_gates | open != 0 {
                if slides && open_gates & 1 != 0 {
                    speed = self.row::<true>(&tables.slip.rows[1], start, a, force_n);
                }
                let slack = slack.times(simd, PER_SAMPLE);
                let samples = Samples { sample, steps, mode, x: start };
                open |= self.open_at_samples(&samples, a, force_n, open_gates, speed, slack);
                open |= behind(self.open(gates, slack));
                if open != 0 {
                    self.look_over::<true>(&samples, open, slack);
                }
            }
            self.record::<true>(sample, steps, x, force_n);
            (x, gates) = (next, next_gates);
            sample += steps;
            if steps < BATCH {
                break;
            }
        }
        *self.shared.x = x.to_array();
        sample
    }

    /// How far the gates depart from a chord over a batch at most, from a state on.
    #[inline(always)]
    fn slack_in_slip(
        &self,
        x: [f64; 4],
        extent: Extent,
        (of_acceleration, by_force): (&Five, Abreast<S>),
    ) -> Abreast<S> {
        let (simd, tables) = (self.simd, self.of.tables);
        let of = &tables.slip.gates.slack;
        let by_norm = of.of_norm.times(simd, tables.storey.norm(&x));
        let by_acceleration = of_acceleration.times(simd, extent.size + self.slope);
        let by_change = of.of_change.times(simd, extent.change);
        by_norm.plus(by_acceleration).plus(by_change.plus(by_force))
    }

    /// Whether at an end of a chord the gates are within their limits, and the block slides, by a slack.
    #[inline(always)]
    fn slides_within(&self, gates: Abreast<S>, slack: Abreast<S>, sign: f64) -> bool {
        let speed = sign * gates.four.as_array()[0];
        self.are_within(gates, slack) && speed > slack.four.as_array()[0]
    }

    /// Gates that may pass their limits between two states of a slide, and outputs behind several gates that
    /// may pass their peaks: the slider force `T − K1 s − C1 ṡ`, and the overturning moment. `|s|` is at
    /// most that at the ends.
    #[inline(always)]
    fn open_in_slip(
        &self,
        [first, last]: [Abreast<S>; 2],
        [x, next]: [f64x4<S>; 2],
        slack: Abreast<S>,
        force_n: f64,
    ) -> (u64, u64) {
        let open_gates = self.open(first, slack) | self.open(last, slack);
        if !self.several {
            return (open_gates, 0);
        }
        let gates = first.larger_size(last).plus(slack).to_array();
        let s = greatest(x.as_array()[0].abs(), next.as_array()[0].abs());
        let (storey, [of_f, of_u]) = (&self.of.tables.storey, self.of.tables.shape.arms);
        let peak = self.peak[0].as_array();
        let restraint = storey.stiffness_n_per_m * s + storey.damper_n_s_per_m * gates[0];
        let slider = force_n.abs() + restraint;
        let moment = of_f.abs() * gates[2] + of_u.abs() * gates[3];
        let open = u64::from(!(slider <= peak[output::SLIDER])) << output::SLIDER
            | u64::from(!(moment <= peak[output::OVERTURNING])) << output::OVERTURNING;
        (open_gates, open)
    }

    /// Outputs behind those of the open gates that pass their limits at a sample, of which the speed is
    /// known.
    #[inline(always)]
    fn open_at_samples(
        &self,
        samples: &Samples,
        a: &Window,
        force_n: f64,
        open_gates: u64,
        speed: f64x8<S>,
        slack: Abreast<S>,
    ) -> u64 {
        let (simd, storey, start) = (self.simd, &self.of.tables.storey, samples.x);
        let (rows, steps) = (&self.of.tables.slip.rows, samples.steps);
        let (low, high) = (self.low.plus(slack).to_array(), self.high.less(slack).to_array());
        let limits: [[f64; 2]; 5] = core::array::from_fn(|i| [low[i], high[i]]);
        let mut open = 0;
        if open_gates & 0b0_0001 != 0 && passes(simd, speed, limits[0], steps) {
            open |= BEHIND[0];
        }
        if open_gates & 0b0_0010 != 0 {
            let eta = self.row::<true>(&rows[2], start, a, force_n);
            if passes(simd, eta, limits[1], steps) {
                open |= BEHIND[1];
            }
        }
        if open_gates & 0b1_0000 != 0 {
            let rate = self.row::<true>(&rows[4], start, a, force_n);
            if passes(simd, rate, limits[4], steps) {
                open |= BEHIND[4];
            }
        }
        if open_gates & 0b0_1100 != 0 {
            let f = self.row::<true>(&rows[3], start, a, force_n);
            if passes(simd, f, limits[2], steps) {
                open |= BEHIND[2];
            }
            let mut push = eight(simd, storey.participation) * f + eight(simd, force_n);
            if storey.stiffness_n_per_m != 0.0 {
                let s = self.row::<true>(&rows[0], start, a, force_n);
                push -= eight(simd, storey.stiffness_n_per_m) * s;
            }
            if storey.damper_n_s_per_m != 0.0 {
                let w = self.row::<true>(&rows[1], start, a, force_n);
                push -= eight(simd, storey.damper_n_s_per_m) * w;
            }
            let u = push * eight(simd, storey.per_block_mass);
            if passes(simd, u, limits[3], steps) {
                open |= BEHIND[3];
            }
        }
        open
    }

    /// Takes samples of stick; the first that the bounds leave open.
    #[inline(always)]
    pub(super) fn screen_stick(&mut self, mut sample: usize, end: usize) -> usize {
        let (simd, tables) = (self.simd, self.of.tables);
        let (of, quiet, storey) = (&tables.stick.gates.slack, &tables.quiet, &tables.storey);
        let [low, high] = self.of.bounds_n;
        let mut x = self.state();
        let spring_n = storey.stiffness_n_per_m * self.shared.x[0];
        let holds = least(high, -low) - spring_n.abs();
        let mut limit = self.limits_in_stick(spring_n);
        while sample + BATCH <= end {
            let a = self.window(sample);
            let start = x.to_array();
            let amplitude = storey.amplitude(&start);
            let Extent { size, change } = self.of.windows.batch(sample);
            let size = size + self.slope;
            let base = quiet.of_amplitude.times(simd, amplitude);
            let most = base.plus(quiet.of_acceleration[0].times(simd, size));
            let quiet_batch = most.is_within(limit) && self.moment_stays(most);
            if quiet_batch && most.four.as_array()[0] <= holds {
                if sample + QUIET <= end {
                    let far = self.of.windows.many(sample).size + self.slope;
                    let most = base.plus(quiet.of_acceleration[1].times(simd, far));
                    let stays = most.is_within(limit) && self.moment_stays(most);
                    if stays && most.four.as_array()[0] <= holds {
                        self.record_quiet(sample, x);
                        x = self.after_quiet(sample, x);
                        sample += QUIET;
                        continue;
                    }
                }
                self.record::<false>(sample, BATCH, x, 0.0);
                x = self.after::<false>(BATCH, x, a, 0.0);
                sample += BATCH;
                continue;
            }
            let slack = (of.of_norm.times(simd, amplitude))
                .plus(of.of_acceleration[0].times(simd, size))
                .plus(of.of_change.times(simd, change));
            let hidden = storey.participation * slack.four.as_array()[2];
            // Of the demand without the spring's part.
            let demand = self.row::<false>(&tables.stick.rows[0], start, a, 0.0);
            let clear = demand.simd_gt(eight(simd, (low - spring_n) + hidden))
                & demand.simd_lt(eight(simd, (high - spring_n) - hidden));
            let first = storey.required_friction_n(&start, a[0]);
            let holds_first = first > low + hidden && first < high - hidden;
            let steps = clear_steps(clear.to_bitmask(), holds_first);
            if steps == 0 {
                break;
            }
            if !quiet_batch {
                let open_gates = !most.within(limit);
                let u = f64x8::from_slice(simd, &a[1..]);
                let first_gates = self.gates::<false>(x, a[0]);
                let mut open = behind(self.open(first_gates, slack));
                open |= u64::from(!self.moment_stays(most)) << output::OVERTURNING;
                let low = self.low.plus(slack).to_array();
                let high = self.high.less(slack).to_array();
                if open_gates & 0b0_0001 != 0 {
                    let most = self.most_friction - hidden;
                    let friction = demand + eight(simd, spring_n);
                    if first.abs() > most || passes(simd, friction, [-most, most], steps) {
                        open |= 1 << output::FRICTION;
                    }
                    let most = self.most_slider - hidden;
                    if (first - spring_n).abs() > most || passes(simd, demand, [-most, most], steps)
                    {
                        open |= 1 << output::SLIDER;
                    }
                }
                if open_gates & 0b1_0000 != 0 {
                    let rate = self.row::<false>(&tables.stick.rows[4], start, a, 0.0);
                    if passes(simd, rate, [low[4], high[4]], steps) {
                        open |= BEHIND[4];
                    }
                }
                if open_gates & 0b0_0010 != 0 {
                    let eta = self.row::<false>(&tables.stick.rows[2], start, a, 0.0);
                    if passes(simd, eta, [low[1], high[1]], steps) {
                        open |= BEHIND[1];
                    }
                }
                if open_gates & 0b0_0100 != 0 {
                    // L·f = M1 a − T, without the spring's part.
                    let shear = eight(simd, storey.block_mass_kg) * u - demand;
                    let f = shear * eight(simd, 1.0 / storey.participation);
                    if passes(simd, f, [low[2], high[2]], steps) {
                        open |= BEHIND[2];
                    }
                }
                if open_gates & 0b0_1000 != 0 && passes(simd, u, [low[3], high[3]], steps) {
                    open |= BEHIND[3];
                }
                if open != 0 {
                    let samples = Samples { sample, steps, mode: Mode::Stick, x: start };
                    self.look_over::<false>(&samples, open, slack);
                    limit = self.limits_in_stick(spring_n);
                }
            }
            self.record::<false>(sample, steps, x, 0.0);
            sample += steps;
            x = self.after::<false>(steps, x, a, 0.0);
            if steps < BATCH {
                break;
            }
        }
        *self.shared.x = x.to_array();
        sample
    }

    /// Sizes below which no output of stick passes its peak: of the demand without the spring's part, `η`,
    /// `f`, `a` and `η̇`.
    #[inline(always)]
    fn limits_in_stick(&self, spring_n: f64) -> Abreast<S> {
        let (low, high) = (self.low.to_array(), self.high.to_array());
        let limits = [
            least(self.most_friction - spring_n.abs(), self.most_slider),
            high[1],
            least(high[2], -low[2]),
            least(high[3], -low[3]),
            high[4],
        ];
        Five::new(limits).load(self.simd)
    }

    /// Whether in stick the overturning moment stays below its peak under such sizes.
    #[inline(always)]
    fn moment_stays(&self, most: Abreast<S>) -> bool {
        if !self.overturns {
            return true;
        }
        let ([of_f, of_u], most) = (self.of.tables.shape.arms, most.to_array());
        of_f.abs() * most[2] + of_u.abs() * most[3] <= self.peak[0].as_array()[output::OVERTURNING]
    }

    /// State after many samples of stick.
    #[inline(always)]
    fn after_quiet(&self, sample: usize, x: f64x4<S>) -> f64x4<S> {
        let (simd, quiet) = (self.simd, &self.of.tables.quiet);
        let acceleration = &self.of.ground.acceleration[sample..];
        let Some(a) = acceleration.first_chunk::<{ QUIET + 1 }>() else { return x };
        let (mut eta, mut rate) = (eight(simd, 0.0), eight(simd, 0.0));
        for i in 0..QUIET / BATCH {
            let a = f64x8::from_slice(simd, &a[1 + i * BATCH..][..BATCH]);
            eta += quiet.taps[0][i].load(simd) * a;
            rate += quiet.taps[1][i].load(simd) * a;
        }
        let load = f64x4::load_array(simd, [0.0, 0.0, eta.reduce_sum(), rate.reduce_sum()]);
        self.carried::<false>(&quiet.power, x) + (times4(simd, &quiet.first, a[0]) + load)
    }
}

/// Whether one of the first samples of a batch passes some limits.
#[inline(always)]
fn passes<S: Simd>(simd: S, values: f64x8<S>, [low, high]: [f64; 2], steps: usize) -> bool {
    let within = values.simd_ge(eight(simd, low)) & values.simd_le(eight(simd, high));
    !within.to_bitmask() & ((1 << steps) - 1) != 0
}
