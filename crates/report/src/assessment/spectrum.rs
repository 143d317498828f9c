//! Sliding spectra and frequency response curves.

use serde::Serialize;
use slipstick::assessment::spectrum::{CurveOf, DemandCurves, SpectrumRun};
use slipstick::notice::Notice;
use slipstick::study::travel_used_up;

use super::key::{path_label, path_words, quantity, title};
use super::lines::{BAND, FRACTILES, RECORD, band, group_style, line, panel, share_names, stacked};
use super::sheet::{Sheet, cell, counted_as, failed};
use crate::display::{DisplayUnits, Unit};
use crate::json::{each, pretty};
use crate::number::compact;
use crate::plot::{Axis, Limit, Panel, PlotSeries, Style};
use crate::view;

/// What a spectrum is told from.
#[derive(Clone, Debug)]
pub struct SpectrumReport<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// What came of it.
    pub run: &'a SpectrumRun,
    /// Names of the records; of a made motion, its description alone.
    pub records: &'a [String],
    /// How the records were scaled, in words.
    pub scaled: &'a str,
    /// What reading the records gave notice of.
    pub warnings: &'a [Notice],
    /// Units to show results in.
    pub display: DisplayUnits,
}

/// Names of the groups of a spectrum, such as `kinetic friction 0.05`; an empty one where nothing
/// makes groups.
fn group_names(run: &SpectrumRun) -> Vec<String> {
    let name = |values: &Vec<f64>| {
        let of = |((path, unit), value): (&(String, String), &f64)| {
            format!("{} {} {unit}", short(path), compact(*value)).trim_end().to_owned()
        };
        run.group_paths.iter().zip(values).map(of).collect::<Vec<_>>().join(", ")
    };
    let names = run.groups.iter().map(name);
    if run.group_bounds.is_empty() {
        return names.collect();
    }
    let of_bound = |(name, bound): (String, &&str)| match name.as_str() {
        "" => format!("{bound} friction"),
        name => format!("{name}, {bound} friction"),
    };
    names.zip(&run.group_bounds).map(of_bound).collect()
}

/// The last word of a path, which says enough in a legend.
fn short(path: &str) -> String {
    path.rsplit('.').next().unwrap_or(path).replace('_', " ")
}

impl<'s> SpectrumReport<'s> {
    fn groups(&self) -> Vec<String> {
        group_names(self.run)
    }

