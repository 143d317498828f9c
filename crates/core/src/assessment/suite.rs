//! The records that a model is run on, and how they are scaled.

use super::grid::levels;
use super::{AssessmentError, refuse};
use crate::error::{MotionError, RunError};
use crate::input::Parts;
use crate::motion::GroundMotion;
use crate::motion::intensity::Measure;
use crate::study::engine::{Engine, made_motion, scaled_with_tail};
use crate::table::Table;

/// How records are scaled, vertical components with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scaling {
    /// By a factor, 1 as recorded.
    Factor(f64),
    /// So that a measure takes a value, in its SI unit.
    Level(Measure, f64),
}

impl Scaling {
    /// That to one level of a measure as people write it, and that in words; `what` is what errors call
    /// the level.
    ///
    /// # Errors
    /// [`AssessmentError::Choice`] for text that is not one level of the measure.
    pub fn to_level(
        what: &str,
        measure: Measure,
        text: &str,
    ) -> Result<(Self, String), AssessmentError> {
        let [value] = levels(what, text, &measure)?[..] else {
            return Err(refuse(what, "one level", format!("{text:?}")));
        };
        Ok((Self::Level(measure, value), format!(" scaled to {measure} = {}", text.trim())))
    }
}

/// A record of a suite.
#[derive(Clone, Debug, PartialEq)]
pub struct SuiteRecord {
    /// Its name in tables.
    pub name: String,
    /// The motion as it was recorded.
    pub motion: GroundMotion,
}

/// The records that a model is run on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Suite {
    /// The records in their order.
    pub records: Vec<SuiteRecord>,
    /// Whether the motion is made by the model rather than recorded: then it is the one record.
    pub made: bool,
}

impl Suite {
    /// Names of the records.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.records.iter().map(|record| record.name.clone()).collect()
    }

    /// The measure of each record as recorded, in SI.
    ///
    /// # Errors
    /// [`AssessmentError::Choice`] for a measure that does not grow as the motion does, and for a
    /// record of which it is 0.
    pub fn measure(
        &self,
        measure: &Measure,
        engine: &Engine<'_>,
    ) -> Result<Vec<f64>, AssessmentError> {
        if !measure.scales() {
            let expected = "a measure that grows as the motion does, such as PGA or Sa(1.2 s)";
            return Err(refuse("measure", expected, measure.to_string()));
        }
        let values = engine.map(self.records.len(), |i| Ok(measure.of(&self.records[i].motion)))?;
        for (value, record) in values.iter().zip(&self.records) {
            if !(value.is_finite() && *value > 0.0) {
                let expected = format!("records that can be scaled to {measure}");
                let found = format!("{measure} = {value} of {}", record.name);
                return Err(refuse("measure", expected, found));
            }
        }
        Ok(values)
    }

    /// The factor on each record.
    ///
    /// # Errors
    /// As [`Suite::measure`].
    pub fn factors(
        &self,
        scaling: &Scaling,
        engine: &Engine<'_>,
    ) -> Result<Vec<f64>, AssessmentError> {
        match scaling {
            Scaling::Factor(factor) => Ok(vec![*factor; self.records.len()]),
            Scaling::Level(measure, level) => {
                let values = self.measure(measure, engine)?;
                Ok(values.into_iter().map(|value| level / value).collect())
            }
        }
    }

    /// Columns that say of what intensity each record is as it is run: `measure`, `measure_unit` and
    /// `level`, the peak acceleration where records are scaled by a factor; none for a made motion.
    pub(super) fn intensities(
        &self,
        scaling: &Scaling,
        of_runs: &[usize],
        engine: &Engine<'_>,
    ) -> Result<Table, AssessmentError> {
        let mut table = Table::default();
        if self.made {
            return Ok(table);
        }
        let (measure, levels) = match scaling {
            Scaling::Level(measure, level) => (*measure, vec![*level; self.records.len()]),
            Scaling::Factor(factor) => {
                let values = self.measure(&Measure::Pga, engine)?;
                (Measure::Pga, values.into_iter().map(|value| value * factor.abs()).collect())
            }
        };
        table
            .texts("measure", vec![measure.to_string(); of_runs.len()])
            .texts("measure_unit", vec![measure.unit().to_owned(); of_runs.len()])
            .numbers("level", measure.unit(), of_runs.iter().map(|&i| levels[i]).collect());
        Ok(table)
    }

    /// A record times a factor, with a tail of free vibration.
    ///
    /// # Errors
    /// [`MotionError`] for a factor or tail that cannot be.
    pub fn motion(
        &self,
        record: usize,
        factor: f64,
        tail_s: f64,
    ) -> Result<GroundMotion, MotionError> {
        scaled_with_tail(&self.records[record].motion, factor, tail_s)
    }

    /// The motion of a run: a record of the suite with the model's tail, or the model's own.
    ///
    /// # Errors
    /// [`RunError`] for a motion that cannot be made, scaled or given its tail.
    pub fn motion_of(
        &self,
        record: usize,
        factor: f64,
        parts: &Parts,
    ) -> Result<GroundMotion, RunError> {
        if !self.made {
            return Ok(self.motion(record, factor, parts.tail_s)?);
        }
        Ok(scaled_with_tail(&made_motion(parts.motion.as_ref())?, factor, parts.tail_s)?)
    }
}
