//! The long way through a sample: segment by segment, event by event.

use super::{EVENTS_PER_INTERVAL_LIMIT, Run, Start};
use crate::error::SolveError;
use crate::friction::Direction;
use crate::linear::polynomial::{DEGREE, Polynomial, curvature_bound, deflated, first_root, value};
use crate::linear::{MAX_RATE_STEP, PerStorey, State};
use crate::response::{Event, EventKind, Mode};
use crate::solver::excitation::Stretch;
use crate::solver::extremes::Place;
use crate::solver::recorder::{Knot, Recorder};

impl<V: PerStorey, R: Recorder<V>> Run<'_, V, R> {
    /// Walks through one sample interval.
    pub(super) fn long_way(&mut self, sample: usize) -> Result<(), SolveError> {
        self.long_way_from(sample, 0.0)
    }

    /// Walks through the rest of one sample interval after a time in it.
    pub(in crate::solver) fn long_way_from(
        &mut self,
        sample: usize,
        mut from_s: f64,
    ) -> Result<(), SolveError> {
        let times_s = self.excitation.times_s;
        let length_s = times_s[sample + 1] - times_s[sample];
        let kink_s = self.excitation.kink(sample).map(|part| part * length_s);
        for to_s in kink_s.into_iter().chain([length_s]) {
            if to_s > from_s {
                let stretch = self.excitation.stretch(sample, from_s, to_s);
                self.walk_stretch(&stretch)?;
                from_s = to_s;
            }
        }
        Ok(())
    }

    fn walk_stretch(&mut self, stretch: &Stretch) -> Result<(), SolveError> {
        let mut at_s = stretch.from_s;
        let mut first = at_s == 0.0;
        loop {
            // Whatever is due at this instant: a stop on a sample, a release by a jump.
            let before = self.events.len();
            let (w, mode) = (self.state.w(), self.mode);
            if matches!(mode, Mode::Slip(_)) && self.start.is_none() && w == 0.0 {
                self.note_before_event(stretch, at_s, first);
                self.stop(stretch, at_s);
            }
            if self.mode == Mode::Stick {
                self.release_if_due(stretch, at_s, first && before == self.events.len());
            }
            if first {
                self.record(stretch, at_s, self.mode, true);
            } else if self.events.len() > before {
                self.record(stretch, at_s, self.mode, false);
            }
            first = false;
            self.check_interval(stretch, at_s)?;
            let left_s = stretch.to_s - at_s;
            let rate = match self.mode {
                Mode::Stick => self.system.stick_rate_rad_per_s,
                Mode::Slip(_) => self.system.slip_rate_rad_per_s,
            };
            let segments = left_s * rate / MAX_RATE_STEP;
            let to_s = if segments > 1.0 { at_s + left_s / segments.ceil() } else { stretch.to_s };
            at_s = match self.mode {
                Mode::Stick => self.stick_segment(stretch, at_s, to_s),
                Mode::Slip(direction) => self.slip_segment(stretch, direction, at_s, to_s),
            };
            if at_s >= stretch.to_s {
                return Ok(());
            }
        }
    }

    fn check_interval(&self, stretch: &Stretch, at_s: f64) -> Result<(), SolveError> {
        let time_s = self.excitation.times_s[stretch.interval] + at_s;
        if self.events_in_interval > EVENTS_PER_INTERVAL_LIMIT {
            let limit = EVENTS_PER_INTERVAL_LIMIT;
            return Err(SolveError::TooManyEvents { time_s, limit });
        }
        if !self.state.0.as_ref().iter().all(|x| x.is_finite()) {
            return Err(SolveError::NotFinite { time_s });
        }
        Ok(())
    }

    /// One segment of stick, up to its end or the release in it; the time reached.
    fn stick_segment(&mut self, stretch: &Stretch, from_s: f64, to_s: f64) -> f64 {
        let length_s = to_s - from_s;
        let load = self.excitation.load(stretch, from_s, length_s, None);
        self.series.stick(self.system, &self.state, &load, length_s);
        let demand = self.series.demand(self.system, &load);
        let curvature = curvature_bound(&demand);
        let demand_end = value(&demand, 1.0);
        let (normal, rise) = (stretch.normal_at(from_s), stretch.normal_rate() * length_s);
        let [low, high] = self.bounds;
        let ways = [(1.0, high, Direction::Negative), (-1.0, low, Direction::Positive)];
        let release = ways
            .into_iter()
            .filter_map(|(sign, bound, direction)| {
                // Distance from the bound, positive where friction holds.
                let start = sign * (bound * normal - demand[0]);
                let end = sign * (bound * (normal + rise) - demand_end);
                if start.min(end) > 0.125 * curvature {
                    return None;
                }
                let mut distance = demand.map(|c| -sign * c);
                distance[0] += sign * (bound * normal);
                distance[1] += sign * (bound * rise);
                first_crossing(&distance).map(|part| (part, direction))
            })
            .reduce(|a, b| if b.0 < a.0 { b } else { a });
        let Some((part, direction)) = release else {
            let before = self.advance(1.0);
            self.look(stretch, from_s, length_s, &before);
            return to_s;
        };
        let before = self.advance(part);
        let at_s = (from_s + part * length_s).min(to_s);
        self.look_to(stretch, from_s, part, length_s, &before);
        self.record(stretch, at_s, Mode::Stick, false);
        let acceleration = self.drop_at_release(stretch, at_s, direction);
        let order = if acceleration > 0.0 { 1 } else { 2 };
        self.slip_from_stick(stretch, at_s, direction, Start { order, acceleration });
        self.record(stretch, at_s, self.mode, false);
        at_s
    }

    /// One segment of slip, up to its end or the stop in it; the time reached.
    fn slip_segment(
        &mut self,
        stretch: &Stretch,
        direction: Direction,
        from_s: f64,
        to_s: f64,
    ) -> f64 {
        let length_s = to_s - from_s;
        let sign = direction.sign();
        let load = self.excitation.load(stretch, from_s, length_s, Some(direction));
        self.series.slip(self.system, &self.state, &load, length_s);
        let mut speed: Polynomial = self.series.w.map(|c| sign * c);
        if let Some(start) = self.start.take() {
            if start.order == 1 {
                speed[1] = start.acceleration * length_s;
            }
            speed = deflated(&speed, start.order);
        }
        let Some(part) = first_root(&speed) else {
            let before = self.advance(1.0);
            if sign * self.state.w() <= 0.0 {
                self.state.set_w(0.0);
            }
            self.look(stretch, from_s, length_s, &before);
            return to_s;
        };
        let before = self.advance(part);
        self.state.set_w(0.0);
        let at_s = (from_s + part * length_s).min(to_s);
        self.look_to(stretch, from_s, part, length_s, &before);
        if at_s < stretch.to_s {
            self.record(stretch, at_s, self.mode, false);
            self.stop(stretch, at_s);
            self.record(stretch, at_s, self.mode, false);
        }
        at_s
    }

    /// The sliding velocity is zero: stick if friction holds, eq. (4), else slip on, eq. (3).
    pub(super) fn stop(&mut self, stretch: &Stretch, at_s: f64) {
        let demand = self.demand(stretch, at_s);
        let normal = stretch.normal_at(at_s);
        let [low, high] = self.bounds.map(|bound| bound * normal);
        self.sliding.decide(demand, [low, high]);
        let direction = if demand > high {
            Direction::Negative
        } else if demand < low {
            Direction::Positive
        } else {
            self.end_phase(stretch, at_s);
            self.mode = Mode::Stick;
            self.push_event(stretch, at_s, EventKind::Stick);
            return;
        };
        let acceleration = self.excess_acceleration(demand, normal, direction);
        self.start = Some(Start { order: 1, acceleration });
        if self.mode != Mode::Slip(direction) {
            self.end_phase(stretch, at_s);
            self.begin_phase(stretch, at_s, direction);
            self.push_event(stretch, at_s, EventKind::Reversal);
        }
    }

    /// In stick: slip if the demand is beyond its bound (a jump), or on it and about to pass it.
    fn release_if_due(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) {
        let demand = self.demand(stretch, at_s);
        let normal = stretch.normal_at(at_s);
        let [low, high] = self.bounds.map(|bound| bound * normal);
        if low < demand && demand < high {
            return;
        }
        let (direction, start) = if demand > high || demand < low {
            let direction = if demand > high { Direction::Negative } else { Direction::Positive };
            let acceleration = self.excess_acceleration(demand, normal, direction);
            (direction, Start { order: 1, acceleration })
        } else {
            let ways = [(high, Direction::Negative), (low, Direction::Positive)];
            let due = ways.into_iter().filter(|(bound, _)| demand == *bound).find_map(
                |(_, direction)| {
                    self.leaving_order(stretch, at_s, direction).map(|k| (direction, k))
                },
            );
            let Some((direction, order)) = due else { return };
            let acceleration = self.drop_at_release(stretch, at_s, direction);
            let order = if acceleration > 0.0 { 1 } else { order + 1 };
            (direction, Start { order, acceleration })
        };
        self.note_before_event(stretch, at_s, at_sample);
        self.slip_from_stick(stretch, at_s, direction, start);
    }

    /// With the demand on its bound: order of the first derivative of (|T| − bound) that does not
    /// vanish, if that is positive.
    fn leaving_order(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        direction: Direction,
    ) -> Option<usize> {
        let length_s = (stretch.to_s - at_s).min(MAX_RATE_STEP / self.system.stick_rate_rad_per_s);
        let load = self.excitation.load(stretch, at_s, length_s, None);
        self.series.stick(self.system, &self.state, &load, length_s);
        let demand = self.series.demand(self.system, &load);
        let [low, high] = self.bounds.map(|b| b * (stretch.normal_rate() * length_s));
        let sign = -direction.sign();
        let bound = if sign > 0.0 { high } else { low };
        (1..=DEGREE)
            .map(|k| (k, sign * (demand[k] - if k == 1 { bound } else { 0.0 })))
            .find(|(_, rise)| *rise != 0.0)
            .and_then(|(k, rise)| (rise > 0.0).then_some(k))
    }

    fn slip_from_stick(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        direction: Direction,
        start: Start,
    ) {
        self.begin_phase(stretch, at_s, direction);
        self.start = Some(start);
        self.push_event(stretch, at_s, EventKind::Slip);
    }

    /// `|s̈|` just after a release on the bound: `(μ_s − μ_k) N / M1`.
    fn drop_at_release(&self, stretch: &Stretch, at_s: f64, direction: Direction) -> f64 {
        let bound = self.bounds[if direction == Direction::Positive { 0 } else { 1 }];
        let kinetic = self.excitation.kinetic(direction);
        (bound.abs() - kinetic.abs()) * stretch.normal_at(at_s) / self.system.block_mass_kg
    }

    /// `|s̈|` just after the block gives way to a demand beyond its bound.
    fn excess_acceleration(&self, demand: f64, normal: f64, direction: Direction) -> f64 {
        let kinetic_n = self.excitation.kinetic(direction).abs() * normal;
        (demand.abs() - kinetic_n) / self.system.block_mass_kg
    }

    fn begin_phase(&mut self, stretch: &Stretch, at_s: f64, direction: Direction) {
        let time_s = self.excitation.times_s[stretch.interval] + at_s;
        self.mode = Mode::Slip(direction);
        self.sliding.begin(time_s, self.state.s());
    }

    fn end_phase(&mut self, stretch: &Stretch, at_s: f64) {
        let time_s = self.excitation.times_s[stretch.interval] + at_s;
        self.sliding.end(time_s, self.state.s());
    }

    fn push_event(&mut self, stretch: &Stretch, at_s: f64, kind: EventKind) {
        self.events_in_interval += 1;
        self.events.push(Event {
            time_s: self.excitation.times_s[stretch.interval] + at_s,
            kind,
            mode: self.mode,
            sliding_displacement_m: self.state.s(),
        });
    }

    /// The force that keeps the block stuck, eqs (8), (14).
    fn demand(&self, stretch: &Stretch, at_s: f64) -> f64 {
        let a = self.excitation.load(stretch, at_s, 0.0, None).acceleration;
        let f = self.system.restoring(self.state.eta(), self.state.eta_dot());
        self.system.demand_n(self.state.s(), self.system.base_shear_n(f.as_ref()), a)
    }

    /// Moves the state along the series; the state before.
    fn advance(&mut self, part: f64) -> State<V> {
        let before = self.state.clone();
        self.series.state_at(part, &mut self.state);
        if self.mode == Mode::Stick {
            let x = self.state.0.as_mut();
            (x[0], x[1]) = (before.s(), 0.0);
        }
        before
    }

    // ---- what is kept of the walk --------------------------------------------------------------

    /// Tracked values of a state under the acceleration `a` and, in slip, a friction force.
    #[inline(always)]
    pub(super) fn values(&self, x: &State<V>, mode: Mode, a: f64, kinetic_n: f64) -> V::Tracked {
        let system = self.system;
        let f = system.restoring(x.eta(), x.eta_dot());
        let shear_n = system.base_shear_n(f.as_ref());
        let (u, friction_n) = match mode {
            Mode::Stick => (a, system.demand_n(x.s(), shear_n, a)),
            Mode::Slip(_) => {
                (system.block_acceleration(x.s(), x.w(), shear_n, kinetic_n), kinetic_n)
            }
        };
        let (f, eta) = (f.as_ref(), x.eta());
        self.extremes.values(system, x.s(), x.w(), eta, f, shear_n, u, friction_n)
    }

    /// Shows the whole of the last series to the extremes.
    #[inline(always)]
    fn look(&mut self, stretch: &Stretch, from_s: f64, length_s: f64, before: &State<V>) {
        self.look_to(stretch, from_s, 1.0, length_s, before);
    }

    /// Shows the first `part` of the last series to the extremes.
    fn look_to(
        &mut self,
        stretch: &Stretch,
        from_s: f64,
        part: f64,
        length_s: f64,
        before: &State<V>,
    ) {
        let direction = match self.mode {
            Mode::Stick => None,
            Mode::Slip(direction) => Some(direction),
        };
        let at = |part: f64, state: &State<V>| {
            let load = self.excitation.load(stretch, from_s + part * length_s, 0.0, direction);
            self.values(state, self.mode, load.acceleration, load.friction)
        };
        let (start, end) = (at(0.0, before), at(part, &self.state));
        // Twice the second coefficient is ẍ times the length squared.
        let s = &self.series;
        let bend =
            2.0 * self.system.energy_norm(s.s[2], s.w[2], s.eta[2].as_ref(), s.eta_dot[2].as_ref());
        let reach = 0.125 * bend * part * part;
        if self.extremes.take(&start, &end, reach, self.mode) {
            let place = Place {
                interval: stretch.interval,
                from_s,
                length_s: part * length_s,
                mode: self.mode,
                state: before,
            };
            self.extremes.keep(self.system, self.excitation, &start, &end, reach, &place);
        }
    }

    /// Records the knot before an event at an instant that no segment has led to.
    fn note_before_event(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) {
        // At t = 0 nothing was before; before a jump the left side stands recorded already.
        let interval = stretch.interval;
        let times_s = self.excitation.times_s;
        let after_jump = interval == 0 || times_s[interval - 1] == times_s[interval];
        if !(at_sample && after_jump) {
            self.record(stretch, at_s, self.mode, false);
        }
    }

    /// Records the present state as a knot in a mode.
    pub(in crate::solver) fn record(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        mode: Mode,
        row: bool,
    ) {
        if !R::WANTED {
            return;
        }
        let (interval, times_s) = (stretch.interval, self.excitation.times_s);
        if at_s == 0.0 {
            self.record_sample(interval, mode, row);
            return;
        }
        let length_s = times_s[interval + 1] - times_s[interval];
        let [from, to] = [self.table[interval], self.table[interval + 1]];
        let table = from + (to - from) * (at_s / length_s);
        let a = self.excitation.load(stretch, at_s, 0.0, None).acceleration;
        let (time_s, load) = (times_s[interval] + at_s, [a, stretch.normal_at(at_s)]);
        self.record_knot(&self.state.clone(), time_s, mode, table, load, row);
    }

    /// Records the present state as a knot at a sample.
    pub(in crate::solver) fn record_sample(&mut self, sample: usize, mode: Mode, row: bool) {
        if R::WANTED {
            self.record_at(&self.state.clone(), sample, mode, row);
        }
    }

    /// Records a state as a knot at a sample.
    pub(super) fn record_at(&mut self, x: &State<V>, sample: usize, mode: Mode, row: bool) {
        let a = self.excitation.acceleration[sample];
        let normal = self.excitation.normal_at_sample(sample).max(0.0);
        let (time_s, table) = (self.excitation.times_s[sample], self.table[sample]);
        self.record_knot(x, time_s, mode, table, [a, normal], row);
    }

    fn record_knot(
        &mut self,
        x: &State<V>,
        time_s: f64,
        mode: Mode,
        table: f64,
        [a, normal]: [f64; 2],
        row: bool,
    ) {
        let system = self.system;
        let f = system.restoring(x.eta(), x.eta_dot());
        let shear_n = system.base_shear_n(f.as_ref());
        let (u, friction_n) = match mode {
            Mode::Stick => (a, system.demand_n(x.s(), shear_n, a)),
            Mode::Slip(_) => {
                let friction_n = self.excitation.kinetic_n(mode, normal);
                (system.block_acceleration(x.s(), x.w(), shear_n, friction_n), friction_n)
            }
        };
        let knot = Knot { time_s, mode, table, state: x, u, f: f.as_ref(), friction_n };
        self.recorder.knot(system, &knot, row);
    }
}

/// First part of a segment after which the distance from a bound is negative; a distance that is
/// zero at the start has been found not to go that way.
fn first_crossing(distance: &Polynomial) -> Option<f64> {
    if distance[0] > 0.0 {
        return first_root(distance);
    }
    let order = (1..=DEGREE).find(|&k| distance[k] != 0.0)?;
    first_root(&deflated(distance, order))
}
