//! One step of the motion in a plane: Gauss collocation with eight nodes in physical time, by Newton's method.
//!
//! With `F_i` the accelerations at the nodes, `w_i = w_0 + h Σ_j A_ij F_j` and `∂(f u)/∂w = (f/r)(I − u uᵀ) + f′(r) u uᵀ`:
//!
//! ```text
//! δ_i + h P_i Σ_j A_ij δ_j = p_i − f_i u_i − F_i        P = ∂(f u)/∂w
//! ```
//!
//! for the block's part; what the structure does to `p` and to itself follows by iteration, as λ h ≤ 1/2.
//!
//! Legendre's coefficients `c_k` of `F` fall like `ρ^−k` for a motion that is analytic in an ellipse of
//! that ρ, the defect at the end of a step like `ρ^−16`: less than `h |F| (c_6/|F|)²`; the more
//! so where friction is stiff.

use super::super::collocation::{NODES, POINTS, Rule, legendre};
use super::frame::{
    Forces, Loads, Pair, PlaneFrame, between, cross, dot, norm, table, times, unit,
};

/// A velocity below this part of the largest in a step has no direction.
const ROUNDING: f64 = 1e-9;
/// Largest last Legendre coefficient over the largest acceleration with which the polynomials are as good as the
/// motion.
pub(super) const FINE: f64 = 1e-10;
/// Most passes of the iteration.
const MOST_PASSES: usize = 40;
/// Unknowns of the block at the nodes.
const UNKNOWNS: usize = 2 * NODES;

/// Displacements and velocities, the block's first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct State {
    pub(super) x: Vec<f64>,
    pub(super) v: Vec<f64>,
}

impl State {
    /// `w`.
    pub(super) fn speed(&self) -> Pair {
        [self.v[0], self.v[1]]
    }

    /// The block comes to rest in no time, the floors go on: `q̇_i += w`, then `w = 0`.
    pub(super) fn lose_speed(&mut self, frame: &PlaneFrame<'_>) {
        let w = self.speed();
        for (i, v) in self.v.iter_mut().skip(2).enumerate() {
            *v += frame.ridden(i, w);
        }
        self.v[..2].fill(0.0);
    }
}

/// A stretch of time under linear loads.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    pub(super) from_s: f64,
    pub(super) step_s: f64,
    pub(super) loads: [Loads; 2],
}

impl Stretch {
    /// Loads at a time from its start.
    pub(super) fn at(&self, t: f64) -> Loads {
        between(&self.loads, t / self.step_s)
    }

    /// The part of a length from a time on.
    pub(super) fn part(&self, t: f64, step_s: f64) -> Self {
        let end = if t + step_s >= self.step_s { self.loads[1] } else { self.at(t + step_s) };
        Self { from_s: self.from_s + t, step_s, loads: [self.at(t), end] }
    }
}

/// The motion in a step: polynomials through their values at the points of the rule.
pub(super) struct Step {
    pub(super) stretch: Stretch,
    pub(super) slips: bool,
    x: Vec<[f64; POINTS]>,
    v: Vec<[f64; POINTS]>,
    /// Largest of the last Legendre coefficients of the block's acceleration over its largest value.
    pub(super) tail: f64,
    /// Largest acceleration of the block over the table.
    pub(super) sharpest: f64,
    /// Largest rate of each velocity.
    pub(super) rates: Vec<f64>,
}

impl Step {
    /// The state at a point.
    pub(super) fn at_point(&self, point: usize, state: &mut State) {
        for (to, from) in [(&mut state.x, &self.x), (&mut state.v, &self.v)] {
            to.clear();
            to.extend(from.iter().map(|values| values[point]));
        }
    }

    /// The state at a part of the step.
    pub(super) fn at(&self, rule: &Rule, part: f64, state: &mut State) {
        if let Some(point) = rule.points.iter().position(|point| *point == part) {
            return self.at_point(point, state);
        }
        for (to, from) in [(&mut state.x, &self.x), (&mut state.v, &self.v)] {
            to.clear();
            to.extend(from.iter().map(|values| rule.interpolate(values, part)));
        }
    }

