//! The files of codes: edition, what they ask for besides the model, values and requirements, each with its clause and
//! its formulas. A new edition is a new file.

use toml::de::{DeTable, DeValue};

use super::formula::Formula;
use super::quantities::{FUNCTIONS, OFFERED};
use crate::error::{ChoiceError, similar};
use crate::units::{Dimension, parse_quantity};

/// The codes by their names, with their files.
const FILES: [(&str, &str); 3] = [
    ("asce7-22", include_str!("asce7-22.toml")),
    ("en1998-1", include_str!("en1998-1.toml")),
    ("aashto", include_str!("aashto.toml")),
];

/// The names of the codes.
pub const CODES: &[&str] = &[FILES[0].0, FILES[1].0, FILES[2].0];

/// A code: what it asks for, what it makes of the model, and what it requires.
#[derive(Clone, Debug, PartialEq)]
pub struct Code {
    /// Its name among [`CODES`].
    pub name: &'static str,
    /// Its title.
    pub title: String,
    /// Edition and chapter.
    pub edition: String,
    /// What a reader must know of how the rules were written down.
    pub note: String,
    /// What its displacement, force and damping are for, in a few words.
    pub lateral: String,
    /// The intensities by whose names its rules ask; a suite without a name is of all.
    pub hazards: Vec<String>,
    /// The range of periods over which pairs are compared with the spectrum, as parts of the shortest and the longest
    /// effective period.
    pub periods: [f64; 2],
    /// What the products of property factors are taken to at least unless tests say otherwise.
    pub limits: Option<[f64; 2]>,
    /// Why no rule is judged of a model with a structure on its block; none where rules are for structures too.
    pub(super) rigid: Option<String>,
    /// The factor by which an effective damping `beta` divides the spectrum.
    pub(super) damping: Formula,
    pub(super) inputs: Vec<CodeInput>,
    pub(super) values: Vec<CodeValue>,
    pub(super) distributions: Vec<Distribution>,
    pub(super) rules: Vec<Rule>,
    /// What is given of its inputs, in SI.
    pub(super) given: Vec<(String, f64)>,
}

/// What a code asks for and no model says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CodeInput {
    pub name: String,
    pub words: String,
    pub unit: CodeUnit,
    /// What stands for it where it is not given.
    pub or: Option<Formula>,
}

/// A quantity that a code makes of others.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CodeValue {
    pub name: String,
    pub words: String,
    pub clause: String,
    pub unit: CodeUnit,
    pub written: String,
    pub formula: Formula,
}

/// Forces over the height.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Distribution {
    pub words: String,
    pub clause: String,
    pub written: [String; 2],
    /// At the base level and at a level above it.
    pub formulas: [Formula; 2],
}

/// A requirement.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rule {
    pub requirement: String,
    pub clause: String,
    /// The hazards that it asks at; none for all.
    pub at: Vec<String>,
    /// What may be used where it holds; none where the design must hold it.
    pub condition: Option<String>,
    /// Whether it is of the analysis, not of the structure: then it governs nothing.
    pub formal: bool,
    pub unit: CodeUnit,
    pub asked: Asked,
}

/// What a requirement compares.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Asked {
    /// Nothing: why it cannot be judged here.
    Unjudged(String),
    /// A demand that must not exceed a capacity.
    Compared {
        written: [String; 2],
        formulas: Box<[Formula; 2]>,
        /// Whether each is taken at its largest over all bounds and directions by itself.
        envelope: bool,
    },
}

/// How a quantity is shown: of a dimension, in percent, or a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeUnit {
    /// In a unit of its dimension.
    Of(Dimension),
    /// A ratio in percent.
    Percent,
    /// A ratio or a count.
    Number,
}

impl CodeUnit {
    /// The unit in which the library keeps it; empty of a ratio.
    #[must_use]
    pub fn si_unit(self) -> &'static str {
        match self {
            Self::Of(dimension) => dimension.si_unit(),
            Self::Percent | Self::Number => "",
        }
    }

    fn parse(text: &str) -> Option<Self> {
        let of = || Dimension::ALL.into_iter().find(|dimension| dimension.si_unit() == text);
        match text {
            "" => Some(Self::Number),
            "%" => Some(Self::Percent),
            _ => of().map(Self::Of),
        }
    }
}

