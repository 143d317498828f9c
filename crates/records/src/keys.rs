//! Headers of keys and values, as the networks write them: `NDATA: 13876`, `PGA (m/s/s) : 0.01`.

use core::ops::Range;

use super::fixed::Cursor;
use super::text::{Line, Text, number};
use super::{Options, Quantity, RecordError, Units};
use slipstick_dynamics::motion::MAX_SAMPLES;
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// A value in a header and where it stands; blanks around it are not part of it.
#[derive(Clone)]
pub(super) struct Field<'a> {
    /// Its line.
    pub line: Line<'a>,
    /// Its bytes in the line.
    pub at: Range<usize>,
}

impl<'a> Field<'a> {
    /// What stands on a line from a byte on.
    pub fn from(line: Line<'a>, start: usize) -> Self {
        let end = line.bytes.len();
        Self { line, at: start.min(end)..end }.trimmed()
    }

    /// Without the blanks around it.
    pub fn trimmed(mut self) -> Self {
        let bytes = &self.line.bytes[self.at.clone()];
        let start = self.at.start + (bytes.len() - bytes.trim_ascii_start().len());
        self.at = start..(self.at.start + bytes.trim_ascii_end().len()).max(start);
        self
    }

    /// Its text; `None` where it is empty or says that nothing is known.
    pub fn text(&self) -> Option<String> {
        let text = self.line.str(&self.at);
        let nothing = ["", "none", "unknown", "n/a"];
        (!nothing.iter().any(|word| text.eq_ignore_ascii_case(word))).then_some(text)
    }

    /// Its words.
    pub fn words(&self) -> Vec<Self> {
        let within = |word: &Range<usize>| word.start >= self.at.start && word.end <= self.at.end;
        let words = self.line.words().filter(within);
        words.map(|at| Self { line: self.line, at }).collect()
    }

    /// Its first word, itself where it is empty.
    pub fn first_word(&self) -> Self {
        self.words().into_iter().next().unwrap_or_else(|| self.clone())
    }

    /// Its parts between a separator, in order.
    pub fn split(&self, separator: u8) -> Vec<Self> {
        let bytes = &self.line.bytes[self.at.clone()];
        let mut start = self.at.start;
        bytes
            .split(|&b| b == separator)
            .map(|part| {
                let field = Self { line: self.line, at: start..start + part.len() }.trimmed();
                start += part.len() + 1;
                field
            })
            .collect()
    }

    /// The number at its start and how far its last digit counts: 1e-3 for `0.345`. What follows
    /// the number is not looked at.
    pub fn number(&self) -> Option<(f64, f64)> {
        let bytes = &self.line.bytes[self.at.clone()];
        let is_part = |b: &u8| matches!(b, b'0'..=b'9' | b'.' | b'+' | b'-' | b'e' | b'E');
        let length = bytes.iter().take_while(|b| is_part(b)).count();
        let word = &bytes[..length];
        let value = number(word)?;
        let mantissa = word.split(|b| matches!(b, b'e' | b'E')).next()?;
        let exponent = core::str::from_utf8(&word[mantissa.len()..]).ok()?;
        let exponent: i32 = exponent.get(1..).unwrap_or("0").parse().ok()?;
        let decimals = mantissa.iter().rev().position(|&b| b == b'.').unwrap_or(0);
        let last = i32::try_from(decimals).ok()?;
        Some((value, libm::pow(10.0, f64::from(exponent - last))))
    }

    /// An error at it.
    pub fn error(&self, text: &Text, expected: impl Into<String>) -> RecordError {
        text.error_at(&self.line, &self.at, expected)
    }

    /// A number of values, which is digits only.
    ///
    /// # Errors
    /// For anything else, and past what a record may hold.
    pub fn count(&self, text: &Text, what: &str) -> Result<usize, RecordError> {
        let digits = &self.line.bytes[self.at.clone()];
        if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
            return Err(self.error(text, what));
        }
        match self.line.str(&self.at).parse::<usize>() {
            Ok(count) if (2..=MAX_SAMPLES).contains(&count) => Ok(count),
            _ => Err(self.error(text, format!("{what}, 2 to 100 000 000"))),
        }
    }

    /// A number > 0 that is the whole of it.
    ///
    /// # Errors
    /// For anything else.
    pub fn positive(&self, text: &Text, what: &str) -> Result<f64, RecordError> {
        let value = number(&self.line.bytes[self.at.clone()]).filter(|value| *value > 0.0);
        value.ok_or_else(|| self.error(text, what))
    }

    /// A time step in s; a different one given by the caller is refused.
    ///
    /// # Errors
    /// For anything but a number > 0, and where the caller's is another.
    pub fn step(&self, text: &Text, what: &str, options: &Options) -> Result<f64, RecordError> {
        let dt_s = self.positive(text, what)?;
        self.same_step(text, dt_s, options)
    }

    /// The step read here, unless the caller gives a different one.
    ///
    /// # Errors
    /// Where the caller's step is another.
    pub fn same_step(&self, text: &Text, dt_s: f64, options: &Options) -> Result<f64, RecordError> {
        match options.dt_s {
            Some(given_s) if given_s != dt_s => {
                let expected = format!("the time step given, {given_s} s (leave it out)");
                Err(self.error(text, expected))
            }
            _ => Ok(dt_s),
        }
    }

    /// The units named here; of counts, those that the caller gives for one, if any.
    ///
    /// # Errors
    /// For units that are not known, and where the caller gives other units than the file states.
    pub fn units(&self, text: &Text, options: &Options) -> Result<Units, RecordError> {
        let name = self.line.str(&self.at);
        match (Units::parse(&name), options.units) {
            (Some(stated), Some(given)) if stated.quantity() == Quantity::Counts => Ok(given),
            (Some(stated), Some(given)) if stated != given => {
                Err(self.error(text, format!("the units given, {given} (leave them out)")))
            }
            (Some(stated), _) => Ok(stated),
            _ => Err(self.error(text, "units of acceleration, velocity or displacement")),
        }
    }
}

