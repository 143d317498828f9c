//! Where curves cross and peak.

/// `n` values from `first` to `last`, both included; `n` ≥ 2.
pub(crate) fn linspace(first: f64, last: f64, n: usize) -> Vec<f64> {
    let step = (last - first) / (n - 1) as f64;
    (0..n).map(|i| if i + 1 == n { last } else { first + i as f64 * step }).collect()
}

/// The same with equal ratios.
pub(crate) fn logspace(first: f64, last: f64, n: usize) -> Vec<f64> {
    let ratio = libm::log(last / first) / (n - 1) as f64;
    let at = |i: usize| if i + 1 == n { last } else { first * libm::exp(i as f64 * ratio) };
    (0..n).map(at).collect()
}

/// Where a function that changes sign between `low` and `high` is zero, by 44 halvings.
pub(crate) fn crossing<E>(
    [mut low, mut high]: [f64; 2],
    mut value: impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<f64>, E> {
    let (at_low, at_high) = (value(low)?, value(high)?);
    if at_low * at_high > 0.0 || at_low.is_nan() || at_high.is_nan() {
        return Ok(None);
    }
    for _ in 0..44 {
        let middle = 0.5 * (low + high);
        if value(middle)? * at_low > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(Some(0.5 * (low + high)))
}

/// Intervals of x in which neighbouring points satisfy a condition, by their first and last points.
pub(crate) fn intervals(points: &[[f64; 2]], mut holds: impl FnMut(f64) -> bool) -> Vec<[f64; 2]> {
    let mut found: Vec<[f64; 2]> = Vec::new();
    let mut inside = false;
    for &[x, y] in points {
        let here = holds(y);
        match found.last_mut() {
            Some(last) if here && inside => last[1] = x,
            _ if here => found.push([x, x]),
            _ => {}
        }
        inside = here;
    }
    found
}

/// Intervals as text, `0.10 to 0.35 and 1.20 to 3.00`; `nowhere` for none.
pub(crate) fn interval_text(intervals: &[[f64; 2]], decimals: usize) -> String {
    if intervals.is_empty() {
        return "nowhere".to_owned();
    }
    let one = |&[from, to]: &[f64; 2]| {
        if from == to {
            format!("{from:.decimals$}")
        } else {
            format!("{from:.decimals$} to {to:.decimals$}")
        }
    };
    intervals.iter().map(one).collect::<Vec<_>>().join(" and ")
}

/// Amplitudes in m/s² as text, `at 0.10 to 0.35 m/s²`, `at no amplitude`.
pub(crate) fn at_amplitudes(intervals: &[[f64; 2]]) -> String {
    if intervals.is_empty() {
        return "at no amplitude".to_owned();
    }
    format!("at {} m/s²", interval_text(intervals, 2))
}

/// The point with the largest value, the first of equals; `None` without points.
pub(crate) fn highest(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    points.iter().copied().reduce(|best, point| if point[1] > best[1] { point } else { best })
}

/// Least and largest of some values.
pub(crate) fn range(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(start, |[low, high], v| [low.min(v), high.max(v)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_and_their_text() {
        let points = [[0.0, 1.0], [1.0, 3.0], [2.0, 4.0], [3.0, 0.0], [4.0, 5.0]];
        let found = intervals(&points, |y| y > 2.0);
        assert_eq!(found, [[1.0, 2.0], [4.0, 4.0]]);
        assert_eq!(interval_text(&found, 1), "1.0 to 2.0 and 4.0");
        assert_eq!(interval_text(&[], 1), "nowhere");
    }

    #[test]
    fn crossing_of_a_parabola() {
        let root = crossing([1.0, 2.0], |x: f64| Ok::<_, ()>(x * x - 2.0)).unwrap().unwrap();
        assert!((root - 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(crossing([2.0, 3.0], |x: f64| Ok::<_, ()>(x * x - 2.0)), Ok(None));
    }

    #[test]
    fn spaces_end_where_they_should() {
        assert_eq!(linspace(0.0, 1.0, 3), [0.0, 0.5, 1.0]);
        let ratios = logspace(0.1, 10.0, 3);
        assert_eq!((ratios[0], ratios[2]), (0.1, 10.0));
        assert!((ratios[1] - 1.0).abs() < 1e-15);
    }
}
