//! The time step of a column of times, or the one that is given in its place.

use core::ops::Range;

use super::text::{Line, Text, last_digit, number};
use super::{RecordError, Sampling};
use slipstick_dynamics::motion::constant_step;
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// How the times of a column are spaced, with a warning where that had to be judged.
///
/// Times that follow a constant step to within rounding are that step. Times written with few
/// decimals which follow a short step to within their last decimal (a hundredth of the step at
/// most) are taken as that step. Any others stay as they are.
///
/// `times_s` are two or more and do not decrease. `given_s` is the caller's step, which stands in place
/// of theirs: that is said unless both are one.
pub fn of_times(times_s: Vec<f64>, given_s: Option<f64>) -> (Sampling, Vec<Notice>) {
    let from_zero: Vec<f64> = times_s.iter().map(|t| t - times_s[0]).collect();
    let even = constant_step(&from_zero);
    if let Some(given_s) = given_s {
        let notice = (even != Some(given_s)).then(|| replaced(given_s, even));
        return (Sampling::Dt(given_s), notice.into_iter().collect());
    }
    let resolution_s = resolution(&times_s);
    if let Some(dt_s) = even {
        return (Sampling::Dt(dt_s), odd_step(dt_s, resolution_s).into_iter().collect());
    }
    if let Some(dt_s) = step_but_for_rounding(&from_zero, resolution_s) {
        let message = format!(
            "the times are rounded to {resolution_s} s: taken as evenly spaced at {dt_s} s"
        );
        return (Sampling::Dt(dt_s), vec![Notice::new(NoticeKind::TimesRounded, message)]);
    }
    let steps = || from_zero.windows(2).map(|t| t[1] - t[0]);
    let spread_s = steps().fold(0.0, f64::max) - steps().fold(f64::INFINITY, f64::min);
    let warning = (spread_s <= 1.01 * resolution_s).then(|| {
        let message = format!(
            "the time steps differ by their last decimal, {resolution_s} s, only and were taken \
             as they stand: if the times were rounded, give the true step as dt"
        );
        Notice::new(NoticeKind::TimesRounded, message)
    });
    (Sampling::Times(times_s), warning.into_iter().collect())
}

/// Whether the caller's step is that of times which a format states in seconds, to within the rounding of
/// both.
///
/// # Errors
/// Their own step in words where it is not.
pub(super) fn fits(times_s: &[f64], given_s: Option<f64>) -> Result<(), String> {
    let Some(given_s) = given_s else { return Ok(()) };
    let from_zero: Vec<f64> = times_s.iter().map(|t| t - times_s[0]).collect();
    let resolution_s = resolution(times_s);
    match constant_step(&from_zero) {
        Some(dt_s) if (dt_s - given_s).abs() <= 0.51 * resolution_s => Ok(()),
        _ if follows(&from_zero, given_s, resolution_s) => Ok(()),
        Some(dt_s) => Err(format!("{dt_s} s")),
        None => Err("uneven times".to_owned()),
    }
}

/// The step that a header states, unless the caller's is what it rounds: steps are printed with few
/// decimals, 1/150 s as `.0067`.
///
/// # Errors
/// Where the caller gives another step.
pub(super) fn stated_step(
    text: &Text,
    line: &Line,
    word: &Range<usize>,
    stated_s: f64,
    given_s: Option<f64>,
) -> Result<f64, RecordError> {
    let Some(given_s) = given_s.filter(|given_s| *given_s != stated_s) else { return Ok(stated_s) };
    // A step that is computed from a rate is not what the word says.
    let written = &line.bytes[word.clone()];
    let half_s = match number(written) {
        Some(value) if value == stated_s => 0.505 * last_digit(written),
        _ => 1e-9 * stated_s,
    };
    if (given_s - stated_s).abs() > half_s {
        let expected = format!("the time step given, {given_s} s (leave it out)");
        return Err(text.error_at(line, word, expected));
    }
    Ok(given_s)
}

/// The step of `count` values over a duration in s that is written with a last digit of `ulp_s`: the
/// shortest decimal that makes the duration, of `count` steps or of one less.
pub(super) fn step_of_duration(duration_s: f64, count: usize, ulp_s: f64) -> Option<f64> {
    let mut scale = 1.0;
    for _ in 0..9 {
        for steps in [count, count.saturating_sub(1)] {
            let dt_s = libm::round(duration_s / steps as f64 * scale) / scale;
            if dt_s > 0.0 && (dt_s * steps as f64 - duration_s).abs() <= 0.51 * ulp_s {
                return Some(dt_s);
            }
        }
        scale *= 10.0;
    }
    let dt_s = duration_s / count as f64;
    (dt_s > 0.0 && dt_s.is_finite()).then_some(dt_s)
}

/// The first time that is before its predecessor, or stands a third time.
pub(super) fn disorder(times_s: &[f64]) -> Option<usize> {
    (1..times_s.len()).find(|&i| {
        let third = i >= 2 && times_s[i - 2] == times_s[i];
        times_s[i] < times_s[i - 1] || third || !(times_s[i] - times_s[0]).is_finite()
    })
}

fn replaced(given_s: f64, own_s: Option<f64>) -> Notice {
    let own = own_s.map_or("uneven steps".to_owned(), |own_s| format!("steps of {own_s} s"));
    let message =
        format!("the times of the file, {own}, were replaced by the given step of {given_s} s");
    Notice::new(NoticeKind::TimesReplaced, message)
}

