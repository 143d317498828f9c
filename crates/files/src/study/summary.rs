//! The figures of a study from the parts in its folder.

use std::path::Path;

use slipstick::study::StudySummary;
use slipstick::study::engine::Engine;
use slipstick::study::summary::Rows;
use slipstick::table::Cells;

use super::part::PartFile;
use super::{OpenStudy, StudyError};
use crate::error::FileError;

/// Reads the parts of a study.
pub(super) fn of(
    open: &OpenStudy,
    files: &[PartFile],
    engine: &Engine<'_>,
) -> Result<StudySummary, StudyError> {
    let study = &open.study;
    let status = study.fields().len() - 1;
    let solved = |take: &mut dyn FnMut(u64, bool)| {
        for file in files {
            let Cells::Texts(cells) = file.table.cells(status)? else { continue };
            (file.notes.first..).zip(cells).for_each(|(run, status)| take(run, status == "ok"));
        }
        Ok(())
    };
    let first = study.first_demand();
    let demand = |index: usize, take: &mut dyn FnMut(u64, f64)| {
        for file in files {
            let values = file.table.cells(first + index)?.to_numbers().unwrap_or_default();
            (file.notes.first..).zip(values).for_each(|(run, value)| take(run, value));
        }
        Ok(())
    };
    let travel_used_up = |take: &mut dyn FnMut(u64, f64)| {
        let Some(column) = study.travel_used_up() else { return Ok(()) };
        for file in files {
            let values = file.table.cells(column)?.to_numbers().unwrap_or_default();
            (file.notes.first..).zip(values).for_each(|(run, value)| take(run, value));
        }
        Ok(())
    };
    let warnings = |take: &mut dyn FnMut(u64, &str)| {
        for file in files {
            let Cells::Texts(cells) = file.table.cells(status - 1)? else { continue };
            (file.notes.first..).zip(&cells).for_each(|(run, kinds)| take(run, kinds));
        }
        Ok(())
    };
    let name = open.plan.name.clone().unwrap_or_else(|| stem(&open.plan_path));
    let rows = Rows {
        solved: &solved,
        demand: &demand,
        travel_used_up: &travel_used_up,
        warnings: &warnings,
    };
    study.summary(&name, &rows, engine)
}

fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "study".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Writes the summary of a folder.
pub(super) fn write(path: &Path, summary: &StudySummary) -> Result<(), FileError> {
    crate::write::write_whole(path, crate::table::to_csv(&summary.table()).as_bytes())
}
