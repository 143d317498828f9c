//! Intervals by profile likelihood: how far a parameter can move before the fit, all others fitted
//! again, is worse than chance allows.

use super::{Minimum, Problem, levenberg, simplex};
use crate::numerics::algebra::inverse;

/// Where beyond an end a second valley is looked for, in its distance from the minimum or, if that is
/// larger, in what derivatives at the minimum make of it.
const BEYOND: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 1.5, 2.0];

/// A fit that is better than the minimum by less than this part of the threshold moves an end by
/// half as much of its distance, and is no other minimum.
const BETTER: f64 = 0.01;

/// The interval of one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower and upper end, in the parameter's own unit.
    pub ends: [f64; 2],
    /// Whether the fit is still good enough at the lower and the upper bound of the parameter: the
    /// end is that bound.
    pub open: [bool; 2],
}

/// What a profile finds.
pub enum Profile {
    /// The interval.
    Interval(Interval),
    /// A better fit than the one it started from.
    Better(Minimum),
}

/// The interval of parameter `index` in which the sum of squares, the others fitted again, rises by
/// less than `threshold` times `variance` over that of the minimum.
///
/// With `variance` that of independent residuals and `threshold` the square of Student's `t` it is
/// the interval of that confidence. From the minimum the ends are sought outwards; a second valley
/// within twice the distance still counts, since the function may jump.
pub fn profile(
    problem: &Problem,
    minimum: &Minimum,
    index: usize,
    threshold: f64,
    variance: f64,
) -> Profile {
    let mut ends = [0.0, 1.0];
    let mut open = [true, true];
    for side in 0..2 {
        let mut walk = Walk::new(problem, minimum, index, variance, side == 1);
        if let Some(unit) = walk.end(threshold) {
            (ends[side], open[side]) = (unit, false);
        }
        // Not before the end: a function that jumps often falls by a little in the first small steps,
        // and whoever turns back at each of them does not arrive.
        if let Some(better) = walk.better
            && minimum.sse - better.sse > BETTER * threshold * variance
        {
            return Profile::Better(better);
        }
    }
    let [low, high] = problem.bounds[index];
    let ends = ends.map(|unit| low + unit * (high - low));
    Profile::Interval(Interval { ends, open })
}

struct Walk<'a> {
    problem: &'a Problem<'a>,
    minimum: &'a Minimum,
    index: usize,
    others: Vec<usize>,
    variance: f64,
    sign: f64,
    /// Points of the profile so far: distance from the minimum and where the others are.
    path: Vec<(f64, Vec<f64>)>,
    /// The best fit on the way that is better than the minimum.
    better: Option<Minimum>,
}

impl<'a> Walk<'a> {
    fn new(
        problem: &'a Problem<'a>,
        minimum: &'a Minimum,
        index: usize,
        variance: f64,
        upwards: bool,
    ) -> Self {
        let others = (0..problem.bounds.len()).filter(|k| *k != index).collect();
        let sign = if upwards { 1.0 } else { -1.0 };
        let path = vec![(0.0, minimum.unit.clone())];
        Self { problem, minimum, index, others, variance, sign, path, better: None }
    }

    /// Distance to the bound.
    fn reach(&self) -> f64 {
        let at = self.minimum.unit[self.index];
        if self.sign > 0.0 { 1.0 - at } else { at }
    }

    /// A first guess of the distance at which the sum of squares has risen by `threshold`.
    fn guess(&self, threshold: f64) -> f64 {
        let unit = &self.minimum.unit;
        let all: Vec<usize> = (0..unit.len()).collect();
        let error = self.problem.at(unit).and_then(|residuals| {
            let columns = levenberg::jacobian(self.problem, unit, &residuals, &all)?;
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let normal: Vec<Vec<f64>> =
                columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
            Some((self.variance * inverse(&normal)?[self.index][self.index] * threshold).sqrt())
        });
        error.filter(|e| e.is_finite() && *e > 0.0).unwrap_or(0.02).clamp(1e-6, 0.2)
    }

