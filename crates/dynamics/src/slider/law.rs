//! The law of a slider, as the solver asks for it.
//!
//! The linear structure never changes; everything else is the one force between ground and block. A law
//! answers four questions: the [`SlipForce`] in force while the block slides, the [`Exit`]s from that
//! branch besides the stop at `ṡ = 0`, the [`Hold`] at rest, and what follows an exit ([`Law::follow`],
//! [`Law::begin`]). Friction is a function of the normal force; where a branch is affine under one, it is
//! so by one [`Affine`] force.

use super::branch::{BranchEnd, EXITS, Exit, Restraint, Restraints, SlipForce, TwoBranches};
use super::hold::Hold;
use super::rate::{Coefficient, RateCurve, RateLaw};
use super::series::{SeriesState, SurfacesInSeries};
use super::stop::{ElasticStop, RigidStop};
use super::{Bearing, Contact, Direction, Friction, Pressing, Slider, StopKind};

/// Levels nearer to a rigid stop than this part of its distance are at it.
const AT_WALL: f64 = 1e-12;

/// Most surfaces in series of which every set that can slide together has its own tables.
const TABLED_SURFACES: usize = 4;

/// What a slider is under a normal force that stays or varies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law<'a> {
    bearing: &'a Bearing,
    /// Spring and damper.
    restraint: Restraint,
    /// Radius of a pendulum whose spring follows the normal force, in m.
    radius_m: Option<f64>,
    /// The normal force that friction follows.
    pressing: Pressing,
    ends: Stopping,
}

/// What stops the block.
#[derive(Clone, Copy, Debug)]
enum Stopping {
    Nothing,
    ElasticStop(ElasticStop),
    RigidStop(RigidStop),
}

/// What the force depends on besides `s`, `ṡ` and `N`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Memory {
    /// With an elastic stop.
    pub(crate) contact: Contact,
    /// Piece of a piecewise rate law.
    pub(crate) piece: usize,
    /// Surfaces in series.
    pub(crate) series: SeriesState,
}

impl Slider {
    /// Its law: a pendulum's spring follows a normal force that varies, and that of friction by the
    /// speed, else it is that of a normal force that stays.
    pub(crate) fn law(&self, normal_n: f64, varying: bool) -> Law<'_> {
        let radius_m = self.pendulum_radius_m(varying);
        let stiffness_n_per_m =
            if radius_m.is_some() { 0.0 } else { self.stiffness_n_per_m(normal_n) };
        let ends = match self.stop() {
            None => Stopping::Nothing,
            Some(stop) => match stop.kind {
                StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => {
                    let restraint = Restraint { stiffness_n_per_m, damper_n_s_per_m };
                    Stopping::ElasticStop(ElasticStop { gap_m: stop.gap_m, restraint })
                }
                StopKind::Rigid { restitution } => {
                    Stopping::RigidStop(RigidStop { gap_m: stop.gap_m, restitution })
                }
            },
        };
        let restraint = Restraint { stiffness_n_per_m, damper_n_s_per_m: self.damper_n_s_per_m };
        let friction = self.bearing.friction();
        let pressing = Pressing::new(friction.and_then(Friction::pressure), normal_n);
        Law { bearing: &self.bearing, restraint, radius_m, pressing, ends }
    }
}

impl<'a> Law<'a> {
    // ---- what kind it is ------------------------------------------------------------------------

    /// Whether every branch between rigid stops goes by tables, under a normal force that is constant
    /// or varies: affine but for what fades.
    pub(crate) fn is_tabled(&self, varying: bool) -> bool {
        match self.bearing {
            Bearing::Surface { friction, .. } => {
                let is_affine = friction.rate().is_none() && self.pressing.is_plain();
                !varying || (is_affine && self.radius_m.is_none())
            }
            Bearing::InSeries(series) => !varying && series.surfaces().len() <= TABLED_SURFACES,
        }
    }

    /// Whether what is in force at rest, or while the block slides, comes again as it was and is affine under a constant
    /// normal force.
    pub(crate) fn repeats(&self, slides: bool) -> bool {
        let is_affine = !slides || self.fading_rate_s_per_m().is_none();
        self.bearing.series().is_none() && is_affine
    }

