//! Columns of a study's table.

use crate::response::{Demands, StoreyDemands};

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A number; none where it does not exist.
    Number,
    /// A whole number.
    Count,
    /// Yes or no.
    Flag,
}

/// A column of numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// The SI unit of its values (Hz for frequencies); empty where they have none.
    pub unit: &'static str,
    /// What it holds.
    pub kind: ColumnKind,
}

impl Column {
    pub(super) fn number(name: impl Into<String>, unit: &'static str) -> Self {
        Self { name: name.into(), unit, kind: ColumnKind::Number }
    }
}

/// A demand: its key in the summary of a run, unit, kind and value.
type Entry<D> = (&'static str, &'static str, ColumnKind, fn(&D) -> Option<f64>);

use ColumnKind::{Count, Flag, Number};

const BEFORE_STOREYS: [Entry<Demands>; 13] = [
    ("peak_sliding_displacement_m", "m", Number, |d| Some(d.peak_sliding_displacement_m)),
    ("peak_sliding_displacement_time_s", "s", Number, |d| Some(d.peak_sliding_displacement_time_s)),
    ("max_sliding_displacement_m", "m", Number, |d| Some(d.max_sliding_displacement_m)),
    ("min_sliding_displacement_m", "m", Number, |d| Some(d.min_sliding_displacement_m)),
    ("residual_sliding_displacement_m", "m", Number, |d| Some(d.residual_sliding_displacement_m)),
    ("sliding_at_end", "", Flag, |d| Some(f64::from(u8::from(d.sliding_at_end)))),
    ("sliding_path_m", "m", Number, |d| Some(d.sliding_path_m)),
    ("peak_sliding_velocity_m_per_s", "m/s", Number, |d| Some(d.peak_sliding_velocity_m_per_s)),
    ("sliding_time_s", "s", Number, |d| Some(d.sliding_time_s)),
    ("slip_count", "", Count, |d| Some(d.slip_count as f64)),
    ("reversal_count", "", Count, |d| Some(d.reversal_count as f64)),
    ("stick_count", "", Count, |d| Some(d.stick_count as f64)),
    ("block.peak_acceleration_m_per_s2", "m/s2", Number, |d| {
        Some(d.peak_block_acceleration_m_per_s2)
    }),
];

const OF_STOREY: [Entry<StoreyDemands>; 4] = [
    ("peak_acceleration_m_per_s2", "m/s2", Number, |d| Some(d.peak_acceleration_m_per_s2)),
    ("peak_displacement_m", "m", Number, |d| Some(d.peak_displacement_m)),
    ("peak_drift_m", "m", Number, |d| Some(d.peak_drift_m)),
    ("peak_drift_ratio", "", Number, |d| d.peak_drift_ratio),
];

const AFTER_STOREYS: [Entry<Demands>; 9] = [
    ("peak_base_shear_n", "N", Number, |d| Some(d.peak_base_shear_n)),
    ("peak_friction_force_n", "N", Number, |d| Some(d.peak_friction_force_n)),
    ("peak_slider_force_n", "N", Number, |d| Some(d.peak_slider_force_n)),
    ("base_shear_coefficient", "", Number, |d| Some(d.base_shear_coefficient)),
    ("friction_coefficient_used", "", Number, |d| Some(d.friction_coefficient_used)),
    ("slider_force_coefficient", "", Number, |d| Some(d.slider_force_coefficient)),
    ("gap_ratio", "", Number, |d| d.gap_ratio),
    ("overturning_ratio", "", Number, |d| d.overturning_ratio),
    ("closest_stop", "", Number, |d| d.closest_stop),
];

/// The demands of a structure of so many storeys, named as in the summary of a run; what that has
/// under `storeys[i].` is called `storey1_…` and so on.
#[must_use]
pub fn demand_columns(storeys: usize) -> Vec<Column> {
    let named = |name: String, unit, kind| Column { name, unit, kind };
    let plain = |&(name, unit, kind, _): &Entry<Demands>| named(name.to_owned(), unit, kind);
    let mut columns: Vec<Column> = BEFORE_STOREYS.iter().map(plain).collect();
    for storey in 1..=storeys {
        columns.extend(
            OF_STOREY
                .iter()
                .map(|&(name, unit, kind, _)| named(format!("storey{storey}_{name}"), unit, kind)),
        );
    }
    columns.extend(AFTER_STOREYS.iter().map(plain));
    columns
}

/// The values of [`demand_columns`]; NaN where there is none.
#[must_use]
pub fn demand_values(demands: &Demands) -> Vec<f64> {
    let length = BEFORE_STOREYS.len() + AFTER_STOREYS.len();
    let mut values = Vec::with_capacity(length + OF_STOREY.len() * demands.storeys.len());
    let mut push = |value: Option<f64>| values.push(value.unwrap_or(f64::NAN));
    BEFORE_STOREYS.iter().for_each(|(.., value)| push(value(demands)));
    for storey in &demands.storeys {
        OF_STOREY.iter().for_each(|(.., value)| push(value(storey)));
    }
    AFTER_STOREYS.iter().for_each(|(.., value)| push(value(demands)));
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_columns_and_values_stand_in_the_same_order() {
        let storey = |peak_drift_m| StoreyDemands { peak_drift_m, ..Default::default() };
        let demands = Demands {
            peak_sliding_displacement_m: 1.0,
            slip_count: 2,
            sliding_at_end: true,
            storeys: vec![storey(3.0), storey(4.0)],
            overturning_ratio: Some(5.0),
            ..Default::default()
        };
        let (columns, values) = (demand_columns(2), demand_values(&demands));
        assert_eq!(columns.len(), values.len());
        let of = |name: &str| values[columns.iter().position(|c| c.name == name).unwrap()];
        assert_eq!(of("peak_sliding_displacement_m"), 1.0);
        assert_eq!(of("slip_count"), 2.0);
        assert_eq!(of("sliding_at_end"), 1.0);
        assert_eq!([of("storey1_peak_drift_m"), of("storey2_peak_drift_m")], [3.0, 4.0]);
        assert_eq!(of("overturning_ratio"), 5.0);
        assert!(of("gap_ratio").is_nan() && of("storey1_peak_drift_ratio").is_nan());
    }
}
