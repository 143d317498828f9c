//! A linear structure by its modes on a fixed base.
//!
//! A mode on a moving base is an oscillator of its effective mass on the block: with `L = φᵀ M 1` of a shape of
//! unit modal mass, `η = L d` and
//!
//! ```text
//! d̈ + 2 ξ ω ḋ + ω² d = −(s̈ + a)        m = L²
//! displacement of a point = Σ φ η = Σ (φ L) d
//! ```

use super::{Damping, Frame};
use crate::error::ModelError;
use crate::slider::ranges::positive;

/// A mode on a fixed base.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureMode {
    /// Circular frequency `ω` in rad/s.
    pub frequency_rad_per_s: f64,
    /// Ratio of critical damping `ξ`.
    pub damping_ratio: f64,
    /// Effective mass `L²` in kg.
    pub effective_mass_kg: f64,
    /// Displacement of each point over that of the mode's oscillator, `φ L`.
    pub points: Vec<f64>,
}

/// A mode that may move along x and y at once, by its shape of unit modal mass.
///
/// On a base that moves along both,
///
/// ```text
/// η̈ + 2 ξ ω η̇ + ω² η = −L_x (s̈_x + a_x) − L_y (s̈_y + a_y)        L = φᵀ M 1
/// displacement of a point along an axis = Σ φ η
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ModeInPlane {
    /// Circular frequency `ω` in rad/s.
    pub frequency_rad_per_s: f64,
    /// Ratio of critical damping `ξ`.
    pub damping_ratio: f64,
    /// Participations `L` along x and y in √kg.
    pub participation: [f64; 2],
    /// Shape `φ` at each point along x and y in 1/√kg.
    pub points: Vec<[f64; 2]>,
}

/// A mode as an oscillator on the block, of its effective mass `|L|²` and along the direction `L/|L|`: with
/// `η = |L| d`
///
/// ```text
/// d̈ + 2 ξ ω ḋ + ω² d = −(L/|L|)·(s̈ + a)
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct OscillatorInPlane {
    /// Circular frequency `ω` in rad/s.
    pub frequency_rad_per_s: f64,
    /// Ratio of critical damping `ξ`.
    pub damping_ratio: f64,
    /// `|L|²` in kg.
    pub mass_kg: f64,
    /// `L/|L|` along x and y.
    pub direction: [f64; 2],
    /// What each point's displacement along x and y has of `d`, `φ |L|`.
    pub points: Vec<[f64; 2]>,
}

/// A point of the structure whose motion is wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct StructurePoint {
    /// Its name.
    pub name: String,
    /// Height above the block in m.
    pub height_m: Option<f64>,
    /// Its share of the mass in kg, of whose inertia the overturning moment is made.
    pub mass_kg: Option<f64>,
}

/// A structure by its modes. Mass that they lack moves with the block.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// All of its mass in kg.
    pub mass_kg: f64,
    /// Modes that take part along x; none where all move along y.
    pub modes: Vec<StructureMode>,
    /// All modes with what they do along x and along y; none where nothing is known along y.
    pub in_plane: Vec<ModeInPlane>,
    /// Points, in the order of the results.
    pub points: Vec<StructurePoint>,
}

impl StructureMode {
    /// This mode along x and one like it along y, of a structure that is the same along both.
    #[must_use]
    pub fn along_both(&self) -> [ModeInPlane; 2] {
        let participation = self.effective_mass_kg.sqrt();
        [0, 1].map(|axis| {
            let along = |value: f64| {
                let mut both = [0.0; 2];
                both[axis] = value;
                both
            };
            ModeInPlane {
                frequency_rad_per_s: self.frequency_rad_per_s,
                damping_ratio: self.damping_ratio,
                participation: along(participation),
                points: self.points.iter().map(|of| along(of / participation)).collect(),
            }
        })
    }
}

impl ModeInPlane {
    fn check(&self, points: usize) -> Result<(), ModelError> {
        let quantity = "structure frequency_rad_per_s";
        positive(quantity, self.frequency_rad_per_s)?;
        super::not_negative("structure damping_ratio", self.damping_ratio)?;
        for value in self.participation {
            super::finite("structure participation", value)?;
        }
        let (expected, found) = (points, self.points.len());
        if expected != found {
            let quantity = "structure mode points";
            return Err(ModelError::WrongCount { quantity, expected, found });
        }
        let mut shape = self.points.iter().flatten();
        shape.try_for_each(|value| super::finite("structure mode points", *value))
    }
}

