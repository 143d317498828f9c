//! The analyses and their fields: a table from which every door makes its options, keywords or form.

use super::fields::{Field, FrontEnd, Measures, Takes};
use crate::assessment::code::CODES;
use crate::units::Dimension;

const PATH_VALUES: &str = "PATH=VALUES";

const METHOD: Field = Field::new(
    "method",
    "METHOD",
    "Method: exact, or stepwise as in the program of the paper; that of the model if left out",
)
.of(&["exact", "stepwise"]);
const MEASURE: Field = Field::new(
    "measure",
    "NAME",
    "Intensity measure: PGA, PGV, Sa(1.2 s), Sa(1.2 s, 2 %), Sa_avg(0.5 s, 3 s), of pairs RotD50(1.2 s), …",
)
.or("PGA");
const SCALE_TO: Field = Field::new(
    "scale-to",
    "LEVEL",
    "Scale every record to this value of the measure: \"0.4 g\"; as recorded if left out",
)
.sample("0.4 g")
.measuring(Measures::Intensity);
const SCALE: Field = Field::new("scale", "FACTOR", "Scale every record by this factor").or("1");
const VARY: Field = Field::new(
    "vary",
    PATH_VALUES,
    "Parameter to vary: slider.radius=\"1, 2, 3 m\" or slider.radius=1..5m:200; may be repeated",
)
.many()
.measuring(Measures::Key);
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
.many()
.range_of(Measures::Key);
const BY: Field = Field::new(
    "by",
    "PATH",
    "Curves of their own for each value of this path, else averaged over: slider.radius, friction",
);
const CONFIDENCE: Field =
    Field::new("confidence", "SHARE", "Confidence of intervals and band").or("0.9");
const MAPPING: Field = Field::new(
    "mapping",
    "FILE|QUANTITY=COLUMN",
    "Mapping file (TOML), or the column of a quantity: \"block_acceleration = A1 [g] * -1\"; may be repeated",
)
.many();

const PAIRS: Field = Field::new(
    "pairs",
    "RUN",
    "How pairs of components are run: together, the table moving in two horizontal directions, or separate, \
     each component by itself",
)
.of(&["together", "separate"])
.or("together");

const PROPERTY_FACTORS: Field = Field::new(
    "property-factors",
    "FACTORS",
    "Bounds of friction from property modification factors, of aging three quarters: \"test = 0.9..1.2, \
     aging = 1..1.3, specification = 0.85..1.15\"; with limits = 0.6..1.8 the products reach these at least",
);

const FLOOR_SPECTRUM: Field = Field::new(
    "floor-spectrum",
    "",
    "Add 5 % floor response spectra of ground, block and storeys to report and JSON; of pairs RotD100, x and y, of a \
     suite means and fractiles",
)
.flag();

/// Fields of one analysis.
const RUN: &[Field] = &[
    METHOD,
    PROPERTY_FACTORS,
    FLOOR_SPECTRUM,
    Field::new(
        "scale",
        "FACTOR",
        "Factor on the record, that of the model or one in its place; may be negative",
    ),
    Field::new(
        "scale-to",
        "PEAK",
        "Peak acceleration to scale the record to: \"0.3 g\"; of a suite the value of the measure",
    ),
];

/// Fields of analyses side by side.
const SUITE: &[Field] = &[
    Field::new(
        "measure",
        "NAME",
        "Intensity measure by which a suite is scaled: PGA, Sa(1.2 s), of pairs RotD50(1.2 s), …",
    )
    .or("PGA"),
    SCALE_TO,
    SCALE,
    Field::new(
        "code-spectrum",
        "VALUES",
        "Spectrum that pairs are scaled to, in the shape of ASCE/SEI 7: \"sds = 1.2 g, sd1 = 0.8 g, tl = 8 s\"",
    ),
    Field::new(
        "periods",
        "FROM..TO",
        "First and last period of the range in which pairs are scaled to the spectrum: \"0.6 s..3.8 s\"; 0.75 \
         and 1.25 effective periods of the hand calculation if left out",
    )
    .range_of(Measures::Of(Dimension::Time)),
    PROPERTY_FACTORS,
    Field::new(
        "hazard",
        "NAME[=FACTOR]",
        "What the report of a suite calls this intensity: MCE_R; repeated with a factor on it for a further one beside it: \
         DE=0.6667",
    )
    .many(),
    Field::new(
        "eccentricity",
        "LENGTHS",
        "Plan of the building, for the total displacement of the hand calculation: \"e = 1.2 m, y = 9 m, \
         b = 18 m, d = 24 m, pt = 1.1\"",
    ),
    Field::new(
        "code",
        "CODE",
        "Code whose requirements are judged row by row: demand, capacity, ratio, or why a row is not judged",
    )
    .of(CODES),
    Field::new(
        "code-values",
        "VALUES",
        "What the code asks for and no model says: \"R = 4, I_e = 1.5, S_1 = 0.9, V_wind = 900 kN\"; may be repeated",
    )
    .many(),
    FLOOR_SPECTRUM,
    Field::new("project", "NAME", "Project, for the title block of the report"),
    Field::new("author", "NAME", "Who answers for the report, for its title block"),
    Field::new("date", "DATE", "Date of the report as it is to be printed, for its title block"),
    Field::new(
        "history-of",
        "RECORD",
        "Record of a suite, by its name in the tables, whose history is written with each bound of friction; may be \
         repeated",
    )
    .many(),
    PAIRS,
];

