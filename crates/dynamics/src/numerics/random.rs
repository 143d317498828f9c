//! Reproducible random numbers: SplitMix64, and points spread over a box.
//!
//! Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014. The same seed
//! gives the same numbers on every machine.

/// By which the state of the generator grows.
pub const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// Its output function: every bit of the output depends on every bit of the input; a permutation of
/// 64-bit words.
pub const fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A generator of random numbers.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The generator of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(GOLDEN);
        mix(self.state)
    }

    /// One of `0 … n − 1`, each as likely as the others to 2⁻⁶⁴ n.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// Uniform between 0 and 1, without the ends.
    pub fn uniform(&mut self) -> f64 {
        ((self.bits() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Of the standard normal distribution (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        radius * libm::cos(core::f64::consts::TAU * self.uniform())
    }

    /// A Latin hypercube: `points` points in the unit cube of some dimension, one in each of as many
    /// slices of every side.
    pub fn latin_hypercube(&mut self, points: usize, dimension: usize) -> Vec<Vec<f64>> {
        let mut cube = vec![vec![0.0; dimension]; points];
        for axis in 0..dimension {
            let mut slices: Vec<usize> = (0..points).collect();
            for i in (1..points).rev() {
                let j = ((i + 1) as f64 * self.uniform()) as usize;
                slices.swap(i, j.min(i));
            }
            for (point, slice) in cube.iter_mut().zip(slices) {
                point[axis] = (slice as f64 + self.uniform()) / points as f64;
            }
        }
        cube
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first outputs for the seed 1234567, from the authors' program.
    #[test]
    fn peer_bits_of_the_authors() {
        let mut random = Random::new(1_234_567);
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        assert_eq!([(); 5].map(|()| random.bits()), expected);
    }

    #[test]
    fn one_point_a_slice() {
        let cube = Random::new(3).latin_hypercube(20, 3);
        for axis in 0..3 {
            let mut slices: Vec<usize> = cube.iter().map(|p| (20.0 * p[axis]) as usize).collect();
            slices.sort_unstable();
            assert_eq!(slices, (0..20).collect::<Vec<_>>());
        }
    }

    #[test]
    fn prop_normal_numbers_have_mean_0_and_variance_1() {
        let mut random = Random::new(5);
        let values: Vec<f64> = (0..20_000).map(|_| random.normal()).collect();
        let mean = values.iter().sum::<f64>() / 2e4;
        let variance = values.iter().map(|v| v * v).sum::<f64>() / 2e4;
        // Four standard errors.
        assert!(mean.abs() < 4.0 / 2e4_f64.sqrt() && (variance - 1.0).abs() < 4.0 * 0.01);
    }
}
