//! Sobol' indices: which input the scatter of an output comes from.
//!
//! With `A` and `B` two independent samples of the inputs, `N` rows each, and `A_B^(i)` the sample `A`
//! with its column `i` from `B`,
//!
//! ```text
//! first order   S_i = [1/N Σ f(B) (f(A_B^(i)) − f(A))] / V       A. Saltelli et al., 2010, table 2 (b)
//! total         T_i = [1/2N Σ (f(A) − f(A_B^(i)))²] / V          M. J. W. Jansen, 1999, table 2 (f)
//! ```
//!
//! where V is the variance of `f` over both samples, `f` taken less its mean. `N (k + 2)` runs for `k` inputs. Intervals
//! are those of the bootstrap over the rows, with a generator of its own and a fixed seed.

use crate::error::FitError;
use crate::numerics::fractile::{fractile, sorted};
use crate::numerics::random::Random;

/// Indices of one input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    /// Share of the variance that goes with this input alone.
    pub first: f64,
    /// Its interval.
    pub first_interval: [f64; 2],
    /// Share of the variance that would vanish last, were all other inputs known: alone and with
    /// others.
    pub total: f64,
    /// Its interval.
    pub total_interval: [f64; 2],
}

/// The rows to run, in the order `A`, `B`, `A_B^(1)` … `A_B^(k)`, from points of a unit cube of `2k`
/// dimensions (one a row of `points`): the first `k` coordinates make `A`, the others `B`.
///
/// # Errors
/// [`FitError`] for fewer than 8 points, or points of other than `2k` coordinates.
pub fn design(points: &[Vec<f64>], inputs: usize) -> Result<Vec<Vec<f64>>, FitError> {
    let n = points.len();
    if n < 8 {
        return Err(FitError::TooFew { what: "sample points", expected: 8, found: n });
    }
    if let Some(point) = points.iter().find(|point| point.len() != 2 * inputs) {
        let (what, found) = ("coordinates of a point, two an input,", point.len());
        return Err(FitError::TooFew { what, expected: 2 * inputs, found });
    }
    let a = points.iter().map(|point| point[..inputs].to_vec());
    let b = points.iter().map(|point| point[inputs..].to_vec());
    let mixed = (0..inputs).flat_map(|i| {
        points.iter().map(move |point| {
            let mut row = point[..inputs].to_vec();
            row[i] = point[inputs + i];
            row
        })
    });
    Ok(a.chain(b).chain(mixed).collect())
}

/// Indices of every input from the outputs of the rows of [`design`], in their order.
///
/// # Errors
/// [`FitError`] for a wrong number of outputs, one that is not finite, or outputs that do not vary.
pub fn indices(outputs: &[f64], inputs: usize, confidence: f64) -> Result<Vec<Index>, FitError> {
    let n = outputs.len() / (inputs + 2);
    if n < 8 || outputs.len() != n * (inputs + 2) {
        return Err(FitError::TooFew {
            what: "outputs",
            expected: 8 * (inputs + 2),
            found: outputs.len(),
        });
    }
    if let Some(&found) = outputs.iter().find(|value| !value.is_finite()) {
        return Err(FitError::OutOfRange { quantity: "output", expected: "a finite value", found });
    }
    let mean = outputs[..2 * n].iter().sum::<f64>() / (2 * n) as f64;
    let centred: Vec<f64> = outputs.iter().map(|value| value - mean).collect();
    let (a, rest) = centred.split_at(n);
    let (b, mixed) = rest.split_at(n);
    let all: Vec<usize> = (0..n).collect();
    let Some(estimate) = estimates(a, b, mixed, &all) else {
        return Err(FitError::NoMaximum);
    };
    let mut random = Random::new(0x5eed);
    let mut draws: Vec<Vec<[f64; 2]>> = vec![Vec::new(); inputs];
    for _ in 0..BOOTSTRAP {
        let rows: Vec<usize> = (0..n).map(|_| random.below(n)).collect();
        let Some(drawn) = estimates(a, b, mixed, &rows) else { continue };
        for (kept, pair) in draws.iter_mut().zip(drawn) {
            kept.push(pair);
        }
    }
    let tail = 0.5 * (1.0 - confidence);
    let interval = |draws: &[[f64; 2]], which: usize| {
        let values = sorted(&draws.iter().map(|pair| pair[which]).collect::<Vec<_>>());
        [fractile(&values, tail), fractile(&values, 1.0 - tail)]
    };
    let index = |(pair, draws): (&[f64; 2], &Vec<[f64; 2]>)| Index {
        first: pair[0],
        first_interval: interval(draws, 0),
        total: pair[1],
        total_interval: interval(draws, 1),
    };
    Ok(estimate.iter().zip(&draws).map(index).collect())
}

const BOOTSTRAP: usize = 400;

/// First-order and total index of every input over some rows; `None` without variance.
fn estimates(a: &[f64], b: &[f64], mixed: &[f64], rows: &[usize]) -> Option<Vec<[f64; 2]>> {
    let n = a.len();
    let count = rows.len() as f64;
    let (mut sum, mut square) = (0.0, 0.0);
    for &row in rows {
        sum += a[row] + b[row];
        square += a[row] * a[row] + b[row] * b[row];
    }
    let mean = sum / (2.0 * count);
    let variance = square / (2.0 * count) - mean * mean;
    if !(variance > 0.0) {
        return None;
    }
    let one = |ab: &[f64]| {
        let (mut first, mut total) = (0.0, 0.0);
        for &row in rows {
            let change = ab[row] - a[row];
            first += b[row] * change;
            total += change * change;
        }
        [first / (count * variance), total / (2.0 * count * variance)]
    };
    Some(mixed.chunks_exact(n).map(one).collect())
}
