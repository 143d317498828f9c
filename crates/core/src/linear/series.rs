//! Taylor series of the motion in stick and in slip.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::lanes::{Eight, Width, dot, eight, four};
use super::polynomial::{DEGREE, Polynomial};
use super::system::System;

/// Longest interval for one series, times the rate: 0.8^17 / 17! = 6.3e-17.
pub const MAX_RATE_STEP: f64 = 0.8;

/// Pairs of orders.
const PAIRS: usize = DEGREE / 2;

/// Loads over an interval, linear in time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// `a = Ü + g sin θ` at the start in m/s².
    pub acceleration: f64,
    /// Its change over the interval.
    pub acceleration_change: f64,
    /// Force on the block at the start in N; of no effect in stick.
    pub force: f64,
    /// Its change over the interval.
    pub force_change: f64,
}

/// What a unit of each of `s, ṡ, η, η̇` and of the four numbers of a [`Load`] adds to the state of a
/// system of one storey: coefficients from the first order on, an odd order and the even one after it
/// side by side.
pub type SeriesTable = [[Eight; 8]; PAIRS];

/// Taylor coefficients of a state over an interval, in time over the interval's length.
///
/// Order after order, each as many numbers as a padded state has. With `rate × length ≤ MAX_RATE_STEP`
/// the first term left out is below 7e-17 of the largest.
#[derive(Clone, Debug)]
pub struct Series {
    stride: usize,
    c: Vec<f64>,
    f: Vec<f64>,
}

