//! The records of a suite, opened once.

use std::path::{Path, PathBuf};

use slipstick::assessment::suite::Suite;
use slipstick::error::{ChoiceError, Stopped};
use slipstick::input::PairOf;
use slipstick::input::loaded::{Component, Loaded};
use slipstick::notice::{Notice, NoticeKind};
use slipstick::record::{Origin, Units};
use slipstick::study::engine::Engine;

use crate::error::FileError;
use crate::globs::{expand_all, expand_once, named_twice};
use crate::load::{AlongYRequest, LoadedMotion, RecordRequest, VerticalRequest, load_record};
use crate::unfit::refuse_unfit;

/// Why the records of a suite cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SuiteError {
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// Components that are not as many as the records.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// The callback that followed it stopped it.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Records to be opened, and what they may not say themselves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SuiteRequest {
    /// Files, folders or patterns, relative to the working folder.
    pub patterns: Vec<String>,
    /// The same for the other horizontal components: pairs, whose components stand beside each other.
    pub second: Vec<String>,
    /// The same for the components along y of motions in two horizontal directions, each one record.
    pub along_y: Vec<String>,
    /// The same for the vertical components, as many and in the same order.
    pub vertical: Vec<String>,
    /// Units, where files do not state them.
    pub units: Option<Units>,
    /// Time step in s, where files do not state it.
    pub dt_s: Option<f64>,
    /// Name or number (from 1) of the channel.
    pub channel: Option<String>,
}

/// A suite with what is known of its files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OpenSuite {
    /// The records, in the order of their patterns and paths.
    pub suite: Suite,
    /// Files read: path, SHA-256, what they are.
    pub sources: Vec<(String, String, String)>,
}

/// Records that were read, each with all that its file says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadRecords {
    /// The records by their names, components of a pair beside each other.
    pub records: Vec<(String, LoadedMotion)>,
    /// What is to be said of several of them.
    pub warnings: Vec<Notice>,
}

impl ReadRecords {
    /// Reads all records, of each of which the engine is told; a record's name is its file's stem, or its path
    /// where stems repeat.
    ///
    /// # Errors
    /// [`SuiteError`] where nothing matches a pattern, a file is no record, the vertical or other
    /// components are not as many as the records, or it is stopped.
    pub fn read(request: &SuiteRequest, engine: &Engine<'_>) -> Result<Self, SuiteError> {
        let (mut files, mut again) = expand_once(Path::new(""), &request.patterns)?;
        let second = expand_all(Path::new(""), &request.second)?;
        let mut vertical = expand_all(Path::new(""), &request.vertical)?;
        let along_y = expand_all(Path::new(""), &request.along_y)?;
        if !second.is_empty() || !along_y.is_empty() {
            // A component may be of two pairs.
            (files, again) = (expand_all(Path::new(""), &request.patterns)?, Vec::new());
        }
        let as_many = |what: &str, component: &str, others: &[PathBuf]| {
            if others.is_empty() || others.len() == files.len() {
                return Ok(());
            }
            Err(SuiteError::Choice(ChoiceError {
                what: what.to_owned(),
                expected: format!("one {component} for each of {} records", files.len()),
                found: others.len().to_string(),
                nearest: None,
            }))
        };
        as_many("second", "other component", &second)?;
        as_many("y", "component along y", &along_y)?;
        as_many("vertical", "vertical motion", &vertical)?;
        let pairs = !second.is_empty();
        if pairs {
            let beside = |a: PathBuf, b: PathBuf| [a, b];
            files = files.into_iter().zip(second).flat_map(|(a, b)| beside(a, b)).collect();
            vertical = vertical.into_iter().flat_map(|up| [up.clone(), up]).collect();
        }
        let load = |i: usize| {
            load_record(&RecordRequest {
                path: files[i].clone(),
                units: request.units,
                dt_s: request.dt_s,
                channel: request.channel.clone(),
                along_y: along_y.get(i).map(|path| AlongYRequest {
                    path: path.clone(),
                    units: request.units,
                    dt_s: request.dt_s,
                    channel: request.channel.clone(),
                    pair: PairOf { scale_y: 1.0, rotate_rad: 0.0 },
                }),
                vertical: vertical.get(i).map(|path| VerticalRequest {
                    path: path.clone(),
                    channel: None,
                    factor: 1.0,
                }),
                ..RecordRequest::default()
            })
        };
        let loaded = engine.runs(files.len(), load)?;
        let loaded = loaded.into_iter().collect::<Result<Vec<_>, FileError>>()?;
        let components: Vec<(&Path, Loaded)> = match along_y[..] {
            [] => {
                files.iter().zip(&loaded).map(|(file, of)| (&**file, of.loaded.clone())).collect()
            }
            _ => files.iter().zip(&along_y).zip(&loaded).flat_map(components).collect(),
        };
        let pairs = pairs || !along_y.is_empty();
        let same = refuse_unfit(&components, request.channel.is_some(), pairs)?;
        let warning = |kind| move |message| Notice::new(kind, message);
        let twice = named_twice(&again).map(warning(NoticeKind::RecordNamedTwice)).into_iter();
        let warnings = twice.chain(same.into_iter().map(warning(NoticeKind::SameMotion))).collect();
        let names = stems_or_paths(&[&files[..], &along_y[..]].concat());
        let (names, of_y) = names.split_at(files.len());
        let named = |(i, loaded): (usize, LoadedMotion)| match of_y.get(i) {
            Some(y) => (format!("{} + {y}", names[i]), loaded),
            None => (names[i].clone(), loaded),
        };
        let records = loaded.into_iter().enumerate().map(named).collect();
        Ok(Self { records, warnings })
    }
}

