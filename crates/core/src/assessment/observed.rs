//! Fragilities from tables: stripes, capacities, or runs of an analysis or a study.

use super::censored::Known;
use super::fragility::{Capacity, CloudPoint, Fragility, Stripe};
use super::ida::Curve;
use super::{AssessmentError, ChoiceError, refuse};
use crate::error::{CellError, similar};
use crate::motion::intensity::Measure;
use crate::response::Warning;
use crate::table::{Cells, Column, Table};

/// What a curve is fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitTo {
    /// Counts of exceedances at levels.
    Counts,
    /// The first crossing of each record.
    Capacities,
    /// All runs, by regression.
    Cloud,
}

/// A fragility to be fitted.
#[derive(Clone, Copy, Debug)]
pub struct FragilityRequest<'a> {
    /// The table: stripes (`level`, `runs`, `exceeded`), capacities (`capacity`, `reached`), or runs
    /// (`level`, the demand, perhaps `record`).
    pub table: &'a Table,
    /// What errors call the table.
    pub source_name: &'a str,
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on it, SI; needed where runs are given.
    pub limit: Option<f64>,
    /// The measure, where it is not that of the levels.
    pub measure: Option<&'a str>,
    /// What to fit; by the kind of data where `None`.
    pub fit_to: Option<FitTo>,
    /// Demands below it count as below it only, in a cloud; SI.
    pub floor: Option<f64>,
    /// Demands above it count as above it only, in a cloud; SI.
    pub cap: Option<f64>,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct FragilityRun {
    /// The data that the curve was fitted to.
    pub data: Data,
    /// What the table held: `stripes`, `capacities` or `runs`.
    pub kind: &'static str,
    /// The fit.
    pub fragility: Fragility,
    /// Name of the measure.
    pub measure: String,
    /// Its SI unit.
    pub measure_unit: String,
    /// Choices that were made.
    pub warnings: Vec<Warning>,
}

/// What a curve was fitted to.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// Counts of exceedances at levels.
    Stripes(Vec<Stripe>),
    /// Levels at which records reach the limit.
    Capacities(Vec<Capacity>),
    /// Intensities and demands of single runs.
    Cloud(Vec<CloudPoint>),
}

/// Fits a fragility to the data of a table.
///
/// # Errors
/// [`AssessmentError`] for a table that lacks a column or has a cell that is no number, and for data
/// that cannot tell a curve.
pub fn run_fragility(request: &FragilityRequest<'_>) -> Result<FragilityRun, AssessmentError> {
    let columns = Columns { table: request.table, source_name: request.source_name };
    let (measure, measure_unit, level) = level_column(request, columns)?;
    let mut warnings = Vec::new();
    let (data, kind) = if columns.has("runs") && columns.has("exceeded") {
        (Data::Stripes(stripes(columns, &level)?), "stripes")
    } else if columns.has("capacity") && columns.has("reached") {
        (Data::Capacities(capacities(columns)?), "capacities")
    } else {
        (of_runs(request, columns, &level, &mut warnings)?, "runs")
    };
    let fragility = match &data {
        Data::Stripes(stripes) => Fragility::of_stripes(stripes),
        Data::Capacities(capacities) => Fragility::of_capacities(capacities),
        Data::Cloud(points) => Fragility::of_cloud(points, request.limit.unwrap_or(f64::NAN)),
    };
    let unit = measure_unit.clone();
    let fragility = fragility.map_err(|error| AssessmentError::Fragility { error, unit })?;
    Ok(FragilityRun { data, kind, fragility, measure, measure_unit, warnings })
}

/// Name and unit of the measure, and the column of intensities.
fn level_column(
    request: &FragilityRequest<'_>,
    columns: Columns<'_>,
) -> Result<(String, String, String), AssessmentError> {
    let levels =
        if columns.has("capacity") && !columns.has("level") { "capacity" } else { "level" };
    let said = columns.first_text("measure");
    let unit = |name: &str, column: &str| {
        let of_measure = Measure::parse(name).map(|measure| measure.unit().to_owned());
        of_measure.unwrap_or_else(|_| columns.unit(column))
    };
    let Some(asked) = request.measure else {
        if !columns.has(levels) {
            return Err(columns.lacking("measure", levels));
        }
        let name = said.unwrap_or_else(|| "level".to_owned());
        let unit = unit(&name, levels);
        return Ok((name, unit, levels.to_owned()));
    };
    let parsed = Measure::parse(asked).ok();
    let same = |said: &String| {
        *said == asked || parsed.is_some_and(|parsed| Measure::parse(said).ok() == Some(parsed))
    };
    if said.as_ref().is_some_and(same) && columns.has(levels) {
        return Ok((asked.to_owned(), unit(asked, levels), levels.to_owned()));
    }
    let candidates = [Some(asked.to_owned()), parsed.map(|measure| measure.column())];
    for column in candidates.into_iter().flatten() {
        if columns.has(&column) {
            let unit = unit(asked, &column);
            let column =
                if same_values(columns, levels, &column) { levels.to_owned() } else { column };
            return Ok((asked.to_owned(), unit, column));
        }
    }
    if said.is_none() && columns.has(levels) && parsed.is_some() {
        // A table of levels that does not say of what: the option does.
        return Ok((asked.to_owned(), unit(asked, levels), levels.to_owned()));
    }
    let column = parsed.map_or_else(|| asked.to_owned(), |measure| measure.column());
    Err(columns.lacking("measure", &column))
}

