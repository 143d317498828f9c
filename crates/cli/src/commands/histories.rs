//! `slipstick run` with several models or a suite of records.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::assessment::histories::{ModelOn, run_histories};
use slipstick_files::stems_or_paths;
use slipstick_report::assessment::histories::HistoriesReport;

use super::assessment::{Opened, conclude, folder, open_records, scaling_by};
use super::run::scale_factor;
use crate::args::{MethodName, RunArgs, SuiteArgs};
use crate::failure::Failure;

/// Runs, prints and writes; status 1 where a certificate does not hold.
pub fn histories(args: &RunArgs) -> Result<ExitCode, Failure> {
    if args.floor_spectrum {
        let expected = "--floor-spectrum: expected one model and one record beside it";
        return Err(Failure::Message(expected.to_owned()));
    }
    if matches!(args.method, Some(MethodName::Stepwise)) {
        let expected = "--method: expected exact, the only one over a suite, found stepwise";
        return Err(Failure::Message(expected.to_owned()));
    }
    let factor = args.scale.as_deref().map(scale_factor).transpose()?;
    let measure = args.measure.as_deref().unwrap_or("PGA");
    let (scaling, scaled) = scaling_by("scale-to", measure, args.scale_to.as_deref(), factor)?;
    let suites: Vec<SuiteArgs> = args.models.iter().map(|model| suite_of(args, model)).collect();
    // Every model has the same records: they are read once.
    let mut records = None;
    let mut opened = Vec::with_capacity(suites.len());
    for suite in &suites {
        let read = || match &records {
            Some(read) => Ok(Clone::clone(read)),
            None => Ok(records.insert(open_records(suite)?).clone()),
        };
        opened.push(Opened::open_with(suite, read)?);
    }
    let mut sources: Vec<(String, String, String)> = Vec::new();
    let mut warnings = Vec::new();
    for opened in &opened {
        for source in opened.sources() {
            if !sources.contains(&source) {
                sources.push(source);
            }
        }
        for warning in &opened.warnings {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
    }
    let inputs: Vec<PathBuf> = sources.iter().map(|(path, ..)| path.into()).collect();
    let folder = folder(&args.result, &inputs)?;
    let names = names(&opened);
    let models: Vec<ModelOn<'_>> = opened
        .iter()
        .zip(&names)
        .map(|(opened, name)| ModelOn { name, analysis: &opened.analysis, suite: &opened.suite })
        .collect();
    let first = opened.first().zip(suites.first());
    let (first, suite) = first.ok_or_else(|| Failure::Message("expected a model".to_owned()))?;
    let histories = first.compute(suite, |engine| run_histories(&models, scaling, engine))?;
    let report = HistoriesReport {
        version: env!("CARGO_PKG_VERSION"),
        histories: &histories,
        scaled: if opened.iter().all(|opened| opened.suite.made) { "" } else { &scaled },
        warnings: &warnings,
        display: args.result.display_units.into(),
    };
    let sheet = report.sheet();
    let tables = [("runs.csv", &histories.runs), ("governing.csv", &histories.governing)];
    let texts: Vec<(String, String)> = opened.iter().flat_map(Opened::inputs).collect();
    conclude(&args.result, folder, &sheet, &tables, &sources, &texts)?;
    let records = histories.models.iter().flat_map(|model| &model.records);
    let failed = records.flat_map(|on| &on.holds).any(|holds| !holds);
    Ok(ExitCode::from(u8::from(failed)))
}

/// The options of a model with the suite; one motion is a suite of one.
fn suite_of(args: &RunArgs, model: &Path) -> SuiteArgs {
    let motion = args.motion.iter().map(|path| path.display().to_string());
    SuiteArgs {
        model: model.to_owned(),
        records: args.records.iter().cloned().chain(motion).collect(),
        vertical: args.vertical.clone(),
        record: args.record.clone(),
        set: args.set.clone(),
        jobs: None,
        result: args.result.clone(),
    }
}

/// Names of the models: of several the stems of their files, or their paths where stems repeat.
fn names(opened: &[Opened]) -> Vec<String> {
    match opened {
        [one] => vec![one.name.clone()],
        _ => {
            let files: Vec<PathBuf> = opened.iter().map(|o| o.file.name.clone().into()).collect();
            stems_or_paths(&files)
        }
    }
}
