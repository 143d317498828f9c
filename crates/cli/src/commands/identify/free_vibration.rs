//! Frequency and damping from free vibration.

use std::process::ExitCode;

use slipstick::laboratory::identify::{
    FreeVibrationRequest, ModelText, free_vibration as identify_free_vibration,
};
use slipstick::units::Dimension;
use slipstick_files::{read_mapping, time_left};

use super::{Inputs, failure, finish, output, read, text};
use crate::args::{FreeVibrationArgs, quantity};
use crate::commands::run::read_model;
use crate::failure::Failure;
use crate::progress::{TRIAL, estimated};

/// Identifies frequency and damping ratio of the storey.
pub fn free_vibration(args: &FreeVibrationArgs) -> Result<ExitCode, Failure> {
    let model = args.model.as_deref().map(read_model).transpose()?;
    let text = model.as_ref().map(text).transpose()?.unwrap_or_default();
    let (mapping, mapping_file) = read_mapping(args.mapping.mapping.as_deref(), &args.mapping.map)?;
    let (measured, source) = read(&args.file, &mapping, args.result.quiet)?;
    let inputs =
        Inputs { model: model.as_ref(), sources: &[&source], mapping: mapping_file.as_ref() };
    let folder = output(&args.result, &inputs.paths())?;
    let end = |option: &str, text: &Option<String>, none: f64| match text {
        Some(text) => quantity(option, text, Dimension::Time),
        None => Ok(none),
    };
    let request = FreeVibrationRequest {
        model: model.as_ref().map(|model| ModelText { name: &model.name, text: &text, set: &[] }),
        channel: args.channel.as_deref(),
        span_s: [
            end("--from", &args.from, f64::NEG_INFINITY)?,
            end("--to", &args.to, f64::INFINITY)?,
        ],
    };
    let first =
        |samples| identify_free_vibration(&request, &measured.first(samples)).ok().map(|_| ());
    let estimate = || time_left([1024, measured.samples()], TRIAL, first);
    let fit = || identify_free_vibration(&request, &measured);
    let identified = estimated("fitting", args.result.quiet, &estimate, fit);
    let identified = identified.map_err(|error| failure(error, &text))?;
    finish(&args.result, folder, &inputs, core::slice::from_ref(&measured), &identified)
}
