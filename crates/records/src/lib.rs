#![doc = include_str!("../README.md")]
//!
//! # How it is built
//!
//! One file a format: bytes in, `Result` out.
//!
//! A reader says what it understood, and refuses what it cannot read with line, column and reason.
//! What a file does not state (units, time step) must be given in [`Options`]; what it states
//! cannot be overruled, but for a step that its rounded times allow. Nothing is guessed in silence:
//! a choice that a reader had to make is a warning.
//!
//! A format is a file here with two functions: `recognises(text)` and `read(text, options)`; one of
//! binary files has `recognises_bytes` and `read_bytes`, which are asked first.

mod asa;
mod bhrc;
mod bytes;
mod component;
mod cosmos;
mod csmip;
mod csmnc;
mod cwa;
mod decimal;
mod delimited;
mod dyna;
mod fixed;
mod geonet;
mod itaca;
mod jma;
mod keys;
mod knet;
mod miniseed;
mod nsmn;
mod origin;
mod peer;
mod quality;
mod renadic;
mod sac;
mod sampling;
mod seismosignal;
mod smc;
mod text;
mod unit;
mod usc;
mod volume;
mod write;

use std::collections::BTreeMap;

use slipstick_dynamics::error::{MotionError, RecordError};
use slipstick_dynamics::motion::target::TargetSpectrum;
use slipstick_dynamics::motion::{GroundMotion, MAX_STEP_S, Series};
use slipstick_dynamics::notice::Notice;

pub use delimited::bracket;
pub use delimited::texts::{TextCell, TextRows, cell_ranges, separator_of};
pub use delimited::{Column, Columns};
pub use origin::Origin;
pub use quality::judged;
pub use quality::{REST_KINDS, beyond_earthquakes, rest};
pub use sampling::of_times;
use text::Text;
pub use text::packed;
pub use unit::{Quantity, Units};
pub use write::{write_at2, write_csv, write_smc};

/// Formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// PEER NGA, `.AT2`, `.VT2`, `.DT2`.
    Peer,
    /// CSMIP volumes, `.V1`, `.V2`.
    Csmip,
    /// COSMOS 1.x, `.V0c`, `.V1c`, `.V2c`.
    Cosmos,
    /// USGS SMC, `.smc`.
    Smc,
    /// USC and Caltech volumes, `.m0a`, `.s0a`.
    Usc,
    /// RENADIC of Chile, `.v1`.
    Renadic,
    /// BHRC of Iran, `.V1`.
    Bhrc,
    /// Text exported by SeismoSignal.
    SeismoSignal,
    /// K-NET and KiK-net, Japan: `.EW`, `.NS`, `.UD`, `.EW1`, …
    Knet,
    /// JMA, the Japan Meteorological Agency: `.csv`.
    Jma,
    /// DYNA of ESM, ITACA and AFAD: `.ASC`, `.asc`.
    Dyna,
    /// Older ITACA and SISMA: `.acc`.
    Itaca,
    /// NSMN, the old network of Turkey: `.txt`.
    Nsmn,
    /// GeoNet, New Zealand: `.V1A`, `.V2A`.
    GeoNet,
    /// UNAM, Mexico: ASA 2.0.
    Asa,
    /// CSMNC, China: `.dat`.
    Csmnc,
    /// CWA, Taiwan: `.dat`, `.txt`.
    Cwa,
    /// SAC, binary and alphanumeric.
    Sac,
    /// MiniSEED 2 and 3.
    MiniSeed,
    /// Columns of numbers: CSV and other text.
    Delimited,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 20] = [
        Self::Peer,
        Self::Csmip,
        Self::Cosmos,
        Self::Smc,
        Self::Usc,
        Self::Renadic,
        Self::Bhrc,
        Self::SeismoSignal,
        Self::Knet,
        Self::Jma,
        Self::Dyna,
        Self::Itaca,
        Self::Nsmn,
        Self::GeoNet,
        Self::Asa,
        Self::Csmnc,
        Self::Cwa,
        Self::Sac,
        Self::MiniSeed,
        Self::Delimited,
    ];

    /// The word for it in `--format`.
    #[must_use]
    pub fn keyword(self) -> &'static str {
        match self {
            Self::Peer => "peer",
            Self::Csmip => "csmip",
            Self::Cosmos => "cosmos",
            Self::Smc => "smc",
            Self::Usc => "usc",
            Self::Renadic => "renadic",
            Self::Bhrc => "bhrc",
            Self::SeismoSignal => "seismosignal",
            Self::Knet => "knet",
            Self::Jma => "jma",
            Self::Dyna => "dyna",
            Self::Itaca => "itaca",
            Self::Nsmn => "nsmn",
            Self::GeoNet => "geonet",
            Self::Asa => "asa",
            Self::Csmnc => "csmnc",
            Self::Cwa => "cwa",
            Self::Sac => "sac",
            Self::MiniSeed => "miniseed",
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
    pub warnings: Vec<Notice>,
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
    pub warnings: Vec<Notice>,
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

    /// The channel of a name (capital letters or not), else of a name without its unit in brackets
    /// if only one has it, else of a number counted from 1.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        let name = name.trim();
        let named = self.channels.iter().find(|c| c.name.eq_ignore_ascii_case(name));
        let bare = || {
            let mut alike = self.channels.iter().filter(|channel| {
                bracket(&channel.name).is_some_and(|(bare, _)| bare.eq_ignore_ascii_case(name))
            });
            alike.next().filter(|_| alike.next().is_none())
        };
        let numbered = || self.channels.get(name.parse::<usize>().ok()?.checked_sub(1)?);
        named.or_else(bare).or_else(numbered)
    }
}

