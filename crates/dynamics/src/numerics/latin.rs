//! Latin hypercubes: every coordinate takes each of `n` equal intervals once.

use super::hash::Stream;

/// Rounds of the permutation's network.
const ROUNDS: u64 = 8;

/// The place of an index in a random order of `0..count`.
///
/// A balanced Feistel network over the smallest square power of two that holds the count, walked
/// along its cycle until it comes back below the count (Black and Rogaway 2002): a permutation that
/// is stored nowhere.
fn place(index: u64, count: u64, random: Stream) -> u64 {
    let bits = (64 - (count - 1).leading_zeros()).div_ceil(2).max(1);
    let mask = (1_u64 << bits) - 1;
    let mut at = index;
    loop {
        let (mut left, mut right) = (at >> bits, at & mask);
        for round in 0..ROUNDS {
            let mixed = random.word(round << 32 | right) >> 32 & mask;
            (left, right) = (right, left ^ mixed);
        }
        at = left << bits | right;
        if at < count {
            return at;
        }
    }
}

/// The coordinate of a sample, in the open unit interval: somewhere in its own interval.
pub fn coordinate(index: u64, count: u64, order: Stream, jitter: Stream) -> f64 {
    // 24 bits of place in the interval: with an index below 2²⁷ the sum is exact.
    let within = ((jitter.word(index) >> 40) as f64 + 0.5) / f64::from(1 << 24);
    (place(index, count, order) as f64 + within) / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As many as a study may have.
    const MOST: u64 = 100_000_000;

    #[test]
    fn each_interval_is_taken_once() {
        for count in [1, 2, 3, 5, 16, 17, 100, 1000, 4097] {
            let mut seen = vec![false; count as usize];
            for index in 0..count {
                let u = coordinate(index, count, Stream::new(7, 1, 0), Stream::new(7, 2, 0));
                assert!(0.0 < u && u < 1.0);
                let interval = (u * count as f64) as usize;
                assert!(!seen[interval], "{count}: interval {interval} twice");
                seen[interval] = true;
            }
        }
    }

    #[test]
    fn largest_hypercube_stays_inside() {
        for index in [0, 1, MOST / 2, MOST - 1] {
            let u = coordinate(index, MOST, Stream::new(1, 1, 5), Stream::new(1, 2, 5));
            assert!(0.0 < u && u < 1.0);
        }
    }

    /// Two dimensions are in independent orders: the correlation of 2000 samples is below five of
    /// its standard deviations.
    #[test]
    fn prop_dimensions_are_independent() {
        let of = |dimension: u64| -> Vec<f64> {
            let (order, jitter) = (Stream::new(3, 1, dimension), Stream::new(3, 2, dimension));
            (0..2000).map(|index| coordinate(index, 2000, order, jitter) - 0.5).collect()
        };
        let all: Vec<_> = (0..6).map(of).collect();
        for (i, x) in all.iter().enumerate() {
            for y in all.iter().skip(i + 1) {
                let dot: f64 = x.iter().zip(y).map(|(x, y)| 12.0 * x * y).sum::<f64>() / 2000.0;
                assert!(dot.abs() < 5.0 / libm::sqrt(2000.0), "{dot}");
            }
        }
    }
}
