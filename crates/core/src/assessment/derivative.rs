//! Derivatives of demands with respect to keys of a model, by differences of exact runs.
//!
//! At a key's value `x`, with runs at `x ± h` and the slopes `D₊ = (f(x+h) − f(x))/h`,
//! `D₋ = (f(x) − f(x−h))/h`:
//!
//! ```text
//! derivative  D = (D₊ + D₋)/2
//! error       |D₊ − D₋|/2 + r/h
//! step        h = |x| √(r/|f|)        between 3e-8 |x| and 1e-4 |x|
//! ```
//!
//! `r` is the rounding of `f`: what two runs with all keys moved by a few of their last digits change, at least
//! `2 ε |f|`. Where `f` bends one way only within the step, its derivative lies between the two slopes and the
//! error is a bound; of a kink it is half the jump of the slope. The events of the three runs are compared: where
//! their order or number differs, the step is made smaller while runs are left, and the derivative is flagged if
//! that does not help. Where a value on one side makes no model, `f(x)`, `f(x ± h)` and `f(x ± 2h)` of the other
//! side serve.
//!
//! Of one record that is `2 k + 3` runs for `k` keys, and up to [`ANALYSES`] in all where steps are made smaller.

use super::models::Models;
use super::suite::{Scaling, Suite};
use super::{AssessmentError, FailedRun, refuse};
use crate::check::{self, ClosestCall};
use crate::error::{RunError, SolveError};
use crate::input::Parts;
use crate::motion::GroundMotion;
use crate::notice::Notice;
use crate::response::{
    DemandColumn, DemandKind, EventKind, InDirections, Method, Response, demand_values,
};
use crate::solver;
use crate::study::Certified;
use crate::study::cases::{Case, CaseRun, Runs};
use crate::study::engine::Engine;
use crate::study::kept::InNumbers;
use crate::table::{Cells, Column, Table};

/// Runs on a record that steps may be made smaller within; of more than 20 keys two more than those that all take.
pub const ANALYSES: usize = 45;

/// How often a step is made smaller, and how much.
const ROUNDS: usize = 4;
const SMALLER: f64 = 0.1;

/// Least and largest step over the value.
const STEPS: [f64; 2] = [3e-8, 1e-4];

/// Last digits by which the keys are moved to see rounding.
const DIGITS: f64 = 4.0 * f64::EPSILON;

/// What derivatives are asked of.
#[derive(Clone, Copy, Debug)]
pub struct DerivativeRequest<'a> {
    /// The models, whose grid has the keys as its axes, with one value each.
    pub models: &'a Models,
    /// The records.
    pub suite: &'a Suite,
    /// How they are scaled.
    pub scaling: &'a Scaling,
    /// Keys of the demands that are wanted; all that are numbers if empty.
    pub demands: &'a [String],
}

/// A key of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Its path.
    pub path: String,
    /// Its SI unit; empty of a ratio.
    pub unit: String,
    /// Its value, SI.
    pub value: f64,
}

/// A derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivative {
    /// Number of the record.
    pub record: usize,
    /// Number of the key.
    pub key: usize,
    /// Number of the demand.
    pub demand: usize,
    /// Value of the demand, SI.
    pub value: f64,
    /// Change of the demand over that of the key, SI; NaN where a run has no answer.
    pub derivative: f64,
    /// Its error.
    pub error: f64,
    /// The step, in the unit of the key.
    pub step: f64,
    /// Whether order or number of the events changes within the step.
    pub events_change: bool,
}

impl Derivative {
    /// Relative change of the demand over that of the key: `x/f df/dx`. NaN where one of the two is 0.
    #[must_use]
    pub fn relative(&self, key: &Key) -> f64 {
        if key.value == 0.0 || self.value == 0.0 {
            return f64::NAN;
        }
        key.value / self.value * self.derivative
    }
}

/// The model on a record, with its certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct OfRecord {
    /// Name of the record.
    pub name: String,
    /// Factor on it.
    pub scale: f64,
    /// Whether the certificate holds; `None` without an answer.
    pub holds: Option<bool>,
    /// The largest figure of the certificate by its name.
    pub largest: Option<(String, f64)>,
    /// The nearest decision.
    pub closest_call: Option<ClosestCall>,
    /// Runs that were made on it.
    pub analyses: u64,
}

