//! A motion as a signal: what `slipstick record` does with one, by the same functions.

use std::path::{Path, PathBuf};

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PySlice, PySliceMethods, PyString};
use slipstick::error::{ChoiceError, MeasureError, MotionError};
use slipstick::input::loaded::Component;
use slipstick::motion::intensity::{IntensityMeasures, LevelMeasure};
use slipstick::motion::processing::Step;
use slipstick::motion::target::{
    Matched, TargetSpectrum, matching_periods, maximum_direction_of_pair,
};
use slipstick::motion::{
    FourierSpectrum, GroundMotion, Quantity, Spectrum, USUAL_PERIODS, logarithmic_periods, spectrum,
};
use slipstick::progress::Cancel;
use slipstick::requests::{code_spectrum, periods};
use slipstick::units::Dimension;
use slipstick_files::{
    LoadedMotion, RecordOptions, RecordRequest, TARGET, Wanted, WrittenFormat, channels,
    load_record, open_record, read_target, write_whole,
};
use slipstick_report::records::{fourier_table, spectrum_table};

use crate::errors::{of_argument, of_choice, of_file, of_motion};
use crate::motion::Motion;
use crate::table::Table;
use crate::values::{plain, quantity, record_units, samples};
use crate::work::on_samples;

/// A table as the package has it.
fn tabled(py: Python<'_>, table: slipstick::table::Table) -> PyResult<Bound<'_, PyAny>> {
    let class = py.import("slipstick._table")?.getattr("Table")?;
    class.call_method1("_of", (Table(table),))
}

/// One number or several, each in SI or with its unit.
fn several(name: &str, value: &Bound<'_, PyAny>, dimension: Dimension) -> PyResult<Vec<f64>> {
    let one = |value: &Bound<'_, PyAny>| quantity(name, value, dimension, true);
    if value.is_instance_of::<PyString>() || plain(name, value)?.is_some() {
        return Ok(vec![one(value)?]);
    }
    // What is no list has no items, and is told as one value that is none.
    let Ok(values) = value.try_iter() else { return Ok(vec![one(value)?]) };
    values.map(|value| one(&value?)).collect()
}

/// The one component of a motion, which a spectrum is of.
fn alone<'a>(py: Python<'_>, what: &str, motion: &'a GroundMotion) -> PyResult<&'a GroundMotion> {
    match motion.horizontal_y_m_per_s2() {
        None => Ok(motion),
        Some(_) => {
            let expected = "a motion in one direction: one of its components";
            Err(of_argument(py, what, expected, "one in two"))
        }
    }
}

/// The measures of a motion by the keys of `slipstick record info`, and further ones by their names.
pub(crate) fn measures<'py>(
    py: Python<'py>,
    motion: &Motion,
    names: Vec<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let loaded = &motion.0.loaded;
    let all = PyDict::new(py);
    let finite = |value: f64| value.is_finite().then_some(value);
    let standard = |motion: &GroundMotion, to: &Bound<'py, PyDict>| -> PyResult<()> {
        let of = motion.clone();
        let found = on_samples(py, motion.len(), move |_| IntensityMeasures::of(&of).columns())?;
        for (_, key, value) in found {
            to.set_item(key, finite(value))?;
        }
        to.set_item("end_velocity_m_per_s", finite(motion.figures().end_velocity_m_per_s))
    };
    if loaded.motion.horizontal_y_m_per_s2().is_some() {
        for (name, component) in [("x", Component::X), ("y", Component::Y)] {
            let Some(component) = loaded.component(component) else { continue };
            let of = PyDict::new(py);
            standard(&component.motion, &of)?;
            all.set_item(name, of)?;
        }
    } else {
        standard(&loaded.motion, &all)?;
    }
    for name in names {
        let measure = LevelMeasure::parse(&name).map_err(|error| of_measure(py, "names", error))?;
        let of = loaded.motion.clone();
        let value = on_samples(py, of.len(), move |_| measure.of(&of, None))?;
        let value = value.map_err(|error| of_motion(py, &error))?;
        if value.is_nan() && measure.rotated.is_some() {
            let expected = "a motion in two horizontal directions for what is over all directions";
            return Err(of_argument(py, "names", expected, &format!("{name:?} of one in one")));
        }
        all.set_item(name, finite(value))?;
    }
    Ok(all)
}

