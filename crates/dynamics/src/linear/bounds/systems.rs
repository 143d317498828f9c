//! Random systems, states and loads, and what is asked of them.

use super::random::Random;
use crate::linear::lanes::Many;
use crate::linear::polynomial::{DEGREE, Polynomial, value};
use crate::linear::{Load, StoreyDamping};
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;

pub use crate::linear::System;

/// `s, ṡ, η, η̇`.
#[derive(Clone)]
pub struct State(pub Vec<f64>);

impl State {
    pub fn s(&self) -> f64 {
        self.0[0]
    }

    pub fn w(&self) -> f64 {
        self.0[1]
    }

    pub fn eta(&self) -> &[f64] {
        &self.0[2..1 + self.0.len() / 2]
    }

    pub fn eta_dot(&self) -> &[f64] {
        &self.0[1 + self.0.len() / 2..]
    }
}

/// The series of each component of a state.
pub struct PlainSeries(pub Vec<Polynomial>);

impl PlainSeries {
    pub fn w(&self) -> Polynomial {
        self.0[1]
    }

    pub fn state_at(&self, part: f64, state: &mut State) {
        for (x, c) in state.0.iter_mut().zip(&self.0) {
            *x = value(c, part);
        }
    }

    /// The series of a row times the state.
    pub fn row(&self, row: &[f64]) -> Polynomial {
        core::array::from_fn(|k| row.iter().zip(&self.0).map(|(r, c)| r * c[k]).sum())
    }
}

/// The row `s · s + w · ṡ + yᵀ Ω η + e · η̇`.
pub fn row(system: &System, [s, w]: [f64; 2], y: &[f64], e: &[f64]) -> Vec<f64> {
    let mut row = vec![s, w];
    row.extend(y.iter().zip(&system.omega2).map(|(y, omega2)| y * omega2));
    row.extend_from_slice(e);
    row
}

/// `f = D η̇ + Ω η`.
pub fn restoring(system: &System, eta: &[f64], eta_dot: &[f64]) -> Vec<f64> {
    let mut f = vec![0.0; eta.len()];
    system.restoring(eta, eta_dot, &mut f);
    f
}

/// Random systems a test looks at.
pub const SYSTEMS: u64 = 300;

/// A system and what it was made from.
pub struct RandomSystem {
    pub system: System,
    pub masses_kg: Vec<f64>,
    pub stiffnesses_n_per_m: Vec<f64>,
    pub damped: bool,
}

/// None, one or three storeys; with and without spring, damper, dampers or ratio.
pub fn system(random: &mut Random, damped: bool) -> RandomSystem {
    let n = [0, 1, 3][random.integer(0, 2) as usize];
    let mut list =
        |low, high| -> Vec<f64> { (0..n).map(|_| random.logarithmic(low, high)).collect() };
    let (masses_kg, stiffnesses_n_per_m) = (list(10.0, 1e3), list(1e2, 1e6));
    let dampers = list(1.0, 1e3);
    let block_kg = random.logarithmic(10.0, 1e3);
    let spring = if random.chance(0.7) { random.logarithmic(1e2, 1e6) } else { 0.0 };
    let damper = if damped && random.chance(0.7) { random.logarithmic(1.0, 1e3) } else { 0.0 };
    let damping = match (damped, random.chance(0.5)) {
        (false, _) => StoreyDamping::Ratio(0.0),
        (true, true) => StoreyDamping::Ratio(random.between(0.0, 0.2)),
        (true, false) => StoreyDamping::Dampers(&dampers),
    };
    let system = System::new(block_kg, spring, damper, &masses_kg, &stiffnesses_n_per_m, damping);
    RandomSystem { system, masses_kg, stiffnesses_n_per_m, damped }
}

/// Seeds, each with its stream, and whether the system is damped.
pub fn streams() -> impl Iterator<Item = (Random, bool)> {
    (0..SYSTEMS).map(|seed| (Random::new(seed), seed % 3 != 0))
}

/// Displacements about 10 mm, velocities about 100 mm/s, in the coordinates of the system.
pub fn state(random: &mut Random, made: &RandomSystem, slip: bool) -> State {
    let n = made.masses_kg.len();
    let mut draw = |size: f64| size * random.between(-1.0, 1.0);
    let q: Vec<f64> = (0..n).map(|_| draw(0.01)).collect();
    let v: Vec<f64> = (0..n).map(|_| draw(0.1)).collect();
    let mut x = vec![draw(0.01), if slip { draw(0.1) } else { 0.0 }];
    x.extend(made.system.coordinates(&made.masses_kg, &q));
    x.extend(made.system.coordinates(&made.masses_kg, &v));
    State(x)
}

/// Loads and their rates: acceleration in m/s², friction force in N.
#[derive(Clone, Copy)]
pub struct Rates {
    pub acceleration: [f64; 2],
    pub friction: [f64; 2],
}

impl Rates {
    pub const NONE: Self = Self { acceleration: [0.0; 2], friction: [0.0; 2] };

    pub fn random(random: &mut Random) -> Self {
        let mut draw = |size: f64| size * random.between(-1.0, 1.0);
        Self { acceleration: [draw(3.0), draw(100.0)], friction: [draw(100.0), draw(1e3)] }
    }

    pub fn load(&self, from_s: f64, length_s: f64) -> Load {
        let at = |[value, rate]: [f64; 2]| (value + rate * from_s, rate * length_s);
        let ((acceleration, acceleration_change), (friction, friction_change)) =
            (at(self.acceleration), at(self.friction));
        Load { acceleration, acceleration_change, force: friction, force_change: friction_change }
    }
}

pub fn series(
    system: &System,
    slip: bool,
    state: &State,
    load: &Load,
    length_s: f64,
) -> PlainSeries {
    let mut series = crate::linear::ModalSeries::new(system, DEGREE);
    let mut x = state.0.clone();
    let components = x.len();
    x.resize(components.div_ceil(4) * 4, 0.0);
    vectorize!(InstructionSet::best(), simd => {
        series.expand(simd, system, slip, &x, load, length_s);
    });
    let width = Many(system.modes());
    PlainSeries((0..components).map(|i| series.component(width, i)).collect())
}

/// A coefficient of a series as a state.
pub fn coefficient(series: &PlainSeries, k: usize) -> State {
    assert!(k <= DEGREE);
    State(series.0.iter().map(|c| c[k]).collect())
}

pub fn norm(system: &System, x: &State) -> f64 {
    system.energy_norm(&x.0)
}

/// Norm of `ẍ` in a state under loads.
pub fn bend(system: &System, slip: bool, state: &State, rates: &Rates, at_s: f64) -> f64 {
    // Over one second the second coefficient is half the second derivative.
    2.0 * norm(system, &coefficient(&series(system, slip, state, &rates.load(at_s, 1.0), 1.0), 2))
}

/// `ẋ` of the unloaded system: the row of equations that the rates bound.
pub fn derivative(system: &System, slip: bool, x: &State) -> State {
    coefficient(&series(system, slip, x, &Rates::NONE.load(0.0, 1.0), 1.0), 1)
}

pub fn rate(system: &System, slip: bool) -> f64 {
    if slip { system.slip_rate_rad_per_s } else { system.stick_rate_rad_per_s }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs() / expected.abs().max(f64::MIN_POSITIVE);
    assert!(error <= tolerance, "{what}: found {found:e}, expected {expected:e}, off by {error:e}");
}
