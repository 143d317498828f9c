//! K-NET and KiK-net ASCII files of NIED, Japan: `.EW`, `.NS`, `.UD`, `.EW1`, `.EW2`, …
//!
//! Seventeen lines of key and value, the value from column 19 on; then counts, 8I9. One count is the
//! scale factor, a fraction in gal. The format defines acceleration, and the peak in its header, with
//! the mean of the whole record taken off. Source: NIED, "About K-NET ASCII format".

use super::fixed::{Cursor, Fields};
use super::keys::{self, Field};
use super::text::{Text, number};
use super::{Channel, FilterCorners, Format, Options, Record, RecordError, Sampling, Units, to_si};
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// Lines of the header.
const HEADER_LINES: usize = 17;
/// Where values begin.
const COLUMN: usize = 18;
/// How counts stand.
const FIELDS: Fields = Fields::new(8, 9);

/// Whether the first lines are those of the header.
pub(super) fn recognises(text: &Text) -> bool {
    let mut lines = text.lines().take(HEADER_LINES);
    lines.next().is_some_and(|line| line.find("ORIGIN TIME", 0) == Some(0))
        && lines.any(|line| line.find("SCALE FACTOR", 0) == Some(0))
}

/// Reads the file: one channel.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let lines = cursor.take(HEADER_LINES, "the 17 lines of a K-NET header")?;
    // In the order of the format; some have been written with and without a point after `Max`.
    let [origin, .., code, _, _, _, _, rate, duration, direction, scale, peak, _, _] =
        lines.as_slice()
    else {
        return Err(text.error_at_start("the 17 lines of a K-NET header", "fewer"));
    };
    for (line, key) in [
        (origin, "ORIGIN TIME"),
        (code, "STATION CODE"),
        (rate, "SAMPLING FREQ(HZ)"),
        (duration, "DURATION TIME"),
        (direction, "DIR."),
        (scale, "SCALE FACTOR"),
        (peak, "MAX"),
    ] {
        if line.find(key, 0) != Some(0) {
            let expected = format!("\"{key}\" on line {} of a K-NET header", line.number);
            return Err(text.error(line, 0, expected, &line.trimmed()));
        }
    }
    let value = |line| Field::from(line, COLUMN);

    let rate = value(*rate);
    let hertz = rate.line.find("HZ", COLUMN).filter(|&at| at + 2 == rate.at.end);
    let rate_hz = hertz
        .and_then(|at| number(rate.line.bytes[rate.at.start..at].trim_ascii()))
        .filter(|hz| *hz > 0.0)
        .ok_or_else(|| rate.error(text, "a sampling frequency such as 100Hz"))?;
    let dt_s = rate.same_step(text, 1.0 / rate_hz, options)?;
    let duration = value(*duration);
    let duration_s = duration.positive(text, "a duration in s")?;
    let count = libm::round(rate_hz * duration_s);
    if !(2.0..=slipstick_dynamics::motion::MAX_SAMPLES as f64).contains(&count) {
        return Err(duration.error(text, "a duration of 2 to 100 000 000 values"));
    }
    let count = count as usize;
    let gal_per_count = scale_factor(text, &value(*scale))?;
    let gal = Units::parse("gal").ok_or_else(|| text.error_at_start("units", "none"))?;
    if let Some(given) = options.units.filter(|given| *given != gal) {
        let expected = format!("the units given, {given} (leave them out)");
        return Err(value(*scale).error(text, expected));
    }

    let counts = cursor.values(FIELDS, count, &duration.line)?;
    keys::end(&mut cursor, count, &duration.line)?;
    // Counts are whole numbers: their sum is exact.
    let mean = counts.iter().sum::<f64>() / count as f64;
    let values: Vec<f64> = counts.iter().map(|n| (n - mean) * gal_per_count).collect();
    let mut warnings = vec![Notice::new(
        NoticeKind::MeanRemoved,
        format!(
            "the mean of {:.3} gal was taken off, as the format defines acceleration",
            mean * gal_per_count
        ),
    )];
    let peak = value(*peak);
    warnings.extend(keys::check_peak(text, Some(&peak), &values, "gal", keys::PEAK_FACTOR)?);

    let written = value(*direction).text().unwrap_or_default();
    let (name, azimuth_deg) = component(&written);
    let origin = value(*origin).text();
    let magnitude = lines.get(4).map(|line| value(*line)).and_then(|field| field.text());
    let event = keys::join(&[origin, magnitude.map(|m| format!("M{m}"))]);
    let channel = Channel {
        name: name.clone(),
        event,
        station: value(*code).text(),
        component: Some(name),
        azimuth_deg,
        units: gal,
        values: to_si(values, &gal),
        sampling: Sampling::Dt(dt_s),
        filter: FilterCorners::default(),
        warnings,
    };
    let layout = if written.len() == 1 { "KiK-net" } else { "K-NET" }.to_owned();
    Ok(Record { format: Format::Knet, layout, channels: vec![channel], warnings: vec![] })
}

/// Value of one count in gal: `7845(gal)/8223790`.
fn scale_factor(text: &Text, field: &Field) -> Result<f64, RecordError> {
    let parts = |written: &str| {
        let (gal, counts) = written.split_once('/')?;
        let (gal, unit) = gal.trim().split_once('(')?;
        unit.eq_ignore_ascii_case("gal)").then_some(())?;
        let gal = number(gal.trim().as_bytes()).filter(|gal| *gal > 0.0)?;
        let counts = number(counts.trim().as_bytes()).filter(|counts| *counts > 0.0)?;
        Some(gal / counts)
    };
    parts(&field.line.str(&field.at))
        .ok_or_else(|| field.error(text, "a scale factor such as 3920(gal)/6182761"))
}

/// Name and azimuth of a direction, which is positive to the north and east: KiK-net numbers its six, 1 to 3 in the borehole and 4 to 6 at
/// the surface; the names are those of its files.
fn component(written: &str) -> (String, Option<f64>) {
    let name = match written {
        "1" => "NS1",
        "2" => "EW1",
        "3" => "UD1",
        "4" => "NS2",
        "5" => "EW2",
        "6" => "UD2",
        other => other,
    };
    let azimuth_deg = match name.get(..2) {
        Some("N-" | "NS") => Some(0.0),
        Some("E-" | "EW") => Some(90.0),
        _ => None,
    };
    (name.to_owned(), azimuth_deg)
}
