//! Runs the parts of a shard that are not there yet.

use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

use slipstick::input::plan::Levels;
use slipstick::study::Row;
use slipstick::study::engine::Engine;

use super::part::{self, Checks, Notes, part_count, part_name, rows_of};
use super::parts::{Damaged, PARTS, PartsFound, find, refuse_old_layout, remove_leftovers};
use super::{OpenStudy, StudyError};
use crate::error::shown;
use crate::parquet::at;
use crate::write::{OutputFolder, write_whole_by};

/// Most parts that are computed or written at a time, whose rows are held.
const PARTS_AT_ONCE: usize = 8;

/// One of so many shards of a study, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    count: u64,
}

impl Shard {
    /// The whole study.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// The shard `index` of `count`, both from 1.
    ///
    /// # Errors
    /// [`StudyError::OutOfRange`] unless `1 ≤ index ≤ count`.
    pub fn new(index: u64, count: u64) -> Result<Self, StudyError> {
        if 1 <= index && index <= count {
            return Ok(Self { index, count });
        }
        Err(StudyError::OutOfRange {
            expected: "a shard i/n with i from 1 to n".to_owned(),
            found: format!("{index}/{count}"),
        })
    }

    /// Its parts, of so many.
    fn parts(self, count: u64) -> Range<u64> {
        let bound = |index: u64| {
            // Neither factor is above 10⁸ but a count of shards that someone typed.
            (u128::from(count) * u128::from(index) / u128::from(self.count)) as u64
        };
        bound(self.index - 1)..bound(self.index)
    }
}

/// What a shard came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShardOutcome {
    /// Runs of the shard.
    pub runs: u64,
    /// Those that were there already.
    pub kept: u64,
    /// Those that failed.
    pub failures: u64,
    /// What came of running some again.
    pub checks: Checks,
    /// One sentence for each file that stood under a part's name and was not that part.
    pub notices: Vec<String>,
}

/// Runs what a folder lacks of a shard's parts.
///
/// The rows of a part, and so the bytes of its file, follow from the plan and its inputs alone:
/// they are the same whatever the shard, the number of threads and what was there before. A part
/// appears whole or not at all, and is written while the next is computed. Called again with the same
/// plan it does what is left to do. The threads are those of the pool that it is called in.
///
/// # Errors
/// [`StudyError`] for inputs that cannot be used, a folder that cannot be written or that holds
/// parts of another study, a run that fails its check, and where the engine is stopped. A run that
/// cannot be solved is a row; a part that is damaged is run again.
pub fn run_shard(
    plan: &Path,
    shard: Shard,
    folder: &Path,
    engine: &Engine<'_>,
) -> Result<ShardOutcome, StudyError> {
    OpenStudy::open(plan)?.run_shard(shard, folder, engine)
}

impl OpenStudy {
    /// As [`run_shard`], of a study that is open.
    ///
    /// # Errors
    /// As [`run_shard`].
    pub fn run_shard(
        &self,
        shard: Shard,
        folder: &Path,
        engine: &Engine<'_>,
    ) -> Result<ShardOutcome, StudyError> {
        refuse_old_layout(folder)?;
        let mut output = OutputFolder::create(folder, &[])?;
        output.make_inside(PARTS)?;
        output.commit()?;
        let runs = self.study.runs();
        let wanted = shard.parts(part_count(runs));
        remove_leftovers(folder, &wanted, wanted == (0..part_count(runs)))?;
        let found = find(&folder.join(PARTS))?;
        found.refuse_foreign(&self.id)?;
        let mut outcome = ShardOutcome {
            notices: notices(&found, &wanted, part_count(runs)),
            ..Default::default()
        };
        let mut to_do = Vec::new();
        for part in wanted {
            let rows = rows_of(part, runs);
            outcome.runs += rows.end - rows.start;
            match found.whole.iter().find(|file| file.notes.first == rows.start) {
                Some(file) => {
                    outcome.kept += file.notes.rows;
                    outcome.failures += file.notes.failures;
                    outcome.checks.join(&file.notes.checks);
                }
                None => to_do.push(part),
            }
        }
        engine.done(outcome.kept)?;
        // One part is judged, encoded and written while others are computed.
        let all_notes = engine.begun_in_order(to_do.len(), PARTS_AT_ONCE, |i| {
            let rows = self.study.rows(rows_of(to_do[i], runs), engine)?;
            self.finish(to_do[i], &rows, folder, engine)
        })?;
        for notes in all_notes {
            outcome.failures += notes.failures;
            outcome.checks.join(&notes.checks);
        }
        Ok(outcome)
    }

