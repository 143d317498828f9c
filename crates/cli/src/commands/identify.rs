//! `slipstick identify`: parameters from tests.

mod cyclic;
mod free_vibration;
mod shaking_table;

use std::path::PathBuf;
use std::process::ExitCode;

use slipstick::input::{self, Analysis, Override};
use slipstick::laboratory::estimate::Estimate;
use slipstick::laboratory::fitted;
use slipstick::response::Warning;
use slipstick::units::{Dimension, parse_quantity};
use slipstick_files::OutputFolder;
use slipstick_report::IdentifyReport;

use super::run::ModelFile;
use crate::args::{IdentifyCommand, ResultArgs};
use crate::failure::{Failure, print, say};

/// Runs one of the three jobs.
pub fn identify(command: &IdentifyCommand) -> Result<ExitCode, Failure> {
    match command {
        IdentifyCommand::Cyclic(args) => cyclic::cyclic(args),
        IdentifyCommand::FreeVibration(args) => free_vibration::free_vibration(args),
        IdentifyCommand::ShakingTable(args) => shaking_table::shaking_table(args),
    }
}

/// The value of an option, in SI.
fn quantity(option: &str, text: &str, dimension: Dimension) -> Result<f64, Failure> {
    parse_quantity(text, dimension).map_err(|error| Failure::Message(format!("{option}: {error}")))
}

/// An output folder that replaces none of the inputs.
fn output(args: &ResultArgs, inputs: &[PathBuf]) -> Result<Option<OutputFolder>, Failure> {
    let folder = args.out.as_deref().map(|out| OutputFolder::create(out, inputs));
    Ok(folder.transpose()?)
}

/// The model with what was told, and what had to be decided for it.
fn fitted_model(
    model: &ModelFile,
    set: &[Override],
    estimates: &[Estimate],
) -> Result<(Analysis, Vec<Warning>), Failure> {
    let (told, warnings) = fitted::overrides(estimates);
    let all: Vec<Override> = set.iter().cloned().chain(told).collect();
    let analysis = input::from_bytes(&model.name, &model.bytes, &all)
        .map_err(|error| Failure::input(error, &model.text()))?;
    Ok((analysis, warnings))
}

/// Writes and prints a result; status 1 where the data do not tell everything.
fn finish(
    args: &ResultArgs,
    folder: Option<OutputFolder>,
    report: &IdentifyReport,
    more: &[(&str, Vec<u8>)],
) -> Result<ExitCode, Failure> {
    if let Some(mut folder) = folder {
        folder.write("identified.json", report.to_json().as_bytes())?;
        folder.write("report.html", report.to_html().as_bytes())?;
        for (name, bytes) in more {
            folder.write(name, bytes)?;
        }
        folder.commit()?;
    }
    print(&if args.json { report.to_json() } else { report.table() })?;
    super::compare::tell(args, &report.warnings);
    if let (Some(out), false) = (&args.out, args.quiet) {
        for (name, _) in more {
            say(format_args!("wrote {}", out.join(name).display()));
        }
    }
    Ok(ExitCode::from(u8::from(!report.all_told())))
}
