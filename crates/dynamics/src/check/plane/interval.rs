//! The own motion from a knot to the next.

use super::super::collocation::POINTS;
use super::super::rate::SpeedLine;
use super::super::structure::{excess, larger};
use super::decisions::is_straight;
use super::frame::{Loads, Pair, State, dot, norm, pair, unit};
use super::judge::{Place, PlaneJudge};
use super::peaks::Tracked;
use super::step::{FINE, Step, Stretch, time_to_rest};
use crate::error::Stopped;
use crate::numerics::instructions::vectorize;
use crate::response::Mode;

/// Part of the peak speed of a slip below which it is near rest: where it is straight, rounding tells its direction.
const NEAR_REST: f64 = 1e-6;
/// A way to rest shorter than this is its end, in m: what friction does on it is known. In straight motion it
/// does nothing but slow down.
const SHORTEST_M: f64 = 1e-26;
const SHORTEST_STRAIGHT_M: f64 = 2e-18;
/// Defect of a step over the largest velocity.
const DEFECT: f64 = 2e-15;
/// Largest last Legendre coefficient over the largest force: beyond it they say nothing.
const TAIL: f64 = 1e-4;
/// A speed is at a corner of friction by straight lines within this part of it.
const AT_CORNER: f64 = 16.0 * f64::EPSILON;
/// Most cuts of a step to a corner.
const MOST_CUTS: u32 = 8;
/// Most halvings to tell a peak.
const DEEPEST: u32 = 12;
/// Most steps of an interval.
const MOST_STEPS: usize = 100_000;

/// The path through an interval so far.
struct IntervalPath {
    knot: usize,
    state: State,
    /// Largest velocities and their rates.
    fastest: Vec<f64>,
    rates: Vec<f64>,
    /// Whether the block is at rest for good in a slip, and how long it has been when the interval ends.
    rested_s: Option<f64>,
}

/// How far a slip goes without coming to rest.
enum Reach {
    Free,
    /// For so long at least.
    Within(f64),
    /// It comes to rest after so long.
    Rest(f64),
    /// It passes rest at once.
    Turn,
}

impl<'a> PlaneJudge<'a> {
    /// Judges the interval from a knot to the next.
    pub(super) fn interval(&mut self, k: usize) -> Result<(), Stopped> {
        let [from_s, end_s] = [self.h.time_s[k], self.h.time_s[k + 1]];
        let d = self.frame().degrees();
        let mut path = IntervalPath {
            knot: k,
            state: self.state(k),
            fastest: vec![0.0; d],
            rates: vec![0.0; d],
            rested_s: None,
        };
        let slips = self.mode(k) != Mode::Stick;
        if !slips {
            path.state.v[..2].fill(0.0);
        }
        let (mut at_s, mut state_rounding) = (from_s, 0.0);
        while at_s < end_s {
            let grounds = [&mut self.ground, &mut self.axes.ground_y];
            let pieces = grounds.map(|ground| ground.piece(at_s, end_s));
            let to_s = pieces[0].to_s.min(pieces[1].to_s);
            let loads = [0, 1].map(|end| [0, 1].map(|axis| pieces[axis].loads[end]));
            if at_s == from_s {
                if !self.ground.is_at_sample(from_s) {
                    self.unsure_n = larger(self.unsure_n, self.rounding(&loads[0]));
                }
                let side = self.side(k, &loads[0], Place::Start);
                self.take(&side);
            }
            if to_s >= end_s {
                let side = self.side(k + 1, &loads[1], Place::End);
                self.take(&side);
            }
            state_rounding =
                f64::max(state_rounding, self.normal_rounding_of_state(&path.state, &loads[0]));
            let (step_s, pressed) = (to_s - at_s, path.state.pressed);
            let stretch = Stretch { from_s: at_s, step_s, loads, line: None, pressed };
            if slips {
                self.slide(&mut path, &stretch)?;
            } else {
                self.rest(&mut path, &stretch)?;
            }
            at_s = to_s;
        }
        self.ends(&path, state_rounding);
        Ok(())
    }

    /// What the rounding of `N` makes of the force on the block.
    fn normal_rounding_of_state(&self, state: &State, loads: &Loads) -> f64 {
        let frame = self.frame();
        let normal_n = loads[0].normal_rounding(self.ground.load_rounding());
        let follows = frame.curvature_per_m * norm([state.x[0], state.x[1]]);
        frame.most * self.pressed_rounding(&loads[0]) + follows * normal_n
    }

