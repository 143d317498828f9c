//! Studies: one model, many records, levels and samples, one row of demands a run.
//!
//! A [`Study`] is made from a plan, the model's text and the records that the plan names. Its runs
//! have a fixed order ([`Cases`]); the row of a run depends on nothing but the plan, the model and
//! the record: not on the runs before it, the thread it runs on or the part it belongs to. No
//! history is kept.

pub(crate) mod cases;
pub(crate) mod certified;
mod columns;
mod demanded;
mod design;
pub mod engine;
pub mod kept;
pub(crate) mod notices;
mod pieces;
pub(crate) mod records;
mod rows;
pub mod summary;
mod verify;

pub use cases::{Case, CaseRun, Cases, FailedRun};
pub use certified::{Certified, RunKind, Unconfirmed, Verdict, Worst, worse};
pub(crate) use demanded::SLIDING;
pub use demanded::{Demanded, TRAVEL_USED_UP, travel_used_up};
pub use design::Design;
pub use notices::USUAL_FACTORS;
pub use records::Record;
pub use rows::Row;
pub use summary::{LevelSummary, StudySummary};

pub use crate::numerics::random::Random;

use std::sync::OnceLock;

use engine::Engine;

use crate::error::{ChoiceError, InputError, RunError, Stopped};
use crate::input::plan::{Levels, Plan, ROTATE, Records, Target, is_of_motion};
use crate::input::{Bound, FrictionBounds, MAX_RUNS, Parts, Variation};
use crate::motion::intensity::{IntensityMeasures, LevelMeasure, Measure};
use crate::motion::target::{Matched, TargetSpectrum};
use crate::notice::NoticeKind;
use crate::response::DemandShape;

/// Most models that are kept for the next record: beyond, they are made anew.
const MODELS_KEPT: u64 = 10_000;

/// A study whose runs can be computed, in any order.
///
/// # Examples
/// ```
/// use slipstick::input::plan::Plan;
/// use slipstick::study::{Study, engine::Engine};
///
/// let model = r#"
///     [block]
///     mass = "30 t"
///     [slider]
///     static_friction = 0.06
///     kinetic_friction = 0.05
///     [motion.sine]
///     frequency = "1 Hz"
///     amplitude = "0.3 g"
///     duration = "5 s"
///     dt = "0.01 s"
/// "#;
/// let plan = r#"
///     model = "machine.toml"
///     [vary]
///     "slider.radius" = { values = ["1 m", "2 m", "4 m"] }
///     [sampling]
///     method = "grid"
/// "#;
/// let plan = Plan::parse("plan.toml", plan)?;
/// let study = Study::new(&plan, "machine.toml", model, Vec::new())?;
/// let rows = study.rows(0..study.runs(), &Engine::unwatched())?;
/// assert_eq!(rows.iter().map(|row| row.values[0]).collect::<Vec<_>>(), [1.0, 2.0, 4.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Study {
    design: Design,
    variation: Variation,
    records: Vec<Record>,
    /// For each record the first one whose demands it shares: of its pair, or of its earthquake and station.
    clusters: Vec<usize>,
    levels: Levels,
    /// Factors of each record's levels, record by record.
    factors: Vec<f64>,
    /// Where every design has a scale of its own.
    of_designs: Option<OfDesigns>,
    cases: Cases,
    /// Bounds of friction that every sample is run with; the nominal one where the model has none.
    bounds: Vec<Bound>,
    /// How pairs were brought to a target spectrum.
    matched: Option<Matched>,
    shape: DemandShape,
    /// Whether the table moves in two horizontal directions.
    in_plane: bool,
    /// Which of the varied paths turns the pairs of records.
    turned: Option<usize>,
    samples: OnceLock<Vec<Sample>>,
    /// What rows say of their motion.
    measures: Vec<Measure>,
    /// The standard measures of each record, unscaled.
    unscaled: Vec<OnceLock<Vec<f64>>>,
}

/// A scale of the records for each design.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignScale {
    /// Factors on every record, one a design.
    Factors(Vec<f64>),
    /// Values that a measure of every record takes, in SI, one a design.
    Levels(LevelMeasure, Vec<f64>),
}

