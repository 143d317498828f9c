//! What stands before the numbers: comments, text, names of the columns with their units.

use super::style::Separator;
use super::table::TextTable;
use super::texts::cell_ranges;
use crate::text::{Line, Text, number, number_with_comma};
use crate::unit::{Quantity, Units, seconds};
use slipstick_dynamics::error::RecordError;
use slipstick_dynamics::units::{Dimension, parse_unit};

/// Most lines of text, comments not counted, before the numbers; more where the last of them names
/// columns of times and of motion with their units.
const TEXT_LINES: usize = 8;
/// Most lines before the numbers of a file whose header says all that is needed.
const HEADER_LINES: usize = 1000;

/// The lines before the first line of numbers.
pub(super) struct Header<'a> {
    /// The last line of text, else of comment: perhaps the names of the columns.
    last: Option<Line<'a>>,
    /// The line of text before that: the names, where the last one holds their units.
    before: Option<Line<'a>>,
    /// Whether the last line is text, not a comment.
    is_text: bool,
    /// The line of text that is one more than usual.
    too_many: Option<Line<'a>>,
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

/// Whether a line before the numbers is text: it begins like a word, perhaps behind columns without a
/// name, and is no `nan` or `inf`.
fn is_text(line: &Line) -> bool {
    let bytes = line.bytes.trim_ascii();
    let unnamed = bytes.iter().take_while(|b| matches!(b, b',' | b';' | b' ' | b'\t')).count();
    let bytes = &bytes[unnamed..];
    // Numbers between quotes are numbers.
    let quoted = bytes.strip_prefix(b"\"").and_then(<[u8]>::first);
    let is_number = quoted.is_some_and(|b| b.is_ascii_digit() || matches!(b, b'-' | b'+' | b'.'));
    let begins = !is_number
        && bytes.first().is_some_and(|b| {
            b.is_ascii_alphabetic()
                || !b.is_ascii()
                || matches!(b, b'"' | b'\'' | b'(' | b'[' | b'_')
        });
    let word = bytes.split(|b| b.is_ascii_whitespace() || matches!(b, b',' | b';')).next();
    let not_finite = |word: &[u8]| {
        let text = core::str::from_utf8(word).ok();
        text.is_some_and(|w| w.parse::<f64>().is_ok()) && number(word).is_none()
    };
    begins && !word.is_some_and(not_finite)
}

/// Whether a line holds a word of two letters or more beside its numbers, or nothing but marks: part of
/// a header, where text follows.
fn is_prose(line: &Line) -> bool {
    let is_word = |word: &&[u8]| {
        let letters = word.iter().filter(|b| b.is_ascii_alphabetic()).count();
        let missing = [&b"nan"[..], b"inf", b"null", b"none", b"na"];
        letters >= 2 && !missing.iter().any(|m| word.eq_ignore_ascii_case(m))
    };
    let words = || line.bytes.split(|b| !(b.is_ascii_alphanumeric() || *b == b'.'));
    words().any(|word| is_word(&word)) || words().all(<[u8]>::is_empty)
}

/// Which cells of a row that begins with text are numbers, and what divides them.
#[derive(PartialEq)]
struct RowShape {
    separator: u8,
    is_number: Vec<bool>,
}

impl RowShape {
    fn of(line: &Line, separator: u8) -> Self {
        let cells = cells(line.bytes, separator).into_iter();
        let is_number = |cell: &[u8]| {
            number(cell).is_some() || (separator != b',' && number_with_comma(cell).is_some())
        };
        Self { separator, is_number: cells.map(is_number).collect() }
    }

    /// That of the rows of a file whose last line begins with text and has numbers behind it.
    fn of_rows(text: &Text) -> Option<Self> {
        let last = text.last_line(is_comment).filter(is_text)?;
        let all = [b'\t', b';', b','].into_iter().map(|separator| Self::of(&last, separator));
        let is_row = |shape: &Self| shape.is_number.len() > 1 && shape.is_number.contains(&true);
        all.into_iter().find(is_row)
    }

    fn is_of(&self, line: &Line) -> bool {
        *self == Self::of(line, self.separator)
    }
}

/// The cells of a line without the blanks around them.
fn cells(line: &[u8], separator: u8) -> Vec<&[u8]> {
    cell_ranges(line, separator).into_iter().map(|range| &line[range]).collect()
}

