//! The model in words and numbers, shared by the plain-text table and the report.

use core::f64::consts::TAU;

use slipstick::model::{Damping, Model, Stop, StopKind, Structure, StructureMode};
use slipstick::response::{Event, Mode};
use slipstick::slider::{Direction, RateCurve};

use crate::display::{DisplayUnits, Quantity};
use crate::number::{compact, rounded, significant};

/// A value given in SI with its unit, as `325 kg`.
#[must_use]
pub fn value(display: DisplayUnits, quantity: Quantity, si: f64) -> String {
    let unit = display.unit(quantity, si);
    let text = compact(unit.of(si));
    if unit.symbol.is_empty() { text } else { format!("{text} {}", unit.symbol) }
}

/// One line: `block 325 kg, 1 storey, friction 0.02 static, 0.012 kinetic, spring 143 kN/m`.
#[must_use]
pub fn model_line(model: &Model, display: DisplayUnits) -> String {
    let slider = model.slider();
    let mut parts =
        vec![format!("block {}", value(display, Quantity::Mass, model.bare_block_kg()))];
    parts.push(match model.storeys() {
        n if model.structure().is_some() => {
            let mass_kg = model.structure().map_or(0.0, |structure| structure.mass_kg);
            let mass = value(display, Quantity::Mass, mass_kg);
            format!("structure of {mass} by {n} mode{}", if n == 1 { "" } else { "s" })
        }
        0 => "no storeys".to_owned(),
        1 => format!("1 storey of {}", value(display, Quantity::Mass, model.frame().masses_kg[0])),
        n => {
            let above: f64 = model.frame().masses_kg.iter().sum();
            format!("{n} storeys of {} in all", value(display, Quantity::Mass, above))
        }
    });
    parts.push(match (slider.series(), slider.rate()) {
        (Some(series), _) => format!("{} surfaces in series", series.surfaces().len()),
        (None, rate) => format!(
            "friction {} static, {} kinetic{}",
            by_direction(model.static_friction()),
            by_direction(model.kinetic_friction()),
            if rate.is_some() { " at rest" } else { "" }
        ),
    });
    for (name, quantity, si) in [
        ("spring", Quantity::Stiffness, model.slider_stiffness_n_per_m()),
        ("damper", Quantity::Damping, slider.damper_n_s_per_m),
    ] {
        if si > 0.0 {
            parts.push(format!("{name} {}", value(display, quantity, si)));
        }
    }
    for (name, tilt_rad) in [("tilt", slider.tilt_rad), ("tilt along y", slider.tilt_y_rad)] {
        if tilt_rad != 0.0 {
            parts.push(format!("{name} {} mrad", compact(1e3 * tilt_rad)));
        }
    }
    if let Some(gap_m) = slider.gap_m() {
        parts.push(format!("gap {}", value(display, Quantity::Length, gap_m)));
    }
    if let Some(stop) = slider.stop() {
        parts.push(format!("stop {}", stop_gap(stop, display)));
    }
    match model.contents().len() {
        0 => {}
        n => parts.push(format!("{n} contents")),
    }
    parts.join(", ")
}

/// Where a stop stands.
fn stop_gap(stop: &Stop, display: DisplayUnits) -> String {
    let show = |gap_m| value(display, Quantity::Length, gap_m);
    match stop.gap_m {
        [Some(positive), Some(negative)] if positive == negative => {
            format!("at ±{}", show(positive))
        }
        [Some(positive), Some(negative)] => {
            format!("at {} (+x) and {} (-x)", show(positive), show(negative))
        }
        [Some(positive), None] => format!("at {} (+x only)", show(positive)),
        [None, Some(negative)] => format!("at {} (-x only)", show(negative)),
        [None, None] => "nowhere".to_owned(),
    }
}

/// A coefficient, or both where the directions differ.
fn by_direction([positive, negative]: [f64; 2]) -> String {
    if positive == negative {
        compact(positive)
    } else {
        format!("{} (+x) and {} (-x)", compact(positive), compact(negative))
    }
}

