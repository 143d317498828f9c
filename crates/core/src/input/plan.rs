//! Study plans: text to a checked plan.
//!
//! A plan names a model, perhaps records with their levels, what is varied and how the samples are
//! drawn. Its keys are described as a model's are, in `plan_keys`; the paths that it varies
//! are those of the model.

use super::reader::Values;
use super::schema::Range;
use super::tree::{self, SourceSpan};
use super::{MAX_TEXT_BYTES, dimension_of, utf8};
use crate::error::InputError;
use crate::motion::intensity::LevelMeasure;
use crate::motion::target::TargetSpectrum;
use crate::record::Units;
use crate::units::Dimension;

mod records;
mod sampling;
mod vary;

/// All that a plan says.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The study's name, where it has one.
    pub name: Option<String>,
    /// Path of the model file as written, relative to the plan.
    pub model: String,
    /// Name of the one bound of friction that is run; `None` for all that the model gives.
    pub bound: Option<&'static str>,
    /// The ground motions; without them the model's own motion is used.
    pub records: Option<Records>,
    /// What is varied, in the order of the text.
    pub vary: Vec<Varied>,
    /// How the varied values are chosen; `None` where nothing is varied.
    pub sampling: Option<Sampling>,
    values: Values,
}

/// The ground motions of a plan, before any is opened.
#[derive(Clone, Debug, PartialEq)]
pub struct Records {
    /// Files or patterns as written, relative to the plan.
    pub files: Vec<String>,
    /// Files or patterns of the other horizontal components, in the order of the first.
    pub second: Vec<String>,
    /// Whether both components of a pair move the table at once, else each by itself.
    pub together: bool,
    /// Spectrum to which pairs are brought, and the periods in s over which.
    pub target: Option<(Target, [f64; 2])>,
    /// Unit of their values, where the files do not state it.
    pub units: Option<Units>,
    /// Name of that unit.
    pub unit_name: Option<String>,
    /// Their time step in s, where the files do not state it.
    pub dt_s: Option<f64>,
    /// Which of their channels, by name or by number from 1.
    pub channel: Option<String>,
    /// Files or patterns of the vertical motions, in the order of the horizontal ones.
    pub vertical: Vec<String>,
    /// Factor on the vertical motions besides that of the horizontal ones; 1 where `None`.
    pub vertical_scale: Option<f64>,
    /// How the records are scaled.
    pub levels: Levels,
}

/// A spectrum to which pairs are brought.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Path of a file as written, relative to the plan.
    File(String),
    /// A shape of a code.
    Shape(TargetSpectrum),
}

/// How each record is scaled, once a level.
#[derive(Clone, Debug, PartialEq)]
pub enum Levels {
    /// By factors.
    Factors(Vec<f64>),
    /// So that a measure takes values.
    Measure {
        /// The measure, of a record or of a pair.
        measure: LevelMeasure,
        /// Its values, in its SI unit.
        levels: Vec<f64>,
    },
}

impl Levels {
    /// Number of levels.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Factors(list) | Self::Measure { levels: list, .. } => list.len(),
        }
    }

    /// Never: a plan gives at least one.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A path of the model that is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// The path.
    pub path: String,
    /// The SI unit of its values (Hz for frequencies); empty where they have none.
    pub unit: &'static str,
    /// The values that the model takes there.
    pub(super) range: Range,
    /// Whether it is of the records, and no key of the model's text.
    pub(super) of_records: bool,
    /// What is drawn: values, or factors where `factor_of` is given.
    pub distribution: Distribution,
    /// The path whose value is multiplied by what is drawn.
    pub factor_of: Option<String>,
    /// Index of the path in whose list the value of the same place is drawn.
    pub paired_with: Option<usize>,
}

/// What may be drawn, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// One of a list, each with the same probability.
    List(List),
    /// Anything between the two.
    Uniform([f64; 2]),
    /// A normal distribution, perhaps truncated.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation, > 0.
        deviation: f64,
        /// Least and largest value.
        truncated: Option<[f64; 2]>,
    },
    /// A lognormal distribution, perhaps truncated.
    Lognormal {
        /// Median, > 0.
        median: f64,
        /// Standard deviation of the natural logarithm, > 0.
        sigma_ln: f64,
        /// Least and largest value.
        truncated: Option<[f64; 2]>,
    },
}

