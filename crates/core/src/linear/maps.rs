//! The motion over whole samples as linear maps: eight samples at a time.
//!
//! Over evenly spaced samples the state after `k` of them is a sum of the state before and of the
//! loads at the samples between:
//!
//! ```text
//! x_{i+k} = E^k x_i + first_k a_i + Σ_{m=1..k} tap_{k−m} a_{i+m}  (+ the same of a force)
//! ```
//!
//! The maps depend neither on friction nor on the motion.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::lanes::{Eight, Four, combine4, combine8, dot, eight, four};
use super::polynomial::DEGREE;
use super::series::{Load, Series, advance};
use super::system::System;

/// Samples in a batch.
pub const BATCH: usize = 8;

/// Batches that quiet stick takes at once.
const QUIET_BATCHES: usize = 4;

/// Samples that quiet stick takes at once.
pub const QUIET: usize = BATCH * QUIET_BATCHES;

/// Loads at the samples of a batch, both ends included.
pub type Window = [f64; BATCH + 1];

/// The force on the block over a batch in slip.
#[derive(Clone, Copy, Debug)]
pub enum Force<'a> {
    /// The same at all samples, in N.
    Constant(f64),
    /// A coefficient times the normal force at the samples.
    Varying(f64, &'a Window),
}

impl Force<'_> {
    /// At the `k`-th sample.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, k: usize) -> f64 {
        match self {
            Self::Constant(force) => *force,
            Self::Varying(coefficient, normal) => coefficient * normal[k],
        }
    }
}

/// Maps of stick or slip for one step.
#[derive(Debug)]
pub struct Maps {
    /// For each number of samples from 1: a constant force, the first sample, the taps of the eight
    /// samples after it, the state; four components at a time.
    columns: [Vec<Four>; BATCH],
    /// The same for a force that varies: first sample and taps.
    force_columns: [Vec<Four>; BATCH],
    /// Stick over [`QUIET`] samples: first sample, taps, state.
    quiet: Vec<Four>,
}

/// One number at the samples `1 … 8` of a batch: a constant force, the first sample, the taps, the
/// state; and first sample and taps of a force that varies.
#[derive(Clone, Debug)]
pub struct Row {
    columns: Vec<Eight>,
    force_columns: Vec<Eight>,
}

/// What unit inputs leave behind over one step and more, as padded states.
#[derive(Debug)]
pub struct Units {
    stride: usize,
    /// `E^k` from `k = 1`, column by column.
    powers: [Vec<f64>; BATCH],
    /// What a unit at the first sample leaves after `k` samples, from 1: of acceleration, of force.
    first: [Vec<Vec<f64>>; 2],
    /// What a unit at a sample leaves `j` samples later.
    taps: [Vec<Vec<f64>>; 2],
    /// What a constant unit of force leaves after `k` samples, from 1.
    constant: Vec<Vec<f64>>,
}

