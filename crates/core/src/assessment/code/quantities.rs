//! What models, hand calculations and runs offer to the formulas of a code, by name and by case.

use super::formula::{Formula, combined};
use super::rules::Code;
use super::{FrictionBounds, Plan};
use crate::assessment::histories::ModelHistories;
use crate::assessment::lateral::{LateralForce, Loop, interpolated};
use crate::input::{Analysis, Bound};
use crate::model::{Model, shear_frame_frequencies};
use crate::motion::target::{Matched, TargetSpectrum};
use crate::response::Demands;

/// What is offered: names, and what they are in SI.
pub(super) const OFFERED: &[(&str, &str)] = &[
    ("W", "weight of all that is isolated"),
    ("W_s", "weight of the structure above the base level"),
    ("g", "gravity"),
    ("storeys", "number of storeys above the base level"),
    ("height", "height of the roof above the base level"),
    ("T_fb", "first period of the structure on a fixed base, along the direction"),
    ("width", "width of the base along the direction"),
    ("w_x", "weight of a level"),
    ("h_x", "height of a level above the base level"),
    ("friction_factor", "factor on friction of the bound"),
    ("has_bounds", "1 where friction has a lower and an upper bound"),
    ("radius", "sum of the radii of the surfaces"),
    ("static_friction", "coefficient of static friction with the bound, the larger of both senses"),
    ("kinetic_friction", "coefficient of kinetic friction with the bound, the mean of both senses"),
    ("activation", "force that makes the isolators slide"),
    ("reach", "least of travel, gap to a stop and gap of the detailing"),
    ("D", "displacement of the hand calculation"),
    ("k", "effective stiffness at it"),
    ("beta", "effective damping at it"),
    ("B", "factor by which that damping divides the spectrum"),
    ("T", "effective period at it"),
    ("Sa_short", "ordinate of the spectrum at short periods"),
    ("e", "eccentricity of the plan"),
    ("y", "distance of the element of interest from the centre"),
    ("b", "shorter side of the plan"),
    ("d", "longer side of the plan"),
    ("P_T", "ratio of the translational to the torsional period"),
    ("earthquakes", "number of records or pairs"),
    ("pairs", "number of pairs that were run"),
    ("in_plane", "1 where both components act at once"),
    ("range_from", "first period over which pairs were compared with the spectrum"),
    ("range_to", "last period of that range"),
    ("spectrum_share", "least ratio of the mean of the pairs' spectra to the target"),
    ("runs_D", "sliding displacement of the runs"),
    ("runs_residual", "residual sliding displacement of the runs"),
    ("runs_V_b", "force of the isolators in the runs, along the direction"),
    ("runs_V_s", "shear of the structure at the base level in the runs, along the direction"),
    ("runs_drift", "largest ratio of drift to height of a storey in the runs"),
    ("runs_overturning", "overturning moment over W width/2 in the runs, along the direction"),
];

/// Functions, and how many arguments they take at least.
pub(super) const FUNCTIONS: &[(&str, usize)] = &[
    ("max", 2),
    ("min", 2),
    ("sqrt", 1),
    // 1 where the first is at least the second, else 0.
    ("at_least", 2),
    // Of x, then x and value row by row: linear between rows, level beyond the ends.
    ("table", 5),
    // The first that is known.
    ("else", 2),
    // The largest of those that are known.
    ("known_max", 1),
    // With a bound of friction.
    ("lower", 1),
    ("nominal", 1),
    ("upper", 1),
    // Over all bounds and directions.
    ("largest", 1),
    ("least", 1),
    // Over the levels above the base.
    ("sum", 1),
    // Of the spectrum at a period, in m/s².
    ("Sa", 1),
    // Of the isolators pushed slowly to a displacement: force, energy of a whole loop, energy stored.
    ("force", 1),
    ("dissipated", 1),
    ("stored", 1),
];

/// Of what a quantity is: a bound of friction, a direction, and a level above the base where it is of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct At {
    pub bound: usize,
    pub direction: usize,
    pub level: Option<usize>,
}

