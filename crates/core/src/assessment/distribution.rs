//! The normal distribution and the tails of χ² and beta, to about 14 digits, on libm alone.

use core::f64::consts::PI;

use crate::study::normal;

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
    normal::probability(x)
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

/// The `x` with `Φ(x) = p`; −∞ and +∞ at 0 and 1, NaN outside.
#[must_use]
pub fn normal_quantile(p: f64) -> f64 {
    match p {
        0.0 => f64::NEG_INFINITY,
        1.0 => f64::INFINITY,
        p if 0.0 < p && p < 1.0 => normal::inverse(p),
        _ => f64::NAN,
    }
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

/// Where a condition that holds at `low` and fails at `high` changes, to the last bit.
pub(crate) fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
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
pub(crate) fn ln_normal_density(x: f64) -> f64 {
    -0.5 * (x * x + libm::log(2.0 * PI))
}
