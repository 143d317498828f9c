//! One sample by its Taylor series, with events in it where they are beyond doubt.
//!
//! What is not (two roots near each other, an event on a sample, a demand at its bound) goes the
//! long way from where it turns up.

use fearless_simd::f64x4;
use fearless_simd::prelude::*;

use super::lanes::{Four, four, times4};
use super::peaks::Part;
use super::walk::Walk;
use crate::error::SolveError;
use crate::friction::Direction;
use crate::linear::polynomial::DEGREE;
use crate::response::{Event, EventKind, Mode};
use crate::solver::exact::Start;

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

/// Taylor coefficients of the state over a piece from the first on, and their bound on its second
/// derivative.
pub(super) struct Series<S: Simd> {
    x: f64x4<S>,
    pub(super) c: [f64x4<S>; DEGREE],
    pub(super) bend: f64x4<S>,
}

/// A segment: from `at` in a piece to its end.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub(super) rest: f64,
    /// Acceleration at its start and its change over a whole piece.
    pub(super) a: f64,
    pub(super) change: f64,
}

/// What the coefficients of every order are made of.
struct Order<'a, S: Simd> {
    simd: S,
    x: [f64; 4],
    segment: &'a Segment,
    force: f64,
}

impl<S: Simd> Order<'_, S> {
    #[inline(always)]
    fn of<const SLIP: bool>(&self, table: &[Four; 7]) -> f64x4<S> {
        let (simd, x) = (self.simd, self.x);
        let structure = times4(simd, &table[2], x[2]) + times4(simd, &table[3], x[3]);
        let load =
            times4(simd, &table[4], self.segment.a) + times4(simd, &table[5], self.segment.change);
        if SLIP {
            let block = times4(simd, &table[0], x[0]) + times4(simd, &table[1], x[1]);
            (block + structure) + (load + times4(simd, &table[6], self.force))
        } else {
            structure + load
        }
    }
}

impl<S: Simd> Series<S> {
    /// Series of a phase from a state.
    #[inline(always)]
    pub(super) fn new<const SLIP: bool>(
        simd: S,
        table: &[[Four; 7]; DEGREE],
        x: [f64; 4],
        segment: &Segment,
        force: f64,
    ) -> Self {
        let order = Order { simd, x, segment, force };
        // One by one: a loop would not be unrolled.
        let c = [
            order.of::<SLIP>(&table[0]),
            order.of::<SLIP>(&table[1]),
            order.of::<SLIP>(&table[2]),
            order.of::<SLIP>(&table[3]),
            order.of::<SLIP>(&table[4]),
            order.of::<SLIP>(&table[5]),
            order.of::<SLIP>(&table[6]),
            order.of::<SLIP>(&table[7]),
            order.of::<SLIP>(&table[8]),
            order.of::<SLIP>(&table[9]),
            order.of::<SLIP>(&table[10]),
            order.of::<SLIP>(&table[11]),
        ];
        let odd = ((c[1].abs() * four(simd, 2.0) + c[3].abs() * four(simd, 12.0))
            + (c[5].abs() * four(simd, 30.0) + c[7].abs() * four(simd, 56.0)))
            + (c[9].abs() * four(simd, 90.0) + c[11].abs() * four(simd, 132.0));
        let even = ((c[2].abs() * four(simd, 6.0) + c[4].abs() * four(simd, 20.0))
            + (c[6].abs() * four(simd, 42.0) + c[8].abs() * four(simd, 72.0)))
            + c[10].abs() * four(simd, 110.0);
        Self { x: Four(x).load(simd), c, bend: odd + even }
    }

    /// State at a part of the piece.
    #[inline(always)]
    pub(super) fn at(&self, simd: S, t: f64) -> f64x4<S> {
        let t2 = t * t;
        let t4 = t2 * t2;
        let (t, t2, t4) = (four(simd, t), four(simd, t2), four(simd, t4));
        let c = &self.c;
        let p0 = (self.x + c[0] * t) + (c[1] + c[2] * t) * t2;
        let p1 = (c[3] + c[4] * t) + (c[5] + c[6] * t) * t2;
        let p2 = (c[7] + c[8] * t) + (c[9] + c[10] * t) * t2;
        p0 + (p1 + (p2 + c[11] * t4) * t4) * t4
    }
}

