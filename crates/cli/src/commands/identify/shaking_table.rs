//! Parameters of a model from a shaking-table record.

use std::path::PathBuf;
use std::process::ExitCode;

use slipstick::input::{self, Channel};
use slipstick::laboratory::compare::table_csv;
use slipstick::laboratory::shaking_table::{
    Builder, Parameter, TableTest, shaking_table as fit_table,
};
use slipstick_files::{read_mapping, read_measured};
use slipstick_report::IdentifyReport;
use slipstick_report::laboratory::shaking_table::{agreement, assumption, facts, json};

use super::{finish, fitted_model, output};
use crate::args::ShakingTableArgs;
use crate::commands::compare::WentIn;
use crate::commands::run::{command_line, overrides, read_model};
use crate::failure::Failure;
use crate::progress::{counted, watched};

/// Fits chosen keys of a model to measured histories.
pub fn shaking_table(args: &ShakingTableArgs) -> Result<ExitCode, Failure> {
    let model = read_model(&args.model)?;
    let set = overrides(&args.set, None)?;
    let analysis = input::from_bytes(&model.name, &model.bytes, &set)
        .map_err(|error| Failure::input(error, &model.text()))?;
    let message = |error: &dyn std::fmt::Display| Failure::Message(error.to_string());
    let texts: Vec<&str> = args.fit.iter().map(String::as_str).collect();
    let parameters = texts.iter().map(|text| Parameter::parse(text, &analysis, &texts));
    let parameters: Vec<Parameter> =
        parameters.collect::<Result<_, _>>().map_err(|error| message(&error))?;
    let using = using(&args.using)?;
    let (mapping, mapping_file) = read_mapping(args.mapping.mapping.as_deref(), &args.mapping.map)?;
    let (measured, source) =
        watched("reading", args.result.quiet, || read_measured(&args.file, &mapping))?;
    let inputs: Vec<PathBuf> = [args.file.clone(), model.path.clone()]
        .into_iter()
        .chain(mapping_file.as_ref().map(|file| file.source.path.clone()))
        .collect();
    let folder = output(&args.result, &inputs)?;
    let text = model.text();
    let builder = Builder::new(&model.name, &text, &set, &parameters);
    let start: Option<Vec<f64>> = parameters.iter().map(|p| analysis.value(&p.path)).collect();
    let fit = counted("fitting", args.result.quiet, |engine| {
        let build = |values: &[f64]| builder.model(values);
        let test = TableTest {
            measured: &measured,
            parameters: &parameters,
            build: &build,
            start,
            using,
            seed: args.seed,
        };
        fit_table(&test, engine)
    });
    let fit = fit.map_err(|error| message(&error))?;
    let (fitted, decided) = fitted_model(&model, &set, &fit.estimates)?;
    let mut warnings = fit.comparison.warnings.clone();
    warnings.extend(fit.warnings.clone());
    warnings.extend(decided);
    let display = args.result.display_units.into();
    let version = env!("CARGO_PKG_VERSION");
    let (rows, figures) = agreement(&fit, &measured.source_name, version, display);
    let went_in = WentIn::of_files(Some(&model), &[&source], mapping_file.as_ref());
    let report = IdentifyReport {
        version,
        job: "shaking-table",
        measured: &measured.source_name,
        estimates: fit.estimates.clone(),
        facts: facts(&fit, display),
        tables: vec![("Agreement with the best values".to_owned(), rows)],
        assumption: assumption(&fit),
        json: json(&fit, &parameters, args.seed),
        figures,
        warnings,
        inputs: &went_in.inputs(),
        files: &went_in.files(),
        command_line: &command_line(),
        display,
    };
    let more = [
        ("model.toml", fitted.to_toml(Some("table.csv")).into_bytes()),
        ("table.csv", table_csv(&fit.comparison.motion).into_bytes()),
    ];
    finish(&args.result, folder, &report, &more)
}

/// The quantities to fit; `None` for all.
fn using(names: &[String]) -> Result<Option<Vec<Channel>>, Failure> {
    if names.is_empty() {
        return Ok(None);
    }
    let channel = |name: &String| {
        Channel::parse(name).ok_or_else(|| {
            let expected = "a quantity such as sliding_displacement or block_acceleration";
            Failure::Message(format!("--using: expected {expected}, found {name:?}"))
        })
    };
    names.iter().map(channel).collect::<Result<_, _>>().map(Some)
}
