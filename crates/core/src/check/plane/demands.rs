//! The printed demands of a motion in a plane, compared with those of the check's own.

use super::super::Certificate;
use super::super::demands::{Comparison, Own, Rounding, of_events, of_peaks, of_stops, of_sums};
use super::super::judge::{relative, unsure};
use super::super::outputs::VELOCITY;
use super::frame::norm;
use super::judge::PlaneJudge;
use crate::response::{Demands, Mode};

impl PlaneJudge<'_> {
    /// What all tells.
    pub(super) fn certificate(self, bound: f64) -> Certificate {
        let (normal, table) = self.largest;
        let f = &self.figures;
        let jolt_j = self.frame().total_kg * self.jolt * self.jolt;
        let near = |scale: f64| 64.0 * f64::EPSILON * scale;
        let blur_n = self.law.rounding(&self.grounds[0], self.instant_s, normal);
        let rounding = Rounding {
            instant_s: self.instant_s,
            displacement_m: near(f.displacement[1]) + self.drift[0],
            velocity_m_per_s: near(f.velocity[1]) + self.jolt + self.drift[1],
            force_n: near(f.force[1]) + self.unsure_n + blur_n,
        };
        let scale = self.law.scale(normal, self.given.model.weight_n());
        Certificate {
            equilibrium_residual: f.equilibrium(table),
            friction_excess: relative([f.excess, scale]),
            energy_balance_error: self
                .books
                .error(jolt_j, |k| unsure(&self.h.time_s, self.instant_s, k)),
            demands_error: self.demands_error(&rounding),
            closest_call: self.closest,
            bound,
            books: self.books,
        }
    }

    fn demands_error(&self, rounding: &Rounding) -> f64 {
        let Self { given, peaks, outputs, .. } = self;
        let (model, response, plane) = (given.model, given.response, given.plane);
        let d = &response.demands;
        let mut c = Comparison { worst: 0.0 };
        let own = Own {
            outputs,
            peaks: &peaks.largest[0],
            possible: &peaks.possible[0],
            scales: &peaks.largest[0],
            totals: &self.totals,
            events: &self.events,
            gap_m: model.slider().gap_m(),
            width_m: None,
        };
        let (peak_m, near_m) = (peaks.largest[0][outputs.len()], rounding.displacement_m);
        let last = self.place(self.h.len() - 1);
        c.number(d.peak_sliding_displacement_m, peak_m, near_m, peak_m);
        c.number(d.residual_sliding_displacement_m, norm(last), near_m, peak_m);
        self.of_peak_time(&mut c, (peak_m, near_m));
        of_sums(&mut c, d, self.h, &own, (peak_m, rounding));
        of_peaks(&mut c, model, d, &own, (peak_m, rounding));
        of_events(&mut c, response, &own, peak_m.max(near_m), rounding);
        of_stops(&mut c, response, &own);
        let [most_x, least_x, most_y, least_y] = peaks.sides_m;
        c.number(d.max_sliding_displacement_m, most_x, near_m, peak_m);
        c.number(d.min_sliding_displacement_m, -least_x, near_m, peak_m);
        let widths = [model.block().width_m, model.along_y().width_m];
        let extremes = [[most_x, -least_x], [most_y, -least_y]];
        for axis in 0..2 {
            let own = Own {
                peaks: &peaks.largest[1 + axis],
                possible: &peaks.possible[1 + axis],
                gap_m: None,
                width_m: widths[axis],
                ..own
            };
            let d = &plane.axes[axis];
            let [most_m, least_m] = extremes[axis];
            let far_m = most_m.max(-least_m);
            c.number(d.peak_sliding_displacement_m, far_m, near_m, peak_m);
            c.number(d.max_sliding_displacement_m, most_m, near_m, peak_m);
            c.number(d.min_sliding_displacement_m, least_m, near_m, peak_m);
            c.number(d.residual_sliding_displacement_m, last[axis], near_m, peak_m);
            of_peaks(&mut c, model, d, &own, (peak_m, rounding));
            c.same(has_no_axis(d));
        }
        self.of_least_speed(&mut c, rounding);
        self.of_directions(&mut c, peak_m.max(near_m), rounding);
        c.worst
    }

    /// The printed time of the peak is one at which `|s|` has risen to it, and its direction that of `s` then.
    fn of_peak_time(&self, c: &mut Comparison, (peak_m, near_m): (f64, f64)) {
        let (h, d) = (self.h, &self.given.response.demands);
        let at_s = d.peak_sliding_displacement_time_s;
        let s = self.at_peak.unwrap_or([f64::NAN; 2]);
        c.number(norm(s), peak_m, near_m, peak_m);
        // Where the block rests at its peak, the first instant counts.
        let before = (0..h.len()).rev().find(|&k| h.time_s[k] < at_s - self.instant_s);
        let rests = |k: usize| self.mode(k) == Mode::Stick && norm(self.place(k)) >= norm(s);
        c.same(!before.is_some_and(rests));
        if peak_m > near_m {
            let printed = self.given.plane.peak_sliding_displacement_direction_rad;
            let turn = printed - libm::atan2(s[1], s[0]);
            let full = 2.0 * core::f64::consts::PI;
            let turn = turn - full * libm::round(turn / full);
            c.number(turn, 0.0, near_m / peak_m, 1.0);
        }
    }

    /// The least local minimum of the sliding speed; one below rounding may count or not.
    fn of_least_speed(&self, c: &mut Comparison, rounding: &Rounding) {
        let printed = self.given.plane.least_sliding_speed_m_per_s;
        let near = rounding.velocity_m_per_s;
        let fastest = self.peaks.largest[0][VELOCITY];
        match (printed, self.least_speed) {
            (Some(printed), Some(own)) => c.number(printed, own, near, fastest),
            (None, Some(least)) | (Some(least), None) => {
                c.same(least <= near.max(1e-12 * fastest));
            }
            (None, None) => {}
        }
    }

    /// Directions and places of the events.
    fn of_directions(&self, c: &mut Comparison, peak_m: f64, rounding: &Rounding) {
        let printed = &self.given.plane.events;
        c.same(printed.len() == self.given.response.events.len());
        c.same(printed.len() == self.turns.len());
        for (printed, own) in printed.iter().zip(&self.turns) {
            c.number(printed.sliding_displacement_y_m, own.y_m, rounding.displacement_m, peak_m);
            let u = own.direction.unwrap_or([f64::NAN; 2]);
            let off = norm([0, 1].map(|i| printed.direction[i] - u[i]));
            c.number(off, 0.0, own.unsure + rounding.force_n / own.force_n, 1.0);
        }
    }
}

/// Whether what belongs to no axis is left out.
fn has_no_axis(d: &Demands) -> bool {
    let numbers = [d.peak_sliding_displacement_time_s, d.sliding_path_m, d.sliding_time_s];
    let counts = [d.slip_count, d.stick_count, d.reversal_count];
    numbers == [0.0; 3] && counts == [0; 3] && !d.sliding_at_end && d.closest_stop.is_none()
}
