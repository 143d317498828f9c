//! The files of a study in a folder.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use slipstick::hash::sha256_hex;
use slipstick::study::engine::Engine;

use super::StudyError;
use super::part::{Notes, PartFile, part_count, part_name, part_of_name, rows_of};
use super::seal::is_sealed;
use crate::error::FileError;
use crate::parquet::ParquetTable;
use crate::read::read_bytes;

/// The folder of the parts. Nothing else stands in it, so that any reader takes it as one table; a
/// part has its temporary name beside it.
pub(super) const PARTS: &str = "parts";

/// What a study writes besides its parts.
pub(super) const MANIFEST: &str = "manifest.json";
pub(super) const SUMMARY: &str = "summary.csv";
/// Its page, where one was asked for.
pub const REPORT: &str = "report.html";

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

/// Names in the folder of the parts; none where there is no such folder.
fn names_of_parts(folder: &Path) -> Result<Vec<String>, FileError> {
    let parts = folder.join(PARTS);
    if parts.is_dir() { names(&parts) } else { Ok(Vec::new()) }
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
    let empty = folder.join(PARTS).is_dir() && names_of_parts(folder)?.is_empty();
    let counts = |name: &String| half_written(name).is_none() && !(empty && name == PARTS);
    Ok(names(folder)?.iter().any(counts))
}

/// Number of runs in the parts that a folder holds of a study with so many runs.
#[must_use]
pub fn kept_runs(folder: &Path, runs: u64) -> u64 {
    let names = names_of_parts(folder).unwrap_or_default();
    let parts = names.iter().filter_map(|name| part_of_name(name));
    let rows = parts.filter(|part| *part < part_count(runs)).map(|part| rows_of(part, runs));
    rows.map(|rows| rows.end - rows.start).sum()
}

/// Where the parts stand that a folder holds: in `parts`, else in the folder itself, which may be
/// `parts` or one of the older layout.
pub(super) fn held(folder: &Path) -> PathBuf {
    let parts = folder.join(PARTS);
    if parts.is_dir() { parts } else { folder.to_owned() }
}

/// Refuses a folder of the older layout, with the parts beside the manifest.
///
/// # Errors
/// [`StudyError::OldLayout`], [`FileError::Read`].
pub(super) fn refuse_old_layout(folder: &Path) -> Result<(), StudyError> {
    if folder.is_dir() && names(folder)?.iter().any(|name| part_of_name(name).is_some()) {
        return Err(StudyError::OldLayout { folder: folder.to_owned(), parts: folder.join(PARTS) });
    }
    Ok(())
}

/// Removes what a study wrote into a folder, in the older layout too; other files stay.
///
/// # Errors
/// [`FileError::Read`], and [`FileError::Write`] for a file that cannot be removed.
pub fn clear(folder: &Path) -> Result<(), FileError> {
    if !folder.exists() {
        return Ok(());
    }
    for name in names_of_parts(folder)?.into_iter().filter(|name| part_of_name(name).is_some()) {
        remove(&folder.join(PARTS).join(name))?;
    }
    for name in names(folder)? {
        if is_ours(&name) || half_written(&name).is_some() {
            remove(&folder.join(name))?;
        }
    }
    Ok(())
}

fn remove(path: &Path) -> Result<(), FileError> {
    fs::remove_file(path).map_err(|source| FileError::Write { path: path.to_owned(), source })
}

/// Whether a study writes a file of that name.
fn is_ours(name: &str) -> bool {
    part_of_name(name).is_some() || [MANIFEST, SUMMARY, REPORT].contains(&name)
}

/// The file of a study of which this one was left half-written: `.part-00012.parquet.1234-0.tmp`.
fn half_written(name: &str) -> Option<&str> {
    let (target, writer) = name.strip_prefix('.')?.strip_suffix(".tmp")?.rsplit_once('.')?;
    let by_process = writer.chars().all(|c| c.is_ascii_digit() || c == '-');
    (by_process && is_ours(target)).then_some(target)
}

/// Removes what a killed study left half-written of some parts, and of the rest where these are all: other
/// shards may be at work in the folder.
pub(super) fn remove_leftovers(
    folder: &Path,
    wanted: &Range<u64>,
    is_whole: bool,
) -> Result<(), FileError> {
    for name in names(folder)? {
        let Some(target) = half_written(&name) else { continue };
        if part_of_name(target).map_or(is_whole, |part| wanted.contains(&part)) {
            remove(&folder.join(name))?;
        }
    }
    Ok(())
}