fn of_measure(py: Python<'_>, argument: &str, error: MeasureError) -> PyErr {
    let MeasureError { expected, found, nearest } = error;
    of_choice(py, &ChoiceError { what: argument.to_owned(), expected, found, nearest })
}

/// The elastic response spectrum as a table.
pub(crate) fn response_spectrum<'py>(
    py: Python<'py>,
    motion: &Motion,
    periods: Option<&Bound<'py, PyAny>>,
    damping: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let motion = alone(py, "spectrum", &motion.0.loaded.motion)?;
    let periods_s = match periods {
        Some(periods) => several("periods", periods, Dimension::Time)?,
        None => {
            let (from_s, to_s, count) = USUAL_PERIODS;
            logarithmic_periods(from_s, to_s, count)
        }
    };
    let ratio = |value: &Bound<'_, PyAny>| {
        let found =
            || of_argument(py, "damping", "ratios such as 0.05 or \"5 %\"", &value.to_string());
        let Some(plain) = plain("damping", value)? else { return Err(found()) };
        if let Ok(number) = plain.extract::<f64>() {
            return Ok(number);
        }
        let text: String = plain.extract()?;
        let (number, part) =
            text.trim().strip_suffix('%').map_or((text.trim(), 1.0), |n| (n, 100.0));
        number.trim_end().parse::<f64>().map(|number| number / part).map_err(|_| found())
    };
    let single = damping.is_instance_of::<PyString>() || plain("damping", damping)?.is_some();
    let listed = if single { None } else { damping.try_iter().ok() };
    let damping: Vec<f64> = match listed {
        None => vec![ratio(damping)?],
        Some(ratios) => ratios.map(|value| ratio(&value?)).collect::<PyResult<_>>()?,
    };
    let motion = motion.clone();
    let found = on_samples(py, motion.len(), move |go_on| {
        spectrum_by_parts(&motion, periods_s, damping, go_on)
    })?;
    let found = found.map_err(|error| match error {
        MotionError::OutOfRange { quantity, expected, found } => {
            let argument = if quantity.starts_with("period") { "periods" } else { "damping" };
            of_argument(py, argument, expected, &found.to_string())
        }
        other => of_motion(py, &other),
    })?;
    tabled(py, spectrum_table(&found))
}

/// Oscillators that are solved before it is asked whether to go on.
const AT_ONCE: usize = 8;

/// The elastic response spectrum, some periods after the others; where it is not to go on, what was found.
fn spectrum_by_parts(
    motion: &GroundMotion,
    periods_s: Vec<f64>,
    damping_ratios: Vec<f64>,
    go_on: Cancel<'_>,
) -> Result<Spectrum, MotionError> {
    let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
    // What is wrong with any of them is said of all.
    let mut ordinates = spectrum(times_s, a, &[], &damping_ratios)?.ordinates;
    for ratio in &damping_ratios {
        for periods_s in periods_s.chunks(AT_ONCE) {
            ordinates.extend(spectrum(times_s, a, periods_s, &[*ratio])?.ordinates);
            if go_on().is_break() {
                break;
            }
        }
    }
    Ok(Spectrum { periods_s, damping_ratios, ordinates })
}

/// The Fourier amplitudes as a table.
pub(crate) fn fourier<'py>(
    py: Python<'py>,
    motion: &Motion,
    step: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let motion = alone(py, "fourier", &motion.0.loaded.motion)?;
    let step_hz = match step {
        Some(step) => quantity("step", step, Dimension::Frequency, true)?,
        None => FourierSpectrum::USUAL_STEP_HZ,
    };
    if !(step_hz > 0.0) {
        return Err(of_argument(py, "step", "a frequency > 0", &step_hz.to_string()));
    }
    let motion = motion.clone();
    let found = on_samples(py, motion.len(), move |_| FourierSpectrum::of(&motion, step_hz))?;
    tabled(py, fourier_table(&found))
}

