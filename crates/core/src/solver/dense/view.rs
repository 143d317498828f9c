//! The outputs of one storey or none as eight lanes.

use super::lanes::Eight;
use super::plant::Plant;
use crate::solver::outputs::{OutputRow, output as tracked};

/// Place of the storey's displacement, and drift, among the outputs.
pub(in crate::solver) const DISPLACEMENT: usize = tracked::STOREYS;
/// Place of the floor's acceleration.
pub(in crate::solver) const ACCELERATION: usize = tracked::STOREYS + 1;

/// The outputs: the sum of columns times `s, ṡ, η, η̇` and of the acceleration and the friction force
/// times theirs, and a constant.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) columns: [Eight; 4],
    pub(super) of_acceleration: Eight,
    pub(super) of_force: Eight,
    pub(super) constant: Eight,
    /// How far they may be off for each unit that the gates are off.
    pub(super) of_gates: [Eight; 4],
}

impl View {
    #[inline(always)]
    pub(super) fn new(
        rows: &[OutputRow],
        plant: &Plant,
        slip: bool,
        (shape, [arm, half]): (f64, [f64; 2]),
    ) -> Self {
        let (zero, l) = (Eight::ZERO, plant.participation);
        let mut view = Self {
            columns: [zero; 4],
            of_acceleration: zero,
            of_force: zero,
            constant: zero,
            of_gates: [zero; 4],
        };
        for (lane, row) in rows.iter().enumerate() {
            for (column, factor) in view.columns.iter_mut().zip(&row.state) {
                column.0[lane] = *factor;
            }
            view.of_acceleration.0[lane] = row.of_a;
            view.of_force.0[lane] = row.of_friction;
            view.constant.0[lane] = row.constant;
        }
        let [w, eta, f, u] = &mut view.of_gates;
        w.0[tracked::VELOCITY] = 1.0;
        eta.0[DISPLACEMENT] = shape;
        f.0[tracked::BASE_SHEAR] = l;
        f.0[ACCELERATION] = shape;
        f.0[tracked::SLIDER] = l;
        f.0[tracked::FRICTION] = if slip { 0.0 } else { l };
        f.0[tracked::OVERTURNING] = arm.abs();
        if slip {
            u.0[tracked::BLOCK] = 1.0;
            // The slider force is M1 u − L f.
            u.0[tracked::SLIDER] = plant.block_mass_kg;
            u.0[tracked::OVERTURNING] = half.abs();
        }
        view
    }
}