impl DerivativeRun {
    /// How many of the runs were certified: of each record the one of the model as it stands.
    #[must_use]
    pub fn certified(&self) -> Certified {
        let mut certified = Certified::of(self.runs);
        for of in self.records.iter().filter(|of| of.holds.is_some()) {
            let refused = of.largest.as_ref().filter(|_| of.holds == Some(false));
            let defect = refused.map(|(what, error)| format!("{what} {error:.1e}"));
            certified.add_judged(&of.name, of.largest.clone(), defect);
        }
        certified
    }
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct DerivativeRun {
    /// The keys.
    pub keys: Vec<Key>,
    /// The demands.
    pub demands: Vec<DemandColumn>,
    /// Whether these were asked for, and are not simply all.
    pub are_asked_for: bool,
    /// The records.
    pub records: Vec<OfRecord>,
    /// Record by record, key by key, demand by demand.
    pub derivatives: Vec<Derivative>,
    /// Runs without an answer.
    pub failures: Vec<FailedRun>,
    /// What was noticed of runs.
    pub warnings: Vec<Notice>,
    /// Number of runs.
    pub runs: u64,
    /// A row a derivative.
    pub table: Table,
}

/// Demands and the order of events of one run.
#[derive(Clone, Debug)]
struct Sample {
    demands: Vec<f64>,
    events: Vec<(EventKind, usize, i8)>,
}

impl Sample {
    fn of(response: &Response, columns: &[usize]) -> Self {
        let all = demand_values(&response.demands);
        let events = response.events.iter();
        Self {
            demands: columns.iter().map(|&column| all[column]).collect(),
            events: events.map(|e| (e.kind, e.interface, e.mode.sign() as i8)).collect(),
        }
    }
}

/// How many demands there are, these, then three numbers an event: the place of its kind, interface and direction.
impl InNumbers for Sample {
    fn numbers(&self) -> Option<Vec<f64>> {
        let event = |(kind, interface, sign): &(EventKind, usize, i8)| {
            let place = EventKind::ALL.iter().position(|of| of == kind)?;
            Some([place as f64, *interface as f64, f64::from(*sign)])
        };
        let events = self.events.iter().map(event).collect::<Option<Vec<_>>>()?;
        let mut numbers = vec![self.demands.len() as f64];
        numbers.extend(&self.demands);
        numbers.extend(events.as_flattened());
        Some(numbers)
    }

