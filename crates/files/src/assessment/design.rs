//! Runs of a design search over a suite.

use slipstick::assessment::design::{Demand, Figures, Found, Target, search};
use slipstick::assessment::sensitivity;
use slipstick::input::Parts;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::study::unit_points;
use slipstick_report::assessment::design::{Bounded, Sensitivity, Variable};

use super::models::{demands, motion_of};
use super::suite::{Scaling, Suite};
use super::table::Table;
use super::{AssessmentError, Models, threads};

/// A design to be searched for.
#[derive(Clone, Copy, Debug)]
pub struct DesignRequest<'a> {
    /// The models; their grid is what is searched.
    pub models: &'a Models,
    /// The records.
    pub suite: &'a Suite,
    /// How they are scaled.
    pub scaling: Scaling,
    /// What is asked for.
    pub target: Target,
    /// Key of the acceleration to be made least.
    pub acceleration: &'a str,
    /// Factors on friction of the lower and the upper bound, where the front is to be run with them.
    pub bounds: Option<[f64; 2]>,
    /// Sample points of the sensitivity; 0 for none.
    pub sensitivity: u32,
    /// Seed of those points.
    pub seed: u64,
    /// Confidence of intervals.
    pub confidence: f64,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct DesignRun {
    /// What was varied.
    pub variables: Vec<Variable>,
    /// The front, and how many runs it took.
    pub found: Found,
    /// The front (or the nearest design) with lower and upper friction.
    pub bounded: Option<Vec<Bounded>>,
    /// Sensitivity, or why there is none.
    pub sensitivity: Option<Result<Sensitivity, String>>,
    /// Messages of failed runs of the search.
    pub failures: Vec<String>,
    /// The front, a row a design.
    pub front: Table,
}

/// Searches for a design.
///
/// # Errors
/// [`AssessmentError`] for a demand that is none, a target out of range, and scaling without an
/// answer. A run that fails counts as beyond everything.
pub fn run_design(request: &DesignRequest) -> Result<DesignRun, AssessmentError> {
    let DesignRequest { models, suite, target, .. } = *request;
    target.check()?;
    let runner = Runner::new(request)?;
    let records = suite.records.len();
    let grid = models.grid();
    let parts = models.all(records)?;
    let mut failures: Vec<String> = Vec::new();
    let found = search(&target, grid.len(), records, |pairs: &[(usize, usize)]| {
        let runs = threads::map(pairs.len(), |i| {
            let (design, record) = pairs[i];
            let parts = parts[design].as_ref().map_err(Clone::clone)?;
            runner.run(parts, &parts.model, record)
        });
        let demand = |(run, (_, record)): (Result<Demand, String>, &(usize, usize))| {
            run.unwrap_or_else(|message| {
                failures.push(format!("{}: {message}", suite.records[*record].name));
                FAILED
            })
        };
        Ok::<_, AssessmentError>(runs.into_iter().zip(pairs).map(demand).collect())
    })?;
    let bounded = match request.bounds {
        None => None,
        Some(factors) => {
            let designs: Vec<usize> =
                found.front.iter().chain(&found.nearest).map(|point| point.design).collect();
            Some(runner.bounded(&designs, &parts, factors, &target)?)
        }
    };
    let sensitivity = (request.sensitivity > 0).then(|| runner.sensitivity(request));
    let variables: Vec<Variable> = grid
        .axes()
        .iter()
        .map(|axis| Variable {
            path: axis.path.clone(),
            unit: axis.unit.clone(),
            values: axis.values.clone(),
        })
        .collect();
    let front = table(request, &variables, &found, bounded.as_deref());
    Ok(DesignRun { variables, found, bounded, sensitivity, failures, front })
}

/// A run without an answer.
const FAILED: Demand = Demand { displacement_m: f64::NAN, acceleration_m_per_s2: f64::NAN };

/// What all runs of a search share.
struct Runner<'a> {
    models: &'a Models,
    suite: &'a Suite,
    factors: Vec<f64>,
    tail_s: f64,
    /// Scaled records with that tail; none for a made motion.
    motions: Vec<Result<GroundMotion, String>>,
    displacement: usize,
    acceleration: usize,
}

impl<'a> Runner<'a> {
    fn new(request: &DesignRequest<'a>) -> Result<Self, AssessmentError> {
        let (models, suite) = (request.models, request.suite);
        let factors = suite.factors(&request.scaling)?;
        let first = models.parts(&models.grid().values(0));
        let tail_s = first.map_or(0.0, |parts| parts.tail_s);
        let motions = if suite.made {
            Vec::new()
        } else {
            let motion = |i| suite.motion(i, factors[i], tail_s).map_err(|error| error.to_string());
            threads::map(suite.records.len(), motion)
        };
        Ok(Self {
            displacement: models.column("peak_sliding_displacement_m")?,
            acceleration: models.column(request.acceleration)?,
            models,
            suite,
            factors,
            tail_s,
            motions,
        })
    }

