//! Decimal numbers, correctly rounded and fast: records hold millions of them.

/// Powers of ten that are exact as `f64`.
const EXACT: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The finite number that a word is, to the nearest `f64`: sign, digits with or without a point,
/// and an exponent after E or D; blanks, `inf` and `nan` are none.
///
/// A number of at most 19 digits that is an integer below 2⁵³ times or over an exact power of ten
/// is one correctly rounded operation on exact operands (Clinger 1990, "How to read floating point
/// numbers accurately"); any other is left to the standard library.
pub(super) fn parse(word: &[u8]) -> Option<f64> {
    let (negative, digits) = match word.first()? {
        b'-' => (true, &word[1..]),
        b'+' => (false, &word[1..]),
        _ => (false, word),
    };
    let (mut mantissa, mut count, mut after_point, mut at) = (0_u64, 0, 0_i32, 0);
    let mut point = false;
    while let Some(&byte) = digits.get(at) {
        let digit = byte.wrapping_sub(b'0');
        if digit <= 9 {
            // Wraps beyond 19 digits, which are not used then.
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
            count += 1;
            after_point += i32::from(point);
        } else if byte == b'.' && !point {
            point = true;
        } else {
            break;
        }
        at += 1;
    }
    if count == 0 {
        return None;
    }
    let exponent = exponent(&digits[at..])?;
    // Leading zeros count as digits here, which costs speed for odd numbers only.
    if count <= 19 && mantissa <= 1 << 53 && exponent.abs() < 1000 {
        let power = exponent - after_point;
        if power.unsigned_abs() <= 22 {
            let (value, ten) = (mantissa as f64, EXACT[power.unsigned_abs() as usize]);
            let value = if power < 0 { value / ten } else { value * ten };
            return Some(if negative { -value } else { value });
        }
    }
    slowly(word)
}

/// The exponent of the rest of a word; 0 where there is no rest, huge ones cut.
fn exponent(rest: &[u8]) -> Option<i32> {
    let Some((letter, rest)) = rest.split_first() else { return Some(0) };
    if !matches!(letter, b'e' | b'E' | b'd' | b'D') {
        return None;
    }
    let (negative, digits) = match rest.first()? {
        b'-' => (true, &rest[1..]),
        b'+' => (false, &rest[1..]),
        _ => (false, rest),
    };
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let value = digits.iter().fold(0, |e: i32, d| (e * 10 + i32::from(d - b'0')).min(99_999));
    Some(if negative { -value } else { value })
}

/// A number whose form was checked, by the standard library; `None` where it is not finite.
fn slowly(word: &[u8]) -> Option<f64> {
    let value = if word.iter().any(|b| matches!(b, b'd' | b'D')) {
        let e = |b: &u8| if matches!(b, b'd' | b'D') { 'e' } else { char::from(*b) };
        word.iter().map(e).collect::<String>().parse::<f64>()
    } else {
        core::str::from_utf8(word).ok()?.parse::<f64>()
    };
    value.ok().filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_read_in_every_form() {
        for word in [
            "0",
            "-0",
            "1",
            "-.8075668E-03",
            "+0.220470",
            "1.4275799e-003",
            "5.",
            "-5.e2",
            ".5",
            "123456789012345678901234567890",
            "1e22",
            "1e23",
            "9007199254740993",
            "1e-400",
            "0.000000000000000000000000123",
            "8.5e-324",
            "1.7976931348623157e308",
            "1e-9999999",
        ] {
            let expected: f64 = word.parse().unwrap();
            assert_eq!(
                parse(word.as_bytes()).map(f64::to_bits),
                Some(expected.to_bits()),
                "{word}"
            );
        }
        assert_eq!(parse(b"1.5D-03"), Some(0.0015));
        assert_eq!(parse(b"123456789.123456789123456789d+2"), Some(12_345_678_912.345_679));
        for word in [
            "", "-", "+", ".", "e5", "1e", "1e+", "1.2.3", "1-2", "0.1-0.2", "nan", "inf", "1e999",
            " 1", "1 ", "0x10", "1,5", "1_000", "--1", "1f2", "é",
        ] {
            assert_eq!(parse(word.as_bytes()), None, "{word}");
        }
    }

    proptest! {
        /// The standard library rounds correctly; so must we, to the last bit.
        #[test]
        fn prop_nearest_number(
            digits in 0_u64..20_000_000_000_000_000, cut in 0_u32..17, point in 0_usize..20,
            power in -40_i32..40, form in 0_u8..4,
        ) {
            let mut text = (digits / 10_u64.pow(cut)).to_string();
            text.insert(point.min(text.len()), '.');
            let text = match form {
                0 => text,
                1 => format!("-{text}"),
                2 => format!("{text}E{power:+03}"),
                _ => format!("+{text}e{power}"),
            };
            let expected: f64 = text.parse().unwrap();
            prop_assert_eq!(parse(text.as_bytes()).map(f64::to_bits), Some(expected.to_bits()));
        }

        /// Any finite number survives being written.
        #[test]
        fn prop_written_numbers_read_back(value in any::<f64>().prop_filter("finite", |v| v.is_finite())) {
            prop_assert_eq!(parse(format!("{value:e}").as_bytes()), Some(value));
            prop_assert_eq!(parse(format!("{value:.6}").as_bytes()), format!("{value:.6}").parse().ok());
        }
    }
}
