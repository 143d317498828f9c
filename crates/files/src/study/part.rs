//! A part of a study: so many rows in one Parquet file.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use slipstick::study::{Column, ColumnKind, Row, Study, Verdict};

use crate::error::FileError;
use crate::parquet::{self, TableWriter, field, numbers};
use ::parquet::errors::ParquetError;

/// Parts that a study is cut into, where their size allows.
const PARTS: u64 = 128;

/// Fewest and most rows of a part (but the last).
const FEWEST_ROWS: u64 = 500;
const MOST_ROWS: u64 = 20_000;

/// Rows that are run again: every so manieth, besides the first and last of each part.
const CHECKED_EVERY: u64 = 1000;

/// Rows of each part but the last of a study with so many runs.
#[must_use]
pub fn part_rows(runs: u64) -> u64 {
    runs.div_ceil(PARTS).clamp(FEWEST_ROWS, MOST_ROWS)
}

/// Number of parts of a study with so many runs.
pub(super) fn part_count(runs: u64) -> u64 {
    runs.div_ceil(part_rows(runs))
}

/// Name of a part's file.
pub(super) fn part_name(part: u64) -> String {
    format!("part-{part:05}.parquet")
}

/// The part of a file's name.
pub(super) fn part_of_name(name: &str) -> Option<u64> {
    name.strip_prefix("part-")?.strip_suffix(".parquet")?.parse().ok()
}

/// Whether a run is run again alone.
pub(super) fn is_checked(run: u64, part: &std::ops::Range<u64>) -> bool {
    run.is_multiple_of(CHECKED_EVERY) || run == part.start || run + 1 == part.end
}

/// What came of running rows again.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Checks {
    /// Number of rows.
    pub rows: u64,
    /// Worst defect of the equations of motion.
    pub equilibrium_residual: f64,
    /// Worst excess over the friction law.
    pub friction_excess: f64,
    /// Worst imbalance of energy.
    pub energy_balance_error: f64,
}

impl Checks {
    /// With one more row.
    pub(super) fn add(&mut self, verdict: &Verdict) {
        self.join(&Self {
            rows: 1,
            equilibrium_residual: verdict.equilibrium_residual,
            friction_excess: verdict.friction_excess,
            energy_balance_error: verdict.energy_balance_error,
        });
    }

    /// With those of other rows.
    pub(super) fn join(&mut self, other: &Self) {
        self.rows += other.rows;
        self.equilibrium_residual = self.equilibrium_residual.max(other.equilibrium_residual);
        self.friction_excess = self.friction_excess.max(other.friction_excess);
        self.energy_balance_error = self.energy_balance_error.max(other.energy_balance_error);
    }
}

/// What a part's file says of itself besides its rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Notes {
    /// The study.
    pub id: String,
    /// Number of runs of the whole study.
    pub runs: u64,
    /// First run of the file.
    pub first: u64,
    /// Number of rows of the file.
    pub rows: u64,
    /// Runs that failed.
    pub failures: u64,
    /// What came of running some again.
    pub checks: Checks,
}

impl Notes {
    fn to_pairs(&self) -> Vec<(&'static str, String)> {
        let number = |value: f64| format!("{value:?}");
        vec![
            ("slipstick.study", self.id.clone()),
            ("slipstick.runs", self.runs.to_string()),
            ("slipstick.first_run", self.first.to_string()),
            ("slipstick.rows", self.rows.to_string()),
            ("slipstick.failures", self.failures.to_string()),
            ("slipstick.checked_rows", self.checks.rows.to_string()),
            ("slipstick.equilibrium_residual", number(self.checks.equilibrium_residual)),
            ("slipstick.friction_excess", number(self.checks.friction_excess)),
            ("slipstick.energy_balance_error", number(self.checks.energy_balance_error)),
        ]
    }

    /// Those of a file.
    ///
    /// # Errors
    /// [`FileError::Table`] for a file without them.
    pub(super) fn read(path: &Path) -> Result<Self, FileError> {
        let table = parquet::open(path)?;
        let missing = |key: &str| FileError::Table {
            path: path.to_owned(),
            reason: format!("it has no {key} and is no part of a study"),
        };
        let text = |key: &str| parquet::note(&table, key).ok_or_else(|| missing(key));
        let count = |key: &str| text(key)?.parse::<u64>().map_err(|_| missing(key));
        let number = |key: &str| text(key)?.parse::<f64>().map_err(|_| missing(key));
        Ok(Self {
            id: text("slipstick.study")?.to_owned(),
            runs: count("slipstick.runs")?,
            first: count("slipstick.first_run")?,
            rows: count("slipstick.rows")?,
            failures: count("slipstick.failures")?,
            checks: Checks {
                rows: count("slipstick.checked_rows")?,
                equilibrium_residual: number("slipstick.equilibrium_residual")?,
                friction_excess: number("slipstick.friction_excess")?,
                energy_balance_error: number("slipstick.energy_balance_error")?,
            },
        })
    }
}

