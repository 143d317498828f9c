//! Goes through the knots of a history and keeps the worst of everything.

use fearless_simd::{Level, dispatch};

use super::collocation::Rule;
use super::demands::{self, Rounding, Totals};
use super::energy::Books;
use super::events::Events;
use super::ground::Ground;
use super::intervals::Run;
use super::knots::{Acting, Knots, LaneJudge, Worst};
use super::law::Law;
use super::near::Dips;
use super::outputs::{BLOCK, Outputs, VELOCITY};
use super::structure::{Phase, Structure, larger};
use super::{Certificate, ClosestCall};
use crate::error::Stopped;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::progress::{Pulse, UNWATCHED};
use crate::response::{Contact, History, Mode, Response};

/// A sliding velocity below this part of its peak has no sign: the depth of a dip through zero that
/// the exact method may miss.
pub(super) const STILL: f64 = 1e-12;
/// Largest defects so far, each with the scale it is measured by.
#[derive(Default)]
pub(super) struct Figures {
    pub(super) displacement: [f64; 2],
    pub(super) velocity: [f64; 2],
    pub(super) force: [f64; 2],
    pub(super) table: [f64; 2],
    pub(super) excess: f64,
}

impl Figures {
    /// The largest defect over its scale; that of the table is over its own peak.
    pub(super) fn equilibrium(&self, table: f64) -> f64 {
        let all = [self.displacement, self.velocity, self.force, [self.table[0], table]];
        all.map(relative).into_iter().fold(0.0, larger)
    }

    /// Takes the worst of all lanes.
    pub(super) fn take(&mut self, worst: &Worst) {
        for (figure, lanes) in [
            (&mut self.displacement, &worst.displacement),
            (&mut self.velocity, &worst.velocity),
            (&mut self.force, &worst.force),
        ] {
            *figure = [0, 1].map(|i| larger(figure[i], lanes[i].largest()));
        }
        self.table[0] = larger(self.table[0], worst.table.largest());
        self.excess = larger(self.excess, worst.excess.largest());
    }
}

/// The largest defect over its scale, where `pair` is `[defect, scale]`.
pub(super) fn relative(pair: [f64; 2]) -> f64 {
    if pair[0] == 0.0 { 0.0 } else { pair[0] / pair[1] }
}