impl<S: Simd> Walk<'_, S> {
    /// Walks through one sample.
    #[inline(always)]
    pub(super) fn step(&mut self, sample: usize) -> Result<(), SolveError> {
        if self.is_due() {
            return self.long_way(sample, 0.0);
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
                        return self.long_way(sample, part * self.tables.piece_s);
                    }
                };
                at += t;
                let at_s = (piece as f64 + at) * self.tables.piece_s;
                events += 1;
                start = None;
                if events > MOST_EVENTS || !self.decide(&place, t, at_s, &mut start) {
                    return self.long_way(sample, at_s);
                }
            }
        }
        Ok(())
    }

    /// A segment of stick.
    #[inline(always)]
    fn stick_segment(&mut self, place: &Part, fresh: bool) -> Led {
        let (simd, tables, plant) = (self.simd, self.tables, &self.tables.plant);
        let (x, segment) = (place.x, &place.segment);
        let rest = segment.rest;
        let [low, high] = self.ground.bounds;
        let series = Series::<S>::new::<false>(simd, &tables.stick.series, x, segment, 0.0);
        let end = series.at(simd, rest).to_array();
        let bend = plant.participation * plant.restoring(series.bend.as_array());
        let hidden = 0.125 * bend * (rest * rest);
        let demand = plant.demand_n(&x, segment.a);
        let end_demand = plant.demand_n(&end, segment.a + segment.change * rest);
        let above = (high - demand).min(high - end_demand) > hidden;
        let below = (demand - low).min(end_demand - low) > hidden;
        if above && below {
            self.note_start(place, fresh);
            self.look::<false>(place, &series, end, rest, [demand, end_demand]);
            self.carry.x = end;
            return Led::Through;
        }
        // A release is beyond doubt where the distance from one bound falls all the way.
        let (sign, bound) = if below { (1.0, high) } else { (-1.0, low) };
        let distance = sign * (bound - demand);
        let of = |k: usize| plant.participation * plant.restoring(series.c[k].as_array());
        let slope = sign * (of(0) - plant.block_mass_kg * segment.change);
        let second = 2.0 * sign * of(1);
        let one_way = (above || below)
            && distance > DOUBT * bound.abs()
            && sign * (bound - end_demand) < 0.0
            && crosses_once(slope, second, bend, rest);
        if !one_way {
            return Led::Doubt;
        }
        let mut t = guess([distance, slope, sign * of(1), sign * of(2)]);
        let h = tables.piece_s;
        for _ in 0..4 {
            if !(t > 0.0 && t < rest) {
                return Led::Doubt;
            }
            let y = series.at(simd, t).to_array();
            let a = segment.a + segment.change * t;
            let f = plant.restoring(&y);
            let first = [0.0, 0.0, h * y[3], h * (-f - plant.participation * a)];
            let f1 = plant.restoring(&first);
            let second = [0.0, 0.0, h * first[3], h * (-f1 - plant.participation * segment.change)];
            let f2 = plant.restoring(&second);
            let g = sign * (bound - plant.demand_n(&y, a));
            let g1 = sign * (plant.participation * f1 - plant.block_mass_kg * segment.change);
            let g2 = sign * (plant.participation * f2);
            let d = halley(g, g1, g2);
            t += d;
            if d.abs() < SHORT {
                return self.event::<false>(
                    place,
                    fresh,
                    &series,
                    t,
                    taylor(y, first, second, d),
                    [demand, bound],
                );
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
        let (simd, tables, plant) = (self.simd, self.tables, &self.tables.plant);
        let (x, segment) = (place.x, &place.segment);
        let (sign, force, rest) = (direction.sign(), self.force(direction), segment.rest);
        let series = Series::<S>::new::<true>(simd, &tables.slip.series, x, segment, force);
        let end = series.at(simd, rest).to_array();
        let bend = series.bend.as_array()[1];
        let of = |k: usize| sign * series.c[k].as_array()[1];
        let (speed, end_speed) = (sign * x[1], sign * end[1]);
        let slides = match start {
            None => speed.min(end_speed) > 0.125 * bend * (rest * rest),
            // The zero at the start is no stop: what is left after dividing by it stays positive.
            Some(start) if start.order == 1 => {
                start.acceleration * tables.piece_s > 0.5 * bend * rest
            }
            Some(_) => of(1) > rest * (bend - 2.0 * of(1)) * (1.0 / 6.0),
        };
        if slides {
            self.note_start(place, fresh);
            self.look::<true>(place, &series, end, rest, [force; 2]);
            self.carry.x = end;
            return Led::Through;
        }
        let one_way = start.is_none()
            && speed > 0.0
            && end_speed < 0.0
            && crosses_once(of(0), 2.0 * of(1), bend, rest);
        if !one_way {
            return Led::Doubt;
        }
        let mut t = guess([speed, of(0), of(1), of(2)]);
        let (h, l) = (tables.piece_s, plant.participation);
        for _ in 0..4 {
            if !(t > 0.0 && t < rest) {
                return Led::Doubt;
            }
            let y = series.at(simd, t).to_array();
            let a = segment.a + segment.change * t;
            let f = plant.restoring(&y);
            let u = plant.block_acceleration(&y, f, force);
            let first = [h * y[1], h * (u - a), h * y[3], h * (-f - l * u)];
            let f1 = plant.restoring(&first);
            let u1 = plant.block_acceleration(&first, f1, 0.0);
            let second =
                [h * first[1], h * (u1 - segment.change), h * first[3], h * (-f1 - l * u1)];
            let d = halley(sign * y[1], sign * first[1], sign * second[1]);
            t += d;
            if d.abs() < SHORT {
                let mut y = taylor(y, first, second, d);
                y[1] = 0.0;
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
        x: [f64; 4],
        friction: [f64; 2],
    ) -> Led {
        if !(t > DOUBT && t < place.segment.rest - DOUBT) {
            return Led::Doubt;
        }
        self.note_start(place, fresh);
        self.look::<SLIP>(place, series, x, t, friction);
        self.carry.x = x;
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
            self.carry.sliding.decide(demand, [low, high]);
            self.carry.sliding.end(time_s, s);
        }
        if mode != Mode::Stick {
            self.carry.sliding.begin(time_s, s);
        }
        self.carry.mode = mode;
        self.carry.events.push(Event { time_s, kind, mode, sliding_displacement_m: s });
        self.note_event(sample, at_s);
        true
    }

    /// Records the start of a sample that is known to go this way.
    #[inline(always)]
    fn note_start(&mut self, place: &Part, fresh: bool) {
        if self.records && fresh {
            self.host.record_row(&place.x, place.mode, place.sample);
        }
    }

    /// Records one side of an event.
    #[inline(always)]
    fn note_event(&mut self, sample: usize, at_s: f64) {
        if self.records {
            self.host.record_event(self.carry, sample, at_s);
        }
    }
}

/// Whether a value that is positive at the start and negative at the end, with these derivatives at
/// the start and a bound on the second, crosses zero once: it falls all the way, or is concave.
#[inline(always)]
fn crosses_once(slope: f64, second: f64, bend: f64, rest: f64) -> bool {
    slope + bend * rest < 0.0 || second < -(bend - second.abs())
}

/// First falling root by the terms up to the third power, or anything.
#[inline(always)]
fn guess([c0, c1, c2, c3]: [f64; 4]) -> f64 {
    let t = 2.0 * c0 / ((c1 * c1 - 4.0 * c0 * c2).sqrt() - c1);
    t - c3 * (t * t * t) / (c1 + 2.0 * c2 * t)
}

/// Halley's correction of a root.
#[inline(always)]
fn halley(g: f64, g1: f64, g2: f64) -> f64 {
    -g * g1 / (g1 * g1 - 0.5 * (g * g2))
}

/// State a little later.
#[inline(always)]
fn taylor(y: [f64; 4], first: [f64; 4], second: [f64; 4], d: f64) -> [f64; 4] {
    let half = 0.5 * (d * d);
    let mut x = y;
    for i in 0..4 {
        x[i] += d * first[i] + half * second[i];
    }
    x
}
