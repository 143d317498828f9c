//! `Motion`.

use std::cmp::Reverse;
use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyString, PyTuple};
use slipstick::error::MotionError;
use slipstick::hash::motion_hash;
use slipstick::input::PairOf;
use slipstick::input::loaded::Loaded;
use slipstick::motion::{GroundMotion, Quantity};
use slipstick::notice::{Notice, NoticeKind};
use slipstick::record::{Origin, Units};
use slipstick::units::Dimension;
use slipstick_files::{AlongYRequest, LoadedMotion, RecordRequest, VerticalRequest, load_record};
use slipstick_report::DisplayUnits;
use slipstick_report::records::Histories;

use crate::errors::{Escaped, of_argument, of_file, of_motion, warn_severe};
use crate::signal;
use crate::values::{
    accelerations, channel_of, count_in, described, number_in, path_in, quantity, record_units,
    samples, text_in, texts_in,
};

/// A ground motion, linear between its samples.
///
/// Motions do not change; they compare by their samples and pickle.
///
/// Parameters
/// ----------
/// acceleration
///     Accelerations of the table, positive towards +x; real numbers in one dimension, or a quantity of pint.
/// y
///     Accelerations along y at the same times, for a table that moves in two horizontal directions.
/// dt
///     Time step, in s or with its unit.
/// times_s
///     In place of it the times in s, as many as there are values, not necessarily evenly spaced; a repeated
///     time is a jump.
/// units
///     Units of the values, such as ``"g"``, ``"m/s2"`` or what one count is, ``"4.67e-6 m/s2"``; not for
///     quantities, which have their own.
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
/// Warns
/// -----
/// SlipstickWarning
///     For a peak that no earthquake has: the units are others. All that is noticed is in ``warnings``.
///
/// Examples
/// --------
/// >>> import slipstick as ss
/// >>> motion = ss.Motion([0.0, 0.2, -0.1, 0.0], dt=0.1, units="g")
/// >>> round(motion.duration_s, 3), len(motion)
/// (0.3, 4)
/// >>> round(motion.scaled(pga="0.3 g").pga_m_per_s2, 3)
/// 2.942
#[pyclass(module = "slipstick._core", frozen, from_py_object)]
#[derive(Clone, Debug)]
pub struct Motion(pub(crate) LoadedMotion);

impl Motion {
    pub(crate) fn of(motion: GroundMotion) -> Self {
        Self(of_arrays(motion, &Units::m_per_s2()))
    }

    fn derived(py: Python<'_>, loaded: Result<Loaded, MotionError>, of: &Self) -> PyResult<Self> {
        let loaded = loaded.map_err(|error| of_motion(py, &error))?;
        // What was said of the motion that it comes from is not said again.
        let known = |notice: &&Notice| of.0.warnings.iter().all(|known| known.kind != notice.kind);
        warn_severe(py, &loaded.warnings.iter().filter(known).cloned().collect::<Vec<_>>())?;
        Ok(Self(LoadedMotion { loaded, sources: of.0.sources.clone() }))
    }

    /// What is noticed of it, the gravest first.
    fn noticed(&self) -> Vec<&Notice> {
        let mut noticed: Vec<&Notice> = self.0.warnings.iter().collect();
        noticed.sort_by_key(|notice| Reverse(notice.severity()));
        noticed
    }

    /// What it is in a line.
    fn described(&self) -> String {
        let description = self.0.description.join("; ");
        match self.0.factor {
            1.0 => description,
            factor => format!("{factor:.4} × ({description})"),
        }
    }

    /// It with a warning in Python where the figures are void.
    pub(crate) fn said(self, py: Python<'_>) -> PyResult<Self> {
        warn_severe(py, &self.0.warnings)?;
        Ok(self)
    }
}

