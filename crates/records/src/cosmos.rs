//! COSMOS strong-motion format, version 1.x: `.V0`, `.V1`, `.V2` and their `c` forms.
//!
//! Each channel has lines of text (thirteen, or as many as the first line says), integers, reals and
//! comments, each announced by a line with its count and format, then one or more blocks of values
//! under a heading such as `7000 acceleration pts, approx 70 secs, units=cm/sec2(04),Format=(8F10.5)`,
//! and a line that ends it. The step is real 62 in milliseconds (real 34 is the recorder's own).
//!
//! Layout: COSMOS Strong Motion Programs Board, Strong Motion Data Format 1.20, 2001.

use core::ops::Range;
use slipstick_dynamics::notice::{Notice, NoticeKind};

use super::component::azimuth;
use super::fixed::{Cursor, Fields};
use super::text::{Line, Text};
use super::volume::{agree, count, stated_number};
use super::{
    Channel, FilterCorners, Format, Options, Quantity, Record, RecordError, Sampling, Units,
    keys_to_add, quality, sampling, to_si,
};

/// Lines of text where the first does not say how many.
const TEXT_LINES: usize = 13;

/// Integers and reals that a header holds, and more than any does.
const MAX_NUMBERS: usize = 10_000;

/// Position of the number of values among the integers, from 0: integer 70.
const COUNT: usize = 69;

/// Positions of reals, from 0.
mod real {
    /// Step of the values in ms: real 62.
    pub const STEP_MS: usize = 61;
    /// Length of the series in s: real 63.
    pub const LENGTH_S: usize = 62;
    /// Largest value: real 64.
    pub const PEAK: usize = 63;
}

/// Whether the first line names the format and its version.
pub(super) fn recognises(text: &Text) -> bool {
    let mut lines = text.lines().filter(|line| !line.is_blank());
    lines.next().is_some_and(|line| line.find("(FORMAT V", 0).is_some())
}

/// Reads the file; channels are named by their components.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut channels = Vec::new();
    let mut heads = 0;
    loop {
        cursor.skip_blank();
        if cursor.peek().is_none_or(|line| line.bytes == [0x1A]) {
            break;
        }
        let head = Head::read(&mut cursor)?;
        heads += 1;
        blocks(&mut cursor, &head, options, &mut channels)?;
        end_of_channel(&mut cursor, &mut channels)?;
    }
    if channels.is_empty() {
        return Err(text.error_at_end("a channel", "the end of the file"));
    }
    let s = if heads == 1 { "" } else { "s" };
    let layout = format!("COSMOS v1, {heads} channel{s}");
    Ok(Record { format: Format::Cosmos, layout, channels, warnings: vec![] })
}

/// What stands before the blocks of a channel.
struct Head<'a> {
    text: Vec<Line<'a>>,
    integers: Vec<Option<f64>>,
    reals: Vec<Option<f64>>,
    reals_line: Line<'a>,
    /// The number that stands for an unknown one.
    null: f64,
}

impl<'a> Head<'a> {
    fn read(cursor: &mut Cursor<'_, 'a>) -> Result<Self, RecordError> {
        let first = cursor.next("a first line of text")?;
        if first.find("SPECTRA", 0).is_some() {
            let expected = "a time history, not spectra";
            return Err(cursor.text.error(&first, 0, expected, &first.trimmed()));
        }
        let Some(version) = first.find("(FORMAT V", 0) else {
            let expected = "\"(Format v01.20 with 13 text lines)\" in the first line of a channel";
            return Err(cursor.text.error(&first, 0, expected, &first.trimmed()));
        };
        let lines = first.find(" WITH ", version).and_then(|at| stated_number(&first, at + 6));
        let lines = lines.map_or(TEXT_LINES, |n| n.value.clamp(1.0, 100.0) as usize);
        let mut text = vec![first];
        text.extend(cursor.take(lines - 1, "lines of text")?);
        let null = text.last().and_then(|line| {
            let at = line.find("UNSPECIFIED:", 0)? + 12;
            let words = line.words().filter(|word| word.start >= at);
            stated_number(line, words.last()?.start).map(|n| n.value)
        });
        let (integers, _) = numbers(cursor, "INTEGER", Fields::new(10, 8))?;
        let (reals, reals_line) = numbers(cursor, "REAL", Fields::new(5, 15))?;
        comments(cursor)?;
        let null = null.unwrap_or(-999.0);
        Ok(Self { text, integers, reals, reals_line, null })
    }

