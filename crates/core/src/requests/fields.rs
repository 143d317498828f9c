//! What is asked of an analysis, as texts by the names of fields; every door fills it, and says errors in its
//! own words.

use super::kinds::Kind;
use super::measured;
use crate::assessment::models::ISOLATOR_PERIOD;
use crate::error::{ChoiceError, UnitError, similar};
use crate::input::{Analysis, unit_of_bare};
use crate::motion::intensity::LevelMeasure;
use crate::units::{Dimension, parse_quantity};

/// How often a field is given, and what its text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// One text.
    One,
    /// Any number of texts, together.
    Many,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// `true` or nothing.
    Flag,
}

/// What the numbers in the text of a field measure: a program that gives bare ones gives them in SI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measures {
    /// Nothing: they are complete without a unit, or there are none.
    Nothing,
    /// A dimension.
    Of(Dimension),
    /// What the demand of the request measures.
    Demand,
    /// What the intensity measure of the request measures.
    Intensity,
    /// What the key of the model measures that stands before them.
    Key,
}

/// A field of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name, of which every door makes its own word: see [`FrontEnd::calls`].
    pub name: &'static str,
    /// What it was called, which every door takes still; empty where it has always had its name.
    pub formerly: &'static str,
    /// What stands for its text in a help: `VALUES`.
    pub value: &'static str,
    /// How often it is given.
    pub takes: Takes,
    /// What its numbers measure.
    pub measures: Measures,
    /// Whether two numbers are the ends of a range, `FROM..TO`; else numbers are a list.
    pub is_range: bool,
    /// The text where none is given; empty where nothing stands for it.
    pub default: &'static str,
    /// The key of the model that stands for it; empty where none does.
    pub key: &'static str,
    /// A text to start from in a form, where there is neither default nor key; empty where it may stay so.
    pub sample: &'static str,
    /// What it is, with what follows where it is not given.
    pub about: &'static str,
}

impl Field {
    pub(super) const fn new(name: &'static str, value: &'static str, about: &'static str) -> Self {
        let (takes, measures, is_range) = (Takes::One, Measures::Nothing, false);
        let [formerly, default, key, sample] = [""; 4];
        Self { name, formerly, value, takes, measures, is_range, default, key, sample, about }
    }

    pub(super) const fn formerly(self, formerly: &'static str) -> Self {
        Self { formerly, ..self }
    }

    pub(super) const fn measuring(self, measures: Measures) -> Self {
        Self { measures, ..self }
    }

    pub(super) const fn range_of(self, measures: Measures) -> Self {
        Self { measures, is_range: true, ..self }
    }

    pub(super) const fn many(self) -> Self {
        Self { takes: Takes::Many, ..self }
    }

    pub(super) const fn flag(self) -> Self {
        Self { takes: Takes::Flag, ..self }
    }

    pub(super) const fn or(self, default: &'static str) -> Self {
        Self { default, ..self }
    }

    pub(super) const fn key(self, key: &'static str) -> Self {
        Self { key, ..self }
    }

    pub(super) const fn sample(self, sample: &'static str) -> Self {
        Self { sample, ..self }
    }

    pub(super) const fn of(self, words: &'static [&'static str]) -> Self {
        Self { takes: Takes::Choice(words), ..self }
    }
}

impl Field {
    /// The SI unit of bare numbers in its text; empty where they have none. `key` is the key of the model that stands
    /// before them, `of` the text of another field of the request, its default where none is given.
    #[must_use]
    pub fn unit(&self, key: &str, of: impl Fn(&str) -> String) -> &'static str {
        match self.measures {
            Measures::Nothing => "",
            Measures::Of(dimension) => dimension.si_unit(),
            Measures::Demand => measured(&of("demand")).0.map_or("", Dimension::si_unit),
            Measures::Intensity => {
                LevelMeasure::parse(&of("measure")).map_or("", |measure| measure.unit())
            }
            Measures::Key if key == ISOLATOR_PERIOD => Dimension::Time.si_unit(),
            Measures::Key => unit_of_bare(key),
        }
    }

    /// What a form starts with where it asks of a model.
    #[must_use]
    pub fn start(&self, model: &Analysis) -> &'static str {
        match (self.default, model.value(self.key)) {
            ("", None) => self.sample,
            (default, _) => default,
        }
    }
}

/// Where a request comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrontEnd {
    /// Options of the command.
    Command,
    /// Keywords in Python.
    Python,
    /// The form of the page.
    Page,
}

