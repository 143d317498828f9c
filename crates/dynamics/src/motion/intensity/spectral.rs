//! Measures of spectra: mean period, spectrum intensities, spectral acceleration.

use crate::motion::spectrum::{Ordinates, logarithmic_periods, spectrum};
use crate::motion::{FourierSpectrum, GroundMotion};

use super::DEFAULT_DAMPING_RATIO;

/// Band of the mean period and largest step between its frequencies, in Hz.
const MEAN_PERIOD_FROM_HZ: f64 = 0.25;
const MEAN_PERIOD_TO_HZ: f64 = 20.0;
const MEAN_PERIOD_STEP_HZ: f64 = 0.05;

/// Periods of the spectrum intensities: every 0.01 s from 0.1 to 2.5 s, of which the first 41 reach
/// 0.5 s.
const INTENSITY_STEPS_PER_S: f64 = 100.0;
const INTENSITY_FIRST: usize = 10;
const INTENSITY_LAST: usize = 250;
const ASI_LAST: usize = 50;

/// Number of periods of Sa_avg.
const AVERAGE_PERIODS: usize = 50;

/// Mean period `Σ C²/f / Σ C²` over the frequencies `0.25 Hz ≤ f ≤ 20 Hz`, at most 0.05 Hz apart;
/// in s, 0 for a motion that has nothing there.
///
/// The sums depend on the step between frequencies by 1 % or so where that is the inverse of the
/// duration. Here it is at most a quarter of that: within 0.3 % of what ever finer steps give.
pub(super) fn mean_period(motion: &GroundMotion) -> f64 {
    let step_hz = MEAN_PERIOD_STEP_HZ.min(0.25 / motion.duration_s());
    let spectrum = FourierSpectrum::of(motion, step_hz);
    let (mut weighted, mut sum) = (0.0, 0.0);
    for (f, c) in spectrum.frequencies_hz().zip(&spectrum.amplitudes_m_per_s) {
        if (MEAN_PERIOD_FROM_HZ..=MEAN_PERIOD_TO_HZ).contains(&f) {
            weighted += c * c / f;
            sum += c * c;
        }
    }
    if sum > 0.0 { weighted / sum } else { 0.0 }
}

/// Integrals of spectra at 5 % over periods, by the trapezium rule with steps of 0.01 s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Intensities {
    /// `∫ PSv dT` from 0.1 to 2.5 s, in m.
    pub housner_m: f64,
    /// `∫ Sa dT` from 0.1 to 0.5 s, in m/s.
    pub asi_m_per_s: f64,
    /// `∫ Sv dT` from 0.1 to 2.5 s, in m.
    pub vsi_m: f64,
}

pub(super) fn intensities(motion: &GroundMotion) -> Intensities {
    let periods_s: Vec<f64> =
        (INTENSITY_FIRST..=INTENSITY_LAST).map(|k| k as f64 / INTENSITY_STEPS_PER_S).collect();
    let ordinates = all(motion, &periods_s, DEFAULT_DAMPING_RATIO);
    let integral = |last: usize, value: fn(&Ordinates) -> f64| {
        let part = &ordinates[..=last - INTENSITY_FIRST];
        let pairs = part.windows(2).map(|pair| 0.5 * (value(&pair[0]) + value(&pair[1])));
        pairs.sum::<f64>() / INTENSITY_STEPS_PER_S
    };
    Intensities {
        housner_m: integral(INTENSITY_LAST, |o| o.psv_m_per_s),
        asi_m_per_s: integral(ASI_LAST, |o| o.sa_m_per_s2),
        vsi_m: integral(INTENSITY_LAST, |o| o.sv_m_per_s),
    }
}

/// Ordinates at one period.
pub(super) fn ordinates(motion: &GroundMotion, period_s: f64, damping_ratio: f64) -> Ordinates {
    all(motion, &[period_s], damping_ratio)[0]
}

/// Geometric mean of PSa at 50 periods, both ends included, evenly spaced by their logarithm.
pub(super) fn average(motion: &GroundMotion, from_s: f64, to_s: f64, damping_ratio: f64) -> f64 {
    let periods_s = logarithmic_periods(from_s, to_s, AVERAGE_PERIODS);
    let ordinates = all(motion, &periods_s, damping_ratio);
    if ordinates.iter().any(|o| o.psa_m_per_s2 == 0.0) {
        return 0.0;
    }
    let sum: f64 = ordinates.iter().map(|o| libm::log(o.psa_m_per_s2)).sum();
    libm::exp(sum / AVERAGE_PERIODS as f64)
}

/// Ordinates at periods ≥ 0, one damping ratio in `[0, 1)`: those of a measure that was checked.
///
/// A period below a ten-millionth of the duration is taken as 0.
fn all(motion: &GroundMotion, periods_s: &[f64], damping_ratio: f64) -> Vec<Ordinates> {
    let shortest_s = 1e-7 * motion.duration_s();
    let rigid_or_not = |&t: &f64| if t < shortest_s { 0.0 } else { t };
    let periods_s: Vec<f64> = periods_s.iter().map(rigid_or_not).collect();
    let (times_s, acceleration) = (motion.times_s(), motion.horizontal_m_per_s2());
    spectrum(times_s, acceleration, &periods_s, &[damping_ratio]).map_or_else(
        |_| vec![Ordinates { sa_m_per_s2: f64::NAN, ..Ordinates::default() }; periods_s.len()],
        |spectrum| spectrum.ordinates,
    )
}
