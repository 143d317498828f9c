//! One step of the motion in one direction: the collocation equations iterated, or the linear map that they are.
//!
//! Where friction does not follow the speed and nothing that multiplies the state varies, `ẍ` at the nodes of a step is
//! a linear map of the state at its start and of the loads at both ends. For the step that comes again and again that map
//! is made once, from the steps of unit inputs.

use super::super::collocation::{Column, MOST_PASSES, NODES, POINTS, ROUNDING, Rule, add, most};
use super::super::ground::Load;
use super::super::outputs::Outputs;
use super::super::structure::Structure;
use super::equations::{Drive, LineEquations, LineForces, TABLE, linear};
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;

/// Most maps that are kept.
const MOST_MAPS: usize = 16;

/// A stretch of time under linear loads.
pub(super) struct LineStretch {
    pub(super) from_s: f64,
    pub(super) step_s: f64,
    pub(super) loads: [Load; 2],
}

/// The motion in a step: what moves and acts at the points of the rule, polynomials between them.
pub(super) struct LineStep {
    /// Displacements and velocities, of which the first point is the start.
    pub(super) x: Vec<Column<POINTS>>,
    pub(super) v: Vec<Column<POINTS>>,
    pub(super) acting: LineForces<POINTS>,
    pub(super) outputs: Vec<Column<POINTS>>,
}

impl LineStep {
    pub(super) fn new(structure: &Structure, outputs: usize) -> Self {
        let zeros = |count: usize| vec![[0.0; POINTS]; count];
        let d = structure.degrees();
        Self {
            x: zeros(d),
            v: zeros(d),
            acting: LineForces::new(structure),
            outputs: zeros(outputs),
        }
    }

    /// The next step starts where this one has ended.
    pub(super) fn go_on(&mut self) {
        for column in self.x.iter_mut().chain(&mut self.v) {
            column[0] = column[POINTS - 1];
        }
    }
}

/// The map of a step from its inputs, `x` and `v` at the start and loads at both ends, to `ẍ` at the nodes.
struct StepMap {
    /// What is in force in its steps, and their length.
    stuck: Vec<bool>,
    stop: [f64; 2],
    rise: f64,
    drag: f64,
    step_s: f64,
    /// Inputs that anything follows, and what a unit of each does to every degree.
    inputs: Vec<(usize, Vec<Column<NODES>>)>,
}

impl StepMap {
    fn is_of(&self, drive: &Drive<'_>, step_s: f64) -> bool {
        let stuck = |(i, stuck): (usize, &bool)| drive.sticks(i) == *stuck;
        self.step_s == step_s
            && self.stop == drive.stop
            && self.rise == drive.rise[0]
            && self.drag == drive.drag
            && self.stuck.iter().enumerate().all(stuck)
    }
}

/// The iteration under way: states at the nodes, what acts there, and `ẍ`.
struct Nodes {
    x: Vec<Column<NODES>>,
    v: Vec<Column<NODES>>,
    acting: LineForces<NODES>,
    rates: Vec<Column<NODES>>,
}

/// Solves steps.
pub(super) struct LineStepper<'a> {
    pub(super) equations: LineEquations<'a>,
    pub(super) rule: &'static Rule,
    outputs: &'a Outputs,
    maps: Vec<StepMap>,
    nodes: Nodes,
    pub(super) instructions: InstructionSet,
}

impl<'a> LineStepper<'a> {
    pub(super) fn new(equations: LineEquations<'a>, outputs: &'a Outputs) -> Self {
        let structure = equations.structure;
        let zeros = || vec![[0.0; NODES]; structure.degrees()];
        Self {
            equations,
            rule: Rule::get(),
            outputs,
            maps: Vec::new(),
            nodes: Nodes {
                x: zeros(),
                v: zeros(),
                acting: LineForces::new(structure),
                rates: zeros(),
            },
            instructions: InstructionSet::best(),
        }
    }

    /// The motion in a step of a length from what is at its start; `usual_s` is the length of the steps that come again, if it
    /// is one of these to within the rounding of times.
    pub(super) fn step(
        &mut self,
        drive: &Drive<'_>,
        (step_s, usual_s): (f64, Option<f64>),
        to: &mut LineStep,
    ) {
        let map = usual_s.and_then(|usual_s| self.map(drive, usual_s));
        vectorize!(self.instructions, _simd => {
            match map {
                Some(map) => self.apply(map, drive, to),
                None => self.solve(drive, step_s, to),
            }
            self.tell(drive, step_s, to);
        });
    }

