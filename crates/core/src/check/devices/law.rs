//! The laws of the slider as the judge of devices reads them.

use super::super::law::{Law, Push, index};
use crate::model::{Model, StopKind};
use crate::response::{Contact, Mode};
use crate::slider::{Direction, Surface, SurfacesInSeries};

/// Thresholds closer than this part of the largest are the same.
const SAME: f64 = 1e-13;
/// A threshold is passed by less than this part of the friction within the rounding of the times.
const PASSED: f64 = 1e-10;

/// A surface is at its end from this part of its travel on: bounces at a stop leave it by little more.
const AT_END: f64 = 1.0 - 4.0 * f64::EPSILON;

/// What friction is asked for and between which forces it holds, in N.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    pub(super) demand: f64,
    pub(super) low: f64,
    pub(super) high: f64,
    /// The same of friction alone, where rigid stops hold too.
    pub(super) friction: [f64; 2],
}

impl Asked {
    /// How far the demand lies beyond what holds, in N; negative within.
    pub(super) fn beyond(&self) -> f64 {
        (self.demand - self.high).max(self.low - self.demand)
    }

    /// Distance from the nearest bound over the larger one, or over the one that the demand is on the
    /// side of.
    pub(super) fn margin(&self) -> Option<f64> {
        if self.low <= 0.0 && self.high >= 0.0 {
            let bound = if self.demand < 0.0 { -self.low } else { self.high };
            return (bound > 0.0).then(|| (1.0 - self.demand.abs() / bound).abs());
        }
        let scale = self.low.abs().max(self.high.abs());
        (self.high > self.low && scale.is_finite()).then(|| self.beyond().abs() / scale)
    }

    /// What friction takes of the demand; a stop takes the rest.
    pub(super) fn taken(&self) -> f64 {
        let [low, high] = self.friction;
        let least = if self.low == f64::NEG_INFINITY { low } else { f64::NEG_INFINITY };
        let most = if self.high == f64::INFINITY { high } else { f64::INFINITY };
        self.demand.max(least).min(most)
    }
}

pub(super) struct Slider<'a> {
    pub(super) law: Law,
    fixed: [f64; 2],
    radius_m: Option<f64>,
    series: Option<&'a SurfacesInSeries>,
    spring: f64,
    damper: f64,
    /// Restitution of rigid stops and where they stand.
    pub(super) e: Option<f64>,
    gap_m: [Option<f64>; 2],
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

impl<'a> Slider<'a> {
    pub(super) fn new(model: &'a Model, vertical: bool) -> Self {
        let radius_m = model.slider().pendulum_radius_m(vertical);
        let (e, gap_m) = match model.stop() {
            Some(stop) => match stop.kind {
                StopKind::Rigid { restitution } => (Some(restitution), stop.gap_m),
                StopKind::Elastic { .. } => (None, [None; 2]),
            },
            None => (None, [None; 2]),
        };
        Self {
            law: Law::new(model),
            fixed: model.static_friction(),
            radius_m,
            series: model.slider().series(),
            spring: if radius_m.is_some() { 0.0 } else { model.slider_stiffness_n_per_m() },
            damper: model.slider().damper_n_s_per_m,
            e,
            gap_m,
        }
    }

    /// Whether its spring follows the normal force.
    pub(super) fn is_pendulum(&self) -> bool {
        self.radius_m.is_some()
    }

    /// `N s / R`.
    pub(super) fn pendulum(&self, s: f64, normal: f64) -> f64 {
        self.radius_m.map_or(0.0, |radius_m| normal * s / radius_m)
    }

    /// Force of spring, pendulum and damper.
    pub(super) fn spring(&self, s: f64, w: f64, normal: f64) -> f64 {
        self.spring * s + self.pendulum(s, normal) + self.damper * w
    }

    /// What the elastic stop does.
    pub(super) fn stop(&self, contact: Contact) -> Push {
        self.law.push(contact)
    }

    pub(super) fn contact_excess(&self, claimed: Contact, at: (f64, f64), slack: [f64; 2]) -> f64 {
        self.law.contact_excess(claimed, at, slack)
    }

    /// `μ(|ṡ|)`.
    pub(super) fn kinetic(&self, direction: Direction, speed: f64) -> f64 {
        self.law.kinetic(direction, speed)
    }

