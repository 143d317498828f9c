//! Text of a record: lines, words and numbers with their positions.

use core::ops::Range;

use super::decimal;
use slipstick_dynamics::error::RecordError;

/// Bytes that are text, and the caller's name for them.
pub(super) struct Text<'a> {
    source_name: &'a str,
    bytes: &'a [u8],
}

/// One line without its end.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    /// Counted from 1.
    pub number: usize,
    /// Its bytes; headers need not be UTF-8.
    pub bytes: &'a [u8],
}

/// Of bytes that a program has packed, what is expected in their place and what they are; `None` of all others.
#[must_use]
pub fn packed(bytes: &[u8]) -> Option<[&'static str; 2]> {
    const SHEETS: &str = "a text file: of a workbook save each sheet as CSV (File, Save As)";
    const PACKED: [(&[u8], [&str; 2]); 3] = [
        (b"PK\x03\x04", [SHEETS, "a workbook or another packed file"]),
        (b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", [SHEETS, "a workbook of an old Excel"]),
        (b"\x1F\x8B", ["a text file: unpack it first", "a compressed file"]),
    ];
    PACKED.into_iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, words)| words)
}

/// Bytes as they are, but UTF-16 with its mark, as spreadsheets save it, as UTF-8.
pub(super) fn decoded(bytes: &[u8]) -> std::borrow::Cow<'_, [u8]> {
    let pair: fn([u8; 2]) -> u16 = match bytes {
        [0xFF, 0xFE, ..] => u16::from_le_bytes,
        [0xFE, 0xFF, ..] => u16::from_be_bytes,
        _ => return bytes.into(),
    };
    let units = bytes[2..].chunks_exact(2).map(|two| pair([two[0], two[1]]));
    let characters = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER));
    characters.collect::<String>().into_bytes().into()
}

/// Without the zeros after the last line, with which blocks of a tape were filled.
fn unpadded(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().rposition(|b| *b != 0 && !is_blank(b)).map_or(0, |last| last + 1);
    let zero = bytes[end..].iter().position(|b| *b == 0);
    zero.filter(|_| end > 0).map_or(bytes, |zero| &bytes[..end + zero])
}

