//! What stands before the numbers: comments, text, names of the columns with their units.

use super::style::Separator;
use crate::text::{Line, Text, number};
use crate::unit::{Units, seconds};
use slipstick_dynamics::error::RecordError;
use slipstick_dynamics::units::{Dimension, parse_unit};

/// Most lines of text, comments not counted, before the numbers.
const TEXT_LINES: usize = 8;

/// The lines before the first line of numbers.
pub(super) struct Header<'a> {
    /// The last line of text, else of comment: perhaps the names of the columns.
    last: Option<Line<'a>>,
    /// The line of text before that: the names, where the last one holds their units.
    before: Option<Line<'a>>,
    /// Whether the last line is text, not a comment.
    is_text: bool,
    /// Lines before the first of numbers.
    pub lines: usize,
}

/// A column's name and what its unit says.
#[derive(Clone, Debug)]
pub(super) struct Name {
    /// As it stands in the file.
    pub text: String,
    /// Its unit, where one is stated.
    pub unit: Option<Unit>,
}

/// What a column's unit says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unit {
    /// Time: seconds in one of them.
    Time(f64),
    /// Acceleration, velocity or displacement.
    Motion(Units),
    /// Anything else.
    Other,
}

/// Whether a line is a comment.
pub(super) fn is_comment(line: &Line) -> bool {
    let bytes = line.bytes.trim_ascii_start();
    let marked =
        matches!(bytes.first(), Some(b'#' | b'%' | b'!' | b'*')) || bytes.starts_with(b"//");
    // A number that did not fit its field is printed as asterisks: not a comment.
    marked && (bytes[0] != b'*' || bytes.iter().any(u8::is_ascii_alphabetic))
}

/// Whether a line before the numbers is text: it begins like a word, and is no `nan` or `inf`.
fn is_text(line: &Line) -> bool {
    let bytes = line.bytes.trim_ascii();
    let begins = bytes.first().is_some_and(|b| {
        b.is_ascii_alphabetic() || !b.is_ascii() || matches!(b, b'"' | b'\'' | b'(' | b'[' | b'_')
    });
    let word = bytes.split(|b| b.is_ascii_whitespace() || matches!(b, b',' | b';')).next();
    let not_finite = |word: &[u8]| {
        let text = core::str::from_utf8(word).ok();
        text.is_some_and(|w| w.parse::<f64>().is_ok()) && number(word).is_none()
    };
    begins && !word.is_some_and(not_finite)
}

impl<'a> Header<'a> {
    /// The lines before the numbers.
    ///
    /// # Errors
    /// Where no numbers follow soon.
    pub fn of(text: &Text<'a>) -> Result<Self, RecordError> {
        let mut header = Self { last: None, before: None, is_text: false, lines: 0 };
        let mut texts = 0;
        for line in text.lines() {
            if !line.is_blank() && !is_comment(&line) && !is_text(&line) {
                return Ok(header);
            }
            header.lines += 1;
            if is_comment(&line) && !header.is_text {
                header.last = Some(line);
            } else if is_text(&line) {
                texts += 1;
                header.before = header.last.filter(|_| header.is_text);
                (header.last, header.is_text) = (Some(line), true);
            }
            if texts > TEXT_LINES {
                let expected = format!(
                    "a format that is recognised, or text with at most {TEXT_LINES} lines before \
                     its numbers"
                );
                return Err(text.error(&line, 0, expected, &line.trimmed()));
            }
        }
        Err(text.error_at_end("numbers", "the end of the file"))
    }

    /// Names of the columns, where the last line has as many as there are columns.
    ///
    /// # Errors
    /// Where a line of text is divided as the numbers are, but has another count; and for the
    /// header of a spectrum.
    pub fn names(
        &self,
        text: &Text,
        separator: Separator,
        columns: usize,
    ) -> Result<Option<Vec<Name>>, RecordError> {
        let Some(line) = &self.last else { return Ok(None) };
        if let Some(names) = self.with_units(text, separator, columns)? {
            return Ok(Some(names));
        }
        let words = split(&comment_mark_cut(line), separator);
        let begins = words.first().map_or(String::new(), |word| word.to_lowercase());
        if begins.starts_with("period") || begins.starts_with("freq") {
            return Err(text.error(line, 0, "a time history, not a spectrum", &line.trimmed()));
        }
        if words.len() == columns {
            if self.is_named_before(separator, &words) {
                let expected = "one line of names, or names and below them their units";
                return Err(text.error(line, 0, expected, "names on two lines"));
            }
            return Ok(Some(words.into_iter().map(Name::of).collect()));
        }
        if self.is_text && separator != Separator::Blank && words.len() > 1 {
            let expected = format!("{columns} names, one a column of numbers");
            return Err(text.error(line, 0, expected, &format!("{} names", words.len())));
        }
        Ok(None)
    }

