//! Floor spectra over a suite: tables and figures.

use serde::Serialize;
use slipstick::assessment::floors::place_name;
use slipstick::assessment::histories::ModelHistories;
use slipstick::assessment::histories::floors::{DIRECTIONS, FloorSpectrum};
use slipstick::assessment::histories::over_suite::OverSuite;

use super::HistoriesReport;
use crate::assessment::lines::{BAND, GROUPS, RECORD, band, over_x, panel, stacked};
use crate::assessment::sheet::SheetTable;
use crate::display::{Quantity, Unit};
use crate::figures::{Drawn, shown_note, shown_storeys};
use crate::floors::{heading, heads, largest, ordinates, shown_ordinates};
use crate::json::each;
use crate::markup::shortened;
use crate::number::compact;
use crate::plot::{Axis, Panel, PlotSeries, Style};
use crate::view;

/// The line of the ground beside those of a place.
const GROUND: Style = Style { colour: "#6b6b6b", width: 1.2, dashes: "8 3 2 3" };

/// What is drawn of places and bounds of friction.
struct Drawing<'a> {
    model: &'a ModelHistories,
    periods_s: &'a [f64],
    unit: Unit,
}

impl HistoriesReport<'_> {
    /// The spectra of each model at round periods: of every place what governs with each bound of friction, then the
    /// other statistics with the bound that gives the largest ordinate.
    pub(super) fn floor_tables(&self) -> Vec<SheetTable> {
        self.histories.models.iter().filter_map(|model| self.floor_table(model)).collect()
    }

    fn floor_table(&self, model: &ModelHistories) -> Option<SheetTable> {
        let one = model.a_floor_spectrum()?;
        let unit = self.floor_unit(model);
        let bounds = model.bounds.len();
        let several = model.counted() > 1;
        let mut head = vec!["Place".to_owned()];
        head.extend((bounds > 1).then(|| "Friction".to_owned()));
        head.extend(several.then(|| "Statistic".to_owned()));
        let mut rows = vec![head.into_iter().chain(heads()).collect::<Vec<_>>()];
        let ordinates = |of: FloorSpectrum, statistic: &dyn Fn(&OverSuite) -> f64| {
            let sa: Vec<f64> = model.floor_spectrum(of)?.iter().map(statistic).collect();
            Some(ordinates(&one.periods_s, &sa))
        };
        for place in 0..one.sa.places().count() {
            let of = FloorSpectrum { place, ..FloorSpectrum::default() };
            let governs = model.floor_governs(of)?;
            let first = rows.len();
            let mut row = |bound: usize, statistic: &str, cells: Vec<String>| {
                let is_first = rows.len() == first;
                let name = if is_first { place_name(&model.names, place) } else { String::new() };
                let mut row = vec![shortened(&name, 28)];
                // The ground moves as it does, whatever the friction.
                let friction = if place == 0 { "—" } else { model.bounds[bound].name };
                row.extend((bounds > 1).then(|| friction.to_owned()));
                row.extend(several.then(|| statistic.to_owned()));
                rows.push(row.into_iter().chain(cells).collect());
            };
            let of_bounds: Option<Vec<Vec<f64>>> = (0..if place == 0 { 1 } else { bounds })
                .map(|bound| ordinates(FloorSpectrum { bound, ..of }, &|o| model.governing_of(o)))
                .collect();
            let of_bounds = of_bounds?;
            for (bound, values) in of_bounds.iter().enumerate() {
                let is_most = |i: usize| {
                    let most = of_bounds.iter().map(|values| values[i]).fold(0.0, f64::max);
                    let least = of_bounds.iter().map(|values| values[i]).fold(f64::MAX, f64::min);
                    // The second is the period of the first.
                    i != 1 && values[i] == most && least < most
                };
                let cells = shown_ordinates(values, unit).into_iter().enumerate();
                let cells = cells.map(|(i, text)| if is_most(i) { text + "*" } else { text });
                row(bound, model.statistic(), cells.collect());
            }
            let mean = (model.statistic() != "mean").then_some(("mean", 3));
            let rest = mean.into_iter().chain([("16 %", 0), ("84 %", 2)]);
            for (name, which) in rest.filter(|_| several) {
                let of = FloorSpectrum { bound: governs, ..of };
                let values = ordinates(of, &|over| match over.fractiles.get(which) {
                    Some(fractile) => *fractile,
                    None => over.mean,
                });
                row(governs, name, shown_ordinates(&values?, unit));
            }
        }
        let direction = if one.axes.is_some() { ", RotD100" } else { "" };
        let heading = heading(one.damping_ratio, unit.symbol, direction);
        Some((self.of_model(&heading, model), rows))
    }

    /// The unit of the largest ordinate that governs.
    fn floor_unit(&self, model: &ModelHistories) -> Unit {
        let all = model.floor_spectra();
        let largest = all.iter().flat_map(|(_, over)| over).map(|over| model.governing_of(over));
        self.display.unit(Quantity::Acceleration, largest.fold(0.0, f64::max))
    }

    /// The spectra of the block and some floors of each model: the records with the bound that governs, their band,
    /// and what governs with each bound.
    pub(super) fn floor_figures(&self) -> Vec<Drawn> {
        let models = self.histories.models.iter().enumerate();
        models.filter_map(|(i, model)| self.floor_figure(i, model)).collect()
    }

    fn floor_figure(&self, number: usize, model: &ModelHistories) -> Option<Drawn> {
        let one = model.a_floor_spectrum()?;
        let periods_s = &one.periods_s;
        let (&first, &last) = (periods_s.first()?, periods_s.last()?);
        let drawing = Drawing { model, periods_s, unit: self.floor_unit(model) };
        let peaks: Option<Vec<f64>> =
            (2..one.sa.places().count()).map(|place| drawing.peak(place)).collect();
        let peaks = peaks?;
        let shown = shown_storeys(&peaks);
        let places = core::iter::once(1).chain(shown.iter().map(|storey| storey + 2));
        let drawn: Option<Vec<(usize, Vec<PlotSeries>)>> =
            places.map(|place| Some((place, drawing.series(place)?))).collect();
        let drawn = drawn?;
        // That of the ground would flatten those of floors on sliders: it is cut where it is higher.
        let above = drawn.iter().flat_map(|(_, series)| series).filter(|of| of.style != GROUND);
        let points = above.flat_map(|series| &series.points);
        let direction = if one.axes.is_some() { ", RotD100" } else { "" };
        let label = format!("{}{direction}", drawing.unit.label("Spectral acceleration"));
        let y = Axis::from_zero(label, points.map(|point| point[1]).collect::<Vec<_>>());
        let panels = drawn.into_iter().enumerate().map(|(i, (place, mut series))| {
            if i > 0 {
                series.iter_mut().for_each(|series| series.label.clear());
            }
            let x = Axis::logarithmic("Period (s)", first, last);
            let note = shortened(&place_name(&model.names, place), 28);
            Panel { note, ..panel(x, y.clone(), 140.0, series) }
        });
        let friction = match model.bounds.len() {
            1 => "",
            _ => {
                " Records and band are with the bound of friction that gives the largest ordinate of the place, thick \
                 lines with each bound."
            }
        };
        let rotated = match one.axes {
            Some(_) => " RotD100 is the largest over all horizontal directions.",
            None => "",
        };
        let caption = format!(
            "Floor spectra at {} % damping: thin every record, grey 16 to 84 % of them, thick their {}, dashed and dotted \
             that of the ground, cut where it is higher than all floors.{friction}{rotated}{}",
            compact(100.0 * one.damping_ratio),
            model.statistic(),
            shown_note(&shown, peaks.len(), &model.names)
        );
        let id = numbered_id("floor-spectra", number);
        let title = self.of_model("Floor spectra over the suite", model);
        Some(stacked(&id, &title, caption, panels.collect()))
    }

    /// The spectra as JSON, where they were asked for.
    pub(super) fn floor_json(&self) -> Option<impl Serialize> {
        let models = self.histories.models.iter();
        let one = models.clone().find_map(ModelHistories::a_floor_spectrum)?;
        let in_plane = one.axes.is_some();
        let all = models.flat_map(|model| {
            model.floor_spectra().into_iter().map(move |(of, over)| (model, of, over))
        });
        let spectra = each(all, |(model, of, over)| {
            let is_governing = model.floor_governs(of) == Some(of.bound);
            let list = |of: fn(&OverSuite) -> f64| over.iter().map(of).collect::<Vec<f64>>();
            view! {
                model: &model.name,
                friction: model.bounds[of.bound].name,
                place: place_name(&model.names, of.place),
                direction: in_plane.then(|| DIRECTIONS[of.direction]),
                governs: is_governing,
                mean_m_per_s2: list(|over| over.mean),
                p16_m_per_s2: list(|over| over.fractiles[0]),
                median_m_per_s2: list(|over| over.fractiles[1]),
                p84_m_per_s2: list(|over| over.fractiles[2]),
                largest_m_per_s2: list(|over| over.largest),
            }
        });
        Some(view! {
            damping_ratio: one.damping_ratio,
            period_s: &one.periods_s,
            spectra,
        })
    }
}