    fn of(numbers: Vec<f64>) -> Option<Self> {
        let (count, rest) = numbers.split_first()?;
        let (demands, events) = rest.split_at_checked(*count as usize)?;
        let (events, []) = events.as_chunks::<3>() else { return None };
        let event = |[place, interface, sign]: &[f64; 3]| {
            Some((*EventKind::ALL.get(*place as usize)?, *interface as usize, *sign as i8))
        };
        let events = events.iter().map(event).collect::<Option<Vec<_>>>()?;
        Some(Self { demands: demands.to_vec(), events })
    }
}

/// Two values of a key beside its own, both at one side where the other makes no model.
#[derive(Clone, Debug)]
struct Stencil {
    key: usize,
    at: [f64; 2],
    models: [Result<Parts, RunError>; 2],
}

/// Differences of the demands over a stencil, and whether the events differ.
#[derive(Clone, Debug)]
struct Slopes {
    step: f64,
    slopes: Vec<[f64; 2]>,
    events_change: bool,
}

/// Runs what derivatives take; the engine is told of every run.
///
/// # Errors
/// [`AssessmentError`] for no key, a demand that is none or no number, scaling without an answer, and where it is
/// stopped.
pub fn run_derivatives(
    request: &DerivativeRequest<'_>,
    engine: &Engine<'_>,
) -> Result<DerivativeRun, AssessmentError> {
    let DerivativeRequest { models, suite, .. } = *request;
    let keys: Vec<Key> = models
        .grid()
        .axes()
        .iter()
        .map(|axis| Key { path: axis.path.clone(), unit: axis.unit.clone(), value: axis.values[0] })
        .collect();
    if keys.is_empty() {
        return Err(refuse("vary", "keys, such as slider.kinetic_friction", "nothing"));
    }
    let columns = columns(request)?;
    let values: Vec<f64> = keys.iter().map(|key| key.value).collect();
    let base = models.parts(&values)?;
    let factors = suite.scaled(request.scaling, engine)?.factors;
    let cases = Case::every(1, 1, &factors);
    let on = |i: usize| CaseRun::of(cases[i], on_base(&base, suite, &cases[i], &columns, engine));
    let bases = engine.runs(cases.len(), on)?;
    let mut of = Work {
        models,
        suite,
        factors: &factors,
        columns: &columns,
        runs: suite.runs(&factors, base.tail_s, engine)?,
        failures: Vec::new(),
        analyses: vec![1; factors.len()],
    };
    let rounding = of.rounding(&values, &bases)?;
    let relative = relative_step(&rounding, &bases);
    let natural: Vec<f64> = keys.iter().map(|key| scale_of(key, &base)).collect();
    let steps: Vec<f64> = natural.iter().map(|scale| scale * relative).collect();
    let all: Vec<usize> = (0..keys.len()).collect();
    // slopes[record][key]
    let mut slopes = of.slopes(&all, &values, &steps, &bases)?;
    let budget = ANALYSES.max(2 * keys.len() + 5) as u64;
    let mut smaller = 1.0;
    for _ in 0..ROUNDS {
        smaller *= SMALLER;
        let changes =
            |key: &usize| slopes.iter().flatten().any(|of| of.0 == *key && of.1.events_change);
        let flagged = all.iter().copied().filter(changes);
        let left = budget.saturating_sub(of.analyses.iter().copied().max().unwrap_or(0)) / 2;
        let flagged: Vec<usize> = flagged.take(left as usize).collect();
        if flagged.is_empty() {
            break;
        }
        let steps: Vec<f64> = flagged.iter().map(|&key| steps[key] * smaller).collect();
        let again = of.slopes(&flagged, &values, &steps, &bases)?;
        for (kept, again) in slopes.iter_mut().zip(again) {
            for (key, finer) in again {
                let place = kept.iter_mut().find(|(other, old)| *other == key && old.events_change);
                if let Some((_, old)) = place {
                    *old = finer;
                }
            }
        }
    }
    let mut derivatives = Vec::new();
    for (record, (base, slopes)) in bases.iter().zip(&slopes).enumerate() {
        let Ok(base) = &base.kept else { continue };
        for (key, slopes) in slopes {
            for demand in 0..columns.len() {
                let [first, second] = slopes.slopes[demand];
                let noise = rounding[record][demand] / slopes.step;
                derivatives.push(Derivative {
                    record,
                    key: *key,
                    demand,
                    value: base.sample.demands[demand],
                    derivative: first,
                    error: second + noise,
                    step: slopes.step,
                    events_change: slopes.events_change,
                });
            }
        }
    }
    let analyses = of.analyses;
    let mut failures = of.failures;
    let records = bases.iter().enumerate().map(|(i, base)| OfRecord {
        name: suite.records[i].name.clone(),
        scale: factors[i],
        holds: base.kept.as_ref().ok().map(|base| base.holds),
        largest: base.kept.as_ref().ok().map(|base| base.largest.clone()),
        closest_call: base.kept.as_ref().ok().and_then(|base| base.closest_call),
        analyses: analyses[i],
    });
    let records: Vec<OfRecord> = records.collect();
    failures.extend(suite.in_words(&[], &|_| String::new()).failures(&bases));
    let demands = models.columns();
    let demands: Vec<DemandColumn> = columns.iter().map(|&column| demands[column]).collect();
    let table = table(&keys, &demands, &records, &derivatives);
    let answered = bases.iter().flat_map(|base| &base.kept);
    let warnings = answered.flat_map(|base| base.noticed.iter().cloned()).collect();
    let runs = analyses.iter().sum();
    let are_asked_for = !request.demands.is_empty();
    Ok(DerivativeRun {
        keys,
        demands,
        are_asked_for,
        records,
        derivatives,
        failures,
        warnings,
        runs,
        table,
    })
}

/// The demands that are wanted, by their places among all, each once.
fn columns(request: &DerivativeRequest<'_>) -> Result<Vec<usize>, AssessmentError> {
    let all = request.models.columns();
    let in_plane = request.suite.in_plane();
    let fits = |column: &DemandColumn| {
        let of_axis = in_plane && column.demand.in_directions == InDirections::Axis;
        column.demand.kind == DemandKind::Number && column.demand.in_summary && !of_axis
    };
    if request.demands.is_empty() {
        return Ok((0..all.len()).filter(|&i| fits(&all[i])).collect());
    }
    let place = |key: &String| {
        let place = request.models.column(key)?;
        match fits(&all[place]) {
            true => Ok(place),
            false => {
                let expected = "a demand that is a number, of which there is a derivative";
                Err(refuse("demand", expected, format!("{key:?}")))
            }
        }
    };
    let mut places = Vec::new();
    for key in request.demands {
        let place = place(key)?;
        if !places.contains(&place) {
            places.push(place);
        }
    }
    Ok(places)
}

/// The model as it stands on a record, judged.
struct Base {
    sample: Sample,
    holds: bool,
    largest: (String, f64),
    closest_call: Option<ClosestCall>,
    noticed: Vec<Notice>,
}

fn on_base(
    base: &Parts,
    suite: &Suite,
    case: &Case,
    columns: &[usize],
    engine: &Engine<'_>,
) -> Result<Base, RunError> {
    let motion = suite.motion(case.record, case.scale, base.tail_s)?;
    let judged = engine.watch(|go_on| {
        let response = solver::solve_while(&base.model, &motion, Method::Exact, go_on)?;
        let certificate = check::check_while(&base.model, &motion, &response, go_on)?;
        Ok::<_, SolveError>((response, certificate))
    });
    let (response, certificate) = judged?;
    Ok(Base {
        sample: Sample::of(&response, columns),
        holds: certificate.holds(),
        largest: certificate.largest(),
        closest_call: certificate.closest_call,
        noticed: response.warnings,
    })
}

/// What steps are taken of where a value is 0: its own size else.
fn scale_of(key: &Key, base: &Parts) -> f64 {
    let mass_kg = base.model.total_mass_kg();
    match (key.value, key.unit.as_str()) {
        (0.0, "kg" | "N s/m" | "N/m" | "N") => mass_kg,
        (0.0, _) => 1.0,
        (value, _) => value.abs(),
    }
}

/// The step over the value that balances rounding and curvature: the root of the usual relative rounding.
fn relative_step(rounding: &[Vec<f64>], bases: &[CaseRun<Base>]) -> f64 {
    let mut all = Vec::new();
    for (rounding, base) in rounding.iter().zip(bases) {
        let Ok(base) = &base.kept else { continue };
        let ratios = rounding.iter().zip(&base.sample.demands).map(|(r, f)| r / f.abs());
        all.extend(ratios.filter(|ratio| ratio.is_finite()));
    }
    all.sort_by(f64::total_cmp);
    let usual = all.get(all.len() / 2).copied().unwrap_or(0.0);
    usual.sqrt().clamp(STEPS[0], STEPS[1])
}

struct Work<'a> {
    models: &'a Models,
    suite: &'a Suite,
    factors: &'a [f64],
    columns: &'a [usize],
    runs: Runs<'a>,
    failures: Vec<FailedRun>,
    /// Runs made on each record.
    analyses: Vec<u64>,
}

