//! Scrambled Sobol' points.
//!
//! The `i`-th point in Gray-code order (Antonov and Saleev 1979) is the exclusive or of one
//! direction number for each bit of `i ^ (i >> 1)`, so that any point is found without those before
//! it. Scrambling is Owen's (1995), nested and uniform: each binary digit of a coordinate is flipped
//! or not by a random bit that belongs to the digits before it. The points stay a net — every
//! binary box holds its share of them — and each of them is uniform on the unit cube.

use super::directions::{DIMENSIONS, Dimension};
use super::hash::{Stream, unit};

/// Most dimensions that there are directions for.
pub const MAX_DIMENSIONS: usize = DIMENSIONS.len();

/// Binary digits of an unscrambled coordinate: as many as an index may have.
const DIGITS: usize = 32;

/// One coordinate of the points.
#[derive(Clone, Debug)]
pub struct Coordinate {
    directions: [u32; DIGITS],
}

impl Coordinate {
    /// `None` beyond [`MAX_DIMENSIONS`].
    pub fn new(dimension: usize) -> Option<Self> {
        let (polynomial, first) = *DIMENSIONS.get(dimension)?;
        let numbers = if dimension == 0 { [1; DIGITS] } else { recur((polynomial, first)) };
        let mut directions = [0; DIGITS];
        for (digit, (direction, m)) in directions.iter_mut().zip(numbers).enumerate() {
            *direction = m << (DIGITS - 1 - digit);
        }
        Some(Self { directions })
    }

    /// The coordinate of a point as a binary fraction, its first digit the highest bit.
    pub fn digits(&self, index: u32) -> u32 {
        let gray = index ^ (index >> 1);
        let mut digits = 0;
        for (bit, direction) in self.directions.iter().enumerate() {
            if gray >> bit & 1 == 1 {
                digits ^= direction;
            }
        }
        digits
    }

    /// The scrambled coordinate of a point, in the open unit interval.
    pub fn scrambled(&self, index: u32, random: Stream) -> f64 {
        let digits = self.digits(index);
        let mut flips = 0_u32;
        for depth in 0..DIGITS {
            // The node of the binary tree that the digits so far lead to, counted as in a heap.
            let before = if depth == 0 { 0 } else { u64::from(digits >> (DIGITS - depth)) };
            let node = 1_u64 << depth | before;
            let flip = (random.word(node) >> 63) as u32;
            flips |= flip << (DIGITS - 1 - depth);
        }
        // All further digits are 0 before they are scrambled: one word flips them together.
        let leaf = 1_u64 << DIGITS | u64::from(digits);
        let rest = random.word(leaf) >> DIGITS;
        unit(u64::from(digits ^ flips) << DIGITS | rest)
    }
}

/// The first `count` scrambled points of the open unit cube, each with so many coordinates; fewer
/// beyond [`MAX_DIMENSIONS`].
#[must_use]
pub fn unit_points(dimensions: usize, count: u32, seed: u64) -> Vec<Vec<f64>> {
    let coordinates: Vec<Coordinate> = (0..dimensions).filter_map(Coordinate::new).collect();
    let point = |index: u32| {
        let coordinate = |(dimension, coordinate): (usize, &Coordinate)| {
            coordinate.scrambled(index, Stream::new(seed, 0, dimension as u64))
        };
        coordinates.iter().enumerate().map(coordinate).collect()
    };
    (0..count).map(point).collect()
}

