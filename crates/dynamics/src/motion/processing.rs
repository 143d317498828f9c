//! Processing of records: named steps, one after the other.
//!
//! A step says what it does in the words in which it is written, so that a list of steps is the
//! whole story of a processed record. Nothing is done that is not named: resampling does not
//! filter, filtering does not remove a baseline.

mod baseline;
mod butterworth;
mod names;
mod rates;
mod reshape;

pub use butterworth::Band;

use std::sync::Arc;

use super::GroundMotion;
use super::series::{Quantity, Series};
use crate::error::MotionError;

/// One step of processing.
///
/// ```
/// use slipstick_dynamics::motion::processing::Step;
/// use slipstick_dynamics::motion::{Quantity, Series};
/// let series = Series::evenly_spaced(0.5, vec![1.0, 2.0, 6.0], Quantity::Acceleration).unwrap();
/// let step = Step::parse("remove mean").unwrap();
/// assert_eq!(step.apply(&series).unwrap().values(), [-2.0, -1.0, 3.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Step {
    /// Subtracts the polynomial of this degree that fits the samples best (least squares): 0 for
    /// the mean, 1 for a straight line.
    RemovePolynomial {
        /// Degree, at most 10.
        degree: usize,
    },
    /// Butterworth filter run forwards and backwards: no phase shift, the gain squared.
    Filter {
        /// What passes.
        band: Band,
        /// Order of the filter that is run twice, from 1 to 10.
        order: usize,
    },
    /// Cosine taper: half a cosine from 0 to 1 over this part of the duration at the start, and
    /// back at the end.
    Taper {
        /// Part of the duration at each end, from above 0 to 0.5.
        fraction: f64,
    },
    /// Samples along the straight lines at a new step, the last one at or before the end. No
    /// filter is applied: what is above the new Nyquist frequency folds back.
    Resample {
        /// The new step in s.
        dt_s: f64,
    },
    /// The part between two times, whose end values lie on the straight lines; the clock starts
    /// anew.
    Trim {
        /// Start in s.
        from_s: f64,
        /// End in s.
        to_s: f64,
    },
    /// All values times a factor.
    Scale {
        /// The factor.
        factor: f64,
    },
    /// Integrates from rest or differentiates to another quantity.
    To {
        /// That quantity.
        quantity: Quantity,
    },
}

impl Step {
    /// What the step makes of a series.
    ///
    /// # Errors
    /// [`MotionError`] where the step has no answer for this series: [`MotionError::Uneven`] for a
    /// filter of uneven samples, [`MotionError::OutOfRange`] for a corner above the Nyquist
    /// frequency, a series too short, times outside it; values that are not finite.
    pub fn apply(&self, series: &Series) -> Result<Series, MotionError> {
        match *self {
            Self::RemovePolynomial { degree } => baseline::remove(series, degree),
            Self::Filter { band, order } => butterworth::filter(series, band, order),
            Self::Taper { fraction } => reshape::taper(series, fraction),
            Self::Resample { dt_s } => reshape::resample(series, dt_s),
            Self::Trim { from_s, to_s } => reshape::trim(series, from_s, to_s),
            Self::Scale { factor } => {
                series.with_values(series.values().iter().map(|v| factor * v).collect())
            }
            Self::To { quantity } => rates::to(series, quantity),
        }
    }
}

/// All steps in their order.
///
/// # Errors
/// The first step's error, with its index from 0.
pub fn process(series: &Series, steps: &[Step]) -> Result<Series, (usize, MotionError)> {
    let mut series = series.clone();
    for (index, step) in steps.iter().enumerate() {
        series = step.apply(&series).map_err(|error| (index, error))?;
    }
    Ok(series)
}

/// All steps in their order on every component of a motion; `None` where they end in another quantity.
///
/// # Errors
/// The first step's error, with its index from 0.
///
/// # Examples
/// ```
/// use slipstick_dynamics::motion::GroundMotion;
/// use slipstick_dynamics::motion::processing::{Step, process_motion};
/// let motion = GroundMotion::evenly_spaced(0.5, vec![1.0, 2.0, 6.0], Some(vec![0.0, 3.0, 0.0])).unwrap();
/// let steps = [Step::parse("remove mean").unwrap()];
/// let motion = process_motion(&motion, &steps).unwrap().unwrap();
/// assert_eq!(motion.horizontal_m_per_s2(), [-2.0, -1.0, 3.0]);
/// assert_eq!(motion.vertical_m_per_s2(), Some(&[-1.0, 2.0, -1.0][..]));
/// ```
pub fn process_motion(
    motion: &GroundMotion,
    steps: &[Step],
) -> Result<Option<GroundMotion>, (usize, MotionError)> {
    let processed = |values: &Arc<Vec<f64>>| {
        let series = Series { values: values.clone(), ..motion.series() };
        Ok::<_, (usize, MotionError)>(process(&series, steps)?.motion())
    };
    let Some(along_x) = processed(&motion.horizontal_m_per_s2)? else { return Ok(None) };
    let other = |values: &Option<Arc<Vec<f64>>>| {
        let processed = values.as_ref().map(processed).transpose()?.flatten();
        Ok::<_, (usize, MotionError)>(processed.map(|motion| motion.horizontal_m_per_s2))
    };
    Ok(Some(GroundMotion {
        horizontal_y_m_per_s2: other(&motion.horizontal_y_m_per_s2)?,
        vertical_m_per_s2: other(&motion.vertical_m_per_s2)?,
        ..along_x
    }))
}
