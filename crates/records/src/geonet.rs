//! GeoNet accelerograms, New Zealand: `.V1A` (as digitised) and `.V2A` (corrected).
//!
//! Up to three components one after another, each: 16 lines of text, 40 integers 10I8, 60 reals
//! 10F8, then acceleration in mm/s², velocity in mm/s and displacement in mm, 10F8 each, of which a
//! V1A has the first only. Source: GNS Science, "Accelerogram data file format".

use super::component::azimuth;
use super::fixed::{Cursor, Fields};
use super::keys::{self, Field};
use super::text::{Line, Text, number};
use super::{Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, Units, to_si};
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// Lines of text before the numbers of the header.
const TEXT_LINES: usize = 16;
/// Components of an accelerograph.
const COMPONENTS: usize = 3;
/// How all numbers stand.
const FIELDS: Fields = Fields::new(10, 8);
/// What stands for a value that is missing.
const MISSING: [f64; 3] = [999_999.9, 9_999.999, 99.999_99];

fn is_first(line: &Line) -> bool {
    ["CORRECTED ACCELEROGRAM", "UNCORRECTED ACCELEROGRAM"]
        .iter()
        .any(|title| line.find(title, 0) == Some(0))
}

/// Whether the first line is the title and the component stands on line 13.
pub(super) fn recognises(text: &Text) -> bool {
    text.lines().next().is_some_and(|line| is_first(&line))
        && text.lines().nth(12).is_some_and(|line| line.find("COMPONENT", 0) == Some(0))
}

/// Reads the file: three channels a component, or one.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut channels = Vec::new();
    let mut layout = "GeoNet V1A";
    let mut components = 0;
    loop {
        let corrected = component(&mut cursor, options, &mut channels)?;
        components += 1;
        if corrected {
            layout = "GeoNet V2A";
        }
        cursor.skip_blank();
        match cursor.peek() {
            None => break,
            Some(line) if line.bytes.iter().all(|b| *b == 0x1A || b.is_ascii_whitespace()) => break,
            Some(line) if is_first(&line) => (),
            Some(line) => {
                let expected = "the title of the next component, as the counts of this one say";
                return Err(text.error(&line, 0, expected, &line.trimmed()));
            }
        }
    }
    if let (1..COMPONENTS, Some(last)) = (components, channels.last_mut()) {
        let message = format!(
            "the file ends after {components} of the three components that an accelerograph has: it \
             may be cut"
        );
        last.warnings.push(Notice::new(NoticeKind::Truncated, message));
    }
    let layout = layout.to_owned();
    Ok(Record { format: Format::GeoNet, layout, channels, warnings: vec![] })
}

/// A number of a header that begins on a line, by its place from 1.
fn place<'a>(text: &Text<'a>, first: Line<'a>, i: usize) -> Field<'a> {
    let line = text.lines().nth(first.number - 1 + (i - 1) / 10).unwrap_or(first);
    let (start, end) = ((i - 1) % 10 * FIELDS.width, line.bytes.len());
    Field { line, at: start.min(end)..(start + FIELDS.width).min(end) }.trimmed()
}

/// Reads a component's blocks; whether it is of a corrected record.
fn component(
    cursor: &mut Cursor,
    options: &Options,
    channels: &mut Vec<Channel>,
) -> Result<bool, RecordError> {
    let text = cursor.text;
    let lines = cursor.take(TEXT_LINES, "the 16 lines of text of a GeoNet header")?;
    let numbers = cursor.peek();
    let integers = cursor.header_numbers(FIELDS, 40, "the integers of a GeoNet header")?;
    let reals_line = cursor.peek();
    let reals = cursor.header_numbers(FIELDS, 60, "the reals of a GeoNet header")?;
    let (Some(numbers), Some(reals_line)) = (numbers, reals_line) else {
        return Err(text.error_at_end("the numbers of a GeoNet header", "the end of the file"));
    };
    let integer = |i: usize| place(text, numbers, i);
    let real = |i: usize| place(text, reals_line, i);

    let corrected = lines[0].find("CORRECTED", 0) == Some(0);
    let digitised = integer(31);
    if !corrected && digitised.line.str(&digitised.at) != integer(34).line.str(&integer(34).at) {
        return Err(integer(34).error(text, "as many values as were digitised"));
    }
    let count_line = Field::from(lines[9], "NUMBER OF POINTS".len());
    let stated = count_line.number().map(|(count, _)| count);
    if lines[9].find("NUMBER OF POINTS", 0) == Some(0) && stated != integers[33] {
        let expected = "the number of points that line 10 of the component states";
        return Err(integer(34).error(text, expected));
    }
    let step = real(26);
    let dt_s = step.step(text, "a time step > 0 s", options)?;
    check_step(text, &lines[10], &step, dt_s)?;
    if let Some(given) = options.units {
        let expected = format!("the units given, {given} (leave them out)");
        return Err(Field::from(lines[13], 0).error(text, expected));
    }

    let label = lines[12].trimmed();
    let name = label.split_whitespace().nth(1).unwrap_or("1").to_owned();
    let azimuth = if azimuth(&name).is_some() { integers[27] } else { None };
    // The middle of each transition band: reals 51 to 53 and 56 to 58.
    let middle = |from: usize, to: usize| {
        let (from, to) = (reals[from - 1]?, reals[to - 1]?);
        (from >= 0.0 && to > 0.0 && corrected).then_some(0.5 * (from + to))
    };
    let filter = FilterCorners { high_pass_hz: middle(51, 53), low_pass_hz: middle(56, 58) };
    let event = lines[7].trimmed().split_whitespace().collect::<Vec<_>>().join(" ");
    let magnitude =
        lines[8].find(" M ", 0).map(|at| Field::from(lines[8], at + 3)).and_then(|f| f.text());
    let event = format!("{event}{}", magnitude.map(|m| format!(" M{m}")).unwrap_or_default());
    let code = lines[1].words().nth(1).map(|word| lines[1].str(&word));
    let station = keys::join(&[code, Some(lines[2].trimmed()).filter(|name| !name.is_empty())]);

    let peaks = if corrected { [36, 41, 46] } else { [31, 41, 46] };
    for (block, (unit, suffix)) in
        [("mm/s/s", ""), ("mm/s", " velocity"), ("mm", " displacement")].into_iter().enumerate()
    {
        let announced = integer(34 + block);
        if block > 0 && integers[33 + block] == Some(0.0) {
            continue;
        }
        let count = announced.count(text, "a number of values")?;
        let mut units = Units::parse(unit).ok_or_else(|| announced.error(text, "units"))?;
        let mut values = cursor.values(FIELDS, count, &announced.line)?;
        if block == 0 && !corrected {
            units = raw_units(text, &lines[10])?;
        } else {
            check_units(text, &lines[13 + block], unit)?;
        }
        let mut warnings: Vec<Notice> = missing(text, &announced, &mut values)?;
        let symbol = units.to_string();
        // The raw peak of a V1A stands in mm/s², whatever one reading is.
        let scaled: Vec<f64> = values.iter().map(|v| v * units.si() * 1000.0).collect();
        let peak = real(peaks[block]);
        let compared = if block == 0 { &scaled } else { &values };
        warnings.extend(keys::check_peak(text, Some(&peak), compared, &symbol, keys::PEAK_FACTOR)?);
        channels.push(Channel {
            name: format!("{name}{suffix}"),
            event: Some(event.clone()),
            station: station.clone(),
            component: Some(name.clone()),
            azimuth_deg: azimuth,
            units,
            values: to_si(values, &units),
            sampling: Sampling::Dt(dt_s),
            filter,
            warnings,
        });
    }
    Ok(corrected)
}

