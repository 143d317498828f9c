//! The laws of friction and stop as a judge reads them.

use super::ground::Ground;
use super::rate::RateFriction;
use super::structure::{excess, larger};
use crate::model::{Model, Stop, StopKind};
use crate::response::{Contact, Mode};
use crate::slider::{Direction, Surface, SurfacesInSeries};

/// Thresholds of surfaces closer than this part of the largest are the same.
const SAME: f64 = 1e-13;
/// A threshold is passed by less than this part of the friction within the rounding of the times.
const PASSED: f64 = 1e-10;
/// A surface is at its end from this part of its travel on: bounces at a stop leave it by little more.
const AT_END: f64 = 1.0 - 4.0 * f64::EPSILON;

/// Stands for no bound, so that it can be multiplied by 0.
pub(super) const UNBOUNDED: f64 = 1e200;
/// No bound either way.
pub(super) const BOUNDLESS: [f64; 2] = [-UNBOUNDED, UNBOUNDED];

/// Some numbers where a stop is leaned against, others where it is not.
pub(super) fn either(bears_on_stop: [bool; 2], those: [f64; 2], others: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| if bears_on_stop[i] { those[i] } else { others[i] })
}

/// What friction is asked for and between which forces it holds, in N.
#[derive(Clone, Copy, Debug)]
pub(super) struct StickDemand {
    pub(super) demand: f64,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl StickDemand {
    /// How far the demand lies beyond what holds, in N; negative within.
    pub(super) fn beyond(&self) -> f64 {
        (self.demand - self.high).max(self.low - self.demand)
    }

    /// What a margin is measured by.
    pub(super) fn bound(&self) -> f64 {
        if self.low <= 0.0 && self.high >= 0.0 {
            return if self.demand > 0.0 { self.high } else { -self.low };
        }
        self.low.abs().max(self.high.abs())
    }

    /// Distance from the nearest bound over the larger one, or over the one that the demand is on the
    /// side of, negative beyond; `None` without a bound.
    pub(super) fn margin(&self) -> Option<f64> {
        let (bound, straddles) = (self.bound(), self.low <= 0.0 && self.high >= 0.0);
        if straddles {
            return (bound > 0.0).then(|| 1.0 - self.demand.abs() / bound);
        }
        (self.high > self.low && bound.is_finite()).then(|| -self.beyond() / bound)
    }
}

/// Bounds and kinetic forces for each direction, restoring forces that follow `N`, and the stop.
pub(super) struct Law {
    fixed: [f64; 2],
    kinetic: [f64; 2],
    /// In place of the kinetic coefficients, where there is one.
    pub(super) rate: Option<RateFriction>,
    pub(super) series: Option<SurfacesInSeries>,
    /// Of a pendulum whose spring follows `N`.
    radius_m: Option<f64>,
    /// Where coefficients follow a pressure that varies: the exponent `m`, and `N` at rest.
    pressure: Option<[f64; 2]>,
    stop: Option<Stop>,
}

/// What a stop does while it acts: the block pushes it with `k s + c ṡ − shift` towards +x.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Push {
    stiffness: f64,
    damper: f64,
    shift: f64,
}

impl Push {
    /// Force of the block on the stop towards +x.
    pub(super) fn force(&self, s: f64, w: f64) -> f64 {
        self.stiffness * s + self.damper * w - self.shift
    }

    /// Stiffness, damper and shift.
    pub(super) fn numbers(&self) -> [f64; 3] {
        [self.stiffness, self.damper, self.shift]
    }

    /// What its spring has stored: `(k s − shift)²/(2 k)`.
    pub(super) fn strain(&self, s: f64) -> f64 {
        let force = self.force(s, 0.0);
        if force == 0.0 { 0.0 } else { 0.5 * force * (force / self.stiffness) }
    }
}

/// A slip on surfaces in series: which slide, and the force over the normal force.
#[derive(Clone, Debug)]
pub(super) struct Sliding {
    shares: Vec<f64>,
    /// Signed force at the knot, and its slope over `s`.
    phi: f64,
    slope: f64,
    direction: Direction,
}

impl Sliding {
    /// `F/N` after a displacement.
    pub(super) fn force(&self, moved: f64) -> f64 {
        self.phi + self.slope * moved
    }

    /// `p₀, p₁` of `T/N = p₀ − p₁ s` in a slip that begins at `s`.
    pub(super) fn friction(&self, s: f64) -> [f64; 2] {
        [self.slope * s - self.phi, self.slope]
    }

    /// Displacements of the surfaces after one, from those at the knot.
    pub(super) fn displacements(&self, from: &[f64], moved: f64) -> Vec<f64> {
        from.iter().zip(&self.shares).map(|(u, share)| u + share * moved).collect()
    }

