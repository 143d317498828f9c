//! Sliders that are the same in all horizontal directions.

use super::{Bearing, Restoring, Slider};

/// What a slider does along any direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Isotropic {
    /// `μ_s` and `μ_k`.
    pub(crate) fixed: f64,
    pub(crate) kinetic: f64,
    /// `K1` in N/m without that of a pendulum, which is `N/R`: `1/R` in 1/m, 0 without one.
    pub(crate) stiffness_n_per_m: f64,
    pub(crate) per_radius: f64,
}

impl Slider {
    /// The slider as one that is the same in all directions.
    ///
    /// # Errors
    /// What of it is not, or does not slide in two directions.
    pub(crate) fn isotropic(&self) -> Result<Isotropic, &'static str> {
        let Bearing::Surface { restoring, friction } = &self.bearing else {
            return Err("surfaces in series");
        };
        let [fixed, kinetic] = self.coefficients();
        let refused = [
            (self.tilt_rad != 0.0, "tilt"),
            (self.stop().is_some(), "a stop"),
            (friction.rate().is_some(), "friction by speed"),
            (fixed[0] != fixed[1] || kinetic[0] != kinetic[1], "friction by direction"),
        ];
        if let Some((_, what)) = refused.into_iter().find(|(refused, _)| *refused) {
            return Err(what);
        }
        let (stiffness_n_per_m, per_radius) = match *restoring {
            Restoring::None => (0.0, 0.0),
            Restoring::Spring { stiffness_n_per_m } => (stiffness_n_per_m, 0.0),
            Restoring::Pendulum { radius_m } => (0.0, 1.0 / radius_m),
        };
        Ok(Isotropic { fixed: fixed[0], kinetic: kinetic[0], stiffness_n_per_m, per_radius })
    }
}
