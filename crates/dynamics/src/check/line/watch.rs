//! What intervals tell of decisions that may have been close.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::collocation::POINTS;
use super::super::lane::{Eight, all, larger, smaller};
use super::group::Step;

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
    pub(super) fn least_into<S: Simd>(&self, simd: S, told: &mut Watch<Eight>) {
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
