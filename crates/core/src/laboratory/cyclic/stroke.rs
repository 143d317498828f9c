//! Strokes of a cyclic test: from one reversal of the displacement to the next.

use super::{Cycle, CyclicError, CyclicTest, KineticLaw};
use crate::numerics::fractile::upper_median;

/// Strokes of one speed take times within this ratio.
const ONE_SPEED: f64 = 1.2;

/// Part of the drop that is left one sample after a breakaway whose fall is slow.
const SLOW_FALL: f64 = 0.15;
/// Travel counts from so many standard deviations of the displacement's noise on.
const CLEAR_OF_NOISE: f64 = 6.0;

/// From one reversal to the next.
#[derive(Clone, Debug)]
pub(super) struct Stroke {
    /// Sample of its first reversal.
    pub first: usize,
    /// Sample of its last.
    pub last: usize,
    /// +1 towards +x, −1 towards −x.
    pub sign: f64,
    /// Samples on each side over which velocities are taken.
    pub smoothing: usize,
    /// Standard deviation of the noise of the displacement, in m.
    noise_m: f64,
    /// Velocity at each of its samples in m/s.
    velocity_m_per_s: Vec<f64>,
}

/// A breakaway: the force falls from static to kinetic friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Breakaway {
    /// The last sample before it.
    pub sample: usize,
    /// The friction force then, in N.
    pub force_n: f64,
    /// By how much it falls, in N.
    pub drop_n: f64,
    /// By how much the last sample before it is above those behind it, in N.
    pub seen_n: f64,
    /// By how much the force rises in one step before it, in N.
    pub rise_n: f64,
    /// Standard deviation of the force for not knowing when between two samples it broke away.
    pub sampling_n: f64,
}

impl Breakaway {
    /// Whether it can be told from noise of some standard deviation and from the samples' steps: a sample must
    /// stand above what follows, since a curve that is carried on does so by itself.
    pub fn is_clear(&self, noise_n: f64) -> bool {
        let rise_n = self.rise_n;
        let least = self.drop_n.min(self.seen_n);
        least > super::CLEAR_DROP * noise_n && self.drop_n > 2.0 * rise_n
    }
}

/// The complete strokes of a test and how many were left out.
pub(super) fn strokes(test: &CyclicTest) -> Result<(Vec<Stroke>, usize), CyclicError> {
    let x = test.displacement_m;
    let (low, high) =
        x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let (range_m, noise_m) = (high - low, noise(x));
    if !(range_m > 25.0 * noise_m && range_m > 0.0 && range_m.is_finite()) {
        return Err(CyclicError::NoSliding { range_m, noise_m });
    }
    let turns = reversals(x, 0.1 * range_m);
    let all: Vec<f64> = turns.windows(2).map(|t| (x[t[1]] - x[t[0]]).abs()).collect();
    let usual_m = upper_median(all.iter().copied()).unwrap_or(0.0);
    let mut strokes = Vec::new();
    for (ends, length_m) in turns.windows(2).zip(all) {
        let duration = ends[1] - ends[0];
        let smoothing = (duration / 20).max(2);
        if length_m >= 0.5 * usual_m && duration > 4 * smoothing {
            strokes.push(Stroke::new(test, [ends[0], ends[1]], smoothing, noise_m));
        }
    }
    // What stands before the first and after the last reversal is incomplete.
    let whole = turns.len().saturating_sub(1) + 2;
    let left_out = whole - strokes.len();
    // A cycle is two neighbours: after a stroke that was left out counting starts anew, and where friction
    // follows the speed also after one in which the speed of the test was changed.
    let duration = |stroke: &Stroke| (stroke.last - stroke.first) as f64;
    let of_one_speed = |pair: &[Stroke]| {
        let ratio = duration(&pair[0]) / duration(&pair[1]);
        test.law == KineticLaw::Coulomb || (ratio < ONE_SPEED && 1.0 / ratio < ONE_SPEED)
    };
    let mut paired: Vec<Stroke> = Vec::new();
    let mut i = 0;
    while i + 1 < strokes.len() {
        if strokes[i].last == strokes[i + 1].first && of_one_speed(&strokes[i..i + 2]) {
            paired.extend([strokes[i].clone(), strokes[i + 1].clone()]);
            i += 2;
        } else {
            i += 1;
        }
    }
    Ok((paired, left_out))
}

/// Standard deviation of the noise of a smooth history: from the median of its third differences.
pub(super) fn noise(values: &[f64]) -> f64 {
    let thirds = values.windows(4).map(|v| (v[3] - 3.0 * v[2] + 3.0 * v[1] - v[0]).abs());
    // The variance of the difference is 20 times that of a value; 0.6745 is the median of |N(0, 1)|.
    upper_median(thirds).map_or(0.0, |median| median / (0.6745 * 20.0_f64.sqrt()))
}

