//! `slipstick fragility`: a lognormal fragility with its certainty.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use slipstick::assessment::AssessmentError;
use slipstick::assessment::observed::{
    FitTo, FragilityRequest, run_fragility, run_fragility_by, usual_by,
};
use slipstick::study::engine::Engine;
use slipstick::table::Table;
use slipstick_files::{
    OutputFolder, ReadTable, expand, limit_of_ida, read_bytes, read_csv, read_runs, read_table,
    reading_time, sha256_hex, time_left,
};
use slipstick_report::assessment::Sheet;
use slipstick_report::assessment::fragility::{FragilityFamily, FragilityReport};

use super::assessment::{conclude, failure, folder, limit, share};
use crate::args::{FitToName, FragilityArgs};
use crate::failure::Failure;
use crate::progress::{TRIAL, counted, estimated};

/// Fits, prints and writes.
pub fn fragility(args: &FragilityArgs) -> Result<ExitCode, Failure> {
    let of = |option: &str, text: &Option<String>| {
        text.as_deref().map(|text| limit(option, text, &args.demand)).transpose()
    };
    let bound = match of("--limit", &args.limit)? {
        None => limit_of_ida(&args.source, &args.demand),
        given => given,
    };
    let confidence = share("--confidence", args.confidence)?;
    let read = || read(&args.source);
    let estimate = || reading_left(&args.source);
    let (mut sources, read) = estimated("reading", args.result.quiet, &estimate, read)?;
    let name = args.source.display().to_string();
    let request = FragilityRequest {
        table: &read.table,
        source_name: &read.path.display().to_string(),
        demand: &args.demand,
        limit: bound,
        measure: args.measure.as_deref(),
        units: args.units.as_deref(),
        fit_to: args.fit_to.map(|name| match name {
            FitToName::Counts => FitTo::Counts,
            FitToName::Capacities => FitTo::Capacities,
            FitToName::Cloud => FitTo::Cloud,
        }),
        floor: of("--floor", &args.floor)?,
        cap: of("--cap", &args.cap)?,
        keep: &args.keep,
        bootstrap: args.bootstrap.map(|draws| (draws, args.seed)),
    };
    let failed = |error| match error {
        AssessmentError::Cell(error) => read.cell_error(&error).into(),
        other => failure(other),
    };
    let inputs: Vec<PathBuf> = sources.iter().map(|(path, ..)| path.into()).collect();
    let display = args.result.display_units.into();
    let by = match &args.by {
        Some(by) => Some(by.as_str()),
        None => usual_by(&request).map_err(failed)?,
    };
    if let Some(by) = by {
        let fit = |engine: &Engine<'_>| run_fragility_by(&request, by, engine);
        let (groups, by_unit) = counted("fitting", args.result.quiet, fit).map_err(failed)?;
        let folder = folder(&args.result, &inputs)?;
        let family = FragilityFamily {
            name: &name,
            by,
            by_unit: &by_unit,
            groups: &groups,
            demand: &args.demand,
            limit: bound,
            confidence,
            display,
        };
        let Some(sheet) = family.sheet() else {
            let reason = groups.iter().find_map(|group| group.run.as_ref().err());
            let reason = reason.map_or("no rows".to_owned(), ToString::to_string);
            return Err(Failure::Message(format!("--by {by}: no value has a curve: {reason}")));
        };
        let curves = family.curves();
        let mut table = Table::default();
        if curves.iter().any(|(group, _)| group.value.is_nan()) {
            table.texts(by, curves.iter().map(|(group, _)| group.text.clone()).collect());
        } else {
            table.numbers(by, &by_unit, curves.iter().map(|(group, _)| group.value).collect());
        }
        let unit = groups.iter().find_map(|group| Some(&group.run.as_ref().ok()?.measure_unit));
        let rows: Vec<[f64; 4]> = curves.iter().map(|(_, row)| *row).collect();
        curve_columns(&mut table, unit.map_or("", String::as_str), &rows);
        return finish(args, folder, &sheet, &table, &sources);
    }
    let run = counted("fitting", args.result.quiet, |engine| run_fragility(&request, engine));
    let run = run.map_err(failed)?;
    if let Some((.., kind)) = sources.first_mut() {
        run.kind.clone_into(kind);
    }
    let folder = folder(&args.result, &inputs)?;
    let report = FragilityReport {
        name: &name,
        demand: &args.demand,
        limit: bound,
        run: &run,
        confidence,
        display,
    };
    let mut table = Table::default();
    curve_columns(&mut table, &run.measure_unit, &report.curve());
    finish(args, folder, &report.sheet(), &table, &sources)
}

/// Intensity, probability and band of curves.
fn curve_columns(table: &mut Table, unit: &str, rows: &[[f64; 4]]) {
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
    table
        .numbers("level", unit, column(0))
        .numbers("probability", "", column(1))
        .numbers("band_low", "", column(2))
        .numbers("band_high", "", column(3));
}

fn finish(
    args: &FragilityArgs,
    folder: Option<OutputFolder>,
    sheet: &Sheet,
    table: &Table,
    sources: &[Source],
) -> Result<ExitCode, Failure> {
    let tables = [("fragility.csv", table), ("fragility.parquet", table)];
    conclude(&args.result, folder, sheet, &tables, sources, &[])
}

/// A file that was read: its path, its hash, what it is.
type Source = (String, String, String);

/// What the commands write into their folders, the first that is there.
const TABLES: [&str; 4] = ["parts/part-*.parquet", "part-*.parquet", "ida.parquet", "runs.parquet"];

/// The files of a source: itself, or those of the folder of a command.
fn files(source: &Path) -> Result<Vec<PathBuf>, Failure> {
    Ok(if source.is_dir() {
        let found = TABLES.iter().find_map(|pattern| expand(source, pattern).ok());
        found.ok_or_else(|| {
            let expected = "a table, or a folder that ida, study, spectrum or design wrote";
            Failure::Message(format!(
                "SOURCE: expected {expected}, found the folder {} without runs",
                source.display()
            ))
        })?
    } else {
        vec![source.to_owned()]
    })
}

/// Time that reading a source may take, from its first lines or its first parts.
fn reading_left(source: &Path) -> Option<Duration> {
    let piece = |bytes: &[u8]| drop(read_csv(source, &String::from_utf8_lossy(bytes)));
    let files = files(source).ok()?;
    let parts = |count: usize| read_table(&files[..count]).ok().map(|_| ());
    match files.as_slice() {
        [one] => reading_time(one, TRIAL, piece),
        many => time_left([1, many.len()], TRIAL, parts),
    }
}

/// The table of a source, and its files with their hashes.
fn read(source: &Path) -> Result<(Vec<Source>, ReadTable), Failure> {
    let files = files(source)?;
    let mut sources = Vec::with_capacity(files.len());
    for path in &files {
        let sha256 = sha256_hex(&read_bytes(path)?);
        sources.push((path.display().to_string(), sha256, "runs".to_owned()));
    }
    Ok((sources, read_runs(&files)?))
}
