//! The friction law as a judge reads it, and the decisions that came close.

use super::ClosestCall;
use super::collocation::{POINTS, Rule};
use super::ground::Ground;
use super::rate::RateFriction;
use super::structure::{excess, larger};
use crate::model::{Model, Stop, StopKind};
use crate::response::{Contact, EventKind, Mode};
use crate::slider::Direction;

/// Bounds and kinetic forces from the coefficients, for each direction.
pub(super) struct Law {
    fixed: [f64; 2],
    kinetic: [f64; 2],
    /// In place of the kinetic coefficients, where there is one.
    pub(super) rate: Option<RateFriction>,
    stop: Option<Stop>,
}

/// What a stop does while it acts: the block pushes it with `k s + c ṡ − shift` towards +x.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Push {
    stiffness: f64,
    damper: f64,
    pub(super) shift: f64,
}

impl Push {
    /// Force of the block on the stop towards +x.
    pub(super) fn force(&self, s: f64, w: f64) -> f64 {
        self.stiffness * s + self.damper * w - self.shift
    }

    /// What its spring has stored: `(k s − shift)²/(2 k)`.
    pub(super) fn strain(&self, s: f64) -> f64 {
        let force = self.force(s, 0.0);
        if force == 0.0 { 0.0 } else { 0.5 * force * (force / self.stiffness) }
    }
}

impl Law {
    /// Static coefficients towards +x and −x.
    pub(super) fn fixed(&self) -> [f64; 2] {
        self.fixed
    }

    pub(super) fn new(model: &Model) -> Self {
        Self {
            fixed: model.static_friction(),
            kinetic: model.kinetic_friction(),
            rate: RateFriction::new(model),
            stop: model.stop().copied(),
        }
    }

