//! Taylor series of the motion in stick and in slip.

use fearless_simd::f64x4;
use fearless_simd::prelude::*;

use super::lanes::{Four, Width, dot, four, greatest, least, sum_of_lanes};
use super::polynomial::{DEGREE, Polynomial, ZERO, curvature_bound};
use super::system::{Modes, System};

/// Longest interval for one series, times the rate: 1.4^21 / 21! = 2.3e-17.
pub const MAX_RATE_STEP: f64 = 1.4;

/// Terms of a series below this part of the largest are left out.
const NEGLIGIBLE: f64 = 1e-18;

/// `(5e-18 · 21!)^(1/21)`.
const NEAR: f64 = 1.302;

/// The part of the length, at most `part`, over which the orders that the series of `e^(−rate |w|)`
/// leaves off are rounding of 1, by the orders of `w`. Where it has faded the orders kept do not tell
/// that it comes back.
///
/// With `x = rate |w|` at the start and `Δ` its largest change, what is left off is at most
/// `e^(Δ − x)`, and `2 e^(−x) Δ²¹ / 21!` where `Δ ≤ 10`.
#[must_use]
pub fn fading_part(velocity: &Polynomial, rate_s_per_m: f64, part: f64) -> f64 {
    let x = rate_s_per_m * velocity[0].abs();
    let faded = x + libm::log(10.0 * NEGLIGIBLE);
    let near = NEAR * libm::exp(x / (DEGREE + 1) as f64);
    let most = greatest(faded, least(near, 0.5 * DEGREE as f64));
    let orders = velocity[1..=DEGREE].iter().rev();
    let change = rate_s_per_m * orders.fold(0.0, |sum, c| part * (sum + c.abs()));
    // Without a constant order Δ(p t) ≤ p Δ(t).
    if change > most { part * (most / change) } else { part }
}

/// Loads over an interval, linear in time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// `a = Ü + g sin θ` at the start in m/s².
    pub acceleration: f64,
    /// Its change over the interval.
    pub acceleration_change: f64,
    /// Force on the block at the start in N; of no effect in stick.
    pub force: f64,
    /// Its change over the interval.
    pub force_change: f64,
}

impl Load {
    /// Coefficients of acceleration and force of an order.
    #[inline(always)]
    pub(super) fn order(&self, k: usize) -> [f64; 2] {
        match k {
            0 => [self.acceleration, self.force],
            1 => [self.acceleration_change, self.force_change],
            _ => [0.0; 2],
        }
    }

    /// The first two coefficients of `of_a a + of_force force`; it has no others.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, [of_a, of_force]: [f64; 2]) -> [f64; 2] {
        [
            of_a * self.acceleration + of_force * self.force,
            of_a * self.acceleration_change + of_force * self.force_change,
        ]
    }
}

/// Taylor coefficients of a state over an interval, in time over the interval's length.
///
/// Order after order, each as many numbers as a padded state has. With `rate × length ≤ MAX_RATE_STEP`
/// the first term left out is below 6.4e-17 of the largest.
#[derive(Clone, Debug, Default)]
pub struct ModalSeries {
    stride: usize,
    /// Orders of a whole series.
    orders: usize,
    /// Those of the last.
    used: usize,
    c: Vec<f64>,
    f: Vec<f64>,
    /// `η`, `η̇` and `D η̇ + Ω η` of four modes at a time.
    lanes: Vec<[Four; 3]>,
    /// Energy norms of the orders, where a force fades.
    sizes: Polynomial,
    /// Series of that force in N.
    pub fade: Polynomial,
}