/// The components of a motion in two directions, each by its file.
fn components<'a>(
    ((x, y), read): ((&'a PathBuf, &'a PathBuf), &LoadedMotion),
) -> Vec<(&'a Path, Loaded)> {
    let along_y = read.origin.along_y.as_deref().cloned().unwrap_or_default();
    let along_x = Origin { along_y: None, ..read.origin.clone() };
    let of = |(file, component, origin): (&'a PathBuf, Component, Origin)| {
        Some((&**file, Loaded { origin, ..read.loaded.component(component)? }))
    };
    [(x, Component::X, along_x), (y, Component::Y, along_y)].into_iter().filter_map(of).collect()
}

impl OpenSuite {
    /// Opens all records as [`ReadRecords::read`] reads them.
    ///
    /// # Errors
    /// As there.
    pub fn open(request: &SuiteRequest, engine: &Engine<'_>) -> Result<Self, SuiteError> {
        let ReadRecords { records, warnings } = ReadRecords::read(request, engine)?;
        let mut open = Self::of(records, false);
        if !request.second.is_empty() {
            open.suite.pair_up();
        }
        open.suite.notices.extend(warnings);
        Ok(open)
    }

    /// The motion of a model as its only record.
    #[must_use]
    pub fn single(name: &str, loaded: LoadedMotion, made: bool) -> Self {
        Self::of(vec![(name.to_owned(), loaded)], made)
    }

    fn of(records: Vec<(String, LoadedMotion)>, made: bool) -> Self {
        let mut sources = Vec::new();
        for (_, loaded) in &records {
            sources.extend(loaded.sources.iter().zip(&loaded.description).map(|(file, what)| {
                (file.path.display().to_string(), file.sha256.clone(), what.clone())
            }));
        }
        let read = records.into_iter().map(|(name, loaded)| (name, loaded.loaded));
        Self { suite: Suite::of(read, made), sources }
    }
}

/// Stems of files, or paths where stems repeat.
#[must_use]
pub fn stems_or_paths(files: &[PathBuf]) -> Vec<String> {
    let path = |file: &PathBuf| file.display().to_string().replace('\\', "/");
    let stem = |file: &PathBuf| {
        file.file_stem().map_or_else(|| path(file), |stem| stem.to_string_lossy().into_owned())
    };
    let stems: Vec<String> = files.iter().map(stem).collect();
    let repeats = |name: &String| stems.iter().filter(|other| *other == name).count() > 1;
    if stems.iter().any(repeats) { files.iter().map(path).collect() } else { stems }
}