/// Steps of processing as they are written, `argument` being what errors call them.
pub(crate) fn processed(
    py: Python<'_>,
    motion: &Motion,
    argument: &str,
    steps: &[String],
) -> PyResult<Motion> {
    let read = |text: &String| Step::parse(text).map_err(|error| of_measure(py, argument, error));
    let steps: Vec<Step> = steps.iter().map(read).collect::<PyResult<_>>()?;
    let (of, asked) = (motion.0.loaded.clone(), steps.clone());
    let made = on_samples(py, of.motion.len(), move |_| of.processed(&asked))?;
    let made = made.map_err(|(index, error)| {
        let step = steps.get(index).map(Step::to_string).unwrap_or_default();
        match error {
            MotionError::OutOfRange { quantity, expected, found } => {
                let expected = format!("a {quantity} that is {expected} (step \"{step}\")");
                of_argument(py, argument, &expected, &found.to_string())
            }
            error => of_argument(
                py,
                argument,
                "steps that this motion takes",
                &format!("\"{step}\": {error}"),
            ),
        }
    })?;
    let expected = "steps that end in acceleration";
    let loaded = made.ok_or_else(|| of_argument(py, argument, expected, "another quantity"))?;
    Ok(Motion(LoadedMotion { loaded, sources: motion.0.sources.clone() }))
}

/// The first and the last of a range of periods as its text, `0.6 s..3.8 s`.
pub(crate) fn range_of_periods(given: &Bound<'_, PyAny>) -> PyResult<String> {
    if given.is_instance_of::<PyString>() {
        return given.extract();
    }
    let ends = match plain("periods", given)? {
        None if given.hasattr("__iter__")? => several("periods", given, Dimension::Time)?,
        _ => Vec::new(),
    };
    match ends[..] {
        [from_s, to_s] => Ok(format!("{from_s:?} s..{to_s:?} s")),
        _ => {
            let expected = "the first and the last period, \"0.6 s..3.8 s\" or (0.6, 3.8)";
            Err(of_argument(given.py(), "periods", expected, &given.repr()?.to_string()))
        }
    }
}

/// The motion brought to a spectrum: the factor in the mean of the logarithms over the periods.
pub(crate) fn factor_to_spectrum(
    py: Python<'_>,
    motion: &GroundMotion,
    target: &Bound<'_, PyAny>,
    range: Option<&str>,
) -> PyResult<f64> {
    let Some(range) = range else {
        return Err(of_argument(
            py,
            "periods",
            "the range beside a spectrum, \"0.6 s..3.8 s\"",
            "none",
        ));
    };
    let range_s = periods(range).map_err(|error| of_choice(py, &error))?;
    let target = target_of(py, target)?;
    let periods_s = matching_periods(range_s);
    let motion = motion.clone();
    let found = on_samples(py, motion.len(), move |_| {
        let ordinates = match motion.horizontal_y_m_per_s2() {
            Some(_) => maximum_direction_of_pair(&motion, None, &periods_s)?,
            None => {
                let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
                let found = spectrum(times_s, a, &periods_s, &[0.05])?;
                found.of_damping(0).iter().map(|at| at.psa_m_per_s2).collect()
            }
        };
        let found = Matched::new(&target, periods_s, &[ordinates])?;
        Ok::<_, MotionError>(found.factors[0] / found.raised)
    })?;
    let expected = "a motion that can be brought to the spectrum over these periods";
    found.map_err(|error| of_argument(py, "spectrum", expected, &error.to_string()))
}

/// A spectrum: the shape of a code, a file, or columns of periods in s and accelerations in m/s².
fn target_of(py: Python<'_>, target: &Bound<'_, PyAny>) -> PyResult<TargetSpectrum> {
    if let Ok(text) = target.extract::<String>()
        && text.contains("sds")
    {
        return code_spectrum(&text)
            .map_err(|error| of_choice(py, &ChoiceError { what: "spectrum".to_owned(), ..error }));
    }
    if let Ok(path) = target.extract::<PathBuf>() {
        let read = read_target(&path).map_err(|found| of_argument(py, "spectrum", TARGET, &found));
        return read.map(|(spectrum, _)| spectrum);
    }
    let column = |name: &str| {
        let expected = "the columns period_s and sa_m_per_s2";
        let values = target.get_item(name);
        samples("spectrum", &values.map_err(|_| of_argument(py, "spectrum", expected, "others"))?)
    };
    let points = TargetSpectrum::points(column("period_s")?, column("sa_m_per_s2")?);
    points.map_err(|error| of_argument(py, "spectrum", "a spectrum", &error.to_string()))
}

