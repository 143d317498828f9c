//! Measured files and their mappings.

use std::path::Path;

use slipstick::error::InputError;
use slipstick::input::{MAX_TEXT_BYTES, Mapping};
use slipstick::laboratory::measured::{Measured, MeasuredError};

use crate::error::FileError;
use crate::load::SourceFile;
use crate::read::{read_at_most, read_bytes, sha256_hex};

/// Why a measured file is of no use.
#[derive(Debug, thiserror::Error)]
pub enum LaboratoryError {
    /// It cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Its content or its mapping.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// The mapping.
    #[error(transparent)]
    Mapping(#[from] InputError),
}

/// A text file that was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFile {
    /// Its path and hash.
    pub source: SourceFile,
    /// All of it.
    pub text: String,
}

/// Reads a mapping file, if there is one, and the options that add to it.
///
/// # Errors
/// [`LaboratoryError`] where the file cannot be read, and for faults of either.
pub fn read_mapping(
    path: Option<&Path>,
    options: &[String],
) -> Result<(Mapping, Option<TextFile>), LaboratoryError> {
    let Some(path) = path else { return Ok((Mapping::parse(None, options)?, None)) };
    let bytes = read_at_most(path, MAX_TEXT_BYTES as u64)?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let mapping = Mapping::parse(Some((&path.display().to_string(), &text)), options)?;
    let source = SourceFile { path: path.to_owned(), sha256: sha256_hex(&bytes) };
    Ok((mapping, Some(TextFile { source, text })))
}

/// Reads a measured file: text in columns.
///
/// # Errors
/// [`LaboratoryError`] where it cannot be read or understood.
pub fn read_measured(
    path: &Path,
    mapping: &Mapping,
) -> Result<(Measured, SourceFile), LaboratoryError> {
    let bytes = read_bytes(path)?;
    let measured = Measured::read(&path.display().to_string(), &bytes, mapping)?;
    Ok((measured, SourceFile { path: path.to_owned(), sha256: sha256_hex(&bytes) }))
}
