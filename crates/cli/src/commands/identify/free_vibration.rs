//! Frequency and damping from free vibration.

use std::path::PathBuf;
use std::process::ExitCode;

use slipstick::input::Channel;
use slipstick::laboratory::free_vibration::free_vibration as fit_free_vibration;
use slipstick::laboratory::measured::{Measured, Series};
use slipstick::units::Dimension;
use slipstick_files::{read_mapping, read_measured, time_left};
use slipstick_report::IdentifyReport;
use slipstick_report::laboratory::free_vibration::{ASSUMPTION, facts, figures, json};

use super::{finish, fitted_model, output, quantity};
use crate::args::FreeVibrationArgs;
use crate::commands::compare::WentIn;
use crate::commands::run::{command_line, read_model};
use crate::failure::Failure;
use crate::progress::{TRIAL, estimated, watched};

/// Identifies frequency and damping ratio of the storey.
pub fn free_vibration(args: &FreeVibrationArgs) -> Result<ExitCode, Failure> {
    let model = args.model.as_deref().map(read_model).transpose()?;
    let (mapping, mapping_file) = read_mapping(args.mapping.mapping.as_deref(), &args.mapping.map)?;
    let (measured, source) =
        watched("reading", args.result.quiet, || read_measured(&args.file, &mapping))?;
    let inputs: Vec<PathBuf> = core::iter::once(args.file.clone())
        .chain(model.as_ref().map(|model| model.path.clone()))
        .chain(mapping_file.as_ref().map(|file| file.source.path.clone()))
        .collect();
    let folder = output(&args.result, &inputs)?;
    let series = chosen(&measured, args.channel.as_deref())?;
    let end = |option: &str, text: &Option<String>, none: f64| match text {
        Some(text) => quantity(option, text, Dimension::Time),
        None => Ok(none),
    };
    let span_s =
        [end("--from", &args.from, f64::NEG_INFINITY)?, end("--to", &args.to, f64::INFINITY)?];
    let inside = |t: &f64| (span_s[0]..=span_s[1]).contains(t);
    let (times_s, values): (Vec<f64>, Vec<f64>) = series
        .times_s
        .iter()
        .zip(&series.values)
        .filter(|(t, _)| inside(t))
        .map(|(t, v)| (*t, *v))
        .unzip();
    let work = |samples: usize| fit_free_vibration(&times_s[..samples], &values[..samples]);
    let first = |samples| Some(work(samples)).map(|_| ());
    let estimate = || time_left([1024, times_s.len()], TRIAL, first);
    let fit = estimated("fitting", args.result.quiet, &estimate, || work(times_s.len()));
    let estimates = vec![fit.frequency.clone(), fit.damping_ratio.clone()];
    let mut warnings = measured.warnings.clone();
    let mut more = Vec::new();
    if let Some(model) = model.as_ref().filter(|_| fit.frequency.value().is_some()) {
        let (analysis, decided) = fitted_model(model, &[], &estimates)?;
        warnings.extend(decided);
        more.push(("model.toml", analysis.to_toml(None).into_bytes()));
    }
    let went_in = WentIn::of_files(model.as_ref(), &[&source], mapping_file.as_ref());
    let span_s = [times_s.first(), times_s.last()].map(|t| t.copied().unwrap_or(0.0));
    let display = args.result.display_units.into();
    let report = IdentifyReport {
        version: env!("CARGO_PKG_VERSION"),
        job: "free-vibration",
        measured: &measured.source_name,
        estimates,
        facts: facts(series.channel, span_s, &fit),
        tables: Vec::new(),
        assumption: ASSUMPTION.to_owned(),
        json: json(series.channel, span_s, &fit),
        figures: figures(series.channel, &times_s, &values, &fit, display),
        warnings,
        inputs: &went_in.inputs(),
        files: &went_in.files(),
        command_line: &command_line(),
        display,
    };
    finish(&args.result, folder, &report, &more)
}

/// The quantity asked for, else the only one.
fn chosen<'a>(measured: &'a Measured, name: Option<&str>) -> Result<&'a Series, Failure> {
    let names: Vec<String> = measured.series.iter().map(|s| s.channel.name()).collect();
    let fault = |expected: &str| {
        Failure::Message(format!(
            "{}: expected {expected}, found the quantities {}",
            measured.source_name,
            if names.is_empty() { "none".to_owned() } else { names.join(", ") }
        ))
    };
    match (name, measured.series.as_slice()) {
        (Some(name), _) => {
            let channel = Channel::parse(name).and_then(|channel| measured.get(channel));
            channel.ok_or_else(|| fault(&format!("a quantity {name:?}")))
        }
        (None, [only]) => Ok(only),
        (None, []) => Err(fault("a quantity, such as --map \"storey1_acceleration = COLUMN [g]\"")),
        (None, _) => Err(fault("one quantity: choose it with --channel")),
    }
}
