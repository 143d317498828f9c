//! The one force between ground and block, as the solver asks for it.
//!
//! The linear structure never changes; everything else is this force. A law answers four questions:
//! the [`SlipForce`] in force while the block slides, the [`Exit`]s from that branch besides the stop
//! at `ṡ = 0`, the [`Hold`] at rest, and what follows an exit ([`Law::follow`], [`Law::begin`]).
//! Where a branch is affine, it is so by one [`Affine`] force.

use super::rate::{Coefficient, RateCurve, RateLaw};
use super::surfaces::{Series, SeriesState};
use super::{Direction, ElasticStop, Friction, RigidStop};
use crate::linear::polynomial::Polynomial;

/// Levels nearer to a rigid stop than this part of its distance are at it.
const AT_WALL: f64 = 1e-12;

/// Most surfaces in series of which every set that can slide together has its own tables.
const TABLED_SURFACES: usize = 4;

/// Where the block stands to the elastic stops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Contact {
    /// Within the gap.
    #[default]
    Free,
    /// Pressed against the stop on this side: `δ ≥ 0`, the stop pushes.
    Pressed(Direction),
    /// Beyond the gap, but faster on its way back than the stop follows: `δ > 0`, no force.
    Separated(Direction),
}

/// A stiffness and a damper between ground and block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Restraint {
    /// `k` in N/m.
    pub stiffness_n_per_m: f64,
    /// `c` in N s/m.
    pub damper_n_s_per_m: f64,
}

/// All that the slider consists of.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
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
    /// Whether a stop is pressed.
    pub is_pressed: bool,
    /// Constant part in N.
    pub force_n: f64,
    /// Constant part over the normal force.
    pub of_normal: f64,
    /// Stiffness over the normal force in 1/m.
    pub of_normal_s: f64,
    /// Whether these two count as friction: of surfaces in series, whose springs memory mixes with it.
    pub is_friction: bool,
    /// `σ`.
    pub sign: f64,
    /// `μ`.
    pub coefficient: Coefficient,
}

/// What a branch adds to the linear system, by which its tables are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Restraints {
    /// `k` and `c` of all.
    pub all: Restraint,
    /// What of them counts as friction.
    pub of_friction: Restraint,
    /// Whether a stop is pressed.
    pub is_pressed: bool,
}

/// The same under a constant normal force, affine but perhaps for what fades:
/// `F = force + k s + c ṡ + coefficient N − fading`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// `k` and `c`.
    pub restraints: Restraints,
    /// Constant part in N.
    pub force_n: f64,
    /// Constant part over the normal force, which is friction.
    pub coefficient: f64,
    /// What exponential friction lacks of that at high speed.
    pub fading: Option<Fading>,
}

/// A force that fades with the speed: `force e^(−rate σ ṡ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fading {
    /// At rest in N, positive towards +x.
    pub force_n: f64,
    /// Rate in s/m, with the sign `σ` of the velocity.
    pub rate_s_per_m: f64,
}

impl Fading {
    /// The force at a velocity, in N.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, w: f64) -> f64 {
        self.force_n * libm::exp(-self.rate_s_per_m * w)
    }
}

/// The end of a branch other than `ṡ = 0`: where `of_s s + of_w ṡ + constant`, positive within the
/// branch, reaches zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exit {
    /// Factor of `s`.
    pub of_s: f64,
    /// Factor of `ṡ`; 0 where the exit is a level of `s`, which is monotone while the block slides.
    pub of_w: f64,
    /// Constant part.
    pub constant: f64,
    /// What is reached there.
    pub reached: Reached,
}

/// Most exits of a branch.
pub const EXITS: usize = 4;

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
pub struct Hold {
    /// Force of springs and elastic stop in N.
    pub force_n: f64,
    /// Force over the normal force.
    pub of_normal: f64,
    /// What friction holds, over the normal force: `−μ_s⁺` and `μ_s⁻`.
    pub bounds: [f64; 2],
    /// Whether a rigid stop holds what friction cannot: a push of the ground towards −x (the block
    /// leans on the stop towards +x), and one towards +x.
    pub leans: [bool; 2],
}

