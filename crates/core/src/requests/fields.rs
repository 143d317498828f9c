//! What may be asked: a table from which every door makes its options, keywords or form.

use crate::error::{ChoiceError, similar};

/// How often a field is given, and what its text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// One text.
    One,
    /// Any number of texts, together.
    Many,
    /// One of some words.
    Choice(&'static [&'static str]),
}

/// A field of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name: with `--` before it an option, with `_` for `-` a keyword.
    pub name: &'static str,
    /// What stands for its text in a help: `VALUES`.
    pub value: &'static str,
    /// How often it is given.
    pub takes: Takes,
    /// The text where none is given; empty where nothing stands for it.
    pub default: &'static str,
    /// What it is, with what follows where it is not given.
    pub about: &'static str,
}

impl Field {
    const fn new(name: &'static str, value: &'static str, about: &'static str) -> Self {
        Self { name, value, takes: Takes::One, default: "", about }
    }

    const fn many(self) -> Self {
        Self { takes: Takes::Many, ..self }
    }

    const fn or(self, default: &'static str) -> Self {
        Self { default, ..self }
    }

    const fn of(self, words: &'static [&'static str]) -> Self {
        Self { takes: Takes::Choice(words), ..self }
    }
}

const PATH_VALUES: &str = "PATH=VALUES";

const MEASURE: Field = Field::new(
    "measure",
    "NAME",
    "Intensity measure: PGA, PGV, Sa(1.2 s), Sa(1.2 s, 2 %), Sa_avg(0.5 s, 3 s), …",
)
.or("PGA");
const SCALE_TO: Field = Field::new(
    "scale-to",
    "LEVEL",
    "Scale every record to this value of the measure: \"0.4 g\"; as recorded if left out",
);
const SCALE: Field = Field::new("scale", "FACTOR", "Scale every record by this factor").or("1");
const VARY: Field = Field::new(
    "vary",
    PATH_VALUES,
    "Parameter to vary: slider.radius=\"1, 2, 3 m\" or slider.radius=1..5m:200; may be repeated",
)
.many();
const FRICTION: Field = Field::new(
    "friction",
    "VALUES",
    "Kinetic friction to vary, the model's ratio of static to kinetic kept: 0.02,0.05,0.10",
);
const BOUNDS: Field = Field::new(
    "bounds",
    "BOUNDS",
    "Which of the model's slider.bounds are run, each with curves of its own",
)
.of(&["all", "lower", "nominal", "upper"])
.or("all");
const DEMAND: Field =
    Field::new("demand", "KEY", "Key of the demand").or("peak_sliding_displacement_m");
const KEEP: Field = Field::new(
    "where",
    "PATH=VALUE|FROM..TO",
    "Only designs with this value or within this range: slider.radius=\"1..2 m\", friction=upper; \
     may be repeated",
)
.many();
const BY: Field = Field::new(
    "by",
    "PATH",
    "Curves of their own for each value of this path, else averaged over: slider.radius, friction",
);
const CONFIDENCE: Field =
    Field::new("confidence", "SHARE", "Confidence of intervals and band").or("0.9");

/// Fields of a sliding spectrum.
const SPECTRUM: &[Field] = &[
    Field::new(
        "over",
        PATH_VALUES,
        "Parameter along the axis: storey.1.period=0.1..3s:30, isolator.period=1..5s:40, …",
    )
    .or("isolator.period=1..5s:40"),
    FRICTION,
    VARY,
    MEASURE,
    SCALE_TO,
    SCALE,
    Field::new(
        "demand",
        "KEY",
        "Further demands, besides displacement, residual, path and roof acceleration; may be repeated",
    )
    .many(),
    BOUNDS,
];

/// Fields of an incremental dynamic analysis.
const IDA: &[Field] = &[
    MEASURE,
    Field::new(
        "scale-to",
        "LEVELS",
        "Levels for all records: \"0.1, 0.2, 0.4 g\" or \"0.1..1.5 g:15\"; hunted, record by record, if \
         left out",
    ),
    Field::new(
        "between",
        "FROM..TO",
        "First and highest level of the hunt: \"0.05..10 g\"; a twentieth and twenty times the records' \
         median if left out",
    ),
    DEMAND,
    Field::new(
        "limit",
        "LIMIT",
        "Limit on the demand: \"150 mm\"; of sliding, slider.gap of the model if left out",
    ),
    FRICTION,
    VARY,
    KEEP,
    BY,
    BOUNDS,
];

/// Fields of a fragility.
const FRAGILITY: &[Field] = &[
    DEMAND,
    Field::new(
        "limit",
        "LIMIT",
        "Limit on the demand: \"150 mm\"; that of the analysis if left out, and of none where the table has \
         counts or capacities",
    ),
    Field::new(
        "measure",
        "NAME",
        "Intensity measure, where it is not that of the levels: PGV, Sa(1.2 s), or a column's name",
    ),
    Field::new(
        "units",
        "UNIT",
        "Unit of the intensities, where the table does not state it: g, m/s2, cm/s, …",
    ),
    Field::new("fit-to", "DATA", "What the curve is fitted to; by the kind of data if left out")
        .of(&["counts", "capacities", "cloud"]),
    Field::new(
        "where",
        "PATH=VALUE|FROM..TO",
        "Only rows with this value or within this range: slider.radius=\"1..2 m\", record=taft-111; may be \
         repeated",
    )
    .many(),
    Field::new("by", "PATH", "One curve for each value of this column: slider.radius"),
    Field::new(
        "bootstrap",
        "DRAWS",
        "Intervals from this many draws of the records (50 to 100000) instead of the sandwich",
    ),
    Field::new("seed", "SEED", "Seed of these draws").or("1"),
    Field::new(
        "floor",
        "LIMIT",
        "Demands below this count as below it only, in a cloud: \"1 mm\"",
    ),
    Field::new("cap", "LIMIT", "Demands above this count as above it only, in a cloud"),
    CONFIDENCE,
];

