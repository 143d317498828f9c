//! Files that are not what they would be run as.

use std::path::Path;

use slipstick::input::loaded::Loaded;
use slipstick::input::unfit;

use crate::error::FileError;
use crate::load::LoadedMotion;

/// As [`unfit::refuse_unfit`], of files.
pub(crate) fn refuse_unfit(
    records: &[(&Path, &LoadedMotion)],
    channel_asked: bool,
    pairs: bool,
) -> Result<Vec<String>, FileError> {
    let named: Vec<(String, &Loaded)> =
        records.iter().map(|(path, read)| (path.display().to_string(), &read.loaded)).collect();
    unfit::refuse_unfit(&named, channel_asked, pairs).map_err(|error| FileError::Unfit {
        path: records[error.place].0.to_owned(),
        expected: error.expected,
        found: error.found,
    })
}
