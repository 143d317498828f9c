//! Stops at the ends of the gap.
//!
//! Elastic: with `δ = s − d` the pad pushes the block back by `max(0, k δ + c ṡ)` while `δ > 0`, and never
//! pulls; left behind, it has recovered. Mirrored on the other side.

use super::Direction;
use super::branch::{BranchEnd, Exit, Restraint};
use super::ranges::{in_range, not_negative, positive};
use crate::error::ModelError;

/// A stop at the end of the slider's travel, on one side or on both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Distance from `s = 0` towards +x and −x in m, 0 of what stands against it; `None`: no stop on that side.
    pub gap_m: [Option<f64>; 2],
    /// How it pushes back.
    pub kind: StopKind,
}

/// How a stop pushes back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopKind {
    /// A spring and a damper side by side, which cannot pull: at a penetration δ > 0 the force
    /// `max(0, k δ + c δ̇)` on the block against δ, for δ ≤ 0 none.
    Elastic {
        /// `k` in N/m.
        stiffness_n_per_m: f64,
        /// `c` in N s/m.
        damper_n_s_per_m: f64,
    },
    /// Nothing gives way: at an impact `ṡ⁺ = −e ṡ⁻`, and floors keep their absolute velocities.
    Rigid {
        /// `e`, from 0 to 1.
        restitution: f64,
    },
}

impl Stop {
    /// Pads at distances from `s = 0` towards +x and −x in m, with `k` in N/m and `c` in N s/m.
    #[must_use]
    pub fn elastic(gap_m: [Option<f64>; 2], stiffness_n_per_m: f64, damper_n_s_per_m: f64) -> Self {
        Self { gap_m, kind: StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } }
    }

    /// Walls at distances from `s = 0` towards +x and −x in m, with their restitution.
    #[must_use]
    pub fn rigid(gap_m: [Option<f64>; 2], restitution: f64) -> Self {
        Self { gap_m, kind: StopKind::Rigid { restitution } }
    }

    /// Refuses what no stop is.
    pub(super) fn check(&self) -> Result<(), ModelError> {
        if self.gap_m == [None; 2] {
            let expected = "a gap on one side at least";
            return Err(ModelError::Missing { quantity: "stop gap_m", expected });
        }
        let mut gaps_m = self.gap_m.into_iter().flatten();
        gaps_m.try_for_each(|gap_m| not_negative("stop gap_m", gap_m))?;
        match self.kind {
            StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => {
                positive("stop stiffness_n_per_m", stiffness_n_per_m)?;
                not_negative("stop damper_n_s_per_m", damper_n_s_per_m)
            }
            StopKind::Rigid { restitution } => {
                let is_within = (0.0..=1.0).contains(&restitution);
                in_range("stop restitution", "a number from 0 to 1", restitution, is_within)
            }
        }
    }

    /// Refuses a place beyond a rigid stop.
    pub(crate) fn admits(&self, place_m: f64) -> Result<(), ModelError> {
        let StopKind::Rigid { .. } = self.kind else { return Ok(()) };
        let within = |side: Direction| {
            self.gap_towards(side).is_none_or(|gap_m| side.sign() * place_m <= gap_m)
        };
        let is_within = Direction::BOTH.into_iter().all(within);
        let expected = "a place between the rigid stops";
        in_range("initial sliding_displacement_m", expected, place_m, is_within)
    }

    /// Distance from `s = 0` to the stop on a side, in m.
    #[must_use]
    pub fn gap_towards(&self, side: Direction) -> Option<f64> {
        side.of(self.gap_m)
    }
}

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

/// Pads at the ends of the gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ElasticStop {
    /// Distances from `s = 0` to the pads towards +x and −x in m; none where there is no pad.
    pub(super) gap_m: [Option<f64>; 2],
    /// `k` and `c` of a pad.
    pub(super) restraint: Restraint,
}

/// Stops that do not give way: `ṡ⁺ = −e ṡ⁻` at the end of the gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RigidStop {
    /// Distances from `s = 0` to the stops towards +x and −x in m; none where there is no stop.
    pub(super) gap_m: [Option<f64>; 2],
    /// `e`, from 0 to 1.
    pub(super) restitution: f64,
}

/// `s` at the end of the gap on a side.
fn place([positive, negative]: [Option<f64>; 2], side: Direction) -> Option<f64> {
    match side {
        Direction::Positive => positive,
        // A gap of 0 is at 0, not at −0.
        Direction::Negative => negative.map(|gap_m| 0.0 - gap_m),
    }
}

