//! `slipstick fragility`: a lognormal fragility with its certainty.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::assessment::AssessmentError;
use slipstick::assessment::observed::{FitTo, FragilityRequest, run_fragility};
use slipstick::table::Table;
use slipstick_files::{ReadTable, expand, read_bytes, read_table, sha256_hex};
use slipstick_report::assessment::fragility::FragilityReport;

use super::assessment::{conclude, failure, folder, limit, share};
use crate::args::{FitToName, FragilityArgs};
use crate::failure::Failure;
use crate::progress::watched;

/// Fits, prints and writes.
pub fn fragility(args: &FragilityArgs) -> Result<ExitCode, Failure> {
    let of = |option: &str, text: &Option<String>| {
        text.as_deref().map(|text| limit(option, text, &args.demand)).transpose()
    };
    let bound = of("--limit", &args.limit)?;
    let confidence = share("--confidence", args.confidence)?;
    let read = || read(&args.source);
    let (mut sources, read) = watched("reading", args.result.quiet, read)?;
    let name = args.source.display().to_string();
    let request = FragilityRequest {
        table: &read.table,
        source_name: &read.path.display().to_string(),
        demand: &args.demand,
        limit: bound,
        measure: args.measure.as_deref(),
        fit_to: args.fit_to.map(|name| match name {
            FitToName::Counts => FitTo::Counts,
            FitToName::Capacities => FitTo::Capacities,
            FitToName::Cloud => FitTo::Cloud,
        }),
        floor: of("--floor", &args.floor)?,
        cap: of("--cap", &args.cap)?,
    };
    let mut run =
        watched("fitting", args.result.quiet, || run_fragility(&request)).map_err(|error| {
            match error {
                AssessmentError::Cell(error) => read.cell_error(&error).into(),
                other => failure(other),
            }
        })?;
    if let Some((.., kind)) = sources.first_mut() {
        run.kind.clone_into(kind);
    }
    for warning in run.warnings.iter_mut().filter(|warning| warning.kind == "fitted_to") {
        warning.message.push_str("; --fit-to chooses otherwise");
    }
    let inputs: Vec<PathBuf> = sources.iter().map(|(path, ..)| path.into()).collect();
    let folder = folder(&args.result, &inputs)?;
    let report = FragilityReport {
        version: env!("CARGO_PKG_VERSION"),
        name: &name,
        measure: &run.measure,
        measure_unit: &run.measure_unit,
        demand: &args.demand,
        limit: bound,
        data: &run.data,
        fragility: &run.fragility,
        confidence,
        warnings: &run.warnings,
        display: args.result.display_units.into(),
    };
    let curve = report.curve();
    let column = |i: usize| curve.iter().map(|row| row[i]).collect::<Vec<f64>>();
    let mut table = Table::default();
    table
        .numbers("level", &run.measure_unit, column(0))
        .numbers("probability", "", column(1))
        .numbers("band_low", "", column(2))
        .numbers("band_high", "", column(3));
    let tables = [("fragility.csv", &table), ("fragility.parquet", &table)];
    conclude(&args.result, folder, &report.sheet(), &tables, &sources, &[])?;
    Ok(ExitCode::SUCCESS)
}

/// A file that was read: its path, its hash, what it is.
type Source = (String, String, String);

/// The table of a file, or of the parts of a study's folder, and the files with their hashes.
fn read(source: &Path) -> Result<(Vec<Source>, ReadTable), Failure> {
    let files = if source.is_dir() {
        expand(source, "part-*.parquet").map_err(|_| {
            let expected = "a file, or the folder of a study with its part-*.parquet";
            Failure::Message(format!(
                "SOURCE: expected {expected}, found the folder {}",
                source.display()
            ))
        })?
    } else {
        vec![source.to_owned()]
    };
    let mut sources = Vec::with_capacity(files.len());
    for path in &files {
        let sha256 = sha256_hex(&read_bytes(path)?);
        sources.push((path.display().to_string(), sha256, "runs".to_owned()));
    }
    Ok((sources, read_table(&files)?))
}