/// Friction, by speed or on surfaces in series where the model has such.
fn friction_rows(model: &Model, display: DisplayUnits, rows: &mut Vec<(&'static str, String)>) {
    let slider = model.slider();
    if let Some(series) = slider.series() {
        for surface in series.surfaces() {
            let length = |si: f64| value(display, Quantity::Length, si);
            let radius = surface.radius_m.map_or("flat".to_owned(), |r| format!("R {}", length(r)));
            let travel =
                surface.travel_m.map_or(String::new(), |d| format!(", travel {}", length(d)));
            rows.push((
                "Surface",
                format!("{radius}, friction {}{travel}", compact(surface.friction)),
            ));
        }
        rows.push(("Static over kinetic friction", compact(series.static_ratio())));
        return;
    }
    if let Some(law) = slider.pressure() {
        let mpa = |pa: f64| compact(1e-6 * pa);
        rows.push((
            "Friction by pressure",
            format!(
                "μ (p/{} MPa)^−{}, {} MPa at rest: the coefficients here",
                mpa(law.reference_pa()),
                compact(law.exponent()),
                mpa(law.at_rest_pa())
            ),
        ));
    }
    rows.push(("Static friction μₛ", by_direction(model.static_friction())));
    let Some(rate) = slider.rate() else {
        rows.push(("Kinetic friction μₖ", by_direction(model.kinetic_friction())));
        return;
    };
    let factor = rate.factor(Direction::Positive);
    rows.push((
        "Kinetic friction μₖ",
        match rate.curve() {
            RateCurve::Exponential { slow, fast, rate_s_per_m } => format!(
                "{} slow, {} fast, rate {} s/m",
                compact(factor * slow),
                compact(factor * fast),
                compact(*rate_s_per_m)
            ),
            RateCurve::Pieces { speeds_m_per_s, coefficients } => speeds_m_per_s
                .iter()
                .zip(coefficients)
                .map(|(v, mu)| format!("{} at {} m/s", compact(factor * mu), compact(*v)))
                .collect::<Vec<_>>()
                .join(", "),
        },
    ));
}

/// Every quantity of block, slider and start with its value, in plain characters.
#[must_use]
pub fn model_rows(model: &Model, display: DisplayUnits) -> Vec<(&'static str, String)> {
    let (block, slider) = (model.block(), model.slider());
    let show = |quantity, si| value(display, quantity, si);
    let derived = |quantity, si| {
        let unit = display.unit(quantity, si);
        format!("{} {}", significant(unit.of(si), 4), unit.symbol)
    };
    let mut rows = vec![("Mass of the block M₁", show(Quantity::Mass, model.bare_block_kg()))];
    if let Some(structure) = model.structure() {
        rows.push(("Mass of the structure", show(Quantity::Mass, structure.mass_kg)));
        let missing_kg = structure.missing_mass_kg();
        if missing_kg > 0.0 {
            let share = rounded(1e2 * missing_kg / structure.mass_kg, 4);
            let mass = derived(Quantity::Mass, missing_kg);
            rows.push(("  of it with the block", format!("{mass} ({share} %)")));
        }
    }
    if model.storeys() > 0 {
        rows.push(("Total mass", show(Quantity::Mass, model.total_mass_kg())));
    }
    rows.push(("Weight", derived(Quantity::Force, model.weight_n())));
    friction_rows(model, display, &mut rows);
    let k1 = model.slider_stiffness_n_per_m();
    if k1 > 0.0 {
        let total = model.total_mass_kg();
        rows.push(("Spring K₁ of the slider", show(Quantity::Stiffness, k1)));
        rows.push(("  as a pendulum of radius", derived(Quantity::Length, model.weight_n() / k1)));
        rows.push((
            "  period of sliding on it",
            derived(Quantity::Time, TAU * (total / k1).sqrt()),
        ));
    } else {
        rows.push(("Spring K₁ of the slider", "none".to_owned()));
    }
    rows.push((
        "Damper C₁ of the slider",
        if slider.damper_n_s_per_m > 0.0 {
            show(Quantity::Damping, slider.damper_n_s_per_m)
        } else {
            "none".to_owned()
        },
    ));
    rows.push((
        "Tilt θ, uphill towards +x",
        match slider.tilt_rad {
            0.0 => "none".to_owned(),
            tilt_rad => format!("{} mrad", compact(1e3 * tilt_rad)),
        },
    ));
    if slider.tilt_y_rad != 0.0 {
        let tilt = format!("{} mrad", compact(1e3 * slider.tilt_y_rad));
        rows.push(("Tilt θ_y, uphill towards +y", tilt));
    }
    match slider.stop() {
        None => {
            let gap = slider.gap_m().map_or("not given".into(), |gap| show(Quantity::Length, gap));
            rows.push(("Gap", gap));
        }
        Some(stop) => {
            rows.push(("Stop", stop_gap(stop, display)));
            match stop.kind {
                StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => {
                    rows.push(("  stiffness k", show(Quantity::Stiffness, stiffness_n_per_m)));
                    if damper_n_s_per_m > 0.0 {
                        rows.push(("  damper C", show(Quantity::Damping, damper_n_s_per_m)));
                    }
                }
                StopKind::Rigid { restitution } => {
                    rows.push(("  rigid, restitution e", compact(restitution)));
                }
            }
        }
    }
    for contents in model.contents() {
        let place = match contents.floor {
            0 => "on the block".to_owned(),
            floor => format!("on storey {floor}"),
        };
        let mass = show(Quantity::Mass, contents.mass_kg);
        let (fixed, kinetic) =
            (compact(contents.static_friction), compact(contents.kinetic_friction));
        rows.push(("Contents", format!("{mass} {place}, friction {fixed} and {kinetic}")));
    }
    if let Some(width) = block.width_m {
        rows.push(("Width of the block", show(Quantity::Length, width)));
    }
    if let Some(height) = block.height_m {
        rows.push(("Height of the block", show(Quantity::Length, height)));
    }
    rows.push(("Gravity", format!("{} m/s²", compact(model.gravity_m_per_s2()))));
    let initial = model.initial();
    for (name, quantity, si) in [
        ("Sliding displacement at start", Quantity::Length, initial.sliding_displacement_m),
        ("Sliding velocity at start", Quantity::Velocity, initial.sliding_velocity_m_per_s),
    ] {
        if si != 0.0 {
            rows.push((name, show(quantity, si)));
        }
    }
    if let Damping::Ratio(ratio) = model.frame().damping
        && model.storeys() > 0
    {
        rows.push((
            "Damping of the structure",
            format!("{} % in every mode", compact(1e2 * ratio)),
        ));
    }
    rows
}

/// What stands above a row.
type Rows = (Vec<String>, Vec<Vec<String>>);

/// What is above the block, and of what sort: storeys from the roof down, columns without a value left out; or modes.
#[must_use]
pub fn storey_rows(model: &Model, display: DisplayUnits) -> Option<(&'static str, Rows)> {
    let (frame, n) = (model.frame(), model.storeys());
    let dampers = match &frame.damping {
        Damping::Dampers(dampers) => Some(dampers),
        Damping::Ratio(_) => None,
    };
    let q = model.initial().storey_displacement_m.as_ref();
    let v = model.initial().storey_velocity_m_per_s.as_ref();
    if let Some(structure) = model.structure() {
        return Some(("Modes", mode_rows(structure, display)));
    }
    let columns = [
        ("Mass", Quantity::Mass, Some(&frame.masses_kg)),
        ("Stiffness", Quantity::Stiffness, Some(&frame.stiffnesses_n_per_m)),
        ("Damper", Quantity::Damping, dampers),
        ("Height", Quantity::Length, frame.heights_m.as_ref()),
        ("Displacement at start", Quantity::Length, q),
        ("Velocity at start", Quantity::Velocity, v),
    ];
    let mut header = vec!["Storey".to_owned()];
    let mut rows: Vec<Vec<String>> = (1..=n).map(|storey| vec![storey.to_string()]).collect();
    for (name, quantity, values) in columns {
        let Some(values) = values else { continue };
        let unit = display.unit(quantity, values.iter().fold(0.0, |m: f64, v| m.max(v.abs())));
        header.push(unit.label(name));
        for (row, si) in rows.iter_mut().zip(values) {
            row.push(compact(unit.of(*si)));
        }
    }
    rows.reverse();
    (n > 0).then_some(("Storeys, from the roof down", (header, rows)))
}

/// Header and one row a mode.
fn mode_rows(structure: &Structure, display: DisplayUnits) -> Rows {
    let unit = display.unit(Quantity::Mass, structure.mass_kg);
    let header = ["Mode".to_owned(), "Period (s)".to_owned(), "Damping (%)".to_owned()];
    let header = header.into_iter().chain([unit.label("Effective mass"), "Share (%)".to_owned()]);
    let row = |(j, mode): (usize, &StructureMode)| {
        vec![
            (j + 1).to_string(),
            significant(core::f64::consts::TAU / mode.frequency_rad_per_s, 4),
            compact(1e2 * mode.damping_ratio),
            significant(unit.of(mode.effective_mass_kg), 4),
            significant(1e2 * mode.effective_mass_kg / structure.mass_kg, 4),
        ]
    };
    (header.collect(), structure.modes.iter().enumerate().map(row).collect())
}

/// Which way the block slides after an event in two horizontal directions: an angle from x towards y.
#[must_use]
pub fn event_bearing([x, y]: [f64; 2]) -> String {
    if [x, y] == [0.0; 2] {
        return "stuck".to_owned();
    }
    format!("towards {:.1}° from x", libm::atan2(y, x).to_degrees() + 0.0)
}

/// Which way the block slides after an event.
#[must_use]
pub fn event_direction(event: &Event) -> &'static str {
    match event.mode {
        Mode::Stick => "stuck",
        Mode::Slip(direction) if direction.sign() > 0.0 => "towards +x",
        Mode::Slip(_) => "towards −x",
    }
}