/// Samples at which the history turns by more than a threshold.
fn reversals(x: &[f64], threshold: f64) -> Vec<usize> {
    let mut turns = Vec::new();
    let (mut highest, mut lowest) = (0, 0);
    let mut rising: Option<bool> = None;
    for i in 1..x.len() {
        if x[i] > x[highest] {
            highest = i;
        }
        if x[i] < x[lowest] {
            lowest = i;
        }
        if rising != Some(false) && x[highest] - x[i] > threshold {
            if rising == Some(true) {
                turns.push(highest);
            }
            (rising, lowest) = (Some(false), i);
        } else if rising != Some(true) && x[i] - x[lowest] > threshold {
            if rising == Some(false) {
                turns.push(lowest);
            }
            (rising, highest) = (Some(true), i);
        }
    }
    turns
}

impl Stroke {
    fn new(test: &CyclicTest, [first, last]: [usize; 2], smoothing: usize, noise_m: f64) -> Self {
        let sign = (test.displacement_m[last] - test.displacement_m[first]).signum();
        let velocity = (first..=last).map(|i| slope(test, i, smoothing)).collect();
        Self { first, last, sign, smoothing, noise_m, velocity_m_per_s: velocity }
    }

    /// Velocity at a sample in m/s.
    pub fn velocity(&self, sample: usize) -> f64 {
        self.velocity_m_per_s[sample - self.first]
    }

    /// Largest speed in m/s.
    pub fn peak_velocity(&self) -> f64 {
        self.velocity_m_per_s.iter().fold(0.0, |peak, v| v.abs().max(peak))
    }

    /// From end to end, in m.
    pub fn length_m(&self, test: &CyclicTest) -> f64 {
        (test.displacement_m[self.last] - test.displacement_m[self.first]).abs()
    }

    /// How far it has come at a sample, in m.
    fn travel_m(&self, test: &CyclicTest, sample: usize) -> f64 {
        self.sign * (test.displacement_m[sample] - test.displacement_m[self.first])
    }

    /// The first sample beyond some travel, and clear of what the smoothing mixes. Noise is no travel: a block that
    /// is stuck stays where it is.
    pub fn after(&self, test: &CyclicTest, travel_m: f64) -> usize {
        let travel_m = travel_m + CLEAR_OF_NOISE * self.noise_m;
        let beyond = (self.first..self.last).find(|i| self.travel_m(test, *i) > travel_m);
        beyond.unwrap_or(self.last) + self.smoothing + 1
    }

