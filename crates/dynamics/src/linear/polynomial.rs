//! Polynomials on [0, 1]: value, first root, largest value.
//!
//! Both searches rest on the error of a chord: where `|g''| ≤ D` on an interval of width `w`,
//! `g` departs from the chord through its ends by at most `D w² / 8`. `D` is the sum of
//! `k (k − 1) |c_k|`. An interval is dismissed only by that bound, else halved.

use super::lanes::least;

/// Degree of the Taylor polynomials.
pub const DEGREE: usize = 20;

/// Coefficients, constant first, zeros beyond [`DEGREE`]: whole fours.
pub type Polynomial = [f64; COEFFICIENTS];

const COEFFICIENTS: usize = (DEGREE + 1).next_multiple_of(4);

/// The polynomial that vanishes.
pub const ZERO: Polynomial = [0.0; COEFFICIENTS];

/// Narrowest interval that is searched, of the part searched: a dip that a chord over it can hide is below
/// 3e-17 of `D` times the square of that part.
const NARROWEST: f64 = 1.0 / (1_u64 << 26) as f64;

/// Value at `x` in [0, 1]: by Horner's scheme in `x⁴` four sums, of the powers that leave the same rest.
#[inline(always)]
#[must_use]
pub fn value(c: &Polynomial, x: f64) -> f64 {
    let x2 = x * x;
    let x4 = x2 * x2;
    let fours = c.as_chunks::<4>().0;
    let mut sums = fours[COEFFICIENTS / 4 - 1];
    for four in fours[..COEFFICIENTS / 4 - 1].iter().rev() {
        for i in 0..4 {
            sums[i] = four[i] + sums[i] * x4;
        }
    }
    (sums[0] + sums[1] * x) + (sums[2] + sums[3] * x) * x2
}

/// `k` and `k (k − 1)`, the factors of the derivatives of `x^k`.
const FACTORS: [Polynomial; 2] = {
    let mut factors = [ZERO; 2];
    let mut k = 1;
    while k < COEFFICIENTS {
        (factors[0][k], factors[1][k]) = (k as f64, (k * (k - 1)) as f64);
        k += 1;
    }
    factors
};

/// `(k − 1)(k − 2)`, those of the second derivative of `x^(k−1)`.
const OVER_X: Polynomial = {
    let mut factors = ZERO;
    let mut k = 2;
    while k < COEFFICIENTS {
        factors[k] = ((k - 1) * (k - 2)) as f64;
        k += 1;
    }
    factors
};

/// Derivative.
#[inline(always)]
#[must_use]
pub fn derivative(c: &Polynomial) -> Polynomial {
    let mut d = ZERO;
    for k in 0..COEFFICIENTS - 1 {
        d[k] = FACTORS[0][k + 1] * c[k + 1];
    }
    d
}

/// `x` times the derivative.
#[inline(always)]
fn rise(c: &Polynomial) -> Polynomial {
    let mut rise = ZERO;
    for k in 0..COEFFICIENTS {
        rise[k] = FACTORS[0][k] * c[k];
    }
    rise
}

/// Bound on the second derivative over [0, 1].
#[inline(always)]
#[must_use]
pub fn curvature_bound(c: &Polynomial) -> f64 {
    weighted_sum(c, &FACTORS[1])
}

/// `x²` times the bound on the second derivative over [0, `x`]: `Σ k (k − 1) |c_k| x^k`.
#[inline(always)]
#[must_use]
pub fn curvature_term(c: &Polynomial, x: f64) -> f64 {
    let mut terms = ZERO;
    for k in 0..COEFFICIENTS {
        terms[k] = FACTORS[1][k] * c[k].abs();
    }
    value(&terms, x)
}

/// Bound on the size over [0, 1]: `Σ |c_k|`.
#[inline(always)]
#[must_use]
pub fn size_bound(c: &Polynomial) -> f64 {
    weighted_sum(c, &[1.0; COEFFICIENTS])
}

/// `Σ factors_k |c_k|`.
#[inline(always)]
fn weighted_sum(c: &Polynomial, factors: &Polynomial) -> f64 {
    let [fours, factors] = [c, factors].map(|c| c.as_chunks::<4>().0);
    let mut bound = [0.0; 4];
    for (c, factor) in fours.iter().zip(factors) {
        for i in 0..4 {
            bound[i] += factor[i] * c[i].abs();
        }
    }
    (bound[0] + bound[1]) + (bound[2] + bound[3])
}

