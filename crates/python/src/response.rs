//! `run` and its `Response`.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipstick::assessment::single::{Job, Outcome};
use slipstick::error::{SolveError, Stopped};
use slipstick::notice::{Notice, Severity};
use slipstick::progress::GoOn;
use slipstick::response::History;
use slipstick_files::{JobError, LoadedMotion, OpenJob};
use slipstick_report::{DisplayUnits, FileNote, InputText, Report, Summary};

use crate::errors::{of_argument, of_job};
use crate::model::Model;
use crate::motion::Motion;
use crate::work::interruptible;

/// Runs a model on a motion, on its own where none is given.
#[pyfunction]
#[pyo3(signature = (model, motion = None, *, floor_spectrum = false))]
pub(crate) fn run(
    py: Python<'_>,
    model: &Model,
    motion: Option<&Motion>,
    floor_spectrum: bool,
) -> PyResult<Response> {
    let in_plane = match motion {
        None => model.analysis.motion.as_ref().is_some_and(|source| source.key_of_y().is_some()),
        Some(Motion(loaded)) => loaded.motion.horizontal_y_m_per_s2().is_some(),
    };
    if motion.is_none() && model.analysis.motion.is_none() {
        let expected = "a motion, for the model has none of its own";
        return Err(of_argument(py, "motion", expected, "none"));
    }
    if floor_spectrum && in_plane {
        let expected = "False with a motion in two directions";
        return Err(of_argument(py, "floor_spectrum", expected, "True"));
    }
    let work = |go_on: GoOn<'_>| -> Result<Response, JobError> {
        let start = Instant::now();
        // Copies of long motions take their time too.
        let ask = || match go_on() {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(SolveError::Stopped(Stopped)),
        };
        let analysis = model.analysis.clone();
        let job = match motion {
            None => OpenJob::new(model.path(), analysis, None)?,
            Some(Motion(LoadedMotion { loaded, sources })) => {
                let loaded = loaded.clone();
                ask()?;
                let job = Job::new(analysis, loaded)?;
                ask()?;
                OpenJob { name: model.title(), job, sources: sources.clone() }
            }
        };
        ask()?;
        let (outcome, summary) = job.run_while(floor_spectrum, go_on)?;
        Ok(Response { job, outcome, summary, took: start.elapsed() })
    };
    interruptible(py, work)?.map_err(|error| of_job(py, &error))
}

/// Units to show results in.
pub(crate) fn display_units(py: Python<'_>, name: &str) -> PyResult<DisplayUnits> {
    DisplayUnits::of_name(name).ok_or_else(|| {
        let names = DisplayUnits::NAMES.map(|(name, ..)| format!("{name:?}")).join(", ");
        of_argument(py, "units", &format!("one of {names}"), &format!("{name:?}"))
    })
}

/// What came of one analysis.
#[pyclass(module = "slipstick._core", frozen)]
pub struct Response {
    job: OpenJob,
    outcome: Outcome,
    summary: Summary,
    took: Duration,
}

impl Response {
    fn response_history(&self) -> Option<&History> {
        self.outcome.nominal.response.history.as_ref()
    }
}

#[pymethods]
impl Response {
    /// The figures as the text that `slipstick run --json` prints.
    fn _summary_json(&self) -> String {
        self.summary.to_json()
    }

    /// Seconds of the work in Rust: opening or copying the motion, solving, certificate and figures.
    fn _took_s(&self) -> f64 {
        self.took.as_secs_f64()
    }

