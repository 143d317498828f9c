//! What can go wrong, one enum a kind of failure.

/// A number that a model cannot have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// A quantity outside the range in which the model means anything.
    #[error("{quantity}: expected {expected}, found {found}")]
    OutOfRange {
        /// Name of the quantity with its unit, as the constructor calls it.
        quantity: &'static str,
        /// The range, in words.
        expected: &'static str,
        /// The value given, in the quantity's SI unit.
        found: f64,
    },
    /// Lists that must have one entry a storey and have not.
    #[error("{quantity}: expected {expected} values, one a storey, found {found}")]
    WrongCount {
        /// Name of the list.
        quantity: &'static str,
        /// Number of storeys.
        expected: usize,
        /// Length of the list given.
        found: usize,
    },
    /// A quantity of which nothing was given.
    #[error("{quantity}: expected {expected}, found none")]
    Missing {
        /// Name of the quantity.
        quantity: &'static str,
        /// What it takes.
        expected: &'static str,
    },
    /// Text that is no such quantity.
    #[error("{quantity}: {error}")]
    Quantity {
        /// Name of the quantity.
        quantity: &'static str,
        /// What was expected and found.
        error: UnitError,
    },
}

/// A channel that a format of records cannot hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RecordWriteError {
    /// Counts of a recorder, which are no motion.
    #[error("expected acceleration, velocity or displacement, found counts of a recorder")]
    Counts,
    /// Uneven times in a format that has a step only.
    #[error(
        "{format} has no times: expected even sampling, found uneven (resample it, or write CSV)"
    )]
    Uneven {
        /// The format.
        format: &'static str,
    },
    /// A value with more digits than a field of the format.
    #[error("expected values below 1e10 in the units of the format, found {value:e}")]
    TooLarge {
        /// The value in the units of the format.
        value: f64,
    },
}

/// Samples that are no ground motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// Fewer than two samples, or lists of different lengths.
    #[error("expected at least two samples with one value each, found {found}")]
    TooShort {
        /// Number of samples or of values found.
        found: usize,
    },
    /// More samples than any analysis needs.
    #[error("expected at most 100 000 000 samples, found {found:e}")]
    TooLong {
        /// Number asked for.
        found: f64,
    },
    /// A value that is not finite.
    #[error("sample {index}: expected a finite {quantity}, found {found}")]
    NotFinite {
        /// Index of the sample, from 0.
        index: usize,
        /// Which of its values.
        quantity: &'static str,
        /// The value.
        found: f64,
    },
    /// A value larger than any that can be computed with.
    #[error("sample {index}: expected a {quantity} of at most {limit:e} in SI, found {found:e}")]
    TooLarge {
        /// Index of the sample, from 0.
        index: usize,
        /// Which of its values.
        quantity: &'static str,
        /// The value.
        found: f64,
        /// The limit.
        limit: f64,
    },
    /// Time that runs backwards, or stands still for more than one jump.
    #[error(
        "sample {index}: expected a time after {previous_s} s (or once the same, for a jump), \
         found {found_s} s"
    )]
    TimeOrder {
        /// Index of the sample, from 0.
        index: usize,
        /// Time of the sample before it, in s.
        previous_s: f64,
        /// Its own time, in s.
        found_s: f64,
    },
    /// A gap that makes the motion longer than its samples can tell of.
    #[error(
        "sample {index}: expected a motion of at most {longest_s} s, in proportion to its samples, \
         found a gap from {from_s} s to {to_s} s: correct the time, or cut the motion there"
    )]
    Gap {
        /// Index of the sample after the gap, from 0.
        index: usize,
        /// Time of the sample before it, in s.
        from_s: f64,
        /// Its own time, in s.
        to_s: f64,
        /// How long the motion may be, in s.
        longest_s: f64,
    },
    /// A parameter of a made motion, or a factor, outside its range.
    #[error("{quantity}: expected {expected}, found {found}")]
    OutOfRange {
        /// Name of the parameter with its unit.
        quantity: &'static str,
        /// The range, in words.
        expected: &'static str,
        /// The value given.
        found: f64,
    },
    /// A step of processing that needs a constant time step.
    #[error("{step}: expected evenly spaced samples, found uneven ones: resample first")]
    Uneven {
        /// The step.
        step: &'static str,
    },
    /// Counts of a recorder where motion is needed.
    #[error("expected acceleration, velocity or displacement, found counts of a recorder")]
    Counts,
    /// A peak was asked of a motion that is zero throughout.
    #[error("scale_to: expected a motion that is not zero throughout, its peak is 0 m/s²")]
    ZeroPeak,
}

