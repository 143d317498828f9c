//! Values of Python: numbers of every kind, quantities, arrays.

use std::path::PathBuf;

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyMapping, PyString, PyTuple};
use slipstick::error::similar;
use slipstick::input::unit_of_bare;
use slipstick::record::{Quantity, Units};
use slipstick::units::{Dimension, parse_quantity, parse_unit};

use crate::errors::{of_argument, of_unit};

/// A number, a flag or a text as Python's own: scalars of NumPy and arrays without a dimension, fractions,
/// decimals; of a quantity of pint its text. None where a value is none of these.
pub(crate) fn plain<'py>(
    path: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let py = value.py();
    let own = value.is_instance_of::<PyBool>() || value.is_instance_of::<PyInt>();
    if own || value.is_instance_of::<PyString>() {
        return Ok(Some(value.clone()));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Some(PyFloat::new(py, value.extract()?).into_any()));
    }
    if value.hasattr("magnitude")? && value.hasattr("units")? {
        let Some(number) = plain(path, &value.getattr("magnitude")?)? else { return Ok(None) };
        let text = format!("{} {}", number.repr()?, pint_units(&value.getattr("units")?)?);
        return Ok(Some(PyString::new(py, &text).into_any()));
    }
    // An item of a column of PyArrow.
    if value.hasattr("as_py")? {
        return plain(path, &value.call_method0("as_py")?);
    }
    if value.hasattr("mask")? {
        return Err(of_argument(py, path, "a value", "a masked one"));
    }
    if value.hasattr("ndim")? && value.hasattr("item")? {
        if value.getattr("ndim")?.extract::<usize>()? != 0 {
            return Ok(None);
        }
        let item = value.call_method0("item")?;
        if !item.get_type().is(value.get_type()) {
            return plain(path, &item);
        }
    }
    let number = value.hasattr("__float__")?.then(|| value.extract::<f64>().ok()).flatten();
    Ok(number.map(|number| PyFloat::new(py, number).into_any()))
}

/// The same for the package.
#[pyfunction]
#[pyo3(name = "plain")]
pub(crate) fn as_plain<'py>(
    path: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    plain(path, value)
}

/// The value at a path of a model as a person writes it: a bare number of what has a dimension is in SI.
pub(crate) fn written(path: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    let Some(plain) = plain(path, value)? else {
        let found = value.get_type().name()?.to_string();
        let expected = "a number, or text such as \"150 mm\"";
        return Err(of_argument(value.py(), path, expected, &found));
    };
    if plain.is_instance_of::<PyBool>() {
        return Ok(if plain.extract()? { "true" } else { "false" }.to_owned());
    }
    let text = plain.str()?.to_string();
    let unit = if plain.is_instance_of::<PyString>() { "" } else { unit_of_bare(path) };
    Ok(if unit.is_empty() { text } else { format!("{text} {unit}") })
}

/// The short form of pint's units, as units are written here.
pub(crate) fn pint_units(units: &Bound<'_, PyAny>) -> PyResult<String> {
    let short: String = units.call_method1("__format__", ("~C",))?.extract()?;
    Ok(short.replace("**", "").replace('*', " ").replace("g_0", "g"))
}

/// A quantity with its unit; a plain number where the unit is known.
pub(crate) fn quantity(
    name: &str,
    value: &Bound<'_, PyAny>,
    dimension: Dimension,
    number_in_si: bool,
) -> PyResult<f64> {
    let py = value.py();
    if value.is_instance_of::<PyString>() {
        let text: String = value.extract()?;
        return parse_quantity(&text, dimension).map_err(|error| of_unit(py, name, &error));
    }
    if let Some(plain) = plain(name, value)? {
        if plain.is_instance_of::<PyString>() {
            return quantity(name, &plain, dimension, number_in_si);
        }
        if number_in_si && !plain.is_instance_of::<PyBool>() {
            return plain.extract();
        }
    }
    let expected =
        format!("{} with its unit, such as {:?}", dimension.with_article(), dimension.example());
    Err(of_argument(py, name, &expected, &value.repr()?.to_string()))
}

/// Samples as doubles: any real array of one dimension.
pub(crate) fn samples(name: &str, values: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let py = values.py();
    let numpy = py.import("numpy")?;
    let expected = "numbers in one dimension";
    if numpy.getattr("ma")?.call_method1("isMaskedArray", (values,))?.is_truthy()? {
        let expected = "an array without a mask (a gap is no acceleration)";
        return Err(of_argument(py, name, expected, "a masked one"));
    }
    let array = numpy
        .call_method1("asarray", (values,))
        .map_err(|_| of_argument(py, name, expected, "no array"))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    let shape = array.getattr("shape")?.repr()?.to_string();
    if !matches!(kind.as_str(), "f" | "i" | "u") || array.getattr("ndim")?.extract::<usize>()? != 1
    {
        let found = format!("an array of shape {shape} and type {}", array.getattr("dtype")?);
        return Err(of_argument(py, name, expected, &found));
    }
    let array = numpy.call_method1("require", (array, "f8", ("C_CONTIGUOUS", "ALIGNED")))?;
    let array: PyReadonlyArray1<'_, f64> = array.extract()?;
    Ok(array.as_slice()?.to_vec())
}