/// 1 / (k + 1).
const RECIPROCAL: [f64; DEGREE] = {
    let mut table = [0.0; DEGREE];
    let mut k = 0;
    while k < DEGREE {
        table[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    table
};

impl Series {
    /// Room for the series of a system.
    #[must_use]
    pub fn new(system: &System) -> Self {
        let n = system.modes();
        let stride = (2 + 2 * n).div_ceil(4) * 4;
        Self { stride, c: vec![0.0; stride * (DEGREE + 1)], f: vec![0.0; n] }
    }

    /// Motion from a padded state over `length_s`, order by order from the equations of motion.
    #[inline(always)]
    pub fn expand(&mut self, system: &System, slip: bool, x: &[f64], load: &Load, length_s: f64) {
        let (n, stride) = (self.f.len(), self.stride);
        let (l, f) = (&system.participation[..n], &mut self.f[..n]);
        self.c[..stride].copy_from_slice(x);
        if !slip {
            self.c[1] = 0.0;
        }
        for k in 0..DEGREE {
            let (before, after) = self.c.split_at_mut((k + 1) * stride);
            let (now, next) = (&before[k * stride..], &mut after[..stride]);
            let (a, force) = match k {
                0 => (load.acceleration, load.force),
                1 => (load.acceleration_change, load.force_change),
                _ => (0.0, 0.0),
            };
            let step = length_s * RECIPROCAL[k];
            let (eta, rate) = (&now[2..2 + n], &now[2 + n..2 + 2 * n]);
            system.restoring(eta, rate, f);
            let (block, rest) = next[..2 + 2 * n].split_at_mut(2);
            let (next_eta, next_rate) = rest.split_at_mut(n);
            let mut u = a;
            if slip {
                u = system.block_acceleration(now[0], now[1], dot(l, f), force);
                (block[0], block[1]) = (step * now[1], step * (u - a));
            } else {
                (block[0], block[1]) = (0.0, 0.0);
            }
            for j in 0..n {
                next_eta[j] = step * rate[j];
                next_rate[j] = -step * (f[j] + l[j] * u);
            }
        }
    }

    /// The same by a table for this length, of one storey at most.
    #[inline(always)]
    pub fn expand_by_table<S: Simd, const SLIP: bool>(
        &mut self,
        simd: S,
        table: &SeriesTable,
        x: &[f64],
        load: &Load,
    ) {
        let Some((start, orders)) = self.c.split_first_chunk_mut::<4>() else { return };
        let Some(x) = x.first_chunk::<4>() else { return };
        *start = *x;
        if !SLIP {
            start[1] = 0.0;
        }
        for (columns, out) in table.iter().zip(orders.chunks_exact_mut(8)) {
            let structure = of(simd, columns, 2, x[2]) + of(simd, columns, 3, x[3]);
            let ground = of(simd, columns, 4, load.acceleration)
                + of(simd, columns, 5, load.acceleration_change);
            let c = if SLIP {
                let force =
                    of(simd, columns, 6, load.force) + of(simd, columns, 7, load.force_change);
                let block = of(simd, columns, 0, x[0]) + of(simd, columns, 1, x[1]);
                (ground + force) + (block + structure)
            } else {
                ground + structure
            };
            c.store_slice(out);
        }
    }

    /// Four components of an order.
    #[inline(always)]
    fn four<S: Simd>(simd: S, c: &[f64], stride: usize, k: usize, i: usize) -> f64x4<S> {
        f64x4::from_slice(simd, &c[k * stride + 4 * i..][..4])
    }

    /// State at `t` in [0, 1], padded.
    #[inline(always)]
    pub fn state_at<S: Simd>(&self, simd: S, t: f64, out: &mut [f64]) {
        let (t2, stride) = (t * t, out.len());
        let c = &self.c[..stride * (DEGREE + 1)];
        let t4 = four(simd, t2 * t2);
        for (i, out) in out.chunks_exact_mut(4).enumerate() {
            // Four sums, of the orders that leave the same rest on division by four.
            let mut sums = [Self::four(simd, c, stride, DEGREE, i); 4];
            for (r, sum) in sums.iter_mut().enumerate() {
                let mut k = 12 + r;
                *sum = if r == 0 {
                    Self::four(simd, c, stride, k, i) + *sum * t4
                } else {
                    Self::four(simd, c, stride, k, i)
                };
                while k >= 4 {
                    k -= 4;
                    *sum = Self::four(simd, c, stride, k, i) + *sum * t4;
                }
            }
            let even = sums[0] + sums[2] * four(simd, t2);
            let odd = sums[1] + sums[3] * four(simd, t2);
            (even + odd * four(simd, t)).store_slice(out);
        }
    }

    /// The coefficients of one component of the state.
    #[inline(always)]
    #[must_use]
    pub fn component<W: Width>(&self, width: W, i: usize) -> Polynomial {
        let stride = 4 * width.fours();
        let c = &self.c[..stride * (DEGREE + 1)];
        let mut p = [0.0; DEGREE + 1];
        for k in 0..=DEGREE {
            p[k] = c[k * stride + i];
        }
        p
    }

    /// The coefficients of a padded row times the state.
    #[inline(always)]
    #[must_use]
    pub fn row<W: Width>(&self, width: W, row: &[f64]) -> Polynomial {
        let stride = 4 * width.fours();
        let (row, c) = (&row[..stride], &self.c[..stride * (DEGREE + 1)]);
        let mut p = [0.0; DEGREE + 1];
        for k in 0..=DEGREE {
            p[k] = dot(row, &c[k * stride..][..stride]);
        }
        p
    }

    /// The coefficients of an order.
    #[inline(always)]
    #[must_use]
    pub fn order(&self, k: usize) -> &[f64] {
        &self.c[k * self.stride..][..self.stride]
    }
}

#[inline(always)]
fn of<S: Simd>(simd: S, columns: &[Eight; 8], j: usize, x: f64) -> f64x8<S> {
    columns[j].load(simd) * eight(simd, x)
}

/// The table of a system of one storey at most for intervals of `length_s`.
#[must_use]
pub fn series_table(system: &System, slip: bool, length_s: f64) -> Box<SeriesTable> {
    let mut table = Box::new([[Eight::ZERO; 8]; PAIRS]);
    let mut series = Series::new(system);
    for input in 0..8 {
        let mut x = [0.0; 4];
        if let Some(x) = x.get_mut(input) {
            *x = 1.0;
        }
        let of = |i: usize| f64::from(u8::from(input == i));
        let load = Load {
            acceleration: of(4),
            acceleration_change: of(5),
            force: of(6),
            force_change: of(7),
        };
        if slip || (2..6).contains(&input) {
            series.expand(system, slip, &x, &load, length_s);
            for k in 1..=DEGREE {
                let half = (k - 1) % 2 * 4;
                table[(k - 1) / 2][input].0[half..half + 4].copy_from_slice(series.order(k));
            }
        }
    }
    table
}

/// Moves a padded state over `length_s` under loads that are linear in it, by as many series as the
/// length needs.
#[inline(always)]
pub fn advance<S: Simd>(
    simd: S,
    system: &System,
    slip: bool,
    length_s: f64,
    load: &Load,
    series: &mut Series,
    x: &mut [f64],
) {
    let rate = if slip { system.slip_rate_rad_per_s } else { system.stick_rate_rad_per_s };
    let pieces = (rate * length_s / MAX_RATE_STEP).ceil().max(1.0);
    let part = Load {
        acceleration_change: load.acceleration_change / pieces,
        force_change: load.force_change / pieces,
        ..*load
    };
    for piece in 0..pieces as usize {
        let load = Load {
            acceleration: load.acceleration + part.acceleration_change * piece as f64,
            force: load.force + part.force_change * piece as f64,
            ..part
        };
        let s = x[0];
        series.expand(system, slip, x, &load, length_s / pieces);
        series.state_at(simd, 1.0, x);
        if !slip {
            x[0] = s;
        }
    }
}
