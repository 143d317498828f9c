//! Records that were dropped on the page, by their names.

use slipstick::assessment::single::described;
use slipstick::error::RecordError;
use slipstick::input::loaded::{Components, LoadError, Loaded, Wanted};
use slipstick::input::{self, Analysis, MotionSource, Override, RecordSource};
// Any record by the whole module, columns of numbers by the other: those that the page brings with it.
#[cfg(feature = "whole")]
use slipstick::record::read;
#[cfg(not(feature = "whole"))]
use slipstick::record::read_delimited as read;
use slipstick::record::{Options, Record};
#[cfg(feature = "whole")]
use slipstick::record::{Quantity, Sampling, Units};
#[cfg(feature = "whole")]
use slipstick::units::{Dimension, parse_quantity};
#[cfg(feature = "whole")]
use slipstick_report::json::{each, pretty};
#[cfg(feature = "whole")]
use slipstick_report::view;

use crate::failure::Failure;
use crate::session::MODEL;

/// A file and, once read, what is in it.
struct File {
    name: String,
    bytes: Vec<u8>,
    read: Option<(Options, Record)>,
}

/// All files of a session.
#[derive(Default)]
pub struct Records(Vec<File>);

impl Records {
    /// Keeps a file, in place of one of the same name.
    pub fn add(&mut self, name: &str, bytes: Vec<u8>) {
        self.remove(name);
        self.0.push(File { name: name.to_owned(), bytes, read: None });
    }

    /// Forgets a file.
    pub fn remove(&mut self, name: &str) {
        self.0.retain(|file| file.name != name);
    }

    /// The bytes of a file: of its whole path as the model gives it, else of its name alone.
    pub fn bytes(&self, path: &str) -> Option<&[u8]> {
        self.position(path).map(|i| self.0[i].bytes.as_slice())
    }

    /// The table of modes that a model names.
    pub fn modes(&self, text: &str) -> Result<Vec<Override>, Failure> {
        let read = |path: &str| {
            let table = self.bytes(path).map(String::from_utf8_lossy);
            let missing = || format!("no file named {path} dropped on the page");
            table.map(|table| (path.to_owned(), table.into_owned())).ok_or_else(missing)
        };
        let table = input::modes_beside(MODEL, text, read);
        Ok(table.map_err(|error| Failure::input(&error, text))?.into_iter().collect())
    }

    fn position(&self, path: &str) -> Option<usize> {
        let of = |wanted: &str| self.0.iter().position(|file| file.name == wanted);
        of(path).or_else(|| of(path.rsplit(['/', '\\']).next().unwrap_or(path)))
    }

    /// The record of a file, read once.
    pub fn read(&mut self, path: &str, options: &Options) -> Option<Result<&Record, RecordError>> {
        let position = self.position(path)?;
        let file = &mut self.0[position];
        if file.read.as_ref().is_none_or(|(of, _)| of != options) {
            match read(&file.name, &file.bytes, options) {
                Ok(record) => file.read = Some((options.clone(), record)),
                Err(error) => return Some(Err(error)),
            }
        }
        file.read.as_ref().map(|(_, record)| Ok(record))
    }

    /// The motion that an analysis asks for.
    pub fn motion(&mut self, analysis: &Analysis, text: &str) -> Result<Loaded, Failure> {
        let of_input = |error| Failure::input(&error, text);
        let source = analysis.required_motion().map_err(of_input)?;
        if let MotionSource::Record(record) = source {
            return self.recorded(analysis, record, text);
        }
        let made = described(source).map_err(|e| of_input(analysis.motion_error(&e)))?;
        let none = || of_input(analysis.error_at("motion", "a motion", "none"));
        made.map(|(motion, words)| Loaded::made(motion, words)).ok_or_else(none)
    }

