//! Masses, springs and dampers as the equations of motion need them.
//!
//! The matrices are assembled here from the model alone. Letters as in the book: `x = (s, q, r)`
//! and `v = (ṡ, q̇, ṙ)` have one entry for the block, one a storey and one an item of contents; `B` is the block's total
//! acceleration with the slope, `s̈ + a`.

use super::collocation::{Column, add, combined, most};
use super::damping::modal_damping;
use crate::model::{Contents, Damping, Model, StopKind};

/// Which equations hold: the block rests on the table, or slides over it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    Stick,
    Slip,
    /// Sliding against the stop, which is one more spring and damper.
    Pressed,
}

/// Damping matrix `C` of the storeys, relative to the block.
pub(super) enum StoreyDamping {
    /// Dampers between neighbouring floors, from the block up.
    Chain(Vec<f64>),
    /// Rows of a full matrix.
    Full(Vec<f64>),
}

/// The mechanical part of a model.
pub(super) struct Structure {
    pub(super) block_kg: f64,
    pub(super) total_kg: f64,
    pub(super) masses_kg: Vec<f64>,
    /// Whether each of them stands on the block, as the oscillators of modes do, not on the one below.
    pub(super) on_block: bool,
    /// What moves with each degree: the momentum is their sum with the velocities.
    pub(super) moved_kg: Vec<f64>,
    pub(super) spring: f64,
    pub(super) damper: f64,
    /// Stiffness and damper of the stop.
    stop: [f64; 2],
    pub(super) stiffnesses: Vec<f64>,
    pub(super) damping: StoreyDamping,
    /// `1ᵀ C`: what the storeys' dampers pass on to the block.
    pub(super) base_damping: Vec<f64>,
    /// What slides on the floors.
    pub(super) contents: Vec<Contents>,
}

impl Structure {
    /// The spring of a pendulum that follows `N` is no part of it.
    pub(super) fn new(model: &Model, vertical: bool) -> Self {
        let frame = model.frame();
        Self::of(model, (&frame.stiffnesses_n_per_m, &frame.damping), vertical)
    }

    /// The structure of a model with these stiffnesses and this damping of its storeys.
    pub(super) fn of(model: &Model, (k, damping): (&[f64], &Damping), vertical: bool) -> Self {
        let m = &model.frame().masses_kg;
        let (n, on_block) = (m.len(), model.structure().is_some());
        let (damping, base_damping) = match damping {
            Damping::Dampers(c) if on_block => (StoreyDamping::Chain(c.clone()), c.clone()),
            Damping::Dampers(c) => {
                let mut base = vec![0.0; n];
                base[..n.min(1)].copy_from_slice(&c[..n.min(1)]);
                (StoreyDamping::Chain(c.clone()), base)
            }
            Damping::Ratio(ratio) if *ratio == 0.0 || n == 0 => {
                (StoreyDamping::Chain(vec![0.0; n]), vec![0.0; n])
            }
            Damping::Ratio(ratio) => {
                let full = modal_damping(m, k, *ratio);
                let base = (0..n).map(|j| (0..n).map(|i| full[i * n + j]).sum()).collect();
                (StoreyDamping::Full(full), base)
            }
        };
        let contents = model.contents();
        let on =
            |floor: usize| contents.iter().filter(move |c| c.floor == floor).map(|c| c.mass_kg);
        let floors = (0..n).map(|i| m[i] + on(1 + i).sum::<f64>());
        let moved_kg = core::iter::once(model.total_mass_kg())
            .chain(floors)
            .chain(contents.iter().map(|c| c.mass_kg))
            .collect();
        Self {
            moved_kg,
            block_kg: model.block().mass_kg,
            total_kg: model.total_mass_kg(),
            masses_kg: m.clone(),
            on_block,
            spring: match model.slider().pendulum_radius_m(vertical).filter(|_| vertical) {
                Some(_) => 0.0,
                None => model.slider_stiffness_n_per_m(),
            },
            damper: model.slider().damper_n_s_per_m,
            stop: model.stop().map_or([0.0; 2], |stop| match stop.kind {
                StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => {
                    [stiffness_n_per_m, damper_n_s_per_m]
                }
                StopKind::Rigid { .. } => [0.0; 2],
            }),
            stiffnesses: k.to_vec(),
            damping,
            base_damping,
            contents: contents.to_vec(),
        }
    }

    /// Entries of `x` and of `v`: the block, the storeys, the contents.
    pub(super) fn degrees(&self) -> usize {
        1 + self.masses_kg.len() + self.contents.len()
    }

    /// Place of an interface's sliding in `x` and `v`.
    pub(super) fn degree_of(&self, interface: usize) -> usize {
        if interface == 0 { 0 } else { self.masses_kg.len() + interface }
    }

    /// The least mass of the block and the floors.
    pub(super) fn least_kg(&self) -> f64 {
        self.masses_kg.iter().fold(self.block_kg, |least, mass| mass.min(least))
    }

    /// Spring and damper between table and block in a phase.
    pub(super) fn slider(&self, phase: Phase) -> [f64; 2] {
        match phase {
            Phase::Stick | Phase::Slip => [self.spring, self.damper],
            Phase::Pressed => [self.spring + self.stop[0], self.damper + self.stop[1]],
        }
    }

    /// Damper of the stop in N s/m.
    pub(super) fn stop_damper(&self) -> f64 {
        self.stop[1]
    }

    /// Upper bound on the largest undamped frequency on a block that rests, in rad/s.
    pub(super) fn frame_frequency(&self) -> f64 {
        let m = &self.masses_kg;
        let rows = self.floor_rows(&self.stiffnesses);
        libm::sqrt(rows.zip(m).map(|(row, m)| row / m).fold(0.0, f64::max))
    }

