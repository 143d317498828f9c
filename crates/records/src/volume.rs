//! The layout of Caltech's volumes, which CSMIP, USC, RENADIC and BHRC kept: channels one after
//! another, each with lines of text, integers in fixed columns, reals in fixed columns, and its
//! values.
//!
//! Volume I is uncorrected: either values under a heading that states their number, rate, units and
//! format, or pairs of time and value without one. Volume II is corrected: blocks of acceleration,
//! velocity and displacement, each under such a heading. Volume III holds spectra and is refused.

use core::ops::Range;

use super::fixed::{Cursor, Fields};
use super::text::{Line, Text, number};
use super::{
    Channel, FilterCorners, Options, Quantity, RecordError, Sampling, Units, quality, sampling,
    to_si,
};
use slipstick_dynamics::motion::MAX_SAMPLES;
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// Most lines of text before the integers.
const TEXT_LINES: usize = 40;

/// Most lines of integers or reals.
const NUMBER_LINES: usize = 20;

/// Columns of an integer.
const INTEGER_WIDTH: usize = 5;

/// Reals of volume I stand on seven lines.
const VOLUME_ONE_REALS: usize = 7;

/// What stands before the values of a channel.
pub(super) struct Head<'a> {
    /// Lines of text.
    pub text: Vec<Line<'a>>,
    /// Lines of integers.
    pub integers: Vec<Line<'a>>,
    /// Lines of reals.
    pub reals: Vec<Line<'a>>,
    /// Whether the values were corrected: volume II.
    pub corrected: bool,
}

/// A number that a line of text states, with its place.
#[derive(Clone)]
pub(super) struct Stated<'a> {
    /// The line.
    pub line: Line<'a>,
    /// The word.
    pub word: Range<usize>,
    /// Its value.
    pub value: f64,
}

/// The line above a block of values.
pub(super) struct Heading<'a> {
    /// The line itself.
    pub line: Line<'a>,
    /// Number of values.
    pub count: usize,
    /// Time step in s.
    pub dt_s: f64,
    /// Where the step stands.
    pub step_word: Range<usize>,
    /// Units of the values, where the heading states them.
    pub units: Option<Units>,
    /// What they measure, where it says so.
    pub quantity: Option<Quantity>,
    /// Their columns, where stated.
    pub fields: Option<Fields>,
}

/// Whether a line holds numbers in columns and nothing else, points and exponents where allowed.
fn is_numeric(line: &Line, reals: bool) -> bool {
    let allowed = |b: &u8| match b {
        b'0'..=b'9' | b' ' | b'-' | b'*' => true,
        b'.' | b'+' | b'E' | b'e' | b'D' | b'd' => reals,
        _ => false,
    };
    line.bytes.trim_ascii().iter().all(allowed) && line.bytes.iter().any(u8::is_ascii_digit)
}

impl<'a> Head<'a> {
    /// The head of the next channel; `None` after the last.
    ///
    /// # Errors
    /// Where what follows is no such head, or the head of spectra.
    pub fn read(cursor: &mut Cursor<'_, 'a>) -> Result<Option<Self>, RecordError> {
        cursor.skip_blank();
        let Some(first) = cursor.peek() else { return Ok(None) };
        if first.find("RESPONSE", 0).is_some() && first.find("SPECTRA", 0).is_some() {
            let expected = "a time history, not the spectra of a volume III";
            return Err(cursor.text.error(&first, 0, expected, &first.trimmed()));
        }
        let corrected = first.trimmed().to_ascii_uppercase().starts_with("CORRECTED");
        let mut text = Vec::new();
        // A full line of integers has 60 columns or more; short ones may be numbers in the text.
        let full = |line: &Line| is_numeric(line, false) && line.bytes.trim_ascii_end().len() >= 60;
        while cursor.peek().is_none_or(|line| !full(&line)) {
            let expected = "a header of integers in columns after the lines of text";
            let line = cursor.next(expected)?;
            if text.len() == TEXT_LINES {
                return Err(cursor.text.error(&line, 0, expected, &line.trimmed()));
            }
            text.push(line);
        }
        if text.is_empty() {
            let expected = "lines of text before the header of integers";
            return Err(cursor.text.error(&first, 0, expected, &first.trimmed()));
        }
        let mut integers = Vec::new();
        while cursor.peek().is_some_and(|line| is_numeric(&line, false))
            && integers.len() < NUMBER_LINES
        {
            integers.push(cursor.next("integers")?);
        }
        let limit = if corrected { NUMBER_LINES } else { VOLUME_ONE_REALS };
        let mut reals = Vec::new();
        while reals.len() < limit {
            match cursor.peek().filter(|line| is_numeric(line, true)) {
                Some(_) => reals.push(cursor.next("reals")?),
                None if reals.len() < VOLUME_ONE_REALS => {
                    let expected = "a header of reals in columns";
                    let line = cursor.next(expected)?;
                    return Err(cursor.text.error(&line, 0, expected, &line.trimmed()));
                }
                None => break,
            }
        }
        Ok(Some(Self { text, integers, reals, corrected }))
    }

