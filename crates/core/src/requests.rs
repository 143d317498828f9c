//! Requests: what a person asks of an analysis over a suite, as texts by name, made into an answer.
//!
//! The command, the Python package and the page only fill the fields of one table ([`Field`]) and show the
//! [`Answer`]: names, defaults and checks stand here alone. An error names the field; each door says it in
//! its own words.

mod fields;
mod kinds;
mod laboratory;
mod single;
mod suite;

pub use fields::{Field, FrontEnd, Measures, Request, Takes};
pub use kinds::{Kind, NOT_OFFERED, table};
pub use laboratory::Comparing;
pub use single::Single;
pub use suite::{code_spectrum, periods};

use crate::assessment::code::{Judgement, Plan, PropertyFactors};
use crate::assessment::derivative::{DerivativeRequest, DerivativeRun, run_derivatives};
use crate::assessment::design::{DesignRequest, DesignRun, Target, run_design};
use crate::assessment::grid::levels;
use crate::assessment::histories::Histories;
use crate::assessment::ida::{IdaLevels, IdaRequest, IdaRun, run_ida};
use crate::assessment::models::Models;
use crate::assessment::observed::{
    FitTo, FragilityGroup, FragilityRequest, FragilityRun, certified, noticed, run_fragility,
    run_fragility_by, usual_by,
};
use crate::assessment::spectrum::{SpectrumRequest, SpectrumRun, run_spectrum};
use crate::assessment::suite::{Recorded, Suite};
use crate::assessment::{AssessmentError, refuse};
use crate::error::{ChoiceError, MeasureError};
use crate::input::{Analysis, Bound, FrictionBounds, Override, dimension_of};
use crate::motion::intensity::LevelMeasure;
use crate::notice::Notice;
use crate::response::DemandColumn;
use crate::study::engine::Engine;
use crate::study::{Certified, together_for};
use crate::table::Table;
use crate::units::Dimension;

/// The demand that gaps limit.
const SLIDING: &str = "peak_sliding_displacement_m";

/// Where a hunt starts and ends where nothing else is said, over the records' median.
const HUNTED: [f64; 2] = [0.05, 20.0];

/// The model and the records that are asked of.
#[derive(Clone, Copy, Debug)]
pub struct On<'a> {
    /// What the model is called.
    pub name: &'a str,
    /// What errors call its text.
    pub source: &'a str,
    /// Its text.
    pub text: &'a str,
    /// Keys that are set in it.
    pub set: &'a [Override],
    /// What the two make.
    pub analysis: &'a Analysis,
    /// The records.
    pub suite: &'a Suite,
}

/// A table of runs that a fragility is asked of.
#[derive(Clone, Copy, Debug)]
pub struct Runs<'a> {
    /// What the answer calls it.
    pub name: &'a str,
    /// What errors call it.
    pub source: &'a str,
    /// The table.
    pub table: &'a Table,
    /// The limit that it was made for, in SI, where it is known.
    pub limit: Option<f64>,
    /// How many of its runs were certified, where its columns do not say so and its files do.
    pub certified: Option<&'a Certified>,
}

/// What came of a request, and what it is of.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Name of the model or the table.
    pub name: String,
    /// Hash of the model; none of a table.
    pub model_hash: Option<String>,
    /// The records.
    pub records: Vec<Recorded>,
    /// How they were scaled, in words.
    pub scaled: String,
    /// What reading them gave notice of.
    pub warnings: Vec<Notice>,
    /// Project, author and date, as they are given for the report.
    pub title: Vec<(&'static str, String)>,
    /// What came of it.
    pub found: Results,
}

/// What came of a request.
#[derive(Clone, Debug)]
pub enum Results {
    /// Models on the records of suites, side by side.
    Suite {
        /// What came of it.
        histories: Histories,
        /// What the intensity is called: `MCE_R`, `DE`.
        hazard: Option<String>,
        /// Property modification factors that the bounds of friction come from.
        factors: Option<PropertyFactors>,
        /// Plan of the building, for the total displacement.
        plan: Option<Plan>,
        /// What a code makes of each model, in their order; none without a code.
        judgements: Vec<Judgement>,
        /// The same models and records at further intensities.
        others: Vec<AtHazard>,
    },
    /// A sliding spectrum.
    Spectrum(SpectrumRun),
    /// Derivatives of the demands.
    Sensitivity(DerivativeRun),
    /// An incremental dynamic analysis.
    Ida {
        /// The intensity measure.
        measure: LevelMeasure,
        /// Key of the demand.
        demand: String,
        /// The limit on it, SI.
        limit: Option<f64>,
        /// Whether the levels are the same for all records; else they were hunted.
        fixed_levels: bool,
        /// What came of it.
        run: IdaRun,
    },
    /// A fragility, or one for each value of a path.
    Fragility {
        /// Key of the demand.
        demand: String,
        /// The limit on it, SI.
        limit: Option<f64>,
        /// Confidence of intervals.
        confidence: f64,
        /// How many of the runs were certified; none where the table does not say so.
        certified: Option<Certified>,
        /// The curves.
        curves: Curves,
    },
    /// A design.
    Design {
        /// What was asked.
        target: Target,
        /// Key of the acceleration.
        acceleration: String,
        /// Factors on friction of the check of robustness.
        bounds: Option<[f64; 2]>,
        /// Confidence of intervals.
        confidence: f64,
        /// What came of it.
        run: DesignRun,
    },
}

