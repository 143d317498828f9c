//! `slipstick record convert`, and where converted and processed records go.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::error::listed;
use slipstick::record::Channel;
use slipstick_files::{
    FileNames, OutputFolder, Wanted, WrittenFormat, channels, open_record, refuse_inputs,
    write_whole,
};

use super::{Many, read_options, refuse};
use crate::failure::Failure;
use crate::record_args::ConvertArgs;

/// Writes every channel asked for in another format.
pub fn convert(args: &ConvertArgs) -> Result<ExitCode, Failure> {
    let options = read_options(&args.read)?;
    let mut many = Many::find(std::slice::from_ref(&args.input))?;
    if many.files.is_empty() {
        return Ok(many.status());
    }
    let mut output = Output::new(&args.output, args.to.as_deref(), &many.files)?;
    many.each(|path| {
        let record = open_record(path, &options)?;
        let chosen = channels(path, &record, options.channel.as_deref(), Wanted::Any)?;
        output.write_all(path, &chosen, "")
    })?;
    output.commit()?;
    Ok(many.status())
}

/// One file, or a folder of them.
pub struct Output {
    format: WrittenFormat,
    target: Target,
}

enum Target {
    File(PathBuf),
    Folder { folder: OutputFolder, names: FileNames },
}

impl Output {
    /// Where `out` is a folder that stands there, ends in a separator, or there are several inputs,
    /// a folder; else a file.
    pub fn new(out: &Path, to: Option<&str>, inputs: &[PathBuf]) -> Result<Self, Failure> {
        let ends_as_folder = out.as_os_str().to_string_lossy().ends_with(['/', '\\']);
        let nameless = to.is_some() && out.extension().is_none();
        let is_folder = inputs.len() > 1 || out.is_dir() || ends_as_folder || nameless;
        let format = written_format(to, (!is_folder).then_some(out))?;
        let target = if is_folder {
            let folder = OutputFolder::create(out, inputs)?;
            Target::Folder { folder, names: FileNames::default() }
        } else {
            refuse_inputs(out, inputs)?;
            Target::File(out.to_owned())
        };
        Ok(Self { format, target })
    }

    /// Writes channels that come from one file; `title` says in one line what was done to them.
    pub fn write_all<C: std::borrow::Borrow<Channel>>(
        &mut self,
        path: &Path,
        channels: &[C],
        title: &str,
    ) -> Result<(), Failure> {
        let format = self.format;
        let bytes = |channel: &Channel| format.bytes(path, channel, title);
        match &mut self.target {
            Target::File(file) => match channels {
                [one] => Ok(write_whole(file, &bytes(one.borrow())?)?),
                _ => {
                    let names = channels.iter().map(|c| format!("{:?}", c.borrow().name));
                    Err(Failure::Message(format!(
                        "{}: expected one channel for one file: add --channel, or name a folder \
                         (channels: {})",
                        path.display(),
                        listed(names)
                    )))
                }
            },
            Target::Folder { folder, names } => {
                // All of a file or nothing of it.
                let each = channels.iter().map(|c| bytes(c.borrow()));
                let all = each.collect::<Result<Vec<_>, _>>()?;
                for (channel, bytes) in channels.iter().zip(all) {
                    let channel = channel.borrow();
                    let named = (channels.len() > 1).then_some(channel.name.as_str());
                    let extension = format.extension(channel.units.quantity());
                    let name = names.name(path, named, extension);
                    folder.write(&name.to_string_lossy(), &bytes)?;
                }
                Ok(())
            }
        }
    }

    /// Gives files of a folder their names.
    pub fn commit(self) -> Result<(), Failure> {
        match self.target {
            Target::File(_) => Ok(()),
            Target::Folder { folder, .. } => Ok(folder.commit()?),
        }
    }
}

/// The format asked for, else that of the file's name.
fn written_format(to: Option<&str>, out: Option<&Path>) -> Result<WrittenFormat, Failure> {
    let expected = "csv, at2, smc or parquet";
    match (to, out) {
        (Some(word), _) => WrittenFormat::of_name(Path::new(&format!("x.{word}")))
            .ok_or_else(|| refuse("--to", &format!("expected {expected}, found {word:?}"))),
        (None, Some(out)) => WrittenFormat::of_name(out).ok_or_else(|| {
            let name = out.display();
            Failure::Message(format!(
                "{name}: expected a name that ends in .csv, .AT2, .smc or .parquet, or --to"
            ))
        }),
        (None, None) => Err(refuse("--to", &format!("expected {expected} for files in a folder"))),
    }
}
