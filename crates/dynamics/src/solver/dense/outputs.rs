//! The outputs of one storey or none, eight side by side, and the five numbers that bound them.
//!
//! Nearly every output follows from one of the *gates* `ṡ, η, f, u, η̇`: an output stays below its peak while
//! its gate stays within two limits. So a batch asks for five numbers where nothing is near a peak. Two
//! outputs stand behind several gates: with a damper the slider force in slip, and the overturning moment.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::equations::{OneStorey, unit};
use super::lanes::{Abreast, BATCH, Eight, Five, Four, combine4, larger, times8};
use crate::linear::{QUIET, System};
use crate::response::output::{self, Output};
use crate::solver::outputs::OutputRow;

/// Place of the storey's displacement, and drift, among the outputs.
pub(super) const DISPLACEMENT: usize = Output::Displacement(0).place(1);
/// Place of the floor's acceleration.
pub(super) const ACCELERATION: usize = Output::Acceleration(0).place(1);

/// Place of the storey's velocity.
pub(super) const RATE: usize = Output::DriftVelocity(0).place(1);

/// Registers of eight that the outputs take.
pub(in crate::solver) const REGISTERS: usize = Output::count(1, 0).div_ceil(8);

/// Outputs side by side.
pub(super) type Registers<S> = [f64x8<S>; REGISTERS];

/// What is kept of outputs, for each.
pub(in crate::solver) type Kept = [Eight; REGISTERS];

/// Each of them.
#[inline(always)]
pub(super) fn each(kept: &Kept) -> [f64; 8 * REGISTERS] {
    core::array::from_fn(|j| kept[j / 8].0[j % 8])
}

/// Registers made one by one.
#[inline(always)]
pub(super) fn by_register<S: Simd>(mut of: impl FnMut(usize) -> f64x8<S>) -> Registers<S> {
    // A loop has the vector instructions of what it stands in; a function of the library has none.
    let mut all = [of(0); REGISTERS];
    for (g, register) in all.iter_mut().enumerate().skip(1) {
        *register = of(g);
    }
    all
}

/// Outputs as they are kept.
#[inline(always)]
pub(super) fn kept<S: Simd>(outputs: Registers<S>) -> Kept {
    let mut kept = [Eight::ZERO; REGISTERS];
    for (kept, register) in kept.iter_mut().zip(&outputs) {
        register.store_slice(&mut kept.0);
    }
    kept
}

/// Outputs that have been kept.
#[inline(always)]
pub(super) fn loaded<S: Simd>(simd: S, kept: &Kept) -> Registers<S> {
    by_register(
        #[inline(always)]
        |g| kept[g].load(simd),
    )
}

/// The larger sizes, one by one.
#[inline(always)]
pub(super) fn larger_sizes<S: Simd>(a: Registers<S>, b: Registers<S>) -> Registers<S> {
    by_register(
        #[inline(always)]
        |g| larger(a[g].abs(), b[g].abs()),
    )
}

/// Sums, one by one.
#[inline(always)]
pub(super) fn plus<S: Simd>(a: Registers<S>, b: Registers<S>) -> Registers<S> {
    by_register(
        #[inline(always)]
        |g| a[g] + b[g],
    )
}

/// A bit for each that is above another.
#[inline(always)]
pub(super) fn above<S: Simd>(a: Registers<S>, b: Registers<S>) -> u64 {
    let mut bits = 0;
    for g in 0..REGISTERS {
        bits |= a[g].simd_gt(b[g]).to_bitmask() << (8 * g);
    }
    bits
}

/// Outputs behind each gate.
pub(super) const BEHIND: [u64; 5] = [
    1 << output::VELOCITY,
    1 << DISPLACEMENT,
    1 << output::BASE_SHEAR | 1 << ACCELERATION,
    1 << output::BLOCK,
    1 << RATE,
];

/// Outputs behind those gates whose bits are set.
#[inline(always)]
pub(super) fn behind(gates: u64) -> u64 {
    let mut bits = 0;
    for (gate, outputs) in BEHIND.into_iter().enumerate() {
        bits |= outputs * ((gates >> gate) & 1);
    }
    bits
}

/// What turns `f` and `u` into outputs: `Φ`, what `f` and `u` add to the overturning moment, `g sin θ`.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Shape {
    pub(in crate::solver) floor: f64,
    pub(in crate::solver) arms: [f64; 2],
    pub(in crate::solver) slope: f64,
}

