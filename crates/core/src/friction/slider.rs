//! The one force between ground and block where [`Law`](super::Law) does not suffice: rigid stops,
//! friction by speed, a pendulum's spring under vertical motion, surfaces in series.
//!
//! The questions are the same: the force in a branch, its exits, what holds at rest, what follows.

use super::law::{Contact, Restraint};
use super::rate::{Coefficient, RateLaw};
use super::surfaces::{Series, SeriesState};
use super::{Direction, ElasticStop, Friction};

/// Levels nearer to a rigid stop than this part of its distance are at it.
const AT_WALL: f64 = 1e-12;

/// Stops that do not give way: `ṡ⁺ = −e ṡ⁻` at the end of the gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidStop {
    /// Distances from `s = 0` to the stops towards +x and −x in m; none where there is no stop.
    pub gap_m: [Option<f64>; 2],
    /// `e`, from 0 to 1.
    pub restitution: f64,
}

impl RigidStop {
    /// `s` at the stop on a side.
    fn place(&self, side: Direction) -> Option<f64> {
        let [positive, negative] = self.gap_m;
        match side {
            Direction::Positive => positive,
            Direction::Negative => negative.map(|gap_m| -gap_m),
        }
    }
}

/// All that the slider consists of.
#[derive(Clone, Debug)]
pub struct SliderLaw {
    /// Static friction, and kinetic friction that does not depend on the speed.
    pub friction: Friction,
    /// Kinetic friction that does.
    pub rate: Option<RateLaw>,
    /// Radius of a pendulum whose spring is `N/R`, in m.
    pub radius_m: Option<f64>,
    /// Surfaces in series, which stand for all friction.
    pub series: Option<Series>,
    /// Spring and damper.
    pub restraint: Restraint,
    /// Elastic stops.
    pub stop: Option<ElasticStop>,
    /// Rigid stops.
    pub rigid: Option<RigidStop>,
}

/// What the force depends on besides `s`, `ṡ` and `N`.
#[derive(Clone, Debug, PartialEq)]
pub struct Memory {
    /// With an elastic stop.
    pub contact: Contact,
    /// Piece of a piecewise rate law.
    pub piece: usize,
    /// Surfaces in series.
    pub series: SeriesState,
}

/// The force on the ground while the block slides:
/// `F = force + k s + c ṡ + N (of_normal + of_normal_s s) + σ μ(|ṡ|) N`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipForce {
    /// `k` and `c`.
    pub restraint: Restraint,
    /// Constant part in N.
    pub force_n: f64,
    /// Constant part over the normal force.
    pub of_normal: f64,
    /// Stiffness over the normal force in 1/m.
    pub of_normal_s: f64,
    /// Whether these two count as friction: of surfaces in series, whose springs memory mixes with it.
    pub is_friction: bool,
    /// `μ`.
    pub coefficient: Coefficient,
}

/// What is crossed at the end of a branch: the branch lasts while
/// `of_s s + of_w ṡ + constant` is positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// Factor of `s`.
    pub of_s: f64,
    /// Factor of `ṡ`.
    pub of_w: f64,
    /// Constant part.
    pub constant: f64,
    /// What is reached there.
    pub reached: Reached,
}

/// What is reached where a branch ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// The elastic stop changes its contact; at this `s`, where that is a level.
    Contact(Contact, Option<f64>),
    /// A rigid stop on a side, at this `s`.
    Wall(Direction, f64),
    /// Another surface joins or one leaves, at this `s`.
    Surface(f64),
    /// A knot of the rate law, this speed, and the piece beyond.
    Knot(f64, usize),
}

/// What holds the block at rest: friction carries `low N ≤ T ≤ high N`, where
/// `T = demand + force + of_normal N`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Force of springs and elastic stop in N.
    pub force_n: f64,
    /// Force over the normal force.
    pub of_normal: f64,
    /// What friction holds, over the normal force.
    pub bounds: [f64; 2],
    /// Whether a rigid stop holds what friction cannot: a push of the ground towards −x (the block
    /// leans on the stop towards +x), and one towards +x.
    pub leans: [bool; 2],
}

impl Rest {
    /// The forces between which the block stays.
    #[must_use]
    pub fn holds_n(&self, normal_n: f64) -> [f64; 2] {
        let [low, high] = self.bounds.map(|bound| bound * normal_n);
        [
            if self.leans[0] { f64::NEG_INFINITY } else { low },
            if self.leans[1] { f64::INFINITY } else { high },
        ]
    }

