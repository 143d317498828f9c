//! A model and the records that it runs on, read.

use std::path::Path;

use slipstick::assessment::AssessmentError;
use slipstick::assessment::suite::Suite;
use slipstick::input::{self, Analysis, Override};
use slipstick::requests::On;
use slipstick::response::Method;
use slipstick::study::engine::Engine;
use slipstick_files::{
    InputFiles, LoadedMotion, OpenJob, OpenSuite, OutputFolder, SuiteError, SuiteRequest,
    on_threads,
};

use crate::args::{ResultArgs, SuiteArgs};
use crate::failure::Failure;
use crate::model_file::{ModelFile, read_model, tell_replaced};
use crate::progress::counted;
use crate::results::folder;

/// A model and its suite, read.
pub struct Opened {
    pub file: ModelFile,
    text: String,
    pub name: String,
    pub analysis: Analysis,
    overrides: Vec<Override>,
    pub suite: Suite,
    /// What went in, the model first.
    pub inputs: InputFiles,
}

impl Opened {
    /// Reads the model and the records, or the model's own motion.
    pub fn open(model: &Path, args: &SuiteArgs) -> Result<Self, Failure> {
        Self::open_with(model, args, || open_records(args))
    }

    /// Reads the model, then the records by `records`; the model's own motion where it gives none.
    pub fn open_with(
        model: &Path,
        args: &SuiteArgs,
        records: impl FnOnce() -> Result<Option<OpenSuite>, Failure>,
    ) -> Result<Self, Failure> {
        let file = read_model(model)?;
        let overrides = file.overrides(&args.set)?;
        let analysis = input::from_bytes(&file.name, &file.bytes, &overrides)
            .map_err(|error| file.failure(error))?;
        tell_replaced(&file, &overrides, &analysis, args.result.quiet);
        if analysis.method != Method::Exact {
            let expected = "the exact method, which is the only one over a suite";
            let error = analysis.error_at("analysis.method", expected, "\"stepwise\"");
            return Err(Failure::input(error, &file.text()));
        }
        let name = file.model_name(analysis.name.as_deref());
        let OpenSuite { suite, sources } = match records()? {
            Some(records) => records,
            None => {
                let job = OpenJob::new(&file.path, analysis.clone(), None)
                    .map_err(|error| Failure::job(error, &file.name, &file.text()))?;
                let (name, made) = (job.motion_name(), job.sources.is_empty());
                let loaded = LoadedMotion { loaded: job.job.loaded, sources: job.sources };
                OpenSuite::single(&name, loaded, made)
            }
        };
        let mut inputs = file.inputs();
        inputs.files.extend(sources);
        let text = file.text();
        Ok(Self { file, text, name, analysis, overrides, suite, inputs })
    }

    /// What is asked of.
    pub fn on(&self) -> On<'_> {
        On {
            name: &self.name,
            source: &self.file.name,
            text: &self.text,
            set: &self.overrides,
            analysis: &self.analysis,
            suite: &self.suite,
        }
    }

    /// An error of an analysis, with the model's text where it points into that.
    pub fn failure(&self, error: AssessmentError) -> Failure {
        match error {
            AssessmentError::Input(error) => Failure::input(error, &self.file.text()),
            other => other.into(),
        }
    }

    /// Runs something on the threads asked for, with a sign of life.
    pub fn compute<T: Send>(
        &self,
        args: &SuiteArgs,
        work: impl FnOnce(&Engine<'_>) -> Result<T, AssessmentError> + Send,
    ) -> Result<T, Failure> {
        let work = |engine: &Engine<'_>| on_threads(args.threads.number(), || work(engine));
        counted("computing", args.result.quiet, work).map_err(|error| self.failure(error))
    }

    /// The folder for the results, refused where it would replace an input.
    pub fn folder(&self, args: &ResultArgs) -> Result<Option<OutputFolder>, Failure> {
        folder(args, &self.inputs.paths())
    }
}

/// Reads the records that are asked for; `None` where none are.
pub fn open_records(args: &SuiteArgs) -> Result<Option<OpenSuite>, Failure> {
    args.only_with_records()?;
    args.record.only_with("--records <PATTERN>", !args.records.is_empty())?;
    if args.records.is_empty() {
        return Ok(None);
    }
    let options = args.record.options(true)?;
    let request = SuiteRequest {
        patterns: args.records.clone(),
        along_y: Vec::new(),
        second: args.second.clone(),
        vertical: args.vertical.clone(),
        units: options.units,
        dt_s: options.dt_s,
        channel: options.channel,
    };
    let read = |engine: &Engine<'_>| {
        on_threads(args.threads.number(), || OpenSuite::open(&request, engine))
    };
    let opened =
        counted("reading records", args.result.quiet, read).map_err(|error| match error {
            SuiteError::Choice(error) => error.into(),
            SuiteError::File(error) => error.into(),
            SuiteError::Stopped(error) => Failure::Message(error.to_string()),
        })?;
    Ok(Some(opened))
}
