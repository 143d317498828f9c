//! Decisions of a slider in a plane: what lets go, what comes to rest, and how close it was.

use super::super::collocation::POINTS;
use super::super::near::{Dips, dip};
use super::super::structure::{excess, larger};
use super::super::{ClosestCall, DecisionKind};
use super::frame::{Pair, between, dot, norm, times, unit};
use super::interval::FINE;
use super::judge::PlaneJudge;
use super::peaks::Acting;
use super::step::{State, Step, sine};
use crate::response::Mode;

/// A block that slows down to this part of its peak speed in a slip has come to rest if it holds.
const REST: f64 = 1e-14;
/// Sine of the angle between velocity and push below which a motion is straight, and from which it is not.
const STRAIGHT: [f64; 2] = [1e-6, 1e-5];

/// Whether a motion against the push may be straight.
pub(super) fn is_straight(w: Pair, push: Pair) -> bool {
    dot(w, push) < 0.0 && sine(w, push) < STRAIGHT[1]
}

/// Where a side of a knot lies in its interval.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Start,
    End,
    /// No interval begins or ends at the knot.
    Alone,
}

/// What an event is in the plane.
pub(super) struct Turn {
    /// Direction of the first velocity, as far as it is known; 0 in stick.
    pub(super) direction: Option<Pair>,
    /// What it is not known to, and the force that tells it.
    pub(super) unsure: f64,
    pub(super) force_n: f64,
    /// `s` along y.
    pub(super) y_m: f64,
}

/// The speed of a slip, and its minima where the block would have held, had it come to rest.
pub(super) struct Speed {
    still: f64,
    dips: Dips,
    /// When the speed was last at a turn, and whether the block would hold there.
    turn: (f64, bool),
    /// Least of those, and when.
    least: Option<(f64, f64)>,
}

impl Speed {
    pub(super) fn new(still: f64) -> Self {
        Self { still, dips: Dips::new(still), turn: (0.0, false), least: None }
    }

    /// Starts anew.
    pub(super) fn restart(&mut self) {
        *self = Self::new(self.still);
    }

    /// Largest speed of the slip so far.
    pub(super) fn peak(&self) -> f64 {
        self.dips.peak()
    }

    pub(super) fn feed(&mut self, time_s: f64, speed: f64, holds: impl FnOnce() -> bool) {
        if let Some(minimum) = self.dips.feed(time_s, speed)
            && self.turn.1
            && self.least.is_none_or(|(least, _)| minimum < least)
        {
            self.least = Some((minimum, self.turn.0));
        }
        if self.dips.turn_s() == time_s {
            self.turn = (time_s, holds());
        }
    }
}

