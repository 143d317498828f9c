//! Records as the `record` commands take them: one file after the other, any of their channels.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use slipstick::error::listed;
use slipstick::record::{
    self, Channel, Format, Options, Quantity, Record, Sampling, Units, write_at2, write_csv,
    write_smc,
};
use slipstick::table::{Cells, Column, Table};

use crate::error::FileError;
use crate::parquet::{self, columns_with_notes};
use crate::read::read_bytes;
use crate::table::to_csv;

/// What the caller says of files that do not say it themselves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordOptions {
    /// The format, where it is not to be recognised.
    pub format: Option<Format>,
    /// Units, where a file does not state them.
    pub units: Option<Units>,
    /// Time step in s, where a file does not state it.
    pub dt_s: Option<f64>,
    /// Name or number (from 1) of the channel; all of them without it.
    pub channel: Option<String>,
}

/// Opens a record.
///
/// # Errors
/// [`FileError`] where the file cannot be read or understood.
pub fn open_record(path: &Path, options: &RecordOptions) -> Result<Record, FileError> {
    let bytes = read_bytes(path)?;
    let RecordOptions { format, units, dt_s, .. } = *options;
    let options = Options { format, units, dt_s };
    understood(path, &bytes, &options)
}

/// What every file of Parquet starts with.
pub(crate) const PARQUET: &[u8] = b"PAR1";

/// The record in the bytes of a file. A table of Parquet is read as CSV with the same columns.
pub(crate) fn understood(
    path: &Path,
    bytes: &[u8],
    options: &Options,
) -> Result<Record, FileError> {
    let name = path.display().to_string();
    if !bytes.starts_with(PARQUET) || options.format.is_some() {
        return Ok(record::read(&name, bytes, options)?);
    }
    let table = parquet::ParquetTable::of(path)?;
    let columns = table.columns(usize::MAX)?;
    let numbers = columns.into_iter().filter(|column| matches!(column.cells, Cells::Numbers(_)));
    let columns = numbers.collect();
    let record = record::read(&name, to_csv(&Table { columns }).as_bytes(), options)?;
    let of = |key: &str| table.note(key).map(str::to_owned);
    let said = |channel| Channel {
        event: of("event"),
        station: of("station"),
        component: of("component"),
        ..channel
    };
    let channels = record.channels.into_iter().map(said).collect();
    Ok(Record { layout: record.layout.replacen("text", "Parquet", 1), channels, ..record })
}

/// Which channels a command can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Any.
    Any,
    /// Those that are acceleration.
    Acceleration,
}

/// The channel that was asked for, else all that are wanted, at least one.
///
/// # Errors
/// [`FileError::Channel`] with the names there are.
pub fn channels<'a>(
    path: &Path,
    record: &'a Record,
    name: Option<&str>,
    wanted: Wanted,
) -> Result<Vec<&'a Channel>, FileError> {
    let fits = |c: &&Channel| wanted == Wanted::Any || c.units.quantity() == Quantity::Acceleration;
    let what = match wanted {
        Wanted::Any => "a channel",
        Wanted::Acceleration => "a channel of acceleration",
    };
    let found: Vec<&Channel> = match name {
        Some(name) => record.channel(name).filter(fits).into_iter().collect(),
        None => record.channels.iter().filter(fits).collect(),
    };
    if !found.is_empty() {
        return Ok(found);
    }
    let expected = name.map_or(what.to_owned(), |name| format!("{what} {name:?}"));
    Err(no_channel(path, record, expected))
}

/// The one channel, or an error that says how to pick one.
///
/// # Errors
/// [`FileError::Channel`].
pub fn one_channel<'a>(
    path: &Path,
    record: &'a Record,
    name: Option<&str>,
    wanted: Wanted,
) -> Result<&'a Channel, FileError> {
    match channels(path, record, name, wanted)?[..] {
        [channel] => Ok(channel),
        [first, ..] => {
            let expected = format!("one channel: add --channel {:?}", first.name);
            Err(no_channel(path, record, expected))
        }
        [] => Err(no_channel(path, record, "a channel".to_owned())),
    }
}

fn no_channel(path: &Path, record: &Record, expected: String) -> FileError {
    let describe = |(i, c): (usize, &Channel)| {
        format!("{} {:?} ({})", i + 1, c.name, c.units.quantity().name())
    };
    let channels = listed(record.channels.iter().enumerate().map(describe));
    FileError::Channel { path: path.to_owned(), expected, channels }
}

/// Formats that are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrittenFormat {
    /// Times and values in SI, all digits.
    Csv,
    /// PEER AT2; VT2 and DT2 for velocity and displacement.
    At2,
    /// USGS SMC.
    Smc,
    /// Times and values in SI as columns of a Parquet table.
    Parquet,
}

