//! An event sample by its Taylor series, with events in it where they are beyond doubt.
//!
//! What is ambiguous (two roots near each other, an event on a sample, a demand at its bound) is left to
//! event stepping, from where it turns up.

use fearless_simd::f64x4;
use fearless_simd::prelude::*;

use super::ahead::Ahead;
use super::lanes::{four, greatest, least};
use super::series::{Span, StoreySeries};
use crate::response::Mode;
use crate::slider::Direction;
use crate::solver::course::{AMBIGUOUS, Instant};
use crate::solver::slider::Start;

/// A slip that starts with less than this part of what friction makes is ambiguous if it ends at once.
const CLEAR: f64 = 1e-2;

/// Longest correction of a root that is made by derivatives, in pieces: the next term of the state is below
/// rounding.
const SHORT: f64 = 2e-5;

/// Events in a sample after which it goes by event stepping.
const MOST_EVENTS: u32 = 8;

/// The motion of one phase over a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) sample: usize,
    pub(super) span: Span,
    pub(super) mode: Mode,
    /// State at its start.
    pub(super) x: [f64; 4],
}

/// How a segment ends.
enum End {
    /// With the piece.
    Piece,
    /// With an event, so many pieces after its start.
    Event(f64),
    /// Nobody knows: what comes is ambiguous.
    Ambiguous,
}

impl<S: Simd> Ahead<'_, '_, S> {
    /// Takes one sample; the time in it from where on it is ambiguous.
    #[inline(always)]
    pub(super) fn step(&mut self, sample: usize) -> Option<f64> {
        if self.has_pending_decision() {
            return Some(0.0);
        }
        let (pieces, a) = (self.of.tables.pieces, self.of.ground.acceleration);
        let piece_s = self.of.tables.slip.series.piece_s;
        let [from, to] = [a[sample], a[sample + 1]];
        let change = if pieces == 1 { to - from } else { (to - from) / pieces as f64 };
        let mut events = 0;
        for piece in 0..pieces {
            let start_a = from + change * piece as f64;
            let mut at = 0.0;
            loop {
                let span = Span { rest: 1.0 - at, a: start_a + change * at, change };
                let (mode, x) = (self.shared.course.block.mode, *self.shared.x);
                let segment = Segment { sample, span, mode, x };
                let at_sample = piece == 0 && at == 0.0;
                let end = match mode {
                    Mode::Stick => self.stick_segment(&segment, at_sample),
                    Mode::Slip(direction) => self.slip_segment(&segment, direction, at_sample),
                };
                match end {
                    End::Piece => break,
                    End::Event(t) => at += t,
                    End::Ambiguous => return Some((piece as f64 + at) * piece_s),
                }
                let at_s = (piece as f64 + at) * piece_s;
                events += 1;
                if events > MOST_EVENTS || !self.decide(&segment, start_a + change * at, at_s) {
                    return Some(at_s);
                }
            }
        }
        None
    }

    /// A segment of stick.
    #[inline(always)]
    fn stick_segment(&mut self, segment: &Segment, at_sample: bool) -> End {
        let (simd, storey, x) = (self.simd, &self.of.tables.storey, segment.x);
        let Span { rest, a, change } = segment.span;
        let [low, high] = self.of.bounds_n;
        let table = &self.of.tables.stick.series;
        let series = StoreySeries::<S>::new::<false>(simd, table, x, &segment.span, 0.0);
        let end = series.at(rest);
        let curvature = storey.participation * storey.restoring(series.curvature.as_array());
        let hidden = 0.125 * curvature * (rest * rest);
        let demand = storey.required_friction_n(&x, a);
        let end_demand = storey.required_friction_n(end.as_array(), a + change * rest);
        let above = least(high - demand, high - end_demand) > hidden;
        let below = least(demand - low, end_demand - low) > hidden;
        if above && below {
            return self.through::<false>(segment, at_sample, &series, end, [demand, end_demand]);
        }
        // A release is beyond doubt where the distance from one bound falls all the way.
        let (sign, bound) = if below { (1.0, high) } else { (-1.0, low) };
        let (m, l) = (sign * storey.block_mass_kg, sign * storey.participation);
        let distance = sign * (bound - demand);
        let [c1, c2, c3, c4] = series.leading_storey();
        let (c1, c2) = (l * storey.restoring_of(c1), l * storey.restoring_of(c2));
        let (c3, c4) = (l * storey.restoring_of(c3), l * storey.restoring_of(c4));
        let slope = c1 - m * change;
        let is_simple = (above || below)
            && distance > AMBIGUOUS * bound.abs()
            && sign * (bound - end_demand) < 0.0
            && crosses_once(slope, 2.0 * c2, curvature, rest);
        if !is_simple {
            return End::Ambiguous;
        }
        let mut t = guess([distance, slope, c2, c3, c4]);
        for _ in 0..4 {
            if !(t > 0.0 && t < rest) {
                return End::Ambiguous;
            }
            let velocities = series.velocities(t);
            let y = series.state(t, velocities);
            let derivatives = series.derivatives(t, velocities);
            let f1 = l * storey.restoring(derivatives[0].as_array());
            let f2 = l * storey.restoring(derivatives[1].as_array());
            let g = sign * bound - sign * storey.required_friction_n(y.as_array(), a + change * t);
            let d = halley(g, f1 - m * change, f2);
            t += d;
            if d.abs() < SHORT {
                let y = later(simd, y, derivatives, d);
                return self.event::<false>(segment, at_sample, &series, (t, y), [demand, bound]);
            }
        }
        End::Ambiguous
    }

