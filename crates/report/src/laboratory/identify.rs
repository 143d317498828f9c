//! Identified parameters: what the three jobs have in common.

use serde::Serialize;
use slipstick::laboratory::estimate::{Estimate, Outcome};
use slipstick::laboratory::identify::{Fitted, Identified, cyclic_histories};
use slipstick::laboratory::measured::Measured;

use super::{cyclic, free_vibration, shaking_table};
use crate::assessment::sheet::{Sheet, SheetTable};
use crate::display::{DisplayUnits, Quantity};
use crate::figures::Drawn;
use crate::json::{each, joined, pretty};
use crate::number::{fixed, significant};
use crate::view;

/// What stands over the keys of a model.
const FOR_MODEL: &str = "For the model file";

/// What is told of one job alone.
#[derive(Default)]
struct OfJob {
    /// The job: `cyclic`, `free-vibration` or `shaking-table`.
    job: &'static str,
    /// Figures, by name.
    facts: Vec<(&'static str, String)>,
    /// Tables below that of the parameters.
    tables: Vec<SheetTable>,
    /// What the intervals assume.
    assumption: String,
    /// The object whose members come last in the JSON object.
    json: String,
    /// The figures of the page.
    figures: Vec<Drawn>,
}

/// A value and its unit as a person reads them: `[value, low, high]` and the unit.
fn shown(display: DisplayUnits, unit: &'static str, values: [f64; 3]) -> ([String; 3], String) {
    let largest = values.into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let quantity = match unit {
        "N/m" => Some(Quantity::Stiffness),
        "N s/m" => Some(Quantity::Damping),
        "N" => Some(Quantity::Force),
        "m" => Some(Quantity::Length),
        "kg" => Some(Quantity::Mass),
        _ => None,
    };
    let (factor, symbol) = match (quantity, unit) {
        (Some(quantity), _) => {
            let unit = display.unit(quantity, largest);
            (unit.in_si, unit.symbol)
        }
        (None, "rad") => (1e-3, "mrad"),
        (None, unit) => (1.0, unit),
    };
    // The interval says how many digits mean something: two of its own.
    let width = (values[2] - values[1]).abs() / factor;
    let digits = |value: f64| {
        let value = value / factor;
        if !(width > 0.0 && width.is_finite()) {
            return significant(value, 4);
        }
        let decimals = (1.0 - libm::floor(libm::log10(width))).max(0.0) as usize;
        if decimals <= 9 && value.abs() < 1e6 {
            fixed(value, decimals)
        } else {
            significant(value, 4)
        }
    };
    (values.map(digits), symbol.to_owned())
}

/// What was identified from measured files, laid out.
#[must_use]
pub fn sheet(measured: &[Measured], identified: &Identified, display: DisplayUnits) -> Sheet {
    let names: Vec<&str> = measured.iter().map(|m| m.source_name.as_str()).collect();
    let name = names.join(", ");
    let OfJob { job, facts, tables, assumption, json, figures } =
        of_job(measured, &name, identified, display);
    let estimates = &identified.estimates;
    let parameters = ("Parameters".to_owned(), rows(estimates, display));
    let estimates_json = each(estimates, estimate_json);
    let of_all = view! { job, measured: &name, confidence: 0.95, estimates: estimates_json };
    let json = joined(&[&pretty(&of_all), &json]);
    let undetermined = estimates
        .iter()
        .filter_map(|e| Some(format!("{} cannot be determined: {}", e.path, e.why()?)));
    let facts = facts.into_iter().map(|(name, fact)| format!("{name}: {fact}."));
    Sheet {
        kind: "Parameters from a test",
        named: "Measured",
        name,
        line: format!("identify {job}"),
        verdict: verdict(estimates, display),
        display,
        warnings: identified.warnings.clone(),
        tables: core::iter::once(parameters).chain(tables).collect(),
        keys: identified.slider_keys().map(|keys| (FOR_MODEL, keys)),
        notes: undetermined.chain(facts).chain([assumption]).collect(),
        figures,
        complete: estimates.iter().all(|estimate| estimate.value().is_some()),
        json,
        ..Sheet::default()
    }
}

fn of_job(
    measured: &[Measured],
    name: &str,
    identified: &Identified,
    display: DisplayUnits,
) -> OfJob {
    match &identified.found {
        Fitted::Cyclic { fits, together, normal_forces_n, at_rest_pa } => {
            let tests = measured.iter().zip(fits).enumerate().filter_map(|(i, (measured, fit))| {
                let [displacement, force] = cyclic_histories(measured).ok()?;
                let (displacement_m, force_n) = (&displacement.values, &force.values);
                let name = measured.source_name.as_str();
                let normal_n = normal_forces_n.as_ref().and_then(|all| all.get(i).copied());
                Some(cyclic::Test { name, displacement_m, force_n, fit, normal_n })
            });
            let tests: Vec<cyclic::Test<'_>> = tests.collect();
            let mut tables = vec![("Cycle by cycle".to_owned(), cyclic::table(&tests))];
            let law = together.pressure.as_ref();
            let by_speed = together.rate.as_ref().map(|rate| {
                let limit = identified.estimates.iter().find(|e| e.path.contains("static"));
                cyclic::by_speed(&tests, rate, law, limit.and_then(Estimate::value), display)
            });
            let by_pressure = law.and_then(|law| cyclic::by_pressure(law, together.rate.is_some()));
            if tests.len() > 1 {
                let unit = if normal_forces_n.is_some() { "" } else { " (N)" };
                let rows = cyclic::by_test(&tests, law);
                tables.insert(0, (format!("Test by test{unit}"), rows));
            }
            let keys = identified.slider_keys();
            let friction = by_speed.into_iter().chain(by_pressure);
            OfJob {
                job: "cyclic",
                json: pretty(&cyclic::json(&tests, together, *at_rest_pa, keys)),
                facts: cyclic::facts(&tests, together, *at_rest_pa),
                tables,
                assumption: cyclic::assumption(together),
                figures: friction.chain(cyclic::figures(&tests, display)).collect(),
            }
        }
        Fitted::FreeVibration { channel, times_s, values, fit } => {
            let span_s = [times_s.first(), times_s.last()].map(|t| t.copied().unwrap_or(0.0));
            OfJob {
                job: "free-vibration",
                tables: Vec::new(),
                facts: free_vibration::facts(*channel, span_s, fit),
                assumption: free_vibration::ASSUMPTION.to_owned(),
                json: pretty(&free_vibration::json(*channel, span_s, fit)),
                figures: free_vibration::figures(*channel, times_s, values, fit, display),
            }
        }
        Fitted::ShakingTable { fit, parameters, seed } => {
            let (rows, mut figures) = shaking_table::agreement(fit, name, display);
            figures.push(shaking_table::residuals(fit, display));
            let sensors = shaking_table::sensors(fit).map(|rows| ("Sensors".to_owned(), rows));
            let correlations = shaking_table::correlations(fit);
            let correlations = correlations.map(|rows| ("Correlations".to_owned(), rows));
            let agreement = ("Agreement with the best values".to_owned(), rows);
            OfJob {
                job: "shaking-table",
                facts: shaking_table::facts(fit, display),
                tables: sensors.into_iter().chain(correlations).chain([agreement]).collect(),
                assumption: shaking_table::assumption(fit),
                json: pretty(&shaking_table::json(fit, parameters, *seed)),
                figures,
            }
        }
    }
}

/// Parameter, value, interval, unit; the first row holds the heads.
fn rows(estimates: &[Estimate], display: DisplayUnits) -> Vec<Vec<String>> {
    let heads = ["Parameter", "Value", "95 % from", "to", "Unit"].map(str::to_owned);
    let told = estimates.iter().filter_map(|estimate| match estimate.outcome {
        Outcome::Told { value, low, high } => {
            let ([value, low, high], unit) = shown(display, estimate.unit, [value, low, high]);
            Some(vec![estimate.path.clone(), value, low, high, unit])
        }
        Outcome::CannotTell { .. } => None,
    });
    core::iter::once(heads.to_vec()).chain(told).collect()
}

/// What the data determine, with its intervals, and what they do not: what the page begins with.
fn verdict(estimates: &[Estimate], display: DisplayUnits) -> Vec<String> {
    const NAMED: usize = 4;
    let told: Vec<String> = estimates
        .iter()
        .filter_map(|estimate| {
            let (value, [low, high]) = (estimate.value()?, estimate.interval()?);
            let ([value, low, high], unit) = shown(display, estimate.unit, [value, low, high]);
            let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
            Some(format!("{} = {value}{unit} (95 %: {low} to {high})", estimate.path))
        })
        .collect();
    let all = estimates.len();
    let parameters = if all == 1 { "parameter" } else { "parameters" };
    let more = match told.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let named = format!("{}{more}", told[..told.len().min(NAMED)].join(", "));
    let first = match told.len() {
        0 => return vec![format!("The data do not determine any of {all} {parameters}.")],
        count if count == all => format!("Determined: {named}."),
        count => format!("{count} of {all} {parameters} determined: {named}."),
    };
    let missing = estimates.iter().filter(|estimate| estimate.value().is_none());
    let missing: Vec<&str> = missing.map(|estimate| estimate.path.as_str()).collect();
    let second = format!("Cannot be determined from the data: {}.", missing.join(", "));
    std::iter::once(first).chain((!missing.is_empty()).then_some(second)).collect()
}

/// An estimate as an object; numbers are null where the data do not tell it.
pub(super) fn estimate_json(estimate: &Estimate) -> impl Serialize {
    let interval = estimate.interval();
    view! {
        parameter: &estimate.path,
        unit: estimate.unit,
        value: estimate.value(),
        low: interval.map(|[low, _]| low),
        high: interval.map(|[_, high]| high),
        cannot_tell: estimate.why(),
    }
}
