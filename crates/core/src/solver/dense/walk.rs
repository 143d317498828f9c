//! The state of a walk by blocks, and what its steps share.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8, mask64x4};

use super::lanes::{BLOCK, Four, combine4, combine8, eight, four, larger, times4, times8};
use super::peaks::Candidate;
use super::tables::{Phase, Row, Tables};
use super::view::{ACCELERATION, DISPLACEMENT};
use super::windows::Windows;
use crate::error::{Pulse, SolveError};
use crate::friction::{Contact, Direction, Hold};
use crate::linear::System;
use crate::response::{Event, Mode};
use crate::solver::outputs::output as tracked;
use crate::solver::recorder::{Knot, Recorder};
use crate::solver::run::Sliding;
use crate::solver::slider::Start;

/// What the walk and this way ahead hand to each other.
pub(in crate::solver) struct Carry {
    /// `s, ṡ, η, η̇`, with zeros for the structure of a rigid block.
    pub(in crate::solver) x: [f64; 4],
    /// Peaks attained so far, in the order of the outputs.
    pub(in crate::solver) peak: [f64; 8],
    pub(in crate::solver) mode: Mode,
    pub(in crate::solver) start: Option<Start>,
    pub(in crate::solver) events: Vec<Event>,
    pub(in crate::solver) sliding: Sliding,
    /// Places that may hold a peak.
    pub(in crate::solver) candidates: Vec<Candidate>,
}

/// Where it has come to: so long after a sample, from where on others decide.
#[derive(Clone, Copy)]
pub(in crate::solver) struct Reached {
    pub(in crate::solver) sample: usize,
    pub(in crate::solver) at_s: f64,
}

/// Evenly spaced samples under a constant normal force.
pub(in crate::solver) struct Ground<'a> {
    pub(in crate::solver) times_s: &'a [f64],
    /// `Ü` at the samples.
    pub(in crate::solver) table: &'a [f64],
    /// `a = Ü + g sin θ` at the samples.
    pub(in crate::solver) acceleration: &'a [f64],
    /// `|g sin θ|`.
    pub(in crate::solver) slope_size: f64,
    pub(in crate::solver) normal_n: f64,
    /// What holds at rest; only its bounds count.
    pub(in crate::solver) hold: Hold,
    /// Static bounds in N, and friction force of sliding towards +x and −x.
    pub(in crate::solver) bounds: [f64; 2],
    pub(in crate::solver) kinetic: [f64; 2],
}

/// A walk by blocks.
pub(super) struct Walk<'w, S: Simd> {
    pub(super) simd: S,
    pub(super) tables: &'w Tables,
    pub(super) windows: &'w Windows,
    pub(super) ground: &'w Ground<'w>,
    /// Where a history is wanted.
    pub(super) recorder: Option<(&'w mut Recorder, &'w System)>,
    pub(super) carry: &'w mut Carry,
    /// Peaks attained so far; those of `carry` are behind.
    pub(super) peak: f64x8<S>,
    /// Within which values of the gates nothing new is told.
    pub(super) low: f64x4<S>,
    pub(super) high: f64x4<S>,
    /// Peaks of friction and slider force in stick that matter, infinite where the static bounds
    /// keep them.
    pub(super) most_friction: f64,
    pub(super) most_slider: f64,
    pub(super) records: bool,
    /// Whether the overturning moment, or in slip the slider force, is to be watched besides.
    pub(super) careful: bool,
    /// Whether an overturning moment is told.
    pub(super) tells_moment: bool,
}