impl Reached {
    /// `s` and `ṡ` where it is reached in a direction, of which one is known, from both as computed.
    #[inline(always)]
    #[must_use]
    pub fn place(&self, direction: Direction, [s, w]: [f64; 2]) -> [f64; 2] {
        match *self {
            Self::Contact(_, level_m) => [level_m.unwrap_or(s), w],
            Self::Wall(_, level_m) | Self::Surface(level_m) => [level_m, w],
            Self::Knot(speed, _) => [s, direction.sign() * speed],
        }
    }
}

impl Exit {
    /// Its value in a state; the branch lasts while it is positive.
    #[inline(always)]
    #[must_use]
    pub fn value(&self, s: f64, w: f64) -> f64 {
        (self.of_s * s + self.of_w * w) + self.constant
    }
}

impl Hold {
    /// The forces between which the block stays.
    #[inline(always)]
    #[must_use]
    pub fn holds_n(&self, normal_n: f64) -> [f64; 2] {
        let [low, high] = self.bounds.map(|bound| bound * normal_n);
        [
            if self.leans[0] { f64::NEG_INFINITY } else { low },
            if self.leans[1] { f64::INFINITY } else { high },
        ]
    }

    /// What friction holds against sliding in a direction, over the normal force.
    #[inline(always)]
    #[must_use]
    pub fn size(&self, direction: Direction) -> f64 {
        match direction {
            Direction::Positive => -self.bounds[0],
            Direction::Negative => self.bounds[1],
        }
    }

    /// How far a demand and a normal force, linear in time, leave the block from sliding in a direction:
    /// positive where friction holds.
    #[inline(always)]
    #[must_use]
    pub fn distance(
        &self,
        demand: &Polynomial,
        [normal_n, rise_n]: [f64; 2],
        direction: Direction,
    ) -> Polynomial {
        let (sign, size) = (direction.sign(), self.size(direction));
        let mut distance = demand.map(|c| sign * c);
        distance[0] += size * normal_n;
        distance[1] += size * rise_n;
        distance
    }

    /// Whether friction holds a force that it is asked for, eq. (4); at the bound it does. Else the
    /// direction in which the block slides, against the force, eq. (3).
    #[inline(always)]
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

    /// How near a decision about a force was, over what friction holds; none where it holds nothing,
    /// or a stop holds.
    #[must_use]
    pub fn margin(&self, force_n: f64, normal_n: f64) -> Option<f64> {
        let [low, high] = self.holds_n(normal_n);
        let margin = if low <= 0.0 && high >= 0.0 {
            let bound = if force_n < 0.0 { -low } else { high };
            if bound <= 0.0 {
                return None;
            }
            (1.0 - force_n.abs() / bound).abs()
        } else {
            // The springs of surfaces push the block back.
            let [a, b] = self.bounds.map(|bound| (bound * normal_n).abs());
            ((force_n - high).max(low - force_n) / a.max(b)).abs()
        };
        Some(margin).filter(|margin| margin.is_finite())
    }
}

impl SlipForce {
    /// The force under a constant normal force.
    #[inline(always)]
    #[must_use]
    pub fn under(&self, normal_n: f64) -> Affine {
        let (at_rest, slope_s_per_m, fading) = match self.coefficient {
            Coefficient::Linear { at_rest, slope_s_per_m } => (at_rest, slope_s_per_m, None),
            Coefficient::Exponential { fast, drop, rate_s_per_m } => {
                let force_n = self.sign * drop * normal_n;
                let rate_s_per_m = self.sign * rate_s_per_m;
                (fast, 0.0, Some(Fading { force_n, rate_s_per_m }))
            }
        };
        let (mut all, mut of_friction) = (self.restraint, Restraint::default());
        let mut coefficient = self.sign * at_rest;
        if self.is_friction {
            coefficient = self.of_normal;
            of_friction.stiffness_n_per_m = self.of_normal_s * normal_n;
            all.stiffness_n_per_m += of_friction.stiffness_n_per_m;
        } else {
            all.stiffness_n_per_m += self.of_normal_s * normal_n;
        }
        if slope_s_per_m != 0.0 {
            of_friction.damper_n_s_per_m = slope_s_per_m * normal_n;
            all.damper_n_s_per_m += of_friction.damper_n_s_per_m;
        }
        let restraints = Restraints { all, of_friction, is_pressed: self.is_pressed };
        Affine { restraints, force_n: self.force_n, coefficient, fading }
    }
}

