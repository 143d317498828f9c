//! The front, and where its designs lie.

use slipstick::assessment::design::{Bounded, DesignMap, Figures, Point};
use slipstick::assessment::grid::Axis as Variable;

use super::{DesignReport, label};
use crate::assessment::lines::{dots, line, panel, single, stacked};
use crate::display::Unit;
use crate::figures::Drawn;
use crate::legend::{FRONT, GAP, LOWER_FRICTION, UPPER_FRICTION, not_exceeded};
use crate::number::compact;
use crate::plot::{Axis, PlotSeries, Shape, Style, contour, levels};

impl DesignReport<'_> {
    pub(super) fn figures(&self) -> Vec<Drawn> {
        let front = (!self.run.found.front.is_empty()).then(|| self.front_figure());
        let map = self.run.map.as_ref().map(|map| self.map_figure(map));
        front.into_iter().chain(map).collect()
    }

    fn front_figure(&self) -> Drawn {
        let (l, a) = (self.length(), self.acceleration_unit());
        let at =
            |figures: &Figures| [l.of(figures.displacement_m), a.of(figures.acceleration_m_per_s2)];
        let front: Vec<[f64; 2]> = self.run.found.front.iter().map(|p| at(&p.figures)).collect();
        let mut series = vec![
            line(FRONT.label, FRONT.style, front.clone()),
            designs("", "#0b3c6f", front.clone()),
        ];
        if let Some((_, bounded)) = self.bounded() {
            for (label, fill, pick) in [
                (LOWER_FRICTION.label, "#fff", (|b| &b.lower) as fn(&Bounded) -> &Figures),
                (UPPER_FRICTION.label, "#767676", |b| &b.upper),
            ] {
                let points: Vec<[f64; 2]> = bounded.iter().map(|b| at(pick(b))).collect();
                series.push(PlotSeries {
                    style: Style { colour: "#b3541e", width: 0.7, dashes: "" },
                    ..designs(&label, fill, points)
                });
            }
        }
        let all: Vec<[f64; 2]> = series.iter().flat_map(|s| s.points.iter().copied()).collect();
        let top = all.iter().map(|p| p[1]).filter(|v| v.is_finite()).fold(0.0, f64::max);
        let gap = l.of(self.target.gap_m);
        series.push(line(GAP.label, GAP.style, vec![[gap, 0.0], [gap, 1.06 * top]]));
        let x = Axis::from_zero(
            l.label(&not_exceeded("Displacement", self.target.probability)),
            all.iter().map(|p| p[0]).chain([gap]),
        );
        let y = Axis::linear(
            a.label(&not_exceeded("Acceleration", self.target.acceleration_share)),
            0.0,
            1.06 * top,
        );
        series.push(ring(front.last().copied()));
        let frame = panel(x, y, 260.0, series);
        let bounds = if self.bounded().is_some() {
            " Small points: the same designs with lower- and upper-bound friction."
        } else {
            ""
        };
        let caption = format!(
            "Designs that keep the gap and that no other beats in both displacement and floor \
             acceleration; the chosen one is ringed.{bounds}"
        );
        single("front", "Front", caption, frame)
    }

    /// Lines of equal displacement and equal acceleration over the two main variables.
    fn map_figure(&self, map: &DesignMap) -> Drawn {
        let [x, y] = map.variables.map(|i| &self.run.variables[i]);
        let only = self.run.variables.len() == 2;
        let at = |point: &Point| {
            let values = self.values(point.design);
            map.variables.map(|i| values[i])
        };
        let front: Vec<[f64; 2]> = self.run.found.front.iter().map(at).collect();
        let main = self.run.found.chosen().or(self.run.found.nearest);
        let axis = |variable: &Variable, values: &[f64]| {
            let (low, high) = (values[0], values[values.len() - 1]);
            // Points at the ends of a range stand within the frame, whole.
            let margin = MARGIN * (high - low);
            Axis::linear(label(variable), low - margin, high + margin)
        };
        let (l, a) = (self.length(), self.acceleration_unit());
        let of = |values: &[f64], unit: Unit, what: &str, limit: Option<f64>| {
            let shown: Vec<f64> = values.iter().map(|value| unit.of(*value)).collect();
            let finite = || shown.iter().copied().filter(|value| value.is_finite());
            let low = finite().fold(f64::INFINITY, f64::min);
            let high = finite().fold(f64::NEG_INFINITY, f64::max);
            let mut series = Vec::new();
            let mut names = Vec::new();
            let beside =
                |level: &f64| limit.is_none_or(|limit| (level - limit).abs() > 1e-3 * (high - low));
            for level in levels(low, high, LINES).into_iter().filter(beside) {
                let style = Style { width: 0.9, ..Style::MAIN };
                add_lines(&mut series, &mut names, map, &shown, level, style, compact(level));
            }
            if let Some(limit) = limit {
                let name = format!("gap {}", compact(limit));
                add_lines(&mut series, &mut names, map, &shown, limit, Style::LIMIT, name);
            }
            if only {
                series.push(designs("front", "#0b3c6f", front.clone()));
            }
            series.push(ring(main.as_ref().map(at)));
            series.extend(names);
            // The heading of the panel stands where the label of its axis does.
            let heading = unit.label(what);
            let y = Axis { label: format!("{}; {heading}", label(y)), ..axis(y, &map.y) };
            panel(axis(x, &map.x), y, 250.0, series)
        };
        let panels = vec![
            of(&map.displacement_m, l, "lines of displacement", Some(l.of(self.target.gap_m))),
            of(&map.acceleration_m_per_s2, a, "lines of acceleration", None),
        ];
        let others = if only { "" } else { ", the other variables as in the chosen design" };
        let points = if only { " Points: the front." } else { "" };
        let displacements = || map.displacement_m.iter().filter(|value| value.is_finite());
        let is_crossed = displacements().any(|value| *value < self.target.gap_m)
            && displacements().any(|value| *value > self.target.gap_m);
        let gap = if is_crossed { "; the gap in red" } else { "" };
        let caption = format!(
            "Displacement not exceeded in {} % of the records (above{gap}) and acceleration \
             not exceeded in {} % (below), over {} and {}{others}.{points} The {} design is ringed.",
            compact(100.0 * self.target.probability),
            compact(100.0 * self.target.acceleration_share),
            super::name(x),
            super::name(y),
            if self.run.found.front.is_empty() { "nearest" } else { "chosen" }
        );
        stacked("map", "Displacement and acceleration over the main variables", caption, panels)
    }
}