/// What is judged: a model, its runs at one intensity, and what was given besides.
#[derive(Clone, Copy, Debug)]
pub struct Judged<'a> {
    /// The model with its bounds of friction.
    pub analysis: &'a Analysis,
    /// Its runs.
    pub histories: &'a ModelHistories,
    /// The spectrum of the hand calculation.
    pub spectrum: Option<&'a TargetSpectrum>,
    /// The first and last period in s over which pairs were compared with it.
    pub range_s: Option<[f64; 2]>,
    /// How they were brought to it.
    pub matched: Option<&'a Matched>,
    /// What the intensity is called.
    pub hazard: Option<&'a str>,
    /// Whether it is a further intensity beside the first.
    pub further: bool,
    /// Plan of the building.
    pub plan: Option<&'a Plan>,
}

/// The same with what is made of it once.
pub(super) struct Quantities<'a> {
    pub code: &'a Code,
    of: Judged<'a>,
    /// With each bound.
    models: Vec<Model>,
    loops: Vec<Option<Loop>>,
    lateral: Vec<Option<LateralForce>>,
    /// Weight and height above the base of each level.
    levels: Option<Vec<[f64; 2]>>,
    periods_s: [Option<f64>; 2],
}

/// A quantity, or why there is none.
pub(super) type Found = Result<f64, String>;

fn missing<T>(why: &str) -> Result<T, String> {
    Err(why.to_owned())
}

impl<'a> Quantities<'a> {
    pub fn new(code: &'a Code, of: Judged<'a>) -> Self {
        let model = &of.analysis.model;
        let bounds = &of.histories.bounds;
        let models: Vec<Model> = bounds.iter().map(|bound| bound.of(model)).collect();
        let lateral = |model: &Model| code.lateral(model, of.spectrum?);
        let base_m = model.block().height_m.unwrap_or(0.0);
        let raised =
            |[mass_kg, height_m]: [f64; 2]| [mass_kg * model.gravity_m_per_s2(), height_m - base_m];
        let arms = model.lever_arms().filter(|arms| !arms.is_empty());
        Self {
            code,
            of,
            loops: models.iter().map(Loop::of).collect(),
            lateral: models.iter().map(lateral).collect(),
            levels: arms.map(|arms| arms.into_iter().map(raised).collect()),
            periods_s: [0, 1].map(|axis| fixed_base_s(model, axis)),
            models,
        }
    }

    /// How many directions are told apart.
    pub fn directions(&self) -> usize {
        if self.of.histories.is_in_plane() { 2 } else { 1 }
    }

    pub fn bounds(&self) -> &[Bound] {
        &self.of.histories.bounds
    }

