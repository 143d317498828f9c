//! What figures call what they draw: quantities along axes, lines, places, and the order of colours.
//!
//! One description for the drawings of this crate and for those who draw the same results by other means.

use std::borrow::Cow;

use slipstick::assessment::models::ISOLATOR_PERIOD;
use slipstick::input::{Names, dimension_of};
use slipstick::requests::measured;
use slipstick::response::DemandColumn;
use slipstick::units::{Dimension, parse_unit};

use crate::assessment::key::{of_measure, path_label, title};
use crate::assessment::lines::{FRACTILES, GROUPS, RECORD, share_names};
use crate::display::{DisplayUnits, Quantity, Unit};
use crate::number::compact;
use crate::plot::Style;

/// Constants of a type, and the list of all of them.
macro_rules! listed {
    (
        $(#[$of_list:meta])* $list:ident: $type:ty;
        $($(#[$of_one:meta])* $name:ident = $value:expr;)*
    ) => {
        $($(#[$of_one])* pub const $name: $type = $value;)*
        $(#[$of_list])* pub const $list: &[$type] = &[$($name),*];
    };
}

/// A quantity that stands along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisQuantity {
    /// By which it is asked for.
    pub key: &'static str,
    /// Its name in words, which begins an axis.
    pub words: &'static str,
    /// Its letter in the theory; empty where figures do without.
    pub symbol: &'static str,
    /// What it measures.
    pub quantity: Quantity,
}

/// Along which direction a quantity is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// There is one direction only.
    One,
    /// x of two.
    X,
    /// y of two.
    Y,
    /// The size of both together.
    Resultant,
}

impl Along {
    /// Both axes of two directions, in their order.
    pub const AXES: [Self; 2] = [Self::X, Self::Y];

    /// That of a name: `x`, `y`, `resultant`, or nothing in one direction.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        match name {
            "" => Some(Self::One),
            "x" => Some(Self::X),
            "y" => Some(Self::Y),
            "resultant" => Some(Self::Resultant),
            _ => None,
        }
    }

    /// `along x`, as a line is called that is one of several; empty in one direction.
    #[must_use]
    pub fn line(self) -> &'static str {
        match self {
            Self::One => "",
            Self::X => "along x",
            Self::Y => "along y",
            Self::Resultant => "resultant",
        }
    }
}

impl AxisQuantity {
    const fn new(
        key: &'static str,
        words: &'static str,
        symbol: &'static str,
        quantity: Quantity,
    ) -> Self {
        Self { key, words, symbol, quantity }
    }

    /// Its name without the unit: `Sliding displacement s along x`, `Roof acceleration`; `of` is what it is of, empty where
    /// that is said elsewhere.
    #[must_use]
    pub fn name(&self, of: &str, along: Along) -> String {
        let mut name = match of {
            "" => self.words.to_owned(),
            of => format!("{of} {}", self.words.to_lowercase()),
        };
        match (self.symbol, along) {
            ("", Along::Resultant) => name.push_str(", resultant"),
            ("", _) => {}
            (symbol, Along::Resultant) => name.push_str(&format!(" |{symbol}|")),
            (symbol, _) => name.push_str(&format!(" {symbol}")),
        }
        if matches!(along, Along::X | Along::Y) {
            name.push_str(&format!(" {}", along.line()));
        }
        name
    }

    /// The same with a unit, in one direction and of what needs no saying: `Sliding displacement s (mm)`.
    #[must_use]
    pub fn alone(&self, unit: Unit) -> String {
        self.label("", Along::One, unit)
    }

    /// The same of something and along a direction: `Roof acceleration along x (g)`.
    #[must_use]
    pub fn label(&self, of: &str, along: Along, unit: Unit) -> String {
        unit.label(&self.name(of, along))
    }
}

listed! {
    /// All quantities that stand along axes.
    QUANTITIES: AxisQuantity;
    /// Time from the start of the motion.
    TIME = AxisQuantity::new("time", "Time", "", Quantity::Time);
    /// Of an oscillator.
    PERIOD = AxisQuantity::new("period", "Period", "", Quantity::Time);
    /// Of the block over the ground.
    SLIDING = AxisQuantity::new("sliding", "Sliding displacement", "s", Quantity::Length);
    /// Of ground, block, floors and points.
    ACCELERATION = AxisQuantity::new("acceleration", "Acceleration", "", Quantity::Acceleration);
    /// Of the ground.
    VELOCITY = AxisQuantity::new("velocity", "Velocity", "", Quantity::Velocity);
    /// Of the ground, of surfaces, of contents, of the rig of a test.
    DISPLACEMENT = AxisQuantity::new("displacement", "Displacement", "", Quantity::Length);
    /// Of a floor, or of a point of a structure by its modes.
    OVER_BLOCK =
        AxisQuantity::new("over_block", "Displacement over the block", "", Quantity::Length);
    /// Of what slides on a floor.
    OVER_FLOOR =
        AxisQuantity::new("over_floor", "Displacement over the floor", "", Quantity::Length);
    /// Of a storey, or of a point over the one before it.
    DRIFT = AxisQuantity::new("drift", "Drift", "", Quantity::Length);
    /// Of the block on its slider.
    SLIDER_FORCE = AxisQuantity::new("slider_force", "Slider force", "", Quantity::Force);
    /// The part of it that is friction, with its sign.
    FRICTION_ALONE =
        AxisQuantity::new("friction_alone", "Friction force alone", "", Quantity::Force);
    /// Of the ground on the block.
    FRICTION_FORCE = AxisQuantity::new("friction_force", "Friction force", "T", Quantity::Force);
    /// Of the rig of a cyclic test.
    FORCE = AxisQuantity::new("force", "Force", "", Quantity::Force);
    /// Relative to the ground.
    ENERGY = AxisQuantity::new("energy", "Energy", "", Quantity::Energy);
    /// The ordinate of a floor spectrum.
    SPECTRAL_ACCELERATION = AxisQuantity::new(
        "spectral_acceleration", "Spectral acceleration", "", Quantity::Acceleration,
    );
    /// The ordinate of a fragility.
    PROBABILITY =
        AxisQuantity::new("probability", "Probability of exceedance", "", Quantity::Ratio);
}

/// A line of a figure: what the legend calls it, and how it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendEntry {
    /// By which it is asked for.
    pub key: &'static str,
    /// What the legend calls it; empty for a line that stands alone.
    pub label: Cow<'static, str>,
    /// How it is drawn.
    pub style: Style,
}

