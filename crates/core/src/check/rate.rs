//! Kinetic friction by sliding speed.

use crate::model::Model;
use crate::slider::{Direction, RateCurve};

/// `μ_k(|ṡ|)` for a factor of 1:
///
/// ```text
/// pieces       μ = μ_0 + Σ (μ_{i+1} − μ_i)/(v_{i+1} − v_i) · min(max(|ṡ| − v_i, 0), v_{i+1} − v_i)
/// exponential  μ = μ_fast − (μ_fast − μ_slow) exp(−α |ṡ|)
/// ```
pub(super) struct RateFriction {
    /// `μ_0`, or `μ_fast`.
    base: f64,
    /// `v_i`, `v_{i+1} − v_i` and the slope between, of pieces.
    pieces: Vec<[f64; 3]>,
    /// `μ_fast − μ_slow` and `α` in s/m, of the exponential.
    drop: f64,
    rate_s_per_m: f64,
    /// Largest `|dμ/d|ṡ||` in s/m.
    steepest_s_per_m: f64,
    factors: [f64; 2],
}

impl RateFriction {
    /// The law of a model that has one.
    pub(super) fn new(model: &Model) -> Option<Self> {
        let law = model.slider().rate()?;
        let factors = [Direction::Positive, Direction::Negative].map(|way| law.factor(way));
        Some(match law.curve() {
            RateCurve::Pieces { speeds_m_per_s: v, coefficients: mu } => {
                let pair = v.windows(2).zip(mu.windows(2));
                let pieces: Vec<[f64; 3]> = pair
                    .map(|(v, mu)| [v[0], v[1] - v[0], (mu[1] - mu[0]) / (v[1] - v[0])])
                    .collect();
                let steepest_s_per_m = pieces.iter().fold(0.0, |most, p| p[2].abs().max(most));
                let (drop, rate_s_per_m) = (0.0, 0.0);
                Self { base: mu[0], pieces, drop, rate_s_per_m, steepest_s_per_m, factors }
            }
            RateCurve::Exponential { slow, fast, rate_s_per_m } => {
                let (drop, rate_s_per_m) = (fast - slow, *rate_s_per_m);
                let steepest_s_per_m = drop.abs() * rate_s_per_m;
                let pieces = Vec::new();
                Self { base: *fast, pieces, drop, rate_s_per_m, steepest_s_per_m, factors }
            }
        })
    }

    /// `μ_k` at speeds, for a factor of 1.
    #[inline(always)]
    pub(super) fn coefficients<const L: usize>(&self, speeds_m_per_s: [f64; L]) -> [f64; L] {
        let mut mu = [self.base; L];
        for &[from, width, slope] in &self.pieces {
            for lane in 0..L {
                let above = speeds_m_per_s[lane] - from;
                let above = if above > 0.0 { above } else { 0.0 };
                mu[lane] += slope * if above < width { above } else { width };
            }
        }
        if self.drop != 0.0 {
            for lane in 0..L {
                mu[lane] -= self.drop * libm::exp(-self.rate_s_per_m * speeds_m_per_s[lane]);
            }
        }
        mu
    }

    /// Factor on the curve in a direction.
    pub(super) fn factor(&self, direction: Direction) -> f64 {
        self.factors[super::law::index(direction)]
    }

    /// What it adds to the rates of a slip, in 1/s: for a normal force over the block's mass, and
    /// the largest acceleration of the block over the table.
    pub(super) fn rate(&self, normal: f64, acceleration: f64, fixed: f64) -> f64 {
        let factor = self.factors[0].max(self.factors[1]);
        // e^(−α |ṡ|) changes by its own size while |ṡ| changes by 1/α.
        factor * self.steepest_s_per_m * normal
            + self.rate_s_per_m * (acceleration + normal * fixed)
    }
}

#[cfg(test)]
mod tests {
    use super::RateFriction;
    use crate::model::Model;
    use crate::slider::{Direction, Friction, RateCurve, RateLaw};

    /// As the definition of the law has it, alone and in lanes.
    #[test]
    fn exact_is_the_law() {
        let pieces = RateCurve::Pieces {
            speeds_m_per_s: vec![0.0, 1e-4, 0.05, 0.2],
            coefficients: vec![0.1, 0.03, 0.05, 0.06],
        };
        let exponential = RateCurve::Exponential { slow: 0.03, fast: 0.06, rate_s_per_m: 25.0 };
        for curve in [pieces, exponential] {
            let law = RateLaw::new(curve, [1.0, 0.9]).unwrap();
            let friction = Friction::by_speed([0.2; 2], law.clone()).unwrap();
            let model = Model::rigid_block(9.0, friction).unwrap();
            let own = RateFriction::new(&model).unwrap();
            for i in 0..200 {
                let speed = 0.0017 * f64::from(i);
                for way in [Direction::Positive, Direction::Negative] {
                    let [mu] = own.coefficients([speed]);
                    let (found, expected) = (own.factor(way) * mu, law.at(speed, way));
                    assert!((found - expected).abs() < 1e-16, "{speed}: {found} {expected}");
                    assert_eq!(own.coefficients([0.01, speed, 0.3])[1], mu);
                }
            }
        }
    }
}
