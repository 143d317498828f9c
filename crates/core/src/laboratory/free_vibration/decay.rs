//! Free vibration of one mode under viscous damping and dry friction, exactly.
//!
//! ```text
//! ẍ + 2ξω ẋ + ω² x = −a_f sgn ẋ
//! ```
//!
//! with the friction force over the mass, `a_f`. From one reversal to the next `x + s a_f/ω²`, `s = sgn ẋ`, is a damped
//! oscillation, and half a period passes; at a reversal within `a_f/ω²` of the middle it stops (Den Hartog,
//! Trans. ASME 53, 1931, for free vibration).

use core::f64::consts::PI;

/// What of the vibration was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// `x`.
    Displacement,
    /// `ẋ`.
    Velocity,
    /// `ẍ`.
    Acceleration,
}

/// A vibration that decays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Decay {
    /// Angular frequency in rad/s.
    pub omega: f64,
    /// Ratio of critical damping, below 1.
    pub damping_ratio: f64,
    /// Friction over mass in m/s² of the unit of the values.
    pub friction: f64,
    /// Displacement at the start.
    pub x: f64,
    /// Velocity at the start.
    pub v: f64,
}

/// One way, from a reversal or the start.
#[derive(Clone, Copy)]
struct Stroke {
    from_s: f64,
    to_s: f64,
    /// +1 or −1; 0 at rest.
    way: f64,
    x: f64,
    v: f64,
}

impl Decay {
    fn half_period_s(&self) -> f64 {
        PI / self.damped()
    }

    fn damped(&self) -> f64 {
        self.omega * (1.0 - self.damping_ratio * self.damping_ratio).sqrt()
    }

    /// The stroke from a state on.
    fn stroke(&self, from_s: f64, x: f64, v: f64) -> Stroke {
        let reach = self.friction / (self.omega * self.omega);
        if v == 0.0 {
            if x.abs() <= reach {
                return Stroke { from_s, to_s: f64::INFINITY, way: 0.0, x, v };
            }
            return Stroke { from_s, to_s: from_s + self.half_period_s(), way: -x.signum(), x, v };
        }
        let way = v.signum();
        let y = x + way * reach;
        let rate = self.omega * self.omega * y + self.damping_ratio * self.omega * v;
        let angle = libm::atan2(way * v * self.damped(), way * rate);
        Stroke { from_s, to_s: from_s + angle / self.damped(), way, x, v }
    }

    /// Displacement, velocity and acceleration in a stroke.
    fn at(&self, stroke: &Stroke, time_s: f64) -> [f64; 3] {
        if stroke.way == 0.0 {
            return [stroke.x, 0.0, 0.0];
        }
        let (w, xi, wd) = (self.omega, self.damping_ratio, self.damped());
        let reach = stroke.way * self.friction / (w * w);
        let t = time_s - stroke.from_s;
        let (y0, v0) = (stroke.x + reach, stroke.v);
        let decay = libm::exp(-xi * w * t);
        let (sin, cos) = libm::sincos(wd * t);
        let y = decay * (y0 * cos + (v0 + xi * w * y0) / wd * sin);
        let v = decay * (v0 * cos - (w * w * y0 + xi * w * v0) / wd * sin);
        [y - reach, v, -w * w * y - 2.0 * xi * w * v]
    }

    /// The values of a quantity at times in s from the start, which do not decrease.
    pub(super) fn values(&self, times_s: &[f64], motion: Motion) -> Vec<f64> {
        let mut stroke = self.stroke(0.0, self.x, self.v);
        let of = match motion {
            Motion::Displacement => 0,
            Motion::Velocity => 1,
            Motion::Acceleration => 2,
        };
        let value = |time_s: &f64| {
            while *time_s > stroke.to_s {
                let [x, ..] = self.at(&stroke, stroke.to_s);
                stroke = self.stroke(stroke.to_s, x, 0.0);
            }
            self.at(&stroke, *time_s)[of]
        };
        times_s.iter().map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every half period takes `2 a_f/ω²` off the amplitude, and the mass stops within `a_f/ω²`.
    #[test]
    fn closed_form_under_dry_friction() {
        let omega = 2.0 * PI;
        let reach = 0.03;
        let friction = reach * omega * omega;
        let decay = Decay { omega, damping_ratio: 0.0, friction, x: 1.0, v: 0.0 };
        let times: Vec<f64> = (0..60).map(|k| 0.5 * f64::from(k)).collect();
        let found = decay.values(&times, Motion::Displacement);
        for (k, x) in found.iter().enumerate().take(16) {
            let amplitude = 1.0 - 2.0 * reach * k as f64;
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            assert!((x - sign * amplitude).abs() < 1e-12, "{k} {x}");
        }
        // 1 − 0.06 · 17 is −0.02: within the reach, at rest.
        assert!((found[17] - found[59]).abs() < 1e-15 && found[59].abs() < reach);
    }

    /// The logarithmic decrement, and both together: `y` falls by `e^(−πξ/√(1−ξ²))` each half period.
    #[test]
    fn closed_form_under_both() {
        let (omega, xi, reach) = (2.0 * PI, 0.02, 0.01);
        let decay =
            Decay { omega, damping_ratio: xi, friction: reach * omega * omega, x: 1.0, v: 0.0 };
        let half_s = decay.half_period_s();
        let q = libm::exp(-PI * xi / (1.0 - xi * xi).sqrt());
        let mut amplitude: f64 = 1.0;
        let times: Vec<f64> = (0..8).map(|k| half_s * f64::from(k)).collect();
        for (k, x) in decay.values(&times, Motion::Displacement).iter().enumerate() {
            assert!((x.abs() - amplitude).abs() < 1e-12, "{k} {x} {amplitude}");
            amplitude = (amplitude - reach) * q - reach;
        }
        // A start on the way has the same future.
        let late = decay.values(&[0.3], Motion::Displacement)[0];
        let speed = decay.values(&[0.3], Motion::Velocity)[0];
        let after = Decay { x: late, v: speed, ..decay };
        let found = after.values(&[0.9], Motion::Acceleration)[0];
        assert!((found - decay.values(&[1.2], Motion::Acceleration)[0]).abs() < 1e-10);
    }
}
