//! `slipstick compare`: a prediction beside a measurement.

use std::path::PathBuf;
use std::process::ExitCode;

use slipstick::hash::sha256_hex;
use slipstick::input;
use slipstick::laboratory::compare::compare as compared;
use slipstick::laboratory::measured::Measured;
use slipstick::requests::Comparing;
use slipstick_files::{OutputFolder, SourceFile, TextFile, read_mapping, read_measured, time_left};
use slipstick_report::laboratory::CompareReport;

use super::assessment::{Written, conclude};
use super::run::{ModelFile, read_model};
use crate::args::{CompareArgs, ResultArgs};
use crate::failure::{Failure, say};
use crate::progress::{TRIAL, estimated, reading};

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
    let folder = output(&args.result, &model, &source, mapping_file.as_ref())?;
    let work = |measured: &Measured| compared(measured, &analysis.model, analysis.method);
    let first = |samples| work(&measured.first(samples)).ok().map(|_| ());
    let estimate = || time_left([256, measured.samples()], TRIAL, first);
    let comparison = estimated("computing", args.result.quiet, &estimate, || work(&measured));
    let comparison = comparison.map_err(|error| Failure::Message(error.to_string()))?;
    let went_in = WentIn::of(&model, &source, mapping_file.as_ref());
    let (name, hash) = (name(&model, analysis.name.as_deref()), analysis.hash());
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
    let WentIn { files, texts } = &went_in;
    let written = Written { folder, json: "comparison.json", more: &[], replaces: &[] };
    let status = conclude(&args.result, written, &report.sheet(), &[], files, texts)?;
    for bound in report.missed() {
        say(format_args!("missed: {}", bound.name()));
    }
    Ok(status)
}

/// The name of a model, else the stem of its file.
pub(super) fn name(model: &ModelFile, name: Option<&str>) -> String {
    let stem = model.path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    name.map(str::to_owned).or(stem).unwrap_or_else(|| "model".to_owned())
}

/// The folder for the results, refused where it would replace an input.
pub(super) fn output(
    args: &ResultArgs,
    model: &ModelFile,
    measured: &SourceFile,
    mapping: Option<&TextFile>,
) -> Result<Option<OutputFolder>, Failure> {
    let Some(out) = &args.out else { return Ok(None) };
    let mut inputs: Vec<PathBuf> = vec![model.path.clone(), measured.path.clone()];
    inputs.extend(mapping.map(|file| file.source.path.clone()));
    Ok(Some(OutputFolder::create(out, &inputs)?))
}

/// Files that a result came from.
pub(super) struct WentIn {
    /// Path, hash, and what it is.
    pub files: Vec<(String, String, String)>,
    /// Path and text.
    pub texts: Vec<(String, String)>,
}

impl WentIn {
    /// A model, a measured file and perhaps a mapping.
    pub fn of(model: &ModelFile, measured: &SourceFile, mapping: Option<&TextFile>) -> Self {
        Self::of_files(Some(model), &[measured], mapping)
    }

    /// The same of several measured files, perhaps without a model.
    pub fn of_files(
        model: Option<&ModelFile>,
        measured: &[&SourceFile],
        mapping: Option<&TextFile>,
    ) -> Self {
        let shown = |file: &SourceFile| file.path.display().to_string();
        let (mut files, mut texts) = (Vec::new(), Vec::new());
        if let Some(model) = model {
            files.push((model.name.clone(), sha256_hex(&model.bytes), "model".to_owned()));
            texts.push((model.name.clone(), model.text()));
        }
        let what =
            |what: &str, file: &SourceFile| (shown(file), file.sha256.clone(), what.to_owned());
        files.extend(measured.iter().map(|file| what("measured", file)));
        if let Some(mapping) = mapping {
            files.push(what("mapping", &mapping.source));
            texts.push((shown(&mapping.source), mapping.text.clone()));
        }
        Self { files, texts }
    }
}
