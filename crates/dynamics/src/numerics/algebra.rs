//! Least squares of a few unknowns.

/// A small square matrix, row by row.
pub type Matrix = Vec<Vec<f64>>;

/// The inverse of a symmetric positive definite matrix, scaled by its diagonal; `None` where it is
/// singular to within `1e-12` of that scale.
#[must_use]
pub fn inverse(matrix: &Matrix) -> Option<Matrix> {
    let n = matrix.len();
    let scale: Vec<f64> = (0..n).map(|i| matrix[i][i].sqrt()).collect();
    if scale.iter().any(|s| !(*s > 0.0 && s.is_finite())) {
        return None;
    }
    let scaled = |i: usize, j: usize| matrix[i][j] / (scale[i] * scale[j]);
    // Cholesky's factor L, then the inverse of L, then L⁻ᵀ L⁻¹.
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = scaled(i, j) - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i == j {
                if !(sum > 1e-12) {
                    return None;
                }
                l[i][i] = sum.sqrt();
            } else {
                l[i][j] = sum / l[j][j];
            }
        }
    }
    let mut inverse_l = vec![vec![0.0; n]; n];
    for j in 0..n {
        inverse_l[j][j] = 1.0 / l[j][j];
        for i in j + 1..n {
            let sum: f64 = (j..i).map(|k| l[i][k] * inverse_l[k][j]).sum();
            inverse_l[i][j] = -sum / l[i][i];
        }
    }
    let mut inverse = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..n {
            let sum: f64 = (i.max(j)..n).map(|k| inverse_l[k][i] * inverse_l[k][j]).sum();
            inverse[i][j] = sum / (scale[i] * scale[j]);
        }
    }
    Some(inverse)
}

/// The sum of products, one after the other.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

/// A matrix times a vector.
#[must_use]
pub fn times(matrix: &Matrix, vector: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}

/// A linear fit by least squares.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearFit {
    /// The unknowns.
    pub coefficients: Vec<f64>,
    /// The inverse of the normal matrix: times the variance of the noise it is their covariance.
    pub covariance: Matrix,
    /// Sum of squares of what is left.
    pub sse: f64,
}

/// Fits `y ≈ Σ c_k x_k` to rows `(x, y)`; `None` where they do not determine the unknowns.
#[must_use]
pub fn linear_fit<R: AsRef<[f64]>>(rows: &[(R, f64)]) -> Option<LinearFit> {
    let n = rows.first()?.0.as_ref().len();
    let mut normal = vec![vec![0.0; n]; n];
    let mut right = vec![0.0; n];
    for (x, y) in rows {
        let x = x.as_ref();
        for i in 0..n {
            right[i] += x[i] * y;
            for j in 0..n {
                normal[i][j] += x[i] * x[j];
            }
        }
    }
    let covariance = inverse(&normal)?;
    let coefficients = times(&covariance, &right);
    let left = |(x, y): &(R, f64)| {
        y - x.as_ref().iter().zip(&coefficients).map(|(x, c)| x * c).sum::<f64>()
    };
    let sse = rows.iter().map(|row| left(row) * left(row)).sum();
    Some(LinearFit { coefficients, covariance, sse })
}

/// Solution of `A x = b` by elimination with pivots, `None` of a singular matrix given row by row.
#[must_use]
pub fn solution(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let pivot =
            (k..n).reduce(|best, i| if a[i][k].abs() > a[best][k].abs() { i } else { best })?;
        if a[pivot][k] == 0.0 {
            return None;
        }
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (done, rest) = a.split_at_mut(k + 1);
        for (i, row) in rest.iter_mut().enumerate() {
            let factor = row[k] / done[k][k];
            row.iter_mut().zip(&done[k]).skip(k).for_each(|(x, y)| *x -= factor * y);
            b[k + 1 + i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known = (k + 1..n).fold(b[k], |rest, j| rest - a[k][j] * b[j]);
        b[k] = known / a[k][k];
    }
    Some(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_of_a_matrix_of_hilbert() {
        let matrix =
            vec![vec![1.0, 0.5, 1.0 / 3.0], vec![0.5, 1.0 / 3.0, 0.25], vec![1.0 / 3.0, 0.25, 0.2]];
        let expected = [[9.0, -36.0, 30.0], [-36.0, 192.0, -180.0], [30.0, -180.0, 180.0]];
        let inverse = inverse(&matrix).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                assert!((inverse[i][j] - expected[i][j]).abs() < 1e-9);
            }
        }
        assert!(super::inverse(&vec![vec![1.0, 1.0], vec![1.0, 1.0]]).is_none());
    }

    /// A line through three points: slope and offset by the formulas of the textbook.
    #[test]
    fn a_line_has_the_least_squares() {
        let rows = [([1.0, 0.0], 1.0), ([1.0, 1.0], 3.0), ([1.0, 2.0], 4.0)];
        let fit = linear_fit(&rows).unwrap();
        assert!((fit.coefficients[1] - 1.5).abs() < 1e-12);
        assert!((fit.coefficients[0] - 7.0 / 6.0).abs() < 1e-12);
        assert!((fit.sse - 1.0 / 6.0).abs() < 1e-12);
        // Var(slope)/σ² = 1/Σ(x − x̄)².
        assert!((fit.covariance[1][1] - 0.5).abs() < 1e-12);
        assert!(linear_fit::<[f64; 2]>(&[]).is_none());
    }
}