    /// Every bound in every direction.
    pub fn cases(&self) -> impl Iterator<Item = At> + '_ {
        let directions = 0..self.directions();
        (0..self.bounds().len()).flat_map(move |bound| {
            directions.clone().map(move |direction| At { bound, direction, level: None })
        })
    }

    /// Weight in N and height above the base in m of each level above it.
    pub fn levels(&self) -> &[[f64; 2]] {
        self.levels.as_deref().unwrap_or_default()
    }

    /// The value of a formula in a case.
    pub fn value(&self, formula: &Formula, at: At) -> Found {
        match formula {
            Formula::Number(number) => Ok(*number),
            Formula::Name(name) => self.named(name, at),
            Formula::Binary(sign, of) => {
                Ok(combined(*sign, self.value(&of[0], at)?, self.value(&of[1], at)?))
            }
            Formula::Call(name, of) => self.call(name, of, at),
        }
    }

    fn named(&self, name: &str, at: At) -> Found {
        if let Some(value) = self.code.values.iter().find(|value| value.name == name) {
            return self.value(&value.formula, at);
        }
        if let Some(input) = self.code.inputs.iter().find(|input| input.name == name) {
            if let Some((_, value)) = self.code.given.iter().find(|(given, _)| given == name) {
                return Ok(*value);
            }
            let or = input.or.as_ref().and_then(|or| self.value(or, at).ok());
            return or.ok_or_else(|| {
                format!("{name} is not given among the code's values: {}", input.words)
            });
        }
        self.offered(name, at)
    }

    fn call(&self, name: &str, of: &[Formula], at: At) -> Found {
        let argument = |i: usize| match of.get(i) {
            Some(formula) => self.value(formula, at),
            None => Err(format!("{name} of nothing")),
        };
        let all = || of.iter().map(|one| self.value(one, at)).collect::<Result<Vec<f64>, _>>();
        let with = |bound: &str| {
            let place = self.bounds().iter().position(|known| known.name == bound);
            At { bound: place.unwrap_or(at.bound), ..at }
        };
        let first = of.first();
        let in_case = |at: At| first.map_or(missing("nothing"), |one| self.value(one, at));
        let over_cases = || self.cases().map(&in_case).collect::<Result<Vec<f64>, String>>();
        let loops = || {
            let why = "friction follows the sliding speed, of which a hand takes no loop";
            self.loops[at.bound].as_ref().ok_or_else(|| why.to_owned())
        };
        let weight_n = self.models[at.bound].weight_n();
        Ok(match name {
            "max" | "min" | "sqrt" | "at_least" | "table" => {
                of_numbers(name, &all()?).ok_or_else(|| format!("{name} of too little"))?
            }
            "else" => return argument(0).or_else(|_| argument(1)),
            "known_max" => {
                let known = of.iter().filter_map(|one| self.value(one, at).ok());
                return known.reduce(f64::max).map_or_else(|| argument(0), Ok);
            }
            "lower" | "nominal" | "upper" => in_case(with(name))?,
            "largest" => over_cases()?.into_iter().fold(f64::NEG_INFINITY, f64::max),
            "least" => over_cases()?.into_iter().fold(f64::INFINITY, f64::min),
            "sum" => {
                let levels = 0..self.levels().len();
                let of_level = |level| in_case(At { level: Some(level), ..at });
                levels.map(of_level).sum::<Result<f64, String>>()?
            }
            "Sa" => {
                let period_s = argument(0)?;
                let why = || format!("the spectrum has no ordinate at {period_s:.3} s");
                self.spectrum()?.at(period_s).ok_or_else(why)?
            }
            "force" => loops()?.at(argument(0)?)[0] * weight_n,
            "dissipated" => loops()?.at(argument(0)?)[1] * weight_n,
            "stored" => loops()?.stored_m(argument(0)?) * weight_n,
            _ => return Err(format!("no function {name}")),
        })
    }

    fn spectrum(&self) -> Result<&'a TargetSpectrum, String> {
        let why = "pairs were not brought to a spectrum, under which the hand calculation is";
        self.of.spectrum.ok_or_else(|| why.to_owned())
    }

    /// What is of the hand calculation.
    fn by_hand(&self, at: At, of: fn(&LateralForce) -> f64) -> Found {
        self.spectrum()?;
        let found = self.lateral[at.bound].as_ref();
        let why = "the hand calculation finds no displacement: nothing slides, the spectrum ends, or friction follows \
                   the speed";
        found.map(of).ok_or_else(|| why.to_owned())
    }

    fn level(&self, at: At, part: usize) -> Found {
        let Some(levels) = &self.levels else {
            return missing("the model gives no heights of its storeys");
        };
        let level = at.level.and_then(|level| levels.get(level));
        level.map_or(missing("a level above the base"), |level| Ok(level[part]))
    }

    fn plan(&self, of: fn(&Plan) -> f64) -> Found {
        let why = "the plan of the building is not given (eccentricity)";
        self.of.plan.map(of).ok_or_else(|| why.to_owned())
    }

    /// What governs over the suite of a demand: of the resultant, or along the direction where there are two.
    fn runs(&self, at: At, along: bool, of: impl Fn(&Demands) -> Option<f64>) -> Found {
        let axis = along.then_some(at.direction);
        let why = "the runs do not have it, or a run has no answer";
        self.of.histories.governing_along(at.bound, axis, of).ok_or_else(|| why.to_owned())
    }

    fn drift(&self, at: At) -> Found {
        let shape = self.of.histories.shape();
        let count = shape.storeys.max(shape.points);
        if count == 0 {
            return missing("the model has no storeys");
        }
        let one = |i: usize| {
            self.runs(at, false, |demands| {
                let all =
                    if demands.storeys.is_empty() { &demands.points } else { &demands.storeys };
                all.get(i)?.peak_drift_ratio
            })
        };
        let all: Result<Vec<f64>, String> = (0..count).map(one).collect();
        let largest = all.map(|all| all.into_iter().fold(0.0, f64::max));
        largest.map_err(|_| "the model gives no heights of its storeys".to_owned())
    }

    fn offered(&self, name: &str, at: At) -> Found {
        let (model, histories) = (&self.models[at.bound], self.of.histories);
        let flag = |is: bool| Ok(f64::from(u8::from(is)));
        let known = |value: Option<f64>, why: &str| value.ok_or_else(|| why.to_owned());
        let range = |i: usize| {
            let why = "pairs were not brought to a spectrum over a range of periods";
            known(self.of.range_s.map(|range_s| range_s[i]), why)
        };
        match name {
            "W" => Ok(model.weight_n()),
            "W_s" => known(histories.above_block_n, "the model has no structure above its block"),
            "g" => Ok(model.gravity_m_per_s2()),
            "storeys" => match (model.structure(), model.storeys()) {
                (None, storeys) => Ok(storeys as f64),
                (Some(_), _) => missing("the structure is given by its modes, not by storeys"),
            },
            "height" => {
                let roof = self.levels.as_ref().and_then(|levels| levels.last());
                known(roof.map(|level| level[1]), "the model gives no heights of its storeys")
            }
            "T_fb" => {
                let why = "the model has no structure above its block";
                known(self.periods_s[at.direction], why)
            }
            "width" => {
                let width_m = match at.direction {
                    0 => model.block().width_m,
                    _ => model.along_y().width_m,
                };
                known(width_m, "the model does not give the width of its block")
            }
            "w_x" => self.level(at, 0),
            "h_x" => self.level(at, 1),
            "friction_factor" => Ok(self.bounds()[at.bound].friction_factor),
            "has_bounds" => flag(self.bounds().len() > 1),
            "radius" => {
                let surfaces = model.slider().slow_surfaces(model.normal_n(), model.weight_n());
                let radii = surfaces.map(|all| all.iter().map(|one| one.radius_m).sum());
                known(radii.flatten(), "the surfaces are not all curved")
            }
            "static_friction" => {
                let [positive, negative] = model.static_friction();
                Ok(positive.max(negative))
            }
            "kinetic_friction" => {
                let [positive, negative] = model.kinetic_friction();
                Ok(0.5 * (positive + negative))
            }
            "activation" => {
                let [positive, negative] = model.static_friction();
                Ok(positive.max(negative) * model.normal_n())
            }
            "reach" => {
                let reach = model.slider().reach_m().map(|(_, reach_m)| reach_m);
                known(reach, "the model gives no gap, travel or stop")
            }
            "D" => self.by_hand(at, |found| found.displacement_m),
            "k" => self.by_hand(at, |found| found.stiffness_n_per_m),
            "beta" => self.by_hand(at, |found| found.damping_ratio),
            "B" => self.by_hand(at, |found| found.damping_factor),
            "T" => self.by_hand(at, |found| found.period_s),
            "Sa_short" => match self.spectrum()? {
                TargetSpectrum::Code { sds_m_per_s2, .. } => Ok(*sds_m_per_s2),
                TargetSpectrum::Points { .. } => missing(
                    "the spectrum is a table, which does not say its short-period parameter",
                ),
            },
            "e" => self.plan(|plan| plan.eccentricity_m),
            "y" => self.plan(|plan| plan.distance_m),
            "b" => self.plan(|plan| plan.sides_m[0]),
            "d" => self.plan(|plan| plan.sides_m[1]),
            "P_T" => self.plan(|plan| plan.period_ratio),
            "earthquakes" => Ok(histories.of_earthquakes() as f64),
            "pairs" if histories.of_pairs() => Ok(histories.of_earthquakes() as f64),
            "pairs" => missing("the records are single components, not pairs"),
            "in_plane" => flag(histories.is_in_plane()),
            "range_from" => range(0),
            "range_to" => range(1),
            "spectrum_share" => {
                let why = "pairs were not brought to a spectrum";
                known(self.of.matched.map(|matched| matched.least[0]), why)
            }
            "runs_D" => self.runs(at, false, |demands| Some(demands.peak_sliding_displacement_m)),
            "runs_residual" => {
                self.runs(at, false, |demands| Some(demands.residual_sliding_displacement_m))
            }
            "runs_V_b" => self.runs(at, true, |demands| Some(demands.peak_slider_force_n)),
            "runs_V_s" if histories.above_block_n.is_none() => {
                missing("the model has no structure above its block")
            }
            "runs_V_s" => self.runs(at, true, |demands| Some(demands.peak_base_shear_n)),
            "runs_drift" => self.drift(at),
            "runs_overturning" => {
                let found = self.runs(at, true, |demands| demands.overturning_ratio);
                found.map_err(|_| {
                    "the model does not give the width of its block and the heights of its storeys"
                        .to_owned()
                })
            }
            _ => Err(format!("no quantity {name}")),
        }
    }
}