    /// Columns of the history: one row a sample, or both sides of every event.
    fn _history<'py>(&self, py: Python<'py>, knots: bool) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        let Some(history) = self.response_history() else { return Ok(columns) };
        let all: Vec<usize>;
        let rows = if knots {
            all = (0..history.len()).collect();
            &all
        } else {
            &history.rows
        };
        for (name, values) in self.outcome.nominal.response.columns(rows) {
            columns.set_item(name, values.into_pyarray(py))?;
        }
        Ok(columns)
    }

    /// Mode of the slider at the knots: 0 stuck, 1 and −1 sliding.
    fn _modes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let history = self.response_history();
        let modes = history.map_or(&[][..], |history| &history.mode);
        let width = history.map_or(1, |history| history.interfaces.max(1));
        modes.iter().step_by(width).map(|mode| mode.sign()).collect::<Vec<_>>().into_pyarray(py)
    }

    /// Force of the whole slider at the knots in N, rising with the displacement.
    fn _slider_force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let model = &self.job.job.analysis.model;
        self.outcome.nominal.response.slider_force_n(model).into_pyarray(py)
    }

    /// Static and kinetic friction in N under the weight, each towards +x and −x.
    fn _friction_limits(&self) -> [[f64; 2]; 2] {
        let model = &self.job.job.analysis.model;
        let normal_n = model.normal_n();
        [model.static_friction(), model.kinetic_friction()].map(|way| way.map(|mu| mu * normal_n))
    }

    /// The motion as it was read, without a tail.
    #[getter]
    fn motion(&self) -> Motion {
        Motion(LoadedMotion {
            loaded: self.job.job.loaded.clone(),
            sources: self.job.sources.clone(),
        })
    }

    /// Energies at the knots in J.
    fn _energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let energy = self.outcome.nominal.certificate.energy();
        let columns = PyDict::new(py);
        for (name, values) in [
            ("input_j", &energy.input_j),
            ("kinetic_j", &energy.kinetic_j),
            ("strain_j", &energy.strain_j),
            ("damping_j", &energy.damping_j),
            ("friction_j", &energy.friction_j),
        ] {
            columns.set_item(name, values.clone().into_pyarray(py))?;
        }
        Ok(columns)
    }

    /// Events as (time in s, kind, direction, sliding displacement in m, interface).
    fn _events(&self) -> Vec<(f64, &'static str, f64, f64, String)> {
        let events = &self.outcome.nominal.response.events;
        events
            .iter()
            .map(|e| {
                (
                    e.time_s,
                    e.kind.name(),
                    e.mode.sign(),
                    e.sliding_displacement_m,
                    e.interface_name(),
                )
            })
            .collect()
    }

    /// The report as one page of HTML.
    fn _report_html(&self, py: Python<'_>, units: &str) -> PyResult<String> {
        let display = display_units(py, units)?;
        let (outcome, loaded) = (&self.outcome, &self.job.job.loaded);
        let record = loaded.description.join("; ");
        let toml = self.job.job.analysis.to_toml_with_motion();
        let inputs = [InputText { path: &self.job.name, text: &toml }];
        let paths: Vec<String> =
            self.job.sources.iter().map(|file| Path::display(&file.path).to_string()).collect();
        let files: Vec<FileNote<'_>> = self
            .job
            .sources
            .iter()
            .zip(&paths)
            .zip(&loaded.description)
            .map(|((file, path), description)| FileNote { path, sha256: &file.sha256, description })
            .collect();
        let report = Report {
            summary: &self.summary,
            model: &self.job.job.analysis.model,
            motion: &self.job.job.motion,
            record: &record,
            response: &outcome.nominal.response,
            certificate: &outcome.nominal.certificate,
            bounds: outcome
                .bounds
                .as_ref()
                .map(|[lower, upper]| [&lower.response, &upper.response]),
            floor_spectra: self.summary.floor_spectra.as_ref(),
            inputs: &inputs,
            files: &files,
            command_line: "slipstick.run(model, motion)",
            display,
        };
        Ok(report.to_html())
    }

    /// What makes its figures void, and all else that is noticed: kind, message and whether it is severe.
    fn _noticed(&self) -> Vec<(&'static str, &str, bool)> {
        let of = |notice: &'_ Notice| notice.severity() == Severity::Severe;
        let notices = self.summary.warnings.iter().filter(|notice| !notice.is_note());
        notices.map(|notice| (notice.kind.name(), &*notice.message, of(notice))).collect()
    }

    /// Name of the model.
    #[getter]
    fn name(&self) -> &str {
        &self.job.name
    }

    /// Whether the certificate holds; none of the stepwise method.
    #[getter]
    fn holds(&self) -> Option<bool> {
        self.summary.checks.holds
    }
}
