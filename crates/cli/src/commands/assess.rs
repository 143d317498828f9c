//! `slipstick spectrum`, `ida`, `design` and `fragility`: a request in, an answer out.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::Duration;

use slipstick::assessment::AssessmentError;
use slipstick::hash::sha256_hex;
use slipstick::requests::Runs;
use slipstick::study::engine::Engine;
use slipstick_files::{
    InputFiles, KeptFile, ReadTable, files_of_runs, limit_of_ida, model_of_runs, on_threads,
    read_bytes, read_csv, read_runs, read_table, reading_time, time_left,
};
use slipstick_report::assessment::answer::kind_of_runs;
use slipstick_report::number::count;

use crate::args::{AssessArgs, FragilityArgs};
use crate::failure::Failure;
use crate::opened::Opened;
use crate::progress::{TRIAL, counted, estimated, on_interrupt};
use crate::results::{command_line, emit, folder};

/// Runs, prints and writes; status 1 where a run has no answer, or no design is found.
pub fn assess<const KIND: usize>(args: &AssessArgs<KIND>) -> Result<ExitCode, Failure> {
    let asked = args.fields.asked()?;
    let opened = Opened::open(&args.model, &args.suite)?;
    let result = &args.suite.result;
    let folder = opened.folder(result)?;
    keeping_runs(result.out.as_deref(), |kept| {
        let answer = opened
            .compute(&args.suite, |engine| kept.with(engine, |on| asked.run(&opened.on(), on)))?;
        emit(result, folder, answer, &opened.inputs)
    })
}

/// The runs that are kept in a folder of results, where there is one.
pub(super) struct KeptRuns(Option<KeptFile>);

impl KeptRuns {
    /// Computes with the runs that are kept.
    pub(super) fn with<T>(&self, engine: &Engine<'_>, run: impl FnOnce(&Engine<'_>) -> T) -> T {
        match &self.0 {
            Some(kept) => run(&engine.keeping(kept)),
            None => run(engine),
        }
    }
}

/// Computes and writes with the runs that an interrupted command has kept; what is written needs them no more.
pub(super) fn keeping_runs(
    out: Option<&Path>,
    write: impl FnOnce(&KeptRuns) -> Result<ExitCode, Failure>,
) -> Result<ExitCode, Failure> {
    let kept = out.map(|out| KeptFile::open(out, &command_line())).transpose()?;
    if let Some((kept, out)) = kept.as_ref().zip(out) {
        tell_what_is_kept(kept, out.to_owned());
    }
    let kept = KeptRuns(kept);
    let status = write(&kept)?;
    if let Some(kept) = kept.0 {
        kept.done();
    }
    Ok(status)
}

/// Says how to go on, should Ctrl-C end what follows.
fn tell_what_is_kept(kept: &KeptFile, out: PathBuf) {
    let runs = kept.count();
    on_interrupt(move || {
        let (runs, out) = (count(runs.load(Ordering::Relaxed)), out.display());
        format!(
            "interrupted: {runs} runs in two directions are kept in {out}; the same command goes on with them"
        )
    });
}

/// Fits, prints and writes.
pub fn fragility(args: &FragilityArgs) -> Result<ExitCode, Failure> {
    let asked = args.fields.asked()?;
    let quiet = args.result.quiet;
    let estimate = || reading_left(&args.source);
    let (mut inputs, read) = estimated("reading", quiet, &estimate, || read(&args.source))?;
    let name = model_of_runs(&args.source).unwrap_or_else(|| args.source.display().to_string());
    let runs = Runs {
        name: &name,
        source: &read.path.display().to_string(),
        table: &read.table,
        limit: limit_of_ida(&args.source, asked.demand()),
        certified: read.certified.as_ref(),
    };
    let fit = |engine: &Engine<'_>| on_threads(args.threads.number(), || asked.fit(&runs, engine));
    let answer = counted("fitting", quiet, fit).map_err(|error| match error {
        AssessmentError::Cell(error) => Failure::from(read.cell_error(&error)),
        other => other.into(),
    })?;
    if let Some((.., kind)) = inputs.files.first_mut() {
        kind_of_runs(&answer).clone_into(kind);
    }
    let folder = folder(&args.result, &inputs.paths())?;
    emit(&args.result, folder, answer, &inputs)
}

/// Time that reading a source may take, from its first lines or its first parts.
fn reading_left(source: &Path) -> Option<Duration> {
    let piece = |bytes: &[u8]| drop(read_csv(source, bytes));
    let files = files_of_runs(source).ok()?;
    let parts = |count: usize| read_table(&files[..count]).ok().map(|_| ());
    match files.as_slice() {
        [one] => reading_time(one, TRIAL, piece),
        many => time_left([1, many.len()], TRIAL, parts),
    }
}

/// The table of a source, and its files with their hashes.
fn read(source: &Path) -> Result<(InputFiles, ReadTable), Failure> {
    let files = files_of_runs(source)?;
    let mut inputs = InputFiles::default();
    for path in &files {
        let sha256 = sha256_hex(&read_bytes(path)?);
        inputs.files.push((path.display().to_string(), sha256, "runs".to_owned()));
    }
    Ok((inputs, read_runs(&files)?))
}
