//! What a slider may have beyond one surface of constant friction, and what stands on the floors.

use super::{finite, in_range, not_negative, positive};
use crate::error::ModelError;
use crate::friction::{Direction, RateLaw, Series};

/// Parts that a model need not have.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Devices {
    /// Kinetic friction by sliding speed; at rest it must not be above the static friction.
    pub rate: Option<RateLaw>,
    /// Radius of the slider's pendulum in m. Its spring follows the normal force, `N(t)/R`; the
    /// slider's own stiffness is that under the weight, `M_tot g cos θ/R`.
    pub radius_m: Option<f64>,
    /// Surfaces in series, of which the slider's friction is the first to slide.
    pub series: Option<Series>,
    /// What slides on the floors, in the order of the file.
    pub contents: Vec<Contents>,
}

/// Something that stands unfastened on the block or on a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contents {
    /// 0 on the block, else the storey on whose floor it stands, from the block up.
    pub floor: usize,
    /// Mass in kg.
    pub mass_kg: f64,
    /// Static coefficient of friction.
    pub static_friction: f64,
    /// Kinetic coefficient of friction.
    pub kinetic_friction: f64,
}

impl Devices {
    /// Whether the model has none of them.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Mass of all contents in kg.
    #[must_use]
    pub fn contents_kg(&self) -> f64 {
        self.contents.iter().map(|contents| contents.mass_kg).sum()
    }

    /// The same with all coefficients of the slider times `factor`.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            rate: self.rate.as_ref().map(|rate| rate.scaled(factor)),
            series: self.series.as_ref().map(|series| series.scaled(factor)),
            ..self.clone()
        }
    }

    /// # Errors
    /// [`ModelError`] for what no model can have.
    pub(super) fn check(
        &self,
        fixed: impl Fn(Direction) -> f64,
        storeys: usize,
    ) -> Result<(), ModelError> {
        if let Some(rate) = &self.rate {
            for direction in [Direction::Positive, Direction::Negative] {
                let found = rate.at(0.0, direction);
                let expected = "at rest at most the static friction of the same direction";
                let holds = found <= fixed(direction);
                in_range("kinetic_friction", expected, found, holds)?;
            }
            if self.series.is_some() {
                let expected = "no friction by speed on surfaces in series: the shares of the \
                                surfaces would be a differential-algebraic system";
                return Err(ModelError::Missing { quantity: "kinetic_friction", expected });
            }
        }
        self.radius_m.map_or(Ok(()), |radius_m| positive("slider radius_m", radius_m))?;
        for contents in &self.contents {
            positive("contents mass_kg", contents.mass_kg)?;
            finite("contents static_friction", contents.static_friction)?;
            not_negative("contents kinetic_friction", contents.kinetic_friction)?;
            in_range(
                "contents kinetic_friction",
                "at most the static friction",
                contents.kinetic_friction,
                contents.kinetic_friction <= contents.static_friction,
            )?;
            in_range(
                "contents floor",
                "0 for the block, or the number of a storey",
                contents.floor as f64,
                contents.floor <= storeys,
            )?;
        }
        Ok(())
    }
}
