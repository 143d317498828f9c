//! Requests as keywords: what is asked of an analysis, by the names of its fields.

use pyo3::prelude::*;
use slipstick::assessment::grid;
use slipstick::error::{ChoiceError, MeasureError};
use slipstick::input::{self, EigenMatrices, Override, dimension_of, unit_of_bare};
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

/// A field as the package reads it: name, whether it may be repeated, whether two numbers are the ends of a range,
/// default, what it is.
type Told = (String, bool, bool, &'static str, &'static str);

/// The fields of an analysis that are keywords.
#[pyfunction]
pub(crate) fn fields(kind: &str) -> Vec<Told> {
    let of = |field: &Field| {
        let many = field.takes == Takes::Many;
        (field.name.replace('-', "_"), many, field.is_range, field.default, field.about)
    };
    Kind::of_name(kind)
        .map_or_else(Vec::new, |kind| kind.offered(FrontEnd::Python).map(of).collect())
}

/// The SI unit of bare numbers in a field of an analysis, before which a key of the model may stand; empty where they
/// have none.
#[pyfunction]
pub(crate) fn unit_in(
    kind: &str,
    name: &str,
    key: &str,
    demand: Option<&str>,
    measure: Option<&str>,
) -> &'static str {
    let Some(kind) = Kind::of_name(kind) else { return "" };
    let fields = || kind.fields().iter();
    let given = |other: &str| {
        let given = if other == "demand" { demand } else { measure };
        let default = || fields().find(|field| field.name == other).map_or("", |of| of.default);
        given.unwrap_or_else(default).to_owned()
    };
    let field = fields().find(|field| field.name == name.replace('_', "-"));
    field.map_or("", |field| field.unit(key, given))
}

/// The SI unit of a bare number at a path of the model, or of a plan; empty where it has none.
#[pyfunction]
pub(crate) fn unit_at(path: &str) -> &'static str {
    unit_of_bare(path)
}

/// A measure that records are scaled to.
pub(crate) fn level_measure(py: Python<'_>, name: &str) -> PyResult<LevelMeasure> {
    LevelMeasure::parse(name).map_err(|error| {
        let MeasureError { expected, found, nearest } = error;
        let found = format!("{found:?}");
        of_choice(py, &ChoiceError { what: "measure".to_owned(), expected, found, nearest })
    })
}

/// Levels of a measure that are written as one text, a list or a range, as a plan lists them.
#[pyfunction]
pub(crate) fn levels(py: Python<'_>, text: &str, measure: &str) -> PyResult<Vec<String>> {
    let measure = level_measure(py, measure)?;
    let levels = grid::levels("scale_to", text, &measure.measure);
    let levels = levels.map_err(|error| of_assessment(py, &error))?;
    Ok(levels.iter().map(|level| format!("{level:?} {}", measure.unit())).collect())
}

/// The table `[structure]` of the matrices of an eigenvalue analysis in SI, as paths of its keys with their values.
#[pyfunction]
#[pyo3(name = "keys_of_modes")]
pub(crate) fn keys_of_modes(
    py: Python<'_>,
    shapes: Vec<Vec<f64>>,
    omega_rad_per_s: Vec<f64>,
    damping_ratios: Vec<f64>,
    mass_kg: Vec<Vec<f64>>,
    influence: Vec<f64>,
    points: Vec<(String, usize)>,
) -> PyResult<Vec<(String, String)>> {
    let matrices =
        EigenMatrices { shapes, omega_rad_per_s, damping_ratios, mass_kg, influence, points };
    let modes = matrices.modes().map_err(|error| of_choice(py, &error))?;
    Ok(modes.to_keys())
}

/// The SI unit of a measure that records are scaled to.
#[pyfunction]
pub(crate) fn unit_of_measure(py: Python<'_>, measure: &str) -> PyResult<&'static str> {
    level_measure(py, measure).map(|measure| measure.unit())
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
    let item = item.replacen("structure.mode.", "structure.mode.1.", 1);
    let item = item.replacen("structure.point.", "structure.point.1.", 1);
    Override::removal(&item).map_err(|error| of_input(py, &error))?;
    let is_plain = plain(path, value)?.is_some();
    match dimension_of(&item) {
        Ok(Some(dimension)) if is_plain => quantity(path, value, dimension, true).map(drop),
        _ => Ok(()),
    }
}
