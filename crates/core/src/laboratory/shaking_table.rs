//! Parameters of a model from a shaking-table record: those with which the exact response meets the
//! measured histories best.
//!
//! The residuals of each quantity are taken over their own standard deviation, which is estimated
//! from them. Parameters are sought from a seeded global start (see [`super::fit`]); intervals are
//! those of profile likelihood for residuals that are normal, of one variance a quantity, and whose
//! memory is as long as measured: the rise of the sum of squares that is allowed is multiplied by
//! their correlation length.
//!
//! What transducers do to what they measure, gain, lag, zero and drift, is fitted with the rest and widens the
//! intervals ([`Instruments`]). The table acceleration drives the model, so its noise, and what happens
//! between its samples, move the estimates and widen the intervals too (`drive`). What the model leaves is
//! looked at: residuals above the stated noise, or with a memory that noise does not have, are no noise.

mod covariance;
mod drive;
mod instruments;
mod parameter;
mod remarks;

use core::cell::{Cell, RefCell};

pub use covariance::Covariance;
pub use instruments::{Instrument, Instruments};
use instruments::{Remainder, Seen};
pub use parameter::{Builder, Parameter};

use super::compare::{self, CompareError, Comparison};
use super::estimate::{Estimate, correlation_length};
use super::fit::{Interval, Minimum, Problem, Profile, global, profile, refine};
use super::measured::Measured;
use super::metrics::rms;
use crate::error::{ChoiceError, RecordError, Stopped};
use crate::input::Channel;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::notice::{Notice, NoticeKind};
use crate::numerics::distribution::student_quantile;
use crate::response::Method;
use crate::slider::Friction;
use crate::solver;
use crate::study::engine::Engine;
use crate::units::Dimension;

/// How much better than stuck a sliding response must fit before anything is said of the slider, in
/// variances.
const CLEAR_SLIDING: f64 = 25.0;
/// How often a profile may turn up a better fit and start anew.
const MOST_TURNS: usize = 20;
/// Residuals that each parameter must have.
const LEAST_RESIDUALS: usize = 10;
/// Least variance of residuals over their standard deviation.
const LEAST_VARIANCE: f64 = 0.1;
/// Least standard deviation over the size of a quantity: its last digits, or what a lag about which the model is
/// taken as linear leaves.
const LEAST_NOISE: [f64; 2] = [1e-9, 1e-6];
/// Fits after each of which residuals are weighed anew and lags move, at most.
const MOST_SCALES: usize = 8;
/// Least step of a derivative, over the range of the parameter: where a sum of squares has a cliff at
/// either side of its minimum, the interval of the profile is next to nothing.
const LEAST_STEP: f64 = 1e-4;
/// How near in samples a jump of the response is known: the table moves between its samples as it likes.
const JUMP_REACH: f64 = 0.1;
/// Standard deviation of the lag of a quantity that jumps, in samples.
const JUMP_PLACE: f64 = 0.03;
/// Lags to either side that are looked at, at most.
const MOST_LAGS: i32 = 400;

/// A record to be fitted.
pub struct TableTest<'a> {
    /// What was measured.
    pub measured: &'a Measured,
    /// What is fitted.
    pub parameters: &'a [Parameter],
    /// The model of some values, in the order of the parameters; `None` where there is none.
    pub build: &'a dyn Fn(&[f64]) -> Option<Model>,
    /// Values to begin with, beside the random ones.
    pub start: Option<Vec<f64>>,
    /// Quantities to fit; `None`: all that the model has.
    pub using: Option<Vec<Channel>>,
    /// What is known of the transducers.
    pub instruments: &'a Instruments,
    /// Seed of the global start.
    pub seed: u64,
}

