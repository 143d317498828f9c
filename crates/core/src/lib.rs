//! Exact stick–slip response of structures on sliding bearings.
//!
//! A rigid block lies on a moving table, held by Coulomb friction with different static and
//! kinetic coefficients, perhaps a spring and a damper; on it stands a linear structure of any
//! number of storeys. Between two stick/slip events that system is linear, so its motion under a
//! piecewise-linear table acceleration is computed exactly; the events are located, not stepped
//! over. Every response can be judged by a method that shares nothing with the solver.
//!
//! ```
//! use slipstick::check::check;
//! use slipstick::model::Model;
//! use slipstick::motion::GroundMotion;
//! use slipstick::solver;
//!
//! // A machine of 30 t on pendulum sliders, its upper part swaying at 2 Hz.
//! let model = Model::builder()
//!     .block("18 t")
//!     .friction(0.06, 0.05)
//!     .radius("2.2 m")
//!     .gap("300 mm")
//!     .oscillator("12 t", "2 Hz", 0.02)
//!     .build()?;
//!
//! // Ten seconds of table acceleration in m/s², every 10 ms.
//! let samples = (0..1000).map(|k| 2.5 * (0.05 * f64::from(k)).sin()).collect();
//! let motion = GroundMotion::evenly_spaced(0.01, samples, None)?.with_tail(5.0)?;
//!
//! let response = solver::exact(&model, &motion)?;
//! let demands = &response.demands;
//! assert!(demands.slip_count > 0 && demands.gap_ratio < Some(1.0));
//! println!("{:.1} mm", 1e3 * demands.peak_sliding_displacement_m);
//!
//! assert!(check(&model, &motion, &response).holds());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Where to look
//!
//! | for | see |
//! |---|---|
//! | a model: by builder, in SI, from the text of a model file | [`model`], [`input`] |
//! | a ground motion: samples, made motions, spectra, intensity measures, processing | [`motion`] |
//! | records of strong-motion networks, from bytes | [`record`] |
//! | one analysis; the same model or motion many times | [`solver`] |
//! | what comes of it: demands, events, histories | [`response`] |
//! | what to know of a result or a record, and how grave it is | [`notice`] |
//! | the certificate of an answer | [`check`] |
//! | one model over many records, levels and designs | [`study`] |
//! | incremental dynamic analysis, fragility, design, suites | [`assessment`] |
//! | measured tests: comparison and identification | [`laboratory`] |
//! | the slider: friction, springs and pendulums, stops, surfaces in series | [`slider`] |
//! | units, tables, errors, stopping long work | [`units`], [`table`], [`error`], [`progress`] |
//!
//! # Conventions
//!
//! Everything here is SI and `f64`, and names end in their unit. The library opens no files, reads no
//! clock, prints nothing and starts no threads but with the feature `parallel`; it builds for
//! WebAssembly and gives the same bits there. Equation numbers in the documentation are those of the
//! paper the model comes from; the book's chapter "Theory" restates them.
//!
//! Signs: the *sliding displacement* is that of the block minus that of the table, positive
//! towards +x; storey displacements are relative to the block; the friction force `T` is that of
//! the table on the block.

pub mod assessment;
pub mod hash;
pub mod input;
pub mod laboratory;
pub mod requests;
pub mod study;

pub use slipstick_dynamics::{
    check, error, model, motion, notice, progress, response, slider, solver, table, units,
};
pub use slipstick_records as record;

use slipstick_dynamics::numerics;
