//! One step of a judge: energies, and the friction law between knots.

use super::collocation::{NODES, POINTS, Path, Rule};
use super::ground::Load;
use super::judge::{Judge, STILL, between};
use super::structure::{excess, larger};
use crate::friction::Direction;
use crate::response::Mode;

impl Judge<'_> {
    /// One collocation step: advances the state, its energies, and judges friction on the way.
    pub(super) fn step(&mut self, mode: Mode, from_s: f64, step_s: f64, loads: [Load; 2]) {
        let d = self.structure.degrees();
        let forces = match mode {
            Mode::Stick => [0.0; 2],
            Mode::Slip(direction) => {
                loads.map(|load| self.law.sliding_force(direction, load.normal))
            }
        };
        let demand = |state: &[f64], a: f64| self.structure.demand(&state[..d], &state[d..], a);
        let first = if mode == Mode::Stick { demand(&self.state, loads[0].a) } else { 0.0 };
        let path = self.scheme.step(&self.state, [loads.map(|load| load.a), forces]);
        let mut values = [0.0; POINTS];
        match mode {
            Mode::Stick => {
                values[0] = first;
                values[1..=NODES].copy_from_slice(path.demands());
                values[NODES + 1] = demand(path.end(), loads[1].a);
            }
            Mode::Slip(direction) => {
                let sign = direction.sign();
                values[0] = sign * self.state[d];
                for (value, node) in values[1..].iter_mut().zip(0..NODES) {
                    *value = sign * path.velocity(node)[0];
                }
                values[NODES + 1] = sign * path.end()[d];
            }
        }
        self.state.copy_from_slice(path.end());
        self.spend(step_s, loads, forces);
        match mode {
            Mode::Stick => self.held(from_s, step_s, loads, &values),
            Mode::Slip(direction) => self.sliding(direction, from_s, step_s, loads, &values),
        }
    }

    /// Adds up work and losses of the step just made.
    fn spend(&mut self, step_s: f64, loads: [Load; 2], forces: [f64; 2]) {
        let path: &Path = self.scheme.path();
        let rule: &Rule = &self.scheme.rule;
        let (mut work, mut size, mut damping, mut friction) = (0.0, 0.0, 0.0, 0.0);
        for node in 0..NODES {
            let (v, c) = (path.velocity(node), rule.points[node + 1]);
            for (fastest, v) in self.fastest.iter_mut().zip(v) {
                *fastest = v.abs().max(*fastest);
            }
            let weight = step_s * rule.weights[node];
            let a = loads[0].a + (loads[1].a - loads[0].a) * c;
            let force = forces[0] + (forces[1] - forces[0]) * c;
            let power = -self.structure.momentum(v) * a;
            work += weight * power;
            size += weight * power.abs();
            damping += weight * self.structure.dissipation(v);
            friction -= weight * force * v[0];
        }
        self.energy.spend(work, size, damping, friction);
        // Between two knots the motion may be faster and go farther than at any.
        let speed = self.fastest.iter().fold(self.figures.velocity[1], |p, v| v.max(p));
        self.figures.velocity[1] = speed;
        self.still = (STILL * self.fastest[0]).max(self.still);
        let x = path.end()[..self.structure.degrees()].iter();
        self.figures.displacement[1] = x.fold(self.figures.displacement[1], |p, x| x.abs().max(p));
    }

    /// Judges a step of a stick from the demand at its points.
    fn held(&mut self, from_s: f64, step_s: f64, loads: [Load; 2], demands: &[f64; POINTS]) {
        let rule = &self.scheme.rule;
        let normal = |t: f64| between(loads, t).normal;
        let mut margins = [f64::NAN; POINTS];
        for i in 0..POINTS {
            let n = normal(rule.points[i]);
            let beyond = self.law.beyond(demands[i], n);
            self.figures.excess = larger(self.figures.excess, excess(beyond));
            margins[i] = self.law.margin(demands[i], n).unwrap_or(f64::NAN);
        }
        if margins.iter().any(|m| m.is_nan()) {
            self.dips.interrupt();
            return;
        }
        let inner = dip(&margins);
        let flat = margins.iter().all(|m| (m - margins[0]).abs() <= 1e-12);
        for i in 0..POINTS {
            let (mut t, mut margin) = (rule.points[i], margins[i]);
            if inner == Some(i) {
                let law = &self.law;
                let cost =
                    |t: f64, demand: f64| law.margin(demand, normal(t)).unwrap_or(f64::INFINITY);
                (t, margin) = rule.least(demands, i, cost);
                let beyond = -margin * self.law.bound(demands[i], normal(t));
                self.figures.excess = larger(self.figures.excess, excess(beyond));
            }
            self.dips.feed(from_s + t * step_s, margin);
        }
        // A plateau near the bound is as close a call as a maximum, if it is no sliver of one.
        let long = step_s > 1e6 * self.instant_s;
        if flat && long && margins[0] < 1.0 {
            self.dips.take(from_s, margins[0]);
        }
    }

    /// Judges a step of a slip from the velocity, in the direction claimed, at its points.
    fn sliding(
        &mut self,
        direction: Direction,
        from_s: f64,
        step_s: f64,
        loads: [Load; 2],
        speeds: &[f64; POINTS],
    ) {
        let rule = &self.scheme.rule;
        let inner = dip(speeds);
        for i in 0..POINTS {
            let (mut t, mut speed) = (rule.points[i], speeds[i]);
            if inner == Some(i) {
                (t, speed) = rule.least(speeds, i, |_, speed| speed);
            }
            if speed < -self.still || speed.is_nan() {
                let excess = self.law.wrong_way(direction, between(loads, t).normal);
                self.astray = [larger(self.astray[0], speed), larger(self.astray[1], excess)];
            }
            self.dips.feed(from_s + t * step_s, speed);
        }
    }
}

/// The least of the inner values, if it is below both ends.
fn dip(values: &[f64; POINTS]) -> Option<usize> {
    let least = (0..POINTS).fold(0, |best, i| if values[i] < values[best] { i } else { best });
    (least > 0 && least + 1 < POINTS).then_some(least)
}
