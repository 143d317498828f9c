//! `Table`: columns that every library of data frames takes.

use std::borrow::Cow;
use std::sync::Arc;

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray,
};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};
use slipstick::error::similar;
use slipstick::table::{self, Cells, Column};
use slipstick_files::{read_table, to_csv, to_parquet, write_whole};

use crate::errors::{of_argument, of_file};
use crate::values::{path_in, text_in};

/// Columns as the package wraps them.
#[pyclass(module = "slipstick._core", frozen)]
pub struct Table(pub(crate) table::Table);

/// A column as it is pickled: name, unit, kind, cells.
type Parts<'py> = (String, String, &'static str, Bound<'py, PyAny>);

/// A unit as every library of units reads it: `m/s²` is in none an `s2`.
fn legible(unit: &str) -> Cow<'_, str> {
    let is_power = |at: usize| unit[..at].ends_with(|c: char| c.is_ascii_alphabetic());
    let powers = [("2", "²"), ("3", "³"), ("4", "⁴")];
    let place = powers.iter().find_map(|(digit, power)| {
        unit.find(digit).filter(|at| is_power(*at)).map(|at| (at, *power))
    });
    match place {
        Some((at, power)) => format!("{}{power}{}", &unit[..at], &unit[at + 1..]).into(),
        None => unit.into(),
    }
}

/// A column as Arrow has it; its unit stands in the field's metadata under `unit`.
fn arrow_column(column: &Column) -> (Field, ArrayRef) {
    let (kind, array): (DataType, ArrayRef) = match &column.cells {
        Cells::Numbers(cells) => {
            let cells = cells.iter().map(|x| (!x.is_nan()).then_some(*x));
            (DataType::Float64, Arc::new(cells.collect::<Float64Array>()))
        }
        Cells::Counts(cells) => {
            (DataType::Int64, Arc::new(cells.iter().copied().collect::<Int64Array>()))
        }
        Cells::Flags(cells) => {
            (DataType::Boolean, Arc::new(cells.iter().copied().collect::<BooleanArray>()))
        }
        Cells::Texts(cells) => {
            (DataType::Utf8, Arc::new(cells.iter().map(Some).collect::<StringArray>()))
        }
    };
    let field = Field::new(&column.name, kind, true);
    let field = match column.unit.as_str() {
        "" => field,
        unit => field.with_metadata([("unit".to_owned(), legible(unit).into_owned())]),
    };
    (field, array)
}

fn of_arrow(error: &ArrowError) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

#[pymethods]
impl Table {
    /// Names of the columns.
    #[getter]
    fn columns(&self) -> Vec<&str> {
        self.0.columns.iter().map(|column| column.name.as_str()).collect()
    }

    /// Units of the columns that have one.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let units = PyDict::new(py);
        for column in self.0.columns.iter().filter(|column| !column.unit.is_empty()) {
            units.set_item(&column.name, legible(&column.unit))?;
        }
        Ok(units)
    }

    fn __len__(&self) -> usize {
        self.0.rows()
    }

    /// A column: an array of doubles where it holds numbers, else a list.
    fn __getitem__<'py>(
        &self,
        py: Python<'py>,
        name: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let name: &str = &text_in("column", name)?;
        let column = self.0.columns.iter().find(|column| column.name == name);
        let column = column.ok_or_else(|| {
            let names = self.0.columns.iter().map(|column| column.name.as_str());
            let hint = similar(name, names).map(|near| format!("; nearest is {near:?}"));
            let hint = hint.unwrap_or_default();
            PyKeyError::new_err(format!("expected a column of the table, found {name:?}{hint}"))
        })?;
        Ok(match &column.cells {
            Cells::Numbers(cells) => cells.clone().into_pyarray(py).into_any(),
            Cells::Counts(cells) => PyList::new(py, cells)?.into_any(),
            Cells::Flags(cells) => PyList::new(py, cells)?.into_any(),
            Cells::Texts(cells) => PyList::new(py, cells)?.into_any(),
        })
    }

    /// Write the table as the text of a CSV file.
    fn to_csv(&self) -> String {
        to_csv(&self.0)
    }

    /// Write the table as a file, CSV or Parquet by the end of its name.
    fn write(&self, py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<()> {
        let path = path_in("path", path)?;
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let written = match ending.as_deref() {
            Some("csv") => write_whole(&path, to_csv(&self.0).as_bytes()),
            Some("parquet") => to_parquet(&path, &self.0).and_then(|of| write_whole(&path, &of)),
            _ => {
                let found = path.display().to_string();
                return Err(of_argument(
                    py,
                    "path",
                    "a name that ends in .csv or .parquet",
                    &found,
                ));
            }
        };
        written.map_err(|error| of_file(py, &error))
    }

    /// Read a table in CSV or Parquet.
    #[staticmethod]
    fn read(py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<Self> {
        let path = path_in("path", path)?;
        let read = py.detach(|| read_table(&[path]));
        read.map(|read| Self(read.table)).map_err(|error| of_file(py, &error))
    }

    /// The table as a stream of Arrow's C interface.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // A consumer may wish for other types; the interface lets a producer keep its own.
        drop(requested_schema);
        let (fields, arrays): (Vec<Field>, Vec<ArrayRef>) =
            self.0.columns.iter().map(arrow_column).unzip();
        let schema = Arc::new(Schema::new(fields));
        let batch = RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(|e| of_arrow(&e))?;
        let reader = RecordBatchIterator::new([Ok(batch)], schema);
        let stream = FFI_ArrowArrayStream::new(Box::new(reader));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Vec<Parts<'py>>,))> {
        let py = slf.py();
        let parts = slf.get().0.columns.iter().map(|column| {
            let (kind, cells) = match &column.cells {
                Cells::Numbers(cells) => ("numbers", cells.clone().into_pyarray(py).into_any()),
                Cells::Counts(cells) => ("counts", PyList::new(py, cells)?.into_any()),
                Cells::Flags(cells) => ("flags", PyList::new(py, cells)?.into_any()),
                Cells::Texts(cells) => ("texts", PyList::new(py, cells)?.into_any()),
            };
            Ok((column.name.clone(), column.unit.clone(), kind, cells))
        });
        let parts: Vec<Parts<'py>> = parts.collect::<PyResult<_>>()?;
        Ok((slf.get_type().getattr("_from_columns")?, (parts,)))
    }

    #[staticmethod]
    fn _from_columns(columns: Vec<(String, String, String, Bound<'_, PyAny>)>) -> PyResult<Self> {
        let columns = columns.into_iter().map(|(name, unit, kind, cells)| {
            let cells = match kind.as_str() {
                "numbers" => Cells::Numbers(
                    cells.extract::<PyReadonlyArray1<'_, f64>>()?.as_slice()?.to_vec(),
                ),
                "counts" => Cells::Counts(cells.extract()?),
                "flags" => Cells::Flags(cells.extract()?),
                _ => Cells::Texts(cells.extract()?),
            };
            Ok(Column { name, unit, cells })
        });
        Ok(Self(table::Table { columns: columns.collect::<PyResult<_>>()? }))
    }

    fn __eq__(&self, other: &Self) -> bool {
        // Bit by bit but for the payload of NaN, which is an empty cell.
        to_csv(&self.0) == to_csv(&other.0)
    }
}
