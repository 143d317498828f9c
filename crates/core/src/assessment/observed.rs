//! Fragilities from tables: stripes, capacities, or runs of an analysis or a study.

mod columns;
mod intensity;
mod rows;
mod runs;

use super::fragility::{Capacity, CloudPoint, Fragility, Stripe};
use super::{AssessmentError, refuse};
use crate::error::FitError;
use crate::notice::{Notice, NoticeKind};
use crate::study::Certified;
use crate::study::cases::{NOTICED, of_a_cell, of_runs, tally};
use crate::study::engine::Engine;
use crate::table::{Cells, Table};

use columns::Columns;
use intensity::Intensity;
pub use rows::{Averaged, FRICTION};

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
    /// (`level`, the demand, perhaps `record` and varied paths).
    pub table: &'a Table,
    /// What errors call the table.
    pub source_name: &'a str,
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on it, SI; needed where runs are given.
    pub limit: Option<f64>,
    /// The measure, where it is not that of the levels.
    pub measure: Option<&'a str>,
    /// Unit of the intensities, where the table does not state it.
    pub units: Option<&'a str>,
    /// What to fit; by the kind of data where `None`.
    pub fit_to: Option<FitTo>,
    /// Demands below it count as below it only, in a cloud; SI.
    pub floor: Option<f64>,
    /// Demands above it count as above it only, in a cloud; SI.
    pub cap: Option<f64>,
    /// Rows that are kept: `PATH=VALUE` or `PATH=FROM..TO`, all of them.
    pub keep: &'a [String],
    /// Intervals from draws of the records or pairs, so many with this seed, in place of the sandwich.
    pub bootstrap: Option<(u32, u64)>,
}

/// What a table of fragility data holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TableKind {
    /// Counts of exceedances at levels.
    Stripes,
    /// Levels at which records reach the limit.
    Capacities,
    /// Single runs, a row each.
    Runs,
}

impl TableKind {
    /// Its name, as the list of files read gives it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stripes => "stripes",
            Self::Capacities => "capacities",
            Self::Runs => "runs",
        }
    }
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct FragilityRun {
    /// The data that the curve was fitted to.
    pub data: Data,
    /// What the table held.
    pub kind: TableKind,
    /// Why it was fitted to those data.
    pub why: String,
    /// Designs that the curve averages over.
    pub averaged: Averaged,
    /// The fit.
    pub fragility: Fragility,
    /// What its certainty is clustered by where it is: `record`, or `pair` of the components of one.
    pub clustered_by: &'static str,
    /// Name of the measure.
    pub measure: String,
    /// Its SI unit.
    pub measure_unit: String,
    /// Choices that were made.
    pub warnings: Vec<Notice>,
}

