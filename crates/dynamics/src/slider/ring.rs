//! A stop around the slider in two directions: a moat, or a ring of restrainers.
//!
//! With `ρ = |s|`, `n = s/ρ` and `δ = ρ − d` it pushes the block back along `−n` by `max(0, k δ + c ρ̇)` while `δ > 0`, as a
//! pad does in one direction, and takes no force along the ring.
//!
//! One that does not give way is struck at `ρ = d`: `ρ̇⁺ = −e ρ̇⁻`, while the velocity along it stays. A block that has no
//! velocity towards it any more bears on it, and slides along it, for as long as what it pushes with is no less than zero.
//! At rest against it, friction takes what pushes along the ring, and the ring what pushes towards it.

use super::stop::{Contact, Stop, StopKind};
use super::{Direction, Restraint};

/// In two directions a ring is pressed on the one side that it has.
const SIDE: Direction = Direction::Positive;

/// A ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ring {
    /// `d` in m.
    pub(crate) gap_m: f64,
    /// `k` and `c` of one that gives way.
    pub(crate) restraint: Restraint,
    /// `e` of one that does not.
    pub(crate) restitution: Option<f64>,
}

/// Scalar product.
fn inner(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Ring {
    /// The ring pressed.
    pub(crate) const PRESSED: Contact = Contact::Pressed(SIDE);
    /// Beyond its gap without a force.
    pub(crate) const SEPARATED: Contact = Contact::Separated(SIDE);

    /// A stop as a ring.
    ///
    /// # Errors
    /// What of it is none.
    pub(super) fn of(stop: &Stop) -> Result<Self, &'static str> {
        let (restraint, restitution) = match stop.kind {
            StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => {
                (Restraint { stiffness_n_per_m, damper_n_s_per_m }, None)
            }
            StopKind::Rigid { restitution } => (Restraint::default(), Some(restitution)),
        };
        match stop.gap_m {
            [Some(gap_m), Some(other_m)] if gap_m == other_m && gap_m > 0.0 => {
                Ok(Self { gap_m, restraint, restitution })
            }
            [Some(_), Some(other_m)] if stop.gap_m == [Some(other_m); 2] => {
                Err("a stop without a gap")
            }
            _ => Err("a stop whose gap is not the same on both sides"),
        }
    }

    /// `ρ` and `ρ̇`.
    pub(crate) fn along_radius(s: [f64; 2], w: [f64; 2]) -> [f64; 2] {
        let radius = inner(s, s).sqrt();
        [radius, inner(s, w) / radius]
    }

    /// `k δ + c ρ̇` in N.
    pub(crate) fn pushes_n(&self, s: [f64; 2], w: [f64; 2]) -> f64 {
        let Restraint { stiffness_n_per_m: k, damper_n_s_per_m: c } = self.restraint;
        let [radius, rate] = Self::along_radius(s, w);
        k * (radius - self.gap_m) + c * rate
    }

    /// How fast that grows, in N/s, under a sliding acceleration.
    pub(crate) fn growth_n_per_s(&self, s: [f64; 2], w: [f64; 2], change: [f64; 2]) -> f64 {
        let Restraint { stiffness_n_per_m: k, damper_n_s_per_m: c } = self.restraint;
        let [radius, rate] = Self::along_radius(s, w);
        let bend = (inner(w, w) + inner(s, change) - rate * rate) / radius;
        k * rate + c * bend
    }

    /// Force of the block on it where it is pressed, in N.
    pub(crate) fn force_n(&self, s: [f64; 2], w: [f64; 2]) -> [f64; 2] {
        let [radius, _] = Self::along_radius(s, w);
        let size = self.pushes_n(s, w) / radius;
        s.map(|s| size * s)
    }

    /// Of one that does not give way, what the block pushes it with over `M1`, where its push without the ring is known.
    pub(crate) fn bears_per_kg(&self, s: [f64; 2], w: [f64; 2], push: [f64; 2]) -> f64 {
        let radius = inner(s, s).sqrt();
        let bears = (inner(s, push) + inner(w, w)) / radius;
        // At rest nothing holds it there.
        if w == [0.0; 2] { bears.max(0.0) } else { bears }
    }

    /// Where the block stands to it at a start.
    pub(crate) fn contact_at_start(&self, s: [f64; 2], w: [f64; 2]) -> Contact {
        let radius = inner(s, s).sqrt();
        if self.restitution.is_some() {
            let bears = radius >= self.gap_m && inner(s, w) == 0.0;
            return if bears { Self::PRESSED } else { Contact::Free };
        }
        if radius > self.gap_m {
            return if self.pushes_n(s, w) >= 0.0 { Self::PRESSED } else { Self::SEPARATED };
        }
        if radius == self.gap_m && inner(s, w) > 0.0 { Self::PRESSED } else { Contact::Free }
    }

    /// Where the block stands to it at rest, from which it may set out in a direction: beyond the gap the ring has followed.
    pub(crate) fn contact_at_rest(&self, s: [f64; 2], direction: [f64; 2]) -> Contact {
        let radius = inner(s, s).sqrt();
        let sets_out = radius == self.gap_m && inner(s, direction) > 0.0;
        if radius > self.gap_m || sets_out { Self::PRESSED } else { Contact::Free }
    }
}
