//! Fixed-base modes of a shear frame.

use crate::numerics::algebra::dot;

/// Fixed-base modes, mass-normalised, in order of frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameModes {
    /// Circular frequencies in rad/s, ascending.
    pub frequencies_rad_per_s: Vec<f64>,
    /// Shapes in kg^(−1/2), row by row: entry `i * n + j` is floor `i` in mode `j`; `Φᵀ M Φ = 1`.
    pub shapes: Vec<f64>,
}

/// Circular frequencies of a shear frame on a fixed base in rad/s, ascending.
///
/// `masses_kg` of the floors and `stiffnesses_n_per_m` of the storeys run from the base up and have
/// the same length.
#[must_use]
pub fn shear_frame_frequencies(masses_kg: &[f64], stiffnesses_n_per_m: &[f64]) -> Vec<f64> {
    shear_frame_modes(masses_kg, stiffnesses_n_per_m).frequencies_rad_per_s
}

/// Modes of a shear frame on a fixed base.
///
/// The frame's stiffness is `GᵀG` in mass-weighted displacements, with the bidiagonal
/// `G = k^(1/2) (difference) m^(−1/2)`. Its singular values are the frequencies; one-sided Jacobi
/// rotations (Hestenes) find them to high *relative* accuracy, the lowest of a frame whose storeys
/// differ by orders of magnitude included.
#[must_use]
pub fn shear_frame_modes(masses_kg: &[f64], stiffnesses_n_per_m: &[f64]) -> FrameModes {
    let n = masses_kg.len();
    assert_eq!(n, stiffnesses_n_per_m.len(), "one stiffness a floor");
    // Columns of G and of V; rotations keep G V = U diag(ω).
    let mut g = vec![vec![0.0; n]; n];
    let mut v = vec![vec![0.0; n]; n];
    for j in 0..n {
        let root = masses_kg[j].sqrt();
        g[j][j] = stiffnesses_n_per_m[j].sqrt() / root;
        if j + 1 < n {
            g[j][j + 1] = -stiffnesses_n_per_m[j + 1].sqrt() / root;
        }
        v[j][j] = 1.0;
    }
    for _sweep in 0..60 {
        let mut rotated = false;
        for i in 0..n {
            for j in i + 1..n {
                rotated |= orthogonalise(&mut g, &mut v, i, j);
            }
        }
        if !rotated {
            break;
        }
    }
    let mut order: Vec<(f64, usize)> =
        g.iter().enumerate().map(|(j, column)| (dot(column, column).sqrt(), j)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut shapes = vec![0.0; n * n];
    for (mode, &(_, j)) in order.iter().enumerate() {
        // The top floor moves towards +x in every mode, so that the sign is not left to chance.
        let sign = if v[j][n - 1] < 0.0 { -1.0 } else { 1.0 };
        for i in 0..n {
            shapes[i * n + mode] = sign * v[j][i] / masses_kg[i].sqrt();
        }
    }
    FrameModes {
        frequencies_rad_per_s: order.into_iter().map(|(omega, _)| omega).collect(),
        shapes,
    }
}

/// Rotates columns `i` and `j` of `g` (and of `v`) until they are orthogonal; whether it had to.
fn orthogonalise(g: &mut [Vec<f64>], v: &mut [Vec<f64>], i: usize, j: usize) -> bool {
    let (alpha, beta, gamma) = (dot(&g[i], &g[i]), dot(&g[j], &g[j]), dot(&g[i], &g[j]));
    if gamma.abs() <= f64::EPSILON * (alpha * beta).sqrt() {
        return false;
    }
    let zeta = (beta - alpha) / (2.0 * gamma);
    let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    rotate(g, i, j, c, c * t);
    rotate(v, i, j, c, c * t);
    true
}

fn rotate(columns: &mut [Vec<f64>], i: usize, j: usize, c: f64, s: f64) {
    let (left, right) = columns.split_at_mut(j);
    for (x, y) in left[i].iter_mut().zip(right[0].iter_mut()) {
        (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform frame of n equal storeys: ω_j = 2 √(k/m) sin((2j − 1) π / (4n + 2)).
    #[test]
    fn uniform_frame_frequencies() {
        for n in [1, 2, 5, 20] {
            let omega = shear_frame_frequencies(&vec![3.0; n], &vec![7.0; n]);
            for (j, found) in omega.iter().enumerate() {
                let angle = (2 * j + 1) as f64 * core::f64::consts::PI / (4 * n + 2) as f64;
                let expected = 2.0 * (7.0_f64 / 3.0).sqrt() * libm::sin(angle);
                assert!((found / expected - 1.0).abs() < 4e-15, "n {n} mode {j}: {found}");
            }
        }
    }

    /// A soft storey under a stiff frame: the lowest mode is the rigid frame on the soft storey.
    #[test]
    fn lowest_mode_of_a_graded_frame_keeps_its_digits() {
        let omega = shear_frame_frequencies(&[1.0, 1.0, 1.0], &[3e-12, 1.0, 1.0]);
        assert!((omega[0] / 1e-6 - 1.0).abs() < 2e-12, "{}", omega[0]);
    }

    #[test]
    fn shapes_are_orthonormal_and_complete() {
        let (m, k) = ([5.0, 3.0, 8.0, 2.0], [90.0, 400.0, 70.0, 150.0]);
        let FrameModes { frequencies_rad_per_s: omega, shapes } = shear_frame_modes(&m, &k);
        for a in 0..4 {
            for b in 0..4 {
                let mass: f64 = (0..4).map(|i| shapes[i * 4 + a] * m[i] * shapes[i * 4 + b]).sum();
                let drift = |i: usize, j: usize| {
                    shapes[i * 4 + j] - if i > 0 { shapes[(i - 1) * 4 + j] } else { 0.0 }
                };
                let stiffness: f64 = (0..4).map(|i| k[i] * drift(i, a) * drift(i, b)).sum();
                let one = f64::from(u8::from(a == b));
                assert!((mass - one).abs() < 1e-14);
                assert!((stiffness - one * omega[a] * omega[a]).abs() < 1e-12);
            }
        }
    }
}
