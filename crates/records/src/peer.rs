//! PEER strong-motion files: `.AT2` (g), `.VT2` (cm/s), `.DT2` (cm).
//!
//! A few lines of text, of which one states units and filter and one, the last, the number of
//! values and the time step; then values in free format. The last line of the header is written
//! `NPTS=  4000, DT= .01000 SEC`, with or without `SEC`, in small letters, with tabs, with words
//! on the filter after it, or the numbers first: `4096  0.0100  NPTS, DT`.

use core::ops::Range;

use super::component::azimuth;
use super::text::{Line, Text, number};
use super::{
    Channel, FilterCorners, Format, Options, Quantity, Record, RecordError, Sampling, Units,
    keys_to_add, sampling, to_si,
};
use slipstick_dynamics::motion::MAX_SAMPLES;
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// Lines among which the count and step are looked for.
const HEADER_LINES: usize = 10;

/// Whether one of the first lines names the number of points.
pub(super) fn recognises(text: &Text) -> bool {
    count_line(text).is_some()
}

fn count_line<'a>(text: &Text<'a>) -> Option<Line<'a>> {
    // Comments of delimited text may state the count too.
    let is_marked =
        |line: &Line| matches!(line.bytes.trim_ascii_start().first(), Some(b'#' | b'%'));
    let mut lines = text.lines().take(HEADER_LINES).filter(|line| !is_marked(line));
    lines.find(|line| line.find("NPTS", 0).is_some())
}

/// Reads the file; its one channel is named by its component.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let Some(last) = count_line(text) else {
        let expected = format!("\"NPTS=\" and \"DT=\" in one of the first {HEADER_LINES} lines");
        return Err(text.error_at_start(expected, "none"));
    };
    let (count, dt_s) = count_and_step(text, &last, options.dt_s)?;
    let header: Vec<Line> = text.lines().take(last.number - 1).collect();
    let units = match (stated_units(text, &header)?, options.units) {
        (Some((line, word, stated)), Some(given)) if stated != given => {
            let expected = format!("the units given, {given} (leave them out)");
            return Err(text.error_at(&line, &word, expected));
        }
        (Some((.., stated)), _) => stated,
        (None, Some(given)) => given,
        (None, None) => {
            return Err(text.error(&last, 0, keys_to_add(true, false), &last.trimmed()));
        }
    };
    let values = values(text, &last, count)?;
    let names = Names::of(&header);
    let layout = match units.quantity() {
        Quantity::Acceleration | Quantity::Counts => "PEER AT2",
        Quantity::Velocity => "PEER VT2",
        Quantity::Displacement => "PEER DT2",
    };
    let warnings = other_count(&header, &last, count, dt_s).into_iter().collect();
    let channel = Channel {
        name: names.component.clone().unwrap_or_else(|| "1".to_owned()),
        azimuth_deg: names.component.as_deref().and_then(azimuth),
        event: names.event,
        station: names.station,
        component: names.component,
        units,
        values: to_si(values, &units),
        sampling: Sampling::Dt(dt_s),
        filter: filter(&header),
        warnings,
    };
    let layout = layout.to_owned();
    Ok(Record { format: Format::Peer, layout, channels: vec![channel], warnings: vec![] })
}

/// A warning where a line above says another count than the last one: `1559 points at equal spacing`,
/// or count and step, `2500 0.0100000`.
fn other_count(header: &[Line], last: &Line, count: usize, dt_s: f64) -> Option<Notice> {
    header.iter().find_map(|line| {
        let mut words = line.words();
        let (first, second) = (words.next()?, words.next()?);
        let digits = &line.bytes[first];
        let stated = number(digits).filter(|_| digits.iter().all(u8::is_ascii_digit))?;
        let is_step = number(&line.bytes[second.clone()])
            .is_some_and(|step_s| (step_s - dt_s).abs() <= 1e-3 * dt_s);
        let is_count = is_step || line.str(&second).eq_ignore_ascii_case("points");
        (is_count && stated != count as f64).then(|| {
            Notice::new(
                NoticeKind::HeaderDiffers,
                format!(
                    "line {} states {stated} values, line {} {count}, which stand there",
                    line.number, last.number
                ),
            )
        })
    })
}

