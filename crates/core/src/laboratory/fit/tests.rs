use super::*;
use crate::numerics::distribution::student_quantile;
use crate::numerics::random::Random;

fn interval(problem: &Problem, minimum: &Minimum, index: usize, variance: f64) -> Interval {
    let freedom = (minimum.count - problem.bounds.len()) as f64;
    let t = student_quantile(0.95, freedom);
    match profile(problem, minimum, index, t * t, variance) {
        Profile::Interval(interval) => interval,
        Profile::Better(found) => panic!("a better minimum: {found:?}"),
    }
}

/// A straight line: the profile is the interval of the textbook.
#[test]
fn line_has_the_interval_of_the_textbook() {
    let mut random = Random::new(11);
    let data: Vec<[f64; 2]> = (0..30)
        .map(|i| {
            let x = f64::from(i) / 29.0;
            [x, 1.0 + 2.0 * x + 0.1 * random.normal()]
        })
        .collect();
    let residuals = |p: &[f64]| Some(data.iter().map(|[x, y]| p[0] + p[1] * x - y).collect());
    let problem = Problem { bounds: vec![[-5.0, 5.0], [-9.0, 9.0]], residuals: &residuals };
    let minimum = global(&problem, None, 1).unwrap();
    let rows: Vec<([f64; 2], f64)> = data.iter().map(|[x, y]| ([1.0, *x], *y)).collect();
    let line = crate::numerics::algebra::linear_fit(&rows).unwrap();
    let parameters = problem.parameters(&minimum.unit);
    let variance = line.sse / 28.0;
    for k in 0..2 {
        assert!((parameters[k] - line.coefficients[k]).abs() < 1e-6, "{k}");
        let half = student_quantile(0.95, 28.0) * (variance * line.covariance[k][k]).sqrt();
        let found = interval(&problem, &minimum, k, variance);
        assert_eq!(found.open, [false, false]);
        // The root is sought to a two-hundredth of the width.
        assert!((found.ends[0] - (line.coefficients[k] - half)).abs() < 0.01 * half);
        assert!((found.ends[1] - (line.coefficients[k] + half)).abs() < 0.01 * half);
    }
}

/// Rosenbrock's valley, whose minimum is at (1, 1).
#[test]
fn minimum_of_a_curved_valley() {
    let residuals = |p: &[f64]| Some(vec![10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0]]);
    let problem = Problem { bounds: vec![[-2.0, 2.0], [-2.0, 2.0]], residuals: &residuals };
    let minimum = global(&problem, Some(&[-1.2, 1.0]), 7).unwrap();
    let parameters = problem.parameters(&minimum.unit);
    assert!((parameters[0] - 1.0).abs() < 1e-4 && (parameters[1] - 1.0).abs() < 1e-4);
}

/// A saw whose teeth point away from the minimum: derivatives lead nowhere.
#[test]
fn a_saw_is_climbed_without_derivatives() {
    let residuals = |p: &[f64]| {
        let tooth = 30.0 * p[0] - libm::floor(30.0 * p[0]);
        Some(vec![(p[0] - 0.3).abs() + 0.05 * tooth, 0.0])
    };
    let problem = Problem { bounds: vec![[0.0, 1.0]], residuals: &residuals };
    let minimum = global(&problem, None, 3).unwrap();
    // A tooth more is 0.033.
    assert!(minimum.sse.sqrt() < 0.02, "{minimum:?}");
}

#[test]
fn a_parameter_without_effect_has_no_end() {
    let residuals = |p: &[f64]| Some((0..20).map(|i| p[0] - f64::from(i % 2)).collect());
    let problem = Problem { bounds: vec![[-3.0, 3.0], [0.0, 1.0]], residuals: &residuals };
    let minimum = global(&problem, None, 2).unwrap();
    assert_eq!(interval(&problem, &minimum, 1, 0.25).open, [true, true]);
    assert_eq!(interval(&problem, &minimum, 0, 0.25).open, [false, false]);
}

#[test]
fn no_value_anywhere_is_no_fit() {
    let problem = Problem { bounds: vec![[0.0, 1.0]], residuals: &|_: &[f64]| None };
    assert!(global(&problem, None, 1).is_none());
    let nan = |_: &[f64]| Some(vec![f64::NAN]);
    let problem = Problem { bounds: vec![[0.0, 1.0]], residuals: &nan };
    assert!(global(&problem, None, 1).is_none());
}
