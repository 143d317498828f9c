//! The units in which results are shown; inside, everything is SI.

use slipstick::units::{Dimension, STANDARD_GRAVITY_M_PER_S2};

/// A system of units to show results in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DisplayUnits {
    /// SI, in the multiple that reads well: mm or m, N, kN or MN, m/s².
    #[default]
    Si,
    /// As SI, accelerations in g.
    SiG,
    /// mm, kN, t, and m/s² for accelerations.
    KnMm,
    /// in, kip, lb, and g for accelerations.
    Us,
}

/// A kind of quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// SI: m.
    Length,
    /// SI: m/s.
    Velocity,
    /// SI: m/s².
    Acceleration,
    /// SI: N.
    Force,
    /// SI: kg.
    Mass,
    /// SI: N/m.
    Stiffness,
    /// SI: N s/m.
    Damping,
    /// SI: J.
    Energy,
    /// s in every system.
    Time,
    /// A ratio: no unit.
    Ratio,
}

impl From<Option<Dimension>> for Quantity {
    /// Of a dimension that results have; of another, and of none, a ratio.
    fn from(dimension: Option<Dimension>) -> Self {
        match dimension {
            Some(Dimension::Length) => Self::Length,
            Some(Dimension::Velocity) => Self::Velocity,
            Some(Dimension::Acceleration) => Self::Acceleration,
            Some(Dimension::Force) => Self::Force,
            Some(Dimension::Mass) => Self::Mass,
            Some(Dimension::Stiffness) => Self::Stiffness,
            Some(Dimension::Damper) => Self::Damping,
            Some(Dimension::Time) => Self::Time,
            _ => Self::Ratio,
        }
    }
}

/// A unit: what one of it is in SI, and its symbol (empty for a ratio).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The SI value of one unit.
    pub in_si: f64,
    /// Its symbol, as in print.
    pub symbol: &'static str,
}

impl Unit {
    /// A second.
    pub const SECOND: Self = Self { in_si: 1.0, symbol: "s" };
    /// What a ratio is in.
    pub const NONE: Self = Self { in_si: 1.0, symbol: "" };

    /// A value given in SI in this unit.
    #[must_use]
    pub fn of(&self, si: f64) -> f64 {
        si / self.in_si
    }

    /// `quantity, unit`, or the quantity alone where there is no unit.
    #[must_use]
    pub fn label(&self, quantity: &str) -> String {
        if self.symbol.is_empty() {
            quantity.to_owned()
        } else {
            format!("{quantity} ({})", self.symbol)
        }
    }
}

/// An inch in m, exact.
pub const INCH_M: f64 = 0.0254;
/// A pound of mass in kg, exact.
pub const POUND_KG: f64 = 0.453_592_37;
/// A kip (1000 lbf) in N, exact.
pub const KIP_N: f64 = 1000.0 * POUND_KG * STANDARD_GRAVITY_M_PER_S2;

impl DisplayUnits {
    /// The systems with their names, and what they are in.
    pub const NAMES: [(&str, Self, &str); 4] = [
        ("si", Self::Si, "m, m/s, m/s², N"),
        ("si-g", Self::SiG, "As si, accelerations in g"),
        ("kN-mm", Self::KnMm, "kN and mm"),
        ("us", Self::Us, "kip and in"),
    ];

