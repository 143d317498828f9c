//! `compare` and `identify`: tests of a laboratory beside models.

use std::path::{Path, PathBuf};

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipstick::input::Mapping;
use slipstick::laboratory::compare::{self, Comparison as Compared, Within};
use slipstick::laboratory::estimate::Outcome;
use slipstick::laboratory::identify::{Identified as Estimates, IdentifyError, ModelText};
use slipstick::laboratory::measured::Measured;
use slipstick::record::{Column, Columns};
use slipstick::requests::{Comparing, Kind};
use slipstick::table;
use slipstick_files::{InputFiles, SourceFile, TextFile, expand_all, read_mapping, read_measured};
use slipstick_report::assessment::Sheet;
use slipstick_report::laboratory::identify as told;
use slipstick_report::{CompareReport, DisplayUnits};

use crate::errors::{of_choice, of_compare, of_file, of_identify, of_laboratory};
use crate::model::Model;
use crate::motion::Motion;
use crate::requests::{FieldTexts, asked};
use crate::response::display_units;
use crate::table::Table;
use crate::work::followed;

/// A measured file, or its columns by name.
#[derive(FromPyObject)]
pub(crate) enum MeasuredFile<'py> {
    Path(PathBuf),
    Columns(Vec<(String, PyReadonlyArray1<'py, f64>)>),
}

/// The columns of a measured file: a mapping file, and what is said beside it.
pub(crate) struct Columned {
    mapping: Mapping,
    file: Option<TextFile>,
}

impl Columned {
    fn new(py: Python<'_>, said: &[String]) -> PyResult<Self> {
        let (mapping, file) = read_mapping(said).map_err(|error| of_laboratory(py, &error))?;
        Ok(Self { mapping, file })
    }

    /// What is measured; of a file, where it is.
    fn read(
        &self,
        py: Python<'_>,
        given: &MeasuredFile<'_>,
    ) -> PyResult<(Measured, Option<SourceFile>)> {
        match given {
            MeasuredFile::Path(path) => {
                let read = py.detach(|| read_measured(path, &self.mapping));
                let (measured, source) = read.map_err(|error| of_laboratory(py, &error))?;
                Ok((measured, Some(source)))
            }
            MeasuredFile::Columns(columns) => {
                let column = |(name, values): &(String, PyReadonlyArray1<'_, f64>)| {
                    let values = values.as_slice()?.to_vec();
                    Ok(Column { is_time: false, name: name.clone(), values })
                };
                let columns: PyResult<Vec<Column>> = columns.iter().map(column).collect();
                let columns = Columns::new("measured", columns?).map_err(|e| e.into());
                let read = columns.and_then(|c| Measured::of_columns(c, &self.mapping));
                Ok((read.map_err(|error| of_laboratory(py, &error.into()))?, None))
            }
        }
    }
}

/// What went in.
fn inputs(
    model: Option<&Model>,
    sources: &[Option<SourceFile>],
    columned: &Columned,
) -> InputFiles {
    let of_model = |model: &Model| InputFiles::model(&model.title(), model.text().as_bytes());
    let inputs = model.map(of_model).unwrap_or_default();
    inputs.with_tests(sources.iter().flatten(), columned.file.as_ref())
}

/// Tables by name.
fn tables<'py, S: AsRef<str>>(
    py: Python<'py>,
    tables: Vec<(S, table::Table)>,
) -> PyResult<Bound<'py, PyDict>> {
    let named = PyDict::new(py);
    for (name, table) in tables {
        named.set_item(name.as_ref(), Table(table))?;
    }
    Ok(named)
}

/// A prediction beside what was measured.
#[pyclass(module = "slipstick._core", frozen)]
pub struct Comparison {
    model: Model,
    measured: String,
    comparison: Compared,
    within: Vec<Within>,
    inputs: InputFiles,
}

