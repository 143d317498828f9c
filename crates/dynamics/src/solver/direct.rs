//! The motion in physical coordinates, for what does not go by tables: rigid stops that are reached, contents
//! that slide on the floors, and friction by speed, surfaces in series or a pendulum under vertical motion.
//!
//! Between two events it is one Taylor series, nonlinear where the force is; the slider's law says which
//! force. Whole samples in which nothing happens go eight at a time where the motion is affine (`ahead`).

mod affine;
mod ahead;
mod body;
mod peaks;

use self::ahead::Ahead;
use self::body::{Body, Expansion, InForce, Loads, State};
use self::peaks::{Peaks, history};
use super::course::WalkState;
use super::ground::{Ground, Stretch};
use super::phase::{Advance, LinePhase, Of, Phase, Segment, fitting};
use super::slider::{ROUNDING, SliderState};
use super::tables::system_of;
use super::walk::Walk;
use crate::error::SolveError;
use crate::linear::polynomial::{DEGREE, Polynomial};
use crate::model::Model;
use crate::notice::Notice;
use crate::numerics::InstructionSet;
use crate::progress::{Cancel, Pulse};
use crate::response::output::{self, Output};
use crate::response::{ContentsDemands, Event, EventKind, History, Mode};
use crate::slider::{Hold, Law, SlipForce};

use super::summary::{self, Outcome};

/// What an analysis leaves behind.
pub(super) struct Stepped {
    pub(super) outcome: Outcome,
    /// Peaks in the order of [`Output::all`].
    pub(super) peaks: Vec<f64>,
    pub(super) contents: Vec<ContentsDemands>,
    pub(super) history: Option<History>,
    pub(super) warnings: Vec<Notice>,
}

/// Solves a model with devices.
pub(super) fn solve(
    model: &Model,
    law: &Law<'_>,
    ground: Ground<'_>,
    instructions: InstructionSet,
    (with_history, go_on): (bool, Cancel<'_>),
) -> Result<Stepped, SolveError> {
    let mut walk = start(model, law, ground, instructions, (with_history, Pulse::new(go_on)));
    walk.go()?;
    Ok(stepped(walk))
}

/// A walk before anything has happened.
fn start<'a>(
    model: &'a Model,
    law: &'a Law<'a>,
    ground: Ground<'a>,
    instructions: InstructionSet,
    (with_history, pulse): (bool, Pulse<'a>),
) -> Walk<'a, Direct<'a>> {
    let phase = Direct::new(model, law, ground, instructions, with_history);
    let count = phase.body.contents.len();
    let [s, w] = phase.position_and_velocity(0);
    let course = WalkState::new(SliderState::new(law, s, w), [s, w], (Vec::new(), Vec::new()))
        .with_contents(count);
    let before = [model.slope_m_per_s2(), model.normal_n()];
    let units = 128 * (1 + model.storeys() + count) as u32;
    Walk::new((phase, course), (ground, before), (pulse, units))
}

fn stepped(walk: Walk<'_, Direct<'_>>) -> Stepped {
    let (phase, events) = (&walk.phase, &walk.course.events);
    let count = |interface: usize, kind| {
        let own = events.iter().filter(|e| e.interface == interface && e.kind == kind);
        own.count() as u64
    };
    let of_part = |part: &usize| {
        let (interface, sliding) = (1 + part, &walk.course.contents[*part].sliding);
        let peaks = &phase.peaks.values;
        ContentsDemands {
            peak_sliding_displacement_m: sliding.max_m.max(-sliding.min_m),
            residual_sliding_displacement_m: phase.x.r[*part],
            sliding_path_m: sliding.path_m,
            sliding_time_s: sliding.time_s,
            peak_sliding_velocity_m_per_s: peaks[phase.velocity_output(interface)],
            peak_acceleration_m_per_s2: peaks[phase.contents_acceleration_output(*part)],
            slip_count: count(interface, EventKind::Slip),
            reversal_count: count(interface, EventKind::Reversal),
            stick_count: count(interface, EventKind::Stick),
        }
    };
    let contents = phase.body.part_of.iter().map(of_part).collect();
    let mut outcome = walk.outcome(phase.peaks.inertia.arms.is_some());
    outcome.events = events_of_items(&phase.body, &outcome.events);
    let warnings = outcome.first_impact_s.map(summary::impulses_excluded);
    Stepped {
        outcome,
        contents,
        warnings: warnings.into_iter().collect(),
        peaks: walk.phase.peaks.values,
        history: walk.phase.history,
    }
}

/// All events, those of contents for each item that slides with them.
fn events_of_items(body: &Body, events: &[Event]) -> Vec<Event> {
    let mut all = Vec::with_capacity(events.len());
    for event in events {
        if event.interface == 0 {
            all.push(*event);
            continue;
        }
        let items = body.part_of.iter().enumerate();
        let alike = items.filter(|(_, part)| 1 + **part == event.interface);
        all.extend(alike.map(|(item, _)| Event { interface: 1 + item, ..*event }));
    }
    all
}

/// State, series and peaks of an analysis in physical coordinates.
pub(super) struct Direct<'a> {
    ground: Ground<'a>,
    instructions: InstructionSet,
    ahead: Ahead,
    body: Body,
    x: State,
    /// The modes of all interfaces.
    modes: Vec<Mode>,
    /// The force of the slider in its mode; in stick what springs and stops do.
    force: SlipForce,
    series: Expansion,
    /// Of one instant.
    instant: Expansion,
    unit_s: f64,
    peaks: Peaks,
    history: Option<History>,
    /// Scratch for the state and the outputs of a knot.
    knot: [Vec<[f64; 1]>; 2],
}

