//! Arrays that fill vector registers, and sums over them in a fixed order.
//!
//! Every operation rounds as IEEE 754 says, none is fused with another, and each sum has one order:
//! so every instruction set gives the same bits.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

/// Four components of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct Four(pub [f64; 4]);

/// One number for each of eight samples, or for each of eight outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Eight(pub [f64; 8]);

impl Four {
    /// Zeros.
    pub const ZERO: Self = Self([0.0; 4]);

    /// The first numbers of a list, zeros beyond its last.
    #[must_use]
    pub fn new(list: &[f64]) -> Self {
        let mut all = Self::ZERO;
        for (x, of_list) in all.0.iter_mut().zip(list) {
            *x = *of_list;
        }
        all
    }

    /// As a vector.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S) -> f64x4<S> {
        f64x4::load_array_ref(simd, &self.0)
    }
}

impl Eight {
    /// Zeros.
    pub const ZERO: Self = Self([0.0; 8]);

    /// As a vector.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S) -> f64x8<S> {
        f64x8::load_array_ref(simd, &self.0)
    }
}

/// A number in four lanes.
#[inline(always)]
pub fn four<S: Simd>(simd: S, x: f64) -> f64x4<S> {
    f64x4::splat(simd, x)
}

/// A number in eight lanes.
#[inline(always)]
pub fn eight<S: Simd>(simd: S, x: f64) -> f64x8<S> {
    f64x8::splat(simd, x)
}

/// The larger lane by lane; the first where they cannot be compared.
#[inline(always)]
pub fn larger<S: Simd>(a: f64x8<S>, b: f64x8<S>) -> f64x8<S> {
    b.simd_gt(a).select(b, a)
}

/// The sum of the lanes.
#[inline(always)]
#[must_use]
pub fn sum_of_lanes<S: Simd>(x: f64x4<S>) -> f64 {
    let [a, b, c, d] = x.to_array();
    (a + b) + (c + d)
}

/// The largest lane.
#[inline(always)]
#[must_use]
pub fn largest_lane<S: Simd>(simd: S, x: f64x8<S>) -> f64 {
    let (a, b) = simd.split_f64x8(x);
    let [a, b, c, d] = b.simd_gt(a).select(b, a).to_array();
    greatest(greatest(a, b), greatest(c, d))
}

/// The larger; the first where they cannot be compared.
#[inline(always)]
#[must_use]
pub fn greatest(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The smaller; the first where they cannot be compared.
#[inline(always)]
#[must_use]
pub fn least(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// Sum of products: four sums side by side, then the rest one by one.
#[inline(always)]
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    if n == 1 {
        return a[0] * b[0];
    }
    let mut sums = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let (rest_a, rest_b) = (fours.remainder(), others.remainder());
    for (a, b) in fours.zip(others) {
        for i in 0..4 {
            sums[i] += a[i] * b[i];
        }
    }
    let mut sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    for (a, b) in rest_a.iter().zip(rest_b) {
        sum += a * b;
    }
    sum
}

/// How many storeys a system has: one at most, which the compiler knows, or any number.
pub trait Width: Copy {
    /// Storey coordinates; a rigid block has one that does nothing.
    fn modes(self) -> usize;

    /// Components of a state, `s, ṡ, η, η̇`.
    #[inline(always)]
    fn components(self) -> usize {
        2 + 2 * self.modes()
    }

    /// Fours that hold a state, zeros at the end.
    #[inline(always)]
    fn fours(self) -> usize {
        self.components().div_ceil(4)
    }
}

/// One storey or none.
#[derive(Clone, Copy, Debug)]
pub struct One;

/// Any number of storeys.
#[derive(Clone, Copy, Debug)]
pub struct Many(pub usize);

impl Width for One {
    #[inline(always)]
    fn modes(self) -> usize {
        1
    }
}

impl Width for Many {
    #[inline(always)]
    fn modes(self) -> usize {
        self.0
    }
}

/// `out = Σ loads[m] a[m] + Σ columns[j] x[j]`, each column a state; what comes late comes last.
///
/// `columns` holds, for each four of components, the columns of the loads and then those of the
/// state one after another. Their numbers are multiples of four but for `singles`, at most four
/// loads that come first.
#[inline(always)]
pub fn combine4<S: Simd>(
    simd: S,
    columns: &[Four],
    singles: &[f64],
    loads: &[f64],
    x: &[f64],
    out: &mut [f64],
) {
    let count = singles.len() + loads.len() + x.len();
    let (loads, x) = (loads.as_chunks::<4>().0, x.as_chunks::<4>().0);
    let mut later = columns;
    for out in out.as_chunks_mut::<4>().0 {
        let (columns, after) = later.split_at(count);
        later = after;
        let (of_singles, rest) = columns.split_at(singles.len());
        let (rest, _) = rest.as_chunks::<4>();
        let (of_loads, of_x) = rest.split_at(loads.len());
        let mut sums = [four(simd, 0.0); 4];
        for j in 0..singles.len() {
            sums[j] = of_singles[j].load(simd) * four(simd, singles[j]);
        }
        add4(simd, &mut sums, of_loads, loads);
        add4(simd, &mut sums, of_x, x);
        ((sums[0] + sums[1]) + (sums[2] + sums[3])).store_slice(out);
    }
}

/// Columns times factors: one number at eight samples, or eight outputs.
#[inline(always)]
pub fn combine8<S: Simd>(
    simd: S,
    columns: &[Eight],
    singles: &[f64],
    loads: &[f64],
    x: &[f64],
) -> f64x8<S> {
    let (of_singles, rest) = columns.split_at(singles.len());
    let (loads, x) = (loads.as_chunks::<4>().0, x.as_chunks::<4>().0);
    let (of_loads, of_x) = rest.as_chunks::<4>().0.split_at(loads.len());
    let mut sums = [eight(simd, 0.0); 2];
    for j in 0..singles.len() {
        sums[j % 2] += of_singles[j].load(simd) * eight(simd, singles[j]);
    }
    add8(simd, &mut sums, of_loads, loads);
    add8(simd, &mut sums, of_x, x);
    sums[0] + sums[1]
}

/// Adds columns times numbers to four sums side by side.
#[inline(always)]
pub fn add4<S: Simd>(simd: S, sums: &mut [f64x4<S>; 4], columns: &[[Four; 4]], x: &[[f64; 4]]) {
    let columns = &columns[..x.len()];
    for k in 0..x.len() {
        for j in 0..4 {
            sums[j] += columns[k][j].load(simd) * four(simd, x[k][j]);
        }
    }
}

#[inline(always)]
fn add8<S: Simd>(simd: S, sums: &mut [f64x8<S>; 2], columns: &[[Eight; 4]], x: &[[f64; 4]]) {
    let columns = &columns[..x.len()];
    for k in 0..x.len() {
        for j in 0..4 {
            sums[j % 2] += columns[k][j].load(simd) * eight(simd, x[k][j]);
        }
    }
}