/// [`curvature_bound`] over [0, `b`]: near 0 a polynomial without low powers is far flatter than
/// over [0, 1], and a search by the bound for [0, 1] would halve its way through all of it.
fn curvature_up_to(c: &Polynomial, b: f64) -> f64 {
    let mut bound = 0.0;
    for k in (2..=DEGREE).rev() {
        bound = bound * b + FACTORS[1][k] * c[k].abs();
    }
    bound
}

/// The polynomial over `x^order`: what is left of one whose first `order` coefficients are 0.
#[inline(always)]
#[must_use]
pub fn deflated(c: &Polynomial, order: usize) -> Polynomial {
    let mut d = ZERO;
    d[..COEFFICIENTS - order].copy_from_slice(&c[order..]);
    d
}

/// [`first_root`] of a polynomial whose first `order` coefficients stand for zero: of what is
/// left of it over `x^order`.
#[inline(always)]
#[must_use]
pub fn first_root_after_zero(c: &Polynomial, order: usize, end: f64) -> Option<f64> {
    if order == 1 {
        // Over x: c_1 at 0, c(end) / end, and the second derivative by (k − 1)(k − 2) |c_k|.
        let last = (value(c, end) - c[0]) / end;
        if least(c[1], last) > 0.125 * weighted_sum(c, &OVER_X) * (end * end) {
            return None;
        }
    }
    first_root(&deflated(c, order), end)
}

/// First point of [0, `end`] after which the polynomial is negative, `None` if there is none.
///
/// `end` is at most 1. The polynomial is taken to be ≥ 0 at 0. A dip below zero is missed only if it is shallower than
/// 3e-17 of the bound on the second derivative times `end²`; a root is located to the last few bits.
#[inline(always)]
#[must_use]
pub fn first_root(c: &Polynomial, end: f64) -> Option<f64> {
    let curvature = curvature_bound(c);
    let (start, last) = (c[0], value(c, end));
    if start.min(last) > 0.125 * curvature * (end * end) {
        return None;
    }
    if start < 0.0 {
        return Some(0.0);
    }
    // Terms beyond all numbers: no point is negative, and no part of [0, `end`] shows it.
    if !curvature.is_finite() {
        return None;
    }
    let search = Search { c, rise: rise(c), curvature, end };
    if last < 0.0 && search.falls([0.0, end], curvature) {
        return Some(search.bracketed([0.0, start], [end, last]));
    }
    search.first([0.0, start], [end, last])
}

struct Search<'a> {
    c: &'a Polynomial,
    rise: Polynomial,
    /// Over all of [0, 1].
    curvature: f64,
    /// Where the search ends.
    end: f64,
}

