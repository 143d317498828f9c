//! Decisions of a slider in a plane: what lets go, what comes to rest, and how close it was.

use super::super::collocation::POINTS;
use super::super::events::SLOWEST_IMPACT_M_PER_S;
use super::super::ground::nearest;
use super::super::structure::larger;
use super::super::{ClosestCall, DecisionKind};
use super::frame::{Loads, Pair, State, between, dot, norm, pair, unit};
use super::judge::{EventDirection, Minima, PlaneJudge, REST};
use super::step::{FINE, Step, Stretch, sine};
use crate::response::Mode;

/// Sine of the angle between velocity and push below which a motion is straight, and from which it is not.
const STRAIGHT: [f64; 2] = [1e-6, 1e-5];

/// Whether a motion against the push may be straight.
pub(super) fn is_straight(w: Pair, push: Pair) -> bool {
    dot(w, push) < 0.0 && sine(w, push) < STRAIGHT[1]
}

impl<'a> PlaneJudge<'a> {
    /// Takes the next speed of a slip.
    pub(super) fn feed_speed(
        &mut self,
        time_s: f64,
        speed: f64,
        holds: impl FnOnce(&Self) -> bool,
    ) {
        let minimum = self.dips[0].feed(time_s, speed);
        let peak = self.dips[0].peak();
        let Minima { turn: (turn_s, holds_there), least, was_at_rest } = &mut self.axes.minima;
        if let Some(minimum) = minimum.filter(|_| *holds_there) {
            *was_at_rest |= minimum <= 0.5 * REST * peak;
            if least.is_none_or(|(least, _)| minimum < least) {
                *least = Some((minimum, *turn_s));
            }
        }
        if self.dips[0].turn_s() == time_s {
            self.axes.minima.turn = (time_s, holds(self));
        }
    }

    /// Whether a block at rest is held though friction would not have stopped it: `f < |p| ≤ μ_s N/M1`.
    pub(super) fn holds_only(&self, state: &State, loads: &Loads) -> bool {
        let (frame, push) = (self.frame(), norm(self.push(state, loads)));
        frame.slowing(loads, 0.0) < push && push <= frame.holding(loads)
    }

    /// Takes the direction of a knot at which the mode has changed, and judges the way to a stop.
    pub(super) fn turn(&mut self, k: usize) {
        let (all, off) = self.loads_of(k);
        let state = self.state(k);
        let mut turn = EventDirection {
            direction: Some([0.0; 2]),
            unsure: 0.0,
            force_n: 1.0,
            y_m: state.x[1],
        };
        if self.mode(k) == Mode::Stick {
            self.axes.event_directions.push(turn);
            if self.strikes(k) {
                return;
            }
            let best = nearest(off).iter().position(|is| *is);
            return self.comes_to_rest(k, &all[best.unwrap_or(0)]);
        }
        let push = self.push(&state, &all[3]);
        let slowing = self.frame().slowing(&all[3], 0.0);
        let clear = norm(push) > 1e-6 * (self.largest.1 + slowing);
        turn.direction = self.frame().body.departure(push, slowing).filter(|_| clear);
        turn.force_n = self.frame().block_kg * norm(push);
        self.axes.event_directions.push(turn);
    }

