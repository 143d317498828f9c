//! Measured histories: columns of a file with what they mean, in SI, each on its own clock.

use crate::error::{InputError, RecordError, similar};
use crate::input::{Channel, ColumnRef, MappedColumn, Mapping, Zero};
use crate::notice::{Notice, NoticeKind};
use crate::numerics::fractile::upper_median;
use crate::record::{self, Column, Columns, Sampling, bracket};
use crate::units::{Dimension, Unit};

/// One measured quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredSeries {
    /// What it is.
    pub channel: Channel,
    /// Where it comes from, in words: `column "A1" in g, × −1`.
    pub origin: String,
    /// When its values were taken, in s, from the file's first row; its own shift included.
    pub times_s: Vec<f64>,
    /// Its values in SI.
    pub values: Vec<f64>,
    /// Whether the mapping states the zero of its sensor.
    pub zero_known: bool,
}

/// The measured quantities of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The caller's name for the file.
    pub source_name: String,
    /// The constant time step in s, or `None` where the rows are unevenly spaced.
    pub dt_s: Option<f64>,
    /// The quantities, in the order of the file's columns.
    pub series: Vec<MeasuredSeries>,
    /// What the reader of a result must know.
    pub warnings: Vec<Notice>,
    /// Whether the mapping says that all sensors are right as measured.
    pub zero_as_measured: bool,
    /// Whether displacement and force come from files with clocks of their own, which were aligned.
    pub is_of_two_clocks: bool,
    /// Names of the file's columns, for messages.
    names: String,
}