/// The fragility of the rows in which a column has one value.
#[derive(Clone, Debug)]
pub struct FragilityGroup {
    /// The value, in SI; NaN of a text.
    pub value: f64,
    /// The value as a text of the table, empty for numbers.
    pub text: String,
    /// The fragility, or why there is none.
    pub run: Result<FragilityRun, FitError>,
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

/// Fewest records from which clustered intervals can be relied on.
const ENOUGH_RECORDS: usize = 10;

/// Fits a fragility to the data of a table.
///
/// # Errors
/// [`AssessmentError`] for a table that lacks a column, has a cell that is no number or does not state
/// the unit of its intensities, for data that cannot tell a curve, and where draws are stopped.
pub fn run_fragility(
    request: &FragilityRequest<'_>,
    engine: &Engine<'_>,
) -> Result<FragilityRun, AssessmentError> {
    let columns = Columns { table: request.table, source_name: request.source_name };
    let kept = rows::keep(columns, request.keep)?;
    let table = kept.as_ref().unwrap_or(request.table);
    fit(request, Columns { table, ..columns }, engine)
}

/// Fits a fragility to the rows of each value of a column; its unit in SI beside them.
///
/// # Errors
/// As [`run_fragility`], but that values whose data cannot tell a curve keep the reason; and for a
/// column with more values than a figure can show.
pub fn run_fragility_by(
    request: &FragilityRequest<'_>,
    by: &str,
    engine: &Engine<'_>,
) -> Result<(Vec<FragilityGroup>, String), AssessmentError> {
    let columns = Columns { table: request.table, source_name: request.source_name };
    let kept = rows::keep(columns, request.keep)?;
    let table = kept.as_ref().unwrap_or(request.table);
    let columns = Columns { table, ..columns };
    let (groups, unit) = rows::groups(columns, by)?;
    let mut found = Vec::with_capacity(groups.len());
    for rows::DesignGroup { value, text, rows } in groups {
        let table = table.select(&rows);
        let run = match fit(request, Columns { table: &table, ..columns }, engine) {
            Ok(run) => Ok(run),
            Err(AssessmentError::Fit(error) | AssessmentError::Fragility { error, .. }) => {
                Err(error)
            }
            Err(AssessmentError::Cell(error)) => {
                let row = rows.get(error.row).copied().unwrap_or(error.row);
                return Err(AssessmentError::Cell(crate::error::CellError { row, ..error }));
            }
            Err(error) => return Err(error),
        };
        found.push(FragilityGroup { value, text, run });
    }
    Ok((found, unit))
}

/// Designs, a row each, that an analysis is told apart by.
pub(super) struct DesignGroup {
    pub(super) value: f64,
    pub(super) text: String,
    /// Rows of the table.
    pub(super) designs: Vec<usize>,
    pub(super) averaged: Averaged,
}

/// The designs of a table that conditions keep, apart by the values of a column, and the SI unit of
/// those; one group without a column.
pub(super) fn design_groups(
    table: &Table,
    keep: &[String],
    by: Option<&str>,
) -> Result<(Vec<DesignGroup>, String), AssessmentError> {
    let columns = Columns { table, source_name: "what is varied" };
    let kept = rows::kept(columns, keep)?;
    let of_kept = table.select(&kept);
    let columns = Columns { table: &of_kept, ..columns };
    let (groups, unit) = match by {
        Some(by) => rows::groups(columns, by)?,
        None => {
            let rows = (0..kept.len()).collect();
            (vec![rows::DesignGroup { value: f64::NAN, text: String::new(), rows }], String::new())
        }
    };
    let group = |rows::DesignGroup { value, text, rows }: rows::DesignGroup| {
        let of_group = of_kept.select(&rows);
        let averaged = rows::averaged(Columns { table: &of_group, ..columns })?;
        let designs = rows.into_iter().map(|row| kept[row]).collect();
        Ok(DesignGroup { value, text, designs, averaged })
    };
    Ok((groups.into_iter().map(group).collect::<Result<_, AssessmentError>>()?, unit))
}

/// The column by which a table is taken apart where nothing else is asked for: the bounds of friction,
/// over which nobody averages; `None` where the rows that are kept know one at most.
///
/// # Errors
/// [`AssessmentError`] for conditions that cannot be understood.
pub fn usual_by(request: &FragilityRequest<'_>) -> Result<Option<&'static str>, AssessmentError> {
    let columns = Columns { table: request.table, source_name: request.source_name };
    let kept = rows::keep(columns, request.keep)?;
    let table = kept.as_ref().unwrap_or(request.table);
    let several = match table.find(rows::FRICTION).map(|column| &column.cells) {
        Some(Cells::Texts(texts)) => texts.iter().any(|text| *text != texts[0]),
        _ => false,
    };
    Ok(several.then_some(rows::FRICTION))
}

/// How many runs of a table were certified, where it says so in its column `holds`, of the rows that are kept.
///
/// # Errors
/// [`AssessmentError`] for conditions that cannot be understood.
pub fn certified(request: &FragilityRequest<'_>) -> Result<Option<Certified>, AssessmentError> {
    let columns = Columns { table: request.table, source_name: request.source_name };
    let kept = rows::keep(columns, request.keep)?;
    let columns = Columns { table: kept.as_ref().unwrap_or(request.table), ..columns };
    let Some(holds) = columns.holds() else { return Ok(None) };
    let status = |row| columns.text("status", row).filter(|status| *status != "ok");
    let mut certified = Certified::of(holds.len() as u64);
    for (row, holds) in holds.into_iter().enumerate().filter(|(_, holds)| !holds.is_nan()) {
        let said = || status(row).unwrap_or_default().to_owned();
        certified.add_judged(&columns.run(row), None, (holds == 0.0).then(said));
    }
    Ok(Some(certified))
}

/// What the runs of a table gave notice of, where its column `warnings` says it, of the rows that are kept: each kind
/// once, with the number of its runs and the first of them.
///
/// # Errors
/// [`AssessmentError`] for conditions that cannot be understood.
pub fn noticed(request: &FragilityRequest<'_>) -> Result<Vec<Notice>, AssessmentError> {
    let columns = Columns { table: request.table, source_name: request.source_name };
    let kept = rows::keep(columns, request.keep)?;
    let columns = Columns { table: kept.as_ref().unwrap_or(request.table), ..columns };
    let Some(cells) = columns.table.texts_of(NOTICED) else { return Ok(Vec::new()) };
    let mut kinds = Vec::new();
    for (row, cell) in cells.iter().enumerate() {
        of_a_cell(cell).for_each(|kind| tally(&mut kinds, &kind, row));
    }
    let told = |(kind, gave, row)| of_runs(kind, gave, cells.len(), &columns.run(row));
    Ok(kinds.into_iter().map(told).collect())
}

fn fit(
    request: &FragilityRequest<'_>,
    columns: Columns<'_>,
    engine: &Engine<'_>,
) -> Result<FragilityRun, AssessmentError> {
    let intensity = Intensity::of(request, columns)?;
    let mut warnings = Vec::new();
    let (clustered_by, clusters) = columns.clusters().unzip();
    let (data, of_data, kind, why) = if columns.has("runs") && columns.has("exceeded") {
        let stripes = stripes(columns, &intensity)?;
        let why = "the table holds counts".to_owned();
        (Data::Stripes(stripes), clusters.clone(), TableKind::Stripes, why)
    } else if columns.has("reached") && columns.intensity("capacity").is_some() {
        let capacities = capacities(columns, &intensity)?;
        let why = "the table holds capacities".to_owned();
        (Data::Capacities(capacities), clusters.clone(), TableKind::Capacities, why)
    } else {
        let of_runs = runs::of_runs(request, columns, &intensity, &mut warnings)?;
        (of_runs.data, of_runs.clusters, TableKind::Runs, of_runs.why)
    };
    let of_data = of_data.map_or_else(Vec::new, |clusters| clusters.of_row);
    let fragility = match &data {
        Data::Stripes(stripes) => Fragility::of_stripes_by_record(stripes, &of_data),
        Data::Capacities(capacities) => Fragility::of_capacities_by_record(capacities, &of_data),
        Data::Cloud(points) => {
            let limit = request.limit.unwrap_or(f64::NAN);
            Fragility::of_cloud_by_record(points, limit, &of_data)
        }
    };
    let unit = intensity.unit.clone();
    let mut fragility = fragility.map_err(|error| {
        // As the table writes them.
        let (in_si, unit) = intensity.as_written(&unit);
        AssessmentError::Fragility { error: error.with_intensities_over(in_si), unit }
    })?;
    let counts = matches!(data, Data::Stripes(_));
    let mut warn = |kind, message| warnings.push(Notice::new(kind, message));
    if clusters.is_none() && counts {
        warn(
            NoticeKind::IndependentRuns,
            "the table does not say which runs share a record: they are taken as independent, so \
             the intervals are too narrow where records were run more than once; a column record \
             says it"
                .to_owned(),
        );
    }
    if let Some((draws, seed)) = request.bootstrap {
        if clusters.is_none() && counts {
            let expected = "a column record, whose records are drawn";
            return Err(refuse("bootstrap", expected, "none"));
        }
        fragility = fragility.bootstrapped(draws, seed, engine)?;
    }
    use super::fragility::Certainty as C;
    let clustered_by = clustered_by.unwrap_or("record");
    match fragility.certainty() {
        C::Clustered { records } | C::Bootstrap { records, .. } if *records < ENOUGH_RECORDS => {
            warn(
                NoticeKind::FewRecords,
                format!(
                    "{records} {clustered_by}s: intervals over so few {clustered_by}s are rough"
                ),
            );
        }
        _ => {}
    }
    if let C::Bootstrap { curves, failed: failed @ 1.., .. } = fragility.certainty() {
        let all = failed + curves.len();
        let message = format!(
            "{failed} of {all} draws of {clustered_by}s tell no curve and are left out of the intervals"
        );
        warn(NoticeKind::FailedDraws, message);
    }
    // Counts of one level are one row of the report, whatever their records.
    let data = match data {
        Data::Stripes(stripes) => Data::Stripes(runs::by_level(&stripes)),
        other => other,
    };
    let averaged = rows::averaged(columns)?;
    let Intensity { measure, unit, .. } = intensity;
    Ok(FragilityRun {
        data,
        kind,
        why,
        averaged,
        fragility,
        clustered_by,
        measure,
        measure_unit: unit,
        warnings,
    })
}

fn stripes(columns: Columns<'_>, level: &Intensity) -> Result<Vec<Stripe>, AssessmentError> {
    let levels = level.values(columns)?;
    let runs = columns.counts("runs")?;
    let exceeded = columns.counts("exceeded")?;
    let rows = levels.into_iter().zip(runs).zip(exceeded);
    Ok(rows.map(|((level, runs), exceeded)| Stripe { level, runs, exceeded }).collect())
}

fn capacities(columns: Columns<'_>, level: &Intensity) -> Result<Vec<Capacity>, AssessmentError> {
    let levels = level.values(columns)?;
    let reached = columns.numbers("reached")?;
    Ok(levels
        .into_iter()
        .zip(reached)
        .map(|(level, reached)| Capacity { level, reached: reached != 0.0 })
        .collect())
}
