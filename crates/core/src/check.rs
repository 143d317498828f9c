//! Judges a response without the solver.

use crate::model::Model;
use crate::motion::GroundMotion;
use crate::response::History;

/// The decision that came closest to going the other way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestCall {
    /// Distance from the other decision, relative to the bound or peak.
    pub margin: f64,
    /// When, in s.
    pub time_s: f64,
    /// `stop`, `stick` or `slip`.
    pub kind: &'static str,
}

/// Figures that certify a response.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// Largest defect of the equations of motion.
    pub equilibrium_residual: f64,
    /// Largest excess over the friction law.
    pub friction_excess: f64,
    /// Largest imbalance of energy.
    pub energy_balance_error: f64,
    /// The nearest decision; `None` where nothing was decided.
    pub closest_call: Option<ClosestCall>,
    /// What the first three must stay below: max(1e-10, 100 ε ω_max t_end).
    pub bound: f64,
    /// Energy by kind at every knot.
    pub energy: EnergyHistory,
}

impl Certificate {
    /// Whether the first three figures stay within the bound.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.equilibrium_residual <= self.bound
            && self.friction_excess <= self.bound
            && self.energy_balance_error <= self.bound
    }
}

/// Energy in the frame of the table at every knot, in J.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergyHistory {
    /// Initial energy plus the work of the table, `E₀ + W`.
    pub input_j: Vec<f64>,
    /// Kinetic.
    pub kinetic_j: Vec<f64>,
    /// Strain of spring and storeys.
    pub strain_j: Vec<f64>,
    /// Spent in dampers so far.
    pub damping_j: Vec<f64>,
    /// Spent in friction so far.
    pub friction_j: Vec<f64>,
}

/// Judges the states at knots of a response to a motion.
#[must_use]
pub fn check(model: &Model, motion: &GroundMotion, history: &History) -> Certificate {
    let _ = (model, motion, history);
    unreachable!("written next")
}
