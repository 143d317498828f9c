//! Kinetic friction over the sliding speed and the pressure.
//!
//! ```text
//! μ(v, p) = μ(v) (p/p_ref)^(−m)
//! μ(v) = fast − (fast − slow) e^(−rate v), v = |ẋ|, or one coefficient
//! ```
//!
//! Every cycle tells friction (mean of both ways) in some classes of speed, under one pressure; a curve is laid
//! through them by least squares in which all cycles count alike. Its variance is that of cycles: they are taken
//! as independent, and nothing is assumed of the classes within one. With `J` the derivatives, `A = JᵀJ`,
//! `H = J A⁻¹ Jᵀ` and `r` the residuals, a quantity with the gradient `d` has
//!
//! ```text
//! V = Σ_c (q_c · r_c)²,    q_c = (I − H_cc)^(−1/2) J_c A⁻¹ d
//! ν = (tr G)² / |G|²,      G_cd = q_c · (I − H)_cd q_d
//! ```
//!
//! (Bell and McCaffrey, Survey Methodology 28 (2002)). Its interval is that of the profile: as far as the
//! sum of squares rises by `t_ν² V / (dᵀ A⁻¹ d)`, which for a line is `± t_ν √V`.
//!
//! Under several pressures residuals count over `(p/p_ref)^(−m₀)`, with `m₀` from the means of the cycles: friction
//! scatters by a part of itself, whatever the pressure.

use core::ops::Range;

use crate::laboratory::estimate::Estimate;
use crate::laboratory::fit::{Interval, Minimum, Problem, Profile, global, profile};
use crate::numerics::algebra::{Matrix, dot, inverse, linear_fit, times};
use crate::numerics::distribution::student_quantile;

/// Speeds are different where they differ by this ratio.
const APART: f64 = 1.1;
/// The change of friction counts where it is this many times the half width of its interval.
const CLEAR_CHANGE: f64 = 3.0;
/// Parts of the curve.
const PARTS: usize = 60;

/// Kinetic friction over speed, of both ways together; at the reference pressure, where it follows the pressure too.
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

impl RateFit {
    /// That of a fit, or of why there is none; friction is a coefficient, or a force.
    pub(super) fn new(fit: Result<&CurveFit, &str>, is_coefficient: bool) -> Self {
        let (unit, force) = if is_coefficient { ("", "") } else { ("N", "_force") };
        let keys = [("slow", unit), ("fast", unit), ("rate", "s/m")];
        let named = keys.map(|(key, unit)| (format!("slider.kinetic_friction{force}.{key}"), unit));
        match fit {
            Ok(CurveFit { friction, by_speed, .. }) => {
                let mut outcomes = friction.iter();
                let estimates = named.map(|(path, unit)| match outcomes.next() {
                    Some(Ok((value, ends))) => Estimate::determined(path, unit, *value, *ends),
                    Some(Err(why)) => Estimate::refused(path, unit, why.as_str()),
                    None => Estimate::refused(path, unit, ""),
                });
                Self { estimates, curve: by_speed.clone() }
            }
            Err(why) => {
                let estimates = named.map(|(path, unit)| Estimate::refused(path, unit, why));
                Self { estimates, curve: Vec::new() }
            }
        }
    }
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

/// What a cycle tells of kinetic friction, under its normal force.
pub(super) struct CurveCycle {
    /// Friction by class of speeds, as a coefficient or in N.
    pub classes: Vec<ClassFriction>,
    /// `ln(p/p_ref)`.
    pub ln_pressure: f64,
}

/// Friction in a class of speeds: a coefficient or a force in N.
pub(super) struct ClassFriction {
    pub speed_m_per_s: f64,
    pub spread_m_per_s: f64,
    pub friction: f64,
}

impl CurveCycle {
    /// The mean over its classes.
    pub fn mean(&self) -> f64 {
        let sum: f64 = self.classes.iter().map(|class| class.friction).sum();
        sum / self.classes.len() as f64
    }
}

/// What kinetic friction follows. Parameters are the coefficient, or slow, fast and ln rate, and then the exponent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Follows {
    pub speed: bool,
    pub pressure: bool,
}

