//! Units of records, as files and people write them.

use slipstick_dynamics::units::STANDARD_GRAVITY_M_PER_S2;

pub use slipstick_dynamics::motion::Quantity;

/// Units of acceleration, velocity or displacement, perhaps times a number, what one count of a
/// digitiser is; or counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    symbol: &'static str,
    quantity: Quantity,
    si: f64,
    times: f64,
}

/// Symbol, quantity, factor to SI, and the spellings of it after [`plain`].
const TABLE: [(&str, Quantity, f64, &[&str]); 28] = {
    use Quantity::{Acceleration, Counts, Displacement, Velocity};
    const G: f64 = STANDARD_GRAVITY_M_PER_S2;
    const INCH: f64 = 0.0254;
    const FOOT: f64 = 0.3048;
    [
        ("g", Acceleration, G, &["g", "gs", "g's"]),
        ("g/10", Acceleration, G / 10.0, &["g/10"]),
        ("%g", Acceleration, G / 100.0, &["%g", "pctg", "percentg", "%ofg", "g%"]),
        ("mg", Acceleration, G / 1e3, &["mg", "milli-g", "millig"]),
        ("µg", Acceleration, G / 1e6, &["µg", "ug", "microg"]),
        ("m/s²", Acceleration, 1.0, &["m/s2", "m/s/s", "ms-2", "m/s-2"]),
        ("cm/s²", Acceleration, 0.01, &["cm/s2", "cm/s/s", "gal", "gals", "cms-2", "cms/s/s"]),
        ("mm/s²", Acceleration, 0.001, &["mm/s2", "mm/s/s", "mms-2"]),
        ("µm/s²", Acceleration, 1e-6, &["µm/s2", "µm/s/s", "µms-2", "um/s2", "um/s/s", "ums-2"]),
        ("nm/s²", Acceleration, 1e-9, &["nm/s2", "nm/s/s", "nms-2"]),
        ("mGal", Acceleration, 1e-5, &["mgal", "mgals", "milligal"]),
        ("µGal", Acceleration, 1e-8, &["µgal", "ugal", "microgal"]),
        ("in/s²", Acceleration, INCH, &["in/s2", "in/s/s"]),
        ("ft/s²", Acceleration, FOOT, &["ft/s2", "ft/s/s"]),
        ("m/s", Velocity, 1.0, &["m/s", "ms-1"]),
        ("cm/s", Velocity, 0.01, &["cm/s", "cms/s", "cms-1"]),
        ("mm/s", Velocity, 0.001, &["mm/s", "mms-1"]),
        ("µm/s", Velocity, 1e-6, &["µm/s", "um/s", "µms-1", "ums-1"]),
        ("nm/s", Velocity, 1e-9, &["nm/s"]),
        ("in/s", Velocity, INCH, &["in/s"]),
        ("m", Displacement, 1.0, &["m"]),
        ("cm", Displacement, 0.01, &["cm", "cms"]),
        ("mm", Displacement, 0.001, &["mm"]),
        ("µm", Displacement, 1e-6, &["µm", "um"]),
        ("nm", Displacement, 1e-9, &["nm"]),
        ("in", Displacement, INCH, &["in"]),
        ("ft", Displacement, FOOT, &["ft"]),
        ("counts", Counts, 1.0, &["counts", "count", "cts"]),
    ]
};

impl Units {
    /// m/s².
    #[must_use]
    pub fn m_per_s2() -> Self {
        Self { symbol: "m/s²", quantity: Quantity::Acceleration, si: 1.0, times: 1.0 }
    }

    /// The SI unit of a quantity; counts have none but themselves.
    #[must_use]
    pub fn si_of(quantity: Quantity) -> Self {
        let symbol = match quantity {
            Quantity::Acceleration => "m/s²",
            Quantity::Velocity => "m/s",
            Quantity::Displacement => "m",
            Quantity::Counts => "counts",
        };
        Self { symbol, times: 1.0, quantity, si: 1.0 }
    }

