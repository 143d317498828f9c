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

/// Five numbers of which four stand side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Five {
    pub(super) four: Four,
    pub(super) fifth: f64,
}

impl Five {
    pub(super) const ZERO: Self = Self { four: Four::ZERO, fifth: 0.0 };

    pub(super) fn new(list: [f64; 5]) -> Self {
        let [a, b, c, d, fifth] = list;
        Self { four: Four([a, b, c, d]), fifth }
    }

    /// Times a number.
    #[inline(always)]
    pub(super) fn times<S: Simd>(&self, simd: S, x: f64) -> Abreast<S> {
        Abreast { four: times4(simd, &self.four, x), fifth: self.fifth * x }
    }

    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S) -> Abreast<S> {
        Abreast { four: self.four.load(simd), fifth: self.fifth }
    }
}

/// Five numbers that stay in registers.
#[derive(Clone, Copy)]
pub(super) struct Abreast<S: Simd> {
    pub(super) four: f64x4<S>,
    pub(super) fifth: f64,
}

impl<S: Simd> Abreast<S> {
    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        Self { four: self.four + other.four, fifth: self.fifth + other.fifth }
    }

    #[inline(always)]
    pub(super) fn less(self, other: Self) -> Self {
        Self { four: self.four - other.four, fifth: self.fifth - other.fifth }
    }

    #[inline(always)]
    pub(super) fn times(self, simd: S, x: f64) -> Self {
        Self { four: self.four * four(simd, x), fifth: self.fifth * x }
    }

    /// The larger sizes of two.
    #[inline(always)]
    pub(super) fn larger_size(self, other: Self) -> Self {
        let four = larger4(self.four.abs(), other.four.abs());
        Self { four, fifth: greatest(self.fifth.abs(), other.fifth.abs()) }
    }

    /// Whether all are at most others.
    #[inline(always)]
    pub(super) fn is_within(self, most: Self) -> bool {
        self.four.simd_le(most.four).all_true() && self.fifth <= most.fifth
    }

    /// A bit for each that is at most another.
    #[inline(always)]
    pub(super) fn within(self, most: Self) -> u64 {
        self.four.simd_le(most.four).to_bitmask() | u64::from(self.fifth <= most.fifth) << 4
    }

    #[inline(always)]
    pub(super) fn to_array(self) -> [f64; 5] {
        let [a, b, c, d] = self.four.to_array();
        [a, b, c, d, self.fifth]
    }
}

/// The larger lane by lane; the first where they cannot be compared.
#[inline(always)]
pub(super) fn larger4<S: Simd>(a: f64x4<S>, b: f64x4<S>) -> f64x4<S> {
    b.simd_gt(a).select(b, a)
}
