//! Columns of a table asked for by name.

use std::collections::HashMap;

use crate::assessment::{AssessmentError, ChoiceError, refuse};
use crate::error::{CellError, UnitError, similar};
use crate::study::cases::HOLDS;
use crate::table::{Cells, Column, Table};
use crate::units::{Dimension, Unit, parse_unit};

/// Columns that counts and capacities are made of.
const KNOWN: [&str; 5] = ["level", "exceeded", "runs", "capacity", "reached"];

/// A table whose columns are asked for by name.
#[derive(Clone, Copy)]
pub(super) struct Columns<'a> {
    pub(super) table: &'a Table,
    pub(super) source_name: &'a str,
}

/// The record of each row, numbered from 0.
#[derive(Clone, Debug)]
pub(super) struct Records {
    pub(super) of_row: Vec<usize>,
    pub(super) count: usize,
}

impl Records {
    /// Numbers in the order in which records first occur.
    pub(super) fn numbered<K: core::hash::Hash + Eq>(keys: impl Iterator<Item = K>) -> Self {
        let mut known: HashMap<K, usize> = HashMap::new();
        let of_row = keys
            .map(|key| {
                let next = known.len();
                *known.entry(key).or_insert(next)
            })
            .collect();
        Self { of_row, count: known.len() }
    }
}

impl<'a> Columns<'a> {
    pub(super) fn has(self, name: &str) -> bool {
        self.table.find(name).is_some()
    }

