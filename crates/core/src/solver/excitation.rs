//! The motion as the equations see it: along the slope with gravity's pull, and as normal force.

use std::borrow::Cow;

use crate::friction::{Direction, Friction};
use crate::linear::Load;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::response::Mode;

/// Loads of a model under a motion, and the bounds of its friction.
pub(super) struct Excitation<'a> {
    pub(super) times_s: &'a [f64],
    /// The step that all but a few intervals have; none where the sampling is uneven.
    pub(super) dt_s: Option<f64>,
    /// The other intervals, in order: jumps, an odd end, a gap.
    irregular: Vec<usize>,
    /// `a = Ü + g sin θ` at the samples.
    pub(super) acceleration: Cow<'a, [f64]>,
    /// `M_tot (g cos θ + Üv)` at the samples, negative where contact is lost; or one value.
    normal: Normal,
    static_friction: [f64; 2],
    kinetic_friction: [f64; 2],
}

enum Normal {
    Constant(f64),
    Varying(Vec<f64>),
}

/// A stretch of one sample interval over which all loads are linear.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    /// Index of the interval's first sample.
    pub(super) interval: usize,
    /// Start and end after that sample, in s.
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// `a` at the start and its rate.
    acceleration: f64,
    acceleration_rate: f64,
    /// `N ≥ 0` at the start and its rate.
    normal: f64,
    normal_rate: f64,
}

impl<'a> Excitation<'a> {
    pub(super) fn new(model: &Model, motion: &'a GroundMotion) -> Self {
        let slope = model.slope_m_per_s2();
        let (mass, gravity) = (model.total_mass_kg(), model.normal_gravity_m_per_s2());
        let friction: &Friction = &model.slider().friction;
        let (dt_s, irregular) = match motion.dt_s() {
            Some(dt_s) => (Some(dt_s), Vec::new()),
            None => regular_step(motion.times_s()),
        };
        let directions = [Direction::Positive, Direction::Negative];
        Self {
            times_s: motion.times_s(),
            dt_s,
            irregular,
            acceleration: if slope == 0.0 {
                Cow::Borrowed(motion.horizontal_m_per_s2())
            } else {
                motion.horizontal_m_per_s2().iter().map(|a| a + slope).collect()
            },
            normal: match motion.vertical_m_per_s2() {
                None => Normal::Constant(mass * gravity),
                Some(vertical) => {
                    Normal::Varying(vertical.iter().map(|a| mass * (gravity + a)).collect())
                }
            },
            static_friction: directions.map(|d| friction.static_coefficient(d)),
            kinetic_friction: directions.map(|d| friction.kinetic_coefficient(d)),
        }
    }

    /// End of the regular intervals that begin at a sample: the first sample whose interval has
    /// another length, or the last.
    pub(super) fn regular_end(&self, sample: usize) -> usize {
        let next = self.irregular.partition_point(|&interval| interval < sample);
        self.irregular.get(next).copied().unwrap_or(self.times_s.len() - 1)
    }

    /// Normal force at a sample, unclamped.
    #[inline(always)]
    pub(super) fn normal_at_sample(&self, sample: usize) -> f64 {
        match &self.normal {
            Normal::Constant(normal) => *normal,
            Normal::Varying(normal) => normal[sample],
        }
    }

    /// Normal forces at the samples, unclamped, where they vary.
    #[inline(always)]
    pub(super) fn varying_normal(&self) -> Option<&[f64]> {
        match &self.normal {
            Normal::Constant(_) => None,
            Normal::Varying(normal) => Some(normal),
        }
    }

    /// Normal forces at both ends of an interval, unclamped.
    #[inline(always)]
    pub(super) fn normal_n(&self, interval: usize) -> [f64; 2] {
        match &self.normal {
            Normal::Constant(normal) => [*normal; 2],
            Normal::Varying(normal) => [normal[interval], normal[interval + 1]],
        }
    }

    /// Where in an interval (as a part of it) contact is lost or regained.
    pub(super) fn kink(&self, interval: usize) -> Option<f64> {
        let [from, to] = self.normal_n(interval);
        (from * to < 0.0).then(|| from / (from - to))
    }