/// 1 / (k + 1).
const RECIPROCAL: [f64; DEGREE] = {
    let mut table = [0.0; DEGREE];
    let mut k = 0;
    while k < DEGREE {
        table[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    table
};

impl ModalSeries {
    /// Room for series of so many orders, a multiple of four.
    #[must_use]
    pub fn new(system: &System, orders: usize) -> Self {
        let mut series = Self::default();
        series.serve(system, orders);
        series
    }

    /// Makes the room serve another system or number of orders.
    pub fn serve(&mut self, system: &System, orders: usize) {
        let n = system.modes();
        (self.stride, self.orders) = ((2 + 2 * n).div_ceil(4) * 4, orders);
        // The last four modes of the last order may reach beyond it.
        let count = self.stride * (DEGREE + 1) + 4;
        for (list, count) in [(&mut self.c, count), (&mut self.f, n)] {
            list.clear();
            list.resize(count, 0.0);
        }
    }

    /// Motion from a padded state over `length_s`, order by order from the equations of motion.
    #[inline(always)]
    pub fn expand<S: Simd>(
        &mut self,
        simd: S,
        system: &System,
        slip: bool,
        x: &[f64],
        load: &Load,
        length_s: f64,
    ) {
        self.expand_to(simd, system, slip, x, load, (length_s, self.orders));
    }

    /// The same up to an order, a multiple of four.
    #[inline(always)]
    pub(super) fn expand_to<S: Simd>(
        &mut self,
        simd: S,
        system: &System,
        slip: bool,
        x: &[f64],
        load: &Load,
        (length_s, orders): (f64, usize),
    ) {
        let stride = self.stride;
        self.used = orders;
        self.c[..stride].copy_from_slice(x);
        if !slip {
            self.c[1] = 0.0;
        }
        if let Some(modes) = system.uncoupled_modes() {
            return if slip {
                self.expand_slip(simd, system, modes, load, length_s)
            } else {
                self.expand_stick(simd, system.modes(), modes, load, length_s)
            };
        }
        let f = &mut self.f[..system.modes()];
        for k in 0..self.used {
            let (before, next) = self.c.split_at_mut((k + 1) * stride);
            let step = length_s * RECIPROCAL[k];
            next_order(system, slip, &before[k * stride..], next, f, load.order(k), step);
        }
    }

    /// Stick of modes that damping does not couple: four oscillators at a time.
    ///
    /// Of the last four some may be beyond the last mode. Their zeros fall on what is written after them:
    /// on the first rates, which therefore come last, or on the next order.
    #[inline(always)]
    fn expand_stick<S: Simd>(
        &mut self,
        simd: S,
        n: usize,
        modes: &[Modes],
        load: &Load,
        length_s: f64,
    ) {
        let (stride, orders) = (self.stride, self.used);
        let c = &mut self.c[..stride * (orders + 1) + 4];
        for k in 1..=orders {
            (c[k * stride], c[k * stride + 1]) = (0.0, 0.0);
        }
        for m in (0..modes.len()).rev() {
            let [omega2, damping, l] = modes[m].each_ref().map(|x| x.load(simd));
            let (eta_at, rate_at) = (2 + 4 * m, 2 + n + 4 * m);
            let [mut eta, mut rate] =
                [eta_at, rate_at].map(|at| Four::new(&c[at..at - 4 * m + n]).load(simd));
            for k in 0..orders {
                let step = four(simd, length_s * RECIPROCAL[k]);
                let mut f = omega2 * eta + damping * rate;
                if k < 2 {
                    f += l * four(simd, load.order(k)[0]);
                }
                (eta, rate) = (step * rate, -step * f);
                let next = &mut c[(k + 1) * stride..][..rate_at + 4];
                eta.store_slice(&mut next[eta_at..][..4]);
                rate.store_slice(&mut next[rate_at..][..4]);
            }
        }
    }

    /// Slip of the same modes.
    #[inline(always)]
    fn expand_slip<S: Simd>(
        &mut self,
        simd: S,
        system: &System,
        modes: &[Modes],
        load: &Load,
        length_s: f64,
    ) {
        let (n, stride) = (system.modes(), self.stride);
        let count = modes.len();
        let (eta_at, rate_at) = (2, 2 + n);
        self.lanes.resize(count, [Four::ZERO; 3]);
        let lanes = &mut self.lanes[..count];
        for m in 0..count {
            let of = |at: usize| Four::new(&self.c[at + 4 * m..at + n]);
            lanes[m] = [of(eta_at), of(rate_at), Four::ZERO];
        }
        let [mut s, mut w] = [self.c[0], self.c[1]];
        for k in 0..self.used {
            let mut shear = four(simd, 0.0);
            for m in 0..count {
                let ([omega2, damping, l], [eta, rate, f]) = (&modes[m], &mut lanes[m]);
                let x = omega2.load(simd) * eta.load(simd) + damping.load(simd) * rate.load(simd);
                x.store_slice(&mut f.0);
                shear += l.load(simd) * x;
            }
            let step = length_s * RECIPROCAL[k];
            let [a, force] = load.order(k);
            let u = system.block_acceleration(s, w, sum_of_lanes(shear), force);
            [s, w] = [step * w, step * (u - a)];
            let (u, step) = (four(simd, u), four(simd, step));
            let next = &mut self.c[(k + 1) * stride..][..rate_at + 4 * count];
            (next[0], next[1]) = (s, w);
            let of_eta = &mut next[eta_at..].as_chunks_mut::<4>().0[..count];
            for m in 0..count {
                let ([.., l], [eta, rate, f]) = (&modes[m], &mut lanes[m]);
                let next_eta = step * rate.load(simd);
                let next_rate = -step * (f.load(simd) + l.load(simd) * u);
                next_eta.store_slice(&mut eta.0);
                next_eta.store_slice(&mut of_eta[m]);
                next_rate.store_slice(&mut rate.0);
            }
            let of_rates = &mut next[rate_at..].as_chunks_mut::<4>().0[..count];
            for m in 0..count {
                of_rates[m] = lanes[m][1].0;
            }
        }
    }

    /// The same in slip under one more force, which fades with the speed: `force e^(−rate ṡ)`.
    ///
    /// With the coefficients `E_k` of the power, `(k+1) E_{k+1} = −rate Σ_{j≤k} (j+1) w_{j+1} E_{k−j}`.
    /// Returns the part of the length over which the last terms are below rounding, 4 at most.
    #[inline(always)]
    pub fn expand_fading<W: Width>(
        &mut self,
        width: W,
        system: &System,
        x: &[f64],
        load: &Load,
        length_s: f64,
        [force_n, rate_s_per_m]: [f64; 2],
    ) -> f64 {
        let (n, stride) = (width.modes(), 4 * width.fours());
        self.used = DEGREE;
        let (f, fade) = (&mut self.f[..n], &mut self.fade);
        let mut w = ZERO;
        self.c[..stride].copy_from_slice(x);
        fade[0] = force_n * libm::exp(-rate_s_per_m * x[1]);
        for k in 0..DEGREE {
            let (before, next) = self.c.split_at_mut((k + 1) * stride);
            let [a, force] = load.order(k);
            let step = length_s * RECIPROCAL[k];
            next_order(system, true, &before[k * stride..], next, f, [a, force + fade[k]], step);
            // (j + 1) w_{j+1}
            w[k] = (k + 1) as f64 * next[1];
            let mut sum = 0.0;
            for j in 0..=k {
                sum += w[j] * fade[k - j];
            }
            fade[k + 1] = -rate_s_per_m * sum * RECIPROCAL[k];
        }
        let mut largest = 0.0;
        for (size, c) in self.sizes.iter_mut().zip(self.c.chunks_exact(stride)).take(DEGREE + 1) {
            *size = system.energy_norm(&c[..2 + 2 * n]);
            largest = greatest(largest, *size);
        }
        if !largest.is_finite() {
            return 0.5;
        }
        let mut part: f64 = 4.0;
        for k in [DEGREE - 1, DEGREE] {
            let of_state = NEGLIGIBLE * largest / self.sizes[k];
            let of_force = NEGLIGIBLE * (10.0 * force_n.abs()) / fade[k].abs();
            let room = least(of_state, of_force);
            if room < 1.0 {
                part = part.min(libm::pow(room, 1.0 / k as f64));
            }
        }
        let mut velocity = ZERO;
        for (w, c) in velocity.iter_mut().zip(self.c.chunks_exact(stride)).take(DEGREE + 1) {
            *w = c[1];
        }
        fading_part(&velocity, rate_s_per_m.abs(), part)
    }

    /// Bound on the norm of `ẍ` over that length, times its square: `Σ k (k − 1) ‖c_k‖`.
    #[must_use]
    pub fn second_bound(&self) -> f64 {
        curvature_bound(&self.sizes)
    }

    /// Room for the start and for so many orders after it, of states of so many numbers.
    #[inline(always)]
    pub(super) fn scratch(&mut self, orders: usize, stride: usize) -> (&mut [f64], &mut [f64]) {
        self.used = orders;
        let (start, rest) = self.c.split_at_mut(stride);
        (start, &mut rest[..stride * orders])
    }

    /// Four components of an order.
    #[inline(always)]
    fn four<S: Simd>(simd: S, c: &[f64], stride: usize, k: usize, i: usize) -> f64x4<S> {
        f64x4::from_slice(simd, &c[k * stride + 4 * i..][..4])
    }

    /// State at `t` in [0, 1], padded.
    #[inline(always)]
    pub fn state_at<S: Simd>(&self, simd: S, t: f64, out: &mut [f64]) {
        let (t2, stride) = (t * t, out.len());
        let c = &self.c[..stride * (DEGREE + 1)];
        let t4 = four(simd, t2 * t2);
        for (i, out) in out.chunks_exact_mut(4).enumerate() {
            // Four sums, of the orders that leave the same rest on division by four.
            let zero = four(simd, 0.0);
            let mut sums = [Self::four(simd, c, stride, self.used, i), zero, zero, zero];
            let mut k = self.used;
            while k >= 4 {
                k -= 4;
                for r in 0..4 {
                    sums[r] = Self::four(simd, c, stride, k + r, i) + sums[r] * t4;
                }
            }
            let even = sums[0] + sums[2] * four(simd, t2);
            let odd = sums[1] + sums[3] * four(simd, t2);
            (even + odd * four(simd, t)).store_slice(out);
        }
    }

    /// The coefficients of one component of the state.
    #[inline(always)]
    #[must_use]
    pub fn component<W: Width>(&self, width: W, i: usize) -> Polynomial {
        let mut p = ZERO;
        for (p, c) in p.iter_mut().zip(self.c.chunks_exact(4 * width.fours())).take(self.used + 1) {
            *p = c[i];
        }
        p
    }

    /// The coefficients of a padded row times the state.
    #[inline(always)]
    #[must_use]
    pub fn row<S: Simd, W: Width>(&self, simd: S, width: W, row: &[f64]) -> Polynomial {
        let stride = 4 * width.fours();
        let (row, _) = row[..stride].as_chunks::<4>();
        let mut p = ZERO;
        for k in 0..=self.used {
            let (c, _) = self.c[k * stride..][..stride].as_chunks::<4>();
            let mut sum = four(simd, 0.0);
            for i in 0..row.len() {
                sum += f64x4::load_array_ref(simd, &row[i]) * f64x4::load_array_ref(simd, &c[i]);
            }
            p[k] = sum_of_lanes(sum);
        }
        p
    }

    /// The coefficients of an order.
    #[inline(always)]
    #[must_use]
    pub fn order(&self, k: usize) -> &[f64] {
        &self.c[k * self.stride..][..self.stride]
    }
}

/// The order that follows from one, under coefficients of acceleration and force; `step` is the length
/// over the number of the order. Leaves `D η̇ + Ω η` in `f`.
#[inline(always)]
fn next_order(
    system: &System,
    slip: bool,
    now: &[f64],
    next: &mut [f64],
    f: &mut [f64],
    [a, force]: [f64; 2],
    step: f64,
) {
    let n = f.len();
    let (now, l) = (&now[..2 + 2 * n], &system.participation[..n]);
    let (eta, rate) = (&now[2..2 + n], &now[2 + n..]);
    system.restoring(eta, rate, f);
    let (block, rest) = next[..2 + 2 * n].split_at_mut(2);
    let (next_eta, next_rate) = rest.split_at_mut(n);
    let mut u = a;
    if slip {
        u = system.block_acceleration(now[0], now[1], dot(l, f), force);
        (block[0], block[1]) = (step * now[1], step * (u - a));
    } else {
        (block[0], block[1]) = (0.0, 0.0);
    }
    for j in 0..n {
        next_eta[j] = step * rate[j];
        next_rate[j] = -step * (f[j] + l[j] * u);
    }
}

/// Orders of a series for a rate times a length of [`MAX_RATE_STEP`] at most, a multiple of four.
///
/// What the series of a slow system leaves out is below 1e-24 of its largest term: a slide of a
/// hundred-millionth of the structure's motion keeps its digits. Up to 0.8 there are sixteen:
/// 0.8^17 / 17! = 6.3e-17.
#[must_use]
pub fn orders(rate_step: f64) -> usize {
    let mut term = 1.0;
    for k in 1..DEGREE {
        term *= rate_step / k as f64;
        if k % 4 == 1 && k > 4 && (term <= 1e-24 || k == 17 && term <= 6.4e-17) {
            return k - 1;
        }
    }
    DEGREE
}

/// Moves a padded state over `length_s` under loads that are linear in it, by as many series as the
/// length needs.
#[inline(always)]
pub fn advance<S: Simd>(
    simd: S,
    system: &System,
    slip: bool,
    length_s: f64,
    load: &Load,
    series: &mut ModalSeries,
    x: &mut [f64],
) {
    let rate = if slip { system.slip_rate_rad_per_s } else { system.stick_rate_rad_per_s };
    let pieces = (rate * length_s / MAX_RATE_STEP).ceil().max(1.0);
    let part = Load {
        acceleration_change: load.acceleration_change / pieces,
        force_change: load.force_change / pieces,
        ..*load
    };
    for piece in 0..pieces as usize {
        let load = Load {
            acceleration: load.acceleration + part.acceleration_change * piece as f64,
            force: load.force + part.force_change * piece as f64,
            ..part
        };
        let s = x[0];
        series.expand(simd, system, slip, x, &load, length_s / pieces);
        series.state_at(simd, 1.0, x);
        if !slip {
            x[0] = s;
        }
    }
}
