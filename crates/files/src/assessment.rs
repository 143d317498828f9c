//! Analyses over a suite of records: the runs behind spectra, incremental dynamic analyses, fragilities
//! and designs, and the tables that are written of them.

mod axis;
mod columns;
mod design;
mod fragility;
mod ida;
mod models;
mod spectrum;
mod suite;
mod table;
mod threads;

pub use axis::{Axis, Grid, levels};
pub use design::{DesignRequest, DesignRun, run_design};
pub use fragility::{FitTo, FragilityRequest, FragilityRun, run_fragility};
pub use ida::{IdaLevels, IdaRequest, IdaRun, run_ida};
pub use models::Models;
pub use spectrum::{SpectrumRequest, SpectrumRun, run_spectrum};
pub use suite::{Scaling, Suite, SuiteRequest};
pub use table::Table;
pub use threads::on_threads;

use std::path::PathBuf;

use slipstick::error::{FitError, InputError, MotionError};

use crate::error::FileError;

/// What ends an analysis over a suite.
#[derive(Debug, thiserror::Error)]
pub enum AssessmentError {
    /// The model; the error points into its text.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// An option: which, what was expected, what was found.
    #[error("{option}: expected {expected}, found {found}{}", hint(nearest.as_deref()))]
    Option {
        /// The option.
        option: String,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
        /// The word that was probably meant.
        nearest: Option<String>,
    },
    /// A table that lacks what is needed, or a cell of it that cannot be read.
    #[error("{}:{line}:{column}: expected {expected}, found {found}", path.display())]
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
    /// Data from which a statistic cannot be told.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The same of a fragility, with the unit of its intensities.
    #[error("{error}{}", in_unit(unit))]
    Fragility {
        /// Why it cannot be told.
        error: FitError,
        /// Unit of the intensities in the message; empty where it is not known.
        unit: String,
    },
    /// A motion that cannot be made or scaled.
    #[error(transparent)]
    Motion(#[from] MotionError),
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |nearest| format!("; nearest is \"{nearest}\""))
}

fn in_unit(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" (intensities in {unit})") }
}

/// The error of an option.
pub(crate) fn refuse(
    option: &str,
    expected: impl Into<String>,
    found: impl Into<String>,
) -> AssessmentError {
    AssessmentError::Option {
        option: option.to_owned(),
        expected: expected.into(),
        found: found.into(),
        nearest: None,
    }
}
