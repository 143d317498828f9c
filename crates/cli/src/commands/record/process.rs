//! `slipstick record process`: named steps, one after the other.

use std::path::Path;
use std::process::ExitCode;

use slipstick::error::visible;
use slipstick::motion::Series;
use slipstick::motion::processing::{self, Step};
use slipstick::record::{Channel, Record};
use slipstick::units::Dimension;
use slipstick_files::{
    FileError, RecordOptions, Wanted, WrittenFormat, channels, one_channel, open_record,
};

use super::output::Output;
use super::{Many, read_options, refuse};
use crate::args::quantity;
use crate::failure::{Failure, print, say};
use crate::record_args::ProcessArgs;

/// Processes every channel asked for and writes it; the list of steps goes to standard error.
pub fn process(args: &ProcessArgs) -> Result<ExitCode, Failure> {
    let options = read_options(&args.read)?;
    let steps = args.step.iter().map(|text| Step::parse(text));
    let steps: Vec<Step> =
        steps.collect::<Result<_, _>>().map_err(|error| refuse("--step", &error.to_string()))?;
    let before = Before::new(args, &options)?;
    let mut many = Many::find(std::slice::from_ref(&args.input))?;
    if many.files.is_empty() {
        return Ok(many.status());
    }
    let several = many.files.len() > 1;
    let out = args.out.as_deref();
    let mut output = match out {
        Some(out) => Some(Output::new(out, args.to.as_deref(), &many.files)?),
        None if several => {
            return Err(refuse("--out", "expected a folder for what comes of several files"));
        }
        None => None,
    };
    let said: Vec<String> =
        before.words().into_iter().chain(steps.iter().map(Step::to_string)).collect();
    if !args.quiet {
        for (i, step) in said.iter().enumerate() {
            say(format_args!("{}. {step}", i + 1));
        }
    }
    many.each(|path| {
        let record = open_record(path, &options)?;
        let made = made(path, &record, &before, &options, &steps)?;
        let title = title(path, &said);
        if let Some(output) = &mut output {
            return output.write_all(path, &made, &title);
        }
        let [channel] = &made[..] else {
            one_channel(path, &record, None, Wanted::Any)?;
            return Ok(());
        };
        // What CSV holds is text.
        let bytes = WrittenFormat::Csv.bytes(path, channel, &title)?;
        print(&String::from_utf8_lossy(&bytes))
    })?;
    if let Some(output) = output {
        output.commit()?;
    }
    Ok(many.status())
}

/// What a processed file says of itself, in one line.
fn title(path: &Path, said: &[String]) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let name = visible(&name);
    let steps = if said.is_empty() { "no steps".to_owned() } else { said.join("; ") };
    format!("Processed from {name}: {steps}")
}

/// Channels after all steps, each with its labels.
fn made(
    path: &Path,
    record: &Record,
    before: &Before,
    options: &RecordOptions,
    steps: &[Step],
) -> Result<Vec<Channel>, Failure> {
    let started = before.start(path, record, options)?;
    let processed = started.into_iter().map(|(channel, series)| {
        let series = processing::process(&series, steps).map_err(|(index, source)| {
            let step = steps[index].to_string();
            FileError::Processing { path: path.to_owned(), step, source }
        })?;
        Ok(channel.with_series(&series))
    });
    processed.collect()
}

/// What is done with channels before the steps.
enum Before {
    Nothing,
    Combine(Vec<(String, f64)>),
    Rotate { degrees: f64, text: String, second: String, other: Option<Box<(String, Record)>> },
}

impl Before {
    fn new(args: &ProcessArgs, options: &RecordOptions) -> Result<Self, Failure> {
        if !args.combine.is_empty() {
            let part = |text: &String| {
                let (name, factor) = text.rsplit_once('=')?;
                let factor = factor.trim().parse::<f64>().ok().filter(|f| f.is_finite())?;
                Some((name.trim().to_owned(), factor))
            };
            let expected = |text: &String| {
                refuse("--combine", &format!("expected NAME=FACTOR, found {text:?}"))
            };
            let parts = args.combine.iter().map(|text| part(text).ok_or_else(|| expected(text)));
            return Ok(Self::Combine(parts.collect::<Result<_, _>>()?));
        }
        let (Some(angle), Some(second)) = (&args.rotate, &args.second) else {
            return Ok(Self::Nothing);
        };
        let degrees = quantity("--rotate", angle, Dimension::Angle)?.to_degrees();
        // 30 deg became radians and back: the last digits are rounding.
        let degrees = format!("{degrees:.12e}").parse().unwrap_or(degrees);
        let other = args.second_file.as_deref().map(|path| {
            let record = open_record(path, options)?;
            Ok::<_, FileError>(Box::new((path.display().to_string(), record)))
        });
        let (text, second) = (format!("{degrees} deg"), second.clone());
        Ok(Self::Rotate { degrees, text, second, other: other.transpose()? })
    }

    /// In words, for the list of steps.
    fn words(&self) -> Option<String> {
        match self {
            Self::Nothing => None,
            Self::Combine(parts) => {
                let parts = parts.iter().map(|(name, factor)| format!("{factor} * {name}"));
                Some(format!("combine {}", parts.collect::<Vec<_>>().join(" + ")))
            }
            Self::Rotate { text, second, .. } => Some(format!("rotate {text} towards {second}")),
        }
    }

    /// Channels with the samples that the steps start from.
    fn start(
        &self,
        path: &Path,
        record: &Record,
        options: &RecordOptions,
    ) -> Result<Vec<(Channel, Series)>, Failure> {
        let motion = |source| FileError::Motion { path: path.to_owned(), source };
        let series = |channel: &Channel| channel.series().map_err(motion);
        let name = options.channel.as_deref();
        match self {
            Self::Nothing => {
                let chosen = channels(path, record, name, Wanted::Any)?;
                let with = |c: &Channel| Ok((c.clone(), series(c)?));
                chosen.into_iter().map(with).collect()
            }
            Self::Combine(parts) => {
                let mut all = Vec::new();
                for (name, factor) in parts {
                    let channel = one_channel(path, record, Some(name), Wanted::Any)?;
                    all.push((*factor, channel, series(channel)?));
                }
                let sum: Vec<(f64, &Series)> = all.iter().map(|(f, _, s)| (*f, s)).collect();
                let combined = Series::combined(&sum).map_err(motion)?;
                Ok(vec![(relabelled(all[0].1, "combined"), combined)])
            }
            Self::Rotate { degrees, second, other, .. } => {
                let first = one_channel(path, record, name, Wanted::Any)?;
                let second = match other.as_deref() {
                    Some((name, other)) => {
                        one_channel(Path::new(name), other, Some(second), Wanted::Any)?
                    }
                    None => one_channel(path, record, Some(second), Wanted::Any)?,
                };
                let (x, y) = (series(first)?, series(second)?);
                let rotated = Series::rotated(&x, &y, *degrees).map_err(motion)?;
                Ok(vec![(relabelled(first, "rotated"), rotated)])
            }
        }
    }
}

/// A channel that is no longer the component of its labels.
fn relabelled(channel: &Channel, name: &str) -> Channel {
    let (name, component) = (name.to_owned(), Some(name.to_owned()));
    Channel { name, component, azimuth_deg: None, ..channel.clone() }
}
