//! What is noticed of a model and the motion under it, before anything is run.

use crate::linear::shear_frame_frequencies;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::response::Warning;

/// Frequency of the highest mode, or of the block on its spring, in Hz.
pub(crate) fn highest_hz(model: &Model) -> f64 {
    let frame = model.frame();
    let of_frame = shear_frame_frequencies(&frame.masses_kg, &frame.stiffnesses_n_per_m);
    let of_slider = (model.slider().stiffness_n_per_m / model.total_mass_kg()).sqrt();
    of_frame.into_iter().fold(of_slider, f64::max) / (2.0 * core::f64::consts::PI)
}

/// Longest step of a motion, in s.
pub(crate) fn longest_step_s(motion: &GroundMotion) -> f64 {
    motion.times_s().windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max)
}

/// Samples further apart than a tenth of the shortest period say little of the highest mode.
pub(crate) fn coarse_sampling(highest_hz: f64, longest_step_s: f64) -> Option<Warning> {
    let nyquist_hz = 0.5 / longest_step_s;
    (nyquist_hz < 5.0 * highest_hz).then(|| Warning {
        kind: "coarse_sampling",
        time_s: None,
        message: format!(
            "the Nyquist frequency of the motion, {nyquist_hz:.4} Hz, is below 5 times the highest \
             mode, {highest_hz:.4} Hz: the motion may lack what excites that mode"
        ),
    })
}

/// The spring of a pendulum slider does not follow the normal force.
pub(crate) fn pendulum_under_vertical_motion(
    has_radius: bool,
    motion: &GroundMotion,
) -> Option<Warning> {
    (has_radius && motion.vertical_m_per_s2().is_some()).then(|| Warning {
        kind: "pendulum_under_vertical_motion",
        time_s: None,
        message: "the pendulum slider is a spring M_tot g / R; its true force would follow the \
                  normal force N(t)"
            .to_owned(),
    })
}
