//! The exact method: linear phases by their Taylor series, events by certified root search.
//!
//! Every sample interval is walked in segments short enough for one series. Ordinary samples take
//! a shorter way: the propagator gives the state at the sample's end, and the error bound of a
//! chord shows that nothing can have happened between.

mod by_blocks;
mod long_way;
mod short_way;

use std::sync::Arc;

use fearless_simd::Level;

use super::blocks::{Blocks, Tables, Windows};
use super::excitation::Excitation;
use super::extremes::Extremes;
use super::recorder::{Everything, Nothing, Recorder};
use super::summary;
use crate::error::SolveError;
use crate::friction::Direction;
use crate::linear::{PerStorey, Propagator, Series, State, StoreyDamping, System};
use crate::model::{Damping, Model};
use crate::motion::GroundMotion;
use crate::response::{Event, Method, Mode, Response};

/// Most events in one sample interval before an analysis is given up.
pub const EVENTS_PER_INTERVAL_LIMIT: u32 = 1_000_000;

/// Most radians that the fastest mode may turn: beyond, its phase is lost to rounding.
const RADIANS_LIMIT: f64 = 1e9;

/// Largest rate times step at which the short way is tried: its bounds are hopeless beyond.
const SHORT_WAY_RATE_STEP: f64 = 30.0;

/// By which way ordinary samples go.
#[derive(Clone, Copy)]
pub(super) enum Way<'a> {
    /// One by one.
    Plain,
    /// By blocks where the model and the motion allow it.
    Blocks {
        windows: &'a Windows,
        /// For the step of the motion, where they are at hand.
        tables: Option<&'a Tables>,
        level: Level,
    },
}

pub(super) fn solve(
    model: &Model,
    motion: &GroundMotion,
    with_history: bool,
    way: Way<'_>,
) -> Result<Response, SolveError> {
    match model.storeys() {
        0 => solve_for::<[f64; 0]>(model, motion, with_history, way),
        1 => solve_for::<[f64; 1]>(model, motion, with_history, way),
        _ => solve_for::<Vec<f64>>(model, motion, with_history, way),
    }
}

/// Tables for the blocks of a model, unless it must go the plain way.
pub(super) fn tables(model: &Model, dt_s: f64) -> Option<Arc<Tables>> {
    fn of<V: PerStorey>(model: &Model, dt_s: f64) -> Option<Arc<Tables>> {
        let system = system_of::<V>(model);
        Tables::new(&system, &Extremes::new(model, &system), dt_s)
    }
    match model.storeys() {
        0 => of::<[f64; 0]>(model, dt_s),
        1 => of::<[f64; 1]>(model, dt_s),
        _ => None,
    }
}

fn solve_for<V: PerStorey>(
    model: &Model,
    motion: &GroundMotion,
    with_history: bool,
    way: Way<'_>,
) -> Result<Response, SolveError> {
    let system = system_of::<V>(model);
    let excitation = Excitation::new(model, motion);
    let radians = system.slip_rate_rad_per_s * motion.duration_s();
    if !(radians <= RADIANS_LIMIT) {
        let duration_s = motion.duration_s();
        return Err(SolveError::TooStiff { radians, duration_s, limit: RADIANS_LIMIT });
    }
    let steady = excitation.varying_normal().is_none();
    let dt_s = excitation.dt_s;
    let own = match way {
        Way::Blocks { tables: None, .. } if steady => dt_s.and_then(|dt_s| tables(model, dt_s)),
        _ => None,
    };
    let blocks = match way {
        Way::Blocks { windows, tables, level } if steady => {
            tables.or(own.as_deref()).map(|tables| Blocks { tables, windows, level })
        }
        _ => None,
    };
    let short_way = dt_s.filter(|dt_s| {
        blocks.is_none() && dt_s * system.slip_rate_rad_per_s <= SHORT_WAY_RATE_STEP
    });
    let propagators =
        short_way.map(|dt_s| [false, true].map(|slip| Propagator::new(&system, slip, dt_s)));
    let (ways, table) = ((propagators.as_ref(), blocks), motion.horizontal_m_per_s2());
    let (run, history) = if with_history {
        let recorder = Everything::new(model.storeys(), motion.len(), model.slope_m_per_s2());
        let mut run = Run::new(model, &system, ways, &excitation, table, recorder);
        run.walk()?;
        let history = core::mem::take(&mut run.recorder.history);
        (run.outcome(), Some(history))
    } else {
        let mut run = Run::new(model, &system, ways, &excitation, table, Nothing);
        run.walk()?;
        (run.outcome(), None)
    };
    let contact_loss_s = excitation.contact_loss_s();
    let warnings = summary::warnings(model, &run.events, &contact_loss_s);
    Ok(Response {
        method: Method::Exact,
        demands: summary::demands(model, &run),
        events: run.events,
        history,
        contact_loss_s,
        iterations: None,
        warnings,
    })
}

