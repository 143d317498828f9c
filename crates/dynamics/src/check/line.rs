//! What is judged in one horizontal direction: from the state stored at a knot the equations of motion are solved to the
//! next, in physical coordinates, and compared with what is stored there.

mod decisions;
mod equations;
mod interval;
mod knots;
mod step;

use self::equations::LineEquations;
use self::interval::LinePath;
use self::knots::lists_of;
use self::step::LineStepper;
use super::demands::{self, Comparison, Recomputed, Rounding};
use super::energy::EnergyBalance;
use super::judge::{Directions, Judge, JudgeInput, Run};
use super::structure::{Phase, Structure, excess, larger};
use super::{ClosestCall, DecisionKind};
use crate::error::Stopped;
use crate::response::Mode;
use crate::slider::Direction;

/// What a judgement in one direction needs besides.
pub(super) struct Line<'a> {
    stepper: LineStepper<'a>,
    /// Largest sizes of the outputs.
    attained: Vec<f64>,
    /// Upper bounds on the fastest rate where the block sticks, slides, and slides against a stop, in 1/s.
    rates: [f64; 3],
    /// Step of most intervals of the motion.
    even_s: f64,
}

impl<'a> Judge<'a, Line<'a>> {
    /// A judgement of a motion in one direction.
    pub(super) fn of_line(given: JudgeInput<'a>, structure: &'a Structure) -> Self {
        let slides = given.model.initial().sliding_velocity_m_per_s != 0.0;
        let (times_s, outputs) = (given.motion.times_s(), given.outputs);
        let slope = given.model.slope_m_per_s2();
        let equations = LineEquations { structure, law: given.law, slope };
        let line = Line {
            stepper: LineStepper::new(equations, outputs),
            attained: vec![0.0; outputs.len()],
            rates: [0.0; 3],
            even_s: f64::NAN,
        };
        let mut judge = Self::new(given, slides, line);
        let (h, law) = (judge.h, judge.law);
        let relative = || {
            let pairs = h.block_acceleration_m_per_s2.iter().zip(&h.table_acceleration_m_per_s2);
            pairs.fold(0.0, |most, (block, table)| (block - table).abs().max(most))
        };
        let relative = if law.rate.is_some() { relative() } else { 0.0 };
        let added = law.added_rate(judge.largest.0 / structure.block_kg, relative);
        let rate = |phase| structure.rate(phase) + if phase == Phase::Stick { 0.0 } else { added };
        judge.axes.rates = [Phase::Stick, Phase::Slip, Phase::Pressed].map(rate);
        judge.axes.even_s = common_step(times_s, 2.0 * judge.instant_s);
        judge
    }

    fn structure(&self) -> &'a Structure {
        self.axes.stepper.equations.structure
    }

    /// What the rounding of times makes of a position at this speed, and of the force of the stop.
    fn slack(&self, w: f64) -> [f64; 2] {
        let slack_m = self.instant_s * w.abs() + 8.0 * f64::EPSILON * self.figures.displacement[1];
        [slack_m, self.structure().stop_damper() * self.velocity_rounding]
    }

    /// Whether an interface could stick where it slides, without slowing down to it smoothly.
    fn drops(&self, i: usize, direction: Direction) -> bool {
        match i.checked_sub(1).map(|e| &self.structure().contents[e]) {
            None => self.law.drops(direction),
            Some(contents) => contents.static_friction > contents.kinetic_friction,
        }
    }

    /// Raises the peaks by the outputs at the first or the last knot, where no interval tells those that
    /// are not stored.
    fn peaks_at_jump(&mut self, k: usize) {
        let load = self.ground.instant(self.h.time_s[k])[if k == 0 { 1 } else { 2 }];
        let (drive, [x, v]) = self.at_knot(k, self.h.modes(k), &load);
        let values = self.axes.stepper.outputs_at(&drive, [&x, &v]);
        for (peak, value) in self.axes.attained.iter_mut().zip(values) {
            *peak = larger(*peak, value);
        }
    }
}

