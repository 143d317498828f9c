//! What devices do: friction over the sliding speed, surfaces in series, contents.

use slipstick::model::Contents;
use slipstick::response::Mode;
use slipstick::slider::{Direction, Surface};

use super::force::vertical_at_knots;
use super::histories::{SHADING, history_panel, over_time};
use super::{Drawn, Scene, Trace};
use crate::assessment::lines::{dots, line, panel, single};
use crate::display::Quantity;
use crate::legend::{self, Along, DISPLACEMENT};
use crate::markup::shortened;
use crate::number::compact;
use crate::plot::{Axis, Limit, Panel, Style};

/// How many instants of the run are marked on its law.
const MARKS: usize = 240;

/// The kinetic coefficient over the sliding speed, and `|T|/N` of the run on it.
pub fn friction_by_speed(scene: &Scene) -> Option<Drawn> {
    let (report, history) = (scene.report, scene.history);
    let rate = report.model.slider().rate()?;
    let peak_m_per_s = report.summary.demands.peak_sliding_velocity_m_per_s;
    if !(peak_m_per_s > 0.0) {
        return None;
    }
    let unit = report.display.unit(Quantity::Velocity, peak_m_per_s);
    let end_m_per_s = 1.25 * peak_m_per_s;
    let law = |direction: Direction| -> Vec<[f64; 2]> {
        let at = |i: u32| end_m_per_s * f64::from(i) / 200.0;
        (0..=200).map(|i| [unit.of(at(i)), rate.at(at(i), direction)]).collect()
    };
    let normal = {
        let model = report.model;
        let lift = report.motion.vertical_m_per_s2();
        let lift = lift.map(|up| vertical_at_knots(report.motion, up, &history.time_s));
        move |knot: usize| {
            let up = lift.as_ref().map_or(0.0, |lift| lift[knot]);
            model.total_mass_kg() * (model.normal_gravity_m_per_s2() + up).max(0.0)
        }
    };
    let slips: Vec<usize> = (0..history.len())
        .filter(|&knot| matches!(history.modes(knot)[0], Mode::Slip(_)) && normal(knot) > 0.0)
        .collect();
    let run = slips.iter().step_by(slips.len().div_ceil(MARKS).max(1)).map(|&knot| {
        let speed = history.sliding_velocity_m_per_s[knot].abs();
        [unit.of(speed), history.friction_force_n[knot].abs() / normal(knot)]
    });
    let [positive, negative] = [Direction::Positive, Direction::Negative].map(law);
    let mut series = if positive == negative {
        vec![line("kinetic friction", Style::MAIN, positive)]
    } else {
        vec![
            line("kinetic friction towards +x", Style::MAIN, positive),
            line("towards −x", Style::DASHED, negative),
        ]
    };
    series.push(dots("|T|/N of the run", Style::WIDE, Style::WIDE.colour, run.collect()));
    let values = series.iter().flat_map(|s| s.points.iter().map(|point| point[1]));
    let along = Axis::linear(unit.label("Sliding speed"), 0.0, unit.of(end_m_per_s));
    let upwards = Axis::from_zero("Coefficient of friction", values.collect::<Vec<_>>());
    let note = format!("fastest {} {}", compact(unit.of(peak_m_per_s)), unit.symbol);
    let panel = Panel { note, ..panel(along, upwards, 170.0, series) };
    let caption =
        "Kinetic friction over the sliding speed: the law as it is given, and the friction \
                   force over the normal force at instants of the run. Where dots crowd, the block \
                   slides for longest."
            .to_owned();
    Some(single("friction-by-speed", "Coefficient of friction over sliding speed", caption, panel))
}

/// Displacement of each surface in series over time, with the end of its travel.
pub fn surfaces(scene: &Scene) -> Option<Drawn> {
    let (report, history) = (scene.report, scene.history);
    let series = report.model.slider().series()?;
    let peaks = report.summary.demands.surfaces.iter();
    let peak_m = peaks.map(|surface| surface.peak_displacement_m).fold(0.0, f64::max);
    let unit = report.display.unit(Quantity::Length, peak_m);
    let panel = |(i, surface): (usize, &Surface)| {
        let points = scene.over_time(unit, |knot| history.surface_displacements(knot)[i]);
        let name = DISPLACEMENT.name(&format!("Surface {}", i + 1), Along::One);
        let mut panel = history_panel(scene, &name, Trace::of(points), unit);
        // An end far away would flatten the curve.
        if let Some(travel_m) = surface.travel_m.filter(|travel_m| *travel_m <= 2.5 * peak_m) {
            let travel = unit.of(travel_m);
            let values = panel.series[0].points.iter().map(|point| point[1]);
            panel.y =
                Axis::symmetric(panel.y.label.clone(), values.chain([travel]).collect::<Vec<_>>());
            let limit = |value: f64, label: &str| Limit {
                value,
                label: label.to_owned(),
                style: Style::LIMIT,
            };
            panel.limits = vec![limit(travel, "end of travel"), limit(-travel, "")];
        }
        panel
    };
    let panels: Vec<Panel> = series.surfaces().iter().enumerate().map(panel).collect();
    let caption = format!(
        "Displacement of each surface of the slider; together they make the sliding displacement. \
         {SHADING} A surface that moves no further carries on with the friction of the next."
    );
    let title = "Displacements of the surfaces over time";
    Some(over_time(scene, ("surfaces", title), panels, caption))
}

/// Displacement of the contents over their floors.
pub fn contents(scene: &Scene) -> Option<Drawn> {
    let (report, history) = (scene.report, scene.history);
    let contents = report.model.contents();
    if contents.is_empty() {
        return None;
    }
    let names = &report.summary.names;
    let largest = report.summary.demands.contents.iter();
    let largest = largest.map(|of| of.peak_sliding_displacement_m).fold(0.0, f64::max);
    let unit = report.display.unit(Quantity::Length, largest);
    let panel = |(i, contents): (usize, &Contents)| {
        let points = scene.over_time(unit, |knot| history.contents_state(knot, i)[0]);
        let name =
            shortened(&legend::contents(names, i + 1, contents.floor), 40).replacen('c', "C", 1);
        history_panel(scene, &name, Trace::of(points), unit)
    };
    let panels: Vec<Panel> = contents.iter().enumerate().map(panel).collect();
    let caption =
        "Displacement of the contents over the floor that they stand on, positive towards +x. \
                   Level stretches: they move with their floor. Grey: the block slides."
            .to_owned();
    let title = "Displacement of the contents over time";
    Some(over_time(scene, ("contents", title), panels, caption))
}
