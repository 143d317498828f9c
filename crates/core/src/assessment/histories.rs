//! Response-history analyses side by side: models on the records of suites, with lower- and
//! upper-bound friction, and what governs.

use super::lateral::LateralForce;
use super::single::{Job, Judged};
use super::suite::{PairScaling, Scaled, Suite, SuiteRecord};
use super::{AssessmentError, FailedRun};
use crate::error::RunError;
use crate::input::{Analysis, Bound, Names};
use crate::motion::target::Matched;
use crate::record::Origin;
use crate::response::{DemandColumn, DemandShape, Demands, Method, Warning, flat_geometry, struck};
use crate::study::engine::Engine;
use crate::table::{Cells, Column, Table};

/// From this number of records on their mean governs, of fewer the maximum (ASCE/SEI 7, chapter 17).
pub const RECORDS_OF_A_MEAN: usize = 7;

/// A model and the records that it is run on.
#[derive(Clone, Copy, Debug)]
pub struct ModelOn<'a> {
    /// Its name in tables.
    pub name: &'a str,
    /// The model and how it is analysed.
    pub analysis: &'a Analysis,
    /// The records.
    pub suite: &'a Suite,
}

/// A model on a record.
#[derive(Clone, Debug)]
pub struct OnRecord {
    /// Name of the record.
    pub record: String,
    /// Name of its pair, that of the first component; empty where it is in none.
    pub pair: String,
    /// What its file says of where it was recorded.
    pub origin: Origin,
    /// Factor on it.
    pub scale: f64,
    /// Peak of the horizontal acceleration as it was run, in m/s².
    pub pga_m_per_s2: f64,
    /// Why it has no answer, where it has none.
    pub failed: Option<FailedRun>,
    /// Demands with each bound of friction, in the order of [`ModelHistories::bounds`]; none where it failed.
    pub demands: Vec<Demands>,
    /// Whether the certificate of each holds; none where it failed.
    pub holds: Vec<bool>,
    /// Times in s and sliding displacements in m with nominal friction.
    pub sliding: [Vec<f64>; 2],
    /// What was noticed of it.
    pub warnings: Vec<Warning>,
}

impl OnRecord {
    /// The size of a demand with a bound of friction; NaN where there is none.
    #[must_use]
    pub fn size(&self, column: &DemandColumn, bound: usize) -> f64 {
        let value = self.demands.get(bound).and_then(|demands| column.value(demands));
        value.map_or(f64::NAN, f64::abs)
    }
}

/// A model on all its records.
#[derive(Clone, Debug)]
pub struct ModelHistories {
    /// Its name.
    pub name: String,
    /// What its block and its storeys are called.
    pub names: Names,
    /// The gap of its slider in m, where it has one.
    pub gap_m: Option<f64>,
    /// The bounds of friction that were run.
    pub bounds: Vec<Bound>,
    /// Its records in their order.
    pub records: Vec<OnRecord>,
    /// Of each bound the displacement of the equivalent-lateral-force procedure under the target spectrum,
    /// where there is one of both.
    pub lateral: Vec<Option<LateralForce>>,
}

/// What came of all models.
#[derive(Clone, Debug)]
pub struct Histories {
    /// The models in their order.
    pub models: Vec<ModelHistories>,
    /// What the models have that demands are asked of.
    pub shape: DemandShape,
    /// Every run: model, record, bound, scale, peak acceleration, whether its certificate holds, demands.
    pub runs: Table,
    /// What governs: model, bound, statistic, demands.
    pub governing: Table,
    /// How pairs were brought to a target spectrum, and their names.
    pub matched: Option<(Matched, Vec<String>)>,
}

impl ModelHistories {
    /// What the model has that demands are asked of.
    #[must_use]
    pub fn shape(&self) -> DemandShape {
        let first = self.records.iter().find_map(|on| on.demands.first());
        first.map_or_else(DemandShape::default, Demands::shape)
    }

    /// The records of each earthquake: both components of a pair, or a record alone.
    fn earthquakes(&self) -> impl Iterator<Item = &[OnRecord]> {
        self.records.chunk_by(|a, b| !a.pair.is_empty() && a.pair == b.pair)
    }

    /// The runs without an answer.
    pub fn failures(&self) -> impl Iterator<Item = &FailedRun> {
        self.records.iter().filter_map(|on| on.failed.as_ref())
    }

    /// Whether the records are pairs of components.
    #[must_use]
    pub fn has_pairs(&self) -> bool {
        self.records.iter().any(|on| !on.pair.is_empty())
    }

    /// Number of pairs, or of records alone.
    #[must_use]
    pub fn counted(&self) -> usize {
        self.earthquakes().count()
    }

