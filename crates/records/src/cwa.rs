//! Files of the Central Weather Administration (CWA, formerly CWB), Taiwan, `.dat`, `.txt`.
//!
//! Lines `#Key: value`, then rows of time and acceleration up, north and east, 4F10.3, in gal. The
//! header names the order of the columns, which is not that of other networks.

use super::component::azimuth;
use super::fixed::{Cursor, Fields};
use super::keys::{self, Field, Keys};
use super::text::Text;
use super::{Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, to_si};
use slipstick_dynamics::notice::Notice;

/// More lines than any header has.
const MAX_HEADER_LINES: usize = 100;

/// Whether the keys of the header are there.
pub(super) fn recognises(text: &Text) -> bool {
    let keys = Keys { lines: text.lines().take(MAX_HEADER_LINES).collect() };
    text.lines().next().is_some_and(|line| line.bytes.starts_with(b"#"))
        && ["SampleRate(Hz)", "AmplitudeUnit", "DataSequence"].iter().all(|k| keys.get(k).is_some())
}

/// Reads the file: a channel a column.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut header = Keys { lines: vec![] };
    while let Some(line) = cursor.peek() {
        let of_header = line.is_blank() || line.bytes.trim_ascii_start().starts_with(b"#");
        if !of_header || header.lines.len() == MAX_HEADER_LINES {
            break;
        }
        header.lines.push(cursor.next("")?);
    }
    let rate = header.required(text, "SampleRate(Hz)")?;
    let rate_hz = rate.positive(text, "samples a second")?;
    let dt_s = rate.same_step(text, 1.0 / rate_hz, options)?;
    let length = header.required(text, "RecordLength(sec)")?;
    let count = libm::round(rate_hz * length.positive(text, "a length in s")?);
    if !(2.0..=slipstick_dynamics::motion::MAX_SAMPLES as f64).contains(&count) {
        return Err(length.error(text, "a length of 2 to 100 000 000 values"));
    }
    let count = count as usize;
    let unit = header.required(text, "AmplitudeUnit")?;
    let unit = first_word(&unit);
    let units = unit.units(text, options)?;
    let sequence = header.required(text, "DataSequence")?;
    let columns = columns(text, &sequence)?;
    let n = columns.len() + 1;
    let fields = header.text("Data").and_then(|format| Fields::parse(&format));
    let fields = fields.filter(|f| f.per_line == n).unwrap_or(Fields::new(n, 10));

    let table = cursor.values(fields, n * count, &length.line)?;
    keys::end(&mut cursor, n * count, &length.line)?;
    check_times(text, &table, n, dt_s, &rate)?;
    let event = keys::join(&[
        header.text("Origin Time(GMT+08)"),
        header.text("Magnitude(Ml)").map(|m| format!("ML{m}")),
    ]);
    let station = keys::join(&[header.text("StationCode"), header.text("StationName")]);
    let mut channels = Vec::with_capacity(columns.len());
    for (i, name) in columns.iter().enumerate() {
        let values: Vec<f64> = table.iter().skip(i + 1).step_by(n).copied().collect();
        let warnings = check_range(text, &header, name, &values, &units.to_string())?;
        channels.push(Channel {
            name: name.clone(),
            event: event.clone(),
            station: station.clone(),
            component: Some(name.clone()),
            azimuth_deg: azimuth(name),
            units,
            values: to_si(values, &units),
            sampling: Sampling::Dt(dt_s),
            filter: FilterCorners::default(),
            warnings,
        });
    }
    let layout = "CWA".to_owned();
    Ok(Record { format: Format::Cwa, layout, channels, warnings: vec![] })
}

/// The first word of `gal. DCoffset(corr)`, without its point.
fn first_word<'a>(field: &Field<'a>) -> Field<'a> {
    let mut word = field.first_word();
    while word.at.len() > 1 && matches!(word.line.bytes[word.at.end - 1], b'.' | b';' | b',') {
        word.at.end -= 1;
    }
    word
}

/// Names of the columns after the first: `Time U(+); N(+); E(+)`.
fn columns(text: &Text, field: &Field) -> Result<Vec<String>, RecordError> {
    let expected = "columns such as \"Time U(+); N(+); E(+)\"";
    let words: Vec<String> = field.words().iter().filter_map(Field::text).collect();
    let (time, rest) = words.split_first().ok_or_else(|| field.error(text, expected))?;
    let name = |word: &String| {
        let (name, sign) = word.split_once('(')?;
        // A column of the other sense would have to be turned: none is known.
        sign.starts_with("+)").then(|| name.to_owned()).filter(|name| !name.is_empty())
    };
    let names: Option<Vec<String>> = rest.iter().map(name).collect();
    match names {
        Some(names) if time.eq_ignore_ascii_case("time") && (1..=12).contains(&names.len()) => {
            Ok(names)
        }
        _ => Err(field.error(text, expected)),
    }
}

/// Every time is its number times the step, within the three decimals it has.
fn check_times(
    text: &Text,
    table: &[f64],
    n: usize,
    dt_s: f64,
    rate: &Field,
) -> Result<(), RecordError> {
    let start_s = table[0];
    for (i, time_s) in table.iter().step_by(n).enumerate() {
        let expected_s = start_s + i as f64 * dt_s;
        if (time_s - expected_s).abs() > 0.001_001 {
            let expected = format!("a rate that gives row {} its time of {time_s} s", i + 1);
            return Err(rate.error(text, expected));
        }
    }
    Ok(())
}

/// Compares the largest and least values that `#AmplitudeMAX. U: 1.196~ -1.017` states.
fn check_range(
    text: &Text,
    header: &Keys,
    name: &str,
    values: &[f64],
    symbol: &str,
) -> Result<Vec<Notice>, RecordError> {
    let Some(field) = header.get(&format!("AmplitudeMAX. {name}")) else { return Ok(vec![]) };
    let parts = field.split(b'~');
    let size = |part: &&Field| part.number().map_or(0.0, |(value, _)| value.abs());
    let stated = parts.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
    Ok(keys::check_peak(text, stated, values, symbol, keys::PEAK_FACTOR)?.into_iter().collect())
}
