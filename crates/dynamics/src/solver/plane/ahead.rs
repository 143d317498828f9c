//! Sticks over whole samples: each mode by its map, as far as bounds show that nothing happens in them.
//!
//! Where `ε = η − η_p` with the motion `η_p` that is linear in the time under a linear load, `ε̇² + ω² ε²` does not grow, so that
//! with `R` its root at the start of a sample
//!
//! ```text
//! |η̈| = |ε̈| ≤ (ω + d) R        |η⃛| = |ε⃛| ≤ (ω² + d (ω + d)) R
//! |g̈| = |ε⁗| ≤ (ω² (ω + d) + d (ω² + d (ω + d))) R
//! ```
//!
//! and no output departs by more from the chord between the ends of the sample than an eighth of `h²` times the sum of these.
//! What that does not exclude is left to the series.

use super::Plane;
use super::peaks::StickEnd;
use super::rows::{PointsBetween, size_of_sum};
use super::system::{State, System};
use super::vector::{inner, norm};
use crate::error::SolveError;
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;
use crate::response::Mode;
use crate::solver::phase::{Advance, Phase};
use crate::solver::walk::Walk;

/// Part of the bound up to which a push has certainly not reached it.
const WITHIN: f64 = 1.0 - 1e-9;

/// Terms of a Taylor series over a radian.
const TERMS: usize = 20;

/// How modes go through a sample of a stick.
pub(super) struct Ahead {
    instructions: InstructionSet,
    step_s: f64,
    modes: Vec<Map>,
    /// How far `η`, `η̇` and `g` of each mode depart from their chords at most.
    bends: [Vec<f64>; 3],
    /// `η`, `η̇` and `g` at the end of a sample.
    eta: Vec<f64>,
    rate: Vec<f64>,
    g: Vec<f64>,
    points: PointsBetween,
    /// Whether it is known what points do at the start: after another sample.
    is_known: bool,
}

/// The map of a mode over a sample, of `(η, η̇)`, of the load `−L·a` at its start and of the rate of that.
#[derive(Clone, Copy)]
struct Map {
    of_state: [[f64; 2]; 2],
    of_load: [f64; 2],
    of_rate: [f64; 2],
    omega2: f64,
    damping: f64,
    /// Factors on `R`.
    bends: [f64; 3],
}

impl Map {
    fn new(step_s: f64, omega2: f64, damping: f64) -> Self {
        let omega = omega2.sqrt();
        let parts = ((omega + damping) * step_s).ceil().max(1.0);
        let part_s = step_s / parts;
        let part = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
        .map(|[eta, rate, load, load_rate]| {
            let (mut term, mut sum) = ([eta, rate], [eta, rate]);
            for k in 0..TERMS {
                let per = part_s / (k + 1) as f64;
                let load = match k {
                    0 => load,
                    1 => load_rate * part_s,
                    _ => 0.0,
                };
                term = [per * term[1], per * (load - omega2 * term[0] - damping * term[1])];
                sum = [sum[0] + term[0], sum[1] + term[1]];
            }
            sum
        });
        let [of_eta, of_eta_rate, of_load, of_rate] = part;
        let through = |x: [f64; 2]| [0, 1].map(|i| of_eta[i] * x[0] + of_eta_rate[i] * x[1]);
        let mut map = Self {
            of_state: [[1.0, 0.0], [0.0, 1.0]],
            of_load: [0.0; 2],
            of_rate: [0.0; 2],
            omega2,
            damping,
            bends: [0.0; 3],
        };
        let mut columns = [[1.0, 0.0], [0.0, 1.0]];
        for i in 0..parts as usize {
            columns = columns.map(through);
            let (load, rate) = (through(map.of_load), through(map.of_rate));
            let later = i as f64 * part_s;
            map.of_load = [0, 1].map(|k| load[k] + of_load[k]);
            map.of_rate = [0, 1].map(|k| rate[k] + of_rate[k] + later * of_load[k]);
        }
        map.of_state = [0, 1].map(|i| [columns[0][i], columns[1][i]]);
        let (eighth, sum) = (0.125 * step_s * step_s, omega + damping);
        let of_third = omega2 + damping * sum;
        map.bends = [sum, of_third, omega2 * sum + damping * of_third].map(|of| eighth * of);
        map
    }