fn of_arrays(motion: GroundMotion, units: &Units) -> LoadedMotion {
    let samples = motion.len();
    let sampling = motion.dt_s().map_or("uneven".to_owned(), |dt_s| format!("{dt_s} s"));
    let both = motion.horizontal_y_m_per_s2().map_or("", |_| " along x and y");
    let description = format!("array{both}, {samples} values, {sampling}");
    LoadedMotion { loaded: Loaded::of_arrays(motion, units, description), sources: Vec::new() }
}

#[pymethods]
impl Motion {
    #[new]
    #[pyo3(signature = (acceleration, *, y = None, dt = None, times_s = None, units = None, vertical = None))]
    fn new(
        py: Python<'_>,
        acceleration: &Bound<'_, PyAny>,
        y: Option<&Bound<'_, PyAny>>,
        dt: Option<&Bound<'_, PyAny>>,
        times_s: Option<&Bound<'_, PyAny>>,
        units: Option<&Bound<'_, PyAny>>,
        vertical: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let units = units.map(|text| text_in("units", text)).transpose()?;
        let units = units.as_deref();
        let (horizontal, unit) = accelerations("acceleration", acceleration, units)?;
        let beside = |name: &str, values: Option<&Bound<'_, PyAny>>| -> PyResult<_> {
            let Some(values) = values else { return Ok(None) };
            let (values, _) = accelerations(name, values, units)?;
            if values.len() == horizontal.len() {
                return Ok(Some(values));
            }
            let expected = format!("{} values, as many as acceleration", horizontal.len());
            Err(of_argument(py, name, &expected, &values.len().to_string()))
        };
        let (along_y, vertical) = (beside("y", y)?, beside("vertical", vertical)?);
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
        let motion = match along_y {
            Some(y) => motion.and_then(|motion| motion.with_y(y)),
            None => motion,
        };
        Self(of_arrays(motion.map_err(|error| of_motion(py, &error))?, &unit)).said(py)
    }

    /// Read a record; ``slipstick.read_record`` has the same arguments.
    #[staticmethod]
    #[pyo3(signature = (path, *, y = None, channel = None, units = None, dt = None, vertical = None))]
    fn read(
        py: Python<'_>,
        path: &Bound<'_, PyAny>,
        y: Option<&Bound<'_, PyAny>>,
        channel: Option<&Bound<'_, PyAny>>,
        units: Option<&Bound<'_, PyAny>>,
        dt: Option<&Bound<'_, PyAny>>,
        vertical: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let path = path_in("path", path)?;
        let y = y.map(|path| path_in("y", path)).transpose()?;
        let vertical = vertical.map(|path| path_in("vertical", path)).transpose()?;
        let units = units.map(record_units).transpose()?;
        let dt_s = dt.map(|dt| quantity("dt", dt, Dimension::Time, true)).transpose()?;
        let channel = channel.map(channel_of).transpose()?;
        let vertical = vertical.map(|path| VerticalRequest { path, channel: None, factor: 1.0 });
        let along_y = y.map(|path| AlongYRequest {
            path,
            units,
            dt_s,
            channel: channel.clone(),
            pair: PairOf { scale_y: 1.0, rotate_rad: 0.0 },
        });
        let asked = RecordRequest { path, units, dt_s, channel, ..RecordRequest::default() };
        let request = RecordRequest { along_y, vertical, ..asked };
        let loaded = py.detach(|| load_record(&request));
        loaded.map(Self).map_err(|error| of_file(py, &error))?.said(py)
    }

    /// Take the motion of a trace of ObsPy, or of a stream of the components of one station.
    ///
    /// Station, channels and the time of the first sample stand in ``origin``; ``to_obspy`` gives them back.
    ///
    /// Parameters
    /// ----------
    /// stream
    ///     A ``Trace``, or a ``Stream`` of at most two horizontal components, along x and along y in their order, and a
    ///     vertical one, whose channel ends in Z.
    /// units
    ///     Units of its values; ``stats.units`` of its traces if left out.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For traces of several stations or times, gaps, and values without units.
    #[staticmethod]
    #[pyo3(signature = (stream, *, units = None))]
    fn from_obspy(stream: &Bound<'_, PyAny>, units: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let units = units.map(|text| text_in("units", text)).transpose()?;
        let made =
            stream.py().import("slipstick._obspy")?.call_method1("motion", (stream, units))?;
        Ok(made.cast::<Self>()?.get().clone())
    }

    /// It with what is known of where and when it was recorded: station, component and start in ns since 1970 of
    /// the component along x, and component of that along y.
    fn _recorded(
        &self,
        station: Option<String>,
        component: Option<String>,
        start_ns: Option<i64>,
        component_y: Option<String>,
    ) -> Self {
        let mut motion = self.0.clone();
        let of = |component| Origin {
            station: station.clone(),
            component,
            start_ns,
            ..Origin::default()
        };
        motion.loaded.origin = match component_y {
            Some(y) => of(component).with_along_y(of(Some(y))),
            None => of(component),
        };
        Self(motion)
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
    #[pyo3(signature = (signal, *, units = None), text_signature = "(signal, *, units=\"m/s2\")")]
    fn from_eqsig(signal: &Bound<'_, PyAny>, units: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let py = signal.py();
        let part = |name: &str| {
            let expected = "a signal of eqsig, with its values and its dt";
            signal
                .getattr(name)
                .map_err(|_| of_argument(py, "signal", expected, &described(signal)))
        };
        let (dt, values) = (part("dt")?, part("values")?);
        let usual = PyString::new(py, "m/s2").into_any();
        let units = units.unwrap_or(&usual);
        Self::new(py, &values, None, Some(&dt), None, Some(units), None)
    }

    /// Scale the motion, all its components together.
    ///
    /// Parameters
    /// ----------
    /// factor
    ///     What it is multiplied with; may be negative.
    /// pga
    ///     In place of it the peak that the horizontal component, of two the larger, is to have: ``"0.3 g"``, or in m/s².
    /// spectrum
    ///     In place of it a spectrum that it is brought to, 5 % damped, in the mean of the logarithms: the shape of
    ///     ASCE/SEI 7, ``"sds = 1.2 g, sd1 = 0.8 g, tl = 8 s"``, a CSV with the columns ``period_s`` and ``sa_g``,
    ///     or columns ``period_s`` and ``sa_m_per_s2``. Of two components the largest over all directions counts.
    /// periods
    ///     First and last period of that, ``"0.6 s..3.8 s"`` or ``(0.6, 3.8)``.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a peak without its unit, for none or several, and for a motion of zeros that is to have a peak.
    #[pyo3(signature = (factor = None, *, pga = None, spectrum = None, periods = None))]
    fn scaled(
        &self,
        py: Python<'_>,
        factor: Option<&Bound<'_, PyAny>>,
        pga: Option<&Bound<'_, PyAny>>,
        spectrum: Option<&Bound<'_, PyAny>>,
        periods: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let motion = &self.0.motion;
        let periods = periods.map(signal::range_of_periods).transpose()?;
        if let Some(target) = spectrum {
            if factor.is_some() || pga.is_some() {
                return Err(of_argument(py, "spectrum", "a factor, pga or a spectrum", "two"));
            }
            let factor = signal::factor_to_spectrum(py, motion, target, periods.as_deref())?;
            return Self::derived(py, self.0.scaled(factor), self);
        }
        if let Some(periods) = periods {
            return Err(of_argument(py, "periods", "a spectrum beside them", &periods));
        }
        let (name, given, factor) = match (factor, pga) {
            (Some(given), None) => ("factor", given, number_in("factor", given)?),
            (None, Some(given)) => {
                let peak = quantity("pga", given, Dimension::Acceleration, true)?;
                let factor = motion.factor_to_peak(peak).map_err(|error| {
                    let expected = match error {
                        MotionError::ZeroPeak => "a motion that is not zero throughout",
                        _ => "a finite peak > 0",
                    };
                    of_argument(py, "pga", expected, &given.to_string())
                })?;
                ("pga", given, factor)
            }
            (None, None) => {
                return Err(of_argument(py, "factor", "a factor, or pga", "neither"));
            }
            (Some(_), Some(_)) => {
                return Err(of_argument(py, "factor", "a factor or pga", "both"));
            }
        };
        if !factor.is_finite() {
            return Err(of_argument(py, name, "a finite factor", &given.to_string()));
        }
        Self::derived(py, self.0.scaled(factor), self)
    }

    /// Turn a motion in two horizontal directions, x towards y.
    ///
    /// Parameters
    /// ----------
    /// angle, angle_deg
    ///     The angle with its unit, ``"30 deg"``, or a number of degrees by its name, ``angle_deg=30``.
    /// scale_y
    ///     Factor on the component along y before that.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a motion in one direction, an angle without its unit, both or neither, a factor that is not finite.
    ///
    /// Examples
    /// --------
    /// >>> import slipstick as ss
    /// >>> pair = ss.Motion([0.0, 1.0, 0.0], y=[0.0, 0.5, 0.0], dt=0.1, units="m/s2")
    /// >>> pair.rotated("90 deg").acceleration_y_m_per_s2.tolist()
    /// [0.0, 1.0, 0.0]
    /// >>> pair.rotated(angle_deg=90) == pair.rotated("90 deg")
    /// True
    #[pyo3(signature = (angle = None, *, angle_deg = None, scale_y = None))]
    fn rotated(
        &self,
        py: Python<'_>,
        angle: Option<&Bound<'_, PyAny>>,
        angle_deg: Option<&Bound<'_, PyAny>>,
        scale_y: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        if self.0.motion.horizontal_y_m_per_s2().is_none() {
            let expected = "a motion in two horizontal directions, which can be turned";
            return Err(of_argument(py, "rotated", expected, "one in one"));
        }
        let angle_rad = match (angle, angle_deg) {
            (Some(angle), None) => quantity("angle", angle, Dimension::Angle, false)?,
            (None, Some(degrees)) => {
                let degrees = number_in("angle_deg", degrees)?;
                if !degrees.is_finite() {
                    let found = degrees.to_string();
                    return Err(of_argument(py, "angle_deg", "a finite number", &found));
                }
                degrees.to_radians()
            }
            (given, _) => {
                let found = if given.is_some() { "both" } else { "neither" };
                return Err(of_argument(py, "angle", "one of angle and angle_deg", found));
            }
        };
        let scale_y = scale_y.map_or(Ok(1.0), |of| number_in("scale_y", of))?;
        Self::derived(py, self.0.turned(scale_y, angle_rad), self)
    }

    /// Measure the motion: peaks, Arias intensity, durations, CAV and the other measures of ``slipstick record
    /// info``, with the keys of its ``--json``.
    ///
    /// Parameters
    /// ----------
    /// names
    ///     Further measures by their names, ``"Sa(1.2 s)"``, ``"Sa_avg(0.5 s, 3 s)"``, of two components
    ///     ``"RotD50(1.2 s)"``, ``"RotD100(PGV)"``; of two components another one is the geometric mean of both.
    ///
    /// Returns
    /// -------
    /// dict
    ///     Values in SI by key, and by name; None where there is none. Of two components those of ``x`` and ``y``.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a name that is no measure, and a measure over all directions of a motion in one.
    ///
    /// Examples
    /// --------
    /// >>> import slipstick as ss
    /// >>> motion = ss.Motion([0.0, 1.0, 0.0], dt=0.1, units="m/s2")
    /// >>> found = motion.measures("Sa(1 s)")
    /// >>> found["pga_m_per_s2"], found["Sa(1 s)"] > 0.0
    /// (1.0, True)
    #[pyo3(signature = (*names))]
    fn measures<'py>(
        &self,
        py: Python<'py>,
        names: &Bound<'py, PyTuple>,
    ) -> PyResult<Bound<'py, PyDict>> {
        signal::measures(py, self, texts_in("names", names)?)
    }

    /// Compute the elastic response spectrum, exactly between samples too, as ``slipstick record spectrum`` does.
    ///
    /// Parameters
    /// ----------
    /// periods
    ///     Periods in s or with their unit; 200 from 0.01 s to 10 s if left out.
    /// damping
    ///     Damping ratios, ``0.05`` or ``"5 %"``; one or several.
    ///
    /// Returns
    /// -------
    /// Table
    ///     Columns ``damping_ratio``, ``period_s``, ``sd_m``, ``sv_m_per_s``, ``psv_m_per_s``, ``psa_m_per_s2`` and
    ///     ``sa_m_per_s2``, one row a period.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For periods and ratios that cannot be, and a motion in two directions: take one of its ``components``.
    ///
    /// Examples
    /// --------
    /// >>> import slipstick as ss
    /// >>> motion = ss.Motion([0.0, 1.0, 0.0], dt=0.1, units="m/s2")
    /// >>> motion.spectrum([0.0, "1 s"])["sa_m_per_s2"].tolist()[0]
    /// 1.0
    #[pyo3(signature = (periods = None, *, damping = None))]
    fn spectrum<'py>(
        &self,
        py: Python<'py>,
        periods: Option<&Bound<'py, PyAny>>,
        damping: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let usual = PyFloat::new(py, 0.05).into_any();
        signal::response_spectrum(py, self, periods, damping.unwrap_or(&usual))
    }

    /// Compute the Fourier amplitudes, as ``slipstick record spectrum --fourier`` does.
    ///
    /// Parameters
    /// ----------
    /// step
    ///     Largest step between frequencies, in Hz or with its unit; 0.05 Hz if left out.
    ///
    /// Returns
    /// -------
    /// Table
    ///     Columns ``frequency_hz`` and ``fourier_amplitude_m_per_s``.
    #[pyo3(signature = (step = None))]
    fn fourier<'py>(
        &self,
        py: Python<'py>,
        step: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        signal::fourier(py, self, step)
    }

    /// Process all components by named steps, as ``slipstick record process`` does.
    ///
    /// Parameters
    /// ----------
    /// steps
    ///     In their order: ``"remove linear"``, ``"band-pass 0.1 Hz 25 Hz order 4"``, ``"taper 5 %"``,
    ///     ``"resample 0.005 s"``, ``"trim 2 s 30 s"``, ``"scale 1.5"``, ``"to velocity"``. They end in acceleration.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a step that is none, or that this motion does not take: a filter of uneven samples.
    ///
    /// Examples
    /// --------
    /// >>> import slipstick as ss
    /// >>> motion = ss.Motion([1.0, 2.0, 6.0], dt=0.1, units="m/s2")
    /// >>> motion.processed("remove mean", "scale 2").acceleration_m_per_s2.tolist()
    /// [-4.0, -2.0, 6.0]
    #[pyo3(signature = (*steps))]
    fn processed(&self, py: Python<'_>, steps: &Bound<'_, PyTuple>) -> PyResult<Self> {
        signal::processed(py, self, "steps", &texts_in("steps", steps)?)
    }

    /// Filter all components by a Butterworth filter that runs forwards and backwards.
    ///
    /// Parameters
    /// ----------
    /// high_pass, low_pass
    ///     Corner frequencies in Hz or with their unit; both for a band.
    /// order
    ///     Order of the filter that is run twice, from 1 to 10.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For neither, for corners that cannot be, and for uneven samples.
    #[pyo3(
        signature = (*, high_pass = None, low_pass = None, order = None),
        text_signature = "($self, *, high_pass=None, low_pass=None, order=4)"
    )]
    fn filter(
        &self,
        py: Python<'_>,
        high_pass: Option<&Bound<'_, PyAny>>,
        low_pass: Option<&Bound<'_, PyAny>>,
        order: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let order = order.map_or(Ok(4), |order| count_in("order", order))?;
        let corner = |name: &str, given: Option<&Bound<'_, PyAny>>| {
            given.map(|given| quantity(name, given, Dimension::Frequency, true)).transpose()
        };
        let step = match (corner("high_pass", high_pass)?, corner("low_pass", low_pass)?) {
            (Some(from), Some(to)) => ("filter", format!("band-pass {from:?} Hz {to:?} Hz")),
            (Some(from), None) => ("high_pass", format!("high-pass {from:?} Hz")),
            (None, Some(to)) => ("low_pass", format!("low-pass {to:?} Hz")),
            (None, None) => {
                return Err(of_argument(py, "high_pass", "a corner, or low_pass", "neither"));
            }
        };
        signal::processed(py, self, step.0, &[format!("{} order {order}", step.1)])
    }

    /// Subtract the polynomial that fits the accelerations best, of all components.
    ///
    /// Parameters
    /// ----------
    /// degree
    ///     0 for the mean, 1 for a straight line, at most 10.
    #[pyo3(signature = (degree = None), text_signature = "($self, degree=1)")]
    fn baseline(&self, py: Python<'_>, degree: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let degree = degree.map_or(Ok(1), |degree| count_in("degree", degree))?;
        signal::processed(py, self, "degree", &[format!("remove polynomial {degree}")])
    }

    /// Sample all components anew along the straight lines, without a filter.
    ///
    /// Parameters
    /// ----------
    /// dt
    ///     The new step, in s or with its unit.
    fn resample(&self, py: Python<'_>, dt: &Bound<'_, PyAny>) -> PyResult<Self> {
        let dt_s = quantity("dt", dt, Dimension::Time, true)?;
        signal::processed(py, self, "dt", &[format!("resample {dt_s:?} s")])
    }

    /// Write the motion as a file of the format that its name ends in: ``.csv``, ``.AT2``, ``.smc`` or ``.parquet``.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     The file, which is replaced.
    ///
    /// Returns
    /// -------
    /// Path
    ///     The same path.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a name of another format, and a motion of several components: write its ``components``.
    /// RecordError
    ///     For what the format cannot hold: uneven samples in AT2 and SMC.
    /// OSError
    ///     For a file that cannot be written.
    fn write(&self, py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<PathBuf> {
        let path = path_in("path", path)?;
        signal::write(py, self, &path)?;
        Ok(path)
    }

    /// Draw acceleration, velocity and displacement over time in Matplotlib.
    ///
    /// Parameters
    /// ----------
    /// ax
    ///     Where the acceleration alone is drawn; all three on a new figure if left out.
    /// kwargs
    ///     What lines take: ``color``, ``lw``.
    ///
    /// Returns
    /// -------
    /// Axes or array of Axes
    #[pyo3(signature = (*, ax = None, **kwargs))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        ax: Option<&Bound<'py, PyAny>>,
        kwargs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let draw = slf.py().import("slipstick._plot")?.getattr("draw_motion")?;
        draw.call((slf, ax), kwargs)
    }

    /// Give the motion as a stream of ObsPy, a trace for each component, in m/s².
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For uneven samples.
    /// ImportError
    ///     Without ObsPy.
    fn to_obspy<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("slipstick._obspy")?.call_method1("stream", (slf,))
    }

    /// The components by name, ``x``, ``y``, ``vertical``, each a motion in one direction.
    #[getter]
    fn components<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        signal::components(py, self)
    }

    /// Velocity of the table in m/s, from rest at the first sample.
    #[getter]
    fn velocity_m_per_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        signal::integral(self, Quantity::Velocity).into_pyarray(py)
    }

    /// Displacement of the table in m, from rest at the first sample.
    #[getter]
    fn displacement_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        signal::integral(self, Quantity::Displacement).into_pyarray(py)
    }

    /// ``motion[10]`` is a sample along x in m/s², ``motion[10:20]`` the part of ten; ``motion["2 s":"30 s"]`` is the
    /// part between two times, its clock started anew; ``motion["3.2 s"]``, or ``motion.at(3.2)``, is the
    /// acceleration along x at a time. Whole numbers are samples, numbers with a point are s.
    fn __getitem__<'py>(
        &self,
        py: Python<'py>,
        key: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        signal::item(py, self, key)
    }

    /// Give the acceleration along x at a time in m/s², along the straight lines between samples.
    ///
    /// Parameters
    /// ----------
    /// time
    ///     The time in s or with its unit, ``"10 s"``; at a jump what is after it.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a time before the first sample or after the last.
    ///
    /// Examples
    /// --------
    /// >>> import slipstick as ss
    /// >>> motion = ss.Motion([0.0, 1.0, 3.0, 0.0], dt=0.5, units="m/s2")
    /// >>> motion[2], motion.at("0.75 s"), motion.at(1)
    /// (3.0, 2.0, 3.0)
    fn at(&self, py: Python<'_>, time: &Bound<'_, PyAny>) -> PyResult<f64> {
        signal::at(py, &self.0.motion, time)
    }

    /// The samples in m/s² as an array, of a motion of one component: ``numpy.asarray(motion)``.
    #[pyo3(signature = (dtype = None, copy = None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if copy == Some(false) {
            let message = "expected copy=None or copy=True: the samples of a motion are copied";
            return Err(PyValueError::new_err(message));
        }
        let samples = signal::array(py, self)?.into_any();
        match dtype {
            None => Ok(samples),
            Some(dtype) => samples.call_method1("astype", (dtype,)),
        }
    }

    /// The samples in m/s² one by one, of a motion of one component.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        signal::array(py, self)?.call_method0("tolist")?.try_iter().map(Bound::into_any)
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

    /// Acceleration of the table along y in m/s², where it moves in two horizontal directions.
    #[getter]
    fn acceleration_y_m_per_s2<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.0.motion.horizontal_y_m_per_s2().map(|values| values.to_vec().into_pyarray(py))
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

    /// Largest acceleration in m/s²; in two directions of the resultant.
    #[getter]
    fn pga_m_per_s2(&self) -> f64 {
        self.0.figures.pga_m_per_s2
    }

    /// Factor on the values of the file or the array.
    #[getter]
    fn factor(&self) -> f64 {
        self.0.factor
    }

    /// What was understood of the record.
    #[getter]
    fn description(&self) -> String {
        self.0.description.join("; ")
    }

    /// What its reader should know, as (kind, message), the gravest first.
    #[getter]
    fn warnings(&self) -> Vec<(&'static str, String)> {
        let notices = self.noticed().into_iter();
        notices.map(|notice| (notice.kind.name(), notice.message.clone())).collect()
    }

    /// What its file says of where it was recorded: ``event``, ``station``, ``component``, ``azimuth_deg``; of a
    /// stream of ObsPy also ``start``, the time of the first sample.
    #[getter]
    fn origin<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Origin { event, station, component, azimuth_deg, start_ns, along_y } = &self.0.origin;
        let said = PyDict::new(py);
        for (key, text) in [("event", event), ("station", station), ("component", component)] {
            said.set_item(key, text)?;
        }
        said.set_item("azimuth_deg", azimuth_deg)?;
        if let Some(start_ns) = start_ns {
            said.set_item(
                "start",
                py.import("numpy")?.call_method1("datetime64", (start_ns, "ns"))?,
            )?;
        }
        if let Some(y) = along_y {
            said.set_item("component_y", &y.component)?;
            said.set_item("azimuth_y_deg", y.azimuth_deg)?;
        }
        Ok(said)
    }

    /// A short hash of its samples: what summaries call ``motion_hash``.
    #[getter]
    fn digest(&self) -> String {
        motion_hash(&self.0.motion)
    }

    fn __len__(&self) -> usize {
        self.0.motion.len()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.0.motion == other.0.motion
    }

    fn __repr__(&self) -> String {
        let of = |notice: &&Notice| format!("{}: {}; ", notice.label(), notice.kind.words());
        let noticed: String = self.noticed().iter().map(of).collect();
        format!("<slipstick.Motion {noticed}{}>", self.described())
    }

    fn _repr_html_(&self) -> String {
        let of = |notice: &&Notice| {
            format!("<p><b>{}:</b> {}</p>", notice.label(), Escaped(&notice.message))
        };
        let noticed: String = self.noticed().iter().map(of).collect();
        let picture = Histories { motion: &self.0.motion, display: DisplayUnits::Si }.drawn();
        format!("{noticed}<p>{}</p>{}", Escaped(&self.described()), picture.svg.as_str())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Pickled<'py>)> {
        let (py, motion) = (slf.py(), &slf.get().0);
        let array = |values: &[f64]| values.to_vec().into_pyarray(py);
        let make = slf.get_type().getattr("_from_parts")?;
        let samples = &motion.motion;
        let parts = (
            array(samples.times_s()),
            array(samples.horizontal_m_per_s2()),
            samples.horizontal_y_m_per_s2().map(array),
            samples.vertical_m_per_s2().map(array),
            motion.description.clone(),
            motion
                .warnings
                .iter()
                .map(|w| (w.kind.name().to_owned(), w.time_s, w.message.clone()))
                .collect(),
            {
                let of = |origin: &Origin| {
                    let Origin { event, station, component, azimuth_deg, start_ns, .. } =
                        origin.clone();
                    (event, station, component, azimuth_deg, start_ns)
                };
                let along_y = motion.origin.along_y.as_deref();
                (motion.factor, of(&motion.origin), along_y.map(of))
            },
        );
        Ok((make, parts))
    }

    #[staticmethod]
    #[expect(clippy::too_many_arguments, reason = "a motion pickles as these")]
    fn _from_parts(
        py: Python<'_>,
        times_s: &Bound<'_, PyAny>,
        horizontal: &Bound<'_, PyAny>,
        along_y: Option<&Bound<'_, PyAny>>,
        vertical: Option<&Bound<'_, PyAny>>,
        description: Vec<String>,
        warnings: Vec<(String, Option<f64>, String)>,
        origin: OriginParts,
    ) -> PyResult<Self> {
        let vertical = vertical.map(|values| samples("vertical", values)).transpose()?;
        let (times_s, horizontal) =
            (samples("times_s", times_s)?, samples("acceleration", horizontal)?);
        let along_y = along_y.map(|values| samples("y", values)).transpose()?;
        let motion = GroundMotion::new(times_s, horizontal, vertical);
        let motion = match along_y {
            Some(y) => motion.and_then(|motion| motion.with_y(y)),
            None => motion,
        };
        let motion = motion.map_err(|error| of_motion(py, &error))?;
        let motion = Loaded::made(motion, String::new());
        let warning = |(name, time_s, message): (String, Option<f64>, String)| {
            let kind = NoticeKind::from_name(&name)
                .ok_or_else(|| of_argument(py, "warnings", "a known kind of warning", &name))?;
            Ok(Notice { time_s, ..Notice::new(kind, message) })
        };
        let warnings = warnings.into_iter().map(warning).collect::<PyResult<_>>()?;
        let (factor, along_x, along_y) = origin;
        let of = |(event, station, component, azimuth_deg, start_ns): Said| Origin {
            event,
            station,
            component,
            azimuth_deg,
            start_ns,
            along_y: None,
        };
        let origin = match along_y.map(of) {
            Some(along_y) => of(along_x).with_along_y(along_y),
            None => of(along_x),
        };
        let loaded = Loaded { description, warnings, factor, origin, ..motion };
        Ok(Self(LoadedMotion { loaded, sources: Vec::new() }))
    }
}

/// What a motion is pickled as.
type Pickled<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Option<Bound<'py, PyArray1<f64>>>,
    Vec<String>,
    Vec<(String, Option<f64>, String)>,
    OriginParts,
);

/// Event, station, component, azimuth in degrees and start in ns since 1970.
type Said = (Option<String>, Option<String>, Option<String>, Option<f64>, Option<i64>);

/// Factor on the record, and what the files of its horizontal components say.
type OriginParts = (f64, Said, Option<Said>);