    /// The units of a word such as `g`, `cm/s2`, `CM/SEC/SEC`, `gal`; or of a number > 0 and a word,
    /// `4.674e-6 m/s2`: the value of one count.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        if let Some(units) = Self::named(text) {
            return Some(units);
        }
        let (number, word) = text.trim().split_once(char::is_whitespace)?;
        let times = super::text::number(number.as_bytes()).filter(|times| *times > 0.0)?;
        let units = Self::named(word).filter(|units| units.quantity != Quantity::Counts)?;
        let si = times * units.si;
        si.is_normal().then_some(Self { times, si, ..units })
    }

    fn named(word: &str) -> Option<Self> {
        let plain = plain(word);
        TABLE
            .iter()
            .find(|(.., spellings)| spellings.contains(&plain.as_str()))
            .map(|&(symbol, quantity, si, _)| Self { symbol, quantity, si, times: 1.0 })
    }

    /// Their symbol, without the value of one count.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        self.symbol
    }

    /// What they measure.
    #[must_use]
    pub fn quantity(self) -> Quantity {
        self.quantity
    }

    /// One of them in SI: m/s², m/s or m; 1 for counts.
    #[must_use]
    pub fn si(self) -> f64 {
        self.si
    }
}

impl core::fmt::Display for Units {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        if self.times == 1.0 {
            return f.write_str(self.symbol);
        }
        // 4.674e-6 rather than 0.000004674.
        if !(1e-3..1e6).contains(&self.times) {
            write!(f, "{:e} {}", self.times, self.symbol)
        } else {
            write!(f, "{} {}", self.times, self.symbol)
        }
    }
}

/// Seconds in a unit of time as a column's header names it.
pub(super) fn seconds(word: &str) -> Option<f64> {
    let word = word.trim().trim_end_matches('.').to_lowercase();
    Some(match word.as_str() {
        "s" | "sec" | "secs" | "second" | "seconds" | "sn" | "saniye" | "sek" | "sekunde"
        | "sekunden" | "seg" | "segundo" | "segundos" => 1.0,
        "ms" | "msec" | "msecs" | "msek" | "millis" | "millisecond" | "milliseconds" => 1e-3,
        "us" | "µs" | "μs" | "usec" | "microsecond" | "microseconds" => 1e-6,
        "ns" | "nsec" | "nanosecond" | "nanoseconds" => 1e-9,
        "min" | "minute" | "minutes" => 60.0,
        _ => return None,
    })
}

/// A word in small letters without blanks, powers and seconds spelt one way. `\u{FFFD}` is what an
/// older encoding's ² becomes.
fn plain(word: &str) -> String {
    word.trim()
        .to_lowercase()
        .replace([' ', '^', '*', '.', '·', '⋅', '•'], "")
        .replace(['²', '\u{FFFD}'], "2")
        .replace('¹', "1")
        .replace(['⁻', '−', '–'], "-")
        // The sign of micro has two places in Unicode.
        .replace('μ', "µ")
        .replace("sec", "s")
        .replace("sn", "s")
        .replace("_per_", "/")
        .replace('_', "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_by_every_spelling() {
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
            ("%g", "%g", 0.098_066_5),
            ("m_s2", "m/s²", 1.0),
            ("cm/sn²", "cm/s²", 0.01),
            ("m.s-2", "m/s²", 1.0),
            ("m·s⁻²", "m/s²", 1.0),
            ("cm.s^-2", "cm/s²", 0.01),
            ("mGal", "mGal", 1e-5),
            ("µm/s²", "µm/s²", 1e-6),
            ("μm/s/s", "µm/s²", 1e-6),
            ("um/s^2", "µm/s²", 1e-6),
            ("m.s-1", "m/s", 1.0),
        ] {
            let units = Units::parse(word).unwrap_or_else(|| panic!("{word}"));
            assert_eq!((units.symbol, units.si), (symbol, si), "{word}");
        }
        for word in [
            "",
            "kg",
            "H",
            "m/s3",
            "sec",
            "n",
            "2",
            "0 g",
            "-1 g",
            "nan g",
            "1e-320 mm",
            "2g",
            "2 counts",
        ] {
            assert_eq!(Units::parse(word), None, "{word}");
        }
        let count = Units::parse(" 1.67e-6  m / s2").unwrap();
        assert_eq!((count.si, count.to_string().as_str()), (1.67e-6, "1.67e-6 m/s²"));
        let count = Units::parse("0.5 mm/s^2").unwrap();
        assert_eq!((count.si, count.to_string().as_str()), (0.0005, "0.5 mm/s²"));
        assert_ne!(Some(count), Units::parse("mm/s^2"));
        assert_eq!(
            ["s", "sec", "sn", "seconds", "ms", "m"].map(seconds),
            [Some(1.0), Some(1.0), Some(1.0), Some(1.0), Some(0.001), None]
        );
    }
}
