//! Largest accelerations of a motion over windows of its samples, looked through once.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::lanes::{BATCH, greatest};
use crate::linear::QUIET;

/// What bounds a motion over some samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    /// Largest `|Ü|`.
    pub(super) size: f64,
    /// Largest change of `Ü` from one sample to the next.
    pub(super) change: f64,
}

/// Those of all batches of a motion.
#[derive(Debug)]
pub(in crate::solver) struct Windows {
    /// Over the samples and intervals that begin in each eight, with zeros after the last.
    eights: Vec<Extent>,
}

/// Eights that many samples touch, wherever in the first one they begin.
const TOUCHED: usize = QUIET / BATCH + 1;

impl Windows {
    #[inline(never)]
    pub(in crate::solver) fn new<S: Simd>(simd: S, table: &[f64]) -> Self {
        let mut eights = Vec::with_capacity(table.len() / BATCH + TOUCHED);
        simd.vectorize(
            #[inline(always)]
            || {
                let mut rest = table;
                while let Some(window) = rest.first_chunk::<{ BATCH + 1 }>() {
                    eights.push(Extent::of(simd, window));
                    rest = &rest[BATCH..];
                }
                // The last value once more, for no change.
                let mut window = [rest[rest.len() - 1]; BATCH + 1];
                window[..rest.len()].copy_from_slice(rest);
                eights.push(Extent::of(simd, &window));
            },
        );
        eights.resize(eights.len() + TOUCHED - 1, Extent::default());
        Self { eights }
    }

    /// Over the batch from a sample.
    #[inline(always)]
    pub(super) fn batch(&self, sample: usize) -> Extent {
        let from = sample / BATCH;
        self.eights[from].and(&self.eights[from + 1])
    }

    /// Over many samples from one.
    #[inline(always)]
    pub(super) fn many(&self, sample: usize) -> Extent {
        let from = sample / BATCH;
        let [a, b, c, d, e] = &self.eights[from..from + TOUCHED] else { return Extent::default() };
        a.and(b).and(&c.and(d)).and(e)
    }
}

impl Extent {
    #[inline(always)]
    fn of<S: Simd>(simd: S, window: &[f64; BATCH + 1]) -> Self {
        let at = f64x8::from_slice(simd, &window[..BATCH]);
        let next = f64x8::from_slice(simd, &window[1..]);
        Self { size: at.abs().reduce_max(), change: (next - at).abs().reduce_max() }
    }

    #[inline(always)]
    fn and(&self, other: &Self) -> Self {
        Self { size: greatest(self.size, other.size), change: greatest(self.change, other.change) }
    }
}
