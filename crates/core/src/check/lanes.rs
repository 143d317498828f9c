//! Eight knots, or eight intervals between knots, side by side.
//!
//! Every interval starts from a stored state, so intervals of one phase do not depend on each other.
//! Lanes never mix, no operation is fused with another and no sum is reordered: every instruction
//! set gives the same bits.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};

use super::collocation::{MOST_PASSES, NODES, POINTS, ROUNDING, Rule};
use super::demands::{Outputs, Peaks, output, raise};
use super::law::Law;
use super::structure::{Phase, StoreyDamping, Structure, larger as greatest};
use crate::error::Stopped;
use crate::progress::Pulse;
use crate::response::{History, Mode};

/// Knots or intervals side by side.
pub(super) const LANES: usize = 8;

/// One number for each of them.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Eight(pub(super) [f64; LANES]);

impl Eight {
    pub(super) const ZERO: Self = Self([0.0; LANES]);

    #[inline(always)]
    fn load<S: Simd>(&self, simd: S) -> f64x8<S> {
        f64x8::load_array_ref(simd, &self.0)
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, value: f64x8<S>) {
        self.0 = value.to_array();
    }

    /// The largest.
    pub(super) fn largest(&self) -> f64 {
        self.0.iter().fold(f64::NEG_INFINITY, |most, &x| if x > most { x } else { most })
    }
}

#[inline(always)]
fn all<S: Simd>(simd: S, x: f64) -> f64x8<S> {
    f64x8::splat(simd, x)
}

#[inline(always)]
fn larger<S: Simd>(a: f64x8<S>, b: f64x8<S>) -> f64x8<S> {
    b.simd_gt(a).select(b, a)
}

#[inline(always)]
fn smaller<S: Simd>(a: f64x8<S>, b: f64x8<S>) -> f64x8<S> {
    b.simd_lt(a).select(b, a)
}

/// A closure that is compiled into the loop that calls it, for its instructions.
#[inline(always)]
fn inlined<F>(closure: F) -> F {
    closure
}

/// The values of a closure at 0 and 1, likewise.
#[inline(always)]
fn both<T>(at: impl Fn(usize) -> T) -> [T; 2] {
    [at(0), at(1)]
}

/// Knots of eight lanes: those from one on, or any.
pub(super) struct Places {
    at: [usize; LANES],
    contiguous: bool,
}

impl Places {
    pub(super) fn new(at: [usize; LANES]) -> Self {
        let contiguous = at.iter().enumerate().all(|(lane, &k)| k == at[0] + lane);
        Self { at, contiguous }
    }

    /// Entry `i` of `n` of a list knot by knot, `later` knots on.
    #[inline(always)]
    fn read<S: Simd>(&self, simd: S, list: &[f64], later: usize, [n, i]: [usize; 2]) -> f64x8<S> {
        if self.contiguous && n == 1 {
            let from = self.at[0] + later;
            if let Some(part) = list.get(from..from + LANES) {
                return f64x8::from_slice(simd, part);
            }
        }
        let one = |lane: usize| list[(self.at[lane] + later) * n + i];
        f64x8::load_array(simd, core::array::from_fn(one))
    }
}

/// Largest sizes of what is stored.
#[derive(Clone, Copy)]
pub(super) struct Sizes {
    /// `s`.
    pub(super) place: Eight,
    /// `q`.
    pub(super) storey: Eight,
    /// `q̇`.
    pub(super) rate: Eight,
    /// `Ü`.
    pub(super) table: Eight,
}

/// The worst of all lanes so far.
pub(super) struct Worst {
    pub(super) displacement: [Eight; 2],
    pub(super) velocity: [Eight; 2],
    pub(super) force: [Eight; 2],
    pub(super) table: Eight,
    pub(super) excess: Eight,
    pub(super) sliding: Eight,
    pub(super) sizes: Sizes,
    /// 0, or not a number where something stored is none.
    pub(super) broken: Eight,
}

impl Worst {
    pub(super) const NONE: Self = Self {
        displacement: [Eight::ZERO; 2],
        velocity: [Eight::ZERO; 2],
        force: [Eight::ZERO; 2],
        table: Eight::ZERO,
        excess: Eight::ZERO,
        sliding: Eight::ZERO,
        sizes: Sizes {
            place: Eight::ZERO,
            storey: Eight::ZERO,
            rate: Eight::ZERO,
            table: Eight::ZERO,
        },
        broken: Eight::ZERO,
    };
}

#[inline(always)]
fn keep<S: Simd>(simd: S, worst: &mut Eight, value: f64x8<S>) {
    worst.store(larger(worst.load(simd), value));
}

/// What the lanes need of a model.
pub(super) struct Bench<'a> {
    pub(super) structure: &'a Structure,
    pub(super) rule: &'a Rule,
    pub(super) history: &'a History,
    /// `g sin θ`.
    pub(super) slope: f64,
    pub(super) instant_s: f64,
    /// Force of the block on the stop at every knot; empty without a stop.
    pub(super) stop: &'a [f64],
    pub(super) law: &'a Law,
}

/// What one look at the knots tells of each.
pub(super) struct Knots {
    /// Outputs one after another, `stride` values each.
    pub(super) outputs: Vec<f64>,
    pub(super) stride: usize,
    pub(super) kinetic_j: Vec<f64>,
    pub(super) strain_j: Vec<f64>,
    pub(super) attained: Vec<f64>,
}

impl Knots {
    pub(super) fn new(knots: usize, outputs: usize) -> Self {
        let stride = knots.next_multiple_of(LANES);
        Self {
            outputs: vec![0.0; outputs * stride],
            stride,
            kinetic_j: vec![0.0; stride],
            strain_j: vec![0.0; stride],
            attained: vec![0.0; outputs],
        }
    }
}

/// Work space of lanes, by storey.
struct Storeys {
    q: Vec<Eight>,
    v: Vec<Eight>,
    a: Vec<Eight>,
    elastic: Vec<Eight>,
    viscous: Vec<Eight>,
}

impl Storeys {
    fn new(n: usize) -> Self {
        let list = || vec![Eight::ZERO; n];
        Self { q: list(), v: list(), a: list(), elastic: list(), viscous: list() }
    }
}

/// Adds the forces of elements between neighbouring floors; returns the largest single term.
#[inline(always)]
fn add_chain<S: Simd>(
    simd: S,
    n: usize,
    chain: &[f64],
    q: &[Eight],
    out: &mut [Eight],
) -> f64x8<S> {
    let (mut below, mut term) = (all(simd, 0.0), all(simd, 0.0));
    for i in 0..n {
        let (k, here) = (all(simd, chain[i]), q[i].load(simd));
        let force = k * (here - below);
        let sum = out[i].load(simd) + force;
        out[i].store(sum);
        if i > 0 {
            let sum = out[i - 1].load(simd) - force;
            out[i - 1].store(sum);
        }
        term = larger(larger(term, (k * here).abs()), (k * below).abs());
        below = here;
    }
    term
}

