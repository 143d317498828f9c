//! Sliding displacement, accelerations and drifts over time.

use slipstick::response::{Demands, StoreyDemands};

use super::trace::Trace;
use super::{Drawn, Scene, drifts_title, shown_note, shown_storeys};
use crate::assessment::lines::{over_x, panel};
use crate::display::{Quantity, Unit};
use crate::legend::{
    ACCELERATION, Along, DRIFT, GAP, LOWER_FRICTION, LegendEntry, SLIDING, UPPER_FRICTION,
};
use crate::markup::shortened;
use crate::number::{compact, printed};
use crate::plot::{Axis, Figure, Layout, Limit, Panel, PlotSeries, Style};

/// Five of them stand on a printed page together with the sliding displacement.
const HISTORY_HEIGHT: f64 = 78.0;
pub(super) const SHADING: &str = "Grey: the block slides.";

/// `s(t)` with its gap and, where they were run, the answers with lower and upper friction.
pub fn sliding_displacement(scene: &Scene) -> Drawn {
    let report = scene.report;
    let runs = report.summary.runs();
    let largest = runs.iter().map(|(_, run)| run.demands.peak_sliding_displacement_m);
    let peak_m = largest.fold(0.0, f64::max);
    let gap_m = report.model.slider().gap_m();
    let gap_shown = gap_m.filter(|gap| *gap <= 4.0 * peak_m);
    let unit = report.display.unit(Quantity::Length, gap_shown.map_or(peak_m, |g| g.max(peak_m)));

    let nominal = sliding_trace(scene, unit);
    let mut series = bound_series(scene, unit);
    let label = if series.is_empty() { String::new() } else { "nominal".to_owned() };
    let gap = gap_shown.map(|gap| unit.of(gap));
    let extremes = series.iter().flat_map(|s| s.points.iter().map(|point| point[1]));
    let values: Vec<f64> = nominal
        .values()
        .chain(extremes)
        .chain([0.0])
        .chain(gap.iter().flat_map(|g| [-g, *g]))
        .collect();
    let (peak, note) = marked(&nominal, unit, "peak");
    series.push(over_x(label, Style::MAIN, nominal.points));
    let limits = gap.map_or_else(Vec::new, |gap| {
        let line = |value: f64, label| Limit { value, label, style: GAP.style };
        let label = format!("{} ±{} {}", GAP.label, compact(gap), unit.symbol);
        vec![line(gap, label), line(-gap, String::new())]
    });
    let panel = Panel {
        x: scene.time_axis(),
        y: Axis::covering(SLIDING.alone(unit), values),
        height: 140.0,
        series,
        limits,
        peak,
        note,
    };
    let ratios = runs.iter().filter_map(|(_, run)| run.demands.gap_ratio);
    let mut caption = format!(
        "Sliding displacement s of the block relative to the ground, positive towards +x. {SHADING}"
    );
    if let Some(ratio) = ratios.reduce(f64::max) {
        let over = if runs.len() > 1 { " over all bounds of friction" } else { "" };
        caption.push_str(&format!(
            " Its peak{over} uses {} % of the gap{}.",
            printed(100.0 * ratio, 3),
            if gap_shown.is_some() { "" } else { ", whose lines lie outside the drawing" }
        ));
    }
    if report.bounds.is_some() {
        caption.push_str(" Shading and ringed peak: nominal friction.");
    }
    let figure = Figure {
        id: "sliding-displacement".to_owned(),
        title: "Sliding displacement over time".to_owned(),
        description: format!("{caption} {}", panel.note),
        layout: Layout::Stacked,
        panels: vec![panel],
        shaded: scene.sliding.clone(),
    };
    Drawn::new(figure, caption)
}

fn sliding_trace(scene: &Scene, unit: Unit) -> Trace {
    let demands = &scene.report.summary.demands;
    let points = scene.over_time(unit, |knot| scene.history.sliding_displacement_m[knot]);
    let extremes = [demands.min_sliding_displacement_m, demands.max_sliding_displacement_m];
    Trace::new(points, extremes.map(|value| unit.of(value)))
}

fn bound_series(scene: &Scene, unit: Unit) -> Vec<PlotSeries> {
    let Some(responses) = scene.report.bounds else { return Vec::new() };
    let named = [LOWER_FRICTION, UPPER_FRICTION];
    named
        .into_iter()
        .zip(responses)
        .filter_map(|(LegendEntry { label, style, .. }, response)| {
            let history = response.history.as_ref()?;
            let points = history.time_s.iter().zip(&history.sliding_displacement_m);
            let points = points.map(|(&time_s, &s)| [time_s, unit.of(s)]).collect();
            let demands = &response.demands;
            let extremes = [demands.min_sliding_displacement_m, demands.max_sliding_displacement_m];
            let points = Trace::new(points, extremes.map(|value| unit.of(value))).points;
            Some(over_x(label, style, points))
        })
        .collect()
}

