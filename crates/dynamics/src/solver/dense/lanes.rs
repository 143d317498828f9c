//! Sums of a known number of columns, which the compiler unrolls.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

pub(super) use crate::linear::BATCH;
pub(super) use crate::linear::lanes::{Eight, Four, eight, four, greatest, larger, least};

/// A column times a number.
#[inline(always)]
pub(super) fn times4<S: Simd>(simd: S, column: &Four, x: f64) -> f64x4<S> {
    column.load(simd) * four(simd, x)
}

/// A column times a number.
#[inline(always)]
pub(super) fn times8<S: Simd>(simd: S, column: &Eight, x: f64) -> f64x8<S> {
    column.load(simd) * eight(simd, x)
}

/// The sum of `columns[j] x[j]`.
#[inline(always)]
pub(super) fn combine4<S: Simd>(simd: S, c: &[Four; 4], x: f64x4<S>) -> f64x4<S> {
    let x = x.to_array();
    (times4(simd, &c[0], x[0]) + times4(simd, &c[1], x[1]))
        + (times4(simd, &c[2], x[2]) + times4(simd, &c[3], x[3]))
}

/// The part of that which is the storey's.
#[inline(always)]
pub(super) fn of_storey4<S: Simd>(simd: S, c: &[Four; 4], x: f64x4<S>) -> f64x4<S> {
    let [_, _, eta, rate] = x.to_array();
    times4(simd, &c[2], eta) + times4(simd, &c[3], rate)
}

/// The sum of `columns[j] x[j]`.
#[inline(always)]
pub(super) fn combine8<S: Simd>(simd: S, c: &[Eight; 4], x: [f64; 4]) -> f64x8<S> {
    (times8(simd, &c[0], x[0]) + times8(simd, &c[1], x[1]))
        + (times8(simd, &c[2], x[2]) + times8(simd, &c[3], x[3]))
}

/// The larger lane by lane; the first where they cannot be compared.
#[inline(always)]
pub(super) fn larger4<S: Simd>(a: f64x4<S>, b: f64x4<S>) -> f64x4<S> {
    b.simd_gt(a).select(b, a)
}
