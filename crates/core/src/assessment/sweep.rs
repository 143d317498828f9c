//! One motion, one model after the other: how demands follow a parameter.

use core::ops::Range;

use super::models::Models;
use crate::error::RunError;
use crate::motion::GroundMotion;
use crate::response::Demands;
use crate::solver::{PreparedMotion, Workspace};
use crate::study::engine::{Engine, Running};

/// The models of a grid under one motion, a part of them at a time.
#[derive(Debug)]
pub struct Sweep {
    models: Models,
    motion: PreparedMotion,
    workspace: Workspace,
}

impl Sweep {
    /// A sweep over the models' grid; the motion has its tail.
    #[must_use]
    pub fn new(models: Models, motion: GroundMotion) -> Self {
        let motion = PreparedMotion::new(motion);
        Self { models, motion, workspace: Workspace::default() }
    }

    /// The models and their grid.
    #[must_use]
    pub fn models(&self) -> &Models {
        &self.models
    }

    /// The demands of some models, by their numbers in the grid, in order; those that the solver gives
    /// for each of them alone, bit for bit.
    pub fn demands(&mut self, models: Range<usize>) -> Vec<Result<Demands, RunError>> {
        let end = models.end.min(self.models.grid().len());
        (models.start..end).map(|number| self.one(number)).collect()
    }

    fn one(&mut self, number: usize) -> Result<Demands, RunError> {
        let model = self.models.parts(&self.models.grid().values(number))?.model;
        let engine = Engine::unwatched();
        Ok(Running::new(&model, &engine).on(&self.motion, &mut self.workspace)?.demands)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{input, solver};

    #[test]
    fn a_part_of_a_sweep_is_its_runs() {
        let text = "[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0.02\nkinetic_friction = \
                    0.01\n[[storey]]\nmass = \"1 kg\"\nfrequency = \"2 Hz\"\ndamping_ratio = 0.02\n";
        let over = [("over", "slider.kinetic_friction=0.01..0.04:4".to_owned())];
        let models = Models::new("model", text, &[], &over, true).unwrap();
        let values = (0..400).map(|i| 3.0 * libm::sin(0.1 * f64::from(i))).collect();
        let motion = GroundMotion::evenly_spaced(0.01, values, None).unwrap();
        let mut sweep = Sweep::new(models, motion.clone());
        let part = sweep.demands(1..9);
        assert_eq!(part.len(), 3);
        for (i, demands) in part.iter().enumerate() {
            let friction = sweep.models().grid().values(i + 1)[0];
            let set = [
                input::Override::number("slider.kinetic_friction", friction).unwrap(),
                input::Override::number("slider.static_friction", friction * 2.0).unwrap(),
            ];
            let model = input::parse("model", text, &set).unwrap().model;
            let alone = solver::exact_demands(&model, &motion).unwrap().demands;
            assert_eq!(demands.as_ref().unwrap(), &alone);
        }
    }
}