impl<'a> Text<'a> {
    /// Takes the bytes as text: UTF-8 with or without its mark, or any other superset of ASCII.
    ///
    /// # Errors
    /// Where they are empty, UTF-16 or binary.
    pub fn new(source_name: &'a str, bytes: &'a [u8]) -> Result<Self, RecordError> {
        let bytes = unpadded(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes));
        let text = Self { source_name, bytes };
        if let Some([expected, found]) = packed(bytes) {
            return Err(text.error_at_start(expected, found));
        }
        if bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF") {
            return Err(text.error_at_start("text in UTF-8 or ASCII", "UTF-16"));
        }
        let is_control = |b: &u8| *b < b' ' && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0C | 0x1A);
        if let Some(at) = bytes.iter().position(is_control) {
            let line = text.lines().take_while(|l| text.offset(l) <= at).last();
            let line = line.unwrap_or(Line { number: 1, bytes: b"" });
            let found = format!("byte 0x{:02X} (a binary file?)", bytes[at]);
            let column = at - text.offset(&line).min(at);
            return Err(text.error(&line, column, "a text file", &found));
        }
        if bytes.iter().all(is_blank) {
            return Err(text.error_at_start("a record", "an empty file"));
        }
        Ok(text)
    }

    /// The caller's name for the text.
    pub fn source_name(&self) -> &'a str {
        self.source_name
    }

    /// Number of bytes.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// The last word, where the text ends in it and it is shorter after its point than the words
    /// before it, which are alike: a number cut in the middle is another number. Some hundred
    /// words after a header are looked at.
    pub fn cut_word(&self, header: &Line) -> Option<String> {
        let from = self.offset(header) + header.bytes.len();
        let tail = &self.bytes[self.bytes.len().saturating_sub(1024).max(from)..];
        let words: Vec<&[u8]> = tail.split(is_blank).filter(|word| !word.is_empty()).collect();
        let after_point = |word: &[u8]| word.iter().rev().position(|&b| b == b'.');
        let (last, before) = words.split_last()?;
        // The first may be cut by the choice of the tail.
        let before = before.get(1..)?;
        let usual = after_point(before.first()?);
        let alike = before.iter().all(|word| after_point(word) == usual);
        let shorter = after_point(last) < usual;
        (alike && shorter && tail.ends_with(last))
            .then(|| String::from_utf8_lossy(last).into_owned())
    }

    /// Whether the last line is ended, or blanks stand at its end.
    pub fn ends_with_line_end(&self) -> bool {
        self.bytes.last().is_some_and(is_blank)
    }

    /// Lines ended by LF, CRLF, CR CR LF or CR.
    pub fn lines(&self) -> Lines<'a> {
        Lines { rest: self.bytes, number: 0 }
    }

    /// The last line that is not blank and of which `is_left_out` does not hold; its number is not counted.
    pub fn last_line(&self, is_left_out: impl Fn(&Line) -> bool) -> Option<Line<'a>> {
        let lines = self.bytes.rsplit(|b| matches!(b, b'\n' | b'\r'));
        lines.map(|bytes| Line { number: 0, bytes }).find(|l| !l.is_blank() && !is_left_out(l))
    }

    /// Where a line of this text starts.
    fn offset(&self, line: &Line) -> usize {
        line.bytes.as_ptr() as usize - self.bytes.as_ptr() as usize
    }

    /// An error at a byte of a line.
    pub fn error(
        &self,
        line: &Line,
        at: usize,
        expected: impl Into<String>,
        found: &str,
    ) -> RecordError {
        let before = &line.bytes[..at.min(line.bytes.len())];
        RecordError {
            source_name: self.source_name.to_owned(),
            line: line.number,
            column: String::from_utf8_lossy(before).chars().count() + 1,
            offset: None,
            expected: expected.into(),
            found: found.chars().take(40).collect(),
        }
    }

    /// An error at a word of a line, which is what was found.
    pub fn error_at(
        &self,
        line: &Line,
        word: &Range<usize>,
        expected: impl Into<String>,
    ) -> RecordError {
        let found = String::from_utf8_lossy(&line.bytes[word.clone()]).into_owned();
        let found = if found.is_empty() { "the end of the line".to_owned() } else { found };
        self.error(line, word.start, expected, &found)
    }

    /// An error about the file as a whole.
    pub fn error_at_start(&self, expected: impl Into<String>, found: &str) -> RecordError {
        self.error(&Line { number: 1, bytes: b"" }, 0, expected, found)
    }

    /// An error after the last character.
    pub fn error_at_end(&self, expected: impl Into<String>, found: &str) -> RecordError {
        let last = self.lines().filter(|line| !line.is_blank()).last();
        let last = last.unwrap_or(Line { number: 1, bytes: b"" });
        self.error(&last, last.bytes.trim_ascii_end().len(), expected, found)
    }

    /// The number that a word is.
    ///
    /// # Errors
    /// For anything but one finite number.
    pub fn number(&self, line: &Line, word: &Range<usize>) -> Result<f64, RecordError> {
        number(&line.bytes[word.clone()])
            .ok_or_else(|| self.error_at(line, word, "a finite number"))
    }
}

/// See [`Text::lines`].
#[derive(Clone)]
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let end = self.rest.iter().position(|&b| b == b'\n' || b == b'\r');
        let (bytes, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        let returns = rest.iter().take_while(|&&b| b == b'\r').count();
        let ended_by = match rest.get(returns) {
            Some(b'\n') => returns + 1,
            _ => rest.len().min(1),
        };
        self.rest = &rest[ended_by..];
        Some(Line { number: self.number, bytes })
    }
}

impl<'a> Line<'a> {
    /// Whether there is nothing on it but blanks.
    pub fn is_blank(&self) -> bool {
        self.bytes.iter().all(is_blank)
    }

    /// Words between blanks.
    pub fn words(&self) -> Words<'a> {
        Words { bytes: self.bytes, at: 0 }
    }

    /// A word as text; bytes that are not UTF-8 are replaced.
    pub fn str(&self, word: &Range<usize>) -> String {
        String::from_utf8_lossy(&self.bytes[word.clone()]).into_owned()
    }

    /// The whole line as text, blanks at both ends cut.
    pub fn trimmed(&self) -> String {
        String::from_utf8_lossy(self.bytes.trim_ascii()).into_owned()
    }

    /// The line as text, but for blanks behind it and spaces before it.
    pub fn text(&self) -> String {
        let start = self.bytes.iter().take_while(|b| **b == b' ').count();
        String::from_utf8_lossy(self.bytes[start..].trim_ascii_end()).into_owned()
    }

    /// Where some text in capitals stands first at or after `from`, capital letters or not.
    pub fn find(&self, capitals: &str, from: usize) -> Option<usize> {
        let after = self.bytes.get(from..)?;
        let hit = |w: &[u8]| w.eq_ignore_ascii_case(capitals.as_bytes());
        after.windows(capitals.len()).position(hit).map(|at| from + at)
    }
}

/// White space, or the end-of-file mark that old systems left.
fn is_blank(byte: &u8) -> bool {
    byte.is_ascii_whitespace() || *byte == 0x1A
}

