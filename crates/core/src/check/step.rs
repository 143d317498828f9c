//! One step of a judge: energies, peaks, and the laws of friction and stop between knots.

use super::collocation::{NODES, POINTS, Path, Rule};
use super::demands::Instant;
use super::ground::Load;
use super::judge::{Judge, STILL, between};
use super::lanes::{LANES, Work};
use super::law::{Push, dip};
use super::structure::{Phase, excess, larger};
use crate::response::{Contact, Mode};
use crate::slider::Direction;

/// What a step is looked at for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// Everything.
    All,
    /// The law of friction only.
    Law,
}

/// How far outputs may leave the chord of a step: at most in proportion to its length.
pub(super) struct Spread {
    /// Of which step these are the bounds.
    pub(super) longest_s: f64,
    /// Output by output, one bound for each input of size 1.
    pub(super) bounds: Vec<f64>,
    /// The same without zeros: outputs that leave the chord, with the inputs that make them.
    pub(super) leaving: Vec<(usize, Vec<(usize, f64)>)>,
}

impl Spread {
    /// Of steps whose law is not linear: nothing is known of the outputs in between.
    pub(super) fn unknown(longest_s: f64) -> Self {
        Self { longest_s, bounds: Vec::new(), leaving: Vec::new() }
    }
}

/// The path of a unit input, and `x` and `ẍ` at its nodes.
pub(super) struct Unit {
    path: Vec<f64>,
    trace: Vec<f64>,
}

impl Unit {
    /// The paths of all, one after another.
    pub(super) fn paths(all: &[Self]) -> Vec<f64> {
        all.iter().flat_map(|unit| &unit.path).copied().collect()
    }

    /// `x` at the nodes of all, one after another.
    pub(super) fn places(all: &[Self]) -> Vec<f64> {
        all.iter().flat_map(|unit| &unit.trace[..unit.trace.len() / 2]).copied().collect()
    }
}

