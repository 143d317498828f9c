//! `slipstick record`: what is in records, and what can be made of them.

mod info;
mod output;
mod plot;
mod process;
mod spectrum;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::record::Format;
use slipstick_files::{RecordOptions, expand};

use crate::failure::{Failure, say};
use crate::record_args::{ReadArgs, RecordCommand};

/// Runs one of the commands.
pub fn record(command: &RecordCommand) -> Result<ExitCode, Failure> {
    match command {
        RecordCommand::Info(args) => info::info(args),
        RecordCommand::Convert(args) => output::convert(args),
        RecordCommand::Spectrum(args) => spectrum::spectrum(args),
        RecordCommand::Process(args) => process::process(args),
        RecordCommand::Plot(args) => plot::plot(args),
    }
}

/// Options of reading, checked.
fn read_options(args: &ReadArgs) -> Result<RecordOptions, Failure> {
    let format = args.format.as_deref().map(|word| {
        Format::from_keyword(word).ok_or_else(|| {
            let known = Format::ALL.map(Format::keyword).join(", ");
            refuse("--format", &format!("expected one of {known}, found {word:?}"))
        })
    });
    Ok(RecordOptions { format: format.transpose()?, ..args.record.options(false)? })
}

fn refuse(option: &str, reason: &str) -> Failure {
    Failure::Message(format!("{option}: {reason}"))
}

/// Damping ratios as typed: percent or ratio; 5 % where there are none.
fn damping_ratios(typed: &[String]) -> Result<Vec<f64>, Failure> {
    if typed.is_empty() {
        return Ok(vec![0.05]);
    }
    typed.iter().map(|text| damping_ratio(text)).collect()
}

/// A damping ratio as typed: percent or ratio.
pub(super) fn damping_ratio(text: &str) -> Result<f64, Failure> {
    let word = text.trim();
    let ratio = match word.strip_suffix('%') {
        Some(percent) => percent.trim_end().parse::<f64>().map(|percent| percent / 100.0),
        None => word.parse::<f64>(),
    };
    ratio.ok().filter(|ratio| (0.0..1.0).contains(ratio)).ok_or_else(|| {
        let expected = "expected damping from 0 % to below 100 %, such as \"5 %\" or 0.05";
        refuse("--damping", &format!("{expected}, found {text:?}"))
    })
}

/// What became of many files: the good ones go on, the bad ones are told as they come.
struct Many {
    files: Vec<PathBuf>,
    failed: usize,
    done: usize,
}

impl Many {
    /// The files that patterns mean; a pattern without files counts as a bad file.
    fn find(patterns: &[String]) -> Result<Self, Failure> {
        let mut many = Self { files: vec![], failed: 0, done: 0 };
        for pattern in patterns {
            match expand(Path::new(""), pattern) {
                Ok(files) => many.files.extend(files),
                Err(error) => many.fail(error.into())?,
            }
        }
        let mut known = std::collections::HashSet::new();
        many.files.retain(|file| known.insert(file.clone()));
        Ok(many)
    }

    /// Does the same with every file.
    fn each(&mut self, mut work: impl FnMut(&Path) -> Result<(), Failure>) -> Result<(), Failure> {
        for file in std::mem::take(&mut self.files) {
            match work(&file) {
                Ok(()) => self.done += 1,
                Err(failure) => self.fail(failure)?,
            }
        }
        Ok(())
    }

    fn fail(&mut self, failure: Failure) -> Result<(), Failure> {
        if matches!(failure, Failure::ClosedPipe) {
            return Err(failure);
        }
        failure.report();
        self.failed += 1;
        Ok(())
    }

    /// 0 where all is well, 1 where some files were bad, 2 where all were.
    fn status(&self) -> ExitCode {
        if self.failed > 0 && self.done > 0 {
            let files = if self.failed == 1 { "file" } else { "files" };
            say(format_args!(
                "{} {files} of {} could not be used",
                self.failed,
                self.failed + self.done
            ));
        }
        match (self.failed, self.done) {
            (0, _) => ExitCode::SUCCESS,
            (_, 0) => ExitCode::from(2),
            _ => ExitCode::from(1),
        }
    }
}
