//! The knots by themselves: the balance of forces, energies, outputs.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::collocation::Rule;
use super::super::judge::Figures;
use super::super::lane::{Eight, LANES, Places, add_chain, all, chain_form, inlined, keep, larger};
use super::super::law::Law;
use super::super::outputs::Outputs;
use super::super::structure::{StoreyDamping, Structure, larger as greatest};
use crate::error::Stopped;
use crate::numerics::InstructionSet;
use crate::progress::Pulse;
use crate::response::{History, Mode};

/// Knots whose outputs and states are bounded together.
pub(super) const BATCH: usize = 64;

/// The worst of all lanes so far.
#[derive(Default)]
pub(super) struct Worst {
    pub(super) displacement: [Eight; 2],
    pub(super) velocity: [Eight; 2],
    pub(super) force: [Eight; 2],
    pub(super) table: Eight,
    pub(super) excess: Eight,
    pub(super) sliding: Eight,
    /// What the rounding of `N` makes of places and velocities in an interval.
    pub(super) drift: [Eight; 2],
    /// 0, or not a number where something stored is none.
    pub(super) broken: Eight,
}

impl Worst {
    /// Adds it to the figures.
    pub(super) fn enter(&self, figures: &mut Figures) {
        for (figure, lanes) in [
            (&mut figures.displacement, &self.displacement),
            (&mut figures.velocity, &self.velocity),
            (&mut figures.force, &self.force),
        ] {
            *figure = [0, 1].map(|i| greatest(figure[i], lanes[i].largest()));
        }
        figures.table[0] = greatest(figures.table[0], self.table.largest());
        figures.excess = greatest(figures.excess, self.excess.largest());
    }
}

/// What the lanes need of a model and its history.
pub(super) struct LaneJudge<'a> {
    pub(super) structure: &'a Structure,
    pub(super) rule: &'static Rule,
    pub(super) history: &'a History,
    pub(super) law: &'a Law,
    /// `g sin θ`.
    pub(super) slope: f64,
    pub(super) instant_s: f64,
    /// Whether the normal force varies.
    pub(super) vertical: bool,
    pub(super) instructions: InstructionSet,
}

/// What else there is to know of knots.
#[derive(Clone, Copy)]
pub(super) struct Acting<'a> {
    /// Force of the block on an elastic stop; empty without.
    pub(super) stop: &'a [f64],
    /// 1 where more than friction, spring and stop acts on the block; empty where it never does.
    pub(super) held: &'a [f64],
    /// Knots that the motion passes in no time, in order: they are no peaks.
    pub(super) passed: &'a [usize],
}

/// Displacements and velocities of a degree of a structure of `n` storeys, and its place in what is stored at a
/// knot.
#[inline(always)]
pub(super) fn lists_of(h: &History, n: usize, degree: usize) -> ([&[f64]; 2], [usize; 2]) {
    match degree {
        0 => ([&h.sliding_displacement_m, &h.sliding_velocity_m_per_s], [1, 0]),
        i if i <= n => ([&h.storey_displacement_m, &h.storey_velocity_m_per_s], [n, i - 1]),
        i => {
            let lists = [&h.contents_displacement_m[..], &h.contents_velocity_m_per_s];
            (lists, [h.interfaces - 1, i - 1 - n])
        }
    }
}

