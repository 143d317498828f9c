//! `run` and its `Response`.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipstick::assessment::single::{self, Job, Outcome, Solved};
use slipstick::error::{SolveError, Stopped};
use slipstick::model::Contents;
use slipstick::notice::{Notice, Severity};
use slipstick::progress::Cancel;
use slipstick::response::{History, Response as Answer};
use slipstick_files::{JobError, LoadedMotion, OpenJob, OutputFolder, events_csv, history_csv};
use slipstick_report::figures::{self, Drawn};
use slipstick_report::legend;
use slipstick_report::{DisplayUnits, FileNote, InputText, Report, Summary};

use crate::errors::{of_argument, of_file, of_job};
use crate::legend::{Line, friction_bounds};
use crate::model::Model;
use crate::motion::Motion;
use crate::work::interruptible;

/// Runs a model on a motion, on its own where none is given.
#[pyfunction]
#[pyo3(signature = (model, motion = None, *, floor_spectrum = false, history = true, check = true))]
pub(crate) fn run(
    py: Python<'_>,
    model: &Bound<'_, Model>,
    motion: Option<&Bound<'_, Motion>>,
    floor_spectrum: bool,
    history: bool,
    check: bool,
) -> PyResult<Response> {
    let own = model.get().analysis.motion.as_ref();
    if motion.is_none() && own.is_none() {
        let expected = "a motion, for the model has none of its own";
        return Err(of_argument(py, "motion", expected, "none"));
    }
    if floor_spectrum && !(history && check) {
        let expected = "False without a history and its check";
        return Err(of_argument(py, "floor_spectrum", expected, "True"));
    }
    let start = Instant::now();
    let (of, on) = (model.get(), motion.map(|motion| &motion.get().0));
    let work = |go_on: Cancel<'_>| -> Result<(OnceLock<OpenJob>, Answers), JobError> {
        // Copies of long motions take their time too.
        let ask = || match go_on() {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(SolveError::Stopped(Stopped)),
        };
        let analysis = &of.analysis;
        if let (Some(on), false) = (on, check) {
            let motion = single::motion_of(analysis, &on.motion)?;
            let solved = single::solve_all(analysis, &motion, history, go_on)?;
            let warnings = single::noticed(analysis, on);
            let noticed = solved.first().map(|solved| Summary::noticed(solved, &motion, &warnings));
            return Ok((OnceLock::new(), Answers::Solved(solved, noticed.unwrap_or_default())));
        }
        let analysis = analysis.clone();
        let job = match on {
            None => OpenJob::new(of.path(), analysis, None)?,
            Some(LoadedMotion { loaded, sources }) => {
                let loaded = loaded.clone();
                ask()?;
                let job = Job::new(analysis, loaded)?;
                ask()?;
                OpenJob { name: of.title(), job, sources: sources.clone() }
            }
        };
        ask()?;
        let found = if check {
            let (mut outcome, summary) = job.run_while(floor_spectrum, go_on)?;
            if !history {
                outcome.forget_history();
            }
            Answers::Judged(Box::new((outcome, summary)))
        } else {
            let Job { analysis, motion, warnings, .. } = &job.job;
            let solved = single::solve_all(analysis, motion, history, go_on)?;
            let noticed = solved.first().map(|solved| Summary::noticed(solved, motion, warnings));
            Answers::Solved(solved, noticed.unwrap_or_default())
        };
        Ok((OnceLock::from(job), found))
    };
    let (job, found) = interruptible(py, work)?.map_err(|error| of_job(py, &error))?;
    let (model, motion) = (model.clone().unbind(), motion.map(|motion| motion.clone().unbind()));
    Ok(Response { model, motion, job, found, summary: OnceLock::new(), took: start.elapsed() })
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
    model: Py<Model>,
    motion: Option<Py<Motion>>,
    /// Made of the two when it is asked for, where the analysis did without.
    job: OnceLock<OpenJob>,
    found: Answers,
    /// Of a response that is not judged, when it is asked for.
    summary: OnceLock<Summary>,
    took: Duration,
}

/// What was asked for.
enum Answers {
    /// Responses with their certificates.
    Judged(Box<(Outcome, Summary)>),
    /// Responses alone, at least one, and what is noticed.
    Solved(Vec<Solved>, Vec<Notice>),
}

impl Response {
    fn response(&self) -> Option<&Answer> {
        match &self.found {
            Answers::Judged(of) => Some(&of.0.nominal.response),
            Answers::Solved(solved, _) => solved.first().map(|solved| &solved.response),
        }
    }