/// Fields of the response over one parameter.
const SWEEP: &[Field] = &[Field::new(
    "over",
    PATH_VALUES,
    "Parameter along the axis and its values: slider.kinetic_friction=0.02..0.1:200",
)
.measuring(Measures::Key)];

/// Fields of a sliding spectrum.
const SPECTRUM: &[Field] = &[
    Field::new(
        "over",
        PATH_VALUES,
        "Parameter along the axis: storey.1.period=0.1..3s:30, isolator.period=1..5s:40, …",
    )
    .or("isolator.period=1..5s:40")
    .measuring(Measures::Key),
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
    PAIRS,
];

/// Fields of derivatives.
const SENSITIVITY: &[Field] = &[
    Field::new(
        "vary",
        "PATHS",
        "Keys of the model that the demands are derived by: slider.kinetic_friction,slider.radius; all numbers of \
         slider, block and structure if left out; may be repeated",
    )
    .formerly("paths")
    .many(),
    MEASURE,
    SCALE_TO,
    SCALE,
    Field::new(
        "demand",
        "KEY",
        "Keys of the demands; all that are numbers if left out; may be repeated",
    )
    .many(),
    PAIRS,
];

/// Fields of an incremental dynamic analysis.
const IDA: &[Field] = &[
    MEASURE,
    Field::new(
        "scale-to",
        "LEVELS",
        "Levels for all records: \"0.1, 0.2, 0.4 g\" or \"0.1..1.5 g:15\"; hunted, record by record, if \
         left out",
    )
    .measuring(Measures::Intensity),
    Field::new(
        "between",
        "FROM..TO",
        "First and highest level of the hunt: \"0.05..10 g\"; a twentieth and twenty times the records' \
         median if left out",
    )
    .range_of(Measures::Intensity),
    DEMAND,
    Field::new(
        "limit",
        "LIMIT",
        "Limit on the demand: \"150 mm\"; of sliding, slider.gap of the model if left out",
    )
    .key("slider.gap")
    .sample("150 mm")
    .measuring(Measures::Demand),
    FRICTION,
    VARY,
    KEEP,
    BY,
    BOUNDS,
    PAIRS,
];

/// Fields of a fragility.
const FRAGILITY: &[Field] = &[
    DEMAND,
    Field::new(
        "limit",
        "LIMIT",
        "Limit on the demand: \"150 mm\"; that of the analysis if left out, and of none where the table has \
         counts or capacities",
    )
    .measuring(Measures::Demand),
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
    Field::new(
        "fit-to",
        "DATA",
        "What the curve is fitted to; by the kind of data if left out",
    )
    .of(&["counts", "capacities", "cloud"]),
    Field::new(
        "where",
        "PATH=VALUE|FROM..TO",
        "Only rows with this value or within this range: slider.radius=\"1..2 m\", record=taft-111; may be \
         repeated",
    )
    .many()
    .range_of(Measures::Key),
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
    )
    .measuring(Measures::Demand),
    Field::new("cap", "LIMIT", "Demands above this count as above it only, in a cloud")
        .measuring(Measures::Demand),
    CONFIDENCE,
];

/// Fields of a design.
const DESIGN: &[Field] = &[
    FRICTION.sample("0.02..0.12:20"),
    VARY.sample("slider.radius=1..5m:12"),
    MEASURE,
    SCALE_TO,
    SCALE,
    Field::new(
        "gap",
        "LENGTH",
        "Sliding displacement not to be exceeded; slider.gap of the model if left out",
    )
    .key("slider.gap")
    .sample("150 mm")
    .measuring(Measures::Of(Dimension::Length)),
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
        "friction-factors",
        "LOWER,UPPER",
        "Factors on friction for the robustness check: 0.8,1.3; slider.bounds of the model if left out",
    )
    .formerly("bounds"),
    Field::new(
        "sensitivity",
        "N",
        "Sample points of the sensitivity (Sobol' indices); 0 for none; 256 if left out, of pairs run together 64",
    ),
    Field::new("seed", "SEED", "Seed of those points").or("1"),
    CONFIDENCE,
    PAIRS,
];

