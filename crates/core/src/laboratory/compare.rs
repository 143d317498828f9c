//! A prediction driven by the measured table acceleration, against what was measured.

use super::anderson::{Anderson, anderson};
use super::measured::{Measured, MeasuredSeries};
use super::metrics::{self, Russell};
use crate::error::{MotionError, RecordError, SolveError};
use crate::input::Channel;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::notice::{Notice, NoticeKind};
use crate::response::{History, Method, Response};
use crate::solver;
use crate::table::Table;

mod suspicions;
mod within;

pub use suspicions::suspicions;
pub use within::Within;

/// One quantity with its figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// The two histories.
    pub pair: Pair,
    /// What is to be said of them.
    pub metrics: Metrics,
}

/// A prediction beside what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The measured table acceleration, which drove the prediction.
    pub motion: GroundMotion,
    /// The time of the file's clock at which the prediction starts, in s.
    pub start_s: f64,
    /// The prediction.
    pub response: Response,
    /// Every measured quantity that the prediction has, in the order of the file's columns.
    pub compared: Vec<Compared>,
    /// How the two were brought onto the same times.
    pub alignment: String,
    /// What was noticed of file, motion and prediction, and what looks like a wrong unit, sign or
    /// clock.
    pub warnings: Vec<Notice>,
}

/// Why there is nothing to compare.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompareError {
    /// The file has no table acceleration, or nothing that the prediction has too.
    #[error(transparent)]
    Measured(#[from] RecordError),
    /// The table acceleration is no motion.
    #[error("table_acceleration: {0}")]
    Motion(#[from] MotionError),
    /// The prediction has no answer.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

/// Predicts the response of a model to the measured table acceleration and compares.
///
/// The model's own motion and tail play no part; its initial state holds at the first sample of
/// the table acceleration.
///
/// # Errors
/// [`CompareError`] where the file lacks a table acceleration or anything to compare it with, and
/// where the solver finds no answer.
pub fn compare(
    measured: &Measured,
    model: &Model,
    method: Method,
) -> Result<Comparison, CompareError> {
    let (motion, start_s) = table_motion(measured)?;
    let response = solver::solve(model, &motion, method)?;
    let empty = History::default();
    let pairs = pairs(measured, start_s, response.history.as_ref().unwrap_or(&empty));
    if pairs.is_empty() {
        // Any of them would do; the first that a table test measures is asked for.
        measured.require(Channel::BlockAcceleration)?;
    }
    let alignment = alignment(measured, start_s, &pairs);
    let mut warnings = measured.warnings.clone();
    warnings.extend(offsets(&motion, &pairs));
    warnings.extend(response.warnings.iter().cloned());
    let compared: Vec<Compared> = pairs
        .into_iter()
        .map(|pair| {
            let metrics = Metrics::of(&pair);
            Compared { pair, metrics }
        })
        .collect();
    warnings.extend(suspicions(measured, &compared));
    Ok(Comparison { motion, start_s, response, compared, alignment, warnings })
}

impl Comparison {
    /// The figures, one row a quantity, in SI: the unit of those that have the quantity's stands
    /// beside its name.
    #[must_use]
    pub fn table(&self) -> Table {
        let mut table = Table::default();
        let channels = self.compared.iter().map(|c| c.pair.channel);
        table.texts("quantity", channels.clone().map(Channel::name).collect());
        let units = channels.map(|channel| channel.dimension().si_unit().to_owned());
        table.texts("unit", units.collect());
        for Metric { key, unit, value, .. } in &Metrics::ALL {
            let cells = self.compared.iter().map(|c| value(&c.metrics).unwrap_or(f64::NAN));
            table.numbers(key, unit.unwrap_or(""), cells.collect());
        }
        table
    }

    /// Measured and predicted values at their common times, by quantity.
    #[must_use]
    pub fn curves(&self) -> Vec<(String, Table)> {
        let of = |Pair { channel, times_s, measured, predicted, .. }: &Pair| {
            let unit = channel.dimension().si_unit();
            let mut table = Table::default();
            table
                .numbers("time_s", "s", times_s.clone())
                .numbers("measured", unit, measured.clone())
                .numbers("predicted", unit, predicted.clone());
            (channel.name(), table)
        };
        self.compared.iter().map(|compared| of(&compared.pair)).collect()
    }

    /// The figures of a quantity.
    #[must_use]
    pub fn get(&self, channel: Channel) -> Option<&Compared> {
        self.compared.iter().find(|compared| compared.pair.channel == channel)
    }
}

/// One quantity, measured and predicted at the same times.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// What it is.
    pub channel: Channel,
    /// Where the measured values come from.
    pub origin: String,
    /// Times in s, increasing, on the clock of the prediction.
    pub times_s: Vec<f64>,
    /// Measured values in SI.
    pub measured: Vec<f64>,
    /// Predicted values in SI at those times.
    pub predicted: Vec<f64>,
    /// How many of the times are samples of the table acceleration; at the others the prediction
    /// is interpolated between knots.
    pub at_samples: usize,
}

/// What a comparison says of one quantity. Peaks and sums are over the common samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Metrics {
    /// Largest measured absolute value.
    pub measured_peak: f64,
    /// When, in s.
    pub measured_peak_time_s: f64,
    /// Largest predicted absolute value.
    pub predicted_peak: f64,
    /// When, in s.
    pub predicted_peak_time_s: f64,
    /// Predicted over measured peak.
    pub peak_ratio: Option<f64>,
    /// Last measured value.
    pub measured_residual: f64,
    /// Last predicted value.
    pub predicted_residual: f64,
    /// Predicted less measured last value.
    pub residual_error: f64,
    /// Root mean square of the measured values.
    pub measured_rms: f64,
    /// Root mean square of predicted less measured values.
    pub rms_error: f64,
    /// That over the root mean square of the measured values.
    pub normalised_rms_error: Option<f64>,
    /// Pearson's coefficient.
    pub correlation: Option<f64>,
    /// Russell's errors.
    pub russell: Option<Russell>,
    /// Anderson's scores, of accelerations.
    pub anderson: Option<Anderson>,
    /// How much later the measured history comes than the predicted one, in s.
    pub arrival_lag_s: Option<f64>,
    /// The normalised cross-correlation at that lag.
    pub lagged_correlation: Option<f64>,
}