impl Judge<'_> {
    /// One collocation step: advances the state, its energies, and judges the laws on the way.
    pub(super) fn step(
        &mut self,
        (mode, contact): (Mode, Contact),
        from_s: f64,
        step_s: f64,
        loads: [Load; 2],
        look: Look,
    ) {
        let d = self.structure.degrees();
        let push = self.law.push(contact);
        self.before.copy_from_slice(&self.state);
        let forces = match mode {
            Mode::Stick => [0.0; 2],
            Mode::Slip(direction) => {
                loads.map(|load| self.law.sliding_load(direction, load.normal))
            }
        };
        let held = push.force(self.state[0], 0.0);
        let demand =
            |state: &[f64], a: f64| self.structure.demand(&state[..d], &state[d..], a) + held;
        let first = if mode == Mode::Stick { demand(&self.state, loads[0].a) } else { 0.0 };
        let shifted = forces.map(|force| force + push.shift);
        let path = self.scheme.step(&self.state, [loads.map(|load| load.a), shifted]);
        let mut values = [0.0; POINTS];
        match mode {
            Mode::Stick => {
                values[0] = first;
                for (value, demand) in values[1..].iter_mut().zip(path.demands()) {
                    *value = demand + held;
                }
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
        if look == Look::All {
            self.spend(step_s, loads, forces);
            if contact != Contact::Free && mode != Mode::Stick {
                self.against_stop((contact, push), step_s);
            }
            if mode != Mode::Stick {
                self.totals.path_m += (self.state[0] - self.before[0]).abs();
            }
            self.track((mode, push), step_s, loads, forces);
        }
        match mode {
            Mode::Stick => self.held(from_s, step_s, loads, &values),
            Mode::Slip(direction) => self.sliding(direction, from_s, step_s, loads, &values),
        }
    }

    /// Adds up work and losses of the step just made.
    fn spend(&mut self, step_s: f64, loads: [Load; 2], forces: [f64; 2]) {
        let path: &Path = self.scheme.path();
        let rule: &Rule = self.scheme.rule;
        let (mut work, mut size, mut damping, mut friction) = (0.0, 0.0, 0.0, 0.0);
        for node in 0..NODES {
            let (v, c) = (path.velocity(node), rule.points[node + 1]);
            for (fastest, v) in self.fastest.iter_mut().zip(v) {
                *fastest = v.abs().max(*fastest);
            }
            let weight = step_s * rule.weights[node];
            let a = loads[0].a + (loads[1].a - loads[0].a) * c;
            let force = (forces[0] + (forces[1] - forces[0]) * c) * self.law.speed_factor(v[0]);
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

    /// Judges the stop in a step of a slip, and adds the work that it takes.
    fn against_stop(&mut self, (contact, push): (Contact, Push), step_s: f64) {
        let d = self.structure.degrees();
        let slack = self.contact_slack(self.fastest[0]);
        let [x, v, _] = self.scheme.trace();
        let at: [(f64, f64); NODES] = core::array::from_fn(|i| (x[i * d], v[i * d]));
        let mut taken = 0.0;
        for (i, (s, w)) in at.into_iter().enumerate() {
            taken += step_s * self.scheme.rule.weights[i] * push.force(s, w) * w;
            let broken = self.law.contact_excess(contact, (s, w), slack);
            self.figures.excess = larger(self.figures.excess, broken);
        }
        self.energy.spend(0.0, 0.0, taken, 0.0);
    }

    /// Bounds the outputs between the ends of a step of a phase, for steps up to `longest_s`, from the
    /// unit inputs over that step.
    pub(super) fn spread(&mut self, phase: Phase, longest_s: f64, units: &[Unit]) {
        let d = self.structure.degrees();
        let (inputs, outputs) = (2 * d + 4, self.peaks.outputs.len());
        let mut bounds = vec![0.0; outputs * inputs];
        let mut values = vec![[0.0; POINTS]; outputs];
        let mut rate = vec![0.0; d];
        for (j, Unit { path, trace }) in units.iter().enumerate() {
            let (places, rates) = trace.split_at(NODES * d);
            let unit = |k: usize| if k == j { 1.0 } else { 0.0 };
            let linear = |k: usize, t: f64| unit(k) + (unit(k + 1) - unit(k)) * t;
            let start: Vec<f64> = (0..2 * d).map(unit).collect();
            for (i, &t) in self.scheme.rule.points.iter().enumerate() {
                let loads = (linear(2 * d, t), linear(2 * d + 2, t));
                let (x, v) = match i {
                    0 => start.split_at(d),
                    i if i <= NODES => (&places[(i - 1) * d..i * d], &path[(i - 1) * d..i * d]),
                    _ => path[NODES * d..(NODES + 2) * d].split_at(d),
                };
                if (1..=NODES).contains(&i) {
                    rate.copy_from_slice(&rates[(i - 1) * d..i * d]);
                } else {
                    self.structure.accelerate(phase, (x, v), loads, &mut rate);
                }
                let force = match phase {
                    Phase::Stick => self.structure.demand(x, v, loads.0),
                    _ => loads.1,
                };
                let now = Instant { x, v, rate: &rate, a: loads.0, force, stop: 0.0 };
                self.peaks.outputs_at(&now, &mut values, i);
            }
            for (output, values) in values.iter().enumerate() {
                let chord = |t: f64| values[0] + (values[POINTS - 1] - values[0]) * t;
                let off = |i: usize| (values[i] - chord(self.scheme.rule.points[i])).abs();
                let most = (1..=NODES).map(off).fold(0.0, f64::max);
                // What is linear leaves it by rounding only.
                let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
                // Between two points it may leave the chord a little further than at any.
                bounds[output * inputs + j] = if most > 1e-14 * size { 1.25 * most } else { 0.0 };
            }
        }
        let rows = bounds.chunks_exact(inputs).enumerate();
        let of_row = |(output, row): (usize, &[f64])| {
            let terms = row.iter().copied().enumerate().filter(|(_, bound)| *bound > 0.0);
            (output, terms.collect::<Vec<_>>())
        };
        let leaving = rows.map(of_row).filter(|(_, terms)| !terms.is_empty()).collect();
        self.spreads[phase as usize] = Some(Spread { longest_s, bounds, leaving });
    }

    /// The steps of every unit input.
    pub(super) fn units(&self, phase: Phase, step_s: f64) -> Vec<Unit> {
        let d = self.structure.degrees();
        let mut work = Work::new(d);
        let mut units = Vec::with_capacity(2 * d + 4);
        for from in (0..2 * d + 4).step_by(LANES) {
            let count = LANES.min(2 * d + 4 - from);
            work.solve_units(&self.bench(&[]), phase, step_s, from);
            let unit = |lane: usize| Unit { path: work.path(lane), trace: work.trace(lane) };
            units.extend((0..count).map(unit));
        }
        units
    }

    /// Looks for peaks in the step just made; `forces` are the loads of sliding at its ends.
    fn track(
        &mut self,
        (mode, push): (Mode, Push),
        step_s: f64,
        loads: [Load; 2],
        forces: [f64; 2],
    ) {
        let d = self.structure.degrees();
        let phase = self.scheme.phase();
        let length = self.peaks.outputs.len();
        let mut values = vec![[0.0; POINTS]; length];
        let held = push.force(self.before[0], 0.0);
        for (i, state) in [(0, &self.before), (POINTS - 1, &self.state)] {
            let end = i.min(1);
            let (x, v) = state.split_at(d);
            let mut rate = vec![0.0; d];
            let a = loads[end].a;
            let (force, stop) = match mode {
                Mode::Stick => (self.structure.demand(x, v, a) + held, held),
                Mode::Slip(_) => {
                    (forces[end] * self.law.speed_factor(v[0]), push.force(x[0], v[0]))
                }
            };
            self.structure.accelerate(phase, (x, v), (a, force + push.shift), &mut rate);
            let now = Instant { x, v, rate: &rate, a, force, stop };
            self.peaks.outputs_at(&now, &mut values, i);
        }
        if phase != Phase::Pressed
            && let Some(spread) = &self.spreads[phase as usize]
            && !spread.bounds.is_empty()
        {
            let inputs = self.before.iter().copied().chain(loads.map(|load| load.a)).chain(forces);
            let sizes: Vec<f64> = inputs.map(f64::abs).collect();
            let share = step_s / spread.longest_s;
            let rows = spread.bounds.chunks_exact(sizes.len());
            let off =
                rows.map(|row| share * row.iter().zip(&sizes).map(|(b, u)| b * u).sum::<f64>());
            if !self.peaks.may_pass(&values, off) {
                return;
            }
        }
        let linear = |pair: [f64; 2], t: f64| pair[0] + (pair[1] - pair[0]) * t;
        let points = self.scheme.rule.points;
        let [x, v, rates] = self.scheme.trace();
        for i in 1..=NODES {
            let of = |list: &'_ [f64]| -> Vec<f64> { list[(i - 1) * d..i * d].to_vec() };
            let (x, v, rate) = (of(x), of(v), of(rates));
            let a = linear(loads.map(|load| load.a), points[i]);
            let (force, stop) = match mode {
                Mode::Stick => (self.structure.demand(&x, &v, a) + held, held),
                Mode::Slip(_) => {
                    let force = linear(forces, points[i]) * self.law.speed_factor(v[0]);
                    (force, push.force(x[0], v[0]))
                }
            };
            let now = Instant { x: &x, v: &v, rate: &rate, a, force, stop };
            self.peaks.outputs_at(&now, &mut values, i);
        }
        for (output, values) in values.iter().enumerate() {
            self.peaks.search(self.scheme.rule, output, values);
        }
    }

    /// Judges a step of a stick from the demand at its points.
    fn held(&mut self, from_s: f64, step_s: f64, loads: [Load; 2], demands: &[f64; POINTS]) {
        let rule = self.scheme.rule;
        let normal = |t: f64| between(loads, t).normal;
        let mut margins = [f64::NAN; POINTS];
        let rounding = self.rounding(&loads[0]);
        for i in 0..POINTS {
            let n = normal(rule.points[i]);
            let beyond = self.law.beyond(demands[i], n) - rounding;
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
                let beyond = -margin * self.law.bound(demands[i], normal(t)) - rounding;
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
        let rule = self.scheme.rule;
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