    /// What the stop does, zero where it does not act.
    pub(super) fn push(&self, contact: Contact) -> Push {
        let (Contact::Pressed(side), Some(stop)) = (contact, &self.stop) else {
            return Push::default();
        };
        let StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } = stop.kind else {
            return Push::default();
        };
        let gap_m = stop.gap_towards(side).unwrap_or(f64::NAN);
        let shift = side.sign() * stiffness_n_per_m * gap_m;
        Push { stiffness: stiffness_n_per_m, damper: damper_n_s_per_m, shift }
    }

    /// By how much a claimed contact breaks the law of the stop, as the force that should or should
    /// not act, in N. `slack_m` and `slack_n` are what the rounding of times makes of position and
    /// force.
    pub(super) fn contact_excess(
        &self,
        claimed: Contact,
        (s, w): (f64, f64),
        [slack_m, slack_n]: [f64; 2],
    ) -> f64 {
        let Some(stop) = &self.stop else { return 0.0 };
        let StopKind::Elastic { stiffness_n_per_m: k, damper_n_s_per_m: c } = stop.kind else {
            return 0.0;
        };
        let of = |side: Direction| {
            let delta = side.sign() * s - stop.gap_towards(side)?;
            Some((delta, k * delta + c * side.sign() * w))
        };
        let beyond = |force: f64| excess(force - slack_n - k * slack_m);
        match claimed {
            Contact::Free => [Direction::Positive, Direction::Negative]
                .into_iter()
                .filter_map(of)
                .filter(|(delta, _)| !(*delta <= slack_m))
                .fold(0.0, |worst, (_, force)| beyond(force).max(worst)),
            Contact::Pressed(side) => match of(side) {
                None => f64::INFINITY,
                Some((delta, force)) if delta < -slack_m => larger(0.0, force),
                Some((_, force)) => beyond(-force),
            },
            Contact::Separated(side) => match of(side) {
                None => f64::INFINITY,
                Some((delta, _)) if delta < -slack_m => larger(0.0, k * delta),
                Some((_, force)) => beyond(force),
            },
        }
    }

    /// What the rounding of times and of vertical motion makes of a force of friction at most.
    pub(super) fn rounding(&self, ground: &Ground<'_>, instant_s: f64, normal: f64) -> f64 {
        self.fixed[0].max(self.fixed[1]) * ground.normal_rounding(instant_s, normal)
    }

    /// Largest `μ_s N`, or the weight where that is 0: the scale of [`super::Certificate::friction_excess`].
    pub(super) fn scale(&self, normal: f64, weight: f64) -> f64 {
        let bound = self.fixed[0].max(self.fixed[1]) * normal;
        if bound > 0.0 { bound } else { weight }
    }

    /// `T = −μ_k N sgn ṡ`; with friction by speed what [`speed_factor`](Self::speed_factor) multiplies.
    pub(super) fn sliding_load(&self, direction: Direction, normal: f64) -> f64 {
        let mu = match &self.rate {
            Some(rate) => rate.factor(direction),
            None => self.kinetic[index(direction)],
        };
        -direction.sign() * mu * normal
    }

    /// What friction by speed makes of a load of sliding; 1 without.
    pub(super) fn speed_factor(&self, w: f64) -> f64 {
        self.rate.as_ref().map_or(1.0, |rate| rate.coefficients([w.abs()])[0])
    }

    /// `μ_k` at a speed.
    pub(super) fn kinetic(&self, direction: Direction, speed: f64) -> f64 {
        -direction.sign() * self.sliding_load(direction, 1.0) * self.speed_factor(speed)
    }

    /// Whether a slip in this direction could turn into a stick without slowing down to it smoothly.
    pub(super) fn drops(&self, direction: Direction) -> bool {
        self.kinetic(direction, 0.0) < self.fixed[index(direction)]
    }

    /// What friction by speed adds to the rates of a slip, as [`RateFriction::rate`] has it.
    pub(super) fn added_rate(&self, normal: f64, acceleration: f64) -> f64 {
        let fixed = self.fixed[0].max(self.fixed[1]);
        self.rate.as_ref().map_or(0.0, |rate| rate.rate(normal, acceleration, fixed))
    }

    /// The bound that a demand of this sign meets: too large a `T` slides the block towards −x.
    pub(super) fn bound(&self, demand: f64, normal: f64) -> f64 {
        self.fixed[if demand > 0.0 { 1 } else { 0 }] * normal
    }

    /// How far a demand lies beyond its bound, in N; negative within.
    pub(super) fn beyond(&self, demand: f64, normal: f64) -> f64 {
        demand.abs() - self.bound(demand, normal)
    }

    /// `1 − |demand|/bound`; `None` without a bound.
    pub(super) fn margin(&self, demand: f64, normal: f64) -> Option<f64> {
        let bound = self.bound(demand, normal);
        (bound > 0.0).then(|| 1.0 - demand.abs() / bound)
    }

    /// `|T + μ_k N sgn ṡ|` for the direction in which the block really moves, at a velocity.
    pub(super) fn sliding_excess(
        &self,
        force: f64,
        (direction, w): (Direction, f64),
        normal: f64,
    ) -> f64 {
        (force - self.sliding_load(direction, normal) * self.speed_factor(w)).abs()
    }

    /// The same for a slip whose velocity has the wrong sign. Where no kinetic friction tells the
    /// directions apart the static one stands for it: eq. (4) was not asked at ṡ = 0.
    pub(super) fn wrong_way(&self, claimed: Direction, normal: f64) -> f64 {
        let force = self.sliding_load(claimed, normal) * self.speed_factor(0.0);
        let excess = self.sliding_excess(force, (claimed.opposite(), 0.0), normal);
        if excess > 0.0 { excess } else { self.fixed[0].max(self.fixed[1]) * normal }
    }

    /// By how much a demand forbids a change to a mode at ṡ = 0, in N, or 0: eqs (1), (3), (4).
    pub(super) fn forbids(&self, to: Mode, demand: f64, normal: f64) -> f64 {
        let beyond = match to {
            Mode::Stick => self.beyond(demand, normal),
            Mode::Slip(Direction::Positive) => demand + self.fixed[0] * normal,
            Mode::Slip(Direction::Negative) => self.fixed[1] * normal - demand,
        };
        excess(beyond)
    }
}

