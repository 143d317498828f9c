//! `spectrum`, `ida`, `fragility`, `design`: many records to a decision.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipstick::assessment::AssessmentError;
use slipstick::assessment::suite::Suite;
use slipstick::record::Units;
use slipstick::requests::{Answer, Field, Kind, On, Request, Runs, Takes};
use slipstick_files::{
    OpenSuite, SuiteError, SuiteRequest, files_of_runs, limit_of_ida, read_runs,
};
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::{Sheet, Went, answer};

use crate::errors::{of_argument, of_assessment, of_file};
use crate::model::Model;
use crate::motion::Motion;
use crate::table::Table;
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
            Kind::Ida => "slipstick.ida(model, records)",
            Kind::Design => "slipstick.design(model, records, vary)",
            Kind::Fragility => "slipstick.fragility(table)",
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
    fn _figures(&self) -> Vec<(&'static str, String)> {
        let figures = self.sheet.figures.iter();
        figures.map(|figure| (figure.id, figure.svg.as_str().to_owned())).collect()
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
        let went = Went { command_line: self.call, files: &[], inputs: &[] };
        self.sheet.to_html(&went)
    }
}

/// Reads the records of files, folders or patterns; names and motions.
#[pyfunction]
#[pyo3(signature = (patterns, *, channel = None, units = None, dt_s = None, vertical = Vec::new()))]
pub(crate) fn read_suite(
    py: Python<'_>,
    patterns: Vec<String>,
    channel: Option<String>,
    units: Option<&str>,
    dt_s: Option<f64>,
    vertical: Vec<String>,
) -> PyResult<Vec<(String, Motion)>> {
    let units = units.map(|text| {
        let expected = "units of records, such as \"g\" or \"cm/s2\"";
        Units::parse(text).ok_or_else(|| of_argument(py, "units", expected, text))
    });
    let units = units.transpose()?;
    let request =
        SuiteRequest { patterns, vertical, units, dt_s, channel, ..SuiteRequest::default() };
    let open = followed(py, None, None, |engine| OpenSuite::open(&request, engine))?;
    let open = open.map_err(|error| match error {
        SuiteError::File(error) => of_file(py, &error),
        SuiteError::Choice(error) => of_assessment(py, &AssessmentError::Choice(error)),
        SuiteError::Stopped(error) => of_assessment(py, &AssessmentError::Stopped(error)),
    })?;
    let records = open.suite.records.into_iter();
    Ok(records.map(|record| (record.name.clone(), Motion::recorded(record))).collect())
}

/// An analysis of a model over records: a spectrum, an incremental dynamic analysis or a design.
#[pyfunction]
#[pyo3(signature = (kind, model, records, given, *, jobs = None, progress = None))]
pub(crate) fn assess(
    py: Python<'_>,
    kind: &str,
    model: &Model,
    records: Vec<(String, Motion)>,
    given: Vec<(String, String)>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let asked = asked(py, kind, &given)?;
    let records = records.into_iter().map(|(name, motion)| (name, motion.0.loaded));
    let suite = Suite::of(records, false);
    let on = On {
        name: model.name(),
        source: &model.source,
        text: model.text(),
        set: &[],
        analysis: &model.analysis,
        suite: &suite,
    };
    let answer = followed(py, jobs, progress, |engine| asked.run(&on, engine))?;
    Assessment::new(py, asked.kind(), answer.map_err(|error| of_assessment(py, &error))?)
}

/// A lognormal fragility of a table, of which the limit may be known.
#[pyfunction]
#[pyo3(signature = (table, given, *, limit = None, jobs = None, progress = None))]
pub(crate) fn fit(
    py: Python<'_>,
    table: &Table,
    given: Vec<(String, String)>,
    limit: Option<f64>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let asked = asked(py, Kind::Fragility.name(), &given)?;
    let runs = Runs { name: "table", source: "table", table: &table.0, limit };
    let answer = followed(py, jobs, progress, |engine| asked.fit(&runs, engine))?;
    Assessment::new(py, asked.kind(), answer.map_err(|error| of_assessment(py, &error))?)
}

fn asked(py: Python<'_>, kind: &str, given: &[(String, String)]) -> PyResult<Request> {
    let names = Kind::ALL.map(Kind::name).join(", ");
    let known = Kind::ALL.into_iter().find(|known| known.name() == kind);
    let kind = known.ok_or_else(|| of_argument(py, "kind", &names, kind))?;
    let given: Vec<(String, String)> =
        given.iter().map(|(name, text)| (name.replace('_', "-"), text.clone())).collect();
    let given = given.iter().map(|(name, text)| (name.as_str(), text.clone()));
    Request::new(kind, given).map_err(|error| of_assessment(py, &AssessmentError::Choice(error)))
}

/// The fields of an analysis: name, whether it may be repeated, default, what it is.
#[pyfunction]
pub(crate) fn fields(kind: &str) -> Vec<(String, bool, &'static str, &'static str)> {
    let kind = Kind::ALL.into_iter().find(|known| known.name() == kind);
    let of = |field: &Field| {
        let many = field.takes == Takes::Many;
        (field.name.replace('-', "_"), many, field.default, field.about)
    };
    kind.map_or_else(Vec::new, |kind| kind.fields().iter().map(of).collect())
}

/// Reads the runs of a table or of a command's folder, and the limit on a demand that they were made for.
#[pyfunction]
#[pyo3(name = "read_runs")]
pub(crate) fn runs_of(
    py: Python<'_>,
    source: PathBuf,
    demand: Option<&str>,
) -> PyResult<(Table, Option<f64>)> {
    let asked = asked(py, Kind::Fragility.name(), &[])?;
    let limit = limit_of_ida(&source, demand.unwrap_or(asked.demand()));
    let read = py.detach(|| read_runs(&files_of_runs(&source)?));
    Ok((Table(read.map_err(|error| of_file(py, &error))?.table), limit))
}
