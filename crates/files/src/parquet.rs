//! Tables in Parquet: columns with their units in, columns out.
//!
//! The same values give the same bytes: nothing in a file says when, where or by which machine it
//! was written. Compression is snappy, which every reader of Parquet knows. The unit of a column
//! `NAME` stands in the metadata of the file under `unit.NAME`.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, SortOrder, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::{KeyValue, ParquetMetaData, ParquetMetaDataReader};
use parquet::file::properties::WriterProperties;
use parquet::file::serialized_reader::SerializedPageReader;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{ColumnDescriptor, Type as SchemaType};

use slipstick::table::{Cells, Column, Field, Kind};

use crate::error::FileError;
use crate::write::write_whole;

/// What stands before a column's name in the key of its unit.
pub const UNIT_KEY: &str = "unit.";

fn schema(field: &Field) -> Result<SchemaType, ParquetError> {
    let (physical, logical) = match field.kind {
        Kind::Number => (Type::DOUBLE, None),
        Kind::Count => (Type::INT64, None),
        Kind::Flag => (Type::BOOLEAN, None),
        Kind::Text => (Type::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let repetition = if field.optional { Repetition::OPTIONAL } else { Repetition::REQUIRED };
    SchemaType::primitive_type_builder(&field.name, physical)
        .with_repetition(repetition)
        .with_logical_type(logical)
        .build()
}

/// A file of row groups in the making.
pub(crate) struct TableWriter<W: Write + Send> {
    writer: SerializedFileWriter<W>,
}

impl<W: Write + Send> TableWriter<W> {
    /// A table without rows; `notes` become metadata of the file.
    pub(crate) fn new(
        to: W,
        fields: &[Field],
        notes: &[(&str, String)],
    ) -> Result<Self, ParquetError> {
        let units = fields.iter().filter(|field| !field.unit.is_empty());
        let units = units.map(|f| KeyValue::new(format!("{UNIT_KEY}{}", f.name), f.unit.clone()));
        let notes = notes.iter().map(|(key, text)| KeyValue::new((*key).to_owned(), text.clone()));
        let properties = WriterProperties::builder()
            .set_created_by(concat!("slipstick ", env!("CARGO_PKG_VERSION")).to_owned())
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(notes.chain(units).collect()))
            .build();
        let columns = fields.iter().map(|field| Ok(Arc::new(schema(field)?)));
        let columns = columns.collect::<Result<Vec<_>, ParquetError>>()?;
        let schema = SchemaType::group_type_builder("table").with_fields(columns).build()?;
        let writer = SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties))?;
        Ok(Self { writer })
    }

    /// Adds rows as a row group of their own.
    pub(crate) fn row_group<'a>(
        &mut self,
        columns: impl IntoIterator<Item = &'a Cells>,
    ) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        for cells in columns {
            let Some(mut column) = group.next_column()? else {
                return Err(ParquetError::General("more columns than the schema has".to_owned()));
            };
            match cells {
                Cells::Numbers(cells) => {
                    let number = |value: &f64| (!value.is_nan()).then_some(*value);
                    write::<DoubleType>(&mut column, cells.iter().map(number))?;
                }
                Cells::Counts(cells) => write::<Int64Type>(&mut column, cells.iter().copied())?,
                Cells::Flags(cells) => write::<BoolType>(&mut column, cells.iter().copied())?,
                Cells::Texts(cells) => {
                    let bytes = |text: &String| Some(ByteArray::from(text.as_str()));
                    write::<ByteArrayType>(&mut column, cells.iter().map(bytes))?;
                }
            }
            column.close()?;
        }
        group.close()?;
        Ok(())
    }

    /// Ends the file and gives back what it was written to.
    pub(crate) fn finish(self) -> Result<W, ParquetError> {
        self.writer.into_inner()
    }
}

