//! Contact with the stop around the block: where it begins and ends, and what is struck.

use super::Plane;
use super::stop::REST;
use super::system::{Loads, State};
use super::vector::{inner, norm, unit};
use crate::response::{Contact, EventInPlane, EventKind};
use crate::slider::Ring;
use crate::solver::ground::Stretch;
use crate::solver::walk::Walk;
use crate::solver::walk::impact::{LEAST_BOUNCE, LONGEST_REST, SLOWEST_IMPACT_M_PER_S};

/// Part of its velocity below which rounding tells how fast a block bounces off the stop.
const SLOWEST_BOUNCE: f64 = 64.0 * f64::EPSILON;

impl Plane<'_> {
    /// Takes a velocity off the block, what is not the block going on as before; its velocity then.
    fn rebound(&mut self, n: [f64; 2], speed: f64) -> [f64; 2] {
        let State { w, rate, .. } = &mut self.state;
        *w = [0, 1].map(|k| w[k] - speed * n[k]);
        for (j, rate) in rate.iter_mut().enumerate() {
            *rate += speed * inner(n, self.system.participation_of(j));
        }
        *w
    }

    /// The acceleration off the centre that a block which slides along a velocity has beside the stop.
    fn outward(&mut self, loads: &Loads, n: [f64; 2], along: [f64; 2]) -> f64 {
        let at = self.instant(loads);
        let [u, w] = [unit(along), self.state.w];
        let across = inner(w, w) - inner(n, w) * inner(n, w);
        inner(n, [0, 1].map(|k| at.push[k] - at.friction * u[k])) + across / norm(self.state.s)
    }
}

impl<'a> Walk<'a, Plane<'a>> {
    /// Contact with the stop changes where a step has ended.
    pub(super) fn change_contact(&mut self, stretch: &Stretch, at_s: f64, to: Contact) {
        let Some(ring) = self.phase.system.ring else { return };
        if let (Some(e), Ring::PRESSED) = (ring.restitution, to) {
            return self.strike((stretch, at_s), (&ring, e));
        }
        self.phase.off_stop_m2 = ring.restitution.map(|_| 0.0);
        let state = &mut self.phase.state;
        if to == Contact::Free || state.contact == Contact::Free {
            let per = ring.gap_m / norm(state.s);
            state.s = state.s.map(|s| per * s);
        }
        self.record(stretch, at_s, false);
        let state = &self.phase.state;
        let direction = unit(state.w);
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        self.touch(time_s, to, direction);
        self.phase.next_s = f64::INFINITY;
        self.record(stretch, at_s, false);
    }

    /// The block strikes a stop that does not give way: `ρ̇⁺ = −e ρ̇⁻`. What is not the block keeps its absolute velocity.
    fn strike(&mut self, (stretch, at_s): (&Stretch, f64), (ring, e): (&Ring, f64)) {
        let per = ring.gap_m / norm(self.phase.state.s);
        let s = self.phase.state.s.map(|s| per * s);
        self.phase.state.s = s;
        self.record(stretch, at_s, false);
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        let n = s.map(|s| s / ring.gap_m);
        let before = self.phase.state.w;
        let speed = inner(n, before);
        let fast = speed >= SLOWEST_IMPACT_M_PER_S;
        let peak = &mut self.course.slider.stopping.demands.peak_impact_speed_m_per_s;
        *peak = peak.max(speed);
        if fast && self.first_impact_s.is_none() {
            self.first_impact_s = Some(time_s);
        }
        let loads = self.phase.loads(stretch, at_s);
        let outward = [before, self.phase.rebound(n, (1.0 + e) * speed)]
            .map(|along| self.phase.outward(&loads, n, along));
        let end_s = self.ground.times_s[self.ground.times_s.len() - 1];
        let ends = e == 0.0 || speed == 0.0 || self.is_last_bounce((ring, e), outward, end_s);
        let bears = outward[1] > 0.0 && ends;
        if bears {
            let off = inner(n, self.phase.state.w);
            let along = self.phase.rebound(n, off);
            if norm(along) <= REST * self.phase.peak_speed {
                // The way along the stop that is left is rounding.
                self.phase.rebound(along, 1.0);
            }
            let direction = unit(self.phase.state.w);
            self.touch(time_s, Ring::PRESSED, direction);
        } else if fast {
            let direction = unit(self.phase.state.w);
            self.course.push_of(0, [time_s, s[0]], EventKind::Impact);
            let y_m = self.phase.state.s[1];
            self.phase.events.push(EventInPlane { direction, sliding_displacement_y_m: y_m });
        }
        let phase = &mut self.phase;
        phase.off_stop_m2 = (!bears).then_some(0.0);
        phase.next_s = f64::INFINITY;
        phase.least.drop_to(norm(before), norm(phase.state.w));
        if phase.state.w != [0.0; 2] {
            phase.direction = unit(phase.state.w);
        }
        self.record(stretch, at_s, false);
    }

    /// Whether infinitely many bounces are left, all below rounding: as in one direction, with the accelerations `P` and `Q`
    /// towards the stop on the way in and out.
    fn is_last_bounce(&self, (ring, e): (&Ring, f64), [p, q]: [f64; 2], end_s: f64) -> bool {
        let State { s, w, .. } = &self.phase.state;
        let speed = -inner(*s, *w) / ring.gap_m;
        if !(p > 0.0 && q > 0.0) {
            return false;
        }
        let r = e * (p / q).sqrt();
        let rest_s = speed / q * (1.0 + (q / p).sqrt()) / (1.0 - r);
        let is_left_out = rest_s < LONGEST_REST * end_s || speed <= SLOWEST_BOUNCE * norm(*w);
        r < 1.0 && 0.5 * speed * speed / q < LEAST_BOUNCE * ring.gap_m && is_left_out
    }

    /// Contact at rest is that of a stop that has followed; from one that does not give way a block sets out along it, or
    /// leaves it.
    pub(super) fn touch_at_rest(&mut self, (stretch, at_s): (&Stretch, f64), direction: [f64; 2]) {
        let Some(ring) = self.phase.system.ring else { return };
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        if ring.restitution.is_some() {
            let loads = self.phase.loads(stretch, at_s);
            let is_borne = self.phase.state.contact == Ring::PRESSED;
            if is_borne && direction != [0.0; 2] && self.phase.borne(&loads) == [0.0; 2] {
                self.phase.off_stop_m2 = Some(0.0);
                self.touch(time_s, Contact::Free, [0.0; 2]);
            }
            return;
        }
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