    /// Compares the end of the path with what is stored there.
    fn ends(&mut self, path: &IntervalPath, drift_n: f64) {
        let (k, instant_s) = (path.knot, self.instant_s);
        let length_s = self.h.time_s[k + 1] - self.h.time_s[k];
        let state_rounding = self.take_state_rounding(drift_n / self.frame().least_kg(), length_s);
        for i in 0..path.fastest.len() {
            let end = [path.state.x[i], path.state.v[i]];
            self.arrive((k + 1, i), end, [path.fastest[i], path.rates[i]], state_rounding);
        }
        let (end, stored) = (path.state.speed(), self.state(k + 1).speed());
        self.dips[0].widen(norm([end[0] - stored[0], end[1] - stored[1]]));
        self.axes.arrived = norm(end);
        if self.ground.has_vertical() {
            let speed: f64 = path.fastest.iter().sum();
            let moved = path.fastest[0].max(path.fastest[1]) * length_s;
            self.books.load_rounding[k] +=
                drift_n * moved + self.frame().total_kg * speed * state_rounding[1];
        }
        let Some(rested_s) = path.rested_s else { return };
        let loads = self.instant(self.h.time_s[k + 1])[0];
        let push = norm(self.push(&path.state, &loads));
        let slowing = self.frame().slowing(&loads, 0.0);
        let faster = self.frame().body.most_compliant();
        let late_s = excess(rested_s.abs() - instant_s);
        if self.stops(k + 1) {
            let f = &mut self.figures;
            f.velocity[0] = larger(f.velocity[0], late_s * faster * (slowing + push));
        } else if late_s > 0.0 {
            let off = self.frame().block_kg * (slowing - push);
            self.figures.excess = larger(self.figures.excess, excess(off));
        }
    }

    /// Whether the slip ends at a knot.
    fn stops(&self, k: usize) -> bool {
        let after = self.h.mode.get(k + 1);
        self.mode(k) == Mode::Stick || after == Some(&Mode::Stick)
    }

    /// A stretch of a stick, or of a slip that has come to rest.
    fn rest(&mut self, path: &mut IntervalPath, stretch: &Stretch) -> Result<(), Stopped> {
        let steps = self.axes.stepper.parts(stretch.step_s, false) as usize;
        for j in 0..steps {
            let length_s = stretch.step_s / steps as f64;
            let part = stretch.part(j as f64 * length_s, length_s);
            self.pulse.tick(64 * self.frame().degrees() as u32)?;
            let Some(step) = self.axes.stepper.solve(&path.state, part, false) else {
                self.give_up();
                return Ok(());
            };
            if path.rested_s.is_none() {
                self.stays(&step);
            }
            self.follow(path, &step);
        }
        Ok(())
    }

    /// A stretch of a slip.
    fn slide(&mut self, path: &mut IntervalPath, stretch: &Stretch) -> Result<(), Stopped> {
        let length_s = stretch.step_s;
        let (mut t, mut next_s) = (0.0, None);
        for _ in 0..MOST_STEPS {
            let left_s = length_s - t;
            if !(left_s > 0.0) {
                return Ok(());
            }
            let loads = stretch.at(t);
            let most_s = match self.reach(path, &loads, (t, left_s)) {
                Reach::Free => left_s,
                Reach::Within(reach_s) => reach_s,
                Reach::Rest(rest_s) => {
                    let (w, push) = (path.state.speed(), self.push(&path.state, &loads));
                    let under = (stretch.from_s + t, &loads, push);
                    let frame = self.frame();
                    let turned = |before| frame.has_turned_about([w, before], under);
                    if !self.axes.heading.is_some_and(turned) {
                        self.axes.heading = unit(w);
                    }
                    path.rested_s = Some(left_s - rest_s);
                    path.state.lose_speed(self.frame());
                    return self.rest(path, &stretch.part(t, left_s));
                }
                Reach::Turn => {
                    self.turn_about(path, &loads, stretch.from_s + t);
                    continue;
                }
            };
            let first_s = next_s.unwrap_or_else(|| self.outlook(path, &loads));
            let longest_s = most_s.min(left_s / self.axes.stepper.parts(left_s, true));
            let found = self.step(path, stretch, (t, left_s), longest_s.min(first_s))?;
            let Some((step, at_corner)) = found else {
                if norm(path.state.speed()) > 0.0 {
                    self.give_up();
                    return Ok(());
                }
                path.rested_s = Some(left_s);
                return self.rest(path, &stretch.part(t, left_s));
            };
            let took_s = step.stretch.step_s;
            let gain =
                libm::pow(self.bearable() / step.defect().max(f64::MIN_POSITIVE), 1.0 / 15.0);
            // What a corner has cut says nothing about the length of the next.
            next_s = (!at_corner).then_some(took_s * (0.9 * gain).clamp(0.5, 4.0));
            self.slid(&step);
            self.follow(path, &step);
            t = if took_s >= left_s { length_s } else { t + took_s };
        }
        self.give_up();
        Ok(())
    }

