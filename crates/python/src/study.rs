//! `study`: many analyses of one plan.

use std::collections::HashMap;
use std::path::PathBuf;

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use slipstick::error::Stopped;
use slipstick::input::dimension_of;
use slipstick::input::plan::Plan;
use slipstick::notice::Notice;
use slipstick::study::engine::Engine;
use slipstick::study::{DesignScale, Record, Study as Runs};
use slipstick::table::{self, Cells};
use slipstick::units::Dimension;
use slipstick_files::{
    FileError, OpenStudy, Shard, StudyError, clear, conclude, expand, read_table,
};

use crate::errors::{of_argument, of_choice, of_file, of_input, of_refuted, of_study};
use crate::model::Model;
use crate::motion::Motion;
use crate::requests::level_measure;
use crate::table::Table;
use crate::values::{plain, quantity};
use crate::work::followed;

/// The parts of a study in its folder.
const PARTS: &str = "parts/part-*.parquet";

/// What came of a study.
#[pyclass(module = "slipstick._core", frozen, get_all)]
pub struct Study {
    /// One row a run; none where a shard alone was run.
    table: Option<Py<Table>>,
    /// Fractiles and counts, one row a level and demand; none where a shard alone was run.
    summary: Option<Py<Table>>,
    /// Number of runs.
    runs: u64,
    /// Number of those that have no answer.
    failures: u64,
    /// What a person should know.
    notices: Vec<String>,
}

/// Calls records by their names, where rows call them by the files that hold them.
fn rename(table: &mut table::Table, names: &[(String, String)]) {
    let of_file: HashMap<&str, &str> =
        names.iter().map(|(file, name)| (file.as_str(), name.as_str())).collect();
    for column in table.columns.iter_mut().filter(|c| ["record", "pair"].contains(&&*c.name)) {
        let Cells::Texts(cells) = &mut column.cells else { continue };
        for cell in cells {
            if let Some(name) = of_file.get(cell.as_str()) {
                *cell = (*name).to_owned();
            }
        }
    }
}

/// Numbers in SI, each of a list alone or with its unit; where one is none, its row is said.
fn numbers(
    name: &str,
    values: &Bound<'_, PyAny>,
    dimension: Option<Dimension>,
) -> PyResult<Vec<f64>> {
    let py = values.py();
    let number = |(row, value): (usize, PyResult<Bound<'_, PyAny>>)| {
        let value = value?;
        let number = match dimension {
            Some(dimension) => quantity(name, &value, dimension, true)?,
            None => {
                let number = plain(name, &value)?.and_then(|plain| plain.extract::<f64>().ok());
                number.ok_or_else(|| of_argument(py, name, "numbers", &value.to_string()))?
            }
        };
        if number.is_finite() {
            return Ok(number);
        }
        let found = format!("{number} in row {row}");
        Err(of_argument(py, name, "finite numbers", &found))
    };
    values.try_iter()?.enumerate().map(number).collect()
}

/// Numbers in SI of values that are in a unit of SI where they are bare; what has none is without a unit.
#[pyfunction]
pub(crate) fn numbers_in(name: &str, values: &Bound<'_, PyAny>, unit: &str) -> PyResult<Vec<f64>> {
    let of = |dimension: &Dimension| !unit.is_empty() && dimension.si_unit() == unit;
    numbers(name, values, Dimension::ALL.into_iter().find(of))
}

