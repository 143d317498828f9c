//! One step of the motion in a plane: the force of the slider by Gauss collocation, all else by linear maps.
//!
//! The force on the block over its mass, `φ = −f(r) u − κ s` with `r u = w` and `κ = N/(R M1)` of a spring that follows
//! `N`, and with what a stop around the block takes where it is pressed, is the polynomial through its values at eight nodes. Structure, springs and dampers are linear ([`maps`]), so that
//! the block's motion at the nodes is linear in these values, and Newton's method has no other unknowns:
//!
//! ```text
//! w_j = w°_j + Σ_k G_jk φ_k        δ_j + Σ_k (P_j G_jk + κ_j S_jk) δ_k = −f_j u_j − κ_j s_j − φ_j
//! P = (f/r)(I − u uᵀ) + f′(r) u uᵀ
//! ```
//!
//! Legendre's coefficients `c_k` of φ fall like `ρ^−k` for a motion that is analytic in an ellipse of
//! that ρ, the defect at the end of a step like `ρ^−16`: less than `h |φ| (c_6/|φ|)²`; the more
//! so where friction is stiff.
//!
//! [`maps`]: super::maps

use super::super::collocation::{Column, NODES, POINTS, Rule, add, legendre};
use super::super::rate::SpeedLine;
use super::frame::{
    Loads, Pair, PlaneFrame, Ring, State, Under, between, cross, dot, norm, pair, times, unit,
};
use super::maps::{Blocks, Influence, Linear};
use super::peaks::Acting;
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;
use std::sync::LazyLock;

/// A velocity below this part of the largest in a step has no direction; nor has one at its ends, where it is what a stop
/// leaves, below the second part.
const ROUNDING: [f64; 2] = [1e-9, 1e-3];
/// Largest last Legendre coefficient over the largest force with which the polynomials are as good as the motion.
pub(super) const FINE: f64 = 1e-10;
/// Most passes of the iteration.
const MOST_PASSES: usize = 40;
/// No change of a force.
const ONE: [Pair; 2] = [[1.0, 0.0], [0.0, 1.0]];
/// Unknowns of the block at the nodes.
const UNKNOWNS: usize = 2 * NODES;

/// A stretch of time under linear loads.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    pub(super) from_s: f64,
    pub(super) step_s: f64,
    pub(super) loads: [Loads; 2],
    /// The straight line of friction by the speed that a slip is on.
    pub(super) line: Option<SpeedLine>,
    /// Whether the block presses the stop around it.
    pub(super) pressed: bool,
}

impl Stretch {
    /// Loads at a time from its start.
    pub(super) fn at(&self, t: f64) -> Loads {
        between(&self.loads, t / self.step_s)
    }

    /// The part of a length from a time on.
    pub(super) fn part(&self, t: f64, step_s: f64) -> Self {
        let end = if t + step_s >= self.step_s { self.loads[1] } else { self.at(t + step_s) };
        Self { from_s: self.from_s + t, step_s, loads: [self.at(t), end], ..*self }
    }
}

/// The motion in a step: what moves and acts at the points of the rule, polynomials between them.
pub(super) struct Step {
    pub(super) stretch: Stretch,
    pub(super) slips: bool,
    pub(super) acting: Acting<POINTS>,
    /// The size of `w`, and the largest.
    pub(super) speeds: [f64; POINTS],
    pub(super) quickest: f64,
    /// `f` at the points, and in a slip its directions there.
    pub(super) slowings: [f64; POINTS],
    pub(super) headings: [Column<POINTS>; 2],
    /// Directions of a slip at both ends by the polynomial of the force, if there is one.
    ends: [Option<Pair>; 2],
    /// Largest of the last Legendre coefficients of the slider's force over its largest value.
    pub(super) tail: f64,
    /// Largest force of the slider over the mass of the block.
    sharpest: f64,
}

