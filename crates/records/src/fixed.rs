//! Blocks of numbers in FORTRAN's fixed columns, where neighbours may touch: `1.5057E+0-2.2223E+0`.

use core::ops::Range;

use super::text::{Line, Lines, Text, number};
use slipstick_dynamics::error::RecordError;

/// How many numbers stand on a line and how wide each is: `8F10.3` is 8 of 10 characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fields {
    /// Numbers on a full line, at least one.
    pub per_line: usize,
    /// Characters of each, at least one.
    pub width: usize,
    /// Characters before the first, which are blank.
    pub skip: usize,
}

impl Fields {
    /// Fields of a format that the file does not state; both numbers are at least 1.
    pub const fn new(per_line: usize, width: usize) -> Self {
        Self { per_line, width, skip: 0 }
    }

    /// The same after some blank characters at the start of each line.
    pub const fn after(self, skip: usize) -> Self {
        Self { skip, ..self }
    }

    /// The columns of field `i` on a line of some length, cut to it.
    fn columns(self, i: usize, length: usize) -> Range<usize> {
        let start = self.skip + i * self.width;
        start.min(length)..(start + self.width).min(length)
    }

    /// The fields of a format such as `(8f9.6)`, `10I8`, `(1P5E15.7)`: one descriptor only, I, F,
    /// E, D or G.
    pub fn parse(format: &str) -> Option<Self> {
        let format = format.trim().trim_start_matches('(').trim_end_matches(')').trim();
        let format = format.to_ascii_uppercase();
        let format =
            format.strip_prefix("1P").map_or(format.as_str(), |f| f.trim_start_matches(','));
        let letter = format.find(['I', 'F', 'E', 'D', 'G'])?;
        let (repeat, rest) = (format[..letter].trim(), &format[letter + 1..]);
        let width = rest.split('.').next()?.trim();
        let number = |digits: &str| {
            let value = digits.parse::<usize>().ok()?;
            (1..=1000).contains(&value).then_some(value)
        };
        let decimals = rest.split_once('.').map_or(Some(0), |(_, d)| d.trim().parse().ok());
        let per_line = if repeat.is_empty() { 1 } else { number(repeat)? };
        decimals.filter(|&d: &usize| d < 1000)?;
        Some(Self::new(per_line, number(width)?))
    }

    /// The format that a line states in brackets after the word `format`.
    pub fn stated(line: &Line) -> Option<Self> {
        let text = line.trimmed();
        let open = match line.find("FORMAT", 0) {
            Some(_) => text
                .to_ascii_uppercase()
                .find("FORMAT")
                .and_then(|at| text[at..].find('(').map(|open| at + open))?,
            None => text.rfind('(')?,
        };
        let close = text[open..].find(')')? + open;
        Self::parse(&text[open..=close])
    }

    /// Lines that a number of values takes.
    pub fn lines(self, count: usize) -> usize {
        count.div_ceil(self.per_line)
    }
}

/// The lines of a text one after another.
#[derive(Clone)]
pub(super) struct Cursor<'t, 'a> {
    /// The text.
    pub text: &'t Text<'a>,
    lines: Lines<'a>,
}

impl<'t, 'a> Cursor<'t, 'a> {
    /// Before the first line.
    pub fn new(text: &'t Text<'a>) -> Self {
        Self { text, lines: text.lines() }
    }

