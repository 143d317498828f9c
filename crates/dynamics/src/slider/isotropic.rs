//! Sliders that are the same in all horizontal directions.

use super::hold::Disc;
use super::{Bearing, Direction, Pressing, RateCurve, Restoring, Ring, Slider};

/// What a slider does along any direction.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Isotropic {
    /// The forces that friction holds, in N.
    pub(crate) hold: Disc,
    pub(crate) kinetic: IsotropicFriction,
    /// `K1` in N/m without that of a pendulum, which is `N/R`: `1/R` in 1/m, 0 without one.
    pub(crate) stiffness_n_per_m: f64,
    pub(crate) per_radius: f64,
    /// The stop around it.
    pub(crate) ring: Option<Ring>,
}

/// `μ_k` by the sliding speed `r`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IsotropicFriction {
    curve: Curve,
    /// The normal force that it is of.
    pressing: Pressing,
}

#[derive(Clone, Debug, PartialEq)]
enum Curve {
    /// `at_rest + gain (1 − e^(−α r))`, with `α` in s/m.
    Smooth { at_rest: f64, gain: f64, rate_s_per_m: f64 },
    /// Straight lines from corner to corner, the last of which goes on without end.
    Lines(Vec<SpeedLine>),
}

/// A straight line of a coefficient by the speed: from a speed in m/s on, at which it has a value.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SpeedLine {
    from_m_per_s: f64,
    value: f64,
    slope_s_per_m: f64,
}

impl SpeedLine {
    fn at(&self, speed: f64) -> f64 {
        self.value + self.slope_s_per_m * (speed - self.from_m_per_s)
    }
}

impl IsotropicFriction {
    /// Whether it is the same at all speeds.
    #[inline(always)]
    pub(crate) fn is_constant(&self) -> bool {
        match &self.curve {
            Curve::Smooth { gain, rate_s_per_m, .. } => *gain == 0.0 || *rate_s_per_m == 0.0,
            Curve::Lines(lines) => lines.iter().all(|line| line.slope_s_per_m == 0.0),
        }
    }

    /// Whether it has corners: speeds at which one line ends and another begins.
    pub(crate) fn has_corners(&self) -> bool {
        matches!(&self.curve, Curve::Lines(lines) if lines.len() > 1)
    }

    /// The line on which a speed that grows or falls lies, as a law without corners, and the speeds between which it does. A
    /// speed is at a corner if it is as near to it as a part of it.
    pub(crate) fn line_of(&self, speed: f64, grows: bool, near: f64) -> (Self, [f64; 2]) {
        let Curve::Lines(lines) = &self.curve else { return (self.clone(), [0.0, f64::INFINITY]) };
        let is_passed = |corner: f64| {
            let near = near * corner;
            if grows { speed >= corner - near } else { speed > corner + near }
        };
        let passed = lines[1..].iter().take_while(|line| is_passed(line.from_m_per_s)).count();
        let end = lines.get(passed + 1).map_or(f64::INFINITY, |next| next.from_m_per_s);
        let line = Self { curve: Curve::Lines(vec![lines[passed]]), pressing: self.pressing };
        (line, [lines[passed].from_m_per_s, end])
    }

    /// Its least and largest value up to a speed.
    pub(crate) fn range_up_to(&self, speed: f64) -> [f64; 2] {
        let (first, last) = (self.at(0.0), self.at(speed));
        let (mut least, mut most) = (first.min(last), first.max(last));
        if let Curve::Lines(lines) = &self.curve {
            for line in lines.iter().take_while(|line| line.from_m_per_s < speed) {
                (least, most) = (least.min(line.value), most.max(line.value));
            }
        }
        [least, most]
    }

    /// Whether there is none at any speed.
    pub(crate) fn is_none(&self) -> bool {
        self.at(0.0) == 0.0 && self.is_constant()
    }

    /// The normal force that friction follows, under a normal force.
    #[inline(always)]
    pub(crate) fn pressing_n(&self, normal_n: f64) -> f64 {
        self.pressing.of(normal_n)
    }

    /// Friction at a speed in m/s under a normal force.
    pub(crate) fn force(&self, speed: f64, normal_n: f64) -> f64 {
        self.at(speed) * self.pressing.of(normal_n)
    }