    /// The direction in which a force of friction that is asked for slides the block, if it is too
    /// large.
    #[must_use]
    pub fn gives_way(&self, force_n: f64, normal_n: f64) -> Option<Direction> {
        let [low, high] = self.holds_n(normal_n);
        if force_n > high {
            Some(Direction::Negative)
        } else if force_n < low {
            Some(Direction::Positive)
        } else {
            None
        }
    }
}

impl SliderLaw {
    /// What is in force in a state before anything has happened.
    #[must_use]
    pub fn initial(&self, s: f64, w: f64) -> Memory {
        let contact = self.stop.map_or(Contact::Free, |stop| stop.initial(s, w));
        let series = self.series.as_ref().map_or_else(SeriesState::default, |all| all.initial(s));
        let mut memory = Memory { contact, piece: 0, series };
        if w != 0.0 {
            let direction = if w > 0.0 { Direction::Positive } else { Direction::Negative };
            self.resume(&mut memory, w.abs(), direction);
        }
        memory
    }

    /// What is in force once the block leaves rest at `s` in a direction.
    pub fn begin(&self, memory: &mut Memory, s: f64, direction: Direction) {
        if let Some(stop) = self.stop {
            memory.contact = stop.begin(memory.contact, s, direction);
        }
        if let Some(series) = &self.series {
            series.settle(&mut memory.series, s);
        }
        self.resume(memory, 0.0, direction);
    }

    /// What is in force at a speed that the block has been given.
    pub fn resume(&self, memory: &mut Memory, speed: f64, direction: Direction) {
        memory.piece = self.rate.as_ref().map_or(0, |rate| rate.piece_of(speed));
        if let Some(series) = &self.series {
            series.begin(&mut memory.series, direction);
        }
    }

    /// Whether no surface can slide on in a direction.
    #[must_use]
    pub fn at_end(&self, memory: &Memory) -> bool {
        self.series.is_some() && !memory.series.active.contains(&true)
    }

    /// The force while the block slides in a direction.
    #[must_use]
    pub fn force(&self, memory: &Memory, direction: Direction) -> SlipForce {
        let mut force = SlipForce {
            restraint: self.restraint,
            force_n: 0.0,
            of_normal: 0.0,
            of_normal_s: self.radius_m.map_or(0.0, |radius_m| 1.0 / radius_m),
            is_friction: self.series.is_some(),
            coefficient: self.coefficient(memory, direction),
        };
        if let (Contact::Pressed(side), Some(stop)) = (memory.contact, self.stop) {
            force.restraint = stop.beside(self.restraint);
            force.force_n = stop.constant_n(side);
        }
        if let Some(series) = &self.series {
            let [phi, slope] = series.force(&memory.series, direction);
            force.of_normal = phi - slope * memory.series.from_m;
            force.of_normal_s = slope;
        }
        force
    }

    fn coefficient(&self, memory: &Memory, direction: Direction) -> Coefficient {
        if self.series.is_some() {
            return Coefficient::Linear { at_rest: 0.0, slope_s_per_m: 0.0 };
        }
        match &self.rate {
            Some(rate) => rate.piece(memory.piece, direction),
            None => Coefficient::Linear {
                at_rest: self.friction.kinetic_coefficient(direction),
                slope_s_per_m: 0.0,
            },
        }
    }

    /// How a branch can end besides a stop at `ṡ = 0`.
    #[must_use]
    pub fn bounds(&self, memory: &Memory, direction: Direction) -> Vec<Bound> {
        let mut all = Vec::new();
        let sign = direction.sign();
        let level =
            |place: f64, reached| Bound { of_s: -sign, of_w: 0.0, constant: sign * place, reached };
        if let Some(stop) = &self.stop {
            all.extend(stop.exits(memory.contact, direction).into_iter().flatten().map(|exit| {
                Bound {
                    of_s: exit.of_s,
                    of_w: exit.of_w,
                    constant: exit.constant,
                    reached: Reached::Contact(exit.to, exit.level_m),
                }
            }));
        }
        if let Some(place) = self.rigid.and_then(|rigid| rigid.place(direction)) {
            all.push(level(place, Reached::Wall(direction, place)));
        }
        let wall = self.rigid.and_then(|rigid| rigid.place(direction));
        // Bounces lead the surfaces back to where they were at the stop: what joins there does not.
        let before_wall =
            |place: f64| wall.is_none_or(|wall| sign * (wall - place) > AT_WALL * wall.abs());
        if let Some(series) = &self.series
            && let Some(place) = series.next_level(&memory.series, direction)
            && before_wall(place)
        {
            all.push(level(place, Reached::Surface(place)));
        }
        if let Some(rate) = &self.rate {
            let [below, above] = rate.ends(memory.piece);
            if let Some(speed) = below {
                let reached = Reached::Knot(speed, memory.piece - 1);
                all.push(Bound { of_s: 0.0, of_w: sign, constant: -speed, reached });
            }
            if let Some(speed) = above {
                let reached = Reached::Knot(speed, memory.piece + 1);
                all.push(Bound { of_s: 0.0, of_w: -sign, constant: speed, reached });
            }
        }
        all
    }