/// The linear system of a model.
pub(super) fn system_of<V: PerStorey>(model: &Model) -> System<V> {
    let frame = model.frame();
    let damping = match &frame.damping {
        Damping::Ratio(ratio) => StoreyDamping::Ratio(*ratio),
        Damping::Dampers(dampers) => StoreyDamping::Dampers(dampers),
    };
    System::new(
        model.block().mass_kg,
        model.slider().stiffness_n_per_m,
        model.slider().damper_n_s_per_m,
        &frame.masses_kg,
        &frame.stiffnesses_n_per_m,
        damping,
    )
}

/// What a walk through the motion leaves behind.
pub(super) struct Outcome {
    pub(super) events: Vec<Event>,
    /// Peaks in the order of [`super::extremes::tracked`].
    pub(super) peaks: Vec<f64>,
    pub(super) overturns: bool,
    pub(super) sliding: Sliding,
    pub(super) residual_m: f64,
    pub(super) sliding_at_end: bool,
}

/// Extremes, path and duration of sliding; `s` is monotone between two events.
#[derive(Clone, Copy)]
pub(super) struct Sliding {
    pub(super) max_m: f64,
    pub(super) min_m: f64,
    pub(super) peak_time_s: f64,
    pub(super) path_m: f64,
    pub(super) time_s: f64,
    /// Least margin of the decisions at stops so far; infinite where there was none.
    pub(super) closest_stop: f64,
    phase_start: [f64; 2],
}

impl Sliding {
    pub(super) fn new(s: f64) -> Self {
        Self {
            max_m: s,
            min_m: s,
            peak_time_s: 0.0,
            path_m: 0.0,
            time_s: 0.0,
            closest_stop: f64::INFINITY,
            phase_start: [0.0, s],
        }
    }

    /// A stop is decided: friction is asked for `demand`, its static bounds are `low` and `high`.
    /// Without a bound there is nothing to decide.
    pub(super) fn decide(&mut self, demand: f64, [low, high]: [f64; 2]) {
        let bound = if demand < 0.0 { -low } else { high };
        if bound > 0.0 {
            self.closest_stop = self.closest_stop.min((1.0 - demand.abs() / bound).abs());
        }
    }

    /// The block starts to slide, one way or the other.
    pub(super) fn begin(&mut self, time_s: f64, s: f64) {
        self.phase_start = [time_s, s];
    }

    /// It stops, turns round, or the motion ends.
    pub(super) fn end(&mut self, time_s: f64, s: f64) {
        if s.abs() > self.max_m.max(-self.min_m) {
            self.peak_time_s = time_s;
        }
        self.max_m = self.max_m.max(s);
        self.min_m = self.min_m.min(s);
        let [start_s, start_m] = self.phase_start;
        self.path_m += (s - start_m).abs();
        self.time_s += time_s - start_s;
    }
}

/// How a slip starts: `ṡ = 0`, and the leading coefficients of `|ṡ|` that are known to vanish.
#[derive(Clone, Copy)]
pub(super) struct Start {
    /// Number of vanishing coefficients, the constant one included.
    pub(super) order: usize,
    /// `|s̈|` at the start where `order` is 1.
    pub(super) acceleration: f64,
}

pub(super) struct Run<'a, V: PerStorey, R> {
    system: &'a System<V>,
    pub(super) excitation: &'a Excitation<'a>,
    table: &'a [f64],
    /// Coefficients of the static bounds: `[−μ_s⁺, μ_s⁻]`.
    bounds: [f64; 2],
    propagators: Option<&'a [Propagator<V>; 2]>,
    blocks: Option<Blocks<'a>>,
    recorder: R,
    pub(super) extremes: Extremes<V>,
    series: Series<V>,
    pub(super) state: State<V>,
    pub(super) mode: Mode,
    /// Set while a slip has just started.
    pub(super) start: Option<Start>,
    pub(super) events: Vec<Event>,
    pub(super) sliding: Sliding,
    pub(super) events_in_interval: u32,
    /// What a kink of acceleration and of normal force between samples adds to the norm of `ẍ`.
    per_kink: [f64; 2],
}

