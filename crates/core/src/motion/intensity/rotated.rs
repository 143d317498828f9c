//! Measures of a pair of horizontal components over all directions: RotD50 and RotD100.

use super::Measure;
use crate::error::MotionError;
use crate::motion::GroundMotion;

/// A measure of the component at every whole degree from 0 to 179 between two components.
///
/// D. M. Boore, "Orientation-independent, nongeometric-mean measures of seismic intensity from two
/// horizontal components of motion", Bulletin of the Seismological Society of America 100 (2010)
/// 1830–1835.
#[derive(Clone, Debug, PartialEq)]
pub struct RotD {
    /// The measure in SI at 0°, the first component, 1°, … 179°; 90° is the second component.
    pub values: Vec<f64>,
}

impl RotD {
    /// The measure of `x cos φ + y sin φ` at every degree.
    ///
    /// Times of both are united; the shorter is zero after its end.
    ///
    /// # Errors
    /// [`MotionError`] where the union has too many samples.
    pub fn of(measure: &Measure, x: &GroundMotion, y: &GroundMotion) -> Result<Self, MotionError> {
        let (pair, _) = x.with_vertical(y, 1.0)?;
        let values = (0..180).map(|degrees| {
            let motion = pair.in_direction(f64::from(degrees))?;
            Ok(measure.of(&motion))
        });
        Ok(Self { values: values.collect::<Result<_, MotionError>>()? })
    }

    /// RotD50: the median over the directions, the mean of the two middle values.
    #[must_use]
    pub fn median(&self) -> f64 {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len();
        0.5 * (sorted[(n - 1) / 2] + sorted[n / 2])
    }

    /// RotD100: the largest over the directions.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }

    /// RotD00: the smallest over the directions.
    #[must_use]
    pub fn smallest(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion along one line: |cos φ| of it in every direction.
    #[test]
    fn exact_rotated_single_component() {
        let x = GroundMotion::evenly_spaced(0.5, vec![0.0, 3.0, -1.0, 0.0], None).unwrap();
        let y = GroundMotion::evenly_spaced(0.5, vec![0.0; 4], None).unwrap();
        let rotated = RotD::of(&Measure::Pga, &x, &y).unwrap();
        assert_eq!(rotated.largest(), 3.0);
        assert!(rotated.smallest().abs() < 1e-15);
        // Middle values: |cos| at 45° and 135° are equal.
        assert!((rotated.median() - 3.0 * core::f64::consts::FRAC_1_SQRT_2).abs() < 1e-14);
        assert!((rotated.values[60] - 1.5).abs() < 1e-14);
    }

    /// A motion that turns has the same peak in every direction, but for its sampling.
    #[test]
    fn exact_rotated_circle() {
        let angle = |k: u32| f64::from(k) * core::f64::consts::TAU / 3600.0;
        let x: Vec<f64> = (0..=7200).map(|k| libm::cos(angle(k))).collect();
        let y: Vec<f64> = (0..=7200).map(|k| libm::sin(angle(k))).collect();
        let x = GroundMotion::evenly_spaced(0.01, x, None).unwrap();
        let y = GroundMotion::evenly_spaced(0.01, y, None).unwrap();
        let rotated = RotD::of(&Measure::Pga, &x, &y).unwrap();
        assert!((rotated.largest() - 1.0).abs() < 1e-12);
        assert!((rotated.median() - 1.0).abs() < 1e-12);
    }
}