const fn entry(key: &'static str, label: &'static str, style: Style) -> LegendEntry {
    LegendEntry { key, label: Cow::Borrowed(label), style }
}

listed! {
    /// All lines but the fractiles of many runs.
    LINES: LegendEntry;
    /// What the figure is of, where there is nothing beside it.
    MAIN = entry("main", "", Style::MAIN);
    /// The ground beside what stands on it.
    GROUND = entry("ground", "ground", Style::DOTTED);
    /// The block beside ground and floors, by its name.
    BLOCK = entry("block", "", Style { width: 1.3, ..Style::MAIN });
    /// The whole slider beside its friction alone or a stop.
    SLIDER = entry("slider", "slider", Style::MAIN);
    /// Its friction beside it.
    FRICTION_PART = entry("friction_part", "friction force alone", RECORD);
    /// Surfaces in series together.
    TOGETHER = entry("together", "together", Style::WIDE);
    /// Static friction at its bound.
    STATIC_BOUND = entry("static_bound", "static bound", Style::DASHED);
    /// Kinetic friction beside it.
    KINETIC_FRICTION = entry("kinetic_friction", "kinetic friction", Style::DOTTED);
    /// The gap that the block has.
    GAP = entry("gap", "gap", Style::LIMIT);
    /// A limit on a demand.
    LIMIT = entry("limit", "limit", Style::LIMIT);
    /// What was put in, beside what became of it.
    INPUT = entry("input", "input", Style { width: 1.4, ..Style::DASHED });
    /// A curve that is fitted.
    FITTED = entry("fitted", "fitted", Style { width: 2.0, ..Style::MAIN });
    /// What was measured.
    MEASURED = entry("measured", "measured", Style::WIDE);
    /// What was computed beside it.
    PREDICTED = entry("predicted", "predicted", Style::MAIN);
    /// Designs that no other beats.
    FRONT = entry("front", "front", Style { width: 1.2, ..Style::MAIN });
    /// With the least friction.
    LOWER_FRICTION = entry("lower_friction", "lower friction", Style::WIDE);
    /// With the most friction.
    UPPER_FRICTION = entry("upper_friction", "upper friction", Style::DASHED);
    /// One of many records.
    ONE_RECORD = entry("record", "record", RECORD);
}

/// An area of the energies that are stacked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnergyArea {
    /// The column of energies at the knots.
    pub column: &'static str,
    /// What the legend calls it.
    pub label: &'static str,
    /// The colour of the area.
    pub fill: &'static str,
}

const fn energy(column: &'static str, label: &'static str, fill: &'static str) -> EnergyArea {
    EnergyArea { column, label, fill }
}

