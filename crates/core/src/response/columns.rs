//! The columns of a history, named as the files name them.

use super::History;

impl History {
    /// Names and values of all columns at some knots: time, table acceleration, sliding displacement
    /// and velocity, total acceleration of the block, friction force; of each storey displacement and
    /// velocity relative to the block and total acceleration. Units are in the names.
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
        for i in 0..self.storeys {
            for (name, list) in [
                ("displacement_m", &self.storey_displacement_m),
                ("velocity_m_per_s", &self.storey_velocity_m_per_s),
                ("acceleration_m_per_s2", &self.storey_acceleration_m_per_s2),
            ] {
                columns.push((format!("storey{}_{name}", i + 1), of(list, self.storeys, i)));
            }
        }
        columns
    }
}