/// A list of values, written out or by its ends.
#[derive(Clone, Debug, PartialEq)]
pub enum List {
    /// As written.
    Values(Vec<f64>),
    /// At equal distances, both ends included.
    Even {
        /// First and last value.
        ends: [f64; 2],
        /// Number of values, ≥ 2.
        count: u64,
    },
    /// At equal ratios, both ends included, both > 0.
    Ratios {
        /// First and last value.
        ends: [f64; 2],
        /// Number of values, ≥ 2.
        count: u64,
    },
}

/// The number of 15 digits, as a person writes it, where it is as near as the rounding of the sum of two
/// numbers up to `size`: 0.03 + 3 (0.07 − 0.03) / 4 is 0.06, not 0.060000000000000005.
fn as_written(value: f64, size: f64) -> f64 {
    let short = format!("{value:.14e}").parse().unwrap_or(value);
    if (short - value).abs() <= f64::EPSILON * size { short } else { value }
}

impl List {
    /// Number of values.
    #[must_use]
    pub fn len(&self) -> u64 {
        match self {
            Self::Values(values) => values.len() as u64,
            Self::Even { count, .. } | Self::Ratios { count, .. } => *count,
        }
    }

    /// Never: a list has at least one value.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value of an index from 0; of one beyond the end, the last.
    #[must_use]
    pub fn get(&self, index: u64) -> f64 {
        match self {
            Self::Values(values) => {
                let last = values.len().saturating_sub(1);
                values.get((index as usize).min(last)).copied().unwrap_or(f64::NAN)
            }
            Self::Even { ends: [first, last], count } => match index {
                0 => *first,
                index if index + 1 >= *count => *last,
                index => {
                    let value = first + (last - first) * (index as f64 / (count - 1) as f64);
                    as_written(value, first.abs().max(last.abs()))
                }
            },
            Self::Ratios { ends: [first, last], count } => match index {
                0 => *first,
                index if index + 1 >= *count => *last,
                index => {
                    let fraction = index as f64 / (count - 1) as f64;
                    let [from, to] = [libm::log(*first), libm::log(*last)];
                    libm::exp(from + (to - from) * fraction)
                }
            },
        }
    }
}

/// How samples are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Scrambled Sobol' points.
    Sobol,
    /// A Latin hypercube.
    LatinHypercube,
    /// Every combination of the lists, the last path fastest.
    Grid,
}

/// How the varied values are chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    /// The method.
    pub method: Method,
    /// Number of samples; of a grid the product of its lists' lengths.
    pub count: u64,
    /// Seed; `None` for a grid, which draws nothing.
    pub seed: Option<u64>,
    /// Lower triangle `L` of the correlation `L Lᵀ`, row by row, square; `None` without correlation.
    pub correlation: Option<Vec<f64>>,
}

/// The path of `[motion]` that may be varied beside records: it turns their pairs.
pub(crate) const ROTATE: &str = "motion.rotate";

/// Whether a path says how the table moves, which records do in its place.
pub(crate) fn is_of_motion(path: &str) -> bool {
    path.starts_with("motion.") && path != ROTATE
}

