//! From event to event: the one way through the motion, for the slider and all contents.
//!
//! Between two events the motion is one series of a [`Phase`]. Its first event is where an interface has no
//! velocity, reaches its bound, or where the slider's branch ends; what follows is decided in `decide`, and
//! at rigid stops in `impact`. Where a phase can, it runs ahead of this over whole samples.

mod decide;
pub(in crate::solver) mod impact;
mod straight;

use super::course::WalkState;
use super::ground::{Ground, Stretch};
use super::phase::{Advance as Ahead, LinePhase, Phase};
use super::summary::Outcome;
use crate::error::SolveError;
use crate::progress::Pulse;
use crate::response::{Contact, EventKind, Mode};

/// Most events in one sample interval before an analysis is given up.
pub const EVENTS_PER_INTERVAL_LIMIT: u32 = 1_000_000;

/// A way through a motion.
pub(super) struct Walk<'a, P: ?Sized> {
    pub(super) course: WalkState<'a>,
    pub(super) ground: Ground<'a>,
    /// Asks whether to go on, after so many units of work a segment.
    pub(super) pulse: Pulse<'a>,
    pub(super) units: u32,
    /// Acceleration and normal force before the motion.
    before: [f64; 2],
    /// Whether a jump is walked, in which displacements stand.
    walks_jump: bool,
    /// Factor on what of a decision is taken for rounding.
    doubt: f64,
    /// What friction takes of a push against a rigid stop has just become all of it, or too little.
    bearing_changed: bool,
    bears_on_stop_since_s: Option<f64>,
    /// The last turn since the last impact.
    turn: Option<usize>,
    pub(super) first_impact_s: Option<f64>,
    pub(super) phase: P,
}

/// A walk in one direction, for what is done now and then: it is compiled once for all phases.
type Line<'a> = Walk<'a, dyn LinePhase<'a> + 'a>;

/// What happens on the way: in one direction, or in two.
pub(super) trait Events {
    /// One segment, up to its end or the first event in it; the time reached.
    ///
    /// # Errors
    /// Where what is reached has no continuation.
    fn segment(&mut self, stretch: &Stretch, at_s: f64) -> Result<f64, SolveError>;

    /// Whether something waits to be decided.
    fn has_pending_decision(&self) -> bool;

    /// Decides all that is due at an instant; whether something was.
    fn decide(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) -> bool;

    /// Goes through a jump at a sample between two pairs of acceleration and normal force: what it releases
    /// has reached its bound. Displacements and velocities are what they were.
    ///
    /// # Errors
    /// Where the events in it do not end.
    fn walk_jump(
        &mut self,
        _sample: usize,
        _from: [f64; 2],
        _to: [f64; 2],
    ) -> Result<(), SolveError> {
        Ok(())
    }

    /// Looks at the outputs under loads that stand.
    fn peaks_at_jump(&mut self, stretch: &Stretch);

    /// Begins what lasts from the start.
    fn begin(&mut self) {}

    /// Ends at a time what lasts.
    fn end(&mut self, _end_s: f64) {}
}