    /// A warning where the integers state another number of values than there is: the twelfth of their
    /// second line that of volume I, the fifth of the fourth that of volume II.
    pub fn check_count(&self, count: usize, channel: &mut Channel) {
        let (row, place) = if self.corrected { (3, 5) } else { (1, 12) };
        let Some(line) = self.integers.get(row) else { return };
        let columns = (place - 1) * INTEGER_WIDTH..place * INTEGER_WIDTH;
        let stated = line.bytes.get(columns).and_then(|field| number(field.trim_ascii()));
        // 0 and -999 say nothing.
        if let Some(stated) = stated.filter(|stated| *stated > 1.0 && *stated != count as f64) {
            let message = format!(
                "integer {place} of line {} states {stated} values, {count} stand there",
                line.number
            );
            channel.warnings.push(Notice::new(NoticeKind::HeaderDiffers, message));
        }
    }

    /// The number after some words in capitals (and an equals sign) in the text.
    pub fn number_after(&self, capitals: &str) -> Option<Stated<'a>> {
        self.text.iter().find_map(|line| {
            let at = line.find(capitals, 0)? + capitals.len();
            stated_number(line, at)
        })
    }

    /// The text after a key at the start of a line (`CHAN`), cut where two blanks or a bracket
    /// follow.
    pub fn after_key(&self, key: &str, separator: u8) -> Option<String> {
        let line = self.text.iter().find(|line| {
            let bytes = line.bytes.trim_ascii_start();
            bytes.len() > key.len() && bytes[..key.len()].eq_ignore_ascii_case(key.as_bytes())
        })?;
        let bytes = line.bytes.trim_ascii_start();
        let rest = &bytes[key.len()..];
        let at = rest.iter().position(|&b| b == separator)?;
        phrase(&rest[at + 1..])
    }

    /// A line of the text, cut at two blanks: what follows there is on another matter.
    pub fn phrase(&self, index: usize) -> Option<String> {
        phrase(self.text.get(index)?.bytes)
    }

    /// Filter corners: the numbers after `FILTERED`, either the ends of two ramps, of which the
    /// pass band is taken, or two corners.
    pub fn filter(&self) -> FilterCorners {
        let line = self.text.iter().find_map(|line| Some((line, line.find("FILTERED", 0)?)));
        let Some((line, at)) = line else { return FilterCorners::default() };
        // "3 dB pts at" is no corner.
        let at = line.find(" AT ", at).or_else(|| line.find("BETWEEN", at)).unwrap_or(at);
        let (high_pass_hz, low_pass_hz) = match numbers(&line.bytes[at..]).as_slice() {
            [_, high, low, _] | [high, low] => (Some(*high), Some(*low)),
            _ => (None, None),
        };
        let positive = |hz: &f64| *hz > 0.0;
        FilterCorners {
            high_pass_hz: high_pass_hz.filter(positive),
            low_pass_hz: low_pass_hz.filter(positive),
        }
    }

    /// Units that the text states as `UNITS ARE SEC AND G/10`, with their place.
    pub fn units(&self) -> Option<(Line<'a>, Range<usize>, Option<Units>)> {
        self.text.iter().find_map(|line| {
            let at = line.find(" AND ", line.find("UNITS", 0)?)? + 5;
            let mut word = line.words().find(|word| word.start >= at)?;
            while word.len() > 1 && matches!(line.bytes[word.end - 1], b'.' | b',') {
                word.end -= 1;
            }
            Some((*line, word.clone(), Units::parse(&line.str(&word))))
        })
    }

    /// The units of a block whose heading states none: those given, else those that stand beside its peak in
    /// the text; with a notice where the two differ.
    ///
    /// # Errors
    /// Where there are neither.
    fn units_beside_peak(
        &self,
        text: &Text,
        heading: &Heading,
        given: Option<Units>,
    ) -> Result<(Units, Option<Notice>), RecordError> {
        let fits = |units: &Units| Some(units.quantity()) == heading.quantity;
        let key = heading.quantity.and_then(peak_key).unwrap_or_default();
        let peak = self.number_after(key).filter(|_| !key.is_empty());
        let beside = peak.as_ref().and_then(|peak| {
            let word = peak.line.words().find(|word| word.start >= peak.word.end)?;
            Units::parse(peak.line.str(&word).trim_end_matches([',', '.'])).filter(fits)
        });
        let given = given.filter(fits);
        let differ = given.zip(beside).filter(|(given, beside)| given != beside);
        let line = peak.map_or(0, |peak| peak.line.number);
        let notice = differ.map(|(given, beside)| {
            let message = format!(
                "line {line} states the peak in {beside}: the units given, {given}, were taken"
            );
            Notice::new(NoticeKind::HeaderDiffers, message)
        });
        match given.or(beside) {
            Some(units) => Ok((units, notice)),
            None => {
                let found = heading.line.trimmed();
                Err(text.error(&heading.line, 0, super::keys_to_add(true, false), &found))
            }
        }
    }

    /// A warning where the values do not reach the peak that the text states within its digits.
    pub fn check_peak(&self, capitals: &str, channel: &mut Channel) {
        let Some(stated) = self.number_after(capitals) else { return };
        let unit = stated.line.words().find(|word| word.start >= stated.word.end);
        let unit = unit.map(|word| stated.line.str(&word));
        let unit = unit.and_then(|word| Units::parse(word.trim_end_matches([',', '.'])));
        let Some(unit) = unit.filter(|u| u.quantity() == channel.units.quantity()) else { return };
        let ulp = super::text::last_digit(&stated.line.bytes[stated.word.clone()]);
        let warning = quality::peak_differs(channel, stated.value, ulp, unit, stated.line.number);
        channel.warnings.extend(warning);
    }
}

