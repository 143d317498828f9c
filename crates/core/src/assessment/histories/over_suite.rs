//! Statistics over a suite of what every record gives.

use super::{ModelHistories, OnRecord, is_confirmed, largest};
use crate::numerics::fractile::fractiles;
use crate::table::Table;

/// Statistics over a suite of a size: one value an earthquake, of a pair whose components were run separately the
/// larger of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverSuite {
    /// Arithmetic mean.
    pub mean: f64,
    /// Fractiles of [`SHARES`](crate::assessment::SHARES), interpolated between the values.
    pub fractiles: [f64; 3],
    /// The largest.
    pub largest: f64,
}

/// A statistic as a column: its name and its value.
type StatisticColumn = (&'static str, fn(&OverSuite) -> f64);

impl OverSuite {
    /// Those of the values of the earthquakes; none of nothing.
    fn of(sizes: &[f64]) -> Option<Self> {
        let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
        let (fractiles, largest) = (fractiles(sizes), largest(sizes));
        (!sizes.is_empty()).then_some(Self { mean, fractiles, largest })
    }

    /// The columns of some, a row each; `suffix` stands after their names, which are of a quantity with this unit.
    pub(super) fn add_columns(all: &[Self], table: &mut Table, suffix: &str, unit: &str) {
        let columns: [StatisticColumn; 5] = [
            ("mean", |over| over.mean),
            ("p16", |over| over.fractiles[0]),
            ("median", |over| over.fractiles[1]),
            ("p84", |over| over.fractiles[2]),
            ("largest", |over| over.largest),
        ];
        for (name, of) in columns {
            table.numbers(&format!("{name}{suffix}"), unit, all.iter().map(of).collect());
        }
    }
}

impl ModelHistories {
    /// A size of each earthquake whose runs the check confirms; none where a record has no such size.
    pub(super) fn of_each_earthquake(&self, size: impl Fn(&OnRecord) -> f64) -> Option<Vec<f64>> {
        if self.records.iter().any(|on| size(on).is_nan()) {
            return None;
        }
        let of_one = |records: &[OnRecord]| largest(&records.iter().map(&size).collect::<Vec<_>>());
        let confirmed = self.earthquakes().filter(|records| is_confirmed(records));
        Some(confirmed.map(of_one).collect())
    }

    /// Statistics of a size over the earthquakes whose runs the check confirms; none where a record has no such size.
    #[must_use]
    pub fn over_suite(&self, size: impl Fn(&OnRecord) -> f64) -> Option<OverSuite> {
        OverSuite::of(&self.of_each_earthquake(size)?)
    }

    /// What governs of these statistics: the mean, or the largest of few records.
    #[must_use]
    pub fn governing_of(&self, over: &OverSuite) -> f64 {
        if self.statistic() == "mean" { over.mean } else { over.largest }
    }
}
