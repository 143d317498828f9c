//! Axes: ranges, round ticks and their labels.

use crate::number::{significant, typeset};

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where, in the axis's unit.
    pub value: f64,
    /// What stands beside it; empty for a minor mark.
    pub label: String,
}

/// A quantity drawn along one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit, as `Sliding displacement (mm)`.
    pub label: String,
    /// Value at the left or lower end.
    pub min: f64,
    /// Value at the right or upper end, above `min`.
    pub max: f64,
    /// Whether equal lengths are equal ratios; then `min > 0`.
    pub logarithmic: bool,
    /// What stands at 1, 2, 3 … in the place of numbers; nothing of an axis of numbers.
    pub names: Vec<String>,
}

impl Axis {
    /// From `min` to `max` as they are; an empty or unusable range becomes one around its start.
    #[must_use]
    pub fn linear(label: impl Into<String>, min: f64, max: f64) -> Self {
        let (min, max) = usable(min, max);
        Self { label: label.into(), min, max, logarithmic: false, names: Vec::new() }
    }

    /// Wide enough for all values and a margin of 6 %.
    #[must_use]
    pub fn covering(label: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = extremes(values);
        let margin = 0.06 * (high - low);
        Self::linear(label, low - margin, high + margin)
    }

    /// The same, 0 in the middle.
    #[must_use]
    pub fn symmetric(label: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let largest =
            values.into_iter().filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
        Self::linear(label, -1.08 * largest, 1.08 * largest)
    }

    /// From 0 up to the largest value and a margin.
    #[must_use]
    pub fn from_zero(label: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let (_, high) = extremes(values);
        Self::linear(label, 0.0, 1.06 * high.max(0.0))
    }

    /// Logarithmic from `min` to `max`; linear where that cannot be.
    #[must_use]
    pub fn logarithmic(label: impl Into<String>, min: f64, max: f64) -> Self {
        let logarithmic = min > 0.0 && max > min && (max / min).is_finite();
        Self { logarithmic, ..Self::linear(label, min, max) }
    }

    /// Names at 1, 2, 3 …
    #[must_use]
    pub fn named(label: impl Into<String>, names: Vec<String>) -> Self {
        let max = names.len() as f64 + 0.5;
        Self { names, ..Self::linear(label, 0.5, max) }
    }

    /// Where a value lies: 0 at `min`, 1 at `max`.
    #[must_use]
    pub fn fraction(&self, value: f64) -> f64 {
        if self.logarithmic {
            libm::log(value / self.min) / libm::log(self.max / self.min)
        } else {
            // Halves, so that a range as wide as the numbers go does not overflow.
            (0.5 * value - 0.5 * self.min) / (0.5 * self.max - 0.5 * self.min)
        }
    }

    /// Round values inside the range: steps of 1, 2 or 5 times a power of ten, about `target` of
    /// them; on a logarithmic axis 1, 2, 5 of each decade, with the other digits as minor marks.
    #[must_use]
    pub fn ticks(&self, target: usize) -> Vec<Tick> {
        if !self.names.is_empty() {
            let tick =
                |(i, name): (usize, &String)| Tick { value: (i + 1) as f64, label: name.clone() };
            return self.names.iter().enumerate().map(tick).collect();
        }
        if self.logarithmic { self.logarithmic_ticks() } else { self.linear_ticks(target) }
    }

    fn linear_ticks(&self, target: usize) -> Vec<Tick> {
        let slack = 1e-9;
        let inside = |target: usize| {
            let step = round_step((self.max - self.min) / target as f64);
            let first = libm::ceil(self.min / step - slack);
            (step, first, libm::floor(self.max / step + slack))
        };
        // A single tick gives no scale: ask for more until there are three.
        let target = target.max(1);
        let (step, first, last) = (target..target + 4)
            .map(inside)
            .find(|(_, first, last)| last - first >= 2.0)
            .unwrap_or_else(|| inside(target));
        if !(step > 0.0 && step.is_finite()) {
            return Vec::new();
        }
        let decimals = (-libm::floor(libm::log10(step) + slack)).max(0.0) as usize;
        let fixed = decimals <= 5 && self.min.abs().max(self.max.abs()) < 1e6;
        let count = (last - first).clamp(0.0, 100.0) as usize;
        (0..=count)
            .map(|i| {
                let value = (first + i as f64) * step + 0.0;
                let plain =
                    if fixed { format!("{value:.decimals$}") } else { significant(value, 2) };
                Tick { value, label: typeset(&plain) }
            })
            .collect()
    }