/// What stands before the peak of a quantity in the text of a volume II.
fn peak_key(quantity: Quantity) -> Option<&'static str> {
    match quantity {
        Quantity::Acceleration => Some("PEAK ACCELERATION"),
        Quantity::Velocity => Some("PEAK   VELOCITY"),
        Quantity::Displacement => Some("PEAK DISPLACEMENT"),
        Quantity::Counts => None,
    }
}

/// Text up to two blanks, a tab or a bracket.
fn phrase(bytes: &[u8]) -> Option<String> {
    let bytes = bytes.trim_ascii();
    let ends = |w: &[u8]| w == b"  " || w[0] == b'(' || w[0] == b'\t';
    let end = bytes.windows(2).position(ends).unwrap_or(bytes.len());
    let text = String::from_utf8_lossy(bytes[..end].trim_ascii()).into_owned();
    (!text.is_empty()).then_some(text)
}

/// The number at or after a place in a line, an equals sign or colon and blanks before it.
pub(super) fn stated_number<'a>(line: &Line<'a>, at: usize) -> Option<Stated<'a>> {
    let skip = |b: &u8| b.is_ascii_whitespace() || matches!(b, b'=' | b':');
    let start = at + line.bytes.get(at..)?.iter().position(|b| !skip(b))?;
    let inside = |b: &u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+' | b'E' | b'e');
    let end = line.bytes[start..].iter().position(|b| !inside(b));
    let word = start..end.map_or(line.bytes.len(), |n| start + n);
    let value = number(&line.bytes[word.clone()])?;
    Some(Stated { line: *line, word, value })
}

