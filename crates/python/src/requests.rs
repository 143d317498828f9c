//! Requests as keywords: what is asked of an analysis, by the names of its fields.

use pyo3::prelude::*;
use slipstick::assessment::grid;
use slipstick::input::{self, Override, dimension_of};
use slipstick::motion::intensity::LevelMeasure;
use slipstick::requests::{Field, FrontEnd, Kind, Request, Takes};
use slipstick::units::{Dimension, Unit, all};

use crate::errors::{of_argument, of_assessment, of_choice, of_input};
use crate::values::{plain, quantity};

/// What is given, `(keyword, text)`.
pub(crate) type FieldTexts = Vec<(String, String)>;

/// What is asked of an analysis.
pub(crate) fn asked(py: Python<'_>, kind: &str, given: FieldTexts) -> PyResult<Request> {
    let names = Kind::ALL.map(Kind::name).join(", ");
    let kind = Kind::of_name(kind).ok_or_else(|| of_argument(py, "kind", &names, kind))?;
    let given = given.into_iter().map(|(name, text)| (name.replace('_', "-"), text));
    let given: Vec<(String, String)> = given.collect();
    let given = given.iter().map(|(name, text)| (name.as_str(), text.clone()));
    Request::new(kind, given).map_err(|error| of_choice(py, &error))
}

/// The fields of an analysis that are keywords: name, whether it may be repeated, default, what it is.
#[pyfunction]
pub(crate) fn fields(kind: &str) -> Vec<(String, bool, &'static str, &'static str)> {
    let of = |field: &Field| {
        let many = field.takes == Takes::Many;
        (field.name.replace('-', "_"), many, field.default, field.about)
    };
    Kind::of_name(kind)
        .map_or_else(Vec::new, |kind| kind.offered(FrontEnd::Python).map(of).collect())
}

/// Levels of a measure that are written as one text, a list or a range, as a plan lists them.
#[pyfunction]
pub(crate) fn levels(py: Python<'_>, text: &str, measure: &str) -> PyResult<Vec<String>> {
    let measure = LevelMeasure::parse(measure).map_err(|error| {
        let found = format!("{:?}", error.found);
        of_argument(py, "measure", &error.expected, &found)
    })?;
    let levels = grid::levels("levels", text, &measure.measure);
    let levels = levels.map_err(|error| of_assessment(py, &error))?;
    Ok(levels.iter().map(|level| format!("{level:?} {}", measure.unit())).collect())
}

/// The JSON schema of the model file, or of a plan.
#[pyfunction]
pub(crate) fn schema(plan: bool) -> String {
    if plan { input::plan_json_schema() } else { input::json_schema() }
}

/// All units: name, what it measures, what one of it is in SI, the SI unit.
#[pyfunction]
pub(crate) fn units() -> Vec<(&'static str, &'static str, f64, &'static str)> {
    let of = |(dimension, unit): (Dimension, &'static Unit)| {
        (unit.name(), dimension.name(), unit.to_si(1.0), dimension.si_unit())
    };
    all().map(of).collect()
}

/// Checks one value of a model by its path: its kind and its unit. Tables and lists are the model's to check.
#[pyfunction]
pub(crate) fn check(path: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
    let py = value.py();
    let item = path.replacen("storey.", "storey.1.", 1).replacen("contents.", "contents.1.", 1);
    let item = item.replacen("slider.surface.", "slider.surface.1.", 1);
    Override::removal(&item).map_err(|error| of_input(py, &error))?;
    let is_plain = plain(path, value)?.is_some();
    match dimension_of(&item) {
        Ok(Some(dimension)) if is_plain => quantity(path, value, dimension, false).map(drop),
        _ => Ok(()),
    }
}