impl<'a> Header<'a> {
    /// The lines before the numbers.
    ///
    /// # Errors
    /// Where no numbers follow soon.
    pub fn of(text: &Text<'a>) -> Result<Self, RecordError> {
        let mut header =
            Self { last: None, before: None, is_text: false, too_many: None, lines: 0 };
        let mut texts = 0;
        let mut prose = false;
        let rows = RowShape::of_rows(text);
        for (index, line) in text.lines().enumerate() {
            let (comment, words) = (is_comment(&line), is_text(&line));
            if words && rows.as_ref().is_some_and(|rows| rows.is_of(&line)) {
                return header.known(text);
            }
            if !line.is_blank() && !comment && !words {
                if index < HEADER_LINES && is_prose(&line) {
                    prose = true;
                    continue;
                }
                return header.known(text);
            }
            let has_words = line.bytes.iter().any(u8::is_ascii_alphanumeric);
            if comment && !header.is_text && has_words {
                header.last = Some(line);
            } else if words {
                texts += 1;
                prose = false;
                header.before = header.last.filter(|_| header.is_text);
                (header.last, header.is_text) = (Some(line), true);
                if texts > TEXT_LINES {
                    header.too_many.get_or_insert(line);
                }
            }
            // Prose belongs to the header where text stands below it.
            if words || index == header.lines {
                header.lines = index + 1;
            }
        }
        match header.too_many {
            Some(_) => Err(header.unknown(text)),
            // Every row has words beside its numbers.
            None if prose => header.known(text),
            None => Err(text.error_at_end("numbers", "the end of the file")),
        }
    }

    /// The header, unless it is long and its names do not say what the columns are.
    fn known(self, text: &Text) -> Result<Self, RecordError> {
        let says_enough = |line: &Line| {
            let separators = [Separator::Byte(b','), Separator::Byte(b';'), Separator::Blank];
            separators.into_iter().any(|separator| {
                let names = split(&comment_mark_cut(line), separator);
                let units: Vec<_> = names.iter().filter_map(|name| unit(name)).collect();
                units.iter().any(|unit| matches!(unit, Unit::Motion(_)))
                    && units.iter().any(|unit| matches!(unit, Unit::Time(_)))
            })
        };
        if self.too_many.is_some() && !self.last.as_ref().is_some_and(says_enough) {
            return Err(self.unknown(text));
        }
        Ok(self)
    }

    fn unknown(&self, text: &Text) -> RecordError {
        let expected = format!(
            "a format that is recognised, or text with at most {TEXT_LINES} lines before its numbers"
        );
        let line = self.too_many.unwrap_or(Line { number: 1, bytes: b"" });
        text.error(&line, 0, expected, &line.trimmed())
    }

