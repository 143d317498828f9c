//! `slipstick spectrum`: sliding spectra and frequency response curves.

use std::process::ExitCode;

use slipstick::assessment::spectrum::{SpectrumRequest, run_spectrum};
use slipstick_report::assessment::spectrum::SpectrumReport;

use super::assessment::{Opened, conclude, scaling};
use crate::args::SpectrumArgs;
use crate::failure::Failure;

/// Runs, prints and writes.
pub fn spectrum(args: &SpectrumArgs) -> Result<ExitCode, Failure> {
    let opened = Opened::open(&args.suite)?;
    let mut options: Vec<(&str, String)> =
        args.vary.iter().map(|text| ("vary", text.clone())).collect();
    if let Some(values) = &args.friction {
        options.push(("friction", format!("slider.kinetic_friction={values}")));
    }
    options.push(("over", args.over.clone()));
    let models = opened.models(&options)?;
    let (scaling, scaled) = scaling(&args.scale)?;
    let folder = opened.folder(&args.suite.result)?;
    let bounds = opened.bounds(args.bounds)?;
    let request = SpectrumRequest {
        models: &models,
        suite: &opened.suite,
        scaling,
        demands: &args.demand,
        bounds: &bounds,
    };
    let run = opened.compute(&args.suite, |engine| run_spectrum(&request, engine))?;
    let scaled = if opened.suite.made { "" } else { &scaled };
    let names = opened.suite.names();
    let sheet = SpectrumReport {
        name: &opened.name,
        run: &run,
        records: &names,
        scaled,
        warnings: &opened.warnings,
        display: args.suite.result.display_units.into(),
    }
    .sheet();
    let tables = [
        ("spectrum.csv", &run.table),
        ("spectrum.parquet", &run.table),
        ("runs.parquet", &run.rows),
    ];
    conclude(&args.suite.result, folder, &sheet, &tables, &opened.sources(), &opened.inputs())
}
