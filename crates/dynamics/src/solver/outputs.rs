//! What the outputs are: [`Output::of`] says it once, of a motion as rows of the state, as series or at an instant.
//!
//! As a row an output is a linear function of the state, the acceleration `a = Ü + g sin θ` and the constant part
//! of the friction force `T`, with other coefficients in stick than in slip. Rows are looked at eight at a time.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use crate::linear::System;
use crate::linear::lanes::{Eight, combine8, dot, eight};
use crate::model::{Contents, Model};
use crate::response::output::Output;
use crate::slider::Restraint;

/// A number that sums are made of.
pub(super) trait Linear: Sized {
    /// Less a constant.
    fn less(self, constant: f64) -> Self;
    /// `first + Σ factor × term`, the first with its factor.
    fn sum(first: (f64, Self), terms: impl Iterator<Item = (f64, Self)>) -> Self;
}

impl Linear for f64 {
    fn less(self, constant: f64) -> Self {
        self - constant
    }

    fn sum((factor, first): (f64, Self), terms: impl Iterator<Item = (f64, Self)>) -> Self {
        terms.fold(factor * first, |sum, (factor, term)| sum + factor * term)
    }
}

/// What outputs are made of; accelerations are total ones with the slope's pull.
pub(super) trait Quantities {
    type Value: Linear;
    /// What is not asked for.
    fn zero(&self) -> Self::Value;
    /// `ṡ`.
    fn velocity(&self) -> Self::Value;
    /// `u`.
    fn block(&self) -> Self::Value;
    /// What passes from the table to the block.
    fn slider_n(&self) -> Self::Value;
    /// `T`.
    fn friction_n(&self) -> Self::Value;
    /// `L·f`.
    fn base_shear_n(&self) -> Self::Value;
    /// Displacement of a point.
    fn displacement(&self, point: usize) -> Self::Value;
    /// Displacement of a point over the one before it, which is not the first.
    fn drift(&self, point: usize) -> Self::Value;
    /// Velocity of a point over the one before it; of the first that over the block.
    fn drift_velocity(&self, point: usize) -> Self::Value;
    /// Acceleration of a point.
    fn acceleration(&self, point: usize) -> Self::Value;
    /// Sliding velocity and acceleration of contents.
    fn contents(&self, number: usize) -> [Self::Value; 2];
}

impl Output {
    /// Its value in a motion, by what has inertia in it, accelerations less the slope's pull.
    pub(super) fn of<M: Quantities>(self, motion: &M, inertia: &Inertia, slope: f64) -> M::Value {
        match self {
            Self::Velocity => motion.velocity(),
            Self::Block => motion.block().less(slope),
            Self::SliderForce => motion.slider_n(),
            Self::FrictionForce => motion.friction_n(),
            Self::BaseShear | Self::StoreyShear(0) => motion.base_shear_n(),
            Self::Overturning => {
                let Some(arms) = &inertia.arms else { return motion.zero() };
                let points = arms.points.iter().enumerate();
                let contents = arms.contents.iter().enumerate();
                let of_contents = contents.map(|(e, arm)| {
                    let [_, acceleration] = motion.contents(e);
                    (*arm, acceleration)
                });
                let of_points = points.map(|(i, arm)| (*arm, motion.acceleration(i)));
                Linear::sum((arms.block, motion.block()), of_points.chain(of_contents))
            }
            Self::Displacement(i) | Self::Drift(i @ 0) => motion.displacement(i),
            Self::Acceleration(i) => motion.acceleration(i).less(slope),
            Self::Drift(i) => motion.drift(i),
            Self::DriftVelocity(i) => motion.drift_velocity(i),
            // What is above the storey is moved by it alone.
            Self::StoreyShear(i) => {
                let Some(masses) = &inertia.masses else { return motion.zero() };
                let points = masses.points_kg.iter().enumerate().skip(i);
                let points = points.map(|(j, kg)| (-kg, motion.acceleration(j)));
                let contents = masses.contents_kg.iter().enumerate();
                let contents = contents.filter(|(_, (floor, _))| *floor > i).map(|(e, (_, kg))| {
                    let [_, acceleration] = motion.contents(e);
                    (-kg, acceleration)
                });
                Linear::sum((0.0, motion.zero()), points.chain(contents))
            }
            Self::ContentsVelocity(e) => {
                let [velocity, _] = motion.contents(e);
                velocity
            }
            Self::ContentsAcceleration(e) => {
                let [_, acceleration] = motion.contents(e);
                acceleration.less(slope)
            }
        }
    }
}