    /// Judges the way to a stop at a knot: whether the block has slowed down so far, and what friction has
    /// done in all directions between that of sliding and that of the push.
    fn comes_to_rest(&mut self, k: usize, loads: &Loads) {
        let state = self.state(k);
        let acting = self.acting(&state, loads);
        let (frame, tracked) = (self.frame(), self.tracked());
        let push = pair(&acting.forces.push, 0);
        let (p, f) = (norm(push), frame.slowing(loads, 0.0));
        let is_led = self.is_led(&state);
        let late = 2.0 * self.instant_s * (p + f);
        let passes = self.axes.arrived > late.max(2.0 * REST * self.dips[0].peak());
        if !is_led && passes && p > f * (1.0 + 1e-9) {
            let off = frame.block_kg * (p - f);
            self.figures.excess = larger(self.figures.excess, off);
        }
        let Some(from) = self.last_heading(k) else { return };
        if is_led {
            // One that comes to rest off a stop, and then bears on it, has not slid along it.
            let is_along = self.axes.line.is_some() || sine(from, self.place(k)) > 1.0 - 1e-6;
            match is_along {
                true => self.axes.peaks.see(&tracked, &acting, Some(from)),
                false => self.axes.peaks.turn(&tracked, &acting, Some([from; 2]), false),
            }
            return;
        }
        let Some(to) = self.last_direction(from, push, f) else { return };
        if !frame.body.is_one() {
            let rate = frame.body.moved([push[0] - f * from[0], push[1] - f * from[1]]);
            if sine(from, rate) >= STRAIGHT[0] {
                let certain = sine(from, rate) >= STRAIGHT[1];
                self.axes.peaks.turn(&tracked, &acting, Some([from, to]), certain);
            }
            self.axes.peaks.turn(&tracked, &acting, Some([from, to]), false);
            return;
        }
        if dot(from, to) >= 0.0 || sine(from, to) >= STRAIGHT[0] {
            let certain = !is_straight(from, to);
            self.axes.peaks.turn(&tracked, &acting, Some([from, to]), certain);
        }
        if is_straight(from, to) {
            self.axes.peaks.turn(&tracked, &acting, None, false);
        }
    }

    /// The direction that a slip has in the end under a push.
    fn last_direction(&self, from: Pair, push: Pair, slowing: f64) -> Option<Pair> {
        let body = &self.frame().body;
        if body.is_one() || norm(push) >= slowing {
            return body.departure(push, slowing);
        }
        Some(body.end_of_turn(from, push, slowing))
    }

    /// The last direction of sliding before a stop at a knot.
    fn last_heading(&self, k: usize) -> Option<Pair> {
        if let Some(heading) = self.axes.heading {
            return Some(heading);
        }
        for j in (k.saturating_sub(3)..k).rev().take_while(|&j| self.mode(j) != Mode::Stick) {
            let stored = unit(self.state(j).speed());
            // What a block had for a direction before it struck a stop it no longer has.
            if stored.is_some() || self.strikes(j) {
                return stored;
            }
        }
        None
    }

    /// Directions of sliding that pass between two knots of one time.
    pub(super) fn turn_between(&mut self, k: usize) {
        let slips = |k: usize| self.mode(k) != Mode::Stick;
        if self.axes.line.is_some() || !(slips(k) && slips(k + 1)) {
            return;
        }
        let [from, to] = [k, k + 1].map(|k| self.state(k));
        let headings = [unit(from.speed()), unit(to.speed())];
        if headings[0].is_some() && headings[0] == headings[1] {
            return;
        }
        // What friction does on the way to a stop is looked at where that is reached.
        let mut abreast =
            (k + 2..self.h.len()).take_while(|&j| self.h.time_s[j] == self.h.time_s[k]);
        if headings == [None; 2] && abreast.any(|j| !slips(j)) {
            return;
        }
        let tracked = self.tracked();
        let loads = self.instant(self.h.time_s[k])[3];
        let acting = self.acting(&from, &loads);
        // Which way a straight pass through rest turns is rounding.
        if let [Some(from), Some(to)] = headings
            && !is_straight(from, to)
        {
            self.axes.peaks.turn(&tracked, &acting, Some([from, to]), true);
        }
        self.axes.peaks.turn(&tracked, &acting, None, false);
    }

    /// Judges a step of a stick by what is asked at its points.
    pub(super) fn stays(&mut self, step: &Step) {
        let Stretch { from_s, step_s, loads, .. } = step.stretch;
        let rounding = self.rounding(&loads[0]);
        let at_points = core::array::from_fn(|point| {
            self.required_friction(step.push(point), &step.loads(point)).0
        });
        self.held(0, (from_s, step_s), rounding, &at_points, |judge, t| {
            let state = step.at(judge.axes.stepper.rule, t);
            let loads = between(&loads, t);
            judge.required_friction(judge.push(&state, &loads), &loads).0
        });
    }

