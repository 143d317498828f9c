//! Largest accelerations of a motion over windows of its samples, looked through once.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use crate::linear::lanes::greatest;
use crate::linear::{BATCH, QUIET};

/// What bounds a motion over some samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    /// Largest `|Ü|`.
    pub(super) size: f64,
    /// Largest change of `Ü` from one sample to the next.
    pub(super) change: f64,
}

/// Extents of all batches of a motion.
#[derive(Debug)]
pub(super) struct Windows {
    /// Over the samples and intervals that begin in each eight, with zeros after the last.
    eights: Vec<Extent>,
}

/// Eights that many samples touch, wherever in the first one they begin.
const TOUCHED: usize = QUIET / BATCH + 1;

impl Windows {
    #[inline(never)]
    pub(super) fn new<S: Simd>(simd: S, table: &[f64]) -> Self {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::InstructionSet;
    use crate::numerics::instructions::vectorize;

    /// At every sample the extents are at least those of the samples from there on, and no more than those of
    /// the eights that these touch.
    #[test]
    fn extents_of_every_window() {
        let mut x = 1_u32;
        let table: Vec<f64> = (0..203)
            .map(|_| {
                x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(x >> 8) - 8e6
            })
            .collect();
        let windows = vectorize!(InstructionSet::best(), simd => Windows::new(simd, &table));
        let largest = |from: usize, to: usize| {
            let of = &table[from..(to + 1).min(table.len())];
            let size = of.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
            let change = of.windows(2).fold(0.0, |most: f64, a| most.max((a[1] - a[0]).abs()));
            [size, change]
        };
        for sample in 0..table.len() - 1 {
            let ways = [(windows.batch(sample), BATCH), (windows.many(sample), QUIET)];
            for (Extent { size, change }, samples) in ways {
                let from = sample / BATCH * BATCH;
                let (least, most) =
                    (largest(sample, sample + samples), largest(from, from + samples + BATCH));
                assert!(least[0] <= size && size <= most[0], "{sample} {samples}");
                assert!(least[1] <= change && change <= most[1], "{sample} {samples}");
            }
        }
    }
}