impl<'a, P: Phase<'a>> Walk<'a, P> {
    /// Before anything has happened, under a first acceleration and normal force; a segment is so many
    /// `units` of work.
    #[inline(always)]
    pub(super) fn new(
        (phase, course): (P, WalkState<'a>),
        (ground, before): (Ground<'a>, [f64; 2]),
        (pulse, units): (Pulse<'a>, u32),
    ) -> Self {
        let mut walk = Self {
            course,
            ground,
            pulse,
            units,
            before,
            walks_jump: false,
            doubt: 1.0,
            bearing_changed: false,
            bears_on_stop_since_s: None,
            turn: None,
            first_impact_s: None,
            phase,
        };
        walk.phase.update_branch(&walk.course);
        walk
    }
}

impl<'a, P: Phase<'a>> Walk<'a, P>
where
    Self: Events,
{
    /// Goes through all sample intervals.
    #[inline(always)]
    pub(super) fn go(&mut self) -> Result<(), SolveError> {
        let times_s = self.ground.times_s;
        let last = times_s.len() - 1;
        self.note_ends(0.0)?;
        self.begin();
        self.walk_jump(0, self.before, self.loads_at(0))?;
        if let Some(stretch) = self.ground.before_first_jump() {
            self.decide(&stretch, 0.0, true);
            self.peaks_at_jump(&stretch);
            self.clear_starts();
        }
        let mut sample = 0;
        while sample < last {
            let mut from_s = 0.0;
            if times_s[sample + 1] > times_s[sample] {
                let end = self.ground.sampling.regular_end(sample, last);
                Ahead { sample, at_s: from_s } = P::run_ahead(self, [sample, end])?;
                self.pulse.tick(1)?;
            }
            if sample == last {
                break;
            }
            if times_s[sample + 1] > times_s[sample] {
                self.step(sample, from_s)?;
            } else {
                self.step_over_jump(sample)?;
            }
            sample += 1;
        }
        self.finish(last)
    }

    /// Goes over a jump: its left side is a row of the history, its right side decides.
    #[inline(never)]
    fn step_over_jump(&mut self, sample: usize) -> Result<(), SolveError> {
        self.record_sample(sample);
        // What a jump at the very end lets go has no time to slide.
        let times_s = self.ground.times_s;
        if times_s[sample] < times_s[times_s.len() - 1] {
            self.walk_jump(sample + 1, self.loads_at(sample), self.loads_at(sample + 1))?;
        }
        Ok(())
    }

    /// Goes through one sample interval from a time in it.
    #[inline(never)]
    fn step(&mut self, sample: usize, from_s: f64) -> Result<(), SolveError> {
        self.course.events_in_interval = 0;
        for stretch in self.ground.stretches(sample, from_s).iter().flatten() {
            self.step_stretch(stretch)?;
        }
        Ok(())
    }

    fn finish(&mut self, last: usize) -> Result<(), SolveError> {
        let end_s = self.ground.times_s[last];
        self.must_be_finite(end_s)?;
        if self.has_pending_decision() {
            // A decision at the very end is made by the limit from the left.
            let interval = (0..last).rev().find(|&i| self.ground.times_s[i] < end_s);
            if let Some(interval) = interval {
                let length_s = end_s - self.ground.times_s[interval];
                let stretch = self.ground.stretch(interval, 0.0, length_s);
                self.decide(&stretch, length_s, false);
            }
        }
        if let Some(stretch) = self.ground.after_last_jump() {
            self.walk_jump(last, self.loads_at(last - 1), self.loads_at(last))?;
            self.decide(&stretch, 0.0, true);
            self.peaks_at_jump(&stretch);
        }
        self.record_sample(last);
        for i in 0..self.course.interfaces() {
            let [place_m, _] = self.phase.position_and_velocity(i);
            let interface = self.course.interface_mut(i);
            if interface.mode != Mode::Stick {
                interface.sliding.end(end_s, place_m);
            }
        }
        let slider = &mut self.course.slider;
        slider.stopping.change(end_s, 0.0, slider.memory.contact, Contact::Free);
        self.course.slider.note_surfaces(self.phase.position_and_velocity(0)[0]);
        self.end(end_s);
        P::settle(self);
        Ok(())
    }

    // ---- steps ----------------------------------------------------------------------------------

    #[inline(always)]
    fn step_stretch(&mut self, stretch: &Stretch) -> Result<(), SolveError> {
        let mut at_s = stretch.from_s;
        let mut first = at_s == 0.0;
        loop {
            let before = self.course.events.len();
            let decided = self.decide(stretch, at_s, first);
            if first || decided || self.course.events.len() > before {
                self.record(stretch, at_s, first);
            }
            first = false;
            let time_s = self.ground.times_s[stretch.interval] + at_s;
            self.note_ends(time_s)?;
            self.limit_events(time_s)?;
            self.must_be_finite(time_s)?;
            if at_s >= stretch.to_s {
                return Ok(());
            }
            self.pulse.tick(self.units)?;
            at_s = self.segment(stretch, at_s)?;
            // At a sample the limit from the right decides.
            if at_s >= stretch.to_s {
                return Ok(());
            }
        }
    }
}

impl<'a, P: Phase<'a> + ?Sized> Walk<'a, P> {
    /// What the analysis leaves behind.
    pub(super) fn outcome(&self, overturns: bool) -> Outcome {
        let (course, slider) = (&self.course, &self.course.slider);
        let impacts = course.events.iter().filter(|event| event.kind == EventKind::Impact);
        let mut stop = slider.stopping.demands;
        stop.impact_count = impacts.count() as u64;
        Outcome {
            events: course.events.clone(),
            overturns,
            sliding: course.block.sliding,
            stop: slider.law.has_stop().then_some(stop),
            surfaces: slider.surfaces.demands(),
            residual_m: self.phase.position_and_velocity(0)[0],
            sliding_at_end: course.block.mode != Mode::Stick,
            first_impact_s: self.first_impact_s,
        }
    }

    // ---- what is in force -----------------------------------------------------------------------

    /// Acceleration and normal force at a sample.
    fn loads_at(&self, sample: usize) -> [f64; 2] {
        [self.ground.acceleration[sample], self.ground.normal_at(sample)]
    }

    fn limit_events(&self, time_s: f64) -> Result<(), SolveError> {
        let limit = EVENTS_PER_INTERVAL_LIMIT;
        if self.course.events_in_interval > limit {
            return Err(SolveError::TooManyEvents { time_s, limit });
        }
        Ok(())
    }

    #[inline(always)]
    fn must_be_finite(&self, time_s: f64) -> Result<(), SolveError> {
        let [s, w] = self.phase.position_and_velocity(0);
        if !(s.is_finite() && w.is_finite()) {
            return Err(SolveError::NotFinite { time_s });
        }
        Ok(())
    }

    /// Notes surfaces at their ends; an error where none can slide on.
    #[inline(always)]
    fn note_ends(&mut self, time_s: f64) -> Result<(), SolveError> {
        self.course.slider.note_surfaces(self.phase.position_and_velocity(0)[0]);
        if self.course.block.mode != Mode::Stick && self.course.slider.at_end() {
            let travel_m = self.course.slider.law.travel_m();
            return Err(SolveError::EndOfTravel { time_s, travel_m });
        }
        Ok(())
    }

    // ---- events ---------------------------------------------------------------------------------

    /// No slip has just started.
    #[inline(always)]
    fn clear_starts(&mut self) {
        for i in 0..self.course.interfaces() {
            self.course.interface_mut(i).start = None;
        }
    }

    // ---- what is kept ---------------------------------------------------------------------------

    /// Records the present state as a knot.
    #[inline(always)]
    pub(super) fn record(&mut self, stretch: &Stretch, at_s: f64, row: bool) {
        if !self.phase.records() {
            return;
        }
        let (ground, interval) = (&self.ground, stretch.interval);
        if at_s == 0.0 {
            self.phase.record_sample(&self.course, interval, row);
        } else {
            let knot = [ground.times_s[interval] + at_s, ground.table_at(interval, at_s)];
            self.phase.record_between(&self.course, knot, (stretch, at_s), row);
        }
    }

    /// Records the present state as a row of the history.
    fn record_sample(&mut self, sample: usize) {
        if self.phase.records() {
            self.phase.record_sample(&self.course, sample, true);
        }
    }

    /// Records the knot before an event at an instant that no segment has led to.
    pub(super) fn note_before(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) {
        if !(at_sample && self.ground.starts_anew(stretch.interval)) {
            self.record(stretch, at_s, false);
        }
    }
}
