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

use super::super::collocation::MAX_TURN;
use super::super::ground::{Ground, Load, between};
use super::super::lane::{Eight, LANES, all};
use super::super::law::{BOUNDLESS, Push, StickDemand, UNBOUNDED};
use super::knots::LaneJudge;
use crate::response::Mode;

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
#[derive(Clone, Copy, Default)]
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

    pub(super) fn next(&mut self, ground: &mut Ground<'_>) -> Option<Step> {
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
#[derive(Clone, Copy)]
pub(super) struct Course<'a> {
    pub(super) knot: usize,
    pub(super) modes: &'a [Mode],
    /// `p₀, p₁`.
    pub(super) friction: [f64; 2],
    /// `p₂`, and between which speeds: of friction by speed in a straight piece. `None`: by `μ(|ṡ|)`.
    pub(super) piece: Option<(f64, [f64; 2])>,
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
    /// `N p₂`.
    pub(super) drag: f64,
}

/// Contents in lanes.
#[derive(Clone, Copy, Default)]
pub(super) struct Carried {
    pub(super) stuck: Eight,
    pub(super) sign: Eight,
    /// `sgn ṙ μ_k/M`; 0 in stick.
    pub(super) pull: Eight,
}

/// Intervals to be judged side by side; the last stands for the lanes that are left.
#[derive(Default)]
pub(super) struct Group {
    pub(super) count: usize,
    pub(super) knots: [usize; LANES],
    pub(super) feeds: [Feed; LANES],
    pub(super) steps: [Step; LANES],
    /// Of the step under way: its length, what lies before it, and the length of the interval.
    pub(super) step_s: Eight,
    pub(super) before_s: Eight,
    pub(super) length_s: Eight,
    pub(super) table: [Eight; 2],
    pub(super) normal: [Eight; 2],
    pub(super) rise: [Eight; 2],
    pub(super) drift: Eight,
    /// Rounding of `N`, the largest on the way.
    pub(super) normal_rounding: Eight,
    pub(super) stuck: Eight,
    pub(super) sign: Eight,
    pub(super) friction: [Eight; 2],
    /// Whether friction by speed is in a straight piece: `N p₂`, and between which speeds.
    pub(super) affine: bool,
    pub(super) drag: Eight,
    pub(super) band: [Eight; 2],
    /// Stiffness, damper and shift of an elastic stop.
    pub(super) stop: [Eight; 3],
    pub(super) hold: [Eight; 2],
    /// What the margins towards them are measured by, inverted: the bound on the demand's side, or the
    /// larger one where both are on one.
    pub(super) scale: [Eight; 2],
    pub(super) taken: [Eight; 2],
    pub(super) slides: Eight,
    /// Whether all intervals are of one step.
    pub(super) at_once: bool,
    /// Masses of the block and the floors with what sticks to them, and their inverses.
    pub(super) mass: Vec<Eight>,
    pub(super) inverse: Vec<Eight>,
    pub(super) carried: Vec<Carried>,
}

impl Group {
    pub(super) fn new(bench: &LaneJudge<'_>) -> Self {
        let s = bench.structure;
        let masses = || core::iter::once(s.block_kg).chain(s.masses_kg.iter().copied());
        Self {
            at_once: true,
            mass: masses().map(|m| Eight([m; LANES])).collect(),
            inverse: masses().map(|m| Eight([1.0 / m; LANES])).collect(),
            carried: vec![Carried::default(); s.contents.len()],
            ..Self::default()
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
        for (scale, demand) in self.scale.iter_mut().zip([-1.0, 1.0]) {
            let bound = StickDemand { demand, low, high }.bound();
            scale.0[lane] = 1.0 / if bound < UNBOUNDED { bound } else { 1.0 };
        }
        for i in 0..2 {
            self.friction[i].0[lane] = course.friction[i];
            self.hold[i].0[lane] = course.hold[i];
            self.taken[i].0[lane] = course.taken[i];
        }
        for (stop, value) in self.stop.iter_mut().zip(course.push.numbers()) {
            stop.0[lane] = value;
        }
        self.affine = course.piece.is_some();
        let (per_n, band) = course.piece.unwrap_or((0.0, BOUNDLESS));
        self.drag.0[lane] = per_n * course.feed.loads[0].normal;
        for (lanes, speed) in self.band.iter_mut().zip(band) {
            lanes.0[lane] = speed;
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
        group.affine = true;
        for lane in 0..LANES {
            group.step_s.0[lane] = step_s;
            group.stuck.0[lane] = if key.stuck & 1 == 1 { 1.0 } else { 0.0 };
            group.stop[0].0[lane] = key.push[0];
            group.stop[1].0[lane] = key.push[1];
            group.drag.0[lane] = key.drag;
            for end in 0..2 {
                group.rise[end].0[lane] = key.rise;
            }
            group.taken[0].0[lane] = BOUNDLESS[0];
            group.taken[1].0[lane] = BOUNDLESS[1];
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
            .chain([&mut self.drag])
            .chain(&mut self.band)
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
        if !self.at_once {
            self.feeds[from..].fill(feed);
        }
    }

    /// 1 where an interface sticks, and the sign of its sliding.
    #[inline(always)]
    pub(super) fn interface(&self, i: usize) -> [&Eight; 2] {
        match i.checked_sub(1).map(|e| &self.carried[e]) {
            None => [&self.stuck, &self.sign],
            Some(carried) => [&carried.stuck, &carried.sign],
        }
    }

    pub(super) fn knot(&self, lane: usize) -> usize {
        self.knots[lane]
    }

    /// All lanes are intervals of one step of this length.
    #[inline(always)]
    pub(super) fn set_length<S: Simd>(&mut self, simd: S, length: f64x8<S>) {
        self.before_s.store(all(simd, 0.0));
        self.step_s.store(length);
        self.length_s.store(length);
    }

    /// Goes on by a step; a lane that has arrived waits in steps of no length. Whether any goes on.
    pub(super) fn next(&mut self, bench: &LaneJudge<'_>, ground: &mut Ground<'_>) -> bool {
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

    /// Whether all sliders stick.
    pub(super) fn sticks(&self) -> bool {
        self.stuck.0 == [1.0; LANES]
    }

    /// Whether anything sticks.
    pub(super) fn asks(&self) -> bool {
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
    pub(super) fn follow_normal(&mut self, bench: &LaneJudge<'_>, ground: &Ground<'_>) {
        if bench.vertical {
            for lane in 0..LANES {
                let rounding = self.steps[lane].loads[0].normal_rounding(ground.blur());
                let most = &mut self.normal_rounding.0[lane];
                *most = most.max(rounding);
            }
        }
        if !bench.law.follows() {
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
