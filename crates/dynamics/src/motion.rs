//! Ground motion: piecewise-linear table acceleration along and normal to the sliding surface.

mod combine;
mod figures;
mod fourier;
pub mod intensity;
mod made;
mod oscillator;
pub mod processing;
mod series;
mod spectrum;
pub mod target;

pub use figures::Figures;
pub use fourier::FourierSpectrum;
pub use made::{Pulse, PulseShape, Sine, Sweep, SweepKind};
pub use series::{Quantity, Series};
pub use spectrum::{Ordinates, Spectrum, USUAL_PERIODS, logarithmic_periods, spectrum};

use std::sync::Arc;

use crate::error::MotionError;
use crate::numerics::fractile::upper_median;
use crate::units::LARGEST;

/// Most samples that a motion may have.
pub const MAX_SAMPLES: usize = 100_000_000;

/// Longest time step, and longest mean of uneven ones, in s.
pub const MAX_STEP_S: f64 = 1000.0;

/// Usual steps that a motion of `n` samples may take with its gaps: `USUAL + n USUAL_A_SAMPLE`. Steps
/// below `SHORTEST_USUAL_S` are edges of jumps and not usual.
const USUAL: f64 = 1e6;
const USUAL_A_SAMPLE: f64 = 10.0;
const SHORTEST_USUAL_S: f64 = 1e-3;

/// Acceleration of the table, linear between samples.
///
/// Times start at 0 and do not decrease; a time that stands twice is a jump (left limit, then right
/// limit). Before the first sample the table is at rest: a first sample other than 0 is a jump at
/// t = 0. After the last sample both accelerations are 0. Copies share the samples.
///
/// # Examples
/// ```
/// use slipstick_dynamics::motion::GroundMotion;
///
/// // A pulse of 3 m/s² for half a second: 0.5 s stands twice, for the jump at its end.
/// let motion = GroundMotion::new(vec![0.0, 0.5, 0.5, 2.0], vec![3.0, 3.0, 0.0, 0.0], None)?;
/// assert_eq!(motion.figures().pga_m_per_s2, 3.0);
///
/// let scaled = GroundMotion::evenly_spaced(0.01, vec![0.0, 1.0, -2.0, 0.5], None)?
///     .scaled_to_peak(4.0)?
///     .with_tail(5.0)?;
/// assert_eq!(scaled.horizontal_m_per_s2()[..4], [0.0, 2.0, -4.0, 1.0]);
/// # Ok::<(), slipstick_dynamics::error::MotionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GroundMotion {
    times_s: Arc<Vec<f64>>,
    horizontal_m_per_s2: Arc<Vec<f64>>,
    horizontal_y_m_per_s2: Option<Arc<Vec<f64>>>,
    vertical_m_per_s2: Option<Arc<Vec<f64>>>,
    dt_s: Option<f64>,
}

impl GroundMotion {
    /// A motion from samples at any times; the clock is moved to start at the first.
    ///
    /// `horizontal` is Ü in m/s², positive towards +x; `vertical` is Üv in m/s², positive upwards.
    /// Times that follow a constant step to within rounding (8 ulp of the duration) are taken as
    /// evenly spaced.
    ///
    /// # Errors
    /// [`MotionError`] for fewer than two samples, lists of different lengths, values that are not
    /// finite or larger than [`LARGEST`], times that decrease or stand still for more than two samples, no duration, and a
    /// duration out of proportion to the samples.
    pub fn new(
        mut times_s: Vec<f64>,
        horizontal: Vec<f64>,
        vertical: Option<Vec<f64>>,
    ) -> Result<Self, MotionError> {
        let n = times_s.len();
        check_values(n, &horizontal, vertical.as_deref())?;
        if let Some((index, &found)) = times_s.iter().enumerate().find(|(_, t)| !t.is_finite()) {
            return Err(MotionError::NotFinite { index, quantity: "time", found });
        }
        let start_s = times_s[0];
        if start_s != 0.0 {
            for t in &mut times_s {
                *t -= start_s;
            }
        }
        for index in 1..n {
            let previous_s = times_s[index - 1];
            let found_s = times_s[index];
            let third = index >= 2 && times_s[index - 2] == found_s;
            if !found_s.is_finite() || found_s < previous_s || third {
                return Err(MotionError::TimeOrder { index, previous_s, found_s });
            }
        }
        if times_s[n - 1] <= 0.0 {
            return Err(MotionError::TimeOrder { index: n - 1, previous_s: 0.0, found_s: 0.0 });
        }
        if let Some(Gap { index, longest_s }) = gap(&times_s) {
            let [from_s, to_s] = [times_s[index - 1], times_s[index]];
            return Err(MotionError::Gap { index, from_s, to_s, longest_s });
        }
        let dt_s = constant_step(&times_s);
        Ok(Self::of(times_s, horizontal, vertical, dt_s))
    }