/// Part of the mass by which effective masses may exceed it: what rounding to seven digits makes.
pub const ROUNDED_MASS: f64 = 1e-6;

/// Part of the mass by which the coupling of x and y may exceed it: products of two rounded participations.
pub const ROUNDED_ACROSS: f64 = 1e-3;

/// Part of the mass, or of the block's motion, by which a structure may move across a line and move along it: rounding.
const OFF: f64 = 1e-14;

/// What is asked of the participations along x and y together.
pub const ACROSS: &str = "participations along x and y whose squares sum to at most the mass of the structure in every \
     direction between them: do their signs belong to the same shapes?";

/// The largest of `Σ (L·u)²` over the directions u, of `Σ L Lᵀ`.
pub fn largest_mass_kg([[x, across], [_, y]]: [[f64; 2]; 2]) -> f64 {
    0.5 * (x + y) + libm::hypot(0.5 * (x - y), across)
}

impl Structure {
    /// What the modes lack of the mass, in kg.
    #[must_use]
    pub fn missing_mass_kg(&self) -> f64 {
        let found = self.modes.iter().fold(0.0, |sum, mode| sum + mode.effective_mass_kg);
        (self.mass_kg - found).max(0.0)
    }

    /// What all modes together have of the mass, in kg: `Σ L Lᵀ` along x and y, whose part beside the diagonal is 0
    /// where no mode is missing.
    #[must_use]
    pub fn mass_in_plane_kg(&self) -> [[f64; 2]; 2] {
        let of = |i: usize, j: usize| {
            let product = |mode: &ModeInPlane| mode.participation[i] * mode.participation[j];
            self.in_plane.iter().map(product).sum()
        };
        [[of(0, 0), of(0, 1)], [of(1, 0), of(1, 1)]]
    }

    /// The oscillators that its modes are in two directions; a mode that takes no part moves nothing.
    #[must_use]
    pub fn oscillators_in_plane(&self) -> Vec<OscillatorInPlane> {
        let taking_part = self.in_plane.iter().filter(|mode| mode.participation != [0.0; 2]);
        let of = |mode: &ModeInPlane| {
            let [x, y] = mode.participation;
            let size = libm::hypot(x, y);
            OscillatorInPlane {
                frequency_rad_per_s: mode.frequency_rad_per_s,
                damping_ratio: mode.damping_ratio,
                mass_kg: size * size,
                direction: [x / size, y / size],
                points: mode.points.iter().map(|shape| shape.map(|phi| phi * size)).collect(),
            }
        };
        taking_part.map(of).collect()
    }

    /// The structure as one of one direction, along which alone block, modes and points move when the ground does: modes of
    /// one frequency and damping are one there. `None` where something moves across it.
    pub(crate) fn along(&self, direction: [f64; 2]) -> Option<Self> {
        let [x, y] = direction;
        let on = |v: [f64; 2]| x * v[0] + y * v[1];
        let is_off = |v: [f64; 2], size: f64| (x * v[1] - y * v[0]).abs() > OFF * size;
        let mut modes: Vec<StructureMode> = Vec::new();
        for (i, first) in self.in_plane.iter().enumerate() {
            let is_alike = |mode: &&ModeInPlane| {
                mode.frequency_rad_per_s == first.frequency_rad_per_s
                    && mode.damping_ratio == first.damping_ratio
            };
            if self.in_plane[..i].iter().any(|mode| is_alike(&mode)) {
                continue;
            }
            // Σ v (L·e)
            let moved = |of: &dyn Fn(&ModeInPlane) -> [f64; 2]| {
                let alike = self.in_plane.iter().filter(is_alike);
                alike.fold([0.0; 2], |sum, mode| {
                    let (v, l) = (of(mode), on(mode.participation));
                    [sum[0] + v[0] * l, sum[1] + v[1] * l]
                })
            };
            let mass = moved(&|mode| mode.participation);
            let points: Vec<[f64; 2]> =
                (0..self.points.len()).map(|i| moved(&|mode| mode.points[i])).collect();
            if is_off(mass, self.mass_kg) || points.iter().any(|point| is_off(*point, 1.0)) {
                return None;
            }
            if on(mass) > OFF * self.mass_kg {
                modes.push(StructureMode {
                    frequency_rad_per_s: first.frequency_rad_per_s,
                    damping_ratio: first.damping_ratio,
                    effective_mass_kg: on(mass),
                    points: points.into_iter().map(on).collect(),
                });
            }
        }
        let points = self.points.clone();
        (!modes.is_empty()).then(|| Self { mass_kg: self.mass_kg, modes, in_plane: vec![], points })
    }

