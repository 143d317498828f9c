//! Steps by derivatives, damped until they help.

use super::{Free, Minimum, Problem, sum_of_squares};
use crate::numerics::algebra::{inverse, times};

/// Step of the finite differences in the unit cube.
const DIFFERENCE: f64 = 1e-6;

/// Goes down from a point while the sum of squares falls by more than `tolerance` of the mean
/// square, at most `most` times; parameters stay in the cube. `None` where there is no value at the
/// start. Where no damping helps it stops: a jump of the function, or the minimum.
pub(super) fn minimise(
    problem: &Problem,
    start: &[f64],
    free: Free,
    most: usize,
    tolerance: f64,
) -> Option<Minimum> {
    let mut unit = start.to_vec();
    let mut residuals = problem.at(&unit)?;
    let mut sse = sum_of_squares(&residuals);
    let mut damping = 1e-3;
    for _ in 0..most {
        let Some(columns) = jacobian(problem, &unit, &residuals, free) else { break };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let slope: Vec<f64> = columns.iter().map(|column| -dot(column, &residuals)).collect();
        // A parameter at its bound that wants to go beyond it stays there for this step.
        let moving: Vec<usize> = (0..free.len())
            .filter(|&k| {
                let u = unit[free[k]];
                let outwards = (u <= 0.0 && slope[k] < 0.0) || (u >= 1.0 && slope[k] > 0.0);
                !outwards && dot(&columns[k], &columns[k]) > 0.0
            })
            .collect();
        if moving.is_empty() {
            break;
        }
        let mut helped = false;
        let before = sse;
        for _ in 0..10 {
            let normal = moving.iter().map(|&i| {
                let entry = |&j: &usize| {
                    let value = dot(&columns[i], &columns[j]);
                    if i == j { value * (1.0 + damping) } else { value }
                };
                moving.iter().map(entry).collect()
            });
            let normal: Vec<Vec<f64>> = normal.collect();
            let right: Vec<f64> = moving.iter().map(|&k| slope[k]).collect();
            let Some(inverted) = inverse(&normal) else {
                damping = (10.0 * damping).max(1e-6);
                continue;
            };
            let step = times(&inverted, &right);
            let mut trial = unit.clone();
            for (&k, step) in moving.iter().zip(&step) {
                trial[free[k]] = (trial[free[k]] + step).clamp(0.0, 1.0);
            }
            if let Some(found) = problem.at(&trial)
                && sum_of_squares(&found) < sse
            {
                (sse, residuals, unit) = (sum_of_squares(&found), found, trial);
                damping = (0.2 * damping).max(1e-12);
                helped = true;
                break;
            }
            damping = (5.0 * damping).max(1e-6);
            if trial == unit {
                break;
            }
        }
        if !helped || before - sse <= tolerance * sse / residuals.len() as f64 {
            break;
        }
    }
    Some(Minimum { unit, sse, count: residuals.len() })
}

/// Derivatives of the residuals, a column a free parameter; `None` where one is not finite.
pub(super) fn jacobian(
    problem: &Problem,
    unit: &[f64],
    residuals: &[f64],
    free: Free,
) -> Option<Vec<Vec<f64>>> {
    let column = |&k: &usize| {
        let towards = |sign: f64| {
            let mut moved = unit.to_vec();
            moved[k] += sign * DIFFERENCE;
            let inside = (0.0..=1.0).contains(&moved[k]);
            let found = if inside { problem.at(&moved) } else { None }?;
            let rate = |(b, a): (&f64, &f64)| sign * (b - a) / DIFFERENCE;
            Some(found.iter().zip(residuals).map(rate).collect::<Vec<f64>>())
        };
        towards(1.0).or_else(|| towards(-1.0))
    };
    free.iter().map(column).collect()
}