impl Follows {
    /// How many parameters friction at the reference pressure has; the next is the exponent.
    fn friction_count(self) -> usize {
        if self.speed { 3 } else { 1 }
    }

    fn count(self) -> usize {
        self.friction_count() + usize::from(self.pressure)
    }

    /// At the reference pressure.
    fn at_reference(self, parameters: &[f64], point: &Point) -> f64 {
        match *parameters {
            [slow, fast, ln_rate, ..] if self.speed => {
                fast - (fast - slow) * point.fade(libm::exp(ln_rate))[0]
            }
            _ => parameters[0],
        }
    }

    /// `(p/p_ref)^(−m)`.
    fn factor(self, parameters: &[f64], ln_pressure: f64) -> f64 {
        match parameters.get(self.friction_count()) {
            Some(exponent) => libm::exp(-exponent * ln_pressure),
            None => 1.0,
        }
    }

    fn friction(self, parameters: &[f64], point: &Point) -> f64 {
        self.at_reference(parameters, point) * self.factor(parameters, point.ln_pressure)
    }

    /// The gradient of [`friction`](Self::friction).
    fn gradient(self, parameters: &[f64], point: &Point) -> Vec<f64> {
        let mut gradient = match *parameters {
            [slow, fast, ln_rate, ..] if self.speed => {
                let [fade, change] = point.fade(libm::exp(ln_rate));
                vec![fade, 1.0 - fade, -(fast - slow) * change]
            }
            _ => vec![1.0],
        };
        if self.pressure {
            let factor = self.factor(parameters, point.ln_pressure);
            gradient.iter_mut().for_each(|of| *of *= factor);
            gradient.push(-point.ln_pressure * self.friction(parameters, point));
        }
        gradient
    }
}

/// Friction of a cycle in a class of speeds.
struct Point {
    speed: f64,
    spread: f64,
    ln_pressure: f64,
    friction: f64,
    /// The friction brought to the reference pressure over itself, by the exponent that the means tell.
    to_reference: f64,
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

    /// At one speed and a pressure.
    fn at(speed: f64, ln_pressure: f64) -> Self {
        Self { speed, spread: 0.0, ln_pressure, friction: 0.0, to_reference: 1.0, root: 1.0 }
    }
}

/// What all cycles tell, and which of it each; `exponent` is about that of the pressure.
fn points(cycles: &[CurveCycle], exponent: f64) -> (Vec<Point>, Vec<Range<usize>>) {
    let (mut points, mut ranges) = (Vec::new(), Vec::new());
    for CurveCycle { classes, ln_pressure } in cycles {
        let start = points.len();
        let to_reference = libm::exp(exponent * ln_pressure);
        let root = to_reference / (classes.len() as f64).sqrt();
        points.extend(classes.iter().map(|class| Point {
            speed: class.speed_m_per_s,
            spread: class.spread_m_per_s,
            ln_pressure: *ln_pressure,
            friction: class.friction,
            to_reference,
            root,
        }));
        ranges.push(start..points.len());
    }
    (points, ranges)
}

/// The exponent of a straight line through the logarithms of the cycles' means.
fn exponent_of_means(cycles: &[CurveCycle]) -> Option<f64> {
    let rows = cycles.iter().filter(|cycle| cycle.mean() > 0.0);
    let rows: Vec<([f64; 2], f64)> =
        rows.map(|cycle| ([1.0, cycle.ln_pressure], libm::log(cycle.mean()))).collect();
    linear_fit(&rows).map(|line| -line.coefficients[1])
}

/// A value with the ends of its interval, or why there is none.
type FrictionEstimate = Result<(f64, [f64; 2]), String>;

/// A curve that was laid through all cycles.
pub(super) struct CurveFit {
    /// The coefficient, or slow, fast and rate.
    pub friction: Vec<FrictionEstimate>,
    /// The exponent of the pressure and its interval, where friction follows it.
    pub exponent: Option<(f64, Interval)>,
    /// The curve over the speed, where friction follows it.
    by_speed: Vec<CurvePoint>,
    follows: Follows,
    spread: Spread,
}

