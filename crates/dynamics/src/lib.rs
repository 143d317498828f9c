//! The exact motion of structures on sliding bearings, one solve at a time.
//!
//! A rigid block lies on a moving table, held by Coulomb friction with different static and
//! kinetic coefficients, perhaps a spring and a damper; on it stands a linear structure of any
//! number of storeys. Between two stick/slip events that system is linear, so its motion under a
//! piecewise-linear table acceleration is computed exactly; the events are located, not stepped
//! over. Every response can be judged by a method that shares nothing with the solver.
//!
//! This crate has the model, the ground motion, the solver and the check. The crate `slipstick` passes all of it
//! on and adds what is done with it: model files, records, studies, assessments, the laboratory.
//!
//! | for | see |
//! |---|---|
//! | a model: by builder, in SI | [`model`] |
//! | a ground motion: samples, made motions, spectra, intensity measures, processing | [`motion`] |
//! | one analysis; the same model or motion many times | [`solver`] |
//! | what comes of it: demands, events, histories | [`response`] |
//! | what to know of a result or a record, and how grave it is | [`notice`] |
//! | the certificate of an answer | [`check`] |
//! | the slider: friction, springs and pendulums, stops, surfaces in series | [`slider`] |
//! | units, tables, errors, stopping long work | [`units`], [`table`], [`error`], [`progress`] |
//!
//! Everything is SI and `f64`, and names end in their unit. Nothing opens files, reads a clock, prints or starts
//! threads; it builds for WebAssembly and gives the same bits there.

pub mod check;
pub mod error;
mod linear;
pub mod model;
pub mod motion;
pub mod notice;
#[doc(hidden)]
pub mod numerics;
pub mod progress;
pub mod response;
pub mod slider;
pub mod solver;
pub mod table;
pub mod units;
