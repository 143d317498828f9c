//! Sliding spectra and frequency response: the sliding model beside the one on a fixed base, and the
//! window of frequencies in which a structure amplifies.

use core::ops::ControlFlow;

use super::models::Models;
use super::suite::{Scaling, Suite};
use super::{AssessmentError, FailedRun, refuse};
use crate::error::{ModelError, MotionError, RunError, Stopped};
use crate::input::{Bound, Parts};
use crate::model::{Block, InitialState, Model};
use crate::motion::GroundMotion;
use crate::notice::Notice;
use crate::numerics::fractile::fractiles;
use crate::response::{DemandColumn, Response, demand_values};
use crate::study::cases::{Case, CaseRun, add_answers, status};
use crate::study::certified::{Certified, same_bits};
use crate::study::engine::Engine;
use crate::study::kept::InNumbers;
use crate::study::{Demanded, Record, SLIDING};
use crate::table::Table;

/// A friction that nothing overcomes: a million times what any motion on Earth asks.
const HELD: f64 = 1e9;

/// The same structure with its block held to the table: what it would feel without sliders.
///
/// It is to be run on [`without_vertical`] motion, so that contact is never lost; sliding velocity and
/// displacement at the start are 0.
///
/// # Errors
/// [`ModelError`] never, of a model that was checked.
pub fn fixed_base(model: &Model) -> Result<Model, ModelError> {
    let initial = InitialState {
        sliding_displacement_m: 0.0,
        sliding_velocity_m_per_s: 0.0,
        ..model.initial().clone()
    };
    let slider = model.slider().held(HELD, model.normal_n())?;
    let (block, gravity_m_per_s2) = (*model.block(), model.gravity_m_per_s2());
    match model.structure() {
        Some(structure) => {
            let block = Block { mass_kg: model.bare_block_kg(), ..block };
            Model::with_modes(block, slider, structure.clone(), gravity_m_per_s2, initial)
        }
        None => Model::new(block, slider, model.frame().clone(), gravity_m_per_s2, initial),
    }
}

/// The motion along the sliding surface alone.
///
/// # Errors
/// [`MotionError`] never, of a motion that was checked.
pub fn without_vertical(motion: &GroundMotion) -> Result<GroundMotion, MotionError> {
    let along = motion.horizontal_m_per_s2().to_vec();
    GroundMotion::new(motion.times_s().to_vec(), along, None)
}

/// Intervals of `x` (rising) in which `y`, linear between its points, is above a threshold; values
/// that are not finite end an interval.
#[must_use]
pub fn intervals_above(x: &[f64], y: &[f64], threshold: f64) -> Vec<[f64; 2]> {
    let mut intervals: Vec<[f64; 2]> = Vec::new();
    let mut open: Option<f64> = None;
    let n = x.len().min(y.len());
    for i in 0..n {
        let above = y[i] > threshold;
        let crossing = |i: usize| {
            let part = (threshold - y[i - 1]) / (y[i] - y[i - 1]);
            if part.is_finite() { x[i - 1] + part * (x[i] - x[i - 1]) } else { x[i] }
        };
        match (open, above) {
            (None, true) => {
                let known = i > 0 && y[i - 1].is_finite();
                open = Some(if known { crossing(i) } else { x[i] });
            }
            (Some(from), false) => {
                let to = if y[i].is_finite() { crossing(i) } else { x[i - 1] };
                intervals.push([from, to]);
                open = None;
            }
            _ => {}
        }
    }
    if let Some(from) = open {
        intervals.push([from, x[n - 1]]);
    }
    intervals
}

