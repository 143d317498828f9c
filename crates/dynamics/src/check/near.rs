//! Decisions that came close: between knots, and in which order.

use super::collocation::POINTS;
use super::{ClosestCall, DecisionKind};

/// The least of the inner values, if it is below both ends.
pub(super) fn dip(values: &[f64; POINTS]) -> Option<usize> {
    let least = (0..POINTS).fold(0, |best, i| if values[i] < values[best] { i } else { best });
    (least > 0 && least + 1 < POINTS).then_some(least)
}

/// Local minima of a quantity within one phase, fed in order of time.
///
/// A minimum counts once the quantity has fallen to it and risen from it by more than `slack`, the
/// rounding of the values.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalMinima {
    slack: f64,
    falling: bool,
    turn: f64,
    turn_s: f64,
    /// Largest value.
    peak: f64,
    least: Option<(f64, f64)>,
    /// Least minimum, those counted that slack hides.
    shallow: f64,
}

impl LocalMinima {
    pub(super) fn new(slack: f64) -> Self {
        Self {
            slack,
            falling: false,
            turn: f64::NAN,
            turn_s: 0.0,
            peak: 0.0,
            least: None,
            shallow: f64::INFINITY,
        }
    }

    /// The least minimum so far, or ∞.
    pub(super) fn so_far(&self) -> f64 {
        self.least.map_or(f64::INFINITY, |(least, _)| least)
    }

    /// The least minimum so far, however little the values rise from it, or ∞.
    pub(super) fn shallow(&self) -> f64 {
        self.shallow
    }

    /// Takes the next value; the minimum that it confirms.
    pub(super) fn feed(&mut self, time_s: f64, value: f64) -> Option<f64> {
        self.peak = self.peak.max(value);
        let onward = if self.falling { value <= self.turn } else { value >= self.turn };
        if onward || self.turn.is_nan() {
            (self.turn, self.turn_s) = (value, time_s);
            return None;
        }
        let minimum = self.falling.then_some(self.turn);
        self.shallow = minimum.map_or(self.shallow, |turn| self.shallow.min(turn));
        if !((value - self.turn).abs() > self.slack) {
            return None;
        }
        if let Some(turn) = minimum {
            self.take(self.turn_s, turn);
        }
        self.falling = !self.falling;
        (self.turn, self.turn_s) = (value, time_s);
        minimum
    }

    /// The next values may be off those before by so much.
    pub(super) fn widen(&mut self, slack: f64) {
        self.slack = self.slack.max(slack);
    }

    /// When the value was last that at which it may turn.
    pub(super) fn turn_s(&self) -> f64 {
        self.turn_s
    }

    /// Largest value so far.
    pub(super) fn peak(&self) -> f64 {
        self.peak
    }

    /// Takes a value as a minimum.
    pub(super) fn take(&mut self, time_s: f64, value: f64) {
        if self.least.is_none_or(|(least, _)| value < least) {
            self.least = Some((value, time_s));
        }
    }

    /// Starts anew after a stretch without values.
    pub(super) fn interrupt(&mut self) {
        (self.falling, self.turn) = (false, f64::NAN);
    }

    /// The least minimum of an interface's margin in stick, or of its speed in slip over its largest value.
    pub(super) fn least(&self, kind: DecisionKind, interface: usize) -> Option<ClosestCall> {
        let (least, time_s) = self.least?;
        let scale = if kind == DecisionKind::Stick { 1.0 } else { self.peak };
        (scale > 0.0).then(|| ClosestCall { margin: least / scale, time_s, kind, interface })
    }
}
