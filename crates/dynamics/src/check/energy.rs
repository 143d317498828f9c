//! The balance of energy in the frame of the table.

use super::EnergyHistory;

/// Energies at knots, and what the intervals that begin there spend, in J.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct EnergyBalance {
    /// Initial energy `E₀`, of which a stop has taken a part.
    pub(super) initial: [f64; 2],
    pub(super) kinetic: Vec<f64>,
    pub(super) strain: Vec<f64>,
    pub(super) work: Vec<f64>,
    /// Size of the work and of what springs give back that follow `N`; empty without such.
    pub(super) size: Vec<f64>,
    pub(super) damping: Vec<f64>,
    pub(super) friction: Vec<f64>,
    /// What the rounding of the loads makes of them; empty where `N` is constant.
    pub(super) load_rounding: Vec<f64>,
}

impl EnergyBalance {
    /// None spent yet, from these energies at knots on, with what a stop has taken.
    pub(super) fn new(
        [kinetic, strain]: [Vec<f64>; 2],
        stop_j: f64,
        [varies, follows]: [bool; 2],
    ) -> Self {
        let zeros = || vec![0.0; kinetic.len()];
        Self {
            initial: [kinetic[0] + strain[0] + stop_j, stop_j],
            work: zeros(),
            size: if follows { zeros() } else { Vec::new() },
            damping: zeros(),
            friction: zeros(),
            load_rounding: if varies { zeros() } else { Vec::new() },
            kinetic,
            strain,
        }
    }

    /// The largest imbalance at a knot over the largest sum of all energies; `rounding` is what the rounding
    /// of times makes of a system at rest, and `unsure` the part of an interval that it may be.
    ///
    /// The imbalances of intervals are added up, in which the energies have gone already: rounding grows with
    /// what is exchanged, not with its sums.
    pub(super) fn error(&self, rounding: f64, unsure: impl Fn(usize) -> f64) -> f64 {
        let [initial, stop] = self.initial;
        let (mut imbalance, mut load_rounding, mut worst) = (0.0_f64, 0.0, 0.0_f64);
        let (mut size, mut damping, mut friction) = (initial, stop, 0.0);
        let mut scale = rounding;
        for k in 0..self.kinetic.len() {
            if let Some(last) = k.checked_sub(1) {
                let stored =
                    (self.kinetic[k] - self.kinetic[last]) + (self.strain[k] - self.strain[last]);
                imbalance += (self.work[last] - self.damping[last] - self.friction[last]) - stored;
                let worked = self.size.get(last).copied().unwrap_or(self.work[last].abs());
                size += worked;
                damping += self.damping[last];
                friction += self.friction[last];
                let spent = worked + self.friction[last].abs() + self.damping[last].abs();
                load_rounding +=
                    self.load_rounding.get(last).unwrap_or(&0.0) + unsure(last) * spent;
            }
            worst = worst.max(imbalance.abs() - load_rounding);
            let held = self.kinetic[k] + self.strain[k];
            scale = scale.max(size + held + damping.abs() + f64::abs(friction));
        }
        // What is not a number stays in the sum.
        match (worst == 0.0, imbalance.is_nan() || scale.is_nan()) {
            (_, true) => f64::INFINITY,
            (true, _) => 0.0,
            _ => worst / scale,
        }
    }

    /// Energy by kind at every knot.
    pub(super) fn history(&self) -> EnergyHistory {
        let sums = |from: f64, list: &[f64]| {
            let mut sum = from;
            let spent = list.iter().take(list.len().saturating_sub(1));
            let sums = spent.map(|spent| {
                sum += spent;
                sum
            });
            core::iter::once(from).chain(sums).take(list.len()).collect()
        };
        EnergyHistory {
            input_j: sums(self.initial[0], &self.work),
            kinetic_j: self.kinetic.clone(),
            strain_j: self.strain.clone(),
            damping_j: sums(self.initial[1], &self.damping),
            friction_j: sums(0.0, &self.friction),
        }
    }
}
