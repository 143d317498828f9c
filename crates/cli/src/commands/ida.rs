//! `slipstick ida`: incremental dynamic analysis.

use std::process::ExitCode;

use slipstick::assessment::grid::levels;
use slipstick::assessment::ida::{IdaLevels, IdaRequest, run_ida};
use slipstick::motion::intensity::Measure;
use slipstick::study::engine::Engine;
use slipstick_report::assessment::ida::IdaFamily;

use super::assessment::{Opened, conclude, failure, limit, measure, message, open_pairs};
use crate::args::IdaArgs;
use crate::failure::Failure;

/// Where a hunt starts and ends without --between, over the records' median.
const HUNTED: [f64; 2] = [0.05, 20.0];

/// Runs, prints and writes.
pub fn ida(args: &IdaArgs) -> Result<ExitCode, Failure> {
    let opened = Opened::open_with(&args.suite, || open_pairs(&args.suite, &args.second))?;
    let measure = measure(&args.measure)?;
    let varied: Vec<(&str, String)> = args.vary.iter().map(|text| ("vary", text.clone())).collect();
    let models = opened.models(&varied)?;
    models.column(&args.demand).map_err(|error| opened.failure(error))?;
    let limit = the_limit(args, &opened)?;
    let levels = the_levels(args, &opened, &measure)?;
    let bounds = opened.bounds(args.bounds)?;
    let folder = opened.folder(&args.suite.result)?;
    let request = IdaRequest {
        models: &models,
        bounds: &bounds,
        suite: &opened.suite,
        measure,
        demand: &args.demand,
        limit,
        levels,
        keep: &args.keep,
        by: args.by.as_deref(),
    };
    let run = opened.compute(&args.suite, |engine| run_ida(&request, engine))?;
    let sheet = IdaFamily {
        name: &opened.name,
        measure: &measure,
        demand: &args.demand,
        limit,
        fixed_levels: !args.hunt,
        run: &run,
        warnings: &opened.warnings,
        display: args.suite.result.display_units.into(),
    }
    .sheet();
    let mut tables = vec![("ida.csv", &run.rows), ("ida.parquet", &run.rows)];
    tables.extend(run.capacities.as_ref().map(|table| ("capacities.csv", table)));
    conclude(&args.suite.result, folder, &sheet, &tables, &opened.sources(), &opened.inputs())
}

/// The limit: as given, else the model's gap where that is what is measured.
fn the_limit(args: &IdaArgs, opened: &Opened) -> Result<Option<f64>, Failure> {
    let gap = opened.analysis.model.slider().gap_m;
    let slides = args.demand == "peak_sliding_displacement_m";
    match args.to.as_deref().map(str::trim) {
        Some("slider.gap") => {
            gap.map(Some).ok_or_else(|| message("--to", "slider.gap in the model", "none there"))
        }
        Some(text) => limit("--to", text, &args.demand).map(Some),
        None if args.hunt && !(slides && gap.is_some()) => {
            let expected = "a limit to hunt for, such as \"150 mm\" (or slider.gap in the model)";
            Err(message("--to", expected, ""))
        }
        None => Ok(gap.filter(|_| slides)),
    }
}

fn the_levels(args: &IdaArgs, opened: &Opened, measure: &Measure) -> Result<IdaLevels, Failure> {
    if let Some(text) = &args.levels {
        return Ok(IdaLevels::Fixed(levels("levels", text, measure).map_err(failure)?));
    }
    if let Some(text) = &args.between {
        let both = levels("between", &format!("{text}:2"), measure).map_err(failure)?;
        return Ok(IdaLevels::Hunt { start: both[0], top: both[1] });
    }
    let engine = Engine::unwatched();
    let mut values = opened.suite.measure(measure, &engine).map_err(failure)?;
    values.sort_by(f64::total_cmp);
    let median = values[values.len() / 2];
    Ok(IdaLevels::Hunt { start: HUNTED[0] * median, top: HUNTED[1] * median })
}
