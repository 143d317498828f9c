//! Rows and columns of numbers.

use core::ops::Range;
use std::collections::BTreeMap;

use super::clock::{self, Instant};
use super::header::{Header, is_comment};
use super::style::{Separator, Style};
use crate::text::{Line, Text};
use slipstick_dynamics::error::RecordError;
use slipstick_dynamics::motion::MAX_SAMPLES;

/// All numbers of a file.
pub(super) struct TextTable {
    /// How they are written.
    pub style: Style,
    /// Numbers a row.
    pub columns: usize,
    /// Row by row; the last row may be short if there are three columns or more.
    pub cells: Vec<f64>,
    /// The column of times of day, whose cells here are 0, and that of dates beside them.
    pub clock: [Option<usize>; 2],
    /// Of each column with cells that are no numbers, NaN here, the first of them and their count.
    faults: BTreeMap<usize, Fault>,
    /// A last line of words behind the numbers, which is none of the rows.
    pub tail: Option<usize>,
    /// Count and step of a first line that states them.
    count: Option<CountLine>,
    /// Lines before the first of numbers, a count among them.
    header_lines: usize,
}

/// The first cell of a column that is no number.
#[derive(Clone)]
struct Fault {
    row: usize,
    word: Range<usize>,
    /// Cells of the column that are no numbers.
    count: usize,
}

/// A first line `4000 0.01`: count and step in s.
#[derive(Clone, Copy)]
struct CountLine {
    count: f64,
    dt_s: f64,
    number: usize,
}

impl TextTable {
    /// Reads the numbers after a header. A cell that is no number is a fault of its column, which matters
    /// where the column is used ([`TextTable::require`]).
    ///
    /// # Errors
    /// For rows of different lengths; for a blank line among them; for fewer or more than a count line says.
    pub fn read(text: &Text, header: &Header) -> Result<Self, RecordError> {
        let style = Style::of(text, header)?;
        let mut table = Self {
            style,
            columns: 0,
            cells: vec![],
            clock: [None; 2],
            faults: BTreeMap::new(),
            tail: None,
            count: None,
            header_lines: header.lines,
        };
        let mut rows = text.lines().skip(header.lines).filter(|line| !is_comment(line));
        let mut pending = rows.next();
        if let Some(first) = pending {
            table.columns = style.columns_of_first(text, header, &first);
            table.columns = table.row(text, &first)?;
            if table.columns == 0 {
                return Err(text.error(&first, 0, "a row of numbers", "empty cells"));
            }
            pending = rows.next();
            if let Some(second) = pending.filter(|line| !line.is_blank()) {
                let columns = table.row(text, &second)?;
                if let Some(count) = table.count_line(&first, columns) {
                    table.cells.drain(..2);
                    table.header_lines = first.number;
                    table.faults.values_mut().for_each(|fault| fault.row = 0);
                    (table.count, table.columns) = (Some(count), columns);
                    if columns == 0 {
                        return Err(text.error(&second, 0, "a row of numbers", "empty cells"));
                    }
                } else if columns != table.columns {
                    return Err(table.uneven_row(text, &second, columns));
                }
                pending = rows.next();
            }
        }
        let mut short: Option<(Line, usize)> = None;
        while let Some(line) = pending {
            if line.is_blank() {
                if rows.all(|line| line.is_blank()) {
                    break;
                }
                return Err(text.error(&line, 0, "a row of numbers", "an empty line"));
            }
            if let Some((short, columns)) = short {
                return Err(table.uneven_row(text, &short, columns));
            }
            if table.is_tail(&line) && rows.clone().all(|line| line.is_blank()) {
                table.tail = Some(line.number);
                break;
            }
            let columns = table.row(text, &line)?;
            if columns != table.columns {
                if columns > table.columns || table.columns < 3 || table.has_fault_in_last_row() {
                    return Err(table.uneven_row(text, &line, columns));
                }
                short = Some((line, columns));
            }
            pending = rows.next();
        }
        if table.columns == 0 {
            return Err(text.error_at_end("numbers", "the end of the file"));
        }
        table.check_count(text)?;
        Ok(table)
    }

    /// Whether a line is a sentence, such as people write below numbers that blanks divide: a word first,
    /// and more words than numbers.
    fn is_tail(&self, line: &Line) -> bool {
        let is_word = |word: Range<usize>| {
            let word = &line.bytes[word];
            self.style.number(word).is_none() && word.iter().any(u8::is_ascii_alphabetic)
        };
        let words = || line.words().map(is_word);
        let count = words().filter(|is_word| *is_word).count();
        self.style.separator == Separator::Blank
            && self.clock == [None; 2]
            && self.faults.is_empty()
            && words().next() == Some(true)
            && count >= 2
            && 2 * count > words().count()
    }

    /// Whether no cell of a column is a number: text, or nothing.
    pub fn is_text(&self, column: usize) -> bool {
        self.faults.get(&column).is_some_and(|fault| fault.count >= self.rows())
    }

    /// Whether every cell of a column is a number, or a time of day, or a date.
    pub fn is_numeric(&self, column: usize) -> bool {
        !self.faults.contains_key(&column)
    }

