//! Decisions that came close: between knots, and in which order.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::collocation::POINTS;
use super::group::Step;
use super::lane::{Eight, all, larger, smaller};
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
pub(super) struct Dips {
    slack: f64,
    /// The time up to which values were fed, in s.
    fed_s: f64,
    falling: bool,
    turn: f64,
    turn_s: f64,
    /// Largest value.
    peak: f64,
    least: Option<(f64, f64)>,
}

impl Dips {
    pub(super) fn new(slack: f64) -> Self {
        Self {
            slack,
            fed_s: 0.0,
            falling: false,
            turn: f64::NAN,
            turn_s: 0.0,
            peak: 0.0,
            least: None,
        }
    }

    /// Takes a value that is no minimum.
    pub(super) fn see(&mut self, value: f64) {
        self.peak = self.peak.max(value);
    }

    /// The least minimum so far, or ∞.
    pub(super) fn so_far(&self) -> f64 {
        self.least.map_or(f64::INFINITY, |(least, _)| least)
    }

    /// Takes the next value; the minimum that it confirms.
    pub(super) fn feed(&mut self, time_s: f64, value: f64) -> Option<f64> {
        self.peak = self.peak.max(value);
        let onward = if self.falling { value <= self.turn } else { value >= self.turn };
        let mut minimum = None;
        if onward || self.turn.is_nan() {
            (self.turn, self.turn_s) = (value, time_s);
        } else if (value - self.turn).abs() > self.slack {
            if self.falling {
                self.take(self.turn_s, self.turn);
                minimum = Some(self.turn);
            }
            self.falling = !self.falling;
            (self.turn, self.turn_s) = (value, time_s);
        }
        minimum
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

    /// Values of an interval follow; perhaps none of the one before did.
    pub(super) fn resume(&mut self, [from_s, to_s]: [f64; 2]) {
        if self.fed_s != from_s {
            self.interrupt();
        }
        self.fed_s = to_s;
    }

    /// The least minimum of an interface's margin in stick, or of its speed in slip over its largest value.
    pub(super) fn least(&self, kind: DecisionKind, interface: usize) -> Option<ClosestCall> {
        let (least, time_s) = self.least?;
        let scale = if kind == DecisionKind::Stick { 1.0 } else { self.peak };
        (scale > 0.0).then(|| ClosestCall { margin: least / scale, time_s, kind, interface })
    }
}

/// What the points of intervals say of a margin or a speed, one after another.
#[derive(Clone, Default)]
pub(super) struct Extremes {
    first: Eight,
    least: Eight,
    most: Eight,
    last: Eight,
    /// 1 where it has risen, and fallen.
    rises: Eight,
    falls: Eight,
}

/// What is told of the decisions of an interface in an interval: its margin in stick, its speed in slip.
#[derive(Clone, Copy, Default)]
pub(super) struct Watch<T> {
    /// At both ends.
    pub(super) ends: [T; 2],
    /// The least at any point, and what it cannot fall below in between where it is not monotone.
    pub(super) least: T,
    pub(super) low: T,
    /// Largest speed.
    pub(super) fastest: T,
}

/// The points of a step: `T` or the acceleration of contents in stick, the speed in the direction claimed
/// in slip, interface by interface; then `s` and `ṡ`.
pub(super) struct Points {
    pub(super) knot: usize,
    pub(super) step: Step,
    pub(super) values: Vec<[f64; POINTS]>,
}

impl Watch<Eight> {
    pub(super) fn lane(&self, lane: usize) -> Watch<f64> {
        Watch {
            ends: [self.ends[0].0[lane], self.ends[1].0[lane]],
            least: self.least.0[lane],
            low: self.low.0[lane],
            fastest: self.fastest.0[lane],
        }
    }
}

impl Extremes {
    #[inline(always)]
    pub(super) fn start<S: Simd>(&mut self, first: f64x8<S>) {
        for place in [&mut self.first, &mut self.least, &mut self.most, &mut self.last] {
            place.store(first);
        }
        (self.rises, self.falls) = (Eight::ZERO, Eight::ZERO);
    }

    #[inline(always)]
    pub(super) fn take<S: Simd>(&mut self, simd: S, value: f64x8<S>) {
        let (one, last) = (all(simd, 1.0), self.last.load(simd));
        self.least.store(smaller(self.least.load(simd), value));
        self.most.store(larger(self.most.load(simd), value));
        self.rises.store(value.simd_gt(last).select(one, self.rises.load(simd)));
        self.falls.store(value.simd_lt(last).select(one, self.falls.load(simd)));
        self.last.store(value);
    }

    /// The least, and what it cannot fall below in between.
    #[inline(always)]
    pub(super) fn tell<S: Simd>(&self, simd: S, told: &mut Watch<Eight>) {
        let least = self.least.load(simd);
        let range = self.most.load(simd) - least;
        let flat = range.simd_le(all(simd, 4e-12));
        // Between two points the polynomial falls below both by less than a tenth of its range.
        let low = (self.rises.load(simd) * self.falls.load(simd))
            .simd_gt(all(simd, 0.0))
            .select(least - range * all(simd, 0.1), all(simd, f64::INFINITY));
        told.low.store(flat.select(least, low));
        (told.least, told.ends) = (self.least, [self.first, self.last]);
    }
}

/// Intervals that were looked at by their paths, and how many have been recalled in order of time.
#[derive(Default)]
pub(super) struct Watched {
    /// In order.
    pub(super) knots: Vec<usize>,
    /// One an interface.
    pub(super) watch: Vec<Watch<f64>>,
    pub(super) recalled: usize,
    /// Points of those in which a decision may have been close.
    pub(super) points: Vec<Points>,
    pub(super) looked_at: usize,
}