/// An identifier, with the number of the model from the second on.
pub(super) fn numbered_id(id: &str, model: usize) -> String {
    if model == 0 { id.to_owned() } else { format!("{id}-{}", model + 1) }
}

impl Drawing<'_> {
    fn governing(&self, of: FloorSpectrum) -> Option<Vec<f64>> {
        let over = self.model.floor_spectrum(of)?;
        Some(over.iter().map(|over| self.model.governing_of(over)).collect())
    }

    /// Largest ordinate of a place that governs, with any bound.
    fn peak(&self, place: usize) -> Option<f64> {
        let of = FloorSpectrum { place, ..FloorSpectrum::default() };
        let bound = self.model.floor_governs(of)?;
        self.governing(FloorSpectrum { bound, ..of }).map(|sa| largest(&sa))
    }

    fn line(&self, label: String, style: Style, sa: &[f64]) -> PlotSeries {
        let points = self.periods_s.iter().zip(sa).map(|(t, sa)| [*t, self.unit.of(*sa)]);
        over_x(label, style, points.collect())
    }

    /// The lines of a place, those of single records lowest.
    fn series(&self, place: usize) -> Option<Vec<PlotSeries>> {
        let model = self.model;
        let of = FloorSpectrum { place, ..FloorSpectrum::default() };
        let governs = FloorSpectrum { bound: model.floor_governs(of)?, ..of };
        let mut series = Vec::new();
        if model.counted() > 1 {
            let over = model.floor_spectrum(governs)?;
            let fractile =
                |i: usize| over.iter().map(|o| self.unit.of(o.fractiles[i])).collect::<Vec<_>>();
            series.push(band(self.periods_s, &fractile(0), &fractile(2), "16 to 84 %", BAND));
            let records = model.records.iter().filter(|on| !on.is_unconfirmed());
            let records = records.filter_map(|on| on.floor_spectrum(governs));
            series.extend(records.map(|sa| self.line(String::new(), RECORD, sa)));
        }
        let ground = FloorSpectrum { place: 0, ..of };
        series.push(self.line("ground".to_owned(), GROUND, &self.governing(ground)?));
        for ((bound, named), style) in model.bounds.iter().enumerate().zip(GROUPS) {
            let sa = self.governing(FloorSpectrum { bound, ..of })?;
            let label = match model.bounds.len() {
                1 => model.statistic().to_owned(),
                _ => format!("{} friction", named.name),
            };
            series.push(self.line(label, style, &sa));
        }
        Some(series)
    }
}