impl Code {
    /// The code of a name.
    ///
    /// # Errors
    /// [`ChoiceError`] for `code` where no code has that name.
    pub fn named(name: &str) -> Result<Self, ChoiceError> {
        let Some((name, text)) = FILES.into_iter().find(|(known, _)| *known == name) else {
            return Err(ChoiceError {
                what: "code".to_owned(),
                expected: format!("one of {}", CODES.join(", ")),
                found: format!("{name:?}"),
                nearest: similar(name, CODES.iter().copied()),
            });
        };
        Self::parse(name, text).map_err(|found| ChoiceError {
            what: "code".to_owned(),
            expected: format!("rules in the file of {name}"),
            found,
            nearest: None,
        })
    }

    /// That of ASCE/SEI 7, by which the hand calculation is made where no code is named.
    ///
    /// # Errors
    /// As [`Code::named`].
    pub(crate) fn assumed() -> Result<Self, ChoiceError> {
        Self::named(FILES[0].0)
    }

    /// Whether its hand calculation is that of ASCE/SEI 7.
    pub(crate) fn is_asce(&self) -> bool {
        self.name == FILES[0].0
    }

    fn parse(name: &'static str, text: &str) -> Result<Self, String> {
        let document = DeTable::parse(text).map_err(|error| error.to_string())?;
        let document = Reader { table: document.get_ref(), place: "the file".to_owned() };
        let each = |key: &str| document.tables(key);
        let inputs = each("input").iter().map(Reader::input).collect::<Result<Vec<_>, _>>()?;
        let values = each("value").iter().map(Reader::value).collect::<Result<Vec<_>, _>>()?;
        let distributions =
            each("distribution").iter().map(Reader::distribution).collect::<Result<Vec<_>, _>>()?;
        let code = Self {
            name,
            title: document.text("title")?,
            edition: document.text("edition")?,
            note: document.text("note")?,
            lateral: document.text("lateral")?,
            hazards: document.texts("hazards"),
            periods: document.pair("periods").ok_or("periods: expected two numbers")?,
            limits: document.pair("limits"),
            rigid: document.text("rigid").ok(),
            damping: document.formula("damping")?.1,
            inputs,
            values,
            distributions,
            rules: each("rule").iter().map(Reader::rule).collect::<Result<Vec<_>, _>>()?,
            given: Vec::new(),
        };
        code.check()?;
        Ok(code)
    }

    /// That every formula is made of what is offered, asked for, or made before it.
    fn check(&self) -> Result<(), String> {
        let mut known: Vec<&str> = OFFERED.iter().map(|(name, _)| *name).collect();
        known.extend(self.inputs.iter().map(|input| &input.name[..]));
        let fits = |formula: &Formula, known: &[&str], of: &str| {
            if let Some(name) = formula.names().into_iter().find(|name| !known.contains(name)) {
                return Err(format!("{of}: expected a known quantity, found {name:?}"));
            }
            let unknown = |(name, count): &(&str, usize)| {
                let takes = FUNCTIONS.iter().find(|(known, _)| known == name);
                takes.is_none_or(|(_, least)| count < least)
            };
            match formula.calls().into_iter().find(unknown) {
                Some((name, count)) => Err(format!("{of}: no function {name} of {count}")),
                None => Ok(()),
            }
        };
        fits(&self.damping, &["beta"], "damping")?;
        for input in &self.inputs {
            input.or.iter().try_for_each(|or| fits(or, &known, &input.name))?;
        }
        for value in &self.values {
            fits(&value.formula, &known, &value.name)?;
            known.push(&value.name);
        }
        for of in &self.distributions {
            of.formulas.iter().try_for_each(|formula| fits(formula, &known, &of.words))?;
        }
        for rule in &self.rules {
            if let Asked::Compared { formulas, .. } = &rule.asked {
                formulas.iter().try_for_each(|one| fits(one, &known, &rule.requirement))?;
            }
        }
        Ok(())
    }

    /// Whether a value that it asks for is given and is not 0.
    #[must_use]
    pub fn is_given(&self, name: &str) -> bool {
        self.given.iter().any(|(given, value)| given == name && *value > 0.0)
    }

