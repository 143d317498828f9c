//! What serves many analyses at once: a motion prepared for all models, a model for all motions.

use std::sync::Arc;

use fearless_simd::Level;

use super::blocks::{Tables, Windows};
use super::exact::{self, Way};
use crate::error::SolveError;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::response::Response;

/// A ground motion with what the solver needs to know of it, for any number of models.
#[derive(Debug)]
pub struct PreparedMotion<'a> {
    motion: &'a GroundMotion,
    windows: Windows,
}

impl<'a> PreparedMotion<'a> {
    /// Looks through the motion once.
    #[must_use]
    pub fn new(motion: &'a GroundMotion) -> Self {
        Self { motion, windows: Windows::new(motion) }
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
    dt_s: Option<f64>,
    /// None where the model goes the plain way.
    tables: Option<Arc<Tables>>,
}

impl<'a> PreparedModel<'a> {
    /// Prepares a model for motions with the sampling of this one.
    #[must_use]
    pub fn new(model: &'a Model, motion: &PreparedMotion<'_>) -> Self {
        let dt_s = motion.windows.dt_s;
        let tables = dt_s.and_then(|dt_s| exact::tables(model, dt_s));
        Self { model, dt_s, tables }
    }

    /// Another model, with the propagators of this one where the two differ in friction alone.
    #[must_use]
    pub fn sharing<'b>(&self, model: &'b Model) -> PreparedModel<'b> {
        let same = self.model.with_friction(model.slider().friction) == *model;
        let tables = if same {
            self.tables.clone()
        } else {
            self.dt_s.and_then(|dt_s| exact::tables(model, dt_s))
        };
        PreparedModel { model, dt_s: self.dt_s, tables }
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
    demands_by(InstructionSet::best(), model, motion)
}

/// [`demands`] by a given instruction set: the bits are the same by all.
///
/// # Errors
/// [`SolveError`] with time and cause.
pub fn demands_by(
    instructions: InstructionSet,
    model: &PreparedModel<'_>,
    motion: &PreparedMotion<'_>,
) -> Result<Response, SolveError> {
    solve(instructions, model, motion, false)
}

pub(super) fn solve(
    instructions: InstructionSet,
    model: &PreparedModel<'_>,
    motion: &PreparedMotion<'_>,
    with_history: bool,
) -> Result<Response, SolveError> {
    let tables = model.tables.as_deref().filter(|_| model.dt_s == motion.windows.dt_s);
    let way = Way::Blocks { windows: &motion.windows, tables, level: instructions.0 };
    exact::solve(model.model, motion.motion, with_history, way)
}

/// Vector instructions of the processor, as found when the program runs.
#[derive(Clone, Copy, Debug)]
pub struct InstructionSet(Level);

impl InstructionSet {
    /// The best of this machine.
    #[must_use]
    pub fn best() -> Self {
        Self(Level::new())
    }

    /// All of this machine that a response can be computed by; with the feature `scalar` also no
    /// vector instructions at all.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let best = Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let found = [
            best.as_avx512().map(Level::Avx512),
            best.as_avx2().map(Level::Avx2),
            best.as_sse4_2().map(Level::Sse4_2),
            best.as_sse2().map(Level::Sse2),
        ];
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let found = [Some(best)];
        let all = found.into_iter().flatten();
        #[cfg(feature = "scalar")]
        let all = all.chain([Level::fallback()]);
        all.map(Self).collect()
    }
}
