//! The motion in two horizontal directions: one slider whose friction is the same in all of them.
//!
//! The structure, springs and dampers are linear, and so is the motion under a known force of friction: a Taylor series
//! in the time (`series`). In a slip that force is the polynomial through its values at Gauss' nodes (`nodes`), whose
//! directions are those of the velocity there (`force`); a step is as long as the direction allows (`slip`). What happens
//! where a slip has come to rest is in `stop`. Peaks are those of the continuous motion (`peaks`).

mod ahead;
mod force;
mod impact;
mod mass;
mod nodes;
mod peaks;
mod record;
mod ring;
mod rows;
mod series;
mod slip;
mod speed;
mod steps;
mod stop;
mod straight;
mod summary;
mod system;
mod terms;
mod vector;

use self::ahead::Ahead;
use self::force::{Force, Influence};
use self::peaks::Peaks;
use self::record::{Knot, Recorder};
use self::series::{Kind, PlaneSeries};
use self::speed::Least;
use self::stop::Instant;
use self::system::{Loads, State};
use self::terms::Scales;
use self::vector::{inner, norm};
use super::course::{self, WalkState};
use super::ground::{Ground, GroundAlongY, Stretch};
use super::phase::{Advance, Phase};
use super::slider::leading;
use super::walk::{Events, Walk};
use crate::error::SolveError;
use crate::linear::polynomial::ZERO;
use crate::numerics::InstructionSet;
use crate::response::{EventInPlane, EventKind, Mode};
use crate::slider::{Contact, Direction, Ring};

pub(super) use self::straight::{OnLine, on_line, solve};
pub(super) use self::system::System;

/// Roundings of the time within which two knots are one.
const INSTANTS: f64 = 64.0;

/// Part of the largest velocity of the table.
const OF_TABLE: f64 = 0.1;

/// In two directions a slip is positive along its own velocity.
const SLIP: Mode = Mode::Slip(Direction::Positive);

/// State, series and peaks of an analysis in two horizontal directions.
pub(super) struct Plane<'a> {
    ground: Ground<'a>,
    along_y: GroundAlongY<'a>,
    system: System,
    state: State,
    /// Of friction: that of the last velocity, where there is none.
    direction: [f64; 2],
    /// A slip starts from rest, or goes on through it.
    starts: bool,
    /// A stick has reached its bound.
    is_released: bool,
    /// Largest speed of this slip.
    peak_speed: f64,
    /// A part of the largest velocity of the table, which a speed is compared with.
    speed_scale: f64,
    /// The length of a step of a slip that is tried next, in s.
    next_s: f64,
    /// How far from rest the last one began, as a time in s.
    near_s: f64,
    /// The last step was short because of rest, or of how fast its direction turns: its end is a knot.
    is_near_rest: bool,
    /// What the contact with the stop has become where the last step has ended.
    reached: Option<Contact>,
    /// The largest force of the stop in N.
    peak_stop_n: f64,
    /// `ρ² − d²` of a block that has struck or left a stop which does not give way, in m²: `s` itself has not the digits.
    off_stop_m2: Option<f64>,
    /// The size of the terms of what such a stop takes over `M1`.
    borne_terms: f64,
    series: PlaneSeries,
    influence: Influence,
    force: Force,
    scales: Scales,
    peaks: Peaks,
    least: Least,
    path_m: f64,
    events: Vec<EventInPlane>,
    recorder: Option<Recorder>,
    ahead: Option<Ahead>,
    /// Room for `g`.
    g: Vec<f64>,
}