    /// `u·ẇ` at the points of a step of a slip.
    fn gains(&self, step: &Step) -> [f64; POINTS] {
        core::array::from_fn(|i| {
            let (u, push) = (pair(&step.headings, i), step.push(i));
            dot(u, self.frame().body.moved([0, 1].map(|k| push[k] - step.slowings[i] * u[k])))
        })
    }

    /// The state at a part of a step of a slip.
    fn inside(&self, step: &Step, part: f64) -> State {
        let stepper = &self.axes.stepper;
        if step.tail > FINE { stepper.at(step, part) } else { step.at(stepper.rule, part) }
    }

    /// Where the speed is least between two points, of which one may be nearest, and that speed: the zero of `w·ẇ`, with
    /// `ẇ = p − f u` of one mass. A least square is found to half the digits, which in a pass through rest are all that
    /// the speed has.
    fn turn_of_speed(&self, step: &Step, ends: [usize; 2], nearest: usize) -> Option<(f64, f64)> {
        let gain = |part: f64| {
            let state = self.inside(step, part);
            let loads = between(&step.stretch.loads, part);
            let (w, r) = (state.speed(), norm(state.speed()));
            let push = self.push(&state, &loads);
            let body = &self.frame().body;
            // w·A⁻¹p − f w·A⁻¹u
            let slowing = self.frame().slowing(&loads, r) * dot(w, body.moved(w)) / r;
            (dot(w, body.moved(push)) - if r > 0.0 { slowing } else { 0.0 }, r)
        };
        let points = &self.axes.stepper.rule.points;
        let [mut low, mut high] = ends.map(|end| points[end]);
        let ((mut falls, _), (mut rises, _)) = (gain(low), gain(high));
        if !(falls < 0.0 && rises > 0.0) {
            return None;
        }
        let mut least = (points[nearest], step.speeds[nearest]);
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
        let rule = self.axes.stepper.rule;
        let (speeds, gains) = (step.speeds, self.gains(step));
        let last = POINTS - 1;
        let least_near = |point: usize| {
            let beside = [point.saturating_sub(1), (point + 1).min(last)];
            self.turn_of_speed(step, beside, point).unwrap_or_else(|| {
                // The square has no corner where the speed passes 0.
                let square = speeds[point] * speeds[point];
                let (t, square) = rule.least_of((point, square), |t| {
                    let w = self.inside(step, t).speed();
                    dot(w, w)
                });
                (t, square.sqrt())
            })
        };
        // A minimum beside a maximum, both between two points, shows in the slope at one of these alone.
        let least_between = |point: usize| {
            if point == 0 || point == last {
                return None;
            }
            let [before, at, after] = [point - 1, point, point + 1].map(|i| speeds[i]);
            let (rises, falls) = (before < at && at < after, before > at && at > after);
            let ends = match gains[point] {
                gain if rises && gain < 0.0 => [point, point + 1],
                gain if falls && gain > 0.0 => [point - 1, point],
                _ => return None,
            };
            self.turn_of_speed(step, ends, point)
        };
        let mut points = Vec::with_capacity(POINTS + 1);
        for (point, at) in rule.points.into_iter().zip(speeds).enumerate() {
            let is_below = |other: usize| speeds[point] < speeds[other];
            let is_least = match point {
                0 => is_below(1) && gains[0] < 0.0,
                _ if point == last => is_below(last - 1) && gains[last] > 0.0,
                _ => is_below(point - 1) && is_below(point + 1),
            };
            points.push(at);
            let found = if is_least { Some(least_near(point)) } else { least_between(point) };
            if let Some(found) = found {
                points.insert(points.len() - usize::from(found.0 < at.0), found);
            }
        }
        for (t, size) in points {
            self.feed_speed(step.stretch.from_s + t * step.stretch.step_s, size, |judge| {
                judge.holds_only(&step.at(rule, t), &between(&step.stretch.loads, t))
            });
        }
        let frame = self.frame();
        self.axes.heading = Some(pair(&step.headings, last));
        // A push too small to tell the first direction grows into one that does.
        if let Some(turn) = self.axes.event_directions.last_mut()
            && turn.direction.is_none()
        {
            let [first, second] = [1, 2].map(|point| step.heading(frame, point, [0.0; 2]));
            (turn.direction, turn.force_n) = (Some(first), f64::INFINITY);
            turn.unsure = 2.0 * norm([first[0] - second[0], first[1] - second[1]]);
        }
    }

