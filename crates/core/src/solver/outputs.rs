//! The tracked outputs: every number of which the analysis reports a peak, as a row.
//!
//! Each is a linear function of the state, the acceleration `a = Ü + g sin θ` and the constant part of
//! the friction force `T`, with other coefficients in stick than in slip. [`rows`] is the one place that lists them: a
//! new peak is a row here and a field in [`Demands`](crate::response::Demands). They are looked at
//! eight at a time.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use crate::linear::System;
use crate::linear::lanes::{Eight, combine8, dot, eight};
use crate::model::Model;
use crate::slider::Restraint;

/// Places of the outputs of the block; those of the points follow: floors, or points of a structure by its modes.
pub(super) mod output {
    /// `ṡ` in m/s.
    pub(in crate::solver) const VELOCITY: usize = 0;
    /// `u = s̈ + a` less the slope's pull in m/s².
    pub(in crate::solver) const BLOCK: usize = 1;
    /// All that passes from the table to the block, `M1 u − L·f`, in N.
    pub(in crate::solver) const SLIDER: usize = 2;
    /// `T` in N.
    pub(in crate::solver) const FRICTION: usize = 3;
    /// `L·f` in N.
    pub(in crate::solver) const BASE_SHEAR: usize = 4;
    /// Overturning moment about the sliding surface in N m.
    pub(in crate::solver) const OVERTURNING: usize = 5;
    /// Displacements of the storeys, then their accelerations `−Φ_i f` less the slope's pull, then
    /// drifts from the second storey on: that of the first is its displacement.
    pub(in crate::solver) const STOREYS: usize = 6;

    /// Number of outputs with `n` storeys.
    pub(in crate::solver) fn count(n: usize) -> usize {
        STOREYS + 2 * n + n.saturating_sub(1)
    }

    /// Displacement of storey `i` of `n`.
    pub(in crate::solver) fn displacement(i: usize) -> usize {
        STOREYS + i
    }

    /// Acceleration of floor `i` of `n`.
    pub(in crate::solver) fn acceleration(n: usize, i: usize) -> usize {
        STOREYS + n + i
    }

    /// Drift of storey `i` of `n`.
    pub(in crate::solver) fn drift(n: usize, i: usize) -> usize {
        if i == 0 { displacement(0) } else { STOREYS + 2 * n + i - 1 }
    }
}

/// An output as a row.
#[derive(Clone, Debug)]
pub(super) struct OutputRow {
    /// Factors of `s, ṡ, η, η̇`, padded.
    pub(super) state: Vec<f64>,
    /// Factor of `a`.
    pub(super) of_a: f64,
    /// Factor of the friction force.
    pub(super) of_friction: f64,
    /// Factor of what the stop does: in slip its constant force, in stick its force.
    pub(super) of_stop: f64,
    /// Constant part.
    pub(super) constant: f64,
}

/// What the model adds to the system for its outputs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Overturning {
    /// Masses of the floors times their heights, `Φᵀ z`.
    arm: Vec<f64>,
    /// Half the block's mass times its height, with what of the points' motion is the block's.
    block: f64,
}

impl Overturning {
    /// What `f` of one storey and the block's acceleration add.
    pub(super) fn arms(&self) -> [f64; 2] {
        [self.arm[0], self.block]
    }

    /// What `f` of each mode and the block's acceleration add.
    pub(super) fn all(&self) -> (&[f64], f64) {
        (&self.arm, self.block)
    }

    /// The moment of the inertia of floors and block about the sliding surface, in N m.
    pub(super) fn moment(&self, f: &[f64], u: f64) -> f64 {
        self.block * u - dot(&self.arm, f)
    }
}

/// Moment arms of the floors' and the block's inertia, where width and heights are given.
pub(super) fn overturning(model: &Model, system: &System) -> Option<Overturning> {
    model.block().width_m?;
    let mut arm = vec![0.0; system.modes()];
    let mut block = 0.5 * model.block().height_m.unwrap_or(0.0) * model.bare_block_kg();
    for (i, [mass_kg, above_m]) in model.lever_arms()?.into_iter().enumerate() {
        for (arm, shape) in arm.iter_mut().zip(system.point(i)) {
            *arm += mass_kg * above_m * shape;
        }
        block += mass_kg * above_m * system.with_block(i);
    }
    Some(Overturning { arm, block })
}

