//! What is mathematics and no mechanics: distributions, small algebra, fractiles, random numbers and
//! points spread over a cube. The same bits on every machine.

pub mod algebra;
mod cholesky;
mod directions;
pub mod distribution;
pub mod fractile;
mod hash;
pub(crate) mod instructions;
mod latin;
pub mod random;
mod sobol;
mod sort;

pub use cholesky::cholesky;
pub use hash::Stream;
pub use instructions::InstructionSet;
pub use latin::coordinate as latin_coordinate;
pub use sobol::Coordinate;
pub use sobol::{MAX_DIMENSIONS, unit_points};
pub use sort::sort;
