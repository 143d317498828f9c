//! One analysis from model text to results: what the command and other front ends share.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use slipstick::assessment::single::{Job, Outcome, described};
use slipstick::error::{InputError, MotionError, SolveError};
use slipstick::input::loaded::Loaded;
use slipstick::input::{Analysis, MotionSource, RecordSource, stem};
use slipstick::progress::Cancel;
use slipstick_report::Summary;

use crate::error::{FileError, reason};
use crate::load::{
    AlongYRequest, LoadedMotion, RecordRequest, SourceFile, VerticalRequest, load_record,
};
use crate::parquet::ParquetTable;
use crate::read::resolve;

/// A job with what is known of its files.
#[derive(Clone, Debug)]
pub struct OpenJob {
    /// Name of the model, else the stem of its file.
    pub name: String,
    /// Model and motion, ready to be solved.
    pub job: Job,
    /// The files that the motion comes from.
    pub sources: Vec<SourceFile>,
}

/// Why a job could not be made ready or solved.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// The model.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// The analysis itself.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

impl OpenJob {
    /// Opens or makes the motion of an analysis.
    ///
    /// `model_path` names the model file (its folder is where records are looked for); `record`
    /// replaces the model's own motion, its path being relative to the working folder.
    ///
    /// # Errors
    /// [`JobError`] where no motion is given, or it cannot be read or made.
    pub fn new(
        model_path: &Path,
        analysis: Analysis,
        record: Option<&RecordRequest>,
    ) -> Result<Self, JobError> {
        let folder = model_path.parent().unwrap_or(Path::new(""));
        let made = |motion, description| LoadedMotion {
            loaded: Loaded::made(motion, description),
            sources: Vec::new(),
        };
        let loaded = match record {
            Some(record) => with_vertical_told(record, load_record(record)?),
            None => match analysis.required_motion()? {
                MotionSource::Record(source) => {
                    let record = request(source, folder);
                    let loaded = load_record(&record);
                    let loaded = loaded.map_err(|error| of_model(&analysis, &record, error))?;
                    with_vertical_told(&record, loaded)
                }
                source => match described(source).map_err(|e| analysis.motion_error(&e))? {
                    Some((motion, description)) => made(motion, description),
                    None => return Err(analysis.error_at("motion", "a motion", "none").into()),
                },
            },
        };
        let stem = model_path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let name = analysis.name.clone().or(stem).unwrap_or_else(|| "model".to_owned());
        let LoadedMotion { loaded, sources } = loaded;
        Ok(Self { name, job: Job::new(analysis, loaded)?, sources })
    }

    /// Time that [`OpenJob::run`] may take, from the first samples, of which more and more are solved
    /// until that takes `budget`; `None` where they cannot be.
    #[must_use]
    pub fn estimate(&self, budget: Duration) -> Option<Duration> {
        let motion = &self.job.motion;
        time_left([32, motion.len()], budget, |samples| {
            let first = Job { motion: motion.first(samples)?, ..self.job.clone() };
            first.run(false).ok().map(|_| ())
        })
    }

    /// Solves and judges, and gathers the figures.
    ///
    /// # Errors
    /// [`JobError::Solve`] with time and cause.
    pub fn run(&self, floor_spectra: bool) -> Result<(Outcome, Summary), JobError> {
        let outcome = self.job.run(floor_spectra)?;
        Ok(self.summed(outcome))
    }

    /// The same as long as `go_on` says so, which is asked every few milliseconds.
    ///
    /// # Errors
    /// [`JobError::Solve`] with [`SolveError::Stopped`] where it says no, and as [`OpenJob::run`].
    pub fn run_while(
        &self,
        floor_spectra: bool,
        go_on: Cancel<'_>,
    ) -> Result<(Outcome, Summary), JobError> {
        let outcome = self.job.run_while(floor_spectra, go_on)?;
        Ok(self.summed(outcome))
    }

    /// What the motion is called: the stem of its file, of two components both; whatever is made by what it is.
    #[must_use]
    pub fn motion_name(&self) -> String {
        let paths = self.sources.iter().map(|source| source.path.display().to_string());
        let paths: Vec<String> = paths.collect();
        let in_plane = self.job.loaded.motion.horizontal_y_m_per_s2().is_some();
        match paths.as_slice() {
            [] => self.job.loaded.description.join("; "),
            [x, y, ..] if in_plane => format!("{} + {}", stem(x), stem(y)),
            [x, ..] => stem(x).to_owned(),
        }
    }

    /// The same, with what was understood of the files as a note.
    #[must_use]
    pub fn motion_words(&self) -> String {
        self.job.loaded.words(&self.motion_name())
    }

    fn summed(&self, outcome: Outcome) -> (Outcome, Summary) {
        let summary = Summary::of(&self.name, &self.job, &outcome);
        (outcome, summary)
    }
}

/// Time that work on all samples may take, from the `least` first of them, of which more and more are
/// worked on until that takes `budget`; `None` where they cannot be.
#[must_use]
pub fn time_left(
    [least, samples]: [usize; 2],
    budget: Duration,
    work: impl Fn(usize) -> Option<()>,
) -> Option<Duration> {
    let mut first = least.min(samples);
    loop {
        let start = Instant::now();
        work(first)?;
        let taken = start.elapsed();
        if 4 * taken > budget || first == samples {
            return Some(taken.mul_f64(samples as f64 / first.max(1) as f64));
        }
        first = (4 * first).min(samples);
    }
}

