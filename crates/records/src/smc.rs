//! SMC of the USGS: one component a file, in cm/s², cm/s or cm.
//!
//! Eleven lines of text, the first of which says what is in it; 48 integers in 8I10 (number 16 the
//! lines of comment, 17 the values, 47 the digits); 50 reals in 5E15.7 (number 2 samples a second,
//! 30 and 32 the extremes, 33 and 35 the corners of the filter);
//! comments that begin with `|`; then values, eight of ten columns on a line or, where integer 47
//! is 8, five of fourteen. Without samples a second (a film digitised where it bends) these are pairs of
//! time and value, of which integer 17 counts the numbers.
//!
//! Layout: USGS Digital Data Series 7 (1992) and the National Strong-Motion Program's description
//! of it; integer 47: D. M. Boore, USGS Open-File Report 00-358.

use super::component::azimuth;
use super::fixed::{Cursor, Fields};
use super::sampling::of_times;
use super::text::{Line, Text};
use super::volume::agree;
use super::{
    Channel, FilterCorners, Format, Options, Quantity, Record, RecordError, Sampling, Units,
    keys_to_add, quality, to_si,
};
use slipstick_dynamics::motion::MAX_SAMPLES;
use slipstick_dynamics::notice::{Notice, NoticeKind};

const TEXT_LINES: usize = 11;
const INTEGERS: usize = 48;
const REALS: usize = 50;

/// Five significant digits.
const USUAL: Fields = Fields::new(8, 10);

/// Eight.
const FINE: Fields = Fields::new(5, 14);

/// Whether the first line is one of the format's, or its eleven lines of text and its integers are.
pub(super) fn recognises(text: &Text) -> bool {
    let Some(first) = text.lines().next() else { return false };
    let kinds = [
        "0 UNKNOWN",
        "1 UNCORRECTED ACCELEROGRAM",
        "2 CORRECTED ACCELEROGRAM",
        "3 VELOCITY",
        "4 DISPLACEMENT",
        "5 RESPONSE SPECTRA",
        "6 FOURIER",
    ];
    let begins = first.trimmed().to_ascii_uppercase();
    let integers = |line: Line| {
        line.bytes.trim_ascii_end().len() >= 70
            && line.words().count() == 8
            && line.words().all(|word| line.str(&word).parse::<i64>().is_ok())
    };
    kinds.iter().any(|kind| begins.starts_with(kind))
        || (begins == "*" && text.lines().nth(TEXT_LINES).is_some_and(integers))
}

/// Reads the file; its one channel is named by its component.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let lines = cursor.take(TEXT_LINES, "eleven lines of text")?;
    let units = units(text, &lines[0], options)?;
    let integers_line = cursor.clone().next("48 integers")?;
    let integers = cursor.header_numbers(USUAL, INTEGERS, "48 integers")?;
    let reals_line = cursor.clone().next("50 reals")?;
    let reals = cursor.header_numbers(Fields::new(5, 15), REALS, "50 reals")?;
    // The first of each is the number that stands for an unknown one.
    let integer = |number: usize| integers[number - 1].filter(|i| Some(*i) != integers[0]);
    let real = |number: usize| {
        let null = reals[0].unwrap_or(1.7e38);
        reals[number - 1].filter(|value| *value < 0.999 * null)
    };
    let Some(count) = integer(17).filter(|n| (2.0..=MAX_SAMPLES as f64).contains(n)) else {
        let expected = "2 to 100 000 000 values, as integer 17 of the header says";
        return Err(text.error(&integers_line, 0, expected, &shown(integers[16])));
    };
    let rate = real(2).filter(|rate| *rate > 0.0 && *rate < 1e6);
    let dt_s = rate.map(|rate| step(text, &reals_line, 1.0 / rate, options)).transpose()?;
    let comments = integer(16).unwrap_or(0.0).clamp(0.0, 1e6) as usize;
    for _ in 0..comments {
        let line = cursor.next("a comment line that begins with \"|\"")?;
        if !line.bytes.starts_with(b"|") {
            let expected = format!(
                "{comments} comment lines that begin with \"|\", as integer 16 of the header says"
            );
            return Err(text.error(&line, 0, expected, &line.trimmed()));
        }
    }
    let fields = if integer(47) == Some(8.0) { FINE } else { USUAL };
    let first = cursor.peek();
    let (values, sampling, mut warnings) = match dt_s {
        Some(dt_s) => {
            let values = cursor.values(fields, count as usize, &integers_line)?;
            (values, Sampling::Dt(dt_s), vec![])
        }
        None => {
            let all = cursor.values(fields, count as usize, &integers_line)?;
            let (times_s, values): (Vec<f64>, Vec<f64>) =
                all.chunks_exact(2).map(|pair| (pair[0], pair[1])).unzip();
            let rises = all.len().is_multiple_of(2)
                && times_s.len() >= 2
                && times_s.windows(2).all(|t| t[1] >= t[0])
                && times_s.last() > times_s.first();
            if !rises {
                let line = first.as_ref().unwrap_or(&reals_line);
                let expected =
                    "pairs of time and value, as real 2 of the header states no samples a second";
                return Err(text.error(line, 0, expected, "times that do not rise"));
            }
            let (sampling, warnings) = of_times(times_s, options.dt_s);
            (values, sampling, warnings)
        }
    };
    cursor.skip_blank();
    if let Some(line) = cursor.peek() {
        // Below such pairs stands a line of the end of the film that the header does not count.
        cursor.next("")?;
        cursor.skip_blank();
        if dt_s.is_some() || cursor.peek().is_some() {
            let expected = format!("no more than {count} values, as integer 17 of the header says");
            return Err(text.error(&line, 0, expected, &line.trimmed()));
        }
        let message = format!(
            "line {}, after the {count} values that integer 17 of the header counts: skipped",
            line.number
        );
        warnings.push(Notice::new(NoticeKind::ColumnSkipped, message));
    }
    let component = after(&lines, "COMPONENT");
    let mut channel = Channel {
        name: component.clone().unwrap_or_else(|| "1".to_owned()),
        event: event(&lines[3]),
        station: station(&lines),
        azimuth_deg: component.as_deref().and_then(azimuth),
        component,
        units,
        values: to_si(values, &units),
        sampling,
        filter: FilterCorners {
            high_pass_hz: real(33).filter(|hz| *hz > 0.0),
            low_pass_hz: real(35).filter(|hz| *hz > 0.0),
        },
        warnings: vec![],
    };
    channel.warnings.append(&mut warnings);
    let extremes = [real(30), real(32)].into_iter().flatten();
    if let Some(peak) = extremes.reduce(|a, b| if a.abs() > b.abs() { a } else { b }) {
        let ulp = 1e-6 * peak.abs();
        channel.warnings.extend(quality::peak_differs(
            &channel,
            peak,
            ulp,
            units,
            reals_line.number,
        ));
    }
    if integer(18) == Some(1.0) {
        let message = "the header marks the record as having a problem: read its comments";
        let warning = Notice::new(NoticeKind::ProblemMarked, message);
        channel.warnings.push(warning);
    }
    let layout = "SMC".to_owned();
    Ok(Record { format: Format::Smc, layout, channels: vec![channel], warnings: vec![] })
}

