//! What the two components of a pair say where each is run by itself, to stand beside the pair in two
//! horizontal directions.

use super::{ModelHistories, ModelOn, OnRecord, judged};
use crate::error::RunError;
use crate::input::{Analysis, Bound};
use crate::motion::GroundMotion;
use crate::study::cases::Case;
use crate::study::engine::Engine;

/// What the two components of a pair say where each is run by itself: peak sliding displacements in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alone {
    /// Along x under the first component, along y under the second.
    pub axes_m: [f64; 2],
}

impl Alone {
    /// The part of the other component that the combination of 100 % + 30 % takes.
    const OTHER: f64 = 0.3;

    /// By 100 % + 30 %: the longer of the vectors (x, 0.3 y) and (0.3 x, y).
    #[must_use]
    pub fn combined_m(&self) -> f64 {
        let [x, y] = self.axes_m;
        let (larger, smaller) = (x.max(y), Self::OTHER * x.min(y));
        (larger * larger + smaller * smaller).sqrt()
    }
}

/// A column of the runs in m: its name and its value.
type ColumnAlone = (&'static str, fn(&Alone) -> f64);

/// What components say by themselves, as columns of the runs.
pub const ALONE: [ColumnAlone; 3] = [
    ("peak_sliding_displacement_x_alone_m", |alone| alone.axes_m[0]),
    ("peak_sliding_displacement_y_alone_m", |alone| alone.axes_m[1]),
    ("peak_sliding_displacement_100_30_m", Alone::combined_m),
];

impl ModelHistories {
    /// Whether pairs were run together, in two horizontal directions.
    #[must_use]
    pub fn is_in_plane(&self) -> bool {
        self.records.iter().any(|on| on.alone.iter().any(Option::is_some))
    }

    /// The statistic that governs of what components say by themselves with a bound of friction; NaN where a
    /// record has none.
    #[must_use]
    pub fn governing_alone(&self, bound: usize, of: impl Fn(&Alone) -> f64) -> f64 {
        let alone = |on: &OnRecord| on.alone.get(bound).copied().flatten();
        let confirmed = self.records.iter().filter(|on| !on.is_unconfirmed());
        let sizes = confirmed.map(|on| alone(on).map_or(f64::NAN, |found| of(&found)));
        self.statistic_of(&sizes.collect::<Vec<f64>>())
    }
}

/// What the components of a record in two directions say by themselves, where it is one.
pub(super) fn of(
    model: &ModelOn<'_>,
    case: &Case,
    bound: &Bound,
    engine: &Engine<'_>,
) -> Result<Option<Alone>, RunError> {
    let motion = model.suite.motion(case.record, case.scale, 0.0)?;
    if motion.horizontal_y_m_per_s2().is_none() {
        return Ok(None);
    }
    let mut along_y = model.analysis.clone();
    along_y.model = along_y.model.turned_to_y();
    let peak = |analysis: &Analysis, motion: GroundMotion| {
        let (_, outcome) = judged(analysis, motion, bound, false, engine)?;
        Ok::<_, RunError>(outcome.nominal.response.demands.peak_sliding_displacement_m)
    };
    let axes_m = [peak(model.analysis, motion.along_x())?, peak(&along_y, motion.along_y())?];
    Ok(Some(Alone { axes_m }))
}
