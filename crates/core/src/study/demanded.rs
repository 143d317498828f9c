//! What a run says of a demand: one rule for runs without an answer.
//!
//! A run that ended because its travel was used up had slid that far: its sliding displacement exceeds every
//! limit up to that travel. Of every other demand, of limits beyond the travel, and where a run has no answer
//! for another reason, nothing is known: such a run is censored, neither within a limit nor beyond it, and
//! whoever counts says how many there are.

use super::cases::FailedRun;

/// The demand of which something is known where a run used up its travel.
pub(crate) const SLIDING: &str = "peak_sliding_displacement_m";

/// Name of the column of runs that gives the travel in m which a run has used up.
pub const TRAVEL_USED_UP: &str = "travel_used_up_m";

/// What a run says of a demand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Demanded {
    /// Its size.
    Value(f64),
    /// It has reached this, and nothing is known beyond.
    AtLeast(f64),
    /// Nothing.
    Unknown,
}

impl From<f64> for Demanded {
    /// NaN is nothing known, infinity beyond every limit.
    fn from(value: f64) -> Self {
        match value {
            value if value.is_nan() => Self::Unknown,
            value if value.is_infinite() => Self::AtLeast(f64::INFINITY),
            value => Self::Value(value),
        }
    }
}

impl Demanded {
    /// What is known of a demand by its name from its size, NaN without an answer, and the travel in m that
    /// the run has used up.
    #[must_use]
    pub fn of(demand: &str, size: f64, travel_used_up_m: Option<f64>) -> Self {
        match travel_used_up_m.filter(|travel_m| size.is_nan() && travel_m.is_finite()) {
            Some(travel_m) if demand == SLIDING => Self::AtLeast(travel_m),
            _ => size.into(),
        }
    }

    /// Whether it reaches a limit; `None` where that is not known.
    #[must_use]
    pub fn reaches(self, limit: f64) -> Option<bool> {
        match self {
            Self::Value(value) => Some(value >= limit),
            Self::AtLeast(reached) => (reached >= limit).then_some(true),
            Self::Unknown => None,
        }
    }

    /// Whether it exceeds a limit; `None` where that is not known. A travel that is the limit is exceeded: the
    /// run would have gone on.
    #[must_use]
    pub fn exceeds(self, limit: f64) -> Option<bool> {
        match self {
            Self::Value(value) => Some(value > limit),
            _ => self.reaches(limit),
        }
    }

    /// Its size; NaN where that is not known.
    #[must_use]
    pub fn value(self) -> f64 {
        match self {
            Self::Value(value) => value,
            _ => f64::NAN,
        }
    }

    /// Its place among others: infinite where it is beyond them, NaN where nothing is known.
    #[must_use]
    pub fn or_beyond(self) -> f64 {
        match self {
            Self::Value(value) => value,
            Self::AtLeast(_) => f64::INFINITY,
            Self::Unknown => f64::NAN,
        }
    }

    /// The same for one limit: infinite where it reaches it without being known.
    #[must_use]
    pub fn against(self, limit: f64) -> f64 {
        match self {
            Self::AtLeast(reached) if reached >= limit => f64::INFINITY,
            _ => self.value(),
        }
    }
}

/// How many of some runs without an answer ended because their travel was used up.
#[must_use]
pub fn travel_used_up(failures: &[FailedRun]) -> usize {
    failures.iter().filter(|failed| failed.error.travel_used_up_m().is_some()).count()
}
