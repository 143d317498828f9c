//! The printed demands of a motion in a plane, compared with those of the check's own.

use super::super::demands::{Comparison, Corner, Recomputed, Rounding, of_directions, of_motion};
use super::frame::norm;
use super::judge::PlaneJudge;
use crate::response::output::VELOCITY;
use crate::response::{Demands, Mode};

impl<'a> PlaneJudge<'a> {
    /// Compares the printed demands with those of the path.
    pub(super) fn compare_printed(&self, c: &mut Comparison, rounding: &Rounding) {
        let (model, response, outputs) = (self.model, self.response, self.outputs);
        let (peaks, plane) = (&self.axes.peaks, self.axes.printed);
        let near_m = rounding.displacement_m;
        let peak_m = peaks.largest[0][outputs.len()];
        let last = self.place(self.h.len() - 1);
        let [most_x, least_x, most_y, least_y] = peaks.sides_m;
        let root = Recomputed {
            outputs,
            sliding_m: [peak_m, most_x, -least_x, norm(last)],
            scale_m: peak_m,
            peaks: &peaks.largest[0],
            possible: &peaks.possible[0],
            scales: &peaks.largest[0],
            totals: &self.totals,
            events: &self.events,
            gap_m: model.slider().gap_m(),
            width_m: None,
            corner: self.frame().per_resisted.map(|per| {
                let [corner, possible] = peaks.corner;
                Corner { ratio: [corner, possible.max(corner)], per_n_m: per[0] + per[1] }
            }),
        };
        of_motion(c, (model, response, self.h), &root, rounding);
        self.of_peak_time(c, (peak_m, near_m));
        let widths = [model.block().width_m, model.along_y().width_m];
        let sides = [[most_x, -least_x], [most_y, -least_y]];
        for (axis, [most_m, least_m]) in sides.into_iter().enumerate() {
            // Across the line of a motion along an axis nothing moves, and nothing is rounded.
            let is_still = self.axes.still[axis];
            let sliding_m = [most_m.max(-least_m), most_m, least_m, last[axis]];
            let largest = &peaks.largest[1 + axis];
            let own = Recomputed {
                sliding_m,
                scale_m: if is_still { sliding_m[0] } else { peak_m },
                peaks: largest,
                possible: &peaks.possible[1 + axis],
                scales: if is_still { largest } else { root.scales },
                gap_m: None,
                width_m: widths[axis],
                corner: None,
                ..root
            };
            let rounding = if is_still { &Rounding::default() } else { rounding };
            c.along(["x.", "y."][axis]);
            of_directions(c, model, &plane.axes[axis], &own, rounding);
            c.same(has_no_axis(&plane.axes[axis]));
        }
        c.along("");
        self.of_least_speed(c, rounding);
        self.of_turns(c, peak_m.max(near_m), rounding);
    }

    /// The printed time of the peak is one at which `|s|` has risen to it, and its direction that of `s` then.
    fn of_peak_time(&self, c: &mut Comparison, (peak_m, near_m): (f64, f64)) {
        let (h, d) = (self.h, &self.response.demands);
        c.of("peak_sliding_displacement_time_s");
        let at_s = d.peak_sliding_displacement_time_s;
        let s = self.axes.at_peak.unwrap_or([f64::NAN; 2]);
        c.number(norm(s), peak_m, near_m, peak_m);
        // Where the block rests at its peak, the first instant counts.
        let before = (0..h.len()).rev().find(|&k| h.time_s[k] < at_s - self.instant_s);
        let rests = |k: usize| self.mode(k) == Mode::Stick && norm(self.place(k)) >= norm(s);
        c.same(!before.is_some_and(rests));
        if peak_m > near_m {
            let printed = self.axes.printed.peak_sliding_displacement_direction_rad;
            let turn = printed - libm::atan2(s[1], s[0]);
            let full = 2.0 * core::f64::consts::PI;
            let turn = turn - full * libm::round(turn / full);
            c.number(turn, 0.0, near_m / peak_m, 1.0);
        }
    }

    /// The least local minimum of the sliding speed; one below rounding may count or not.
    fn of_least_speed(&self, c: &mut Comparison, rounding: &Rounding) {
        let printed = self.axes.printed.least_sliding_speed_m_per_s;
        c.of("least_sliding_speed_m_per_s");
        let near = rounding.velocity_m_per_s;
        let fastest = self.axes.peaks.largest[0][VELOCITY];
        match (printed, self.axes.least_speed) {
            (Some(printed), Some(own)) => {
                c.within(printed, [self.axes.shallow_speed.min(own), own, fastest], near);
            }
            (Some(printed), None) if self.axes.shallow_speed <= printed + near => {}
            (None, Some(least)) | (Some(least), None) => {
                c.same(least <= near.max(1e-12 * fastest));
            }
            (None, None) => {}
        }
    }

    /// Directions and places of the events.
    fn of_turns(&self, c: &mut Comparison, peak_m: f64, rounding: &Rounding) {
        let printed = &self.axes.printed.events;
        c.of("events");
        c.same(printed.len() == self.response.events.len());
        c.same(printed.len() == self.axes.event_directions.len());
        for (printed, own) in printed.iter().zip(&self.axes.event_directions) {
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