/// Number of values and time step in s.
fn count_and_step(
    text: &Text,
    line: &Line,
    given_s: Option<f64>,
) -> Result<(usize, f64), RecordError> {
    let npts = line.find("NPTS", 0).unwrap_or(0);
    let (count_word, step_word, label) = match after_equals(line, npts + 4) {
        Some(at) => {
            let Some(dt) = line.find("DT", at) else {
                let end = line.bytes.len()..line.bytes.len();
                return Err(text.error_at(line, &end, "\"DT=\" and the time step"));
            };
            (
                word_from(line, at),
                word_from(line, after_equals(line, dt + 2).unwrap_or(dt + 2)),
                "NPTS=",
            )
        }
        None => {
            let mut words = line.words();
            let end = line.bytes.len()..line.bytes.len();
            let mut next = || words.next().unwrap_or_else(|| end.clone());
            (next(), next(), "before \"NPTS\"")
        }
    };
    let expected = match label {
        "NPTS=" => "sample count after \"NPTS=\"",
        _ => "sample count before \"NPTS\"",
    };
    let count = count(text, line, &count_word, expected)?;
    let dt_s = step(text, line, &step_word)?;
    let dt_s = sampling::stated_step(text, line, &step_word, dt_s, given_s)?;
    Ok((count, dt_s))
}

fn count(
    text: &Text,
    line: &Line,
    word: &Range<usize>,
    expected: &str,
) -> Result<usize, RecordError> {
    let digits = &line.bytes[word.clone()];
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return Err(text.error_at(line, word, expected));
    }
    match line.str(word).parse::<usize>() {
        Ok(count) if (2..=MAX_SAMPLES).contains(&count) => Ok(count),
        _ => Err(text.error_at(line, word, "2 to 100 000 000 values")),
    }
}

/// The time step in s, and nothing but seconds after it.
fn step(text: &Text, line: &Line, word: &Range<usize>) -> Result<f64, RecordError> {
    let bytes = &line.bytes[word.clone()];
    let letters = bytes.iter().rev().take_while(|b| b.is_ascii_alphabetic()).count();
    let (digits, unit) = bytes.split_at(bytes.len() - letters);
    let dt_s = number(digits).filter(|dt_s| *dt_s > 0.0);
    let Some(dt_s) = dt_s else {
        return Err(text.error_at(line, word, "a time step > 0 s after \"DT=\""));
    };
    let next = word_from(line, word.end + 1);
    let unit = if unit.is_empty() { &line.bytes[next.clone()] } else { unit };
    let states_count_first = unit.eq_ignore_ascii_case(b"NPTS");
    let seconds = [&b"S"[..], b"SEC", b"SECS", b"SECOND", b"SECONDS"];
    let is_seconds = seconds.iter().any(|s| unit.eq_ignore_ascii_case(s));
    if unit.first().is_some_and(u8::is_ascii_alphabetic) && !is_seconds && !states_count_first {
        return Err(text.error_at(line, &next, "\"SEC\" after the time step"));
    }
    Ok(dt_s)
}

/// Where the text after an equals sign begins, if one follows.
fn after_equals(line: &Line, from: usize) -> Option<usize> {
    let rest = line.bytes.get(from..)?;
    let at = rest.iter().position(|b| !b.is_ascii_whitespace())?;
    (rest[at] == b'=').then_some(from + at + 1)
}

/// The next word at or after `from`, ended by a blank or a comma.
fn word_from(line: &Line, from: usize) -> Range<usize> {
    let n = line.bytes.len();
    let ends = |b: &u8| b.is_ascii_whitespace() || *b == b',';
    let from = from.min(n);
    let start = line.bytes[from..].iter().position(|b| !ends(b)).map_or(n, |at| from + at);
    let end = line.bytes[start..].iter().position(ends).map_or(n, |at| start + at);
    start..end
}

