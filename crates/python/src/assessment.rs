//! `spectrum`, `ida`, `fragility`, `design`: many records to a decision.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipstick::assessment::AssessmentError;
use slipstick::assessment::suite::{Recorded, Suite};
use slipstick::notice::Notice;
use slipstick::record::Origin;
use slipstick::requests::{Answer, Kind, On, Runs};
use slipstick::study::{Certified, Worst};
use slipstick::units::Dimension;
use slipstick_files::{
    OpenJob, ReadRecords, SuiteError, SuiteRequest, TARGET, files_of_runs, limit_of_ida, read_runs,
    read_target,
};
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::{Provenance, Sheet, answer};

use crate::errors::{of_argument, of_assessment, of_file, of_job, warn, warn_severe};
use crate::model::Model;
use crate::motion::Motion;
use crate::requests::{FieldTexts, asked};
use crate::table::Table;
use crate::values::{channel_of, quantity, record_units};
use crate::work::followed;

/// A result as people and programs read it.
#[pyclass(module = "slipstick._core", frozen)]
pub struct Assessment {
    sheet: Sheet,
    call: &'static str,
    tables: Vec<(&'static str, Py<Table>)>,
}

impl Assessment {
    fn new(py: Python<'_>, kind: Kind, answer: Answer) -> PyResult<Self> {
        let call = match kind {
            Kind::Spectrum => "slipstick.spectrum(model, records, over)",
            Kind::Sensitivity => "slipstick.sensitivity(model, records, paths)",
            Kind::Ida => "slipstick.ida(model, records)",
            Kind::Design => "slipstick.design(model, records, vary)",
            Kind::Fragility => "slipstick.fragility(table)",
            _ => "slipstick.suite(models, records)",
        };
        let sheet = answer::sheet(&answer, DisplayUnits::Si);
        let new = |tabled: answer::Tabled| Ok((tabled.name, Py::new(py, Table(tabled.table))?));
        let tables = answer::tables(answer).into_iter().map(new).collect::<PyResult<Vec<_>>>()?;
        Ok(Self { sheet, call, tables })
    }
}

#[pymethods]
impl Assessment {
    /// The tables by their names.
    #[getter]
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tables = PyDict::new(py);
        for (name, table) in &self.tables {
            tables.set_item(name, table)?;
        }
        Ok(tables)
    }

    /// The figures as SVG by their names.
    fn _figures(&self) -> Vec<(String, String)> {
        let figures = self.sheet.figures.iter();
        figures.map(|figure| (figure.id.clone(), figure.svg.as_str().to_owned())).collect()
    }

    /// What the command prints.
    #[getter]
    fn text(&self) -> String {
        self.sheet.to_text()
    }

    fn _summary_json(&self) -> String {
        self.sheet.to_json()
    }

    fn _report_html(&self) -> String {
        let provenance = Provenance { command_line: self.call, files: &[], inputs: &[] };
        self.sheet.to_html(&provenance)
    }
}

/// Reads the records of files, folders or patterns; names and motions.
#[pyfunction]
#[pyo3(signature = (
    patterns, *, y = Vec::new(), channel = None, units = None, dt = None, vertical = Vec::new()
))]
pub(crate) fn read_suite(
    py: Python<'_>,
    patterns: Vec<String>,
    y: Vec<String>,
    channel: Option<&Bound<'_, PyAny>>,
    units: Option<&Bound<'_, PyAny>>,
    dt: Option<&Bound<'_, PyAny>>,
    vertical: Vec<String>,
) -> PyResult<Vec<(String, Motion)>> {
    let units = units.map(record_units).transpose()?;
    let dt_s = dt.map(|dt| quantity("dt", dt, Dimension::Time, true)).transpose()?;
    let channel = channel.map(channel_of).transpose()?;
    let asked = SuiteRequest { patterns, along_y: y, vertical, ..SuiteRequest::default() };
    let request = SuiteRequest { units, dt_s, channel, ..asked };
    let read = followed(py, None, None, |engine| ReadRecords::read(&request, engine))?;
    let ReadRecords { records, warnings } = read.map_err(|error| match error {
        SuiteError::File(error) => of_file(py, &error),
        SuiteError::Choice(error) => of_assessment(py, &AssessmentError::Choice(error)),
        SuiteError::Stopped(error) => of_assessment(py, &AssessmentError::Stopped(error)),
    })?;
    for warning in warnings {
        warn(py, warning.message)?;
    }
    for (name, loaded) in &records {
        let of = |notice: &Notice| Notice {
            message: format!("{name}: {}", notice.message),
            ..notice.clone()
        };
        warn_severe(py, &loaded.warnings.iter().map(of).collect::<Vec<_>>())?;
    }
    Ok(records.into_iter().map(|(name, loaded)| (name, Motion(loaded))).collect())
}

/// Records by their names.
type Named = Vec<(String, Motion)>;

/// The suite of records, of pairs with as many other components.
fn suite_of(records: Named, second: Named) -> Suite {
    let pairs = !second.is_empty();
    let mut others = second.into_iter();
    let both = records.into_iter().flat_map(|first| [Some(first), others.next()]);
    let read = both.flatten().map(|(name, motion)| (name, motion.0.loaded));
    let mut suite = Suite::of(read, false);
    if pairs {
        suite.pair_up();
    }
    suite
}

