//! The modes of a structure as people and programs read them: what `slipstick structure info` says.

use slipstick::error::visible;
use slipstick::input::{ModalTable, Share};

use crate::assessment::lines::{line, panel};
use crate::display::{DisplayUnits, Quantity};
use crate::json::{each, pretty};
use crate::laboratory::text::padded;
use crate::number::significant;
use crate::plot::{Axis, Figure, Layout, Panel, PlotSeries, Style, Svg, column};
use crate::view;

const AXES: [&str; 2] = ["x", "y"];

/// Modes that are drawn: three a row.
const DRAWN: usize = 6;
const IN_A_ROW: usize = 3;

/// Identifiers of the rows, each its own on a page.
const ROWS: [&str; DRAWN / IN_A_ROW] = ["mode-shapes", "mode-shapes-further"];

/// Below this part of the mass the modes lack too much of it.
const ENOUGH: f64 = 0.9;

/// Modes and what was understood of their files; `mass_kg` is that of the structure, where it is known otherwise.
#[derive(Clone, Copy, Debug)]
pub struct ModalInfo<'a> {
    /// The files as they were named.
    pub files: &'a str,
    /// What is in them.
    pub table: &'a ModalTable,
    /// Mass of the structure in kg.
    pub mass_kg: Option<f64>,
}