    /// The next line, which is passed.
    ///
    /// # Errors
    /// What was expected, at the end of the text.
    pub fn next(&mut self, expected: &str) -> Result<Line<'a>, RecordError> {
        let line = self.lines.next();
        line.ok_or_else(|| self.text.error_at_end(expected, "the end of the file"))
    }

    /// The next line, which is not passed.
    pub fn peek(&self) -> Option<Line<'a>> {
        self.lines.clone().next()
    }

    /// The next `count` lines.
    ///
    /// # Errors
    /// As [`Cursor::next`].
    pub fn take(&mut self, count: usize, expected: &str) -> Result<Vec<Line<'a>>, RecordError> {
        (0..count).map(|_| self.next(expected)).collect()
    }

    /// Passes blank lines.
    pub fn skip_blank(&mut self) {
        while self.peek().is_some_and(|line| line.is_blank()) {
            self.lines.next();
        }
    }

    /// Numbers of a header in fixed columns; `None` where a field is blank or no number (asterisks
    /// stand for one that did not fit). Which of them matter is the reader's to check.
    ///
    /// # Errors
    /// Where the text ends before them.
    pub fn header_numbers(
        &mut self,
        fields: Fields,
        count: usize,
        expected: &str,
    ) -> Result<Vec<Option<f64>>, RecordError> {
        let mut numbers = Vec::with_capacity(count);
        for _ in 0..fields.lines(count) {
            let line = self.next(expected)?;
            for i in 0..fields.per_line.min(count - numbers.len()) {
                let field = fields.columns(i, line.bytes.len());
                numbers.push(number(line.bytes[field].trim_ascii()));
            }
        }
        Ok(numbers)
    }

    /// Exactly `count` values, every line full but the last. The first line decides whether the
    /// columns are kept: if they are, every number must end where the first one does in its field,
    /// so that a cut or shifted one is refused; if its numbers stand elsewhere but are apart, blanks
    /// divide the block. `announced` is the line that says how many there are.
    ///
    /// # Errors
    /// For what is no finite number, for a line with another number of values, for a number cut at
    /// the end of the text, and where the text ends before them.
    pub fn values(
        &mut self,
        fields: Fields,
        count: usize,
        announced: &Line,
    ) -> Result<Vec<f64>, RecordError> {
        // A value takes one byte at least, whatever the header promises.
        let mut values = Vec::with_capacity(count.min(self.text.len()));
        let mut right: Option<usize> = None;
        let mut columns = true;
        let first = self.peek().map(|line| Line { bytes: &line.bytes[..0], ..line });
        while values.len() < count {
            let Some(line) = self.lines.next() else {
                let expected = format!("{count} values, as line {} says", announced.number);
                let found = format!("the end after {}", values.len());
                return Err(self.text.error_at_end(expected, &found));
            };
            let on_line = fields.per_line.min(count - values.len());
            if values.is_empty() {
                columns = keeps_columns(&line, fields, on_line);
            }
            if columns {
                self.line_in_columns(&line, fields, on_line, &mut right, &mut values)?;
            } else {
                self.line_of_words(&line, on_line, &mut values)?;
            }
        }
        if !columns && let Some(cut) = first.and_then(|first| self.text.cut_word(&first)) {
            let expected = "a last value written as those before it (a truncated file?)";
            return Err(self.text.error_at_end(expected, &cut));
        }
        Ok(values)
    }

    fn line_in_columns(
        &self,
        line: &Line,
        fields: Fields,
        on_line: usize,
        right: &mut Option<usize>,
        values: &mut Vec<f64>,
    ) -> Result<(), RecordError> {
        for i in 0..on_line {
            let field = fields.columns(i, line.bytes.len());
            let bytes = &line.bytes[field.clone()];
            let blanks = bytes.len() - bytes.trim_ascii_start().len();
            let word = field.start + blanks..field.start + bytes.trim_ascii_end().len().max(blanks);
            if word.is_empty() {
                let expected = format!("{on_line} values on this line");
                return Err(self.text.error_at(line, &word, expected));
            }
            let value = self.text.number(line, &word)?;
            let full = fields.columns(i, usize::MAX).end;
            let apart = full - word.end;
            if *right.get_or_insert(apart) != apart {
                let expected = format!(
                    "a value that ends in column {} as those before it do (a truncated line?)",
                    full - right.unwrap_or(0)
                );
                return Err(self.text.error_at(line, &word, expected));
            }
            values.push(value);
        }
        let rest = fields.columns(on_line, line.bytes.len()).start..line.bytes.len();
        if !line.bytes[rest.clone()].trim_ascii().iter().all(|&b| b == 0x1A) {
            return Err(self.text.error_at(line, &rest, format!("{on_line} values on this line")));
        }
        Ok(())
    }

    fn line_of_words(
        &self,
        line: &Line,
        on_line: usize,
        values: &mut Vec<f64>,
    ) -> Result<(), RecordError> {
        let before = values.len();
        for word in line.words() {
            values.push(self.text.number(line, &word)?);
        }
        let found = values.len() - before;
        if found != on_line {
            let expected = format!("{on_line} values on this line");
            return Err(self.text.error(line, 0, expected, &found.to_string()));
        }
        Ok(())
    }
}

