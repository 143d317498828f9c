//! What the noise of the table's accelerometer, and the motion between its samples, do to estimates.
//!
//! The model is driven by the measured table acceleration. With the Jacobian `J` of the residuals `r` at
//! the best values, a change `δr` that comes from another table motion moves the estimates by
//!
//! ```text
//! δp = −(Jᵀ J)⁻¹ Jᵀ δr
//! ```
//!
//! `δr` is computed for draws of the noise on top of the measured motion, and for the motion that passes
//! midway between samples on the cubic through four of them instead of the straight line.

use super::{Data, Found, weighed};
use crate::laboratory::fit::{Interval, Problem};
use crate::motion::GroundMotion;
use crate::numerics::algebra::linear_fit;
use crate::numerics::distribution::normal_quantile;
use crate::numerics::fractile::upper_median;
use crate::numerics::random::Random;

/// Draws of the noise: its standard deviation is known to a seventh.
const DRAWS: usize = 24;
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

/// Widens intervals by what moves the estimates through the table motion.
pub(super) fn widen(
    found: &mut Found,
    problem: &Problem,
    data: &Data,
    scales: &[f64],
    noise_m_per_s2: f64,
    seed: u64,
) {
    let Some(moves) = moves(found, problem, data, scales, noise_m_per_s2, seed) else { return };
    let z = normal_quantile(0.975);
    let values = problem.parameters(&found.minimum.unit);
    for ((interval, deviation), value) in found.intervals.iter_mut().zip(moves).zip(values) {
        let Some(Interval { ends, .. }) = interval else { continue };
        let wider = |end: f64| {
            let (half, more) = (end - value, z * deviation);
            value + half.signum() * (half * half + more * more).sqrt()
        };
        *ends = ends.map(wider);
    }
}

/// Standard deviations of the estimates for what is not known of the table motion; `None` where the
/// derivatives tell nothing.
fn moves(
    found: &Found,
    problem: &Problem,
    data: &Data,
    scales: &[f64],
    noise_m_per_s2: f64,
    seed: u64,
) -> Option<Vec<f64>> {
    let values = problem.parameters(&found.minimum.unit);
    let count = values.len();
    let model = (data.build)(&values)?;
    // Derivatives over half of each interval: closer by, single events would count for too much.
    let mut columns = Vec::with_capacity(count);
    for index in 0..count {
        let [low, high] = found.intervals[index]?.ends;
        let [least, most] = problem.bounds[index];
        let step = 0.25 * (high - low);
        let [from, to] =
            [values[index] - step, values[index] + step].map(|value| value.clamp(least, most));
        if !(to > from) {
            return None;
        }
        let at = |value: f64| {
            let mut moved = values.clone();
            moved[index] = value;
            data.residuals(&moved, scales)
        };
        let (from_r, to_r) = (at(from)?, at(to)?);
        let slope = from_r.iter().zip(&to_r).map(|(a, b)| (b - a) / (to - from));
        columns.push(slope.collect::<Vec<f64>>());
    }
    let plain = data.residuals(&values, scales)?;
    let moved_by = |motion: &GroundMotion| -> Option<Vec<f64>> {
        let other = weighed(&data.of_model_under(&model, motion)?, scales);
        let row = |i: usize| columns.iter().map(|column| column[i]).collect::<Vec<f64>>();
        let rows: Vec<(Vec<f64>, f64)> =
            (0..plain.len()).map(|i| (row(i), plain[i] - other[i])).collect();
        Some(linear_fit(&rows)?.coefficients)
    };
    let mut random = Random::new(seed);
    let mut square = vec![0.0; count];
    let a = data.motion.horizontal_m_per_s2();
    let times_s = data.motion.times_s();
    for _ in 0..DRAWS {
        let noisy = a.iter().map(|a| a + noise_m_per_s2 * random.normal()).collect();
        let motion = GroundMotion::new(times_s.to_vec(), noisy, None).ok()?;
        for (square, moved) in square.iter_mut().zip(moved_by(&motion)?) {
            *square += moved * moved / DRAWS as f64;
        }
    }
    if let Some(curved) = curved(data.motion) {
        for (square, moved) in square.iter_mut().zip(moved_by(&curved)?) {
            *square += moved * moved;
        }
    }
    Some(square.into_iter().map(f64::sqrt).collect())
}

/// The motion with a sample midway between all others, on the cubic through four of them; `None`
/// for uneven samples.
fn curved(motion: &GroundMotion) -> Option<GroundMotion> {
    let dt_s = motion.dt_s()?;
    let a = motion.horizontal_m_per_s2();
    let mut fine = Vec::with_capacity(2 * a.len());
    for i in 0..a.len() - 1 {
        let before = a[i.saturating_sub(1)];
        let after = a[(i + 2).min(a.len() - 1)];
        fine.extend([a[i], (9.0 * (a[i] + a[i + 1]) - before - after) / 16.0]);
    }
    fine.extend(a.last());
    GroundMotion::evenly_spaced(0.5 * dt_s, fine, None).ok()
}
