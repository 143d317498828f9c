//! Friction of one surface: which forces hold the block, and which resist it while it slides.

use super::ranges::in_range;
use super::{Direction, PressureLaw, RateLaw};
use crate::error::ModelError;

/// Static and kinetic friction of one surface, eqs (1)–(4), (8), (14) of the paper.
///
/// # Examples
/// ```
/// use slipstick_dynamics::slider::{Direction, Friction, RateCurve, RateLaw};
///
/// let plain = Friction::new(0.06, 0.05)?;
/// assert_eq!(plain.static_coefficient(Direction::Negative), 0.06);
///
/// let curve = RateCurve::Exponential { slow: 0.03, fast: 0.06, rate_s_per_m: 25.0 };
/// let by_speed = Friction::by_speed([0.04; 2], RateLaw::new(curve, [1.0; 2])?)?;
/// assert_eq!(by_speed.kinetic_coefficient(Direction::Positive), 0.03);
///
/// let error = Friction::new(0.05, 0.06).unwrap_err();
/// assert!(error.to_string().contains("at most the static friction"));
/// # Ok::<(), slipstick_dynamics::error::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// `μ_s` towards +x and −x.
    fixed: [f64; 2],
    kinetic: KineticFriction,
    /// How they follow the pressure: they are those at rest.
    pressure: Option<PressureLaw>,
}

/// Kinetic friction.
#[derive(Clone, Debug, PartialEq)]
enum KineticFriction {
    /// `μ_k` towards +x and −x.
    Constant([f64; 2]),
    /// `μ_k` by the sliding speed.
    BySpeed(RateLaw),
}

impl Friction {
    /// A static and a kinetic coefficient, the same in both directions.
    ///
    /// # Errors
    /// As [`Friction::by_direction`].
    pub fn new(fixed: f64, kinetic: f64) -> Result<Self, ModelError> {
        Self::by_direction([fixed; 2], [kinetic; 2])
    }

    /// Static and kinetic coefficients for sliding towards +x and −x.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] unless each is finite and ≥ 0 and none of the kinetic ones is
    /// above the static one of its direction.
    pub fn by_direction(fixed: [f64; 2], kinetic: [f64; 2]) -> Result<Self, ModelError> {
        check(fixed, kinetic)?;
        Ok(Self { fixed, kinetic: KineticFriction::Constant(kinetic), pressure: None })
    }

    /// Static coefficients for sliding towards +x and −x, and kinetic friction by the sliding speed.
    ///
    /// # Errors
    /// As [`Friction::by_direction`] for the kinetic coefficients at rest.
    pub fn by_speed(fixed: [f64; 2], kinetic: RateLaw) -> Result<Self, ModelError> {
        check(fixed, Direction::BOTH.map(|direction| kinetic.at(0.0, direction)))?;
        Ok(Self { fixed, kinetic: KineticFriction::BySpeed(kinetic), pressure: None })
    }

    /// Friction whose coefficients, so far those at the reference pressure of a law, follow the pressure: from here on
    /// they are those under the weight alone.
    ///
    /// # Errors
    /// As [`Friction::scaled`].
    pub fn under_pressure(&self, law: PressureLaw) -> Result<Self, ModelError> {
        Ok(Self { pressure: Some(law), ..self.scaled(law.factor_at_rest())? })
    }

    /// How coefficients follow the pressure, where they do.
    #[inline(always)]
    #[must_use]
    pub fn pressure(&self) -> Option<&PressureLaw> {
        self.pressure.as_ref()
    }

    /// Static coefficient against sliding in a direction.
    #[inline(always)]
    #[must_use]
    pub fn static_coefficient(&self, direction: Direction) -> f64 {
        direction.of(self.fixed)
    }

    /// Kinetic coefficient while sliding in a direction; where it follows the speed, that at rest.
    #[inline(always)]
    #[must_use]
    pub fn kinetic_coefficient(&self, direction: Direction) -> f64 {
        match &self.kinetic {
            KineticFriction::Constant(kinetic) => direction.of(*kinetic),
            KineticFriction::BySpeed(rate) => rate.at(0.0, direction),
        }
    }

    /// The law of kinetic friction that follows the speed, where it does.
    #[inline(always)]
    #[must_use]
    pub fn rate(&self) -> Option<&RateLaw> {
        match &self.kinetic {
            KineticFriction::Constant(_) => None,
            KineticFriction::BySpeed(rate) => Some(rate),
        }
    }

    /// The same with all coefficients times `factor` (lower- and upper-bound friction).
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] unless the factor is finite and ≥ 0.
    pub fn scaled(&self, factor: f64) -> Result<Self, ModelError> {
        check_factor(factor)?;
        let kinetic = match &self.kinetic {
            KineticFriction::Constant(kinetic) => {
                KineticFriction::Constant(kinetic.map(|mu| factor * mu))
            }
            KineticFriction::BySpeed(rate) => KineticFriction::BySpeed(rate.scaled(factor)),
        };
        Ok(Self { fixed: self.fixed.map(|mu| factor * mu), kinetic, pressure: self.pressure })
    }
}

/// Whether all coefficients may be multiplied by a factor.
pub(super) fn check_factor(found: f64) -> Result<(), ModelError> {
    let is_within = found.is_finite() && found >= 0.0;
    in_range("factor on friction", "a finite factor ≥ 0", found, is_within)
}

fn check(fixed: [f64; 2], kinetic: [f64; 2]) -> Result<(), ModelError> {
    const FIXED: [&str; 2] = ["static_friction (positive)", "static_friction (negative)"];
    const KINETIC: [&str; 2] = ["kinetic_friction (positive)", "kinetic_friction (negative)"];
    for (quantity, found) in FIXED.into_iter().zip(fixed).chain(KINETIC.into_iter().zip(kinetic)) {
        let is_within = found.is_finite() && found >= 0.0;
        in_range(quantity, "a finite coefficient of friction ≥ 0", found, is_within)?;
    }
    for ((quantity, found), limit) in KINETIC.into_iter().zip(kinetic).zip(fixed) {
        let expected = "at most the static friction of the same direction";
        in_range(quantity, expected, found, found <= limit)?;
    }
    Ok(())
}