    /// The forces of a block that has but two branches, each with a constant friction force over the
    /// normal force.
    pub(crate) fn two_branches(&self, normal_n: f64) -> Option<TwoBranches> {
        let friction = self.bearing.friction().filter(|friction| friction.rate().is_none())?;
        let [fixed, kinetic] = [Friction::static_coefficient, Friction::kinetic_coefficient]
            .map(|mu| Direction::BOTH.map(|d| -d.sign() * mu(friction, d) * normal_n));
        (!self.has_pads()).then_some(TwoBranches { bounds_n: fixed, kinetic_n: kinetic })
    }

    /// Rate in s/m at which friction fades with the speed, where it does.
    pub(crate) fn fading_rate_s_per_m(&self) -> Option<f64> {
        match self.bearing.rate()?.curve() {
            RateCurve::Exponential { rate_s_per_m, .. } => Some(*rate_s_per_m),
            RateCurve::Pieces { .. } => None,
        }
    }

    /// What a method that sees the block at samples alone cannot follow: what jumps, and what remembers.
    pub(crate) fn beyond_samples(&self) -> Option<&'static str> {
        match (self.ends, self.bearing) {
            (Stopping::RigidStop(_), _) => Some("a rigid stop"),
            (_, Bearing::InSeries(_)) => Some("surfaces in series"),
            (_, Bearing::Surface { .. }) => None,
        }
    }

    /// Whether the block is stopped at an end of its travel.
    pub(crate) fn has_stop(&self) -> bool {
        !matches!(self.ends, Stopping::Nothing)
    }

    /// Whether it presses against what gives way there: contact is part of a knot.
    #[inline(always)]
    pub(crate) fn has_pads(&self) -> bool {
        matches!(self.ends, Stopping::ElasticStop(_))
    }

    /// Distances from `s = 0` towards +x and −x in m at which it is struck and rebounds.
    pub(crate) fn walls_m(&self) -> Option<[Option<f64>; 2]> {
        self.walls().map(|walls| walls.gap_m)
    }

    /// What is left there of the speed, `e`.
    pub(crate) fn restitution(&self) -> Option<f64> {
        self.walls().map(|walls| walls.restitution)
    }

    /// The law away from such walls, where they change nothing.
    pub(crate) fn without_walls(mut self) -> Self {
        if self.walls().is_some() {
            self.ends = Stopping::Nothing;
        }
        self
    }

    /// The law under a constant normal force, by which a pendulum has a spring like any other.
    pub(crate) fn under(mut self, normal_n: f64) -> Self {
        if let Some(radius_m) = self.radius_m.take() {
            self.restraint.stiffness_n_per_m += normal_n / radius_m;
        }
        self
    }

    /// Number of surfaces whose displacements it tells.
    #[inline(always)]
    pub(crate) fn surface_count(&self) -> usize {
        self.bearing.series().map_or(0, |series| series.surfaces().len())
    }

    #[inline(always)]
    fn pads(&self) -> Option<&ElasticStop> {
        match &self.ends {
            Stopping::ElasticStop(pads) => Some(pads),
            _ => None,
        }
    }

    #[inline(always)]
    fn walls(&self) -> Option<&RigidStop> {
        match &self.ends {
            Stopping::RigidStop(walls) => Some(walls),
            _ => None,
        }
    }

    // ---- what is in force -----------------------------------------------------------------------

    /// Spring and damper of a block free of stops.
    pub(crate) fn restraint(&self) -> Restraint {
        self.restraint
    }

    /// The distinct restraints of the branches of such a law; the first is that of a block free of stops.
    pub(crate) fn restraints(&self, normal_n: f64) -> Vec<Restraints> {
        let mut all = Vec::with_capacity(2);
        let contacts = [Contact::Free, Contact::Pressed(Direction::Positive)];
        let pieces = self.bearing.rate().map_or(1, RateLaw::pieces);
        let sets = 1_usize << self.surface_count();
        for contact in contacts.into_iter().take(if self.has_pads() { 2 } else { 1 }) {
            for piece in 0..pieces {
                for set in usize::from(sets > 1)..sets {
                    let mut series = SeriesState::default();
                    let count = self.surface_count();
                    series.displacements_m = vec![0.0; count];
                    series.active = (0..count).map(|i| set & (1 << i) != 0).collect();
                    let memory = Memory { contact, piece, series };
                    for direction in [Direction::Positive, Direction::Negative] {
                        let force = self.force(&memory, direction).affine(normal_n);
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
    pub(crate) fn initial(&self, s: f64, w: f64) -> Memory {
        let contact = self.pads().map_or(Contact::Free, |pads| pads.initial(s, w));
        let series = self.bearing.series().map_or_else(SeriesState::default, |all| all.initial(s));
        let mut memory = Memory { contact, piece: 0, series };
        if w != 0.0 {
            let direction = if w > 0.0 { Direction::Positive } else { Direction::Negative };
            self.resume(&mut memory, w.abs(), direction);
        }
        memory
    }

    /// What is in force once the block leaves rest at `s` in a direction.
    #[inline(always)]
    pub(crate) fn begin(&self, memory: &mut Memory, s: f64, direction: Direction) {
        if let Some(pads) = self.pads() {
            memory.contact = pads.begin(memory.contact, s, direction);
        }
        if let Some(series) = self.bearing.series() {
            series.settle(&mut memory.series, s);
        }
        self.resume(memory, 0.0, direction);
    }

    /// What is in force at a speed that the block has been given.
    #[inline(always)]
    pub(crate) fn resume(&self, memory: &mut Memory, speed: f64, direction: Direction) {
        memory.piece = self.bearing.rate().map_or(0, |rate| rate.piece_of(speed));
        if let Some(series) = self.bearing.series() {
            series.begin(&mut memory.series, direction);
        }
    }

    /// Largest displacement that surfaces in series can take together, in m; infinite where one has no end.
    pub(crate) fn travel_m(&self) -> f64 {
        let series = self.bearing.series();
        series.and_then(SurfacesInSeries::travel_m).unwrap_or(f64::INFINITY)
    }

    /// Whether no surface can slide on in a direction.
    pub(crate) fn at_end(&self, memory: &Memory) -> bool {
        self.bearing.series().is_some() && !memory.series.active.contains(&true)
    }

    /// The force while the block slides in a direction.
    #[inline(always)]
    pub(crate) fn force(&self, memory: &Memory, direction: Direction) -> SlipForce {
        let mut force = SlipForce {
            restraint: self.restraint,
            is_pressed: false,
            force_n: 0.0,
            of_normal: 0.0,
            of_normal_s: self.radius_m.map_or(0.0, |radius_m| 1.0 / radius_m),
            is_friction: self.bearing.series().is_some(),
            sign: direction.sign(),
            coefficient: self.coefficient(memory, direction),
            pressing: self.pressing,
        };
        if let (Contact::Pressed(side), Some(pads)) = (memory.contact, self.pads()) {
            (force.restraint, force.is_pressed) = (pads.beside(self.restraint), true);
            force.force_n = pads.constant_n(side);
        }
        if let Some(series) = self.bearing.series() {
            let [phi, slope] = series.force(&memory.series, direction);
            force.of_normal = phi - slope * memory.series.from_m;
            force.of_normal_s = slope;
        }
        force
    }

    #[inline(always)]
    fn coefficient(&self, memory: &Memory, direction: Direction) -> Coefficient {
        let (at_rest, slope_s_per_m) = match self.bearing {
            Bearing::InSeries(_) => (0.0, 0.0),
            Bearing::Surface { friction, .. } => match friction.rate() {
                Some(rate) => return rate.piece(memory.piece, direction),
                None => (friction.kinetic_coefficient(direction), 0.0),
            },
        };
        Coefficient::Linear { at_rest, slope_s_per_m }
    }

    /// How a branch can end besides a stop at `ṡ = 0`.
    #[inline(always)]
    pub(crate) fn exits(&self, memory: &Memory, direction: Direction) -> [Option<Exit>; EXITS] {
        let mut all = [None; EXITS];
        if let Some(pads) = self.pads() {
            [all[0], all[1]] = pads.exits(memory.contact, direction);
        }
        if self.walls().is_none()
            && self.bearing.series().is_none()
            && self.bearing.rate().is_none()
        {
            return all;
        }
        let sign = direction.sign();
        let level = |place: f64, reached| {
            Some(Exit { of_s: -sign, of_w: 0.0, constant: sign * place, reached })
        };
        let wall = self.walls().and_then(|walls| walls.place(direction));
        if let Some(place) = wall {
            all[0] = level(place, BranchEnd::Wall(direction, place));
        }
        // Bounces lead the surfaces back to where they were at the stop: what joins there does not.
        let before_wall =
            |place: f64| wall.is_none_or(|wall| sign * (wall - place) > AT_WALL * wall.abs());
        if let Some(series) = self.bearing.series()
            && let Some(place) = series.next_level(&memory.series, direction)
            && before_wall(place)
        {
            all[2] = level(place, BranchEnd::Surface(place));
        }
        if let Some(rate) = self.bearing.rate() {
            let [below, above] = rate.ends(memory.piece);
            if let Some(speed) = below {
                let reached = BranchEnd::Knot(speed, memory.piece - 1);
                all[2] = Some(Exit { of_s: 0.0, of_w: sign, constant: -speed, reached });
            }
            if let Some(speed) = above {
                let reached = BranchEnd::Knot(speed, memory.piece + 1);
                all[3] = Some(Exit { of_s: 0.0, of_w: -sign, constant: speed, reached });
            }
        }
        all
    }

    /// What holds the block at rest at `s`.
    #[inline(always)]
    pub(crate) fn hold(&self, memory: &Memory, s: f64) -> Hold {
        let stop_n = self.pads().map_or(0.0, |pads| pads.force_n(memory.contact, s, 0.0));
        let force_n = self.restraint.stiffness_n_per_m * s + stop_n;
        let bears_on_stop = match self.walls() {
            Some(walls) => Direction::BOTH.map(|side| {
                walls.place(side).is_some_and(|place| side.sign() * (s - place) >= 0.0)
            }),
            None => [false; 2],
        };
        let (of_normal, friction) = match self.bearing {
            Bearing::InSeries(series) => {
                let [low, high] = series.hold(&memory.series);
                (0.0, [-high, -low])
            }
            Bearing::Surface { friction, .. } => {
                let bound = |direction| friction.static_coefficient(direction);
                let of_normal = self.radius_m.map_or(0.0, |radius_m| s / radius_m);
                (of_normal, [-bound(Direction::Positive), bound(Direction::Negative)])
            }
        };
        Hold { force_n, of_normal, friction, pressing: self.pressing, bears_on_stop }
    }

    /// Friction over the normal force once the block begins to slide at `s`: the size of what resists
    /// sliding, negative where the surfaces pull the block along.
    #[inline(always)]
    fn resistance(&self, memory: &Memory, s: f64, direction: Direction) -> f64 {
        match self.bearing {
            Bearing::InSeries(series) => {
                let mut begun = memory.series.clone();
                series.settle(&mut begun, s);
                series.begin(&mut begun, direction);
                direction.sign() * series.force(&begun, direction)[0]
            }
            Bearing::Surface { friction, .. } => friction.kinetic_coefficient(direction),
        }
    }

    /// Force of kinetic friction in a direction under a normal force, in N.
    #[inline(always)]
    pub(crate) fn resistance_n(
        &self,
        memory: &Memory,
        s: f64,
        direction: Direction,
        normal_n: f64,
    ) -> f64 {
        self.resistance(memory, s, direction) * self.pressing.of(normal_n)
    }

    /// By how much that is below what holds.
    #[inline(always)]
    pub(crate) fn drop_n(
        &self,
        hold: &Hold,
        (memory, s): (&Memory, f64),
        direction: Direction,
        normal_n: f64,
    ) -> f64 {
        let drop = hold.size(direction) - self.resistance(memory, s, direction);
        drop * self.pressing.of(normal_n)
    }

    /// Size of the friction force while the block slides in a direction at a speed.
    pub(crate) fn kinetic_n(&self, direction: Direction, speed: f64, normal_n: f64) -> f64 {
        let of_surface = self.bearing.friction().map_or(0.0, |friction| match friction.rate() {
            Some(rate) => rate.at(speed, direction),
            None => friction.kinetic_coefficient(direction),
        });
        of_surface * self.pressing.of(normal_n)
    }

    /// Force of spring, damper, pendulum and elastic stop against the block.
    pub(crate) fn restoring_n(&self, contact: Contact, [s, w]: [f64; 2], normal_n: f64) -> f64 {
        let Restraint { stiffness_n_per_m, damper_n_s_per_m } = self.restraint;
        let pendulum = self.radius_m.map_or(0.0, |radius_m| normal_n / radius_m);
        let stop_n = self.pads().map_or(0.0, |pads| pads.force_n(contact, s, w));
        stiffness_n_per_m * s + damper_n_s_per_m * w + pendulum * s + stop_n
    }

    // ---- what follows ---------------------------------------------------------------------------

    /// Follows the end of a branch other than a wall; what slides must be decided at the end of all
    /// travel.
    pub(crate) fn follow(&self, memory: &mut Memory, reached: BranchEnd, direction: Direction) {
        match reached {
            BranchEnd::Contact(to, _) => memory.contact = to,
            BranchEnd::Knot(_, piece) => memory.piece = piece,
            BranchEnd::Surface(place) => {
                if let Some(series) = self.bearing.series() {
                    series.reach(&mut memory.series, place, direction);
                }
            }
            BranchEnd::Wall(..) => {}
        }
    }

    /// Ends a branch at rest at `s`.
    #[inline(always)]
    pub(crate) fn settle(&self, memory: &mut Memory, s: f64) {
        if let Some(series) = self.bearing.series() {
            series.settle(&mut memory.series, s);
            memory.series.active.fill(false);
        }
    }

    /// Updates the memory where the block strikes a rigid stop in a direction.
    pub(crate) fn strike(&self, memory: &mut Memory, s: f64, direction: Direction) {
        if let Some(series) = self.bearing.series() {
            series.arrive(&mut memory.series, s, direction);
        }
        self.settle(memory, s);
    }

    /// Updates the memory where a bounce in a direction ends, however short it was.
    pub(crate) fn turn(&self, memory: &mut Memory, s: f64, direction: Direction) {
        if let Some(series) = self.bearing.series() {
            series.turn(&mut memory.series, s, direction);
        }
        self.settle(memory, s);
    }

    // ---- what is told ---------------------------------------------------------------------------

    /// Displacements of surfaces in series at `s` in a branch.
    #[inline(always)]
    pub(crate) fn surfaces(&self, memory: &Memory, s: f64) -> Vec<f64> {
        let of = |series: &SurfacesInSeries| series.displacements(&memory.series, s);
        self.bearing.series().map_or_else(Vec::new, of)
    }

    /// Whether surfaces with these displacements are at their ends.
    pub(crate) fn surfaces_at_ends<'d>(
        &self,
        displacements_m: &'d [f64],
    ) -> impl Iterator<Item = bool> + use<'a, 'd> {
        let surfaces = self.bearing.surfaces();
        let at_end = |(surface, u): (&super::Surface, &f64)| {
            surface.travel_m.is_some_and(|travel_m| u.abs() >= travel_m)
        };
        surfaces.iter().zip(displacements_m).map(at_end)
    }

    /// Force of the elastic stop on the block, as a size in N.
    pub(crate) fn stop_force_n(&self, contact: Contact, s: f64, w: f64) -> f64 {
        self.pads().map_or(0.0, |pads| pads.force_n(contact, s, w).abs())
    }

    /// The force of the elastic stop as factors of `s` and `ṡ` and a constant part, positive as it
    /// presses; none without contact.
    pub(crate) fn stop_row(&self, contact: Contact) -> Option<[f64; 3]> {
        let (Contact::Pressed(side), Some(pads)) = (contact, self.pads()) else { return None };
        let Restraint { stiffness_n_per_m, damper_n_s_per_m } = pads.restraint;
        let of = [stiffness_n_per_m, damper_n_s_per_m, pads.constant_n(side)];
        Some(of.map(|x| side.sign() * x))
    }

    /// Largest force that friction can hold; infinite where the springs of surfaces in series add to it.
    #[inline(always)]
    pub(crate) fn largest_static_n(&self, normal_n: f64) -> f64 {
        let Some(friction) = self.bearing.friction() else { return f64::INFINITY };
        let [positive, negative] = Direction::BOTH.map(|d| friction.static_coefficient(d));
        positive.max(negative) * self.pressing.of(normal_n)
    }
}
