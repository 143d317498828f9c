//! The paper's own program, eqs (5), (6), (15)–(18): what it computed, errors included.
//!
//! Friction by the sliding speed, a pendulum's spring `N/R` and elastic stops are forces at samples like
//! any other, and are taken.

use super::course::Sliding;
use super::ground::{Normal, contact_loss_s, varying_normal};
use super::outputs::{Inertia, Quantities};
use super::recorder::{self, Recorder, Stored};
use super::slider::Stopping;
use super::summary;
use super::summary::Outcome;
use super::tables::system_of;
use crate::error::SolveError;
use crate::linear::System;
use crate::linear::lanes::{dot, greatest};
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::progress::{Cancel, Pulse};
use crate::response::output::Output;
use crate::response::{Event, EventKind, Iterations, Method, Mode, Response};
use crate::slider::{Contact, Direction, Law};

/// Largest change of an acceleration in the last iteration, `δ` of eqs (17), (18), in m/s².
pub(super) const TOLERANCE_M_PER_S2: f64 = 1e-5;

/// Most iterations in a step.
const ITERATIONS_LIMIT: u32 = 200;

/// State at a sample with the accelerations that belong to it.
#[derive(Clone)]
struct Step {
    mode: Mode,
    s: f64,
    w: f64,
    eta: Vec<f64>,
    eta_dot: Vec<f64>,
    /// `u = s̈ + a`, the block's acceleration.
    u: f64,
    /// `f = D η̇ + Ω η`: minus the floors' accelerations.
    f: Vec<f64>,
}

pub(super) fn solve(
    model: &Model,
    motion: &GroundMotion,
    tolerance_m_per_s2: f64,
    go_on: Cancel<'_>,
) -> Result<Response, SolveError> {
    let law = model.law(motion.vertical_m_per_s2().is_some());
    is_taken(model, &law)?;
    recorder::fits(model, motion.len())?;
    let system = system_of(model);
    let program = Program::new(model, motion, (&system, &law), tolerance_m_per_s2);
    let n = system.storeys;
    let mut told = Told::new(&program, model, motion);
    let mut step = program.start(model);
    let mut pulse = Pulse::new(go_on);
    let mut sliding = Sliding::new(step.s);
    let mut stopping = Stopping::default();
    let mut contact = Contact::Free;
    let mut events = Vec::new();
    let (mut total, mut most) = (0_u64, 0);
    if step.mode != Mode::Stick && model.initial().sliding_velocity_m_per_s == 0.0 {
        events.push(event(EventKind::Slip, &step, 0.0));
    }
    let mut touch = |step: &Step, time_s: f64| {
        let (from, to) = (contact, program.contact(step.s, step.w));
        contact = to;
        let peak_n = &mut stopping.demands.peak_force_n;
        *peak_n = greatest(*peak_n, law.stop_force_n(to, step.s, step.w));
        (from != to).then(|| stopping.change(time_s, step.w.abs(), from, to))
    };
    events.extend(touch(&step, 0.0).map(|kind| event(kind, &step, 0.0)));
    told.note(0, &step, step.mode, true);
    for sample in 1..motion.len() {
        let (next, iterations) = program.advance(&step, sample)?;
        pulse.tick(8 * iterations * (1 + n as u32))?;
        total += u64::from(iterations);
        most = most.max(iterations);
        let time_s = program.times_s[sample];
        if step.mode != Mode::Stick || next.mode != Mode::Stick {
            sliding.begin(program.times_s[sample - 1], step.s);
            sliding.end(time_s, next.s);
        }
        if let Some(kind) = change(step.mode, next.mode) {
            told.note(sample, &next, step.mode, false);
            events.push(event(kind, &next, time_s));
        }
        events.extend(touch(&next, time_s).map(|kind| event(kind, &next, time_s)));
        told.note(sample, &next, next.mode, true);
        step = next;
    }
    if contact != Contact::Free {
        stopping.change(motion.times_s()[motion.len() - 1], 0.0, contact, Contact::Free);
    }
    let varying: Option<Vec<f64>> = varying_normal(model, motion).map(Iterator::collect);
    let normal = Normal::new(model, varying.as_deref());
    let contact_loss_s = contact_loss_s(motion.times_s(), normal);
    let warnings = summary::warnings(model, &events, &contact_loss_s);
    let outcome = Outcome {
        events,
        overturns: told.inertia.arms.is_some(),
        sliding,
        stop: law.has_stop().then_some(stopping.demands),
        surfaces: Vec::new(),
        residual_m: step.s,
        sliding_at_end: step.mode != Mode::Stick,
        first_impact_s: None,
    };
    Ok(Response {
        method: Method::Stepwise,
        demands: summary::demands(model, &outcome, |output| told.peaks[output.place(n)]),
        events: outcome.events,
        history: Some(told.recorder.history),
        contact_loss_s,
        iterations: Some(Iterations { mean: total as f64 / (motion.len() - 1) as f64, max: most }),
        warnings,
        in_plane: None,
    })
}

