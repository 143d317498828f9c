//! Taylor series of the state over a piece of a sample, two orders side by side.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::equations::{OneStorey, unit};
use super::event::Span;
use super::lanes::{Eight, Four, eight, four, times8};
use super::tables::ORDERS;

/// Pairs of orders.
const PAIRS: usize = ORDERS / 2;

/// Taylor coefficients from the first on over a piece, two orders side by side: what one unit of
/// each component of the state, of the acceleration, of its change over the piece and of the
/// friction force adds to the state.
pub(super) type Table = [[Eight; 7]; PAIRS];

/// A table with nothing in it yet.
pub(super) const EMPTY: Table = [[Eight::ZERO; 7]; PAIRS];

/// 1 / (k + 1).
const RECIPROCAL: [f64; ORDERS] = {
    let mut table = [0.0; ORDERS];
    let mut k = 0;
    while k < ORDERS {
        table[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    table
};

/// `k` and `k (k − 1)` for the orders of each pair, once for each component.
const ONCE: [Eight; PAIRS] = factors(false);
const TWICE: [Eight; PAIRS] = factors(true);

const fn factors(twice: bool) -> [Eight; PAIRS] {
    let mut table = [Eight::ZERO; PAIRS];
    let mut k = 1;
    while k <= ORDERS {
        let factor = if twice { k * (k - 1) } else { k } as f64;
        let mut i = 0;
        while i < 4 {
            table[(k - 1) / 2].0[(k - 1) % 2 * 4 + i] = factor;
            i += 1;
        }
        k += 1;
    }
    table
}

/// Fills the table of a phase.
#[inline(always)]
pub(super) fn fill(storey: &OneStorey, slip: bool, piece_s: f64, table: &mut Table) {
    let inputs = if slip { 0..7 } else { 2..6 };
    let mut x: [[f64; 4]; 7] =
        core::array::from_fn(|input| if input < 4 { unit(input) } else { [0.0; 4] });
    // All inputs order by order: they do not wait for each other.
    for k in 0..ORDERS {
        let step = piece_s * RECIPROCAL[k];
        for input in inputs.clone() {
            // The acceleration counts at the start, its change in the order after.
            let a = if input == 4 + k && k < 2 { 1.0 } else { 0.0 };
            let force = if input == 6 && k == 0 { 1.0 } else { 0.0 };
            let [s, w, eta, rate] = storey.rate(slip, x[input], a, force);
            x[input] = [step * s, step * w, step * eta, step * rate];
            table[k / 2][input].0[k % 2 * 4..][..4].copy_from_slice(&x[input]);
        }
    }
}

/// What a unit input adds to the state by the end of the piece.
#[inline(always)]
pub(super) fn sum(table: &Table, input: usize) -> [f64; 4] {
    let mut end = [0.0; 4];
    for pair in table.iter().rev() {
        let [o0, o1, o2, o3, e0, e1, e2, e3] = pair[input].0;
        for (end, (odd, even)) in end.iter_mut().zip([(o0, e0), (o1, e1), (o2, e2), (o3, e3)]) {
            *end = (*end + even) + odd;
        }
    }
    end
}

/// Taylor coefficients `c_k` of the state over a piece from the first on, and `Σ k (k − 1) |c_k|`, which
/// bounds its second derivative.
pub(super) struct Series<S: Simd> {
    x: f64x4<S>,
    /// An odd order and the even one after it, side by side.
    c: [f64x8<S>; PAIRS],
    /// `k (k − 1) c_k`.
    second: [f64x8<S>; PAIRS],
    pub(super) curvature: f64x4<S>,
}

/// What the coefficients of every order are made of.
struct Order<'a, S: Simd> {
    simd: S,
    x: [f64; 4],
    span: &'a Span,
    force: f64,
}

impl<S: Simd> Order<'_, S> {
    #[inline(always)]
    fn of<const SLIP: bool>(&self, table: &[Eight; 7]) -> f64x8<S> {
        let (simd, x) = (self.simd, self.x);
        let structure = times8(simd, &table[2], x[2]) + times8(simd, &table[3], x[3]);
        let load = times8(simd, &table[4], self.span.a) + times8(simd, &table[5], self.span.change);
        if SLIP {
            let block = times8(simd, &table[0], x[0]) + times8(simd, &table[1], x[1]);
            (block + structure) + (load + times8(simd, &table[6], self.force))
        } else {
            structure + load
        }
    }
}

