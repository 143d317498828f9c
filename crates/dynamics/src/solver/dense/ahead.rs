//! A run ahead: its state, and what its steps share.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::lanes::{Abreast, BATCH, Five, Four, combine4, combine8, of_storey4, times4, times8};
use super::outputs::{
    ACCELERATION, BEHIND, DISPLACEMENT, RATE, Registers, each, kept, larger_sizes, loaded,
};
use super::tables::{Phase, Row};
use super::{Dense, Shared};
use crate::error::SolveError;
use crate::linear::Window;
use crate::response::Mode;
use crate::response::output;
use crate::slider::{Direction, Hold};
use crate::solver::phase::Advance;

/// Keeps the block's numbers of a state.
const BLOCK: Four = Four([1.0, 1.0, 0.0, 0.0]);

/// A run ahead of event stepping.
pub(super) struct Ahead<'r, 'a, S: Simd> {
    pub(super) simd: S,
    pub(super) of: &'r Dense<'a>,
    pub(super) shared: Shared<'r, 'a>,
    /// Peaks attained so far; those of `shared` are behind.
    pub(super) peak: Registers<S>,
    /// Between these values of the gates no output passes its peak.
    pub(super) low: Abreast<S>,
    pub(super) high: Abreast<S>,
    /// The same in stick of friction and slider force; infinite where the static bounds keep them.
    pub(super) most_friction: f64,
    pub(super) most_slider: f64,
    /// What holds at rest; the same everywhere but for the spring's force, which is not asked for.
    pub(super) hold: Hold,
    /// `|g sin θ|`.
    pub(super) slope: f64,
    /// Whether outputs stand behind several gates.
    pub(super) several: bool,
    /// Whether the overturning moment is an output.
    pub(super) overturns: bool,
}

