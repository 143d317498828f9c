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

/// Runs a plan into a folder, or what the folder lacks of it, and reads what stands there then; of a
/// shard only runs it.
#[pyfunction]
#[pyo3(signature = (plan, folder, *, shard = None, jobs = None, progress = None, force = false))]
pub(crate) fn study(
    py: Python<'_>,
    plan: PathBuf,
    folder: PathBuf,
    shard: Option<(u64, u64)>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
    force: bool,
) -> PyResult<Study> {
    let done = followed(py, jobs, progress, |engine| {
        let study = OpenStudy::open(&plan)?;
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
                Some((read_table(&expand(&folder, PARTS)?)?.table, summary.table()))
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