impl CurveFit {
    /// Lays the curve; else why there is none.
    pub fn new(cycles: &[CurveCycle], follows: Follows) -> Result<Self, String> {
        let unsettled = || "the fit does not settle".to_owned();
        let exponent = match follows.pressure {
            true => exponent_of_means(cycles).ok_or_else(unsettled)?,
            false => 0.0,
        };
        let (points, ranges) = points(cycles, exponent);
        let largest = points.iter().fold(0.0, |m: f64, p| m.max(p.to_reference * p.friction));
        let speeds = follows.speed.then(|| Speeds::new(&points)).transpose()?;
        let mut bounds = vec![[0.0, 3.0 * largest]];
        let mut start = vec![largest];
        if let Some(speeds) = &speeds {
            bounds = vec![bounds[0], bounds[0], speeds.ln_rates()];
            start = speeds.start(&points, largest);
        }
        if follows.pressure {
            bounds.push([exponent - 1.0, exponent + 1.0]);
            start.push(exponent);
        }
        let problem = Problem {
            bounds,
            residuals: &|p| {
                let left = |of: &Point| of.root * (follows.friction(p, of) - of.friction);
                Some(points.iter().map(left).collect())
            },
        };
        let flat = || speeds.as_ref().map_or_else(unsettled, Speeds::flat);
        let mut minimum = global(&problem, Some(&start), 1).ok_or_else(flat)?;
        'better: for _ in 0..8 {
            let spread =
                Spread::new(&problem, &minimum, &points, &ranges, follows).ok_or_else(flat)??;
            if let Some(speeds) = &speeds {
                speeds.check_change(&spread, follows)?;
            }
            let mut found = Vec::new();
            for k in 0..follows.count() {
                let unit = (0..follows.count()).map(|i| if i == k { 1.0 } else { 0.0 });
                let half = spread.half_width(&unit.collect::<Vec<f64>>());
                let half = half.max(1e-9 * spread.parameters[k].abs().max(1e-3));
                let rise = half * half / spread.inverse[k][k];
                match profile(&problem, &minimum, k, 1.0, rise) {
                    Profile::Interval(interval) => found.push(interval),
                    Profile::Better(better) => {
                        minimum = better;
                        continue 'better;
                    }
                }
            }
            let at = |k: usize| spread.parameters.get(k).copied().zip(found.get(k).copied());
            let exponent = at(follows.friction_count());
            let (friction, by_speed) = match &speeds {
                Some(speeds) => (speeds.outcomes(&spread, &found)?, speeds.curve(&spread, follows)),
                None => {
                    (at(0).map(|(value, of)| Ok((value, of.ends))).into_iter().collect(), vec![])
                }
            };
            return Ok(Self { friction, exponent, by_speed, follows, spread });
        }
        Err(unsettled())
    }

    /// Friction of a cycle as it is drawn over the pressure: itself, or where friction follows the speed too, over that
    /// of the curve at the reference pressure.
    pub fn over_pressure(&self, cycle: &CurveCycle) -> f64 {
        if !self.follows.speed {
            return cycle.mean();
        }
        let at_reference = |class: &ClassFriction| {
            let spread = class.spread_m_per_s;
            let point = Point { spread, ..Point::at(class.speed_m_per_s, 0.0) };
            self.follows.at_reference(&self.spread.parameters, &point)
        };
        let sum: f64 = cycle.classes.iter().map(at_reference).sum();
        cycle.mean() / (sum / cycle.classes.len() as f64)
    }

    /// The curve over the pressure, `ln(p/p_ref)`, as [`over_pressure`](Self::over_pressure), and half its 95 % interval.
    pub fn at_pressure(&self, ln_pressure: f64) -> (f64, f64) {
        let parameters = &self.spread.parameters;
        let point = Point::at(0.0, ln_pressure);
        if !self.follows.speed {
            let half = self.spread.half_width(&self.follows.gradient(parameters, &point));
            return (self.follows.friction(parameters, &point), half);
        }
        let factor = self.follows.factor(parameters, ln_pressure);
        let mut gradient = vec![0.0; self.follows.count()];
        gradient[self.follows.friction_count()] = -ln_pressure * factor;
        (factor, self.spread.half_width(&gradient))
    }
}

