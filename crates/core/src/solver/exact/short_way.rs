//! The short way through ordinary samples: one propagator, and a bound that vouches for the rest.

use super::Run;
use crate::friction::Direction;
use crate::linear::{PerStorey, Propagator};
use crate::response::Mode;
use crate::solver::extremes::Place;
use crate::solver::recorder::Recorder;

/// Samples after which the bound on `ẍ` is made anew from the state.
const BOUND_LIFE: u32 = 16;

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
        let last = excitation.acceleration.len() - 1;
        let [n0, _] = if sample < last { excitation.normal_n(sample) } else { [0.0; 2] };
        if !(n0 >= 0.0) {
            return sample;
        }
        let mut values = self.values(excitation.acceleration[sample], coefficient * n0);
        while sample < last {
            let [n0, n1] = excitation.normal_n(sample);
            let a = [excitation.acceleration[sample], excitation.acceleration[sample + 1]];
            let friction = [coefficient * n0, coefficient * n1];
            let next = propagator.slip(&self.state, a, friction);
            let reach = eighth * self.bend(sample, friction);
            let least = (sign * self.state.w()).min(sign * next.w());
            if !(least > reach * norm && n1 >= 0.0) {
                break;
            }
            let f = system.restoring(next.eta(), next.eta_dot());
            let u = self.u_in_slip(&next, f.as_ref(), friction[1]);
            let (eta, w, s) = (next.eta(), next.w(), next.s());
            let end = self.extremes.values(system, s, w, eta, f.as_ref(), u, friction[1]);
            if self.extremes.may_exceed(&values, &end, reach, mode) {
                let place = Place {
                    interval: sample,
                    from_s: 0.0,
                    length_s: dt_s,
                    mode,
                    state: &self.state,
                };
                self.extremes.keep(system, excitation, &values, &end, reach, &place);
            }
            if R::WANTED {
                self.record_sample(sample, mode, true);
            }
            values = end;
            self.state = next;
            sample += 1;
        }
        sample
    }

    fn short_stick(&mut self, propagator: &Propagator<V>, mut sample: usize) -> usize {
        let (system, excitation) = (self.system, self.excitation);
        let Some(dt_s) = excitation.dt_s else { return sample };
        let eighth = 0.125 * dt_s * dt_s;
        let norm = self.extremes.demand_norm();
        let [low, high] = self.bounds;
        let last = excitation.acceleration.len() - 1;
        let spring_n = system.stiffness_n_per_m * self.state.s();
        let demand =
            |a: f64, f: &[f64]| system.block_mass_kg * a + spring_n - system.base_shear_n(f);
        let a0 = excitation.acceleration[sample];
        let f0 = system.restoring(self.state.eta(), self.state.eta_dot());
        let mut held_n = demand(a0, f0.as_ref());
        let mut values = self.values(a0, held_n);
        while sample < last {
            let [n0, n1] = excitation.normal_n(sample);
            let a = [excitation.acceleration[sample], excitation.acceleration[sample + 1]];
            let next = propagator.stick(&self.state, a);
            let reach = eighth * self.bend(sample, [0.0; 2]);
            let f = system.restoring(next.eta(), next.eta_dot());
            let holds_n = demand(a[1], f.as_ref());
            let slack = reach * norm;
            let held = |demand: f64, normal: f64| {
                low * normal < demand - slack && demand + slack < high * normal
            };
            if !(held(held_n, n0) && held(holds_n, n1)) {
                break;
            }
            let (eta, s) = (next.eta(), next.s());
            let end = self.extremes.values(system, s, 0.0, eta, f.as_ref(), a[1], holds_n);
            if self.extremes.may_exceed(&values, &end, reach, Mode::Stick) {
                let place = Place {
                    interval: sample,
                    from_s: 0.0,
                    length_s: dt_s,
                    mode: Mode::Stick,
                    state: &self.state,
                };
                self.extremes.keep(system, excitation, &values, &end, reach, &place);
            }
            if R::WANTED {
                self.record_sample(sample, Mode::Stick, true);
            }
            (values, held_n) = (end, holds_n);
            self.state = next;
            sample += 1;
        }
        sample
    }

    /// Bound on the norm of `ẍ` over a whole sample. Within a sample it does not grow; from one to
    /// the next it grows by the kink of the load.
    #[inline(always)]
    fn bend(&mut self, sample: usize, friction: [f64; 2]) -> f64 {
        if self.bend_life == 0 {
            self.bend = self.bend_at(sample, friction);
            self.bend_life = BOUND_LIFE;
        } else {
            let a = &self.excitation.acceleration;
            let kink = (a[sample + 1] - a[sample]) - (a[sample] - a[sample - 1]);
            let [n_before, n_here] = self.excitation.normal_n(sample - 1);
            let [_, n_after] = self.excitation.normal_n(sample);
            let turn = (n_after - n_here) - (n_here - n_before);
            self.bend += self.per_kink[0] * kink.abs() + self.per_kink[1] * turn.abs();
        }
        self.bend_life -= 1;
        self.bend
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