/// A spectrum to be run: the last path of the models' grid runs along the axis, those before it make
/// groups of curves.
#[derive(Clone, Copy, Debug)]
pub struct SpectrumRequest<'a> {
    /// The models.
    pub models: &'a Models,
    /// The records.
    pub suite: &'a Suite,
    /// How they are scaled.
    pub scaling: &'a Scaling,
    /// Keys of demands besides those that are always told.
    pub demands: &'a [String],
    /// Bounds of friction with which every model is run, a group of curves each; empty where the model
    /// is run as it stands.
    pub bounds: &'a [Bound],
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct SpectrumRun {
    /// The path along the axis.
    pub over: String,
    /// Its SI unit.
    pub unit: String,
    /// Its values.
    pub values: Vec<f64>,
    /// The paths that make groups of curves, with their SI units.
    pub group_paths: Vec<(String, String)>,
    /// Their values, a list a group, in SI.
    pub groups: Vec<Vec<f64>>,
    /// Name of the bound of friction of each group; none where no bounds are run.
    pub group_bounds: Vec<&'static str>,
    /// Fractiles of each demand.
    pub curves: Vec<DemandCurves>,
    /// Intervals in which the median amplification of each group is above 1.
    pub windows: Vec<Vec<[f64; 2]>>,
    /// Runs without an answer.
    pub failures: Vec<FailedRun>,
    /// How many runs were certified. One that the check does not confirm is left out of the fractiles.
    pub certified: Certified,
    /// What was noticed of runs.
    pub warnings: Vec<Notice>,
    /// Number of runs, those of the fixed-base models apart.
    pub runs: usize,
    /// Fractiles, a row a value and group.
    pub table: Table,
    /// Demands, a row a run.
    pub rows: Table,
}

/// What a curve tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurveOf {
    /// A demand.
    Demand(DemandColumn),
    /// This acceleration of a roof over the one of the same structure held to the table.
    FixedBaseRatio(DemandColumn),
    /// This acceleration, of a roof or of a block, over the peak of the table.
    Amplification(DemandColumn),
}

impl CurveOf {
    /// Its name in tables: the demand's, `storey3_fixed_base_ratio`, `block_amplification`.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Demand(demand) => demand.name(),
            Self::FixedBaseRatio(of) => format!("{}_fixed_base_ratio", place(of)),
            Self::Amplification(of) => format!("{}_amplification", place(of)),
        }
    }

    /// The SI unit of its values; empty where they have none.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Demand(demand) => demand.unit(),
            Self::FixedBaseRatio(_) | Self::Amplification(_) => "",
        }
    }
}

/// Where an acceleration is: `storey3`, `block`.
fn place(of: &DemandColumn) -> String {
    match of.demand.of.part() {
        Some(part) => format!("{part}{}", of.part),
        None => "block".to_owned(),
    }
}

/// Fractiles of one demand, or of a ratio of two, over the records.
#[derive(Clone, Debug, PartialEq)]
pub struct DemandCurves {
    /// What they tell.
    pub of: CurveOf,
    /// Fractiles of 16, 50 and 84 %, SI: group by group, one entry a value along the axis.
    pub fractiles: Vec<Vec<[f64; 3]>>,
    /// Curves of the single records, SI: group by group, record by record, one entry a value along
    /// the axis; NaN where a run has no answer.
    pub singles: Vec<Vec<Vec<f64>>>,
}

/// Demands that are always told, besides those of the roof.
const TOLD: [&str; 3] = [SLIDING, RESIDUAL, "sliding_path_m"];

/// The demand that is told without its sign.
const RESIDUAL: &str = "residual_sliding_displacement_m";

/// One run: its demands, and the peak of the table in m/s².
struct Run {
    demands: Vec<f64>,
    table: f64,
}

impl InNumbers for Run {
    fn numbers(&self) -> Option<Vec<f64>> {
        let mut numbers = self.demands.clone();
        numbers.push(self.table);
        Some(numbers)
    }

    fn of(mut numbers: Vec<f64>) -> Option<Self> {
        let table = numbers.pop()?;
        Some(Self { demands: numbers, table })
    }
}

impl SpectrumRequest<'_> {
    /// Number of runs, those of the fixed-base models apart.
    #[must_use]
    pub fn runs(&self) -> u64 {
        let designs =
            (self.models.grid().len() as u64).saturating_mul(self.bounds.len().max(1) as u64);
        designs.saturating_mul(self.suite.records.len() as u64)
    }
}

