//! Fractiles of a suite's results.
//!
//! Two rules, each where it belongs. Curves over a suite ([`fractile`]) interpolate linearly between
//! order statistics: the value at position `p (n − 1)` of the sorted values counted from 0, rule 7 of
//! R. J. Hyndman and Y. Fan (*The American Statistician* 50, 1996), the default of NumPy, R and
//! Excel. A probability that is promised ([`held_by`]) is counted: the least value that at least a
//! share `p` of the runs do not exceed.
//!
//! An infinite value counts as above every other: a run that is known to lie beyond, or a record whose curve
//! does not reach. A fractile that falls on such runs is infinite and drawn by nobody. NaN is no value: a run of
//! which nothing is known is left out.

/// 16, 50 and 84 %: median and one standard deviation of a normal distribution to either side.
pub const SHARES: [f64; 3] = [0.16, 0.5, 0.84];

/// The values in ascending order, those that are infinite as +∞ at the end and NaN left out.
#[must_use]
pub fn sorted(values: &[f64]) -> Vec<f64> {
    let above = |value: &f64| if value.is_finite() { *value } else { f64::INFINITY };
    let known = values.iter().filter(|value| !value.is_nan());
    let mut sorted: Vec<f64> = known.map(above).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// The fractile at a share `0 ≤ p ≤ 1` of sorted values, by linear interpolation; infinite where a
/// neighbour that it needs is, NaN of nothing.
#[must_use]
pub fn fractile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let position = p.clamp(0.0, 1.0) * last as f64;
    let below = (position as usize).min(last);
    let part = position - below as f64;
    let low = sorted[below];
    if part == 0.0 {
        return low;
    }
    let high = sorted[(below + 1).min(last)];
    if high.is_finite() { low + part * (high - low) } else { f64::INFINITY }
}

/// Fractiles of 16, 50 and 84 % of values in any order.
#[must_use]
pub fn fractiles(values: &[f64]) -> [f64; 3] {
    let sorted = sorted(values);
    SHARES.map(|share| fractile(&sorted, share))
}

/// The middle value in order of size, of an even number the mean of the two in the middle; NaN of
/// nothing.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n => 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]),
    }
}

/// A value that half of the others do not exceed: of an even number the upper one in the middle.
pub fn upper_median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// How many of `runs` must hold for a share of at least `p`: `⌈p n⌉`, with `p n` within rounding of a
/// whole number taken as that number.
#[must_use]
pub fn needed(p: f64, runs: usize) -> usize {
    let exact = p.clamp(0.0, 1.0) * runs as f64;
    let whole = libm::round(exact);
    let near = (exact - whole).abs() <= 1e-9 * (1.0 + whole);
    (if near { whole } else { libm::ceil(exact) }) as usize
}

/// The least of some sorted values that at least a share `p` of them do not exceed; −∞ where none is
/// needed.
#[must_use]
pub fn held_by(sorted: &[f64], p: f64) -> f64 {
    match needed(p, sorted.len()).checked_sub(1) {
        None => f64::NEG_INFINITY,
        Some(index) => sorted.get(index).copied().unwrap_or(f64::INFINITY),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_of_odd_and_even_numbers() {
        assert_eq!([median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0, 2.0, 8.0])], [2.0, 3.0]);
        assert!(median(&[]).is_nan());
        assert_eq!(upper_median([3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(upper_median([4.0, 1.0, 2.0, 8.0]), Some(4.0));
        assert_eq!(upper_median([]), None);
    }
}
