//! MiniSEED, versions 2 and 3: streams of data records, here of one station or many.
//!
//! Each record says what stream it is of, when it starts and how its samples are coded. Records that
//! follow one another within half a step are one segment; at a gap or an overlap a new one begins,
//! and each is a channel of its own: gaps are never bridged. Values are a digitiser's counts, of
//! which the caller may say what one is. A StationXML file beside it is not read.
//! Sources: SEED manual 2.4, chapter 8 and appendix B; FDSN, "miniSEED 3".

mod decode;
mod segments;
mod version2;
mod version3;

use super::bytes::Bytes;
use super::keys;
use super::{
    Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, Units, counts_to_add,
    to_si,
};
use decode::Encoding;
use segments::{Segment, Streams};
use slipstick_dynamics::motion::MAX_SAMPLES;
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// A data record as its header has it.
#[derive(Clone, Debug)]
struct DataRecord {
    /// Where it begins in the file.
    offset: usize,
    /// Bytes of it.
    length: usize,
    /// Network, station, location and channel, joined by points.
    id: String,
    /// Start in ns since 1970.
    start_ns: i64,
    /// Step in s; none for a log.
    dt_s: Option<f64>,
    /// Number of samples.
    count: usize,
    encoding: Encoding,
    /// Where its samples begin and end in the file.
    data: core::ops::Range<usize>,
    /// Whether the digitiser or its amplifier was saturated.
    clipped: bool,
}

/// Whether these bytes begin with a data record or the header of a SEED volume.
pub(super) fn recognises_bytes(bytes: &[u8]) -> bool {
    version2::is_record(bytes) || version3::is_record(bytes) || version2::is_volume(bytes)
}

/// Reads the file.
pub(super) fn read_bytes(
    source_name: &str,
    all: &[u8],
    options: &Options,
) -> Result<Record, RecordError> {
    let bytes = Bytes::new(source_name, all);
    let mut streams = Streams::default();
    let mut warnings = Vec::new();
    let (mut at, mut version, mut length) = (0, 2, 0);
    let mut total = 0;
    while at < all.len() {
        let rest = &all[at..];
        if at > 0 && rest.iter().all(|&b| b == 0 || b == b' ') {
            break;
        }
        let record = if version3::is_record(rest) {
            version = 3;
            version3::header(&bytes, at)?
        } else if version2::is_record(rest) || rest.len() >= length {
            version2::header(&bytes, at)?
        } else {
            // Less than a record, and not the beginning of one.
            None
        };
        let Some(record) = record.filter(|record| at + record.length <= all.len()) else {
            if at == 0 {
                let found = format!("{} bytes", all.len());
                return Err(bytes.error(all.len(), "the whole of the first record", &found));
            }
            warnings.push(Notice::new(
                NoticeKind::Truncated,
                format!(
                    "from byte {at} on, {} bytes are no whole record and were left out",
                    rest.len()
                ),
            ));
            break;
        };
        length = record.length;
        at += length;
        total += record.count;
        if total > MAX_SAMPLES {
            return Err(bytes.error(record.offset, "at most 100 000 000 samples", "more"));
        }
        streams.add(&bytes, record)?;
    }
    let (segments, skipped) = streams.finish();
    if segments.is_empty() {
        let found = skipped.first().map_or("no samples", |warning| warning.message.as_str());
        let expected = "samples coded as numbers";
        return Err(bytes.error(0, expected, found));
    }
    warnings.extend(skipped);
    let Some(units) = options.units.or_else(|| Units::parse("counts")) else {
        return Err(bytes.error(0, counts_to_add(), &format!("MiniSEED of {}", segments[0].id)));
    };
    let channels: Result<Vec<Channel>, RecordError> = segments
        .into_iter()
        .map(|segment| {
            if let Some(given_s) = options.dt_s.filter(|given_s| *given_s != segment.dt_s) {
                let expected = format!("the time step given, {given_s} s (leave it out)");
                let found = format!("{} s", segment.dt_s);
                return Err(bytes.error(segment.offset, expected, &found));
            }
            Ok(channel(segment, units))
        })
        .collect();
    let layout = format!("MiniSEED {version}");
    Ok(Record { format: Format::MiniSeed, layout, channels: channels?, warnings })
}

fn channel(segment: Segment, units: Units) -> Channel {
    let code = segment.id.rsplit('.').next().unwrap_or_default().to_owned();
    let station: Vec<&str> = segment.id.split('.').take(2).collect();
    let station = station.join(" ").trim().to_owned();
    Channel {
        name: segment.name,
        event: None,
        station: (!station.is_empty()).then_some(station),
        azimuth_deg: keys::azimuth_of_code(&code),
        component: (!code.is_empty()).then_some(code),
        units,
        values: to_si(segment.values, &units),
        sampling: Sampling::Dt(segment.dt_s),
        filter: FilterCorners::default(),
        warnings: segment.warnings,
    }
}

/// Nanoseconds since 1970 of a day of a year, from 1, and a time of day; `None` for none.
fn nanoseconds(year: u16, day: u16, [hour, minute, second]: [u8; 3], rest_ns: i64) -> Option<i64> {
    let plausible = (1900..=2200).contains(&year)
        && (1..=366).contains(&day)
        && hour < 24
        && minute < 60
        && second <= 60;
    let year = i64::from(year);
    // Leap days of all years before this one, since 1970.
    let leaps = |y: i64| (y - 1) / 4 - (y - 1) / 100 + (y - 1) / 400;
    let days = 365 * (year - 1970) + leaps(year) - leaps(1970) + i64::from(day) - 1;
    let seconds = 60 * (60 * (24 * days + i64::from(hour)) + i64::from(minute)) + i64::from(second);
    plausible.then_some(seconds * 1_000_000_000 + rest_ns)
}

#[cfg(test)]
mod tests;