impl<'r, 'a, S: Simd> Ahead<'r, 'a, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, of: &'r Dense<'a>, shared: Shared<'r, 'a>) -> Self {
        let overturns = of.tables.shape.arms != [0.0; 2];
        let mut ahead = Self {
            simd,
            of,
            peak: loaded(simd, shared.peak),
            hold: shared.course.slider.hold(0.0),
            shared,
            low: Five::ZERO.load(simd),
            high: Five::ZERO.load(simd),
            most_friction: 0.0,
            most_slider: 0.0,
            slope: of.tables.shape.slope.abs(),
            several: overturns || of.tables.storey.damper_n_s_per_m != 0.0,
            overturns,
        };
        ahead.set_limits();
        ahead
    }

    /// Goes on from the first of two samples towards the second.
    #[inline(always)]
    pub(super) fn go(&mut self, [mut sample, end]: [usize; 2]) -> Result<Advance, SolveError> {
        self.attain();
        let mut at_s = 0.0;
        while sample < end && !self.has_pending_decision() {
            let from = sample;
            sample = match self.shared.course.block.mode {
                Mode::Slip(direction) => self.screen_slip(sample, end, direction),
                Mode::Stick => self.screen_stick(sample, end),
            };
            self.shared.pulse.tick(16 + (sample - from) as u32)?;
            if sample < end {
                if let Some(ambiguous_s) = self.step(sample) {
                    at_s = ambiguous_s;
                    break;
                }
                sample += 1;
            }
        }
        self.attain();
        self.hand_over();
        Ok(Advance { sample, at_s })
    }

    /// Hands the peaks over.
    #[inline(always)]
    pub(super) fn hand_over(&mut self) {
        *self.shared.peak = kept(self.peak);
    }

    /// Whether a slip has just started, or a stop is still to be decided.
    #[inline(always)]
    pub(super) fn has_pending_decision(&self) -> bool {
        let course = &self.shared.course;
        course.block.start.is_some() || course.is_stopped(self.shared.x[1])
    }

    /// The friction force in a mode, or what an input takes its place in stick: nothing.
    #[inline(always)]
    pub(super) fn force_n(&self, mode: Mode) -> f64 {
        match mode {
            Mode::Stick => 0.0,
            Mode::Slip(Direction::Positive) => self.of.kinetic_n[0],
            Mode::Slip(Direction::Negative) => self.of.kinetic_n[1],
        }
    }

    #[inline(always)]
    pub(super) fn phase<const SLIP: bool>(&self) -> &'a Phase {
        if SLIP { &self.of.tables.slip } else { &self.of.tables.stick }
    }

    /// The accelerations that a batch from a sample touches; zeros where the motion has ended.
    #[inline(always)]
    pub(super) fn window(&self, sample: usize) -> &'a Window {
        self.of.ground.acceleration[sample..].first_chunk().unwrap_or(&[0.0; BATCH + 1])
    }

    /// The state as a vector.
    #[inline(always)]
    pub(super) fn state(&self) -> f64x4<S> {
        f64x4::load_array(self.simd, *self.shared.x)
    }

    /// State after `k` samples from a state at the first of `a`.
    #[inline(always)]
    pub(super) fn after<const SLIP: bool>(
        &self,
        k: usize,
        x: f64x4<S>,
        a: &Window,
        force_n: f64,
    ) -> f64x4<S> {
        let (simd, phase) = (self.simd, self.phase::<SLIP>());
        let taps = &phase.tap[k..k + BATCH];
        let mut load = times4(simd, &phase.first[k], a[0]);
        if SLIP {
            load += times4(simd, &phase.force[k], force_n);
        }
        // Two sums, that neither has to wait for the other.
        let odd = (times4(simd, &taps[7], a[1]) + times4(simd, &taps[5], a[3]))
            + (times4(simd, &taps[3], a[5]) + times4(simd, &taps[1], a[7]));
        let even = (times4(simd, &taps[6], a[2]) + times4(simd, &taps[4], a[4]))
            + (times4(simd, &taps[2], a[6]) + times4(simd, &taps[0], a[8]));
        load += odd + even;
        self.carried::<SLIP>(&phase.power[k], x) + load
    }

    /// What a map makes of a state. In stick the block keeps its place.
    #[inline(always)]
    pub(super) fn carried<const SLIP: bool>(&self, map: &[Four; 4], x: f64x4<S>) -> f64x4<S> {
        if SLIP {
            return combine4(self.simd, map, x);
        }
        x * BLOCK.load(self.simd) + of_storey4(self.simd, map, x)
    }

    /// One number at the samples 1 … 8 after a state.
    #[inline(always)]
    pub(super) fn row<const SLIP: bool>(
        &self,
        row: &Row,
        x: [f64; 4],
        a: &Window,
        force_n: f64,
    ) -> f64x8<S> {
        let (simd, taps) = (self.simd, &row.tap);
        let odd = (times8(simd, &taps[0], a[1]) + times8(simd, &taps[2], a[3]))
            + (times8(simd, &taps[4], a[5]) + times8(simd, &taps[6], a[7]));
        let even = (times8(simd, &taps[1], a[2]) + times8(simd, &taps[3], a[4]))
            + (times8(simd, &taps[5], a[6]) + times8(simd, &taps[7], a[8]));
        let mut load = times8(simd, &row.first, a[0]) + (odd + even);
        if SLIP {
            load += times8(simd, &row.force, force_n);
            combine8(simd, &row.state, x) + load
        } else {
            (times8(simd, &row.state[2], x[2]) + times8(simd, &row.state[3], x[3])) + load
        }
    }

    /// The gates in a state under an input.
    #[inline(always)]
    pub(super) fn gates<const SLIP: bool>(&self, x: f64x4<S>, input: f64) -> Abreast<S> {
        let (simd, gates) = (self.simd, &self.phase::<SLIP>().gates);
        let by_input = times4(simd, &gates.of_input, input);
        let four = if SLIP {
            combine4(simd, &gates.columns, x) + by_input
        } else {
            of_storey4(simd, &gates.columns, x) + by_input
        };
        Abreast { four, fifth: x.as_array()[3] }
    }

    /// A bit for each gate that may not stay within its limits by a slack.
    #[inline(always)]
    pub(super) fn open(&self, gates: Abreast<S>, slack: Abreast<S>) -> u64 {
        let within = self.low.plus(slack).within(gates) & gates.within(self.high.less(slack));
        !within & ((1 << BEHIND.len()) - 1)
    }

    /// Whether all do.
    #[inline(always)]
    pub(super) fn are_within(&self, gates: Abreast<S>, slack: Abreast<S>) -> bool {
        self.low.plus(slack).is_within(gates) && gates.is_within(self.high.less(slack))
    }

    /// Takes the outputs of sliding at the present for attained: friction force and slider force have their
    /// peaks at the ends of a slip, where nothing else looks if the samples begin or end amid it.
    #[inline(always)]
    fn attain(&mut self) {
        let mode = self.shared.course.block.mode;
        if mode != Mode::Stick && !self.has_pending_decision() {
            let x = *self.shared.x;
            let outputs = self.of.tables.slip.outputs.at(self.simd, x, self.force_n(mode));
            self.peak = larger_sizes(self.peak, outputs);
            self.set_limits();
        }
    }

    /// Draws the limits of the gates from the peaks attained.
    #[inline(always)]
    pub(super) fn set_limits(&mut self) {
        let (simd, tables) = (self.simd, self.of.tables);
        let (storey, shape, slope) = (&tables.storey, tables.shape.floor, tables.shape.slope);
        let peak = each(&kept(self.peak));
        let mut low = [f64::NEG_INFINITY; 5];
        let mut high = [f64::INFINITY; 5];
        (low[0], high[0]) = (-peak[output::VELOCITY], peak[output::VELOCITY]);
        if shape > 0.0 {
            // Φ η is the displacement, Φ η̇ the velocity, L·f the base shear, −Φ f − g sin θ the floor's acceleration.
            let per_shape = 1.0 / shape;
            high[1] = peak[DISPLACEMENT] * per_shape;
            low[1] = -high[1];
            high[4] = peak[RATE] * per_shape;
            low[4] = -high[4];
            let of_shear = peak[output::BASE_SHEAR] / storey.participation;
            high[2] = ((peak[ACCELERATION] - slope) * per_shape).min(of_shear);
            low[2] = -((peak[ACCELERATION] + slope) * per_shape).min(of_shear);
        }
        (low[3], high[3]) = (slope - peak[output::BLOCK], slope + peak[output::BLOCK]);
        (self.low, self.high) = (Five::new(low).load(simd), Five::new(high).load(simd));
        // (j) A demand that has reached its largest bound cannot grow but by rounding.
        let [low_n, high_n] = self.of.bounds_n;
        let bound_n = high_n.max(-low_n) * (1.0 - 1e-14);
        let [friction, slider] = [peak[output::FRICTION], peak[output::SLIDER]];
        let free = storey.stiffness_n_per_m == 0.0;
        self.most_friction = if friction >= bound_n { f64::INFINITY } else { friction };
        self.most_slider = if free && slider >= bound_n { f64::INFINITY } else { slider };
    }
}
