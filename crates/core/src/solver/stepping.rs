//! Event stepping of what does not go by tables: rigid stops that are reached, contents that slide on
//! the floors, and friction by speed, surfaces in series or a pendulum under vertical motion.
//!
//! The slider and the contents are interfaces, each of which sticks or slides. Between two events the
//! motion is one Taylor series in physical coordinates, nonlinear where the force is; the slider's law
//! says which force, where it ends, what holds at rest and what follows. Whole samples in which nothing
//! happens go eight at a time where the motion is affine (`ahead`).

mod affine;
mod ahead;
mod body;
mod decide;
mod keep;

use self::ahead::Ahead;
use self::body::{Body, Expansion, Loads, Phase, State};
use self::decide::LetGo;
use self::keep::{Peaks, history};
use super::event::{EVENTS_PER_INTERVAL_LIMIT, fitting};
use super::ground::{Ground, Stretch};
use super::prepared::InstructionSet;
use super::run::{Outcome, Sliding};
use super::slider::SliderState;
use super::tables::system_of;
use crate::error::SolveError;
use crate::linear::polynomial::{DEGREE, Polynomial, deflated, first_root, value};
use crate::model::Model;
use crate::progress::{GoOn, Pulse};
use crate::response::{
    Contact, ContentsDemands, Event, EventKind, History, Mode, StopDemands, Warning,
};
use crate::slider::{Coefficient, Direction, Exit, Hold, Law, Reached, Restraint, SlipForce};

/// Impacts slower than this are neither listed nor counted, in m/s.
pub(super) const SLOWEST_IMPACT_M_PER_S: f64 = 1e-3;

/// What an analysis leaves behind.
pub(super) struct Stepped {
    pub(super) outcome: Outcome,
    /// Peaks in the order of [`rows`](super::outputs::rows).
    pub(super) peaks: Vec<f64>,
    pub(super) contents: Vec<ContentsDemands>,
    pub(super) history: Option<History>,
    pub(super) warnings: Vec<Warning>,
}

/// Solves a model with devices.
pub(super) fn solve(
    model: &Model,
    law: &Law<'_>,
    ground: Ground<'_>,
    instructions: InstructionSet,
    (with_history, go_on): (bool, GoOn<'_>),
) -> Result<Stepped, SolveError> {
    let how = (with_history, Pulse::new(go_on));
    let mut run = Stepping::new(model, law, ground, instructions, how);
    run.go()?;
    Ok(run.stepped())
}

/// Why a segment ends before the series does.
#[derive(Clone, Copy, Debug)]
enum End {
    /// An interface has no velocity.
    Still(usize),
    /// The slider's branch ends.
    Exit(Exit),
    /// Interfaces that stuck reach their bounds.
    Release,
    /// Friction takes all of a push against a rigid stop from here on, or no longer does.
    Lean,
}

/// A rigid stop that has just been struck, and where the block is to it.
#[derive(Clone, Copy)]
struct Near {
    place: f64,
    offset: f64,
}

struct Stepping<'a> {
    model: &'a Model,
    slider: SliderState<'a>,
    ground: Ground<'a>,
    instructions: InstructionSet,
    ahead: Ahead,
    body: Body,
    x: State,
    modes: Vec<Mode>,
    /// Number of leading coefficients of `|velocity|` that vanish where a slip starts.
    start: Vec<Option<usize>>,
    /// Interfaces that have reached their bounds.
    pending: Vec<LetGo>,
    /// Whether a jump is walked, in which displacements stand.
    walks_jump: bool,
    near: Option<Near>,
    /// What friction takes of a push against a rigid stop has just become all of it, or too little.
    leant: bool,
    series: Expansion,
    /// Of one instant.
    instant: Expansion,
    unit_s: f64,
    events: Vec<Event>,
    events_in_interval: u32,
    /// The last turn since the last impact.
    turn: Option<usize>,
    sliding: Vec<Sliding>,
    leans_since_s: Option<f64>,
    first_impact_s: Option<f64>,
    peaks: Peaks,
    history: Option<History>,
    /// Room for the state and the outputs of a knot.
    knot: [Vec<[f64; 1]>; 2],
    /// Asks whether to go on, after so many units of work a segment.
    pulse: Pulse<'a>,
    units: u32,
}