    /// Name of the statistic that governs: `mean` from [`RECORDS_OF_A_MEAN`] records or pairs on, else
    /// `maximum`.
    #[must_use]
    pub fn statistic(&self) -> &'static str {
        if self.counted() >= RECORDS_OF_A_MEAN { "mean" } else { "maximum" }
    }

    /// The sizes of a demand with a bound of friction, record by record; NaN where there is none.
    #[must_use]
    pub fn sizes(&self, column: &DemandColumn, bound: usize) -> Vec<f64> {
        self.records.iter().map(|on| on.size(column, bound)).collect()
    }

    /// The mean of these sizes, or their maximum; of a pair the larger of both components counts. NaN where
    /// a record has none.
    #[must_use]
    pub fn governing(&self, column: &DemandColumn, bound: usize) -> f64 {
        let sizes = self.sizes(column, bound);
        if sizes.iter().any(|size| size.is_nan()) {
            return f64::NAN;
        }
        let largest = |sizes: &[f64]| sizes.iter().fold(0.0, |most: f64, size| most.max(*size));
        let mut left = &sizes[..];
        let of_each = self.earthquakes().map(|records| {
            let (own, rest) = left.split_at(records.len());
            left = rest;
            largest(own)
        });
        let of_each: Vec<f64> = of_each.collect();
        match self.statistic() {
            "mean" => of_each.iter().sum::<f64>() / of_each.len() as f64,
            _ => largest(&of_each),
        }
    }

    /// The bound with which a demand governs, and the demand; `None` where no record has it.
    #[must_use]
    pub fn governs(&self, column: &DemandColumn) -> Option<(&Bound, f64)> {
        self.governing_bound(column).map(|i| (&self.bounds[i], self.governing(column, i)))
    }

    /// Index of the bound with which a demand governs.
    #[must_use]
    pub fn governing_bound(&self, column: &DemandColumn) -> Option<usize> {
        let all = (0..self.bounds.len()).map(|i| (i, self.governing(column, i)));
        let all = all.filter(|(_, value)| !value.is_nan());
        all.reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(i, _)| i)
    }
}

