//! Which columns are times, which are motion, and whether the lines are one series.

use super::header::{Header, Name, Unit};
use super::table::Table;
use crate::sampling;
use crate::text::Text;
use slipstick_dynamics::error::RecordError;
use slipstick_dynamics::motion::{Gap, MAX_SAMPLES, gap};

/// What the columns are.
pub(super) struct Layout {
    /// In words, for the line that says what was understood.
    pub words: String,
    /// Names of the columns, where the file has them.
    pub names: Option<Vec<Name>>,
    /// The column of times.
    pub time_column: Option<usize>,
    /// The times in s.
    pub times_s: Option<Vec<f64>>,
    /// Whether all numbers are one series, read along the lines.
    pub wrapped: bool,
}

/// Finds it.
///
/// # Errors
/// Where times do not increase, or stand still more than once; where a row is short; where columns
/// without times and names look like separate components; for fewer than two values.
pub(super) fn of(text: &Text, header: &Header, table: &Table) -> Result<Layout, RecordError> {
    let names = header.names(text, table.style.separator, table.columns)?;
    let named_time = names.as_ref().and_then(|names| names.iter().position(Name::is_time));
    // A column that is named and has a unit of motion is not taken for times.
    let first_is_motion =
        names.as_ref().is_some_and(|names| names[0].unit.is_some() || named_time.is_some());
    // Nothing increases in a single row: one long line of numbers is a series.
    let looks_like_time =
        !first_is_motion && table.columns >= 2 && table.rows() >= 2 && mostly_increases(table);
    let time_column = named_time.or(looks_like_time.then_some(0));
    let wrapped = time_column.is_none() && names.is_none() && table.columns >= 3;

    if time_column.is_none() && names.is_none() && table.columns == 2 {
        let row = first_decrease(table).unwrap_or(0);
        let expected = "times that increase in the first of two columns, or a header that names \
                        the columns";
        return Err(table.error_at(text, row, 0, expected));
    }
    if wrapped && looks_like_components(table) {
        let expected = format!(
            "a header that names the {} columns: they look like components side by side",
            table.columns
        );
        return Err(table.error_at_start(text, expected));
    }
    if !wrapped && !table.is_full() {
        let short = table.cells.len() % table.columns;
        let expected = format!("{} numbers, as in the rows before", table.columns);
        return Err(text.error_at_end(expected, &short.to_string()));
    }
    let samples = if wrapped { table.cells.len() } else { table.rows() };
    if !(2..=MAX_SAMPLES).contains(&samples) {
        let expected = "2 to 100 000 000 values";
        return Err(text.error_at_end(expected, &samples.to_string()));
    }
    let times_s = match time_column {
        Some(column) => {
            let unit = names.as_ref().and_then(|names| names[column].unit);
            Some(times(text, table, column, unit)?)
        }
        None => None,
    };
    let words = match (table.columns, wrapped) {
        (1, _) => "text with one column".to_owned(),
        (n, true) => format!("text with {n} values a line"),
        (n, false) => format!("text with {n} columns"),
    };
    Ok(Layout { words, names, time_column, times_s, wrapped })
}

/// Whether the first column goes forwards in most steps and back in few: times, perhaps with a fault
/// in them, and no motion, which goes down as often as up.
fn mostly_increases(table: &Table) -> bool {
    let first = table.column(0);
    let (mut forwards, mut backwards, mut steps) = (0, 0, 0);
    for (after, before) in first.clone().skip(1).zip(first) {
        forwards += usize::from(after > before);
        backwards += usize::from(after < before);
        steps += 1;
    }
    2 * forwards >= steps && 4 * backwards <= steps
}

fn first_decrease(table: &Table) -> Option<usize> {
    let first = table.column(0);
    let at = first.clone().skip(1).zip(first).position(|(after, before)| after <= before);
    at.map(|row| row + 1)
}

/// Whether neighbours in a column are closer than neighbours on a line, which in one series sampled
/// finely enough are the closest of all.
fn looks_like_components(table: &Table) -> bool {
    let mean = |lag: usize| -> f64 {
        let later = table.cells.iter().skip(lag);
        let sum: f64 = later.zip(&table.cells).map(|(b, a)| (b - a).abs()).sum();
        sum / table.cells.len().saturating_sub(lag) as f64
    };
    mean(table.columns) < mean(1)
}

/// The times in s.
fn times(
    text: &Text,
    table: &Table,
    column: usize,
    unit: Option<Unit>,
) -> Result<Vec<f64>, RecordError> {
    let second = match unit {
        Some(Unit::Time(seconds)) => seconds,
        None => 1.0,
        Some(_) => return Err(table.error_at(text, 0, column, "times in s, ms or min")),
    };
    let times_s: Vec<f64> = table.column(column).map(|t| t * second).collect();
    if let Some(row) = sampling::disorder(&times_s) {
        let before_s = times_s[row - 1];
        let expected = format!("a time after {before_s} s (or once the same, for a jump)");
        return Err(table.error_at(text, row, column, expected));
    }
    let last = times_s.len() - 1;
    if times_s[last] == times_s[0] {
        return Err(table.error_at(text, last, column, "times that increase"));
    }
    if let Some(Gap { index, longest_s }) = gap(&times_s) {
        let before_s = times_s[index - 1];
        let expected = format!(
            "a time in proportion to the samples after {before_s} s, {longest_s} s from the first to \
             the last (correct it, or cut the motion there)"
        );
        return Err(table.error_at(text, index, column, expected));
    }
    Ok(times_s)
}
