//! Tables: named columns of equal length, of numbers, counts, flags or texts.
//!
//! Studies and analyses over suites return them; files hold them as CSV and Parquet.

use std::borrow::Cow;

/// What the cells of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Numbers.
    Number,
    /// Whole numbers.
    Count,
    /// Yes or no.
    Flag,
    /// Texts.
    Text,
}

/// A column of a table without its cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its unit; empty where it has none, or where a file does not say.
    pub unit: String,
    /// What its cells are.
    pub kind: Kind,
    /// Whether a cell may be empty.
    pub optional: bool,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its unit; empty where it has none, or where a file does not say.
    pub unit: String,
    /// Its cells.
    pub cells: Cells,
}

/// The cells of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Whole numbers.
    Counts(Vec<Option<i64>>),
    /// Yes or no.
    Flags(Vec<Option<bool>>),
    /// Texts.
    Texts(Vec<String>),
}

/// Columns of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The columns in their order.
    pub columns: Vec<Column>,
}

/// A text as a cell of CSV that a spreadsheet shows and does not run: behind an apostrophe where it
/// begins as a formula does, with `=`, `+`, `-`, `@`, a tab or a line end, and is no number.
///
/// ```
/// use slipstick_dynamics::table::{from_cell, to_cell};
/// assert_eq!(to_cell("=1+1"), "'=1+1");
/// assert_eq!(to_cell("-1.5"), "-1.5");
/// assert_eq!(from_cell("'=1+1"), "=1+1");
/// ```
#[must_use]
pub fn to_cell(text: &str) -> Cow<'_, str> {
    let is_run = is_formula(text.trim_start_matches('\'')) && text.parse::<f64>().is_err();
    if is_run { format!("'{text}").into() } else { text.into() }
}

/// The text of a cell that [`to_cell`] wrote.
#[must_use]
pub fn from_cell(cell: &str) -> &str {
    match cell.strip_prefix('\'') {
        Some(text) if is_formula(text.trim_start_matches('\'')) => text,
        _ => cell,
    }
}

fn is_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n'])
}

impl Field {
    /// A column of numbers, some of which may be missing.
    #[must_use]
    pub fn number(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into(), kind: Kind::Number, optional: true }
    }

    /// A column of texts.
    #[must_use]
    pub fn text(name: impl Into<String>) -> Self {
        Self { name: name.into(), unit: String::new(), kind: Kind::Text, optional: false }
    }

    /// This field with a value in every cell.
    #[must_use]
    pub fn required(self) -> Self {
        Self { optional: false, ..self }
    }
}

impl Column {
    /// A column of numbers; NaN where there is none.
    #[must_use]
    pub fn numbers(name: &str, unit: &str, cells: Vec<f64>) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), cells: Cells::Numbers(cells) }
    }

    /// A column of texts.
    #[must_use]
    pub fn texts(name: &str, cells: Vec<String>) -> Self {
        Self { name: name.to_owned(), unit: String::new(), cells: Cells::Texts(cells) }
    }

    /// What it is without its cells.
    #[must_use]
    pub fn field(&self) -> Field {
        let (kind, optional) = match self.cells {
            Cells::Numbers(_) => (Kind::Number, true),
            Cells::Counts(_) => (Kind::Count, true),
            Cells::Flags(_) => (Kind::Flag, true),
            Cells::Texts(_) => (Kind::Text, false),
        };
        Field { name: self.name.clone(), unit: self.unit.clone(), kind, optional }
    }
}

impl Cells {
    /// No cells yet, of a kind.
    #[must_use]
    pub fn none(kind: Kind) -> Self {
        match kind {
            Kind::Number => Self::Numbers(Vec::new()),
            Kind::Count => Self::Counts(Vec::new()),
            Kind::Flag => Self::Flags(Vec::new()),
            Kind::Text => Self::Texts(Vec::new()),
        }
    }

    /// Numbers as cells of a kind: whole numbers as counts, 0 as no and any other as yes; NaN where
    /// there is none.
    ///
    /// Texts are made of no numbers: they stay numbers.
    #[must_use]
    pub fn of_numbers(kind: Kind, values: impl Iterator<Item = f64>) -> Self {
        let some = |value: f64| (!value.is_nan()).then_some(value);
        match kind {
            Kind::Number | Kind::Text => Self::Numbers(values.collect()),
            Kind::Count => Self::Counts(values.map(|v| some(v).map(|v| v as i64)).collect()),
            Kind::Flag => Self::Flags(values.map(|v| some(v).map(|v| v != 0.0)).collect()),
        }
    }

