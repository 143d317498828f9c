//! What a reader must know of the sensors and of what the fit leaves.

use super::instruments::{Remainder, place};
use super::{Data, Residuals};
use crate::input::Channel;
use crate::laboratory::estimate::{Estimate, Outcome};
use crate::laboratory::metrics::rms;
use crate::notice::{Notice, NoticeKind};
use crate::numerics::fractile::upper_median;

/// What is clear of what chance makes of the residuals, in standard errors.
const CLEAR: f64 = 5.0;
/// Residuals above so many times the stated noise are no noise.
const ABOVE_NOISE: f64 = 1.5;
/// Memory in samples that the noise of sensors and their filters do not have.
const LONG_MEMORY: f64 = 5.0;
/// Least part of the measured root mean square at which such residuals count.
const LEAST_PART: f64 = 0.02;

/// Offsets, and drifts of force cells, that are clear of what chance makes of the residuals.
pub(super) fn of_sensors(left: &[Remainder], data: &Data, length: f64) -> Vec<Notice> {
    let mut all = Vec::new();
    for ((left, series), instrument) in
        left.iter().zip(&data.measured.series).zip(&data.instruments)
    {
        let n = left.left.len() as f64;
        let independent = (n / length).max(2.0);
        let (name, unit) = (series.channel.name(), series.channel.dimension().si_unit());
        let deviation = rms(&left.left);
        let [_, _, offset, _] = left.found;
        let is_of_kind = !matches!(
            series.channel,
            Channel::BlockAcceleration | Channel::StoreyAcceleration(_) | Channel::SlidingVelocity
        );
        if instrument.zero > 0.0
            && is_of_kind
            && offset.abs() > CLEAR * deviation / independent.sqrt()
        {
            let (sign, size) = (if offset < 0.0 { '+' } else { '-' }, offset.abs());
            let message = format!(
                "the sensor of {name} is off by {offset:.4e} {unit}, which was fitted with the rest: \
                 the mapping \"{name}=… {sign} {size:.4e} {unit}\" or \"zero=first 2 s\" states its zero"
            );
            all.push(Notice::new(NoticeKind::SensorOffset, message));
        }
        if series.channel != Channel::FrictionForce || instrument.drift > 0.0 {
            continue;
        }
        // A slope over the record, the time running from −1 to 1.
        let t = |i: usize| place(i, left.left.len());
        let square: f64 = (0..left.left.len()).map(|i| t(i) * t(i)).sum();
        let slope = -left.left.iter().enumerate().map(|(i, r)| t(i) * r).sum::<f64>() / square;
        if slope.abs() > CLEAR * deviation * (length / square).sqrt() {
            all.push(drifts(&name, unit, slope));
        }
    }
    all
}

fn drifts(name: &str, unit: &str, half: f64) -> Notice {
    let message = format!(
        "the measured {name} drifts by {:.4e} {unit} over the record: the zero of the force cell moves",
        2.0 * half
    );
    Notice::new(NoticeKind::ForceDrift, message)
}

/// Gains, lags and drifts that are clear of their nominal values.
pub(super) fn of_instruments(found: &[Estimate]) -> Vec<Notice> {
    let mut said: Vec<String> = Vec::new();
    let mut gains: Vec<[f64; 2]> = Vec::new();
    let mut all = Vec::new();
    for estimate in found {
        let Outcome::Told { value, low, high } = estimate.outcome else { continue };
        let (name, what) = estimate.path.rsplit_once('.').unwrap_or((&estimate.path, ""));
        let nominal = if what == "gain" { 1.0 } else { 0.0 };
        let error = (high - low) / 4.0;
        let is_clear = (value - nominal).abs() > CLEAR * error;
        if !is_clear || what == "zero" {
            continue;
        }
        match what {
            "drift" if name == "friction_force" => all.push(drifts(name, estimate.unit, value)),
            "gain" => {
                gains.push([value, error]);
                said.push(format!("the gain of {name} is {value:.4} ± {:.4}", 2.0 * error));
            }
            "lag" => {
                said.push(format!("{name} is late by {:.2} ± {:.2} ms", 1e3 * value, 2e3 * error))
            }
            _ => said.push(format!(
                "{name} drifts by {:.3e} ± {:.1e} {} over the record",
                2.0 * value,
                4.0 * error,
                estimate.unit
            )),
        }
    }
    if said.is_empty() {
        return all;
    }
    let alike =
        gains.windows(2).all(|g| (g[0][0] - g[1][0]).abs() < 3.0 * libm::hypot(g[0][1], g[1][1]));
    let of_table = if gains.len() > 1 && alike {
        "; all gains are alike, as an accelerometer of the table that is off makes them: friction would be \
         off by as much"
    } else {
        ""
    };
    let message = format!(
        "the sensors are not what they are taken for: {}; that was fitted with the rest{of_table}",
        said.join(", ")
    );
    all.push(Notice::new(NoticeKind::SensorsDiffer, message));
    all
}

/// Residuals that are no noise of sensors.
pub(super) fn of_residuals(residuals: &[Residuals], data: &Data) -> Vec<Notice> {
    let mut all = Vec::new();
    for ((residuals, series), instrument) in
        residuals.iter().zip(&data.measured.series).zip(&data.instruments)
    {
        let (name, unit) = (series.channel.name(), series.channel.dimension().si_unit());
        let left = rms(&residuals.values);
        if let Some(noise) = instrument.noise.filter(|noise| left > ABOVE_NOISE * noise) {
            let message = format!(
                "what the model leaves of {name}, {left:.3e} {unit} in the root mean square, is \
                 {:.1} times the stated noise: the model or the sensor does something that is not fitted, \
                 and the intervals hold only as far as the model does",
                left / noise
            );
            all.push(Notice::new(NoticeKind::ModelMisfit, message));
            continue;
        }
        let middle = upper_median(series.values.iter().copied()).unwrap_or(0.0);
        let moved: Vec<f64> = series.values.iter().map(|value| value - middle).collect();
        let part = left / rms(&moved).max(1e-300);
        if residuals.correlation_length > LONG_MEMORY && part > LEAST_PART {
            let message = format!(
                "what the model leaves of {name}, {:.1} % of its root mean square, is correlated over \
                 {:.0} samples, which noise is not: the model or the sensor does something that is not \
                 fitted, and the intervals hold only as far as the model does; look at the residuals",
                100.0 * part,
                residuals.correlation_length
            );
            all.push(Notice::new(NoticeKind::ModelMisfit, message));
        }
    }
    all
}