    fn of(
        times_s: Vec<f64>,
        horizontal: Vec<f64>,
        vertical: Option<Vec<f64>>,
        dt_s: Option<f64>,
    ) -> Self {
        Self {
            times_s: Arc::new(times_s),
            horizontal_m_per_s2: Arc::new(horizontal),
            horizontal_y_m_per_s2: None,
            vertical_m_per_s2: vertical.map(Arc::new),
            dt_s,
        }
    }

    /// This motion with an acceleration along y at its samples, Ü_y in m/s².
    ///
    /// # Errors
    /// [`MotionError`] for a list of another length, and values that are not finite or larger than
    /// [`LARGEST`].
    pub fn with_y(self, horizontal_y: Vec<f64>) -> Result<Self, MotionError> {
        check_component(self.len(), "horizontal acceleration along y", &horizontal_y)?;
        Ok(Self { horizontal_y_m_per_s2: Some(Arc::new(horizontal_y)), ..self })
    }

    /// A motion with samples at `0, dt, 2 dt, …`.
    ///
    /// # Errors
    /// As [`GroundMotion::new`], and [`MotionError::OutOfRange`] unless `dt_s` is > 0 and at most
    /// [`MAX_STEP_S`].
    pub fn evenly_spaced(
        dt_s: f64,
        horizontal: Vec<f64>,
        vertical: Option<Vec<f64>>,
    ) -> Result<Self, MotionError> {
        if !(dt_s.is_finite() && dt_s > 0.0) {
            let expected = "a finite time step > 0";
            return Err(MotionError::OutOfRange { quantity: "dt_s", expected, found: dt_s });
        }
        if dt_s > MAX_STEP_S {
            let expected = "a time step of at most 1000 s";
            return Err(MotionError::OutOfRange { quantity: "dt_s", expected, found: dt_s });
        }
        let n = horizontal.len();
        check_values(n, &horizontal, vertical.as_deref())?;
        let times_s: Vec<f64> = (0..n).map(|i| i as f64 * dt_s).collect();
        Ok(Self::of(times_s, horizontal, vertical, Some(dt_s)))
    }

    /// Times of the samples in s, from 0, not decreasing.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Acceleration along the sliding surface at the samples, Ü in m/s².
    #[must_use]
    pub fn horizontal_m_per_s2(&self) -> &[f64] {
        &self.horizontal_m_per_s2
    }

    /// Acceleration along y at the samples, Ü_y in m/s², where the table moves in two horizontal
    /// directions.
    #[must_use]
    pub fn horizontal_y_m_per_s2(&self) -> Option<&[f64]> {
        self.horizontal_y_m_per_s2.as_deref().map(Vec::as_slice)
    }

    /// What of the motion is along x, with the vertical.
    pub fn along_x(&self) -> Self {
        Self { horizontal_y_m_per_s2: None, ..self.clone() }
    }

    /// What of it is along a unit vector as a motion along x, with the vertical.
    pub(crate) fn along(&self, [x, y]: [f64; 2]) -> Self {
        match &self.horizontal_y_m_per_s2 {
            Some(own) if x == 0.0 => Self { horizontal_m_per_s2: own.clone(), ..self.along_x() },
            Some(own) if y != 0.0 => {
                let both = self.horizontal_m_per_s2.iter().zip(own.iter());
                let both = both.map(|(a, b)| x * a + y * b).collect();
                Self { horizontal_m_per_s2: Arc::new(both), ..self.along_x() }
            }
            _ => self.along_x(),
        }
    }

    /// What of it is along y as a motion along x, with the vertical.
    pub fn along_y(&self) -> Self {
        self.along([0.0, 1.0])
    }

    /// Its vertical component as a motion along x.
    pub fn upwards(&self) -> Option<Self> {
        let up = self.vertical_m_per_s2.as_ref()?.clone();
        Some(Self { horizontal_m_per_s2: up, vertical_m_per_s2: None, ..self.along_x() })
    }

    /// What of the motion is along x, alone.
    pub fn horizontal_alone(self) -> Self {
        Self { vertical_m_per_s2: None, horizontal_y_m_per_s2: None, ..self }
    }

    /// Acceleration normal to the sliding surface at the samples, Üv in m/s², positive upwards.
    #[must_use]
    pub fn vertical_m_per_s2(&self) -> Option<&[f64]> {
        self.vertical_m_per_s2.as_deref().map(Vec::as_slice)
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

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.times_s.len()
    }

    /// Never: a motion has at least two samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }
}

fn check_values(n: usize, horizontal: &[f64], vertical: Option<&[f64]>) -> Result<(), MotionError> {
    if n < 2 {
        return Err(MotionError::TooShort { found: n });
    }
    if n > MAX_SAMPLES {
        return Err(MotionError::TooLong { found: n as f64 });
    }
    check_component(n, "horizontal acceleration", horizontal)?;
    vertical.map_or(Ok(()), |vertical| check_component(n, "vertical acceleration", vertical))
}

