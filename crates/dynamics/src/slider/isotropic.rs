//! Sliders that are the same in all horizontal directions.

use super::hold::Disc;
use super::{Bearing, Direction, Pressing, RateCurve, Restoring, Slider};

/// What a slider does along any direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Isotropic {
    /// The forces that friction holds, in N.
    pub(crate) hold: Disc,
    pub(crate) kinetic: IsotropicFriction,
    /// `K1` in N/m without that of a pendulum, which is `N/R`: `1/R` in 1/m, 0 without one.
    pub(crate) stiffness_n_per_m: f64,
    pub(crate) per_radius: f64,
}

/// `μ_k` by the sliding speed `r`: `at_rest + gain (1 − e^(−α r))`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IsotropicFriction {
    pub(crate) at_rest: f64,
    gain: f64,
    /// `α` in s/m.
    rate_s_per_m: f64,
    /// The normal force that it is of.
    pressing: Pressing,
}

impl IsotropicFriction {
    /// Whether it is the same at all speeds.
    #[inline(always)]
    pub(crate) fn is_constant(&self) -> bool {
        self.gain == 0.0 || self.rate_s_per_m == 0.0
    }

    /// Whether there is none at any speed.
    pub(crate) fn is_none(&self) -> bool {
        self.at_rest == 0.0 && self.is_constant()
    }

    /// Whether friction follows the normal force itself.
    pub(crate) fn is_plain(&self) -> bool {
        self.pressing.is_plain()
    }

    /// The normal force that friction follows, under a normal force.
    #[inline(always)]
    pub(crate) fn pressing_n(&self, normal_n: f64) -> f64 {
        self.pressing.of(normal_n)
    }

    /// Friction at a speed in m/s under a normal force.
    pub(crate) fn force(&self, speed: f64, normal_n: f64) -> f64 {
        self.at(speed) * self.pressing.of(normal_n)
    }

    /// `μ_k` at a speed in m/s.
    pub(crate) fn at(&self, speed: f64) -> f64 {
        self.at_rest - self.gain * libm::expm1(-self.rate_s_per_m * speed)
    }

    /// How fast that grows with the speed, in s/m.
    pub(crate) fn slope_at(&self, speed: f64) -> f64 {
        self.gain * self.rate_s_per_m * libm::exp(-self.rate_s_per_m * speed)
    }

    /// The same times a factor.
    pub(crate) fn times(&self, factor: f64) -> Self {
        Self { at_rest: factor * self.at_rest, gain: factor * self.gain, ..*self }
    }
}

impl Slider {
    /// The slider as one that is the same in all directions, with the normal force at rest.
    ///
    /// # Errors
    /// What of it is not, or does not slide in two directions.
    pub(crate) fn isotropic(&self, normal_n: f64) -> Result<Isotropic, &'static str> {
        let Bearing::Surface { restoring, friction } = &self.bearing else {
            return Err("surfaces in series");
        };
        let [fixed, at_rest] = self.coefficients();
        let at_rest_alike = at_rest[0] == at_rest[1];
        let pressing = Pressing::new(friction.pressure(), normal_n);
        let (kinetic, alike) = match friction.rate() {
            None => {
                let at_rest = at_rest[0];
                (
                    IsotropicFriction { at_rest, gain: 0.0, rate_s_per_m: 0.0, pressing },
                    at_rest_alike,
                )
            }
            Some(law) => {
                let RateCurve::Exponential { slow, fast, rate_s_per_m } = *law.curve() else {
                    return Err("friction by straight lines of the speed");
                };
                let [factor, other] = Direction::BOTH.map(|way| law.factor(way));
                let gain = factor * (fast - slow);
                (
                    IsotropicFriction { at_rest: at_rest[0], gain, rate_s_per_m, pressing },
                    factor == other,
                )
            }
        };
        let refused = [
            (self.tilt_rad != 0.0, "tilt"),
            (self.stop().is_some(), "a stop"),
            (fixed[0] != fixed[1] || !alike, "friction by direction"),
        ];
        if let Some((_, what)) = refused.into_iter().find(|(refused, _)| *refused) {
            return Err(what);
        }
        let (stiffness_n_per_m, per_radius) = match *restoring {
            Restoring::None => (0.0, 0.0),
            Restoring::Spring { stiffness_n_per_m } => (stiffness_n_per_m, 0.0),
            Restoring::Pendulum { radius_m } => (0.0, 1.0 / radius_m),
        };
        let hold = Disc { of_normal: fixed[0], pressing };
        Ok(Isotropic { hold, kinetic, stiffness_n_per_m, per_radius })
    }
}
