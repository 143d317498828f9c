//! Friction force against sliding displacement, and the demand against its bound.

use std::borrow::Cow;

use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::response::History;
use slipstick::slider::Contact;

use super::{Drawn, Scene};
use crate::assessment::lines::{laid, line, over_x, panel};
use crate::display::Quantity;
use crate::legend::{
    AxisQuantity, FRICTION_ALONE, FRICTION_FORCE, KINETIC_FRICTION, LegendEntry, MAIN, SLIDER,
    SLIDER_FORCE, SLIDING, STATIC_BOUND,
};
use crate::number::printed;
use crate::plot::{Axis, Figure, Layout, Limit, Panel, PlotSeries, Style};

/// An axis of forces ends at this many times the largest force without a stop's.
const ABOVE_THE_LOOP: f64 = 3.0;

/// The force with which the block pushes its slider over `s`: it rises, as a data sheet draws it.
///
/// Where a stop's force would flatten the loop its branch leaves the frame, and a note says how far it goes.
/// With a spring, damper or stop, that of the whole slider first and friction alone beside it.
pub fn loops(scene: &Scene) -> Drawn {
    let (report, history) = (scene.report, scene.history);
    let (model, slider) = (report.model, report.model.slider());
    let demands = &report.summary.demands;
    let restrained = model.slider_stiffness_n_per_m() > 0.0
        || slider.damper_n_s_per_m > 0.0
        || slider.stop().is_some();
    let length = report.display.unit(Quantity::Length, demands.peak_sliding_displacement_m);
    let whole = |knot: usize| history.slider_force_n(model, knot);
    let friction = |knot: usize| -history.friction_force_n[knot];
    // Of an elastic stop, rising with the displacement.
    let stop_n = |knot: usize| match history.contact.get(knot) {
        Some(&contact @ Contact::Pressed(side)) => {
            let (s, w) =
                (history.sliding_displacement_m[knot], history.sliding_velocity_m_per_s[knot]);
            side.sign() * slider.stop_force_n(contact, s, w)
        }
        _ => 0.0,
    };
    let panel =
        |label: AxisQuantity, peak_n: f64, force: &dyn Fn(usize) -> f64, with_stop: bool| {
            let unit = report.display.unit(Quantity::Force, peak_n);
            let points: Vec<[f64; 2]> = (0..history.len())
                .map(|knot| [length.of(history.sliding_displacement_m[knot]), unit.of(force(knot))])
                .collect();
            let forces = || points.iter().map(|point| point[1]);
            let largest =
                |all: &mut dyn Iterator<Item = f64>| all.map(f64::abs).fold(0.0, f64::max);
            let of_loop = |knot: usize| unit.of(force(knot) - stop_n(knot));
            let of_loop = largest(&mut (0..history.len()).map(of_loop));
            let most = largest(&mut forces());
            let cut = with_stop && of_loop > 0.0 && most > ABOVE_THE_LOOP * of_loop;
            let (upwards, note) = match cut {
                true => (
                    Axis::symmetric(label.alone(unit), [ABOVE_THE_LOOP * of_loop]),
                    format!("stop {} {}", printed(most, 3), unit.symbol),
                ),
                false => (Axis::symmetric(label.alone(unit), forces()), String::new()),
            };
            let along = points.iter().map(|p| p[0]).chain([0.0]);
            let along = Axis::covering(SLIDING.alone(length), along);
            let stop = if with_stop { at_stop(history, &points) } else { Vec::new() };
            let LegendEntry { label, style, .. } = if stop.is_empty() { MAIN } else { SLIDER };
            let series = std::iter::once(line(label, style, points)).chain(stop).collect();
            Panel { note, ..panel(along, upwards, 150.0, series) }
        };
    let mut panels = Vec::new();
    let mut caption = String::from("Force of the block on its slider");
    if restrained {
        panels.push(panel(SLIDER_FORCE, demands.peak_slider_force_n, &whole, true));
        panels.push(panel(FRICTION_ALONE, demands.peak_friction_force_n, &friction, false));
        caption.push_str(" (left; right: its friction alone)");
    } else {
        panels.push(panel(SLIDER_FORCE, demands.peak_friction_force_n, &friction, false));
    }
    caption.push_str(
        " over sliding displacement, with the sign of a data sheet: it rises with the displacement. \
         Vertical lines: sticking; the area inside is the energy lost.",
    );
    // Nothing is red of a stop that is rigid, or not reached.
    if panels[0].series.len() > 1 {
        caption.push_str(" Red: the block presses against the stop.");
    }
    if !panels[0].note.is_empty() {
        caption.push_str(" Where its force would flatten the loop, it leaves the frame.");
    }
    if report.motion.vertical_m_per_s2().is_some() {
        caption.push_str(" Slips bend where the vertical motion changes the normal force.");
    }
    laid(Layout::Beside, ("hysteresis", "Slider force over sliding displacement"), caption, panels)
}

/// Pieces of the loop in which the block presses against a stop.
fn at_stop(history: &History, points: &[[f64; 2]]) -> Vec<PlotSeries> {
    let pressed = |knot: &usize| matches!(history.contact[*knot], Contact::Pressed(_));
    let knots: Vec<usize> = (0..history.contact.len()).filter(pressed).collect();
    let stretches = knots.chunk_by(|a, b| a + 1 == *b).filter(|stretch| stretch.len() > 1);
    let piece = |stretch: &[usize]| {
        line(
            "",
            Style { colour: Style::LIMIT.colour, width: 1.6, dashes: "" },
            stretch.iter().map(|&knot| points[knot]).collect(),
        )
    };
    let mut pieces: Vec<PlotSeries> = stretches.map(piece).collect();
    if let Some(first) = pieces.first_mut() {
        first.label = "against the stop".to_owned();
    }
    pieces
}

