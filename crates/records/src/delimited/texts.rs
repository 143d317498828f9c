//! A table whose cells are texts, whatever stands in them: what is asked of a study's rows, of fragility
//! data and of the tables of other programs.

use core::ops::Range;

use super::header::is_comment;
use super::style::separated;
use crate::text::{Line, Text, number, number_with_comma};
use slipstick_dynamics::error::RecordError;

/// A cell: its text, without quotes, and where it begins in its line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextCell {
    /// What stands in it.
    pub text: String,
    /// Its column in characters, from 1.
    pub column: usize,
}

/// A table of texts as it stands in a file: names, then rows as long.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextRows {
    /// The names of the columns.
    pub names: Vec<String>,
    /// The line of each row, from 1, and its cells.
    pub rows: Vec<(usize, Vec<TextCell>)>,
}

/// The cells of a line as ranges of its bytes, blanks around them cut; a separator between quotes is none.
#[must_use]
pub fn cell_ranges(line: &[u8], separator: u8) -> Vec<Range<usize>> {
    let mut all = Vec::new();
    let mut start = 0;
    loop {
        let rest = &line[start..];
        let length = separated(rest, separator);
        let cell = &rest[..length.unwrap_or(rest.len())];
        let first = start + cell.len() - cell.trim_ascii_start().len();
        all.push(first..first + cell.trim_ascii().len());
        match length {
            Some(length) => start += length + 1,
            None => return all,
        }
    }
}

/// What divides the names of a header: a tab, a semicolon or a comma, whichever there is, in that order.
#[must_use]
pub fn separator_of(header: &[u8]) -> u8 {
    b"\t;,".iter().copied().find(|b| header.contains(b)).unwrap_or(b',')
}

/// Reads the table. Lines of comment and empty lines are passed over, and columns without a name that are
/// empty in every row, and a first one without a name that numbers the rows; a decimal comma between
/// semicolons or tabs becomes a point.
///
/// # Errors
/// [`RecordError`] for no header and for a row of another length.
pub(crate) fn read(text: &Text) -> Result<TextRows, RecordError> {
    let mut lines = text.lines().filter(|line| !line.is_blank() && !is_comment(line));
    let Some(header) = lines.next() else {
        return Err(text.error_at_start("a header with names of columns", "nothing"));
    };
    let separator = separator_of(header.bytes);
    let names: Vec<String> = of_line(&header, separator).into_iter().map(|c| c.text).collect();
    let mut table = TextRows { names, rows: Vec::new() };
    for line in lines {
        let mut cells = of_line(&line, separator);
        while cells.len() > table.names.len() && cells.last().is_some_and(|c| c.text.is_empty()) {
            cells.pop();
        }
        if cells.len() != table.names.len() {
            let expected = format!("{} cells, as the header has", table.names.len());
            return Err(text.error(&line, 0, expected, &cells.len().to_string()));
        }
        table.rows.push((line.number, cells));
    }
    table.leave_out();
    if separator != b',' {
        table.with_points();
    }
    Ok(table)
}

fn of_line(line: &Line, separator: u8) -> Vec<TextCell> {
    let cell = |range: Range<usize>| {
        let before = String::from_utf8_lossy(&line.bytes[..range.start]);
        let text = String::from_utf8_lossy(&line.bytes[range]).into_owned();
        let inner = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
        let text =
            inner.map_or(text.clone(), |inner| inner.replace("\"\"", "\"").trim().to_owned());
        TextCell { text, column: before.chars().count() + 1 }
    };
    cell_ranges(line.bytes, separator).into_iter().map(cell).collect()
}

impl TextRows {
    /// Takes out columns without a name that say nothing.
    fn leave_out(&mut self) {
        let says_nothing = |index: usize| {
            let mut cells = self.rows.iter().map(|(_, cells)| cells[index].text.as_str());
            let is_empty = cells.clone().all(str::is_empty);
            let first = cells.clone().next().and_then(|cell| cell.parse::<u64>().ok());
            let counts = index == 0
                && first.is_some_and(|first| {
                    cells.all(|cell| !cell.is_empty())
                        && self.rows.iter().enumerate().all(|(row, (_, cells))| {
                            cells[0].text.parse() == Ok(first + row as u64)
                        })
                });
            is_empty || counts
        };
        let is_unnamed = |name: &str| name.is_empty() || name.starts_with("Unnamed: ");
        let kept: Vec<bool> = (0..self.names.len())
            .map(|index| !(is_unnamed(&self.names[index]) && says_nothing(index)))
            .collect();
        let mut keep = kept.iter();
        self.names.retain(|_| *keep.next().unwrap_or(&true));
        for (_, cells) in &mut self.rows {
            let mut keep = kept.iter();
            cells.retain(|_| *keep.next().unwrap_or(&true));
        }
    }

    /// Writes numbers with a decimal point where a column has them with a comma.
    fn with_points(&mut self) {
        for index in 0..self.names.len() {
            let cells = || self.rows.iter().map(|(_, cells)| cells[index].text.as_bytes());
            let is_number =
                |cell: &[u8]| number(cell).or_else(|| number_with_comma(cell)).is_some();
            if cells().all(|cell| cell.is_empty() || is_number(cell)) {
                for (_, cells) in &mut self.rows {
                    cells[index].text = cells[index].text.replace(',', ".");
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Vec<Vec<String>> {
        let text = Text::new("t", text.as_bytes()).unwrap();
        let table = read(&text).unwrap();
        let rows =
            table.rows.iter().map(|(_, cells)| cells.iter().map(|c| c.text.clone()).collect());
        core::iter::once(table.names.clone()).chain(rows).collect()
    }

    /// One table as pandas, a German spreadsheet and a database write it.
    #[test]
    fn one_table_in_the_forms_of_programs() {
        let plain = table("record,level,collapsed\na,0.1,0\nb,0.25,1\n");
        for text in [
            ",record,level,collapsed\n0,a,0.1,0\n1,b,0.25,1\n",
            "Unnamed: 0,record,level,collapsed\r\n5,a,0.1,0\r\n6,b,0.25,1\r\n",
            "record;level;collapsed;;\na;0,1;0;;\nb;0,25;1;;\n",
            "# NPTS, 3\n\nrecord\tlevel\tcollapsed\na\t0,1\t0\n# between\nb\t0.25\t1\n",
            "\"record\",\"level\",\"collapsed\",\n\"a\",\"0.1\",0,\n\"b\",0.25,1,\n",
        ] {
            assert_eq!(table(text), plain, "{text}");
        }
        let quoted = table("record,level\n\"a, \"\"b\"\"\",0.1\n");
        assert_eq!(quoted[1], ["a, \"b\"", "0.1"]);
        // A decimal comma is none between commas, a name none that numbers.
        assert_eq!(table("n,level\n0,1\n1,2\n")[0], ["n", "level"]);
    }
}
