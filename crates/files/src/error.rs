//! What can go wrong with files.

use std::io;
use std::path::{Path, PathBuf};

use slipstick::error::{MotionError, RecordError, RecordWriteError, visible};

/// A file that cannot be read, understood or written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// Nothing there, or nothing that may be read.
    #[error("{}: cannot be read: {}", shown(path), reason(source))]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A folder where a file was expected.
    #[error("{}: expected a file, found a folder", shown(path))]
    IsFolder {
        /// The folder.
        path: PathBuf,
    },
    /// Nothing of that name, and nothing that a pattern meets.
    #[error(
        "{}: expected a file, a folder or a pattern that meets files, found nothing",
        shown(pattern)
    )]
    NoMatch {
        /// What was looked for.
        pattern: PathBuf,
    },
    /// A file larger than any record.
    #[error("{}: expected at most {limit} bytes, found more", shown(path))]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The limit.
        limit: u64,
    },
    /// Content that is no record.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// Several channels, or none of the name that was asked for.
    #[error("{}: expected {expected} (channels: {})", shown(path), visible(channels))]
    Channel {
        /// The record.
        path: PathBuf,
        /// What was expected.
        expected: String,
        /// Names of its channels.
        channels: String,
    },
    /// Samples that are no ground motion.
    #[error("{}: {source}", shown(path))]
    Motion {
        /// The record.
        path: PathBuf,
        /// Why.
        source: MotionError,
    },
    /// A record that cannot be what it is to be run as.
    #[error("{}: expected {expected}, found {found}", shown(path))]
    Unfit {
        /// The record.
        path: PathBuf,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
    /// A step of processing that has no answer for a channel.
    #[error("{}: {step}: {source}", shown(path))]
    Processing {
        /// The record.
        path: PathBuf,
        /// The step in words.
        step: String,
        /// Why.
        source: MotionError,
    },
    /// A channel that a format cannot hold.
    #[error("{}: {source}", shown(path))]
    Unwritable {
        /// The record.
        path: PathBuf,
        /// Why.
        source: RecordWriteError,
    },
    /// Content that is no table in Parquet, or not the one that was expected.
    #[error("{}: expected a Parquet file: {reason}", shown(path))]
    Table {
        /// The file.
        path: PathBuf,
        /// What the library says.
        reason: String,
    },
    /// A cell of a table in text that is not what it must be.
    #[error("{}:{line}:{column}: expected {expected}, found {found}", shown(path))]
    Cell {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
    /// A result that cannot be written.
    #[error("{}: cannot be written: {}", shown(path), reason(source))]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// An output folder that is a file.
    #[error("{}: expected a folder to write to, found a file", shown(path))]
    NotAFolder {
        /// The file.
        path: PathBuf,
    },
    /// An output that would replace an input.
    #[error("{}: is an input of this analysis and is not overwritten", shown(path))]
    IsInput {
        /// The file.
        path: PathBuf,
    },
}

/// A path as messages show it.
pub(crate) fn shown(path: &Path) -> String {
    visible(&path.display().to_string())
}

/// The reason in words, without the number of the system's error.
pub(crate) fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file or folder".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::StorageFull => "no space left on the device".to_owned(),
        io::ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_owned(),
        _ => {
            let text = error.to_string();
            let number = text.find(" (os error");
            text[..number.unwrap_or(text.len())].to_owned()
        }
    }
}
