//! The liquid in an upright circular tank with a rigid wall, by Housner's two masses.

use core::f64::consts::{PI, TAU};

use crate::error::ModelError;
use crate::slider::ranges::positive;
use crate::units::STANDARD_GRAVITY_M_PER_S2;

/// Density of water in kg/m³, of which a specific gravity is a multiple.
const WATER_KG_PER_M3: f64 = 1000.0;

/// Part of the liquid that moves with the wall, and part that sloshes in its first mode.
///
/// G. W. Housner, The dynamic behavior of water tanks, Bull. Seism. Soc. Am. 53 (1963) 381-387, in the form of
/// ACI 350.3-06, section 9.3. With the diameter `D`, the depth `H` and `x = 3.68 H/D`:
///
/// ```text
/// m     = ρ π D² H/4
/// m_i/m = tanh(0.866 D/H)/(0.866 D/H)        h_i/H = 0.5 − 0.09375 D/H where D/H < 1.333, else 0.375
/// m_c/m = 0.230 (D/H) tanh x                 h_c/H = 1 − (cosh x − 1)/(x sinh x)
/// T_c   = 2 π/√(3.68 (g/D) tanh x)
/// h'_i/H = 0.866 (D/H)/(2 tanh(0.866 D/H)) − 1/8, 0.45 where D/H < 0.75
/// h'_c/H = 1 − (cosh x − 2.01)/(x sinh x)
/// ```
///
/// Heights `h` are those of the pressure on the wall alone, by which the wall bends; `h'` are those of the pressure on
/// wall and bottom, by which the tank overturns about a plane below it. In wide tanks `m_i + m_c` lacks some per
/// cent of `m`, the higher modes. In those with `D/H < 1.5` the two formulas exceed `m` by up to 6 %; there
/// `m_i = m − m_c`, since the liquid has no more mass.
///
/// # Examples
/// ```
/// use slipstick_dynamics::model::LiquidTank;
/// let tank = LiquidTank::new(10.0, 8.0, 1.0)?;
/// assert!((tank.convective_period_s - 4.93).abs() < 0.01);
/// # Ok::<(), slipstick_dynamics::error::ModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiquidTank {
    /// Radius in m.
    pub radius_m: f64,
    /// Depth of the liquid in m.
    pub depth_m: f64,
    /// Density over that of water, 1000 kg/m³.
    pub specific_gravity: f64,
    /// Mass of the liquid in kg.
    pub mass_kg: f64,
    /// What moves with the wall, in kg.
    pub impulsive_mass_kg: f64,
    /// What sloshes, in kg.
    pub convective_mass_kg: f64,
    /// Height of the impulsive mass above the bottom in m, by the pressure on the wall alone.
    pub wall_impulsive_height_m: f64,
    /// Height of the convective mass above the bottom in m, by the pressure on the wall alone.
    pub wall_convective_height_m: f64,
    /// Height of the impulsive mass above the bottom in m, by the pressure on wall and bottom.
    pub impulsive_height_m: f64,
    /// Height of the convective mass above the bottom in m, by the pressure on wall and bottom.
    pub convective_height_m: f64,
    /// Period of sloshing in s.
    pub convective_period_s: f64,
}

