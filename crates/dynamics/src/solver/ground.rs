//! The motion as the equations see it: along the slope with gravity's pull, and as normal force.

use std::sync::OnceLock;

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::windows::Windows;
use crate::linear::lanes::{greatest, largest_lane, least, sum_of_lanes};
use crate::linear::{BATCH, Load, Window};
use crate::model::Model;
use crate::motion::GroundMotion;

/// How a motion is sampled.
#[derive(Debug)]
pub(super) struct Sampling {
    /// The step that all but a few intervals have; none where the sampling is uneven.
    pub(super) dt_s: Option<f64>,
    /// The other intervals, in order: jumps, an odd end, a gap.
    irregular: Vec<usize>,
    /// Made where they are first needed.
    windows: OnceLock<Windows>,
}

impl Sampling {
    /// That of a motion.
    pub(super) fn new(motion: &GroundMotion) -> Self {
        let (dt_s, irregular) = match motion.dt_s() {
            Some(dt_s) => (Some(dt_s), Vec::new()),
            None => regular_step(motion.times_s()),
        };
        Self { dt_s, irregular, windows: OnceLock::new() }
    }

    /// Largest sizes of the motion over windows.
    #[inline(always)]
    pub(super) fn windows<S: Simd>(&self, simd: S, table: &[f64]) -> &Windows {
        self.windows.get_or_init(|| Windows::new(simd, table))
    }

    /// End of the regular intervals that begin at a sample: the first sample whose interval has
    /// another length, or the last.
    #[inline(always)]
    pub(super) fn regular_end(&self, sample: usize, last: usize) -> usize {
        if self.irregular.is_empty() {
            return last;
        }
        let next = self.irregular.partition_point(|&interval| interval < sample);
        self.irregular.get(next).copied().unwrap_or(last)
    }
}

/// Largest size in a batch.
#[inline(always)]
pub(super) fn largest_size<S: Simd>(simd: S, x: &Window) -> f64 {
    let [first, rest @ ..] = x;
    greatest(first.abs(), largest_lane(simd, f64x8::from_slice(simd, rest).abs()))
}

/// Least value in a batch.
#[inline(always)]
fn smallest<S: Simd>(simd: S, x: &Window) -> f64 {
    let [first, rest @ ..] = x;
    least(*first, -largest_lane(simd, -f64x8::from_slice(simd, rest)))
}

/// How a signal varies within a batch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roughness {
    /// Sum of |x_{i+1} − x_i|.
    pub(super) variation: f64,
    /// Sum of |x_{i+1} − 2 x_i + x_{i−1}| at the samples within.
    pub(super) kinks: f64,
    /// Largest |x_{i+1} − x_i|.
    pub(super) change: f64,
}

impl Roughness {
    /// That of the samples of a batch.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, x: &Window) -> Self {
        // A closure that is called twice would not be inlined into the vectorized work.
        #[inline(always)]
        fn four<S: Simd>(simd: S, x: &Window, first: usize) -> f64x4<S> {
            f64x4::from_slice(simd, &x[first..first + 4])
        }
        let (a, b, c) = (four(simd, x, 0), four(simd, x, 1), four(simd, x, 2));
        let (d, e, f) = (four(simd, x, 3), four(simd, x, 4), four(simd, x, 5));
        let [early, late] = [(b - a).abs(), (f - e).abs()];
        // Both fours have the kink in the middle.
        let [before, after] = [((c - b) - (b - a)).abs(), ((f - e) - (e - d)).abs()];
        let after = after * f64x4::from_slice(simd, &[0.0, 1.0, 1.0, 1.0]);
        Self {
            variation: sum_of_lanes(early + late),
            kinks: sum_of_lanes(before + after),
            change: {
                let [a, b, c, d] = late.simd_gt(early).select(late, early).to_array();
                greatest(greatest(a, b), greatest(c, d))
            },
        }
    }
}

/// Loads of a model under a motion.
#[derive(Clone, Copy)]
pub(super) struct Ground<'a> {
    pub(super) times_s: &'a [f64],
    /// `Ü` at the samples.
    pub(super) table: &'a [f64],
    /// `a = Ü + g sin θ` at the samples.
    pub(super) acceleration: &'a [f64],
    pub(super) normal: Normal<'a>,
    pub(super) sampling: &'a Sampling,
}

