//! CSV files of the Japan Meteorological Agency: three components in one file.
//!
//! Six lines of key and value (`SITE CODE=`, `LAT.=`, `LON.=`, `SAMPLING RATE=`, `UNIT  =`, `INITIAL TIME =`),
//! a line of names (`NS, EW, UD`), then a row a sample. Rows may be padded with commas; the name of the
//! place is in the encoding cp932.

use super::component::azimuth;
use super::sampling;
use super::text::{Line, Text, number};
use super::{Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, Units, to_si};
use slipstick_dynamics::motion::MAX_SAMPLES;

/// Lines before the names of the components, at most.
const HEADER_LINES: usize = 20;

/// Whether the first lines are those of the header.
pub(super) fn recognises(text: &Text) -> bool {
    let has = |key: &str| text.lines().take(HEADER_LINES).any(|line| key_of(&line) == Some(key));
    has("SITE CODE") && has("SAMPLING RATE") && has("UNIT") && has("INITIAL TIME")
}

/// The key of a line, of those that the format has.
fn key_of(line: &Line) -> Option<&'static str> {
    const KEYS: [&str; 6] = ["SITE CODE", "LAT.", "LON.", "SAMPLING RATE", "UNIT", "INITIAL TIME"];
    let at = line.bytes.iter().position(|b| *b == b'=')?;
    let key = line.bytes[..at].trim_ascii();
    KEYS.into_iter().find(|known| known.as_bytes() == key)
}

/// What stands behind the sign of equality, padding cut, and where.
fn value(line: &Line) -> (core::ops::Range<usize>, String) {
    let start = line.bytes.iter().position(|b| *b == b'=').map_or(0, |at| at + 1);
    let end =
        line.bytes.iter().rposition(|b| !matches!(b, b',' | b' ' | b'\t')).map_or(0, |at| at + 1);
    let word = start..end.max(start);
    (word.clone(), String::from_utf8_lossy(line.bytes[word].trim_ascii()).into_owned())
}

/// Reads the file; its channels are `NS`, `EW` and `UD`.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut lines = text.lines();
    let (mut dt_s, mut units, mut station, mut event) = (None, None, None, None);
    let names = loop {
        let expected = "the header of a file of JMA and the line \"NS, EW, UD\" behind it";
        let Some(line) = lines.next().filter(|line| line.number <= HEADER_LINES) else {
            return Err(text.error_at_end(expected, "no such line"));
        };
        let (word, said) = value(&line);
        match key_of(&line) {
            Some("SITE CODE") => station = site(&line.bytes[word]),
            Some("SAMPLING RATE") => {
                let rate = said.to_ascii_uppercase();
                let rate = rate.strip_suffix("HZ").and_then(|hz| number(hz.trim().as_bytes()));
                let rate = rate
                    .filter(|hz| *hz > 0.0)
                    .ok_or_else(|| text.error_at(&line, &word, "a sampling rate such as 100Hz"))?;
                dt_s = Some(sampling::stated_step(text, &line, &word, 1.0 / rate, options.dt_s)?);
            }
            Some("UNIT") => {
                let plain = said.split('(').next().unwrap_or_default().trim();
                let stated = Units::parse(plain).ok_or_else(|| {
                    text.error_at(&line, &word, "a unit of acceleration such as gal")
                })?;
                super::volume::agree(text, &line, &word, stated, options.units)?;
                units = Some(stated);
            }
            Some("INITIAL TIME") => event = Some(said).filter(|said| !said.is_empty()),
            Some(_) => {}
            None if line.is_blank() => {}
            None => break line,
        }
    };
    let (Some(dt_s), Some(units)) = (dt_s, units) else {
        let expected = "\"SAMPLING RATE=\" and \"UNIT  =\" above the names of the components";
        return Err(text.error(&names, 0, expected, &names.trimmed()));
    };
    let components = components(text, &names)?;
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); components.len()];
    for line in lines {
        if line.is_blank() {
            continue;
        }
        let cells = line.bytes.split(|b| *b == b',');
        let mut at = 0;
        let mut found = 0;
        for cell in cells {
            let word = at..at + cell.len();
            at += cell.len() + 1;
            let is_padding = found >= components.len() && cell.trim_ascii().is_empty();
            if is_padding {
                continue;
            }
            let value = number(cell.trim_ascii()).filter(|_| found < components.len());
            let Some(value) = value else {
                let expected = format!("{} numbers a row", components.len());
                return Err(text.error_at(&line, &word, expected));
            };
            values[found].push(value);
            found += 1;
        }
        if found < components.len() || values[0].len() > MAX_SAMPLES {
            let expected = format!("{} numbers a row, 100 000 000 rows at most", components.len());
            return Err(text.error(&line, 0, expected, &found.to_string()));
        }
    }
    if values[0].len() < 2 {
        return Err(text.error_at_end("2 rows of numbers or more", &values[0].len().to_string()));
    }
    let channel = |(name, values): (String, Vec<f64>)| Channel {
        azimuth_deg: match name.as_str() {
            "NS" => Some(0.0),
            "EW" => Some(90.0),
            other => azimuth(other),
        },
        component: Some(name.clone()),
        name,
        event: event.clone(),
        station: station.clone(),
        units,
        values: to_si(values, &units),
        sampling: Sampling::Dt(dt_s),
        filter: FilterCorners::default(),
        warnings: vec![],
    };
    let channels = components.into_iter().zip(values).map(channel).collect();
    Ok(Record { format: Format::Jma, layout: "JMA CSV".to_owned(), channels, warnings: vec![] })
}

/// The code of the site; its name, which is not UTF-8, stands behind it.
fn site(value: &[u8]) -> Option<String> {
    let value = value.trim_ascii();
    let is_code = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'-' | b'_');
    let code = &value[..value.iter().take_while(|b| is_code(b)).count()];
    let code = String::from_utf8_lossy(code).into_owned();
    (!code.is_empty()).then_some(code)
}

/// The names of the components, each once.
fn components(text: &Text, line: &Line) -> Result<Vec<String>, RecordError> {
    let names: Vec<String> = line
        .trimmed()
        .split(',')
        .map(|name| name.trim().to_ascii_uppercase().replace('-', ""))
        .filter(|name| !name.is_empty())
        .collect();
    let known = names.iter().all(|name| matches!(name.as_str(), "NS" | "EW" | "UD"));
    let twice = (1..names.len()).any(|i| names[..i].contains(&names[i]));
    if names.is_empty() || !known || twice {
        let expected = "the names of the components, NS, EW and UD";
        return Err(text.error(line, 0, expected, &line.trimmed()));
    }
    Ok(names)
}