/// All outputs of stick, or of slip with what of its restraint is friction, in their order.
pub(super) fn rows(
    system: &System,
    slip: Option<&Restraint>,
    overturning: Option<&Overturning>,
    slope: f64,
) -> Vec<OutputRow> {
    let n = system.modes();
    let stride = (2 + 2 * n).div_ceil(4) * 4;
    let none = || OutputRow {
        state: vec![0.0; stride],
        of_a: 0.0,
        of_friction: 0.0,
        of_stop: 0.0,
        constant: 0.0,
    };
    // y·η, or y·f by Ω and D, times a factor.
    let of_eta = |y: &[f64]| {
        let mut row = none();
        row.state[2..2 + y.len()].copy_from_slice(y);
        row
    };
    let still = vec![0.0; n];
    let of_f = |y: &[f64], factor: f64| {
        let mut row = none();
        let (of_eta, of_rate) = row.state[2..2 + 2 * n].split_at_mut(n);
        system.restoring(&still, y, of_rate);
        for j in 0..n {
            of_eta[j] = factor * (system.omega2[j] * y[j]);
            of_rate[j] *= factor;
        }
        row
    };
    let l = &system.participation;
    let (mass, per_mass) = (system.block_mass_kg, system.per_block_mass);
    // u, of which slip has u = (T − stop − c ṡ − k s + L·f) / M1 and stick u = a.
    let mut u = if slip.is_some() { of_f(l, per_mass) } else { none() };
    if slip.is_some() {
        u.state[0] = -system.stiffness_n_per_m * per_mass;
        u.state[1] = -system.damper_n_s_per_m * per_mass;
        (u.of_friction, u.of_stop) = (per_mass, -per_mass);
    } else {
        u.of_a = 1.0;
    }
    let mut velocity = none();
    let mut slider = if slip.is_some() { none() } else { of_f(l, -1.0) };
    let mut friction;
    if let Some(of_friction) = slip {
        friction = none();
        velocity.state[1] = 1.0;
        (slider.state[0], slider.state[1]) = (-system.stiffness_n_per_m, -system.damper_n_s_per_m);
        (slider.of_friction, slider.of_stop) = (1.0, -1.0);
        friction.of_friction = 1.0;
        friction.state[0] = -of_friction.stiffness_n_per_m;
        friction.state[1] = -of_friction.damper_n_s_per_m;
    } else {
        slider.of_a = mass;
        friction = slider.clone();
        friction.state[0] = system.stiffness_n_per_m;
        friction.of_stop = 1.0;
    }
    let moment = overturning.map_or_else(none, |moment| {
        let mut row = of_f(&moment.arm, -1.0);
        for (row, u) in row.state.iter_mut().zip(&u.state) {
            *row += moment.block * u;
        }
        row.of_a = moment.block * u.of_a;
        row.of_friction = moment.block * u.of_friction;
        row.of_stop = moment.block * u.of_stop;
        row
    });
    let points = 0..system.points();
    // −Φ_i f, and with the block what of the point's motion is the block's.
    let acceleration = |i: usize| {
        let (mut row, part) = (of_f(system.point(i), -1.0), system.with_block(i));
        if part != 0.0 {
            row.state.iter_mut().zip(&u.state).for_each(|(row, u)| *row += part * u);
            [row.of_a, row.of_friction, row.of_stop] =
                [u.of_a, u.of_friction, u.of_stop].map(|u| part * u);
        }
        OutputRow { constant: -slope, ..row }
    };
    let accelerations: Vec<OutputRow> = points.clone().map(acceleration).collect();
    let block = OutputRow { constant: -slope, ..u };
    let mut all = Vec::with_capacity(output::count(system.points()));
    all.extend([velocity, block, slider, friction, of_f(l, 1.0), moment]);
    all.extend(points.clone().map(|i| of_eta(system.point(i))));
    all.extend(accelerations);
    all.extend(points.skip(1).map(|i| of_eta(system.point_drift(i))));
    all
}

/// The outputs of a phase.
#[derive(Debug)]
pub(super) struct Outputs {
    pub(super) rows: Vec<OutputRow>,
    pub(super) groups: Vec<Group>,
    /// Group by group: one, friction force, acceleration and stop, then the state.
    pub(super) columns: Vec<Eight>,
    /// Group by group what the amplitudes of [`System::amplitudes`] do at most, in stick.
    pub(super) amplitudes: Vec<Eight>,
    pub(super) amplitude_count: usize,
}

/// What bounds eight outputs side by side.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) constant: Eight,
    pub(super) of_stop: Eight,
    /// Largest values on states of energy norm 1.
    pub(super) norm: Eight,
    /// The same of their rates `c A`, and what rates of acceleration and friction force add to their
    /// second derivatives, `|c b|`.
    pub(super) norm_of_rate: Eight,
    pub(super) of_jerk: Eight,
    pub(super) of_force_rate: Eight,
    /// Factors of `s`, and those of the acceleration and of the friction force as sizes.
    pub(super) of_s: Eight,
    pub(super) size_of_a: Eight,
    pub(super) size_of_friction: Eight,
    /// What `∫|a| dt` adds at most in stick.
    pub(super) of_impulse: Eight,
    /// Components of a state up to the last four that one of them asks for.
    pub(super) used: usize,
}