/// The ground along y.
#[derive(Clone, Copy)]
pub(super) struct GroundAlongY<'a> {
    pub(super) table: &'a [f64],
    pub(super) acceleration: &'a [f64],
}

/// `M_tot (g cos θ + Üv)` at the samples, negative where contact is lost; or one value.
#[derive(Clone, Copy)]
pub(super) enum Normal<'a> {
    Constant(f64),
    Varying(&'a [f64]),
}

/// `M_tot (g cos θ + Üv)` at the samples, where there is vertical motion.
pub(super) fn varying_normal<'a>(
    model: &Model,
    motion: &'a GroundMotion,
) -> Option<impl Iterator<Item = f64> + 'a> {
    let (mass_kg, gravity) = (model.total_mass_kg(), model.normal_gravity_m_per_s2());
    let vertical = motion.vertical_m_per_s2()?;
    Some(vertical.iter().map(move |a| mass_kg * (gravity + a)))
}

impl<'a> Normal<'a> {
    /// That of a model, varying where there is vertical motion.
    pub(super) fn new(model: &Model, varying: Option<&'a [f64]>) -> Self {
        varying.map_or(Self::Constant(model.normal_n()), Self::Varying)
    }
}

impl<'a> Normal<'a> {
    /// At the samples of a batch, where it varies.
    #[inline(always)]
    pub(super) fn window(&self, sample: usize) -> Option<&'a Window> {
        match self {
            Self::Constant(_) => None,
            Self::Varying(normal) => normal[sample..].first_chunk(),
        }
    }

    /// Least in a batch from a sample.
    #[inline(always)]
    pub(super) fn least<S: Simd>(&self, simd: S, sample: usize) -> f64 {
        match self {
            Self::Constant(normal) => *normal,
            Self::Varying(normal) => {
                normal[sample..].first_chunk().map_or(0.0, |normal| smallest(simd, normal))
            }
        }
    }

    /// At the eight samples after one, and at that one.
    #[inline(always)]
    pub(super) fn values<S: Simd>(&self, simd: S, sample: usize) -> (f64x8<S>, f64) {
        match self {
            Self::Constant(normal) => (f64x8::splat(simd, *normal), *normal),
            Self::Varying(normal) => {
                (f64x8::from_slice(simd, &normal[sample + 1..][..BATCH]), normal[sample])
            }
        }
    }
}

/// The time in s over which a jump is walked as a ramp: nothing moves meanwhile, but its accelerations
/// have their order. 2^−200 s.
const RAMP_S: f64 = f64::from_bits((1023 - 200) << 52);

/// How long the loads stand after it: 2^30 times that.
const STANDING_S: f64 = f64::from_bits((1023 - 170) << 52);

/// A stretch of one sample interval over which all loads are linear.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    /// Index of the interval's first sample.
    pub(super) interval: usize,
    /// Start and end after that sample, in s.
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    acceleration: f64,
    pub(super) acceleration_rate: f64,
    /// Normal force at `normal_from_s`: 0 where contact changes, which has no rounding.
    normal: f64,
    normal_from_s: f64,
    pub(super) normal_rate: f64,
}

impl Stretch {
    /// Loads over a length from a time, under a friction force of this part of the normal force.
    #[inline(always)]
    pub(super) fn load(&self, at_s: f64, length_s: f64, coefficient: f64) -> Load {
        Load {
            acceleration: self.acceleration_at(at_s),
            acceleration_change: self.acceleration_rate * length_s,
            force: coefficient * self.normal_at(at_s),
            force_change: coefficient * (self.normal_rate * length_s),
        }
    }
}