/// A figure of a comparison: one description for tables of columns, JSON, what people read, and bounds.
#[derive(Clone, Copy, Debug)]
pub struct Metric {
    /// Its column in tables and its key in JSON.
    pub key: &'static str,
    /// Its SI unit, empty for a ratio; `None` where it is that of the quantity.
    pub unit: Option<&'static str>,
    /// What the row of it is called; `None` where it has none, or one of its own kind.
    pub title: Option<&'static str>,
    /// What a bound calls it; `None` where there are no bounds on it.
    pub bound: Option<&'static str>,
    /// Its value; `None` where it has none.
    pub value: fn(&Metrics) -> Option<f64>,
}

impl Metric {
    /// One with the unit of the quantity.
    const fn of_quantity(key: &'static str, value: fn(&Metrics) -> Option<f64>) -> Self {
        Self { key, unit: None, title: None, bound: None, value }
    }

    const fn ratio(key: &'static str, value: fn(&Metrics) -> Option<f64>) -> Self {
        Self { unit: Some(""), ..Self::of_quantity(key, value) }
    }

    const fn time(key: &'static str, value: fn(&Metrics) -> Option<f64>) -> Self {
        Self { unit: Some("s"), ..Self::of_quantity(key, value) }
    }

    const fn titled(self, title: &'static str) -> Self {
        Self { title: Some(title), ..self }
    }

    const fn bounded(self, bound: &'static str) -> Self {
        Self { bound: Some(bound), ..self }
    }
}