/// What is wrong with a measured file or its mapping.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeasuredError {
    /// The file.
    #[error(transparent)]
    File(#[from] RecordError),
    /// The mapping.
    #[error(transparent)]
    Mapping(#[from] InputError),
}

impl Measured {
    /// Reads a table of numbers; columns that the mapping does not name are known by their own
    /// names, which are those of `history.csv` or the same with another unit
    /// (`block_acceleration_g`, `block_acceleration (g)`). Other columns are left alone.
    ///
    /// # Errors
    /// [`MeasuredError`] for what is no table of finite numbers, a column that is not there, a
    /// unit that is missing or not the one the header states, no times, times that run backwards
    /// or leave a gap.
    pub fn read(source_name: &str, bytes: &[u8], mapping: &Mapping) -> Result<Self, MeasuredError> {
        let columns = record::columns(source_name, bytes).map_err(MeasuredError::from);
        columns.and_then(|columns| Self::of_columns(columns, mapping)).map_err(
            |error| match error {
                MeasuredError::File(error) => of_format(source_name, bytes, error).into(),
                other => other,
            },
        )
    }

    /// As [`Measured::read`], of columns that were read already.
    ///
    /// # Errors
    /// As [`Measured::read`], but for what makes no table.
    pub fn of_columns(columns: Columns, mapping: &Mapping) -> Result<Self, MeasuredError> {
        let mut found: Vec<(usize, MeasuredSeries)> = Vec::new();
        let mut taken = vec![false; columns.columns.len()];
        let mut time = None;
        let mut has_unit_of_time = true;
        for entry in &mapping.columns {
            let column = find(&columns, mapping, entry, &entry.column)?;
            taken[column] = true;
            let minus = match &entry.minus {
                Some(minus) => Some(find(&columns, mapping, entry, minus)?),
                None => None,
            };
            if let Some(minus) = minus {
                taken[minus] = true;
            }
            let series = mapped(&columns, mapping, entry, column, minus)?;
            if entry.channel == Channel::Time {
                time = Some((column, series.values));
            } else {
                found.push((column, series));
            }
        }
        for (index, column) in columns.columns.iter().enumerate().filter(|(i, _)| !taken[*i]) {
            let Some((channel, unit)) = by_name(column) else { continue };
            let mapped_already = mapping.get(channel).is_some()
                || (channel == Channel::Time && mapping.dt_s.is_some());
            if mapped_already {
                continue;
            }
            let twice = found.iter().any(|(_, series)| series.channel == channel);
            if twice || (channel == Channel::Time && time.is_some()) {
                let expected = format!("one column of {}, or a mapping", channel.name());
                return Err(columns.error(0, index + 1, expected, column.name.clone()).into());
            }
            let values = columns.numbers(index)?.iter().map(|value| unit.to_si(*value)).collect();
            if channel == Channel::Time {
                let stated = stated_unit(&column.name, Dimension::Time);
                has_unit_of_time = !matches!(stated, Stated::None);
                time = Some((index, values));
                continue;
            }
            let origin = format!("column {:?}, in {}", column.name, unit.name());
            let zero_known = false;
            let times_s = Vec::new();
            found.push((index, MeasuredSeries { channel, origin, times_s, values, zero_known }));
        }
        let names = columns.names();
        let (times_s, dt_s, mut warnings) = clock(&columns, mapping, time)?;
        warnings.extend(columns.texts().map(|column| {
            let message = format!("the column \"{}\" holds no numbers: left out", column.name);
            Notice::new(NoticeKind::ColumnSkipped, message)
        }));
        found.sort_by_key(|(column, _)| *column);
        let series = found.into_iter().map(|(_, mut series)| {
            let offset_s = mapping.get(series.channel).map_or(0.0, |entry| entry.offset_s);
            series.times_s = times_s.iter().map(|t| t + offset_s).collect();
            series
        });
        let mut series: Vec<MeasuredSeries> = series.collect();
        match mapping.zero {
            Zero::Unknown => {}
            Zero::AsMeasured => series.iter_mut().for_each(|series| series.zero_known = true),
            Zero::First(span_s) => {
                let count = times_s.iter().take_while(|t| **t <= span_s).count();
                if count < 2 || count == times_s.len() {
                    let expected = "a span with two samples or more that ends before the file does";
                    return Err(mapping.error_at_zero(expected, format!("{count} samples")).into());
                }
                // Sensors whose zero the mapping states have it already.
                for series in series.iter_mut().filter(|series| !series.zero_known) {
                    let mean = series.values[..count].iter().sum::<f64>() / count as f64;
                    series.values.iter_mut().for_each(|value| *value -= mean);
                    series.origin.push_str(&format!(", less the mean of its first {span_s} s"));
                    series.zero_known = true;
                }
            }
        }
        let source_name = columns.source_name.clone();
        let zero_as_measured = mapping.zero == Zero::AsMeasured;
        warnings.extend(doubt_of_seconds(has_unit_of_time, &times_s));
        let is_of_two_clocks = false;
        Ok(Self { source_name, dt_s, series, warnings, zero_as_measured, is_of_two_clocks, names })
    }

    /// Whether a file has the column of an entry.
    pub(super) fn has(columns: &Columns, mapping: &Mapping, entry: &MappedColumn) -> bool {
        find(columns, mapping, entry, &entry.column).is_ok()
    }

    /// With the quantities of another file of the same test, those that are not there yet.
    #[must_use]
    pub(super) fn beside(mut self, other: Self) -> Self {
        let known: Vec<Channel> = self.series.iter().map(|series| series.channel).collect();
        self.series.extend(other.series.into_iter().filter(|s| !known.contains(&s.channel)));
        self.warnings.extend(other.warnings);
        self.source_name = format!("{} + {}", self.source_name, other.source_name);
        self.names = format!("{}, {}", self.names, other.names);
        self.dt_s = self.dt_s.filter(|dt_s| other.dt_s == Some(*dt_s));
        self
    }

    /// Number of samples of the longest quantity.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.series.iter().map(|series| series.times_s.len()).max().unwrap_or(0)
    }

    /// The first samples of every quantity.
    #[must_use]
    pub fn first(&self, samples: usize) -> Self {
        let first = |series: &MeasuredSeries| MeasuredSeries {
            times_s: series.times_s.iter().take(samples).copied().collect(),
            values: series.values.iter().take(samples).copied().collect(),
            ..series.clone()
        };
        Self { series: self.series.iter().map(first).collect(), ..self.clone() }
    }

    /// The series of a quantity.
    #[must_use]
    pub fn get(&self, channel: Channel) -> Option<&MeasuredSeries> {
        self.series.iter().find(|series| series.channel == channel)
    }

    /// The series of a quantity that must be there.
    ///
    /// # Errors
    /// [`RecordError`] that names the columns of the file and says how one is chosen.
    pub fn require(&self, channel: Channel) -> Result<&MeasuredSeries, RecordError> {
        self.get(channel).ok_or_else(|| {
            let (name, unit) = (channel.name(), channel.dimension().si_unit());
            RecordError {
                source_name: self.source_name.clone(),
                line: 1,
                column: 1,
                offset: None,
                expected: format!(
                    "a column of {name}: name it {} in the header, or say which it is with \
                     the mapping \"{name}=COLUMN [{unit}]\"",
                    column_name(channel)
                ),
                found: format!("the columns {}", self.names),
            }
        })
    }
}

