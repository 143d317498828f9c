//! The command as a person meets it: what it accepts, writes, refuses and leaves behind.
// Helpers of tests may panic as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod accepted;
mod assessment;
mod cases;
mod codes;
mod endings;
mod field;
mod files;
mod fragility;
mod histories;
mod json;
mod laboratory;
mod options;
mod paper;
mod plane;
mod readme;
mod record;
mod records;
mod refused;
mod structure;
mod studies;
mod support;
