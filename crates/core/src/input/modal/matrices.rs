//! The matrices of an eigenvalue analysis, as libraries of linear algebra have them.

use super::{ModalPoint, ModalRow, ModalTable, Share};
use crate::error::ChoiceError;

/// What two shapes may have in common over their modal masses, by rounding of the program that they come from.
const ORTHOGONAL: f64 = 1e-6;

/// What may differ between the two halves of a mass matrix, over its largest term.
const SYMMETRIC: f64 = 1e-9;

/// An eigenvalue analysis of a structure on a fixed base, one direction, in SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EigenMatrices {
    /// Shapes of any normalisation, a row a degree of freedom and a column a mode.
    pub shapes: Vec<Vec<f64>>,
    /// Circular frequencies in rad/s, one a mode.
    pub omega_rad_per_s: Vec<f64>,
    /// Ratios of critical damping, one a mode.
    pub damping_ratios: Vec<f64>,
    /// The mass matrix in kg, row by row.
    pub mass_kg: Vec<Vec<f64>>,
    /// What each degree of freedom does where the base moves by 1.
    pub influence: Vec<f64>,
    /// Degrees of freedom whose motion is wanted, counted from 0, by the names that they get.
    pub points: Vec<(String, usize)>,
}

impl EigenMatrices {
    /// Periods, participations `L = φᵀ M r` and shapes at points, of shapes of unit modal mass `φᵀ M φ`, the longest
    /// period first.
    ///
    /// # Errors
    /// [`ChoiceError`], by the name of the field, for sizes that do not fit, frequencies and modal masses that are
    /// not positive, a mass matrix that is not symmetric, and shapes that are not orthogonal.
    pub fn modes(&self) -> Result<ModalTable, ChoiceError> {
        let (freedoms, modes) = (self.shapes.len(), self.shapes.first().map_or(0, Vec::len));
        self.check_sizes(freedoms, modes)?;
        let slowest = self.omega_rad_per_s.iter().copied().fold(f64::INFINITY, f64::min);
        if slowest.is_nan() || slowest <= 0.0 {
            return Err(refuse("omega", "circular frequencies > 0", slowest));
        }
        let shape = |j: usize| -> Vec<f64> { self.shapes.iter().map(|row| row[j]).collect() };
        let shapes: Vec<Vec<f64>> = (0..modes).map(shape).collect();
        let moved: Vec<Vec<f64>> = shapes.iter().map(|shape| self.times_mass(shape)).collect();
        let masses: Vec<f64> = (0..modes).map(|j| dot(&shapes[j], &moved[j])).collect();
        if let Some(none) = masses.iter().find(|mass| mass.is_nan() || **mass <= 0.0) {
            let expected = "a matrix by which every mode has a mass > 0";
            return Err(refuse("mass", expected, format!("{none} kg")));
        }
        let mut common: f64 = 0.0;
        for j in 0..modes {
            for k in 0..j {
                let of_two = dot(&shapes[j], &moved[k]) / (masses[j] * masses[k]).sqrt();
                common = common.max(of_two.abs());
            }
        }
        if common > ORTHOGONAL {
            let expected = "shapes that are orthogonal with respect to the masses, a column a mode";
            let found = format!("two that have {common:.3e} of their modal masses in common");
            return Err(refuse("phi", expected, found));
        }
        let mut order: Vec<usize> = (0..modes).collect();
        order.sort_by(|&j, &k| self.omega_rad_per_s[j].total_cmp(&self.omega_rad_per_s[k]));
        let row = |&j: &usize| ModalRow {
            period_s: 2.0 * core::f64::consts::PI / self.omega_rad_per_s[j],
            damping_ratio: Some(self.damping_ratios[j]),
            shares: [
                Some(Share::Participation(dot(&moved[j], &self.influence) / masses[j].sqrt())),
                None,
            ],
        };
        let point = |(name, freedom): &(String, usize)| {
            let of = |&j: &usize| shapes[j][*freedom] / masses[j].sqrt();
            ModalPoint { name: name.clone(), shapes: [Some(order.iter().map(of).collect()), None] }
        };
        let mass_kg = dot(&self.influence, &self.times_mass(&self.influence));
        Ok(ModalTable {
            format: "matrices of an eigenvalue analysis".to_owned(),
            mass_kg: [Some(mass_kg), None],
            modes: order.iter().map(row).collect(),
            points: self.points.iter().map(point).collect(),
            ..ModalTable::default()
        })
    }

    fn check_sizes(&self, freedoms: usize, modes: usize) -> Result<(), ChoiceError> {
        let shape =
            |rows: &[Vec<f64>]| format!("{} × {}", rows.len(), rows.first().map_or(0, Vec::len));
        if modes == 0 || self.shapes.iter().any(|row| row.len() != modes) {
            let expected = "a matrix, a row a degree of freedom and a column a mode";
            return Err(refuse("phi", expected, shape(&self.shapes)));
        }
        for (name, values, what, count) in [
            ("omega", &self.omega_rad_per_s, "circular frequencies in rad/s, one a mode", modes),
            ("damping", &self.damping_ratios, "damping ratios, one a mode", modes),
            ("influence", &self.influence, "a number a degree of freedom", freedoms),
        ] {
            if values.len() != count {
                return Err(refuse(name, format!("{what}, {count} in all"), values.len()));
            }
        }
        let expected = format!(
            "masses in kg: {freedoms} of them, or a symmetric matrix of {freedoms} × {freedoms}"
        );
        let is_square =
            self.mass_kg.len() == freedoms && self.mass_kg.iter().all(|row| row.len() == freedoms);
        if !is_square {
            return Err(refuse("mass", expected, shape(&self.mass_kg)));
        }
        let largest = self.mass_kg.iter().flatten().fold(0.0, |most: f64, m| most.max(m.abs()));
        let apart = |(i, j): (usize, usize)| (self.mass_kg[i][j] - self.mass_kg[j][i]).abs();
        let mut pairs = (0..freedoms).flat_map(|i| (0..i).map(move |j| (i, j)));
        if pairs.any(|pair| apart(pair) > SYMMETRIC * largest) {
            return Err(refuse("mass", expected, "one that is not symmetric"));
        }
        let beyond = self.points.iter().find(|(_, freedom)| *freedom >= freedoms);
        if let Some((name, freedom)) = beyond {
            let expected = format!("rows of phi, from 0 to {}", freedoms - 1);
            return Err(refuse("points", expected, format!("{name:?}: {freedom}")));
        }
        Ok(())
    }