/// All plain numbers in some text; a hyphen divides, as in `.050- .100`.
fn numbers(bytes: &[u8]) -> Vec<f64> {
    let words = bytes.split(|b| !b.is_ascii_digit() && *b != b'.');
    words.filter_map(number).collect()
}

/// A count of values that a word states.
///
/// # Errors
/// For anything but 2 to 100 000 000.
pub(super) fn count(text: &Text, line: &Line, word: &Range<usize>) -> Result<usize, RecordError> {
    let count = line.str(word).parse::<usize>().ok();
    let allowed = count.filter(|count| (2..=MAX_SAMPLES).contains(count));
    allowed.ok_or_else(|| text.error_at(line, word, "2 to 100 000 000 values"))
}

impl<'a> Heading<'a> {
    /// The heading that a line is; `None` where it is none.
    ///
    /// # Errors
    /// Where it is one but its count, step or units cannot be read.
    pub fn of(text: &Text<'a>, line: Line<'a>) -> Result<Option<Self>, RecordError> {
        let first = line.words().next().unwrap_or(0..0);
        let is_count =
            !first.is_empty() && line.bytes[first.clone()].iter().all(u8::is_ascii_digit);
        let points = line.find("POINTS", 0).or_else(|| line.find("PTS", 0));
        let spaced = line.find("SPACED AT", 0);
        let rate = line.find("PTS/SEC", 0).or_else(|| line.find("SAMPLES/SEC", 0));
        let (true, Some(_), Some(_)) = (is_count, points, spaced.or(rate)) else { return Ok(None) };
        let count = count(text, &line, &first)?;
        let step = match (spaced, rate) {
            (Some(at), _) => stated_number(&line, at + 9),
            (None, Some(end)) => {
                let word = line.words().filter(|word| word.end <= end).last();
                word.and_then(|word| stated_number(&line, word.start))
                    .map(|rate| Stated { value: 1.0 / rate.value, ..rate })
            }
            (None, None) => None,
        };
        let end = line.bytes.len()..line.bytes.len();
        let Some(step) = step.filter(|s| s.value > 0.0 && s.value.is_finite()) else {
            return Err(text.error_at(&line, &end, "a time step > 0 s in this heading"));
        };
        let word = units_word(&line).unwrap_or(end);
        let quantities = [Quantity::Acceleration, Quantity::Velocity, Quantity::Displacement];
        let keys = ["ACC", "VEL", "DIS"];
        let announced =
            quantities.into_iter().zip(keys).find(|(_, key)| line.find(key, 0).is_some());
        let announced = announced.map(|(quantity, _)| quantity);
        let units = Units::parse(&line.str(&word));
        let agrees = |u: &Units| announced.is_none_or(|q| q == u.quantity());
        let units = units.filter(agrees);
        // Older headings state no units; the text above may, beside the peaks.
        if units.is_none() && (!word.is_empty() || announced.is_none()) {
            let what = announced.map_or("acceleration, velocity or displacement", Quantity::name);
            return Err(text.error_at(&line, &word, format!("units of {what}")));
        }
        let quantity = announced.or(units.map(Units::quantity));
        let (dt_s, step_word) = (step.value, step.word);
        let fields = Fields::stated(&line);
        Ok(Some(Self { line, count, dt_s, step_word, units, quantity, fields }))
    }
}

/// Where the units stand in a heading: after `UNITS:`, `UNITS OF`, `UNITS` or `, IN`.
fn units_word(line: &Line) -> Option<Range<usize>> {
    let key = ["UNITS OF", "UNITS:", "UNITS", ", IN "].iter();
    let at = key.filter_map(|key| Some(line.find(key, 0)? + key.len())).next()?;
    let mut word = line.words().find(|word| word.start >= at)?;
    if let Some(open) = line.bytes[word.clone()].iter().position(|&b| b == b'(')
        && open > 0
    {
        word.end = word.start + open;
    }
    while word.len() > 1 && matches!(line.bytes[word.end - 1], b'.' | b',' | b')' | b';') {
        word.end -= 1;
    }
    Some(word)
}