impl Ground<'_> {
    /// Normal force at a sample, unclamped.
    #[inline(always)]
    pub(super) fn normal_at(&self, sample: usize) -> f64 {
        match self.normal {
            Normal::Constant(normal) => normal,
            Normal::Varying(normal) => normal[sample],
        }
    }

    /// Normal forces at both ends of an interval, unclamped.
    #[inline(always)]
    fn normals(&self, interval: usize) -> [f64; 2] {
        match self.normal {
            Normal::Constant(normal) => [normal; 2],
            Normal::Varying(normal) => [normal[interval], normal[interval + 1]],
        }
    }

    /// Whether an interval starts where nothing was before: at t = 0, or after a jump, whose left side
    /// stands recorded already.
    pub(super) fn starts_anew(&self, interval: usize) -> bool {
        interval == 0 || self.times_s[interval - 1] == self.times_s[interval]
    }

    /// The loads before a jump at the first sample, where there is one.
    pub(super) fn before_first_jump(&self) -> Option<Stretch> {
        (self.times_s[0] == self.times_s[1]).then(|| self.standing(0))
    }

    /// The loads after a jump at the last sample, where there is one.
    pub(super) fn after_last_jump(&self) -> Option<Stretch> {
        let last = self.times_s.len() - 1;
        (self.times_s[last] == self.times_s[last - 1]).then(|| self.standing(last))
    }

    /// The loads of a sample, which stand.
    fn standing(&self, sample: usize) -> Stretch {
        let loads = [self.acceleration[sample], self.normal_at(sample)];
        Stretch::standing(sample, loads, 1.0)
    }

    /// `Ü` at a time after an interval's first sample.
    pub(super) fn table_at(&self, interval: usize, at_s: f64) -> f64 {
        let length_s = self.times_s[interval + 1] - self.times_s[interval];
        let [from, to] = [self.table[interval], self.table[interval + 1]];
        from + (to - from) * (at_s / length_s)
    }

    /// An interval from a time after its first sample, cut where contact changes.
    #[inline(always)]
    pub(super) fn stretches(&self, interval: usize, from_s: f64) -> [Option<Stretch>; 2] {
        let length_s = self.times_s[interval + 1] - self.times_s[interval];
        let accelerations = [self.acceleration[interval], self.acceleration[interval + 1]];
        Stretch::cut(interval, length_s, accelerations, self.normals(interval), from_s)
    }

    /// The part of an interval between two times after its first sample; contact does not change
    /// in it.
    #[inline(always)]
    pub(super) fn stretch(&self, interval: usize, from_s: f64, to_s: f64) -> Stretch {
        let length_s = self.times_s[interval + 1] - self.times_s[interval];
        let accelerations = [self.acceleration[interval], self.acceleration[interval + 1]];
        Stretch::new(interval, length_s, accelerations, self.normals(interval), [from_s, to_s])
    }
}

/// The steep ramp that a jump of acceleration and normal force at a sample is the limit of, cut where
/// contact changes, and the loads after it, which stand for as long as what has started may take to stop.
pub(super) fn jump(sample: usize, from: [f64; 2], to: [f64; 2]) -> Vec<Stretch> {
    let [a, n] = [0, 1].map(|i| [from[i], to[i]]);
    let ramp = Stretch::cut(sample, RAMP_S, a, n, 0.0);
    let standing = Stretch::standing(sample, to, STANDING_S);
    ramp.into_iter().flatten().chain([standing]).collect()
}

/// Where in an interval between two normal forces (as a part of it) contact is lost or regained.
#[inline(always)]
fn change([from, to]: [f64; 2]) -> Option<f64> {
    (from * to < 0.0).then(|| from / (from - to))
}

/// Intervals of time in which contact is lost, in s.
pub(super) fn contact_loss_s(times_s: &[f64], normal: Normal<'_>) -> Vec<[f64; 2]> {
    let normal = match normal {
        Normal::Constant(normal) if normal < 0.0 => return vec![[0.0, times_s[times_s.len() - 1]]],
        Normal::Constant(_) => return Vec::new(),
        Normal::Varying(normal) => normal,
    };
    let mut lost: Vec<[f64; 2]> = Vec::new();
    for (t, n) in times_s.windows(2).zip(normal.windows(2)) {
        let ([t0, t1], [n0, n1]) = ([t[0], t[1]], [n[0], n[1]]);
        if t0 == t1 || (n0 >= 0.0 && n1 >= 0.0) {
            continue;
        }
        let crossing = change([n0, n1]).map(|part| t0 + part * (t1 - t0));
        let from = if n0 < 0.0 { t0 } else { crossing.unwrap_or(t0) };
        let to = if n1 < 0.0 { t1 } else { crossing.unwrap_or(t1) };
        match lost.last_mut() {
            Some(last) if last[1] == from => last[1] = to,
            _ => lost.push([from, to]),
        }
    }
    lost
}

