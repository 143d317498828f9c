//! What a code makes of a model and its runs, row by row: values, forces over the height, requirements.

use super::quantities::{At, Found, Judged, Quantities};
use super::rules::{Asked, Code, CodeUnit, Rule};
use crate::assessment::floors::place_name;
use crate::input::{Bound, Names};

/// What a code makes of a model at one intensity.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// Title of the code.
    pub title: String,
    /// Its edition and chapter.
    pub edition: String,
    /// How its rules were written down.
    pub note: String,
    /// Names of the bounds of friction.
    pub bounds: Vec<&'static str>,
    /// How many directions are told apart: 1, or 2 for x and y.
    pub directions: usize,
    /// Its quantities in their order.
    pub values: Vec<FoundValue>,
    /// Forces over the height.
    pub forces: Vec<LevelForces>,
    /// Its requirements in their order.
    pub rules: Vec<JudgedRule>,
}

/// A quantity of a code.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundValue {
    /// Its name in formulas: `D_TM`.
    pub name: String,
    /// What it is.
    pub words: String,
    /// Where it stands.
    pub clause: String,
    /// How it is shown.
    pub unit: CodeUnit,
    /// Its formula.
    pub formula: String,
    /// Bound by bound, direction by direction: its value in SI, or why there is none.
    pub found: Vec<Result<f64, String>>,
}

/// Forces at the levels of a structure.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelForces {
    /// What they are.
    pub words: String,
    /// Where they stand.
    pub clause: String,
    /// The formula at the base level, and at a level above it.
    pub formulas: [String; 2],
    /// The base level, then those above it: names.
    pub levels: Vec<String>,
    /// Weight of each level above the base in N, and its height above that in m.
    pub weights_and_heights: Vec<[f64; 2]>,
    /// Bound by bound, direction by direction: the force at each level in N; or why there is none.
    pub found: Vec<Result<Vec<f64>, String>>,
}

/// A requirement of a code.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedRule {
    /// What is required.
    pub requirement: String,
    /// Where it stands.
    pub clause: String,
    /// What may be used where it holds; none where the design must hold it.
    pub condition: Option<String>,
    /// Whether it is of the analysis, not of the structure: then it governs nothing.
    pub formal: bool,
    /// How demand and capacity are shown.
    pub unit: CodeUnit,
    /// The formulas of demand and capacity; none where nothing is compared.
    pub formulas: Option<[String; 2]>,
    /// What came of it, or why it is not judged.
    pub found: Result<Compared, String>,
}

impl JudgedRule {
    /// Its place among those that hold, do not, and are not judged.
    fn place(&self) -> usize {
        match &self.found {
            Ok(compared) if compared.ok => 0,
            Ok(_) => 1,
            Err(_) => 2,
        }
    }
}

/// A demand beside its capacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// Demand in SI.
    pub demand: f64,
    /// Capacity in SI.
    pub capacity: f64,
    /// Demand over capacity; infinite over none.
    pub ratio: f64,
    /// Whether the demand does not exceed the capacity.
    pub ok: bool,
    /// Of which bound and direction the row is.
    pub side: Side,
}

/// The bound and the direction by which a row is governed, where others give another ratio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Side {
    /// Name of the bound of friction.
    pub bound: Option<&'static str>,
    /// `x` or `y`.
    pub direction: Option<&'static str>,
}

/// Part of a capacity by which rounding may bring a demand above it that is meant to be equal, as a share that was reached
/// by scaling to it.
const ROUNDED: f64 = 1e-12;