/// What follows of a scale of each design.
#[derive(Clone, Debug)]
struct OfDesigns {
    /// Factors on each record, record by record.
    factors: Vec<f64>,
    /// Values of the measure, one a design; empty where factors were given.
    levels: Vec<f64>,
    /// The SI unit of these.
    unit: &'static str,
}

/// The values of a sample and the model that they make.
#[derive(Clone, Debug)]
struct Sample {
    values: Vec<f64>,
    parts: Result<Parts, RunError>,
    /// Frequency of the highest mode of the model; 0 without a model.
    highest_hz: f64,
    /// Kinds of what is hardly meant in it.
    suspicious: Vec<NoticeKind>,
}

impl Study {
    /// Makes a study of a plan.
    ///
    /// `model_name` is what errors call the model's text; `records` are those that the plan's
    /// patterns name, in their order. Without records the model's own made motion is used.
    ///
    /// # Errors
    /// [`InputError`] for a model that does not fit the plan, a record that cannot be scaled to the
    /// plan's levels, no motion at all, and more than 10⁸ runs.
    pub fn new(
        plan: &Plan,
        model_name: &str,
        model_text: &str,
        records: Vec<Record>,
    ) -> Result<Self, InputError> {
        match Self::followed(plan, model_name, model_text, records, None, &Engine::unwatched()) {
            Ok(study) => study,
            // Nothing stops an engine that nobody follows.
            Err(Stopped) => Err(plan.error_at("records", "a study that is not stopped", "one")),
        }
    }

    /// The same on the threads of the caller's pool; the engine is told of every record that is
    /// measured. `target` is the spectrum of the file that the plan names, where it names one.
    ///
    /// # Errors
    /// [`Stopped`], and as [`Study::new`] besides.
    pub fn followed(
        plan: &Plan,
        model_name: &str,
        model_text: &str,
        records: Vec<Record>,
        target: Option<&TargetSpectrum>,
        engine: &Engine<'_>,
    ) -> Result<Result<Self, InputError>, Stopped> {
        let unscaled = match Self::unscaled(plan, model_name, model_text, records) {
            Ok(unscaled) => unscaled,
            Err(error) => return Ok(Err(error)),
        };
        let scaled = scaled(plan, &unscaled.records, target, engine)?;
        Ok(scaled.map(|Scaled { factors, matched }| Self { factors, matched, ..unscaled }))
    }

