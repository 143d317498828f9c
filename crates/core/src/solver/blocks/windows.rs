//! Largest accelerations and rates in windows of a motion, looked through once.

use super::lanes::BLOCK;
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
        let a = motion.horizontal_m_per_s2();
        let over_dt = dt_s.map_or(0.0, |dt_s| 1.0 / dt_s);
        let chunks = a.len().div_ceil(BLOCK);
        // Largest over the samples and intervals that begin in a chunk.
        let mut sizes = Vec::with_capacity(chunks);
        for from in (0..a.len()).step_by(BLOCK) {
            let (mut size, mut rate) = (0.0_f64, 0.0_f64);
            for i in from..a.len().min(from + BLOCK) {
                size = size.max(a[i].abs());
                if let Some(next) = a.get(i + 1) {
                    rate = rate.max((next - a[i]).abs());
                }
            }
            sizes.push([size, rate * over_dt]);
        }
        // From the last of eight samples a block ends at the last sample of the next chunk, and a
        // stretch of quiet stick at that of the fourth.
        let over = |from: usize, chunks: usize, which: usize| {
            sizes[from..sizes.len().min(from + chunks)]
                .iter()
                .fold(0.0_f64, |largest, x| largest.max(x[which]))
        };
        let largest = (0..chunks)
            .map(|c| Window {
                block: over(c, 2, 0),
                quiet: over(c, 1 + QUIET / BLOCK, 0),
                rate: over(c, 2, 1),
            })
            .collect();
        Self { dt_s, largest }
    }

    /// The window of the blocks that begin at a sample.
    #[inline(always)]
    pub(super) fn at(&self, sample: usize) -> Window {
        self.largest[sample / BLOCK]
    }
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
