//! Rows of a study: the demands of its runs.

use std::ops::Range;
use std::sync::Arc;

use super::{Case, Column, Sample, Study, chunks, demand_columns, demand_values, parallel};
use crate::input::MotionSource;
use crate::motion::GroundMotion;
use crate::motion::intensity::{IntensityMeasures, Measure};
use crate::response::Response;
use crate::solver;

/// One run of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its number, from 0.
    pub run: u64,
    /// Its record, level and sample.
    pub case: Case,
    /// The factor on the record; 1 for a made motion.
    pub scale: f64,
    /// Intensity measures of the motion as it was run, without its tail; NaN where there is no
    /// motion. In the order of [`Study::measure_columns`].
    pub measures: Arc<[f64]>,
    /// Values at the varied paths, in SI.
    pub values: Vec<f64>,
    /// Demands in the order of [`Study::demand_columns`]; NaN where one does not exist, all of them
    /// where the run failed.
    pub demands: Vec<f64>,
    /// Kinds of warnings, each once.
    pub warnings: Vec<&'static str>,
    /// Why the run failed, where it did.
    pub error: Option<String>,
}

/// A motion as it is solved, and what rows say of it.
#[derive(Clone, Debug)]
struct Prepared {
    motion: GroundMotion,
    measures: Arc<[f64]>,
}

/// What a prepared motion was made from: it serves for all samples that agree on it.
#[derive(Clone, Debug, PartialEq)]
struct Made {
    source: Option<MotionSource>,
    tail_s: f64,
}

impl Study {
    /// Columns of [`Row::measures`].
    #[must_use]
    pub fn measure_columns(&self) -> Vec<Column> {
        let all = self.measures.iter();
        all.map(|measure| Column::number(measure.column(), measure.unit())).collect()
    }

    /// Columns of [`Row::values`]: the varied paths.
    #[must_use]
    pub fn value_columns(&self) -> Vec<Column> {
        let vary = self.design.vary().iter();
        vary.map(|varied| Column::number(varied.path.clone(), varied.unit)).collect()
    }

    /// Columns of [`Row::demands`].
    #[must_use]
    pub fn demand_columns(&self) -> Vec<Column> {
        demand_columns(self.storeys)
    }

    /// The rows of a range of runs, in order. `done` is told now and then how many more are.
    #[must_use]
    pub fn rows(&self, runs: Range<u64>, done: &(dyn Fn(u64) + Sync)) -> Vec<Row> {
        let samples = self.cases.samples;
        let groups: Vec<Range<u64>> = {
            // All runs of one record at one level stand together.
            let first = runs.start / samples;
            let last = runs.end.div_ceil(samples);
            let range = |group: u64| {
                (group * samples).max(runs.start)..((group + 1) * samples).min(runs.end)
            };
            (first..last).map(range).filter(|range| !range.is_empty()).collect()
        };
        parallel::map(&groups, |group| self.group(group.clone(), done))
            .into_iter()
            .flatten()
            .collect()
    }

    /// Runs of one record at one level.
    fn group(&self, runs: Range<u64>, done: &(dyn Fn(u64) + Sync)) -> Vec<Row> {
        let first = self.cases.case(runs.start);
        let samples = self.samples(first.sample..first.sample + (runs.end - runs.start));
        let scale = self.factor(first);
        let scaled = self.records.get(first.record as usize).map(|record| {
            let motion = record.motion.scaled(scale).map_err(|error| error.to_string())?;
            let measures = self.measures_of(first.record, scale, &motion);
            Ok(Prepared { motion, measures })
        });
        let chunks: Vec<_> = chunks(0..samples.len() as u64).collect();
        let of_chunk = |chunk: &Range<u64>| -> Vec<Row> {
            let samples = &samples[chunk.start as usize..chunk.end as usize];
            let first = Case { sample: first.sample + chunk.start, ..first };
            let rows = self.chunk(first, scale, samples, scaled.as_ref());
            done(chunk.end - chunk.start);
            rows
        };
        parallel::map(&chunks, of_chunk).into_iter().flatten().collect()
    }