/// A warning where a step read from few decimals is no whole number of samples a second.
fn odd_step(dt_s: f64, resolution_s: f64) -> Option<Notice> {
    let rate = 1.0 / dt_s;
    let whole = (rate - libm::round(rate)).abs() <= 1e-6 * rate;
    let coarse = resolution_s > 0.009 * dt_s;
    (coarse && !whole && dt_s < 1.0).then(|| {
        let message = format!(
            "a step of {dt_s} s is no whole number of samples a second: if the times were rounded, \
             give the true step as dt"
        );
        Notice::new(NoticeKind::TimesRounded, message)
    })
}

/// One unit of the last decimal in which the times are written, trailing zeros left out.
fn resolution(times_s: &[f64]) -> f64 {
    let mut scale = 1.0;
    for _ in 0..12 {
        let slack = 4.0 * f64::EPSILON * scale;
        let whole = |t: &f64| (t * scale - libm::round(t * scale)).abs() <= slack * t.abs();
        if times_s.iter().all(whole) {
            break;
        }
        scale *= 10.0;
    }
    1.0 / scale
}

/// Whether times are multiples of a step to within their last decimal.
fn follows(from_zero_s: &[f64], dt_s: f64, resolution_s: f64) -> bool {
    let slack_s = 1.01 * resolution_s;
    from_zero_s.iter().enumerate().all(|(i, t)| (t - i as f64 * dt_s).abs() <= slack_s)
}

/// The shortest decimal number that the times follow, if their last decimal is far below it.
fn step_but_for_rounding(from_zero_s: &[f64], resolution_s: f64) -> Option<f64> {
    let n = from_zero_s.len();
    let mean_s = from_zero_s[n - 1] / (n - 1) as f64;
    if resolution_s > 0.01 * mean_s {
        return None;
    }
    let mut scale = 1.0;
    for _ in 0..12 {
        let dt_s = libm::round(mean_s * scale) / scale;
        if dt_s > 0.0 && follows(from_zero_s, dt_s, resolution_s) {
            return Some(dt_s);
        }
        scale *= 10.0;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rounded(dt_s: f64, decimals: f64, n: usize) -> Vec<f64> {
        (0..n).map(|i| libm::floor(i as f64 * dt_s * decimals + 0.5) / decimals).collect()
    }

    #[test]
    fn an_even_step_is_told_from_rounded_times() {
        assert_eq!(resolution(&[0.0, 0.02, 0.04]), 0.01);
        assert_eq!(resolution(&[0.0, 0.005, 163.42]), 0.001);
        let (sampling, warnings) = of_times(rounded(0.02, 100.0, 50), None);
        assert_eq!((sampling, warnings.len()), (Sampling::Dt(0.02), 0));
    }

    /// 163.39999 where 163.4 was meant.
    #[test]
    fn last_decimal_is_rounding() {
        let mut times_s = rounded(0.02, 1e5, 100);
        times_s[40] -= 1e-5;
        let (sampling, warnings) = of_times(times_s, None);
        assert_eq!((sampling, warnings[0].kind), (Sampling::Dt(0.02), NoticeKind::TimesRounded));
    }

    #[test]
    fn uneven_times_stay() {
        let times_s = vec![0.0, 0.01, 0.03, 0.04];
        let (sampling, warnings) = of_times(times_s.clone(), None);
        assert_eq!((sampling, warnings.len()), (Sampling::Times(times_s), 1));
        let times_s = vec![0.0, 0.01, 0.05, 0.06];
        let (sampling, warnings) = of_times(times_s.clone(), None);
        assert_eq!((sampling, warnings.len()), (Sampling::Times(times_s), 0));
    }

    /// A step of 0.0025 s written as 0.003 s again and again.
    #[test]
    fn rounded_step_is_doubted_and_may_be_replaced() {
        let times_s = rounded(0.003, 1e3, 100);
        let (sampling, warnings) = of_times(times_s.clone(), None);
        assert_eq!((sampling, warnings[0].kind), (Sampling::Dt(0.003), NoticeKind::TimesRounded));
        let (sampling, warnings) = of_times(times_s.clone(), Some(0.0025));
        assert_eq!((sampling, warnings[0].kind), (Sampling::Dt(0.0025), NoticeKind::TimesReplaced));
        assert_eq!(of_times(times_s, Some(0.003)).1, vec![]);
    }

    /// Thirds of a hundredth with three decimals: 0.003, 0.007, 0.010, …
    #[test]
    fn times_may_be_replaced_by_the_step_they_round() {
        let times_s = rounded(1.0 / 300.0, 1e3, 100);
        assert!(fits(&times_s, Some(1.0 / 300.0)).is_ok() && fits(&times_s, None).is_ok());
        assert_eq!(fits(&times_s, Some(0.01)).unwrap_err(), "uneven times");
        assert_eq!(fits(&rounded(0.003, 1e3, 100), Some(0.01)).unwrap_err(), "0.003 s");
        let (sampling, warnings) = of_times(times_s.clone(), Some(1.0 / 300.0));
        assert_eq!((sampling, warnings.len()), (Sampling::Dt(1.0 / 300.0), 1));
        assert_eq!(warnings[0].kind, NoticeKind::TimesReplaced);
    }

    /// Milliseconds without a unit.
    #[test]
    fn a_given_step_stands_in_place_of_a_clock() {
        let (sampling, warnings) = of_times(vec![0.0, 5.0, 10.0], Some(0.005));
        assert_eq!((sampling, warnings[0].kind), (Sampling::Dt(0.005), NoticeKind::TimesReplaced));
        assert!(warnings[0].message.contains("steps of 5 s"), "{warnings:?}");
    }
}