/// What came of models on their suites at an intensity besides the first.
#[derive(Clone, Debug)]
pub struct AtHazard {
    /// What the intensity is called.
    pub name: String,
    /// The factor on the first.
    pub factor: f64,
    /// What came of it.
    pub histories: Histories,
    /// What a code makes of each model, in their order; none without a code.
    pub judgements: Vec<Judgement>,
}

impl Results {
    /// How many runs were certified; none of a table that does not say so.
    #[must_use]
    pub fn certified(&self) -> Option<Certified> {
        match self {
            Self::Suite { histories, others, .. } => {
                let mut all = histories.certified();
                for AtHazard { name, histories, .. } in others {
                    let mut at = histories.certified();
                    let worst = at.worst.iter_mut().map(|worst| &mut worst.run);
                    let refused = at.unconfirmed.iter_mut().map(|refused| &mut refused.run);
                    worst.chain(refused).for_each(|run| *run = format!("{run} at {name}"));
                    all.join(at);
                }
                Some(all)
            }
            Self::Spectrum(run) => Some(run.certified.clone()),
            Self::Sensitivity(run) => Some(run.certified()),
            Self::Ida { run, .. } => Some(run.certified.clone()),
            Self::Fragility { certified, .. } => certified.clone(),
            Self::Design { run, .. } => Some(run.certified.clone()),
        }
    }
}

/// The curves of a fragility.
#[derive(Clone, Debug)]
pub enum Curves {
    /// One.
    One(Box<FragilityRun>),
    /// One for each value of a path, which has a unit.
    By {
        /// The path.
        path: String,
        /// Its SI unit.
        unit: String,
        /// A curve for each value, or why there is none.
        groups: Vec<FragilityGroup>,
    },
}

impl Request {
    /// Runs a spectrum, derivatives, an incremental dynamic analysis or a design; of a fragility, the incremental dynamic
    /// analysis is asked for by itself.
    ///
    /// # Errors
    /// [`AssessmentError`], a choice by the name of its field.
    pub fn run(&self, on: &On<'_>, engine: &Engine<'_>) -> Result<Answer, AssessmentError> {
        let together = self.together(on)?;
        let on = &together.as_ref().map_or(*on, |(analysis, suite)| On { analysis, suite, ..*on });
        if on.suite.has_pairs() && self.kind() != Kind::Ida {
            let expected = "pairs that are run together: each component by itself, only ida and response \
                            histories know which of them belong together";
            return Err(refuse("pairs", expected, self.one("pairs")));
        }
        let (found, scaled) = match self.kind() {
            Kind::Spectrum => self.spectrum(on, engine)?,
            Kind::Sensitivity => self.derivatives(on, engine)?,
            Kind::Ida => (self.ida(on, engine)?, String::new()),
            Kind::Design => self.design(on, engine)?,
            kind => {
                let expected = "an analysis over a suite: spectrum, sensitivity, ida or design";
                return Err(refuse("kind", expected, kind.name()));
            }
        };
        Ok(Answer {
            name: on.name.to_owned(),
            model_hash: Some(on.analysis.hash()),
            records: on.suite.recorded(),
            scaled: if on.suite.made { String::new() } else { scaled },
            warnings: on.suite.noticed(),
            title: Vec::new(),
            found,
        })
    }