    /// What of a point's motion is the block's, along x and y by the block's along x and y: `I − Σ φ Lᵀ`.
    #[must_use]
    pub fn with_block_in_plane(&self, point: usize) -> [[f64; 2]; 2] {
        let mut rest = [[1.0, 0.0], [0.0, 1.0]];
        for mode in &self.in_plane {
            for (row, phi) in rest.iter_mut().zip(mode.points[point]) {
                for (rest, l) in row.iter_mut().zip(mode.participation) {
                    *rest -= phi * l;
                }
            }
        }
        rest
    }

    /// What of a point's motion is the block's: `1 − Σ φ L`, the residual of modes that are not given.
    #[must_use]
    pub fn with_block(&self, point: usize) -> f64 {
        1.0 - self.modes.iter().fold(0.0, |sum, mode| sum + mode.points[point])
    }

    /// Height of a point above the one before it, of the first above the block, in m.
    #[must_use]
    pub fn rise_m(&self, point: usize) -> Option<f64> {
        let below_m = match point.checked_sub(1) {
            Some(below) => self.points[below].height_m?,
            None => 0.0,
        };
        self.points[point].height_m.map(|height_m| height_m - below_m).filter(|rise| *rise > 0.0)
    }

    /// Mass and height of every point in kg and m, where all have both.
    #[must_use]
    pub fn shares(&self) -> Option<Vec<[f64; 2]>> {
        let share = |point: &StructurePoint| Some([point.mass_kg?, point.height_m?]);
        self.points.iter().map(share).collect::<Option<Vec<_>>>().filter(|all| !all.is_empty())
    }

    /// The oscillators that the modes are, each on the block.
    pub(super) fn oscillators(&self) -> Frame {
        let masses_kg: Vec<f64> = self.modes.iter().map(|mode| mode.effective_mass_kg).collect();
        let of = |value: fn(&StructureMode) -> f64| {
            self.modes.iter().map(|mode| mode.effective_mass_kg * value(mode)).collect()
        };
        Frame {
            masses_kg,
            stiffnesses_n_per_m: of(|mode| mode.frequency_rad_per_s * mode.frequency_rad_per_s),
            damping: Damping::Dampers(of(|mode| {
                2.0 * mode.damping_ratio * mode.frequency_rad_per_s
            })),
            heights_m: None,
        }
    }

    pub(super) fn check(&self) -> Result<(), ModelError> {
        positive("structure mass_kg", self.mass_kg)?;
        if self.modes.is_empty() && self.in_plane.iter().all(|mode| mode.participation == [0.0; 2])
        {
            let (quantity, expected) = ("structure modes", "a mode that takes part");
            return Err(ModelError::Missing { quantity, expected });
        }
        for mode in &self.modes {
            let (expected, found) = (self.points.len(), mode.points.len());
            if expected != found {
                let quantity = "structure mode points";
                return Err(ModelError::WrongCount { quantity, expected, found });
            }
            for value in &mode.points {
                super::finite("structure mode points", *value)?;
            }
        }
        for mode in &self.in_plane {
            mode.check(self.points.len())?;
        }
        let [[x, across], [_, y]] = self.mass_in_plane_kg();
        let expected =
            "participations along y whose squares sum to at most the mass of the structure";
        let within = y <= self.mass_kg * (1.0 + ROUNDED_MASS);
        super::in_range("structure participation along y", expected, y, within)?;
        let within =
            largest_mass_kg([[x, across], [across, y]]) <= self.mass_kg * (1.0 + ROUNDED_ACROSS);
        super::in_range("structure participation across", ACROSS, across, within)?;
        for point in &self.points {
            super::optional_positive("structure point mass_kg", point.mass_kg)?;
            super::optional_positive("structure point height_m", point.height_m)?;
        }
        let found = self.modes.iter().fold(0.0, |sum, mode| sum + mode.effective_mass_kg);
        let expected = "effective masses that sum to at most the mass of the structure";
        let within = found <= self.mass_kg * (1.0 + ROUNDED_MASS);
        super::in_range("structure effective_mass_kg", expected, found, within)
    }
}
