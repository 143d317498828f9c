//! Tables in Parquet: columns with their units in, columns out.
//!
//! The same values give the same bytes: nothing in a file says when, where or by which machine it
//! was written. Compression is snappy, which every reader of Parquet knows.

use std::collections::HashMap;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use parquet::arrow::arrow_reader::{
    ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReaderBuilder,
};
use parquet::arrow::{ArrowWriter, ProjectionMask};
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;

use crate::error::FileError;
use crate::write::write_whole;

/// Key of a column's unit in the metadata of its Arrow field.
pub const UNIT_KEY: &str = "unit";

/// A column of numbers of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberColumn {
    /// Its name.
    pub name: String,
    /// Its unit; empty where it has none, or the file does not say.
    pub unit: String,
    /// Its values; NaN where there is none.
    pub values: Vec<f64>,
}

/// A field of a table, with its unit.
pub(crate) fn field(name: &str, unit: &str, kind: DataType, nullable: bool) -> Field {
    let field = Field::new(name, kind, nullable);
    if unit.is_empty() {
        return field;
    }
    field.with_metadata(HashMap::from([(UNIT_KEY.to_owned(), unit.to_owned())]))
}

/// Numbers as an Arrow array; NaN is null.
pub(crate) fn numbers(values: impl Iterator<Item = f64>) -> ArrayRef {
    let nullable = values.map(|value| (!value.is_nan()).then_some(value));
    Arc::new(nullable.collect::<Float64Array>())
}

/// A file of row groups in the making.
pub(crate) struct TableWriter<W: Write + Send> {
    writer: ArrowWriter<W>,
}

impl<W: Write + Send> TableWriter<W> {
    /// A table without rows; `notes` become metadata of the file.
    pub(crate) fn new(
        to: W,
        schema: SchemaRef,
        notes: &[(&str, String)],
    ) -> Result<Self, ParquetError> {
        let notes = notes.iter().map(|(key, text)| KeyValue::new((*key).to_owned(), text.clone()));
        let properties = WriterProperties::builder()
            .set_created_by(concat!("slipstick ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(notes.collect()))
            .build();
        Ok(Self { writer: ArrowWriter::try_new(to, schema, Some(properties))? })
    }

    /// Adds rows as a row group of their own.
    pub(crate) fn row_group(&mut self, batch: &RecordBatch) -> Result<(), ParquetError> {
        self.writer.write(batch)?;
        self.writer.flush()
    }

    /// Ends the file and gives back what it was written to.
    pub(crate) fn finish(self) -> Result<W, ParquetError> {
        self.writer.into_inner()
    }
}

/// What is wrong with a file, in the words of the Parquet library.
pub(crate) fn at(path: &Path) -> impl Fn(ParquetError) -> FileError + '_ {
    |error| {
        // The library says whose error it is; the message says so already.
        let reason = error.to_string();
        let reason = reason.strip_prefix("Parquet error: ").unwrap_or(&reason).to_owned();
        FileError::Table { path: path.to_owned(), reason }
    }
}

/// Opens a table.
///
/// # Errors
/// [`FileError::Read`], and [`FileError::Table`] for what is no Parquet file.
pub(crate) fn open(path: &Path) -> Result<ParquetRecordBatchReaderBuilder<File>, FileError> {
    let failed = |source| FileError::Read { path: path.to_owned(), source };
    let file = File::open(path).map_err(failed)?;
    if file.metadata().map_err(failed)?.is_dir() {
        return Err(FileError::IsFolder { path: path.to_owned() });
    }
    ParquetRecordBatchReaderBuilder::try_new(file).map_err(at(path))
}

/// A table that is read more than once: what stands about its columns is read once.
pub(crate) struct Table {
    pub(crate) path: PathBuf,
    metadata: ArrowReaderMetadata,
}

impl Table {
    /// # Errors
    /// As [`open`].
    pub(crate) fn of(path: &Path) -> Result<Self, FileError> {
        let failed = |source| FileError::Read { path: path.to_owned(), source };
        let file = File::open(path).map_err(failed)?;
        let metadata = ArrowReaderMetadata::load(&file, ArrowReaderOptions::default());
        Ok(Self { path: path.to_owned(), metadata: metadata.map_err(at(path))? })
    }

    /// # Errors
    /// [`FileError::Read`].
    pub(crate) fn open(&self) -> Result<ParquetRecordBatchReaderBuilder<File>, FileError> {
        let failed = |source| FileError::Read { path: self.path.clone(), source };
        let file = File::open(&self.path).map_err(failed)?;
        Ok(ParquetRecordBatchReaderBuilder::new_with_metadata(file, self.metadata.clone()))
    }
}

/// A note in the metadata of a file.
pub(crate) fn note<'a>(
    table: &'a ParquetRecordBatchReaderBuilder<File>,
    key: &str,
) -> Option<&'a str> {
    let notes = table.metadata().file_metadata().key_value_metadata()?;
    notes.iter().find(|note| note.key == key)?.value.as_deref()
}

/// Columns of equal length as the bytes of a Parquet file.
///
/// # Errors
/// [`FileError::Table`] for columns of different lengths; `path` is for the message.
pub fn columns_to_bytes(path: &Path, columns: &[NumberColumn]) -> Result<Vec<u8>, FileError> {
    columns_with_notes(path, columns, &[])
}