    /// A segment of slip.
    #[inline(always)]
    fn slip_segment(&mut self, segment: &Segment, direction: Direction, at_sample: bool) -> End {
        let (simd, tables, x) = (self.simd, self.of.tables, segment.x);
        let (sign, rest) = (direction.sign(), segment.span.rest);
        let force_n = self.force_n(segment.mode);
        let table = &tables.slip.series;
        let series = StoreySeries::<S>::new::<true>(simd, table, x, &segment.span, force_n);
        let end = series.velocities(rest);
        let curvature = series.curvature.as_array()[1];
        let [c1, c2, c3, c4] = series.leading_speed();
        let (c1, c2, c3, c4) = (sign * c1, sign * c2, sign * c3, sign * c4);
        let (speed, end_speed) = (sign * x[1], sign * end.as_array()[0]);
        // A slip that has just started is divided by the zero at its start: q(t) = |ṡ|/t^m. With
        // D = Σ k (k − 1) |c_k| the second derivative of q is at most D, where m = 1 it is at most
        // D − 2 |c₂|, and where m = 2 at most D − 2 |c₂| − 6 |c₃|.
        let (q, end_q, curvature, clear) = match self.shared.course.block.start {
            None => ([speed, c1, c2, c3, c4], end_speed, curvature, 0.0),
            Some(Start { order: 1, acceleration }) => {
                let q = [acceleration * table.piece_s, c2, c3, c4, 0.0];
                (q, end_speed / rest, curvature - 2.0 * c2.abs(), CLEAR)
            }
            Some(_) => {
                let curvature = curvature - (2.0 * c2.abs() + 6.0 * c3.abs());
                ([c2, c3, c4, 0.0, 0.0], end_speed / (rest * rest), curvature, CLEAR)
            }
        };
        // Speeds are known to some ulp of what friction alone makes of them.
        let of_friction = greatest(-self.of.bounds_n[0], self.of.bounds_n[1])
            * (tables.storey.per_block_mass * table.piece_s);
        let lower = least(q[0], end_q);
        let stays = lower > 0.125 * curvature * (rest * rest)
            || lower > 0.0 && is_least_at_ends(q[1], 2.0 * q[2], curvature, rest);
        if stays && end_speed > AMBIGUOUS * (of_friction * rest) {
            self.shared.course.block.start = None;
            let end = series.state(rest, end);
            return self.through::<true>(segment, at_sample, &series, end, [force_n; 2]);
        }
        let is_simple = q[0] > clear * of_friction
            && end_q < 0.0
            && crosses_once(q[1], 2.0 * q[2], curvature, rest);
        if !is_simple {
            return End::Ambiguous;
        }
        let mut t = guess(q);
        for _ in 0..4 {
            if !(t > 0.0 && t < rest) {
                return End::Ambiguous;
            }
            let velocities = series.velocities(t);
            let derivatives = series.derivatives(t, velocities);
            let (g1, g2) =
                (sign * derivatives[0].as_array()[1], sign * derivatives[1].as_array()[1]);
            let d = halley(sign * velocities.as_array()[0], g1, g2);
            let y = series.state(t, velocities);
            t += d;
            // At the zero at the start the speed rises.
            if d.abs() < SHORT && g1 < 0.0 {
                let y = later(simd, y, derivatives, d);
                return self.event::<true>(segment, at_sample, &series, (t, y), [force_n; 2]);
            }
        }
        End::Ambiguous
    }

