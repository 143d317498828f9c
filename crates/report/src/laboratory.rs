//! The laboratory's results: comparisons with measurements and identified parameters, as table,
//! JSON and page.

pub mod compare;
pub mod cyclic;
pub mod free_vibration;
pub mod identify;
pub mod shaking_table;
pub(crate) mod text;

pub use compare::CompareReport;