    /// A study whose records still lack their factors.
    fn unscaled(
        plan: &Plan,
        model_name: &str,
        model_text: &str,
        records: Vec<Record>,
    ) -> Result<Self, InputError> {
        let variation = Variation::new(model_name, model_text, &plan.vary).map_err(|error| {
            // A path that the model does not take is a fault of the plan that varies it.
            let place = format!("vary.{}", error.path);
            if plan.vary.iter().any(|varied| varied.path == error.path) {
                return plan.error_at(&place, error.expected, error.found);
            }
            error
        })?;
        if variation.text("analysis.method") == Some("stepwise") {
            let expected = "the exact method, which is the only one of studies";
            return Err(variation.error_at("analysis.method", expected, "\"stepwise\""));
        }
        let records = match &plan.records {
            Some(Records { together: true, .. }) => {
                records::together(&records, |x, _| x.to_owned()).map_err(|error| {
                    let expected = "components whose samples make one motion";
                    plan.error_at("records.second", expected, error.to_string())
                })?
            }
            _ => records,
        };
        let in_plane = records::in_plane(&records);
        let turned = plan.vary.iter().position(|varied| varied.path == ROTATE);
        let turned = turned.filter(|_| !records.is_empty());
        if turned.is_some() && !in_plane {
            let expected =
                "pairs of components that move the table together, which alone are turned";
            let found = format!("\"{ROTATE}\" of records in one direction");
            return Err(plan.error_at(&format!("vary.{ROTATE}"), expected, found));
        }
        if !in_plane {
            variation.along_x_alone().map_err(|error| {
                if !records::has_pairs(&records) {
                    return error;
                }
                plan.error_at("records.pairs", together_for(&error.path), "\"separate\"")
            })?;
        }
        let variation = if in_plane { variation.in_plane() } else { variation };
        let design = Design::new(plan, &variation)?;
        let levels = match &plan.records {
            Some(records) => records.levels.clone(),
            None => Levels::Factors(vec![1.0]),
        };
        if records.is_empty() {
            if plan.records.is_some() {
                return Err(plan.error_at("records.files", "at least one record", "none"));
            }
            let is_made = |name: &&str| variation.has(&format!("motion.{name}"));
            if !["sine", "sweep", "pulse"].iter().any(is_made) {
                let expected = "a made motion in the model, or a table [records]";
                return Err(plan.error_at("records", expected, "neither"));
            }
        }
        if plan.records.is_none()
            && !records.is_empty()
            && let Some(varied) = plan.vary.iter().find(|v| is_of_motion(&v.path))
        {
            let expected = "[records] with their levels: a record is not varied by its keys";
            let place = format!("vary.{}", varied.path);
            return Err(plan.error_at(&place, expected, format!("\"{}\"", varied.path)));
        }
        let bounds = bounds(plan, &variation)?;
        let cases = Cases {
            records: records.len().max(1) as u64,
            levels: levels.len() as u64,
            samples: design.count(),
            bounds: bounds.len() as u64,
        };
        if cases.runs().is_none_or(|runs| runs > MAX_RUNS) {
            let Cases { records, levels, samples, bounds } = cases;
            let expected = format!("at most {MAX_RUNS} runs");
            let times = if bounds == 1 { String::new() } else { format!(" × {bounds} bounds") };
            let found = format!("{records} records × {levels} levels × {samples} samples{times}");
            return Err(plan.error_at("sampling.count", expected, found));
        }
        let shape = variation.shape();
        let measures = if records.is_empty() {
            // A made motion may be another in every run, and spectra cost more than the run.
            vec![Measure::Pga, Measure::Pgv, Measure::Pgd]
        } else {
            IntensityMeasures::default().columns().map(|(measure, ..)| measure).to_vec()
        };
        Ok(Self {
            design,
            variation,
            unscaled: records.iter().map(|_| OnceLock::new()).collect(),
            clusters: records::clusters(&records),
            records,
            levels,
            factors: Vec::new(),
            of_designs: None,
            cases,
            bounds,
            matched: None,
            shape,
            in_plane,
            turned,
            samples: OnceLock::new(),
            measures,
        })
    }

    /// The same study, of which each design has a scale of its own, in place of the levels of the plan.
    ///
    /// # Errors
    /// [`ChoiceError`] for as many values as there are no designs, a factor that is not finite, a level that is not
    /// above 0, and a record that cannot be scaled to the measure.
    pub fn scaled_by_design(mut self, scale: DesignScale) -> Result<Self, ChoiceError> {
        let refuse = |what: &str, expected: &str, found: String| {
            let (what, expected) = (what.to_owned(), expected.to_owned());
            ChoiceError { what, expected, found, nearest: None }
        };
        let (what, given) = match &scale {
            DesignScale::Factors(factors) => ("scale", factors),
            DesignScale::Levels(_, levels) => ("levels", levels),
        };
        let designs = self.cases.samples as usize;
        if given.len() != designs {
            let expected = format!("{designs} values, as many as designs");
            return Err(refuse(what, &expected, given.len().to_string()));
        }
        let records = self.records.len().max(1);
        let of_designs = match scale {
            DesignScale::Factors(factors) => {
                if let Some((row, factor)) = not(&factors, |factor| factor.is_finite()) {
                    return Err(refuse(
                        "scale",
                        "finite factors",
                        format!("{factor} in row {row}"),
                    ));
                }
                OfDesigns { factors: factors.repeat(records), levels: Vec::new(), unit: "" }
            }
            DesignScale::Levels(measure, levels) => {
                if self.records.is_empty() {
                    let expected = "records beside them, for a made motion has its own amplitude";
                    return Err(refuse("levels", expected, "none".to_owned()));
                }
                if let Some((row, level)) = not(&levels, |level| level.is_finite() && level > 0.0) {
                    return Err(refuse("scale-to", "levels > 0", format!("{level} in row {row}")));
                }
                let mut factors = Vec::with_capacity(records * designs);
                for record in &self.records {
                    let unscaled = records::measured(std::slice::from_ref(record), &measure);
                    let unscaled = unscaled.map_err(|found| {
                        let expected = format!("records that can be scaled to {measure}");
                        refuse("measure", &expected, found)
                    })?;
                    factors.extend(levels.iter().map(|level| level / unscaled));
                }
                OfDesigns { factors, levels, unit: measure.unit() }
            }
        };
        self.of_designs = Some(of_designs);
        Ok(self)
    }

