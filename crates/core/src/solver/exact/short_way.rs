//! The short way through ordinary samples: one propagator, and a bound that vouches for the rest.

use super::Run;
use crate::friction::Direction;
use crate::linear::{PerStorey, Propagator, State};
use crate::response::Mode;
use crate::solver::extremes::{Place, tracked};
use crate::solver::recorder::Recorder;

/// Samples for which a bound on `ẍ` serves.
const BOUND_LIFE: usize = 8;

impl<V: PerStorey, R: Recorder<V>> Run<'_, V, R> {
    /// Takes whole samples while the bounds show that nothing happens in them; the first sample
    /// that they do not vouch for.
    pub(super) fn short_way(&mut self, mut sample: usize) -> usize {
        let Some(propagators) = self.propagators.take() else { return sample };
        if self.start.is_none() {
            let excitation = self.excitation;
            sample = match excitation.varying_normal() {
                Some(normal) => self.short(&propagators, sample, |i| normal[i]),
                None => {
                    let normal = excitation.normal_at_sample(0);
                    self.short(&propagators, sample, |_| normal)
                }
            };
        }
        self.propagators = Some(propagators);
        sample
    }

    fn short(
        &mut self,
        [stick, slip]: &[Propagator<V>; 2],
        sample: usize,
        normal: impl Fn(usize) -> f64,
    ) -> usize {
        match self.mode {
            Mode::Stick => self.walk_short::<false>(stick, Direction::Positive, sample, normal),
            Mode::Slip(direction) => self.walk_short::<true>(slip, direction, sample, normal),
        }
    }

    fn walk_short<const SLIP: bool>(
        &mut self,
        propagator: &Propagator<V>,
        direction: Direction,
        mut sample: usize,
        normal: impl Fn(usize) -> f64,
    ) -> usize {
        let excitation = self.excitation;
        let Some(dt_s) = excitation.dt_s else { return sample };
        let mode = if SLIP { Mode::Slip(direction) } else { Mode::Stick };
        let acceleration: &[f64] = &excitation.acceleration;
        let last = excitation.regular_end(sample);
        let coefficient = excitation.kinetic(direction);
        let [low, high] = self.bounds;
        let sign = direction.sign();
        let event_norm = self.extremes.event_norm(mode);
        // The state stays in registers; it is written back at the end.
        let mut state = self.state.clone();
        let mut life = BOUND_LIFE;
        while sample < last {
            let (from, end) = (sample, last.min(sample + life));
            let reach = 0.125 * dt_s * dt_s * self.bend(&state, from, end);
            let slack = reach * event_norm;
            // Friction holds, or the block slides, by more than a chord can hide.
            let clear = |values: &V::Tracked, normal: f64| {
                let values = values.as_ref();
                if SLIP {
                    sign * values[tracked::VELOCITY] > slack && normal >= 0.0
                } else {
                    let demand = values[tracked::FRICTION];
                    low * normal < demand - slack && demand + slack < high * normal
                }
            };
            let mut limits = self.extremes.limits(reach, mode);
            let start_n = normal(sample);
            let values = self.values(&state, mode, acceleration[sample], coefficient * start_n);
            let mut quiet = limits.hold(&values);
            if clear(&values, start_n) {
                while sample < end {
                    let a = [acceleration[sample], acceleration[sample + 1]];
                    let normal = [normal(sample), normal(sample + 1)];
                    let next = if SLIP {
                        propagator.slip(&state, a, normal.map(|n| coefficient * n))
                    } else {
                        propagator.stick(&state, a)
                    };
                    let values = self.values(&next, mode, a[1], coefficient * normal[1]);
                    if !clear(&values, normal[1]) {
                        break;
                    }
                    let next_quiet = limits.hold(&values);
                    if !(quiet && next_quiet) {
                        self.keep_sample(sample, mode, state.clone(), values.clone());
                        limits = self.extremes.limits(reach, mode);
                        quiet = limits.hold(&values);
                    }
                    if R::WANTED {
                        self.state.clone_from(&state);
                        self.record_sample(sample, mode, true);
                    }
                    state = next;
                    sample += 1;
                }
            }
            // A failure is tried again with a bound for this sample alone.
            if sample == end {
                life = BOUND_LIFE;
            } else if life == 1 {
                break;
            } else {
                life = 1;
            }
        }
        self.state = state;
        sample
    }

    /// Shows a sample to the extremes, by the bound for it alone.
    #[inline(never)]
    fn keep_sample(&mut self, sample: usize, mode: Mode, state: State<V>, end: V::Tracked) {
        let excitation = self.excitation;
        let Some(dt_s) = excitation.dt_s else { return };
        let reach = 0.125 * dt_s * dt_s * self.bend(&state, sample, sample + 1);
        let friction_n = self.kinetic_n(mode, excitation.normal_at_sample(sample));
        let start = self.values(&state, mode, excitation.acceleration[sample], friction_n);
        let place = Place { interval: sample, from_s: 0.0, length_s: dt_s, mode, state: &state };
        self.extremes.keep(self.system, excitation, &start, &end, reach, &place);
    }

    /// Bound on the norm of `ẍ` over whole samples from a state: within a sample the norm does not
    /// grow; from one to the next it grows by the kink of the load.
    #[inline(always)]
    fn bend(&self, state: &State<V>, from: usize, end: usize) -> f64 {
        let kinks = |x: &[f64]| {
            let mut sum = 0.0;
            for x in x[from..=end].windows(3) {
                sum += ((x[2] - x[1]) - (x[1] - x[0])).abs();
            }
            sum
        };
        let mut bend = self.bend_at(state, from);
        bend += self.per_kink[0] * kinks(&self.excitation.acceleration);
        if let Some(normal) = self.excitation.varying_normal() {
            bend += self.per_kink[1] * kinks(normal);
        }
        bend
    }

    /// Norm of `ẍ` at the start of a sample.
    #[inline(always)]
    fn bend_at(&self, x: &State<V>, sample: usize) -> f64 {
        let (system, excitation) = (self.system, self.excitation);
        let n = system.storeys();
        let l = system.participation.as_ref();
        let over_dt = excitation.dt_s.map_or(0.0, |dt_s| 1.0 / dt_s);
        let change = |x: [f64; 2]| (x[1] - x[0]) * over_dt;
        let a = [excitation.acceleration[sample], excitation.acceleration[sample + 1]];
        let friction = excitation.normal_n(sample).map(|normal| self.kinetic_n(self.mode, normal));
        let (jerk, rate) = (change(a), change(friction));
        // The derivative of the state, then the derivative of that.
        let f = system.restoring(x.eta(), x.eta_dot());
        let u = match self.mode {
            Mode::Stick => a[0],
            Mode::Slip(_) => {
                let shear_n = system.base_shear_n(f.as_ref());
                system.block_acceleration(x.s(), x.w(), shear_n, friction[0])
            }
        };
        let mut eta2 = V::zeros(n);
        for (j, eta2) in eta2.as_mut().iter_mut().enumerate() {
            *eta2 = -(f.as_ref()[j] + l[j] * u);
        }
        let f = system.restoring(x.eta_dot(), eta2.as_ref());
        let u_dot = match self.mode {
            Mode::Stick => jerk,
            Mode::Slip(_) => {
                let shear_n = system.base_shear_n(f.as_ref());
                system.block_acceleration(x.w(), u - a[0], shear_n, rate)
            }
        };
        let mut eta3 = V::zeros(n);
        for (j, eta3) in eta3.as_mut().iter_mut().enumerate() {
            *eta3 = -(f.as_ref()[j] + l[j] * u_dot);
        }
        system.energy_norm(u - a[0], u_dot - jerk, eta2.as_ref(), eta3.as_ref())
    }
}
