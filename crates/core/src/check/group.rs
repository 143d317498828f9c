//! Intervals between knots, eight side by side.
//!
//! Every interval starts from a stored state, so intervals do not depend on each other. Between two knots
//! all laws but friction by speed are affine with numbers of the lane:
//!
//! ```text
//! T = N (p₀ − p₁ s)                                    in a slip, times μ(|ṡ|) with friction by speed
//! F = T − (K1 + N/R) s − C1 ṡ − (k s + c ṡ − shift)     with the spring of a pendulum and an elastic stop
//! ```
//!
//! and contents add their mass to a floor that they stick to, or pull at it with `μ m N/M`.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::collocation::{MAX_TURN, MOST_PASSES, NODES, POINTS, ROUNDING};
use super::ground::{Ground, Load, between};
use super::knots::{Knots, LaneJudge, Worst};
use super::lane::{Eight, LANES, Places, all, both, inlined, keep, larger, smaller};
use super::law::Push;
use super::outputs::{BLOCK, FRICTION, Outputs, STOP, each_output, raise};
use super::structure::{StoreyDamping, larger as greatest};
use crate::error::Stopped;
use crate::progress::Pulse;
use crate::response::Mode;

/// Stands for no bound, so that it can be multiplied by 0.
pub(super) const UNBOUNDED: f64 = 1e200;

/// The way through an interval in equal steps under linear loads, piece after piece.
#[derive(Clone, Copy, Default)]
pub(super) struct Feed {
    start_s: f64,
    end_s: f64,
    from_s: f64,
    to_s: f64,
    rate: f64,
    loads: [Load; 2],
    steps: usize,
    at: usize,
}

/// One step of it.
#[derive(Clone, Copy)]
pub(super) struct Step {
    pub(super) from_s: f64,
    pub(super) step_s: f64,
    pub(super) loads: [Load; 2],
}

impl Feed {
    /// Through an interval, at a rate of the motion.
    pub(super) fn new(ground: &mut Ground<'_>, [from_s, end_s]: [f64; 2], rate: f64) -> Self {
        let mut feed = Self { start_s: from_s, end_s, from_s, rate, ..Self::default() };
        feed.piece(ground);
        feed
    }

    /// An instant under a load.
    pub(super) fn instant(load: Load) -> Self {
        Self { loads: [load; 2], steps: 1, ..Self::default() }
    }

    fn piece(&mut self, ground: &mut Ground<'_>) {
        let piece = ground.piece(self.from_s, self.end_s);
        (self.loads, self.to_s) = (piece.loads, piece.to_s);
        // A step that is even to within rounding takes as many.
        let turns = self.rate * (self.to_s - self.from_s) / MAX_TURN;
        self.steps = libm::ceil(turns * (1.0 - 1e-9)).max(1.0) as usize;
        self.at = 0;
    }

    /// Whether its loads are linear from end to end.
    pub(super) fn is_single(&self) -> bool {
        self.to_s >= self.end_s
    }

    fn is_through(&self) -> bool {
        self.at == self.steps && self.is_single()
    }

    /// Steps, of its first piece.
    pub(super) fn steps(&self) -> usize {
        self.steps
    }

    /// Rate of the motion.
    pub(super) fn rate(&self) -> f64 {
        self.rate
    }

    /// Loads at both ends of its first piece.
    pub(super) fn loads(&self) -> [Load; 2] {
        self.loads
    }

    fn next(&mut self, ground: &mut Ground<'_>) -> Option<Step> {
        if self.at == self.steps {
            if self.to_s >= self.end_s {
                return None;
            }
            self.from_s = self.to_s;
            self.piece(ground);
        }
        if self.steps == 1 {
            self.at = 1;
            let (from_s, loads) = (self.from_s, self.loads);
            return Some(Step { from_s, step_s: self.to_s - from_s, loads });
        }
        let (steps, at) = (self.steps as f64, self.at as f64);
        let step_s = (self.to_s - self.from_s) / steps;
        let loads = [self.at, self.at + 1].map(|j| between(self.loads, j as f64 / steps));
        self.at += 1;
        Some(Step { from_s: self.from_s + at * step_s, step_s, loads })
    }
}

/// An interval, or an instant: what is in force there.
pub(super) struct Course<'a> {
    pub(super) knot: usize,
    pub(super) modes: &'a [Mode],
    /// `p₀, p₁`.
    pub(super) friction: [f64; 2],
    /// What an elastic stop does.
    pub(super) push: Push,
    /// Least and largest `T/N` at rest, of friction with rigid stops.
    pub(super) hold: [f64; 2],
    /// Between which `T/N` friction takes the demand; a rigid stop takes the rest.
    pub(super) taken: [f64; 2],
    /// Sum of the coefficients of what slides.
    pub(super) slides: f64,
    pub(super) feed: Feed,
}

/// What makes the path of an interval a linear map of its inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    /// A bit for each interface that sticks.
    pub(super) stuck: u64,
    /// Elastic stop: stiffness and damper.
    pub(super) push: [f64; 2],
    /// `N p₁ + N/R`.
    pub(super) rise: f64,
}

/// Contents in lanes.
#[derive(Clone, Copy, Default)]
struct Carried {
    stuck: Eight,
    sign: Eight,
    /// `sgn ṙ μ_k/M`; 0 in stick.
    pull: Eight,
}

/// Intervals to be judged side by side; the last stands for the lanes that are left.
pub(super) struct Group {
    pub(super) count: usize,
    knots: [usize; LANES],
    feeds: [Feed; LANES],
    steps: [Step; LANES],
    /// Of the step under way: its length, what lies before it, and the length of the interval.
    step_s: Eight,
    before_s: Eight,
    length_s: Eight,
    table: [Eight; 2],
    normal: [Eight; 2],
    rise: [Eight; 2],
    drift: Eight,
    /// Rounding of `N`, the largest on the way.
    normal_rounding: Eight,
    stuck: Eight,
    sign: Eight,
    friction: [Eight; 2],
    /// Stiffness, damper and shift of an elastic stop.
    stop: [Eight; 3],
    hold: [Eight; 2],
    /// What the margins towards them are measured by, inverted: the bound on the demand's side, or the
    /// larger one where both are on one.
    scale: [Eight; 2],
    taken: [Eight; 2],
    slides: Eight,
    /// Whether all intervals are of one step.
    at_once: bool,
    /// Masses of the block and the floors with what sticks to them, and their inverses.
    mass: Vec<Eight>,
    inverse: Vec<Eight>,
    carried: Vec<Carried>,
}

impl Group {
    pub(super) fn new(bench: &LaneJudge<'_>) -> Self {
        let s = bench.structure;
        let masses = || core::iter::once(s.block_kg).chain(s.masses_kg.iter().copied());
        let rest = Step { from_s: 0.0, step_s: 0.0, loads: [Load::default(); 2] };
        let pair = [Eight::ZERO; 2];
        Self {
            count: 0,
            knots: [0; LANES],
            feeds: [Feed::default(); LANES],
            steps: [rest; LANES],
            step_s: Eight::ZERO,
            before_s: Eight::ZERO,
            length_s: Eight::ZERO,
            table: pair,
            normal: pair,
            rise: pair,
            drift: Eight::ZERO,
            normal_rounding: Eight::ZERO,
            stuck: Eight::ZERO,
            sign: Eight::ZERO,
            friction: pair,
            stop: [Eight::ZERO; 3],
            hold: pair,
            scale: pair,
            taken: pair,
            at_once: true,
            slides: Eight::ZERO,
            mass: masses().map(|m| Eight([m; LANES])).collect(),
            inverse: masses().map(|m| Eight([1.0 / m; LANES])).collect(),
            carried: vec![Carried::default(); s.contents.len()],
        }
    }

