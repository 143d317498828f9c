//! Many oscillators at once over evenly spaced samples, in lanes.
//!
//! Two passes over the record for [`LANES`] oscillators. The first steps from sample to sample and
//! keeps, for every block of [`BLOCK`] samples, the states at its start and its largest values at
//! samples. The second goes through those blocks again, one oscillator at a time, in which a peak
//! between samples may be above what was attained: few of them. Lanes do not mix and no sum is
//! reordered, so that the bits are the same whatever instructions do it.

use super::Oscillator;
use crate::motion::oscillator::{Interval, Overshoot, Peaks, State, Step};
use crate::numerics::instructions::vectorize;
use crate::numerics::{InstructionSet, sort};

/// Oscillators side by side.
const LANES: usize = 8;

/// Samples between kept states.
const BLOCK: usize = 32;

/// One number for each oscillator.
type Lanes = [f64; LANES];

/// Most samples that straight lines are cut into for short periods, and most of them a sample of a
/// long record: beyond, one interval after the other is looked at, which costs no more.
const MOST_SAMPLES: usize = 1 << 24;
const MOST_CUTS: usize = 64;
const FEW_SAMPLES: usize = 1 << 18;

/// Peaks of every oscillator under an acceleration sampled every `dt_s`; `None` for those whose
/// period is too short for it.
///
/// An oscillator that turns far within a sample sees the straight lines cut into equal parts, which
/// are the same motion: so its peaks between samples have a close bound, too.
pub(super) fn peaks(
    dt_s: f64,
    acceleration: &[f64],
    oscillators: &[Oscillator],
) -> Vec<Option<Peaks>> {
    let parts: Vec<f64> =
        oscillators.iter().map(|o| Overshoot::parts(o.omega * dt_s, o.xi)).collect();
    let mut order: Vec<usize> = (0..oscillators.len()).collect();
    sort(&mut order, |&i, &j| parts[i].total_cmp(&parts[j]));
    let mut all = vec![None; oscillators.len()];
    let mut blocks = Vec::new();
    let instructions = InstructionSet::best();
    let most = (MOST_CUTS * acceleration.len()).clamp(FEW_SAMPLES, MOST_SAMPLES) as f64;
    for alike in order.chunk_by(|&i, &j| parts[i] == parts[j]) {
        let cuts = parts[alike[0]];
        if !(cuts * acceleration.len() as f64 <= most) {
            break;
        }
        let fine;
        let acceleration = match cuts as usize {
            1 => acceleration,
            cuts => {
                fine = cut(acceleration, cuts);
                &fine[..]
            }
        };
        let dt_s = dt_s / cuts;
        let extents = extents(acceleration);
        for indices in alike.chunks(LANES) {
            let group: Vec<Oscillator> = indices.iter().map(|&i| oscillators[i]).collect();
            let matrices = Matrices::new(dt_s, &group);
            vectorize!(instructions, _simd => matrices.run(acceleration, &mut blocks));
            for (lane, &i) in indices.iter().enumerate() {
                let one = One::new(dt_s, oscillators[i], &matrices, lane);
                all[i] = Some(one.peaks(acceleration, &extents, &blocks));
            }
        }
    }
    all
}

/// The straight lines between samples, each cut into equal parts.
fn cut(acceleration: &[f64], parts: usize) -> Vec<f64> {
    let mut fine = Vec::with_capacity((acceleration.len() - 1) * parts + 1);
    for a in acceleration.windows(2) {
        fine.extend((0..parts).map(|k| a[0] + (a[1] - a[0]) * (k as f64 / parts as f64)));
    }
    fine.extend(acceleration.last());
    fine
}

/// Bounds of the acceleration over a block: largest |a|, and largest |a[k+1] − a[k]|.
#[derive(Clone, Copy)]
struct Extent {
    value: f64,
    change: f64,
}

fn extents(acceleration: &[f64]) -> Vec<Extent> {
    let firsts = (0..acceleration.len() - 1).step_by(BLOCK);
    let extent = |first: usize| {
        let block = &acceleration[first..(first + BLOCK + 1).min(acceleration.len())];
        let change = block.windows(2).map(|a| (a[1] - a[0]).abs()).fold(0.0, f64::max);
        Extent { value: block.iter().map(|a| a.abs()).fold(0.0, f64::max), change }
    };
    firsts.map(extent).collect()
}