    /// The part of an interval between two times after its first sample; contact does not change
    /// in it.
    pub(super) fn stretch(&self, interval: usize, from_s: f64, to_s: f64) -> Stretch {
        let length_s = self.times_s[interval + 1] - self.times_s[interval];
        let over_length = 1.0 / length_s;
        let [a0, a1] = [self.acceleration[interval], self.acceleration[interval + 1]];
        let [n0, n1] = self.normal_n(interval);
        let acceleration_rate = (a1 - a0) * over_length;
        let normal_rate = (n1 - n0) * over_length;
        let middle = n0 + normal_rate * (0.5 * (from_s + to_s));
        let in_contact = middle > 0.0;
        Stretch {
            interval,
            from_s,
            to_s,
            acceleration: a0 + acceleration_rate * from_s,
            acceleration_rate,
            normal: if in_contact { (n0 + normal_rate * from_s).max(0.0) } else { 0.0 },
            normal_rate: if in_contact { normal_rate } else { 0.0 },
        }
    }

    /// Kinetic friction force over a normal force: `−μ_k sgn(ṡ)`.
    #[inline(always)]
    pub(super) fn kinetic(&self, direction: Direction) -> f64 {
        match direction {
            Direction::Positive => -self.kinetic_friction[0],
            Direction::Negative => self.kinetic_friction[1],
        }
    }

    /// Friction force of slip under a normal force, 0 in stick.
    #[inline(always)]
    pub(super) fn kinetic_n(&self, mode: Mode, normal: f64) -> f64 {
        match mode {
            Mode::Stick => 0.0,
            Mode::Slip(direction) => self.kinetic(direction) * normal,
        }
    }

    /// Static bounds over the normal force: `[−μ_s⁺, μ_s⁻]`.
    #[inline(always)]
    pub(super) fn bounds(&self) -> [f64; 2] {
        [-self.static_friction[0], self.static_friction[1]]
    }

    /// Load on a system in a mode that slides in `direction` (or sticks).
    #[inline(always)]
    pub(super) fn load(
        &self,
        stretch: &Stretch,
        from_s: f64,
        length_s: f64,
        direction: Option<Direction>,
    ) -> Load {
        let after_s = from_s - stretch.from_s;
        let coefficient = direction.map_or(0.0, |d| self.kinetic(d));
        Load {
            acceleration: stretch.acceleration + stretch.acceleration_rate * after_s,
            acceleration_change: stretch.acceleration_rate * length_s,
            friction: coefficient * stretch.normal_at(from_s),
            friction_change: coefficient * (stretch.normal_rate * length_s),
        }
    }

    /// Intervals of time in which contact is lost, in s.
    pub(super) fn contact_loss_s(&self) -> Vec<[f64; 2]> {
        let Normal::Varying(normal) = &self.normal else {
            return if self.normal_n(0)[0] < 0.0 {
                vec![[0.0, self.times_s[self.times_s.len() - 1]]]
            } else {
                Vec::new()
            };
        };
        let mut lost: Vec<[f64; 2]> = Vec::new();
        for i in 0..normal.len() - 1 {
            let [t0, t1] = [self.times_s[i], self.times_s[i + 1]];
            if t0 == t1 || (normal[i] >= 0.0 && normal[i + 1] >= 0.0) {
                continue;
            }
            let crossing = self.kink(i).map(|part| t0 + part * (t1 - t0));
            let from = if normal[i] < 0.0 { t0 } else { crossing.unwrap_or(t0) };
            let to = if normal[i + 1] < 0.0 { t1 } else { crossing.unwrap_or(t1) };
            match lost.last_mut() {
                Some(last) if last[1] == from => last[1] = to,
                _ => lost.push([from, to]),
            }
        }
        lost
    }
}

/// The step that most intervals have to within rounding, and the intervals that have another.
pub(super) fn regular_step(times_s: &[f64]) -> (Option<f64>, Vec<usize>) {
    let last = times_s.len() - 1;
    let slack_s = 8.0 * f64::EPSILON * times_s[last];
    let mut lengths_s: Vec<f64> = times_s.windows(2).map(|t| t[1] - t[0]).collect();
    let middle = lengths_s.len() / 2;
    let dt_s = *lengths_s.select_nth_unstable_by(middle, f64::total_cmp).1;
    let is_odd = |&i: &usize| (times_s[i + 1] - times_s[i] - dt_s).abs() > slack_s;
    let irregular: Vec<usize> = (0..last).filter(is_odd).collect();
    if dt_s > 0.0 && irregular.len() <= last / 4 {
        (Some(dt_s), irregular)
    } else {
        (None, Vec::new())
    }
}

impl Stretch {
    /// Normal force at a time after the interval's first sample, ≥ 0.
    #[inline(always)]
    pub(super) fn normal_at(&self, at_s: f64) -> f64 {
        (self.normal + self.normal_rate * (at_s - self.from_s)).max(0.0)
    }

    /// Change of the normal force in a second.
    #[inline(always)]
    pub(super) fn normal_rate(&self) -> f64 {
        self.normal_rate
    }
}