/// Time that reading a file may take, from its beginning, of which more and more is read until that takes
/// `budget`: lines of text by `read`, rows of Parquet; `None` for what is neither.
#[must_use]
pub fn reading_time(path: &Path, budget: Duration, read: impl Fn(&[u8])) -> Option<Duration> {
    let file = path.metadata().ok().filter(|file| file.is_file())?;
    if let Ok(table) = ParquetTable::of(path) {
        let rows = |most| table.columns(most).ok().map(|_| ());
        return time_left([1 << 12, table.rows()], budget, rows);
    }
    let length = usize::try_from(file.len()).ok()?;
    time_left([1 << 16, length], budget, |count| {
        let mut bytes = Vec::new();
        File::open(path).ok()?.take(count as u64).read_to_end(&mut bytes).ok()?;
        let end = bytes.iter().rposition(|byte| *byte == b'\n')?;
        read(&bytes[..end]);
        Some(())
    })
}

/// The file that [`OpenJob::new`] reads the motion from, if it does.
#[must_use]
pub fn record_path(
    model_path: &Path,
    analysis: &Analysis,
    record: Option<&RecordRequest>,
) -> Option<PathBuf> {
    match (record, analysis.required_motion()) {
        (Some(record), _) => Some(record.path.clone()),
        (None, Ok(MotionSource::Record(source))) => {
            let folder = model_path.parent().unwrap_or(Path::new(""));
            Some(resolve(folder, &source.path))
        }
        _ => None,
    }
}

/// With a notice of each file along the surface that is a vertical component.
fn with_vertical_told(record: &RecordRequest, motion: LoadedMotion) -> LoadedMotion {
    let name = |path: &Path| path.display().to_string();
    let (x, y) = (name(&record.path), record.along_y.as_ref().map(|y| name(&y.path)));
    let channel_y = record.along_y.as_ref().and_then(|y| y.channel.as_deref());
    let along_y = y.as_deref().map(|path| (path, channel_y));
    let loaded = motion.loaded.with_vertical_told((&x, record.channel.as_deref()), along_y);
    LoadedMotion { loaded, ..motion }
}

/// What is wrong with the record of a model, at the key that asks for it where the model can be
/// blamed: a path that leads nowhere, a scale that has no answer.
fn of_model(analysis: &Analysis, record: &RecordRequest, error: FileError) -> JobError {
    let key = |path: &Path| {
        let vertical = record.vertical.as_ref().is_some_and(|vertical| vertical.path == path);
        let along_y = record.along_y.as_ref().is_some_and(|y| y.path == path);
        match (vertical, along_y) {
            (true, _) => "motion.vertical",
            (_, true) => "motion.record_y",
            _ => "motion.record",
        }
    };
    match &error {
        FileError::Read { path, source } => {
            let found = format!("{}: {}", path.display(), reason(source));
            analysis.error_at(key(path), "a file that can be read", found).into()
        }
        FileError::IsFolder { path } => {
            let found = format!("the folder {}", path.display());
            analysis.error_at(key(path), "a file", found).into()
        }
        FileError::Motion {
            source: source @ (MotionError::ZeroPeak | MotionError::OutOfRange { .. }),
            ..
        } => analysis.motion_error(source).into(),
        _ => error.into(),
    }
}

/// A record as the model asks for it.
pub(crate) fn request(record: &RecordSource, folder: &Path) -> RecordRequest {
    RecordRequest {
        path: resolve(folder, &record.path),
        format: None,
        units: record.units,
        dt_s: record.dt_s,
        channel: record.channel.clone(),
        scale: Some(record.scale),
        along_y: record.along_y.as_ref().map(|y| AlongYRequest {
            path: resolve(folder, &y.path),
            units: y.units,
            dt_s: y.dt_s,
            channel: y.channel.clone(),
            pair: y.pair,
        }),
        vertical: record.vertical.as_ref().map(|path| VerticalRequest {
            path: resolve(folder, path),
            channel: None,
            factor: record.vertical_scale.unwrap_or(1.0),
        }),
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use super::*;

    /// More and more samples are tried, never more than there are; what cannot be done has no time.
    #[test]
    fn time_left_tries_the_first_samples() {
        let tried = RefCell::new(Vec::new());
        let work = |samples| {
            tried.borrow_mut().push(samples);
            Some(())
        };
        assert!(time_left([32, 1000], Duration::MAX / 8, work).is_some());
        assert_eq!(*tried.borrow(), [32, 128, 512, 1000]);
        tried.borrow_mut().clear();
        assert!(time_left([500, 1000], Duration::ZERO, work).is_some());
        assert_eq!(*tried.borrow(), [500]);
        assert!(time_left([32, 10], Duration::ZERO, |_| None).is_none());
    }

    /// A single Parquet file has a time left, as text has.
    #[test]
    fn reading_time_of_text_and_parquet() {
        let folder = std::env::temp_dir().join(format!("slipstick-time-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let (text, table) = (folder.join("a.csv"), folder.join("a.parquet"));
        std::fs::write(&text, "x\n1\n2\n").unwrap();
        let x = slipstick::table::Column::numbers("x", "", vec![1.0; 10_000]);
        crate::parquet::write_columns(&table, &[x]).unwrap();
        let read = RefCell::new(Vec::<u8>::new());
        let time = |path: &Path| {
            reading_time(path, Duration::MAX / 8, |bytes| read.borrow_mut().extend(bytes))
        };
        assert!(time(&text).is_some());
        assert_eq!(read.take(), b"x\n1\n2");
        assert!(time(&table).is_some());
        assert!(read.take().is_empty());
        assert!(time(&folder).is_none());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
