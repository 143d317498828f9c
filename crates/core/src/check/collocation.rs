//! Gauss collocation of the equations of motion over one step.
//!
//! With the nodes `c_i` of Gauss's rule on (0, 1) and `F_i = ẍ(c_i h)`,
//!
//! ```text
//! v_i = v_0 + h Σ_j A_ij F_j        x_i = x_0 + c_i h v_0 + h² Σ_j (A²)_ij F_j
//! v_1 = v_0 + h Σ_j b_j F_j         x_1 = x_0 + h v_0 + h² Σ_j b_j (1 − c_j) F_j
//! ```
//!
//! which is solved by iterating `F_i ← ẍ(x_i, v_i)`. For eight nodes the end of a step of a mode of
//! rate λ is the (8, 8) Padé approximant of `exp(λ h)`, its error 2.2e-19 (λh)¹⁷; inside, where the
//! order is 8, it is below 2e-10 (λh)⁹. Steps with λh ≤ [`MAX_TURN`] = 1/2 keep the two below 1e-23
//! and 4e-13 of the amplitude.

use std::sync::LazyLock;

use super::law::Law;
use super::structure::{Phase, Structure};

/// Nodes of the rule.
pub(super) const NODES: usize = 8;
/// Nodes and both ends.
pub(super) const POINTS: usize = NODES + 2;
/// Largest rate times step.
pub(super) const MAX_TURN: f64 = 0.5;
/// Inputs of a step beside the state: `a` and `T` at its two ends.
const LOADS: usize = 4;
/// Most passes of the iteration.
pub(super) const MOST_PASSES: usize = 100;
/// Changes below this part of the accelerations may be rounding.
pub(super) const ROUNDING: f64 = 1e-12;
/// Most intervals that are kept.
const KEPT: usize = 16;

/// Nodes, weights and integrals of the rule, and what interpolates between its points.
pub(super) struct Rule {
    /// Nodes.
    pub(super) c: [f64; NODES],
    /// Weights `b`.
    pub(super) weights: [f64; NODES],
    /// `A` and its square.
    pub(super) a: [[f64; NODES]; NODES],
    pub(super) aa: [[f64; NODES]; NODES],
    /// 0, the nodes, 1.
    pub(super) points: [f64; POINTS],
    barycentric: [f64; POINTS],
}

