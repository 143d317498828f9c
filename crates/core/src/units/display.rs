//! Units of the table that a person reads.

use super::{INCH_M, POUND_FORCE_N, POUND_KG, STANDARD_GRAVITY_M_PER_S2};

/// A system of units for printed tables; files and `--json` are always SI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DisplaySystem {
    /// m, m/s, m/s², N.
    #[default]
    Si,
    /// mm, mm/s, m/s², kN.
    KnMm,
    /// in, in/s, g, kip.
    Us,
}

/// A kind of quantity in a printed table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayKind {
    /// Displacements.
    Length,
    /// Velocities.
    Velocity,
    /// Accelerations.
    Acceleration,
    /// Forces.
    Force,
    /// Masses.
    Mass,
    /// Stiffnesses.
    Stiffness,
}

/// How a kind of quantity is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    /// What an SI value is multiplied by.
    pub factor: f64,
    /// The unit's name.
    pub label: &'static str,
}

impl DisplaySystem {
    /// The names of the systems, as the command takes them.
    pub const NAMES: [&'static str; 3] = ["si", "kN-mm", "us"];

    /// The system of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "si" => Some(Self::Si),
            "kN-mm" => Some(Self::KnMm),
            "us" => Some(Self::Us),
            _ => None,
        }
    }

    /// How this system prints a kind of quantity.
    #[must_use]
    pub fn unit(self, kind: DisplayKind) -> DisplayUnit {
        let (factor, label) = match (self, kind) {
            (Self::Si, DisplayKind::Length) => (1.0, "m"),
            (Self::Si, DisplayKind::Velocity) => (1.0, "m/s"),
            (Self::Si | Self::KnMm, DisplayKind::Acceleration) => (1.0, "m/s²"),
            (Self::Si, DisplayKind::Force) => (1.0, "N"),
            (Self::Si, DisplayKind::Mass) => (1.0, "kg"),
            (Self::Si, DisplayKind::Stiffness) => (1.0, "N/m"),
            (Self::KnMm, DisplayKind::Length) => (1e3, "mm"),
            (Self::KnMm, DisplayKind::Velocity) => (1e3, "mm/s"),
            (Self::KnMm, DisplayKind::Force) => (1e-3, "kN"),
            (Self::KnMm, DisplayKind::Mass) => (1e-3, "t"),
            (Self::KnMm, DisplayKind::Stiffness) => (1e-6, "kN/mm"),
            (Self::Us, DisplayKind::Length) => (1.0 / INCH_M, "in"),
            (Self::Us, DisplayKind::Velocity) => (1.0 / INCH_M, "in/s"),
            (Self::Us, DisplayKind::Acceleration) => (1.0 / STANDARD_GRAVITY_M_PER_S2, "g"),
            (Self::Us, DisplayKind::Force) => (1e-3 / POUND_FORCE_N, "kip"),
            (Self::Us, DisplayKind::Mass) => (1.0 / POUND_KG, "lb"),
            (Self::Us, DisplayKind::Stiffness) => (1e-3 * INCH_M / POUND_FORCE_N, "kip/in"),
        };
        DisplayUnit { factor, label }
    }
}
