//! Older `.acc` files of ITACA and SISMA, Italy: ten lines `Key : value`, then 5E14.7; one component.

use super::component::azimuth;
use super::fixed::{Cursor, Fields};
use super::keys::{self, Field, Keys};
use super::text::Text;
use super::{Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, Units, to_si};
use slipstick_dynamics::notice::Notice;

/// Lines of the header.
const HEADER_LINES: usize = 10;
/// How values stand.
const FIELDS: Fields = Fields::new(5, 14);

fn header<'a>(text: &Text<'a>) -> Keys<'a> {
    Keys { lines: text.lines().take(HEADER_LINES).collect() }
}

/// Whether the keys of the header are there.
pub(super) fn recognises(text: &Text) -> bool {
    let keys = header(text);
    keys.get("Time Increment (s)").is_some() && keys.get("Number of Data").is_some()
}

/// Reads the file: one channel.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let header = Keys { lines: cursor.take(HEADER_LINES, "the 10 lines of an .acc header")? };
    let announced = header.required(text, "Number of Data")?;
    let count = announced.count(text, "a number of values")?;
    let dt_s =
        header.required(text, "Time Increment (s)")?.step(text, "a time step > 0 s", options)?;
    // The last line says "Accelaration time series in m/s/s", in this spelling.
    let last = header.lines[HEADER_LINES - 1];
    let Some(at) = last.find("TIME SERIES IN", 0) else {
        let expected = "\"... time series in\" and units on line 10";
        return Err(text.error(&last, 0, expected, &last.trimmed()));
    };
    let stated = Field::from(last, at + "TIME SERIES IN".len());
    let units = stated.units(text, options)?;
    let first_letter = last.trimmed().chars().next().map(|c| c.to_ascii_lowercase());
    if first_letter != units.quantity().name().chars().next() {
        return Err(stated.error(text, "units of the quantity named on this line"));
    }
    let values = cursor.values(FIELDS, count, &announced.line)?;
    keys::end(&mut cursor, count, &announced.line)?;

    let warnings = check_peak(text, &header, units, &values)?;
    let corners = header.get("Filter Cut-off Frequency (Hz)").map_or(vec![], |f| f.split(b'-'));
    let corner = |i: usize| corners.get(i)?.number().map(|(hz, _)| hz).filter(|hz| *hz > 0.0);
    let component = header.text("Orientation");
    let channel = Channel {
        name: component.clone().unwrap_or_else(|| "1".to_owned()),
        event: header.text("Event Date & Time"),
        station: header.text("Station Code / Name"),
        azimuth_deg: component.as_deref().and_then(azimuth),
        component,
        units,
        values: to_si(values, &units),
        sampling: Sampling::Dt(dt_s),
        filter: FilterCorners { high_pass_hz: corner(0), low_pass_hz: corner(1) },
        warnings: warnings.into_iter().collect(),
    };
    let layout = "ITACA .acc".to_owned();
    Ok(Record { format: Format::Itaca, layout, channels: vec![channel], warnings: vec![] })
}

/// The peak stands under a key that names its units: `PGA (m/s/s) : 1.0E-02`, PGV or PGD.
fn check_peak(
    text: &Text,
    header: &Keys,
    units: Units,
    values: &[f64],
) -> Result<Option<Notice>, RecordError> {
    let Some(line) = header.lines.iter().find(|line| line.find("PG", 0) == Some(0)) else {
        return Ok(None);
    };
    let [open, close, colon] = ["(", ")", ":"].map(|mark| line.find(mark, 0));
    let named = open.zip(close).filter(|(open, close)| open < close);
    let named = named.and_then(|(open, close)| Units::parse(&line.str(&(open + 1..close))));
    let (Some(named), Some(colon)) = (named, colon) else { return Ok(None) };
    let field = Field::from(*line, colon + 1);
    let values: Vec<f64> = values.iter().map(|v| v * units.si() / named.si()).collect();
    keys::check_peak(text, Some(&field), &values, &named.to_string(), keys::PEAK_FACTOR)
}
