//! Runs as a table that says of which measure their levels are.

use std::path::{Path, PathBuf};

use slipstick::input::plan::{Levels, Plan};
use slipstick::input::stem;

use slipstick::study::Certified;

use super::part::{MEASURE_KEY, Notes, part_of_name};
use super::parts::MANIFEST;
use crate::error::FileError;
use crate::globs::expand;
use crate::parquet::ParquetTable;
use crate::read::read_bytes;
use crate::table::{ReadTable, read_table};

/// What commands besides a study say of their runs.
const SUMMARY_JSON: &str = "summary.json";

/// The column of that measure.
const MEASURE: &str = "measure";

/// What the commands write into their folders, the first that is there.
const TABLES: [&str; 4] = ["parts/part-*.parquet", "part-*.parquet", "ida.parquet", "runs.parquet"];

/// The files of runs: a table itself, or those in the folder of a command.
///
/// # Errors
/// [`FileError::Unfit`] for a folder without runs.
pub fn files_of_runs(source: &Path) -> Result<Vec<PathBuf>, FileError> {
    if !source.is_dir() {
        return Ok(vec![source.to_owned()]);
    }
    let found = TABLES.iter().find_map(|pattern| expand(source, pattern).ok());
    found.ok_or_else(|| FileError::Unfit {
        path: source.to_owned(),
        expected: "a table, or a folder that ida, study, spectrum or design wrote".to_owned(),
        found: "a folder without runs".to_owned(),
    })
}

/// Runs in CSV or Parquet as one table. A study says in its manifest what its records were scaled to,
/// and its table is given that as a column; so does a file that its parts were merged to.
///
/// # Errors
/// As [`read_table`].
pub fn read_runs(files: &[PathBuf]) -> Result<ReadTable, FileError> {
    let mut read = read_table(files)?;
    if read.table.find(MEASURE).is_none()
        && read.table.find("level").is_some()
        && let Some(measure) = measure_of_levels(&read.path)
    {
        let rows = read.table.rows();
        read.table.texts(MEASURE, vec![measure; rows]);
    }
    read.certified = certified(files);
    Ok(read)
}

/// How many of the runs in the files of a study were certified; none where one of them does not say so.
fn certified(files: &[PathBuf]) -> Option<Certified> {
    let mut all = Certified::default();
    for file in files {
        let notes = Notes::of(&ParquetTable::of(file).ok()?).ok()?;
        all.join(notes.checks.certified(notes.rows));
    }
    Some(all)
}

/// What the records of a study were scaled to: from the file itself, else from the manifest that stands beside the
/// folder of a part.
pub(super) fn measure_of_levels(part: &Path) -> Option<String> {
    let own =
        ParquetTable::of(part).ok().and_then(|file| file.note(MEASURE_KEY).map(str::to_owned));
    if own.is_some() {
        return own;
    }
    part_of_name(part.file_name()?.to_str()?)?;
    let folder = part.parent()?;
    let beside = [folder.join("..").join(MANIFEST), folder.join(MANIFEST)];
    let manifest = beside.iter().find_map(|path| read_bytes(path).ok())?;
    let manifest: serde_json::Value = serde_json::from_slice(&manifest).ok()?;
    let plan = Plan::parse(MANIFEST, manifest.get("plan")?.as_str()?).ok()?;
    match plan.records?.levels {
        Levels::Measure { measure, .. } => Some(measure.to_string()),
        Levels::Factors(_) => None,
    }
}

/// The folder that a source of runs is, or in which a command wrote it.
fn folder_of(source: &Path) -> Option<&Path> {
    match source.file_stem()?.to_str()? {
        "ida" | "capacities" | "runs" if source.is_file() => source.parent(),
        _ => Some(source),
    }
}

/// A file of JSON in a folder; `None` where there is none.
fn json_in(folder: &Path, name: &str) -> Option<serde_json::Value> {
    serde_json::from_slice(&read_bytes(&folder.join(name)).ok()?).ok()
}

/// The limit that an incremental dynamic analysis was run for, from the summary in its folder or beside its
/// table; `None` where it was another demand's.
#[must_use]
pub fn limit_of_ida(source: &Path, demand: &str) -> Option<f64> {
    let summary = json_in(folder_of(source)?, SUMMARY_JSON)?;
    (summary.get("demand")?.as_str()? == demand).then(|| summary.get("limit")?.as_f64())?
}

/// What the runs of a command are of, from what it wrote beside them: the name of the model, of a study that of its
/// model's file and its own; `None` where nothing says so.
#[must_use]
pub fn model_of_runs(source: &Path) -> Option<String> {
    let folder = folder_of(source)?;
    if let Some(summary) = json_in(folder, SUMMARY_JSON) {
        return Some(summary.get("model")?.as_str()?.to_owned());
    }
    let manifest = json_in(folder, MANIFEST)?;
    // The plan stands first, the model second.
    let model = stem(manifest.get("inputs")?.get(1)?.get("path")?.as_str()?).to_owned();
    let study = manifest.get("name").and_then(serde_json::Value::as_str);
    Some(study.map_or_else(|| model.clone(), |study| format!("{model} ({study})")))
}
