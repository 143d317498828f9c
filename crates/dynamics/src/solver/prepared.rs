//! What serves many analyses at once: a motion prepared for all models, a model for all motions.

use core::mem::take;
use std::sync::Arc;

use super::course::{Sliding, WalkState};
use super::ground::{Ground, GroundAlongY, Normal, Sampling, contact_loss_s, varying_normal};
use super::modal::{Buffers, Modal};
use super::phase::Phase;
use super::recorder::{self, Recorder};
use super::slider::SliderState;
use super::summary::Outcome;
use super::tables::{self, Tables};
use super::walk::Walk;
use super::{direct, plane, summary};
use crate::error::SolveError;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::numerics::InstructionSet;
use crate::numerics::fractile::upper_median;
use crate::numerics::instructions::vectorize;
use crate::progress::{Cancel, NEVER_CANCELLED, Pulse};
use crate::response::{History, Method, PointFactors, Response, StopDemands};
use crate::slider::Law;

/// Most work of an analysis: radians that the fastest mode turns, times the square of the number of
/// masses. That is some minutes; at ten times as many radians of one mode its phase is lost to rounding.
const WORK_LIMIT: f64 = 3e8;

/// Most factors of e by which friction fades with the speed: each takes a series, and all some twenty
/// seconds.
const FADING_LIMIT: f64 = 1e5;

/// Radians of the fastest mode in a usual step of the motion beyond which it is no mode but a rigid link.
const RIGID_RADIANS: f64 = 100.0;

/// A ground motion with what the solver needs to know of it, for any number of models. Copies share
/// both.
#[derive(Clone, Debug)]
pub struct PreparedMotion {
    motion: Arc<GroundMotion>,
    sampling: Arc<Sampling>,
}

impl PreparedMotion {
    /// Looks through the motion once.
    #[must_use]
    pub fn new(motion: impl Into<Arc<GroundMotion>>) -> Self {
        let motion = motion.into();
        let sampling = Arc::new(Sampling::new(&motion));
        Self { motion, sampling }
    }

    /// The motion itself.
    #[must_use]
    pub fn motion(&self) -> &GroundMotion {
        &self.motion
    }

    /// The step that all but a few intervals have, in s; none where the sampling is uneven.
    #[must_use]
    pub fn dt_s(&self) -> Option<f64> {
        self.sampling.dt_s
    }
}

impl From<GroundMotion> for PreparedMotion {
    fn from(motion: GroundMotion) -> Self {
        Self::new(motion)
    }
}

/// A model with its modes, series and maps for one time step. Copies share them.
///
/// They depend neither on friction nor on the motion's values: one prepared model serves all levels
/// of a record, and [`Prepared::with_model`] all coefficients of friction.
///
/// With one storey or none, a plain law, a constant normal force and even steps, the solver *runs ahead* of
/// the way that serves all models, as far as nothing is in doubt.
#[derive(Clone, Debug)]
pub struct Prepared {
    model: Arc<Model>,
    dt_s: Option<f64>,
    tables: Arc<Tables>,
}

impl Prepared {
    /// Prepares a model for motions of one step in s, or of none.
    #[must_use]
    pub fn new(model: impl Into<Arc<Model>>, dt_s: Option<f64>) -> Self {
        let model = model.into();
        let tables = Arc::new(tables_of(&model, dt_s));
        Self { model, dt_s, tables }
    }

    /// Another model for the same step, with the tables of this one where both have one
    /// [system](Model::has_system_of).
    #[must_use]
    pub fn with_model(&self, model: impl Into<Arc<Model>>) -> Self {
        let model = model.into();
        if self.model.has_system_of(&model) {
            Self { model, ..self.clone() }
        } else {
            Self::new(model, self.dt_s)
        }
    }

    /// The response without [running ahead](Prepared): every event by event stepping, for comparison.
    #[must_use]
    pub fn without_running_ahead(self) -> Self {
        let mut tables = tables_of(&self.model, self.dt_s);
        tables.dense = None;
        Self { tables: Arc::new(tables), ..self }
    }

