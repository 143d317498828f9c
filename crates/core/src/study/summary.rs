//! Statistics of a study by level and bound of friction: exact quantiles in memory that does not grow with the runs.

use super::Study;
use super::cases::tally;
use super::demanded::SLIDING;
use super::engine::Engine;
use crate::error::Stopped;
use crate::input::Names;
use crate::input::plan::Levels;
use crate::numerics::sort;
use crate::response::{DemandColumn, DemandKind};
use crate::table::{Cells, Column, Table};

/// Probabilities of the quantiles.
const QUANTILES: [f64; 3] = [0.16, 0.5, 0.84];

/// Number of equal steps in probability of a distribution.
const STEPS: usize = 20;

/// Bits of a number that one pass over the values tells apart.
const DIGIT_BITS: u32 = 11;

/// One demand at one level.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSummary {
    /// Index of the level, from 0.
    pub level: usize,
    /// Value of the measure at the level, in SI; `None` where levels are factors.
    pub value: Option<f64>,
    /// The factor of the level, where levels are factors.
    pub scale: Option<f64>,
    /// The bound of friction, where the model has bounds.
    pub friction: Option<&'static str>,
    /// The demand.
    pub demand: DemandColumn,
    /// Runs of the level.
    pub runs: u64,
    /// Those without an answer.
    pub failures: u64,
    /// Those of them that are known to lie beyond all values: of the sliding displacement those whose travel was
    /// used up. The others without an answer are left out.
    pub beyond: u64,
    /// Mean of the runs that have a value; NaN where none has, and where runs lie beyond.
    pub mean: f64,
    /// 16 %, 50 % and 84 % quantiles, linear between neighbours of the sorted values; infinite where they fall
    /// on runs that lie beyond.
    pub quantiles: [f64; 3],
    /// Probabilities not exceeded and the quantiles there, rising, where the study has one level.
    pub distribution: Vec<[f64; 2]>,
    /// The value largest in size; infinite where runs lie beyond.
    pub max: f64,
    /// Its run; `None` where no run has a value.
    pub max_run: Option<u64>,
    /// The record of that run.
    pub max_record: String,
}

/// A study in figures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudySummary {
    /// Name of the study.
    pub name: String,
    /// The measure that levels are values of, with its SI unit.
    pub measure: Option<(String, &'static str)>,
    /// Level by level, demand by demand; residuals without their sign.
    pub rows: Vec<LevelSummary>,
    /// What the block, the storeys and the points are called.
    pub names: Names,
    /// Kinds of warnings, each with the number of runs that gave it and the first of those.
    pub warned: Vec<(String, u64, u64)>,
}

impl StudySummary {
    /// Runs that failed.
    #[must_use]
    pub fn failures(&self) -> u64 {
        let first = self.rows.first().map(|row| row.demand);
        let of_first = self.rows.iter().filter(|row| Some(row.demand) == first);
        of_first.map(|row| row.failures).sum()
    }

    /// Runs whose travel was used up.
    #[must_use]
    pub fn beyond_travel(&self) -> u64 {
        self.rows.iter().map(|row| row.beyond).sum()
    }

    /// The rows as a table, SI.
    #[must_use]
    pub fn table(&self) -> Table {
        let rows = &self.rows;
        let texts = |text: &dyn Fn(&LevelSummary) -> String| rows.iter().map(text).collect();
        let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
        let numbers = |number: &dyn Fn(&LevelSummary) -> f64| -> Vec<f64> {
            rows.iter().map(|row| finite(number(row))).collect()
        };
        let counts = |name: &str, count: &dyn Fn(&LevelSummary) -> Option<u64>| Column {
            name: name.to_owned(),
            unit: String::new(),
            cells: Cells::Counts(rows.iter().map(|row| count(row).map(|n| n as i64)).collect()),
        };
        let mut table = Table::default();
        table.numbers("level", "", numbers(&|row| row.value.unwrap_or(f64::NAN)));
        table.numbers("scale", "", numbers(&|row| row.scale.unwrap_or(f64::NAN)));
        if rows.iter().any(|row| row.friction.is_some()) {
            table.texts("friction", texts(&|row| row.friction.unwrap_or_default().to_owned()));
        }
        table.texts("demand", texts(&|row| row.demand.name()));
        table.texts("unit", texts(&|row| row.demand.unit().to_owned()));
        table.columns.push(counts("runs", &|row| Some(row.runs)));
        table.columns.push(counts("failures", &|row| Some(row.failures)));
        if rows.iter().any(|row| row.beyond > 0) {
            table.columns.push(counts("beyond_travel", &|row| Some(row.beyond)));
        }
        table.numbers("mean", "", numbers(&|row| row.mean));
        for (name, i) in [("median", 1), ("p16", 0), ("p84", 2)] {
            table.numbers(name, "", numbers(&|row| row.quantiles[i]));
        }
        table.numbers("max", "", numbers(&|row| row.max));
        let record = |row: &LevelSummary| row.max_run.map(|_| row.max_record.clone());
        table.texts("max_record", texts(&|row| record(row).unwrap_or_default()));
        table.columns.push(counts("max_run", &|row| row.max_run));
        table
    }
}

