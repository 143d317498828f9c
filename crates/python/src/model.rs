//! `Model`.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString};
use slipstick::error::InputError;
use slipstick::input::{self, Analysis, InputValue, Override};
use slipstick_files::read_at_most;

use crate::errors::{of_argument, of_file, of_input};

/// A checked model: block, slider, storeys, perhaps its own motion and the method.
#[pyclass(module = "slipstick._core", frozen, from_py_object)]
#[derive(Clone, Debug)]
pub struct Model {
    pub(crate) analysis: Analysis,
    /// What errors call its text.
    pub(crate) source: String,
    /// All keys, as TOML.
    text: String,
}

impl Model {
    /// What results call it.
    pub(crate) fn name(&self) -> &str {
        self.analysis.name.as_deref().unwrap_or("model")
    }

    /// What results of one analysis call it: its name, else the stem of its file.
    pub(crate) fn title(&self) -> String {
        let stem = self.path().file_stem().map(|stem| stem.to_string_lossy().into_owned());
        self.analysis.name.clone().or(stem).unwrap_or_else(|| "model".to_owned())
    }

    /// A model that was made elsewhere.
    pub(crate) fn of(analysis: Analysis) -> Self {
        let text = analysis.to_toml_with_motion();
        Self { analysis, source: String::new(), text }
    }

    /// All its keys.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Where its records are looked for.
    pub(crate) fn path(&self) -> &Path {
        Path::new(&self.source)
    }

    /// What makes two models the same: all that is written, and where records are looked for.
    fn identity(&self) -> (String, &Path) {
        let folder = self.path().parent().unwrap_or(Path::new(""));
        (self.analysis.to_toml_with_motion(), folder)
    }
}

/// A value as a person writes it; pint's quantities write themselves so.
fn written(path: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    let py = value.py();
    if value.is_instance_of::<PyBool>() {
        return Ok(if value.extract()? { "true" } else { "false" }.to_owned());
    }
    if value.is_instance_of::<PyString>() {
        return value.extract();
    }
    if value.is_instance_of::<PyInt>() || value.is_instance_of::<PyFloat>() {
        return Ok(value.repr()?.to_string());
    }
    if value.hasattr("magnitude")? && value.hasattr("units")? {
        let number: f64 = value.getattr("magnitude")?.extract()?;
        return Ok(format!("{number:?} {}", pint_units(&value.getattr("units")?)?));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(format!("{number:?}"));
    }
    let found = value.get_type().name()?.to_string();
    Err(of_argument(py, path, "a number, or text such as \"150 mm\"", &found))
}

/// The short form of pint's units, as units are written here.
fn pint_units(units: &Bound<'_, PyAny>) -> PyResult<String> {
    let short: String = units.call_method1("__format__", ("~C",))?.extract()?;
    Ok(short.replace("**", "").replace('*', " ").replace("g_0", "g"))
}

/// `{"slider": {"radius": "2 m"}, "storey": [{…}]}` or `{"slider.radius": "2 m"}` as paths and values.
fn flattened(
    prefix: &str,
    values: &Bound<'_, PyDict>,
    to: &mut Vec<(String, String)>,
) -> PyResult<()> {
    let py = values.py();
    for (key, value) in values {
        let key: String = key
            .extract()
            .map_err(|_| of_argument(py, prefix, "keys that are text", &key.to_string()))?;
        let path = if prefix.is_empty() { key } else { format!("{prefix}.{key}") };
        if let Ok(inner) = value.cast::<PyDict>() {
            flattened(&path, inner, to)?;
        } else if let Ok(list) = value.cast::<PyList>() {
            for (i, item) in list.iter().enumerate() {
                let path = format!("{path}.{}", i + 1);
                match item.cast::<PyDict>() {
                    Ok(inner) => flattened(&path, inner, to)?,
                    Err(_) => to.push((path.clone(), written(&path, &item)?)),
                }
            }
        } else {
            let value = written(&path, &value)?;
            to.push((path, value));
        }
    }
    Ok(())
}

#[pymethods]
impl Model {
    /// A model from the values of its keys.
    #[new]
    fn new(values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut given = Vec::new();
        flattened("", values, &mut given)?;
        let texts: Vec<(&str, InputValue<'_>)> =
            given.iter().map(|(path, text)| (path.as_str(), InputValue::Text(text))).collect();
        let analysis = input::from_values(&texts).map_err(|error| of_input(values.py(), &error))?;
        let text = analysis.to_toml_with_motion();
        Ok(Self { analysis, source: String::new(), text })
    }

    /// Reads a model file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let limit = input::MAX_TEXT_BYTES as u64;
        let bytes = read_at_most(&path, limit).map_err(|error| of_file(py, &error))?;
        let source = path.display().to_string();
        let analysis =
            input::from_bytes(&source, &bytes, &[]).map_err(|error| of_input(py, &error))?;
        Ok(Self { analysis, source, text: String::from_utf8_lossy(&bytes).into_owned() })
    }

    /// A model from the text of a model file.
    #[staticmethod]
    #[pyo3(signature = (text, source = "model.toml"))]
    fn from_toml(py: Python<'_>, text: &str, source: &str) -> PyResult<Self> {
        let analysis = input::parse(source, text, &[]).map_err(|error| of_input(py, &error))?;
        Ok(Self { analysis, source: source.to_owned(), text: text.to_owned() })
    }

    /// The same model with other values of some keys.
    fn with_(&self, values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut given = Vec::new();
        flattened("", values, &mut given)?;
        let set: Result<Vec<Override>, InputError> =
            given.iter().map(|(path, text)| Override::text_value(path, text)).collect();
        let changed = set.and_then(|set| input::parse(&self.source, &self.text, &set));
        let analysis = changed.map_err(|error| of_input(values.py(), &error))?;
        let text = analysis.to_toml_with_motion();
        Ok(Self { analysis, source: self.source.clone(), text })
    }

    /// The model as the text of a model file.
    #[getter]
    fn toml(&self) -> &str {
        &self.text
    }

    /// Its name, where it has one.
    #[getter(name)]
    fn own_name(&self) -> Option<&str> {
        self.analysis.name.as_deref()
    }

    /// Number of storeys.
    #[getter]
    fn storeys(&self) -> usize {
        self.analysis.model.storeys()
    }

    /// Every value in use by its path, as it was written.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        for value in self.analysis.inputs() {
            values.set_item(value.path, value.text)?;
        }
        Ok(values)
    }

    /// The value at a path in SI, where one is written.
    fn value(&self, path: &str) -> Option<f64> {
        self.analysis.value(path)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.identity() == other.identity()
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.identity().hash(&mut hasher);
        hasher.finish()
    }

    fn __repr__(&self) -> String {
        format!("<slipstick.Model {:?}, {} storeys>", self.name(), self.analysis.model.storeys())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, String))> {
        let this = slf.get();
        let make = slf.get_type().getattr("from_toml")?;
        Ok((make, (this.text.clone(), this.source.clone())))
    }
}