    /// The model itself.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The step in s that it was prepared for, if any.
    #[must_use]
    pub fn dt_s(&self) -> Option<f64> {
        self.dt_s
    }

    /// Exact response without a history: peaks, counts and events, bit for bit those of
    /// [`exact`](super::exact) and of [`exact_demands`](super::exact_demands).
    ///
    /// A motion whose step is not the one the model was prepared for costs a new preparation.
    ///
    /// # Errors
    /// [`SolveError`] with time and cause.
    pub fn demands(&self, motion: &PreparedMotion) -> Result<Response, SolveError> {
        self.demands_in(&mut Workspace::default(), motion)
    }

    /// [`Prepared::demands`] in a workspace that analyses before it have left.
    ///
    /// # Errors
    /// [`SolveError`] with time and cause.
    pub fn demands_in(
        &self,
        workspace: &mut Workspace,
        motion: &PreparedMotion,
    ) -> Result<Response, SolveError> {
        self.demands_while(workspace, motion, NEVER_CANCELLED)
    }

    /// The demands, as long as `go_on` says so, which is asked every few milliseconds.
    ///
    /// # Errors
    /// [`SolveError::Stopped`] where it says no, and as [`Prepared::demands`].
    pub fn demands_while(
        &self,
        workspace: &mut Workspace,
        motion: &PreparedMotion,
        go_on: Cancel<'_>,
    ) -> Result<Response, SolveError> {
        self.solve(InstructionSet::best(), motion, (false, go_on), workspace)
    }

    /// [`Prepared::demands`] by a given instruction set: the bits are the same by all.
    ///
    /// # Errors
    /// [`SolveError`] with time and cause.
    pub fn demands_by(
        &self,
        instructions: InstructionSet,
        motion: &PreparedMotion,
    ) -> Result<Response, SolveError> {
        self.solve(instructions, motion, (false, NEVER_CANCELLED), &mut Workspace::default())
    }

    /// Exact response with its history.
    ///
    /// # Errors
    /// [`SolveError`] with time and cause.
    pub fn response(&self, motion: &PreparedMotion) -> Result<Response, SolveError> {
        self.response_by(InstructionSet::best(), motion)
    }

    /// The response by a given instruction set.
    ///
    /// # Errors
    /// [`SolveError`] with time and cause.
    pub fn response_by(
        &self,
        instructions: InstructionSet,
        motion: &PreparedMotion,
    ) -> Result<Response, SolveError> {
        self.solve(instructions, motion, (true, NEVER_CANCELLED), &mut Workspace::default())
    }