    /// The error about the first cell of a column that is no number.
    ///
    /// # Errors
    /// Where there is one.
    pub fn require(&self, text: &Text, column: usize) -> Result<(), RecordError> {
        match self.faults.get(&column) {
            None => Ok(()),
            Some(fault) => Err(self.error_of(text, fault)),
        }
    }

    /// The same of all columns, the first cell of the file.
    ///
    /// # Errors
    /// Where there is one.
    pub fn require_all(&self, text: &Text) -> Result<(), RecordError> {
        match self.faults.iter().min_by_key(|(column, fault)| (fault.row, **column)) {
            None => Ok(()),
            Some((_, fault)) => Err(self.error_of(text, fault)),
        }
    }

    fn error_of(&self, text: &Text, fault: &Fault) -> RecordError {
        text.error_at(&self.line(text, fault.row), &fault.word, "a finite number")
    }

    fn has_fault_in_last_row(&self) -> bool {
        let last = self.cells.len().saturating_sub(1) / self.columns.max(1);
        self.faults.values().any(|fault| fault.row >= last)
    }

    /// Number of full rows.
    pub fn rows(&self) -> usize {
        self.cells.len() / self.columns
    }

    /// Whether the last row is full.
    pub fn is_full(&self) -> bool {
        self.cells.len().is_multiple_of(self.columns)
    }

