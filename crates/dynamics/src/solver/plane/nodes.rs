//! Gauss' nodes of a step, and the polynomial through the values at them.

use crate::linear::polynomial::{DEGREE, Polynomial, ZERO};
use std::sync::LazyLock;

/// Nodes of a step.
pub(super) const NODES: usize = 8;

/// Nodes of the rule by which the tables are integrated: exact for all that is in them.
const FINE: usize = 16;

/// A value at each node, or of each degree.
pub(super) type AtNodes = [f64; NODES];

/// A matrix, row by row.
pub(super) type Square = [AtNodes; NODES];

/// Nodes of a step of length 1, and what a polynomial through the values at them is.
pub(super) struct Nodes {
    pub(super) at: AtNodes,
    /// Legendre's coefficients of a polynomial from its values, row by row.
    coefficients: Square,
    /// Legendre's polynomials by powers, row by row.
    powers: Square,
    /// `∫₀^c (c − x)^l L_k(x) dx` up to each node, with Lagrange's polynomial of each node, of each `l`.
    pub(super) integrals: Vec<Square>,
}

static TABLE: LazyLock<Nodes> = LazyLock::new(Nodes::new);

/// The tables.
pub(super) fn nodes() -> &'static Nodes {
    &TABLE
}

/// Legendre's polynomials of [0, 1] up to a degree.
fn legendre<const N: usize>(x: f64) -> [f64; N] {
    let t = 2.0 * x - 1.0;
    let mut p = [1.0; N];
    p[1] = t;
    for l in 1..N - 1 {
        let m = l as f64;
        p[l + 1] = ((2.0 * m + 1.0) * t * p[l] - m * p[l - 1]) / (m + 1.0);
    }
    p
}

/// Nodes and weights of Gauss' rule on [0, 1].
fn gauss<const N: usize, const MORE: usize>() -> [[f64; N]; 2] {
    let n = N as f64;
    let (mut at, mut weights) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        let mut x = -libm::cos(core::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
        let mut slope = 1.0;
        for _ in 0..8 {
            let p: [f64; MORE] = legendre(0.5 * (1.0 + x));
            slope = n * (p[N - 1] - x * p[N]) / (1.0 - x * x);
            x -= p[N] / slope;
        }
        (at[i], weights[i]) = (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope));
    }
    [at, weights]
}

impl Nodes {
    fn new() -> Self {
        let [at, weights] = gauss::<NODES, { NODES + 1 }>();
        let [fine, fine_weights] = gauss::<FINE, { FINE + 1 }>();
        let mut coefficients = [[0.0; NODES]; NODES];
        for (k, x) in at.iter().enumerate() {
            let p: AtNodes = legendre(*x);
            for l in 0..NODES {
                coefficients[l][k] = (2 * l + 1) as f64 * weights[k] * p[l];
            }
        }
        // (l+1) P_{l+1} = (2l+1) (2x−1) P_l − l P_{l−1}, of whole numbers.
        let mut powers = [[0.0; NODES]; NODES];
        powers[0][0] = 1.0;
        (powers[1][0], powers[1][1]) = (-1.0, 2.0);
        for l in 1..NODES - 1 {
            let m = l as f64;
            for p in 0..NODES {
                let before = if p > 0 { powers[l][p - 1] } else { 0.0 };
                let turned = (2.0 * m + 1.0) * (2.0 * before - powers[l][p]);
                powers[l + 1][p] = (turned - m * powers[l - 1][p]) / (m + 1.0);
            }
        }
        let mut integrals = vec![[[0.0; NODES]; NODES]; DEGREE + 1];
        for (j, c) in at.iter().enumerate() {
            for (x, weight) in fine.iter().zip(fine_weights) {
                let p: AtNodes = legendre(c * x);
                let mut power = c * weight;
                for of_l in &mut integrals {
                    for k in 0..NODES {
                        let lagrange: f64 = (0..NODES).map(|l| p[l] * coefficients[l][k]).sum();
                        of_l[j][k] += power * lagrange;
                    }
                    power *= c * (1.0 - x);
                }
            }
        }
        Self { at, coefficients, powers, integrals }
    }

    /// Legendre's coefficients of the polynomial through some values.
    #[inline(always)]
    pub(super) fn coefficients(&self, values: &AtNodes) -> AtNodes {
        self.coefficients.map(|row| row.iter().zip(values).fold(0.0, |sum, (c, x)| sum + c * x))
    }

    /// The polynomial that vanishes at all nodes and is 1 at the start.
    pub(super) fn beside_start(&self, x: f64) -> f64 {
        self.at.iter().fold(1.0, |product, c| product * (1.0 - x / c))
    }

    /// The polynomial of Legendre's coefficients by powers of a part of the step.
    #[inline(always)]
    pub(super) fn polynomial(&self, coefficients: &AtNodes) -> Polynomial {
        let mut of = ZERO;
        for (row, c) in self.powers.iter().zip(coefficients) {
            for (sum, power) in of.iter_mut().zip(row) {
                *sum += c * power;
            }
        }
        of
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::polynomial::value;

    /// A polynomial of the highest degree is what its values say, and so are its integrals.
    #[test]
    fn tables_are_exact() {
        let nodes = nodes();
        let of = |x: f64| (x - 0.3) * libm::pow(x, 6.0) + 0.5;
        let values = nodes.at.map(of);
        let polynomial = nodes.polynomial(&nodes.coefficients(&values));
        for x in [0.0, 0.2, 0.7, 1.0] {
            assert!((value(&polynomial, x) - of(x)).abs() <= 4e-14, "at {x}");
        }
        let [whole, ..] = nodes.coefficients(&values);
        assert!((whole - (1.0 / 8.0 - 0.3 / 7.0 + 0.5)).abs() <= 1e-15);
        // ∫₀^c (c − x)^l x^7 dx = c^(l+8) l! 7!/(l+8)!
        let seventh = nodes.at.map(|x| libm::pow(x, 7.0));
        for (l, of_l) in nodes.integrals.iter().enumerate() {
            let beta: f64 = (1..=7).map(|m| m as f64 / (l + 1 + m) as f64).product();
            for (j, c) in nodes.at.iter().enumerate() {
                let found: f64 = of_l[j].iter().zip(seventh).map(|(g, x)| g * x).sum();
                let expected = beta / (l + 1) as f64 * libm::pow(*c, (l + 8) as f64);
                assert!((found - expected).abs() <= 1e-14 * expected + 1e-16, "{l} {j}");
            }
        }
    }
}