/// The outputs: columns times `s, ṡ, η, η̇` and the input (the acceleration in stick, the friction force
/// in slip), and a constant.
#[derive(Debug)]
pub(super) struct Outputs {
    pub(super) columns: [Kept; 4],
    pub(super) of_input: Kept,
    pub(super) constant: Kept,
    /// How far they are off at most for each unit that the gates are off.
    of_gates: [Kept; 5],
}

impl Outputs {
    pub(super) const EMPTY: Self = Self {
        columns: [[Eight::ZERO; REGISTERS]; 4],
        of_input: [Eight::ZERO; REGISTERS],
        constant: [Eight::ZERO; REGISTERS],
        of_gates: [[Eight::ZERO; REGISTERS]; 5],
    };

    #[inline(always)]
    pub(super) fn fill(
        &mut self,
        rows: &[OutputRow],
        storey: &OneStorey,
        slip: bool,
        shape: &Shape,
    ) {
        let put = |to: &mut Kept, j: usize, x: f64| to[j / 8].0[j % 8] = x;
        for (j, row) in rows.iter().enumerate() {
            for (column, factor) in self.columns.iter_mut().zip(&row.state) {
                put(column, j, *factor);
            }
            put(&mut self.of_input, j, if slip { row.of_friction } else { row.of_a });
            put(&mut self.constant, j, row.constant);
        }
        let l = storey.participation;
        let [w, eta, f, u, rate] = &mut self.of_gates;
        put(w, output::VELOCITY, 1.0);
        put(eta, DISPLACEMENT, shape.floor);
        put(rate, RATE, shape.floor);
        put(f, output::BASE_SHEAR, l);
        put(f, ACCELERATION, shape.floor);
        put(f, output::SLIDER, l);
        put(f, output::OVERTURNING, shape.arms[0].abs());
        if slip {
            put(u, output::BLOCK, 1.0);
            // M1 u − L·f.
            put(u, output::SLIDER, storey.block_mass_kg);
            put(u, output::OVERTURNING, shape.arms[1].abs());
        } else {
            put(f, output::FRICTION, l);
        }
    }

    /// How far they are off at most where the gates are off by so much.
    #[inline(always)]
    pub(super) fn slack<S: Simd>(&self, simd: S, gates: [f64; 5]) -> Registers<S> {
        by_register(
            #[inline(always)]
            |g| {
                let mut sum = times8(simd, &self.of_gates[0][g], gates[0]);
                for gate in 1..gates.len() {
                    sum += times8(simd, &self.of_gates[gate][g], gates[gate]);
                }
                sum
            },
        )
    }

    /// In a state under an input.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, simd: S, x: [f64; 4], input: f64) -> Registers<S> {
        by_register(
            #[inline(always)]
            |g| {
                let [a, b, c, d] = &self.columns;
                let of_block = times8(simd, &a[g], x[0]) + times8(simd, &b[g], x[1]);
                let of_storey = times8(simd, &c[g], x[2]) + times8(simd, &d[g], x[3]);
                let by_input = times8(simd, &self.of_input[g], input);
                (of_block + of_storey) + (by_input + self.constant[g].load(simd))
            },
        )
    }
}

/// The gates: columns times state and input, and `η̇`, which stands in the state.
#[derive(Debug)]
pub(super) struct Gates {
    pub(super) columns: [Four; 4],
    pub(super) of_input: Four,
    /// Sizes of the columns.
    sizes: [Four; 4],
    pub(super) slack: Slack,
}

/// How far the gates depart from a chord at most: these times the norm of the state at the start, the
/// largest acceleration, its largest change in a sample, and the friction force. The norm is that at the
/// start of the chord's batch, or of many samples with the chord among them.
///
/// In slip the chord spans a batch, in stick a sample.
#[derive(Debug)]
pub(super) struct Slack {
    pub(super) of_norm: Five,
    pub(super) of_acceleration: [Five; 2],
    pub(super) of_change: Five,
    pub(super) of_force: [Five; 2],
}

impl Gates {
    pub(super) const EMPTY: Self = Self {
        columns: [Four::ZERO; 4],
        of_input: Four::ZERO,
        sizes: [Four::ZERO; 4],
        slack: Slack {
            of_norm: Five::ZERO,
            of_acceleration: [Five::ZERO; 2],
            of_change: Five::ZERO,
            of_force: [Five::ZERO; 2],
        },
    };