/// What a record says.
#[derive(Clone, Debug, PartialEq)]
pub struct TableFit {
    /// One estimate a parameter.
    pub estimates: Vec<Estimate>,
    /// The best values, also of those that the data do not tell.
    pub values: Vec<f64>,
    /// The model with them.
    pub model: Model,
    /// Its response beside what was measured.
    pub comparison: Comparison,
    /// The quantities that were fitted, with the standard deviation of their residuals in SI.
    pub noise: Vec<(Channel, f64)>,
    /// How many samples one independent sample is worth.
    pub correlation_length: f64,
    /// How much better than a stuck block the fit is, in variances.
    pub sliding_evidence: f64,
    /// Fitted offsets of sensors whose zero is not stated: measured less true, in SI.
    pub offsets: Vec<(Channel, f64)>,
    /// What the transducers were found to do, such as `block_acceleration.gain`, where it was not known.
    pub instruments: Vec<Estimate>,
    /// Predicted less measured values, corrected for the transducers, a list a quantity, in SI, and their
    /// times in s from the start of the table acceleration.
    pub residuals: Vec<Residuals>,
    /// The covariance of the parameters, and of what was found of the transducers; `None` where the derivatives
    /// do not determine it.
    pub covariance: Option<Covariance>,
    /// Standard deviation of the noise of the table acceleration, in m/s².
    pub table_noise_m_per_s2: f64,
    /// What a reader must know.
    pub warnings: Vec<Notice>,
}

/// What the best values leave of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// The quantity.
    pub channel: Channel,
    /// Times in s from the start of the table acceleration, as the file has them.
    pub times_s: Vec<f64>,
    /// Predicted less measured, in SI.
    pub values: Vec<f64>,
    /// How many samples one independent sample is worth.
    pub correlation_length: f64,
}