/// The name of a quantity's column in `history.csv`, with its SI unit.
#[must_use]
pub fn column_name(channel: Channel) -> String {
    let unit = channel.dimension().si_unit().replace('/', "_per_").replace(' ', "_");
    format!("{}_{}", channel.name(), unit.to_lowercase())
}

/// The column of a name, else of a number from 1 after `#`.
fn find(
    columns: &Columns,
    mapping: &Mapping,
    entry: &MappedColumn,
    wanted: &ColumnRef,
) -> Result<usize, InputError> {
    let named = |name: &str| columns.columns.iter().position(|column| column.name == name);
    let alike = || {
        let mut same = columns.columns.iter().enumerate().filter(|(_, column)| {
            column.name.eq_ignore_ascii_case(&wanted.name) || base(&column.name) == wanted.name
        });
        same.next().map(|(index, _)| index).filter(|_| same.next().is_none())
    };
    let numbered = || {
        let number = wanted.name.strip_prefix('#')?.trim().parse::<usize>().ok()?;
        number.checked_sub(1).filter(|index| *index < columns.columns.len())
    };
    named(&wanted.name).or_else(alike).or_else(numbered).ok_or_else(|| {
        let names: Vec<&str> = columns.columns.iter().map(|column| column.name.as_str()).collect();
        let nearest = similar(&wanted.name, names.iter().copied());
        let expected = format!("one of the columns {} of {}", columns.names(), columns.source_name);
        mapping.error_at_column(entry, wanted, expected, nearest)
    })
}

/// A column in SI as its entry says.
fn mapped(
    columns: &Columns,
    mapping: &Mapping,
    entry: &MappedColumn,
    column: usize,
    minus: Option<usize>,
) -> Result<MeasuredSeries, MeasuredError> {
    let dimension = entry.channel.dimension();
    let in_si = |index: usize| -> Result<(Vec<f64>, &'static Unit), MeasuredError> {
        let column = &columns.columns[index];
        let stated = stated_unit(&column.name, dimension);
        let unit = match (entry.unit, stated) {
            (Some(given), Stated::Unit(stated)) if given != stated => {
                let expected = format!(
                    "the unit that the header of {:?} states, {} (leave it out)",
                    column.name,
                    stated.name()
                );
                let found = format!("\"{}\"", given.name());
                return Err(mapping.error_at(entry, expected, found).into());
            }
            (None, Stated::Other(other)) => {
                let expected = format!(
                    "a column of {}, such as in {}, or its true unit in brackets",
                    dimension.name(),
                    dimension.si_unit()
                );
                let found = format!("the unit \"{other}\"");
                return Err(mapping.error_at(entry, expected, found).into());
            }
            (Some(given), _) => given,
            (None, Stated::Unit(stated)) => stated,
            (None, Stated::None) => {
                let expected = format!(
                    "a unit, which the header does not state, such as \"{} [{}]\"",
                    column.name,
                    dimension.si_unit()
                );
                return Err(mapping.error_at(entry, expected, "none".to_owned()).into());
            }
        };
        Ok((columns.numbers(index)?.iter().map(|value| unit.to_si(*value)).collect(), unit))
    };
    let (mut values, unit) = in_si(column)?;
    let name = &columns.columns[column].name;
    let mut origin = format!("column {name:?}");
    if let Some(minus) = minus {
        let (subtracted, _) = in_si(minus)?;
        for (value, other) in values.iter_mut().zip(&subtracted) {
            *value -= other;
        }
        origin.push_str(&format!(" − {:?}", columns.columns[minus].name));
    }
    origin.push_str(&format!(", in {}", unit.name()));
    if let Some(zero) = entry.zero {
        values.iter_mut().for_each(|value| *value -= zero);
        origin.push_str(&format!(", less {zero} {}", dimension.si_unit()));
    }
    if entry.factor != 1.0 {
        values.iter_mut().for_each(|value| *value *= entry.factor);
        origin.push_str(&format!(", × {}", entry.factor));
    }
    if entry.offset_s != 0.0 {
        origin.push_str(&format!(", {:+} s", entry.offset_s));
    }
    let zero_known = entry.zero.is_some();
    Ok(MeasuredSeries { channel: entry.channel, origin, times_s: Vec::new(), values, zero_known })
}