impl Comparison {
    fn report<T>(&self, display: DisplayUnits, tell: impl FnOnce(&CompareReport<'_>) -> T) -> T {
        tell(&CompareReport {
            name: &self.model.title(),
            model_hash: Some(&self.model.analysis.hash()),
            measured: &self.measured,
            model: &self.model.analysis.model,
            method: self.model.analysis.method,
            comparison: &self.comparison,
            within: &self.within,
            display,
        })
    }
}

#[pymethods]
impl Comparison {
    /// The measured table acceleration.
    #[getter]
    fn motion(&self) -> Motion {
        Motion::of(self.comparison.motion.clone())
    }

    /// Whether every bound is kept.
    #[getter]
    fn holds(&self) -> bool {
        self.report(DisplayUnits::Si, |report| report.missed().is_empty())
    }

    /// How near the prediction is, in sentences.
    #[getter]
    fn verdict(&self) -> Vec<String> {
        self.report(DisplayUnits::Si, |report| report.verdict())
    }

    /// The figures as a table.
    #[getter]
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables(py, vec![("figures", self.comparison.table())])
    }

    /// Measured and predicted values by quantity.
    #[getter]
    fn curves<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables(py, self.comparison.curves())
    }

    /// The figures as SVG by their names.
    fn _figures(&self) -> Vec<(String, String)> {
        let figures = self.report(DisplayUnits::Si, |report| report.figures());
        figures.into_iter().map(|figure| (figure.id, figure.svg.as_str().to_owned())).collect()
    }

    fn _text(&self, py: Python<'_>, units: &str) -> PyResult<String> {
        Ok(self.report(display_units(py, units)?, |report| report.sheet().to_text()))
    }

    fn _summary_json(&self) -> String {
        self.report(DisplayUnits::Si, |report| report.sheet().to_json())
    }

    fn _report_html(&self, py: Python<'_>, units: &str) -> PyResult<String> {
        let sheet = self.report(display_units(py, units)?, |report| report.sheet());
        Ok(self.inputs.page(&sheet, "slipstick.compare(measured, model)"))
    }
}

/// Predicts a measured test and compares.
#[pyfunction]
#[pyo3(signature = (measured, model, given))]
pub(crate) fn compare_with(
    py: Python<'_>,
    measured: MeasuredFile<'_>,
    mut model: Model,
    given: FieldTexts,
) -> PyResult<Comparison> {
    let asked = asked(py, Kind::Compare.name(), given)?;
    let Comparing { within, method } = asked.comparing().map_err(|error| of_choice(py, &error))?;
    model.analysis.method = method.unwrap_or(model.analysis.method);
    let columned = Columned::new(py, &asked.mapping())?;
    let (measured, source) = columned.read(py, &measured)?;
    let (of, method) = (&model.analysis.model, model.analysis.method);
    let comparison = followed(py, Some(1), None, |_| compare::compare(&measured, of, method))?;
    Ok(Comparison {
        measured: measured.source_name,
        comparison: comparison.map_err(|error| of_compare(py, &error))?,
        within,
        inputs: inputs(Some(&model), &[source], &columned),
        model,
    })
}

/// Parameters from tests.
#[pyclass(module = "slipstick._core", frozen)]
pub struct Identified {
    measured: Vec<Measured>,
    found: Estimates,
    model: Option<Model>,
    inputs: InputFiles,
    call: &'static str,
}

impl Identified {
    fn new(
        py: Python<'_>,
        call: &'static str,
        measured: Vec<Measured>,
        found: Result<Estimates, IdentifyError>,
        inputs: InputFiles,
    ) -> PyResult<Self> {
        let found = found.map_err(|error| of_identify(py, &error))?;
        let model = found.model.clone().map(Model::of);
        Ok(Self { measured, found, model, inputs, call })
    }

    fn sheet(&self, display: DisplayUnits) -> Sheet {
        told::sheet(&self.measured, &self.found, display)
    }
}