/// Fields of a comparison with a measurement.
const COMPARE: &[Field] = &[
    MAPPING,
    METHOD,
    Field::new(
        "within",
        "METRIC.QUANTITY=LEAST..MOST",
        "A bound to keep: \"peak_ratio.sliding_displacement=0.9..1.1\"; may be repeated",
    )
    .many(),
];

/// Fields of an identification from cyclic tests.
const CYCLIC: &[Field] = &[
    Field::new(
        "mass",
        "MASS",
        "Mass of the block: friction becomes a coefficient, and a model of the block is made",
    )
    .measuring(Measures::Of(Dimension::Mass)),
    Field::new(
        "normal-force",
        "FORCE",
        "Force that presses the block on its surface, where it is not the weight of that mass: of all tests, or one \
         for each in their order, \"400 kN,800 kN\"",
    )
    .many()
    .measuring(Measures::Of(Dimension::Force)),
    Field::new(
        "area",
        "AREA",
        "Area of the bearing: from tests under several normal forces, how friction follows the pressure, \
         μ(p) = μ (p/reference)^(-exponent)",
    )
    .measuring(Measures::Of(Dimension::Area)),
    Field::new(
        "reference-pressure",
        "PRESSURE",
        "Pressure at which coefficients are told; if left out, that of the tests which is next to the geometric mean of \
         the least and the largest",
    )
    .measuring(Measures::Of(Dimension::Pressure)),
    Field::new(
        "law",
        "LAW",
        "How kinetic friction follows the sliding speed: not at all, or by slow and fast coefficients and the \
         rate between them, which takes tests at several speeds and leaves out the damper",
    )
    .of(&["coulomb", "slow-fast-rate"])
    .or("coulomb"),
    Field::new(
        "without",
        "PART",
        "Do not fit these beside friction: spring, damper",
    )
    .many(),
    Field::new(
        "slack",
        "LENGTH",
        "Travel after each reversal to leave out (backlash); found from the force if left out",
    )
    .measuring(Measures::Of(Dimension::Length)),
    MAPPING,
];

/// Fields of an identification from free vibration.
const FREE_VIBRATION: &[Field] = &[
    Field::new(
        "channel",
        "QUANTITY",
        "Quantity to fit, where the file has several: storey1_acceleration, displacement, …",
    ),
    Field::new("start", "TIME", "Time at which free vibration starts: \"12 s\"")
        .measuring(Measures::Of(Dimension::Time)),
    Field::new("end", "TIME", "Time at which it ends").measuring(Measures::Of(Dimension::Time)),
    MAPPING,
];

/// Fields of an identification from a shaking-table record.
const SHAKING_TABLE: &[Field] = &[
    Field::new(
        "fit",
        "PATH[=LEAST..MOST]",
        "Keys to fit, each perhaps with its range: \"slider.spring=100 kN/m..200 kN/m\"; may be repeated",
    )
    .many()
    .range_of(Measures::Key),
    Field::new(
        "using",
        "QUANTITY",
        "Measured quantities to fit; all if left out",
    )
    .many(),
    Field::new(
        "instrument",
        "[QUANTITY.]WHAT=DEVIATION",
        "What is not known of the sensors, standard deviations: gain=5 %, lag=20 ms, of one quantity also zero, \
         drift and noise (\"sliding_displacement.drift=1 mm\"); 0 is known, exact is all known; may be repeated",
    )
    .many(),
    Field::new("seed", "SEED", "Seed of the random starts").or("1"),
    MAPPING,
];

/// An analysis that is asked for by fields. What is asked of a study is its plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One model on one motion.
    Run,
    /// Models on the records of a suite, side by side.
    Suite,
    /// How demands on one motion follow a parameter.
    Sweep,
    /// A sliding spectrum, or response over excitation frequency.
    Spectrum,
    /// Derivatives of the demands with respect to keys of the model.
    Sensitivity,
    /// An incremental dynamic analysis.
    Ida,
    /// A lognormal fragility of a table of runs.
    Fragility,
    /// The friction and stiffness that keep a gap.
    Design,
    /// A prediction beside a measurement.
    Compare,
    /// Friction from cyclic tests.
    Cyclic,
    /// Frequency and damping from free vibration.
    FreeVibration,
    /// Keys of a model from a shaking-table record.
    ShakingTable,
}