/// Writes the motion in the format of a name.
pub(crate) fn write(py: Python<'_>, motion: &Motion, path: &Path) -> PyResult<()> {
    let Some(format) = WrittenFormat::of_name(path) else {
        let expected = "a name that ends in .csv, .AT2, .smc or .parquet";
        return Err(of_argument(py, "path", expected, &path.display().to_string()));
    };
    let loaded = &motion.0.loaded;
    alone(py, "write", &loaded.motion)?;
    if loaded.motion.vertical_m_per_s2().is_some() {
        let expected = "a motion without a vertical component: one of its components";
        return Err(of_argument(py, "write", expected, "one with"));
    }
    let written = py.detach(|| {
        let bytes = format.bytes(path, &loaded.as_channel(), "")?;
        write_whole(path, &bytes)
    });
    written.map_err(|error| of_file(py, &error))
}

/// The components of a motion by their names, each as a motion along x.
pub(crate) fn components<'py>(py: Python<'py>, motion: &Motion) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    let named = [("x", Component::X), ("y", Component::Y), ("vertical", Component::Vertical)];
    for (name, component) in named {
        if let Some(loaded) = motion.0.loaded.component(component) {
            let sources = motion.0.sources.clone();
            all.set_item(name, Motion(LoadedMotion { loaded, sources }))?;
        }
    }
    Ok(all)
}

/// A whole number that Python may index with, NumPy's too; a flag is none.
fn index_of(value: &Bound<'_, PyAny>) -> PyResult<Option<isize>> {
    if value.is_instance_of::<PyBool>() || !value.hasattr("__index__")? {
        return Ok(None);
    }
    // What overflows is out of range however long the motion is.
    Ok(value.call_method0("__index__").ok().map(|whole| whole.extract().unwrap_or(isize::MAX)))
}

/// The sample of a whole number, the part of a slice, or the acceleration at a time that is written with its unit or
/// as a number with a point.
pub(crate) fn item<'py>(
    py: Python<'py>,
    motion: &Motion,
    key: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let loaded = &motion.0.loaded;
    if let Ok(slice) = key.cast::<PySlice>() {
        return Ok(Bound::new(py, part(py, motion, slice)?)?.into_any());
    }
    let Some(index) = index_of(key)? else {
        return Ok(PyFloat::new(py, at(py, &loaded.motion, key)?).into_any());
    };
    let values = loaded.motion.horizontal_m_per_s2();
    let from_end = if index < 0 { index.saturating_add_unsigned(values.len()) } else { index };
    let value = usize::try_from(from_end).ok().and_then(|index| values.get(index));
    let value = value.ok_or_else(|| {
        let last = values.len().saturating_sub(1);
        let expected =
            format!("a sample from 0 to {last} (a time is \"10 s\", or motion.at(10.0))");
        PyIndexError::new_err(format!("sample: expected {expected}, found {index}"))
    })?;
    Ok(PyFloat::new(py, *value).into_any())
}

