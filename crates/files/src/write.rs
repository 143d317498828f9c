//! Whole files or none.
//!
//! A file is written under a temporary name beside its target and renamed when it is complete. The
//! names of temporary files and of folders made for them are kept in one list of the process, so
//! that Ctrl-C can remove them: it must work from wherever the program is.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::FileError;

/// What must be removed if the process ends now.
#[derive(Default)]
struct Live {
    files: BTreeSet<PathBuf>,
    /// Made for output and not yet used; removed only where empty.
    folders: BTreeSet<PathBuf>,
    /// Set by [`remove_temporaries`]: nothing new is begun.
    ending: bool,
}

static LIVE: Mutex<Live> =
    Mutex::new(Live { files: BTreeSet::new(), folders: BTreeSet::new(), ending: false });

fn live() -> MutexGuard<'static, Live> {
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all temporary files and the empty folders made for them, and begins no new ones; for a
/// handler of Ctrl-C, after which the process ends. It waits for a set of renames under way.
pub fn remove_temporaries() {
    let mut live = live();
    live.ending = true;
    for file in std::mem::take(&mut live.files) {
        let _ = fs::remove_file(file);
    }
    for folder in std::mem::take(&mut live.folders).iter().rev() {
        let _ = fs::remove_dir(folder);
    }
}

/// Refuses an output path that is one of the inputs, whatever way they are written.
///
/// # Errors
/// [`FileError::IsInput`].
pub fn refuse_inputs(output: &Path, inputs: &[PathBuf]) -> Result<(), FileError> {
    let Ok(real) = fs::canonicalize(output) else { return Ok(()) };
    let same = |input: &PathBuf| fs::canonicalize(input).is_ok_and(|input| input == real);
    if inputs.iter().any(same) {
        return Err(FileError::IsInput { path: output.to_owned() });
    }
    Ok(())
}

/// Writes one file, whole or not at all; an existing one is replaced.
///
/// # Errors
/// [`FileError::Write`], [`FileError::IsFolder`]; nothing is left behind.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    Temporary::write(path, |to| to.write_all(bytes))?.rename(&mut live())
}

/// As [`write_whole`], with the temporary name in a folder of the same file system, for targets in a
/// folder where only whole files may stand.
///
/// # Errors
/// As [`write_whole`].
pub(crate) fn write_whole_by(folder: &Path, path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    Temporary::write_in(folder, path, |to| to.write_all(bytes))?.rename(&mut live())
}

/// As [`write_whole`], for content that is made while it is written.
///
/// # Errors
/// As [`write_whole`], and those of `fill`.
pub(crate) fn write_whole_with(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<fs::File>) -> Result<(), FileError>,
) -> Result<(), FileError> {
    let mut reason = None;
    let filled = Temporary::write(path, |to| {
        fill(to).map_err(|error| {
            reason = Some(error);
            io::ErrorKind::Other.into()
        })
    });
    match (filled, reason) {
        (_, Some(reason)) => Err(reason),
        (filled, None) => filled?.rename(&mut live()),
    }
}

/// A complete file under a temporary name; removed when dropped.
struct Temporary {
    name: PathBuf,
    target: PathBuf,
}

impl Temporary {
    fn write(
        target: &Path,
        fill: impl FnOnce(&mut BufWriter<fs::File>) -> io::Result<()>,
    ) -> Result<Self, FileError> {
        Self::write_in(target.parent().unwrap_or(Path::new("")), target, fill)
    }

    fn write_in(
        folder: &Path,
        target: &Path,
        fill: impl FnOnce(&mut BufWriter<fs::File>) -> io::Result<()>,
    ) -> Result<Self, FileError> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let failed = |source| FileError::Write { path: target.to_owned(), source };
        if target.is_dir() {
            return Err(FileError::IsFolder { path: target.to_owned() });
        }
        let Some(file_name) = target.file_name() else {
            let reason = io::Error::new(io::ErrorKind::InvalidInput, "it has no file name");
            return Err(failed(reason));
        };
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let mut name = std::ffi::OsString::from(".");
        name.push(file_name);
        name.push(format!(".{}-{count}.tmp", std::process::id()));
        let name = folder.join(name);
        let file = {
            // Created under the lock: Ctrl-C finds it in the list or finds no file.
            let mut live = live();
            if live.ending {
                return Err(failed(io::ErrorKind::Interrupted.into()));
            }
            let file = fs::File::create_new(&name).map_err(failed)?;
            live.files.insert(name.clone());
            file
        };
        let temporary = Self { name, target: target.to_owned() };
        let mut file = BufWriter::new(file);
        fill(&mut file).map_err(failed)?;
        let file = file.into_inner().map_err(|error| failed(error.into_error()))?;
        file.sync_all().map_err(failed)?;
        Ok(temporary)
    }

    fn rename(self, live: &mut Live) -> Result<(), FileError> {
        let result = fs::rename(&self.name, &self.target);
        if result.is_err() {
            let _ = fs::remove_file(&self.name);
        }
        live.files.remove(&self.name);
        let path = self.target.clone();
        // Its file is gone either way, and the list's lock is held.
        std::mem::forget(self);
        result.map_err(|source| FileError::Write { path, source })
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if live().files.remove(&self.name) {
            let _ = fs::remove_file(&self.name);
        }
    }
}

