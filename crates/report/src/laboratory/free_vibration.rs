//! Free vibration: the measured history with the fitted oscillation.

use serde::Serialize;
use slipstick::input::Channel;
use slipstick::laboratory::free_vibration::{Damping, FreeVibration};

use super::compare::{quantity, title};
use super::identify::estimate_json;
use crate::assessment::lines::{over_x, panel, single};
use crate::display::DisplayUnits;
use crate::figures::Drawn;
use crate::number::significant;
use crate::plot::{Axis, Style};
use crate::view;

/// What the intervals assume.
pub const ASSUMPTION: &str = "95 % intervals by profile likelihood: one linear mode under viscous \
     damping, dry friction or both, as the evidence has it, residuals that are normal and of one variance; their measured correlation length \
     widens the intervals.";

/// Other figures of a fit.
#[must_use]
pub fn facts(
    channel: Channel,
    span_s: [f64; 2],
    fit: &FreeVibration,
) -> Vec<(&'static str, String)> {
    let mut facts = vec![
        ("Quantity", channel.name()),
        ("Time", format!("{} to {} s", significant(span_s[0], 5), significant(span_s[1], 5))),
        ("Cycles", significant(fit.cycles, 3)),
        ("Variance explained", format!("{} %", significant(100.0 * fit.explained, 4))),
        (
            "Correlation length of the residuals",
            format!("{} samples", significant(fit.correlation_length, 3)),
        ),
    ];
    facts.extend(fit.damping.zip(fit.evidence).map(|(damping, evidence)| {
        let law = match damping {
            Damping::Viscous => "viscous damping",
            Damping::Friction => "dry friction",
            Damping::Both => "viscous damping and dry friction",
            Damping::Undecided => "not decided",
        };
        let [viscous, friction, both] = evidence.map(|worse| significant(worse, 3));
        let said = format!(
            "{law}; Schwarz's criterion above its least: viscous {viscous}, friction {friction}, both {both} (6 \
             are odds of 20 to 1)"
        );
        ("What stops it", said)
    }));
    facts.extend(fit.friction.why().map(|why| ("Friction", why.to_owned())));
    facts
}

/// What only this job has in its JSON object.
#[must_use]
pub fn json(channel: Channel, [from_s, to_s]: [f64; 2], fit: &FreeVibration) -> impl Serialize {
    view! {
        quantity: channel.name(),
        from_s,
        to_s,
        cycles: fit.cycles,
        variance_explained: fit.explained,
        correlation_length_samples: fit.correlation_length,
        damping: fit.damping.map(Damping::name),
        evidence: fit.evidence.map(|[viscous, friction, both]| view! { viscous, friction, both }),
        friction: estimate_json(&fit.friction),
    }
}

/// The overlay.
#[must_use]
pub fn figures(
    channel: Channel,
    times_s: &[f64],
    values: &[f64],
    fit: &FreeVibration,
    display: DisplayUnits,
) -> Vec<Drawn> {
    let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let unit = display.unit(quantity(channel), largest);
    let line = |label: &str, style, values: &[f64]| {
        over_x(label, style, times_s.iter().zip(values).map(|(t, v)| [*t, unit.of(*v)]).collect())
    };
    let mut series = vec![line("measured", Style::WIDE, values)];
    if !fit.fitted.is_empty() {
        series.push(line("fitted", Style::MAIN, &fit.fitted));
    }
    let all: Vec<f64> = series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).collect();
    let ends = [times_s.first(), times_s.last()].map(|t| t.copied().unwrap_or(0.0));
    let panel = panel(
        Axis::linear("Time (s)", ends[0], ends[1]),
        Axis::covering(unit.label(&title(channel)), all),
        200.0,
        series,
    );
    let caption =
        "Free vibration, measured (wide) and the decaying oscillation that fits best (thin)."
            .to_owned();
    vec![single("free-vibration", "Free vibration over time", caption, panel)]
}
