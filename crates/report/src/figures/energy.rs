//! Where the energy goes.

use super::{Drawn, Scene};
use crate::assessment::lines::{over_x, panel, single};
use crate::display::Quantity;
use crate::legend::{ENERGIES, ENERGY, EnergyArea, INPUT};
use crate::number::printed;
use crate::plot::{Axis, PlotSeries, Shape, Style};

/// Energy by kind, stacked up to the input; none where the certificate has no energies.
pub fn by_kind(scene: &Scene) -> Option<Drawn> {
    let energy = scene.report.certificate.energy();
    // In the order of `ENERGIES`.
    let kinds = [&energy.friction_j, &energy.damping_j, &energy.strain_j, &energy.kinetic_j];
    let knots = scene.history.len();
    if kinds.iter().any(|kind| kind.len() != knots) || energy.input_j.len() != knots {
        return None;
    }
    let largest = energy.input_j.iter().copied().fold(0.0, f64::max);
    let unit = scene.report.display.unit(Quantity::Energy, largest);
    let edge = Style { colour: "#1a1a1a", width: 0.5, dashes: "" };
    // The highest edge first, so that each area covers the foot of the one before it.
    let mut series: Vec<PlotSeries> = (0..kinds.len())
        .rev()
        .map(|last| {
            let points = scene.over_time(unit, |knot| kinds[..=last].iter().map(|k| k[knot]).sum());
            let EnergyArea { label, fill, .. } = ENERGIES[last];
            PlotSeries { label: label.to_owned(), style: edge, shape: Shape::Area(fill), points }
        })
        .collect();
    let input = scene.over_time(unit, |knot| energy.input_j[knot]);
    let values: Vec<f64> =
        input.iter().chain(series.iter().flat_map(|s| &s.points)).map(|point| point[1]).collect();
    series.push(over_x(INPUT.label, INPUT.style, input));
    let panel =
        panel(scene.time_axis(), Axis::from_zero(ENERGY.alone(unit), values), 190.0, series);
    let last = |values: &[f64]| values.last().copied().unwrap_or(0.0);
    let input_end = last(&energy.input_j);
    let mut caption = String::from(
        "Energy relative to the ground, stacked: what friction and dampers have dissipated so far, \
         and what is stored as strain and kinetic energy. The stack must fill the input (initial \
         energy and work of the ground, dashed): a gap between them would be an error.",
    );
    if input_end > 0.0 {
        caption.push_str(&format!(
            " At the end friction has dissipated {} % of the input and the dampers {} %.",
            printed(100.0 * last(&energy.friction_j) / input_end, 3),
            printed(100.0 * last(&energy.damping_j) / input_end, 3),
        ));
    }
    Some(single("energy", "Energy by kind over time", caption, panel))
}
