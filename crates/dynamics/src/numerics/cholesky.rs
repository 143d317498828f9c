//! Cholesky's factor of a symmetric matrix.

/// Lower triangular `L` with `A = L Lᵀ`, row by row with zeros above the diagonal.
///
/// `a` holds the `n × n` matrix row by row; only its lower triangle is read. `None` where a pivot is
/// not above `n ε` times the diagonal: the matrix is not positive definite to within rounding.
#[must_use]
pub fn cholesky(a: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut l = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum();
            let rest = a[i * n + j] - dot;
            if i != j {
                l[i * n + j] = rest / l[j * n + j];
            } else if rest > n as f64 * f64::EPSILON * a[i * n + i].abs() {
                l[i * n + i] = rest.sqrt();
            } else {
                return None;
            }
        }
    }
    Some(l)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_of_two() {
        assert_eq!(cholesky(&[4.0, 2.0, 2.0, 5.0], 2), Some(vec![2.0, 0.0, 1.0, 2.0]));
        assert_eq!(cholesky(&[1.0, 2.0, 2.0, 1.0], 2), None);
    }

    #[test]
    fn factor_of_three() {
        let a = [4.0, 2.0, 2.0, 2.0, 10.0, 7.0, 2.0, 7.0, 21.0];
        let expected = [2.0, 0.0, 0.0, 1.0, 3.0, 0.0, 1.0, 2.0, 4.0];
        assert_eq!(cholesky(&a, 3).unwrap(), expected);
    }

    /// Three correlations of −0.5 add up to a singular matrix.
    #[test]
    fn singular_matrix_is_refused() {
        let a = [1.0, -0.5, -0.5, -0.5, 1.0, -0.5, -0.5, -0.5, 1.0];
        assert_eq!(cholesky(&a, 3), None);
        let b = [1.0, 0.9, -0.9, 0.9, 1.0, 0.9, -0.9, 0.9, 1.0];
        assert_eq!(cholesky(&b, 3), None);
    }
}
