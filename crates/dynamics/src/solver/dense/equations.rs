//! The equations of motion of a rigid block, or a block with one storey, in their few numbers.

use crate::linear::System;

/// A rigid block (with zeros for the storey) or a block with one storey. A state is `s, ṡ, η, η̇`.
#[derive(Clone, Copy, Debug)]
pub(super) struct OneStorey {
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

impl OneStorey {
    pub(super) const NONE: Self = Self {
        block_mass_kg: 0.0,
        per_block_mass: 0.0,
        stiffness_n_per_m: 0.0,
        damper_n_s_per_m: 0.0,
        omega2: 0.0,
        decay: 0.0,
        participation: 0.0,
        root_mass: 0.0,
        per_root_block: 0.0,
    };

    pub(super) fn new(system: &System) -> Self {
        let of = |x: f64, v: f64| {
            let mut f = [0.0];
            system.restoring(&[x], &[v], &mut f);
            f[0]
        };
        Self {
            block_mass_kg: system.block_mass_kg,
            per_block_mass: system.per_block_mass,
            stiffness_n_per_m: system.stiffness_n_per_m,
            damper_n_s_per_m: system.damper_n_s_per_m,
            omega2: of(1.0, 0.0),
            decay: of(0.0, 1.0),
            participation: system.participation[0],
            root_mass: system.root_total_mass,
            per_root_block: system.per_root_block,
        }
    }

    /// `f = D η̇ + Ω η`.
    #[inline(always)]
    pub(super) fn restoring(&self, x: &[f64; 4]) -> f64 {
        self.restoring_of([x[2], x[3]])
    }

    /// The same of `η, η̇`.
    #[inline(always)]
    pub(super) fn restoring_of(&self, [eta, rate]: [f64; 2]) -> f64 {
        self.omega2 * eta + self.decay * rate
    }

    /// `u` in slip under a friction force.
    #[inline(always)]
    pub(super) fn block_acceleration(&self, x: &[f64; 4], f: f64, force_n: f64) -> f64 {
        ((force_n - self.damper_n_s_per_m * x[1])
            + (self.participation * f - self.stiffness_n_per_m * x[0]))
            * self.per_block_mass
    }

    /// `M1 a + K1 s − L·f`: what keeps the block stuck.
    #[inline(always)]
    pub(super) fn required_friction_n(&self, x: &[f64; 4], a: f64) -> f64 {
        (self.block_mass_kg * a + self.stiffness_n_per_m * x[0])
            - self.participation * self.restoring(x)
    }

    /// `‖x‖`.
    #[inline(always)]
    pub(super) fn norm(&self, x: &[f64; 4]) -> f64 {
        let momentum = x[3] + self.participation * x[1];
        let of_block = self.stiffness_n_per_m * (x[0] * x[0]) + self.block_mass_kg * (x[1] * x[1]);
        (of_block + (self.omega2 * (x[2] * x[2]) + momentum * momentum)).sqrt()
    }

    /// `√(Ω η² + η̇²)`, which is all that moves in stick.
    #[inline(always)]
    pub(super) fn amplitude(&self, x: &[f64; 4]) -> f64 {
        (self.omega2 * (x[2] * x[2]) + x[3] * x[3]).sqrt()
    }

    /// `ẋ = A x + b a + d T`.
    #[inline(always)]
    pub(super) fn rate(&self, slip: bool, x: [f64; 4], a: f64, force_n: f64) -> [f64; 4] {
        let f = self.restoring(&x);
        if slip {
            let u = self.block_acceleration(&x, f, force_n);
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