    /// Numbers of records, levels, samples and bounds of friction.
    #[must_use]
    pub fn cases(&self) -> Cases {
        self.cases
    }

    /// Number of runs.
    #[must_use]
    pub fn runs(&self) -> u64 {
        self.cases.runs().unwrap_or(0)
    }

    /// The samples.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// The records; none where the model's made motion is used.
    #[must_use]
    pub fn records(&self) -> &[Record] {
        &self.records
    }

    /// Whether the table moves in two horizontal directions.
    #[must_use]
    pub fn is_in_plane(&self) -> bool {
        self.in_plane
    }

    /// Whether records are pairs of horizontal components, each run by itself.
    #[must_use]
    pub fn has_pairs(&self) -> bool {
        records::has_pairs(&self.records)
    }

    /// Whether some records are not independent: components of a pair, or records whose files say that they are
    /// of one earthquake and station.
    #[must_use]
    pub fn has_clusters(&self) -> bool {
        self.clusters.iter().enumerate().any(|(record, first)| record != *first)
    }

    /// The name of those that a record is one of, that of the first; empty where it is alone.
    #[must_use]
    pub fn cluster_name(&self, record: usize) -> &str {
        let first = self.clusters.get(record).copied();
        let alone = self.clusters.iter().filter(|other| Some(**other) == first).count() <= 1;
        let name = first.and_then(|first| self.records.get(first)).filter(|_| !alone);
        name.map_or("", |record| &record.name)
    }

    /// How pairs were brought to a target spectrum, where the plan asks for it.
    #[must_use]
    pub fn matched(&self) -> Option<&Matched> {
        self.matched.as_ref()
    }

    /// How the records are scaled.
    #[must_use]
    pub fn levels(&self) -> &Levels {
        &self.levels
    }

    /// What the structure has that demands are asked of.
    #[must_use]
    pub fn shape(&self) -> DemandShape {
        self.shape
    }

    /// The value of the measure at a level, in SI; `None` where levels are factors.
    #[must_use]
    pub fn level(&self, level: usize) -> Option<f64> {
        match &self.levels {
            Levels::Factors(_) => None,
            Levels::Measure { levels, .. } => levels.get(level).copied(),
        }
    }

    /// The factor of a level that is one; NaN where levels are values of a measure.
    #[must_use]
    pub fn level_factor(&self, level: usize) -> f64 {
        match &self.levels {
            Levels::Factors(factors) => factors.get(level).copied().unwrap_or(f64::NAN),
            Levels::Measure { .. } => f64::NAN,
        }
    }

    /// The value of the measure of a case, in SI; NaN where its motion has a factor.
    #[must_use]
    pub(crate) fn level_of(&self, case: &Case) -> f64 {
        let level = match &self.of_designs {
            Some(of) => of.levels.get(case.design).copied(),
            None => self.level(case.level),
        };
        level.unwrap_or(f64::NAN)
    }