    /// The defect of a step that may stand.
    fn bearable(&self) -> f64 {
        DEFECT * self.figures.velocity[1]
    }

    /// A step of a slip, of this length or as many times halved as it takes, and whether a corner of friction has cut it;
    /// `None` where none is short enough.
    fn step(
        &mut self,
        path: &IntervalPath,
        stretch: &Stretch,
        (t, left_s): (f64, f64),
        mut step_s: f64,
    ) -> Result<Option<(Box<Step>, bool)>, Stopped> {
        // No sliver is left.
        if step_s > 0.9 * left_s && self.axes.stepper.parts(left_s, true) == 1.0 {
            step_s = left_s;
        }
        let (line, mut cuts) = (self.line_from(path, &stretch.at(t)), 0);
        loop {
            self.pulse.tick(256 + 64 * self.frame().degrees() as u32)?;
            let part = Stretch { line, ..stretch.part(t, step_s) };
            let step = self.axes.stepper.solve(&path.state, part, true);
            let bearable = self.bearable();
            let stands =
                |s: &Step| s.tail <= TAIL && s.defect() <= bearable || s.pushes() <= bearable;
            if let Some(step) = step.filter(|step| stands(step)) {
                let corner = step.corner(self.axes.stepper.rule, AT_CORNER);
                match corner.filter(|_| cuts < MOST_CUTS) {
                    Some(corner) => (step_s, cuts) = (step_s * corner, cuts + 1),
                    None => return Ok(Some((step, cuts > 0))),
                }
            } else {
                step_s *= 0.5;
            }
            if step_s <= f64::EPSILON * f64::EPSILON * stretch.step_s {
                return Ok(None);
            }
        }
    }

    /// The straight line of friction by the speed on which a slip goes on.
    fn line_from(&self, path: &IntervalPath, loads: &Loads) -> Option<SpeedLine> {
        let frame = self.frame();
        let (w, push) = (path.state.speed(), self.push(&path.state, loads));
        let r = norm(w);
        let slowed = if r > 0.0 { frame.slowing(loads, r) / r } else { 0.0 };
        let change = frame.body.moved([push[0] - slowed * w[0], push[1] - slowed * w[1]]);
        frame.line_of(w, change, AT_CORNER)
    }

    /// How long a first step from here may be: the motion bends within `r/(f + |p|)`.
    fn outlook(&self, path: &IntervalPath, loads: &Loads) -> f64 {
        let r = norm(path.state.speed());
        let p = norm(self.push(&path.state, loads));
        let rate = self.frame().body.most_compliant() * (self.frame().slowing(loads, r) + p);
        if r > 0.0 { 2.0 * r / rate } else { f64::INFINITY }
    }

    /// How far a slip goes from here without coming to rest.
    fn reach(&self, path: &IntervalPath, loads: &Loads, (t, left_s): (f64, f64)) -> Reach {
        let push = self.push(&path.state, loads);
        let (w, p) = (path.state.speed(), norm(push));
        let r = norm(w);
        let f = self.frame().slowing(loads, r);
        if r == 0.0 || f == 0.0 || (dot(w, push) >= 0.0 && p >= f) {
            return Reach::Free;
        }
        // How fast it slows down; against the push it turns as well, and with a mass in every direction it always does.
        let (along, body) = (dot(w, push) / r, &self.frame().body);
        let slower = match (body.is_one(), along < 0.0) {
            (true, true) => f + p,
            (true, false) => f - along,
            (false, _) => norm(body.moved([0, 1].map(|i| push[i] - f / r * w[i]))),
        };
        let reach_s = 0.5 * r / slower;
        if left_s <= reach_s {
            return Reach::Free;
        }
        let stops = self.stops(path.knot + 1);
        let is_led = self.is_led(&path.state);
        let straight = is_led || self.is_straight(w, push, f);
        let shortest_m = if straight { SHORTEST_STRAIGHT_M } else { SHORTEST_M };
        let holds = p <= self.frame().holding(loads) * (1.0 + 1e-12);
        let to_rest = if !body.is_one() {
            body.time_to_rest(w, push, f, shortest_m)
        } else if p >= f && is_led {
            (stops && holds).then(|| r / (f - along))
        } else {
            time_to_rest(w, push, f)
        };
        let rest_s = match to_rest {
            Some(rest_s) if r * rest_s < shortest_m => Some(rest_s),
            None if stops && self.rests(r) && holds => Some(r / (f + p)),
            _ => None,
        };
        match rest_s.filter(|rest_s| stops || *rest_s <= left_s) {
            Some(rest_s) => Reach::Rest(rest_s),
            // So slow that rounding tells its direction, it has been at rest and goes on along the push.
            None if t + reach_s == t || self.rests(r) && p > f => Reach::Turn,
            None => Reach::Within(reach_s),
        }
    }