impl Work<'_> {
    /// Samples of designs, each on every record.
    fn run(
        &mut self,
        designs: &[Result<Parts, RunError>],
    ) -> Result<Vec<CaseRun<Sample>>, AssessmentError> {
        for count in &mut self.analyses {
            *count += designs.len() as u64;
        }
        let (cases, columns) = (Case::every(designs.len(), 1, self.factors), self.columns);
        let sample =
            |_: &Case, response: &Response, _: &GroundMotion| Sample::of(response, columns);
        Ok(self.runs.all(&cases, |case| &designs[case.design], sample)?)
    }

    /// The rounding of every demand on every record.
    fn rounding(
        &mut self,
        values: &[f64],
        bases: &[CaseRun<Base>],
    ) -> Result<Vec<Vec<f64>>, AssessmentError> {
        let moved = |sign: f64| {
            let values: Vec<f64> = values.iter().map(|x| x * (1.0 + sign * DIGITS)).collect();
            self.models.parts(&values).map_err(RunError::from)
        };
        let designs = [1.0, -1.0].map(moved);
        let ran = self.run(&designs)?;
        let of_record = |(record, base): (usize, &CaseRun<Base>)| {
            let Ok(base) = &base.kept else { return vec![0.0; self.columns.len()] };
            let of = |demand: usize| {
                let f = base.sample.demands[demand];
                let probes = ran.iter().filter(|ran| ran.case.record == record);
                let probes = probes.filter_map(|ran| ran.kept.as_ref().ok());
                let change = |sample: &Sample| (sample.demands[demand] - f).abs();
                let least = 2.0 * f64::EPSILON * f.abs();
                probes.map(change).filter(|c| c.is_finite()).fold(least, f64::max)
            };
            (0..self.columns.len()).map(of).collect()
        };
        Ok(bases.iter().enumerate().map(of_record).collect())
    }

    /// The slopes of some keys on every record.
    fn slopes(
        &mut self,
        keys: &[usize],
        values: &[f64],
        steps: &[f64],
        bases: &[CaseRun<Base>],
    ) -> Result<Vec<Vec<(usize, Slopes)>>, AssessmentError> {
        let stencils: Vec<Stencil> =
            keys.iter().zip(steps).map(|(key, step)| self.stencil(*key, values, *step)).collect();
        let designs: Vec<_> = stencils.iter().flat_map(|of| of.models.iter().cloned()).collect();
        let ran = self.run(&designs)?;
        let axes = self.models.grid().axes();
        let moved =
            |design: usize| format!(", {} moved by a step", axes[stencils[design / 2].key].path);
        let answered = ran.iter().filter(|ran| bases[ran.case.record].kept.is_ok());
        self.failures.extend(self.suite.in_words(&[], &moved).failures(answered));
        let mut all = Vec::with_capacity(bases.len());
        for (record, base) in bases.iter().enumerate() {
            let Ok(base) = &base.kept else {
                all.push(Vec::new());
                continue;
            };
            let mut of_record = Vec::with_capacity(stencils.len());
            for (i, stencil) in stencils.iter().enumerate() {
                let two = [2 * i, 2 * i + 1].map(|i| &ran[i * bases.len() + record].kept);
                let x = values[stencil.key];
                of_record.push((stencil.key, slopes(x, stencil.at, &base.sample, two)));
            }
            all.push(of_record);
        }
        Ok(all)
    }

    /// A key's value more and less by a step, or both at the side that makes a model.
    fn stencil(&self, key: usize, values: &[f64], step: f64) -> Stencil {
        let at = |x: f64| {
            let mut moved = values.to_vec();
            moved[key] = x;
            self.models.parts(&moved).map_err(RunError::from)
        };
        let x = values[key];
        let [less, more] = [x - step, x + step];
        let models = [at(less), at(more)];
        match &models {
            [Err(_), Ok(_)] => {
                let further = x + 2.0 * step;
                let [_, one] = models;
                Stencil { key, at: [more, further], models: [one, at(further)] }
            }
            [Ok(_), Err(_)] => {
                let further = x - 2.0 * step;
                let [one, _] = models;
                Stencil { key, at: [less, further], models: [one, at(further)] }
            }
            _ => Stencil { key, at: [less, more], models },
        }
    }
}

