//! Masses, springs and dampers as the equations of motion need them.
//!
//! The matrices are assembled here from the model alone. Letters as in the book: `x = (s, q)` and
//! `v = (ṡ, q̇)` have one entry for the block and one a storey; `B` is the block's total
//! acceleration with the slope, `s̈ + a`.

use super::damping::modal_damping;
use crate::model::{Damping, Model, StopKind};

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
    pub(super) spring: f64,
    pub(super) damper: f64,
    /// Stiffness and damper of the stop.
    stop: [f64; 2],
    pub(super) stiffnesses: Vec<f64>,
    pub(super) damping: StoreyDamping,
    /// `1ᵀ C`: what the storeys' dampers pass on to the block.
    pub(super) base_damping: Vec<f64>,
}

impl Structure {
    pub(super) fn new(model: &Model) -> Self {
        let frame = model.frame();
        let (m, k) = (&frame.masses_kg, &frame.stiffnesses_n_per_m);
        let n = m.len();
        let (damping, base_damping) = match &frame.damping {
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
        Self {
            block_kg: model.block().mass_kg,
            total_kg: model.total_mass_kg(),
            masses_kg: m.clone(),
            spring: model.slider_stiffness_n_per_m(),
            damper: model.slider().damper_n_s_per_m,
            stop: model.stop().map_or([0.0; 2], |stop| match stop.kind {
                StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => {
                    [stiffness_n_per_m, damper_n_s_per_m]
                }
                StopKind::Rigid { .. } => [0.0; 2],
            }),
            stiffnesses: k.clone(),
            damping,
            base_damping,
        }
    }

    /// Entries of `x` and of `v`: the block and the storeys.
    pub(super) fn degrees(&self) -> usize {
        self.masses_kg.len() + 1
    }

    /// Adds `K q` to `out`.
    pub(super) fn add_elastic(&self, q: &[f64], out: &mut [f64]) {
        add_chain(&self.stiffnesses, q, out);
    }

    /// Adds `C q̇` to `out`.
    pub(super) fn add_viscous(&self, rates: &[f64], out: &mut [f64]) {
        match &self.damping {
            StoreyDamping::Chain(c) => add_chain(c, rates, out),
            StoreyDamping::Full(c) => {
                for (row, o) in c.chunks_exact(rates.len()).zip(out) {
                    *o += dot(row, rates);
                }
            }
        }
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

    /// `K1 s + C1 ṡ`.
    pub(super) fn slider_force(&self, s: f64, w: f64) -> f64 {
        self.spring * s + self.damper * w
    }

    /// `1ᵀ (C q̇ + K q)`: the force of the lowest storey on the block.
    pub(super) fn base_force(&self, q: &[f64], rates: &[f64]) -> f64 {
        let elastic = if q.is_empty() { 0.0 } else { self.stiffnesses[0] * q[0] };
        elastic + dot(&self.base_damping, rates)
    }

    /// The force `T` that keeps the block at rest on a table whose acceleration is `a` (with the
    /// slope's share): eqs (8), (14).
    pub(super) fn demand(&self, x: &[f64], v: &[f64], a: f64) -> f64 {
        self.block_kg * a + self.spring * x[0] - self.base_force(&x[1..], &v[1..])
    }

    /// `ẍ` from eqs (9)–(12); in stick `force` is not used. Against the stop it is `T` with what the
    /// stop's spring would give back at `s = 0`.
    pub(super) fn accelerate(
        &self,
        phase: Phase,
        (x, v): (&[f64], &[f64]),
        (a, force): (f64, f64),
        out: &mut [f64],
    ) {
        let (q, rates) = (&x[1..], &v[1..]);
        let block = match phase {
            Phase::Stick => a,
            Phase::Slip | Phase::Pressed => {
                let [spring, damper] = self.slider(phase);
                let slider = force - damper * v[0] - spring * x[0];
                (slider + self.base_force(q, rates)) / self.block_kg
            }
        };
        out.fill(0.0);
        self.add_elastic(q, &mut out[1..]);
        self.add_viscous(rates, &mut out[1..]);
        for (o, m) in out[1..].iter_mut().zip(&self.masses_kg) {
            *o = -*o / m - block;
        }
        out[0] = block - a;
    }

    /// `M1 ṡ + Σ m_i (ṡ + q̇_i)`.
    pub(super) fn momentum(&self, v: &[f64]) -> f64 {
        self.total_kg * v[0] + dot(&self.masses_kg, &v[1..])
    }

    /// Kinetic energy in the frame of the table, in J.
    pub(super) fn kinetic(&self, v: &[f64]) -> f64 {
        let storeys = self.masses_kg.iter().zip(&v[1..]);
        let sum = storeys.map(|(m, rate)| m * (v[0] + rate) * (v[0] + rate)).sum::<f64>();
        0.5 * (self.block_kg * v[0] * v[0] + sum)
    }

    /// Strain energy of spring and storeys, in J.
    pub(super) fn strain(&self, x: &[f64]) -> f64 {
        0.5 * (self.spring * x[0] * x[0] + chain_form(&self.stiffnesses, &x[1..]))
    }

    /// `C1 ṡ² + q̇ᵀ C q̇`, in W.
    pub(super) fn dissipation(&self, v: &[f64]) -> f64 {
        let rates = &v[1..];
        let storeys = match &self.damping {
            StoreyDamping::Chain(c) => chain_form(c, rates),
            StoreyDamping::Full(c) => c
                .chunks_exact(rates.len().max(1))
                .zip(rates)
                .map(|(row, r)| r * dot(row, rates))
                .sum(),
        };
        self.damper * v[0] * v[0] + storeys
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
            StoreyDamping::Chain(c) => {
                (self.floor_rows(c).collect(), 2.0 * c.first().unwrap_or(&0.0))
            }
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
            let stiffness = spring + 2.0 * self.stiffnesses.first().unwrap_or(&0.0);
            frequency = frequency.max(libm::sqrt(stiffness / self.block_kg));
            decay = decay.max((damper + base) / self.block_kg);
        }
        frequency.max(decay)
    }

    /// Sums of the sizes in each floor's row of a chain's matrix, the block's column included.
    fn floor_rows<'a>(&self, chain: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let above = chain.iter().skip(1).chain(core::iter::once(&0.0));
        chain.iter().zip(above).map(|(below, above)| 2.0 * (below + above))
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

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds the forces of elements between neighbouring floors, from the block up.
fn add_chain(chain: &[f64], q: &[f64], out: &mut [f64]) {
    let mut below = 0.0;
    for i in 0..chain.len() {
        let force = chain[i] * (q[i] - below);
        out[i] += force;
        if i > 0 {
            out[i - 1] -= force;
        }
        below = q[i];
    }
}

/// `qᵀ K q` of such a chain.
fn chain_form(chain: &[f64], q: &[f64]) -> f64 {
    let mut below = 0.0;
    let mut sum = 0.0;
    for (k, &q) in chain.iter().zip(q) {
        sum += k * (q - below) * (q - below);
        below = q;
    }
    sum
}
