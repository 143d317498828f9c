//! Which column holds the intensities, of what measure and in what unit.

use super::FragilityRequest;
use super::columns::{Columns, any_unit};
use crate::assessment::{AssessmentError, ChoiceError, refuse};
use crate::motion::intensity::{IntensityMeasures, Measure};
use crate::units::{Dimension, Unit, parse_unit};

/// The intensities of a table.
#[derive(Clone, Debug)]
pub(super) struct Intensity {
    /// Name of the measure.
    pub(super) measure: String,
    /// Its SI unit; empty where it has none.
    pub(super) unit: String,
    /// The column.
    column: String,
    /// The unit in which the column is written; `None` where it has none.
    written: Option<&'static Unit>,
}

impl Intensity {
    /// # Errors
    /// [`AssessmentError::Choice`] for a column that is not there, and where no unit is stated.
    pub(super) fn of(
        request: &FragilityRequest<'_>,
        columns: Columns<'_>,
    ) -> Result<Self, AssessmentError> {
        let levels =
            if columns.intensity("capacity").is_some() && columns.intensity("level").is_none() {
                "capacity"
            } else {
                "level"
            };
        let of_levels = columns.intensity(levels).map(|column| column.name.clone());
        let told = |levels: &String| of_equal_column(columns, levels);
        let said = columns.first_text("measure").or_else(|| of_levels.as_ref().and_then(told));
        let Some(asked) = request.measure else {
            let Some(column) = of_levels else { return Err(columns.lacking("measure", levels)) };
            let measure = said.clone().unwrap_or_default();
            let found = Self::in_unit(request, columns, measure, column.clone())?;
            return said.map(|_| found).ok_or_else(|| unsaid(columns, &column));
        };
        let parsed = Measure::parse(asked).ok();
        let same = |said: &String| {
            *said == asked || parsed.is_some_and(|parsed| Measure::parse(said).ok() == Some(parsed))
        };
        if let Some(column) = &of_levels
            && said.as_ref().is_some_and(same)
        {
            return Self::in_unit(request, columns, asked.to_owned(), column.clone());
        }
        let candidates = [Some(asked.to_owned()), parsed.map(|measure| measure.column())];
        let known = candidates.into_iter().flatten().find(|column| columns.has(column));
        if let Some(column) = known {
            let own = of_levels.clone().filter(|levels| same_values(columns, levels, &column));
            return Self::in_unit(request, columns, asked.to_owned(), own.unwrap_or(column));
        }
        if let Some(column) = of_levels
            && let Some(measure) = parsed
        {
            return match said {
                // The levels are of another measure, and the table has no column of this one.
                Some(said) => {
                    let expected = format!(
                        "{said}, of which the levels of {} are, or a measure it has a column of",
                        columns.source_name
                    );
                    Err(refuse("measure", expected, format!("{asked:?}")))
                }
                // Runs with factors were scaled to some measure, and whoever wrote them knows it.
                None if columns.has("scale") => Err(unsaid(columns, &column)),
                // A table of levels that does not say of what: the option does.
                None => Self::in_unit(request, columns, measure.to_string(), column),
            };
        }
        let column = parsed.map_or_else(|| asked.to_owned(), |measure| measure.column());
        Err(columns.lacking("measure", &column))
    }