/// The part between two samples, the last of them left out, or between two times.
fn part(py: Python<'_>, motion: &Motion, slice: &Bound<'_, PySlice>) -> PyResult<Motion> {
    let samples = &motion.0.loaded.motion;
    let times_s = samples.times_s();
    let [start, stop, step] = ["start", "stop", "step"].map(|name| slice.getattr(name));
    let (start, stop) = (start?, stop?);
    if !step?.is_none() {
        return Err(of_argument(py, "step", "none (resample changes it)", "one"));
    }
    let given = [&start, &stop].into_iter().filter(|end| !end.is_none());
    let whole = given.map(|end| Ok(index_of(end)?.is_some())).collect::<PyResult<Vec<bool>>>()?;
    let (from_s, to_s) = if whole.contains(&true) {
        if whole.contains(&false) {
            let expected = "two samples, or two times such as \"2 s\"";
            return Err(of_argument(py, "slice", expected, "a sample and a time"));
        }
        let range = slice.indices(samples.len() as isize)?;
        let (first, end) = (range.start.max(0) as usize, range.stop.max(0) as usize);
        let ends =
            end.checked_sub(1).and_then(|last| Some((times_s.get(first)?, times_s.get(last)?)));
        match ends.filter(|(from_s, to_s)| from_s < to_s) {
            Some((from_s, to_s)) => (*from_s, *to_s),
            None => {
                let found = format!("{}", slice.repr()?);
                return Err(of_argument(py, "slice", "two samples or more", &found));
            }
        }
    } else {
        let end = |value: &Bound<'_, PyAny>, or: f64| match value.is_none() {
            true => Ok(or),
            false => quantity("time", value, Dimension::Time, true),
        };
        (end(&start, 0.0)?, end(&stop, samples.duration_s())?)
    };
    processed(py, motion, "time", &[format!("trim {from_s:?} s {to_s:?} s")])
}

/// The acceleration along x at a time, along the straight lines; at a jump the limit from the right.
pub(crate) fn at(py: Python<'_>, samples: &GroundMotion, time: &Bound<'_, PyAny>) -> PyResult<f64> {
    let at_s = quantity("time", time, Dimension::Time, true)?;
    if !(0.0 <= at_s && at_s <= samples.duration_s()) {
        let expected = format!("a time from 0 to {} s", samples.duration_s());
        return Err(of_argument(py, "time", &expected, &at_s.to_string()));
    }
    let (times_s, values) = (samples.times_s(), samples.horizontal_m_per_s2());
    let after = times_s.partition_point(|t| *t <= at_s);
    Ok(match (values.get(after.wrapping_sub(1)), values.get(after)) {
        (Some(last), None) => *last,
        (Some(before), Some(next)) => {
            let (t0, t1) = (times_s[after - 1], times_s[after]);
            before + (next - before) * ((at_s - t0) / (t1 - t0))
        }
        (None, _) => values.first().copied().unwrap_or(f64::NAN),
    })
}

/// The samples of a motion of one component, which alone are one array.
pub(crate) fn array<'py>(py: Python<'py>, motion: &Motion) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let samples = alone(py, "array", &motion.0.loaded.motion)?;
    if samples.vertical_m_per_s2().is_some() {
        let expected = "a motion without a vertical component: one of its components";
        return Err(of_argument(py, "array", expected, "one with"));
    }
    Ok(samples.horizontal_m_per_s2().to_vec().into_pyarray(py))
}

/// Velocity or displacement from rest, in SI.
pub(crate) fn integral(motion: &Motion, quantity: Quantity) -> Vec<f64> {
    let series = Step::To { quantity }.apply(&motion.0.loaded.motion.series());
    series.map_or_else(|_| Vec::new(), |series| series.values().to_vec())
}

/// All channels of acceleration of a file by their names.
#[pyfunction]
#[pyo3(signature = (path, *, units = None, dt = None))]
pub(crate) fn read_channels<'py>(
    py: Python<'py>,
    path: PathBuf,
    units: Option<&Bound<'py, PyAny>>,
    dt: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let units = units.map(record_units).transpose()?;
    let dt_s = dt.map(|dt| quantity("dt", dt, Dimension::Time, true)).transpose()?;
    let options = RecordOptions { units, dt_s, ..RecordOptions::default() };
    let names = py.detach(|| {
        let record = open_record(&path, &options)?;
        let all = channels(&path, &record, None, Wanted::Acceleration)?;
        Ok(all.into_iter().map(|channel| channel.name.clone()).collect::<Vec<String>>())
    });
    let all = PyDict::new(py);
    for name in names.map_err(|error| of_file(py, &error))? {
        let channel = Some(name.clone());
        let request =
            RecordRequest { path: path.clone(), units, dt_s, channel, ..RecordRequest::default() };
        let loaded = py.detach(|| load_record(&request)).map_err(|error| of_file(py, &error))?;
        all.set_item(name, Motion(loaded).said(py)?)?;
    }
    Ok(all)
}