    /// Nothing happens up to the end of a segment.
    #[inline(always)]
    fn through<const SLIP: bool>(
        &mut self,
        segment: &Segment,
        at_sample: bool,
        series: &StoreySeries<S>,
        x: f64x4<S>,
        friction_n: [f64; 2],
    ) -> End {
        self.move_to::<SLIP>(segment, at_sample, series, (segment.span.rest, x), friction_n);
        End::Piece
    }

    /// An event so many pieces after a segment's start, with the state there.
    #[inline(always)]
    fn event<const SLIP: bool>(
        &mut self,
        segment: &Segment,
        at_sample: bool,
        series: &StoreySeries<S>,
        (t, x): (f64, f64x4<S>),
        friction_n: [f64; 2],
    ) -> End {
        if !(t > AMBIGUOUS && t < segment.span.rest - AMBIGUOUS) {
            return End::Ambiguous;
        }
        self.move_to::<SLIP>(segment, at_sample, series, (t, x), friction_n);
        if SLIP {
            (self.shared.x[1], self.shared.course.block.start) = (0.0, None);
        }
        End::Event(t)
    }

    #[inline(always)]
    fn move_to<const SLIP: bool>(
        &mut self,
        segment: &Segment,
        at_sample: bool,
        series: &StoreySeries<S>,
        (t, x): (f64, f64x4<S>),
        friction_n: [f64; 2],
    ) {
        if at_sample {
            self.record_now(segment.sample, 0.0, segment.mode);
        }
        self.look::<SLIP>(segment, series, x, t, friction_n);
        *self.shared.x = x.to_array();
    }

    /// What follows the event at the end of a segment, under an acceleration; whether that is beyond doubt.
    /// If not, nothing has happened.
    #[inline(always)]
    fn decide(&mut self, segment: &Segment, a: f64, at_s: f64) -> bool {
        let (sample, storey) = (segment.sample, &self.of.tables.storey);
        let at = Instant {
            time_s: self.of.ground.times_s[sample] + at_s,
            place_m: self.shared.x[0],
            normal_n: self.of.normal_n,
            mass_kg: storey.block_mass_kg,
        };
        let hold = self.hold;
        let demand_n = storey.required_friction_n(self.shared.x, a);
        if segment.mode == Mode::Stick {
            let [low, high] = self.of.bounds_n;
            let is_high = high - demand_n < demand_n - low;
            let direction = if is_high { Direction::Negative } else { Direction::Positive };
            self.shared.course.release(&at, &hold, direction, 1);
        } else if !self.shared.course.stop(&at, &hold, demand_n, false) {
            return false;
        }
        self.record_now(sample, at_s, segment.mode);
        self.record_now(sample, at_s, self.shared.course.block.mode);
        true
    }
}

/// Whether a value with these derivatives at the start and a bound on the second is nowhere less than at
/// one of its ends: it falls or rises all the way, is concave, or is convex and rises at the start.
#[inline(always)]
fn is_least_at_ends(slope: f64, second: f64, curvature: f64, rest: f64) -> bool {
    let bends_one_way = second.abs() > curvature - second.abs();
    slope.abs() > curvature * rest || bends_one_way && (second < 0.0 || slope >= 0.0)
}

/// Whether a value that is positive at the start and negative at the end, with these derivatives at the
/// start and a bound on the second, crosses zero once: it falls all the way, or is concave.
#[inline(always)]
fn crosses_once(slope: f64, second: f64, curvature: f64, rest: f64) -> bool {
    slope + curvature * rest < 0.0 || second < -(curvature - second.abs())
}

/// First falling root by the terms up to the fourth power, or anything: that of the quadratic terms,
/// where the slope is `−root`, corrected twice by the others.
#[inline(always)]
fn guess([c0, c1, c2, c3, c4]: [f64; 5]) -> f64 {
    let root = (c1 * c1 - 4.0 * c0 * c2).sqrt();
    let t = 2.0 * c0 / (root - c1);
    let (per, t2) = (1.0 / root, t * t);
    let first = (c3 + c4 * t) * (t2 * t) * per;
    let change = (3.0 * c3 + 4.0 * (c4 * t)) * t2 + c2 * first;
    t + (first + first * (change * per))
}

/// Halley's correction of a root.
#[inline(always)]
fn halley(g: f64, g1: f64, g2: f64) -> f64 {
    -g * g1 / (g1 * g1 - 0.5 * (g * g2))
}

/// State a little later.
#[inline(always)]
fn later<S: Simd>(simd: S, y: f64x4<S>, [first, second]: [f64x4<S>; 2], d: f64) -> f64x4<S> {
    y + (first * four(simd, d) + second * four(simd, 0.5 * (d * d)))
}
