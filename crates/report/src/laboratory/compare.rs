//! A prediction beside a measurement.

use serde::Serialize;
use slipstick::input::Channel;
use slipstick::laboratory::anderson::in_words;
use slipstick::laboratory::compare::{Compared, Comparison, Metric, Metrics, Within};
use slipstick::model::Model;
use slipstick::response::{Method, Mode};
use slipstick::units::Dimension;

use super::text::in_groups;
use crate::assessment::key;
use crate::assessment::lines::{over_x, panel};
use crate::assessment::sheet::{Sheet, SheetTable};
use crate::describe::model_rows;
use crate::display::{DisplayUnits, Quantity, Unit};
use crate::figures::Drawn;
use crate::json::{Members, each, pretty};
use crate::legend::{MEASURED, PREDICTED, TIME};
use crate::number::{significant, typeset};
use crate::plot::{Axis, Figure, Layout, Panel, Style};
use crate::summary::method_name;
use crate::view;

/// The table's own acceleration: there to be seen, not to hide the others.
const TABLE: Style = Style { colour: "#5f7358", width: 0.8, dashes: "" };

/// What a comparison is told from.
#[derive(Clone, Copy, Debug)]
pub struct CompareReport<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// Its hash, where it was read from a text.
    pub model_hash: Option<&'a str>,
    /// The measured file as it was given.
    pub measured: &'a str,
    /// The model.
    pub model: &'a Model,
    /// How the prediction was computed.
    pub method: Method,
    /// The comparison.
    pub comparison: &'a Comparison,
    /// Bounds that it must keep.
    pub within: &'a [Within],
    /// Units to show results in.
    pub display: DisplayUnits,
}

/// The quantity of the display table that a channel is.
pub(super) fn quantity(channel: Channel) -> Quantity {
    match channel.dimension() {
        Dimension::Acceleration => Quantity::Acceleration,
        Dimension::Length => Quantity::Length,
        Dimension::Velocity => Quantity::Velocity,
        Dimension::Force => Quantity::Force,
        _ => Quantity::Time,
    }
}

/// `Sliding displacement`, `Storey 1 acceleration`.
pub(super) fn title(channel: Channel) -> String {
    key::title(&channel.name())
}

