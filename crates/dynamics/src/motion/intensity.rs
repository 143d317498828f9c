//! Intensity measures: one number that says how strong a ground motion is.
//!
//! All are those of the horizontal component as the piecewise-linear motion that is analysed:
//! integrals are exact, peaks and crossings between samples count. The book's page on measures has
//! a row for each, with formula, constants and source.

mod durations;
mod fiv3;
mod integrals;
mod level;
mod names;
mod rotated;
mod spectral;
mod standard;

pub use level::{LevelMeasure, Rotated};
pub use rotated::{Components, RotD, SaInPlane, rotated_spectra};
pub use standard::IntensityMeasures;

use super::GroundMotion;

/// Damping ratio of a spectral measure where none is written.
pub const DEFAULT_DAMPING_RATIO: f64 = 0.05;

/// Threshold of the bracketed and the uniform duration where none is written: 0.05 g, in m/s².
pub const DEFAULT_THRESHOLD_M_PER_S2: f64 = 0.05 * crate::units::STANDARD_GRAVITY_M_PER_S2;

/// An intensity measure with its parameters.
///
/// ```
/// use slipstick_dynamics::motion::intensity::Measure;
/// let measure = Measure::parse("Sa(1.2 s, 2 %)").unwrap();
/// assert_eq!(measure, Measure::Sa { period_s: 1.2, damping_ratio: 0.02 });
/// assert_eq!(measure.to_string(), "Sa(1.2 s, 2 %)");
/// assert_eq!(measure.column(), "sa_1.2s_2pct_m_per_s2");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Measure {
    /// Largest |Ü|, m/s².
    Pga,
    /// Largest |U̇|, m/s, from rest.
    Pgv,
    /// Largest |U|, m, from rest.
    Pgd,
    /// Arias intensity `π/(2g) ∫ Ü² dt` with g = 9.80665 m/s², m/s.
    Arias,
    /// Cumulative absolute velocity `∫ |Ü| dt`, m/s.
    Cav,
    /// Standardised CAV: that of the 1 s windows, counted from the start, whose peak exceeds
    /// 0.025 g; m/s.
    CavStd,
    /// Significant duration from 5 % to 75 % of the Arias intensity, s.
    D5To75,
    /// Significant duration from 5 % to 95 % of the Arias intensity, s.
    D5To95,
    /// From the first to the last time that |Ü| is above a threshold, s.
    Bracketed {
        /// Threshold in m/s².
        threshold_m_per_s2: f64,
    },
    /// Time during which |Ü| is above a threshold, s.
    Uniform {
        /// Threshold in m/s².
        threshold_m_per_s2: f64,
    },
    /// Mean period `Σ C²/f / Σ C²` of the Fourier amplitudes from 0.25 to 20 Hz, s.
    MeanPeriod,
    /// Housner's spectrum intensity `∫ PSv(T, 5 %) dT` from 0.1 to 2.5 s, m.
    Housner,
    /// Acceleration spectrum intensity `∫ Sa(T, 5 %) dT` from 0.1 to 0.5 s, m/s.
    Asi,
    /// Velocity spectrum intensity `∫ Sv(T, 5 %) dT` from 0.1 to 2.5 s, m.
    Vsi,
    /// Spectral acceleration: largest total acceleration of an oscillator, m/s².
    Sa {
        /// Period in s; 0 is the rigid oscillator.
        period_s: f64,
        /// Damping ratio, from 0 to below 1.
        damping_ratio: f64,
    },
    /// Pseudo-spectral acceleration: ω² times the largest displacement of an oscillator, m/s².
    PSa {
        /// Period in s; 0 is the rigid oscillator.
        period_s: f64,
        /// Damping ratio, from 0 to below 1.
        damping_ratio: f64,
    },
    /// Geometric mean of PSa at 50 periods, evenly spaced by their logarithm, m/s².
    SaAverage {
        /// First period in s, > 0.
        from_s: f64,
        /// Last period in s, > the first.
        to_s: f64,
        /// Damping ratio, from 0 to below 1.
        damping_ratio: f64,
    },
    /// Filtered incremental velocity of Dávalos and Miranda, m/s.
    Fiv3 {
        /// Period in s, > 0.
        period_s: f64,
        /// Length of the window over the period.
        alpha: f64,
        /// Corner frequency of the filter times the period.
        beta: f64,
    },
}

impl Measure {
    /// Whether the measure of a motion times a factor ≥ 0 is the measure times that factor, so that
    /// a motion can be scaled to a level of it.
    #[must_use]
    pub fn scales(&self) -> bool {
        !matches!(
            self,
            Self::Arias
                | Self::CavStd
                | Self::D5To75
                | Self::D5To95
                | Self::Bracketed { .. }
                | Self::Uniform { .. }
                | Self::MeanPeriod
        )
    }

    /// The measure of a motion, in SI.
    ///
    /// A motion that is zero throughout has 0 of everything. An oscillator whose period is below a
    /// ten-millionth of the duration is taken as rigid.
    #[must_use]
    pub fn of(&self, motion: &GroundMotion) -> f64 {
        match *self {
            Self::Pga => super::figures::peak(motion.horizontal_m_per_s2()),
            Self::Pgv => motion.figures().pgv_m_per_s,
            Self::Pgd => motion.figures().pgd_m,
            Self::Arias => integrals::arias(motion),
            Self::Cav => integrals::cav(motion),
            Self::CavStd => integrals::cav_std(motion),
            Self::D5To75 => durations::significant(motion, 0.05, 0.75),
            Self::D5To95 => durations::significant(motion, 0.05, 0.95),
            Self::Bracketed { threshold_m_per_s2 } => {
                durations::above(motion, threshold_m_per_s2).bracketed_s
            }
            Self::Uniform { threshold_m_per_s2 } => {
                durations::above(motion, threshold_m_per_s2).uniform_s
            }
            Self::MeanPeriod => spectral::mean_period(motion),
            Self::Housner => spectral::intensities(motion).housner_m,
            Self::Asi => spectral::intensities(motion).asi_m_per_s,
            Self::Vsi => spectral::intensities(motion).vsi_m,
            Self::Sa { period_s, damping_ratio } => {
                spectral::ordinates(motion, period_s, damping_ratio).sa_m_per_s2
            }
            Self::PSa { period_s, damping_ratio } => {
                spectral::ordinates(motion, period_s, damping_ratio).psa_m_per_s2
            }
            Self::SaAverage { from_s, to_s, damping_ratio } => {
                spectral::average(motion, from_s, to_s, damping_ratio)
            }
            Self::Fiv3 { period_s, alpha, beta } => fiv3::fiv3(motion, period_s, alpha, beta),
        }
    }
}