/// `Σ c (x_i − x_{i−1})²`.
#[inline(always)]
fn chain_form<S: Simd>(simd: S, chain: &[f64], x: impl Fn(usize) -> f64x8<S>) -> f64x8<S> {
    let (mut below, mut sum) = (all(simd, 0.0), all(simd, 0.0));
    for (i, &c) in chain.iter().enumerate() {
        let here = x(i);
        let over = here - below;
        sum += all(simd, c) * over * over;
        below = here;
    }
    sum
}

/// Hands on all outputs in their order: those of the block, and of the storeys from displacement and
/// acceleration.
#[inline(always)]
fn each_output<S: Simd>(
    simd: S,
    n: usize,
    block: [f64x8<S>; output::STOREYS],
    storey: impl Fn(usize) -> [f64x8<S>; 2],
    mut out: impl FnMut(usize, f64x8<S>),
) {
    for g in 0..output::STOREYS {
        out(g, block[g]);
    }
    let mut below = all(simd, 0.0);
    for i in 0..n {
        let [q, acceleration] = storey(i);
        out(output::STOREYS + i, q);
        out(output::STOREYS + n + i, q - below);
        out(output::STOREYS + 2 * n + i, acceleration);
        below = q;
    }
}

impl Bench<'_> {
    /// `C1 ṡ² + q̇ᵀ C q̇`.
    #[inline(always)]
    fn dissipation<S: Simd>(
        &self,
        simd: S,
        w: f64x8<S>,
        v: impl Fn(usize) -> f64x8<S>,
    ) -> f64x8<S> {
        let s = self.structure;
        let storeys = match &s.damping {
            StoreyDamping::Chain(c) => chain_form(simd, c, v),
            StoreyDamping::Full(c) => {
                let n = s.masses_kg.len();
                let mut sum = all(simd, 0.0);
                for i in 0..n {
                    let mut row = all(simd, 0.0);
                    for j in 0..n {
                        row += all(simd, c[i * n + j]) * v(j);
                    }
                    sum += v(i) * row;
                }
                sum
            }
        };
        all(simd, s.damper) * w * w + storeys
    }

    /// `T` in a slip at a velocity, of a load of sliding.
    #[inline(always)]
    fn sliding_force<S: Simd>(&self, simd: S, w: f64x8<S>, load: f64x8<S>) -> f64x8<S> {
        match &self.law.rate {
            Some(rate) => load * f64x8::load_array(simd, rate.coefficients(w.abs().to_array())),
            None => load,
        }
    }

    /// `1ᵀ (C q̇ + K q)`.
    #[inline(always)]
    fn base_force<S: Simd>(
        &self,
        simd: S,
        q: impl Fn(usize) -> f64x8<S>,
        v: impl Fn(usize) -> f64x8<S>,
    ) -> f64x8<S> {
        let s = self.structure;
        let Some(&k) = s.stiffnesses.first() else { return all(simd, 0.0) };
        let mut sum = all(simd, k) * q(0);
        for (j, &c) in s.base_damping.iter().enumerate() {
            sum += all(simd, c) * v(j);
        }
        sum
    }

    /// Looks at every knot by itself: the balance of its forces, its energies and its outputs.
    #[inline(always)]
    pub(super) fn knots<S: Simd>(
        &self,
        simd: S,
        outputs: &Outputs,
        worst: &mut Worst,
        (knots, pulse): (&mut Knots, &mut Pulse<'_>),
    ) -> Result<(), Stopped> {
        let count = self.structure.masses_kg.len();
        let mut storeys = Storeys::new(count);
        let mut attained = vec![Eight::ZERO; outputs.len()];
        let last = self.history.len() - 1;
        for from in (0..=last).step_by(LANES) {
            pulse.beat(16 * (1 + count as u32))?;
            let places = Places::new(core::array::from_fn(|lane| (from + lane).min(last)));
            // One storey gets loops of its own.
            let (n, at) = (count, (from, &places));
            if n == 1 {
                self.eight_knots(simd, 1, at, outputs, worst, knots, &mut storeys, &mut attained);
            } else {
                self.eight_knots(simd, n, at, outputs, worst, knots, &mut storeys, &mut attained);
            }
        }
        for (attained, lanes) in knots.attained.iter_mut().zip(&attained) {
            *attained = lanes.largest();
        }
        Ok(())
    }

    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // one loop's body
    fn eight_knots<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (from, places): (usize, &Places),
        outputs: &Outputs,
        worst: &mut Worst,
        knots: &mut Knots,
        storeys: &mut Storeys,
        attained: &mut [Eight],
    ) {
        let (h, structure) = (self.history, self.structure);
        let zero = all(simd, 0.0);
        let slope = all(simd, self.slope);
        let one = inlined(
            #[inline(always)]
            |list: &[f64]| places.read(simd, list, 0, [1, 0]),
        );
        let s = one(&h.sliding_displacement_m);
        let w = one(&h.sliding_velocity_m_per_s);
        let block = one(&h.block_acceleration_m_per_s2);
        let table = one(&h.table_acceleration_m_per_s2);
        let force = one(&h.friction_force_n);
        let stop = if self.stop.is_empty() { zero } else { one(self.stop) };
        let mut sum = s + w + block + table + force;
        keep(simd, &mut worst.sizes.place, s.abs());
        keep(simd, &mut worst.sizes.table, table.abs());
        for i in 0..n {
            let of = inlined(
                #[inline(always)]
                |list: &[f64]| places.read(simd, list, 0, [n, i]),
            );
            let (q, v) = (of(&h.storey_displacement_m), of(&h.storey_velocity_m_per_s));
            let a = of(&h.storey_acceleration_m_per_s2);
            sum += q + v + a;
            keep(simd, &mut worst.sizes.storey, q.abs());
            keep(simd, &mut worst.sizes.rate, v.abs());
            storeys.q[i].store(q);
            storeys.v[i].store(v);
            storeys.a[i].store(a);
            storeys.elastic[i] = Eight::ZERO;
            storeys.viscous[i] = Eight::ZERO;
        }
        worst.broken.store(worst.broken.load(simd) + sum * zero);
        // Eqs (9), (10): the largest defect and the largest single term.
        let mut term = add_chain(simd, n, &structure.stiffnesses, &storeys.q, &mut storeys.elastic);
        match &structure.damping {
            StoreyDamping::Chain(c) => {
                term = larger(term, add_chain(simd, n, c, &storeys.v, &mut storeys.viscous));
            }
            StoreyDamping::Full(c) => {
                for i in 0..n {
                    let mut row = zero;
                    for j in 0..n {
                        let share = all(simd, c[i * n + j]) * storeys.v[j].load(simd);
                        term = larger(term, share.abs());
                        row += share;
                    }
                    storeys.viscous[i].store(row);
                }
            }
        }
        let total = block + slope;
        let spring = all(simd, structure.spring) * s;
        let damper = all(simd, structure.damper) * w;
        let inertia = all(simd, structure.block_kg) * total;
        let mut balance = inertia + damper + spring + stop - force;
        let mut defect = zero;
        let mut kinetic = all(simd, structure.block_kg) * w * w;
        for i in 0..n {
            let mass = all(simd, structure.masses_kg[i]);
            let inertia = mass * (storeys.a[i].load(simd) + slope);
            balance += inertia;
            let floor = inertia + storeys.viscous[i].load(simd) + storeys.elastic[i].load(simd);
            defect = larger(defect, floor.abs());
            term = larger(term, inertia.abs());
            let speed = w + storeys.v[i].load(simd);
            kinetic += mass * speed * speed;
        }
        for single in [spring, damper, inertia, force, stop] {
            term = larger(term, single.abs());
        }
        let stuck =
            f64x8::load_array(
                simd,
                core::array::from_fn(|lane| {
                    if h.mode[places.at[lane]] == Mode::Stick { 1.0 } else { 0.0 }
                }),
            );
        let split = all(simd, structure.block_kg) * (block - table);
        defect = larger(larger(defect, balance.abs()), (split * stuck).abs());
        keep(simd, &mut worst.force[0], defect);
        keep(simd, &mut worst.force[1], term);
        keep(simd, &mut worst.velocity[0], (w * stuck).abs());
        let half = all(simd, 0.5);
        let form = chain_form(
            simd,
            &structure.stiffnesses,
            #[inline(always)]
            |i| storeys.q[i].load(simd),
        );
        let strain = half * (spring * s + form);
        let out = inlined(
            #[inline(always)]
            |g: usize, value: f64x8<S>| {
                let to = g * knots.stride + from;
                knots.outputs[to..to + LANES].copy_from_slice(&value.to_array());
                keep(simd, &mut attained[g], value.abs());
            },
        );
        let base = self.base_force(
            simd,
            #[inline(always)]
            |i| storeys.q[i].load(simd),
            #[inline(always)]
            |i| storeys.v[i].load(simd),
        );
        let floor = inlined(
            #[inline(always)]
            |i: usize| storeys.a[i].load(simd) + slope,
        );
        let slider = force - (spring + damper) - stop;
        let fixed = [w, block, slider, force, base, outputs.moment(simd, total, floor), stop];
        each_output(
            simd,
            n,
            fixed,
            #[inline(always)]
            |i| [storeys.q[i].load(simd), storeys.a[i].load(simd)],
            out,
        );
        knots.kinetic_j[from..from + LANES].copy_from_slice(&(half * kinetic).to_array());
        knots.strain_j[from..from + LANES].copy_from_slice(&strain.to_array());
    }
}

