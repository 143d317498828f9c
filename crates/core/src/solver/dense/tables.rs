//! What a block needs to know of a system and a time step, made once.
//!
//! All tables hold the state in the order `s, ṡ, η, η̇`; a rigid block has zeros for the structure.
//! They depend neither on friction nor on the motion.

use fearless_simd::prelude::*;

use super::lanes::{BLOCK, Eight, Four};
use super::plant::{Plant, unit};
use super::series::{self, Table};
use super::view::View;
pub(super) use crate::linear::QUIET;
use crate::linear::System;
use crate::solver::outputs::OutputRow;

/// Orders of the series, for a rate times a piece of [`MAX_RATE_STEP`] at most: the first term left out is
/// below 3e-17 of the largest.
pub(super) const ORDERS: usize = 12;

/// Largest rate times piece.
const MAX_RATE_STEP: f64 = 0.3;

/// Largest rate times step: beyond, bounds by the energy norm alone cost more than they save.
const MOST_RATE_STEP: f64 = 0.65;

/// Tables of a system and a step.
#[derive(Debug)]
pub(in crate::solver) struct Tables {
    pub(super) plant: Plant,
    /// Equal pieces into which a sample is cut for its Taylor series.
    pub(super) pieces: usize,
    pub(super) piece_s: f64,
    pub(super) stick: Phase,
    pub(super) slip: Phase,
    pub(super) quiet: Quiet,
    /// `Φ`, and what `f` and the block's acceleration add to the overturning moment.
    pub(super) shape: f64,
    pub(super) arm: [f64; 2],
    pub(super) slope: f64,
}

/// Tables of stick or slip.
#[derive(Debug)]
pub(super) struct Phase {
    pub(super) series: Table,
    /// `E^k`, column by column.
    pub(super) power: [[Four; 4]; BLOCK + 1],
    /// What a unit of acceleration at the first sample leaves after `k`.
    pub(super) first: [Four; BLOCK + 1],
    /// What a unit of acceleration at a sample leaves `j − 8` samples later, zeros before it.
    pub(super) tap: [Four; 2 * BLOCK],
    /// What a unit of friction force leaves after `k` samples.
    pub(super) force: [Four; BLOCK + 1],
    /// The same for one value at all samples of a block: `s`, `ṡ`, `η`, `f`, `η̇`; in stick the demand
    /// without the spring's part in the place of `s`.
    pub(super) rows: [Row; 5],
    /// The tracked quantities.
    pub(super) view: View,
    /// What is watched on the way.
    pub(super) gates: Gates,
}

/// What is watched from block to block: `ṡ`, `η`, `f` and the block's acceleration `u`. Nearly all
/// tracked quantities follow from one of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gates {
    /// They are the sum of these times the state and the input: the friction force in slip, the
    /// acceleration in stick.
    pub(super) columns: [Four; 4],
    pub(super) of_input: Four,
    /// Sizes of the columns.
    pub(super) sizes: [Four; 4],
    pub(super) bend: Bend,
}

/// One value at the samples `1 … 8` after a state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) state: [Eight; 4],
    pub(super) first: Eight,
    pub(super) tap: [Eight; BLOCK],
    pub(super) force: Eight,
}

/// Bound on what a chord hides of the gates: the sum of these times the norm of the state at the
/// start, the largest acceleration, its largest rate, and the friction force. In slip a chord spans
/// a block, in stick a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    pub(super) of_norm: Four,
    pub(super) of_acceleration: Four,
    pub(super) of_rate: Four,
    pub(super) of_force: Four,
}

/// Stick over many samples.
#[derive(Debug)]
pub(super) struct Quiet {
    pub(super) power: [Four; 4],
    pub(super) first: Four,
    pub(super) tap: [Four; QUIET],
    /// Bounds over a block and over the stretch on the size of the demand without the spring's part,
    /// of `η`, `f` and `a`: of the norm of the state at the start, and of the largest acceleration.
    pub(super) of_norm: Four,
    pub(super) of_acceleration: [Four; 2],
}

