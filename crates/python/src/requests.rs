//! Requests as keywords: what is asked of an analysis, by the names of its fields.

use pyo3::prelude::*;
use slipstick::assessment::grid;
use slipstick::motion::intensity::LevelMeasure;
use slipstick::requests::{Door, Field, Kind, Request, Takes};

use crate::errors::{of_argument, of_assessment, of_choice};

/// What is given, `(keyword, text)`.
pub(crate) type Asked = Vec<(String, String)>;

/// What is asked of an analysis.
pub(crate) fn asked(py: Python<'_>, kind: &str, given: Asked) -> PyResult<Request> {
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
    Kind::of_name(kind).map_or_else(Vec::new, |kind| kind.offered(Door::Python).map(of).collect())
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