    /// What the laws add to the rates of a slip, in 1/s: for a normal force over the block's mass, and
    /// an acceleration of the block over the table.
    pub(super) fn rate(&self, normal: f64, acceleration: f64) -> f64 {
        let mut rate = self.radius_m.map_or(0.0, |radius_m| libm::sqrt(normal / radius_m));
        if let Some(series) = self.series {
            let radii = series.surfaces().iter().filter_map(|surface| surface.radius_m);
            let least = radii.fold(f64::INFINITY, f64::min);
            rate += libm::sqrt(normal / least);
        }
        rate + self.law.added_rate(normal, acceleration)
    }

    /// The largest coefficient at rest.
    pub(super) fn most(&self) -> f64 {
        self.fixed[0].max(self.fixed[1])
    }

    /// Largest `μ_s N`, or the weight where that is 0.
    pub(super) fn scale(&self, normal: f64, weight: f64) -> f64 {
        self.law.scale(normal, weight)
    }

    /// Whether a slip could turn into a stick without slowing down to it smoothly.
    pub(super) fn drops(&self, direction: Direction) -> bool {
        match self.series {
            Some(series) => series.static_ratio() > 1.0,
            None => self.law.drops(direction),
        }
    }

    /// What static friction holds, in N.
    fn fixed_n(&self, normal: f64) -> [f64; 2] {
        [-self.fixed[0] * normal, self.fixed[1] * normal]
    }

    /// Where the rigid stop of a direction stands.
    pub(super) fn wall(&self, direction: Direction) -> Option<f64> {
        let gap_m = self.e.and(self.gap_m[index(direction)])?;
        Some(direction.sign() * gap_m)
    }

    /// By how much `s` lies beyond a rigid stop in m; none without one.
    pub(super) fn beyond_walls(&self, s: f64) -> Option<f64> {
        self.e?;
        let both = [Direction::Positive, Direction::Negative];
        let beyond = both
            .into_iter()
            .filter_map(|side| Some(side.sign() * (s - self.wall(side)?)))
            .fold(0.0, f64::max);
        Some(beyond)
    }

    /// Against which stops a block at `s` rests.
    pub(super) fn leans(&self, s: f64, slack_m: f64) -> [bool; 2] {
        [Direction::Positive, Direction::Negative]
            .map(|side| self.wall(side).is_some_and(|wall| side.sign() * (s - wall) >= -slack_m))
    }

    /// What holds a block at rest at `s`, with surfaces in series at these displacements.
    pub(super) fn asked(
        &self,
        demand: f64,
        (s, slack_m): (f64, f64),
        surfaces: &[f64],
        normal: f64,
    ) -> Asked {
        let [mut low, mut high] = match self.series {
            None => self.fixed_n(normal),
            Some(series) => {
                // max(u/R − r μ) ≤ F/N ≤ min(u/R + r μ), and T = −F.
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
                [-most * normal, -least * normal]
            }
        };
        let friction = [low, high];
        let [positive, negative] = self.leans(s, slack_m);
        if positive {
            low = f64::NEG_INFINITY;
        }
        if negative {
            high = f64::INFINITY;
        }
        Asked { demand, low, high, friction }
    }

    /// Displacements of surfaces of which those that have slid in a direction are off their ends on the
    /// other side, where they have moved by less than their rounding.
    pub(super) fn off_ends(&self, surfaces: &[f64], slid: Direction) -> Vec<f64> {
        let mut all = surfaces.to_vec();
        if let (Some(series), Some(sliding)) = (self.series, self.sliding(surfaces, slid, false)) {
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
        let Some(series) = self.series else { return Vec::new() };
        let mut all = surfaces.iter().zip(series.surfaces());
        let ended = all.any(|(u, surface)| is_at_end(surface, direction.sign() * u));
        let ways = [false, true].into_iter().take(if ended { 2 } else { 1 });
        ways.filter_map(|off_ends| self.sliding(surfaces, direction, off_ends)).collect()
    }

    /// The same with all at their ends still there, or all off them.
    fn sliding(&self, surfaces: &[f64], direction: Direction, off_ends: bool) -> Option<Sliding> {
        let series = self.series?;
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
        let Some(series) = self.series else { return 0.0 };
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
        let Some(series) = self.series else { return 0.0 };
        let all = surfaces.iter().zip(series.surfaces());
        all.filter_map(|(u, surface)| Some(u.abs() - surface.travel_m?)).fold(0.0, f64::max)
    }

    /// Where a slip in a mode has come to a halt: how far the force was from the next surface's, over
    /// that.
    pub(super) fn next_join(&self, surfaces: &[f64], mode: Mode) -> Option<f64> {
        let Mode::Slip(direction) = mode else { return None };
        let sliding = self.sliding(surfaces, direction, false)?;
        let series = self.series?;
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