impl Kind {
    /// All of them, in their order.
    pub const ALL: [Self; 12] = [
        Self::Run,
        Self::Suite,
        Self::Sweep,
        Self::Spectrum,
        Self::Sensitivity,
        Self::Ida,
        Self::Fragility,
        Self::Design,
        Self::Compare,
        Self::Cyclic,
        Self::FreeVibration,
        Self::ShakingTable,
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Run => "run",
            Self::Suite => "suite",
            Self::Sweep => "sweep",
            Self::Spectrum => "spectrum",
            Self::Sensitivity => "sensitivity",
            Self::Ida => "ida",
            Self::Fragility => "fragility",
            Self::Design => "design",
            Self::Compare => "compare",
            Self::Cyclic => "cyclic",
            Self::FreeVibration => "free-vibration",
            Self::ShakingTable => "shaking-table",
        }
    }

    /// That of a name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// What it is, in a sentence.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::Run => "One model on one motion.",
            Self::Suite => "Models on the records of a suite, side by side, with what governs.",
            Self::Sweep => "How the demands on one motion follow a value of the model.",
            Self::Spectrum => "Fractiles of the demands over a parameter of the model.",
            Self::Sensitivity => {
                "How much each key of the model changes each demand, with its error."
            }
            Self::Ida => "Incremental dynamic analysis: demands over intensity, record by record.",
            Self::Fragility => "The probability of exceeding a limit over intensity.",
            Self::Design => "The least floor acceleration that stays within a gap.",
            Self::Compare => "A prediction beside what was measured on a shaking table.",
            Self::Cyclic => "Friction, spring and damper from cyclic tests.",
            Self::FreeVibration => "Frequency and damping ratio of a storey from free vibration.",
            Self::ShakingTable => "Keys of a model from a shaking-table record.",
        }
    }

    /// A field by its name, or by what it was called.
    #[must_use]
    pub fn field(self, name: &str) -> Option<&'static Field> {
        let called =
            |field: &&Field| field.name == name || (!name.is_empty() && field.formerly == name);
        self.fields().iter().find(called)
    }

    /// Its fields, in the order of a help.
    #[must_use]
    pub fn fields(self) -> &'static [Field] {
        match self {
            Self::Run => RUN,
            Self::Suite => SUITE,
            Self::Sweep => SWEEP,
            Self::Spectrum => SPECTRUM,
            Self::Sensitivity => SENSITIVITY,
            Self::Ida => IDA,
            Self::Fragility => FRAGILITY,
            Self::Design => DESIGN,
            Self::Compare => COMPARE,
            Self::Cyclic => CYCLIC,
            Self::FreeVibration => FREE_VIBRATION,
            Self::ShakingTable => SHAKING_TABLE,
        }
    }
}

/// What a door does not offer, and why: a field of an analysis, or all of it.
pub const NOT_OFFERED: &[(FrontEnd, Kind, Option<&str>, &str)] = &[
    (
        FrontEnd::Command,
        Kind::Sweep,
        None,
        "spectrum over the model's own motion, or a study, tells it",
    ),
    (FrontEnd::Python, Kind::Run, Some("method"), "analysis.method is a key of the model"),
    (FrontEnd::Python, Kind::Run, Some("scale"), "Motion.scaled scales a motion"),
    (FrontEnd::Python, Kind::Run, Some("scale-to"), "Motion.scaled scales a motion"),
    (FrontEnd::Python, Kind::Run, Some("property-factors"), "slider.bounds is a key of the model"),
    (
        FrontEnd::Python,
        Kind::Suite,
        Some("history-of"),
        "run tells the history of a model on a motion",
    ),
    (FrontEnd::Python, Kind::Sweep, None, "study tells it"),
    (FrontEnd::Page, Kind::Run, None, "the page shows the run of its own model and motion"),
    (FrontEnd::Page, Kind::Suite, Some("code-spectrum"), "the page has no pairs of records"),
    (FrontEnd::Page, Kind::Suite, Some("periods"), "the page has no pairs of records"),
    (
        FrontEnd::Page,
        Kind::Suite,
        Some("history-of"),
        "the page shows the histories of its own motion",
    ),
    (FrontEnd::Page, Kind::Suite, Some("pairs"), "the page has no pairs of records"),
    (FrontEnd::Page, Kind::Spectrum, Some("pairs"), "the page has no pairs of records"),
    (FrontEnd::Page, Kind::Sensitivity, Some("pairs"), "the page has no pairs of records"),
    (FrontEnd::Page, Kind::Ida, Some("pairs"), "the page has no pairs of records"),
    (FrontEnd::Page, Kind::Design, Some("pairs"), "the page has no pairs of records"),
    (FrontEnd::Page, Kind::Compare, None, "the page shows no measurements"),
    (FrontEnd::Page, Kind::Cyclic, None, "the page shows no measurements"),
    (FrontEnd::Page, Kind::FreeVibration, None, "the page shows no measurements"),
    (FrontEnd::Page, Kind::ShakingTable, None, "the page shows no measurements"),
];