impl<'a> Directions for Judge<'a, Line<'a>> {
    fn degrees(&self) -> usize {
        self.structure().degrees()
    }

    fn stored(&self, k: usize, degree: usize) -> [f64; 2] {
        let (lists, [stride, i]) = lists_of(self.h, degree);
        lists.map(|list| list[k * stride + i])
    }

    fn initial(&self, degree: usize) -> [f64; 2] {
        let (model, initial) = (self.model, self.model.initial());
        let Some(storey) = degree.checked_sub(1) else {
            return [initial.sliding_displacement_m, initial.sliding_velocity_m_per_s];
        };
        let storeys =
            [model.initial_storey_displacement_m(), model.initial_storey_velocity_m_per_s()];
        storeys.map(|list| list.get(storey).copied().unwrap_or(0.0))
    }

    fn speed_at(&self, k: usize, interface: usize) -> f64 {
        self.stored(k, self.structure().degree_of(interface))[1]
    }

    fn measure(&mut self) -> Result<bool, Stopped> {
        let h = self.h;
        let Some(energies) = self.look_at_knots()? else { return Ok(false) };
        if self.model.stop().is_some() {
            for k in 0..h.len() {
                let at = (h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]);
                let broken = self.law.contact_excess(self.contact(k), at, self.slack(at.1));
                self.figures.excess = larger(self.figures.excess, broken);
                let beyond = self.law.beyond_walls(at.0);
                self.figures.displacement[0] = larger(self.figures.displacement[0], beyond);
            }
        }
        // Surfaces in series make up s, within their travels.
        for k in 0..if h.surfaces > 0 { h.len() } else { 0 } {
            let surfaces = h.surface_displacements(k);
            let off = surfaces.iter().sum::<f64>() - h.sliding_displacement_m[k];
            for off in [off, self.law.beyond_ends(surfaces)] {
                self.figures.displacement[0] = larger(self.figures.displacement[0], off);
            }
        }
        let stop_j = self.law.push(self.contact(0)).strain(h.sliding_displacement_m[0]);
        self.books =
            EnergyBalance::new(energies, stop_j, [self.ground.has_vertical(), self.law.follows()]);
        Ok(true)
    }

    fn decide(&mut self, changes: &[usize]) {
        self.judge_changes(changes);
    }

    fn go_through(&mut self, run: Run) -> Result<(), Stopped> {
        let mut path = LinePath::new(self.structure(), self.outputs.len());
        for k in run.from..run.to {
            self.interval(k, &mut path)?;
            for (i, _) in self.h.modes(k).iter().enumerate().filter(|(_, m)| **m != Mode::Stick) {
                // Without contact a slip may turn back.
                let at = self.structure().degree_of(i);
                let [[start, _], [end, _]] = [k, k + 1].map(|k| self.stored(k, at));
                self.totals.interfaces[i].path_m += (end - start).abs();
            }
            if self.h.surfaces > 0 {
                self.surfaces(k);
            }
        }
        Ok(())
    }

    /// By the load that suits it best.
    fn isolated_knot(&mut self, k: usize) {
        let h = self.h;
        let in_force = self.in_force(k, h.modes(k));
        let (place, w) = (h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]);
        let (mut table, mut force) = (f64::INFINITY, f64::INFINITY);
        for load in self.ground.instant(h.time_s[k]) {
            let off = (load.table - h.table_acceleration_m_per_s2[k]).abs();
            table = table.min((off - self.instant_s * load.slope.abs()).max(0.0));
            let off = match h.modes(k)[0] {
                Mode::Stick => 0.0,
                Mode::Slip(_) => {
                    let drive = self.drive(&in_force, &[load; 2], None);
                    let own = self.axes.stepper.equations.stored_sliding(&drive, 0, [place, w]);
                    (h.friction_force_n[k] - own).abs()
                }
            };
            let rounding = self.law.most() * self.pressed_rounding(&load);
            force = force.min(excess(off - rounding));
        }
        self.figures.table[0] = larger(self.figures.table[0], table);
        self.figures.excess = larger(self.figures.excess, force);
        if k == 0 || k + 1 == h.len() {
            self.peaks_at_jump(k);
        }
    }

    fn at_same_time(&mut self, k: usize) -> bool {
        let h = self.h;
        let struck = self.strikes(k);
        if struck {
            self.books.damping[k - 1] = self.lost_in_impact(k);
        } else {
            for i in 0..self.structure().degrees() {
                self.compare(k, i, self.stored(k - 1, i), [0.0; 2]);
            }
        }
        let surfaces = h.surface_displacements(k).iter().zip(h.surface_displacements(k - 1));
        for (a, b) in surfaces {
            let f = &mut self.figures.displacement[0];
            *f = larger(*f, a - b);
        }
        struck
    }

    fn leans(&self, k: usize) -> bool {
        self.law.bears_on_stop(self.h.sliding_displacement_m[k]) != [false; 2]
    }

    fn closest_call_of_slip(&mut self, i: usize, direction: Direction) -> Option<ClosestCall> {
        if self.drops(i, direction) { self.dips[i].least(DecisionKind::Slip, i) } else { None }
    }

    fn compare_demands(&self, c: &mut Comparison, rounding: &Rounding) {
        let (h, attained) = (self.h, &self.axes.attained);
        let sliding_m = demands::extremes(h.sliding_displacement_m.iter().copied());
        let own = Recomputed {
            outputs: self.outputs,
            sliding_m,
            scale_m: sliding_m[0],
            peaks: attained,
            possible: attained,
            scales: attained,
            totals: &self.totals,
            events: &self.events,
            gap_m: self.model.slider().gap_m(),
            width_m: self.model.block().width_m,
            corner: None,
        };
        demands::of_motion(c, (self.model, self.response, h), &own, rounding);
        demands::of_peak_time(c, &self.response.demands, h, sliding_m[0], rounding);
    }
}

