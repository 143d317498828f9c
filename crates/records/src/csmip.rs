//! CSMIP of the California Geological Survey (CDMG, CGS): `.V1` uncorrected in g, `.V2` corrected in
//! cm/s², cm/s and cm; channels one after another, each ended by `/&`. `.V3` holds spectra.
//!
//! Layout: California Division of Mines and Geology, OSMS 85-03. Early volumes I have pairs of time
//! and value in g/10.

use super::component::azimuth;
use super::fixed::{Cursor, Fields};
use super::text::Text;
use super::volume::{Head, Names, blocks, end_of_channel, pairs};
use super::{Channel, Format, Options, Record, RecordError, keys_to_add, volume};

/// Columns of a volume II whose headings do not state them.
const VOLUME_TWO: Fields = Fields::new(8, 10);

/// Columns of a volume I whose heading does not state them.
const VOLUME_ONE: Fields = Fields::new(8, 9);

/// Whether the first line is that of a volume, or of spectra.
pub(super) fn recognises(text: &Text) -> bool {
    let Some(first) = text.lines().find(|line| !line.is_blank()) else { return false };
    let begins = first.trimmed().to_ascii_uppercase();
    let volume = ["UNCORRECTED ACCELEROGRAM", "CORRECTED ACCELEROGRAM"];
    let spectra = "RESPONSE AND FOURIER AMPLITUDE SPECTRA";
    volume.iter().any(|name| begins.starts_with(name)) || begins.starts_with(spectra)
}

/// Reads the file; channels are named by their components, and by their numbers where components
/// stand twice.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut channels: Vec<(usize, Channel)> = Vec::new();
    let mut corrected = false;
    let mut number = 0;
    while let Some(head) = Head::read(&mut cursor)? {
        number += 1;
        corrected = head.corrected;
        let names = names(&head, number);
        let mut own = channel(&mut cursor, &head, &names, options)?;
        end_of_channel(&mut cursor, &mut own, true)?;
        channels.extend(own.into_iter().map(|channel| (number, channel)));
    }
    let repeated = |name: &str| channels.iter().filter(|(_, c)| c.name == name).count() > 1;
    let repeated: Vec<bool> = channels.iter().map(|(_, c)| repeated(&c.name)).collect();
    let named = channels.into_iter().zip(repeated).map(|((number, mut channel), repeated)| {
        if repeated {
            channel.name = format!("chan {number} {}", channel.name);
        }
        channel
    });
    let channels: Vec<Channel> = named.collect();
    if channels.is_empty() {
        return Err(text.error_at_end("a channel", "the end of the file"));
    }
    let layout = if corrected { "CSMIP V2" } else { "CSMIP V1" };
    let layout = format!("{layout}, {} channel{}", number, if number == 1 { "" } else { "s" });
    Ok(Record { format: Format::Csmip, layout, channels, warnings: vec![] })
}

/// The channels of one head: blocks under headings, else pairs.
pub(super) fn channel(
    cursor: &mut Cursor,
    head: &Head,
    names: &Names,
    options: &Options,
) -> Result<Vec<Channel>, RecordError> {
    let usual = if head.corrected { VOLUME_TWO } else { VOLUME_ONE };
    let channels = blocks(cursor, head, names, options, usual)?;
    if !channels.is_empty() || head.corrected {
        if channels.is_empty() {
            let expected = "a heading \"n POINTS OF ACCEL DATA EQUALLY SPACED AT …\"";
            let line = cursor.next(expected)?;
            return Err(cursor.text.error(&line, 0, expected, &line.trimmed()));
        }
        return Ok(channels);
    }
    let text = cursor.text;
    let Some(count) = head.number_after("NO. OF POINTS") else {
        let line = head.text.last().copied();
        return Err(match line {
            Some(line) => text.error(&line, 0, "\"NO. OF POINTS =\" in the text above", "none"),
            None => text.error_at_start("\"NO. OF POINTS =\"", "none"),
        });
    };
    let npts = volume::count(text, &count.line, &count.word)?;
    let units = match (head.units(), options.units) {
        (Some((line, word, Some(stated))), given) => {
            volume::agree(text, &line, &word, stated, given)?;
            stated
        }
        (Some((line, word, None)), _) => {
            return Err(text.error_at(&line, &word, "units of acceleration"));
        }
        (None, Some(given)) => given,
        (None, None) => {
            let found = count.line.trimmed();
            return Err(text.error(&count.line, 0, keys_to_add(true, false), &found));
        }
    };
    let (values, sampling, warnings) = pairs(cursor, npts, &count.line, options.dt_s)?;
    let mut channel = names.channel(head, units, values, sampling);
    channel.warnings.extend(warnings);
    head.check_count(npts, &mut channel);
    head.check_peak("MAX ", &mut channel);
    Ok(vec![channel])
}

/// Event, station and component from the text.
pub(super) fn names(head: &Head, number: usize) -> Names {
    let first = usize::from(head.corrected);
    let component = head.after_key("CHAN", b':');
    Names {
        event: head.phrase(first + 1),
        station: head.phrase(first + 5),
        azimuth_deg: component.as_deref().and_then(azimuth),
        name: component.clone().unwrap_or_else(|| number.to_string()),
        component,
    }
}
