//! Numbers as people read them: few significant digits, a point, a real minus sign.

/// A number rounded to `digits` significant digits (at least 1), in plain characters.
///
/// Fixed notation from 0.0001 to 999 999, with trailing zeros kept, so that columns show equal
/// precision; `1.234e-7` beyond. Exact zeros (of either sign) are `0`; what is not finite is `n/a`.
///
/// ```
/// use slipstick_report::number::significant;
/// assert_eq!(significant(0.0123456, 4), "0.01235");
/// assert_eq!(significant(-1.2e-9, 4), "-1.200e-9");
/// ```
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "n/a".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.clamp(1, 17);
    let scientific = format!("{value:.*e}", digits - 1);
    match exponent_of(&scientific) {
        exponent @ -4..6 => {
            let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => scientific,
    }
}

/// The decimal exponent in the text that `{:e}` writes.
fn exponent_of(scientific: &str) -> i32 {
    scientific.rsplit('e').next().and_then(|text| text.parse().ok()).unwrap_or(0)
}

/// Decimals with which a value has `digits` significant digits, 0 to 9.
#[must_use]
pub fn decimals(value: f64, digits: usize) -> usize {
    if !(value.is_finite() && value != 0.0) {
        return digits.saturating_sub(1).min(9);
    }
    (digits as i32 - 1 - exponent_of(&format!("{value:e}"))).clamp(0, 9) as usize
}

/// A number that a person gave, to 6 significant digits, without trailing zeros.
#[must_use]
pub fn compact(value: f64) -> String {
    rounded(value, 6)
}

/// [`significant`] without trailing zeros after the point.
#[must_use]
pub fn rounded(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (mantissa, exponent) = match text.find('e') {
        Some(at) => text.split_at(at),
        None => (text.as_str(), ""),
    };
    if !mantissa.contains('.') {
        return text;
    }
    format!("{}{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
}

/// A number with only the decimals it needs, at most `decimals`: coordinates in path data.
#[must_use]
pub fn trimmed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.to_owned()
}

/// A number with so many decimals; what rounds to zero has no sign.
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|b| matches!(b, b'0' | b'.')) => size.to_owned(),
        _ => text,
    }
}

/// Plain characters of a number set as in print: a true minus sign, powers of ten as such.
///
/// ```
/// use slipstick_report::number::typeset;
/// assert_eq!(typeset("-1.200e-9"), "−1.200\u{202f}×\u{202f}10⁻⁹");
/// ```
#[must_use]
pub fn typeset(plain: &str) -> String {
    match plain.split_once('e') {
        Some((mantissa, exponent)) if exponent.parse::<i32>().is_ok() => {
            let power: String = exponent.chars().map(superscript).collect();
            format!("{}\u{202f}×\u{202f}10{power}", mantissa.replace('-', "−"))
        }
        _ => plain.replace('-', "−"),
    }
}

/// A sentence with the numbers in it set as in print. What stands in quotes is to be typed, and stays.
///
/// ```
/// use slipstick_report::number::typeset_sentence;
/// assert_eq!(typeset_sentence("r-1: at -0.2, not 0"), "r-1: at −0.2, not 0");
/// assert_eq!(typeset_sentence("-6 to 5 (error, 8e-16)."), "−6 to 5 (error, 8\u{202f}×\u{202f}10⁻¹⁶).");
/// assert_eq!(typeset_sentence("\"A1 - 2e-3 m\" or -1"), "\"A1 - 2e-3 m\" or −1");
/// ```
#[must_use]
pub fn typeset_sentence(plain: &str) -> String {
    let mut is_quoted = false;
    let set = |word: &str| {
        let quotes = word.matches('"').count();
        let stays = is_quoted || quotes > 0;
        is_quoted ^= quotes % 2 == 1;
        let from = word.trim_start_matches('(');
        let number = from.trim_end_matches([',', ';', ':', ')', '.', '°', '%']);
        match !stays && number.parse::<f64>().is_ok_and(f64::is_finite) {
            true => {
                let (before, after) = (&word[..word.len() - from.len()], &from[number.len()..]);
                format!("{before}{}{after}", typeset(number))
            }
            false => word.to_owned(),
        }
    };
    plain.split(' ').map(set).collect::<Vec<_>>().join(" ")
}

/// A cell of a table as in print: a number by [`typeset`], words as they are.
#[must_use]
pub fn typeset_cell(cell: &str) -> String {
    if cell.parse::<f64>().is_ok() { typeset(cell) } else { cell.to_owned() }
}

/// [`significant`] and [`typeset`] in one.
#[must_use]
pub fn printed(value: f64, digits: usize) -> String {
    typeset(&significant(value, digits))
}

fn superscript(character: char) -> char {
    match character {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' | '4'..='9' => {
            char::from_u32(0x2070 + character as u32 - '0' as u32).unwrap_or(character)
        }
        other => other,
    }
}

/// A count with thin spaces between groups of three digits from 10 000 up.
#[must_use]
pub fn count(value: u64) -> String {
    let plain = value.to_string();
    if plain.len() < 5 {
        return plain;
    }
    let mut grouped = String::new();
    for (i, digit) in plain.chars().enumerate() {
        if i > 0 && (plain.len() - i).is_multiple_of(3) {
            grouped.push('\u{202f}');
        }
        grouped.push(digit);
    }
    grouped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_round_and_keep_their_zeros() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1.000"),
            (9.99996, "10.00"),
            (150.0, "150.0"),
            (123_456.0, "123456"),
            (1_234_567.0, "1.235e6"),
            (0.000_123_456, "0.0001235"),
            (0.000_012_34, "1.234e-5"),
            (-0.5, "-0.5000"),
            (f64::NAN, "n/a"),
            (f64::INFINITY, "n/a"),
        ] {
            assert_eq!(significant(value, 4), expected);
        }
    }

    #[test]
    fn coordinates_lose_their_trailing_zeros() {
        assert_eq!(trimmed(12.50, 2), "12.5");
        assert_eq!(trimmed(100.0, 2), "100");
        assert_eq!(trimmed(-0.001, 2), "0");
        assert_eq!(trimmed(100.0, 0), "100");
    }

    #[test]
    fn given_numbers_come_back_as_given() {
        for (value, expected) in [
            (0.02, "0.02"),
            (325.0, "325"),
            (100.0, "100"),
            (2.5e-7, "2.5e-7"),
            (9.80665, "9.80665"),
        ] {
            assert_eq!(compact(value), expected);
        }
        assert_eq!(compact(143e3), "143000");
    }

    #[test]
    fn print_has_true_minus_and_superscripts() {
        assert_eq!(printed(-0.25, 2), "−0.25");
        assert_eq!(printed(3.0e-14, 2), "3.0\u{202f}×\u{202f}10⁻¹⁴");
        assert_eq!(typeset("gate"), "gate");
    }

    #[test]
    fn counts_are_grouped() {
        assert_eq!(count(2800), "2800");
        assert_eq!(count(1_234_567), "1\u{202f}234\u{202f}567");
    }
}