/// Derivative and error of every demand from its values at `x` and two other points.
fn slopes(x: f64, at: [f64; 2], base: &Sample, two: [&Result<Sample, RunError>; 2]) -> Slopes {
    let [Ok(first), Ok(second)] = two else {
        let none = vec![[f64::NAN; 2]; base.demands.len()];
        return Slopes { step: (at[0] - x).abs(), slopes: none, events_change: false };
    };
    let [a, b] = at.map(|point| point - x);
    let of = |demand: usize| {
        let [f, fa, fb] = [base, first, second].map(|sample| sample.demands[demand]);
        // Newton's form through the three points: f[x, a] − a f[x, a, b].
        let [near, far] = [(fa - f) / a, (fb - f) / b];
        let derivative = near - a * (far - near) / (b - a);
        let beside = if a * b < 0.0 { 0.5 } else { 2.0 };
        [derivative, beside * (far - near).abs()]
    };
    Slopes {
        step: a.abs(),
        slopes: (0..base.demands.len()).map(of).collect(),
        events_change: first.events != base.events || second.events != base.events,
    }
}

/// A row a derivative.
fn table(
    keys: &[Key],
    demands: &[DemandColumn],
    records: &[OfRecord],
    derivatives: &[Derivative],
) -> Table {
    let texts = |of: &dyn Fn(&Derivative) -> String| derivatives.iter().map(of).collect();
    let numbers = |of: &dyn Fn(&Derivative) -> f64| derivatives.iter().map(of).collect();
    let unit = |d: &Derivative| {
        let (of, per) = (demands[d.demand].unit(), keys[d.key].unit.as_str());
        match (of, per) {
            (of, "") => of.to_owned(),
            ("", per) => format!("1/({per})"),
            (of, per) => format!("{of}/({per})"),
        }
    };
    let mut table = Table::default();
    table
        .texts("record", texts(&|d| records[d.record].name.clone()))
        .texts("path", texts(&|d| keys[d.key].path.clone()))
        .numbers("value", "", numbers(&|d| keys[d.key].value))
        .texts("demand", texts(&|d| demands[d.demand].name()))
        .numbers("demand_value", "", numbers(&|d| d.value))
        .numbers("derivative", "", numbers(&|d| d.derivative))
        .numbers("error", "", numbers(&|d| d.error))
        .texts("unit", texts(&unit))
        .numbers("relative", "", numbers(&|d| d.relative(&keys[d.key])))
        .numbers("step", "", numbers(&|d| d.step));
    let changes = derivatives.iter().map(|d| Some(d.events_change)).collect();
    table.columns.push(Column {
        name: "events_change".to_owned(),
        unit: String::new(),
        cells: Cells::Flags(changes),
    });
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_is_kept_is_the_same() {
        let sample = Sample {
            demands: vec![0.25, f64::NAN, -3.0],
            events: vec![
                (EventKind::Slip, 0, 1),
                (EventKind::Surface, 2, -1),
                (EventKind::Stick, 0, 0),
            ],
        };
        let (numbers, of) = (sample.numbers().unwrap(), <Sample as InNumbers>::of);
        let again = of(numbers.clone()).unwrap();
        assert_eq!(format!("{again:?}"), format!("{sample:?}"));
        assert!(of(numbers[..numbers.len() - 1].to_vec()).is_none());
        assert!(of(vec![4.0, 1.0]).is_none());
    }

    use crate::input::loaded::Loaded;

    const G: f64 = 9.80665;

    /// A block on friction alone under one pulse of `a` for `t1`: it slides for `t1 a/(μ g)`, and comes to rest
    /// `s = ½ t1² a (a − μ g)/(μ g)` behind, so that `ds/dμ = −½ t1² a²/(μ² g)`.
    fn newmark(mu_static: f64) -> (String, GroundMotion) {
        let text = format!(
            "[block]\nmass = \"2 t\"\n[slider]\nstatic_friction = {mu_static}\nkinetic_friction = 0.2\n"
        );
        let values = [0.4, 0.4, 0.0, 0.0].map(|a| a * G).to_vec();
        (text, GroundMotion::new(vec![0.0, 0.5, 0.5, 2.0], values, None).unwrap())
    }

    fn derivatives(text: &str, motion: GroundMotion, keys: &[(&str, &str)]) -> DerivativeRun {
        let varied: Vec<(&str, String)> =
            keys.iter().map(|(path, value)| ("vary", format!("{path}={value}"))).collect();
        let models = Models::new("m.toml", text, &[], &varied, false).unwrap();
        let suite = Suite::of([("pulse".to_owned(), Loaded::made(motion, String::new()))], false);
        let request = DerivativeRequest {
            models: &models,
            suite: &suite,
            scaling: &Scaling::Factor(1.0),
            demands: &[],
        };
        run_derivatives(&request, &Engine::unwatched()).unwrap()
    }

    fn of<'a>(run: &'a DerivativeRun, key: usize, demand: &str) -> &'a Derivative {
        let place = run.demands.iter().position(|column| column.name() == demand).unwrap();
        run.derivatives.iter().find(|d| d.key == key && d.demand == place).unwrap()
    }

    /// The closed form, and an error that is one.
    #[test]
    fn derivatives_of_newmarks_block_are_those_of_the_closed_form() {
        let (text, motion) = newmark(0.25);
        let keys = [
            ("slider.kinetic_friction", "0.2"),
            ("block.mass", "2 t"),
            ("slider.static_friction", "0.25"),
        ];
        let run = derivatives(&text, motion, &keys);
        let residual = of(&run, 0, "residual_sliding_displacement_m");
        let exact = 0.5 * 0.25 * 0.16 * G / 0.04;
        assert!((residual.derivative - exact).abs() <= residual.error, "{residual:?} {exact}");
        assert!(residual.error < 1e-4 * exact, "{residual:?}");
        assert!(!residual.events_change);
        let force = of(&run, 1, "peak_friction_force_n");
        assert!(
            (force.derivative - 0.2 * G).abs() <= force.error
                && force.error < 1e-6 * force.derivative,
            "{force:?}"
        );
        // Neither mass nor static friction moves where the block ends.
        for key in [1, 2] {
            let none = of(&run, key, "residual_sliding_displacement_m");
            assert!(none.derivative.abs() <= none.error, "{none:?}");
        }
        assert_eq!((run.runs, run.records[0].holds), (2 * 3 + 3, Some(true)));
        assert!(run.failures.is_empty());
    }

    /// Where both coefficients are equal, kinetic friction has no more side: the other one serves.
    #[test]
    fn a_side_without_a_model_leaves_the_other() {
        let (text, motion) = newmark(0.2);
        let run = derivatives(&text, motion, &[("slider.kinetic_friction", "0.2")]);
        let residual = of(&run, 0, "residual_sliding_displacement_m");
        let exact = 0.5 * 0.25 * 0.16 * G / 0.04;
        assert!((residual.derivative - exact).abs() <= residual.error, "{residual:?}");
        assert!(residual.error < 1e-4 * exact && run.failures.is_empty());
    }

    /// Static friction that the pulse just reaches: with a little more nothing slides.
    #[test]
    fn a_change_of_the_events_is_flagged() {
        let (text, motion) = newmark(0.4);
        let run = derivatives(&text, motion, &[("slider.static_friction", "0.4")]);
        let residual = of(&run, 0, "residual_sliding_displacement_m");
        assert!(residual.events_change, "{residual:?}");
        assert!(run.runs <= ANALYSES as u64);
    }

    /// A smaller step helps where the change is near, not at the value.
    #[test]
    fn a_step_is_made_smaller_where_that_helps() {
        let (text, motion) = newmark(0.4 * (1.0 - 2e-9));
        let run = derivatives(&text, motion, &[("slider.static_friction", "0.3999999992")]);
        let residual = of(&run, 0, "residual_sliding_displacement_m");
        assert!(!residual.events_change && residual.step < 1e-9, "{residual:?}");
        assert!(run.runs > 5 && run.runs <= ANALYSES as u64);
    }

    /// The bar of 45 runs holds for 20 keys, and steps made smaller keep to it.
    #[test]
    fn twenty_keys_take_forty_five_runs_at_most() {
        let mut text = newmark(0.4).0;
        let mut keys = vec![("slider.static_friction".to_owned(), "0.4".to_owned())];
        for storey in 1..=10 {
            text.push_str(
                "[[storey]]\nmass = \"1 t\"\nstiffness = \"4 kN/mm\"\ndamper = \"4 kN s/m\"\n",
            );
            keys.push((format!("storey.{storey}.mass"), "1 t".to_owned()));
            keys.push((format!("storey.{storey}.damper"), "4 kN s/m".to_owned()));
        }
        keys.truncate(20);
        let keys: Vec<(&str, &str)> = keys.iter().map(|(a, b)| (&a[..], &b[..])).collect();
        let run = derivatives(&text, newmark(0.4).1, &keys);
        assert!((43..=45).contains(&run.runs), "{}", run.runs);
        assert_eq!(run.derivatives.len(), 20 * run.demands.len());
    }
}