/// What is kept of a block: states at its start and largest values at its samples, both ends
/// included.
#[derive(Clone, Copy)]
struct Block {
    u: Lanes,
    w: Lanes,
    peak_u: Lanes,
    peak_w: Lanes,
    peak_total: Lanes,
}

/// The matrix of one step, in lanes; the columns of the acceleration include the compliance.
struct Matrices {
    u_by_u: Lanes,
    u_by_w: Lanes,
    u_by_a0: Lanes,
    u_by_a1: Lanes,
    w_by_u: Lanes,
    w_by_w: Lanes,
    w_by_a0: Lanes,
    w_by_a1: Lanes,
    two_xi: Lanes,
}

impl Matrices {
    fn new(dt_s: f64, group: &[Oscillator]) -> Self {
        let mut m = Self {
            u_by_u: [0.0; LANES],
            u_by_w: [0.0; LANES],
            u_by_a0: [0.0; LANES],
            u_by_a1: [0.0; LANES],
            w_by_u: [0.0; LANES],
            w_by_w: [0.0; LANES],
            w_by_a0: [0.0; LANES],
            w_by_a1: [0.0; LANES],
            two_xi: [0.0; LANES],
        };
        for (i, o) in group.iter().enumerate() {
            let step = Step::new(o.omega * dt_s, o.xi);
            let compliance = o.compliance();
            (m.u_by_u[i], m.w_by_u[i]) = (step.by_u.u, step.by_u.w);
            (m.u_by_w[i], m.w_by_w[i]) = (step.by_w.u, step.by_w.w);
            m.u_by_a0[i] = compliance * step.by_alpha0.u;
            m.w_by_a0[i] = compliance * step.by_alpha0.w;
            m.u_by_a1[i] = compliance * step.by_alpha1.u;
            m.w_by_a1[i] = compliance * step.by_alpha1.w;
            m.two_xi[i] = 2.0 * o.xi;
        }
        m
    }

    /// One lane over one step.
    #[inline(always)]
    fn step(&self, i: usize, u: f64, w: f64, a0: f64, a1: f64) -> (f64, f64) {
        let by_ground_u = self.u_by_a0[i] * a0 + self.u_by_a1[i] * a1;
        let by_ground_w = self.w_by_a0[i] * a0 + self.w_by_a1[i] * a1;
        (
            (self.u_by_u[i] * u + self.u_by_w[i] * w) + by_ground_u,
            (self.w_by_u[i] * u + self.w_by_w[i] * w) + by_ground_w,
        )
    }

    /// All lanes over the whole record, from rest.
    #[inline(always)]
    fn run(&self, acceleration: &[f64], blocks: &mut Vec<Block>) {
        blocks.clear();
        let (mut u, mut w) = ([0.0; LANES], [0.0; LANES]);
        for first in (0..acceleration.len() - 1).step_by(BLOCK) {
            let last = (first + BLOCK + 1).min(acceleration.len());
            let mut block = Block::new(u, w, &self.two_xi);
            for a in acceleration[first..last].windows(2) {
                for i in 0..LANES {
                    (u[i], w[i]) = self.step(i, u[i], w[i], a[0], a[1]);
                    block.peak_u[i] = higher(block.peak_u[i], u[i]);
                    block.peak_w[i] = higher(block.peak_w[i], w[i]);
                    let total = u[i] + self.two_xi[i] * w[i];
                    block.peak_total[i] = higher(block.peak_total[i], total);
                }
            }
            blocks.push(block);
        }
    }
}

/// The larger of a peak and the size of a value.
#[inline(always)]
fn higher(peak: f64, value: f64) -> f64 {
    let value = value.abs();
    if value > peak { value } else { peak }
}

impl Block {
    /// One that holds its first state alone.
    fn new(u: Lanes, w: Lanes, two_xi: &Lanes) -> Self {
        let mut total = [0.0; LANES];
        for i in 0..LANES {
            total[i] = (u[i] + two_xi[i] * w[i]).abs();
        }
        Self { u, w, peak_u: u.map(f64::abs), peak_w: w.map(f64::abs), peak_total: total }
    }