/// The numbers `m_i`, of which the first are given, by the recurrence of the polynomial: for
/// `x^s + a_1 x^(s−1) + … + 1`,
/// `m_i = 2 a_1 m_(i−1) ⊕ … ⊕ 2^(s−1) a_(s−1) m_(i−s+1) ⊕ 2^s m_(i−s) ⊕ m_(i−s)`.
fn recur((polynomial, first): Dimension) -> [u32; DIGITS] {
    let degree = first.len();
    let mut m = [0_u32; DIGITS];
    m[..degree].copy_from_slice(first);
    for i in degree..DIGITS {
        let mut next = m[i - degree] ^ m[i - degree] << degree;
        for k in 1..degree {
            let coefficient = polynomial >> (degree - k) & 1;
            next ^= coefficient * (m[i - k] << k);
        }
        m[i] = next;
    }
    m
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of SciPy, whose coordinates times 2¹² are stored.
    #[test]
    fn peer_unscrambled_points_are_those_of_scipy() {
        let table = include_str!("../../../../data/reference/study/sobol.csv");
        let mut compared = 0;
        for line in table.lines().filter(|line| !line.starts_with('#')) {
            let numbers: Vec<u32> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let (index, expected) = numbers.split_first().unwrap();
            for (dimension, expected) in expected.iter().enumerate() {
                let digits = Coordinate::new(dimension).unwrap().digits(*index);
                assert_eq!(digits, expected << 20, "point {index}, dimension {dimension}");
                compared += 1;
            }
        }
        assert_eq!(compared, 8 * MAX_DIMENSIONS);
        assert!(Coordinate::new(MAX_DIMENSIONS).is_none());
    }

    fn points(dimension: usize, count: u32, seed: u64) -> Vec<f64> {
        let coordinate = Coordinate::new(dimension).unwrap();
        let random = Stream::new(seed, 0, dimension as u64);
        (0..count).map(|index| coordinate.scrambled(index, random)).collect()
    }

    /// The first 2^k points have one coordinate in each of 2^k equal intervals, scrambled or not;
    /// of two dimensions 1024 points fill every binary box of the (0, m, 2)-net of the first two.
    #[test]
    fn scrambled_points_stay_a_net() {
        for dimension in 0..MAX_DIMENSIONS {
            let mut seen = [false; 1024];
            for u in points(dimension, 1024, 11) {
                assert!(0.0 < u && u < 1.0);
                seen[(u * 1024.0) as usize] = true;
            }
            assert!(seen.iter().all(|seen| *seen), "dimension {dimension}");
        }
        let (x, y) = (points(0, 1024, 5), points(1, 1024, 5));
        for k in 0..=10 {
            let (columns, rows) = (1 << k, 1 << (10 - k));
            let mut seen = vec![0; 1024];
            for (x, y) in x.iter().zip(&y) {
                let (i, j) = ((x * columns as f64) as usize, (y * rows as f64) as usize);
                seen[i * rows + j] += 1;
            }
            assert!(seen.iter().all(|count| *count == 1), "boxes of {columns} × {rows}");
        }
    }

    /// One point over many seeds is uniform: Kolmogorov's distance of 4096 of them stays below the
    /// 0.1 % critical value 1.95/√4096.
    #[test]
    fn prop_scrambled_point_is_uniform_over_seeds() {
        for (dimension, index) in [(0, 0), (3, 5), (63, 1000)] {
            let coordinate = Coordinate::new(dimension).unwrap();
            let of = |seed| {
                let random = Stream::new(seed, 0, dimension as u64);
                coordinate.scrambled(index, random)
            };
            let mut all: Vec<f64> = (0..4096).map(of).collect();
            all.sort_by(f64::total_cmp);
            let distance = all
                .iter()
                .enumerate()
                .map(|(i, u)| (u - (i as f64 + 0.5) / 4096.0).abs())
                .fold(0.0, f64::max);
            assert!(distance < 1.95 / 64.0, "dimension {dimension}, point {index}: {distance}");
        }
    }

    /// The mean of a smooth function of five coordinates converges far faster than that of
    /// independent points, whose standard error at 4096 of them is √(31/4096) = 0.087: each factor
    /// has the mean 1 and the mean square 2.
    #[test]
    fn order_scrambled_mean_beats_monte_carlo() {
        let count = 4096;
        let coordinates: Vec<_> = (0..5).map(|dimension| points(dimension, count, 42)).collect();
        let product = |i: usize| -> f64 {
            coordinates.iter().map(|u| libm::sqrt(12.0) * (u[i] - 0.5) + 1.0).product()
        };
        let mean = (0..count as usize).map(product).sum::<f64>() / f64::from(count);
        assert!((mean - 1.0).abs() < 0.01, "{mean}");
    }
}