    /// `w` at a point.
    pub(super) fn speed(&self, point: usize) -> Pair {
        [self.v[0][point], self.v[1][point]]
    }

    /// The direction of a slip at a point under a push. At rest, in which a slip begins and ends along the push,
    /// what is left of the velocity is rounding; in straight motion it is that of the point beside it.
    pub(super) fn heading(&self, frame: &PlaneFrame<'_>, point: usize, push: Pair) -> Pair {
        let fastest = (0..POINTS).fold(0.0, |most: f64, i| most.max(norm(self.speed(i))));
        let (w, Stretch { from_s, step_s, loads }) = (self.speed(point), &self.stretch);
        let beside = self.speed(if point == 0 { 1 } else { point - 1 });
        let under = (from_s + step_s, &loads[0], push);
        if norm(w) > ROUNDING * fastest && !frame.has_turned_about([w, beside], under) {
            return unit(w).unwrap_or_default();
        }
        let along = if frame.body.is_one() {
            unit(push)
        } else {
            let part = if point == 0 { 0.0 } else { self.stretch.step_s };
            frame.body.departure(push, frame.slowing(&self.stretch.at(part), 0.0))
        };
        let along = along.filter(|u| dot(*u, beside) > 0.0);
        along.or(unit(beside)).unwrap_or_default()
    }

    /// `∫|w| dt`, by halves where the speed has corners: it may have one where it is least.
    pub(super) fn path_m(&self, rule: &Rule) -> f64 {
        let speed = |t: f64| norm([0, 1].map(|axis| rule.interpolate(&self.v[axis], t)));
        let over = |from: f64, to: f64| {
            let nodes = rule.c.iter().zip(&rule.weights);
            (to - from) * nodes.map(|(c, b)| b * speed(from + (to - from) * c)).sum::<f64>()
        };
        let speeds: [f64; POINTS] = core::array::from_fn(|i| norm(self.speed(i)));
        let inside: [f64; NODES] = core::array::from_fn(|i| speeds[1 + i]);
        let whole: f64 = rule.weights.iter().zip(&inside).map(|(b, r)| b * r).sum();
        let last = [NODES - 2, NODES - 1].map(|k| coefficient(rule, k, &inside).abs());
        // A corner beside an end shows in no coefficient, and none shows where a part ends beside it.
        let is_inside = |i: usize| i > 0 && i + 1 < POINTS;
        let is_low =
            |i: &usize| is_least(&speeds, *i) && (is_inside(*i) || speeds[*i] <= 0.1 * whole);
        let low: Vec<usize> = (0..POINTS).filter(is_low).collect();
        if low.is_empty() && last[0].max(last[1]) <= 1e-7 * whole {
            return self.stretch.step_s * whole;
        }
        let least = |i: usize| rule.least_of((i, speeds[i] * speeds[i]), |t| speed(t) * speed(t)).0;
        let inner = |t: &f64| *t > 0.0 && *t < 1.0;
        let corners: Vec<f64> = low.into_iter().map(least).filter(inner).collect();
        let ends = [&[0.0], &corners[..], &[1.0]].concat();
        let mut parts: Vec<_> = ends.windows(2).map(|e| (e[0], e[1], over(e[0], e[1]))).collect();
        let mut sum = 0.0;
        while let Some((from, to, one)) = parts.pop() {
            let middle = 0.5 * (from + to);
            let halves = [over(from, middle), over(middle, to)];
            let both = halves[0] + halves[1];
            if (both - one).abs() <= 1e-15 * whole || to - from < 1e-12 {
                sum += both;
            } else {
                parts.extend([(from, middle, halves[0]), (middle, to, halves[1])]);
            }
        }
        self.stretch.step_s * sum
    }

    /// The defect of the block's velocity at the end, about.
    pub(super) fn defect(&self) -> f64 {
        self.stretch.step_s * self.sharpest * self.tail * self.tail
    }
}

