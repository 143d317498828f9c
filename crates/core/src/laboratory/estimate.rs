//! What an identification says of one parameter.

/// A parameter, its value with its interval, or why the data do not tell it.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Its path in a model file, such as `slider.kinetic_friction.positive`.
    pub path: String,
    /// Its SI unit, empty for a ratio.
    pub unit: &'static str,
    /// What the data say.
    pub outcome: Outcome,
}

/// What data say of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// The value that fits best, in SI, and the ends of its 95 % interval of confidence.
    Told {
        /// Best value.
        value: f64,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// The data cannot tell.
    CannotTell {
        /// Why, in one sentence without a full stop.
        why: String,
    },
}

impl Estimate {
    /// An estimate with its interval.
    #[must_use]
    pub fn determined(
        path: impl Into<String>,
        unit: &'static str,
        value: f64,
        ends: [f64; 2],
    ) -> Self {
        let [low, high] = ends;
        Self { path: path.into(), unit, outcome: Outcome::Told { value, low, high } }
    }

    /// A refusal.
    #[must_use]
    pub fn refused(path: impl Into<String>, unit: &'static str, why: impl Into<String>) -> Self {
        Self { path: path.into(), unit, outcome: Outcome::CannotTell { why: why.into() } }
    }

    /// The best value, where the data tell one.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        match self.outcome {
            Outcome::Told { value, .. } => Some(value),
            Outcome::CannotTell { .. } => None,
        }
    }

    /// The ends of the interval, where the data tell one.
    #[must_use]
    pub fn interval(&self) -> Option<[f64; 2]> {
        match self.outcome {
            Outcome::Told { low, high, .. } => Some([low, high]),
            Outcome::CannotTell { .. } => None,
        }
    }

    /// Why the data do not tell it.
    #[must_use]
    pub fn why(&self) -> Option<&str> {
        match &self.outcome {
            Outcome::Told { .. } => None,
            Outcome::CannotTell { why } => Some(why),
        }
    }
}

/// The mean of independent values and its 95 % interval by Student's distribution, where there are
/// two values or more; `floor` is the least standard deviation that one value is taken to have.
#[must_use]
pub fn mean_interval(values: &[f64], floor: f64) -> Option<(f64, [f64; 2])> {
    let n = values.len() as f64;
    if values.len() < 2 {
        return None;
    }
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    let deviation = (squares / (n - 1.0)).sqrt().max(floor);
    let half =
        crate::numerics::distribution::student_quantile(0.95, n - 1.0) * deviation / n.sqrt();
    Some((mean, [mean - half, mean + half]))
}

/// The 95 % interval of a mean to which one error is common: the error lies anywhere within ± `reach`,
/// as likely here as there, and does not average out.
///
/// Its half width `w` is where the sum of both errors, uniform and normal with the standard error `s` of
/// the mean (Student's `t` over 1.96 counting for few values), lies within ± `w` with 95 %.
#[must_use]
pub fn mean_interval_with_common(values: &[f64], reach: f64) -> Option<(f64, [f64; 2])> {
    use crate::numerics::distribution::{bisect, normal_cdf, normal_density, normal_quantile};
    let (mean, [_, high]) = mean_interval(values, 0.0)?;
    let s = (high - mean) / normal_quantile(0.975);
    if !(reach > 0.0) {
        return Some((mean, [mean - (high - mean), high]));
    }
    let half = if s < 1e-6 * reach {
        0.95 * reach
    } else {
        // ∫ Φ = x Φ(x) + φ(x).
        let g = |x: f64| x * normal_cdf(x) + normal_density(x);
        let within = |w: f64| {
            let [a, b] = [(w + reach) / s, (w - reach) / s];
            s / (2.0 * reach) * (g(a) - g(b) - g(-b) + g(-a))
        };
        bisect(0.0, reach + 10.0 * s, |w| within(w) < 0.95)
    };
    Some((mean, [mean - half, mean + half]))
}

/// How many samples one independent sample is worth, 1 for noise without memory: the integrated
/// autocorrelation `1 + 2 Σ ρ_k` of residuals, summed up to the first lag at which `ρ` is below what
/// independent samples show by chance (`2/√n`), a tenth of the samples at most.
#[must_use]
pub fn correlation_length(residuals: &[f64]) -> f64 {
    let n = residuals.len();
    let energy: f64 = residuals.iter().map(|r| r * r).sum();
    if n < 4 || !(energy > 0.0) {
        return 1.0;
    }
    let chance = 2.0 / (n as f64).sqrt();
    let mut length = 1.0;
    for lag in 1..(n / 10).max(2).min(n - 1) {
        let sum: f64 = residuals.iter().zip(&residuals[lag..]).map(|(a, b)| a * b).sum();
        let rho = sum / energy;
        if rho < chance {
            break;
        }
        length += 2.0 * rho;
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1, 2, 3: mean 2, deviation 1, t = 4.30265 with two degrees of freedom.
    #[test]
    fn interval_of_three_values() {
        let (mean, [low, high]) = mean_interval(&[1.0, 2.0, 3.0], 0.0).unwrap();
        assert_eq!(mean, 2.0);
        assert!((high - 2.0 - 4.302_652_729_911 / 3.0_f64.sqrt()).abs() < 1e-9);
        assert!((low + high - 4.0).abs() < 1e-12);
        assert!(mean_interval(&[1.0], 0.0).is_none());
    }

    /// Alone the common error is uniform, alone the values are a mean; both together exceed either.
    #[test]
    fn interval_with_a_common_error() {
        let half = |values: &[f64], reach: f64| {
            let (mean, [_, high]) = mean_interval_with_common(values, reach).unwrap();
            high - mean
        };
        assert!((half(&[2.0, 2.0, 2.0], 0.3) - 0.95 * 0.3).abs() < 1e-12);
        let plain = half(&[1.0, 2.0, 3.0], 0.0);
        assert!((plain - 4.302_652_729_911 / 3.0_f64.sqrt()).abs() < 1e-9);
        assert!((half(&[1.0, 2.0, 3.0], 1e-6) / plain - 1.0).abs() < 1e-9);
        let both = half(&[1.0, 2.0, 3.0], 2.0);
        assert!(both > plain && both < plain + 2.0, "{both}");
        // Drawn: 1.2 uniform within ± 0.5 and normal with 0.2.
        let mut random = crate::numerics::random::Random::new(3);
        let s = 0.2 * 3.0_f64.sqrt() / 4.302_652_729_911 * 1.959_963_985;
        let half = half(&[-s, 0.0, s], 0.5);
        let inside = (0..100_000)
            .filter(|_| (random.uniform() - 0.5 + 0.2 * random.normal()).abs() < half)
            .count();
        assert!((inside as f64 / 1e5 - 0.95).abs() < 0.003, "{inside}");
    }

    /// A process `r_k = φ r_{k−1} + noise` has `ρ_k = φᵏ`, so a length of `(1 + φ)/(1 − φ)`.
    #[test]
    fn length_of_a_process_with_memory() {
        let mut random = crate::numerics::random::Random::new(4);
        let mut r = 0.0;
        let mut process = |phi: f64| -> Vec<f64> {
            let next = |_| {
                r = phi * r + random.normal();
                r
            };
            (0..40_000).map(next).collect()
        };
        assert!((correlation_length(&process(0.8)) - 9.0).abs() < 1.0);
        assert!(correlation_length(&process(0.0)) < 1.05);
        assert_eq!(correlation_length(&[0.0; 10]), 1.0);
    }
}
