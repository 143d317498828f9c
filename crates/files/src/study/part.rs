//! A part of a study: so many rows in one Parquet file.

use std::io::Write;
use std::ops::Range;

use slipstick::study::{Certified, Verdict, Worst, worse};
use slipstick::table::{Cells, Field};

use crate::error::FileError;
use crate::parquet::{ParquetTable, TableWriter};
use ::parquet::errors::ParquetError;

use super::seal::{SEAL_KEY, blank, seal};

/// Parts that a study is cut into, where their size allows.
const PARTS: u64 = 128;

/// Fewest and most rows of a part (but the last).
const FEWEST_ROWS: u64 = 500;
const MOST_ROWS: u64 = 20_000;

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

/// The runs of a part.
pub(super) fn rows_of(part: u64, runs: u64) -> Range<u64> {
    let size = part_rows(runs);
    part * size..((part + 1) * size).min(runs)
}

/// The part of a file's name.
pub(super) fn part_of_name(name: &str) -> Option<u64> {
    name.strip_prefix("part-")?.strip_suffix(".parquet")?.parse().ok()
}

/// What came of running rows again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checks {
    /// Number of rows.
    pub rows: u64,
    /// Worst defect of the equations of motion.
    pub equilibrium_residual: f64,
    /// Worst excess over the friction law.
    pub friction_excess: f64,
    /// Worst imbalance of energy.
    pub energy_balance_error: f64,
    /// Worst difference of a demand from the one recomputed.
    pub demands_error: f64,
    /// The row with the largest figure of all, and that figure; none of parts of older versions.
    pub worst: Option<Worst>,
}

impl Checks {
    /// That so many of some runs were certified.
    #[must_use]
    pub fn certified(&self, runs: u64) -> Certified {
        let worst = self.worst.clone();
        Certified { certified: self.rows, worst, ..Certified::of(runs) }
    }

    /// With one more row.
    pub(super) fn add(&mut self, run: u64, verdict: &Verdict) {
        let largest = verdict.largest.clone();
        self.join(&Self {
            worst: largest.map(|(what, error)| Worst { run: format!("run {run}"), what, error }),
            rows: 1,
            equilibrium_residual: verdict.equilibrium_residual,
            friction_excess: verdict.friction_excess,
            energy_balance_error: verdict.energy_balance_error,
            demands_error: verdict.demands_error,
        });
    }

    /// With those of other rows.
    pub(super) fn join(&mut self, other: &Self) {
        self.rows += other.rows;
        self.equilibrium_residual = self.equilibrium_residual.max(other.equilibrium_residual);
        self.friction_excess = self.friction_excess.max(other.friction_excess);
        self.energy_balance_error = self.energy_balance_error.max(other.energy_balance_error);
        self.demands_error = self.demands_error.max(other.demands_error);
        self.worst = worse(self.worst.take(), other.worst.clone());
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
    /// The measure that records were scaled to, where they were.
    pub measure: Option<String>,
}

/// The key of that measure.
pub(super) const MEASURE_KEY: &str = "slipstick.measure";

/// The keys of the worst row: what it is called, the figure or demand, and its size.
const WORST_KEYS: [&str; 3] =
    ["slipstick.worst_run", "slipstick.worst_figure", "slipstick.worst_error"];

impl Notes {
    fn to_pairs(&self) -> Vec<(&'static str, String)> {
        let number = |value: f64| format!("{value:?}");
        let measure = self.measure.iter().map(|measure| (MEASURE_KEY, measure.clone()));
        let pairs = [
            ("slipstick.study", self.id.clone()),
            ("slipstick.runs", self.runs.to_string()),
            ("slipstick.first_run", self.first.to_string()),
            ("slipstick.rows", self.rows.to_string()),
            ("slipstick.failures", self.failures.to_string()),
            ("slipstick.checked_rows", self.checks.rows.to_string()),
            ("slipstick.equilibrium_residual", number(self.checks.equilibrium_residual)),
            ("slipstick.friction_excess", number(self.checks.friction_excess)),
            ("slipstick.energy_balance_error", number(self.checks.energy_balance_error)),
            ("slipstick.demands_error", number(self.checks.demands_error)),
        ];
        let worst = self.checks.worst.iter().flat_map(|worst| {
            let texts = [worst.run.clone(), worst.what.clone(), number(worst.error)];
            WORST_KEYS.into_iter().zip(texts)
        });
        pairs.into_iter().chain(worst).chain(measure).collect()
    }

    /// Those of a file.
    ///
    /// # Errors
    /// [`FileError::Table`] for a file without them.
    pub(super) fn of(table: &ParquetTable) -> Result<Self, FileError> {
        let missing = |key: &str| FileError::Table {
            path: table.path.clone(),
            reason: format!("it has no {key} and is no part of a study"),
        };
        let text = |key: &str| table.note(key).ok_or_else(|| missing(key));
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
                demands_error: number("slipstick.demands_error")?,
                worst: worst_of(table),
            },
            measure: table.note(MEASURE_KEY).map(str::to_owned),
        })
    }
}

/// The worst row that a file names; none where an older version wrote it.
fn worst_of(table: &ParquetTable) -> Option<Worst> {
    let [run, what, error] = WORST_KEYS.map(|key| table.note(key));
    Some(Worst { run: run?.to_owned(), what: what?.to_owned(), error: error?.parse().ok()? })
}

/// A table in the making with the notes of its file.
pub(super) fn table<W: Write + Send>(
    to: W,
    fields: &[Field],
    notes: &Notes,
) -> Result<TableWriter<W>, ParquetError> {
    TableWriter::new(to, fields, &notes.to_pairs())
}

/// The bytes of a part, with the hash of all of them.
pub(super) fn sealed(
    fields: &[Field],
    notes: &Notes,
    cells: &[Cells],
) -> Result<Vec<u8>, ParquetError> {
    let mut pairs = notes.to_pairs();
    pairs.push((SEAL_KEY, blank()));
    let mut table = TableWriter::new(Vec::new(), fields, &pairs)?;
    table.row_group(cells)?;
    let mut bytes = table.finish()?;
    seal(&mut bytes);
    Ok(bytes)
}

/// A file of a study that is known by its notes.
#[derive(Clone, Debug)]
pub(super) struct PartFile {
    pub table: ParquetTable,
    pub notes: Notes,
    /// SHA-256 of the file.
    pub sha256: String,
}

#[cfg(test)]
mod tests {
    use slipstick::table::Kind;

    use super::*;

    /// What a part says of its rows is read back; of an older version, which names no worst row, as well.
    #[test]
    fn notes_are_read_back_of_older_parts_too() {
        let path = std::env::temp_dir().join(format!("slipstick-notes-{}", std::process::id()));
        let named =
            Worst { run: "run 17".to_owned(), what: "sliding_path_m".to_owned(), error: 2e-13 };
        for worst in [Some(named), None] {
            let checks = Checks { rows: 3, demands_error: 2e-13, worst, ..Checks::default() };
            let notes = Notes {
                id: "ab".to_owned(),
                runs: 500,
                first: 0,
                rows: 500,
                failures: 2,
                checks,
                measure: None,
            };
            let fields = [Field { kind: Kind::Count, ..Field::text("run") }];
            let cells = [Cells::Counts((0..500).map(Some).collect())];
            std::fs::write(&path, sealed(&fields, &notes, &cells).unwrap()).unwrap();
            let read = Notes::of(&ParquetTable::of(&path).unwrap());
            std::fs::remove_file(&path).unwrap();
            assert_eq!(read.unwrap(), notes);
        }
    }
}
