//! Segments of a motion in one direction: a series up to its end or the first event in it.

use super::super::course::{Instant, Release};
use super::super::ground::Stretch;
use super::super::phase::{LinePhase, Segment};
use super::{Events, Line, Walk};
use crate::error::SolveError;
use crate::linear::polynomial::{Polynomial, derivative, first_root, first_root_after_zero, value};
use crate::response::{EventKind, Mode};
use crate::slider::{BranchEnd, Direction, Exit};

/// Why a segment ends before the series does.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// An interface has no velocity.
    Still(usize),
    /// The slider's branch ends.
    Exit(Exit),
    /// An interface that sticks reaches its bound.
    Release(Release),
    /// Friction takes all of a push against a rigid stop from here on, or no longer does.
    BearingOnStop,
}

impl<'a, P: LinePhase<'a>> Events for Walk<'a, P> {
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
            Some(End::BearingOnStop) => {
                self.bearing_changed = true;
                self.record(stretch, segment.to_s, false);
            }
            Some(End::Exit(exit)) => self.line().reach(stretch, segment.to_s, exit.reached)?,
            _ => {}
        }
        Ok(segment.to_s)
    }

    /// Whether something waits to be decided: a stop or what has reached its bound.
    fn has_pending_decision(&self) -> bool {
        !self.course.released.is_empty() || self.has_any_stopped()
    }

    /// Decides all that is due at an instant; whether something was.
    #[inline(always)]
    fn decide(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) -> bool {
        match self.decide_beyond_doubt(stretch, at_s, at_sample) {
            Some(decided) => decided,
            None => self.line().decide_by_series(stretch, at_s, at_sample),
        }
    }

    /// Goes through a jump of the loads: what it releases has reached its bound. Displacements and
    /// velocities are what they were.
    #[inline(always)]
    fn walk_jump(&mut self, sample: usize, from: [f64; 2], to: [f64; 2]) -> Result<(), SolveError> {
        if self.is_lone() {
            return Ok(());
        }
        self.walk_ramps(sample, from, to)
    }

    /// Looks at the outputs under loads that stand.
    fn peaks_at_jump(&mut self, stretch: &Stretch) {
        let segment = self.phase.expand(&self.course, stretch, 0.0).up_to(0.0);
        self.phase.move_to(0.0);
        self.phase.look(&mut self.course, stretch, &segment);
    }

    fn begin(&mut self) {
        self.line().begin_bearing_on_stop(0.0);
    }

    fn end(&mut self, end_s: f64) {
        self.line().end_bearing_on_stop(end_s);
    }
}

impl<'a, P: LinePhase<'a>> Walk<'a, P> {
    /// As what is done now and then sees it.
    pub(super) fn line(&mut self) -> &mut Line<'a> {
        self
    }

    /// Whether nothing waits to be decided: neither a slip that has just started nor what has stopped or
    /// reached its bound.
    pub(in crate::solver) fn is_settled(&self) -> bool {
        let starts =
            (0..self.course.interfaces()).any(|i| self.course.interface(i).start.is_some());
        self.course.released.is_empty()
            && !self.bearing_changed
            && self.course.slider.just.is_none()
            && !starts
    }

    /// Moves up to the end of the series or the first event in it, and what ends there.
    #[inline(always)]
    pub(super) fn advance(&mut self, stretch: &Stretch, from_s: f64) -> (Segment, Option<End>) {
        let mut segment = self.phase.expand(&self.course, stretch, from_s);
        let end = self.first_end(&segment).map(|(part, end)| {
            segment = segment.up_to(part);
            end
        });
        self.phase.move_to(segment.part);
        if self.course.near.is_some() {
            self.line().move_near(segment.part);
        }
        self.clear_starts();
        self.course.slider.just = None;
        (segment, end)
    }

    /// The part of the series after which something ends, and what does.
    #[inline(always)]
    pub(super) fn first_end(&mut self, segment: &Segment) -> Option<(f64, End)> {
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
                let sliding = [self.phase.displacement(), self.phase.velocity(0)];
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
        if self.bears_on_stop_since_s.is_some() && !self.walks_jump {
            take(self.line().first_change_of_bearing(segment.part), End::BearingOnStop);
        }
        first
    }

    /// Where an interface that slides has no velocity.
    #[inline(always)]
    pub(super) fn first_halt(
        &self,
        i: usize,
        direction: Direction,
        segment: &Segment,
    ) -> Option<f64> {
        let sign = direction.sign();
        let mut speed = self.phase.velocity(i).map(|c| sign * c);
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
    pub(super) fn of_exit(&self, exit: &Exit, [s, w]: [&Polynomial; 2]) -> Polynomial {
        let mut p: Polynomial = core::array::from_fn(|k| exit.of_s * s[k] + exit.of_w * w[k]);
        p[0] += exit.constant;
        if let BranchEnd::Wall(_, place) = exit.reached
            && let Some(near) = self.course.near.filter(|near| near.place == place)
        {
            p[0] = exit.of_s * near.offset;
        }
        self.course.slider.of_exit(exit, p)
    }

    /// What has come to a halt or reached its bound at a part of the series.
    #[inline(always)]
    pub(super) fn follow(&mut self, part: f64, end: Option<End>) {
        match end {
            Some(End::Still(i)) => self.stand(i),
            Some(End::Release(first)) => self.find_released(first, part),
            _ => {}
        }
        self.stop_within_rounding(part);
    }

    /// Stops what slides, at a part of the series, with no more velocity than rounding and no
    /// acceleration.
    #[inline(always)]
    pub(super) fn stop_within_rounding(&mut self, part: f64) {
        for i in 0..self.course.interfaces() {
            let Mode::Slip(direction) = self.course.mode(i) else { continue };
            let here = direction.sign() * self.phase.position_and_velocity(i)[1];
            if here <= 0.0 || self.is_within_rounding(i, here, part) {
                self.stand(i);
            }
        }
    }

    /// Whether a speed is no more than rounding, and falls.
    #[inline(always)]
    pub(super) fn is_within_rounding(&self, i: usize, speed: f64, part: f64) -> bool {
        let velocity = self.phase.velocity(i);
        let falls = |sign: f64| sign * value(&derivative(velocity), part) <= 0.0;
        speed <= self.rounding_m_per_s(i, velocity, part) && falls(self.course.mode(i).sign())
    }
}

