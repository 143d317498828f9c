//! Measures of a pair of horizontal components over all directions: RotD50 and RotD100.

use super::Measure;
use crate::error::MotionError;
use crate::motion::{GroundMotion, Ordinates, Spectrum, spectrum};
use crate::numerics::fractile::median;

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
        Ok(Self { values: in_all_directions(x, y, |motion| Ok(measure.of(motion)))? })
    }

    /// RotD50: the median over the directions, the mean of the two middle values.
    #[must_use]
    pub fn median(&self) -> f64 {
        median(&self.values)
    }

    /// RotD100: the largest over the directions.
    #[must_use]
    pub fn largest(&self) -> f64 {
        largest(&self.values)
    }

    /// RotD00: the smallest over the directions.
    #[must_use]
    pub fn smallest(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// Response spectra of a pair over all directions: RotD50 and RotD100 of every ordinate.
///
/// As [`RotD::of`] and [`spectrum`]; each ordinate has its own direction.
///
/// # Errors
/// As those two.
pub fn rotated_spectra(
    x: &GroundMotion,
    y: &GroundMotion,
    periods_s: &[f64],
    damping_ratios: &[f64],
) -> Result<[Spectrum; 2], MotionError> {
    let all: Vec<Spectrum> = in_all_directions(x, y, |motion| {
        spectrum(motion.times_s(), motion.horizontal_m_per_s2(), periods_s, damping_ratios)
    })?;
    let over_directions = |fold: fn(&[f64]) -> f64| Spectrum {
        periods_s: periods_s.to_vec(),
        damping_ratios: damping_ratios.to_vec(),
        ordinates: (0..periods_s.len() * damping_ratios.len())
            .map(|i| {
                let of = |value: fn(&Ordinates) -> f64| {
                    fold(&all.iter().map(|one| value(&one.ordinates[i])).collect::<Vec<f64>>())
                };
                Ordinates {
                    sd_m: of(|o| o.sd_m),
                    sv_m_per_s: of(|o| o.sv_m_per_s),
                    psv_m_per_s: of(|o| o.psv_m_per_s),
                    psa_m_per_s2: of(|o| o.psa_m_per_s2),
                    sa_m_per_s2: of(|o| o.sa_m_per_s2),
                }
            })
            .collect(),
    };
    Ok([over_directions(median), over_directions(largest)])
}

/// What becomes of `x cos φ + y sin φ` at every whole degree from 0 to 179.
fn in_all_directions<T>(
    x: &GroundMotion,
    y: &GroundMotion,
    of: impl Fn(&GroundMotion) -> Result<T, MotionError>,
) -> Result<Vec<T>, MotionError> {
    let (pair, _) = x.with_vertical(y, 1.0)?;
    (0..180).map(|degrees| of(&pair.in_direction(f64::from(degrees))?)).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion along one line: |cos φ| of it in every direction.
    #[test]
    fn rotated_single_component() {
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
    fn rotated_circle() {
        let angle = |k: u32| f64::from(k) * core::f64::consts::TAU / 3600.0;
        let x: Vec<f64> = (0..=7200).map(|k| libm::cos(angle(k))).collect();
        let y: Vec<f64> = (0..=7200).map(|k| libm::sin(angle(k))).collect();
        let x = GroundMotion::evenly_spaced(0.01, x, None).unwrap();
        let y = GroundMotion::evenly_spaced(0.01, y, None).unwrap();
        let rotated = RotD::of(&Measure::Pga, &x, &y).unwrap();
        assert!((rotated.largest() - 1.0).abs() < 1e-12);
        assert!((rotated.median() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rotated_spectra_are_those_of_every_ordinate() {
        let wave = |k: f64, phase: f64| libm::sin(0.3 * k + phase) * libm::exp(-0.02 * k);
        let of = |phase: f64| {
            let a = (0..100).map(|k| wave(f64::from(k), phase)).collect();
            GroundMotion::evenly_spaced(0.02, a, None).unwrap()
        };
        let (x, y) = (of(0.0), of(1.3));
        let [median, largest] = rotated_spectra(&x, &y, &[0.0, 0.3, 1.0], &[0.05]).unwrap();
        assert_eq!(median.periods_s, [0.0, 0.3, 1.0]);
        let rotated = RotD::of(&Measure::Pga, &x, &y).unwrap();
        assert_eq!(median.ordinates[0].psa_m_per_s2, rotated.median());
        assert_eq!(largest.ordinates[0].psa_m_per_s2, rotated.largest());
        for (i, name) in [(1, "PSa(0.3 s)"), (2, "PSa(1 s)")] {
            let rotated = RotD::of(&Measure::parse(name).unwrap(), &x, &y).unwrap();
            let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
            assert!(close(median.ordinates[i].psa_m_per_s2, rotated.median()), "{name}");
            assert!(close(largest.ordinates[i].psa_m_per_s2, rotated.largest()), "{name}");
        }
    }
}
