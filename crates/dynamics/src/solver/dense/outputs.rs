//! The outputs of one storey or none, eight side by side, and the four numbers that bound them.
//!
//! Nearly every output follows from one of the *gates* `ṡ, η, f, u`: an output stays below its peak while
//! its gate stays within two limits. So a batch asks for four numbers where nothing is near a peak. Two
//! outputs stand behind several gates: with a damper the slider force in slip, and the overturning moment.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::equations::{OneStorey, unit};
use super::lanes::{BATCH, Eight, Four, combine8, times8};
use crate::linear::{QUIET, System};
use crate::response::output::{self, Output};
use crate::solver::outputs::OutputRow;

/// Place of the storey's displacement, and drift, among the outputs.
pub(super) const DISPLACEMENT: usize = Output::Displacement(0).place(1);
/// Place of the floor's acceleration.
pub(super) const ACCELERATION: usize = Output::Acceleration(0).place(1);

/// Outputs behind each gate.
pub(super) const BEHIND: [u64; 4] = [
    1 << output::VELOCITY,
    1 << DISPLACEMENT,
    1 << output::BASE_SHEAR | 1 << ACCELERATION,
    1 << output::BLOCK,
];

/// Outputs behind those gates whose bits are set.
#[inline(always)]
pub(super) fn behind(gates: u64) -> u64 {
    ((BEHIND[0] * (gates & 1)) | (BEHIND[1] * ((gates >> 1) & 1)))
        | ((BEHIND[2] * ((gates >> 2) & 1)) | (BEHIND[3] * ((gates >> 3) & 1)))
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
    pub(super) columns: [Eight; 4],
    pub(super) of_input: Eight,
    pub(super) constant: Eight,
    /// How far they are off at most for each unit that the gates are off.
    pub(super) of_gates: [Eight; 4],
}

impl Outputs {
    pub(super) const EMPTY: Self = Self {
        columns: [Eight::ZERO; 4],
        of_input: Eight::ZERO,
        constant: Eight::ZERO,
        of_gates: [Eight::ZERO; 4],
    };

    #[inline(always)]
    pub(super) fn fill(
        &mut self,
        rows: &[OutputRow],
        storey: &OneStorey,
        slip: bool,
        shape: &Shape,
    ) {
        for (lane, row) in rows.iter().enumerate() {
            for (column, factor) in self.columns.iter_mut().zip(&row.state) {
                column.0[lane] = *factor;
            }
            self.of_input.0[lane] = if slip { row.of_friction } else { row.of_a };
            self.constant.0[lane] = row.constant;
        }
        let l = storey.participation;
        let [w, eta, f, u] = &mut self.of_gates;
        w.0[output::VELOCITY] = 1.0;
        eta.0[DISPLACEMENT] = shape.floor;
        f.0[output::BASE_SHEAR] = l;
        f.0[ACCELERATION] = shape.floor;
        f.0[output::SLIDER] = l;
        f.0[output::OVERTURNING] = shape.arms[0].abs();
        if slip {
            u.0[output::BLOCK] = 1.0;
            // M1 u − L·f.
            u.0[output::SLIDER] = storey.block_mass_kg;
            u.0[output::OVERTURNING] = shape.arms[1].abs();
        } else {
            f.0[output::FRICTION] = l;
        }
    }

    /// In a state under an input.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, simd: S, x: [f64; 4], input: f64) -> f64x8<S> {
        let input = times8(simd, &self.of_input, input);
        combine8(simd, &self.columns, x) + (input + self.constant.load(simd))
    }
}

/// The gates: columns times state and input.
#[derive(Debug)]
pub(super) struct Gates {
    pub(super) columns: [Four; 4],
    pub(super) of_input: Four,
    /// Sizes of the columns.
    pub(super) sizes: [Four; 4],
    pub(super) slack: Slack,
}

/// How far the gates depart from a chord at most: these times the norm of the state at the start, the
/// largest acceleration, its largest change in a sample, and the friction force. The norm is that at the
/// start of the chord's batch, or of many samples with the chord among them.
///
/// In slip the chord spans a batch, in stick a sample.
#[derive(Debug)]
pub(super) struct Slack {
    pub(super) of_norm: Four,
    pub(super) of_acceleration: [Four; 2],
    pub(super) of_change: Four,
    pub(super) of_force: [Four; 2],
}

impl Gates {
    pub(super) const EMPTY: Self = Self {
        columns: [Four::ZERO; 4],
        of_input: Four::ZERO,
        sizes: [Four::ZERO; 4],
        slack: Slack {
            of_norm: Four::ZERO,
            of_acceleration: [Four::ZERO; 2],
            of_change: Four::ZERO,
            of_force: [Four::ZERO; 2],
        },
    };

    #[inline(always)]
    pub(super) fn new(system: &System, storey: &OneStorey, slip: bool, dt_s: f64) -> Self {
        let f = [0.0, 0.0, storey.omega2, storey.decay];
        let mut rows = [unit(1), unit(2), f, [0.0; 4]];
        if slip {
            // u = (T − C1 ṡ − K1 s + L·f) / M1
            let (per_mass, share) =
                (storey.per_block_mass, storey.participation * storey.per_block_mass);
            let [k, c] = [storey.stiffness_n_per_m, storey.damper_n_s_per_m];
            rows[3] = [-k * per_mass, -c * per_mass, share * f[2], share * f[3]];
        }
        let (mut columns, mut sizes) = ([Four::ZERO; 4], [Four::ZERO; 4]);
        for (j, row) in rows.iter().enumerate() {
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
        rows: &[[f64; 4]; 4],
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
        let (mut of_norm, mut of_change) = (Four::ZERO, Four::ZERO);
        let (mut of_acceleration, mut of_force) = ([Four::ZERO; 2], [Four::ZERO; 2]);
        for (j, c) in rows.iter().enumerate() {
            let (mut ca, mut caa) = ([0.0; 4], [0.0; 4]);
            for i in 0..4 {
                ca[i] = dot(c, &a[i]);
            }
            for i in 0..4 {
                caa[i] = dot(&ca, &a[i]);
            }
            let norm = system.dual_norm(slip, &caa);
            of_norm.0[j] = reach * norm;
            of_change.0[j] = reach * dot(c, &b).abs() / dt_s;
            let [at_a, at_force] = [dot(&ca, &b).abs(), dot(&ca, &d).abs()];
            for (i, samples) in [BATCH, QUIET].into_iter().enumerate() {
                let grown = norm * (samples as f64 * dt_s);
                of_acceleration[i].0[j] = reach * (at_a + grown * growth);
                of_force[i].0[j] = reach * (at_force + grown * storey.per_root_block);
            }
        }
        Self { of_norm, of_acceleration, of_change, of_force }
    }
}

#[inline(always)]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}
