//! Fixed-base frequencies of a shear frame.

/// Circular frequencies in rad/s, ascending, of a shear frame on a fixed base.
///
/// `masses_kg` are the floors' and `stiffnesses_n_per_m` those of the storeys below each, all
/// finite and > 0, from the base up; of lists of different lengths the shorter counts.
///
/// With `m`, `k` those, `M^-½ K M^-½ = B Bᵀ` where `B` is bidiagonal: `√(k_i/m_i)` on the diagonal,
/// `−√(k_{i+1}/m_i)` beside it. The frequencies are its singular values: the positive eigenvalues of
/// the tridiagonal matrix with a zero diagonal and, beside it, the entries of `B` in turn (Golub and
/// Kahan). Bisection on Sturm counts of that matrix gives each, the smallest too, to a few ulp for
/// each storey (Demmel and Kahan, SIAM J. Sci. Stat. Comput. 11, 1990).
#[must_use]
pub fn shear_frame_frequencies(masses_kg: &[f64], stiffnesses_n_per_m: &[f64]) -> Vec<f64> {
    let n = masses_kg.len().min(stiffnesses_n_per_m.len());
    // Squares of the entries of B in turn.
    let mut squares = Vec::with_capacity(2 * n);
    for i in 0..n {
        squares.push(stiffnesses_n_per_m[i] / masses_kg[i]);
        if i + 1 < n {
            squares.push(stiffnesses_n_per_m[i + 1] / masses_kg[i]);
        }
    }
    // No row of the tridiagonal matrix sums to more.
    let bound = 2.0 * squares.iter().fold(0.0_f64, |a, b| a.max(*b)).sqrt();
    let mut frequencies: Vec<f64> = Vec::with_capacity(n);
    for i in 0..n {
        let mut low = frequencies.last().copied().unwrap_or(0.0);
        let mut high = bound;
        loop {
            let middle = low + 0.5 * (high - low);
            if middle <= low || middle >= high {
                break;
            }
            if below(&squares, middle) > i {
                high = middle;
            } else {
                low = middle;
            }
        }
        frequencies.push(high);
    }
    frequencies
}

/// How many frequencies lie below `omega` > 0: negative pivots of the tridiagonal matrix minus
/// `omega`, less the half of them that belong to its negative eigenvalues. A pivot of 0 gives an
/// infinite one after it, which counts right.
fn below(squares: &[f64], omega: f64) -> usize {
    let mut pivot = -omega;
    let mut negative = 1;
    for square in squares {
        pivot = -omega - square / pivot;
        negative += usize::from(pivot.is_sign_negative());
    }
    negative - squares.len().div_ceil(2)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::shear_frame_frequencies;

    fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(found.len(), expected.len());
        for (f, e) in found.iter().zip(expected) {
            assert!((f / e - 1.0).abs() < tolerance, "{found:?}, expected {expected:?}");
        }
    }

    /// One storey: ω = √(k/m).
    #[test]
    fn exact_one_storey() {
        assert_close(&shear_frame_frequencies(&[45.0], &[4500.0]), &[10.0], 4e-16);
        assert!(shear_frame_frequencies(&[], &[]).is_empty());
    }

    /// Uniform frame: ω_j = 2 √(k/m) sin((2j−1)π / (2(2n+1))).
    #[test]
    fn exact_uniform_frames() {
        for n in [2_usize, 3, 5, 20, 100] {
            let expected: Vec<f64> = (1..=n)
                .map(|j| {
                    let angle =
                        (2 * j - 1) as f64 * std::f64::consts::PI / (2 * (2 * n + 1)) as f64;
                    2.0 * 3.0 * libm::sin(angle)
                })
                .collect();
            // A few ulp for each storey.
            let found = shear_frame_frequencies(&vec![2.0; n], &vec![18.0; n]);
            assert_close(&found, &expected, 4.0 * n as f64 * f64::EPSILON);
        }
    }

    /// Two storeys: ω² are the roots of m₁m₂ω⁴ − (m₁k₂ + m₂(k₁+k₂))ω² + k₁k₂ = 0; k₂ and m₂ are
    /// chosen so small that the roots lie far apart.
    #[test]
    fn exact_two_storeys_far_apart() {
        let (m1, m2, k1, k2) = (1.0, 1.0, 1e14, 1.0);
        let (a, b, c): (f64, f64, f64) = (m1 * m2, m1 * k2 + m2 * (k1 + k2), k1 * k2);
        let q = 0.5 * (b + (b * b - 4.0 * a * c).sqrt());
        let expected = [(c / q).sqrt(), (q / a).sqrt()];
        assert_close(&shear_frame_frequencies(&[m1, m2], &[k1, k2]), &expected, 1e-15);
    }

    proptest! {
        /// det(M⁻¹K) = Π k_i/m_i = Π ω_i², whatever the spread.
        #[test]
        fn prop_product_is_the_determinant(
            storeys in proptest::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 1..12),
        ) {
            let m: Vec<f64> = storeys.iter().map(|(m, _)| libm::exp10(*m)).collect();
            let k: Vec<f64> = storeys.iter().map(|(_, k)| libm::exp10(*k)).collect();
            let frequencies = shear_frame_frequencies(&m, &k);
            prop_assert!(frequencies.windows(2).all(|pair| pair[0] <= pair[1]));
            let log_det: f64 = m.iter().zip(&k).map(|(m, k)| libm::log(k / m)).sum();
            let log_product: f64 = frequencies.iter().map(|w| 2.0 * libm::log(*w)).sum();
            // Each frequency to a few ulp a storey; logarithms add their own rounding.
            prop_assert!((log_det - log_product).abs() < 1e-12, "{log_det} {log_product}");
        }
    }
}