    /// The history, if one was kept.
    fn kept(&self) -> Option<&History> {
        self.response()?.history.as_ref()
    }

    fn history(&self) -> PyResult<&History> {
        self.kept().ok_or_else(|| without("history"))
    }

    /// The analysis and its motion.
    fn job(&self) -> PyResult<&OpenJob> {
        if let Some(job) = self.job.get() {
            return Ok(job);
        }
        let of = self.model.get();
        let motion = self.motion.as_ref().map(|motion| &motion.get().0);
        let LoadedMotion { loaded, sources } = motion.ok_or_else(|| without("motion"))?.clone();
        let job = Job::new(of.analysis.clone(), loaded);
        let job = job.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(self.job.get_or_init(|| OpenJob { name: of.title(), job, sources }))
    }

    /// The report of a response with history and certificate.
    fn report<T>(&self, display: DisplayUnits, tell: impl FnOnce(&Report<'_>) -> T) -> PyResult<T> {
        let Answers::Judged(of) = &self.found else { return Err(without("check")) };
        self.history()?;
        let ((outcome, summary), open) = (&**of, self.job()?);
        let loaded = &open.job.loaded;
        let record = open.motion_words();
        let toml = open.job.analysis.to_toml_with_motion();
        let inputs = [InputText { path: &open.name, text: &toml }];
        let paths: Vec<String> =
            open.sources.iter().map(|file| Path::display(&file.path).to_string()).collect();
        let files: Vec<FileNote<'_>> = open
            .sources
            .iter()
            .zip(&paths)
            .zip(&loaded.description)
            .map(|((file, path), description)| FileNote { path, sha256: &file.sha256, description })
            .collect();
        let report = Report {
            summary,
            model: &open.job.analysis.model,
            motion: &open.job.motion,
            record: &record,
            response: &outcome.nominal.response,
            certificate: &outcome.nominal.certificate,
            bounds: outcome
                .bounds
                .as_ref()
                .map(|[lower, upper]| [&lower.response, &upper.response]),
            floor_spectra: summary.floor_spectra.as_ref(),
            inputs: &inputs,
            files: &files,
            command_line: "slipstick.run(model, motion)",
            display,
        };
        Ok(tell(&report))
    }

    fn summary(&self) -> PyResult<&Summary> {
        let solved = match &self.found {
            Answers::Judged(of) => return Ok(&of.1),
            Answers::Solved(solved, _) => solved,
        };
        if let Some(summary) = self.summary.get() {
            return Ok(summary);
        }
        let OpenJob { name, job, .. } = self.job()?;
        let made = Summary::of_solved(name, job, solved).ok_or_else(|| without("response"))?;
        Ok(self.summary.get_or_init(|| made))
    }
}

/// What was not asked for.
fn without(what: &str) -> PyErr {
    let found = "found one without";
    PyValueError::new_err(format!("expected a response of run(..., {what}=True), {found}"))
}

#[pymethods]
impl Response {
    /// The figures as the text that `slipstick run --json` prints.
    fn _summary_json(&self) -> PyResult<String> {
        Ok(self.summary()?.to_json())
    }

    /// Seconds of the work in Rust: opening or copying the motion, solving, certificate and figures.
    fn _took_s(&self) -> f64 {
        self.took.as_secs_f64()
    }