impl<'a> Plane<'a> {
    fn new(
        (system, state): (System, State),
        (ground, along_y): (Ground<'a>, GroundAlongY<'a>),
        instructions: InstructionSet,
        with_history: bool,
    ) -> Self {
        let speed = norm(state.w);
        let mut scales = Scales::default();
        scales.note(&state);
        let modes = system.modes();
        let again_s = ground.sampling.dt_s.map(|dt_s| system.within_reach(dt_s));
        Self {
            ground,
            along_y,
            direction: if speed > 0.0 { state.w.map(|w| w / speed) } else { [0.0; 2] },
            starts: false,
            is_released: false,
            peak_speed: speed,
            speed_scale: OF_TABLE * largest_velocity(ground.times_s, [ground.table, along_y.table]),
            next_s: f64::INFINITY,
            near_s: f64::INFINITY,
            is_near_rest: false,
            reached: None,
            peak_stop_n: 0.0,
            off_stop_m2: None,
            borne_terms: 0.0,
            series: PlaneSeries::new(&system, instructions),
            influence: Influence::new(instructions, again_s),
            force: Force::new(),
            scales,
            peaks: Peaks::new(&system, state.s),
            least: Least::default(),
            path_m: 0.0,
            events: Vec::new(),
            recorder: with_history.then(|| Recorder::new(&system)),
            ahead: Ahead::new(&system, instructions, ground.sampling.dt_s),
            g: vec![0.0; modes],
            system,
            state,
        }
    }

    // ---- loads ----------------------------------------------------------------------------------

    /// Loads of a stretch from a time on.
    fn loads(&self, stretch: &Stretch, at_s: f64) -> Loads {
        let (times_s, y, i) = (self.ground.times_s, self.along_y.acceleration, stretch.interval);
        // Loads of an interval without length, or beyond the last, stand.
        let length_s = times_s.get(i + 1).map_or(0.0, |next_s| next_s - times_s[i]);
        let y_rate = if length_s > 0.0 { (y[i + 1] - y[i]) * (1.0 / length_s) } else { 0.0 };
        let x = [stretch.acceleration_at(at_s), stretch.acceleration_rate];
        let normal_n = stretch.normal_at(at_s);
        Loads {
            table: [x, [y[i] + y_rate * at_s, y_rate]],
            normal: [normal_n, stretch.normal_rate],
        }
    }

    fn instant(&mut self, loads: &Loads) -> Instant {
        Instant::new(&self.system, &self.state, loads, &mut self.g)
    }

    // ---- decisions ------------------------------------------------------------------------------

    /// Whether it slides without a velocity where friction could hold it.
    fn has_stopped(&self, course: &WalkState<'a>) -> bool {
        course.block.mode != Mode::Stick && !self.starts && self.state.w == [0.0; 2]
    }

    /// What is due at an instant, and by which margin it was decided.
    fn due(&mut self, course: &WalkState<'a>, stretch: &Stretch, at_s: f64) -> Option<Due> {
        let is_stuck = course.block.mode == Mode::Stick;
        if !(is_stuck || self.has_stopped(course)) {
            return None;
        }
        let loads = self.loads(stretch, at_s);
        let at = self.instant(&loads);
        let (push, hold, normal_n) = (norm(at.push), self.system.hold, loads.normal[0]);
        if is_stuck {
            let leaves = core::mem::take(&mut self.is_released) || self.leaves(loads, &at);
            return leaves.then(|| Due::Slip(self.direction_of(&at, loads)));
        }
        if hold.excess(push, normal_n) <= 0.0 || !self.leaves(loads, &at) {
            return Some(Due::Stick(hold.margin(push, normal_n)));
        }
        Some(Due::GoOn(self.system.departure(at.push, at.friction)))
    }

    /// The direction in which a push is followed; without one, that in which it grows.
    fn direction_of(&mut self, at: &Instant, loads: Loads) -> [f64; 2] {
        let mut growing = at.push;
        if at.push == [0.0; 2] {
            self.expand_stick(loads, 1e-3);
            let [x, y] = &self.series.friction;
            let orders = x.iter().zip(y).map(|(x, y)| [*x, *y]);
            growing = orders.into_iter().find(|p| *p != [0.0; 2]).unwrap_or([1.0, 0.0]);
        }
        self.system.departure(growing, at.friction)
    }

