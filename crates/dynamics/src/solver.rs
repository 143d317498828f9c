//! Solves the equations of motion: exactly, or by the paper's stepwise program.

mod chords;
mod course;
mod dense;
mod direct;
mod ground;
mod modal;
mod outputs;
mod phase;
mod plane;
mod prepared;
mod recorder;
mod slider;
mod stepwise;
mod summary;
mod tables;
mod walk;
mod windows;

use crate::error::SolveError;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::progress::{Cancel, NEVER_CANCELLED};
use crate::response::{Method, Response};

pub use crate::linear::{FrameModes, shear_frame_modes};
pub use crate::numerics::InstructionSet;
pub use prepared::{Prepared, PreparedMotion, Workspace};
pub use walk::EVENTS_PER_INTERVAL_LIMIT;

/// Exact response with its history.
///
/// Between two events the motion is the Taylor series of a linear system, summed to rounding;
/// events are located to a few ulp of the time within their sample. See the book's chapter
/// "Theory" for the method and for the proof that no event is missed.
///
/// # Errors
/// [`SolveError`] with time and cause.
///
/// # Examples
/// ```
/// use slipstick_dynamics::{model::Model, motion::GroundMotion, solver};
///
/// // Newmark's block: 0.4 g for 0.5 s over friction of 0.2 stops after 1 s, 0.49 m behind.
/// let g = slipstick_dynamics::units::STANDARD_GRAVITY_M_PER_S2;
/// let model = Model::builder().block("124 kg").friction(0.2, 0.2).build()?;
/// let times_s = vec![0.0, 0.5, 0.5, 1.5];
/// let motion = GroundMotion::new(times_s, vec![0.4 * g, 0.4 * g, 0.0, 0.0], None)?;
/// let response = solver::exact(&model, &motion)?;
/// assert!((response.events[1].time_s - 1.0).abs() < 1e-12);
/// assert!((response.demands.residual_sliding_displacement_m + 0.05 * g).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn exact(model: &Model, motion: &GroundMotion) -> Result<Response, SolveError> {
    prepared::solve_once(model, motion, true, NEVER_CANCELLED)
}

/// Exact response without a history: peaks, counts and events only.
///
/// # Errors
/// [`SolveError`] with time and cause.
pub fn exact_demands(model: &Model, motion: &GroundMotion) -> Result<Response, SolveError> {
    prepared::solve_once(model, motion, false, NEVER_CANCELLED)
}

/// [`exact_demands`] as long as `go_on` says so, which is asked every few milliseconds.
///
/// # Errors
/// [`SolveError::Stopped`] where it says no, otherwise [`SolveError`] with time and cause.
pub fn exact_demands_while(
    model: &Model,
    motion: &GroundMotion,
    go_on: Cancel<'_>,
) -> Result<Response, SolveError> {
    prepared::solve_once(model, motion, false, go_on)
}

/// Response by the paper's own program (eqs 5, 6, 15–18), with history and iteration counts.
///
/// The trapezoidal rule for velocity and displacement, iterated from the last accelerations until
/// both change by less than 1e-5 m/s², 200 times at most; stick is tested when the sign of the
/// sliding velocity differs from the last step's. Events, peaks and counts are those at samples.
///
/// # Errors
/// [`SolveError::NoConvergence`] with the time where the iteration does not converge.
pub fn stepwise(model: &Model, motion: &GroundMotion) -> Result<Response, SolveError> {
    stepwise_within(model, motion, stepwise::TOLERANCE_M_PER_S2)
}

/// As [`stepwise`], with another `δ` of eqs (17), (18): the largest change of an acceleration in the
/// last iteration, in m/s², instead of the paper's 1e-5.
///
/// # Errors
/// [`SolveError::NoConvergence`] with the time where the iteration does not converge; where `δ` is
/// not positive it never does.
pub fn stepwise_within(
    model: &Model,
    motion: &GroundMotion,
    tolerance_m_per_s2: f64,
) -> Result<Response, SolveError> {
    stepwise::solve(model, motion, tolerance_m_per_s2, NEVER_CANCELLED)
}

/// Response by either method, with its history.
///
/// # Errors
/// [`SolveError`] with time and cause.
///
/// # Examples
/// ```
/// use slipstick_dynamics::response::{EventKind, Method};
/// use slipstick_dynamics::{model::Model, motion::GroundMotion, solver};
///
/// let model = Model::builder().block("325 kg").friction(0.02, 0.012).spring("143 kN/m").build()?;
/// let samples = (0..500).map(|k| 0.5 * (0.2 * f64::from(k)).sin()).collect();
/// let motion = GroundMotion::evenly_spaced(0.01, samples, None)?;
/// let exact = solver::solve(&model, &motion, Method::Exact)?;
/// assert_eq!(exact.events[0].kind, EventKind::Slip);
/// let stepwise = solver::solve(&model, &motion, Method::Stepwise)?;
/// assert!(stepwise.iterations.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(model: &Model, motion: &GroundMotion, method: Method) -> Result<Response, SolveError> {
    match method {
        Method::Exact => exact(model, motion),
        Method::Stepwise => stepwise(model, motion),
    }
}

/// [`solve`] as long as `go_on` says so, which is asked every few milliseconds.
///
/// # Errors
/// [`SolveError::Stopped`] where it says no, otherwise [`SolveError`] with time and cause.
///
/// # Examples
/// ```
/// use core::ops::ControlFlow;
/// use slipstick_dynamics::error::{SolveError, Stopped};
/// use slipstick_dynamics::response::Method;
/// use slipstick_dynamics::{model::Model, motion::GroundMotion, solver};
///
/// let model = Model::builder().block("124 kg").friction(0.2, 0.2).build()?;
/// let motion = GroundMotion::evenly_spaced(0.01, vec![0.0; 1_000_000], None)?;
/// let stopped = solver::solve_while(&model, &motion, Method::Exact, &|| ControlFlow::Break(()));
/// assert_eq!(stopped.err(), Some(SolveError::Stopped(Stopped)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve_while(
    model: &Model,
    motion: &GroundMotion,
    method: Method,
    go_on: Cancel<'_>,
) -> Result<Response, SolveError> {
    match method {
        Method::Exact => prepared::solve_once(model, motion, true, go_on),
        Method::Stepwise => stepwise::solve(model, motion, stepwise::TOLERANCE_M_PER_S2, go_on),
    }
}
