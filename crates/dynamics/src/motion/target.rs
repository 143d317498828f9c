//! Target spectra, and the factors that bring pairs of records to one.

use super::intensity::rotated_spectra;
use super::{GroundMotion, logarithmic_periods};
use crate::error::MotionError;

/// A spectrum of pseudo-acceleration over the period, 5 % damped.
#[derive(Clone, Debug, PartialEq)]
pub enum TargetSpectrum {
    /// Points, periods rising, linear between the logarithms of both; between a period of 0 and the next
    /// linear.
    Points {
        /// Periods in s, rising; the first may be 0.
        periods_s: Vec<f64>,
        /// Ordinates in m/s², > 0, one a period.
        sa_m_per_s2: Vec<f64>,
    },
    /// The two-period shape of ASCE/SEI 7, section 11.4: `SDS (0.4 + 0.6 T/T0)` up to
    /// `T0 = 0.2 SD1/SDS`, `SDS` up to `TS = SD1/SDS`, `SD1/T` up to `TL`, then `SD1 TL/T²`.
    Code {
        /// Ordinate at short periods in m/s², > 0.
        sds_m_per_s2: f64,
        /// Ordinate at 1 s in m/s², > 0.
        sd1_m_per_s2: f64,
        /// Period from which displacement is constant, in s, > 0.
        tl_s: f64,
    },
}

impl TargetSpectrum {
    /// A spectrum of points.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`] for fewer than two points, ordinates that are not finite and > 0,
    /// periods that are not finite and at least 0, and periods that do not rise.
    pub fn points(periods_s: Vec<f64>, sa_m_per_s2: Vec<f64>) -> Result<Self, MotionError> {
        let positive = |values: &[f64]| values.iter().all(|v| v.is_finite() && *v > 0.0);
        let fault =
            |quantity, expected, found| MotionError::OutOfRange { quantity, expected, found };
        if periods_s.len() < 2 || periods_s.len() != sa_m_per_s2.len() {
            let found = periods_s.len() as f64;
            return Err(fault("number of points", "two at least, each with an ordinate", found));
        }
        if let Some(pair) = periods_s.windows(2).find(|pair| !(pair[0] < pair[1])) {
            return Err(fault("period", "periods that rise", pair[1]));
        }
        if !(periods_s[0] >= 0.0 && positive(&periods_s[1..])) {
            return Err(fault("period", "finite values of at least 0", periods_s[0]));
        }
        if let Some(sa) = sa_m_per_s2.iter().find(|v| !positive(&[**v])) {
            return Err(fault("ordinate", "finite values > 0", *sa));
        }
        Ok(Self::Points { periods_s, sa_m_per_s2 })
    }

    /// Ordinate at a period in m/s²; `None` beyond the points.
    #[must_use]
    pub fn at(&self, period_s: f64) -> Option<f64> {
        match self {
            Self::Code { sds_m_per_s2: sds, sd1_m_per_s2: sd1, tl_s } => {
                let ts = sd1 / sds;
                Some(match period_s {
                    t if t < 0.2 * ts => sds * (0.4 + 0.6 * t / (0.2 * ts)),
                    t if t <= ts => *sds,
                    t if t <= *tl_s => sd1 / t,
                    t => sd1 * tl_s / (t * t),
                })
            }
            Self::Points { periods_s, sa_m_per_s2 } => {
                let last = periods_s.len() - 1;
                if !(periods_s[0] <= period_s && period_s <= periods_s[last]) {
                    return None;
                }
                let i = periods_s.partition_point(|t| *t <= period_s).clamp(1, last);
                let (low, high) = (sa_m_per_s2[i - 1], sa_m_per_s2[i]);
                if periods_s[i - 1] == 0.0 {
                    return Some(low + (high - low) * period_s / periods_s[i]);
                }
                let ln = |v: f64| libm::log(v);
                let part = (ln(period_s) - ln(periods_s[i - 1]))
                    / (ln(periods_s[i]) - ln(periods_s[i - 1]));
                Some(low * libm::exp(part * libm::log(high / low)))
            }
        }
    }
}