/// The same with `notes` as metadata of the file.
///
/// # Errors
/// As [`columns_to_bytes`].
pub(crate) fn columns_with_notes(
    path: &Path,
    columns: &[NumberColumn],
    notes: &[(&str, String)],
) -> Result<Vec<u8>, FileError> {
    let fields = columns.iter().map(|c| field(&c.name, &c.unit, DataType::Float64, true));
    let schema: SchemaRef = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let arrays = columns.iter().map(|column| numbers(column.values.iter().copied())).collect();
    let bytes = || -> Result<Vec<u8>, ParquetError> {
        let batch = RecordBatch::try_new(schema.clone(), arrays)?;
        let mut table = TableWriter::new(Vec::new(), schema, notes)?;
        table.row_group(&batch)?;
        table.finish()
    };
    bytes().map_err(at(path))
}

/// Writes columns of equal length as a Parquet file, whole or not at all.
///
/// # Errors
/// As [`columns_to_bytes`] and [`write_whole`].
pub fn write_columns(path: &Path, columns: &[NumberColumn]) -> Result<(), FileError> {
    write_whole(path, &columns_to_bytes(path, columns)?)
}

/// The columns of numbers of a Parquet file, in its order; columns of another kind are left out.
///
/// # Errors
/// [`FileError::Read`], and [`FileError::Table`] for what is no Parquet file.
pub fn read_columns(path: &Path) -> Result<Vec<NumberColumn>, FileError> {
    let table = open(path)?;
    let schema = table.schema().clone();
    let wanted: Vec<usize> =
        (0..schema.fields().len()).filter(|&i| is_number(schema.field(i).data_type())).collect();
    let mut columns: Vec<NumberColumn> = wanted
        .iter()
        .map(|&i| NumberColumn {
            name: schema.field(i).name().clone(),
            unit: schema.field(i).metadata().get(UNIT_KEY).cloned().unwrap_or_default(),
            values: Vec::new(),
        })
        .collect();
    each_batch(path, table, &wanted, |arrays| {
        for (column, array) in columns.iter_mut().zip(arrays) {
            extend(&mut column.values, array);
        }
    })?;
    Ok(columns)
}

fn is_number(kind: &DataType) -> bool {
    matches!(
        kind,
        DataType::Float64
            | DataType::Float32
            | DataType::Int64
            | DataType::Int32
            | DataType::UInt64
            | DataType::UInt32
            | DataType::Boolean
    )
}

/// Hands over some columns of a table, batch by batch, in the order of `wanted`, which rises.
pub(crate) fn each_batch(
    path: &Path,
    table: ParquetRecordBatchReaderBuilder<File>,
    wanted: &[usize],
    mut take: impl FnMut(&[ArrayRef]),
) -> Result<(), FileError> {
    let mask = ProjectionMask::roots(table.parquet_schema(), wanted.iter().copied());
    let reader = table.with_projection(mask).build().map_err(at(path))?;
    for batch in reader {
        let batch = batch.map_err(|error| at(path)(ParquetError::ArrowError(error.to_string())))?;
        take(batch.columns());
    }
    Ok(())
}

/// Appends the numbers of an array; null is NaN, a truth value 0 or 1.
pub(crate) fn extend(values: &mut Vec<f64>, array: &ArrayRef) {
    use arrow_array::types::{Float32Type, Int32Type, UInt32Type, UInt64Type};
    macro_rules! primitive {
        ($kind:ty) => {
            values.extend(
                array
                    .as_primitive::<$kind>()
                    .iter()
                    .map(|value| value.map_or(f64::NAN, |value| value as f64)),
            )
        };
    }
    match array.data_type() {
        DataType::Float64 => primitive!(Float64Type),
        DataType::Float32 => primitive!(Float32Type),
        DataType::Int64 => primitive!(Int64Type),
        DataType::Int32 => primitive!(Int32Type),
        DataType::UInt64 => primitive!(UInt64Type),
        DataType::UInt32 => primitive!(UInt32Type),
        DataType::Boolean => values.extend(
            array
                .as_boolean()
                .iter()
                .map(|value| value.map_or(f64::NAN, |value| f64::from(u8::from(value)))),
        ),
        _ => values.extend(std::iter::repeat_n(f64::NAN, array.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_columns_come_back_with_their_units() {
        let folder = std::env::temp_dir().join(format!("slipstick-parquet-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("columns.parquet");
        let column = |name: &str, unit: &str, values: &[f64]| NumberColumn {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: values.to_vec(),
        };
        let columns =
            [column("time_s", "s", &[0.0, 0.1, 0.2]), column("x", "", &[-0.0, 1.0 / 3.0, 1e-300])];
        write_columns(&path, &columns).unwrap();
        let read = read_columns(&path).unwrap();
        assert_eq!(read, columns);
        assert!(read[1].values[0].is_sign_negative());
        assert_eq!(columns_to_bytes(&path, &columns).unwrap(), std::fs::read(&path).unwrap());

        let unequal = [column("a", "", &[1.0]), column("b", "", &[1.0, 2.0])];
        assert!(matches!(columns_to_bytes(&path, &unequal), Err(FileError::Table { .. })));
        std::fs::write(&path, b"PAR1 and no more").unwrap();
        let error = read_columns(&path).unwrap_err().to_string();
        assert!(error.contains("columns.parquet: expected a Parquet file: "), "{error}");
        assert!(matches!(read_columns(&folder), Err(FileError::IsFolder { .. })));
    }
}
