//! The motion over whole samples as linear maps: eight samples at a time.
//!
//! Over evenly spaced samples the state after `k` of them is a sum of the state before and of the
//! loads at the samples between:
//!
//! ```text
//! x_{i+k} = E^k x_i + first_k a_i + Σ_{m=1..k} tap_{k−m} a_{i+m}  (+ the same of a force)
//! ```
//!
//! The maps depend neither on friction nor on the motion. Where in stick nothing couples the modes, `E^k`
//! has two numbers in each row: what the component itself does, and the other of its mode.

use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

use super::lanes::{Eight, Four, add4, combine4, combine8, eight, four};
use super::polynomial::DEGREE;
use super::series::{Load, ModalSeries, advance};
use super::system::System;

/// Samples in a batch.
pub const BATCH: usize = 8;

/// Batches that quiet stick takes at once.
const QUIET_BATCHES: usize = 4;

/// Samples that quiet stick takes at once.
pub const QUIET: usize = BATCH * QUIET_BATCHES;

/// Most storeys of which stick moves by whole columns: beyond, each mode by itself takes less.
const WHOLE_STOREYS: usize = 4;

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
    /// Number of modes where nothing couples them: then all columns are first sample, taps, the component
    /// itself and the other of its mode.
    apart: Option<usize>,
}

/// One number at the samples `1 … 8` of a batch: a constant force, the first sample, the taps, the
/// state; then first sample and taps of a force that varies.
#[derive(Clone, Debug)]
pub struct Row(Vec<Eight>);

/// What unit inputs leave behind over one step and more, as padded states one after another.
#[derive(Debug)]
pub struct UnitResponses {
    stride: usize,
    /// `E^k` from `k = 1`, column by column.
    powers: Vec<f64>,
    /// What a unit at the first sample leaves after `k` samples, from 1: of acceleration, of force.
    first: [Vec<f64>; 2],
    /// What a unit at a sample leaves `j` samples later.
    taps: [Vec<f64>; 2],
    /// What a constant unit of force leaves after `k` samples, from 1.
    constant: Vec<f64>,
    /// All of these at eight samples side by side, component by component: the constant force, the
    /// first sample and the taps of acceleration and of force, the columns of the powers.
    samples: Vec<Eight>,
}

/// How many of [`UnitResponses::samples`] come before the columns of the powers, in components of a state.
const INPUTS: usize = 5;

impl UnitResponses {
    /// By the series of every unit input.
    #[inline(always)]
    #[must_use]
    pub fn new<S: Simd>(simd: S, system: &System, slip: bool, dt_s: f64) -> Self {
        let components = 2 + 2 * system.modes();
        let stride = components.div_ceil(4) * 4;
        let mut series = ModalSeries::new(system, DEGREE);
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
        Self::of_step(by_1, ends)
    }

    /// Of `ẋ = A x + b a + g force` under a constant force, `A` by padded columns, over a step of so many
    /// series: each no longer than [`MAX_RATE_STEP`](super::MAX_RATE_STEP) over the rate of `A`.
    #[inline(always)]
    #[must_use]
    pub fn affine(a: &[f64], b: &[f64], g: &[f64], (dt_s, parts): (f64, usize)) -> Self {
        let stride = b.len();
        let none = vec![0.0; stride];
        let mut by_1 = vec![0.0; a.len()];
        for (j, column) in by_1.chunks_exact_mut(stride).enumerate() {
            column[j] = 1.0;
            move_affine(a, [&none, &none], (dt_s, parts), column);
        }
        let mut ends = [const { Vec::new() }; 4];
        let loads = [[b, &none], [&none, b], [g, &none], [&none, &none]];
        for (end, load) in ends.iter_mut().zip(loads) {
            end.resize(stride, 0.0);
            move_affine(a, load, (dt_s, parts), end);
        }
        Self::of_step(by_1, ends)
    }

