//! A quantity over time before it is ground motion: what processing works on.

use std::sync::Arc;

use super::{GroundMotion, constant_step};
use crate::error::MotionError;

/// What the values of a channel measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// In m/s².
    Acceleration,
    /// In m/s.
    Velocity,
    /// In m.
    Displacement,
    /// Numbers of a recorder, which its constants alone turn into motion.
    Counts,
}

impl Quantity {
    /// Its name in a sentence.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Acceleration => "acceleration",
            Self::Velocity => "velocity",
            Self::Displacement => "displacement",
            Self::Counts => "counts of a recorder",
        }
    }

    /// Name of a column of a table, unit included.
    #[must_use]
    pub fn column(self) -> &'static str {
        match self {
            Self::Acceleration => "acceleration_m_per_s2",
            Self::Velocity => "velocity_m_per_s",
            Self::Displacement => "displacement_m",
            Self::Counts => "counts",
        }
    }
}

/// Samples of acceleration, velocity or displacement in SI, linear between them; times start at 0,
/// and a time that stands twice is a jump.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub(super) times_s: Arc<Vec<f64>>,
    pub(super) values: Arc<Vec<f64>>,
    pub(super) quantity: Quantity,
    pub(super) dt_s: Option<f64>,
}

impl Series {
    /// Samples at any times; the clock is moved to start at the first.
    ///
    /// # Errors
    /// As [`GroundMotion::new`].
    pub fn new(
        times_s: Vec<f64>,
        values: Vec<f64>,
        quantity: Quantity,
    ) -> Result<Self, MotionError> {
        Ok(Self::from_motion(GroundMotion::new(times_s, values, None)?, quantity))
    }

    /// Samples at `0, dt, 2 dt, …`.
    ///
    /// # Errors
    /// As [`GroundMotion::evenly_spaced`].
    pub fn evenly_spaced(
        dt_s: f64,
        values: Vec<f64>,
        quantity: Quantity,
    ) -> Result<Self, MotionError> {
        Ok(Self::from_motion(GroundMotion::evenly_spaced(dt_s, values, None)?, quantity))
    }

    /// The samples of a motion's horizontal component, taken as `quantity`.
    fn from_motion(motion: GroundMotion, quantity: Quantity) -> Self {
        let GroundMotion { times_s, horizontal_m_per_s2: values, dt_s, .. } = motion;
        Self { times_s, values, quantity, dt_s }
    }

    /// Times in s, from 0, not decreasing.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Values in m/s², m/s or m.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// What they measure.
    #[must_use]
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// The constant step in s, or `None` where the samples are unevenly spaced or jump.
    #[must_use]
    pub fn dt_s(&self) -> Option<f64> {
        self.dt_s
    }

