//! `Model`.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use slipstick::assessment::single::Job;
use slipstick::error::InputError;
use slipstick::input::{self, Analysis, InputValue, MotionSource, Override};
use slipstick::units::Dimension;
use slipstick_files::{modes_beside, read_at_most};
use slipstick_report::examples;
use slipstick_report::opensees::script;

use crate::errors::{of_argument, of_file, of_input};
use crate::motion::Motion;
use crate::values::{count_in, described, keys_in, number_in, path_in, quantity, text_in, written};

/// A checked model: block, slider, storeys, perhaps its own motion and the method.
///
/// Models do not change; they compare by the values of their keys (``"2 m"`` is ``"2000 mm"``), hash and pickle.
///
/// Parameters
/// ----------
/// values
///     Keys of the model file with their values, nested or as paths: ``{"block": {"mass": "325 kg"}}``,
///     ``{"block.mass": "325 kg"}``. A value with a dimension is text with its unit, or a quantity of pint; one
///     without is any number, a scalar of NumPy too.
/// tables
///     The same by keyword, beside or in place of them: ``block=ss.Block(mass="325 kg")``,
///     ``storey=[ss.Storey(...), ...]``, ``motion=ss.Sine(...)``.
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

    /// A model of the text of a model file.
    fn of_toml(py: Python<'_>, text: &str, source: &str) -> PyResult<Self> {
        let analysis = input::parse(source, text, &[]).map_err(|error| of_input(py, &error))?;
        let source = if source.is_empty() { String::new() } else { absolute(source) };
        Ok(Self { analysis, source, text: text.to_owned() })
    }

    /// What makes two models the same: the values of all keys, and where their record is looked for.
    fn identity(&self) -> (String, &Path) {
        let has_record = matches!(self.analysis.motion, Some(MotionSource::Record(_)));
        let folder = self.path().parent().filter(|_| has_record);
        (self.analysis.canonical(), folder.unwrap_or(Path::new("")))
    }
}

/// `{"slider": {"radius": "2 m"}, "storey": [{…}]}` or `{"slider.radius": "2 m"}` as paths and values; no
/// value where it is None.
fn flattened(
    prefix: &str,
    values: &Bound<'_, PyDict>,
    to: &mut Vec<(String, Option<String>)>,
) -> PyResult<()> {
    let py = values.py();
    for (key, value) in values {
        let key: String = key
            .extract()
            .map_err(|_| of_argument(py, prefix, "keys that are text", &key.to_string()))?;
        let path = if prefix.is_empty() { key } else { format!("{prefix}.{key}") };
        if let Ok(inner) = value.cast::<PyDict>() {
            flattened(&path, inner, to)?;
        } else if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
            for (i, item) in value.try_iter()?.enumerate() {
                let (path, item) = (format!("{path}.{}", i + 1), item?);
                match item.cast::<PyDict>() {
                    Ok(inner) => flattened(&path, inner, to)?,
                    Err(_) => given_once(py, path, &item, to)?,
                }
            }
        } else {
            given_once(py, path, &value, to)?;
        }
    }
    Ok(())
}

/// Takes a value at its path.
fn given_once(
    py: Python<'_>,
    path: String,
    value: &Bound<'_, PyAny>,
    to: &mut Vec<(String, Option<String>)>,
) -> PyResult<()> {
    if to.iter().any(|(given, _)| *given == path) {
        return Err(of_argument(py, &path, "one value", "two"));
    }
    let text = if value.is_none() { None } else { Some(written(&path, value)?) };
    to.push((path, text));
    Ok(())
}

/// What is expected where keys of a model stand.
const KEYS: &str = "keys of a model with their values, {\"slider.radius\": \"2 m\"}";

/// A path from here, as long as there is one, so that it holds after a change of folder.
fn absolute(path: &str) -> String {
    let whole = std::path::absolute(path);
    whole.map_or_else(|_| path.to_owned(), |path| path.display().to_string())
}

