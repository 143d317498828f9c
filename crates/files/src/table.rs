//! Tables in files, as CSV and Parquet.

use std::path::{Path, PathBuf};

use slipstick::error::{CellError, RecordError};
use slipstick::record::{TextCell, text_rows};
use slipstick::study::Certified;
use slipstick::table::{Column, Table, from_cell};

use crate::error::FileError;
use crate::parquet::{columns_to_bytes, read_columns};
use crate::read::read_bytes;

pub use slipstick_report::tables::to_csv;

/// The table as a Parquet file; `path` is for messages.
///
/// # Errors
/// [`FileError::Table`] for columns of different lengths.
pub fn to_parquet(path: &Path, table: &Table) -> Result<Vec<u8>, FileError> {
    columns_to_bytes(path, &table.columns)
}

/// A table as it was read, and where its cells stand. The cells of CSV are texts.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadTable {
    /// The table.
    pub table: Table,
    /// The file, the first of several.
    pub path: PathBuf,
    /// How many of the runs of a study were certified, where its files say so.
    pub certified: Option<Certified>,
    /// Of CSV the line of each row and the columns in characters of its cells, all from 1.
    places: Vec<(usize, Vec<usize>)>,
}

impl ReadTable {
    /// Line and column, from 1, of the cell in a row (from 0) of a column.
    #[must_use]
    pub fn place(&self, row: usize, column: &str) -> (usize, usize) {
        let index = self.table.columns.iter().position(|known| known.name == column);
        let place = self.places.get(row).zip(index);
        place.map_or((row + 1, 1), |((line, columns), index)| (*line, columns[index]))
    }

    /// What is wrong with a cell, with its place in the file.
    #[must_use]
    pub fn cell_error(&self, error: &CellError) -> FileError {
        let (line, column) = self.place(error.row, &error.column);
        cell_error(&self.path, line, column, &error.expected, &error.found)
    }
}

/// Reads a CSV file, or Parquet files of the same columns one after another.
///
/// # Errors
/// [`FileError`] for files that cannot be read, rows of CSV with another number of cells than the
/// header, and columns that are not of one kind in all files.
pub fn read_table(files: &[PathBuf]) -> Result<ReadTable, FileError> {
    let Some(first) = files.first() else {
        return Err(FileError::NoMatch { pattern: PathBuf::new() });
    };
    if !first.extension().is_some_and(|e| e.eq_ignore_ascii_case("parquet")) {
        let bytes = read_bytes(first)?;
        return read_csv(first, &bytes);
    }
    let mut columns: Vec<Column> = Vec::new();
    for path in files {
        for column in read_columns(path)? {
            match columns.iter_mut().find(|known| known.name == column.name) {
                Some(known) => {
                    if !known.cells.append(column.cells) {
                        let expected = format!("{} as in {}", column.name, first.display());
                        return Err(cell_error(path, 1, 1, &expected, "another kind"));
                    }
                }
                None => columns.push(column),
            }
        }
    }
    Ok(ReadTable {
        table: Table { columns },
        path: first.clone(),
        certified: None,
        places: Vec::new(),
    })
}

/// A table from the bytes of a CSV, all of whose cells are texts.
///
/// # Errors
/// [`FileError::Cell`] for rows that do not fit the header, and for a table without rows.
pub fn read_csv(path: &Path, bytes: &[u8]) -> Result<ReadTable, FileError> {
    let read = text_rows(&path.display().to_string(), bytes).map_err(|error| {
        let RecordError { line, column, expected, found, .. } = error;
        cell_error(path, line, column, &expected, &found)
    })?;
    if read.rows.is_empty() {
        return Err(cell_error(path, 2, 1, "at least one row", "none"));
    }
    let column = |(index, name): (usize, &String)| {
        let cells = read.rows.iter().map(|(_, cells)| from_cell(&cells[index].text).to_owned());
        Column::texts(from_cell(name), cells.collect())
    };
    let columns = read.names.iter().enumerate().map(column).collect();
    let place = |(line, cells): &(usize, Vec<TextCell>)| {
        (*line, cells.iter().map(|cell| cell.column).collect())
    };
    let places = read.rows.iter().map(place).collect();
    Ok(ReadTable { table: Table { columns }, path: path.to_owned(), certified: None, places })
}

fn cell_error(path: &Path, line: usize, column: usize, expected: &str, found: &str) -> FileError {
    let (expected, found) = (expected.to_owned(), found.to_owned());
    FileError::Cell { path: path.to_owned(), line, column, expected, found }
}

#[cfg(test)]
mod tests {
    use slipstick::table::Column;

    use super::*;

    #[test]
    fn tables_in_both_forms() {
        let mut table = Table::default();
        table
            .texts("record", vec!["a, b".to_owned(), "c \"d\"".to_owned()])
            .numbers("level", "m/s2", vec![0.1, f64::NAN])
            .numbers("x", "", vec![-0.0, f64::INFINITY]);
        assert_eq!(to_csv(&table), "record,level,x\n\"a, b\",0.1,0.0\n\"c \"\"d\"\"\",,inf\n");
        let path =
            std::env::temp_dir().join(format!("slipstick-table-{}.parquet", std::process::id()));
        std::fs::write(&path, to_parquet(&path, &table).unwrap()).unwrap();
        let back = crate::parquet::read_columns(&path).unwrap();
        assert_eq!(back[0], Column::texts("record", vec!["a, b".into(), "c \"d\"".into()]));
        assert_eq!((back[1].name.as_str(), back[1].unit.as_str()), ("level", "m/s2"));
        let levels = back[1].cells.to_numbers().unwrap();
        assert!(levels[0] == 0.1 && levels[1].is_nan());
        std::fs::remove_file(&path).unwrap();
        table.numbers("short", "", vec![1.0]);
        assert!(to_parquet(&path, &table).is_err());
    }

    /// What is read of one form is what is read of the other, texts and units too; cells of CSV are
    /// texts until numbers are asked for.
    #[test]
    fn tables_are_read_back() {
        let folder = std::env::temp_dir().join(format!("slipstick-tables-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mut table = Table::default();
        table.texts("record", vec!["=a, b".to_owned(), "c \"d\"".to_owned()]).numbers(
            "level",
            "m/s2",
            vec![0.1, 1.0 / 3.0],
        );
        let (csv, parquet) = (folder.join("t.csv"), folder.join("t.parquet"));
        std::fs::write(&csv, to_csv(&table)).unwrap();
        std::fs::write(&parquet, to_parquet(&parquet, &table).unwrap()).unwrap();
        let twice = read_table(&[parquet.clone(), parquet]).unwrap().table;
        assert_eq!((twice.rows(), &twice.columns[1].unit[..]), (4, "m/s2"));
        assert_eq!(twice.texts_of("record").unwrap()[2..], table.texts_of("record").unwrap()[..]);
        let read = read_table(&[csv]).unwrap();
        assert_eq!(read.table.texts_of("record"), table.texts_of("record"));
        assert_eq!(read.table.texts_of("level").unwrap()[1].parse(), Ok(1.0 / 3.0));
        assert!(std::fs::read_to_string(folder.join("t.csv")).unwrap().contains("\n\"'=a, b\","));
        assert_eq!(read.place(1, "level"), (3, 11));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
