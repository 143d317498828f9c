//! Units at the door: SI inside.
//!
//! One table, printed by [`table`], says what a person may write. A quantity is text: a number and a
//! unit, such as `"143 kN/m"`. The table's units differ from SI by a factor, multiplied or divided so
//! that decimal multiples are rounded once: `"5 mm"` is exactly the number nearest to 0.005.

use std::fmt::Write as _;

use crate::error::UnitError;

#[cfg(test)]
mod tests;

/// Standard gravity in m/s²: what "g" means in a record or a scale, and the default of a model.
pub const STANDARD_GRAVITY_M_PER_S2: f64 = 9.80665;

/// Largest size of a number in SI that a model or a motion may have, and the smallest of one that must be
/// > 0: products of some of them are still finite, and far from 0.
pub const LARGEST: f64 = 1e30;
/// See [`LARGEST`].
pub const SMALLEST: f64 = 1e-30;

const POUND_KG: f64 = 0.453_592_37;
const POUND_FORCE_N: f64 = POUND_KG * STANDARD_GRAVITY_M_PER_S2;
const INCH_M: f64 = 0.0254;
const FOOT_M: f64 = 0.3048;

/// What a number measures; each dimension has its own units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Mass, in kg.
    Mass,
    /// Force, in N.
    Force,
    /// Length, in m.
    Length,
    /// Time, in s.
    Time,
    /// Frequency, in Hz.
    Frequency,
    /// Angle, in rad.
    Angle,
    /// Velocity, in m/s.
    Velocity,
    /// Acceleration, in m/s².
    Acceleration,
    /// Stiffness of a spring, in N/m.
    Stiffness,
    /// Constant of a damper, in N s/m.
    Damper,
    /// Rate at which friction follows the sliding speed, in s/m.
    Slowness,
    /// Pressure, in Pa.
    Pressure,
    /// Area, in m².
    Area,
}

impl Dimension {
    /// Every dimension, in the order of the printed table.
    pub const ALL: [Self; 13] = [
        Self::Mass,
        Self::Force,
        Self::Length,
        Self::Time,
        Self::Frequency,
        Self::Angle,
        Self::Velocity,
        Self::Acceleration,
        Self::Stiffness,
        Self::Damper,
        Self::Slowness,
        Self::Pressure,
        Self::Area,
    ];

    /// Its name, such as "length".
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::Force => "force",
            Self::Length => "length",
            Self::Time => "time",
            Self::Frequency => "frequency",
            Self::Angle => "angle",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Stiffness => "stiffness",
            Self::Damper => "damper constant",
            Self::Slowness => "rate by speed",
            Self::Pressure => "pressure",
            Self::Area => "area",
        }
    }

    /// Its name with the indefinite article, such as "an angle".
    #[must_use]
    pub fn with_article(self) -> String {
        let vowel = matches!(self, Self::Angle | Self::Acceleration | Self::Area);
        let article = if vowel { "an" } else { "a" };
        format!("{article} {}", self.name())
    }

    /// A quantity as a person would write it, such as `150 mm`.
    #[must_use]
    pub fn example(self) -> &'static str {
        match self {
            Self::Mass => "325 kg",
            Self::Force => "12 kN",
            Self::Length => "150 mm",
            Self::Time => "0.01 s",
            Self::Frequency => "1.6 Hz",
            Self::Angle => "1 mrad",
            Self::Velocity => "0.2 m/s",
            Self::Acceleration => "0.3 g",
            Self::Stiffness => "143 kN/m",
            Self::Damper => "250 N s/m",
            Self::Slowness => "25 s/m",
            Self::Pressure => "20 MPa",
            Self::Area => "0.04 m2",
        }
    }

    /// Its units, the SI unit first.
    #[must_use]
    pub fn units(self) -> &'static [Unit] {
        match self {
            Self::Mass => &MASS,
            Self::Force => &FORCE,
            Self::Length => &LENGTH,
            Self::Time => &TIME,
            Self::Frequency => &FREQUENCY,
            Self::Angle => &ANGLE,
            Self::Velocity => &VELOCITY,
            Self::Acceleration => &ACCELERATION,
            Self::Stiffness => &STIFFNESS,
            Self::Damper => &DAMPER,
            Self::Slowness => &SLOWNESS,
            Self::Pressure => &PRESSURE,
            Self::Area => &AREA,
        }
    }

    /// The unit in which the library keeps it.
    #[must_use]
    pub fn si_unit(self) -> &'static str {
        self.units()[0].name
    }
}

