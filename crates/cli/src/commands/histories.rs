//! `slipstick run` with several models or a suite of records.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::assessment::code::{Plan, named};
use slipstick::assessment::histories::{ModelOn, run_histories};
use slipstick::assessment::suite::{PairScaling, times};
use slipstick::input;
use slipstick::motion::intensity::LevelMeasure;
use slipstick::motion::target::TargetSpectrum;
use slipstick::units::Dimension;
use slipstick_files::{read_target, stems_or_paths};
use slipstick_report::assessment::histories::HistoriesReport;

use super::assessment::{Opened, Written, conclude, failure, folder, message, open_records};
use super::run::{read_model, scale_factor};
use crate::args::{MethodName, RunArgs, SuiteArgs, quantity};
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
    let (scaling, scaled, target) = scaling(args, measure, factor)?;
    let set = args.set()?;
    let suites: Vec<SuiteArgs> =
        args.models.iter().map(|model| suite_of(args, model, &set)).collect();
    // A record among the models is told before a model that lacks one.
    for model in args.models.iter().filter(|path| path.extension().is_some_and(|e| e != "toml")) {
        let file = read_model(model)?;
        input::from_bytes(&file.name, &file.bytes, &[])
            .map_err(|error| Failure::input(error, &file.text()))?;
    }
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
    let mut sources: Vec<(String, String, String)> = target.into_iter().collect();
    for opened in &opened {
        for source in opened.sources() {
            if !sources.contains(&source) {
                sources.push(source);
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
    let histories = first.compute(suite, |engine| run_histories(&models, &scaling, engine))?;
    let plan = args.eccentricity.as_deref().map(Plan::parse).transpose().map_err(failure)?;
    let report = HistoriesReport {
        histories: &histories,
        hazard: args.hazard.as_deref(),
        factors: args.factors()?,
        plan,
        scaled: if opened.iter().all(|opened| opened.suite.made) { "" } else { &scaled },
        display: args.result.display_units.into(),
    };
    let sheet = report.sheet();
    let tables = [("runs.csv", &histories.runs), ("governing.csv", &histories.governing)];
    let texts: Vec<(String, String)> = opened.iter().flat_map(Opened::inputs).collect();
    conclude(&args.result, Written::usual(folder), &sheet, &tables, &sources, &texts)
}

/// A file that went in: path, hash, what it is.
type Source = (String, String, String);

/// How the suite is scaled, that in words, and the file of a target spectrum.
fn scaling(
    args: &RunArgs,
    name: &str,
    factor: Option<f64>,
) -> Result<(PairScaling, String, Option<Source>), Failure> {
    let range = args.periods.as_deref().map(|text| {
        let wrong = || message("--periods", "two periods, the shorter first: 0.6 s..3.8 s", text);
        let (from, to) = text.split_once("..").ok_or_else(wrong)?;
        let [from_s, to_s] =
            [from, to].map(|text| quantity("--periods", text.trim(), Dimension::Time));
        let range = [from_s?, to_s?];
        if 0.0 < range[0] && range[0] < range[1] { Ok(range) } else { Err(wrong()) }
    });
    let range = range.transpose()?;
    let (spectrum, words, source) = match (&args.target, &args.code_spectrum) {
        (Some(path), _) => {
            let (spectrum, sha256) = read_target(path).map_err(|found| {
                let expected = "a CSV with the columns period_s and sa_g";
                Failure::Message(format!("--target: expected {expected}, found {found}"))
            })?;
            let path = path.display().to_string();
            (spectrum, path.clone(), Some((path, sha256, "target spectrum".to_owned())))
        }
        (None, Some(text)) => (code_spectrum(text)?, format!("the spectrum {text}"), None),
        (None, None) => {
            if let Some(text) = &args.periods {
                let expected = "--target or --code-spectrum beside them";
                return Err(message("--periods", expected, text));
            }
            let Some(level) = &args.scale_to else {
                let factor = factor.unwrap_or(1.0);
                if !(factor.is_finite() && factor != 0.0) {
                    return Err(message("--scale", "a factor other than 0", &factor.to_string()));
                }
                return Ok((PairScaling::Factor(factor), times(factor), None));
            };
            let measure = LevelMeasure::parse(name)
                .map_err(|error| Failure::Message(format!("--measure: {error}")))?;
            let scaling = PairScaling::to_level("scale-to", measure, level).map_err(failure)?;
            return Ok((scaling, format!(" scaled to {measure} = {}", level.trim()), None));
        }
    };
    let range = range.ok_or_else(|| message("--periods", "the range of periods", "nothing"))?;
    let words = format!(" scaled to {words}");
    Ok((PairScaling::Target(spectrum, range), words, source))
}

/// The shape of a code from its three parameters.
fn code_spectrum(text: &str) -> Result<TargetSpectrum, Failure> {
    let expected = "three parameters: sds = 1.2 g, sd1 = 0.8 g, tl = 8 s";
    let wrong = || message("--code-spectrum", expected, text);
    let Some([Some(sds), Some(sd1), Some(tl)]) = named(text, ["sds", "sd1", "tl"]) else {
        return Err(wrong());
    };
    let positive = |text: &str, dimension| {
        let value = quantity("--code-spectrum", text, dimension)?;
        if value.is_finite() && value > 0.0 { Ok(value) } else { Err(wrong()) }
    };
    let [sds_m_per_s2, sd1_m_per_s2] =
        [sds, sd1].map(|text| positive(text, Dimension::Acceleration));
    let (sds_m_per_s2, sd1_m_per_s2) = (sds_m_per_s2?, sd1_m_per_s2?);
    let tl_s = positive(tl, Dimension::Time)?;
    Ok(TargetSpectrum::Code { sds_m_per_s2, sd1_m_per_s2, tl_s })
}

/// The options of a model with the suite; one motion is a suite of one.
fn suite_of(args: &RunArgs, model: &Path, set: &[String]) -> SuiteArgs {
    let motion = args.motion.iter().map(|path| path.display().to_string());
    SuiteArgs {
        model: model.to_owned(),
        records: args.records.iter().cloned().chain(motion).collect(),
        vertical: args.vertical.clone(),
        second: args.second.clone(),
        record: args.record.clone(),
        set: set.to_vec(),
        jobs: args.jobs,
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