pub(super) struct Judge<'a> {
    pub(super) model: &'a Model,
    pub(super) response: &'a Response,
    pub(super) h: &'a History,
    pub(super) structure: &'a Structure,
    pub(super) law: &'a Law,
    pub(super) ground: Ground<'a>,
    /// Largest `N` and `|Ü|`.
    pub(super) largest: (f64, f64),
    pub(super) outputs: Outputs,
    /// Largest sizes of the outputs.
    pub(super) attained: Vec<f64>,
    pub(super) rates: [f64; 3],
    /// Velocities below this are zero to within rounding.
    pub(super) still: f64,
    /// Rounding of a time.
    pub(super) instant_s: f64,
    /// What it makes of a force at an event at most.
    pub(super) unsure_n: f64,
    /// Velocity that the largest acceleration gives in that time.
    pub(super) jolt: f64,
    /// What the rounding of `N` makes of places and velocities in an interval.
    pub(super) drift: [f64; 2],
    pub(super) figures: Figures,
    pub(super) runs: Vec<Run>,
    /// Modes before the first knot: a block with a velocity slides on.
    pub(super) at_start: Vec<Mode>,
    /// Near decisions of the phases under way, by interface.
    pub(super) dips: Vec<Dips>,
    /// Knots at which these have begun.
    pub(super) since: Vec<usize>,
    pub(super) closest: Option<ClosestCall>,
    /// A margin that the closest call has at most.
    pub(super) floor: f64,
    pub(super) totals: Totals,
    pub(super) events: Events,
    /// Step of most intervals of the motion.
    pub(super) even_s: f64,
    pub(super) longest_s: f64,
    /// Intervals that were swept.
    #[cfg(test)]
    pub(super) swept: usize,
    pub(super) level: Level,
    /// Asks whether to go on.
    pub(super) pulse: Pulse<'a>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(
        model: &'a Model,
        motion: &'a GroundMotion,
        (response, history): (&'a Response, &'a History),
        (structure, law): (&'a Structure, &'a Law),
        pulse: Pulse<'a>,
    ) -> Self {
        let end_s = history.time_s.last().copied().unwrap_or(0.0);
        let instant_s = 8.0 * f64::EPSILON * end_s;
        let ground = Ground::new(model, motion, end_s);
        let largest = ground.largest(end_s);
        let relative = || {
            let tables = history.table_acceleration_m_per_s2.iter();
            let pairs = history.block_acceleration_m_per_s2.iter().zip(tables);
            pairs.fold(0.0, |most, (block, table)| (block - table).abs().max(most))
        };
        let relative = if law.rate.is_some() { relative() } else { 0.0 };
        let added = law.added_rate(largest.0 / structure.block_kg, relative);
        let rate = |phase| structure.rate(phase) + if phase == Phase::Stick { 0.0 } else { added };
        let interfaces = 1 + structure.contents.len();
        let mut at_start = vec![Mode::Stick; interfaces];
        if model.initial().sliding_velocity_m_per_s != 0.0 {
            at_start[0] = history.mode[0];
        }
        let outputs = Outputs::new(model);
        Self {
            model,
            response,
            h: history,
            structure,
            law,
            ground,
            largest,
            attained: vec![0.0; outputs.len()],
            outputs,
            rates: [Phase::Stick, Phase::Slip, Phase::Pressed].map(rate),
            still: 0.0,
            instant_s,
            unsure_n: 0.0,
            jolt: 0.0,
            drift: [0.0; 2],
            figures: Figures::default(),
            runs: Vec::new(),
            at_start,
            dips: vec![Dips::new(0.0); interfaces],
            since: vec![0; interfaces],
            closest: None,
            floor: f64::INFINITY,
            totals: Totals::new(interfaces),
            events: Events::default(),
            even_s: common_step(motion.times_s(), 2.0 * instant_s),
            longest_s: history.time_s.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max),
            #[cfg(test)]
            swept: 0,
            level: Level::new(),
            pulse,
        }
    }

    /// What the lanes need.
    pub(super) fn bench(&self) -> LaneJudge<'a> {
        LaneJudge {
            structure: self.structure,
            rule: Rule::get(),
            history: self.h,
            law: self.law,
            slope: self.model.slope_m_per_s2(),
            instant_s: self.instant_s,
            vertical: self.ground.has_vertical(),
            level: self.level,
        }
    }

    /// Looks at every knot by itself: the balance of forces, scales, energies and outputs. `None`
    /// where something stored is not finite.
    fn knots(&mut self) -> Result<Option<Knots>, Stopped> {
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
        let mut worst = Worst::NONE;
        let degrees = [self.structure.degrees(), h.storeys];
        let mut knots = Knots::new(h.len(), self.outputs.len(), degrees);
        let mut pulse = core::mem::replace(&mut self.pulse, Pulse::new(UNWATCHED));
        let (bench, outputs) = (self.bench(), &self.outputs);
        let acting = Acting { stop: &stop, held: &held, passed: &passed };
        let to = (&mut knots, &mut pulse);
        dispatch!(self.level, simd => bench.knots(simd, outputs, &mut worst, acting, to))?;
        self.pulse = pulse;
        if worst.broken.0.iter().any(|x| x.is_nan())
            || !h.surface_displacement_m.iter().all(|u| u.is_finite())
        {
            return Ok(None);
        }
        let (attained, sizes) = knots.largest();
        self.attained = attained;
        let (n, d) = (self.structure.masses_kg.len(), self.structure.degrees());
        let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(*x));
        let (x, v, table) = (&sizes[..d], &sizes[d..2 * d], sizes[2 * d]);
        let (storey, rate) = (most(&x[1..=n]), most(&v[1..]));
        let place = most(&x[1 + n..]).max(x[0]);
        let (sliding, block) = (self.attained[VELOCITY], self.attained[BLOCK]);
        let speed = sliding.max(rate);
        // A frame held at rest by its weight on a slope moves by rounding alone: its velocities
        // are measured by the static displacement, not by themselves.
        let rest = 1e-4 * self.structure.frame_frequency() * storey;
        // What the rounding of a time makes of the largest acceleration is no motion either.
        self.jolt = self.instant_s * block.max(table);
        let f = &mut self.figures;
        f.displacement[1] = storey.max(place).max(self.instant_s * self.jolt);
        f.velocity[1] = speed.max(rest).max(self.jolt);
        self.still = STILL * sliding + 64.0 * f64::EPSILON * speed;
        f.take(&worst);
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
        Ok(Some(knots))
    }

    /// Judges everything; `None` where something stored is not finite.
    pub(super) fn run(mut self, bound: f64) -> Result<Option<Certificate>, Stopped> {
        let Some(mut knots) = self.knots()? else { return Ok(None) };
        let (h, count) = (self.h, self.h.len());
        self.runs = self.find_runs();
        self.start();
        let stop_j = self.law.push(self.contact(0)).strain(h.sliding_displacement_m[0]);
        let rounding_j = self.model.total_mass_kg() * self.jolt * self.jolt;
        let energies = [&mut knots.kinetic_j, &mut knots.strain_j].map(|list| {
            list.truncate(count);
            core::mem::take(list)
        });
        let mut books =
            Books::new(energies, stop_j, [self.ground.has_vertical(), self.law.follows()]);
        self.decide();
        self.find_floor();
        let watched = self.side_by_side(&knots, &mut books)?;
        let near = self.look_again(&watched, &mut books)?;
        self.in_order(&mut books, &watched, &near);
        Ok(Some(self.certificate(bound, books, rounding_j)))
    }

    /// Contact with the stop at a knot.
    pub(super) fn contact(&self, k: usize) -> Contact {
        self.h.contact.get(k).copied().unwrap_or(Contact::Free)
    }

    /// What the rounding of times makes of a position at this speed, and of the force of the stop.
    pub(super) fn slack(&self, w: f64) -> [f64; 2] {
        let slack_m = self.instant_s * w.abs() + 8.0 * f64::EPSILON * self.figures.displacement[1];
        [slack_m, self.structure.stop_damper() * self.jolt]
    }

    /// Displacement and velocity of a degree at a knot.
    pub(super) fn stored(&self, k: usize, degree: usize) -> [f64; 2] {
        let (h, n) = (self.h, self.h.storeys);
        match degree {
            0 => [h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]],
            i if i <= n => [h.storey_displacements(k)[i - 1], h.storey_velocities(k)[i - 1]],
            i => {
                let [r, p, _] = h.contents_state(k, i - 1 - n);
                [r, p]
            }
        }
    }

    /// Compares the stored state of a degree at a knot with another.
    pub(super) fn compare(&mut self, k: usize, degree: usize, [own_x, own_v]: [f64; 2]) {
        let [x, v] = self.stored(k, degree);
        self.figures.displacement[0] = larger(self.figures.displacement[0], x - own_x);
        self.figures.velocity[0] = larger(self.figures.velocity[0], v - own_v);
    }

    /// The first knot has the model's initial state.
    fn start(&mut self) {
        let initial = self.model.initial();
        let mut x = vec![initial.sliding_displacement_m];
        x.extend(self.model.initial_storey_displacement_m());
        let mut v = vec![initial.sliding_velocity_m_per_s];
        v.extend(self.model.initial_storey_velocity_m_per_s());
        let at = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
        for i in 0..self.structure.degrees() {
            self.compare(0, i, [at(&x, i), at(&v, i)]);
        }
    }

    fn certificate(self, bound: f64, books: Books, rounding_j: f64) -> Certificate {
        let weight = self.model.weight_n();
        let (normal, table) = self.largest;
        let f = &self.figures;
        // 64 ε of what a difference is made of is rounding.
        let near = |scale: f64| 64.0 * f64::EPSILON * scale;
        let rounding = Rounding {
            instant_s: self.instant_s,
            displacement_m: near(f.displacement[1]) + self.drift[0],
            velocity_m_per_s: near(f.velocity[1]) + self.jolt + self.drift[1],
            force_n: near(f.force[1])
                + self.unsure_n
                + self.law.rounding(&self.ground, self.instant_s, normal),
        };
        let own = demands::Own {
            outputs: &self.outputs,
            peaks: &self.attained,
            possible: &self.attained,
            scales: &self.attained,
            totals: &self.totals,
            events: &self.events,
            gap_m: self.model.slider().gap_m(),
            width_m: self.model.block().width_m,
        };
        let demands_error = demands::error(self.model, self.response, self.h, &own, &rounding);
        Certificate {
            equilibrium_residual: f.equilibrium(table),
            friction_excess: relative([f.excess, self.law.scale(normal, weight)]),
            energy_balance_error: books
                .error(rounding_j, |k| unsure(&self.h.time_s, self.instant_s, k)),
            demands_error,
            closest_call: self.closest,
            bound,
            books,
        }
    }
}

