//! One analysis from model text to results: what the command and other front ends share.

use std::path::Path;

use slipstick::check::{self, Certificate};
use slipstick::error::{InputError, MotionError, SolveError};
use slipstick::input::{Analysis, MotionSource, RecordSource, Scale as ModelScale};
use slipstick::linear::shear_frame_frequencies;
use slipstick::model::Model;
use slipstick::motion::{GroundMotion, spectrum};
use slipstick::response::{History, Response, Warning};
use slipstick::solver;
use slipstick_report::{FloorSpectra, Summary, SummaryInputs};

use crate::error::{FileError, reason};
use crate::load::{LoadedMotion, RecordRequest, Scale, VerticalRequest, load_record};
use crate::read::resolve;

/// Damping ratio of floor spectra.
const FLOOR_SPECTRUM_DAMPING: f64 = 0.05;

/// A model and its motion, ready to be solved.
#[derive(Clone, Debug)]
pub struct Job {
    /// Name of the model, else the stem of its file.
    pub name: String,
    /// What the model file says.
    pub analysis: Analysis,
    /// The motion as it was read, factors applied, without its tail.
    pub loaded: LoadedMotion,
    /// The motion with its tail: what is solved.
    pub motion: GroundMotion,
    /// What reading model and record gave notice of.
    pub warnings: Vec<Warning>,
}

/// What came of a job.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The nominal response, with its history.
    pub response: Response,
    /// Its certificate.
    pub certificate: Certificate,
    /// All figures, those of the bounds included, and floor spectra where they were asked for.
    pub summary: Summary,
    /// Responses with lower- and upper-bound friction, where the model gives bounds.
    pub bounds: Option<[Response; 2]>,
}

/// Why a job could not be made ready or solved.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// The model.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// The analysis itself.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

impl Job {
    /// Opens or makes the motion of an analysis.
    ///
    /// `model_path` names the model file (its folder is where records are looked for); `record`
    /// replaces the model's own motion, its path being relative to the working folder.
    ///
    /// # Errors
    /// [`JobError`] where no motion is given, or it cannot be read or made.
    pub fn new(
        model_path: &Path,
        analysis: Analysis,
        record: Option<&RecordRequest>,
    ) -> Result<Self, JobError> {
        let folder = model_path.parent().unwrap_or(Path::new(""));
        let in_model = |error: MotionError| analysis.motion_error(&error);
        let loaded = match record {
            Some(record) => load_record(record)?,
            None => match analysis.required_motion()? {
                MotionSource::Record(source) => {
                    let record = request(source, folder);
                    load_record(&record).map_err(|error| of_model(&analysis, &record, error))?
                }
                MotionSource::Sine(sine) => {
                    let text =
                        format!("sine, {} Hz, {} m/s²", sine.frequency_hz, sine.amplitude_m_per_s2);
                    LoadedMotion::made(sine.motion().map_err(in_model)?, text)
                }
                MotionSource::Sweep(sweep) => {
                    let text = format!(
                        "sweep, {} to {} Hz, {} m/s²",
                        sweep.from_hz, sweep.to_hz, sweep.amplitude_m_per_s2
                    );
                    LoadedMotion::made(sweep.motion().map_err(in_model)?, text)
                }
                MotionSource::Pulse(pulse) => {
                    let text = format!("pulse, {} m/s²", pulse.amplitude_m_per_s2);
                    LoadedMotion::made(pulse.motion().map_err(in_model)?, text)
                }
            },
        };
        let motion = match analysis.tail_s {
            0.0 => loaded.motion.clone(),
            tail_s => {
                let motion = loaded.motion.with_tail(tail_s);
                motion.map_err(|error| of_tail(&analysis, &error))?
            }
        };
        let mut warnings = loaded.warnings.clone();
        warnings.extend(coarse_sampling(&analysis.model, &loaded.motion));
        warnings.extend(pendulum_under_vertical_motion(&analysis, &loaded.motion));
        let stem = model_path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let name = analysis.name.clone().or(stem).unwrap_or_else(|| "model".to_owned());
        Ok(Self { name, analysis, loaded, motion, warnings })
    }

    /// Solves, judges and summarises, with lower- and upper-bound friction where bounds are given.
    ///
    /// # Errors
    /// [`JobError::Solve`] with time and cause.
    pub fn run(&self, floor_spectrum: bool) -> Result<Outcome, JobError> {
        let model = &self.analysis.model;
        let (response, certificate, summary) = self.solve(model, 1.0)?;
        let (summary, bounds) = match self.analysis.friction_bounds {
            None => (summary, None),
            Some(factors) => {
                let solve = |factor: f64| {
                    let friction = model.slider().friction.scaled(factor);
                    let friction = friction.unwrap_or(model.slider().friction);
                    self.solve(&model.with_friction(friction), factor)
                };
                let (lower, _, of_lower) = solve(factors.lower)?;
                let (upper, _, of_upper) = solve(factors.upper)?;
                (summary.with_bounds(of_lower, of_upper), Some([lower, upper]))
            }
        };
        let summary = match (&response.history, floor_spectrum) {
            (Some(history), true) => {
                summary.with_floor_spectra(floor_spectra(&self.loaded.motion, history))
            }
            _ => summary,
        };
        Ok(Outcome { response, certificate, summary, bounds })
    }

