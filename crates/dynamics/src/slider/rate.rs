//! Kinetic friction that depends on the sliding speed.

use super::Direction;
use super::ranges::{in_range, not_negative};
use crate::error::ModelError;
use crate::linear::polynomial::Polynomial;

/// How a coefficient of friction depends on the sliding speed `v = |ṡ|`.
#[derive(Clone, Debug, PartialEq)]
pub enum RateCurve {
    /// Straight lines between knots, constant beyond the last.
    Pieces {
        /// Speeds at the knots in m/s, from 0 and increasing.
        speeds_m_per_s: Vec<f64>,
        /// Coefficients there.
        coefficients: Vec<f64>,
    },
    /// `μ = fast − (fast − slow) e^(−rate v)`.
    Exponential {
        /// Coefficient at rest.
        slow: f64,
        /// Coefficient at high speed.
        fast: f64,
        /// How soon it is reached, in s/m.
        rate_s_per_m: f64,
    },
}

/// Kinetic friction by sliding speed, times a factor for each direction.
#[derive(Clone, Debug, PartialEq)]
pub struct RateLaw {
    curve: RateCurve,
    factors: [f64; 2],
}

/// A coefficient of friction in one piece of a [`RateLaw`], by `v = |ṡ|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Coefficient {
    /// `at_rest + slope v`.
    Linear {
        /// Value of the line at `v = 0`.
        at_rest: f64,
        /// Its slope in s/m.
        slope_s_per_m: f64,
    },
    /// `fast − drop e^(−rate v)`.
    Exponential {
        /// Value at high speed.
        fast: f64,
        /// What it lacks of that at rest.
        drop: f64,
        /// Rate in s/m.
        rate_s_per_m: f64,
    },
}

impl Coefficient {
    /// Its value at a speed in m/s.
    fn at(&self, speed_m_per_s: f64) -> f64 {
        match *self {
            Self::Linear { at_rest, slope_s_per_m } => at_rest + slope_s_per_m * speed_m_per_s,
            Self::Exponential { fast, drop, rate_s_per_m } => {
                fast - drop * libm::exp(-rate_s_per_m * speed_m_per_s)
            }
        }
    }

    /// Its coefficient of an order of the time, from that of the speed and those of `e^(−rate v)`.
    #[inline(always)]
    pub(crate) fn of_order(&self, k: usize, speed: f64, decay: &Polynomial) -> f64 {
        let first = if k == 0 { 1.0 } else { 0.0 };
        match *self {
            Self::Linear { at_rest, slope_s_per_m } => at_rest * first + slope_s_per_m * speed,
            Self::Exponential { fast, drop, .. } => fast * first - drop * decay[k],
        }
    }
}

impl RateLaw {
    /// A curve, times one factor for sliding towards +x and one towards −x.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] unless coefficients, rate and factors are finite and ≥ 0 and speeds
    /// start at 0 and increase; [`ModelError::WrongCount`] unless there is one coefficient a speed.
    pub fn new(curve: RateCurve, factors: [f64; 2]) -> Result<Self, ModelError> {
        match &curve {
            RateCurve::Pieces { speeds_m_per_s, coefficients } => {
                if speeds_m_per_s.len() != coefficients.len() || speeds_m_per_s.is_empty() {
                    return Err(ModelError::WrongCount {
                        quantity: "kinetic_friction coefficient",
                        expected: speeds_m_per_s.len().max(1),
                        found: coefficients.len(),
                    });
                }
                let quantity = "kinetic_friction velocity";
                let first = speeds_m_per_s[0];
                in_range(quantity, "0 as the first velocity", first, first == 0.0)?;
                for pair in speeds_m_per_s.windows(2) {
                    let is_within = pair[1] > pair[0] && pair[1].is_finite();
                    in_range(quantity, "velocities that increase", pair[1], is_within)?;
                }
                for found in coefficients {
                    not_negative("kinetic_friction coefficient", *found)?;
                }
            }
            RateCurve::Exponential { slow, fast, rate_s_per_m } => {
                not_negative("kinetic_friction slow", *slow)?;
                not_negative("kinetic_friction fast", *fast)?;
                not_negative("kinetic_friction rate", *rate_s_per_m)?;
            }
        }
        factors
            .iter()
            .try_for_each(|factor| not_negative("factor on kinetic_friction", *factor))?;
        Ok(Self { curve, factors })
    }

    /// The curve.
    #[must_use]
    pub fn curve(&self) -> &RateCurve {
        &self.curve
    }

    /// Factor on the curve in a direction.
    #[must_use]
    pub fn factor(&self, direction: Direction) -> f64 {
        direction.of(self.factors)
    }

    /// Coefficient at a speed in m/s.
    #[must_use]
    pub fn at(&self, speed_m_per_s: f64, direction: Direction) -> f64 {
        if speed_m_per_s == 0.0 {
            // As given, without the rounding of a difference.
            let at_rest = match &self.curve {
                RateCurve::Pieces { coefficients, .. } => coefficients[0],
                RateCurve::Exponential { slow, .. } => *slow,
            };
            return self.factor(direction) * at_rest;
        }
        self.piece(self.piece_of(speed_m_per_s), direction).at(speed_m_per_s)
    }

    /// This law with all coefficients times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { curve: self.curve.clone(), factors: self.factors.map(|own| own * factor) }
    }

    /// Number of pieces.
    pub(super) fn pieces(&self) -> usize {
        match &self.curve {
            RateCurve::Pieces { speeds_m_per_s, .. } => speeds_m_per_s.len(),
            RateCurve::Exponential { .. } => 1,
        }
    }

    /// The piece to which a speed belongs: at a knot the one above it.
    pub(super) fn piece_of(&self, speed: f64) -> usize {
        match &self.curve {
            RateCurve::Pieces { speeds_m_per_s, .. } => {
                speeds_m_per_s.partition_point(|knot| *knot <= speed).max(1) - 1
            }
            RateCurve::Exponential { .. } => 0,
        }
    }

    /// The speeds between which a piece lies.
    pub(super) fn ends(&self, piece: usize) -> [Option<f64>; 2] {
        match &self.curve {
            RateCurve::Pieces { speeds_m_per_s, .. } => {
                [(piece > 0).then(|| speeds_m_per_s[piece]), speeds_m_per_s.get(piece + 1).copied()]
            }
            RateCurve::Exponential { .. } => [None; 2],
        }
    }

    /// Coefficient in a piece.
    pub(super) fn piece(&self, piece: usize, direction: Direction) -> Coefficient {
        let factor = self.factor(direction);
        match &self.curve {
            RateCurve::Pieces { speeds_m_per_s: v, coefficients: mu } => {
                let slope = match v.get(piece + 1) {
                    Some(next) => (mu[piece + 1] - mu[piece]) / (next - v[piece]),
                    None => 0.0,
                };
                Coefficient::Linear {
                    at_rest: factor * (mu[piece] - slope * v[piece]),
                    slope_s_per_m: factor * slope,
                }
            }
            RateCurve::Exponential { slow, fast, rate_s_per_m } => Coefficient::Exponential {
                fast: factor * fast,
                drop: factor * (fast - slow),
                rate_s_per_m: *rate_s_per_m,
            },
        }
    }
}
