//! Taylor series of the state over a piece of a sample: those of the velocities, four orders side by side,
//! and of the displacements as their integrals.

use fearless_simd::prelude::*;
use fearless_simd::{f64x2, f64x4, f64x8};

use super::equations::{OneStorey, unit};
use super::lanes::{Eight, eight, four, times8};

/// Orders of the series: with [`PIECE_RATE`] the first term left out is below 3e-17 of the largest.
pub(super) const ORDERS: usize = 12;

/// Largest rate times the length of a series.
pub(super) const PIECE_RATE: f64 = 0.3;

/// Orders side by side, and how often.
const ABREAST: usize = 4;
const GROUPS: usize = ORDERS / ABREAST;

/// From an instant in a piece of a sample to its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// Its length in pieces.
    pub(super) rest: f64,
    /// Acceleration at its start and its change over a whole piece.
    pub(super) a: f64,
    pub(super) change: f64,
}

/// A number for `ṡ` and one for `η̇`, order by order.
type ByOrder = [Eight; GROUPS];

/// `1/k` for the orders `k`.
const RECIPROCAL: [f64; ORDERS] = {
    let mut table = [0.0; ORDERS];
    let mut k = 1;
    while k <= ORDERS {
        table[k - 1] = 1.0 / k as f64;
        k += 1;
    }
    table
};

/// `k`, `k (k − 1)` and `1/(k + 1)` for the orders `k`.
const FACTORS: [ByOrder; 3] = {
    let mut factors = [[Eight::ZERO; GROUPS]; 3];
    let mut k = 1;
    while k <= ORDERS {
        let of_k = [k as f64, (k * (k - 1)) as f64, 1.0 / (k + 1) as f64];
        let (group, lane) = ((k - 1) / ABREAST, (k - 1) % ABREAST * 2);
        let mut i = 0;
        while i < 3 {
            factors[i][group].0[lane] = of_k[i];
            factors[i][group].0[lane + 1] = of_k[i];
            i += 1;
        }
        k += 1;
    }
    factors
};
const ONCE: ByOrder = FACTORS[0];
const TWICE: ByOrder = FACTORS[1];
const INTEGRAL: ByOrder = FACTORS[2];

/// Taylor coefficients `c_k` of `ṡ` and `η̇` over a piece, from the first on: what one unit of each
/// component of the state, of the acceleration, of its change over the piece and of the friction force
/// adds to them.
#[derive(Debug)]
pub(super) struct SeriesTable {
    pub(super) piece_s: f64,
    columns: [[Eight; 7]; GROUPS],
}

impl SeriesTable {
    pub(super) const EMPTY: Self = Self { piece_s: 0.0, columns: [[Eight::ZERO; 7]; GROUPS] };

    /// Fills the table of a phase.
    #[inline(always)]
    pub(super) fn fill(&mut self, storey: &OneStorey, slip: bool, piece_s: f64) {
        self.piece_s = piece_s;
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
                let lane = k % ABREAST * 2;
                let column = &mut self.columns[k / ABREAST][input].0;
                (column[lane], column[lane + 1]) = (x[input][1], x[input][3]);
            }
        }
    }

    /// What a unit input makes of the state by the end of the piece.
    #[inline(always)]
    pub(super) fn end(&self, input: usize) -> [f64; 4] {
        let [s, w, eta, rate] = if input < 4 { unit(input) } else { [0.0; 4] };
        let (mut once, mut integral) = ([0.0; 2], [0.0; 2]);
        for k in (0..ORDERS).rev() {
            let (group, lane) = (k / ABREAST, k % ABREAST * 2);
            for i in 0..2 {
                let c = self.columns[group][input].0[lane + i];
                once[i] += c;
                integral[i] += c * INTEGRAL[group].0[lane];
            }
        }
        let h = self.piece_s;
        let [s, eta] = [s + h * (w + integral[0]), eta + h * (rate + integral[1])];
        [s, w + once[0], eta, rate + once[1]]
    }
}

/// The motion over a piece.
pub(super) struct StoreySeries<S: Simd> {
    simd: S,
    piece_s: f64,
    /// `s, η` and `ṡ, η̇` at the start.
    displacements: f64x2<S>,
    velocities: f64x2<S>,
    /// The coefficients `c_k` of the velocities from the first on.
    c: [f64x8<S>; GROUPS],
    /// `k (k − 1) c_k`.
    second: [f64x8<S>; GROUPS],
    /// Bounds on the second derivatives of the state by the piece: `Σ k (k − 1) |c_k|` for the velocities,
    /// `h (|c_1| + Σ k (k − 1) |c_k|) ≥ h Σ k |c_k|` for the displacements.
    pub(super) curvature: f64x4<S>,
}

impl<S: Simd> StoreySeries<S> {
    /// Series of a phase from a state.
    #[inline(always)]
    pub(super) fn new<const SLIP: bool>(
        simd: S,
        table: &SeriesTable,
        x: [f64; 4],
        span: &Span,
        force: f64,
    ) -> Self {
        let of = &table.columns;
        // One by one: a loop would not be unrolled.
        let c = [
            group::<S, SLIP>(simd, &of[0], x, span, force),
            group::<S, SLIP>(simd, &of[1], x, span, force),
            group::<S, SLIP>(simd, &of[2], x, span, force),
        ];
        let second = weighted(simd, &c, &TWICE);
        let (low, high) = ((second[0].abs() + second[1].abs()) + second[2].abs()).split();
        let (odd, even) = (low + high).split();
        let of_velocities = odd + even;
        let first = c[0].split().0.split().0.abs();
        let of_displacements = (first + of_velocities) * two(simd, table.piece_s);
        let (block, storey) = f64x4::load_array(simd, x).split();
        Self {
            simd,
            piece_s: table.piece_s,
            displacements: block.unzip_low(storey),
            velocities: block.unzip_high(storey),
            c,
            second,
            curvature: state(of_displacements, of_velocities),
        }
    }