#[pymethods]
impl Model {
    #[new]
    #[pyo3(signature = (values = None, **tables))]
    fn new(
        py: Python<'_>,
        values: Option<&Bound<'_, PyAny>>,
        tables: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let mut given = Vec::new();
        let values = values.map(|values| keys_in("values", KEYS, values)).transpose()?;
        for values in values.iter().chain(tables) {
            flattened("", values, &mut given)?;
        }
        let text = |(path, text)| Some((path, InputValue::Text(text?)));
        let given = given.iter().map(|(path, text)| (path.as_str(), text.as_deref()));
        let texts: Vec<(&str, InputValue<'_>)> = given.filter_map(text).collect();
        let analysis = input::from_values(&texts).map_err(|error| of_input(py, &error))?;
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
    fn read(py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<Self> {
        let path = path_in("path", path)?;
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
        Ok(Self { analysis, source: absolute(&source), text })
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
    #[pyo3(signature = (text, source = None), text_signature = "(text, source=\"model.toml\")")]
    fn from_toml(text: &Bound<'_, PyAny>, source: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let py = text.py();
        let source = source.map_or(Ok("model.toml".to_owned()), |of| text_in("source", of))?;
        Self::of_toml(py, &text_in("text", text)?, &source)
    }

    /// Give an example, the one that ``slipstick init --example`` writes.
    ///
    /// Parameters
    /// ----------
    /// name
    ///     ``"block"``, ``"mock-up"``, ``"frame"``, ``"stop"``, ``"double-pendulum"``, ``"triple-pendulum"``,
    ///     ``"contents"``, ``"structure"`` or ``"tank-sloshing"``.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For another name.
    ///
    /// Examples
    /// --------
    /// >>> import slipstick as ss
    /// >>> ss.run(ss.Model.example("mock-up")).holds
    /// True
    #[staticmethod]
    fn example(py: Python<'_>, name: &Bound<'_, PyAny>) -> PyResult<Self> {
        let name = &*text_in("name", name)?;
        let Some(text) = examples::text(name) else {
            let names: Vec<String> = examples::names().map(|name| format!("{name:?}")).collect();
            let expected = format!("one of {}", names.join(", "));
            return Err(of_argument(py, "name", &expected, &format!("{name:?}")));
        };
        Self::of_toml(py, &text, "")
    }

    /// Take the structure from an eigenvalue analysis of OpenSees that stands in memory.
    ///
    /// Parameters
    /// ----------
    /// ops
    ///     The module ``openseespy.opensees`` with a model on a fixed base; z is upwards, in two dimensions y.
    /// values
    ///     All other keys, as for a new model: block, slider, motion.
    /// mass_unit
    ///     What one unit of mass of that model is, ``"1 t"``; OpenSees has no units. Times are in s.
    /// nodes
    ///     Nodes whose motion is wanted, by the names that they get: ``{"Roof": 40}``.
    /// damping_ratio
    ///     Ratio of critical damping of all modes.
    /// modes
    ///     Number of modes to compute; without it those of the last call of ``eigen``.
    /// direction
    ///     ``"x"`` or ``"y"``: the direction of OpenSees along which the ground moves.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For what makes no model, and for a unit or a direction that is none.
    #[staticmethod]
    #[pyo3(
        signature = (ops, values, *, mass_unit, nodes, damping_ratio, modes = None, direction = None),
        text_signature = "(ops, values, *, mass_unit, nodes, damping_ratio, modes=None, direction=\"x\")"
    )]
    #[allow(clippy::too_many_arguments)]
    fn from_opensees(
        ops: &Bound<'_, PyAny>,
        values: &Bound<'_, PyAny>,
        mass_unit: &Bound<'_, PyAny>,
        nodes: &Bound<'_, PyAny>,
        damping_ratio: &Bound<'_, PyAny>,
        modes: Option<&Bound<'_, PyAny>>,
        direction: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let py = ops.py();
        if !ops.hasattr("modalProperties")? {
            let expected = "the module openseespy.opensees with a model in it";
            return Err(of_argument(py, "ops", expected, &described(ops)));
        }
        let nodes = keys_in("nodes", "tags of nodes by names, {\"Roof\": 40}", nodes)?;
        for (name, node) in &nodes {
            text_in("nodes", &name)?;
            count_in("nodes", &node)?;
        }
        let damping_ratio = number_in("damping_ratio", damping_ratio)?;
        let modes = modes.map(|count| count_in("modes", count)).transpose()?;
        let direction = direction.map_or(Ok("x".to_owned()), |of| text_in("direction", of))?;
        let unit_kg = quantity("mass_unit", mass_unit, Dimension::Mass, false)?;
        if !["x", "y"].contains(&&*direction) {
            return Err(of_argument(py, "direction", "\"x\" or \"y\"", &format!("{direction:?}")));
        }
        let asked = (ops, unit_kg, nodes, damping_ratio, modes, direction);
        let structure = py.import("slipstick._opensees")?.call_method1("structure", asked)?;
        let text = format!(
            "{}\n{}",
            Self::new(py, Some(values), None)?.text,
            structure.extract::<String>()?
        );
        Self::of_toml(py, &text, "")
    }

    /// Take the structure by its modes from the matrices of an eigenvalue analysis on a fixed base.
    ///
    /// Parameters
    /// ----------
    /// phi
    ///     Shapes, a row a degree of freedom and a column a mode, as ``scipy.linalg.eigh(K, M)`` gives them, of any
    ///     normalisation.
    /// omega
    ///     Circular frequencies in rad/s, one a mode.
    /// damping
    ///     Ratios of critical damping, one a mode, or one of all.
    /// mass
    ///     Mass matrix in kg, or the masses on its diagonal.
    /// values
    ///     All other keys, as for a new model: block, slider, motion.
    /// points
    ///     Degrees of freedom whose motion is wanted, by the names that they get, counted from 0: ``{"Roof": 9}``;
    ///     all of them if left out.
    /// influence
    ///     What each degree of freedom does where the base moves by 1 along x; 1 of all if left out.
    /// tables
    ///     Other keys by keyword, as for a new model.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For shapes that are not orthogonal with respect to the masses, and for what makes no model.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> import slipstick as ss
    /// >>> model = ss.Model.from_modes(
    /// ...     np.array([[1.0]]), [2 * np.pi * 2.0], 0.02, [200.0],
    /// ...     {"block.mass": "325 kg", "slider.static_friction": 0.1, "slider.kinetic_friction": 0.08},
    /// ...     points={"Roof": 0})
    /// >>> round(model.value("structure.mode.1.period"), 12), model.value("structure.mass")
    /// (0.5, 200.0)
    #[staticmethod]
    #[pyo3(signature = (phi, omega, damping, mass, values = None, *, points = None, influence = None, **tables))]
    #[allow(clippy::too_many_arguments)]
    fn from_modes(
        phi: &Bound<'_, PyAny>,
        omega: &Bound<'_, PyAny>,
        damping: &Bound<'_, PyAny>,
        mass: &Bound<'_, PyAny>,
        values: Option<&Bound<'_, PyAny>>,
        points: Option<&Bound<'_, PyAny>>,
        influence: Option<&Bound<'_, PyAny>>,
        tables: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let py = phi.py();
        let asked = (phi, omega, damping, mass, points, influence);
        let structure = py.import("slipstick._modes")?.call_method1("structure", asked)?;
        let with_structure = match tables {
            Some(tables) => tables.copy()?,
            None => PyDict::new(py),
        };
        if with_structure.contains("structure")? {
            return Err(of_argument(py, "structure", "that of the modes alone", "another"));
        }
        with_structure.update(structure.cast::<PyDict>()?.as_mapping())?;
        Self::new(py, values, Some(&with_structure))
    }

    /// Give the same model with other values of some keys.
    ///
    /// Setting one of two keys that exclude each other removes the other; None removes a key, a storey, a table.
    /// A storey, surface or item of contents above the last is added.
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
    /// >>> pendulum = model.with_({"slider.radius": "2 m"})
    /// >>> pendulum.with_({"slider.radius": None}) == model
    /// True
    fn with_(&self, values: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mut given = Vec::new();
        flattened("", &keys_in("values", KEYS, values)?, &mut given)?;
        let one = |(path, text): &(String, Option<String>)| match text {
            Some(text) => Override::text_value(path, text).map(Override::growing),
            None => Override::removal(path),
        };
        let set: Result<Vec<Override>, InputError> = given.iter().map(one).collect();
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

    /// A short hash of the values of all keys but those of its motion: what summaries call ``model_hash``.
    #[getter]
    fn digest(&self) -> String {
        self.analysis.hash()
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
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a path that no model has, with the nearest.
    fn value(&self, py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
        let path = &*text_in("path", path)?;
        Override::removal(path).map_err(|error| of_input(py, &error))?;
        Ok(self.analysis.value(path))
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
    ///     Stiffness of that spring, ``"10 kN/mm"`` or in N/m: a number that physics does not have.
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
    /// >>> script = model.to_opensees(ss.Motion([0.0, 0.3, 0.0], dt=0.1, units="g"), "10 kN/mm")
    /// >>> "ElasticPP" in script
    /// True
    fn to_opensees(
        &self,
        py: Python<'_>,
        motion: &Bound<'_, PyAny>,
        k_init: &Bound<'_, PyAny>,
    ) -> PyResult<String> {
        let one = py.import("slipstick._records")?.getattr("one")?;
        let motion = one.call1(("motion", motion))?;
        let motion = motion.cast::<Motion>()?.get();
        let k_init = quantity("k_init", k_init, Dimension::Stiffness, true)?;
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
