//! Which columns are times, which are motion, and whether the lines are one series.

use super::clock;
use super::header::{Header, Name, Unit};
use super::table::TextTable;
use crate::sampling;
use crate::text::Text;
use slipstick_dynamics::error::RecordError;
use slipstick_dynamics::motion::{Gap, MAX_SAMPLES, gap};
use slipstick_dynamics::notice::{Notice, NoticeKind};

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
    /// The column that numbers the rows.
    pub index: Option<usize>,
    /// Whether all numbers are one series, read along the lines.
    pub wrapped: bool,
    /// What had to be judged.
    pub notices: Vec<Notice>,
}

/// From what size on times in the unit of their column have digits that doubles no longer hold.
const LARGE_TIME: f64 = 1e5;

/// Finds it; with `given_s`, a time step, times need not be in seconds.
///
/// # Errors
/// For a spectrum; where times do not increase, or stand still more than once; where a row is short;
/// where columns without times and names look like separate components; for fewer than two values.
pub(super) fn of(
    text: &Text,
    header: &Header,
    table: &TextTable,
    given_s: Option<f64>,
) -> Result<Layout, RecordError> {
    let names = header.names(text, table)?;
    if names.is_none() {
        table.require_all(text)?;
    }
    if let Some(names) = &names
        && is_spectrum(names, table)
    {
        return Err(header.error(text, "a time history, not a spectrum", &header.names_line()));
    }
    let index = index_column(names.as_deref(), table);
    let named_time = names.as_ref().and_then(|names| {
        let times = |c: &usize| Some(*c) != index && names[*c].is_time();
        let is_usable = |c: &usize| given_s.is_none() || table.is_numeric(*c);
        let all: Vec<usize> = (0..table.columns).filter(times).filter(is_usable).collect();
        let of_numbers = all.iter().copied().filter(|c| !table.is_text(*c));
        let of_numbers: Vec<usize> = of_numbers.collect();
        let all = if of_numbers.is_empty() { all } else { of_numbers };
        all.iter().copied().find(|c| names[*c].has_time_unit()).or_else(|| all.first().copied())
    });
    let named_time = table.clock[0].or(named_time);
    let is_none = |c: &usize| Some(*c) == index || table.clock[1] == Some(*c) || table.is_text(*c);
    let first = (0..table.columns).find(|c| !is_none(c)).unwrap_or(0);
    // A column that is named and has a unit of motion is not taken for times.
    let first_is_motion = names.as_ref().is_some_and(|names| {
        named_time.is_some() || names.get(first).is_none_or(|name| name.unit.is_some())
    });
    // Nothing increases in a single row: one long line of numbers is a series.
    let looks_like_time = !first_is_motion
        && table.columns >= first + 2
        && table.rows() >= 2
        && mostly_increases(table, first);
    let time_column = named_time.or(looks_like_time.then_some(first));
    let unnamed = time_column.is_none() && names.is_none() && index.is_none();
    let wrapped = unnamed && table.columns >= 3;

    if unnamed && table.columns == 2 {
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
    let mut notices = Vec::new();
    let times_s = match time_column {
        Some(column) => {
            table.require(text, column)?;
            let unit = names.as_ref().and_then(|names| names[column].unit);
            let clock = Clock { text, table, column, is_given: given_s.is_some() };
            Some(clock.times_s(unit, &mut notices)?)
        }
        None => None,
    };
    if index.is_some() {
        let message = "the first column counts the rows: taken as their numbers, not as times";
        notices.push(Notice::new(NoticeKind::ColumnSkipped, message));
    }
    let words = match (table.columns, wrapped) {
        (1, _) => "text with one column".to_owned(),
        (n, true) => format!("text with {n} values a line"),
        (n, false) => format!("text with {n} columns"),
    };
    Ok(Layout { words, names, time_column, times_s, index, wrapped, notices })
}

/// Whether names are those of a spectrum: periods or frequencies first, or spectral ordinates that are
/// nowhere below 0, as those of no motion are.
fn is_spectrum(names: &[Name], table: &TextTable) -> bool {
    let ordinate = |column: usize| {
        names[column].is_ordinate() && table.column(column).all(|value| value >= 0.0)
    };
    let first = names.iter().find(|name| !name.is_index());
    names.iter().any(Name::is_period)
        || first.is_some_and(Name::is_frequency)
        || (0..names.len()).any(ordinate)
}

/// The first column, where it numbers the rows: it counts by one and is not called time, or is called
/// by a word for numbers of samples and holds whole numbers that increase.
fn index_column(names: Option<&[Name]>, table: &TextTable) -> Option<usize> {
    let name = names.and_then(|names| names.first());
    let is_named = name.is_some_and(|name| name.is_time() || name.unit.is_some());
    if is_named || table.columns < 2 {
        return None;
    }
    let whole = || table.column(0).all(|value| value.fract() == 0.0);
    let increases = || first_decrease(table).is_none() && table.rows() >= 3;
    let by_name = name.is_some_and(Name::is_index) && increases() && whole();
    (by_name || table.counts_rows()).then_some(0)
}

/// Whether a column goes forwards in most steps and back in few: times, perhaps with a fault
/// in them, and no motion, which goes down as often as up.
fn mostly_increases(table: &TextTable, column: usize) -> bool {
    let first = table.column(column);
    let (mut forwards, mut backwards, mut steps) = (0, 0, 0);
    for (after, before) in first.clone().skip(1).zip(first) {
        forwards += usize::from(after > before);
        backwards += usize::from(after < before);
        steps += 1;
    }
    2 * forwards >= steps && 4 * backwards <= steps
}

fn first_decrease(table: &TextTable) -> Option<usize> {
    let first = table.column(0);
    let at = first.clone().skip(1).zip(first).position(|(after, before)| after <= before);
    at.map(|row| row + 1)
}

/// Whether neighbours in a column are closer than neighbours on a line, which in one series sampled
/// finely enough are the closest of all.
fn looks_like_components(table: &TextTable) -> bool {
    let mean = |lag: usize| -> f64 {
        let later = table.cells.iter().skip(lag);
        let sum: f64 = later.zip(&table.cells).map(|(b, a)| (b - a).abs()).sum();
        sum / table.cells.len().saturating_sub(lag) as f64
    };
    mean(table.columns) < mean(1)
}

/// A column of times.
struct Clock<'a, 'b> {
    text: &'a Text<'b>,
    table: &'a TextTable,
    column: usize,
    /// Whether the time step is known besides.
    is_given: bool,
}

impl Clock<'_, '_> {
    /// The times in s.
    fn times_s(
        &self,
        unit: Option<Unit>,
        notices: &mut Vec<Notice>,
    ) -> Result<Vec<f64>, RecordError> {
        let Self { text, table, column, is_given } = *self;
        let is_clock = table.clock[0] == Some(column);
        let first = table.column(column).next().unwrap_or(0.0);
        let second = match unit {
            _ if is_clock => 1.0,
            Some(Unit::Time(seconds)) => seconds,
            None => self.unit_of_epoch(notices),
            Some(_) => return Err(table.error_at(text, 0, column, "times in s, ms or min")),
        };
        let large = is_clock || first.abs() >= LARGE_TIME || second == clock::DAY_S as f64;
        let exact = large.then(|| table.since_first(text, column)).flatten();
        if is_clock && exact.is_none() {
            return Err(table.error_at(text, 0, column, "a time of day in every row"));
        }
        let times = exact.unwrap_or_else(|| table.column(column).collect());
        // A thousandth is no double, a thousand is.
        let per_second = libm::round(1.0 / second);
        let in_s = |t: f64| if second < 1.0 { t / per_second } else { t * second };
        let times_s: Vec<f64> = times.into_iter().map(in_s).collect();
        if let Some(row) = sampling::disorder(&times_s) {
            let before_s = times_s[row - 1];
            let thousands = if table.has_thousands(text, row, column) {
                "; with a point between thousands it is none: write 1000, not 1.000"
            } else {
                ""
            };
            let expected =
                format!("a time after {before_s} s (or once the same, for a jump){thousands}");
            return Err(table.error_at(text, row, column, expected));
        }
        let last = times_s.len() - 1;
        if times_s[last] == times_s[0] {
            return Err(table.error_at(text, last, column, "times that increase"));
        }
        if let Some(Gap { index, longest_s }) = gap(&times_s).filter(|_| !is_given) {
            let before_s = times_s[index - 1];
            let expected = format!(
                "a time in proportion to the samples after {before_s} s, {longest_s} s from the \
                 first to the last (correct it, cut the motion there, or give the time step as dt if \
                 these are no seconds)"
            );
            return Err(table.error_at(text, index, column, expected));
        }
        Ok(times_s)
    }

    /// Seconds in the unit of times that only a clock since 1970 shows, or the days of a spreadsheet.
    fn unit_of_epoch(&self, notices: &mut Vec<Notice>) -> f64 {
        let mut times = self.table.column(self.column);
        let (first, last) = (times.next().unwrap_or(0.0), times.last().unwrap_or(0.0));
        let (second, name) = match clock::epoch_unit(first) {
            Some((second, name)) => (second, format!("{name} since 1970")),
            None if clock::are_days(first, last, self.table.rows()) => {
                (clock::DAY_S as f64, "days of a spreadsheet".to_owned())
            }
            None => return 1.0,
        };
        let message = format!("times of the size of {first:.6e} were taken as {name}");
        notices.push(Notice::new(NoticeKind::ClockAssumed, message));
        second
    }
}
