//! Demands over the height of the structure, over a suite.

use super::ModelHistories;
use super::over_suite::OverSuite;
use crate::assessment::floors::place_name;
use crate::model::Model;
use crate::response::{DemandColumn, DemandOf, DemandShape};
use crate::table::Table;

/// The demands of floors and points that profiles are of, in their order: the key of one of the block beside them, and
/// that of a storey.
const PROFILES: [(Option<&str>, &str); 5] = [
    (Some("block.peak_acceleration_m_per_s2"), "peak_acceleration_m_per_s2"),
    (None, "peak_displacement_m"),
    (None, "peak_drift_m"),
    (None, "peak_drift_ratio"),
    (None, "peak_shear_n"),
];

/// A demand at every level that has it, from below: the block, the storeys or the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Key of the demand, of one storey: `peak_drift_m`.
    pub key: &'static str,
    /// Levels and the demands there: 0 the block, then the storeys or points.
    pub levels: Vec<(usize, DemandColumn)>,
}

impl Profile {
    /// Those of a structure of two storeys or points and more; less has no height.
    #[must_use]
    pub fn all(shape: DemandShape) -> Vec<Self> {
        let (of, count) = match shape.storeys {
            0 => (DemandOf::Point, shape.points),
            storeys => (DemandOf::Storey, storeys),
        };
        if count < 2 {
            return Vec::new();
        }
        let columns = shape.columns();
        let one = |(of_block, key): (Option<&str>, &'static str)| {
            let of_level = |column: &DemandColumn| {
                let is_block =
                    column.demand.of == DemandOf::Run && Some(column.demand.key) == of_block;
                let is_level = column.demand.of == of && column.demand.key == key;
                let level = if is_block { 0 } else { column.part };
                (is_block || is_level).then_some((level, *column))
            };
            let mut levels: Vec<_> = columns.iter().filter_map(of_level).collect();
            levels.sort_by_key(|(level, _)| *level);
            Self { key, levels }
        };
        PROFILES.into_iter().map(one).collect()
    }
}

impl ModelHistories {
    /// The profiles that the model has of what every record has, with a bound of friction: statistics level by level.
    #[must_use]
    pub fn profiles(&self, bound: usize) -> Vec<(Profile, Vec<OverSuite>)> {
        let over = |profile: Profile| {
            let each = profile.levels.iter();
            let over: Option<Vec<OverSuite>> =
                each.map(|(_, column)| self.over_suite(|on| on.size(column, bound))).collect();
            Some((profile, over?))
        };
        Profile::all(self.shape()).into_iter().filter_map(over).collect()
    }
}

/// Heights of the levels above the block in m, the block first, where the model gives all of them.
pub(super) fn levels_m(model: &Model) -> Option<Vec<f64>> {
    let mut levels_m = vec![0.0];
    for point in 0..model.points() {
        levels_m.push(levels_m[point] + model.rise_m(point)?);
    }
    Some(levels_m)
}

/// The profiles of all models over their suites, a row a model, bound, demand and level; none without any.
pub(super) fn table(models: &[ModelHistories]) -> Option<Table> {
    let mut rows = Vec::new();
    for model in models {
        for bound in 0..model.bounds.len() {
            for (profile, over) in model.profiles(bound) {
                let levels = profile.levels.into_iter().zip(over);
                rows.extend(levels.map(|(level, over)| (model, bound, profile.key, level, over)));
            }
        }
    }
    let height = |model: &ModelHistories, level: usize| {
        model.levels_m.as_ref().map_or(f64::NAN, |levels_m| levels_m[level])
    };
    let mut table = Table::default();
    table
        .texts("model", rows.iter().map(|(model, ..)| model.name.clone()).collect())
        .texts("friction", rows.iter().map(|(m, i, ..)| m.bounds[*i].name.to_owned()).collect())
        .texts("demand", rows.iter().map(|(_, _, key, ..)| (*key).to_owned()).collect())
        .numbers("level", "", rows.iter().map(|(.., (level, _), _)| *level as f64).collect())
        .texts(
            "name",
            rows.iter().map(|(m, _, _, (level, _), _)| place_name(&m.names, level + 1)).collect(),
        )
        .numbers(
            "height_m",
            "m",
            rows.iter().map(|(m, _, _, (level, _), _)| height(m, *level)).collect(),
        );
    let all: Vec<OverSuite> = rows.iter().map(|(.., over)| *over).collect();
    OverSuite::add_columns(&all, &mut table, "", "");
    (!rows.is_empty()).then_some(table)
}