/// The length that more than half of the intervals between these times have, to within `same_s`; NaN
/// where there is none.
fn common_step(times_s: &[f64], same_s: f64) -> f64 {
    let lengths = || times_s.windows(2).map(|pair| pair[1] - pair[0]);
    let same = |a: f64, b: f64| (a - b).abs() <= same_s;
    // Boyer and Moore's majority vote: pairs of unlike lengths cancel.
    let (mut step_s, mut votes) = (f64::NAN, 0_usize);
    for length_s in lengths() {
        if votes == 0 {
            step_s = length_s;
        }
        if same(length_s, step_s) {
            votes += 1;
        } else {
            votes -= 1;
        }
    }
    let count = lengths().filter(|length_s| same(*length_s, step_s)).count();
    if step_s > 0.0 && 2 * count > times_s.len() - 1 { step_s } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::super::law::Law;
    use super::super::outputs::Outputs;
    use super::*;
    use crate::model::{Block, Damping, Frame, InitialState, Model, Slider};
    use crate::motion::GroundMotion;
    use crate::numerics::InstructionSet;
    use crate::progress::{NEVER_CANCELLED, Pulse};
    use crate::response::{Demands, History, Method, Response};
    use crate::slider::Friction;

    /// A motion that is none of the model's, with its figures of every size, under a motion of so many
    /// samples that does not end at 0, and a tail.
    fn wrong(n: usize, samples: usize, tail_s: f64) -> (Model, GroundMotion, Response) {
        let friction = Friction::new(0.1, 0.08).unwrap();
        let rigid = Model::rigid_block(300.0, friction.clone()).unwrap();
        let frame = Frame {
            masses_kg: vec![200.0; n],
            stiffnesses_n_per_m: vec![4e4; n],
            damping: Damping::Ratio(0.02),
            heights_m: Some(vec![3.0; n]),
        };
        let slider = Slider::sprung(friction, 5e3);
        let block = Block { width_m: Some(1.0), ..*rigid.block() };
        let model = Model::new(block, slider, frame, 9.81, InitialState::rest()).unwrap();
        let wave = |k: usize, rate: f64| libm::sin(rate * k as f64);
        let motion = (0..samples).map(|k| 2.0 * wave(k, 0.3)).collect();
        let motion = GroundMotion::evenly_spaced(0.01, motion, None).unwrap();
        let motion = motion.with_tail(tail_s).unwrap();
        let mut h = History { storeys: n, ..History::default() };
        for k in 0..motion.len() {
            h.time_s.push(motion.times_s()[k]);
            h.mode.push(match k / 11 % 3 {
                0 => Mode::Stick,
                1 => Mode::Slip(Direction::Positive),
                _ => Mode::Slip(Direction::Negative),
            });
            h.table_acceleration_m_per_s2.push(motion.horizontal_m_per_s2()[k]);
            h.sliding_displacement_m.push(0.01 * wave(k, 0.2));
            h.sliding_velocity_m_per_s.push(0.2 * wave(k, 0.25));
            h.block_acceleration_m_per_s2.push(wave(k, 0.37));
            h.friction_force_n.push(200.0 * wave(k, 0.31));
            for i in 0..n {
                h.storey_displacement_m.push(0.01 * wave(k + i, 0.21));
                h.storey_velocity_m_per_s.push(0.1 * wave(k + i, 0.23));
                h.storey_acceleration_m_per_s2.push(wave(k + i, 0.29));
            }
        }
        let response = Response {
            method: Method::Exact,
            demands: Demands::default(),
            events: Vec::new(),
            history: Some(h),
            contact_loss_s: Vec::new(),
            iterations: None,
            warnings: Vec::new(),
            in_plane: None,
        };
        (model, motion, response)
    }

    fn given<'a>(
        (model, motion, response): (&'a Model, &'a GroundMotion, &'a Response),
        (law, outputs): (&'a Law, &'a Outputs),
    ) -> JudgeInput<'a> {
        let history = response.history.as_ref().unwrap();
        JudgeInput {
            model,
            motion,
            response,
            history,
            law,
            outputs,
            pulse: Pulse::new(NEVER_CANCELLED),
        }
    }

    #[test]
    fn step_of_most_intervals_is_common() {
        assert_eq!(common_step(&[0.0, 1.0, 2.0, 2.0, 3.0, 9.0], 0.0), 1.0);
        assert_eq!(common_step(&[0.0, 5.0, 6.0, 6.5, 7.5, 8.5, 9.5], 0.0), 1.0);
        assert!(common_step(&[0.0, 1.0, 2.0, 4.0, 6.0], 0.0).is_nan());
        assert!(common_step(&[0.0, 0.0], 0.0).is_nan());
    }

    #[test]
    fn same_bits_by_every_instruction_set() {
        for n in [0, 1, 3] {
            let (model, motion, response) = wrong(n, 99, 0.0);
            let structure = Structure::new(&model, false);
            let of = |instructions| {
                let (law, outputs) = (Law::new(&model, false), Outputs::new(&model));
                let given = given((&model, &motion, &response), (&law, &outputs));
                let mut judge = Judge::of_line(given, &structure);
                judge.axes.stepper.instructions = instructions;
                judge.run(1e-10).unwrap().unwrap()
            };
            let first = of(InstructionSet::best());
            assert!(first.equilibrium_residual > 0.01 && first.equilibrium_residual.is_finite());
            for set in InstructionSet::all() {
                assert_eq!(of(set), first, "{n} storeys, {set:?}");
            }
        }
    }
}
