//! DYNA 1.2 files of ITACA, ESM and AFAD: `.ASC`, `.asc`; one component each.
//!
//! 64 lines `KEY: value`, of which any value may be empty, then one value a line. AFAD writes the
//! same keys with other dates and with words for nothing (`None`, `unknown`). Older versions have
//! fewer keys; the header ends where the numbers begin. Source: the headers' own keys, which name
//! their units, and the DYNA 1.2 description of ITACA.

use super::component::azimuth;
use super::fixed::Cursor;
use super::keys::{self, Keys};
use super::text::{Text, number};
use super::{
    Channel, FilterCorners, Format, Options, Quantity, Record, RecordError, Sampling, Units, to_si,
};
use slipstick_dynamics::notice::Notice;

/// More lines than any version has.
const MAX_HEADER_LINES: usize = 200;

/// Whether the keys that all versions share stand among the first lines.
pub(super) fn recognises(text: &Text) -> bool {
    let keys = Keys { lines: text.lines().take(MAX_HEADER_LINES).collect() };
    ["EVENT_DATE_YYYYMMDD", "NDATA", "SAMPLING_INTERVAL_S"].iter().all(|k| keys.get(k).is_some())
}

/// Reads the file: one channel.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut header = Keys { lines: vec![] };
    while let Some(line) = cursor.peek() {
        let is_value = number(line.bytes.trim_ascii()).is_some();
        if is_value || header.lines.len() == MAX_HEADER_LINES {
            break;
        }
        header.lines.push(cursor.next("")?);
    }
    let announced = header.required(text, "NDATA")?;
    let count = announced.count(text, "a number of values after \"NDATA:\"")?;
    let step = header.required(text, "SAMPLING_INTERVAL_S")?;
    let dt_s = step.step(text, "a time step > 0 s", options)?;
    let stated = header.required(text, "UNITS")?;
    let units = stated.units(text, options)?;
    let kind = header.get("DATA_TYPE").filter(|field| field.text().is_some());
    if let Some(kind) = kind
        && units.quantity() != Quantity::Counts
        && !kind.line.str(&kind.at).eq_ignore_ascii_case(units.quantity().name())
    {
        let expected =
            format!("\"{}\", as the units say (a time history)", units.quantity().name());
        return Err(kind.error(text, expected));
    }
    let values = keys::rows(&mut cursor, 1, count, &announced.line)?;
    keys::end(&mut cursor, count, &announced.line)?;

    let mut warnings = Vec::new();
    warnings.extend(check_peak(text, &header, units, &values)?);
    warnings.extend(keys::check_duration(header.get("DURATION_S").as_ref(), count, dt_s));
    let stream = header.text("STREAM");
    let station =
        [header.text("NETWORK"), header.text("STATION_CODE"), header.text("STATION_NAME")];
    let date = header.text("EVENT_DATE_YYYYMMDD");
    let magnitude = |key| header.text(key).map(|m| (key, m));
    let magnitude = magnitude("MAGNITUDE_W").or(magnitude("MAGNITUDE_L")).map(|(key, m)| {
        let scale = if key == "MAGNITUDE_W" { "Mw" } else { "ML" };
        format!("{scale}{m}")
    });
    let afad = text
        .lines()
        .take(MAX_HEADER_LINES)
        .any(|line| line.find("AFAD", 0).is_some() && line.find("DATA_CREATOR", 0) == Some(0));
    let channel = Channel {
        name: stream.clone().unwrap_or_else(|| "1".to_owned()),
        event: keys::join(&[header.text("EVENT_NAME"), date, magnitude]),
        station: keys::join(&station),
        azimuth_deg: stream
            .as_deref()
            .and_then(|s| keys::azimuth_of_code(s).or_else(|| azimuth(s))),
        component: stream,
        units,
        values: to_si(values, &units),
        sampling: Sampling::Dt(dt_s),
        filter: FilterCorners {
            high_pass_hz: header.hertz("LOW_CUT_FREQUENCY_HZ"),
            low_pass_hz: header.hertz("HIGH_CUT_FREQUENCY_HZ"),
        },
        warnings,
    };
    let layout = if afad { "AFAD DYNA" } else { "ESM DYNA" }.to_owned();
    Ok(Record { format: Format::Dyna, layout, channels: vec![channel], warnings: vec![] })
}

/// The peak stands under a key that names its units: `PGA_CM/S^2`, `PGV_CM/S`, `PGD_CM`.
fn check_peak(
    text: &Text,
    header: &Keys,
    units: Units,
    values: &[f64],
) -> Result<Option<Notice>, RecordError> {
    let key = match units.quantity() {
        Quantity::Acceleration => "PGA_CM/S^2",
        Quantity::Velocity => "PGV_CM/S",
        Quantity::Displacement => "PGD_CM",
        Quantity::Counts => return Ok(None),
    };
    let Some(field) = header.get(key) else { return Ok(None) };
    let centimetres: Vec<f64> = values.iter().map(|v| v * units.si() / 0.01).collect();
    let unit = key.get(4..).unwrap_or_default().to_ascii_lowercase();
    keys::check_peak(text, Some(&field), &centimetres, &unit, keys::PEAK_FACTOR)
}
