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

/// A straight line of `μ_k` between two speeds: `μ + slope (|w| − from)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpeedLine {
    pub(super) from: f64,
    pub(super) mu: f64,
    pub(super) slope: f64,
    pub(super) to: f64,
}

impl RateFriction {
    /// The law of a model that has one.
    pub(super) fn new(model: &Model) -> Option<Self> {
        let law = model.slider().rate()?;
        let factors = Direction::BOTH.map(|way| law.factor(way));
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

    /// `μ_k` at a speed, for a factor of 1.
    pub(super) fn coefficient(&self, speed_m_per_s: f64) -> f64 {
        let slid =
            |&[from, width, slope]: &[f64; 3]| slope * (speed_m_per_s - from).clamp(0.0, width);
        let mu = self.base + self.pieces.iter().map(slid).sum::<f64>();
        if self.drop == 0.0 { mu } else { mu - self.faded(speed_m_per_s) }
    }

    /// `dμ_k/d|ṡ|` in s/m, for a factor of 1; at a corner of the line above it.
    pub(super) fn slope_s_per_m(&self, speed_m_per_s: f64) -> f64 {
        let within = |[from, width, _]: &&[f64; 3]| (*from..from + width).contains(&speed_m_per_s);
        let of_line = self.pieces.iter().find(within).map_or(0.0, |piece| piece[2]);
        of_line + self.rate_s_per_m * self.faded(speed_m_per_s)
    }

    /// `(μ_fast − μ_slow) exp(−α |ṡ|)`.
    fn faded(&self, speed_m_per_s: f64) -> f64 {
        self.drop * libm::exp(-self.rate_s_per_m * speed_m_per_s)
    }

    /// The straight line of `μ_k` on which a speed that grows or falls lies, where there are such: `v_i`, `μ_i` and the
    /// slope, and between which speeds. A speed is at a corner within this part of it.
    pub(super) fn line(&self, speed_m_per_s: f64, grows: bool, near: f64) -> Option<SpeedLine> {
        let last = self.pieces.last()?;
        let mut line =
            SpeedLine { from: last[0] + last[1], mu: 0.0, slope: 0.0, to: f64::INFINITY };
        for &[from, width, slope] in &self.pieces {
            let end = from + width;
            let margin = if grows { -near * end } else { near * end };
            if speed_m_per_s < end + margin {
                line = SpeedLine { from, mu: 0.0, slope, to: end };
                break;
            }
        }
        let factor = self.factors[0];
        line.mu = factor * self.coefficient(line.from);
        line.slope *= factor;
        Some(line)
    }

    /// Whether it is 0 at every speed.
    pub(super) fn is_none(&self) -> bool {
        let corners = self.pieces.iter().map(|[from, width, _]| from + width);
        corners.chain([0.0, 1.0]).all(|speed| self.coefficient(speed) == 0.0)
    }

    /// The straight piece of `μ_k` in which two speeds lie, for a factor of 1: between which speeds, and
    /// `μ_k = c + m |ṡ|`.
    pub(super) fn piece(&self, speeds_m_per_s: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        if self.drop != 0.0 {
            return None;
        }
        let ends = self.pieces.iter().map(|[from, width, _]| from + width);
        let starts = self.pieces.first().map(|piece| piece[0]);
        let corners = starts.into_iter().chain(ends);
        let mut band = [0.0, f64::INFINITY];
        for corner in corners {
            if speeds_m_per_s[0] < corner {
                band[1] = corner;
                break;
            }
            band[0] = corner;
        }
        let slope = self.pieces.iter().find(|piece| piece[0] == band[0]).map_or(0.0, |p| p[2]);
        // A steep line would lose digits of μ_k in c.
        let keeps = (slope * band[0]).abs() <= 1.0;
        let within = keeps && (band[0]..=band[1]).contains(&speeds_m_per_s[1]);
        within.then(|| (band, [self.coefficient(band[0]) - slope * band[0], slope]))
    }

    /// The largest size of `c` of its pieces, in a direction.
    pub(super) fn most(&self) -> f64 {
        let lines = self.pieces.iter().flat_map(|[from, width, slope]| {
            let mu = self.coefficient(*from);
            [mu - slope * from, mu + slope * width]
        });
        let most = lines.fold(self.base.abs(), |most, c| most.max(c.abs()));
        most * self.factors[0].max(self.factors[1])
    }

    /// Factor on the curve in a direction.
    pub(super) fn factor(&self, direction: Direction) -> f64 {
        direction.of(self.factors)
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
    use super::*;
    use crate::slider::{Friction, RateLaw};

    /// As the definition of the law has it, alone and piece by piece.
    #[test]
    fn is_the_law() {
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
                let mu = own.coefficient(speed);
                for way in Direction::BOTH {
                    let (found, expected) = (own.factor(way) * mu, law.at(speed, way));
                    assert!((found - expected).abs() < 1e-16, "{speed}: {found} {expected}");
                }
                if let Some((band, [c, m])) = own.piece([speed; 2]) {
                    assert!(band[0] <= speed && speed <= band[1] && own.pieces.len() > 1);
                    assert!((c + m * speed - mu).abs() < 1e-15, "{speed}: {c} {m} {mu}");
                }
            }
        }
    }
}
