//! `slipstick compare`: a prediction beside a measurement.

use std::process::ExitCode;

use slipstick::input;
use slipstick::laboratory::compare::compare as compared;
use slipstick::laboratory::measured::Measured;
use slipstick::requests::Comparing;
use slipstick_files::{read_mapping, read_measured, time_left};
use slipstick_report::laboratory::CompareReport;

use crate::args::CompareArgs;
use crate::failure::{Failure, say};
use crate::model_file::read_model;
use crate::progress::{TRIAL, estimated, reading};
use crate::results::{Written, conclude, folder};

/// Compares, prints and writes; status 1 where a bound is missed.
pub fn compare(args: &CompareArgs) -> Result<ExitCode, Failure> {
    let asked = args.fields.asked()?;
    let Comparing { within, method } = asked.comparing()?;
    let model = read_model(&args.model)?;
    let mut analysis = input::from_bytes(&model.name, &model.bytes, &model.overrides(&args.set)?)
        .map_err(|error| model.failure(error))?;
    analysis.method = method.unwrap_or(analysis.method);
    let (mapping, mapping_file) = read_mapping(&asked.mapping())?;
    let piece = |bytes: &[u8]| drop(Measured::read("", bytes, &mapping));
    let read = || read_measured(&args.measured, &mapping);
    let (measured, source) = reading(Some(&args.measured), args.result.quiet, &piece, read)?;
    let inputs = model.inputs().with_tests([&source], mapping_file.as_ref());
    let folder = folder(&args.result, &inputs.paths())?;
    let work = |measured: &Measured| compared(measured, &analysis.model, analysis.method);
    let first = |samples| work(&measured.first(samples)).ok().map(|_| ());
    let estimate = || time_left([256, measured.samples()], TRIAL, first);
    let comparison = estimated("computing", args.result.quiet, &estimate, || work(&measured));
    let comparison = comparison.map_err(|error| Failure::Message(error.to_string()))?;
    let (name, hash) = (model.model_name(analysis.name.as_deref()), analysis.hash());
    let report = CompareReport {
        name: &name,
        model_hash: Some(&hash),
        measured: &measured.source_name,
        model: &analysis.model,
        method: analysis.method,
        comparison: &comparison,
        within: &within,
        display: args.result.display_units,
    };
    let written =
        Written { folder, json: "comparison.json", more: &[], histories: &[], replaces: &[] };
    let status = conclude(&args.result, written, &report.sheet(), &[], &inputs)?;
    for bound in report.missed() {
        say(format_args!("missed: {}", bound.name()));
    }
    Ok(status)
}
