//! The front, and where its designs lie.

use slipstick::assessment::design::{Figures, Point};

use slipstick::assessment::design::Bounded;
use slipstick::assessment::grid::Axis as Variable;

use super::{DesignReport, label};
use crate::assessment::lines::{line, panel, single};
use crate::figures::Drawn;
use crate::number::compact;
use crate::plot::{Axis, Series, Shape, Style};

impl DesignReport<'_> {
    pub(super) fn figures(&self) -> Vec<Drawn> {
        if self.found.front.is_empty() {
            return Vec::new();
        }
        let mut figures = vec![self.front_figure()];
        if self.variables.len() == 2 {
            figures.push(self.plane_figure());
        }
        figures
    }

    fn front_figure(&self) -> Drawn {
        let (l, a) = (self.length(), self.acceleration_unit());
        let at =
            |figures: &Figures| [l.of(figures.displacement_m), a.of(figures.acceleration_m_per_s2)];
        let front: Vec<[f64; 2]> = self.found.front.iter().map(|p| at(&p.figures)).collect();
        let mut series = vec![
            line("front", Style { width: 1.2, ..Style::MAIN }, front.clone()),
            dots("", "#0b3c6f", front.clone()),
        ];
        if let Some((_, bounded)) = self.bounds {
            for (label, fill, pick) in [
                ("lower friction", "#fff", (|b| &b.lower) as fn(&Bounded) -> &Figures),
                ("upper friction", "#b0b0b0", |b| &b.upper),
            ] {
                let points: Vec<[f64; 2]> = bounded.iter().map(|b| at(pick(b))).collect();
                series.push(Series {
                    style: Style { colour: "#b3541e", width: 0.7, dashes: "" },
                    ..dots(label, fill, points)
                });
            }
        }
        let all: Vec<[f64; 2]> = series.iter().flat_map(|s| s.points.iter().copied()).collect();
        let top = all.iter().map(|p| p[1]).filter(|v| v.is_finite()).fold(0.0, f64::max);
        let gap = l.of(self.target.gap_m);
        series.push(line("gap", Style::LIMIT, vec![[gap, 0.0], [gap, 1.06 * top]]));
        let x = Axis::from_zero(
            l.label(&format!(
                "Displacement not exceeded in {} % of the records",
                compact(100.0 * self.target.probability)
            )),
            all.iter().map(|p| p[0]).chain([gap]),
        );
        let y = Axis::linear(
            a.label(&format!(
                "Acceleration not exceeded in {} % of the records",
                compact(100.0 * self.target.acceleration_share)
            )),
            0.0,
            1.06 * top,
        );
        series.push(ring(front.last().copied()));
        let frame = panel(x, y, 260.0, series);
        let bounds = if self.bounds.is_some() {
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

    fn plane_figure(&self) -> Drawn {
        let at = |point: &Point| {
            let values = self.values(point.design);
            [values[0], values[1]]
        };
        let points: Vec<[f64; 2]> = self.found.front.iter().map(at).collect();
        let chosen = points.last().copied();
        let range = |v: &Variable| {
            let ends = v
                .values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
            let margin = 0.04 * (ends.1 - ends.0);
            (ends.0 - margin, ends.1 + margin)
        };
        let [x, y] = [&self.variables[0], &self.variables[1]].map(|v| {
            let (low, high) = range(v);
            Axis::linear(label(v), low, high)
        });
        let frame = panel(x, y, 240.0, vec![dots("front", "#0b3c6f", points), ring(chosen)]);
        let caption =
            "Where the designs of the front lie among those looked at; the chosen one is ringed.";
        single("plane", "Designs of the front", caption.to_owned(), frame)
    }
}

/// A ring around the chosen design.
fn ring(at: Option<[f64; 2]>) -> Series {
    let style = Style { colour: "#a3161c", width: 3.2, dashes: "" };
    Series {
        label: "chosen".to_owned(),
        style,
        shape: Shape::Dots("none"),
        points: at.into_iter().collect(),
    }
}

fn dots(label: &str, fill: &'static str, points: Vec<[f64; 2]>) -> Series {
    let style = Style { colour: "#0b3c6f", width: 0.9, dashes: "" };
    Series { label: label.to_owned(), style, shape: Shape::Dots(fill), points }
}