impl Kind {
    /// The fields that a door offers.
    pub fn offered(self, door: FrontEnd) -> impl Iterator<Item = &'static Field> {
        let missing = move |field: &Field| {
            let mut of_door = NOT_OFFERED.iter().filter(|(at, of, ..)| (*at, *of) == (door, self));
            of_door.any(|(_, _, name, _)| name.is_none_or(|name| name == field.name))
        };
        self.fields().iter().filter(move |field| !missing(field))
    }
}

/// All fields of all analyses as text, a line each: name, what it takes, its default, what it is.
#[must_use]
pub fn table() -> String {
    let mut text = String::new();
    for kind in Kind::ALL {
        let rule = if text.is_empty() { "" } else { "\n" };
        text.push_str(&format!("{rule}{}: {}\n", kind.name(), kind.about()));
        for Field { name, value, takes, default, about, .. } in kind.fields() {
            let value = match takes {
                Takes::Choice(words) => words.join("|"),
                Takes::One | Takes::Many | Takes::Flag => (*value).to_owned(),
            };
            let default =
                if default.is_empty() { String::new() } else { format!(" [default: {default}]") };
            text.push_str(&format!("  {name:<16} {value:<21} {about}{default}\n"));
        }
    }
    text.push_str("\nstudy: its plan (slipstick schema --plan)\n\nNot offered:\n");
    for (door, kind, field, reason) in NOT_OFFERED {
        let door = match door {
            FrontEnd::Command => "command",
            FrontEnd::Python => "Python",
            FrontEnd::Page => "page",
        };
        let what = format!("{} {}", kind.name(), field.unwrap_or_default());
        text.push_str(&format!("  {door:<8} {:<21} {reason}\n", what.trim_end()));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requests::Request;

    #[test]
    fn fields_have_one_name_each_and_defaults_that_may_be_given() {
        for (place, kind) in Kind::ALL.into_iter().enumerate() {
            assert_eq!((kind as usize, Kind::of_name(kind.name())), (place, Some(kind)));
            let fields = kind.fields();
            for (i, field) in fields.iter().enumerate() {
                let names = |of: &Field| [of.name, of.formerly].contains(&field.name);
                assert!(!fields[..i].iter().any(names), "{}", field.name);
                assert_eq!(kind.field(field.name), Some(field));
                let given = (field.name, field.default.to_owned());
                let asked = Request::new(kind, [given]).unwrap();
                assert_eq!(asked.one(field.name), field.default, "{}", field.name);
            }
        }
        let unit = |kind: Kind, name: &str, key: &str, demand: &str| {
            let field = kind.fields().iter().find(|field| field.name == name).unwrap();
            let of = |other: &str| match other {
                "demand" => demand.to_owned(),
                _ => Request::new(kind, []).unwrap().one(other).to_owned(),
            };
            field.unit(key, of)
        };
        assert_eq!(unit(Kind::Ida, "limit", "", "peak_sliding_displacement_m"), "m");
        assert_eq!(unit(Kind::Ida, "limit", "", "gap_ratio"), "");
        assert_eq!(unit(Kind::Ida, "scale-to", "", ""), "m/s2");
        assert_eq!(unit(Kind::Spectrum, "over", "isolator.period", ""), "s");
        assert_eq!(unit(Kind::Spectrum, "vary", "storey.1.frequency", ""), "Hz");
        assert_eq!(unit(Kind::Spectrum, "vary", "slider.kinetic_friction", ""), "");
        assert_eq!(unit(Kind::Spectrum, "vary", "slider.raduis", ""), "");
        for (_, kind, name, reason) in NOT_OFFERED {
            let known = |name: &str| kind.fields().iter().any(|field| field.name == name);
            assert!(name.is_none_or(known) && !reason.is_empty(), "{name:?}");
        }
        assert!(
            table().contains("  scale-to         LEVELS                Levels for all records")
        );
    }
}