    fn logarithmic_ticks(&self) -> Vec<Tick> {
        let first = libm::floor(libm::log10(self.min)) as i32;
        let last = libm::ceil(libm::log10(self.max)) as i32;
        let crowded = last - first > 5;
        // Within a decade 1, 2 and 5 are two marks, or one: half steps and more of the digits have labels.
        let narrow = self.max / self.min < 9.0;
        // Over two decades there is room for a mark between 1 and 2.
        let roomy = self.max / self.min < 100.0;
        (first..=last)
            .flat_map(|decade| (2..20).map(move |half| (decade, half)))
            .filter(|(_, half)| half % 2 == 0 || (narrow && *half < 6) || (roomy && *half == 3))
            .map(|(decade, half)| {
                // Written and read back: 0.02 rather than 2 × 0.01 with its rounding.
                let value = format!("{}e{}", 5 * half, decade - 1).parse().unwrap_or(f64::NAN);
                let labelled = match half {
                    2 => true,
                    4 | 10 => !crowded,
                    3 => narrow || decade >= 0,
                    _ => narrow && half < 14,
                };
                let decimals = (i32::from(half % 2 == 1) - decade).max(0) as usize;
                let label = if labelled { format!("{value:.decimals$}") } else { String::new() };
                Tick { value, label }
            })
            .filter(|tick| (self.min * 0.999_999..=self.max * 1.000_001).contains(&tick.value))
            .collect()
    }
}

/// Smallest and largest finite value; (0, 0) of none.
fn extremes(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .into_iter()
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low <= high { (low, high) } else { (0.0, 0.0) }
}

/// The range itself, or one of a visible width around its start.
fn usable(min: f64, max: f64) -> (f64, f64) {
    if !(min.is_finite() && max.is_finite()) {
        return (0.0, 1.0);
    }
    let least = 1e-9 * min.abs().max(max.abs());
    if max - min > least {
        return (min, max);
    }
    let half = if min == 0.0 { 1.0 } else { 0.5 * min.abs() };
    (min - half, min + half)
}

/// The one of 1, 2, 5 × 10^k nearest to a rough step, by ratio.
fn round_step(rough: f64) -> f64 {
    let decade = libm::floor(libm::log10(rough)) as i32;
    // Between two candidates the border is their geometric mean.
    [(1, 2.0), (2, 10.0), (5, 50.0), (10, f64::INFINITY)]
        .into_iter()
        .filter_map(|(digit, border)| {
            let step = format!("{digit}e{decade}").parse::<f64>().ok()?;
            let unit = step / f64::from(digit);
            ((rough / unit) * (rough / unit) < border).then_some(step)
        })
        .next()
        .unwrap_or(rough)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, target: usize) -> Vec<String> {
        axis.ticks(target).into_iter().map(|tick| tick.label).filter(|l| !l.is_empty()).collect()
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(labels(&Axis::linear("t", 0.0, 54.4), 6), ["0", "10", "20", "30", "40", "50"]);
        assert_eq!(
            labels(&Axis::linear("a", -0.31, 0.31), 5),
            ["−0.3", "−0.2", "−0.1", "0.0", "0.1", "0.2", "0.3"]
        );
        assert_eq!(labels(&Axis::linear("a", -4.81, 4.81), 3), ["−4", "−2", "0", "2", "4"]);
        assert_eq!(
            labels(&Axis::linear("tiny", 0.0, 3e-8), 3),
            [
                "0",
                "1.0\u{202f}×\u{202f}10⁻⁸",
                "2.0\u{202f}×\u{202f}10⁻⁸",
                "3.0\u{202f}×\u{202f}10⁻⁸"
            ]
        );
        assert_eq!(
            labels(&Axis::logarithmic("T", 0.05, 2.0), 0),
            ["0.05", "0.1", "0.2", "0.5", "1", "1.5", "2"]
        );
        assert_eq!(
            labels(&Axis::logarithmic("T", 0.9, 4.5), 0),
            ["1", "1.5", "2", "2.5", "3", "4"]
        );
    }

    #[test]
    fn degenerate_ranges_are_still_drawable() {
        for (min, max) in [(0.0, 0.0), (5.0, 5.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            let axis = Axis::linear("x", min, max);
            assert!(axis.max > axis.min && axis.min.is_finite() && axis.max.is_finite());
            assert!(!axis.ticks(5).is_empty(), "{min} {max}");
        }
        let wide = Axis::linear("x", -f64::MAX, f64::MAX);
        assert!((wide.fraction(0.0) - 0.5).abs() < 1e-12);
        assert!(wide.ticks(5).len() <= 101);
        assert!(!Axis::logarithmic("x", 0.0, 1.0).logarithmic);
    }
}
