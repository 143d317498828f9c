//! `Model`.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString};
use slipstick::assessment::single::Job;
use slipstick::error::InputError;
use slipstick::input::{self, Analysis, InputValue, Override};
use slipstick::units::Dimension;
use slipstick_files::{modes_beside, read_at_most};
use slipstick_report::opensees::script;

use crate::errors::{of_argument, of_file, of_input};
use crate::motion::{Motion, quantity};

/// A checked model: block, slider, storeys, perhaps its own motion and the method.
///
/// Models do not change; they compare by their keys, hash and pickle.
///
/// Parameters
/// ----------
/// values
///     Keys of the model file with their values, nested or as paths: ``{"block": {"mass": "325 kg"}}``,
///     ``{"block.mass": "325 kg"}``. A value with a dimension is text with its unit, or a quantity of pint.
///
/// Raises
/// ------
/// InputError
///     For a key that no model has, a value of another kind or unit, a key that is missing or excludes
///     another.
///
/// Examples
/// --------
/// >>> import slipstick as ss
/// >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
/// ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
/// >>> model.value("slider.radius")
/// 2.0
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

    /// Read a model file.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     The file, TOML. Records in it are looked for beside it.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     With line and column of the fault.
    /// OSError
    ///     For a file that cannot be read: ``FileNotFoundError`` and its kin.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let limit = input::MAX_TEXT_BYTES as u64;
        let bytes = read_at_most(&path, limit).map_err(|error| of_file(py, &error))?;
        let source = path.display().to_string();
        let modes = modes_beside(&path, &source, &bytes).map_err(|error| of_input(py, &error))?;
        let modes: Vec<Override> = modes.into_iter().collect();
        let analysis =
            input::from_bytes(&source, &bytes, &modes).map_err(|error| of_input(py, &error))?;
        let text = match modes.is_empty() {
            true => String::from_utf8_lossy(&bytes).into_owned(),
            // One text, with the modes in it.
            false => analysis.to_toml_with_motion(),
        };
        Ok(Self { analysis, source, text })
    }

    /// Make a model from the text of a model file.
    ///
    /// Parameters
    /// ----------
    /// text
    ///     TOML.
    /// source
    ///     What errors call it; its folder is where records are looked for.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     With line and column of the fault.
    #[staticmethod]
    #[pyo3(signature = (text, source = "model.toml"))]
    fn from_toml(py: Python<'_>, text: &str, source: &str) -> PyResult<Self> {
        let analysis = input::parse(source, text, &[]).map_err(|error| of_input(py, &error))?;
        Ok(Self { analysis, source: source.to_owned(), text: text.to_owned() })
    }

    /// Give the same model with other values of some keys.
    ///
    /// Setting one of two keys that exclude each other removes the other.
    ///
    /// Parameters
    /// ----------
    /// values
    ///     Keys with their values, as for a new model; storeys count from 1.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For what makes no model.
    ///
    /// Examples
    /// --------
    /// >>> import slipstick as ss
    /// >>> model = ss.Model({"block.mass": "1 t", "slider.static_friction": 0.1,
    /// ...                   "slider.kinetic_friction": 0.08})
    /// >>> model.with_({"slider.kinetic_friction": 0.05}).value("slider.kinetic_friction")
    /// 0.05
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

    /// Give the value at a path in SI; None where none is written.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     Such as ``"slider.radius"`` or ``"storey.1.mass"``.
    fn value(&self, path: &str) -> Option<f64> {
        self.analysis.value(path)
    }

    /// Write the model on a motion as a script for OpenSeesPy.
    ///
    /// Stick becomes an elastic spring, as programs in use today have it. Run as a program the script prints
    /// peak and residual sliding displacement; its function ``analyse`` returns times and displacements.
    ///
    /// Parameters
    /// ----------
    /// motion
    ///     The motion; the model's tail is added.
    /// k_init
    ///     Stiffness of that spring with its unit, ``"10 kN/mm"``: a number that physics does not have.
    ///
    /// Returns
    /// -------
    /// str
    ///     The script, for 0, 1 or more storeys, spring or pendulum, damper, friction by speed, vertical motion,
    ///     two or three pendulums in series, stops and contents. Rigid stops, which OpenSees does not have, are
    ///     springs as stiff as ``k_init`` with the damper of their restitution.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For what such a script cannot express: static above kinetic friction, a stop's damper, flat surfaces
    ///     in series or more than three, a tilt, an initial state, vertical motion that lifts the block.
    ///
    /// Examples
    /// --------
    /// >>> import slipstick as ss
    /// >>> model = ss.Model({"block.mass": "1 t", "slider.static_friction": 0.1,
    /// ...                   "slider.kinetic_friction": 0.1})
    /// >>> script = model.to_opensees(ss.Motion([0.0, 0.3, 0.0], dt=0.5, units="g"), "10 kN/mm")
    /// >>> "ElasticPP" in script
    /// True
    fn to_opensees(
        &self,
        py: Python<'_>,
        motion: &Motion,
        k_init: &Bound<'_, PyAny>,
    ) -> PyResult<String> {
        let k_init = quantity("k_init", k_init, Dimension::Stiffness, false)?;
        let job = Job::new(self.analysis.clone(), motion.0.loaded.clone());
        let job = job.map_err(|error| of_input(py, &error))?;
        script(&self.title(), &self.analysis.model, &job.motion, k_init)
            .map_err(|e| of_argument(py, &e.what, &e.expected, &e.found))
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