impl Stretch {
    /// Part of an interval with these loads at its ends; contact does not change in it.
    #[inline(always)]
    fn new(
        interval: usize,
        length_s: f64,
        [a0, a1]: [f64; 2],
        [n0, n1]: [f64; 2],
        [from_s, to_s]: [f64; 2],
    ) -> Self {
        let over_length = 1.0 / length_s;
        let normal_rate = (n1 - n0) * over_length;
        let (normal, normal_from_s) = match change([n0, n1]) {
            Some(part) => (0.0, part * length_s),
            None if n1 == 0.0 => (0.0, length_s),
            None => (n0, 0.0),
        };
        let middle = normal + normal_rate * (0.5 * (from_s + to_s) - normal_from_s);
        let (normal, normal_rate) = if middle > 0.0 { (normal, normal_rate) } else { (0.0, 0.0) };
        Self {
            interval,
            from_s,
            to_s,
            acceleration: a0,
            acceleration_rate: (a1 - a0) * over_length,
            normal,
            normal_from_s,
            normal_rate,
        }
    }

    /// An interval with these loads at its ends, from a time in it, cut where contact changes.
    #[inline(always)]
    fn cut(
        interval: usize,
        length_s: f64,
        accelerations: [f64; 2],
        normals: [f64; 2],
        mut from_s: f64,
    ) -> [Option<Self>; 2] {
        let change_s = change(normals).map(|part| part * length_s);
        let mut stretches = [None, None];
        for (stretch, to_s) in stretches.iter_mut().zip([change_s.unwrap_or(0.0), length_s]) {
            if to_s > from_s {
                *stretch =
                    Some(Self::new(interval, length_s, accelerations, normals, [from_s, to_s]));
                from_s = to_s;
            }
        }
        stretches
    }

    /// Loads that stand for a time.
    pub(super) fn standing(interval: usize, [a, n]: [f64; 2], length_s: f64) -> Self {
        Self::new(interval, length_s, [a; 2], [n; 2], [0.0, length_s])
    }

    /// `a` at a time after the interval's first sample.
    #[inline(always)]
    pub(super) fn acceleration_at(&self, at_s: f64) -> f64 {
        self.acceleration + self.acceleration_rate * at_s
    }

    /// Normal force at a time after the interval's first sample, ≥ 0.
    #[inline(always)]
    pub(super) fn normal_at(&self, at_s: f64) -> f64 {
        greatest(0.0, self.normal + self.normal_rate * (at_s - self.normal_from_s))
    }
}

/// The step that most intervals have to within rounding, and the intervals that have another.
fn regular_step(times_s: &[f64]) -> (Option<f64>, Vec<usize>) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::InstructionSet;
    use crate::numerics::instructions::vectorize;

    fn noise(count: usize) -> Vec<f64> {
        let mut x = 1_u32;
        let next = |_| {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(x >> 8) - 8e6
        };
        (0..count).map(next).collect()
    }

    #[test]
    fn sizes_and_roughness_of_every_batch() {
        vectorize!(InstructionSet::best(), simd => sizes_and_roughness(simd));
    }

    fn sizes_and_roughness<S: Simd>(simd: S) {
        let a = noise(203);
        for x in a.windows(BATCH + 1) {
            let x: &Window = x.try_into().expect("nine samples");
            let sizes = || x.iter().map(|x| x.abs());
            assert_eq!(largest_size(simd, x), sizes().fold(0.0, f64::max));
            let low = smallest(simd, x);
            assert!(x.iter().all(|x| low <= *x) && x.contains(&low));
            let changes = || x.windows(2).map(|x| (x[1] - x[0]).abs());
            let kinks: f64 = x.windows(3).map(|x| ((x[2] - x[1]) - (x[1] - x[0])).abs()).sum();
            let found = Roughness::new(simd, x);
            let near = |sum: f64, found: f64| (found - sum).abs() <= 1e-14 * sum;
            assert!(near(kinks, found.kinks) && near(changes().sum(), found.variation));
            assert_eq!(found.change, changes().fold(0.0, f64::max));
        }
    }
}