/// Lines of a header.
pub(super) struct Keys<'a> {
    /// All of them.
    pub lines: Vec<Line<'a>>,
}

impl<'a> Keys<'a> {
    /// What follows a key and a colon; the key stands in capitals or not at the start of its line,
    /// after blanks and `#`.
    pub fn get(&self, key: &str) -> Option<Field<'a>> {
        let of = |line: &Line<'a>| {
            let start = line.bytes.iter().position(|b| !b.is_ascii_whitespace() && *b != b'#')?;
            let rest = line.bytes.get(start + key.len()..)?;
            if !line.bytes[start..start + key.len()].eq_ignore_ascii_case(key.as_bytes()) {
                return None;
            }
            let colon = rest.iter().position(|b| !b.is_ascii_whitespace())?;
            (rest[colon] == b':').then(|| Field::from(*line, start + key.len() + colon + 1))
        };
        self.lines.iter().find_map(of)
    }

    /// The same, which must be there.
    ///
    /// # Errors
    /// At the end of the header where it is not.
    pub fn required(&self, text: &Text, key: &str) -> Result<Field<'a>, RecordError> {
        self.get(key).ok_or_else(|| {
            let last = self.lines.last().copied().unwrap_or(Line { number: 1, bytes: b"" });
            text.error(
                &last,
                0,
                format!("a line \"{key}\" in the header"),
                "none before the values",
            )
        })
    }

    /// The text of a key, where there is one.
    pub fn text(&self, key: &str) -> Option<String> {
        self.get(key)?.text()
    }

    /// A frequency of a key in Hz; 0 is none.
    pub fn hertz(&self, key: &str) -> Option<f64> {
        self.get(key)?.number().map(|(hz, _)| hz).filter(|hz| *hz > 0.0)
    }
}

/// Several texts as one, blanks between; `None` where there is none.
pub(super) fn join(parts: &[Option<String>]) -> Option<String> {
    let parts: Vec<&str> = parts.iter().flatten().map(String::as_str).collect();
    (!parts.is_empty()).then(|| parts.join(" "))
}

/// Rows of `per_line` numbers between blanks, `count` numbers in all and no more; `announced` is the
/// line that says how many there are.
///
/// # Errors
/// For what is no finite number, rows of another length, another number of them, and a number cut
/// at the end of the text.
pub(super) fn rows(
    cursor: &mut Cursor,
    per_line: usize,
    count: usize,
    announced: &Line,
) -> Result<Vec<f64>, RecordError> {
    let text = cursor.text;
    let mut values = Vec::with_capacity(count.min(text.len() / 2 + 1));
    let first = cursor.peek();
    while values.len() < count {
        let Ok(line) = cursor.next("") else {
            let expected = format!("{count} values, as line {} says", announced.number);
            return Err(text.error_at_end(expected, &format!("the end after {}", values.len())));
        };
        let on_line = per_line.min(count - values.len());
        let before = values.len();
        for word in line.words() {
            if values.len() - before == on_line {
                return Err(text.error_at(&line, &word, format!("{on_line} values on this line")));
            }
            values.push(text.number(&line, &word)?);
        }
        if values.len() - before != on_line {
            let end = line.bytes.len()..line.bytes.len();
            return Err(text.error_at(&line, &end, format!("{on_line} values on this line")));
        }
    }
    // Nothing before the first value: the words after it are alike.
    let start = first.map(|line| Line { bytes: &line.bytes[..0], ..line });
    if let Some(cut) = start.and_then(|start| text.cut_word(&start)) {
        let expected = "a last value written as those before it (a truncated file?)";
        return Err(text.error_at_end(expected, &cut));
    }
    Ok(values)
}

