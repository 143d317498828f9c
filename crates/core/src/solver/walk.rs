//! From event to event: the one way through the motion, for the slider and all contents.
//!
//! Between two events the motion is one series of a [`Phase`]. Its first event is where an interface has no
//! velocity, reaches its bound, or where the slider's branch ends; what follows is decided in `decide`, and
//! at rigid stops in `impact`. Where a phase can, it runs ahead of this over whole samples.

mod decide;
mod impact;

use super::course::{Course, Instant, Release};
use super::ground::{Ground, Stretch};
use super::phase::{Phase, Reached as Ahead, Segment};
use super::summary::Outcome;
use crate::error::SolveError;
use crate::linear::polynomial::{Polynomial, derivative, first_root, first_root_after_zero, value};
use crate::progress::Pulse;
use crate::response::{Contact, EventKind, Mode};
use crate::slider::{Direction, Exit, Reached};

/// Most events in one sample interval before an analysis is given up.
pub const EVENTS_PER_INTERVAL_LIMIT: u32 = 1_000_000;

/// Why a segment ends before the series does.
#[derive(Clone, Copy, Debug)]
enum End {
    /// An interface has no velocity.
    Still(usize),
    /// The slider's branch ends.
    Exit(Exit),
    /// An interface that sticks reaches its bound.
    Release(Release),
    /// Friction takes all of a push against a rigid stop from here on, or no longer does.
    Lean,
}

/// A way through a motion.
pub(super) struct Walk<'a, P> {
    pub(super) phase: P,
    pub(super) course: Course<'a>,
    pub(super) ground: Ground<'a>,
    /// Asks whether to go on, after so many units of work a segment.
    pub(super) pulse: Pulse<'a>,
    pub(super) units: u32,
    /// Acceleration and normal force before the motion.
    before: [f64; 2],
    /// Whether a jump is walked, in which displacements stand.
    walks_jump: bool,
    /// What friction takes of a push against a rigid stop has just become all of it, or too little.
    leant: bool,
    leans_since_s: Option<f64>,
    /// The last turn since the last impact.
    turn: Option<usize>,
    first_impact_s: Option<f64>,
}

