//! What a batch and a sample need to know of a linear system and a step, made once.
//!
//! A batch is the sum of the maps in [`maps`](crate::linear::Maps), here with a number of columns that the
//! compiler knows:
//!
//! ```text
//! x_{i+k} = E^k x_i + first_k a_i + Σ_{m=1..k} tap_{k−m} a_{i+m} + force_k T
//! ```

use fearless_simd::prelude::*;

use super::equations::{OneStorey, unit};
use super::lanes::{BATCH, Eight, Five, Four};
use super::outputs::{Gates, Outputs, Shape};
use super::series::{PIECE_RATE, SeriesTable};
use crate::linear::{QUIET, System};
use crate::solver::outputs::OutputRow;

/// Largest rate times step: beyond, the bounds of the general way save more than its tables cost.
const STEP_RATE: f64 = 0.65;

/// Tables of a system with one storey or none and a step. They depend neither on friction nor on the
/// motion.
#[derive(Debug)]
pub(in crate::solver) struct Tables {
    pub(super) storey: OneStorey,
    pub(super) shape: Shape,
    /// Equal pieces into which a sample is cut for its Taylor series.
    pub(super) pieces: usize,
    /// Length of a batch.
    pub(super) batch_s: f64,
    pub(super) stick: Phase,
    pub(super) slip: Phase,
    pub(super) quiet: Quiet,
}

/// Tables of stick or slip.
#[derive(Debug)]
pub(super) struct Phase {
    pub(super) series: SeriesTable,
    /// `E^k`, column by column.
    pub(super) power: [[Four; 4]; BATCH + 1],
    /// What a unit of acceleration at the first sample leaves after `k`.
    pub(super) first: [Four; BATCH + 1],
    /// What a unit of acceleration at a sample leaves `j − 8` samples later, zeros before it.
    pub(super) tap: [Four; 2 * BATCH],
    /// What a unit of friction force leaves after `k` samples.
    pub(super) force: [Four; BATCH + 1],
    /// `s` (in stick the demand without the spring's part), `ṡ, η, f, η̇` at the samples of a batch.
    pub(super) rows: [Row; 5],
    pub(super) outputs: Outputs,
    pub(super) gates: Gates,
}

/// One number at the samples `1 … 8` after a state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) state: [Eight; 4],
    pub(super) first: Eight,
    pub(super) tap: [Eight; BATCH],
    pub(super) force: Eight,
}

/// Stick over many samples.
#[derive(Debug)]
pub(super) struct Quiet {
    pub(super) power: [Four; 4],
    pub(super) first: Four,
    /// What a unit of acceleration at each sample after the first leaves of `η` and of `η̇`.
    pub(super) taps: [[Eight; QUIET / BATCH]; 2],
    /// Bounds on the sizes of the demand without the spring's part, of `η`, `f`, `a` and `η̇`: of the amplitude at
    /// the start, and of the largest acceleration in a batch and in all the samples.
    pub(super) of_amplitude: Five,
    pub(super) of_acceleration: [Five; 2],
}

impl Tables {
    /// Tables for the outputs of stick and slip, unless the step is too long for the system's rates.
    #[inline(always)]
    pub(in crate::solver) fn new<S: Simd>(
        simd: S,
        system: &System,
        shape: Shape,
        rows: [&[OutputRow]; 2],
        dt_s: f64,
    ) -> Option<Box<Self>> {
        let rate = dt_s * system.slip_rate_rad_per_s;
        if !(system.storeys <= 1 && system.damper_n_s_per_m >= 0.0 && rate <= STEP_RATE) {
            return None;
        }
        let pieces = (rate / PIECE_RATE).ceil().max(1.0);
        // Filled in place: they are too large to be moved about.
        let mut tables = Box::new(Self::EMPTY);
        (tables.storey, tables.shape) = (OneStorey::new(system), shape);
        (tables.pieces, tables.batch_s) = (pieces as usize, BATCH as f64 * dt_s);
        simd.vectorize(
            #[inline(always)]
            || tables.fill(system, rows, dt_s),
        );
        Some(tables)
    }