    /// The result laid out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let count = self.records.len();
        let records = match self.records {
            [one] => one.clone(),
            _ => format!("{count} records"),
        };
        Sheet {
            kind: "Sliding spectra",
            name: self.name.to_owned(),
            line: format!("{} runs: {records}{}", self.run.runs, self.scaled),
            display: self.display,
            verdict: self.verdict(),
            warnings: failed(
                &self.run.failures,
                self.run.runs as u64,
                &counted_as(&self.run.failures),
            )
            .into_iter()
            .chain(self.run.warnings.iter().chain(self.warnings).cloned())
            .collect(),
            complete: self.run.failures.is_empty(),
            tables: self.tables(),
            notes: self.notes(),
            figures: self.run.curves.iter().map(|curves| self.figure(curves)).collect(),
            method: self.method(),
            json: pretty(&self.json()),
            ..Sheet::default()
        }
    }

    /// Where along the axis the first demand is least and greatest.
    fn verdict(&self) -> Vec<String> {
        let of = |curves: &DemandCurves| {
            let unit = self.unit_of(curves);
            let all = curves.fractiles.iter().flat_map(|group| {
                group.iter().zip(&self.run.values).map(|(f, at)| (f[MEDIAN], *at))
            });
            let finite: Vec<(f64, f64)> = all.filter(|(value, _)| value.is_finite()).collect();
            let least = finite.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0))?;
            let most = finite.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0))?;
            let median = if self.records.len() > 1 { "Median " } else { "" };
            let what = title(&curves.of.name());
            let what = if median.is_empty() { what } else { what.to_lowercase() };
            let at = |x: f64| format!("{} {}", compact(x), self.run.unit).trim_end().to_owned();
            Some(format!(
                "{median}{what}: {} {} at {} to {} {} at {}.",
                cell(unit.of(least.0)),
                unit.symbol,
                at(least.1),
                cell(unit.of(most.0)),
                unit.symbol,
                at(most.1)
            ))
        };
        self.run.curves.first().and_then(of).into_iter().collect()
    }

    /// At most this many rows of a table: the ends and what lies evenly between.
    fn shown(&self) -> Vec<usize> {
        const ROWS: usize = 13;
        let n = self.run.values.len();
        if n <= ROWS {
            return (0..n).collect();
        }
        let mut shown: Vec<usize> =
            (0..ROWS).map(|i| (i * (n - 1) + (ROWS - 1) / 2) / (ROWS - 1)).collect();
        shown.dedup();
        shown
    }

    fn unit_of(&self, curves: &DemandCurves) -> Unit {
        let largest = curves.fractiles.iter().flatten().map(|f| f[2]).filter(|v| v.is_finite());
        self.display.unit(quantity(&curves.of.name()), largest.fold(0.0, f64::max))
    }

    fn axis_label(&self) -> String {
        path_label(&self.run.over, &self.run.unit)
    }

    /// One group: a table a demand with its fractiles, or of a single motion three demands a table.
    /// Several groups: a table a demand with their medians.
    fn tables(&self) -> Vec<(String, Vec<Vec<String>>)> {
        let (single, many) = (self.records.len() == 1, self.groups().len() > 1);
        let named = |curves: &DemandCurves| self.unit_of(curves).label(&title(&curves.of.name()));
        let column = |head: String, curves, group, which| Column { head, curves, group, which };
        let tables: Vec<(String, Vec<Column>)> = if many {
            let of = |curves: &'s DemandCurves| {
                let of_group =
                    |(g, name): (usize, &String)| column(name.clone(), curves, g, MEDIAN);
                let after = if single { "" } else { ", median" };
                let columns = self.groups().iter().enumerate().map(of_group).collect();
                (format!("{}{after}", named(curves)), columns)
            };
            self.run.curves.iter().map(of).collect()
        } else if single {
            let of = |part: &'s [DemandCurves]| {
                let columns = part.iter().map(|curves| column(named(curves), curves, 0, MEDIAN));
                ("Demands".to_owned(), columns.collect())
            };
            self.run.curves.chunks(3).map(of).collect()
        } else {
            let of = |curves: &'s DemandCurves| {
                let names = share_names().into_iter().enumerate();
                let columns = names.map(|(which, name)| column(name, curves, 0, which)).collect();
                (named(curves), columns)
            };
            self.run.curves.iter().map(of).collect()
        };
        let table = |(heading, columns): (String, Vec<Column>)| {
            let heads = columns.iter().map(|column| column.head.clone());
            let heads = std::iter::once(self.axis_label()).chain(heads).collect();
            let row = |&i: &usize| {
                let number = |c: &Column| {
                    cell(self.unit_of(c.curves).of(c.curves.fractiles[c.group][i][c.which]))
                };
                std::iter::once(compact(self.run.values[i]))
                    .chain(columns.iter().map(number))
                    .collect()
            };
            let rows = std::iter::once(heads).chain(self.shown().iter().map(row)).collect();
            (heading, rows)
        };
        tables.into_iter().map(table).collect()
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.shown().len() < self.run.values.len() {
            notes.push(format!(
                "{} of {} values along the axis are shown; all, with all fractiles, are in spectrum.csv.",
                self.shown().len(),
                self.run.values.len()
            ));
        }
        let amplification = title(&self.amplification());
        for (name, windows) in self.groups().iter().zip(&self.run.windows) {
            let of = |[from, to]: &[f64; 2]| {
                format!("{} to {} {}", cell(*from), cell(*to), self.run.unit)
            };
            let list: Vec<String> = windows.iter().map(of).collect();
            let where_ =
                if list.is_empty() { "nowhere in the range".to_owned() } else { list.join(", ") };
            let group = if name.is_empty() { String::new() } else { format!(" ({name})") };
            notes.push(format!("{amplification} is above 1{group}: {}.", where_.trim_end()));
        }
        notes
    }

    fn figure(&self, curves: &DemandCurves) -> crate::figures::Drawn {
        let unit = self.unit_of(curves);
        let x = &self.run.values[..];
        let ends = (x.first().copied().unwrap_or(0.0), x.last().copied().unwrap_or(1.0));
        // Values at equal ratios, or over more than a decade, want a logarithmic axis.
        let logarithmic = ends.0 > 0.0 && ends.1 / ends.0 >= 12.0;
        let x_axis = if logarithmic {
            Axis::logarithmic(self.axis_label(), ends.0, ends.1)
        } else {
            Axis::linear(self.axis_label(), ends.0, ends.1)
        };
        let of = |group: usize, which: usize| -> Vec<f64> {
            curves.fractiles[group].iter().map(|f| unit.of(f[which])).collect()
        };
        let points = |values: &[f64]| -> Vec<[f64; 2]> {
            x.iter().zip(values).map(|(&x, &y)| [x, y]).collect()
        };
        let (many, single) = (self.groups().len() > 1, self.records.len() == 1);
        let mut series: Vec<PlotSeries> = Vec::new();
        if !single && !many {
            series.push(band(x, &of(0, 0), &of(0, 2), "16 to 84 %", BAND));
            // Of a long suite the curves of single records would be a grey field.
            for (i, single) in curves.singles[0].iter().take(MOST_SINGLES).enumerate() {
                let values: Vec<f64> = single.iter().map(|value| unit.of(*value)).collect();
                let label = if i == 0 { "record" } else { "" };
                series.push(line(label, RECORD, finite(points(&values))));
            }
        }
        for (group, name) in self.groups().iter().enumerate() {
            let style = if many { group_style(group) } else { FRACTILES[1] };
            if many && !single {
                for which in [0, 2] {
                    let thin = Style { width: 0.6, ..style };
                    series.push(line("", thin, points(&of(group, which))));
                }
            }
            let label = if many {
                name.clone()
            } else if single {
                String::new()
            } else {
                share_names()[1].clone()
            };
            series.push(line(label, style, points(&of(group, 1))));
        }
        let values = series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).collect::<Vec<_>>();
        let limits = match curves.of {
            CurveOf::Demand(_) => Vec::new(),
            _ => vec![Limit { value: 1.0, label: "1".to_owned(), style: Style::LIMIT }],
        };
        let what = title(&curves.of.name());
        let y_axis = Axis::from_zero(unit.label(&what), values);
        let panel = Panel { limits, ..panel(x_axis, y_axis, 210.0, series) };
        let spread = match (single, many) {
            (true, _) => String::new(),
            (false, true) => {
                " Thick: median over the records; thin, in the same dashes: 16 and 84 %.".to_owned()
            }
            (false, false) => {
                let count = self.records.len();
                let singles = match count > MOST_SINGLES {
                    true => format!("the first {MOST_SINGLES} of {count} records"),
                    false => "single records".to_owned(),
                };
                format!(
                    " Thick line: median over the records; band: 16 to 84 %; thin lines: {singles}."
                )
            }
        };
        let caption = format!("{what} over {}.{spread}", path_words(&self.run.over));
        stacked(&self.figure_id(curves), &what, caption, vec![panel])
    }

    /// The identifier of a figure: a word for what is always told, the name of a demand that is asked for.
    fn figure_id(&self, curves: &DemandCurves) -> String {
        let is_of_roof =
            |demand| self.run.curves.iter().any(|other| other.of == CurveOf::Amplification(demand));
        let word = match curves.of {
            CurveOf::FixedBaseRatio(_) => "fixed-base-ratio",
            CurveOf::Amplification(_) => "amplification",
            CurveOf::Demand(demand) => match demand.name().as_str() {
                "peak_sliding_displacement_m" => "displacement",
                "residual_sliding_displacement_m" => "residual",
                "sliding_path_m" => "path",
                _ if is_of_roof(demand) => "acceleration",
                name => return name.replace(['_', '.'], "-"),
            },
        };
        word.to_owned()
    }

    /// The name of the curve whose windows above 1 are told: the last.
    fn amplification(&self) -> String {
        self.run.curves.last().map(|curves| curves.of.name()).unwrap_or_default()
    }

    fn method(&self) -> Vec<String> {
        let mut method = vec![
            "Every run is an exact analysis of its own; no value of one is taken from another."
                .to_owned(),
        ];
        if self.records.len() > 1 {
            method.push(
                "Fractiles interpolate linearly between the sorted values of the suite, at position \
                 p (n − 1) counted from 0; a failed run counts as above all."
                    .to_owned(),
            );
        }
        method.push(
            "The residual sliding displacement is taken without its sign. The fixed-base ratio is the \
             storey's peak total acceleration over that of the same structure held to the table; the \
             amplification is over the peak of the table."
                .to_owned(),
        );
        method
    }

    fn json(&self) -> impl Serialize {
        let groups = self.groups();
        let curves = self.run.curves.iter().flat_map(|curves| {
            let demand = curves.of.name();
            each(groups.iter().zip(&curves.fractiles), |(group, fractiles)| {
                let pick = |i: usize| each(fractiles, |f| f[i]);
                view! {
                    demand: demand.clone(),
                    group: group.clone(),
                    p16: pick(0),
                    p50: pick(1),
                    p84: pick(2),
                }
            })
        });
        view! {
            model: self.name,
            over: &self.run.over,
            unit: &self.run.unit,
            values: &self.run.values,
            groups: groups.clone(),
            records: self.records,
            runs: self.run.runs,
            failed: self.run.failures.len(),
            used_up_travel: travel_used_up(&self.run.failures),
            curves: curves.collect::<Vec<_>>(),
            windows: each(groups.iter().zip(&self.run.windows), |(group, above_1)| {
                view! { demand: self.amplification(), group: group.clone(), above_1 }
            }),
        }
    }
}

/// Most curves of single records in a figure.
const MOST_SINGLES: usize = 60;

/// Points up to the first that is not finite.
fn finite(points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.into_iter().take_while(|point| point[1].is_finite()).collect()
}

/// A column of a table: its head, and which fractile of which group it is.
struct Column<'a> {
    head: String,
    curves: &'a DemandCurves,
    group: usize,
    which: usize,
}

/// The median among the three fractiles.
const MEDIAN: usize = 1;
