//! The laboratory's work: what tests say of models and models of tests.

pub mod paper;