    #[inline(always)]
    pub(super) fn new(system: &System, storey: &OneStorey, slip: bool, dt_s: f64) -> Self {
        let f = [0.0, 0.0, storey.omega2, storey.decay];
        let mut rows = [unit(1), unit(2), f, [0.0; 4], unit(3)];
        if slip {
            // u = (T − C1 ṡ − K1 s + L·f) / M1
            let (per_mass, share) =
                (storey.per_block_mass, storey.participation * storey.per_block_mass);
            let [k, c] = [storey.stiffness_n_per_m, storey.damper_n_s_per_m];
            rows[3] = [-k * per_mass, -c * per_mass, share * f[2], share * f[3]];
        }
        let (mut columns, mut sizes) = ([Four::ZERO; 4], [Four::ZERO; 4]);
        for (j, row) in rows[..4].iter().enumerate() {
            for i in 0..4 {
                (columns[i].0[j], sizes[i].0[j]) = (row[i], row[i].abs());
            }
        }
        Self {
            columns,
            of_input: Four([0.0, 0.0, 0.0, if slip { storey.per_block_mass } else { 1.0 }]),
            sizes,
            slack: Slack::new(system, storey, slip, &rows, dt_s),
        }
    }

    /// How large they are at most where the state has these sizes.
    #[inline(always)]
    pub(super) fn of_sizes<S: Simd>(&self, simd: S, x: f64x4<S>) -> Abreast<S> {
        Abreast { four: combine4(simd, &self.sizes, x), fifth: x.as_array()[3] }
    }
}

impl Slack {
    /// Of rows `g = c·x + …` over chords within a time `H` of the start. From `g″ = c A² x + c A b a
    /// + c A d T + c b ȧ`, and (h) of the book for the growth of the norm,
    ///
    /// ```text
    /// |g″| ≤ |c A²|* (‖x‖ + H (√M_tot |a| + |T|/√M1)) + |c A b| |a| + |c A d| |T| + |c b| |ȧ|
    /// ```
    #[inline(always)]
    fn new(
        system: &System,
        storey: &OneStorey,
        slip: bool,
        rows: &[[f64; 4]; 5],
        dt_s: f64,
    ) -> Self {
        let mut a = [[0.0; 4]; 4];
        for (j, column) in a.iter_mut().enumerate() {
            *column = storey.rate(slip, unit(j), 0.0, 0.0);
        }
        let b = storey.rate(slip, [0.0; 4], 1.0, 0.0);
        let d = if slip { storey.rate(slip, [0.0; 4], 0.0, 1.0) } else { [0.0; 4] };
        let span_s = if slip { BATCH as f64 * dt_s } else { dt_s };
        let reach = 0.125 * span_s * span_s;
        let growth = if slip { storey.root_mass } else { storey.participation.abs() };
        let (mut of_norm, mut of_change) = ([0.0; 5], [0.0; 5]);
        let (mut of_acceleration, mut of_force) = ([[0.0; 5]; 2], [[0.0; 5]; 2]);
        for (j, c) in rows.iter().enumerate() {
            let (mut ca, mut caa) = ([0.0; 4], [0.0; 4]);
            for i in 0..4 {
                ca[i] = dot(c, &a[i]);
            }
            for i in 0..4 {
                caa[i] = dot(&ca, &a[i]);
            }
            let norm = system.dual_norm(slip, &caa);
            of_norm[j] = reach * norm;
            of_change[j] = reach * dot(c, &b).abs() / dt_s;
            let [at_a, at_force] = [dot(&ca, &b).abs(), dot(&ca, &d).abs()];
            for (i, samples) in [BATCH, QUIET].into_iter().enumerate() {
                let grown = norm * (samples as f64 * dt_s);
                of_acceleration[i][j] = reach * (at_a + grown * growth);
                of_force[i][j] = reach * (at_force + grown * storey.per_root_block);
            }
        }
        Self {
            of_norm: Five::new(of_norm),
            of_acceleration: of_acceleration.map(Five::new),
            of_change: Five::new(of_change),
            of_force: of_force.map(Five::new),
        }
    }
}

#[inline(always)]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}