impl Search<'_> {
    /// Whether the polynomial falls throughout an interval in which its second derivative is bounded.
    #[inline(always)]
    fn falls(&self, [a, b]: [f64; 2], curvature: f64) -> bool {
        let (width, middle) = (b - a, 0.5 * (a + b));
        value(&self.rise, middle) + 0.5 * curvature * width * middle < 0.0
    }

    #[inline(never)]
    fn first(&self, [a, ga]: [f64; 2], [b, gb]: [f64; 2]) -> Option<f64> {
        let width = b - a;
        let curvature = if b == self.end { self.curvature } else { curvature_up_to(self.c, b) };
        // g ≥ min(g_a, g_b) − h²/8 max|g''| ≥ 0, equal where the polynomial is 0 throughout.
        if ga.min(gb) >= 0.125 * curvature * width * width {
            return None;
        }
        let middle = a + 0.5 * width;
        let narrowest = NARROWEST * self.end;
        if gb < 0.0 {
            if self.falls([a, b], curvature) || width <= narrowest {
                return Some(self.bracketed([a, ga], [b, gb]));
            }
        } else if width <= narrowest {
            return None;
        }
        let gm = value(self.c, middle);
        self.first([a, ga], [middle, gm]).or_else(|| self.first([middle, gm], [b, gb]))
    }

    /// The root between `a`, where the value is ≥ 0, and `b`, where it is negative: Newton's
    /// method, which bisection keeps inside the shrinking bracket.
    #[inline(always)]
    fn bracketed(&self, [mut a, ga]: [f64; 2], [mut b, gb]: [f64; 2]) -> f64 {
        if ga <= 0.0 {
            return a;
        }
        let mut x = self.guess();
        if !(a < x && x < b) {
            x = a + (b - a) * (ga / (ga - gb));
        }
        for _ in 0..100 {
            if !(a < x && x < b) {
                x = a + 0.5 * (b - a);
                if x <= a || x >= b {
                    break;
                }
            }
            let (g, rise) = (value(self.c, x), value(&self.rise, x));
            if g < 0.0 {
                b = x;
            } else {
                a = x;
            }
            let step = g * x / rise;
            let next = x - step;
            // What Newton's step leaves is at most its square times half the curvature over the
            // slope.
            let negligible = 2.0 * f64::EPSILON * x;
            if g == 0.0
                || step.abs() <= negligible
                || self.curvature * (step * step) * x <= negligible * rise.abs()
            {
                return next.clamp(a, b);
            }
            x = next;
        }
        b
    }

    /// First falling root by the terms up to the third power, or anything.
    #[inline(always)]
    fn guess(&self) -> f64 {
        let [c0, c1, c2, c3] = [self.c[0], self.c[1], self.c[2], self.c[3]];
        let x = 2.0 * c0 / ((c1 * c1 - 4.0 * c0 * c2).sqrt() - c1);
        x - c3 * (x * x * x) / (c1 + 2.0 * c2 * x)
    }
}

/// The larger of `attained` and the polynomial's largest value on [0, `to`], to a few ulp; `to` is at
/// most 1.
#[must_use]
pub fn largest(c: &Polynomial, to: f64, attained: f64) -> f64 {
    let (start, end) = (c[0], value(c, to));
    let slope = derivative(c);
    let mut peak = Peak {
        c,
        slope: &slope,
        bend: derivative(&slope),
        curvature: curvature_bound(c),
        third: curvature_bound(&slope),
        end: to,
        attained: attained.max(start).max(end),
    };
    peak.search([0.0, start], [to, end]);
    peak.attained
}

/// Raises a peak to the polynomial's largest size on [0, `to`], to a few ulp; `to` is at most 1.
pub fn raise_to_size(peak: &mut f64, c: &Polynomial, to: f64) {
    let ends = c[0].abs().max(value(c, to).abs());
    *peak = peak.max(ends);
    if ends + 0.125 * curvature_bound(c) * (to * to) > *peak {
        *peak = largest(&c.map(|c| -c), to, largest(c, to, *peak));
    }
}

struct Peak<'a> {
    c: &'a Polynomial,
    slope: &'a Polynomial,
    bend: Polynomial,
    curvature: f64,
    third: f64,
    /// Where the search ends.
    end: f64,
    attained: f64,
}