/// The powers 2, 4 and 8 of a part of the piece.
struct Powers<S: Simd>([f64x8<S>; 3]);

impl<S: Simd> Powers<S> {
    #[inline(always)]
    fn new(simd: S, t: f64) -> Self {
        let t2 = t * t;
        let t4 = t2 * t2;
        Self([eight(simd, t2), eight(simd, t4), eight(simd, t4 * t4)])
    }

    /// The sum of `c[j] t^2j`.
    #[inline(always)]
    fn sum(&self, c: &[f64x8<S>; PAIRS]) -> f64x8<S> {
        let [t2, t4, t8] = self.0;
        ((c[0] + c[1] * t2) + (c[2] + c[3] * t2) * t4) + (c[4] + c[5] * t2) * t8
    }
}

impl<S: Simd> Series<S> {
    /// Series of a phase from a state.
    #[inline(always)]
    pub(super) fn new<const SLIP: bool>(
        simd: S,
        table: &Table,
        x: [f64; 4],
        span: &Span,
        force: f64,
    ) -> Self {
        let order = Order { simd, x, span, force };
        // One by one: a loop would not be unrolled.
        let c = [
            order.of::<SLIP>(&table[0]),
            order.of::<SLIP>(&table[1]),
            order.of::<SLIP>(&table[2]),
            order.of::<SLIP>(&table[3]),
            order.of::<SLIP>(&table[4]),
            order.of::<SLIP>(&table[5]),
        ];
        let second = weighted(simd, &c, &TWICE);
        let (c0, c1, c2) = (second[0].abs(), second[1].abs(), second[2].abs());
        let (c3, c4, c5) = (second[3].abs(), second[4].abs(), second[5].abs());
        let (odd, even) = (((c0 + c1) + (c2 + c3)) + (c4 + c5)).split();
        Self { x: Four(x).load(simd), c, second, curvature: odd + even }
    }

    /// State at a part of the piece.
    #[inline(always)]
    pub(super) fn at(&self, simd: S, t: f64) -> f64x4<S> {
        let (odd, even) = Powers::new(simd, t).sum(&self.c).split();
        self.x + (odd * four(simd, t) + even * four(simd, t * t))
    }

    /// First and second derivative of the state at a part of the piece, by the piece.
    #[inline(always)]
    pub(super) fn derivatives(&self, simd: S, t: f64) -> [f64x4<S>; 2] {
        let powers = Powers::new(simd, t);
        let (odd, even) = powers.sum(&weighted(simd, &self.c, &ONCE)).split();
        let first = odd + even * four(simd, t);
        let s = &self.second;
        let none = eight(simd, 0.0);
        let (odd, even) = powers.sum(&[s[1], s[2], s[3], s[4], s[5], none]).split();
        let second = s[0].split().1 + (odd * four(simd, t) + even * four(simd, t * t));
        [first, second]
    }

    /// The coefficients one by one, from the first on.
    #[inline(always)]
    pub(super) fn coefficients(&self) -> [[f64; 4]; ORDERS] {
        let mut all = [[0.0; 4]; ORDERS];
        for (pair, c) in all.as_chunks_mut::<2>().0.iter_mut().zip(&self.c) {
            let (odd, even) = c.split();
            *pair = [odd.to_array(), even.to_array()];
        }
        all
    }

    /// The first four coefficients.
    #[inline(always)]
    pub(super) fn leading(&self) -> [[f64; 4]; 4] {
        let [a, b, c, d, e, f, g, h] = self.c[0].to_array();
        let [i, j, k, l, m, n, o, p] = self.c[1].to_array();
        [[a, b, c, d], [e, f, g, h], [i, j, k, l], [m, n, o, p]]
    }
}

/// Coefficients times factors.
#[inline(always)]
fn weighted<S: Simd>(
    simd: S,
    c: &[f64x8<S>; PAIRS],
    factors: &[Eight; PAIRS],
) -> [f64x8<S>; PAIRS] {
    [
        c[0] * factors[0].load(simd),
        c[1] * factors[1].load(simd),
        c[2] * factors[2].load(simd),
        c[3] * factors[3].load(simd),
        c[4] * factors[4].load(simd),
        c[5] * factors[5].load(simd),
    ]
}