    /// Values of a column.
    pub fn column(&self, column: usize) -> impl Iterator<Item = f64> + Clone + '_ {
        self.cells.chunks_exact(self.columns).map(move |row| row[column])
    }

    /// Whether the first column counts the rows: whole numbers, each one more than the last.
    pub fn counts_rows(&self) -> bool {
        let first = self.column(0);
        let whole = first.clone().next().is_some_and(|value| value.fract() == 0.0);
        let by_one = first.clone().skip(1).zip(first).all(|(after, before)| after - before == 1.0);
        whole && by_one && self.rows() >= 3 && self.clock[0] != Some(0)
    }

    /// The times of a column in its unit, from the first on, each difference that of the decimals as
    /// they are written; `None` where one of them has more than 18 digits after its point.
    pub fn since_first(&self, text: &Text, column: usize) -> Option<Vec<f64>> {
        let lines = text.lines().skip(self.header_lines).filter(|line| !is_comment(line));
        let instants = lines.take(self.rows()).map(|line| {
            let word = self.words(&line).into_iter().nth(column)?;
            Instant::of(unquoted(&line.bytes[word]))
        });
        let instants: Option<Vec<Instant<'_>>> = instants.collect();
        Some(clock::since_first(instants?.into_iter()))
    }

    /// Whether a cell has three digits behind a point, the cell above it none: 999, then 1.000.
    pub fn has_thousands(&self, text: &Text, row: usize, column: usize) -> bool {
        let cell = |row: usize| {
            let line = self.line(text, row);
            let word = self.words(&line).into_iter().nth(column);
            word.map(|word| unquoted(&line.bytes[word]).to_vec()).unwrap_or_default()
        };
        let before = row.checked_sub(1).map(cell).unwrap_or_default();
        let found = cell(row);
        let digits = |cell: &[u8]| !cell.is_empty() && cell.iter().all(u8::is_ascii_digit);
        let parts: Vec<&[u8]> = found.split(|b| *b == b'.').collect();
        let [whole, groups @ ..] = &parts[..] else { return false };
        digits(&before)
            && digits(whole)
            && !groups.is_empty()
            && groups.iter().all(|group| group.len() == 3 && digits(group))
    }

    /// The words of a line; a date and the time of day behind it are one.
    fn words(&self, line: &Line) -> Vec<Range<usize>> {
        let mut words: Vec<Range<usize>> = Vec::new();
        let _: Result<(), ()> = self.style.words(line, |word| {
            match words.last_mut() {
                Some(date) if self.is_date_before_time(&line.bytes[date.clone()]) => {
                    date.end = word.end;
                }
                _ => words.push(word),
            }
            Ok(())
        });
        words
    }

    /// Whether a word between blanks is a date, which the time of day follows.
    fn is_date_before_time(&self, word: &[u8]) -> bool {
        self.style.separator == Separator::Blank && clock::is_date(word)
    }

    /// Appends the cells of a line, NaN for what is no number; how many there were. Empty cells behind those
    /// that other rows have are none.
    fn row(&mut self, text: &Text, line: &Line) -> Result<usize, RecordError> {
        let before = self.cells.len();
        let row = before / self.columns.max(1);
        let style = self.style;
        let (mut date, mut filled): (Option<usize>, usize) = (None, 0);
        let mut faults: Vec<(usize, Range<usize>)> = Vec::new();
        style.words(line, |word| {
            let word = date.take().unwrap_or(word.start)..word.end;
            let bytes = unquoted(&line.bytes[word.clone()]);
            if !bytes.is_empty() && self.is_date_before_time(bytes) {
                date = Some(word.start);
                return Ok::<(), RecordError>(());
            }
            let column = self.cells.len() - before;
            let value = style.number(bytes).or_else(|| self.clock_cell(column, bytes));
            if value.is_none() {
                faults.push((column, word));
            }
            if !bytes.is_empty() {
                filled = column + 1;
            }
            self.cells.push(value.unwrap_or(f64::NAN));
            Ok(())
        })?;
        let found = self.cells.len() - before;
        let columns = filled.max(found.min(self.columns));
        self.cells.truncate(before + columns);
        for (column, word) in faults.into_iter().filter(|(column, _)| *column < columns) {
            let new = Fault { row, word, count: 0 };
            self.faults.entry(column).or_insert(new).count += 1;
        }
        if self.cells.len() > 8 * MAX_SAMPLES {
            return Err(text.error(line, 0, "at most 100 000 000 rows", "more"));
        }
        Ok(columns)
    }

    /// What stands for a time of day, or a date, in the one column that has them.
    fn clock_cell(&mut self, column: usize, word: &[u8]) -> Option<f64> {
        let kind = match (clock::is_time_of_day(word), clock::is_date(word)) {
            (true, _) => 0,
            (_, true) => 1,
            _ => return None,
        };
        (*self.clock[kind].get_or_insert(column) == column).then_some(0.0)
    }

    /// The first line as count and step, if the second has another length or, as a time, would
    /// run backwards.
    fn count_line(&self, first: &Line, columns: usize) -> Option<CountLine> {
        let (&[count, dt_s], second) = self.cells.split_first_chunk::<2>()?;
        let is_count = || {
            let word = first.words().next()?;
            let digits = &first.bytes[word];
            digits.iter().all(u8::is_ascii_digit).then_some(())
        };
        let apart = columns != 2 || second[0] < count;
        (self.columns == 2 && count >= 2.0 && dt_s > 0.0 && apart && is_count().is_some())
            .then_some(CountLine { count, dt_s, number: first.number })
    }

    fn check_count(&self, text: &Text) -> Result<(), RecordError> {
        let Some(CountLine { count, number, .. }) = self.count else { return Ok(()) };
        let (rows, values) = (self.rows() as f64, self.cells.len() as f64);
        if count == rows || (self.columns >= 3 && count == values) {
            return Ok(());
        }
        let found = if self.columns >= 3 { values } else { rows };
        let expected = format!("{count} values, as line {number} says");
        Err(text.error_at_end(expected, &format!("the end after {found}")))
    }

    fn uneven_row(&self, text: &Text, line: &Line, columns: usize) -> RecordError {
        // A word is no number, whatever the number of words.
        let last =
            self.faults.values().filter(|fault| self.line(text, fault.row).number == line.number);
        if let Some(fault) = last.min_by_key(|fault| fault.word.start) {
            return self.error_of(text, fault);
        }
        let s = if self.columns == 1 { "" } else { "s" };
        let expected = format!("{} number{s}, as in the rows before", self.columns);
        text.error(line, 0, expected, &columns.to_string())
    }

    /// The step that a count line states, else the caller's.
    ///
    /// # Errors
    /// Where both are there and differ.
    pub fn given_step(
        &self,
        text: &Text,
        given_s: Option<f64>,
    ) -> Result<Option<f64>, RecordError> {
        match (self.count, given_s) {
            (Some(CountLine { dt_s, number, .. }), Some(given_s)) if dt_s != given_s => {
                let expected = format!("the time step given, {given_s} s (leave it out)");
                Err(text.error(&Line { number, bytes: b"" }, 0, expected, &format!("{dt_s} s")))
            }
            (count, given_s) => Ok(count.map(|line| line.dt_s).or(given_s)),
        }
    }

    /// The line of a row.
    fn line<'a>(&self, text: &Text<'a>, row: usize) -> Line<'a> {
        let mut rows = text.lines().skip(self.header_lines).filter(|line| !is_comment(line));
        rows.nth(row).unwrap_or(Line { number: 1, bytes: b"" })
    }

    /// The lines of the rows, one each, counted from 1.
    pub fn row_lines(&self, text: &Text) -> Vec<u32> {
        let rows = text.lines().skip(self.header_lines).filter(|line| !is_comment(line));
        rows.take(self.rows()).map(|line| u32::try_from(line.number).unwrap_or(u32::MAX)).collect()
    }

    /// An error at a cell.
    pub fn error_at(
        &self,
        text: &Text,
        row: usize,
        column: usize,
        expected: impl Into<String>,
    ) -> RecordError {
        let line = self.line(text, row);
        let words = self.words(&line);
        text.error_at(&line, words.get(column).unwrap_or(&(0..0)), expected)
    }

    /// An error at the first number.
    pub fn error_at_start(&self, text: &Text, expected: impl Into<String>) -> RecordError {
        self.error_at(text, 0, 0, expected)
    }

    /// An error about the numbers as a whole.
    pub fn error_found(
        &self,
        text: &Text,
        expected: impl Into<String>,
        found: &str,
    ) -> RecordError {
        text.error(&self.line(text, 0), 0, expected, found)
    }
}

/// A word without the quotes around it.
fn unquoted(word: &[u8]) -> &[u8] {
    match word {
        [b'"', inner @ .., b'"'] => inner.trim_ascii(),
        _ => word,
    }
}