/// The speeds that were tested.
struct Speeds {
    slowest_m_per_s: f64,
    fastest_m_per_s: f64,
}

impl Speeds {
    /// Refused where there are fewer than three.
    fn new(points: &[Point]) -> Result<Self, String> {
        let mut speeds: Vec<f64> = points.iter().map(|point| point.speed).collect();
        speeds.sort_by(f64::total_cmp);
        let mut different: Vec<f64> = Vec::new();
        for speed in speeds {
            if different.last().is_none_or(|last| speed > APART * last) {
                different.push(speed);
            }
        }
        let [slowest_m_per_s, fastest_m_per_s] =
            points.iter().fold([f64::INFINITY, 0.0], |[low, high], point| {
                [point.speed.min(low), point.speed.max(high)]
            });
        let this = Self { slowest_m_per_s, fastest_m_per_s };
        if different.len() < 3 {
            let found = if different.len() == 1 { "one speed" } else { "two speeds" };
            return Err(format!(
                "all cycles slide at {found} ({}), and three unknowns need three speeds or more, a \
                 tenth apart at least",
                this.range()
            ));
        }
        Ok(this)
    }

    fn range(&self) -> String {
        format!("{:.3e} to {:.3e} m/s", self.slowest_m_per_s, self.fastest_m_per_s)
    }

    /// Why nothing is told where the curve is level.
    fn flat(&self) -> String {
        format!("friction does not change clearly with speed from {}", self.range())
    }

    /// The range in which the logarithm of the rate is sought.
    fn ln_rates(&self) -> [f64; 2] {
        [libm::log(1e-3 / self.fastest_m_per_s), libm::log(50.0 / self.slowest_m_per_s)]
    }

    /// Slow, fast and ln rate to start from.
    fn start(&self, points: &[Point], largest: f64) -> Vec<f64> {
        let at = |speed: f64| {
            let point = points.iter().find(|point| point.speed == speed);
            point.map_or(largest, |point| point.to_reference * point.friction)
        };
        let [slow, fast] = [self.slowest_m_per_s, self.fastest_m_per_s];
        vec![at(slow), at(fast), -0.5 * (libm::log(slow) + libm::log(fast))]
    }

    /// Refused where friction does not change clearly from the slowest to the fastest.
    fn check_change(&self, spread: &Spread, follows: Follows) -> Result<(), String> {
        let both = [self.slowest_m_per_s, self.fastest_m_per_s].map(|v| Point::at(v, 0.0));
        let [low, high] = both.each_ref().map(|point| follows.gradient(&spread.parameters, point));
        let change: Vec<f64> = high.iter().zip(&low).map(|(high, low)| high - low).collect();
        let [low, high] = both.each_ref().map(|point| follows.friction(&spread.parameters, point));
        let is_clear = (high - low).abs() > CLEAR_CHANGE * spread.half_width(&change);
        is_clear.then_some(()).ok_or_else(|| self.flat())
    }

