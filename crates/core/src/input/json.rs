//! The few lines of JSON that the schema needs.

use std::fmt::Write as _;

/// A JSON value; objects keep the order of their keys.
pub(super) enum Json {
    False,
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(Vec<(&'static str, Json)>),
}

impl Json {
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    pub fn texts<'a>(texts: impl IntoIterator<Item = &'a str>) -> Self {
        Self::List(texts.into_iter().map(Self::text).collect())
    }

    /// The value as text, two spaces a level, with a newline at the end.
    pub fn pretty(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, 0);
        out.push('\n');
        out
    }

    fn write(&self, out: &mut String, level: usize) {
        match self {
            Self::False => out.push_str("false"),
            // Writing to a String cannot fail.
            Self::Number(value) => drop(write!(out, "{value}")),
            Self::Text(text) => write_text(out, text),
            Self::List(items) if items.is_empty() => out.push_str("[]"),
            Self::List(items) => {
                out.push('[');
                for (index, item) in items.iter().enumerate() {
                    new_line(out, index, level + 1);
                    item.write(out, level + 1);
                }
                new_line(out, 0, level);
                out.push(']');
            }
            Self::Object(entries) if entries.is_empty() => out.push_str("{}"),
            Self::Object(entries) => {
                out.push('{');
                for (index, (key, value)) in entries.iter().enumerate() {
                    new_line(out, index, level + 1);
                    write_text(out, key);
                    out.push_str(": ");
                    value.write(out, level + 1);
                }
                new_line(out, 0, level);
                out.push('}');
            }
        }
    }
}

fn new_line(out: &mut String, items_before: usize, level: usize) {
    if items_before > 0 {
        out.push(',');
    }
    out.push('\n');
    out.push_str(&"  ".repeat(level));
}

fn write_text(out: &mut String, text: &str) {
    out.push('"');
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => drop(write!(out, "\\u{:04x}", u32::from(c))),
            c => out.push(c),
        }
    }
    out.push('"');
}
