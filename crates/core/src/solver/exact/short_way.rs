//! The short way through ordinary samples: one propagator, and a bound that vouches for the rest.

use core::ops::Range;

use super::Run;
use crate::friction::Direction;
use crate::linear::{PerStorey, Propagator, State};
use crate::response::Mode;
use crate::solver::extremes::{Limits, Place, StickLimits, tracked};
use crate::solver::recorder::Recorder;

/// Samples for which a bound on `ẍ` serves.
const BOUND_LIFE: usize = 16;

/// Samples that are shown to the extremes as one piece.
const LEAP: usize = 4;

/// Limits within which ordinary motion shows nothing new.
struct Watch<V: PerStorey> {
    /// At the ends of a leap.
    leap: Limits<V>,
    /// At every sample of stick.
    stick: StickLimits,
}

impl<V: PerStorey, R: Recorder<V>> Run<'_, V, R> {
    /// Takes whole samples while the bounds show that nothing happens in them; the first sample
    /// that they do not vouch for.
    pub(super) fn short_way(&mut self, sample: usize) -> usize {
        let (excitation, normal) = (self.excitation, self.excitation.normal_at_sample(sample));
        match (self.propagators, self.start, excitation.varying_normal()) {
            (Some(propagators), None, Some(normal)) => {
                self.short(propagators, sample, |i| normal[i])
            }
            (Some(propagators), None, None) => self.short(propagators, sample, move |_| normal),
            _ => sample,
        }
    }

    fn short(
        &mut self,
        [stick, slip]: &[Propagator<V>; 2],
        sample: usize,
        normal: impl Fn(usize) -> f64 + Copy,
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
        normal: impl Fn(usize) -> f64 + Copy,
    ) -> usize {
        let (system, excitation) = (self.system, self.excitation);
        let Some(dt_s) = excitation.dt_s else { return sample };
        let mode = if SLIP { Mode::Slip(direction) } else { Mode::Stick };
        let acceleration: &[f64] = &excitation.acceleration;
        let last = excitation.regular_end(sample);
        let (sign, coefficient) = (direction.sign(), excitation.kinetic(direction));
        let [low, high] = self.bounds;
        let event_norm = self.extremes.event_norm(mode);
        let s = self.state.s();
        let demand_n = |x: &State<V>, a: f64| {
            let f = system.restoring(x.eta(), x.eta_dot());
            if SLIP { 0.0 } else { system.demand_n(s, system.base_shear_n(f.as_ref()), a) }
        };
        // Whether the block slides, or friction holds, by more than a slack.
        let by = move |slack: f64, x: &State<V>, demand_n: f64, normal: f64| {
            if SLIP {
                sign * x.w() > slack && normal >= 0.0
            } else {
                low * normal + slack < demand_n && demand_n < high * normal - slack
            }
        };
        // The chord bound asks for a continuous derivative: where a load enters a tracked value
        // itself, its kinks at samples part the pieces. In stick such values are looked at sample
        // by sample.
        let loads_kink =
            if SLIP { excitation.varying_normal().is_some() } else { self.extremes.overturns() };
        let leap = if loads_kink { 1 } else { LEAP };
        let mut going = true;
        while going && sample < last {
            // The state stays in registers; it is written back after each leap.
            let mut state = self.state.clone();
            let end = last.min(sample + BOUND_LIFE);
            let reach = 0.125 * dt_s * dt_s * self.bend(&state, sample, end);
            let slack = reach * event_norm;
            let mut watch = self.watch::<SLIP>(reach, leap, mode);
            let a = acceleration[sample];
            let mut demand = demand_n(&state, a);
            let mut clear = by(slack, &state, demand, normal(sample));
            let kinetic_n = coefficient * normal(sample);
            let mut open = !self.quiet::<SLIP>(&watch, &state, mode, a, kinetic_n);
            while going && sample < end {
                let from = sample;
                for a in acceleration[sample..=end.min(sample + leap)].windows(2) {
                    let a = [a[0], a[1]];
                    let normal = [normal(sample), normal(sample + 1)];
                    let next = if SLIP {
                        propagator.slip(&state, a, normal.map(|n| coefficient * n))
                    } else {
                        propagator.stick(&state, a)
                    };
                    let next_demand = demand_n(&next, a[1]);
                    let next_clear = by(slack, &next, next_demand, normal[1]);
                    if !(clear && next_clear) {
                        // Once more by the bound for this sample alone, unless there is an event.
                        going = by(0.0, &next, next_demand, normal[1]) && {
                            let slack = event_norm * self.reach_alone(&state.clone(), sample);
                            by(slack, &state, demand, normal[0])
                                && by(slack, &next, next_demand, normal[1])
                        };
                        if !going {
                            break;
                        }
                    }
                    if !SLIP {
                        open |= !watch.stick.hold(next_demand, a[1]);
                    }
                    if R::WANTED {
                        self.record_at(&state.clone(), sample, mode, true);
                    }
                    (clear, demand, state) = (next_clear, next_demand, next);
                    sample += 1;
                }
                let (a, kinetic_n) = (acceleration[sample], coefficient * normal(sample));
                if open || !self.quiet::<SLIP>(&watch, &state, mode, a, kinetic_n) {
                    self.show(propagator, from..sample, mode, reach);
                    watch = self.watch::<SLIP>(reach, leap, mode);
                    open = !self.quiet::<SLIP>(&watch, &state, mode, a, kinetic_n);
                }
                self.state.clone_from(&state);
            }
        }
        sample
    }

    /// Limits for a leap of samples by a bound for one, `length²/8` times the norm of `ẍ`.
    #[inline(always)]
    fn watch<const SLIP: bool>(&self, reach: f64, leap: usize, mode: Mode) -> Watch<V> {
        let spring_n = self.system.stiffness_n_per_m * self.state.s();
        Watch {
            leap: self.extremes.limits(reach * (leap * leap) as f64, mode),
            stick: self.extremes.limits(reach, mode).stick(spring_n),
        }
    }

    /// Whether all values at an instant keep the limits.
    #[inline(always)]
    fn quiet<const SLIP: bool>(
        &self,
        watch: &Watch<V>,
        x: &State<V>,
        mode: Mode,
        a: f64,
        kinetic_n: f64,
    ) -> bool {
        let values = self.values(x, mode, a, kinetic_n);
        if SLIP {
            watch.leap.hold(&values)
        } else {
            watch.stick.hold(values.as_ref()[tracked::FRICTION], a)
                && watch.leap.hold_but::<true>(&values)
        }
    }

    /// Shows samples of ordinary motion from the present state to the extremes one by one.
    #[inline(never)]
    fn show(&mut self, propagator: &Propagator<V>, samples: Range<usize>, mode: Mode, reach: f64) {
        let (system, excitation) = (self.system, self.excitation);
        let Some(dt_s) = excitation.dt_s else { return };
        let load = |sample: usize| {
            let friction_n = excitation.kinetic_n(mode, excitation.normal_at_sample(sample));
            (excitation.acceleration[sample], friction_n)
        };
        let mut state = self.state.clone();
        let (mut a, mut friction_n) = load(samples.start);
        let mut start = self.values(&state, mode, a, friction_n);
        for sample in samples {
            let (next_a, next_n) = load(sample + 1);
            let next = match mode {
                Mode::Stick => propagator.stick(&state, [a, next_a]),
                Mode::Slip(_) => propagator.slip(&state, [a, next_a], [friction_n, next_n]),
            };
            let end = self.values(&next, mode, next_a, next_n);
            if self.extremes.take(&start, &end, reach, mode) {
                // Once more by the bound for this sample alone.
                let reach = self.reach_alone(&state, sample);
                if self.extremes.take(&start, &end, reach, mode) {
                    let state = &state;
                    let (interval, from_s, length_s) = (sample, 0.0, dt_s);
                    let place = Place { interval, from_s, length_s, mode, state };
                    self.extremes.keep(system, excitation, &start, &end, reach, &place);
                }
            }
            (a, friction_n, state, start) = (next_a, next_n, next, end);
        }
    }

    /// What a chord over one sample can hide of a quantity of dual norm 1.
    #[inline(never)]
    fn reach_alone(&self, state: &State<V>, sample: usize) -> f64 {
        let dt_s = self.excitation.dt_s.unwrap_or(0.0);
        0.125 * dt_s * dt_s * self.bend(state, sample, sample + 1)
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
        let friction =
            excitation.normal_n(sample).map(|normal| excitation.kinetic_n(self.mode, normal));
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