    /// The suite whose pairs move the table in two horizontal directions and the model under them, or where they
    /// are asked for separately that of their components; none where that is the suite as it is.
    pub(super) fn together(
        &self,
        on: &On<'_>,
    ) -> Result<Option<(Analysis, Suite)>, AssessmentError> {
        let separate = self.one("pairs") == "separate";
        if separate || !(on.suite.has_pairs() || on.suite.in_plane()) {
            if let Err(error) = on.analysis.along_x_alone() {
                let of_pairs = on.suite.has_pairs() || on.suite.in_plane();
                return Err(if separate && of_pairs {
                    refuse("pairs", together_for(&error.path), "\"separate\"")
                } else {
                    error.into()
                });
            }
            let split = separate && on.suite.in_plane();
            return Ok(split.then(|| (on.analysis.clone(), on.suite.apart())));
        }
        let suite = on.suite.together().map_err(|error| {
            refuse("second", "components whose samples make one motion", error.to_string())
        })?;
        Ok(Some((on.analysis.in_plane()?, suite)))
    }

    /// Fits a fragility.
    ///
    /// # Errors
    /// [`AssessmentError`], a choice by the name of its field.
    pub fn fit(&self, runs: &Runs<'_>, engine: &Engine<'_>) -> Result<Answer, AssessmentError> {
        let demand = self.demand();
        let limited = |name| self.given(name).map(|text| limit(name, text, demand)).transpose();
        let keep: Vec<String> = self.all("where").map(str::to_owned).collect();
        let limit = limited("limit")?.or(runs.limit);
        let request = FragilityRequest {
            table: runs.table,
            source_name: runs.source,
            demand,
            limit,
            measure: self.given("measure"),
            units: self.given("units"),
            fit_to: self.given("fit-to").map(|name| match name {
                "counts" => FitTo::Counts,
                "capacities" => FitTo::Capacities,
                _ => FitTo::Cloud,
            }),
            floor: limited("floor")?,
            cap: limited("cap")?,
            keep: &keep,
            bootstrap: match self.given("bootstrap") {
                Some(_) => Some((self.count("bootstrap", 50, 100_000)? as u32, self.seed()?)),
                None => None,
            },
        };
        let confidence = self.share("confidence")?;
        let by = match self.given("by") {
            Some(by) => Some(by),
            None => usual_by(&request)?,
        };
        let curves = match by {
            None => Curves::One(Box::new(run_fragility(&request, engine)?)),
            Some(by) => {
                let (groups, unit) = run_fragility_by(&request, by, engine)?;
                if groups.iter().all(|group| group.run.is_err()) {
                    let reason = groups.iter().find_map(|group| group.run.as_ref().err());
                    let reason = reason.map_or("no rows".to_owned(), ToString::to_string);
                    return Err(refuse("by", format!("a value of {by} that has a curve"), reason));
                }
                Curves::By { path: by.to_owned(), unit, groups }
            }
        };
        let demand = demand.to_owned();
        let certified = certified(&request)?.or_else(|| runs.certified.cloned());
        Ok(Answer {
            name: runs.name.to_owned(),
            model_hash: None,
            records: Vec::new(),
            scaled: String::new(),
            warnings: noticed(&request)?,
            title: Vec::new(),
            found: Results::Fragility { demand, limit, confidence, certified, curves },
        })
    }

    fn spectrum(
        &self,
        on: &On<'_>,
        engine: &Engine<'_>,
    ) -> Result<(Results, String), AssessmentError> {
        let models = self.models(on, Some(self.one("over")))?;
        let (scaling, scaled) = self.scaling(None, &[])?;
        let demands: Vec<String> = self.all("demand").map(str::to_owned).collect();
        let bounds = self.bounds(on)?;
        let suite = on.suite;
        let request = SpectrumRequest {
            models: &models,
            suite,
            scaling: &scaling,
            demands: &demands,
            bounds: &bounds,
        };
        Ok((Results::Spectrum(run_spectrum(&request, engine)?), scaled))
    }

    fn derivatives(
        &self,
        on: &On<'_>,
        engine: &Engine<'_>,
    ) -> Result<(Results, String), AssessmentError> {
        let mut varied = Vec::new();
        let mut paths = self.listed("vary");
        if paths.is_empty() {
            paths = on.analysis.built();
        }
        for path in paths {
            let unit = dimension_of(path)?.map_or("", Dimension::si_unit);
            let Some(value) = on.analysis.value(path) else {
                let found = format!("{path:?}, of which the model says nothing");
                return Err(refuse("vary", "keys that stand in the model as one number", found));
            };
            varied.push(("vary", format!("{path}={value:?} {unit}").trim_end().to_owned()));
        }
        let models = Models::new(on.source, on.text, on.set, &varied, false)?;
        let models = if on.suite.in_plane() { models.in_plane() } else { models };
        let (scaling, scaled) = self.scaling(None, &[])?;
        let demands: Vec<String> = self.listed("demand").into_iter().map(str::to_owned).collect();
        let request = DerivativeRequest {
            models: &models,
            suite: on.suite,
            scaling: &scaling,
            demands: &demands,
        };
        Ok((Results::Sensitivity(run_derivatives(&request, engine)?), scaled))
    }

