//! Student's distribution: what intervals of confidence are made with.

/// Probability that Student's `t` with `freedom` degrees of freedom (> 0) lies within ± `t`.
#[must_use]
pub fn student_within(t: f64, freedom: f64) -> f64 {
    if !t.is_finite() {
        return 1.0;
    }
    1.0 - incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t))
}

/// The `t` within ± which Student's distribution has a probability, such as 0.95.
///
/// Its square is the quantile of F with 1 and `freedom` degrees of freedom.
#[must_use]
pub fn student_quantile(probability: f64, freedom: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while student_within(high, freedom) < probability && high < 1e9 {
        high *= 2.0;
    }
    // Bisection to the last bit: a call a fit, so speed does not matter.
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if student_within(middle, freedom) < probability { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The regularised incomplete beta function `I_x(a, b)`, by its continued fraction (Lentz).
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return if x <= 0.0 { 0.0 } else { 1.0 };
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(b, a, 1.0 - x);
    }
    let beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let front = libm::exp(a * libm::log(x) + b * libm::log1p(-x) - beta) / a;
    const TINY: f64 = 1e-300;
    let keep = |value: f64| if value.abs() < TINY { TINY } else { value };
    let (mut c, mut d) = (1.0, 1.0 / keep(1.0 - (a + b) * x / (a + 1.0)));
    let mut fraction = d;
    for m in 1..500 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for term in [even, odd] {
            d = 1.0 / keep(1.0 + term * d);
            c = keep(1.0 + term / c);
            change = c * d;
            fraction *= change;
        }
        if (change - 1.0).abs() < 1e-16 {
            break;
        }
    }
    front * fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One and two degrees of freedom have closed forms.
    #[test]
    fn exact_closed_forms() {
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