impl FrontEnd {
    /// What is wrong, in the words of the door: the field, and every other that is named in backticks, as it is
    /// called there.
    #[must_use]
    pub fn says(self, error: &ChoiceError) -> ChoiceError {
        let what = match error.what.split_once(' ') {
            Some((field, rest)) => format!("{} {rest}", self.calls(field)),
            None => self.calls(&error.what),
        };
        let (expected, found) = (self.reads(&error.expected), self.reads(&error.found));
        ChoiceError { what, expected, found, nearest: error.nearest.clone() }
    }

    /// What it calls a field: `--scale-to`, `scale_to`, `Scale to`.
    #[must_use]
    pub fn calls(self, field: &str) -> String {
        match self {
            Self::Command => format!("--{field}"),
            // What the command takes by its place is an argument here.
            Self::Python if field == "SOURCE" => "source".to_owned(),
            Self::Python => field.replace('-', "_"),
            Self::Page => {
                let (first, rest) = field.split_at(field.chars().next().map_or(0, char::len_utf8));
                format!("{}{}", first.to_uppercase(), rest.replace('-', " "))
            }
        }
    }

    fn reads(self, text: &str) -> String {
        let parts = text.split('`').enumerate();
        parts.map(|(i, part)| if i % 2 == 0 { part.to_owned() } else { self.calls(part) }).collect()
    }
}

/// What is asked of an analysis: texts by the names of its fields.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    kind: Kind,
    given: Vec<(&'static Field, String)>,
    /// Whether the runs of a suite are judged.
    pub(super) certifies: bool,
}

impl Request {
    /// Takes what is given, `(name of the field, text)`; an empty text is none.
    ///
    /// # Errors
    /// [`ChoiceError`] for a name that is no field, and for a word that is none of those to choose from.
    pub fn new<'a>(
        kind: Kind,
        given: impl IntoIterator<Item = (&'a str, String)>,
    ) -> Result<Self, ChoiceError> {
        let mut asked = Self { kind, given: Vec::new(), certifies: true };
        for (name, text) in given {
            let Some(field) = kind.field(name) else {
                return Err(ChoiceError {
                    what: kind.name().to_owned(),
                    expected: "one of its fields".to_owned(),
                    found: format!("{name:?}"),
                    nearest: similar(name, kind.fields().iter().map(|field| field.name)),
                });
            };
            let name = field.name;
            let words = match field.takes {
                Takes::Choice(words) => words,
                Takes::Flag => &["true", "false"],
                Takes::One | Takes::Many => &[],
            };
            if text.trim().is_empty() || (field.takes == Takes::Flag && text == "false") {
                continue;
            }
            if !words.is_empty() && !words.contains(&text.as_str()) {
                return Err(ChoiceError {
                    what: name.to_owned(),
                    expected: format!("one of {}", words.join(", ")),
                    found: format!("{text:?}"),
                    nearest: similar(&text, words.iter().copied()),
                });
            }
            if field.takes != Takes::Many && asked.given(name).is_some() {
                return Err(wrong_found(name, "one value", "several"));
            }
            asked.given.push((field, text));
        }
        Ok(asked)
    }

    /// The same without a certificate for the runs of a suite.
    #[must_use]
    pub fn uncertified(self) -> Self {
        Self { certifies: false, ..self }
    }

    /// Which analysis.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Key of the demand that is asked for.
    #[must_use]
    pub fn demand(&self) -> &str {
        self.one("demand")
    }

    /// All texts of a field.
    pub(super) fn all(&self, name: &str) -> impl Iterator<Item = &str> {
        let of = move |(field, _): &&(&Field, String)| field.name == name;
        self.given.iter().filter(of).map(|(_, text)| text.as_str())
    }

    /// All texts of a field, each of which may be several with commas between.
    pub(super) fn listed(&self, name: &str) -> Vec<&str> {
        self.all(name).flat_map(|text| text.split(',')).map(str::trim).collect()
    }

    /// The last text of a field.
    pub(super) fn given(&self, name: &str) -> Option<&str> {
        self.all(name).last()
    }

    /// The text of a field: the one given, or its default.
    pub(super) fn one(&self, name: &str) -> &str {
        self.given(name).or(self.kind.field(name).map(|field| field.default)).unwrap_or_default()
    }

