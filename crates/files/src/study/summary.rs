//! Statistics of a study by level: exact quantiles in memory that does not grow with the runs.

use std::path::Path;

use arrow_array::ArrayRef;
use arrow_array::cast::AsArray;
use slipstick::input::plan::Levels;
use slipstick::study::{Column, ColumnKind, Study};
use slipstick_report::{LevelSummary, StudySummary};

use super::OpenStudy;

use super::part::{Layout, PartFile};
use crate::error::FileError;
use crate::parquet::{Table, each_batch, extend};

/// Probabilities of the quantiles.
const QUANTILES: [f64; 3] = [0.16, 0.5, 0.84];

/// Bits of a number that one pass over the values tells apart.
const DIGIT_BITS: u32 = 11;

/// Reads the parts of a study.
pub(super) fn of(open: &OpenStudy, files: &[PartFile]) -> Result<StudySummary, FileError> {
    let study = &open.study;
    let layout = Layout::new(study);
    let levels = study.cases().levels as usize;
    let parts = files
        .iter()
        .map(|file| Ok((file.notes.first, Table::of(&file.path)?)))
        .collect::<Result<Vec<_>, FileError>>()?;
    let counts = counts(study, &layout, &parts)?;
    let demands = layout.demands().iter().enumerate();
    let demands: Vec<_> = demands.filter(|(_, column)| column.kind != ColumnKind::Flag).collect();
    let of_demand = |&(index, column): &(usize, &Column)| -> Result<Vec<LevelSummary>, FileError> {
        let source = Source { study, parts: &parts, column: layout.first_demand + index };
        let figures = figures(&source, levels)?;
        let quantiles = quantiles(&source, &figures)?;
        let each = figures.iter().zip(quantiles).enumerate();
        let rows = each.map(|(level, (figures, quantiles))| {
            let record = figures
                .max_run
                .and_then(|run| study.records().get(study.cases().case(run).record as usize));
            let (runs, failures) = counts[level];
            let value = study.level(level as u64);
            LevelSummary {
                level: level as u64,
                value,
                scale: value.is_none().then(|| study.level_factor(level as u64)),
                demand: column.name.clone(),
                unit: column.unit,
                runs,
                failures,
                mean: figures.mean(),
                quantiles,
                max: figures.max,
                max_run: figures.max_run,
                max_record: record
                    .map_or_else(|| study.made_motion().to_owned(), |record| record.name.clone()),
            }
        });
        Ok(rows.collect())
    };
    let mut rows: Vec<LevelSummary> = map(&demands, of_demand)?.concat();
    rows.sort_by_key(|row| row.level);
    let measure = match study.levels() {
        Levels::Measure { measure, .. } => Some((measure.to_string(), measure.unit())),
        Levels::Factors(_) => None,
    };
    let name = open.plan.name.clone().unwrap_or_else(|| stem(&open.plan_path));
    Ok(StudySummary { name, measure, rows })
}

/// The same of every demand, on as many threads as there are.
#[cfg(feature = "parallel")]
fn map<T: Sync, R: Send>(
    items: &[T],
    work: impl Fn(&T) -> Result<R, FileError> + Sync + Send,
) -> Result<Vec<R>, FileError> {
    use rayon::prelude::*;
    items.par_iter().map(work).collect()
}

#[cfg(not(feature = "parallel"))]
fn map<T, R>(items: &[T], work: impl Fn(&T) -> Result<R, FileError>) -> Result<Vec<R>, FileError> {
    items.iter().map(work).collect()
}

fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "study".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Runs and failures of each level.
fn counts(
    study: &Study,
    layout: &Layout,
    parts: &[(u64, Table)],
) -> Result<Vec<(u64, u64)>, FileError> {
    let mut counts = vec![(0, 0); study.cases().levels as usize];
    let status = layout.schema.fields().len() - 1;
    for (first, table) in parts {
        let mut run = *first;
        each_batch(&table.path, table.open()?, &[status], |columns| {
            for status in columns.iter().flat_map(|column| column.as_string::<i32>().iter()) {
                let (runs, failures) = &mut counts[study.cases().case(run).level as usize];
                *runs += 1;
                *failures += u64::from(status != Some("ok"));
                run += 1;
            }
        })?;
    }
    Ok(counts)
}

/// One column of all parts.
struct Source<'a> {
    study: &'a Study,
    /// First run and table of each.
    parts: &'a [(u64, Table)],
    column: usize,
}

impl Source<'_> {
    /// Hands over every value that is one, with its run and level, in order.
    fn each(&self, mut take: impl FnMut(u64, usize, f64)) -> Result<(), FileError> {
        let mut values = Vec::new();
        for (first, table) in self.parts {
            let mut run = *first;
            each_batch(&table.path, table.open()?, &[self.column], |columns: &[ArrayRef]| {
                for column in columns {
                    values.clear();
                    extend(&mut values, column);
                    for &value in &values {
                        if !value.is_nan() {
                            take(run, self.study.cases().case(run).level as usize, value);
                        }
                        run += 1;
                    }
                }
            })?;
        }
        Ok(())
    }
}

