//! Units of records, as files and people write them.

use crate::units::STANDARD_GRAVITY_M_PER_S2;

pub use crate::motion::Quantity;

/// Units of acceleration, velocity or displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    symbol: &'static str,
    quantity: Quantity,
    si: f64,
}

/// Symbol, quantity, factor to SI, and the spellings of it after [`plain`].
const TABLE: [(&str, Quantity, f64, &[&str]); 15] = {
    use Quantity::{Acceleration, Displacement, Velocity};
    const G: f64 = STANDARD_GRAVITY_M_PER_S2;
    const INCH: f64 = 0.0254;
    const FOOT: f64 = 0.3048;
    [
        ("g", Acceleration, G, &["g", "gs", "g's"]),
        ("m/s²", Acceleration, 1.0, &["m/s2", "m/s/s", "ms-2"]),
        ("cm/s²", Acceleration, 0.01, &["cm/s2", "cm/s/s", "gal", "gals", "cms-2"]),
        ("mm/s²", Acceleration, 0.001, &["mm/s2", "mm/s/s", "mms-2"]),
        ("in/s²", Acceleration, INCH, &["in/s2", "in/s/s"]),
        ("ft/s²", Acceleration, FOOT, &["ft/s2", "ft/s/s"]),
        ("m/s", Velocity, 1.0, &["m/s"]),
        ("cm/s", Velocity, 0.01, &["cm/s"]),
        ("mm/s", Velocity, 0.001, &["mm/s"]),
        ("in/s", Velocity, INCH, &["in/s"]),
        ("m", Displacement, 1.0, &["m"]),
        ("cm", Displacement, 0.01, &["cm"]),
        ("mm", Displacement, 0.001, &["mm"]),
        ("in", Displacement, INCH, &["in"]),
        ("ft", Displacement, FOOT, &["ft"]),
    ]
};

impl Units {
    /// The units of a word such as `g`, `cm/s2`, `CM/SEC/SEC`, `gal`.
    #[must_use]
    pub fn parse(word: &str) -> Option<Self> {
        let plain = plain(word);
        TABLE
            .iter()
            .find(|(.., spellings)| spellings.contains(&plain.as_str()))
            .map(|&(symbol, quantity, si, _)| Self { symbol, quantity, si })
    }

    /// What they measure.
    #[must_use]
    pub fn quantity(self) -> Quantity {
        self.quantity
    }

    /// One of them in SI: m/s², m/s or m.
    #[must_use]
    pub fn si(self) -> f64 {
        self.si
    }
}

impl core::fmt::Display for Units {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.symbol)
    }
}

/// Seconds in a unit of time as a column's header names it.
pub(super) fn seconds(word: &str) -> Option<f64> {
    match plain(word).as_str() {
        "s" | "seconds" => Some(1.0),
        "ms" => Some(0.001),
        "min" => Some(60.0),
        _ => None,
    }
}

/// A word in small letters without blanks, powers and seconds spelt one way.
fn plain(word: &str) -> String {
    word.trim()
        .to_lowercase()
        .replace([' ', '^', '*'], "")
        .replace('²', "2")
        .replace("sec", "s")
        .replace("_per_", "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_spellings() {
        for (word, symbol, si) in [
            ("g", "g", 9.80665),
            ("G", "g", 9.80665),
            ("g's", "g", 9.80665),
            ("cm/s^2", "cm/s²", 0.01),
            ("CM/SEC/SEC", "cm/s²", 0.01),
            ("cm/sec**2", "cm/s²", 0.01),
            ("gal", "cm/s²", 0.01),
            ("m_per_s2", "m/s²", 1.0),
            ("m/s²", "m/s²", 1.0),
            ("CM/S", "cm/s", 0.01),
            ("CM", "cm", 0.01),
        ] {
            let units = Units::parse(word).unwrap_or_else(|| panic!("{word}"));
            assert_eq!((units.symbol, units.si), (symbol, si), "{word}");
        }
        for word in ["", "kg", "H", "m/s3", "sec", "n"] {
            assert_eq!(Units::parse(word), None, "{word}");
        }
        assert_eq!(
            [seconds("s"), seconds("sec"), seconds("ms"), seconds("m")],
            [Some(1.0), Some(1.0), Some(0.001), None]
        );
    }
}
