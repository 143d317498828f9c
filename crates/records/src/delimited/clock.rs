//! Times as clocks and loggers write them: dates, times of day and numbers of many digits, whose
//! differences are taken in decimals.

/// Units of [`Instant`] in a second.
const UNITS: i128 = 1_000_000_000_000_000_000;
/// Decimals of it.
const DECIMALS: usize = 18;
/// Seconds of a day.
pub(super) const DAY_S: i128 = 86_400;

/// Numbers of a unit since 1970 from 2001 to 2286: which unit their size tells, and how many of it
/// are a second.
const EPOCHS: [(f64, &str, f64); 3] =
    [(1e12, "milliseconds", 1e-3), (1e15, "microseconds", 1e-6), (1e18, "nanoseconds", 1e-9)];

/// A time as it is written, without rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Instant<'a> {
    /// What stands before a time of day; empty for a number.
    date: &'a [u8],
    /// In 10⁻¹⁸ of the unit that the column has.
    units: i128,
}

impl<'a> Instant<'a> {
    /// A number, or a time of day with or without a date before it and a time zone behind it:
    /// `2025-11-26T10:00:00.005Z`, `26.11.2025 10:00:00,005`, `10:00:00.005`.
    pub fn of(word: &'a [u8]) -> Option<Self> {
        decimal(word).map(|units| Self { date: b"", units }).or_else(|| time_of_day(word))
    }
}

/// Whether a word is a time of day, with or without a date.
pub(super) fn is_time_of_day(word: &[u8]) -> bool {
    time_of_day(word).is_some()
}

/// Whether a word is a date alone: `2025-11-26`, `26.11.2025`, `11/26/2025`.
pub(super) fn is_date(word: &[u8]) -> bool {
    let is_of = |separator: &u8| {
        let parts: Vec<&[u8]> = word.split(|b| b == separator).collect();
        let is_part =
            |part: &&[u8]| (1..=4).contains(&part.len()) && part.iter().all(u8::is_ascii_digit);
        parts.len() == 3 && parts.iter().all(is_part)
    };
    b"-/.".iter().any(is_of)
}

/// Differences to the first of some instants, each correctly rounded, in the column's unit (in s for
/// times of day). A date that changes is the next day.
pub(super) fn since_first<'a>(instants: impl Iterator<Item = Instant<'a>>) -> Vec<f64> {
    let mut first = None;
    let mut date: Option<&[u8]> = None;
    let mut days = 0;
    instants
        .map(|instant| {
            days += i128::from(date.is_some_and(|before| before != instant.date));
            date = Some(instant.date);
            let units = instant.units + days * DAY_S * UNITS;
            nearest(units - *first.get_or_insert(units))
        })
        .collect()
}

/// The number nearest to units of 10⁻¹⁸.
fn nearest(mut units: i128) -> f64 {
    let mut scale = UNITS as f64;
    while units != 0 && units % 10 == 0 && scale > 1.0 {
        (units, scale) = (units / 10, scale / 10.0);
    }
    units as f64 / scale
}

/// Seconds in what a number counts that is only a time since 1970 in that unit, and its name.
pub(super) fn epoch_unit(number: f64) -> Option<(f64, &'static str)> {
    let of = |(least, ..): &&(f64, &str, f64)| (*least..10.0 * least).contains(&number);
    EPOCHS.iter().find(of).map(|&(_, name, second)| (second, name))
}

/// Whether times are the days that spreadsheets count, from 1982 on: of that size, and several a minute.
pub(super) fn are_days(first: f64, last: f64, rows: usize) -> bool {
    let day = DAY_S as f64;
    let step_s = (last - first) * day / rows as f64;
    (30_000.0..80_000.0).contains(&first) && last - first < 1.0 && (0.0..20.0).contains(&step_s)
}

/// A decimal number, with point or comma, perhaps with an exponent, in 10⁻¹⁸; `None` where it has
/// more decimals or is too large.
fn decimal(word: &[u8]) -> Option<i128> {
    let (negative, word) = match word.first()? {
        b'-' => (true, &word[1..]),
        b'+' => (false, &word[1..]),
        _ => (false, word),
    };
    let e = word.iter().position(|b| matches!(b, b'e' | b'E' | b'd' | b'D'));
    let (digits, exponent) = word.split_at(e.unwrap_or(word.len()));
    let exponent: i32 = match exponent {
        [] => 0,
        [_, rest @ ..] => core::str::from_utf8(rest).ok()?.parse().ok()?,
    };
    let point = digits.iter().position(|b| matches!(b, b'.' | b','));
    let (whole, decimals) = digits.split_at(point.unwrap_or(digits.len()));
    let decimals = decimals.get(1..).unwrap_or(b"");
    let decimals = &decimals[..decimals.len() - trailing_zeros(decimals)];
    if whole.is_empty() && decimals.is_empty() && point.is_none() {
        return None;
    }
    let mut value: i128 = 0;
    for byte in whole.iter().chain(decimals) {
        let digit = byte.is_ascii_digit().then(|| i128::from(byte - b'0'))?;
        value = value.checked_mul(10)?.checked_add(digit)?;
    }
    let power = exponent + i32::try_from(DECIMALS).ok()? - i32::try_from(decimals.len()).ok()?;
    let value = value.checked_mul(10_i128.checked_pow(u32::try_from(power).ok()?)?)?;
    Some(if negative { -value } else { value })
}

