//! The motion as the check reads it: straight pieces and one-sided limits.

use crate::model::Model;
use crate::motion::GroundMotion;

/// What the table does at one instant, on one side of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Load {
    /// `Ü` in m/s².
    pub(super) table: f64,
    /// `a = Ü + g sin θ` in m/s².
    pub(super) a: f64,
    /// `N` in N.
    pub(super) normal: f64,
    /// `dÜ/dt` on that side in m/s³.
    pub(super) slope: f64,
    /// `dN/dt` on that side in N/s.
    pub(super) normal_slope: f64,
}

impl Load {
    /// What the rounding of times makes of `N`, in N: `δt |dN/dt| + 8 ε N` under vertical motion, with the
    /// largest `N`.
    pub(super) fn normal_rounding(&self, (instant_s, normal): (f64, f64)) -> f64 {
        let normal = if self.normal_slope == 0.0 { 0.0 } else { normal };
        instant_s * self.normal_slope.abs() + 8.0 * f64::EPSILON * normal
    }

    /// Rounding of a force on a mass, in N: `m |dÜ/dt| δt`.
    pub(super) fn rounding_of_mass(&self, instant_s: f64, mass_kg: f64) -> f64 {
        instant_s * mass_kg * self.slope.abs()
    }
}

/// Largest change of `N` over a piece, as a part of it, where friction follows a power of it; and what of that at rest is
/// no normal force for this.
const MOST_CHANGE: f64 = 0.3;
const NO_PRESS: f64 = 1e-10;

/// A stretch in which `a` and `N` are linear.
pub(super) struct Piece {
    pub(super) to_s: f64,
    pub(super) loads: [Load; 2],
}

/// Which of the loads at an instant are nearest to what is stored, by how far each is off.
pub(super) fn nearest(off: [f64; 4]) -> [bool; 4] {
    let least = off.into_iter().fold(f64::INFINITY, f64::min);
    off.map(|off| off <= least)
}

/// A motion under a model: its accelerations with the slope, and the normal force.
pub(super) struct Ground<'a> {
    times_s: &'a [f64],
    horizontal: &'a [f64],
    vertical: Option<&'a [f64]>,
    slope: f64,
    gravity: f64,
    total_kg: f64,
    /// Whether friction follows a power of `N`, of which a piece takes no more than a part.
    follows_pressure: bool,
    /// Index of the sample at or before the last piece asked for.
    cursor: usize,
    /// Rounding of a time, and the largest `N` up to the end.
    load_rounding: (f64, f64),
}

impl<'a> Ground<'a> {
    pub(super) fn new(model: &Model, motion: &'a GroundMotion, end_s: f64) -> Self {
        Self::of(model, motion, (motion.horizontal_m_per_s2(), model.slope_m_per_s2()), end_s)
    }

