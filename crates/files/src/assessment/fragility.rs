//! Fragilities from files: stripes, capacities, runs of an analysis, or the folder of a study.

use std::path::{Path, PathBuf};

use slipstick::assessment::censored::Known;
use slipstick::assessment::fragility::{Capacity, CloudPoint, Fragility, Stripe};
use slipstick::assessment::ida::Curve;
use slipstick::motion::intensity::Measure;
use slipstick::response::Warning;
use slipstick_report::assessment::fragility::Data;

use super::columns::Columns;
use super::{AssessmentError, refuse};
use crate::read::{read_bytes, sha256_hex};

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
    /// A CSV or Parquet file, or the folder of a study.
    pub source: &'a Path,
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
    /// The data.
    pub data: Data,
    /// The fit.
    pub fragility: Fragility,
    /// Name of the measure.
    pub measure: String,
    /// Its SI unit.
    pub measure_unit: String,
    /// Choices that were made.
    pub warnings: Vec<Warning>,
    /// Files read: path, SHA-256, what they are.
    pub sources: Vec<(String, String, String)>,
}

/// Fits a fragility to a file's data.
///
/// # Errors
/// [`AssessmentError`] for a file that cannot be read, lacks a column or has a cell that is no number,
/// and for data that cannot tell a curve.
pub fn run_fragility(request: &FragilityRequest) -> Result<FragilityRun, AssessmentError> {
    let files = files(request.source)?;
    let mut sources = Vec::with_capacity(files.len());
    for path in &files {
        let sha256 = sha256_hex(&read_bytes(path)?);
        sources.push((path.display().to_string(), sha256, "runs".to_owned()));
    }
    let columns = Columns::read(&files)?;
    let (measure, measure_unit, level) = level_column(request, &columns)?;
    let mut warnings = Vec::new();
    let data = if columns.has("runs") && columns.has("exceeded") {
        sources[0].2 = "stripes".to_owned();
        Data::Stripes(stripes(&columns, &level)?)
    } else if columns.has("capacity") && columns.has("reached") {
        sources[0].2 = "capacities".to_owned();
        Data::Capacities(capacities(&columns)?)
    } else {
        of_runs(request, &columns, &level, &mut warnings)?
    };
    let fragility = match &data {
        Data::Stripes(stripes) => Fragility::of_stripes(stripes),
        Data::Capacities(capacities) => Fragility::of_capacities(capacities),
        Data::Cloud(points) => Fragility::of_cloud(points, request.limit.unwrap_or(f64::NAN)),
    };
    let unit = measure_unit.clone();
    let fragility = fragility.map_err(|error| AssessmentError::Fragility { error, unit })?;
    Ok(FragilityRun { data, fragility, measure, measure_unit, warnings, sources })
}

/// The parts of a study's folder, or the file itself.
fn files(source: &Path) -> Result<Vec<PathBuf>, AssessmentError> {
    if !source.is_dir() {
        return Ok(vec![source.to_owned()]);
    }
    match crate::globs::expand(source, "part-*.parquet") {
        Ok(files) => Ok(files),
        Err(_) => {
            let expected = "a file, or the folder of a study with its part-*.parquet";
            Err(refuse("SOURCE", expected, format!("the folder {}", source.display())))
        }
    }
}

/// Name and unit of the measure, and the column of intensities.
fn level_column(
    request: &FragilityRequest,
    columns: &Columns,
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
            return Err(columns.lacking("--measure", levels));
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
    Err(columns.lacking("--measure", &column))
}

/// Whether records were scaled to levels of a column's measure: its values are those of the levels, but
/// for the rounding of each record's factor, which would take the levels apart.
fn same_values(columns: &Columns, levels: &str, column: &str) -> bool {
    let numbers = |name: &str| columns.numbers_or_nan(name).unwrap_or_default();
    let (levels, values) = (numbers(levels), numbers(column));
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * b.abs();
    !levels.is_empty() && levels.len() == values.len() && levels.iter().zip(&values).all(near)
}

fn stripes(columns: &Columns, level: &str) -> Result<Vec<Stripe>, AssessmentError> {
    let levels = columns.numbers(level)?;
    let runs = columns.counts("runs")?;
    let exceeded = columns.counts("exceeded")?;
    let rows = levels.into_iter().zip(runs).zip(exceeded);
    Ok(rows.map(|((level, runs), exceeded)| Stripe { level, runs, exceeded }).collect())
}

fn capacities(columns: &Columns) -> Result<Vec<Capacity>, AssessmentError> {
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
    request: &FragilityRequest,
    columns: &Columns,
    level: &str,
    warnings: &mut Vec<Warning>,
) -> Result<Data, AssessmentError> {
    if !columns.has(request.demand) {
        return Err(columns.lacking("--demand", request.demand));
    }
    let Some(limit) = request.limit else {
        return Err(refuse("--limit", "a limit on the demand, such as \"150 mm\"", "nothing"));
    };
    let levels = columns.numbers(level)?;
    let demands: Vec<f64> =
        columns.numbers_or_nan(request.demand)?.into_iter().map(f64::abs).collect();
    let records = columns.texts("record");
    let fit_to = request.fit_to.unwrap_or_else(|| natural(&levels, records.as_deref()));
    let mut warn = |kind, message| warnings.push(Warning { kind, time_s: None, message });
    if request.fit_to.is_none() {
        let name = match fit_to {
            FitTo::Counts => "counts at the levels, which the records share",
            FitTo::Capacities => "the first crossing of each record, whose levels differ",
            FitTo::Cloud => "all runs by regression, since no level is shared",
        };
        warn("fitted_to", format!("fitted to {name}; --fit-to chooses otherwise"));
    }
    if fit_to == FitTo::Capacities {
        let Some(records) = records else { return Err(columns.lacking("--fit-to", "record")) };
        return Ok(Data::Capacities(crossings(&records, &levels, &demands, limit)));
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
                return Err(refuse("--floor", expected, "a demand of 0, which has no logarithm"));
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