impl Channel {
    /// Whether it is a vertical component by what its file or its own name says.
    #[must_use]
    pub fn is_vertical(&self) -> bool {
        origin::is_vertical_channel(self)
    }

    /// The same channel with other samples in it, in SI: what processing makes of it.
    #[must_use]
    pub fn with_series(&self, series: &Series) -> Self {
        let sampling = match series.dt_s() {
            Some(dt_s) => Sampling::Dt(dt_s),
            None => Sampling::Times(series.times_s().to_vec()),
        };
        let units = Units::si_of(series.quantity());
        Self { units, values: series.values().to_vec(), sampling, ..self.clone() }
    }

    /// The channel, whatever it measures, as samples in SI whose clock starts at the first.
    ///
    /// # Errors
    /// [`MotionError`] for samples that are too few, too many, or past the range of numbers.
    pub fn series(&self) -> Result<Series, MotionError> {
        let quantity = self.units.quantity();
        match &self.sampling {
            Sampling::Dt(dt_s) => Series::evenly_spaced(*dt_s, self.values.clone(), quantity),
            Sampling::Times(times_s) => Series::new(times_s.clone(), self.values.clone(), quantity),
        }
    }

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
    let mut record = match binary(bytes, options) {
        Some(Format::Sac) => sac::read_bytes(source_name, bytes, options),
        Some(_) => miniseed::read_bytes(source_name, bytes, options),
        None => read_text(&Text::new(source_name, &text::decoded(bytes))?, options),
    }?;
    distinct(&mut record.channels);
    record.channels.iter_mut().for_each(quality::inspect);
    Ok(record)
}

/// [`read`] of delimited text, which is not asked whether another format knows it.
///
/// # Errors
/// As [`read`].
pub fn read_delimited(
    source_name: &str,
    bytes: &[u8],
    options: &Options,
) -> Result<Record, RecordError> {
    let bytes = text::decoded(bytes);
    let text = Text::new(source_name, &bytes)?;
    given(&text, options)?;
    let mut record = delimited::read(&text, options)?;
    distinct(&mut record.channels);
    record.channels.iter_mut().for_each(quality::inspect);
    Ok(record)
}

/// The format of binary bytes: the one asked for, else the one that knows them.
fn binary(bytes: &[u8], options: &Options) -> Option<Format> {
    match options.format {
        Some(Format::MiniSeed) => Some(Format::MiniSeed),
        // Its other form is text.
        Some(Format::Sac) | None if sac::recognises_bytes(bytes) => Some(Format::Sac),
        None if miniseed::recognises_bytes(bytes) => Some(Format::MiniSeed),
        _ => None,
    }
}

/// Refuses a time step that is none.
fn given(text: &Text, options: &Options) -> Result<(), RecordError> {
    if let Some(dt_s) = options.dt_s
        && !(dt_s.is_finite() && dt_s > 0.0)
    {
        return Err(text.error_at_start("a time step > 0 s given as dt", &format!("{dt_s} s")));
    }
    if let Some(dt_s) = options.dt_s
        && dt_s > MAX_STEP_S
    {
        let expected = "a time step of at most 1000 s given as dt";
        return Err(text.error_at_start(expected, &format!("{dt_s} s")));
    }
    Ok(())
}

