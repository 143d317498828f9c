//! A fitted shaking-table record: the response with the best values beside what was measured.

use serde::Serialize;
use slipstick::input::Channel;
use slipstick::laboratory::shaking_table::{Parameter, TableFit};
use slipstick::response::Method;

use super::CompareReport;
use super::compare::{quantity, title};
use crate::display::DisplayUnits;
use crate::figures::Drawn;
use crate::json::each;
use crate::number::significant;
use crate::view;

/// What the intervals assume.
#[must_use]
pub fn assumption(fit: &TableFit) -> String {
    format!(
        "95 % intervals by profile likelihood: residuals are normal, with one standard deviation a \
         quantity, which is estimated from them; they are correlated over {} samples, by which the \
         rise of the sum of squares that is allowed was multiplied. They include the noise of the \
         table acceleration, {} m/s², and what it may do between its samples.",
        significant(fit.correlation_length, 3),
        significant(fit.table_noise_m_per_s2, 2)
    )
}

/// Other figures of a fit.
#[must_use]
pub fn facts(fit: &TableFit, display: DisplayUnits) -> Vec<(&'static str, String)> {
    let mut facts = vec![(
        "Fit against a block that never slides",
        format!("sum of squares lower by {} noise variances", significant(fit.sliding_evidence, 3)),
    )];
    for (channel, noise) in &fit.noise {
        let unit = display.unit(quantity(*channel), *noise);
        facts.push((
            "Standard deviation of the residuals",
            format!("{}: {} {}", title(*channel), significant(unit.of(*noise), 3), unit.symbol),
        ));
    }
    for (channel, offset) in &fit.offsets {
        let unit = display.unit(quantity(*channel), offset.abs());
        facts.push((
            "Offset of the sensor, fitted",
            format!("{}: {} {}", title(*channel), significant(unit.of(*offset), 3), unit.symbol),
        ));
    }
    facts
}

/// What only this job has in its JSON object.
#[must_use]
pub fn json(fit: &TableFit, parameters: &[Parameter], seed: u64) -> impl Serialize {
    let of_channel = |channel: Channel| {
        view! { quantity: channel.name(), unit: channel.dimension().si_unit() }
    };
    view! {
        seed,
        ranges: each(parameters.iter().zip(&fit.values), |(parameter, best)| {
            view! {
                parameter: &parameter.path,
                least_tried: parameter.low,
                most_tried: parameter.high,
                best,
            }
        }),
        residuals: each(&fit.noise, |(channel, residual_rms)| {
            view! { #[serde(flatten)] channel: of_channel(*channel), residual_rms }
        }),
        sensor_offsets: each(&fit.offsets, |(channel, offset)| {
            view! { #[serde(flatten)] channel: of_channel(*channel), offset }
        }),
        table_noise_m_per_s2: fit.table_noise_m_per_s2,
        correlation_length_samples: fit.correlation_length,
        sliding_evidence: fit.sliding_evidence,
    }
}

/// The table of agreement and the overlays of a comparison with the best values.
#[must_use]
pub fn agreement(
    fit: &TableFit,
    measured: &str,
    display: DisplayUnits,
) -> (Vec<Vec<String>>, Vec<Drawn>) {
    let report = CompareReport {
        name: measured,
        model_hash: None,
        measured,
        model: &fit.model,
        method: Method::Exact,
        comparison: &fit.comparison,
        within: &[],
        display,
    };
    (report.rows(), report.figures())
}