/// What a column's name says of its unit.
enum Stated {
    None,
    Unit(&'static Unit),
    /// A unit in brackets that is not of the dimension.
    Other(String),
}

/// The unit in a column's name: in brackets, or after an underscore (`_m_per_s2`).
fn stated_unit(name: &str, dimension: Dimension) -> Stated {
    if let Some((_, word)) = bracket(name) {
        return match unit_of(word, dimension) {
            Some(unit) => Stated::Unit(unit),
            None => Stated::Other(word.to_owned()),
        };
    }
    let suffixes = name.match_indices('_').map(|(at, _)| &name[at + 1..]);
    let mut units = suffixes.filter_map(|suffix| unit_of(suffix, dimension));
    units.next().map_or(Stated::None, Stated::Unit)
}

/// The unit of a word, capital letters or not where that is plain.
fn unit_of(word: &str, dimension: Dimension) -> Option<&'static Unit> {
    let spelt = word.replace("_per_", "/").replace('_', " ").replace("sec", "s");
    if let Ok(unit) = crate::units::parse_unit(&spelt, dimension) {
        return Some(unit);
    }
    let mut alike = dimension.units().iter().filter(|u| u.name().eq_ignore_ascii_case(&spelt));
    alike.next().filter(|_| alike.next().is_none())
}

/// A column's name without its unit in brackets.
fn base(name: &str) -> &str {
    bracket(name).map_or(name, |(base, _)| base)
}

/// The quantity and unit that a column's own name states.
fn by_name(column: &Column) -> Option<(Channel, &'static Unit)> {
    let name = base(&column.name).to_lowercase();
    if column.is_time || name == "t" || name == "time" {
        return match stated_unit(&column.name, Dimension::Time) {
            Stated::Unit(unit) => Some((Channel::Time, unit)),
            Stated::None => Some((Channel::Time, &Dimension::Time.units()[0])),
            Stated::Other(_) => None,
        };
    }
    if bracket(&column.name).is_some() {
        let channel = Channel::parse(&name)?;
        let Stated::Unit(unit) = stated_unit(&column.name, channel.dimension()) else {
            return None;
        };
        return Some((channel, unit));
    }
    name.match_indices('_').find_map(|(at, _)| {
        let channel = Channel::parse(&name[..at])?;
        Some((channel, unit_of(&column.name[at + 1..], channel.dimension())?))
    })
}

