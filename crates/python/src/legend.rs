//! What figures in Matplotlib take from the figures of the reports: labels of axes, units, names and styles of lines,
//! colours. Units are SI, accelerations in g.

use pyo3::prelude::*;
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::key::path_words;
use slipstick_report::display::Unit;
use slipstick_report::legend::{self, Along, AxisQuantity, ENERGIES, LegendEntry, QUANTITIES};

use crate::errors::of_argument;

/// Units that figures in Matplotlib have.
const UNITS: DisplayUnits = DisplayUnits::SiG;

/// Label with the unit, symbol of the unit, what one of it is in SI.
type Axis = (String, &'static str, f64);

fn axis_of(label: String, unit: Unit) -> Axis {
    (label, unit.symbol, unit.in_si)
}

fn known(py: Python<'_>, quantity: &str) -> PyResult<&'static AxisQuantity> {
    let known = QUANTITIES.iter().find(|known| known.key == quantity);
    known.ok_or_else(|| of_argument(py, "quantity", "a quantity of figures", quantity))
}

/// The axis of a quantity for values up to so much, perhaps along `x`, `y` or the `resultant`.
#[pyfunction]
#[pyo3(signature = (quantity, largest_si = 0.0, along = ""))]
pub(crate) fn axis(py: Python<'_>, quantity: &str, largest_si: f64, along: &str) -> PyResult<Axis> {
    let known = known(py, quantity)?;
    let along = Along::of_name(along)
        .ok_or_else(|| of_argument(py, "along", "one of x, y, resultant", along))?;
    let unit = UNITS.unit(known.quantity, largest_si);
    Ok(axis_of(known.label("", along, unit), unit))
}

/// The axis of a column of a table for values up to so much, of an intensity by its name; None for a column that is
/// neither intensity, demand nor key of the model.
#[pyfunction]
#[pyo3(signature = (column, si_unit, largest_si, measure = None))]
pub(crate) fn axis_of_column(
    column: &str,
    si_unit: &str,
    largest_si: f64,
    measure: Option<&str>,
) -> Option<Axis> {
    let found = legend::of_column(column, si_unit, measure, largest_si, UNITS);
    found.map(|(label, unit)| axis_of(label, unit))
}

/// Label, colour, width and dashes.
pub(crate) type Line = (String, &'static str, f64, &'static str);

fn line_of(LegendEntry { label, style, .. }: LegendEntry) -> Line {
    (label.into_owned(), style.colour, style.width, style.dashes)
}

/// Lines of figures by their keys.
#[pyfunction]
pub(crate) fn lines() -> Vec<(&'static str, Line)> {
    legend::entries().into_iter().map(|entry| (entry.key, line_of(entry))).collect()
}

/// Colours of so many lines, no two alike.
#[pyfunction]
pub(crate) fn colours(count: usize) -> Vec<String> {
    legend::colours(count)
}

/// Kinds of energy from the lowest of the stack up: column, label, colour of the area.
#[pyfunction]
pub(crate) fn energies() -> Vec<(&'static str, &'static str, &'static str)> {
    ENERGIES.iter().map(|area| (area.column, area.label, area.fill)).collect()
}

/// `along x`, as a line is called that is one of several.
#[pyfunction]
pub(crate) fn along(axis: &str) -> &'static str {
    Along::of_name(axis).map_or("", Along::line)
}

/// Whether a column of a table is a key of the model that was varied.
#[pyfunction]
pub(crate) fn is_key(column: &str) -> bool {
    legend::is_key(column)
}

/// The axis of a demand, of what is made of one, and of what a test measures, by its key.
#[pyfunction]
pub(crate) fn axis_of_words(key: &str, si_unit: &str, largest_si: f64) -> Axis {
    let (label, unit) = legend::of_words(key, si_unit, largest_si, UNITS);
    axis_of(label, unit)
}

/// The axis of a quantity that is not exceeded in a share of the records.
#[pyfunction]
pub(crate) fn axis_of_share(
    py: Python<'_>,
    quantity: &str,
    share: f64,
    largest_si: f64,
) -> PyResult<Axis> {
    let known = known(py, quantity)?;
    let unit = UNITS.unit(known.quantity, largest_si);
    Ok(axis_of(unit.label(&legend::not_exceeded(known.words, share)), unit))
}

/// The band of a fragility.
#[pyfunction]
pub(crate) fn band(confidence: f64) -> String {
    legend::band(confidence)
}

/// A key of the model as people read it.
#[pyfunction]
pub(crate) fn words_of_key(path: &str) -> String {
    path_words(path)
}

/// What a tornado has along its axis.
#[pyfunction]
pub(crate) fn change(demand: &str) -> String {
    legend::change(demand)
}

/// Bounds of the friction force of a response in N, each with its line.
pub(crate) fn friction_bounds(model: &slipstick::model::Model) -> Vec<(f64, Line)> {
    let normal_n = model.normal_n();
    let bounds = slipstick_report::figures::friction_bounds(model).into_iter();
    bounds.map(|(share, entry)| (share * normal_n, line_of(entry))).collect()
}