impl Peak<'_> {
    fn search(&mut self, [a, ga]: [f64; 2], [b, gb]: [f64; 2]) {
        let width = b - a;
        let [curvature, third] = if b == 1.0 {
            [self.curvature, self.third]
        } else {
            [curvature_up_to(self.c, b), curvature_up_to(self.slope, b)]
        };
        let narrowest = NARROWEST * self.end;
        if ga.max(gb) + 0.125 * curvature * width * width <= self.attained || width <= narrowest {
            return;
        }
        let middle = a + 0.5 * width;
        if value(self.slope, middle).abs() > 0.5 * curvature * width {
            return; // monotone: the ends are the extremes
        }
        if value(&self.bend, middle) + 0.5 * third * width < 0.0 {
            if value(self.slope, a) > 0.0 && value(self.slope, b) < 0.0 {
                let (c, curvature) = (self.slope, self.third);
                let search = Search { c, rise: rise(c), curvature, end: b };
                let top = search.bracketed([a, value(self.slope, a)], [b, value(self.slope, b)]);
                self.attained = self.attained.max(value(self.c, top));
            }
            return;
        }
        let gm = value(self.c, middle);
        self.attained = self.attained.max(gm);
        self.search([a, ga], [middle, gm]);
        self.search([middle, gm], [b, gb]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_roots(roots: &[f64], factor: f64) -> Polynomial {
        let mut c = ZERO;
        c[0] = factor;
        for (k, root) in roots.iter().enumerate() {
            for i in (0..=k).rev() {
                c[i + 1] += c[i];
                c[i] *= -root;
            }
        }
        c
    }

    #[test]
    fn first_of_several_roots() {
        let c = from_roots(&[0.3, 0.4, 0.9], -1.0);
        let x = first_root(&c, 1.0).expect("three roots");
        assert!((x - 0.3).abs() < 1e-15, "{x}");
    }

    #[test]
    fn dip_between_equal_ends() {
        let dip = |depth: f64| {
            let mut c = from_roots(&[0.37, 0.37], 1.0);
            c[0] -= depth;
            first_root(&c, 1.0)
        };
        for depth in [1e-4, 1e-8, 1e-12, 1e-14] {
            let x = dip(depth).expect("dip");
            let error = (x - (0.37 - depth.sqrt())).abs();
            assert!(error < 1e-16 / depth.sqrt() + 1e-15, "{depth} {error}");
        }
        assert_eq!(dip(-1e-14), None);
    }

    #[test]
    fn root_at_a_start_on_zero_is_deflated_away() {
        let c = from_roots(&[0.0, 0.0, 0.6], -1.0);
        let x = first_root(&deflated(&c, 2), 1.0).expect("one root");
        assert!((x - 0.6).abs() < 2e-16);
    }

    /// A dip within a billionth of the unit: a velocity that comes to a halt in a steep ramp of the motion.
    /// Neither shows on any part that nothing is negative: halving all of them would take minutes.
    #[test]
    fn what_is_zero_throughout_or_no_number_has_no_root_at_once() {
        for c in [ZERO, [f64::NAN; COEFFICIENTS], [1e306; COEFFICIENTS]] {
            for _ in 0..10_000 {
                assert_eq!(first_root(&c, 1.0), None);
            }
        }
    }

    #[test]
    fn first_root_in_a_short_part() {
        for part in [1e-3, 1e-6, 1e-9, 1e-12] {
            for [first, second] in [[0.3, 0.6], [0.5, 0.501], [0.25, 2.0]] {
                let mut c = ZERO;
                (c[0], c[1], c[2]) =
                    (first * second, -(first + second) / part, 1.0 / (part * part));
                let x = first_root(&c, part).expect("two roots") / part;
                assert!((x - first).abs() < 1e-12, "{part}: {x}");
            }
        }
    }

    /// A peak within a billionth of the unit, as a steep ramp of the motion makes it.
    #[test]
    fn largest_value_in_a_short_part() {
        let part = 1e-9;
        let mut c = ZERO;
        (c[0], c[1], c[2]) = (1.8, 3.6, -3.6 / part);
        let peak = 1.8 + 0.25 * 3.6 * part;
        assert!((largest(&c, part, f64::MIN) - peak).abs() < 1e-15);
    }

    #[test]
    fn largest_value_between_the_ends() {
        let mut c = from_roots(&[0.2, 0.8], -1.0);
        c[0] += 1.0;
        assert!((largest(&c, 1.0, f64::MIN) - 1.09).abs() < 1e-15);
        assert_eq!(largest(&c, 1.0, 2.0), 2.0);
    }

    /// A frame at rest: its upper storeys follow the block by a high power of time.
    #[test]
    fn high_power_alone_is_searched_in_few_steps() {
        let mut c = ZERO;
        c[11] = -1.0;
        assert_eq!(largest(&c, 1.0, f64::MIN), 0.0);
        (c[0], c[12]) = (1e-30, 1.0);
        let x = first_root(&c, 1.0).expect("falls below zero");
        assert!((x / libm::pow(1e-30, 1.0 / 11.0) - 1.0).abs() < 1e-3, "{x}");
    }

    /// The worst case of the chord bound: a parabola that touches it.
    #[test]
    fn chord_bound_is_reached_by_a_parabola() {
        let touching = |gap: f64| {
            let mut c = ZERO;
            (c[0], c[1], c[2]) = (0.25 + gap, -1.0, 1.0);
            c
        };
        assert_eq!(first_root(&touching(1e-15), 1.0), None);
        let x = first_root(&touching(-1e-12), 1.0).expect("dips by 1e-12");
        assert!((x - (0.5 - 1e-6)).abs() < 1e-9);
    }
}
