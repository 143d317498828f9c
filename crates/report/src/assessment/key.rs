//! Keys of demands and measures as people read them.

use slipstick::error::{ChoiceError, UnitError};
use slipstick::response::DemandColumn;
use slipstick::units::{Dimension, STANDARD_GRAVITY_M_PER_S2, parse_quantity};

use crate::display::{DisplayUnits, Quantity, Unit};

/// Endings of keys that are no demand of the registry (ratios of two demands, columns of other
/// programs' tables), with the quantity that they mean, the longer before the shorter.
const ENDINGS: [(&str, Quantity); 5] = [
    ("_m_per_s2", Quantity::Acceleration),
    ("_m_per_s", Quantity::Velocity),
    ("_m", Quantity::Length),
    ("_n", Quantity::Force),
    ("_s", Quantity::Time),
];

/// What a key measures.
#[must_use]
pub fn quantity(key: &str) -> Quantity {
    if let Some(column) = DemandColumn::of_name(key) {
        return column.dimension().into();
    }
    let found = ENDINGS.iter().find(|(ending, _)| key.ends_with(ending));
    found.map_or(Quantity::Ratio, |(_, quantity)| *quantity)
}

/// A limit > 0 on a demand, in SI: with the unit that its key ends in, or a bare number; `what` is what
/// errors call it.
///
/// # Errors
/// [`ChoiceError`] for text that is no such quantity, and for one that is not > 0.
pub fn limit(what: &str, text: &str, demand: &str) -> Result<f64, ChoiceError> {
    let refuse = |expected: &str| ChoiceError {
        what: what.to_owned(),
        expected: expected.to_owned(),
        found: format!("{text:?}"),
        nearest: None,
    };
    let dimension = match quantity(demand) {
        Quantity::Length => Some(Dimension::Length),
        Quantity::Velocity => Some(Dimension::Velocity),
        Quantity::Acceleration => Some(Dimension::Acceleration),
        Quantity::Force => Some(Dimension::Force),
        Quantity::Time => Some(Dimension::Time),
        _ => None,
    };
    let value = match dimension {
        Some(dimension) => {
            parse_quantity(text, dimension).map_err(|UnitError { expected, found, nearest }| {
                ChoiceError { what: what.to_owned(), expected, found, nearest }
            })?
        }
        None => text.trim().parse().map_err(|_| refuse("a number"))?,
    };
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(refuse("a limit > 0")) }
}

/// `Peak sliding displacement` of `peak_sliding_displacement_m`.
#[must_use]
pub fn title(key: &str) -> String {
    if let Some(column) = DemandColumn::of_name(key) {
        return column.title();
    }
    let found = ENDINGS.iter().find_map(|(ending, _)| key.strip_suffix(ending));
    let plain = found.unwrap_or(key).replace(['_', '.'], " ").replace("storey", "storey ");
    let mut letters = plain.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// The unit of an intensity measure given its SI unit: accelerations in g, as levels are written.
#[must_use]
pub fn of_measure(si_unit: &str, display: DisplayUnits, largest: f64) -> Unit {
    match si_unit {
        "m/s2" => Unit { in_si: STANDARD_GRAVITY_M_PER_S2, symbol: "g" },
        "m/s" => display.unit(Quantity::Velocity, largest),
        "m" => display.unit(Quantity::Length, largest),
        "s" => Unit { in_si: 1.0, symbol: "s" },
        _ => Unit { in_si: 1.0, symbol: "" },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_keys_have_titles_and_quantities() {
        assert_eq!(title("peak_sliding_displacement_m"), "Peak sliding displacement");
        assert_eq!(title("storey2_peak_acceleration_m_per_s2"), "Storey 2 peak acceleration");
        assert_eq!(title("gap_ratio"), "Gap ratio");
        assert_eq!(quantity("peak_sliding_velocity_m_per_s"), Quantity::Velocity);
        assert_eq!(quantity("gap_ratio"), Quantity::Ratio);
        assert_eq!(quantity("peak_base_shear_n"), Quantity::Force);
    }
}
