//! `study`: many analyses of one plan.

use std::path::PathBuf;

use pyo3::prelude::*;
use slipstick_files::{OpenStudy, Shard, StudyError, clear, conclude, expand, read_table};

use crate::errors::of_study;
use crate::table::Table;
use crate::work::followed;

/// The parts of a study in its folder.
const PARTS: &str = "parts/part-*.parquet";

/// What came of a study.
#[pyclass(module = "slipstick._core", frozen, get_all)]
pub struct Study {
    /// One row a run.
    table: Py<Table>,
    /// Fractiles and counts, one row a level and demand.
    summary: Py<Table>,
    /// Number of runs.
    runs: u64,
    /// Number of those that have no answer.
    failures: u64,
    /// What a person should know.
    notices: Vec<String>,
}

/// Runs a plan into a folder, or what the folder lacks of it, and reads what stands there then.
#[pyfunction]
#[pyo3(signature = (plan, folder, *, jobs = None, progress = None, force = false))]
pub(crate) fn study(
    py: Python<'_>,
    plan: PathBuf,
    folder: PathBuf,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
    force: bool,
) -> PyResult<Study> {
    let done = followed(py, jobs, progress, |engine| {
        let study = OpenStudy::open(&plan)?;
        if force {
            clear(&folder)?;
        }
        engine.plan(study.study.runs());
        let outcome = study.run_shard(Shard::WHOLE, &folder, engine)?;
        let summary = conclude(&study, &folder, engine)?;
        let table = read_table(&expand(&folder, PARTS)?)?;
        let notices = study.notices.iter().chain(&outcome.notices).cloned().collect();
        Ok((table.table, summary.table(), outcome.runs, outcome.failures, notices))
    })?;
    let (table, summary, runs, failures, notices) =
        done.map_err(|error: StudyError| of_study(py, &error))?;
    let new = |table| Py::new(py, Table(table));
    Ok(Study { table: new(table)?, summary: new(summary)?, runs, failures, notices })
}