    /// The code with what is given of what it asks for, `R = 4, V_wind = 400 kN`.
    ///
    /// # Errors
    /// [`ChoiceError`] for `code-values` where a name is none of those that the code asks for, or a value does not fit.
    pub fn with_values(self, texts: &[&str]) -> Result<Self, ChoiceError> {
        let mut given: Vec<(String, f64)> = Vec::new();
        let refused = |expected: String, found: &str, nearest| ChoiceError {
            what: "code-values".to_owned(),
            expected,
            found: format!("{found:?}"),
            nearest,
        };
        for part in texts.iter().flat_map(|text| text.split(',')) {
            let names = || self.inputs.iter().map(|input| &input.name[..]);
            let list = || names().collect::<Vec<_>>().join(", ");
            let Some((name, text)) = part.split_once('=') else {
                let expected = format!("values by their names, of {}: {}", self.title, list());
                return Err(refused(expected, part.trim(), None));
            };
            let (name, text) = (name.trim(), text.trim());
            let Some(input) = self.inputs.iter().find(|input| input.name == name) else {
                let expected =
                    format!("one of the values that {} asks for: {}", self.title, list());
                return Err(refused(expected, name, similar(name, names())));
            };
            if given.iter().any(|(known, _)| known == name) {
                return Err(refused(format!("one value of {name}"), text, None));
            }
            let value = match input.unit {
                CodeUnit::Of(dimension) => parse_quantity(text, dimension).ok(),
                CodeUnit::Percent | CodeUnit::Number => match text {
                    "yes" => Some(1.0),
                    "no" => Some(0.0),
                    _ => text.parse().ok(),
                },
            };
            let Some(value) = value.filter(|value| value.is_finite() && *value >= 0.0) else {
                let example = match input.unit {
                    CodeUnit::Of(dimension) => format!(" with a unit, {}", dimension.example()),
                    CodeUnit::Percent | CodeUnit::Number => String::new(),
                };
                let expected = format!("{name}: {} of at least 0{example}", input.words);
                return Err(refused(expected, text, None));
            };
            given.push((name.to_owned(), value));
        }
        Ok(Self { given, ..self })
    }
}

/// A table of a file, with what messages call it.
struct Reader<'a> {
    table: &'a DeTable<'a>,
    place: String,
}