    /// By the columns of `E`, and by what a unit leaves behind over one step: of a constant acceleration, of
    /// one that grows from zero, and of forces that do.
    #[inline(always)]
    fn of_step(by_1: Vec<f64>, ends: [Vec<f64>; 4]) -> Self {
        let stride = ends[0].len();
        let [constant_a, ramp_a, constant_f, ramp_f] = ends;
        // A sample's unit ramps up in the interval before it and down in the one after.
        let first = [(&constant_a, &ramp_a), (&constant_f, &ramp_f)].map(|(constant, ramp)| {
            let start = constant.iter().zip(ramp).map(|(constant, ramp)| constant - ramp);
            chain(&by_1, start.collect(), BATCH, stride)
        });
        let [first_a, first_f] = &first;
        let taps = [(ramp_a, first_a), (ramp_f, first_f)].map(|(ramp, first)| {
            let mut after = vec![0.0; stride];
            times(&by_1, &ramp, &mut after, stride);
            after.iter_mut().zip(first).for_each(|(after, first)| *after += first);
            let mut taps = ramp;
            taps.extend(chain(&by_1, after, BATCH, stride));
            taps
        });
        let mut constant = vec![0.0; BATCH * stride];
        constant[..stride].copy_from_slice(&constant_f);
        for k in 1..BATCH {
            let (before, after) = constant.split_at_mut(k * stride);
            let (before, after) = (&before[(k - 1) * stride..], &mut after[..stride]);
            times(&by_1, before, after, stride);
            after.iter_mut().zip(&constant_f).for_each(|(after, constant)| *after += constant);
        }
        let powers = chain(&by_1, by_1.clone(), BATCH, stride);
        let [[first_a, first_f], [taps_a, taps_f]] = [&first, &taps];
        let mut samples = Vec::with_capacity((INPUTS + stride) * stride);
        for list in [&constant, first_a, first_f, taps_a, taps_f] {
            side_by_side(list, stride, &mut samples);
        }
        side_by_side(&powers, stride * stride, &mut samples);
        Self { stride, powers, first, taps, constant, samples }
    }

    /// The `k`-th of padded states.
    #[inline(always)]
    fn state<'a>(&self, list: &'a [f64], k: usize) -> &'a [f64] {
        &list[k * self.stride..][..self.stride]
    }

    /// The columns of `E^(k+1)`.
    #[inline(always)]
    fn power(&self, k: usize) -> impl Iterator<Item = &[f64]> + Clone {
        let size = self.stride * self.stride;
        self.powers[k * size..][..size].chunks_exact(self.stride)
    }

    /// What the samples of a batch leave after the `k + 1`-th of them, those to come nothing.
    fn taps_of<'a>(
        &'a self,
        input: usize,
        k: usize,
        zero: &'a [f64],
    ) -> impl Iterator<Item = &'a [f64]> + Clone {
        (0..BATCH).map(move |m| if m <= k { self.state(&self.taps[input], k - m) } else { zero })
    }

    /// The maps of whole states.
    #[must_use]
    pub fn maps(&self, system: &System, slip: bool) -> Maps {
        let n = system.modes();
        if !slip && n > WHOLE_STOREYS && system.uncoupled_modes().is_some() {
            return self.maps_of_modes(n);
        }
        let zero = vec![0.0; self.stride];
        let columns = core::array::from_fn(|k| {
            let loads = [self.state(&self.constant, k), self.state(&self.first[0], k)];
            let taps = self.taps_of(0, k, &zero);
            by_fours(self.stride, loads.into_iter().chain(taps).chain(self.power(k)))
        });
        let force_columns = core::array::from_fn(|k| {
            let taps = self.taps_of(1, k, &zero);
            by_fours(self.stride, core::iter::once(self.state(&self.first[1], k)).chain(taps))
        });
        let quiet = if slip { Vec::new() } else { self.quiet(None) };
        Maps { columns, force_columns, quiet, apart: None }
    }

    /// The same of stick where nothing couples the modes.
    fn maps_of_modes(&self, n: usize) -> Maps {
        let zero = vec![0.0; self.stride];
        let size = self.stride * self.stride;
        let columns = core::array::from_fn(|k| {
            let of_state = modes_apart(&self.powers[k * size..][..size], n, self.stride);
            let first = core::iter::once(self.state(&self.first[0], k));
            let taps = self.taps_of(0, k, &zero);
            by_fours(self.stride, first.chain(taps).chain(of_state.iter().map(Vec::as_slice)))
        });
        let force_columns = [const { Vec::new() }; BATCH];
        Maps { columns, force_columns, quiet: self.quiet(Some(n)), apart: Some(n) }
    }

    /// Stick over several batches: what a load has left moves on by itself.
    fn quiet(&self, apart: Option<usize>) -> Vec<Four> {
        let stride = self.stride;
        let by_batch = &self.powers[(BATCH - 1) * stride * stride..];
        let mut taps = self.taps[0][..(BATCH + 1) * stride].to_vec();
        taps.resize(QUIET * stride, 0.0);
        for j in BATCH + 1..QUIET {
            let (before, after) = taps.split_at_mut(j * stride);
            times(by_batch, self.state(before, j - BATCH), &mut after[..stride], stride);
        }
        let first = self.state(&self.first[0], BATCH - 1).to_vec();
        let first = chain(by_batch, first, QUIET_BATCHES, stride);
        let powers = chain(by_batch, by_batch.to_vec(), QUIET_BATCHES, stride);
        let by_quiet = &powers[(QUIET_BATCHES - 1) * stride * stride..];
        let taps = (1..=QUIET).map(|m| self.state(&taps, QUIET - m));
        let first = core::iter::once(self.state(&first, QUIET_BATCHES - 1));
        if let Some(n) = apart {
            let of_state = modes_apart(by_quiet, n, stride);
            return by_fours(stride, first.chain(taps).chain(of_state.iter().map(Vec::as_slice)));
        }
        by_fours(stride, first.chain(taps).chain(by_quiet.chunks_exact(stride)))
    }

    /// A row times one of the blocks of `samples`.
    #[inline(always)]
    fn times_block<S: Simd>(&self, simd: S, block: usize, row: &[f64]) -> f64x8<S> {
        combine8(simd, &self.samples[block * row.len()..][..row.len()], &[], &[], row)
    }

    /// The row of one number: `row` times the state and `of_a` and `of_force` times the loads at the
    /// sample itself.
    #[inline(always)]
    #[must_use]
    pub fn row<S: Simd>(&self, simd: S, row: &[f64], of_a: f64, of_force: f64) -> Row {
        let stride = self.stride;
        let mut all = vec![Eight::ZERO; 2 + BATCH + stride + 1 + BATCH];
        let (columns, force_columns) = all.split_at_mut(2 + BATCH + stride);
        let (loads, of_state) = columns.split_at_mut(2 + BATCH);
        let row = &row[..stride];
        (self.times_block(simd, 0, row) + eight(simd, of_force)).store_slice(&mut loads[0].0);
        self.times_block(simd, 1, row).store_slice(&mut loads[1].0);
        self.times_block(simd, 2, row).store_slice(&mut force_columns[0].0);
        let mut taps = self.times_block(simd, 3, row).to_array();
        let mut force_taps = self.times_block(simd, 4, row).to_array();
        taps[0] += of_a;
        force_taps[0] += of_force;
        // A sample's tap is as old as the samples after it.
        for m in 0..BATCH {
            loads[2 + m].0[m..].copy_from_slice(&taps[..BATCH - m]);
            force_columns[1 + m].0[m..].copy_from_slice(&force_taps[..BATCH - m]);
        }
        for (j, column) in of_state.iter_mut().enumerate() {
            self.times_block(simd, INPUTS + j, row).store_slice(&mut column.0);
        }
        Row(all)
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
        if x.len() > 4
            && let Some(n) = self.apart
        {
            return move_modes(simd, &self.columns[k - 1], (*first, loads), (n, x), out);
        }
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
                    let all = f64x4::from_slice(simd, out) + c * f64x4::from_slice(simd, &sum);
                    all.store_slice(out);
                }
            }
        }
    }

    /// State after [`QUIET`] samples of stick from a state at the first of `a`.
    #[inline(always)]
    pub fn after_quiet<S: Simd>(&self, simd: S, x: &[f64], a: &[f64; QUIET + 1], out: &mut [f64]) {
        let [first, loads @ ..] = a;
        if x.len() > 4
            && let Some(n) = self.apart
        {
            return move_modes(simd, &self.quiet, (*first, loads), (n, x), out);
        }
        combine4(simd, &self.quiet, &[*first], loads, x, out);
    }
}

