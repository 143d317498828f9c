//! Demands over the height of the structure, over a suite: tables and figures.

use serde::Serialize;
use slipstick::assessment::floors::place_name;
use slipstick::assessment::histories::over_suite::OverSuite;
use slipstick::assessment::histories::profiles::Profile;
use slipstick::assessment::histories::{ModelHistories, OnRecord};
use slipstick::input::Bound;
use slipstick::response::DemandColumn;

use super::HistoriesReport;
use super::floors::numbered_id;
use crate::assessment::lines::{BAND, GROUPS, RECORD, laid, line, panel};
use crate::assessment::sheet::{SheetTable, cell};
use crate::display::{Quantity, Unit};
use crate::figures::Drawn;
use crate::json::each;
use crate::markup::shortened;
use crate::number::compact;
use crate::plot::{Axis, Layout, Panel, PlotSeries, Shape, Style};
use crate::view;

/// Levels from which on names would crowd an axis: numbers stand at some of them.
const MANY_LEVELS: usize = 13;

/// A profile of a model with each bound of friction.
struct Profiles<'a> {
    model: &'a ModelHistories,
    profile: Profile,
    /// Bound by bound, level by level.
    over: Vec<Vec<OverSuite>>,
    unit: Unit,
}

impl HistoriesReport<'_> {
    /// The profiles of a model that are shown: the ratio of the drift to the height where there is one, else the drift.
    fn profiles<'a>(&self, model: &'a ModelHistories) -> Vec<Profiles<'a>> {
        let of_bounds: Vec<Vec<(Profile, Vec<OverSuite>)>> =
            (0..model.bounds.len()).map(|bound| model.profiles(bound)).collect();
        let Some(first) = of_bounds.first() else { return Vec::new() };
        let has_ratio = first.iter().any(|(profile, _)| profile.key == "peak_drift_ratio");
        let shown = first.iter().enumerate();
        let shown = shown.filter(|(_, (one, _))| !(has_ratio && one.key == "peak_drift_m"));
        let of = |(i, (profile, _)): (usize, &(Profile, _))| {
            let over: Option<Vec<_>> =
                of_bounds.iter().map(|all| Some(all.get(i)?.1.clone())).collect();
            let (over, profile) = (over?, profile.clone());
            let largest = over.iter().flatten().map(|over| over.largest).fold(0.0, f64::max);
            let dimension = profile.levels.first().and_then(|(_, column)| column.dimension());
            let unit = self.display.unit(Quantity::from(dimension), largest);
            Some(Profiles { model, profile, over, unit })
        };
        shown.filter_map(of).collect()
    }

    /// A table a profile, the top first.
    pub(super) fn profile_tables(&self) -> Vec<SheetTable> {
        let of = |model: &ModelHistories| -> Vec<SheetTable> {
            let each = self.profiles(model).into_iter();
            each.map(|of| (self.of_model(&of.heading(), model), of.rows())).collect()
        };
        self.histories.models.iter().flat_map(of).collect()
    }

    /// A figure a model, a panel a profile.
    pub(super) fn profile_figures(&self) -> Vec<Drawn> {
        let figure = |(i, model): (usize, &ModelHistories)| {
            let all = self.profiles(model);
            let panels: Vec<Panel> =
                all.iter().enumerate().map(|(k, of)| of.panel(k == 0)).collect();
            let friction = match model.bounds.len() {
                1 => "",
                _ => " Records and band are with nominal friction, thick lines with each bound.",
            };
            let caption = format!(
                "Demands over the height: thin every record, grey 16 to 84 % of them, thick their {}. Displacements are \
                 relative to the block, drifts to the level below; shears are of the storey below the level.{friction}",
                model.statistic()
            );
            let title = self.of_model("Demands over the height", model);
            let id = numbered_id("profiles", i);
            (!panels.is_empty()).then(|| laid(Layout::Beside, (&id, &title), caption, panels))
        };
        self.histories.models.iter().enumerate().filter_map(figure).collect()
    }

    /// The profiles as JSON, where there are any.
    pub(super) fn profile_json(&self) -> Option<impl Serialize> {
        self.histories.profiles.as_ref()?;
        let of_model = |model: &'_ ModelHistories| {
            let of_bound = |bound: usize| {
                let all = model.profiles(bound).into_iter();
                all.map(move |(profile, over)| (bound, profile, over)).collect::<Vec<_>>()
            };
            (0..model.bounds.len()).flat_map(of_bound).collect::<Vec<_>>()
        };
        let models = self.histories.models.iter();
        let all = models.flat_map(|model| of_model(model).into_iter().map(move |of| (model, of)));
        Some(each(all, |(model, (bound, profile, over))| {
            let list = |of: fn(&OverSuite) -> f64| over.iter().map(of).collect::<Vec<f64>>();
            let levels = profile.levels.iter().map(|(level, _)| *level);
            let heights_m = model.levels_m.as_ref();
            view! {
                model: &model.name,
                friction: model.bounds[bound].name,
                demand: profile.key,
                levels: levels.clone().map(|level| level as u64).collect::<Vec<u64>>(),
                names: each(levels.clone(), |level| place_name(&model.names, level + 1)),
                heights_m: heights_m.map(|all| each(levels, |level| all[level])),
                mean: list(|over| over.mean),
                p16: list(|over| over.fractiles[0]),
                median: list(|over| over.fractiles[1]),
                p84: list(|over| over.fractiles[2]),
                largest: list(|over| over.largest),
            }
        }))
    }
}