fn trailing_zeros(digits: &[u8]) -> usize {
    digits.iter().rev().take_while(|b| **b == b'0').count()
}

/// A time of day in s, and the date before it.
fn time_of_day(word: &[u8]) -> Option<Instant<'_>> {
    let colon = word.iter().position(|b| *b == b':')?;
    let hour = word[..colon].iter().rposition(|b| !b.is_ascii_digit()).map_or(0, |at| at + 1);
    let date = word[..hour].trim_ascii_end();
    let date = date.strip_suffix(b"T").or(date.strip_suffix(b"t")).unwrap_or(date);
    if !(date.is_empty() || is_date(date)) {
        return None;
    }
    let (first, rest) = whole(&word[hour..colon], &word[colon + 1..])?;
    let (second, rest) = whole(leading(rest), &rest[leading(rest).len()..])?;
    let (third, rest) = match rest {
        [b':', rest @ ..] => {
            let (value, rest) = whole(leading(rest), &rest[leading(rest).len()..])?;
            (Some(value), rest)
        }
        _ => (None, rest),
    };
    let (decimals, rest) = match rest {
        [b'.' | b',', rest @ ..] => rest.split_at(leading(rest).len()),
        _ => (&b""[..], rest),
    };
    let fraction = decimal(&[b"0.", decimals].concat())?;
    // Spreadsheets show minutes and seconds alone: 00:00.005.
    let seconds = match third {
        Some(third) => 3600 * first + 60 * second + third,
        None if decimals.is_empty() => 3600 * first + 60 * second,
        None => 60 * first + second,
    };
    let seconds = seconds + half_day(first, rest.trim_ascii())?;
    Some(Instant { date, units: seconds * UNITS + fraction })
}

/// Seconds that `AM`, `PM`, or a time zone, behind a time of day add to it.
fn half_day(hour: i128, rest: &[u8]) -> Option<i128> {
    let zone = |rest: &[u8]| {
        let digits = |b: &u8| b.is_ascii_digit() || *b == b':';
        matches!(rest, [b'+' | b'-', rest @ ..] if rest.len() <= 5 && rest.iter().all(digits))
    };
    match rest.to_ascii_uppercase().as_slice() {
        b"" | b"Z" | b"UTC" => Some(0),
        b"AM" => Some(if hour == 12 { -12 * 3600 } else { 0 }),
        b"PM" => Some(if hour == 12 { 0 } else { 12 * 3600 }),
        rest => zone(rest).then_some(0),
    }
}

/// The digits at the start.
fn leading(bytes: &[u8]) -> &[u8] {
    &bytes[..bytes.iter().take_while(|b| b.is_ascii_digit()).count()]
}

/// One or two digits as a number, and what follows.
fn whole<'a>(digits: &[u8], rest: &'a [u8]) -> Option<(i128, &'a [u8])> {
    let value: i128 = core::str::from_utf8(digits).ok()?.parse().ok()?;
    (digits.len() <= 2).then_some((value, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(words: &[&str]) -> Vec<f64> {
        since_first(words.iter().map(|word| Instant::of(word.as_bytes()).expect(word)))
    }

    /// Doubles have no digit left for what these differ by.
    #[test]
    fn differences_are_those_of_the_decimals() {
        assert_eq!(
            after(&["1700000000.000", "1700000000.005", "1700000010.01"]),
            [0.0, 0.005, 10.01]
        );
        assert_eq!(after(&["1.7e9", "1.700000000005E+09"]), [0.0, 0.005]);
        assert_eq!(after(&["1700000000000000000", "1700000000005000000"]), [0.0, 5e6]);
        assert_eq!(after(&["-0,005", "0", "+0.01"]), [0.0, 0.005, 0.015]);
    }

    #[test]
    fn times_of_day() {
        for (from, to, expected) in [
            ("2025-11-26 10:00:00.000", "2025-11-26 10:00:00.005", 0.005),
            ("2025-11-26T10:00:59.995Z", "2025-11-26T10:01:00Z", 0.005),
            ("26.11.2025 23:59:59,99", "27.11.2025 00:00:00,00", 0.01),
            ("11/26/2025 11:59:59.99 AM", "11/26/2025 12:00:00.00 PM", 0.01),
            ("2025/11/26 10:00:00.01+03:00", "2025/11/26 10:00:00.03+03:00", 0.02),
            ("10:00:00", "10:00:01", 1.0),
            ("00:00.005", "01:00.010", 60.005),
        ] {
            assert_eq!(after(&[from, to]), [0.0, expected], "{from}");
        }
        for word in ["", ":", "x10:00:00", "10:00:00 x", "1:2:3:4", "10:000", "-1:00", "nan", "1e"]
        {
            assert_eq!(Instant::of(word.as_bytes()), None, "{word}");
        }
        assert!(
            is_date(b"2025-11-26")
                && !is_date(b"-0.5")
                && !is_date(b"-0.0001709")
                && !is_date(b"1.5e-3")
        );
    }

    #[test]
    fn units_of_epochs() {
        assert_eq!(epoch_unit(1.7e12), Some((1e-3, "milliseconds")));
        assert_eq!(epoch_unit(1.7e18), Some((1e-9, "nanoseconds")));
        assert_eq!([epoch_unit(1.7e9), epoch_unit(5.0)], [None, None]);
    }
}
