//! The state of a walk by blocks, and what its steps share.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::lanes::{BLOCK, Eight, Four, combine4, combine8};
use super::peaks::Candidates;
use super::tables::{ACCELERATION, DISPLACEMENT, Phase, Row, Tables};
use super::windows::Windows;
use crate::error::SolveError;
use crate::friction::Direction;
use crate::linear::PerStorey;
use crate::response::Mode;
use crate::solver::exact::Run;
use crate::solver::extremes::tracked;
use crate::solver::recorder::Recorder;

/// A walk through evenly spaced samples under a constant normal force.
pub(super) struct Walk<'w, 'a, V: PerStorey, R, S: Simd> {
    pub(super) simd: S,
    pub(super) tables: &'w Tables,
    pub(super) windows: &'w Windows,
    pub(super) run: &'w mut Run<'a, V, R>,
    pub(super) acceleration: &'a [f64],
    /// The state; that of the run is behind.
    pub(super) x: [f64; 4],
    /// Peaks attained so far; those of the run are behind.
    pub(super) peak: f64x8<S>,
    pub(super) candidates: &'w mut Candidates,
    /// `|g sin θ|`.
    pub(super) slope_size: f64,
    /// Static bounds in N, and kinetic friction for sliding towards +x and −x.
    pub(super) bounds: [f64; 2],
    pub(super) kinetic: [f64; 2],
}

