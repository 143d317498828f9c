//! The stop around the block: its force over a step, where contact with it changes, and its peak.
//!
//! Pressed, the ring takes a force that bends with the motion: over a step it is the polynomial through its values at the
//! nodes, found by correcting it by the motion that it makes. Steps are so short that this polynomial is exact to rounding,
//! so that it is a load of the series like any other.

use super::Plane;
use super::nodes::{AtNodes, NODES, nodes};
use super::speed::turns;
use super::vector::{cross, inner, norm};
use crate::linear::polynomial::{Polynomial, ZERO, derivative, value};
use crate::response::Contact;
use crate::slider::Ring;
use crate::solver::ground::Stretch;
use crate::solver::slider::{first_crossing, leading};

use super::peaks::squared;
use super::series::Kind;
use super::system::{Loads, State};

/// The last Legendre coefficients of the force over a step: this part of its largest value is as good as none.
const TAIL: f64 = 1e-13;

/// Roundings of `k ρ + c |w|` that the force of the stop is known to.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Roundings by which that force has to be below zero, or above, to have passed it.
const PASSED: f64 = 8.0;

/// A correction of the force at the nodes that is rounding, over its largest value.
const SETTLED: f64 = 4.0 * f64::EPSILON;

/// Part of `d²` by which a block is off the stop and still near it.
const NEAR: f64 = 1e-3;

/// Most lengths that are tried for a step without friction, and most corrections of the force over each.
const MOST_LENGTHS: usize = 60;
pub(super) const MOST_CORRECTIONS: usize = 40;