/// Writes all cells of a column.
fn write<T: DataType>(
    column: &mut SerializedColumnWriter<'_>,
    cells: impl ExactSizeIterator<Item = Option<T::T>>,
) -> Result<(), ParquetError> {
    let rows = cells.len();
    let mut levels = Vec::with_capacity(rows);
    let mut values = Vec::with_capacity(rows);
    for cell in cells {
        levels.push(i16::from(cell.is_some()));
        values.extend(cell);
    }
    let column = column.typed::<T>();
    let optional = column.get_descriptor().max_def_level() > 0;
    if !optional && values.len() < rows {
        return Err(ParquetError::General("an empty cell where there must be a value".to_owned()));
    }
    column.write_batch(&values, optional.then_some(&levels[..]), None)?;
    Ok(())
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

/// A table in a file, with what stands about its columns and rows: that is read once.
#[derive(Clone, Debug)]
pub(crate) struct ParquetTable {
    pub(crate) path: PathBuf,
    metadata: Arc<ParquetMetaData>,
    /// The columns that are numbers or texts, and where they stand among all.
    fields: Vec<Field>,
    places: Vec<usize>,
}

impl ParquetTable {
    /// # Errors
    /// [`FileError::Read`], and [`FileError::Table`] for what is no Parquet file.
    pub(crate) fn of(path: &Path) -> Result<Self, FileError> {
        let failed = |source| FileError::Read { path: path.to_owned(), source };
        let file = File::open(path).map_err(failed)?;
        if file.metadata().map_err(failed)?.is_dir() {
            return Err(FileError::IsFolder { path: path.to_owned() });
        }
        let metadata = ParquetMetaDataReader::new().parse_and_finish(&file).map_err(at(path))?;
        let mut table = Self {
            path: path.to_owned(),
            metadata: Arc::new(metadata),
            fields: Vec::new(),
            places: Vec::new(),
        };
        let metadata = table.metadata.clone();
        for (place, column) in metadata.file_metadata().schema_descr().columns().iter().enumerate()
        {
            let Some(kind) = kind_of(column) else { continue };
            let name = column.name().to_owned();
            let unit = table.note(&format!("{UNIT_KEY}{name}")).unwrap_or_default().to_owned();
            let optional = column.max_def_level() > 0;
            table.fields.push(Field { name, unit, kind, optional });
            table.places.push(place);
        }
        Ok(table)
    }

    /// The columns of numbers and texts; others are left out.
    pub(crate) fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// A note in the metadata of the file.
    pub(crate) fn note(&self, key: &str) -> Option<&str> {
        let notes = self.metadata.file_metadata().key_value_metadata()?;
        notes.iter().find(|note| note.key == key)?.value.as_deref()
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        usize::try_from(self.metadata.file_metadata().num_rows()).unwrap_or(0)
    }

    /// Its columns, of no more rows than the first `most`.
    ///
    /// # Errors
    /// As [`ParquetTable::cells`].
    pub(crate) fn columns(&self, most: usize) -> Result<Vec<Column>, FileError> {
        let column = |(index, field): (usize, &Field)| {
            let (name, unit) = (field.name.clone(), field.unit.clone());
            Ok(Column { name, unit, cells: self.first_cells(index, most)? })
        };
        self.fields.iter().enumerate().map(column).collect()
    }

    /// All cells of one of [`ParquetTable::fields`].
    ///
    /// # Errors
    /// [`FileError::Read`], and [`FileError::Table`] for a column that is damaged.
    pub(crate) fn cells(&self, index: usize) -> Result<Cells, FileError> {
        self.first_cells(index, usize::MAX)
    }

    fn first_cells(&self, index: usize, most: usize) -> Result<Cells, FileError> {
        let failed = |source| FileError::Read { path: self.path.clone(), source };
        let file = Arc::new(File::open(&self.path).map_err(failed)?);
        let (Some(field), Some(&place)) = (self.fields.get(index), self.places.get(index)) else {
            let reason = format!("it has {} columns of numbers and texts", self.fields.len());
            return Err(FileError::Table { path: self.path.clone(), reason });
        };
        let mut cells = match field.kind {
            Kind::Number => Cells::Numbers(Vec::new()),
            Kind::Count => Cells::Counts(Vec::new()),
            Kind::Flag => Cells::Flags(Vec::new()),
            Kind::Text => Cells::Texts(Vec::new()),
        };
        let mut left = most;
        for group in self.metadata.row_groups() {
            let rows = usize::try_from(group.num_rows()).unwrap_or(0);
            let wanted = rows.min(left);
            let mut read = || {
                let chunk = group.column(place);
                let pages = SerializedPageReader::new(file.clone(), chunk, rows, None)?;
                let reader = get_column_reader(chunk.column_descr_ptr(), Box::new(pages));
                read_into(&mut cells, reader, chunk.column_descr(), wanted)
            };
            read().map_err(at(&self.path))?;
            left -= wanted;
        }
        Ok(cells)
    }
}

/// What a column holds; `None` for what is neither a number nor text, and for lists and groups.
fn kind_of(column: &ColumnDescriptor) -> Option<Kind> {
    use ConvertedType as C;
    if column.max_rep_level() > 0 || column.path().parts().len() > 1 {
        return None;
    }
    let is_text = matches!(column.converted_type(), C::UTF8 | C::ENUM | C::JSON);
    let is_plain = matches!(column.logical_type_ref(), None | Some(LogicalType::Integer(_)))
        && matches!(
            column.converted_type(),
            C::NONE
                | C::INT_8
                | C::INT_16
                | C::INT_32
                | C::INT_64
                | C::UINT_8
                | C::UINT_16
                | C::UINT_32
                | C::UINT_64
        );
    match column.physical_type() {
        Type::BOOLEAN => Some(Kind::Flag),
        Type::FLOAT | Type::DOUBLE => Some(Kind::Number),
        // Unsigned words of 64 bits may be larger than any count.
        Type::INT64 if is_plain && column.sort_order() == SortOrder::UNSIGNED => Some(Kind::Number),
        Type::INT32 | Type::INT64 if is_plain => Some(Kind::Count),
        Type::BYTE_ARRAY if is_text => Some(Kind::Text),
        _ => None,
    }
}

/// Appends the first cells of one row group.
fn read_into(
    cells: &mut Cells,
    reader: ColumnReader,
    column: &ColumnDescriptor,
    rows: usize,
) -> Result<(), ParquetError> {
    use ColumnReader as R;
    let unsigned = column.sort_order() == SortOrder::UNSIGNED;
    let optional = column.max_def_level() > 0;
    match (cells, reader) {
        (Cells::Numbers(cells), R::DoubleColumnReader(reader)) => {
            read(reader, optional, rows, |value| cells.push(value.unwrap_or(f64::NAN)))
        }
        (Cells::Numbers(cells), R::FloatColumnReader(reader)) => {
            read(reader, optional, rows, |value| cells.push(value.map_or(f64::NAN, f64::from)))
        }
        (Cells::Numbers(cells), R::Int64ColumnReader(reader)) => {
            let number = |value: Option<i64>| value.map_or(f64::NAN, |v| v.cast_unsigned() as f64);
            read(reader, optional, rows, |value| cells.push(number(value)))
        }
        (Cells::Counts(cells), R::Int64ColumnReader(reader)) => {
            read(reader, optional, rows, |value| cells.push(value))
        }
        (Cells::Counts(cells), R::Int32ColumnReader(reader)) => {
            let count = |v: i32| if unsigned { v.cast_unsigned().into() } else { v.into() };
            read(reader, optional, rows, |value| cells.push(value.map(count)))
        }
        (Cells::Flags(cells), R::BoolColumnReader(reader)) => {
            read(reader, optional, rows, |value| cells.push(value))
        }
        (Cells::Texts(cells), R::ByteArrayColumnReader(reader)) => {
            let text = |bytes: ByteArray| String::from_utf8_lossy(bytes.data()).into_owned();
            read(reader, optional, rows, |value| cells.push(value.map(text).unwrap_or_default()))
        }
        _ => Err(ParquetError::General("its columns are of another kind than it says".to_owned())),
    }
}

/// Hands over so many cells, one by one.
fn read<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    optional: bool,
    rows: usize,
    mut take: impl FnMut(Option<T::T>),
) -> Result<(), ParquetError> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    let (found, ..) = reader.read_records(rows, Some(&mut levels), None, &mut values)?;
    if found != rows {
        return Err(ParquetError::General(format!("{rows} rows announced, {found} found")));
    }
    if optional {
        let mut values = values.into_iter();
        levels.iter().for_each(|level| take(if *level > 0 { values.next() } else { None }));
    } else {
        values.into_iter().for_each(|value| take(Some(value)));
    }
    Ok(())
}

