//! The columns of a history, named as the files name them.

use super::History;
use crate::model::Model;

impl History {
    /// Force of the block on its slider at a knot in N, friction, spring, damper and stop together: it
    /// rises with the sliding displacement, as a data sheet draws it.
    #[must_use]
    pub fn slider_force_n(&self, model: &Model, knot: usize) -> f64 {
        // −(M₁ (Ẍ₁ + g sinθ) + Σ mᵢ (Ẍᵢ + g sinθ)) over block, floors and contents
        let floors = model.frame().masses_kg.iter().zip(self.storey_accelerations(knot));
        let contents = model.contents().iter().enumerate();
        let inertia = model.block().mass_kg * self.block_acceleration_m_per_s2[knot]
            + floors.map(|(m, a)| m * a).sum::<f64>()
            + contents.map(|(i, c)| c.mass_kg * self.contents_state(knot, i)[2]).sum::<f64>();
        -(inertia + model.total_mass_kg() * model.slope_m_per_s2())
    }

    /// Names and values of all columns at some knots: time, table acceleration, sliding displacement
    /// and velocity, total acceleration of the block, friction force; of each storey displacement and
    /// velocity relative to the block and total acceleration; displacements of surfaces in series; of
    /// contents displacement and velocity relative to their floor and total acceleration. Units are in
    /// the names.
    #[must_use]
    pub fn columns(&self, knots: &[usize]) -> Vec<(String, Vec<f64>)> {
        let of = |list: &[f64], width: usize, place: usize| -> Vec<f64> {
            knots.iter().map(|&knot| list[knot * width + place]).collect()
        };
        let mut columns: Vec<(String, Vec<f64>)> = [
            ("time_s", &self.time_s),
            ("table_acceleration_m_per_s2", &self.table_acceleration_m_per_s2),
            ("sliding_displacement_m", &self.sliding_displacement_m),
            ("sliding_velocity_m_per_s", &self.sliding_velocity_m_per_s),
            ("block_acceleration_m_per_s2", &self.block_acceleration_m_per_s2),
            ("friction_force_n", &self.friction_force_n),
        ]
        .into_iter()
        .map(|(name, list)| (name.to_owned(), of(list, 1, 0)))
        .collect();
        let mut add = |part: &str, count: usize, lists: [&[f64]; 3]| {
            let kinds = ["displacement_m", "velocity_m_per_s", "acceleration_m_per_s2"];
            for i in 0..count {
                for (kind, list) in kinds.iter().zip(lists).filter(|(_, list)| !list.is_empty()) {
                    columns.push((format!("{part}{}_{kind}", i + 1), of(list, count, i)));
                }
            }
        };
        add(
            "storey",
            self.storeys,
            [
                &self.storey_displacement_m,
                &self.storey_velocity_m_per_s,
                &self.storey_acceleration_m_per_s2,
            ],
        );
        add("surface", self.surfaces, [&self.surface_displacement_m, &[], &[]]);
        add(
            "contents",
            self.contents(),
            [
                &self.contents_displacement_m,
                &self.contents_velocity_m_per_s,
                &self.contents_acceleration_m_per_s2,
            ],
        );
        columns
    }
}