impl Rule {
    /// The rule, made once.
    pub(super) fn get() -> &'static Self {
        static RULE: LazyLock<Rule> = LazyLock::new(Rule::new);
        &RULE
    }

    fn new() -> Self {
        let mut c = [0.0; NODES];
        let mut weights = [0.0; NODES];
        for i in 0..NODES {
            let angle = core::f64::consts::PI * ((NODES - i) as f64 - 0.25) / (NODES as f64 + 0.5);
            let mut z = libm::cos(angle);
            let mut slope = 0.0;
            for _ in 0..8 {
                let (mut p, mut before) = (1.0, 0.0);
                for k in 1..=NODES {
                    let k = k as f64;
                    (p, before) = (((2.0 * k - 1.0) * z * p - (k - 1.0) * before) / k, p);
                }
                slope = NODES as f64 * (z * p - before) / (z * z - 1.0);
                z -= p / slope;
            }
            c[i] = 0.5 * (1.0 + z);
            weights[i] = 1.0 / ((1.0 - z * z) * slope * slope);
        }
        // The integral of Lagrange's polynomial over (0, c_i), by the rule itself: exact.
        let lagrange = |j: usize, t: f64| {
            (0..NODES).filter(|&k| k != j).map(|k| (t - c[k]) / (c[j] - c[k])).product::<f64>()
        };
        let integral = |i: usize, j: usize| {
            c[i] * (0..NODES).map(|k| weights[k] * lagrange(j, c[i] * c[k])).sum::<f64>()
        };
        let a: [[f64; NODES]; NODES] =
            core::array::from_fn(|i| core::array::from_fn(|j| integral(i, j)));
        let square = |i: usize, j: usize| (0..NODES).map(|k| a[i][k] * a[k][j]).sum();
        let aa = core::array::from_fn(|i| core::array::from_fn(|j| square(i, j)));
        let points: [f64; POINTS] = core::array::from_fn(|i| match i {
            0 => 0.0,
            i if i <= NODES => c[i - 1],
            _ => 1.0,
        });
        let barycentric = core::array::from_fn(|i| {
            let gaps = (0..POINTS).filter(|&k| k != i).map(|k| points[i] - points[k]);
            1.0 / gaps.product::<f64>()
        });
        Self { c, weights, a, aa, points, barycentric }
    }

    /// The polynomial through `values` at the points, at `t` in [0, 1].
    fn interpolate(&self, values: &[f64; POINTS], t: f64) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        for ((&p, &w), &value) in self.points.iter().zip(&self.barycentric).zip(values) {
            if t == p {
                return value;
            }
            let share = w / (t - p);
            above += share * value;
            below += share;
        }
        above / below
    }

    /// The smallest value of `cost(t, value(t))` next to the point `middle`, by golden section.
    pub(super) fn least(
        &self,
        values: &[f64; POINTS],
        middle: usize,
        cost: impl Fn(f64, f64) -> f64,
    ) -> (f64, f64) {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let at = |t: f64| cost(t, self.interpolate(values, t));
        let mut low = self.points[middle.saturating_sub(1)];
        let mut high = self.points[(middle + 1).min(POINTS - 1)];
        let mut left = high - GOLDEN * (high - low);
        let mut right = low + GOLDEN * (high - low);
        let (mut at_left, mut at_right) = (at(left), at(right));
        // Sixteen sections leave 5e-4 of the bracket, three parabolas through the best three points
        // its square again and again.
        for _ in 0..16 {
            if at_left <= at_right {
                (high, right, at_right) = (right, left, at_left);
                left = high - GOLDEN * (high - low);
                at_left = at(left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + GOLDEN * (high - low);
                at_right = at(right);
            }
        }
        let mut found = if at_left <= at_right { (left, at_left) } else { (right, at_right) };
        let mut width = 0.5 * (high - low);
        for _ in 0..3 {
            let t = found.0;
            let (below, above) = (at(t - width), at(t + width));
            let bend = below - 2.0 * found.1 + above;
            let shift = 0.5 * width * (below - above) / bend;
            if !(bend > 0.0 && shift.abs() <= width) {
                break;
            }
            let inside = (t + shift).clamp(low, high);
            let there = (inside, at(inside));
            if there.1 <= found.1 {
                found = there;
            }
            width *= 0.1;
        }
        let node = (self.points[middle], cost(self.points[middle], values[middle]));
        if node.1 <= found.1 { node } else { found }
    }
}

/// What a step found: `v` at the nodes (node by node), `x` and `v` at its end, and in stick the
/// demand at the nodes.
pub(super) struct Path {
    values: Vec<f64>,
    degrees: usize,
}

impl Path {
    /// `v` at a node.
    pub(super) fn velocity(&self, node: usize) -> &[f64] {
        &self.values[node * self.degrees..(node + 1) * self.degrees]
    }

    /// `(x, v)` at the end.
    pub(super) fn end(&self) -> &[f64] {
        &self.values[NODES * self.degrees..(NODES + 2) * self.degrees]
    }

    /// The demand at the nodes, in stick.
    pub(super) fn demands(&self) -> &[f64] {
        &self.values[(NODES + 2) * self.degrees..]
    }
}

/// An interval met before, with its number of steps.
struct Kept {
    phase: Phase,
    duration_s: f64,
    steps: usize,
    /// Times a step was solved anew.
    solved: usize,
    /// Columns of the linear map from inputs to a [`Path`], once that pays.
    columns: Vec<f64>,
}

/// Integrates the equations of motion of a structure.
pub(super) struct Scheme<'a> {
    pub(super) rule: &'static Rule,
    structure: &'a Structure,
    law: &'a Law,
    rates: [f64; 3],
    kept: Vec<Kept>,
    same_s: f64,
    /// Whether the last step was solved, and not taken from its columns.
    solved: bool,
    /// The interval under way: where it is kept, and its step.
    slot: usize,
    step_s: f64,
    input: Vec<f64>,
    forces: Vec<f64>,
    x: Vec<f64>,
    v: Vec<f64>,
    next: Vec<f64>,
    /// `x` at the nodes of a traced step.
    places: Vec<f64>,
    path: Path,
}

