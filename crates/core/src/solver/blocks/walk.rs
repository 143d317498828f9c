//! The state of a walk by blocks, and what its steps share.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::lanes::{BLOCK, Four, combine4, combine8, times4, times8};
use super::peaks::Candidates;
use super::tables::{Phase, Row, Tables};
use super::windows::Windows;
use crate::error::SolveError;
use crate::friction::Direction;
use crate::response::{Event, Mode};
use crate::solver::exact::{Sliding, Start};

/// What a walk by blocks and the run it serves hand to each other.
pub(in crate::solver) struct Carry {
    /// `s, ṡ, η, η̇`, with zeros for the structure of a rigid block.
    pub(in crate::solver) x: [f64; 4],
    /// Peaks attained so far, in the order of [`View`](super::tables::View).
    pub(in crate::solver) peak: [f64; 8],
    pub(in crate::solver) mode: Mode,
    pub(in crate::solver) start: Option<Start>,
    pub(in crate::solver) events: Vec<Event>,
    pub(in crate::solver) sliding: Sliding,
}

/// The run that a walk by blocks serves.
pub(in crate::solver) trait Host {
    /// Takes the long way through the rest of a sample after a time in it.
    fn long_way(&mut self, carry: &mut Carry, sample: usize, from_s: f64)
    -> Result<(), SolveError>;

    /// Whether a history is wanted.
    fn records(&self) -> bool;

    /// Records a state at a sample as a row of the history.
    fn record_row(&mut self, x: &[f64; 4], mode: Mode, sample: usize);

    /// Records one side of an event at a time after a sample.
    fn record_event(&mut self, carry: &Carry, sample: usize, at_s: f64);
}

/// Evenly spaced samples under a constant normal force.
pub(in crate::solver) struct Ground<'a> {
    pub(in crate::solver) times_s: &'a [f64],
    /// `a = Ü + g sin θ` at the samples.
    pub(in crate::solver) acceleration: &'a [f64],
    /// `|g sin θ|`.
    pub(in crate::solver) slope_size: f64,
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
    pub(super) host: &'w mut dyn Host,
    pub(super) carry: &'w mut Carry,
    pub(super) candidates: Candidates,
    /// Peaks attained so far; those of `carry` are behind.
    pub(super) peak: f64x8<S>,
    pub(super) records: bool,
}

impl<'w, S: Simd> Walk<'w, S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        (tables, windows): (&'w Tables, &'w Windows),
        ground: &'w Ground<'w>,
        host: &'w mut dyn Host,
        carry: &'w mut Carry,
    ) -> Self {
        Self {
            simd,
            tables,
            windows,
            ground,
            records: host.records(),
            host,
            candidates: Candidates::default(),
            peak: f64x8::load_array(simd, carry.peak),
            carry,
        }
    }

    /// Walks from a sample to the end of the evenly spaced samples.
    #[inline(always)]
    pub(super) fn go(&mut self, mut sample: usize, end: usize) -> Result<(), SolveError> {
        while sample < end {
            sample = match self.carry.mode {
                Mode::Slip(_) if self.is_due() => sample,
                Mode::Slip(direction) => self.slide(sample, end, direction),
                Mode::Stick => self.hold(sample, end),
            };
            if sample < end {
                self.step(sample)?;
                sample += 1;
            }
        }
        self.settle();
        self.carry.peak = self.peak.to_array();
        Ok(())
    }

    /// Whether a slip has just started, or a stop is still to be decided.
    #[inline(always)]
    pub(super) fn is_due(&self) -> bool {
        self.carry.start.is_some() || (self.carry.mode != Mode::Stick && self.carry.x[1] == 0.0)
    }

    /// The long way through the rest of a sample.
    #[inline(never)]
    pub(super) fn long_way(&mut self, sample: usize, from_s: f64) -> Result<(), SolveError> {
        self.carry.peak = self.peak.to_array();
        let result = self.host.long_way(self.carry, sample, from_s);
        self.peak = f64x8::load_array(self.simd, self.carry.peak);
        result
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
        let taps = &phase.tap;
        let mut load = times4(simd, &phase.first[k], a[0]);
        if SLIP {
            load = load + times4(simd, &phase.force[k], force);
        }
        if k == BLOCK {
            // Two sums, that neither has to wait for the other.
            let odd = (times4(simd, &taps[7], a[1]) + times4(simd, &taps[5], a[3]))
                + (times4(simd, &taps[3], a[5]) + times4(simd, &taps[1], a[7]));
            let even = (times4(simd, &taps[6], a[2]) + times4(simd, &taps[4], a[4]))
                + (times4(simd, &taps[2], a[6]) + times4(simd, &taps[0], a[8]));
            load = load + (odd + even);
        } else {
            for m in 1..=k {
                load = load + times4(simd, &taps[k - m], a[m]);
            }
        }
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
            load = load + times8(simd, &row.force, force);
        }
        combine8(simd, &row.state, x) + load
    }

    /// The tracked quantities in a state under an acceleration and a friction force.
    #[inline(always)]
    pub(super) fn view<const SLIP: bool>(&self, x: [f64; 4], a: f64, force: f64) -> f64x8<S> {
        let (simd, view) = (self.simd, &self.phase::<SLIP>().view);
        let f = self.tables.plant.restoring(&x);
        let input = if SLIP {
            times8(simd, &view.of_force, force)
        } else {
            times8(simd, &view.of_acceleration, a)
        };
        combine8(simd, &view.columns, [x[0], x[1], x[2], f]) + (input - view.slope.load(simd))
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
        let a = self.block_at(sample);
        for k in 0..steps {
            let x = self.end::<SLIP>(k, x, a, force).to_array();
            self.host.record_row(&x, self.carry.mode, sample + k);
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
