//! Forces at the base of models over their suites: what the isolators and the structure take, in each direction, over the
//! weights by name; overturning, and the range of axial force that it makes.

use slipstick::assessment::histories::ModelHistories;
use slipstick::response::Demands;

use super::HistoriesReport;
use super::judged::DIRECTIONS;
use crate::assessment::sheet::{SheetTable, cell};
use crate::display::Quantity;

impl HistoriesReport<'_> {
    /// One row a force and direction, a column a bound.
    pub(super) fn force_table(&self, model: &ModelHistories) -> SheetTable {
        let bounds = 0..model.bounds.len();
        let axes: Vec<Option<usize>> =
            if model.is_in_plane() { vec![Some(0), Some(1)] } else { vec![None] };
        let at = |axis: Option<usize>, of: fn(&Demands) -> Option<f64>| -> Vec<f64> {
            let one = |bound| model.governing_along(bound, axis, of).unwrap_or(f64::NAN);
            bounds.clone().map(one).collect()
        };
        let along =
            |axis: Option<usize>| axis.map_or(String::new(), |i| format!(", {}", DIRECTIONS[i]));
        let heads = match model.bounds.as_slice() {
            [_] => vec![model.statistic().to_owned()],
            several => several.iter().map(|bound| bound.name.to_owned()).collect(),
        };
        let unit = self.display.unit(Quantity::Force, model.weight_n);
        let weight = |n: f64| format!("{} {}", cell(unit.of(n)), unit.symbol);
        let row = |name: String, values: Vec<String>| {
            core::iter::once(name).chain(values).collect::<Vec<String>>()
        };
        let mut rows = vec![row(String::new(), heads)];
        let cells = |values: &[f64], over: f64| values.iter().map(|v| cell(v / over)).collect();
        for axis in &axes {
            let forces = at(*axis, |demands| Some(demands.peak_slider_force_n));
            let name = format!("Force of the isolators V_b{}", along(*axis));
            rows.push(row(unit.label(&name), cells(&forces, unit.in_si)));
            let name = format!("  over the whole weight W = {}", weight(model.weight_n));
            rows.push(row(name, cells(&forces, model.weight_n)));
        }
        for (axis, above_n) in axes.iter().filter_map(|axis| Some((axis, model.above_block_n?))) {
            let forces = at(*axis, |demands| Some(demands.peak_base_shear_n));
            let name = format!("Shear of the structure above the block{}", along(*axis));
            rows.push(row(unit.label(&name), cells(&forces, unit.in_si)));
            let name = format!("  over the whole weight W = {}", weight(model.weight_n));
            rows.push(row(name, cells(&forces, model.weight_n)));
            let name = format!("  over the weight above the block W_s = {}", weight(above_n));
            rows.push(row(name, cells(&forces, above_n)));
        }
        for axis in &axes {
            let ratios = at(*axis, |demands| demands.overturning_ratio);
            if ratios.iter().any(|ratio| ratio.is_nan()) {
                continue;
            }
            let name = format!("Overturning moment over W width/2{}", along(*axis));
            rows.push(row(name, cells(&ratios, 1.0)));
            for (spread, part) in [("in rows at both edges", 1.0), ("spread evenly", 3.0)] {
                let name = format!("  axial range of isolators {spread}, over the mean");
                let range = |ratio: &f64| {
                    format!("{} to {}", cell(1.0 - part * ratio), cell(1.0 + part * ratio))
                };
                rows.push(row(name, ratios.iter().map(range).collect()));
            }
        }
        let heading = format!("Forces at the base, {}{}", model.statistic(), self.at());
        (self.of_model(&heading, model), rows)
    }
}

/// What no run of these follows.
pub(super) fn not_modelled(torsion: bool) -> Vec<String> {
    let turned = match torsion {
        true => {
            "Torsion about the vertical: displacements of the runs are of the centre; the factor beside them is of the \
                 plan or the code, not of a run."
        }
        false => "Torsion about the vertical: displacements of the runs are of the centre.",
    };
    [
        turned,
        "Rocking and uplift: the normal force is that of the whole weight, spread evenly, and an edge that would lift stays \
         down. The axial range beside the forces is of statics.",
        "Single isolators: stability, temperature, wear and ageing of each; what bounds of friction stand for.",
        "Yielding and second-order effects of the structure, which is linear; soil, whose motion is the record's.",
        "Wind, creep, offsets and live load.",
    ]
    .map(str::to_owned)
    .to_vec()
}