    fn peaks(&self, i: usize) -> Peaks {
        Peaks { u: self.peak_u[i], w: self.peak_w[i], total: self.peak_total[i] }
    }
}

/// One oscillator of the group, looked at closely.
struct One<'a> {
    matrices: &'a Matrices,
    lane: usize,
    xi: f64,
    theta: f64,
    /// `α` over the acceleration, and its slope by phase over the change in a sample.
    compliance: f64,
    by_change: f64,
    overshoot: Overshoot,
}

impl<'a> One<'a> {
    fn new(dt_s: f64, oscillator: Oscillator, matrices: &'a Matrices, lane: usize) -> Self {
        let (xi, theta) = (oscillator.xi, oscillator.omega * dt_s);
        let compliance = oscillator.compliance();
        let overshoot = Overshoot::new(theta, xi);
        Self { matrices, lane, xi, theta, compliance, by_change: compliance / theta, overshoot }
    }

    fn peaks(&self, acceleration: &[f64], extents: &[Extent], blocks: &[Block]) -> Peaks {
        let mut peaks = Peaks::default();
        let mut highest = [0; 3];
        for (index, block) in blocks.iter().enumerate() {
            let of = block.peaks(self.lane);
            for (peak, value, at) in
                [(&mut peaks.u, of.u, 0), (&mut peaks.w, of.w, 1), (&mut peaks.total, of.total, 2)]
            {
                if value > *peak {
                    (*peak, highest[at]) = (value, index);
                }
            }
        }
        // The highest first: what they attain leaves fewer of the others to look at.
        for &index in &highest {
            self.look_closely(acceleration, index, &blocks[index], extents[index], &mut peaks);
        }
        for (index, block) in blocks.iter().enumerate() {
            if exceeds(&block.peaks(self.lane), &self.limits(&peaks, extents[index])) {
                self.look_closely(acceleration, index, block, extents[index], &mut peaks);
            }
        }
        peaks
    }

    /// What values at samples of a block have to exceed for a peak between them to be above those
    /// attained.
    #[inline(always)]
    fn limits(&self, attained: &Peaks, extent: Extent) -> Peaks {
        let (value, slope) = (self.compliance * extent.value, self.by_change * extent.change);
        let total = value + 2.0 * self.xi * slope;
        Peaks {
            u: self.overshoot.limit(attained.u, value),
            w: self.overshoot.limit(attained.w, slope),
            total: self.overshoot.limit(attained.total, total),
        }
    }

    /// Goes through a block again and raises the peaks by those between its samples.
    fn look_closely(
        &self,
        acceleration: &[f64],
        index: usize,
        block: &Block,
        extent: Extent,
        peaks: &mut Peaks,
    ) {
        let first = index * BLOCK;
        let last = (first + BLOCK + 1).min(acceleration.len());
        let sizes = |s: State| Peaks {
            u: s.u.abs(),
            w: s.w.abs(),
            total: (s.u + 2.0 * self.xi * s.w).abs(),
        };
        // As peaks rise, limits do: those at the start let through a few too many.
        let limits = self.limits(peaks, extent);
        let mut start = State { u: block.u[self.lane], w: block.w[self.lane] };
        let mut from_start = exceeds(&sizes(start), &limits);
        for a in acceleration[first..last].windows(2) {
            let (u, w) = self.matrices.step(self.lane, start.u, start.w, a[0], a[1]);
            let end = State { u, w };
            let from_end = exceeds(&sizes(end), &limits);
            if from_start || from_end {
                let (alpha0, alpha1) = (self.compliance * a[0], self.compliance * a[1]);
                let (xi, theta) = (self.xi, self.theta);
                Interval { xi, theta, start, end, alpha0, alpha1 }.raise(self.overshoot, peaks);
            }
            (start, from_start) = (end, from_end);
        }
    }
}

/// Whether one of the values is above its limit.
#[inline(always)]
fn exceeds(values: &Peaks, limits: &Peaks) -> bool {
    values.u > limits.u || values.w > limits.w || values.total > limits.total
}
