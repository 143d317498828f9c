//! Kinetic friction over the sliding speed: slow, fast and the rate between them.
//!
//! ```text
//! μ(v) = fast − (fast − slow) e^(−rate v)        v = |ẋ|
//! ```
//!
//! Every cycle tells friction (mean of both ways) in some classes of speed; a curve is laid through them
//! by least squares in which all cycles count alike. Its variance is that of cycles: they are taken as
//! independent, and nothing is assumed of the classes within one. With `J` the derivatives, `A = JᵀJ`,
//! `H = J A⁻¹ Jᵀ` and `r` the residuals, a quantity with the gradient `d` has
//!
//! ```text
//! V = Σ_c (q_c · r_c)²,    q_c = (I − H_cc)^(−1/2) J_c A⁻¹ d
//! ν = (tr G)² / |G|²,      G_cd = q_c · (I − H)_cd q_d
//! ```
//!
//! (Bell and McCaffrey, Survey Methodology 28 (2002)). Its interval is that of the profile: as far as the
//! sum of squares rises by `t_ν² V / (dᵀ A⁻¹ d)`, which for a line is `± t_ν √V`.

use core::ops::Range;

use super::Cycle;
use crate::laboratory::estimate::Estimate;
use crate::laboratory::fit::{Minimum, Problem, Profile, global, profile};
use crate::numerics::algebra::{Matrix, dot, inverse, times};
use crate::numerics::distribution::student_quantile;

/// Speeds are different where they differ by this ratio.
const APART: f64 = 1.1;
/// The change of friction counts where it is this many times the half width of its interval.
const CLEAR_CHANGE: f64 = 3.0;
/// Parts of the curve.
const PARTS: usize = 60;

/// Kinetic friction over speed, of both ways together.
#[derive(Clone, Debug, PartialEq)]
pub struct RateFit {
    /// Slow and fast friction, as a coefficient or in N, and the rate in s/m.
    ///
    /// Refused are all three where fewer than three different speeds were tested, or where friction does
    /// not change clearly with speed; each one whose interval has an end that the data do not set: slow
    /// friction and rate where even the slowest speed is above the knee of the curve, fast friction and
    /// rate where even the fastest is below it.
    pub estimates: [Estimate; 3],
    /// The fitted curve over the speeds that were tested; empty where there is none.
    pub curve: Vec<CurvePoint>,
}

/// A point of the fitted curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Sliding speed in m/s.
    pub speed_m_per_s: f64,
    /// Friction there, as a coefficient or in N.
    pub friction: f64,
    /// Ends of its 95 % interval.
    pub interval: [f64; 2],
}

/// Friction of a cycle in a class of speeds.
struct Point {
    speed: f64,
    spread: f64,
    friction: f64,
    /// Square root of its weight: each cycle counts as one.
    root: f64,
}

impl Point {
    /// The mean of `e^(−rate v)` over the class, and its derivative with respect to ln rate.
    fn fade(&self, rate: f64) -> [f64; 2] {
        let both = [(self.speed - self.spread).max(0.0), self.speed + self.spread];
        let e = both.map(|v| 0.5 * libm::exp(-rate * v));
        [e[0] + e[1], -rate * (both[0] * e[0] + both[1] * e[1])]
    }

    fn at(speed: f64) -> Self {
        Self { speed, spread: 0.0, friction: 0.0, root: 1.0 }
    }

    /// Friction on the curve with `[slow, fast, ln rate]`.
    fn on(&self, parameters: &[f64]) -> Option<f64> {
        let [slow, fast, ln_rate] = *parameters else { return None };
        Some(fast - (fast - slow) * self.fade(libm::exp(ln_rate))[0])
    }

    /// The gradient of that.
    fn gradient(&self, [slow, fast, ln_rate]: [f64; 3]) -> [f64; 3] {
        let [fade, change] = self.fade(libm::exp(ln_rate));
        [fade, 1.0 - fade, -(fast - slow) * change]
    }
}

