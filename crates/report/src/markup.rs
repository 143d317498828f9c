//! HTML and SVG text that cannot be injected into: markup comes only from this crate's own source.
//!
//! [`Markup::raw`] takes `&'static str`, so what a user typed cannot reach it; everything else goes
//! through [`Markup::text`] and [`Markup::attribute`], which escape.

use slipstick::error::is_hidden;
use std::fmt;

/// A growing piece of HTML or SVG.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Markup(String);

impl Markup {
    /// Nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends markup that stands in our own source.
    pub fn raw(&mut self, markup: &'static str) -> &mut Self {
        self.0.push_str(markup);
        self
    }

    /// Appends text; `< > & " '` become entities, control characters that XML forbids and
    /// marks that turn the direction of writing are replaced.
    pub fn text(&mut self, text: impl fmt::Display) -> &mut Self {
        for character in text.to_string().chars() {
            match character {
                '&' => self.0.push_str("&amp;"),
                '<' => self.0.push_str("&lt;"),
                '>' => self.0.push_str("&gt;"),
                '"' => self.0.push_str("&quot;"),
                '\'' => self.0.push_str("&#39;"),
                '\t' | '\n' => self.0.push(character),
                c if is_hidden(c) || matches!(c, '\u{fffe}' | '\u{ffff}') => {
                    self.0.push('\u{fffd}');
                }
                c => self.0.push(c),
            }
        }
        self
    }

    /// Appends ` name="value"`, the value escaped.
    pub fn attribute(&mut self, name: &'static str, value: impl fmt::Display) -> &mut Self {
        self.raw(" ").raw(name).raw("=\"").text(value).raw("\"")
    }

    /// Appends `<tag>text</tag>`, the text escaped; `tag` is a name without attributes.
    pub fn element(&mut self, tag: &'static str, text: impl fmt::Display) -> &mut Self {
        self.raw("<").raw(tag).raw(">").text(text).raw("</").raw(tag).raw(">")
    }

    /// Appends another piece as it is.
    pub fn append(&mut self, other: &Self) -> &mut Self {
        self.0.push_str(&other.0);
        self
    }

    /// Appends a string for a style sheet, with its quotes; all but letters, digits and spaces are
    /// written as CSS escapes, at most `limit` characters of it.
    pub fn css_string(&mut self, text: &str, limit: usize) -> &mut Self {
        self.0.push('"');
        for character in shortened(text, limit).chars() {
            if character.is_ascii_alphanumeric() || character == ' ' {
                self.0.push(character);
            } else if is_hidden(character) {
                self.0.push(' ');
            } else {
                self.0.push_str(&format!("\\{:x} ", character as u32));
            }
        }
        self.0.push('"');
        self
    }

    /// The markup as text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The markup as text.
    #[must_use]
    pub fn into_string(self) -> String {
        self.0
    }
}

/// The text, or its first `limit − 1` characters and an ellipsis.
#[must_use]
pub fn shortened(text: &str, limit: usize) -> String {
    if text.chars().count() <= limit {
        return text.to_owned();
    }
    text.chars().take(limit.saturating_sub(1)).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_attributes_are_escaped() {
        let mut m = Markup::new();
        m.raw("<p").attribute("title", "\" onload='x'").raw(">").text("<script>&\u{1}");
        assert_eq!(
            m.as_str(),
            "<p title=\"&quot; onload=&#39;x&#39;\">&lt;script&gt;&amp;\u{fffd}"
        );
    }

    #[test]
    fn css_strings_hold_no_quote_and_no_angle_bracket() {
        let mut m = Markup::new();
        m.css_string("a\"; } </style>\n", 40);
        assert_eq!(m.as_str(), "\"a\\22 \\3b  \\7d  \\3c \\2f style\\3e  \"");
        let mut long = Markup::new();
        long.css_string("abcdef", 4);
        assert_eq!(long.as_str(), "\"abc\\2026 \"");
    }
}