/// Whether a value is below those beside it.
fn is_least(values: &[f64; POINTS], point: usize) -> bool {
    let below = |other: Option<&f64>| other.is_none_or(|other| values[point] < *other);
    below(point.checked_sub(1).map(|i| &values[i])) && below(values.get(point + 1))
}

/// Solves steps.
pub(super) struct Stepper<'a> {
    pub(super) frame: &'a PlaneFrame<'a>,
    pub(super) rule: &'static Rule,
}

/// Accelerations at the nodes, part by part.
type Rates = Vec<[f64; NODES]>;

impl Stepper<'_> {
    /// A step from a state; `None` where the iteration does not settle. A slip that starts from rest follows
    /// the push: `None` where that does not exceed friction.
    pub(super) fn solve(&self, from: &State, stretch: Stretch, slips: bool) -> Option<Step> {
        let mut rates = vec![[0.0; NODES]; self.frame.degrees()];
        if slips {
            if unit(from.speed()).is_some() || stretch.loads.iter().all(|l| self.frame.is_free(l)) {
                self.go_on(from, stretch, &mut rates);
            } else {
                self.depart(from, stretch, &mut rates)?;
            }
        }
        let settled = self.settle(from, stretch, slips, &mut rates);
        settled.then(|| self.step(from, stretch, slips, &rates))
    }

    /// The state at a part of a step, by a step that ends there: an end is known better than what lies between
    /// the points.
    pub(super) fn at(&self, step: &Step, part: f64, state: &mut State) {
        step.at_point(0, state);
        if part > 0.0 {
            let stretch = step.stretch.part(0.0, part * step.stretch.step_s);
            match self.solve(state, stretch, step.slips) {
                Some(part) => part.at_point(POINTS - 1, state),
                None => step.at(self.rule, part, state),
            }
        }
    }

    /// Accelerations to begin a slip with that is under way: those at its start.
    fn go_on(&self, from: &State, stretch: Stretch, rates: &mut Rates) {
        let mut floors = vec![0.0; self.frame.masses_kg.len()];
        let loads = &stretch.loads[0];
        let push = self.frame.forces(&from.x, &from.v, loads, &mut floors).push;
        let u = unit(from.speed()).unwrap_or([0.0; 2]);
        let f = self.frame.slowing(loads, norm(from.speed()));
        let block = self.frame.body.moved([0, 1].map(|i| push[i] - f * u[i]));
        let a = table(loads);
        for (k, list) in rates.iter_mut().enumerate() {
            *list = match k.checked_sub(2) {
                None => [block[k]; NODES],
                Some(part) => {
                    let [carried, moved] = [a, block].map(|of| self.frame.ridden(part, of));
                    let pull = -floors[part] / self.frame.masses_kg[part] - carried;
                    [pull - moved; NODES]
                }
            };
        }
    }

    /// Accelerations to begin a release with: `(|p| − f) p/|p|` of a block that would rest.
    fn depart(&self, from: &State, stretch: Stretch, rates: &mut Rates) -> Option<()> {
        let mut floors = vec![0.0; self.frame.masses_kg.len()];
        if !self.settle(from, stretch, false, rates) {
            return None;
        }
        let step = self.step(from, stretch, false, rates);
        let mut state = State::default();
        let mut leaves = false;
        for i in 0..NODES {
            step.at_point(1 + i, &mut state);
            let loads = between(&stretch.loads, self.rule.c[i]);
            let push = self.frame.forces(&state.x, &state.v, &loads, &mut floors).push;
            let slowing = self.frame.slowing(&loads, 0.0);
            let beyond = norm(push) - slowing;
            leaves |= beyond > 0.0;
            let along = self.frame.body.departure(push, slowing)?;
            let start = times(along, beyond.max(1e-3 * beyond.abs()));
            (rates[0][i], rates[1][i]) = (start[0], start[1]);
        }
        leaves.then_some(())
    }

    /// Iterates accelerations at the nodes. Whether they settle.
    fn settle(&self, from: &State, stretch: Stretch, slips: bool, rates: &mut Rates) -> bool {
        let (rule, frame, h) = (self.rule, self.frame, stretch.step_s);
        let d = frame.degrees();
        let mut floors = vec![0.0; d - 2];
        let mut state = from.clone();
        let mut last = f64::INFINITY;
        let mut pulls = vec![0.0; NODES * (d - 2)];
        for pass in 0..MOST_PASSES {
            let mut system = Newton::default();
            // An acceleration is known to the rounding of the forces that it is made of.
            let terms = frame.largest_terms(&state.x, &state.v);
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for i in 0..NODES {
                node(rule, h, from, rates, i, &mut state);
                let loads = between(&stretch.loads, rule.c[i]);
                let Forces { push, .. } = frame.forces(&state.x, &state.v, &loads, &mut floors);
                let a = table(&loads);
                for (k, (floor, mass)) in floors.iter().zip(&frame.masses_kg).enumerate() {
                    pulls[i * (d - 2) + k] = -floor / mass - frame.ridden(k, a);
                }
                if !slips {
                    continue;
                }
                let w = state.speed();
                let r = norm(w);
                let [f, slope] = frame.slowing_and_slope(&loads, r);
                let mut rate = frame.body.moved(push);
                let mut bend = [[0.0; 2]; 2];
                if f > 0.0 && r > 0.0 {
                    let u = [w[0] / r, w[1] / r];
                    rate = frame.body.moved([push[0] - f * u[0], push[1] - f * u[1]]);
                    // It is symmetric, its columns are its rows.
                    let rows = [0, 1].map(|a| {
                        let across = |b: usize| if a == b { 1.0 } else { 0.0 } - u[a] * u[b];
                        [0, 1].map(|b| f / r * across(b) + slope * u[a] * u[b])
                    });
                    let columns = rows.map(|column| frame.body.moved(column));
                    bend = [0, 1].map(|a| [columns[0][a], columns[1][a]]);
                }
                size = size.max(norm(push) + f);
                system.take(rule, h, i, bend, [rate[0] - rates[0][i], rate[1] - rates[1][i]]);
            }
            if slips {
                let Some(steps) = system.solve() else { return false };
                for i in 0..NODES {
                    for axis in 0..2 {
                        let step = steps[2 * i + axis];
                        change = change.max(step.abs());
                        rates[axis][i] += step;
                    }
                }
            }
            for i in 0..NODES {
                for k in 2..d {
                    let block = [rates[0][i], rates[1][i]];
                    let rate = pulls[i * (d - 2) + k - 2] - frame.ridden(k - 2, block);
                    change = change.max((rate - rates[k][i]).abs());
                    size = size.max(rate.abs());
                    rates[k][i] = rate;
                }
            }
            if !change.is_finite() {
                return false;
            }
            // The next pass would change as much less as this one has.
            let next = if pass > 0 { change * (change / last) } else { change };
            let stalled = pass >= 6 && change >= 0.5 * last && change <= 1e-12 * size;
            if change.min(next) <= 2.0 * f64::EPSILON * size.max(terms) || stalled {
                return true;
            }
            last = change;
        }
        false
    }

    /// The motion from accelerations at the nodes.
    fn step(&self, from: &State, stretch: Stretch, slips: bool, rates: &Rates) -> Step {
        let (rule, h, d) = (self.rule, stretch.step_s, self.frame.degrees());
        let (mut x, mut v) = (vec![[0.0; POINTS]; d], vec![[0.0; POINTS]; d]);
        let mut state = State { x: vec![0.0; d], v: vec![0.0; d] };
        for i in 0..NODES {
            node(rule, h, from, rates, i, &mut state);
            for k in 0..d {
                (x[k][1 + i], v[k][1 + i]) = (state.x[k], state.v[k]);
            }
        }
        for k in 0..d {
            (x[k][0], v[k][0]) = (from.x[k], from.v[k]);
            [x[k][POINTS - 1], v[k][POINTS - 1]] =
                rule.end(h, [from.x[k], from.v[k]], |j| rates[k][j]);
        }
        let most =
            |list: &[f64; NODES]| list.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let sharpest = most(&rates[0]).max(most(&rates[1]));
        let tail = if slips && sharpest > 0.0 {
            let last =
                |k: usize| rates[..2].iter().map(move |list| coefficient(rule, k, list).abs());
            last(NODES - 2).chain(last(NODES - 1)).fold(0.0, f64::max) / sharpest
        } else {
            0.0
        };
        let rates = rates.iter().map(most).collect();
        Step { stretch, slips, x, v, tail, sharpest, rates }
    }
}