impl Metrics {
    /// All figures, in their order.
    pub const ALL: [Metric; 18] = [
        Metric::of_quantity("measured_peak", |m| Some(m.measured_peak)).titled("Measured peak"),
        Metric::time("measured_peak_time_s", |m| Some(m.measured_peak_time_s)),
        Metric::of_quantity("predicted_peak", |m| Some(m.predicted_peak)).titled("Predicted peak"),
        Metric::time("predicted_peak_time_s", |m| Some(m.predicted_peak_time_s)),
        Metric::ratio("peak_ratio", |m| m.peak_ratio)
            .titled("Peak ratio (predicted/measured)")
            .bounded("peak_ratio"),
        Metric::of_quantity("measured_residual", |m| Some(m.measured_residual))
            .titled("Measured at the end"),
        Metric::of_quantity("predicted_residual", |m| Some(m.predicted_residual))
            .titled("Predicted at the end"),
        Metric::of_quantity("residual_error", |m| Some(m.residual_error))
            .titled("Error at the end")
            .bounded("residual_error"),
        Metric::of_quantity("measured_rms", |m| Some(m.measured_rms)).titled("RMS, measured"),
        Metric::of_quantity("rms_error", |m| Some(m.rms_error))
            .titled("RMS of the error")
            .bounded("rms_error"),
        Metric::ratio("normalised_rms_error", |m| m.normalised_rms_error)
            .titled("  over the RMS measured")
            .bounded("normalised_rms_error"),
        Metric::ratio("correlation", |m| m.correlation)
            .titled("Correlation")
            .bounded("correlation"),
        Metric::ratio("russell_magnitude", |m| Some(m.russell?.magnitude))
            .titled("Russell: magnitude error")
            .bounded("russell_magnitude"),
        Metric::ratio("russell_phase", |m| Some(m.russell?.phase))
            .titled("Russell: phase error")
            .bounded("russell_phase"),
        Metric::ratio("russell_comprehensive", |m| Some(m.russell?.comprehensive))
            .titled("Russell: comprehensive error")
            .bounded("russell_comprehensive"),
        Metric::ratio(Self::ANDERSON, |m| Some(m.anderson?.mean())).bounded("anderson_whole_band"),
        Metric::time("arrival_lag_s", |m| m.arrival_lag_s)
            .titled("Arrival lag (s)")
            .bounded("arrival_lag"),
        Metric::ratio("correlation_at_lag", |m| m.lagged_correlation),
    ];

    /// The key of the mean of Anderson's scores, in whose place JSON has all of them.
    pub const ANDERSON: &'static str = "anderson_whole_band";

    /// Names of the figures that a bound may be put on.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::ALL.into_iter().filter_map(|figure| figure.bound)
    }

    /// The figure that a bound calls by a name, in SI; `None` where it has no value.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        let figure = Self::ALL.into_iter().find(|figure| figure.bound == Some(name))?;
        (figure.value)(self)
    }

    /// The figures of a pair.
    #[must_use]
    pub fn of(pair: &Pair) -> Self {
        let (m, p, times_s) = (&pair.measured, &pair.predicted, &pair.times_s);
        let ((measured_peak, at_m), (predicted_peak, at_p)) = (metrics::peak(m), metrics::peak(p));
        let ratio = |a: f64, b: f64| (b > 0.0 && (a / b).is_finite()).then(|| a / b);
        let time = |index: usize| times_s.get(index).copied().unwrap_or(0.0);
        let last = |values: &[f64]| values.last().copied().unwrap_or(0.0);
        let measured_rms = metrics::rms(m);
        let rms_error = metrics::rms_error(m, p);
        let is_acceleration = pair.channel.dimension() == crate::units::Dimension::Acceleration;
        let lag = lag(pair);
        Self {
            measured_peak,
            measured_peak_time_s: time(at_m),
            predicted_peak,
            predicted_peak_time_s: time(at_p),
            peak_ratio: ratio(predicted_peak, measured_peak),
            measured_residual: last(m),
            predicted_residual: last(p),
            residual_error: last(p) - last(m),
            measured_rms,
            rms_error,
            normalised_rms_error: ratio(rms_error, measured_rms),
            correlation: metrics::correlation(m, p),
            russell: metrics::russell(m, p),
            anderson: if is_acceleration { anderson(times_s, m, p) } else { None },
            arrival_lag_s: lag.map(|(lag_s, _)| lag_s),
            lagged_correlation: lag.map(|(_, lag)| lag.correlation),
        }
    }
}

