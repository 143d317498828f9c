//! How a text's keys are described: one static table says what may be written.
//!
//! Known keys, types, ranges, excluding keys, the paths that `--set` takes and the JSON schema all
//! come from the same [`Section`]s, so none can disagree with another.

use crate::units::{self, Dimension};

/// A table of keys.
#[derive(Debug)]
pub struct Section {
    /// The keys, in the order in which a person would write them.
    pub keys: &'static [Key],
    /// Keys that exclude each other.
    pub choices: &'static [Exclusive],
}

/// Keys of a section of which at most one is written. `key.*` stands for a key given as a table.
#[derive(Debug)]
pub struct Exclusive {
    /// The keys' names.
    pub names: &'static [&'static str],
    /// Whether one must be there.
    pub required: bool,
}

/// A key, what it takes and what it means.
#[derive(Debug)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// What it takes.
    pub kind: Kind,
    /// Whether its section must have it.
    pub required: bool,
    /// The key without which it means nothing.
    pub beside: Option<&'static str>,
    /// Whether it, or what stands in it, says how the thing is built that moves: of such keys a sensitivity is
    /// where none is named.
    pub built: bool,
    /// What it means, in a sentence.
    pub doc: &'static str,
}

/// What a key takes.
#[derive(Debug)]
pub enum Kind {
    /// Any text; here an example.
    Text(&'static str),
    /// One of these words.
    Word(&'static [&'static str]),
    /// The name of a unit.
    UnitOf(Dimension),
    /// A name, or a number from 1.
    NameOrIndex,
    /// A dimensionless number.
    Number(Range),
    /// A dimensionless number for both directions of sliding, or a section with one for each.
    NumberOr(Range, &'static Section),
    /// A number with its unit.
    Quantity(Dimension, Range),
    /// A number with its unit for both directions of sliding, or a section with one for each or
    /// for one of them.
    QuantityOr(Dimension, Range, &'static Section),
    /// A number with its unit, or a bare number where only ratios count.
    QuantityOrRatio(Dimension, Range),
    /// A list of numbers with their units, and how many at most.
    Quantities(Dimension, Range, usize),
    /// A number with its unit, or a list of two, along x and along y.
    Vector(Dimension, Range),
    /// A list of such, one a storey, and how many at most.
    Vectors(Dimension, Range, usize),
    /// A section of its own.
    Section(&'static Section),
    /// Sections of the same form, and how many at most.
    Sections(&'static Section, usize),
    /// A text or a list of texts; here an example.
    Texts(&'static str),
    /// A list of dimensionless numbers, and how many at most.
    Numbers(Range, usize),
    /// A whole number from the first to the second.
    Whole(u64, u64),
    /// What only its own reader can judge.
    Special(Special),
}

/// Values whose form depends on other keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Special {
    /// Distributions by the paths of the model that they vary.
    Vary,
    /// Levels of an intensity measure, in its unit.
    Levels,
    /// Pairs of paths, each with their correlation.
    Correlation,
    /// That many values of the path that is varied; any number where it is 0.
    Values(usize),
}

/// The largest whole number that every program keeps when it reads it as a double.
pub const MAX_WHOLE: u64 = 1 << 53;

/// The numbers that a key takes; always at most [`units::LARGEST`] in size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// All.
    Any,
    /// > 0.
    Positive,
    /// ≥ 0.
    NotNegative,
    /// Between −1 and 1, without the ends.
    Fraction,
    /// An angle between −π/2 and π/2, without the ends.
    Tilt,
}

impl Section {
    /// The key of that name.
    #[must_use]
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The keys that a path goes through, the outermost first.
    pub fn along(&'static self, path: &str) -> impl Iterator<Item = &'static Key> {
        let mut section = Some(self);
        let names = path.split('.').filter(|name| name.parse::<usize>().is_err());
        names.map_while(move |name| {
            let key = section?.key(name)?;
            section = key.kind.section();
            Some(key)
        })
    }

    /// The names of its keys.
    #[must_use]
    pub fn names(&self) -> Vec<&'static str> {
        self.keys.iter().map(|key| key.name).collect()
    }
}

impl Exclusive {
    pub(super) const fn at_most(names: &'static [&'static str]) -> Self {
        Self { names, required: false }
    }

    pub(super) const fn one_of(names: &'static [&'static str]) -> Self {
        Self { names, required: true }
    }
}

impl Key {
    pub(super) const fn required(name: &'static str, kind: Kind, doc: &'static str) -> Self {
        Self { name, kind, required: true, beside: None, built: true, doc }
    }

    pub(super) const fn optional(name: &'static str, kind: Kind, doc: &'static str) -> Self {
        Self { name, kind, required: false, beside: None, built: true, doc }
    }

    pub(super) const fn beside(self, other: &'static str) -> Self {
        Self { beside: Some(other), ..self }
    }

    pub(super) const fn not_built(self) -> Self {
        Self { built: false, ..self }
    }
}

impl Kind {
    /// The section that a table of this kind has.
    #[must_use]
    pub fn section(&self) -> Option<&'static Section> {
        match self {
            Self::NumberOr(_, section)
            | Self::QuantityOr(_, _, section)
            | Self::Section(section)
            | Self::Sections(section, _) => Some(section),
            _ => None,
        }
    }