    /// What holds the block at rest at `s`.
    #[must_use]
    pub fn rest(&self, memory: &Memory, s: f64) -> Rest {
        let stop_n = self.stop.map_or(0.0, |stop| stop.force_n(memory.contact, s, 0.0));
        let force_n = self.restraint.stiffness_n_per_m * s + stop_n;
        let leans = match self.rigid {
            Some(rigid) => [Direction::Positive, Direction::Negative].map(|side| {
                rigid.place(side).is_some_and(|place| side.sign() * (s - place) >= 0.0)
            }),
            None => [false; 2],
        };
        if let Some(series) = &self.series {
            let [low, high] = series.hold(&memory.series);
            return Rest { force_n, of_normal: 0.0, bounds: [-high, -low], leans };
        }
        let bound = |direction| self.friction.static_coefficient(direction);
        Rest {
            force_n,
            of_normal: self.radius_m.map_or(0.0, |radius_m| s / radius_m),
            bounds: [-bound(Direction::Positive), bound(Direction::Negative)],
            leans,
        }
    }

    /// By how much friction over the normal force falls at the start of a branch in a direction, from
    /// what holds at rest.
    #[must_use]
    pub fn drop(&self, rest: &Rest, begun: &Memory, direction: Direction) -> f64 {
        let held = match direction {
            Direction::Positive => -rest.bounds[0],
            Direction::Negative => -rest.bounds[1],
        };
        let sliding = match &self.series {
            Some(series) => series.force(&begun.series, direction)[0],
            None => {
                let at_rest = self.rate.as_ref().map(|rate| rate.at(0.0, direction));
                let constant = || self.friction.kinetic_coefficient(direction);
                direction.sign() * at_rest.unwrap_or_else(constant)
            }
        };
        direction.sign() * (held - sliding)
    }

    /// Follows the end of a branch other than a wall; what slides must be decided at the end of all
    /// travel.
    pub fn follow(&self, memory: &mut Memory, reached: Reached, direction: Direction) {
        match reached {
            Reached::Contact(to, _) => memory.contact = to,
            Reached::Knot(_, piece) => memory.piece = piece,
            Reached::Surface(place) => {
                if let Some(series) = &self.series {
                    series.reach(&mut memory.series, place, direction);
                }
            }
            Reached::Wall(..) => {}
        }
    }

    /// Ends a branch at rest at `s`.
    pub fn settle(&self, memory: &mut Memory, s: f64) {
        if let Some(series) = &self.series {
            series.settle(&mut memory.series, s);
            memory.series.active.fill(false);
        }
    }

    /// Displacements of surfaces in series at `s` in a branch.
    #[must_use]
    pub fn surfaces(&self, memory: &Memory, s: f64) -> Vec<f64> {
        let of = |series: &Series| series.displacements(&memory.series, s);
        self.series.as_ref().map_or_else(Vec::new, of)
    }

    /// Force of the elastic stop on the block, as a size in N.
    #[must_use]
    pub fn stop_force_n(&self, memory: &Memory, s: f64, w: f64) -> f64 {
        self.stop.map_or(0.0, |stop| stop.force_n(memory.contact, s, w).abs())
    }

    /// The force of the elastic stop as factors of `s` and `ṡ` and a constant part, positive as it
    /// presses; none without contact.
    #[must_use]
    pub fn stop_row(&self, memory: &Memory) -> Option<[f64; 3]> {
        let (Contact::Pressed(side), Some(stop)) = (memory.contact, self.stop) else { return None };
        let of = [stop.stiffness_n_per_m, stop.damper_n_s_per_m, stop.constant_n(side)];
        Some(of.map(|x| side.sign() * x))
    }
}