impl<'a, P: Phase<'a>> Walk<'a, P> {
    /// Before anything has happened, under a first acceleration and normal force; a segment is so many
    /// `units` of work.
    #[inline(always)]
    pub(super) fn new(
        (phase, course): (P, Course<'a>),
        (ground, before): (Ground<'a>, [f64; 2]),
        (pulse, units): (Pulse<'a>, u32),
    ) -> Self {
        let mut walk = Self {
            phase,
            course,
            ground,
            pulse,
            units,
            before,
            walks_jump: false,
            leant: false,
            leans_since_s: None,
            turn: None,
            first_impact_s: None,
        };
        walk.phase.enter(&walk.course);
        walk
    }

    /// Goes through all sample intervals.
    #[inline(always)]
    pub(super) fn go(&mut self) -> Result<(), SolveError> {
        let times_s = self.ground.times_s;
        let last = times_s.len() - 1;
        self.note_ends(0.0)?;
        self.lean(0.0);
        self.walk_jump(0, self.before, self.loads_at(0))?;
        if let Some(stretch) = self.ground.before_first_jump() {
            self.look_beside_jump(&stretch);
            self.clear_starts();
        }
        let mut sample = 0;
        while sample < last {
            let mut from_s = 0.0;
            if times_s[sample + 1] > times_s[sample] {
                let end = self.ground.sampling.regular_end(sample, last);
                Ahead { sample, at_s: from_s } = P::run_ahead(self, [sample, end])?;
                self.pulse.beat(1)?;
            }
            if sample == last {
                break;
            }
            if times_s[sample + 1] > times_s[sample] {
                P::step(self, sample, from_s)?;
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
    #[inline(always)]
    pub(super) fn step(&mut self, sample: usize, from_s: f64) -> Result<(), SolveError> {
        self.course.events_in_interval = 0;
        for stretch in self.ground.stretches(sample, from_s).iter().flatten() {
            self.step_stretch(stretch)?;
        }
        Ok(())
    }

    fn finish(&mut self, last: usize) -> Result<(), SolveError> {
        let end_s = self.ground.times_s[last];
        self.must_be_finite(end_s)?;
        if !self.course.released.is_empty() || self.has_any_stopped() {
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
            self.look_beside_jump(&stretch);
        }
        self.record_sample(last);
        for i in 0..self.course.interfaces() {
            let [place_m, _] = self.phase.place(i);
            let interface = self.course.interface_mut(i);
            if interface.mode != Mode::Stick {
                interface.sliding.end(end_s, place_m);
            }
        }
        let slider = &mut self.course.slider;
        if slider.law.has_pads() {
            slider.stopping.change(end_s, 0.0, slider.memory.contact, Contact::Free);
        }
        self.end_leaning(end_s);
        self.course.slider.note_surfaces(self.phase.place(0)[0]);
        P::settle(self);
        Ok(())
    }

    /// Decides by the loads beside a jump at the very start or end, and looks at the outputs under them.
    fn look_beside_jump(&mut self, stretch: &Stretch) {
        self.decide(stretch, 0.0, true);
        let segment = self.phase.expand(&self.course, stretch, 0.0).up_to(0.0);
        self.phase.move_to(0.0);
        self.phase.look(&mut self.course, stretch, &segment);
    }

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
            residual_m: self.phase.place(0)[0],
            sliding_at_end: course.block.mode != Mode::Stick,
            first_impact_s: self.first_impact_s,
        }
    }

    // ---- what is in force -----------------------------------------------------------------------

    /// Acceleration and normal force at a sample.
    fn loads_at(&self, sample: usize) -> [f64; 2] {
        [self.ground.acceleration[sample], self.ground.normal_at(sample)]
    }

    /// Whether an interface slides without a velocity.
    #[inline(always)]
    pub(super) fn has_stopped(&self, i: usize) -> bool {
        let interface = self.course.interface(i);
        interface.mode != Mode::Stick && interface.start.is_none() && self.phase.place(i)[1] == 0.0
    }

    /// Whether any does.
    pub(super) fn has_any_stopped(&self) -> bool {
        (0..self.course.interfaces()).any(|i| self.has_stopped(i))
    }

    /// Whether nothing waits to be decided: neither a slip that has just started nor what has stopped or
    /// reached its bound.
    pub(super) fn is_settled(&self) -> bool {
        let starts =
            (0..self.course.interfaces()).any(|i| self.course.interface(i).start.is_some());
        self.course.released.is_empty()
            && !self.leant
            && self.course.slider.just.is_none()
            && !starts
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
            self.pulse.beat(self.units)?;
            at_s = self.segment(stretch, at_s)?;
            // At a sample the limit from the right decides.
            if at_s >= stretch.to_s {
                return Ok(());
            }
        }
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
        let [s, w] = self.phase.place(0);
        if !(s.is_finite() && w.is_finite()) {
            return Err(SolveError::NotFinite { time_s });
        }
        Ok(())
    }

    /// One segment, up to its end or the first event in it; the time reached.
    #[inline(always)]
    fn segment(&mut self, stretch: &Stretch, from_s: f64) -> Result<f64, SolveError> {
        let (segment, end) = self.advance(stretch, from_s);
        // What is passed in no time is no peak, but for the start.
        if segment.part > 0.0 || stretch.interval == 0 {
            self.phase.look(&mut self.course, stretch, &segment);
        }
        self.follow(segment.part, end);
        match end {
            Some(End::Lean) => {
                self.leant = true;
                self.record(stretch, segment.to_s, false);
            }
            Some(End::Exit(exit)) => self.reach(stretch, segment.to_s, exit.reached)?,
            _ => {}
        }
        Ok(segment.to_s)
    }

    /// Moves up to the end of the series or the first event in it, and what ends there.
    #[inline(always)]
    fn advance(&mut self, stretch: &Stretch, from_s: f64) -> (Segment, Option<End>) {
        let mut segment = self.phase.expand(&self.course, stretch, from_s);
        let end = self.first_end(&segment).map(|(part, end)| {
            segment = segment.up_to(part);
            end
        });
        self.phase.move_to(segment.part);
        if self.course.near.is_some() {
            self.move_near(segment.part);
        }
        self.clear_starts();
        self.course.slider.just = None;
        (segment, end)
    }

    /// No slip has just started.
    #[inline(always)]
    fn clear_starts(&mut self) {
        for i in 0..self.course.interfaces() {
            self.course.interface_mut(i).start = None;
        }
    }

    /// The part of the series after which something ends, and what does.
    #[inline(always)]
    fn first_end(&mut self, segment: &Segment) -> Option<(f64, End)> {
        let mut first: Option<(f64, End)> = None;
        let mut take = |at: Option<f64>, what: End| {
            if let Some(at) = at
                && first.is_none_or(|(first, _)| at < first)
            {
                first = Some((at, what));
            }
        };
        for i in 0..self.course.interfaces() {
            if let Mode::Slip(direction) = self.course.mode(i) {
                take(self.first_halt(i, direction, segment), End::Still(i));
            }
        }
        if let Mode::Slip(direction) = self.course.block.mode
            && !self.walks_jump
        {
            let (law, memory) = (self.course.slider.law, &self.course.slider.memory);
            let exits = law.exits(memory, direction);
            if exits.iter().any(Option::is_some) {
                let series = self.phase.series();
                let sliding = [self.phase.displacement(series), self.phase.velocity(series, 0)];
                for exit in exits.into_iter().flatten() {
                    let p = self.of_exit(&exit, sliding);
                    take(first_root(&p, segment.part), End::Exit(exit));
                }
            }
        }
        for i in 0..self.course.interfaces() {
            if self.course.mode(i) == Mode::Stick
                && let Some((at, direction)) = self.first_release(i, segment.part)
            {
                take(Some(at), End::Release(Release { interface: i, direction }));
            }
        }
        if self.leans_since_s.is_some() && !self.walks_jump {
            take(self.first_lean(segment.part), End::Lean);
        }
        first
    }

    /// Where an interface that slides has no velocity.
    #[inline(always)]
    fn first_halt(&self, i: usize, direction: Direction, segment: &Segment) -> Option<f64> {
        let sign = direction.sign();
        let mut speed = self.phase.velocity(self.phase.series(), i).map(|c| sign * c);
        match self.course.interface(i).start {
            None => first_root(&speed, segment.part),
            Some(start) => {
                if start.order == 1 {
                    speed[1] = start.acceleration * segment.unit_s;
                }
                first_root_after_zero(&speed, start.order, segment.part)
            }
        }
    }

    /// The polynomial of an exit, less what of it is known to vanish, from those of `s` and `ṡ`.
    #[inline(always)]
    fn of_exit(&self, exit: &Exit, [s, w]: [&Polynomial; 2]) -> Polynomial {
        let mut p: Polynomial = core::array::from_fn(|k| exit.of_s * s[k] + exit.of_w * w[k]);
        p[0] += exit.constant;
        if let Reached::Wall(_, place) = exit.reached
            && let Some(near) = self.course.near.filter(|near| near.place == place)
        {
            p[0] = exit.of_s * near.offset;
        }
        self.course.slider.of_exit(exit, p)
    }

    /// What has come to a halt or reached its bound at a part of the series.
    #[inline(always)]
    fn follow(&mut self, part: f64, end: Option<End>) {
        match end {
            Some(End::Still(i)) => self.stand(i),
            Some(End::Release(first)) => self.find_released(first, part),
            _ => {}
        }
        self.stop_within_rounding(part);
    }

    /// An interface has come to a halt.
    #[inline(always)]
    fn stand(&mut self, i: usize) {
        let [place, _] = self.phase.place(i);
        self.phase.put(i, [place, 0.0]);
    }

    /// Stops what slides, at a part of the series, with no more velocity than rounding and no
    /// acceleration.
    #[inline(always)]
    fn stop_within_rounding(&mut self, part: f64) {
        for i in 0..self.course.interfaces() {
            let Mode::Slip(direction) = self.course.mode(i) else { continue };
            let here = direction.sign() * self.phase.place(i)[1];
            if here <= 0.0 || self.is_within_rounding(i, here, part) {
                self.stand(i);
            }
        }
    }

    /// Whether a speed is no more than rounding, and falls.
    #[inline(always)]
    fn is_within_rounding(&self, i: usize, speed: f64, part: f64) -> bool {
        let velocity = self.phase.velocity(self.phase.series(), i);
        let falls = |sign: f64| sign * value(&derivative(velocity), part) <= 0.0;
        speed <= self.rounding_m_per_s(i, velocity, part) && falls(self.course.mode(i).sign())
    }

    /// What follows the end of a branch of the slider.
    #[inline(never)]
    fn reach(&mut self, stretch: &Stretch, at_s: f64, reached: Reached) -> Result<(), SolveError> {
        let Mode::Slip(direction) = self.course.block.mode else { return Ok(()) };
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        self.course.near = None;
        let place = reached.place(direction, self.phase.place(0));
        self.phase.put(0, place);
        self.record(stretch, at_s, false);
        match self.course.slider.follow(reached, direction, time_s, place) {
            Some(kind) => self.push_event(time_s, 0, kind),
            None if matches!(reached, Reached::Wall(..)) => self.strike(stretch, at_s, direction),
            None => self.course.events_in_interval += 1,
        }
        self.phase.enter(&self.course);
        self.note_ends(time_s)?;
        self.record(stretch, at_s, false);
        Ok(())
    }

    /// Notes surfaces at their ends; an error where none can slide on.
    #[inline(always)]
    fn note_ends(&mut self, time_s: f64) -> Result<(), SolveError> {
        self.course.slider.note_surfaces(self.phase.place(0)[0]);
        if self.course.block.mode != Mode::Stick && self.course.slider.at_end() {
            return Err(SolveError::EndOfTravel { time_s });
        }
        Ok(())
    }

    fn push_event(&mut self, time_s: f64, interface: usize, kind: EventKind) {
        if interface == 0 {
            self.turn = (kind == EventKind::Reversal).then_some(self.course.events.len());
        }
        let [place_m, _] = self.phase.place(interface);
        self.course.push_of(interface, [time_s, place_m], kind);
    }

    /// The present state of the slider so long after the first sample of an interval.
    #[inline(always)]
    fn instant(&self, stretch: &Stretch, at_s: f64) -> Instant {
        Instant {
            time_s: self.ground.times_s[stretch.interval] + at_s,
            place_m: self.phase.place(0)[0],
            normal_n: stretch.normal_at(at_s),
            mass_kg: self.phase.block_kg(),
        }
    }

    // ---- what is kept ---------------------------------------------------------------------------

    /// Records the present state as a knot.
    #[inline(always)]
    fn record(&mut self, stretch: &Stretch, at_s: f64, row: bool) {
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
    fn note_before(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) {
        if !(at_sample && self.ground.starts_anew(stretch.interval)) {
            self.record(stretch, at_s, false);
        }
    }
}
