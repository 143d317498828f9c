//! SAC files, binary of either byte order and alphanumeric: one trace each.
//!
//! 70 numbers with a point, 40 whole numbers and 192 characters of header, then the values; at uneven
//! steps their times after them. The header does not name units: its IDEP says displacement, velocity
//! or acceleration, for which the manual has nm, but files of networks hold counts, g or m/s² under
//! the same mark. The caller says. Source: SAC manual, "SAC data file format".

mod header;

use super::bytes::{Bytes, Order, decimal, f32_at, f64_at};
use super::fixed::Cursor;
use super::keys;
use super::sampling;
use super::text::{Line, Text};
use super::{
    Channel, FilterCorners, Format, Options, Quantity, Record, RecordError, Sampling,
    counts_to_add, to_si,
};
use header::{Header, TEXT_LINES};
use slipstick_dynamics::motion::MAX_SAMPLES;
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// Bytes of a binary header.
const HEADER_BYTES: usize = 632;
/// Bytes after the values in version 7, doubles of which the first is the step.
const FOOTER_BYTES: usize = 176;

/// Whether the version of the header stands where it should, and its byte order.
fn order(bytes: &[u8]) -> Option<Order> {
    [Order::Little, Order::Big].into_iter().find(|&order| header::has_version(bytes, order))
}

/// Whether these are the bytes of a binary file.
pub(super) fn recognises_bytes(bytes: &[u8]) -> bool {
    order(bytes).is_some()
}

/// Whether this is an alphanumeric file.
pub(super) fn recognises(text: &Text) -> bool {
    header::of_text(text).is_some()
}

/// Reads a binary file.
pub(super) fn read_bytes(
    source_name: &str,
    all: &[u8],
    options: &Options,
) -> Result<Record, RecordError> {
    let bytes = Bytes::new(source_name, all);
    let Some(order) = order(all) else {
        let expected = "a SAC header, of which byte 304 begins the version 6 or 7";
        return Err(bytes.error(304, expected, "none"));
    };
    let Some(header) = header::of_bytes(all, order) else {
        let found = format!("{} bytes", all.len());
        return Err(bytes.error(all.len(), "632 bytes of a SAC header", &found));
    };
    let error = |place: Place, expected: String, found: &str| match place {
        Place::Header(word) => bytes.error(4 * word, expected, found),
        Place::Value(i) => bytes.error(HEADER_BYTES + 4 * i, expected, found),
    };
    let layout = header.check(&error)?;
    let sections = if layout.even { 1 } else { 2 };
    let values_end = HEADER_BYTES + 4 * sections * layout.count;
    let footer = if header.version == 7 { FOOTER_BYTES } else { 0 };
    if all.len() != values_end + footer {
        let expected = format!("{} bytes for {} values", values_end + footer, layout.count);
        return Err(bytes.error(4 * header::NPTS, expected, &format!("{} bytes", all.len())));
    }
    let numbers: Vec<f64> = (0..sections * layout.count)
        .filter_map(|i| f32_at(all, HEADER_BYTES + 4 * i, order).map(f64::from))
        .collect();
    let dt_s = (header.version == 7).then(|| f64_at(all, values_end, order)).flatten();
    trace(&header, &layout, numbers, dt_s, options, &error, "SAC")
}

/// The number as it is written, and NaN and infinities as they are.
fn decimal_or_not(value: f32) -> f64 {
    if value.is_finite() { decimal(value) } else { f64::from(value) }
}

/// Reads an alphanumeric file.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let Some(header) = header::of_text(text) else {
        let expected = "the 30 lines of an alphanumeric SAC header";
        return Err(text.error_at_start(expected, "none"));
    };
    let nowhere = Line { number: 1, bytes: b"" };
    let error = |place: Place, expected: String, found: &str| {
        let number = match place {
            // Five numbers a line, the 71st on a line of its own kind.
            Place::Header(word) => word / 5,
            Place::Value(i) => TEXT_LINES + i / 5,
        };
        let line = text.lines().nth(number).unwrap_or(nowhere);
        text.error(&line, 0, expected, found)
    };
    let layout = header.check(&error)?;
    let mut cursor = Cursor::new(text);
    cursor.take(TEXT_LINES, "the header")?;
    let announced = text.lines().nth(header::NPTS / 5).unwrap_or(nowhere);
    let sections = if layout.even { 1 } else { 2 };
    let mut numbers = Vec::new();
    for _ in 0..sections {
        numbers.extend(keys::rows(&mut cursor, 5, layout.count, &announced)?);
    }
    keys::end(&mut cursor, sections * layout.count, &announced)?;
    check_last(text, layout.count)?;
    trace(&header, &layout, numbers, None, options, &error, "SAC alphanumeric")
}

/// The last value of a text that ends in it must end in the column of those above it: a number that
/// is cut is another number.
fn check_last(text: &Text, count: usize) -> Result<(), RecordError> {
    let ends = |line: &Line, i: usize| line.words().nth(i).map(|word| word.end);
    let column = text.lines().nth(TEXT_LINES).and_then(|line| ends(&line, (count - 1) % 5));
    let Some(last) = text.lines().last().filter(|last| !last.is_blank()) else { return Ok(()) };
    let end = last.words().last().map(|word| word.end);
    if !text.ends_with_line_end() && end != column {
        let expected = "a last value that ends in the column of those above it (a truncated file?)";
        let word = last.words().last().unwrap_or(0..0);
        return Err(text.error_at(&last, &word, expected));
    }
    Ok(())
}

