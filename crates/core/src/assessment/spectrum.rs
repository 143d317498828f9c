//! Sliding spectra and frequency response: the fixed-base model beside the sliding one, and the window
//! of frequencies in which a structure amplifies.

use crate::error::{ModelError, MotionError};
use crate::friction::{Coulomb, Friction};
use crate::model::{InitialState, Model};
use crate::motion::GroundMotion;

/// A friction that nothing overcomes: a million times what any motion on Earth asks.
const HELD: f64 = 1e9;

/// The same structure with its block held to the table: what it would feel without sliders.
///
/// It is to be run on [`without_vertical`] motion, so that contact is never lost; sliding velocity and
/// displacement at the start are 0.
///
/// # Errors
/// [`ModelError`] never, of a model that was checked.
pub fn fixed_base(model: &Model) -> Result<Model, ModelError> {
    let friction = Friction::Coulomb(Coulomb::new([HELD; 2], [HELD; 2])?);
    let initial = InitialState {
        sliding_displacement_m: 0.0,
        sliding_velocity_m_per_s: 0.0,
        ..model.initial().clone()
    };
    let slider = crate::model::Slider { friction, gap_m: None, ..*model.slider() };
    Model::new(*model.block(), slider, model.frame().clone(), model.gravity_m_per_s2(), initial)
}

/// The motion along the sliding surface alone.
///
/// # Errors
/// [`MotionError`] never, of a motion that was checked.
pub fn without_vertical(motion: &GroundMotion) -> Result<GroundMotion, MotionError> {
    let along = motion.horizontal_m_per_s2().to_vec();
    GroundMotion::new(motion.times_s().to_vec(), along, None)
}

/// Intervals of `x` (rising) in which `y`, linear between its points, is above a threshold; values
/// that are not finite end an interval.
#[must_use]
pub fn intervals_above(x: &[f64], y: &[f64], threshold: f64) -> Vec<[f64; 2]> {
    let mut intervals: Vec<[f64; 2]> = Vec::new();
    let mut open: Option<f64> = None;
    let n = x.len().min(y.len());
    for i in 0..n {
        let above = y[i] > threshold;
        let crossing = |i: usize| {
            let part = (threshold - y[i - 1]) / (y[i] - y[i - 1]);
            if part.is_finite() { x[i - 1] + part * (x[i] - x[i - 1]) } else { x[i] }
        };
        match (open, above) {
            (None, true) => {
                let known = i > 0 && y[i - 1].is_finite();
                open = Some(if known { crossing(i) } else { x[i] });
            }
            (Some(from), false) => {
                let to = if y[i].is_finite() { crossing(i) } else { x[i - 1] };
                intervals.push([from, to]);
                open = None;
            }
            _ => {}
        }
    }
    if let Some(from) = open {
        intervals.push([from, x[n - 1]]);
    }
    intervals
}