/// Largest shift that is looked for, in s, and as a part of the common time.
const LONGEST_LAG: (f64, f64) = (2.0, 0.1);
/// Most products of a cross-correlation; longer ones look for shorter lags.
const MOST_PRODUCTS: usize = 100_000_000;

/// The arrival lag in s, on evenly spaced values.
fn lag(pair: &Pair) -> Option<(f64, metrics::Lag)> {
    let n = pair.times_s.len();
    if n < 3 {
        return None;
    }
    let from_s = pair.times_s[0];
    let dt_s = (pair.times_s[n - 1] - from_s) / (n - 1) as f64;
    let even = |i: usize| (pair.times_s[i] - from_s - i as f64 * dt_s).abs() <= 1e-6 * dt_s;
    let resampled = |values: &[f64]| -> Vec<f64> {
        (0..n).map(|i| linear(&pair.times_s, values, from_s + i as f64 * dt_s)).collect()
    };
    let longest_s = LONGEST_LAG.0.min(LONGEST_LAG.1 * n as f64 * dt_s);
    let most = ((longest_s / dt_s) as usize).clamp(1, (MOST_PRODUCTS / (2 * n)).max(1));
    let lag = if (0..n).all(even) {
        metrics::lag(&pair.measured, &pair.predicted, most)
    } else {
        metrics::lag(&resampled(&pair.measured), &resampled(&pair.predicted), most)
    }?;
    Some((lag.samples * dt_s, lag))
}

/// The ground motion that a measured table acceleration is, and the time in s on the file's clock
/// at which it starts.
///
/// # Errors
/// [`CompareError`] where it is not among the columns, or is no motion.
pub fn table_motion(measured: &Measured) -> Result<(GroundMotion, f64), CompareError> {
    let table = measured.require(Channel::TableAcceleration)?;
    let start_s = table.times_s[0];
    let motion = match measured.dt_s {
        Some(dt_s) => GroundMotion::evenly_spaced(dt_s, table.values.clone(), None),
        None => GroundMotion::new(table.times_s.clone(), table.values.clone(), None),
    };
    Ok((motion?, start_s))
}

/// A motion as a record that needs no keys: `time_s,acceleration_m_per_s2` with 17 digits.
#[must_use]
pub fn table_csv(motion: &GroundMotion) -> String {
    let rows = motion.times_s().iter().zip(motion.horizontal_m_per_s2());
    let rows = rows.map(|(t, a)| format!("{t:.16e},{a:.16e}\n"));
    core::iter::once("time_s,acceleration_m_per_s2\n".to_owned()).chain(rows).collect()
}

/// Measured and predicted values at the measured times, for every measured quantity that a history
/// has; the table acceleration, which drives it, is not among them.
///
/// `start_s` is the time of the file's clock at which the history's clock starts. Measured values
/// outside the history are left out. The prediction is taken at the measured times: at samples and
/// events it is known; between them displacements follow the cubic through displacement and
/// velocity at both ends, all else the straight line. At a jump the limit from the right is taken.
#[must_use]
pub fn pairs(measured: &Measured, start_s: f64, history: &History) -> Vec<Pair> {
    measured.series.iter().filter_map(|series| pair(series, start_s, history)).collect()
}

