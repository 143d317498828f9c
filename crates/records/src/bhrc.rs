//! BHRC, Iran: three blocks `COMP L1`, `V2`, `T3` in one file, each a volume I whose values in g/10
//! are evenly spaced; the step is the duration over their number.

use super::fixed::{Cursor, Fields};
use super::text::{Text, last_digit};
use super::volume::{Head, Names, count, end_of_channel};
use super::{
    Channel, Format, Options, Record, RecordError, Sampling, keys_to_add, sampling, volume,
};

/// Values stand ten on a line, thirteen columns each.
const FIELDS: Fields = Fields::new(10, 13);

/// Whether the first line names the volume as BHRC's program does.
pub(super) fn recognises(text: &Text) -> bool {
    let mut lines = text.lines().filter(|line| !line.is_blank());
    lines.next().is_some_and(|line| line.find("VOL1DS", 0).is_some())
}

/// Reads the file; channels are named by their components.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut channels = Vec::new();
    while let Some(head) = Head::read(&mut cursor)? {
        let channel = channel(&mut cursor, &head, channels.len() + 1, options)?;
        channels.push(channel);
        end_of_channel(&mut cursor, &mut channels, true)?;
    }
    if channels.is_empty() {
        return Err(text.error_at_end("a channel", "the end of the file"));
    }
    let layout = "BHRC V1".to_owned();
    Ok(Record { format: Format::Bhrc, layout, channels, warnings: vec![] })
}

fn channel(
    cursor: &mut Cursor,
    head: &Head,
    number: usize,
    options: &Options,
) -> Result<Channel, RecordError> {
    let text = cursor.text;
    let (Some(npts), Some(duration)) =
        (head.number_after("NO. OF POINTS"), head.number_after("DURATION"))
    else {
        let line = head.text[0];
        let expected = "\"NO. OF POINTS =\" and \"DURATION =\" in the text below";
        return Err(text.error(&line, 0, expected, "none"));
    };
    let n = count(text, &npts.line, &npts.word)?;
    let Some((line, word, stated)) = head.units() else {
        return Err(text.error(&npts.line, 0, keys_to_add(true, false), &npts.line.trimmed()));
    };
    let Some(units) = stated else {
        return Err(text.error_at(&line, &word, "units of acceleration"));
    };
    volume::agree(text, &line, &word, units, options.units)?;
    let ulp = last_digit(&duration.line.bytes[duration.word.clone()]);
    let Some(dt_s) = sampling::step_of_duration(duration.value, n, ulp) else {
        return Err(text.error_at(&duration.line, &duration.word, "a duration > 0 s"));
    };
    let dt_s = sampling::stated_step(text, &duration.line, &duration.word, dt_s, options.dt_s)?;
    // The ninth real is the rate.
    if let Some(rate) = rate(head).filter(|rate| (rate * dt_s - 1.0).abs() > 0.01) {
        let expected = format!(
            "the duration of {n} values at {rate} samples a second, as the \
                                reals of the header say"
        );
        return Err(text.error_at(&duration.line, &duration.word, expected));
    }
    let values = cursor.values(FIELDS, n, &npts.line)?;
    let names = names(head, number);
    let mut channel = names.channel(head, units, values, Sampling::Dt(dt_s));
    head.check_count(n, &mut channel);
    Ok(channel)
}

fn rate(head: &Head) -> Option<f64> {
    let second = head.reals.get(1)?;
    let word = second.words().next()?;
    super::text::number(&second.bytes[word]).filter(|rate| *rate > 0.0)
}

fn names(head: &Head, number: usize) -> Names {
    let component = head.after_key("COMP", b' ');
    let station = head.text.iter().find_map(|line| {
        let name = line.bytes.get(..line.find("STATION", 0)?)?;
        let name = String::from_utf8_lossy(name.trim_ascii()).into_owned();
        (!name.is_empty()).then_some(name)
    });
    // "Azimuth L 50    T 140": of the component's letter.
    let azimuth_deg = component.as_deref().and_then(|component| {
        let axis = component.get(..1).filter(|axis| matches!(*axis, "L" | "T"))?;
        head.text.iter().find_map(|line| {
            let at = line.find("AZIMUTH", 0)? + 7;
            volume::stated_number(line, line.find(&format!(" {axis} "), at)? + 3)
        })
    });
    Names {
        event: head.number_after("ORIGIN TIME").and_then(|_| head.phrase(2)),
        station,
        azimuth_deg: azimuth_deg.map(|a| a.value).filter(|a| (0.0..=360.0).contains(a)),
        name: component.clone().unwrap_or_else(|| number.to_string()),
        component,
    }
}