impl ModalInfo<'_> {
    /// The directions in which modes have a share of the mass.
    fn axes(&self) -> Vec<usize> {
        let modes = &self.table.modes;
        (0..2).filter(|axis| modes.iter().any(|mode| mode.shares[*axis].is_some())).collect()
    }

    /// What is missing of the mass, and what signs leave open.
    fn notes(&self) -> Vec<String> {
        let mut notes = self.table.notes.clone();
        for axis in self.axes() {
            let Some(sum) = self.table.sum(axis, self.mass_kg) else { continue };
            if sum < ENOUGH {
                notes.push(format!(
                    "the modes have {} % of the mass along {}: what they lack moves with the block",
                    significant(100.0 * sum, 3),
                    AXES[axis]
                ));
            }
        }
        notes
    }

    /// One JSON object; numbers in SI, `null` where the files do not say them.
    #[must_use]
    pub fn json(&self) -> String {
        let Self { table, mass_kg, .. } = *self;
        let by_axis = |value: &dyn Fn(usize) -> Option<f64>| view! { x: value(0), y: value(1) };
        let modes = table.modes.iter().enumerate();
        pretty(&view! {
            files: self.files,
            format: &table.format,
            read: &table.read,
            mass_kg: by_axis(&|axis| mass_kg.or(table.mass_kg[axis])),
            effective_mass_ratio_sum: by_axis(&|axis| table.sum(axis, mass_kg)),
            modes: each(modes, |(j, mode)| {
                let participation = |axis: usize| match mode.shares[axis] {
                    Some(Share::Participation(l)) => Some(l),
                    _ => None,
                };
                view! {
                    period_s: mode.period_s,
                    damping_ratio: mode.damping_ratio,
                    participation_sqrt_kg: by_axis(&participation),
                    effective_mass_kg: by_axis(&|a| table.effective_mass_kg(j, a, mass_kg)),
                    effective_mass_ratio: by_axis(&|a| table.ratio(j, a, mass_kg)),
                }
            }),
            points: each(&table.points, |point| {
                let [shape_x, shape_y] = &point.shapes;
                view! { name: &point.name, shape_x, shape_y }
            }),
            notes: self.notes(),
        })
    }

    /// A table of the modes with the sums of their effective masses.
    #[must_use]
    pub fn text(&self, display: DisplayUnits) -> String {
        let table = self.table;
        let axes = self.axes();
        let mut out = format!("{}  ({})\n", visible(self.files), table.format);
        for line in &table.read {
            out.push_str(&format!("  {}\n", visible(line)));
        }
        let mass = |kg: f64| {
            let unit = display.unit(Quantity::Mass, kg);
            format!("{} {}", significant(unit.of(kg), 5), unit.symbol)
        };
        let masses: Vec<String> = axes
            .iter()
            .filter_map(|axis| {
                let kg = self.mass_kg.or(table.mass_kg[*axis])?;
                Some(format!("{} along {}", mass(kg), AXES[*axis]))
            })
            .collect();
        let said = if masses.is_empty() { "not said by the files" } else { &masses.join(", ") };
        out.push_str(&format!("Mass     {said}\n"));
        let names: Vec<String> = table.points.iter().map(|point| visible(&point.name)).collect();
        let points = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        out.push_str(&format!("Points   {points}\n"));
        let mut rows = vec![vec!["Mode".to_owned(), "Period".to_owned(), "Damping".to_owned()]];
        rows[0].extend(axes.iter().map(|axis| format!("Mass {}", AXES[*axis])));
        rows[0].extend(axes.iter().map(|axis| format!("Sum {}", AXES[*axis])));
        let percent = |ratio: Option<f64>| {
            ratio.map_or("-".to_owned(), |ratio| format!("{:.2} %", 100.0 * ratio))
        };
        let mut sums = [Some(0.0); 2];
        for (j, mode) in table.modes.iter().enumerate() {
            let damping = mode.damping_ratio;
            let mut row = vec![(j + 1).to_string(), format!("{} s", significant(mode.period_s, 5))];
            row.push(
                damping.map_or("-".to_owned(), |xi| format!("{} %", significant(100.0 * xi, 3))),
            );
            let ratios: Vec<Option<f64>> =
                axes.iter().map(|axis| table.ratio(j, *axis, self.mass_kg)).collect();
            row.extend(ratios.iter().map(|ratio| percent(*ratio)));
            for (axis, ratio) in axes.iter().zip(&ratios) {
                sums[*axis] = sums[*axis].zip(*ratio).map(|(sum, ratio)| sum + ratio);
            }
            row.extend(axes.iter().map(|axis| percent(sums[*axis])));
            rows.push(row);
        }
        out.push_str(&padded(&rows, |_| false));
        for note in self.notes() {
            out.push_str(&format!("Note     {}\n", visible(&note)));
        }
        out
    }

    /// The first modes at the points, over the largest displacement of each. `None` without points.
    #[must_use]
    pub fn figure(&self) -> Option<Svg> {
        let table = self.table;
        if table.points.is_empty() || table.modes.is_empty() {
            return None;
        }
        let drawn: Vec<usize> = (0..table.modes.len().min(DRAWN)).collect();
        let figures: Vec<Svg> = drawn
            .chunks(IN_A_ROW)
            .zip(ROWS)
            .map(|(modes, id)| {
                let panels = modes.iter().map(|mode| self.panel(*mode)).collect();
                let title = format!("Modes {} to {}", modes[0] + 1, modes[modes.len() - 1] + 1);
                let description = "Shapes of modes at the points, the lowest point first; full line along x, dashed \
                                   along y.";
                Figure {
                    id: id.to_owned(),
                    title,
                    description: description.to_owned(),
                    layout: Layout::Beside,
                    panels,
                    shaded: Vec::new(),
                }
                .to_svg()
            })
            .collect();
        Some(column(&figures))
    }

    fn panel(&self, mode: usize) -> Panel {
        let table = self.table;
        let series = |axis: usize, style: Style| {
            let values: Option<Vec<f64>> =
                table.points.iter().map(|point| Some(point.shapes[axis].as_ref()?[mode])).collect();
            values.map(|values| {
                let at = (1..).zip(values).map(|(i, value)| [value, f64::from(i)]);
                let label = if mode.is_multiple_of(IN_A_ROW) {
                    format!("along {}", AXES[axis])
                } else {
                    String::new()
                };
                let points = std::iter::once([0.0, 0.0]).chain(at).collect();
                line(label, style, points)
            })
        };
        let mut lines: Vec<PlotSeries> =
            [series(0, Style::MAIN), series(1, Style::DASHED)].into_iter().flatten().collect();
        let largest =
            lines.iter().flat_map(|line| &line.points).fold(0.0, |m: f64, p| m.max(p[0].abs()));
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        for point in lines.iter_mut().flat_map(|line| &mut line.points) {
            point[0] *= scale;
        }
        let row = &table.modes[mode];
        let label = format!("Mode {}, {} s", mode + 1, significant(row.period_s, 4));
        let points = Axis::linear("Point", 0.0, table.points.len() as f64);
        panel(Axis::linear(label, -1.1, 1.1), points, 190.0, lines)
    }
}