    fn real(&self, index: usize) -> Option<f64> {
        self.reals.get(index).copied().flatten().filter(|value| *value != self.null)
    }

    /// Step in s.
    fn step_s(&self, cursor: &Cursor) -> Result<f64, RecordError> {
        let step = self.real(real::STEP_MS).filter(|ms| *ms > 0.0);
        step.map(|ms| ms / 1000.0).ok_or_else(|| {
            let expected = "a sampling interval in ms as real 62 of the header";
            cursor.text.error(&self.reals_line, 0, expected, "none")
        })
    }

    /// `Sta Chan  1: 340 deg (Rcrdr …` or `Sta Cha:  1: 340 deg …`: after the channel's number.
    fn component(&self) -> Option<String> {
        let line = self.text.get(8)?;
        let at = line.find("CHA", 0)?;
        let is_number = |b: &u8| b.is_ascii_digit() || *b == b'?';
        let number = at + line.bytes[at..].iter().position(is_number)?;
        let colon = number + line.bytes[number..].iter().position(|&b| b == b':')? + 1;
        phrase(line, colon..line.bytes.len())
    }

    fn event(&self) -> Option<String> {
        let text = self.text.get(1)?.trimmed();
        let words: Vec<&str> = text.split_whitespace().collect();
        (!words.is_empty()).then(|| words.join(" "))
    }

    /// `Statn No: 01-23075  Code:CE-J2236  CDMG Yucaipa - Bryant & Oak Glen`.
    fn station(&self) -> Option<String> {
        let line = self.text.get(4)?;
        let after = line.find("CODE:", 0).map_or(0, |at| at + 5);
        let text = line.str(&(after..line.bytes.len()));
        let words: Vec<&str> = text.split_whitespace().collect();
        (!words.is_empty()).then(|| words.join(" "))
    }

    /// `Record filtered below 0.30  Hz (periods over  14.5 secs), and above 40.0 Hz`.
    fn filter(&self) -> FilterCorners {
        let line = self.text.iter().find(|line| line.find("FILTERED BELOW", 0).is_some());
        let corner = |key: &str| {
            let line = line?;
            let hz = stated_number(line, line.find(key, 0)? + key.len())?;
            (hz.value > 0.0).then_some(hz.value)
        };
        FilterCorners { high_pass_hz: corner("BELOW"), low_pass_hz: corner("ABOVE") }
    }
}

/// Text of a part of a line up to two blanks or a bracket.
fn phrase(line: &Line, part: Range<usize>) -> Option<String> {
    let text = line.str(&part);
    let text = text.trim();
    let end = text.find("  ").into_iter().chain(text.find('(')).min().unwrap_or(text.len());
    let text = text[..end].trim();
    (!text.is_empty()).then(|| text.to_owned())
}

/// Numbers announced by `100 Real-header values follow on  20 lines, Format= (5F15.6)`.
fn numbers<'a>(
    cursor: &mut Cursor<'_, 'a>,
    kind: &str,
    usual: Fields,
) -> Result<(Vec<Option<f64>>, Line<'a>), RecordError> {
    let expected = format!("\"n {}-header values follow\"", kind.to_lowercase());
    let line = cursor.next(&expected)?;
    let number = stated_number(&line, 0).filter(|_| line.find(kind, 0).is_some());
    let Some(number) = number else {
        return Err(cursor.text.error(&line, 0, expected, &line.trimmed()));
    };
    let count = number.value;
    if !(0.0..=MAX_NUMBERS as f64).contains(&count) {
        return Err(cursor.text.error_at(&line, &number.word, "at most 10 000 header values"));
    }
    let fields = Fields::stated(&line).unwrap_or(usual);
    let count = count as usize;
    let stated = line.find("FOLLOW ON", 0).and_then(|at| stated_number(&line, at + 9));
    if let Some(stated) = stated.filter(|lines| lines.value != fields.lines(count) as f64) {
        let expected = format!("{} lines for {count} values", fields.lines(count));
        return Err(cursor.text.error_at(&line, &stated.word, expected));
    }
    Ok((cursor.header_numbers(fields, count, &expected)?, line))
}