    #[inline(always)]
    fn fill(&mut self, system: &System, rows: [&[OutputRow]; 2], dt_s: f64) {
        let Self { storey, pieces, stick, slip, quiet, shape, .. } = self;
        let mut taps = [Four::ZERO; BATCH + 1];
        for (is_slip, phase) in [(true, slip), (false, &mut *stick)] {
            phase.series.fill(storey, is_slip, dt_s / *pieces as f64);
            let sample = Sample::new(&phase.series, is_slip, *pieces);
            sample.taps(&mut taps);
            phase.fill(storey, is_slip, &sample, &taps);
            phase.outputs.fill(rows[usize::from(is_slip)], storey, is_slip, shape);
            phase.gates = Gates::new(system, storey, is_slip, dt_s);
        }
        quiet.fill(system, storey, stick, &taps, dt_s);
    }

    const EMPTY: Self = Self {
        storey: OneStorey::NONE,
        shape: Shape { floor: 0.0, arms: [0.0; 2], slope: 0.0 },
        pieces: 0,
        batch_s: 0.0,
        stick: Phase::EMPTY,
        slip: Phase::EMPTY,
        quiet: Quiet {
            power: [Four::ZERO; 4],
            first: Four::ZERO,
            taps: [[Eight::ZERO; QUIET / BATCH]; 2],
            of_amplitude: Five::ZERO,
            of_acceleration: [Five::ZERO; 2],
        },
    };
}

impl Phase {
    const EMPTY: Self = Self {
        series: SeriesTable::EMPTY,
        power: [[Four::ZERO; 4]; BATCH + 1],
        first: [Four::ZERO; BATCH + 1],
        tap: [Four::ZERO; 2 * BATCH],
        force: [Four::ZERO; BATCH + 1],
        rows: [Row {
            state: [Eight::ZERO; 4],
            first: Eight::ZERO,
            tap: [Eight::ZERO; BATCH],
            force: Eight::ZERO,
        }; 5],
        outputs: Outputs::EMPTY,
        gates: Gates::EMPTY,
    };

    #[inline(always)]
    fn fill(&mut self, storey: &OneStorey, slip: bool, sample: &Sample, taps: &[Four; BATCH + 1]) {
        self.tap[BATCH..].copy_from_slice(&taps[..BATCH]);
        for j in 0..4 {
            self.power[0][j] = Four(unit(j));
        }
        for k in 1..=BATCH {
            for j in 0..4 {
                self.power[k][j] = times(&sample.state, self.power[k - 1][j]);
            }
            self.first[k] =
                if k == 1 { sample.before() } else { times(&sample.state, self.first[k - 1]) };
            self.force[k] = sum(times(&sample.state, self.force[k - 1]), sample.force);
        }
        for k in 1..=BATCH {
            let (first, force) =
                (values(storey, slip, &self.first[k]), values(storey, slip, &self.force[k]));
            for (i, row) in self.rows.iter_mut().enumerate() {
                (row.first.0[k - 1], row.force.0[k - 1]) = (first[i], force[i]);
            }
            for j in 0..4 {
                let state = values(storey, slip, &self.power[k][j]);
                for (i, row) in self.rows.iter_mut().enumerate() {
                    row.state[j].0[k - 1] = state[i];
                }
            }
        }
        // What a sample leaves at those before it, at itself and after it.
        let mut left = [[0.0; 2 * BATCH]; 5];
        for (j, tap) in taps[..BATCH].iter().enumerate() {
            let values = values(storey, slip, tap);
            for (left, value) in left.iter_mut().zip(values) {
                left[BATCH - 1 + j] = value;
            }
        }
        if !slip {
            left[0][BATCH - 1] += storey.block_mass_kg;
        }
        for (row, left) in self.rows.iter_mut().zip(&left) {
            for (m, tap) in row.tap.iter_mut().enumerate() {
                tap.0.copy_from_slice(&left[BATCH - 1 - m..][..BATCH]);
            }
        }
    }
}

/// The numbers of [`Phase::rows`] in a state.
#[inline(always)]
fn values(storey: &OneStorey, slip: bool, x: &Four) -> [f64; 5] {
    let [s, w, eta, rate] = x.0;
    let f = storey.restoring(&x.0);
    [if slip { s } else { -storey.participation * f }, w, eta, f, rate]
}