    /// Samples from a start on that slide: fast, and clear of the next reversal.
    pub fn sliding(&self, start: usize, slowest: f64) -> impl Iterator<Item = usize> + '_ {
        let least = slowest * self.peak_velocity();
        let end = self.last.saturating_sub(self.smoothing);
        (start..end).filter(move |i| self.sign * self.velocity(*i) >= least)
    }

    /// The class of each of its samples by speed, from slow to fast: all classes with as many samples.
    pub fn classes(&self, samples: &[usize], classes: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..samples.len()).collect();
        let speed = |i: usize| self.velocity(samples[i]).abs();
        order.sort_by(|a, b| speed(*a).total_cmp(&speed(*b)));
        let mut of = vec![0; samples.len()];
        for (rank, i) in order.into_iter().enumerate() {
            of[i] = rank * classes / samples.len();
        }
        of
    }

    /// The friction force at a sample, positive against the motion: what is left of the force
    /// without spring and damper.
    fn friction_n(&self, test: &CyclicTest, cycle: &Cycle, sample: usize) -> f64 {
        let damper = cycle.damper_n_s_per_m.unwrap_or(0.0) * self.velocity(sample);
        self.held_n(test, cycle, sample) - self.sign * damper
    }

    /// The same while the block is stuck: without the spring only. Velocities are smoothed and
    /// know nothing of a breakaway.
    fn held_n(&self, test: &CyclicTest, cycle: &Cycle, sample: usize) -> f64 {
        let spring = cycle.spring_n_per_m.unwrap_or(0.0) * test.displacement_m[sample];
        self.sign * (test.force_n[sample] - spring)
    }

    /// The least kinetic friction at any speed.
    fn least_kinetic_n(&self, cycle: &Cycle) -> f64 {
        let way = usize::from(self.sign < 0.0);
        cycle.by_speed.iter().map(|at| at.kinetic_n[way]).fold(f64::INFINITY, f64::min)
    }

    /// Travel at which friction has built up to nine tenths, in m; `None` where it never does.
    pub fn build_up_m(&self, test: &CyclicTest, cycle: &Cycle) -> Option<f64> {
        let level = 0.9 * self.least_kinetic_n(cycle);
        let built = (self.first..self.last).find(|i| self.friction_n(test, cycle, *i) >= level)?;
        Some(self.travel_m(test, built).max(0.0))
    }

    /// The breakaway: the steepest fall of the friction force while it builds up or in the first
    /// tenth of the stroke. `None` where too few samples rise towards it.
    ///
    /// The samples well before it follow a parabola (a straight line where they are few), those
    /// after it a level; which is the last before it is decided by least squares, a sample in the
    /// midst of the fall counting as fallen. It broke away half a step later on average.
    pub fn breakaway(&self, test: &CyclicTest, cycle: &Cycle, slack_m: f64) -> Option<Breakaway> {
        const RISING: usize = 14;
        const LEVEL: usize = 4;
        let held = |i: usize| self.held_n(test, cycle, i);
        let reach_m = slack_m.max(0.1 * self.length_m(test));
        let last =
            (self.first..self.last).take_while(|i| self.travel_m(test, *i) <= reach_m).last()?;
        // While the block is stuck its displacement says little of when it turned: the force does.
        let begin = (0..=self.first).rev().take_while(|i| held(*i) > 0.0).last();
        let begin = begin.unwrap_or(self.first);
        let fall = |i: usize| 0.5 * (held(i) + held(i - 1)) - 0.5 * (held(i + 1) + held(i + 2));
        let range = begin + 2..last.min(self.last.saturating_sub(LEVEL + 2));
        let steepest =
            range.map(|i| (i, fall(i))).fold(None, |best: Option<(usize, f64)>, next| {
                if best.is_none_or(|best| next.1 > best.1) { Some(next) } else { best }
            })?;
        let at = steepest.0;
        let count = RISING.min((at - 2).checked_sub(begin)? + 1);
        let rows: Vec<([f64; 3], f64)> = (2..2 + count)
            .map(|back| {
                let t = -(back as f64);
                ([1.0, t, t * t], held(at - back))
            })
            .collect();
        let curve = match count {
            0..4 => return None,
            4..8 => {
                let rows: Vec<([f64; 2], f64)> =
                    rows.iter().map(|(x, y)| ([x[0], x[1]], *y)).collect();
                let line = super::linear_fit(&rows)?.coefficients;
                [line[0], line[1], 0.0]
            }
            _ => {
                let curve = super::linear_fit(&rows)?.coefficients;
                [curve[0], curve[1], curve[2]]
            }
        };
        let rising = |t: f64| curve[0] + t * (curve[1] + t * curve[2]);
        let level = (2..2 + LEVEL).map(|ahead| held(at + ahead)).sum::<f64>() / LEVEL as f64;
        let drop_n = rising(0.5) - level;
        let fallen = level + 0.3 * drop_n;
        let misfit = |turn: i32| -> f64 {
            (-1..4)
                .map(|j: i32| {
                    let expected = if j <= turn { rising(f64::from(j)) } else { fallen };
                    let found = held(at.saturating_add_signed(j as isize));
                    (found - expected) * (found - expected)
                })
                .sum()
        };
        let turn = (-2..3).fold((-2, f64::INFINITY), |best, turn| {
            let value = misfit(turn);
            if value < best.1 { (turn, value) } else { best }
        });
        let sample = at.saturating_add_signed(turn.0 as isize);
        // A soft rig lets the force fall over several samples: the first of them may stand near the top. (Where
        // friction follows the speed it falls on as the block gains speed.)
        let is_slow = test.law == KineticLaw::Coulomb
            && held(sample + 1) - level > SLOW_FALL * drop_n
            && held(sample + 2) - level > 0.5 * SLOW_FALL * drop_n;
        let (back, steps) = if is_slow { (0.0, 2.0) } else { (0.5, 1.0) };
        let t = f64::from(turn.0) + back;
        let rate = curve[1] + 2.0 * t * curve[2];
        Some(Breakaway {
            sample,
            force_n: rising(t),
            drop_n,
            seen_n: held(sample) - level,
            rise_n: rate.abs(),
            sampling_n: steps * rate.abs() / 12.0_f64.sqrt(),
        })
    }
}

/// When the displacement turns at a sample, in s: the middle of the time within a twentieth of a
/// stroke of it. While the block is stuck the sample itself is any of many.
pub(super) fn turning_s(test: &CyclicTest, sample: usize, length_m: f64) -> f64 {
    let x = test.displacement_m;
    let reach_m = 0.05 * length_m;
    let away_m = |i: usize| (x[i] - x[sample]).abs();
    // By the straight line between the last sample within reach and the first beyond it.
    let leaves_s = |within: usize, beyond: usize| {
        let part = (reach_m - away_m(within)) / (away_m(beyond) - away_m(within));
        test.times_s[within] + part * (test.times_s[beyond] - test.times_s[within])
    };
    let before = (0..sample).rev().find(|i| away_m(*i) > reach_m);
    let after = (sample + 1..x.len()).find(|i| away_m(*i) > reach_m);
    match (before, after) {
        (Some(i), Some(j)) => 0.5 * (leaves_s(i + 1, i) + leaves_s(j - 1, j)),
        _ => test.times_s[sample],
    }
}

/// Slope of the straight line through the samples around one.
fn slope(test: &CyclicTest, sample: usize, reach: usize) -> f64 {
    let n = test.times_s.len();
    let range = sample.saturating_sub(reach)..(sample + reach + 1).min(n);
    let count = range.len() as f64;
    let mean = |values: &[f64]| values[range.clone()].iter().sum::<f64>() / count;
    let (t0, x0) = (mean(test.times_s), mean(test.displacement_m));
    let (mut tt, mut tx) = (0.0, 0.0);
    for i in range.clone() {
        let t = test.times_s[i] - t0;
        tt += t * t;
        tx += t * (test.displacement_m[i] - x0);
    }
    if tt > 0.0 { tx / tt } else { 0.0 }
}
