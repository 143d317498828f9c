//! Propagators and modes.

mod frame;

pub use frame::shear_frame_frequencies;