    /// The column of an intensity, whose name may end in its unit: `level`, `level [g]`, `level_g`.
    pub(super) fn intensity(self, name: &str) -> Option<&'a Column> {
        self.table.find(name).or_else(|| {
            self.table
                .columns
                .iter()
                .find(|column| split_unit(&column.name).is_some_and(|(base, _)| base == name))
        })
    }

    /// The unit of a column: of its name, of its table, or of the column `measure_unit`.
    pub(super) fn unit(self, name: &str) -> Option<String> {
        if let Some((_, unit)) = split_unit(name) {
            return Some(unit.name().to_owned());
        }
        let column = self.table.find(name)?;
        if !column.unit.is_empty() {
            return Some(column.unit.clone());
        }
        let of_levels = matches!(name, "level" | "capacity");
        self.first_text("measure_unit").filter(|_| of_levels)
    }

    /// The error for a column that is not there, with the nearest that is; where none is near, that of a column whose
    /// name is nearly one of those that a fragility is made of.
    pub(super) fn lacking(self, what: &str, name: &str) -> AssessmentError {
        let names = || self.table.columns.iter().map(|column| column.name.as_str());
        let nearest = similar(name, names());
        let missing = || KNOWN.into_iter().filter(|known| !self.has(known));
        let meant = |column: &str| Some((column.to_owned(), similar(column, missing())?));
        let misnamed = names().filter(|column| !KNOWN.contains(column)).find_map(meant);
        let (what, expected, found, nearest) = match misnamed.filter(|_| nearest.is_none()) {
            Some((column, meant)) => {
                let expected = format!("a column among {}, or a demand", KNOWN.join(", "));
                ("SOURCE", expected, column, Some(meant))
            }
            None => (what, format!("a column of {}", self.source_name), name.to_owned(), nearest),
        };
        let (what, found) = (what.to_owned(), format!("{found:?}"));
        AssessmentError::Choice(ChoiceError { what, expected, found, nearest })
    }

    /// The record of each row, where the table says it.
    pub(super) fn records(self) -> Option<Records> {
        Some(Records::numbered(self.table.texts_of("record")?.iter()))
    }

    /// What the runs of one cluster share: the pair of components, one earthquake's, or else the record; its
    /// name and that of each row.
    pub(super) fn clusters(self) -> Option<(&'static str, Records)> {
        let records = self.table.texts_of("record");
        let Some(pairs) = self.table.texts_of("pair") else {
            return records.map(|records| ("record", Records::numbered(records.iter())));
        };
        // A row without a pair is a record of its own.
        let key = |row: usize| match &pairs[row][..] {
            "" => ("record", records.map_or("", |records| &records[row][..])),
            pair => ("pair", pair),
        };
        let of_pairs = pairs.iter().any(|pair| !pair.is_empty());
        let name = if of_pairs { "pair" } else { "record" };
        (of_pairs || records.is_some())
            .then(|| (name, Records::numbered((0..pairs.len()).map(key))))
    }

    /// A cell of a column of texts.
    pub(super) fn text(self, name: &str, row: usize) -> Option<&'a str> {
        Some(self.table.texts_of(name)?.get(row)?)
    }

    /// What the run of a row is called: its record where the table says it.
    pub(super) fn run(self, row: usize) -> String {
        self.text("record", row).map_or_else(|| format!("row {row}"), str::to_owned)
    }

    /// The first cell of a column of texts.
    pub(super) fn first_text(self, name: &str) -> Option<String> {
        self.table.texts_of(name)?.first().filter(|text| !text.is_empty()).cloned()
    }

    /// A column of numbers, none of them missing.
    pub(super) fn numbers(self, name: &str) -> Result<Vec<f64>, AssessmentError> {
        let values = self.numbers_or_nan(name)?;
        match values.iter().position(|value| value.is_nan()) {
            None => Ok(values),
            Some(row) => Err(not_a_number(row, name, "nothing".to_owned())),
        }
    }

    /// A column of numbers, written as such or as texts; NaN where a cell is empty.
    pub(super) fn numbers_or_nan(self, name: &str) -> Result<Vec<f64>, AssessmentError> {
        let texts = match self.table.find(name) {
            None => return Err(self.lacking("SOURCE", name)),
            Some(Column { cells: Cells::Texts(texts), .. }) => texts,
            Some(column) => return Ok(column.cells.to_numbers().unwrap_or_default()),
        };
        let number = |(row, text): (usize, &String)| match text.trim() {
            "" => Ok(f64::NAN),
            text if text.eq_ignore_ascii_case("true") => Ok(1.0),
            text if text.eq_ignore_ascii_case("false") => Ok(0.0),
            text => text.parse::<f64>().ok().filter(|v| !v.is_nan()).ok_or_else(|| {
                let shown: String = text.chars().take(40).collect();
                not_a_number(row, name, format!("{shown:?}"))
            }),
        };
        texts.iter().enumerate().map(number).collect()
    }

    /// Whether the check confirms the run of each row: 1 where it does, 0 where it does not, NaN where it was not
    /// asked; none where the table has no such column of flags.
    pub(super) fn holds(self) -> Option<Vec<f64>> {
        let holds = self.numbers_or_nan(HOLDS).ok()?;
        let is_flag = |flag: &f64| flag.is_nan() || *flag == 0.0 || *flag == 1.0;
        holds.iter().all(is_flag).then_some(holds)
    }

    /// A column of whole numbers ≥ 0.
    pub(super) fn counts(self, name: &str) -> Result<Vec<u64>, AssessmentError> {
        let whole = |value: f64| {
            if (0.0..1e15).contains(&value) && value.fract() == 0.0 {
                return Ok(value as u64);
            }
            Err(refuse(name, "whole numbers ≥ 0", value.to_string()))
        };
        self.numbers(name)?.into_iter().map(whole).collect()
    }
}

fn not_a_number(row: usize, name: &str, found: String) -> AssessmentError {
    let expected = format!("a number in {name}");
    AssessmentError::Cell(CellError { row, column: name.to_owned(), expected, found })
}

/// Name and unit of a column such as `level [g]`, `level_g` or `level_m_per_s2`.
fn split_unit(name: &str) -> Option<(&str, &'static Unit)> {
    if let Some((base, unit)) = name.split_once('[') {
        let unit = unit.trim().strip_suffix(']')?;
        return Some((base.trim(), any_unit(unit).ok()?.1));
    }
    ["level", "capacity"].into_iter().find_map(|base| {
        let unit = name.strip_prefix(base)?.strip_prefix('_')?;
        Some((base, any_unit(&unit.replace("_per_", "/")).ok()?.1))
    })
}

/// A unit of any dimension by its name.
pub(super) fn any_unit(name: &str) -> Result<(Dimension, &'static Unit), UnitError> {
    let of = |dimension| parse_unit(name, dimension).ok().map(|unit| (dimension, unit));
    match Dimension::ALL.into_iter().find_map(of) {
        Some(found) => Ok(found),
        None => {
            parse_unit(name, Dimension::Acceleration).map(|unit| (Dimension::Acceleration, unit))
        }
    }
}