impl<'a> Scheme<'a> {
    /// Intervals that differ by no more than `same_s` count as one; friction by speed adds to the rates
    /// of a slip.
    pub(super) fn new(
        (structure, law): (&'a Structure, &'a Law),
        same_s: f64,
        added_rate: f64,
    ) -> Self {
        let d = structure.degrees();
        let rate = |phase: Phase| {
            structure.rate(phase) + if phase == Phase::Stick { 0.0 } else { added_rate }
        };
        Self {
            rule: Rule::get(),
            structure,
            law,
            rates: [Phase::Stick, Phase::Slip, Phase::Pressed].map(rate),
            kept: Vec::new(),
            same_s,
            solved: false,
            slot: 0,
            step_s: 0.0,
            input: vec![0.0; 2 * d + LOADS],
            forces: vec![0.0; NODES * d],
            x: vec![0.0; d],
            v: vec![0.0; d],
            next: vec![0.0; d],
            places: vec![0.0; NODES * d],
            path: Path { values: vec![0.0; (NODES + 2) * d + NODES], degrees: d },
        }
    }

    /// Bound on the fastest rate of a phase, in 1/s.
    pub(super) fn rate(&self, phase: Phase) -> f64 {
        self.rates[phase as usize]
    }

    /// Prepares an interval and returns how many equal steps it takes.
    pub(super) fn begin(&mut self, phase: Phase, duration_s: f64) -> usize {
        let rate = self.rate(phase);
        let steps = libm::ceil(rate * duration_s / MAX_TURN).max(1.0) as usize;
        self.step_s = duration_s / steps as f64;
        self.slot = self.find(phase, duration_s, steps);
        steps
    }

    /// One step from `state = (x, v)` with `a` and `T` linear between two values.
    pub(super) fn step(&mut self, state: &[f64], [a, force]: [[f64; 2]; 2]) -> &Path {
        let d = self.path.degrees;
        self.input[..2 * d].copy_from_slice(state);
        self.input[2 * d..].copy_from_slice(&[a[0], a[1], force[0], force[1]]);
        let Kept { phase, duration_s, steps, solved, .. } = self.kept[self.slot];
        if self.kept[self.slot].columns.is_empty() {
            // The columns cost as much as these solutions, so they are made when that is spent.
            if solved < self.input.len() || !self.is_linear(phase) {
                self.kept[self.slot].solved = solved.saturating_add(1);
                self.solve(phase, self.step_s);
                self.solved = true;
                return &self.path;
            }
            self.kept[self.slot].columns = self.columns(phase, duration_s / steps as f64);
        }
        self.solved = false;
        let out = &mut self.path.values;
        out.fill(0.0);
        let columns = self.kept[self.slot].columns.chunks_exact(out.len());
        for (column, &u) in columns.zip(&self.input) {
            if u != 0.0 {
                for (o, c) in out.iter_mut().zip(column) {
                    *o += c * u;
                }
            }
        }
        &self.path
    }

    /// Whether the path of a phase is a linear map of its inputs.
    fn is_linear(&self, phase: Phase) -> bool {
        phase == Phase::Stick || self.law.rate.is_none()
    }

    /// The phase under way.
    pub(super) fn phase(&self) -> Phase {
        self.kept[self.slot].phase
    }

    /// What the last step found.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// `x`, `v` and `ẍ` at the nodes of the last step, node by node.
    pub(super) fn trace(&mut self) -> [&[f64]; 3] {
        let (phase, step_s) = (self.kept[self.slot].phase, self.step_s);
        if !self.solved {
            self.solve(phase, step_s);
            self.solved = true;
        }
        let d = self.path.degrees;
        for i in 0..NODES {
            self.node(step_s, i);
            self.places[i * d..(i + 1) * d].copy_from_slice(&self.x);
        }
        [&self.places, &self.path.values[..NODES * d], &self.forces]
    }

    /// Keeps the columns of a step of an interval of so many.
    pub(super) fn keep(
        &mut self,
        phase: Phase,
        (duration_s, steps): (f64, usize),
        columns: Vec<f64>,
    ) {
        self.slot = self.find(phase, duration_s, steps);
        self.kept[self.slot].columns = columns;
        // Not the one to make room.
        self.kept[self.slot].solved = usize::MAX;
    }