/// Kinds of energy from the lowest of the stack up.
pub const ENERGIES: [EnergyArea; 4] = [
    energy("friction_j", "friction", "#74879c"),
    energy("damping_j", "dampers", "#aab8c6"),
    energy("strain_j", "strain", "#dcd2bb"),
    energy("kinetic_j", "kinetic", "#faf6ec"),
];

/// All lines, and the fractiles of many runs.
#[must_use]
pub fn entries() -> Vec<LegendEntry> {
    let shares = ["p16", "p50", "p84"].into_iter().zip(share_names()).zip(FRACTILES);
    let shares =
        shares.map(|((key, label), style)| LegendEntry { key, label: Cow::Owned(label), style });
    LINES.iter().cloned().chain(shares).collect()
}

/// What legends call the block: `block`, or its name.
#[must_use]
pub fn block(names: &Names) -> String {
    names.block.clone().unwrap_or_else(|| names.block().to_lowercase())
}

/// What legends call a point (from 1): `storey 2`, or the name of the storey or of the point.
#[must_use]
pub fn point(names: &Names, point: usize) -> String {
    let named = names.points.get(point.wrapping_sub(1)).is_some()
        || names.storeys.get(point.wrapping_sub(1)).is_some_and(Option::is_some);
    let name = names.point(point);
    if named { name } else { name.to_lowercase() }
}

/// What legends call what slides on a floor (from 1; 0 is the block): `contents 1 on Roof`.
#[must_use]
pub fn contents(names: &Names, number: usize, floor: usize) -> String {
    let floor = if floor == 0 { block(names) } else { point(names, floor) };
    format!("contents {number} on {floor}")
}

/// The band of a fragility, `90 % band`.
#[must_use]
pub fn band(confidence: f64) -> String {
    format!("{} % band", compact(100.0 * confidence))
}

/// A demand in a share of the records, `Displacement not exceeded in 90 % of the records`.
#[must_use]
pub fn not_exceeded(what: &str, share: f64) -> String {
    format!("{what} not exceeded in {} % of the records", compact(100.0 * share))
}

/// What a tornado has along its axis.
#[must_use]
pub fn change(demand: &str) -> String {
    format!("{}: change in % for 1 % of the key", title(demand))
}

/// Colours of so many lines, no two alike: those of groups in their order, of more than these all hues, light and dark
/// in turn.
#[must_use]
pub fn colours(count: usize) -> Vec<String> {
    if count <= GROUPS.len() {
        return GROUPS.iter().take(count).map(|style| style.colour.to_owned()).collect();
    }
    let colour = |i: usize| {
        let sixths = 6.0 * i as f64 / count as f64;
        let [low, high] = if i.is_multiple_of(2) { [20.0, 150.0] } else { [70.0, 215.0] };
        // Of the three colours one is full, one empty, and one goes up or down between them.
        let (sector, part) = (libm::floor(sixths), sixths - libm::floor(sixths));
        let up = low + (high - low) * part;
        let down = low + (high - low) * (1.0 - part);
        let rgb = match sector as u8 {
            0 => [high, up, low],
            1 => [down, high, low],
            2 => [low, high, up],
            3 => [low, down, high],
            4 => [up, low, high],
            _ => [high, low, down],
        };
        let [r, g, b] = rgb.map(|part| libm::round(part) as u8);
        format!("#{r:02x}{g:02x}{b:02x}")
    };
    (0..count).map(colour).collect()
}

/// Whether a column of a table is a key of the model that was varied.
#[must_use]
pub fn is_key(column: &str) -> bool {
    column.contains('.') && DemandColumn::of_name(column).is_none() && of_key(column).is_some()
}

/// What the number at a key of the model measures; `None` for what is no such key.
fn of_key(path: &str) -> Option<Option<Dimension>> {
    match path {
        ISOLATOR_PERIOD => Some(Some(Dimension::Time)),
        path => dimension_of(path).ok(),
    }
}

/// The axis of a column of a table: its label with the unit, and the unit, for values up to `largest_si`. `measure` is the
/// intensity that the column has, if it does; `None` for a column that is neither that nor a demand or a key.
#[must_use]
pub fn of_column(
    column: &str,
    si_unit: &str,
    measure: Option<&str>,
    largest_si: f64,
    display: DisplayUnits,
) -> Option<(String, Unit)> {
    if let Some(measure) = measure {
        let unit = of_measure(
            dimension_of_unit(si_unit).map_or("", Dimension::si_unit),
            display,
            largest_si,
        );
        return Some((unit.label(measure), unit));
    }
    if is_key(column) {
        let symbol = of_key(column).flatten().map_or("", Dimension::si_unit);
        return Some((path_label(column, symbol), Unit { in_si: 1.0, symbol }));
    }
    let known = DemandColumn::of_name(column).is_some();
    known.then(|| of_words(column, si_unit, largest_si, display))
}