    /// The system of a name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        Self::NAMES.into_iter().find(|(known, ..)| *known == name).map(|(_, system, _)| system)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES
            .into_iter()
            .find(|(_, system, _)| *system == self)
            .map_or("si", |(name, ..)| name)
    }

    /// The unit for values of a quantity up to `largest_si` in size.
    ///
    /// Only SI chooses by size; the other systems have one unit a quantity.
    #[must_use]
    pub fn unit(self, quantity: Quantity, largest_si: f64) -> Unit {
        let (in_si, symbol) = match self {
            Self::Si => si(quantity, largest_si.abs()),
            Self::SiG if quantity == Quantity::Acceleration => (STANDARD_GRAVITY_M_PER_S2, "g"),
            Self::SiG => si(quantity, largest_si.abs()),
            Self::KnMm => kn_mm(quantity),
            Self::Us => us(quantity),
        };
        Unit { in_si, symbol }
    }

    /// A sentence with its quantities in these units: `a gap of 150 mm` becomes `a gap of 5.906 in`.
    ///
    /// A quantity is a number, a blank and one of the units that messages use.
    #[must_use]
    pub fn sentence(self, text: &str) -> String {
        let mut words: Vec<String> = text.split(' ').map(str::to_owned).collect();
        for i in 1..words.len() {
            let (unit, after) = split_end(&words[i]);
            let Some((_, quantity, in_si)) = MESSAGE_UNITS.iter().find(|(name, ..)| *name == unit)
            else {
                continue;
            };
            let Ok(value) = words[i - 1].replace('−', "-").parse::<f64>() else { continue };
            let shown = self.unit(*quantity, value * in_si);
            if self == Self::Si || shown.symbol == unit {
                continue;
            }
            let (symbol, after) = (shown.symbol, after.to_owned());
            words[i - 1] = crate::number::rounded(shown.of(value * in_si), 4);
            words[i] = format!("{symbol}{after}");
        }
        words.join(" ")
    }
}

/// Units in messages, with their quantity and SI value.
const MESSAGE_UNITS: [(&str, Quantity, f64); 9] = [
    ("mm", Quantity::Length, 1e-3),
    ("m", Quantity::Length, 1.0),
    ("m/s", Quantity::Velocity, 1.0),
    ("mm/s", Quantity::Velocity, 1e-3),
    ("m/s²", Quantity::Acceleration, 1.0),
    ("m/s2", Quantity::Acceleration, 1.0),
    ("N", Quantity::Force, 1.0),
    ("kN", Quantity::Force, 1e3),
    ("N/m", Quantity::Stiffness, 1.0),
];

/// A word and the punctuation at its end.
fn split_end(word: &str) -> (&str, &str) {
    let end = word.trim_end_matches([',', ';', ':', '.', ')']).len();
    word.split_at(end)
}

fn si(quantity: Quantity, largest: f64) -> (f64, &'static str) {
    // 0 has no size: it is shown in the smallest unit, as the values near it would be.
    match quantity {
        Quantity::Length => pick(largest, [(1e-3, "mm"), (1.0, "m"), (1e3, "km")], 1.0),
        Quantity::Velocity => pick(largest, [(1e-3, "mm/s"), (1.0, "m/s"), (1e3, "km/s")], 0.1),
        Quantity::Acceleration => (1.0, "m/s²"),
        Quantity::Force => pick(largest, [(1.0, "N"), (1e3, "kN"), (1e6, "MN")], 1.0),
        Quantity::Mass => pick(largest, [(1.0, "kg"), (1e3, "t"), (1e6, "kt")], 10.0),
        Quantity::Stiffness => pick(largest, [(1.0, "N/m"), (1e3, "kN/m"), (1e6, "MN/m")], 1.0),
        Quantity::Damping => pick(largest, [(1.0, "N s/m"), (1e3, "kN s/m"), (1e6, "MN s/m")], 1.0),
        Quantity::Energy => pick(largest, [(1.0, "J"), (1e3, "kJ"), (1e6, "MJ")], 1.0),
        Quantity::Time => (1.0, "s"),
        Quantity::Ratio => (1.0, ""),
    }
}