    /// Whether it is a list, whose items a path counts from 1.
    #[must_use]
    pub fn is_list(&self) -> bool {
        matches!(
            self,
            Self::Sections(..)
                | Self::Quantities(..)
                | Self::Numbers(..)
                | Self::Vector(..)
                | Self::Vectors(..)
        )
    }

    /// What to write, in words.
    #[must_use]
    pub fn expected(&self) -> String {
        let with_unit = |dimension: &Dimension| {
            let (what, example) = (dimension.with_article(), dimension.example());
            format!("{what} with its unit, such as \"{example}\"")
        };
        match self {
            Self::Text(example) => format!("text in quotes, such as \"{example}\""),
            Self::Word(words) => one_of(words),
            Self::UnitOf(dimension) => {
                let names: Vec<_> =
                    dimension.units().iter().map(crate::units::Unit::name).collect();
                format!("a unit of {} ({})", dimension.name(), names.join(", "))
            }
            Self::NameOrIndex => "a name in quotes or a number from 1".to_owned(),
            Self::Number(range) => range.expected("number"),
            // Surfaces in series take no table; one is read for its reason to be refused.
            Self::NumberOr(Range::Positive, _) => Range::Positive.expected("number"),
            Self::NumberOr(range, section) => {
                let between = if section.choices.is_empty() { " and " } else { ", " };
                let names = section.names().join(between);
                format!("{} or a table of {names}", range.expected("number"))
            }
            Self::Quantity(dimension, _) => with_unit(dimension),
            Self::QuantityOr(dimension, _, section) => {
                let names = section.names().join(" and ");
                format!(
                    "{} or a table of {names}, of which one may be missing",
                    with_unit(dimension)
                )
            }
            Self::QuantityOrRatio(dimension, _) => {
                format!("{} (or a ratio, where a period is given)", with_unit(dimension))
            }
            Self::Quantities(dimension, ..) => {
                let (what, example) = (dimension.with_article(), dimension.example());
                format!("a list, each {what} with its unit, such as [\"{example}\"]")
            }
            Self::Vector(dimension, _) => {
                format!("{} (or a list of two, along x and along y)", with_unit(dimension))
            }
            Self::Vectors(dimension, ..) => {
                let (what, example) = (dimension.with_article(), dimension.example());
                format!("a list with {what} for each storey, such as [\"{example}\"]")
            }
            Self::Section(_) => "a table of keys".to_owned(),
            Self::Sections(..) => "a list of tables".to_owned(),
            Self::Texts(example) => {
                format!("text in quotes or a list of such, such as [\"{example}\"]")
            }
            Self::Numbers(range, _) => {
                format!("a list of numbers, each {}", range.expected("number"))
            }
            Self::Whole(least, most) if *most == MAX_WHOLE => {
                format!("a whole number from {least}")
            }
            Self::Whole(least, most) => format!("a whole number from {least} to {most}"),
            Self::Special(special) => special.expected().to_owned(),
        }
    }
}

impl Special {
    /// What to write, in words.
    #[must_use]
    pub fn expected(self) -> &'static str {
        match self {
            Self::Vary => {
                "a table of paths of the model, each with a table such as { values = [1, 2] }"
            }
            Self::Levels => "a list of levels of the measure with their unit, such as [\"0.2 g\"]",
            Self::Correlation => "a list of [\"PATH\", \"PATH\", NUMBER]",
            Self::Values(2) => "a list of two values",
            Self::Values(3) => "a list of two values and how many there are from one to the other",
            Self::Values(_) => "a list of values",
        }
    }
}

impl Range {
    /// Whether a number is finite and in the range.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        value.abs() <= units::LARGEST
            && match self {
                Self::Any => true,
                Self::Positive => value >= units::SMALLEST,
                Self::NotNegative => value >= 0.0,
                Self::Fraction => value.abs() < 1.0,
                Self::Tilt => value.abs() < core::f64::consts::FRAC_PI_2,
            }
    }

    /// What to write, in words, instead of a number of that name that is not in the range.
    #[must_use]
    pub fn refusal(self, name: &str, value: f64) -> String {
        let (least, most) = (units::SMALLEST, units::LARGEST);
        let a = if name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        let too_large = value.is_finite() && value.abs() > most;
        match self {
            Self::Positive if too_large || (value > 0.0 && value < least) => {
                format!("{a} {name} from {least:e} to {most:e} in SI")
            }
            Self::Any | Self::NotNegative if too_large => {
                format!("{a} {name} of at most {most:e} in SI")
            }
            _ => self.expected(name),
        }
    }

    /// The range in words, for a number of that name.
    #[must_use]
    pub fn expected(self, name: &str) -> String {
        match self {
            Self::Any => format!("a finite {name}"),
            Self::Positive => format!("a finite {name} > 0"),
            Self::NotNegative => format!("a finite {name} ≥ 0"),
            Self::Fraction => format!("a {name} between -1 and 1"),
            Self::Tilt => format!("an {name} between -90 deg and 90 deg"),
        }
    }
}

/// `one of "a", "b"`.
pub(super) fn one_of(words: &[&str]) -> String {
    let words: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
    format!("one of {}", words.join(", "))
}