/// Nothing but blanks after the values.
///
/// # Errors
/// At the first line that is more.
pub(super) fn end(cursor: &mut Cursor, count: usize, announced: &Line) -> Result<(), RecordError> {
    let is_blank = |line: &Line| line.bytes.iter().all(|b| b.is_ascii_whitespace() || *b == 0x1A);
    while let Some(line) = cursor.peek() {
        if !is_blank(&line) {
            let expected =
                format!("no more than {count} values, as line {} says", announced.number);
            let found = line.trimmed();
            return Err(cursor.text.error(&line, 0, expected, &found));
        }
        cursor.next("")?;
    }
    Ok(())
}

/// Compares the peak that a header states with that of the values, both in the header's units and
/// without sign. Within its last digit it is the same. `factor` is what more a stated peak may be
/// off: up to it a warning says so, past it the units or the values are not what the header says.
///
/// # Errors
/// Where the two differ by more than the factor.
pub(super) fn check_peak(
    text: &Text,
    stated: Option<&Field>,
    values: &[f64],
    units: &str,
    factor: f64,
) -> Result<Option<Notice>, RecordError> {
    let Some((field, (peak, last_digit))) = stated.and_then(|f| Some((f, f.number()?))) else {
        return Ok(None);
    };
    let found = values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let peak = peak.abs();
    if peak == 0.0 || (peak - found).abs() <= 0.501 * last_digit + 1e-6 * peak {
        return Ok(None);
    }
    if found > factor * (peak + last_digit) || found * factor < peak - last_digit {
        let expected = format!("a peak of {found:.6} {units}, as the values have");
        return Err(field.error(text, expected));
    }
    let message = format!(
        "line {} states a peak of {peak} {units}, the values have {found:.6} {units}",
        field.line.number
    );
    Ok(Some(Notice::new(NoticeKind::PeakDiffers, message)))
}

/// Compares the duration that a header states in s with a number of steps or of values.
pub(super) fn check_duration(stated: Option<&Field>, count: usize, dt_s: f64) -> Option<Notice> {
    let field = stated?;
    let (stated_s, last_digit) = field.number().filter(|(duration_s, _)| *duration_s > 0.0)?;
    let duration_s = count as f64 * dt_s;
    let slack_s = last_digit + 1.5 * dt_s + 1e-9 * duration_s;
    ((stated_s - duration_s).abs() > slack_s).then(|| {
        let message = format!(
            "line {} states a duration of {stated_s} s, {count} values at {dt_s} s last {duration_s} s",
            field.line.number
        );
        Notice::new(NoticeKind::DurationDiffers, message)
    })
}

/// How much a stated peak may differ before a record is refused.
pub(super) const PEAK_FACTOR: f64 = 1.5;

/// Azimuth of a channel code of SEED such as `HNE`: its last letter N or E means within 5 degrees.
pub(super) fn azimuth_of_code(code: &str) -> Option<f64> {
    let letters = code.len() == 3 && code.bytes().all(|b| b.is_ascii_alphanumeric());
    match &code.as_bytes().get(2)? {
        b'N' if letters => Some(0.0),
        b'E' if letters => Some(90.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_of_codes() {
        let codes = ["HNE", "HNN", "HNZ", "HN1", "E", "NNE E"];
        assert_eq!(codes.map(azimuth_of_code), [Some(90.0), Some(0.0), None, None, None, None]);
    }

    #[test]
    fn number_and_its_last_digit() {
        let number = |bytes: &'static [u8]| {
            let (value, digit) = Field::from(Line { number: 1, bytes }, 0).number()?;
            Some((value, (1e12 * digit).round() / 1e12))
        };
        assert_eq!(number(b" 6.847"), Some((6.847, 0.001)));
        assert_eq!(number(b"-41.6 mm/s/s at"), Some((-41.6, 0.1)));
        assert_eq!(number(b"1.0022000E-02"), Some((0.010_022, 1e-9)));
        assert_eq!(number(b"12"), Some((12.0, 1.0)));
        assert_eq!(number(b"none"), None);
        assert_eq!(number(b"1e99999999999"), None);
    }

    #[test]
    fn keys_are_found() {
        let text =
            Text::new("f", b"#Rate(Hz): 50\nUNITS: cm/s^2 \n NO. OF : 7\nUNITSX: 3\n").unwrap();
        let keys = Keys { lines: text.lines().collect() };
        assert_eq!(keys.text("rate(hz)").as_deref(), Some("50"));
        assert_eq!(keys.text("UNITS").as_deref(), Some("cm/s^2"));
        assert_eq!(keys.text("NO. OF").as_deref(), Some("7"));
        assert_eq!(keys.text("UNIT"), None);
        let error = keys.required(&text, "NDATA").err().unwrap().to_string();
        assert_eq!(
            error,
            "f:4:1: expected a line \"NDATA\" in the header, found \"none before the values\""
        );
    }
}