/// What has inertia, as outputs are made of it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Inertia {
    /// For the overturning moment, where it is asked for.
    pub(super) arms: Option<Arms>,
    /// For the shears of the storeys, where the points have masses.
    pub(super) masses: Option<Masses>,
}

/// Masses in kg: of points, and of contents on their floors, from 1, which may be fewer than the model's where some slide as
/// one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Masses {
    pub(super) points_kg: Vec<f64>,
    pub(super) contents_kg: Vec<(usize, f64)>,
}

impl Inertia {
    pub(super) fn new(model: &Model, contents: &[Contents]) -> Self {
        let contents_kg = || contents.iter().map(|c| (c.floor, c.mass_kg)).collect();
        let masses = model
            .point_masses_kg()
            .map(|points_kg| Masses { points_kg, contents_kg: contents_kg() });
        Self { arms: Arms::new(model, contents), masses }
    }
}

/// Mass times height above the sliding surface of all that has inertia, in kg m.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Arms {
    pub(super) block: f64,
    pub(super) points: Vec<f64>,
    /// Of contents, which may be fewer than the model's where some slide as one.
    pub(super) contents: Vec<f64>,
}

impl Arms {
    /// Where width and heights are given: else no moment is asked for.
    pub(super) fn new(model: &Model, contents: &[Contents]) -> Option<Self> {
        model.block().width_m?;
        let (points, block_m) = (model.lever_arms()?, model.block().height_m.unwrap_or(0.0));
        let height_m = |floor: usize| floor.checked_sub(1).map_or(block_m, |i| points[i][1]);
        Some(Self {
            block: 0.5 * block_m * model.bare_block_kg(),
            contents: contents.iter().map(|c| c.mass_kg * height_m(c.floor)).collect(),
            points: points.iter().map(|[mass_kg, above_m]| mass_kg * above_m).collect(),
        })
    }

    /// What `f` of each mode adds to the moment, with a minus sign, and what the block's acceleration adds.
    pub(super) fn by_modes(&self, system: &System) -> (Vec<f64>, f64) {
        let (mut of_f, mut of_block) = (vec![0.0; system.modes()], self.block);
        for (i, point) in self.points.iter().enumerate() {
            of_f.iter_mut().zip(system.point(i)).for_each(|(sum, shape)| *sum += point * shape);
            of_block += point * system.with_block(i);
        }
        (of_f, of_block)
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

impl OutputRow {
    fn plus(mut self, factor: f64, other: &Self) -> Self {
        self.state.iter_mut().zip(&other.state).for_each(|(sum, c)| *sum += factor * c);
        self.of_a += factor * other.of_a;
        self.of_friction += factor * other.of_friction;
        self.of_stop += factor * other.of_stop;
        self.constant += factor * other.constant;
        self
    }

    fn times(mut self, factor: f64) -> Self {
        self.state.iter_mut().for_each(|c| *c *= factor);
        let Self { of_a, of_friction, of_stop, constant, .. } = &mut self;
        [of_a, of_friction, of_stop, constant].into_iter().for_each(|c| *c *= factor);
        self
    }
}

impl Linear for OutputRow {
    fn less(self, constant: f64) -> Self {
        Self { constant: self.constant - constant, ..self }
    }

    fn sum((factor, first): (f64, Self), terms: impl Iterator<Item = (f64, Self)>) -> Self {
        terms.fold(first.times(factor), |sum, (factor, term)| sum.plus(factor, &term))
    }
}

/// The motion as rows, of stick or of slip with what of its restraint is friction.
struct Rows<'a> {
    system: &'a System,
    slip: Option<&'a Restraint>,
}

impl Rows<'_> {
    /// `y·η`.
    fn of_eta(&self, y: &[f64]) -> OutputRow {
        let mut row = self.zero();
        row.state[2..2 + y.len()].copy_from_slice(y);
        row
    }

    /// `factor y·f`, with `f` by `Ω` and `D`.
    fn of_f(&self, y: &[f64], factor: f64) -> OutputRow {
        let (system, n) = (self.system, self.system.modes());
        let mut row = self.zero();
        let (of_eta, of_rate) = row.state[2..2 + 2 * n].split_at_mut(n);
        system.restoring(&vec![0.0; n], y, of_rate);
        for j in 0..n {
            of_eta[j] = factor * (system.omega2[j] * y[j]);
            of_rate[j] *= factor;
        }
        row
    }
}