/// The axis of a demand, of what is made of one, and of what a test measures, by its key: its title with the unit, and
/// the unit.
#[must_use]
pub fn of_words(
    key: &str,
    si_unit: &str,
    largest_si: f64,
    display: DisplayUnits,
) -> (String, Unit) {
    let quantity = measured(key).0.or_else(|| dimension_of_unit(si_unit)).into();
    let unit = display.unit(quantity, largest_si);
    (unit.label(&title(key)), unit)
}

/// What a unit measures.
fn dimension_of_unit(unit: &str) -> Option<Dimension> {
    Dimension::ALL.into_iter().find(|of| parse_unit(unit, *of).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_say_what_they_are_of_along_which_direction_and_in_which_unit() {
        let mm = DisplayUnits::SiG.unit(Quantity::Length, 0.1);
        let g = DisplayUnits::SiG.unit(Quantity::Acceleration, 1.0);
        assert_eq!(SLIDING.alone(mm), "Sliding displacement s (mm)");
        assert_eq!(SLIDING.label("", Along::Y, mm), "Sliding displacement s along y (mm)");
        assert_eq!(SLIDING.label("", Along::Resultant, mm), "Sliding displacement |s| (mm)");
        assert_eq!(ACCELERATION.label("Roof", Along::X, g), "Roof acceleration along x (g)");
        assert_eq!(ACCELERATION.label("", Along::Resultant, g), "Acceleration, resultant (g)");
        assert_eq!(PROBABILITY.alone(Unit::NONE), PROBABILITY.words);
        for (i, quantity) in QUANTITIES.iter().enumerate() {
            assert!(QUANTITIES[..i].iter().all(|other| other.key != quantity.key));
        }
    }

    #[test]
    fn columns_are_demands_keys_or_intensities() {
        let of = |column, unit, measure, largest| {
            of_column(column, unit, measure, largest, DisplayUnits::SiG)
                .map(|(label, unit)| (label, unit.in_si))
        };
        let told = |label: &str, in_si| Some((label.to_owned(), in_si));
        assert_eq!(
            of("peak_sliding_displacement_m", "m", None, 0.1),
            told("Peak sliding displacement (mm)", 1e-3)
        );
        assert_eq!(of("gap_ratio", "", None, 0.5), told("Gap ratio", 1.0));
        assert_eq!(of("slider.radius", "m", None, 4.0), told("radius (m)", 1.0));
        assert_eq!(of("isolator.period", "s", None, 4.0), told("isolator period (s)", 1.0));
        assert_eq!(of("level", "m/s²", Some("PGA"), 4.0), told("PGA (g)", 9.80665));
        assert_eq!(of("level", "m/s2", Some("PGA"), 4.0), told("PGA (g)", 9.80665));
        assert_eq!(of("block_amplification", "", None, 4.0), None);
        let words = |key, unit| of_words(key, unit, 0.1, DisplayUnits::SiG).0;
        assert_eq!(words("sliding_displacement", "m"), "Sliding displacement (mm)");
        assert_eq!(words("block_amplification", ""), "Block amplification");
        assert_eq!(words("storey1_acceleration", "m/s²"), "Storey 1 acceleration (g)");
        assert!(is_key("storey.1.mass") && !is_key("block.peak_acceleration_m_per_s2"));
    }

    #[test]
    fn no_two_of_a_thousand_lines_have_one_colour() {
        for count in [1, 6, 7, 12, 100, 360] {
            let mut colours = colours(count);
            colours.sort();
            colours.dedup();
            assert_eq!(colours.len(), count);
        }
    }

    #[test]
    fn legends_keep_the_names_that_people_gave() {
        let names = Names {
            block: Some("Base mat".into()),
            storeys: vec![None, Some("Roof".into())],
            ..Names::default()
        };
        assert_eq!(
            [block(&names), point(&names, 1), point(&names, 2)],
            ["Base mat", "storey 1", "Roof"]
        );
        assert_eq!(block(&Names::default()), "block");
        assert_eq!(contents(&names, 2, 0), "contents 2 on Base mat");
        assert_eq!(contents(&names, 1, 1), "contents 1 on storey 1");
    }
}
