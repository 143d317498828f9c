//! The stop around the block: its force over a step, where contact with it changes, and its peak.
//!
//! Pressed, the ring takes a force that bends with the motion: over a step it is the polynomial through its values at the
//! nodes, found by correcting it by the motion that it makes. Steps are so short that this polynomial is exact to rounding,
//! so that it is a load of the series like any other.

use super::Plane;
use super::nodes::{AtNodes, NODES, nodes};
use super::speed::turns;
use super::vector::norm;
use crate::linear::polynomial::{Polynomial, ZERO, derivative, value};
use crate::response::{Contact, EventInPlane};
use crate::slider::Ring;
use crate::solver::ground::Stretch;
use crate::solver::slider::first_crossing;
use crate::solver::walk::Walk;

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

/// Most lengths that are tried for a step without friction, and most corrections of the force over each.
const MOST_LENGTHS: usize = 60;
pub(super) const MOST_CORRECTIONS: usize = 40;

impl Plane<'_> {
    fn pressed(&self) -> Option<Ring> {
        self.system.ring.filter(|_| matches!(self.state.contact, Contact::Pressed(_)))
    }

    /// What the stop takes stays as it is in the state: at an instant, and at rest.
    pub(super) fn hold_stop(&mut self) {
        for (stopped, now) in self.series.stopped.iter_mut().zip(self.system.stopped(&self.state)) {
            *stopped = ZERO;
            stopped[0] = now;
        }
    }

    /// As much of a time as a step takes, which against the stop bends with its own frequency.
    pub(super) fn within_reach_of_stop(&self, left_s: f64) -> f64 {
        let [stiffness, damper] = self.system.stop_per_kg(self.state.contact);
        let [compliance, _] = self.system.stretches();
        let rate = (compliance * stiffness).sqrt() + compliance * damper;
        let within_s = self.system.within_reach(left_s);
        if rate > 0.0 { within_s.min(1.0 / rate) } else { within_s }
    }

    /// The force of the stop at the nodes of a step to begin with: along the velocity that the block has.
    pub(super) fn guess_stop(&mut self, step_s: f64) {
        let Some(ring) = self.pressed() else {
            self.force.stopped = [[0.0; NODES]; 2];
            return;
        };
        let (s, w, kg) = (self.state.s, self.state.w, self.system.block_kg);
        for (j, x) in nodes().at.iter().enumerate() {
            let force_n = ring.force_n([0, 1].map(|k| s[k] + step_s * x * w[k]), w);
            (0..2).for_each(|axis| self.force.stopped[axis][j] = force_n[axis] / kg);
        }
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
        ROUNDING * (stiffness * norm(self.state.s) + damper * speed)
    }

    /// Corrects the force at the nodes by the motion of the series; whether there was nothing to correct.
    pub(super) fn correct_stop(&mut self) -> bool {
        let Some(ring) = self.pressed() else { return true };
        let (series, kg) = (&self.series, self.system.block_kg);
        let mut off = 0.0_f64;
        for (j, x) in nodes().at.iter().enumerate() {
            let force_n = ring.force_n(place_at(&series.s, *x), series.velocity_at(*x));
            for axis in 0..2 {
                let own = force_n[axis] / kg;
                off = off.max((own - self.force.stopped[axis][j]).abs());
                self.force.stopped[axis][j] = own;
            }
        }
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
        self.guess_stop(step_s);
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

    /// The first part of the series at which the force of the stop passes zero with a sign.
    fn passes_zero(&self, ring: &Ring, to: f64, sign: f64) -> Option<f64> {
        let series = &self.series;
        let force = |x: f64| sign * ring.pushes_n(place_at(&series.s, x), series.velocity_at(x));
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
        let changes = series.w.each_ref().map(derivative);
        let per_s = 1.0 / series.unit;
        move |x: f64| {
            let change = changes.each_ref().map(|c| per_s * value(c, x));
            ring.growth_n_per_s(place_at(&series.s, x), series.velocity_at(x), change)
        }
    }

    /// Looks for the largest force of the stop in the first part of the series.
    pub(super) fn look_at_stop(&mut self, part: f64) {
        let Some(ring) = self.pressed() else { return };
        if self.series.kind == Kind::Stick {
            return self.note_stop(ring.pushes_n(self.state.s, [0.0; 2]));
        }
        let series = &self.series;
        let force = |x: f64| ring.pushes_n(place_at(&series.s, x), series.velocity_at(x));
        let ends = force(0.0).max(force(part));
        let peaks = turns(self.growth(&ring), part).map(|(x, _)| force(x));
        let largest = peaks.fold(ends, f64::max);
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

impl<'a> Walk<'a, Plane<'a>> {
    /// Contact with the stop changes where a step has ended.
    pub(super) fn change_contact(&mut self, stretch: &Stretch, at_s: f64, to: Contact) {
        let Some(ring) = self.phase.system.ring else { return };
        let state = &mut self.phase.state;
        if to == Contact::Free || state.contact == Contact::Free {
            let per = ring.gap_m / norm(state.s);
            state.s = state.s.map(|s| per * s);
        }
        self.record(stretch, at_s, false);
        let state = &self.phase.state;
        let speed = norm(state.w);
        let direction = if speed > 0.0 { state.w.map(|w| w / speed) } else { [0.0; 2] };
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        self.touch(time_s, to, direction);
        self.phase.next_s = f64::INFINITY;
        self.record(stretch, at_s, false);
    }

    /// Contact at rest is that of a stop that has followed.
    pub(super) fn touch_at_rest(&mut self, time_s: f64, direction: [f64; 2]) {
        let Some(ring) = self.phase.system.ring else { return };
        let to = ring.contact_at_rest(self.phase.state.s, direction);
        if to != self.phase.state.contact {
            self.touch(time_s, to, direction);
        }
    }

    fn touch(&mut self, time_s: f64, to: Contact, direction: [f64; 2]) {
        let State { s, w, .. } = &self.phase.state;
        let [_, rate] = Ring::along_radius(*s, *w);
        let kind = self.course.slider.change_contact(time_s, rate.abs(), to);
        self.phase.state.contact = to;
        let [x_m, y_m] = self.phase.state.s;
        self.course.push_of(0, [time_s, x_m], kind);
        self.phase.events.push(EventInPlane { direction, sliding_displacement_y_m: y_m });
    }
}