/// A folder that receives a set of files, all of them or none.
///
/// Dropped without [`OutputFolder::commit`] it leaves nothing: no temporary file, and no folder
/// that it made.
pub struct OutputFolder {
    folder: PathBuf,
    inputs: Vec<PathBuf>,
    files: Vec<Temporary>,
    stale: Vec<PathBuf>,
    made: Vec<PathBuf>,
}

impl OutputFolder {
    /// Takes a folder for output, made with those above it where it does not exist; `inputs` are
    /// never overwritten.
    ///
    /// # Errors
    /// [`FileError::NotAFolder`] for a file, [`FileError::Write`] where it cannot be made or
    /// written to.
    pub fn create(folder: &Path, inputs: &[PathBuf]) -> Result<Self, FileError> {
        let mut output = Self {
            folder: folder.to_owned(),
            inputs: inputs.to_vec(),
            files: vec![],
            stale: vec![],
            made: vec![],
        };
        output.make(folder)?;
        // Known before an analysis is run, not after it.
        drop(Temporary::write(&folder.join("writable"), |_| Ok(()))?);
        Ok(output)
    }

    fn make(&mut self, folder: &Path) -> Result<(), FileError> {
        // Looked up first: another process may make the folder meanwhile.
        let there = fs::symlink_metadata(folder).is_ok();
        // The empty path is the current folder.
        if folder.as_os_str().is_empty() || folder.is_dir() {
            return Ok(());
        }
        if there {
            return Err(FileError::NotAFolder { path: folder.to_owned() });
        }
        if let Some(above) = folder.parent() {
            self.make(above)?;
        }
        let failed = |source| FileError::Write { path: folder.to_owned(), source };
        let mut live = live();
        if live.ending {
            return Err(failed(io::ErrorKind::Interrupted.into()));
        }
        match fs::create_dir(folder) {
            Err(_) if folder.is_dir() => return Ok(()),
            made => made.map_err(failed)?,
        }
        live.folders.insert(folder.to_owned());
        self.made.push(folder.to_owned());
        Ok(())
    }

    /// Makes a folder inside, where it does not exist.
    ///
    /// # Errors
    /// [`FileError::NotAFolder`], [`FileError::Write`].
    pub(crate) fn make_inside(&mut self, name: &str) -> Result<(), FileError> {
        self.make(&self.folder.join(name))
    }

