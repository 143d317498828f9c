//! What transducers do to what they measure, as part of the model that is fitted.
//!
//! A transducer of gain `G` whose clock is late by `l`, that is off by `z` and drifts by `d` from the middle
//! of the record to its end, shows of the quantity `y`
//!
//! ```text
//! m(t) = G y(t − l) + z + d τ(t),    −1 ≤ τ ≤ 1 over the record
//! ```
//!
//! Each of the four has a normal distribution about its nominal value (1, 0, 0, 0). About a lag `l₀` that is
//! found beforehand the model is linear in `G, z, d` and, over small distances, in the rest of the lag,
//!
//! ```text
//! G y(t − l) = G y(t − l₀) − G δ y'(t − l₀),    l = l₀ + δ
//! ```
//!
//! so that the best four follow from the response by linear least squares, whatever the model's parameters:
//! what is left of the measured values is a function of those alone (variable projection; Golub and Pereyra,
//! SIAM J. Numer. Anal. 10, 1973), and the intervals of its profile include what is not known of the transducers.

use crate::error::{ChoiceError, cut};
use crate::input::Channel;
use crate::laboratory::measured::MeasuredSeries;
use crate::laboratory::metrics;
use crate::numerics::algebra::inverse;
use crate::units::{Dimension, parse_quantity};

/// Unknowns of a transducer: gain, rest of the lag times the gain, zero, drift.
const UNKNOWNS: usize = 4;
/// Usual standard deviation of a gain.
const USUAL_GAIN: f64 = 0.05;
/// Usual standard deviation of a lag in s.
const USUAL_LAG_S: f64 = 0.02;
/// What changes by so many standard deviations of the noise about a sample jumps there.
const AT_JUMP: f64 = 4.0;
/// Usual standard deviation of a drift, over the peak of the quantity.
const USUAL_DRIFT: f64 = 0.02;

/// What is not known of a transducer: standard deviations about its nominal values, 0 for what is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instrument {
    /// Of its gain, 1.
    pub gain: f64,
    /// Of the time in s by which its clock is late.
    pub lag_s: f64,
    /// Of its zero, in SI.
    pub zero: f64,
    /// Of its drift from the middle of the record to its end, in SI.
    pub drift: f64,
    /// Standard deviation of its noise in SI, where it is stated.
    pub noise: Option<f64>,
}

/// What of a transducer something is said of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    Gain,
    Lag,
    Zero,
    Drift,
    Noise,
}

impl What {
    const ALL: [(Self, &'static str); 5] = [
        (Self::Gain, "gain"),
        (Self::Lag, "lag"),
        (Self::Zero, "zero"),
        (Self::Drift, "drift"),
        (Self::Noise, "noise"),
    ];
}

/// One statement: of a quantity, or of all, with a standard deviation as it was written.
#[derive(Clone, Debug, PartialEq)]
struct Said {
    text: String,
    channel: Option<Channel>,
    what: What,
    deviation: String,
}

/// What is said of the transducers of a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Instruments {
    exact: bool,
    said: Vec<Said>,
}

impl Instruments {
    /// Transducers of which only the zero of displacements and forces may not be known.
    #[must_use]
    pub fn exact() -> Self {
        Self { exact: true, said: Vec::new() }
    }

    /// Reads what is said of them: `exact`, or `[QUANTITY.]gain=2 %`, `lag=10 ms`, `zero=0.1 mm`, `drift=1 mm`,
    /// `noise=0.05 m/s2`, each a standard deviation, 0 for what is known. What is not said of is as usual: a
    /// gain within 5 %, a lag within 20 ms, a drift within 2 % of the peak, any zero that the mapping does not
    /// state; of the table's accelerometer, which drives the model, nothing but its noise.
    ///
    /// # Errors
    /// [`ChoiceError`] for what is none of these.
    pub fn parse(texts: &[&str]) -> Result<Self, ChoiceError> {
        let mut all = Self::default();
        for text in texts {
            if text.trim() == "exact" {
                all.exact = true;
                continue;
            }
            let fault = |expected: String, found: &str| ChoiceError {
                what: format!("instrument {}", cut(text)),
                expected,
                found: format!("{found:?}"),
                nearest: None,
            };
            let form =
                || "exact, or QUANTITY.gain=2 %, .lag=10 ms, .zero=, .drift= or .noise=".to_owned();
            let (name, deviation) = text.split_once('=').ok_or_else(|| fault(form(), text))?;
            let (quantity, word) = match name.trim().rsplit_once('.') {
                Some((quantity, word)) => (Some(quantity), word),
                None => (None, name.trim()),
            };
            let what = What::ALL.into_iter().find(|(_, known)| *known == word);
            let (what, _) = what.ok_or_else(|| fault(form(), word))?;
            let known = "a quantity such as sliding_displacement or block_acceleration";
            let channel = quantity.map(|quantity| {
                Channel::parse(quantity).ok_or_else(|| fault(known.to_owned(), quantity))
            });
            let channel = channel.transpose()?;
            let needs_quantity = matches!(what, What::Zero | What::Drift | What::Noise);
            if needs_quantity && channel.is_none() {
                return Err(fault(format!("{known} before .{word}"), name));
            }
            if channel == Some(Channel::TableAcceleration) && what != What::Gain {
                let expected = "table_acceleration.gain: the other quantities have their lag, and a tilt \
                                its zero";
                return Err(fault(expected.to_owned(), name));
            }
            let said = Said {
                text: (*text).to_owned(),
                channel,
                what,
                deviation: deviation.trim().to_owned(),
            };
            // Its unit is that of the quantity.
            said.deviation_in(channel.unwrap_or(Channel::BlockAcceleration))?;
            all.said.push(said);
        }
        Ok(all)
    }

