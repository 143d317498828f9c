//! The laboratory's results: comparisons with measurements, as table, JSON and page.

pub mod compare;
pub(crate) mod text;

pub use compare::CompareReport;