/// The error for a file of ground motion, which says so; else as it is.
fn of_format(source_name: &str, bytes: &[u8], error: RecordError) -> RecordError {
    // It is the whole file, whatever of it was no number.
    let another = |found: String| RecordError {
        expected: "a table with a column a sensor".into(),
        found,
        ..RecordError { line: 1, column: 1, offset: None, ..error.clone() }
    };
    if bytes.split(|byte| *byte == b'\n').any(|line| line.trim_ascii() == b"[block]") {
        return another("a model: what was measured stands before it".to_owned());
    }
    match record::read(source_name, bytes, &record::Options::default()) {
        Ok(record) if record.format != record::Format::Delimited => {
            another(format!("a record of ground motion, {}", record.layout))
        }
        _ => error,
    }
}

type Clock = (Vec<f64>, Option<f64>, Vec<Notice>);

/// The times of the rows in s from the first.
fn clock(
    columns: &Columns,
    mapping: &Mapping,
    time: Option<(usize, Vec<f64>)>,
) -> Result<Clock, RecordError> {
    let rows = columns.rows();
    let even = |dt_s: f64| (0..rows).map(|row| row as f64 * dt_s).collect::<Vec<f64>>();
    let Some((column, times_s)) = time else {
        return match mapping.dt_s {
            Some(dt_s) => Ok((even(dt_s), Some(dt_s), vec![])),
            None => {
                let expected = "a column of times (time_s), or the mapping \"time=COLUMN [s]\", or \
                                \"time=0.01 s\" for a time step";
                Err(columns.error(0, 1, expected, format!("the columns {}", columns.names())))
            }
        };
    };
    let at = |row: usize, expected: String| {
        columns.error(row, column + 1, expected, format!("{} s", times_s[row]))
    };
    for row in 1..rows {
        let third = row >= 2 && times_s[row - 2] == times_s[row];
        if !(times_s[row] - times_s[0]).is_finite() || times_s[row] < times_s[row - 1] || third {
            let expected = format!("a time after {} s", times_s[row - 1]);
            return Err(at(row, expected));
        }
    }
    if times_s[rows - 1] <= times_s[0] {
        return Err(at(rows - 1, "times that increase".to_owned()));
    }
    if let Some((row, step_s)) = gap(&times_s) {
        let (from, to) = (times_s[row - 1], times_s[row]);
        let expected = format!(
            "a sample every {step_s:.6} s (a gap is not filled: cut the file before or after it)"
        );
        let found = format!("a gap from {from} s to {to} s");
        return Err(columns.error(row, column + 1, expected, found));
    }
    let (sampling, warnings) = record::of_times(times_s, None);
    Ok(match sampling {
        Sampling::Dt(dt_s) => (even(dt_s), Some(dt_s), warnings),
        Sampling::Times(times_s) => {
            let start_s = times_s[0];
            (times_s.into_iter().map(|t| t - start_s).collect(), None, warnings)
        }
    })
}

/// The doubt about times without a unit whose steps are whole and long: milliseconds look so.
fn doubt_of_seconds(has_unit: bool, times_s: &[f64]) -> Option<Notice> {
    /// Steps in s from which on times without a unit are doubted.
    const LONG_STEP_S: f64 = 0.5;
    let step_s = upper_median(times_s.windows(2).map(|t| t[1] - t[0]))?;
    let is_whole = times_s.iter().all(|t| t.fract() == 0.0);
    (!has_unit && step_s >= LONG_STEP_S && is_whole).then(|| {
        let message = format!(
            "the samples are {step_s} s apart, if the times, which state no unit, are seconds; of milliseconds \
             say so with the mapping \"time=COLUMN [ms]\""
        );
        Notice::new(NoticeKind::LongStep, message)
    })
}