    /// Time of the last sample in s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.times_s[self.times_s.len() - 1]
    }

    /// The acceleration as ground motion; `None` for another quantity.
    #[must_use]
    pub fn motion(&self) -> Option<GroundMotion> {
        (self.quantity == Quantity::Acceleration).then(|| GroundMotion {
            times_s: self.times_s.clone(),
            horizontal_m_per_s2: self.values.clone(),
            horizontal_y_m_per_s2: None,
            vertical_m_per_s2: None,
            dt_s: self.dt_s,
        })
    }

    /// The sum of series of one quantity, each times its factor, on the union of their times; the
    /// shorter are zero after their ends.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`] for none, for a factor that is not finite, for quantities that
    /// differ; [`MotionError::TooLong`] for too many times.
    pub fn combined(parts: &[(f64, &Self)]) -> Result<Self, MotionError> {
        let refused =
            |expected, found| MotionError::OutOfRange { quantity: "combination", expected, found };
        let Some(((factor, first), rest)) = parts.split_first() else {
            return Err(refused("at least one channel", 0.0));
        };
        let as_motion = |series: &Self| GroundMotion {
            times_s: series.times_s.clone(),
            horizontal_m_per_s2: series.values.clone(),
            horizontal_y_m_per_s2: None,
            vertical_m_per_s2: None,
            dt_s: series.dt_s,
        };
        let mut sum = as_motion(first).scaled(*factor)?;
        for (index, (factor, part)) in rest.iter().enumerate() {
            if part.quantity != first.quantity {
                let expected = "channels that measure one quantity (counted from 1)";
                return Err(refused(expected, (index + 2) as f64));
            }
            let (both, _) = sum.with_vertical(&as_motion(part), *factor)?;
            sum = both.sum();
        }
        Ok(Self::from_motion(sum, first.quantity))
    }

    /// `x cos φ + y sin φ`: the component at the angle φ, in degrees, from the first towards the
    /// second of a pair at right angles.
    ///
    /// # Errors
    /// As [`Series::combined`].
    pub fn rotated(x: &Self, y: &Self, degrees: f64) -> Result<Self, MotionError> {
        let [cos, sin] = super::combine::direction(degrees);
        Self::combined(&[(cos, x), (sin, y)])
    }

    /// A series with other values at these times.
    pub(super) fn with_values(&self, values: Vec<f64>) -> Result<Self, MotionError> {
        super::check_values(self.times_s.len(), &values, None)?;
        Ok(Self { values: Arc::new(values), ..self.clone() })
    }

    /// Value at a time inside, along the straight lines; at a jump the limit from the right, or
    /// from the left where `left` is set.
    pub(super) fn at(&self, t: f64, left: bool) -> f64 {
        let (times, values) = (&self.times_s, &self.values);
        let after = if left {
            times.partition_point(|s| *s < t)
        } else {
            times.partition_point(|s| *s <= t)
        };
        match after {
            0 => values[0],
            n if n == times.len() => values[n - 1],
            n => {
                let fraction = (t - times[n - 1]) / (times[n] - times[n - 1]);
                values[n - 1] + (values[n] - values[n - 1]) * fraction
            }
        }
    }
}

impl GroundMotion {
    /// The horizontal component as a series, to be processed.
    #[must_use]
    pub fn series(&self) -> Series {
        Series::from_motion(self.clone(), Quantity::Acceleration)
    }

    /// `Ü + Üv` as a horizontal motion.
    fn sum(&self) -> Self {
        let up = self.vertical_m_per_s2().unwrap_or_default();
        let sum = self.horizontal_m_per_s2.iter().zip(up).map(|(a, b)| a + b);
        Self {
            times_s: self.times_s.clone(),
            horizontal_m_per_s2: Arc::new(sum.collect()),
            horizontal_y_m_per_s2: None,
            vertical_m_per_s2: None,
            dt_s: constant_step(&self.times_s).or(self.dt_s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(values: &[f64]) -> Series {
        Series::evenly_spaced(0.5, values.to_vec(), Quantity::Acceleration).unwrap()
    }

    #[test]
    fn combination_and_rotation() {
        let (x, y) = (series(&[1.0, 2.0, 3.0]), series(&[4.0, -2.0, 0.0]));
        let sum = Series::combined(&[(2.0, &x), (-0.5, &y)]).unwrap();
        assert_eq!(sum.values(), [0.0, 5.0, 6.0]);
        assert_eq!(sum.dt_s(), Some(0.5));
        assert_eq!(Series::rotated(&x, &y, 90.0).unwrap().values(), y.values());
        assert_eq!(Series::rotated(&x, &y, 180.0).unwrap().values(), [-1.0, -2.0, -3.0]);
        let third = Series::rotated(&x, &y, 60.0).unwrap();
        assert!((third.values()[0] - (0.5 + 4.0 * 0.75_f64.sqrt())).abs() < 1e-14);
        let velocity = Series::new(vec![0.0, 1.0], vec![0.0; 2], Quantity::Velocity).unwrap();
        assert!(Series::combined(&[(1.0, &x), (1.0, &velocity)]).is_err());
        assert!(Series::combined(&[]).is_err());
    }

    #[test]
    fn values_between_samples() {
        let s =
            Series::new(vec![0.0, 1.0, 1.0, 2.0], vec![0.0, 1.0, 5.0, 7.0], Quantity::Acceleration)
                .unwrap();
        assert_eq!([s.at(0.25, false), s.at(1.0, true), s.at(1.0, false)], [0.25, 1.0, 5.0]);
        assert_eq!([s.at(1.5, false), s.at(2.0, false), s.at(2.0, true)], [6.0, 7.0, 7.0]);
    }
}
