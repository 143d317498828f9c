//! `slipstick run` with several models or a suite of records.

use std::path::PathBuf;
use std::process::ExitCode;

use slipstick::input;
use slipstick::requests::{Kind, On};
use slipstick_files::{InputFiles, TARGET, read_target, stems_or_paths};

use super::assess::keeping_runs;
use crate::args::RunArgs;
use crate::failure::Failure;
use crate::model_file::read_model;
use crate::opened::{Opened, open_records};
use crate::results::{emit, folder};

/// Runs, prints and writes; status 1 where a certificate does not hold.
pub fn histories(args: &RunArgs) -> Result<ExitCode, Failure> {
    args.one.none_beside(Kind::Suite, "one model and one record beside it")?;
    let asked = args.suite.asked()?;
    if args.suite.has("history-of") && args.on.result.out.is_none() {
        let message = "--history-of: expected a folder for the history beside it, --out <DIR>";
        return Err(Failure::Message(message.to_owned()));
    }
    let target = args.target.as_deref().map(|path| {
        let (spectrum, sha256) = read_target(path).map_err(|found| {
            Failure::Message(format!("--target: expected {TARGET}, found {found}"))
        })?;
        Ok::<_, Failure>((path.display().to_string(), spectrum, sha256))
    });
    let target = target.transpose()?;
    // One motion is a suite of one.
    let mut suite = args.on.clone();
    suite.records.extend(args.motion.iter().map(|path| path.display().to_string()));
    // A record among the models is told before a model that lacks one.
    for model in args.models.iter().filter(|path| path.extension().is_some_and(|e| e != "toml")) {
        let file = read_model(model)?;
        input::from_bytes(&file.name, &file.bytes, &file.overrides(&[])?)
            .map_err(|error| file.failure(error))?;
    }
    // Every model has the same records: they are read once.
    let mut records = None;
    let mut opened = Vec::with_capacity(args.models.len());
    for model in &args.models {
        let read = || match &records {
            Some(read) => Ok(Clone::clone(read)),
            None => Ok(records.insert(open_records(&suite)?).clone()),
        };
        opened.push(Opened::open_with(model, &suite, read)?);
    }
    let of_target = |(path, _, sha256): &(String, _, String)| {
        (path.clone(), sha256.clone(), "target spectrum".to_owned())
    };
    let mut inputs = InputFiles::default();
    inputs.files.extend(target.iter().map(of_target));
    for InputFiles { files, texts } in opened.iter().map(|opened| &opened.inputs) {
        for file in files {
            if !inputs.files.contains(file) {
                inputs.files.push(file.clone());
            }
        }
        inputs.texts.extend_from_slice(texts);
    }
    let folder = folder(&suite.result, &inputs.paths())?;
    let names = names(&opened);
    let on: Vec<On<'_>> =
        opened.iter().zip(&names).map(|(opened, name)| On { name, ..opened.on() }).collect();
    let first = opened.first().ok_or_else(|| Failure::Message("expected a model".to_owned()))?;
    let target = target.map(|(path, spectrum, _)| (path, spectrum));
    keeping_runs(suite.result.out.as_deref(), |kept| {
        let answer = first.compute(&suite, |engine| {
            let target = target.as_ref().map(|(path, spectrum)| (path.as_str(), spectrum.clone()));
            kept.with(engine, |engine| asked.suite(&on, target, engine))
        })?;
        emit(&suite.result, folder, answer, &inputs)
    })
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
