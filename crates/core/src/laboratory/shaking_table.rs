//! Parameters of a model from a shaking-table record: those with which the exact response meets the
//! measured histories best.
//!
//! The residuals of each quantity are taken over their own standard deviation, which is estimated
//! from them. Parameters are sought from a seeded global start (see [`super::fit`]); intervals are
//! those of profile likelihood for residuals that are normal, of one variance a quantity, and whose
//! memory is as long as measured: the rise of the sum of squares that is allowed is multiplied by
//! their correlation length.
//!
//! A sensor of displacement or force whose zero is not stated may be off by any constant: that is
//! fitted with the rest. The table acceleration drives the model, so its noise, and what happens
//! between its samples, move the estimates and widen the intervals (`drive`).

mod drive;
mod parameter;

use core::cell::Cell;

pub use parameter::{Builder, Parameter};

use super::compare::{self, CompareError, Comparison};
use super::estimate::{Estimate, correlation_length};
use super::fit::{Interval, Minimum, Problem, Profile, global, profile, refine};
use super::measured::{Measured, MeasuredSeries};
use super::metrics::rms;
use crate::error::{RecordError, Stopped};
use crate::input::Channel;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::notice::{Notice, NoticeKind};
use crate::numerics::distribution::student_quantile;
use crate::response::Method;
use crate::slider::Friction;
use crate::solver;
use crate::study::engine::Engine;

/// How much better than stuck a sliding response must fit before anything is said of the slider, in
/// variances.
const CLEAR_SLIDING: f64 = 25.0;
/// How often a profile may turn up a better fit and start anew.
const MOST_TURNS: usize = 20;
/// Residuals that each parameter must have.
const LEAST_RESIDUALS: usize = 10;

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
    /// Standard deviation of the noise of the table acceleration, in m/s².
    pub table_noise_m_per_s2: f64,
    /// What a reader must know.
    pub warnings: Vec<Notice>,
}

/// Why nothing was fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
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
    let free: Vec<bool> = chosen.series.iter().map(has_free_zero).collect();
    let runs = Cell::new(0);
    let (build, measured) = (test.build, &chosen);
    let data = Data { motion: &motion, start_s, measured, free, build, engine, runs };
    let count = test.parameters.len() as u64;
    engine.plan(RUNS.iter().sum::<u64>() * count);
    let known = |stage: usize| engine.replan(RUNS[stage] * count, data.runs.take());
    let names = || {
        let names: Vec<&str> = test.parameters.iter().map(|p| p.path.as_str()).collect();
        names.join(", ")
    };
    let no_response = || TableError::NoResponse { parameters: names() };
    let bounds: Vec<[f64; 2]> = test.parameters.iter().map(|p| [p.low, p.high]).collect();
    // First each quantity over its own size, then over what the fit leaves of it.
    let mut scales: Vec<f64> = chosen.series.iter().map(|s| rms(&s.values).max(1e-300)).collect();
    let mut minimum: Option<Minimum> = None;
    for _ in 0..4 {
        let residuals = |p: &[f64]| data.residuals(p, &scales);
        let problem = Problem { bounds: bounds.clone(), residuals: &residuals };
        let found = match &minimum {
            None => global(&problem, test.start.as_deref(), test.seed),
            Some(minimum) => refine(&problem, &minimum.unit),
        };
        let found = found.ok_or_else(no_response)?;
        let expected = LEAST_RESIDUALS * bounds.len();
        if found.count < expected {
            let found = found.count;
            return Err(TableError::TooShort { parameters: names(), expected, found });
        }
        let values = problem.parameters(&found.unit);
        let left = data.by_quantity(&values).ok_or_else(no_response)?;
        let next: Vec<f64> = left
            .iter()
            .zip(&chosen.series)
            // A fit without noise is weighed by the last digits of the size.
            .map(|(left, series)| rms(left).max(1e-9 * rms(&series.values)).max(1e-300))
            .collect();
        let settled = next.iter().zip(&scales).all(|(a, b)| (a / b - 1.0).abs() < 0.01);
        minimum = Some(found);
        scales = next;
        if settled {
            break;
        }
    }
    known(0);
    let residuals = |p: &[f64]| data.residuals(p, &scales);
    let problem = Problem { bounds, residuals: &residuals };
    let minimum = minimum.and_then(|minimum| refine(&problem, &minimum.unit));
    let mut found = intervals(&problem, &data, minimum.ok_or_else(no_response)?);
    known(1);
    let table_noise_m_per_s2 = drive::noise(&motion);
    drive::widen(&mut found, &problem, &data, &scales, table_noise_m_per_s2, test.seed);
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
    let estimates = estimates.collect();
    let comparison = compare::compare(test.measured, &model, Method::Exact)?;
    let noise = chosen.series.iter().map(|s| s.channel).zip(scales.iter().copied()).collect();
    let raw = data.of_motion(&model, &motion).ok_or_else(no_response)?;
    let offsets: Vec<(Channel, f64)> = raw
        .iter()
        .zip(&chosen.series)
        .zip(&data.free)
        .filter(|(_, free)| **free)
        .map(|((left, series), _)| (series.channel, -mean(left)))
        .collect();
    let mut warnings = warnings(&raw, &chosen, &offsets, found.length);
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
        table_noise_m_per_s2,
        warnings,
    })
}