/// A table in the making with the notes of its file.
pub(super) fn table<W: Write + Send>(
    to: W,
    schema: SchemaRef,
    notes: &Notes,
) -> Result<TableWriter<W>, ParquetError> {
    TableWriter::new(to, schema, &notes.to_pairs())
}

/// A file of a study that is known by its notes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PartFile {
    pub path: PathBuf,
    pub notes: Notes,
}

/// The columns of a study's table.
pub(super) struct Layout {
    pub schema: SchemaRef,
    demands: Vec<Column>,
    /// Index of the first demand among the columns.
    pub first_demand: usize,
}

impl Layout {
    pub(super) fn new(study: &Study) -> Self {
        let has_measure = study.level(0).is_some();
        let mut fields = vec![
            field("run", "", DataType::Int64, false),
            field("record", "", DataType::Utf8, false),
            field("channel", "", DataType::Utf8, false),
            field(
                "level",
                if has_measure { study.level_unit() } else { "" },
                DataType::Float64,
                true,
            ),
            field("scale", "", DataType::Float64, false),
        ];
        let number = |column: &Column| field(&column.name, column.unit, DataType::Float64, true);
        fields.extend(study.measure_columns().iter().map(number));
        fields.extend(study.value_columns().iter().map(number));
        let first_demand = fields.len();
        let demands = study.demand_columns();
        fields.extend(demands.iter().map(|column| match column.kind {
            ColumnKind::Number => number(column),
            ColumnKind::Count => field(&column.name, column.unit, DataType::Int64, true),
            ColumnKind::Flag => field(&column.name, column.unit, DataType::Boolean, true),
        }));
        fields.push(Field::new("warnings", DataType::Utf8, false));
        fields.push(Field::new("status", DataType::Utf8, false));
        Self { schema: Arc::new(Schema::new(fields)), demands, first_demand }
    }

    /// The demands, which stand from [`Layout::first_demand`] on.
    pub(super) fn demands(&self) -> &[Column] {
        &self.demands
    }

    /// Rows as columns.
    pub(super) fn batch(&self, study: &Study, rows: &[Row]) -> Result<RecordBatch, ParquetError> {
        let texts = |text: &dyn Fn(&Row) -> String| -> ArrayRef {
            Arc::new(rows.iter().map(|row| Some(text(row))).collect::<StringArray>())
        };
        let record = |row: &Row| study.records().get(row.case.record as usize);
        let runs: Int64Array = rows.iter().map(|row| Some(row.run as i64)).collect();
        let levels = rows.iter().map(|row| study.level(row.case.level).unwrap_or(f64::NAN));
        let scales: Float64Array = rows.iter().map(|row| Some(row.scale)).collect();
        let mut columns: Vec<ArrayRef> = vec![
            Arc::new(runs),
            texts(&|row| record(row).map_or(study.made_motion().to_owned(), |r| r.name.clone())),
            texts(&|row| record(row).map_or_else(String::new, |r| r.channel.clone())),
            numbers(levels),
            Arc::new(scales),
        ];
        let of = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(f64::NAN);
        for i in 0..study.measure_columns().len() {
            columns.push(numbers(rows.iter().map(|row| of(&row.measures, i))));
        }
        for i in 0..study.value_columns().len() {
            columns.push(numbers(rows.iter().map(|row| of(&row.values, i))));
        }
        for (i, column) in self.demands.iter().enumerate() {
            let values = rows.iter().map(|row| of(&row.demands, i));
            let some = values.clone().map(|value| (!value.is_nan()).then_some(value));
            columns.push(match column.kind {
                ColumnKind::Number => numbers(values),
                ColumnKind::Count => {
                    Arc::new(some.map(|v| v.map(|v| v as i64)).collect::<Int64Array>())
                }
                ColumnKind::Flag => {
                    Arc::new(some.map(|v| v.map(|v| v != 0.0)).collect::<BooleanArray>())
                }
            });
        }
        columns.push(texts(&|row| row.warnings.join(";")));
        columns.push(texts(&|row| row.error.clone().unwrap_or_else(|| "ok".to_owned())));
        Ok(RecordBatch::try_new(self.schema.clone(), columns)?)
    }
}
