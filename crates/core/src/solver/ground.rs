//! The motion as the equations see it: along the slope with gravity's pull, and as normal force.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use crate::linear::lanes::greatest;
use crate::linear::{BATCH, QUIET};
use crate::model::Model;
use crate::motion::GroundMotion;

/// What screening needs to know of a motion, whatever the model.
#[derive(Clone, Debug)]
pub(super) struct Windows {
    /// The step that all but a few intervals have; none where the sampling is uneven.
    pub(super) dt_s: Option<f64>,
    /// The other intervals, in order: jumps, an odd end, a gap.
    irregular: Vec<usize>,
    horizontal: Signal,
    vertical: Option<Signal>,
}

/// Sizes and kinks of a signal.
#[derive(Clone, Debug)]
struct Signal {
    /// For each eighth sample the largest size at the samples that a batch, and quiet stick, from
    /// there or from one of the next seven samples touches.
    sizes: Vec<[f64; 2]>,
    /// For each eighth sample the largest |x_{i+1} − x_i| in a batch, as before.
    changes: Vec<f64>,
    /// Sums of |x_i − x_{i−1}| and of |x_{i+1} − 2 x_i + x_{i−1}| up to a sample.
    sums: Vec<[f64; 2]>,
}

impl Windows {
    /// Looks through a motion once.
    pub(super) fn new(motion: &GroundMotion) -> Self {
        let (dt_s, irregular) = match motion.dt_s() {
            Some(dt_s) => (Some(dt_s), Vec::new()),
            None => regular_step(motion.times_s()),
        };
        let signal = |x: &[f64]| if dt_s.is_some() { Signal::new(x) } else { Signal::NONE };
        Self {
            dt_s,
            irregular,
            horizontal: signal(motion.horizontal_m_per_s2()),
            vertical: motion.vertical_m_per_s2().map(signal),
        }
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

impl Signal {
    const NONE: Self = Self { sizes: Vec::new(), changes: Vec::new(), sums: Vec::new() };

    fn new(x: &[f64]) -> Self {
        let chunks = x.len().div_ceil(BATCH);
        let mut largest = vec![0.0; chunks + QUIET / BATCH];
        let mut steepest = largest.clone();
        for i in 0..chunks {
            let intervals = &x[BATCH * i..x.len().min(BATCH * (i + 1) + 1)];
            let samples = &intervals[..intervals.len().min(BATCH)];
            largest[i] = samples.iter().fold(0.0, |size, x| greatest(size, x.abs()));
            let changes = intervals.windows(2).map(|x| (x[1] - x[0]).abs());
            steepest[i] = changes.fold(0.0, greatest);
        }
        let mut sums = vec![[0.0; 2]; x.len()];
        let [mut variation, mut kinks, mut change] = [0.0; 3];
        for i in 1..x.len() {
            let next = x[i] - x[i - 1];
            if i > 1 {
                kinks += (next - change).abs();
            }
            variation += next.abs();
            (sums[i - 1][1], sums[i]) = (kinks, [variation, kinks]);
            change = next;
        }
        // From the last of eight samples a batch ends at the last sample of the next chunk, and quiet
        // stick at that of the fourth.
        let over = |i: usize, n: usize| largest[i..=i + n].iter().fold(0.0, |a, b| greatest(a, *b));
        let sizes = (0..chunks).map(|i| [over(i, 1), over(i, QUIET / BATCH)]).collect();
        let changes = (0..chunks).map(|i| greatest(steepest[i], steepest[i + 1])).collect();
        Self { sizes, changes, sums }
    }

    /// Largest size in a batch and in quiet stick from a sample.
    #[inline(always)]
    fn size(&self, sample: usize) -> [f64; 2] {
        self.sizes[sample / BATCH]
    }

    /// What a batch from a sample holds, with room for the rounding of the sums.
    #[inline(always)]
    fn roughness(&self, sample: usize) -> Roughness {
        let ([v0, k0], [v1, _], [_, k1]) =
            (self.sums[sample], self.sums[sample + BATCH], self.sums[sample + BATCH - 1]);
        Roughness {
            variation: (v1 - v0) + 1e-15 * v1,
            kinks: (k1 - k0) + 1e-15 * k1,
            change: self.changes[sample / BATCH],
        }
    }
}

/// How a signal varies within a batch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Roughness {
    /// Sum of |x_{i+1} − x_i|.
    pub(super) variation: f64,
    /// Sum of |x_{i+1} − 2 x_i + x_{i−1}| at the samples within.
    pub(super) kinks: f64,
    /// Largest |x_{i+1} − x_i|, or more.
    pub(super) change: f64,
}

/// Loads of a model under a motion.
pub(super) struct Ground<'a> {
    pub(super) times_s: &'a [f64],
    /// `Ü` at the samples.
    pub(super) table: &'a [f64],
    /// `a = Ü + g sin θ` at the samples.
    pub(super) acceleration: &'a [f64],
    pub(super) normal: Normal<'a>,
    pub(super) windows: &'a Windows,
    /// `|g sin θ|`.
    pub(super) slope_size: f64,
    /// `M_tot` and `M_tot g cos θ`.
    pub(super) mass_kg: f64,
    pub(super) weight_n: f64,
}

/// `M_tot (g cos θ + Üv)` at the samples, negative where contact is lost; or one value.
#[derive(Clone, Copy)]
pub(super) enum Normal<'a> {
    Constant(f64),
    Varying(&'a [f64]),
}

