//! Delimited text: one column of values, times and values, or many columns, with or without a
//! header; separated by comma, semicolon, tab or blanks; with decimal point or decimal comma.
//!
//! Columns of text, and of quantities that are no motion, are passed over, whatever stands in them; so are
//! columns of which every cell is empty. What was passed over is said.
//!
//! Lines that begin with `#`, `%`, `!`, `//` or `*` and hold a letter are comments. A few lines of
//! other text may stand first; the last of them (or of the comments) names the columns if it has as
//! many names. A first line of two numbers, count and step, is understood where what follows shows
//! that it is one. Without header and times, three or more values a line are one series.

mod clock;
mod columns;
mod header;
mod layout;
mod style;
mod table;
mod target;
pub(crate) mod texts;
mod words;

use super::quality;
use super::text::Text;
use super::{
    Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, Units, keys_to_add,
    sampling, to_si,
};
pub(super) use columns::read as read_columns;
pub use columns::{Column, Columns};
pub use header::bracket;
use header::{Header, Name, Unit, is_comment};
use layout::Layout;
use slipstick_dynamics::notice::{Notice, NoticeKind};
use table::TextTable;
pub(super) use target::read as read_target;

/// Most columns of a record: each that is motion is a channel, of which much is computed.
const MAX_COLUMNS: usize = 1000;

/// Reads the file; channels are named by the header, else `column 1`, `column 2`, ….
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let header = Header::of(text)?;
    let table = TextTable::read(text, &header)?;
    let given_s = table.given_step(text, options.dt_s)?;
    let layout = layout::of(text, &header, &table, given_s)?;
    let (series, mut warnings) = series(text, &header, &table, &layout, options.units)?;
    warnings.extend(count_differs(text, &header, &table));
    let missing_units = series.iter().any(|s| s.units.is_none());
    let missing_step = layout.times_s.is_none() && given_s.is_none();
    if missing_units || missing_step {
        let mut expected = keys_to_add(missing_units, missing_step);
        if layout.index.is_some() && missing_step {
            expected.push_str("; the first column counts its rows, which are no times");
        }
        return Err(table.error_at_start(text, expected));
    }
    let sampling = match layout.times_s {
        Some(times_s) => {
            let (sampling, doubts) = sampling::of_times(times_s, given_s);
            warnings.extend(doubts);
            sampling
        }
        None => Sampling::Dt(given_s.unwrap_or_default()),
    };
    if let Sampling::Times(times_s) = &sampling
        && times_s.windows(2).all(|t| t[0] < t[1])
        && series.iter().all(|series| never_returns(&series.values))
    {
        let expected =
            "a time history, not a spectrum: one that is below 0 at times, or 0 at its end";
        return Err(table.error_found(text, expected, "uneven steps and no value below 0"));
    }
    let channel = |series: ColumnSeries| {
        let units = series.units?;
        Some(Channel {
            name: series.name,
            event: None,
            station: None,
            component: None,
            azimuth_deg: None,
            units,
            values: to_si(series.values, &units),
            sampling: sampling.clone(),
            filter: FilterCorners::default(),
            warnings: vec![],
        })
    };
    let channels = series.into_iter().filter_map(channel).collect();
    Ok(Record { format: Format::Delimited, layout: layout.words, channels, warnings })
}

/// What a line of the header says that is a number and `samples`, as EXSIM writes it, where there are others.
fn count_differs(text: &Text, header: &Header, table: &TextTable) -> Option<Notice> {
    let stated = text.lines().take(header.lines).find_map(|line| {
        let mut words = line.words().map(|word| line.str(&word));
        let count = words.next()?.parse::<usize>().ok()?;
        let is_count = words.next()? == "samples" && words.next().is_none();
        is_count.then_some((line.number, count))
    });
    let (line, count) = stated.filter(|(_, count)| *count != table.rows())?;
    let rows = table.rows();
    let message = format!("line {line} states {count} samples, {rows} stand there");
    let kind = if rows < count { NoticeKind::Truncated } else { NoticeKind::HeaderDiffers };
    Some(Notice::new(kind, message))
}

/// Values of one channel as they stand, and their units if they are known.
struct ColumnSeries {
    name: String,
    values: Vec<f64>,
    units: Option<Units>,
}

