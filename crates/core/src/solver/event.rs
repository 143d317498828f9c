//! Event stepping: a sample by its Taylor series, from event to event.
//!
//! This is the one place that decides what follows an event of a slider by itself; where contents slide
//! too, [`stepping`](super::stepping) decides about all interfaces together. The roots are those of
//! [`polynomial`](crate::linear::polynomial), which dismisses an interval only by a bound.

use fearless_simd::prelude::*;

use super::course::Instant;
use super::ground::Stretch;
use super::outputs::output;
use super::run::{InForce, Run};
use super::slider::{ROUNDING, falls_below, first_crossing, leaving_order};
use super::tables::Phase;
use crate::error::SolveError;
use crate::linear::lanes::{Width, least};
use crate::linear::polynomial::{
    DEGREE, Polynomial, ZERO, curvature_bound, first_root, first_root_after_zero, value,
};
use crate::linear::{Load, Series};
use crate::response::Mode;
use crate::slider::{Direction, Exit, Fading};

/// Most events in one sample interval before an analysis is given up.
pub const EVENTS_PER_INTERVAL_LIMIT: u32 = 1_000_000;

/// A segment of a stretch: one series long at most.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// Length of its series in s.
    pub(super) unit_s: f64,
    /// Its length over that.
    pub(super) part: f64,
}

impl Segment {
    /// Its first part.
    #[inline(always)]
    fn up_to(self, part: f64) -> Self {
        Self { to_s: least(self.from_s + part * self.unit_s, self.to_s), part, ..self }
    }
}

