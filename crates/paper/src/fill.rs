//! Texts with placeholders: the chapter, and what is said of its claims.

use crate::PaperError;

/// What stands in the place of a placeholder.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Text(String),
    Number(f64),
    /// Two numbers, written `1 to 2`.
    Range([f64; 2]),
    /// What the placeholders of a passage stand for, each time that it is repeated.
    Each(Vec<Values>),
}

/// Placeholders by name, and what stands in their places.
pub(crate) type Values = Vec<(String, Value)>;

/// The values of a few names.
pub(crate) fn values<const N: usize>(named: [(&str, Value); N]) -> Values {
    named.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Puts values in the places of their placeholders: `{name}`; of numbers also `{name:.2}` and
/// `{name:+.2}`, their decimals without or with a plus sign; `{#name:, }…{/name}` repeats the
/// passage, with `, ` between.
///
/// # Errors
/// [`PaperError::Text`], which names `place`, for a placeholder without a value and a value without a
/// placeholder.
pub(crate) fn fill(
    place: &str,
    text: &str,
    values: &[(String, Value)],
) -> Result<String, PaperError> {
    let unknown = |name: &str| PaperError::text(place, format!("a value for {{{name}}}"), "none");
    let mut used = vec![false; values.len()];
    let mut filled = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        filled.push_str(before);
        let (placeholder, after) = after.split_once('}').ok_or_else(|| unknown(after))?;
        rest = after;
        let (name, format) = placeholder.split_once(':').unwrap_or((placeholder, ""));
        let (repeats, name) = (name.starts_with('#'), name.trim_start_matches('#'));
        let at = values.iter().position(|(known, _)| known == name);
        let at = at.ok_or_else(|| unknown(placeholder))?;
        used[at] = true;
        match &values[at].1 {
            Value::Each(times) if repeats => {
                let (passage, after) = after
                    .split_once(&format!("{{/{name}}}"))
                    .ok_or_else(|| unknown(placeholder))?;
                let times: Result<Vec<String>, PaperError> =
                    times.iter().map(|values| fill(place, passage, values)).collect();
                filled.push_str(&times?.join(format));
                rest = after;
            }
            value => {
                let written = value.written(format).filter(|_| !repeats);
                filled.push_str(&written.ok_or_else(|| unknown(placeholder))?);
            }
        }
    }
    filled.push_str(rest);
    match used.iter().position(|used| !used) {
        Some(at) => {
            Err(PaperError::text(place, format!("a place for {{{}}}", values[at].0), "none"))
        }
        None => Ok(filled),
    }
}

impl Value {
    /// The value in a format, where it has that.
    fn written(&self, format: &str) -> Option<String> {
        match self {
            Self::Text(text) => format.is_empty().then(|| text.clone()),
            Self::Number(value) => number(*value, format),
            Self::Range([low, high]) => {
                Some(format!("{} to {}", number(*low, format)?, number(*high, format)?))
            }
            Self::Each(_) => None,
        }
    }
}

fn number(value: f64, format: &str) -> Option<String> {
    if format.is_empty() {
        return Some(value.to_string());
    }
    let decimals: usize = format.trim_start_matches('+').strip_prefix('.')?.parse().ok()?;
    Some(match format.starts_with('+') {
        true => format!("{value:+.decimals$}"),
        false => format!("{value:.decimals$}"),
    })
}

macro_rules! from {
    ($($type:ty: $value:ident => $made:expr;)*) => {
        $(impl From<$type> for Value {
            fn from($value: $type) -> Self {
                $made
            }
        })*
    };
}

from! {
    &str: text => Self::Text(text.to_owned());
    String: text => Self::Text(text);
    usize: count => Self::Text(count.to_string());
    f64: number => Self::Number(number);
    [f64; 2]: ends => Self::Range(ends);
    Vec<Values>: times => Self::Each(times);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_placeholder_gets_its_value() {
        let steps = [1.0, 2.0].map(|ms| values([("ms", ms.into())])).to_vec();
        let given = values([
            ("name", "A".into()),
            ("mm", (-0.5).into()),
            ("range", [1.0, 2.0].into()),
            ("steps", steps.into()),
            ("none", Vec::new().into()),
        ]);
        let text =
            "{name}: {mm:+.2} and {mm}, {range:.1}, {#steps:, }{ms} ms{/steps}{#none}x{/none}.";
        let expected = "A: -0.50 and -0.5, 1.0 to 2.0, 1 ms, 2 ms.";
        assert_eq!(fill("", text, &given).unwrap(), expected);
    }

    #[test]
    fn unknown_and_unused_placeholders_are_errors() {
        let given = values([("mm", 1.0.into())]);
        for (text, expected) in [
            ("{mm} {cm}", "here: expected a value for {cm}, found none"),
            ("{mm} {mm:2}", "here: expected a value for {mm:2}, found none"),
            ("{#mm}{/mm}", "here: expected a value for {#mm}, found none"),
            ("1 mm", "here: expected a place for {mm}, found none"),
        ] {
            assert_eq!(fill("here", text, &given).unwrap_err().to_string(), expected);
        }
    }
}