/// Whether the zero of a sensor is to be fitted.
fn has_free_zero(series: &MeasuredSeries) -> bool {
    let by_kind = matches!(
        series.channel,
        Channel::SlidingDisplacement | Channel::StoreyDisplacement(_) | Channel::FrictionForce
    );
    by_kind && !series.zero_known
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Offsets and drifts that are clear of what chance makes of the residuals.
fn warnings(
    raw: &[Vec<f64>],
    measured: &Measured,
    offsets: &[(Channel, f64)],
    length: f64,
) -> Vec<Notice> {
    const CLEAR: f64 = 5.0;
    let mut all = Vec::new();
    for (left, series) in raw.iter().zip(&measured.series) {
        let n = left.len() as f64;
        let independent = (n / length).max(2.0);
        let (name, unit) = (series.channel.name(), series.channel.dimension().si_unit());
        let middle = mean(left);
        let deviation = (left.iter().map(|r| (r - middle) * (r - middle)).sum::<f64>() / n).sqrt();
        let offset = offsets.iter().find(|(channel, _)| *channel == series.channel);
        if let Some((_, offset)) = offset
            && offset.abs() > CLEAR * deviation / independent.sqrt()
        {
            let message = format!(
                "the sensor of {name} is off by {offset:.4e} {unit}, which was fitted with the rest: \
                 the mapping \"{name}=… - {offset:.4e} {unit}\" or \"zero=first 2 s\" states its zero"
            );
            all.push(Notice::new(NoticeKind::SensorOffset, message));
        }
        if series.channel != Channel::FrictionForce {
            continue;
        }
        // A slope over the record, the time running from −1 to 1.
        let t = |i: usize| 2.0 * i as f64 / (n - 1.0) - 1.0;
        let square: f64 = (0..left.len()).map(|i| t(i) * t(i)).sum();
        let slope = -left.iter().enumerate().map(|(i, r)| t(i) * r).sum::<f64>() / square;
        if slope.abs() > CLEAR * deviation * (length / square).sqrt() {
            let message = format!(
                "the measured {name} drifts by {:.4e} {unit} over the record: the zero of the force \
                 cell moves",
                2.0 * slope
            );
            all.push(Notice::new(NoticeKind::ForceDrift, message));
        }
    }
    all
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
    /// Of which quantities the zero is fitted.
    free: Vec<bool>,
    build: &'a dyn Fn(&[f64]) -> Option<Model>,
    engine: &'a Engine<'a>,
    /// Runs that were not yet told of to those who wait.
    runs: Cell<u64>,
}

/// Runs that the search, the intervals and the draws of the table's noise are thought to take for each
/// parameter, for those who wait.
const RUNS: [u64; 3] = [200, 600, 2000];

impl Data<'_> {
    /// Predicted less measured values, a list a quantity, in SI; less their mean where the zero of the
    /// sensor is fitted, which is its best value.
    fn of_model(&self, model: &Model) -> Option<Vec<Vec<f64>>> {
        Some(centred(self.of_motion(model, self.motion)?, &self.free))
    }

    /// Predicted less measured values under a motion.
    fn of_motion(&self, model: &Model, motion: &GroundMotion) -> Option<Vec<Vec<f64>>> {
        self.engine.done(1).ok()?;
        self.runs.set(self.runs.get() + 1);
        let response = solver::exact(model, motion).ok()?;
        let pairs = compare::pairs(self.measured, self.start_s, response.history.as_ref()?);
        let all = pairs.len() == self.measured.series.len();
        let left = |pair: &compare::Pair| {
            pair.predicted.iter().zip(&pair.measured).map(|(p, m)| p - m).collect()
        };
        all.then(|| pairs.iter().map(left).collect())
    }

    fn by_quantity(&self, parameters: &[f64]) -> Option<Vec<Vec<f64>>> {
        self.of_model(&(self.build)(parameters)?)
    }

    fn residuals(&self, parameters: &[f64], scales: &[f64]) -> Option<Vec<f64>> {
        let lists = self.by_quantity(parameters)?;
        Some(weighed(&lists, scales))
    }
}

/// Residuals less their mean where the zero of the sensor is fitted.
fn centred(mut lists: Vec<Vec<f64>>, free: &[bool]) -> Vec<Vec<f64>> {
    for (list, _) in lists.iter_mut().zip(free).filter(|(_, free)| **free) {
        let mean = mean(list);
        list.iter_mut().for_each(|r| *r -= mean);
    }
    lists
}

fn weighed(lists: &[Vec<f64>], scales: &[f64]) -> Vec<f64> {
    let weigh =
        |(list, scale): (&Vec<f64>, &f64)| list.iter().map(|r| r / scale).collect::<Vec<f64>>();
    lists.iter().zip(scales).flat_map(weigh).collect()
}

struct Fitted {
    minimum: Minimum,
    intervals: Vec<Option<Interval>>,
    length: f64,
    variance: f64,
}

/// Intervals of all parameters, from the best minimum that turns up on the way.
fn intervals(problem: &Problem, data: &Data, minimum: Minimum) -> Fitted {
    let mut minimum = minimum;
    let count = problem.bounds.len();
    let mut found = Vec::new();
    let (mut length, mut variance) = (1.0, 1.0);
    for _ in 0..MOST_TURNS {
        let values = problem.parameters(&minimum.unit);
        let lists = data.by_quantity(&values).unwrap_or_default();
        let lengths = lists.iter().map(|list| correlation_length(list));
        length = lengths.fold(1.0, f64::max);
        let zeros = data.free.iter().filter(|free| **free).count();
        let freedom = minimum.count.saturating_sub(count + lists.len() + zeros).max(1) as f64;
        variance = (minimum.sse / freedom).max(1e-24);
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
    let stuck = data.of_model(&model.with_friction(friction));
    let sse: f64 = match stuck {
        Some(lists) => weighed(&lists, scales).iter().map(|r| r * r).sum(),
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
