//! One sample by its Taylor series, with events in it where they are beyond doubt.
//!
//! What is not (two roots near each other, an event on a sample, a demand at its bound) goes the
//! long way from where it turns up.

use fearless_simd::f64x4;
use fearless_simd::prelude::*;

use super::lanes::{four, least};
use super::peaks::Part;
use super::series::Series;
use super::walk::Walk;
use crate::friction::Direction;
use crate::response::{Event, EventKind, Mode};
use crate::solver::slider::Start;

/// Nearer to an end of a piece, or a demand nearer to its bound, relative to it, is in doubt.
const DOUBT: f64 = 1e-9;

/// Longest correction of a root that is made by derivatives, in pieces.
const SHORT: f64 = 2e-5;

/// Events in a sample after which it goes the long way.
const MOST_EVENTS: u32 = 8;

/// Where a segment has led.
enum Led {
    /// To the end of the piece.
    Through,
    /// To an event, this part of the piece after the segment's start.
    Event(f64),
    /// Nowhere: what comes is in doubt.
    Doubt,
}

/// A segment: from `at` in a piece to its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) rest: f64,
    /// Acceleration at its start and its change over a whole piece.
    pub(super) a: f64,
    pub(super) change: f64,
}

impl<S: Simd> Walk<'_, S> {
    /// Walks through one sample; the time in it at which doubt arises.
    #[inline(always)]
    pub(super) fn step(&mut self, sample: usize) -> Option<f64> {
        if self.is_due() {
            return Some(0.0);
        }
        let pieces = self.tables.pieces;
        let [from, to] = [self.ground.acceleration[sample], self.ground.acceleration[sample + 1]];
        let change = if pieces == 1 { to - from } else { (to - from) / pieces as f64 };
        let mut events = 0;
        for piece in 0..pieces {
            let start_a = from + change * piece as f64;
            let (mut at, mut start) = (0.0, None);
            loop {
                let segment = Segment { rest: 1.0 - at, a: start_a + change * at, change };
                let place = Part { sample, segment, x: self.carry.x, mode: self.carry.mode };
                let fresh = piece == 0 && at == 0.0;
                let led = match self.carry.mode {
                    Mode::Stick => self.stick_segment(&place, fresh),
                    Mode::Slip(direction) => self.slip_segment(&place, direction, start, fresh),
                };
                let t = match led {
                    Led::Through => break,
                    Led::Event(t) => t,
                    Led::Doubt => {
                        self.carry.start = start;
                        let part = piece as f64 + at;
                        return Some(part * self.tables.piece_s);
                    }
                };
                at += t;
                let at_s = (piece as f64 + at) * self.tables.piece_s;
                events += 1;
                start = None;
                if events > MOST_EVENTS || !self.decide(&place, t, at_s, &mut start) {
                    return Some(at_s);
                }
            }
        }
        None
    }

    /// A segment of stick.
    #[inline(always)]
    fn stick_segment(&mut self, place: &Part, fresh: bool) -> Led {
        let (simd, tables, plant) = (self.simd, self.tables, &self.tables.plant);
        let (x, segment) = (place.x, &place.segment);
        let rest = segment.rest;
        let [low, high] = self.ground.bounds;
        let series = Series::<S>::new::<false>(simd, &tables.stick.series, x, segment, 0.0);
        let end = series.at(simd, rest);
        let bend = plant.participation * plant.restoring(series.bend.as_array());
        let hidden = 0.125 * bend * (rest * rest);
        let demand = plant.demand_n(&x, segment.a);
        let end_demand = plant.demand_n(end.as_array(), segment.a + segment.change * rest);
        let above = least(high - demand, high - end_demand) > hidden;
        let below = least(demand - low, end_demand - low) > hidden;
        if above && below {
            self.note_start(place, fresh);
            self.look::<false>(place, &series, end, rest, [demand, end_demand]);
            self.carry.x = end.to_array();
            return Led::Through;
        }
        // A release is beyond doubt where the distance from one bound falls all the way.
        let (sign, bound) = if below { (1.0, high) } else { (-1.0, low) };
        let distance = sign * (bound - demand);
        let [of_1, of_2, of_3, of_4] =
            series.leading().map(|c| sign * plant.participation * plant.restoring(&c));
        let slope = of_1 - sign * plant.block_mass_kg * segment.change;
        let one_way = (above || below)
            && distance > DOUBT * bound.abs()
            && sign * (bound - end_demand) < 0.0
            && crosses_once(slope, 2.0 * of_2, bend, rest);
        if !one_way {
            return Led::Doubt;
        }
        let mut t = guess([distance, slope, of_2, of_3, of_4]);
        let (m, l) = (sign * plant.block_mass_kg, sign * plant.participation);
        for _ in 0..4 {
            if !(t > 0.0 && t < rest) {
                return Led::Doubt;
            }
            let y = series.at(simd, t);
            let derivatives = series.derivatives(simd, t);
            let [f1, f2] = derivatives.map(|y| l * plant.restoring(y.as_array()));
            let a = segment.a + segment.change * t;
            let g = sign * bound - sign * plant.demand_n(y.as_array(), a);
            let d = halley(g, f1 - m * segment.change, f2);
            t += d;
            if d.abs() < SHORT {
                let y = later(simd, y, derivatives, d);
                return self.event::<false>(place, fresh, &series, t, y, [demand, bound]);
            }
        }
        Led::Doubt
    }

    /// A segment of slip.
    #[inline(always)]
    fn slip_segment(
        &mut self,
        place: &Part,
        direction: Direction,
        start: Option<Start>,
        fresh: bool,
    ) -> Led {
        let (simd, tables) = (self.simd, self.tables);
        let (x, segment) = (place.x, &place.segment);
        let (sign, force, rest) = (direction.sign(), self.force(direction), segment.rest);
        let series = Series::<S>::new::<true>(simd, &tables.slip.series, x, segment, force);
        let end = series.at(simd, rest);
        let bend = series.bend.as_array()[1];
        let [of_1, of_2, of_3, of_4] = series.leading().map(|c| sign * c[1]);
        let (speed, end_speed) = (sign * x[1], sign * end.as_array()[1]);
        let slides = match start {
            None => least(speed, end_speed) > 0.125 * bend * (rest * rest),
            // The zero at the start is no stop: what is left after dividing by it stays positive.
            Some(start) if start.order == 1 => {
                start.acceleration * tables.piece_s > 0.5 * bend * rest
            }
            Some(_) => of_2 > rest * (bend - 2.0 * of_2) * (1.0 / 6.0),
        };
        if slides {
            self.note_start(place, fresh);
            self.look::<true>(place, &series, end, rest, [force; 2]);
            self.carry.x = end.to_array();
            return Led::Through;
        }
        let one_way = start.is_none()
            && speed > 0.0
            && end_speed < 0.0
            && crosses_once(of_1, 2.0 * of_2, bend, rest);
        if !one_way {
            return Led::Doubt;
        }
        let mut t = guess([speed, of_1, of_2, of_3, of_4]);
        for _ in 0..4 {
            if !(t > 0.0 && t < rest) {
                return Led::Doubt;
            }
            let y = series.at(simd, t);
            let derivatives = series.derivatives(simd, t);
            let [g1, g2] = derivatives.map(|y| sign * y.as_array()[1]);
            let d = halley(sign * y.as_array()[1], g1, g2);
            t += d;
            if d.abs() < SHORT {
                let y = later(simd, y, derivatives, d);
                return self.event::<true>(place, fresh, &series, t, y, [force; 2]);
            }
        }
        Led::Doubt
    }

    /// An event at a part `t` of the piece after the segment's start, with the state there.
    #[inline(always)]
    fn event<const SLIP: bool>(
        &mut self,
        place: &Part,
        fresh: bool,
        series: &Series<S>,
        t: f64,
        x: f64x4<S>,
        friction: [f64; 2],
    ) -> Led {
        if !(t > DOUBT && t < place.segment.rest - DOUBT) {
            return Led::Doubt;
        }
        self.note_start(place, fresh);
        self.look::<SLIP>(place, series, x, t, friction);
        self.carry.x = x.to_array();
        if SLIP {
            self.carry.x[1] = 0.0;
        }
        Led::Event(t)
    }

    /// What follows an event: a release starts to slide, a stop sticks or turns round. Whether that
    /// is beyond doubt; if not, nothing has happened.
    #[inline(always)]
    fn decide(&mut self, place: &Part, t: f64, at_s: f64, start: &mut Option<Start>) -> bool {
        let sample = place.sample;
        let plant = &self.tables.plant;
        let [low, high] = self.ground.bounds;
        let time_s = self.ground.times_s[sample] + at_s;
        let s = self.carry.x[0];
        let a = place.segment.a + place.segment.change * t;
        let demand = plant.demand_n(&self.carry.x, a);
        let before = place.mode;
        let (mode, kind) = match before {
            Mode::Stick => {
                let (direction, bound) = if high - demand < demand - low {
                    (Direction::Negative, high)
                } else {
                    (Direction::Positive, low)
                };
                let drop = bound.abs() - self.force(direction).abs();
                let acceleration = drop / plant.block_mass_kg;
                let order = if acceleration > 0.0 { 1 } else { 2 };
                *start = Some(Start { order, acceleration });
                (Mode::Slip(direction), EventKind::Slip)
            }
            Mode::Slip(_) => {
                let doubt = DOUBT * (high - low);
                let turned = if demand > high + doubt {
                    Some(Direction::Negative)
                } else if demand < low - doubt {
                    Some(Direction::Positive)
                } else if demand < high - doubt && demand > low + doubt {
                    None
                } else {
                    return false;
                };
                match turned {
                    None => (Mode::Stick, EventKind::Stick),
                    Some(direction) if before == Mode::Slip(direction) => return false,
                    Some(direction) => {
                        let excess = demand.abs() - self.force(direction).abs();
                        let acceleration = excess / plant.block_mass_kg;
                        *start = Some(Start { order: 1, acceleration });
                        (Mode::Slip(direction), EventKind::Reversal)
                    }
                }
            }
        };
        self.note_event(sample, at_s);
        if before != Mode::Stick {
            self.carry.sliding.decide(self.ground.hold.margin(demand, self.ground.normal_n));
            self.carry.sliding.end(time_s, s);
        }
        if mode != Mode::Stick {
            self.carry.sliding.begin(time_s, s);
        }
        self.carry.mode = mode;
        self.carry.events.push(Event {
            time_s,
            kind,
            mode,
            sliding_displacement_m: s,
            interface: 0,
        });
        self.note_event(sample, at_s);
        true
    }

    /// Records the start of a sample that is known to go this way.
    #[inline(always)]
    fn note_start(&mut self, place: &Part, fresh: bool) {
        if self.records && fresh {
            self.record_now(place.sample, 0.0, true);
        }
    }

    /// Records one side of an event.
    #[inline(always)]
    fn note_event(&mut self, sample: usize, at_s: f64) {
        if self.records {
            self.record_now(sample, at_s, false);
        }
    }
}

/// Whether a value that is positive at the start and negative at the end, with these derivatives at
/// the start and a bound on the second, crosses zero once: it falls all the way, or is concave.
#[inline(always)]
fn crosses_once(slope: f64, second: f64, bend: f64, rest: f64) -> bool {
    slope + bend * rest < 0.0 || second < -(bend - second.abs())
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
