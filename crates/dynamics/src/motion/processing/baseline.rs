//! Removal of a polynomial baseline.

use crate::error::MotionError;
use crate::motion::Series;

/// Subtracts the polynomial of `degree` that fits best.
///
/// Least squares with a weight for every sample: 1 where samples are evenly spaced, as in other
/// programs, else the half of both intervals beside it, so that a dense part counts no more than
/// its time. The polynomials are orthogonal over the samples (Forsythe's recurrence): a fit of
/// degree 10 loses no digits.
pub(super) fn remove(series: &Series, degree: usize) -> Result<Series, MotionError> {
    let times = series.times_s();
    let n = times.len();
    if degree + 1 > n {
        return Err(MotionError::OutOfRange {
            quantity: "degree of the baseline",
            expected: "a degree below the number of samples",
            found: degree as f64,
        });
    }
    let end_s = series.duration_s();
    let x: Vec<f64> = times.iter().map(|t| 2.0 * t / end_s - 1.0).collect();
    let weights = weights(series);
    let dot = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).zip(&weights).map(|((a, b), w)| w * a * b).sum()
    };
    let mut rest = series.values().to_vec();
    let mut previous = vec![0.0; n];
    let mut current = vec![1.0; n];
    let mut norm = dot(&current, &current);
    let mut beta = 0.0;
    for power in 0..=degree {
        let factor = dot(&rest, &current) / norm;
        for (r, p) in rest.iter_mut().zip(&current) {
            *r -= factor * p;
        }
        if power == degree {
            break;
        }
        let shifted: Vec<f64> = x.iter().zip(&current).map(|(x, p)| x * p).collect();
        let alpha = dot(&shifted, &current) / norm;
        let next = (0..n).map(|i| (x[i] - alpha) * current[i] - beta * previous[i]).collect();
        previous = std::mem::replace(&mut current, next);
        let next_norm = dot(&current, &current);
        beta = next_norm / norm;
        norm = next_norm;
    }
    series.with_values(rest)
}

fn weights(series: &Series) -> Vec<f64> {
    let times = series.times_s();
    let n = times.len();
    if series.dt_s().is_some() {
        return vec![1.0; n];
    }
    let half = |i: usize, j: usize| 0.5 * (times[j] - times[i]);
    let beside = |i: usize| half(i.saturating_sub(1), i) + half(i, (i + 1).min(n - 1));
    (0..n).map(beside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Quantity;

    /// A polynomial leaves nothing of itself, whatever the sampling.
    #[test]
    fn polynomials_vanish() {
        for degree in 0..=10 {
            let times: Vec<f64> =
                (0..200).map(|i| 0.1 * f64::from(i) * (1.0 + 0.01 * f64::from(i))).collect();
            let values: Vec<f64> = times
                .iter()
                .map(|t| {
                    let x = t / 30.0 - 1.0;
                    (0..=degree).fold(0.0, |sum, k| sum * x + f64::from(k) - 2.5)
                })
                .collect();
            let even = Series::evenly_spaced(0.1, values.clone(), Quantity::Acceleration);
            let uneven = Series::new(times, values, Quantity::Acceleration).unwrap();
            let rest = remove(&uneven, degree as usize).unwrap();
            let largest = rest.values().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            assert!(largest < 1e-11, "{degree}: {largest}");
            drop(even);
        }
    }

    /// 0, 1, 4, 9 is t²; its straight line by least squares is 3t − 1.
    #[test]
    fn line_of_a_parabola() {
        let s = Series::evenly_spaced(1.0, vec![0.0, 1.0, 4.0, 9.0], Quantity::Velocity).unwrap();
        let rest = remove(&s, 1).unwrap();
        for (found, expected) in rest.values().iter().zip([1.0, -1.0, -1.0, 1.0]) {
            assert!((found - expected).abs() < 1e-14);
        }
        assert!(remove(&s, 4).is_err());
        let largest = remove(&s, 3).unwrap().values().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        assert!(largest < 1e-14);
    }
}
