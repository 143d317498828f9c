//! A writer of JSON objects with a fixed order of keys; numbers in shortest round-trip digits.
//!
//! Numbers that are not finite become `null`: JSON has no others.

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    /// `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Count(u64),
    /// A number; written as `null` unless finite.
    Number(f64),
    /// A string.
    Text(String),
    /// An array.
    List(Vec<Json>),
    /// An object, its keys in the order given.
    Object(Vec<(&'static str, Json)>),
}

impl From<f64> for Json {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<Option<f64>> for Json {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::Null, Self::Number)
    }
}

impl From<u64> for Json {
    fn from(value: u64) -> Self {
        Self::Count(value)
    }
}

impl From<bool> for Json {
    fn from(value: bool) -> Self {
        Self::Bool(value)
    }
}

impl From<&str> for Json {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

impl Json {
    /// The value as text, indented by two spaces, with a line feed at the end.
    #[must_use]
    pub fn to_pretty(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, 0);
        out.push('\n');
        out
    }

    fn write(&self, out: &mut String, depth: usize) {
        match self {
            Self::Null => out.push_str("null"),
            Self::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
            Self::Count(value) => out.push_str(&value.to_string()),
            // Adding 0 takes the sign off a negative zero; `{:?}` is the shortest round trip.
            Self::Number(value) if value.is_finite() => out.push_str(&format!("{:?}", value + 0.0)),
            Self::Number(_) => out.push_str("null"),
            Self::Text(text) => quoted(out, text),
            Self::List(items) => {
                let items = items.iter().map(|item| (None, item));
                write_items(out, depth, ['[', ']'], items);
            }
            Self::Object(members) => {
                let items = members.iter().map(|(key, value)| (Some(*key), value));
                write_items(out, depth, ['{', '}'], items);
            }
        }
    }
}

fn write_items<'a>(
    out: &mut String,
    depth: usize,
    [open, close]: [char; 2],
    items: impl ExactSizeIterator<Item = (Option<&'static str>, &'a Json)>,
) {
    out.push(open);
    let empty = items.len() == 0;
    for (i, (key, value)) in items.enumerate() {
        out.push_str(if i == 0 { "\n" } else { ",\n" });
        indent(out, depth + 1);
        if let Some(key) = key {
            quoted(out, key);
            out.push_str(": ");
        }
        value.write(out, depth + 1);
    }
    if !empty {
        out.push('\n');
        indent(out, depth);
    }
    out.push(close);
}

fn indent(out: &mut String, depth: usize) {
    out.extend(std::iter::repeat_n("  ", depth));
}

fn quoted(out: &mut String, text: &str) {
    out.push('"');
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            c if c.is_control() => out.push_str(&format!("\\u{:04x}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_double_comes_back() {
        for value in [0.1, 1.0, -2.5e-300, 5e-324, f64::MAX, 1.0 / 3.0, 1e21] {
            let text = Json::Number(value).to_pretty();
            let back: f64 = serde_json::from_str(&text).expect(&text);
            assert_eq!(back.to_bits(), value.to_bits(), "{text}");
        }
        assert_eq!(Json::Number(f64::NAN).to_pretty(), "null\n");
        assert_eq!(Json::Number(f64::NEG_INFINITY).to_pretty(), "null\n");
        assert_eq!(Json::Number(-0.0).to_pretty(), "0.0\n");
    }

    #[test]
    fn exact_any_string_comes_back() {
        let text = "a \"quoted\" \\ name\n\t\u{1}\u{7f} μ </script>";
        let written = Json::from(text).to_pretty();
        assert_eq!(serde_json::from_str::<String>(&written).expect(&written), text);
    }

    #[test]
    fn exact_layout_is_two_spaces_and_keeps_the_order() {
        let value = Json::Object(vec![
            ("b", Json::List(vec![Json::from(1.5), Json::Null])),
            ("a", Json::Object(vec![])),
        ]);
        assert_eq!(value.to_pretty(), "{\n  \"b\": [\n    1.5,\n    null\n  ],\n  \"a\": {}\n}\n");
    }
}
