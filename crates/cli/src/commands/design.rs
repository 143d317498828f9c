//! `slipstick design`: friction and stiffness for a gap over a suite.

use std::process::ExitCode;

use slipstick::assessment::design::{DesignRequest, Target, run_design};
use slipstick_report::assessment::design::DesignReport;

use super::assessment::{Opened, conclude, limit, message, scaling, share};
use crate::args::DesignArgs;
use crate::failure::Failure;

/// Searches, prints and writes; status 1 where no design keeps the gap, or a run has no answer.
pub fn design(args: &DesignArgs) -> Result<ExitCode, Failure> {
    let opened = Opened::open(&args.suite)?;
    let mut options: Vec<(&str, String)> = Vec::new();
    if let Some(values) = &args.friction {
        options.push(("friction", format!("slider.kinetic_friction={values}")));
    }
    options.extend(args.vary.iter().map(|text| ("vary", text.clone())));
    if options.is_empty() {
        let expected = "something to vary, --friction or --vary slider.radius=1..5m:50";
        return Err(message("--vary", expected, "nothing"));
    }
    let models = opened.models(&options)?;
    let (scaling, scaled) = scaling(&args.scale)?;
    let target = Target {
        gap_m: gap(args, &opened)?,
        probability: args.probability,
        acceleration_share: args.share,
    };
    let confidence = share("--confidence", args.confidence)?;
    let bounds = bounds(args, &opened)?;
    let acceleration = args.demand.clone().unwrap_or_else(|| models.roof_acceleration());
    let folder = opened.folder(&args.suite.result)?;
    let request = DesignRequest {
        models: &models,
        suite: &opened.suite,
        scaling,
        target,
        acceleration: &acceleration,
        bounds,
        sensitivity: args.sensitivity,
        seed: args.seed,
        confidence,
    };
    let run = opened.compute(&args.suite, |engine| run_design(&request, engine))?;
    let sheet = DesignReport {
        name: &opened.name,
        records: opened.suite.records.len(),
        scaled: if opened.suite.made { "" } else { &scaled },
        target,
        run: &run,
        acceleration: &acceleration,
        bounds,
        confidence,
        warnings: &opened.warnings,
        display: args.suite.result.display_units.into(),
    }
    .sheet();
    let tables =
        [("front.csv", &run.front), ("front.parquet", &run.front), ("runs.parquet", &run.runs)];
    conclude(&args.suite.result, folder, &sheet, &tables, &opened.sources(), &opened.inputs())
}

fn gap(args: &DesignArgs, opened: &Opened) -> Result<f64, Failure> {
    match (&args.gap, opened.analysis.model.slider().gap_m) {
        (Some(text), _) => limit("--gap", text, "peak_sliding_displacement_m"),
        (None, Some(gap_m)) => Ok(gap_m),
        (None, None) => Err(message("--gap", "a length (or slider.gap in the model)", "nothing")),
    }
}

fn bounds(args: &DesignArgs, opened: &Opened) -> Result<Option<[f64; 2]>, Failure> {
    let Some(text) = &args.bounds else {
        return Ok(opened.analysis.friction_bounds.map(|bounds| [bounds.lower, bounds.upper]));
    };
    let number =
        |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0);
    let pair = text.split_once(',').and_then(|(a, b)| Some([number(a)?, number(b)?]));
    match pair {
        Some([lower, upper]) if lower <= upper => Ok(Some([lower, upper])),
        _ => Err(message("--bounds", "two factors that rise, such as 0.8,1.3", text)),
    }
}
