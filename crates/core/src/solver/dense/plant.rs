//! The equations of motion of a rigid block or a block with one storey.

use crate::linear::System;

/// The equations of a rigid block (with zeros) or a block with one storey.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plant {
    pub(super) block_mass_kg: f64,
    pub(super) per_block_mass: f64,
    pub(super) stiffness_n_per_m: f64,
    pub(super) damper_n_s_per_m: f64,
    /// `Ω`, 1 for a rigid block.
    pub(super) omega2: f64,
    /// `D`.
    pub(super) decay: f64,
    /// `L`.
    pub(super) participation: f64,
    /// `√M_tot`.
    pub(super) root_mass: f64,
    /// `1/√M1`.
    pub(super) per_root_block: f64,
}

impl Plant {
    pub(super) fn new(system: &System) -> Self {
        let of = |x: f64, v: f64| {
            let mut f = [0.0];
            system.restoring(&[x], &[v], &mut f);
            f[0]
        };
        let participation = system.participation[0];
        let total_kg = system.block_mass_kg + participation * participation;
        Self {
            block_mass_kg: system.block_mass_kg,
            per_block_mass: system.per_block_mass,
            stiffness_n_per_m: system.stiffness_n_per_m,
            damper_n_s_per_m: system.damper_n_s_per_m,
            omega2: of(1.0, 0.0),
            decay: of(0.0, 1.0),
            participation,
            root_mass: total_kg.sqrt(),
            per_root_block: 1.0 / system.block_mass_kg.sqrt(),
        }
    }

    /// `f = D η̇ + Ω η`.
    #[inline(always)]
    pub(super) fn restoring(&self, x: &[f64; 4]) -> f64 {
        self.omega2 * x[2] + self.decay * x[3]
    }

    /// `u` in slip under a friction force.
    #[inline(always)]
    pub(super) fn block_acceleration(&self, x: &[f64; 4], f: f64, force: f64) -> f64 {
        ((force - self.damper_n_s_per_m * x[1])
            + (self.participation * f - self.stiffness_n_per_m * x[0]))
            * self.per_block_mass
    }

    /// The force that keeps the block stuck under an acceleration.
    #[inline(always)]
    pub(super) fn demand_n(&self, x: &[f64; 4], a: f64) -> f64 {
        (self.block_mass_kg * a + self.stiffness_n_per_m * x[0])
            - self.participation * self.restoring(x)
    }

    /// Energy norm of a state.
    #[inline(always)]
    pub(super) fn norm(&self, x: &[f64; 4]) -> f64 {
        let momentum = x[3] + self.participation * x[1];
        let of_block = self.stiffness_n_per_m * (x[0] * x[0]) + self.block_mass_kg * (x[1] * x[1]);
        (of_block + (self.omega2 * (x[2] * x[2]) + momentum * momentum)).sqrt()
    }

    /// Energy norm of the structure's part of a state, which is all that moves in stick.
    #[inline(always)]
    pub(super) fn norm_of_structure(&self, x: &[f64; 4]) -> f64 {
        (self.omega2 * (x[2] * x[2]) + x[3] * x[3]).sqrt()
    }

    /// Largest value of a row on states of norm 1; in stick on those of the structure alone.
    #[inline(always)]
    pub(super) fn dual_norm(&self, slip: bool, c: [f64; 4]) -> f64 {
        let of_structure = c[2] * c[2] / self.omega2 + c[3] * c[3];
        let of_block = if slip {
            let of_s = if c[0] == 0.0 { 0.0 } else { c[0] * c[0] / self.stiffness_n_per_m };
            let momentum = c[1] - c[3] * self.participation;
            of_s + momentum * momentum * self.per_block_mass
        } else {
            0.0
        };
        (of_block + of_structure).sqrt()
    }

    /// Derivative of a state under an acceleration and a friction force.
    #[inline(always)]
    pub(super) fn rate(&self, slip: bool, x: [f64; 4], a: f64, force: f64) -> [f64; 4] {
        let f = self.restoring(&x);
        if slip {
            let u = self.block_acceleration(&x, f, force);
            [x[1], u - a, x[3], -f - self.participation * u]
        } else {
            [0.0, 0.0, x[3], -f - self.participation * a]
        }
    }
}

/// The state with a one in one place.
#[inline(always)]
pub(super) fn unit(j: usize) -> [f64; 4] {
    let mut unit = [0.0; 4];
    unit[j] = 1.0;
    unit
}