/// What a change of contact is called.
pub(super) fn contact_event(before: Contact, after: Contact) -> Option<EventKind> {
    match (before, after) {
        (Contact::Free, Contact::Pressed(_) | Contact::Separated(_)) => Some(EventKind::Contact),
        (Contact::Pressed(_), Contact::Separated(_)) => Some(EventKind::Separation),
        (Contact::Separated(_), Contact::Pressed(_)) => Some(EventKind::Press),
        (Contact::Pressed(_) | Contact::Separated(_), Contact::Free) => Some(EventKind::Leave),
        _ => None,
    }
}

/// Place of a direction in pairs.
pub(super) fn index(direction: Direction) -> usize {
    match direction {
        Direction::Positive => 0,
        Direction::Negative => 1,
    }
}

/// The least of the inner values, if it is below both ends.
pub(super) fn dip(values: &[f64; POINTS]) -> Option<usize> {
    let least = (0..POINTS).fold(0, |best, i| if values[i] < values[best] { i } else { best });
    (least > 0 && least + 1 < POINTS).then_some(least)
}

/// Local minima of a quantity within one phase, fed in order of time.
///
/// A minimum counts once the quantity has fallen to it and risen from it by more than `slack`, the
/// rounding of the values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dips {
    slack: f64,
    falling: bool,
    turn: f64,
    turn_s: f64,
    /// Largest value.
    peak: f64,
    least: Option<(f64, f64)>,
}

impl Dips {
    pub(super) fn new(slack: f64) -> Self {
        Self { slack, falling: false, turn: f64::NAN, turn_s: 0.0, peak: 0.0, least: None }
    }

    /// Takes a value that is no minimum.
    pub(super) fn see(&mut self, value: f64) {
        self.peak = self.peak.max(value);
    }

    /// The least minimum so far, or ∞.
    pub(super) fn so_far(&self) -> f64 {
        self.least.map_or(f64::INFINITY, |(least, _)| least)
    }

    /// Takes the next value.
    pub(super) fn feed(&mut self, time_s: f64, value: f64) {
        self.peak = self.peak.max(value);
        let onward = if self.falling { value <= self.turn } else { value >= self.turn };
        if onward || self.turn.is_nan() {
            (self.turn, self.turn_s) = (value, time_s);
        } else if (value - self.turn).abs() > self.slack {
            if self.falling {
                self.take(self.turn_s, self.turn);
            }
            self.falling = !self.falling;
            (self.turn, self.turn_s) = (value, time_s);
        }
    }

    /// Takes the values at the points of a step, with the least between two where they dip there.
    pub(super) fn feed_points(
        &mut self,
        rule: &Rule,
        (from_s, step_s): (f64, f64),
        values: &[f64; POINTS],
    ) {
        let inner = dip(values);
        for i in 0..POINTS {
            let (t, value) = if inner == Some(i) {
                rule.least(values, i, |_, value| value)
            } else {
                (rule.points[i], values[i])
            };
            self.feed(from_s + t * step_s, value);
        }
    }

    /// Takes a value as a minimum.
    pub(super) fn take(&mut self, time_s: f64, value: f64) {
        if self.least.is_none_or(|(least, _)| value < least) {
            self.least = Some((value, time_s));
        }
    }

    /// Starts anew after a stretch without values.
    pub(super) fn interrupt(&mut self) {
        (self.falling, self.turn) = (false, f64::NAN);
    }

    /// The least minimum of an interface's margin in stick.
    pub(super) fn least(&self, interface: usize) -> Option<ClosestCall> {
        let (margin, time_s) = self.least?;
        Some(ClosestCall { margin, time_s, kind: "stick", interface })
    }

    /// The least minimum of an interface's speed in slip over its largest value.
    pub(super) fn least_of_peak(&self, interface: usize) -> Option<ClosestCall> {
        let (least, time_s) = self.least?;
        let margin = least / self.peak;
        (self.peak > 0.0).then_some(ClosestCall { margin, time_s, kind: "slip", interface })
    }
}