impl Law {
    /// Whether every branch between rigid stops goes by tables, under a normal force that is constant
    /// or varies: affine but for what fades.
    #[must_use]
    pub fn is_tabled(&self, varying: bool) -> bool {
        let Self { rate, radius_m, series, .. } = self;
        if varying {
            return rate.is_none() && radius_m.is_none() && series.is_none();
        }
        series.as_ref().is_none_or(|all| all.surfaces().len() <= TABLED_SURFACES)
    }

    /// Whether the block has but two branches, each with a constant friction force over the normal force.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.rate.is_none() && self.series.is_none() && self.stop.is_none()
    }

    /// Whether friction fades with the speed.
    #[must_use]
    pub fn fades(&self) -> bool {
        let curve = self.rate.as_ref().map(RateLaw::curve);
        matches!(curve, Some(RateCurve::Exponential { .. }))
    }

    /// The law under a constant normal force, by which a pendulum has a spring like any other.
    #[must_use]
    pub fn under(mut self, normal_n: f64) -> Self {
        if let Some(radius_m) = self.radius_m.take() {
            self.restraint.stiffness_n_per_m += normal_n / radius_m;
        }
        self
    }

    /// The distinct restraints of the branches of such a law; the first is that of a block free of stops.
    #[must_use]
    pub fn restraints(&self, normal_n: f64) -> Vec<Restraints> {
        let mut all = Vec::with_capacity(2);
        let contacts = [Contact::Free, Contact::Pressed(Direction::Positive)];
        let pieces = self.rate.as_ref().map_or(1, RateLaw::pieces);
        let sets = self.series.as_ref().map_or(1, |series| 1 << series.surfaces().len());
        for contact in contacts.into_iter().take(if self.stop.is_some() { 2 } else { 1 }) {
            for piece in 0..pieces {
                for set in usize::from(sets > 1)..sets {
                    let mut series = SeriesState::default();
                    if let Some(law) = &self.series {
                        let count = law.surfaces().len();
                        series.displacements_m = vec![0.0; count];
                        series.active = (0..count).map(|i| set & (1 << i) != 0).collect();
                    }
                    let memory = Memory { contact, piece, series };
                    for direction in [Direction::Positive, Direction::Negative] {
                        let force = self.force(&memory, direction).under(normal_n);
                        if !all.contains(&force.restraints) {
                            all.push(force.restraints);
                        }
                    }
                }
            }
        }
        all
    }

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
    #[inline(always)]
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
    #[inline(always)]
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
    #[inline(always)]
    #[must_use]
    pub fn force(&self, memory: &Memory, direction: Direction) -> SlipForce {
        let mut force = SlipForce {
            restraint: self.restraint,
            is_pressed: false,
            force_n: 0.0,
            of_normal: 0.0,
            of_normal_s: self.radius_m.map_or(0.0, |radius_m| 1.0 / radius_m),
            is_friction: self.series.is_some(),
            sign: direction.sign(),
            coefficient: self.coefficient(memory, direction),
        };
        if let (Contact::Pressed(side), Some(stop)) = (memory.contact, self.stop) {
            (force.restraint, force.is_pressed) = (stop.beside(self.restraint), true);
            force.force_n = stop.constant_n(side);
        }
        if let Some(series) = &self.series {
            let [phi, slope] = series.force(&memory.series, direction);
            force.of_normal = phi - slope * memory.series.from_m;
            force.of_normal_s = slope;
        }
        force
    }

    #[inline(always)]
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
    #[inline(always)]
    #[must_use]
    pub fn exits(&self, memory: &Memory, direction: Direction) -> [Option<Exit>; EXITS] {
        let mut all = [None; EXITS];
        if let Some(stop) = &self.stop {
            [all[0], all[1]] = stop.exits(memory.contact, direction);
        }
        if self.rigid.is_none() && self.series.is_none() && self.rate.is_none() {
            return all;
        }
        let sign = direction.sign();
        let level = |place: f64, reached| {
            Some(Exit { of_s: -sign, of_w: 0.0, constant: sign * place, reached })
        };
        let wall = self.rigid.and_then(|rigid| rigid.place(direction));
        if let Some(place) = wall {
            all[0] = level(place, Reached::Wall(direction, place));
        }
        // Bounces lead the surfaces back to where they were at the stop: what joins there does not.
        let before_wall =
            |place: f64| wall.is_none_or(|wall| sign * (wall - place) > AT_WALL * wall.abs());
        if let Some(series) = &self.series
            && let Some(place) = series.next_level(&memory.series, direction)
            && before_wall(place)
        {
            all[2] = level(place, Reached::Surface(place));
        }
        if let Some(rate) = &self.rate {
            let [below, above] = rate.ends(memory.piece);
            if let Some(speed) = below {
                let reached = Reached::Knot(speed, memory.piece - 1);
                all[2] = Some(Exit { of_s: 0.0, of_w: sign, constant: -speed, reached });
            }
            if let Some(speed) = above {
                let reached = Reached::Knot(speed, memory.piece + 1);
                all[3] = Some(Exit { of_s: 0.0, of_w: -sign, constant: speed, reached });
            }
        }
        all
    }

    /// What holds the block at rest at `s`.
    #[inline(always)]
    #[must_use]
    pub fn hold(&self, memory: &Memory, s: f64) -> Hold {
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
            return Hold { force_n, of_normal: 0.0, bounds: [-high, -low], leans };
        }
        let bound = |direction| self.friction.static_coefficient(direction);
        Hold {
            force_n,
            of_normal: self.radius_m.map_or(0.0, |radius_m| s / radius_m),
            bounds: [-bound(Direction::Positive), bound(Direction::Negative)],
            leans,
        }
    }

    /// Friction over the normal force at the start of a branch in a direction: the size of what resists
    /// sliding, negative where the surfaces pull the block along.
    #[inline(always)]
    #[must_use]
    pub fn resistance(&self, begun: &Memory, direction: Direction) -> f64 {
        match (&self.series, &self.rate) {
            (Some(series), _) => direction.sign() * series.force(&begun.series, direction)[0],
            (None, Some(rate)) => rate.at(0.0, direction),
            (None, None) => self.friction.kinetic_coefficient(direction),
        }
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
    #[inline(always)]
    pub fn settle(&self, memory: &mut Memory, s: f64) {
        if let Some(series) = &self.series {
            series.settle(&mut memory.series, s);
            memory.series.active.fill(false);
        }
    }

    /// The same where the block strikes a rigid stop in a direction.
    pub fn strike(&self, memory: &mut Memory, s: f64, direction: Direction) {
        if let Some(series) = &self.series {
            series.arrive(&mut memory.series, s, direction);
        }
        self.settle(memory, s);
    }

    /// The same where a bounce in a direction ends, however short it was.
    pub fn turn(&self, memory: &mut Memory, s: f64, direction: Direction) {
        if let Some(series) = &self.series {
            series.turn(&mut memory.series, s, direction);
        }
        self.settle(memory, s);
    }

    /// Displacements of surfaces in series at `s` in a branch.
    #[must_use]
    pub fn surfaces(&self, memory: &Memory, s: f64) -> Vec<f64> {
        let of = |series: &Series| series.displacements(&memory.series, s);
        self.series.as_ref().map_or_else(Vec::new, of)
    }

    /// Force of the elastic stop on the block, as a size in N.
    #[must_use]
    pub fn stop_force_n(&self, contact: Contact, s: f64, w: f64) -> f64 {
        self.stop.map_or(0.0, |stop| stop.force_n(contact, s, w).abs())
    }

    /// The force of the elastic stop as factors of `s` and `ṡ` and a constant part, positive as it
    /// presses; none without contact.
    #[must_use]
    pub fn stop_row(&self, contact: Contact) -> Option<[f64; 3]> {
        let (Contact::Pressed(side), Some(stop)) = (contact, self.stop) else { return None };
        let of = [stop.stiffness_n_per_m, stop.damper_n_s_per_m, stop.constant_n(side)];
        Some(of.map(|x| side.sign() * x))
    }

    /// Largest force over the normal force that friction can hold; infinite where the springs of
    /// surfaces in series add to it.
    #[must_use]
    pub fn largest_static(&self) -> f64 {
        if self.series.is_some() {
            return f64::INFINITY;
        }
        let of = |direction| self.friction.static_coefficient(direction);
        of(Direction::Positive).max(of(Direction::Negative))
    }
}