/// How a unit turns into SI. Decimal fractions divide, because 1/1000 is no binary number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Factor {
    Times(f64),
    Over(f64),
}

/// A unit of measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    name: &'static str,
    factor: Factor,
}

impl Unit {
    const fn times(name: &'static str, factor: f64) -> Self {
        Self { name, factor: Factor::Times(factor) }
    }

    const fn over(name: &'static str, divisor: f64) -> Self {
        Self { name, factor: Factor::Over(divisor) }
    }

    /// How it is written.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// A value in this unit as its dimension's SI unit (Hz for frequencies), rounded once.
    #[must_use]
    pub fn to_si(&self, value: f64) -> f64 {
        match self.factor {
            Factor::Times(factor) => value * factor,
            Factor::Over(divisor) => value / divisor,
        }
    }
}

const MASS: [Unit; 3] =
    [Unit::times("kg", 1.0), Unit::times("t", 1e3), Unit::times("lb", POUND_KG)];
const FORCE: [Unit; 5] = [
    Unit::times("N", 1.0),
    Unit::times("kN", 1e3),
    Unit::times("MN", 1e6),
    Unit::times("lbf", POUND_FORCE_N),
    Unit::times("kip", 1e3 * POUND_FORCE_N),
];
const LENGTH: [Unit; 5] = [
    Unit::times("m", 1.0),
    Unit::over("mm", 1e3),
    Unit::over("cm", 1e2),
    Unit::times("in", INCH_M),
    Unit::times("ft", FOOT_M),
];
const TIME: [Unit; 3] = [Unit::times("s", 1.0), Unit::over("ms", 1e3), Unit::times("min", 60.0)];
const FREQUENCY: [Unit; 2] = [Unit::times("Hz", 1.0), Unit::over("rad/s", core::f64::consts::TAU)];
const ANGLE: [Unit; 3] = [
    Unit::times("rad", 1.0),
    Unit::over("mrad", 1e3),
    Unit::times("deg", core::f64::consts::PI / 180.0),
];
const VELOCITY: [Unit; 5] = [
    Unit::times("m/s", 1.0),
    Unit::over("mm/s", 1e3),
    Unit::over("cm/s", 1e2),
    Unit::times("in/s", INCH_M),
    Unit::times("ft/s", FOOT_M),
];
const ACCELERATION: [Unit; 7] = [
    Unit::times("m/s2", 1.0),
    Unit::over("mm/s2", 1e3),
    Unit::over("cm/s2", 1e2),
    Unit::over("gal", 1e2),
    Unit::times("g", STANDARD_GRAVITY_M_PER_S2),
    Unit::times("in/s2", INCH_M),
    Unit::times("ft/s2", FOOT_M),
];
const STIFFNESS: [Unit; 8] = [
    Unit::times("N/m", 1.0),
    Unit::times("N/mm", 1e3),
    Unit::times("kN/m", 1e3),
    Unit::times("kN/mm", 1e6),
    Unit::times("MN/m", 1e6),
    Unit::times("lbf/in", POUND_FORCE_N / INCH_M),
    Unit::times("kip/in", 1e3 * POUND_FORCE_N / INCH_M),
    Unit::times("kip/ft", 1e3 * POUND_FORCE_N / FOOT_M),
];
const DAMPER: [Unit; 7] = [
    Unit::times("N s/m", 1.0),
    Unit::times("N s/mm", 1e3),
    Unit::times("kN s/m", 1e3),
    Unit::times("kN s/mm", 1e6),
    Unit::times("MN s/m", 1e6),
    Unit::times("lbf s/in", POUND_FORCE_N / INCH_M),
    Unit::times("kip s/in", 1e3 * POUND_FORCE_N / INCH_M),
];
const SLOWNESS: [Unit; 5] = [
    Unit::times("s/m", 1.0),
    Unit::times("s/mm", 1e3),
    Unit::times("s/cm", 1e2),
    Unit::over("s/in", INCH_M),
    Unit::over("s/ft", FOOT_M),
];

const PRESSURE: [Unit; 6] = [
    Unit::times("Pa", 1.0),
    Unit::times("kPa", 1e3),
    Unit::times("MPa", 1e6),
    Unit::times("N/mm2", 1e6),
    Unit::times("psi", POUND_FORCE_N / (INCH_M * INCH_M)),
    Unit::times("ksi", 1e3 * POUND_FORCE_N / (INCH_M * INCH_M)),
];

