//! `spectrum`, `ida`, `fragility`, `design`: many records to a decision.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipstick::assessment::AssessmentError;
use slipstick::assessment::design::{DesignRequest, Target, run_design};
use slipstick::assessment::grid;
use slipstick::assessment::ida::{IdaLevels, IdaRequest, run_ida};
use slipstick::assessment::models::Models;
use slipstick::assessment::observed::{FitTo, FragilityRequest, run_fragility};
use slipstick::assessment::spectrum::{SpectrumRequest, run_spectrum};
use slipstick::assessment::suite::{Scaling, Suite, SuiteRecord};
use slipstick::input::loaded::Loaded;
use slipstick::input::{Bound as FrictionBound, FrictionBounds};
use slipstick::motion::intensity::Measure;
use slipstick::record::Units;
use slipstick::table;
use slipstick_files::{OpenSuite, SuiteError, SuiteRequest, read_runs};
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::design::DesignReport;
use slipstick_report::assessment::fragility::FragilityReport;
use slipstick_report::assessment::ida::IdaFamily;
use slipstick_report::assessment::key;
use slipstick_report::assessment::spectrum::SpectrumReport;
use slipstick_report::assessment::{Sheet, Went};

use crate::errors::{of_argument, of_assessment, of_file};
use crate::model::Model;
use crate::motion::Motion;
use crate::table::Table;
use crate::work::followed;

/// A result as people and programs read it.
#[pyclass(module = "slipstick._core", frozen)]
pub struct Assessment {
    sheet: Sheet,
    call: &'static str,
    tables: Vec<(&'static str, Py<Table>)>,
}

impl Assessment {
    fn new(
        py: Python<'_>,
        call: &'static str,
        sheet: Sheet,
        tables: Vec<(&'static str, table::Table)>,
    ) -> PyResult<Self> {
        let new = |(name, table)| Ok((name, Py::new(py, Table(table))?));
        let tables = tables.into_iter().map(new).collect::<PyResult<Vec<_>>>()?;
        Ok(Self { sheet, call, tables })
    }
}

#[pymethods]
impl Assessment {
    /// The tables by their names.
    #[getter]
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tables = PyDict::new(py);
        for (name, table) in &self.tables {
            tables.set_item(name, table)?;
        }
        Ok(tables)
    }

    /// The figures as SVG by their names.
    fn _figures(&self) -> Vec<(&'static str, String)> {
        let figures = self.sheet.figures.iter();
        figures.map(|figure| (figure.id, figure.svg.as_str().to_owned())).collect()
    }

    /// What the command prints.
    #[getter]
    fn text(&self) -> String {
        self.sheet.to_text()
    }

    fn _summary_json(&self) -> String {
        self.sheet.to_json()
    }