/// Whether each field of a line holds one number, or the line is none of `count` words either.
fn keeps_columns(line: &Line, fields: Fields, count: usize) -> bool {
    let ends: Vec<usize> = line.words().map(|word| word.end).collect();
    if ends.len() != count {
        return true;
    }
    let apart = |i: usize| fields.columns(i, usize::MAX).end.checked_sub(ends[i]);
    let first = apart(0).filter(|&right| right < fields.width);
    first.is_some() && (0..count).all(|i| apart(i) == first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str, fields: Fields, count: usize) -> Result<Vec<f64>, String> {
        let text = Text::new("f", text.as_bytes()).unwrap();
        let mut cursor = Cursor::new(&text);
        let announced = cursor.next("a header").unwrap();
        cursor.values(fields, count, &announced).map_err(|error| error.to_string())
    }

    #[test]
    fn fortran_formats_are_read() {
        for (format, fields) in [
            ("(8f9.6)", Some((8, 9))),
            ("(10I8)", Some((10, 8))),
            ("8F10", Some((8, 10))),
            ("(1P5E15.7)", Some((5, 15))),
            ("(1E15.6)", Some((1, 15))),
            ("E13.6", Some((1, 13))),
            ("(5F15.6)", Some((5, 15))),
            ("(4X,8F10.3)", None),
            ("(2(F7.3,F7.3))", None),
            ("(99999999999999999999F1)", None),
            ("(8F0.3)", None),
            ("cm", None),
        ] {
            let expected = fields.map(|(n, w)| Fields::new(n, w));
            assert_eq!(Fields::parse(format), expected, "{format}");
        }
        let text = Text::new("f", b" 9 pts (cosmos), units=cm/sec2(04),Format=(8F10.5)").unwrap();
        let line = text.lines().next().unwrap();
        assert_eq!(Fields::stated(&line), Some(Fields::new(8, 10)));
    }

    #[test]
    fn touching_fields() {
        let text = "n\n 1.5057E+0-2.2223E+0\n-1.5057E+0 2.2223E+0\n 1.0000E+0\n";
        let expected = vec![1.5057, -2.2223, -1.5057, 2.2223, 1.0];
        assert_eq!(values(text, Fields::new(2, 10), 5), Ok(expected));
        // A blank after every number, and one left out at the end of the line.
        let text = "n\n  1.5  2.5 \n  3.5  4.5\n";
        assert_eq!(values(text, Fields::new(2, 5), 4), Ok(vec![1.5, 2.5, 3.5, 4.5]));
        // Columns other than stated: blanks divide.
        let text = "n\n1.5 2.5\n33.5 4.5\n";
        assert_eq!(values(text, Fields::new(2, 10), 4), Ok(vec![1.5, 2.5, 33.5, 4.5]));
    }

    #[test]
    fn faults_have_their_place() {
        for (text, expected) in [
            (
                "n\n  1.25  2.25\n  3.25  4.2\n",
                "f:3:9: expected a value that ends in column 12 as \
              those before it do (a truncated line?), found \"4.2\"",
            ),
            (
                "n\n  1.25  2.25\n  3.25\n",
                "f:3:7: expected 2 values on this line, found \"the end of the line\"",
            ),
            (
                "n\n  1.25  2.25\n  3.25  4.25  5.25\n",
                "f:3:13: expected 2 values on this line, found \"  5.25\"",
            ),
            (
                "n\n  1.25  2.25\n",
                "f:2:13: expected 4 values, as line 1 says, found \"the end after 2\"",
            ),
            (
                "n\n  1.25******\n  3.25  4.25\n",
                "f:2:7: expected a finite number, found \"******\"",
            ),
            ("n\n1.25 2.25\n3.25\n", "f:3:1: expected 2 values on this line, found \"1\""),
            (
                "n\n1.25 2.25\n3.25 4.2",
                "f:3:9: expected a last value written as those before it (a \
              truncated file?), found \"4.2\"",
            ),
        ] {
            assert_eq!(values(text, Fields::new(2, 6), 4).unwrap_err(), expected);
        }
        let none = values("n\n 1 2\n", Fields::new(1, 2), 1_000_000_000_000).unwrap_err();
        assert!(none.contains("f:2:3: expected 1 values on this line"), "{none}");
    }

    #[test]
    fn header_numbers_may_be_missing() {
        let text = Text::new("f", b"    913043*****     \n    7\n").unwrap();
        let mut cursor = Cursor::new(&text);
        let numbers = cursor.header_numbers(Fields::new(4, 5), 5, "integers").unwrap();
        assert_eq!(numbers, [Some(9.0), Some(13043.0), None, None, Some(7.0)]);
    }
}