    /// Takes an interval; whether there is no room for another.
    pub(super) fn push(&mut self, bench: &LaneJudge<'_>, course: &Course<'_>) -> bool {
        let lane = self.count;
        self.knots[lane] = course.knot;
        self.feeds[lane] = course.feed;
        let stuck = course.modes[0] == Mode::Stick;
        self.stuck.0[lane] = if stuck { 1.0 } else { 0.0 };
        self.sign.0[lane] = course.modes[0].sign();
        self.slides.0[lane] = course.slides;
        self.normal_rounding.0[lane] = 0.0;
        let [low, high] = course.hold;
        let most = low.abs().max(high.abs());
        let most = if most < UNBOUNDED { most } else { 1.0 };
        let straddles = low <= 0.0 && high >= 0.0;
        self.scale[0].0[lane] = 1.0 / if straddles { most.min(-low) } else { most };
        self.scale[1].0[lane] = 1.0 / if straddles { most.min(high) } else { most };
        for i in 0..2 {
            self.friction[i].0[lane] = course.friction[i];
            self.hold[i].0[lane] = course.hold[i];
            self.taken[i].0[lane] = course.taken[i];
        }
        for (stop, value) in self.stop.iter_mut().zip(course.push.numbers()) {
            stop.0[lane] = value;
        }
        let modes = course.modes[1..].iter().map(|mode| (mode.sign(), *mode == Mode::Stick));
        self.carry(bench, lane, modes);
        let feed = &course.feed;
        if lane == 0 {
            self.at_once = true;
        }
        self.at_once &= feed.steps == 1 && feed.is_single();
        if self.at_once {
            let step_s = feed.to_s - feed.from_s;
            self.take_step(lane, Step { from_s: feed.from_s, step_s, loads: feed.loads });
        }
        self.count += 1;
        self.count == LANES
    }

    /// Sets contents of a lane by the sign of their sliding.
    fn carry(
        &mut self,
        bench: &LaneJudge<'_>,
        lane: usize,
        modes: impl Iterator<Item = (f64, bool)>,
    ) {
        let s = bench.structure;
        if s.contents.is_empty() {
            return;
        }
        self.mass[0].0[lane] = s.block_kg;
        for (mass, own) in self.mass[1..].iter_mut().zip(&s.masses_kg) {
            mass.0[lane] = *own;
        }
        for ((carried, contents), (sign, stuck)) in
            self.carried.iter_mut().zip(&s.contents).zip(modes)
        {
            carried.stuck.0[lane] = if stuck { 1.0 } else { 0.0 };
            carried.sign.0[lane] = sign;
            carried.pull.0[lane] = sign * contents.kinetic_friction / s.total_kg;
            if stuck {
                self.mass[contents.floor].0[lane] += contents.mass_kg;
            }
        }
        for (inverse, mass) in self.inverse.iter_mut().zip(&self.mass) {
            inverse.0[lane] = 1.0 / mass.0[lane];
        }
    }

    /// All lanes as a key has them, in a step of this length.
    pub(super) fn of_key(bench: &LaneJudge<'_>, key: &Key, step_s: f64) -> Self {
        let mut group = Self::new(bench);
        for lane in 0..LANES {
            group.step_s.0[lane] = step_s;
            group.stuck.0[lane] = if key.stuck & 1 == 1 { 1.0 } else { 0.0 };
            group.stop[0].0[lane] = key.push[0];
            group.stop[1].0[lane] = key.push[1];
            for end in 0..2 {
                group.rise[end].0[lane] = key.rise;
            }
            group.taken[0].0[lane] = -UNBOUNDED;
            group.taken[1].0[lane] = UNBOUNDED;
            group.normal[0].0[lane] = 1.0;
            group.normal[1].0[lane] = 1.0;
            let stuck = |e: usize| key.stuck >> (1 + e) & 1 == 1;
            let modes = (0..bench.structure.contents.len()).map(|e| (0.0, stuck(e)));
            group.carry(bench, lane, modes);
        }
        group.count = LANES;
        group
    }

    /// Repeats the last interval in the lanes that are left.
    pub(super) fn fill(&mut self) {
        if self.count == LANES {
            return;
        }
        let (from, last) = (self.count, self.count - 1);
        let carried =
            self.carried.iter_mut().flat_map(|c| [&mut c.stuck, &mut c.sign, &mut c.pull]);
        let lists = [&mut self.stuck, &mut self.sign, &mut self.slides, &mut self.normal_rounding]
            .into_iter()
            .chain(&mut self.friction)
            .chain(&mut self.stop)
            .chain(&mut self.hold)
            .chain(&mut self.scale)
            .chain(&mut self.taken)
            .chain([&mut self.step_s, &mut self.before_s, &mut self.length_s, &mut self.drift])
            .chain(&mut self.table)
            .chain(&mut self.normal)
            .chain(&mut self.mass)
            .chain(&mut self.inverse)
            .chain(carried);
        for list in lists {
            let value = list.0[last];
            list.0[from..].fill(value);
        }
        let (knot, feed, step) = (self.knots[last], self.feeds[last], self.steps[last]);
        self.steps[from..].fill(step);
        self.knots[from..].fill(knot);
        self.feeds[from..].fill(feed);
    }

    pub(super) fn knot(&self, lane: usize) -> usize {
        self.knots[lane]
    }

    /// Goes on by a step; a lane that has arrived waits in steps of no length. Whether any goes on.
    fn next(&mut self, bench: &LaneJudge<'_>, ground: &mut Ground<'_>) -> bool {
        if self.at_once {
            let fresh = self.feeds[0].at == 0;
            self.feeds[0].at = 1;
            if fresh {
                self.follow_normal(bench, ground);
            }
            return fresh;
        }
        let mut goes_on = false;
        for lane in 0..LANES {
            let step = if lane >= self.count {
                self.steps[self.count - 1]
            } else if let Some(step) = self.feeds[lane].next(ground) {
                goes_on = true;
                step
            } else {
                let Step { from_s, step_s, loads: [_, end] } = self.steps[lane];
                Step { from_s: from_s + step_s, step_s: 0.0, loads: [end; 2] }
            };
            self.steps[lane] = step;
        }
        if goes_on {
            for lane in 0..LANES {
                self.take_step(lane, self.steps[lane]);
            }
            self.follow_normal(bench, ground);
        }
        goes_on
    }

    /// Whether no lane goes on after this step.
    fn is_last_step(&self) -> bool {
        self.at_once || self.feeds[..self.count].iter().all(Feed::is_through)
    }

    /// Whether anything sticks.
    fn asks(&self) -> bool {
        let sticks = |stuck: &Eight| stuck.0 != Eight::ZERO.0;
        sticks(&self.stuck) || self.carried.iter().any(|carried| sticks(&carried.stuck))
    }

    /// Takes the step of a lane.
    fn take_step(&mut self, lane: usize, step: Step) {
        let feed = &self.feeds[lane];
        self.step_s.0[lane] = step.step_s;
        self.before_s.0[lane] = step.from_s - feed.start_s;
        self.length_s.0[lane] = feed.end_s - feed.start_s;
        for (end, load) in step.loads.iter().enumerate() {
            self.table[end].0[lane] = load.table;
            self.normal[end].0[lane] = load.normal;
        }
        self.drift.0[lane] = step.loads[0].slope;
        self.steps[lane] = step;
    }

    /// What follows the normal force in the step under way: its rounding, and springs.
    fn follow_normal(&mut self, bench: &LaneJudge<'_>, ground: &Ground<'_>) {
        if bench.vertical {
            for lane in 0..LANES {
                let rounding = self.steps[lane].loads[0].normal_rounding(ground.blur());
                let most = &mut self.normal_rounding.0[lane];
                *most = most.max(rounding);
            }
        }
        if !bench.follows() {
            return;
        }
        let curvature = bench.law.curvature_per_m();
        for end in 0..2 {
            for lane in 0..LANES {
                let per_n = self.friction[1].0[lane] + curvature;
                self.rise[end].0[lane] = self.normal[end].0[lane] * per_n;
            }
        }
    }
}

/// The map from inputs to a path of one key and step, row by row, of inputs that are not 0.
pub(super) struct Map {
    inputs: Vec<usize>,
    /// Rows that are 0, and those that are not with their entries.
    blank: Vec<usize>,
    rows: Vec<usize>,
    entries: Vec<f64>,
}

impl Map {
    /// From the columns of all inputs, of which some are 0.
    fn new(zero: &[usize], count: usize, columns: &[f64]) -> Self {
        let length = columns.len() / count;
        let inputs: Vec<usize> = (0..count)
            .filter(|j| !zero.contains(j))
            .filter(|j| columns[j * length..(j + 1) * length].iter().any(|c| *c != 0.0))
            .collect();
        let row = |r: usize| inputs.iter().map(move |j| columns[j * length + r]);
        let (rows, blank): (Vec<usize>, Vec<usize>) =
            (0..length).partition(|&r| row(r).any(|c| c != 0.0));
        let entries = rows.iter().flat_map(|&r| row(r)).collect();
        Self { inputs, blank, rows, entries }
    }
}

/// The maps of a key and a step to the path, and to its places.
pub(super) struct Maps {
    pub(super) path: Map,
    pub(super) places: Map,
}

/// How far outputs may leave the chord of a step: at most in proportion to its length.
pub(super) struct Spread {
    /// Of which step these are the bounds.
    longest_s: f64,
    /// Outputs that leave the chord, with the inputs of size 1 that make them and by how much.
    leaving: Vec<(usize, Vec<(usize, f64)>)>,
}

