//! Studies: one model, many records, levels and samples, one row of demands a run.
//!
//! A [`Study`] is made from a plan, the model's text and the records that the plan names. Its runs
//! have a fixed order ([`Cases`]); the row of a run depends on nothing but the plan, the model and
//! the record: not on the runs before it, the thread it runs on or the part it belongs to. No
//! history is kept.

mod cases;
mod columns;
mod design;
pub mod engine;
pub(crate) mod notices;
mod rows;
pub mod summary;
mod verify;

pub use cases::{Case, Cases};
pub use design::Design;
pub use rows::Row;
pub use summary::{LevelSummary, StudySummary};
pub use verify::Verdict;

use std::sync::OnceLock;

use engine::Engine;

use crate::error::{InputError, RunError, Stopped};
use crate::input::plan::{Levels, Plan};
use crate::input::{MAX_RUNS, Parts, Variation};
use crate::motion::GroundMotion;
use crate::motion::intensity::{IntensityMeasures, Measure};
use crate::numerics::random::{GOLDEN, mix};
use crate::response::DemandShape;

/// Most samples whose models are kept for the next record: beyond, they are made anew.
const MODELS_KEPT: u64 = 10_000;

/// A recorded motion of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// What rows call it: the path as the plan names it.
    pub name: String,
    /// The channel that was used.
    pub channel: String,
    /// The motion as it was recorded, unscaled, with its vertical component.
    pub motion: GroundMotion,
    /// Kinds of what reading it gave notice of.
    pub warnings: Vec<&'static str>,
}

/// A study whose runs can be computed, in any order.
#[derive(Debug)]
pub struct Study {
    design: Design,
    variation: Variation,
    records: Vec<Record>,
    levels: Levels,
    /// Factors of each record's levels, record by record.
    factors: Vec<f64>,
    cases: Cases,
    shape: DemandShape,
    /// Number of demands.
    demands: usize,
    samples: OnceLock<Vec<Sample>>,
    /// What rows say of their motion.
    measures: Vec<Measure>,
    /// The standard measures of each record, unscaled.
    unscaled: Vec<OnceLock<Vec<f64>>>,
}

