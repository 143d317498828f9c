//! Errors of the core as exceptions of `slipstick._errors`, with all that they know.

use std::ffi::CString;
use std::fmt::{self, Write};
use std::io;
use std::path::Path;

use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipstick::assessment::AssessmentError;
use slipstick::error::{ChoiceError, InputError, MotionError, RecordError, SolveError, UnitError};
use slipstick::laboratory::compare::CompareError;
use slipstick::laboratory::identify::IdentifyError;
use slipstick::laboratory::measured::MeasuredError;
use slipstick::laboratory::shaking_table::TableError;
use slipstick::notice::{Notice, Severity};
use slipstick::requests::FrontEnd;
use slipstick_files::{FileError, JobError, LaboratoryError, StudyError};

/// An exception of the package with fields.
fn exception(
    py: Python<'_>,
    class: &str,
    message: &str,
    fields: impl FnOnce(&Bound<'_, PyDict>) -> PyResult<()>,
) -> PyErr {
    let make = || {
        let known = PyDict::new(py);
        fields(&known)?;
        py.import("slipstick._errors")?.getattr(class)?.call((message,), Some(&known))
    };
    make().map_or_else(|error| error, PyErr::from_value)
}

/// A text in HTML.
pub(crate) struct Escaped<'a>(pub(crate) &'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|c| match c {
            '<' => f.write_str("&lt;"),
            '>' => f.write_str("&gt;"),
            '&' => f.write_str("&amp;"),
            c => f.write_char(c),
        })
    }
}

/// A warning in Python.
pub(crate) fn warn(py: Python<'_>, message: String) -> PyResult<()> {
    let class = py.import("slipstick._errors")?.getattr("SlipstickWarning")?;
    PyErr::warn(py, &class, &CString::new(message).unwrap_or_default(), 1)
}

/// A warning in Python for each severe notice.
pub(crate) fn warn_severe(py: Python<'_>, notices: &[Notice]) -> PyResult<()> {
    let mut severe = notices.iter().filter(|notice| notice.severity() == Severity::Severe);
    severe.try_for_each(|notice| warn(py, notice.message.clone()))
}

pub(crate) fn of_input(py: Python<'_>, error: &InputError) -> PyErr {
    exception(py, "InputError", &error.to_string(), |fields| {
        let place = &error.place;
        let in_text = !place.source_name.is_empty();
        fields.set_item("source", &place.source_name)?;
        fields.set_item("line", in_text.then_some(place.line))?;
        fields.set_item("column", in_text.then_some(place.column))?;
        fields.set_item("path", &error.path)?;
        fields.set_item("expected", &error.expected)?;
        fields.set_item("found", &error.found)?;
        fields.set_item("nearest", &error.nearest)
    })
}

/// An argument that cannot be.
pub(crate) fn of_argument(py: Python<'_>, path: &str, expected: &str, found: &str) -> PyErr {
    let (what, expected) = (path.to_owned(), expected.to_owned());
    of_choice(py, &ChoiceError { what, expected, found: found.to_owned(), nearest: None })
}

/// The same of an argument that is a quantity.
pub(crate) fn of_unit(py: Python<'_>, path: &str, error: &UnitError) -> PyErr {
    let UnitError { expected, found, nearest } = error.clone();
    of_choice(py, &ChoiceError { what: path.to_owned(), expected, found, nearest })
}

/// A field of a request that cannot be: it is a keyword here.
pub(crate) fn of_choice(py: Python<'_>, error: &ChoiceError) -> PyErr {
    let error = FrontEnd::Python.says(error);
    exception(py, "InputError", &error.to_string(), |fields| {
        fields.set_item("path", &error.what)?;
        fields.set_item("expected", &error.expected)?;
        fields.set_item("found", &error.found)?;
        fields.set_item("nearest", &error.nearest)
    })
}

/// What a file lacks, in words of Python: keys of a model and options of the command are keywords here. A
/// model's own record has its keys in the model.
fn in_python(text: &str, of_model: bool) -> String {
    const KEYS: &str = " to [motion]";
    let Some(at) = text.find(KEYS) else { return text.replace("add --channel ", "add channel=") };
    let (before, after) = text.split_at(at);
    let rest = after.get(KEYS.len()..).unwrap_or_default();
    let options = rest.strip_prefix(" (or --").and_then(|rest| rest.split_once(')'));
    let rest = options.map_or(rest, |(_, rest)| rest);
    format!("{before}{}{rest}", if of_model { KEYS } else { "" })
}

/// Samples that are no ground motion.
pub(crate) fn of_motion(py: Python<'_>, error: &MotionError) -> PyErr {
    if let MotionError::OutOfRange { quantity, expected, found } = error {
        let argument = quantity.trim_end_matches("_s");
        return of_argument(py, argument, expected, &found.to_string());
    }
    exception(py, "RecordError", &error.to_string(), |_| Ok(()))
}