const AREA: [Unit; 5] = [
    Unit::times("m2", 1.0),
    Unit::over("mm2", 1e6),
    Unit::over("cm2", 1e4),
    Unit::times("in2", INCH_M * INCH_M),
    Unit::times("ft2", FOOT_M * FOOT_M),
];

/// Every unit with its dimension, in the order of the printed table.
pub fn all() -> impl Iterator<Item = (Dimension, &'static Unit)> {
    Dimension::ALL.into_iter().flat_map(|d| d.units().iter().map(move |unit| (d, unit)))
}

/// The table of units as text: a line a dimension, the SI unit first.
#[must_use]
pub fn table() -> String {
    let mut text = String::new();
    for dimension in Dimension::ALL {
        let names: Vec<_> = dimension.units().iter().map(Unit::name).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:<16} {:<68} such as \"{}\"",
            dimension.name(),
            names.join(", "),
            dimension.example()
        );
    }
    text.push_str(
        "\nThe first of each line is the SI unit in which results are given. s2 may be written s^2 \
         or s²,\nand the space in \"N s/m\" as · or *. t is the tonne of 1000 kg; g is only \
         gravity,\n9.80665 m/s², never a gram.\n",
    );
    text
}

/// Reads a number with its unit, such as `150 mm` or `0.3g`, as the dimension's SI unit.
///
/// # Errors
/// [`UnitError`] for text that is not a finite number followed by a unit of that dimension.
pub fn parse_quantity(text: &str, dimension: Dimension) -> Result<f64, UnitError> {
    let text = text.trim();
    let (number, unit) = text.split_at(number_length(text));
    let malformed = || UnitError {
        expected: format!(
            "{} with its unit, such as \"{}\"",
            dimension.with_article(),
            dimension.example()
        ),
        found: quoted(text),
        nearest: None,
    };
    let Ok(value) = number.parse::<f64>() else { return Err(malformed()) };
    let mended = text.replacen(',', ".", 1);
    if unit.starts_with(',') && parse_quantity(&mended, dimension).is_ok() {
        let expected = format!("a decimal point, {}", quoted(&mended));
        return Err(UnitError { expected, found: quoted(text), nearest: None });
    }
    let unit = unit.trim_start();
    // "1,5 m" and "1_000 m" are numbers written in another way, not numbers with a strange unit.
    if !unit.starts_with(char::is_alphabetic) {
        return Err(malformed());
    }
    let unit = find_unit(unit, dimension, text)?;
    let si = unit.to_si(value);
    if si.is_finite() {
        return Ok(si);
    }
    let expected = format!("{} that is finite", dimension.with_article());
    Err(UnitError { expected, found: quoted(text), nearest: None })
}

/// Reads the name of a unit, such as `cm/s²`.
///
/// # Errors
/// [`UnitError`] for a name that is not a unit of that dimension.
pub fn parse_unit(name: &str, dimension: Dimension) -> Result<&'static Unit, UnitError> {
    find_unit(name.trim(), dimension, name)
}

/// The unit of that name; `text` is all that was written, for the message.
fn find_unit(name: &str, dimension: Dimension, text: &str) -> Result<&'static Unit, UnitError> {
    let plain = plain(name);
    let units = dimension.units();
    if let Some(unit) = units.iter().find(|unit| unit.name == plain) {
        return Ok(unit);
    }
    let named_alike = |(_, unit): &(Dimension, &Unit)| unit.name == plain;
    if let Some((other, _)) = all().find(named_alike) {
        let expected = format!("{}, such as \"{}\"", dimension.with_article(), dimension.example());
        let found = format!("{}, {}", other.with_article(), quoted(text));
        return Err(UnitError { expected, found, nearest: None });
    }
    let names: Vec<_> = units.iter().map(Unit::name).collect();
    let expected = format!("a unit of {} ({})", dimension.name(), names.join(", "));
    let nearest = crate::error::similar(&plain, names.iter().copied());
    Err(UnitError { expected, found: quoted(name), nearest })
}

/// A unit's name as the table spells it: `s2` for `s²` and `s^2`, one space for `·` and `*`.
fn plain(name: &str) -> String {
    let spaced = name.replace('²', "2").replace('^', "").replace(['·', '*'], " ");
    spaced.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Length in bytes of the number at the start of a text: sign, digits, point, digits, exponent.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let sign = |at: usize| usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let mut end = sign(0);
    end += digits(end);
    if bytes.get(end) == Some(&b'.') {
        end += 1 + digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let first = end + 1 + sign(end + 1);
        if digits(first) > 0 {
            end = first + digits(first);
        }
    }
    end
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", crate::error::cut(text))
}