impl Tables {
    /// Tables of a system with at most one storey, unless the step is too long for its rates.
    #[inline(always)]
    pub(in crate::solver) fn new<S: Simd>(
        simd: S,
        system: &System,
        (arm, slope): ([f64; 2], f64),
        rows: [&[OutputRow]; 2],
        dt_s: f64,
    ) -> Option<Box<Self>> {
        let pieces = (dt_s * system.slip_rate_rad_per_s / MAX_RATE_STEP).ceil().max(1.0);
        if !(system.storeys <= 1
            && system.damper_n_s_per_m >= 0.0
            && dt_s * system.slip_rate_rad_per_s <= MOST_RATE_STEP)
        {
            return None;
        }
        // Filled in place: they are too large to be moved about.
        let mut tables = Box::new(Self::EMPTY);
        tables.plant = Plant::new(system);
        (tables.pieces, tables.piece_s) = (pieces as usize, dt_s / pieces);
        tables.shape = if system.storeys == 1 { system.floor(0)[0] } else { 0.0 };
        (tables.arm, tables.slope) = (arm, slope);
        simd.vectorize(
            #[inline(always)]
            || tables.fill(dt_s, rows),
        );
        Some(tables)
    }

    #[inline(always)]
    fn fill(&mut self, dt_s: f64, rows: [&[OutputRow]; 2]) {
        let Self { plant, pieces, piece_s, stick, slip, quiet, shape, arm, .. } = self;
        let mut taps = [Four::ZERO; BLOCK + 1];
        for (is_slip, phase) in [(true, slip), (false, &mut *stick)] {
            series::fill(plant, is_slip, *piece_s, &mut phase.series);
            let sample = Sample::new(&phase.series, is_slip, *pieces);
            sample.taps(&mut taps);
            phase.fill(plant, is_slip, &sample, &taps);
            phase.view = View::new(rows[usize::from(is_slip)], plant, is_slip, (*shape, *arm));
            phase.gates = Gates::new(plant, is_slip, dt_s);
        }
        quiet.fill(plant, stick, &taps, dt_s);
    }

    const EMPTY: Self = Self {
        plant: Plant {
            block_mass_kg: 0.0,
            per_block_mass: 0.0,
            stiffness_n_per_m: 0.0,
            damper_n_s_per_m: 0.0,
            omega2: 0.0,
            decay: 0.0,
            participation: 0.0,
            root_mass: 0.0,
            per_root_block: 0.0,
        },
        pieces: 0,
        piece_s: 0.0,
        stick: Phase::EMPTY,
        slip: Phase::EMPTY,
        quiet: Quiet {
            power: [Four::ZERO; 4],
            first: Four::ZERO,
            tap: [Four::ZERO; QUIET],
            of_norm: Four::ZERO,
            of_acceleration: [Four::ZERO; 2],
        },
        shape: 0.0,
        arm: [0.0; 2],
        slope: 0.0,
    };
}

type Matrix = [[f64; 4]; 4];

/// What unit inputs leave at the end of one sample: of the state, of a constant acceleration, of
/// one that rises from 0 to 1, of a friction force.
struct Sample {
    state: Matrix,
    constant: [f64; 4],
    ramp: [f64; 4],
    force: [f64; 4],
}

impl Phase {
    const EMPTY: Self = {
        let zeros = [Four::ZERO; 4];
        let row = Row {
            state: [Eight::ZERO; 4],
            first: Eight::ZERO,
            tap: [Eight::ZERO; BLOCK],
            force: Eight::ZERO,
        };
        Self {
            series: series::EMPTY,
            power: [zeros; BLOCK + 1],
            first: [Four::ZERO; BLOCK + 1],
            tap: [Four::ZERO; 2 * BLOCK],
            force: [Four::ZERO; BLOCK + 1],
            rows: [row; 5],
            view: View {
                columns: [Eight::ZERO; 4],
                of_acceleration: Eight::ZERO,
                of_force: Eight::ZERO,
                constant: Eight::ZERO,
                of_gates: [Eight::ZERO; 4],
            },
            gates: Gates {
                columns: zeros,
                of_input: Four::ZERO,
                sizes: zeros,
                bend: Bend {
                    of_norm: Four::ZERO,
                    of_acceleration: Four::ZERO,
                    of_rate: Four::ZERO,
                    of_force: Four::ZERO,
                },
            },
        }
    };