/// Why nothing was fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// What is said of the transducers.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// The file lacks a quantity.
    #[error(transparent)]
    Measured(#[from] RecordError),
    /// The table acceleration or the response.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// No values inside the ranges make a model that has a response.
    #[error("no values of {parameters} inside their ranges give a response")]
    NoResponse {
        /// The parameters.
        parameters: String,
    },
    /// Too little data.
    #[error("expected at least {expected} measured values for {parameters}, found {found}")]
    TooShort {
        /// The parameters.
        parameters: String,
        /// Values needed.
        expected: usize,
        /// Values found.
        found: usize,
    },
    /// The callback that followed it stopped it.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Fits a record; the engine is told of every run of the model.
///
/// # Errors
/// [`TableError`] where table acceleration or measured quantities are missing or too short, nothing
/// inside the ranges has a response, or the engine is stopped.
pub fn shaking_table(test: &TableTest, engine: &Engine<'_>) -> Result<TableFit, TableError> {
    // A model that is stopped has no response, which ends every search at once.
    let fit = fit(test, engine);
    engine.check()?;
    fit
}

fn fit(test: &TableTest, engine: &Engine<'_>) -> Result<TableFit, TableError> {
    let (motion, start_s) = compare::table_motion(test.measured)?;
    let chosen = chosen(test)?;
    let table_gain = test.instruments.table_gain()?;
    let instruments = chosen.series.iter().map(|series| test.instruments.of(series));
    let instruments: Vec<Instrument> = instruments.collect::<Result<_, _>>()?;
    let data = Data {
        motion: &motion,
        start_s,
        measured: &chosen,
        lags_s: RefCell::new(vec![0.0; instruments.len()]),
        instruments,
        weight: Cell::new(1.0),
        build: test.build,
        engine,
        runs: Cell::new(0),
    };
    let count = test.parameters.len() as u64;
    engine.plan(RUNS.iter().sum::<u64>() * count);
    let known = |stage: usize| engine.replan(RUNS[stage] * count, data.runs.take());
    let no_response = || TableError::NoResponse { parameters: names(test) };
    let bounds: Vec<[f64; 2]> = test.parameters.iter().map(|p| [p.low, p.high]).collect();
    let (scales, minimum) = searched(test, &data, &bounds)?;
    known(0);
    let residuals = |p: &[f64]| data.residuals(p, &scales);
    let problem = Problem { bounds, residuals: &residuals };
    let minimum = refine(&problem, &minimum.unit).ok_or_else(no_response)?;
    let mut found = intervals(&problem, &data, &scales, minimum);
    known(1);
    let table_noise_m_per_s2 = drive::noise(&motion);
    let of_table = drive::OfTable { noise_m_per_s2: table_noise_m_per_s2, gain: table_gain };
    drive::widen(&mut found, &problem, &data, &scales, of_table, test.seed);
    known(2);
    let values = problem.parameters(&found.minimum.unit);
    let model = (test.build)(&values).ok_or_else(no_response)?;
    let evidence = evidence(&data, &model, &scales, &found);
    let estimates = test.parameters.iter().enumerate().map(|(index, parameter)| {
        let slides = evidence > CLEAR_SLIDING || !parameter.path.starts_with("slider.");
        // Static friction may go down to the kinetic one, where the data tell that.
        let path = parameter.path.replace("static", "kinetic");
        let kinetic =
            test.parameters.iter().position(|other| other.path == path && path != parameter.path);
        let kinetic = kinetic.map(|other| {
            let natural = test.parameters[other].natural;
            let told = found.intervals[other]
                .is_some_and(|i| (!i.open[0] || natural[0]) && (!i.open[1] || natural[1]));
            (values[other], told)
        });
        estimate(parameter, values[index], found.intervals[index], kinetic, slides)
    });
    let estimates: Vec<Estimate> = estimates.collect();
    let sights = data.sights(&model, data.motion).ok_or_else(no_response)?;
    let left = data.remainders(&sights, None, &scales).ok_or_else(no_response)?;
    let paths: Vec<&str> = test.parameters.iter().map(|p| p.path.as_str()).collect();
    let covariance = Covariance::new(&paths, &found, &problem, &data, &scales);
    let instruments = data.found_of_instruments(&left, covariance.as_ref());
    let corrected = data.corrected(test.measured, &left);
    let comparison = compare::compare(&corrected, &model, Method::Exact)?;
    let noise: Vec<(Channel, f64)> =
        chosen.series.iter().map(|s| s.channel).zip(scales.iter().copied()).collect();
    let offsets: Vec<(Channel, f64)> = data
        .instruments
        .iter()
        .zip(&chosen.series)
        .zip(&left)
        .filter(|((instrument, _), _)| instrument.zero > 0.0)
        .map(|((_, series), left)| (series.channel, left.found[2]))
        .collect();
    let residuals = data.residuals_of(sights, &left);
    let mut warnings = remarks::of_sensors(&left, &data, found.length);
    warnings.extend(remarks::of_instruments(&instruments));
    warnings.extend(remarks::of_residuals(&residuals, &data));
    let tilted = test.parameters.iter().any(|parameter| parameter.path == "slider.tilt");
    let table = test.measured.series.iter().find(|s| s.channel == Channel::TableAcceleration);
    if tilted && table.is_some_and(|series| !series.zero_known) {
        let message = "the zero of table_acceleration is not stated, and 1 mg of it is 1 mrad of \
                       slider.tilt: what is fitted is their sum; the mapping \"zero=first 2 s\" states the zero";
        warnings.push(Notice::new(NoticeKind::ZeroNotStated, message));
    }
    Ok(TableFit {
        estimates,
        values,
        model,
        comparison,
        noise,
        correlation_length: found.length,
        sliding_evidence: evidence,
        offsets,
        instruments,
        residuals,
        covariance,
        table_noise_m_per_s2,
        warnings,
    })
}

/// Names of what is fitted.
fn names(test: &TableTest) -> String {
    let names: Vec<&str> = test.parameters.iter().map(|p| p.path.as_str()).collect();
    names.join(", ")
}

/// The standard deviations of what is left of each quantity, and the best values.
fn searched(
    test: &TableTest,
    data: &Data,
    bounds: &[[f64; 2]],
) -> Result<(Vec<f64>, Minimum), TableError> {
    let no_response = || TableError::NoResponse { parameters: names(test) };
    // First each quantity over its own size, then over what the fit leaves of it; lags move to where the
    // response shows them.
    let mut scales: Vec<f64> =
        data.measured.series.iter().map(|s| rms(&s.values).max(1e-300)).collect();
    let mut minimum: Option<Minimum> = None;
    let mut settled_once = data.instruments.iter().all(|instrument| instrument.lag_s == 0.0);
    let mut look_again = false;
    for turn in 0..MOST_SCALES {
        let residuals = |p: &[f64]| data.residuals(p, &scales);
        let problem = Problem { bounds: bounds.to_vec(), residuals: &residuals };
        let found = match &minimum {
            None => global(&problem, test.start.as_deref(), test.seed),
            // The first search was made without lags: it may have ended in another valley.
            Some(minimum) if look_again => {
                let start = problem.parameters(&minimum.unit);
                let refined = refine(&problem, &minimum.unit);
                let again = global(&problem, Some(&start), test.seed);
                [refined, again].into_iter().flatten().min_by(|a, b| a.sse.total_cmp(&b.sse))
            }
            Some(minimum) => refine(&problem, &minimum.unit),
        };
        let found = found.ok_or_else(no_response)?;
        let expected = LEAST_RESIDUALS * bounds.len();
        if found.count < expected {
            let found = found.count;
            return Err(TableError::TooShort { parameters: names(test), expected, found });
        }
        let values = problem.parameters(&found.unit);
        let model = (data.build)(&values).ok_or_else(no_response)?;
        let finely = turn > 0;
        if !settled_once || turn == 0 {
            data.look_for_lags(&model, &scales, finely).ok_or_else(no_response)?;
        }
        let left = data.of_model(&model, &scales).ok_or_else(no_response)?;
        let moved = data.move_lags(&left);
        let next: Vec<f64> = left
            .iter()
            .zip(data.measured.series.iter().zip(&data.instruments))
            .map(|(left, (series, instrument))| {
                let least = LEAST_NOISE[usize::from(instrument.lag_s > 0.0)];
                rms(&left.left).max(least * rms(&series.values)).max(1e-300)
            })
            .collect();
        let settled = next.iter().zip(&scales).all(|(a, b)| (a / b - 1.0).abs() < 0.01);
        minimum = Some(found);
        scales = next;
        data.weight.set(memory(&left));
        if settled_once && settled && !moved {
            break;
        }
        look_again = !settled_once && settled && !moved;
        settled_once |= look_again;
    }
    minimum.map(|minimum| (scales, minimum)).ok_or_else(no_response)
}

/// How many samples one independent sample is worth, at most of all quantities.
fn memory(left: &[Remainder]) -> f64 {
    left.iter().map(|left| correlation_length(&left.left)).fold(1.0, f64::max)
}

/// The measured quantities to fit.
fn chosen(test: &TableTest) -> Result<Measured, RecordError> {
    let mut chosen = test.measured.clone();
    if let Some(using) = &test.using {
        for channel in using {
            test.measured.require(*channel)?;
        }
        chosen.series.retain(|series| using.contains(&series.channel));
    }
    let driven = |channel: Channel| {
        !matches!(
            channel,
            Channel::Time
                | Channel::TableAcceleration
                | Channel::Displacement
                | Channel::Force
                | Channel::Acceleration
        )
    };
    chosen.series.retain(|series| driven(series.channel));
    if chosen.series.is_empty() {
        test.measured.require(Channel::BlockAcceleration)?;
    }
    Ok(chosen)
}

/// What residuals are made from.
struct Data<'a> {
    motion: &'a GroundMotion,
    start_s: f64,
    measured: &'a Measured,
    /// What is not known of the transducer of each quantity.
    instruments: Vec<Instrument>,
    /// The lag in s about which each of them is linear.
    lags_s: RefCell<Vec<f64>>,
    /// How much the squares of what is said of transducers count: as many samples as one independent one is worth.
    weight: Cell<f64>,
    build: &'a dyn Fn(&[f64]) -> Option<Model>,
    engine: &'a Engine<'a>,
    /// Runs that were not yet told of to those who wait.
    runs: Cell<u64>,
}