/// The values of a sample and the model that they make.
#[derive(Clone, Debug)]
struct Sample {
    values: Vec<f64>,
    parts: Result<Parts, RunError>,
    /// Frequency of the highest mode of the model; 0 without a model.
    highest_hz: f64,
    /// Kinds of what is hardly meant in it.
    suspicious: Vec<&'static str>,
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
            && let Some(varied) = plan.vary.iter().find(|v| v.path.starts_with("motion."))
        {
            let expected = "[records] with their levels: a record is not varied by its keys";
            let place = format!("vary.{}", varied.path);
            return Err(plan.error_at(&place, expected, format!("\"{}\"", varied.path)));
        }
        let cases = Cases {
            records: records.len().max(1) as u64,
            levels: levels.len() as u64,
            samples: design.count(),
        };
        if cases.runs().is_none_or(|runs| runs > MAX_RUNS) {
            let Cases { records, levels, samples } = cases;
            let expected = format!("at most {MAX_RUNS} runs");
            let found = format!("{records} records × {levels} levels × {samples} samples");
            return Err(plan.error_at("sampling.count", expected, found));
        }
        let factors = factors(plan, &levels, &records)?;
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
            records,
            levels,
            factors,
            cases,
            shape,
            demands: shape.columns().len(),
            samples: OnceLock::new(),
            measures,
        })
    }

    /// Numbers of records, levels and samples.
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
    pub fn level(&self, level: u64) -> Option<f64> {
        match &self.levels {
            Levels::Factors(_) => None,
            Levels::Measure { levels, .. } => levels.get(level as usize).copied(),
        }
    }

    /// The factor of a level that is one; NaN where levels are values of a measure.
    #[must_use]
    pub fn level_factor(&self, level: u64) -> f64 {
        match &self.levels {
            Levels::Factors(factors) => factors.get(level as usize).copied().unwrap_or(f64::NAN),
            Levels::Measure { .. } => f64::NAN,
        }
    }

    /// The SI unit of the measure that levels are values of; empty where they are factors.
    #[must_use]
    pub fn level_unit(&self) -> &'static str {
        match &self.levels {
            Levels::Factors(_) => "",
            Levels::Measure { measure, .. } => measure.unit(),
        }
    }

    /// Whether the model has bounds of friction, which a study does not run.
    #[must_use]
    pub fn has_bounds(&self) -> bool {
        self.variation.has("slider.bounds")
    }

    /// The model's made motion: `sine`, `sweep` or `pulse`; empty where it has none.
    #[must_use]
    pub fn made_motion(&self) -> &'static str {
        let is_made = |name: &&str| self.variation.has(&format!("motion.{name}"));
        ["sine", "sweep", "pulse"].into_iter().find(is_made).unwrap_or("")
    }

    /// The factor on the record of a case.
    #[must_use]
    pub fn factor(&self, case: Case) -> f64 {
        let index = (case.record * self.cases.levels + case.level) as usize;
        self.factors.get(index).copied().unwrap_or(1.0)
    }

    /// The values of a run's sample as `--set` takes them, `PATH=VALUE`.
    ///
    /// # Errors
    /// None: the paths are known.
    pub fn overrides(&self, case: Case) -> Result<Vec<String>, InputError> {
        let overrides = self.variation.overrides(&self.design.values(case.sample))?;
        Ok(overrides.into_iter().map(|set| set.text().to_owned()).collect())
    }

    fn sample(&self, index: u64) -> Sample {
        let values = self.design.values(index);
        let parts = self.variation.parts(&values).map_err(RunError::from);
        let highest_hz = parts.as_ref().map_or(0.0, |parts| notices::highest_hz(&parts.model));
        let of_model = |parts: &Parts| notices::suspicious(&parts.model);
        let suspicious = parts.as_ref().map_or_else(|_| Vec::new(), of_model);
        let suspicious = suspicious.into_iter().map(|warning| warning.kind).collect();
        Sample { values, parts, highest_hz, suspicious }
    }

    /// The samples in a range: from the store, where they are few enough to be kept.
    fn samples(
        &self,
        range: std::ops::Range<u64>,
        engine: &Engine<'_>,
    ) -> Result<std::borrow::Cow<'_, [Sample]>, Stopped> {
        let made = |range: std::ops::Range<u64>| -> Result<Vec<Sample>, Stopped> {
            let chunks: Vec<_> = chunks(range).collect();
            let of_chunk = |i: usize| -> Result<Vec<Sample>, Stopped> {
                Ok(chunks[i].clone().map(|index| self.sample(index)).collect())
            };
            Ok(engine.map(chunks.len(), of_chunk)?.into_iter().flatten().collect())
        };
        if self.cases.samples > MODELS_KEPT {
            return Ok(made(range)?.into());
        }
        let kept = match self.samples.get() {
            Some(kept) => kept,
            None => {
                let all = made(0..self.cases.samples)?;
                self.samples.get_or_init(|| all)
            }
        };
        Ok(kept.get(range.start as usize..range.end as usize).unwrap_or_default().into())
    }

    /// Whether a run is one of those that are run again alone and judged: one of every thousand of
    /// the whole study, wherever it stands among them, and at least one.
    #[must_use]
    pub fn is_checked(&self, run: u64) -> bool {
        const EVERY: u64 = 1000;
        let first = run - run % EVERY;
        let length = EVERY.min(self.runs().saturating_sub(first)).max(1);
        run == first + mix(mix(first.wrapping_add(GOLDEN))) % length
    }

    /// What rows say of their motion, in the order of [`Row::measures`].
    #[must_use]
    pub fn measures(&self) -> &[Measure] {
        &self.measures
    }
}

/// A range in pieces that are worth handing to a thread.
fn chunks(range: std::ops::Range<u64>) -> impl Iterator<Item = std::ops::Range<u64>> {
    const LENGTH: u64 = 32;
    let end = range.end;
    range.step_by(LENGTH as usize).map(move |start| start..(start + LENGTH).min(end))
}

/// The factor of each record at each level.
fn factors(plan: &Plan, levels: &Levels, records: &[Record]) -> Result<Vec<f64>, InputError> {
    let of_record = |record: &Record| -> Result<Vec<f64>, InputError> {
        let (measure, levels) = match levels {
            Levels::Factors(factors) => return Ok(factors.clone()),
            Levels::Measure { measure, levels } => (measure, levels),
        };
        let unscaled = measure.of(&record.motion);
        if !(unscaled.is_finite() && unscaled > 0.0) {
            let expected = format!("records that can be scaled to {measure}");
            let found = format!("{measure} = {unscaled} of {}", record.name);
            return Err(plan.error_at("records.measure", expected, found));
        }
        Ok(levels.iter().map(|level| level / unscaled).collect())
    };
    // Nothing stops an engine that nobody follows.
    let all = Engine::unwatched().map(records.len(), |i| Ok(of_record(&records[i])));
    let mut factors = Vec::with_capacity(records.len() * levels.len());
    for of_record in all.unwrap_or_default() {
        factors.extend(of_record?);
    }
    Ok(factors)
}
