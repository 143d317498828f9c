//! The laboratory: measured histories, how well a prediction meets them, and what they say of a
//! model.
//!
//! Everything here works on slices in SI and on bytes that the caller has read.

pub mod anderson;
pub mod compare;
pub mod measured;
pub mod metrics;
