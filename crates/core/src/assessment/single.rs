//! One analysis in full: its motion with the tail, its certificate, lower- and upper-bound friction,
//! floor spectra, and what an engineer must be told.

use super::floors::FloorSpectra;
use crate::check::{self, Certificate};
use crate::error::{InputError, MotionError, SolveError};
use crate::input::loaded::Loaded;
use crate::input::{Analysis, Bound, MotionSource};
use crate::model::Model;
use crate::motion::{GroundMotion, Sine};
use crate::notice::Notice;
use crate::progress::{Cancel, NEVER_CANCELLED};
use crate::response::{Method, Response};
use crate::solver;
use crate::study::notices::{coarse_sampling, highest_hz, longest_step_s, suspicious};

/// An analysis with its motion, ready to be solved.
#[derive(Clone, Debug)]
pub struct Job {
    /// What is to be analysed.
    pub analysis: Analysis,
    /// The motion without its tail, and what it is of.
    pub loaded: Loaded,
    /// The motion with its tail: what is solved.
    pub motion: GroundMotion,
    /// What was noticed of model and motion.
    pub warnings: Vec<Notice>,
}

/// A response with its certificate.
#[derive(Clone, Debug)]
pub struct Judged {
    /// Factor on both coefficients of friction.
    pub friction_factor: f64,
    /// The model with that friction.
    pub model: Model,
    /// The response, with its history.
    pub response: Response,
    /// Its certificate.
    pub certificate: Certificate,
}

/// A response that is not judged.
#[derive(Clone, Debug)]
pub struct Solved {
    /// Factor on both coefficients of friction.
    pub friction_factor: f64,
    /// The model with that friction.
    pub model: Model,
    /// The response.
    pub response: Response,
}

/// What came of a job.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// With the friction of the model.
    pub nominal: Judged,
    /// With lower- and upper-bound friction, where the model gives bounds.
    pub bounds: Option<[Judged; 2]>,
    /// Floor spectra of the nominal response, where they were asked for.
    pub floor_spectra: Option<FloorSpectra>,
}

impl Outcome {
    /// Lets go of the histories, of which figures and certificates are left.
    pub fn forget_history(&mut self) {
        let bounds = self.bounds.iter_mut().flatten();
        for judged in core::iter::once(&mut self.nominal).chain(bounds) {
            judged.response.history = None;
            if let Some(plane) = &mut judged.response.in_plane {
                plane.history = None;
            }
        }
    }
}

impl Job {
    /// An analysis on a motion.
    ///
    /// # Errors
    /// [`InputError`] for a tail that cannot be.
    pub fn new(analysis: Analysis, loaded: Loaded) -> Result<Self, InputError> {
        let motion = motion_of(&analysis, &loaded.motion)?;
        let warnings = noticed(&analysis, &loaded);
        Ok(Self { analysis, loaded, motion, warnings })
    }

    /// Solves and judges, with lower- and upper-bound friction where bounds are given.
    ///
    /// # Errors
    /// [`SolveError`] with time and cause.
    pub fn run(&self, floor_spectra: bool) -> Result<Outcome, SolveError> {
        self.run_while(floor_spectra, NEVER_CANCELLED)
    }

    /// The same as long as `go_on` says so, which is asked every few milliseconds.
    ///
    /// # Errors
    /// [`SolveError::Stopped`] where it says no, otherwise [`SolveError`] with time and cause.
    pub fn run_while(&self, floor_spectra: bool, go_on: Cancel<'_>) -> Result<Outcome, SolveError> {
        let nominal = self.solve(&self.analysis.model, go_on)?;
        self.judge(nominal, floor_spectra, go_on)
    }

    /// The same where the nominal response, with its history, is known.
    ///
    /// # Errors
    /// [`SolveError`] with time and cause.
    pub fn run_on(&self, nominal: Response, floor_spectra: bool) -> Result<Outcome, SolveError> {
        self.judge(nominal, floor_spectra, NEVER_CANCELLED)
    }

    fn judge(
        &self,
        nominal: Response,
        floor_spectra: bool,
        go_on: Cancel<'_>,
    ) -> Result<Outcome, SolveError> {
        let model = &self.analysis.model;
        let nominal = self.judged(model.clone(), 1.0, nominal, go_on)?;
        let bounds = match self.analysis.friction_bounds {
            None => None,
            Some(factors) => {
                let with = |bound: Bound| {
                    let model = bound.of(model);
                    let response = self.solve(&model, go_on)?;
                    self.judged(model, bound.friction_factor, response, go_on)
                };
                let [lower, _, upper] = factors.all();
                Some([with(lower)?, with(upper)?])
            }
        };
        let floor_spectra = match floor_spectra {
            true => FloorSpectra::of(&self.loaded.motion, &nominal.response, go_on)?,
            false => None,
        };
        Ok(Outcome { nominal, bounds, floor_spectra })
    }

    /// The nominal response, which nothing has judged, and its floor spectra where they are asked for.
    ///
    /// # Errors
    /// [`SolveError::Stopped`] where `go_on` says no, otherwise [`SolveError`] with time and cause.
    pub fn solve_while(
        &self,
        floor_spectra: bool,
        go_on: Cancel<'_>,
    ) -> Result<(Response, Option<FloorSpectra>), SolveError> {
        let response = self.solve(&self.analysis.model, go_on)?;
        let spectra = match floor_spectra {
            true => FloorSpectra::of(&self.loaded.motion, &response, go_on)?,
            false => None,
        };
        Ok((response, spectra))
    }

