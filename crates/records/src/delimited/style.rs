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

    /// Calls `each` with every word of a line, until it fails.
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
            let length = rest.iter().position(|&b| b == separator);
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