/// See [`Line::words`].
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Iterator for Words<'_> {
    type Item = Range<usize>;

    fn next(&mut self) -> Option<Range<usize>> {
        let start = self.at + self.bytes[self.at..].iter().position(|b| !is_blank(b))?;
        let length = self.bytes[start..].iter().position(is_blank);
        let end = length.map_or(self.bytes.len(), |n| start + n);
        self.at = end;
        Some(start..end)
    }
}

/// The finite number that a word is, correctly rounded; exponents may be written with D.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    decimal::parse(word)
}

/// One unit in the last digit of a number as it is written: 0.001 of `.079`, 1e-5 of `1.04E-03`.
pub(super) fn last_digit(word: &[u8]) -> f64 {
    let exponent = word.iter().position(|b| b.is_ascii_alphabetic());
    let (digits, exponent) = word.split_at(exponent.unwrap_or(word.len()));
    let decimals = digits.iter().rev().position(|&b| b == b'.').unwrap_or(0);
    let one = [b"1", exponent].concat();
    (0..decimals).fold(number(&one).unwrap_or(1.0), |unit, _| unit / 10.0)
}

/// The number that a word with a decimal comma is.
pub(super) fn number_with_comma(word: &[u8]) -> Option<f64> {
    if word.contains(&b'.') {
        return None;
    }
    with_replaced(word, |b| if b == b',' { b'.' } else { b }, number)
}

/// Hands on a short word with some bytes replaced; no number is longer than its 64 bytes.
fn with_replaced(
    word: &[u8],
    replace: impl Fn(u8) -> u8,
    then: impl Fn(&[u8]) -> Option<f64>,
) -> Option<f64> {
    let mut buffer = [0; 64];
    let copy = buffer.get_mut(..word.len())?;
    for (to, &from) in copy.iter_mut().zip(word) {
        *to = replace(from);
    }
    then(copy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_ends() {
        let text = Text::new("t", b"a\nb\r\nc\r\r\nd\re\n\nf").unwrap();
        let lines: Vec<_> = text.lines().map(|l| (l.number, l.trimmed())).collect();
        let expected = ["a", "b", "c", "d", "e", "", "f"];
        assert_eq!(lines.len(), expected.len());
        for (i, (line, word)) in lines.iter().zip(expected).enumerate() {
            assert_eq!((line.0, line.1.as_str()), (i + 1, word));
        }
    }

    #[test]
    fn numbers_are_read_in_every_notation() {
        for (word, value) in [
            ("1", 1.0),
            ("-.8075668E-03", -0.000_807_566_8),
            ("+0.220470", 0.220_47),
            ("1.4275799e-003", 0.001_427_579_9),
            ("1.5D-03", 0.0015),
            ("5.", 5.0),
        ] {
            assert_eq!(number(word.as_bytes()), Some(value), "{word}");
        }
        for word in ["", "nan", "inf", "-Infinity", "1e999", "0.1-0.2", "1,5", "28OO", "0x10", "1 "]
        {
            assert_eq!(number(word.as_bytes()), None, "{word}");
        }
        assert_eq!(number_with_comma(b"-0,125"), Some(-0.125));
        assert_eq!(number_with_comma(b"1.234,5"), None);
        assert_eq!(number_with_comma(b"1,2,3"), None);
    }

    #[test]
    fn zeros_after_the_last_line_are_padding() {
        let padded = Text::new("f", b"1\r\n2\r\n\0\0\0\r\n").unwrap();
        assert_eq!(padded.lines().map(|line| line.trimmed()).collect::<Vec<_>>(), ["1", "2"]);
        assert!(Text::new("f", b"\0\0\n").is_err() && Text::new("f", b"1\n\0\x002\n").is_err());
    }

    #[test]
    fn bytes_that_are_no_text() {
        let message = |bytes: &[u8]| Text::new("f", bytes).err().unwrap().to_string();
        assert_eq!(message(b""), r#"f:1:1: expected a record, found "an empty file""#);
        assert_eq!(message(b" \r\n\n"), r#"f:1:1: expected a record, found "an empty file""#);
        assert_eq!(
            message(b"\xFF\xFE1\0"),
            r#"f:1:1: expected text in UTF-8 or ASCII, found "UTF-16""#
        );
        assert_eq!(
            message(b"1\n23\x004"),
            r#"f:2:3: expected a text file, found "byte 0x00 (a binary file?)""#
        );
        for (bytes, word) in [
            (&b"PK\x03\x04\x14\0"[..], "save each sheet as CSV"),
            (b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1\0", "save each sheet as CSV"),
            (b"\x1F\x8B\x08\0", "unpack it"),
        ] {
            assert!(message(bytes).contains(word), "{}", message(bytes));
        }
    }
}
