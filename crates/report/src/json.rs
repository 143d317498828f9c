//! JSON as it is written here: keys in the order of the code, numbers in shortest round-trip digits.
//!
//! Numbers that are not finite become `null`: JSON has no others.

use std::io::{self, Write};

use serde::Serializer;
use serde_json::ser::{Formatter, PrettyFormatter};
use slipstick::table::Cells;

pub use crate::summary::keys::worst_keys;
// For [`view`](crate::view) in other crates.
pub use serde::{self, Serialize};

/// A struct without a name that serialises: its keys with their values, in this order.
///
/// A key alone has the value of the variable of its name. `#[serde(flatten)]` before a key puts the keys of its
/// value in its place, none of them for `None`.
///
/// ```
/// use slipstick_report::{json::pretty, view};
///
/// let unit = "m";
/// let above = None.map(|above: f64| view! { above });
/// let text = pretty(&view! { name: "gap", unit, #[serde(flatten)] above });
/// assert_eq!(text, "{\n  \"name\": \"gap\",\n  \"unit\": \"m\"\n}\n");
/// ```
#[macro_export]
macro_rules! view {
    ($($(#[$attribute:meta])* $key:ident $(: $value:expr)?),* $(,)?) => {{
        #[allow(non_camel_case_types, non_snake_case)]
        let view = {
            #[derive($crate::json::serde::Serialize)]
            #[serde(crate = "slipstick_report::json::serde")]
            struct View<$($key),*> {
                $($(#[$attribute])* $key: $key),*
            }
            View { $($key $(: $value)?),* }
        };
        view
    }};
}

/// An object whose keys a table gives, in its order.
#[derive(Clone, Debug)]
pub struct Members<T>(pub Vec<(&'static str, T)>);

/// A value whose kind a table gives.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
pub enum Scalar<'a> {
    /// `true` or `false`.
    Flag(Option<bool>),
    /// A whole number.
    Count(u64),
    /// A number.
    Number(Option<f64>),
    /// A string.
    Text(&'a str),
}

impl<T: Serialize> Serialize for Members<T> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

/// The values of a column of a table.
#[must_use]
pub fn cell_values(cells: &Cells) -> Vec<Scalar<'_>> {
    match cells {
        Cells::Texts(texts) => each(texts, |text| Scalar::Text(text)),
        Cells::Flags(flags) => each(flags, |flag| Scalar::Flag(*flag)),
        Cells::Counts(counts) => each(counts, |count| Scalar::Number(count.map(|n| n as f64))),
        Cells::Numbers(numbers) => each(numbers, |number| Scalar::Number(Some(*number))),
    }
}

/// A list of the views of some items.
pub fn each<T, V>(items: impl IntoIterator<Item = T>, view: impl FnMut(T) -> V) -> Vec<V> {
    items.into_iter().map(view).collect()
}

/// The value as text, indented by two spaces, with a line feed at the end.
#[must_use]
pub fn pretty(value: &impl Serialize) -> String {
    let mut bytes = Vec::new();
    let layout = Layout(PrettyFormatter::new());
    // Neither a vector of bytes nor a value of ours can fail.
    let _ = value.serialize(&mut serde_json::Serializer::with_formatter(&mut bytes, layout));
    bytes.push(b'\n');
    String::from_utf8(bytes).unwrap_or_default()
}

/// One object with the members of several, each as [`pretty`] writes it.
#[must_use]
pub fn joined(objects: &[&str]) -> String {
    let members = objects.iter().filter_map(|text| text.strip_prefix("{\n")?.strip_suffix("\n}\n"));
    format!("{{\n{}\n}}\n", members.collect::<Vec<_>>().join(",\n"))
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
        // Adding 0 takes the sign off a negative zero.
        write!(to, "{:?}", value + 0.0)
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
            let text = pretty(&value);
            let back: f64 = serde_json::from_str(&text).expect(&text);
            assert_eq!(back.to_bits(), value.to_bits(), "{text}");
        }
        assert_eq!(pretty(&f64::NAN), "null\n");
        assert_eq!(pretty(&Some(f64::NEG_INFINITY)), "null\n");
        assert_eq!(pretty(&-0.0), "0.0\n");
    }

    #[test]
    fn any_string_comes_back() {
        let text = "a \"quoted\" \\ name\n\t\u{1}\u{7f} μ </script>";
        let written = pretty(&text);
        assert_eq!(serde_json::from_str::<String>(&written).expect(&written), text);
    }

    #[test]
    fn layout_is_two_spaces_and_keeps_the_order() {
        let value = view! { b: [Some(1.5), None], a: view! {}, c: Members(vec![("d", 1)]) };
        let b = "{\n  \"b\": [\n    1.5,\n    null\n  ],\n";
        let rest = "  \"a\": {},\n  \"c\": {\n    \"d\": 1\n  }\n}\n";
        assert_eq!(pretty(&value), format!("{b}{rest}"));
    }

    #[test]
    fn objects_are_joined_member_by_member() {
        let (one, two) = (view! { a: 1, b: view! { c: 2 } }, view! { d: [3] });
        let [one, two, none] = [pretty(&one), pretty(&two), pretty(&view! {})];
        let joined = joined(&[&one, "", &none, &two]);
        let whole = pretty(&view! { a: 1, b: view! { c: 2 }, d: [3] });
        assert_eq!(joined, whole);
    }
}