impl<'a, P: LinePhase<'a> + ?Sized> Walk<'a, P> {
    /// Whether any does.
    pub(super) fn has_any_stopped(&self) -> bool {
        (0..self.course.interfaces()).any(|i| self.has_stopped(i))
    }

    /// Whether an interface slides without a velocity.
    #[inline(always)]
    pub(in crate::solver) fn has_stopped(&self, i: usize) -> bool {
        let interface = self.course.interface(i);
        interface.mode != Mode::Stick
            && interface.start.is_none()
            && self.phase.position_and_velocity(i)[1] == 0.0
    }

    /// An interface has come to a halt.
    #[inline(always)]
    pub(super) fn stand(&mut self, i: usize) {
        let [place, _] = self.phase.position_and_velocity(i);
        self.phase.set_position_and_velocity(i, [place, 0.0]);
    }

    /// The present state of the slider so long after the first sample of an interval.
    #[inline(always)]
    pub(super) fn instant(&self, stretch: &Stretch, at_s: f64) -> Instant {
        Instant {
            time_s: self.ground.times_s[stretch.interval] + at_s,
            place_m: self.phase.position_and_velocity(0)[0],
            normal_n: stretch.normal_at(at_s),
            mass_kg: self.phase.block_kg(),
        }
    }
}

impl<'a> Line<'a> {
    /// What follows the end of a branch of the slider.
    #[inline(never)]
    pub(super) fn reach(
        &mut self,
        stretch: &Stretch,
        at_s: f64,
        reached: BranchEnd,
    ) -> Result<(), SolveError> {
        let Mode::Slip(direction) = self.course.block.mode else { return Ok(()) };
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        self.course.near = None;
        let place = reached.place(direction, self.phase.position_and_velocity(0));
        self.phase.set_position_and_velocity(0, place);
        self.record(stretch, at_s, false);
        match self.course.slider.follow(reached, direction, time_s, place) {
            Some(kind) => self.push_event(time_s, 0, kind),
            None if matches!(reached, BranchEnd::Wall(..)) => self.strike(stretch, at_s, direction),
            None => self.course.events_in_interval += 1,
        }
        self.phase.update_branch(&self.course);
        self.note_ends(time_s)?;
        self.record(stretch, at_s, false);
        Ok(())
    }

    pub(super) fn push_event(&mut self, time_s: f64, interface: usize, kind: EventKind) {
        if interface == 0 {
            self.turn = (kind == EventKind::Reversal).then_some(self.course.events.len());
        }
        let [place_m, _] = self.phase.position_and_velocity(interface);
        self.course.push_of(interface, [time_s, place_m], kind);
    }
}
