//! Random numbers that are looked up, not drawn in turn: each follows from its own coordinates.
//!
//! A sample must not depend on those before it, so that any part of a study can be computed alone.
//! The numbers are SplitMix64's output function (Steele, Lea and Flood 2014, with the constants of
//! Stafford's variant 13) of a key and a counter, both mixed.

use super::random::{GOLDEN, mix};

/// A stream of random words, each with a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stream(u64);

impl Stream {
    /// The stream of a seed for one purpose and one dimension.
    pub const fn new(seed: u64, purpose: u64, dimension: u64) -> Self {
        let key = mix(seed.wrapping_add(GOLDEN));
        let key = mix(key ^ mix(purpose.wrapping_add(GOLDEN)));
        Self(mix(key ^ mix(dimension.wrapping_add(GOLDEN))))
    }

    /// The word of a number.
    pub const fn word(self, number: u64) -> u64 {
        mix(self.0.wrapping_add(mix(number.wrapping_add(GOLDEN))))
    }
}

/// The middle of one of 2⁵² equal cells of (0, 1): never an end, and 1 minus it is exact.
pub(super) fn unit(top_bits: u64) -> f64 {
    ((top_bits >> 12) as f64 + 0.5) * (1.0 / (1_u64 << 52) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_interval_is_open() {
        assert_eq!(unit(0), 1.0 / (1_u64 << 53) as f64);
        assert_eq!(1.0 - unit(u64::MAX), 1.0 / (1_u64 << 53) as f64);
    }

    /// Each bit of words of neighbouring numbers, dimensions and seeds is one half of the time 1:
    /// within five standard deviations of 4096 throws.
    #[test]
    fn prop_bits_are_fair_and_streams_differ() {
        let words = |dimension, seed| {
            let stream = Stream::new(seed, 3, dimension);
            (0..4096).map(move |number| stream.word(number))
        };
        for bit in 0..64 {
            let ones = words(0, 1).filter(|word| word >> bit & 1 == 1).count();
            assert!((ones as f64 - 2048.0).abs() < 160.0, "bit {bit}: {ones}");
            let same = words(0, 1).zip(words(1, 1)).filter(|(a, b)| (a ^ b) >> bit & 1 == 0);
            assert!((same.count() as f64 - 2048.0).abs() < 160.0, "dimensions, bit {bit}");
            let same = words(0, 1).zip(words(0, 2)).filter(|(a, b)| (a ^ b) >> bit & 1 == 0);
            assert!((same.count() as f64 - 2048.0).abs() < 160.0, "seeds, bit {bit}");
        }
    }
}
