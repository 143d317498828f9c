//! The paper's stepwise program.

use crate::error::SolveError;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::response::Response;

pub(super) fn solve(model: &Model, motion: &GroundMotion) -> Result<Response, SolveError> {
    super::exact::solve(model, motion, true)
}
