//! Delimited text: one column of values, times and values, or many columns, with or without a
//! header; separated by comma, semicolon, tab or blanks; with decimal point or decimal comma.
//!
//! Lines that begin with `#`, `%`, `!`, `//` or `*` and hold a letter are comments. A few lines of
//! other text may stand first; the last of them (or of the comments) names the columns if it has as
//! many names. A first line of two numbers, count and step, is understood where what follows shows
//! that it is one. Without header and times, three or more values a line are one series.

mod columns;
mod header;
mod layout;
mod style;
mod table;

use super::text::Text;
use super::{
    Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, Units, keys_to_add,
    sampling, to_si,
};
pub(super) use columns::read as read_columns;
pub use columns::{Column, Columns};
pub use header::bracket;
use header::{Header, Unit};
use layout::Layout;
use slipstick_dynamics::notice::{Notice, NoticeKind};
use table::Table;

/// Reads the file; channels are named by the header, else `column 1`, `column 2`, ….
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let header = Header::of(text)?;
    let table = Table::read(text, &header)?;
    let layout = layout::of(text, &header, &table)?;
    let (series, mut warnings) = series(text, &header, &table, &layout, options.units)?;
    let given_s = table.given_step(text, options.dt_s)?;
    let missing_units = series.iter().any(|s| s.units.is_none());
    if missing_units || (layout.times_s.is_none() && given_s.is_none()) {
        let expected = keys_to_add(missing_units, layout.times_s.is_none() && given_s.is_none());
        return Err(table.error_at_start(text, expected));
    }
    let sampling = match (layout.times_s, given_s) {
        (Some(times_s), given_s) => {
            let (sampling, doubts) = sampling::of_times(times_s, given_s).map_err(|own| {
                let given_s = given_s.unwrap_or_default();
                let expected = format!("times at the step given, {given_s} s (leave it out)");
                table.error_found(text, expected, &own)
            })?;
            warnings.extend(doubts);
            sampling
        }
        (None, given_s) => Sampling::Dt(given_s.unwrap_or_default()),
    };
    let channel = |series: Series| {
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

/// Values of one channel as they stand, and their units if they are known.
struct Series {
    name: String,
    values: Vec<f64>,
    units: Option<Units>,
}

/// Every column that is motion, with the units that the header states, else those given.
fn series(
    text: &Text,
    header: &Header,
    table: &Table,
    layout: &Layout,
    given: Option<Units>,
) -> Result<(Vec<Series>, Vec<Notice>), RecordError> {
    let mut warnings = Vec::new();
    if layout.wrapped {
        let message = format!(
            "{} values a line without header and times were read along the lines as one series",
            table.columns
        );
        warnings.push(Notice::new(NoticeKind::ReadAlongLines, message));
        let (name, values) = ("column 1".to_owned(), table.cells.clone());
        return Ok((vec![Series { name, values, units: given }], warnings));
    }
    let mut series = Vec::new();
    for column in (0..table.columns).filter(|&c| Some(c) != layout.time_column) {
        let named = layout.names.as_ref().map(|names| &names[column]);
        let name = named.map_or_else(|| format!("column {}", column + 1), |n| n.text.clone());
        let units = match (named.and_then(|n| n.unit), given) {
            (Some(Unit::Other | Unit::Time(_)), _) => {
                let message = format!(
                    "the column \"{name}\" is no acceleration, velocity or displacement: skipped"
                );
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
            (None, given) => given,
        };
        let values = table.column(column).collect();
        series.push(Series { name, values, units });
    }
    if series.is_empty() {
        let expected = "a column of acceleration, velocity or displacement";
        return Err(header.error(text, expected, "none"));
    }
    Ok((series, warnings))
}