impl Quiet {
    #[inline(always)]
    fn fill(
        &mut self,
        system: &System,
        storey: &OneStorey,
        stick: &Phase,
        taps: &[Four; BATCH + 1],
        dt_s: f64,
    ) {
        let by_8 = stick.power[BATCH];
        let mut by_16 = by_8;
        for column in &mut by_16 {
            *column = times(&by_8, *column);
        }
        self.power = by_16;
        for column in &mut self.power {
            *column = times(&by_16, *column);
        }
        // The first sample's ramp down has all the samples before it.
        self.first = times(&by_16, times(&by_8, stick.first[BATCH]));
        // From the sample after it on what a unit has left moves on by itself.
        let mut left = [Four::ZERO; QUIET];
        left[..=BATCH].copy_from_slice(taps);
        for j in BATCH + 1..QUIET {
            left[j] = times(&by_8, left[j - BATCH]);
        }
        for (j, left) in left.iter().rev().enumerate() {
            for (taps, of) in self.taps.iter_mut().zip([2, 3]) {
                taps[j / BATCH].0[j % BATCH] = left.0[of];
            }
        }
        let l = storey.participation.abs();
        let of_f = system.dual_norm(false, &[0.0, 0.0, storey.omega2, storey.decay]);
        let [of_eta, of_rate] = [2, 3].map(|i| system.dual_norm(false, &unit(i)));
        let of_amplitude = [l * of_f, of_eta, of_f, 0.0, of_rate];
        self.of_amplitude = Five::new(of_amplitude);
        // (k) The amplitude grows by no more than |L| ∫|a| dt.
        for (of_acceleration, samples) in self.of_acceleration.iter_mut().zip([BATCH, QUIET]) {
            let growth = samples as f64 * dt_s * l;
            let mut of = of_amplitude.map(|of| of * growth);
            of[0] += storey.block_mass_kg;
            of[3] = 1.0;
            *of_acceleration = Five::new(of);
        }
    }
}

/// Four columns.
type Matrix = [Four; 4];

/// What unit inputs leave at the end of one sample: of the state, of a constant acceleration, of one that
/// rises from 0 to 1, of a friction force.
struct Sample {
    state: Matrix,
    constant: Four,
    ramp: Four,
    force: Four,
}

impl Sample {
    #[inline(always)]
    fn new(table: &SeriesTable, slip: bool, pieces: usize) -> Self {
        let (of_a, of_change) = (Four(table.end(4)), Four(table.end(5)));
        let of_force = if slip { Four(table.end(6)) } else { Four::ZERO };
        let mut piece = [Four::ZERO; 4];
        for (j, column) in piece.iter_mut().enumerate() {
            *column = Four(table.end(j));
        }
        // State, constant and ramp of the acceleration, force.
        let mut left = [Four::ZERO; 7];
        for (j, x) in left[..4].iter_mut().enumerate() {
            x.0[j] = 1.0;
        }
        let mut inputs = [[0.0; 3]; 7];
        (inputs[4], inputs[5], inputs[6]) = ([1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        let per_piece = 1.0 / pieces as f64;
        for (x, [from, to, force]) in left.iter_mut().zip(inputs) {
            let change = (to - from) * per_piece;
            for i in 0..pieces {
                let (moved, a) = (times(&piece, *x), from + change * i as f64);
                for (i, x) in x.0.iter_mut().enumerate() {
                    *x = (moved.0[i] + (of_a.0[i] * a + of_change.0[i] * change))
                        + of_force.0[i] * force;
                }
            }
        }
        let [s, w, eta, rate, constant, ramp, force] = left;
        Self { state: [s, w, eta, rate], constant, ramp, force }
    }

    /// What a unit of acceleration that ramps down in a sample leaves.
    #[inline(always)]
    fn before(&self) -> Four {
        Four(core::array::from_fn(|i| self.constant.0[i] - self.ramp.0[i]))
    }

    /// What a unit at a sample leaves behind: it ramps up before and down in the next sample.
    #[inline(always)]
    fn taps(&self, taps: &mut [Four; BATCH + 1]) {
        taps[0] = self.ramp;
        taps[1] = sum(times(&self.state, taps[0]), self.before());
        for j in 2..=BATCH {
            taps[j] = times(&self.state, taps[j - 1]);
        }
    }
}

#[inline(always)]
fn sum(a: Four, b: Four) -> Four {
    Four(core::array::from_fn(|i| a.0[i] + b.0[i]))
}

#[inline(always)]
fn times(columns: &Matrix, x: Four) -> Four {
    let ([a, b, c, d], x) = (columns, x.0);
    Four(core::array::from_fn(|i| {
        (a.0[i] * x[0] + b.0[i] * x[1]) + (c.0[i] * x[2] + d.0[i] * x[3])
    }))
}
