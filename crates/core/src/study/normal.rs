//! The normal distribution and its inverse, with the same bits on every machine.

use core::f64::consts::SQRT_2;

/// Probability of a standard normal variable to lie below `z`.
pub(crate) fn probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// `p[0] + p[1] x + …`, by Horner.
fn polynomial(x: f64, p: &[f64; 8]) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The value below which a standard normal variable lies with the probability `u`, 0 < u < 1.
///
/// Wichura's algorithm AS 241 (1988), routine PPND16: relative accuracy about 1e-16.
pub(crate) fn inverse(u: f64) -> f64 {
    const A: [f64; 8] = [
        3.387_132_872_796_366_5,
        1.331_416_678_917_843_8e2,
        1.971_590_950_306_551_3e3,
        1.373_169_376_550_946e4,
        4.592_195_393_154_987e4,
        6.726_577_092_700_87e4,
        3.343_057_558_358_813e4,
        2.509_080_928_730_122_7e3,
    ];
    const B: [f64; 8] = [
        1.0,
        4.231_333_070_160_091e1,
        6.871_870_074_920_579e2,
        5.394_196_021_424_751e3,
        2.121_379_430_158_659_7e4,
        3.930_789_580_009_271e4,
        2.872_908_573_572_194_3e4,
        5.226_495_278_852_854e3,
    ];
    const C: [f64; 8] = [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        2.417_807_251_774_506e-1,
        2.272_384_498_926_918_4e-2,
        7.745_450_142_783_414e-4,
    ];
    const D: [f64; 8] = [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        6.897_673_349_851e-1,
        1.481_039_764_274_800_8e-1,
        1.519_866_656_361_645_7e-2,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ];
    const E: [f64; 8] = [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        2.965_605_718_285_049e-1,
        2.653_218_952_657_612_4e-2,
        1.242_660_947_388_078_4e-3,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ];
    const F: [f64; 8] = [
        1.0,
        5.998_322_065_558_88e-1,
        1.369_298_809_227_358e-1,
        1.487_536_129_085_061_5e-2,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_8e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ];
    let q = u - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180_625 - q * q;
        return q * polynomial(r, &A) / polynomial(r, &B);
    }
    let r = libm::sqrt(-libm::log(if q < 0.0 { u } else { 1.0 - u }));
    let z = if r <= 5.0 {
        polynomial(r - 1.6, &C) / polynomial(r - 1.6, &D)
    } else {
        polynomial(r - 5.0, &E) / polynomial(r - 5.0, &F)
    };
    if q < 0.0 { -z } else { z }
}

/// As [`inverse`], of a standard normal variable between `lo` and `hi`.
///
/// `None` where no probability is left between them that a number could hold.
pub(super) fn inverse_between(u: f64, [lo, hi]: [f64; 2]) -> Option<f64> {
    if lo > 0.0 {
        // In the upper tail probabilities near 1 have no digits left; its mirror image has.
        return inverse_between(1.0 - u, [-hi, -lo]).map(|z| -z);
    }
    let [below, above] = [probability(lo), probability(hi)];
    let p = below + u * (above - below);
    let holds = above - below > f64::MIN_POSITIVE && p > 0.0 && p < 1.0;
    holds.then(|| inverse(p).clamp(lo, hi))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// √2 erfinv(2u − 1) by mpmath 1.3 with 40 digits, of the doubles nearest to these u.
    #[test]
    fn peer_inverse_is_that_of_mpmath() {
        let cases: [(f64, f64); 11] = [
            (1.0 / (1_u64 << 53) as f64, -8.209_536_151_601_387),
            (1e-10, -6.361_340_902_404_057),
            (0.001, -3.090_232_306_167_813_6),
            (0.02425, -1.972_961_051_311_885),
            (0.16, -0.994_457_883_209_753_1),
            (0.3, -0.524_400_512_708_040_8),
            (0.42, -0.201_893_479_141_850_88),
            (0.5, 0.0),
            (0.575, 0.189_118_426_272_792_38),
            (0.9, 1.281_551_565_544_600_6),
            (0.999_999, 4.753_424_308_817_087),
        ];
        for (u, expected) in cases {
            let z = inverse(u);
            assert!((z - expected).abs() <= 5e-16 * expected.abs(), "{u}: {z} {expected}");
        }
    }

    #[test]
    fn exact_probability_and_inverse_undo_each_other() {
        for i in 1..1000 {
            let u = f64::from(i) / 1000.0;
            assert!((probability(inverse(u)) - u).abs() < 4e-16, "{u}");
        }
        assert_eq!(probability(0.0), 0.5);
    }

    /// Half a normal distribution: its median is that of the whole at 3/4.
    #[test]
    fn exact_truncated_halves_and_tails() {
        let z = inverse_between(0.5, [0.0, f64::INFINITY]).unwrap();
        assert!((z - inverse(0.75)).abs() < 1e-15);
        let z = inverse_between(0.5, [-1.0, 1.0]).unwrap();
        assert!(z.abs() < 1e-16);
        // Far out, the tail falls like exp(−8 (z − 8)): its median is 0.083 beyond its start.
        let z = inverse_between(0.5, [8.0, f64::INFINITY]).unwrap();
        assert!((z - 8.084).abs() < 2e-3, "{z}");
        assert_eq!(inverse_between(0.5, [-8.0, f64::NEG_INFINITY]), None);
        assert_eq!(inverse_between(0.5, [50.0, 60.0]), None);
        let z = inverse_between(0.25, [-f64::INFINITY, 1.0]).unwrap();
        assert!((probability(z) - 0.25 * probability(1.0)).abs() < 1e-16);
    }
}