    fn solve(
        &self,
        model: &Model,
        friction_factor: f64,
    ) -> Result<(Response, Certificate, Summary), JobError> {
        let method = self.analysis.method;
        let response = solver::solve(model, &self.motion, method)?;
        let empty = History::default();
        let history = response.history.as_ref().unwrap_or(&empty);
        let certificate = check::check(model, &self.motion, history);
        let figures = self.loaded.figures;
        let summary = Summary::new(&SummaryInputs {
            name: &self.name,
            model,
            motion: &self.motion,
            record: figures,
            response: &response,
            certificate: &certificate,
            friction_factor,
            warnings: &self.warnings,
        });
        // The step is that of the record: a tail may start with a jump or end between two steps.
        let summary = Summary { dt_s: self.loaded.motion.dt_s(), ..summary };
        Ok((response, certificate, summary))
    }
}

/// What is wrong with the record of a model, at the key that asks for it where the model can be
/// blamed: a path that leads nowhere, a scale that has no answer.
fn of_model(analysis: &Analysis, record: &RecordRequest, error: FileError) -> JobError {
    let key = |path: &Path| {
        let vertical = record.vertical.as_ref().is_some_and(|vertical| vertical.path == path);
        if vertical { "motion.vertical" } else { "motion.record" }
    };
    match &error {
        FileError::Read { path, source } => {
            let found = format!("{}: {}", path.display(), reason(source));
            analysis.error_at(key(path), "a file that can be read", found).into()
        }
        FileError::IsFolder { path } => {
            let found = format!("the folder {}", path.display());
            analysis.error_at(key(path), "a file", found).into()
        }
        FileError::Motion {
            source: source @ (MotionError::ZeroPeak | MotionError::OutOfRange { .. }),
            ..
        } => analysis.motion_error(source).into(),
        _ => error.into(),
    }
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

/// A record as the model asks for it.
pub(crate) fn request(record: &RecordSource, folder: &Path) -> RecordRequest {
    RecordRequest {
        path: resolve(folder, &record.path),
        format: None,
        units: record.units,
        dt_s: record.dt_s,
        channel: record.channel.clone(),
        scale: match record.scale {
            ModelScale::Factor(factor) => Scale::Factor(factor),
            ModelScale::Peak(peak) => Scale::ToPeak(peak),
        },
        vertical: record.vertical.as_ref().map(|path| VerticalRequest {
            path: resolve(folder, path),
            channel: None,
            factor: record.vertical_scale.unwrap_or(1.0),
        }),
    }
}

/// Samples further apart than a tenth of the shortest period say little of the highest mode.
fn coarse_sampling(model: &Model, motion: &GroundMotion) -> Option<Warning> {
    let times_s = motion.times_s();
    let longest_s = times_s.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
    let nyquist_hz = 0.5 / longest_s;
    let frame = model.frame();
    let of_frame = shear_frame_frequencies(&frame.masses_kg, &frame.stiffnesses_n_per_m);
    let of_slider = (model.slider().stiffness_n_per_m / model.total_mass_kg()).sqrt();
    let highest_hz = of_frame.into_iter().fold(of_slider, f64::max) / (2.0 * std::f64::consts::PI);
    (nyquist_hz < 5.0 * highest_hz).then(|| Warning {
        kind: "coarse_sampling",
        time_s: None,
        message: format!(
            "the Nyquist frequency of the motion, {nyquist_hz:.4} Hz, is below 5 times the highest \
             mode, {highest_hz:.4} Hz: the motion may lack what excites that mode"
        ),
    })
}

fn pendulum_under_vertical_motion(analysis: &Analysis, motion: &GroundMotion) -> Option<Warning> {
    let pendulum = analysis.value("slider.radius").is_some();
    (pendulum && motion.vertical_m_per_s2().is_some()).then(|| Warning {
        kind: "pendulum_under_vertical_motion",
        time_s: None,
        message: "the pendulum slider is a spring M_tot g / R; its true force would follow the \
                  normal force N(t)"
            .to_owned(),
    })
}

/// Spectra of table, block and floors; what the knots keep is taken as linear between them, with
/// both sides of every jump.
fn floor_spectra(motion: &GroundMotion, history: &History) -> FloorSpectra {
    let periods_s: Vec<f64> =
        (0..120).map(|i| 0.02 * libm::pow(200.0, f64::from(i) / 119.0)).collect();
    let of = |times_s: &[f64], acceleration: &[f64]| -> Vec<f64> {
        let spectrum = spectrum(times_s, acceleration, &periods_s, &[FLOOR_SPECTRUM_DAMPING]);
        let Ok(spectrum) = spectrum else { return Vec::new() };
        spectrum.of_damping(0).iter().map(|ordinates| ordinates.sa_m_per_s2).collect()
    };
    let n = history.storeys;
    let storey = |i: usize| -> Vec<f64> {
        history.storey_acceleration_m_per_s2.iter().skip(i).step_by(n).copied().collect()
    };
    FloorSpectra {
        damping_ratio: FLOOR_SPECTRUM_DAMPING,
        table_m_per_s2: of(motion.times_s(), motion.horizontal_m_per_s2()),
        block_m_per_s2: of(&history.time_s, &history.block_acceleration_m_per_s2),
        storeys_m_per_s2: (0..n).map(|i| of(&history.time_s, &storey(i))).collect(),
        periods_s,
    }
}
