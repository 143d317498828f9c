//! Named columns of a table that is read: CSV, or Parquet in one or more parts.

use std::path::{Path, PathBuf};

use super::{AssessmentError, refuse};
use crate::parquet::{NumberColumn, read_columns};
use crate::read::read_bytes;

/// A table as it was read.
pub struct Columns {
    path: PathBuf,
    names: Vec<String>,
    kind: Kind,
}

enum Kind {
    /// Rows of cells, each with the line that it stands on.
    Texts(Vec<(usize, Vec<Cell>)>),
    Numbers(Vec<NumberColumn>),
}

/// A cell and its column in characters, from 1.
struct Cell {
    text: String,
    column: usize,
}

impl Columns {
    /// Reads a CSV file, or Parquet files of the same columns one after another.
    ///
    /// # Errors
    /// [`AssessmentError`] for files that cannot be read, and rows of CSV with another number of cells
    /// than the header.
    pub fn read(files: &[PathBuf]) -> Result<Self, AssessmentError> {
        let Some(first) = files.first() else {
            return Err(refuse("SOURCE", "a file", "none"));
        };
        if first.extension().is_some_and(|e| e.eq_ignore_ascii_case("parquet")) {
            let mut columns: Vec<NumberColumn> = Vec::new();
            for path in files {
                for column in read_columns(path)? {
                    match columns.iter_mut().find(|known| known.name == column.name) {
                        Some(known) => known.values.extend(column.values),
                        None => columns.push(column),
                    }
                }
            }
            let names = columns.iter().map(|column| column.name.clone()).collect();
            return Ok(Self { path: first.clone(), names, kind: Kind::Numbers(columns) });
        }
        let bytes = read_bytes(first)?;
        let text = String::from_utf8_lossy(&bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        Self::of_csv(first, text)
    }

    fn of_csv(path: &Path, text: &str) -> Result<Self, AssessmentError> {
        let mut lines = text.lines().enumerate().filter(|(_, line)| {
            let line = line.trim();
            !line.is_empty() && !line.starts_with('#')
        });
        let Some((_, header)) = lines.next() else {
            return Err(cell_error(path, 1, 1, "a header with names of columns", "nothing"));
        };
        let names: Vec<String> = cells(header).into_iter().map(|cell| cell.text).collect();
        let mut rows = Vec::new();
        for (number, line) in lines {
            let row = cells(line);
            if row.len() != names.len() {
                let expected = format!("{} cells, as the header has", names.len());
                let found = row.len().to_string();
                return Err(cell_error(path, number + 1, 1, &expected, &found));
            }
            rows.push((number + 1, row));
        }
        if rows.is_empty() {
            return Err(cell_error(path, 2, 1, "at least one row", "none"));
        }
        Ok(Self { path: path.to_owned(), names, kind: Kind::Texts(rows) })
    }

    fn index(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// Whether there is a column of that name.
    pub fn has(&self, name: &str) -> bool {
        self.index(name).is_some()
    }

    /// The unit of a column, where the file says it.
    pub fn unit(&self, name: &str) -> String {
        match (&self.kind, self.index(name)) {
            (Kind::Numbers(columns), Some(index)) => columns[index].unit.clone(),
            _ => String::new(),
        }
    }

    /// The error for a column that is not there, with the nearest that is.
    pub fn lacking(&self, option: &str, name: &str) -> AssessmentError {
        AssessmentError::Option {
            option: option.to_owned(),
            expected: format!("a column of {}", self.path.display()),
            found: format!("{name:?}"),
            nearest: slipstick::error::similar(name, self.names.iter().map(String::as_str)),
        }
    }

    /// The first cell of a column of texts.
    pub fn first_text(&self, name: &str) -> Option<String> {
        self.texts(name)?.into_iter().next().filter(|text| !text.is_empty())
    }

    /// A column of texts; `None` where there is none, as in Parquet.
    pub fn texts(&self, name: &str) -> Option<Vec<String>> {
        let (Kind::Texts(rows), Some(index)) = (&self.kind, self.index(name)) else { return None };
        Some(rows.iter().map(|(_, row)| row[index].text.clone()).collect())
    }

    /// A column of numbers, none of them missing.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>, AssessmentError> {
        let values = self.numbers_or_nan(name)?;
        let Some(row) = values.iter().position(|value| value.is_nan()) else { return Ok(values) };
        let (line, column) = match (&self.kind, self.index(name)) {
            (Kind::Texts(rows), Some(index)) => (rows[row].0, rows[row].1[index].column),
            _ => (row + 1, 1),
        };
        let expected = format!("a number in {name}");
        Err(cell_error(&self.path, line, column, &expected, "nothing"))
    }

    /// A column of numbers; NaN where a cell is empty.
    pub fn numbers_or_nan(&self, name: &str) -> Result<Vec<f64>, AssessmentError> {
        let Some(index) = self.index(name) else { return Err(self.lacking("SOURCE", name)) };
        let rows = match &self.kind {
            Kind::Numbers(columns) => return Ok(columns[index].values.clone()),
            Kind::Texts(rows) => rows,
        };
        let number = |(line, row): &(usize, Vec<Cell>)| {
            let Cell { text, column } = &row[index];
            match text.trim() {
                "" => Ok(f64::NAN),
                "true" => Ok(1.0),
                "false" => Ok(0.0),
                text => text.parse::<f64>().ok().filter(|v| !v.is_nan()).ok_or_else(|| {
                    let expected = format!("a number in {name}");
                    let shown: String = text.chars().take(40).collect();
                    cell_error(&self.path, *line, *column, &expected, &format!("{shown:?}"))
                }),
            }
        };
        rows.iter().map(number).collect()
    }

    /// A column of whole numbers ≥ 0.
    pub fn counts(&self, name: &str) -> Result<Vec<u64>, AssessmentError> {
        let whole = |value: f64| {
            if (0.0..1e15).contains(&value) && value.fract() == 0.0 {
                return Ok(value as u64);
            }
            Err(refuse(name, "whole numbers ≥ 0", value.to_string()))
        };
        self.numbers(name)?.into_iter().map(whole).collect()
    }
}

fn cell_error(
    path: &Path,
    line: usize,
    column: usize,
    expected: &str,
    found: &str,
) -> AssessmentError {
    AssessmentError::Cell {
        path: path.to_owned(),
        line,
        column,
        expected: expected.to_owned(),
        found: found.to_owned(),
    }
}

/// The cells of a line: between commas, perhaps in quotes, a doubled quote standing for one.
fn cells(line: &str) -> Vec<Cell> {
    let mut found = vec![Cell { text: String::new(), column: 1 }];
    let mut quoted = false;
    let mut characters = line.chars().enumerate().peekable();
    while let Some((at, character)) = characters.next() {
        let last = found.len() - 1;
        match character {
            '"' if quoted && characters.peek().is_some_and(|(_, next)| *next == '"') => {
                characters.next();
                found[last].text.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => found.push(Cell { text: String::new(), column: at + 2 }),
            other => found[last].text.push(other),
        }
    }
    for cell in &mut found {
        cell.text = cell.text.trim().to_owned();
    }
    found
}
