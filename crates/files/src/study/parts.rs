//! The files of a study in a folder.

use std::fs;
use std::path::Path;

use super::StudyError;
use super::part::{Notes, PartFile, part_of_name};
use crate::error::FileError;
use crate::parquet::Table;

/// What a study writes besides its parts.
pub(super) const MANIFEST: &str = "manifest.json";
pub(super) const SUMMARY: &str = "summary.csv";

fn names(folder: &Path) -> Result<Vec<String>, FileError> {
    let failed = |source| FileError::Read { path: folder.to_owned(), source };
    let entries = fs::read_dir(folder).map_err(failed)?;
    let mut names = Vec::new();
    for entry in entries {
        // What is no text is no name of ours.
        if let Ok(name) = entry.map_err(failed)?.file_name().into_string() {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// Whether a folder exists and holds anything at all but what a killed study left half-written.
///
/// # Errors
/// [`FileError::Read`], [`FileError::NotAFolder`].
pub fn has_parts(folder: &Path) -> Result<bool, FileError> {
    if !folder.exists() {
        return Ok(false);
    }
    if !folder.is_dir() {
        return Err(FileError::NotAFolder { path: folder.to_owned() });
    }
    Ok(names(folder)?.iter().any(|name| leftover(name).is_none()))
}

/// Removes what a study wrote into a folder; other files stay.
///
/// # Errors
/// [`FileError::Read`], and [`FileError::Write`] for a file that cannot be removed.
pub fn clear(folder: &Path) -> Result<(), FileError> {
    if !folder.exists() {
        return Ok(());
    }
    for name in names(folder)? {
        let ours = part_of_name(&name).is_some()
            || leftover(&name).is_some()
            || [MANIFEST, SUMMARY].contains(&name.as_str());
        if ours {
            remove(&folder.join(name))?;
        }
    }
    Ok(())
}

fn remove(path: &Path) -> Result<(), FileError> {
    fs::remove_file(path).map_err(|source| FileError::Write { path: path.to_owned(), source })
}

/// The part of a file that was left half-written: `.part-00012.parquet.1234-0.tmp`.
fn leftover(name: &str) -> Option<u64> {
    let (target, _) = name.strip_prefix('.')?.strip_suffix(".tmp")?.rsplit_once('.')?;
    part_of_name(target)
}

/// Removes what a killed study left half-written of some parts.
pub(super) fn remove_leftovers(
    folder: &Path,
    parts: &std::ops::Range<u64>,
) -> Result<(), FileError> {
    for name in names(folder)? {
        if leftover(&name).is_some_and(|part| parts.contains(&part)) {
            remove(&folder.join(name))?;
        }
    }
    Ok(())
}

/// The parts in a folder, in order of their runs.
///
/// # Errors
/// [`FileError::Table`] for a part that is damaged.
pub(super) fn parts(folder: &Path) -> Result<Vec<PartFile>, FileError> {
    let mut parts = Vec::new();
    for name in names(folder)?.into_iter().filter(|name| part_of_name(name).is_some()) {
        let table = Table::of(&folder.join(name))?;
        parts.push(PartFile { notes: Notes::of(&table)?, table });
    }
    parts.sort_by_key(|part| part.notes.first);
    Ok(parts)
}

/// Refuses parts of another study.
pub(super) fn refuse_foreign(parts: &[PartFile], id: &str) -> Result<(), StudyError> {
    match parts.iter().find(|part| part.notes.id != id) {
        Some(part) => Err(StudyError::Foreign { path: part.table.path.clone() }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_names_of_parts_and_leftovers() {
        assert_eq!(part_of_name("part-00012.parquet"), Some(12));
        assert_eq!(part_of_name("part-x.parquet"), None);
        assert_eq!(leftover(".part-00012.parquet.4711-3.tmp"), Some(12));
        assert_eq!(leftover("part-00012.parquet"), None);
        assert_eq!(leftover(".summary.csv.4711-3.tmp"), None);
    }
}