/// Intervals to be judged side by side; the last stands for the lanes that are left.
pub(super) struct Group {
    pub(super) phase: Phase,
    pub(super) count: usize,
    knots: [usize; LANES],
    /// Equal steps that each interval takes, and their length.
    steps: usize,
    step_s: Eight,
    table: [Eight; 2],
    normal: [Eight; 2],
    drift: Eight,
    /// Sign of the sliding; and `T` at both ends.
    sign: Eight,
    force: [Eight; 2],
}

/// An interval of one piece.
pub(super) struct Interval {
    pub(super) knot: usize,
    pub(super) length_s: f64,
    pub(super) table: [f64; 2],
    pub(super) normal: [f64; 2],
    /// `dÜ/dt`.
    pub(super) drift: f64,
    pub(super) sign: f64,
    pub(super) force: [f64; 2],
}

impl Group {
    pub(super) fn new(phase: Phase, steps: usize) -> Self {
        Self {
            phase,
            count: 0,
            knots: [0; LANES],
            steps,
            step_s: Eight::ZERO,
            table: [Eight::ZERO; 2],
            normal: [Eight::ZERO; 2],
            drift: Eight::ZERO,
            sign: Eight::ZERO,
            force: [Eight::ZERO; 2],
        }
    }

    /// Takes an interval; whether there is no room for another.
    pub(super) fn push(&mut self, one: &Interval) -> bool {
        let lane = self.count;
        self.knots[lane] = one.knot;
        self.step_s.0[lane] = one.length_s / self.steps as f64;
        for end in 0..2 {
            self.table[end].0[lane] = one.table[end];
            self.normal[end].0[lane] = one.normal[end];
            self.force[end].0[lane] = one.force[end];
        }
        self.drift.0[lane] = one.drift;
        self.sign.0[lane] = one.sign;
        self.count += 1;
        self.count == LANES
    }

    /// Repeats the last interval in the lanes that are left.
    pub(super) fn fill(&mut self) {
        let (from, last) = (self.count, self.count - 1);
        let lists = [&mut self.step_s, &mut self.drift, &mut self.sign]
            .into_iter()
            .chain(&mut self.table)
            .chain(&mut self.normal)
            .chain(&mut self.force);
        for list in lists {
            let value = list.0[last];
            list.0[from..].fill(value);
        }
        let value = self.knots[last];
        self.knots[from..].fill(value);
    }

    pub(super) fn knot(&self, lane: usize) -> usize {
        self.knots[lane]
    }
}

/// The map from inputs to a path of one phase and step, row by row, of inputs that are not 0.
pub(super) struct Map {
    inputs: Vec<usize>,
    /// Rows that are 0, and those that are not with their entries.
    blank: Vec<usize>,
    rows: Vec<usize>,
    entries: Vec<f64>,
}

impl Map {
    /// From the columns of all inputs.
    pub(super) fn new(phase: Phase, degrees: usize, columns: &[f64]) -> Self {
        let count = 2 * degrees + 4;
        let length = columns.len() / count;
        let stuck = [degrees, 2 * degrees + 2, 2 * degrees + 3];
        let inputs: Vec<usize> =
            (0..count).filter(|j| phase != Phase::Stick || !stuck.contains(j)).collect();
        let row = |r: usize| inputs.iter().map(move |j| columns[j * length + r]);
        let (rows, blank): (Vec<usize>, Vec<usize>) =
            (0..length).partition(|&r| row(r).any(|c| c != 0.0));
        let entries = rows.iter().flat_map(|&r| row(r)).collect();
        Self { inputs, blank, rows, entries }
    }
}

