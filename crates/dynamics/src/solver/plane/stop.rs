//! Where a slip comes to rest, and what happens to the direction of friction there.

use super::mass::STRAIGHT;
use super::system::{Loads, State, System};
use super::vector::{cross, inner, norm};

/// A path below which a slip has stopped, in m.
const NO_PATH_M: f64 = 1e-22;

/// A bound on the path beyond which the way to rest of a block with a mass in each direction is not followed.
const MASSIVE_PATH_M: f64 = 1e2 * NO_PATH_M;

/// Part of friction by which a push may change over the last turn: of one mass, and of one in each direction.
const STANDS: [f64; 2] = [1e-11, 1e-12];

/// Parts of an arc that are looked at.
const LOOKS: usize = 32;

/// Part of the peak of the speed in a slip below which a block rests.
pub(super) const REST: f64 = 1e-14;

/// How a slip goes on from an instant.
pub(super) struct Instant {
    pub(super) speed: f64,
    /// `P` and `p`.
    pub(super) pull: [f64; 2],
    pub(super) push: [f64; 2],
    /// `f`, between which two it is down to rest, and `μ_s N/M1`.
    pub(super) friction: f64,
    to_rest: [f64; 2],
    pub(super) holds: f64,
}

impl Instant {
    /// Of a state under loads; leaves `g` behind.
    pub(super) fn new(system: &System, state: &State, loads: &Loads, g: &mut [f64]) -> Self {
        let pull = state.pull(system, loads, g);
        let speed = norm(state.w);
        let law = &system.kinetic_per_kg;
        let friction = law.force(speed, loads.normal[0]);
        let to_rest = law.range_up_to(speed).map(|mu| mu * law.pressing_n(loads.normal[0]));
        Self {
            speed,
            pull,
            push: loads.push(system, pull),
            friction,
            to_rest,
            holds: system.hold.radius(loads.normal[0]),
        }
    }

    /// With `p` frozen the block stops after `Θ = (f r + p·w)/(f² − p²)`, having moved by less than [`NO_PATH_M`];
    /// and `|p| < f` on all of `[t, t + r/(f − p)]` shows that it stops. None where one of both fails.
    pub(super) fn time_to_rest(
        &self,
        system: &System,
        state: &State,
        loads: &Loads,
        g: &[f64],
    ) -> Option<f64> {
        let (p, [f, most], r) = (norm(self.push), self.to_rest, self.speed);
        if !(p < f) {
            return None;
        }
        let [compliance, inertia] = system.stretches();
        // d|w|_Ĉ/dt ≤ −(f − p)/√λ, λ the largest eigenvalue of Ĉ.
        let longest_s = inertia * (r / (f - p));
        let known_s = match &system.mass {
            None => Some((f * r + inner(self.push, state.w)) / ((f - p) * (f + p))),
            Some(_) if !(r * longest_s < MASSIVE_PATH_M) => return None,
            Some(_) => None,
        };
        // d|w|/dt ≥ −λ (f + p), λ the largest eigenvalue of C.
        if !(r * known_s.unwrap_or(r / (compliance * (f + p))) < NO_PATH_M) {
            return None;
        }
        let per_n = most / loads.normal[0];
        let of_friction = per_n * loads.normal[1].abs();
        let rate =
            2.0 * inertia * compliance * self.rate_of_push(system, state, loads, g) + of_friction;
        // What friction does in all directions of the last turn is told by the push at both of its ends, or, of a block with
        // a mass in each direction, at rest alone, which it may be a while from.
        let lasts = match known_s {
            Some(time_s) => rate * time_s < STANDS[0] * f,
            None => rate * longest_s < STANDS[1] * f,
        };
        if !(lasts && p + rate * longest_s < f) {
            return None;
        }
        // Last, as it takes thousands of steps: the way to rest with a mass in each direction.
        let time_s = match &system.mass {
            Some(mass) => mass.time_to_rest(state.w, self.push, f),
            None => known_s?,
        };
        (r * time_s < NO_PATH_M).then_some(time_s.max(0.0))
    }

    /// A bound on `|ṗ|` over times in which nothing but the direction of `w` changes: there `|b| ≤ |P| + f`.
    fn rate_of_push(&self, system: &System, state: &State, loads: &Loads, g: &[f64]) -> f64 {
        let modes = system.modes();
        let [compliance, inertia] = system.stretches();
        let largest = compliance * (norm(self.pull) + self.to_rest[1]);
        let mut bound = 0.0;
        let mut of_rates = vec![0.0; modes];
        let forces: Vec<f64> = (0..modes)
            .map(|j| {
                let l = [system.participation[0][j], system.participation[1][j]];
                g[j].abs() + norm(l) * largest
            })
            .collect();
        system.restoring(&state.rate, &vec![0.0; modes], &mut of_rates);
        let stop = system.stop_per_kg(state.contact);
        let [stiffness, damper] = stop.map(|x| x * system.block_kg);
        let mut of_forces = vec![0.0; modes];
        system.restoring(&vec![0.0; modes], &forces, &mut of_forces);
        for axis in 0..2 {
            let l = &system.participation[axis];
            let shear: f64 =
                (0..modes).map(|j| l[j].abs() * (of_rates[j].abs() + of_forces[j].abs())).sum();
            let springs = system.stiffness_n_per_m + loads.normal[0] * system.per_radius;
            let slider = (springs + stiffness) * state.w[axis].abs()
                + (loads.normal[1] * system.per_radius * state.s[axis]).abs()
                + (system.damper_n_s_per_m + damper) * (largest + loads.table[axis][0].abs());
            bound += (shear + slider) / system.block_kg + inertia * loads.table[axis][1].abs();
        }
        bound
    }