impl Profiles<'_> {
    /// `Peak acceleration`.
    fn title(&self) -> String {
        let words = self.profile.levels.last().map_or("", |(_, column)| column.demand.words);
        let (first, rest) = words.split_at(words.chars().next().map_or(0, char::len_utf8));
        format!("{}{rest}", first.to_uppercase())
    }

    fn heading(&self) -> String {
        let title = format!("{} over the height, {}", self.title(), self.model.statistic());
        self.unit.label(&title)
    }

    /// Whether it is of what lies between a level and the one below: it is constant over the storey.
    fn is_of_storeys(&self) -> bool {
        self.profile.key.starts_with("peak_drift") || self.profile.key == "peak_shear_n"
    }

    /// What governs at a level with a bound.
    fn governing(&self, bound: usize, place: usize) -> f64 {
        self.model.governing_of(&self.over[bound][place])
    }

    /// The levels from the top: what governs with each bound, and the fractiles with the bound that governs.
    fn rows(&self) -> Vec<Vec<String>> {
        let (model, several) = (self.model, self.model.counted() > 1);
        let heights_m = model.levels_m.as_ref();
        let named = |bound: &Bound| match model.bounds.len() {
            1 => model.statistic().to_owned(),
            _ => bound.name.to_owned(),
        };
        let mut head = vec!["Level".to_owned()];
        head.extend(heights_m.map(|_| "Height (m)".to_owned()));
        head.extend(model.bounds.iter().map(named));
        head.extend(["16 %", "84 %"].iter().filter(|_| several).map(|name| (*name).to_owned()));
        let levels = self.profile.levels.iter().enumerate().rev();
        let row = |(place, (level, _)): (usize, &(usize, DemandColumn))| {
            let values: Vec<f64> =
                (0..self.over.len()).map(|bound| self.governing(bound, place)).collect();
            let most = values.iter().copied().fold(0.0, f64::max);
            let stars = values.iter().any(|value| *value < most);
            let value = |value: &f64| {
                let star = if stars && *value == most { "*" } else { "" };
                format!("{}{star}", cell(self.unit.of(*value)))
            };
            let governs = values.iter().position(|value| *value == most).unwrap_or_default();
            let fractiles = self.over[governs][place].fractiles;
            let mut row = vec![shortened(&place_name(&model.names, level + 1), 28)];
            row.extend(heights_m.map(|all| compact(all[*level])));
            row.extend(values.iter().map(value));
            let fractiles = [fractiles[0], fractiles[2]].into_iter().filter(|_| several);
            row.extend(fractiles.map(|value| cell(self.unit.of(value))));
            row
        };
        core::iter::once(head).chain(levels.map(row)).collect()
    }

    /// Where a level stands on the axis.
    fn height(&self, level: usize) -> f64 {
        // Names of an axis stand at 1, 2, 3 …
        self.model.levels_m.as_ref().map_or((level + 1) as f64, |all| all[level])
    }

    fn levels(&self) -> usize {
        self.profile.levels.last().map_or(0, |(level, _)| level + 1)
    }

    /// The axis of the levels, with their names where `named` says so.
    fn axis(&self, named: bool) -> Axis {
        let n = self.levels();
        match &self.model.levels_m {
            Some(all) => Axis::linear("Height (m)", 0.0, all.last().copied().unwrap_or(1.0)),
            None => {
                let every = n / MANY_LEVELS + 1;
                let name = |level: usize| match every {
                    _ if !named => String::new(),
                    1 => shortened(&place_name(&self.model.names, level + 1), 12),
                    _ if level.is_multiple_of(every) => level.to_string(),
                    _ => String::new(),
                };
                Axis::named("", (0..n).map(name).collect())
            }
        }
    }

    /// The line through values of the levels: drifts and shears are constant over their storey,
    /// displacements begin at the block.
    fn points(&self, value: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
        let each = self.profile.levels.iter().enumerate();
        let own = |(place, (level, _)): (usize, &(usize, DemandColumn))| {
            (*level, self.unit.of(value(place)))
        };
        let values: Vec<(usize, f64)> = each.map(own).collect();
        if self.is_of_storeys() {
            let storey = |(level, value): (usize, f64)| {
                [[value, self.height(level - 1)], [value, self.height(level)]]
            };
            return values.into_iter().flat_map(storey).collect();
        }
        let has_block = values.first().is_some_and(|(level, _)| *level == 0);
        let block = (!has_block).then_some([0.0, self.height(0)]);
        let rest = values.into_iter().map(|(level, value)| [value, self.height(level)]);
        block.into_iter().chain(rest).collect()
    }

    fn series(&self) -> Vec<PlotSeries> {
        let model = self.model;
        let nominal = model.bounds.iter().position(|bound| *bound == Bound::NOMINAL);
        let nominal = nominal.unwrap_or_default();
        let mut series = Vec::new();
        if model.counted() > 1 {
            let fractile = |i: usize| self.points(|place| self.over[nominal][place].fractiles[i]);
            let points = fractile(0).into_iter().chain(fractile(2).into_iter().rev()).collect();
            let (label, style) = ("16 to 84 %".to_owned(), Style::MAIN);
            series.push(PlotSeries { label, style, shape: Shape::Band(BAND), points });
            let size =
                |on: &OnRecord, place: usize| on.size(&self.profile.levels[place].1, nominal);
            let records = model.records.iter().filter(|on| !on.is_unconfirmed());
            series.extend(records.map(|on| line("", RECORD, self.points(|place| size(on, place)))));
        }
        for ((bound, named), style) in model.bounds.iter().enumerate().zip(GROUPS) {
            let label = match model.bounds.len() {
                1 => model.statistic().to_owned(),
                _ => format!("{} friction", named.name),
            };
            series.push(line(label, style, self.points(|place| self.governing(bound, place))));
        }
        series
    }

    /// The names of levels at the left of a panel whose axis has their heights, where they do not crowd it.
    fn level_names(&self) -> Vec<PlotSeries> {
        let crowded = self.levels() >= MANY_LEVELS || self.model.levels_m.is_none();
        let named = (0..self.levels()).filter(|_| !crowded).map(|level| PlotSeries {
            label: shortened(&place_name(&self.model.names, level + 1), 16),
            style: Style::MAIN,
            shape: Shape::Named,
            points: vec![[0.0, self.height(level)]],
        });
        named.collect()
    }

    fn panel(&self, is_first: bool) -> Panel {
        let mut series = self.series();
        if !is_first {
            series.iter_mut().for_each(|series| series.label.clear());
        }
        let values = series.iter().flat_map(|series| &series.points).map(|point| point[0]);
        let x = Axis::from_zero(self.unit.label(&self.title()), values.collect::<Vec<_>>());
        if is_first {
            series.extend(self.level_names());
        }
        panel(x, self.axis(is_first), 260.0, series)
    }
}