/// What jumps, what remembers, and what slides besides the block is not taken.
fn is_taken(model: &Model, law: &Law<'_>) -> Result<(), SolveError> {
    let contents = (!model.contents().is_empty()).then_some("contents");
    let what = law.beyond_samples().or(contents);
    what.map_or(Ok(()), |what| Err(SolveError::NotTaken { method: "stepwise method", what }))
}

/// The event that a change of mode is.
fn change(before: Mode, after: Mode) -> Option<EventKind> {
    match (before, after) {
        (Mode::Stick, Mode::Slip(_)) => Some(EventKind::Slip),
        (Mode::Slip(_), Mode::Stick) => Some(EventKind::Stick),
        (Mode::Slip(before), Mode::Slip(after)) if before != after => Some(EventKind::Reversal),
        _ => None,
    }
}

/// Peaks and history so far.
struct Told<'a> {
    program: &'a Program<'a>,
    table: &'a [f64],
    slope: f64,
    inertia: Inertia,
    peaks: Vec<f64>,
    recorder: Recorder,
}

impl<'a> Told<'a> {
    fn new(program: &'a Program<'a>, model: &Model, motion: &'a GroundMotion) -> Self {
        let (system, slope) = (program.system, model.slope_m_per_s2());
        Self {
            program,
            table: motion.horizontal_m_per_s2(),
            slope,
            inertia: Inertia::new(model, &[]),
            peaks: vec![0.0; Output::count(system.storeys, 0)],
            recorder: Recorder::new(system, program.law, motion.len(), slope),
        }
    }

    /// Takes a step at a sample in a mode, perhaps as a row of the history.
    fn note(&mut self, sample: usize, step: &Step, mode: Mode, row: bool) {
        let (program, slope) = (self.program, self.slope);
        let at = AtSample { program, step, sample };
        for (peak, output) in self.peaks.iter_mut().zip(Output::all(program.system.storeys, 0)) {
            *peak = greatest(*peak, f64::abs(output.of(&at, &self.inertia, slope)));
        }
        let state = step.state();
        let stored = Stored {
            time_s: program.times_s[sample],
            mode,
            contact: program.contact(step.s, step.w),
            table: self.table[sample],
            state: &state,
            block: step.u - slope,
            friction_n: at.friction_n(),
            f: &step.f,
        };
        self.recorder.store(program.system, &stored, row);
    }
}

fn event(kind: EventKind, step: &Step, time_s: f64) -> Event {
    Event { time_s, kind, mode: step.mode, sliding_displacement_m: step.s, interface: 0 }
}

impl Step {
    fn state(&self) -> Vec<f64> {
        let mut x = vec![self.s, self.w];
        x.extend_from_slice(&self.eta);
        x.extend_from_slice(&self.eta_dot);
        x
    }
}

/// The motion at a sample.
struct AtSample<'a> {
    program: &'a Program<'a>,
    step: &'a Step,
    sample: usize,
}

