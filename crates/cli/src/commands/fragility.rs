//! `slipstick fragility`: a lognormal fragility with its certainty.

use std::path::PathBuf;
use std::process::ExitCode;

use slipstick_files::assessment::{FitTo, FragilityRequest, Table, run_fragility};
use slipstick_report::assessment::fragility::FragilityReport;

use super::assessment::{conclude, folder, limit, share};
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
    let request = FragilityRequest {
        source: &args.source,
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
    let run = watched("fitting", args.result.quiet, || run_fragility(&request))
        .map_err(|error| Failure::Message(error.to_string()))?;
    let inputs: Vec<PathBuf> = run.sources.iter().map(|(path, ..)| path.into()).collect();
    let folder = folder(&args.result, &inputs)?;
    let name = args.source.display().to_string();
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
    conclude(&args.result, folder, &report.sheet(), &tables, &run.sources, &[])?;
    Ok(ExitCode::SUCCESS)
}
