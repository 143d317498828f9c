//! What is known of samples by the chords between them.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use crate::linear::BATCH;
use crate::linear::lanes::{eight, larger};

/// Samples up to the last before the first that is not clear: both ends of each must be.
#[inline(always)]
pub(super) fn clear_steps(clear: u64, first: bool) -> usize {
    let ends = (clear << 1) | u64::from(first);
    ((!ends).trailing_zeros() as usize).saturating_sub(1).min(BATCH)
}

/// Bound on an output between two values, from how far it may depart from their chord.
#[inline(always)]
pub(super) fn bound_between<S: Simd>(simd: S, [a, b]: [f64x8<S>; 2], slack: f64x8<S>) -> f64x8<S> {
    // An extreme lies inside only where the ends are less than four times the slack apart:
    // |y| ≤ max + (slack − |Δ|/4)² / slack.
    let zero = eight(simd, 0.0);
    let inside = slack - (b - a).abs() * eight(simd, 0.25);
    let bulge = inside.simd_gt(zero).select(inside * (inside / slack), zero);
    larger(a.abs(), b.abs()) + bulge
}
