//! What is judged in one horizontal direction: intervals do not depend on each other and go side by side.

mod courses;
mod decisions;
mod equations;
mod group;
mod intervals;
mod knots;
mod maps;
mod margins;
mod order;
mod path;
mod peaks;
mod stored;
mod sweep;
mod watch;
mod work;

use self::knots::{Acting, Knots, LaneJudge, Worst, lists_of};
use self::watch::Watched;
use super::collocation::Rule;
use super::demands::{self, Comparison, Recomputed, Rounding};
use super::energy::Books;
use super::judge::{Directions, Judge, JudgeInput, Run, Sizes};
use super::structure::{Phase, Structure, excess, larger};
use super::{ClosestCall, DecisionKind};
use crate::error::Stopped;
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;
use crate::progress::{Pulse, UNWATCHED};
use crate::response::Mode;
use crate::response::output::{BLOCK, VELOCITY};
use crate::slider::Direction;

/// What a judgement in one direction needs besides.
pub(super) struct Line<'a> {
    structure: &'a Structure,
    /// Largest sizes of the outputs.
    attained: Vec<f64>,
    rates: [f64; 3],
    knots: Knots,
    watched: Watched,
    /// Knots at which the phases under way have begun, by interface.
    since: Vec<usize>,
    /// A margin that the closest call has at most.
    floor: f64,
    /// Step of most intervals of the motion.
    even_s: f64,
    longest_s: f64,
    /// Intervals that were swept.
    #[cfg(test)]
    swept: usize,
    instructions: InstructionSet,
}

impl<'a> Judge<'a, Line<'a>> {
    /// A judgement of a motion in one direction.
    pub(super) fn of_line(given: JudgeInput<'a>, structure: &'a Structure) -> Self {
        let slides = given.model.initial().sliding_velocity_m_per_s != 0.0;
        let times_s = given.motion.times_s();
        let line = Line {
            structure,
            attained: Vec::new(),
            rates: [0.0; 3],
            knots: Knots::default(),
            watched: Watched::default(),
            since: vec![0; given.history.interfaces],
            floor: f64::INFINITY,
            even_s: f64::NAN,
            longest_s: given.history.time_s.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max),
            #[cfg(test)]
            swept: 0,
            instructions: InstructionSet::best(),
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

    /// What the lanes need.
    fn bench(&self) -> LaneJudge<'a> {
        LaneJudge {
            structure: self.axes.structure,
            rule: Rule::get(),
            history: self.h,
            law: self.law,
            slope: self.model.slope_m_per_s2(),
            instant_s: self.instant_s,
            vertical: self.ground.has_vertical(),
            instructions: self.axes.instructions,
        }
    }

    /// What the rounding of times makes of a position at this speed, and of the force of the stop.
    fn slack(&self, w: f64) -> [f64; 2] {
        let slack_m = self.instant_s * w.abs() + 8.0 * f64::EPSILON * self.figures.displacement[1];
        [slack_m, self.axes.structure.stop_damper() * self.jolt]
    }
}