/// How far outputs may leave the chord, as [`super::step::Spread`] has it.
pub(super) struct Reach<'a> {
    /// Output by output, those only that leave it.
    pub(super) bounds: &'a [(usize, Vec<(usize, f64)>)],
    /// Whether nothing is known of it.
    pub(super) unknown: bool,
    pub(super) longest_s: f64,
    pub(super) knots: &'a Knots,
}

/// What is told of the intervals of a group side by side, or of one of them.
#[derive(Clone, Copy)]
pub(super) struct Told<T> {
    pub(super) work: T,
    pub(super) size: T,
    pub(super) damping: T,
    pub(super) friction: T,
    /// Margin in stick, speed in slip: at both ends, the least at any point, and what it cannot fall
    /// below in between where it is not monotone.
    pub(super) ends: [T; 2],
    pub(super) least: T,
    pub(super) low: T,
    /// Largest |ṡ|.
    pub(super) fastest: T,
}

impl<T: Copy> Told<T> {
    /// The same of something else in place of each number.
    fn map<U>(&self, of: impl Fn(T) -> U) -> Told<U> {
        Told {
            work: of(self.work),
            size: of(self.size),
            damping: of(self.damping),
            friction: of(self.friction),
            ends: self.ends.map(&of),
            least: of(self.least),
            low: of(self.low),
            fastest: of(self.fastest),
        }
    }
}

impl Told<Eight> {
    /// What is told of a lane.
    pub(super) fn lane(&self, lane: usize) -> Told<f64> {
        self.map(|eight| eight.0[lane])
    }
}

/// Inputs and paths of a group under judgement.
pub(super) struct Work {
    input: Vec<Eight>,
    /// The inputs that are not 0, and a state at a node.
    active: Vec<Eight>,
    state: Vec<(Eight, Eight)>,
    path: Vec<Eight>,
    /// `x` at the nodes, and `ẍ` where the equations were solved.
    trace: Vec<Eight>,
    fastest: Vec<Eight>,
    /// Outputs at the nodes, and at the ends of a step within an interval.
    values: Vec<Eight>,
    ends: [Vec<Eight>; 2],
    /// Normal force at the ends of a step.
    normal: [Eight; 2],
    seen: Seen,
    pub(super) told: Told<Eight>,
}

impl Work {
    pub(super) fn new(degrees: usize) -> Self {
        let zeros = |count: usize| vec![Eight::ZERO; count];
        let outputs = output::STOREYS + 3 * (degrees - 1);
        Self {
            input: zeros(2 * degrees + 4),
            active: zeros(2 * degrees + 4),
            state: vec![(Eight::ZERO, Eight::ZERO); degrees],
            path: zeros((NODES + 2) * degrees + NODES),
            trace: zeros(2 * NODES * degrees),
            fastest: zeros(degrees),
            values: zeros(NODES * outputs),
            ends: [zeros(outputs), zeros(outputs)],
            normal: [Eight::ZERO; 2],
            seen: Seen::default(),
            told: Told {
                work: Eight::ZERO,
                size: Eight::ZERO,
                damping: Eight::ZERO,
                friction: Eight::ZERO,
                ends: [Eight::ZERO; 2],
                least: Eight::ZERO,
                low: Eight::ZERO,
                fastest: Eight::ZERO,
            },
        }
    }
}

impl Work {
    /// Solves the steps of the unit inputs from one on.
    pub(super) fn solve_units(&mut self, bench: &Bench, phase: Phase, step_s: f64, from: usize) {
        self.input.fill(Eight::ZERO);
        for (lane, input) in self.input.iter_mut().skip(from).take(LANES).enumerate() {
            input.0[lane] = 1.0;
        }
        let group = Group { step_s: Eight([step_s; LANES]), ..Group::new(phase, 1) };
        dispatch!(Level::new(), simd => bench.solve(simd, bench.structure.masses_kg.len(), &group, None, self));
    }

    /// The path of a lane.
    pub(super) fn path(&self, lane: usize) -> Vec<f64> {
        self.path.iter().map(|all| all.0[lane]).collect()
    }

    /// `x` and `ẍ` at the nodes of a lane.
    pub(super) fn trace(&self, lane: usize) -> Vec<f64> {
        self.trace.iter().map(|all| all.0[lane]).collect()
    }
}