/// `M_tot (g cos θ + Üv)` at the samples, where there is vertical motion.
pub(super) fn varying_normal(model: &Model, motion: &GroundMotion) -> Option<Vec<f64>> {
    let (mass_kg, gravity) = (model.total_mass_kg(), model.normal_gravity_m_per_s2());
    let vertical = motion.vertical_m_per_s2()?;
    Some(vertical.iter().map(|a| mass_kg * (gravity + a)).collect())
}

impl<'a> Normal<'a> {
    /// That of a model, varying where there is vertical motion.
    pub(super) fn new(model: &Model, varying: Option<&'a [f64]>) -> Self {
        let weight_n = model.total_mass_kg() * model.normal_gravity_m_per_s2();
        varying.map_or(Self::Constant(weight_n), Self::Varying)
    }
}

impl Normal<'_> {
    /// At the eight samples after one, and at that one.
    #[inline(always)]
    pub(super) fn window<S: Simd>(&self, simd: S, sample: usize) -> (f64x8<S>, f64) {
        match self {
            Self::Constant(normal) => (f64x8::splat(simd, *normal), *normal),
            Self::Varying(normal) => {
                (f64x8::from_slice(simd, &normal[sample + 1..][..BATCH]), normal[sample])
            }
        }
    }
}

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
    normal: f64,
    pub(super) normal_rate: f64,
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

    /// Largest |a| in a batch and in quiet stick from a sample.
    #[inline(always)]
    pub(super) fn sizes(&self, sample: usize) -> [f64; 2] {
        self.windows.horizontal.size(sample).map(|size| size + self.slope_size)
    }

    /// Least and largest normal force in a batch from a sample, or beyond.
    #[inline(always)]
    pub(super) fn normal_range(&self, sample: usize) -> [f64; 2] {
        match &self.windows.vertical {
            None => [self.weight_n; 2],
            Some(signal) => {
                let change = self.mass_kg * signal.size(sample)[0];
                [self.weight_n - change, self.weight_n + change]
            }
        }
    }

    /// How acceleration and vertical acceleration vary within a batch from a sample.
    #[inline(always)]
    pub(super) fn roughness(&self, sample: usize) -> (Roughness, Option<Roughness>) {
        let windows = self.windows;
        let vertical = windows.vertical.as_ref().map(|signal| signal.roughness(sample));
        (windows.horizontal.roughness(sample), vertical)
    }

    /// Where in an interval (as a part of it) contact is lost or regained.
    #[inline(always)]
    pub(super) fn contact_change(&self, interval: usize) -> Option<f64> {
        change(self.normals(interval))
    }

    /// The part of an interval between two times after its first sample; contact does not change
    /// in it.
    #[inline(always)]
    pub(super) fn stretch(&self, interval: usize, from_s: f64, to_s: f64) -> Stretch {
        let length_s = self.times_s[interval + 1] - self.times_s[interval];
        let over_length = 1.0 / length_s;
        let [a0, a1] = [self.acceleration[interval], self.acceleration[interval + 1]];
        let [n0, n1] = self.normals(interval);
        let normal_rate = (n1 - n0) * over_length;
        let middle = n0 + normal_rate * (0.5 * (from_s + to_s));
        let (normal, normal_rate) = if middle > 0.0 { (n0, normal_rate) } else { (0.0, 0.0) };
        Stretch {
            interval,
            from_s,
            to_s,
            acceleration: a0,
            acceleration_rate: (a1 - a0) * over_length,
            normal,
            normal_rate,
        }
    }
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
    /// `a` at a time after the interval's first sample.
    #[inline(always)]
    pub(super) fn acceleration_at(&self, at_s: f64) -> f64 {
        self.acceleration + self.acceleration_rate * at_s
    }

    /// Normal force at a time after the interval's first sample, ≥ 0.
    #[inline(always)]
    pub(super) fn normal_at(&self, at_s: f64) -> f64 {
        greatest(0.0, self.normal + self.normal_rate * at_s)
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

    fn noise(count: usize) -> Vec<f64> {
        let mut x = 1_u32;
        let next = |_| {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(x >> 8) - 8e6
        };
        (0..count).map(next).collect()
    }

    #[test]
    fn exact_windows_cover_every_batch_and_quiet_stick() {
        let a = noise(203);
        let signal = Signal::new(&a);
        for i in 0..a.len() {
            let size =
                |n: usize| a[i..a.len().min(i + n + 1)].iter().fold(0.0_f64, |m, a| m.max(a.abs()));
            let [batch, quiet] = signal.size(i);
            assert!(batch >= size(BATCH), "batch at {i}");
            assert!(quiet >= size(QUIET), "quiet stick at {i}");
            if i + BATCH < a.len() {
                let a = &a[i..=i + BATCH];
                let changes = || a.windows(2).map(|x| (x[1] - x[0]).abs());
                let kinks: f64 = a.windows(3).map(|x| ((x[2] - x[1]) - (x[1] - x[0])).abs()).sum();
                let found = signal.roughness(i);
                let near = |sum: f64, found| sum <= found && found < sum * (1.0 + 1e-11);
                assert!(near(kinks, found.kinks) && near(changes().sum(), found.variation));
                assert!(changes().all(|change| change <= found.change));
            }
        }
    }
}