/// Takes every run of a column with its value, in order.
pub type Take<'t, V> = &'t mut dyn FnMut(u64, V);

/// Passes over one of several columns of numbers.
pub type Passes<'a, E> = dyn Fn(usize, Take<'_, f64>) -> Result<(), E> + Sync + 'a;

/// Passes over a column of texts, in order.
pub type PassesOfTexts<'a, E> = dyn Fn(&mut dyn FnMut(u64, &str)) -> Result<(), E> + Sync + 'a;

/// Rows of a study, wherever they are kept, column by column; each is passed over several times.
pub struct Rows<'a, E> {
    /// Whether each run has an answer.
    pub solved: &'a (dyn Fn(Take<'_, bool>) -> Result<(), E> + Sync),
    /// The values of the demand at an index of [`Study::shape`]'s columns, NaN where there is none.
    pub demand: &'a Passes<'a, E>,
    /// The travel that each run has used up, NaN where it has not: no runs where nothing can be used up.
    pub travel_used_up: &'a (dyn Fn(Take<'_, f64>) -> Result<(), E> + Sync),
    /// The warnings of each run, joined by `;`.
    pub warnings: &'a PassesOfTexts<'a, E>,
}

impl Study {
    /// The rows of the study in figures.
    ///
    /// # Errors
    /// Those of the passes over the rows, and [`Stopped`] as one.
    pub fn summary<E: From<Stopped> + Send>(
        &self,
        name: &str,
        rows: &Rows<'_, E>,
        engine: &Engine<'_>,
    ) -> Result<StudySummary, E> {
        let groups = self.groups();
        let mut counts = vec![(0, 0); groups];
        (rows.solved)(&mut |run, solved| {
            let (runs, failures) = &mut counts[self.group(run)];
            *runs += 1;
            *failures += u64::from(!solved);
        })?;
        // Of each group the runs whose travel was used up, and the first of them.
        let mut used_up = vec![(0, None); groups];
        (rows.travel_used_up)(&mut |run, travel_m| {
            if !travel_m.is_nan() {
                let (count, first) = &mut used_up[self.group(run)];
                *count += 1;
                first.get_or_insert(run);
            }
        })?;
        let mut warned: Vec<(String, u64, u64)> = Vec::new();
        (rows.warnings)(&mut |run, kinds| {
            for kind in kinds.split(';').filter(|kind| !kind.is_empty()) {
                tally(&mut warned, kind, run);
            }
        })?;
        let demands = self.shape.columns().into_iter().enumerate();
        let demands: Vec<(usize, DemandColumn)> =
            demands.filter(|(_, column)| column.demand.kind != DemandKind::Flag).collect();
        let of_demand = |i: usize| -> Result<Vec<LevelSummary>, E> {
            let (index, column) = demands[i];
            // What is left has either sign: its fractiles are those of its size.
            let unsigned = column.demand.key.starts_with("residual_");
            let source = Source { study: self, rows, demand: index, unsigned };
            let mut figures = figures(&source, groups)?;
            if column.name() == SLIDING {
                let beyond = figures.iter_mut().zip(&used_up);
                beyond.for_each(|(figures, (count, first))| figures.take_beyond(*count, *first));
            }
            let single = self.cases.levels == 1 && column.demand.study_place > 0;
            let steps = if single { STEPS } else { 0 };
            let steps: Vec<f64> = (1..steps).map(|i| i as f64 / STEPS as f64).collect();
            let probabilities = [&QUANTILES[..], &steps].concat();
            let quantiles = quantiles(&source, &figures, &probabilities)?;
            let each = figures.iter().zip(quantiles).enumerate();
            let rows = each.map(|(group, (figures, quantiles))| {
                let (level, bound) = (group / self.bounds.len(), group % self.bounds.len());
                let record =
                    figures.max_run.and_then(|run| self.records.get(self.case(run).record));
                let (runs, failures) = counts[group];
                let value = self.level(level);
                LevelSummary {
                    level,
                    value,
                    scale: value.is_none().then(|| self.level_factor(level)),
                    friction: self.has_bounds().then(|| self.bounds[bound].name),
                    demand: column,
                    runs,
                    failures,
                    beyond: figures.beyond,
                    mean: figures.mean(),
                    quantiles: [quantiles[0], quantiles[1], quantiles[2]],
                    distribution: steps
                        .iter()
                        .zip(&quantiles[QUANTILES.len()..])
                        .map(|(p, value)| [*p, *value])
                        .collect(),
                    max: figures.max,
                    max_run: figures.max_run,
                    max_record: record.map_or_else(
                        || self.made_motion().to_owned(),
                        |record| record.name.clone(),
                    ),
                }
            });
            Ok(rows.collect())
        };
        let rows = engine.runs(demands.len(), of_demand)?;
        let mut rows = rows.into_iter().collect::<Result<Vec<_>, E>>()?.concat();
        sort(&mut rows, |a, b| a.level.cmp(&b.level));
        let measure = match &self.levels {
            Levels::Measure { measure, .. } => Some((measure.to_string(), measure.unit())),
            Levels::Factors(_) => None,
        };
        let names = self.variation.names();
        Ok(StudySummary { name: name.to_owned(), measure, rows, names, warned })
    }
}