    /// Whether the block passes rest so close that it is none but rounding that tells from it.
    pub(super) fn is_at_rest(&self, w: [f64; 2], peak_speed: f64) -> bool {
        self.speed <= REST * peak_speed && inner(w, self.push) < self.friction * self.speed
    }

    /// Directions that friction has on the arc at a stop, from that of `w` to that of `p` at rest; in straight
    /// motion the first alone.
    pub(super) fn arc(&self, system: &System, w: [f64; 2], at_rest: &Self) -> Arc {
        let (p, push) = (norm(at_rest.push), at_rest.push);
        let from = w.map(|w| w / self.speed);
        let to = match &system.mass {
            Some(mass) => {
                let f = at_rest.friction;
                match mass.is_straight(from, push, f) {
                    true => from,
                    false if p < f => mass.last_direction(from, push, f),
                    false => system.departure(push, f),
                }
            }
            None => {
                let is_straight =
                    inner(w, push) < 0.0 && cross(w, push).abs() < STRAIGHT * (self.speed * p);
                if p == 0.0 || is_straight { from } else { push.map(|x| x / p) }
            }
        };
        Arc { from, to, push: p, friction: at_rest.friction }
    }
}

/// The shorter arc between two directions.
pub(super) struct Arc {
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
    /// `|p|` and `f`.
    push: f64,
    pub(super) friction: f64,
}

impl Arc {
    /// Whether a direction is on it.
    fn holds(&self, u: [f64; 2]) -> bool {
        let turn = cross(self.from, self.to);
        let middle = [self.from[0] + self.to[0], self.from[1] + self.to[1]];
        cross(self.from, u) * turn > 0.0 && cross(u, self.to) * turn > 0.0 && inner(u, middle) > 0.0
    }

    /// The part of the time to rest that is left at a direction: `Θ ~ r (f + p cos φ)`,
    /// `r ~ tan(φ/2)^κ / sin φ`, `κ = f/p`.
    pub(super) fn part_left(&self, u: [f64; 2]) -> f64 {
        let of = |u: [f64; 2]| {
            let (cosine, sine) = (inner(u, self.to), cross(u, self.to).abs());
            // tan(φ/2) = sin φ/(1 + cos φ)
            (sine / (1.0 + cosine), sine, self.friction + self.push * cosine)
        };
        let [(tangent, sine, factor), (first, of_first, first_factor)] = [of(u), of(self.from)];
        let ratio = libm::pow(tangent / first, self.friction / self.push) * (of_first / sine);
        let left = ratio * (factor / first_factor);
        if left.is_finite() { left.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// The largest of a function of the direction on it, where that is no vector less a multiple of it.
    pub(super) fn largest(&self, of: impl Fn([f64; 2]) -> f64) -> f64 {
        let turn = libm::atan2(cross(self.from, self.to), inner(self.from, self.to));
        let at = |part: f64| {
            let (sine, cosine) = (libm::sin(part * turn), libm::cos(part * turn));
            let [x, y] = self.from;
            of([cosine * x - sine * y, sine * x + cosine * y])
        };
        let step = 1.0 / LOOKS as f64;
        let values: Vec<f64> = (0..=LOOKS).map(|i| at(step * i as f64)).collect();
        let better = |best: usize, i: usize| if values[i] > values[best] { i } else { best };
        let best = (1..=LOOKS).fold(0, better);
        let [mut low, mut high] =
            [best.saturating_sub(1), (best + 1).min(LOOKS)].map(|i| step * i as f64);
        let mut most = values[best];
        for _ in 0..60 {
            let [a, b] = [0.4, 0.6].map(|part| low + (high - low) * part);
            let [of_a, of_b] = [at(a), at(b)];
            most = most.max(of_a).max(of_b);
            if of_a > of_b { high = b } else { low = a }
        }
        most
    }

    /// Directions within it at which `A − c u` is extreme: `−A/|A|`, and ±x, ±y.
    pub(super) fn extremes(&self, a: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
        let size = norm(a);
        let against = (size > 0.0).then(|| a.map(|a| -a / size));
        let axes = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        against.into_iter().chain(axes).filter(|u| self.holds(*u))
    }
}