/// The model's own motion as a suite of one.
fn own_motion(py: Python<'_>, model: &Model) -> PyResult<Suite> {
    let analysis = model.analysis.clone();
    let open = OpenJob::new(model.path(), analysis, None).map_err(|error| of_job(py, &error))?;
    let (name, made) = (open.motion_name(), open.sources.is_empty());
    Ok(Suite::of([(name, open.job.loaded)], made))
}

/// A model on a suite.
fn on<'a>(name: &'a str, model: &'a Model, suite: &'a Suite) -> On<'a> {
    let (source, text, analysis) = (&model.source, model.text(), &model.analysis);
    On { name, source, text, set: &[], analysis, suite }
}

/// An analysis of a model over records: a spectrum, an incremental dynamic analysis or a design.
#[pyfunction]
#[pyo3(signature = (kind, model, records, second, given, *, jobs = None, progress = None))]
#[expect(clippy::too_many_arguments, reason = "the package calls it")]
pub(crate) fn assess(
    py: Python<'_>,
    kind: &str,
    model: &Model,
    records: Named,
    second: Named,
    given: FieldTexts,
    jobs: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let asked = asked(py, kind, given)?;
    let suite = match records.is_empty() {
        true => own_motion(py, model)?,
        false => suite_of(records, second),
    };
    let on = on(model.name(), model, &suite);
    let answer = followed(py, jobs, progress, |engine| asked.run(&on, engine))?;
    Assessment::new(py, asked.kind(), answer.map_err(|error| of_assessment(py, &error))?)
}

/// Models on the same records, side by side.
#[pyfunction]
#[pyo3(signature = (
    models, records, second, given, *, target = None, check = true, jobs = None, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "the package calls it")]
pub(crate) fn suite(
    py: Python<'_>,
    models: Vec<(String, Model)>,
    records: Named,
    second: Named,
    given: FieldTexts,
    target: Option<PathBuf>,
    check: bool,
    jobs: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let asked = asked(py, Kind::Suite.name(), given)?;
    let asked = if check { asked } else { asked.uncertified() };
    let target = target.map(|path| {
        let read = read_target(&path).map_err(|found| of_argument(py, "target", TARGET, &found));
        read.map(|(spectrum, _)| (path.display().to_string(), spectrum))
    });
    let target = target.transpose()?;
    let suite = suite_of(records, second);
    let on: Vec<On<'_>> = models.iter().map(|(name, model)| on(name, model, &suite)).collect();
    let target = target.as_ref().map(|(name, spectrum)| (name.as_str(), spectrum.clone()));
    let answer = followed(py, jobs, progress, |engine| asked.suite(&on, target, engine))?;
    Assessment::new(py, asked.kind(), answer.map_err(|error| of_assessment(py, &error))?)
}

/// Runs, how many of them were certified, and the worst of those.
type Counted = (u64, u64, Option<(String, String, f64)>);

/// What runs were made of: the hash of the model, and of every motion its name, hash and peak acceleration in m/s².
type MadeOf = (String, Vec<(String, String, f64)>);

/// A lognormal fragility of a table, of which the limit may be known, and how many of its runs were certified.
#[pyfunction]
#[pyo3(signature = (
    table, given, *, limit = None, certified = None, made_of = None, jobs = None, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "the package calls it")]
pub(crate) fn fit(
    py: Python<'_>,
    table: &Table,
    given: FieldTexts,
    limit: Option<f64>,
    certified: Option<Counted>,
    made_of: Option<MadeOf>,
    jobs: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let asked = asked(py, Kind::Fragility.name(), given)?;
    let certified = certified.map(|(runs, certified, worst)| Certified {
        certified,
        worst: worst.map(|(run, what, error)| Worst { run, what, error }),
        ..Certified::of(runs)
    });
    let certified = certified.as_ref();
    let runs = Runs { name: "table", source: "table", table: &table.0, limit, certified };
    let answer = followed(py, jobs, progress, |engine| asked.fit(&runs, engine))?;
    let mut answer = answer.map_err(|error| of_assessment(py, &error))?;
    if let Some((model_hash, motions)) = made_of {
        let of = |(name, motion_hash, pga_m_per_s2)| Recorded {
            name,
            motion_hash: Some(motion_hash),
            pga_m_per_s2,
            origin: Origin::default(),
            factor: None,
            notices: Vec::new(),
        };
        answer.model_hash = Some(model_hash);
        answer.records = motions.into_iter().map(of).collect();
    }
    Assessment::new(py, asked.kind(), answer)
}

/// Reads the runs of a table or of a command's folder, the limit on a demand that they were made for, and how many of
/// them were certified where they are those of a study.
#[pyfunction]
#[pyo3(name = "read_runs")]
pub(crate) fn runs_of(
    py: Python<'_>,
    source: PathBuf,
    demand: Option<&str>,
) -> PyResult<(Table, Option<f64>, Option<Counted>)> {
    let asked = asked(py, Kind::Fragility.name(), Vec::new())?;
    let limit = limit_of_ida(&source, demand.unwrap_or(asked.demand()));
    let read = py.detach(|| read_runs(&files_of_runs(&source)?));
    let read = read.map_err(|error| of_file(py, &error))?;
    let certified = read.certified.map(|of| {
        (of.runs, of.certified, of.worst.map(|worst| (worst.run, worst.what, worst.error)))
    });
    Ok((Table(read.table), limit, certified))
}
