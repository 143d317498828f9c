//! Tables with columns of texts and numbers, as CSV and Parquet.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, RecordBatch, StringArray};
use arrow_schema::{DataType, Schema, SchemaRef};
use parquet::errors::ParquetError;

use crate::error::FileError;
use crate::parquet::{TableWriter, at, field, numbers};

/// A table whose columns have equal lengths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    columns: Vec<Column>,
}

#[derive(Clone, Debug, PartialEq)]
struct Column {
    name: String,
    unit: String,
    cells: Cells,
}

#[derive(Clone, Debug, PartialEq)]
enum Cells {
    Texts(Vec<String>),
    Numbers(Vec<f64>),
}

impl Table {
    /// Adds a column of texts.
    pub fn texts(&mut self, name: &str, cells: Vec<String>) -> &mut Self {
        self.columns.push(Column {
            name: name.to_owned(),
            unit: String::new(),
            cells: Cells::Texts(cells),
        });
        self
    }

    /// Adds a column of numbers in a unit (empty where they have none); NaN is an empty cell.
    pub fn numbers(&mut self, name: &str, unit: &str, cells: Vec<f64>) -> &mut Self {
        self.columns.push(Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            cells: Cells::Numbers(cells),
        });
        self
    }

    fn rows(&self) -> usize {
        let length = |column: &Column| match &column.cells {
            Cells::Texts(cells) => cells.len(),
            Cells::Numbers(cells) => cells.len(),
        };
        self.columns.iter().map(length).min().unwrap_or(0)
    }

    /// The table as CSV: a header, then rows ended by LF; numbers in the shortest digits that read
    /// back as the same, `inf` for +∞.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let names: Vec<String> = self.columns.iter().map(|column| quoted(&column.name)).collect();
        let mut text = names.join(",");
        text.push('\n');
        for row in 0..self.rows() {
            for (i, column) in self.columns.iter().enumerate() {
                if i > 0 {
                    text.push(',');
                }
                match &column.cells {
                    Cells::Texts(cells) => text.push_str(&quoted(&cells[row])),
                    Cells::Numbers(cells) if cells[row].is_nan() => {}
                    // Writing to a String cannot fail; adding 0 takes the sign off a zero.
                    Cells::Numbers(cells) => drop(write!(text, "{:?}", cells[row] + 0.0)),
                }
            }
            text.push('\n');
        }
        text
    }

    /// The table as a Parquet file, the unit of a column in its field's metadata; `path` is for
    /// messages.
    ///
    /// # Errors
    /// [`FileError::Table`] for columns of different lengths.
    pub fn to_parquet(&self, path: &Path) -> Result<Vec<u8>, FileError> {
        let fields = self.columns.iter().map(|column| match column.cells {
            Cells::Texts(_) => field(&column.name, "", DataType::Utf8, false),
            Cells::Numbers(_) => field(&column.name, &column.unit, DataType::Float64, true),
        });
        let schema: SchemaRef = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let array = |column: &Column| -> ArrayRef {
            match &column.cells {
                Cells::Texts(cells) => Arc::new(StringArray::from(cells.clone())),
                Cells::Numbers(cells) => numbers(cells.iter().copied()),
            }
        };
        let bytes = || -> Result<Vec<u8>, ParquetError> {
            let arrays = self.columns.iter().map(array).collect();
            let batch = RecordBatch::try_new(schema.clone(), arrays)?;
            let mut table = TableWriter::new(Vec::new(), schema, &[])?;
            table.row_group(&batch)?;
            table.finish()
        };
        bytes().map_err(at(path))
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        return format!("\"{}\"", text.replace('"', "\"\""));
    }
    text.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_tables_in_both_forms() {
        let mut table = Table::default();
        table
            .texts("record", vec!["a, b".to_owned(), "c \"d\"".to_owned()])
            .numbers("level", "m/s2", vec![0.1, f64::NAN])
            .numbers("x", "", vec![-0.0, f64::INFINITY]);
        assert_eq!(table.to_csv(), "record,level,x\n\"a, b\",0.1,0.0\n\"c \"\"d\"\"\",,inf\n");
        let path =
            std::env::temp_dir().join(format!("slipstick-table-{}.parquet", std::process::id()));
        std::fs::write(&path, table.to_parquet(&path).unwrap()).unwrap();
        let back = crate::parquet::read_columns(&path).unwrap();
        assert_eq!((back[0].name.as_str(), back[0].unit.as_str()), ("level", "m/s2"));
        assert!(back[0].values[0] == 0.1 && back[0].values[1].is_nan());
        std::fs::remove_file(&path).unwrap();
        table.numbers("short", "", vec![1.0]);
        assert!(table.to_parquet(&path).is_err());
    }
}