impl Units {
    /// By the series of every unit input.
    #[inline(always)]
    #[must_use]
    pub fn new<S: Simd>(simd: S, system: &System, slip: bool, dt_s: f64) -> Self {
        let components = 2 + 2 * system.modes();
        let stride = components.div_ceil(4) * 4;
        let mut series = Series::new(system, DEGREE);
        let none = Load::default();
        let mut by_1 = vec![0.0; stride * stride];
        for (j, column) in by_1.chunks_exact_mut(stride).take(components).enumerate() {
            if slip || j != 1 {
                column[j] = 1.0;
                advance(simd, system, slip, dt_s, &none, &mut series, column);
            }
        }
        let loads = [
            Load { acceleration: 1.0, ..none },
            Load { acceleration_change: 1.0, ..none },
            Load { force: if slip { 1.0 } else { 0.0 }, ..none },
            Load { force_change: if slip { 1.0 } else { 0.0 }, ..none },
        ];
        let mut ends = [const { Vec::new() }; 4];
        for (end, load) in ends.iter_mut().zip(&loads) {
            end.resize(stride, 0.0);
            advance(simd, system, slip, dt_s, load, &mut series, end);
        }
        let [constant_a, ramp_a, constant_f, ramp_f] = ends;
        let on = |x: &[f64]| times(&by_1, x, stride);
        let less = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
        let plus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect::<Vec<_>>();
        // A sample's unit ramps up in the interval before it and down in the one after.
        let first = [(&constant_a, &ramp_a), (&constant_f, &ramp_f)].map(|(constant, ramp)| {
            let mut list = vec![less(constant, ramp)];
            for k in 1..BATCH {
                list.push(on(&list[k - 1]));
            }
            list
        });
        let taps = [(&ramp_a, 0), (&ramp_f, 1)].map(|(ramp, input)| {
            let mut list = vec![ramp.clone()];
            for j in 1..=BATCH {
                let moved = on(&list[j - 1]);
                list.push(if j == 1 { plus(&moved, &first[input][0]) } else { moved });
            }
            list
        });
        let mut constant = vec![constant_f.clone()];
        for k in 1..BATCH {
            constant.push(plus(&on(&constant[k - 1]), &constant_f));
        }
        let mut powers: [Vec<f64>; BATCH] = Default::default();
        for k in 1..BATCH {
            powers[k] = times(&by_1, if k == 1 { &by_1 } else { &powers[k - 1] }, stride);
        }
        powers[0] = by_1;
        Self { stride, powers, first, taps, constant }
    }

    /// The maps of whole states.
    #[must_use]
    pub fn maps(&self, slip: bool) -> Maps {
        let zero = vec![0.0; self.stride];
        let taps = |input: usize, k: usize| {
            let tap = move |m: usize| {
                if m <= k { self.taps[input][k - m].as_slice() } else { &[] }
            };
            (1..=BATCH).map(tap)
        };
        let columns = core::array::from_fn(|i| {
            let mut list: Vec<&[f64]> = vec![&self.constant[i], &self.first[0][i]];
            list.extend(taps(0, i + 1).map(|tap| if tap.is_empty() { &zero } else { tap }));
            list.extend(self.powers[i].chunks_exact(self.stride));
            by_fours(&list)
        });
        let force_columns = core::array::from_fn(|i| {
            let mut list: Vec<&[f64]> = vec![&self.first[1][i]];
            list.extend(taps(1, i + 1).map(|tap| if tap.is_empty() { &zero } else { tap }));
            by_fours(&list)
        });
        let quiet = if slip { Vec::new() } else { self.quiet() };
        Maps { columns, force_columns, quiet }
    }

    /// Stick over several batches: what a load has left moves on by itself.
    fn quiet(&self) -> Vec<Four> {
        let by_batch = &self.powers[BATCH - 1];
        let on = |x: &[f64]| times(by_batch, x, self.stride);
        let mut taps: Vec<Vec<f64>> = self.taps[0].clone();
        for j in BATCH + 1..QUIET {
            taps.push(on(&taps[j - BATCH]));
        }
        let (mut first, mut by_quiet) = (self.first[0][BATCH - 1].clone(), by_batch.clone());
        for _ in 1..QUIET_BATCHES {
            first = on(&first);
            by_quiet = on(&by_quiet);
        }
        let mut list: Vec<&[f64]> = vec![&first];
        list.extend((1..=QUIET).map(|m| taps[QUIET - m].as_slice()));
        list.extend(by_quiet.chunks_exact(self.stride));
        by_fours(&list)
    }

