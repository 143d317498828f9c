//! Hands a run to the walk by blocks and back.

use super::Run;
use crate::error::SolveError;
use crate::friction::Direction;
use crate::linear::{PerStorey, State};
use crate::response::Mode;
use crate::solver::blocks::{self, ACCELERATION, Blocks, Carry, DISPLACEMENT, Ground, Host};
use crate::solver::extremes::tracked;
use crate::solver::recorder::Recorder;

impl<V: PerStorey, R: Recorder<V>> Run<'_, V, R> {
    /// Walks by blocks from a sample to the end of the evenly spaced samples, which are `end`.
    pub(super) fn by_blocks(
        &mut self,
        blocks: Blocks<'_>,
        sample: usize,
        end: usize,
    ) -> Result<(), SolveError> {
        let excitation = self.excitation;
        let normal = excitation.normal_at_sample(0).max(0.0);
        let ground = Ground {
            times_s: excitation.times_s,
            acceleration: &excitation.acceleration,
            slope_size: self.extremes.slope().abs(),
            bounds: excitation.bounds().map(|bound| bound * normal),
            kinetic: [Direction::Positive, Direction::Negative]
                .map(|d| excitation.kinetic(d) * normal),
        };
        let mut carry = Carry {
            x: [0.0; 4],
            peak: [0.0; 8],
            mode: self.mode,
            start: self.start,
            events: Vec::new(),
            sliding: self.sliding,
        };
        self.give(&mut carry);
        let result = blocks::walk(blocks, &ground, self, &mut carry, sample, end);
        self.take(&mut carry);
        result
    }

    /// Gives what both ways share to the walk by blocks.
    fn give(&mut self, carry: &mut Carry) {
        let state = self.state.0.as_ref();
        carry.x[..state.len()].copy_from_slice(state);
        let peak = self.extremes.peak.as_ref();
        carry.peak[..tracked::STOREYS].copy_from_slice(&peak[..tracked::STOREYS]);
        if let [displacement, _, acceleration] = peak[tracked::STOREYS..] {
            (carry.peak[DISPLACEMENT], carry.peak[ACCELERATION]) = (displacement, acceleration);
        }
        (carry.mode, carry.start, carry.sliding) = (self.mode, self.start, self.sliding);
        core::mem::swap(&mut carry.events, &mut self.events);
    }

    /// Takes it back.
    fn take(&mut self, carry: &mut Carry) {
        self.set_state(&carry.x);
        let peak = self.extremes.peak.as_mut();
        peak[..tracked::STOREYS].copy_from_slice(&carry.peak[..tracked::STOREYS]);
        if let [displacement, drift, acceleration] = &mut peak[tracked::STOREYS..] {
            (*displacement, *drift) = (carry.peak[DISPLACEMENT], carry.peak[DISPLACEMENT]);
            *acceleration = carry.peak[ACCELERATION];
        }
        (self.mode, self.start, self.sliding) = (carry.mode, carry.start, carry.sliding);
        core::mem::swap(&mut carry.events, &mut self.events);
    }

    fn set_state(&mut self, x: &[f64; 4]) {
        let state = self.state.0.as_mut();
        let count = state.len();
        state.copy_from_slice(&x[..count]);
    }
}

impl<V: PerStorey, R: Recorder<V>> Host for Run<'_, V, R> {
    fn long_way(
        &mut self,
        carry: &mut Carry,
        sample: usize,
        from_s: f64,
    ) -> Result<(), SolveError> {
        self.take(carry);
        self.events_in_interval = 0;
        let result = self.long_way_from(sample, from_s);
        self.give(carry);
        result
    }

    fn records(&self) -> bool {
        R::WANTED
    }

    fn record_row(&mut self, x: &[f64; 4], mode: Mode, sample: usize) {
        let mut state = State::<V>::zeros(self.system.storeys());
        let count = state.0.as_ref().len();
        state.0.as_mut().copy_from_slice(&x[..count]);
        self.record_at(&state, sample, mode, true);
    }

    fn record_event(&mut self, carry: &Carry, sample: usize, at_s: f64) {
        self.set_state(&carry.x);
        let times_s = self.excitation.times_s;
        let length_s = times_s[sample + 1] - times_s[sample];
        let stretch = self.excitation.stretch(sample, 0.0, length_s);
        self.record(&stretch, at_s, carry.mode, false);
    }
}