impl Study {
    /// Number of levels times bounds of friction.
    fn groups(&self) -> usize {
        self.cases.levels as usize * self.bounds.len()
    }

    /// The level and bound of a run, as one number below [`Study::groups`].
    fn group(&self, run: u64) -> usize {
        let case = self.case(run);
        case.level * self.bounds.len() + case.bound
    }
}

/// One demand of all rows.
struct Source<'a, E> {
    study: &'a Study,
    rows: &'a Rows<'a, E>,
    demand: usize,
    /// Whether it is taken without its sign.
    unsigned: bool,
}

impl<E> Source<'_, E> {
    /// Hands over every value that is one, with its run and level, in order.
    fn each(&self, mut take: impl FnMut(u64, usize, f64)) -> Result<(), E> {
        (self.rows.demand)(self.demand, &mut |run, value| {
            if !value.is_nan() {
                let value = if self.unsigned { value.abs() } else { value };
                take(run, self.study.group(run), value);
            }
        })
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
    /// Runs that are known to lie beyond all values.
    beyond: u64,
}

impl Figures {
    /// Counts runs that lie beyond all values, with the first of them.
    fn take_beyond(&mut self, count: u64, first: Option<u64>) {
        if let Some(run) = first {
            self.beyond = count;
            (self.max, self.max_run) = (f64::INFINITY, Some(run));
        }
    }

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
        match (self.count, self.beyond) {
            (1.., 0) => (self.sum + self.lost) / self.count as f64,
            _ => f64::NAN,
        }
    }
}