/// Size of the first two coefficients.
fn size(p: &Polynomial) -> f64 {
    p[0].abs() + p[1].abs()
}

impl<'a> Direct<'a> {
    fn new(
        model: &Model,
        law: &Law<'_>,
        ground: Ground<'a>,
        instructions: InstructionSet,
        with_history: bool,
    ) -> Self {
        let body = Body::new(model, &system_of(model));
        let initial = model.initial();
        let count = body.contents.len();
        let x = State {
            s: initial.sliding_displacement_m,
            w: initial.sliding_velocity_m_per_s,
            q: model.initial_storey_displacement_m(),
            v: model.initial_storey_velocity_m_per_s(),
            r: vec![0.0; count],
            p: vec![0.0; count],
        };
        let history =
            with_history.then(|| history(&body, law.surface_count(), ground.times_s.len()));
        Self {
            ground,
            instructions,
            ahead: Ahead::default(),
            series: body.scratch(),
            instant: body.scratch(),
            peaks: Peaks::new(model, &body.contents),
            x,
            modes: vec![Mode::Stick; 1 + count],
            force: law.hold(&law.initial(0.0, 0.0), 0.0).force(),
            unit_s: f64::INFINITY,
            history,
            knot: [Vec::new(), Vec::new()],
            body,
        }
    }

    fn expansion(&self, of: Of) -> &Expansion {
        match of {
            Of::Motion => &self.series,
            Of::Instant => &self.instant,
        }
    }

    /// Finds the coefficients of an instant up to an order; of the state one more is asked for than of
    /// forces.
    fn look_at_orders(&mut self, orders: usize, loads: &Loads) {
        let in_force = InForce { modes: &self.modes, force: self.force };
        self.body.expand(&self.x, &in_force, loads, (1.0, orders), &mut self.instant);
    }

    /// Sum of the sizes of the forces in the slider in N.
    fn slider_terms_n(&self, p: &Expansion) -> f64 {
        let springs = self.force.restraint.stiffness_n_per_m * self.x.s;
        size(&p.slider) + size(&p.friction) + springs.abs() + self.force.force_n.abs()
    }
}