/// Judges a model and its runs by a code.
#[must_use]
pub fn judge(code: &Code, of: Judged<'_>) -> Judgement {
    let quantities = Quantities::new(code, of);
    let cases: Vec<At> = quantities.cases().collect();
    let values = code.values.iter().map(|value| FoundValue {
        name: value.name.clone(),
        words: value.words.clone(),
        clause: value.clause.clone(),
        unit: value.unit,
        formula: value.written.clone(),
        found: cases.iter().map(|at| finite(quantities.value(&value.formula, *at))).collect(),
    });
    let structure = of.analysis.model.structure().is_some() || of.analysis.model.storeys() > 0;
    let refused = code.rigid.as_ref().filter(|_| structure);
    // An intensity of another name than those that the code knows is of all its rules.
    let hazard = of.hazard.filter(|name| code.hazards.iter().any(|at| at == name));
    // A further intensity adds what is asked at it alone.
    let asked_here = |rule: &&Rule| match hazard {
        Some(name) if of.further => rule.at.iter().any(|at| at == name),
        _ => true,
    };
    // A code judges the bounds; friction as it stands is one where there are no others.
    let bounded: Vec<At> = match quantities.bounds().len() {
        1 => cases.clone(),
        _ => {
            let nominal = |at: &&At| quantities.bounds()[at.bound] != Bound::NOMINAL;
            cases.iter().filter(nominal).copied().collect()
        }
    };
    let rules = code.rules.iter().filter(asked_here).map(|rule| {
        let found = match refused {
            Some(why) => Err(why.clone()),
            None => judged(rule, &quantities, &bounded, hazard),
        };
        let formulas = match &rule.asked {
            Asked::Compared { written, .. } => Some(written.clone()),
            Asked::Unjudged(_) => None,
        };
        JudgedRule {
            requirement: rule.requirement.clone(),
            clause: rule.clause.clone(),
            condition: rule.condition.clone(),
            formal: rule.formal,
            unit: rule.unit,
            formulas,
            found,
        }
    });
    Judgement {
        title: code.title.clone(),
        edition: code.edition.clone(),
        note: code.note.clone(),
        bounds: quantities.bounds().iter().map(|bound| bound.name).collect(),
        directions: quantities.directions(),
        values: values.collect(),
        forces: forces(code, &quantities, &cases, &of.histories.names),
        rules: rules.collect(),
    }
}

/// A value that is one.
fn finite(found: Found) -> Found {
    found.and_then(|value| match value.is_finite() {
        true => Ok(value),
        false => Err("it is beyond all numbers".to_owned()),
    })
}

/// The worst of all bounds and directions; or why nothing is judged.
fn judged(
    rule: &Rule,
    quantities: &Quantities<'_>,
    cases: &[At],
    hazard: Option<&str>,
) -> Result<Compared, String> {
    let other = hazard.filter(|name| !rule.at.is_empty() && !rule.at.iter().any(|at| at == name));
    if let Some(name) = other {
        return Err(format!("it is asked at {}, this is {name}", rule.at.join(" and ")));
    }
    let (formulas, envelope) = match &rule.asked {
        Asked::Unjudged(why) => return Err(why.clone()),
        Asked::Compared { formulas, envelope, .. } => (formulas, *envelope),
    };
    let of = |formula| {
        let each = cases.iter().map(|at| finite(quantities.value(formula, *at)));
        each.collect::<Result<Vec<f64>, String>>()
    };
    let (demands, mut capacities) = (of(&formulas[0])?, of(&formulas[1])?);
    if envelope {
        let largest = capacities.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        capacities.fill(largest);
    }
    let ratios = demands.iter().zip(&capacities).map(|(demand, capacity)| match *demand {
        0.0 => 0.0,
        demand if *capacity == 0.0 => demand.signum() * f64::INFINITY,
        demand => demand / capacity,
    });
    let ratios: Vec<f64> = ratios.collect();
    let worst = (0..cases.len()).reduce(|a, b| if ratios[b] > ratios[a] { b } else { a });
    let Some(worst) = worst else { return Err("there are no runs".to_owned()) };
    let at = cases[worst];
    let differs = |alike: &dyn Fn(&At) -> bool| {
        let others = cases.iter().zip(&ratios).filter(|(other, _)| alike(other));
        others.into_iter().any(|(_, ratio)| *ratio != ratios[worst])
    };
    let by_bound = differs(&|other: &At| other.direction == at.direction);
    let by_direction = differs(&|other: &At| other.bound == at.bound);
    Ok(Compared {
        demand: demands[worst],
        capacity: capacities[worst],
        ratio: ratios[worst],
        ok: ratios[worst] <= 1.0 + ROUNDED,
        side: Side {
            bound: by_bound.then(|| quantities.bounds()[at.bound].name),
            direction: by_direction.then_some(["x", "y"][at.direction]),
        },
    })
}

