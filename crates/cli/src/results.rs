//! What a command leaves: a printed sheet, and a folder with tables, figures and a report.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::requests::Answer;
use slipstick::response::Response;
use slipstick::table::Table;
use slipstick_files::{InputFiles, OutputFolder, history_csv, to_csv, to_parquet};
use slipstick_report::assessment::{Sheet, answer};
use slipstick_report::report;

use crate::args::ResultArgs;
use crate::failure::{Failure, print, say};

/// The folder for results, made before any work is done.
pub fn folder(args: &ResultArgs, inputs: &[PathBuf]) -> Result<Option<OutputFolder>, Failure> {
    Ok(args.out.as_deref().map(|out| OutputFolder::create(out, inputs)).transpose()?)
}

/// Files that only some answers have: those of another would be stale beside a new summary.
pub const OF_SOME: [&str; 7] = [
    "history.csv",
    "events.csv",
    "floor-spectra.csv",
    "floor-spectra.parquet",
    "floor-spectra.svg",
    "profiles.csv",
    "profiles.svg",
];

/// Where a result is written.
pub struct Written<'a> {
    /// The folder, if any.
    pub folder: Option<OutputFolder>,
    /// Name of the file of JSON.
    pub json: &'a str,
    /// Further files: names and texts.
    pub more: &'a [(&'static str, String)],
    /// Histories by the names of their files.
    pub histories: &'a [(String, Response)],
    /// Files of other results, which would be stale beside these where they are not written anew.
    pub replaces: &'a [&'static str],
}

impl Written<'_> {
    /// The usual files.
    pub fn usual(folder: Option<OutputFolder>) -> Self {
        Self { folder, json: "summary.json", more: &[], histories: &[], replaces: &OF_SOME }
    }
}

/// Writes tables, figures, summary and report, and prints the result; status 1 where it is not complete.
pub fn conclude(
    args: &ResultArgs,
    written: Written<'_>,
    sheet: &Sheet,
    tables: &[(&str, &Table)],
    inputs: &InputFiles,
) -> Result<ExitCode, Failure> {
    let Written { folder, json, more, histories, replaces } = written;
    if let Some(mut folder) = folder {
        folder.replaces(replaces);
        for (name, table) in tables {
            match name.rsplit_once('.') {
                Some((_, "parquet")) => folder.write(name, &to_parquet(Path::new(name), table)?)?,
                _ => folder.write(name, to_csv(table).as_bytes())?,
            }
        }
        for figure in &sheet.figures {
            folder.write(&format!("{}.svg", figure.id), figure.svg.as_str().as_bytes())?;
        }
        folder.write(json, sheet.to_json().as_bytes())?;
        folder.write("report.html", inputs.page(sheet, &command_line()).as_bytes())?;
        for (name, response) in histories {
            folder.write_with(name, |to| history_csv(response, to))?;
        }
        for (name, text) in more {
            folder.write(name, text.as_bytes())?;
        }
        folder.commit()?;
    }
    print(&if args.json { sheet.to_json() } else { sheet.to_text() })?;
    let status = ExitCode::from(u8::from(!sheet.complete));
    if args.quiet {
        return Ok(status);
    }
    if args.json {
        for warning in &sheet.warnings {
            let label = warning.severity().name();
            say(format_args!("{label}: {}: {}", warning.kind, warning.message));
        }
    }
    if let Some(out) = &args.out {
        for name in core::iter::once("report.html").chain(more.iter().map(|(name, _)| *name)) {
            say(format_args!("wrote {}", out.join(name).display()));
        }
    }
    Ok(status)
}

/// Prints and writes the answer to a request.
pub fn emit(
    args: &ResultArgs,
    folder: Option<OutputFolder>,
    mut answer: Answer,
    inputs: &InputFiles,
) -> Result<ExitCode, Failure> {
    let sheet = answer::sheet(&answer, args.display_units);
    let histories = answer::histories(&mut answer);
    let tables = answer::tables(answer);
    let files: Vec<(String, &Table)> = tables
        .iter()
        .flat_map(|tabled| {
            tabled.forms.iter().map(|form| (format!("{}.{form}", tabled.name), &tabled.table))
        })
        .collect();
    let files: Vec<(&str, &Table)> =
        files.iter().map(|(name, table)| (&name[..], *table)).collect();
    conclude(
        args,
        Written { histories: &histories, ..Written::usual(folder) },
        &sheet,
        &files,
        inputs,
    )
}

/// The command as it was typed, with quotes where the shell needs them.
pub fn command_line() -> String {
    let words = std::env::args_os().skip(1);
    report::command_line(words.map(|word| word.to_string_lossy().into_owned()))
}