/// Runs a spectrum; the engine is told of every run but those of the fixed-base models.
///
/// # Errors
/// [`AssessmentError`] for an axis that does not rise, a demand that is none, scaling without an
/// answer, and where it is stopped. A run without an answer counts as above all others in sliding displacement
/// where it used up its travel; else it is left out of the fractiles.
pub fn run_spectrum(
    request: &SpectrumRequest<'_>,
    engine: &Engine<'_>,
) -> Result<SpectrumRun, AssessmentError> {
    let SpectrumRequest { models, suite, .. } = *request;
    let grid = models.grid();
    let Some((axis, groups_of)) = grid.axes().split_last() else {
        return Err(refuse("over", "PATH=VALUES", "nothing"));
    };
    if !axis.rises() {
        let found = "values that do not rise";
        return Err(refuse(&format!("over {}", axis.path), "values that rise", found));
    }
    let shape = models.shape();
    let roof = shape.roof_acceleration();
    let columns = models.columns();
    let mut told: Vec<(usize, DemandColumn)> = Vec::new();
    let asked = request.demands.iter().map(String::as_str);
    for name in TOLD.into_iter().chain([&*roof.name()]).chain(asked) {
        let place = models.column(name)?;
        if !told.iter().any(|(other, _)| *other == place) {
            told.push((place, columns[place]));
        }
    }
    let factors = suite.scaled(request.scaling, engine)?.factors;
    let records = suite.records.len();
    let bounds = if request.bounds.is_empty() { &[Bound::NOMINAL][..] } else { request.bounds };
    let nominal = models.all(records * bounds.len(), engine)?;
    let of_bound = |bound: &Bound, parts: &Result<Parts, RunError>| {
        let parts = parts.as_ref().map_err(Clone::clone)?;
        Ok(Parts { model: bound.of(&parts.model), ..parts.clone() })
    };
    let all = |bound| nominal.iter().map(move |parts| of_bound(bound, parts));
    let parts: Vec<Result<Parts, RunError>> = bounds.iter().flat_map(all).collect();
    let peak = |motion: &GroundMotion| {
        motion.horizontal_m_per_s2().iter().fold(0.0, |peak: f64, a| peak.max(a.abs()))
    };
    let cases = Case::every(grid.len(), bounds.len(), &factors);
    let design = |case: &Case| &parts[case.bound * grid.len() + case.design];
    let keep = |_: &Case, response: &Response, motion: &GroundMotion| Run {
        demands: demand_values(&response.demands),
        table: peak(motion),
    };
    let label = |design: usize| grid.label(design);
    let in_words = suite.in_words(request.bounds, &label);
    let of_suite = suite.runs(&factors, tail_s(&parts), engine)?;
    let mut runs = of_suite.all(&cases, design, keep)?;
    let same =
        |run: &Run, response: &Response| same_bits(&run.demands, &demand_values(&response.demands));
    let certified = of_suite.certify(&mut runs, design, same, |case| in_words.case(case))?;
    let has_structure = shape.storeys + shape.points > 0;
    let fixed =
        if has_structure { on_fixed_base(&parts, suite, &factors, engine)? } else { Vec::new() };
    let roof_place = models.column(&roof.name())?;
    let ratios = [CurveOf::FixedBaseRatio(roof), CurveOf::Amplification(roof)];
    let ratios = &ratios[usize::from(!has_structure)..];
    let nothing = f64::NAN;
    let ratio = |run: usize, of: &CurveOf| -> f64 {
        let Ok(kept) = &runs[run].kept else { return nothing };
        let roof = kept.demands[roof_place];
        let over = if let CurveOf::FixedBaseRatio(_) = of { fixed[run] } else { kept.table };
        // 0/0: nothing moves, and nothing is amplified.
        if roof == 0.0 && over == 0.0 { 0.0 } else { roof / over }
    };
    let of_demands = told.iter().map(|&(place, demand)| {
        let name = demand.name();
        let of = |ran: &CaseRun<Run>| match &ran.kept {
            Ok(run) if name == RESIDUAL => run.demands[place].abs(),
            Ok(run) => run.demands[place],
            Err(_) => Demanded::of(&name, nothing, ran.travel_used_up_m()).or_beyond(),
        };
        (CurveOf::Demand(demand), runs.iter().map(of).collect())
    });
    let of_ratios =
        ratios.iter().map(|of| (*of, (0..runs.len()).map(|run| ratio(run, of)).collect()));
    let values: Vec<(CurveOf, Vec<f64>)> = of_demands.chain(of_ratios).collect();
    let (length, of_grid) = (axis.values.len(), grid.len() / axis.values.len());
    let group_count = bounds.len() * of_grid;
    let at = |group: usize, i: usize| (group * length + i) * records;
    let curves: Vec<DemandCurves> = values
        .iter()
        .map(|(curve, values)| {
            let of = |group: usize, i: usize| fractiles(&values[at(group, i)..][..records]);
            let of_group = |group: usize| (0..length).map(|i| of(group, i)).collect();
            let finite = |value: f64| if value.is_finite() { value } else { nothing };
            let single = |group: usize, record: usize| -> Vec<f64> {
                (0..length).map(|i| finite(values[at(group, i) + record])).collect()
            };
            let singles = |group: usize| (0..records).map(|r| single(group, r)).collect();
            DemandCurves {
                of: *curve,
                fractiles: (0..group_count).map(of_group).collect(),
                singles: (0..group_count).map(singles).collect(),
            }
        })
        .collect();
    let groups = (0..group_count)
        .map(|group| grid.values(group % of_grid * length)[..groups_of.len()].to_vec())
        .collect();
    let group_paths = groups_of.iter().map(|axis| (axis.path.clone(), axis.unit.clone()));
    let window = curves.last().map_or(&[][..], |curves| &curves.fractiles[..]);
    let windows = window
        .iter()
        .map(|group| {
            let median: Vec<f64> = group.iter().map(|f| f[1]).collect();
            intervals_above(&axis.values, &median, 1.0)
        })
        .collect();
    let (failures, warnings) = (in_words.failures(&runs), in_words.noticed(&runs));

    let mut table = Table::default();
    let coordinates = |table: &mut Table, repeat: usize| {
        if !request.bounds.is_empty() {
            let of = |n: usize| bounds[n / repeat / grid.len()].name.to_owned();
            table.texts("friction", (0..parts.len() * repeat).map(of).collect());
        }
        for (i, axis) in grid.axes().iter().enumerate() {
            let of = |n: usize| grid.values(n / repeat % grid.len())[i];
            let cells = (0..parts.len() * repeat).map(of).collect();
            table.numbers(&axis.path, &axis.unit, cells);
        }
    };
    coordinates(&mut table, 1);
    for DemandCurves { of, fractiles, .. } in &curves {
        for (i, share) in ["p16", "p50", "p84"].into_iter().enumerate() {
            let cells = fractiles.iter().flatten().map(|f| f[i]).collect();
            table.numbers(&format!("{}_{share}", of.name()), of.unit(), cells);
        }
    }
    let mut rows = Table::default();
    rows.texts(
        "record",
        (0..runs.len()).map(|i| suite.records[i % records].name.clone()).collect(),
    );
    let of_runs: Vec<usize> = (0..runs.len()).map(|i| i % records).collect();
    rows.columns.extend(suite.intensities(request.scaling, &factors, &of_runs, engine)?.columns);
    rows.numbers("scale", "", of_runs.iter().map(|&record| factors[record]).collect());
    coordinates(&mut rows, records);
    for (i, column) in columns.iter().enumerate() {
        let of = |ran: &CaseRun<Run>| ran.kept.as_ref().map_or(f64::NAN, |run| run.demands[i]);
        rows.numbers(&column.name(), column.unit(), runs.iter().map(of).collect());
    }
    for (of, values) in &values[told.len()..] {
        rows.numbers(&of.name(), of.unit(), values.clone());
    }
    add_answers(&mut rows, &runs, models.shape().surfaces > 0);
    rows.texts("status", runs.iter().map(|ran| status(ran.kept.as_ref().err())).collect());
    Ok(SpectrumRun {
        over: axis.path.clone(),
        unit: axis.unit.clone(),
        values: axis.values.clone(),
        group_paths: group_paths.collect(),
        groups,
        group_bounds: match request.bounds {
            [] => Vec::new(),
            bounds => (0..group_count).map(|group| bounds[group / of_grid].name).collect(),
        },
        curves,
        windows,
        failures,
        certified,
        warnings,
        runs: runs.len(),
        table,
        rows,
    })
}