/// The scale of each design's records, where one is given: factors, or levels of a measure.
fn scale_of_designs(
    py: Python<'_>,
    scale: Option<&Bound<'_, PyAny>>,
    measure: Option<&str>,
    levels: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<DesignScale>> {
    match (scale, levels) {
        (Some(_), Some(_)) => Err(of_argument(py, "scale", "scale or scale_to", "both")),
        (_, None) if measure.is_some() => {
            let found = measure.unwrap_or_default();
            Err(of_argument(py, "measure", "scale_to beside it", &format!("{found:?}")))
        }
        (Some(scale), None) => Ok(Some(DesignScale::Factors(numbers("scale", scale, None)?))),
        (None, Some(levels)) => {
            let measure = level_measure(py, measure.unwrap_or("PGA"))?;
            let levels = numbers_in("scale_to", levels, measure.unit())?;
            Ok(Some(DesignScale::Levels(measure, levels)))
        }
        (None, None) => Ok(None),
    }
}

/// Demands of designs, each on all records: one row a run, records the slowest.
#[pyfunction]
#[pyo3(signature = (
    model, records, designs, *, scale = None, measure = None, scale_to = None, one_of = None, jobs = None,
    progress = None
))]
#[expect(clippy::too_many_arguments, reason = "the package calls it")]
pub(crate) fn demands(
    py: Python<'_>,
    model: &Model,
    records: Vec<(String, Motion)>,
    designs: Vec<(String, Bound<'_, PyAny>)>,
    scale: Option<&Bound<'_, PyAny>>,
    measure: Option<&str>,
    scale_to: Option<&Bound<'_, PyAny>>,
    one_of: Option<usize>,
    jobs: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Table> {
    let read = |(path, values): (String, Bound<'_, PyAny>)| {
        let dimension = dimension_of(&path).map_err(|error| of_input(py, &error))?;
        let values = numbers(&path, &values, dimension)?;
        Ok((path, values))
    };
    let paths: Vec<(String, Vec<f64>)> = designs.into_iter().map(read).collect::<PyResult<_>>()?;
    let count = paths.first().map_or(0, |(_, values)| values.len());
    for (path, values) in &paths {
        if values.len() != count || count == 0 {
            let expected = format!("{} values, as many as designs", count.max(1));
            return Err(of_argument(py, path, &expected, &values.len().to_string()));
        }
    }
    let scale = scale_of_designs(py, scale, measure, scale_to)?;
    let mut plan = Plan::listed(&paths, !records.is_empty()).map_err(|e| of_input(py, &e))?;
    plan.bound = model.analysis.friction_bounds.map(|_| "nominal");
    let record = |(name, Motion(read)): (String, Motion)| Record::read(name, read.loaded, None);
    let records = records.into_iter().map(record).collect();
    let study = Runs::new(&plan, &model.source, model.text(), records);
    let study = study.map_err(|error| of_input(py, &error))?;
    let done = followed(py, jobs, progress, |engine| {
        let study = match scale {
            Some(scale) => match study.scaled_by_design(scale) {
                Ok(study) => study,
                Err(error) => return Ok(Err(error)),
            },
            None => study,
        };
        engine.plan(study.runs());
        let rows = study.rows(0..study.runs(), engine)?;
        let refuted = one_of.map(|one_of| study.refuted(&rows, one_of, engine)).transpose()?;
        Ok::<_, Stopped>(Ok((study.table(&rows), refuted.flatten())))
    })?;
    match done {
        Err(Stopped) => Err(PyKeyboardInterrupt::new_err(())),
        Ok(Err(error)) => Err(of_choice(py, &error)),
        Ok(Ok((_, Some((run, what))))) => Err(of_refuted(py, run, &what)),
        Ok(Ok((table, None))) => Ok(Table(table)),
    }
}

/// A hash of a plan in a file and of all that it names.
#[pyfunction]
pub(crate) fn study_id(py: Python<'_>, plan: PathBuf) -> PyResult<String> {
    let id = followed(py, None, None, |_| OpenStudy::open(&plan).map(|study| study.id))?;
    id.map_err(|error| of_study(py, &error))
}

/// Runs a plan into a folder, or what the folder lacks of it, and reads what stands there then; of a
/// shard only runs it. Records in files that hold motions go by the names of these, and what is noticed of them
/// is noticed of the motions.
#[pyfunction]
#[pyo3(signature = (
    plan, folder, *, motions = Vec::new(), shard = None, jobs = None, progress = None, force = false
))]
#[expect(clippy::too_many_arguments, reason = "the package calls it")]
pub(crate) fn study(
    py: Python<'_>,
    plan: PathBuf,
    folder: PathBuf,
    motions: Vec<(String, String, Motion)>,
    shard: Option<(u64, u64)>,
    jobs: Option<i64>,
    progress: Option<Py<PyAny>>,
    force: bool,
) -> PyResult<Study> {
    let known = |(file, _, motion): &(String, _, Motion)| (file.clone(), motion.0.warnings.clone());
    let known: Vec<(String, Vec<Notice>)> = motions.iter().map(known).collect();
    let names: Vec<(String, String)> =
        motions.into_iter().map(|(file, name, _)| (file, name)).collect();
    let done = followed(py, jobs, progress, |engine| {
        let study = OpenStudy::open_knowing(&plan, &known, &Engine::unwatched())?;
        if force {
            clear(&folder)?;
        }
        let part = match shard {
            Some((index, count)) => Shard::new(index, count)?,
            None => Shard::WHOLE,
        };
        engine.plan(study.shard_runs(part));
        let outcome = study.run_shard(part, &folder, engine)?;
        let tables = match shard {
            Some(_) => None,
            None => {
                let summary = conclude(&study, &folder, engine)?;
                let mut table = read_table(&expand(&folder, PARTS)?)?.table;
                rename(&mut table, &names);
                Some((table, summary.table()))
            }
        };
        let notices = study.notices.iter().chain(&outcome.notices).cloned().collect();
        Ok((tables, outcome.runs, outcome.failures, notices))
    })?;
    let (tables, runs, failures, notices) =
        done.map_err(|error: StudyError| of_study(py, &error))?;
    let (table, summary) = tables.unzip();
    let new = |table: Option<_>| table.map(|table| Py::new(py, Table(table))).transpose();
    Ok(Study { table: new(table)?, summary: new(summary)?, runs, failures, notices })
}

/// Reads what a concluded study has in its folder: its runs, its summary, how many there are and have no answer.
#[pyfunction]
pub(crate) fn read_study(py: Python<'_>, folder: PathBuf) -> PyResult<Study> {
    let read = py.detach(|| {
        let summary = read_table(&[folder.join("summary.csv")])?.table;
        Ok::<_, FileError>((read_table(&expand(&folder, PARTS)?)?.table, summary))
    });
    let (table, summary) = read.map_err(|error| of_file(py, &error))?;
    let runs = table.rows() as u64;
    let status = table.texts_of("status").unwrap_or_default();
    let failures = status.iter().filter(|status| *status != "ok").count() as u64;
    let [table, summary] = [table, summary].map(|table| Py::new(py, Table(table)));
    Ok(Study { table: Some(table?), summary: Some(summary?), runs, failures, notices: Vec::new() })
}