/// The step that the text states, `at 0.020 sec intervals` or `at intervals of 0.005 s`, is that of
/// the numbers.
fn check_step(text: &Text, line: &Line, step: &Field, dt_s: f64) -> Result<(), RecordError> {
    let at = line.find("INTERVALS OF", 0).map(|at| at + "INTERVALS OF".len());
    let at = at.or_else(|| line.find(" AT ", 0).map(|at| at + 4));
    let stated = at.map(|at| Field::from(*line, at)).and_then(|f| Some((f.number()?, f)));
    match stated {
        Some(((stated_s, digit), _)) if (stated_s - dt_s).abs() > 0.501 * digit => {
            let expected = format!("the step of {stated_s} s that line {} states", line.number);
            Err(step.error(text, expected))
        }
        _ => Ok(()),
    }
}

/// Units of a V1A: `Raw readings in units of 1.00 mm/s/s  at intervals of 0.005 s`.
fn raw_units(text: &Text, line: &Line) -> Result<Units, RecordError> {
    let expected = "\"Raw readings in units of 1.00 mm/s/s\"";
    let Some(at) = line.find("UNITS OF", 0).map(|at| at + "UNITS OF".len()) else {
        return Err(text.error(line, 0, expected, &line.trimmed()));
    };
    let field = Field::from(*line, at);
    let words = field.words();
    let [times, unit, ..] = words.as_slice() else { return Err(field.error(text, expected)) };
    let times_one = number(&line.bytes[times.at.clone()]) == Some(1.0);
    let unit_name = line.str(&unit.at);
    let name = if times_one { unit_name } else { format!("{} {unit_name}", line.str(&times.at)) };
    Units::parse(&name).ok_or_else(|| field.error(text, expected))
}

/// The line on a block's peak names its units.
fn check_units(text: &Text, line: &Line, unit: &str) -> Result<(), RecordError> {
    let words: Vec<_> = line.words().collect();
    let named = words.iter().any(|word| line.str(word).eq_ignore_ascii_case(unit));
    if named || line.find("PEAK", 0).is_none() {
        return Ok(());
    }
    let at = Field::from(*line, 0);
    Err(at.error(text, format!("units of {unit} on this line")))
}

/// Takes values that are marked as missing off both ends, with a warning.
///
/// # Errors
/// Where one is missing between others.
fn missing(
    text: &Text,
    announced: &Field,
    values: &mut Vec<f64>,
) -> Result<Vec<Notice>, RecordError> {
    let is_missing = |value: &f64| MISSING.contains(value);
    let before = values.iter().take_while(|v| is_missing(v)).count();
    let after = values.iter().rev().take_while(|v| is_missing(v)).count();
    if before + after == 0 && !values.iter().any(is_missing) {
        return Ok(vec![]);
    }
    let kept = values.len().saturating_sub(after);
    values.truncate(kept);
    values.drain(..before.min(kept));
    if values.len() < 2 || values.iter().any(is_missing) {
        return Err(announced.error(text, "values without missing ones (999999.9) between them"));
    }
    let message = format!(
        "{before} values at the start and {after} at the end are marked as missing and were left \
         out: this component starts {before} steps later than its file"
    );
    Ok(vec![Notice::new(NoticeKind::MissingValues, message)])
}