    fn _report_html(&self) -> String {
        let went = Went { command_line: self.call, files: &[], inputs: &[] };
        self.sheet.to_html(&went)
    }
}

/// Reads the records of files, folders or patterns; names and motions.
#[pyfunction]
#[pyo3(signature = (patterns, *, channel = None, units = None, dt_s = None, vertical = Vec::new()))]
pub(crate) fn read_suite(
    py: Python<'_>,
    patterns: Vec<String>,
    channel: Option<String>,
    units: Option<&str>,
    dt_s: Option<f64>,
    vertical: Vec<String>,
) -> PyResult<Vec<(String, Motion)>> {
    let units = units.map(|text| {
        let expected = "units of records, such as \"g\" or \"cm/s2\"";
        Units::parse(text).ok_or_else(|| of_argument(py, "units", expected, text))
    });
    let units = units.transpose()?;
    let request =
        SuiteRequest { patterns, vertical, units, dt_s, channel, ..SuiteRequest::default() };
    let open = followed(py, None, None, |engine| OpenSuite::open(&request, engine))?;
    let open = open.map_err(|error| match error {
        SuiteError::File(error) => of_file(py, &error),
        SuiteError::Choice(error) => of_assessment(py, &AssessmentError::Choice(error)),
        SuiteError::Stopped(error) => of_assessment(py, &AssessmentError::Stopped(error)),
    })?;
    let records = open.suite.records.into_iter();
    Ok(records.map(|record| (record.name, Motion::of(record.motion))).collect())
}

/// Records under their names.
fn suite(records: Vec<(String, Motion)>) -> Suite {
    let records = records.into_iter().map(|(name, motion)| {
        let Loaded { motion, origin, .. } = motion.0.loaded;
        SuiteRecord { name, motion, pair: None, origin }
    });
    Suite { records: records.collect(), made: false }
}

fn models(
    py: Python<'_>,
    model: &Model,
    varied: &[(&str, String)],
    coupled: bool,
) -> PyResult<Models> {
    Models::new(&model.source, model.text(), &[], varied, coupled)
        .map_err(|error| of_assessment(py, &error))
}

/// The bounds of friction to run; none for a model without them.
fn bounds(py: Python<'_>, model: &Model, name: &str) -> PyResult<Vec<FrictionBound>> {
    if !["all", "lower", "nominal", "upper"].contains(&name) {
        let expected = "\"all\", \"lower\", \"nominal\" or \"upper\"";
        return Err(of_argument(py, "bounds", expected, &format!("{name:?}")));
    }
    let wanted = Some(name).filter(|name| *name != "all");
    FrictionBounds::chosen(model.analysis.friction_bounds, wanted)
        .map_err(|error| of_assessment(py, &AssessmentError::Choice(error)))
}

fn measure(py: Python<'_>, name: &str) -> PyResult<Measure> {
    Measure::parse(name).map_err(|error| {
        let found = format!("{:?}", error.found);
        of_argument(py, "measure", &error.expected, &found)
    })
}

/// How records are scaled, and that in words.
fn scaling(py: Python<'_>, name: &str, level: Option<&str>) -> PyResult<(Scaling, String)> {
    let Some(text) = level else {
        return Ok((Scaling::Factor(1.0), " as recorded".to_owned()));
    };
    Scaling::to_level("level", measure(py, name)?, text).map_err(|error| of_assessment(py, &error))
}

/// A share strictly between 0 and 1.
fn share(py: Python<'_>, name: &str, value: f64) -> PyResult<f64> {
    let inside = value > 0.0 && value < 1.0;
    inside
        .then_some(value)
        .ok_or_else(|| of_argument(py, name, "a share between 0 and 1", &value.to_string()))
}

/// A limit on a demand with its unit, in SI.
fn limit(py: Python<'_>, text: &str, demand: &str) -> PyResult<f64> {
    key::limit("limit", text, demand)
        .map_err(|error| of_assessment(py, &AssessmentError::Choice(error)))
}

/// Demands over one varied value, for every record.
#[pyfunction]
#[pyo3(signature = (
    model, records, over, *, vary = Vec::new(), friction = None, measure = "PGA", level = None,
    demands = Vec::new(), bounds = "all", jobs = None, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub(crate) fn spectrum(
    py: Python<'_>,
    model: &Model,
    records: Vec<(String, Motion)>,
    over: String,
    vary: Vec<String>,
    friction: Option<String>,
    measure: &str,
    level: Option<&str>,
    demands: Vec<String>,
    bounds: &str,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let mut varied: Vec<(&str, String)> = vary.into_iter().map(|text| ("vary", text)).collect();
    let coupled = friction.is_some();
    if let Some(values) = friction {
        varied.push(("friction", format!("slider.kinetic_friction={values}")));
    }
    varied.push(("over", over));
    let models = models(py, model, &varied, coupled)?;
    let (scaling, scaled) = scaling(py, measure, level)?;
    let (suite, bounds) = (suite(records), self::bounds(py, model, bounds)?);
    let request = SpectrumRequest {
        models: &models,
        suite: &suite,
        scaling,
        demands: &demands,
        bounds: &bounds,
    };
    let run = followed(py, jobs, progress, |engine| run_spectrum(&request, engine))?;
    let run = run.map_err(|error| of_assessment(py, &error))?;
    let sheet = SpectrumReport {
        name: model.name(),
        run: &run,
        records: &suite.names(),
        scaled: &scaled,
        warnings: &[],
        display: DisplayUnits::Si,
    }
    .sheet();
    let tables = vec![("spectrum", run.table), ("runs", run.rows)];
    Assessment::new(py, "slipstick.spectrum(model, records, over)", sheet, tables)
}

/// Incremental dynamic analysis.
#[pyfunction]
#[pyo3(signature = (
    model, records, *, levels = None, between = None, measure = "PGA",
    demand = "peak_sliding_displacement_m", limit = None, vary = Vec::new(), keep = Vec::new(),
    by = None, bounds = "all", jobs = None, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub(crate) fn ida(
    py: Python<'_>,
    model: &Model,
    records: Vec<(String, Motion)>,
    levels: Option<&str>,
    between: Option<&str>,
    measure: &str,
    demand: &str,
    limit: Option<&str>,
    vary: Vec<String>,
    keep: Vec<String>,
    by: Option<&str>,
    bounds: &str,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let varied: Vec<(&str, String)> = vary.into_iter().map(|text| ("vary", text)).collect();
    let models = models(py, model, &varied, false)?;
    models.column(demand).map_err(|error| of_assessment(py, &error))?;
    let of = self::measure(py, measure)?;
    let read = |name: &str, text: &str| {
        grid::levels(name, text, &of).map_err(|error| of_assessment(py, &error))
    };
    let at = match (levels, between) {
        (Some(text), None) => IdaLevels::Fixed(read("levels", text)?),
        (None, Some(text)) => match read("between", &format!("{text}:2"))?[..] {
            [start, top] => IdaLevels::Hunt { start, top },
            _ => return Err(of_argument(py, "between", "two levels, 0.05..2 g", text)),
        },
        (None, None) => {
            return Err(of_argument(py, "levels", "levels, or between for a hunt", "neither"));
        }
        (Some(_), Some(_)) => return Err(of_argument(py, "levels", "levels or between", "both")),
    };
    let fixed_levels = matches!(at, IdaLevels::Fixed(_));
    let gap_m = model.analysis.model.slider().gap_m;
    let limit = match limit {
        Some(text) => Some(self::limit(py, text, demand)?),
        None => gap_m.filter(|_| demand == "peak_sliding_displacement_m"),
    };
    let (suite, bounds) = (suite(records), self::bounds(py, model, bounds)?);
    let request = IdaRequest {
        models: &models,
        bounds: &bounds,
        suite: &suite,
        measure: of,
        demand,
        limit,
        levels: at,
        keep: &keep,
        by,
    };
    let run = followed(py, jobs, progress, |engine| run_ida(&request, engine))?;
    let run = run.map_err(|error| of_assessment(py, &error))?;
    let sheet = IdaFamily {
        name: model.name(),
        measure: &of,
        demand,
        limit,
        fixed_levels,
        run: &run,
        warnings: &[],
        display: DisplayUnits::Si,
    }
    .sheet();
    let mut tables = vec![("ida", run.rows)];
    tables.extend(run.capacities.map(|table| ("capacities", table)));
    Assessment::new(py, "slipstick.ida(model, records)", sheet, tables)
}

/// Designs that keep a gap with the least acceleration.
#[pyfunction]
#[pyo3(signature = (
    model, records, vary, *, friction = None, gap = None, probability = 0.9, demand = None,
    share = 0.5, measure = "PGA", level = None, bounds = None, sensitivity = 256, seed = 1,
    confidence = 0.9, jobs = None, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub(crate) fn design(
    py: Python<'_>,
    model: &Model,
    records: Vec<(String, Motion)>,
    vary: Vec<String>,
    friction: Option<String>,
    gap: Option<&str>,
    probability: f64,
    demand: Option<String>,
    share: f64,
    measure: &str,
    level: Option<&str>,
    bounds: Option<[f64; 2]>,
    sensitivity: u32,
    seed: u64,
    confidence: f64,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let coupled = friction.is_some();
    let of_friction =
        friction.map(|values| ("friction", format!("slider.kinetic_friction={values}")));
    let varied: Vec<(&str, String)> =
        of_friction.into_iter().chain(vary.into_iter().map(|text| ("vary", text))).collect();
    if varied.is_empty() {
        return Err(of_argument(py, "vary", "something to vary", "nothing"));
    }
    let models = models(py, model, &varied, coupled)?;
    let (scaling, scaled) = scaling(py, measure, level)?;
    let own_gap_m = model.analysis.model.slider().gap_m;
    let gap_m = match (gap, own_gap_m) {
        (Some(text), _) => limit(py, text, "peak_sliding_displacement_m")?,
        (None, Some(gap_m)) => gap_m,
        (None, None) => {
            return Err(of_argument(py, "gap", "a length (or slider.gap in the model)", "nothing"));
        }
    };
    let target = Target { gap_m, probability, acceleration_share: share };
    let of_model = || model.analysis.friction_bounds.map(|bounds| [bounds.lower, bounds.upper]);
    let bounds = bounds.or_else(of_model);
    let acceleration = demand.unwrap_or_else(|| models.roof_acceleration());
    let suite = suite(records);
    let request = DesignRequest {
        models: &models,
        suite: &suite,
        scaling,
        target,
        acceleration: &acceleration,
        bounds,
        sensitivity,
        seed,
        confidence: self::share(py, "confidence", confidence)?,
    };
    let run = followed(py, jobs, progress, |engine| run_design(&request, engine))?;
    let run = run.map_err(|error| of_assessment(py, &error))?;
    let sheet = DesignReport {
        name: model.name(),
        records: suite.records.len(),
        scaled: &scaled,
        target,
        run: &run,
        acceleration: &acceleration,
        bounds,
        confidence,
        warnings: &[],
        display: DisplayUnits::Si,
    }
    .sheet();
    let tables = vec![("front", run.front), ("runs", run.runs)];
    Assessment::new(py, "slipstick.design(model, records, vary)", sheet, tables)
}

/// A lognormal fragility of a table.
#[pyfunction]
#[pyo3(signature = (
    table, *, demand = "peak_sliding_displacement_m", limit = None, measure = None, units = None,
    fit_to = None, keep = Vec::new(), confidence = 0.9, bootstrap = None, jobs = None, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub(crate) fn fragility(
    py: Python<'_>,
    table: &Table,
    demand: &str,
    limit: Option<&str>,
    measure: Option<&str>,
    units: Option<&str>,
    fit_to: Option<&str>,
    keep: Vec<String>,
    confidence: f64,
    bootstrap: Option<(u32, u64)>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Assessment> {
    let limit = limit.map(|text| self::limit(py, text, demand)).transpose()?;
    let confidence = share(py, "confidence", confidence)?;
    let fit_to = match fit_to {
        None => None,
        Some("counts") => Some(FitTo::Counts),
        Some("capacities") => Some(FitTo::Capacities),
        Some("cloud") => Some(FitTo::Cloud),
        Some(other) => {
            let expected = "\"counts\", \"capacities\" or \"cloud\"";
            return Err(of_argument(py, "fit_to", expected, &format!("{other:?}")));
        }
    };
    let request = FragilityRequest {
        table: &table.0,
        source_name: "table",
        demand,
        limit,
        measure,
        units,
        fit_to,
        floor: None,
        cap: None,
        keep: &keep,
        bootstrap,
    };
    let run = followed(py, jobs, progress, |engine| run_fragility(&request, engine))?;
    let run = run.map_err(|error| of_assessment(py, &error))?;
    let report = FragilityReport {
        name: "table",
        demand,
        limit,
        run: &run,
        confidence,
        display: DisplayUnits::Si,
    };
    let curve = report.curve();
    let column = |i: usize| curve.iter().map(|row| row[i]).collect::<Vec<f64>>();
    let mut tabled = table::Table::default();
    tabled
        .numbers("level", &run.measure_unit, column(0))
        .numbers("probability", "", column(1))
        .numbers("band_low", "", column(2))
        .numbers("band_high", "", column(3));
    Assessment::new(py, "slipstick.fragility(table)", report.sheet(), vec![("fragility", tabled)])
}

/// Reads a table in CSV, or one in Parquet files.
#[pyfunction]
#[pyo3(name = "read_table")]
pub(crate) fn table_of_files(py: Python<'_>, files: Vec<std::path::PathBuf>) -> PyResult<Table> {
    let read = py.detach(|| read_runs(&files)).map_err(|error| of_file(py, &error))?;
    Ok(Table(read.table))
}