    /// The SI unit of the measure that levels are values of; empty where they are factors.
    #[must_use]
    pub fn level_unit(&self) -> &'static str {
        if let Some(of) = &self.of_designs {
            return of.unit;
        }
        match &self.levels {
            Levels::Factors(_) => "",
            Levels::Measure { measure, .. } => measure.unit(),
        }
    }

    /// Whether the model has bounds of friction: then rows say which one is theirs.
    #[must_use]
    pub fn has_bounds(&self) -> bool {
        self.variation.has("slider.bounds")
    }

    /// The bounds of friction that every sample is run with; the nominal one where the model has none.
    #[must_use]
    pub fn bounds(&self) -> &[Bound] {
        &self.bounds
    }

    /// The bound of friction of a case.
    #[must_use]
    pub fn bound(&self, case: &Case) -> Bound {
        self.bounds.get(case.bound).copied().unwrap_or(Bound::NOMINAL)
    }

    /// The model's made motion: `sine`, `sweep` or `pulse`; empty where it has none.
    #[must_use]
    pub fn made_motion(&self) -> &'static str {
        let is_made = |name: &&str| self.variation.has(&format!("motion.{name}"));
        ["sine", "sweep", "pulse"].into_iter().find(is_made).unwrap_or("")
    }

    /// The case of a run.
    #[must_use]
    pub fn case(&self, run: u64) -> Case {
        let case = self.cases.case(run, &self.factors);
        let Some(of) = &self.of_designs else { return case };
        let place = case.record * self.cases.samples as usize + case.design;
        Case { scale: of.factors.get(place).copied().unwrap_or(1.0), ..case }
    }

    /// The angle by which a sample turns a pair of records, x towards y; `None` where it is not varied.
    fn turned_rad(&self, values: &[f64]) -> Option<f64> {
        self.turned.map(|path| values[path])
    }

    /// The values of a run's sample as `--set` takes them, `PATH=VALUE`.
    ///
    /// # Errors
    /// None: the paths are known.
    pub fn overrides(&self, case: &Case) -> Result<Vec<String>, InputError> {
        let overrides = self.variation.overrides(&self.design.values(case.design as u64))?;
        Ok(overrides.into_iter().map(|set| set.text().to_owned()).collect())
    }

    /// The model of an index below [`Cases::models`].
    fn sample(&self, index: u64) -> Sample {
        let case = self.case(index);
        let values = self.design.values(case.design as u64);
        let parts = self.variation.parts(&values).map_err(RunError::from);
        let bound = self.bound(&case);
        let parts = parts.map(|parts| Parts { model: bound.of(&parts.model), ..parts });
        let highest_hz = parts.as_ref().map_or(0.0, |parts| notices::highest_hz(&parts.model));
        let of_model = |parts: &Parts| notices::suspicious(&parts.model);
        let suspicious = parts.as_ref().map_or_else(|_| Vec::new(), of_model);
        let suspicious = suspicious.into_iter().map(|warning| warning.kind).collect();
        Sample { values, parts, highest_hz, suspicious }
    }

    /// The models in a range: from the store, where they are few enough to be kept.
    fn samples(
        &self,
        range: std::ops::Range<u64>,
        engine: &Engine<'_>,
    ) -> Result<std::borrow::Cow<'_, [Sample]>, Stopped> {
        let made = |range: std::ops::Range<u64>| -> Result<Vec<Sample>, Stopped> {
            let chunks: Vec<_> = chunks(range, CHUNK).collect();
            let of_chunk = |i: usize| -> Result<Vec<Sample>, Stopped> {
                Ok(chunks[i].clone().map(|index| self.sample(index)).collect())
            };
            Ok(engine.map(chunks.len(), of_chunk)?.into_iter().flatten().collect())
        };
        if self.cases.models() > MODELS_KEPT {
            return Ok(made(range)?.into());
        }
        let kept = match self.samples.get() {
            Some(kept) => kept,
            None => {
                let all = made(0..self.cases.models())?;
                self.samples.get_or_init(|| all)
            }
        };
        Ok(kept.get(range.start as usize..range.end as usize).unwrap_or_default().into())
    }

    /// Whether a run is drawn to be run again alone and judged: one of every thousand of the whole study,
    /// wherever it stands among them, and at least one.
    #[must_use]
    pub fn is_drawn(&self, run: u64) -> bool {
        certified::is_drawn(run, self.runs())
    }

    /// Those of some rows, in their order, that are run again alone and judged: the rows that are drawn, the first
    /// of each kind of run, and all where they are few.
    #[must_use]
    pub fn to_certify<'r>(&self, rows: &'r [Row]) -> Vec<&'r Row> {
        let kinds: Vec<_> = rows.iter().map(Row::kind_of_answer).collect();
        let chosen = certified::chosen(&kinds, |place| self.is_drawn(rows[place].run));
        chosen.into_iter().map(|place| &rows[place]).collect()
    }

    /// What rows say of their motion, in the order of [`Row::measures`].
    #[must_use]
    pub fn measures(&self) -> &[Measure] {
        &self.measures
    }
}

