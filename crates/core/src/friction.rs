//! The force between ground and block: one file a law.
//!
//! [`Coulomb`] friction, [`RateLaw`]s, the [`ElasticStop`] and [`RigidStop`], [`Series`] of surfaces; and
//! the [`Law`] of them all, which the solver asks for what is in force.

mod coulomb;
mod law;
mod rate;
mod stop;
mod surfaces;

pub use coulomb::{Coulomb, Friction};
pub use law::{
    Affine, Contact, EXITS, Exit, Fading, Hold, Law, Memory, Reached, Restraint, Restraints,
    SlipForce,
};
pub use rate::{Coefficient, RateCurve, RateLaw};
pub use stop::{ElasticStop, RigidStop};
pub use surfaces::{Series, SeriesState, Surface};

/// Direction of sliding along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Towards +x: the sliding velocity is positive.
    Positive,
    /// Towards −x.
    Negative,
}

impl Direction {
    /// +1 or −1.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }

    /// The other one.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Positive => Self::Negative,
            Self::Negative => Self::Positive,
        }
    }
}