fn figures<E>(source: &Source<'_, E>, levels: usize) -> Result<Vec<Figures>, E> {
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
fn quantiles<E>(
    source: &Source<'_, E>,
    figures: &[Figures],
    probabilities: &[f64],
) -> Result<Vec<Vec<f64>>, E> {
    // Runs that lie beyond all values come after them.
    let ranks = |figures: &Figures| -> Vec<((u64, u64), f64)> {
        let last = (figures.count + figures.beyond).saturating_sub(1);
        let rank = |p: &f64| {
            let place = p * last as f64;
            let below = place.floor();
            ((below as u64, (below as u64 + 1).min(last)), place - below)
        };
        probabilities.iter().map(rank).collect()
    };
    let mut searches: Vec<Vec<Search>> = figures
        .iter()
        .map(|figures| {
            let start = |rank| Search { prefix: 0, rank };
            ranks(figures).iter().flat_map(|((a, b), _)| [start(*a), start(*b)]).collect()
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
        let mut quantiles = vec![f64::NAN; probabilities.len()];
        if figures.count + figures.beyond == 0 {
            return quantiles;
        }
        for ((quantile, pair), ((below, above), fraction)) in
            quantiles.iter_mut().zip(searches.chunks_exact(2)).zip(ranks(figures))
        {
            let [low, high] = [pair[0], pair[1]].map(|search| value_of(search.prefix));
            let last = if fraction > 0.0 { above } else { below };
            let known = last < figures.count;
            *quantile = if known { low + (high - low) * fraction } else { f64::INFINITY };
        }
        quantiles
    };
    Ok(figures.iter().zip(&searches).map(of_level).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::plan::Plan;
    use crate::notice::NoticeKind;
    use crate::study::{Record, Row};

    /// Quantiles, means and largest values against those of the sorted rows in memory.
    #[test]
    fn summary_is_that_of_the_sorted_values() {
        let model = "[block]\nmass = \"10 t\"\n[slider]\nstatic_friction = 0.2\n\
                     kinetic_friction = 0.1\n";
        let text = "model = \"m.toml\"\n[records]\nfiles = \"*.txt\"\nscale = [1, -3]\n[vary]\n\
                    slider.kinetic_friction = { uniform = [0.02, 0.21] }\n[sampling]\n\
                    method = \"sobol\"\ncount = 37\nseed = 9\n";
        let plan = Plan::parse("p.toml", text).unwrap();
        let wave = |i: u32| 4.0 * libm::sin(0.07 * f64::from(i)) * libm::sin(0.23 * f64::from(i));
        let motion =
            crate::motion::GroundMotion::evenly_spaced(0.01, (0..400).map(wave).collect(), None);
        let record = Record::new("a", motion.unwrap());
        let study = Study::new(&plan, "m.toml", model, vec![record]).unwrap();
        let engine = Engine::unwatched();
        let rows = study.rows(0..study.runs(), &engine).unwrap();
        let solved = |take: &mut dyn FnMut(u64, bool)| {
            rows.iter().for_each(|row| take(row.run, row.error.is_none()));
            Ok::<(), Stopped>(())
        };
        let demand = |i: usize, take: &mut dyn FnMut(u64, f64)| {
            rows.iter().for_each(|row| take(row.run, row.demands[i]));
            Ok(())
        };
        let warnings = |take: &mut dyn FnMut(u64, &str)| {
            rows.iter().for_each(|row| take(row.run, &row.kinds()));
            Ok(())
        };
        let travel_used_up = |_: &mut dyn FnMut(u64, f64)| Ok(());
        let passes = Rows {
            solved: &solved,
            demand: &demand,
            travel_used_up: &travel_used_up,
            warnings: &warnings,
        };
        let summary = study.summary("s", &passes, &engine).unwrap();
        let slid = |row: &Row| !row.warnings.contains(&NoticeKind::NothingSlides);
        let still = rows.iter().filter(|row| !slid(row)).count() as u64;
        let told = summary.warned.iter().find(|(kind, ..)| kind == "nothing_slides");
        assert_eq!(told.map_or(0, |(_, runs, _)| *runs), still);
        for found in &summary.rows {
            let (index, _) = study.shape().find(&found.demand.name()).unwrap();
            let of_level = |row: &&Row| row.case.level == found.level && row.error.is_none();
            let mut values: Vec<f64> =
                rows.iter().filter(of_level).map(|row| row.demands[index]).collect();
            values.retain(|value| !value.is_nan());
            if found.demand.name() == "residual_sliding_displacement_m" {
                values.iter_mut().for_each(|value| *value = value.abs());
            }
            assert_eq!(
                (found.runs, found.failures),
                (37, 37 - rows.iter().filter(of_level).count() as u64)
            );
            if values.is_empty() {
                assert!(found.max_run.is_none() && found.mean.is_nan());
                continue;
            }
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            assert!((found.mean - mean).abs() <= 1e-14 * mean.abs().max(1e-300), "{found:?}");
            values.sort_by(f64::total_cmp);
            let distribution = found.distribution.iter().map(|[p, value]| (p, *value));
            for (p, quantile) in QUANTILES.iter().zip(found.quantiles).chain(distribution) {
                let place = p * (values.len() - 1) as f64;
                let (low, high) = (values[place.floor() as usize], values[place.ceil() as usize]);
                let expected = low + (high - low) * place.fract();
                assert!((quantile - expected).abs() <= 1e-15 * expected.abs(), "{found:?}");
            }
        }
    }
}
