//! The normal distribution and its inverse, Student's, the tails of χ² and beta: to about 14 digits,
//! with the same bits on every machine.

use core::f64::consts::{PI, SQRT_2};

/// `√(2π)`.
const SQRT_TAU: f64 = 2.506_628_274_631_000_5;

/// Density of the standard normal distribution at `x`.
#[must_use]
pub fn normal_density(x: f64) -> f64 {
    libm::exp(-0.5 * x * x) / SQRT_TAU
}

/// Probability `Φ(x)` that a standard normal variable is at most `x`.
#[must_use]
pub fn normal_cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x / SQRT_2)
}

/// `ln Φ(x)`, finite far into the lower tail, where `Φ` itself is 0 in floating point.
#[must_use]
pub fn ln_normal_cdf(x: f64) -> f64 {
    if x > 0.0 {
        libm::log1p(-normal_cdf(-x))
    } else if x > TAIL {
        libm::log(normal_cdf(x))
    } else {
        -0.5 * x * x - libm::log(SQRT_TAU) + libm::log(mills(-x))
    }
}

/// `φ(x) / Φ(x)`: the slope of `ln Φ`.
#[must_use]
pub fn normal_hazard(x: f64) -> f64 {
    if x > TAIL { normal_density(x) / normal_cdf(x) } else { 1.0 / mills(-x) }
}

/// Below this the lower tail is taken from its continued fraction.
const TAIL: f64 = -6.0;

/// Mills' ratio `(1 − Φ(t)) / φ(t)` for `t ≥ 6`: Laplace's continued fraction, whose terms beyond
/// the fiftieth are below rounding there.
fn mills(t: f64) -> f64 {
    (1..=50).rev().fold(t, |below, k| t + f64::from(k) / below).recip()
}

/// `p[0] + p[1] x + …`, by Horner.
fn polynomial(x: f64, p: &[f64; 8]) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The `x` with `Φ(x) = u`; −∞ and +∞ at 0 and 1, NaN outside.
///
/// Wichura's algorithm AS 241 (1988), routine PPND16: relative accuracy about 1e-16.
#[must_use]
pub fn normal_quantile(u: f64) -> f64 {
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
    if !(0.0 < u && u < 1.0) {
        return match u {
            0.0 => f64::NEG_INFINITY,
            1.0 => f64::INFINITY,
            _ => f64::NAN,
        };
    }
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

/// As [`normal_quantile`], of a standard normal variable between `lo` and `hi`.
///
/// `None` where no probability is left between them that a number could hold.
#[must_use]
pub fn normal_quantile_between(u: f64, [lo, hi]: [f64; 2]) -> Option<f64> {
    if lo > 0.0 {
        // In the upper tail probabilities near 1 have no digits left; its mirror image has.
        return normal_quantile_between(1.0 - u, [-hi, -lo]).map(|z| -z);
    }
    let [below, above] = [normal_cdf(lo), normal_cdf(hi)];
    let p = below + u * (above - below);
    let holds = above - below > f64::MIN_POSITIVE && p > 0.0 && p < 1.0;
    holds.then(|| normal_quantile(p).clamp(lo, hi))
}

/// Probability that χ² with `degrees` of freedom exceeds `x`.
#[must_use]
pub fn chi_squared_tail(x: f64, degrees: f64) -> f64 {
    if !(x > 0.0) { 1.0 } else { upper_gamma(0.5 * degrees, 0.5 * x) }
}

/// Regularised upper incomplete gamma function `Q(a, x)`: its series below `a + 1`, else Lentz's
/// continued fraction.
fn upper_gamma(a: f64, x: f64) -> f64 {
    let scale = libm::exp(a * libm::log(x) - x - libm::lgamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > 0.25 * f64::EPSILON * sum {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - scale * sum;
    }
    let terms = (1..10_000).map(|i| {
        let i = f64::from(i);
        (-i * (i - a), x + 2.0 * i + 1.0 - a)
    });
    scale / lentz(x + 1.0 - a, terms)
}

/// Probability that a beta variable with parameters `a, b > 0` is at most `x` in [0, 1].
#[must_use]
pub fn beta_cdf(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return if x <= 0.0 { 0.0 } else { 1.0 };
    }
    // The continued fraction converges fast below the mean; beyond, by symmetry.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - beta_cdf(1.0 - x, b, a);
    }
    let ln_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let scale = libm::exp(a * libm::log(x) + b * libm::log1p(-x) - ln_beta) / a;
    let terms = (1..10_000).map(|i| {
        let m = f64::from(i / 2);
        let d = if i % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        (d, 1.0)
    });
    scale / lentz(1.0, terms)
}

/// The `x` with [`beta_cdf`] equal to `p`, by bisection to the last bit.
#[must_use]
pub fn beta_quantile(p: f64, a: f64, b: f64) -> f64 {
    bisect(0.0, 1.0, |x| beta_cdf(x, a, b) < p)
}