/// Pairs brought to a target spectrum, each by one factor on both components.
#[derive(Clone, Debug, PartialEq)]
pub struct Matched {
    /// Periods in s at which they are compared.
    pub periods_s: Vec<f64>,
    /// The target there, in m/s².
    pub target_m_per_s2: Vec<f64>,
    /// RotD100 of each pair there, scaled, in m/s².
    pub pairs_m_per_s2: Vec<Vec<f64>>,
    /// Their mean.
    pub mean_m_per_s2: Vec<f64>,
    /// The factor on both components of each pair.
    pub factors: Vec<f64>,
    /// Standard deviation of `ln(RotD100/target)` over the periods, of each pair.
    pub misfits: Vec<f64>,
    /// The factor that all pairs were raised by besides, so that their mean is nowhere below
    /// [`LEAST_SHARE`] of the target; 1 where it was not needed.
    pub raised: f64,
    /// Least ratio of the mean to the target, and its period in s.
    pub least: [f64; 2],
}

/// Share of the target below which the mean must not fall (ASCE/SEI 7-22, 16.2.3.2).
pub const LEAST_SHARE: f64 = 0.9;

/// Periods at which pairs are compared, at equal ratios.
const PERIODS: usize = 50;

/// Periods of a comparison over a range.
#[must_use]
pub fn matching_periods([from_s, to_s]: [f64; 2]) -> Vec<f64> {
    logarithmic_periods(from_s, to_s, PERIODS)
}

/// RotD100 of a pair at periods, 5 % damped pseudo-acceleration in m/s².
///
/// # Errors
/// As [`rotated_spectra`].
pub fn maximum_direction(
    x: &GroundMotion,
    y: &GroundMotion,
    periods_s: &[f64],
) -> Result<Vec<f64>, MotionError> {
    let [_, largest] = rotated_spectra(x, y, periods_s, &[0.05])?;
    Ok(largest.of_damping(0).iter().map(|ordinates| ordinates.psa_m_per_s2).collect())
}

/// RotD100 of a record and the other component of its pair, which a motion in two horizontal directions
/// has in it, at periods; 5 % damped pseudo-acceleration in m/s².
///
/// # Errors
/// As [`maximum_direction`].
pub fn maximum_direction_of_pair(
    first: &GroundMotion,
    other: Option<&GroundMotion>,
    periods_s: &[f64],
) -> Result<Vec<f64>, MotionError> {
    match other {
        Some(other) => maximum_direction(first, other, periods_s),
        None => maximum_direction(&first.along_x(), &first.along_y(), periods_s),
    }
}

