//! The linear system between two events: modes, Taylor series, maps over samples, polynomials.
//!
//! In stick and in slip the equations of motion (9)–(12) are affine with a load that is linear in
//! time. [`System`] holds them in the structure's fixed-base modes; [`ModalSeries`] is the Taylor series of
//! their solution, [`Maps`] the same solution over eight samples; [`polynomial`] finds the first root
//! and the extremes of what is made of them.

#[cfg(test)]
mod bounds;
mod frame;
pub mod lanes;
mod maps;
pub mod polynomial;
mod series;
mod solution;
mod system;

pub use frame::{FrameModes, shear_frame_frequencies, shear_frame_modes};
pub use maps::{BATCH, Force, Maps, QUIET, Row, UnitResponses, Window};
pub use series::{Load, MAX_RATE_STEP, ModalSeries, fading_part, orders};
pub use solution::IntervalTables;
pub use system::{StoreyDamping, System};