/// What the points of intervals say of a margin or a speed, one after another.
#[derive(Clone, Default)]
struct Extremes {
    first: Eight,
    least: Eight,
    most: Eight,
    last: Eight,
    /// 1 where it has risen, and fallen.
    rises: Eight,
    falls: Eight,
}

/// What is told of the decisions of an interface in an interval: its margin in stick, its speed in slip.
#[derive(Clone, Copy, Default)]
pub(super) struct Watch<T> {
    /// At both ends.
    pub(super) ends: [T; 2],
    /// The least at any point, and what it cannot fall below in between where it is not monotone.
    pub(super) least: T,
    pub(super) low: T,
    /// Largest speed.
    pub(super) fastest: T,
}

/// What is told of the energies of an interval.
#[derive(Clone, Copy, Default)]
pub(super) struct Spent<T> {
    pub(super) work: T,
    pub(super) size: T,
    pub(super) damping: T,
    pub(super) friction: T,
    /// What the rounding of `N` makes of them.
    pub(super) blur: T,
}

/// The points of a step: `T` or the acceleration of contents in stick, the speed in the direction claimed
/// in slip, interface by interface; then `s` and `ṡ`.
pub(super) struct Points {
    pub(super) knot: usize,
    pub(super) step: Step,
    pub(super) values: Vec<[f64; POINTS]>,
}

/// Inputs and paths of a group under judgement.
pub(super) struct Work {
    input: Vec<Eight>,
    /// The inputs that are not 0, and a state at a node.
    active: Vec<Eight>,
    state: Vec<(Eight, Eight)>,
    /// Accelerations of the block, the floors and the contents, with the slope's share.
    bodies: Vec<Eight>,
    /// `v` at the nodes, `x` and `v` at the end, what is asked of each interface at the nodes.
    path: Vec<Eight>,
    /// `x` at the nodes, and `ẍ` where the equations were solved.
    trace: Vec<Eight>,
    fastest: Vec<Eight>,
    /// Outputs at the nodes, and at the ends of a step within an interval.
    values: Vec<Eight>,
    pub(super) ends: [Vec<Eight>; 2],
    seen: Vec<Extremes>,
    pub(super) spent: Spent<Eight>,
    pub(super) watch: Vec<Watch<Eight>>,
}

impl Work {
    pub(super) fn new(bench: &LaneJudge<'_>, outputs: usize) -> Self {
        let zeros = |count: usize| vec![Eight::ZERO; count];
        let (d, e) = (bench.structure.degrees(), bench.structure.contents.len());
        Self {
            input: zeros(2 * d + 4 + 2 * e),
            active: zeros(2 * d + 4 + 2 * e),
            state: vec![(Eight::ZERO, Eight::ZERO); d],
            bodies: zeros(d),
            path: zeros((NODES + 2) * d + NODES * (1 + e)),
            trace: zeros(2 * NODES * d),
            fastest: zeros(d),
            values: zeros(NODES * outputs),
            ends: [zeros(outputs), zeros(outputs)],
            seen: vec![Extremes::default(); 1 + e],
            spent: Spent::default(),
            watch: vec![Watch::default(); 1 + e],
        }
    }
}

impl Spent<Eight> {
    pub(super) fn lane(&self, lane: usize) -> Spent<f64> {
        let [work, size, damping, friction, blur] =
            [self.work, self.size, self.damping, self.friction, self.blur].map(|e| e.0[lane]);
        Spent { work, size, damping, friction, blur }
    }
}

impl Watch<Eight> {
    pub(super) fn lane(&self, lane: usize) -> Watch<f64> {
        Watch {
            ends: self.ends.map(|e| e.0[lane]),
            least: self.least.0[lane],
            low: self.low.0[lane],
            fastest: self.fastest.0[lane],
        }
    }
}

/// What a pass through groups reads and changes besides them.
pub(super) struct Pass<'p, 'g> {
    pub(super) ground: &'p mut Ground<'g>,
    pub(super) outputs: &'p Outputs,
    pub(super) attained: &'p mut [f64],
    pub(super) knots: &'p Knots,
    pub(super) work: &'p mut Work,
    pub(super) worst: &'p mut Worst,
    pub(super) pulse: &'p mut Pulse<'g>,
}

/// Loads and springs at a part of a step.
#[derive(Clone, Copy)]
struct Now<S: Simd> {
    a: f64x8<S>,
    /// `N p₀ + shift` in slip, `shift` in stick.
    load: f64x8<S>,
    rise: f64x8<S>,
    part: f64,
}