    /// What is not known of the transducer of a quantity.
    ///
    /// # Errors
    /// [`ChoiceError`] as [`Instruments::parse`].
    pub(super) fn of(&self, series: &MeasuredSeries) -> Result<Instrument, ChoiceError> {
        let peak = metrics::peak(&series.values).0;
        let by_kind = matches!(
            series.channel,
            Channel::SlidingDisplacement | Channel::StoreyDisplacement(_) | Channel::FrictionForce
        );
        let free_zero = !series.zero_known && (by_kind || !self.exact);
        let zero = if free_zero { 10.0 * peak } else { 0.0 };
        let mut found = match self.exact {
            true => Instrument { gain: 0.0, lag_s: 0.0, zero, drift: 0.0, noise: None },
            false => Instrument {
                gain: USUAL_GAIN,
                lag_s: USUAL_LAG_S,
                zero,
                drift: USUAL_DRIFT * peak,
                noise: None,
            },
        };
        let applies = |said: &&Said| said.channel.is_none_or(|channel| channel == series.channel);
        for said in self.said.iter().filter(applies) {
            let deviation = said.deviation_in(series.channel)?;
            match said.what {
                What::Gain => found.gain = deviation,
                What::Lag => found.lag_s = deviation,
                What::Zero => found.zero = deviation,
                What::Drift => found.drift = deviation,
                What::Noise => found.noise = Some(deviation),
            }
        }
        Ok(found)
    }

    /// Standard deviation of the gain of the table's accelerometer; 0 where nothing is said of it.
    ///
    /// # Errors
    /// [`ChoiceError`] as [`Instruments::parse`].
    pub(super) fn table_gain(&self) -> Result<f64, ChoiceError> {
        let table = Channel::TableAcceleration;
        let said = self.said.iter().rfind(|s| s.channel == Some(table) && s.what == What::Gain);
        said.map_or(Ok(0.0), |said| said.deviation_in(table))
    }
}

impl Said {
    /// The standard deviation in SI.
    fn deviation_in(&self, channel: Channel) -> Result<f64, ChoiceError> {
        let fault = |expected: String| ChoiceError {
            what: format!("instrument {}", cut(&self.text)),
            expected,
            found: format!("{:?}", self.deviation),
            nearest: None,
        };
        let value = match self.what {
            What::Gain => {
                let (number, unit) = match self.deviation.strip_suffix('%') {
                    Some(number) => (number.trim(), 0.01),
                    None => (self.deviation.as_str(), 1.0),
                };
                let number = number.parse::<f64>().ok().map(|number| number * unit);
                number.ok_or_else(|| fault("a ratio such as 2 %".to_owned()))?
            }
            What::Lag => {
                parse_quantity(&self.deviation, Dimension::Time).map_err(|e| fault(e.expected))?
            }
            What::Zero | What::Drift | What::Noise => {
                parse_quantity(&self.deviation, channel.dimension())
                    .map_err(|e| fault(e.expected))?
            }
        };
        if value.is_finite() && value >= 0.0 {
            Ok(value)
        } else {
            Err(fault("a standard deviation ≥ 0".to_owned()))
        }
    }
}

/// What the model says that a transducer sees, at the measured times less its lag `l₀`.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    /// The quantity.
    pub values: Vec<f64>,
    /// Its rate; empty where the lag is known.
    pub rates: Vec<f64>,
    /// Its least and largest value about each of the times, as near as a jump is known in time; empty where
    /// nothing jumps.
    pub about: Vec<[f64; 2]>,
}

