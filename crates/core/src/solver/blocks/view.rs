//! The tracked quantities of a block as sums over its state and loads.

use super::lanes::Eight;
use super::plant::Plant;
use crate::solver::extremes::tracked;

/// Place of the storey's displacement, and drift, among the tracked quantities of a block.
pub(in crate::solver) const DISPLACEMENT: usize = 6;
/// Place of the floor's acceleration.
pub(in crate::solver) const ACCELERATION: usize = 7;

/// The tracked quantities in the order of [`tracked`] with the drift, which is the displacement,
/// left out: the sum of columns times `s, ṡ, η, f` and of the acceleration and the friction force
/// times theirs, less the slope's pull in accelerations.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) columns: [Eight; 4],
    pub(super) of_acceleration: Eight,
    pub(super) of_force: Eight,
    pub(super) slope: Eight,
    /// How far they may be off for each unit that the gates are off.
    pub(super) of_gates: [Eight; 4],
}

/// Coefficients of the tracked quantities.
pub(super) struct TrackedRows {
    stick: [[f64; 8]; 6],
    slip: [[f64; 8]; 6],
    /// Lanes from which the slope's pull is taken.
    slope: Eight,
}

/// Rows of [`TrackedRows`]: of `s`, `ṡ`, `η`, `f`, the acceleration, the friction force.
const OF_A: usize = 4;
const OF_FORCE: usize = 5;

impl TrackedRows {
    #[inline(always)]
    pub(super) fn new(plant: &Plant, shape: f64, [arm, half]: [f64; 2], pull: f64) -> Self {
        let (k1, c1) = (plant.stiffness_n_per_m, plant.damper_n_s_per_m);
        let (l, per_mass) = (plant.participation, plant.per_block_mass);
        let mut slip = [[0.0; 8]; 6];
        slip[1][tracked::VELOCITY] = 1.0;
        let u = [-k1 * per_mass, -c1 * per_mass, 0.0, l * per_mass, 0.0, per_mass];
        for (column, u) in slip.iter_mut().zip(u) {
            column[tracked::BLOCK] = u;
            column[tracked::OVERTURNING] = half * u;
        }
        (slip[0][tracked::SLIDER], slip[1][tracked::SLIDER]) = (-k1, -c1);
        slip[OF_FORCE][tracked::SLIDER] = 1.0;
        slip[OF_FORCE][tracked::FRICTION] = 1.0;
        let mut stick = [[0.0; 8]; 6];
        stick[OF_A][tracked::BLOCK] = 1.0;
        stick[OF_A][tracked::OVERTURNING] = half;
        stick[0][tracked::FRICTION] = k1;
        for j in [tracked::SLIDER, tracked::FRICTION] {
            stick[OF_A][j] = plant.block_mass_kg;
            stick[3][j] = -l;
        }
        for columns in [&mut slip, &mut stick] {
            columns[3][tracked::BASE_SHEAR] = l;
            columns[3][tracked::OVERTURNING] -= arm;
            columns[2][DISPLACEMENT] = shape;
            columns[3][ACCELERATION] = -shape;
        }
        let mut slope = [0.0; 8];
        slope[tracked::BLOCK] = pull;
        // A rigid block has no floor whose acceleration could be told.
        slope[ACCELERATION] = if l == 0.0 { 0.0 } else { pull };
        Self { stick, slip, slope: Eight(slope) }
    }

    #[inline(always)]
    fn columns(&self, slip: bool) -> &[[f64; 8]; 6] {
        if slip { &self.slip } else { &self.stick }
    }

    #[inline(always)]
    pub(super) fn view(
        &self,
        plant: &Plant,
        slip: bool,
        shape: f64,
        [arm, half]: [f64; 2],
    ) -> View {
        let columns = self.columns(slip);
        let column = |j: usize| Eight(columns[j]);
        let mut of_gates = [Eight::ZERO; 4];
        let l = plant.participation;
        of_gates[0].0[tracked::VELOCITY] = 1.0;
        of_gates[1].0[DISPLACEMENT] = shape;
        let f = &mut of_gates[2].0;
        f[tracked::BASE_SHEAR] = l;
        f[ACCELERATION] = shape;
        f[tracked::SLIDER] = l;
        f[tracked::FRICTION] = if slip { 0.0 } else { l };
        f[tracked::OVERTURNING] = arm.abs();
        if slip {
            let u = &mut of_gates[3].0;
            u[tracked::BLOCK] = 1.0;
            // The slider force is M1 u − L f.
            u[tracked::SLIDER] = plant.block_mass_kg;
            u[tracked::OVERTURNING] = half.abs();
        }
        View {
            columns: core::array::from_fn(column),
            of_acceleration: column(OF_A),
            of_force: column(OF_FORCE),
            slope: self.slope,
            of_gates,
        }
    }
}