    /// Whether a stick is beyond its bound, or at it and about to leave it: the first derivative of the distance
    /// that does not vanish is negative.
    fn leaves(&mut self, loads: Loads, at: &Instant) -> bool {
        let now = at.holds * at.holds - inner(at.push, at.push);
        let rounding = self.rounding_of_distance(&loads, at.push, &self.g);
        if now.abs() > rounding {
            return now < 0.0;
        }
        self.expand_stick(loads, 1e-3);
        let distance = self.distance();
        leading(&distance, rounding).is_some_and(|k| distance[k] < 0.0)
    }

    fn record_knot(&mut self, mode: Mode, [time_s, x, y]: [f64; 3], normal_n: f64, row: bool) {
        let Some(recorder) = &mut self.recorder else { return };
        let (system, table) = (&self.system, [x, y]);
        let slope = system.slope;
        let pulled = |k: usize| [table[k] + slope[k], 0.0];
        let loads = Loads { table: [pulled(0), pulled(1)], normal: [normal_n, 0.0] };
        let at = Instant::new(system, &self.state, &loads, &mut self.g);
        let (block, friction_n) = match mode {
            Mode::Stick => (table, at.push.map(|p| -system.block_kg * p)),
            Mode::Slip(_) => {
                let taken = self.direction.map(|u| at.friction * u);
                let block = system.moved([at.pull[0] - taken[0], at.pull[1] - taken[1]]);
                ([block[0] - slope[0], block[1] - slope[1]], taken.map(|f| -system.block_kg * f))
            }
        };
        let State { s, w, eta, rate, .. } = &self.state;
        let (s, w, g) = (*s, *w, &self.g);
        let contact = self.state.contact;
        let knot = Knot { time_s, mode, contact, table, s, w, block, friction_n, eta, rate, g };
        recorder.store(system, &knot, row);
    }
}

/// `∫Ü dt` at its largest.
fn largest_velocity(times_s: &[f64], table: [&[f64]; 2]) -> f64 {
    let (mut v, mut most) = ([0.0; 2], 0.0_f64);
    for i in 1..times_s.len() {
        let half_s = 0.5 * (times_s[i] - times_s[i - 1]);
        v = [0, 1].map(|k| v[k] + half_s * (table[k][i - 1] + table[k][i]));
        most = most.max(norm(v));
    }
    most
}

/// What is due.
enum Due {
    Stick(Option<f64>),
    /// A slip in a direction.
    Slip([f64; 2]),
    /// A slip that goes on through rest in a direction, which is no event.
    GoOn([f64; 2]),
}

