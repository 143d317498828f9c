//! Motions in two horizontal directions: orbits, and histories of the resultant and by axis.

use core::f64::consts::TAU;

use slipstick::model::Model;
use slipstick::response::{Demands, History, HistoryAlongY};

use super::histories::{SHADING, history_panel, of_points, over_time};
use super::trace::Trace;
use super::{Drawn, Scene, drifts_title, shown_note, shown_storeys};
use crate::assessment::lines::{laid, line, panel};
use crate::display::{Quantity, Unit};
use crate::legend::{
    ACCELERATION, Along, AxisQuantity, DRIFT, FRICTION_FORCE, GAP, KINETIC_FRICTION, SLIDING,
    STATIC_BOUND,
};
use crate::markup::shortened;
use crate::number::{compact, printed};
use crate::plot::{Axis, Layout, Limit, Panel, PlotSeries, Shape, Style};

/// A quantity at the knots along x and along y.
type Vector<'a> = [&'a [f64]; 2];

/// All figures but that of energies.
pub fn all(scene: &Scene, y: &HistoryAlongY) -> Vec<Drawn> {
    let x = scene.history;
    let s = [&x.sliding_displacement_m[..], &y.sliding_displacement_m];
    let friction = [&x.friction_force_n[..], &y.friction_force_n];
    let mut figures =
        vec![sliding_displacement(scene, s), orbits(scene, s, friction), accelerations(scene, y)];
    figures.extend(drifts(scene, y));
    figures
}

/// `|s|(t)` with its gap, then `s` along x and along y.
fn sliding_displacement(scene: &Scene, s: Vector) -> Drawn {
    let report = scene.report;
    let demands = &report.summary.demands;
    let peak_m = demands.peak_sliding_displacement_m;
    let end = end_of_travel(report.model, peak_m);
    let unit = report
        .display
        .unit(Quantity::Length, end.map_or(peak_m, |(_, radius_m)| radius_m.max(peak_m)));
    let norm = Trace::with_peak(scene.over_time(unit, |knot| norm(s, knot)), unit.of(peak_m));
    let largest = end.map_or(0.0, |(_, radius_m)| unit.of(radius_m));
    let y =
        Axis::from_zero(SLIDING.label("", Along::Resultant, unit), norm.values().chain([largest]));
    let mut resultant = Panel { y, ..history_panel(scene, "", norm, unit) };
    resultant.limits.extend(end.map(|(name, radius_m)| {
        let label = format!("{name} {} {}", compact(unit.of(radius_m)), unit.symbol);
        Limit { value: unit.of(radius_m), label, style: GAP.style }
    }));
    let mut panels = vec![resultant];
    panels.extend(by_axis(scene, (SLIDING, ""), unit, s, |axis| axis.peak_sliding_displacement_m));
    let caption = format!(
        "Sliding displacement of the block relative to the ground: its size, along x and along y. \
         {SHADING}{}",
        demands.gap_ratio.map_or(String::new(), |ratio| format!(
            " Its peak uses {} % of the gap.",
            printed(100.0 * ratio, 3)
        ))
    );
    over_time(scene, ("sliding-displacement", "Sliding displacement over time"), panels, caption)
}

/// The gap, or the stop around the block, by its name and its radius in m, where it is near what the block slides.
fn end_of_travel(model: &Model, peak_m: f64) -> Option<(&'static str, f64)> {
    let slider = model.slider();
    let [stop_m, _] = slider.stop_m();
    let gap = slider.gap_m().map(|gap_m| ("gap", gap_m));
    gap.or(stop_m.map(|stop_m| ("stop", stop_m))).filter(|(_, radius_m)| *radius_m <= 4.0 * peak_m)
}

/// The orbit of `s` inside its gap, and that of the friction force inside `μ_s N`.
fn orbits(scene: &Scene, s: Vector, friction: Vector) -> Drawn {
    let (report, model) = (scene.report, scene.report.model);
    let demands = &report.summary.demands;
    let end = end_of_travel(model, demands.peak_sliding_displacement_m);
    let [static_n, kinetic_n] =
        [model.static_friction(), model.kinetic_friction()].map(|[mu, _]| mu * model.normal_n());
    let length = report.display.unit(Quantity::Length, demands.peak_sliding_displacement_m);
    let force = report.display.unit(Quantity::Force, demands.peak_friction_force_n);
    let circle = end.map(|(name, radius_m)| (name, GAP.style, length.of(radius_m)));
    let mut bounds = vec![("static friction μₛ N", STATIC_BOUND.style, force.of(static_n))];
    if kinetic_n != static_n {
        bounds.push(("kinetic friction μₖ N", KINETIC_FRICTION.style, force.of(kinetic_n)));
    }
    let panels = vec![
        orbit(SLIDING, length, s, &Vec::from_iter(circle)),
        orbit(FRICTION_FORCE, force, friction, &bounds),
    ];
    let varies = if report.motion.vertical_m_per_s2().is_some() {
        " The circles are those of the weight; the vertical motion changes the normal force."
    } else {
        ""
    };
    let caption = format!(
        "Left: the path of the block over the ground, seen from above{}. Right: the force of the ground \
         on the block by friction, which stays inside the circle of static friction while the block \
         sticks and lies on that of kinetic friction, against the velocity, while it slides.{varies}",
        end.map_or(String::new(), |(name, _)| format!(", with its {name}"))
    );
    laid(
        Layout::Square,
        ("orbits", "Orbits of sliding displacement and friction force"),
        caption,
        panels,
    )
}