/// Table, block and floors, each on its own scale.
pub fn accelerations(scene: &Scene) -> Drawn {
    let (report, history) = (scene.report, scene.history);
    let demands = &report.summary.demands;
    let unit = report.display.unit(Quantity::Acceleration, report.summary.record.pga_m_per_s2);
    let table = scene.over_time(unit, |knot| history.table_acceleration_m_per_s2[knot]);
    let block = scene.over_time(unit, |knot| history.block_acceleration_m_per_s2[knot]);
    let names = &report.summary.names;
    let acceleration = |name: &str| ACCELERATION.name(&shortened(name, 24), Along::One);
    let block_peak = unit.of(demands.peak_block_acceleration_m_per_s2);
    let mut panels = vec![
        history_panel(scene, &acceleration("Ground"), Trace::of(table), unit),
        history_panel(
            scene,
            &acceleration(names.block()),
            Trace::with_peak(block, block_peak),
            unit,
        ),
    ];
    let peaks: Vec<f64> =
        of_points(demands).iter().map(|point| point.peak_acceleration_m_per_s2).collect();
    let shown = shown_storeys(&peaks);
    for &i in &shown {
        let floor = scene.over_time(unit, |knot| history.point_acceleration(knot, i));
        let trace = Trace::with_peak(floor, unit.of(peaks[i]));
        panels.push(history_panel(scene, &acceleration(&names.point(i + 1)), trace, unit));
    }
    let caption = format!(
        "Total accelerations, each on its own scale. {SHADING} While the block sticks it moves with \
         the ground; while it slides only friction, spring and structure drive it, which caps its \
         acceleration.{}",
        shown_note(&shown, history.point_count(), names)
    );
    let title = match names.points.is_empty() {
        true => "Accelerations of ground, block and storeys over time",
        false => "Accelerations of ground, block and points over time",
    };
    over_time(scene, ("accelerations", title), panels, caption)
}

/// Demands of the storeys, or of the points of a structure by its modes.
pub(super) fn of_points(demands: &Demands) -> &[StoreyDemands] {
    if demands.points.is_empty() { &demands.storeys } else { &demands.points }
}

/// Displacement of each floor relative to the one below; none without storeys.
pub fn drifts(scene: &Scene) -> Option<Drawn> {
    let (report, history) = (scene.report, scene.history);
    let points = of_points(&report.summary.demands);
    let peaks: Vec<f64> = points.iter().map(|storey| storey.peak_drift_m).collect();
    let largest = peaks.iter().copied().fold(0.0, f64::max);
    let unit = report.display.unit(Quantity::Length, largest);
    let shown = shown_storeys(&peaks);
    if shown.is_empty() {
        return None;
    }
    let panels: Vec<Panel> = shown
        .iter()
        .map(|&i| {
            let drift = scene.over_time(unit, |knot| {
                let below = if i == 0 { 0.0 } else { history.point_displacement(knot, i - 1) };
                history.point_displacement(knot, i) - below
            });
            let trace = Trace::with_peak(drift, unit.of(peaks[i]));
            history_panel(
                scene,
                &DRIFT.name(&shortened(&report.summary.names.point(i + 1), 24), Along::One),
                trace,
                unit,
            )
        })
        .collect();
    let what = match report.model.structure() {
        Some(_) => {
            "Drift of each point: its displacement relative to the point before it (the first: \
             relative to the block)."
        }
        None => {
            "Drift of each storey: displacement of its floor relative to the floor below (storey 1: \
             relative to the block)."
        }
    };
    let note = shown_note(&shown, history.point_count(), &report.summary.names);
    let caption = format!("{what} {SHADING}{note}");
    Some(over_time(scene, ("drifts", drifts_title(&report.summary.names)), panels, caption))
}

/// A figure of panels one above the other, shaded where the block slides.
pub(super) fn over_time(
    scene: &Scene,
    (id, title): (&'static str, &str),
    panels: Vec<Panel>,
    caption: String,
) -> Drawn {
    let figure = Figure {
        id: id.to_owned(),
        title: title.to_owned(),
        description: describe(&caption, &panels),
        layout: Layout::Stacked,
        panels,
        shaded: scene.sliding.clone(),
    };
    Drawn::new(figure, caption)
}

pub(super) fn history_panel(scene: &Scene, quantity: &str, trace: Trace, unit: Unit) -> Panel {
    let (peak, note) = marked(&trace, unit, "peak");
    let upwards = Axis::symmetric(unit.label(quantity), trace.values());
    let series = vec![over_x("", Style::MAIN, trace.points)];
    Panel { peak, note, ..panel(scene.time_axis(), upwards, HISTORY_HEIGHT, series) }
}

/// The point to ring and what to write of it; nothing where all is 0.
pub fn marked(trace: &Trace, unit: Unit, word: &str) -> (Option<[f64; 2]>, String) {
    match trace.peak {
        Some([time_s, value]) if value != 0.0 => {
            let value_text = printed(value.abs(), 4);
            let time_text = printed(time_s, 4);
            (Some([time_s, value]), format!("{word} {value_text} {} at {time_text} s", unit.symbol))
        }
        _ => (None, "0 throughout".to_owned()),
    }
}

/// The caption and every panel's note, for those who cannot see the figure.
fn describe(caption: &str, panels: &[Panel]) -> String {
    let notes = panels.iter().map(|panel| format!(" {}: {}.", panel.y.label, panel.note));
    std::iter::once(caption.to_owned()).chain(notes).collect()
}
