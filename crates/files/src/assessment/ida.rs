//! Runs of an incremental dynamic analysis.

use slipstick::assessment::fragility::{Capacity, Fragility};
use slipstick::assessment::ida::{Curve, Hunt};
use slipstick::error::FitError;
use slipstick::motion::intensity::Measure;

use super::models::{demands, motion_of};
use super::suite::Suite;
use super::table::Table;
use super::{AssessmentError, Models, refuse, threads};

/// How levels are chosen.
#[derive(Clone, Debug, PartialEq)]
pub enum IdaLevels {
    /// The same for all records, in SI, rising.
    Fixed(Vec<f64>),
    /// Sought for each record, between these two.
    Hunt {
        /// First level tried.
        start: f64,
        /// Highest level tried.
        top: f64,
    },
}

/// An incremental dynamic analysis to be run.
#[derive(Clone, Debug)]
pub struct IdaRequest<'a> {
    /// The model: a grid of one.
    pub models: &'a Models,
    /// The records.
    pub suite: &'a Suite,
    /// The measure.
    pub measure: Measure,
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on it, SI; a hunt needs one.
    pub limit: Option<f64>,
    /// The levels.
    pub levels: IdaLevels,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct IdaRun {
    /// The records' curves of the demand.
    pub curves: Vec<Curve>,
    /// A lognormal fit of the capacities, where there is a limit.
    pub fit: Option<Result<Fragility, FitError>>,
    /// Messages of failed runs.
    pub failures: Vec<String>,
    /// A row a run: record, level, scale, all demands.
    pub rows: Table,
    /// A row a record, where there is a limit.
    pub capacities: Option<Table>,
}

/// A run of a record: its level and factor, demands or the reason why there are none.
struct Run {
    level: f64,
    scale: f64,
    demands: Result<Vec<f64>, String>,
}

/// Runs an incremental dynamic analysis.
///
/// # Errors
/// [`AssessmentError`] for a demand that is none, levels that do not rise, a hunt without a limit,
/// and records that cannot be scaled. A run that fails counts as above any limit.
pub fn run_ida(request: &IdaRequest) -> Result<IdaRun, AssessmentError> {
    let IdaRequest { models, suite, measure, .. } = request;
    let column = models.column(request.demand)?;
    let hunt = match &request.levels {
        IdaLevels::Fixed(levels) => {
            let rise = levels.windows(2).all(|pair| pair[0] < pair[1]);
            if levels.is_empty() || !rise || !(levels[0] > 0.0) {
                return Err(refuse("--levels", "levels > 0 that rise", format!("{levels:?}")));
            }
            None
        }
        IdaLevels::Hunt { start, top } => {
            let Some(limit) = request.limit else {
                return Err(refuse("--to", "the limit to hunt for, or slider.gap", "nothing"));
            };
            Some(Hunt::new(limit, *start, *top)?)
        }
    };
    let unscaled = suite.measure(measure)?;
    let parts = models.parts(&[])?;
    let one = |record: usize, level: f64| -> Run {
        let scale = level / unscaled[record];
        let motion = motion_of(suite, record, scale, &parts);
        let demands = motion.and_then(|motion| demands(&parts.model, &motion));
        Run { level, scale, demands }
    };
    let records = suite.records.len();
    let all: Vec<Vec<Run>> = match (&request.levels, &hunt) {
        (IdaLevels::Fixed(levels), _) => {
            let n = levels.len();
            let mut runs = threads::map(records * n, |i| one(i / n, levels[i % n])).into_iter();
            (0..records).map(|_| runs.by_ref().take(n).collect()).collect()
        }
        (_, Some(hunt)) => threads::map(records, |record| {
            let mut runs: Vec<Run> = Vec::new();
            hunt.run(|level| {
                let run = one(record, level);
                let demand = run.demands.as_ref().map_or(f64::NAN, |values| values[column]);
                runs.push(run);
                demand.abs()
            });
            runs.sort_by(|a, b| a.level.total_cmp(&b.level));
            runs
        }),
        _ => Vec::new(),
    };
    let curves: Vec<Curve> = all
        .iter()
        .map(|runs| {
            let demand = |run: &Run| run.demands.as_ref().map_or(f64::NAN, |v| v[column].abs());
            Curve {
                levels: runs.iter().map(|run| run.level).collect(),
                demands: runs.iter().map(demand).collect(),
            }
        })
        .collect();
    let names = suite.names();
    let failures = all
        .iter()
        .zip(&names)
        .flat_map(|(runs, name)| {
            let message = |run: &Run| run.demands.as_ref().err().map(|e| format!("{name}: {e}"));
            runs.iter().filter_map(message).collect::<Vec<_>>()
        })
        .collect();
    let (fit, capacities) = match request.limit {
        None => (None, None),
        Some(limit) => {
            let (fit, table) = capacities(&curves, limit, &names, measure);
            (Some(fit), Some(table))
        }
    };
    let flat: Vec<(&String, &Run)> = all
        .iter()
        .zip(&names)
        .flat_map(|(runs, name)| runs.iter().map(move |run| (name, run)))
        .collect();
    let mut rows = Table::default();
    rows.texts("record", flat.iter().map(|(name, _)| (*name).clone()).collect());
    rows.texts("measure", vec![measure.to_string(); flat.len()]);
    rows.numbers("level", measure.unit(), flat.iter().map(|(_, run)| run.level).collect());
    rows.numbers("scale", "", flat.iter().map(|(_, run)| run.scale).collect());
    for (i, column) in models.columns().iter().enumerate() {
        let of = |(_, run): &(&String, &Run)| run.demands.as_ref().map_or(f64::NAN, |v| v[i]);
        rows.numbers(&column.name, column.unit, flat.iter().map(of).collect());
    }
    let status =
        |(_, run): &(&String, &Run)| run.demands.as_ref().err().cloned().unwrap_or("ok".to_owned());
    rows.texts("status", flat.iter().map(status).collect());
    Ok(IdaRun { curves, fit, failures, rows, capacities })
}

/// The lognormal fit of the first crossings, and their table.
fn capacities(
    curves: &[Curve],
    limit: f64,
    names: &[String],
    measure: &Measure,
) -> (Result<Fragility, FitError>, Table) {
    let crossings: Vec<_> = curves.iter().map(|curve| curve.first_crossing(limit)).collect();
    let of =
        |c: &slipstick::assessment::ida::Crossing| Capacity { level: c.level, reached: c.reached };
    let fit = Fragility::of_capacities(&crossings.iter().map(of).collect::<Vec<_>>());
    let unit = measure.unit();
    let mut table = Table::default();
    table
        .texts("record", names.to_vec())
        .texts("measure", vec![measure.to_string(); names.len()])
        .numbers("capacity", unit, crossings.iter().map(|c| c.level).collect())
        .numbers("reached", "", crossings.iter().map(|c| f64::from(u8::from(c.reached))).collect())
        .numbers("below", unit, crossings.iter().map(|c| c.between[0]).collect())
        .numbers("above", unit, crossings.iter().map(|c| c.between[1]).collect())
        .numbers(
            "returns",
            unit,
            crossings.iter().map(|c| c.returns.unwrap_or(f64::NAN)).collect(),
        );
    (fit, table)
}