impl Matched {
    /// The factors that bring spectra of pairs to a target in the mean of the logarithms over the
    /// periods, all raised by one more where the mean of the pairs falls below [`LEAST_SHARE`] of the
    /// target.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`] for periods beyond the target, and a pair without motion.
    pub fn new(
        target: &TargetSpectrum,
        periods_s: Vec<f64>,
        spectra: &[Vec<f64>],
    ) -> Result<Self, MotionError> {
        let of_target = |t: &f64| {
            target.at(*t).ok_or(MotionError::OutOfRange {
                quantity: "period",
                expected: "periods within those of the target spectrum",
                found: *t,
            })
        };
        let target_m_per_s2 = periods_s.iter().map(of_target).collect::<Result<Vec<_>, _>>()?;
        let count = periods_s.len() as f64;
        let ratios = |spectrum: &[f64]| -> Vec<f64> {
            target_m_per_s2.iter().zip(spectrum).map(|(t, s)| libm::log(t / s)).collect()
        };
        let mut factors = Vec::with_capacity(spectra.len());
        let mut misfits = Vec::with_capacity(spectra.len());
        for spectrum in spectra {
            let ratios = ratios(spectrum);
            let mean = ratios.iter().sum::<f64>() / count;
            let factor = libm::exp(mean);
            if !(factor.is_finite() && factor > 0.0) {
                let expected = "a pair that moves at every period";
                return Err(MotionError::OutOfRange {
                    quantity: "factor",
                    expected,
                    found: factor,
                });
            }
            let squares = ratios.iter().map(|ratio| (ratio - mean) * (ratio - mean)).sum::<f64>();
            factors.push(factor);
            misfits.push((squares / count).sqrt());
        }
        let mean = |factors: &[f64], i: usize| {
            let sum: f64 = spectra.iter().zip(factors).map(|(s, f)| f * s[i]).sum();
            sum / factors.len().max(1) as f64
        };
        let least = |factors: &[f64]| {
            let share = |i: usize| [mean(factors, i) / target_m_per_s2[i], periods_s[i]];
            let all = (0..periods_s.len()).map(share);
            all.reduce(|a, b| if b[0] < a[0] { b } else { a }).unwrap_or([f64::NAN; 2])
        };
        let raised = (LEAST_SHARE / least(&factors)[0]).max(1.0);
        factors.iter_mut().for_each(|factor| *factor *= raised);
        let scaled = |(s, f): (&Vec<f64>, &f64)| s.iter().map(|value| f * value).collect();
        Ok(Self {
            pairs_m_per_s2: spectra.iter().zip(&factors).map(scaled).collect(),
            mean_m_per_s2: (0..periods_s.len()).map(|i| mean(&factors, i)).collect(),
            least: least(&factors),
            periods_s,
            target_m_per_s2,
            factors,
            misfits,
            raised,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of the shape, and its branches on both sides of them.
    #[test]
    fn shape_of_the_code() {
        let shape = TargetSpectrum::Code { sds_m_per_s2: 10.0, sd1_m_per_s2: 6.0, tl_s: 4.0 };
        for (period_s, expected) in [
            (0.0, 4.0),
            (0.06, 7.0),
            (0.12, 10.0),
            (0.6, 10.0),
            (1.0, 6.0),
            (4.0, 1.5),
            (8.0, 0.375),
        ] {
            let found = shape.at(period_s).unwrap();
            assert!((found - expected).abs() < 1e-12, "{period_s}: {found}");
        }
    }

    #[test]
    fn points_are_joined_on_logarithms() {
        let target = TargetSpectrum::points(vec![0.1, 1.0, 4.0], vec![8.0, 8.0, 2.0]).unwrap();
        assert!((target.at(0.3).unwrap() - 8.0).abs() < 1e-12);
        assert!((target.at(2.0).unwrap() - 4.0).abs() < 1e-12);
        assert_eq!((target.at(0.1), target.at(4.0)), (Some(8.0), Some(2.0)));
        assert_eq!((target.at(0.09), target.at(4.1)), (None, None));
        let from_zero = TargetSpectrum::points(vec![0.0, 0.1, 1.0], vec![4.0, 8.0, 8.0]).unwrap();
        assert_eq!([0.0, 0.05, 0.1].map(|t| from_zero.at(t)), [Some(4.0), Some(6.0), Some(8.0)]);
        for (t, sa) in [
            (vec![-0.1, 1.0], vec![1.0; 2]),
            (vec![1.0], vec![1.0]),
            (vec![1.0, 1.0], vec![1.0; 2]),
            (vec![1.0, 2.0], vec![1.0, 0.0]),
        ] {
            assert!(TargetSpectrum::points(t, sa).is_err());
        }
    }

    /// Pairs of the target's own shape are brought onto it; a dip of their mean raises all.
    #[test]
    fn pairs_are_brought_to_the_target() {
        let target = TargetSpectrum::Code { sds_m_per_s2: 10.0, sd1_m_per_s2: 6.0, tl_s: 4.0 };
        let periods = matching_periods([0.2, 3.0]);
        assert_eq!((periods[0], periods[PERIODS - 1]), (0.2, 3.0));
        let shape: Vec<f64> = periods.iter().map(|t| target.at(*t).unwrap()).collect();
        let times = |k: f64| shape.iter().map(|v| k * v).collect::<Vec<_>>();
        let matched = Matched::new(&target, periods.clone(), &[times(0.5), times(4.0)]).unwrap();
        assert!(
            (matched.factors[0] - 2.0).abs() < 1e-12 && (matched.factors[1] - 0.25).abs() < 1e-12
        );
        assert!(matched.misfits.iter().all(|misfit| *misfit < 1e-12));
        assert_eq!(matched.raised, 1.0);
        let mut dip = times(1.0);
        dip[20] *= 0.5;
        let matched = Matched::new(&target, periods.clone(), &[dip]).unwrap();
        assert!(matched.raised > 1.5);
        assert!((matched.least[0] - LEAST_SHARE).abs() < 1e-12 && matched.least[1] == periods[20]);
        assert!(Matched::new(&target, periods, &[vec![0.0; PERIODS]]).is_err());
    }
}
