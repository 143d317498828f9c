//! What the noise of the table's accelerometer, and the motion between its samples, do to estimates.
//!
//! The model is driven by the measured table acceleration. With the Jacobian `J` of the residuals `r` at
//! the best values, a change `δr` that comes from another table motion moves the estimates by
//!
//! ```text
//! δp = −(Jᵀ J)⁻¹ Jᵀ δr
//! ```
//!
//! `δr` is computed for draws of the noise on top of the measured motion, and for the motion on the cubic
//! through four samples instead of the straight line. The noise scatters the estimates. Between its samples
//! the table moves alike in every test: that `δp` is a shift `d`, of which no more is known than its limits,
//! nothing and all of it. The interval of an estimate `p` with the half widths `h` then reaches from the
//! lower end under the one to the upper end under the other:
//!
//! ```text
//! p + min(0, d) − h₋  to  p + max(0, d) + h₊        held with Φ(1.96 + |d|/s) − Φ(−1.96)
//! ```
//!
//! with the standard error `s`, where the truth is at either limit: 95 % where the shift is small, 97.5 % where it
//! is large.
//!
//! The sum of squares jumps where a stick or a slip appears, so that the best values move further than
//! derivatives tell. Where the noise counts at all, the response of the best values is therefore fitted
//! anew under each draw.

use super::{Data, Fitted, weighed};
use crate::laboratory::fit::{Interval, Problem, refine};
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::numerics::algebra::linear_fit;
use crate::numerics::distribution::{normal_quantile, student_quantile};
use crate::numerics::fractile::upper_median;
use crate::numerics::random::Random;

/// Draws of the noise: its standard deviation is known to a seventh.
const DRAWS: usize = 24;
/// What moves no estimate by more than this part of the standard deviation of its profile does not count:
/// even three times as much would widen the interval by a twentieth.
const NOTHING: f64 = 0.1;
/// Samples of the quietest stretch that is looked at.
const QUIET: usize = 50;

/// Standard deviation of the noise of the table acceleration in m/s²: from third differences, which
/// a smooth motion hardly has, or from the quietest stretch, whichever is less. Both count motion as
/// noise where there is such motion, so neither is too small.
pub(super) fn noise(motion: &GroundMotion) -> f64 {
    let a = motion.horizontal_m_per_s2();
    let thirds = a.windows(4).map(|v| (v[3] - 3.0 * v[2] + 3.0 * v[1] - v[0]).abs());
    let by_thirds = upper_median(thirds).map_or(0.0, |m| m / (0.6745 * 20.0_f64.sqrt()));
    let deviation = |v: &[f64]| {
        let n = v.len() as f64;
        let mean = v.iter().sum::<f64>() / n;
        (v.iter().map(|a| (a - mean) * (a - mean)).sum::<f64>() / (n - 1.0)).sqrt()
    };
    let stretches = a.chunks(QUIET).filter(|v| v.len() == QUIET).map(deviation);
    stretches.fold(by_thirds, f64::min)
}

/// What is not known of the table's accelerometer.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfTable {
    /// Standard deviation of its noise in m/s².
    pub noise_m_per_s2: f64,
    /// Standard deviation of its gain.
    pub gain: f64,
}

/// What is not known of the table motion, for one parameter.
struct Moves {
    /// Standard deviation of its estimate through the noise.
    deviation: f64,
    /// How far its estimate moves under the curved motion.
    shift: f64,
    /// How far it moves where the gain is off by its standard deviation.
    by_gain: f64,
}

/// Widens intervals by what moves the estimates through the table motion: the noise by its square, the
/// motion between the samples as a shift of which only the two limits are known.
pub(super) fn widen(
    found: &mut Fitted,
    problem: &Problem,
    data: &Data,
    scales: &[f64],
    of_table: OfTable,
    seed: u64,
) {
    let values = problem.parameters(&found.minimum.unit);
    let Some(moves) = moves(found, problem, data, scales, of_table, seed) else { return };
    let t = student_quantile(0.95, DRAWS as f64);
    for ((interval, moves), value) in found.intervals.iter_mut().zip(moves).zip(values) {
        let Some(Interval { ends, .. }) = interval else { continue };
        let by_gain = normal_quantile(0.975) * moves.by_gain;
        let by_table = libm::hypot(t * moves.deviation, by_gain);
        let [below, above] = ends.map(|end| libm::hypot(end - value, by_table));
        *ends = [value + moves.shift.min(0.0) - below, value + moves.shift.max(0.0) + above];
    }
}