impl CompareReport<'_> {
    /// The value of a bounded figure.
    fn value(&self, within: &Within) -> Option<f64> {
        self.comparison.get(within.channel)?.metrics.get(within.metric)
    }

    /// Bounds that are missed.
    #[must_use]
    pub fn missed(&self) -> Vec<&Within> {
        self.within.iter().filter(|bound| !bound.holds(self.value(bound))).collect()
    }

    /// One line a bound: `peak_ratio.sliding_displacement = 1.25, expected 0.9 to 1.1: missed`.
    #[must_use]
    pub fn verdicts(&self) -> Vec<String> {
        let end = |value: f64| if value.is_finite() { value.to_string() } else { "any".to_owned() };
        let line = |bound: &Within| {
            let value = self.value(bound);
            let found = value.map_or("no value".to_owned(), |value| significant(value, 5));
            let verdict = if bound.holds(value) { "kept" } else { "missed" };
            let (least, most) = (end(bound.least), end(bound.most));
            format!("{} = {found}, expected {least} to {most}: {verdict}", bound.name())
        };
        self.within.iter().map(line).collect()
    }

    fn unit(&self, compared: &Compared) -> Unit {
        let largest = compared.metrics.measured_peak.max(compared.metrics.predicted_peak);
        self.display.unit(quantity(compared.pair.channel), largest)
    }

    /// Rows of names and values, a column a quantity.
    pub(super) fn rows(&self) -> Vec<Vec<String>> {
        let all = &self.comparison.compared;
        let row = |name: &str, of: &dyn Fn(&Compared, Unit) -> String| {
            let cells = all.iter().map(|c| of(c, self.unit(c)));
            core::iter::once(name.to_owned()).chain(cells).collect::<Vec<String>>()
        };
        let mut rows = vec![
            row("", &|c, _| title(c.pair.channel)),
            row("Unit", &|_, unit| unit.symbol.to_owned()),
        ];
        let told = Metrics::ALL.iter().filter_map(|figure| Some((figure.title?, figure)));
        rows.extend(told.map(|(title, figure)| {
            row(title, &|c, unit| {
                let shown = |value| if figure.unit.is_none() { unit.of(value) } else { value };
                let value = (figure.value)(&c.metrics);
                value.map_or("n/a".to_owned(), |value| significant(shown(value), 4))
            })
        }));
        if all.iter().any(|c| c.metrics.anderson.is_some()) {
            rows.push(row("Anderson's scores over the whole band (0 to 10)", &|c, _| {
                c.metrics
                    .anderson
                    .map_or(String::new(), |scores| scores.words(c.metrics.peak_ratio))
            }));
        }
        rows
    }

    /// The result laid out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let Comparison { compared, alignment, warnings, .. } = self.comparison;
        let titled = |heading: &str, rows: &[Vec<String>]| -> Vec<SheetTable> {
            in_groups(rows, 3).into_iter().map(|group| (heading.to_owned(), group)).collect()
        };
        let agreement = titled("Agreement", &self.rows());
        let scores = self.anderson().map(|rows| titled("Anderson's scores (0 to 10)", &rows));
        let pairs = |rows: &mut dyn Iterator<Item = (String, String)>| -> Vec<Vec<String>> {
            rows.map(|(name, value)| vec![name, value]).collect()
        };
        let model = model_rows(self.model, self.display).into_iter();
        let mut model = model.map(|(name, value)| (name.to_owned(), value));
        let mut origins = compared.iter().map(|c| (title(c.pair.channel), c.pair.origin.clone()));
        let line = format!(
            "Driven by the table acceleration measured in {}, {} method",
            self.measured,
            method_name(self.method)
        );
        Sheet {
            kind: "Prediction and measurement",
            name: self.name.to_owned(),
            model_hash: self.model_hash.map(str::to_owned),
            line,
            verdict: self.verdict(),
            display: self.display,
            warnings: warnings.clone(),
            tables: agreement.into_iter().chain(scores.into_iter().flatten()).collect(),
            notes: self.verdicts(),
            figures: self.figures(),
            method: vec![format!("Times: {alignment}")],
            appendix: vec![
                ("Model".to_owned(), pairs(&mut model)),
                ("Measured quantities".to_owned(), pairs(&mut origins)),
            ],
            complete: self.missed().is_empty(),
            json: pretty(&self.json()),
            ..Sheet::default()
        }
    }

    fn json(&self) -> impl Serialize {
        let c = self.comparison;
        view! {
            model: self.name,
            method: method_name(self.method),
            measured: self.measured,
            alignment: &c.alignment,
            starts_at_s: c.start_s,
            samples: c.motion.len(),
            dt_s: c.motion.dt_s(),
            table_peak_acceleration_m_per_s2: c.motion.figures().pga_m_per_s2,
            quantities: each(&c.compared, |Compared { pair, metrics: m, .. }| {
                let figures = |of: &[Metric]| {
                    Members(each(of, |figure| (figure.key, (figure.value)(m))))
                };
                // Where tables have the mean of Anderson's scores stand all of them.
                let all = &Metrics::ALL;
                let scores = all.iter().take_while(|figure| figure.key != Metrics::ANDERSON).count();
                view! {
                    quantity: pair.channel.name(),
                    unit: pair.channel.dimension().si_unit(),
                    origin: &pair.origin,
                    samples: pair.times_s.len(),
                    samples_not_interpolated: pair.at_samples,
                    from_s: pair.times_s.first(),
                    to_s: pair.times_s.last(),
                    #[serde(flatten)] figures: figures(&all[..scores]),
                    anderson_whole_band: m.anderson.map(|a| {
                        Members(a.scores().into_iter().chain([("mean", a.mean())]).collect())
                    }),
                    #[serde(flatten)] lag: figures(&all[scores + 1..]),
                }
            }),
            within: each(self.within, |bound| {
                let value = self.value(bound);
                view! {
                    bound: bound.name(),
                    least: bound.least,
                    most: bound.most,
                    value,
                    holds: bound.holds(value),
                }
            }),
        }
    }

    /// How near the prediction is, quantity by quantity, and whether the bounds are kept.
    #[must_use]
    pub fn verdict(&self) -> Vec<String> {
        let of = |c: &Compared| {
            let unit = self.unit(c);
            let m = &c.metrics;
            let peak = |si: f64| typeset(&significant(unit.of(si), 4));
            format!(
                "{}: predicted peak {} {}, measured {} {}; RMS error {}.",
                title(c.pair.channel),
                peak(m.predicted_peak),
                unit.symbol,
                peak(m.measured_peak),
                unit.symbol,
                m.normalised_rms_error.map_or("n/a".to_owned(), |error| format!(
                    "{} % of the RMS measured",
                    significant(100.0 * error, 3)
                ))
            )
        };
        // What slides comes first.
        let mut all: Vec<&Compared> = self.comparison.compared.iter().collect();
        all.sort_by_key(|c| c.pair.channel != Channel::SlidingDisplacement);
        let mut verdict: Vec<String> = all.into_iter().take(3).map(of).collect();
        if !self.within.is_empty() {
            let (missed, of) = (self.missed().len(), self.within.len());
            verdict.insert(
                0,
                match (missed, of) {
                    (0, 1) => "The bound is kept.".to_owned(),
                    (0, 2) => "Both bounds are kept.".to_owned(),
                    (0, _) => format!("All {of} bounds are kept."),
                    (_, 1) => "The bound is missed.".to_owned(),
                    (1, _) => format!("1 of {of} bounds is missed."),
                    (n, _) => format!("{n} of {of} bounds are missed."),
                },
            );
        }
        verdict
    }

    /// Anderson's scores, a column a quantity; none where no acceleration was compared.
    fn anderson(&self) -> Option<Vec<Vec<String>>> {
        let compared = self.comparison.compared.iter();
        let scored = compared.filter_map(|c| Some((title(c.pair.channel), c.metrics.anderson?)));
        let scored: Vec<_> = scored.collect();
        let (_, first) = scored.first()?;
        let heads = scored.iter().map(|(name, _)| name.clone());
        let row = |(i, (name, _)): (usize, &(&str, f64))| {
            let cells = scored.iter().map(|(_, a)| format!("{:.1}", a.scores()[i].1));
            core::iter::once(in_words(name)).chain(cells).collect()
        };
        let heads = core::iter::once(String::new()).chain(heads).collect();
        Some(core::iter::once(heads).chain(first.scores().iter().enumerate().map(row)).collect())
    }

    /// The overlays: accelerations with that of the table, then displacements and forces.
    #[must_use]
    pub fn figures(&self) -> Vec<Drawn> {
        let c = self.comparison;
        let panels: Vec<Panel> = c.compared.iter().map(|compared| self.panel(compared)).collect();
        let shaded = sliding(c);
        let of = |id: &'static str, title: &str, caption: String, panels: Vec<Panel>| {
            let figure = Figure {
                id: id.to_owned(),
                title: title.to_owned(),
                description: caption.clone(),
                layout: Layout::Stacked,
                panels,
                shaded: shaded.clone(),
            };
            Drawn::new(figure, caption)
        };
        let is_acceleration =
            |i: usize| c.compared[i].pair.channel.dimension() == Dimension::Acceleration;
        let (mut accelerations, mut others) = (Vec::new(), Vec::new());
        for (i, panel) in panels.into_iter().enumerate() {
            if is_acceleration(i) { accelerations.push(panel) } else { others.push(panel) }
        }
        let mut figures = Vec::new();
        let grey = "Grey: the predicted block slides.";
        if !accelerations.is_empty() {
            let caption = format!(
                "Total accelerations, measured (wide) and predicted (thin), with that of the table \
                 (light). {grey}"
            );
            figures.push(of("accelerations", "Accelerations over time", caption, accelerations));
        }
        if !others.is_empty() {
            let caption = format!(
                "Measured (wide) and predicted (thin). The sliding displacement is block minus \
                 table, storey displacements are relative to the block. {grey}"
            );
            figures.push(of("displacements", "Displacements over time", caption, others));
        }
        figures
    }

    fn panel(&self, compared: &Compared) -> Panel {
        let pair = &compared.pair;
        let unit = self.unit(compared);
        let points = |times_s: &[f64], values: &[f64]| -> Vec<[f64; 2]> {
            times_s.iter().zip(values).map(|(t, v)| [*t, unit.of(*v)]).collect()
        };
        let mut series = Vec::new();
        let motion = &self.comparison.motion;
        if pair.channel.dimension() == Dimension::Acceleration {
            let table = points(motion.times_s(), motion.horizontal_m_per_s2());
            series.push(over_x("table", TABLE, table));
        }
        series.push(over_x(MEASURED.label, MEASURED.style, points(&pair.times_s, &pair.measured)));
        series.push(over_x(
            PREDICTED.label,
            PREDICTED.style,
            points(&pair.times_s, &pair.predicted),
        ));
        let values: Vec<f64> = series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).collect();
        let note = compared
            .metrics
            .peak_ratio
            .map_or(String::new(), |ratio| format!("peak ratio {}", significant(ratio, 3)));
        let along = Axis::linear(TIME.alone(Unit::SECOND), 0.0, motion.duration_s());
        let upwards = Axis::covering(unit.label(&title(pair.channel)), values);
        Panel { note, ..panel(along, upwards, 120.0, series) }
    }
}

/// Intervals in which the predicted block slides.
fn sliding(comparison: &Comparison) -> Vec<[f64; 2]> {
    let Some(history) = &comparison.response.history else { return Vec::new() };
    let mut intervals: Vec<[f64; 2]> = Vec::new();
    let sliders = history.mode.iter().step_by(history.interfaces);
    for (times, mode) in history.time_s.windows(2).zip(sliders) {
        if *mode == Mode::Stick || times[1] <= times[0] {
            continue;
        }
        match intervals.last_mut() {
            Some(last) if last[1] == times[0] => last[1] = times[1],
            _ => intervals.push([times[0], times[1]]),
        }
    }
    intervals
}