/// What a file that is read has in common in all its channels.
pub(super) struct Names {
    /// Earthquake.
    pub event: Option<String>,
    /// Station.
    pub station: Option<String>,
    /// Component.
    pub component: Option<String>,
    /// Azimuth in degrees.
    pub azimuth_deg: Option<f64>,
    /// What picks the channel.
    pub name: String,
}

impl Names {
    /// A channel of this name with values in its units.
    pub fn channel(
        &self,
        head: &Head,
        units: Units,
        values: Vec<f64>,
        sampling: Sampling,
    ) -> Channel {
        let name = match units.quantity() {
            Quantity::Acceleration | Quantity::Counts => self.name.clone(),
            other => format!("{} {}", self.name, other.name()),
        };
        Channel {
            name,
            event: self.event.clone(),
            station: self.station.clone(),
            component: self.component.clone(),
            azimuth_deg: self.azimuth_deg,
            units,
            values: to_si(values, &units),
            sampling,
            filter: head.filter(),
            warnings: vec![],
        }
    }
}

/// Units given by the caller must be those of the file, where they measure the same.
///
/// # Errors
/// Where they differ.
pub(super) fn agree(
    text: &Text,
    line: &Line,
    word: &Range<usize>,
    stated: Units,
    given: Option<Units>,
) -> Result<(), RecordError> {
    match given {
        Some(given) if given != stated && given.quantity() == stated.quantity() => {
            let expected = format!("the units given, {given} (leave them out)");
            Err(text.error_at(line, word, expected))
        }
        _ => Ok(()),
    }
}

/// All blocks under headings of one channel.
///
/// # Errors
/// Where a heading or its values cannot be read, or contradict the text.
pub(super) fn blocks(
    cursor: &mut Cursor,
    head: &Head,
    names: &Names,
    options: &Options,
    usual: Fields,
) -> Result<Vec<Channel>, RecordError> {
    let mut channels = Vec::new();
    loop {
        cursor.skip_blank();
        let Some(line) = cursor.peek() else { break };
        let Some(heading) = Heading::of(cursor.text, line)? else { break };
        cursor.next("a heading")?;
        let text = cursor.text;
        let word = units_word(&line).unwrap_or(0..0);
        let (units, doubt) = match heading.units {
            Some(stated) => {
                agree(text, &line, &word, stated, options.units)?;
                (stated, None)
            }
            None => head.units_beside_peak(text, &heading, options.units)?,
        };
        let dt_s =
            sampling::stated_step(text, &line, &heading.step_word, heading.dt_s, options.dt_s)?;
        let values = cursor.values(heading.fields.unwrap_or(usual), heading.count, &line)?;
        let mut channel = names.channel(head, units, values, Sampling::Dt(dt_s));
        channel.warnings.extend(doubt);
        check_text(text, head, &heading, &mut channel)?;
        channels.push(channel);
    }
    Ok(channels)
}

