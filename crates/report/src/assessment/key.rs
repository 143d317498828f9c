//! Keys of demands and measures as people read them.

use slipstick::requests::measured;
use slipstick::response::DemandColumn;
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use crate::display::{DisplayUnits, Quantity, Unit};
use crate::json::Scalar;

/// What a key measures.
#[must_use]
pub fn quantity(key: &str) -> Quantity {
    measured(key).0.into()
}

/// `Peak sliding displacement` of `peak_sliding_displacement_m`.
#[must_use]
pub fn title(key: &str) -> String {
    if let Some(column) = DemandColumn::of_name(key) {
        return column.title();
    }
    let plain = measured(key).1.replace(['_', '.'], " ").replace("storey", "storey ");
    let mut letters = plain.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// `kinetic friction` of `slider.kinetic_friction`, `storey 1 frequency` of `storey.1.frequency`: a key of a model as
/// people read it.
#[must_use]
pub fn path_words(path: &str) -> String {
    let own = ["slider.", "motion."].iter().find_map(|of| path.strip_prefix(of));
    own.unwrap_or(path).replace(['.', '_'], " ")
}

/// A sentence about one of several curves, that of a value of `by`: `With lower friction: half …`,
/// `With radius 2 m: half …`.
#[must_use]
pub fn about_curve(by: &str, label: &str, sentence: &str) -> String {
    let mut letters = sentence.chars();
    let said = match letters.next() {
        Some(first) => first.to_lowercase().chain(letters).collect(),
        None => String::new(),
    };
    match by {
        "friction" => format!("With {label} friction: {said}"),
        path => format!("With {} {label}: {said}", path_words(path)),
    }
}

/// A key of a model as it stands along an axis, with its unit: `kinetic friction`, `radius (m)`.
#[must_use]
pub fn path_label(path: &str, unit: &str) -> String {
    let words = path_words(path);
    if unit.is_empty() { words } else { format!("{words} ({unit})") }
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

/// The value by which a group was taken apart: a number, else its text.
pub(super) fn group_value(value: f64, text: &str) -> Scalar<'_> {
    if value.is_nan() { Scalar::Text(text) } else { Scalar::Number(Some(value)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_models_have_words() {
        assert_eq!(path_words("slider.kinetic_friction"), "kinetic friction");
        assert_eq!(path_words("storey.1.damping_ratio"), "storey 1 damping ratio");
        assert_eq!(path_words("motion.sine.frequency"), "sine frequency");
        assert_eq!(path_words("isolator.period"), "isolator period");
        assert_eq!(path_label("slider.radius", "m"), "radius (m)");
        assert_eq!(path_label("slider.kinetic_friction", ""), "kinetic friction");
        let said = |by, label| about_curve(by, label, "Half of them.");
        assert_eq!(said("friction", "lower"), "With lower friction: half of them.");
        assert_eq!(said("slider.radius", "2 m"), "With radius 2 m: half of them.");
    }

    #[test]
    fn keys_have_titles_and_quantities() {
        assert_eq!(title("peak_sliding_displacement_m"), "Peak sliding displacement");
        assert_eq!(title("storey2_peak_acceleration_m_per_s2"), "Storey 2 peak acceleration");
        assert_eq!(title("gap_ratio"), "Gap ratio");
        assert_eq!(quantity("peak_sliding_velocity_m_per_s"), Quantity::Velocity);
        assert_eq!(quantity("gap_ratio"), Quantity::Ratio);
        assert_eq!(quantity("peak_base_shear_n"), Quantity::Force);
    }
}