    fn ida(&self, on: &On<'_>, engine: &Engine<'_>) -> Result<Results, AssessmentError> {
        let measure = self.measure()?;
        let models = self.models(on, None)?;
        let demand = self.demand();
        models.column(demand)?;
        let limit = match self.given("limit") {
            Some(text) => Some(limit("limit", text, demand)?),
            None => on.analysis.model.slider().gap_m().filter(|_| demand == SLIDING),
        };
        let levels = self.levels(on, &measure, engine)?;
        let fixed_levels = matches!(levels, IdaLevels::Fixed(_));
        if !fixed_levels && limit.is_none() {
            let expected = "a limit to hunt for, such as 150 mm (or slider.gap in the model)";
            return Err(refuse("limit", expected, "nothing"));
        }
        let keep: Vec<String> = self.all("where").map(str::to_owned).collect();
        let request = IdaRequest {
            models: &models,
            bounds: &self.bounds(on)?,
            suite: on.suite,
            measure,
            demand,
            limit,
            levels,
            keep: &keep,
            by: self.given("by"),
        };
        let run = run_ida(&request, engine)?;
        Ok(Results::Ida { measure, demand: demand.to_owned(), limit, fixed_levels, run })
    }

    fn levels(
        &self,
        on: &On<'_>,
        measure: &LevelMeasure,
        engine: &Engine<'_>,
    ) -> Result<IdaLevels, AssessmentError> {
        if let Some(text) = self.given("scale-to") {
            if self.given("between").is_some() {
                return Err(refuse("between", "a hunt, without `scale-to`", "both"));
            }
            return Ok(IdaLevels::Fixed(levels("scale-to", text, &measure.measure)?));
        }
        if let Some(text) = self.given("between") {
            return match levels("between", &format!("{text}:2"), &measure.measure)?[..] {
                [start, top] => Ok(IdaLevels::Hunt { start, top }),
                _ => Err(refuse("between", "two levels, 0.05..2 g", format!("{text:?}"))),
            };
        }
        let mut values = on.suite.measure(measure, engine)?;
        values.sort_by(f64::total_cmp);
        let median = values.get(values.len() / 2).copied().unwrap_or(f64::NAN);
        let [start, top] = HUNTED.map(|part| part * median);
        Ok(IdaLevels::Hunt { start, top })
    }

    fn design(
        &self,
        on: &On<'_>,
        engine: &Engine<'_>,
    ) -> Result<(Results, String), AssessmentError> {
        if self.given("friction").is_none() && self.given("vary").is_none() {
            let expected = "something to vary, `friction` or slider.radius=1..5m:50";
            return Err(refuse("vary", expected, "nothing"));
        }
        let models = self.models(on, None)?;
        let (scaling, scaled) = self.scaling(None, &[])?;
        let gap_m = match (self.given("gap"), on.analysis.model.slider().gap_m()) {
            (Some(text), _) => limit("gap", text, SLIDING)?,
            (None, Some(gap_m)) => gap_m,
            (None, None) => {
                let expected = "a length (or slider.gap in the model)";
                return Err(refuse("gap", expected, "nothing"));
            }
        };
        let target = Target {
            gap_m,
            probability: self
                .number("probability", "a share above 0, at most 1", |p| p > 0.0 && p <= 1.0)?,
            acceleration_share: self
                .number("share", "a share above 0, at most 1", |p| p > 0.0 && p <= 1.0)?,
        };
        let bounds = match self.given("friction-factors") {
            Some(text) => Some(factors(text)?),
            None => on.analysis.friction_bounds.map(|bounds| [bounds.lower, bounds.upper]),
        };
        let acceleration =
            self.given("demand").map_or_else(|| models.roof_acceleration(), str::to_owned);
        let confidence = self.share("confidence")?;
        let request = DesignRequest {
            models: &models,
            suite: on.suite,
            scaling: &scaling,
            target,
            acceleration: &acceleration,
            bounds,
            sensitivity: match self.given("sensitivity") {
                Some(_) => self.count("sensitivity", 0, 1 << 20)? as u32,
                // A run in two directions costs fifty in one.
                None if on.suite.in_plane() => 64,
                None => 256,
            },
            seed: self.seed()?,
            confidence,
        };
        let run = run_design(&request, engine)?;
        Ok((Results::Design { target, acceleration, bounds, confidence, run }, scaled))
    }