    /// Names of the columns, where the last line has as many as there are columns.
    ///
    /// # Errors
    /// Where a line of text is divided as the numbers are, but has another count.
    pub fn names(&self, text: &Text, table: &TextTable) -> Result<Option<Vec<Name>>, RecordError> {
        let (separator, columns) = (table.style.separator, table.columns);
        let Some(line) = &self.last else { return Ok(None) };
        if let Some(names) = self.with_units(text, separator, columns)? {
            return Ok(Some(names));
        }
        let mut words = named(&comment_mark_cut(line), separator, columns);
        // Some programs leave the column that numbers the rows without a name.
        if words.len() + 1 == columns && columns > 1 && table.counts_rows() {
            words.insert(0, String::new());
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
        let names = named(&before.text(), separator, columns);
        let units = last.text();
        let units: Vec<String> = match separator {
            Separator::Blank if !units.contains('\t') => {
                units.split_whitespace().map(str::to_owned).collect()
            }
            separator => named(&units, separator, columns),
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

    /// The line that names the columns; empty where there is none.
    pub fn names_line(&self) -> String {
        self.last.as_ref().map_or_else(String::new, Line::trimmed)
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
    let text = line.text();
    let marked = is_comment(line);
    let cut = text.trim_start().trim_start_matches(['#', '%', '!', '/', '*']);
    if marked { cut.to_owned() } else { text }
}

/// Names on a line over so many columns: empty ones behind the last name, and a tab before the first,
/// are none where the columns are fewer.
fn named(line: &str, separator: Separator, columns: usize) -> Vec<String> {
    let mut names = split(line, separator);
    while names.len() > columns && names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    if names.len() > columns && names.first().is_some_and(String::is_empty) {
        names.remove(0);
    }
    names
}

/// Names on a line; a unit in brackets belongs to the word before it.
fn split(line: &str, separator: Separator) -> Vec<String> {
    let clean = |name: &str| name.trim().trim_matches(['"', '\'']).trim().to_owned();
    match separator {
        Separator::Byte(byte) => {
            let cells = cells(line.as_bytes(), byte).into_iter();
            cells.map(|cell| clean(&String::from_utf8_lossy(cell))).collect()
        }
        Separator::Blank if line.contains('\t') => line.split('\t').map(clean).collect(),
        Separator::Blank => {
            let mut names: Vec<String> = Vec::new();
            for word in line.split_whitespace() {
                match names.last_mut() {
                    Some(name) if word.starts_with(['(', '[', '{']) => {
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

    /// The name without its unit.
    pub fn base(&self) -> &str {
        let suffix = || suffixes(&self.text).find(|(_, word)| known(word).is_some());
        let word = || last_word(&self.text).filter(|(_, word)| known(word).is_some());
        bracket(&self.text).or_else(suffix).or_else(word).map_or(&self.text, |(base, _)| base)
    }

    /// Whether it is the ground acceleration of Eurocode 8, which states no unit.
    pub fn is_ground_acceleration(&self) -> bool {
        is_symbol_of_ground(&self.text)
    }

    /// What stands in brackets behind it where no unit of any quantity is called that.
    pub fn unknown_unit(&self) -> Option<&str> {
        let (_, word) = bracket(&self.text).filter(|_| self.unit == Some(Unit::Other))?;
        let is_known = Dimension::ALL.iter().any(|of| parse_unit(word, *of).is_ok());
        (!is_known && !word.is_empty()).then_some(word)
    }

    /// Whether its unit is one of time.
    pub fn has_time_unit(&self) -> bool {
        matches!(self.unit, Some(Unit::Time(_)))
    }
}

/// `name (unit)`, in any brackets, in two.
pub fn bracket(name: &str) -> Option<(&str, &str)> {
    const OPEN: [char; 4] = ['(', '[', '{', '<'];
    let (start, unit) = name.trim().strip_suffix([')', ']', '}', '>'])?.rsplit_once(OPEN)?;
    Some((start.trim(), unit.trim()))
}

/// What follows each underscore of a name, the longest first, with what stands before.
fn suffixes(name: &str) -> impl Iterator<Item = (&str, &str)> {
    let all = name.match_indices('_').map(|(at, _)| (&name[..at], &name[at + 1..]));
    // No unit is as long as that.
    all.filter(|(_, suffix)| (1..=24).contains(&suffix.len()))
}

/// The last of several words of a name, with what stands before: `Time s`, `a / (m/s²)`, `Sa, g`.
fn last_word(name: &str) -> Option<(&str, &str)> {
    let (base, word) = name.trim().rsplit_once(char::is_whitespace)?;
    let base = base.trim_end().trim_end_matches(['/', ',', ':']).trim_end();
    let base = base.strip_suffix(" in").unwrap_or(base);
    (!base.is_empty()).then_some((base, word))
}

/// A unit of motion or of time.
fn known(word: &str) -> Option<Unit> {
    Units::parse(word).map(Unit::Motion).or_else(|| seconds(word).map(Unit::Time))
}

/// The unit in a column's name: in brackets, after an underscore (`_m_per_s2`), or as its last word.
fn unit(name: &str) -> Option<Unit> {
    if let Some((_, word)) = bracket(name) {
        return Some(known(word).unwrap_or(Unit::Other));
    }
    if is_symbol_of_ground(name) {
        return None;
    }
    let others = ["n", "kn", "j", "hz", "rad", "deg", "kg"];
    let of_suffix = |(_, suffix): (&str, &str)| {
        let other = others.contains(&suffix.to_lowercase().as_str());
        known(suffix).or_else(|| other.then_some(Unit::Other))
    };
    let of_word = || known(last_word(name)?.1);
    suffixes(name).find_map(of_suffix).or_else(of_word).or_else(|| unit_alone(name))
}

/// The unit that is all that a name says: `seconds`, `m/s2`. `NS` is a direction and `min` a least value.
fn unit_alone(name: &str) -> Option<Unit> {
    let word = name.trim();
    let is_time = word == "s" || word == "ms" || (word.len() > 2 && word.to_lowercase() != "min");
    match known(word)? {
        Unit::Time(second) => is_time.then_some(Unit::Time(second)),
        Unit::Motion(units) if units.quantity() == Quantity::Acceleration => {
            Some(Unit::Motion(units))
        }
        _ => None,
    }
}

/// Whether a name is that of the ground acceleration of Eurocode 8, `a_g` or `u_g`, whose letter g is
/// no unit.
fn is_symbol_of_ground(name: &str) -> bool {
    let mut letters = name.trim().chars();
    let (symbol, rest) = (letters.next(), letters.as_str());
    symbol.is_some_and(|c| !c.is_ascii_digit()) && rest.eq_ignore_ascii_case("_g")
}
