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
/// With `rate × length ≤ MAX_RATE_STEP` the first term left out is below 3e-17 of the largest.
#[derive(Clone, Debug)]
pub struct Series<V: PerStorey> {
    /// `s`.
    pub s: Polynomial,
    /// `ṡ`.
    pub w: Polynomial,
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
        Self { s: zero, w: zero, eta: room(), eta_dot: room(), f: room() }
    }

    /// Motion in slip from `state` over `length_s`.
    pub fn slip(&mut self, system: &System<V>, state: &State<V>, load: &Load, length_s: f64) {
        self.start(state, state.w());
        let per_mass = system.per_block_mass;
        self.step::<true>(system, 0, length_s, load.acceleration, load.friction * per_mass);
        let (a, friction) = (load.acceleration_change, load.friction_change);
        self.step::<true>(system, 1, length_s, a, friction * per_mass);
        for k in 2..DEGREE {
            self.step::<true>(system, k, length_s, 0.0, 0.0);
        }
        self.restore(system, DEGREE);
    }

    /// Motion in stick from `state` (whose `ṡ` is taken as 0) over `length_s`.
    pub fn stick(&mut self, system: &System<V>, state: &State<V>, load: &Load, length_s: f64) {
        (self.s, self.w) = ([0.0; DEGREE + 1], [0.0; DEGREE + 1]);
        self.start(state, 0.0);
        self.step::<false>(system, 0, length_s, load.acceleration, 0.0);
        self.step::<false>(system, 1, length_s, load.acceleration_change, 0.0);
        for k in 2..DEGREE {
            self.step::<false>(system, k, length_s, 0.0, 0.0);
        }
        self.restore(system, DEGREE);
    }

    #[inline(always)]
    fn start(&mut self, state: &State<V>, w: f64) {
        (self.s[0], self.w[0]) = (state.s(), w);
        self.eta[0].as_mut().copy_from_slice(state.eta());
        self.eta_dot[0].as_mut().copy_from_slice(state.eta_dot());
    }

    /// Coefficients of order `k + 1` from those of order `k` under a table acceleration and, in
    /// slip, a friction force over `M1`. Products that can go ahead of the block's acceleration
    /// do, as each order has to wait for it.
    #[inline(always)]
    fn step<const SLIP: bool>(
        &mut self,
        system: &System<V>,
        k: usize,
        length_s: f64,
        a: f64,
        friction: f64,
    ) {
        let step = length_s * RECIPROCAL[k + 1];
        self.restore(system, k);
        let mut u = a;
        if SLIP {
            let (eta, eta_dot) = (self.eta[k].as_ref(), self.eta_dot[k].as_ref());
            u = system.block_response(self.s[k], self.w[k], eta, eta_dot, friction);
            self.w[k + 1] = step * (u - a);
            self.s[k + 1] = step * self.w[k];
        }
        let (l, f) = (system.participation.as_ref(), self.f[k].as_ref());
        let (now, next) = self.eta_dot.split_at_mut(k + 1);
        for (j, next) in next[0].as_mut().iter_mut().enumerate() {
            *next = -step * f[j] - (step * l[j]) * u;
        }
        for (next, now) in self.eta[k + 1].as_mut().iter_mut().zip(now[k].as_ref()) {
            *next = step * now;
        }
    }

    /// `f` of order `k`.
    #[inline(always)]
    fn restore(&mut self, system: &System<V>, k: usize) {
        let (eta, eta_dot) = (self.eta[k].as_ref(), self.eta_dot[k].as_ref());
        system.restoring_into(eta, eta_dot, self.f[k].as_mut());
    }

    /// The demand `T = M1 a + K1 s − L·f` of stick under a load.
    #[inline(always)]
    #[must_use]
    pub fn demand(&self, system: &System<V>, load: &Load) -> Polynomial {
        let mut demand = [0.0; DEGREE + 1];
        for (k, demand) in demand.iter_mut().enumerate() {
            *demand = -system.base_shear_n(self.f[k].as_ref());
        }
        demand[0] +=
            system.block_mass_kg * load.acceleration + system.stiffness_n_per_m * self.s[0];
        demand[1] += system.block_mass_kg * load.acceleration_change;
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
