//! What engineers ask of many runs: fractiles, incremental dynamic analysis, fragility, design.
//!
//! Statistics on results, and searches that say which runs they need next; the runs themselves are
//! the caller's, so that threads, files and progress stay where they belong. Results are demands in
//! SI; intensities are in the unit of their measure.

pub mod censored;
pub mod design;
pub mod distribution;
pub mod fractile;
pub mod fragility;
pub mod ida;
pub mod proportion;
pub mod sensitivity;
pub mod spectrum;
#[cfg(test)]
mod tests;
