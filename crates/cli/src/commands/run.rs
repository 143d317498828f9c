//! `slipstick run`: the main job.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::assessment::single::{Job, Outcome};
use slipstick::hash::sha256_hex;
use slipstick::input::{self, Scale};
use slipstick::record;
use slipstick::requests::Kind;
use slipstick::units::Dimension;
use slipstick_files::{
    FileError, OpenJob, OutputFolder, RecordRequest, events_csv, history_csv, record_path,
};
use slipstick_report::{FileNote, InputText, Report, Summary, opensees, table};

use super::histories::histories;
use crate::args::{RunArgs, quantity};
use crate::failure::{Failure, print, say};
use crate::model_file::{ModelFile, read_model, tell_replaced};
use crate::progress::{Lines, TRIAL, estimated, reading, writing};
use crate::results::{OF_SOME, command_line, folder};

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
    if let Some(stiffness) = &args.to_opensees {
        print(&opensees_script(&model, &job.job, stiffness)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    // An output folder that cannot be written is told before the work, not after it.
    let records = job.sources.iter().map(|source| source.path.clone());
    let inputs: Vec<PathBuf> = records.chain([model.path.clone()]).collect();
    let folder = folder(&args.on.result, &inputs)?;
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
        let record = job.motion_words();
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
    let record = job.motion_words();
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
    let of_suites = ["runs.csv", "governing.csv", "histories.svg", "shares.svg"];
    folder.replaces(&[&of_suites[..], &OF_SOME].concat());
    folder.write("summary.json", summary.to_json().as_bytes())?;
    let response = &outcome.nominal.response;
    folder.write_with("history.csv", |to| history_csv(response, &mut Lines { to, written }))?;
    folder.write_with("events.csv", |to| events_csv(response, &mut Lines { to, written }))?;
    folder.write("report.html", report.to_html().as_bytes())?;
    folder.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Not to be seen from outside: an exact response that fails its check is a fault of ours.
    #[test]
    fn failed_check_is_status_1() {
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