    /// Slow, fast and rate with their intervals, or why one is not told; else why none is.
    fn outcomes(
        &self,
        spread: &Spread,
        found: &[Interval],
    ) -> Result<Vec<FrictionEstimate>, String> {
        let open = |k: usize| found.get(k).map_or([true; 2], |interval| interval.open);
        // What bounds the rate where slow or fast friction is not told is their range, not the data.
        let above = open(0) != [false; 2] || open(2)[1];
        let below = open(1) != [false; 2] || open(2)[0];
        if above && below {
            return Err(self.flat());
        }
        let too_fast = format!(
            "even the slowest speed tested, {:.3e} m/s, lies above the knee of the curve: \
             slower tests are needed",
            self.slowest_m_per_s
        );
        let too_slow = format!(
            "even the fastest speed tested, {:.3e} m/s, lies below the knee of the curve: \
             faster tests are needed",
            self.fastest_m_per_s
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
        Ok(outcomes.to_vec())
    }

    /// The curve over the speeds, at the reference pressure.
    fn curve(&self, spread: &Spread, follows: Follows) -> Vec<CurvePoint> {
        let [slowest, fastest] = [self.slowest_m_per_s, self.fastest_m_per_s];
        let point = |i: usize| {
            let part = i as f64 / PARTS as f64;
            let speed = libm::exp(libm::log(slowest) + part * libm::log(fastest / slowest));
            let point = Point::at(speed, 0.0);
            let friction = follows.friction(&spread.parameters, &point);
            let half = spread.half_width(&follows.gradient(&spread.parameters, &point));
            let interval = [friction - half, friction + half];
            CurvePoint { speed_m_per_s: speed, friction, interval }
        };
        (0..=PARTS).map(point).collect()
    }
}

/// What the cycles' residuals say of the variance of the fit.
struct Spread {
    parameters: Vec<f64>,
    /// `(JᵀJ)⁻¹`.
    inverse: Matrix,
    cycles: Vec<CycleRows>,
}

/// What a cycle adds to the fit.
struct CycleRows {
    /// Its rows of `J`.
    rows: Vec<Vec<f64>>,
    residuals: Vec<f64>,
    /// `(I − H_cc)^(−1/2)`.
    root: Matrix,
}

impl Spread {
    /// `None` where the cycles do not determine the unknowns, a reason where one of them alone does.
    fn new(
        problem: &Problem,
        minimum: &Minimum,
        points: &[Point],
        cycles: &[Range<usize>],
        follows: Follows,
    ) -> Option<Result<Self, String>> {
        let parameters = problem.parameters(&minimum.unit);
        let residuals = (problem.residuals)(&parameters)?;
        let row = |point: &Point| -> Vec<f64> {
            follows.gradient(&parameters, point).iter().map(|g| point.root * g).collect()
        };
        let rows: Vec<Vec<f64>> = points.iter().map(row).collect();
        let normal = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
        let all = 0..follows.count();
        let line = |i: usize| all.clone().map(|j| normal(i, j)).collect();
        let inverse = inverse(&all.clone().map(line).collect())?;
        let cycle = |range: &Range<usize>| {
            let own = &rows[range.clone()];
            let less = |(i, a): (usize, &Vec<f64>)| {
                let entry = |(j, b): (usize, &Vec<f64>)| {
                    let one = if i == j { 1.0 } else { 0.0 };
                    one - dot(a, &times(&inverse, b))
                };
                own.iter().enumerate().map(entry).collect()
            };
            let root = inverse_root(own.iter().enumerate().map(less).collect())?;
            Some(CycleRows {
                rows: own.to_vec(),
                residuals: residuals[range.clone()].to_vec(),
                root,
            })
        };
        let cycles: Option<Vec<_>> = cycles.iter().map(cycle).collect();
        let why = "slow, fast and rate would follow from a single cycle: more cycles are needed";
        let spread = cycles.map(|cycles| Self { parameters, cycles, inverse });
        Some(spread.ok_or_else(|| why.to_owned()))
    }

    /// Half the 95 % interval of a quantity with a gradient.
    fn half_width(&self, gradient: &[f64]) -> f64 {
        let towards = times(&self.inverse, gradient);
        let (mut variance, mut weights) = (0.0, Vec::new());
        for CycleRows { rows, residuals, root } in &self.cycles {
            let plain: Vec<f64> = rows.iter().map(|row| dot(row, &towards)).collect();
            let q = times(root, &plain);
            let score = dot(&q, residuals);
            variance += score * score;
            let along = |k: usize| rows.iter().zip(&q).map(|(row, q)| row[k] * q).sum::<f64>();
            let z: Vec<f64> = (0..gradient.len()).map(along).collect();
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
