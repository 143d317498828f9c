//! Taylor series of the motion in stick and in slip.

use super::polynomial::{DEGREE, Polynomial, value};
use super::system::{PerStorey, System};

/// State of block and structure: `s`, `ṡ`, then all `η`, then all `η̇`.
#[derive(Clone, Debug, PartialEq)]
pub struct State<V: PerStorey>(pub V::Flat);

impl<V: PerStorey> State<V> {
    /// All zeros for `n` storeys.
    #[must_use]
    pub fn zeros(n: usize) -> Self {
        Self(V::flat_zeros(n))
    }

    /// Sliding displacement `s` in m.
    #[inline(always)]
    #[must_use]
    pub fn s(&self) -> f64 {
        self.0.as_ref()[0]
    }

    /// Sliding velocity `ṡ` in m/s.
    #[inline(always)]
    #[must_use]
    pub fn w(&self) -> f64 {
        self.0.as_ref()[1]
    }

    /// Sets the sliding velocity.
    #[inline(always)]
    pub fn set_w(&mut self, w: f64) {
        self.0.as_mut()[1] = w;
    }

    /// Storey coordinates `η` in kg^(1/2) m.
    #[inline(always)]
    #[must_use]
    pub fn eta(&self) -> &[f64] {
        let x = self.0.as_ref();
        &x[2..1 + x.len() / 2]
    }

    /// Their velocities `η̇`.
    #[inline(always)]
    #[must_use]
    pub fn eta_dot(&self) -> &[f64] {
        let x = self.0.as_ref();
        &x[1 + x.len() / 2..]
    }
}

/// Load over an interval: the table's acceleration and the friction force, both linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// `a = Ü + g sin θ` at the start in m/s².
    pub acceleration: f64,
    /// Its change over the interval.
    pub acceleration_change: f64,
    /// Friction force `T` at the start in N; of no effect in stick.
    pub friction: f64,
    /// Its change over the interval.
    pub friction_change: f64,
}

/// Taylor coefficients over an interval, in time over the interval's length.
///
/// Beside the state they hold `f` and `u` (see [`System`]), of which accelerations and demand are
/// made. With `rate × length ≤ MAX_RATE_STEP` the first term left out is below 3e-17 of the
/// largest.
#[derive(Clone, Debug)]
pub struct Series<V: PerStorey> {
    /// `s`.
    pub s: Polynomial,
    /// `ṡ`.
    pub w: Polynomial,
    /// `u = s̈ + a`.
    pub u: Polynomial,
    /// `η`, one entry a coefficient.
    pub eta: [V; DEGREE + 1],
    /// `η̇`.
    pub eta_dot: [V; DEGREE + 1],
    /// `f = D η̇ + Ω η`.
    pub f: [V; DEGREE + 1],
}

/// Longest interval for one series, times the rate: 0.3^13 / 13! = 2.6e-17.
pub const MAX_RATE_STEP: f64 = 0.3;

impl<V: PerStorey> Series<V> {
    /// Room for the series of a system with `n` storeys.
    #[must_use]
    pub fn zeros(n: usize) -> Self {
        let room = || core::array::from_fn(|_| V::zeros(n));
        let zero = [0.0; DEGREE + 1];
        Self { s: zero, w: zero, u: zero, eta: room(), eta_dot: room(), f: room() }
    }

    /// Motion in slip from `state` over `length_s`.
    #[inline(always)]
    pub fn slip(&mut self, system: &System<V>, state: &State<V>, load: &Load, length_s: f64) {
        let over_mass = 1.0 / system.block_mass_kg;
        let (k1, c1) = (system.stiffness_n_per_m * over_mass, system.damper_n_s_per_m * over_mass);
        self.start(state);
        for k in 0..=DEGREE {
            let (friction, acceleration) = match k {
                0 => (load.friction * over_mass, load.acceleration),
                1 => (load.friction_change * over_mass, load.acceleration_change),
                _ => (0.0, 0.0),
            };
            let (eta, eta_dot) = (self.eta[k].as_ref(), self.eta_dot[k].as_ref());
            system.restoring_into(eta, eta_dot, self.f[k].as_mut());
            let shear = system.base_shear_n(self.f[k].as_ref()) * over_mass;
            self.u[k] = (friction - c1 * self.w[k]) + (shear - k1 * self.s[k]);
            if k < DEGREE {
                let step = length_s * RECIPROCAL[k + 1];
                self.s[k + 1] = step * self.w[k];
                self.w[k + 1] = step * (self.u[k] - acceleration);
                self.step_structure(system, k, step, self.u[k]);
            }
        }
    }