    /// A number that fits, in the text of a field.
    pub(super) fn number(
        &self,
        name: &str,
        expected: &str,
        fits: impl Fn(f64) -> bool,
    ) -> Result<f64, ChoiceError> {
        let text = self.one(name);
        let number = text.trim().parse::<f64>().ok().filter(|n| n.is_finite() && fits(*n));
        number.ok_or_else(|| wrong(name, expected, text))
    }

    /// A share strictly between 0 and 1.
    pub(super) fn share(&self, name: &str) -> Result<f64, ChoiceError> {
        self.number(name, "a share between 0 and 1", |share| share > 0.0 && share < 1.0)
    }

    pub(super) fn count(&self, name: &str, least: u64, most: u64) -> Result<u64, ChoiceError> {
        let text = self.one(name);
        let count = text.trim().parse::<u64>().ok().filter(|n| (least..=most).contains(n));
        count.ok_or_else(|| wrong(name, &format!("a whole number from {least} to {most}"), text))
    }

    pub(super) fn seed(&self) -> Result<u64, ChoiceError> {
        self.count("seed", 0, u64::MAX)
    }

    /// A quantity with its unit, in SI; `None` where none is given.
    pub(super) fn quantity(
        &self,
        name: &str,
        dimension: Dimension,
    ) -> Result<Option<f64>, ChoiceError> {
        self.given(name).map(|text| quantity(name, text, dimension)).transpose()
    }
}

/// A quantity in the text of a field, in SI.
pub(super) fn quantity(name: &str, text: &str, dimension: Dimension) -> Result<f64, ChoiceError> {
    parse_quantity(text, dimension).map_err(|UnitError { expected, found, nearest }| ChoiceError {
        what: name.to_owned(),
        expected,
        found,
        nearest,
    })
}

/// What is found in the place of what a field expects.
fn wrong_found(name: &str, expected: &str, found: &str) -> ChoiceError {
    let [what, expected, found] = [name, expected, found].map(str::to_owned);
    ChoiceError { what, expected, found, nearest: None }
}

/// A text that is not what a field expects.
pub(super) fn wrong(name: &str, expected: &str, found: &str) -> ChoiceError {
    wrong_found(name, expected, &format!("{found:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_given_by_its_old_name_too() {
        for (kind, old, name, text) in [
            (Kind::Sensitivity, "paths", "vary", "slider.radius"),
            (Kind::Design, "bounds", "friction-factors", "0.8,1.3"),
        ] {
            let by = |name| Request::new(kind, [(name, text.to_owned())]).unwrap();
            assert_eq!(by(old), by(name));
            assert_eq!(by(old).one(name), text);
        }
        // A word that others have still is of them alone.
        assert!(Kind::Spectrum.field("bounds").is_some() && Kind::Ida.field("paths").is_none());
    }

    #[test]
    fn what_is_no_field_is_said_with_the_nearest() {
        let error = |kind, name, text: &str| {
            Request::new(kind, [(name, text.to_owned())]).unwrap_err().to_string()
        };
        assert_eq!(
            error(Kind::Ida, "limits", "1 mm"),
            "ida: expected one of its fields, found \"limits\"; nearest is \"limit\""
        );
        assert_eq!(
            error(Kind::Ida, "bounds", "uper"),
            "bounds: expected one of all, lower, nominal, upper, found \"uper\"; nearest is \"upper\""
        );
        let twice = [("limit", "1 mm".to_owned()), ("limit", "2 mm".to_owned())];
        let twice = Request::new(Kind::Ida, twice).unwrap_err().to_string();
        assert_eq!(twice, "limit: expected one value, found several");
        let flag = |text: &str| Request::new(Kind::Run, [("floor-spectrum", text.to_owned())]);
        assert_eq!(flag("false"), flag(""));
        assert!(flag("true").unwrap().given("floor-spectrum").is_some() && flag("yes").is_err());
    }

    #[test]
    fn each_door_says_a_field_in_its_own_words() {
        let error = ChoiceError {
            what: "scale-to slider.gap".to_owned(),
            expected: "`scale-to` or `code-spectrum`".to_owned(),
            found: "both".to_owned(),
            nearest: None,
        };
        let says = |door: FrontEnd| door.says(&error).to_string();
        assert_eq!(
            says(FrontEnd::Command),
            "--scale-to slider.gap: expected --scale-to or --code-spectrum, found both"
        );
        assert_eq!(
            says(FrontEnd::Python),
            "scale_to slider.gap: expected scale_to or code_spectrum, found both"
        );
        assert_eq!(
            says(FrontEnd::Page),
            "Scale to slider.gap: expected Scale to or Code spectrum, found both"
        );
    }
}
