//! Where the table's motion comes from.

use super::reader::{Given, Values};
use crate::error::{InputError, MotionError};
use crate::motion::{Pulse, PulseShape, Sine, Sweep, SweepKind};
use crate::record::Units;

/// How the table moves, before any record is opened.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionSource {
    /// A recorded motion.
    Record(RecordSource),
    /// A sine of constant frequency.
    Sine(Sine),
    /// A sine whose frequency changes.
    Sweep(Sweep),
    /// A single pulse.
    Pulse(Pulse),
}

/// A file of a recorded motion and what the file does not say of itself.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordSource {
    /// Its path as written, relative to the model file.
    pub path: String,
    /// Unit of its values.
    pub units: Option<Units>,
    /// Its time step in s.
    pub dt_s: Option<f64>,
    /// Which of its channels, by name or by number from 1.
    pub channel: Option<String>,
    /// How it is scaled.
    pub scale: Scale,
    /// Path of the vertical motion; it takes the factor of the horizontal one.
    pub vertical: Option<String>,
    /// Factor on `vertical` besides that of the horizontal motion; 1 where `None`.
    pub vertical_scale: Option<f64>,
}

/// How a record is scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Times a factor, perhaps negative; 1 by default.
    Factor(f64),
    /// To this peak acceleration in m/s².
    Peak(f64),
}

/// The motion that the checked values describe, if any.
pub(super) fn motion(values: &Values) -> Result<Option<MotionSource>, InputError> {
    let source = if values.has("motion.record") {
        MotionSource::Record(record(values))
    } else if values.has("motion.sine") {
        MotionSource::Sine(sine(values)?)
    } else if values.has("motion.sweep") {
        MotionSource::Sweep(sweep(values)?)
    } else if values.has("motion.pulse") {
        MotionSource::Pulse(pulse(values)?)
    } else {
        return Ok(None);
    };
    Ok(Some(source))
}

fn record(values: &Values) -> RecordSource {
    let text = |path| values.text(path).map(str::to_owned);
    let channel = values.leaf("motion.channel").map(|leaf| leaf.written.clone());
    let units = values.leaf("motion.units").and_then(|leaf| match leaf.given {
        // As written, perhaps with the value of one count before it.
        Given::Unit(unit) => Units::parse(&leaf.written).or_else(|| Units::parse(unit.name())),
        _ => None,
    });
    let scale = match values.number("motion.scale_to") {
        Some(peak) => Scale::Peak(peak),
        None => Scale::Factor(values.number("motion.scale").unwrap_or(1.0)),
    };
    RecordSource {
        path: text("motion.record").unwrap_or_default(),
        units,
        dt_s: values.number("motion.dt"),
        channel,
        scale,
        vertical: text("motion.vertical"),
        vertical_scale: values.number("motion.vertical_scale"),
    }
}

fn sine(values: &Values) -> Result<Sine, InputError> {
    Ok(Sine {
        frequency_hz: values.required("motion.sine.frequency")?,
        amplitude_m_per_s2: values.required("motion.sine.amplitude")?,
        duration_s: values.required("motion.sine.duration")?,
        dt_s: values.required("motion.sine.dt")?,
        phase_rad: values.number("motion.sine.phase").unwrap_or(0.0),
        ramp_s: values.number("motion.sine.ramp").unwrap_or(0.0),
        decay_s: values.number("motion.sine.decay").unwrap_or(0.0),
    })
}

fn sweep(values: &Values) -> Result<Sweep, InputError> {
    let kind = match values.text("motion.sweep.kind") {
        Some("logarithmic") => SweepKind::Logarithmic,
        _ => SweepKind::Linear,
    };
    Ok(Sweep {
        from_hz: values.required("motion.sweep.from")?,
        to_hz: values.required("motion.sweep.to")?,
        kind,
        amplitude_m_per_s2: values.required("motion.sweep.amplitude")?,
        duration_s: values.required("motion.sweep.duration")?,
        dt_s: values.required("motion.sweep.dt")?,
        ramp_s: values.number("motion.sweep.ramp").unwrap_or(0.0),
        decay_s: values.number("motion.sweep.decay").unwrap_or(0.0),
    })
}

fn pulse(values: &Values) -> Result<Pulse, InputError> {
    let shape = match values.text("motion.pulse.shape") {
        Some("rectangular") => PulseShape::Rectangular,
        Some("triangular") => PulseShape::Triangular,
        _ => PulseShape::HalfSine,
    };
    Ok(Pulse {
        shape,
        amplitude_m_per_s2: values.required("motion.pulse.amplitude")?,
        duration_s: values.required("motion.pulse.duration")?,
        start_s: values.number("motion.pulse.start").unwrap_or(0.0),
        dt_s: values.required("motion.pulse.dt")?,
    })
}

/// What a motion's maker objects to, at the key that caused it.
pub(super) fn error(
    values: &Values,
    source: Option<&MotionSource>,
    error: &MotionError,
) -> InputError {
    let table = match source {
        Some(MotionSource::Sine(_)) => "motion.sine",
        Some(MotionSource::Sweep(_)) => "motion.sweep",
        Some(MotionSource::Pulse(_)) => "motion.pulse",
        Some(MotionSource::Record(_)) => "motion.record",
        None => "motion",
    };
    // A quantity's name starts with that of its key: "ramp + decay in s".
    let of_key = |quantity: &str| {
        let key = quantity.split([' ', '_']).next().unwrap_or_default();
        let paths = [format!("{table}.{key}"), format!("motion.{key}"), format!("analysis.{key}")];
        paths.into_iter().find(|path| values.has(path)).unwrap_or_else(|| table.to_owned())
    };
    match error {
        MotionError::OutOfRange { quantity, expected, found } => {
            values.error(&of_key(quantity), format!("{quantity} {expected}"), found.to_string())
        }
        MotionError::TooLong { found } => {
            let expected = "at most 100 000 000 samples";
            values.error(&of_key("dt"), expected, format!("{found:.1e}"))
        }
        MotionError::ZeroPeak => {
            let expected = "a record that is not zero throughout";
            values.error("motion.scale_to", expected, "a peak of 0 m/s²")
        }
        other => values.error(table, "a ground motion", other.to_string()),
    }
}