/// Room around the ranges of a map, as a share of them.
const MARGIN: f64 = 0.05;

/// About so many lines in a panel.
const LINES: usize = 8;

/// The lines of a level, and its name on the longest of them.
fn add_lines(
    series: &mut Vec<PlotSeries>,
    names: &mut Vec<PlotSeries>,
    map: &DesignMap,
    values: &[f64],
    level: f64,
    style: Style,
    name: String,
) {
    let lines = contour(&map.x, &map.y, values, level);
    let longest = lines.iter().max_by_key(|line| line.len());
    if let Some(longest) = longest.filter(|line| line.len() > 2) {
        // Not all in the middle: names of neighbours would stand on each other.
        let place = longest[(longest.len() * (1 + names.len() % 3)) / 4];
        names.push(PlotSeries { label: name, style, shape: Shape::Named, points: vec![place] });
    }
    series.extend(lines.into_iter().map(|points| line("", style, points)));
}

/// A ring around the chosen design.
fn ring(at: Option<[f64; 2]>) -> PlotSeries {
    let style = Style { colour: "#a3161c", width: 3.2, dashes: "" };
    dots("chosen", style, "none", at.into_iter().collect())
}

fn designs(label: &str, fill: &'static str, points: Vec<[f64; 2]>) -> PlotSeries {
    dots(label, Style { colour: "#0b3c6f", width: 0.9, dashes: "" }, fill, points)
}