impl<'w, 'a, V: PerStorey, R: Recorder<V>, S: Simd> Walk<'w, 'a, V, R, S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        tables: &'w Tables,
        windows: &'w Windows,
        candidates: &'w mut Candidates,
        run: &'w mut Run<'a, V, R>,
    ) -> Self {
        let excitation = run.excitation;
        let normal = excitation.normal_at_sample(0).max(0.0);
        let mut walk = Self {
            simd,
            tables,
            windows,
            acceleration: &excitation.acceleration,
            x: [0.0; 4],
            peak: f64x8::splat(simd, 0.0),
            candidates,
            slope_size: run.extremes.slope().abs(),
            bounds: excitation.bounds().map(|bound| bound * normal),
            kinetic: [Direction::Positive, Direction::Negative]
                .map(|d| excitation.kinetic(d) * normal),
            run,
        };
        walk.take_over();
        walk
    }

    /// Walks from a sample to the end of the evenly spaced samples.
    #[inline(always)]
    pub(super) fn go(&mut self, mut sample: usize, end: usize) -> Result<(), SolveError> {
        while sample < end {
            let pending = self.run.start.is_some();
            sample = match self.run.mode {
                Mode::Slip(_) if pending || self.x[1] == 0.0 => sample,
                Mode::Slip(direction) => self.slide(sample, end, direction),
                Mode::Stick => self.hold(sample, end),
            };
            if sample < end {
                self.step(sample)?;
                sample += 1;
            }
        }
        self.hand_back();
        Ok(())
    }

    /// Reads state and peaks of the run, and takes the values at this instant for attained.
    pub(super) fn take_over(&mut self) {
        let state = self.run.state.0.as_ref();
        self.x = match *state {
            [s, w, eta, eta_dot] => [s, w, eta, eta_dot],
            _ => [state[0], state[1], 0.0, 0.0],
        };
        let of_run = self.run.extremes.peak.as_ref();
        let mut peak = [0.0; 8];
        peak[..tracked::STOREYS].copy_from_slice(&of_run[..tracked::STOREYS]);
        if let [displacement, _, acceleration] = of_run[tracked::STOREYS..] {
            (peak[DISPLACEMENT], peak[ACCELERATION]) = (displacement, acceleration);
        }
        self.peak = f64x8::load_array(self.simd, peak);
    }

    /// Gives state and peaks back to the run.
    pub(super) fn hand_back(&mut self) {
        self.write_state();
        let peak = self.peak.to_array();
        let of_run = self.run.extremes.peak.as_mut();
        of_run[..tracked::STOREYS].copy_from_slice(&peak[..tracked::STOREYS]);
        if let [displacement, drift, acceleration] = &mut of_run[tracked::STOREYS..] {
            (*displacement, *drift) = (peak[DISPLACEMENT], peak[DISPLACEMENT]);
            *acceleration = peak[ACCELERATION];
        }
    }

    /// Gives the state back to the run.
    #[inline(always)]
    pub(super) fn write_state(&mut self) {
        let state = self.run.state.0.as_mut();
        let storeys = state.len();
        state.copy_from_slice(&self.x[..storeys]);
    }

    /// Friction force of sliding in a direction, in N.
    #[inline(always)]
    pub(super) fn force(&self, direction: Direction) -> f64 {
        self.kinetic[if direction == Direction::Positive { 0 } else { 1 }]
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
        let splat = |x: f64| f64x4::splat(simd, x);
        let tap = |m: usize| phase.tap[k - m].load(simd) * splat(a[m]);
        let mut load = phase.first[k].load(simd) * splat(a[0]);
        if SLIP {
            load = load + phase.force[k].load(simd) * splat(force);
        }
        if k == BLOCK {
            // Two sums, that neither has to wait for the other.
            let odd = (tap(1) + tap(3)) + (tap(5) + tap(7));
            let even = (tap(2) + tap(4)) + (tap(6) + tap(8));
            load = load + (odd + even);
        } else {
            for m in 1..=k {
                load = load + tap(m);
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
        let times = |column: &Eight, x: f64| column.load(simd) * f64x8::splat(simd, x);
        let tap = |m: usize| times(&row.tap[m - 1], a[m]);
        let odd = (tap(1) + tap(3)) + (tap(5) + tap(7));
        let even = (tap(2) + tap(4)) + (tap(6) + tap(8));
        let mut load = times(&row.first, a[0]) + (odd + even);
        if SLIP {
            load = load + times(&row.force, force);
        }
        combine8(simd, &row.state, x) + load
    }

    /// The tracked quantities in a state under an acceleration and a friction force.
    #[inline(always)]
    pub(super) fn view<const SLIP: bool>(&self, x: [f64; 4], a: f64, force: f64) -> f64x8<S> {
        let (simd, view) = (self.simd, &self.phase::<SLIP>().view);
        let f = self.tables.plant.restoring(&x);
        let input = if SLIP {
            view.of_force.load(simd) * f64x8::splat(simd, force)
        } else {
            view.of_acceleration.load(simd) * f64x8::splat(simd, a)
        };
        combine8(simd, &view.columns, [x[0], x[1], x[2], f]) + (input - view.slope.load(simd))
    }

    #[inline(always)]
    pub(super) fn phase<const SLIP: bool>(&self) -> &'w Phase {
        if SLIP { &self.tables.slip } else { &self.tables.stick }
    }

    /// Records samples of a block as rows of the history.
    #[inline(always)]
    pub(super) fn record_block<const SLIP: bool>(
        &mut self,
        sample: usize,
        steps: usize,
        x: f64x4<S>,
        force: f64,
    ) {
        if !R::WANTED {
            return;
        }
        let a = self.block_at(sample);
        for k in 0..steps {
            self.x = self.end::<SLIP>(k, x, a, force).to_array();
            self.write_state();
            self.run.record_sample(sample + k, self.run.mode, true);
        }
    }

    /// The accelerations that a block from a sample touches; zeros where the motion has ended.
    #[inline(always)]
    pub(super) fn block_at(&self, sample: usize) -> &'a [f64; BLOCK + 1] {
        self.acceleration[sample..].first_chunk().unwrap_or(&[0.0; BLOCK + 1])
    }

    /// The state as a vector.
    #[inline(always)]
    pub(super) fn state(&self) -> f64x4<S> {
        Four(self.x).load(self.simd)
    }
}
