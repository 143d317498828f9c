//! The short way through ordinary samples: one propagator, and a bound that vouches for the rest.

use super::Run;
use crate::friction::Direction;
use crate::linear::{PerStorey, Propagator};
use crate::response::Mode;
use crate::solver::extremes::Place;
use crate::solver::recorder::Recorder;

/// Samples after which the bound on `ẍ` is made anew from the state.
const BOUND_LIFE: u32 = 16;

/// Bound on the norm of `ẍ` over the coming sample, and how many samples it may still serve.
struct Bend {
    norm: f64,
    life: u32,
}

impl Bend {
    /// To be made from the state before it is used.
    fn due() -> Self {
        Self { norm: 0.0, life: 0 }
    }
}

impl<V: PerStorey, R: Recorder<V>> Run<'_, V, R> {
    /// Takes whole samples while the bounds show that nothing happens in them; the first sample
    /// that they do not vouch for.
    pub(super) fn short_way(&mut self, mut sample: usize) -> usize {
        let Some([stick, slip]) = self.propagators.take() else { return sample };
        if self.start.is_none() {
            sample = match self.mode {
                Mode::Stick => self.short_stick(&stick, sample),
                Mode::Slip(direction) => self.short_slip(&slip, direction, sample),
            };
        }
        self.propagators = Some([stick, slip]);
        sample
    }

    fn short_slip(
        &mut self,
        propagator: &Propagator<V>,
        direction: Direction,
        mut sample: usize,
    ) -> usize {
        let (system, excitation) = (self.system, self.excitation);
        let Some(dt_s) = excitation.dt_s else { return sample };
        let (eighth, sign) = (0.125 * dt_s * dt_s, direction.sign());
        let coefficient = excitation.kinetic(direction);
        let norm = self.extremes.velocity_norm();
        let mode = Mode::Slip(direction);
        let acceleration = excitation.acceleration.as_slice();
        let mut normal = excitation.normal_at_sample(sample);
        if !(normal >= 0.0) {
            return sample;
        }
        // The state stays in registers; it is written back at the end.
        let mut state = self.state.clone();
        let mut values = self.values(acceleration[sample], coefficient * normal);
        let mut bend = Bend::due();
        while let Some(&a1) = acceleration.get(sample + 1) {
            let a = [acceleration[sample], a1];
            let next_normal = excitation.normal_at_sample(sample + 1);
            let friction = [coefficient * normal, coefficient * next_normal];
            let next = propagator.slip(&state, a, friction);
            if bend.life == 0 {
                self.state.clone_from(&state);
                bend = Bend { norm: self.bend_at(sample, friction), life: BOUND_LIFE };
            } else {
                self.add_kink(&mut bend, sample);
            }
            let reach = eighth * bend.norm;
            let least = (sign * state.w()).min(sign * next.w());
            if !(least > reach * norm && next_normal >= 0.0) {
                break;
            }
            let f = system.restoring(next.eta(), next.eta_dot());
            let shear = system.base_shear_n(f.as_ref());
            let u = Self::u_of(system, &next, shear, friction[1]);
            let (eta, w, s) = (next.eta(), next.w(), next.s());
            let end = self.extremes.values(system, s, w, eta, f.as_ref(), shear, u, friction[1]);
            if self.extremes.may_exceed(&values, &end, reach, mode) {
                let state = &state;
                let place = Place { interval: sample, from_s: 0.0, length_s: dt_s, mode, state };
                self.extremes.keep(system, excitation, &values, &end, reach, &place);
            }
            if R::WANTED {
                self.state.clone_from(&state);
                self.record_sample(sample, mode, true);
            }
            (values, normal, state) = (end, next_normal, next);
            sample += 1;
        }
        self.state = state;
        sample
    }

    fn short_stick(&mut self, propagator: &Propagator<V>, mut sample: usize) -> usize {
        let (system, excitation) = (self.system, self.excitation);
        let Some(dt_s) = excitation.dt_s else { return sample };
        let eighth = 0.125 * dt_s * dt_s;
        let norm = self.extremes.demand_norm();
        let [low, high] = self.bounds;
        let acceleration = excitation.acceleration.as_slice();
        let spring_n = system.stiffness_n_per_m * self.state.s();
        let demand = |a: f64, shear_n: f64| (system.block_mass_kg * a + spring_n) - shear_n;
        let mut held_n = {
            let f = system.restoring(self.state.eta(), self.state.eta_dot());
            demand(acceleration[sample], system.base_shear_n(f.as_ref()))
        };
        let mut normal = excitation.normal_at_sample(sample);
        let mut state = self.state.clone();
        let mut values = self.values(acceleration[sample], held_n);
        let mut bend = Bend::due();
        while let Some(&a1) = acceleration.get(sample + 1) {
            let next = propagator.stick(&state, [acceleration[sample], a1]);
            let next_normal = excitation.normal_at_sample(sample + 1);
            if bend.life == 0 {
                self.state.clone_from(&state);
                bend = Bend { norm: self.bend_at(sample, [0.0; 2]), life: BOUND_LIFE };
            } else {
                self.add_kink(&mut bend, sample);
            }
            let reach = eighth * bend.norm;
            let f = system.restoring(next.eta(), next.eta_dot());
            let shear = system.base_shear_n(f.as_ref());
            let holds_n = demand(a1, shear);
            let slack = reach * norm;
            let held = |demand: f64, normal: f64| {
                low * normal < demand - slack && demand + slack < high * normal
            };
            if !(held(held_n, normal) && held(holds_n, next_normal)) {
                break;
            }
            let (eta, s) = (next.eta(), next.s());
            let end = self.extremes.values(system, s, 0.0, eta, f.as_ref(), shear, a1, holds_n);
            if self.extremes.may_exceed(&values, &end, reach, Mode::Stick) {
                let (mode, state) = (Mode::Stick, &state);
                let place = Place { interval: sample, from_s: 0.0, length_s: dt_s, mode, state };
                self.extremes.keep(system, excitation, &values, &end, reach, &place);
            }
            if R::WANTED {
                self.state.clone_from(&state);
                self.record_sample(sample, Mode::Stick, true);
            }
            (values, normal, held_n, state) = (end, next_normal, holds_n, next);
            sample += 1;
        }
        self.state = state;
        sample
    }

    /// Within a sample the norm of `ẍ` does not grow; from one to the next it grows by the kink of
    /// the load.
    #[inline(always)]
    fn add_kink(&self, bend: &mut Bend, sample: usize) {
        let a = &self.excitation.acceleration[sample - 1..sample + 2];
        let kink = (a[2] - a[1]) - (a[1] - a[0]);
        bend.norm += self.per_kink[0] * kink.abs();
        if let Some(n) = self.excitation.varying_normal() {
            let turn = (n[sample + 1] - n[sample]) - (n[sample] - n[sample - 1]);
            bend.norm += self.per_kink[1] * turn.abs();
        }
        bend.life -= 1;
    }
    /// Norm of `ẍ` at the start of a sample.
    fn bend_at(&self, sample: usize, friction: [f64; 2]) -> f64 {
        let system = self.system;
        let n = system.storeys();
        let l = system.participation.as_ref();
        let over_dt = self.excitation.dt_s.map_or(0.0, |dt_s| 1.0 / dt_s);
        let a = &self.excitation.acceleration;
        let (a0, jerk) = (a[sample], (a[sample + 1] - a[sample]) * over_dt);
        let rate = (friction[1] - friction[0]) * over_dt;
        let x = &self.state;
        let f = system.restoring(x.eta(), x.eta_dot());
        let slips = matches!(self.mode, Mode::Slip(_));
        let (u, w) =
            if slips { (self.u_in_slip(x, f.as_ref(), friction[0]), x.w()) } else { (a0, 0.0) };
        let s2 = u - a0;
        let mut eta2 = V::zeros(n);
        for (j, eta2) in eta2.as_mut().iter_mut().enumerate() {
            *eta2 = -(f.as_ref()[j] + l[j] * u);
        }
        let f1 = system.restoring(x.eta_dot(), eta2.as_ref());
        let u1 = if slips {
            let spring = system.stiffness_n_per_m * w + system.damper_n_s_per_m * s2;
            (rate - spring + system.base_shear_n(f1.as_ref())) / system.block_mass_kg
        } else {
            jerk
        };
        let mut eta3 = V::zeros(n);
        for (j, eta3) in eta3.as_mut().iter_mut().enumerate() {
            *eta3 = -(f1.as_ref()[j] + l[j] * u1);
        }
        system.energy_norm(s2, u1 - jerk, eta2.as_ref(), eta3.as_ref())
    }
}
