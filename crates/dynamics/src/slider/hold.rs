//! What holds at rest: the forces that friction carries, an interval in one direction and a disc in two.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::branch::{Restraint, SlipForce};
use super::rate::Coefficient;
use super::{Direction, Pressing};
use crate::linear::lanes::{eight, greatest, least};
use crate::linear::polynomial::{DEGREE, Polynomial, ZERO, curvature_bound};

/// What holds the block at rest: friction carries `low N ≤ T ≤ high N`, where
/// `T = demand + force + of_normal N`, or of the normal force that it follows in place of `N`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hold {
    /// Force of springs and elastic stop in N.
    pub(crate) force_n: f64,
    /// Force over the normal force.
    pub(crate) of_normal: f64,
    /// What friction holds, over the normal force: `−μ_s⁺` and `μ_s⁻`.
    pub(super) friction: [f64; 2],
    pub(super) pressing: Pressing,
    /// Whether a rigid stop holds what friction cannot: a push of the ground towards −x (the block
    /// leans on the stop towards +x), and one towards +x.
    pub(crate) bears_on_stop: [bool; 2],
}

impl Hold {
    /// Friction alone, of one coefficient.
    pub(crate) fn of_friction(coefficient: f64) -> Self {
        let friction = [-coefficient, coefficient];
        let pressing = Pressing::default();
        Self { force_n: 0.0, of_normal: 0.0, friction, pressing, bears_on_stop: [false; 2] }
    }

    /// What holds off rigid stops.
    pub(crate) fn off_stops(self) -> Self {
        Self { bears_on_stop: [false; 2], ..self }
    }

    /// What springs and stops do at rest, as a force in slip is said.
    pub(crate) fn force(&self) -> SlipForce {
        SlipForce {
            restraint: Restraint::default(),
            is_pressed: false,
            force_n: self.force_n,
            of_normal: self.of_normal,
            of_normal_s: 0.0,
            is_friction: false,
            sign: 0.0,
            coefficient: Coefficient::Linear { at_rest: 0.0, slope_s_per_m: 0.0 },
            pressing: self.pressing,
        }
    }

    /// The forces that friction alone holds under a normal force.
    #[inline(always)]
    pub(crate) fn friction_n(&self, normal_n: f64) -> [f64; 2] {
        let pressing_n = self.pressing.of(normal_n);
        self.friction.map(|bound| bound * pressing_n)
    }

    /// The same under eight normal forces, which friction itself follows.
    #[inline(always)]
    pub(crate) fn friction_of_eight<S: Simd>(&self, simd: S, normal_n: f64x8<S>) -> [f64x8<S>; 2] {
        let [low, high] = self.friction;
        [normal_n * eight(simd, low), normal_n * eight(simd, high)]
    }

    /// The forces between which the block stays under a normal force.
    #[inline(always)]
    pub(crate) fn holds_n(&self, normal_n: f64) -> [f64; 2] {
        let [low, high] = self.friction_n(normal_n);
        [
            if self.bears_on_stop[0] { f64::NEG_INFINITY } else { low },
            if self.bears_on_stop[1] { f64::INFINITY } else { high },
        ]
    }

    /// How far a force is beyond what friction alone holds, negative within, and the width of that.
    #[inline(always)]
    pub(crate) fn excess_and_width_n(&self, force_n: f64, normal_n: f64) -> [f64; 2] {
        let [low, high] = self.friction_n(normal_n);
        [greatest(force_n - high, low - force_n), high - low]
    }

    /// The force that friction alone holds against any direction, from the least normal force.
    #[inline(always)]
    pub(crate) fn least_n(&self, normal_n: f64) -> f64 {
        let [low, high] = self.friction;
        least(high, -low) * self.pressing.of(normal_n)
    }

    /// The largest force that friction alone holds; none where springs of surfaces hold any.
    pub(crate) fn largest_n(&self, normal_n: f64) -> f64 {
        let finite =
            self.friction.iter().map(|bound| bound.abs()).filter(|bound| bound.is_finite());
        finite.fold(0.0, f64::max) * self.pressing.of(normal_n)
    }

    /// What friction holds against sliding in a direction, over the normal force.
    #[inline(always)]
    pub(super) fn size(&self, direction: Direction) -> f64 {
        direction.of([-self.friction[0], self.friction[1]])
    }

    /// What friction holds against sliding in a direction.
    #[inline(always)]
    pub(crate) fn against_n(&self, direction: Direction, normal_n: f64) -> f64 {
        self.size(direction) * self.pressing.of(normal_n)
    }

    /// How far that departs from its chord over a part of a unit at most, under a normal force and its change over it.
    #[inline(always)]
    pub(crate) fn bend_n(&self, direction: Direction, normal: [f64; 2], part: f64) -> f64 {
        if self.pressing.is_plain() {
            return 0.0;
        }
        let curvature = curvature_bound(&self.pressing.series(normal));
        0.125 * self.size(direction) * curvature * (part * part)
    }

    /// Whether a force can make the block slide in a direction.
    pub(crate) fn gives(&self, direction: Direction) -> bool {
        self.size(direction).is_finite() && !direction.of(self.bears_on_stop)
    }

