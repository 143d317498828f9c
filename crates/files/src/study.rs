//! Studies in files: a plan in, a folder with a table in Parquet parts out.
//!
//! A study's rows are cut into parts of a fixed size that follows from their number; they stand in
//! the folder `parts`, and nothing else. [`run_shard`] computes the parts of one shard that it does not
//! hold yet, each whole or not at all, so that it may be killed and called again at any time.
//! [`conclude`] writes the manifest and the summary beside `parts`; [`merge`] joins folders to one file.

mod merge;
mod open;
mod part;
mod parts;
mod repeat;
mod runs;
mod seal;
mod shard;
mod summary;

pub use merge::{Merged, conclude, merge};
pub use open::{OpenStudy, TARGET, read_target};
pub use part::{Checks, part_rows};
pub use parts::{REPORT as STUDY_REPORT, clear, has_parts, kept_runs};
pub use repeat::quoted;
pub use runs::{files_of_runs, limit_of_ida, model_of_runs, read_runs};
pub use shard::{Shard, ShardOutcome, estimate, run_shard};

use std::path::PathBuf;

use slipstick::error::{InputError, Stopped};

use crate::error::{FileError, shown};

/// What ends a study early.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The plan or the model.
    #[error("{error}")]
    Input {
        /// What is wrong, and where.
        error: Box<InputError>,
        /// The text it points into.
        text: String,
    },
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// A part of another study where one of this study was expected.
    #[error(
        "{}: belongs to another study (another plan, model, record or version): choose another \
         folder, or start anew with --force",
        shown(path)
    )]
    Foreign {
        /// The part.
        path: PathBuf,
    },
    /// A file that is not the part of its name.
    #[error("{}: {reason}: run the study again with --resume, which replaces it", shown(path))]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A file under a name that the study does not give to any part.
    #[error("{}: the study has no such part: remove it", shown(path))]
    Stray {
        /// The file.
        path: PathBuf,
    },
    /// Parts beside the manifest, as earlier versions wrote them.
    #[error(
        "{}: expected the parts of the study in {}, found some beside it, as an earlier version \
         wrote them: move part-*.parquet there, or start anew with --force",
        shown(folder),
        shown(parts)
    )]
    OldLayout {
        /// The folder of the study.
        folder: PathBuf,
        /// Where its parts belong.
        parts: PathBuf,
    },
    /// Folders that do not hold every run.
    #[error("expected the runs 0 to {last}, found none from {missing} on in {folders}")]
    Incomplete {
        /// The last run of the study.
        last: u64,
        /// The first run that is missing.
        missing: u64,
        /// Where they were looked for.
        folders: String,
    },
    /// A run whose certificate does not hold, or that came out differently when run again.
    #[error(
        "run {run} fails its check ({what}); nothing of its part was written. It is reproduced by\n  \
         {repeat}"
    )]
    CheckFailed {
        /// The run.
        run: u64,
        /// What was found.
        what: String,
        /// The command that reproduces it.
        repeat: String,
    },
    /// No such run or shard.
    #[error("expected {expected}, found {found}")]
    OutOfRange {
        /// What was expected.
        expected: String,
        /// What was asked for.
        found: String,
    },
    /// The callback that followed it stopped it.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl StudyError {
    fn input(error: InputError, text: &str) -> Self {
        Self::Input { error: Box::new(error), text: text.to_owned() }
    }
}
