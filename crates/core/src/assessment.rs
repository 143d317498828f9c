//! What engineers ask of many runs: histories over a suite, sliding spectra, incremental dynamic
//! analysis, fragility, design.
//!
//! Statistics on results, searches that say which runs they need next, and the runs themselves: the
//! models of a [`grid`], the records of a [`suite`], each run by the [engine](crate::study::engine),
//! which a callback follows and may stop. Nothing here opens a file. Results are demands in SI;
//! intensities are in the SI unit of their measure.

pub mod censored;
pub mod code;
pub mod derivative;
pub mod design;
pub mod floors;
pub mod fragility;
pub mod grid;
pub mod histories;
pub mod ida;
pub mod lateral;
pub mod models;
pub mod observed;
pub mod outline;
pub mod proportion;
pub mod sensitivity;
pub mod single;
pub mod spectrum;
pub mod suite;
pub mod sweep;
#[cfg(test)]
mod tests;

pub use crate::error::ChoiceError;
use crate::error::{CellError, FitError, InputError, MotionError, Stopped};
pub use crate::numerics::fractile::SHARES;
pub use crate::study::FailedRun;

/// What ends an analysis over a suite.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssessmentError {
    /// The model; the error points into its text.
    #[error(transparent)]
    Input(#[from] InputError),
    /// What was asked for cannot be.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// A cell of a table that is not what it must be.
    #[error(transparent)]
    Cell(#[from] CellError),
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
    /// The callback that followed it stopped it.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

fn in_unit(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" (intensities in {unit})") }
}

/// The error of a choice: what was chosen wrongly, what was expected, what was found.
pub(crate) fn refuse(
    what: &str,
    expected: impl Into<String>,
    found: impl Into<String>,
) -> AssessmentError {
    let (expected, found) = (expected.into(), found.into());
    AssessmentError::Choice(ChoiceError { what: what.to_owned(), expected, found, nearest: None })
}