    /// `μ_k` at a speed in m/s.
    pub(crate) fn at(&self, speed: f64) -> f64 {
        match &self.curve {
            Curve::Smooth { at_rest, gain, rate_s_per_m } => {
                at_rest - gain * libm::expm1(-rate_s_per_m * speed)
            }
            Curve::Lines(lines) => {
                let passed = lines[1..].iter().take_while(|line| line.from_m_per_s <= speed);
                lines[passed.count()].at(speed)
            }
        }
    }

    /// How fast that grows with the speed, in s/m.
    pub(crate) fn slope_at(&self, speed: f64) -> f64 {
        match &self.curve {
            Curve::Smooth { gain, rate_s_per_m, .. } => {
                gain * rate_s_per_m * libm::exp(-rate_s_per_m * speed)
            }
            Curve::Lines(lines) => {
                let passed = lines[1..].iter().take_while(|line| line.from_m_per_s <= speed);
                lines[passed.count()].slope_s_per_m
            }
        }
    }

    /// This friction times a factor.
    pub(crate) fn times(&self, factor: f64) -> Self {
        let curve = match &self.curve {
            Curve::Smooth { at_rest, gain, rate_s_per_m } => Curve::Smooth {
                at_rest: factor * at_rest,
                gain: factor * gain,
                rate_s_per_m: *rate_s_per_m,
            },
            Curve::Lines(lines) => Curve::Lines(
                lines
                    .iter()
                    .map(|line| SpeedLine {
                        value: factor * line.value,
                        slope_s_per_m: factor * line.slope_s_per_m,
                        ..*line
                    })
                    .collect(),
            ),
        };
        Self { curve, pressing: self.pressing }
    }
}

/// The lines between corners, and beyond the last, times a factor.
fn lines(speeds_m_per_s: &[f64], coefficients: &[f64], factor: f64) -> Vec<SpeedLine> {
    let corners: Vec<[f64; 2]> =
        speeds_m_per_s.iter().zip(coefficients).map(|(v, mu)| [*v, factor * mu]).collect();
    let of = |(i, [from, value]): (usize, &[f64; 2])| {
        let rise = |[to, next]: &[f64; 2]| (next - value) / (to - from);
        let slope_s_per_m = corners.get(i + 1).map_or(0.0, rise);
        SpeedLine { from_m_per_s: *from, value: *value, slope_s_per_m }
    };
    corners.iter().enumerate().map(of).collect()
}

impl Slider {
    /// The slider as one that is the same in all directions, with the normal force at rest.
    ///
    /// # Errors
    /// What of it is not, or does not slide in two directions.
    pub(crate) fn isotropic(&self, normal_n: f64) -> Result<Isotropic, &'static str> {
        let Bearing::Surface { restoring, friction } = &self.bearing else {
            return Err("surfaces in series");
        };
        let [fixed, at_rest] = self.coefficients();
        let at_rest_alike = at_rest[0] == at_rest[1];
        let pressing = Pressing::new(friction.pressure(), normal_n);
        let at_rest = at_rest[0];
        let (curve, alike) = match friction.rate() {
            None => (Curve::Smooth { at_rest, gain: 0.0, rate_s_per_m: 0.0 }, at_rest_alike),
            Some(law) => {
                let [factor, other] = Direction::BOTH.map(|way| law.factor(way));
                let curve = match law.curve() {
                    RateCurve::Exponential { slow, fast, rate_s_per_m } => {
                        let gain = factor * (fast - slow);
                        Curve::Smooth { at_rest, gain, rate_s_per_m: *rate_s_per_m }
                    }
                    RateCurve::Pieces { speeds_m_per_s, coefficients } => {
                        Curve::Lines(lines(speeds_m_per_s, coefficients, factor))
                    }
                };
                (curve, factor == other)
            }
        };
        let kinetic = IsotropicFriction { curve, pressing };
        if fixed[0] != fixed[1] || !alike {
            return Err("friction by direction");
        }
        let ring = self.stop().map(Ring::of).transpose()?;
        let (stiffness_n_per_m, per_radius) = match *restoring {
            Restoring::None => (0.0, 0.0),
            Restoring::Spring { stiffness_n_per_m } => (stiffness_n_per_m, 0.0),
            Restoring::Pendulum { radius_m } => (0.0, 1.0 / radius_m),
        };
        let hold = Disc { of_normal: fixed[0], pressing };
        Ok(Isotropic { hold, kinetic, stiffness_n_per_m, per_radius, ring })
    }
}
