//! Coulomb friction: which forces hold the block, and which resist it while it slides.

use super::Direction;
use crate::error::ModelError;

/// Coulomb friction with static and kinetic coefficients for each direction of sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    static_positive: f64,
    static_negative: f64,
    kinetic_positive: f64,
    kinetic_negative: f64,
}

/// The law that the solver asks for the bounds in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// Coulomb's, eqs (1)–(4), (8), (14) of the paper.
    Coulomb(Coulomb),
}

impl Coulomb {
    /// Coefficients for sliding towards +x and −x; all dimensionless.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] unless each is finite and ≥ 0 and none of the kinetic ones is
    /// above the static one of its direction.
    pub fn new(
        [static_positive, static_negative]: [f64; 2],
        [kinetic_positive, kinetic_negative]: [f64; 2],
    ) -> Result<Self, ModelError> {
        for (quantity, found) in [
            ("static_friction (positive)", static_positive),
            ("static_friction (negative)", static_negative),
            ("kinetic_friction (positive)", kinetic_positive),
            ("kinetic_friction (negative)", kinetic_negative),
        ] {
            if !(found.is_finite() && found >= 0.0) {
                let expected = "a finite coefficient of friction ≥ 0";
                return Err(ModelError::OutOfRange { quantity, expected, found });
            }
        }
        for (quantity, kinetic, limit) in [
            ("kinetic_friction (positive)", kinetic_positive, static_positive),
            ("kinetic_friction (negative)", kinetic_negative, static_negative),
        ] {
            if kinetic > limit {
                let expected = "at most the static friction of the same direction";
                return Err(ModelError::OutOfRange { quantity, expected, found: kinetic });
            }
        }
        Ok(Self { static_positive, static_negative, kinetic_positive, kinetic_negative })
    }
}

impl Friction {
    /// Coulomb friction with a static and a kinetic coefficient, the same in both directions.
    ///
    /// # Errors
    /// As [`Coulomb::new`], which takes coefficients by direction.
    pub fn new(fixed: f64, kinetic: f64) -> Result<Self, ModelError> {
        Coulomb::new([fixed; 2], [kinetic; 2]).map(Self::Coulomb)
    }

    /// Static coefficient against sliding in a direction.
    #[must_use]
    pub fn static_coefficient(&self, direction: Direction) -> f64 {
        let Self::Coulomb(c) = self;
        match direction {
            Direction::Positive => c.static_positive,
            Direction::Negative => c.static_negative,
        }
    }

    /// Kinetic coefficient while sliding in a direction.
    #[must_use]
    pub fn kinetic_coefficient(&self, direction: Direction) -> f64 {
        let Self::Coulomb(c) = self;
        match direction {
            Direction::Positive => c.kinetic_positive,
            Direction::Negative => c.kinetic_negative,
        }
    }

    /// The same law with all coefficients times `factor` (lower- and upper-bound friction).
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] unless the factor is finite and ≥ 0.
    pub fn scaled(&self, factor: f64) -> Result<Self, ModelError> {
        if !(factor.is_finite() && factor >= 0.0) {
            return Err(ModelError::OutOfRange {
                quantity: "factor on friction",
                expected: "a finite factor ≥ 0",
                found: factor,
            });
        }
        let Self::Coulomb(c) = *self;
        Ok(Self::Coulomb(Coulomb {
            static_positive: factor * c.static_positive,
            static_negative: factor * c.static_negative,
            kinetic_positive: factor * c.kinetic_positive,
            kinetic_negative: factor * c.kinetic_negative,
        }))
    }
}