impl Quantities for Rows<'_> {
    type Value = OutputRow;

    fn zero(&self) -> OutputRow {
        let stride = (2 + 2 * self.system.modes()).div_ceil(4) * 4;
        let state = vec![0.0; stride];
        OutputRow { state, of_a: 0.0, of_friction: 0.0, of_stop: 0.0, constant: 0.0 }
    }

    fn velocity(&self) -> OutputRow {
        let mut row = self.zero();
        if self.slip.is_some() {
            row.state[1] = 1.0;
        }
        row
    }

    /// In slip `(T − stop − c ṡ − k s + L·f) / M1`, in stick `a`.
    fn block(&self) -> OutputRow {
        let (system, per_mass) = (self.system, self.system.per_block_mass);
        if self.slip.is_none() {
            return OutputRow { of_a: 1.0, ..self.zero() };
        }
        let mut row = self.of_f(&system.participation, per_mass);
        row.state[0] = -system.stiffness_n_per_m * per_mass;
        row.state[1] = -system.damper_n_s_per_m * per_mass;
        OutputRow { of_friction: per_mass, of_stop: -per_mass, ..row }
    }

    /// In slip `T − stop − c ṡ − k s`, in stick `M1 a − L·f`.
    fn slider_n(&self) -> OutputRow {
        let system = self.system;
        if self.slip.is_none() {
            let row = self.of_f(&system.participation, -1.0);
            return OutputRow { of_a: system.block_mass_kg, ..row };
        }
        let mut row = OutputRow { of_friction: 1.0, of_stop: -1.0, ..self.zero() };
        (row.state[0], row.state[1]) = (-system.stiffness_n_per_m, -system.damper_n_s_per_m);
        row
    }

    /// In slip with what of the restraint is friction, in stick the rest of what passes.
    fn friction_n(&self) -> OutputRow {
        let Some(slip) = self.slip else {
            let mut row = OutputRow { of_stop: 1.0, ..self.slider_n() };
            row.state[0] = self.system.stiffness_n_per_m;
            return row;
        };
        let mut row = OutputRow { of_friction: 1.0, ..self.zero() };
        (row.state[0], row.state[1]) = (-slip.stiffness_n_per_m, -slip.damper_n_s_per_m);
        row
    }

    fn base_shear_n(&self) -> OutputRow {
        self.of_f(&self.system.participation, 1.0)
    }

    fn displacement(&self, point: usize) -> OutputRow {
        self.of_eta(self.system.point(point))
    }

    fn drift(&self, point: usize) -> OutputRow {
        self.of_eta(self.system.point_drift(point))
    }

    fn drift_velocity(&self, point: usize) -> OutputRow {
        let (mut row, n) = (self.zero(), self.system.modes());
        row.state[2 + n..2 + 2 * n].copy_from_slice(self.system.point_drift(point));
        row
    }

    /// `−Φ_i f`, and with the block what of the point's motion is the block's.
    fn acceleration(&self, point: usize) -> OutputRow {
        let (system, part) = (self.system, self.system.with_block(point));
        let row = self.of_f(system.point(point), -1.0);
        if part == 0.0 { row } else { row.plus(part, &self.block()) }
    }

    /// Tables serve no contents.
    fn contents(&self, _: usize) -> [OutputRow; 2] {
        [self.zero(), self.zero()]
    }
}

/// All outputs of stick, or of slip with what of its restraint is friction, in their order.
pub(super) fn rows(
    system: &System,
    slip: Option<&Restraint>,
    inertia: &Inertia,
    slope: f64,
) -> Vec<OutputRow> {
    let rows = Rows { system, slip };
    Output::all(system.points(), 0).map(|output| output.of(&rows, inertia, slope)).collect()
}

/// The outputs of a phase.
#[derive(Debug)]
pub(super) struct Outputs {
    pub(super) rows: Vec<OutputRow>,
    pub(super) groups: Vec<OutputGroup>,
    /// Group by group: one, friction force, acceleration and stop, then the state.
    pub(super) columns: Vec<Eight>,
    /// Group by group what the amplitudes of [`System::amplitudes`] do at most, in stick.
    pub(super) amplitudes: Vec<Eight>,
    pub(super) amplitude_count: usize,
}

/// What bounds eight outputs side by side.
#[derive(Debug)]
pub(super) struct OutputGroup {
    pub(super) constant: Eight,
    pub(super) of_stop: Eight,
    /// Largest values on states of energy norm 1.
    pub(super) norm: Eight,
    /// Largest rates `c A x` on those states, and what rates of acceleration and friction force add to their
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
            let group = OutputGroup {
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