    /// Columns of the history: one row a sample, or both sides of every event.
    fn _history<'py>(&self, py: Python<'py>, knots: bool) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        let (history, response) = (self.history()?, self.response());
        let all: Vec<usize>;
        let rows = if knots {
            all = (0..history.len()).collect();
            &all
        } else {
            &history.rows
        };
        for (name, values) in response.into_iter().flat_map(|response| response.columns(rows)) {
            columns.set_item(name, values.into_pyarray(py))?;
        }
        Ok(columns)
    }

    /// Mode of the slider at the knots: 0 stuck, 1 and −1 sliding.
    fn _modes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let history = self.history()?;
        let modes = history.mode.iter().step_by(history.interfaces.max(1));
        Ok(modes.map(|mode| mode.sign()).collect::<Vec<_>>().into_pyarray(py))
    }

    /// Force of the whole slider at the knots in N, rising with the displacement.
    fn _slider_force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.history()?;
        let model = &self.job()?.job.analysis.model;
        let force = self.response().map(|response| response.slider_force_n(model));
        Ok(force.unwrap_or_default().into_pyarray(py))
    }

    /// The same along y; empty in one direction.
    fn _slider_force_y<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.history()?;
        let model = &self.job()?.job.analysis.model;
        let force = self.response().map(|response| response.slider_force_y_n(model));
        Ok(force.unwrap_or_default().into_pyarray(py))
    }

    /// Bounds of the friction force in N under the weight, each with the line that it has in figures.
    fn _friction_bounds(&self) -> Vec<(f64, Line)> {
        friction_bounds(&self.model.get().analysis.model)
    }

    /// What figures call the block, and the storeys or points of a structure by its modes.
    fn _places(&self) -> PyResult<(String, Vec<String>)> {
        let Summary { names, demands, .. } = self.summary()?;
        let count = demands.storeys.len().max(demands.points.len());
        let points = (1..=count).map(|point| legend::point(names, point)).collect();
        Ok((legend::block(names), points))
    }

    /// What figures call what slides on the floors.
    fn _contents(&self) -> PyResult<Vec<String>> {
        let (names, contents) =
            (&self.summary()?.names, self.model.get().analysis.model.contents());
        let name = |(i, of): (usize, &Contents)| legend::contents(names, i + 1, of.floor);
        Ok(contents.iter().enumerate().map(name).collect())
    }

    /// The motion as it was read, without a tail.
    #[getter]
    fn motion(&self, py: Python<'_>) -> PyResult<Py<Motion>> {
        if let Some(motion) = &self.motion {
            return Ok(motion.clone_ref(py));
        }
        let OpenJob { job, sources, .. } = self.job()?;
        let (loaded, sources) = (job.loaded.clone(), sources.clone());
        Py::new(py, Motion(LoadedMotion { loaded, sources }))
    }

    /// Energies at the knots in J.
    fn _energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Answers::Judged(of) = &self.found else { return Err(without("check")) };
        self.history()?;
        let energy = of.0.nominal.certificate.energy();
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
        let events = self.response().map_or(&[][..], |response| &response.events);
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

    /// Writes the files of `slipstick run --out` into a folder, and others beside them.
    fn _save(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        beside: Vec<(String, String)>,
    ) -> PyResult<()> {
        self.history()?;
        let (summary, page) =
            (self.summary()?.to_json(), self.report(DisplayUnits::Si, |of| of.to_html())?);
        let Some(response) = self.response() else { return Err(without("history")) };
        let written = py.detach(|| {
            let mut output = OutputFolder::create(&folder, &[])?;
            output.write("summary.json", summary.as_bytes())?;
            output.write_with("history.csv", |to| history_csv(response, to))?;
            output.write_with("events.csv", |to| events_csv(response, to))?;
            output.write("report.html", page.as_bytes())?;
            for (name, text) in &beside {
                output.write(name, text.as_bytes())?;
            }
            output.commit()
        });
        written.map_err(|error| of_file(py, &error))
    }

    /// The report as one page of HTML.
    fn _report_html(&self, py: Python<'_>, units: &str) -> PyResult<String> {
        self.report(display_units(py, units)?, |report| report.to_html())
    }

    /// The figures of the report as SVG by their names.
    fn _figures(&self) -> PyResult<Vec<(String, String)>> {
        let svg = |figure: Drawn| (figure.id, figure.svg.as_str().to_owned());
        self.report(DisplayUnits::Si, |report| figures::all(report).into_iter().map(svg).collect())
    }

    /// What makes its figures void, and all else that is noticed: kind, message and whether it is severe.
    fn _noticed(&self) -> Vec<(&'static str, &str, bool)> {
        let of = |notice: &'_ Notice| notice.severity() == Severity::Severe;
        let noticed = match &self.found {
            Answers::Judged(of) => &of.1.warnings,
            Answers::Solved(_, noticed) => noticed,
        };
        let notices = noticed.iter().filter(|notice| !notice.is_note());
        notices.map(|notice| (notice.kind.name(), &*notice.message, of(notice))).collect()
    }

    /// Name of the model.
    #[getter]
    fn name(&self) -> String {
        self.job.get().map_or_else(|| self.model.get().title(), |open| open.name.clone())
    }

    /// Whether the certificate holds; none of the stepwise method, and where it was not asked for.
    #[getter]
    fn holds(&self) -> Option<bool> {
        match &self.found {
            Answers::Judged(of) => of.1.checks.holds,
            Answers::Solved(..) => None,
        }
    }
}