impl<'a> Phase<'a> for Direct<'a> {
    fn run_ahead(
        walk: &mut Walk<'a, Self>,
        [sample, end]: [usize; 2],
    ) -> Result<Advance, SolveError> {
        let sample = ahead::run_ahead(walk, [sample, end]);
        Ok(Advance { sample, at_s: 0.0 })
    }

    fn settle(walk: &mut Walk<'a, Self>) {
        walk.phase.settle_candidates(&mut walk.course);
    }

    fn update_branch(&mut self, course: &WalkState<'a>) {
        self.modes.clear();
        self.modes.extend((0..course.interfaces()).map(|i| course.mode(i)));
        self.force = match self.modes[0] {
            Mode::Slip(direction) => course.slider.law.force(&course.slider.memory, direction),
            Mode::Stick => course.hold(self.x.s).force(),
        };
    }

    fn position_and_velocity(&self, interface: usize) -> [f64; 2] {
        match interface.checked_sub(1) {
            None => [self.x.s, self.x.w],
            Some(i) => [self.x.r[i], self.x.p[i]],
        }
    }

    fn records(&self) -> bool {
        self.history.is_some()
    }

    fn record_sample(&mut self, course: &WalkState<'a>, sample: usize, row: bool) {
        let normal = self.ground.normal_at(sample).max(0.0);
        let loads =
            Loads { acceleration: [self.ground.acceleration[sample], 0.0], normal: [normal, 0.0] };
        let knot = [self.ground.times_s[sample], self.ground.table[sample]];
        self.record_knot(course, knot, &loads, row);
    }

    fn record_between(
        &mut self,
        course: &WalkState<'a>,
        knot: [f64; 2],
        (stretch, at_s): (&Stretch, f64),
        row: bool,
    ) {
        self.record_knot(course, knot, &Loads::at(stretch, at_s), row);
    }
}