/// Comments announced by `2 Comment line(s) follow, each starting with a "|":`.
fn comments(cursor: &mut Cursor) -> Result<(), RecordError> {
    let announced = cursor.peek().filter(|line| line.find("COMMENT", 0).is_some());
    let Some(line) = announced else { return Ok(()) };
    cursor.next("comments")?;
    let count = stated_number(&line, 0).map_or(0.0, |n| n.value);
    for _ in 0..count.clamp(0.0, MAX_NUMBERS as f64) as usize {
        let comment = cursor.next("a comment line that begins with \"|\"")?;
        if !comment.bytes.trim_ascii_start().starts_with(b"|") {
            let expected = format!("{count} comment lines that begin with \"|\"");
            return Err(cursor.text.error(&comment, 0, expected, &comment.trimmed()));
        }
    }
    Ok(())
}

/// Whether a line is the heading of a block.
fn is_heading(line: &Line) -> bool {
    line.find(" PTS", 0).is_some() && line.find("UNITS", 0).is_some()
}

/// All blocks of one channel.
fn blocks(
    cursor: &mut Cursor,
    head: &Head,
    options: &Options,
    channels: &mut Vec<Channel>,
) -> Result<(), RecordError> {
    let expected = "a heading \"n acceleration pts, approx n secs, units=cm/sec2(04),Format=…\"";
    let mut line = cursor.next(expected)?;
    loop {
        if !is_heading(&line) {
            return Err(cursor.text.error(&line, 0, expected, &line.trimmed()));
        }
        channels.push(block(cursor, head, &line, options)?);
        cursor.skip_blank();
        match cursor.peek().filter(is_heading) {
            Some(_) => line = cursor.next(expected)?,
            None => return Ok(()),
        }
    }
}

fn block(
    cursor: &mut Cursor,
    head: &Head,
    line: &Line,
    options: &Options,
) -> Result<Channel, RecordError> {
    let text = cursor.text;
    let first = line.words().next().unwrap_or(0..0);
    let npts = count(text, line, &first)?;
    let (units, word) = units(text, line)?;
    let units = match (units, options.units) {
        // What one count is.
        (Some(units), Some(given)) if units.quantity() == Quantity::Counts => given,
        (Some(units), given) => {
            agree(text, line, &word, units, given)?;
            units
        }
        (None, Some(given)) => given,
        (None, None) => {
            return Err(text.error(line, word.start, keys_to_add(true, false), &line.trimmed()));
        }
    };
    let step_s = head.step_s(cursor)?;
    let dt_s = sampling::stated_step(text, &head.reals_line, &(0..0), step_s, options.dt_s)?;
    let length_s = npts as f64 * dt_s;
    // The heading's length is rounded to seconds.
    let approx = line.find("APPROX", 0).and_then(|at| stated_number(line, at + 6));
    let differs = |s: f64| (s - length_s).abs() > 1.0 + 0.005 * length_s;
    if let Some(approx) = approx.filter(|s| differs(s.value)) {
        let expected =
            format!("about {length_s:.1} s for {npts} values at {dt_s} s, as real 62 says");
        return Err(text.error_at(line, &approx.word, expected));
    }
    let fields = Fields::stated(line).unwrap_or(Fields::new(8, 10));
    let values = cursor.values(fields, npts, line)?;
    // Among whole numbers of a recorder it may be a value.
    let whole = values.iter().all(|value| libm::trunc(*value) == *value);
    let missing = |value: &f64| *value == head.null && !whole;
    if let Some(at) = values.iter().position(missing) {
        let expected = format!("a value where {} stands for a missing one", head.null);
        let line = Line { number: line.number + 1 + at / fields.per_line, bytes: b"" };
        return Err(text.error(&line, 0, expected, &head.null.to_string()));
    }
    let component = head.component();
    let mut name = component.clone().unwrap_or_else(|| "1".to_owned());
    if matches!(units.quantity(), Quantity::Velocity | Quantity::Displacement) {
        name = format!("{name} {}", units.quantity().name());
    }
    let mut channel = Channel {
        name,
        event: head.event(),
        station: head.station(),
        azimuth_deg: component.as_deref().and_then(azimuth),
        component,
        units,
        values: to_si(values, &units),
        sampling: Sampling::Dt(dt_s),
        filter: head.filter(),
        warnings: vec![],
    };
    // 0 and -999 say nothing.
    let stated = head.integers.get(COUNT).copied().flatten().filter(|n| *n > 1.0);
    if let Some(stated) = stated.filter(|stated| *stated != npts as f64) {
        let message = format!(
            "integer 70 of the header states {stated} values, line {} {npts}, which stand there",
            line.number
        );
        channel.warnings.push(Notice::new(NoticeKind::HeaderDiffers, message));
    }
    let series_s = head.real(real::LENGTH_S).filter(|s| *s > 0.0);
    if let Some(series_s) = series_s.filter(|s| (s - length_s).abs() > 2.0 * dt_s + 1e-3 * s) {
        let message = format!(
            "real 63 states a length of {series_s} s, {npts} values at {dt_s} s make {length_s} s"
        );
        channel.warnings.push(Notice::new(NoticeKind::HeaderDiffers, message));
    }
    // Real 64 has six decimals at most; it is that of the first block.
    let is_first = !matches!(units.quantity(), Quantity::Velocity | Quantity::Displacement)
        || head.text[0].find("ACCEL", 0).is_none();
    if let Some(peak) = head.real(real::PEAK).filter(|_| is_first) {
        let number = head.reals_line.number;
        channel.warnings.extend(quality::peak_differs(&channel, peak, 1e-6, units, number));
    }
    Ok(channel)
}