    /// Which slide.
    pub(super) fn active(&self) -> Vec<bool> {
        self.shares.iter().map(|share| *share > 0.0).collect()
    }
}

/// Whether a surface has no travel left one way, after a displacement that way.
fn is_at_end(surface: &Surface, u: f64) -> bool {
    surface.travel_m.is_some_and(|travel_m| u >= travel_m * AT_END)
}

impl Law {
    pub(super) fn new(model: &Model, vertical: bool) -> Self {
        Self {
            fixed: model.static_friction(),
            kinetic: model.kinetic_friction(),
            rate: RateFriction::new(model),
            series: model.slider().series().cloned(),
            radius_m: model.slider().pendulum_radius_m(vertical).filter(|_| vertical),
            pressure: model
                .slider()
                .pressure_exponent(vertical)
                .map(|exponent| [exponent, model.normal_n()]),
            stop: model.stop().copied(),
        }
    }

    /// Whether friction follows a power of the normal force.
    pub(super) fn follows_pressure(&self) -> bool {
        self.pressure.is_some()
    }

    /// What the coefficients are multiplied by: `N`, or `N (N/N₀)^(−m)` where they follow the pressure.
    pub(super) fn pressed(&self, normal: f64) -> f64 {
        match self.pressure {
            Some([exponent, at_rest]) if normal > 0.0 => {
                normal * libm::pow(normal / at_rest, -exponent)
            }
            _ => normal,
        }
    }

    /// What the rounding of `N` makes of that.
    pub(super) fn pressed_rounding(&self, normal: f64, rounding: f64) -> f64 {
        match self.pressure {
            Some(_) => self.pressed(normal + rounding) - self.pressed(normal),
            None => rounding,
        }
    }

    /// The largest `|p₀|` of a slip: of friction by speed by the line of any of its pieces.
    pub(super) fn most_sliding(&self) -> f64 {
        self.rate.as_ref().map_or(self.most(), RateFriction::most)
    }

    /// The largest coefficient at rest.
    pub(super) fn most(&self) -> f64 {
        self.fixed[0].max(self.fixed[1])
    }

    /// What the rounding of times and of vertical motion makes of a force of friction at most.
    pub(super) fn rounding(&self, ground: &Ground<'_>, instant_s: f64, normal: f64) -> f64 {
        self.most() * ground.normal_rounding(instant_s, normal)
    }

    /// `1/R` of a spring that follows `N`.
    pub(super) fn curvature_per_m(&self) -> f64 {
        self.radius_m.map_or(0.0, |radius_m| 1.0 / radius_m)
    }

    /// Whether a force on the block follows `N` and `s`.
    pub(super) fn follows(&self) -> bool {
        self.series.is_some() || self.is_pendulum()
    }

    /// Whether the spring follows the normal force.
    pub(super) fn is_pendulum(&self) -> bool {
        self.radius_m.is_some()
    }

    /// `T/N` of sliding: with friction by speed what `μ(|ṡ|)` multiplies.
    pub(super) fn sliding_load(&self, direction: Direction) -> f64 {
        let mu = match &self.rate {
            Some(rate) => rate.factor(direction),
            None => direction.of(self.kinetic),
        };
        -direction.sign() * mu
    }

    /// `μ_k` at a sliding speed of a slider that is the same in all directions, and its slope in s/m.
    pub(super) fn kinetic_at(&self, speed_m_per_s: f64) -> [f64; 2] {
        match &self.rate {
            Some(rate) => {
                let factor = rate.factor(Direction::Positive);
                [rate.coefficient(speed_m_per_s), rate.slope_s_per_m(speed_m_per_s)]
                    .map(|own| factor * own)
            }
            None => [self.kinetic[0], 0.0],
        }
    }

    /// Whether there is no kinetic friction at any speed.
    pub(super) fn has_no_kinetic(&self) -> bool {
        match &self.rate {
            Some(rate) => rate.is_none(),
            None => self.kinetic == [0.0; 2],
        }
    }

    /// `μ_k` at rest.
    fn kinetic_at_rest(&self, direction: Direction) -> f64 {
        let factor = self.rate.as_ref().map_or(1.0, |rate| rate.coefficient(0.0));
        self.sliding_load(direction).abs() * factor
    }

    /// Whether a slip in this direction could turn into a stick without slowing down to it smoothly.
    pub(super) fn drops(&self, direction: Direction) -> bool {
        match &self.series {
            Some(series) => series.static_ratio() > 1.0,
            None => self.kinetic_at_rest(direction) < direction.of(self.fixed),
        }
    }

    /// `|T + μ_k N sgn ṡ|` over `N` for a slip whose velocity has the wrong sign. Where no kinetic
    /// friction tells the directions apart the static one stands for it: eq. (4) was not asked at ṡ = 0.
    pub(super) fn wrong_way(&self) -> f64 {
        let [positive, negative] = Direction::BOTH.map(|way| self.kinetic_at_rest(way));
        let excess = if self.series.is_some() { 0.0 } else { positive + negative };
        if excess > 0.0 { excess } else { self.most() }
    }