/// Accelerations of a degree's body and of what it moves over, whose difference is `ẍ`, likewise.
#[inline(always)]
pub(super) fn rates_of<'h>(
    h: &'h History,
    structure: &Structure,
    n: usize,
    degree: usize,
) -> [(&'h [f64], [usize; 2]); 2] {
    let floor = inlined!(|floor: usize| match floor {
        0 => (&h.block_acceleration_m_per_s2[..], [1, 0]),
        i => (&h.storey_acceleration_m_per_s2[..], [n, i - 1]),
    });
    match degree {
        0 => [floor(0), (&h.table_acceleration_m_per_s2, [1, 0])],
        i if i <= n => [floor(i), floor(0)],
        i => {
            let (e, contents) = (i - 1 - n, &structure.contents);
            let own = &h.contents_acceleration_m_per_s2[..];
            [(own, [contents.len(), e]), floor(contents[e].floor)]
        }
    }
}

/// What one look at the knots tells.
#[derive(Default)]
pub(super) struct Knots {
    pub(super) kinetic_j: Vec<f64>,
    pub(super) strain_j: Vec<f64>,
    /// Largest sizes of the outputs, of `x`, `v`, `Ü`, `M⁻¹ K q` and `M⁻¹ K q̇`, batch after batch.
    batches: Vec<f64>,
    outputs: usize,
    width: usize,
}

impl Knots {
    pub(super) fn new(knots: usize, outputs: usize, [degrees, storeys]: [usize; 2]) -> Self {
        let stride = knots.next_multiple_of(LANES);
        let (batches, kinetic_j, strain_j) = (Vec::new(), vec![0.0; stride], vec![0.0; stride]);
        Self {
            kinetic_j,
            strain_j,
            batches,
            outputs,
            width: outputs + 2 * degrees + 1 + 2 * storeys,
        }
    }

    /// Largest sizes of the outputs, then of `x`, `v`, `Ü`, `M⁻¹ K q` and `M⁻¹ K q̇`, in every batch.
    pub(super) fn batches(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        self.batches.chunks_exact(self.width).map(|batch| batch.split_at(self.outputs))
    }

    /// The same in all.
    pub(super) fn largest(&self) -> (Vec<f64>, Vec<f64>) {
        let mut largest = vec![0.0_f64; self.width];
        for batch in self.batches.chunks_exact(self.width) {
            for (largest, size) in largest.iter_mut().zip(batch) {
                *largest = largest.max(*size);
            }
        }
        let sizes = largest.split_off(self.outputs);
        (largest, sizes)
    }
}

/// Work space of lanes, by storey and by item of contents.
struct Bodies {
    q: Vec<Eight>,
    v: Vec<Eight>,
    a: Vec<Eight>,
    elastic: Vec<Eight>,
    viscous: Vec<Eight>,
    /// Velocity and acceleration of contents.
    carried: Vec<[Eight; 2]>,
}

impl Bodies {
    fn new(n: usize, contents: usize) -> Self {
        let list = || vec![Eight::ZERO; n];
        let carried = vec![[Eight::ZERO; 2]; contents];
        Self { q: list(), v: list(), a: list(), elastic: list(), viscous: list(), carried }
    }
}

impl LaneJudge<'_> {
    /// `C1 ṡ² + q̇ᵀ C q̇`.
    #[inline(always)]
    pub(super) fn dissipation<S: Simd>(
        &self,
        simd: S,
        w: f64x8<S>,
        v: impl Fn(usize) -> f64x8<S>,
    ) -> f64x8<S> {
        let s = self.structure;
        let storeys = match &s.damping {
            StoreyDamping::Chain(c) => chain_form(simd, (c, s.on_block), v),
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

    /// `1ᵀ (C q̇ + K q)`.
    #[inline(always)]
    pub(super) fn base_force<S: Simd>(
        &self,
        simd: S,
        q: impl Fn(usize) -> f64x8<S>,
        v: impl Fn(usize) -> f64x8<S>,
    ) -> f64x8<S> {
        let s = self.structure;
        let Some(&k) = s.stiffnesses.first() else { return all(simd, 0.0) };
        let mut sum = all(simd, k) * q(0);
        if s.on_block {
            for (j, &k) in s.stiffnesses.iter().enumerate().skip(1) {
                sum += all(simd, k) * q(j);
            }
        }
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
        acting: Acting<'_>,
        (knots, pulse): (&mut Knots, &mut Pulse<'_>),
    ) -> Result<(), Stopped> {
        let count = self.structure.masses_kg.len();
        let mut bodies = Bodies::new(count, self.structure.contents.len());
        let mut largest = vec![Eight::ZERO; knots.width];
        let last = self.history.len() - 1;
        for from in (0..=last).step_by(LANES) {
            pulse.beat(16 * self.structure.degrees() as u32)?;
            let places = Places::new(core::array::from_fn(|lane| (from + lane).min(last)));
            // One storey gets loops of its own.
            let (n, at) = (count, (from, &places));
            let to = (&mut *knots, &mut bodies, &mut largest[..]);
            if n == 1 {
                self.eight_knots(simd, 1, at, acting, outputs, worst, to);
            } else {
                self.eight_knots(simd, n, at, acting, outputs, worst, to);
            }
            if (from + LANES).is_multiple_of(BATCH) || from + LANES > last {
                knots.batches.extend(largest.iter().map(Eight::largest));
                largest.fill(Eight::ZERO);
            }
        }
        Ok(())
    }

    /// 1 in the lanes where an interface sticks at its knot, else 0.
    #[inline(always)]
    fn stuck<S: Simd>(&self, simd: S, places: &Places, interface: usize) -> f64x8<S> {
        let h = self.history;
        let one = |lane: usize| {
            let mode = h.mode[places.knot(lane) * h.interfaces + interface];
            if mode == Mode::Stick { 1.0 } else { 0.0 }
        };
        f64x8::load_array(simd, core::array::from_fn(one))
    }

    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // one loop's body
    fn eight_knots<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (from, places): (usize, &Places),
        acting: Acting<'_>,
        outputs: &Outputs,
        worst: &mut Worst,
        (knots, bodies, largest): (&mut Knots, &mut Bodies, &mut [Eight]),
    ) {
        let (h, structure) = (self.history, self.structure);
        let zero = all(simd, 0.0);
        let slope = all(simd, self.slope);
        let one = inlined!(|list: &[f64]| places.read(simd, list, 0, [1, 0]));
        let s = one(&h.sliding_displacement_m);
        let w = one(&h.sliding_velocity_m_per_s);
        let block = one(&h.block_acceleration_m_per_s2);
        let table = one(&h.table_acceleration_m_per_s2);
        let force = one(&h.friction_force_n);
        let Acting { stop, held, passed } = acting;
        let stop = if stop.is_empty() { zero } else { one(stop) };
        let first = passed.partition_point(|&k| k < from);
        let passes = passed.get(first).is_some_and(|&k| k < from + LANES);
        let lasts = |lane: usize| if passed.contains(&(from + lane)) { 0.0 } else { 1.0 };
        let lasts = f64x8::load_array(
            simd,
            core::array::from_fn(|lane| if passes { lasts(lane) } else { 1.0 }),
        );
        let mut sum = s + w + block + table + force;
        let d = structure.degrees();
        let (attained, sizes) = largest.split_at_mut(outputs.len());
        keep(simd, &mut sizes[0], s.abs());
        keep(simd, &mut sizes[d], w.abs());
        keep(simd, &mut sizes[2 * d], table.abs());
        for i in 0..n {
            let of = inlined!(|list: &[f64]| places.read(simd, list, 0, [n, i]));
            let (q, v) = (of(&h.storey_displacement_m), of(&h.storey_velocity_m_per_s));
            let a = of(&h.storey_acceleration_m_per_s2);
            sum += q + v + a;
            keep(simd, &mut sizes[1 + i], q.abs());
            keep(simd, &mut sizes[d + 1 + i], v.abs());
            bodies.q[i].store(q);
            bodies.v[i].store(v);
            bodies.a[i].store(a);
            bodies.elastic[i] = Eight::ZERO;
            bodies.viscous[i] = Eight::ZERO;
        }
        // Eqs (9), (10): the largest defect and the largest single term.
        let mut term = add_chain(simd, n, structure.springs(), &bodies.q, &mut bodies.elastic);
        let Bodies { v, elastic, viscous, .. } = &mut *bodies;
        for (first, forces) in [(2 * d + 1, &mut *elastic), (2 * d + 1 + n, &mut *viscous)] {
            if first > 2 * d + 1 {
                add_chain(simd, n, structure.springs(), v, forces);
            }
            for (i, force) in forces.iter_mut().enumerate() {
                let per_kg = all(simd, 1.0 / structure.masses_kg[i]);
                keep(simd, &mut sizes[first + i], (force.load(simd) * per_kg).abs());
            }
        }
        viscous.fill(Eight::ZERO);
        match &structure.damping {
            StoreyDamping::Chain(c) => {
                term = larger(
                    term,
                    add_chain(simd, n, (c, structure.on_block), &bodies.v, &mut bodies.viscous),
                );
            }
            StoreyDamping::Full(c) => {
                for i in 0..n {
                    let mut row = zero;
                    for j in 0..n {
                        let share = all(simd, c[i * n + j]) * bodies.v[j].load(simd);
                        term = larger(term, share.abs());
                        row += share;
                    }
                    bodies.viscous[i].store(row);
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
        let stuck = self.stuck(simd, places, 0);
        // Contents pull at their floors with their inertia, whether they slide or not.
        for (e, contents) in structure.contents.iter().enumerate() {
            let of =
                inlined!(|list: &[f64]| places.read(simd, list, 0, [structure.contents.len(), e]));
            let p = of(&h.contents_velocity_m_per_s);
            let (r, a) = (of(&h.contents_displacement_m), of(&h.contents_acceleration_m_per_s2));
            sum += r + p + a;
            keep(simd, &mut sizes[1 + n + e], r.abs());
            keep(simd, &mut sizes[d + 1 + n + e], p.abs());
            let mass = all(simd, contents.mass_kg);
            let inertia = mass * (a + slope);
            balance += inertia;
            term = larger(term, inertia.abs());
            let (mut speed, mut under) = (w + p, block);
            if let Some(i) = contents.floor.checked_sub(1) {
                let pull = bodies.viscous[i].load(simd) + inertia;
                bodies.viscous[i].store(pull);
                speed += bodies.v[i].load(simd);
                under = bodies.a[i].load(simd);
            }
            kinetic += mass * speed * speed;
            let at_rest = self.stuck(simd, places, 1 + e);
            defect = larger(defect, (mass * (a - under) * at_rest).abs());
            keep(simd, &mut worst.velocity[0], (p * at_rest).abs());
            bodies.carried[e][0].store(p);
            bodies.carried[e][1].store(a);
        }
        worst.broken.store(worst.broken.load(simd) + sum * zero);
        for i in 0..n {
            let mass = all(simd, structure.masses_kg[i]);
            let inertia = mass * (bodies.a[i].load(simd) + slope);
            balance += inertia;
            let floor = inertia + bodies.viscous[i].load(simd) + bodies.elastic[i].load(simd);
            defect = larger(defect, floor.abs());
            term = larger(term, inertia.abs());
            let speed = w + bodies.v[i].load(simd);
            kinetic += mass * speed * speed;
        }
        for single in [spring, damper, inertia, force, stop] {
            term = larger(term, single.abs());
        }
        if !held.is_empty() {
            balance *= all(simd, 1.0) - one(held);
        }
        let split = all(simd, structure.block_kg) * (block - table);
        defect = larger(larger(defect, balance.abs()), (split * stuck).abs());
        keep(simd, &mut worst.force[0], defect);
        keep(simd, &mut worst.force[1], term);
        keep(simd, &mut worst.velocity[0], (w * stuck).abs());
        let half = all(simd, 0.5);
        let form =
            chain_form(simd, structure.springs(), inlined!(|i: usize| bodies.q[i].load(simd)));
        let strain = half * (spring * s + form);
        let out = inlined!(|g: usize, value: f64x8<S>| {
            keep(simd, &mut attained[g], value.abs() * lasts);
        });
        let base = self.base_force(
            simd,
            inlined!(|i: usize| bodies.q[i].load(simd)),
            inlined!(|i: usize| bodies.v[i].load(simd)),
        );
        // Where more acts on the block the slider's force is not known from what is stored.
        let mut slider = force - (spring + damper) - stop;
        if !held.is_empty() {
            slider *= all(simd, 1.0) - one(held);
        }
        outputs.each(
            [w, slider, force, base, stop],
            (self.slope, total),
            inlined!(|i: usize| {
                let q = inlined!(|j: usize| bodies.q[j].load(simd));
                let a = inlined!(|j: usize| bodies.a[j].load(simd) + slope);
                outputs.point(i, total, q, a)
            }),
            inlined!(|e: usize| {
                let [velocity, acceleration] = &bodies.carried[e];
                [velocity.load(simd), acceleration.load(simd) + slope]
            }),
            out,
        );
        knots.kinetic_j[from..from + LANES].copy_from_slice(&(half * kinetic).to_array());
        knots.strain_j[from..from + LANES].copy_from_slice(&strain.to_array());
    }
}
