//! The records of a folder.

use std::fs;
use std::path::{Path, PathBuf};

use slipstick::motion::GroundMotion;

use crate::error::FileError;
use crate::load::{RecordRequest, load_record};

/// How deep folders are searched.
const DEPTH: usize = 8;

/// Records below a folder, by their paths in it, and why the other files are none.
#[derive(Debug, Default)]
pub struct FolderRecords {
    /// Name relative to the folder, and the horizontal motion.
    pub records: Vec<(String, GroundMotion)>,
    /// One sentence for each file that cannot be read without being told more.
    pub skipped: Vec<String>,
}

/// Reads every file below a folder that says itself what it is; in the order of their names.
///
/// Links to folders are not followed.
///
/// # Errors
/// [`FileError::Read`] where a folder cannot be listed. A file that is no record, or whose units or
/// step its reader would have to be told, is skipped and named.
pub fn folder_records(folder: &Path) -> Result<FolderRecords, FileError> {
    let mut paths = Vec::new();
    list(folder, 0, &mut paths)?;
    let mut found = FolderRecords::default();
    for path in paths {
        let request = RecordRequest { path: path.clone(), ..RecordRequest::default() };
        match load_record(&request) {
            Ok(loaded) => {
                let relative = path.strip_prefix(folder).unwrap_or(&path);
                let name = relative.to_string_lossy().replace('\\', "/");
                found.records.push((name, loaded.loaded.motion));
            }
            Err(error) => found.skipped.push(error.to_string()),
        }
    }
    Ok(found)
}

fn list(folder: &Path, depth: usize, paths: &mut Vec<PathBuf>) -> Result<(), FileError> {
    let failed = |source| FileError::Read { path: folder.to_owned(), source };
    let mut entries = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        entries.push(entry.map_err(failed)?);
    }
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let kind = entry.file_type().map_err(failed)?;
        if kind.is_dir() && depth < DEPTH {
            list(&entry.path(), depth + 1, paths)?;
        } else if !kind.is_dir() && entry.path().is_file() {
            paths.push(entry.path());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_records_of_a_folder_in_order_and_what_is_none() {
        let folder = std::env::temp_dir().join(format!("slipstick-folder-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("b")).unwrap();
        let record = "time_s,acceleration_m_per_s2\n0,0\n1,5\n2,0\n";
        fs::write(folder.join("b/two.csv"), record).unwrap();
        fs::write(folder.join("a.csv"), record).unwrap();
        fs::write(folder.join("note.md"), "# no record\n").unwrap();
        let found = folder_records(&folder).unwrap();
        let names: Vec<&str> = found.records.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a.csv", "b/two.csv"]);
        assert_eq!(found.skipped.len(), 1);
        assert!(found.skipped[0].contains("note.md"), "{}", found.skipped[0]);
        fs::remove_dir_all(&folder).unwrap();
        assert!(matches!(folder_records(&folder), Err(FileError::Read { .. })));
    }
}
