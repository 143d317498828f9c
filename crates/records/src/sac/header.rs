//! The header of a SAC file: 70 numbers with a point, 40 whole numbers, 192 characters.

use crate::bytes::{Order, f32_at, i32_at, text_at};
use crate::text::{Text, number};
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// What stands for a number that is not defined.
pub(super) const NONE: i32 = -12345;
/// Lines of an alphanumeric header: 14 of 5 numbers, 8 of 5 whole numbers, 8 of text.
pub(super) const TEXT_LINES: usize = 30;

/// Words of the header, counted from 0.
pub(super) const DELTA: usize = 0;
const DEPMIN: usize = 1;
const DEPMAX: usize = 2;
const SCALE: usize = 3;
const B: usize = 5;
const E: usize = 6;
const CMPAZ: usize = 57;
const CMPINC: usize = 58;
const NVHDR: usize = 76;
/// Number of values.
pub(super) const NPTS: usize = 79;
/// Kind of file.
pub(super) const IFTYPE: usize = 85;
/// Kind of values.
pub(super) const IDEP: usize = 86;
/// Whether the steps are equal.
pub(super) const LEVEN: usize = 105;

/// Texts of the header: where each begins and how long it is.
pub(super) type Characters = (usize, usize);
/// Station.
pub(super) const KSTNM: Characters = (0, 8);
/// Event.
pub(super) const KEVNM: Characters = (8, 16);
/// Hole or location.
pub(super) const KHOLE: Characters = (24, 8);
/// Component.
pub(super) const KCMPNM: Characters = (160, 8);
/// Network.
pub(super) const KNETWK: Characters = (168, 8);

/// What a header holds.
pub(super) struct Header {
    /// Version, 6 or 7.
    pub version: i32,
    /// The first 70 words.
    pub floats: Vec<f64>,
    /// The 40 words after them.
    pub integers: Vec<i32>,
    characters: Vec<u8>,
}

/// Whether the version stands in its place in this byte order.
pub(super) fn has_version(bytes: &[u8], order: Order) -> bool {
    let logical = |word: usize| matches!(i32_at(bytes, 4 * word, order), Some(0 | 1 | NONE));
    matches!(i32_at(bytes, 4 * NVHDR, order), Some(6 | 7)) && (bytes.len() < 440 || logical(LEVEN))
}

/// The header of a binary file; `None` where the bytes end before it does.
pub(super) fn of_bytes(bytes: &[u8], order: Order) -> Option<Header> {
    let floats: Option<Vec<f64>> =
        (0..70).map(|i| f32_at(bytes, 4 * i, order).map(super::decimal_or_not)).collect();
    let integers: Option<Vec<i32>> = (70..110).map(|i| i32_at(bytes, 4 * i, order)).collect();
    let characters = bytes.get(440..632)?.to_vec();
    let integers = integers?;
    Some(Header { version: integers[NVHDR - 70], floats: floats?, integers, characters })
}

/// The header of an alphanumeric file, if this is one.
pub(super) fn of_text(text: &Text) -> Option<Header> {
    let mut lines = text.lines();
    let (mut floats, mut integers) = (Vec::with_capacity(70), Vec::with_capacity(40));
    for _ in 0..14 {
        let line = lines.next()?;
        let before = floats.len();
        for word in line.words().take(6) {
            // Written with seven digits from 32 bits.
            floats.push(number(&line.bytes[word])?);
        }
        (floats.len() == before + 5).then_some(())?;
    }
    for _ in 0..8 {
        let line = lines.next()?;
        let before = integers.len();
        for word in line.words().take(6) {
            integers.push(line.str(&word).parse::<i32>().ok()?);
        }
        (integers.len() == before + 5).then_some(())?;
    }
    let version = integers[NVHDR - 70];
    matches!(version, 6 | 7).then_some(())?;
    let mut characters = Vec::with_capacity(192);
    for _ in 0..8 {
        let mut bytes = lines.next()?.bytes.to_vec();
        bytes.resize(24, b' ');
        characters.extend(bytes);
    }
    Some(Header { version, floats, integers, characters })
}

impl Header {
    /// A text, where it is defined.
    pub fn text(&self, (at, length): Characters) -> Option<String> {
        text_at(&self.characters, at, length).filter(|text| !text.starts_with("-12345"))
    }

    fn float(&self, word: usize) -> Option<f64> {
        let value = self.floats[word];
        (value.is_finite() && value != f64::from(NONE)).then_some(value)
    }

    /// Azimuth of a horizontal component: its inclination is 90° from the vertical.
    pub fn azimuth_deg(&self) -> Option<f64> {
        let azimuth = self.float(CMPAZ).filter(|d| (-360.0..=360.0).contains(d))?;
        let horizontal = self.float(CMPINC).is_none_or(|d| (d - 90.0).abs() < 1.0);
        horizontal.then_some(if azimuth < 0.0 { azimuth + 360.0 } else { azimuth })
    }

    /// A warning where the times of the first and last value are not as many steps apart.
    pub fn check_end(&self, count: usize, dt_s: f64) -> Option<Notice> {
        let (begin_s, end_s) = (self.float(B)?, self.float(E)?);
        let span_s = (count - 1) as f64 * dt_s;
        // Both have seven digits.
        let slack_s = 0.5 * dt_s + 1e-6 * (begin_s.abs() + end_s.abs());
        ((end_s - begin_s - span_s).abs() > slack_s).then(|| {
            Notice::new(
                NoticeKind::DurationDiffers,
                format!(
                    "the header's B and E are {} s apart, {count} values at {dt_s} s {span_s} s",
                    end_s - begin_s
                ),
            )
        })
    }

    /// A warning where the least and largest value are not those that the header states.
    pub fn check_range(&self, values: &[f64]) -> Option<Notice> {
        let (low, high) = (self.float(DEPMIN)?, self.float(DEPMAX)?);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let slack = 1e-5 * least.abs().max(largest.abs());
        let differ = (low - least).abs() > slack || (high - largest).abs() > slack;
        (differ && low <= high).then(|| {
            let message = format!(
                "the header states values from {low} to {high}, they go from {least} to {largest}"
            );
            Notice::new(NoticeKind::PeakDiffers, message)
        })
    }

    /// A warning where a factor is stated, which SAC itself does not use.
    pub fn scale_unused(&self) -> Option<Notice> {
        let scale = self.float(SCALE).filter(|scale| *scale != 1.0)?;
        Some(Notice::new(
            NoticeKind::ScaleUnused,
            format!("the header states a factor of {scale} (SCALE), which was not used"),
        ))
    }
}