/// What is not known of the table motion; `None` where the derivatives tell nothing.
fn moves(
    found: &Fitted,
    problem: &Problem,
    data: &Data,
    scales: &[f64],
    OfTable { noise_m_per_s2, gain }: OfTable,
    seed: u64,
) -> Option<Vec<Moves>> {
    let derivatives = Derivatives::new(found, problem, data, scales)?;
    let mut random = Random::new(seed);
    let (a, times_s) = (data.motion.horizontal_m_per_s2(), data.motion.times_s());
    let noisy = |_| {
        let noisy = a.iter().map(|a| a + noise_m_per_s2 * random.normal()).collect();
        GroundMotion::new(times_s.to_vec(), noisy, None).ok()
    };
    let draws: Vec<GroundMotion> = (0..DRAWS).map(noisy).collect::<Option<_>>()?;
    let deviations = |moved: &dyn Fn(&GroundMotion) -> Option<Vec<f64>>| {
        let mut squares = vec![0.0; problem.bounds.len()];
        for motion in &draws {
            for (square, moved) in squares.iter_mut().zip(moved(motion)?) {
                *square += moved * moved / DRAWS as f64;
            }
        }
        Some(squares.into_iter().map(f64::sqrt).collect::<Vec<f64>>())
    };
    let mut noise = deviations(&|motion| derivatives.moved_by(motion))?;
    let counts = |(deviation, interval): (&f64, &Option<Interval>)| {
        interval.is_some_and(|Interval { ends: [low, high], .. }| {
            *deviation > NOTHING * 0.25 * (high - low)
        })
    };
    if noise.iter().zip(&found.intervals).any(counts) {
        noise = deviations(&|motion| fitted_anew(found, problem, data, scales, motion))?;
    }
    let shifts = match curved(data.motion) {
        Some(curved) => derivatives.moved_by(&curved)?,
        None => vec![0.0; noise.len()],
    };
    let by_gain = match gain {
        0.0 => vec![0.0; noise.len()],
        gain => derivatives.moved_by(&data.motion.scaled(1.0 / (1.0 + gain)).ok()?)?,
    };
    let all = noise.into_iter().zip(shifts).zip(by_gain);
    Some(all.map(|((deviation, shift), by_gain)| Moves { deviation, shift, by_gain }).collect())
}

/// How far the best values move when their own response is fitted under another table motion.
fn fitted_anew(
    found: &Fitted,
    problem: &Problem,
    data: &Data,
    scales: &[f64],
    motion: &GroundMotion,
) -> Option<Vec<f64>> {
    let values = problem.parameters(&found.minimum.unit);
    // What the best values and the transducers as they were found show, without noise.
    let sights = data.sights(&(data.build)(&values)?, data.motion)?;
    let best = data.remainders(&sights, None, scales)?;
    let shown: Vec<Vec<f64>> = best
        .iter()
        .zip(&sights)
        .map(|(best, sight)| best.left.iter().zip(&sight.measured).map(|(r, m)| m + r).collect())
        .collect();
    let residuals = |p: &[f64]| {
        let sights = data.sights(&(data.build)(p)?, motion)?;
        Some(weighed(&data.remainders(&sights, Some(&shown), scales)?, scales))
    };
    let again = Problem { bounds: problem.bounds.clone(), residuals: &residuals };
    let moved = problem.parameters(&refine(&again, &found.minimum.unit)?.unit);
    Some(moved.iter().zip(&values).map(|(moved, value)| moved - value).collect())
}

/// The residuals at the best values and their derivatives.
struct Derivatives<'a> {
    data: &'a Data<'a>,
    scales: &'a [f64],
    model: Model,
    plain: Vec<f64>,
    /// A column a parameter.
    columns: Vec<Vec<f64>>,
}

impl<'a> Derivatives<'a> {
    fn new(
        found: &Fitted,
        problem: &Problem,
        data: &'a Data<'a>,
        scales: &'a [f64],
    ) -> Option<Self> {
        let values = problem.parameters(&found.minimum.unit);
        let columns = found.derivatives(problem, |values| data.residuals(values, scales))?;
        let model = (data.build)(&values)?;
        let plain = data.residuals(&values, scales)?;
        Some(Self { data, scales, model, plain, columns })
    }

    /// How far the estimates move under another table motion.
    fn moved_by(&self, motion: &GroundMotion) -> Option<Vec<f64>> {
        let sights = self.data.sights(&self.model, motion)?;
        let other = weighed(&self.data.remainders(&sights, None, self.scales)?, self.scales);
        let row = |i: usize| self.columns.iter().map(|column| column[i]).collect::<Vec<f64>>();
        let rows: Vec<(Vec<f64>, f64)> =
            (0..self.plain.len()).map(|i| (row(i), self.plain[i] - other[i])).collect();
        Some(linear_fit(&rows)?.coefficients)
    }
}

/// The motion on the cubic through four samples; `None` for uneven samples.
fn curved(motion: &GroundMotion) -> Option<GroundMotion> {
    /// A sample is divided into so many straight lines, which miss 1/64 of the area under a parabola.
    const POINTS: usize = 8;
    let dt_s = motion.dt_s()?;
    let a = motion.horizontal_m_per_s2();
    let mut fine = Vec::with_capacity(POINTS * a.len());
    for i in 0..a.len() - 1 {
        let four = [a[i.saturating_sub(1)], a[i], a[i + 1], a[(i + 2).min(a.len() - 1)]];
        fine.extend((0..POINTS).map(|part| cubic(four, part as f64 / POINTS as f64)));
    }
    fine.extend(a.last());
    GroundMotion::evenly_spaced(dt_s / POINTS as f64, fine, None).ok()
}

/// Lagrange's cubic through values at −1, 0, 1 and 2.
fn cubic([a, b, c, d]: [f64; 4], u: f64) -> f64 {
    let [before, after, beyond] = [u + 1.0, u - 1.0, u - 2.0];
    before * after * beyond * b / 2.0 - before * u * beyond * c / 2.0 - u * after * beyond * a / 6.0
        + before * u * after * d / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_through_four_values() {
        let y = |x: f64| 2.0 - x + 0.5 * x * x - 0.25 * x * x * x;
        for u in [0.0, 0.125, 0.5, 1.0] {
            assert!((cubic([-1.0, 0.0, 1.0, 2.0].map(y), u) - y(u)).abs() < 1e-15);
        }
    }
}