/// What is expected of pairs under a model with a key of two directions.
pub(crate) fn together_for(key: &str) -> String {
    format!("together, for {key} is of motions in two directions")
}

/// The first of some numbers that does not fit, with its row from 0.
fn not(numbers: &[f64], fits: impl Fn(f64) -> bool) -> Option<(usize, f64)> {
    numbers.iter().copied().enumerate().find(|(_, number)| !fits(*number))
}

/// Models that are worth handing to a thread to be made.
const CHUNK: u64 = 32;

/// A range in pieces of a length.
fn chunks(range: std::ops::Range<u64>, length: u64) -> impl Iterator<Item = std::ops::Range<u64>> {
    let end = range.end;
    range.step_by(length as usize).map(move |start| start..(start + length).min(end))
}

/// The bounds of friction that a plan runs.
fn bounds(plan: &Plan, variation: &Variation) -> Result<Vec<Bound>, InputError> {
    let Ok(bounds) = FrictionBounds::chosen(variation.friction_bounds()?, plan.bound) else {
        let expected = "slider.bounds in the model, whose bounds are run";
        let name = plan.bound.unwrap_or_default();
        return Err(plan.error_at("bounds", expected, format!("\"{name}\" without them")));
    };
    Ok(if bounds.is_empty() { vec![Bound::NOMINAL] } else { bounds })
}

/// Factors of each record's levels, record by record, and how pairs were brought to a spectrum.
struct Scaled {
    factors: Vec<f64>,
    matched: Option<Matched>,
}

/// The factor of each record at each level.
fn scaled(
    plan: &Plan,
    records: &[Record],
    target: Option<&TargetSpectrum>,
    engine: &Engine<'_>,
) -> Result<Result<Scaled, InputError>, Stopped> {
    let groups = records::groups(records);
    let mut matched = None;
    let mut of_groups = vec![1.0; groups.len()];
    if let Some((named, range_s)) = plan.records.as_ref().and_then(|records| records.target.clone())
    {
        let target = match (&named, target) {
            (Target::Shape(shape), _) => shape,
            (Target::File(_), Some(read)) => read,
            (Target::File(path), None) => {
                let found = format!("\"{path}\" unread");
                return Ok(Err(plan.error_at("records.target", "a spectrum of the file", found)));
            }
        };
        match records::matched(&groups, target, range_s, (engine, true))? {
            Ok(found) => {
                of_groups.clone_from(&found.factors);
                matched = Some(found);
            }
            Err(error) => {
                let expected = "pairs that can be brought to the spectrum over these periods";
                return Ok(Err(plan.error_at("records.periods", expected, error.to_string())));
            }
        }
    }
    let levels = match &plan.records {
        Some(records) => &records.levels,
        None => &Levels::Factors(vec![1.0]),
    };
    let of_group = |i: usize| -> Result<Vec<f64>, InputError> {
        let (measure, levels) = match levels {
            Levels::Factors(factors) => {
                return Ok(factors.iter().map(|factor| factor * of_groups[i]).collect());
            }
            Levels::Measure { measure, levels } => (measure, levels),
        };
        let unscaled = records::measured(groups[i], measure).map_err(|found| {
            let expected = format!("records that can be scaled to {measure}");
            plan.error_at("records.measure", expected, found)
        })?;
        Ok(levels.iter().map(|level| level / unscaled).collect())
    };
    let all = match matched {
        // Spectra took the time already.
        Some(_) => engine.map(groups.len(), |i| Ok(of_group(i)))?,
        None => engine.runs(groups.len(), of_group)?,
    };
    let mut factors = Vec::with_capacity(records.len() * levels.len());
    for (of_group, group) in all.into_iter().zip(&groups) {
        match of_group {
            Ok(of_group) => group.iter().for_each(|_| factors.extend(&of_group)),
            Err(error) => return Ok(Err(error)),
        }
    }
    Ok(Ok(Scaled { factors, matched }))
}