/// Path, SI unit, value, ends of the interval, reason where there are none.
type EstimateParts = (String, &'static str, Option<f64>, Option<f64>, Option<f64>, Option<String>);

#[pymethods]
impl Identified {
    /// The estimates.
    fn _estimates(&self) -> Vec<EstimateParts> {
        let parts = self.found.estimates.iter().map(|estimate| {
            let (path, unit) = (estimate.path.clone(), estimate.unit);
            match &estimate.outcome {
                Outcome::Told { value, low, high } => {
                    (path, unit, Some(*value), Some(*low), Some(*high), None)
                }
                Outcome::CannotTell { why } => (path, unit, None, None, None, Some(why.clone())),
            }
        });
        parts.collect()
    }

    /// The given model with what was told.
    #[getter]
    fn model(&self) -> Option<Model> {
        self.model.clone()
    }

    /// Whether the data tell every parameter.
    #[getter]
    fn holds(&self) -> bool {
        self.found.estimates.iter().all(|estimate| estimate.value().is_some())
    }

    /// What the data tell and what they do not, in sentences.
    #[getter]
    fn verdict(&self) -> Vec<String> {
        self.sheet(DisplayUnits::Si).verdict
    }

    /// The tables by name.
    #[getter]
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables(py, self.found.tables(&self.measured))
    }

    /// What was fitted, with the fit.
    #[getter]
    fn curves<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables(py, self.found.curves(&self.measured))
    }

    /// The figures as SVG by their names.
    fn _figures(&self) -> Vec<(String, String)> {
        let figures = self.sheet(DisplayUnits::Si).figures.into_iter();
        figures.map(|figure| (figure.id, figure.svg.as_str().to_owned())).collect()
    }

    fn _text(&self, py: Python<'_>, units: &str) -> PyResult<String> {
        Ok(self.sheet(display_units(py, units)?).to_text())
    }

    fn _summary_json(&self) -> String {
        self.sheet(DisplayUnits::Si).to_json()
    }

    fn _report_html(&self, py: Python<'_>, units: &str) -> PyResult<String> {
        Ok(self.inputs.page(&self.sheet(display_units(py, units)?), self.call))
    }
}

/// Parameters of a model from tests: cyclic tests, free vibration or a shaking-table record.
#[pyfunction]
#[pyo3(signature = (kind, tests, model, given, *, jobs = None, progress = None))]
pub(crate) fn identify(
    py: Python<'_>,
    kind: &str,
    tests: Vec<MeasuredFile<'_>>,
    model: Option<Model>,
    given: FieldTexts,
    jobs: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Identified> {
    let asked = asked(py, kind, given)?;
    let columned = Columned::new(py, &asked.mapping())?;
    let (mut measured, mut sources) = (Vec::new(), Vec::new());
    for test in tests {
        let expanded = match test {
            MeasuredFile::Path(path) => {
                let files = expand_all(Path::new(""), &[path.to_string_lossy()])
                    .map_err(|error| of_file(py, &error))?;
                files.into_iter().map(MeasuredFile::Path).collect()
            }
            columns @ MeasuredFile::Columns(_) => vec![columns],
        };
        for one in expanded {
            let (one, source) = columned.read(py, &one)?;
            measured.push(one);
            sources.push(source);
        }
    }
    let on = model.as_ref();
    let on = on.map(|model| ModelText { name: &model.source, text: model.text(), set: &[] });
    let found = followed(py, jobs, progress, |engine| asked.identify(on, &measured, engine))?;
    let inputs = inputs(model.as_ref(), &sources, &columned);
    let call = match asked.kind() {
        Kind::Cyclic => "slipstick.identify.cyclic(tests)",
        Kind::FreeVibration => "slipstick.identify.free_vibration(measured)",
        _ => "slipstick.identify.shaking_table(measured, model, fit)",
    };
    Identified::new(py, call, measured, found, inputs)
}