    #[inline(always)]
    fn fill(&mut self, plant: &Plant, slip: bool, sample: &Sample, taps: &[Four; BLOCK + 1]) {
        self.tap[BLOCK..].copy_from_slice(&taps[..BLOCK]);
        for j in 0..4 {
            self.power[0][j] = Four(unit(j));
        }
        for k in 1..=BLOCK {
            for j in 0..4 {
                self.power[k][j] = Four(times(&sample.state, self.power[k - 1][j].0));
            }
            self.first[k] = Four(match k {
                1 => sample.before(),
                _ => times(&sample.state, self.first[k - 1].0),
            });
            self.force[k] = Four(times(&sample.state, self.force[k - 1].0));
            for i in 0..4 {
                self.force[k].0[i] += sample.force[i];
            }
        }
        let values = |column: &Four| {
            let [s, w, eta, rate] = column.0;
            let f = plant.restoring(&column.0);
            [if slip { s } else { -plant.participation * f }, w, eta, f, rate]
        };
        for k in 1..=BLOCK {
            let state = self.power[k].map(|column| values(&column));
            let (first, force) = (values(&self.first[k]), values(&self.force[k]));
            for (i, row) in self.rows.iter_mut().enumerate() {
                for j in 0..4 {
                    row.state[j].0[k - 1] = state[j][i];
                }
                (row.first.0[k - 1], row.force.0[k - 1]) = (first[i], force[i]);
            }
        }
        // What a sample leaves at those before it, at itself and after it.
        let mut left = [[0.0; 2 * BLOCK]; 5];
        for (j, tap) in taps[..BLOCK].iter().enumerate() {
            for (left, value) in left.iter_mut().zip(values(tap)) {
                left[BLOCK - 1 + j] = value;
            }
        }
        if !slip {
            left[0][BLOCK - 1] += plant.block_mass_kg;
        }
        for (row, left) in self.rows.iter_mut().zip(&left) {
            for (m, tap) in row.tap.iter_mut().enumerate() {
                tap.0.copy_from_slice(&left[BLOCK - 1 - m..][..BLOCK]);
            }
        }
    }
}

impl Gates {
    #[inline(always)]
    fn new(plant: &Plant, slip: bool, dt_s: f64) -> Self {
        let span_s = if slip { BLOCK as f64 * dt_s } else { dt_s };
        let f = [0.0, 0.0, plant.omega2, plant.decay];
        let share = plant.participation * plant.per_block_mass;
        let u = [
            -plant.stiffness_n_per_m * plant.per_block_mass,
            -plant.damper_n_s_per_m * plant.per_block_mass,
            share * f[2],
            share * f[3],
        ];
        let u = if slip { u } else { [0.0; 4] };
        let rows = [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], f, u];
        let columns: [Four; 4] =
            core::array::from_fn(|i| Four(core::array::from_fn(|j| rows[j][i])));
        let [of_norm, of_acceleration, of_rate, of_force] =
            bend(plant, slip, &rows, [span_s, dt_s]).map(Four);
        Self {
            columns,
            of_input: Four([0.0, 0.0, 0.0, if slip { plant.per_block_mass } else { 1.0 }]),
            sizes: columns.map(|column| Four(column.0.map(f64::abs))),
            bend: Bend { of_norm, of_acceleration, of_rate, of_force },
        }
    }
}

/// [`Bend`] of some rows over chords of `span_s` within a block: `g″` of `g = c·x` is
/// `c A² x + c A b a + c A d T + c b ȧ`, and the norm of the state grows in the block by no more
/// than its duration times `√M_tot |a| + |T|/√M1`.
#[inline(always)]
fn bend(
    plant: &Plant,
    slip: bool,
    rows: &[[f64; 4]; 4],
    [span_s, dt_s]: [f64; 2],
) -> [[f64; 4]; 4] {
    let a: Matrix = core::array::from_fn(|j| plant.rate(slip, unit(j), 0.0, 0.0));
    let on_a = plant.rate(slip, [0.0; 4], 1.0, 0.0);
    let on_force = if slip { plant.rate(slip, [0.0; 4], 0.0, 1.0) } else { [0.0; 4] };
    let reach = 0.125 * span_s * span_s;
    let block_s = BLOCK as f64 * dt_s;
    let growth = if slip { plant.root_mass } else { plant.participation };
    let mut bend = [[0.0; 4]; 4];
    for (j, row) in rows.iter().enumerate() {
        let once: [f64; 4] = core::array::from_fn(|i| dot(row, &a[i]));
        let twice: [f64; 4] = core::array::from_fn(|i| dot(&once, &a[i]));
        let on_norm = plant.dual_norm(slip, twice);
        bend[0][j] = reach * on_norm;
        bend[1][j] = reach * (dot(&once, &on_a).abs() + on_norm * (block_s * growth));
        bend[2][j] = reach * dot(row, &on_a).abs();
        bend[3][j] =
            reach * (dot(&once, &on_force).abs() + on_norm * (block_s * plant.per_root_block));
    }
    bend
}