/// Units that the header states, where they stand.
fn stated_units<'a>(
    text: &Text,
    header: &[Line<'a>],
) -> Result<Option<(Line<'a>, Range<usize>, Units)>, RecordError> {
    let stated = |line: &Line<'a>| {
        let at = line.find("UNITS OF", 0).or_else(|| line.find("UNITS ARE", 0))?;
        let second = word_from(line, at + 6);
        Some((*line, word_from(line, second.end)))
    };
    let Some((line, word)) = header.iter().find_map(stated) else { return Ok(None) };
    let name = line.str(&word);
    let name = name.trim_end_matches(['.', ';', ')']).trim_start_matches('(');
    let quantities = [Quantity::Acceleration, Quantity::Velocity, Quantity::Displacement];
    let announced = quantities.into_iter().find(|q| line.find(q.name(), 0).is_some());
    match Units::parse(name) {
        Some(units) if announced.is_none_or(|q| q == units.quantity()) => {
            Ok(Some((line, word, units)))
        }
        _ => {
            let what = announced.map_or("acceleration, velocity or displacement", Quantity::name);
            Err(text.error_at(&line, &word, format!("units of {what}")))
        }
    }
}

/// The values after the header, exactly as many as it says.
fn values(text: &Text, header: &Line, count: usize) -> Result<Vec<f64>, RecordError> {
    // A value takes two bytes at least, whatever the header promises.
    let mut values = Vec::with_capacity(count.min(text.len() / 2 + 1));
    for line in text.lines().skip(header.number) {
        for word in line.words() {
            if values.len() == count {
                let expected =
                    format!("no more than {count} values, as line {} says", header.number);
                return Err(text.error_at(&line, &word, expected));
            }
            values.push(text.number(&line, &word)?);
        }
    }
    if values.len() < count {
        let expected = format!("{count} values, as line {} says", header.number);
        return Err(text.error_at_end(expected, &format!("the end after {}", values.len())));
    }
    if let Some(cut) = text.cut_word(header) {
        let expected = "a last value written as those before it (a truncated file?)";
        return Err(text.error_at_end(expected, &cut));
    }
    Ok(values)
}

/// Corners as in `FILTER POINTS: HP=0.2 Hz LP=12.5 Hz`; `unknown` and 0 are none.
fn filter(header: &[Line]) -> FilterCorners {
    let corner = |key: &str| {
        header.iter().find_map(|line| {
            let at = after_equals(line, line.find(key, 0)? + key.len())?;
            number(&line.bytes[word_from(line, at)]).filter(|hz| *hz > 0.0)
        })
    };
    FilterCorners { high_pass_hz: corner("HP"), low_pass_hz: corner("LP") }
}

/// Event, station and component: the second line of a header that begins with PEER's own.
#[derive(Default)]
struct Names {
    event: Option<String>,
    station: Option<String>,
    component: Option<String>,
}

impl Names {
    fn of(header: &[Line]) -> Self {
        let [first, second, ..] = header else { return Self::default() };
        let known = ["PEER", "PACIFIC ENGINEERING"];
        if !known.iter().any(|name| first.find(name, 0).is_some()) {
            return Self::default();
        }
        let line = second.trimmed();
        // The network stands in brackets at the end: (USGS STATION 117).
        let names = match line.rsplit_once(" (") {
            Some((names, network)) if network.ends_with(')') => names,
            _ => &line,
        };
        let parts: Vec<&str> = names.split(',').map(str::trim).collect();
        let owned = |text: &str| (!text.is_empty()).then(|| text.to_owned());
        match parts.as_slice() {
            [event @ .., station, component] if !event.is_empty() => Self {
                event: owned(&event.join(", ")),
                station: owned(station),
                component: owned(component),
            },
            _ => Self { event: owned(names), ..Self::default() },
        }
    }
}