/// Lays the curve through all cycles; `why_not` is why nothing slid, if so.
pub(super) fn slow_fast_rate(
    cycles: &[&Cycle],
    why_not: Option<&str>,
    normal_force_n: Option<f64>,
) -> RateFit {
    let (over_n, unit, force) = normal_force_n.map_or((1.0, "N", "_force"), |n| (n, "", ""));
    let keys = [("slow", unit), ("fast", unit), ("rate", "s/m")];
    let named = keys.map(|(key, unit)| (format!("slider.kinetic_friction{force}.{key}"), unit));
    let (points, ranges) = points(cycles, over_n);
    match why_not.map_or_else(|| fitted(&points, &ranges), |why| Err(why.to_owned())) {
        Ok((outcomes, curve)) => {
            let mut outcomes = outcomes.into_iter();
            let estimates = named.map(|(path, unit)| match outcomes.next() {
                Some(Ok((value, ends))) => Estimate::determined(path, unit, value, ends),
                Some(Err(why)) => Estimate::refused(path, unit, why),
                None => Estimate::refused(path, unit, ""),
            });
            RateFit { estimates, curve }
        }
        Err(why) => {
            let estimates = named.map(|(path, unit)| Estimate::refused(path, unit, why.as_str()));
            RateFit { estimates, curve: Vec::new() }
        }
    }
}

/// What all cycles tell, and which of it each.
fn points(cycles: &[&Cycle], over_n: f64) -> (Vec<Point>, Vec<Range<usize>>) {
    let (mut points, mut ranges) = (Vec::new(), Vec::new());
    for cycle in cycles {
        let start = points.len();
        let root = 1.0 / (cycle.by_speed.len() as f64).sqrt();
        points.extend(cycle.by_speed.iter().map(|at| Point {
            speed: at.speed_m_per_s,
            spread: at.spread_m_per_s,
            friction: 0.5 * (at.kinetic_n[0] + at.kinetic_n[1]) / over_n,
            root,
        }));
        ranges.push(start..points.len());
    }
    (points, ranges)
}

/// A value with the ends of its interval, or why there is none.
type SpeedEstimate = Result<(f64, [f64; 2]), String>;