impl Row {
    /// The number at the eight samples after the state `x` at the first of the samples `a`.
    #[inline(always)]
    pub fn values<S: Simd>(&self, simd: S, x: &[f64], a: &Window, force: Force<'_>) -> f64x8<S> {
        let [first, loads @ ..] = a;
        let (columns, force_columns) = self.0.split_at(2 + BATCH + x.len());
        match force {
            Force::Constant(force) => combine8(simd, columns, &[force, *first], loads, x),
            Force::Varying(coefficient, [first_n, normal @ ..]) => {
                combine8(simd, columns, &[0.0, *first], loads, x)
                    + eight(simd, coefficient)
                        * combine8(simd, force_columns, &[*first_n], normal, &[])
            }
        }
    }
}

/// Moves modes that nothing couples: the loads at the first sample and after it, and of the state each
/// component and the other of its mode.
#[inline(always)]
fn move_modes<S: Simd>(
    simd: S,
    columns: &[Four],
    (first, loads): (f64, &[f64]),
    (n, x): (usize, &[f64]),
    out: &mut [f64],
) {
    let loads = loads.as_chunks::<4>().0;
    let count = 1 + 4 * loads.len() + 2;
    (out[0], out[1]) = (x[0], x[1]);
    out[2..2 + n].copy_from_slice(&x[2 + n..2 + 2 * n]);
    out[2 + n..2 + 2 * n].copy_from_slice(&x[2..2 + n]);
    let (x, out) = (x.as_chunks::<4>().0, out.as_chunks_mut::<4>().0);
    for i in 0..x.len() {
        let (of_first, rest) = columns[i * count..][..count].split_at(1);
        let (of_loads, of_state) = rest.split_at(4 * loads.len());
        let mut sums = [four(simd, 0.0); 4];
        sums[0] = of_first[0].load(simd) * four(simd, first);
        add4(simd, &mut sums, of_loads.as_chunks::<4>().0, loads);
        let [own, other] = [f64x4::from_slice(simd, &x[i]), f64x4::from_slice(simd, &out[i])];
        let of_state = of_state[0].load(simd) * own + of_state[1].load(simd) * other;
        (((sums[0] + sums[1]) + (sums[2] + sums[3])) + of_state).store_slice(&mut out[i]);
    }
}

