//! A parsed text as a tree whose every key and value knows where it stands.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{InputError, Place, cut};
use crate::numerics::sort;

/// A place in one of the texts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct SourceSpan {
    /// Index of the text in [`Sources`].
    pub source: usize,
    /// Its bytes.
    pub span: Range<usize>,
}

/// The texts that errors point into: the file first, then the options that set keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sources(Vec<(String, String)>);

/// A table's keys in the order of the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TomlTable(pub Vec<Entry>);

/// A key and its value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub name: String,
    /// Where the key stands.
    pub key: SourceSpan,
    pub node: Node,
}

/// A value and where it stands; of a table with a header, the header.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    pub spot: SourceSpan,
    pub value: Value,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Text(String),
    /// A number and how it was written.
    Number(f64, String),
    /// A number in the SI unit of its key, and how it would be written with that.
    Si(f64, String),
    /// A truth value or a date: no key takes one.
    Other(String),
    List(Vec<Node>),
    Table(TomlTable),
}

impl Sources {
    /// Adds a text and returns its index.
    pub fn add(&mut self, name: &str, text: &str) -> usize {
        self.0.push((name.to_owned(), text.to_owned()));
        self.0.len() - 1
    }

    /// The error at a place.
    pub fn error(
        &self,
        spot: &SourceSpan,
        path: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> InputError {
        let (name, text) = self.0.get(spot.source).map_or(("", ""), |(n, t)| (n, t));
        let (line, column) = line_and_column(text, spot.span.start);
        let span = spot.span.clone();
        InputError {
            place: Box::new(Place { source_name: name.to_owned(), line, column, span }),
            path: path.to_owned(),
            expected: expected.into(),
            found: found.into(),
            nearest: None,
        }
    }
}

/// Line and column, from 1, of a byte; the column counts characters, and a byte order mark is none.
pub(super) fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = 1 + before.bytes().filter(|b| *b == b'\n').count();
    let column = 1 + before[start..].chars().filter(|c| *c != '\u{feff}').count();
    (line, column)
}

impl TomlTable {
    pub fn get(&self, name: &str) -> Option<&Entry> {
        self.0.iter().find(|entry| entry.name == name)
    }

    fn from_toml(table: DeTable<'_>, source: usize) -> Self {
        let mut entries: Vec<Entry> = table
            .into_iter()
            .map(|(key, value)| Entry {
                key: SourceSpan { source, span: key.span() },
                name: key.into_inner().into_owned(),
                node: Node::from_toml(value, source),
            })
            .collect();
        sort(&mut entries, |a: &Entry, b| a.key.span.start.cmp(&b.key.span.start));
        Self(entries)
    }
}

impl Node {
    fn from_toml(value: Spanned<DeValue<'_>>, source: usize) -> Self {
        let spot = SourceSpan { source, span: value.span() };
        let value = match value.into_inner() {
            DeValue::String(text) => Value::Text(text.into_owned()),
            DeValue::Integer(integer) => {
                let written = integer.to_string();
                let value = match integer.radix() {
                    10 => written.parse().unwrap_or(f64::NAN),
                    // Bit patterns are no measurements, but 0x10 is a number all the same.
                    radix => u64::from_str_radix(integer.as_str(), radix)
                        .map_or(f64::NAN, |value| value as f64),
                };
                Value::Number(value, written)
            }
            DeValue::Float(float) => {
                let written = float.to_string();
                Value::Number(written.parse().unwrap_or(f64::NAN), written)
            }
            DeValue::Boolean(value) => Value::Other(value.to_string()),
            DeValue::Datetime(value) => Value::Other(format!("the date {value}")),
            DeValue::Array(list) => {
                let nodes = list.into_iter().map(|value| Self::from_toml(value, source));
                Value::List(nodes.collect())
            }
            DeValue::Table(table) => Value::Table(TomlTable::from_toml(table, source)),
        };
        Self { spot, value }
    }