impl<'a> Phase<'a> for Plane<'a> {
    fn run_ahead(walk: &mut Walk<'a, Self>, samples: [usize; 2]) -> Result<Advance, SolveError> {
        ahead::run_ahead(walk, samples)
    }

    /// Its peaks are those of the steps.
    fn settle(_: &mut Walk<'a, Self>) {}

    fn update_branch(&mut self, _: &WalkState<'a>) {}

    fn position_and_velocity(&self, _: usize) -> [f64; 2] {
        [self.state.s[0], self.state.w[0]]
    }

    fn records(&self) -> bool {
        self.recorder.is_some()
    }

    fn record_sample(&mut self, course: &WalkState<'a>, sample: usize, row: bool) {
        let ground = &self.ground;
        let normal_n = ground.normal_at(sample).max(0.0);
        let knot = [ground.times_s[sample], ground.table[sample], self.along_y.table[sample]];
        self.record_knot(course.block.mode, knot, normal_n, row);
    }

    fn record_between(
        &mut self,
        course: &WalkState<'a>,
        [time_s, table]: [f64; 2],
        (stretch, at_s): (&Stretch, f64),
        row: bool,
    ) {
        let loads = self.loads(stretch, at_s);
        let [_, [pulled_y, _]] = loads.table;
        let table_y = pulled_y - self.system.slope[1];
        self.record_knot(course.block.mode, [time_s, table, table_y], loads.normal[0], row);
    }
}

/// At a jump velocities are what they were, and one slider has one bound: the right side alone decides.
impl<'a> Events for Walk<'a, Plane<'a>> {
    fn segment(&mut self, stretch: &Stretch, at_s: f64) -> Result<f64, SolveError> {
        let to_s = match self.course.block.mode {
            Mode::Stick => self.phase.hold(stretch, at_s),
            Mode::Slip(_) => self.phase.slide(stretch, at_s),
        };
        // A step is counted as an event, one without length as a thousand: none of these moves on, but to another contact.
        let moves_on = to_s > at_s || self.phase.reached.is_some();
        self.course.events_in_interval += if moves_on { 1 } else { 1000 };
        let is_near_rest = self.phase.series.kind == Kind::Slip && self.phase.is_near_rest;
        // Where times are as close as that they tell no knot from the next.
        let instant_s = INSTANTS * f64::EPSILON * self.ground.times_s[stretch.interval];
        if let Some(to) = self.phase.reached.take() {
            self.change_contact(stretch, to_s, to);
        } else if is_near_rest && to_s < stretch.to_s && to_s - at_s > instant_s {
            self.record(stretch, to_s, false);
        }
        Ok(to_s)
    }

    fn has_pending_decision(&self) -> bool {
        self.phase.is_released || self.phase.has_stopped(&self.course)
    }

    fn decide(&mut self, stretch: &Stretch, at_s: f64, at_sample: bool) -> bool {
        let Some(due) = self.phase.due(&self.course, stretch, at_s) else { return false };
        self.note_before(stretch, at_s, at_sample);
        let at = course::Instant {
            time_s: self.ground.times_s[stretch.interval] + at_s,
            place_m: self.phase.state.s[0],
            normal_n: stretch.normal_at(at_s),
            mass_kg: self.phase.system.block_kg,
        };
        let (course, phase) = (&mut self.course, &mut self.phase);
        let direction = match due {
            Due::GoOn(direction) if phase.sets_out_against_stop(direction) => {
                self.change_contact(stretch, at_s, Ring::PRESSED);
                return true;
            }
            Due::GoOn(direction) => {
                (phase.direction, phase.starts) = (direction, true);
                return true;
            }
            Due::Stick(margin) => {
                course.block.sliding.decide(margin);
                course.block.sliding.end(at.time_s, at.place_m);
                course.block.mode = Mode::Stick;
                course.push(&at, EventKind::Stick);
                [0.0; 2]
            }
            Due::Slip(direction) => {
                course.block.mode = SLIP;
                course.block.sliding.begin(at.time_s, at.place_m);
                course.push(&at, EventKind::Slip);
                (phase.direction, phase.starts, phase.peak_speed) = (direction, true, 0.0);
                direction
            }
        };
        phase.least.interrupt();
        let sliding_displacement_y_m = phase.state.s[1];
        phase.events.push(EventInPlane { direction, sliding_displacement_y_m });
        self.touch_at_rest((stretch, at_s), direction);
        true
    }

    fn peaks_at_jump(&mut self, stretch: &Stretch) {
        let loads = self.phase.loads(stretch, 0.0);
        let phase = &mut self.phase;
        match self.course.block.mode {
            Mode::Stick => phase.expand_stick(loads, 1e-3),
            Mode::Slip(_) => {
                let at = phase.instant(&loads);
                phase.hold_stop_under(&loads);
                phase.series.from = phase.direction;
                let taken = phase.direction.map(|u| at.friction * u);
                for (friction, taken) in phase.series.friction.iter_mut().zip(taken) {
                    (*friction, friction[0]) = (ZERO, taken);
                }
                phase.expand(Kind::Slip, (loads, 1e-3));
            }
        }
        phase.look_for_peaks(stretch, 0.0, 0.0);
        phase.starts = false;
    }
}
