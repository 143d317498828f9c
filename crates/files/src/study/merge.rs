//! The end of a study: manifest and summary of a folder, and one file of many folders.

use std::path::{Path, PathBuf};

use slipstick::input::plan::Method;
use slipstick::study::StudySummary;
use slipstick::study::engine::Engine;
use slipstick::table::Cells;
use slipstick_report::json::{each, pretty, worst_keys};
use slipstick_report::view;

use super::part::{self, Checks, Notes, PartFile};
use super::parts::{MANIFEST, PARTS, PartsFound, SUMMARY, find, held};
use super::runs::measure_of_levels;
use super::summary;
use super::{OpenStudy, StudyError};
use crate::error::FileError;
use crate::parquet::at;
use crate::write::{refuse_inputs, write_whole, write_whole_with};

/// What was joined to one file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Merged {
    /// Number of rows.
    pub rows: u64,
    /// Runs that failed.
    pub failures: u64,
    /// What came of running some again.
    pub checks: Checks,
}

/// Writes `manifest.json` and `summary.csv` of the parts in a folder and gives the summary; the
/// threads are those of the pool that it is called in. Parts that are damaged are left out.
///
/// # Errors
/// [`StudyError`] for parts that belong to another study, and files that cannot be written.
pub fn conclude(
    study: &OpenStudy,
    folder: &Path,
    engine: &Engine<'_>,
) -> Result<StudySummary, StudyError> {
    let found = find(&folder.join(PARTS))?;
    found.refuse_foreign(&study.id)?;
    let files = found.whole;
    let summary = summary::of(study, &files, engine)?;
    summary::write(&folder.join(SUMMARY), &summary)?;
    write_whole(&folder.join(MANIFEST), manifest(study, &files).as_bytes())?;
    Ok(summary)
}

/// What the manifest says: version, plan, inputs with their hashes, seed, counts and checks. Nothing
/// in it depends on when, where or by which machine the study was run.
fn manifest(study: &OpenStudy, files: &[PartFile]) -> String {
    let total = totals(files);
    let cases = study.study.cases();
    let sampling = study.plan.sampling.as_ref();
    let bounds = study.study.bounds().iter().filter(|_| study.study.has_bounds());
    let checks = &total.checks;
    pretty(&view! {
        slipstick: env!("CARGO_PKG_VERSION"),
        study: &study.id,
        name: &study.plan.name,
        plan: &study.plan_text,
        inputs: each(&study.inputs, |(path, sha256)| view! { path, sha256 }),
        method: sampling.map(|sampling| match sampling.method {
            Method::Sobol => "sobol",
            Method::LatinHypercube => "latin-hypercube",
            Method::Grid => "grid",
        }),
        seed: sampling.and_then(|sampling| sampling.seed),
        records: cases.records,
        levels: cases.levels,
        samples: cases.samples,
        bounds: each(bounds, |bound| bound.name),
        runs: study.study.runs(),
        rows: total.rows,
        complete: total.rows == study.study.runs(),
        failures: total.failures,
        checks: view! {
            rows: checks.rows,
            equilibrium_residual: checks.equilibrium_residual,
            friction_excess: checks.friction_excess,
            energy_balance_error: checks.energy_balance_error,
            demands_error: checks.demands_error,
            worst: checks.worst.as_ref().map(worst_keys),
        },
        // A part by its path from the manifest, its runs and the hash of its file.
        parts: each(files, |PartFile { table, notes, sha256, .. }| {
            let name = table.path.file_name().map(|name| name.to_string_lossy());
            view! {
                path: format!("{PARTS}/{}", name.unwrap_or_default()),
                first_run: notes.first,
                rows: notes.rows,
                sha256,
            }
        }),
    })
}

fn totals(files: &[PartFile]) -> Merged {
    let mut total = Merged::default();
    for PartFile { notes, .. } in files {
        total.rows += notes.rows;
        total.failures += notes.failures;
        total.checks.join(&notes.checks);
    }
    total
}

/// Joins the parts in some folders to one file: all runs of the study in their order.
///
/// The bytes of the file follow from the rows alone. A part that is in two folders counts once. A
/// folder is that of a study, or the one in it that holds the parts.
///
/// # Errors
/// [`StudyError::Foreign`] for parts of different studies, [`StudyError::Damaged`] and
/// [`StudyError::Stray`] for files that are not the parts of their names,
/// [`StudyError::Incomplete`] where runs are missing, [`FileError`] for files that cannot be read or written.
pub fn merge(folders: &[PathBuf], out: &Path) -> Result<Merged, StudyError> {
    let mut all = PartsFound::default();
    for folder in folders {
        let found = find(&held(folder))?;
        found.refuse_damaged()?;
        all.whole.extend(found.whole);
    }
    all.whole.sort_by_key(|file| file.notes.first);
    if let Some(first) = all.whole.first() {
        all.refuse_foreign(&first.notes.id)?;
    }
    let mut files = all.whole;
    files.dedup_by_key(|file| file.notes.first);
    let named = folders.iter().map(|f| f.display().to_string()).collect::<Vec<_>>().join(", ");
    let Some(first) = files.first().cloned() else {
        let reason = "it holds no parts of a study".to_owned();
        let path = folders.first().cloned().unwrap_or_default();
        return Err(FileError::Table { path, reason }.into());
    };
    let runs = first.notes.runs;
    let mut next = 0;
    for file in &files {
        if file.notes.first != next {
            break;
        }
        next += file.notes.rows;
    }
    if next != runs {
        let last = runs.saturating_sub(1);
        return Err(StudyError::Incomplete { last, missing: next, folders: named });
    }
    let inputs: Vec<PathBuf> = files.iter().map(|file| file.table.path.clone()).collect();
    refuse_inputs(out, &inputs)?;
    let total = totals(&files);
    let notes = Notes {
        first: 0,
        rows: total.rows,
        failures: total.failures,
        checks: total.checks.clone(),
        measure: first.notes.measure.clone().or_else(|| measure_of_levels(&first.table.path)),
        ..first.notes
    };
    let fields = first.table.fields();
    write_whole_with(out, |to| {
        let mut table = part::table(to, fields, &notes).map_err(at(out))?;
        for file in &files {
            if file.table.fields() != fields {
                let reason = "its columns are not those of the other parts".to_owned();
                return Err(FileError::Table { path: file.table.path.clone(), reason });
            }
            let columns = (0..fields.len()).map(|column| file.table.cells(column));
            let columns = columns.collect::<Result<Vec<Cells>, FileError>>()?;
            table.row_group(&columns).map_err(at(out))?;
        }
        table.finish().map_err(at(out))?;
        Ok(())
    })?;
    Ok(total)
}