/// Slow, fast, rate and the curve; else why none of them.
fn fitted(
    points: &[Point],
    cycles: &[Range<usize>],
) -> Result<([SpeedEstimate; 3], Vec<CurvePoint>), String> {
    let mut speeds: Vec<f64> = points.iter().map(|point| point.speed).collect();
    speeds.sort_by(f64::total_cmp);
    let mut different: Vec<f64> = Vec::new();
    for speed in speeds {
        if different.last().is_none_or(|last| speed > APART * last) {
            different.push(speed);
        }
    }
    let [slowest, fastest] = points.iter().fold([f64::INFINITY, 0.0], |[low, high], point| {
        [point.speed.min(low), point.speed.max(high)]
    });
    let range = format!("{slowest:.3e} to {fastest:.3e} m/s");
    if different.len() < 3 {
        let found = if different.len() == 1 { "one speed" } else { "two speeds" };
        return Err(format!(
            "all cycles slide at {found} ({range}), and three unknowns need three speeds or more, a \
             tenth apart at least"
        ));
    }
    let largest = points.iter().fold(0.0, |m: f64, point| m.max(point.friction));
    let least_rate = 1e-3 / fastest;
    let most_rate = 50.0 / slowest;
    let ln = |x: f64| libm::log(x);
    let problem = Problem {
        bounds: vec![[0.0, 3.0 * largest], [0.0, 3.0 * largest], [ln(least_rate), ln(most_rate)]],
        residuals: &|p| {
            points.iter().map(|point| Some(point.root * (point.on(p)? - point.friction))).collect()
        },
    };
    let at = |speed: f64| {
        points.iter().find(|point| point.speed == speed).map_or(largest, |point| point.friction)
    };
    let start = [at(slowest), at(fastest), -0.5 * (ln(slowest) + ln(fastest))];
    let flat = || format!("friction does not change clearly with speed from {range}");
    let mut minimum = global(&problem, Some(&start), 1).ok_or_else(flat)?;
    'better: for _ in 0..8 {
        let spread = Spread::new(&problem, &minimum, points, cycles).ok_or_else(flat)??;
        let [low, high] = [slowest, fastest].map(|v| Point::at(v).gradient(spread.parameters));
        let change = spread.half_width([0, 1, 2].map(|k| high[k] - low[k]));
        let [low, high] = [slowest, fastest].map(|v| Point::at(v).on(&spread.parameters));
        let changes = high.zip(low).map_or(0.0, |(high, low)| (high - low).abs());
        if !(changes > CLEAR_CHANGE * change) {
            return Err(flat());
        }
        let mut found = Vec::new();
        for k in 0..3 {
            let unit = [0, 1, 2].map(|i| if i == k { 1.0 } else { 0.0 });
            let half = spread.half_width(unit).max(1e-9 * spread.parameters[k].abs().max(1e-3));
            let rise = half * half / spread.inverse[k][k];
            match profile(&problem, &minimum, k, 1.0, rise) {
                Profile::Interval(interval) => found.push(interval),
                Profile::Better(better) => {
                    minimum = better;
                    continue 'better;
                }
            }
        }
        let open = |k: usize| found.get(k).map_or([true; 2], |interval| interval.open);
        // What bounds the rate where slow or fast friction is not told is their range, not the data.
        let above = open(0) != [false; 2] || open(2)[1];
        let below = open(1) != [false; 2] || open(2)[0];
        if above && below {
            return Err(flat());
        }
        let too_fast = format!(
            "even the slowest speed tested, {slowest:.3e} m/s, lies above the knee of the curve: \
             slower tests are needed"
        );
        let too_slow = format!(
            "even the fastest speed tested, {fastest:.3e} m/s, lies below the knee of the curve: \
             faster tests are needed"
        );
        let told = |k: usize| {
            let ends = found.get(k).map_or([f64::NAN; 2], |interval| interval.ends);
            let value = spread.parameters[k];
            if k == 2 { (libm::exp(value), ends.map(libm::exp)) } else { (value, ends) }
        };
        let outcomes = [(0, above, false), (1, false, below), (2, above, below)].map(
            |(k, above, below)| match (above, below) {
                (true, _) => Err(too_fast.clone()),
                (_, true) => Err(too_slow.clone()),
                _ => Ok(told(k)),
            },
        );
        let curve = (0..=PARTS).filter_map(|i| {
            let part = i as f64 / PARTS as f64;
            let speed = libm::exp(ln(slowest) + part * ln(fastest / slowest));
            let point = Point::at(speed);
            let friction = point.on(&spread.parameters)?;
            let half = spread.half_width(point.gradient(spread.parameters));
            let interval = [friction - half, friction + half];
            Some(CurvePoint { speed_m_per_s: speed, friction, interval })
        });
        return Ok((outcomes, curve.collect()));
    }
    Err("the fit does not settle".to_owned())
}

/// What the cycles' residuals say of the variance of the fit.
struct Spread {
    parameters: [f64; 3],
    /// `(JᵀJ)⁻¹`.
    inverse: Matrix,
    /// Of each cycle its rows of `J`, its residuals and `(I − H_cc)^(−1/2)`.
    cycles: Vec<(Vec<[f64; 3]>, Vec<f64>, Matrix)>,
}