impl LiquidTank {
    /// # Errors
    /// [`ModelError`] unless all are finite and > 0.
    pub fn new(radius_m: f64, depth_m: f64, specific_gravity: f64) -> Result<Self, ModelError> {
        positive("radius_m", radius_m)?;
        positive("depth_m", depth_m)?;
        positive("specific_gravity", specific_gravity)?;
        let (d, h) = (2.0 * radius_m, depth_m);
        let density_kg_per_m3 = WATER_KG_PER_M3 * specific_gravity;
        let mass_kg = density_kg_per_m3 * PI * d * d * h / 4.0;
        let wide = 0.866 * d / h;
        let x = 3.68 * h / d;
        let impulsive_height = if d / h < 1.333 { 0.5 - 0.09375 * d / h } else { 0.375 };
        // (cosh x − 1)/sinh x = tanh(x/2)
        let convective_height = 1.0 - libm::tanh(0.5 * x) / x;
        // 1 − (cosh x − 2.01)/(x sinh x), the same and the part of the bottom.
        let of_bottom = 1.01 / (x * libm::sinh(x));
        let impulsive_on_base =
            if d / h < 0.75 { 0.45 } else { 0.5 * wide / libm::tanh(wide) - 0.125 };
        let convective_mass_kg = mass_kg * 0.230 * d / h * libm::tanh(x);
        let impulsive_mass_kg = mass_kg * libm::tanh(wide) / wide;
        let omega = (3.68 * STANDARD_GRAVITY_M_PER_S2 / d * libm::tanh(x)).sqrt();
        Ok(Self {
            radius_m,
            depth_m,
            specific_gravity,
            mass_kg,
            impulsive_mass_kg: impulsive_mass_kg.min(mass_kg - convective_mass_kg),
            convective_mass_kg,
            wall_impulsive_height_m: impulsive_height * h,
            wall_convective_height_m: convective_height * h,
            impulsive_height_m: impulsive_on_base * h,
            convective_height_m: (convective_height + of_bottom) * h,
            convective_period_s: TAU / omega,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear potential flow in a rigid tank, first mode, `λ = 1.8412` the first zero of `J₁′`:
    /// `ω² = λ (g/R) tanh(λ H/R)`, `m_c/m = 2 tanh(λ H/R)/(λ (λ² − 1) H/R)`. Housner's constants are its own to 1.5 %.
    #[test]
    fn sloshing_is_that_of_potential_flow() {
        let lambda = 1.841_183_781_340_659_3;
        for (radius_m, depth_m) in [(10.0, 2.0), (10.0, 8.0), (10.0, 20.0), (3.0, 12.0)] {
            let tank = LiquidTank::new(radius_m, depth_m, 0.8).expect("a tank");
            let deep = depth_m / radius_m;
            let wave = libm::tanh(lambda * deep);
            let omega = (lambda * STANDARD_GRAVITY_M_PER_S2 / radius_m * wave).sqrt();
            let mass = 2.0 * wave / (lambda * (lambda * lambda - 1.0) * deep);
            assert!((tank.convective_period_s * omega / TAU - 1.0).abs() < 1e-3);
            assert!((tank.convective_mass_kg / tank.mass_kg / mass - 1.0).abs() < 0.015);
            let sum_kg = tank.convective_mass_kg + tank.impulsive_mass_kg;
            assert!(sum_kg > 0.9 * tank.mass_kg && sum_kg <= tank.mass_kg * (1.0 + 1e-15));
        }
    }

    /// Eqs (9-15), (9-17) and (9-28) to (9-30) of ACI 350.3-06 worked by hand for D = 9 m, H = 4 m, to four digits.
    #[test]
    fn values_worked_by_hand() {
        let tank = LiquidTank::new(4.5, 4.0, 1.0).expect("a tank");
        assert!((tank.impulsive_mass_kg / tank.mass_kg - 0.4928).abs() < 1e-4);
        assert!((tank.wall_impulsive_height_m - 1.5).abs() < 1e-12);
        // Rounded, with g = 9.81 m/s².
        assert!((tank.convective_period_s - 3.259).abs() < 2e-3);
    }

    /// ACI 350.3-06, section 9.3, worked by hand for R = 10 m: heights with the pressure on the bottom, and those
    /// without it, impulsive and convective.
    #[test]
    fn heights_about_a_plane_below_the_bottom() {
        for (depth_m, with, without) in [
            (3.0, [8.285, 10.993], [1.125, 1.537]),
            (6.0, [7.964, 7.361], [2.250, 3.272]),
            (10.0, [7.970, 7.844], [3.750, 6.055]),
            (20.0, [9.883, 15.11], [8.125, 14.83]),
        ] {
            let tank = LiquidTank::new(10.0, depth_m, 1.0).expect("a tank");
            let found = [tank.impulsive_height_m, tank.convective_height_m];
            let of_wall = [tank.wall_impulsive_height_m, tank.wall_convective_height_m];
            for (found, expected) in
                found.into_iter().chain(of_wall).zip(with.into_iter().chain(without))
            {
                assert!((found / expected - 1.0).abs() < 5e-4, "{depth_m}: {found} for {expected}");
            }
        }
    }

    /// Potential flow of the first mode: the moment of the pressure on wall and bottom about the bottom is that of the
    /// mass at `h'/H = 1 − (cosh y − 2)/(y sinh y)`, `y = 1.8412 H/R`.
    #[test]
    fn exact_convective_height_is_that_of_potential_flow() {
        for depth_m in [2.0, 8.0, 15.0, 30.0] {
            let tank = LiquidTank::new(10.0, depth_m, 1.0).expect("a tank");
            let y = 1.841_183_781_340_659_3 * depth_m / 10.0;
            let height = depth_m * (1.0 - (libm::cosh(y) - 2.0) / (y * libm::sinh(y)));
            // Housner's constants 3.68 and 2.01 for 3.6824 and 2: in a shallow tank 0.01/0.93 of the height.
            assert!((tank.convective_height_m / height - 1.0).abs() < 0.015);
        }
    }

    #[test]
    fn nonsense_is_refused() {
        for (radius_m, depth_m, gravity) in
            [(0.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, f64::NAN)]
        {
            assert!(LiquidTank::new(radius_m, depth_m, gravity).is_err());
        }
    }
}