impl LaneJudge<'_> {
    /// Judges a group by the maps of its step, or by solving the equations of each.
    #[inline(always)]
    pub(super) fn group<S: Simd>(
        &self,
        simd: S,
        group: &mut Group,
        (maps, spread): (Option<&Maps>, Option<&Spread>),
        pass: &mut Pass<'_, '_>,
    ) -> Result<(), Stopped> {
        // One storey gets loops of its own.
        match self.structure.masses_kg.len() {
            1 => self.group_of(simd, 1, group, (maps, spread), pass),
            n => self.group_of(simd, n, group, (maps, spread), pass),
        }
    }

    #[inline(always)]
    fn group_of<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &mut Group,
        (maps, spread): (Option<&Maps>, Option<&Spread>),
        pass: &mut Pass<'_, '_>,
    ) -> Result<(), Stopped> {
        let places = Places::new(group.knots);
        self.read(simd, n, &places, &mut pass.work.input);
        pass.work.spent = Spent::default();
        pass.work.fastest.fill(Eight::ZERO);
        let mut first = true;
        while group.next(self, pass.ground) {
            pass.pulse.beat(32 * self.structure.degrees() as u32)?;
            self.load(simd, n, group, first, pass.work);
            match maps {
                Some(maps) => apply(simd, &maps.path, pass.work, false),
                None => self.solve(simd, n, group, Some(&places), pass.work),
            }
            self.spend(simd, n, group, maps.is_none(), pass.work);
            self.watch(simd, n, group, first, pass.work);
            if first {
                self.sides(simd, n, (group, 0), &places, pass);
            }
            self.peaks(simd, n, (group, first), (maps, spread), &places, pass);
            first = false;
        }
        self.sides(simd, n, (group, 1), &places, pass);
        for i in 0..pass.work.seen.len() {
            let at = self.structure.degree_of(i);
            let Work { seen, watch, fastest, .. } = &mut *pass.work;
            seen[i].tell(simd, &mut watch[i]);
            watch[i].fastest = fastest[at];
        }
        self.arrive(simd, n, group, &places, pass);
        Ok(())
    }

    /// The points of every step of a group.
    #[inline(always)]
    pub(super) fn points<S: Simd>(
        &self,
        simd: S,
        group: &mut Group,
        pass: &mut Pass<'_, '_>,
        out: &mut Vec<Points>,
    ) -> Result<(), Stopped> {
        let n = self.structure.masses_kg.len();
        let d = self.structure.degrees();
        let places = Places::new(group.knots);
        self.read(simd, n, &places, &mut pass.work.input);
        let mut first = true;
        while group.next(self, pass.ground) {
            pass.pulse.beat(32 * d as u32)?;
            self.load(simd, n, group, first, pass.work);
            self.solve(simd, n, group, Some(&places), pass.work);
            first = false;
            let interfaces = 1 + self.structure.contents.len();
            let blank = [Eight::ZERO; POINTS];
            let mut rows = vec![blank; interfaces + 2];
            for end in 0..2 {
                let point = end * (POINTS - 1);
                self.ask(simd, n, group, end, pass.work);
                for (i, row) in rows[..interfaces].iter_mut().enumerate() {
                    let Work { input, path, bodies, .. } = &*pass.work;
                    let asked = if i == 0 {
                        pass.work.ends[end][FRICTION]
                    } else {
                        bodies[self.structure.degree_of(i)]
                    };
                    let speed = state_of(input, path, end, d + self.structure.degree_of(i), d);
                    row[point] = self.of_interface(simd, group, i, asked, speed);
                }
                let Work { input, path, .. } = &*pass.work;
                rows[interfaces][point] = state_of(input, path, end, 0, d);
                rows[interfaces + 1][point] = state_of(input, path, end, d, d);
            }
            for node in 0..NODES {
                let Work { path, trace, .. } = &*pass.work;
                for (i, row) in rows[..interfaces].iter_mut().enumerate() {
                    let asked = path[(NODES + 2) * d + i * NODES + node];
                    let speed = path[node * d + self.structure.degree_of(i)];
                    row[1 + node] = self.of_interface(simd, group, i, asked, speed);
                }
                rows[interfaces][1 + node] = trace[node * d];
                rows[interfaces + 1][1 + node] = path[node * d];
            }
            for lane in 0..group.count {
                let step = group.steps[lane];
                if step.step_s > 0.0 {
                    let values = rows.iter().map(|row| row.map(|point| point.0[lane])).collect();
                    out.push(Points { knot: group.knots[lane], step, values });
                }
            }
        }
        Ok(())
    }

    /// What is asked of an interface in stick, its speed in the direction claimed in slip.
    #[inline(always)]
    fn of_interface<S: Simd>(
        &self,
        simd: S,
        group: &Group,
        i: usize,
        asked: Eight,
        speed: Eight,
    ) -> Eight {
        let (stuck, sign) = match i.checked_sub(1) {
            None => (group.stuck, group.sign),
            Some(e) => (group.carried[e].stuck, group.carried[e].sign),
        };
        let speed = speed.load(simd) * sign.load(simd);
        let mut value = Eight::ZERO;
        let stuck = stuck.load(simd).simd_gt(all(simd, 0.0));
        value.store(stuck.select(asked.load(simd), speed));
        value
    }

    /// Forces at instants: `T` in `ends[0][FRICTION]`, accelerations in `bodies`.
    #[inline(always)]
    pub(super) fn instants<S: Simd>(
        &self,
        simd: S,
        group: &mut Group,
        ground: &Ground<'_>,
        work: &mut Work,
    ) {
        let n = self.structure.masses_kg.len();
        let places = Places::new(group.knots);
        self.read(simd, n, &places, &mut work.input);
        group.follow_normal(self, ground);
        self.load(simd, n, group, true, work);
        self.ask(simd, n, group, 0, work);
    }

    /// Outputs at instants, in `ends[0]`.
    #[inline(always)]
    pub(super) fn outputs_at<S: Simd>(
        &self,
        simd: S,
        group: &mut Group,
        (ground, outputs): (&Ground<'_>, &Outputs),
        work: &mut Work,
    ) {
        self.instants(simd, group, ground, work);
        self.end(simd, self.structure.masses_kg.len(), (group, 0), outputs, work);
    }

    /// Acceleration of an item of contents that [`instants`](Self::instants) or a node has found.
    pub(super) fn acceleration(&self, work: &Work, contents: usize, lane: usize) -> f64 {
        work.bodies[self.structure.degree_of(1 + contents)].0[lane]
    }

    /// Mass of the block with what sticks to it.
    pub(super) fn block_mass(&self, group: &Group, lane: usize) -> f64 {
        group.mass[0].0[lane]
    }

    /// `x, v` stored at the knots.
    #[inline(always)]
    fn read<S: Simd>(&self, simd: S, n: usize, places: &Places, input: &mut [Eight]) {
        let h = self.history;
        let d = self.structure.degrees();
        let e = d - 1 - n;
        input[0].store(places.read(simd, &h.sliding_displacement_m, 0, [1, 0]));
        input[d].store(places.read(simd, &h.sliding_velocity_m_per_s, 0, [1, 0]));
        for i in 0..n {
            input[1 + i].store(places.read(simd, &h.storey_displacement_m, 0, [n, i]));
            input[d + 1 + i].store(places.read(simd, &h.storey_velocity_m_per_s, 0, [n, i]));
        }
        for i in 0..e {
            let (r, p) = (&h.contents_displacement_m, &h.contents_velocity_m_per_s);
            input[1 + n + i].store(places.read(simd, r, 0, [e, i]));
            input[d + 1 + n + i].store(places.read(simd, p, 0, [e, i]));
        }
    }

    /// The loads of a step, and the state with which it starts after another; what sticks has no velocity.
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S, n: usize, group: &Group, first: bool, work: &mut Work) {
        let d = self.structure.degrees();
        if !first {
            let (from, to) = (NODES * d, (NODES + 2) * d);
            work.input[..2 * d].copy_from_slice(&work.path[from..to]);
            work.ends.swap(0, 1);
        }
        let moves = all(simd, 1.0) - group.stuck.load(simd);
        let w = work.input[d].load(simd) * moves;
        work.input[d].store(w);
        let shift = group.stop[2].load(simd);
        for end in 0..2 {
            let normal = group.normal[end].load(simd);
            let a = group.table[end].load(simd) + all(simd, self.slope);
            work.input[2 * d + end].store(a);
            let slid = normal * group.friction[0].load(simd) * moves;
            work.input[2 * d + 2 + end].store(slid + shift);
            for (e, carried) in group.carried.iter().enumerate() {
                let pull = carried.pull.load(simd) * normal;
                work.input[2 * d + 4 + 2 * e + end].store(pull);
            }
        }
        for (e, carried) in group.carried.iter().enumerate() {
            let p = work.input[d + 1 + n + e].load(simd);
            work.input[d + 1 + n + e].store(p * (all(simd, 1.0) - carried.stuck.load(simd)));
        }
    }

    /// Whether a force on the block follows `N` and `s`.
    fn follows(&self) -> bool {
        self.law.series.is_some() || self.law.is_pendulum()
    }

    /// Loads at a part of a step.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, group: &Group, input: &[Eight], part: f64) -> Now<S> {
        let d = self.structure.degrees();
        let linear = inlined(
            #[inline(always)]
            |from: &Eight, to: &Eight| {
                let from = from.load(simd);
                from + (to.load(simd) - from) * all(simd, part)
            },
        );
        Now {
            a: linear(&input[2 * d], &input[2 * d + 1]),
            load: linear(&input[2 * d + 2], &input[2 * d + 3]),
            rise: if self.follows() {
                linear(&group.rise[0], &group.rise[1])
            } else {
                all(simd, 0.0)
            },
            part,
        }
    }

    /// `μ m N/M` of contents that slide, over their mass, at a part of a step.
    #[inline(always)]
    fn pull<S: Simd>(&self, simd: S, input: &[Eight], e: usize, part: f64) -> f64x8<S> {
        let at = 2 * self.structure.degrees() + 4 + 2 * e;
        let from = input[at].load(simd);
        from + (input[at + 1].load(simd) - from) * all(simd, part)
    }

    /// The shear of the lowest storey and the pull of contents that slide on the block.
    #[inline(always)]
    fn on_block<S: Simd>(
        &self,
        simd: S,
        now: Now<S>,
        (x, v): (impl Fn(usize) -> f64x8<S> + Copy, impl Fn(usize) -> f64x8<S> + Copy),
        input: &[Eight],
    ) -> [f64x8<S>; 2] {
        let shear = self.base_force(
            simd,
            #[inline(always)]
            |j| x(1 + j),
            #[inline(always)]
            |j| v(1 + j),
        );
        let mut pull = all(simd, 0.0);
        let contents = self.structure.contents.iter().enumerate();
        for (e, contents) in contents.filter(|(_, contents)| contents.floor == 0) {
            pull += all(simd, contents.mass_kg) * self.pull(simd, input, e, now.part);
        }
        [shear, pull]
    }

    /// Accelerations of all bodies in a state: eqs (9), (10). Returns the shear of the lowest storey and
    /// the pull of contents that slide on the block.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // an instant
    fn accelerate<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        now: Now<S>,
        (x, v): (impl Fn(usize) -> f64x8<S> + Copy, impl Fn(usize) -> f64x8<S> + Copy),
        input: &[Eight],
        bodies: &mut [Eight],
    ) -> [f64x8<S>; 2] {
        let s = self.structure;
        let [shear, pull] = self.on_block(simd, now, (x, v), input);
        let shift = group.stop[2].load(simd);
        let force = match &self.law.rate {
            Some(_) => self.sliding_force(simd, v(0), now.load - shift) + shift,
            None => now.load,
        };
        let spring = all(simd, s.spring) + group.stop[0].load(simd) + now.rise;
        let damper = all(simd, s.damper) + group.stop[1].load(simd);
        let slider = force - damper * v(0) - spring * x(0);
        let sliding = (slider + shear + pull) * group.inverse[0].load(simd);
        let stuck = group.stuck.load(simd).simd_gt(all(simd, 0.0));
        let block = stuck.select(now.a, sliding);
        bodies[0].store(block);
        for k in 0..n {
            let below = if k == 0 { all(simd, 0.0) } else { x(k) };
            let mut force = all(simd, s.stiffnesses[k]) * (x(k + 1) - below);
            if k + 1 < n {
                let above = x(k + 2) - x(k + 1);
                force -= all(simd, s.stiffnesses[k + 1]) * above;
            }
            match &s.damping {
                StoreyDamping::Chain(c) => {
                    let below = if k == 0 { all(simd, 0.0) } else { v(k) };
                    force += all(simd, c[k]) * (v(k + 1) - below);
                    if k + 1 < n {
                        let above = v(k + 2) - v(k + 1);
                        force -= all(simd, c[k + 1]) * above;
                    }
                }
                StoreyDamping::Full(c) => {
                    for j in 0..n {
                        force += all(simd, c[k * n + j]) * v(1 + j);
                    }
                }
            }
            for (e, contents) in s.contents.iter().enumerate().filter(|(_, c)| c.floor == k + 1) {
                force -= all(simd, contents.mass_kg) * self.pull(simd, input, e, now.part);
            }
            bodies[1 + k].store(-(force * group.inverse[1 + k].load(simd)));
        }
        for (e, contents) in s.contents.iter().enumerate() {
            let under = bodies[contents.floor].load(simd);
            let stuck = group.carried[e].stuck.load(simd).simd_gt(all(simd, 0.0));
            let slides = -self.pull(simd, input, e, now.part);
            bodies[1 + n + e].store(stuck.select(under, slides));
        }
        [shear, pull]
    }

    /// `ẍ` of a degree from the accelerations of all bodies.
    #[inline(always)]
    fn rate<S: Simd>(
        &self,
        simd: S,
        (n, k): (usize, usize),
        a: f64x8<S>,
        bodies: &[Eight],
    ) -> f64x8<S> {
        let own = bodies[k].load(simd);
        if k == 0 {
            own - a
        } else if k <= n {
            own - bodies[0].load(simd)
        } else {
            own - bodies[self.structure.contents[k - 1 - n].floor].load(simd)
        }
    }

    /// `T`, in stick the demand: eqs (8), (14).
    #[inline(always)]
    fn friction<S: Simd>(
        &self,
        simd: S,
        group: &Group,
        now: Now<S>,
        (s, w): (f64x8<S>, f64x8<S>),
        [shear, pull]: [f64x8<S>; 2],
    ) -> f64x8<S> {
        let structure = self.structure;
        let shift = group.stop[2].load(simd);
        let spring = all(simd, structure.spring) + group.stop[0].load(simd) + now.rise;
        let held = group.mass[0].load(simd) * now.a - shear - pull + spring * s - shift;
        let slid = self.sliding_force(simd, w, now.load - shift);
        let slid = if self.law.series.is_some() { slid - now.rise * s } else { slid };
        group.stuck.load(simd).simd_gt(all(simd, 0.0)).select(held, slid)
    }

    /// Accelerations and `T` at the start (0) or the end (1) of a step.
    #[inline(always)]
    fn ask<S: Simd>(&self, simd: S, n: usize, group: &Group, end: usize, work: &mut Work) {
        let d = self.structure.degrees();
        let Work { input, path, bodies, ends, .. } = work;
        let now = self.at(simd, group, input, end as f64);
        let x = inlined(
            #[inline(always)]
            |k: usize| state_of(input, path, end, k, d).load(simd),
        );
        let v = inlined(
            #[inline(always)]
            |k: usize| state_of(input, path, end, d + k, d).load(simd),
        );
        let forces = if self.structure.contents.is_empty() {
            self.on_block(simd, now, (x, v), input)
        } else {
            self.accelerate(simd, n, group, now, (x, v), input, bodies)
        };
        let force = self.friction(simd, group, now, (x(0), v(0)), forces);
        ends[end][FRICTION].store(force);
    }

    /// The outputs at the start (0) or the end (1) of a step, from the equations.
    #[inline(always)]
    fn end<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (group, end): (&Group, usize),
        outputs: &Outputs,
        work: &mut Work,
    ) {
        let d = self.structure.degrees();
        let Work { input, path, bodies, ends, .. } = work;
        let now = self.at(simd, group, input, end as f64);
        let x = inlined(
            #[inline(always)]
            |k: usize| state_of(input, path, end, k, d).load(simd),
        );
        let v = inlined(
            #[inline(always)]
            |k: usize| state_of(input, path, end, d + k, d).load(simd),
        );
        self.outputs(
            simd,
            n,
            (group, outputs, now),
            (x, v),
            input,
            bodies,
            #[inline(always)]
            |g, value| ends[end][g].store(value),
        );
    }

    /// Hands on the outputs of a state under loads, its rates from the equations: what cancels in them is
    /// nothing. Against a rigid stop friction takes what it can of the demand, the stop the rest.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // an instant
    fn outputs<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (group, outputs, now): (&Group, &Outputs, Now<S>),
        (x, v): (impl Fn(usize) -> f64x8<S> + Copy, impl Fn(usize) -> f64x8<S> + Copy),
        input: &[Eight],
        bodies: &mut [Eight],
        out: impl FnMut(usize, f64x8<S>),
    ) {
        let structure = self.structure;
        let forces = self.accelerate(simd, n, group, now, (x, v), input, bodies);
        let asked = self.friction(simd, group, now, (x(0), v(0)), forces);
        let slope = all(simd, self.slope);
        let body = inlined(
            #[inline(always)]
            |k: usize| bodies[k].load(simd),
        );
        let [stiffness, damper] = both(
            #[inline(always)]
            |i| group.stop[i].load(simd),
        );
        let shift = group.stop[2].load(simd);
        let mut stop = stiffness * x(0) + damper * v(0) - shift;
        let restoring = if self.law.series.is_some() { all(simd, 0.0) } else { now.rise };
        let spring = (all(simd, structure.spring) + restoring) * x(0);
        let slider = asked - (spring + all(simd, structure.damper) * v(0)) - stop;
        let mut friction = asked;
        if self.law.restitution().is_some() {
            let [low, high] = both(
                #[inline(always)]
                |i| {
                    let [from, to] = both(
                        #[inline(always)]
                        |end| group.normal[end].load(simd),
                    );
                    group.taken[i].load(simd) * (from + (to - from) * all(simd, now.part))
                },
            );
            friction = smaller(larger(asked, low), high);
            stop += friction - asked;
        }
        let total = body(0);
        let moment = outputs.moment(
            simd,
            total,
            #[inline(always)]
            |j| body(1 + j),
            #[inline(always)]
            |e| body(1 + n + e),
        );
        let fixed = [v(0), total - slope, slider, friction, forces[0], moment, stop];
        each_output(
            simd,
            (n, structure.contents.len()),
            fixed,
            #[inline(always)]
            |j| [x(1 + j), body(1 + j) - slope],
            #[inline(always)]
            |e| [v(1 + n + e), body(1 + n + e) - slope],
            out,
        );
    }

    /// `ẍ` of a degree stored at the knots of lanes, or those after them.
    #[inline(always)]
    fn stored_rate<S: Simd>(
        &self,
        simd: S,
        (n, degree): (usize, usize),
        places: &Places,
        later: usize,
    ) -> f64x8<S> {
        let h = self.history;
        let floor = inlined(
            #[inline(always)]
            |floor: usize| match floor {
                0 => places.read(simd, &h.block_acceleration_m_per_s2, later, [1, 0]),
                i => places.read(simd, &h.storey_acceleration_m_per_s2, later, [n, i - 1]),
            },
        );
        if degree == 0 {
            floor(0) - places.read(simd, &h.table_acceleration_m_per_s2, later, [1, 0])
        } else if degree <= n {
            floor(degree) - floor(0)
        } else {
            let (e, contents) = (degree - 1 - n, &self.structure.contents);
            let list = &h.contents_acceleration_m_per_s2;
            places.read(simd, list, later, [contents.len(), e]) - floor(contents[e].floor)
        }
    }

    /// Solves the collocation equations of every lane by iteration, which begins with the line between
    /// the accelerations stored at the ends of the intervals.
    #[inline(always)]
    fn solve<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        stored: Option<&Places>,
        work: &mut Work,
    ) {
        let rule = self.rule;
        let d = self.structure.degrees();
        let Work { input, state, path, trace, bodies, .. } = work;
        let (places, rates) = trace.split_at_mut(NODES * d);
        let h = group.step_s.load(simd);
        let node = inlined(
            #[inline(always)]
            |rates: &[Eight], i: usize, k: usize| {
                let (mut dx, mut dv) = (all(simd, 0.0), all(simd, 0.0));
                for j in 0..NODES {
                    let rate = rates[j * d + k].load(simd);
                    dv += all(simd, rule.a[i][j]) * rate;
                    dx += all(simd, rule.aa[i][j]) * rate;
                }
                let (x0, v0) = (input[k].load(simd), input[d + k].load(simd));
                (x0 + h * (all(simd, rule.c[i]) * v0 + h * dx), v0 + h * dv)
            },
        );
        rates.fill(Eight::ZERO);
        if let Some(places) = stored {
            let per_s = all(simd, 1.0) / group.length_s.load(simd);
            let (before, width) = (group.before_s.load(simd) * per_s, h * per_s);
            for k in 0..d {
                let from = self.stored_rate(simd, (n, k), places, 0);
                let rise = self.stored_rate(simd, (n, k), places, 1) - from;
                for i in 0..NODES {
                    let part = before + width * all(simd, rule.c[i]);
                    rates[i * d + k].store(from + rise * part);
                }
            }
        }
        let rounding = if self.law.rate.is_none() { f64::INFINITY } else { ROUNDING };
        let mut last = Eight([f64::INFINITY; LANES]);
        for pass in 0..MOST_PASSES {
            let (mut change, mut size) = (all(simd, 0.0), all(simd, 0.0));
            for i in 0..NODES {
                for (k, (x, v)) in state.iter_mut().enumerate() {
                    let (place, speed) = node(rates, i, k);
                    x.store(place);
                    v.store(speed);
                }
                let x = inlined(
                    #[inline(always)]
                    |k: usize| state[k].0.load(simd),
                );
                let v = inlined(
                    #[inline(always)]
                    |k: usize| state[k].1.load(simd),
                );
                let now = self.at(simd, group, input, rule.c[i]);
                self.accelerate(simd, n, group, now, (x, v), input, bodies);
                for k in 0..d {
                    let rate = self.rate(simd, (n, k), now.a, bodies);
                    let old = &mut rates[i * d + k];
                    change = larger(change, (rate - old.load(simd)).abs());
                    size = larger(size, rate.abs());
                    old.store(rate);
                }
            }
            // The next pass would gain as much as this one.
            let next = change * change;
            let gained = all(simd, if pass > 0 { 0.5 * f64::EPSILON } else { -1.0 });
            let small = change.simd_le(all(simd, 2.0 * f64::EPSILON) * size)
                | next.simd_le(gained * size * last.load(simd));
            let stalled = change.simd_ge(all(simd, 0.5) * last.load(simd))
                & change.simd_le(all(simd, rounding) * size);
            if small.all_true() || (pass >= 8 && (small | stalled).all_true()) {
                break;
            }
            last.store(change);
        }
        for k in 0..d {
            let (mut dx, mut dv) = (all(simd, 0.0), all(simd, 0.0));
            for j in 0..NODES {
                let share = all(simd, rule.weights[j]) * rates[j * d + k].load(simd);
                dv += share;
                dx += share * all(simd, 1.0 - rule.c[j]);
            }
            let (x0, v0) = (input[k].load(simd), input[d + k].load(simd));
            path[NODES * d + k].store(x0 + h * (v0 + h * dx));
            path[(NODES + 1) * d + k].store(v0 + h * dv);
        }
        let asks = group.asks();
        for i in 0..NODES {
            for (k, (x, v)) in state.iter_mut().enumerate() {
                let (place, speed) = node(rates, i, k);
                x.store(place);
                v.store(speed);
                places[i * d + k].store(place);
                path[i * d + k].store(speed);
            }
            let x = inlined(
                #[inline(always)]
                |k: usize| state[k].0.load(simd),
            );
            let v = inlined(
                #[inline(always)]
                |k: usize| state[k].1.load(simd),
            );
            if !asks {
                continue;
            }
            let now = self.at(simd, group, input, rule.c[i]);
            let forces = if d == 1 + n {
                self.on_block(simd, now, (x, v), input)
            } else {
                self.accelerate(simd, n, group, now, (x, v), input, bodies)
            };
            let asked = self.friction(simd, group, now, (x(0), v(0)), forces);
            path[(NODES + 2) * d + i].store(asked);
            for e in 0..d - 1 - n {
                path[(NODES + 2) * d + (1 + e) * NODES + i] = bodies[1 + n + e];
            }
        }
    }

    /// Work and losses, and the largest velocities.
    #[inline(always)]
    fn spend<S: Simd>(&self, simd: S, n: usize, group: &Group, solved: bool, work: &mut Work) {
        let s = self.structure;
        let d = s.degrees();
        let zero = all(simd, 0.0);
        let (mut done, mut size, mut damping, mut friction) = (zero, zero, zero, zero);
        let h = group.step_s.load(simd);
        let Work { input, path, trace, fastest, .. } = work;
        let [stiffness, damper] = both(
            #[inline(always)]
            |i| group.stop[i].load(simd),
        );
        let shift = group.stop[2].load(simd);
        let follows = self.follows();
        for node in 0..NODES {
            let v = inlined(
                #[inline(always)]
                |k: usize| path[node * d + k].load(simd),
            );
            let now = self.at(simd, group, input, self.rule.c[node]);
            let weight = h * all(simd, self.rule.weights[node]);
            let mut momentum = all(simd, s.total_kg) * v(0);
            for (k, fastest) in fastest.iter_mut().enumerate() {
                let speed = v(k);
                keep(simd, fastest, speed.abs());
                if (1..=n).contains(&k) {
                    momentum += all(simd, s.masses_kg[k - 1]) * speed;
                }
            }
            for (e, contents) in s.contents.iter().enumerate() {
                let mass = all(simd, contents.mass_kg);
                let mut speed = v(1 + n + e);
                if contents.floor > 0 {
                    speed += v(contents.floor);
                }
                momentum += mass * speed;
                let pull = self.pull(simd, input, e, now.part);
                friction += weight * mass * pull * v(1 + n + e);
            }
            let power = momentum * now.a;
            done -= weight * power;
            size += weight * power.abs();
            damping += weight
                * (damper * v(0) * v(0)
                    + self.dissipation(
                        simd,
                        v(0),
                        #[inline(always)]
                        |j| v(1 + j),
                    ));
            let mut force = self.sliding_force(simd, v(0), now.load - shift);
            if follows && solved {
                force -= now.rise * trace[node * d].load(simd);
            }
            friction -= weight * force * v(0);
        }
        let [from, to] = [input[0].load(simd), path[NODES * d].load(simd)];
        let half = all(simd, 0.5);
        // What the stop's spring takes, and a spring that follows a constant N, is exact.
        damping += half * stiffness * (to * to - from * from) - shift * (to - from);
        if follows {
            let stored = half * group.rise[0].load(simd) * (to * to - from * from);
            if !solved {
                friction += stored;
            }
            // What such a spring gives back is work put in.
            size += larger(zero, -stored);
        }
        let spent = &mut work.spent;
        spent.work.store(spent.work.load(simd) + done);
        spent.size.store(spent.size.load(simd) + size);
        spent.damping.store(spent.damping.load(simd) + damping);
        spent.friction.store(spent.friction.load(simd) + friction);
    }

    /// Compares the ends of the paths with the knots stored there.
    #[inline(always)]
    fn arrive<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        places: &Places,
        pass: &mut Pass<'_, '_>,
    ) {
        let (h, s) = (self.history, self.structure);
        let (d, e) = (s.degrees(), s.contents.len());
        let (worst, work) = (&mut *pass.worst, &mut *pass.work);
        let instant = all(simd, self.instant_s);
        // What the rounding of N makes of velocities, places and energies.
        let rounding = group.normal_rounding.load(simd);
        let (mut drift, mut drift_m) = (all(simd, 0.0), all(simd, 0.0));
        if self.vertical {
            let length_s = group.length_s.load(simd);
            let force = group.slides.load(simd) * rounding;
            drift = force * all(simd, 1.0 / s.least_kg()) * length_s;
            drift_m = all(simd, 0.5) * length_s * drift;
            let mut speed = all(simd, 0.0);
            let mut moved = all(simd, 0.0);
            for i in 0..d {
                speed += work.fastest[i].load(simd);
            }
            for i in 0..=e {
                let at = s.degree_of(i);
                let (list, stride) = if i == 0 {
                    (&h.sliding_displacement_m, [1, 0])
                } else {
                    (&h.contents_displacement_m, [e, i - 1])
                };
                let from = places.read(simd, list, 0, stride);
                moved += (work.path[NODES * d + at].load(simd) - from).abs();
            }
            work.spent.blur.store(force * moved + all(simd, s.total_kg) * speed * drift);
        }
        for i in 0..d {
            let (lists, at) = if i == 0 {
                ([&h.sliding_displacement_m, &h.sliding_velocity_m_per_s], [1, 0])
            } else if i <= n {
                ([&h.storey_displacement_m, &h.storey_velocity_m_per_s], [n, i - 1])
            } else {
                ([&h.contents_displacement_m, &h.contents_velocity_m_per_s], [e, i - 1 - n])
            };
            let rates = both(
                #[inline(always)]
                |k| self.stored_rate(simd, (n, i), places, k).abs(),
            );
            let x = work.path[NODES * d + i].load(simd);
            let v = work.path[(NODES + 1) * d + i].load(simd);
            let fastest = work.fastest[i].load(simd);
            let off = (places.read(simd, lists[0], 1, at) - x).abs() - instant * fastest - drift_m;
            keep(simd, &mut worst.displacement[0], off);
            let rate = larger(rates[0], rates[1]);
            let off = (places.read(simd, lists[1], 1, at) - v).abs() - instant * rate - drift;
            keep(simd, &mut worst.velocity[0], off);
            // Between two knots the motion may be faster and go farther than at any.
            keep(simd, &mut worst.displacement[1], x.abs());
            keep(simd, &mut worst.velocity[1], fastest);
        }
        keep(simd, &mut worst.drift[0], drift_m);
        keep(simd, &mut worst.drift[1], drift);
        let slides = all(simd, 1.0) - group.stuck.load(simd);
        keep(simd, &mut worst.sliding, work.fastest[0].load(simd) * slides);
    }

    /// Margins of what sticks and speeds of what slides at the points of a step.
    #[inline(always)]
    fn watch<S: Simd>(&self, simd: S, n: usize, group: &Group, first: bool, work: &mut Work) {
        let (s, d) = (self.structure, self.structure.degrees());
        let asks = group.asks();
        let zero = all(simd, 0.0);
        for point in 0..POINTS {
            if point == 0 && !first {
                continue;
            }
            let end = if point == 0 { 0 } else { 1 };
            let is_node = (1..=NODES).contains(&point);
            if !is_node && asks {
                self.ask(simd, n, group, end, work);
            }
            let part = self.rule.points[point];
            let Work { input, path, bodies, ends, seen, .. } = &mut *work;
            let [from, to] = both(
                #[inline(always)]
                |end| group.normal[end].load(simd),
            );
            let normal = from + (to - from) * all(simd, part);
            for (i, seen) in seen.iter_mut().enumerate() {
                let at = s.degree_of(i);
                let (asked, speed) = if is_node {
                    let asked = path[(NODES + 2) * d + i * NODES + point - 1];
                    (asked, path[(point - 1) * d + at])
                } else {
                    let asked = if i == 0 { ends[end][FRICTION] } else { bodies[at] };
                    (asked, state_of(input, path, end, d + at, d))
                };
                let (stuck, sign) = match i.checked_sub(1) {
                    None => (group.stuck, group.sign),
                    Some(e) => (group.carried[e].stuck, group.carried[e].sign),
                };
                let mut value = sign.load(simd) * speed.load(simd);
                if stuck.0 != Eight::ZERO.0 {
                    let per_n = asked.load(simd) / normal;
                    let margin = match i.checked_sub(1) {
                        None => {
                            let [low, high] = both(
                                #[inline(always)]
                                |i| group.hold[i].load(simd),
                            );
                            let below = (per_n - low) * group.scale[0].load(simd);
                            smaller((high - per_n) * group.scale[1].load(simd), below)
                        }
                        Some(e) => {
                            let fixed = s.contents[e].static_friction / s.total_kg;
                            all(simd, 1.0) - per_n.abs() * all(simd, 1.0 / fixed)
                        }
                    };
                    value = stuck.load(simd).simd_gt(zero).select(margin, value);
                }
                if point == 0 {
                    seen.start(value);
                } else {
                    seen.take(simd, value);
                }
            }
        }
    }

    /// Compares what is stored at the start (0) or the end (1) of intervals with the loads: the table's
    /// acceleration, forces of sliding, and where more acts on the block, its acceleration.
    #[inline(always)]
    fn sides<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (group, end): (&Group, usize),
        places: &Places,
        pass: &mut Pass<'_, '_>,
    ) {
        let (h, s) = (self.history, self.structure);
        let d = s.degrees();
        let slides = all(simd, 1.0) - group.stuck.load(simd);
        let drift = all(simd, self.instant_s) * group.drift.load(simd).abs();
        let rounding = group.normal_rounding.load(simd);
        let table = places.read(simd, &h.table_acceleration_m_per_s2, end, [1, 0]);
        let off = (group.table[end].load(simd) - table).abs() - drift;
        keep(simd, &mut pass.worst.table, off);
        let force = places.read(simd, &h.friction_force_n, end, [1, 0]);
        let s_stored = places.read(simd, &h.sliding_displacement_m, end, [1, 0]);
        let w = places.read(simd, &h.sliding_velocity_m_per_s, end, [1, 0]);
        let load = pass.work.input[2 * d + 2 + end].load(simd) - group.stop[2].load(simd);
        let mut own = self.sliding_force(simd, w, load);
        if self.law.series.is_some() {
            own -= group.rise[end].load(simd) * s_stored;
        }
        let most = all(simd, self.law.most());
        let off = (force - own).abs() - most * rounding;
        keep(simd, &mut pass.worst.excess, off * slides);
        for (e, contents) in s.contents.iter().enumerate() {
            let list = &h.contents_acceleration_m_per_s2;
            let stored =
                places.read(simd, list, end, [s.contents.len(), e]) + all(simd, self.slope);
            let own = -self.pull(simd, &pass.work.input, e, end as f64);
            let mass = all(simd, contents.mass_kg);
            let mu = contents.kinetic_friction * contents.mass_kg / s.total_kg;
            let off = mass * (stored - own).abs() - all(simd, mu) * rounding;
            let moves = all(simd, 1.0) - group.carried[e].stuck.load(simd);
            keep(simd, &mut pass.worst.force[0], off * moves);
        }
        if self.law.is_pendulum() || self.law.restitution().is_some() {
            self.end(simd, n, (group, end), pass.outputs, pass.work);
            let own_force = pass.work.ends[end][FRICTION].load(simd);
            let own_block = pass.work.ends[end][BLOCK].load(simd);
            let block = places.read(simd, &h.block_acceleration_m_per_s2, end, [1, 0]);
            let off = larger(
                (own_force - force).abs() * group.stuck.load(simd),
                all(simd, s.block_kg) * (own_block - block).abs(),
            );
            let rounding = all(simd, s.total_kg) * drift + most * rounding;
            keep(simd, &mut pass.worst.force[0], off - rounding);
            let stop = pass.work.ends[end][STOP].load(simd);
            keep(simd, &mut pass.worst.force[1], larger(own_force.abs(), stop.abs()));
        }
    }

    /// Raises the peaks by the paths of a step where some output may pass them.
    #[inline(always)]
    fn peaks<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (group, first): (&Group, bool),
        (maps, spread): (Option<&Maps>, Option<&Spread>),
        places: &Places,
        pass: &mut Pass<'_, '_>,
    ) {
        let Pass { work, attained, outputs, knots, .. } = pass;
        // Knots tell the outputs at the ends of an interval, the step before those at its start.
        let tell = self.law.restitution().is_none();
        let told = [first && tell, tell && group.is_last_step()];
        let mut passes = (1 << LANES) - 1;
        if !told[0] && first {
            self.end(simd, n, (group, 0), outputs, work);
        }
        if !told[1] {
            self.end(simd, n, (group, 1), outputs, work);
        }
        if let Some(spread) = spread {
            let share = group.step_s.load(simd) * all(simd, 1.0 / spread.longest_s);
            // Of longer steps nothing is known.
            passes = share.simd_gt(all(simd, 1.0 + 1e-9)).to_bitmask();
            for (g, bounds) in &spread.leaving {
                let mut off = all(simd, 0.0);
                for &(input, bound) in bounds {
                    off += all(simd, bound) * work.input[input].load(simd).abs();
                }
                let list = &knots.outputs[g * knots.stride..][..knots.stride];
                let [first, last] = both(
                    #[inline(always)]
                    |end| match told[end] {
                        true => places.read(simd, list, end, [1, 0]),
                        false => work.ends[end][*g].load(simd),
                    },
                );
                let most = larger(first.abs(), last.abs()) + share * off;
                let limit = all(simd, attained[*g] * (1.0 + 1e-12));
                passes |= most.simd_gt(limit).to_bitmask();
            }
        }
        // Nor is what a rigid stop or the spring of a pendulum does known from the knots.
        if self.law.is_pendulum() {
            passes = (1 << LANES) - 1;
        } else if self.law.restitution().is_some() {
            let free = all(simd, UNBOUNDED);
            let [low, high] = both(
                #[inline(always)]
                |i| group.taken[i].load(simd).abs(),
            );
            passes |= smaller(low, high).simd_lt(free).to_bitmask();
        }
        for end in 0..2 {
            if told[end] && passes != 0 {
                self.end(simd, n, (group, end), outputs, work);
            }
        }
        if passes != 0 {
            if let Some(maps) = maps {
                apply(simd, &maps.places, work, true);
            }
            self.trace(simd, n, group, outputs, work);
            for (g, nodes) in work.values.chunks_exact(NODES).enumerate() {
                let ends = both(
                    #[inline(always)]
                    |end| work.ends[end][g].load(simd),
                );
                self.seek(simd, passes, ends, nodes, &mut attained[g]);
            }
        }
    }

    /// Outputs at the nodes of a step.
    #[inline(always)]
    fn trace<S: Simd>(&self, simd: S, n: usize, group: &Group, outputs: &Outputs, work: &mut Work) {
        let d = self.structure.degrees();
        let Work { input, path, bodies, trace: traced, values, .. } = work;
        for i in 0..NODES {
            let now = self.at(simd, group, input, self.rule.c[i]);
            let x = inlined(
                #[inline(always)]
                |k: usize| traced[i * d + k].load(simd),
            );
            let v = inlined(
                #[inline(always)]
                |k: usize| path[i * d + k].load(simd),
            );
            self.outputs(
                simd,
                n,
                (group, outputs, now),
                (x, v),
                input,
                bodies,
                #[inline(always)]
                |g, value| values[g * NODES + i].store(value),
            );
        }
    }

    /// Raises a peak to the largest size of an output in the lanes that may pass it, from its values at the
    /// ends and the nodes.
    #[inline(always)]
    fn seek<S: Simd>(
        &self,
        simd: S,
        passes: u64,
        ends: [f64x8<S>; 2],
        nodes: &[Eight],
        peak: &mut f64,
    ) {
        let (mut least, mut most) = (smaller(ends[0], ends[1]), larger(ends[0], ends[1]));
        for node in nodes {
            let value = node.load(simd);
            (least, most) = (smaller(least, value), larger(most, value));
        }
        let size = larger(most.abs(), least.abs());
        let sizes = size.to_array();
        for lane in (0..LANES).filter(|lane| passes & (1 << lane) != 0) {
            *peak = greatest(*peak, sizes[lane]);
        }
        // Between two points the polynomial rises above both by less than a tenth of its range.
        let bound = size + (most - least) * all(simd, 0.1);
        let open = bound.simd_gt(all(simd, *peak * (1.0 + 1e-12))).to_bitmask() & passes;
        for lane in (0..LANES).filter(|lane| open & (1 << lane) != 0) {
            let mut points = [0.0; POINTS];
            let [first, last] = ends.map(|end| end.to_array()[lane]);
            (points[0], points[POINTS - 1]) = (first, last);
            for (point, node) in points[1..].iter_mut().zip(nodes) {
                *point = node.0[lane];
            }
            raise(self.rule, peak, &points);
        }
    }

    /// The maps of a key's step, and bounds on its outputs in steps up to the longest.
    #[inline(always)]
    pub(super) fn maps<S: Simd>(
        &self,
        simd: S,
        (key, outputs): (&Key, &Outputs),
        (even_s, longest_s): (Option<f64>, f64),
        work: &mut Work,
    ) -> (Option<Maps>, Spread) {
        let n = self.structure.masses_kg.len();
        let (d, count) = (self.structure.degrees(), work.input.len());
        let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); outputs.len()];
        let group = Group::of_key(self, key, longest_s);
        for from in (0..count).step_by(LANES) {
            set_units(&mut work.input, from);
            self.solve(simd, n, &group, None, work);
            for end in 0..2 {
                self.end(simd, n, (&group, end), outputs, work);
            }
            self.trace(simd, n, &group, outputs, work);
            for (g, nodes) in work.values.chunks_exact(NODES).enumerate() {
                for lane in 0..LANES.min(count - from) {
                    let [first, last] = [0, 1].map(|end| work.ends[end][g].0[lane]);
                    let value = |i: usize| nodes[i].0[lane];
                    let chord = |t: f64| first + (last - first) * t;
                    let off = |i: usize| (value(i) - chord(self.rule.c[i])).abs();
                    let most = (0..NODES).map(off).fold(0.0, f64::max);
                    let size = (0..NODES)
                        .map(value)
                        .fold(first.abs().max(last.abs()), |a, b| b.abs().max(a));
                    // What is linear leaves it by rounding only; between two points the output may leave
                    // the chord a little further than at any.
                    if most > 1e-14 * size {
                        rows[g].push((from + lane, 1.25 * most));
                    }
                }
            }
        }
        let leaving = rows.into_iter().enumerate().filter(|(_, row)| !row.is_empty()).collect();
        let spread = Spread { longest_s, leaving };
        let Some(even_s) = even_s else { return (None, spread) };
        let group = Group::of_key(self, key, even_s);
        let (mut paths, mut places) = (Vec::new(), Vec::new());
        for from in (0..count).step_by(LANES) {
            set_units(&mut work.input, from);
            self.solve(simd, n, &group, None, work);
            for lane in 0..LANES.min(count - from) {
                paths.extend(work.path.iter().map(|row| row.0[lane]));
                places.extend(work.trace[..NODES * d].iter().map(|row| row.0[lane]));
            }
        }
        // What sticks has no velocity.
        let interfaces = 1 + self.structure.contents.len();
        let zero: Vec<usize> = (0..interfaces)
            .filter(|i| key.stuck >> i & 1 == 1)
            .map(|i| d + self.structure.degree_of(i))
            .collect();
        let [path, places] = [paths, places].map(|columns| Map::new(&zero, count, &columns));
        (Some(Maps { path, places }), spread)
    }
}