impl<'a> Stepping<'a> {
    fn new(
        model: &'a Model,
        law: &'a Law<'a>,
        ground: Ground<'a>,
        instructions: InstructionSet,
        (with_history, pulse): (bool, Pulse<'a>),
    ) -> Self {
        let body = Body::new(model, &system_of(model));
        let initial = model.initial();
        let count = body.contents.len();
        let (s, w) = (initial.sliding_displacement_m, initial.sliding_velocity_m_per_s);
        let x = State {
            s,
            w,
            q: model.initial_storey_displacement_m(),
            v: model.initial_storey_velocity_m_per_s(),
            r: vec![0.0; count],
            p: vec![0.0; count],
        };
        let mut modes = vec![Mode::Stick; 1 + count];
        if w != 0.0 {
            modes[0] = Mode::Slip(if w > 0.0 { Direction::Positive } else { Direction::Negative });
        }
        let slider = SliderState::new(law, s, w);
        let surfaces = law.surfaces(&slider.memory, s).len();
        let history = with_history.then(|| history(&body, surfaces, ground.times_s.len()));
        let mut sliding = vec![Sliding::new(s)];
        sliding.resize(1 + count, Sliding::new(0.0));
        Self {
            model,
            slider,
            ground,
            instructions,
            ahead: Ahead::default(),
            series: body.room(),
            instant: body.room(),
            peaks: Peaks::new(model, count),
            body,
            x,
            modes,
            start: vec![None; 1 + count],
            pending: Vec::new(),
            walks_jump: false,
            near: None,
            leant: false,
            unit_s: f64::INFINITY,
            events: Vec::new(),
            events_in_interval: 0,
            turn: None,
            sliding,
            leans_since_s: None,
            first_impact_s: None,
            history,
            knot: [Vec::new(), Vec::new()],
            pulse,
            units: 128 * (1 + model.storeys() + count) as u32,
        }
    }

    fn go(&mut self) -> Result<(), SolveError> {
        let times_s = self.ground.times_s;
        let last = times_s.len() - 1;
        self.note_ends(0.0)?;
        self.lean(0.0);
        let before = [self.model.slope_m_per_s2(), self.model.normal_n()];
        self.walk_jump(0, before, self.loads_at(0))?;
        if let Some(stretch) = self.ground.before_first_jump() {
            self.look_beside_jump(&stretch);
            self.start.fill(None);
        }
        let mut sample = 0;
        loop {
            sample = self.run_ahead(sample, last);
            if sample == last {
                return self.finish(last);
            }
            self.step(sample)?;
            sample += 1;
        }
    }

    /// Goes through one sample interval, or a jump.
    fn step(&mut self, sample: usize) -> Result<(), SolveError> {
        let times_s = self.ground.times_s;
        if times_s[sample + 1] == times_s[sample] {
            self.record_sample(sample, true);
            // What a jump at the very end lets go has no time to slide.
            if times_s[sample] < times_s[times_s.len() - 1] {
                self.walk_jump(sample + 1, self.loads_at(sample), self.loads_at(sample + 1))?;
            }
            return Ok(());
        }
        self.events_in_interval = 0;
        for stretch in self.ground.stretches(sample, 0.0).iter().flatten() {
            self.step_stretch(stretch)?;
        }
        Ok(())
    }

    fn finish(&mut self, last: usize) -> Result<(), SolveError> {
        let end_s = self.ground.times_s[last];
        if !(self.x.s.is_finite() && self.x.w.is_finite()) {
            return Err(SolveError::NotFinite { time_s: end_s });
        }
        let due = (0..self.modes.len()).any(|i| self.has_stopped(i)) || !self.pending.is_empty();
        if due {
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
        self.record_sample(last, true);
        for i in 0..self.modes.len() {
            if matches!(self.modes[i], Mode::Slip(_)) {
                let place = self.place(i);
                self.sliding[i].end(end_s, place);
            }
        }
        if self.slider.law.has_pads() {
            self.slider.stopping.change(end_s, 0.0, self.slider.memory.contact, Contact::Free);
        }
        self.end_leaning(end_s);
        self.slider.note_surfaces(self.x.s);
        self.settle_candidates();
        Ok(())
    }

    /// Decides by the loads beside a jump at the very start or end, and looks at the outputs under them.
    fn look_beside_jump(&mut self, stretch: &Stretch) {
        self.decide(stretch, 0.0, true);
        self.expand(stretch, 0.0);
        self.look(0.0);
    }

    fn stepped(self) -> Stepped {
        let count = |interface: usize, kind| {
            let all = self.events.iter();
            all.filter(|e| e.interface == interface && e.kind == kind).count() as u64
        };
        let of_part = |part: &usize| {
            let (interface, sliding) = (1 + part, &self.sliding[1 + part]);
            ContentsDemands {
                peak_sliding_displacement_m: sliding.max_m.max(-sliding.min_m),
                residual_sliding_displacement_m: self.x.r[*part],
                sliding_path_m: sliding.path_m,
                sliding_time_s: sliding.time_s,
                peak_sliding_velocity_m_per_s: self.peaks.values[self.velocity_output(interface)],
                peak_acceleration_m_per_s2: self.peaks.values
                    [self.contents_acceleration_output(*part)],
                slip_count: count(interface, EventKind::Slip),
                reversal_count: count(interface, EventKind::Reversal),
                stick_count: count(interface, EventKind::Stick),
            }
        };
        let contents = self.body.part_of.iter().map(of_part).collect();
        let warnings = self.first_impact_s.map(|time_s| Warning {
            kind: "impulses_excluded",
            time_s: Some(time_s),
            message:
                "the block strikes a rigid stop: peak accelerations and forces are those of the \
                      motion between impacts, without the impulses"
                    .to_owned(),
        });
        let has_stop = self.slider.law.has_stop();
        let demands = StopDemands {
            impact_count: count(0, EventKind::Impact),
            ..self.slider.stopping.demands
        };
        Stepped {
            outcome: Outcome {
                events: self.events_of_items(),
                overturns: self.peaks.overturns,
                sliding: self.sliding[0],
                stop: has_stop.then_some(demands),
                surfaces: self.slider.surfaces.demands(),
                residual_m: self.x.s,
                sliding_at_end: matches!(self.modes[0], Mode::Slip(_)),
            },
            peaks: self.peaks.values,
            contents,
            history: self.history,
            warnings: warnings.into_iter().collect(),
        }
    }

    /// All events, those of contents for each item that slides with them.
    fn events_of_items(&self) -> Vec<Event> {
        let mut all = Vec::with_capacity(self.events.len());
        for event in &self.events {
            if event.interface == 0 {
                all.push(*event);
                continue;
            }
            let items = self.body.part_of.iter().enumerate();
            let alike = items.filter(|(_, part)| 1 + **part == event.interface);
            all.extend(alike.map(|(item, _)| Event { interface: 1 + item, ..*event }));
        }
        all
    }

    // ---- what is in force -----------------------------------------------------------------------

    /// Displacement of an interface.
    fn place(&self, interface: usize) -> f64 {
        if interface == 0 { self.x.s } else { self.x.r[interface - 1] }
    }

    /// Velocity of an interface.
    fn velocity(&self, interface: usize) -> f64 {
        if interface == 0 { self.x.w } else { self.x.p[interface - 1] }
    }

    /// What holds the slider at rest; off a stop by less than the rounding of `s` it does not lean on it.
    fn held(&self) -> Hold {
        let hold = self.slider.hold(self.x.s);
        match self.near {
            Some(near) if near.offset != 0.0 => hold.off_stops(),
            _ => hold,
        }
    }

    /// Acceleration and normal force at a sample.
    fn loads_at(&self, sample: usize) -> [f64; 2] {
        [self.ground.acceleration[sample], self.ground.normal_at(sample)]
    }

    fn loads(stretch: &Stretch, at_s: f64) -> Loads {
        Loads {
            acceleration: [stretch.acceleration_at(at_s), stretch.acceleration_rate],
            normal: [stretch.normal_at(at_s), stretch.normal_rate],
        }
    }

    /// The force of the slider in a mode; in stick what springs and stops do.
    fn force(&self, mode: Mode) -> SlipForce {
        match mode {
            Mode::Slip(direction) => self.slider.law.force(&self.slider.memory, direction),
            Mode::Stick => {
                let hold = self.held();
                SlipForce {
                    restraint: Restraint::default(),
                    is_pressed: false,
                    force_n: hold.force_n,
                    of_normal: hold.of_normal,
                    of_normal_s: 0.0,
                    is_friction: false,
                    sign: 0.0,
                    coefficient: Coefficient::Linear { at_rest: 0.0, slope_s_per_m: 0.0 },
                }
            }
        }
    }

    /// Finds accelerations and forces of this instant.
    fn look_at_instant(&mut self, loads: &Loads) {
        self.look_at_orders(0, loads);
    }

    /// Finds the coefficients of this instant up to an order; of the state one more is asked for than of
    /// forces.
    fn look_at_orders(&mut self, orders: usize, loads: &Loads) {
        let force = self.force(self.modes[0]);
        let phase = Phase { modes: &self.modes, force };
        self.body.expand(&self.x, &phase, loads, (1.0, orders), &mut self.instant);
    }

    // ---- steps ----------------------------------------------------------------------------------

    fn step_stretch(&mut self, stretch: &Stretch) -> Result<(), SolveError> {
        let mut at_s = stretch.from_s;
        let mut first = at_s == 0.0;
        loop {
            let before = self.events.len();
            let decided = self.decide(stretch, at_s, first);
            if first || decided || self.events.len() > before {
                self.record(stretch, at_s, first);
            }
            first = false;
            let time_s = self.ground.times_s[stretch.interval] + at_s;
            self.note_ends(time_s)?;
            self.limit_events(time_s)?;
            if !(self.x.s.is_finite() && self.x.w.is_finite()) {
                return Err(SolveError::NotFinite { time_s });
            }
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
        if self.events_in_interval > limit {
            return Err(SolveError::TooManyEvents { time_s, limit });
        }
        Ok(())
    }

    /// Expands the motion from an instant over as much of a stretch as one series takes.
    fn expand(&mut self, stretch: &Stretch, from_s: f64) {
        let loads = Self::loads(stretch, from_s);
        let left_s = stretch.to_s - from_s;
        let force = self.force(self.modes[0]);
        let phase = Phase { modes: &self.modes, force };
        let rate = self.body.rate_rad_per_s;
        let fastest = if rate > 0.0 { 1.0 / rate } else { left_s };
        let [_, part] = fitting(&mut self.unit_s, fastest, left_s, |unit_s| {
            self.body.expand(&self.x, &phase, &loads, (unit_s, DEGREE), &mut self.series);
            self.series.part
        });
        (self.series.part, self.series.from_s) = (part, from_s);
    }

    /// The polynomial of an exit, less what of it is known to vanish.
    fn of_exit(&self, exit: &Exit) -> Polynomial {
        let (s, w) = (&self.series.s, &self.series.w);
        let mut p: Polynomial = core::array::from_fn(|k| exit.of_s * s[k] + exit.of_w * w[k]);
        p[0] += exit.constant;
        if let Reached::Wall(_, place) = exit.reached
            && let Some(near) = self.near.filter(|near| near.place == place)
        {
            p[0] = exit.of_s * near.offset;
        }
        self.slider.of_exit(exit, p)
    }

    /// One segment, up to its end or the first event in it; the time reached.
    fn segment(&mut self, stretch: &Stretch, from_s: f64) -> Result<f64, SolveError> {
        let (to_s, part, end) = self.walk(stretch, from_s);
        // What is passed in no time is no peak, but for the start.
        if part > 0.0 || stretch.interval == 0 {
            self.look(part);
        }
        self.follow(part, end);
        match end {
            Some(End::Lean) => {
                self.leant = true;
                self.record(stretch, to_s, false);
            }
            Some(End::Exit(exit)) => self.reach(stretch, to_s, exit.reached)?,
            _ => {}
        }
        Ok(to_s)
    }

    /// Moves up to the end of the series or the first event in it: the time and the part of the series
    /// reached, and what ends there.
    fn walk(&mut self, stretch: &Stretch, from_s: f64) -> (f64, f64, Option<End>) {
        self.expand(stretch, from_s);
        let (part, end) = self.first_end();
        let is_whole = end.is_none() && part == 1.0;
        let to_s = from_s + part * self.series.unit_s;
        // The series of a whole stretch ends where the stretch does.
        let to_s = if is_whole && from_s + self.series.unit_s >= stretch.to_s * (1.0 - 1e-15) {
            stretch.to_s
        } else {
            to_s.min(stretch.to_s)
        };
        self.move_to(part);
        self.start.fill(None);
        self.slider.just = None;
        (to_s, part, end)
    }

    /// The part of the series after which something ends, and what does.
    fn first_end(&mut self) -> (f64, Option<End>) {
        let mut part = self.series.part;
        let mut end = None;
        let mut take = |at: Option<f64>, what: End| {
            if let Some(at) = at
                && (at < part || end.is_none())
            {
                (part, end) = (at, Some(what));
            }
        };
        for i in 0..self.modes.len() {
            let Mode::Slip(direction) = self.modes[i] else { continue };
            let speed = self.series.speed(i, direction);
            let left = self.start[i].map_or(speed, |order| deflated(&speed, order));
            take(first_root(&left, self.series.part), End::Still(i));
        }
        if let Mode::Slip(direction) = self.modes[0]
            && !self.walks_jump
        {
            for exit in self.slider.law.exits(&self.slider.memory, direction).into_iter().flatten()
            {
                let p = self.of_exit(&exit);
                take(first_root(&p, self.series.part), End::Exit(exit));
            }
        }
        for i in 0..self.modes.len() {
            if self.modes[i] == Mode::Stick {
                take(self.first_release(i).map(|(at, _)| at), End::Release);
            }
        }
        if let Some((_, mut beyond)) = self.beyond_friction().filter(|_| !self.walks_jump) {
            if core::mem::take(&mut self.leant) {
                beyond[0] = 0.0;
            }
            if let Some(order) = beyond.iter().position(|c| *c != 0.0) {
                let sign = beyond[order].signum();
                let p = deflated(&beyond.map(|c| sign * c), order);
                take(first_root(&p, self.series.part).filter(|at| *at > 0.0), End::Lean);
            }
        }
        (part, end)
    }

    /// What has come to a halt or reached its bound at a part of the series.
    fn follow(&mut self, part: f64, end: Option<End>) {
        match end {
            Some(End::Still(i)) => self.stand(i),
            Some(End::Release) => self.pending = self.released(part),
            _ => {}
        }
        self.stop_within_rounding(part);
    }

    /// Where the slider rests against a rigid stop: how much of its push friction cannot take, positive
    /// where the stop takes some; and the sign of that push.
    fn beyond_friction(&self) -> Option<(f64, Polynomial)> {
        if self.modes[0] != Mode::Stick {
            return None;
        }
        self.held().beyond_friction(&self.series.friction, &self.series.normal)
    }

    /// Moves to a part of the series.
    fn move_to(&mut self, part: f64) {
        self.series.state_at(part, &mut self.x);
        if self.modes[0] == Mode::Stick {
            (self.x.s, self.x.w) = (self.series.s[0], 0.0);
        }
        for (i, r) in self.series.r.iter().enumerate() {
            if self.modes[1 + i] == Mode::Stick {
                (self.x.r[i], self.x.p[i]) = (r[0], 0.0);
            }
        }
        if let Some(near) = &mut self.near {
            let mut moved = self.series.s;
            moved[0] = 0.0;
            near.offset += value(&moved, part);
            self.x.s = near.place + near.offset;
        }
        // Further away s itself has the digits.
        self.near = self.near.filter(|near| near.offset.abs() <= 1e-3 * near.place.abs());
    }

    /// An interface has come to a halt.
    fn stand(&mut self, interface: usize) {
        if interface == 0 {
            self.x.w = 0.0;
        } else {
            self.x.p[interface - 1] = 0.0;
        }
    }

    /// What follows the end of a branch of the slider.
    fn reach(&mut self, stretch: &Stretch, at_s: f64, reached: Reached) -> Result<(), SolveError> {
        let Mode::Slip(direction) = self.modes[0] else { return Ok(()) };
        let time_s = self.ground.times_s[stretch.interval] + at_s;
        self.near = None;
        [self.x.s, self.x.w] = reached.place(direction, [self.x.s, self.x.w]);
        self.record(stretch, at_s, false);
        let place = [self.x.s, self.x.w];
        match self.slider.follow(reached, direction, time_s, place) {
            Some(kind) => self.push_event(time_s, 0, kind),
            None if matches!(reached, Reached::Wall(..)) => self.strike(stretch, at_s, direction),
            None => self.events_in_interval += 1,
        }
        self.note_ends(time_s)?;
        self.record(stretch, at_s, false);
        Ok(())
    }

    /// Notes surfaces at their ends; an error where none can slide on.
    fn note_ends(&mut self, time_s: f64) -> Result<(), SolveError> {
        self.slider.note_surfaces(self.x.s);
        if self.modes[0] != Mode::Stick && self.slider.at_end() {
            return Err(SolveError::EndOfTravel { time_s });
        }
        Ok(())
    }

    fn push_event(&mut self, time_s: f64, interface: usize, kind: EventKind) {
        self.events_in_interval += 1;
        if interface == 0 {
            self.turn = (kind == EventKind::Reversal).then_some(self.events.len());
        }
        self.events.push(Event {
            time_s,
            kind,
            mode: self.modes[interface],
            sliding_displacement_m: self.place(interface),
            interface,
        });
    }
}