/// The largest of three units of which the value makes at least `least`.
fn pick(value: f64, units: [(f64, &'static str); 3], least: f64) -> (f64, &'static str) {
    let [small, middle, large] = units;
    if value >= 10.0 * least * large.0 {
        large
    } else if value >= least * middle.0 {
        middle
    } else {
        small
    }
}

fn kn_mm(quantity: Quantity) -> (f64, &'static str) {
    match quantity {
        Quantity::Length => (1e-3, "mm"),
        Quantity::Velocity => (1e-3, "mm/s"),
        Quantity::Acceleration => (1.0, "m/s²"),
        Quantity::Force => (1e3, "kN"),
        Quantity::Mass => (1e3, "t"),
        Quantity::Stiffness => (1e6, "kN/mm"),
        Quantity::Damping => (1e6, "kN s/mm"),
        Quantity::Energy => (1.0, "kN mm"),
        Quantity::Time => (1.0, "s"),
        Quantity::Ratio => (1.0, ""),
    }
}

fn us(quantity: Quantity) -> (f64, &'static str) {
    match quantity {
        Quantity::Length => (INCH_M, "in"),
        Quantity::Velocity => (INCH_M, "in/s"),
        Quantity::Acceleration => (STANDARD_GRAVITY_M_PER_S2, "g"),
        Quantity::Force => (KIP_N, "kip"),
        Quantity::Mass => (POUND_KG, "lb"),
        Quantity::Stiffness => (KIP_N / INCH_M, "kip/in"),
        Quantity::Damping => (KIP_N / INCH_M, "kip s/in"),
        Quantity::Energy => (KIP_N * INCH_M, "kip in"),
        Quantity::Time => (1.0, "s"),
        Quantity::Ratio => (1.0, ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_the_three_systems() {
        let kip = DisplayUnits::Us.unit(Quantity::Force, 0.0);
        assert_eq!(kip.symbol, "kip");
        assert!((kip.in_si - 4_448.221_615_260_5).abs() < 1e-9);
        let per_inch = DisplayUnits::Us.unit(Quantity::Stiffness, 0.0);
        assert!((per_inch.of(175_126.835_246_476) - 1.0).abs() < 1e-12);
        let g = DisplayUnits::Us.unit(Quantity::Acceleration, 3.0);
        assert_eq!((g.of(9.80665), g.symbol), (1.0, "g"));
        assert_eq!(DisplayUnits::KnMm.unit(Quantity::Stiffness, 0.0).of(143e3), 0.143);
    }

    #[test]
    fn sentences_take_the_units_of_the_display() {
        let text = "past its gap of 150 mm: peak 165.1 mm, 1.101 of the gap; -0.98 m/s², at 3 s";
        assert_eq!(
            DisplayUnits::Us.sentence(text),
            "past its gap of 5.906 in: peak 6.5 in, 1.101 of the gap; -0.09993 g, at 3 s"
        );
        assert_eq!(DisplayUnits::SiG.sentence("0.98 m/s² and 2 mm"), "0.09993 g and 2 mm");
        assert_eq!(DisplayUnits::Si.sentence(text), text);
    }

    #[test]
    fn si_may_show_accelerations_in_g() {
        let g = DisplayUnits::SiG.unit(Quantity::Acceleration, 3.0);
        assert_eq!((g.of(9.80665), g.symbol), (1.0, "g"));
        assert_eq!(DisplayUnits::SiG.unit(Quantity::Length, 0.15).symbol, "mm");
    }

    #[test]
    fn si_multiples_follow_the_size() {
        let symbol = |quantity, size| DisplayUnits::Si.unit(quantity, size).symbol;
        assert_eq!(symbol(Quantity::Length, 0.15), "mm");
        assert_eq!(symbol(Quantity::Length, -1.5), "m");
        assert_eq!(symbol(Quantity::Length, 0.0), "mm");
        assert_eq!(symbol(Quantity::Velocity, 0.02), "mm/s");
        assert_eq!(symbol(Quantity::Velocity, 0.2), "m/s");
        assert_eq!(symbol(Quantity::Force, 63.0), "N");
        assert_eq!(symbol(Quantity::Force, 6.3e4), "kN");
        assert_eq!(symbol(Quantity::Force, 6.3e6), "kN");
        assert_eq!(symbol(Quantity::Mass, 325.0), "kg");
        assert_eq!(symbol(Quantity::Mass, 325e3), "t");
        assert_eq!(symbol(Quantity::Stiffness, 143e3), "kN/m");
    }
}