    /// The models of what is varied, friction first and the axis last. Only `friction` takes the static
    /// coefficient with it.
    fn models(&self, on: &On<'_>, over: Option<&str>) -> Result<Models, AssessmentError> {
        let friction = self.given("friction");
        let mut varied: Vec<(&str, String)> = Vec::new();
        let of_friction =
            friction.map(|values| ("friction", format!("slider.kinetic_friction={values}")));
        let of_paths = self.all("vary").map(|text| ("vary", text.to_owned()));
        match self.kind() {
            Kind::Spectrum => varied.extend(of_paths.chain(of_friction)),
            // Its keys have no values.
            Kind::Sensitivity => {}
            _ => varied.extend(of_friction.into_iter().chain(of_paths)),
        }
        varied.extend(over.map(|over| ("over", over.to_owned())));
        let models = Models::new(on.source, on.text, on.set, &varied, friction.is_some())?;
        Ok(if on.suite.in_plane() { models.in_plane() } else { models })
    }

    fn measure(&self) -> Result<LevelMeasure, AssessmentError> {
        Ok(LevelMeasure::parse(self.one("measure")).map_err(of_measure)?)
    }

    /// The bounds of friction to run; none for a model without them.
    fn bounds(&self, on: &On<'_>) -> Result<Vec<Bound>, AssessmentError> {
        let wanted = Some(self.one("bounds")).filter(|name| *name != "all");
        Ok(FrictionBounds::chosen(on.analysis.friction_bounds, wanted)?)
    }
}

/// A measure that is none.
fn of_measure(error: MeasureError) -> ChoiceError {
    let MeasureError { expected, found, nearest } = error;
    let (what, found) = ("measure".to_owned(), format!("{found:?}"));
    ChoiceError { what, expected, found, nearest }
}

/// Two factors on friction that rise, `0.8,1.3`.
fn factors(text: &str) -> Result<[f64; 2], AssessmentError> {
    let number =
        |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0);
    match text.split_once(',').and_then(|(a, b)| Some([number(a)?, number(b)?])) {
        Some([lower, upper]) if lower <= upper => Ok([lower, upper]),
        _ => Err(refuse(
            "friction-factors",
            "two factors that rise, such as 0.8,1.3",
            format!("{text:?}"),
        )),
    }
}

/// Endings of keys that are no demand of the registry (ratios of two demands, columns of other
/// programs' tables), with what they measure, the longer before the shorter.
const ENDINGS: [(&str, Dimension); 5] = [
    ("_m_per_s2", Dimension::Acceleration),
    ("_m_per_s", Dimension::Velocity),
    ("_m", Dimension::Length),
    ("_n", Dimension::Force),
    ("_s", Dimension::Time),
];

/// What the key of a demand, or of a column like one, measures; none of a ratio. The key without its unit.
#[must_use]
pub fn measured(key: &str) -> (Option<Dimension>, &str) {
    if let Some(column) = DemandColumn::of_name(key) {
        return (column.dimension(), key);
    }
    let found = ENDINGS.iter().find_map(|(ending, of)| Some((*of, key.strip_suffix(ending)?)));
    found.map_or((None, key), |(dimension, bare)| (Some(dimension), bare))
}

/// A limit > 0 on a demand, in SI: with the unit that its key ends in, or a bare number; `what` is what
/// errors call it.
fn limit(what: &str, text: &str, demand: &str) -> Result<f64, AssessmentError> {
    let refused = |expected: &str| refuse(what, expected, format!("{text:?}"));
    let value = match measured(demand).0 {
        Some(dimension) => fields::quantity(what, text, dimension)?,
        None => text.trim().parse().map_err(|_| refused("a number"))?,
    };
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(refused("a limit > 0")) }
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_moves_the_demands_is_derived_where_no_key_is_named() {
        let text = include_str!("../../../examples/frame-pendulum.toml");
        let analysis = crate::input::parse("model.toml", text, &[]).unwrap();
        let paths = analysis.built();
        let first =
            ["block.mass", "slider.static_friction", "slider.kinetic_friction", "slider.radius"];
        assert_eq!(paths[..4], first);
        assert!(paths.contains(&"frame.period") && paths.contains(&"storey.5.mass"), "{paths:?}");
        let beside = |path: &&str| {
            ["bounds", "height", "damping", "width"].iter().any(|part| path.contains(part))
                || path.starts_with("motion")
        };
        assert!(!paths.iter().any(beside), "{paths:?}");
        assert!(!paths.contains(&"slider.gap"));
    }
}