    /// `R` of a state under a load.
    #[inline(always)]
    fn size(&self, [eta, rate]: [f64; 2], [load, load_rate]: [f64; 2]) -> f64 {
        let per = 1.0 / self.omega2;
        let off = eta - per * (load - self.damping * per * load_rate);
        let off_rate = rate - per * load_rate;
        (off_rate * off_rate + self.omega2 * (off * off)).sqrt()
    }

    #[inline(always)]
    fn through(&self, [eta, rate]: [f64; 2], [load, load_rate]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| {
            let [of_eta, of_rate] = self.of_state[i];
            (of_eta * eta + of_rate * rate) + (self.of_load[i] * load + self.of_rate[i] * load_rate)
        })
    }
}

impl Ahead {
    /// Of samples that are evenly spaced; none where dampers couple the modes, or one has no stiffness.
    pub(super) fn new(
        system: &System,
        instructions: InstructionSet,
        step_s: Option<f64>,
    ) -> Option<Self> {
        let [omega2, damping] = system.uncoupled()?;
        let step_s = step_s.filter(|_| omega2.iter().all(|omega2| *omega2 > 0.0))?;
        let modes = omega2.iter().zip(damping).map(|(o, d)| Map::new(step_s, *o, *d)).collect();
        let list = || vec![0.0; omega2.len()];
        Some(Self {
            instructions,
            step_s,
            modes,
            bends: [list(), list(), list()],
            eta: list(),
            rate: list(),
            g: list(),
            points: PointsBetween::new(system.points),
            is_known: false,
        })
    }

    /// What points do over a sample that begins with a state and `g`.
    #[inline(always)]
    fn look_at_points(&mut self, system: &System, (state, g): (&State, &[f64])) {
        let start = (!self.is_known).then_some([&*state.eta, &*state.rate, g]);
        self.points.follow(system, start, [&self.eta, &self.rate, &self.g], &self.bends);
    }
}

/// Goes on through samples of a stick, as far as nothing is in doubt.
pub(super) fn run_ahead<'a>(
    walk: &mut Walk<'a, Plane<'a>>,
    [mut sample, end]: [usize; 2],
) -> Result<Advance, SolveError> {
    let Some(mut ahead) = walk.phase.ahead.take() else { return Ok(Advance { sample, at_s: 0.0 }) };
    let mut done = Ok(());
    ahead.is_known = false;
    while walk.course.block.mode == Mode::Stick && !walk.phase.is_released && sample < end {
        done = walk.pulse.tick(walk.units);
        if done.is_err() || !walk.phase.passes(&mut ahead, sample) {
            break;
        }
        if walk.phase.records() {
            walk.phase.record_sample(&walk.course, sample, true);
        }
        let state = &mut walk.phase.state;
        core::mem::swap(&mut state.eta, &mut ahead.eta);
        core::mem::swap(&mut state.rate, &mut ahead.rate);
        ahead.points.ends.swap(0, 1);
        ahead.is_known = true;
        walk.phase.scales.note(&walk.phase.state);
        walk.phase.least.interrupt();
        sample += 1;
    }
    walk.phase.ahead = Some(ahead);
    done?;
    Ok(Advance { sample, at_s: 0.0 })
}