/// What one pass finds.
#[derive(Clone, Debug, Default)]
struct Figures {
    count: u64,
    sum: f64,
    /// What rounding took from the sum (Neumaier 1974).
    lost: f64,
    max: f64,
    max_run: Option<u64>,
}

impl Figures {
    fn add(&mut self, run: u64, value: f64) {
        self.count += 1;
        let sum = self.sum + value;
        self.lost += if self.sum.abs() >= value.abs() {
            (self.sum - sum) + value
        } else {
            (value - sum) + self.sum
        };
        self.sum = sum;
        if self.max_run.is_none() || value.abs() > self.max.abs() {
            (self.max, self.max_run) = (value, Some(run));
        }
    }

    fn mean(&self) -> f64 {
        if self.count == 0 { f64::NAN } else { (self.sum + self.lost) / self.count as f64 }
    }
}

fn figures(source: &Source<'_>, levels: usize) -> Result<Vec<Figures>, FileError> {
    let mut figures = vec![Figures { max: f64::NAN, ..Figures::default() }; levels];
    source.each(|run, level, value| figures[level].add(run, value))?;
    Ok(figures)
}

/// A number whose order as an unsigned word is that of the values.
fn ordered(value: f64) -> u64 {
    let bits = (value + 0.0).to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

fn value_of(ordered: u64) -> f64 {
    f64::from_bits(if ordered >> 63 == 1 { ordered ^ 1 << 63 } else { !ordered })
}

/// The search for one order statistic: the digits found so far, and its rank among the values that
/// begin with them.
#[derive(Clone, Copy, Debug)]
struct Search {
    prefix: u64,
    rank: u64,
}

/// The quantiles of each level: two order statistics for each, found digit by digit from the
/// highest, one pass over the values a digit.
fn quantiles(source: &Source<'_>, figures: &[Figures]) -> Result<Vec<[f64; 3]>, FileError> {
    let ranks = |count: u64| {
        QUANTILES.map(|p| {
            let place = p * count.saturating_sub(1) as f64;
            let below = place.floor();
            ((below as u64, (below as u64 + 1).min(count.saturating_sub(1))), place - below)
        })
    };
    let mut searches: Vec<Vec<Search>> = figures
        .iter()
        .map(|figures| {
            let start = |rank| Search { prefix: 0, rank };
            ranks(figures.count).iter().flat_map(|((a, b), _)| [start(*a), start(*b)]).collect()
        })
        .collect();
    let mut shift = 64_u32;
    while shift > 0 {
        let width = DIGIT_BITS.min(shift);
        let above = shift;
        shift -= width;
        let mask = (1_u64 << width) - 1;
        // Searches of a level that look below the same digits share their counts.
        let mut tables: Vec<Vec<(u64, Vec<u64>)>> = searches
            .iter()
            .map(|searches| {
                let mut prefixes: Vec<u64> = searches.iter().map(|s| s.prefix).collect();
                prefixes.sort_unstable();
                prefixes.dedup();
                prefixes.into_iter().map(|p| (p, vec![0; 1 << width])).collect()
            })
            .collect();
        source.each(|_, level, value| {
            let word = ordered(value);
            let prefix = if above == 64 { 0 } else { word >> above };
            if let Some((_, counts)) = tables[level].iter_mut().find(|(p, _)| *p == prefix) {
                counts[(word >> shift & mask) as usize] += 1;
            }
        })?;
        for (searches, tables) in searches.iter_mut().zip(&tables) {
            for search in searches {
                let Some((_, counts)) = tables.iter().find(|(p, _)| *p == search.prefix) else {
                    continue;
                };
                for (digit, &count) in counts.iter().enumerate() {
                    if search.rank < count {
                        search.prefix = search.prefix << width | digit as u64;
                        break;
                    }
                    search.rank -= count;
                }
            }
        }
    }
    let of_level = |(figures, searches): (&Figures, &Vec<Search>)| {
        let mut quantiles = [f64::NAN; 3];
        if figures.count == 0 {
            return quantiles;
        }
        for ((quantile, pair), (_, fraction)) in
            quantiles.iter_mut().zip(searches.chunks_exact(2)).zip(ranks(figures.count))
        {
            let [low, high] = [pair[0], pair[1]].map(|search| value_of(search.prefix));
            *quantile = low + (high - low) * fraction;
        }
        quantiles
    };
    Ok(figures.iter().zip(&searches).map(of_level).collect())
}

/// Writes the summary of a folder.
pub(super) fn write(path: &Path, summary: &StudySummary) -> Result<(), FileError> {
    crate::write::write_whole(path, summary.to_csv().as_bytes())
}