/// Lines between which the friction force lies, each a share of the normal force with its sign, the first of a kind
/// with its name: none of surfaces in series, whose bounds move with their displacements, and of friction by speed the
/// static ones alone.
#[must_use]
pub fn friction_bounds(model: &Model) -> Vec<(f64, LegendEntry)> {
    let slider = model.slider();
    let kinds = match (slider.series().is_some(), slider.rate().is_some()) {
        (true, _) => 0,
        (false, true) => 1,
        (false, false) => 2,
    };
    [(model.static_friction(), STATIC_BOUND), (model.kinetic_friction(), KINETIC_FRICTION)]
        .into_iter()
        .take(kinds)
        .flat_map(|([positive, negative], entry)| {
            let unnamed = LegendEntry { label: Cow::Borrowed(""), ..entry.clone() };
            [(negative, entry), (-positive, unnamed)]
        })
        .collect()
}

/// `T` over time between the static bounds −μ_s⁺N and μ_s⁻N, with the kinetic ones dotted; none for
/// surfaces in series, whose bounds move with their displacements.
pub fn demand(scene: &Scene) -> Option<Drawn> {
    let (report, history, model) = (scene.report, scene.history, scene.report.model);
    if model.slider().series().is_some() {
        return None;
    }
    let normal_n = model.normal_n();
    let [positive, negative] = model.static_friction();
    let largest = positive.max(negative) * normal_n;
    let unit = report
        .display
        .unit(Quantity::Force, largest.max(report.summary.demands.peak_friction_force_n));
    let by_speed = model.slider().rate().is_some();
    let bounds = friction_bounds(model);
    let force =
        over_x("T", Style::MAIN, scene.over_time(unit, |knot| history.friction_force_n[knot]));
    let mut series = vec![force];
    let mut limits = Vec::new();
    let mut values: Vec<f64> = series[0].points.iter().map(|point| point[1]).collect();
    if let Some(vertical) = report.motion.vertical_m_per_s2() {
        let lift = vertical_at_knots(report.motion, vertical, &history.time_s);
        let normal_n = |knot: usize| {
            model.total_mass_kg() * (model.normal_gravity_m_per_s2() + lift[knot]).max(0.0)
        };
        for (coefficient, LegendEntry { label, style, .. }) in bounds {
            let points = scene.over_time(unit, |knot| coefficient * normal_n(knot));
            values.extend(points.iter().map(|point| point[1]));
            series.push(over_x(label, style, points));
        }
    } else {
        for (coefficient, LegendEntry { label, style, .. }) in bounds {
            let value = unit.of(coefficient * normal_n);
            values.push(value);
            // A legend entry without points: the line itself is drawn from edge to edge.
            if !label.is_empty() {
                series.push(over_x(label, style, Vec::new()));
            }
            limits.push(Limit { value, label: String::new(), style });
        }
    }
    let upwards = Axis::symmetric(FRICTION_FORCE.alone(unit), values);
    let panel = Panel { limits, ..panel(scene.time_axis(), upwards, 190.0, series) };
    let varies = if report.motion.vertical_m_per_s2().is_some() {
        " The bounds follow the normal force N(t) of the vertical motion."
    } else {
        ""
    };
    let kinetic = if by_speed { "of its speed, μₖ(v) N" } else { "±μₖN (dotted)" };
    let caption = format!(
        "Friction force T against its bounds. Outside the grey the block sticks and T is the demand: it may \
         reach the static bounds −μₛ⁺N and μₛ⁻N (dashed) but never pass them; there the block lets \
         go. On grey it slides and T is the kinetic friction {kinetic}.{varies}"
    );
    let figure = Figure {
        id: "demand".to_owned(),
        title: "Friction force against its bounds over time".to_owned(),
        description: caption.clone(),
        layout: Layout::Stacked,
        panels: vec![panel],
        shaded: scene.sliding.clone(),
    };
    Some(Drawn::new(figure, caption))
}

/// Vertical acceleration at the knots, linear between samples; of two knots at one time the first
/// takes the left limit of a jump and the second the right one; 0 after the end.
pub(super) fn vertical_at_knots(
    motion: &GroundMotion,
    vertical: &[f64],
    knots_s: &[f64],
) -> Vec<f64> {
    let times = motion.times_s();
    let mut upper = 0;
    let mut previous_s = f64::NAN;
    let mut values = Vec::with_capacity(knots_s.len());
    for &time_s in knots_s {
        let second = time_s == previous_s;
        previous_s = time_s;
        let passed = |t: f64| if second { t <= time_s } else { t < time_s };
        while upper < times.len() && passed(times[upper]) {
            upper += 1;
        }
        values.push(if upper == times.len() {
            0.0
        } else if upper == 0 || times[upper] == time_s {
            vertical[upper]
        } else {
            let part = (time_s - times[upper - 1]) / (times[upper] - times[upper - 1]);
            vertical[upper - 1] + part * (vertical[upper] - vertical[upper - 1])
        });
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertical_motion_at_knots_takes_both_sides_of_a_jump() {
        let vertical = vec![1.0, 3.0, -1.0, 0.0];
        let motion =
            GroundMotion::new(vec![0.0, 1.0, 1.0, 2.0], vec![0.0; 4], Some(vertical.clone()))
                .expect("a motion");
        let knots = [0.0, 0.5, 1.0, 1.0, 1.5, 2.0, 2.0, 3.0];
        assert_eq!(
            vertical_at_knots(&motion, &vertical, &knots),
            [1.0, 2.0, 3.0, -1.0, -0.5, 0.0, 0.0, 0.0]
        );
    }
}