impl<'a> LinePhase<'a> for Direct<'a> {
    fn set_position_and_velocity(&mut self, interface: usize, place: [f64; 2]) {
        match interface.checked_sub(1) {
            None => [self.x.s, self.x.w] = place,
            Some(i) => [self.x.r[i], self.x.p[i]] = place,
        }
    }

    fn apply_impulse(&mut self, change: f64) {
        self.x.v.iter_mut().for_each(|v| *v += change);
        for (contents, p) in self.body.contents.iter().zip(&mut self.x.p) {
            if contents.floor == 0 {
                *p += change;
            }
        }
    }

    fn state(&self) -> Vec<f64> {
        let mut list = vec![0.0; self.x.count()];
        self.x.get(&mut list);
        list
    }

    fn set_state(&mut self, state: &[f64]) {
        self.x.set(state);
    }

    fn required_friction_n(&mut self, hold: &Hold, [acceleration, normal_n]: [f64; 2]) -> f64 {
        let springs_n = hold.force_n + hold.of_normal * normal_n;
        (self.block_kg() * acceleration + springs_n) - self.body.shear_n(&self.x)
    }

    fn block_kg(&self) -> f64 {
        self.body.joined_kg(0, &self.modes)
    }

    /// Expands the motion from a time of a stretch over as much of it as one series takes.
    fn expand(&mut self, _: &WalkState<'a>, stretch: &Stretch, from_s: f64) -> Segment {
        let loads = Loads::at(stretch, from_s);
        let left_s = stretch.to_s - from_s;
        let in_force = InForce { modes: &self.modes, force: self.force };
        let rate = self.body.rate_rad_per_s;
        let fastest = if rate > 0.0 { 1.0 / rate } else { left_s };
        let [_, part] = fitting(&mut self.unit_s, fastest, left_s, |unit_s| {
            self.body.expand(&self.x, &in_force, &loads, (unit_s, DEGREE), &mut self.series);
            self.series.part
        });
        (self.series.part, self.series.from_s) = (part, from_s);
        let mut segment = self.segment(Of::Motion);
        // The series of a whole stretch ends where the stretch does.
        let is_whole = part == 1.0 && from_s + segment.unit_s >= stretch.to_s * (1.0 - 1e-15);
        if is_whole || segment.to_s > stretch.to_s {
            segment.to_s = stretch.to_s;
        }
        segment
    }

    fn look_at_instant(&mut self, _: &WalkState<'a>, stretch: &Stretch, at_s: f64) {
        self.look_at_orders(0, &Loads::at(stretch, at_s));
        self.instant.from_s = at_s;
    }

    fn segment(&self, of: Of) -> Segment {
        let Expansion { from_s, unit_s, part, .. } = *self.expansion(of);
        Segment { from_s, to_s: from_s + part * unit_s, unit_s, part }
    }

    fn unit_s(&self) -> f64 {
        self.unit_s
    }

    fn set_unit_s(&mut self, unit_s: f64) {
        self.unit_s = unit_s;
    }

    fn displacement(&self) -> &Polynomial {
        &self.series.state.s
    }

    fn velocity(&self, interface: usize) -> &Polynomial {
        interface.checked_sub(1).map_or(&self.series.state.w, |i| &self.series.state.p[i])
    }

    fn acceleration(&self, of: Of, interface: usize) -> Polynomial {
        let series = self.expansion(of);
        let (own, under) = match interface.checked_sub(1) {
            None => (&series.u, &series.ground),
            Some(i) => match self.body.contents[i].floor {
                0 => (&series.carried[i], &series.u),
                floor => (&series.carried[i], &series.floors[floor - 1]),
            },
        };
        core::array::from_fn(|k| own[k] - under[k])
    }

    fn required_friction(&self, of: Of, interface: usize) -> &Polynomial {
        let series = self.expansion(of);
        interface.checked_sub(1).map_or(&series.friction, |i| &series.carried[i])
    }

    fn normal(&self, of: Of, interface: usize) -> [f64; 2] {
        let series = self.expansion(of);
        let [now, change, ..] = if interface == 0 { series.normal } else { series.press };
        [now, change]
    }

    fn hold(&self, course: &WalkState<'a>, interface: usize) -> Hold {
        match interface.checked_sub(1) {
            None => course.hold(self.x.s),
            Some(i) => Hold::of_friction(self.body.contents[i].static_friction),
        }
    }

    fn rounding_m_per_s2(&self, _: &WalkState<'a>, of: Of, interface: usize) -> f64 {
        let (p, y) = (self.expansion(of), &self.peaks.values);
        let floor = if interface == 0 { 0 } else { self.body.contents[interface - 1].floor };
        let mass_kg = self.body.joined_kg(floor, &self.modes);
        let mut terms = size(&p.ground);
        if interface > 0 {
            terms = self.body.contents[interface - 1].static_friction * size(&p.press);
        }
        if floor > 0 {
            let restoring = self.body.restoring_size(&self.x, floor) / mass_kg;
            let largest = y[Output::Acceleration(floor - 1).place(self.body.storeys())];
            terms += restoring.max(largest) + size(&p.floors[floor - 1]);
        } else if self.modes[0] == Mode::Stick && interface > 0 {
            terms += size(&p.ground);
        } else {
            let shear = size(&p.shear).max(y[output::BASE_SHEAR]);
            terms += (self.slider_terms_n(p) + shear) / mass_kg + size(&p.u);
        }
        ROUNDING * terms
    }

    fn peak_velocity(&self, interface: usize) -> f64 {
        self.peaks.values[self.velocity_output(interface)]
    }

    fn move_to(&mut self, part: f64) {
        self.series.state_at(part, &mut self.x);
        if self.modes[0] == Mode::Stick {
            (self.x.s, self.x.w) = (self.series.state.s[0], 0.0);
        }
        for (i, r) in self.series.state.r.iter().enumerate() {
            if self.modes[1 + i] == Mode::Stick {
                (self.x.r[i], self.x.p[i]) = (r[0], 0.0);
            }
        }
    }

    fn look(&mut self, course: &mut WalkState<'a>, _: &Stretch, segment: &Segment) {
        self.look_at_outputs(course, segment.part);
    }
}