    /// The column in the unit that is stated: by its name, its table or the request.
    fn in_unit(
        request: &FragilityRequest<'_>,
        columns: Columns<'_>,
        measure: String,
        column: String,
    ) -> Result<Self, AssessmentError> {
        let parsed = Measure::parse(&measure).ok();
        let own = parsed.filter(|measure| measure.column() == column);
        let stated = columns.unit(&column).or(own.map(|measure| measure.unit().to_owned()));
        let dimension = parsed.and_then(|measure| dimension(measure.unit()));
        let wrong = |what: &str, error: crate::error::UnitError| {
            let crate::error::UnitError { expected, found, nearest } = error;
            let what = what.to_owned();
            AssessmentError::Choice(ChoiceError { what, expected, found, nearest })
        };
        let unit = |what: &str, name: &str| match (name.trim(), dimension) {
            ("" | "1" | "-", None) => Ok(None),
            (name, Some(dimension)) => parse_unit(name, dimension)
                .map(|unit| Some((dimension, unit)))
                .map_err(|error| wrong(what, error)),
            (name, None) => any_unit(name).map(Some).map_err(|error| wrong(what, error)),
        };
        let written = match (stated, request.units) {
            (Some(stated), asked) => {
                let written = unit(&format!("SOURCE: unit of {column}"), &stated)?;
                if let Some(asked) = asked
                    && unit("units", asked)? != written
                {
                    let expected = format!("{stated:?}, the unit that {} states", column);
                    return Err(refuse("units", expected, format!("{asked:?}")));
                }
                written
            }
            (None, Some(asked)) => unit("units", asked)?,
            (None, None) => {
                let example = dimension.map_or("g", |d| {
                    if d == Dimension::Acceleration { "g" } else { d.units()[0].name() }
                });
                let expected = format!(
                    "the unit of {column}, which {} does not state: write \"{column} [{example}]\" \
                     in its header, or give `units` {example}",
                    columns.source_name
                );
                return Err(refuse("units", expected, "none"));
            }
        };
        let unit = written.map_or("", |(dimension, _)| dimension.units()[0].name());
        Ok(Self { measure, unit: unit.to_owned(), column, written: written.map(|(_, unit)| unit) })
    }

    /// What one unit of the table is in SI, and its name; else `si`.
    pub(super) fn as_written(&self, si: &str) -> (f64, String) {
        let written = self.written.map(|unit| (unit.to_si(1.0), unit.name().to_owned()));
        written.unwrap_or_else(|| (1.0, si.to_owned()))
    }

    /// The intensities of all rows, in SI.
    pub(super) fn values(&self, columns: Columns<'_>) -> Result<Vec<f64>, AssessmentError> {
        let si = |value: f64| self.written.map_or(value, |unit| unit.to_si(value));
        Ok(columns.numbers(&self.column)?.into_iter().map(si).collect())
    }
}

/// What an SI unit measures.
pub(super) fn dimension(unit: &str) -> Option<Dimension> {
    Dimension::ALL.into_iter().find(|dimension| dimension.units()[0].name() == unit)
}

/// The measure that records were scaled to, where the table has its values beside the levels.
fn of_equal_column(columns: Columns<'_>, levels: &str) -> Option<String> {
    let measures = IntensityMeasures::default().columns().map(|(measure, ..)| measure);
    let equal = |measure: &Measure| {
        columns.has(&measure.column()) && same_values(columns, levels, &measure.column())
    };
    measures.into_iter().find(equal).map(|measure| measure.to_string())
}

/// The error where nothing says of what measure the levels are.
fn unsaid(columns: Columns<'_>, levels: &str) -> AssessmentError {
    let source = columns.source_name;
    let expected = if columns.has("scale") {
        format!(
            "a measure that {source} has a column of, such as PGA, or a column measure beside {levels} \
             (a study's folder has it in its manifest)"
        )
    } else {
        format!("the measure of {levels}, which {source} does not state, such as PGA")
    };
    refuse("measure", expected, "none")
}

/// Whether records were scaled to levels of a column's measure: its values are those of the levels, but
/// for the rounding of each record's factor, which would take the levels apart.
fn same_values(columns: Columns<'_>, levels: &str, column: &str) -> bool {
    let numbers = |name: &str| columns.numbers_or_nan(name).unwrap_or_default();
    let (levels, values) = (numbers(levels), numbers(column));
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * b.abs();
    !levels.is_empty() && levels.len() == values.len() && levels.iter().zip(&values).all(near)
}