fn pair(series: &MeasuredSeries, start_s: f64, history: &History) -> Option<Pair> {
    let knots = Knots::of(series.channel, history)?;
    let end_s = history.time_s.last().copied()?;
    // Times of the file are differences of rounded numbers.
    let slack_s = 1e-9 * end_s;
    let mut times_s = Vec::new();
    let (mut measured, mut predicted) = (Vec::new(), Vec::new());
    let mut at_samples = 0;
    let mut knot = 0;
    for (time_s, value) in series.times_s.iter().zip(&series.values) {
        let mut time_s = time_s - start_s;
        if !(-slack_s..=end_s + slack_s).contains(&time_s) {
            continue;
        }
        time_s = time_s.clamp(0.0, end_s);
        // The last knot at or before the time; of those within the slack the nearest, so that an event
        // just after a sample is not yet seen at it.
        let away_s = |knot: usize| (history.time_s[knot] - time_s).abs();
        while knot + 1 < history.len()
            && history.time_s[knot + 1] <= time_s + slack_s
            && (history.time_s[knot + 1] <= time_s || away_s(knot + 1) <= away_s(knot))
        {
            knot += 1;
        }
        if (history.time_s[knot] - time_s).abs() <= slack_s {
            at_samples += 1;
            time_s = history.time_s[knot];
        }
        if times_s.last() == Some(&time_s) {
            // The second row of a jump replaces the first.
            times_s.pop();
            measured.pop();
            predicted.pop();
            at_samples = at_samples.min(times_s.len() + 1);
        }
        times_s.push(time_s);
        measured.push(*value);
        predicted.push(knots.at(knot, time_s));
    }
    (times_s.len() >= 2).then(|| Pair {
        channel: series.channel,
        origin: series.origin.clone(),
        times_s,
        measured,
        predicted,
        at_samples,
    })
}

/// A quantity of a history at times in s that do not decrease, at its ends where they lie outside it; `None`
/// where the history lacks it.
pub(super) fn predicted(channel: Channel, history: &History, times_s: &[f64]) -> Option<Vec<f64>> {
    let knots = Knots::of(channel, history)?;
    let end_s = history.time_s.last().copied()?;
    let mut knot = 0;
    let at = |time_s: &f64| {
        let time_s = time_s.clamp(0.0, end_s);
        while knot + 1 < history.len() && history.time_s[knot + 1] <= time_s {
            knot += 1;
        }
        knots.at(knot, time_s)
    };
    Some(times_s.iter().map(at).collect())
}

/// One quantity of a history at its knots, with its rate where that is stored too.
struct Knots<'a> {
    times_s: &'a [f64],
    values: &'a [f64],
    rates: Option<&'a [f64]>,
    stride: usize,
    first: usize,
}

impl<'a> Knots<'a> {
    fn of(channel: Channel, history: &'a History) -> Option<Self> {
        let plain = |values: &'a [f64], rates: Option<&'a [f64]>| {
            Some(Self { times_s: &history.time_s, values, rates, stride: 1, first: 0 })
        };
        let of_storey = |storey: usize, values: &'a [f64], rates: Option<&'a [f64]>| {
            let (stride, first) = (history.storeys, storey - 1);
            let knots = Self { times_s: &history.time_s, values, rates, stride, first };
            (storey <= history.storeys).then_some(knots)
        };
        let h = history;
        match channel {
            Channel::BlockAcceleration => plain(&h.block_acceleration_m_per_s2, None),
            Channel::SlidingDisplacement => {
                plain(&h.sliding_displacement_m, Some(&h.sliding_velocity_m_per_s))
            }
            Channel::SlidingVelocity => plain(&h.sliding_velocity_m_per_s, None),
            Channel::FrictionForce => plain(&h.friction_force_n, None),
            Channel::StoreyDisplacement(i) => {
                of_storey(i, &h.storey_displacement_m, Some(&h.storey_velocity_m_per_s))
            }
            Channel::StoreyVelocity(i) => of_storey(i, &h.storey_velocity_m_per_s, None),
            Channel::StoreyAcceleration(i) => of_storey(i, &h.storey_acceleration_m_per_s2, None),
            Channel::Time
            | Channel::TableAcceleration
            | Channel::Displacement
            | Channel::Force
            | Channel::Acceleration => None,
        }
    }

