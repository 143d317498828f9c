//! Small arrays that fill a vector register, and sums over them in a fixed order.
//!
//! Every operation rounds as IEEE 754 says, none is fused with another, and each sum has one order:
//! so every instruction set gives the same bits.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

/// Samples in a block.
pub(super) const BLOCK: usize = 8;

/// A state `s, ṡ, η, η̇`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Four(pub(super) [f64; 4]);

/// One number for each sample of a block, or for each tracked quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Eight(pub(super) [f64; 8]);

impl Four {
    pub(super) const ZERO: Self = Self([0.0; 4]);

    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S) -> f64x4<S> {
        f64x4::load_array_ref(simd, &self.0)
    }
}

impl Eight {
    pub(super) const ZERO: Self = Self([0.0; 8]);

    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S) -> f64x8<S> {
        f64x8::load_array_ref(simd, &self.0)
    }
}

/// The same number four times.
#[inline(always)]
pub(super) fn four<S: Simd>(simd: S, x: f64) -> f64x4<S> {
    f64x4::splat(simd, x)
}

/// The same number eight times.
#[inline(always)]
pub(super) fn eight<S: Simd>(simd: S, x: f64) -> f64x8<S> {
    f64x8::splat(simd, x)
}

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

/// The sum of `columns[j] x[j]`.
#[inline(always)]
pub(super) fn combine8<S: Simd>(simd: S, c: &[Eight; 4], x: [f64; 4]) -> f64x8<S> {
    (times8(simd, &c[0], x[0]) + times8(simd, &c[1], x[1]))
        + (times8(simd, &c[2], x[2]) + times8(simd, &c[3], x[3]))
}

/// The larger lane by lane; the first where they cannot be compared.
#[inline(always)]
pub(super) fn larger<S: Simd>(a: f64x8<S>, b: f64x8<S>) -> f64x8<S> {
    b.simd_gt(a).select(b, a)
}

/// The larger lane by lane; the first where they cannot be compared.
#[inline(always)]
pub(super) fn larger4<S: Simd>(a: f64x4<S>, b: f64x4<S>) -> f64x4<S> {
    b.simd_gt(a).select(b, a)
}

/// The smaller; the first where they cannot be compared.
#[inline(always)]
pub(super) fn least(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The larger; the first where they cannot be compared.
#[inline(always)]
pub(super) fn greatest(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