impl<'a, V: PerStorey, R: Recorder<V>> Run<'a, V, R> {
    fn new(
        model: &Model,
        system: &'a System<V>,
        (propagators, blocks): (Option<&'a [Propagator<V>; 2]>, Option<Blocks<'a>>),
        excitation: &'a Excitation<'a>,
        table: &'a [f64],
        recorder: R,
    ) -> Self {
        let n = system.storeys();
        let initial = model.initial();
        let masses_kg = &model.frame().masses_kg;
        let mut state = State::<V>::zeros(n);
        {
            let x = state.0.as_mut();
            x[0] = initial.sliding_displacement_m;
            x[1] = initial.sliding_velocity_m_per_s;
            let q = system.coordinates(masses_kg, &model.initial_storey_displacement_m());
            let v = system.coordinates(masses_kg, &model.initial_storey_velocity_m_per_s());
            x[2..2 + n].copy_from_slice(q.as_ref());
            x[2 + n..].copy_from_slice(v.as_ref());
        }
        let mode = match initial.sliding_velocity_m_per_s {
            w if w > 0.0 => Mode::Slip(Direction::Positive),
            w if w < 0.0 => Mode::Slip(Direction::Negative),
            _ => Mode::Stick,
        };
        // The inertial load of a unit acceleration has energy norm √M_tot, that of a unit force on
        // the block 1/√M1; the force changes by at most the larger μ_k times the normal force.
        let largest_kinetic = model.kinetic_friction().into_iter().fold(0.0, f64::max);
        let over_dt = excitation.dt_s.map_or(0.0, |dt_s| 1.0 / dt_s);
        let per_kink = [
            over_dt * model.total_mass_kg().sqrt(),
            over_dt * largest_kinetic / system.block_mass_kg.sqrt(),
        ];
        Self {
            system,
            excitation,
            table,
            bounds: excitation.bounds(),
            propagators,
            blocks,
            recorder,
            extremes: Extremes::new(model, system),
            series: Series::zeros(n),
            sliding: Sliding::new(state.s()),
            state,
            mode,
            start: None,
            events: Vec::new(),
            events_in_interval: 0,
            per_kink,
        }
    }

    /// Walks through all sample intervals.
    fn walk(&mut self) -> Result<(), SolveError> {
        let times_s = self.excitation.times_s;
        let last = times_s.len() - 1;
        let mut sample = 0;
        while sample < last {
            self.events_in_interval = 0;
            let length_s = times_s[sample + 1] - times_s[sample];
            if length_s == 0.0 {
                // The left side of a jump; the right side decides, as the next sample does.
                self.record_sample(sample, self.mode, true);
                sample += 1;
                continue;
            }
            let end = self.excitation.regular_end(sample);
            match self.blocks {
                Some(blocks) if sample < end => {
                    self.by_blocks(blocks, sample, end)?;
                    sample = end;
                }
                Some(_) => {}
                None => sample = self.short_way(sample),
            }
            if sample < last && times_s[sample + 1] > times_s[sample] {
                self.events_in_interval = 0;
                self.long_way(sample)?;
                sample += 1;
            }
        }
        self.finish(last)
    }

    fn finish(&mut self, last: usize) -> Result<(), SolveError> {
        let end_s = self.excitation.times_s[last];
        if !self.state.0.as_ref().iter().all(|x| x.is_finite()) {
            return Err(SolveError::NotFinite { time_s: end_s });
        }
        if matches!(self.mode, Mode::Slip(_)) && self.start.is_none() && self.state.w() == 0.0 {
            // A stop at the very end is decided by the limit from the left.
            let interval = (0..last).rev().find(|&i| self.excitation.times_s[i] < end_s);
            if let Some(interval) = interval {
                let length_s = end_s - self.excitation.times_s[interval];
                let stretch = self.excitation.stretch(interval, 0.0, length_s);
                self.record(&stretch, length_s, self.mode, false);
                self.stop(&stretch, length_s);
            }
        }
        self.record_sample(last, self.mode, true);
        if matches!(self.mode, Mode::Slip(_)) {
            self.sliding.end(end_s, self.state.s());
        }
        self.extremes.settle(self.system, self.excitation);
        Ok(())
    }

    fn outcome(self) -> Outcome {
        Outcome {
            events: self.events,
            peaks: self.extremes.peak.as_ref().to_vec(),
            overturns: self.extremes.overturns(),
            sliding: self.sliding,
            residual_m: self.state.s(),
            sliding_at_end: matches!(self.mode, Mode::Slip(_)),
        }
    }
}