impl Code {
    /// The displacement of the hand calculation of this code: its law of damping under a spectrum.
    pub(crate) fn lateral(&self, model: &Model, spectrum: &TargetSpectrum) -> Option<LateralForce> {
        LateralForce::by_law(model, spectrum, &|ratio| damping(&self.damping, ratio))
    }
}

/// A function of numbers alone; none of another, and of too few of them.
fn of_numbers(name: &str, of: &[f64]) -> Option<f64> {
    Some(match name {
        "max" => of.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        "min" => of.iter().copied().fold(f64::INFINITY, f64::min),
        "sqrt" => of.first()?.sqrt(),
        "at_least" => f64::from(u8::from(of.first()? >= of.get(1)?)),
        "table" => {
            let (x, rows) = of.split_first()?;
            let rows = rows.chunks_exact(2).map(|row| [row[0], row[1]]);
            interpolated(&rows.collect::<Vec<_>>(), *x)
        }
        _ => return None,
    })
}

/// The factor of an effective damping, of a formula of `beta` alone.
fn damping(formula: &Formula, ratio: f64) -> Option<f64> {
    Some(match formula {
        Formula::Number(number) => *number,
        Formula::Name(_) => ratio,
        Formula::Binary(sign, of) => {
            combined(*sign, damping(&of[0], ratio)?, damping(&of[1], ratio)?)
        }
        Formula::Call(name, of) => {
            let all: Option<Vec<f64>> = of.iter().map(|one| damping(one, ratio)).collect();
            of_numbers(name, &all?)?
        }
    })
}