/// Unit inputs from one on, one a lane.
fn set_units(input: &mut [Eight], from: usize) {
    input.fill(Eight::ZERO);
    for (lane, input) in input.iter_mut().skip(from).take(LANES).enumerate() {
        input.0[lane] = 1.0;
    }
}

/// An entry of the state at the start of a path (0) or at its end (1).
#[inline(always)]
fn state_of(input: &[Eight], path: &[Eight], end: usize, entry: usize, degrees: usize) -> Eight {
    if end == 0 { input[entry] } else { path[NODES * degrees + entry] }
}

impl Extremes {
    #[inline(always)]
    fn start<S: Simd>(&mut self, first: f64x8<S>) {
        for place in [&mut self.first, &mut self.least, &mut self.most, &mut self.last] {
            place.store(first);
        }
        (self.rises, self.falls) = (Eight::ZERO, Eight::ZERO);
    }

    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, value: f64x8<S>) {
        let (one, last) = (all(simd, 1.0), self.last.load(simd));
        self.least.store(smaller(self.least.load(simd), value));
        self.most.store(larger(self.most.load(simd), value));
        self.rises.store(value.simd_gt(last).select(one, self.rises.load(simd)));
        self.falls.store(value.simd_lt(last).select(one, self.falls.load(simd)));
        self.last.store(value);
    }

    /// The least, and what it cannot fall below in between.
    #[inline(always)]
    fn tell<S: Simd>(&self, simd: S, told: &mut Watch<Eight>) {
        let least = self.least.load(simd);
        let range = self.most.load(simd) - least;
        let flat = range.simd_le(all(simd, 4e-12));
        // Between two points the polynomial falls below both by less than a tenth of its range.
        let low = (self.rises.load(simd) * self.falls.load(simd))
            .simd_gt(all(simd, 0.0))
            .select(least - range * all(simd, 0.1), all(simd, f64::INFINITY));
        told.low.store(flat.select(least, low));
        (told.least, told.ends) = (self.least, [self.first, self.last]);
    }
}

/// What a map makes of the inputs of every lane: the path, or its places.
#[inline(always)]
fn apply<S: Simd>(simd: S, map: &Map, work: &mut Work, places: bool) {
    let Work { input, active, path, trace, .. } = work;
    let out = if places { trace } else { path };
    let count = map.inputs.len();
    for (active, &j) in active.iter_mut().zip(&map.inputs) {
        *active = input[j];
    }
    for &row in &map.blank {
        out[row] = Eight::ZERO;
    }
    for (&row, entries) in map.rows.iter().zip(map.entries.chunks_exact(count)) {
        let mut sum = all(simd, 0.0);
        for (&c, input) in entries.iter().zip(active.iter()) {
            sum += all(simd, c) * input.load(simd);
        }
        out[row].store(sum);
    }
}