const GIB: f64 = (1_u64 << 30) as f64;

/// An analysis that has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// More events in one sample interval than any real system has.
    #[error(
        "more than {limit} stick/slip events in one sample interval, at {} s: \
         the block chatters; check masses, stiffnesses and friction", short(*time_s)
    )]
    TooManyEvents {
        /// When it was noticed, in s.
        time_s: f64,
        /// The limit.
        limit: u32,
    },
    /// An analysis that would take hours: the motion has more radians of the fastest mode than samples
    /// tell of, or the model has more storeys than that.
    #[error("the analysis would take {work:.1e} steps, where {limit:.0e} are the most: {advice}")]
    TooMuchWork {
        /// Radians that the fastest mode turns, times the square of the number of masses.
        work: f64,
        /// The limit.
        limit: f64,
        /// What makes it long, and what to do.
        advice: String,
    },
    /// An analysis whose history, which its certificate needs, would not fit into the memory.
    #[error(
        "the history would take {:.1} GiB, where {:.0} GiB are the most: {samples} samples with \
         {numbers} numbers each; take a longer time step or a shorter motion",
        *bytes as f64 / GIB, *limit as f64 / GIB
    )]
    TooMuchMemory {
        /// Memory that the analysis and its certificate would take.
        bytes: u64,
        /// The limit.
        limit: u64,
        /// Number of samples.
        samples: usize,
        /// Numbers that are kept of each.
        numbers: usize,
    },
    /// A state that left the range of numbers.
    #[error(
        "the response is not finite at {} s: check masses, stiffnesses and the motion", short(*time_s)
    )]
    NotFinite {
        /// When it was noticed, in s.
        time_s: f64,
    },
    /// All surfaces in series are at the end of their travel.
    #[error(
        "all sliding surfaces reach the end of their travel at {} s, and nothing stops the \
         block: give [slider.stop] with a gap within the travel, or longer travels", short(*time_s)
    )]
    EndOfTravel {
        /// When, in s.
        time_s: f64,
        /// The travel of all of them together, in m: the sliding displacement then, to either side.
        travel_m: f64,
    },
    /// A model that a method does not take.
    #[error("{method}: expected a model without {what}")]
    NotTaken {
        /// The method.
        method: &'static str,
        /// What of the model it does not take.
        what: &'static str,
    },
    /// Ended by whoever follows it.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// The iteration of the stepwise method did not converge.
    #[error(
        "stepwise method: {iterations} iterations did not converge at {} s: it converges only \
         where the fastest mode times the step is below 2 (here {omega_dt:.3}) and where stick and \
         slip do not take turns within the step; a shorter step or the exact method helps",
        short(*time_s)
    )]
    NoConvergence {
        /// Time of the step's end, in s.
        time_s: f64,
        /// Iterations made.
        iterations: u32,
        /// Largest rate of the system times the step.
        omega_dt: f64,
    },
}

/// A run that has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// Values that make no model.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A motion that cannot be made or scaled.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// Bounds of friction that make no model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A model that is to move the table itself and does not.
    #[error("the model makes no motion")]
    NoMotion,
    /// The analysis itself.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// An answer that the independent check does not confirm, which is none.
    #[error("the independent check does not confirm it: {what}")]
    Unconfirmed {
        /// What is not confirmed.
        what: String,
    },
}

impl RunError {
    /// Whether there was an answer, which the check does not confirm.
    #[must_use]
    pub fn is_unconfirmed(&self) -> bool {
        matches!(self, Self::Unconfirmed { .. })
    }

    /// The sliding displacement in m that the run reached, where it ended because its travel was used up.
    #[must_use]
    pub fn travel_used_up_m(&self) -> Option<f64> {
        match self {
            Self::Solve(SolveError::EndOfTravel { travel_m, .. }) => Some(*travel_m),
            _ => None,
        }
    }
}

/// What ended because the callback that followed it said so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("stopped before the end")]
pub struct Stopped;

/// A choice that cannot be: which, what was expected, what was found.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}: expected {expected}, found {found}{}", nearest_suffix(nearest.as_deref()))]
pub struct ChoiceError {
    /// What was chosen: `demand`, `measure`, a path of the model.
    pub what: String,
    /// What was expected.
    pub expected: String,
    /// What was found.
    pub found: String,
    /// The word that was probably meant.
    pub nearest: Option<String>,
}