impl Bench<'_> {
    /// Judges a group by the maps of its step to the path, and to places, or by solving the equations of
    /// each.
    #[inline(always)]
    pub(super) fn group<S: Simd>(
        &self,
        simd: S,
        (group, maps): (&Group, Option<&[Map; 2]>),
        reach: &Reach,
        peaks: &mut Peaks<'_>,
        work: &mut Work,
        worst: &mut Worst,
    ) {
        // One storey gets loops of its own.
        match self.structure.masses_kg.len() {
            1 => self.group_of(simd, 1, (group, maps), reach, peaks, work, worst),
            n => self.group_of(simd, n, (group, maps), reach, peaks, work, worst),
        }
    }

    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // those of `group`
    fn group_of<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (group, maps): (&Group, Option<&[Map; 2]>),
        reach: &Reach,
        peaks: &mut Peaks<'_>,
        work: &mut Work,
        worst: &mut Worst,
    ) {
        let places = Places::new(group.knots);
        self.read(simd, n, group, &places, &mut work.input);
        for step in 0..group.steps {
            self.load(simd, n, group, step, work);
            match maps {
                Some([map, _]) => {
                    apply(simd, map, &work.input, &mut work.active, &mut work.path);
                }
                None => self.solve(simd, n, group, Some((&places, step)), work),
            }
            self.spend(simd, n, group, step, work);
            match group.phase {
                Phase::Stick => self.held(simd, n, step, work),
                Phase::Slip | Phase::Pressed => self.sliding(simd, n, group, step, work),
            }
            if step + 1 < group.steps {
                self.end(simd, n, (group.phase, 1), &peaks.outputs, work);
            }
            let trace = maps.map(|[_, trace]| trace);
            self.peaks(simd, n, (group, step, trace), &places, reach, peaks, work);
        }
        work.seen.tell(simd, &mut work.told);
        self.arrive(simd, n, group, &places, work, worst);
        self.sides(simd, group, &places, worst);
    }

    /// The loads of a step, and the state with which it starts after another.
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S, n: usize, group: &Group, step: usize, work: &mut Work) {
        let d = n + 1;
        let between = inlined(
            #[inline(always)]
            |[from, to]: &[Eight; 2], at: usize| {
                let (from, to) = (from.load(simd), to.load(simd));
                match at {
                    0 => from,
                    at if at == group.steps => to,
                    at => from + (to - from) * all(simd, at as f64 / group.steps as f64),
                }
            },
        );
        for end in 0..2 {
            let a = between(&group.table, step + end) + all(simd, self.slope);
            work.input[2 * d + end].store(a);
            work.input[2 * d + 2 + end].store(between(&group.force, step + end));
            work.normal[end].store(between(&group.normal, step + end));
        }
        if step > 0 {
            work.input[..2 * d].copy_from_slice(&work.path[NODES * d..(NODES + 2) * d]);
            if group.phase == Phase::Stick {
                work.input[d] = Eight::ZERO;
            }
            work.ends.swap(0, 1);
        }
    }

    /// The outputs at the start (0) or the end (1) of a step, from the equations.
    #[inline(always)]
    fn end<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (phase, end): (Phase, usize),
        outputs: &Outputs<'_>,
        work: &mut Work,
    ) {
        let d = n + 1;
        let Work { input, path, state, ends, .. } = work;
        let from = if end == 0 { 0 } else { NODES * d + 1 };
        let x = inlined(
            #[inline(always)]
            |k: usize| from_state(simd, input, path, from, k),
        );
        let v = inlined(
            #[inline(always)]
            |k: usize| from_state(simd, input, path, from, d + k),
        );
        let a = input[2 * d + end].load(simd);
        let force = match phase {
            Phase::Stick => self.demand(simd, x, v, a),
            Phase::Slip | Phase::Pressed => {
                self.sliding_force(simd, v(0), input[2 * d + 2 + end].load(simd))
            }
        };
        self.outputs(
            simd,
            n,
            (phase, outputs),
            (x, v),
            (a, force),
            state,
            #[inline(always)]
            |g, value| ends[end][g].store(value),
        );
    }

    /// Hands on the outputs of a state under loads, its rates from the equations: what cancels in them is
    /// nothing. `room` holds the rates.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // an instant
    fn outputs<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (phase, outputs): (Phase, &Outputs<'_>),
        (x, v): (impl Fn(usize) -> f64x8<S> + Copy, impl Fn(usize) -> f64x8<S> + Copy),
        (a, force): (f64x8<S>, f64x8<S>),
        room: &mut [(Eight, Eight)],
        out: impl FnMut(usize, f64x8<S>),
    ) {
        self.accelerate(
            simd,
            n,
            phase,
            (x, v),
            (a, force),
            #[inline(always)]
            |k: usize, rate: f64x8<S>| room[k].0.store(rate),
        );
        let rate = inlined(
            #[inline(always)]
            |k: usize| room[k].0.load(simd),
        );
        let slope = all(simd, self.slope);
        let (spring, damper) = (all(simd, self.structure.spring), all(simd, self.structure.damper));
        let total = rate(0) + a;
        let base = self.base_force(
            simd,
            #[inline(always)]
            |j| x(1 + j),
            #[inline(always)]
            |j| v(1 + j),
        );
        let floor = inlined(
            #[inline(always)]
            |j: usize| rate(1 + j) + total,
        );
        let slider = force - (spring * x(0) + damper * v(0));
        let moment = outputs.moment(simd, total, floor);
        let fixed = [v(0), total - slope, slider, force, base, moment, all(simd, 0.0)];
        each_output(
            simd,
            n,
            fixed,
            #[inline(always)]
            |j| [x(1 + j), floor(j) - slope],
            out,
        );
    }

    /// Raises the peaks by the paths of a step where some output may pass them.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // those of `group`
    fn peaks<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (group, step, trace): (&Group, usize, Option<&Map>),
        places: &Places,
        reach: &Reach,
        peaks: &mut Peaks<'_>,
        work: &mut Work,
    ) {
        let share = group.step_s.load(simd) * all(simd, 1.0 / reach.longest_s);
        let mut passes = 0;
        for (g, bounds) in reach.bounds {
            let mut off = all(simd, 0.0);
            for &(input, bound) in bounds {
                off += all(simd, bound) * work.input[input].load(simd).abs();
            }
            let list = &reach.knots.outputs[g * reach.knots.stride..][..reach.knots.stride];
            let [first, last] = both(
                #[inline(always)]
                |end| match step + end {
                    0 => places.read(simd, list, 0, [1, 0]),
                    at if at == group.steps => places.read(simd, list, 1, [1, 0]),
                    _ => work.ends[end][*g].load(simd),
                },
            );
            let most = larger(first.abs(), last.abs()) + share * off;
            let limit = all(simd, peaks.attained[*g] * (1.0 + 1e-12));
            passes |= most.simd_gt(limit).to_bitmask();
        }
        if reach.unknown {
            passes = (1 << LANES) - 1;
        }
        if passes != 0 {
            for end in 0..2 {
                if step + end == 0 || step + end == group.steps {
                    self.end(simd, n, (group.phase, end), &peaks.outputs, work);
                }
            }
            self.trace(simd, n, group, trace, &peaks.outputs, work);
            for (g, nodes) in work.values.chunks_exact(NODES).enumerate() {
                let ends = both(
                    #[inline(always)]
                    |end| work.ends[end][g].load(simd),
                );
                self.seek(simd, passes, ends, nodes, &mut peaks.attained[g]);
            }
        }
    }

    /// Outputs at the nodes of a step; `trace` is the map to places where the path came from a map.
    #[inline(always)]
    fn trace<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        trace: Option<&Map>,
        outputs: &Outputs<'_>,
        work: &mut Work,
    ) {
        let d = n + 1;
        let Work { input, active, path, state, trace: traced, values, .. } = work;
        if let Some(map) = trace {
            apply(simd, map, input, active, traced);
        }
        for i in 0..NODES {
            let load = inlined(
                #[inline(always)]
                |first: usize| {
                    let from = input[first].load(simd);
                    from + (input[first + 1].load(simd) - from) * all(simd, self.rule.c[i])
                },
            );
            let a = load(2 * d);
            let force = match group.phase {
                Phase::Stick => path[(NODES + 2) * d + i].load(simd),
                Phase::Slip | Phase::Pressed => {
                    self.sliding_force(simd, path[i * d].load(simd), load(2 * d + 2))
                }
            };
            let x = inlined(
                #[inline(always)]
                |k: usize| traced[i * d + k].load(simd),
            );
            let v = inlined(
                #[inline(always)]
                |k: usize| path[i * d + k].load(simd),
            );
            self.outputs(
                simd,
                n,
                (group.phase, outputs),
                (x, v),
                (a, force),
                state,
                #[inline(always)]
                |g, value| values[g * NODES + i].store(value),
            );
        }
    }

    /// Raises a peak to the largest size of an output in the lanes that may pass it, from its values at the
    /// ends and the nodes.
    #[inline(always)]
    fn seek<S: Simd>(
        &self,
        simd: S,
        passes: u64,
        ends: [f64x8<S>; 2],
        nodes: &[Eight],
        peak: &mut f64,
    ) {
        let (mut least, mut most) = (smaller(ends[0], ends[1]), larger(ends[0], ends[1]));
        for node in nodes {
            let value = node.load(simd);
            (least, most) = (smaller(least, value), larger(most, value));
        }
        let size = larger(most.abs(), least.abs());
        let sizes = size.to_array();
        for lane in (0..LANES).filter(|lane| passes & (1 << lane) != 0) {
            *peak = greatest(*peak, sizes[lane]);
        }
        // Between two points the polynomial rises above both by less than a tenth of its range.
        let bound = size + (most - least) * all(simd, 0.1);
        let open = bound.simd_gt(all(simd, *peak * (1.0 + 1e-12))).to_bitmask() & passes;
        for lane in (0..LANES).filter(|lane| open & (1 << lane) != 0) {
            let mut points = [0.0; POINTS];
            let [first, last] = ends.map(|end| end.to_array()[lane]);
            (points[0], points[POINTS - 1]) = (first, last);
            for (point, node) in points[1..].iter_mut().zip(nodes) {
                *point = node.0[lane];
            }
            raise(self.rule, peak, &points);
        }
    }

    /// `x, v`.
    #[inline(always)]
    fn read<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        places: &Places,
        input: &mut [Eight],
    ) {
        let h = self.history;
        let d = n + 1;
        input[0].store(places.read(simd, &h.sliding_displacement_m, 0, [1, 0]));
        input[d].store(match group.phase {
            Phase::Stick => all(simd, 0.0),
            _ => places.read(simd, &h.sliding_velocity_m_per_s, 0, [1, 0]),
        });
        for i in 0..n {
            input[1 + i].store(places.read(simd, &h.storey_displacement_m, 0, [n, i]));
            input[d + 1 + i].store(places.read(simd, &h.storey_velocity_m_per_s, 0, [n, i]));
        }
    }

    /// `s̈` or `q̈_i` stored at the knots of lanes, or those after them.
    #[inline(always)]
    fn stored_rate<S: Simd>(
        &self,
        simd: S,
        (n, degree): (usize, usize),
        places: &Places,
        later: usize,
    ) -> f64x8<S> {
        let h = self.history;
        let block = places.read(simd, &h.block_acceleration_m_per_s2, later, [1, 0]);
        match degree {
            0 => block - places.read(simd, &h.table_acceleration_m_per_s2, later, [1, 0]),
            i => places.read(simd, &h.storey_acceleration_m_per_s2, later, [n, i - 1]) - block,
        }
    }

    /// Solves the collocation equations of every lane by iteration, which begins with the line between
    /// the accelerations stored at the ends of the intervals, of which it is the given step.
    #[inline(always)]
    fn solve<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        stored: Option<(&Places, usize)>,
        work: &mut Work,
    ) {
        let rule = self.rule;
        let d = n + 1;
        let Work { input, state, path, trace, .. } = work;
        let (places, rates) = trace.split_at_mut(NODES * d);
        let h = group.step_s.load(simd);
        let load = inlined(
            #[inline(always)]
            |first: usize, c: f64| {
                let from = input[first].load(simd);
                from + (input[first + 1].load(simd) - from) * all(simd, c)
            },
        );
        let node = inlined(
            #[inline(always)]
            |rates: &[Eight], i: usize, k: usize| {
                let (mut dx, mut dv) = (all(simd, 0.0), all(simd, 0.0));
                for j in 0..NODES {
                    let rate = rates[j * d + k].load(simd);
                    dv += all(simd, rule.a[i][j]) * rate;
                    dx += all(simd, rule.aa[i][j]) * rate;
                }
                let (x0, v0) = (input[k].load(simd), input[d + k].load(simd));
                (x0 + h * (all(simd, rule.c[i]) * v0 + h * dx), v0 + h * dv)
            },
        );
        rates.fill(Eight::ZERO);
        if let Some((places, step)) = stored {
            for k in 0..d {
                let from = self.stored_rate(simd, (n, k), places, 0);
                let rise = self.stored_rate(simd, (n, k), places, 1) - from;
                for i in 0..NODES {
                    let part = (step as f64 + rule.c[i]) / group.steps as f64;
                    rates[i * d + k].store(from + rise * all(simd, part));
                }
            }
        }
        let linear = group.phase == Phase::Stick || self.law.rate.is_none();
        let rounding = if linear { f64::INFINITY } else { ROUNDING };
        let mut last = Eight([f64::INFINITY; LANES]);
        for pass in 0..MOST_PASSES {
            let (mut change, mut size) = (all(simd, 0.0), all(simd, 0.0));
            for i in 0..NODES {
                for (k, (x, v)) in state.iter_mut().enumerate() {
                    let (place, speed) = node(rates, i, k);
                    x.store(place);
                    v.store(speed);
                }
                let x = inlined(
                    #[inline(always)]
                    |k: usize| state[k].0.load(simd),
                );
                let v = inlined(
                    #[inline(always)]
                    |k: usize| state[k].1.load(simd),
                );
                let take = inlined(
                    #[inline(always)]
                    |k: usize, rate: f64x8<S>| {
                        let old = &mut rates[i * d + k];
                        change = larger(change, (rate - old.load(simd)).abs());
                        size = larger(size, rate.abs());
                        old.store(rate);
                    },
                );
                let force = self.sliding_force(simd, v(0), load(2 * d + 2, rule.c[i]));
                let loads = (load(2 * d, rule.c[i]), force);
                self.accelerate(simd, n, group.phase, (x, v), loads, take);
            }
            // The next pass would gain as much as this one.
            let next = change * change;
            let gained = all(simd, if pass > 0 { 0.5 * f64::EPSILON } else { -1.0 });
            let small = change.simd_le(all(simd, 2.0 * f64::EPSILON) * size)
                | next.simd_le(gained * size * last.load(simd));
            let stalled = change.simd_ge(all(simd, 0.5) * last.load(simd))
                & change.simd_le(all(simd, rounding) * size);
            if small.all_true() || (pass >= 8 && (small | stalled).all_true()) {
                break;
            }
            last.store(change);
        }
        for k in 0..d {
            let (mut dx, mut dv) = (all(simd, 0.0), all(simd, 0.0));
            for j in 0..NODES {
                let share = all(simd, rule.weights[j]) * rates[j * d + k].load(simd);
                dv += share;
                dx += share * all(simd, 1.0 - rule.c[j]);
            }
            let (x0, v0) = (input[k].load(simd), input[d + k].load(simd));
            path[NODES * d + k].store(x0 + h * (v0 + h * dx));
            path[(NODES + 1) * d + k].store(v0 + h * dv);
        }
        for i in 0..NODES {
            for (k, (x, v)) in state.iter_mut().enumerate() {
                let (place, speed) = node(rates, i, k);
                x.store(place);
                v.store(speed);
                places[i * d + k].store(place);
                path[i * d + k].store(speed);
            }
            if group.phase == Phase::Stick {
                let demand = self.demand(
                    simd,
                    |k| state[k].0.load(simd),
                    |k| state[k].1.load(simd),
                    load(2 * d, rule.c[i]),
                );
                path[(NODES + 2) * d + i].store(demand);
            }
        }
    }

    /// Hands on `ẍ` of a state under loads `a` and `T`: eqs (9), (10).
    #[inline(always)]
    fn accelerate<S: Simd>(
        &self,
        simd: S,
        n: usize,
        phase: Phase,
        (x, v): (impl Fn(usize) -> f64x8<S>, impl Fn(usize) -> f64x8<S>),
        (a, force): (f64x8<S>, f64x8<S>),
        mut take: impl FnMut(usize, f64x8<S>),
    ) {
        let s = self.structure;
        let [spring, damper] = s.slider(phase);
        let block = if phase == Phase::Stick {
            a
        } else {
            let slider = force - all(simd, damper) * v(0) - all(simd, spring) * x(0);
            let base = self.base_force(
                simd,
                #[inline(always)]
                |j| x(1 + j),
                #[inline(always)]
                |j| v(1 + j),
            );
            (slider + base) * all(simd, 1.0 / s.block_kg)
        };
        take(0, block - a);
        for k in 0..n {
            let below = if k == 0 { all(simd, 0.0) } else { x(k) };
            let mut force = all(simd, s.stiffnesses[k]) * (x(k + 1) - below);
            if k + 1 < n {
                let above = x(k + 2) - x(k + 1);
                force -= all(simd, s.stiffnesses[k + 1]) * above;
            }
            match &s.damping {
                StoreyDamping::Chain(c) => {
                    let below = if k == 0 { all(simd, 0.0) } else { v(k) };
                    force += all(simd, c[k]) * (v(k + 1) - below);
                    if k + 1 < n {
                        let above = v(k + 2) - v(k + 1);
                        force -= all(simd, c[k + 1]) * above;
                    }
                }
                StoreyDamping::Full(c) => {
                    for j in 0..n {
                        force += all(simd, c[k * n + j]) * v(1 + j);
                    }
                }
            }
            take(1 + k, -(force * all(simd, 1.0 / s.masses_kg[k])) - block);
        }
    }

    /// `T` that holds the block: eqs (8), (14).
    #[inline(always)]
    fn demand<S: Simd>(
        &self,
        simd: S,
        x: impl Fn(usize) -> f64x8<S>,
        v: impl Fn(usize) -> f64x8<S>,
        a: f64x8<S>,
    ) -> f64x8<S> {
        let s = self.structure;
        let base = self.base_force(
            simd,
            #[inline(always)]
            |j| x(1 + j),
            #[inline(always)]
            |j| v(1 + j),
        );
        all(simd, s.block_kg) * a + all(simd, s.spring) * x(0) - base
    }

    /// Work and losses, and the largest velocities.
    #[inline(always)]
    fn spend<S: Simd>(&self, simd: S, n: usize, group: &Group, step: usize, work: &mut Work) {
        let s = self.structure;
        let d = n + 1;
        let zero = all(simd, 0.0);
        let (mut done, mut size, mut damping, mut friction) = (zero, zero, zero, zero);
        let h = group.step_s.load(simd);
        let [a, a1] = both(
            #[inline(always)]
            |end| work.input[2 * d + end].load(simd),
        );
        let [force, force1] = both(
            #[inline(always)]
            |end| work.input[2 * d + 2 + end].load(simd),
        );
        if step == 0 {
            work.fastest.fill(Eight::ZERO);
            let told = &mut work.told;
            for sum in [&mut told.work, &mut told.size, &mut told.damping, &mut told.friction] {
                *sum = Eight::ZERO;
            }
        }
        for node in 0..NODES {
            let v = inlined(
                #[inline(always)]
                |k: usize| work.path[node * d + k].load(simd),
            );
            let c = all(simd, self.rule.c[node]);
            let weight = h * all(simd, self.rule.weights[node]);
            let mut momentum = all(simd, s.total_kg) * v(0);
            for (k, fastest) in work.fastest.iter_mut().enumerate() {
                let speed = v(k);
                keep(simd, fastest, speed.abs());
                if k > 0 {
                    momentum += all(simd, s.masses_kg[k - 1]) * speed;
                }
            }
            let power = momentum * (a + (a1 - a) * c);
            done -= weight * power;
            size += weight * power.abs();
            damping += weight
                * self.dissipation(
                    simd,
                    v(0),
                    #[inline(always)]
                    |j| v(1 + j),
                );
            let force = self.sliding_force(simd, v(0), force + (force1 - force) * c);
            friction -= weight * force * v(0);
        }
        let told = &mut work.told;
        told.work.store(told.work.load(simd) + done);
        told.size.store(told.size.load(simd) + size);
        told.damping.store(told.damping.load(simd) + damping);
        told.friction.store(told.friction.load(simd) + friction);
        told.fastest = work.fastest[0];
    }

    /// Compares the ends of the paths with the knots stored there.
    #[inline(always)]
    fn arrive<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        places: &Places,
        work: &Work,
        worst: &mut Worst,
    ) {
        let h = self.history;
        let d = n + 1;
        let instant = all(simd, self.instant_s);
        for i in 0..d {
            let (lists, at) = if i == 0 {
                ([&h.sliding_displacement_m, &h.sliding_velocity_m_per_s], [1, 0])
            } else {
                ([&h.storey_displacement_m, &h.storey_velocity_m_per_s], [n, i - 1])
            };
            let rates = both(
                #[inline(always)]
                |k| self.stored_rate(simd, (n, i), places, k).abs(),
            );
            let x = work.path[NODES * d + i].load(simd);
            let v = work.path[(NODES + 1) * d + i].load(simd);
            let fastest = work.fastest[i].load(simd);
            let off = (places.read(simd, lists[0], 1, at) - x).abs() - instant * fastest;
            keep(simd, &mut worst.displacement[0], off);
            let rate = larger(rates[0], rates[1]);
            let off = (places.read(simd, lists[1], 1, at) - v).abs() - instant * rate;
            keep(simd, &mut worst.velocity[0], off);
            // Between two knots the motion may be faster and go farther than at any.
            keep(simd, &mut worst.displacement[1], x.abs());
            keep(simd, &mut worst.velocity[1], fastest);
        }
        if group.phase != Phase::Stick {
            keep(simd, &mut worst.sliding, work.fastest[0].load(simd));
        }
    }

    /// Margins of the demand in stick.
    #[inline(always)]
    fn held<S: Simd>(&self, simd: S, n: usize, step: usize, work: &mut Work) {
        let d = n + 1;
        let Work { input, path, normal, seen, .. } = work;
        let [normal, normal1] = both(
            #[inline(always)]
            |end| normal[end].load(simd),
        );
        let one = all(simd, 1.0);
        let [positive, negative] = self.law.fixed().map(|mu| all(simd, mu));
        // Too large a `T` slides the block towards −x.
        let margin = inlined(
            #[inline(always)]
            |demand: f64x8<S>, c: f64| {
                let mu = demand.simd_gt(all(simd, 0.0)).select(negative, positive);
                let bound = mu * (normal + (normal1 - normal) * all(simd, c));
                one - demand.abs() / bound
            },
        );
        let of = inlined(
            #[inline(always)]
            |from: usize, a: usize| {
                self.demand(
                    simd,
                    #[inline(always)]
                    |k| from_state(simd, input, path, from, k),
                    #[inline(always)]
                    |k| from_state(simd, input, path, from, d + k),
                    input[2 * d + a].load(simd),
                )
            },
        );
        if step == 0 {
            seen.start(margin(of(0, 0), 0.0));
        }
        for (i, demand) in path[(NODES + 2) * d..].iter().enumerate() {
            seen.take(simd, margin(demand.load(simd), self.rule.c[i]));
        }
        seen.take(simd, margin(of(NODES * d + 1, 1), 1.0));
    }

    /// Speeds in the direction of a slip.
    #[inline(always)]
    fn sliding<S: Simd>(&self, simd: S, n: usize, group: &Group, step: usize, work: &mut Work) {
        let d = n + 1;
        let Work { input, path, seen, .. } = work;
        let sign = group.sign.load(simd);
        if step == 0 {
            seen.start(sign * input[d].load(simd));
        }
        for i in 0..NODES {
            seen.take(simd, sign * path[i * d].load(simd));
        }
        seen.take(simd, sign * path[(NODES + 1) * d].load(simd));
    }

    /// Compares the stored table accelerations and forces of sliding at both ends with the loads.
    #[inline(always)]
    fn sides<S: Simd>(&self, simd: S, group: &Group, places: &Places, worst: &mut Worst) {
        let h = self.history;
        let blur = all(simd, self.instant_s) * group.drift.load(simd).abs();
        for end in 0..2 {
            let table = places.read(simd, &h.table_acceleration_m_per_s2, end, [1, 0]);
            keep(simd, &mut worst.table, (group.table[end].load(simd) - table).abs() - blur);
            if group.phase != Phase::Stick {
                let force = places.read(simd, &h.friction_force_n, end, [1, 0]);
                let w = places.read(simd, &h.sliding_velocity_m_per_s, end, [1, 0]);
                let own = self.sliding_force(simd, w, group.force[end].load(simd));
                keep(simd, &mut worst.excess, (force - own).abs());
            }
        }
    }
}