impl Plane<'_> {
    /// Follows a sample of a stick; whether it is certain that nothing happens in it, no peak either.
    fn passes(&mut self, ahead: &mut Ahead, sample: usize) -> bool {
        let (system, state) = (&self.system, &self.state);
        if system.bears_on(state.contact).is_some() {
            return false;
        }
        let [from, to] = [sample, sample + 1].map(|i| {
            let normal_n = self.ground.normal_at(i);
            ([self.ground.acceleration[i], self.along_y.acceleration[i]], normal_n)
        });
        let per_s = 1.0 / ahead.step_s;
        let change = [0, 1].map(|k| per_s * (to.0[k] - from.0[k]));
        for (j, map) in ahead.modes.iter().enumerate() {
            let l = system.participation_of(j);
            let load = [-inner(l, from.0), -inner(l, change)];
            let of = [state.eta[j], state.rate[j]];
            let size = map.size(of, load);
            [ahead.eta[j], ahead.rate[j]] = map.through(of, load);
            ahead.g[j] = map.omega2 * ahead.eta[j] + map.damping * ahead.rate[j];
            for (bends, factor) in ahead.bends.iter_mut().zip(map.bends) {
                bends[j] = factor * size;
            }
        }
        let g = &mut self.g;
        system.restoring(&state.eta, &state.rate, g);
        let stopped = system.stopped(state);
        let end = |(table, normal_n): ([f64; 2], f64), g| {
            let shear_n = system.shear_n(g);
            let pull = [0, 1].map(|k| {
                let pressed = normal_n * state.s[k];
                system.pull(shear_n[k], state.s[k], 0.0, pressed) - stopped[k]
            });
            StickEnd { table, pull, push: system.push(pull, table), shear_n, g }
        };
        let ends = [end(from, g), end(to, &ahead.g)];
        let bend_n = system.participation.each_ref().map(|l| size_of_sum(l, &ahead.bends[2]));
        let bend = bend_n.map(|bend| bend / system.block_kg);
        let hold = system.hold.radius(from.1.min(to.1));
        let largest = norm(ends[0].push).max(norm(ends[1].push)) + norm(bend);
        let [first, last] = &ends;
        if !(hold > 0.0
            && largest < WITHIN * hold
            && self.peaks.hold_in_stick(system, [first, last], (bend_n, &ahead.bends[2])))
        {
            return false;
        }
        if system.points == 0 {
            return true;
        }
        vectorize!(ahead.instructions, _simd => ahead.look_at_points(system, (state, g)));
        self.peaks.hold_at_points(system, [from.0, to.0], &ahead.points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mode under a load that grows: the closed form, and no way off the chord farther than the bound.
    #[test]
    fn a_mode_goes_as_its_closed_form() {
        for (omega, ratio, step_s) in
            [(3.0_f64, 0.02, 0.01), (60.0, 0.0, 0.05), (400.0, 0.3, 0.02), (2.0, 1.5, 0.4)]
        {
            let (omega2, damping) = (omega * omega, 2.0 * ratio * omega);
            let (start, load) = ([0.01, -0.2], [0.7, 30.0]);
            // η_p + e^(−a t) (c cos νt + d sin νt), ν² = ω² − a², or with hyperbolic functions.
            let closed = |t: f64| {
                let a = 0.5 * damping;
                let first = (load[0] - damping * load[1] / omega2) / omega2;
                let (off, off_rate) = (start[0] - first, start[1] - load[1] / omega2);
                let square: f64 = omega2 - a * a;
                let nu = square.abs().sqrt();
                let (cosine, sine) = match square > 0.0 {
                    true => (libm::cos(nu * t), libm::sin(nu * t)),
                    false => (libm::cosh(nu * t), libm::sinh(nu * t)),
                };
                let free = libm::exp(-a * t) * (off * cosine + (off_rate + a * off) / nu * sine);
                first + load[1] / omega2 * t + free
            };
            let map = Map::new(step_s, omega2, damping);
            let [end, _] = map.through(start, load);
            let scale = start[0].abs() + start[1].abs() / omega + load[0].abs() / omega2;
            assert!((end - closed(step_s)).abs() <= 2e-14 * scale, "{omega}: {end}");
            let bend = map.bends[0] * map.size(start, load);
            for i in 1..20 {
                let part = f64::from(i) / 20.0;
                let eta = closed(part * step_s);
                let chord = start[0] + part * (end - start[0]);
                assert!((eta - chord).abs() <= bend * (1.0 + 1e-12), "{omega} at {part}");
            }
        }
    }
}