    /// Whether the block has but one line to slide on, or a stop to slide along: no push turns it, and it slows down to rest.
    pub(super) fn is_led(&self, state: &State) -> bool {
        self.axes.line.is_some() || (self.frame().wall().is_some() && state.pressed)
    }

    /// Whether a motion against the push may be straight: it does not turn.
    fn is_straight(&self, w: Pair, push: Pair, slowing: f64) -> bool {
        let body = &self.frame().body;
        if body.is_one() {
            return is_straight(w, push);
        }
        let u = unit(w).unwrap_or_default();
        let rate = body.moved([push[0] - slowing * u[0], push[1] - slowing * u[1]]);
        dot(w, push) < 0.0 && is_straight(w, rate)
    }

    /// Passes rest quicker than a time can tell: the block goes on along the push, if at all, and may have
    /// turned either way.
    fn turn_about(&mut self, path: &mut IntervalPath, loads: &Loads, at_s: f64) {
        let (tracked, from) = (self.tracked(), unit(path.state.speed()));
        path.state.lose_speed(self.frame());
        let acting = self.acting(&path.state, loads);
        match from.filter(|_| self.axes.line.is_some()) {
            Some(from) => self.axes.peaks.see(&tracked, &acting, Some(from)),
            None => self.axes.peaks.turn(&tracked, &acting, None, false),
        }
        let holds = self.holds_only(&path.state, loads);
        self.feed_speed(at_s, 0.0, |_| holds);
    }

    /// Nothing is known of the path: no figure holds.
    fn give_up(&mut self) {
        self.figures.displacement[0] = f64::INFINITY;
    }

    /// Takes up a step: its end, energies, path, peaks.
    fn follow(&mut self, path: &mut IntervalPath, step: &Step) {
        let (rule, frame) = (self.axes.stepper.rule, self.axes.stepper.frame);
        let Stretch { from_s, step_s, .. } = step.stretch;
        let follows = self.law.follows();
        let (mut done, mut size, mut damping, mut friction) = (0.0, 0.0, 0.0, 0.0);
        let (x, v, under) = (step.acting.x(), step.acting.v(), &step.acting.under);
        for (fastest, v) in path.fastest.iter_mut().zip(v) {
            *fastest = v.iter().fold(*fastest, |fastest, v| fastest.max(v.abs()));
        }
        self.against_stop(path.knot, step);
        let (momentum, dissipation) = vectorize!(self.axes.stepper.instructions, _simd => {
            step.raise_rates(frame, &mut path.rates);
            (frame.momentum(v), frame.dissipation(v))
        });
        for (node, weight) in rule.weights.iter().enumerate() {
            let (point, weight) = (1 + node, step_s * weight);
            let power = dot(pair(&momentum, point), pair(&under.a, point));
            done -= weight * power;
            size += weight * power.abs();
            let stop = pair(&step.acting.forces.stop, point);
            damping += weight * (dissipation[point] + dot(stop, step.speed(point)));
            if step.slips {
                friction += weight * frame.block_kg * step.slowings[point] * step.speeds[point];
            }
            if follows {
                let rise = frame.curvature_per_m * under.normal[point];
                let s = [x[0][point], x[1][point]];
                let back = -weight * rise * dot(s, step.speed(point));
                friction -= back;
                size += back.max(0.0);
            }
        }
        let (k, books) = (path.knot, &mut self.books);
        books.work[k] += done;
        books.damping[k] += damping;
        books.friction[k] += friction;
        if let Some(total) = books.size.get_mut(k) {
            *total += size;
        }
        if step.slips {
            self.totals.interfaces[0].path_m += step.path_m(rule);
        }
        self.see_peak_time(step, (from_s, step_s));
        path.state = step.state(POINTS - 1);
        if path.rested_s.is_some() {
            return;
        }
        let straight = self.is_straight_near_rest(step);
        let turns = straight || self.bounces_near_rest(step);
        let tracked = Tracked { turns, ..self.tracked() };
        if turns {
            let acting = self.acting(&path.state, &step.stretch.at(step_s));
            self.axes.peaks.turn(&tracked, &acting, None, false);
        }
        if !straight {
            self.look(&tracked, step, 0);
        }
    }