/// First period along an axis of the structure on a fixed base in s: of modes that of the one with the most effective
/// mass along it.
fn fixed_base_s(model: &Model, axis: usize) -> Option<f64> {
    let frame = model.frame();
    let rate = match model.structure() {
        Some(structure) => {
            let in_plane = structure.in_plane.iter();
            let in_plane = in_plane.map(|mode| {
                let mass_kg = mode.participation[axis] * mode.participation[axis];
                (mode.frequency_rad_per_s, mass_kg)
            });
            let along_x = structure.modes.iter();
            let along_x = along_x.map(|mode| (mode.frequency_rad_per_s, mode.effective_mass_kg));
            let modes: Vec<(f64, f64)> =
                if structure.in_plane.is_empty() { along_x.collect() } else { in_plane.collect() };
            modes.into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a })?.0
        }
        None if axis == 0 => {
            *shear_frame_frequencies(&frame.masses_kg, &frame.stiffnesses_n_per_m).first()?
        }
        None => {
            let along_y = model.along_y().stiffnesses_n_per_m;
            *shear_frame_frequencies(&frame.masses_kg, &along_y).first()?
        }
    };
    Some(core::f64::consts::TAU / rate)
}

/// Bounds that a code takes where neither factors nor the model give any.
pub(crate) fn bounds_of(code: &Code) -> Option<FrictionBounds> {
    code.limits.map(|[lower, upper]| FrictionBounds { lower, upper })
}