fn forces(
    code: &Code,
    quantities: &Quantities<'_>,
    cases: &[At],
    names: &Names,
) -> Vec<LevelForces> {
    let weights_and_heights = quantities.levels();
    let count = weights_and_heights.len();
    if count == 0 {
        return Vec::new();
    }
    let of = code.distributions.iter().map(|of| {
        let at_levels = |at: &At| {
            let base = finite(quantities.value(&of.formulas[0], *at));
            let above = (0..count).map(|level| {
                finite(quantities.value(&of.formulas[1], At { level: Some(level), ..*at }))
            });
            core::iter::once(base).chain(above).collect::<Result<Vec<f64>, String>>()
        };
        LevelForces {
            words: of.words.clone(),
            clause: of.clause.clone(),
            formulas: of.written.clone(),
            levels: (0..=count).map(|level| place_name(names, level + 1)).collect(),
            weights_and_heights: weights_and_heights.to_vec(),
            found: cases.iter().map(at_levels).collect(),
        }
    });
    of.collect()
}

impl Judgement {
    /// What the design must hold, of what is not a condition of a procedure.
    fn required(&self) -> impl Iterator<Item = &JudgedRule> {
        self.rules.iter().filter(|rule| rule.condition.is_none())
    }

    /// The judged requirement of the structure with the largest ratio.
    #[must_use]
    pub fn governing(&self) -> Option<(&JudgedRule, &Compared)> {
        let judged = self.required().filter_map(|rule| Some((rule, rule.found.as_ref().ok()?)));
        let judged = judged.filter(|(rule, _)| !rule.formal);
        judged.reduce(|a, b| if b.1.ratio > a.1.ratio { b } else { a })
    }

    /// How many requirements hold, do not, and are not judged.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        self.required().for_each(|rule| counts[rule.place()] += 1);
        counts
    }

    /// The procedures that conditions are of, each with how many of these hold, do not, and are not judged.
    #[must_use]
    pub fn procedures(&self) -> Vec<(&str, [usize; 3])> {
        let mut all: Vec<(&str, [usize; 3])> = Vec::new();
        for rule in &self.rules {
            let Some(name) = &rule.condition else { continue };
            if all.iter().all(|(known, _)| known != name) {
                all.push((name, [0; 3]));
            }
            for (_, counts) in all.iter_mut().filter(|(known, _)| known == name) {
                counts[rule.place()] += 1;
            }
        }
        all
    }
}

/// In one line how many requirements hold, and which governs.
#[must_use]
pub fn verdict(judgement: &Judgement) -> String {
    let [hold, fail, unjudged] = judgement.counts();
    let plural = |count: usize| if count == 1 { "requirement" } else { "requirements" };
    let judged = hold + fail;
    let first = match (judged, fail) {
        (0, _) if judgement.rules.is_empty() => "no requirement of its own".to_owned(),
        (0, _) => "no requirement could be judged".to_owned(),
        (1, 0) => "the one judged requirement holds".to_owned(),
        (_, 0) => format!("all {judged} judged {} hold", plural(judged)),
        _ => format!("{fail} of {judged} judged {} FAIL", plural(judged)),
    };
    // What fails of the analysis governs nothing, and is named.
    let fails = |rule: &&JudgedRule| rule.formal && rule.found.as_ref().is_ok_and(|of| !of.ok);
    let formal = judgement
        .required()
        .filter(fails)
        .map(|rule| format!(". Fails of the analysis: {} ({})", rule.requirement, rule.clause));
    let formal: String = formal.collect();
    let governs = judgement.governing().map_or_else(String::new, |(rule, compared)| {
        let Side { bound, direction } = compared.side;
        let bound = bound.map(|bound| format!(", {bound} friction"));
        let direction = direction.map(|direction| format!(", along {direction}"));
        let side: String = bound.into_iter().chain(direction).collect();
        let of = format!("{} ({}{side})", rule.requirement, rule.clause);
        format!(". Governing, demand over capacity {:.3}: {of}", compared.ratio)
    });
    let unjudged = match unjudged {
        0 => String::new(),
        count => format!(". Not judged: {count} {}", plural(count)),
    };
    let procedures = judgement.procedures().into_iter().map(|(name, [hold, fail, unjudged])| {
        let of = hold + fail + unjudged;
        match (fail, unjudged) {
            (0, 0) => format!(". Conditions of {name}: all {of} hold"),
            (0, unjudged) => {
                format!(". Conditions of {name}: {hold} of {of} hold, {unjudged} not judged")
            }
            (fail, _) => format!(". {name} not permitted: {fail} of {of} conditions fail"),
        }
    });
    format!(
        "{}: {first}{governs}{formal}{unjudged}{}.",
        judgement.title,
        procedures.collect::<String>()
    )
}