impl Reader<'_> {
    fn get(&self, key: &str) -> Option<&DeValue<'_>> {
        let found = self.table.iter().find(|(name, _)| name.get_ref().as_ref() == key);
        found.map(|(_, value)| value.get_ref())
    }

    fn text(&self, key: &str) -> Result<String, String> {
        match self.get(key) {
            Some(DeValue::String(text)) => Ok(text.clone().into_owned()),
            _ => Err(format!("{}: expected a text {key:?}", self.place)),
        }
    }

    fn texts(&self, key: &str) -> Vec<String> {
        let Some(DeValue::Array(list)) = self.get(key) else { return Vec::new() };
        let text = |value: &DeValue<'_>| match value {
            DeValue::String(text) => Some(text.clone().into_owned()),
            _ => None,
        };
        list.iter().filter_map(|value| text(value.get_ref())).collect()
    }

    fn pair(&self, key: &str) -> Option<[f64; 2]> {
        let Some(DeValue::Array(list)) = self.get(key) else { return None };
        let number = |value: &DeValue<'_>| match value {
            DeValue::Float(float) => float.to_string().parse().ok(),
            DeValue::Integer(integer) => integer.to_string().parse().ok(),
            _ => None,
        };
        let numbers: Option<Vec<f64>> = list.iter().map(|value| number(value.get_ref())).collect();
        numbers?.try_into().ok()
    }

    fn formula(&self, key: &str) -> Result<(String, Formula), String> {
        let written = self.text(key)?;
        let formula = Formula::parse(&written);
        let formula = formula.map_err(|error| format!("{}, {key}: {error}", self.place))?;
        Ok((written, formula))
    }

    fn is_set(&self, key: &str) -> bool {
        matches!(self.get(key), Some(DeValue::Boolean(true)))
    }

    fn unit(&self) -> Result<CodeUnit, String> {
        let text = self.text("unit").unwrap_or_default();
        CodeUnit::parse(&text).ok_or_else(|| format!("{}: no unit {text:?}", self.place))
    }

    fn tables(&self, key: &str) -> Vec<Reader<'_>> {
        let Some(DeValue::Array(list)) = self.get(key) else { return Vec::new() };
        let tables = list.iter().enumerate().filter_map(|(i, value)| match value.get_ref() {
            DeValue::Table(table) => Some(Reader { table, place: format!("{key} {}", i + 1) }),
            _ => None,
        });
        tables.collect()
    }

    fn input(&self) -> Result<CodeInput, String> {
        let or = if self.get("or").is_some() { Some(self.formula("or")?.1) } else { None };
        let (name, words) = (self.text("name")?, self.text("words")?);
        Ok(CodeInput { name, words, unit: self.unit()?, or })
    }

    fn value(&self) -> Result<CodeValue, String> {
        let (written, formula) = self.formula("formula")?;
        let [name, words, clause] = [self.text("name")?, self.text("words")?, self.text("clause")?];
        Ok(CodeValue { name, words, clause, unit: self.unit()?, written, formula })
    }

    fn distribution(&self) -> Result<Distribution, String> {
        let ((base, at_base), (level, at_level)) = (self.formula("base")?, self.formula("level")?);
        let (words, clause) = (self.text("words")?, self.text("clause")?);
        let (written, formulas) = ([base, level], [at_base, at_level]);
        Ok(Distribution { words, clause, written, formulas })
    }

    fn rule(&self) -> Result<Rule, String> {
        let asked = match self.text("unjudged") {
            Ok(why) => Asked::Unjudged(why),
            Err(_) => {
                let ((demand, of_demand), (capacity, of_capacity)) =
                    (self.formula("demand")?, self.formula("capacity")?);
                Asked::Compared {
                    written: [demand, capacity],
                    formulas: Box::new([of_demand, of_capacity]),
                    envelope: self.is_set("envelope"),
                }
            }
        };
        Ok(Rule {
            requirement: self.text("requirement")?,
            clause: self.text("clause")?,
            at: self.texts("at"),
            condition: self.text("condition").ok(),
            formal: self.is_set("formal"),
            unit: self.unit()?,
            asked,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_is_read_and_says_what_it_asks_for() {
        for name in CODES {
            let code = Code::named(name).unwrap();
            assert!(code.rules.len() > 8 && !code.values.is_empty(), "{name}");
            assert!(code.rules.iter().all(|rule| !rule.clause.is_empty()));
            let known = |at: &String| code.hazards.contains(at);
            assert!(code.rules.iter().flat_map(|rule| &rule.at).all(known), "{name}");
        }
        let error = Code::named("asce7-16").unwrap_err().to_string();
        assert_eq!(
            error,
            "code: expected one of asce7-22, en1998-1, aashto, found \"asce7-16\"; nearest is \"asce7-22\""
        );
    }

    #[test]
    fn a_value_that_no_code_asks_for_is_refused_by_name() {
        let code = Code::named("asce7-22").unwrap();
        assert_eq!(
            code.clone().with_values(&["R_I = 2, V_wind = 400 kN"]).unwrap().given,
            [("R_I".to_owned(), 2.0), ("V_wind".to_owned(), 400e3)]
        );
        let error = |text: &str| code.clone().with_values(&[text]).unwrap_err().to_string();
        assert!(error("Vwind = 2 kN").contains("nearest is \"V_wind\""));
        assert!(error("V_wind = 400").contains("with a unit, 12 kN"), "{}", error("V_wind = 400"));
        assert!(error("R").starts_with("code-values: expected values by their names"));
        assert!(error("R = 1, R = 2").contains("one value of R"));
    }

    #[test]
    fn a_file_with_an_unknown_quantity_is_refused() {
        let text = FILES[0].1.replace("k * D_M", "k * D_N");
        assert_ne!(text, FILES[0].1);
        let error = Code::parse("asce7-22", &text).unwrap_err();
        assert!(error.contains("expected a known quantity, found \"D_N\""), "{error}");
    }
}