/// Units of the values of a record.
pub(crate) fn record_units(value: &Bound<'_, PyAny>) -> PyResult<Units> {
    let expected = "units of a record, such as \"g\" or \"cm/s2\"";
    let text: Option<String> = value.extract().ok();
    let units = text.as_deref().and_then(Units::parse);
    let found = || text.clone().unwrap_or_else(|| described(value));
    units.ok_or_else(|| of_argument(value.py(), "units", expected, &found()))
}

/// Units of acceleration.
fn units_of(py: Python<'_>, text: &str) -> PyResult<Units> {
    let units = Units::parse(text).filter(|units| units.quantity() == Quantity::Acceleration);
    units.ok_or_else(|| match parse_unit(text, Dimension::Acceleration) {
        Err(error) => of_unit(py, "units", &error),
        Ok(_) => of_argument(py, "units", "units of acceleration, such as \"g\"", text),
    })
}

/// Accelerations in SI, and the units that they were in.
pub(crate) fn accelerations(
    name: &str,
    values: &Bound<'_, PyAny>,
    units: Option<&str>,
) -> PyResult<(Vec<f64>, Units)> {
    let py = values.py();
    let own = values.hasattr("magnitude")? && values.hasattr("units")?;
    let (magnitudes, units) = match (own, units) {
        (false, Some(text)) => (values.clone(), units_of(py, text)?),
        (true, None) => {
            let text = pint_units(&values.getattr("units")?)?;
            (values.getattr("magnitude")?, units_of(py, &text)?)
        }
        (true, Some(text)) => {
            return Err(of_argument(
                py,
                "units",
                "none beside a quantity, which has its own",
                text,
            ));
        }
        (false, None) => {
            return Err(of_argument(py, "units", "units of the values, such as \"g\"", "none"));
        }
    };
    let in_si = samples(name, &magnitudes)?.into_iter().map(|value| units.si() * value);
    Ok((in_si.collect(), units))
}

/// A number of any kind, without a dimension.
pub(crate) fn number_in(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let number = plain(name, value)?.and_then(|plain| plain.extract::<f64>().ok());
    number.ok_or_else(|| other(name, "a number", value))
}

/// What stands in place of something else, as a person calls it.
pub(crate) fn described(value: &Bound<'_, PyAny>) -> String {
    let own = [
        value.is_none(),
        value.is_instance_of::<PyBool>(),
        value.is_instance_of::<PyInt>(),
        value.is_instance_of::<PyFloat>(),
        value.is_instance_of::<PyString>(),
    ];
    let text = own.contains(&true).then(|| value.repr().ok()).flatten();
    let text = text.map(|text| text.to_string()).filter(|text| text.chars().count() <= 40);
    text.unwrap_or_else(|| {
        let name = value.get_type().name();
        name.map_or_else(|_| "another value".to_owned(), |name| name.to_string())
    })
}

/// The same for the package.
#[pyfunction]
#[pyo3(name = "described")]
pub(crate) fn as_described(value: &Bound<'_, PyAny>) -> String {
    described(value)
}

/// The one of some names that is nearest to another; none where no one is near.
#[pyfunction]
pub(crate) fn nearest(name: &str, names: Vec<String>) -> Option<String> {
    similar(name, names.iter().map(String::as_str))
}

/// An argument that is something else.
fn other(name: &str, expected: &str, value: &Bound<'_, PyAny>) -> PyErr {
    of_argument(value.py(), name, expected, &described(value))
}

/// A text.
pub(crate) fn text_in(name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    value.extract().map_err(|_| other(name, "text", value))
}

/// Texts, each an argument of its own.
pub(crate) fn texts_in(name: &str, values: &Bound<'_, PyTuple>) -> PyResult<Vec<String>> {
    values.iter().map(|value| text_in(name, &value)).collect()
}

/// A path.
pub(crate) fn path_in(name: &str, value: &Bound<'_, PyAny>) -> PyResult<PathBuf> {
    value.extract().map_err(|_| other(name, "a path", value))
}

/// A whole number that is not negative.
pub(crate) fn count_in(name: &str, value: &Bound<'_, PyAny>) -> PyResult<usize> {
    let whole = (!value.is_instance_of::<PyBool>()).then(|| value.extract().ok()).flatten();
    whole.ok_or_else(|| other(name, "a whole number ≥ 0", value))
}

/// Values by keys that are text.
pub(crate) fn keys_in<'py>(
    name: &str,
    expected: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    if let Ok(dict) = value.cast::<PyDict>() {
        return Ok(dict.clone());
    }
    let mapping = value.cast::<PyMapping>().map_err(|_| other(name, expected, value))?;
    let dict = PyDict::new(value.py());
    dict.update(mapping)?;
    Ok(dict)
}

/// A channel by its name, or by its number from 1.
pub(crate) fn channel_of(value: &Bound<'_, PyAny>) -> PyResult<String> {
    let is_number = !value.is_instance_of::<PyBool>() && value.hasattr("__index__")?;
    if is_number && value.extract::<u32>().is_ok_and(|number| number > 0) {
        return Ok(value.call_method0("__index__")?.to_string());
    }
    value.extract().map_err(|_| {
        let expected = "the name of a channel, or its number from 1";
        let found =
            value.repr().map_or_else(|_| "another value".to_owned(), |text| text.to_string());
        of_argument(value.py(), "channel", expected, &found)
    })
}