impl RigidStop {
    /// `s` at the stop on a side.
    pub(super) fn place(&self, side: Direction) -> Option<f64> {
        place(self.gap_m, side)
    }
}

impl ElasticStop {
    /// `s` at the pad on a side.
    fn place(&self, side: Direction) -> Option<f64> {
        place(self.gap_m, side)
    }

    /// Spring and damper of slider and pad.
    pub(super) fn beside(&self, restraint: Restraint) -> Restraint {
        Restraint {
            stiffness_n_per_m: restraint.stiffness_n_per_m + self.restraint.stiffness_n_per_m,
            damper_n_s_per_m: restraint.damper_n_s_per_m + self.restraint.damper_n_s_per_m,
        }
    }

    /// `−k d`: what a pressed pad adds to `k s + c ṡ`.
    pub(super) fn constant_n(&self, side: Direction) -> f64 {
        -self.restraint.stiffness_n_per_m * self.place(side).unwrap_or(0.0)
    }

    /// Force of the ground's pad against the block, positive against sliding towards +x, in N.
    pub(super) fn force_n(&self, contact: Contact, s: f64, w: f64) -> f64 {
        let Contact::Pressed(side) = contact else { return 0.0 };
        let depth = s - self.place(side).unwrap_or(s);
        self.restraint.stiffness_n_per_m * depth + self.restraint.damper_n_s_per_m * w
    }

    /// Free: `s = ±d`. Pressed and moving out: `k δ + c ṡ = 0`, which without a damper is `s = d`.
    /// Separated: `s = d`, or the pad catches up.
    pub(super) fn exits(&self, contact: Contact, direction: Direction) -> [Option<Exit>; 2] {
        let level = |side: Direction, inward: bool, to: Contact| {
            let place = self.place(side)?;
            let of_s = if inward { -side.sign() } else { side.sign() };
            let constant = -of_s * place;
            let reached = BranchEnd::Contact(to, Some(place));
            Some(Exit { of_s, of_w: 0.0, constant, reached })
        };
        // ±(k δ + c ṡ)
        let force = |side: Direction, sign: f64, to: Contact| {
            let Restraint { stiffness_n_per_m: k, damper_n_s_per_m: c } = self.restraint;
            let sign = sign * side.sign();
            Some(Exit {
                of_s: sign * k,
                of_w: sign * c,
                constant: sign * self.constant_n(side),
                reached: BranchEnd::Contact(to, None),
            })
        };
        match contact {
            Contact::Free => [level(direction, true, Contact::Pressed(direction)), None],
            Contact::Pressed(side) if side == direction => [None; 2],
            Contact::Pressed(side) if self.restraint.damper_n_s_per_m == 0.0 => {
                [level(side, false, Contact::Free), None]
            }
            Contact::Pressed(side) => [force(side, 1.0, Contact::Separated(side)), None],
            Contact::Separated(side) => {
                [level(side, false, Contact::Free), force(side, -1.0, Contact::Pressed(side))]
            }
        }
    }

    /// At the pad itself the block is pressed against it when it sets out towards it, and free when
    /// it sets out the other way.
    pub(super) fn begin(&self, contact: Contact, s: f64, direction: Direction) -> Contact {
        let side = match contact {
            Contact::Free => direction,
            Contact::Pressed(side) | Contact::Separated(side) => side,
        };
        let Some(place) = self.place(side) else { return Contact::Free };
        let depth = side.sign() * (s - place);
        if depth > 0.0 || (depth == 0.0 && direction == side) {
            Contact::Pressed(side)
        } else {
            Contact::Free
        }
    }

    /// Beyond the gap the pad pushes unless the block runs ahead of it.
    pub(super) fn initial(&self, s: f64, w: f64) -> Contact {
        for side in [Direction::Positive, Direction::Negative] {
            let Some(place) = self.place(side) else { continue };
            let (depth, speed) = (side.sign() * (s - place), side.sign() * w);
            let force =
                self.restraint.stiffness_n_per_m * depth + self.restraint.damper_n_s_per_m * speed;
            if depth > 0.0 {
                let pressed = force >= 0.0;
                return if pressed { Contact::Pressed(side) } else { Contact::Separated(side) };
            }
            if depth == 0.0 && speed > 0.0 {
                return Contact::Pressed(side);
            }
        }
        Contact::Free
    }
}