    /// Where an interval is kept; the least used makes room.
    fn find(&mut self, phase: Phase, duration_s: f64, steps: usize) -> usize {
        let same_s = self.same_s;
        let same = |k: &Kept| {
            k.phase == phase && k.steps == steps && (k.duration_s - duration_s).abs() <= same_s
        };
        if self.kept.get(self.slot).is_some_and(same) {
            return self.slot;
        }
        if let Some(slot) = self.kept.iter().position(same) {
            return slot;
        }
        let fresh = Kept { phase, duration_s, steps, solved: 0, columns: Vec::new() };
        if self.kept.len() < KEPT {
            self.kept.push(fresh);
            return self.kept.len() - 1;
        }
        let least = |best: usize, i: usize| {
            if self.kept[i].solved < self.kept[best].solved { i } else { best }
        };
        let slot = (1..KEPT).fold(0, least);
        self.kept[slot] = fresh;
        slot
    }

    /// The paths of unit inputs, one after another.
    fn columns(&mut self, phase: Phase, step_s: f64) -> Vec<f64> {
        let input = self.input.clone();
        let mut columns = Vec::with_capacity(input.len() * self.path.values.len());
        for i in 0..input.len() {
            self.input.fill(0.0);
            self.input[i] = 1.0;
            self.solve(phase, step_s);
            columns.extend_from_slice(&self.path.values);
        }
        self.input = input;
        columns
    }

    /// Solves the collocation equations for `input`.
    fn solve(&mut self, phase: Phase, h: f64) {
        let d = self.path.degrees;
        self.forces.fill(0.0);
        let mut last = f64::INFINITY;
        // A pass gains a factor of about ten; at rounding the change no longer shrinks. Where the law is
        // not linear the first may gain little.
        let rounding = if self.is_linear(phase) { f64::INFINITY } else { ROUNDING };
        for pass in 0..MOST_PASSES {
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for i in 0..NODES {
                self.node(h, i);
                let (a, load) = self.load(i);
                let load = (a, load * self.law.speed_factor(self.v[0]));
                self.structure.accelerate(phase, (&self.x, &self.v), load, &mut self.next);
                let old = &mut self.forces[i * d..(i + 1) * d];
                for (old, &new) in old.iter_mut().zip(&self.next) {
                    change = change.max((new - *old).abs());
                    size = size.max(new.abs());
                    *old = new;
                }
            }
            let stalled = change >= 0.5 * last && change <= rounding * size;
            if change <= 0.5 * f64::EPSILON * size || pass >= 8 && stalled {
                break;
            }
            last = change;
        }
        for i in 0..NODES {
            self.node(h, i);
            self.path.values[i * d..(i + 1) * d].copy_from_slice(&self.v);
            if phase == Phase::Stick {
                let demand = self.structure.demand(&self.x, &self.v, self.load(i).0);
                self.path.values[(NODES + 2) * d + i] = demand;
            }
        }
        let (x, v) = self.path.values[NODES * d..(NODES + 2) * d].split_at_mut(d);
        for k in 0..d {
            let (x0, v0) = (self.input[k], self.input[d + k]);
            let (mut dx, mut dv) = (0.0, 0.0);
            for j in 0..NODES {
                let share = self.rule.weights[j] * self.forces[j * d + k];
                dv += share;
                dx += share * (1.0 - self.rule.c[j]);
            }
            v[k] = v0 + h * dv;
            x[k] = x0 + h * (v0 + h * dx);
        }
    }

    /// `x` and `v` at a node from the accelerations at all nodes.
    fn node(&mut self, h: f64, i: usize) {
        let d = self.path.degrees;
        let rule = self.rule;
        for k in 0..d {
            let (x0, v0) = (self.input[k], self.input[d + k]);
            let (mut dx, mut dv) = (0.0, 0.0);
            for j in 0..NODES {
                let force = self.forces[j * d + k];
                dv += rule.a[i][j] * force;
                dx += rule.aa[i][j] * force;
            }
            self.v[k] = v0 + h * dv;
            self.x[k] = x0 + h * (rule.c[i] * v0 + h * dx);
        }
    }

    /// `a` and `T` at a node.
    fn load(&self, i: usize) -> (f64, f64) {
        let loads = &self.input[2 * self.path.degrees..];
        let c = self.rule.c[i];
        (loads[0] + (loads[1] - loads[0]) * c, loads[2] + (loads[3] - loads[2]) * c)
    }
}