    /// Upper bound on the fastest rate (frequency or decay) of a phase, in 1/s.
    ///
    /// By Gershgorin's rows in absolute coordinates `ω² ≤ max Σ_j |K_ij| / m_i`, and likewise for
    /// `C`; and an eigenvalue of `λ² + c λ + k` with `c ≤ c_max`, `k ≤ ω²` is at most
    /// `max(ω, c_max)` in size. Holding the block only lowers both.
    pub(super) fn rate(&self, phase: Phase) -> f64 {
        let m = &self.masses_kg;
        let (storey_damping, base): (Vec<f64>, f64) = match &self.damping {
            StoreyDamping::Chain(c) => (self.floor_rows(c).collect(), self.base_row(c)),
            StoreyDamping::Full(c) => {
                let rows = c.chunks_exact(m.len()).zip(&self.base_damping);
                let rows = rows.map(|(row, b)| row.iter().map(|c| c.abs()).sum::<f64>() + b.abs());
                (rows.collect(), 2.0 * self.base_damping.iter().map(|b| b.abs()).sum::<f64>())
            }
        };
        let mut frequency = self.frame_frequency();
        let mut decay = storey_damping.iter().zip(m).map(|(row, m)| row / m).fold(0.0, f64::max);
        if phase != Phase::Stick {
            let [spring, damper] = self.slider(phase);
            let stiffness = spring + self.base_row(&self.stiffnesses);
            frequency = frequency.max(libm::sqrt(stiffness / self.block_kg));
            decay = decay.max((damper + base) / self.block_kg);
        }
        frequency.max(decay)
    }

    /// Sums of the sizes in each floor's row of a chain's matrix, the block's column included.
    fn floor_rows<'a>(&self, chain: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let above = chain.iter().skip(1).chain(core::iter::once(&0.0));
        let share = if self.on_block { 0.0 } else { 1.0 };
        chain.iter().zip(above).map(move |(below, above)| 2.0 * (below + share * above))
    }

    /// Sum of the sizes in the block's row of a chain's matrix.
    fn base_row(&self, chain: &[f64]) -> f64 {
        let on_block = if self.on_block { chain.len() } else { 1 };
        2.0 * chain.iter().take(on_block).sum::<f64>()
    }

    /// Adds `K q` floor by floor; returns the largest single term.
    #[inline(always)]
    pub(super) fn add_elastic<const N: usize>(&self, q: &[Column<N>], to: &mut [Column<N>]) -> f64 {
        self.add_chain(&self.stiffnesses, q, to)
    }

    /// Adds `C q̇` floor by floor; returns the largest single term.
    #[inline(always)]
    pub(super) fn add_viscous<const N: usize>(&self, v: &[Column<N>], to: &mut [Column<N>]) -> f64 {
        let rows = match &self.damping {
            StoreyDamping::Chain(c) => return self.add_chain(c, v, to),
            StoreyDamping::Full(rows) => rows.chunks_exact(v.len()),
        };
        let mut term = 0.0_f64;
        for (to, row) in to.iter_mut().zip(rows) {
            add(to, 1.0, &combined(v, row));
            term = row.iter().zip(v).fold(term, |term, (c, v)| term.max(c.abs() * most(v)));
        }
        term
    }

    /// Adds the forces of springs or dampers between neighbouring floors, or to the block; returns the largest term.
    #[inline(always)]
    fn add_chain<const N: usize>(
        &self,
        chain: &[f64],
        x: &[Column<N>],
        to: &mut [Column<N>],
    ) -> f64 {
        let (mut below, mut term) = ([0.0; N], 0.0_f64);
        for (i, (c, here)) in chain.iter().zip(x).enumerate() {
            let mut over = *here;
            add(&mut over, -1.0, &below);
            add(&mut to[i], *c, &over);
            if i > 0 && !self.on_block {
                add(&mut to[i - 1], -c, &over);
            }
            term = term.max(c * most(here).max(most(&below)));
            if !self.on_block {
                below = *here;
            }
        }
        term
    }

    /// `1ᵀ (K q + C q̇)`, with which the storeys act on the block.
    #[inline(always)]
    pub(super) fn base_shear<const N: usize>(&self, q: &[Column<N>], v: &[Column<N>]) -> Column<N> {
        let mut sum = [0.0; N];
        let on_block = if self.on_block { q.len() } else { 1 };
        for (k, q) in self.stiffnesses.iter().zip(q).take(on_block) {
            add(&mut sum, *k, q);
        }
        for (c, v) in self.base_damping.iter().zip(v) {
            add(&mut sum, *c, v);
        }
        sum
    }

    /// `qᵀ K q`, by drifts.
    pub(super) fn elastic_form(&self, q: &[Column<1>]) -> f64 {
        let (mut below, mut sum) = (0.0, 0.0);
        for (k, [here]) in self.stiffnesses.iter().zip(q) {
            sum += k * (here - below) * (here - below);
            if !self.on_block {
                below = *here;
            }
        }
        sum
    }
}

/// The larger in size; not a number wins.
pub(super) fn larger(worst: f64, value: f64) -> f64 {
    let value = value.abs();
    if value <= worst {
        worst
    } else if value.is_nan() {
        f64::INFINITY
    } else {
        value
    }
}

/// The part of a value above 0; infinite where it is not a number.
pub(super) fn excess(beyond: f64) -> f64 {
    if beyond <= 0.0 { 0.0 } else { larger(0.0, beyond) }
}