/// Runs every model on every one of its records, each component of a pair by itself, and with the bounds of friction that it gives.
///
/// # Errors
/// [`AssessmentError`] for records that cannot be scaled so. A record without an answer is one with its reason,
/// and with it there is no mean or maximum.
pub fn run_histories(
    models: &[ModelOn<'_>],
    scaling: &PairScaling,
    engine: &Engine<'_>,
) -> Result<Histories, AssessmentError> {
    let mut done = Vec::with_capacity(models.len());
    let mut matched = None;
    for model in models {
        let Scaled { factors, matched: of_target } = model.suite.scaled(scaling, engine)?;
        let pairs = (0..factors.len()).step_by(2).map(|i| model.suite.pair_name(i).to_owned());
        matched = matched.or(of_target.map(|matched| (matched, pairs.collect())));
        let run = |i: usize| on_record(model, i, factors[i]);
        let records = engine.runs(model.suite.records.len(), run)?;
        done.push(ModelHistories {
            name: model.name.to_owned(),
            names: model.analysis.names.clone(),
            gap_m: model.analysis.model.slider().gap_m,
            lateral: lateral(model.analysis, scaling),
            bounds: bounds(model.analysis),
            records,
        });
    }
    let shapes = done.iter().map(ModelHistories::shape);
    let shape = shapes.fold(DemandShape::default(), |all, shape| DemandShape {
        storeys: all.storeys.max(shape.storeys),
        stop: all.stop || shape.stop,
        surfaces: all.surfaces.max(shape.surfaces),
        contents: all.contents.max(shape.contents),
    });
    let (runs, governing) = (table_of_runs(&done, shape), table_of_governing(&done, shape));
    Ok(Histories { models: done, shape, runs, governing, matched })
}

/// The bounds of friction that an analysis asks for.
fn bounds(analysis: &Analysis) -> Vec<Bound> {
    analysis.friction_bounds.map_or_else(|| vec![Bound::NOMINAL], |bounds| bounds.all().to_vec())
}

/// The procedure's displacement with each bound under the spectrum that the records are brought to.
fn lateral(analysis: &Analysis, scaling: &PairScaling) -> Vec<Option<LateralForce>> {
    let PairScaling::Target(spectrum, _) = scaling else { return Vec::new() };
    let of = |bound: &Bound| LateralForce::of(&bound.of(&analysis.model), spectrum);
    bounds(analysis).iter().map(of).collect()
}

fn on_record(model: &ModelOn<'_>, record: usize, scale: f64) -> OnRecord {
    let SuiteRecord { name, origin, .. } = &model.suite.records[record];
    let mut on = OnRecord {
        record: name.clone(),
        pair: model.suite.pair_name(record).to_owned(),
        origin: origin.clone(),
        scale,
        pga_m_per_s2: f64::NAN,
        failed: None,
        demands: Vec::new(),
        holds: Vec::new(),
        sliding: [Vec::new(), Vec::new()],
        warnings: Vec::new(),
    };
    if let Err(error) = run_on(model, record, &mut on) {
        on.failed = Some(FailedRun { record: name.clone(), scale, design: String::new(), error });
    }
    on
}

/// Runs the model on a record and keeps what the table tells.
fn run_on(model: &ModelOn<'_>, record: usize, on: &mut OnRecord) -> Result<(), RunError> {
    let motion = model.suite.motion(record, on.scale, 0.0)?;
    on.pga_m_per_s2 = motion.figures().pga_m_per_s2;
    let job = Job::new(model.analysis.clone(), motion, Vec::new())?;
    on.warnings.clone_from(&job.warnings);
    let outcome = job.run(false)?;
    let mut nominal = outcome.nominal;
    let history = nominal.response.history.take().unwrap_or_default();
    on.sliding = [history.time_s, history.sliding_displacement_m];
    let judged = match outcome.bounds {
        None => vec![nominal],
        Some([lower, upper]) => vec![lower, nominal, upper],
    };
    let bounds = bounds(model.analysis);
    for (Judged { model, response, certificate, .. }, bound) in judged.into_iter().zip(&bounds) {
        let of_bound = |warning: Warning| match bounds.len() {
            1 => warning,
            _ => {
                let message = format!("{} friction: {}", bound.name, warning.message);
                Warning { message, ..warning }
            }
        };
        let met = struck(&model, &response.demands).into_iter();
        let met = met.chain(flat_geometry(&model, &response.demands)).map(of_bound);
        on.warnings.extend(response.warnings.into_iter().chain(met));
        on.holds.push(response.method == Method::Stepwise || certificate.holds());
        on.demands.push(response.demands);
    }
    Ok(())
}

/// Every run as a row.
fn table_of_runs(models: &[ModelHistories], shape: DemandShape) -> Table {
    let mut rows = Vec::new();
    for model in models {
        for on in &model.records {
            rows.extend((0..model.bounds.len()).map(|i| (model, on, i)));
        }
    }
    let mut table = Table::default();
    table
        .texts("model", rows.iter().map(|(model, ..)| model.name.clone()).collect())
        .texts("record", rows.iter().map(|(_, on, _)| on.record.clone()).collect())
        .texts("friction", rows.iter().map(|(m, _, i)| m.bounds[*i].name.to_owned()).collect());
    if models.iter().any(ModelHistories::has_pairs) {
        table.texts("pair", rows.iter().map(|(_, on, _)| on.pair.clone()).collect());
    }
    table.numbers("scale", "", rows.iter().map(|(_, on, _)| on.scale).collect()).numbers(
        "pga_m_per_s2",
        "m/s2",
        rows.iter().map(|(_, on, _)| on.pga_m_per_s2).collect(),
    );
    let holds = rows.iter().map(|(_, on, i)| on.holds.get(*i).copied()).collect();
    table.columns.push(Column {
        name: "holds".to_owned(),
        unit: String::new(),
        cells: Cells::Flags(holds),
    });
    for column in shape.columns() {
        let value = |(_, on, i): &(_, &OnRecord, usize)| {
            on.demands.get(*i).and_then(|demands| column.value(demands)).unwrap_or(f64::NAN)
        };
        table.numbers(&column.name(), column.unit(), rows.iter().map(value).collect());
    }
    let status = |on: &OnRecord| {
        on.failed.as_ref().map_or_else(|| "ok".to_owned(), |failed| failed.error.to_string())
    };
    table.texts("status", rows.iter().map(|(_, on, _)| status(on)).collect());
    table
}

/// What governs, a row a model and bound.
fn table_of_governing(models: &[ModelHistories], shape: DemandShape) -> Table {
    let rows: Vec<(&ModelHistories, usize)> =
        models.iter().flat_map(|model| (0..model.bounds.len()).map(move |i| (model, i))).collect();
    let mut table = Table::default();
    table
        .texts("model", rows.iter().map(|(model, _)| model.name.clone()).collect())
        .texts("friction", rows.iter().map(|(m, i)| m.bounds[*i].name.to_owned()).collect())
        .texts("statistic", rows.iter().map(|(model, _)| model.statistic().to_owned()).collect());
    let governs = |column: &DemandColumn| column.demand.row.is_some_and(|row| row.governs);
    for column in shape.columns().iter().filter(|column| governs(column)) {
        let values = rows.iter().map(|(model, i)| model.governing(column, *i)).collect();
        table.numbers(&column.name(), column.unit(), values);
    }
    table
}