/// An entry of the state at the start of a path (0) or at its end.
#[inline(always)]
fn from_state<S: Simd>(
    simd: S,
    input: &[Eight],
    path: &[Eight],
    from: usize,
    entry: usize,
) -> f64x8<S> {
    match from.checked_sub(1) {
        None => input[entry].load(simd),
        Some(end) => path[end + entry].load(simd),
    }
}

/// What the points of intervals say of a margin or a speed, one after another.
#[derive(Default)]
struct Seen {
    first: Eight,
    least: Eight,
    most: Eight,
    last: Eight,
    /// 1 where it has risen, and fallen.
    rises: Eight,
    falls: Eight,
}

impl Seen {
    #[inline(always)]
    fn start<S: Simd>(&mut self, first: f64x8<S>) {
        for place in [&mut self.first, &mut self.least, &mut self.most, &mut self.last] {
            place.store(first);
        }
        (self.rises, self.falls) = (Eight::ZERO, Eight::ZERO);
    }

    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, value: f64x8<S>) {
        let (one, last) = (all(simd, 1.0), self.last.load(simd));
        self.least.store(smaller(self.least.load(simd), value));
        self.most.store(larger(self.most.load(simd), value));
        self.rises.store(value.simd_gt(last).select(one, self.rises.load(simd)));
        self.falls.store(value.simd_lt(last).select(one, self.falls.load(simd)));
        self.last.store(value);
    }

    /// The least, and what it cannot fall below in between.
    #[inline(always)]
    fn tell<S: Simd>(&self, simd: S, told: &mut Told<Eight>) {
        let least = self.least.load(simd);
        let range = self.most.load(simd) - least;
        let flat = range.simd_le(all(simd, 4e-12));
        // Between two points the polynomial falls below both by less than a tenth of its range.
        let low = (self.rises.load(simd) * self.falls.load(simd))
            .simd_gt(all(simd, 0.0))
            .select(least - range * all(simd, 0.1), all(simd, f64::INFINITY));
        told.low.store(flat.select(least, low));
        (told.least, told.ends) = (self.least, [self.first, self.last]);
    }
}

/// What a map makes of the inputs of every lane.
#[inline(always)]
fn apply<S: Simd>(simd: S, map: &Map, input: &[Eight], active: &mut [Eight], path: &mut [Eight]) {
    let count = map.inputs.len();
    for (active, &j) in active.iter_mut().zip(&map.inputs) {
        *active = input[j];
    }
    for &row in &map.blank {
        path[row] = Eight::ZERO;
    }
    for (&row, entries) in map.rows.iter().zip(map.entries.chunks_exact(count)) {
        let mut sum = all(simd, 0.0);
        for (&c, input) in entries.iter().zip(active.iter()) {
            sum += all(simd, c) * input.load(simd);
        }
        path[row].store(sum);
    }
}