    /// The ground of one horizontal component, with the slope's pull along it.
    pub(super) fn of(
        model: &Model,
        motion: &'a GroundMotion,
        (horizontal, slope): (&'a [f64], f64),
        end_s: f64,
    ) -> Self {
        let mut ground = Self {
            times_s: motion.times_s(),
            horizontal,
            vertical: motion.vertical_m_per_s2(),
            slope,
            gravity: model.normal_gravity_m_per_s2(),
            total_kg: model.total_mass_kg(),
            follows_pressure: model
                .slider()
                .pressure_exponent(motion.vertical_m_per_s2().is_some())
                .is_some(),
            cursor: 0,
            load_rounding: (8.0 * f64::EPSILON * end_s, 0.0),
        };
        ground.load_rounding.1 = ground.largest(end_s).0;
        ground
    }

    /// Rounding of a time, and the largest `N`.
    pub(super) fn load_rounding(&self) -> (f64, f64) {
        self.load_rounding
    }

    /// Moves to the last sample at or before a time.
    fn seek(&mut self, from_s: f64) {
        let times = self.times_s;
        if times[self.cursor] > from_s {
            self.cursor = times.partition_point(|&t| t <= from_s).saturating_sub(1);
        }
        while self.cursor + 1 < times.len() && times[self.cursor + 1] <= from_s {
            self.cursor += 1;
        }
    }

    /// The piece from `from_s` on, no longer than to `end_s`; ends where contact is lost or found, and where friction
    /// follows a power of `N` before that has changed much.
    /// Quick where the times asked for do not decrease.
    pub(super) fn piece(&mut self, from_s: f64, end_s: f64) -> Piece {
        self.seek(from_s);
        let (times, i) = (self.times_s, self.cursor);
        if i + 1 == times.len() {
            return Piece { to_s: end_s, loads: [self.at_rest(); 2] };
        }
        let is_whole = from_s == times[i] && end_s == times[i + 1] && !self.follows_pressure;
        if is_whole && self.press(i) * self.press(i + 1) >= 0.0 {
            let [from, to] = [i, i + 1].map(|i| (self.horizontal[i], self.press(i)));
            let slopes = self.slopes(i);
            let loads = [self.load(from, slopes), self.load(to, slopes)];
            return Piece { to_s: end_s, loads };
        }
        let mut to_s = end_s.min(times[i + 1]);
        let [from, to] = [from_s, to_s].map(|t| self.between(i, t));
        let (mut to, mut from) = (to, from);
        if from.1 * to.1 < 0.0 {
            let crossing_s = from_s + (to_s - from_s) * (from.1 / (from.1 - to.1));
            if from_s < crossing_s && crossing_s < to_s {
                to_s = crossing_s;
                to = (self.between(i, to_s).0, 0.0);
            } else if crossing_s <= from_s {
                // Within the rounding of the time.
                from.1 = 0.0;
            } else {
                to.1 = 0.0;
            }
        }
        let slopes = self.slopes(i);
        if self.follows_pressure {
            let most = MOST_CHANGE * from.1.max(NO_PRESS * self.gravity);
            let cut_s = from_s + most / slopes[1].abs();
            if cut_s < to_s && from_s < cut_s && from.1 + to.1 > 0.0 {
                (to_s, to) = (cut_s, self.between(i, cut_s));
            }
        }
        Piece { to_s, loads: [self.load(from, slopes), self.load(to, slopes)] }
    }

    /// All that the table does at one instant: the limit from the left, the samples at that time,
    /// the limit from the right. They differ at a jump; at the first and last sample, before and
    /// after which the table is at rest, there may be three.
    pub(super) fn instant(&self, t: f64) -> [Load; 4] {
        let times = self.times_s;
        let n = times.len();
        let inside = |i: usize| self.load(self.between(i, t), self.slopes(i));
        let sample = |i: usize| self.load((self.horizontal[i], self.press(i)), [0.0; 2]);
        let first = times.partition_point(|&s| s < t);
        let after = times.partition_point(|&s| s <= t);
        let left = if first == 0 || first == n { self.at_rest() } else { inside(first - 1) };
        let right = if after == 0 || after == n { self.at_rest() } else { inside(after - 1) };
        if first == after {
            return [left, left, right, right];
        }
        [left, sample(first), sample(after - 1), right]
    }

    /// Whether there is a sample at the time from which the last piece was asked for.
    pub(super) fn is_at_sample(&self, from_s: f64) -> bool {
        self.times_s[self.cursor] == from_s
    }

    /// Largest `N` and largest `|Ü|` up to a time.
    pub(super) fn largest(&self, end_s: f64) -> (f64, f64) {
        let samples = self.times_s.partition_point(|&t| t <= end_s);
        let most = |list: &[f64], from: f64| list[..samples].iter().fold(from, |m, x| m.max(*x));
        let table = self.horizontal[..samples].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let up = self.vertical.map_or(0.0, |vertical| most(vertical, 0.0));
        (self.load((0.0, self.gravity + up), [0.0; 2]).normal, table)
    }

    /// Whether the normal force varies.
    pub(super) fn has_vertical(&self) -> bool {
        self.vertical.is_some()
    }

    /// What the rounding of times and of `g cos θ + Üv` makes of `N` at most; 0 without vertical motion.
    pub(super) fn normal_rounding(&self, instant_s: f64, normal: f64) -> f64 {
        let Some(vertical) = self.vertical else { return 0.0 };
        let times = self.times_s.windows(2);
        let rates = times.zip(vertical.windows(2)).filter(|(t, _)| t[1] > t[0]);
        let rates = rates.map(|(t, v)| ((v[1] - v[0]) / (t[1] - t[0])).abs());
        instant_s * self.total_kg * rates.fold(0.0, f64::max) + 8.0 * f64::EPSILON * normal
    }

    fn at_rest(&self) -> Load {
        self.load((0.0, self.gravity), [0.0; 2])
    }

    fn load(&self, (table, press): (f64, f64), [slope, press_slope]: [f64; 2]) -> Load {
        let normal = self.total_kg * press.max(0.0);
        let normal_slope = self.total_kg * press_slope;
        Load { table, a: table + self.slope, normal, slope, normal_slope }
    }

    /// `dÜ/dt` and `dÜv/dt` between the samples `i` and `i + 1`.
    fn slopes(&self, i: usize) -> [f64; 2] {
        let length_s = self.times_s[i + 1] - self.times_s[i];
        let of = |list: &[f64]| (list[i + 1] - list[i]) / length_s;
        [of(self.horizontal), self.vertical.map_or(0.0, of)]
    }

    /// `g cos θ + Üv` at a sample.
    fn press(&self, i: usize) -> f64 {
        self.gravity + self.vertical.map_or(0.0, |v| v[i])
    }

    /// `Ü` and `g cos θ + Üv` at a time between the samples `i` and `i + 1`.
    fn between(&self, i: usize, t: f64) -> (f64, f64) {
        let (t0, t1) = (self.times_s[i], self.times_s[i + 1]);
        if t <= t0 {
            return (self.horizontal[i], self.press(i));
        }
        if t >= t1 {
            return (self.horizontal[i + 1], self.press(i + 1));
        }
        let part = (t - t0) / (t1 - t0);
        let linear = |from: f64, to: f64| from + (to - from) * part;
        let table = linear(self.horizontal[i], self.horizontal[i + 1]);
        (table, linear(self.press(i), self.press(i + 1)))
    }
}

/// The load at a fraction of a stretch.
pub(super) fn between([from, to]: [Load; 2], t: f64) -> Load {
    let linear = |from: f64, to: f64| from + (to - from) * t;
    Load {
        table: linear(from.table, to.table),
        a: linear(from.a, to.a),
        normal: linear(from.normal, to.normal),
        slope: from.slope,
        normal_slope: from.normal_slope,
    }
}
