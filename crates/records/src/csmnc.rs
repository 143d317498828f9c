//! Files of the China Strong Motion Networks Centre (CSMNC), `.dat`: one component, in gal.
//!
//! Sixteen lines of text, then eight values a line: with exponents and blanks between them, or
//! 8F10.3.

use super::component::azimuth;
use super::fixed::{Cursor, Fields};
use super::keys::{self, Field};
use super::text::{Line, Text};
use super::{Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, to_si};

/// Lines of the header.
const HEADER_LINES: usize = 16;
/// Values on a line.
const PER_LINE: usize = 8;

fn find<'a>(lines: &[Line<'a>], key: &str) -> Option<Field<'a>> {
    let line = lines.iter().find_map(|line| Some((line, line.find(key, 0)?)));
    line.map(|(line, at)| Field::from(*line, at + key.len()))
}

/// Whether the lines on count, step and units are there.
pub(super) fn recognises(text: &Text) -> bool {
    let lines: Vec<Line> = text.lines().take(HEADER_LINES).collect();
    find(&lines, "NO. OF POINTS:").is_some()
        && find(&lines, "EQUALLY SPACED INTERVALS OF:").is_some()
        && find(&lines, "COMP.").is_some()
}

/// Reads the file: one channel.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut lines = cursor.take(11, "the 16 lines of a CSMNC header")?;
    let find = |lines: &[Line<'_>], key: &str| -> Option<(usize, usize)> {
        lines.iter().enumerate().find_map(|(i, line)| Some((i, line.find(key, 0)? + key.len())))
    };
    // Any blank line, then the values; the header's other lines may be fewer.
    while let Some(line) = cursor.peek() {
        let first = line.words().next();
        let is_values = first.is_some_and(|word| text.number(&line, &word).is_ok())
            && find(&lines, "EQUALLY SPACED INTERVALS OF:").is_some();
        if is_values || lines.len() == 2 * HEADER_LINES {
            break;
        }
        lines.push(cursor.next("")?);
    }
    let required = |key: &str| {
        let at = find(&lines, key).map(|(i, at)| Field::from(lines[i], at));
        at.ok_or_else(|| text.error_at_start(format!("\"{key}\" in the header"), "none"))
    };
    let points = required("NO. OF POINTS:")?;
    let announced = points.line;
    let count = points.first_word().count(text, "a number of points")?;
    let step = required("EQUALLY SPACED INTERVALS OF:")?;
    let words = step.words();
    let seconds = words.get(1).is_some_and(|unit| {
        ["SEC", "SEC.", "S"].iter().any(|s| step.line.str(&unit.at).eq_ignore_ascii_case(s))
    });
    if !seconds {
        return Err(step.error(text, "a time step and \"SEC\""));
    }
    let dt_s = words[0].step(text, "a time step > 0 s", options)?;
    let units = required("UNIT:")?.first_word().units(text, options)?;
    let values = match cursor.peek() {
        Some(line) if line.bytes.trim_ascii_end().len() <= 10 * PER_LINE => {
            cursor.values(Fields::new(PER_LINE, 10), count, &announced)?
        }
        _ => keys::rows(&mut cursor, PER_LINE, count, &announced)?,
    };
    keys::end(&mut cursor, count, &announced)?;

    let peak = find(&lines, "PEAK VALUE:").map(|(i, at)| Field::from(lines[i], at));
    let symbol = units.to_string();
    let mut warnings = Vec::new();
    warnings.extend(keys::check_peak(text, peak.as_ref(), &values, &symbol, keys::PEAK_FACTOR)?);
    let duration = find(&lines, "DURATION:").map(|(i, at)| Field::from(lines[i], at));
    warnings.extend(keys::check_duration(duration.as_ref(), count, dt_s));
    let component = required("COMP.")?.text();
    let station = find(&lines, "STATION:").map(|(i, at)| Field::from(lines[i], at));
    let station = station.and_then(|field| field.words().first()?.text());
    let magnitude = find(&lines, "MAGNITUDE").map(|(i, at)| Field::from(lines[i], at));
    let event = keys::join(&[
        Some(lines[2].trimmed()).filter(|name| !name.is_empty()),
        magnitude.and_then(|field| field.text()).map(|m| format!("M{m}")),
    ]);
    let channel = Channel {
        name: component.clone().unwrap_or_else(|| "1".to_owned()),
        event,
        station,
        azimuth_deg: component.as_deref().and_then(azimuth),
        component,
        units,
        values: to_si(values, &units),
        sampling: Sampling::Dt(dt_s),
        filter: FilterCorners::default(),
        warnings,
    };
    let layout = "CSMNC".to_owned();
    Ok(Record { format: Format::Csmnc, layout, channels: vec![channel], warnings: vec![] })
}
