//! The laboratory: measured histories, how well a prediction meets them, and what they say of a
//! model.
//!
//! Everything here works on slices in SI and on bytes that the caller has read.

pub mod algebra;
pub mod anderson;
pub mod compare;
pub mod cyclic;
pub mod estimate;
pub mod fit;
pub mod fitted;
pub mod free_vibration;
pub mod measured;
pub mod metrics;
pub mod paper;
pub mod quantile;
pub mod random;
pub mod shaking_table;
