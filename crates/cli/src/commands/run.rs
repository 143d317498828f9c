//! `slipstick run`: the main job.

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::input::{self, Override};
use slipstick::units::{Dimension, parse_quantity};
use slipstick_files::{
    FileError, Job, Outcome, OutputFolder, RecordRequest, Scale, events_csv, history_csv,
    read_bytes, sha256_hex,
};
use slipstick_report::{FileNote, InputText, Report, table};

use crate::args::{MethodName, RunArgs};
use crate::failure::Failure;
use crate::progress::watched;

/// Largest model file that is read.
const MODEL_BYTES_LIMIT: usize = 16 << 20;

/// Runs one analysis, prints it and writes its files.
pub fn run(args: &RunArgs) -> Result<ExitCode, Failure> {
    let (name, bytes) = read_model(&args.model)?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let overrides = overrides(args)?;
    let analysis = input::from_bytes(&name, &bytes, &overrides)
        .map_err(|error| Failure::input(error, &text))?;
    let record = args.motion.as_deref().map(|path| record_request(args, path)).transpose()?;
    let model_path = Path::new(&name);
    let inputs = [args.model.clone(), args.motion.clone().unwrap_or_default()];
    // An output folder that cannot be written is told before the work, not after it.
    let folder = args.out.as_deref().map(|out| OutputFolder::create(out, &inputs)).transpose()?;
    let (job, outcome) = watched("computing", args.quiet, || {
        let job = Job::new(model_path, analysis, record.as_ref())?;
        let outcome = job.run(args.floor_spectrum)?;
        Ok((job, outcome))
    })
    .map_err(|error| Failure::job(error, &text))?;
    if let Some(folder) = folder {
        let model = ModelFile { name: &name, text: &text, sha256: sha256_hex(&bytes) };
        watched("writing", args.quiet, || write_files(folder, args, &model, &job, &outcome))?;
    }
    print(args, &job, &outcome)?;
    Ok(if outcome.summary.check_failed() { ExitCode::from(1) } else { ExitCode::SUCCESS })
}

/// The model file as it was read.
struct ModelFile<'a> {
    name: &'a str,
    text: &'a str,
    sha256: String,
}

fn read_model(path: &Path) -> Result<(String, Vec<u8>), Failure> {
    let (name, bytes) = if path == Path::new("-") {
        let mut bytes = Vec::new();
        io::stdin()
            .lock()
            .take(MODEL_BYTES_LIMIT as u64 + 1)
            .read_to_end(&mut bytes)
            .map_err(|error| Failure::Message(format!("standard input: {error}")))?;
        ("model.toml".to_owned(), bytes)
    } else {
        (path.display().to_string(), read_bytes(path)?)
    };
    if bytes.len() > MODEL_BYTES_LIMIT {
        return Err(Failure::Message(format!(
            "{name}: expected a model of at most {MODEL_BYTES_LIMIT} bytes, found more"
        )));
    }
    Ok((name, bytes))
}

fn overrides(args: &RunArgs) -> Result<Vec<Override>, Failure> {
    let method = args.method.map(|method| match method {
        MethodName::Exact => "analysis.method=exact".to_owned(),
        MethodName::Stepwise => "analysis.method=stepwise".to_owned(),
    });
    let set = args.set.iter().cloned().chain(method);
    set.map(|text| Override::parse(&text).map_err(|error| Failure::Message(error.to_string())))
        .collect()
}