/// Probability that Student's `t` with `freedom` degrees of freedom (> 0) lies within ± `t`.
#[must_use]
pub fn student_within(t: f64, freedom: f64) -> f64 {
    if !t.is_finite() {
        return 1.0;
    }
    1.0 - beta_cdf(freedom / (freedom + t * t), 0.5 * freedom, 0.5)
}

/// The `t` within ± which Student's distribution has a probability, such as 0.95.
///
/// Its square is the quantile of F with 1 and `freedom` degrees of freedom.
#[must_use]
pub fn student_quantile(probability: f64, freedom: f64) -> f64 {
    let mut high = 1.0;
    while student_within(high, freedom) < probability && high < 1e9 {
        high *= 2.0;
    }
    bisect(0.0, high, |t| student_within(t, freedom) < probability)
}

/// Where a condition that holds at `low` and fails at `high` changes, to the last bit.
pub fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// `b0 + a1/(b1 + a2/(b2 + …))` by Lentz's method as modified by Thompson and Barnett.
fn lentz(b0: f64, terms: impl Iterator<Item = (f64, f64)>) -> f64 {
    const TINY: f64 = 1e-300;
    let away = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut value = away(b0);
    let (mut c, mut d) = (value, 0.0);
    for (a, b) in terms {
        d = away(b + a * d).recip();
        c = away(b + a / c);
        let factor = c * d;
        value *= factor;
        if (factor - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    value
}

/// Log-density of the standard normal distribution.
pub fn ln_normal_density(x: f64) -> f64 {
    -0.5 * (x * x + libm::log(2.0 * PI))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    #[test]
    fn peer_student() {
        let text = include_str!("../../../../data/reference/laboratory/student.json");
        let reference: Value = serde_json::from_str(text).unwrap();
        for case in reference["cases"].as_array().unwrap() {
            let [p, freedom, t] = [0, 1, 2].map(|i| case[i].as_f64().unwrap());
            let found = student_quantile(p, freedom);
            assert!((found / t - 1.0).abs() < 1e-9, "{p} {freedom}: {found} {t}");
        }
    }

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
            let z = normal_quantile(u);
            assert!((z - expected).abs() <= 5e-16 * expected.abs(), "{u}: {z} {expected}");
        }
    }

    #[test]
    fn probability_and_inverse_undo_each_other() {
        for i in 1..1000 {
            let u = f64::from(i) / 1000.0;
            assert!((normal_cdf(normal_quantile(u)) - u).abs() < 4e-16, "{u}");
        }
        assert_eq!(normal_cdf(0.0), 0.5);
    }

    /// Half a normal distribution: its median is that of the whole at 3/4.
    #[test]
    fn truncated_halves_and_tails() {
        let z = normal_quantile_between(0.5, [0.0, f64::INFINITY]).unwrap();
        assert!((z - normal_quantile(0.75)).abs() < 1e-15);
        let z = normal_quantile_between(0.5, [-1.0, 1.0]).unwrap();
        assert!(z.abs() < 1e-16);
        // Far out, the tail falls like exp(−8 (z − 8)): its median is 0.083 beyond its start.
        let z = normal_quantile_between(0.5, [8.0, f64::INFINITY]).unwrap();
        assert!((z - 8.084).abs() < 2e-3, "{z}");
        assert_eq!(normal_quantile_between(0.5, [-8.0, f64::NEG_INFINITY]), None);
        assert_eq!(normal_quantile_between(0.5, [50.0, 60.0]), None);
        let z = normal_quantile_between(0.25, [-f64::INFINITY, 1.0]).unwrap();
        assert!((normal_cdf(z) - 0.25 * normal_cdf(1.0)).abs() < 1e-16);
    }

    /// One and two degrees of freedom have closed forms.
    #[test]
    fn closed_forms() {
        let one = libm::tan(0.5 * core::f64::consts::PI * 0.95);
        assert!((student_quantile(0.95, 1.0) / one - 1.0).abs() < 1e-12);
        let two = 0.95 * (2.0 / (1.0 - 0.95 * 0.95_f64)).sqrt();
        assert!((student_quantile(0.95, 2.0) / two - 1.0).abs() < 1e-12);
    }

    /// scipy.stats.t.ppf(0.5 (1 + p), ν), SciPy 1.17.1 (`xtask/peers/laboratory.py`).
    #[test]
    fn peer_scipy() {
        for (p, freedom, expected) in [
            (0.95, 5.0, 2.570_581_835_636_31),
            (0.95, 9.0, 2.262_157_162_798_2),
            (0.99, 30.0, 2.749_995_653_567_23),
            (0.95, 1e3, 1.962_339_080_826_41),
            (0.95, 1e6, 1.959_966_356_814_11),
        ] {
            let found = student_quantile(p, freedom);
            assert!((found / expected - 1.0).abs() < 1e-9, "{p} {freedom}: {found}");
        }
    }
}
