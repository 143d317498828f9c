//! What the tests of this folder share: the plain reference, the cases, random systems.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

pub mod agree;
pub mod bernstein;
pub mod by_modes;
pub mod cases;
pub mod compare;
pub mod dd;
pub mod devices;
pub mod eigen;
pub mod in_plane;
pub mod nasty;
pub mod plain;
pub mod random;
pub mod random_devices;
pub mod random_in_plane;
pub mod sensible;
pub mod sketch;
pub mod system;
pub mod values;