/// The units of a heading, by name (`units=cm/sec2`), by code (`(04)`) or both; `None` where it
/// has neither. Codes: table 2 of the format.
fn units(text: &Text, line: &Line) -> Result<(Option<Units>, Range<usize>), RecordError> {
    let n = line.bytes.len();
    let at = line.find("UNITS", 0).map_or(n, |at| at + 5);
    let skip = line.bytes[at..].iter().take_while(|b| matches!(b, b'=' | b':' | b' ')).count();
    let start = at + skip;
    let end = line.find(",FORMAT", start).or_else(|| line.find("FORMAT", start)).unwrap_or(n);
    let stated = line.str(&(start..end));
    let word = start..start + line.bytes[start..end].trim_ascii_end().len();
    let (name, code) = match stated.split_once('(') {
        Some((name, code)) => (name, code.split(')').next().unwrap_or("").trim().parse().ok()),
        None => (stated.as_str(), None),
    };
    let name = name.trim().trim_end_matches([',', '.']).trim();
    let named = Units::parse(name);
    let coded = code.map(|code: u32| {
        Units::parse(match code {
            2 => "g",
            4 | 10 => "cm/s2",
            5 => "cm/s",
            6 => "cm",
            7 => "in/s2",
            8 => "in/s",
            9 => "in",
            11 => "mg",
            12 => "ug",
            50 => "counts",
            _ => "",
        })
    });
    // The heading names the quantity too.
    let quantities = [
        ("ACCEL", Quantity::Acceleration),
        ("VELOC", Quantity::Velocity),
        ("DISPL", Quantity::Displacement),
    ];
    let mut quantities = quantities.iter();
    let announced = quantities.find(|(key, _)| line.find(key, 0).is_some()).map(|(_, q)| *q);
    let units = match (named, coded) {
        (None, None) if name.is_empty() => return Ok((None, word)),
        (Some(named), None) => Some(named),
        (None, Some(coded)) if name.is_empty() => coded,
        (Some(named), Some(Some(coded))) if named == coded => Some(named),
        _ => None,
    };
    let fits =
        |u: &Units| u.quantity() == Quantity::Counts || announced.is_none_or(|q| q == u.quantity());
    match units.filter(fits) {
        Some(units) => Ok((Some(units), word)),
        None => {
            let what = announced.map_or("motion", Quantity::name);
            let expected = format!("units of {what}, with the code that table 2 has for them");
            Err(text.error_at(line, &word, expected))
        }
    }
}

/// Passes the line that ends a channel: `End-of-data for …` or `/&`.
fn end_of_channel(cursor: &mut Cursor, channels: &mut [Channel]) -> Result<(), RecordError> {
    cursor.skip_blank();
    let Some(line) = cursor.peek() else {
        if let Some(channel) = channels.last_mut() {
            let message = "the file ends without its line \"End-of-data\": it may be cut, and \
                           channels may be missing"
                .to_owned();
            channel.warnings.push(Notice::new(NoticeKind::Truncated, message));
        }
        return Ok(());
    };
    let is_end = line.bytes.trim_ascii_start().starts_with(b"/&")
        || line.find("END-OF-DATA", 0).is_some()
        || line.find("END OF DATA", 0).is_some();
    if !is_end {
        let expected = "the line \"End-of-data\" after the count of values";
        return Err(cursor.text.error(&line, 0, expected, &line.trimmed()));
    }
    cursor.next("the end of a channel")?;
    Ok(())
}