impl WrittenFormat {
    /// The format of a file name's ending, capital letters or not.
    #[must_use]
    pub fn of_name(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "csv" | "txt" => Some(Self::Csv),
            "at2" | "vt2" | "dt2" => Some(Self::At2),
            "smc" => Some(Self::Smc),
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }

    /// The ending of a file with this quantity.
    #[must_use]
    pub fn extension(self, quantity: Quantity) -> &'static str {
        match (self, quantity) {
            (Self::Csv, _) => "csv",
            (Self::At2, Quantity::Velocity) => "VT2",
            (Self::At2, Quantity::Displacement) => "DT2",
            (Self::At2, _) => "AT2",
            (Self::Smc, _) => "smc",
            (Self::Parquet, _) => "parquet",
        }
    }

    /// The channel in this format. A `title`, one line or nothing, stands before the columns of
    /// CSV and in the metadata of Parquet; the others have no room for it.
    ///
    /// # Errors
    /// [`FileError::Unwritable`] where the format cannot hold the channel; `path` is for the message.
    pub fn bytes(self, path: &Path, channel: &Channel, title: &str) -> Result<Vec<u8>, FileError> {
        let text = match self {
            Self::Csv => write_csv(channel).map(|text| match title {
                "" => text,
                title => format!("{title}\n{text}"),
            }),
            Self::At2 => write_at2(channel),
            Self::Smc => write_smc(channel),
            Self::Parquet => return table(path, channel, title),
        };
        let unwritable = |source| FileError::Unwritable { path: path.to_owned(), source };
        text.map(String::into_bytes).map_err(unwritable)
    }
}

/// Times and values as a Parquet table; what is known of the channel as its metadata.
fn table(path: &Path, channel: &Channel, title: &str) -> Result<Vec<u8>, FileError> {
    let quantity = channel.units.quantity();
    let unit = match quantity {
        Quantity::Acceleration => "m/s2",
        Quantity::Velocity => "m/s",
        Quantity::Displacement => "m",
        Quantity::Counts => "",
    };
    let times_s = match &channel.sampling {
        Sampling::Dt(dt_s) => (0..channel.values.len()).map(|i| i as f64 * dt_s).collect(),
        Sampling::Times(times_s) => times_s.clone(),
    };
    let columns = [
        Column::numbers("time_s", "s", times_s),
        Column::numbers(quantity.column(), unit, channel.values.clone()),
    ];
    let known = [
        ("event", channel.event.clone()),
        ("station", channel.station.clone()),
        ("component", channel.component.clone()),
        ("processing", (!title.is_empty()).then(|| title.to_owned())),
    ];
    let notes: Vec<(&str, String)> =
        known.into_iter().filter_map(|(key, text)| Some((key, text?))).collect();
    columns_with_notes(path, &columns, &notes)
}

/// Names of files in one folder, none twice: `STEM.csv`, or `STEM-CHANNEL.csv` where a file gives
/// several.
#[derive(Debug, Default)]
pub struct FileNames {
    taken: HashSet<String>,
}

impl FileNames {
    /// The name for what comes from a channel (if it needs to be named) of a file.
    pub fn name(&mut self, source: &Path, channel: Option<&str>, extension: &str) -> PathBuf {
        let stem = source.file_stem().map_or("record".into(), |stem| stem.to_string_lossy());
        let plain = |c: char| if c.is_alphanumeric() || "-_.+".contains(c) { c } else { '_' };
        let stem: String = match channel {
            Some(channel) => format!("{stem}-{}", channel.chars().map(plain).collect::<String>()),
            None => stem.into_owned(),
        };
        let mut name = format!("{stem}.{extension}");
        let mut count = 1;
        // Some file systems do not tell capital letters.
        while !self.taken.insert(name.to_lowercase()) {
            count += 1;
            name = format!("{stem}-{count}.{extension}");
        }
        PathBuf::from(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_never_twice_the_same() {
        let mut names = FileNames::default();
        let mut name = |source: &str, channel| {
            names.name(Path::new(source), channel, "csv").display().to_string()
        };
        assert_eq!(name("a/x.AT2", None), "x.csv");
        assert_eq!(name("b/X.AT2", None), "X-2.csv");
        assert_eq!(name("a/x.v1", Some("CHAN 1: 90°")), "x-CHAN_1__90_.csv");
    }

    #[test]
    fn formats_by_name() {
        for (name, format) in [
            ("a.csv", Some(WrittenFormat::Csv)),
            ("a.AT2", Some(WrittenFormat::At2)),
            ("a.Smc", Some(WrittenFormat::Smc)),
            ("a.parquet", Some(WrittenFormat::Parquet)),
            ("a.xyz", None),
            ("a", None),
        ] {
            assert_eq!(WrittenFormat::of_name(Path::new(name)), format);
        }
    }
}