/// What stands under the names of parts in a folder.
#[derive(Debug, Default)]
pub(super) struct PartsFound {
    /// The parts, in order of their runs.
    pub whole: Vec<PartFile>,
    /// Files that are not what they were written as, or hold other runs than their names say.
    pub damaged: Vec<Damaged>,
    /// Files under names that the study does not give.
    pub strays: Vec<PathBuf>,
}

/// A file that is not the part of its name.
#[derive(Debug)]
pub(super) struct Damaged {
    pub path: PathBuf,
    pub part: u64,
    pub reason: String,
}

impl PartsFound {
    /// Refuses parts of another study.
    pub fn refuse_foreign(&self, id: &str) -> Result<(), StudyError> {
        match self.whole.iter().find(|part| part.notes.id != id) {
            Some(part) => Err(StudyError::Foreign { path: part.table.path.clone() }),
            None => Ok(()),
        }
    }

    /// Refuses what is not the part of its name.
    pub fn refuse_damaged(&self) -> Result<(), StudyError> {
        if let Some(Damaged { path, reason, .. }) = self.damaged.first() {
            return Err(StudyError::Damaged { path: path.clone(), reason: reason.clone() });
        }
        match self.strays.first() {
            Some(path) => Err(StudyError::Stray { path: path.clone() }),
            None => Ok(()),
        }
    }
}

/// Judges every file under a part's name in the folder of the parts: its hash, and the runs that it
/// holds.
///
/// # Errors
/// [`FileError::Read`].
pub(super) fn find(parts: &Path) -> Result<PartsFound, FileError> {
    let names = names(parts)?.into_iter();
    let named: Vec<_> = names.filter_map(|name| Some((part_of_name(&name)?, name))).collect();
    let judge = |i: usize| Ok(judge(&parts.join(&named[i].1), named[i].0));
    // Nothing stops an engine that nobody follows.
    let judged = Engine::unwatched().map(named.len(), judge).unwrap_or_default();
    let mut found = PartsFound::default();
    for ((part, name), judged) in named.into_iter().zip(judged) {
        let path = parts.join(&name);
        match judged? {
            _ if name != part_name(part) => found.strays.push(path),
            Ok(file) if part >= part_count(file.notes.runs) => found.strays.push(path),
            Ok(file) => found.whole.push(file),
            Err(reason) => found.damaged.push(Damaged { path, part, reason }),
        }
    }
    found.whole.sort_by_key(|part| part.notes.first);
    Ok(found)
}

/// The part in a file, or why it is none.
fn judge(path: &Path, part: u64) -> Result<Result<PartFile, String>, FileError> {
    if !path.is_file() {
        return Ok(Err("no file".to_owned()));
    }
    let bytes = read_bytes(path)?;
    let sha256 = sha256_hex(&bytes);
    if !is_sealed(bytes) {
        return Ok(Err("damaged: its bytes are not those that were written".to_owned()));
    }
    let table = ParquetTable::of(path)?;
    let notes = Notes::of(&table)?;
    let (held, own) = (notes.first..notes.first + notes.rows, rows_of(part, notes.runs));
    if part < part_count(notes.runs) && held != own {
        let range = |runs: &Range<u64>| format!("{} to {}", runs.start, runs.end.saturating_sub(1));
        let (held, own) = (range(&held), range(&own));
        return Ok(Err(format!("holds the runs {held}, where {own} belong")));
    }
    Ok(Ok(PartFile { table, notes, sha256 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_parts_and_leftovers() {
        assert_eq!(part_of_name("part-00012.parquet"), Some(12));
        assert_eq!(part_of_name("part-x.parquet"), None);
        let part = ".part-00012.parquet.4711-3.tmp";
        assert_eq!(half_written(part), Some("part-00012.parquet"));
        assert_eq!(half_written(".manifest.json.4711-3.tmp"), Some("manifest.json"));
        for other in ["part-00012.parquet", ".mine.csv.4711-3.tmp", ".manifest.json.mine.tmp"] {
            assert_eq!(half_written(other), None, "{other}");
        }
    }
}