/// Runs that the search, the intervals and the draws of the table's noise are thought to take for each
/// parameter, for those who wait.
const RUNS: [u64; 3] = [200, 600, 2000];

/// What a transducer sees of a response, and what it shows.
struct Sight {
    seen: Seen,
    times_s: Vec<f64>,
    measured: Vec<f64>,
}

impl Data<'_> {
    /// What is left of each quantity.
    fn of_model(&self, model: &Model, scales: &[f64]) -> Option<Vec<Remainder>> {
        self.remainders(&self.sights(model, self.motion)?, None, scales)
    }

    /// What the transducers see of the response under a motion, about the lags that they have now.
    fn sights(&self, model: &Model, motion: &GroundMotion) -> Option<Vec<Sight>> {
        self.engine.done(1).ok()?;
        self.runs.set(self.runs.get() + 1);
        let response = solver::exact(model, motion).ok()?;
        let history = response.history.as_ref()?;
        let pairs = compare::pairs(self.measured, self.start_s, history);
        if pairs.len() != self.measured.series.len() {
            return None;
        }
        let lags_s = self.lags_s.borrow();
        let sight = |(pair, (instrument, lag_s)): (compare::Pair, (&Instrument, &f64))| {
            let compare::Pair { channel, times_s, measured, predicted, .. } = pair;
            let at = |late_s: f64| {
                let times_s: Vec<f64> = times_s.iter().map(|t| t - late_s).collect();
                compare::predicted(channel, history, &times_s)
            };
            let values = if *lag_s == 0.0 { predicted } else { at(*lag_s)? };
            let rates = if instrument.lag_s > 0.0 {
                let half_s = 0.5 * step_s(&times_s);
                let (late, early) = (at(lag_s + half_s)?, at(lag_s - half_s)?);
                early.iter().zip(&late).map(|(b, a)| (b - a) / (2.0 * half_s)).collect()
            } else {
                Vec::new()
            };
            let about = if instrument.lag_s > 0.0 && jumps(channel) {
                let reach_s = JUMP_REACH * step_s(&times_s);
                let (early, late) = (at(lag_s + reach_s)?, at(lag_s - reach_s)?);
                let about =
                    |((a, b), c): ((&f64, &f64), &f64)| [a.min(*b).min(*c), a.max(*b).max(*c)];
                early.iter().zip(&late).zip(&values).map(about).collect()
            } else {
                Vec::new()
            };
            Some(Sight { seen: Seen { values, rates, about }, times_s, measured })
        };
        pairs.into_iter().zip(self.instruments.iter().zip(lags_s.iter())).map(sight).collect()
    }

    /// What the best unknowns of the transducers leave of what was measured, or of other values in its place.
    fn remainders(
        &self,
        sights: &[Sight],
        targets: Option<&[Vec<f64>]>,
        scales: &[f64],
    ) -> Option<Vec<Remainder>> {
        let lags_s = self.lags_s.borrow();
        let of = |(index, sight): (usize, &Sight)| {
            let target = targets.map_or(&sight.measured, |targets| &targets[index]);
            let (scale, weight) = (scales[index], self.weight.get());
            self.instruments[index].remainder(&sight.seen, target, lags_s[index], scale, weight)
        };
        sights.iter().enumerate().map(of).collect()
    }

    fn residuals(&self, parameters: &[f64], scales: &[f64]) -> Option<Vec<f64>> {
        Some(weighed(&self.of_model(&(self.build)(parameters)?, scales)?, scales))
    }

    /// Sets each lag that is not known to where the response shows it best: over three of its standard
    /// deviations to either side and a tenth of the record at most; or finely, over a sample to either side of
    /// where it is, since a jump stands at one sample or at the next.
    fn look_for_lags(&self, model: &Model, scales: &[f64], finely: bool) -> Option<()> {
        if self.instruments.iter().all(|instrument| instrument.lag_s == 0.0) {
            return Some(());
        }
        self.engine.done(1).ok()?;
        let response = solver::exact(model, self.motion).ok()?;
        let history = response.history.as_ref()?;
        let pairs = compare::pairs(self.measured, self.start_s, history);
        for (index, pair) in pairs.iter().enumerate().take(self.instruments.len()) {
            let instrument = &self.instruments[index];
            if instrument.lag_s == 0.0 {
                continue;
            }
            let duration_s = pair.times_s.last()? - pair.times_s.first()?;
            let sample_s = step_s(&pair.times_s);
            let (step_s, middle_s, most) = if finely {
                (sample_s / 20.0, self.lags_s.borrow()[index], 20)
            } else {
                let most_s = (3.0 * instrument.lag_s).min(0.1 * duration_s);
                (0.5 * sample_s, 0.0, (most_s / (0.5 * sample_s)) as i32)
            };
            let without = Instrument { lag_s: 0.0, ..*instrument };
            let mut best = (f64::INFINITY, 0.0);
            for k in -most.min(MOST_LAGS)..=most.min(MOST_LAGS) {
                let lag_s = middle_s + f64::from(k) * step_s;
                let times_s: Vec<f64> = pair.times_s.iter().map(|t| t - lag_s).collect();
                let values = compare::predicted(pair.channel, history, &times_s)?;
                let seen = Seen { values, rates: Vec::new(), about: Vec::new() };
                let left = without.remainder(&seen, &pair.measured, 0.0, scales[index], 1.0)?;
                let sse: f64 = left.left.iter().map(|r| r * r).sum();
                if sse < best.0 {
                    best = (sse, lag_s);
                }
            }
            self.lags_s.borrow_mut()[index] = best.1;
        }
        Some(())
    }

    /// Moves the lags to where the last fit found them; whether one moved by more than a twentieth of a step.
    fn move_lags(&self, left: &[Remainder]) -> bool {
        let mut moved = false;
        let mut lags_s = self.lags_s.borrow_mut();
        for (index, instrument) in self.instruments.iter().enumerate() {
            let [gain, late, ..] = left[index].found;
            if instrument.lag_s == 0.0 || !(gain > 0.1) {
                continue;
            }
            let step_s = self.measured.series.get(index).map_or(0.0, |s| step_s(&s.times_s));
            // The line holds over a sample or two.
            let by_s = (late / gain).clamp(-2.0 * step_s, 2.0 * step_s);
            let most_s = 5.0 * instrument.lag_s;
            let next_s = (lags_s[index] + by_s).clamp(-most_s, most_s);
            moved |= (next_s - lags_s[index]).abs() > 0.05 * step_s;
            lags_s[index] = next_s;
        }
        moved
    }

    /// What was found of the transducers, with its intervals.
    fn found_of_instruments(
        &self,
        left: &[Remainder],
        covariance: Option<&Covariance>,
    ) -> Vec<Estimate> {
        let lags_s = self.lags_s.borrow();
        let mut all = Vec::new();
        for (index, series) in self.measured.series.iter().enumerate() {
            let unit = series.channel.dimension().si_unit();
            let [gain, late, zero, drift] = left[index].found;
            let deviations = self.instruments[index].nominal(0.0).map(|[_, deviation]| deviation);
            let values = [gain, lags_s[index] + late / gain, zero, drift];
            for (k, (name, unit)) in [("gain", ""), ("lag", "s"), ("zero", unit), ("drift", unit)]
                .into_iter()
                .enumerate()
            {
                if deviations[k] == 0.0 {
                    continue;
                }
                let path = format!("{}.{name}", series.channel.name());
                let half = covariance.and_then(|covariance| covariance.half_width(&path));
                all.push(match half {
                    Some(half) => {
                        let half = match k {
                            1 => libm::hypot(half / gain, of_jumps_s(series)),
                            _ => half,
                        };
                        Estimate::determined(
                            path,
                            unit,
                            values[k],
                            [values[k] - half, values[k] + half],
                        )
                    }
                    None => Estimate::refused(path, unit, "the derivatives do not determine it"),
                });
            }
        }
        all
    }

    /// What was measured without what the transducers were found to do.
    fn corrected(&self, measured: &Measured, left: &[Remainder]) -> Measured {
        let mut corrected = measured.clone();
        let lags_s = self.lags_s.borrow();
        for (index, fitted) in self.measured.series.iter().enumerate() {
            let instrument = &self.instruments[index];
            let known = instrument.nominal(0.0).iter().all(|[_, deviation]| *deviation == 0.0);
            let [gain, late, zero, drift] = left[index].found;
            let of =
                |series: &&mut super::measured::MeasuredSeries| series.channel == fitted.channel;
            let Some(series) = corrected.series.iter_mut().find(of).filter(|_| !known) else {
                continue;
            };
            let count = series.values.len();
            for (i, value) in series.values.iter_mut().enumerate() {
                *value = (*value - zero - drift * instruments::place(i, count)) / gain;
            }
            let lag_s = lags_s[index] + late / gain;
            series.times_s.iter_mut().for_each(|t| *t -= lag_s);
            series.origin.push_str(", corrected by what the fit found of its sensor");
        }
        corrected
    }

    /// What is left of each quantity, with its times.
    fn residuals_of(&self, sights: Vec<Sight>, left: &[Remainder]) -> Vec<Residuals> {
        let of =
            |((sight, left), series): ((Sight, &Remainder), &super::measured::MeasuredSeries)| {
                Residuals {
                    channel: series.channel,
                    times_s: sight.times_s,
                    correlation_length: correlation_length(&left.left),
                    values: left.left.clone(),
                }
            };
        sights.into_iter().zip(left).zip(&self.measured.series).map(of).collect()
    }
}

