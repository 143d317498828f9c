//! What is told of many runs: histories over a suite, spectra, derivatives, incremental dynamic
//! analysis, fragility, design.
//!
//! Each result is laid out once, as a [`Sheet`]: tables, figures, notes and JSON, from which the
//! printed text, `result.json` and `report.html` come.

pub mod answer;
pub mod design;
pub mod fragility;
pub mod histories;
pub mod ida;
pub mod key;
pub(crate) mod lines;
pub(crate) mod pairs;
pub mod sensitivity;
pub(crate) mod sheet;
pub mod spectrum;

pub use crate::report::Provenance;
pub use sheet::{Sheet, SheetTable};