    /// The row of one number: `row` times the state and `of_a` and `of_force` times the loads at the
    /// sample itself.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, row: &[f64], of_a: f64, of_force: f64) -> Row {
        let start = 2 + BATCH;
        let mut columns = vec![Eight::ZERO; start + self.stride];
        let mut force_columns = vec![Eight::ZERO; 1 + BATCH];
        for k in 0..BATCH {
            columns[0].0[k] = dot(row, &self.constant[k]) + of_force;
            columns[1].0[k] = dot(row, &self.first[0][k]);
            force_columns[0].0[k] = dot(row, &self.first[1][k]);
            let [mut tap, mut force] = [0, 1].map(|input| dot(row, &self.taps[input][k]));
            if k == 0 {
                (tap, force) = (tap + of_a, force + of_force);
            }
            for m in 0..BATCH - k {
                columns[2 + m].0[m + k] = tap;
                force_columns[1 + m].0[m + k] = force;
            }
            let of_state = self.powers[k].chunks_exact(self.stride);
            for (column, of_j) in columns[start..].iter_mut().zip(of_state) {
                column.0[k] = dot(row, of_j);
            }
        }
        Row { columns, force_columns }
    }
}

impl Maps {
    /// State after `k` samples, 1 to 8, from a state at the first of the samples `a`.
    #[inline(always)]
    pub fn after<S: Simd>(
        &self,
        simd: S,
        k: usize,
        x: &[f64],
        a: &Window,
        force: Force<'_>,
        out: &mut [f64],
    ) {
        let [first, loads @ ..] = a;
        match force {
            Force::Constant(force) => {
                combine4(simd, &self.columns[k - 1], &[force, *first], loads, x, out);
            }
            Force::Varying(coefficient, [first_n, normal @ ..]) => {
                combine4(simd, &self.columns[k - 1], &[0.0, *first], loads, x, out);
                let count = BATCH + 1;
                let columns = self.force_columns[k - 1].chunks_exact(count);
                for (columns, out) in columns.zip(out.chunks_exact_mut(4)) {
                    let mut sum = [0.0; 4];
                    combine4(simd, columns, &[*first_n], normal, &[], &mut sum);
                    let c = four(simd, coefficient);
                    let all = fearless_simd::f64x4::from_slice(simd, out)
                        + c * fearless_simd::f64x4::from_slice(simd, &sum);
                    all.store_slice(out);
                }
            }
        }
    }

    /// State after [`QUIET`] samples of stick from a state at the first of `a`.
    #[inline(always)]
    pub fn after_quiet<S: Simd>(&self, simd: S, x: &[f64], a: &[f64; QUIET + 1], out: &mut [f64]) {
        let [first, loads @ ..] = a;
        combine4(simd, &self.quiet, &[*first], loads, x, out);
    }
}

impl Row {
    /// The number at the eight samples after the state `x` at the first of the samples `a`.
    #[inline(always)]
    pub fn values<S: Simd>(&self, simd: S, x: &[f64], a: &Window, force: Force<'_>) -> f64x8<S> {
        let [first, loads @ ..] = a;
        match force {
            Force::Constant(force) => combine8(simd, &self.columns, &[force, *first], loads, x),
            Force::Varying(coefficient, [first_n, normal @ ..]) => {
                combine8(simd, &self.columns, &[0.0, *first], loads, x)
                    + eight(simd, coefficient)
                        * combine8(simd, &self.force_columns, &[*first_n], normal, &[])
            }
        }
    }
}

/// A matrix of padded columns times as many padded columns as `x` holds.
#[must_use]
fn times(matrix: &[f64], x: &[f64], stride: usize) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    for (out, x) in out.chunks_exact_mut(stride).zip(x.chunks_exact(stride)) {
        for (column, x) in matrix.chunks_exact(stride).zip(x) {
            if *x != 0.0 {
                for (out, c) in out.iter_mut().zip(column) {
                    *out += c * x;
                }
            }
        }
    }
    out
}

/// Padded columns, four components of all at a time.
fn by_fours(list: &[&[f64]]) -> Vec<Four> {
    let fours = list[0].len() / 4;
    let mut columns = Vec::with_capacity(fours * list.len());
    for i in 0..fours {
        for column in list {
            columns.push(Four(core::array::from_fn(|j| column[4 * i + j])));
        }
    }
    columns
}