    /// Motion in stick from `state` (whose `ṡ` is taken as 0) over `length_s`.
    #[inline(always)]
    pub fn stick(&mut self, system: &System<V>, state: &State<V>, load: &Load, length_s: f64) {
        self.start(state);
        self.s = [0.0; DEGREE + 1];
        self.w = [0.0; DEGREE + 1];
        self.u = [0.0; DEGREE + 1];
        self.s[0] = state.s();
        (self.u[0], self.u[1]) = (load.acceleration, load.acceleration_change);
        for k in 0..=DEGREE {
            let (eta, eta_dot) = (self.eta[k].as_ref(), self.eta_dot[k].as_ref());
            system.restoring_into(eta, eta_dot, self.f[k].as_mut());
            if k < DEGREE {
                self.step_structure(system, k, length_s * RECIPROCAL[k + 1], self.u[k]);
            }
        }
    }

    #[inline(always)]
    fn start(&mut self, state: &State<V>) {
        (self.s[0], self.w[0]) = (state.s(), state.w());
        self.eta[0].as_mut().copy_from_slice(state.eta());
        self.eta_dot[0].as_mut().copy_from_slice(state.eta_dot());
    }

    /// `η` and `η̇` of order `k + 1`: `η̈ = −f − L u`.
    #[inline(always)]
    fn step_structure(&mut self, system: &System<V>, k: usize, step: f64, u: f64) {
        let l = system.participation.as_ref();
        let f = self.f[k].as_ref();
        let (eta, eta_dot) = (&mut self.eta, &mut self.eta_dot);
        let (now, next) = eta_dot.split_at_mut(k + 1);
        let now = now[k].as_ref();
        for (j, next) in next[0].as_mut().iter_mut().enumerate() {
            *next = -step * (f[j] + l[j] * u);
        }
        for (j, next) in eta[k + 1].as_mut().iter_mut().enumerate() {
            *next = step * now[j];
        }
    }

    /// The demand `T = M1 a + K1 s − L·f` of stick.
    #[inline(always)]
    #[must_use]
    pub fn demand(&self, system: &System<V>) -> Polynomial {
        let mut demand = [0.0; DEGREE + 1];
        for (k, demand) in demand.iter_mut().enumerate() {
            *demand = -system.base_shear_n(self.f[k].as_ref());
        }
        demand[0] += system.block_mass_kg * self.u[0] + system.stiffness_n_per_m * self.s[0];
        demand[1] += system.block_mass_kg * self.u[1];
        demand
    }

    /// State at `x` in [0, 1].
    #[inline(always)]
    pub fn state_at(&self, x: f64, state: &mut State<V>) {
        let out = state.0.as_mut();
        out[0] = value(&self.s, x);
        out[1] = value(&self.w, x);
        let n = out.len() / 2 - 1;
        for j in 0..n {
            out[2 + j] = value(&core::array::from_fn(|k| self.eta[k].as_ref()[j]), x);
            out[2 + n + j] = value(&core::array::from_fn(|k| self.eta_dot[k].as_ref()[j]), x);
        }
    }
}

/// 1 / k.
const RECIPROCAL: [f64; DEGREE + 1] = {
    let mut table = [0.0; DEGREE + 1];
    let mut k = 1;
    while k <= DEGREE {
        table[k] = 1.0 / k as f64;
        k += 1;
    }
    table
};