/// The part of the interval from a knot that the rounding of an event's time may be, where one is beside it.
pub(super) fn unsure(times_s: &[f64], instant_s: f64, k: usize) -> f64 {
    let stands_twice = |k: usize| times_s.get(k + 1) == Some(&times_s[k]);
    if (k > 0 && stands_twice(k - 1)) || stands_twice(k + 1) {
        (instant_s / (times_s[k + 1] - times_s[k])).min(1.0)
    } else {
        0.0
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
    use super::*;
    use crate::model::{Block, Damping, Frame, InitialState, Slider};
    use crate::response::{Demands, Method};
    use crate::slider::{Direction, Friction};

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

    /// The step that a record has is swept with a tail too, which begins with a jump.
    #[test]
    fn exact_common_step_is_swept() {
        for n in [0, 1, 2, 5] {
            for tail_s in [0.0, 1.0, 1.0037] {
                let (model, motion, response) = wrong(n, 800, tail_s);
                assert_eq!(motion.dt_s().is_none(), tail_s > 0.0);
                let structure = Structure::new(&model, false);
                let history = response.history.as_ref().unwrap();
                let (given, pulse) = ((&response, history), Pulse::new(UNWATCHED));
                let law = Law::new(&model, false);
                let mut judge = Judge::new(&model, &motion, given, (&structure, &law), pulse);
                let knots = judge.knots().unwrap().unwrap();
                judge.runs = judge.find_runs();
                let zeros = || vec![0.0; history.len()];
                let mut books = Books::new([zeros(), zeros()], 0.0, [false; 2]);
                judge.side_by_side(&knots, &mut books).unwrap();
                let (swept, intervals) = (judge.swept, motion.len() - 1);
                assert!(10 * swept > 9 * intervals, "{n} storeys: {swept} of {intervals}");
            }
        }
    }

    #[test]
    fn exact_step_of_most_intervals_is_common() {
        assert_eq!(common_step(&[0.0, 1.0, 2.0, 2.0, 3.0, 9.0], 0.0), 1.0);
        assert_eq!(common_step(&[0.0, 5.0, 6.0, 6.5, 7.5, 8.5, 9.5], 0.0), 1.0);
        assert!(common_step(&[0.0, 1.0, 2.0, 4.0, 6.0], 0.0).is_nan());
        assert!(common_step(&[0.0, 0.0], 0.0).is_nan());
    }

    #[test]
    fn exact_same_bits_by_every_instruction_set() {
        let mut levels = vec![Level::new()];
        #[cfg(target_arch = "x86_64")]
        {
            let best = Level::new();
            levels.extend(best.as_avx2().map(Level::Avx2));
            levels.extend(best.as_sse4_2().map(Level::Sse4_2));
            levels.extend(best.as_sse2().map(Level::Sse2));
        }
        for n in [0, 1, 3] {
            let (model, motion, response) = wrong(n, 99, 0.0);
            let structure = Structure::new(&model, false);
            let of = |level| {
                let history = response.history.as_ref().unwrap();
                let (given, pulse) = ((&response, history), Pulse::new(UNWATCHED));
                let law = Law::new(&model, false);
                let mut judge = Judge::new(&model, &motion, given, (&structure, &law), pulse);
                judge.level = level;
                judge.run(1e-10).unwrap().unwrap()
            };
            let first = of(levels[0]);
            assert!(first.equilibrium_residual > 0.01 && first.equilibrium_residual.is_finite());
            for &level in &levels {
                assert_eq!(of(level), first, "{n} storeys, {level:?}");
            }
        }
    }
}
