//! Exact stick–slip response of structures on sliding bearings.
//!
//! A rigid block lies on a moving table, held by Coulomb friction with different static and
//! kinetic coefficients, perhaps a spring and a damper; on it stands a linear structure of any
//! number of storeys. Between two stick/slip events that system is linear, so its motion under a
//! piecewise-linear table acceleration is computed exactly; the events are located, not stepped
//! over.
//!
//! Everything here is SI and `f64`. The library opens no files, reads no clock and prints nothing.
//! Equation numbers in the documentation are those of the paper the model comes from; the book's
//! chapter "Theory" restates them.
//!
//! Signs: the *sliding displacement* is that of the block minus that of the table, positive
//! towards +x; storey displacements are relative to the block; the friction force `T` is that of
//! the table on the block.

pub mod assessment;
pub mod check;
pub mod error;
pub mod friction;
pub mod input;
pub mod laboratory;
pub mod linear;
pub mod model;
pub mod motion;
pub mod numerics;
pub mod progress;
pub mod record;
pub mod response;
pub mod solver;
pub mod study;
pub mod table;
pub mod units;