impl Outputs {
    pub(super) fn new(system: &System, slip: bool, rows: Vec<OutputRow>) -> Self {
        let stride = rows[0].state.len();
        let (mut unit, mut end) = (vec![0.0; stride], vec![0.0; stride]);
        // Rates of the rows: what every component of the state does to them.
        let mut rates = vec![0.0; rows.len() * stride];
        for j in 0..2 + 2 * system.modes() {
            unit[j] = 1.0;
            system.derivative(slip, &unit, 0.0, 0.0, &mut end);
            unit[j] = 0.0;
            for (row, rate) in rows.iter().zip(rates.chunks_exact_mut(stride)) {
                rate[j] = dot(&row.state, &end);
            }
        }
        let mut of_load = |a: f64, force: f64| {
            system.derivative(slip, &unit, a, force, &mut end);
            rows.iter().map(|row| dot(&row.state, &end).abs()).collect::<Vec<f64>>()
        };
        let (of_jerk, of_force_rate) = (of_load(1.0, 0.0), of_load(0.0, 1.0));
        let rate = |j: usize| &rates[j * stride..][..stride];
        let amplitude_count = if slip { 0 } else { system.amplitude_count() };
        let of_amplitudes: Vec<Vec<f64>> = match slip {
            true => Vec::new(),
            false => rows.iter().map(|row| system.dual_amplitudes(&row.state)).collect(),
        };
        let impulse = system.amplitudes_of_impulse();
        let of_impulse = |j: usize| if slip { 0.0 } else { dot(&of_amplitudes[j], &impulse) };
        let count = rows.len().div_ceil(8);
        let mut amplitudes = Vec::with_capacity(count * amplitude_count);
        let (mut groups, mut columns) = (Vec::with_capacity(count), Vec::new());
        columns.reserve_exact(count * (4 + stride));
        for g in 0..count {
            let first = 8 * g;
            let group = Group {
                constant: lanes(&rows, first, |j| rows[j].constant),
                of_stop: lanes(&rows, first, |j| rows[j].of_stop),
                norm: lanes(&rows, first, |j| system.dual_norm(slip, &rows[j].state)),
                norm_of_rate: lanes(&rows, first, |j| system.dual_norm(slip, rate(j))),
                of_jerk: lanes(&rows, first, |j| of_jerk[j]),
                of_force_rate: lanes(&rows, first, |j| of_force_rate[j]),
                of_s: lanes(&rows, first, |j| rows[j].state[0]),
                size_of_a: lanes(&rows, first, |j| rows[j].of_a.abs()),
                size_of_friction: lanes(&rows, first, |j| rows[j].of_friction.abs()),
                of_impulse: lanes(&rows, first, of_impulse),
                used: used(&rows[first..rows.len().min(first + 8)]),
            };
            amplitudes
                .extend((0..amplitude_count).map(|i| lanes(&rows, first, |j| of_amplitudes[j][i])));
            columns.push(group.constant);
            columns.push(lanes(&rows, first, |j| rows[j].of_friction));
            columns.push(lanes(&rows, first, |j| rows[j].of_a));
            columns.push(group.of_stop);
            columns.extend((0..stride).map(|i| lanes(&rows, first, |j| rows[j].state[i])));
            groups.push(group);
        }
        Self { rows, groups, columns, amplitudes, amplitude_count }
    }

    /// What amplitudes, one or whole fours of modes, do at most to the outputs of a group.
    #[inline(always)]
    pub(super) fn of_amplitudes<S: Simd>(&self, simd: S, g: usize, amplitudes: &[f64]) -> f64x8<S> {
        let count = amplitudes.len();
        let columns = &self.amplitudes[g * count..][..count];
        match amplitudes {
            [one] => columns[0].load(simd) * eight(simd, *one),
            _ => combine8(simd, columns, &[], &[], amplitudes),
        }
    }
}

/// One number of each of eight rows from one on; zero beyond the last.
#[inline(always)]
fn lanes(rows: &[OutputRow], first: usize, of: impl Fn(usize) -> f64) -> Eight {
    let mut all = Eight::ZERO;
    for (lane, j) in all.0.iter_mut().zip(first..rows.len()) {
        *lane = of(j);
    }
    all
}

/// Components of a state, in whole fours, up to the last that a row asks for.
fn used(rows: &[OutputRow]) -> usize {
    let last = |row: &OutputRow| row.state.iter().rposition(|c| *c != 0.0).map_or(0, |i| i + 1);
    rows.iter().map(last).fold(0, usize::max).next_multiple_of(4)
}
