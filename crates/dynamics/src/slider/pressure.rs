//! Friction that follows the pressure: the coefficient falls as the pressure grows.
//!
//! ```text
//! μ(p, v) = μ(v) (p/p_ref)^(−m)        0 ≤ m < 1
//! ```
//!
//! so that the force of friction grows with `N^(1 − m)`. The pressure goes with the normal force: under a constant one
//! all coefficients have one factor, under vertical motion friction is that of a normal force `N₀ (N/N₀)^(1 − m)`, with
//! `N₀` that at rest.

use super::ranges::{in_range, positive};
use crate::error::ModelError;
use crate::linear::polynomial::{DEGREE, Polynomial, ZERO};

/// A normal force below this part of that at rest holds and resists nothing.
const NONE_BELOW: f64 = 1e-12;

/// Largest change of the normal force over it that a series takes.
const MOST_CHANGE: f64 = 0.15;

/// How coefficients of friction follow the pressure.
///
/// # Examples
/// ```
/// use slipstick_dynamics::slider::PressureLaw;
///
/// // Coefficients measured at 20 MPa, a bearing under 45 MPa at rest.
/// let law = PressureLaw::new(45e6, 20e6, 0.2)?;
/// assert!((law.factor_at_rest() - 0.850_283).abs() < 1e-6);
///
/// let error = PressureLaw::new(45e6, 20e6, 1.0).unwrap_err();
/// assert!(error.to_string().contains("below 1"));
/// # Ok::<(), slipstick_dynamics::error::ModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureLaw {
    at_rest_pa: f64,
    reference_pa: f64,
    exponent: f64,
}

impl PressureLaw {
    /// The pressure at rest and that of the coefficients in Pa, and the exponent `m`.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] unless both pressures are finite and positive, and the exponent is from 0 to below 1.
    pub fn new(at_rest_pa: f64, reference_pa: f64, exponent: f64) -> Result<Self, ModelError> {
        positive("pressure", at_rest_pa)?;
        positive("reference pressure", reference_pa)?;
        let is_within = (0.0..1.0).contains(&exponent);
        in_range("pressure exponent", "an exponent from 0 to below 1", exponent, is_within)?;
        Ok(Self { at_rest_pa, reference_pa, exponent })
    }

    /// Pressure under the weight alone, in Pa.
    #[must_use]
    pub fn at_rest_pa(&self) -> f64 {
        self.at_rest_pa
    }

    /// Pressure at which the coefficients hold, in Pa.
    #[must_use]
    pub fn reference_pa(&self) -> f64 {
        self.reference_pa
    }

    /// `m`.
    #[must_use]
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// What the coefficients at the reference pressure are multiplied by under the weight alone; exactly 1 where it is
    /// the reference pressure.
    #[must_use]
    pub fn factor_at_rest(&self) -> f64 {
        libm::pow(self.at_rest_pa / self.reference_pa, -self.exponent)
    }
}

/// The normal force that friction follows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pressing {
    exponent: f64,
    at_rest_n: f64,
}

impl Pressing {
    /// By a law, or else the normal force itself.
    pub(crate) fn new(law: Option<&PressureLaw>, at_rest_n: f64) -> Self {
        law.map_or_else(Self::default, |law| Self { exponent: law.exponent, at_rest_n })
    }

    /// Whether it is the normal force itself.
    #[inline(always)]
    pub(crate) fn is_plain(&self) -> bool {
        self.exponent == 0.0
    }

    /// Under a normal force.
    #[inline(always)]
    pub(crate) fn of(&self, normal_n: f64) -> f64 {
        if self.is_plain() { normal_n } else { self.power(normal_n) }
    }

    #[inline(never)]
    fn power(&self, normal_n: f64) -> f64 {
        let ratio = normal_n / self.at_rest_n;
        if ratio > NONE_BELOW {
            self.at_rest_n * libm::pow(ratio, 1.0 - self.exponent)
        } else {
            0.0
        }
    }

    /// Under a normal force and its change over a unit, by powers of the part of it; good over [`reach`](Self::reach).
    #[inline(always)]
    pub(crate) fn series(&self, [normal_n, change_n]: [f64; 2]) -> Polynomial {
        if self.is_plain() {
            let mut series = ZERO;
            (series[0], series[1]) = (normal_n, change_n);
            return series;
        }
        self.series_of_power([normal_n, change_n])
    }

    /// `(1 + x)^p = Σ p (p − 1) … (p − k + 1)/k! x^k`
    #[inline(never)]
    fn series_of_power(&self, [normal_n, change_n]: [f64; 2]) -> Polynomial {
        let mut series = ZERO;
        series[0] = self.power(normal_n);
        if series[0] > 0.0 {
            let x = change_n / normal_n;
            for k in 0..DEGREE {
                series[k + 1] = series[k] * x * (1.0 - self.exponent - k as f64) / (k + 1) as f64;
            }
        }
        series
    }

    /// The part of a unit over which the series of a normal force with a change over the unit is good to rounding.
    #[inline(always)]
    pub(crate) fn reach(&self, [normal_n, change_n]: [f64; 2]) -> f64 {
        if self.is_plain() || change_n == 0.0 {
            return f64::INFINITY;
        }
        let least_n = NONE_BELOW * self.at_rest_n;
        if normal_n > least_n {
            MOST_CHANGE * (normal_n / change_n.abs())
        } else {
            // Up to where there is friction, and a hair beyond.
            (2.0 * least_n - normal_n) / change_n.abs()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::polynomial::value;

    #[test]
    fn at_the_reference_pressure_nothing_changes() {
        let law = PressureLaw::new(30e6, 30e6, 0.3).expect("a law");
        assert_eq!(law.factor_at_rest(), 1.0);
        for n in [3.7, 1e5, 123.456] {
            assert_eq!(Pressing::new(Some(&law), n).of(n), n);
        }
    }

    #[test]
    fn series_is_the_power_as_far_as_it_reaches() {
        let law = PressureLaw::new(30e6, 20e6, 0.25).expect("a law");
        let pressing = Pressing::new(Some(&law), 1000.0);
        for [normal_n, change_n] in [[1000.0, 400.0], [30.0, -500.0], [2.0, 1.0], [1e-6, 1e-7]] {
            let (series, reach) =
                (pressing.series([normal_n, change_n]), pressing.reach([normal_n, change_n]));
            for i in 0..=10 {
                let part = reach * f64::from(i) / 10.0;
                let own = pressing.of(normal_n + change_n * part);
                assert!((value(&series, part) - own).abs() <= 1e-14 * series[0], "{normal_n}");
            }
        }
        assert_eq!(Pressing::default().series([2.0, 3.0])[..3], [2.0, 3.0, 0.0]);
        assert_eq!(pressing.of(0.0), 0.0);
    }
}