/// Half of what the lag of a quantity that jumps is not known by, in s: when between two samples it jumped hardly
/// shows.
fn of_jumps_s(series: &super::measured::MeasuredSeries) -> f64 {
    if jumps(series.channel) { 2.0 * JUMP_PLACE * step_s(&series.times_s) } else { 0.0 }
}

/// Whether a quantity jumps where a block breaks away or stops.
fn jumps(channel: Channel) -> bool {
    !matches!(channel.dimension(), Dimension::Length | Dimension::Velocity)
}

/// The mean step of some times in s.
fn step_s(times_s: &[f64]) -> f64 {
    let span_s = times_s.last().zip(times_s.first()).map_or(0.0, |(last, first)| last - first);
    span_s / (times_s.len().max(2) - 1) as f64
}

/// Residuals over the standard deviation of each quantity, then what is said of the transducers.
fn weighed(left: &[Remainder], scales: &[f64]) -> Vec<f64> {
    let values = left.iter().zip(scales);
    let values = values.flat_map(|(left, scale)| left.left.iter().map(move |r| r / scale));
    values.chain(left.iter().flat_map(|left| left.priors.iter().copied())).collect()
}

struct Fitted {
    minimum: Minimum,
    intervals: Vec<Option<Interval>>,
    length: f64,
    variance: f64,
}