    fn recorded(
        &mut self,
        analysis: &Analysis,
        source: &RecordSource,
        text: &str,
    ) -> Result<Loaded, Failure> {
        let options = Options { format: None, units: source.units, dt_s: source.dt_s };
        let missing = |key: &str, path: &str| {
            let expected = "the file of this record, dropped on the page";
            let error = analysis.error_at(key, expected, format!("none named {path}"));
            Failure::input(&error, text).missing(path)
        };
        let horizontal = self
            .read(&source.path, &options)
            .ok_or_else(|| missing("motion.record", &source.path))?
            .map_err(Failure::of)?
            .clone();
        let along_y = match &source.along_y {
            None => None,
            Some(y) => {
                let options = Options { format: None, units: y.units, dt_s: y.dt_s };
                let record = self.read(&y.path, &options);
                let record = record.ok_or_else(|| missing("motion.record_y", &y.path))?;
                Some((record.map_err(Failure::of)?.clone(), y))
            }
        };
        let vertical = match &source.vertical {
            None => None,
            Some(path) => Some(
                self.read(path, &options)
                    .ok_or_else(|| missing("motion.vertical", path))?
                    .map_err(Failure::of)?,
            ),
        };
        let components = Components {
            horizontal: Wanted { record: &horizontal, channel: source.channel.as_deref() },
            along_y: along_y
                .as_ref()
                .map(|(record, y)| (Wanted { record, channel: y.channel.as_deref() }, y.pair)),
            vertical: vertical.map(|record| {
                (Wanted { record, channel: None }, source.vertical_scale.unwrap_or(1.0))
            }),
        };
        let loaded =
            Loaded::recorded(components, Some(source.scale)).map_err(|error| match &error {
                LoadError::Motion { error, .. } => {
                    Failure::input(&analysis.motion_error(error), text)
                }
                LoadError::Channel { key, .. } => {
                    let key = format!("motion.{}", key.unwrap_or("channel"));
                    Failure::input(&analysis.error_at(&key, error.to_string(), "nothing"), text)
                }
            })?;
        let along_y = source.along_y.as_ref();
        let of_y = along_y.map(|y| (y.path.as_str(), y.channel.as_deref()));
        let x = (source.path.as_str(), source.channel.as_deref());
        Ok(loaded.with_vertical_told(x, of_y))
    }
}

#[cfg(feature = "whole")]
impl Records {
    /// What is in a file: `{layout, plain, upright, channels}`, plain where it needs no more to be a motion, upright where
    /// that motion is vertical.
    pub fn inspect(&mut self, name: &str, units: &str, dt: &str) -> Result<String, Failure> {
        let options = options(units, dt)?;
        let missing = || Failure::of(format!("{name}: expected a file, found none of this name"));
        let record = self.read(name, &options).ok_or_else(missing)?.map_err(Failure::of)?;
        let loaded = Loaded::recorded(Wanted { record, channel: None }, None);
        let plain = loaded.is_ok();
        let upright = loaded.is_ok_and(|loaded| loaded.origin.vertical(name).is_some());
        let channels = each(record.channels.iter().enumerate(), |(i, channel)| {
            let alone = record.channels.iter().filter(|c| c.name == channel.name).count() == 1;
            let quantity = channel.units.quantity();
            view! {
                name: if alone { channel.name.clone() } else { (i + 1).to_string() },
                quantity: quantity.name(),
                usable: quantity == Quantity::Acceleration,
                counts: quantity == Quantity::Counts,
                vertical: channel.is_vertical(),
                values: channel.values.len(),
                dt_s: match channel.sampling {
                    Sampling::Dt(dt_s) => Some(dt_s),
                    Sampling::Times(_) => None,
                },
                words: record.describe(channel),
            }
        });
        Ok(pretty(&view! { layout: &record.layout, plain, upright, channels }))
    }
}

/// Options from what a person writes; nothing where the text is empty.
#[cfg(feature = "whole")]
pub fn options(units: &str, dt: &str) -> Result<Options, Failure> {
    let units = match units.trim() {
        "" => None,
        text => Some(Units::parse(text).ok_or_else(|| {
            Failure::of(format!(
                "units: expected a unit of acceleration, such as g, found {text:?}"
            ))
        })?),
    };
    let dt_s = match dt.trim() {
        "" => None,
        text => Some(
            parse_quantity(text, Dimension::Time)
                .map_err(|error| Failure::of(format!("dt: {error}")))?,
        ),
    };
    Ok(Options { format: None, units, dt_s })
}
