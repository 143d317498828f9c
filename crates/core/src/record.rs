//! Record formats: bytes in, `Result` out; one file a format.
//!
//! A reader says what it understood, and refuses what it cannot read with line, column and reason.
//! What a file does not state (units, time step) must be given in [`Options`]; what it states
//! cannot be overruled, but for a step that its rounded times allow. Nothing is guessed in silence:
//! a choice that a reader had to make is a warning.
//!
//! A format is a file here with two functions: `recognises(text)` and `read(text, options)`.

mod delimited;
mod peer;
mod sampling;
mod text;
mod unit;

use crate::error::{MotionError, RecordError};
use crate::motion::GroundMotion;

pub use delimited::{Column, Columns};
pub(crate) use sampling::of_times;
use text::Text;
pub use unit::{Quantity, Units};

/// Formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// PEER NGA, `.AT2`, `.VT2`, `.DT2`.
    Peer,
    /// Columns of numbers: CSV and other text.
    Delimited,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Peer, Self::Delimited];

    /// The word for it in `--format`.
    #[must_use]
    pub fn keyword(self) -> &'static str {
        match self {
            Self::Peer => "peer",
            Self::Delimited => "text",
        }
    }

    /// The format of a keyword.
    #[must_use]
    pub fn from_keyword(keyword: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.keyword() == keyword)
    }
}

/// What the caller knows about a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The format, where it is not to be recognised from the content.
    pub format: Option<Format>,
    /// Units of the values, where the file does not state them.
    pub units: Option<Units>,
    /// Time step in s, where the file does not state it.
    pub dt_s: Option<f64>,
}

/// Something a reader of the record should know: a short stable name and one sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordWarning {
    /// Short stable name, such as `times_rounded`.
    pub kind: &'static str,
    /// One sentence.
    pub message: String,
}

/// When the values of a channel were sampled.
#[derive(Clone, Debug, PartialEq)]
pub enum Sampling {
    /// At equal steps, in s.
    Dt(f64),
    /// At these times in s, which do not decrease; a time that stands twice is a jump.
    Times(Vec<f64>),
}

/// Corner frequencies of the filter that a file says was applied.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilterCorners {
    /// High-pass corner in Hz.
    pub high_pass_hz: Option<f64>,
    /// Low-pass corner in Hz.
    pub low_pass_hz: Option<f64>,
}

/// One component of motion at one place.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// What picks it: the component or the column's name.
    pub name: String,
    /// Earthquake, where stated.
    pub event: Option<String>,
    /// Station, where stated.
    pub station: Option<String>,
    /// Component, where stated.
    pub component: Option<String>,
    /// Azimuth of the positive direction, clockwise from north in degrees, where stated.
    pub azimuth_deg: Option<f64>,
    /// Units as stated by the file or the caller; they say the quantity.
    pub units: Units,
    /// Values in SI: m/s², m/s or m.
    pub values: Vec<f64>,
    /// When.
    pub sampling: Sampling,
    /// Filter, where stated.
    pub filter: FilterCorners,
    /// What to know about this channel.
    pub warnings: Vec<RecordWarning>,
}

/// A file that was understood.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Its format.
    pub format: Format,
    /// The format and its variant in words: `PEER AT2`, `text with 2 columns`.
    pub layout: String,
    /// Its channels, at least one, in the order of the file.
    pub channels: Vec<Channel>,
    /// What to know about the whole file.
    pub warnings: Vec<RecordWarning>,
}

impl Record {
    /// One line on what was understood of a channel: `PEER AT2, 2800 values, 0.005 s, g`.
    #[must_use]
    pub fn describe(&self, channel: &Channel) -> String {
        let sampling = match &channel.sampling {
            Sampling::Dt(dt_s) => format!("{dt_s} s"),
            Sampling::Times(times_s) => {
                let duration_s = times_s.last().zip(times_s.first()).map_or(0.0, |(b, a)| b - a);
                format!("at uneven times over {duration_s} s")
            }
        };
        let Self { layout, .. } = self;
        format!("{layout}, {} values, {sampling}, {}", channel.values.len(), channel.units)
    }

    /// The channel of a name (capital letters or not), else of a number counted from 1.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        let named = self.channels.iter().find(|c| c.name.eq_ignore_ascii_case(name.trim()));
        named.or_else(|| self.channels.get(name.trim().parse::<usize>().ok()?.checked_sub(1)?))
    }
}

impl Channel {
    /// The channel as horizontal ground motion, its clock started at the first sample; `None` for
    /// a channel that is not acceleration.
    ///
    /// # Errors
    /// [`MotionError`] for values in SI that are no motion: too few, too many, or past the range
    /// of numbers.
    pub fn motion(&self) -> Option<Result<GroundMotion, MotionError>> {
        (self.units.quantity() == Quantity::Acceleration).then(|| match &self.sampling {
            Sampling::Dt(dt_s) => GroundMotion::evenly_spaced(*dt_s, self.values.clone(), None),
            Sampling::Times(times_s) => {
                GroundMotion::new(times_s.clone(), self.values.clone(), None)
            }
        })
    }
}

/// Reads a record; `source_name` is the caller's name for the bytes and appears in errors.
///
/// # Errors
/// [`RecordError`] with line and column where the bytes are no text, no format that is read, do
/// not hold what they announce, or need units or a time step that [`Options`] does not give.
pub fn read(source_name: &str, bytes: &[u8], options: &Options) -> Result<Record, RecordError> {
    let text = Text::new(source_name, bytes)?;
    if let Some(dt_s) = options.dt_s
        && !(dt_s.is_finite() && dt_s > 0.0)
    {
        return Err(text.error_at_start("a time step > 0 s given as dt", &format!("{dt_s} s")));
    }
    let format = options.format.unwrap_or_else(|| recognise(&text));
    match format {
        Format::Peer => peer::read(&text, options),
        Format::Delimited => delimited::read(&text, options),
    }
}

/// Reads a table of numbers as it stands: every column with its name, nothing converted.
///
/// The text may be separated and headed as any record of delimited text may be.
///
/// # Errors
/// [`RecordError`] with line and column for what is no table of finite numbers: an empty cell, a
/// word, a row of another length, fewer than two rows.
pub fn columns(source_name: &str, bytes: &[u8]) -> Result<Columns, RecordError> {
    delimited::read_columns(&Text::new(source_name, bytes)?)
}

/// The format of a text; delimited text where no other format knows it.
fn recognise(text: &Text) -> Format {
    if peer::recognises(text) { Format::Peer } else { Format::Delimited }
}

/// Values converted to SI, once.
fn to_si(mut values: Vec<f64>, units: &Units) -> Vec<f64> {
    let factor = units.si();
    if factor != 1.0 {
        values.iter_mut().for_each(|value| *value *= factor);
    }
    values
}

/// What to add where a file does not state its units or its time step.
fn keys_to_add(units: bool, dt: bool) -> String {
    let (what, keys, options) = match (units, dt) {
        (true, true) => (
            "units and time step, which this file does not state",
            r#"units = "g" and dt = "0.01 s""#,
            r#"--units g --dt "0.01 s""#,
        ),
        (true, false) => ("units, which this file does not state", r#"units = "g""#, "--units g"),
        _ => {
            ("a time step, which this file does not state", r#"dt = "0.01 s""#, r#"--dt "0.01 s""#)
        }
    };
    format!("{what}: add {keys} to [motion] (or {options})")
}

#[cfg(test)]
mod tests;