/// Fields of a design.
const DESIGN: &[Field] = &[
    FRICTION,
    VARY,
    MEASURE,
    SCALE_TO,
    SCALE,
    Field::new(
        "gap",
        "LENGTH",
        "Sliding displacement not to be exceeded; slider.gap of the model if left out",
    ),
    Field::new("probability", "SHARE", "Share of the records that must stay within the gap")
        .or("0.9"),
    Field::new(
        "demand",
        "KEY",
        "Key of the acceleration to minimise; the roof's, or the block's, if left out",
    ),
    Field::new("share", "SHARE", "Share of the records that must not exceed that acceleration")
        .or("0.5"),
    Field::new(
        "bounds",
        "LOWER,UPPER",
        "Factors on friction for the robustness check: 0.8,1.3; slider.bounds of the model if left out",
    ),
    Field::new("sensitivity", "N", "Sample points of the sensitivity (Sobol' indices); 0 for none")
        .or("256"),
    Field::new("seed", "SEED", "Seed of those points").or("1"),
    CONFIDENCE,
];

/// An analysis that is asked for by fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A sliding spectrum, or response over excitation frequency.
    Spectrum,
    /// An incremental dynamic analysis.
    Ida,
    /// A lognormal fragility of a table of runs.
    Fragility,
    /// The friction and stiffness that keep a gap.
    Design,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Spectrum, Self::Ida, Self::Fragility, Self::Design];

    /// Its name, which is that of the command.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Spectrum => "spectrum",
            Self::Ida => "ida",
            Self::Fragility => "fragility",
            Self::Design => "design",
        }
    }

    /// Its fields, in the order of a help.
    #[must_use]
    pub fn fields(self) -> &'static [Field] {
        match self {
            Self::Spectrum => SPECTRUM,
            Self::Ida => IDA,
            Self::Fragility => FRAGILITY,
            Self::Design => DESIGN,
        }
    }
}

/// All fields of all analyses as text, a line each: name, what it takes, its default, what it is.
#[must_use]
pub fn table() -> String {
    let mut text = String::new();
    for kind in Kind::ALL {
        let rule = if text.is_empty() { "" } else { "\n" };
        text.push_str(&format!("{rule}{}\n", kind.name()));
        for Field { name, value, takes, default, about } in kind.fields() {
            let value = match takes {
                Takes::Choice(words) => words.join("|"),
                Takes::One | Takes::Many => (*value).to_owned(),
            };
            let default =
                if default.is_empty() { String::new() } else { format!(" [default: {default}]") };
            text.push_str(&format!("  {name:<12}{value:<21} {about}{default}\n"));
        }
    }
    text
}

/// What is asked of an analysis: texts by the names of its fields.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    kind: Kind,
    given: Vec<(&'static Field, String)>,
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
        let mut asked = Self { kind, given: Vec::new() };
        for (name, text) in given {
            let Some(field) = kind.fields().iter().find(|field| field.name == name) else {
                return Err(ChoiceError {
                    what: kind.name().to_owned(),
                    expected: "one of its fields".to_owned(),
                    found: format!("{name:?}"),
                    nearest: similar(name, kind.fields().iter().map(|field| field.name)),
                });
            };
            if let Takes::Choice(words) = field.takes
                && !words.contains(&text.as_str())
                && !text.is_empty()
            {
                return Err(ChoiceError {
                    what: name.to_owned(),
                    expected: format!("one of {}", words.join(", ")),
                    found: format!("{text:?}"),
                    nearest: similar(&text, words.iter().copied()),
                });
            }
            if !text.trim().is_empty() {
                asked.given.push((field, text));
            }
        }
        Ok(asked)
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

    /// The last text of a field.
    pub(super) fn given(&self, name: &str) -> Option<&str> {
        self.all(name).last()
    }

    /// The text of a field: the one given, or its default.
    pub(super) fn one(&self, name: &str) -> &str {
        let field = self.kind.fields().iter().find(|field| field.name == name);
        self.given(name).or(field.map(|field| field.default)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_fields_have_one_name_each_and_defaults_that_may_be_given() {
        for kind in Kind::ALL {
            let fields = kind.fields();
            for (i, field) in fields.iter().enumerate() {
                assert!(fields[..i].iter().all(|other| other.name != field.name), "{}", field.name);
                let given = (field.name, field.default.to_owned());
                let asked = Request::new(kind, [given]).unwrap();
                assert_eq!(asked.one(field.name), field.default, "{}", field.name);
            }
        }
        assert!(table().contains("  scale-to    LEVELS                Levels for all records"));
    }

    #[test]
    fn exact_what_is_no_field_is_said_with_the_nearest() {
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
    }
}