/// The record of `--motion`, completed by the options beside it.
fn record_request(args: &RunArgs, path: &Path) -> Result<RecordRequest, Failure> {
    let refuse = |option: &str, reason: String| Failure::Message(format!("{option}: {reason}"));
    let quantity = |option: &str, text: &str, dimension| {
        parse_quantity(text, dimension).map_err(|error| refuse(option, error.to_string()))
    };
    let scale = match (&args.scale, &args.scale_to) {
        (Some(factor), _) => {
            let value = factor.trim().parse::<f64>().ok().filter(|factor| factor.is_finite());
            let expected = || refuse("--scale", format!("expected a factor, found {factor:?}"));
            Scale::Factor(value.ok_or_else(expected)?)
        }
        (None, Some(peak)) => {
            let peak_m_per_s2 = quantity("--scale-to", peak, Dimension::Acceleration)?;
            if !(peak_m_per_s2 > 0.0) {
                return Err(refuse("--scale-to", format!("expected a peak > 0, found {peak:?}")));
            }
            Scale::ToPeak(peak_m_per_s2)
        }
        (None, None) => Scale::None,
    };
    let units = args.units.as_deref().map(|units| {
        slipstick::units::parse_unit(units, Dimension::Acceleration)
            .map_err(|error| refuse("--units", error.to_string()))?;
        slipstick::record::Units::parse(units).ok_or_else(|| {
            refuse("--units", format!("expected a unit of a record, found {units:?}"))
        })
    });
    let dt_s = args.dt.as_deref().map(|dt| {
        let dt_s = quantity("--dt", dt, Dimension::Time)?;
        if dt_s > 0.0 {
            Ok(dt_s)
        } else {
            Err(refuse("--dt", format!("expected a time step > 0, found {dt:?}")))
        }
    });
    Ok(RecordRequest {
        path: path.to_owned(),
        format: None,
        units: units.transpose()?,
        dt_s: dt_s.transpose()?,
        channel: args.channel.clone(),
        scale,
        vertical: None,
    })
}

/// The result on standard output; what was noticed, on standard error, where the table has not
/// said it already.
fn print(args: &RunArgs, job: &Job, outcome: &Outcome) -> Result<(), Failure> {
    let text = if args.json {
        outcome.summary.to_json()
    } else {
        let record = job.loaded.description.join("; ");
        table::table(&outcome.summary, &job.analysis.model, &record, args.display_units.into())
    };
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    if !text.ends_with('\n') {
        out.write_all(b"\n")?;
    }
    out.flush()?;
    if !args.quiet {
        if args.json {
            for (run, warning) in outcome.summary.all_warnings() {
                let run = run.map_or(String::new(), |run| format!(" ({run} friction)"));
                eprintln!("warning: {}{run}: {}", warning.kind, warning.message);
            }
        }
        if let Some(out) = &args.out {
            eprintln!("wrote {}", out.join("report.html").display());
        }
    }
    Ok(())
}

fn write_files(
    mut folder: OutputFolder,
    args: &RunArgs,
    model: &ModelFile<'_>,
    job: &Job,
    outcome: &Outcome,
) -> Result<(), FileError> {
    let record = job.loaded.description.join("; ");
    let inputs = [InputText { path: model.name, text: model.text }];
    let sources: Vec<(String, &str, &str)> = job
        .loaded
        .sources
        .iter()
        .zip(&job.loaded.description)
        .map(|(file, what)| (file.path.display().to_string(), file.sha256.as_str(), what.as_str()))
        .collect();
    let mut files =
        vec![FileNote { path: model.name, sha256: &model.sha256, description: "model" }];
    files.extend(sources.iter().map(|(path, sha256, what)| FileNote {
        path,
        sha256,
        description: what,
    }));
    let command_line = command_line();
    let report = Report {
        summary: &outcome.summary,
        model: &job.analysis.model,
        motion: &job.motion,
        record: &record,
        response: &outcome.response,
        certificate: &outcome.certificate,
        bounds: outcome.bounds.as_ref().map(|[lower, upper]| [lower, upper]),
        floor_spectra: outcome.floor_spectra.as_ref(),
        inputs: &inputs,
        files: &files,
        command_line: &command_line,
        display: args.display_units.into(),
    };
    let in_memory = |source| FileError::Write { path: PathBuf::from("history.csv"), source };
    let mut summary = outcome.summary.to_json();
    if !summary.ends_with('\n') {
        summary.push('\n');
    }
    folder.write("summary.json", summary.as_bytes())?;
    let mut csv = Vec::new();
    if let Some(history) = &outcome.response.history {
        history_csv(history, &mut csv).map_err(in_memory)?;
    }
    folder.write("history.csv", &csv)?;
    csv.clear();
    events_csv(&outcome.response.events, &mut csv).map_err(in_memory)?;
    folder.write("events.csv", &csv)?;
    folder.write("report.html", report.to_html().as_bytes())?;
    folder.commit()
}

/// The command as it was typed, with quotes where the shell needs them.
fn command_line() -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,+:@%".contains(c);
    let quoted = |argument: String| {
        if !argument.is_empty() && argument.chars().all(plain) {
            argument
        } else {
            format!("'{}'", argument.replace('\'', r"'\''"))
        }
    };
    let arguments = std::env::args_os().skip(1).map(|a| quoted(a.to_string_lossy().into_owned()));
    std::iter::once("slipstick".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}