    /// Runs of neighbouring samples; those that move the table alike share one motion.
    fn chunk(
        &self,
        first: Case,
        scale: f64,
        samples: &[Sample],
        scaled: Option<&Result<Prepared, String>>,
    ) -> Vec<Row> {
        let made = |sample: &Sample| {
            let parts = sample.parts.as_ref().ok()?;
            let source = if scaled.is_some() { None } else { parts.motion.clone() };
            Some(Made { source, tail_s: parts.tail_s })
        };
        let none = Err("the model makes no motion".to_owned());
        let mut rows = Vec::with_capacity(samples.len());
        let mut rest = samples;
        while let Some(sample) = rest.first() {
            let alike = made(sample);
            let count = rest.iter().take_while(|other| made(other) == alike).count();
            let own;
            let prepared = match (scaled, &alike) {
                (Some(scaled), None | Some(Made { tail_s: 0.0, .. })) => scaled,
                (None, None) => &none,
                (_, Some(made)) => {
                    own = self.with_tail(made, scaled);
                    &own
                }
            };
            let (these, others) = rest.split_at(count);
            for sample in these {
                let case = Case { sample: first.sample + rows.len() as u64, ..first };
                rows.push(self.run(case, scale, sample, prepared));
            }
            rest = others;
        }
        rows
    }

    fn run(
        &self,
        case: Case,
        scale: f64,
        sample: &Sample,
        prepared: &Result<Prepared, String>,
    ) -> Row {
        let measures = match prepared {
            Ok(prepared) => prepared.measures.clone(),
            Err(_) => vec![f64::NAN; self.measures.len()].into(),
        };
        let (run, values) = (self.cases.run(case), sample.values.clone());
        let outcome = sample.parts.as_ref().map_err(Clone::clone).and_then(|parts| {
            let prepared = prepared.as_ref().map_err(Clone::clone)?;
            let response = solver::exact_demands(&parts.model, &prepared.motion);
            response.map_err(|error| error.to_string())
        });
        let (demands, warnings, error) = match outcome {
            Ok(response) => {
                let record = self.records.get(case.record as usize);
                let of_record = record.map_or(&[][..], |record| &record.warnings);
                (demand_values(&response.demands), warnings(of_record, &response), None)
            }
            Err(error) => {
                (vec![f64::NAN; demand_columns(self.storeys).len()], Vec::new(), Some(error))
            }
        };
        Row { run, case, scale, measures, values, demands, warnings, error }
    }

    fn with_tail(
        &self,
        made: &Made,
        scaled: Option<&Result<Prepared, String>>,
    ) -> Result<Prepared, String> {
        let bare = match (scaled, &made.source) {
            (Some(scaled), _) => scaled.clone()?,
            (None, source) => {
                let motion = source.as_ref().and_then(super::made);
                let motion = motion.ok_or("the model makes no motion")?;
                let motion = motion.map_err(|error| error.to_string())?;
                let measures = self.measures.iter().map(|measure| measure.of(&motion)).collect();
                Prepared { motion, measures }
            }
        };
        if made.tail_s == 0.0 {
            return Ok(bare);
        }
        let motion = bare.motion.with_tail(made.tail_s).map_err(|error| error.to_string())?;
        Ok(Prepared { motion, ..bare })
    }

    /// The measures of a record at a level. Spectra are taken once a record: most measures of a
    /// scaled motion follow from those of the record.
    fn measures_of(&self, record: u64, scale: f64, scaled: &GroundMotion) -> Arc<[f64]> {
        let Some((kept, record)) =
            self.unscaled.get(record as usize).zip(self.records.get(record as usize))
        else {
            return Arc::default();
        };
        let unscaled = kept.get_or_init(|| {
            IntensityMeasures::of(&record.motion).columns().map(|(.., value)| value).to_vec()
        });
        let of_scaled = |(measure, unscaled): (&Measure, &f64)| match measure {
            measure if measure.scales() => unscaled * scale.abs(),
            Measure::Arias => unscaled * (scale * scale),
            // A motion times 0 has none of them.
            Measure::D5To75 | Measure::D5To95 | Measure::MeanPeriod if scale != 0.0 => *unscaled,
            measure => measure.of(scaled),
        };
        self.measures.iter().zip(unscaled).map(of_scaled).collect()
    }
}

/// Kinds of warnings that a run gives without its certificate, each once.
pub(super) fn warnings(of_record: &[&'static str], response: &Response) -> Vec<&'static str> {
    let gap = response.demands.gap_ratio.is_some_and(|ratio| ratio > 1.0);
    let gap = gap.then_some("gap_exceeded");
    let of_solver = response.warnings.iter().map(|warning| warning.kind);
    let mut kinds = Vec::new();
    for kind in of_record.iter().copied().chain(gap).chain(of_solver) {
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    kinds
}