impl Spread {
    /// `None` where the cycles do not determine the unknowns, a reason where one of them alone does.
    fn new(
        problem: &Problem,
        minimum: &Minimum,
        points: &[Point],
        cycles: &[Range<usize>],
    ) -> Option<Result<Self, String>> {
        let parameters: [f64; 3] = problem.parameters(&minimum.unit).try_into().ok()?;
        let residuals = (problem.residuals)(&parameters)?;
        let row = |point: &Point| point.gradient(parameters).map(|g| point.root * g);
        let rows: Vec<[f64; 3]> = points.iter().map(row).collect();
        let normal = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
        let inverse =
            inverse(&[0, 1, 2].map(|i| vec![normal(i, 0), normal(i, 1), normal(i, 2)]).to_vec())?;
        let cycle = |range: &Range<usize>| {
            let own = &rows[range.clone()];
            let less = |(i, a): (usize, &[f64; 3])| {
                let entry = |(j, b): (usize, &[f64; 3])| {
                    let one = if i == j { 1.0 } else { 0.0 };
                    one - dot(a, &times(&inverse, b))
                };
                own.iter().enumerate().map(entry).collect()
            };
            let matrix = own.iter().enumerate().map(less).collect();
            Some((own.to_vec(), residuals[range.clone()].to_vec(), inverse_root(matrix)?))
        };
        let cycles: Option<Vec<_>> = cycles.iter().map(cycle).collect();
        let why = "slow, fast and rate would follow from a single cycle: more cycles are needed";
        let spread = cycles.map(|cycles| Self { parameters, cycles, inverse });
        Some(spread.ok_or_else(|| why.to_owned()))
    }

    /// Half the 95 % interval of a quantity with a gradient.
    fn half_width(&self, gradient: [f64; 3]) -> f64 {
        let towards = times(&self.inverse, &gradient);
        let (mut variance, mut weights) = (0.0, Vec::new());
        for (rows, residuals, root) in &self.cycles {
            let plain: Vec<f64> = rows.iter().map(|row| dot(row, &towards)).collect();
            let q = times(root, &plain);
            let score = dot(&q, residuals);
            variance += score * score;
            let z = [0, 1, 2].map(|k| rows.iter().zip(&q).map(|(row, q)| row[k] * q).sum::<f64>());
            weights.push((dot(&q, &q), z));
        }
        let (mut trace, mut square) = (0.0, 0.0);
        for (c, (own, z)) in weights.iter().enumerate() {
            let turned = times(&self.inverse, z);
            for (d, (_, other)) in weights.iter().enumerate() {
                let entry = if c == d { *own } else { 0.0 } - dot(&turned, other);
                square += entry * entry;
                trace += if c == d { entry } else { 0.0 };
            }
        }
        let freedom = trace * trace / square;
        if variance > 0.0 && freedom >= 1.0 {
            student_quantile(0.95, freedom) * variance.sqrt()
        } else if variance > 0.0 {
            f64::INFINITY
        } else {
            0.0
        }
    }
}

/// The inverse of the root of a symmetric positive definite matrix, by the iteration of Denman and
/// Beavers; `None` where it is singular.
fn inverse_root(matrix: Matrix) -> Option<Matrix> {
    let n = matrix.len();
    let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let mut z: Matrix = (0..n).map(|i| (0..n).map(|j| unit(i, j)).collect()).collect();
    let mut y = matrix;
    let middle = |a: &Matrix, b: &Matrix| -> Matrix {
        let row =
            |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect();
        a.iter().zip(b).map(row).collect()
    };
    for _ in 0..40 {
        let (y_inverse, z_inverse) = (inverse(&y)?, inverse(&z)?);
        let next = (middle(&y, &z_inverse), middle(&z, &y_inverse));
        let moved = |a: &Matrix, b: &Matrix| {
            a.iter()
                .flatten()
                .zip(b.iter().flatten())
                .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
        };
        let change = moved(&z, &next.1);
        (y, z) = next;
        if change < 1e-13 * z.iter().flatten().fold(1.0, |m: f64, v| m.max(v.abs())) {
            break;
        }
    }
    Some(z)
}

#[cfg(test)]
mod tests;