impl Quantities for AtSample<'_> {
    type Value = f64;

    fn zero(&self) -> f64 {
        0.0
    }

    fn velocity(&self) -> f64 {
        self.step.w
    }

    fn block(&self) -> f64 {
        self.step.u
    }

    fn slider_n(&self) -> f64 {
        let Step { s, w, .. } = *self.step;
        self.friction_n() - self.program.restoring_n(s, w, self.sample)
    }

    fn friction_n(&self) -> f64 {
        self.program.friction_n(self.step, self.sample)
    }

    fn base_shear_n(&self) -> f64 {
        dot(&self.program.system.participation, &self.step.f)
    }

    fn displacement(&self, storey: usize) -> f64 {
        dot(self.program.system.floor(storey), &self.step.eta)
    }

    fn drift(&self, storey: usize) -> f64 {
        dot(self.program.system.drift(storey), &self.step.eta)
    }

    fn drift_velocity(&self, storey: usize) -> f64 {
        dot(self.program.system.drift(storey), &self.step.eta_dot)
    }

    fn acceleration(&self, storey: usize) -> f64 {
        -dot(self.program.system.floor(storey), &self.step.f)
    }

    /// Contents are not taken.
    fn contents(&self, _: usize) -> [f64; 2] {
        [0.0; 2]
    }
}

struct Program<'a> {
    system: &'a System,
    law: &'a Law<'a>,
    times_s: &'a [f64],
    /// `a = Ü + g sin θ` at the samples.
    acceleration: Vec<f64>,
    /// `N ≥ 0` at the samples.
    normal_n: Vec<f64>,
    /// `δ` of eqs (17), (18).
    tolerance_m_per_s2: f64,
}

impl<'a> Program<'a> {
    fn new(
        model: &Model,
        motion: &'a GroundMotion,
        (system, law): (&'a System, &'a Law<'a>),
        tolerance_m_per_s2: f64,
    ) -> Self {
        let (mass_kg, gravity) = (model.total_mass_kg(), model.normal_gravity_m_per_s2());
        let normal_n = |sample: usize| {
            let vertical = motion.vertical_m_per_s2().map_or(0.0, |a| a[sample]);
            greatest(0.0, mass_kg * (gravity + vertical))
        };
        let (table, slope) = (motion.horizontal_m_per_s2(), model.slope_m_per_s2());
        Self {
            system,
            law,
            times_s: motion.times_s(),
            acceleration: table.iter().map(|a| a + slope).collect(),
            normal_n: (0..motion.len()).map(normal_n).collect(),
            tolerance_m_per_s2,
        }
    }
}

impl Program<'_> {
    fn start(&self, model: &Model) -> Step {
        let masses_kg = &model.frame().masses_kg;
        let eta = self.system.coordinates(masses_kg, &model.initial_storey_displacement_m());
        let eta_dot = self.system.coordinates(masses_kg, &model.initial_storey_velocity_m_per_s());
        let mut f = vec![0.0; eta.len()];
        self.system.restoring(&eta, &eta_dot, &mut f);
        let w = model.initial().sliding_velocity_m_per_s;
        let s = model.initial().sliding_displacement_m;
        let mut step = Step { mode: Mode::Stick, s, w, eta, eta_dot, u: 0.0, f };
        step.mode = if w > 0.0 {
            Mode::Slip(Direction::Positive)
        } else if w < 0.0 {
            Mode::Slip(Direction::Negative)
        } else {
            self.held_or_not(&step, 0)
        };
        step.u = self.block_acceleration(&step, 0);
        step
    }

    /// One step of eqs (15), (16), iterated until (17), (18) hold; the step and its iterations.
    fn advance(&self, last: &Step, sample: usize) -> Result<(Step, u32), SolveError> {
        let (times_s, a) = (self.times_s, &self.acceleration);
        let (a0, a1) = (a[sample - 1], a[sample]);
        let half_s = 0.5 * (times_s[sample] - times_s[sample - 1]);
        let l = &self.system.participation;
        let mut next = last.clone();
        for iteration in 1..=ITERATIONS_LIMIT {
            let (u, f) = (next.u, next.f.clone());
            next.w = match next.mode {
                Mode::Stick => 0.0,
                Mode::Slip(_) => last.w + ((last.u - a0) + (u - a1)) * half_s,
            };
            next.s = last.s + (last.w + next.w) * half_s;
            let block = if next.mode == Mode::Stick { a1 } else { u };
            for j in 0..f.len() {
                let acceleration = -(last.f[j] + l[j] * last.u) - (f[j] + l[j] * block);
                next.eta_dot[j] = last.eta_dot[j] + acceleration * half_s;
                next.eta[j] = last.eta[j] + (last.eta_dot[j] + next.eta_dot[j]) * half_s;
            }
            self.system.restoring(&next.eta, &next.eta_dot, &mut next.f);
            self.test_stick(last, &mut next, sample);
            next.u = self.block_acceleration(&next, sample);
            let change = self.largest_change(u, &f, &next);
            if change <= self.tolerance_m_per_s2 && iteration > 1 {
                self.settle(last, &mut next, [a0, a1], half_s);
                return Ok((next, iteration));
            }
        }
        Err(SolveError::NoConvergence {
            time_s: times_s[sample],
            iterations: ITERATIONS_LIMIT,
            omega_dt: self.system.slip_rate_rad_per_s * 2.0 * half_s,
        })
    }