impl Fitted {
    /// Derivatives of a list of values at the best parameters, a column a parameter, over half of each interval:
    /// closer by, single events would count for too much. `None` where the list has no value.
    fn derivatives(
        &self,
        problem: &Problem,
        of: impl Fn(&[f64]) -> Option<Vec<f64>>,
    ) -> Option<Vec<Vec<f64>>> {
        let values = problem.parameters(&self.minimum.unit);
        let column = |(index, value): (usize, &f64)| {
            let [least, most] = problem.bounds[index];
            let width = self.intervals[index].map_or(0.0, |i| i.ends[1] - i.ends[0]);
            let step = (0.25 * width).max(LEAST_STEP * (most - least));
            let [from, to] = [value - step, value + step].map(|v| v.clamp(least, most));
            if !(to > from) {
                return None;
            }
            let at = |value: f64| {
                let mut moved = values.clone();
                moved[index] = value;
                of(&moved)
            };
            let (low, high) = (at(from)?, at(to)?);
            Some(low.iter().zip(&high).map(|(low, high)| (high - low) / (to - from)).collect())
        };
        values.iter().enumerate().map(column).collect()
    }
}

/// Intervals of all parameters, from the best minimum that turns up on the way.
fn intervals(problem: &Problem, data: &Data, scales: &[f64], minimum: Minimum) -> Fitted {
    let mut minimum = minimum;
    let count = problem.bounds.len();
    let mut found = Vec::new();
    let (mut length, mut variance) = (1.0, 1.0);
    for _ in 0..MOST_TURNS {
        let values = problem.parameters(&minimum.unit);
        let left = (data.build)(&values).and_then(|model| data.of_model(&model, scales));
        let left = left.unwrap_or_default();
        length = memory(&left);
        // What is said of a transducer is a residual, and it takes one away.
        let unknowns = left.iter().map(|left| left.priors.len()).sum::<usize>();
        let freedom = minimum.count.saturating_sub(count + left.len() + unknowns).max(1) as f64;
        // Without noise the last digits of the size are its standard deviation: less is rounding.
        variance = (minimum.sse / freedom).max(LEAST_VARIANCE);
        let t = student_quantile(0.95, freedom);
        let better: Cell<Option<Minimum>> = Cell::new(None);
        found.clear();
        for index in 0..count {
            match profile(problem, &minimum, index, t * t * length, variance) {
                Profile::Interval(interval) => found.push(Some(interval)),
                Profile::Better(minimum) => {
                    better.set(Some(minimum));
                    break;
                }
            }
        }
        match better.take().and_then(|better| refine(problem, &better.unit)) {
            Some(better) => minimum = better,
            None => break,
        }
    }
    found.resize(count, None);
    Fitted { minimum, intervals: found, length, variance }
}