/// Every column that is motion, with the units that the header states, else those given.
fn series(
    text: &Text,
    header: &Header,
    table: &TextTable,
    layout: &Layout,
    given: Option<Units>,
) -> Result<(Vec<ColumnSeries>, Vec<Notice>), RecordError> {
    let mut warnings = layout.notices.clone();
    if let Some(line) = table.tail {
        warnings.push(quality::last_line_of_words(line));
    }
    if layout.wrapped {
        let message = format!(
            "{} values a line without header and times were read along the lines as one series",
            table.columns
        );
        warnings.push(Notice::new(NoticeKind::ReadAlongLines, message));
        let (name, values) = ("column 1".to_owned(), table.cells.clone());
        return Ok((vec![ColumnSeries { name, values, units: given }], warnings));
    }
    if table.columns > MAX_COLUMNS {
        let expected = format!("at most {MAX_COLUMNS} columns");
        return Err(table.error_found(text, expected, &table.columns.to_string()));
    }
    let mut series = Vec::new();
    // Columns whose unit nobody knows.
    let mut unknown: Vec<usize> = Vec::new();
    let offsets = offsets(text);
    let is_motion =
        |c: &usize| ![layout.time_column, layout.index, table.clock[1]].contains(&Some(*c));
    for column in (0..table.columns).filter(is_motion) {
        let named = layout.names.as_ref().map(|names| &names[column]);
        let name = named.map_or_else(|| format!("column {}", column + 1), |n| n.text.clone());
        let unit = named.and_then(|named| named.unit);
        let unit = if named.is_some_and(Name::is_time) { Some(Unit::Other) } else { unit };
        let units = match (unit, given) {
            _ if table.is_text(column) => {
                let message = format!("the column \"{name}\" holds no numbers: skipped");
                warnings.push(Notice::new(NoticeKind::ColumnSkipped, message));
                continue;
            }
            (Some(Unit::Other | Unit::Time(_)), _) => {
                let of_unknown = named.and_then(Name::unknown_unit);
                unknown.extend(of_unknown.map(|_| column));
                let why = match of_unknown {
                    Some(unit) => format!("has the unit \"{unit}\", which is not known"),
                    None => "is no acceleration, velocity or displacement".to_owned(),
                };
                let message = format!("the column \"{name}\" {why}: skipped");
                warnings.push(Notice::new(NoticeKind::ColumnSkipped, message));
                continue;
            }
            (Some(Unit::Motion(stated)), Some(given))
                if stated != given && stated.quantity() == given.quantity() =>
            {
                let expected = format!("a column in the units given, {given} (leave them out)");
                return Err(header.error(text, expected, &name));
            }
            (Some(Unit::Motion(stated)), _) => Some(stated),
            (None, None) if named.is_some_and(Name::is_ground_acceleration) => {
                let (units, notice) = units_of_ground(&name, table.column(column));
                warnings.push(notice);
                units
            }
            (_, given) => given,
        };
        table.require(text, column)?;
        let mut values: Vec<f64> = table.column(column).collect();
        if let Some((_, offset)) = offsets.iter().find(|(of, _)| *of == name) {
            values.iter_mut().for_each(|value| *value -= offset);
            let message =
                format!("the offset of \"{name}\" that the file states, {offset}, was taken off");
            warnings.push(Notice::new(NoticeKind::MeanRemoved, message));
        }
        series.push(ColumnSeries { name, values, units });
    }
    if let (true, Some(names), [_, ..]) = (series.is_empty(), &layout.names, &unknown[..]) {
        let name = |column: &usize| names[*column].text.clone();
        let Some(units) = given else {
            let expected = "a column of acceleration, velocity or displacement in a unit that is known, \
                            such as g, m/s2, cm/s2, gal or %g (or give its unit: units = \"g\" in \
                            [motion], --units g)";
            return Err(header.error(text, expected, &name(&unknown[0])));
        };
        for column in unknown {
            table.require(text, column)?;
            let (name, values) = (name(&column), table.column(column).collect());
            let message =
                format!("the unit of \"{name}\" is not known: the one given, {units}, was taken");
            warnings.retain(|w| !w.message.starts_with(&format!("the column \"{name}\"")));
            warnings.push(Notice::new(NoticeKind::QuantityDiffers, message));
            series.push(ColumnSeries { name, values, units: Some(units) });
        }
    }
    if series.is_empty() {
        table.require_all(text)?;
        let expected = "a column of acceleration, velocity or displacement";
        return Err(header.error(text, expected, "none"));
    }
    Ok((series, warnings))
}

/// What K-NET's table says is to be taken off its columns: `#Offset`, then names, then numbers.
fn offsets(text: &Text) -> Vec<(String, f64)> {
    let mut lines = text.lines();
    let is_knet = |title: &str| title.starts_with("#K-NET") || title.starts_with("#KiK-net");
    if !lines.next().is_some_and(|line| is_knet(&line.trimmed())) {
        return vec![];
    }
    let mut cells = lines
        .take_while(is_comment)
        .skip_while(|line| line.trimmed() != "#Offset")
        .skip(1)
        .map(|line| line.trimmed().trim_start_matches('#').to_owned());
    let (names, values) = (cells.next().unwrap_or_default(), cells.next().unwrap_or_default());
    let number = |(name, value): (&str, &str)| Some((name.to_owned(), value.parse().ok()?));
    names.split(',').zip(values.split(',')).filter_map(number).collect()
}

/// Fewest values that look like a spectrum.
const FEWEST_ORDINATES: usize = 5;

/// Whether values are at least as large as 0, leave it once and never come back, and differ: a spectrum's,
/// and no motion's, which ends at rest.
fn never_returns(values: &[f64]) -> bool {
    values.len() >= FEWEST_ORDINATES
        && values.iter().any(|value| *value != values[0])
        && values.iter().all(|value| *value >= 0.0)
        && values.iter().skip_while(|value| **value == 0.0).all(|value| *value > 0.0)
        && values.last().is_some_and(|value| *value > 0.0)
}

/// Above this peak values of a ground acceleration are no multiples of g, below it hardly m/s².
const LARGEST_IN_G: f64 = 2.0;

/// Units of a column that is named as the ground acceleration of Eurocode 8 and states none.
fn units_of_ground(name: &str, values: impl Iterator<Item = f64>) -> (Option<Units>, Notice) {
    let peak = values.fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let symbols = if peak > LARGEST_IN_G { ["m/s2", "g"] } else { ["g", "m/s2"] };
    let [units, other] = symbols.map(Units::parse);
    let shown = |units: Option<Units>| units.map_or_else(String::new, |units| units.to_string());
    let message = format!(
        "the column \"{name}\" has the name of the ground acceleration of Eurocode 8, which states no \
         unit: its values, up to {peak}, were taken in {}; if they are in {}, give units",
        shown(units),
        shown(other)
    );
    (units, Notice::new(NoticeKind::UnitsAssumed, message))
}