impl Plan {
    /// Reads a plan's text. `source_name` is what errors call it.
    ///
    /// # Errors
    /// [`InputError`] for the first fault found.
    ///
    /// # Examples
    /// ```
    /// use slipstick::input::plan::{Distribution, Plan};
    ///
    /// let text = "model = \"tank.toml\"\n[vary]\n\"slider.radius\" = { uniform = [\"1 m\", \"2 m\"] }\n\
    ///             [sampling]\nmethod = \"sobol\"\ncount = 1000\nseed = 1\n";
    /// let plan = Plan::parse("plan.toml", text)?;
    /// assert_eq!(plan.vary[0].distribution, Distribution::Uniform([1.0, 2.0]));
    ///
    /// let error = Plan::parse("plan.toml", &text.replace("radius", "radios")).unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "plan.toml:3:1: vary.slider.radios: expected a path of the model, found \
    ///      \"slider.radios\"; nearest is \"slider.radius\""
    /// );
    /// # Ok::<(), slipstick::error::InputError>(())
    /// ```
    pub fn parse(source_name: &str, text: &str) -> Result<Self, InputError> {
        let mut sources = tree::Sources::default();
        let file = sources.add(source_name, text);
        if text.len() > MAX_TEXT_BYTES {
            let start = SourceSpan { source: file, span: 0..0 };
            let expected = format!("a plan of at most {MAX_TEXT_BYTES} bytes");
            return Err(sources.error(&start, "", expected, text.len().to_string()));
        }
        let root = tree::parse_document(&sources, file)?;
        let mut values = Values::read(sources, &root, &super::plan_keys::PLAN)?;
        let mut vary = vary::read(&mut values)?;
        let records = records::read(&values)?;
        for varied in &mut vary {
            varied.of_records = records.is_some() && varied.path == ROTATE;
        }
        if records.is_some()
            && let Some(moved) = vary.iter().find(|varied| is_of_motion(&varied.path))
        {
            let expected = "no path of [motion] but rotate beside [records], which replaces it";
            let path = format!("vary.{}", moved.path);
            return Err(values.error(&path, expected, format!("\"{}\"", moved.path)));
        }
        let sampling = sampling::read(&mut values, &vary)?;
        Ok(Self {
            name: values.text("name").map(str::to_owned),
            model: values.text("model").unwrap_or_default().to_owned(),
            bound: match values.text("bounds") {
                Some("lower") => Some("lower"),
                Some("nominal") => Some("nominal"),
                Some("upper") => Some("upper"),
                _ => None,
            },
            records,
            vary,
            sampling,
            values,
        })
    }

    /// A plan of designs that are listed: of each path a value a design, in SI, all lists of one length.
    ///
    /// # Errors
    /// [`InputError`] for a path that no model has or that takes no number, and for a value that it does not
    /// take.
    pub fn listed(paths: &[(String, Vec<f64>)], on_records: bool) -> Result<Self, InputError> {
        let mut text = String::from("model = \"model.toml\"\n");
        if on_records {
            text.push_str("[records]\nfiles = [\"records\"]\n");
        }
        text.push_str("[vary]\n");
        let first_path = paths.first().map(|(path, _)| path.as_str());
        for (path, values) in paths {
            let unit = dimension_of(path)?.map_or("", Dimension::si_unit);
            let first = values.first().copied().unwrap_or(f64::NAN);
            let value = if unit.is_empty() {
                format!("{first:?}")
            } else {
                format!("\"{first:?} {unit}\"")
            };
            let paired = first_path.filter(|first| first != path);
            let paired = paired.map_or(String::new(), |first| format!(", paired_with = {first:?}"));
            text.push_str(&format!("{path:?} = {{ values = [{value}]{paired} }}\n"));
        }
        text.push_str("[sampling]\nmethod = \"grid\"\n");
        let mut plan = Self::parse("", &text)?;
        for (varied, (_, values)) in plan.vary.iter_mut().zip(paths) {
            varied.distribution = Distribution::List(List::Values(values.clone()));
        }
        if let (Some(sampling), Some((_, values))) = (&mut plan.sampling, paths.first()) {
            sampling.count = values.len() as u64;
        }
        Ok(plan)
    }

    /// As [`Plan::parse`], for the bytes of a file.
    ///
    /// # Errors
    /// As [`Plan::parse`], and for bytes that are not UTF-8.
    pub fn from_bytes(source_name: &str, bytes: &[u8]) -> Result<Self, InputError> {
        Self::parse(source_name, utf8(source_name, bytes)?)
    }

    /// The error for a value that only its user can judge, at that value; where it is not written,
    /// at the table that lacks it.
    pub fn error_at(
        &self,
        path: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> InputError {
        self.values.error(path, expected, found)
    }

    /// That there is one other component for each of some files, or none at all; `component` is what the
    /// key lists, `of` what the files are called.
    ///
    /// # Errors
    /// [`InputError`] at the key.
    pub fn one_each(
        &self,
        (key, component): (&str, &str),
        others: usize,
        (files, of): (usize, &str),
    ) -> Result<(), InputError> {
        if others == 0 || others == files {
            return Ok(());
        }
        let expected = format!("one {component} for each of {files} {of}");
        Err(self.error_at(&format!("records.{key}"), expected, others.to_string()))
    }

    /// Number of samples: 1 where nothing is varied.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.sampling.as_ref().map_or(1, |sampling| sampling.count)
    }
}
