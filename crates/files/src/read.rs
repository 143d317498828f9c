//! Whole files in, or one clear error.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use slipstick::error::InputError;
use slipstick::input::{self, Override};

use crate::error::FileError;

/// Largest file that is read: 1 GiB, ten bytes for each sample that a motion may have.
pub const MAX_BYTES: u64 = 1 << 30;

/// The whole content of a file.
///
/// # Errors
/// As [`read_at_most`], with [`MAX_BYTES`].
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    read_at_most(path, MAX_BYTES)
}

/// The whole content of a file of at most `limit` bytes.
///
/// # Errors
/// [`FileError`] where it does not exist, is a folder, cannot be read, or is larger.
pub fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let failed = |source: io::Error| match source.kind() {
        io::ErrorKind::IsADirectory => FileError::IsFolder { path: path.to_owned() },
        _ => FileError::Read { path: path.to_owned(), source },
    };
    let file = fs::File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    if metadata.is_dir() {
        return Err(FileError::IsFolder { path: path.to_owned() });
    }
    let too_large = || FileError::TooLarge { path: path.to_owned(), limit };
    if metadata.len() > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    // A pipe or a growing file has no length to go by.
    file.take(limit + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limit {
        return Err(too_large());
    }
    Ok(bytes)
}

/// A path written in a model file, relative to the model's folder; `\` divides as `/` does.
#[must_use]
pub fn resolve(folder: &Path, written: &str) -> PathBuf {
    let as_written = folder.join(written);
    if !written.contains('\\') || as_written.exists() {
        return as_written;
    }
    folder.join(written.replace('\\', "/"))
}

/// The table of modes beside a model file, where that names one: what is read in its place.
///
/// # Errors
/// [`InputError`] at the path of a table that cannot be read.
pub fn modes_beside(path: &Path, name: &str, bytes: &[u8]) -> Result<Option<Override>, InputError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let text = String::from_utf8_lossy(bytes);
    input::modes_beside(name, &text, |written| {
        let path = resolve(folder, written);
        let table = read_at_most(&path, input::MAX_TEXT_BYTES as u64)?;
        Ok::<_, FileError>((
            path.display().to_string(),
            String::from_utf8_lossy(&table).into_owned(),
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_read() {
        let folder = std::env::temp_dir();
        let message = |path: &Path| read_bytes(path).unwrap_err().to_string();
        let end = "expected a file, found a folder";
        assert_eq!(message(&folder), format!("{}: {end}", folder.display()));
        let none = folder.join("slipstick-no-such-file");
        let end = "cannot be read: there is no such file or folder";
        assert_eq!(message(&none), format!("{}: {end}", none.display()));
    }

    #[test]
    fn backslashes_divide() {
        let folder = Path::new("models");
        assert_eq!(resolve(folder, "a/b.txt"), Path::new("models/a/b.txt"));
        assert_eq!(resolve(folder, "a\\b.txt"), Path::new("models/a/b.txt"));
        assert_eq!(resolve(folder, "/a/b.txt"), Path::new("/a/b.txt"));
    }
}