    /// The value at a time between a knot and the next.
    fn at(&self, knot: usize, time_s: f64) -> f64 {
        let value = |values: &[f64], knot: usize| values[knot * self.stride + self.first];
        let a = value(self.values, knot);
        let step_s = match self.times_s.get(knot + 1) {
            Some(next_s) if *next_s > self.times_s[knot] => next_s - self.times_s[knot],
            _ => return a,
        };
        let part = (time_s - self.times_s[knot]) / step_s;
        if !(part > 0.0) {
            return a;
        }
        let b = value(self.values, knot + 1);
        let Some(rates) = self.rates else { return a + part * (b - a) };
        let (ra, rb) = (step_s * value(rates, knot), step_s * value(rates, knot + 1));
        // Hermite's cubic.
        let bend = 2.0 * (a - b) + ra + rb;
        let square = 3.0 * (b - a) - 2.0 * ra - rb;
        a + part * (ra + part * (square + part * bend))
    }
}

/// The value at a time between increasing ones, by the straight line.
pub(super) fn linear(times_s: &[f64], values: &[f64], time_s: f64) -> f64 {
    let upper = times_s.partition_point(|t| *t <= time_s);
    if upper == 0 || upper == times_s.len() {
        return if upper == 0 { values[0] } else { values[values.len() - 1] };
    }
    let part = (time_s - times_s[upper - 1]) / (times_s[upper] - times_s[upper - 1]);
    values[upper - 1] + part * (values[upper] - values[upper - 1])
}

/// How the two were brought onto the same times, in a sentence.
#[must_use]
pub fn alignment(measured: &Measured, start_s: f64, pairs: &[Pair]) -> String {
    let step = measured.dt_s.map_or("unevenly spaced".to_owned(), |dt_s| format!("every {dt_s} s"));
    let total: usize = pairs.iter().map(|pair| pair.times_s.len()).sum();
    let at_samples: usize = pairs.iter().map(|pair| pair.at_samples).sum();
    let between = if at_samples == total {
        "all of them samples of the table acceleration, so nothing was interpolated".to_owned()
    } else {
        format!(
            "{at_samples} of {total} of them samples of the table acceleration; between those the \
             prediction was interpolated"
        )
    };
    let start = if start_s == 0.0 {
        String::new()
    } else {
        format!(" The prediction starts at {start_s} s of the file's clock.")
    };
    format!(
        "Measured values stand {step} and were neither filtered nor resampled nor shifted beyond \
         what the mapping says; the prediction was taken at the measured times, {between}.{start}"
    )
}

/// What the measured values themselves give notice of: a table that does not start or end at rest,
/// histories that do not start from zero.
fn offsets(motion: &GroundMotion, pairs: &[Pair]) -> Vec<Notice> {
    let mut warnings = Vec::new();
    let figures = motion.figures();
    if figures.end_velocity_m_per_s.abs() > 0.05 * figures.pgv_m_per_s {
        let message = format!(
            "the measured table acceleration drifts: integrated, the table moves at {:.4} m/s in the \
             end, {:.0} % of its peak; nothing was corrected",
            figures.end_velocity_m_per_s,
            100.0 * figures.end_velocity_m_per_s.abs() / figures.pgv_m_per_s
        );
        warnings.push(Notice::new(NoticeKind::RecordDrift, message).at(motion.duration_s()));
    }
    let table = ("table acceleration".to_owned(), motion.horizontal_m_per_s2());
    let names =
        pairs.iter().map(|pair| (pair.channel.name().replace('_', " "), pair.measured.as_slice()));
    for (name, values) in core::iter::once(table).chain(names) {
        let largest = metrics::peak(values).0;
        let first = values.first().copied().unwrap_or(0.0);
        if first.abs() > 0.05 * largest {
            let share = 100.0 * first / largest;
            let message = format!(
                "the measured {name} starts at {share:.0} % of its peak; nothing was subtracted"
            );
            warnings.push(Notice::new(NoticeKind::DoesNotStartAtZero, message).at(0.0));
        }
    }
    warnings
}

#[cfg(test)]
mod tests;