impl Plane<'_> {
    fn pressed(&self) -> Option<Ring> {
        self.system.ring.filter(|_| matches!(self.state.contact, Contact::Pressed(_)))
    }

    /// What a stop that gives way takes stays as it is in the state: at an instant, and at rest.
    pub(super) fn hold_stop(&mut self) {
        self.hold_series(self.system.stopped(&self.state));
    }

    /// At an instant under loads, what a stop takes stays.
    pub(super) fn hold_stop_under(&mut self, loads: &Loads) {
        let [stopped, borne] = [self.system.stopped(&self.state), self.borne(loads)];
        self.hold_series([stopped[0] + borne[0], stopped[1] + borne[1]]);
    }

    fn hold_series(&mut self, stopped: [f64; 2]) {
        self.series.along_stop = None;
        for (series, now) in self.series.stopped.iter_mut().zip(stopped) {
            (*series, series[0]) = (ZERO, now);
        }
    }

    /// What a stop that does not give way takes over `M1` under loads, where the block bears on it.
    pub(super) fn borne(&mut self, loads: &Loads) -> [f64; 2] {
        self.state.borne_under(&self.system, loads, &mut self.g)
    }

    /// Whether a block that slides along a stop that does not give way no longer pushes it.
    pub(super) fn is_let_go(&mut self, loads: &Loads) -> bool {
        if self.system.bears_on(self.state.contact).is_none() || self.state.w == [0.0; 2] {
            return false;
        }
        let borne = self.borne(loads);
        let pushes = inner(self.state.s, borne) / norm(self.state.s);
        pushes < -PASSED * ROUNDING * (self.terms(loads, &self.g) + self.slowing(loads))
    }

    /// `f` of the state.
    fn slowing(&self, loads: &Loads) -> f64 {
        self.system.kinetic_per_kg.force(norm(self.state.w), loads.normal[0].max(0.0))
    }

    /// At rest against a stop that does not give way friction takes what pushes along it, up to where the block pushes it no
    /// longer, or begins to.
    pub(super) fn lean_on_stop(&mut self) {
        if self.system.bears_on(self.state.contact).is_none() {
            return;
        }
        let series = &self.series;
        let n = self.state.s.map(|s| s / norm(self.state.s));
        let [x, y] = &series.friction;
        let towards: Polynomial = core::array::from_fn(|k| inner(n, [x[k], y[k]]));
        let rounding = ROUNDING * self.terms(&series.loads, &series.g[..series.modes]);
        let sign = leading(&towards, rounding).map_or(0.0, |k| towards[k].signum());
        let mut distance = towards.map(|c| sign * c);
        distance[0] = if distance[0] <= rounding { 0.0 } else { distance[0] };
        let ends = first_crossing(&distance, self.series.part).filter(|part| *part > 0.0);
        let series = &mut self.series;
        series.part = ends.map_or(series.part, |part| part.min(series.part));
        if sign <= 0.0 {
            return;
        }
        for (axis, n) in n.into_iter().enumerate() {
            for k in 0..=series.degree {
                let borne = n * towards[k];
                series.friction[axis][k] -= borne;
                series.pull[axis][k] -= borne;
                series.stopped[axis][k] = borne;
            }
        }
    }

    /// A block that bears on a stop which does not give way stays on it, whatever rounding says; one that moves on is no
    /// longer at it.
    pub(super) fn keep_on_stop(&mut self, part: f64) {
        if let (Some(off_m2), Some(ring)) = (self.off_stop_m2, self.system.ring) {
            let mut moved = squared(&self.series.s);
            moved[0] = off_m2;
            let off_m2 = value(&moved, part);
            let near = NEAR * ring.gap_m * ring.gap_m;
            self.off_stop_m2 = Some(off_m2).filter(|off_m2| off_m2.abs() <= near);
        }
        let Some(ring) = self.system.bears_on(self.state.contact) else { return };
        let (per, gap_m) = (1.0 / norm(self.state.s), ring.gap_m);
        let n = self.state.s.map(|s| per * s);
        let off = inner(n, self.state.w);
        self.state.s = n.map(|n| gap_m * n);
        self.state.w = [0, 1].map(|k| self.state.w[k] - off * n[k]);
    }

    /// Whether a block at rest, but for rounding at a stop that does not give way, is off to push it in a direction.
    pub(super) fn sets_out_against_stop(&self, direction: [f64; 2]) -> bool {
        let (Some(off_m2), Some(ring)) = (self.off_stop_m2, self.system.ring) else { return false };
        let is_at_it = off_m2.abs() <= 8.0 * f64::EPSILON * (ring.gap_m * ring.gap_m);
        is_at_it && self.state.contact == Contact::Free && inner(self.state.s, direction) > 0.0
    }

    /// As much of a time as a step takes, which against the stop bends with its own frequency.
    pub(super) fn within_reach_of_stop(&self, left_s: f64) -> f64 {
        let [stiffness, damper] = self.system.stop_per_kg(self.state.contact);
        let [compliance, _] = self.system.stretches();
        // Along one that does not give way the force turns with the block.
        let turns =
            self.system.bears_on(self.state.contact).map(|ring| norm(self.state.w) / ring.gap_m);
        let rate = turns.unwrap_or((compliance * stiffness).sqrt() + compliance * damper);
        let within_s = self.system.within_reach(left_s);
        if rate > 0.0 { within_s.min(1.0 / rate) } else { within_s }
    }

    /// The force of the stop at the nodes of a step to begin with: along the velocity that the block has.
    pub(super) fn guess_stop(&mut self, (loads, step_s): (Loads, f64)) {
        let Some(ring) = self.pressed() else {
            self.force.stopped = [[0.0; NODES]; 2];
            (self.force.along_stop, self.series.along_stop) = (None, None);
            self.borne_terms = 0.0;
            return;
        };
        let (s, w, kg) = (self.state.s, self.state.w, self.system.block_kg);
        let borne = self.borne(&loads);
        let bears = inner(s, borne) / norm(s);
        self.borne_terms = match ring.restitution {
            Some(_) => self.terms(&loads, &self.g) + bears.abs() + self.slowing(&loads),
            None => 0.0,
        };
        let places = nodes().at.map(|x| [0, 1].map(|k| s[k] + step_s * x * w[k]));
        for (j, place) in places.into_iter().enumerate() {
            let stopped = match ring.restitution {
                Some(_) => place.map(|s| bears / norm(place) * s),
                None => ring.force_n(place, w).map(|force_n| force_n / kg),
            };
            (0..2).for_each(|axis| self.force.stopped[axis][j] = stopped[axis]);
        }
        let heading = if w == [0.0; 2] { self.direction } else { w };
        self.series.along_stop = ring.restitution.map(|_| cross(s, heading).signum());
        self.force.along_stop = self.along_stop(&places);
    }

    /// The way along the stop at places.
    fn along_stop(&self, places: &[[f64; 2]; NODES]) -> Option<[AtNodes; 2]> {
        let sign = self.series.along_stop?;
        let along = |[x, y]: [f64; 2]| [-y, x].map(|part| sign * part / norm([x, y]));
        Some([0, 1].map(|axis| places.map(|place| along(place)[axis])))
    }

    /// Takes the force at the nodes for that of the series; how much longer a step may be for its sake.
    pub(super) fn press_series(&mut self) -> f64 {
        let coefficients = self.force.stopped.each_ref().map(|values| nodes().coefficients(values));
        let [x, y] = &coefficients;
        let last = |l: usize| norm([x[l], y[l]]);
        let tail = last(NODES - 1).max(last(NODES - 2));
        self.series.stopped = coefficients.each_ref().map(|of| nodes().polynomial(of));
        let rounding = self.stop_rounding();
        if tail <= rounding {
            return f64::INFINITY;
        }
        let most = (TAIL * largest(&self.force.stopped)).max(rounding);
        (most / tail).sqrt().sqrt().sqrt()
    }

    /// What of the force of the stop over `M1` is rounding.
    fn stop_rounding(&self) -> f64 {
        let [stiffness, damper] = self.system.stop_per_kg(self.state.contact);
        let speed = norm(self.state.w).max(self.peak_speed);
        ROUNDING * (stiffness * norm(self.state.s) + damper * speed + self.borne_terms)
    }

    /// Corrects the force at the nodes by the motion of the series; whether there was nothing to correct.
    pub(super) fn correct_stop(&mut self) -> bool {
        let Some(ring) = self.pressed() else { return true };
        let (series, kg) = (&self.series, self.system.block_kg);
        let changes = series.w.each_ref().map(derivative);
        let mut off = 0.0_f64;
        for (j, x) in nodes().at.iter().enumerate() {
            let (s, w) = (place_at(&series.s, *x), series.velocity_at(*x));
            let force = match ring.restitution {
                None => ring.force_n(s, w).map(|force_n| force_n / kg),
                // What it takes, and what of the acceleration across it is left.
                Some(_) => {
                    let taken = [0, 1].map(|axis| self.force.stopped[axis][j]);
                    let push = [0, 1].map(|k| value(&changes[k], *x) / series.unit + taken[k]);
                    let per_m = ring.bears_per_kg(s, w, push) / norm(s);
                    s.map(|s| per_m * s)
                }
            };
            for axis in 0..2 {
                let own = force[axis];
                off = off.max((own - self.force.stopped[axis][j]).abs());
                self.force.stopped[axis][j] = own;
            }
        }
        let places = nodes().at.map(|x| place_at(&self.series.s, x));
        self.force.along_stop = self.along_stop(&places);
        let most = (SETTLED * largest(&self.force.stopped)).max(0.25 * self.stop_rounding());
        off <= most
    }

    /// One step without friction against the stop.
    pub(super) fn press_freely(&mut self, (stretch, at_s): (&Stretch, f64), loads: Loads) -> f64 {
        let mut step_s = self.within_reach_of_stop(stretch.to_s - at_s);
        for _ in 0..MOST_LENGTHS {
            match self.settle_freely((loads, step_s)) {
                None => break,
                Some(shorter) => step_s *= shorter,
            }
        }
        self.end_freely(stretch, at_s)
    }

    /// Finds the force of the stop over a step without friction; how much shorter the step has to be, if it does not stand.
    fn settle_freely(&mut self, (loads, step_s): (Loads, f64)) -> Option<f64> {
        self.guess_stop((loads, step_s));
        for _ in 0..MOST_CORRECTIONS {
            let by_stop = self.press_series();
            self.expand(Kind::Frictionless, (loads, step_s));
            if !(self.series.part >= 1.0) {
                return Some(self.series.part.clamp(1e-3, 0.7));
            }
            if self.correct_stop() {
                return (by_stop < 1.0).then_some((0.9 * by_stop).clamp(0.05, 0.7));
            }
        }
        Some(0.5)
    }

    /// The first part of the series, up to one, at which contact with the stop changes, and to what.
    pub(super) fn contact_change(&self, to: f64) -> Option<(f64, Contact)> {
        let (ring, series) = (self.system.ring.as_ref()?, &self.series);
        let square = squared(&series.s);
        let gap = ring.gap_m * ring.gap_m;
        let outward = || {
            let mut distance = square.map(|c| -c);
            distance[0] += gap;
            if let Some(off_m2) = self.off_stop_m2 {
                distance[0] = -off_m2;
                self.leave_stop(&mut distance);
            }
            first_crossing(&distance, to)
        };
        let inward = || {
            let mut distance = square;
            distance[0] -= gap;
            first_crossing(&distance, to)
        };
        let leaves = || inward().map(|part| (part, Contact::Free));
        let change = match self.state.contact {
            Contact::Free => outward().map(|part| (part, Ring::PRESSED)),
            Contact::Pressed(_) if ring.restitution.is_some() => {
                self.passes_zero(ring, to, -1.0).map(|part| (part, Contact::Free))
            }
            Contact::Pressed(_) if ring.restraint.damper_n_s_per_m == 0.0 => leaves(),
            Contact::Pressed(_) => self.passes_zero(ring, to, -1.0).map(|part| {
                let is_within = value(&square, part) <= gap * (1.0 + 8.0 * f64::EPSILON);
                (part, if is_within { Contact::Free } else { Ring::SEPARATED })
            }),
            Contact::Separated(_) => {
                let presses = self.passes_zero(ring, to, 1.0).map(|part| (part, Ring::PRESSED));
                let first = |a: (f64, Contact), b: (f64, Contact)| if b.0 < a.0 { b } else { a };
                leaves().into_iter().chain(presses).reduce(first)
            }
        };
        change.filter(|(part, _)| *part > 0.0)
    }

    /// A block that is at a stop and leaves it is not off it by rounding, nor does rounding move it towards it: what is left
    /// of a fast velocity that it had may be more than rounding of a slow one that it has.
    fn leave_stop(&self, distance: &mut Polynomial) {
        let State { s, w, .. } = &self.state;
        let is_rounding = inner(*s, *w).abs() <= 8.0 * f64::EPSILON * norm(*s) * norm(*w);
        if distance[0] == 0.0 && (is_rounding || distance[1] < 0.0) {
            distance[1] = 0.0;
            distance[2] = distance[2].max(0.0);
        }
    }

    /// The force of the stop by the part of the series, in N.
    fn pushes(&self, ring: &Ring) -> impl Fn(f64) -> f64 {
        let (series, kg, ring) = (&self.series, self.system.block_kg, *ring);
        move |x: f64| {
            let s = place_at(&series.s, x);
            match ring.restitution {
                None => ring.pushes_n(s, series.velocity_at(x)),
                Some(_) => kg * inner(s, place_at(&series.stopped, x)) / norm(s),
            }
        }
    }

    /// The first part of the series at which the force of the stop passes zero with a sign.
    fn passes_zero(&self, ring: &Ring, to: f64, sign: f64) -> Option<f64> {
        let pushes = self.pushes(ring);
        let force = |x: f64| sign * pushes(x);
        let beyond = PASSED * self.stop_rounding() * self.system.block_kg;
        let slope = self.growth(ring);
        let mut low = 0.0;
        for high in turns(|x| sign * slope(x), to).map(|(x, _)| x).chain([to]) {
            if force(high) > beyond {
                let mut high = high;
                loop {
                    let middle = 0.5 * (low + high);
                    if middle <= low || middle >= high {
                        return Some(high);
                    }
                    if force(middle) > 0.0 { high = middle } else { low = middle }
                }
            }
            low = high;
        }
        None
    }

    /// How fast the force of the stop grows by a part of the series, with its sign.
    fn growth(&self, ring: &Ring) -> impl Fn(f64) -> f64 {
        let (series, ring) = (&self.series, *ring);
        let rigid = ring.restitution.is_some();
        let of = if rigid { &series.stopped } else { &series.w };
        let changes = of.each_ref().map(derivative);
        let per_s = 1.0 / series.unit;
        move |x: f64| {
            let change = changes.each_ref().map(|c| per_s * value(c, x));
            let (s, w) = (place_at(&series.s, x), series.velocity_at(x));
            match rigid {
                true => inner(s, change) + inner(w, place_at(&series.stopped, x)),
                false => ring.growth_n_per_s(s, w, change),
            }
        }
    }

    /// Looks for the largest force of the stop in the first part of the series.
    pub(super) fn look_at_stop(&mut self, part: f64) {
        let Some(ring) = self.pressed() else { return };
        if self.series.kind == Kind::Stick && ring.restitution.is_none() {
            return self.note_stop(ring.pushes_n(self.state.s, [0.0; 2]));
        }
        let force = self.pushes(&ring);
        let ends = force(0.0).max(force(part));
        let peaks = turns(self.growth(&ring), part).map(|(x, _)| force(x));
        let largest = peaks.fold(ends, f64::max);
        drop(force);
        self.note_stop(largest);
    }

    fn note_stop(&mut self, force_n: f64) {
        self.peak_stop_n = self.peak_stop_n.max(force_n);
    }
}

fn place_at(s: &[Polynomial; 2], x: f64) -> [f64; 2] {
    [value(&s[0], x), value(&s[1], x)]
}

fn largest([x, y]: &[AtNodes; 2]) -> f64 {
    x.iter().zip(y).fold(0.0, |most: f64, (x, y)| most.max(norm([*x, *y])))
}