/// A cell of a table that is not what it must be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("row {row}, column {column}: expected {expected}, found {found}")]
pub struct CellError {
    /// The row, from 0.
    pub row: usize,
    /// Name of the column.
    pub column: String,
    /// What was expected.
    pub expected: String,
    /// What was found.
    pub found: String,
}

/// Data from which a statistic cannot be told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Fewer observations than the statistic needs.
    #[error("expected at least {expected} {what}, found {found}")]
    TooFew {
        /// What is counted.
        what: &'static str,
        /// How many are needed.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// A number outside its range.
    #[error("{quantity}: expected {expected}, found {found}")]
    OutOfRange {
        /// Its name.
        quantity: &'static str,
        /// The range, in words.
        expected: &'static str,
        /// The number.
        found: f64,
    },
    /// No observation exceeds the limit.
    #[error(
        "none of {runs} runs exceeds the limit, up to an intensity of {}: a fragility cannot be \
         told; go to higher intensities or take a smaller limit", short(*highest)
    )]
    NoneExceeds {
        /// Number of runs.
        runs: u64,
        /// Highest intensity among them.
        highest: f64,
    },
    /// Every observation exceeds the limit.
    #[error(
        "all of {runs} runs exceed the limit, down to an intensity of {}: a fragility cannot be \
         told; go to lower intensities or take a larger limit", short(*lowest)
    )]
    AllExceed {
        /// Number of runs.
        runs: u64,
        /// Lowest intensity among them.
        lowest: f64,
    },
    /// Exceedances and the rest do not overlap in intensity: the most likely curve is a step.
    #[error(
        "the runs that exceed the limit and those that do not are separated: none exceeds it below \
         {}, all do above {}; the most likely fragility is a step without dispersion: add \
         intensities between, or records", short(*below), short(*above)
    )]
    Separated {
        /// Highest intensity of a run that does not exceed.
        below: f64,
        /// Lowest intensity of a run that exceeds.
        above: f64,
    },
    /// A single intensity, or a single value of a covariate.
    #[error("all runs have the one intensity {}: expected at least two", short(*level))]
    OneLevel {
        /// The intensity.
        level: f64,
    },
    /// Exceedances that become rarer as intensity grows.
    #[error(
        "the share of runs that exceed the limit does not grow with intensity: no fragility curve \
         describes that; check the measure and the limit"
    )]
    Falls,
    /// A likelihood that grows without end.
    #[error(
        "the likelihood has no maximum: the values do not scatter, or too few of them are known \
         exactly to tell all parameters"
    )]
    NoMaximum,
}

impl FitError {
    /// This error with its intensities in a unit that is so much in SI.
    #[must_use]
    pub fn with_intensities_over(self, in_si: f64) -> Self {
        match self {
            Self::NoneExceeds { runs, highest } => {
                Self::NoneExceeds { runs, highest: highest / in_si }
            }
            Self::AllExceed { runs, lowest } => Self::AllExceed { runs, lowest: lowest / in_si },
            Self::Separated { below, above } => {
                Self::Separated { below: below / in_si, above: above / in_si }
            }
            Self::OneLevel { level } => Self::OneLevel { level: level / in_si },
            other => other,
        }
    }
}

/// Bytes that are not a record: of text in the `file:line:column` form an editor can jump to, of a
/// binary file with the offset of the first offending byte.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{}{}: expected {expected}, found {found:?}", visible(source_name), place(*line, *column, *offset)
)]
pub struct RecordError {
    /// The caller's name for the text: a path, or the name of a dropped file.
    pub source_name: String,
    /// Line of the first offending character, counted from 1; 1 in a binary file.
    pub line: usize,
    /// Its column in characters, counted from 1; 1 in a binary file.
    pub column: usize,
    /// Offset of the first offending byte of a binary file, counted from 0; none in a text.
    pub offset: Option<usize>,
    /// What the format asks for here.
    pub expected: String,
    /// The offending word, cut to 40 characters.
    pub found: String,
}

/// Where a record is wrong, as it stands after the file's name.
fn place(line: usize, column: usize, offset: Option<usize>) -> String {
    match offset {
        Some(offset) => format!(", byte {offset}"),
        None => format!(":{line}:{column}"),
    }
}

/// Text that is not a quantity: what a unit's reader expected and what it found.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected}, found {found}{}", nearest_suffix(nearest.as_deref()))]
pub struct UnitError {
    /// What to write.
    pub expected: String,
    /// What was written, cut to 40 characters.
    pub found: String,
    /// The unit that was probably meant, where one is near.
    pub nearest: Option<String>,
}