    /// All that acts in a state at an instant.
    pub(super) fn instant(&self, drive: &Drive<'_>, [x, v]: [&[f64]; 2]) -> LineForces<1> {
        let mut acting = LineForces::new(self.equations.structure);
        let states = [x, v].map(|list| list.as_chunks().0);
        self.equations.act(drive, &[0.0], states, &mut acting);
        acting
    }

    /// All outputs in a state at an instant.
    pub(super) fn outputs_at(&self, drive: &Drive<'_>, [x, v]: [&[f64]; 2]) -> Vec<f64> {
        let mut out = vec![[0.0]; self.outputs.len()];
        let acting = self.instant(drive, [x, v]);
        let states = [x, v].map(|list| list.as_chunks().0);
        self.equations.outputs(self.outputs, (drive, &[0.0]), states, &acting, &mut out);
        out.into_iter().flatten().collect()
    }

    /// The place of the map of a step, which is made where there is room.
    fn map(&mut self, drive: &Drive<'_>, step_s: f64) -> Option<usize> {
        let follows_pressure = self.equations.law.follows_pressure();
        if drive.by_speed || follows_pressure || drive.rise[0] != drive.rise[1] {
            return None;
        }
        let known = self.maps.iter().position(|map| map.is_of(drive, step_s));
        if known.is_none() && self.maps.len() < MOST_MAPS {
            let map = self.unit_steps(drive, step_s);
            self.maps.push(map);
            return Some(self.maps.len() - 1);
        }
        known
    }

    /// Makes the map of a step from unit inputs.
    fn unit_steps(&mut self, drive: &Drive<'_>, step_s: f64) -> StepMap {
        let (structure, loads) = (self.equations.structure, self.equations.loads());
        let d = structure.degrees();
        // What sticks has no velocity.
        let stuck: Vec<bool> = (0..drive.modes.len()).map(|i| drive.sticks(i)).collect();
        let rests = |input: usize| {
            (0..stuck.len()).any(|i| stuck[i] && input == d + structure.degree_of(i))
        };
        let mut one = LineStep::new(structure, 0);
        let mut inputs = Vec::new();
        for input in (0..2 * d + 2 * loads).filter(|input| !rests(*input)) {
            let mut drive = Drive { loads: vec![[0.0; 2]; loads], ..drive.clone() };
            (0..d).for_each(|k| (one.x[k][0], one.v[k][0]) = (0.0, 0.0));
            match input.checked_sub(2 * d) {
                Some(load) => drive.loads[load / 2][load % 2] = 1.0,
                None if input < d => one.x[input][0] = 1.0,
                None => one.v[input - d][0] = 1.0,
            }
            vectorize!(self.instructions, _simd => self.solve(&drive, step_s, &one));
            if self.nodes.rates.iter().flatten().any(|rate| *rate != 0.0) {
                inputs.push((input, self.nodes.rates.clone()));
            }
        }
        let (rise, drag) = (drive.rise[0], drive.drag);
        StepMap { stuck, stop: drive.stop, rise, drag, step_s, inputs }
    }

    /// Finds `ẍ` at the nodes by a map.
    #[inline(always)]
    fn apply(&mut self, map: usize, drive: &Drive<'_>, from: &LineStep) {
        let (rates, d) = (&mut self.nodes.rates, from.x.len());
        rates.fill([0.0; NODES]);
        for (input, factors) in &self.maps[map].inputs {
            let value = match input.checked_sub(2 * d) {
                Some(load) => drive.loads[load / 2][load % 2],
                None if *input < d => from.x[*input][0],
                None => from.v[*input - d][0],
            };
            rates.iter_mut().zip(factors).for_each(|(rates, factor)| add(rates, value, factor));
        }
    }

    /// Finds `ẍ` at the nodes by iteration.
    #[inline(always)]
    fn solve(&mut self, drive: &Drive<'_>, h: f64, from: &LineStep) {
        let Self { equations, rule, nodes: Nodes { x, v, acting, rates }, .. } = self;
        let a = linear(drive.loads[TABLE], &rule.c);
        let rounding = if drive.by_speed { ROUNDING } else { f64::INFINITY };
        rates.fill([0.0; NODES]);
        let mut last = f64::INFINITY;
        for pass in 0..MOST_PASSES {
            for (k, rates) in rates.iter().enumerate() {
                [x[k], v[k]] = rule.inside(h, [from.x[k][0], from.v[k][0]], rates);
            }
            equations.act(drive, &rule.c, [x, v], acting);
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for (k, rates) in rates.iter_mut().enumerate() {
                let found = equations.rate(k, &a, &acting.bodies);
                add(rates, -1.0, &found);
                (change, size) = (change.max(most(rates)), size.max(most(&found)));
                *rates = found;
            }
            // The next pass would gain as much as this one.
            let gains = pass > 0 && change * change <= 0.5 * f64::EPSILON * size * last;
            let small = change <= 2.0 * f64::EPSILON * size || gains;
            let stalled = pass >= 8 && change >= 0.5 * last && change <= rounding * size;
            if small || stalled {
                break;
            }
            last = change;
        }
    }