/// Columns of equal length as the bytes of a Parquet file.
///
/// # Errors
/// [`FileError::Table`] for columns of different lengths; `path` is for the message.
pub fn columns_to_bytes(path: &Path, columns: &[Column]) -> Result<Vec<u8>, FileError> {
    columns_with_notes(path, columns, &[])
}

/// The same with `notes` as metadata of the file.
///
/// # Errors
/// As [`columns_to_bytes`].
pub(crate) fn columns_with_notes(
    path: &Path,
    columns: &[Column],
    notes: &[(&str, String)],
) -> Result<Vec<u8>, FileError> {
    let fields: Vec<Field> = columns.iter().map(Column::field).collect();
    let bytes = || -> Result<Vec<u8>, ParquetError> {
        let mut table = TableWriter::new(Vec::new(), &fields, notes)?;
        table.row_group(columns.iter().map(|column| &column.cells))?;
        table.finish()
    };
    bytes().map_err(at(path))
}

/// Writes columns of equal length as a Parquet file, whole or not at all.
///
/// # Errors
/// As [`columns_to_bytes`] and [`write_whole`].
pub fn write_columns(path: &Path, columns: &[Column]) -> Result<(), FileError> {
    write_whole(path, &columns_to_bytes(path, columns)?)
}

/// The columns of numbers and texts of a Parquet file, in its order; others are left out.
///
/// # Errors
/// [`FileError::Read`], and [`FileError::Table`] for what is no Parquet file.
pub fn read_columns(path: &Path) -> Result<Vec<Column>, FileError> {
    ParquetTable::of(path)?.columns(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_come_back_with_their_units() {
        let folder = std::env::temp_dir().join(format!("slipstick-parquet-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("columns.parquet");
        let column =
            |name: &str, cells| Column { name: name.to_owned(), unit: String::new(), cells };
        let columns = [
            Column::numbers("time_s", "s", vec![0.0, 0.1, 0.2]),
            Column::numbers("x", "", vec![-0.0, 1.0 / 3.0, 1e-300]),
            Column::texts("record", vec!["a".to_owned(), String::new(), "Ω, \"b\"".to_owned()]),
            column("count", Cells::Counts(vec![Some(-1), None, Some(i64::MAX)])),
            column("flag", Cells::Flags(vec![None, Some(true), Some(false)])),
        ];
        write_columns(&path, &columns).unwrap();
        let read = read_columns(&path).unwrap();
        assert_eq!(read, columns);
        let Cells::Numbers(x) = &read[1].cells else { panic!("numbers") };
        assert!(x[0].is_sign_negative());
        assert_eq!(read[4].cells.to_numbers().unwrap()[1..], [1.0, 0.0]);
        assert_eq!(columns_to_bytes(&path, &columns).unwrap(), std::fs::read(&path).unwrap());

        let unequal =
            [Column::numbers("a", "", vec![1.0]), Column::numbers("b", "", vec![1.0, 2.0])];
        assert!(matches!(columns_to_bytes(&path, &unequal), Err(FileError::Table { .. })));
        std::fs::write(&path, b"PAR1 and no more").unwrap();
        let error = read_columns(&path).unwrap_err().to_string();
        assert!(error.contains("columns.parquet: expected a Parquet file: "), "{error}");
        assert!(matches!(read_columns(&folder), Err(FileError::IsFolder { .. })));
    }

    #[test]
    fn the_first_rows_of_several_groups() {
        let path =
            std::env::temp_dir().join(format!("slipstick-first-{}.parquet", std::process::id()));
        let x = |from: i32, to: i32| Column::numbers("x", "m", (from..to).map(f64::from).collect());
        let file = File::create(&path).unwrap();
        let mut table = TableWriter::new(file, &[x(0, 1).field()], &[]).unwrap();
        table.row_group([&x(0, 7).cells]).unwrap();
        table.row_group([&x(7, 10).cells]).unwrap();
        table.finish().unwrap();
        let table = ParquetTable::of(&path).unwrap();
        assert_eq!(table.rows(), 10);
        for most in [0, 3, 7, 9, 10] {
            assert_eq!(table.columns(most).unwrap(), [x(0, most as i32)]);
        }
        assert_eq!(read_columns(&path).unwrap(), [x(0, 10)]);
        std::fs::remove_file(&path).unwrap();
    }

    /// Missing numbers are empty cells, as other readers show them.
    #[test]
    fn numbers_may_be_missing() {
        let path =
            std::env::temp_dir().join(format!("slipstick-nan-{}.parquet", std::process::id()));
        let numbers: Vec<f64> =
            (0..5000).map(|i| if i % 7 == 0 { f64::NAN } else { f64::from(i).sqrt() }).collect();
        write_columns(&path, &[Column::numbers("x", "m", numbers.clone())]).unwrap();
        let read = read_columns(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read[0].cells.to_numbers().unwrap()), bits(&numbers));
    }
}
