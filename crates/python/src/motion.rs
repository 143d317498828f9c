//! `Motion`.

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt, PyString};
use slipstick::error::MotionError;
use slipstick::input::loaded::Loaded;
use slipstick::motion::GroundMotion;
use slipstick::notice::{Notice, NoticeKind};
use slipstick::record::{Origin, Units};
use slipstick::units::{Dimension, parse_quantity, parse_unit};
use slipstick_files::{LoadedMotion, RecordRequest, VerticalRequest, load_record};

use crate::errors::{of_argument, of_file, of_motion, of_unit};

/// A ground motion, linear between its samples.
///
/// Motions do not change; they compare by their samples and pickle.
///
/// Parameters
/// ----------
/// acceleration
///     Accelerations of the table, positive towards +x; real numbers in one dimension.
/// dt
///     Time step, in s or with its unit.
/// times_s
///     In place of it the times in s, as many as there are values, not necessarily evenly spaced; a repeated
///     time is a jump.
/// units
///     Units of the values, such as ``"g"`` or ``"m/s2"``.
/// vertical
///     Vertical accelerations at the same times, positive upwards.
///
/// Raises
/// ------
/// InputError
///     For an array of another type or shape, units that are none, neither or both of ``dt`` and ``times_s``.
/// RecordError
///     For values that are not finite, or times that do not increase.
///
/// Examples
/// --------
/// >>> import slipstick as ss
/// >>> motion = ss.Motion([0.0, 0.2, -0.1, 0.0], dt=0.5, units="g")
/// >>> motion.duration_s, len(motion)
/// (1.5, 4)
/// >>> round(motion.scaled(pga="0.3 g").pga_m_per_s2, 3)
/// 2.942
#[pyclass(module = "slipstick._core", frozen, from_py_object)]
#[derive(Clone, Debug)]
pub struct Motion(pub(crate) LoadedMotion);

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
    let is_number = value.is_instance_of::<PyFloat>() || value.is_instance_of::<PyInt>();
    if number_in_si && (is_number || value.hasattr("__float__")?) {
        return value.extract();
    }
    let expected =
        format!("{} with its unit, such as {:?}", dimension.with_article(), dimension.example());
    Err(of_argument(py, name, &expected, &value.repr()?.to_string()))
}

