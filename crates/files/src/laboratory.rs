//! Measured files and their mappings.

use std::path::Path;

use slipstick::error::{ChoiceError, InputError};
use slipstick::hash::sha256_hex;
use slipstick::input::{MAX_TEXT_BYTES, Mapping};
use slipstick::laboratory::measured::{Measured, MeasuredError};
use slipstick::laboratory::two_clocks::read_two;
use slipstick::record::{Column, Columns};
use slipstick::table;

use crate::error::FileError;
use crate::load::SourceFile;
use crate::parquet;
use crate::read::{read_at_most, read_bytes};

/// Why a measured file is of no use.
#[derive(Debug, thiserror::Error)]
pub enum LaboratoryError {
    /// It cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Its content or its mapping.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// The mapping.
    #[error(transparent)]
    Mapping(#[from] InputError),
    /// What is said of columns.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
}

/// A text file that was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFile {
    /// Its path and hash.
    pub source: SourceFile,
    /// All of it.
    pub text: String,
}

/// Reads what is said of columns: `QUANTITY=COLUMN`, and the path of a mapping file that says more.
///
/// # Errors
/// [`LaboratoryError`] where the file cannot be read, for a second file, and for faults of either.
pub fn read_mapping(said: &[String]) -> Result<(Mapping, Option<TextFile>), LaboratoryError> {
    let (columns, files): (Vec<String>, Vec<String>) =
        said.iter().cloned().partition(|text| text.contains('='));
    let [path, more @ ..] = files.as_slice() else {
        return Ok((Mapping::parse(None, &columns)?, None));
    };
    if let Some(found) = more.first() {
        let (what, expected) =
            ("mapping".to_owned(), "one mapping file, or QUANTITY=COLUMN".to_owned());
        let found = format!("{found:?}");
        return Err(ChoiceError { what, expected, found, nearest: None }.into());
    }
    let bytes = read_at_most(Path::new(path), MAX_TEXT_BYTES as u64)?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let mapping = Mapping::parse(Some((path, &text)), &columns)?;
    let source = SourceFile { path: path.into(), sha256: sha256_hex(&bytes) };
    Ok((mapping, Some(TextFile { source, text })))
}

/// Reads a measured file: text in columns, or Parquet; or two files of text of one cyclic test, displacement and force
/// with clocks of their own, as `FIRST+SECOND`.
///
/// # Errors
/// [`LaboratoryError`] where it cannot be read or understood.
pub fn read_measured(
    path: &Path,
    mapping: &Mapping,
) -> Result<(Measured, SourceFile), LaboratoryError> {
    let name = path.display().to_string();
    if let Some((first, second)) = name.split_once('+').filter(|_| !path.exists()) {
        let [a, b] = [first, second].map(|part| read_bytes(Path::new(part)));
        let (a, b) = (a?, b?);
        let measured = read_two([(first, &a), (second, &b)], mapping)?;
        let sha256 = sha256_hex(&[a, b].concat());
        return Ok((measured, SourceFile { path: path.to_owned(), sha256 }));
    }
    let bytes = read_bytes(path)?;
    let measured = if bytes.starts_with(b"PAR1") {
        let columns = parquet::read_columns(path)?;
        let columns = columns.into_iter().filter_map(measured_column).collect();
        let columns = Columns::new(&name, columns).map_err(MeasuredError::from)?;
        Measured::of_columns(columns, mapping)?
    } else {
        Measured::read(&name, &bytes, mapping)?
    };
    Ok((measured, SourceFile { path: path.to_owned(), sha256: sha256_hex(&bytes) }))
}

/// A column of numbers whose name states its unit, which in Parquet may stand beside it.
fn measured_column(column: table::Column) -> Option<Column> {
    let values = column.cells.to_numbers()?;
    let table::Column { name, unit, .. } = column;
    let suffix = format!("_{}", unit.replace('/', "_per_").replace(' ', "_"));
    let states_unit = unit.is_empty() || name.ends_with(']') || name.ends_with(&suffix);
    let name = if states_unit { name } else { format!("{name} [{unit}]") };
    Some(Column { is_time: false, name, values })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parquet::write_columns;

    /// The same numbers as text and as Parquet, its units in names or beside them.
    #[test]
    fn parquet_is_read_as_text_is() {
        let folder = std::env::temp_dir().join(format!("slipstick-lab-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let (text, table) = (folder.join("a.csv"), folder.join("a.parquet"));
        std::fs::write(
            &text,
            "time_s,A0 [g],sliding_displacement [mm]\n0,0,1\n0.01,0.5,2\n0.02,-0.25,1.5\n",
        )
        .unwrap();
        let numbers = table::Column::numbers;
        let mut columns = vec![
            numbers("time_s", "s", vec![0.0, 0.01, 0.02]),
            numbers("A0", "g", vec![0.0, 0.5, -0.25]),
            numbers("sliding_displacement [mm]", "", vec![1.0, 2.0, 1.5]),
            table::Column::texts("remark", vec![String::new(); 3]),
        ];
        write_columns(&table, &columns).unwrap();
        let mapping = Mapping::parse(None, &["table_acceleration=A0".to_owned()]).unwrap();
        let (expected, _) = read_measured(&text, &mapping).unwrap();
        let (found, source) = read_measured(&table, &mapping).unwrap();
        assert_eq!(found.series, expected.series);
        assert_eq!(source.sha256, sha256_hex(&std::fs::read(&table).unwrap()));

        columns[1] = numbers("A0", "g", vec![0.0, 0.5, f64::NAN]);
        write_columns(&table, &columns).unwrap();
        let error = read_measured(&table, &mapping).unwrap_err().to_string();
        assert!(error.contains("a.parquet:3:2: expected a number in \"A0 [g]\", found"), "{error}");
        std::fs::write(&table, b"PAR1, and no more").unwrap();
        assert!(read_measured(&table, &mapping).is_err());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