impl Quiet {
    #[inline(always)]
    fn fill(&mut self, plant: &Plant, stick: &Phase, taps: &[Four; BLOCK + 1], dt_s: f64) {
        let square = |m: &Matrix| -> Matrix { core::array::from_fn(|j| times(m, m[j])) };
        let by_8 = stick.power[BLOCK].map(|c| c.0);
        let by_16 = square(&by_8);
        self.power = square(&by_16).map(Four);
        // The first sample's ramp down has the whole stretch before it.
        self.first = Four(times(&by_16, times(&by_8, stick.first[BLOCK].0)));
        self.tap[..=BLOCK].copy_from_slice(taps);
        // From the sample after it on what a unit has left moves on by itself.
        for j in BLOCK + 1..QUIET {
            self.tap[j] = Four(times(&by_8, self.tap[j - BLOCK].0));
        }
        let of_f = plant.dual_norm(false, [0.0, 0.0, plant.omega2, plant.decay]);
        let of_eta = plant.dual_norm(false, unit(2));
        let of_norm = [plant.participation * of_f, of_eta, of_f, 0.0];
        self.of_norm = Four(of_norm);
        for (of_acceleration, samples) in self.of_acceleration.iter_mut().zip([BLOCK, QUIET]) {
            let growth = samples as f64 * dt_s * plant.participation;
            *of_acceleration = Four(of_norm.map(|of_norm| of_norm * growth));
            of_acceleration.0[0] += plant.block_mass_kg;
            of_acceleration.0[3] = 1.0;
        }
    }
}

impl Sample {
    #[inline(always)]
    fn new(series: &Table, slip: bool, pieces: usize) -> Self {
        let sum = |input: usize| series::sum(series, input);
        let mut piece: Matrix = core::array::from_fn(sum);
        for (j, column) in piece.iter_mut().enumerate() {
            column[j] += 1.0;
        }
        let (of_a, of_change) = (sum(4), sum(5));
        let of_force = if slip { sum(6) } else { [0.0; 4] };
        let per_piece = 1.0 / pieces as f64;
        let run = |mut x: [f64; 4], a: [f64; 2], force: f64| {
            for i in 0..pieces {
                let start = a[0] + (a[1] - a[0]) * (per_piece * i as f64);
                let change = (a[1] - a[0]) * per_piece;
                let moved = times(&piece, x);
                x = core::array::from_fn(|i| {
                    moved[i] + (of_a[i] * start + of_change[i] * change) + of_force[i] * force
                });
            }
            x
        };
        Self {
            state: core::array::from_fn(|j| {
                if pieces == 1 { piece[j] } else { run(unit(j), [0.0; 2], 0.0) }
            }),
            constant: run([0.0; 4], [1.0, 1.0], 0.0),
            ramp: run([0.0; 4], [0.0, 1.0], 0.0),
            force: run([0.0; 4], [0.0; 2], 1.0),
        }
    }

    /// What a unit of acceleration that ramps down in a sample leaves.
    #[inline(always)]
    fn before(&self) -> [f64; 4] {
        core::array::from_fn(|i| self.constant[i] - self.ramp[i])
    }

    /// What a unit at a sample leaves behind: it ramps up before and down in the next sample.
    #[inline(always)]
    fn taps(&self, taps: &mut [Four; BLOCK + 1]) {
        taps[0] = Four(self.ramp);
        for j in 1..=BLOCK {
            taps[j] = Four(times(&self.state, taps[j - 1].0));
            if j == 1 {
                let before = self.before();
                for i in 0..4 {
                    taps[1].0[i] += before[i];
                }
            }
        }
    }
}

#[inline(always)]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

#[inline(always)]
fn times(columns: &Matrix, x: [f64; 4]) -> [f64; 4] {
    core::array::from_fn(|i| {
        (columns[0][i] * x[0] + columns[1][i] * x[1])
            + (columns[2][i] * x[2] + columns[3][i] * x[3])
    })
}