    /// A number without a unit: as it stands, or in percent, `"6 %"`.
    pub fn ratio(&self) -> Option<f64> {
        match &self.value {
            Value::Number(value, _) => Some(*value),
            Value::Text(text) => {
                let percent = text.trim().strip_suffix('%')?.trim_end();
                percent.parse::<f64>().ok().map(|percent| percent / 100.0)
            }
            _ => None,
        }
    }

    /// What stands here, for a message.
    pub fn found(&self) -> String {
        match &self.value {
            Value::Text(text) | Value::Si(_, text) => format!("\"{}\"", cut(text)),
            Value::Number(_, written) | Value::Other(written) => cut(written),
            Value::List(_) => "a list".to_owned(),
            Value::Table(_) => "a table".to_owned(),
        }
    }
}

/// Reads a text as TOML.
pub(super) fn parse_document(sources: &Sources, source: usize) -> Result<TomlTable, InputError> {
    let text = sources.0.get(source).map_or("", |(_, text)| text.as_str());
    match DeTable::parse(text) {
        Ok(table) => Ok(TomlTable::from_toml(table.into_inner(), source)),
        Err(error) => Err(syntax_error(sources, source, text, &error)),
    }
}

/// Reads a value as TOML that stands at the byte `start` of a text; as text where it is no TOML.
pub(super) fn parse_value(text: &str, source: usize, start: usize) -> Node {
    match DeValue::parse(text) {
        Ok(value) => {
            let mut node = Node::from_toml(value, source);
            node.shift(start);
            node
        }
        Err(_) => {
            let spot = SourceSpan { source, span: start..start + text.len() };
            Node { spot, value: Value::Text(text.to_owned()) }
        }
    }
}

impl Node {
    /// Moves all places by `offset` bytes.
    fn shift(&mut self, offset: usize) {
        let shifted = |spot: &mut SourceSpan| {
            spot.span = spot.span.start + offset..spot.span.end + offset;
        };
        shifted(&mut self.spot);
        match &mut self.value {
            Value::List(nodes) => nodes.iter_mut().for_each(|node| node.shift(offset)),
            Value::Table(table) => {
                for entry in &mut table.0 {
                    shifted(&mut entry.key);
                    entry.node.shift(offset);
                }
            }
            _ => {}
        }
    }
}

/// A fault of the TOML itself. Its reader says `what is wrong, expected this`, where it can.
fn syntax_error(
    sources: &Sources,
    source: usize,
    text: &str,
    error: &toml::de::Error,
) -> InputError {
    let span = error.span().unwrap_or(text.len()..text.len());
    if let Some((spot, found)) = decimal_comma(text, span.start) {
        let expected = format!("a decimal point, {}", found.replace(',', "."));
        return sources.error(&SourceSpan { source, span: spot }, "", expected, found);
    }
    let (wrong, expected) = match error.message() {
        message if message.starts_with("string values must be quoted") => {
            ("", "a number, or text in double quotes")
        }
        "duplicate key" => ("", "each key and table once"),
        message => message.split_once(", expected ").unwrap_or((message, "TOML")),
    };
    let word = text.get(span.clone()).map(|word| word.trim_end()).unwrap_or_default();
    let found = match (wrong, word) {
        ("", "") => "nothing".to_owned(),
        ("", word) => format!("\"{}\"", cut(word)),
        (wrong, "") => wrong.to_owned(),
        (wrong, word) => format!("{wrong}: \"{}\"", cut(word)),
    };
    sources.error(&SourceSpan { source, span }, "", expected, found)
}

/// A number whose decimals follow a comma, which stands at a byte of the text or begins there.
fn decimal_comma(text: &str, at: usize) -> Option<(Range<usize>, String)> {
    let bytes = text.as_bytes();
    let part = |b: &u8| b.is_ascii_digit() || *b == b',';
    let before = bytes.get(..at)?.iter().rev().take_while(|b| part(b)).count();
    let after = bytes.get(at..)?.iter().take_while(|b| part(b)).count();
    let span = at - before..at + after;
    let (whole, decimals) = text.get(span.clone())?.split_once(',')?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    (digits(whole) && digits(decimals)).then(|| (span, format!("{whole},{decimals}")))
}
