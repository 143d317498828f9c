//! Largest accelerations and rates in windows of a motion, looked through once.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};

use super::lanes::{BLOCK, eight, greatest, larger};
use super::tables::QUIET;
use crate::motion::GroundMotion;
use crate::solver::excitation::regular_step;

/// What blocks need to know of a motion, whatever the model.
#[derive(Clone, Debug)]
pub(in crate::solver) struct Windows {
    /// The step that all but a few intervals have; none where the sampling is uneven.
    pub(in crate::solver) dt_s: Option<f64>,
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
    pub(in crate::solver) fn new(motion: &GroundMotion) -> Self {
        let dt_s = motion.dt_s().or_else(|| regular_step(motion.times_s()).0);
        let (a, over_dt) = (motion.horizontal_m_per_s2(), dt_s.map_or(0.0, |dt_s| 1.0 / dt_s));
        let largest = dispatch!(Level::new(), simd => Self::largest(simd, a, over_dt));
        Self { dt_s, largest }
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
            let of = |from: usize| f64x8::from_slice(simd, &x[from..from + BLOCK]);
            let size = most(core::array::from_fn(|c| of(c * BLOCK).abs()));
            let change = most(core::array::from_fn(|c| (of(c * BLOCK + 1) - of(c * BLOCK)).abs()));
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
    let pair = |a: f64x8<S>, b: f64x8<S>| larger(a.unzip_low(b), a.unzip_high(b));
    let left = pair(pair(x[0], x[1]), pair(x[2], x[3]));
    pair(left, pair(pair(x[4], x[5]), pair(x[6], x[7])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_windows_cover_every_block_and_stretch() {
        let mut x = 1_u32;
        let a: Vec<f64> = (0..203)
            .map(|_| {
                x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(x >> 8) - 8e6
            })
            .collect();
        let motion = GroundMotion::evenly_spaced(0.5, a.clone(), None).expect("a motion");
        let windows = Windows::new(&motion);
        for i in 0..a.len() {
            let window = windows.at(i);
            let to = |n: usize| &a[i..a.len().min(i + n + 1)];
            let size = |a: &[f64]| a.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
            assert!(window.block >= size(to(BLOCK)), "block at {i}");
            assert!(window.quiet >= size(to(QUIET)), "quiet at {i}");
            let rate =
                to(BLOCK).windows(2).fold(0.0_f64, |m, pair| m.max((pair[1] - pair[0]).abs()));
            assert!(window.rate >= rate / 0.5, "rate at {i}");
        }
    }
}
