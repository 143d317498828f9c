//! Files that are not what they would be run as.

use std::borrow::Borrow;
use std::path::Path;

use slipstick::input::loaded::Loaded;
use slipstick::input::unfit;

use crate::error::FileError;

/// As [`unfit::refuse_unfit`], of files.
pub(crate) fn refuse_unfit(
    records: &[(&Path, impl Borrow<Loaded>)],
    channel_asked: bool,
    pairs: bool,
) -> Result<Vec<String>, FileError> {
    let named: Vec<(String, &Loaded)> = records
        .iter()
        .map(|(path, loaded)| (path.display().to_string(), loaded.borrow()))
        .collect();
    unfit::refuse_unfit(&named, channel_asked, pairs).map_err(|error| FileError::Unfit {
        path: records[error.place].0.to_owned(),
        expected: error.expected,
        found: error.found,
    })
}
