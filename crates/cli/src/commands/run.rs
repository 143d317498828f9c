//! `slipstick run`: the main job.

use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::assessment::single::{Job, Outcome};
use slipstick::error::InputError;
use slipstick::hash::sha256_hex;
use slipstick::input::{self, Analysis, Override, Scale};
use slipstick::record;
use slipstick::requests::Kind;
use slipstick::units::Dimension;
use slipstick_files::{
    FileError, OpenJob, OutputFolder, RecordRequest, events_csv, history_csv, modes_beside,
    read_at_most, record_path,
};
use slipstick_report::{FileNote, InputText, Report, Summary, opensees, report, table};

use super::histories::histories;
use crate::args::{RunArgs, quantity};
use crate::failure::{Failure, print, say};
use crate::progress::{Lines, TRIAL, estimated, reading, writing};

/// Runs one analysis, prints it and writes its files.
pub fn run(args: &RunArgs) -> Result<ExitCode, Failure> {
    match args.models.as_slice() {
        [model] if args.on.records.is_empty() => one(args, model),
        _ => histories(args),
    }
}

/// One model on one motion.
fn one(args: &RunArgs, model: &Path) -> Result<ExitCode, Failure> {
    args.on.only_with_records()?;
    args.suite.none_beside(Kind::Run, "a suite beside it, --records <PATTERN>")?;
    let asked = args.one.asked()?.single()?;
    let model = read_model(model)?;
    let mut overrides = model.overrides(&args.on.set)?;
    let keys = asked.keys(args.motion.is_none());
    overrides.extend(keys.map_err(|error| Failure::Message(error.to_string()))?);
    let analysis = input::from_bytes(&model.name, &model.bytes, &overrides).map_err(|error| {
        let of_scale = asked.of_scale(&error).map(Failure::from);
        of_scale.unwrap_or_else(|| model.failure(error))
    })?;
    tell_replaced(&model, &overrides, &analysis, args.on.result.quiet);
    args.on.record.only_with("--motion <FILE>", args.motion.is_some())?;
    let record = args.motion.as_deref().map(|path| record_request(args, path, asked.scale));
    let record = record.transpose()?;
    let in_model = |error| Failure::job(error, &model.name, &model.text());
    let file = record_path(&model.path, &analysis, record.as_ref());
    let piece = |bytes: &[u8]| drop(record::read("", bytes, &record::Options::default()));
    let open = || OpenJob::new(&model.path, analysis, record.as_ref());
    let job = reading(file.as_deref(), args.on.result.quiet, &piece, open).map_err(in_model)?;
    if asked.floor_spectrum && job.job.motion.horizontal_y_m_per_s2().is_some() {
        let message = "--floor-spectrum: expected a motion in one direction, found one in two";
        return Err(Failure::Message(message.to_owned()));
    }
    if let Some(stiffness) = &args.to_opensees {
        print(&opensees_script(&model, &job.job, stiffness)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    // An output folder that cannot be written is told before the work, not after it.
    let folder = args
        .on
        .result
        .out
        .as_deref()
        .map(|out| {
            let records = job.sources.iter().map(|source| source.path.clone());
            let inputs: Vec<PathBuf> = records.chain([model.path.clone()]).collect();
            OutputFolder::create(out, &inputs)
        })
        .transpose()?;
    let (outcome, summary) =
        estimated("computing", args.on.result.quiet, &|| job.estimate(TRIAL), || {
            job.run(asked.floor_spectrum)
        })
        .map_err(in_model)?;
    if let Some(folder) = folder {
        let rows = outcome.nominal.response.history.as_ref().map_or(0, |h| h.rows.len());
        let lines = rows + outcome.nominal.response.events.len();
        writing(lines as u64, args.on.result.quiet, |written| {
            write_files(folder, args, &model, &job, &outcome, &summary, written)
        })?;
    }
    show(args, &job, &summary)?;
    Ok(ExitCode::from(status(&summary)))
}

/// The script for OpenSeesPy, with stick as a spring of the stiffness that the option gives.
fn opensees_script(model: &ModelFile, job: &Job, stiffness: &str) -> Result<String, Failure> {
    let of = &job.analysis.model;
    let stiffness_n_per_m = match stiffness {
        "" => opensees::stiffness_n_per_m(of),
        text => quantity("--to-opensees", text, Dimension::Stiffness)?,
    };
    let name = job.analysis.name.as_deref().unwrap_or(&model.name);
    let script = opensees::script(name, of, &job.motion, stiffness_n_per_m);
    script.map_err(|error| Failure::Message(format!("--to-opensees: {error}")))
}

/// 1 where the check of a run, or of one of its bounds, failed.
fn status(summary: &Summary) -> u8 {
    u8::from(summary.check_failed())
}

/// The model file as it was read.
pub(super) struct ModelFile {
    /// What messages call it.
    pub name: String,
    /// Where it is; empty for standard input.
    pub path: PathBuf,
    /// All of it.
    pub bytes: Vec<u8>,
    /// The table of modes that it names.
    pub modes: Option<Override>,
}

impl ModelFile {
    fn new(name: String, path: PathBuf, bytes: Vec<u8>) -> Result<Self, Failure> {
        let modes = modes_beside(&path, &name, &bytes)
            .map_err(|error| Failure::input(error, &String::from_utf8_lossy(&bytes)))?;
        Ok(Self { name, path, bytes, modes })
    }

    /// The table of modes, then the options that set keys of the model.
    pub fn overrides(&self, set: &[String]) -> Result<Vec<Override>, Failure> {
        Ok(self.modes.iter().cloned().chain(overrides(set)?).collect())
    }

    /// What is wrong with it: with the line in question, unless that is one of the table of modes.
    pub fn failure(&self, error: InputError) -> Failure {
        let named = |modes: &Override| modes.text().ends_with(&error.place.source_name);
        match self.modes.as_ref().filter(|_| !error.place.source_name.is_empty()).is_some_and(named)
        {
            true => Failure::Message(error.to_string()),
            false => Failure::input(error, &self.text()),
        }
    }
}

impl ModelFile {
    /// All of it as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }
}

pub(super) fn read_model(path: &Path) -> Result<ModelFile, Failure> {
    let limit = input::MAX_TEXT_BYTES as u64;
    if path != Path::new("-") {
        let name = path.display().to_string();
        return ModelFile::new(name, path.to_owned(), read_at_most(path, limit)?);
    }
    let path = PathBuf::from("standard input");
    let mut bytes = Vec::new();
    let read = io::stdin().lock().take(limit + 1).read_to_end(&mut bytes);
    if let Err(source) = read {
        return Err(FileError::Read { path, source }.into());
    }
    if bytes.len() as u64 > limit {
        return Err(FileError::TooLarge { path, limit }.into());
    }
    ModelFile::new(path.display().to_string(), PathBuf::new(), bytes)
}

/// The options that set keys of the model.
pub(super) fn overrides(set: &[String]) -> Result<Vec<Override>, Failure> {
    let read = |text: &String| Override::of_option("--set", text);
    let all: Result<_, InputError> = set.iter().map(read).collect();
    all.map_err(|error| Failure::Message(error.to_string()))
}

/// Says what a key that was set takes the place of.
pub(super) fn tell_replaced(
    model: &ModelFile,
    overrides: &[Override],
    analysis: &Analysis,
    quiet: bool,
) {
    let (modes, set): (Vec<Override>, Vec<Override>) =
        overrides.iter().cloned().partition(Override::is_modes);
    if quiet || set.is_empty() {
        return;
    }
    let Ok(written) = input::from_bytes(&model.name, &model.bytes, &modes) else { return };
    let kept: Vec<&str> = analysis.inputs().map(|input| input.path).collect();
    let gone: Vec<&str> =
        written.inputs().map(|input| input.path).filter(|path| !kept.contains(path)).collect();
    if !gone.is_empty() {
        let set: Vec<&str> = set.iter().map(Override::path).collect();
        say(format_args!("note: {} replaces {} of the model", set.join(", "), gone.join(", ")));
    }
}

/// The record of `--motion`, completed by the options beside it.
fn record_request(
    args: &RunArgs,
    path: &Path,
    scale: Option<Scale>,
) -> Result<RecordRequest, Failure> {
    let options = args.on.record.options(true)?;
    Ok(RecordRequest {
        path: path.to_owned(),
        format: None,
        units: options.units,
        dt_s: options.dt_s,
        channel: options.channel,
        scale,
        along_y: None,
        vertical: None,
    })
}

/// The result on standard output; what was noticed, on standard error, where the table has not
/// said it already.
fn show(args: &RunArgs, job: &OpenJob, summary: &Summary) -> Result<(), Failure> {
    if args.on.result.json {
        print(&summary.to_json())?;
    } else {
        let record = job.job.loaded.description.join("; ");
        let display = args.on.result.display_units;
        print(&table::table(summary, &job.job.analysis.model, &record, display))?;
    }
    if args.on.result.quiet {
        return Ok(());
    }
    if args.on.result.json {
        for (run, warning) in summary.all_warnings() {
            let run = run.map_or(String::new(), |run| format!(" ({run} friction)"));
            let label = warning.severity().name();
            say(format_args!("{label}: {}{run}: {}", warning.kind, warning.message));
        }
    }
    if let Some(out) = &args.on.result.out {
        say(format_args!("wrote {}", out.join("report.html").display()));
    }
    Ok(())
}

fn write_files(
    mut folder: OutputFolder,
    args: &RunArgs,
    model: &ModelFile,
    job: &OpenJob,
    outcome: &Outcome,
    summary: &Summary,
    written: &dyn Fn(u64),
) -> Result<(), FileError> {
    let record = job.job.loaded.description.join("; ");
    let (text, sha256) = (model.text(), sha256_hex(&model.bytes));
    let inputs = [InputText { path: &model.name, text: &text }];
    let sources: Vec<(String, &str, &str)> = job
        .sources
        .iter()
        .zip(&job.job.loaded.description)
        .map(|(file, what)| (file.path.display().to_string(), file.sha256.as_str(), what.as_str()))
        .collect();
    let mut files = vec![FileNote { path: &model.name, sha256: &sha256, description: "model" }];
    files.extend(sources.iter().map(|(path, sha256, what)| FileNote {
        path,
        sha256,
        description: what,
    }));
    let command_line = command_line();
    let report = Report {
        summary,
        model: &job.job.analysis.model,
        motion: &job.job.motion,
        record: &record,
        response: &outcome.nominal.response,
        certificate: &outcome.nominal.certificate,
        bounds: outcome.bounds.as_ref().map(|[lower, upper]| [&lower.response, &upper.response]),
        floor_spectra: summary.floor_spectra.as_ref(),
        inputs: &inputs,
        files: &files,
        command_line: &command_line,
        display: args.on.result.display_units,
    };
    folder.replaces(&["runs.csv", "governing.csv", "histories.svg", "shares.svg"]);
    folder.write("summary.json", summary.to_json().as_bytes())?;
    let response = &outcome.nominal.response;
    folder.write_with("history.csv", |to| history_csv(response, &mut Lines { to, written }))?;
    folder.write_with("events.csv", |to| events_csv(response, &mut Lines { to, written }))?;
    folder.write("report.html", report.to_html().as_bytes())?;
    folder.commit()
}

/// The command as it was typed, with quotes where the shell needs them.
pub fn command_line() -> String {
    let words = std::env::args_os().skip(1);
    report::command_line(words.map(|word| word.to_string_lossy().into_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Not to be seen from outside: an exact response that fails its check is a fault of ours.
    #[test]
    fn exact_failed_check_is_status_1() {
        let text = "[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0.2\n\
                    kinetic_friction = 0.1\nbounds = { lower = 0.5, upper = 2 }\n[motion]\n\
                    sine = { frequency = \"1 Hz\", amplitude = \"3 m/s2\", duration = \"2 s\", \
                    dt = \"0.1 s\" }\n";
        let analysis = input::parse("model.toml", text, &[]).unwrap();
        let job = OpenJob::new(Path::new("model.toml"), analysis, None).unwrap();
        let (_, summary) = job.run(false).unwrap();
        assert_eq!(status(&summary), 0);
        let failed = |run: &Summary| {
            let mut run = run.clone();
            run.checks.holds = Some(false);
            run
        };
        assert_eq!(status(&failed(&summary)), 1);
        let bounds = summary.bounds.clone().unwrap();
        let beside = |lower, upper| summary.clone().with_bounds(lower, upper);
        assert_eq!(status(&beside(failed(&bounds.lower), bounds.upper.clone())), 1);
        assert_eq!(status(&beside(bounds.lower.clone(), failed(&bounds.upper))), 1);
        // The stepwise method is reported, never judged.
        let mut stepwise = summary.clone();
        stepwise.checks.holds = None;
        assert_eq!(status(&stepwise), 0);
    }
}