    /// What the laws add to the rates of a slip, in 1/s: for a normal force over the block's mass, and
    /// the largest acceleration of the block over the table.
    pub(super) fn added_rate(&self, normal: f64, acceleration: f64) -> f64 {
        let mut rate = libm::sqrt(normal * self.curvature_per_m());
        if let Some(series) = &self.series {
            let radii = series.surfaces().iter().filter_map(|surface| surface.radius_m);
            rate += libm::sqrt(normal / radii.fold(f64::INFINITY, f64::min));
        }
        rate + self.rate.as_ref().map_or(0.0, |r| r.rate(normal, acceleration, self.most()))
    }

    /// Restitution of a rigid stop.
    pub(super) fn restitution(&self) -> Option<f64> {
        match self.stop.as_ref()?.kind {
            StopKind::Rigid { restitution } => Some(restitution),
            StopKind::Elastic { .. } => None,
        }
    }

    /// Where the rigid stop of a direction stands.
    pub(super) fn wall(&self, direction: Direction) -> Option<f64> {
        self.restitution()?;
        Some(direction.sign() * self.stop.as_ref()?.gap_towards(direction)?)
    }

    /// By how much `s` lies beyond a rigid stop, in m.
    pub(super) fn beyond_walls(&self, s: f64) -> f64 {
        let beyond = |side: Direction| Some(side.sign() * (s - self.wall(side)?));
        let sides = Direction::BOTH.into_iter().filter_map(beyond);
        sides.fold(0.0, f64::max)
    }

    /// Against which stops a block at `s` rests: within the rounding of `s`.
    pub(super) fn bears_on_stop(&self, s: f64) -> [bool; 2] {
        let off = |side: Direction, wall: f64| side.sign() * (wall - s);
        Direction::BOTH.map(|side| {
            self.wall(side).is_some_and(|wall| off(side, wall) <= 8.0 * f64::EPSILON * wall.abs())
        })
    }