    /// The cells as numbers: NaN where there is none, 1 for yes and 0 for no; `None` for texts.
    #[must_use]
    pub fn to_numbers(&self) -> Option<Vec<f64>> {
        let flag = |flag: &Option<bool>| flag.map_or(f64::NAN, |flag| f64::from(u8::from(flag)));
        match self {
            Self::Numbers(cells) => Some(cells.clone()),
            Self::Counts(cells) => {
                Some(cells.iter().map(|count| count.map_or(f64::NAN, |n| n as f64)).collect())
            }
            Self::Flags(cells) => Some(cells.iter().map(flag).collect()),
            Self::Texts(_) => None,
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(cells) => cells.len(),
            Self::Counts(cells) => cells.len(),
            Self::Flags(cells) => cells.len(),
            Self::Texts(cells) => cells.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cells of some rows, in their order; a row that does not exist is left out.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> Self {
        fn of<T: Clone>(cells: &[T], rows: &[usize]) -> Vec<T> {
            rows.iter().filter_map(|&row| cells.get(row).cloned()).collect()
        }
        match self {
            Self::Numbers(cells) => Self::Numbers(of(cells, rows)),
            Self::Counts(cells) => Self::Counts(of(cells, rows)),
            Self::Flags(cells) => Self::Flags(of(cells, rows)),
            Self::Texts(cells) => Self::Texts(of(cells, rows)),
        }
    }

    /// Appends cells of the same kind; `false` where they are of another.
    #[must_use]
    pub fn append(&mut self, more: Self) -> bool {
        match (self, more) {
            (Self::Numbers(cells), Self::Numbers(more)) => cells.extend(more),
            (Self::Counts(cells), Self::Counts(more)) => cells.extend(more),
            (Self::Flags(cells), Self::Flags(more)) => cells.extend(more),
            (Self::Texts(cells), Self::Texts(more)) => cells.extend(more),
            _ => return false,
        }
        true
    }
}

impl Table {
    /// Adds a column of texts.
    pub fn texts(&mut self, name: &str, cells: Vec<String>) -> &mut Self {
        self.columns.push(Column::texts(name, cells));
        self
    }

    /// Adds a column of numbers in a unit (empty where they have none); NaN is an empty cell.
    pub fn numbers(&mut self, name: &str, unit: &str, cells: Vec<f64>) -> &mut Self {
        self.columns.push(Column::numbers(name, unit, cells));
        self
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.iter().map(|column| column.cells.len()).min().unwrap_or(0)
    }

    /// Some of its rows, in their order.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> Self {
        let column = |column: &Column| Column {
            cells: column.cells.select(rows),
            name: column.name.clone(),
            unit: column.unit.clone(),
        };
        Self { columns: self.columns.iter().map(column).collect() }
    }

    /// The column of a name, the first.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The texts of a column; `None` where there is none of that name, or it holds numbers.
    #[must_use]
    pub fn texts_of(&self, name: &str) -> Option<&[String]> {
        match &self.find(name)?.cells {
            Cells::Texts(cells) => Some(cells),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a spreadsheet would run stands behind an apostrophe, and is read back as it was.
    #[test]
    fn cells_that_are_formulas() {
        for (text, cell) in [
            ("=HYPERLINK(\"x\")", "'=HYPERLINK(\"x\")"),
            ("+cmd", "'+cmd"),
            ("-cmd", "'-cmd"),
            ("@sum", "'@sum"),
            ("\tx", "'\tx"),
            ("'=x", "''=x"),
            ("-1.5e3", "-1.5e3"),
            ("+2", "+2"),
            ("'x", "'x"),
            ("a=b", "a=b"),
            ("", ""),
        ] {
            assert_eq!(to_cell(text), cell);
            assert_eq!(from_cell(cell), text);
        }
    }

    #[test]
    fn columns_are_found_by_name_and_kind() {
        let mut table = Table::default();
        table
            .numbers("level", "m/s2", vec![1.0, f64::NAN])
            .texts("record", vec!["a".to_owned(), "b".to_owned()]);
        assert_eq!(table.rows(), 2);
        assert_eq!(table.texts_of("record").unwrap(), ["a", "b"]);
        assert_eq!(table.texts_of("level"), None);
        assert_eq!(table.find("level").unwrap().field(), Field::number("level", "m/s2"));
        assert_eq!(table.find("Level"), None);
        assert_eq!(Table::default().rows(), 0);
        let last = table.select(&[1]);
        assert_eq!((last.rows(), last.texts_of("record").unwrap()), (1, &["b".to_owned()][..]));
        assert_eq!(last.find("level").unwrap().unit, "m/s2");
    }

    #[test]
    fn numbers_as_cells_of_each_kind_and_back() {
        let values = [0.0, 3.0, f64::NAN];
        let cells = |kind| Cells::of_numbers(kind, values.into_iter());
        assert_eq!(cells(Kind::Count), Cells::Counts(vec![Some(0), Some(3), None]));
        assert_eq!(cells(Kind::Flag), Cells::Flags(vec![Some(false), Some(true), None]));
        for (kind, three) in [(Kind::Number, 3.0), (Kind::Count, 3.0), (Kind::Flag, 1.0)] {
            let back = cells(kind).to_numbers().unwrap();
            assert!(back[0] == 0.0 && back[1] == three && back[2].is_nan(), "{kind:?}");
        }
        let mut cells = cells(Kind::Number);
        assert!(cells.append(Cells::Numbers(vec![1.0])) && cells.len() == 4);
        assert!(!cells.append(Cells::Texts(vec![String::new()])) && cells.len() == 4);
    }
}