    /// Stick is left when the demand passes its bound, eq. (8), and tested for when the sign of the
    /// sliding velocity differs from the last step's, eqs (3), (4), (14).
    fn test_stick(&self, last: &Step, next: &mut Step, sample: usize) {
        let turned = match (last.mode, next.mode) {
            (_, Mode::Stick) => true,
            (Mode::Slip(direction), Mode::Slip(_)) => direction.sign() * next.w < 0.0,
            (Mode::Stick, Mode::Slip(_)) => false,
        };
        if turned {
            next.mode = self.held_or_not(next, sample);
        }
    }

    fn held_or_not(&self, step: &Step, sample: usize) -> Mode {
        let hold = self.law.hold(&self.law.initial(step.s, 0.0), step.s);
        hold.gives_way(self.required_friction_n(step, sample), self.normal_n[sample])
            .map_or(Mode::Stick, Mode::Slip)
    }

    /// Where the block stands to an elastic stop.
    fn contact(&self, s: f64, w: f64) -> Contact {
        self.law.initial(s, w).contact
    }

    /// Force of spring, damper, pendulum and elastic stop against the block.
    fn restoring_n(&self, s: f64, w: f64, sample: usize) -> f64 {
        self.law.restoring_n(self.contact(s, w), [s, w], self.normal_n[sample])
    }

    fn required_friction_n(&self, step: &Step, sample: usize) -> f64 {
        self.system.block_mass_kg * self.acceleration[sample]
            + self.restoring_n(step.s, 0.0, sample)
            - dot(&self.system.participation, &step.f)
    }

    fn friction_n(&self, step: &Step, sample: usize) -> f64 {
        let Mode::Slip(direction) = step.mode else {
            return self.required_friction_n(step, sample);
        };
        -direction.sign() * self.law.kinetic_n(direction, step.w.abs(), self.normal_n[sample])
    }

    /// Eq. (11), or the table's acceleration in stick.
    fn block_acceleration(&self, step: &Step, sample: usize) -> f64 {
        match step.mode {
            Mode::Stick => self.acceleration[sample],
            Mode::Slip(_) => {
                (self.friction_n(step, sample) - self.restoring_n(step.s, step.w, sample)
                    + dot(&self.system.participation, &step.f))
                    / self.system.block_mass_kg
            }
        }
    }

    /// Largest change of the block's and the floors' accelerations; NaN counts as infinite.
    fn largest_change(&self, u: f64, f: &[f64], next: &Step) -> f64 {
        let difference: Vec<f64> = next.f.iter().zip(f).map(|(new, old)| new - old).collect();
        let mut floors = vec![0.0; self.system.storeys];
        self.system.floors(&difference, &mut floors);
        floors.into_iter().chain([next.u - u]).fold(0.0, |largest: f64, change| {
            if change.abs() <= largest {
                largest
            } else if change.is_nan() {
                f64::INFINITY
            } else {
                change.abs()
            }
        })
    }

    /// Velocities and displacements of the accelerations that the iteration has settled on.
    fn settle(&self, last: &Step, next: &mut Step, [a0, a1]: [f64; 2], half_s: f64) {
        let l = &self.system.participation;
        next.w = match next.mode {
            Mode::Stick => 0.0,
            Mode::Slip(_) => last.w + ((last.u - a0) + (next.u - a1)) * half_s,
        };
        next.s = last.s + (last.w + next.w) * half_s;
        for j in 0..next.f.len() {
            let acceleration = -(last.f[j] + l[j] * last.u) - (next.f[j] + l[j] * next.u);
            next.eta_dot[j] = last.eta_dot[j] + acceleration * half_s;
            next.eta[j] = last.eta[j] + (last.eta_dot[j] + next.eta_dot[j]) * half_s;
        }
    }
}