    /// One run of a model, which has the motion of these parts.
    fn run(&self, parts: &Parts, model: &Model, record: usize) -> Result<Demand, String> {
        let own;
        let motion = match self.motions.get(record) {
            Some(motion) if parts.tail_s == self.tail_s => motion.as_ref().map_err(Clone::clone)?,
            _ => {
                own = motion_of(self.suite, record, self.factors[record], parts)?;
                &own
            }
        };
        let values = demands(model, motion)?;
        Ok(Demand {
            displacement_m: values[self.displacement],
            acceleration_m_per_s2: values[self.acceleration],
        })
    }

    /// Figures of designs with friction times the lower and the upper factor.
    fn bounded(
        &self,
        designs: &[usize],
        parts: &[Result<Parts, String>],
        factors: [f64; 2],
        target: &Target,
    ) -> Result<Vec<Bounded>, AssessmentError> {
        let records = self.suite.records.len();
        let each = 2 * records;
        let runs = threads::map(designs.len() * each, |i| {
            let (design, factor) = (designs[i / each], factors[i % each / records]);
            let run = || -> Result<Demand, String> {
                let parts = parts[design].as_ref().map_err(Clone::clone)?;
                let friction = parts.model.slider().friction.scaled(factor);
                let model = parts.model.with_friction(friction.map_err(|error| error.to_string())?);
                self.run(parts, &model, i % records)
            };
            run().unwrap_or(FAILED)
        });
        let figures = |at: usize| -> Result<Figures, AssessmentError> {
            Ok(target.figures(&runs[at..at + records])?)
        };
        let bounded = |(i, &design): (usize, &usize)| {
            let (lower, upper) = (figures(i * each)?, figures(i * each + records)?);
            Ok(Bounded { design, lower, upper })
        };
        designs.iter().enumerate().map(bounded).collect()
    }

    /// Sobol' indices of both figures, the variables uniform between their ends.
    fn sensitivity(&self, request: &DesignRequest) -> Result<Sensitivity, String> {
        let axes = self.models.grid().axes();
        let inputs = axes.len();
        let points = unit_points(2 * inputs, request.sensitivity, request.seed);
        let rows = sensitivity::design(&points, inputs).map_err(|error| error.to_string())?;
        let records = self.suite.records.len();
        let figures = threads::map(rows.len(), |i| -> Result<[f64; 2], String> {
            let value = |(axis, u): (&super::axis::Axis, &f64)| {
                let [low, high] = axis.ends();
                (low + u * (high - low)).clamp(low, high)
            };
            let values: Vec<f64> = axes.iter().zip(&rows[i]).map(value).collect();
            let parts = self.models.parts(&values).map_err(|error| error.to_string())?;
            let demands = (0..records).map(|record| self.run(&parts, &parts.model, record));
            let demands = demands.collect::<Result<Vec<_>, _>>()?;
            let figures = request.target.figures(&demands).map_err(|error| error.to_string())?;
            Ok([figures.displacement_m, figures.acceleration_m_per_s2])
        });
        let figures = figures.into_iter().collect::<Result<Vec<_>, _>>()?;
        let of = |which: usize| {
            let outputs: Vec<f64> = figures.iter().map(|pair| pair[which]).collect();
            let indices = sensitivity::indices(&outputs, inputs, request.confidence);
            indices.map_err(|error| error.to_string())
        };
        Ok(Sensitivity { points: points.len(), displacement: of(0)?, acceleration: of(1)? })
    }
}

fn table(
    request: &DesignRequest,
    variables: &[Variable],
    found: &Found,
    bounded: Option<&[Bounded]>,
) -> Table {
    let points = &found.front;
    let mut table = Table::default();
    for (i, variable) in variables.iter().enumerate() {
        let of = |design: usize| request.models.grid().values(design)[i];
        let cells = points.iter().map(|point| of(point.design)).collect();
        table.numbers(&variable.path, &variable.unit, cells);
    }
    let mut figures = |suffix: &str, all: Vec<Figures>| {
        let name = |name: &str| format!("{name}{suffix}");
        let column = |pick: &dyn Fn(&Figures) -> f64| all.iter().map(pick).collect::<Vec<_>>();
        table.numbers(&name("displacement_m"), "m", column(&|f| f.displacement_m));
        table.numbers(&name("acceleration_m_per_s2"), "m/s2", column(&|f| f.acceleration_m_per_s2));
        table.numbers(&name("probability_within_gap"), "", column(&|f| f.within.estimate()));
        let confidence = request.confidence;
        table.numbers(&name("wilson_low"), "", column(&|f| f.within.wilson(confidence)[0]));
        table.numbers(&name("wilson_high"), "", column(&|f| f.within.wilson(confidence)[1]));
    };
    figures("", points.iter().map(|point| point.figures).collect());
    if let Some(bounded) = bounded {
        let of = |pick: fn(&Bounded) -> Figures| {
            let find = |design: usize| bounded.iter().find(|b| b.design == design).map(pick);
            points.iter().filter_map(|point| find(point.design)).collect::<Vec<_>>()
        };
        figures("_lower_friction", of(|b| b.lower));
        figures("_upper_friction", of(|b| b.upper));
    }
    table
}