    /// The mass matrix times a vector, in kg times its unit.
    fn times_mass(&self, vector: &[f64]) -> Vec<f64> {
        self.mass_kg.iter().map(|row| dot(row, vector)).collect()
    }
}

impl ModalTable {
    /// The table `[structure]` of a model along x, as paths of its keys with their values.
    #[must_use]
    pub fn to_keys(&self) -> Vec<(String, String)> {
        let mut keys: Vec<(String, String)> = Vec::new();
        let mut key = |path: String, value: String| keys.push((format!("structure.{path}"), value));
        if let Some(mass_kg) = self.mass_kg[0] {
            key("mass".to_owned(), format!("{mass_kg:?} kg"));
        }
        for (mode, number) in self.modes.iter().zip(1..) {
            key(format!("mode.{number}.period"), format!("{:?} s", mode.period_s));
            if let Some(ratio) = mode.damping_ratio {
                key(format!("mode.{number}.damping_ratio"), format!("{ratio:?}"));
            }
            match mode.shares[0] {
                Some(Share::Participation(l)) => {
                    key(format!("mode.{number}.participation"), format!("{l:?}"));
                }
                Some(Share::Ratio(ratio)) => {
                    key(format!("mode.{number}.effective_mass_ratio"), format!("{ratio:?}"));
                }
                None => {}
            }
        }
        for (point, number) in self.points.iter().zip(1..) {
            key(format!("point.{number}.name"), point.name.clone());
            for (value, mode) in point.shapes[0].iter().flatten().zip(1..) {
                key(format!("point.{number}.shape.{mode}"), format!("{value:?}"));
            }
        }
        keys
    }
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

fn refuse(what: &str, expected: impl Into<String>, found: impl ToString) -> ChoiceError {
    let (what, expected) = (what.to_owned(), expected.into());
    ChoiceError { what, expected, found: found.to_string(), nearest: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses of 1 kg between walls on springs of 1 N/m: shapes (1, 1) and (1, −1), ω² = 1 and 3.
    fn between_walls() -> EigenMatrices {
        EigenMatrices {
            shapes: vec![vec![-2.0, 3.0], vec![2.0, 3.0]],
            omega_rad_per_s: vec![3.0_f64.sqrt(), 1.0],
            damping_ratios: vec![0.03, 0.02],
            mass_kg: vec![vec![1.0, 0.0], vec![0.0, 1.0]],
            influence: vec![1.0, 1.0],
            points: vec![("Second".to_owned(), 1)],
        }
    }

    #[test]
    fn closed_form_modes_of_two_masses_between_walls() {
        let table = between_walls().modes().expect("modes");
        assert_eq!(table.mass_kg, [Some(2.0), None]);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-15;
        let share = |j: usize| match table.modes[j].shares[0] {
            Some(Share::Participation(l)) => l,
            _ => f64::NAN,
        };
        // The slow mode has all of the mass, L² = 2 kg, the fast one none.
        assert!(close(share(0), 2.0_f64.sqrt()) && close(share(1), 0.0));
        assert!(close(table.modes[0].period_s, 2.0 * core::f64::consts::PI));
        assert_eq!(table.modes[0].damping_ratio, Some(0.02));
        let shape = table.points[0].shapes[0].as_ref().expect("a shape");
        let half = 0.5_f64.sqrt();
        assert!(close(shape[0], half) && close(shape[1], half));
        let keys = table.to_keys();
        assert_eq!(keys[0], ("structure.mass".to_owned(), "2.0 kg".to_owned()));
        assert_eq!(keys.last().map(|(path, _)| &path[..]), Some("structure.point.1.shape.2"));
    }

    #[test]
    fn what_is_no_eigenvalue_analysis_is_refused_by_its_field() {
        let with = |change: fn(&mut EigenMatrices)| {
            let mut matrices = between_walls();
            change(&mut matrices);
            matrices.modes().expect_err("no modes").to_string()
        };
        for (change, expected) in [
            (
                (|m| m.shapes[0][0] = 2.0) as fn(&mut EigenMatrices),
                "phi: expected shapes that are orthogonal with respect to the masses, a column a mode, found two that \
                 have 1.000e0 of their modal masses in common",
            ),
            (|m| m.omega_rad_per_s[0] = 0.0, "omega: expected circular frequencies > 0, found 0"),
            (
                |m| m.damping_ratios.truncate(1),
                "damping: expected damping ratios, one a mode, 2 in all, found 1",
            ),
            (
                |m| m.mass_kg[0][1] = 0.1,
                "mass: expected masses in kg: 2 of them, or a symmetric matrix of 2 × 2, found \
                 one that is not symmetric",
            ),
            (
                |m| m.points[0].1 = 2,
                "points: expected rows of phi, from 0 to 1, found \"Second\": 2",
            ),
        ] {
            assert_eq!(with(change), expected);
        }
    }
}
