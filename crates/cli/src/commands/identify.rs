//! `slipstick identify`: parameters from tests.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::input;
use slipstick::laboratory::identify::{Identified, IdentifyError, ModelText};
use slipstick::laboratory::measured::Measured;
use slipstick::requests::{Kind, Request};
use slipstick::study::engine::Engine;
use slipstick_files::{
    InputFiles, LaboratoryError, OutputFolder, SourceFile, expand_all, on_threads, read_mapping,
    read_measured, time_left,
};
use slipstick_report::laboratory::identify;

use crate::args::{IdentifyCommand, ResultArgs, TestArgs};
use crate::failure::Failure;
use crate::model_file::{ModelFile, overrides, read_model};
use crate::progress::{TRIAL, counted, estimated, reading};
use crate::results::{Written, conclude, folder};

/// Runs one of the three jobs.
pub fn identify(command: &IdentifyCommand) -> Result<ExitCode, Failure> {
    match command {
        IdentifyCommand::Cyclic(args) => Job::of(args)?.run(None),
        IdentifyCommand::FreeVibration(args) => Job::of(args)?.run(None),
        IdentifyCommand::ShakingTable(args) => Job {
            asked: args.fields.asked()?,
            files: core::slice::from_ref(&args.file),
            model: Some(&args.model),
            set: &args.set,
            result: &args.result,
        }
        .run(args.threads.number()),
    }
}

/// What is asked, and of what.
struct Job<'a> {
    asked: Request,
    files: &'a [String],
    model: Option<&'a Path>,
    set: &'a [String],
    result: &'a ResultArgs,
}

impl<'a> Job<'a> {
    fn of<const KIND: usize>(args: &'a TestArgs<KIND>) -> Result<Self, Failure> {
        Ok(Self {
            asked: args.fields.asked()?,
            files: &args.files,
            model: args.model.as_deref(),
            set: &[],
            result: &args.result,
        })
    }

    /// Reads, identifies, prints and writes.
    fn run(&self, jobs: Option<usize>) -> Result<ExitCode, Failure> {
        let quiet = self.result.quiet;
        let model = self.model.map(read_model).transpose()?;
        let (set, text) = (overrides(self.set)?, model.as_ref().map(text).transpose()?);
        let (mapping, mapping_file) = read_mapping(&self.asked.mapping())?;
        let read = |path: &PathBuf| -> Result<(Measured, SourceFile), LaboratoryError> {
            let piece = |bytes: &[u8]| drop(Measured::read("", bytes, &mapping));
            reading(Some(path), quiet, &piece, || read_measured(path, &mapping))
        };
        let files = expand_all(Path::new(""), self.files)?;
        let read: Result<Vec<_>, _> = files.iter().map(read).collect();
        let (measured, sources): (Vec<Measured>, Vec<SourceFile>) = read?.into_iter().unzip();
        let inputs = model.as_ref().map(ModelFile::inputs).unwrap_or_default();
        let inputs = inputs.with_tests(&sources, mapping_file.as_ref());
        let folder = folder(self.result, &inputs.paths())?;
        let on = model.as_ref().zip(text.as_deref());
        let on = on.map(|(model, text)| ModelText { name: &model.name, text, set: &set });
        let identified = self.identified(on, &measured, jobs);
        let identified =
            identified.map_err(|error| failure(error, text.as_deref().unwrap_or_default()))?;
        finish(self.result, folder, &inputs, &measured, &identified)
    }

    fn identified(
        &self,
        on: Option<ModelText<'_>>,
        measured: &[Measured],
        jobs: Option<usize>,
    ) -> Result<Identified, IdentifyError> {
        let (asked, quiet) = (&self.asked, self.result.quiet);
        let fit = |measured: &[Measured]| asked.identify(on, measured, &Engine::unwatched());
        let samples = measured.iter().map(Measured::samples).max().unwrap_or(0);
        let least = match asked.kind() {
            Kind::ShakingTable => {
                return counted("fitting", quiet, |engine| {
                    on_threads(jobs, || asked.identify(on, measured, engine))
                });
            }
            // Less than half of a test may lack the cycles that a fit needs.
            Kind::Cyclic => samples / 2,
            _ => 1024,
        };
        let first = |samples: usize| {
            let first: Vec<Measured> = measured.iter().map(|one| one.first(samples)).collect();
            fit(&first).ok().map(|_| ())
        };
        let estimate = || time_left([least, samples], TRIAL, first);
        estimated("fitting", quiet, &estimate, || fit(measured))
    }
}

/// The text of a model file.
fn text(model: &ModelFile) -> Result<String, Failure> {
    let text = model.text();
    if let Some(modes) = &model.modes {
        // One text, with the modes in it.
        let analysis = input::from_bytes(&model.name, &model.bytes, core::slice::from_ref(modes))
            .map_err(|error| model.failure(error))?;
        return Ok(analysis.to_toml_with_motion());
    }
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
        IdentifyError::Choice(error) => error.into(),
        IdentifyError::Cyclic { .. } => Failure::CannotTell(error.to_string()),
        error => Failure::Message(error.to_string()),
    }
}

/// Writes and prints a result; status 1 where the data do not tell everything.
fn finish(
    args: &ResultArgs,
    folder: Option<OutputFolder>,
    inputs: &InputFiles,
    measured: &[Measured],
    identified: &Identified,
) -> Result<ExitCode, Failure> {
    let sheet = identify::sheet(measured, identified, args.display_units);
    let more = identified.files();
    let written =
        Written { folder, json: "identified.json", more: &more, histories: &[], replaces: &[] };
    conclude(args, written, &sheet, &[], inputs)
}
