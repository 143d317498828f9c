//! The records of a suite, opened once.

use std::path::{Path, PathBuf};

use slipstick::error::MotionError;
use slipstick::motion::GroundMotion;
use slipstick::motion::intensity::Measure;
use slipstick::record::Units;
use slipstick::response::Warning;

use super::{AssessmentError, refuse, threads};
use crate::error::FileError;
use crate::globs::expand_all;
use crate::load::{LoadedMotion, RecordRequest, VerticalRequest, load_record};
use crate::read::sha256_hex;

/// Records to be opened, and what they may not say themselves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SuiteRequest {
    /// Files, folders or patterns, relative to the working folder.
    pub patterns: Vec<String>,
    /// The same for the vertical components, as many and in the same order.
    pub vertical: Vec<String>,
    /// Units, where files do not state them.
    pub units: Option<Units>,
    /// Time step in s, where files do not state it.
    pub dt_s: Option<f64>,
    /// Name or number (from 1) of the channel.
    pub channel: Option<String>,
}

/// How records are scaled, vertical components with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scaling {
    /// By a factor, 1 as recorded.
    Factor(f64),
    /// So that a measure takes a value, in its SI unit.
    Level(Measure, f64),
}

/// A record of a suite.
#[derive(Clone, Debug, PartialEq)]
pub struct SuiteRecord {
    /// Its name in tables: the file's stem, or its path where stems repeat.
    pub name: String,
    /// The motion as it was recorded.
    pub motion: GroundMotion,
}

/// The records of a suite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Suite {
    /// The records, in the order of their patterns and paths.
    pub records: Vec<SuiteRecord>,
    /// Files read: path, SHA-256, what they are.
    pub sources: Vec<(String, String, String)>,
    /// What reading them gave notice of, each kind once.
    pub warnings: Vec<Warning>,
    /// Whether the motion is made by the model rather than read.
    pub made: bool,
}

impl Suite {
    /// Opens all records.
    ///
    /// # Errors
    /// [`AssessmentError`] where nothing matches a pattern, a file is no record, or the vertical
    /// components are not as many as the horizontal ones.
    pub fn open(request: &SuiteRequest) -> Result<Self, AssessmentError> {
        let files = expand_all(Path::new(""), &request.patterns)?;
        let vertical = expand_all(Path::new(""), &request.vertical)?;
        if !vertical.is_empty() && vertical.len() != files.len() {
            let expected = format!("one vertical motion for each of {} records", files.len());
            return Err(refuse("--vertical", expected, vertical.len().to_string()));
        }
        let loaded = threads::map(files.len(), |i| {
            load_record(&RecordRequest {
                path: files[i].clone(),
                units: request.units,
                dt_s: request.dt_s,
                channel: request.channel.clone(),
                vertical: vertical.get(i).map(|path| VerticalRequest {
                    path: path.clone(),
                    channel: None,
                    factor: 1.0,
                }),
                ..RecordRequest::default()
            })
        });
        let loaded = loaded.into_iter().collect::<Result<Vec<_>, FileError>>()?;
        Ok(Self::of(&names(&files), loaded, false))
    }

    /// The motion of a model as its only record.
    #[must_use]
    pub fn single(name: &str, loaded: LoadedMotion, made: bool) -> Self {
        Self::of(&[name.to_owned()], vec![loaded], made)
    }

    fn of(names: &[String], loaded: Vec<LoadedMotion>, made: bool) -> Self {
        let mut suite = Self { made, ..Self::default() };
        let mut noticed: Vec<(&'static str, Vec<String>)> = Vec::new();
        for (name, loaded) in names.iter().zip(loaded) {
            for (source, description) in loaded.sources.iter().zip(&loaded.description) {
                suite.sources.push((
                    source.path.display().to_string(),
                    source.sha256.clone(),
                    description.clone(),
                ));
            }
            for warning in &loaded.warnings {
                let message = format!("{name}: {}", warning.message);
                match noticed.iter_mut().find(|(kind, _)| *kind == warning.kind) {
                    Some((_, messages)) => messages.push(message),
                    None => noticed.push((warning.kind, vec![message])),
                }
            }
            suite.records.push(SuiteRecord { name: name.clone(), motion: loaded.motion });
        }
        let one = |(kind, messages): (&'static str, Vec<String>)| {
            let more = match messages.len() {
                1 => String::new(),
                n => format!(" (and {} of the other records)", n - 1),
            };
            let message = format!("{}{more}", messages[0]);
            Warning { kind, time_s: None, message }
        };
        suite.warnings = noticed.into_iter().map(one).collect();
        suite
    }

    /// Names of the records.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.records.iter().map(|record| record.name.clone()).collect()
    }

    /// The measure of each record as recorded, in SI.
    ///
    /// # Errors
    /// [`AssessmentError::Option`] for a measure that does not grow as the motion does, and for a
    /// record of which it is 0.
    pub fn measure(&self, measure: &Measure) -> Result<Vec<f64>, AssessmentError> {
        if !measure.scales() {
            let expected = "a measure that grows as the motion does, such as PGA or Sa(1.2 s)";
            return Err(refuse("--measure", expected, measure.to_string()));
        }
        let values = threads::map(self.records.len(), |i| measure.of(&self.records[i].motion));
        for (value, record) in values.iter().zip(&self.records) {
            if !(value.is_finite() && *value > 0.0) {
                let expected = format!("records that can be scaled to {measure}");
                let found = format!("{measure} = {value} of {}", record.name);
                return Err(refuse("--measure", expected, found));
            }
        }
        Ok(values)
    }

    /// The factor on each record.
    ///
    /// # Errors
    /// As [`Suite::measure`].
    pub fn factors(&self, scaling: &Scaling) -> Result<Vec<f64>, AssessmentError> {
        match scaling {
            Scaling::Factor(factor) => Ok(vec![*factor; self.records.len()]),
            Scaling::Level(measure, level) => {
                Ok(self.measure(measure)?.into_iter().map(|value| level / value).collect())
            }
        }
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
        let motion = &self.records[record].motion;
        let scaled = if factor == 1.0 { motion.clone() } else { motion.scaled(factor)? };
        if tail_s == 0.0 { Ok(scaled) } else { scaled.with_tail(tail_s) }
    }

    /// One hash for all files, in their order.
    #[must_use]
    pub fn hash(&self) -> String {
        let all: String = self.sources.iter().map(|(_, sha256, _)| format!("{sha256}\n")).collect();
        sha256_hex(all.as_bytes())
    }
}

/// Stems of files, or paths where stems repeat.
fn names(files: &[PathBuf]) -> Vec<String> {
    let path = |file: &PathBuf| file.display().to_string().replace('\\', "/");
    let stem = |file: &PathBuf| {
        file.file_stem().map_or_else(|| path(file), |stem| stem.to_string_lossy().into_owned())
    };
    let stems: Vec<String> = files.iter().map(stem).collect();
    let repeats = |name: &String| stems.iter().filter(|other| *other == name).count() > 1;
    if stems.iter().any(repeats) { files.iter().map(path).collect() } else { stems }
}
