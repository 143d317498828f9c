//! `slipstick identify`: parameters from tests.

mod cyclic;
mod free_vibration;
mod shaking_table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::input::{self, Mapping};
use slipstick::laboratory::identify::{Identified, IdentifyError};
use slipstick::laboratory::measured::Measured;
use slipstick_files::{LaboratoryError, OutputFolder, SourceFile, TextFile, read_measured};
use slipstick_report::laboratory::identify;

use super::assessment::{Written, choice, conclude};
use super::compare::WentIn;
use super::run::ModelFile;
use crate::args::{IdentifyCommand, ResultArgs};
use crate::failure::Failure;
use crate::progress::reading;

/// Runs one of the three jobs.
pub fn identify(command: &IdentifyCommand) -> Result<ExitCode, Failure> {
    match command {
        IdentifyCommand::Cyclic(args) => cyclic::cyclic(args),
        IdentifyCommand::FreeVibration(args) => free_vibration::free_vibration(args),
        IdentifyCommand::ShakingTable(args) => shaking_table::shaking_table(args),
    }
}

/// A measured file, with the time left where it takes long.
fn read(
    path: &Path,
    mapping: &Mapping,
    quiet: bool,
) -> Result<(Measured, SourceFile), LaboratoryError> {
    let piece = |bytes: &[u8]| drop(Measured::read("", bytes, mapping));
    reading(Some(path), quiet, &piece, || read_measured(path, mapping))
}

/// The text of a model file.
fn text(model: &ModelFile) -> Result<String, Failure> {
    let text = model.text();
    if text.as_bytes() != model.bytes {
        input::from_bytes(&model.name, &model.bytes, &[])
            .map_err(|error| Failure::input(error, &text))?;
    }
    Ok(text)
}

/// What went wrong; `model` is the text of the model.
fn failure(error: IdentifyError, model: &str) -> Failure {
    match error {
        IdentifyError::Input(error) => Failure::input(error, model),
        IdentifyError::Choice(error) => choice(&error),
        IdentifyError::Cyclic { .. } => Failure::CannotTell(error.to_string()),
        error => Failure::Message(error.to_string()),
    }
}

/// An output folder that replaces none of the inputs.
fn output(args: &ResultArgs, inputs: &[PathBuf]) -> Result<Option<OutputFolder>, Failure> {
    let folder = args.out.as_deref().map(|out| OutputFolder::create(out, inputs));
    Ok(folder.transpose()?)
}

/// What went into an identification: the model, the files in their order, the mapping.
struct Inputs<'a> {
    model: Option<&'a ModelFile>,
    sources: &'a [&'a SourceFile],
    mapping: Option<&'a TextFile>,
}

impl Inputs<'_> {
    /// All that an output folder must not replace.
    fn paths(&self) -> Vec<PathBuf> {
        let sources = self.sources.iter().map(|source| source.path.clone());
        let model = self.model.map(|model| model.path.clone());
        let mapping = self.mapping.map(|file| file.source.path.clone());
        sources.chain(model).chain(mapping).collect()
    }
}

/// Writes and prints a result; status 1 where the data do not tell everything.
fn finish(
    args: &ResultArgs,
    folder: Option<OutputFolder>,
    inputs: &Inputs<'_>,
    measured: &[Measured],
    identified: &Identified,
) -> Result<ExitCode, Failure> {
    let WentIn { files, texts } = WentIn::of_files(inputs.model, inputs.sources, inputs.mapping);
    let sheet = identify::sheet(measured, identified, args.display_units.into());
    let more = identified.files();
    let written = Written { folder, json: "identified.json", more: &more, replaces: &[] };
    conclude(args, written, &sheet, &[], &files, &texts)
}