    /// How far a demand and a normal force, linear in time, leave the block from sliding in a direction:
    /// positive where friction holds.
    #[inline(always)]
    pub(crate) fn distance(
        &self,
        demand: &Polynomial,
        normal_n: [f64; 2],
        direction: Direction,
    ) -> Polynomial {
        let (sign, size) = (direction.sign(), self.size(direction));
        let pressing_n = self.pressing.series(normal_n);
        core::array::from_fn(|k| sign * demand[k] + size * pressing_n[k])
    }

    /// Where the block rests against a rigid stop, or between two: how much of its push towards each friction cannot take,
    /// positive where that stop takes some; and the sign of that push.
    pub(crate) fn beyond_friction(
        &self,
        asked: &Polynomial,
        normal_n: [f64; 2],
    ) -> impl Iterator<Item = (f64, Polynomial)> + use<> {
        let pressing_n = self.pressing.series(normal_n);
        let sides = [0, 1].map(|side| {
            let (sign, bound) = (if side == 0 { -1.0 } else { 1.0 }, self.friction[side]);
            let beyond = core::array::from_fn(|k| sign * asked[k] - sign * (bound * pressing_n[k]));
            self.bears_on_stop[side].then_some((sign, beyond))
        });
        sides.into_iter().flatten()
    }

    /// Whether friction holds a force that it is asked for, eq. (4); at the bound it does. Else the
    /// direction in which the block slides, against the force, eq. (3).
    #[inline(always)]
    pub(crate) fn gives_way(&self, force_n: f64, normal_n: f64) -> Option<Direction> {
        let [low, high] = self.holds_n(normal_n);
        if force_n > high {
            Some(Direction::Negative)
        } else if force_n < low {
            Some(Direction::Positive)
        } else {
            None
        }
    }

    /// How near a decision about a force was, over what friction holds; none where it holds nothing,
    /// or a stop holds.
    pub(crate) fn margin(&self, force_n: f64, normal_n: f64) -> Option<f64> {
        let [low, high] = self.holds_n(normal_n);
        let margin = if low <= 0.0 && high >= 0.0 {
            let bound = if force_n < 0.0 { -low } else { high };
            if bound <= 0.0 {
                return None;
            }
            (1.0 - force_n.abs() / bound).abs()
        } else {
            // The springs of surfaces push the block back.
            let [a, b] = self.friction_n(normal_n).map(f64::abs);
            ((force_n - high).max(low - force_n) / a.max(b)).abs()
        };
        Some(margin).filter(|margin| margin.is_finite())
    }
}

/// What holds a block in two directions: friction carries `|p| ≤ of_normal N`, of the pushes `p` that it is asked
/// to carry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Disc {
    pub(super) of_normal: f64,
    pub(super) pressing: Pressing,
}

impl Disc {
    /// The same for pushes times a factor.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self { of_normal: factor * self.of_normal, ..self }
    }

    /// Its radius under a normal force.
    #[inline(always)]
    pub(crate) fn radius(&self, normal_n: f64) -> f64 {
        self.of_normal * self.pressing.of(normal_n)
    }

    /// The part of a unit over which [`squared_radius`](Self::squared_radius) is good to rounding.
    pub(crate) fn reach(&self, normal_n: [f64; 2]) -> f64 {
        self.pressing.reach(normal_n)
    }

    /// How far a push of a size is beyond it, negative within; at the bound friction holds.
    pub(crate) fn excess(&self, push: f64, normal_n: f64) -> f64 {
        push - self.radius(normal_n)
    }

    /// How near a decision about that was, over what friction holds; none where it holds nothing.
    pub(crate) fn margin(&self, push: f64, normal_n: f64) -> Option<f64> {
        let radius = self.radius(normal_n);
        (radius > 0.0).then(|| self.excess(push, normal_n).abs() / radius)
    }

    /// The square of the radius under a normal force and its change over a unit, by powers of the part of it.
    pub(crate) fn squared_radius(&self, normal_n: [f64; 2]) -> Polynomial {
        let radius = self.pressing.series(normal_n).map(|n| self.of_normal * n);
        let last = if self.pressing.is_plain() { 2 } else { DEGREE };
        let mut square = ZERO;
        for (k, square) in square[..=last].iter_mut().enumerate() {
            *square = (0..=k).fold(0.0, |sum, j| sum + radius[j] * radius[k - j]);
        }
        square
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excess_is_how_far_a_force_is_beyond_what_holds_and_none_at_the_bound() {
        let hold = Hold { friction: [-0.25, 0.5], ..Hold::of_friction(0.0) };
        for (force_n, excess_n) in [(6.0, 2.0), (4.0, 0.0), (0.0, -2.0), (-2.0, 0.0), (-5.0, 3.0)] {
            assert_eq!(hold.excess_and_width_n(force_n, 8.0), [excess_n, 6.0]);
            assert_eq!(hold.gives_way(force_n, 8.0).is_some(), excess_n > 0.0);
        }
        let disc = Disc { of_normal: 0.25, pressing: Pressing::default() }.times(2.0);
        assert_eq!([3.0, 4.0, 5.0].map(|push| disc.excess(push, 8.0)), [-1.0, 0.0, 1.0]);
        assert_eq!((disc.margin(5.0, 8.0), disc.margin(5.0, 0.0)), (Some(0.25), None));
        let [c, b, a, ..] = disc.squared_radius([8.0, -4.0]);
        assert_eq!(c + 0.5 * (b + 0.5 * a), disc.radius(6.0) * disc.radius(6.0));
    }
}
