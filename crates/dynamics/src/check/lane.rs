//! Eight numbers side by side.
//!
//! Lanes never mix, no operation is fused with another and no sum is reordered: every instruction
//! set gives the same bits.

use core::ops::{Add, AddAssign, Mul, Sub};

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

/// One number, or eight side by side.
pub(super) trait Lane:
    Copy
    + AddAssign
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Sub<f64, Output = Self>
{
}

impl Lane for f64 {}
impl<S: Simd> Lane for f64x8<S> {}

/// Knots or intervals side by side.
pub(super) const LANES: usize = 8;

/// One number for each of them.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Eight(pub(super) [f64; LANES]);

impl Eight {
    pub(super) const ZERO: Self = Self([0.0; LANES]);

    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S) -> f64x8<S> {
        f64x8::load_array_ref(simd, &self.0)
    }

    #[inline(always)]
    pub(super) fn store<S: Simd>(&mut self, value: f64x8<S>) {
        self.0 = value.to_array();
    }

    /// The largest.
    pub(super) fn largest(&self) -> f64 {
        self.0.iter().fold(f64::NEG_INFINITY, |most, &x| if x > most { x } else { most })
    }
}

#[inline(always)]
pub(super) fn all<S: Simd>(simd: S, x: f64) -> f64x8<S> {
    f64x8::splat(simd, x)
}

#[inline(always)]
pub(super) fn larger<S: Simd>(a: f64x8<S>, b: f64x8<S>) -> f64x8<S> {
    b.simd_gt(a).select(b, a)
}

#[inline(always)]
pub(super) fn smaller<S: Simd>(a: f64x8<S>, b: f64x8<S>) -> f64x8<S> {
    b.simd_lt(a).select(b, a)
}

/// A closure that is compiled into the loop that calls it, for its instructions.
macro_rules! inlined {
    ($($closure:tt)+) => {
        $crate::check::lane::itself(#[inline(always)] $($closure)+)
    };
}
pub(super) use inlined;

#[inline(always)]
pub(super) fn itself<F>(closure: F) -> F {
    closure
}

/// The values of an expression at 0 and 1.
macro_rules! both {
    (|$i:ident| $value:expr) => {
        [
            {
                let $i = 0_usize;
                $value
            },
            {
                let $i = 1_usize;
                $value
            },
        ]
    };
}
pub(super) use both;

/// Knots of eight lanes: those from one on, or any.
pub(super) struct Places {
    at: [usize; LANES],
    contiguous: bool,
}

impl Places {
    pub(super) fn new(at: [usize; LANES]) -> Self {
        let contiguous = at.iter().enumerate().all(|(lane, &k)| k == at[0] + lane);
        Self { at, contiguous }
    }

    /// The knot of a lane.
    pub(super) fn knot(&self, lane: usize) -> usize {
        self.at[lane]
    }

    /// Entry `i` of `n` of a list knot by knot, `later` knots on.
    #[inline(always)]
    pub(super) fn read<S: Simd>(
        &self,
        simd: S,
        list: &[f64],
        later: usize,
        [n, i]: [usize; 2],
    ) -> f64x8<S> {
        if self.contiguous && n == 1 {
            let from = self.at[0] + later;
            if let Some(part) = list.get(from..from + LANES) {
                return f64x8::from_slice(simd, part);
            }
        }
        let one = |lane: usize| list[(self.at[lane] + later) * n + i];
        f64x8::load_array(simd, core::array::from_fn(one))
    }
}

#[inline(always)]
pub(super) fn keep<S: Simd>(simd: S, worst: &mut Eight, value: f64x8<S>) {
    worst.store(larger(worst.load(simd), value));
}

/// Adds the forces of elements between neighbouring floors; returns the largest single term.
#[inline(always)]
pub(super) fn add_chain<S: Simd>(
    simd: S,
    n: usize,
    (chain, on_block): (&[f64], bool),
    q: &[Eight],
    out: &mut [Eight],
) -> f64x8<S> {
    let (mut below, mut term) = (all(simd, 0.0), all(simd, 0.0));
    for i in 0..n {
        let (k, here) = (all(simd, chain[i]), q[i].load(simd));
        let force = k * (here - below);
        let sum = out[i].load(simd) + force;
        out[i].store(sum);
        term = larger(larger(term, (k * here).abs()), (k * below).abs());
        if on_block {
            continue;
        }
        if i > 0 {
            let sum = out[i - 1].load(simd) - force;
            out[i - 1].store(sum);
        }
        below = here;
    }
    term
}

/// `Σ c (x_i − x_{i−1})²`.
#[inline(always)]
pub(super) fn chain_form<S: Simd>(
    simd: S,
    (chain, on_block): (&[f64], bool),
    x: impl Fn(usize) -> f64x8<S>,
) -> f64x8<S> {
    let (mut below, mut sum) = (all(simd, 0.0), all(simd, 0.0));
    for (i, &c) in chain.iter().enumerate() {
        let here = x(i);
        let over = here - below;
        sum += all(simd, c) * over * over;
        if !on_block {
            below = here;
        }
    }
    sum
}