fn of_record(py: Python<'_>, error: &RecordError, of_model: bool) -> PyErr {
    let expected = in_python(&error.expected, of_model);
    let error = &RecordError { expected, ..error.clone() };
    exception(py, "RecordError", &error.to_string(), |fields| {
        fields.set_item("source", &error.source_name)?;
        fields.set_item("line", error.line)?;
        fields.set_item("column", error.column)?;
        fields.set_item("offset", error.offset)?;
        fields.set_item("expected", &error.expected)?;
        fields.set_item("found", &error.found)
    })
}

/// What the system says of a file, as `open` would raise it.
fn of_system(path: &Path, source: &io::Error) -> PyErr {
    let text = source.to_string();
    let reason = text.find(" (os error").map_or(text.as_str(), |end| &text[..end]).to_owned();
    match source.raw_os_error() {
        Some(code) => PyOSError::new_err((code, reason, path.display().to_string())),
        None => PyOSError::new_err(format!("{}: {reason}", path.display())),
    }
}

pub(crate) fn of_file(py: Python<'_>, error: &FileError) -> PyErr {
    of_opened(py, error, false)
}

/// The same of a file that a model may name.
fn of_opened(py: Python<'_>, error: &FileError, of_model: bool) -> PyErr {
    match error {
        FileError::Read { path, source } | FileError::Write { path, source } => {
            of_system(path, source)
        }
        FileError::Record(error) => of_record(py, error, of_model),
        other => {
            let message = in_python(&other.to_string(), of_model);
            exception(py, "RecordError", &message, |_| Ok(()))
        }
    }
}

pub(crate) fn of_solve(py: Python<'_>, error: &SolveError) -> PyErr {
    if matches!(error, SolveError::Stopped(_)) {
        return PyKeyboardInterrupt::new_err(());
    }
    let time_s = match error {
        SolveError::NotFinite { time_s }
        | SolveError::TooManyEvents { time_s, .. }
        | SolveError::EndOfTravel { time_s, .. }
        | SolveError::NoConvergence { time_s, .. } => Some(*time_s),
        _ => None,
    };
    exception(py, "SolveError", &error.to_string(), |fields| fields.set_item("time_s", time_s))
}

pub(crate) fn of_job(py: Python<'_>, error: &JobError) -> PyErr {
    match error {
        JobError::Input(error) => of_input(py, error),
        JobError::File(error) => of_opened(py, error, true),
        JobError::Solve(error) => of_solve(py, error),
    }
}

/// A run that does not hold when it is run again and judged.
pub(crate) fn of_refuted(py: Python<'_>, run: u64, what: &str) -> PyErr {
    let message = format!("run {run} fails its check ({what}): run it alone, with its certificate");
    exception(py, "StudyError", &message, |_| Ok(()))
}

pub(crate) fn of_study(py: Python<'_>, error: &StudyError) -> PyErr {
    match error {
        StudyError::Input { error, .. } => of_input(py, error),
        StudyError::File(error) => of_file(py, error),
        StudyError::Stopped(_) => PyKeyboardInterrupt::new_err(()),
        other => {
            // What is there already is never run again here.
            let message = other.to_string().replace("--force", "force=True");
            exception(py, "StudyError", &message.replace(" with --resume", ""), |_| Ok(()))
        }
    }
}

pub(crate) fn of_laboratory(py: Python<'_>, error: &LaboratoryError) -> PyErr {
    match error {
        LaboratoryError::File(error) => of_file(py, error),
        LaboratoryError::Measured(MeasuredError::File(error)) => of_record(py, error, false),
        LaboratoryError::Measured(MeasuredError::Mapping(error))
        | LaboratoryError::Mapping(error) => of_input(py, error),
        LaboratoryError::Choice(error) => of_choice(py, error),
    }
}

pub(crate) fn of_compare(py: Python<'_>, error: &CompareError) -> PyErr {
    match error {
        CompareError::Measured(error) => of_record(py, error, false),
        CompareError::Motion(error) => of_motion(py, error),
        CompareError::Solve(error) => of_solve(py, error),
    }
}

pub(crate) fn of_identify(py: Python<'_>, error: &IdentifyError) -> PyErr {
    match error {
        IdentifyError::Input(error) => of_input(py, error),
        IdentifyError::Measured(error) | IdentifyError::Table(TableError::Measured(error)) => {
            of_record(py, error, false)
        }
        IdentifyError::Choice(error) => of_choice(py, error),
        IdentifyError::Table(TableError::Compare(error)) => of_compare(py, error),
        IdentifyError::Table(TableError::Stopped(_)) => PyKeyboardInterrupt::new_err(()),
        other => exception(py, "StudyError", &other.to_string(), |_| Ok(())),
    }
}

pub(crate) fn of_assessment(py: Python<'_>, error: &AssessmentError) -> PyErr {
    match error {
        AssessmentError::Input(error) => of_input(py, error),
        AssessmentError::Choice(error) => of_choice(py, error),
        AssessmentError::Motion(error) => of_motion(py, error),
        AssessmentError::Stopped(_) => PyKeyboardInterrupt::new_err(()),
        other => exception(py, "StudyError", &other.to_string(), |_| Ok(())),
    }
}
