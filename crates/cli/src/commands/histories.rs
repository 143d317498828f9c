//! `slipstick run` with several models or a suite of records.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::assessment::histories::{ModelOn, run_histories};
use slipstick_report::assessment::histories::HistoriesReport;

use super::assessment::{Opened, conclude, folder, scaling_by};
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
    let factor = args.scale.as_deref().map(factor).transpose()?;
    let measure = args.measure.as_deref().unwrap_or("PGA");
    let (scaling, scaled) = scaling_by("scale-to", measure, args.scale_to.as_deref(), factor)?;
    let suites: Vec<SuiteArgs> = args.models.iter().map(|model| suite_of(args, model)).collect();
    let opened = suites.iter().map(Opened::open).collect::<Result<Vec<_>, Failure>>()?;
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

/// Names of the models: of several the stems of their files, or the files where stems repeat.
fn names(opened: &[Opened]) -> Vec<String> {
    if let [one] = opened {
        return vec![one.name.clone()];
    }
    let stem = |opened: &Opened| {
        let stem = Path::new(&opened.file.name).file_stem();
        stem.map_or_else(|| opened.file.name.clone(), |stem| stem.to_string_lossy().into_owned())
    };
    let stems: Vec<String> = opened.iter().map(stem).collect();
    let repeats = |name: &String| stems.iter().filter(|other| *other == name).count() > 1;
    if stems.iter().any(repeats) {
        return opened.iter().map(|opened| opened.file.name.clone()).collect();
    }
    stems
}

/// The factor of `--scale`.
fn factor(text: &str) -> Result<f64, Failure> {
    text.trim()
        .parse()
        .map_err(|_| Failure::Message(format!("--scale: expected a factor, found {text:?}")))
}
