//! What serves many analyses at once: a motion prepared for all models, a model for all motions.

use super::exact;
use crate::error::SolveError;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::response::Response;

/// A ground motion with what the solver needs to know of it, for any number of models.
#[derive(Debug)]
pub struct PreparedMotion<'a> {
    motion: &'a GroundMotion,
}

impl<'a> PreparedMotion<'a> {
    /// Looks through the motion once.
    #[must_use]
    pub fn new(motion: &'a GroundMotion) -> Self {
        Self { motion }
    }

    /// The motion itself.
    #[must_use]
    pub fn motion(&self) -> &'a GroundMotion {
        self.motion
    }
}

/// A model with its propagators for one time step.
///
/// They depend neither on friction nor on the motion's values: one prepared model serves all
/// levels of a record, and [`PreparedModel::sharing`] all coefficients of friction.
#[derive(Debug)]
pub struct PreparedModel<'a> {
    model: &'a Model,
}

impl<'a> PreparedModel<'a> {
    /// Prepares a model for motions with the sampling of this one.
    #[must_use]
    pub fn new(model: &'a Model, _motion: &PreparedMotion<'_>) -> Self {
        Self { model }
    }

    /// Another model, with the propagators of this one where the two differ in friction alone.
    #[must_use]
    pub fn sharing<'b>(&self, model: &'b Model) -> PreparedModel<'b> {
        PreparedModel { model }
    }

    /// The model itself.
    #[must_use]
    pub fn model(&self) -> &'a Model {
        self.model
    }
}

/// Exact response without a history: peaks, counts and events, bit for bit those of
/// [`exact`](super::exact) and of [`exact_demands`](super::exact_demands).
///
/// A motion whose sampling is not the one the model was prepared for costs a new preparation.
///
/// # Errors
/// [`SolveError`] with time and cause.
pub fn demands(
    model: &PreparedModel<'_>,
    motion: &PreparedMotion<'_>,
) -> Result<Response, SolveError> {
    exact::solve(model.model, motion.motion, false)
}
