//! Where the table's motion comes from.

use super::reader::{LeafValue, Values};
use crate::error::{InputError, MotionError};
use crate::motion::{GroundMotion, Pulse, PulseShape, Sine, Sweep, SweepKind};
use crate::record::Units;

/// How the table moves, before any record is opened.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionSource {
    /// A recorded motion.
    Record(RecordSource),
    /// A sine of constant frequency.
    Sine(Sine),
    /// A sine along x and one along y, turned.
    Sines {
        /// Along x and along y.
        sines: [Sine; 2],
        /// Angle by which both are turned, x towards y, in rad.
        rotate_rad: f64,
    },
    /// A sine whose frequency changes.
    Sweep(Sweep),
    /// A single pulse.
    Pulse(Pulse),
}

impl MotionSource {
    /// The key by which the table moves in two horizontal directions, if it does.
    #[must_use]
    pub fn key_of_y(&self) -> Option<&'static str> {
        match self {
            Self::Record(record) => record.along_y.as_ref().map(|_| "motion.record_y"),
            Self::Sines { .. } => Some("motion.sine_y"),
            _ => None,
        }
    }

    /// The motion that it makes, without its tail; `None` for a record.
    ///
    /// # Errors
    /// [`MotionError`] for one that cannot be.
    pub fn made(&self) -> Result<Option<GroundMotion>, MotionError> {
        Ok(Some(match self {
            Self::Record(_) => return Ok(None),
            Self::Sine(sine) => sine.motion()?,
            Self::Sines { sines: [x, y], rotate_rad } => {
                let (motion, _) = x.motion()?.with_along_y(&y.motion()?)?;
                motion.turned(1.0, *rotate_rad)?
            }
            Self::Sweep(sweep) => sweep.motion()?,
            Self::Pulse(pulse) => pulse.motion()?,
        }))
    }
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
    /// The motion along y, where the table moves in two horizontal directions.
    pub along_y: Option<RecordAlongY>,
}

impl RecordSource {
    /// What it is called: the stem of its file, of two components both.
    #[must_use]
    pub fn name(&self) -> String {
        let x = stem(&self.path);
        self.along_y.as_ref().map_or(x.to_owned(), |y| format!("{x} + {}", stem(&y.path)))
    }
}

/// The name of a file without its folders and its ending.
///
/// ```
/// use slipstick::input::stem;
/// assert_eq!(stem("far-field/RSN15.A.AT2"), "RSN15.A");
/// assert_eq!(stem(r"records\kern"), "kern");
/// assert_eq!(stem(".hidden"), ".hidden");
/// ```
#[must_use]
pub fn stem(path: &str) -> &str {
    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
    name.rsplit_once('.').map_or(name, |(stem, _)| if stem.is_empty() { name } else { stem })
}

/// The record of the motion along y; what it does not say is as of the record along x.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordAlongY {
    /// Its path as written, relative to the model file.
    pub path: String,
    /// Unit of its values.
    pub units: Option<Units>,
    /// Its time step in s.
    pub dt_s: Option<f64>,
    /// Which of its channels, by name or by number from 1.
    pub channel: Option<String>,
    /// How the pair is put together.
    pub pair: PairOf,
}

/// How two horizontal components make a motion, after the scale that both have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairOf {
    /// Factor on the component along y.
    pub scale_y: f64,
    /// Angle by which both are turned, x towards y, in rad.
    pub rotate_rad: f64,
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
    let rotate_rad = values.number("motion.rotate");
    if rotate_rad.is_some() && !in_plane(values) {
        return Err(only_in_plane(values, "motion.rotate"));
    }
    let source = if values.has("motion.record") {
        MotionSource::Record(record(values))
    } else if values.has("motion.sine_y") {
        let sines = [sine(values, "motion.sine")?, sine(values, "motion.sine_y")?];
        MotionSource::Sines { sines, rotate_rad: rotate_rad.unwrap_or(0.0) }
    } else if values.has("motion.sine") {
        MotionSource::Sine(sine(values, "motion.sine")?)
    } else if values.has("motion.sweep") {
        MotionSource::Sweep(sweep(values)?)
    } else if values.has("motion.pulse") {
        MotionSource::Pulse(pulse(values)?)
    } else {
        return Ok(None);
    };
    Ok(Some(source))
}

/// Whether the table moves in two horizontal directions.
pub(super) fn in_plane(values: &Values) -> bool {
    values.in_plane || values.has("motion.record_y") || values.has("motion.sine_y")
}

/// The error for a key that means something in two horizontal directions alone.
pub(super) fn only_in_plane(values: &Values, path: &str) -> InputError {
    let expected = "a motion in two directions, motion.record_y or motion.sine_y, of which this is";
    values.error(path, expected, "a motion in one")
}

fn record(values: &Values) -> RecordSource {
    let text = |path| values.text(path).map(str::to_owned);
    let channel = |path| values.leaf(path).map(|leaf| leaf.written.clone());
    let units = |path| {
        values.leaf(path).and_then(|leaf| match leaf.given {
            // As written, perhaps with the value of one count before it.
            LeafValue::Unit(unit) => {
                Units::parse(&leaf.written).or_else(|| Units::parse(unit.name()))
            }
            _ => None,
        })
    };
    let scale = match values.number("motion.scale_to") {
        Some(peak) => Scale::Peak(peak),
        None => Scale::Factor(values.number("motion.scale").unwrap_or(1.0)),
    };
    RecordSource {
        path: text("motion.record").unwrap_or_default(),
        units: units("motion.units"),
        dt_s: values.number("motion.dt"),
        channel: channel("motion.channel"),
        scale,
        vertical: text("motion.vertical"),
        vertical_scale: values.number("motion.vertical_scale"),
        along_y: text("motion.record_y").map(|path| RecordAlongY {
            path,
            units: units("motion.units_y").or(units("motion.units")),
            dt_s: values.number("motion.dt_y").or(values.number("motion.dt")),
            channel: channel("motion.channel_y"),
            pair: PairOf {
                scale_y: values.number("motion.scale_y").unwrap_or(1.0),
                rotate_rad: values.number("motion.rotate").unwrap_or(0.0),
            },
        }),
    }
}

fn sine(values: &Values, table: &str) -> Result<Sine, InputError> {
    let key = |name: &str| format!("{table}.{name}");
    Ok(Sine {
        frequency_hz: values.required(&key("frequency"))?,
        amplitude_m_per_s2: values.required(&key("amplitude"))?,
        duration_s: values.required(&key("duration"))?,
        dt_s: values.required(&key("dt"))?,
        phase_rad: values.number(&key("phase")).unwrap_or(0.0),
        ramp_s: values.number(&key("ramp")).unwrap_or(0.0),
        decay_s: values.number(&key("decay")).unwrap_or(0.0),
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
        Some(MotionSource::Sine(_) | MotionSource::Sines { .. }) => "motion.sine",
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