/// Whether records were scaled to levels of a column's measure: its values are those of the levels, but
/// for the rounding of each record's factor, which would take the levels apart.
fn same_values(columns: Columns<'_>, levels: &str, column: &str) -> bool {
    let numbers = |name: &str| columns.numbers_or_nan(name).unwrap_or_default();
    let (levels, values) = (numbers(levels), numbers(column));
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * b.abs();
    !levels.is_empty() && levels.len() == values.len() && levels.iter().zip(&values).all(near)
}

fn stripes(columns: Columns<'_>, level: &str) -> Result<Vec<Stripe>, AssessmentError> {
    let levels = columns.numbers(level)?;
    let runs = columns.counts("runs")?;
    let exceeded = columns.counts("exceeded")?;
    let rows = levels.into_iter().zip(runs).zip(exceeded);
    Ok(rows.map(|((level, runs), exceeded)| Stripe { level, runs, exceeded }).collect())
}

fn capacities(columns: Columns<'_>) -> Result<Vec<Capacity>, AssessmentError> {
    let levels = columns.numbers("capacity")?;
    let reached = columns.numbers("reached")?;
    Ok(levels
        .into_iter()
        .zip(reached)
        .map(|(level, reached)| Capacity { level, reached: reached != 0.0 })
        .collect())
}

/// Data from single runs: a level and a demand each.
fn of_runs(
    request: &FragilityRequest<'_>,
    columns: Columns<'_>,
    level: &str,
    warnings: &mut Vec<Warning>,
) -> Result<Data, AssessmentError> {
    if !columns.has(request.demand) {
        return Err(columns.lacking("demand", request.demand));
    }
    let Some(limit) = request.limit else {
        return Err(refuse("limit", "a limit on the demand, such as \"150 mm\"", "nothing"));
    };
    let levels = columns.numbers(level)?;
    let demands: Vec<f64> =
        columns.numbers_or_nan(request.demand)?.into_iter().map(f64::abs).collect();
    let records = columns.table.texts_of("record");
    let fit_to = request.fit_to.unwrap_or_else(|| natural(&levels, records));
    let mut warn = |kind, message| warnings.push(Warning { kind, time_s: None, message });
    if request.fit_to.is_none() {
        let name = match fit_to {
            FitTo::Counts => "counts at the levels, which the records share",
            FitTo::Capacities => "the first crossing of each record, whose levels differ",
            FitTo::Cloud => "all runs by regression, since no level is shared",
        };
        warn("fitted_to", format!("fitted to {name}"));
    }
    if fit_to == FitTo::Capacities {
        let Some(records) = records else { return Err(columns.lacking("fit-to", "record")) };
        return Ok(Data::Capacities(crossings(records, &levels, &demands, limit)));
    }
    let failed = demands.iter().filter(|demand| demand.is_nan()).count();
    if failed > 0 {
        warn(
            "failed_runs",
            format!("{failed} of {} runs have no demand and are left out", demands.len()),
        );
    }
    let runs = levels.into_iter().zip(demands).filter(|(_, demand)| !demand.is_nan());
    if fit_to == FitTo::Counts {
        let mut stripes: Vec<Stripe> = Vec::new();
        for (level, demand) in runs {
            let beyond = u64::from(demand > limit);
            match stripes.iter_mut().find(|stripe| stripe.level == level) {
                Some(stripe) => {
                    stripe.runs += 1;
                    stripe.exceeded += beyond;
                }
                None => stripes.push(Stripe { level, runs: 1, exceeded: beyond }),
            }
        }
        stripes.sort_by(|a, b| a.level.total_cmp(&b.level));
        return Ok(Data::Stripes(stripes));
    }
    let floor = request.floor.unwrap_or(0.0);
    let mut points = Vec::new();
    for (level, demand) in runs {
        let (demand, known) = match request.cap {
            Some(cap) if demand > cap => (cap, Known::AtLeast),
            _ if demand < floor => (floor, Known::AtMost),
            _ if demand == 0.0 => {
                let expected = "a floor for the runs in which nothing moves, such as \"1 mm\"";
                return Err(refuse("floor", expected, "a demand of 0, which has no logarithm"));
            }
            _ => (demand, Known::Exactly),
        };
        points.push(CloudPoint { level, demand, known });
    }
    Ok(Data::Cloud(points))
}

