//! Least squares for functions that may jump: a seeded global start, Levenberg and Marquardt's
//! steps where the Jacobian is finite, Nelder and Mead's simplex where it misleads, and intervals
//! by profile likelihood.
//!
//! All of it works in the unit cube onto which the bounds are mapped. Marquardt, SIAM J. Appl. Math.
//! 11 (1963); Nelder and Mead, Computer Journal 7 (1965); the profile as in Bates and Watts,
//! "Nonlinear regression analysis and its applications", 1988, chapter 6.

mod levenberg;
mod profile;
mod simplex;

pub use profile::{Interval, Profile, profile};

use crate::numerics::random::Random;

/// Residuals as a function of parameters inside bounds.
pub struct Problem<'a> {
    /// Lower and upper bound of each parameter, the second above the first.
    pub bounds: Vec<[f64; 2]>,
    /// Residuals, always as many, over their standard deviation or all in one unit; `None` where
    /// the function has no value.
    pub residuals: &'a dyn Fn(&[f64]) -> Option<Vec<f64>>,
}

/// A minimum of the sum of squares.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// Parameters in the unit cube.
    pub unit: Vec<f64>,
    /// Sum of the squares of the residuals.
    pub sse: f64,
    /// Number of residuals.
    pub count: usize,
}

impl Problem<'_> {
    /// Parameters of a point in the unit cube.
    #[must_use]
    pub fn parameters(&self, unit: &[f64]) -> Vec<f64> {
        let value = |([low, high], u): (&[f64; 2], &f64)| low + u * (high - low);
        self.bounds.iter().zip(unit).map(value).collect()
    }

    /// The point in the unit cube of some parameters, moved inside where they lie outside.
    #[must_use]
    pub fn unit(&self, parameters: &[f64]) -> Vec<f64> {
        let unit = |([low, high], p): (&[f64; 2], &f64)| ((p - low) / (high - low)).clamp(0.0, 1.0);
        self.bounds.iter().zip(parameters).map(unit).collect()
    }

    fn at(&self, unit: &[f64]) -> Option<Vec<f64>> {
        let residuals = (self.residuals)(&self.parameters(unit))?;
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    /// The sum of squares, infinite where there is none.
    fn sse(&self, unit: &[f64]) -> f64 {
        self.at(unit).map_or(f64::INFINITY, |residuals| sum_of_squares(&residuals))
    }
}

fn sum_of_squares(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum()
}

/// Which parameters are free to move; the others keep their value.
pub(super) type Free<'a> = &'a [usize];

/// The best of several minima, each started from one of the best points of a Latin hypercube; the
/// given start counts as one more point. `None` where the function has no value at any of them.
#[must_use]
pub fn global(problem: &Problem, start: Option<&[f64]>, seed: u64) -> Option<Minimum> {
    const STARTS: usize = 4;
    let dimension = problem.bounds.len();
    let points = (24 * dimension).clamp(24, 192);
    let mut cube = Random::new(seed).latin_hypercube(points, dimension);
    cube.extend(start.map(|start| problem.unit(start)));
    let mut scored: Vec<(f64, Vec<f64>)> =
        cube.into_iter().map(|unit| (problem.sse(&unit), unit)).collect();
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let free: Vec<usize> = (0..dimension).collect();
    let mut best: Option<Minimum> = None;
    for (sse, unit) in scored.into_iter().take(STARTS) {
        if !sse.is_finite() {
            continue;
        }
        let Some(found) = levenberg::minimise(problem, &unit, &free, 12, 1e-4) else { continue };
        if best.as_ref().is_none_or(|best| found.sse < best.sse) {
            best = Some(found);
        }
    }
    refine(problem, &best?.unit)
}

/// The minimum near a point of the unit cube: steps by derivatives, then a simplex that does
/// without, until the two agree. `None` where the function has no value there.
#[must_use]
pub fn refine(problem: &Problem, unit: &[f64]) -> Option<Minimum> {
    let free: Vec<usize> = (0..problem.bounds.len()).collect();
    let mut best = levenberg::minimise(problem, unit, &free, 60, 1e-9)?;
    let mut size = 0.02;
    for _ in 0..4 {
        let found = simplex::minimise(problem, &best, &free, size, 60 * free.len());
        let polished = levenberg::minimise(problem, &found.unit, &free, 30, 1e-9).unwrap_or(found);
        let gain = best.sse - polished.sse;
        if polished.sse < best.sse {
            best = polished;
        }
        if !(gain > 1e-3 * best.sse / best.count as f64) {
            break;
        }
        size *= 0.5;
    }
    Some(best)
}

#[cfg(test)]
mod tests;
