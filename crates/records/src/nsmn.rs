//! Files of the old national network of Turkey (NSMN, AFAD), `.txt`: three components side by side.
//!
//! A header `KEY : value` that ends in the names of the columns, then rows of N-S, E-W and U-D in gal.

use super::component::azimuth;
use super::fixed::Cursor;
use super::keys::{self, Keys};
use super::text::Text;
use super::{Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, Units, to_si};
use slipstick_dynamics::notice::Notice;

/// Lines among which the names of the columns are looked for.
const HEADER_LINES: usize = 40;

/// Whether the first line is the network's title.
pub(super) fn recognises(text: &Text) -> bool {
    let first = text.lines().next();
    first.is_some_and(|line| line.find("STRONG GROUND MOTION RECORDS OF TURK", 0).is_some())
}

/// Reads the file: a channel a column.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut header = Keys { lines: vec![] };
    let names = loop {
        let line = cursor.next("the names of the columns, \"N-S E-W U-D\"")?;
        let words: Vec<String> = line.words().map(|word| line.str(&word)).collect();
        let direction =
            |w: &String| ["N-S", "E-W", "U-D"].iter().any(|d| w.eq_ignore_ascii_case(d));
        if !words.is_empty() && words.iter().all(direction) {
            break words;
        }
        if header.lines.len() == HEADER_LINES {
            let expected = "the names of the columns, \"N-S E-W U-D\"";
            return Err(text.error(&line, 0, expected, &line.trimmed()));
        }
        header.lines.push(line);
    };
    let announced = header.required(text, "NUMBER OF DATA")?;
    let count = announced.count(text, "a number of rows")?;
    let step = header.required(text, "SAMPLING INTERVAL (sec)")?;
    let dt_s = step.step(text, "a time step > 0 s", options)?;
    // Units are named only beside the peaks.
    let peaks = header.lines.iter().copied().find(|line| line.find("PGA VALUES", 0).is_some());
    let peaks = peaks
        .ok_or_else(|| text.error(&announced.line, 0, "a line \"RAW PGA VALUES (gal)\"", "none"))?;
    let (open, close) = (peaks.find("(", 0), peaks.find(")", 0));
    let at = open.zip(close).filter(|(open, close)| open < close);
    let at = at.map_or(0..0, |(open, close)| open + 1..close);
    let units = keys::Field { line: peaks, at }.trimmed().units(text, options)?;

    let rows = keys::rows(&mut cursor, names.len(), names.len() * count, &announced.line)?;
    keys::end(&mut cursor, names.len() * count, &announced.line)?;
    let event = keys::join(&[
        header.text("EARTHQUAKE DATE"),
        header.text("EARTHQUAKE MAGNITUDE").map(|m| format!("M {m}")),
    ]);
    let station = keys::join(&[header.text("STATION ID"), header.text("PLACE")]);
    let mut channels = Vec::with_capacity(names.len());
    for (i, name) in names.iter().enumerate() {
        let values: Vec<f64> = rows.iter().skip(i).step_by(names.len()).copied().collect();
        let warning = check_peak(text, peaks, name, &values, units)?;
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
            warnings: warning.into_iter().collect(),
        });
    }
    let layout = "NSMN text".to_owned();
    Ok(Record { format: Format::Nsmn, layout, channels, warnings: vec![] })
}

/// Peaks stand as `(N-S) 13.200332 (E-W) …`, of the raw record; processing may have changed them.
fn check_peak(
    text: &Text,
    line: super::text::Line,
    name: &str,
    values: &[f64],
    units: Units,
) -> Result<Option<Notice>, RecordError> {
    let after = format!("({name})").to_ascii_uppercase();
    let field = line.find(&after, 0).map(|at| keys::Field::from(line, at + after.len()));
    keys::check_peak(text, field.as_ref(), values, &units.to_string(), 5.0)
}