/// Samples as doubles: any real array of one dimension.
fn samples(name: &str, values: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let py = values.py();
    let numpy = py.import("numpy")?;
    let expected = "numbers in one dimension";
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

fn made(motion: GroundMotion) -> LoadedMotion {
    let samples = motion.len();
    let sampling = motion.dt_s().map_or("uneven".to_owned(), |dt_s| format!("{dt_s} s"));
    let loaded = Loaded::made(motion, format!("array, {samples} values, {sampling}"));
    LoadedMotion { loaded, sources: Vec::new() }
}

impl Motion {
    pub(crate) fn of(motion: GroundMotion) -> Self {
        Self(made(motion))
    }

    fn derived(&self, py: Python<'_>, motion: Result<GroundMotion, MotionError>) -> PyResult<Self> {
        let motion = motion.map_err(|error| of_motion(py, &error))?;
        let (figures, old) = (motion.figures(), self.0.clone());
        let factor = old.factor * figures.pga_m_per_s2 / old.figures.pga_m_per_s2;
        let loaded = Loaded { motion, factor, figures, ..old.loaded };
        Ok(Self(LoadedMotion { loaded, sources: old.sources }))
    }
}

#[pymethods]
impl Motion {
    #[new]
    #[pyo3(signature = (acceleration, *, dt = None, times_s = None, units, vertical = None))]
    fn new(
        py: Python<'_>,
        acceleration: &Bound<'_, PyAny>,
        dt: Option<&Bound<'_, PyAny>>,
        times_s: Option<&Bound<'_, PyAny>>,
        units: &str,
        vertical: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let unit = parse_unit(units, Dimension::Acceleration)
            .map_err(|error| of_unit(py, "units", &error))?;
        let in_si = |name: &str, values: &Bound<'_, PyAny>| -> PyResult<Vec<f64>> {
            Ok(samples(name, values)?.into_iter().map(|value| unit.to_si(value)).collect())
        };
        let horizontal = in_si("acceleration", acceleration)?;
        let vertical = vertical.map(|values| in_si("vertical", values)).transpose()?;
        if let Some(up) = &vertical
            && up.len() != horizontal.len()
        {
            let expected = format!("{} values, as many as acceleration", horizontal.len());
            return Err(of_argument(py, "vertical", &expected, &up.len().to_string()));
        }
        let motion = match (dt, times_s) {
            (Some(dt), None) => {
                let dt_s = quantity("dt", dt, Dimension::Time, true)?;
                GroundMotion::evenly_spaced(dt_s, horizontal, vertical)
            }
            (None, Some(times)) => {
                let times_s = samples("times_s", times)?;
                if times_s.len() != horizontal.len() {
                    let expected = format!("{} times, one a value", horizontal.len());
                    return Err(of_argument(py, "times_s", &expected, &times_s.len().to_string()));
                }
                GroundMotion::new(times_s, horizontal, vertical)
            }
            (None, None) => {
                return Err(of_argument(py, "dt", "a time step, or times_s", "neither"));
            }
            (Some(_), Some(_)) => return Err(of_argument(py, "dt", "dt or times_s", "both")),
        };
        Ok(Self(made(motion.map_err(|error| of_motion(py, &error))?)))
    }

    /// Read a record; ``slipstick.read_record`` has the same arguments.
    #[staticmethod]
    #[pyo3(signature = (path, *, channel = None, units = None, dt = None, vertical = None))]
    fn read(
        py: Python<'_>,
        path: PathBuf,
        channel: Option<String>,
        units: Option<&str>,
        dt: Option<&Bound<'_, PyAny>>,
        vertical: Option<PathBuf>,
    ) -> PyResult<Self> {
        let units = match units {
            None => None,
            Some(text) => Some(Units::parse(text).ok_or_else(|| {
                of_argument(py, "units", "units of a record, such as \"g\" or \"cm/s2\"", text)
            })?),
        };
        let dt_s = dt.map(|dt| quantity("dt", dt, Dimension::Time, true)).transpose()?;
        let vertical = vertical.map(|path| VerticalRequest { path, channel: None, factor: 1.0 });
        let request =
            RecordRequest { path, units, dt_s, channel, vertical, ..RecordRequest::default() };
        let loaded = py.detach(|| load_record(&request));
        loaded.map(Self).map_err(|error| of_file(py, &error))
    }

    /// Take the motion of a trace of ObsPy.
    ///
    /// Parameters
    /// ----------
    /// trace
    ///     An object with ``data`` and ``stats.delta``.
    /// units
    ///     Units of its values.
    #[staticmethod]
    #[pyo3(signature = (trace, *, units))]
    fn from_obspy(trace: &Bound<'_, PyAny>, units: &str) -> PyResult<Self> {
        let dt = trace.getattr("stats")?.getattr("delta")?;
        Self::new(trace.py(), &trace.getattr("data")?, Some(&dt), None, units, None)
    }

    /// Take the motion of an acceleration signal of eqsig.
    ///
    /// Parameters
    /// ----------
    /// signal
    ///     An object with ``values`` and ``dt``.
    /// units
    ///     Units of its values.
    #[staticmethod]
    #[pyo3(signature = (signal, *, units = "m/s2"))]
    fn from_eqsig(signal: &Bound<'_, PyAny>, units: &str) -> PyResult<Self> {
        let dt = signal.getattr("dt")?;
        Self::new(signal.py(), &signal.getattr("values")?, Some(&dt), None, units, None)
    }

    /// Scale the motion, its vertical component with it.
    ///
    /// Parameters
    /// ----------
    /// factor
    ///     What it is multiplied with; may be negative.
    /// pga
    ///     In place of it the peak that the horizontal component is to have, with its unit: ``"0.3 g"``.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a peak without its unit, and for neither or both.
    /// RecordError
    ///     For a motion of zeros that is to have a peak.
    #[pyo3(signature = (factor = None, *, pga = None))]
    fn scaled(
        &self,
        py: Python<'_>,
        factor: Option<f64>,
        pga: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let motion = &self.0.motion;
        match (factor, pga) {
            (Some(factor), None) => self.derived(py, motion.scaled(factor)),
            (None, Some(pga)) => {
                let peak = quantity("pga", pga, Dimension::Acceleration, false)?;
                self.derived(py, motion.scaled_to_peak(peak))
            }
            (None, None) => Err(of_argument(py, "factor", "a factor, or pga", "neither")),
            (Some(_), Some(_)) => Err(of_argument(py, "factor", "a factor or pga", "both")),
        }
    }

    /// Times of the samples in s.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.motion.times_s().to_vec().into_pyarray(py)
    }

    /// Acceleration of the table in m/s², positive towards +x.
    #[getter]
    fn acceleration_m_per_s2<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.motion.horizontal_m_per_s2().to_vec().into_pyarray(py)
    }

    /// Vertical acceleration in m/s², positive upwards, where there is one.
    #[getter]
    fn vertical_m_per_s2<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.0.motion.vertical_m_per_s2().map(|values| values.to_vec().into_pyarray(py))
    }

    /// The step in s; none where the sampling is uneven.
    #[getter]
    fn dt_s(&self) -> Option<f64> {
        self.0.motion.dt_s()
    }

    /// Time of the last sample in s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.0.motion.duration_s()
    }

    /// Largest acceleration in m/s².
    #[getter]
    fn pga_m_per_s2(&self) -> f64 {
        self.0.figures.pga_m_per_s2
    }

    /// What was understood of the record.
    #[getter]
    fn description(&self) -> String {
        self.0.description.join("; ")
    }

    /// What its reader should know, as (kind, message).
    #[getter]
    fn warnings(&self) -> Vec<(&'static str, String)> {
        let notices = self.0.warnings.iter();
        notices.map(|notice| (notice.kind.name(), notice.message.clone())).collect()
    }

    /// What its file says of where it was recorded: ``event``, ``station``, ``component``, ``azimuth_deg``.
    #[getter]
    fn origin<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Origin { event, station, component, azimuth_deg } = &self.0.origin;
        let said = PyDict::new(py);
        for (key, text) in [("event", event), ("station", station), ("component", component)] {
            said.set_item(key, text)?;
        }
        said.set_item("azimuth_deg", azimuth_deg)?;
        Ok(said)
    }

    fn __len__(&self) -> usize {
        self.0.motion.len()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.0.motion == other.0.motion
    }

    fn __repr__(&self) -> String {
        format!("<slipstick.Motion {}>", self.0.description.join("; "))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Pickled<'py>)> {
        let (py, motion) = (slf.py(), &slf.get().0);
        let array = |values: &[f64]| values.to_vec().into_pyarray(py);
        let make = slf.get_type().getattr("_from_parts")?;
        let samples = &motion.motion;
        let parts = (
            array(samples.times_s()),
            array(samples.horizontal_m_per_s2()),
            samples.vertical_m_per_s2().map(array),
            motion.description.clone(),
            motion
                .warnings
                .iter()
                .map(|w| (w.kind.name().to_owned(), w.time_s, w.message.clone()))
                .collect(),
            {
                let Origin { event, station, component, azimuth_deg } = motion.origin.clone();
                (motion.factor, event, station, component, azimuth_deg)
            },
        );
        Ok((make, parts))
    }

    #[staticmethod]
    fn _from_parts(
        py: Python<'_>,
        times_s: &Bound<'_, PyAny>,
        horizontal: &Bound<'_, PyAny>,
        vertical: Option<&Bound<'_, PyAny>>,
        description: Vec<String>,
        warnings: Vec<(String, Option<f64>, String)>,
        origin: OriginParts,
    ) -> PyResult<Self> {
        let vertical = vertical.map(|values| samples("vertical", values)).transpose()?;
        let (times_s, horizontal) =
            (samples("times_s", times_s)?, samples("acceleration", horizontal)?);
        let motion = GroundMotion::new(times_s, horizontal, vertical);
        let motion = made(motion.map_err(|error| of_motion(py, &error))?);
        let warning = |(name, time_s, message): (String, Option<f64>, String)| {
            let kind = NoticeKind::from_name(&name)
                .ok_or_else(|| of_argument(py, "warnings", "a known kind of warning", &name))?;
            Ok(Notice { kind, time_s, message })
        };
        let warnings = warnings.into_iter().map(warning).collect::<PyResult<_>>()?;
        let (factor, event, station, component, azimuth_deg) = origin;
        let origin = Origin { event, station, component, azimuth_deg };
        let loaded = Loaded { description, warnings, factor, origin, ..motion.loaded };
        Ok(Self(LoadedMotion { loaded, ..motion }))
    }
}

/// What a motion is pickled as.
type Pickled<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Vec<String>,
    Vec<(String, Option<f64>, String)>,
    OriginParts,
);

/// Factor on the record, event, station, component and azimuth in degrees.
type OriginParts = (f64, Option<String>, Option<String>, Option<String>, Option<f64>);