    /// Whether the line before the names holds names too: the same, or some with a unit.
    fn is_named_before(&self, separator: Separator, words: &[String]) -> bool {
        let before = self.before.map_or(Vec::new(), |line| split(&line.trimmed(), separator));
        let named = |word: &String| Name::of(word.clone()).unit.is_some();
        before.len() == words.len() && (before == words || before.iter().any(named))
    }

    /// Names on one line and their units on the next, as data loggers write them.
    ///
    /// # Errors
    /// For a name that states another unit than the one below it.
    fn with_units(
        &self,
        text: &Text,
        separator: Separator,
        columns: usize,
    ) -> Result<Option<Vec<Name>>, RecordError> {
        let (Some(before), Some(last)) = (self.before, self.last) else { return Ok(None) };
        let names = split(&before.trimmed(), separator);
        let units = last.trimmed();
        let units: Vec<String> = match separator {
            Separator::Blank if !units.contains('\t') => {
                units.split_whitespace().map(str::to_owned).collect()
            }
            separator => split(&units, separator),
        };
        let bare = |unit: &String| unit.trim_matches(['(', ')', '[', ']']).trim().to_owned();
        let units: Vec<String> = units.iter().map(bare).collect();
        // A force or an angle may stand beside the motion.
        let other = |unit: &String| Dimension::ALL.iter().any(|of| parse_unit(unit, *of).is_ok());
        let known =
            |unit: &String| Units::parse(unit).is_some() || seconds(unit).is_some() || other(unit);
        let nothing = |unit: &String| unit.is_empty() || unit == "-";
        let are_units = units.iter().all(|unit| known(unit) || nothing(unit));
        if names.len() != columns || units.len() != columns || !are_units {
            return Ok(None);
        }
        let both = |(name, unit): (&String, &String)| match bracket(name) {
            _ if !known(unit) => Ok(Name::of(name.clone())),
            None => Ok(Name::of(format!("{name} ({unit})"))),
            Some((_, stated)) if stated == unit => Ok(Name::of(name.clone())),
            Some(_) => Err(text.error(&last, 0, format!("the unit of {name:?}"), unit)),
        };
        let named = || names.iter().zip(&units).map(both).collect::<Result<_, _>>();
        units.iter().any(known).then(named).transpose()
    }

    /// How many names the last line has with a separator.
    pub fn count(&self, separator: Separator) -> usize {
        self.last.as_ref().map_or(0, |line| split(&comment_mark_cut(line), separator).len())
    }

    /// An error about the header, or the file where it has none.
    pub fn error(&self, text: &Text, expected: impl Into<String>, found: &str) -> RecordError {
        match &self.last {
            Some(line) => text.error(line, 0, expected, found),
            None => text.error_at_start(expected, found),
        }
    }
}

fn comment_mark_cut(line: &Line) -> String {
    line.trimmed().trim_start_matches(['#', '%', '!', '/', '*']).to_owned()
}

/// Names on a line; a unit in brackets belongs to the word before it.
fn split(line: &str, separator: Separator) -> Vec<String> {
    let clean = |name: &str| name.trim().trim_matches(['"', '\'']).trim().to_owned();
    match separator {
        Separator::Byte(byte) => line.split(char::from(byte)).map(clean).collect(),
        Separator::Blank if line.contains('\t') => line.trim().split('\t').map(clean).collect(),
        Separator::Blank => {
            let mut names: Vec<String> = Vec::new();
            for word in line.split_whitespace() {
                match names.last_mut() {
                    Some(name) if word.starts_with(['(', '[']) => {
                        name.push(' ');
                        name.push_str(word);
                    }
                    _ => names.push(clean(word)),
                }
            }
            names
        }
    }
}

impl Name {
    fn of(text: String) -> Self {
        let unit = unit(&text);
        Self { text, unit }
    }

    /// Whether the column holds times.
    pub fn is_time(&self) -> bool {
        matches!(self.unit, Some(Unit::Time(_)))
            || matches!(self.text.to_lowercase().as_str(), "t" | "time")
    }
}

/// `name (unit)` or `name [unit]`, in two.
pub fn bracket(name: &str) -> Option<(&str, &str)> {
    let (start, unit) = name.trim().strip_suffix([')', ']'])?.rsplit_once(['(', '['])?;
    Some((start.trim(), unit.trim()))
}

/// The unit in a column's name: in brackets, or after an underscore (`_m_per_s2`).
fn unit(name: &str) -> Option<Unit> {
    let known = |word: &str| {
        let time = || seconds(word).map(Unit::Time);
        Units::parse(word).map(Unit::Motion).or_else(time)
    };
    if let Some((_, word)) = bracket(name) {
        return Some(known(word).unwrap_or(Unit::Other));
    }
    let suffixes = name.match_indices('_').map(|(at, _)| &name[at + 1..]);
    let mut suffixes = suffixes.filter(|suffix| !suffix.is_empty());
    let others = ["n", "kn", "j", "hz", "rad", "deg", "kg"];
    suffixes.find_map(|suffix| {
        let other = others.contains(&suffix.to_lowercase().as_str());
        known(suffix).or_else(|| other.then_some(Unit::Other))
    })
}
