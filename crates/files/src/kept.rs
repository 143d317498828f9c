//! Costly runs of an analysis, kept in its folder until it is done.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use slipstick::hash::sha256_hex;
use slipstick::study::kept::KeptRuns;

use crate::error::FileError;

/// Name of the file in the folder of results.
const NAME: &str = "runs.kept";

/// What ends a line that is whole.
const END: &str = "\t.";

/// A file with a line a run, its key first. It is begun with the first run that is kept and lasts until the analysis
/// is done; a line that was cut off is not there.
pub struct KeptFile {
    path: PathBuf,
    /// Stands before all keys: other commands keep other figures of a run.
    command: String,
    before: HashMap<String, String>,
    file: Mutex<Option<File>>,
    count: Arc<AtomicU64>,
}

impl KeptFile {
    /// What a command that was interrupted has left in a folder, to which the same command adds.
    ///
    /// # Errors
    /// [`FileError::Read`] where the file is there and cannot be read.
    pub fn open(folder: &Path, command: &str) -> Result<Self, FileError> {
        let path = folder.join(NAME);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            Err(source) => return Err(FileError::Read { path, source }),
        };
        let text = String::from_utf8_lossy(&bytes);
        let whole = text.lines().filter_map(|line| line.strip_suffix(END));
        let command = format!("{} ", sha256_hex(command.as_bytes()));
        let own = whole.filter_map(|line| line.strip_prefix(&*command));
        let pairs = own.filter_map(|line| line.split_once('\t'));
        let before: HashMap<String, String> =
            pairs.map(|(key, line)| (key.to_owned(), line.to_owned())).collect();
        let count = Arc::new(AtomicU64::new(before.len() as u64));
        Ok(Self { path, command, before, file: Mutex::new(None), count })
    }

    /// Number of runs that are kept, to be asked from anywhere.
    #[must_use]
    pub fn count(&self) -> Arc<AtomicU64> {
        self.count.clone()
    }

    /// The analysis is done: its results stand for its runs.
    pub fn done(self) {
        drop(self.file);
        let _ = fs::remove_file(&self.path);
    }

    /// The file to add to, in a line of its own.
    fn opened(&self) -> std::io::Result<File> {
        let mut file = OpenOptions::new().create(true).append(true).open(&self.path)?;
        // An interrupted process may have left a part of one.
        if file.metadata()?.len() > 0 {
            file.write_all(b"\n")?;
        }
        Ok(file)
    }
}

impl KeptRuns for KeptFile {
    fn find(&self, key: &str) -> Option<String> {
        self.before.get(key).cloned()
    }

    fn keep(&self, key: &str, line: &str) {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        if file.is_none() {
            *file = self.opened().ok();
        }
        // A run that cannot be kept is made again.
        let line = format!("{}{key}\t{line}{END}\n", self.command);
        if file.as_mut().is_some_and(|file| file.write_all(line.as_bytes()).is_ok()) {
            self.count.fetch_add(1, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_was_cut_off_is_not_there() {
        let folder = std::env::temp_dir().join(format!("slipstick-kept-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let first = KeptFile::open(&folder, "ida m.toml").unwrap();
        assert!(!folder.join(NAME).exists(), "no file before the first run");
        first.keep("a", "gap, 01");
        first.keep("b", " 02");
        drop(first);
        let mut text = fs::read(folder.join(NAME)).unwrap();
        text.extend(b"c\t 0");
        fs::write(folder.join(NAME), text).unwrap();
        let second = KeptFile::open(&folder, "ida m.toml").unwrap();
        let found = |of: &KeptFile| ["a", "b", "c", "d"].map(|key| of.find(key));
        let [a, b] = [Some("gap, 01".to_owned()), Some(" 02".to_owned())];
        assert_eq!(found(&second), [a.clone(), b.clone(), None, None]);
        second.keep("d", " 03");
        assert_eq!(second.count().load(Ordering::Relaxed), 3);
        drop(second);
        let third = KeptFile::open(&folder, "ida m.toml").unwrap();
        assert_eq!(found(&third), [a, b, None, Some(" 03".to_owned())]);
        let other = KeptFile::open(&folder, "ida n.toml").unwrap();
        assert_eq!(found(&other), [const { None }; 4]);
        third.done();
        assert!(!folder.join(NAME).exists());
        fs::remove_dir(&folder).unwrap();
    }
}
