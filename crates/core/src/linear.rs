//! The linear system between two events: modes, Taylor series, propagators, polynomials.
//!
//! In stick and in slip the equations of motion (9)–(12) are affine with a load that is linear in
//! time. [`System`] holds them in coordinates in which neighbouring storeys couple at most;
//! [`Series`] is the Taylor series of their solution, [`Propagator`] the same solution at the end
//! of a whole sample; [`polynomial`] finds the first root and the extremes of what is made of them.

mod cholesky;
mod frame;
pub mod polynomial;
mod propagator;
mod series;
mod system;

pub use cholesky::cholesky;
pub use frame::{FrameModes, shear_frame_frequencies, shear_frame_modes};
pub use propagator::Propagator;
pub use series::{Load, MAX_RATE_STEP, Series, State};
pub use system::{PerStorey, StoreyDamping, System};