/// The state at a node.
fn node(rule: &Rule, h: f64, from: &State, rates: &Rates, i: usize, state: &mut State) {
    for k in 0..rates.len() {
        [state.x[k], state.v[k]] = rule.node(i, h, [from.x[k], from.v[k]], |j| rates[k][j]);
    }
}

/// Legendre's coefficient of values at the nodes.
fn coefficient(rule: &Rule, k: usize, values: &[f64; NODES]) -> f64 {
    let terms =
        (0..NODES).map(|j| rule.weights[j] * legendre(k, 2.0 * rule.c[j] - 1.0) * values[j]);
    (2 * k + 1) as f64 * terms.sum::<f64>()
}

/// The linear system of a pass, and its right side.
struct Newton {
    rows: [[f64; UNKNOWNS + 1]; UNKNOWNS],
}

impl Default for Newton {
    fn default() -> Self {
        Self { rows: [[0.0; UNKNOWNS + 1]; UNKNOWNS] }
    }
}

impl Newton {
    /// The two rows of a node.
    fn take(&mut self, rule: &Rule, h: f64, i: usize, bend: [[f64; 2]; 2], off: Pair) {
        for axis in 0..2 {
            let row = &mut self.rows[2 * i + axis];
            for j in 0..NODES {
                for other in 0..2 {
                    row[2 * j + other] = h * bend[axis][other] * rule.a[i][j];
                }
            }
            row[2 * i + axis] += 1.0;
            row[UNKNOWNS] = off[axis];
        }
    }