    /// `ṡ, η̇` at a part of the piece.
    #[inline(always)]
    pub(super) fn velocities(&self, t: f64) -> f64x2<S> {
        self.velocities + sum(self.simd, &self.c, t) * two(self.simd, t)
    }

    /// State at a part of the piece, of which the velocities are known:
    /// `s = s_0 + h t (ṡ_0 + Σ c_k t^k/(k + 1))`.
    #[inline(always)]
    pub(super) fn state(&self, t: f64, velocities: f64x2<S>) -> f64x4<S> {
        let integral = sum(self.simd, &weighted(self.simd, &self.c, &INTEGRAL), t);
        let mean = self.velocities + integral * two(self.simd, t);
        state(self.displacements + mean * two(self.simd, self.piece_s * t), velocities)
    }

    /// State at a part of the piece.
    #[inline(always)]
    pub(super) fn at(&self, t: f64) -> f64x4<S> {
        self.state(t, self.velocities(t))
    }

    /// First and second derivative of the state, by the piece, at a part of it that is not its start and of
    /// which the velocities are known.
    #[inline(always)]
    pub(super) fn derivatives(&self, t: f64, velocities: f64x2<S>) -> [f64x4<S>; 2] {
        let (simd, h) = (self.simd, two(self.simd, self.piece_s));
        let first = sum(simd, &weighted(simd, &self.c, &ONCE), t);
        let second = sum(simd, &self.second, t) * two(simd, 1.0 / t);
        [state(velocities * h, first), state(first * h, second)]
    }

    /// The coefficients of the state one by one, from the first on.
    #[inline(always)]
    pub(super) fn coefficients(&self) -> [[f64; 4]; ORDERS] {
        let [mut w, mut rate] = *self.velocities.as_array();
        let mut all = [[0.0; 4]; ORDERS];
        for (group, c) in all.as_chunks_mut::<ABREAST>().0.iter_mut().zip(&self.c) {
            for (x, c) in group.iter_mut().zip(c.as_array().as_chunks::<2>().0) {
                *x = [w, c[0], rate, c[1]];
                [w, rate] = *c;
            }
        }
        for (x, per_order) in all.iter_mut().zip(RECIPROCAL) {
            (x[0], x[2]) = (x[0] * (self.piece_s * per_order), x[2] * (self.piece_s * per_order));
        }
        all
    }

    /// The first four coefficients of `ṡ`.
    #[inline(always)]
    pub(super) fn leading_speed(&self) -> [f64; 4] {
        let [a, _, b, _, c, _, d, _] = self.c[0].to_array();
        [a, b, c, d]
    }

    /// The first four coefficients of `η, η̇`.
    #[inline(always)]
    pub(super) fn leading_storey(&self) -> [[f64; 2]; 4] {
        let ([_, rate], [_, a, _, b, _, c, _, d]) =
            (self.velocities.to_array(), self.c[0].to_array());
        let h = self.piece_s;
        [[h * rate, a], [h * (0.5 * a), b], [h * (b * (1.0 / 3.0)), c], [h * (0.25 * c), d]]
    }
}

/// Four orders of coefficients.
#[inline(always)]
fn group<S: Simd, const SLIP: bool>(
    simd: S,
    of: &[Eight; 7],
    x: [f64; 4],
    span: &Span,
    force: f64,
) -> f64x8<S> {
    let structure = times8(simd, &of[2], x[2]) + times8(simd, &of[3], x[3]);
    let load = times8(simd, &of[4], span.a) + times8(simd, &of[5], span.change);
    if SLIP {
        let block = times8(simd, &of[0], x[0]) + times8(simd, &of[1], x[1]);
        (block + structure) + (load + times8(simd, &of[6], force))
    } else {
        structure + load
    }
}

/// Coefficients times factors.
#[inline(always)]
fn weighted<S: Simd>(simd: S, c: &[f64x8<S>; GROUPS], factors: &ByOrder) -> [f64x8<S>; GROUPS] {
    [c[0] * factors[0].load(simd), c[1] * factors[1].load(simd), c[2] * factors[2].load(simd)]
}

/// `Σ c_k t^(k−1)`.
#[inline(always)]
fn sum<S: Simd>(simd: S, c: &[f64x8<S>; GROUPS], t: f64) -> f64x2<S> {
    let t2 = t * t;
    let t4 = t2 * t2;
    let (low, high) = ((c[0] + c[1] * eight(simd, t4)) + c[2] * eight(simd, t4 * t4)).split();
    let (odd, even) = (low + high * four(simd, t2)).split();
    odd + even * two(simd, t)
}

/// `s, ṡ, η, η̇` of `s, η` and `ṡ, η̇`.
#[inline(always)]
fn state<S: Simd>(displacements: f64x2<S>, velocities: f64x2<S>) -> f64x4<S> {
    displacements.zip_low(velocities).combine(displacements.zip_high(velocities))
}

/// The same number twice.
#[inline(always)]
fn two<S: Simd>(simd: S, x: f64) -> f64x2<S> {
    f64x2::splat(simd, x)
}