    /// The path that a file of the set will have.
    #[must_use]
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Writes a file of the set under a temporary name.
    ///
    /// # Errors
    /// [`FileError::IsInput`], [`FileError::IsFolder`], [`FileError::Write`].
    pub fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        self.write_with(name, |to| to.write_all(bytes))
    }

    /// As [`OutputFolder::write`], for text that is made while it is written.
    ///
    /// # Errors
    /// As [`OutputFolder::write`].
    pub fn write_with(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<fs::File>) -> io::Result<()>,
    ) -> Result<(), FileError> {
        let target = self.path(name);
        debug_assert!(
            self.files.iter().all(|file| file.target != target),
            "{name} is written twice: the first would be lost"
        );
        refuse_inputs(&target, &self.inputs)?;
        self.files.push(Temporary::write(&target, fill)?);
        Ok(())
    }

    /// Names of what another analysis may have written here: with its summary replaced they would be taken
    /// for results of this one. They are removed where a summary stood, never an input and never a file of this set.
    pub fn replaces(&mut self, names: &[&str]) {
        if !self.path("summary.json").is_file() {
            return;
        }
        let own = |path: &PathBuf| path.is_file() && refuse_inputs(path, &self.inputs).is_ok();
        let stale = names.iter().map(|name| self.path(name)).filter(own).collect();
        self.stale = stale;
    }

    /// Gives every file its name.
    ///
    /// # Errors
    /// [`FileError::Write`] where a rename fails; each file is whole or as it was before.
    pub fn commit(mut self) -> Result<(), FileError> {
        let mut live = live();
        let written: Vec<PathBuf> = self.files.iter().map(|file| file.target.clone()).collect();
        let mut files = std::mem::take(&mut self.files).into_iter();
        let renamed = files.try_for_each(|file| file.rename(&mut live));
        if renamed.is_ok() {
            for path in self.stale.iter().filter(|path| !written.contains(path)) {
                let _ = fs::remove_file(path);
            }
            for folder in self.made.drain(..) {
                live.folders.remove(&folder);
            }
        }
        // What is left takes the lock to remove its files.
        drop(live);
        renamed
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        self.files.clear();
        let mut live = live();
        for folder in self.made.iter().rev() {
            if live.folders.remove(folder) {
                let _ = fs::remove_dir(folder);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fresh folder for one test.
    fn scratch(test: &str) -> PathBuf {
        let name = format!("slipstick-write-{}-{test}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn one_file_is_replaced_whole() {
        let folder = scratch("whole");
        let path = folder.join("a.txt");
        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(&folder), ["a.txt"]);
    }

    #[test]
    fn set_appears_only_when_complete() {
        let folder = scratch("set");
        let out = folder.join("new/out");
        let mut output = OutputFolder::create(&out, &[]).unwrap();
        output.write("a.txt", b"a").unwrap();
        output.write("b.txt", b"b").unwrap();
        assert!(!out.join("a.txt").exists());
        output.commit().unwrap();
        assert_eq!(names(&out), ["a.txt", "b.txt"]);
        // Other files of the folder stay.
        let mut output = OutputFolder::create(&out, &[]).unwrap();
        output.write("c.txt", b"c").unwrap();
        output.commit().unwrap();
        assert_eq!(names(&out), ["a.txt", "b.txt", "c.txt"]);
    }

    #[test]
    fn abandoned_set_leaves_nothing() {
        let folder = scratch("abandoned");
        let mut output = OutputFolder::create(&folder.join("new/out"), &[]).unwrap();
        output.write("a.txt", b"a").unwrap();
        drop(output);
        assert!(names(&folder).is_empty());
    }

    /// Shards of one study start at the same time, in a folder that none of them finds.
    #[test]
    fn folder_that_another_makes_meanwhile_is_taken() {
        let folder = scratch("meanwhile");
        for round in 0..50 {
            let out = folder.join(format!("{round}/out"));
            let barrier = std::sync::Barrier::new(8);
            let create = || {
                barrier.wait();
                OutputFolder::create(&out, &[])
            };
            let made: Vec<_> = std::thread::scope(|scope| {
                let threads: Vec<_> = (0..8).map(|_| scope.spawn(create)).collect();
                threads.into_iter().map(|thread| thread.join().unwrap()).collect()
            });
            assert!(
                made.iter().all(Result::is_ok),
                "{:?}",
                made.iter().find_map(|m| m.as_ref().err())
            );
        }
    }

    #[test]
    fn folder_that_is_a_file_is_refused() {
        let folder = scratch("file");
        fs::write(folder.join("out"), b"mine").unwrap();
        for path in [folder.join("out"), folder.join("out/deeper")] {
            let error = OutputFolder::create(&path, &[]).err().unwrap();
            assert!(matches!(&error, FileError::NotAFolder { .. }), "{error}");
            let message = format!(
                "{}: expected a folder to write to, found a file",
                folder.join("out").display()
            );
            assert_eq!(error.to_string(), message);
        }
        assert_eq!(fs::read(folder.join("out")).unwrap(), b"mine");
    }

    #[test]
    fn inputs_are_not_overwritten() {
        let folder = scratch("input");
        let input = folder.join("summary.json");
        fs::write(&input, b"mine").unwrap();
        let roundabout = folder.join(".").join("summary.json");
        let mut output = OutputFolder::create(&folder, &[roundabout]).unwrap();
        let error = output.write("summary.json", b"new").unwrap_err();
        assert!(matches!(error, FileError::IsInput { .. }));
        output.write("other.json", b"new").unwrap();
        drop(output);
        assert_eq!(names(&folder), ["summary.json"]);
        assert_eq!(fs::read(&input).unwrap(), b"mine");
    }

    #[test]
    fn target_that_is_a_folder_is_refused() {
        let folder = scratch("target");
        fs::create_dir(folder.join("history.csv")).unwrap();
        let mut output = OutputFolder::create(&folder, &[]).unwrap();
        let error = output.write("history.csv", b"x").unwrap_err();
        assert!(matches!(error, FileError::IsFolder { .. }));
        assert!(matches!(write_whole(&folder, b"x"), Err(FileError::IsFolder { .. })));
        drop(output);
        assert_eq!(names(&folder), ["history.csv"]);
    }

    /// A file system that takes no files, whoever asks.
    #[cfg(target_os = "linux")]
    #[test]
    fn folder_that_cannot_be_written_is_refused() {
        let error = OutputFolder::create(Path::new("/proc/slipstick/out"), &[]).err().unwrap();
        assert!(matches!(&error, FileError::Write { .. }), "{error}");
        assert!(error.to_string().starts_with("/proc/slipstick: cannot be written: "), "{error}");
        assert!(write_whole(Path::new("/proc/slipstick.txt"), b"x").is_err());
    }
}