    /// How much the fit is worse at a distance, in variances.
    fn rise(&mut self, distance: f64) -> f64 {
        let mut start = self.extrapolated(distance);
        start[self.index] = (self.minimum.unit[self.index] + self.sign * distance).clamp(0.0, 1.0);
        // The nearest known point on the side of the minimum, which has the distance 0.
        let inside = self.path.partition_point(|(at, _)| *at < distance).max(1) - 1;
        let mut fallback = self.path[inside].1.clone();
        fallback[self.index] = start[self.index];
        let mut best: Option<Minimum> = None;
        for start in [start, fallback] {
            let found = if self.others.is_empty() {
                let sse = self.problem.sse(&start);
                Some(Minimum { unit: start, sse, count: self.minimum.count })
            } else {
                levenberg::minimise(self.problem, &start, &self.others, 20, 1e-3)
            };
            if let Some(found) = found
                && best.as_ref().is_none_or(|best| found.sse < best.sse)
            {
                best = Some(found);
            }
            if self.others.is_empty() {
                break;
            }
        }
        let Some(mut found) = best else { return f64::INFINITY };
        let mut rise = (found.sse - self.minimum.sse) / self.variance;
        // Where the derivatives may have stopped at a jump, the simplex looks once more.
        if rise > 1.0 && !self.others.is_empty() {
            let calls = 12 * self.others.len() + 8;
            let looked = simplex::minimise(self.problem, &found, &self.others, 0.004, calls);
            if looked.sse < found.sse {
                found = looked;
                rise = (found.sse - self.minimum.sse) / self.variance;
            }
        }
        let place = self.path.partition_point(|(at, _)| *at < distance);
        self.path.insert(place, (distance, found.unit.clone()));
        let least = self.better.as_ref().map_or(self.minimum.sse, |better| better.sse);
        if found.sse < least {
            self.better = Some(found);
        }
        rise.max(0.0)
    }

    /// Where the others are likely to be: on the line through the two nearest known points.
    fn extrapolated(&self, distance: f64) -> Vec<f64> {
        let place = self.path.partition_point(|(at, _)| *at < distance);
        let last = self.path.len() - 1;
        if last == 0 {
            return self.path[0].1.clone();
        }
        let upper = place.clamp(1, last);
        let ((a, first), (b, second)) = (&self.path[upper - 1], &self.path[upper]);
        let part = ((distance - a) / (b - a)).clamp(-1.0, 3.0);
        first.iter().zip(second).map(|(f, s)| (f + part * (s - f)).clamp(0.0, 1.0)).collect()
    }

    /// Where in the unit interval the fit becomes too bad; `None` if it does not up to the bound.
    fn end(&mut self, threshold: f64) -> Option<f64> {
        let reach = self.reach();
        let guess = self.guess(threshold);
        let mut step = guess.min(reach);
        let mut inside = (0.0, 0.0);
        loop {
            // Outwards until the fit is too bad.
            let outside = loop {
                if reach <= 0.0 || inside.0 >= reach {
                    return None;
                }
                let distance = (inside.0 + step).min(reach);
                let rise = self.rise(distance);
                if rise > threshold {
                    break (distance, rise);
                }
                inside = (distance, rise);
                step *= 1.6;
            };
            let end = self.crossing(threshold, inside, outside);
            match self.valley_beyond(threshold, end, guess.max(end)) {
                Some(valley) => inside = valley,
                None => return Some(self.minimum.unit[self.index] + self.sign * end),
            }
        }
    }

    /// A place beyond an end where the fit is good enough again, the furthest that is found.
    fn valley_beyond(&mut self, threshold: f64, end: f64, scale: f64) -> Option<(f64, f64)> {
        let reach = self.reach();
        for part in BEYOND.into_iter().rev() {
            let distance = end + part * scale;
            if distance <= reach {
                let rise = self.rise(distance);
                if rise <= threshold {
                    return Some((distance, rise));
                }
            }
        }
        None
    }

    /// The distance between two at which the root of the rise passes that of the threshold.
    fn crossing(&mut self, threshold: f64, mut inside: (f64, f64), mut outside: (f64, f64)) -> f64 {
        let goal = threshold.sqrt();
        for turn in 0..14 {
            let (a, fa) = (inside.0, inside.1.sqrt() - goal);
            let (b, fb) = (outside.0, outside.1.sqrt() - goal);
            let secant = a + (b - a) * (-fa / (fb - fa)).clamp(0.05, 0.95);
            // Every third turn halves, whatever the curve looks like.
            let middle = if turn % 3 == 2 || !fb.is_finite() { 0.5 * (a + b) } else { secant };
            let rise = self.rise(middle);
            if (rise.sqrt() - goal).abs() < 0.005 * goal {
                return middle;
            }
            if rise > threshold {
                outside = (middle, rise)
            } else {
                inside = (middle, rise)
            }
            if outside.0 - inside.0 < 1e-3 * outside.0 {
                break;
            }
        }
        0.5 * (inside.0 + outside.0)
    }
}