/// Compares a heading with what the text says of the same.
fn check_text(
    text: &Text,
    head: &Head,
    heading: &Heading,
    channel: &mut Channel,
) -> Result<(), RecordError> {
    let units = channel.units;
    let acceleration = units.quantity() == Quantity::Acceleration;
    let step = if head.corrected {
        head.number_after("SPACED INTERVALS OF")
    } else {
        let rate = head.text.iter().find_map(|line| {
            let end = line.find("SAMPLES/SEC", 0)?;
            stated_number(line, line.words().filter(|word| word.end <= end).last()?.start)
        });
        rate.map(|rate| Stated { value: 1.0 / rate.value, ..rate })
    };
    if let Some(step) = step.filter(|step| (step.value - heading.dt_s).abs() > 1e-6 * heading.dt_s)
    {
        let expected = format!("the step of line {}, {} s", heading.line.number, heading.dt_s);
        return Err(text.error_at(&step.line, &step.word, expected));
    }
    if let (false, Some((line, word, Some(stated)))) = (head.corrected, head.units())
        && stated != units
    {
        let expected = format!("the units of line {}, {units}", heading.line.number);
        return Err(text.error_at(&line, &word, expected));
    }
    let count = if head.corrected {
        let corrected =
            |line: &&Line| line.find("CORRECTED", 0).is_some() && line.find("DATA", 0).is_some();
        let numbered = head.text.iter().skip(2).filter(corrected);
        numbered.filter_map(|line| stated_number(line, 0)).next()
    } else {
        head.number_after("NO. OF POINTS")
    };
    if let Some(count) = count.filter(|c| acceleration && c.value != heading.count as f64) {
        let message = format!(
            "line {} states {} values, line {} {}, which stand there",
            count.line.number, count.value, heading.line.number, heading.count
        );
        channel.warnings.push(Notice::new(NoticeKind::HeaderDiffers, message));
    }
    if acceleration {
        head.check_count(heading.count, channel);
    }
    match (head.corrected, units.quantity()) {
        (false, Quantity::Acceleration) => head.check_peak("MAX ", channel),
        (true, quantity) => {
            if let Some(key) = peak_key(quantity) {
                head.check_peak(key, channel);
            }
        }
        _ => {}
    }
    Ok(())
}

/// Passes the line that ends a channel (`/&`). Where the file ends without one, the last channel
/// says that it may be cut.
///
/// # Errors
/// Where more numbers follow instead.
pub(super) fn end_of_channel(
    cursor: &mut Cursor,
    channels: &mut [Channel],
    marked: bool,
) -> Result<(), RecordError> {
    cursor.skip_blank();
    let Some(line) = cursor.peek() else {
        if let (true, Some(channel)) = (marked, channels.last_mut()) {
            let message = "the file ends without its line \"/&\" at the end of a channel: it may \
                           be cut, and channels may be missing";
            channel.warnings.push(Notice::new(NoticeKind::Truncated, message));
        }
        return Ok(());
    };
    if line.bytes.trim_ascii_start().starts_with(b"/&") {
        cursor.next("the end of a channel")?;
    } else if is_numeric(&line, true) {
        let expected = "the end of a channel, as its count of values says";
        return Err(cursor.text.error(&line, 0, expected, &line.trimmed()));
    }
    Ok(())
}

/// Pairs of time and value without a heading, `count` of them: fields of seven columns, a blank
/// for the printer before the first or not.
///
/// # Errors
/// Where values or times cannot be read, and where times run backwards.
pub(super) fn pairs(
    cursor: &mut Cursor,
    count: usize,
    announced: &Line,
    given_s: Option<f64>,
) -> Result<(Vec<f64>, Sampling, Vec<Notice>), RecordError> {
    let first = cursor.peek();
    let width = first.map_or(0, |line| line.bytes.trim_ascii_end().len());
    let per_line = (width / 7).clamp(2, 20) / 2 * 2;
    let fields = Fields::new(per_line, 7).after(width.saturating_sub(7 * per_line));
    let cells = cursor.values(fields, 2 * count, announced)?;
    let times_s: Vec<f64> = cells.iter().step_by(2).copied().collect();
    let values: Vec<f64> = cells.into_iter().skip(1).step_by(2).collect();
    if let Some(at) = sampling::disorder(&times_s) {
        let line = first.map_or(0, |line| line.number) + 2 * at / per_line;
        let line = Line { number: line, bytes: b"" };
        let expected = format!("a time after {} s in pair {}", times_s[at - 1], at + 1);
        return Err(cursor.text.error(&line, 0, expected, &format!("{} s", times_s[at])));
    }
    sampling::fits(&times_s, given_s).map_err(|own| {
        let given_s = given_s.unwrap_or_default();
        let expected = format!("times at the step given, {given_s} s (leave it out)");
        cursor.text.error(announced, 0, expected, &own)
    })?;
    let (sampling, warnings) = sampling::of_times(times_s, given_s);
    Ok((values, sampling, warnings))
}