/// The peak of the roof of the same structures on a fixed base, for each design and record; NaN where there
/// is none.
fn on_fixed_base(
    parts: &[Result<Parts, RunError>],
    suite: &Suite,
    factors: &[f64],
    engine: &Engine<'_>,
) -> Result<Vec<f64>, Stopped> {
    // One structure on a fixed base serves all designs that share it, and its motion.
    let mut structures: Vec<Result<Parts, RunError>> = Vec::new();
    let mut of_design: Vec<Option<usize>> = Vec::with_capacity(parts.len());
    const LOOKED_BACK: usize = 256;
    for parts in parts {
        let held = parts.as_ref().ok().and_then(|parts| {
            Some(Parts { model: fixed_base(&parts.model).ok()?, ..parts.clone() })
        });
        let Some(held) = held else {
            of_design.push(None);
            continue;
        };
        let from = structures.len().saturating_sub(LOOKED_BACK);
        let alike = |other: &Result<Parts, RunError>| {
            other.as_ref().is_ok_and(|other| {
                same_structure(&other.model, &held.model)
                    && other.motion == held.motion
                    && other.tail_s == held.tail_s
            })
        };
        let known = structures[from..].iter().position(alike);
        of_design.push(Some(known.map_or(structures.len(), |i| from + i)));
        if known.is_none() {
            structures.push(Ok(held));
        }
    }
    let along = |record: &Record| {
        let motion = without_vertical(&record.motion);
        Record { motion: motion.unwrap_or_else(|_| record.motion.clone()), ..record.clone() }
    };
    let flat = Suite { records: suite.records.iter().map(along).collect(), ..suite.clone() };
    let tail_s = tail_s(&structures);
    // They are none of the runs that were asked for: nobody is told of them, and they stop with the others.
    let follow = |_| engine.done(0).map_or_else(|_| ControlFlow::Break(()), ControlFlow::Continue);
    let quiet = Engine::new(&follow);
    let all = Case::every(structures.len(), 1, factors);
    let design = |case: &Case| &structures[case.design];
    let peaks = flat.runs(factors, tail_s, &quiet)?.all(&all, design, |_, response, _| {
        let demands = &response.demands;
        demands.shape().roof_acceleration().value(demands).unwrap_or(f64::NAN)
    })?;
    let records = factors.len();
    let peak = |design: Option<usize>, record: usize| {
        let ran = design.and_then(|design| peaks.get(design * records + record));
        ran.and_then(|ran| ran.kept.as_ref().ok()).copied().unwrap_or(f64::NAN)
    };
    let of = |design: &Option<usize>| {
        let design = *design;
        (0..records).map(move |record| (design, record))
    };
    Ok(of_design.iter().flat_map(of).map(|(design, record)| peak(design, record)).collect())
}

/// The tail of the first design that there is.
fn tail_s(parts: &[Result<Parts, RunError>]) -> f64 {
    parts.iter().find_map(|parts| parts.as_ref().ok()).map_or(0.0, |parts| parts.tail_s)
}

/// Whether two models on a fixed base answer alike: all but the block and its slider is the same.
fn same_structure(a: &Model, b: &Model) -> bool {
    a.frame() == b.frame()
        && a.structure() == b.structure()
        && a.gravity_m_per_s2() == b.gravity_m_per_s2()
        && a.slider().tilt_rad == b.slider().tilt_rad
        && a.slider().tilt_y_rad == b.slider().tilt_y_rad
        && a.initial() == b.initial()
}
