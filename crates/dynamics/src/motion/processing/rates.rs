//! From one quantity to another: integrals from rest, derivatives.

use crate::error::MotionError;
use crate::motion::{Quantity, Series};

/// Integrates from rest or differentiates, as often as it takes.
///
/// - Integrals are those of the straight lines between samples, exact at the samples: the
///   trapezium rule for one, `u + v h + (2 a₀ + a₁) h²/6` for acceleration to displacement.
/// - Derivatives are those of the parabola through a sample and its neighbours (central
///   differences where they are evenly spaced; at the ends the parabola of the next sample).
pub(super) fn to(series: &Series, quantity: Quantity) -> Result<Series, MotionError> {
    use Quantity::{Acceleration, Counts, Displacement, Velocity};
    let changed = match (series.quantity(), quantity) {
        (Acceleration, Velocity) | (Velocity, Displacement) => integral(series),
        (Acceleration, Displacement) => double_integral(series),
        (Displacement, Velocity) | (Velocity, Acceleration) => derivative(series, 1)?,
        (Displacement, Acceleration) => derivative(series, 2)?,
        (Counts, _) | (_, Counts) => return Err(MotionError::Counts),
        _ => return Ok(series.clone()),
    };
    Ok(Series { quantity, ..series.with_values(changed)? })
}

fn integral(series: &Series) -> Vec<f64> {
    let mut sum = 0.0;
    let pieces = series.times_s().windows(2).zip(series.values().windows(2));
    let steps = pieces.map(|(t, v)| {
        sum += 0.5 * (t[1] - t[0]) * (v[0] + v[1]);
        sum
    });
    std::iter::once(0.0).chain(steps).collect()
}

fn double_integral(series: &Series) -> Vec<f64> {
    let (mut v, mut u) = (0.0, 0.0);
    let pieces = series.times_s().windows(2).zip(series.values().windows(2));
    let steps = pieces.map(|(t, a)| {
        let h = t[1] - t[0];
        u += h * (v + h * ((2.0 * a[0] + a[1]) / 6.0));
        v += 0.5 * h * (a[0] + a[1]);
        u
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// First or second derivative.
fn derivative(series: &Series, order: usize) -> Result<Vec<f64>, MotionError> {
    let (times, values) = (series.times_s(), series.values());
    let n = times.len();
    if n < 3 {
        return Err(MotionError::TooShort { found: n });
    }
    if let Some(index) = times.windows(2).position(|t| t[0] == t[1]) {
        let (previous_s, found_s) = (times[index], times[index + 1]);
        return Err(MotionError::TimeOrder { index: index + 1, previous_s, found_s });
    }
    let at = |i: usize| {
        let middle = i.clamp(1, n - 2);
        let (h0, h1) = (times[middle] - times[middle - 1], times[middle + 1] - times[middle]);
        let left = (values[middle] - values[middle - 1]) / h0;
        let right = (values[middle + 1] - values[middle]) / h1;
        let bend = 2.0 * (right - left) / (h0 + h1);
        if order == 2 {
            return bend;
        }
        (left * h1 + right * h0) / (h0 + h1) + bend * (times[i] - times[middle])
    };
    Ok((0..n).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use Quantity::{Acceleration, Displacement, Velocity};

    fn close(found: &Series, expected: impl Fn(f64) -> f64) {
        for (t, v) in found.times_s().iter().zip(found.values()) {
            assert!((v - expected(*t)).abs() < 1e-12, "{t}: {v} {}", expected(*t));
        }
    }

    /// a = 6t − 2 is one straight line: v = 3t² − 2t, u = t³ − t² at any samples.
    #[test]
    fn integrals_of_a_line() {
        let times: Vec<f64> = [0.0, 0.1, 0.4, 0.5, 1.2, 2.0].to_vec();
        let a = times.iter().map(|t| 6.0 * t - 2.0).collect();
        let a = Series::new(times, a, Acceleration).unwrap();
        close(&to(&a, Velocity).unwrap(), |t| 3.0 * t * t - 2.0 * t);
        close(&to(&a, Displacement).unwrap(), |t| t * t * t - t * t);
        assert_eq!(to(&a, Acceleration).unwrap(), a);
    }

    /// A parabola's derivatives are exact, uneven samples and ends included.
    #[test]
    fn derivatives_of_a_parabola() {
        let times: Vec<f64> = [0.0, 0.1, 0.4, 0.5, 1.2, 2.0].to_vec();
        let u = times.iter().map(|t| 3.0 * t * t - t + 2.0).collect();
        let u = Series::new(times, u, Displacement).unwrap();
        close(&to(&u, Velocity).unwrap(), |t| 6.0 * t - 1.0);
        close(&to(&u, Acceleration).unwrap(), |_| 6.0);
        assert_eq!(to(&u, Acceleration).unwrap().quantity(), Acceleration);
    }

    #[test]
    fn a_jump_has_no_derivative() {
        let u = Series::new(vec![0.0, 1.0, 1.0, 2.0], vec![0.0; 4], Velocity).unwrap();
        assert!(matches!(to(&u, Acceleration), Err(MotionError::TimeOrder { index: 2, .. })));
    }
}