    /// By elimination with row pivots.
    fn solve(mut self) -> Option<[f64; UNKNOWNS]> {
        let rows = &mut self.rows;
        for column in 0..UNKNOWNS {
            let larger = |a: usize, b: usize| {
                if rows[b][column].abs() > rows[a][column].abs() { b } else { a }
            };
            let pivot = (column..UNKNOWNS).reduce(larger)?;
            if rows[pivot][column] == 0.0 {
                return None;
            }
            rows.swap(column, pivot);
            let own = rows[column];
            for row in rows.iter_mut().skip(column + 1) {
                let factor = row[column] / own[column];
                if factor != 0.0 {
                    for (value, own) in row.iter_mut().zip(&own).skip(column) {
                        *value -= factor * own;
                    }
                }
            }
        }
        let mut found = [0.0; UNKNOWNS];
        for i in (0..UNKNOWNS).rev() {
            let known: f64 = (i + 1..UNKNOWNS).map(|j| rows[i][j] * found[j]).sum();
            found[i] = (rows[i][UNKNOWNS] - known) / rows[i][i];
        }
        Some(found)
    }
}

/// When and whether a block that slides comes to rest under a push that lasts.
///
/// With `p` frozen and |p| < f it does after `Θ = (f r + p·w)/(f² − p²)`, whatever its direction.
pub(super) fn time_to_rest(w: Pair, push: Pair, slowing: f64) -> Option<f64> {
    let (f, p) = (slowing, norm(push));
    (p < f).then(|| (f * norm(w) + dot(push, w)) / ((f - p) * (f + p)))
}

/// Sine of the angle between two directions.
pub(super) fn sine(a: Pair, b: Pair) -> f64 {
    match (unit(a), unit(b)) {
        (Some(a), Some(b)) => cross(a, b).abs(),
        _ => 0.0,
    }
}