fn read_text(text: &Text, options: &Options) -> Result<Record, RecordError> {
    given(text, options)?;
    match options.format.unwrap_or_else(|| recognise(text)) {
        Format::Peer => peer::read(text, options),
        Format::Csmip => csmip::read(text, options),
        Format::Cosmos => cosmos::read(text, options),
        Format::Smc => smc::read(text, options),
        Format::Usc => usc::read(text, options),
        Format::Renadic => renadic::read(text, options),
        Format::Bhrc => bhrc::read(text, options),
        Format::SeismoSignal => seismosignal::read(text, options),
        Format::Knet => knet::read(text, options),
        Format::Jma => jma::read(text, options),
        Format::Dyna => dyna::read(text, options),
        Format::Itaca => itaca::read(text, options),
        Format::Nsmn => nsmn::read(text, options),
        Format::GeoNet => geonet::read(text, options),
        Format::Asa => asa::read(text, options),
        Format::Csmnc => csmnc::read(text, options),
        Format::Cwa => cwa::read(text, options),
        Format::Sac => sac::read(text, options),
        // Read as bytes.
        Format::MiniSeed => Err(text.error_at_start("MiniSEED", "text")),
        Format::Delimited => delimited::read(text, options),
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
    delimited::read_columns(&Text::new(source_name, &text::decoded(bytes))?)
}

/// Reads a table whose cells are texts: a header of names, then rows as long.
///
/// # Errors
/// [`RecordError`] for bytes that are no text, no header, and a row of another length.
pub fn text_rows(source_name: &str, bytes: &[u8]) -> Result<TextRows, RecordError> {
    delimited::texts::read(&Text::new(source_name, &text::decoded(bytes))?)
}

/// Reads a target spectrum: a table with a column of periods and one of spectral accelerations.
///
/// # Errors
/// [`RecordError`] for what is no such table, an acceleration without a unit, periods that do not rise
/// and accelerations that are not above 0.
pub fn target_spectrum(source_name: &str, bytes: &[u8]) -> Result<TargetSpectrum, RecordError> {
    delimited::read_target(&Text::new(source_name, &text::decoded(bytes))?)
}

/// Numbers the channels that share a name, so that a name picks one channel or none.
fn distinct(channels: &mut [Channel]) {
    let mut seen: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for channel in channels.iter() {
        seen.entry(channel.name.to_ascii_lowercase()).or_default().0 += 1;
    }
    for channel in channels {
        let entry = seen.get_mut(&channel.name.to_ascii_lowercase());
        if let Some((2.., number)) = entry {
            *number += 1;
            channel.name.push_str(&format!(" ({number})"));
        }
    }
}

/// What tells whether a text is of a format.
type Recognises = fn(&Text) -> bool;

/// The formats that a text may be, the surest signs first.
const TEXT_FORMATS: [(Format, Recognises); 18] = [
    (Format::Cosmos, cosmos::recognises),
    (Format::Smc, smc::recognises),
    // USC, RENADIC and GeoNet write volumes much as CSMIP does.
    (Format::Usc, usc::recognises),
    (Format::Renadic, renadic::recognises),
    (Format::Bhrc, bhrc::recognises),
    (Format::GeoNet, geonet::recognises),
    (Format::Csmip, csmip::recognises),
    (Format::SeismoSignal, seismosignal::recognises),
    (Format::Knet, knet::recognises),
    (Format::Jma, jma::recognises),
    (Format::Dyna, dyna::recognises),
    (Format::Itaca, itaca::recognises),
    (Format::Nsmn, nsmn::recognises),
    (Format::Asa, asa::recognises),
    (Format::Csmnc, csmnc::recognises),
    (Format::Cwa, cwa::recognises),
    (Format::Sac, sac::recognises),
    (Format::Peer, peer::recognises),
];

/// The format of a text; delimited text where no other format knows it.
fn recognise(text: &Text) -> Format {
    let known = TEXT_FORMATS.iter().find(|(_, recognises)| recognises(text));
    known.map_or(Format::Delimited, |(format, _)| *format)
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

/// The same for a file of counts, or of values whose units are not known.
fn counts_to_add() -> String {
    let keys = keys_to_add(true, false);
    format!("{keys}; of counts the value of one, such as \"4.67e-6 m/s2\"")
}

#[cfg(test)]
mod tests;
