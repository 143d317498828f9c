//! Nelder and Mead's simplex, which needs no derivatives.

use super::{Free, Minimum, Problem};

/// Goes down from a minimum with a simplex of some size in the unit cube; never up.
pub(super) fn minimise(
    problem: &Problem,
    start: &Minimum,
    free: Free,
    size: f64,
    most: usize,
) -> Minimum {
    let n = free.len();
    let placed = |point: &[f64]| {
        let mut unit = start.unit.clone();
        for (&k, value) in free.iter().zip(point) {
            unit[k] = value.clamp(0.0, 1.0);
        }
        unit
    };
    let value = |point: &[f64]| problem.sse(&placed(point));
    let first: Vec<f64> = free.iter().map(|&k| start.unit[k]).collect();
    let mut simplex = vec![(start.sse, first.clone())];
    for k in 0..n {
        let mut point = first.clone();
        point[k] += if point[k] + size <= 1.0 { size } else { -size };
        simplex.push((value(&point), point));
    }
    let mut calls = n;
    while calls < most {
        simplex.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (best, worst) = (simplex[0].0, simplex[n].0);
        // Smaller than this no parameter is asked for.
        let spread = (0..n).map(|k| (simplex[n].1[k] - simplex[0].1[k]).abs()).fold(0.0, f64::max);
        if spread < 1e-7 || worst - best <= 1e-6 * best / start.count.max(1) as f64 {
            break;
        }
        let centre: Vec<f64> = (0..n)
            .map(|k| simplex[..n].iter().map(|(_, point)| point[k]).sum::<f64>() / n as f64)
            .collect();
        let along = |factor: f64| -> Vec<f64> {
            let worst = &simplex[n].1;
            (0..n).map(|k| (centre[k] + factor * (worst[k] - centre[k])).clamp(0.0, 1.0)).collect()
        };
        let mirrored = along(-1.0);
        let at_mirrored = value(&mirrored);
        calls += 1;
        let (next, at_next) = if at_mirrored < best {
            let further = along(-2.0);
            let at_further = value(&further);
            calls += 1;
            if at_further < at_mirrored { (further, at_further) } else { (mirrored, at_mirrored) }
        } else if at_mirrored < simplex[n - 1].0 {
            (mirrored, at_mirrored)
        } else {
            let inside = along(if at_mirrored < worst { -0.5 } else { 0.5 });
            let at_inside = value(&inside);
            calls += 1;
            if at_inside < worst.min(at_mirrored) {
                (inside, at_inside)
            } else {
                let best_point = simplex[0].1.clone();
                for (sse, point) in simplex.iter_mut().skip(1) {
                    for (p, b) in point.iter_mut().zip(&best_point) {
                        *p = 0.5 * (*p + b);
                    }
                    *sse = value(point);
                }
                calls += n;
                continue;
            }
        };
        simplex[n] = (at_next, next);
    }
    simplex.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (sse, point) = &simplex[0];
    Minimum { unit: placed(point), sse: *sse, count: start.count }
}
