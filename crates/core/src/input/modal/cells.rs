//! Exported tables as cells that know where they stand: title, names of columns, units, rows.

use super::super::tree::{SourceSpan, Sources};
use crate::error::{InputError, cut};
use crate::record::{cell_ranges, separator_of};

/// A cell and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Cell<'a> {
    pub text: &'a str,
    pub spot: SourceSpan,
}

/// A column: its name without spaces, in lower case, and its unit, empty where there is none.
#[derive(Clone, Debug)]
pub(super) struct Column<'a> {
    pub name: String,
    pub unit: &'a str,
    pub spot: SourceSpan,
}

/// One table of a file.
#[derive(Debug)]
pub(super) struct Exported<'a> {
    /// What stands behind `TABLE:`.
    pub title: Option<&'a str>,
    pub spot: SourceSpan,
    pub columns: Vec<Column<'a>>,
    pub rows: Vec<Vec<Cell<'a>>>,
    /// Whether decimals may follow a comma.
    decimal_comma: bool,
}

/// All tables of a text. A line `TABLE: …` begins one; the first line below it has the names, the next the units,
/// unless it begins the rows.
pub(super) fn tables<'a>(
    sources: &Sources,
    source: usize,
    text: &'a str,
) -> Result<Vec<Exported<'a>>, InputError> {
    let mut all: Vec<Exported<'a>> = Vec::new();
    let (mut title, mut separator) = (None, b',');
    let mut at = 0;
    for whole in text.split_inclusive('\n') {
        let from = at;
        at += whole.len();
        let line = whole.trim_end_matches(['\r', '\n']);
        let bare = line.trim_start_matches('\u{feff}');
        let start = from + line.len() - bare.len();
        if bare.trim_matches(|c: char| c.is_whitespace() || ",;".contains(c)).is_empty() {
            continue;
        }
        if bare.trim_start().starts_with('#') {
            continue;
        }
        if let Some(name) = title_of(bare) {
            title = Some((name, SourceSpan { source, span: start..start + bare.len() }));
            continue;
        }
        let is_header = title.is_some() || all.is_empty();
        if is_header {
            separator = separator_of(bare.as_bytes());
        }
        let mut cells = split(bare, start, separator, source);
        // A spreadsheet pads short tables; a column without a name has nothing to be read.
        let most = if is_header { 0 } else { all.last().map_or(0, |table| table.columns.len()) };
        while cells.len() > most.max(1) && cells.last().is_some_and(|cell| cell.text.is_empty()) {
            cells.pop();
        }
        if is_header {
            let (title, spot) = match title.take() {
                Some((name, spot)) => (Some(name), spot),
                None => (None, SourceSpan { source, span: start..start + bare.len() }),
            };
            let columns = cells.iter().map(column).collect();
            let decimal_comma = separator != b',';
            all.push(Exported { title, spot, columns, rows: Vec::new(), decimal_comma });
            continue;
        }
        let Some(table) = all.last_mut() else { continue };
        if table.rows.is_empty() && is_row_of_units(&cells) {
            for (column, cell) in table.columns.iter_mut().zip(&cells) {
                column.unit = if column.unit.is_empty() { cell.text } else { column.unit };
            }
            continue;
        }
        if cells.len() != table.columns.len() {
            let spot = SourceSpan { source, span: start..start + bare.len() };
            let expected = format!("{} values, as the header has", table.columns.len());
            return Err(sources.error(&spot, "", expected, cells.len().to_string()));
        }
        table.rows.push(cells);
    }
    Ok(all)
}

/// The name behind `TABLE:`, without quotes and what a spreadsheet adds.
fn title_of(line: &str) -> Option<&str> {
    let line = line.trim_matches(|c: char| c.is_whitespace() || ",;\"".contains(c));
    let (word, name) = line.split_at_checked(6)?;
    let is_title = word.eq_ignore_ascii_case("table:");
    is_title.then(|| name.trim_matches(|c: char| c.is_whitespace() || c == '"'))
}

fn column<'a>(cell: &Cell<'a>) -> Column<'a> {
    let (name, unit) = match cell.text.split_once('(') {
        Some((name, unit)) => (name, unit.trim_end_matches(')').trim()),
        None => (cell.text, ""),
    };
    let name = name.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
    Column { name, unit, spot: cell.spot.clone() }
}

/// No number, and a unit or the kind of a column: `sec`, `Unitless`, `Text`.
fn is_row_of_units(cells: &[Cell<'_>]) -> bool {
    let is_number = |cell: &Cell<'_>| cell.text.replace(',', ".").parse::<f64>().is_ok();
    !cells.iter().any(is_number)
}

/// The cells of a line.
fn split(line: &str, at: usize, separator: u8, source: usize) -> Vec<Cell<'_>> {
    let cell = |range: core::ops::Range<usize>| Cell {
        text: line.get(range.clone()).unwrap_or("").trim_matches('"').trim(),
        spot: SourceSpan { source, span: at + range.start..at + range.end },
    };
    cell_ranges(line.as_bytes(), separator).into_iter().map(cell).collect()
}

impl<'a> Exported<'a> {
    /// The place of the first column of one of these names.
    pub fn find(&self, names: &[&str]) -> Option<usize> {
        names.iter().find_map(|name| self.columns.iter().position(|column| column.name == *name))
    }

    /// The same, which must be there; the error says `expected`.
    pub fn required(
        &self,
        sources: &Sources,
        names: &[&str],
        expected: &str,
    ) -> Result<usize, InputError> {
        self.find(names).ok_or_else(|| {
            let spot = self.columns.first().map_or(&self.spot, |column| &column.spot);
            sources.error(spot, "", format!("a column {expected}"), "none")
        })
    }

    /// The number in a cell.
    pub fn number(&self, sources: &Sources, cell: &Cell<'_>) -> Result<f64, InputError> {
        let value = match self.decimal_comma {
            true => cell.text.replace(',', ".").parse::<f64>(),
            false => cell.text.parse::<f64>(),
        };
        value.ok().filter(|value| value.is_finite()).ok_or_else(|| {
            sources.error(&cell.spot, "", "a finite number", format!("{:?}", cut(cell.text)))
        })
    }

    /// The number of a mode in a cell, from 1.
    pub fn mode(&self, sources: &Sources, cell: &Cell<'_>) -> Result<usize, InputError> {
        let number = self.number(sources, cell)?;
        if number >= 1.0 && number.fract() == 0.0 && number < 1e6 {
            return Ok(number as usize);
        }
        let found = format!("{:?}", cut(cell.text));
        Err(sources.error(&cell.spot, "", "the number of a mode, from 1", found))
    }
}