/// The step of a file that states it, which a given one may only write with more digits: the rate has seven.
fn step(text: &Text, line: &Line, own_s: f64, options: &Options) -> Result<f64, RecordError> {
    match options.dt_s {
        Some(given_s) if (given_s - own_s).abs() > 1e-6 * own_s => {
            let expected = format!("the time step given, {given_s} s (leave it out)");
            Err(text.error(line, 15, expected, &format!("{own_s} s")))
        }
        given_s => Ok(given_s.unwrap_or(own_s)),
    }
}

fn shown(number: Option<f64>) -> String {
    number.map_or("no number".to_owned(), |n| n.to_string())
}

/// Units by the kind of the file.
fn units(text: &Text, first: &Line, options: &Options) -> Result<Units, RecordError> {
    let symbol = match first.trimmed().bytes().next() {
        Some(b'1' | b'2') => "cm/s2",
        Some(b'3') => "cm/s",
        Some(b'4') => "cm",
        Some(b'5' | b'6') => {
            return Err(text.error(first, 0, "a time history, not spectra", &first.trimmed()));
        }
        _ => "",
    };
    let whole = 0..first.bytes.len();
    match (Units::parse(symbol), options.units) {
        (Some(units), given) => {
            agree(text, first, &whole, units, given)?;
            match given.filter(|given| given.quantity() != units.quantity()) {
                Some(given) => {
                    let expected = format!("the units given, {given} (leave them out)");
                    Err(text.error_at(first, &whole, expected))
                }
                None => Ok(units),
            }
        }
        (None, Some(given)) if given.quantity() != Quantity::Counts => Ok(given),
        (None, _) => Err(text.error(first, 0, keys_to_add(true, false), &first.trimmed())),
    }
}

/// The text after a key and an equals sign, to the end of the line.
fn after(lines: &[Line], key: &str) -> Option<String> {
    let line = lines.iter().find(|line| line.find(key, 0).is_some())?;
    let at = line.find(key, 0)? + key.len();
    let at = at + line.bytes[at..].iter().position(|&b| b == b'=')? + 1;
    named(&line.str(&(at..line.bytes.len())))
}

/// `1989  10  18    0004 Loma Prieta, CA`: the words after year, month, day, hour and minute.
fn event(line: &Line) -> Option<String> {
    let is_number =
        |word: &core::ops::Range<usize>| line.bytes[word.clone()].iter().all(u8::is_ascii_digit);
    let word = line.words().enumerate().find(|(i, word)| *i >= 4 || !is_number(word))?.1;
    named(&line.str(&(word.start..line.bytes.len())))
}

/// `station = San Francisco, 1295 Shafter, F component=    360`.
fn station(lines: &[Line]) -> Option<String> {
    let line = lines.iter().find(|line| line.find("STATION", 0).is_some())?;
    let start = line.find("STATION", 0)? + 7;
    let start = start + line.bytes[start..].iter().position(|&b| b == b'=')? + 1;
    let end = line.find("COMPONENT", start).unwrap_or(line.bytes.len());
    named(&line.str(&(start..end)))
}

fn named(text: &str) -> Option<String> {
    let text = text.trim().trim_matches('*').trim();
    (!text.is_empty()).then(|| text.to_owned())
}
