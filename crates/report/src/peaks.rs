//! The rows of the table of peaks, shared by the plain-text table and the report.

use crate::display::{DisplayUnits, Quantity, Unit};
use crate::number::significant;
use crate::summary::Summary;

/// One quantity over the runs side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What it is.
    pub label: String,
    /// Symbol of its unit, empty for ratios.
    pub unit: &'static str,
    /// One value a run, 4 significant digits in plain characters.
    pub values: Vec<String>,
    /// The run whose value is largest in size, where there are several and they differ.
    pub governing: Option<usize>,
}

/// Rows in the order in which an engineer asks: sliding, block, storeys, forces, ratios.
///
/// The columns are those of [`Summary::runs`].
#[must_use]
pub fn rows(summary: &Summary, display: DisplayUnits) -> Vec<Row> {
    let runs: Vec<&Summary> = summary.runs().into_iter().map(|(_, run)| run).collect();
    let mut table = Table { runs, display, rows: Vec::new() };
    let has = |pick: fn(&Summary) -> Option<f64>| pick(summary).is_some();
    table.add("Peak sliding displacement", Quantity::Length, |r| {
        r.demands.peak_sliding_displacement_m
    });
    table.note("  at time", Quantity::Time, |r| r.demands.peak_sliding_displacement_time_s);
    table.add("Residual sliding displacement", Quantity::Length, |r| {
        r.demands.residual_sliding_displacement_m
    });
    table.note("Largest towards +x", Quantity::Length, |r| r.demands.max_sliding_displacement_m);
    table.note("Largest towards −x", Quantity::Length, |r| r.demands.min_sliding_displacement_m);
    table.add("Sliding path", Quantity::Length, |r| r.demands.sliding_path_m);
    table.add("Peak sliding velocity", Quantity::Velocity, |r| {
        r.demands.peak_sliding_velocity_m_per_s
    });
    table.note("Time spent sliding", Quantity::Time, |r| r.demands.sliding_time_s);
    table.add("Peak block acceleration", Quantity::Acceleration, |r| {
        r.demands.peak_block_acceleration_m_per_s2
    });
    for i in 0..summary.demands.storeys.len() {
        let storey = |r: &Summary| r.demands.storeys.get(i).copied().unwrap_or_default();
        let name = |what: &str| format!("Storey {} {what}", i + 1);
        table.add(&name("peak acceleration"), Quantity::Acceleration, |r| {
            storey(r).peak_acceleration_m_per_s2
        });
        table.add(&name("peak displacement"), Quantity::Length, |r| storey(r).peak_displacement_m);
        table.add(&name("peak drift"), Quantity::Length, |r| storey(r).peak_drift_m);
        if storey(summary).peak_drift_ratio.is_some() {
            table.add(&name("peak drift ratio"), Quantity::Ratio, |r| {
                storey(r).peak_drift_ratio.unwrap_or(f64::NAN)
            });
        }
    }
    if !summary.demands.storeys.is_empty() {
        table.add("Peak base shear", Quantity::Force, |r| r.demands.peak_base_shear_n);
        table.add("  over the weight", Quantity::Ratio, |r| r.demands.base_shear_coefficient);
    }
    table.add("Peak friction force", Quantity::Force, |r| r.demands.peak_friction_force_n);
    table.add("  over the weight", Quantity::Ratio, |r| r.demands.friction_coefficient_used);
    table.add("Peak slider force", Quantity::Force, |r| r.demands.peak_slider_force_n);
    table.add("  over the weight", Quantity::Ratio, |r| r.demands.slider_force_coefficient);
    if has(|s| s.demands.gap_ratio) {
        table.add("Peak sliding over gap", Quantity::Ratio, |r| {
            r.demands.gap_ratio.unwrap_or(f64::NAN)
        });
    }
    if has(|s| s.demands.overturning_ratio) {
        table.add("Overturning ratio", Quantity::Ratio, |r| {
            r.demands.overturning_ratio.unwrap_or(f64::NAN)
        });
    }
    table.rows
}

struct Table<'a> {
    runs: Vec<&'a Summary>,
    display: DisplayUnits,
    rows: Vec<Row>,
}

impl Table<'_> {
    /// A demand, of which the largest value governs.
    fn add(&mut self, label: &str, quantity: Quantity, value: impl Fn(&Summary) -> f64) {
        let values: Vec<f64> = self.runs.iter().map(|run| value(run)).collect();
        let governing = governing(&values);
        self.push(label, quantity, &values, governing);
    }

    /// A figure that governs nothing.
    fn note(&mut self, label: &str, quantity: Quantity, value: impl Fn(&Summary) -> f64) {
        let values: Vec<f64> = self.runs.iter().map(|run| value(run)).collect();
        self.push(label, quantity, &values, None);
    }

    fn push(&mut self, label: &str, quantity: Quantity, si: &[f64], governing: Option<usize>) {
        let largest = si.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let Unit { in_si, symbol } = self.display.unit(quantity, largest);
        self.rows.push(Row {
            label: label.to_owned(),
            unit: symbol,
            values: si.iter().map(|value| significant(value / in_si, 4)).collect(),
            governing,
        });
    }
}

/// Index of the value largest in size, unless there is one value only or all are the same.
fn governing(values: &[f64]) -> Option<usize> {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    if values.iter().all(|value| value.abs() == largest) {
        return None;
    }
    values.iter().position(|value| value.abs() == largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_largest_in_size_governs() {
        assert_eq!(governing(&[1.0, -3.0, 2.0]), Some(1));
        assert_eq!(governing(&[2.0]), None);
        assert_eq!(governing(&[2.0, 2.0, 2.0]), None);
    }
}