/// What is left of the values of one transducer at the best of its unknowns.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Remainder {
    /// Predicted less measured, in SI.
    pub left: Vec<f64>,
    /// The unknowns less their nominal values, over their standard deviations.
    pub priors: Vec<f64>,
    /// The unknowns: `G`, `G δ` in s, `z` and `d` in SI.
    pub found: [f64; UNKNOWNS],
}

/// The place of a sample in its record, from −1 to 1.
pub(super) fn place(index: usize, count: usize) -> f64 {
    2.0 * index as f64 / (count.max(2) - 1) as f64 - 1.0
}

impl Instrument {
    /// The regressors of the unknowns at a sample.
    pub(super) fn regressors(seen: &Seen, index: usize) -> [f64; UNKNOWNS] {
        let rate = seen.rates.get(index).copied().unwrap_or(0.0);
        [seen.values[index], -rate, 1.0, place(index, seen.values.len())]
    }

    /// Nominal values of the unknowns about a lag `l₀`, and their standard deviations.
    pub(super) fn nominal(&self, lag_s: f64) -> [[f64; 2]; UNKNOWNS] {
        [[1.0, self.gain], [-lag_s, self.lag_s], [0.0, self.zero], [0.0, self.drift]]
    }

    /// The best unknowns of measured values with noise of some standard deviation. `weight` is by how much
    /// the squares of the priors count: as many samples as one independent one is worth.
    ///
    /// At a jump one sample stands before or behind it: whichever value of both, or between them, is nearest to the
    /// measured one is taken.
    pub(super) fn remainder(
        &self,
        seen: &Seen,
        measured: &[f64],
        lag_s: f64,
        noise: f64,
        weight: f64,
    ) -> Option<Remainder> {
        let first = self.linear(seen, measured, lag_s, noise, weight)?;
        let jumps = |[low, high]: &[f64; 2]| high - low > AT_JUMP * noise;
        if !(first.found[0] > 0.1) || !seen.about.iter().any(jumps) {
            return Some(first);
        }
        let mut nearest = seen.clone();
        for (index, about) in seen.about.iter().enumerate().filter(|(_, about)| jumps(about)) {
            let value = seen.values[index];
            // Predicted less measured, so that what was measured is this far from the prediction.
            let shown = value - first.left[index] / first.found[0];
            nearest.values[index] = shown.clamp(about[0], about[1]);
            if let Some(rate) = nearest.rates.get_mut(index) {
                *rate = 0.0;
            }
        }
        self.linear(&nearest, measured, lag_s, noise, weight)
    }