impl<'w, S: Simd> Walk<'w, S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        (tables, windows): (&'w Tables, &'w Windows),
        ground: &'w Ground<'w>,
        recorder: Option<(&'w mut Recorder, &'w System)>,
        carry: &'w mut Carry,
    ) -> Self {
        let zero = four(simd, 0.0);
        let mut walk = Self {
            simd,
            tables,
            windows,
            ground,
            records: recorder.is_some(),
            careful: tables.plant.damper_n_s_per_m != 0.0 || tables.arm != [0.0; 2],
            tells_moment: tables.arm != [0.0; 2],
            recorder,
            peak: f64x8::load_array(simd, carry.peak),
            low: zero,
            high: zero,
            most_friction: 0.0,
            most_slider: 0.0,
            carry,
        };
        walk.set_gates();
        walk
    }

    /// Walks from a sample towards the end of the evenly spaced samples, as far as it is sure.
    #[inline(always)]
    pub(super) fn go(
        &mut self,
        mut sample: usize,
        end: usize,
        pulse: &mut Pulse<'_>,
    ) -> Result<Reached, SolveError> {
        self.attain();
        let mut at_s = 0.0;
        while sample < end {
            let from = sample;
            sample = match self.carry.mode {
                Mode::Slip(_) if self.is_due() => break,
                Mode::Slip(direction) => self.slide(sample, end, direction),
                Mode::Stick => self.hold(sample, end),
            };
            pulse.beat(16 + (sample - from) as u32)?;
            if sample < end {
                if let Some(doubt_s) = self.step(sample) {
                    at_s = doubt_s;
                    break;
                }
                sample += 1;
            }
        }
        self.attain();
        self.hand_peaks();
        Ok(Reached { sample, at_s })
    }

    /// Hands the peaks back.
    #[inline(always)]
    pub(super) fn hand_peaks(&mut self) {
        self.carry.peak = self.peak.to_array();
    }

    /// Whether a slip has just started, or a stop is still to be decided.
    #[inline(always)]
    pub(super) fn is_due(&self) -> bool {
        self.carry.start.is_some() || (self.carry.mode != Mode::Stick && self.carry.x[1] == 0.0)
    }

    /// Friction force of sliding in a direction, in N.
    #[inline(always)]
    pub(super) fn force(&self, direction: Direction) -> f64 {
        self.ground.kinetic[if direction == Direction::Positive { 0 } else { 1 }]
    }

    /// State after `k` samples from a state at the first of `a`.
    #[inline(always)]
    pub(super) fn end<const SLIP: bool>(
        &self,
        k: usize,
        x: f64x4<S>,
        a: &[f64; BLOCK + 1],
        force: f64,
    ) -> f64x4<S> {
        let (simd, phase) = (self.simd, self.phase::<SLIP>());
        let taps = &phase.tap[k..k + BLOCK];
        let mut load = times4(simd, &phase.first[k], a[0]);
        if SLIP {
            load += times4(simd, &phase.force[k], force);
        }
        // Two sums, that neither has to wait for the other.
        let odd = (times4(simd, &taps[7], a[1]) + times4(simd, &taps[5], a[3]))
            + (times4(simd, &taps[3], a[5]) + times4(simd, &taps[1], a[7]));
        let even = (times4(simd, &taps[6], a[2]) + times4(simd, &taps[4], a[4]))
            + (times4(simd, &taps[2], a[6]) + times4(simd, &taps[0], a[8]));
        load += odd + even;
        combine4(simd, &phase.power[k], x) + load
    }

    /// One value at the samples 1 … 8 after a state.
    #[inline(always)]
    pub(super) fn row<const SLIP: bool>(
        &self,
        row: &Row,
        x: [f64; 4],
        a: &[f64; BLOCK + 1],
        force: f64,
    ) -> f64x8<S> {
        let simd = self.simd;
        let taps = &row.tap;
        let odd = (times8(simd, &taps[0], a[1]) + times8(simd, &taps[2], a[3]))
            + (times8(simd, &taps[4], a[5]) + times8(simd, &taps[6], a[7]));
        let even = (times8(simd, &taps[1], a[2]) + times8(simd, &taps[3], a[4]))
            + (times8(simd, &taps[5], a[6]) + times8(simd, &taps[7], a[8]));
        let mut load = times8(simd, &row.first, a[0]) + (odd + even);
        if SLIP {
            load += times8(simd, &row.force, force);
        }
        combine8(simd, &row.state, x) + load
    }

    /// Takes the values of sliding at the present for attained: in a slip the friction force, and
    /// without a damper the slider force, have their peaks at its ends, where nothing else looks if
    /// the samples begin or end amid it.
    #[inline(always)]
    fn attain(&mut self) {
        if let Mode::Slip(direction) = self.carry.mode
            && !self.is_due()
        {
            let view = self.view::<true>(self.carry.x, 0.0, self.force(direction));
            self.peak = larger(self.peak, view.abs());
            self.set_gates();
        }
    }

    /// Draws the gates around the peaks attained.
    #[inline(always)]
    pub(super) fn set_gates(&mut self) {
        let (tables, simd) = (self.tables, self.simd);
        let (plant, shape, slope) = (&tables.plant, tables.shape, tables.slope);
        let peak = self.peak.to_array();
        let mut low = [f64::NEG_INFINITY; 4];
        let mut high = [f64::INFINITY; 4];
        (low[0], high[0]) = (-peak[tracked::VELOCITY], peak[tracked::VELOCITY]);
        if shape > 0.0 {
            let per_shape = 1.0 / shape;
            high[1] = peak[DISPLACEMENT] * per_shape;
            low[1] = -high[1];
            let of_shear = peak[tracked::BASE_SHEAR] / plant.participation;
            high[2] = ((peak[ACCELERATION] - slope) * per_shape).min(of_shear);
            low[2] = -((peak[ACCELERATION] + slope) * per_shape).min(of_shear);
        }
        (low[3], high[3]) = (slope - peak[tracked::BLOCK], slope + peak[tracked::BLOCK]);
        (self.low, self.high) = (Four(low).load(simd), Four(high).load(simd));
        // A demand that has reached its largest bound cannot grow but by rounding.
        let bound = self.ground.bounds[1].max(-self.ground.bounds[0]) * (1.0 - 1e-14);
        let [friction, slider] = [peak[tracked::FRICTION], peak[tracked::SLIDER]];
        let free = plant.stiffness_n_per_m == 0.0;
        self.most_friction = if friction >= bound { f64::INFINITY } else { friction };
        self.most_slider = if free && slider >= bound { f64::INFINITY } else { slider };
    }

    /// What is watched in a state.
    #[inline(always)]
    pub(super) fn gates<const SLIP: bool>(&self, x: f64x4<S>, input: f64) -> f64x4<S> {
        let gates = &self.phase::<SLIP>().gates;
        combine4(self.simd, &gates.columns, x) + times4(self.simd, &gates.of_input, input)
    }

    /// Whether values of the gates stay within them by a slack.
    #[inline(always)]
    pub(super) fn inside(&self, view: f64x4<S>, slack: f64x4<S>) -> mask64x4<S> {
        view.simd_ge(self.low + slack) & view.simd_le(self.high - slack)
    }

    /// The tracked quantities in a state under an acceleration and a friction force.
    #[inline(always)]
    pub(super) fn view<const SLIP: bool>(&self, x: [f64; 4], a: f64, force: f64) -> f64x8<S> {
        let (simd, view) = (self.simd, &self.phase::<SLIP>().view);
        let input = if SLIP {
            times8(simd, &view.of_force, force)
        } else {
            times8(simd, &view.of_acceleration, a)
        };
        combine8(simd, &view.columns, x) + (input + view.constant.load(simd))
    }

    #[inline(always)]
    pub(super) fn phase<const SLIP: bool>(&self) -> &'w Phase {
        if SLIP { &self.tables.slip } else { &self.tables.stick }
    }

    /// Records samples of a block as rows of the history, if one is wanted.
    #[inline(always)]
    pub(super) fn record<const SLIP: bool>(
        &mut self,
        sample: usize,
        steps: usize,
        x: f64x4<S>,
        force: f64,
    ) {
        if !self.records {
            return;
        }
        self.record_block::<SLIP>(sample, steps, x.to_array(), force);
    }

    /// The same by rows, each number at all samples at once.
    #[inline(never)]
    fn record_block<const SLIP: bool>(
        &mut self,
        sample: usize,
        steps: usize,
        x: [f64; 4],
        force: f64,
    ) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                let (plant, a) = (&self.tables.plant, self.block_at(sample));
                let rows = &self.phase::<SLIP>().rows;
                let (shape, slope) = (self.tables.shape, self.tables.slope);
                let f0 = plant.restoring(&x);
                let spring_n = plant.stiffness_n_per_m * x[0];
                let storey = shape != 0.0;
                let mut f = eight(simd, 0.0);
                if storey {
                    f = self.row::<SLIP>(&rows[3], x, a, force);
                }
                let [s, w, block, friction];
                if SLIP {
                    let of_s = self.row::<SLIP>(&rows[0], x, a, force);
                    let of_w = self.row::<SLIP>(&rows[1], x, a, force);
                    (s, w, friction) =
                        (series8(x[0], of_s), series8(x[1], of_w), [force; BLOCK + 1]);
                    let push = (eight(simd, force) - eight(simd, plant.damper_n_s_per_m) * of_w)
                        + (eight(simd, plant.participation) * f
                            - eight(simd, plant.stiffness_n_per_m) * of_s);
                    let u = push * eight(simd, plant.per_block_mass) - eight(simd, slope);
                    block = series8(plant.block_acceleration(&x, f0, force) - slope, u);
                } else {
                    let demand = self.row::<SLIP>(&rows[0], x, a, force);
                    (s, w) = ([x[0]; BLOCK + 1], [0.0; BLOCK + 1]);
                    friction = series8(plant.demand_n(&x, a[0]), demand + eight(simd, spring_n));
                    let table = self.ground.table[sample..].first_chunk();
                    block = *table.unwrap_or(&[0.0; BLOCK + 1]);
                }
                let mut of_storey = None;
                if storey {
                    let eta = self.row::<SLIP>(&rows[2], x, a, force);
                    let rate = self.row::<SLIP>(&rows[4], x, a, force);
                    let by = eight(simd, shape);
                    of_storey = Some([
                        series8(shape * x[2], by * eta),
                        series8(shape * x[3], by * rate),
                        series8(-(shape * f0) - slope, -(by * f) - eight(simd, slope)),
                    ]);
                }
                let samples = sample..sample + steps;
                let times = [&self.ground.times_s[samples.clone()], &self.ground.table[samples]];
                let mode = self.carry.mode;
                if let Some((recorder, _)) = &mut self.recorder {
                    recorder.store_samples(times, mode, Contact::Free);
                    recorder.store_block(steps, [&s, &w, &block, &friction], of_storey.as_ref());
                }
            },
        );
    }

    /// The force that a [`Knot`] names: friction in slip, the spring's in stick.
    #[inline(always)]
    fn force_at(&self, x: &[f64; 4], force: f64) -> f64 {
        match self.carry.mode {
            Mode::Stick => self.tables.plant.stiffness_n_per_m * x[0] + 0.0,
            Mode::Slip(_) => force,
        }
    }

    /// Records the present state so long after a sample, `row` as a row of the history.
    #[inline(never)]
    pub(super) fn record_now(&mut self, sample: usize, at_s: f64, row: bool) {
        let (mode, x) = (self.carry.mode, self.carry.x);
        let friction_n = match mode {
            Mode::Stick => 0.0,
            Mode::Slip(direction) => self.force(direction),
        };
        let force_n = self.force_at(&x, friction_n);
        let times_s = &self.ground.times_s[sample..sample + 2];
        let part = at_s / (times_s[1] - times_s[0]);
        let at = |list: &[f64]| {
            let [from, to] = [list[sample], list[sample + 1]];
            if row { from } else { from + (to - from) * part }
        };
        let knot = Knot {
            time_s: times_s[0] + at_s,
            mode,
            contact: Contact::Free,
            table: at(self.ground.table),
            acceleration: at(self.ground.acceleration),
            state: &x,
            friction_n,
            force_n,
        };
        if let Some((recorder, system)) = &mut self.recorder {
            recorder.knot(system, &knot, row);
        }
    }

    /// The accelerations that a block from a sample touches; zeros where the motion has ended.
    #[inline(always)]
    pub(super) fn block_at(&self, sample: usize) -> &'w [f64; BLOCK + 1] {
        self.ground.acceleration[sample..].first_chunk().unwrap_or(&[0.0; BLOCK + 1])
    }

    /// The state as a vector.
    #[inline(always)]
    pub(super) fn state(&self) -> f64x4<S> {
        Four(self.carry.x).load(self.simd)
    }
}

/// A number at a sample and at the eight after it.
#[inline(always)]
fn series8<S: Simd>(first: f64, later: f64x8<S>) -> [f64; BLOCK + 1] {
    let mut all = [first; BLOCK + 1];
    later.store_slice(&mut all[1..]);
    all
}
