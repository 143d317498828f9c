//! The same damping ratio in every fixed-base mode, without computing a mode.

/// `C = M Φ diag(2 ξ ω) Φᵀ M` of a shear frame, row by row in N s/m.
///
/// With `H = (M^{-1/2} K M^{-1/2})^{1/2}` this is `2 ξ M^{1/2} H M^{1/2}`, because `M^{1/2} Φ` is
/// orthogonal. A frame's `M^{-1/2} K M^{-1/2}` is `Gᵀ G` with the bidiagonal
/// `G_ii = √(k_i/m_i)`, `G_i,i−1 = −√(k_i/m_{i−1})`; so `H` is the symmetric factor of the polar
/// decomposition `G = U H`.
pub(super) fn modal_damping(masses: &[f64], stiffnesses: &[f64], ratio: f64) -> Vec<f64> {
    let n = masses.len();
    let mut g = vec![0.0; n * n];
    for i in 0..n {
        g[i * n + i] = libm::sqrt(stiffnesses[i] / masses[i]);
        if i > 0 {
            g[i * n + i - 1] = -libm::sqrt(stiffnesses[i] / masses[i - 1]);
        }
    }
    let u = orthogonal_factor(&g, n);
    let h = |i: usize, j: usize| (0..n).map(|k| u[k * n + i] * g[k * n + j]).sum::<f64>();
    let mut c = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            let symmetric = 0.5 * (h(i, j) + h(j, i));
            c[i * n + j] = 2.0 * ratio * libm::sqrt(masses[i]) * symmetric * libm::sqrt(masses[j]);
        }
    }
    c
}

/// `U` of `G = U H` by Newton's iteration `X ← (γ X + X^{-T}/γ)/2`.
///
/// The scaling γ = (‖X⁻¹‖ / ‖X‖)^{1/2} in Frobenius norms makes it converge in about ten steps
/// whatever the condition of `G` (N. J. Higham, Functions of Matrices, SIAM 2008, section 8.6).
fn orthogonal_factor(g: &[f64], n: usize) -> Vec<f64> {
    let mut x = g.to_vec();
    let mut last = f64::INFINITY;
    for _ in 0..100 {
        let inverse = inverse(&x, n);
        let gamma = libm::sqrt(norm(&inverse) / norm(&x));
        let mut next = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                next[i * n + j] = 0.5 * (gamma * x[i * n + j] + inverse[j * n + i] / gamma);
            }
        }
        let change = norm(&next.iter().zip(&x).map(|(a, b)| a - b).collect::<Vec<_>>());
        x = next;
        // Quadratic until rounding: a step that no longer shrinks is rounding.
        if change < 1e-8 && change >= 0.5 * last || change == 0.0 {
            break;
        }
        last = change;
    }
    x
}

fn norm(x: &[f64]) -> f64 {
    libm::sqrt(x.iter().map(|x| x * x).sum())
}

/// Inverse by Gauss–Jordan elimination with row pivots.
fn inverse(x: &[f64], n: usize) -> Vec<f64> {
    let mut left = x.to_vec();
    let mut right = vec![0.0; n * n];
    for i in 0..n {
        right[i * n + i] = 1.0;
    }
    for column in 0..n {
        let size = |row: usize| left[row * n + column].abs();
        let pivot =
            (column..n).fold(column, |best, row| if size(row) > size(best) { row } else { best });
        for j in 0..n {
            left.swap(column * n + j, pivot * n + j);
            right.swap(column * n + j, pivot * n + j);
        }
        let scale = 1.0 / left[column * n + column];
        for j in 0..n {
            left[column * n + j] *= scale;
            right[column * n + j] *= scale;
        }
        for row in (0..n).filter(|&row| row != column) {
            let factor = left[row * n + column];
            if factor != 0.0 {
                for j in 0..n {
                    left[row * n + j] -= factor * left[column * n + j];
                    right[row * n + j] -= factor * right[column * n + j];
                }
            }
        }
    }
    right
}

#[cfg(test)]
mod tests {
    use super::modal_damping;

    /// A 2×2 square root has a closed form: (S + √det S · 1) / √(tr S + 2 √det S).
    #[test]
    fn two_storeys() {
        let (m, k, ratio) = ([3.0, 0.7], [1.0e4, 230.0], 0.03);
        let s = [
            (k[0] + k[1]) / m[0],
            -k[1] / libm::sqrt(m[0] * m[1]),
            -k[1] / libm::sqrt(m[0] * m[1]),
            k[1] / m[1],
        ];
        let root = libm::sqrt(s[0] * s[3] - s[1] * s[2]);
        let scale = libm::sqrt(s[0] + s[3] + 2.0 * root);
        let h = [(s[0] + root) / scale, s[1] / scale, s[2] / scale, (s[3] + root) / scale];
        let found = modal_damping(&m, &k, ratio);
        for i in 0..2 {
            for j in 0..2 {
                let expected = 2.0 * ratio * libm::sqrt(m[i] * m[j]) * h[2 * i + j];
                // A few roundings of the largest entry.
                assert!((found[2 * i + j] - expected).abs() < 1e-14 * 10.0, "{i}{j}");
            }
        }
    }

    /// C M⁻¹ C = 4 ξ² K, whatever the number of storeys and however stiff one of them.
    #[test]
    fn squares_to_stiffness() {
        let n = 12;
        let m: Vec<f64> = (0..n).map(|i| 1.0 + 0.3 * (i % 4) as f64).collect();
        let k: Vec<f64> = (0..n).map(|i| if i == 5 { 1e8 } else { 1e3 * (1 + i) as f64 }).collect();
        let c = modal_damping(&m, &k, 0.5);
        for i in 0..n {
            for j in 0..n {
                let found: f64 = (0..n).map(|l| c[i * n + l] * c[l * n + j] / m[l]).sum();
                let above = if i + 1 < n { k[i + 1] } else { 0.0 };
                let expected = match j as i64 - i as i64 {
                    0 => k[i] + above,
                    -1 => -k[i],
                    1 => -above,
                    _ => 0.0,
                };
                // Relative to the stiffest storey, times some rounding.
                assert!((found - expected).abs() < 1e-13 * 1e8, "{i} {j}: {found} {expected}");
            }
        }
    }
}