/// What runs are best fitted to: counts where levels are shared, first crossings where each record
/// has several levels of its own, else regression.
fn natural(levels: &[f64], records: Option<&[String]>) -> FitTo {
    let mut sorted = levels.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    if 2 * sorted.len() <= levels.len() {
        return FitTo::Counts;
    }
    let distinct = records.map_or(levels.len(), |records| {
        let mut names: Vec<&String> = records.iter().collect();
        names.sort();
        names.dedup();
        names.len()
    });
    if 2 * distinct <= levels.len() { FitTo::Capacities } else { FitTo::Cloud }
}

/// The first crossing of each record's curve.
fn crossings(records: &[String], levels: &[f64], demands: &[f64], limit: f64) -> Vec<Capacity> {
    let mut curves: Vec<(&String, Curve)> = Vec::new();
    for ((record, level), demand) in records.iter().zip(levels).zip(demands) {
        match curves.iter_mut().find(|(name, _)| *name == record) {
            Some((_, curve)) => curve.insert(*level, *demand),
            None => {
                let curve = Curve { levels: vec![*level], demands: vec![*demand] };
                curves.push((record, curve));
            }
        }
    }
    let capacity = |(_, curve): &(&String, Curve)| {
        let crossing = curve.first_crossing(limit);
        Capacity { level: crossing.level, reached: crossing.reached }
    };
    curves.iter().map(capacity).collect()
}

/// A table whose columns are asked for by name.
#[derive(Clone, Copy)]
struct Columns<'a> {
    table: &'a Table,
    source_name: &'a str,
}

impl Columns<'_> {
    fn has(self, name: &str) -> bool {
        self.table.find(name).is_some()
    }

    /// The unit of a column, where the table says it.
    fn unit(self, name: &str) -> String {
        self.table.find(name).map_or_else(String::new, |column| column.unit.clone())
    }

    /// The error for a column that is not there, with the nearest that is.
    fn lacking(self, what: &str, name: &str) -> AssessmentError {
        let names = self.table.columns.iter().map(|column| column.name.as_str());
        AssessmentError::Choice(ChoiceError {
            what: what.to_owned(),
            expected: format!("a column of {}", self.source_name),
            found: format!("{name:?}"),
            nearest: similar(name, names),
        })
    }

    /// The first cell of a column of texts.
    fn first_text(self, name: &str) -> Option<String> {
        self.table.texts_of(name)?.first().filter(|text| !text.is_empty()).cloned()
    }

    /// A column of numbers, none of them missing.
    fn numbers(self, name: &str) -> Result<Vec<f64>, AssessmentError> {
        let values = self.numbers_or_nan(name)?;
        match values.iter().position(|value| value.is_nan()) {
            None => Ok(values),
            Some(row) => Err(not_a_number(row, name, "nothing".to_owned())),
        }
    }

    /// A column of numbers, written as such or as texts; NaN where a cell is empty.
    fn numbers_or_nan(self, name: &str) -> Result<Vec<f64>, AssessmentError> {
        let texts = match self.table.find(name) {
            None => return Err(self.lacking("SOURCE", name)),
            Some(Column { cells: Cells::Texts(texts), .. }) => texts,
            Some(column) => return Ok(column.cells.to_numbers().unwrap_or_default()),
        };
        let number = |(row, text): (usize, &String)| match text.trim() {
            "" => Ok(f64::NAN),
            "true" => Ok(1.0),
            "false" => Ok(0.0),
            text => text.parse::<f64>().ok().filter(|v| !v.is_nan()).ok_or_else(|| {
                let shown: String = text.chars().take(40).collect();
                not_a_number(row, name, format!("{shown:?}"))
            }),
        };
        texts.iter().enumerate().map(number).collect()
    }

    /// A column of whole numbers ≥ 0.
    fn counts(self, name: &str) -> Result<Vec<u64>, AssessmentError> {
        let whole = |value: f64| {
            if (0.0..1e15).contains(&value) && value.fract() == 0.0 {
                return Ok(value as u64);
            }
            Err(refuse(name, "whole numbers ≥ 0", value.to_string()))
        };
        self.numbers(name)?.into_iter().map(whole).collect()
    }
}

fn not_a_number(row: usize, name: &str, found: String) -> AssessmentError {
    let expected = format!("a number in {name}");
    AssessmentError::Cell(CellError { row, column: name.to_owned(), expected, found })
}
