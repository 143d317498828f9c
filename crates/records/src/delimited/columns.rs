//! All columns of a table as they stand, whatever they measure.

use super::header::{Header, Name};
use super::table::TextTable;
use crate::text::Text;
use slipstick_dynamics::error::{RecordError, listed};
use slipstick_dynamics::motion::MAX_SAMPLES;

/// A column of numbers as they stand in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name in the header, its unit included; `column 1`, … where the file names none.
    pub name: String,
    /// Whether the header says that it holds times.
    pub is_time: bool,
    /// Its numbers, one a row, not converted; NaN for a cell that is none ([`Columns::numbers`]).
    pub values: Vec<f64>,
}

/// A table of numbers as it stands in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// The caller's name for the file, for errors.
    pub source_name: String,
    /// The columns from left to right, at least one, all of the same length of at least 2.
    pub columns: Vec<Column>,
    /// The line of each row, counted from 1.
    lines: Vec<u32>,
    /// Of each column the error about its first cell that is no number.
    faults: Vec<Option<RecordError>>,
}

impl Columns {
    /// A table that was read elsewhere; its rows count from 1 as lines do.
    ///
    /// # Errors
    /// [`RecordError`] for no column, fewer than two rows and columns of different lengths.
    pub fn new(source_name: &str, columns: Vec<Column>) -> Result<Self, RecordError> {
        let rows = columns.first().map_or(0, |column| column.values.len());
        let lines = (1..=u32::try_from(rows).unwrap_or(u32::MAX)).collect();
        let faults = vec![None; columns.len()];
        let mut table = Self { source_name: source_name.to_owned(), columns, lines, faults };
        if !(2..=MAX_SAMPLES).contains(&rows) {
            let expected = "2 to 100 000 000 rows of numbers";
            return Err(table.error(0, 1, expected, rows.to_string()));
        }
        for (index, column) in table.columns.iter().enumerate() {
            let (name, found) = (&column.name, column.values.len());
            if found != rows {
                let expected = format!("{rows} numbers in {name:?}, as in the first column");
                return Err(table.error(found.min(rows), index + 1, expected, found.to_string()));
            }
        }
        table.faults = (0..table.columns.len()).map(|index| table.not_finite(index)).collect();
        Ok(table)
    }

    /// The error about the first value of a column that is not finite.
    fn not_finite(&self, index: usize) -> Option<RecordError> {
        let Column { name, values, .. } = &self.columns[index];
        let row = values.iter().position(|value| !value.is_finite())?;
        let found = match values[row] {
            value if value.is_nan() => "none".to_owned(),
            value => value.to_string(),
        };
        Some(self.error(row, index + 1, format!("a number in {name:?}"), found))
    }

    /// The numbers of a column, all of them finite.
    ///
    /// # Errors
    /// [`RecordError`] at its first cell that is no number.
    pub fn numbers(&self, index: usize) -> Result<&[f64], RecordError> {
        match &self.faults[index] {
            None => Ok(&self.columns[index].values),
            Some(fault) => Err(fault.clone()),
        }
    }

    /// The columns of which no cell is a number: texts.
    pub fn texts(&self) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(|column| column.values.iter().all(|value| value.is_nan()))
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.lines.len()
    }

    /// The error about a cell; `column` counts from 1 as in a spreadsheet.
    #[must_use]
    pub fn error(
        &self,
        row: usize,
        column: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> RecordError {
        RecordError {
            source_name: self.source_name.clone(),
            line: self.lines.get(row).map_or(1, |line| *line as usize),
            column,
            offset: None,
            expected: expected.into(),
            found: found.into(),
        }
    }

    /// The names, for a message.
    #[must_use]
    pub fn names(&self) -> String {
        listed(self.columns.iter().map(|c| format!("{:?}", c.name)))
    }
}

/// Reads every column.
///
/// # Errors
/// As for a record of delimited text; also for a row that is short, and for fewer than two rows.
pub(crate) fn read(text: &Text) -> Result<Columns, RecordError> {
    let header = Header::of(text)?;
    let table = TextTable::read(text, &header)?;
    if !table.is_full() {
        let short = table.cells.len() % table.columns;
        let expected = format!("{} numbers, as in the rows before", table.columns);
        return Err(text.error_at_end(expected, &short.to_string()));
    }
    if !(2..=MAX_SAMPLES).contains(&table.rows()) {
        let expected = "2 to 100 000 000 rows of numbers";
        return Err(text.error_at_end(expected, &table.rows().to_string()));
    }
    let names = header.names(text, &table)?;
    if names.is_none() {
        table.require_all(text)?;
    }
    // Times of day count from the first.
    let of_clock = |index: usize| {
        let is_clock = table.clock[0] == Some(index);
        is_clock.then(|| table.since_first(text, index)).flatten()
    };
    let column = |index: usize| {
        let name = names.as_ref().map(|names| &names[index]);
        Column {
            name: name.map_or_else(|| format!("column {}", index + 1), |n| n.text.clone()),
            is_time: name.is_some_and(Name::is_time),
            values: of_clock(index).unwrap_or_else(|| table.column(index).collect()),
        }
    };
    let columns: Vec<Column> = (0..table.columns).map(column).collect();
    if columns.iter().all(|column| column.values.iter().all(|value| value.is_nan())) {
        table.require_all(text)?;
    }
    Ok(Columns {
        source_name: text.source_name().to_owned(),
        columns,
        lines: table.row_lines(text),
        faults: (0..table.columns).map(|index| table.require(text, index).err()).collect(),
    })
}
