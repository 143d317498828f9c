//! Incremental dynamic analysis: demands over rising intensity, record by record.
//!
//! Terms and the hunt-and-fill search follow D. Vamvatsikos and C. A. Cornell (*Earthquake Engineering
//! and Structural Dynamics* 31, 2002; *Earthquake Spectra* 20, 2004). Demands need not grow with
//! intensity: a curve may cross the limit, come back below it (they call it resurrection) and cross
//! again. The capacity of a record is its **first** crossing; what comes back is told, not used.

use super::fractile;
use crate::error::FitError;

/// Demands of one record at rising intensities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Intensities, rising, > 0.
    pub levels: Vec<f64>,
    /// The demand at each; not finite where the run failed, which counts as above any limit.
    pub demands: Vec<f64>,
}

/// Where a record's curve crosses a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The level: reached there, or not reached up to there.
    pub level: f64,
    /// Whether the limit is reached.
    pub reached: bool,
    /// Highest level not reaching the limit, and lowest reaching it, between which the crossing lies.
    pub between: [f64; 2],
    /// A level beyond the crossing at which the demand is below the limit again.
    pub returns: Option<f64>,
}

impl Curve {
    /// Adds a point in its place; a level that is there already is replaced.
    pub fn insert(&mut self, level: f64, demand: f64) {
        let at = self.levels.partition_point(|known| *known < level);
        if self.levels.get(at) == Some(&level) {
            self.demands[at] = demand;
        } else {
            self.levels.insert(at, level);
            self.demands.insert(at, demand);
        }
    }

    fn reaches(&self, index: usize, limit: f64) -> bool {
        // What failed is NaN, and reaches.
        !(self.demands[index] < limit)
    }

    /// The first crossing of a limit > 0 on the curve's points joined by straight lines from the
    /// origin; where a run failed, the crossing is put at its level.
    #[must_use]
    pub fn first_crossing(&self, limit: f64) -> Crossing {
        let n = self.levels.len();
        let Some(at) = (0..n).find(|&i| self.reaches(i, limit)) else {
            let last = self.levels.last().copied().unwrap_or(0.0);
            let between = [last, f64::INFINITY];
            return Crossing { level: last, reached: false, between, returns: None };
        };
        let (low, below) =
            if at == 0 { (0.0, 0.0) } else { (self.levels[at - 1], self.demands[at - 1]) };
        let (high, above) = (self.levels[at], self.demands[at]);
        let level = if above.is_finite() && above > below {
            low + (high - low) * ((limit - below) / (above - below)).clamp(0.0, 1.0)
        } else {
            high
        };
        let returns = (at..n).find(|&i| !self.reaches(i, limit)).map(|i| self.levels[i]);
        Crossing { level, reached: true, between: [low, high], returns }
    }
}

/// How the level is sought at which a demand reaches its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hunt {
    /// The limit on the demand, > 0.
    pub limit: f64,
    /// First level tried, > 0.
    pub start: f64,
    /// Highest level tried; a record that does not reach the limit there is known only from below.
    pub top: f64,
    /// Largest ratio, less one, of neighbouring levels below the crossing: how close together two
    /// crossings may lie and still be told apart. The default is 0.05.
    pub resolution: f64,
    /// Largest distance of the two levels around the crossing over its level; the default is 0.01.
    pub tolerance: f64,
}

/// Levels this far below the first that reaches the limit are not searched for an earlier crossing.
pub const SEARCHED_SPAN: f64 = 10.0;
const GROWTH: f64 = 2.0;
const MOST_RUNS: usize = 2_000;

impl Hunt {
    /// The usual search for a limit between two levels.
    ///
    /// # Errors
    /// [`FitError::OutOfRange`] unless all are finite, > 0, and `start ≤ top`.
    pub fn new(limit: f64, start: f64, top: f64) -> Result<Self, FitError> {
        for (quantity, found) in [("limit", limit), ("first level", start), ("highest level", top)]
        {
            if !(found.is_finite() && found > 0.0) {
                let expected = "a finite value > 0";
                return Err(FitError::OutOfRange { quantity, expected, found });
            }
        }
        if start > top {
            let expected = "at most the highest level";
            return Err(FitError::OutOfRange { quantity: "first level", expected, found: start });
        }
        Ok(Self { limit, start, top, resolution: 0.05, tolerance: 0.01 })
    }

    /// Runs one record: `demand` gives its demand at a level, NaN where the run fails.
    ///
    /// *Hunt*: the level is doubled from `start` until the demand reaches the limit or `top` is
    /// passed (halved first, where `start` already reaches it). *Fill*: every gap from a tenth of the
    /// first level found up to the highest tried is divided until neighbouring levels differ by
    /// `resolution`; what crosses earlier is found there. *Close*: the gap around the first crossing
    /// is halved to `tolerance`. Two crossings within one gap of the fill cancel unseen.
    pub fn run(&self, mut demand: impl FnMut(f64) -> f64) -> Curve {
        let mut curve = Curve::default();
        let mut try_at = |curve: &mut Curve, level: f64| {
            let found = demand(level);
            curve.insert(level, found);
            !(found < self.limit)
        };
        let mut level = self.start;
        let mut reached = try_at(&mut curve, level);
        if reached {
            let mut below = level / GROWTH;
            while below > self.start * 1e-6 && try_at(&mut curve, below) {
                below /= GROWTH;
            }
        }
        while !reached && level < self.top {
            level = (level * GROWTH).min(self.top);
            reached = try_at(&mut curve, level);
        }
        let first = curve.first_crossing(self.limit);
        let from = if first.reached { first.between[1] } else { self.start } / SEARCHED_SPAN;
        let widest = 1.0 + self.resolution;
        // From the lowest gap up; each division halves its ratio.
        let mut i = 0;
        while i + 1 < curve.levels.len() && curve.levels.len() < MOST_RUNS {
            let (low, high) = (curve.levels[i], curve.levels[i + 1]);
            if high <= from || high <= low * widest {
                i += 1;
                continue;
            }
            let middle = (low.max(from / widest) * high).sqrt();
            try_at(&mut curve, middle);
        }
        if first.reached {
            for _ in 0..200 {
                let crossing = curve.first_crossing(self.limit);
                let [low, high] = crossing.between;
                if high - low <= self.tolerance * high {
                    break;
                }
                try_at(&mut curve, 0.5 * (low + high));
            }
        }
        curve
    }
}

/// Fractiles of 16, 50 and 84 % of the demand at one level, over the records' demands there.
#[must_use]
pub fn demand_fractiles(demands: &[f64]) -> [f64; 3] {
    fractile::fractiles(demands)
}

/// Fractiles of 16, 50 and 84 % of the intensity at which the records first reach a limit; a record
/// that does not reach it counts as above all, so a fractile may be infinite.
#[must_use]
pub fn level_fractiles(curves: &[Curve], limit: f64) -> [f64; 3] {
    let of = |curve: &Curve| {
        let crossing = curve.first_crossing(limit);
        if crossing.reached { crossing.level } else { f64::INFINITY }
    };
    fractile::fractiles(&curves.iter().map(of).collect::<Vec<_>>())
}