impl<'a> Directions for Judge<'a, Line<'a>> {
    fn degrees(&self) -> usize {
        self.axes.structure.degrees()
    }

    fn stored(&self, k: usize, degree: usize) -> [f64; 2] {
        let (lists, [stride, i]) = lists_of(self.h, self.h.storeys, degree);
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
        self.stored(k, self.axes.structure.degree_of(interface))[1]
    }

    fn measure(&mut self) -> Result<bool, Stopped> {
        let h = self.h;
        let (mut stop, mut held) = (Vec::new(), Vec::new());
        if self.model.stop().is_some() && self.law.restitution().is_none() {
            let at = |k: usize| (h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]);
            let force = |k: usize| self.law.push(self.contact(k)).force(at(k).0, at(k).1);
            stop.extend((0..h.len()).map(force));
        }
        if self.law.is_pendulum() {
            held = vec![1.0; h.len()];
        } else if self.law.restitution().is_some() {
            // Sliding, the block has left the stop or not yet struck it.
            let leans = |k: usize| {
                let s = h.sliding_displacement_m[k];
                h.modes(k)[0] == Mode::Stick && self.law.leans(s) != [false; 2]
            };
            held.extend((0..h.len()).map(|k| if leans(k) { 1.0 } else { 0.0 }));
        }
        // At the start and at the end both sides of a jump last.
        let passed = |k: &usize| h.time_s[k + 1] == h.time_s[*k] && h.time_s[k - 1] == h.time_s[*k];
        let passed: Vec<usize> = (1..h.len().saturating_sub(1)).filter(passed).collect();
        let mut worst = Worst::default();
        let degrees = [self.axes.structure.degrees(), h.storeys];
        let mut knots = Knots::new(h.len(), self.outputs.len(), degrees);
        let mut pulse = core::mem::replace(&mut self.pulse, Pulse::new(UNWATCHED));
        let (bench, outputs) = (self.bench(), self.outputs);
        let acting = Acting { stop: &stop, held: &held, passed: &passed };
        let to = (&mut knots, &mut pulse);
        vectorize!(self.axes.instructions, simd => bench.knots(simd, outputs, &mut worst, acting, to))?;
        self.pulse = pulse;
        if worst.broken.0.iter().any(|x| x.is_nan())
            || !h.surface_displacement_m.iter().all(|u| u.is_finite())
        {
            return Ok(false);
        }
        let (attained, sizes) = knots.largest();
        self.axes.attained = attained;
        let (n, d) = (self.axes.structure.masses_kg.len(), self.axes.structure.degrees());
        let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(*x));
        let (x, v, table) = (&sizes[..d], &sizes[d..2 * d], sizes[2 * d]);
        let (storey, rate) = (most(&x[1..=n]), most(&v[1..]));
        let place = most(&x[1 + n..]).max(x[0]);
        let (sliding, block) = (self.axes.attained[VELOCITY], self.axes.attained[BLOCK]);
        self.take_sizes(&Sizes {
            displacement_m: storey.max(place),
            storey_m: storey,
            velocity: sliding.max(rate),
            sliding,
            acceleration: block.max(table),
            frequency: self.axes.structure.frame_frequency(),
        });
        worst.enter(&mut self.figures);
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
        let energies = [&mut knots.kinetic_j, &mut knots.strain_j].map(|list| {
            list.truncate(h.len());
            core::mem::take(list)
        });
        self.books = Books::new(energies, stop_j, [self.ground.has_vertical(), self.law.follows()]);
        self.axes.knots = knots;
        Ok(true)
    }

    fn decide(&mut self, changes: &[usize]) {
        self.judge_changes(changes);
    }

    fn in_any_order(&mut self) -> Result<(), Stopped> {
        self.find_floor();
        self.side_by_side()?;
        self.look_again()
    }

    fn go_through(&mut self, run: Run) -> Result<(), Stopped> {
        self.add_up(run);
        self.recall_until(run.to);
        Ok(())
    }

    /// By the load that suits it best.
    fn alone(&mut self, k: usize) {
        let h = self.h;
        let w = h.sliding_velocity_m_per_s[k];
        let per_n = match h.modes(k)[0] {
            Mode::Stick => None,
            Mode::Slip(direction) => Some(match self.sliding(k, h.modes(k)[0]) {
                Some(sliding) => -sliding.force(0.0),
                None => {
                    let factor =
                        self.law.rate.as_ref().map_or(1.0, |rate| rate.coefficient(w.abs()));
                    self.law.sliding_load(direction) * factor
                }
            }),
        };
        let (mut table, mut force) = (f64::INFINITY, f64::INFINITY);
        for load in self.ground.instant(h.time_s[k]) {
            let off = (load.table - h.table_acceleration_m_per_s2[k]).abs();
            table = table.min((off - self.instant_s * load.slope.abs()).max(0.0));
            let off =
                per_n.map_or(0.0, |per_n| (h.friction_force_n[k] - per_n * load.normal).abs());
            let rounding = self.law.most() * load.normal_rounding(self.ground.blur());
            force = force.min(excess(off - rounding));
        }
        self.figures.table[0] = larger(self.figures.table[0], table);
        self.figures.excess = larger(self.figures.excess, force);
        if k == 0 || k + 1 == h.len() {
            self.beside_jump(k);
        }
    }

    fn abreast(&mut self, k: usize) -> bool {
        let h = self.h;
        let struck = self.strikes(k);
        if struck {
            self.books.damping[k - 1] = self.lost_in_impact(k);
        } else {
            for i in 0..self.axes.structure.degrees() {
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

    fn slipped(&mut self, i: usize, direction: Direction, to: usize) -> Option<ClosestCall> {
        if !self.drops(i, direction) {
            return None;
        }
        if self.dips[i].so_far() < f64::INFINITY {
            let knots = self.axes.since[i]..=to;
            let fastest = knots.fold(0.0, |most, k| self.speed_at(k, i).abs().max(most));
            self.dips[i].see(fastest);
        }
        self.dips[i].least(DecisionKind::Slip, i)
    }

    fn begins(&mut self, i: usize, k: usize) {
        self.axes.since[i] = k;
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
        JudgeInput { model, motion, response, history, law, outputs, pulse: Pulse::new(UNWATCHED) }
    }

    /// The step that a record has is swept with a tail too, which begins with a jump.
    #[test]
    fn common_step_is_swept() {
        for n in [0, 1, 2, 5] {
            for tail_s in [0.0, 1.0, 1.0037] {
                let (model, motion, response) = wrong(n, 800, tail_s);
                assert_eq!(motion.dt_s().is_none(), tail_s > 0.0);
                let structure = Structure::new(&model, false);
                let (law, outputs) = (Law::new(&model, false), Outputs::new(&model));
                let given = given((&model, &motion, &response), (&law, &outputs));
                let mut judge = Judge::of_line(given, &structure);
                assert!(judge.measure().unwrap());
                judge.side_by_side().unwrap();
                let (swept, intervals) = (judge.axes.swept, motion.len() - 1);
                assert!(10 * swept > 9 * intervals, "{n} storeys: {swept} of {intervals}");
            }
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
                judge.axes.instructions = instructions;
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