impl PlaneJudge<'_> {
    /// Begins a phase.
    pub(super) fn begin(&mut self, mode: Mode) {
        match mode {
            Mode::Stick => self.dips = Dips::new(1e-12),
            Mode::Slip(_) => self.speed.restart(),
        }
        self.near_rest = None;
        self.heading = None;
        self.arrived = 0.0;
    }

    /// Ends a phase: its near decisions are known.
    pub(super) fn close(&mut self, mode: Mode) {
        let call = match mode {
            Mode::Stick => self.dips.least(0),
            Mode::Slip(_) => {
                let minimum = self.speed.dips.so_far();
                if minimum.is_finite() {
                    self.least_speed = Some(self.least_speed.map_or(minimum, |m| m.min(minimum)));
                }
                if self
                    .speed
                    .least
                    .is_some_and(|(least, _)| least <= 0.5 * REST * self.speed.peak())
                {
                    // It came to rest, was held, and slides on.
                    let off = (self.frame().fixed - self.law.kinetic_at(0.0)[0]) * self.largest.0;
                    self.figures.excess = larger(self.figures.excess, off);
                }
                self.speed.least.map(|(least, time_s)| ClosestCall {
                    margin: least / self.speed.peak(),
                    time_s,
                    kind: DecisionKind::Slip,
                    interface: 0,
                })
            }
        };
        if let Some(call) = call {
            self.nearest(call);
        }
    }

    /// Whether a block at rest is held though friction would not have stopped it: `f < |p| ≤ μ_s N/M1`.
    pub(super) fn holds_only(&self, state: &State, loads: &super::frame::Loads) -> bool {
        let (frame, push) = (self.frame(), norm(self.forces(state, loads).0.push));
        frame.slowing(loads, 0.0) < push && push <= frame.holding(loads)
    }

    /// Judges a change of mode at a knot, at which the block has no velocity.
    pub(super) fn change(&mut self, k: usize, before: Mode) {
        let (h, time_s) = (self.h, self.h.time_s[k]);
        let state = self.stored(k);
        self.figures.velocity[0] = larger(self.figures.velocity[0], norm(state.speed()));
        let all = self.instant(time_s);
        let own =
            [h.table_acceleration_m_per_s2[k], self.given.along_y.table_acceleration_m_per_s2[k]];
        let off = all.map(|loads| norm([0, 1].map(|axis| loads[axis].table - own[axis])));
        let least_off = off.into_iter().fold(f64::INFINITY, f64::min);
        let stops = before != Mode::Stick;
        let (mut broken, mut decided) = (f64::INFINITY, None);
        for (loads, off) in all.iter().zip(off) {
            // What a jump passes on its way lets go too.
            if stops && off > least_off {
                continue;
            }
            let push = self.forces(&state, loads).0.push;
            let (asked, rounding) = self.asked(push, loads);
            let beyond = if stops { asked.beyond() } else { -asked.beyond() };
            let beyond = excess(beyond - rounding);
            if beyond <= broken {
                decided = asked.margin().map(|m| (m.abs(), rounding / asked.bound()));
            }
            broken = broken.min(beyond);
        }
        self.figures.excess = larger(self.figures.excess, broken);
        if !stops {
            let push = self.forces(&state, &all[3]).0.push;
            let slowing = self.frame().slowing(&all[3], 0.0);
            let clear = norm(push) > 1e-6 * (self.largest.1 + slowing);
            self.turns.push(Turn {
                direction: self.frame().body.departure(push, slowing).filter(|_| clear),
                unsure: 0.0,
                force_n: self.frame().block_kg * norm(push),
                y_m: state.x[1],
            });
            return;
        }
        let rest = Turn { direction: Some([0.0; 2]), unsure: 0.0, force_n: 1.0, y_m: state.x[1] };
        self.turns.push(rest);
        if let Some((margin, drift)) = decided {
            self.totals.decided(margin, drift);
            let (kind, interface) = (DecisionKind::Stop, 0);
            self.nearest(ClosestCall { margin, time_s, kind, interface });
        }
        self.comes_to_rest(k, &all[off.iter().position(|off| *off <= least_off).unwrap_or(0)]);
    }

    /// Judges the way to a stop at a knot: whether the block has slowed down so far, and what friction has
    /// done in all directions between that of sliding and that of the push.
    fn comes_to_rest(&mut self, k: usize, loads: &super::frame::Loads) {
        let state = self.stored(k);
        let (forces, floors) = self.forces(&state, loads);
        let (frame, tracked, push) = (self.frame(), self.tracked(), forces.push);
        let (p, f) = (norm(push), frame.slowing(loads, 0.0));
        let late = 2.0 * self.instant_s * (p + f);
        if p > f * (1.0 + 1e-9) && self.arrived > late.max(2.0 * REST * self.speed.peak()) {
            let off = frame.block_kg * (p - f);
            self.figures.excess = larger(self.figures.excess, off);
        }
        let Some(from) = self.last_heading(k) else { return };
        let Some(to) = self.last_direction(from, push, f) else { return };
        let acting =
            Acting { state: &state, loads: *loads, forces, floors: &floors, direction: Some(from) };
        if !frame.body.is_one() {
            let rate = frame.body.moved([push[0] - f * from[0], push[1] - f * from[1]]);
            if sine(from, rate) >= STRAIGHT[0] {
                let certain = sine(from, rate) >= STRAIGHT[1];
                self.peaks.turn(&tracked, &acting, Some([from, to]), certain);
            }
            self.peaks.turn(&tracked, &acting, Some([from, to]), false);
            return;
        }
        if dot(from, to) >= 0.0 || sine(from, to) >= STRAIGHT[0] {
            let certain = !is_straight(from, to);
            self.peaks.turn(&tracked, &acting, Some([from, to]), certain);
        }
        if is_straight(from, to) {
            self.peaks.turn(&tracked, &acting, None, false);
        }
    }

    /// The direction that a slip has in the end under a push.
    fn last_direction(&self, from: Pair, push: Pair, slowing: f64) -> Option<Pair> {
        let body = &self.frame().body;
        if body.is_one() || norm(push) >= slowing {
            return body.departure(push, slowing);
        }
        // Of a speed that is of no account.
        body.way_to_rest(times(from, 1e-200), push, slowing, 1.0)?.1
    }

    /// The last direction of sliding before a stop at a knot.
    fn last_heading(&self, k: usize) -> Option<Pair> {
        let before = (0..k).rev().take_while(|&j| self.mode(j) != Mode::Stick);
        let stored = before.take(3).find_map(|j| unit(self.stored(j).speed()));
        self.heading.or(stored)
    }

    /// Directions of sliding that pass between two knots of one time.
    pub(super) fn turn_between(&mut self, k: usize) {
        let slips = |k: usize| self.mode(k) != Mode::Stick;
        if !(slips(k) && slips(k + 1)) {
            return;
        }
        let [from, to] = [k, k + 1].map(|k| self.stored(k));
        let headings = [unit(from.speed()), unit(to.speed())];
        if headings[0].is_some() && headings[0] == headings[1] {
            return;
        }
        let tracked = self.tracked();
        let loads = self.instant(self.h.time_s[k])[3];
        let (forces, floors) = self.forces(&from, &loads);
        let acting =
            Acting { state: &from, loads, forces, floors: &floors, direction: headings[0] };
        // Which way a straight pass through rest turns is rounding.
        if let [Some(from), Some(to)] = headings
            && !is_straight(from, to)
        {
            self.peaks.turn(&tracked, &acting, Some([from, to]), true);
        }
        self.peaks.turn(&tracked, &acting, None, false);
    }

    /// Judges a step of a stick by what is asked at its points.
    pub(super) fn held(&mut self, step: &Step) {
        let rule = self.stepper.rule;
        let rounding = self.rounding(&step.stretch.loads[0]);
        let margin_at = |state: &State, t: f64| {
            let loads = between(&step.stretch.loads, t);
            let (asked, _) = self.asked(self.forces(state, &loads).0.push, &loads);
            (asked.beyond(), asked.margin().unwrap_or(f64::NAN), asked.bound())
        };
        let (mut margins, mut broken) = ([0.0; POINTS], 0.0);
        let mut state = State::default();
        for (point, margin) in margins.iter_mut().enumerate() {
            step.at_point(point, &mut state);
            let beyond;
            (beyond, *margin, _) = margin_at(&state, rule.points[point]);
            broken = larger(broken, excess(beyond - rounding));
        }
        let mut least = None;
        if let Some(point) = dip(&margins) {
            let (t, margin) = rule.least_of((point, margins[point]), |t| {
                let mut state = State::default();
                step.at(rule, t, &mut state);
                margin_at(&state, t).1
            });
            step.at(rule, t, &mut state);
            let bound = margin_at(&state, t).2;
            broken = larger(broken, excess(-margin * bound - rounding));
            least = Some((point, t, margin));
        }
        self.figures.excess = larger(self.figures.excess, broken);
        if margins.iter().any(|margin| margin.is_nan()) {
            self.dips.interrupt();
            return;
        }
        for point in 0..POINTS {
            let (t, margin) = match least {
                Some((at, t, margin)) if at == point => (t, margin),
                _ => (rule.points[point], margins[point]),
            };
            self.dips.feed(step.stretch.from_s + t * step.stretch.step_s, margin);
        }
        // A plateau near the bound is as close a call as a maximum, if it is no sliver of one.
        let flat = margins.iter().all(|margin| (margin - margins[0]).abs() <= 1e-12);
        if flat && step.stretch.step_s > 1e6 * self.instant_s && margins[0] < 1.0 {
            self.dips.take(step.stretch.from_s, margins[0]);
        }
    }

    /// The push at a point of a step.
    fn push_at(&self, step: &Step, point: usize) -> Pair {
        let mut state = State::default();
        step.at_point(point, &mut state);
        let loads = step.stretch.at(self.stepper.rule.points[point] * step.stretch.step_s);
        self.forces(&state, &loads).0.push
    }

    /// `u·ẇ` at a point of a step of a slip.
    fn gains(&self, step: &Step, point: usize) -> f64 {
        let loads = step.stretch.at(self.stepper.rule.points[point] * step.stretch.step_s);
        let push = self.push_at(step, point);
        let slowing = self.frame().slowing(&loads, norm(step.speed(point)));
        let u = step.heading(self.frame(), point, push);
        dot(u, self.frame().body.moved([push[0] - slowing * u[0], push[1] - slowing * u[1]]))
    }

    /// The state at a part of a step of a slip.
    fn inside(&self, step: &Step, part: f64) -> State {
        let mut state = State::default();
        if step.tail > FINE {
            self.stepper.at(step, part, &mut state);
        } else {
            step.at(self.stepper.rule, part, &mut state);
        }
        state
    }

    /// Where the speed is least next to a point, and that speed: the zero of `w·ẇ`, with `ẇ = p − f u` of one mass. A least square
    /// is found to half the digits, which in a pass through rest are all that the speed has.
    fn turn_of_speed(&self, step: &Step, point: usize) -> Option<(f64, f64)> {
        let gain = |part: f64| {
            let state = self.inside(step, part);
            let loads = between(&step.stretch.loads, part);
            let (w, r) = (state.speed(), norm(state.speed()));
            let push = self.forces(&state, &loads).0.push;
            let body = &self.frame().body;
            // w·A⁻¹p − f w·A⁻¹u
            let slowing = self.frame().slowing(&loads, r) * dot(w, body.moved(w)) / r;
            (dot(w, body.moved(push)) - if r > 0.0 { slowing } else { 0.0 }, r)
        };
        let points = &self.stepper.rule.points;
        let mut low = points[point.saturating_sub(1)];
        let mut high = points[(point + 1).min(POINTS - 1)];
        let ((mut falls, _), (mut rises, _)) = (gain(low), gain(high));
        if !(falls < 0.0 && rises > 0.0) {
            return None;
        }
        let mut least = (points[point], norm(step.speed(point)));
        // By chords, and by halves where these do not halve it.
        for pass in 0..200 {
            let chord = low + (high - low) * (falls / (falls - rises));
            let part = if pass % 3 == 2 { 0.5 * (low + high) } else { chord };
            if !(part > low && part < high) {
                break;
            }
            let (here, speed) = gain(part);
            if speed <= least.1 {
                least = (part, speed);
            }
            if here < 0.0 {
                (low, falls) = (part, here);
            } else {
                (high, rises) = (part, here);
            }
        }
        Some(least)
    }

    /// Takes the speeds of a step of a slip.
    pub(super) fn slid(&mut self, step: &Step) {
        let rule = self.stepper.rule;
        let mut state = State::default();
        let mut speeds = [0.0; POINTS];
        for (point, speed) in speeds.iter_mut().enumerate() {
            step.at_point(point, &mut state);
            *speed = norm(state.speed());
        }
        let least_near = |point: usize| {
            self.turn_of_speed(step, point).unwrap_or_else(|| {
                // The square has no corner where the speed passes 0.
                let square = speeds[point] * speeds[point];
                let (t, square) = rule.least_of((point, square), |t| {
                    let w = self.inside(step, t).speed();
                    dot(w, w)
                });
                (t, square.sqrt())
            })
        };
        let last = POINTS - 1;
        let mut points = Vec::with_capacity(POINTS + 1);
        for (point, at) in rule.points.into_iter().zip(speeds).enumerate() {
            let is_below = |other: usize| speeds[point] < speeds[other];
            let is_least = match point {
                0 => is_below(1) && self.gains(step, 0) < 0.0,
                _ if point == last => is_below(last - 1) && self.gains(step, last) > 0.0,
                _ => is_below(point - 1) && is_below(point + 1),
            };
            points.push(at);
            if is_least {
                let found = least_near(point);
                // Its place is that of the point, beside it at an end.
                points.insert(points.len() - usize::from(found.0 < at.0), found);
            }
        }
        let mut speed = core::mem::replace(&mut self.speed, Speed::new(0.0));
        for (t, size) in points {
            speed.feed(step.stretch.from_s + t * step.stretch.step_s, size, || {
                step.at(rule, t, &mut state);
                self.holds_only(&state, &between(&step.stretch.loads, t))
            });
        }
        self.speed = speed;
        self.heading = Some(step.heading(self.frame(), POINTS - 1, self.push_at(step, POINTS - 1)));
        // A push too small to tell the first direction grows into one that does.
        let frame = self.frame();
        if let Some(turn) = self.turns.last_mut()
            && turn.direction.is_none()
        {
            let [first, second] = [1, 2].map(|point| step.heading(frame, point, [0.0; 2]));
            (turn.direction, turn.force_n) = (Some(first), f64::INFINITY);
            turn.unsure = 2.0 * norm([first[0] - second[0], first[1] - second[1]]);
        }
    }

    /// Whether a slip has come to rest, as near as rounding tells.
    pub(super) fn rests(&self, speed: f64) -> bool {
        speed <= 1.5 * REST * self.speed.peak()
    }
}
