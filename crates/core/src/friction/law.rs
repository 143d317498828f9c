//! The one force between ground and block, as the solver asks for it.
//!
//! The linear structure never changes; everything else is this force. A law answers four
//! questions: the [`Branch`] in force while the block slides, the [`Exit`]s from it besides the stop
//! at `ṡ = 0`, the [`Hold`] at rest, and what follows an exit ([`Exit::to`], [`Law::begin`]).

use super::{Direction, ElasticStop, Friction};

/// Where the block stands to the stops: the memory of a law.
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

/// The force on the ground while the block slides: `F = force + k s + c ṡ + coefficient N`, with
/// `k` and `c` of a [`Restraint`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Place of its stiffness and damper among [`Law::restraints`].
    pub restraint: usize,
    /// Constant part in N.
    pub force_n: f64,
    /// `σ μ_k`.
    pub coefficient: f64,
}

/// A stiffness and a damper between ground and block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Restraint {
    /// `k` in N/m.
    pub stiffness_n_per_m: f64,
    /// `c` in N s/m.
    pub damper_n_s_per_m: f64,
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
    /// `s` at a level, where the exit is one.
    pub level_m: Option<f64>,
    /// What is in force after it.
    pub to: Contact,
}

impl Exit {
    /// Its value in a state; the branch lasts while it is positive.
    #[inline(always)]
    #[must_use]
    pub fn value(&self, s: f64, w: f64) -> f64 {
        (self.of_s * s + self.of_w * w) + self.constant
    }
}

/// What holds the block at rest: `low N ≤ demand ≤ high N`, where the demand contains the forces of
/// springs and stops at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Force of springs and stops at `ṡ = 0` in N.
    pub force_n: f64,
    /// `−μ_s⁺` and `μ_s⁻`: too large a demand slides the block towards −x.
    pub bounds: [f64; 2],
}

impl Hold {
    /// Whether friction holds a demand under a normal force, eq. (4); at the bound it does. Else the
    /// direction in which the block slides, against the demand, eq. (3).
    #[inline(always)]
    #[must_use]
    pub fn gives_way(&self, demand_n: f64, normal_n: f64) -> Option<Direction> {
        let [low, high] = self.bounds.map(|bound| bound * normal_n);
        if demand_n > high {
            Some(Direction::Negative)
        } else if demand_n < low {
            Some(Direction::Positive)
        } else {
            None
        }
    }
}

/// Friction, spring, damper and stops of a slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    friction: Friction,
    restraint: Restraint,
    stop: Option<ElasticStop>,
}

impl Law {
    /// A law of friction beside a spring and damper, and perhaps stops.
    #[must_use]
    pub fn new(friction: Friction, restraint: Restraint, stop: Option<ElasticStop>) -> Self {
        Self { friction, restraint, stop }
    }

    /// The distinct stiffnesses and dampers of its branches; the first is that without contact.
    pub fn restraints(&self) -> impl Iterator<Item = Restraint> {
        let pressed = self.stop.map(|stop| stop.beside(self.restraint));
        core::iter::once(self.restraint).chain(pressed)
    }

    /// The branch in force while the block slides in a direction.
    #[inline(always)]
    #[must_use]
    pub fn branch(&self, contact: Contact, direction: Direction) -> Branch {
        let coefficient = direction.sign() * self.friction.kinetic_coefficient(direction);
        match (contact, self.stop) {
            (Contact::Pressed(side), Some(stop)) => {
                Branch { restraint: 1, force_n: stop.constant_n(side), coefficient }
            }
            _ => Branch { restraint: 0, force_n: 0.0, coefficient },
        }
    }

    /// How a branch can end besides a stop at `ṡ = 0`.
    #[inline(always)]
    #[must_use]
    pub fn exits(&self, contact: Contact, direction: Direction) -> [Option<Exit>; 2] {
        self.stop.map_or([None; 2], |stop| stop.exits(contact, direction))
    }

    /// What holds the block at rest at `s`.
    #[inline(always)]
    #[must_use]
    pub fn hold(&self, contact: Contact, s: f64) -> Hold {
        let stop_n = self.stop.map_or(0.0, |stop| stop.force_n(contact, s, 0.0));
        let bound = |direction| self.friction.static_coefficient(direction);
        Hold {
            force_n: self.restraint.stiffness_n_per_m * s + stop_n,
            bounds: [-bound(Direction::Positive), bound(Direction::Negative)],
        }
    }

    /// What is in force once the block leaves rest at `s` in a direction.
    #[inline(always)]
    #[must_use]
    pub fn begin(&self, contact: Contact, s: f64, direction: Direction) -> Contact {
        self.stop.map_or(Contact::Free, |stop| stop.begin(contact, s, direction))
    }

    /// What is in force in a state before anything has happened.
    #[must_use]
    pub fn initial(&self, s: f64, w: f64) -> Contact {
        self.stop.map_or(Contact::Free, |stop| stop.initial(s, w))
    }

    /// Force of the stop on the block, as a size in N.
    #[must_use]
    pub fn stop_force_n(&self, contact: Contact, s: f64, w: f64) -> f64 {
        self.stop.map_or(0.0, |stop| stop.force_n(contact, s, w).abs())
    }

    /// The force of the stop in slip as factors of `s` and `ṡ` and a constant part, positive as it
    /// presses; none without contact.
    #[must_use]
    pub fn stop_row(&self, contact: Contact) -> Option<[f64; 3]> {
        let (Contact::Pressed(side), Some(stop)) = (contact, self.stop) else { return None };
        let of = [stop.stiffness_n_per_m, stop.damper_n_s_per_m, stop.constant_n(side)];
        Some(of.map(|x| side.sign() * x))
    }

    /// Whether the law has stops.
    #[must_use]
    pub fn has_stop(&self) -> bool {
        self.stop.is_some()
    }

    /// Largest static coefficient of a direction.
    #[must_use]
    pub fn largest_static(&self) -> f64 {
        let of = |direction| self.friction.static_coefficient(direction);
        of(Direction::Positive).max(of(Direction::Negative))
    }
}