impl Step {
    /// The state at a point.
    pub(super) fn state(&self, point: usize) -> State {
        let [x, v] = [self.acting.x(), self.acting.v()]
            .map(|list| list.iter().map(|column| column[point]).collect());
        State { x, v, pressed: self.stretch.pressed }
    }

    /// The state at a part of the step.
    pub(super) fn at(&self, rule: &Rule, part: f64) -> State {
        if let Some(point) = rule.points.iter().position(|point| *point == part) {
            return self.state(point);
        }
        let shares = rule.shares(part);
        let of = |column: &Column<POINTS>| shares.iter().zip(column).map(|(s, x)| s * x).sum();
        let [x, v] = [self.acting.x(), self.acting.v()].map(|list| list.iter().map(of).collect());
        State { x, v, pressed: self.stretch.pressed }
    }

    /// The part of it at which the speed leaves the line of friction that it is on, if it does, to within a part of the
    /// corner.
    pub(super) fn corner(&self, rule: &Rule, near: f64) -> Option<f64> {
        let line = self.stretch.line.filter(|_| self.slips)?;
        let speed = |t: f64| norm(self.speed_at(rule, t));
        // Beyond either end of the line.
        let beyond = |speed: f64| {
            let above = speed - line.to * (1.0 + near);
            if line.from > 0.0 { above.max(line.from * (1.0 - near) - speed) } else { above }
        };
        let speeds = self.speeds.map(beyond);
        let last = POINTS - 1;
        let first = (1..=last).find(|&i| speeds[i] > 0.0);
        // Where it goes there and back between two points.
        let best = (1..last).fold(1, |best, i| if speeds[i] > speeds[best] { i } else { best });
        let top = || rule.least_of((best, -speeds[best]), |t| -beyond(speed(t))).0;
        let mut high = match first {
            Some(i) => rule.points[i],
            None => Some(top()).filter(|t| beyond(speed(*t)) > 0.0)?,
        };
        let mut low = first.map_or(rule.points[best - 1], |i| rule.points[i - 1]);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if beyond(speed(middle)) > 0.0 { high = middle } else { low = middle }
        }
        (low > 0.0 && low < 1.0 - 4.0 * f64::EPSILON).then_some(low)
    }

    /// `w` at a part of the step.
    pub(super) fn speed_at(&self, rule: &Rule, part: f64) -> Pair {
        [0, 1].map(|axis| rule.interpolate(&self.acting.v()[axis], part))
    }

    /// `w` at a point.
    pub(super) fn speed(&self, point: usize) -> Pair {
        [0, 1].map(|axis| self.acting.v()[axis][point])
    }

    /// The push at a point.
    pub(super) fn push(&self, point: usize) -> Pair {
        pair(&self.acting.forces.push, point)
    }

    /// Loads at a point.
    pub(super) fn loads(&self, point: usize) -> Loads {
        between(&self.stretch.loads, Rule::get().points[point])
    }

    /// The direction of a slip at a point under a push. At rest, in which a slip begins and ends along the push,
    /// what is left of the velocity is rounding, and the force tells its direction; in straight motion it is that of the
    /// point beside it.
    pub(super) fn heading(&self, frame: &PlaneFrame<'_>, point: usize, push: Pair) -> Pair {
        let (w, Stretch { from_s, step_s, loads, pressed, .. }) =
            (self.speed(point), &self.stretch);
        let beside = self.speed(if point == 0 { 1 } else { point - 1 });
        if frame.wall().is_some() && *pressed {
            // Along a stop what is left of a velocity across it is rounding.
            let along = along_wall([0, 1].map(|axis| self.acting.x()[axis][point]));
            let way = [w, beside].map(|w| dot(along, w)).into_iter().find(|way| *way != 0.0);
            return times(along, way.unwrap_or(1.0).signum());
        }
        let under = (from_s + step_s, &loads[0], push);
        let is_end = point == 0 || point + 1 == POINTS;
        let faintest = ROUNDING[usize::from(is_end)] * self.quickest;
        if self.speeds[point] > faintest && !frame.has_turned_about([w, beside], under) {
            return times(w, 1.0 / self.speeds[point]);
        }
        let by_force = self.ends[usize::from(point > 0)].filter(|_| is_end);
        if let Some(along) = by_force.filter(|_| self.speeds[point] > 0.0) {
            return along;
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
        let speed = |t: f64| norm(self.speed_at(rule, t));
        let over = |from: f64, to: f64| {
            let nodes = rule.c.iter().zip(&rule.weights);
            (to - from) * nodes.map(|(c, b)| b * speed(from + (to - from) * c)).sum::<f64>()
        };
        let speeds = self.speeds;
        let inside: [f64; NODES] = core::array::from_fn(|i| speeds[1 + i]);
        let whole: f64 = rule.weights.iter().zip(&inside).map(|(b, r)| b * r).sum();
        let last = last_coefficients(&inside);
        // A corner beside an end shows in no coefficient, and none shows where a part ends beside it.
        let is_inside = |i: usize| i > 0 && i + 1 < POINTS;
        let is_low =
            |i: &usize| is_least(&speeds, *i) && (is_inside(*i) || speeds[*i] <= 0.1 * whole);
        let mut low = (0..POINTS).filter(is_low).peekable();
        if low.peek().is_none() && last[0].max(last[1]) <= 1e-7 * whole {
            return self.stretch.step_s * whole;
        }
        let least = |i: usize| rule.least_of((i, speeds[i] * speeds[i]), |t| speed(t) * speed(t)).0;
        let inner = |t: &f64| *t > 0.0 && *t < 1.0;
        let corners: Vec<f64> = low.map(least).filter(inner).collect();
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

    /// Raises the largest rate of each velocity by those at the points: what acts on a block that rests or slides.
    #[inline(always)]
    pub(super) fn raise_rates(&self, frame: &PlaneFrame<'_>, most: &mut [f64]) {
        let Acting { under, forces, floors, .. } = &self.acting;
        let (mut carried, w) = (under.a, self.acting.v());
        if self.slips {
            let mut moved = [[0.0; POINTS]; 2];
            for i in 0..POINTS {
                let (f, r) = (self.slowings[i], self.speeds[i]);
                let slowed = if r > 0.0 { f / r } else { 0.0 };
                let of = |axis: usize| forces.push[axis][i] - slowed * w[axis][i];
                let block = frame.body.moved([of(0), of(1)]);
                (0..2).for_each(|axis| moved[axis][i] = block[axis]);
            }
            for axis in 0..2 {
                most[axis] = moved[axis].iter().fold(most[axis], |most, rate| most.max(rate.abs()));
                add(&mut carried[axis], 1.0, &moved[axis]);
            }
        }
        for (part, most) in most[2..].iter_mut().enumerate() {
            let [x, y] = frame.along[part];
            let per_kg = 1.0 / frame.masses_kg[part];
            for i in 0..POINTS {
                let rate = floors[part][i] * per_kg + (x * carried[0][i] + y * carried[1][i]);
                *most = most.max(rate.abs());
            }
        }
    }

    /// What all of its friction makes of a velocity at most, in m/s.
    pub(super) fn pushes(&self) -> f64 {
        self.stretch.step_s * self.sharpest
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

/// What forces at the nodes of a step are asked for.
struct Asks {
    line: Option<SpeedLine>,
    /// `N` at the nodes, and of the spring that follows it the stiffness over the mass of the block.
    normal: [f64; NODES],
    kappa: [f64; NODES],
    /// The stop that is pressed.
    stop: Option<Ring>,
    /// What one that does not give way takes over the mass of the block, where it is known.
    borne: Pair,
    /// Where it is not known: the rate at which the block must not move across it.
    held_per_s: Option<f64>,
}

/// What is asked of the force at a node.
struct Asked {
    /// What it is off.
    left: Pair,
    /// How that grows with the force itself, and with `w` and `s`.
    own: [Pair; 2],
    bends: [[Pair; 2]; 2],
    /// The size of its terms.
    size: f64,
}

impl Asked {
    /// Where a stop does not give way what is known across it is not the force but that the block goes nowhere: `n·w = 0`.
    #[inline(always)]
    fn held(self, s: Pair, (w, r): (Pair, f64), per_s: f64) -> Self {
        let n = times(s, 1.0 / norm(s));
        let along = |v: Pair| [0, 1].map(|i| v[i] - dot(n, v) * n[i]);
        let rows = |of: [Pair; 2]| {
            let columns = [0, 1].map(|b| along([of[0][b], of[1][b]]));
            [0, 1].map(|a| [columns[0][a], columns[1][a]])
        };
        let mut bends = self.bends.map(rows);
        for (a, row) in bends[0].iter_mut().enumerate() {
            (0..2).for_each(|b| row[b] += per_s * n[a] * n[b]);
        }
        let (left, across) = (along(self.left), per_s * dot(n, w));
        let left = [0, 1].map(|i| left[i] - across * n[i]);
        Self { left, own: rows(self.own), bends, size: self.size.max(per_s * r) }
    }
}

/// Solves steps.
pub(super) struct Stepper<'a> {
    pub(super) frame: &'a PlaneFrame<'a>,
    pub(super) rule: &'static Rule,
    /// Where the block rests, and where it slides.
    linear: [Linear; 2],
    /// Within which a length is that of another step.
    instant_s: f64,
    pub(super) instructions: InstructionSet,
}

impl<'a> Stepper<'a> {
    /// For a motion with samples that are evenly spaced, or not.
    pub(super) fn new(frame: &'a PlaneFrame<'a>, sample_s: Option<f64>, end_s: f64) -> Self {
        let mut linear = [false, true].map(|slips| Linear::new(frame, slips));
        for linear in &mut linear {
            if let Some(sample_s) = sample_s {
                linear.keep(sample_s / linear.parts(sample_s));
            }
        }
        let instant_s = 4.0 * f64::EPSILON * end_s;
        Self { frame, rule: Rule::get(), linear, instant_s, instructions: InstructionSet::best() }
    }

    /// In how many parts a stretch is gone through in which nothing but what is linear bounds them.
    pub(super) fn parts(&self, length_s: f64, slips: bool) -> f64 {
        self.linear[usize::from(slips)].parts(length_s)
    }

    /// A step from a state; `None` where the iteration does not settle. A slip that starts from rest follows
    /// the push: `None` where that does not exceed friction.
    pub(super) fn solve(&self, from: &State, stretch: Stretch, slips: bool) -> Option<Box<Step>> {
        let (frame, d) = (self.frame, self.frame.degrees());
        let linear = &self.linear[usize::from(slips)];
        let length = (stretch.step_s, self.instant_s);
        let mut states = vec![[0.0; POINTS]; 2 * d];
        vectorize!(self.instructions, _simd => {
            linear.free([&from.x, &from.v], &stretch.loads, length, &mut states);
        });
        let mut forces = [[0.0; NODES]; 2];
        let is_forced = frame.curvature_per_m > 0.0
            || stretch.pressed
            || stretch.loads.iter().any(|loads| !frame.is_free(loads));
        if slips && is_forced {
            forces = self.guess(from, stretch)?;
            let of = |place: usize| core::array::from_fn(|j| states[place][1 + j]);
            let free = [[of(0), of(1)], [of(d), of(d + 1)]];
            let size = frame.largest_terms(&from.x, &from.v).max(self.stop_terms(from));
            let asks = self.asks(from, &stretch);
            let settled = linear.with_influence(length, |influence| {
                vectorize!(self.instructions, _simd => {
                    self.settle(&free, (&asks, size), influence, &mut forces)
                })
            });
            if !settled {
                return None;
            }
            vectorize!(self.instructions, _simd => {
                linear.add_forced(&forces, length, &mut states);
            });
        }
        Some(vectorize!(self.instructions, _simd => self.step(stretch, slips, states, &forces)))
    }

    /// The state at a part of a step, by a step that ends there: an end is known better than what lies between
    /// the points.
    pub(super) fn at(&self, step: &Step, part: f64) -> State {
        let start = step.state(0);
        if part == 0.0 {
            return start;
        }
        let stretch = step.stretch.part(0.0, part * step.stretch.step_s);
        match self.solve(&start, stretch, step.slips) {
            Some(part) => part.state(POINTS - 1),
            None => step.at(self.rule, part),
        }
    }

    /// Forces at the nodes to begin with: along the velocity at the start, or along the push of a block that would rest.
    fn guess(&self, from: &State, stretch: Stretch) -> Option<[[f64; NODES]; 2]> {
        let frame = self.frame;
        let under = |i: usize| between(&stretch.loads, self.rule.c[i]);
        let s = [from.x[0], from.x[1]];
        let stopped = frame.stopped(stretch.pressed, [s, from.speed()]);
        let force = |loads: &Loads, u: Pair, speed: f64, s: Pair| {
            let normal = loads[0].normal;
            let [f, _] = frame.slowing_on(stretch.line, (normal, speed));
            let kappa = self.stiffness(normal);
            [0, 1].map(|i| -f * u[i] - kappa * s[i] - stopped[i] / frame.block_kg)
        };
        if let Some(u) = unit(from.speed()) {
            let r = norm(from.speed());
            return Some(by_axis(|i| force(&under(i), u, r, s)));
        }
        if stretch.loads.iter().all(|loads| frame.is_free(loads)) {
            return Some(by_axis(|i| force(&under(i), [0.0; 2], 0.0, s)));
        }
        let step = self.solve(from, stretch, false)?;
        let (mut all, mut leaves) = ([[0.0; 2]; NODES], false);
        for (i, to) in all.iter_mut().enumerate() {
            let (push, loads) = (step.push(1 + i), step.loads(1 + i));
            let slowing = frame.slowing(&loads, 0.0);
            leaves |= norm(push) > slowing;
            *to = force(&loads, frame.body.departure(push, slowing)?, 0.0, s);
        }
        leaves.then(|| by_axis(|i| all[i]))
    }

    /// Of the spring that follows `N`, over the mass of the block.
    fn stiffness(&self, normal: f64) -> f64 {
        self.frame.curvature_per_m * normal / self.frame.block_kg
    }

    /// The size of the terms of what the stop does, over the mass of the block.
    fn stop_terms(&self, from: &State) -> f64 {
        let terms = self.frame.stop.filter(|_| from.pressed).map_or(0.0, |stop| {
            stop.stiffness * norm([from.x[0], from.x[1]]) + stop.damper * norm(from.speed())
        });
        terms / self.frame.block_kg
    }

    /// What a slip over a stretch is asked for from a state on.
    fn asks(&self, from: &State, stretch: &Stretch) -> Asks {
        let under = self.under(stretch);
        let normal: [f64; NODES] = core::array::from_fn(|i| under.normal[1 + i]);
        let stop = self.frame.stop.filter(|_| stretch.pressed);
        let is_wall = stop.is_some_and(|stop| stop.is_rigid);
        // Over a time that cannot be told what keeps the block on a stop is what did at its start.
        let is_brief = stretch.step_s <= 2.0 * self.instant_s;
        let borne = (is_wall && is_brief).then(|| self.frame.borne(from, &stretch.loads[0]));
        Asks {
            line: stretch.line,
            normal,
            kappa: normal.map(|normal| self.stiffness(normal)),
            stop,
            borne: borne.unwrap_or_default(),
            held_per_s: (is_wall && !is_brief).then(|| 1.0 / stretch.step_s),
        }
    }

    /// `a` and `N` at the points of a stretch.
    #[inline(always)]
    fn under(&self, stretch: &Stretch) -> Under<POINTS> {
        let column = |of: &dyn Fn(&Loads) -> f64| {
            let [from, to] = stretch.loads.each_ref().map(of);
            self.rule.points.map(|t| from + (to - from) * t)
        };
        Under {
            a: [column(&|loads| loads[0].a), column(&|loads| loads[1].a)],
            normal: column(&|loads| loads[0].normal),
            pressed: stretch.pressed,
        }
    }

    /// Iterates forces at the nodes from what `s` and `w` are there without them. Whether they settle.
    #[inline(always)]
    fn settle(
        &self,
        free: &[[[f64; NODES]; 2]; 2],
        (asks, terms): (&Asks, f64),
        influence: &Influence,
        forces: &mut [[f64; NODES]; 2],
    ) -> bool {
        let follows = self.frame.curvature_per_m > 0.0 || asks.stop.is_some();
        let (mut last, mut newton) = (f64::INFINITY, None);
        for pass in 0..MOST_PASSES {
            let (mut change, mut size) = (0.0_f64, terms);
            let (mut bends, mut off) = ([[[[0.0; 2]; 2]; 2]; NODES], [0.0; UNKNOWNS]);
            let mut own = [ONE; NODES];
            let w = moved(&influence.of_w, &free[1], forces);
            let s = if follows { moved(&influence.of_s, &free[0], forces) } else { free[0] };
            for j in 0..NODES {
                let at = [s, w, *forces].map(|of| [of[0][j], of[1][j]]);
                let asked = self.asked(asks, j, at);
                (own[j], bends[j], size) = (asked.own, asked.bends, size.max(asked.size));
                (0..2).for_each(|axis| off[2 * j + axis] = asked.left[axis]);
            }
            // A matrix is kept as long as a pass gains two digits by it.
            let kept = match newton.take() {
                Some(kept) => kept,
                None => match Newton::new(influence, (&own, &bends)) {
                    Some(new) => new,
                    None => return false,
                },
            };
            let steps = kept.solve(off);
            for (i, step) in steps.iter().enumerate() {
                change = change.max(step.abs());
                forces[i % 2][i / 2] += step;
            }
            if !change.is_finite() {
                return false;
            }
            // The next pass would change as much less as this one has.
            let next = if pass > 0 { change * (change / last) } else { change };
            let stalled = pass >= 6 && change >= 0.5 * last && change <= 1e-12 * size;
            if change.min(next) <= 2.0 * f64::EPSILON * size || stalled {
                return true;
            }
            newton = (change <= 1e-2 * if pass > 0 { last } else { size }).then_some(kept);
            last = change;
        }
        false
    }

    /// What is asked at a node where `s`, `w` and the force are known.
    #[inline(always)]
    fn asked(&self, asks: &Asks, j: usize, [s, w, now]: [Pair; 3]) -> Asked {
        let (frame, kappa) = (self.frame, asks.kappa[j]);
        let mut r = norm(w);
        // Along a stop that does not give way what is left of a velocity across it is rounding.
        let along_wall = asks.stop.filter(|stop| stop.is_rigid).map(|_| {
            let along = along_wall(s);
            let way = dot(along, w);
            r = way.abs();
            times(along, way.signum())
        });
        let [f, slope] = frame.slowing_on(asks.line, (asks.normal[j], r));
        let mut force = [0, 1].map(|i| -kappa * s[i] - asks.borne[i]);
        let mut bends = [[[0.0; 2]; 2], [[kappa, 0.0], [0.0, kappa]]];
        if f > 0.0 && r > 0.0 {
            let u = along_wall.unwrap_or([w[0] / r, w[1] / r]);
            force = [force[0] - f * u[0], force[1] - f * u[1]];
            let turns = if along_wall.is_none() { f / r } else { 0.0 };
            bends[0] = [0, 1].map(|a| {
                let across = |b: usize| if a == b { 1.0 } else { 0.0 } - u[a] * u[b];
                [0, 1].map(|b| turns * across(b) + slope * u[a] * u[b])
            });
        }
        if let Some(stop) = &asks.stop {
            let taken = stop.force(s, w);
            let by = stop.slopes(s, w);
            for axis in 0..2 {
                force[axis] -= taken[axis] / frame.block_kg;
                for (bend, by) in bends.iter_mut().zip(by) {
                    (0..2).for_each(|b| bend[axis][b] += by[axis][b] / frame.block_kg);
                }
            }
        }
        let left = [force[0] - now[0], force[1] - now[1]];
        let asked = Asked { left, own: ONE, bends, size: norm(force) };
        match asks.held_per_s {
            Some(per_s) => asked.held(s, (w, r), per_s),
            None => asked,
        }
    }

    /// The motion with forces at the nodes, and what acts at its points.
    #[inline(always)]
    fn step(
        &self,
        stretch: Stretch,
        slips: bool,
        states: Vec<Column<POINTS>>,
        forces: &[[f64; NODES]; 2],
    ) -> Box<Step> {
        let frame = self.frame;
        let acting = Acting::new(frame, states, self.under(&stretch));
        let w = acting.v();
        let speeds: [f64; POINTS] = core::array::from_fn(|i| norm([w[0][i], w[1][i]]));
        let [x, y] = forces;
        let sharpest = x.iter().zip(y).map(|(x, y)| norm([*x, *y])).fold(0.0, f64::max);
        let ends = [0, POINTS - 1].map(|point| {
            let kappa = self.stiffness(acting.under.normal[point]);
            let of = |axis: usize| extrapolated(&forces[axis], usize::from(point > 0));
            let stopped = pair(&acting.forces.stop, point);
            unit([0, 1].map(|axis| {
                -of(axis) - kappa * acting.x()[axis][point] - stopped[axis] / frame.block_kg
            }))
        });
        let mut tail = 0.0;
        if sharpest > 0.0 {
            let last = forces.each_ref().map(last_coefficients);
            tail = last.into_iter().flatten().fold(0.0, f64::max) / sharpest;
        }
        let quickest = speeds.iter().fold(0.0, |most: f64, speed| most.max(*speed));
        let normal = acting.under.normal;
        let slowings = core::array::from_fn(|i| frame.slowing_and_slope(normal[i], speeds[i])[0]);
        let headings = [[0.0; POINTS]; 2];
        let mut step = Box::new(Step {
            stretch,
            slips,
            acting,
            speeds,
            quickest,
            slowings,
            headings,
            ends,
            tail,
            sharpest,
        });
        for point in (0..POINTS).filter(|_| slips) {
            let along = step.heading(frame, point, step.push(point));
            (0..2).for_each(|axis| step.headings[axis][point] = along[axis]);
        }
        step
    }
}

/// The direction along a stop around the block at a place.
fn along_wall(s: Pair) -> Pair {
    times([-s[1], s[0]], 1.0 / norm(s))
}

/// A list of vectors at the nodes, axis by axis.
fn by_axis(of: impl Fn(usize) -> Pair) -> [[f64; NODES]; 2] {
    let all: [Pair; NODES] = core::array::from_fn(of);
    [0, 1].map(|axis| all.map(|vector| vector[axis]))
}

/// What moves without forces, and with them.
#[inline(always)]
fn moved(by: &Blocks, free: &[[f64; NODES]; 2], forces: &[[f64; NODES]; 2]) -> [[f64; NODES]; 2] {
    [0, 1].map(|a| {
        let mut sum = [0.0; NODES];
        for (of_axis, forces) in by[a].iter().zip(forces) {
            of_axis.iter().zip(forces).for_each(|(column, force)| add(&mut sum, *force, column));
        }
        core::array::from_fn(|j| free[a][j] + sum[j])
    })
}

/// The polynomial through values at the nodes, at the start or the end of a step.
fn extrapolated(values: &[f64; NODES], end: usize) -> f64 {
    static SHARES: LazyLock<[[f64; NODES]; 2]> =
        LazyLock::new(|| [0.0, 1.0].map(|t| core::array::from_fn(|k| Rule::get().lagrange(k, t))));
    SHARES[end].iter().zip(values).map(|(share, value)| share * value).sum()
}

/// Sizes of the last two of Legendre's coefficients of values at the nodes.
fn last_coefficients(values: &[f64; NODES]) -> [f64; 2] {
    static ROWS: LazyLock<[[f64; NODES]; 2]> = LazyLock::new(|| {
        let rule = Rule::get();
        [NODES - 2, NODES - 1].map(|k| {
            let of = |j: usize| rule.weights[j] * legendre(k, 2.0 * rule.c[j] - 1.0);
            core::array::from_fn(|j| (2 * k + 1) as f64 * of(j))
        })
    });
    ROWS.each_ref().map(|row| row.iter().zip(values).map(|(c, value)| c * value).sum::<f64>().abs())
}

/// The matrix of a pass, factored with row pivots.
struct Newton {
    rows: [[f64; UNKNOWNS]; UNKNOWNS],
    pivots: [usize; UNKNOWNS],
}

impl Newton {
    /// Of what is asked of the force itself at each node, and how it bends by `w` and by `s`; `None` where it is singular.
    #[inline(always)]
    fn new(
        influence: &Influence,
        (own, bends): (&[[Pair; 2]; NODES], &[[[Pair; 2]; 2]; NODES]),
    ) -> Option<Self> {
        let mut rows = [[0.0; UNKNOWNS]; UNKNOWNS];
        let (of_w, of_s) = (&influence.of_w, &influence.of_s);
        for (j, [by_w, by_s]) in bends.iter().enumerate() {
            let bends_by_s = *by_s != [[0.0; 2]; 2];
            for axis in 0..2 {
                let row = &mut rows[2 * j + axis];
                for i in 0..UNKNOWNS {
                    let (by, k) = (i % 2, i / 2);
                    let of = |bend: &[[f64; 2]; 2], of: &Blocks| {
                        bend[axis][0] * of[0][by][k][j] + bend[axis][1] * of[1][by][k][j]
                    };
                    row[i] = of(by_w, of_w);
                    if bends_by_s {
                        row[i] += of(by_s, of_s);
                    }
                }
                (0..2).for_each(|b| row[2 * j + b] += own[j][axis][b]);
            }
        }
        let mut pivots = [0; UNKNOWNS];
        for column in 0..UNKNOWNS {
            let larger = |a: usize, b: usize| {
                if rows[b][column].abs() > rows[a][column].abs() { b } else { a }
            };
            let pivot = (column..UNKNOWNS).reduce(larger)?;
            if rows[pivot][column] == 0.0 {
                return None;
            }
            pivots[column] = pivot;
            rows.swap(column, pivot);
            let own = rows[column];
            for row in &mut rows[column + 1..] {
                let factor = row[column] / own[column];
                row[column] = factor;
                if factor != 0.0 {
                    for (value, own) in row[column + 1..].iter_mut().zip(&own[column + 1..]) {
                        *value -= factor * own;
                    }
                }
            }
        }
        Some(Self { rows, pivots })
    }

    /// What takes away what is off.
    #[inline(always)]
    fn solve(&self, mut off: [f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
        for (column, pivot) in self.pivots.iter().enumerate() {
            off.swap(column, *pivot);
        }
        for i in 0..UNKNOWNS {
            let known: f64 = self.rows[i][..i].iter().zip(&off).map(|(l, x)| l * x).sum();
            off[i] -= known;
        }
        for i in (0..UNKNOWNS).rev() {
            let row = &self.rows[i];
            let known: f64 = row[i + 1..].iter().zip(&off[i + 1..]).map(|(u, x)| u * x).sum();
            off[i] = (off[i] - known) / row[i];
        }
        off
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
