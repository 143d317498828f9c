//! A writer of JSON objects with a fixed order of keys; numbers in shortest round-trip digits.
//!
//! Numbers that are not finite become `null`: JSON has no others.

use std::io::{self, Write};

use serde::{Serialize, Serializer};
use serde_json::ser::{Formatter, PrettyFormatter};

pub use crate::summary::keys::worst_keys;

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

impl From<String> for Json {
    fn from(value: String) -> Self {
        Self::Text(value)
    }
}

impl From<&str> for Json {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

impl Serialize for Json {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Null => to.serialize_unit(),
            Self::Bool(value) => to.serialize_bool(*value),
            Self::Count(value) => to.serialize_u64(*value),
            // Adding 0 takes the sign off a negative zero.
            Self::Number(value) if value.is_finite() => to.serialize_f64(value + 0.0),
            Self::Number(_) => to.serialize_unit(),
            Self::Text(text) => to.serialize_str(text),
            Self::List(items) => to.collect_seq(items),
            Self::Object(members) => {
                to.collect_map(members.iter().map(|(key, value)| (key, value)))
            }
        }
    }
}

impl Json {
    /// The value as text, indented by two spaces, with a line feed at the end.
    #[must_use]
    pub fn to_pretty(&self) -> String {
        let mut bytes = Vec::new();
        let layout = Layout(PrettyFormatter::new());
        // Neither a vector of bytes nor a value of ours can fail.
        let _ = self.serialize(&mut serde_json::Serializer::with_formatter(&mut bytes, layout));
        bytes.push(b'\n');
        String::from_utf8(bytes).unwrap_or_default()
    }
}

/// The usual layout, but numbers as Rust writes them: small ones as `1e-5`.
struct Layout(PrettyFormatter<'static>);

/// Methods that are those of the usual layout.
macro_rules! usual {
    ($($name:ident($($flag:ident)?),)*) => {$(
        fn $name<W: ?Sized + Write>(&mut self, to: &mut W $(, $flag: bool)?) -> io::Result<()> {
            self.0.$name(to $(, $flag)?)
        }
    )*};
}

impl Formatter for Layout {
    fn write_f64<W: ?Sized + Write>(&mut self, to: &mut W, value: f64) -> io::Result<()> {
        write!(to, "{value:?}")
    }

    usual! {
        begin_array(),
        end_array(),
        begin_array_value(first),
        end_array_value(),
        begin_object(),
        end_object(),
        begin_object_key(first),
        begin_object_value(),
        end_object_value(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_double_comes_back() {
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
    fn any_string_comes_back() {
        let text = "a \"quoted\" \\ name\n\t\u{1}\u{7f} μ </script>";
        let written = Json::from(text).to_pretty();
        assert_eq!(serde_json::from_str::<String>(&written).expect(&written), text);
    }

    #[test]
    fn layout_is_two_spaces_and_keeps_the_order() {
        let value = Json::Object(vec![
            ("b", Json::List(vec![Json::from(1.5), Json::Null])),
            ("a", Json::Object(vec![])),
        ]);
        assert_eq!(value.to_pretty(), "{\n  \"b\": [\n    1.5,\n    null\n  ],\n  \"a\": {}\n}\n");
    }
}