    /// Least and largest `T/N` that hold a block at rest with surfaces in series at these displacements:
    /// `max(u/R − r μ) ≤ F/N ≤ min(u/R + r μ)`, and `T = −F`.
    pub(super) fn hold(&self, surfaces: &[f64]) -> [f64; 2] {
        let Some(series) = &self.series else { return [-self.fixed[0], self.fixed[1]] };
        let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
        for (u, surface) in surfaces.iter().zip(series.surfaces()) {
            let place = surface.radius_m.map_or(0.0, |radius_m| u / radius_m);
            let friction = series.static_ratio() * surface.friction;
            let travel_m = surface.travel_m.unwrap_or(f64::INFINITY);
            if *u > -travel_m * AT_END {
                least = least.max(place - friction);
            }
            if *u < travel_m * AT_END {
                most = most.min(place + friction);
            }
        }
        [-most, -least]
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

    /// Contact with an elastic stop before a start at `s` and `w`: beyond the gap the stop pushes unless the
    /// block runs ahead of it; at the gap, if the block moves on.
    pub(super) fn contact_at_start(&self, s: f64, w: f64) -> Contact {
        let Some(StopKind::Elastic { .. }) = self.stop.as_ref().map(|stop| stop.kind) else {
            return Contact::Free;
        };
        let gap_m = |side| self.stop.as_ref()?.gap_towards(side);
        for side in Direction::BOTH {
            let Some(delta) = gap_m(side).map(|gap_m| side.sign() * s - gap_m) else { continue };
            let push = side.sign() * self.push(Contact::Pressed(side)).force(s, w);
            if delta > 0.0 {
                return if push >= 0.0 { Contact::Pressed(side) } else { Contact::Separated(side) };
            }
            if delta == 0.0 && side.sign() * w > 0.0 {
                return Contact::Pressed(side);
            }
        }
        Contact::Free
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
            Contact::Free => Direction::BOTH
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

    /// Largest `μ_s N`, or the weight where that is 0: the scale of [`super::Certificate::friction_excess`].
    pub(super) fn scale(&self, normal: f64, weight: f64) -> f64 {
        let bound = self.most() * normal;
        if bound > 0.0 { bound } else { weight }
    }

    /// Displacements of surfaces of which those that have slid in a direction are off their ends on the
    /// other side, where they have moved by less than their rounding.
    pub(super) fn off_ends(&self, surfaces: &[f64], slid: Direction) -> Vec<f64> {
        let mut all = surfaces.to_vec();
        if let (Some(series), Some(sliding)) = (&self.series, self.sliding(surfaces, slid, false)) {
            let active = sliding.active();
            for ((u, surface), active) in all.iter_mut().zip(series.surfaces()).zip(active) {
                if active && is_at_end(surface, -slid.sign() * *u) {
                    *u *= 1.0 - 8.0 * f64::EPSILON;
                }
            }
        }
        all
    }

    /// How a slip in a direction goes on from these displacements of surfaces in series, of which those
    /// at their ends may have left them by less than their rounding: the ways that are then possible.
    pub(super) fn slidings(&self, surfaces: &[f64], direction: Direction) -> Vec<Sliding> {
        let Some(series) = &self.series else { return Vec::new() };
        let mut all = surfaces.iter().zip(series.surfaces());
        let ended = all.any(|(u, surface)| is_at_end(surface, direction.sign() * u));
        let ways = [false, true].into_iter().take(if ended { 2 } else { 1 });
        ways.filter_map(|off_ends| self.sliding(surfaces, direction, off_ends)).collect()
    }

    /// How a slip goes on with all surfaces at their ends still there, or all off them.
    fn sliding(&self, surfaces: &[f64], direction: Direction, off_ends: bool) -> Option<Sliding> {
        let series = self.series.as_ref()?;
        let sign = direction.sign();
        let all = || surfaces.iter().zip(series.surfaces());
        let thresholds: Vec<Option<f64>> = all()
            .map(|(u, surface)| {
                let ended = !off_ends && is_at_end(surface, sign * u);
                let place = surface.radius_m.map_or(0.0, |radius_m| u / radius_m);
                (!ended).then_some(sign * place + surface.friction)
            })
            .collect();
        let least = thresholds.iter().flatten().fold(f64::INFINITY, |a, b| a.min(*b));
        let size = series.surfaces().iter().fold(least.abs(), |a, s| a.max(s.friction));
        let slides: Vec<bool> =
            thresholds.iter().map(|t| t.is_some_and(|t| t <= least + SAME * size)).collect();
        let radius = |i: usize| series.surfaces()[i].radius_m;
        let flat = (0..slides.len()).filter(|&i| slides[i] && radius(i).is_none()).count();
        let sum: f64 = (0..slides.len()).filter(|&i| slides[i]).filter_map(radius).sum();
        let share = |i: usize| match (slides[i], radius(i)) {
            (false, _) => 0.0,
            (true, None) => 1.0 / flat as f64,
            (true, Some(_)) if flat > 0 => 0.0,
            (true, Some(radius_m)) => radius_m / sum,
        };
        Some(Sliding {
            shares: (0..slides.len()).map(share).collect(),
            phi: sign * least,
            slope: if flat > 0 { 0.0 } else { 1.0 / sum },
            direction,
        })
    }

    /// By how much surfaces break `|u/R − φ| ≤ μ` after a displacement in a slip, over the normal force.
    pub(super) fn series_excess(&self, sliding: &Sliding, surfaces: &[f64], moved: f64) -> f64 {
        let Some(series) = &self.series else { return 0.0 };
        let (phi, sign) = (sliding.force(moved), sliding.direction.sign());
        let mut worst: f64 = 0.0;
        for (u, surface) in surfaces.iter().zip(series.surfaces()) {
            let ended = is_at_end(surface, sign * u);
            let place = surface.radius_m.map_or(0.0, |radius_m| u / radius_m);
            if !ended {
                worst = worst.max(sign * (phi - place) - surface.friction);
            }
        }
        if worst <= PASSED * self.fixed[0] { 0.0 } else { worst }
    }

    /// By how much surfaces lie beyond their ends, in m.
    pub(super) fn beyond_ends(&self, surfaces: &[f64]) -> f64 {
        let Some(series) = &self.series else { return 0.0 };
        let all = surfaces.iter().zip(series.surfaces());
        all.filter_map(|(u, surface)| Some(u.abs() - surface.travel_m?)).fold(0.0, f64::max)
    }

    /// Where a slip in a mode has come to a halt: how far the force was from the next surface's, over
    /// that.
    pub(super) fn next_join(&self, surfaces: &[f64], mode: Mode) -> Option<f64> {
        let Mode::Slip(direction) = mode else { return None };
        let sliding = self.sliding(surfaces, direction, false)?;
        let series = self.series.as_ref()?;
        let sign = direction.sign();
        let held = sign * sliding.phi;
        surfaces
            .iter()
            .zip(series.surfaces())
            .zip(sliding.active())
            .filter(|((u, surface), active)| !active && !is_at_end(surface, sign * *u))
            .map(|((u, surface), _)| {
                let place = surface.radius_m.map_or(0.0, |radius_m| u / radius_m);
                let threshold = sign * place + surface.friction;
                (threshold - held) / threshold.abs().max(surface.friction)
            })
            .reduce(f64::min)
    }
}
