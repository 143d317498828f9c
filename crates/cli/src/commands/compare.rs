//! `slipstick compare`: a prediction beside a measurement.

use std::path::PathBuf;
use std::process::ExitCode;

use slipstick::hash::sha256_hex;
use slipstick::input;
use slipstick::laboratory::compare::compare as compared;
use slipstick::laboratory::measured::Measured;
use slipstick::notice::Notice;
use slipstick::requests::Comparing;
use slipstick_files::{OutputFolder, SourceFile, TextFile, read_mapping, read_measured, time_left};
use slipstick_report::laboratory::CompareReport;
use slipstick_report::{FileNote, InputText};

use super::run::{ModelFile, command_line, overrides, read_model};
use crate::args::{CompareArgs, ResultArgs};
use crate::failure::{Failure, print, say};
use crate::progress::{TRIAL, estimated, reading};

/// Compares, prints and writes; status 1 where a bound is missed.
pub fn compare(args: &CompareArgs) -> Result<ExitCode, Failure> {
    let asked = args.fields.asked()?;
    let Comparing { within, method } = asked.comparing()?;
    let model = read_model(&args.model)?;
    let mut analysis = input::from_bytes(&model.name, &model.bytes, &overrides(&args.set)?)
        .map_err(|error| Failure::input(error, &model.text()))?;
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
    let report = CompareReport {
        name: &name(&model, analysis.name.as_deref()),
        measured: &measured.source_name,
        model: &analysis.model,
        method: analysis.method,
        comparison: &comparison,
        within: &within,
        inputs: &went_in.inputs(),
        files: &went_in.files(),
        command_line: &command_line(),
        display: args.result.display_units,
    };
    if let Some(mut folder) = folder {
        folder.write("comparison.json", report.to_json().as_bytes())?;
        folder.write("report.html", report.to_html().as_bytes())?;
        folder.commit()?;
    }
    print(&if args.result.json { report.to_json() } else { report.table() })?;
    tell(&args.result, &comparison.warnings);
    let missed = report.missed();
    for bound in &missed {
        say(format_args!("missed: {}", bound.name()));
    }
    Ok(ExitCode::from(u8::from(!missed.is_empty())))
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

/// Warnings, where standard output did not show them, and where the results are.
pub(super) fn tell(args: &ResultArgs, warnings: &[Notice]) {
    if args.quiet {
        return;
    }
    if args.json {
        for warning in warnings {
            let label = warning.severity().name();
            say(format_args!("{label}: {}: {}", warning.kind, warning.message));
        }
    }
    if let Some(out) = &args.out {
        say(format_args!("wrote {}", out.join("report.html").display()));
    }
}

/// Files that a result came from.
pub(super) struct WentIn {
    /// Path, hash, and what it is.
    files: Vec<(String, String, &'static str)>,
    /// Path and text.
    texts: Vec<(String, String)>,
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
            files.push((model.name.clone(), sha256_hex(&model.bytes), "model"));
            texts.push((model.name.clone(), model.text()));
        }
        files.extend(measured.iter().map(|file| (shown(file), file.sha256.clone(), "measured")));
        if let Some(mapping) = mapping {
            files.push((shown(&mapping.source), mapping.source.sha256.clone(), "mapping"));
            texts.push((shown(&mapping.source), mapping.text.clone()));
        }
        Self { files, texts }
    }

    /// As a report lists them.
    pub fn files(&self) -> Vec<FileNote<'_>> {
        self.files
            .iter()
            .map(|(path, sha256, description)| FileNote { path, sha256, description })
            .collect()
    }

    /// As a report shows them.
    pub fn inputs(&self) -> Vec<InputText<'_>> {
        self.texts.iter().map(|(path, text)| InputText { path, text }).collect()
    }
}