/// The row after the first gap, and the usual step: where nine of ten steps agree to a hundredth
/// (or to the last decimal of the times), one that is half as long again is a gap.
fn gap(times_s: &[f64]) -> Option<(usize, f64)> {
    let steps: Vec<f64> = times_s.windows(2).map(|t| t[1] - t[0]).collect();
    let usual_s = upper_median(steps.iter().copied())?;
    let agree = steps.iter().filter(|step| (*step - usual_s).abs() <= 0.1 * usual_s).count();
    if usual_s <= 0.0 || 10 * agree < 9 * steps.len() {
        return None;
    }
    steps.iter().position(|step| *step > 1.5 * usual_s).map(|row| (row + 1, usual_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, options: &[&str]) -> Result<Measured, String> {
        let options: Vec<String> = options.iter().map(|o| (*o).to_owned()).collect();
        let mapping = Mapping::parse(None, &options).map_err(|error| error.to_string())?;
        Measured::read("m.csv", text.as_bytes(), &mapping).map_err(|error| error.to_string())
    }

    #[test]
    fn columns_of_history_need_no_mapping() {
        let text = "time_s,table_acceleration_m_per_s2,sliding_displacement_mm,\
                    storey1_acceleration (g),friction_force_n,remark\n\
                    1.0,0.5,10,1,3,7\n1.5,-0.5,-20,2,4,7\n";
        let measured = read(text, &[]).unwrap();
        let channels: Vec<_> = measured.series.iter().map(|s| s.channel.name()).collect();
        assert_eq!(
            channels,
            [
                "table_acceleration",
                "sliding_displacement",
                "storey1_acceleration",
                "friction_force"
            ]
        );
        assert_eq!(measured.series[1].values, [0.01, -0.02]);
        assert_eq!(measured.series[2].values, [9.80665, 2.0 * 9.80665]);
        assert_eq!(measured.series[0].times_s, [0.0, 0.5]);
        assert_eq!(measured.dt_s, Some(0.5));
    }

    #[test]
    fn mapping_takes_differences_signs_and_shifts() {
        let text = "t,A1,X1,U\n0,1,12,2\n10,-1,14,3\n";
        let options = [
            "time=t [ms]",
            "block_acceleration=A1 [g] * -1",
            "sliding_displacement=X1 - U [mm] @ 5 ms",
        ];
        let measured = read(text, &options).unwrap();
        let block = measured.get(Channel::BlockAcceleration).unwrap();
        assert_eq!(block.values, [-9.80665, 9.80665]);
        assert_eq!(block.origin, "column \"A1\", in g, × -1");
        let sliding = measured.get(Channel::SlidingDisplacement).unwrap();
        assert_eq!(sliding.values, [0.012 - 0.002, 0.014 - 0.003]);
        assert_eq!(sliding.times_s, [0.005, 0.015]);
        assert_eq!(sliding.origin, "column \"X1\" − \"U\", in mm, +0.005 s");
    }

    #[test]
    fn faults_name_file_line_and_remedy() {
        assert_eq!(
            read("time_s,force_n\n0,1\n0.01,\n0.02,1\n", &[]).unwrap_err(),
            "m.csv:3:6: expected a finite number, found \"the end of the line\""
        );
        let rows: String = (0..40)
            .filter(|i| *i != 20)
            .map(|i| format!("{:.2},1\n", 0.01 * f64::from(i)))
            .collect();
        assert_eq!(
            read(&format!("time_s,force_n\n{rows}"), &[]).unwrap_err(),
            "m.csv:22:1: expected a sample every 0.010000 s (a gap is not filled: cut the file \
             before or after it), found \"a gap from 0.19 s to 0.21 s\""
        );
        let text = "time_s,acc_block\n0,1\n1,2\n";
        assert_eq!(
            read(text, &["block_acceleration=acc_blok [g]"]).unwrap_err(),
            "mapping block_acceleration=acc_blok [g]:1:20: block_acceleration: expected one of the \
             columns \"time_s\", \"acc_block\" of m.csv, found \"acc_blok\"; nearest is \
             \"acc_block\""
        );
        assert!(
            read(text, &["block_acceleration=acc_block"])
                .unwrap_err()
                .contains("expected a unit, which the header")
        );
        let stated = "time_s,acc (g)\n0,1\n1,2\n";
        assert!(
            read(stated, &["block_acceleration=acc (g) [m/s2]"]).is_err(),
            "a unit other than the stated one"
        );
        assert!(read(stated, &["force=#2"]).unwrap_err().contains("found the unit \"g\""));
        let measured = read(text, &[]).unwrap();
        let missing = measured.require(Channel::TableAcceleration).unwrap_err().to_string();
        assert!(missing.contains("table_acceleration_m_per_s2"), "{missing}");
        assert!(missing.contains("time_s"), "{missing}");
        assert!(read("a,b\n1,2\n3,4\n", &[]).unwrap_err().contains("a column of times"));
        // Of a record of the public domain, whatever its numbers look like.
        let record = include_bytes!("../../../../data/records/nga-west2.AT2");
        let mapping = Mapping::parse(None, &[]).unwrap();
        let error = Measured::read("r.AT2", record, &mapping).unwrap_err().to_string();
        let expected = "r.AT2:1:1: expected a table with a column a sensor, found \"a record of ground \
                        motion, PEER AT2\"";
        assert!(error.starts_with(expected), "{error}");
        assert!(read("time_s,b\n1,2\n0,4\n", &[]).unwrap_err().contains("a time after 1 s"));
    }

    /// Which of two lines of names is meant is not guessed; units below names are no names.
    #[test]
    fn names_on_two_lines_are_refused() {
        let rows = "0,1,2\n0.01,2,3\n0.02,3,4\n";
        let stated = "time (s),displacement (mm),force (kN)\n";
        let found = |header: &str| read(&format!("{header}{rows}"), &[]);
        for header in [stated, "t,s,F\n"] {
            assert_eq!(
                found(&format!("{stated}{header}")).unwrap_err(),
                "m.csv:2:1: expected one line of names, or names and below them their units, found \
                 \"names on two lines\""
            );
        }
        assert_eq!(
            found(&format!("{stated}s,mm,N\n")).unwrap_err(),
            "m.csv:2:1: expected the unit of \"force (kN)\", found \"N\""
        );
        let once = found(stated).unwrap();
        let twice = found(&format!("{stated}s,mm,kN\n")).unwrap();
        let below = found("time,displacement,force\ns,mm,kN\n").unwrap();
        assert!(once.series == twice.series && below.get(Channel::Force).is_some(), "{below:?}");
        assert!(found(&format!("Test 3\n{stated}")).is_ok());
    }

    /// Milliseconds called seconds make a rate of friction a thousand times too low.
    #[test]
    fn milliseconds_without_a_unit_are_doubted() {
        let rows = |step: usize| -> String {
            (0..50).map(|i| format!("{},{}\n", step * i, i % 7)).collect()
        };
        let kinds = |header: &str| -> Vec<NoticeKind> {
            let measured = read(&format!("{header}\n{}", rows(5)), &[]).unwrap();
            measured.warnings.iter().map(|warning| warning.kind).collect()
        };
        assert_eq!(kinds("Time,force_n"), [NoticeKind::LongStep]);
        for header in ["Time (s),force_n", "time_ms,force_n", "time_s,force_n"] {
            assert_eq!(kinds(header), [], "{header}");
        }
    }

    /// A column of remarks is left out, and that is said; a fault matters where its column is used.
    #[test]
    fn columns_of_text_are_left_out() {
        let text = "time_s,operator,force_n,temperature (C)\n0,A. B.,1,20\n0.01,A. B.,2,n/a\n";
        let measured = read(text, &[]).unwrap();
        assert_eq!(measured.get(Channel::Force).unwrap().values, [1.0, 2.0]);
        assert_eq!(measured.warnings[0].kind, NoticeKind::ColumnSkipped);
        let error = read(&text.replace(",2,", ",,"), &[]).unwrap_err();
        assert!(error.starts_with("m.csv:3:12: expected a finite number"), "{error}");
    }

    #[test]
    fn names_of_columns() {
        assert_eq!(column_name(Channel::BlockAcceleration), "block_acceleration_m_per_s2");
        assert_eq!(column_name(Channel::StoreyVelocity(2)), "storey2_velocity_m_per_s");
        assert_eq!(column_name(Channel::FrictionForce), "friction_force_n");
    }
}
