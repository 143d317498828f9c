//! Largest accelerations and rates in windows of a motion, looked through once.

use fearless_simd::{Level, dispatch};

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
        let (a, over_dt) = (motion.horizontal_m_per_s2(), dt_s.map_or(0.0, |dt_s| 1.0 / dt_s));
        // For the lanes of this machine too; the bits are the same on all.
        let largest = dispatch!(Level::new(), _simd => Self::largest(a, over_dt));
        Self { dt_s, largest }
    }

    #[inline(always)]
    fn largest(a: &[f64], over_dt: f64) -> Vec<Window> {
        // Largest over the samples and intervals that begin in a chunk.
        let larger = |a: f64, b: f64| if b > a { b } else { a };
        let most = |x: &[f64; BLOCK]| {
            let pairs =
                [larger(x[0], x[4]), larger(x[1], x[5]), larger(x[2], x[6]), larger(x[3], x[7])];
            larger(larger(pairs[0], pairs[2]), larger(pairs[1], pairs[3]))
        };
        let mut sizes = Vec::with_capacity(a.len().div_ceil(BLOCK) + QUIET / BLOCK);
        for from in (0..a.len()).step_by(BLOCK) {
            let rest = &a[from..];
            let (mut size, mut change) = ([0.0; BLOCK], [0.0; BLOCK]);
            if let Some(x) = rest.first_chunk::<{ BLOCK + 1 }>() {
                for k in 0..BLOCK {
                    (size[k], change[k]) = (x[k].abs(), (x[k + 1] - x[k]).abs());
                }
            } else {
                for (k, x) in rest.iter().enumerate() {
                    size[k] = x.abs();
                    change[k] = rest.get(k + 1).map_or(0.0, |next| (next - x).abs());
                }
            }
            sizes.push([most(&size), most(&change) * over_dt]);
        }
        let chunks = sizes.len();
        sizes.resize(chunks + QUIET / BLOCK, [0.0; 2]);
        // From the last of eight samples a block ends at the last sample of the next chunk, and a
        // stretch of quiet stick at that of the fourth.
        sizes
            .windows(1 + QUIET / BLOCK)
            .map(|s| {
                let block = larger(s[0][0], s[1][0]);
                let quiet = larger(larger(block, s[2][0]), larger(s[3][0], s[4][0]));
                Window { block, quiet, rate: larger(s[0][1], s[1][1]) }
            })
            .collect()
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
