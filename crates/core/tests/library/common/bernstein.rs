//! Polynomials on `[0, 1]` in Bernstein form: roots that cannot be missed, maxima that cannot be
//! overlooked.
//!
//! A polynomial lies between its smallest and largest Bernstein coefficient, and has at most as
//! many roots in (0, 1) as these coefficients change sign (Descartes, Bernstein; G. Farin, Curves
//! and Surfaces for CAGD, ch. 6). De Casteljau's halving gives the coefficients of both halves.

use std::sync::OnceLock;

use super::dd::{Dd, ONE, ZERO};

/// Degree of the Taylor series.
pub const DEGREE: usize = 22;
/// Coefficients of a polynomial, powers or Bernstein.
pub type Poly<T> = [T; DEGREE + 1];

/// `weights()[i][k] = C(i, k) / C(DEGREE, k)`: Bernstein coefficient `i` of the power `k`.
fn weights() -> &'static [Poly<Dd>; DEGREE + 1] {
    static WEIGHTS: OnceLock<[Poly<Dd>; DEGREE + 1]> = OnceLock::new();
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, j| c * (n - j) as f64 / (j + 1) as f64);
    WEIGHTS.get_or_init(|| {
        std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                if k > i { ZERO } else { Dd::from(choose(i, k)) / Dd::from(choose(DEGREE, k)) }
            })
        })
    })
}

/// The same rounded to doubles, by powers.
fn rounded_weights() -> &'static [Poly<f64>; DEGREE + 1] {
    static WEIGHTS: OnceLock<[Poly<f64>; DEGREE + 1]> = OnceLock::new();
    WEIGHTS
        .get_or_init(|| std::array::from_fn(|k| std::array::from_fn(|i| weights()[i][k].value())))
}

/// The doubles nearest to the coefficients.
pub fn rounded(p: &Poly<Dd>) -> Poly<f64> {
    p.map(Dd::value)
}

/// Bernstein coefficients from powers.
fn bernstein(p: &Poly<Dd>) -> Poly<Dd> {
    std::array::from_fn(|i| (0..=i).fold(ZERO, |sum, k| sum + weights()[i][k] * p[k]))
}

/// The same in doubles.
fn rounded_bernstein(p: &Poly<f64>) -> Poly<f64> {
    let mut b = [0.0; DEGREE + 1];
    for (row, power) in rounded_weights().iter().zip(p) {
        for (sum, weight) in b.iter_mut().zip(row) {
            *sum += weight * power;
        }
    }
    b
}

/// Bernstein coefficients of both halves.
fn halves<T: Copy>(p: &Poly<T>, mean: impl Fn(T, T) -> T) -> (Poly<T>, Poly<T>) {
    let (mut left, mut row) = (*p, *p);
    for i in 1..=DEGREE {
        for j in 0..=DEGREE - i {
            row[j] = mean(row[j], row[j + 1]);
        }
        left[i] = row[0];
    }
    (left, row)
}

/// Value of a polynomial given by powers.
pub fn value(p: &Poly<Dd>, x: Dd) -> Dd {
    p.iter().rev().fold(ZERO, |sum, &c| sum * x + c)
}

/// Largest |value| on `[0, 1]` of a polynomial given by powers, if it is above `known`; else
/// `known`. To 1e-15 relative.
pub fn largest(p: &Poly<f64>, known: f64) -> f64 {
    if p.iter().fold(0.0, |sum, c| sum + c.abs()) <= known {
        return known;
    }
    largest_of(&rounded_bernstein(p), known, 0)
}

fn largest_of(b: &Poly<f64>, known: f64, depth: u32) -> f64 {
    let known = known.max(b[0].abs()).max(b[DEGREE].abs());
    let bound = b.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    if bound <= known * (1.0 + 1e-15) || depth > 40 {
        return known;
    }
    let (left, right) = halves(b, |x, y| 0.5 * (x + y));
    let known = largest_of(&left, known, depth + 1);
    largest_of(&right, known, depth + 1)
}

/// Sign of the first coefficient above `noise`, and its index: the sign just right of 0.
pub fn leading(p: &Poly<Dd>, noise: f64) -> Option<(usize, i32)> {
    p.iter().position(|c| c.value().abs() > noise).map(|k| (k, p[k].sign()))
}

/// The first root in `(0, 1)` of a polynomial given by powers, a root at 0 left out.
///
/// Coefficients and values up to `noise` count as zero. A point where the polynomial touches zero
/// without crossing counts as a root.
pub fn first_root(p: &Poly<Dd>, noise: f64) -> Option<Dd> {
    let (start, _) = leading(p, noise)?;
    // Divided by the power that makes the root at 0.
    let mut q = [ZERO; DEGREE + 1];
    q[..=DEGREE - start].copy_from_slice(&p[start..]);
    let nearest = rounded(&q);
    if nearest[0].abs() > 1.001 * nearest[1..].iter().fold(0.0, |sum, c| sum + c.abs()) {
        return None;
    }
    let quick = rounded_bernstein(&nearest);
    let size = quick.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    let clear = 1e-12 * size;
    if quick.iter().all(|&c| c > clear) || quick.iter().all(|&c| c < -clear) {
        return None;
    }
    isolate(&q, &bernstein(&q), ZERO, ONE, noise)
}

/// The first root between `low` and `high`, where `b` are the Bernstein coefficients of `p` there.
fn isolate(p: &Poly<Dd>, b: &Poly<Dd>, low: Dd, high: Dd, noise: f64) -> Option<Dd> {
    let signs = b.map(|c| if c.value().abs() <= noise { 0 } else { c.sign() });
    let mut changes = 0;
    let mut last = 0;
    for &sign in signs.iter().filter(|&&s| s != 0) {
        changes += usize::from(last != 0 && sign != last);
        last = sign;
    }
    if last == 0 {
        return Some((low + high).half());
    }
    if changes == 0 {
        return None;
    }
    if changes == 1 && signs[0] != 0 && signs[DEGREE] != 0 {
        return Some(bisect(p, low, high, signs[0]));
    }
    let middle = (low + high).half();
    let (left, right) = halves(b, |x, y| (x + y).half());
    if let Some(root) = isolate(p, &left, low, middle, noise) {
        return Some(root);
    }
    if right[0].value().abs() <= noise {
        return Some(middle);
    }
    isolate(p, &right, middle, high, noise)
}

/// The root of a polynomial that has sign `before` at `low` and the other at `high`.
fn bisect(p: &Poly<Dd>, mut low: Dd, mut high: Dd, before: i32) -> Dd {
    for _ in 0..108 {
        let middle = (low + high).half();
        if value(p, middle).sign() == before {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
