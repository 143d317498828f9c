//! The figures of runs over a suite.

use slipstick::assessment::histories::{Farthest, ModelHistories};
use slipstick::assessment::outline::SlidingOutline;
use slipstick::response::DemandColumn;

use super::{HistoriesReport, capital};
use crate::assessment::lines::{GROUPS, RECORD, line, over_x, panel, stacked};
use crate::assessment::pairs;
use crate::display::Unit;
use crate::figures::Drawn;
use crate::plot::{Axis, Limit, Panel, Style};

impl HistoriesReport<'_> {
    /// Sliding displacement over time, a panel a model; and the share of records that stay below a peak.
    pub(super) fn figures(&self) -> Vec<Drawn> {
        let models = &self.histories.models;
        let peaks = self.peaks();
        let unit = self.unit_of(&peaks);
        // Of two directions the size stands for both, which is never below 0.
        let in_plane = models.iter().all(ModelHistories::is_in_plane);
        let label =
            unit.label(if in_plane { "Sliding displacement |s|" } else { "Sliding displacement" });
        let end_s = models.iter().flat_map(|model| &model.records);
        let end_s = end_s.filter_map(|on| on.sliding.time_s.last());
        let end_s = end_s.fold(0.0, |a: f64, b| a.max(*b));
        let all = models.iter().flat_map(|model| &model.records);
        let nominal = all.map(|on| &on.sliding);
        let farthest = models.iter().filter_map(|model| Some(&model.farthest.as_ref()?.sliding));
        let all = nominal.chain(farthest).flat_map(|outline| &outline.sliding_displacement_m);
        let all: Vec<f64> = all.map(|s| unit.of(*s)).collect();
        // A gap far away would flatten every curve.
        let largest = all.iter().fold(0.0, |largest: f64, s| largest.max(s.abs()));
        let gaps = models
            .iter()
            .flat_map(|model| model.gap_m.into_iter().chain(model.stop_m.into_iter().flatten()));
        let gaps = gaps.map(|gap_m| unit.of(gap_m));
        let values = all.into_iter().chain(gaps.filter(|gap| *gap < 2.0 * largest));
        let y = match in_plane {
            true => Axis::from_zero(label, values.collect::<Vec<f64>>()),
            false => Axis::symmetric(label, values),
        };
        let panels = models.iter().map(|model| self.history_panel(model, &y, end_s, &unit));
        let caption = if models.iter().any(|model| model.records.len() > 1) {
            "Sliding displacement: every record with nominal friction thin; bold the largest with the bound of \
             friction that governs."
        } else {
            "Sliding displacement: thin with nominal friction, bold with the bound that governs."
        };
        let target = self.histories.matched.iter().map(|(matched, _)| pairs::figure(matched));
        let mut figures: Vec<Drawn> = target.collect();
        figures.push(stacked(
            "histories",
            "Sliding displacement",
            caption.to_owned(),
            panels.collect(),
        ));
        if models.iter().any(|model| model.records.len() > 1) {
            figures.extend(peaks.first().map(|peak| self.shares(peak, &unit)));
        }
        figures.extend(self.profile_figures());
        figures.extend(self.floor_figures());
        figures
    }

    fn history_panel(&self, model: &ModelHistories, y: &Axis, end_s: f64, unit: &Unit) -> Panel {
        let curve = |outline: &SlidingOutline, label: String, style: Style| {
            over_x(label, style, outline.points().map(|[t, s]| [t, unit.of(s)]).collect())
        };
        let nominal = model.records.iter().map(|on| curve(&on.sliding, String::new(), RECORD));
        let farthest = model.farthest.as_ref().map(|Farthest { record, bound, sliding }| {
            let name = &model.records[*record].record;
            let label = match model.bounds.len() {
                1 => name.clone(),
                _ => format!("{name}, {} friction", model.bounds[*bound].name),
            };
            curve(sliding, label, GROUPS[0])
        });
        let limit = |value: f64, label: &str| Limit {
            value: unit.of(value),
            label: label.to_owned(),
            style: Style::LIMIT,
        };
        let of_gap =
            model.gap_m.into_iter().flat_map(|gap_m| [limit(gap_m, "gap"), limit(-gap_m, "")]);
        let [ahead, behind] = model.stop_m;
        let of_stop = ahead.map(|stop_m| limit(stop_m, "stop"));
        let of_stop = of_stop.into_iter().chain(behind.map(|stop_m| limit(-stop_m, "")));
        let near = |limit: &Limit| y.min < limit.value && limit.value < y.max;
        let note = if self.histories.models.len() > 1 { model.name.clone() } else { String::new() };
        Panel {
            limits: of_gap.chain(of_stop).filter(near).collect(),
            note,
            ..panel(
                Axis::linear("Time (s)", 0.0, end_s),
                y.clone(),
                150.0,
                nominal.chain(farthest).collect(),
            )
        }
    }

    /// Share of the records whose peak is at most a value, with every bound of friction.
    fn shares(&self, column: &DemandColumn, unit: &Unit) -> Drawn {
        let mut series = Vec::new();
        let mut largest = Vec::new();
        for (model, style) in self.histories.models.iter().zip(GROUPS.iter().cycle()) {
            for (i, bound) in model.bounds.iter().enumerate() {
                let mut sizes: Vec<f64> =
                    model.sizes(column, i).iter().map(|size| unit.of(*size)).collect();
                sizes.retain(|size| !size.is_nan());
                sizes.sort_by(f64::total_cmp);
                largest.extend(sizes.last().copied());
                let mut points = vec![[0.0, 0.0]];
                for (k, size) in sizes.iter().enumerate() {
                    points.push([*size, k as f64 / sizes.len() as f64]);
                    points.push([*size, (k + 1) as f64 / sizes.len() as f64]);
                }
                let of_bound = GROUPS[i % GROUPS.len()];
                let several = model.bounds.len() > 1;
                // Of one model a style a bound; of several the colour is the model's, the dashes are the bound's.
                let (style, label) = match self.histories.models.len() {
                    1 => (of_bound, format!("{} friction", bound.name)),
                    _ if several => (
                        Style { dashes: of_bound.dashes, ..*style },
                        format!("{}, {}", model.name, bound.name),
                    ),
                    _ => (*style, model.name.clone()),
                };
                series.push(line(label, style, points));
            }
        }
        let x = Axis::from_zero(unit.label(&column.title()), largest);
        let y = Axis::linear("Share of the records", 0.0, 1.0);
        let governs = self.histories.models.iter().filter_map(|model| {
            let (bound, _) = model.governs(column).filter(|_| model.bounds.len() > 1)?;
            let of_model = self.of_model("", model);
            Some(format!(" {} friction governs{of_model}.", capital(bound.name)))
        });
        let caption = format!(
            "Share of the records whose peak sliding displacement is at most a value.{}",
            governs.collect::<String>()
        );
        stacked("shares", "Peaks over the suite", caption, vec![panel(x, y, 190.0, series)])
    }
}
