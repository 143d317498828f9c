//! What divides the numbers of a line, and what marks their decimals.

use super::header::{Header, is_comment};
use crate::text::{Line, Text, number, number_with_comma};
use slipstick_dynamics::error::RecordError;

/// What stands between two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    /// Blanks or tabs, any number of them.
    Blank,
    /// A comma or a semicolon, with blanks around it or not.
    Byte(u8),
}

/// How numbers are written in a file, the same throughout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Style {
    /// Between two numbers.
    pub separator: Separator,
    /// Whether decimals follow a comma.
    pub decimal_comma: bool,
}

impl Style {
    /// The style of the numbers after a header.
    ///
    /// # Errors
    /// Where every line has the form `0,5`, which may be one number or two.
    pub fn of(text: &Text, header: &Header) -> Result<Self, RecordError> {
        let style = |separator, decimal_comma| Self { separator, decimal_comma };
        let mut doubtful: Option<Line> = None;
        let mut lines = text.lines().skip(header.lines).filter(|line| !is_comment(line));
        let decided = lines.find_map(|line| {
            let bytes = line.bytes.trim_ascii();
            let count = |b: u8| bytes.iter().filter(|&&x| x == b).count();
            let (commas, points) = (count(b','), count(b'.'));
            let has_blank = bytes.iter().any(|&b| b == b' ' || b == b'\t');
            if count(b';') > 0 {
                let semicolon = Separator::Byte(b';');
                // Whole numbers leave the decimals open: look on.
                return match (commas, points) {
                    (0, 0) => {
                        doubtful = None;
                        None
                    }
                    _ => Some(style(semicolon, commas > 0)),
                };
            }
            match (commas, points) {
                // A date and a time of day are divided by a blank, columns by the comma.
                (1.., _) if bytes.contains(&b':') => Some(style(Separator::Byte(b','), false)),
                (0, 0) => None,
                (0, _) => Some(style(Separator::Blank, false)),
                (_, 1..) => Some(style(Separator::Byte(b','), false)),
                _ if bytes.windows(2).any(|w| w[0] == b',' && w[1].is_ascii_whitespace()) => {
                    Some(style(Separator::Byte(b','), false))
                }
                _ if has_blank => Some(style(Separator::Blank, true)),
                (1, 0) => {
                    doubtful.get_or_insert(line);
                    None
                }
                _ => Some(style(Separator::Byte(b','), false)),
            }
        });
        let semicolons = || {
            let mut lines = text.lines().skip(header.lines);
            lines.any(|line| !is_comment(&line) && line.bytes.contains(&b';'))
        };
        let decided = decided.map(|style: Self| match style.separator {
            Separator::Blank if tabs(text, header) => {
                Self { separator: Separator::Byte(b'\t'), ..style }
            }
            _ => style,
        });
        match (decided, doubtful) {
            (Some(style), _) => Ok(style),
            (None, _) if semicolons() => Ok(style(Separator::Byte(b';'), false)),
            (None, None) => Ok(style(Separator::Blank, false)),
            (None, Some(_)) if header.count(Separator::Byte(b',')) == 2 => {
                Ok(style(Separator::Byte(b','), false))
            }
            (None, Some(line)) => {
                let expected = "decimal points, or a semicolon, tab or blank between columns \
                                (this may be one number or two)";
                Err(text.error(&line, 0, expected, &line.trimmed()))
            }
        }
    }

    /// The number that a word is.
    pub fn number(self, word: &[u8]) -> Option<f64> {
        if self.decimal_comma { number_with_comma(word) } else { number(word) }
    }

    /// Number of cells of the first row: those behind which every row has nothing are none.
    pub fn columns_of_first(self, text: &Text, header: &Header, first: &Line) -> usize {
        let cells = |line: &Line| {
            let (mut all, mut filled) = (0, 0);
            let _ = self.words::<()>(line, |word| {
                all += 1;
                filled = if word.is_empty() { filled } else { all };
                Ok(())
            });
            [all, filled]
        };
        let [all, filled] = cells(first);
        if all == filled || self.separator == Separator::Blank {
            return filled;
        }
        let rows = text.lines().skip(header.lines).filter(|line| !is_comment(line));
        rows.map(|line| cells(&line)[1].min(all)).fold(filled, usize::max)
    }

    /// Calls `each` with every word of a line, until it fails; a separator between quotes is none.
    pub fn words<E>(
        self,
        line: &Line,
        mut each: impl FnMut(core::ops::Range<usize>) -> Result<(), E>,
    ) -> Result<(), E> {
        let Separator::Byte(separator) = self.separator else {
            return line.words().try_for_each(each);
        };
        let mut start = 0;
        loop {
            let rest = &line.bytes[start..];
            let length = separated(rest, separator);
            let word = &rest[..length.unwrap_or(rest.len())];
            let blanks = word.len() - word.trim_ascii_start().len();
            let first = start + blanks;
            each(first..first + word.trim_ascii().len())?;
            match length {
                Some(length) => start += length + 1,
                None => return Ok(()),
            }
        }
    }
}

/// Whether tabs divide the first row into cells of which one has words with blanks between them.
fn tabs(text: &Text, header: &Header) -> bool {
    let mut rows = text.lines().skip(header.lines).filter(|line| !is_comment(line));
    let Some(first) = rows.next() else { return false };
    let has_words = |cell: &[u8]| {
        let cell = cell.trim_ascii();
        cell.contains(&b' ') && cell.iter().filter(|b| b.is_ascii_alphabetic()).count() > 1
    };
    first.bytes.contains(&b'\t') && first.bytes.split(|b| *b == b'\t').any(has_words)
}

/// Where the first cell of some bytes ends in a separator; one between quotes is none, unless the quotes
/// are not closed.
pub(super) fn separated(bytes: &[u8], separator: u8) -> Option<usize> {
    let is_separator = |b: &u8| *b == separator;
    if bytes.trim_ascii_start().first() != Some(&b'"') {
        return bytes.iter().position(is_separator);
    }
    let mut quoted = false;
    let mut outside = |b: &u8| {
        quoted ^= *b == b'"';
        !quoted && is_separator(b)
    };
    bytes.iter().position(&mut outside).or_else(|| {
        // The end of the line inside quotes: they mean nothing.
        if quoted { bytes.iter().position(is_separator) } else { None }
    })
}
