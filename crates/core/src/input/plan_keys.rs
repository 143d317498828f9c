//! Every key of a study plan.

use super::keys::{CHANNEL, RECORD_STEP, UNITS, VERTICAL_SCALE};
use crate::units::Dimension;

use super::schema::{Exclusive, Key, Kind, MAX_WHOLE, Range, Section, Special};

/// The most runs that a study may have.
pub const MAX_RUNS: u64 = 100_000_000;

/// The whole file.
pub static PLAN: Section = Section {
    keys: &[
        Key::optional("name", Kind::Text("Friction over the suite"), "Name of the study."),
        Key::required(
            "model",
            Kind::Text("tank.toml"),
            "The model file, relative to the plan; with [records] its [motion] is replaced.",
        ),
        Key::optional(
            "bounds",
            Kind::Word(&["all", "lower", "nominal", "upper"]),
            "Which of the model's slider.bounds are run, in the column friction; default all.",
        ),
        Key::optional(
            "records",
            Kind::Section(&RECORDS),
            "The ground motions; without them the model's own motion is used.",
        ),
        Key::optional(
            "vary",
            Kind::Special(Special::Vary),
            "What is varied: paths of the model, the first is the first dimension.",
        ),
        Key::optional("sampling", Kind::Section(&SAMPLING), "How the varied values are chosen."),
    ],
    choices: &[],
};

static RECORDS: Section = Section {
    keys: &[
        Key::required(
            "files",
            Kind::Texts("far-field/*.AT2"),
            "Files or patterns with * and ?, relative to the plan; the matches of each are sorted.",
        ),
        Key::optional(
            "second",
            Kind::Texts("far-field/*-090.AT2"),
            "Files or patterns of the other horizontal components, one for each of files in the same \
             order, with one factor for the pair.",
        ),
        Key::optional(
            "pairs",
            Kind::Word(&["together", "separate"]),
            "How pairs of components are run: together, the table moving in two horizontal directions, or \
             separate, each component by itself; default together.",
        )
        .beside("second"),
        UNITS,
        RECORD_STEP,
        CHANNEL,
        Key::optional(
            "vertical",
            Kind::Texts("far-field/*-UP.AT2"),
            "Files or patterns of the vertical motions, one for each of files in the same order; \
             each takes the factor of its horizontal one.",
        ),
        VERTICAL_SCALE,
        Key::optional(
            "measure",
            Kind::Text("Sa(1.2 s)"),
            "Intensity measure that is scaled to the levels: PGA, PGV, Sa(1.2 s), Sa(1.2 s, 2 %), \
             Sa_avg(0.5 s, 3 s), of pairs RotD50(1.2 s), RotD100(1.2 s), …",
        ),
        Key::optional(
            "target",
            Kind::Text("target.csv"),
            "Spectrum to which each pair is brought by one factor: a CSV with the columns period_s and \
             sa_g, 5 % damped, relative to the plan.",
        )
        .beside("second"),
        Key::optional(
            "code_spectrum",
            Kind::Section(&CODE_SPECTRUM),
            "The same in the two-period shape of ASCE/SEI 7.",
        )
        .beside("second"),
        Key::optional(
            "periods",
            Kind::Quantities(Dimension::Time, Range::Positive, 2),
            "First and last period over which pairs are brought to the spectrum.",
        ),
        Key::optional(
            "levels",
            Kind::Special(Special::Levels),
            "Values of the measure to which each record is scaled.",
        )
        .beside("measure"),
        Key::optional(
            "scale",
            Kind::Numbers(Range::Any, MAX_RUNS as usize),
            "Factors on every record, instead of a measure; default [1].",
        ),
    ],
    choices: &[
        Exclusive::at_most(&["measure", "scale"]),
        Exclusive::at_most(&["measure", "target", "code_spectrum"]),
    ],
};

static CODE_SPECTRUM: Section = Section {
    keys: &[
        Key::required(
            "sds",
            Kind::Quantity(Dimension::Acceleration, Range::Positive),
            "Ordinate at short periods.",
        ),
        Key::required(
            "sd1",
            Kind::Quantity(Dimension::Acceleration, Range::Positive),
            "Ordinate at 1 s.",
        ),
        Key::required(
            "tl",
            Kind::Quantity(Dimension::Time, Range::Positive),
            "Period from which displacement is constant.",
        ),
    ],
    choices: &[],
};

static SAMPLING: Section = Section {
    keys: &[
        Key::required(
            "method",
            Kind::Word(&["sobol", "latin-hypercube", "grid"]),
            "Scrambled Sobol' points, a Latin hypercube, or every combination of lists.",
        ),
        Key::optional(
            "count",
            Kind::Whole(1, MAX_RUNS),
            "Number of samples; a grid has as many as its lists give.",
        ),
        Key::optional(
            "seed",
            Kind::Whole(0, MAX_WHOLE),
            "Seed of the samples: the same seed gives the same samples.",
        ),
        Key::optional(
            "correlation",
            Kind::Special(Special::Correlation),
            "Correlations of pairs of paths, by a Gaussian copula.",
        ),
    ],
    choices: &[],
};

const fn list(name: &'static str, count: usize, doc: &'static str) -> Key {
    Key::optional(name, Kind::Special(Special::Values(count)), doc)
}

/// How one path is varied.
pub static DISTRIBUTION: Section = Section {
    keys: &[
        list("values", 0, "A list of values."),
        list("linspace", 3, "First and last value and their number, at equal distances."),
        list("logspace", 3, "First and last value and their number, at equal ratios."),
        list("uniform", 2, "Least and largest value, all between equally probable."),
        list("normal", 2, "Mean and standard deviation."),
        list("lognormal", 2, "Median and standard deviation of the natural logarithm."),
        list("truncated", 2, "Least and largest value of a normal or lognormal distribution."),
        Key::optional(
            "factor_of",
            Kind::Text("slider.kinetic_friction"),
            "The path whose value is multiplied by what is drawn here.",
        ),
        Key::optional(
            "paired_with",
            Kind::Text("storey.1.mass"),
            "The path whose list goes with this one: the values of one place belong together.",
        )
        .beside("values"),
    ],
    choices: &[Exclusive::one_of(&[
        "values",
        "linspace",
        "logspace",
        "uniform",
        "normal",
        "lognormal",
    ])],
};