/// Where something stands in the file.
#[derive(Clone, Copy)]
enum Place {
    /// A word of the header, from 0.
    Header(usize),
    /// A value, from 0.
    Value(usize),
}

/// Number of values and whether they stand at equal steps.
struct Layout {
    count: usize,
    even: bool,
}

impl Header {
    /// What must be right for the values to be read.
    fn check(
        &self,
        error: &impl Fn(Place, String, &str) -> RecordError,
    ) -> Result<Layout, RecordError> {
        let npts = self.integers[header::NPTS - 70];
        let count = usize::try_from(npts).ok().filter(|n| (2..=MAX_SAMPLES).contains(n));
        let Some(count) = count else {
            let expected = "2 to 100 000 000 values (NPTS)".to_owned();
            return Err(error(Place::Header(header::NPTS), expected, &npts.to_string()));
        };
        let kind = self.integers[header::IFTYPE - 70];
        if !matches!(kind, 1 | header::NONE) {
            let expected = "a time series (IFTYPE 1)".to_owned();
            let name = match kind {
                2 | 3 => "a spectrum",
                4 => "x against y",
                51 => "a surface",
                _ => "unknown",
            };
            return Err(error(Place::Header(header::IFTYPE), expected, &format!("{kind}, {name}")));
        }
        Ok(Layout { count, even: self.integers[header::LEVEN - 70] != 0 })
    }
}

/// The channel of a trace.
fn trace(
    header: &Header,
    layout: &Layout,
    mut numbers: Vec<f64>,
    double_dt_s: Option<f64>,
    options: &Options,
    error: &impl Fn(Place, String, &str) -> RecordError,
    name: &str,
) -> Result<Record, RecordError> {
    let mut warnings = Vec::new();
    if let Some(i) = numbers.iter().position(|value| !value.is_finite()) {
        let found = numbers[i].to_string();
        return Err(error(Place::Value(i), "a finite number".to_owned(), &found));
    }
    let idep = header.integers[header::IDEP - 70];
    let stated = match idep {
        6 => Some(Quantity::Displacement),
        7 => Some(Quantity::Velocity),
        8 => Some(Quantity::Acceleration),
        _ => None,
    };
    let Some(units) = options.units else {
        let what = stated.map_or(String::new(), |q| {
            format!(" (its IDEP says {}, which the manual has in nm, but few files)", q.name())
        });
        let expected = counts_to_add() + &what;
        return Err(error(Place::Header(header::IDEP), expected, &idep.to_string()));
    };
    if let Some(stated) = stated.filter(|stated| *stated != units.quantity()) {
        warnings.push(Notice::new(
            NoticeKind::QuantityDiffers,
            format!("the header's IDEP says {}, {units} was given", stated.name()),
        ));
    }
    let sampling = if layout.even {
        let dt_s = double_dt_s.unwrap_or(header.floats[header::DELTA]);
        if !(dt_s.is_finite() && dt_s > 0.0) {
            let expected = "a time step > 0 s (DELTA)".to_owned();
            return Err(error(Place::Header(header::DELTA), expected, &dt_s.to_string()));
        }
        if let Some(given_s) = options.dt_s.filter(|given_s| *given_s != dt_s) {
            let expected = format!("the time step given, {given_s} s (leave it out)");
            return Err(error(Place::Header(header::DELTA), expected, &dt_s.to_string()));
        }
        warnings.extend(header.check_end(layout.count, dt_s));
        Sampling::Dt(dt_s)
    } else {
        // As they are written: 0.02, not the 32 bits nearest to it.
        let times = numbers.split_off(layout.count).into_iter();
        let times_s: Vec<f64> = times.map(|time_s| decimal(time_s as f32)).collect();
        let decreasing = times_s.windows(2).position(|t| t[1] < t[0]);
        let thrice = times_s.windows(3).position(|t| t[2] == t[0]);
        if let Some(i) = decreasing.map(|i| i + 1).or(thrice.map(|i| i + 2)) {
            let expected = "times that do not decrease, each twice at most".to_owned();
            let found = times_s[i].to_string();
            return Err(error(Place::Value(layout.count + i), expected, &found));
        }
        sampling::fits(&times_s, options.dt_s).map_err(|own| {
            let expected = format!("the time step given, {} s", options.dt_s.unwrap_or(0.0));
            error(Place::Value(layout.count), expected, &own)
        })?;
        let (sampling, found) = sampling::of_times(times_s, options.dt_s);
        warnings.extend(found);
        sampling
    };
    warnings.extend(header.check_range(&numbers));
    warnings.extend(header.scale_unused());
    let component = header.text(header::KCMPNM);
    let place = [
        header.text(header::KNETWK),
        header.text(header::KSTNM),
        header.text(header::KHOLE),
        component.clone(),
    ];
    let id = place.clone().map(Option::unwrap_or_default).join(".");
    let channel = Channel {
        name: if id == "..." { "1".to_owned() } else { id },
        event: header.text(header::KEVNM),
        station: keys::join(&place[..2]),
        azimuth_deg: header.azimuth_deg(),
        component,
        units,
        values: to_si(numbers, &units),
        sampling,
        filter: FilterCorners::default(),
        warnings,
    };
    let record = Record {
        format: Format::Sac,
        layout: name.to_owned(),
        channels: vec![channel],
        warnings: vec![],
    };
    Ok(record)
}
