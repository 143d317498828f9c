//! The judge of a plane: the reference cases are its own, and it notices every kind of tampering.

// Helpers of tests may panic as tests do, read what they compare with, and say how close it came.
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_macros,
    clippy::expect_used,
    clippy::unwrap_used
)]

mod cases;
mod drive;
mod tampered;