    /// Number of runs of a shard.
    #[must_use]
    pub fn shard_runs(&self, shard: Shard) -> u64 {
        let runs = self.study.runs();
        let parts = shard.parts(part_count(runs));
        parts.map(|part| rows_of(part, runs)).map(|rows| rows.end - rows.start).sum()
    }

    /// Judges some rows of a part and writes it.
    fn finish(
        &self,
        part: u64,
        rows: &[Row],
        folder: &Path,
        engine: &Engine<'_>,
    ) -> Result<Notes, StudyError> {
        let runs = self.study.runs();
        let notes = Notes {
            id: self.id.clone(),
            runs,
            first: rows_of(part, runs).start,
            rows: rows.len() as u64,
            failures: rows.iter().filter(|row| row.error.is_some()).count() as u64,
            checks: self.check(rows, engine)?,
            measure: match self.study.levels() {
                Levels::Measure { measure, .. } => Some(measure.to_string()),
                Levels::Factors(_) => None,
            },
        };
        let path = folder.join(PARTS).join(part_name(part));
        let bytes = part::sealed(&self.study.fields(), &notes, &self.study.cells(rows));
        write_whole_by(folder, &path, &bytes.map_err(at(&path))?)?;
        Ok(notes)
    }

    /// Runs some rows again, alone and with their histories.
    fn check(&self, rows: &[Row], engine: &Engine<'_>) -> Result<Checks, StudyError> {
        let checked = self.study.to_certify(rows);
        let mut checks = Checks::default();
        let verdicts = engine.map(checked.len(), |i| Ok(self.study.verify(checked[i])))?;
        for (row, verdict) in checked.iter().zip(verdicts) {
            checks.add(row.run, &verdict);
            if !verdict.holds() {
                return Err(StudyError::CheckFailed {
                    run: row.run,
                    what: verdict.what_failed(),
                    repeat: self.repeat(row.run)?,
                });
            }
        }
        Ok(checks)
    }
}

/// What becomes of files that are not the parts of their names.
fn notices(found: &PartsFound, wanted: &Range<u64>, count: u64) -> Vec<String> {
    let stray = |path: &Path| {
        format!("{}: the study has no such part; left out of the summary", shown(path))
    };
    let damaged = found.damaged.iter().map(|Damaged { path, part, reason }| {
        let what = match wanted.contains(part) {
            true => "its runs are run again",
            false if *part >= count => return stray(path),
            false => "left out of the summary until its shard is run again",
        };
        format!("{}: {reason}; {what}", shown(path))
    });
    damaged.chain(found.strays.iter().map(|path| stray(path))).collect()
}

/// Time that a shard may take in the pool that this is called in, from runs spread over it that are
/// timed for about `budget`.
///
/// # Errors
/// None: nothing stops it.
pub fn estimate(
    study: &OpenStudy,
    shard: Shard,
    budget: Duration,
) -> Result<(u64, Duration), StudyError> {
    let total = study.study.runs();
    let parts = shard.parts(part_count(total));
    let runs = if parts.is_empty() {
        0..0
    } else {
        rows_of(parts.start, total).start..rows_of(parts.end - 1, total).end
    };
    let count = runs.end - runs.start;
    if count == 0 {
        return Ok((0, Duration::ZERO));
    }
    let engine = Engine::unwatched();
    let mut timed = 0_u64;
    let start = Instant::now();
    // A few runs at a time from all over the shard, as long as time is left.
    let steps = 64_u64;
    let block = (count / steps).clamp(1, 64);
    for step in 0..steps {
        // An odd stride visits every step once, the far ones early.
        let at = runs.start + (count - block) * (step * 37 % steps) / steps;
        timed += study.study.rows(at..at + block, &engine)?.len() as u64;
        if start.elapsed() > budget {
            break;
        }
    }
    let per_run = start.elapsed().as_secs_f64() / timed.max(1) as f64;
    Ok((count, Duration::from_secs_f64(per_run * count as f64)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_cover_all_parts_once() {
        for (parts, shards) in [(128, 1), (128, 3), (5, 100), (1, 1), (1, 7)] {
            let mut next = 0;
            for index in 1..=shards {
                let range = Shard::new(index, shards).unwrap().parts(parts);
                assert_eq!(range.start, next);
                next = range.end;
            }
            assert_eq!(next, parts);
        }
        assert!(Shard::new(0, 3).is_err() && Shard::new(4, 3).is_err());
    }

    #[test]
    fn parts_cover_all_runs_once() {
        for runs in [1, 499, 500, 501, 64_000, 64_001, 880_000, 100_000_000] {
            let mut next = 0;
            for part in 0..part_count(runs) {
                let range = rows_of(part, runs);
                assert_eq!(range.start, next);
                assert!(range.end > range.start);
                next = range.end;
            }
            assert_eq!(next, runs);
        }
    }
}
