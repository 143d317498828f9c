//! A fitted shaking-table record: the response with the best values beside what was measured.

use serde::Serialize;
use slipstick::input::Channel;
use slipstick::laboratory::estimate::Outcome;
use slipstick::laboratory::shaking_table::{Parameter, Residuals, TableFit};
use slipstick::response::Method;

use super::CompareReport;
use super::compare::{quantity, title};
use super::identify::estimate_json;
use crate::assessment::lines::{over_x, panel};
use crate::display::DisplayUnits;
use crate::figures::Drawn;
use crate::json::each;
use crate::number::significant;
use crate::plot::{Axis, Figure, Layout, Panel, Style};
use crate::view;

/// What the intervals assume.
#[must_use]
pub fn assumption(fit: &TableFit) -> String {
    format!(
        "95 % intervals by profile likelihood: residuals are normal, with one standard deviation a \
         quantity, which is estimated from them; they are correlated over {} samples, by which the \
         rise of the sum of squares that is allowed was multiplied. They include what is not known of the \
         sensors, the noise of the table acceleration, {} m/s², and what it may do between its samples; the \
         gain of the table's accelerometer is taken as right unless it is given a deviation.",
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
        sensors: each(&fit.instruments, estimate_json),
        covariance: fit.covariance.as_ref().map(|covariance| {
            view! {
                of: &covariance.names,
                rows: &covariance.rows,
            }
        }),
        correlation_lengths: each(&fit.residuals, |left| {
            view! { #[serde(flatten)] channel: of_channel(left.channel), samples: left.correlation_length }
        }),
        table_noise_m_per_s2: fit.table_noise_m_per_s2,
        correlation_length_samples: fit.correlation_length,
        sliding_evidence: fit.sliding_evidence,
    }
}

/// What was found of the sensors: quantity, what, value, interval, unit; `None` where all was known.
#[must_use]
pub fn sensors(fit: &TableFit) -> Option<Vec<Vec<String>>> {
    let heads = ["Sensor", "Value", "95 % from", "to", "Unit"].map(str::to_owned).to_vec();
    let row = |estimate: &slipstick::laboratory::estimate::Estimate| match estimate.outcome {
        Outcome::Told { value, low, high } => {
            let (factor, unit) = match estimate.unit {
                "s" => (1e3, "ms"),
                "m" => (1e3, "mm"),
                "m/s2" => (1.0, "m/s²"),
                unit => (1.0, unit),
            };
            let shown = [value, low, high].map(|value| significant(factor * value, 4));
            let [value, low, high] = shown;
            Some(vec![estimate.path.replace('_', " "), value, low, high, unit.to_owned()])
        }
        Outcome::CannotTell { .. } => None,
    };
    let rows: Vec<Vec<String>> = fit.instruments.iter().filter_map(row).collect();
    (!rows.is_empty()).then(|| core::iter::once(heads).chain(rows).collect())
}

/// Standard errors and correlations of the parameters; `None` of one alone.
#[must_use]
pub fn correlations(fit: &TableFit) -> Option<Vec<Vec<String>>> {
    let covariance = fit.covariance.as_ref().filter(|covariance| covariance.parameters > 1)?;
    let names = covariance.names[..covariance.parameters].iter();
    let heads = ["", "Standard error"].map(str::to_owned).into_iter().chain(names.clone().cloned());
    let row = |(i, name): (usize, &String)| {
        let error = significant(covariance.rows[i][i].sqrt(), 3);
        let all = (0..covariance.parameters).map(|j| match j {
            j if j > i => String::new(),
            j => format!("{:.2}", covariance.correlation(i, j)),
        });
        [name.clone(), error].into_iter().chain(all).collect()
    };
    Some(core::iter::once(heads.collect()).chain(names.enumerate().map(row)).collect())
}

/// What the best values leave, over time, a panel a quantity.
#[must_use]
pub fn residuals(fit: &TableFit, display: DisplayUnits) -> Drawn {
    let of = |left: &Residuals| -> Panel {
        let largest = left.values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let unit = display.unit(quantity(left.channel), largest);
        let points: Vec<[f64; 2]> =
            left.times_s.iter().zip(&left.values).map(|(t, v)| [*t, unit.of(*v)]).collect();
        let along = Axis::linear("Time (s)", 0.0, fit.comparison.motion.duration_s());
        let upwards = Axis::covering(unit.label(&title(left.channel)), points.iter().map(|p| p[1]));
        let note = format!("correlated over {} samples", significant(left.correlation_length, 2));
        let series = vec![over_x("predicted less measured", Style::MAIN, points)];
        Panel { note, ..panel(along, upwards, 90.0, series) }
    };
    let caption = "What the model and the sensors leave, predicted less measured. Noise has no shape: what swings \
                   with the motion is something that is not fitted."
        .to_owned();
    let figure = Figure {
        id: "residuals".to_owned(),
        title: "Residuals over time".to_owned(),
        description: caption.clone(),
        layout: Layout::Stacked,
        panels: fit.residuals.iter().map(of).collect(),
        shaded: Vec::new(),
    };
    Drawn::new(figure, caption)
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
