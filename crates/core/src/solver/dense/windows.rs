//! Largest accelerations and rates in windows of a motion, looked through once.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::lanes::{BLOCK, eight, greatest, larger};
use super::tables::QUIET;

/// What blocks need to know of a motion, whatever the model.
#[derive(Clone, Debug)]
pub(in crate::solver) struct Windows {
    /// For each eighth sample the largest |Ü| at the samples that a block, and a stretch of quiet
    /// stick, from there or from one of the next seven samples touches; and the largest |ΔÜ|/dt
    /// over the intervals of a block.
    largest: Vec<Window>,
}

/// One entry of [`Windows`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Largest |Ü| in a block.
    pub(super) block: f64,
    /// Largest |Ü| in a stretch of quiet stick.
    pub(super) quiet: f64,
    /// Largest |dÜ/dt| in a block.
    pub(super) rate: f64,
}

impl Windows {
    #[inline(never)]
    pub(in crate::solver) fn new<S: Simd>(simd: S, a: &[f64], dt_s: f64) -> Self {
        let over_dt = 1.0 / dt_s;
        let largest = simd.vectorize(
            #[inline(always)]
            || Self::largest(simd, a, over_dt),
        );
        Self { largest }
    }

    #[inline(always)]
    fn largest<S: Simd>(simd: S, a: &[f64], over_dt: f64) -> Vec<Window> {
        // Largest over the samples and intervals that begin in a chunk of eight.
        let chunks = a.len().div_ceil(BLOCK);
        let mut sizes = vec![0.0; chunks + QUIET / BLOCK];
        let mut rates = sizes.clone();
        for chunk in (0..chunks).step_by(BLOCK) {
            let rest = &a[chunk * BLOCK..];
            let mut last = [0.0; BLOCK * BLOCK + 1];
            let x = rest.first_chunk().unwrap_or_else(|| {
                // The last value once more, for no change.
                last.fill(rest[rest.len() - 1]);
                last[..rest.len()].copy_from_slice(rest);
                &last
            });
            let mut sizes_of = [eight(simd, 0.0); BLOCK];
            let mut changes_of = sizes_of;
            for c in 0..BLOCK {
                let at = f64x8::from_slice(simd, &x[c * BLOCK..][..BLOCK]);
                let next = f64x8::from_slice(simd, &x[c * BLOCK + 1..][..BLOCK]);
                sizes_of[c] = at.abs();
                changes_of[c] = (next - at).abs();
            }
            let (size, change) = (most(sizes_of), most(changes_of));
            let rate = change * eight(simd, over_dt);
            let count = BLOCK.min(chunks - chunk);
            sizes[chunk..chunk + count].copy_from_slice(&size.as_array()[..count]);
            rates[chunk..chunk + count].copy_from_slice(&rate.as_array()[..count]);
        }
        // From the last of eight samples a block ends at the last sample of the next chunk, and a
        // stretch of quiet stick at that of the fourth.
        let sizes: [&[f64]; 5] = core::array::from_fn(|k| &sizes[k..k + chunks]);
        let rates: [&[f64]; 2] = core::array::from_fn(|k| &rates[k..k + chunks]);
        let window = |i: usize| {
            let block = greatest(sizes[0][i], sizes[1][i]);
            let next = greatest(sizes[3][i], sizes[4][i]);
            let quiet = greatest(greatest(block, sizes[2][i]), next);
            Window { block, quiet, rate: greatest(rates[0][i], rates[1][i]) }
        };
        (0..chunks).map(window).collect()
    }

    /// The window of the blocks that begin at a sample.
    #[inline(always)]
    pub(super) fn at(&self, sample: usize) -> Window {
        self.largest[sample / BLOCK]
    }
}

/// The largest lane of each of eight vectors.
#[inline(always)]
fn most<S: Simd>(x: [f64x8<S>; BLOCK]) -> f64x8<S> {
    let left = pair(pair(x[0], x[1]), pair(x[2], x[3]));
    pair(left, pair(pair(x[4], x[5]), pair(x[6], x[7])))
}

/// The larger of each two lanes of two vectors.
#[inline(always)]
fn pair<S: Simd>(a: f64x8<S>, b: f64x8<S>) -> f64x8<S> {
    larger(a.unzip_low(b), a.unzip_high(b))
}