/// Moves a state of `ẋ = A x + load` over a step under a load that is constant and one that grows to its
/// whole from zero, by so many Taylor series.
#[inline(always)]
fn move_affine(
    a: &[f64],
    [constant, ramp]: [&[f64]; 2],
    (length_s, parts): (f64, usize),
    x: &mut [f64],
) {
    let stride = x.len();
    let (part, part_s) = (1.0 / parts as f64, length_s / parts as f64);
    let [mut term, mut next] = [vec![0.0; stride], vec![0.0; stride]];
    for i in 0..parts {
        term.copy_from_slice(x);
        for k in 0..DEGREE {
            next.fill(0.0);
            times(a, &term, &mut next, stride);
            let (of_constant, of_ramp) = match k {
                0 => (1.0, part * i as f64),
                1 => (0.0, part),
                _ => (0.0, 0.0),
            };
            for (next, (constant, ramp)) in next.iter_mut().zip(constant.iter().zip(ramp)) {
                *next += of_constant * constant + of_ramp * ramp;
            }
            let step_s = part_s / (k + 1) as f64;
            let mut changes = false;
            for ((term, next), x) in term.iter_mut().zip(&next).zip(&mut *x) {
                *term = step_s * next;
                let sum = *x + *term;
                changes |= sum != *x;
                *x = sum;
            }
            if !changes && k > 1 {
                break;
            }
        }
    }
}

/// Of a matrix of padded columns that couples no modes what each component does to itself, and what the
/// other of its mode does to it.
fn modes_apart(matrix: &[f64], n: usize, stride: usize) -> [Vec<f64>; 2] {
    let at = |row: usize, column: usize| matrix[column * stride + row];
    let [mut own, mut other] = [vec![0.0; stride], vec![0.0; stride]];
    own[0] = 1.0;
    for (eta, rate) in (2..2 + n).zip(2 + n..) {
        (own[eta], other[eta]) = (at(eta, eta), at(eta, rate));
        (own[rate], other[rate]) = (at(rate, rate), at(rate, eta));
    }
    [own, other]
}

/// A matrix of padded columns times as many padded columns as `x` holds, into zeros.
#[inline(always)]
fn times(matrix: &[f64], x: &[f64], out: &mut [f64], stride: usize) {
    for (out, x) in out.chunks_exact_mut(stride).zip(x.chunks_exact(stride)) {
        for (column, x) in matrix.chunks_exact(stride).zip(x) {
            if *x != 0.0 {
                for (out, c) in out.iter_mut().zip(column) {
                    *out += c * x;
                }
            }
        }
    }
}

/// Padded columns and what each power of a matrix makes of them, up to `count` times as many.
#[inline(always)]
fn chain(matrix: &[f64], start: Vec<f64>, count: usize, stride: usize) -> Vec<f64> {
    let size = start.len();
    let mut list = start;
    list.resize(count * size, 0.0);
    for k in 1..count {
        let (before, after) = list.split_at_mut(k * size);
        times(matrix, &before[(k - 1) * size..], &mut after[..size], stride);
    }
    list
}

/// Numbers of the first eight of lists of one size, each at all eight.
fn side_by_side(list: &[f64], size: usize, out: &mut Vec<Eight>) {
    out.extend((0..size).map(|i| Eight(core::array::from_fn(|k| list[k * size + i]))));
}

/// Padded columns, four components of all at a time.
#[inline(always)]
fn by_fours<'a>(stride: usize, list: impl Iterator<Item = &'a [f64]> + Clone) -> Vec<Four> {
    let mut columns = Vec::with_capacity(list.clone().count() * stride / 4);
    for i in 0..stride / 4 {
        for column in list.clone() {
            columns.push(Four(core::array::from_fn(|j| column[4 * i + j])));
        }
    }
    columns
}
