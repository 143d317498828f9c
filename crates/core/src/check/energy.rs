//! The balance of energy in the frame of the table.

use super::EnergyHistory;
use super::group::Spent;
use super::structure::{excess, larger};

/// A sum that keeps what rounding drops, so that a long record costs no digits.
#[derive(Clone, Copy, Default)]
struct Sum {
    total: f64,
    dropped: f64,
}

impl Sum {
    fn add(&mut self, value: f64) {
        // Knuth's sum of two: what `total` lacks, exactly.
        let total = self.total + value;
        let taken = total - self.total;
        self.dropped += (self.total - (total - taken)) + (value - taken);
        self.total = total;
    }

    fn value(self) -> f64 {
        self.total + self.dropped
    }
}

/// Work and losses up to now, and the balance at every knot.
#[derive(Default)]
pub(super) struct Energy {
    input: Sum,
    size: Sum,
    damping: Sum,
    friction: Sum,
    /// What rounding of the loads makes of them so far.
    blur: f64,
    difference: f64,
    scale: f64,
    pub(super) history: EnergyHistory,
}

impl Energy {
    /// Begins with the initial energy `E₀`, of which a stop has taken `stop_j`; `rounding_j` is what the
    /// rounding of times makes of a system at rest. All in J.
    pub(super) fn start(&mut self, initial_j: f64, stop_j: f64, rounding_j: f64, knots: usize) {
        let history = &mut self.history;
        for list in [&mut history.input_j, &mut history.damping_j, &mut history.friction_j] {
            list.reserve(knots);
        }
        self.input.add(initial_j);
        self.size.add(initial_j);
        self.damping.add(stop_j);
        self.scale = rounding_j;
    }

    /// Adds what an interval has spent.
    pub(super) fn spend(&mut self, spent: &Spent<f64>) {
        self.input.add(spent.work);
        self.size.add(spent.size);
        self.damping.add(spent.damping);
        self.friction.add(spent.friction);
        self.blur += spent.blur;
    }

    /// Balances the books at a knot with this kinetic and strain energy in J.
    pub(super) fn knot(&mut self, kinetic: f64, strain: f64) {
        let [input, damping, friction] = [self.input, self.damping, self.friction].map(Sum::value);
        let difference = input - kinetic - strain - damping - friction;
        self.difference = larger(self.difference, excess(difference.abs() - self.blur));
        self.scale = larger(
            self.scale,
            self.size.value() + kinetic + strain + damping.abs() + friction.abs(),
        );
        self.history.input_j.push(input);
        self.history.damping_j.push(damping);
        self.history.friction_j.push(friction);
    }

    /// The largest difference over the largest sum of everything.
    pub(super) fn error(&self) -> f64 {
        if self.difference == 0.0 { 0.0 } else { self.difference / self.scale }
    }
}