/// The orbit of a vector, with circles around it.
fn orbit(of: AxisQuantity, unit: Unit, vector: Vector, circles: &[(&str, Style, f64)]) -> Panel {
    let [x, y] = vector;
    let points: Vec<[f64; 2]> = x.iter().zip(y).map(|(x, y)| [unit.of(*x), unit.of(*y)]).collect();
    let radii = circles.iter().map(|(.., radius)| *radius);
    let largest: Vec<f64> = points.iter().flatten().copied().chain(radii).collect();
    let axis = |along| Axis::symmetric(of.label("", along, unit), largest.iter().copied());
    let circle = |(label, style, radius): &(&str, Style, f64)| {
        line(
            *label,
            *style,
            (0..=120)
                .map(|i| {
                    let (sin, cos) = libm::sincos(TAU * f64::from(i) / 120.0);
                    [radius * cos, radius * sin]
                })
                .collect(),
        )
    };
    let mut series: Vec<PlotSeries> = circles.iter().map(circle).collect();
    let (style, shape) = (Style::MAIN, Shape::Curve);
    series.push(PlotSeries { label: String::new(), style, shape, points });
    panel(axis(Along::X), axis(Along::Y), 0.0, series)
}

/// Total accelerations of ground, block and floors along x and along y.
fn accelerations(scene: &Scene, y: &HistoryAlongY) -> Drawn {
    let (report, x) = (scene.report, scene.history);
    let names = &report.summary.names;
    let unit = report.display.unit(Quantity::Acceleration, report.summary.record.pga_m_per_s2);
    let ground = [&x.table_acceleration_m_per_s2[..], &y.table_acceleration_m_per_s2];
    let block = [&x.block_acceleration_m_per_s2[..], &y.block_acceleration_m_per_s2];
    let mut panels = by_axis(scene, (ACCELERATION, "Ground"), unit, ground, |_| 0.0);
    let block_peak = |axis: &Demands| axis.peak_block_acceleration_m_per_s2;
    panels.extend(by_axis(scene, (ACCELERATION, names.block()), unit, block, block_peak));
    let peaks: Vec<f64> = storey_peaks(scene, |storey| storey.peak_acceleration_m_per_s2);
    let shown = shown_storeys(&peaks);
    for &i in &shown {
        let floor = over_knots(x, |knot| y.point_acceleration(x, knot, i));
        let name = names.point(i + 1);
        let vector = [&floor[0][..], &floor[1]];
        panels.extend(by_axis(scene, (ACCELERATION, &name), unit, vector, |axis| {
            of_points(axis)[i].peak_acceleration_m_per_s2
        }));
    }
    let caption = format!(
        "Total accelerations along x and along y, each on its own scale. {SHADING}{}",
        shown_note(&shown, y.point_count(x), names)
    );
    let title = match names.points.is_empty() {
        true => "Accelerations of ground, block and storeys over time",
        false => "Accelerations of ground, block and points over time",
    };
    over_time(scene, ("accelerations", title), panels, caption)
}

/// Drift of storeys along x and along y; none without storeys.
fn drifts(scene: &Scene, y: &HistoryAlongY) -> Option<Drawn> {
    let (report, x) = (scene.report, scene.history);
    let peaks = storey_peaks(scene, |storey| storey.peak_drift_m);
    let unit = report.display.unit(Quantity::Length, peaks.iter().copied().fold(0.0, f64::max));
    let shown = shown_storeys(&peaks);
    let mut panels = Vec::new();
    for &i in &shown {
        let drift = over_knots(x, |knot| {
            let own = y.point_displacement(x, knot, i);
            let below = i.checked_sub(1).map_or([0.0; 2], |i| y.point_displacement(x, knot, i));
            [own[0] - below[0], own[1] - below[1]]
        });
        let name = report.summary.names.point(i + 1);
        panels.extend(by_axis(scene, (DRIFT, &name), unit, [&drift[0], &drift[1]], |axis| {
            of_points(axis)[i].peak_drift_m
        }));
    }
    let what = match report.model.structure() {
        Some(_) => {
            "Drift of each point along x and along y: its displacement relative to the point before it \
             (the first: relative to the block)."
        }
        None => {
            "Drift of each storey along x and along y: displacement of its floor relative to the floor \
             below (storey 1: relative to the block)."
        }
    };
    let note = shown_note(&shown, y.point_count(x), &report.summary.names);
    let caption = format!("{what} {SHADING}{note}");
    (!panels.is_empty())
        .then(|| over_time(scene, ("drifts", drifts_title(&report.summary.names)), panels, caption))
}

fn storey_peaks(scene: &Scene, of: fn(&slipstick::response::StoreyDemands) -> f64) -> Vec<f64> {
    of_points(&scene.report.summary.demands).iter().map(of).collect()
}

/// A vector at every knot, as lists along x and along y.
fn over_knots(history: &History, of: impl Fn(usize) -> [f64; 2]) -> [Vec<f64>; 2] {
    let (x, y) = (0..history.len()).map(|knot| of(knot).into()).unzip();
    [x, y]
}

fn norm([x, y]: Vector, knot: usize) -> f64 {
    libm::hypot(x[knot], y[knot])
}

/// A panel an axis of a quantity of something, whose peaks are those of the demands by axis.
fn by_axis(
    scene: &Scene,
    (quantity, of): (AxisQuantity, &str),
    unit: Unit,
    vector: Vector,
    peak: impl Fn(&Demands) -> f64,
) -> Vec<Panel> {
    let demands = scene.report.summary.by_axis.as_ref();
    Along::AXES
        .into_iter()
        .enumerate()
        .map(|(axis, along)| {
            let points = scene.over_time(unit, |knot| vector[axis][knot]);
            let peak = demands.map_or(0.0, |demands| peak(&demands.demands[axis]));
            let trace = Trace::with_peak(points, unit.of(peak));
            history_panel(scene, &quantity.name(&shortened(of, 24), along), trace, unit)
        })
        .collect()
}
