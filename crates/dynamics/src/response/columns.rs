//! The columns of a history, named as the files name them.

use super::{History, HistoryAlongY, Response};
use crate::model::Model;

/// A quantity of a point at a knot: history, knot, point.
type OfPoint = fn(&History, usize, usize) -> f64;
/// Values of a point along x and y at a knot.
type OfPointInPlane = fn(&HistoryAlongY, &History, usize, usize) -> [f64; 2];

impl Response {
    /// Names and values of all columns of the history at some knots, as [`History::columns`]; in two
    /// horizontal directions each that is along x is followed by the same along y, `…_y_m`. None where no
    /// history was asked for.
    #[must_use]
    pub fn columns(&self, knots: &[usize]) -> Vec<(String, Vec<f64>)> {
        let Some(history) = &self.history else { return Vec::new() };
        let Some(y) = self.in_plane.as_ref().and_then(|plane| plane.history.as_ref()) else {
            return history.columns(knots);
        };
        if y.points.is_some() {
            return y.columns_of_modes(history, knots);
        }
        let along_x = history.columns(knots);
        let as_along_x = y.as_along_x(history);
        let along_y = as_along_x.columns(knots).into_iter();
        let pairs = along_x.into_iter().zip(along_y);
        let both = pairs.flat_map(|(x, (name, values))| {
            let twin = (name != "time_s").then(|| (along_y_name(&name), values));
            [Some(x), twin].into_iter().flatten()
        });
        both.collect()
    }
}

impl Response {
    /// Force of the block on its slider along x at the knots of the history in N, as [`History::slider_force_n`].
    #[must_use]
    pub fn slider_force_n(&self, model: &Model) -> Vec<f64> {
        let Some(history) = &self.history else { return Vec::new() };
        let y = self.in_plane.as_ref().and_then(|plane| plane.history.as_ref());
        let of = |knot: usize| match y {
            Some(y) => y.slider_force_n(history, model, knot)[0],
            None => history.slider_force_n(model, knot),
        };
        (0..history.len()).map(of).collect()
    }

    /// Force of the slider along y at the knots, in N; nothing in one direction.
    #[must_use]
    pub fn slider_force_y_n(&self, model: &Model) -> Vec<f64> {
        let y = self.in_plane.as_ref().and_then(|plane| plane.history.as_ref());
        let (Some(history), Some(y)) = (&self.history, y) else { return Vec::new() };
        (0..history.len()).map(|knot| y.slider_force_n(history, model, knot)[1]).collect()
    }
}

/// `sliding_displacement_m` along y: `sliding_displacement_y_m`.
fn along_y_name(name: &str) -> String {
    const UNITS: [&str; 4] = ["_m_per_s2", "_m_per_s", "_m", "_n"];
    let unit = UNITS.into_iter().find(|unit| name.ends_with(unit)).unwrap_or("");
    format!("{}_y{unit}", name.trim_end_matches(unit))
}

impl HistoryAlongY {
    /// The columns where the structure is given by its modes: those of the block, then those of the points, each
    /// along x and along y.
    fn columns_of_modes(&self, x: &History, knots: &[usize]) -> Vec<(String, Vec<f64>)> {
        type Lists<'a> = [&'a [f64]; 2];
        let of_block: [(&str, Lists<'_>); 5] = [
            (
                "table_acceleration_m_per_s2",
                [&x.table_acceleration_m_per_s2, &self.table_acceleration_m_per_s2],
            ),
            ("sliding_displacement_m", [&x.sliding_displacement_m, &self.sliding_displacement_m]),
            (
                "sliding_velocity_m_per_s",
                [&x.sliding_velocity_m_per_s, &self.sliding_velocity_m_per_s],
            ),
            (
                "block_acceleration_m_per_s2",
                [&x.block_acceleration_m_per_s2, &self.block_acceleration_m_per_s2],
            ),
            ("friction_force_n", [&x.friction_force_n, &self.friction_force_n]),
        ];
        let at = |list: &[f64]| -> Vec<f64> { knots.iter().map(|&knot| list[knot]).collect() };
        let mut columns = vec![("time_s".to_owned(), at(&x.time_s))];
        for (name, [of_x, of_y]) in of_block {
            columns.push((name.to_owned(), at(of_x)));
            columns.push((along_y_name(name), at(of_y)));
        }
        let kinds: [(&str, OfPointInPlane); 3] = [
            ("displacement_m", Self::point_displacement),
            ("velocity_m_per_s", Self::point_velocity),
            ("acceleration_m_per_s2", Self::point_acceleration),
        ];
        for i in 0..self.point_count(x) {
            for (kind, value) in kinds {
                let name = format!("point{}_{kind}", i + 1);
                let both = knots.iter().map(|&knot| value(self, x, knot, i));
                let (of_x, of_y) = both.map(|[x, y]| (x, y)).unzip();
                columns.extend([(name.clone(), of_x), (along_y_name(&name), of_y)]);
            }
        }
        columns
    }