    fn solve(&self, model: &Model, go_on: Cancel<'_>) -> Result<Response, SolveError> {
        solver::solve_while(model, &self.motion, self.analysis.method, go_on)
    }

    fn judged(
        &self,
        model: Model,
        friction_factor: f64,
        response: Response,
        go_on: Cancel<'_>,
    ) -> Result<Judged, SolveError> {
        let certificate = check::check_while(&model, &self.motion, &response, go_on)?;
        Ok(Judged { friction_factor, model, response, certificate })
    }
}

/// What an analysis solves: the motion with its tail.
///
/// # Errors
/// [`InputError`] for a tail that cannot be, and for keys along y on a motion in one direction.
pub fn motion_of(analysis: &Analysis, bare: &GroundMotion) -> Result<GroundMotion, InputError> {
    if bare.horizontal_y_m_per_s2().is_none() {
        analysis.along_x_alone()?;
    }
    match analysis.tail_s {
        0.0 => Ok(bare.clone()),
        tail_s => bare.with_tail(tail_s).map_err(|error| of_tail(analysis, &error)),
    }
}

/// What is noticed of a model and a motion before they are run.
#[must_use]
pub fn noticed(analysis: &Analysis, loaded: &Loaded) -> Vec<Notice> {
    let mut warnings = loaded.warnings.clone();
    warnings.extend(suspicious(&analysis.model));
    let (highest_hz, step_s) = (highest_hz(&analysis.model), longest_step_s(&loaded.motion));
    warnings.extend(coarse_sampling(highest_hz, step_s));
    warnings
}

/// The responses of an analysis to a motion with its tail, unjudged: nominal, then lower and upper where the
/// model gives bounds of friction. Histories are kept where they are asked for.
///
/// # Errors
/// [`SolveError::Stopped`] where `go_on` says no, otherwise [`SolveError`] with time and cause.
///
/// # Examples
/// ```
/// use slipstick::assessment::single::solve_all;
/// use slipstick::{input, motion::GroundMotion};
/// use std::ops::ControlFlow;
///
/// let text = "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.1\n\
///             bounds = { lower = 0.8, upper = 1.3 }";
/// let analysis = input::parse("model.toml", text, &[])?;
/// let motion = GroundMotion::evenly_spaced(0.5, vec![0.0, 3.0, 0.0], None)?;
/// let go_on = || ControlFlow::Continue(());
/// let [nominal, lower, upper] = &solve_all(&analysis, &motion, false, &go_on)?[..] else { panic!() };
/// let slid = |solved: &slipstick::assessment::single::Solved| solved.response.demands.sliding_path_m;
/// assert!(slid(upper) < slid(nominal) && slid(nominal) < slid(lower));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve_all(
    analysis: &Analysis,
    motion: &GroundMotion,
    history: bool,
    go_on: Cancel<'_>,
) -> Result<Vec<Solved>, SolveError> {
    let solved = |bound: Option<Bound>| {
        let model = bound.map_or_else(|| analysis.model.clone(), |bound| bound.of(&analysis.model));
        let response = match analysis.method {
            Method::Exact if !history => solver::exact_demands_while(&model, motion, go_on)?,
            method => solver::solve_while(&model, motion, method, go_on)?,
        };
        let response = Response { history: response.history.filter(|_| history), ..response };
        let friction_factor = bound.map_or(1.0, |bound| bound.friction_factor);
        Ok(Solved { friction_factor, model, response })
    };
    let bounds = analysis.friction_bounds.map(|factors| {
        let [lower, _, upper] = factors.all();
        [lower, upper]
    });
    core::iter::once(None).chain(bounds.into_iter().flatten().map(Some)).map(solved).collect()
}

/// A number without the rounding of its unit: 0.12 g is 1.176798 m/s², not 1.1767979999999998.
fn short(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

/// A motion that is made, and what it is in a line; `None` for a record.
///
/// # Errors
/// [`MotionError`] for one that cannot be.
pub fn described(source: &MotionSource) -> Result<Option<(GroundMotion, String)>, MotionError> {
    let words = match source {
        MotionSource::Record(_) => return Ok(None),
        MotionSource::Sine(sine) => of_sine(sine),
        MotionSource::Sines { sines: [x, y], .. } => {
            format!("along x {}; along y {}", of_sine(x), of_sine(y))
        }
        MotionSource::Sweep(sweep) => format!(
            "sweep, {} to {} Hz, {} m/s²",
            short(sweep.from_hz),
            short(sweep.to_hz),
            short(sweep.amplitude_m_per_s2)
        ),
        MotionSource::Pulse(pulse) => format!("pulse, {} m/s²", short(pulse.amplitude_m_per_s2)),
    };
    Ok(source.made()?.map(|motion| (motion, words)))
}

fn of_sine(sine: &Sine) -> String {
    format!("sine, {} Hz, {} m/s²", short(sine.frequency_hz), short(sine.amplitude_m_per_s2))
}

/// What is wrong with a tail, at its key.
fn of_tail(analysis: &Analysis, error: &MotionError) -> InputError {
    match error {
        MotionError::TooLong { found } => {
            let expected = "at most 100 000 000 samples, those of the motion among them";
            analysis.error_at("analysis.tail", expected, format!("{found:.1e}"))
        }
        other => analysis.motion_error(other),
    }
}
