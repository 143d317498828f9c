//! Eigenvalues of symmetric matrices, by a way of the tests.

/// Eigenvalues and vectors of a symmetric matrix by Jacobi's rotations, ascending.
pub fn eigen(mut a: Vec<Vec<f64>>) -> Vec<(f64, Vec<f64>)> {
    let n = a.len();
    let mut v: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for _ in 0..60 {
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for row in a.iter_mut().chain(&mut v) {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for k in 0..n {
                    (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                }
            }
        }
    }
    let mut all: Vec<(f64, Vec<f64>)> =
        (0..n).map(|j| (a[j][j], v.iter().map(|row| row[j]).collect())).collect();
    all.sort_by(|x, y| x.0.total_cmp(&y.0));
    all
}

/// The modes of a shear frame on a fixed base, `ω` and the shape of unit modal mass.
pub fn modes_of(m: &[f64], k: &[f64]) -> Vec<(f64, Vec<f64>)> {
    let n = m.len();
    let scaled = |i: usize, j: usize, x: f64| x / (m[i] * m[j]).sqrt();
    let mut a = vec![vec![0.0; n]; n];
    for i in 0..n {
        a[i][i] += scaled(i, i, k[i]);
        if i > 0 {
            a[i - 1][i - 1] += scaled(i - 1, i - 1, k[i]);
            a[i][i - 1] -= scaled(i, i - 1, k[i]);
            a[i - 1][i] = a[i][i - 1];
        }
    }
    let shape = |vector: Vec<f64>| vector.iter().zip(m).map(|(x, m)| x / m.sqrt()).collect();
    eigen(a).into_iter().map(|(omega2, vector)| (omega2.sqrt(), shape(vector))).collect()
}