fn check_component(n: usize, quantity: &'static str, values: &[f64]) -> Result<(), MotionError> {
    if values.len() != n {
        return Err(MotionError::TooShort { found: values.len() });
    }
    let wrong = |a: &f64| !(a.abs() <= LARGEST);
    match values.iter().enumerate().find(|(_, a)| wrong(a)) {
        Some((index, &found)) if found.is_finite() => {
            Err(MotionError::TooLarge { index, quantity, found, limit: LARGEST })
        }
        Some((index, &found)) => Err(MotionError::NotFinite { index, quantity, found }),
        None => Ok(()),
    }
}

/// A step that makes a motion longer than its samples can tell of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Index of the sample after it.
    pub index: usize,
    /// How long the whole motion may be, in s.
    pub longest_s: f64,
}

/// The longest step of times in s (two or more, which do not decrease), where they last out of
/// proportion to their number.
///
/// What is computed of a motion takes time for its samples and for its duration; so a few lines may
/// not ask for hours of it.
pub fn gap(times_s: &[f64]) -> Option<Gap> {
    let n = times_s.len() as f64;
    let duration_s = times_s[times_s.len() - 1] - times_s[0];
    if duration_s <= SHORTEST_USUAL_S * USUAL {
        return None;
    }
    let steps = || times_s.windows(2).map(|t| t[1] - t[0]);
    let usual_s = upper_median(steps().filter(|&h| h > 0.0)).unwrap_or(0.0);
    let filled_s = usual_s.max(SHORTEST_USUAL_S) * (USUAL + n * USUAL_A_SAMPLE);
    let longest_s = libm::floor(filled_s.min(MAX_STEP_S * (n - 1.0)));
    let longer = |best: (usize, f64), (i, h): (usize, f64)| if h > best.1 { (i, h) } else { best };
    let (step, _) = steps().enumerate().fold((0, 0.0), longer);
    (duration_s > longest_s).then_some(Gap { index: step + 1, longest_s })
}

/// The step of `times_s` (two or more, which start at 0) if every time is a multiple of it to within rounding.
pub fn constant_step(times_s: &[f64]) -> Option<f64> {
    let n = times_s.len();
    let end_s = times_s[n - 1];
    let dt_s = end_s / (n - 1) as f64;
    let slack_s = 8.0 * f64::EPSILON * end_s;
    let even = times_s.iter().enumerate().all(|(i, t)| (t - i as f64 * dt_s).abs() <= slack_s);
    // The step as it was written, where the first interval is that: 0.01 rather than 0.01 ± 1 ulp.
    let written_s = times_s[1];
    let as_written = even && ((n - 1) as f64 * written_s - end_s).abs() <= slack_s;
    even.then_some(if as_written { written_s } else { dt_s })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(times_s: &[f64]) -> Option<(usize, f64)> {
        match GroundMotion::new(times_s.to_vec(), vec![0.0; times_s.len()], None) {
            Err(MotionError::Gap { index, longest_s, .. }) => Some((index, longest_s)),
            Err(error) => panic!("{error}"),
            Ok(_) => None,
        }
    }

    /// Squares of what is computed with are finite.
    #[test]
    fn accelerations_are_of_some_size() {
        let of =
            |a| GroundMotion::evenly_spaced(1.0, vec![0.0, a], None).map_err(|e| e.to_string());
        assert_eq!(
            of(-1e150).unwrap_err(),
            "sample 1: expected a horizontal acceleration of at most 1e30 in SI, found -1e150"
        );
        assert!(of(1e30).is_ok() && of(1e-320).is_ok());
    }

    /// A few samples cannot last for days: work grows with the duration.
    #[test]
    fn durations_are_in_proportion_to_the_samples() {
        // 5 samples may last 4 × 1000 s.
        assert_eq!(refused(&[0.0, 0.01, 0.02, 0.03, 1e5]), Some((4, 4000.0)));
        assert_eq!(refused(&[0.0, 0.01, 2e9, 2e9 + 0.01, 2e9 + 0.02]), Some((2, 4000.0)));
        assert_eq!(refused(&[0.0, 0.01, 0.02, 0.03, 900.0]), None);
        assert_eq!(refused(&[0.0, 1e12]), Some((1, 1000.0)));
        // A thousand samples at 0.01 s: 0.01 s × (10⁶ + 10 × 1001).
        let mut times_s: Vec<f64> = (0..1000).map(|k| f64::from(k) * 0.01).collect();
        times_s.push(9.99 + 10_000.0);
        assert_eq!(refused(&times_s), None);
        times_s[1000] += 1000.0;
        assert_eq!(refused(&times_s), Some((1000, 10_100.0)));
        // Edges of a jump are no usual steps.
        assert_eq!(refused(&[0.0, 1e-9, 500.0, 500.0 + 1e-9]), None);
        let even = |dt_s| GroundMotion::evenly_spaced(dt_s, vec![0.0; 3], None);
        assert!(even(1000.0).is_ok());
        assert!(matches!(even(1e12), Err(MotionError::OutOfRange { quantity: "dt_s", .. })));
    }
}
