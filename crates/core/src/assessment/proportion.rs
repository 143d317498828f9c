//! A probability from counts, with its interval.

use crate::error::FitError;
use crate::numerics::distribution::{beta_quantile, normal_quantile};

/// `count` successes of `runs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Proportion {
    count: u64,
    runs: u64,
}

impl Proportion {
    /// `count` of `runs`.
    ///
    /// # Errors
    /// [`FitError::OutOfRange`] unless `0 < runs` and `count ≤ runs`.
    pub fn new(count: u64, runs: u64) -> Result<Self, FitError> {
        if runs == 0 || count > runs {
            let expected = "at most the number of runs, which is at least 1";
            return Err(FitError::OutOfRange { quantity: "count", expected, found: count as f64 });
        }
        Ok(Self { count, runs })
    }

    /// Share of the runs.
    #[must_use]
    pub fn estimate(&self) -> f64 {
        self.count as f64 / self.runs as f64
    }

    /// Wilson's score interval: near its nominal confidence on average, also for few runs.
    #[must_use]
    pub fn wilson(&self, confidence: f64) -> [f64; 2] {
        let z = normal_quantile(0.5 + 0.5 * confidence);
        let (n, p) = (self.runs as f64, self.estimate());
        let centre = p + z * z / (2.0 * n);
        let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + z * z / n;
        let low = if self.count == 0 { 0.0 } else { (centre - half) / scale };
        let high = if self.count == self.runs { 1.0 } else { (centre + half) / scale };
        [low, high]
    }

    /// Clopper and Pearson's interval, never below its nominal confidence.
    #[must_use]
    pub fn clopper_pearson(&self, confidence: f64) -> [f64; 2] {
        let tail = 0.5 * (1.0 - confidence);
        let (k, n) = (self.count as f64, self.runs as f64);
        let low = if self.count == 0 { 0.0 } else { beta_quantile(tail, k, n - k + 1.0) };
        let high =
            if self.count == self.runs { 1.0 } else { beta_quantile(1.0 - tail, k + 1.0, n - k) };
        [low, high]
    }
}