impl<S: Simd, W: Width> Run<'_, S, W> {
    /// Goes through one sample interval from a time in it.
    #[inline(never)]
    pub(super) fn step_events(&mut self, sample: usize, from_s: f64) -> Result<(), SolveError> {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                self.course.events_in_interval = 0;
                for stretch in self.ground.stretches(sample, from_s).iter().flatten() {
                    self.step_stretch(stretch)?;
                }
                Ok(())
            },
        )
    }

    #[inline(always)]
    fn step_stretch(&mut self, stretch: &Stretch) -> Result<(), SolveError> {
        let mut at_s = stretch.from_s;
        let mut first = at_s == 0.0;
        loop {
            // Whatever is due at this instant: a stop on a sample, a release by a jump.
            let before = self.course.events.len();
            if self.course.is_stopped(self.x[1]) {
                self.note_before_event(stretch, at_s, first);
                self.stop(stretch, at_s);
            }
            if self.course.mode == Mode::Stick {
                self.release_if_due(stretch, at_s, first && before == self.course.events.len());
            }
            if first || self.course.events.len() > before {
                self.record(stretch, at_s, first);
            }
            first = false;
            let time_s = self.ground.times_s[stretch.interval] + at_s;
            if self.course.mode != Mode::Stick && self.course.slider.at_end() {
                return Err(SolveError::EndOfTravel { time_s });
            }
            if self.course.events_in_interval > EVENTS_PER_INTERVAL_LIMIT {
                let limit = EVENTS_PER_INTERVAL_LIMIT;
                return Err(SolveError::TooManyEvents { time_s, limit });
            }
            if !(self.x[0].is_finite() && self.x[1].is_finite()) {
                return Err(SolveError::NotFinite { time_s });
            }
            self.pulse.beat(self.units[1])?;
            at_s = match self.course.mode {
                Mode::Stick => self.stick_segment(stretch, at_s),
                Mode::Slip(direction) => self.slip_segment(stretch, direction, at_s),
            };
            if at_s >= stretch.to_s {
                return Ok(());
            }
        }
    }

    /// The segment of a phase that begins at a time.
    #[inline(always)]
    fn segment(phase: &Phase, stretch: &Stretch, from_s: f64) -> Segment {
        let unit_s = phase.unit_s;
        let part = (stretch.to_s - from_s) / unit_s;
        // A hair beyond is the rounding of the times.
        if part <= 1.0 + 1e-9 {
            let part = if part < 1.0 { part } else { 1.0 };
            Segment { from_s, to_s: stretch.to_s, unit_s, part }
        } else {
            Segment { from_s, to_s: from_s + unit_s, unit_s, part: 1.0 }
        }
    }

    /// Moves the state to a part of a unit under a load; `next` holds the state before.
    #[inline(always)]
    fn move_to(&mut self, phase: &Phase, load: &Load, part: f64) {
        core::mem::swap(&mut self.x, &mut self.next);
        let stride = 4 * self.width.fours();
        let (start, end) = ((&self.next[..stride], load), &mut self.x[..stride]);
        phase.solution.state_at(self.simd, &phase.system, start, part, &mut self.series, end);
    }

    /// Coefficients of the demand in stick over a unit.
    #[inline(always)]
    fn demand_series(&mut self, load: &Load) -> Polynomial {
        let phase = self.tables.stick.get();
        let (x, system) = (&self.x[..4 * self.width.fours()], &phase.system);
        let row = &phase.outputs.rows[output::FRICTION];
        let mut demand = phase.solution.number(self.simd, system, (x, load), &mut self.series);
        demand[0] += row.state[0] * x[0] + (row.of_stop * self.now.stop + row.constant);
        demand
    }

    /// One segment of stick, up to its end or the release in it; the time reached.
    #[inline(always)]
    fn stick_segment(&mut self, stretch: &Stretch, from_s: f64) -> f64 {
        let phase = self.tables.stick.get();
        let segment = Self::segment(phase, stretch, from_s);
        let load = stretch.load(from_s, phase.unit_s, 0.0);
        let demand = self.demand_series(&load);
        let curvature = curvature_bound(&demand) * (segment.part * segment.part);
        let demand_end = value(&demand, segment.part);
        let (normal, rise) = (stretch.normal_at(from_s), stretch.normal_rate * phase.unit_s);
        let mut release: Option<(f64, Direction)> = None;
        for direction in [Direction::Negative, Direction::Positive] {
            let (sign, hold) = (direction.sign(), &self.hold);
            // Distance from the bound, positive where friction holds.
            let start = hold.against_n(direction, normal) + sign * demand[0];
            let last = normal + rise * segment.part;
            let end = hold.against_n(direction, last) + sign * demand_end;
            if start.min(end) > 0.125 * curvature {
                continue;
            }
            let distance = hold.distance(&demand, [normal, rise], direction);
            let most = normal + rise.abs() * segment.part;
            let rounding = ROUNDING * hold.against_n(direction, most);
            if let Some(part) = first_crossing(&distance, segment.part)
                && falls_below(&distance, rounding, segment.part)
                && release.is_none_or(|(first, _)| part < first)
            {
                release = Some((part, direction));
            }
        }
        let segment = match release {
            Some((part, _)) => segment.up_to(part),
            None => segment,
        };
        self.move_to(phase, &load, segment.part);
        if self.course.slider.law.has_pads() {
            self.look_at_stop(None, segment.part);
        }
        self.look(phase, stretch, &segment, &load);
        let at_s = segment.to_s;
        let Some((_, direction)) = release else { return at_s };
        self.record(stretch, at_s, false);
        let at = self.instant(stretch, at_s);
        self.course.release(&at, &self.hold, direction, 1);
        self.set_in_force();
        self.record(stretch, at_s, false);
        at_s
    }

    /// One segment of slip, up to its end or the first of its exits in it; the time reached.
    #[inline(always)]
    fn slip_segment(&mut self, stretch: &Stretch, direction: Direction, from_s: f64) -> f64 {
        let phase = self.now.phase.get();
        let mut load = stretch.load(from_s, phase.unit_s, self.now.friction);
        load.force -= self.now.stop;
        let (segment, mut speed) = match self.now.fading {
            None => {
                let x = &self.x[..4 * self.width.fours()];
                let (simd, start, series) = (self.simd, (x, &load), &mut self.series);
                let speed = phase.solution.number(simd, &phase.system, start, series);
                (Self::segment(phase, stretch, from_s), speed)
            }
            Some(fading) => {
                let segment = self.expand_fading(&fading, stretch, from_s);
                (segment, self.series.component(self.width, 1))
            }
        };
        let sign = direction.sign();
        for c in &mut speed {
            *c *= sign;
        }
        let mut first = match self.course.start.take() {
            None => first_root(&speed, segment.part),
            Some(start) => {
                if start.order == 1 {
                    speed[1] = start.acceleration * segment.unit_s;
                }
                first_root_after_zero(&speed, start.order, segment.part)
            }
        }
        .map(|part| (part, None));
        let asks = self.exits.iter().any(Option::is_some) || self.course.slider.law.has_pads();
        let displacement = asks.then(|| integral(&speed, sign * segment.unit_s, self.x[0]));
        if let Some(displacement) = &displacement {
            for exit in self.exits.iter().flatten() {
                let to = first.map_or(segment.part, |(part, _)| part);
                let row = [exit.of_s, sign * exit.of_w, exit.constant];
                let value = self.course.slider.of_exit(exit, of_sliding(row, displacement, &speed));
                if let Some(part) = first_root(&value, to) {
                    first = Some((part, Some(*exit)));
                }
            }
        }
        self.course.slider.just = None;
        let segment = match first {
            Some((part, _)) => segment.up_to(part),
            None => segment,
        };
        if self.now.fading.is_some() {
            core::mem::swap(&mut self.x, &mut self.next);
            let stride = 4 * self.width.fours();
            self.series.state_at(self.simd, segment.part, &mut self.x[..stride]);
        } else {
            self.move_to(phase, &load, segment.part);
        }
        match first {
            None if sign * self.x[1] <= 0.0 => self.x[1] = 0.0,
            None => {}
            Some((_, None)) => self.x[1] = 0.0,
            Some((_, Some(exit))) => {
                [self.x[0], self.x[1]] = exit.reached.place(direction, [self.x[0], self.x[1]]);
            }
        }
        if self.course.slider.law.has_pads() {
            let sliding = displacement.as_ref().map(|s| (s, &speed, sign));
            self.look_at_stop(sliding, segment.part);
        }
        self.look(phase, stretch, &segment, &load);
        let at_s = segment.to_s;
        let Some((_, exit)) = first else { return at_s };
        if let Some(exit) = exit {
            self.leave_branch(stretch, at_s, direction, &exit);
        } else if at_s < stretch.to_s {
            self.record(stretch, at_s, false);
            self.stop(stretch, at_s);
            self.record(stretch, at_s, false);
        }
        at_s
    }

    /// Expands the motion under friction that fades with the speed, over as much of a stretch as one
    /// series takes.
    #[inline(never)]
    fn expand_fading(&mut self, fading: &Fading, stretch: &Stretch, from_s: f64) -> Segment {
        let InForce { phase, friction, stop, .. } = self.now;
        let stride = 4 * self.width.fours();
        let left_s = stretch.to_s - from_s;
        let [unit_s, part] = fitting(&mut self.fading_s, phase.unit_s, left_s, |unit_s| {
            let mut load = stretch.load(from_s, unit_s, friction);
            load.force -= stop;
            let (x, fading) = (&self.x[..stride], [fading.force_n, fading.rate_s_per_m]);
            self.series.expand_fading(self.width, &phase.system, x, &load, unit_s, fading)
        });
        let whole = part == 1.0 && unit_s == left_s;
        let to_s = if whole { stretch.to_s } else { least(from_s + part * unit_s, stretch.to_s) };
        Segment { from_s, to_s, unit_s, part }
    }

    /// What follows an exit other than a stop.
    fn leave_branch(&mut self, stretch: &Stretch, at_s: f64, direction: Direction, exit: &Exit) {
        self.record(stretch, at_s, false);
        let at = self.instant(stretch, at_s);
        let place = [self.x[0], self.x[1]];
        match self.course.slider.follow(exit.reached, direction, at.time_s, place) {
            Some(kind) => self.course.push(&at, kind),
            None => self.course.events_in_interval += 1,
        }
        self.set_in_force();
        self.record(stretch, at_s, false);
    }

    /// The present state so long after the first sample of an interval.
    fn instant(&self, stretch: &Stretch, at_s: f64) -> Instant {
        Instant {
            time_s: self.ground.times_s[stretch.interval] + at_s,
            place_m: self.x[0],
            normal_n: stretch.normal_at(at_s),
            mass_kg: self.tables.stick.system.block_mass_kg,
        }
    }

    /// The sliding velocity is zero: what follows.
    pub(super) fn stop(&mut self, stretch: &Stretch, at_s: f64) {
        self.course.slider.settle(self.x[0]);
        let hold = self.course.slider.hold(self.x[0]);
        let demand = self.demand(&hold, stretch.acceleration_at(at_s));
        self.course.stop(&self.instant(stretch, at_s), &hold, demand, None);
        self.set_in_force();
    }

    /// In stick: slip if the demand is beyond its bound (a jump), or on it and about to pass it.
    #[inline(always)]
    fn release_if_due(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) {
        let hold = self.hold;
        let demand = self.demand(&hold, stretch.acceleration_at(at_s));
        let normal = stretch.normal_at(at_s);
        let [low, high] = hold.friction_n(normal);
        if low < demand && demand < high {
            return;
        }
        let at = self.instant(stretch, at_s);
        if let Some(direction) = hold.gives_way(demand, normal) {
            self.note_before_event(stretch, at_s, at_sample);
            self.course.give_way(&at, demand, direction);
        } else {
            let ways = [(high, Direction::Negative), (low, Direction::Positive)];
            let due = ways.into_iter().filter(|(bound, _)| demand == *bound).find_map(
                |(_, direction)| {
                    self.leaving_order(stretch, at_s, direction).map(|k| (direction, k))
                },
            );
            let Some((direction, order)) = due else { return };
            self.note_before_event(stretch, at_s, at_sample);
            self.course.release(&at, &hold, direction, order);
        }
        self.set_in_force();
    }

    /// Decides by the loads beside a jump at the very start or end, and looks at the outputs under them.
    pub(super) fn look_beside_jump(&mut self, stretch: &Stretch) {
        if self.course.mode == Mode::Stick {
            self.release_if_due(stretch, 0.0, true);
        }
        let phase = self.now.phase.get();
        let load = stretch.load(0.0, phase.unit_s, self.now.friction);
        let segment = Segment { from_s: 0.0, to_s: 0.0, unit_s: phase.unit_s, part: 0.0 };
        self.next.copy_from_slice(&self.x);
        self.look(phase, stretch, &segment, &load);
    }

    /// With the demand on its bound: order of the first derivative of (|T| − bound) that does not
    /// vanish, if that is positive.
    fn leaving_order(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        direction: Direction,
    ) -> Option<usize> {
        let phase = self.tables.stick.get();
        let load = stretch.load(at_s, phase.unit_s, 0.0);
        let demand = self.demand_series(&load);
        let normal = [0.0, stretch.normal_rate * phase.unit_s];
        leaving_order(&self.hold.distance(&demand, normal, direction))
    }

    /// Records the knot before an event at an instant that no segment has led to.
    fn note_before_event(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) {
        if !(at_sample && self.ground.starts_anew(stretch.interval)) {
            self.record(stretch, at_s, false);
        }
    }

    /// Records the present state as a knot.
    #[inline(always)]
    pub(super) fn record(&mut self, stretch: &Stretch, at_s: f64, row: bool) {
        if self.recorder.is_none() {
            return;
        }
        let interval = stretch.interval;
        if at_s == 0.0 {
            self.record_sample(interval, row);
            return;
        }
        let time_s = self.ground.times_s[interval] + at_s;
        let table = self.ground.table_at(interval, at_s);
        let (a, normal) = (stretch.acceleration_at(at_s), stretch.normal_at(at_s));
        let x = core::mem::take(&mut self.x);
        self.record_knot(time_s, &x, [table, a, normal], row);
        self.x = x;
    }
}