/// How much better the fit is than a block that cannot slide.
fn evidence(data: &Data, model: &Model, scales: &[f64], found: &Fitted) -> f64 {
    const HOLDS: f64 = 1e6;
    let Ok(friction) = Friction::new(HOLDS, HOLDS) else { return 0.0 };
    let stuck = data.of_model(&model.with_friction(friction), scales);
    let sse: f64 = match stuck {
        Some(left) => weighed(&left, scales).iter().map(|r| r * r).sum(),
        None => return f64::INFINITY,
    };
    (sse - found.minimum.sse) / (found.variance * found.length)
}

/// What a profile says of a parameter.
fn estimate(
    parameter: &Parameter,
    value: f64,
    interval: Option<Interval>,
    kinetic: Option<(f64, bool)>,
    slides: bool,
) -> Estimate {
    let refused = |why: String| Estimate::refused(parameter.path.clone(), parameter.unit, why);
    if !slides {
        return refused(
            "no sliding shows in the record: a block that is stuck fits it as well".to_owned(),
        );
    }
    let Some(Interval { mut ends, open }) = interval else {
        return refused("the fit has several minima that are equally good".to_owned());
    };
    let unit =
        if parameter.unit.is_empty() { String::new() } else { format!(" {}", parameter.unit) };
    let shown = |value: f64| format!("{value:.4e}{unit}");
    let bottom = parameter.natural[0] && kinetic.is_none_or(|(_, told)| told);
    let blocked = [open[0] && !bottom, open[1] && !parameter.natural[1]];
    match blocked {
        _ if open == [true, true] => {
            let why = "every value of its range fits as well";
            return refused(format!("{why}, from {} to {}", shown(ends[0]), shown(ends[1])));
        }
        [true, _] => return refused(format!("values down to {} fit as well", shown(ends[0]))),
        [_, true] => return refused(format!("values up to {} fit as well", shown(ends[1]))),
        _ => {}
    }
    if open[0]
        && let Some((kinetic, _)) = kinetic
    {
        ends[0] = ends[0].max(kinetic).min(value);
    }
    Estimate::determined(parameter.path.clone(), parameter.unit, value, ends)
}

#[cfg(test)]
mod tests;