    /// Judges the stop around the block at the points of a step.
    fn against_stop(&mut self, k: usize, step: &Step) {
        if self.frame().stop.is_none() || !step.slips {
            return;
        }
        let x = step.acting.x();
        let place = |point: usize| [x[0][point], x[1][point]];
        let points = (0..POINTS).map(|point| (place(point), step.speed(point)));
        let broken = points.map(|(s, w)| self.contact_excess(k, s, w)).fold(0.0, larger);
        self.figures.excess = larger(self.figures.excess, broken);
        let has_wall = self.frame().wall().is_some();
        for point in (0..POINTS).filter(|_| has_wall) {
            self.off_wall(k, place(point), step.speed(point));
            let pulls_n =
                -dot(unit(place(point)).unwrap_or_default(), pair(&step.acting.forces.stop, point));
            let rounding = self.rounding(&step.loads(point));
            self.figures.excess = larger(self.figures.excess, excess(pulls_n - rounding));
        }
    }

    /// Whether a step passes so near rest that rounding may tell its direction.
    fn is_near_rest(&self, step: &Step) -> bool {
        let is_near = step.slips && step.quickest < NEAR_REST * self.dips[0].peak();
        is_near && self.axes.line.is_none()
    }

    /// Whether a step is near rest beside a wall off which it comes: bounces make rounding of one part a direction.
    fn bounces_near_rest(&self, step: &Step) -> bool {
        self.frame().wall().is_some() && !step.acting.under.pressed && self.is_near_rest(step)
    }

    /// Whether a step is near rest in a slip that was straight when it came there.
    fn is_straight_near_rest(&mut self, step: &Step) -> bool {
        if !self.is_near_rest(step) {
            self.axes.near_rest = None;
            return false;
        }
        if self.axes.near_rest.is_none() {
            let slowing = self.frame().slowing(&step.stretch.loads[0], step.speeds[0]);
            self.axes.near_rest = Some(self.is_straight(step.speed(0), step.push(0), slowing));
        }
        self.axes.near_rest == Some(true)
    }

    /// Keeps where `s` is at the printed time of its peak.
    fn see_peak_time(&mut self, step: &Step, (from_s, step_s): (f64, f64)) {
        let at_s = self.response.demands.peak_sliding_displacement_time_s;
        if at_s < from_s - self.instant_s || at_s > from_s + step_s + self.instant_s {
            return;
        }
        let state = self.axes.stepper.at(step, ((at_s - from_s) / step_s).clamp(0.0, 1.0));
        let s = [state.x[0], state.x[1]];
        if self.axes.at_peak.is_none_or(|found| norm(s) > norm(found)) {
            self.axes.at_peak = Some(s);
        }
    }

    /// Raises the peaks by a step, by parts of it where it is too coarse to tell one.
    fn look(&mut self, tracked: &Tracked<'_>, step: &Step, depth: u32) {
        let coarse = step.tail > FINE && depth < DEEPEST;
        if self.axes.peaks.follow(self.axes.stepper.rule, tracked, step, coarse) {
            return;
        }
        let half_s = 0.5 * step.stretch.step_s;
        let mut state = step.state(0);
        let halves = [0.0, half_s].map(|t| {
            let half = self.axes.stepper.solve(&state, step.stretch.part(t, half_s), step.slips);
            if let Some(half) = &half {
                state = half.state(POINTS - 1);
            }
            half
        });
        match &halves {
            [Some(first), Some(second)] => {
                self.look(tracked, first, depth + 1);
                self.look(tracked, second, depth + 1);
            }
            _ => {
                self.axes.peaks.follow(self.axes.stepper.rule, tracked, step, false);
            }
        }
    }
}