/// The polynomial `∫ p dt + start`, the interval `unit_s` long.
fn integral(p: &Polynomial, unit_s: f64, start: f64) -> Polynomial {
    let mut integral = ZERO;
    integral[0] = start;
    for k in 0..DEGREE {
        integral[k + 1] = p[k] * (unit_s / (k + 1) as f64);
    }
    integral
}

/// The polynomial `of_s s + of_w w + constant`.
pub(super) fn of_sliding(
    [of_s, of_w, constant]: [f64; 3],
    s: &Polynomial,
    w: &Polynomial,
) -> Polynomial {
    let mut p = ZERO;
    for k in 0..=DEGREE {
        p[k] = of_s * s[k] + of_w * w[k];
    }
    p[0] += constant;
    p
}

/// The series of an output from that of the state; the load's force contains no constant force of a
/// stop but what `stop` says in the output's own way.
#[inline(always)]
pub(super) fn output_series<S: Simd, W: Width>(
    (simd, width): (S, W),
    phase: &Phase,
    j: usize,
    series: &Series,
    load: &Load,
    stop: f64,
) -> Polynomial {
    let row = &phase.outputs.rows[j];
    let mut p = series.row(simd, width, &row.state);
    let [constant, change] = load.times([row.of_a, row.of_friction]);
    p[0] += constant + (row.of_stop * stop + row.constant);
    p[1] += change;
    p
}

/// The length over which a series is expanded, and the part of it that the series serves, at most 1.
///
/// `expand` expands over a length and returns the part over which that is exact, perhaps above 1; `last_s`
/// is the length that the last series would have served.
#[inline(always)]
pub(super) fn fitting(
    last_s: &mut f64,
    first_s: f64,
    left_s: f64,
    mut expand: impl FnMut(f64) -> f64,
) -> [f64; 2] {
    let mut unit_s = if last_s.is_finite() { *last_s } else { first_s };
    loop {
        // A hair beyond is the rounding of the times.
        if unit_s * (1.0 + 1e-9) >= left_s {
            unit_s = left_s;
        }
        let part = expand(unit_s);
        let longer_s = unit_s * part;
        *last_s = if unit_s == left_s { longer_s.max(*last_s) } else { longer_s };
        if !last_s.is_finite() {
            *last_s = unit_s;
        }
        if part >= 0.25 {
            return [unit_s, part.min(1.0)];
        }
        unit_s *= part.max(1e-3);
    }
}