    /// The motion at the points of a step from `ẍ` at its nodes, what acts there, and the outputs.
    #[inline(always)]
    fn tell(&self, drive: &Drive<'_>, h: f64, to: &mut LineStep) {
        let Self { equations, rule, nodes, .. } = self;
        let LineStep { x, v, acting, outputs } = to;
        for (k, rates) in nodes.rates.iter().enumerate() {
            let start = [x[k][0], v[k][0]];
            let (inside, end) = (rule.inside(h, start, rates), rule.end(h, start, rates));
            for (i, column) in [&mut x[k], &mut v[k]].into_iter().enumerate() {
                column[1..=NODES].copy_from_slice(&inside[i]);
                column[POINTS - 1] = end[i];
            }
        }
        let (at, states) = ((drive, &rule.points), [&x[..], &v[..]]);
        equations.act(drive, at.1, states, acting);
        equations.outputs(self.outputs, at, states, acting, outputs);
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::law::Law;
    use super::super::super::structure::Phase;
    use super::*;
    use crate::model::{Block, Damping, Frame, InitialState, Model, Slider};
    use crate::response::Mode;
    use crate::slider::{Direction, Friction};

    #[test]
    fn a_kept_map_is_the_iteration_of_its_step() {
        for (n, damping) in [
            (0, Damping::Ratio(0.0)),
            (1, Damping::Ratio(0.05)),
            (4, Damping::Ratio(0.05)),
            (4, Damping::Dampers(vec![90.0; 4])),
        ] {
            let frame = Frame {
                masses_kg: vec![200.0; n],
                stiffnesses_n_per_m: (0..n).map(|i| 4e4 - 5e3 * i as f64).collect(),
                damping,
                heights_m: None,
            };
            let slider = Slider::sprung(Friction::new(0.1, 0.08).unwrap(), 5e3);
            let block = Block { mass_kg: 300.0, width_m: None, height_m: None };
            let model = Model::new(block, slider, frame, 9.81, InitialState::rest()).unwrap();
            let (structure, law) = (Structure::new(&model, false), Law::new(&model, false));
            let outputs = Outputs::new(&model);
            let equations = LineEquations { structure: &structure, law: &law, slope: 0.0 };
            let step_s = 0.5 / structure.rate(Phase::Slip);
            for mode in [Mode::Stick, Mode::Slip(Direction::Positive)] {
                let drive = Drive {
                    modes: &[mode],
                    loads: vec![[1.3, 0.2], [-40.0, -70.0], [3.0; 2]],
                    stop: [700.0, 20.0],
                    rise: [90.0; 2],
                    drag: 6.0,
                    by_speed: false,
                    normal: [0.0; 2],
                    friction: 0.0,
                    taken: [0.0; 2],
                };
                let [mapped, solved] = [Some(step_s), None].map(|usual_s| {
                    let mut step = LineStep::new(&structure, outputs.len());
                    for (i, column) in step.x.iter_mut().chain(&mut step.v).enumerate() {
                        column[0] = libm::sin((1 + i * i) as f64);
                    }
                    if mode == Mode::Stick {
                        step.v[0][0] = 0.0;
                    }
                    let mut stepper = LineStepper::new(equations, &outputs);
                    stepper.step(&drive, (step_s, usual_s), &mut step);
                    assert_eq!(stepper.maps.len(), usize::from(usual_s.is_some()));
                    step
                });
                let lists =
                    |step: &LineStep| [step.x.clone(), step.v.clone(), step.outputs.clone()];
                for (mapped, solved) in lists(&mapped).iter().zip(&lists(&solved)) {
                    let largest = solved.iter().map(most).fold(0.0, f64::max);
                    for (a, b) in mapped.iter().flatten().zip(solved.iter().flatten()) {
                        // Some rounding of what is added up.
                        assert!((a - b).abs() <= 1e-13 * largest, "{n} storeys, {mode:?}: {a} {b}");
                    }
                }
            }
        }
    }
}