/// Text that is not an intensity measure: what was expected and what was found.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected}, found {found:?}{}", nearest_suffix(nearest.as_deref()))]
pub struct MeasureError {
    /// What to write.
    pub expected: String,
    /// What was written, cut to 40 characters.
    pub found: String,
    /// The measure that was probably meant, where one is near.
    pub nearest: Option<String>,
}

/// A place in a text, which an editor can jump to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The caller's name for the text: a path, or the option that set a key; empty where the value
    /// was not in a text, and its key says all.
    pub source_name: String,
    /// Line of its first character, counted from 1.
    pub line: usize,
    /// Its column in characters, counted from 1.
    pub column: usize,
    /// Its bytes in the text; empty where something is missing.
    pub span: std::ops::Range<usize>,
}

/// Text that is not a model, in the `file:line:column` form an editor can jump to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError {
    /// The offending key or value.
    pub place: Box<Place>,
    /// The key's path, joined by dots, storeys counted from 1; empty where the text is not TOML.
    pub path: String,
    /// What was expected.
    pub expected: String,
    /// What was found, cut to 40 characters.
    pub found: String,
    /// The key, unit or word that was probably meant.
    pub nearest: Option<String>,
}

impl std::error::Error for InputError {}

impl std::fmt::Display for InputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Place { source_name, line, column, .. } = &*self.place;
        if !source_name.is_empty() {
            write!(f, "{}:{line}:{column}: ", visible(source_name))?;
        }
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        let nearest = nearest_suffix(self.nearest.as_deref());
        write!(f, "expected {}, found {}{nearest}", self.expected, self.found)
    }
}

/// A number to six significant digits, as a person writes it.
fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

fn nearest_suffix(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |nearest| format!("; nearest is \"{nearest}\""))
}

/// Most names that a message lists.
const LISTED: usize = 20;

/// Names in a message: the first twenty, and how many more there are.
///
/// ```
/// let names = (1..=23).map(|n| n.to_string());
/// assert!(slipstick_dynamics::error::listed(names).ends_with("19, 20, … (3 more)"));
/// ```
#[must_use]
pub fn listed(names: impl IntoIterator<Item = String>) -> String {
    let mut names = names.into_iter();
    let mut text = names.by_ref().take(LISTED).collect::<Vec<_>>().join(", ");
    match names.count() {
        0 => {}
        more => text.push_str(&format!(", … ({more} more)")),
    }
    text
}

/// A found text as messages show it: [`visible`], cut to 40 characters.
pub fn cut(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown = String::new();
    for (count, character) in text.chars().enumerate() {
        if count == LONGEST {
            shown.push('…');
            break;
        }
        show(character, &mut shown);
    }
    shown
}

/// A text as messages and results show it: characters that steer a terminal (control characters) and
/// those that turn the direction of writing are escaped, `\u{1b}`.
///
/// ```
/// assert_eq!(slipstick_dynamics::error::visible("a\u{1b}[2J\u{202e}b"), r"a\u{1b}[2J\u{202e}b");
/// ```
#[must_use]
pub fn visible(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    text.chars().for_each(|character| show(character, &mut shown));
    shown
}

fn show(character: char, shown: &mut String) {
    if is_hidden(character) {
        shown.extend(character.escape_default());
    } else {
        shown.push(character);
    }
}

/// Whether a character steers a terminal or turns the direction of writing, and is not seen itself.
#[must_use]
pub fn is_hidden(character: char) -> bool {
    character.is_control()
        || matches!(
            character,
            '\u{61c}'
                | '\u{200e}'
                | '\u{200f}'
                | '\u{202a}'..='\u{202e}'
                | '\u{2066}'..='\u{2069}'
        )
}

/// The known word nearest to `word`, where the two are alike: at least half of it is the same. None where
/// the word itself is known, and stands in a wrong place.
#[must_use]
pub fn similar<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    let (distance, nearest) =
        known.map(|known| (edit_distance(word, known), known)).min_by_key(|(d, _)| *d)?;
    if distance == 0 {
        return None;
    }
    let longer = word.chars().count().max(nearest.chars().count());
    (2 * distance <= longer + 1).then(|| nearest.to_owned())
}

/// Levenshtein's distance between two words, the first 64 characters of each.
pub fn edit_distance(a: &str, b: &str) -> usize {
    const LONGEST: usize = 64;
    let b: Vec<char> = b.chars().take(LONGEST).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, a_i) in a.chars().take(LONGEST).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, b_j) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(a_i != *b_j);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