    /// Force of the block on its slider along x and y at a knot in N, friction, spring and damper together, as
    /// [`History::slider_force_n`].
    #[must_use]
    pub fn slider_force_n(&self, along_x: &History, model: &Model, knot: usize) -> [f64; 2] {
        let block = [&along_x.block_acceleration_m_per_s2, &self.block_acceleration_m_per_s2]
            .map(|a| a[knot]);
        let slope = model.slope_in_plane_m_per_s2();
        let Some(structure) = model.structure() else {
            let n = along_x.storeys;
            let own = &self.storey_acceleration_m_per_s2[knot * n..(knot + 1) * n];
            let floors = [along_x.storey_accelerations(knot), own].map(|floors| {
                model.frame().masses_kg.iter().zip(floors).map(|(m, a)| m * a).sum::<f64>()
            });
            let pull = |axis: usize| model.total_mass_kg() * slope[axis];
            let own = |axis: usize| model.block().mass_kg * block[axis] + floors[axis];
            return [0, 1].map(|axis| -(own(axis) + pull(axis)));
        };
        // M_tot b + Σ m (a − ℓ·b) ℓ, with the accelerations a of the oscillators along their directions ℓ.
        let mut inertia = [0, 1].map(|k| model.total_mass_kg() * (block[k] + slope[k]));
        let oscillators = structure.oscillators_in_plane();
        for (mode, a) in oscillators.iter().zip(along_x.storey_accelerations(knot)) {
            let [x, y] = mode.direction;
            let own = mode.mass_kg * (a - (x * block[0] + y * block[1]));
            inertia = [inertia[0] + own * x, inertia[1] + own * y];
        }
        inertia.map(|force| -force)
    }

    /// A history whose quantities are those along y.
    fn as_along_x(&self, x: &History) -> History {
        let y = self.clone();
        History {
            storeys: x.storeys,
            interfaces: x.interfaces,
            time_s: x.time_s.clone(),
            table_acceleration_m_per_s2: y.table_acceleration_m_per_s2,
            sliding_displacement_m: y.sliding_displacement_m,
            sliding_velocity_m_per_s: y.sliding_velocity_m_per_s,
            block_acceleration_m_per_s2: y.block_acceleration_m_per_s2,
            friction_force_n: y.friction_force_n,
            storey_displacement_m: y.storey_displacement_m,
            storey_velocity_m_per_s: y.storey_velocity_m_per_s,
            storey_acceleration_m_per_s2: y.storey_acceleration_m_per_s2,
            ..History::default()
        }
    }
}

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
    /// and velocity, total acceleration of the block, friction force; of each storey, or point of a
    /// structure by its modes, displacement and
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
        let kinds: [(&str, OfPoint); 3] = [
            ("displacement_m", Self::point_displacement),
            ("velocity_m_per_s", Self::point_velocity),
            ("acceleration_m_per_s2", Self::point_acceleration),
        ];
        for i in 0..self.points.as_ref().map_or(0, |_| self.point_count()) {
            columns.extend(kinds.map(|(kind, value)| {
                let values = knots.iter().map(|&knot| value(self, knot, i)).collect();
                (format!("point{}_{kind}", i + 1), values)
            }));
        }
        let mut add = |part: &str, count: usize, lists: [&[f64]; 3]| {
            let kinds = ["displacement_m", "velocity_m_per_s", "acceleration_m_per_s2"];
            for i in 0..count {
                for (kind, list) in kinds.iter().zip(lists).filter(|(_, list)| !list.is_empty()) {
                    columns.push((format!("{part}{}_{kind}", i + 1), of(list, count, i)));
                }
            }
        };
        if self.points.is_none() {
            add(
                "storey",
                self.storeys,
                [
                    &self.storey_displacement_m,
                    &self.storey_velocity_m_per_s,
                    &self.storey_acceleration_m_per_s2,
                ],
            );
        }
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