    /// The best unknowns by linear least squares.
    fn linear(
        &self,
        seen: &Seen,
        measured: &[f64],
        lag_s: f64,
        noise: f64,
        weight: f64,
    ) -> Option<Remainder> {
        let nominal = self.nominal(lag_s);
        // A quantity that stays 0 tells no gain and no lag: they stay nominal, which changes nothing.
        let shows =
            |k: usize| (0..measured.len()).any(|index| Self::regressors(seen, index)[k] != 0.0);
        let unknown: Vec<usize> =
            (0..UNKNOWNS).filter(|k| nominal[*k][1] > 0.0 && shows(*k)).collect();
        // What is known counts beside the unknowns.
        let base = [if unknown.contains(&0) { 0.0 } else { 1.0 }, 0.0, 0.0, 0.0];
        let count = unknown.len();
        let mut normal = vec![vec![0.0; count]; count];
        let mut right = vec![0.0; count];
        for (index, value) in measured.iter().enumerate() {
            let x = Self::regressors(seen, index);
            let fixed: f64 = base.iter().zip(x).map(|(b, x)| b * x).sum();
            for (i, a) in unknown.iter().enumerate() {
                right[i] += x[*a] * (value - fixed);
                for (j, b) in unknown.iter().enumerate() {
                    normal[i][j] += x[*a] * x[*b];
                }
            }
        }
        for (i, a) in unknown.iter().enumerate() {
            let [value, deviation] = nominal[*a];
            let counts = weight * (noise / deviation) * (noise / deviation);
            normal[i][i] += counts;
            right[i] += counts * value;
        }
        let mut found = base;
        if count > 0 {
            let scale: Vec<f64> = (0..count).map(|i| normal[i][i].sqrt()).collect();
            let scaled = |(i, row): (usize, &Vec<f64>)| {
                row.iter().zip(&scale).map(|(v, s)| v / (s * scale[i])).collect::<Vec<f64>>()
            };
            let inverted = inverse(&normal.iter().enumerate().map(scaled).collect())?;
            for (i, a) in unknown.iter().enumerate() {
                let of = |j: usize| inverted[i][j] * right[j] / (scale[i] * scale[j]);
                found[*a] = (0..count).map(of).sum();
            }
        }
        let left = measured.iter().enumerate().map(|(index, value)| {
            let x = Self::regressors(seen, index);
            found.iter().zip(x).map(|(b, x)| b * x).sum::<f64>() - value
        });
        let prior = |k: &usize| {
            let [value, deviation] = nominal[*k];
            weight.sqrt() * (found[*k] - value) / deviation
        };
        let priors = (0..UNKNOWNS).filter(|k| nominal[*k][1] > 0.0).map(|k| {
            // Always as many, whatever shows.
            if unknown.contains(&k) { prior(&k) } else { 0.0 }
        });
        let priors = priors.collect();
        Some(Remainder { left: left.collect(), priors, found })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A gain, a lag, a zero and a drift of a transducer without noise are found.
    #[test]
    fn closed_form_of_a_transducer() {
        let y = |t: f64| libm::sin(7.0 * t) + 0.3 * libm::cos(3.0 * t);
        let rate = |t: f64| 7.0 * libm::cos(7.0 * t) - 0.9 * libm::sin(3.0 * t);
        let times: Vec<f64> = (0..500).map(|i| 0.01 * f64::from(i)).collect();
        let [gain, lag_s, zero, drift] = [1.03, 1e-4, 0.2, -0.05];
        let shown = times
            .iter()
            .enumerate()
            .map(|(i, t)| gain * y(t - 0.012 - lag_s) + zero + drift * place(i, times.len()));
        let shown: Vec<f64> = shown.collect();
        let seen = Seen {
            values: times.iter().map(|t| y(t - 0.012)).collect(),
            rates: times.iter().map(|t| rate(t - 0.012)).collect(),
            about: Vec::new(),
        };
        let wide = Instrument { gain: 1.0, lag_s: 1.0, zero: 10.0, drift: 10.0, noise: None };
        let found = wide.remainder(&seen, &shown, 0.012, 1e-6, 1.0).unwrap();
        for (found, truth) in found.found.iter().zip([gain, gain * lag_s, zero, drift]) {
            assert!((found - truth).abs() < 1e-5, "{found} {truth}");
        }
        assert!(found.left.iter().all(|r| r.abs() < 1e-6));
        // What is known stays as it is.
        let exact = Instrument { gain: 0.0, lag_s: 0.0, zero: 0.0, drift: 0.0, noise: None };
        let found = exact.remainder(&seen, &shown, 0.0, 1e-6, 1.0).unwrap();
        assert_eq!(found.found, [1.0, 0.0, 0.0, 0.0]);
        assert!((found.left[3] - (seen.values[3] - shown[3])).abs() < 1e-15);
    }

    #[test]
    fn what_is_said_of_transducers() {
        let series = |channel| MeasuredSeries {
            channel,
            origin: String::new(),
            times_s: vec![0.0, 1.0],
            values: vec![0.0, 2.0],
            zero_known: false,
        };
        let block = series(Channel::BlockAcceleration);
        let usual = Instruments::default().of(&block).unwrap();
        assert_eq!([usual.gain, usual.lag_s, usual.zero, usual.drift], [0.05, 0.02, 20.0, 0.04]);
        assert_eq!(Instruments::exact().of(&block).unwrap().zero, 0.0);
        let said = ["gain=1 %", "block_acceleration.lag=0 s", "block_acceleration.noise=0.05 m/s2"];
        let found = Instruments::parse(&said).unwrap();
        let of_block = found.of(&block).unwrap();
        assert_eq!([of_block.gain, of_block.lag_s], [0.01, 0.0]);
        assert_eq!(of_block.noise, Some(0.05));
        assert_eq!(found.of(&series(Channel::SlidingDisplacement)).unwrap().lag_s, 0.02);
        for (text, part) in [
            ("gain", "exact, or QUANTITY.gain"),
            ("block.gain=1 %", "a quantity such as"),
            ("gain=x", "a ratio such as 2 %"),
            ("drift=1 mm", "before .drift"),
            ("sliding_displacement.drift=1 s", "length"),
            ("table_acceleration.lag=1 s", "table_acceleration.gain"),
            ("gain=-1 %", "≥ 0"),
        ] {
            let error = Instruments::parse(&[text]).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