    /// Whether the block strikes a stop that does not give way between the knot before `k` and `k`.
    pub(super) fn strikes(&self, k: usize) -> bool {
        let h = self.h;
        let Some(ring) = self.frame().wall() else { return false };
        if k == 0 || h.time_s[k] != h.time_s[k - 1] {
            return false;
        }
        let [before, after] = [k - 1, k].map(|k| self.state(k).speed());
        let slack_m = self.instant_s * norm(before) + 8.0 * f64::EPSILON * ring.gap_m;
        before != after
            && dot(self.place(k), before) > 0.0
            && (norm(self.place(k)) - ring.gap_m).abs() <= slack_m
    }

    /// Judges an impact: `ρ̇⁺ = −e ρ̇⁻`, the velocity along the stop and absolute velocities of floors as before.
    pub(super) fn impact(&mut self, k: usize) {
        let e = self.law.restitution().unwrap_or(0.0);
        let [before, after] = [k - 1, k].map(|k| self.state(k));
        let n = unit(self.place(k)).unwrap_or_default();
        let (was, is) = (before.speed(), after.speed());
        let speed = dot(n, was);
        let expected = [0, 1].map(|i| was[i] - (1.0 + e) * speed * n[i]);
        let off = norm([is[0] - expected[0], is[1] - expected[1]]);
        let lost = [was[0] - is[0], was[1] - is[1]];
        self.axes.heading = unit(is);
        if let Some(heading) = self.axes.heading.filter(|_| self.mode(k) != Mode::Stick) {
            // It may be on its way for no time at all.
            let acting = self.acting(&after, &self.instant(self.h.time_s[k])[3]);
            self.axes.peaks.turn(&self.tracked(), &acting, Some([heading; 2]), false);
        }
        let f = &mut self.figures;
        f.velocity[0] = larger(f.velocity[0], off);
        for i in 0..before.x.len() {
            f.displacement[0] = larger(f.displacement[0], after.x[i] - before.x[i]);
            if let Some(part) = i.checked_sub(2) {
                let expected = before.v[i] + self.axes.stepper.frame.ridden(part, lost);
                f.velocity[0] = larger(f.velocity[0], after.v[i] - expected);
            }
        }
        let frame = self.frame();
        self.books.damping[k - 1] =
            0.5 * (dot(was, frame.inertia(was)) - dot(is, frame.inertia(is)));
        if speed < SLOWEST_IMPACT_M_PER_S {
            return;
        }
        let (margin, time_s) = (speed / self.figures.velocity[1], self.h.time_s[k]);
        self.nearest(ClosestCall { margin, time_s, kind: DecisionKind::Impact, interface: 0 });
        if self.mode(k) != Mode::Stick && !self.presses(k) {
            let direction = Some(unit(is).unwrap_or_default());
            let y_m = after.x[1];
            let event = EventDirection { direction, unsure: 0.0, force_n: f64::INFINITY, y_m };
            self.axes.event_directions.push(event);
        }
    }

    /// Whether a slip has come to rest, as near as rounding tells.
    pub(super) fn rests(&self, speed: f64) -> bool {
        speed <= 1.5 * REST * self.dips[0].peak()
    }
}