    fn solve(
        &self,
        instructions: InstructionSet,
        motion: &PreparedMotion,
        how: (bool, Cancel<'_>),
        workspace: &mut Workspace,
    ) -> Result<Response, SolveError> {
        let own;
        let tables = if self.dt_s == motion.dt_s() {
            &self.tables
        } else {
            own = tables_of(&self.model, motion.dt_s());
            &own
        };
        let ground = (motion.motion(), &*motion.sampling);
        solve(instructions, &self.model, tables, ground, how, workspace)
    }
}

/// Response of a model to a motion, neither prepared.
pub(super) fn solve_once(
    model: &Model,
    motion: &GroundMotion,
    with_history: bool,
    go_on: Cancel<'_>,
) -> Result<Response, SolveError> {
    let sampling = Sampling::new(motion);
    let tables = tables_of(model, sampling.dt_s);
    let (ground, workspace) = ((motion, &sampling), &mut Workspace::default());
    solve(InstructionSet::best(), model, &tables, ground, (with_history, go_on), workspace)
}

fn tables_of(model: &Model, dt_s: Option<f64>) -> Tables {
    vectorize!(InstructionSet::best(), simd => Tables::new(simd, model, dt_s))
}

fn solve(
    instructions: InstructionSet,
    model: &Model,
    tables: &Tables,
    (motion, sampling): (&GroundMotion, &Sampling),
    how: (bool, Cancel<'_>),
    workspace: &mut Workspace,
) -> Result<Response, SolveError> {
    match motion.horizontal_y_m_per_s2() {
        None => solve_along_x(instructions, model, tables, (motion, sampling), how, workspace),
        Some(y) => solve_in_plane(instructions, model, tables, (motion, sampling, y), how),
    }
}

/// Solves a motion in two horizontal directions: by the solver in one where all of it is along one line.
fn solve_in_plane(
    instructions: InstructionSet,
    model: &Model,
    tables: &Tables,
    (motion, sampling, y): (&GroundMotion, &Sampling, &[f64]),
    (with_history, go_on): (bool, Cancel<'_>),
) -> Result<Response, SolveError> {
    let system = tables.in_plane(model)?;
    let varying: Option<Vec<f64>> = varying_normal(model, motion).map(Iterator::collect);
    let normal = Normal::new(model, varying.as_deref());
    let slope = model.slope_in_plane_m_per_s2();
    let sloped = [0, 1].map(|axis| {
        let table = [motion.horizontal_m_per_s2(), y][axis];
        let add = |pull: f64| table.iter().map(|a| a + pull).collect::<Vec<f64>>();
        (slope[axis] != 0.0).then(|| add(slope[axis]))
    });
    let [of_x, of_y] = sloped.each_ref().map(Option::as_deref);
    let table = motion.horizontal_m_per_s2();
    let acceleration = of_x.unwrap_or(table);
    let ground = Ground { times_s: motion.times_s(), table, acceleration, normal, sampling };
    let along_y = GroundAlongY { table: y, acceleration: of_y.unwrap_or(y) };
    if let Some((direction, line)) = plane::on_line(model, motion) {
        let along = motion.along(direction);
        let tables = tables_of(&line, sampling.dt_s);
        let workspace = &mut Workspace::default();
        let how = (true, go_on);
        let response =
            solve_along_x(instructions, &line, &tables, (&along, sampling), how, workspace)?;
        let line = &line;
        let on_line =
            plane::OnLine { direction, model, line, system, ground, along_y, instructions };
        return Ok(on_line.turned(response, with_history));
    }
    let masses = 1.0 + model.degrees_in_plane() as f64;
    let (rate, limit) = (system.rate_rad_per_s, WORK_LIMIT);
    let work = rate * motion.duration_s() * masses * masses;
    if !(work <= limit) {
        return Err(SolveError::TooMuchWork { work, limit, advice: advice(model, motion, rate) });
    }
    recorder::fits(model, 2 * motion.len())?;
    let how = (with_history, Pulse::new(go_on));
    plane::solve((model, system), (ground, along_y), instructions, how)
}

/// Refuses what is not solved along x, and what would take too long or too much room.
fn refuse(model: &Model, tables: &Tables, motion: &GroundMotion) -> Result<(), SolveError> {
    if model.structure().is_some_and(|structure| structure.modes.is_empty()) {
        let what = "a structure whose modes all move along y";
        return Err(SolveError::NotTaken { method: "one horizontal direction", what });
    }
    let rate = tables.rate_rad_per_s();
    let masses = (1 + model.storeys()) as f64;
    let (work, limit) = (rate * motion.duration_s() * masses * masses, WORK_LIMIT);
    if !(work <= limit) {
        return Err(SolveError::TooMuchWork { work, limit, advice: advice(model, motion, rate) });
    }
    if let Some(rate_s_per_m) = model.law(false).fading_rate_s_per_m() {
        let (work, limit) = (rate_s_per_m * absolute_velocity(motion), FADING_LIMIT);
        if !(work <= limit) {
            let advice = "friction changes within a hair of rest; take one coefficient, or check \
                          the rate"
                .to_owned();
            return Err(SolveError::TooMuchWork { work, limit, advice });
        }
    }
    recorder::fits(model, motion.len())
}

fn solve_along_x(
    instructions: InstructionSet,
    model: &Model,
    tables: &Tables,
    (motion, sampling): (&GroundMotion, &Sampling),
    (with_history, go_on): (bool, Cancel<'_>),
    workspace: &mut Workspace,
) -> Result<Response, SolveError> {
    refuse(model, tables, motion)?;
    let slope = tables.slope;
    let [mut sloped, mut varying] =
        [&mut workspace.acceleration, &mut workspace.normal_n].map(take);
    let acceleration = if slope == 0.0 {
        motion.horizontal_m_per_s2()
    } else {
        sloped.clear();
        sloped.extend(motion.horizontal_m_per_s2().iter().map(|a| a + slope));
        &sloped
    };
    varying.clear();
    let varies = varying_normal(model, motion).map(|normal_n| varying.extend(normal_n)).is_some();
    let normal = Normal::new(model, varies.then_some(&*varying));
    let ground = Ground {
        times_s: motion.times_s(),
        table: motion.horizontal_m_per_s2(),
        acceleration,
        normal,
        sampling,
    };
    let law = model.law(varies);
    if !tables::serve(model, &law, varies) {
        return stepped(model, &law, (motion, ground), instructions, (with_history, go_on));
    }
    // Away from rigid stops they change nothing.
    let away = law.under(model.normal_n()).without_walls();
    let recorder =
        with_history.then(|| Recorder::new(&tables.stick.system, &away, motion.len(), slope));
    let of = Analysis {
        model,
        tables,
        law: &away,
        ground,
        recorder,
        pulse: Pulse::new(go_on),
        buffers: &mut workspace.buffers,
    };
    let solved = of.solve(instructions);
    let (mut outcome, recorder) = match solved {
        // What would happen beyond a rigid stop says nothing.
        Err(error) if law.walls_m().is_some() && !matches!(error, SolveError::Stopped(_)) => {
            return stepped(model, &law, (motion, ground), instructions, (with_history, go_on));
        }
        solved => solved?,
    };
    if let Some([positive, negative]) = law.walls_m() {
        let within = |gap_m: Option<f64>, s: f64| gap_m.is_none_or(|gap_m| s < gap_m);
        let Sliding { max_m, min_m, .. } = outcome.sliding;
        if !(within(positive, max_m) && within(negative, -min_m)) {
            return stepped(model, &law, (motion, ground), instructions, (with_history, go_on));
        }
        outcome.stop = Some(StopDemands::default());
    }
    let contact_loss_s = contact_loss_s(motion.times_s(), normal);
    let warnings = summary::warnings(model, &outcome.events, &contact_loss_s);
    let demands = summary::demands(model, &outcome, |output| {
        workspace.buffers.peaks.attained(output.place(model.points()))
    });
    [workspace.acceleration, workspace.normal_n] = [sloped, varying];
    Ok(Response {
        method: Method::Exact,
        demands,
        events: outcome.events,
        history: recorder.map(|recorder| with_points(recorder.history, model)),
        contact_loss_s,
        iterations: None,
        warnings,
        in_plane: None,
    })
}

/// Response of a model with devices.
fn stepped(
    model: &Model,
    law: &Law<'_>,
    (motion, ground): (&GroundMotion, Ground<'_>),
    instructions: InstructionSet,
    (with_history, go_on): (bool, Cancel<'_>),
) -> Result<Response, SolveError> {
    let contact_loss_s = contact_loss_s(motion.times_s(), ground.normal);
    let stepped = direct::solve(model, law, ground, instructions, (with_history, go_on))?;
    let mut warnings = summary::warnings(model, &stepped.outcome.events, &contact_loss_s);
    warnings.extend(stepped.warnings);
    let mut demands = summary::demands(model, &stepped.outcome, |output| {
        stepped.peaks[output.place(model.points())]
    });
    demands.contents = stepped.contents;
    Ok(Response {
        method: Method::Exact,
        demands,
        events: stepped.outcome.events,
        history: stepped.history.map(|history| with_points(history, model)),
        contact_loss_s,
        iterations: None,
        warnings,
        in_plane: None,
    })
}

/// A history with the factors by which the points of a structure by its modes follow from it.
fn with_points(history: History, model: &Model) -> History {
    History { points: PointFactors::of(model), ..history }
}

/// `∫|Ü| dt` by the trapezoidal rule, in m/s.
fn absolute_velocity(motion: &GroundMotion) -> f64 {
    let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
    let intervals = times_s.windows(2).zip(a.windows(2));
    intervals.map(|(t, a)| 0.5 * (a[0].abs() + a[1].abs()) * (t[1] - t[0])).sum()
}

/// What makes an analysis long, and what to do: a link that is rigid beside the motion's steps, a gap
/// in the motion, or the length of both.
fn advice(model: &Model, motion: &GroundMotion, rate: f64) -> String {
    let steps = || motion.times_s().windows(2).map(|t| t[1] - t[0]).filter(|&h| h > 0.0);
    let usual_s = upper_median(steps()).unwrap_or(0.0);
    let longest_s = steps().fold(0.0, f64::max);
    let duration_s = motion.duration_s();
    if rate * usual_s <= RIGID_RADIANS {
        return if longest_s > 0.5 * duration_s && longest_s > 10.0 * usual_s {
            format!("the motion has a gap of {longest_s} s; cut it there")
        } else {
            format!("shorten the motion of {duration_s} s, or join storeys")
        };
    }
    let frame = model.frame();
    let own = |i: usize| (frame.stiffnesses_n_per_m[i] / frame.masses_kg[i]).sqrt();
    let stiffest = (0..model.storeys()).max_by(|&i, &j| own(i).total_cmp(&own(j)));
    match stiffest {
        Some(storey) if 4.0 * own(storey) > rate => format!(
            "storey {} is a rigid link; leave it out and add its mass to the one below",
            storey + 1
        ),
        _ if model.slider_stiffness_n_per_m() > 0.25 * rate * rate * model.block().mass_kg => {
            "the slider's spring is a rigid link; check its stiffness".to_owned()
        }
        _ => "a damper or a stop acts within a millionth of a step; check damping and stiffnesses"
            .to_owned(),
    }
}

/// Room for analyses, one after another, of any models: with it a run of friction without memory
/// allocates nothing but its answer. It remembers the tables that were made last.
#[derive(Debug, Default)]
pub struct Workspace {
    /// `a` at the samples, where the slope adds to it.
    acceleration: Vec<f64>,
    /// `N` at the samples, where it varies.
    normal_n: Vec<f64>,
    buffers: Buffers,
    last: Option<Prepared>,
}

impl Workspace {
    /// Prepares a model for motions of one step in s, or of none: with the tables that were made last in
    /// this room where they serve.
    pub fn prepare(&mut self, model: &Model, dt_s: Option<f64>) -> Prepared {
        let prepared = match self.last.take().filter(|last| last.dt_s() == dt_s) {
            Some(last) => last.with_model(model.clone()),
            None => Prepared::new(model.clone(), dt_s),
        };
        self.last = Some(prepared.clone());
        prepared
    }
}

struct Analysis<'a> {
    model: &'a Model,
    tables: &'a Tables,
    law: &'a Law<'a>,
    ground: Ground<'a>,
    recorder: Option<Recorder>,
    pulse: Pulse<'a>,
    buffers: &'a mut Buffers,
}

impl Analysis<'_> {
    fn solve(
        self,
        instructions: InstructionSet,
    ) -> Result<(Outcome, Option<Recorder>), SolveError> {
        let Analysis { model, tables, law, ground, recorder, pulse, buffers } = self;
        let lists = (take(&mut buffers.released), take(&mut buffers.events));
        // A rigid block has one mode that does nothing.
        let modes = model.storeys().max(1);
        let phase = Modal::new((instructions, modes), (tables, law), ground, recorder, buffers);
        let place = phase.position_and_velocity(0);
        let course = WalkState::new(SliderState::new(law, place[0], place[1]), place, lists);
        let before = [model.slope_m_per_s2(), model.normal_n()];
        let units = 32 * (1 + modes as u32);
        let mut walk = Walk::new((phase, course), (ground, before), (pulse, units));
        walk.go()?;
        let outcome = walk.outcome(tables.overturns());
        let Walk { phase, course, .. } = walk;
        (buffers.released, buffers.events) = (course.released, course.events);
        Ok((outcome, phase.leave(buffers)))
    }
}
