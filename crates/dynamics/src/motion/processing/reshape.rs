//! Taper, resampling, trimming.

use core::f64::consts::PI;

use crate::error::MotionError;
use crate::motion::Series;
use crate::motion::combine::steps;

/// Half a cosine over `fraction` of the duration at each end.
pub(super) fn taper(series: &Series, fraction: f64) -> Result<Series, MotionError> {
    if !(fraction > 0.0 && fraction <= 0.5) {
        let expected = "a part of the duration above 0 and up to 0.5";
        return Err(MotionError::OutOfRange { quantity: "taper", expected, found: fraction });
    }
    let end_s = series.duration_s();
    let length_s = fraction * end_s;
    let factor = |t: f64| {
        let from_end_s = t.min(end_s - t);
        if from_end_s >= length_s {
            1.0
        } else {
            0.5 * (1.0 - libm::cos(PI * from_end_s / length_s))
        }
    };
    let tapered = series.times_s().iter().zip(series.values()).map(|(t, v)| factor(*t) * v);
    series.with_values(tapered.collect())
}

/// Samples along the straight lines every `dt_s`, up to the end; at a jump the limit from the right.
pub(super) fn resample(series: &Series, dt_s: f64) -> Result<Series, MotionError> {
    if !(dt_s.is_finite() && dt_s > 0.0) {
        let expected = "a finite time step > 0";
        return Err(MotionError::OutOfRange { quantity: "dt_s", expected, found: dt_s });
    }
    let end_s = series.duration_s();
    let whole = steps(end_s, dt_s, 1)?;
    // The last one may lie past the end, unless rounding alone takes it there.
    let count = if whole as f64 * dt_s > end_s * (1.0 + 1e-9) { whole } else { whole + 1 };
    let (times, values) = (series.times_s(), series.values());
    let mut next = 0;
    let sample = |k: usize| {
        let t = (k as f64 * dt_s).min(end_s);
        while next < times.len() && times[next] <= t {
            next += 1;
        }
        if next == times.len() {
            return values[next - 1];
        }
        let fraction = (t - times[next - 1]) / (times[next] - times[next - 1]);
        values[next - 1] + (values[next] - values[next - 1]) * fraction
    };
    let values = (0..count).map(sample).collect();
    Series::evenly_spaced(dt_s, values, series.quantity())
}

/// The part from `from_s` to `to_s`.
pub(super) fn trim(series: &Series, from_s: f64, to_s: f64) -> Result<Series, MotionError> {
    let end_s = series.duration_s();
    if !(0.0 <= from_s && from_s < to_s) {
        let expected = "two times ≥ 0, the earlier first";
        return Err(MotionError::OutOfRange { quantity: "trim", expected, found: from_s });
    }
    // An end that is meant to be the last sample may differ from it by rounding.
    if to_s > end_s * (1.0 + 1e-9) {
        let expected = "an end no later than the last sample";
        return Err(MotionError::OutOfRange { quantity: "trim", expected, found: to_s });
    }
    let (slack_s, to_s) = (1e-9 * end_s, to_s.min(end_s));
    let inside = |t: &f64| *t > from_s + slack_s && *t < to_s - slack_s;
    let kept: Vec<usize> =
        (0..series.times_s().len()).filter(|i| inside(&series.times_s()[*i])).collect();
    // Ends that stand at a sample are that sample, to the last bit.
    let value = |t: f64, left: bool| {
        let times = series.times_s();
        let mut same = (0..times.len()).filter(|i| (times[*i] - t).abs() <= slack_s);
        let found = if left { same.next() } else { same.next_back() };
        found.map_or_else(|| series.at(t, left), |i| series.values()[i])
    };
    let mut times = vec![0.0];
    let mut values = vec![value(from_s, false)];
    for i in kept {
        times.push(series.times_s()[i] - from_s);
        values.push(series.values()[i]);
    }
    times.push(to_s - from_s);
    values.push(value(to_s, true));
    let trimmed = Series::new(times, values, series.quantity())?;
    // Times less the start differ in their last bits from multiples of the step.
    match (series.dt_s(), trimmed.dt_s()) {
        (Some(dt_s), Some(_)) => {
            Series::evenly_spaced(dt_s, trimmed.values.to_vec(), series.quantity())
        }
        _ => Ok(trimmed),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Quantity;

    fn even(dt_s: f64, values: &[f64]) -> Series {
        Series::evenly_spaced(dt_s, values.to_vec(), Quantity::Acceleration).unwrap()
    }

    #[test]
    fn taper_at_quarters() {
        let s = taper(&even(1.0, &[2.0; 9]), 0.25).unwrap();
        let expected = [0.0, 1.0, 2.0, 2.0, 2.0, 2.0, 2.0, 1.0, 0.0];
        for (found, expected) in s.values().iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
        assert!(taper(&s, 0.6).is_err());
    }

    #[test]
    fn resampled_along_the_lines() {
        let s = even(1.0, &[0.0, 4.0, 0.0]);
        assert_eq!(resample(&s, 0.5).unwrap().values(), [0.0, 2.0, 4.0, 2.0, 0.0]);
        assert_eq!(resample(&s, 1.0).unwrap(), s);
        assert_eq!(resample(&s, 0.75).unwrap().values(), [0.0, 3.0, 2.0]);
        // Back again: nothing lost.
        let fine = resample(&even(0.01, &[0.0, 1.0, -2.0, 0.5]), 0.001).unwrap();
        assert_eq!(fine.values().len(), 31);
        let back = resample(&fine, 0.01).unwrap();
        for (found, expected) in back.values().iter().zip([0.0, 1.0, -2.0, 0.5]) {
            assert!((found - expected).abs() < 1e-14);
        }
        assert!(resample(&s, 1e-12).is_err() && resample(&s, 3.0).is_err());
    }

    #[test]
    fn trimmed_at_and_between_samples() {
        let s = even(1.0, &[0.0, 4.0, 0.0, -8.0]);
        let whole = trim(&s, 1.0, 3.0).unwrap();
        assert_eq!((whole.values(), whole.dt_s()), (&[4.0, 0.0, -8.0][..], Some(1.0)));
        let part = trim(&s, 0.5, 2.5).unwrap();
        assert_eq!(part.times_s(), [0.0, 0.5, 1.5, 2.0]);
        assert_eq!(part.values(), [2.0, 4.0, 0.0, -4.0]);
        assert!(trim(&s, 2.0, 4.0).is_err() && trim(&s, 2.0, 2.0).is_err());
        // A jump at an end keeps the side that is inside.
        let jump = Series::new(
            vec![0.0, 1.0, 1.0, 2.0, 2.0, 3.0],
            vec![0.0, 0.0, 5.0, 5.0, 1.0, 1.0],
            Quantity::Acceleration,
        )
        .unwrap();
        assert_eq!(trim(&jump, 1.0, 2.0).unwrap().values(), [5.0, 5.0]);
    }
}
