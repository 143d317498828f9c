//! The structure with its contents in physical coordinates, and the Taylor series of its motion.

use core::slice;

use super::super::ground::Stretch;
use crate::linear::polynomial::{DEGREE, Polynomial, ZERO, value};
use crate::linear::{System, fading_part};
use crate::model::{Contents, Model};
use crate::response::Mode;
use crate::slider::{Coefficient, SlipForce};

/// Terms of a series below this part of the largest are below rounding.
const NEGLIGIBLE: f64 = 1e-18;

/// Masses, springs and dampers of block and floors, and what stands on them.
pub(super) struct Body {
    pub(super) block_kg: f64,
    pub(super) total_kg: f64,
    pub(super) masses_kg: Vec<f64>,
    pub(super) stiffnesses_n_per_m: Vec<f64>,
    /// Of a structure by its modes: what each oscillator adds to the points, point by point, and what of
    /// their motion is the block's. Its oscillators stand each on the block.
    pub(super) points: Option<(Vec<Vec<f64>>, Vec<f64>)>,
    /// `C` row by row.
    damping: Vec<f64>,
    /// What slides as one: items on one floor with the same coefficients, which start from rest and so
    /// always move alike.
    pub(super) contents: Vec<Contents>,
    /// Of each item of the model, what it is part of.
    pub(super) part_of: Vec<usize>,
    /// Bound on the rates of the structure on a block that slides free, in rad/s.
    pub(super) rate_rad_per_s: f64,
}

/// What a number of each kind there is of a state: of block over ground, floors over block, contents over their floors.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::solver) struct State<T = f64> {
    pub(super) s: T,
    pub(super) w: T,
    pub(super) q: Vec<T>,
    pub(super) v: Vec<T>,
    pub(super) r: Vec<T>,
    pub(super) p: Vec<T>,
}

impl<T> State<T> {
    fn lists(&self) -> [&[T]; 6] {
        let Self { s, w, q, v, r, p } = self;
        [slice::from_ref(s), slice::from_ref(w), q, v, r, p]
    }

    fn lists_mut(&mut self) -> [&mut [T]; 6] {
        let Self { s, w, q, v, r, p } = self;
        [slice::from_mut(s), slice::from_mut(w), q, v, r, p]
    }

    /// Its components, in the order in which they are declared.
    fn components(&self) -> impl Iterator<Item = &T> {
        self.lists().into_iter().flatten()
    }

    /// Gives each component what is made of that of another.
    #[inline(always)]
    fn follow<U>(&mut self, other: &State<U>, each: impl Fn(&mut T, &U)) {
        for (own, other) in self.lists_mut().into_iter().zip(other.lists()) {
            own.iter_mut().zip(other).for_each(|(own, other)| each(own, other));
        }
    }
}

impl State {
    /// Number of its components.
    pub(super) fn count(&self) -> usize {
        2 + 2 * self.q.len() + 2 * self.r.len()
    }

    /// Copies its components into a list.
    pub(super) fn get(&self, list: &mut [f64]) {
        list.iter_mut().zip(self.components()).for_each(|(x, own)| *x = *own);
    }

    /// Takes its components from such a list.
    pub(super) fn set(&mut self, list: &[f64]) {
        self.lists_mut().into_iter().flatten().zip(list).for_each(|(own, x)| *own = *x);
    }
}

/// Loads from an instant on, linear in the time after it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loads {
    /// `a = Ü + g sin θ` in m/s², and its rate.
    pub(super) acceleration: [f64; 2],
    /// `N` in N, and its rate.
    pub(super) normal: [f64; 2],
}

impl Loads {
    /// Loads of a stretch from `at_s` on.
    pub(super) fn at(stretch: &Stretch, at_s: f64) -> Self {
        Self {
            acceleration: [stretch.acceleration_at(at_s), stretch.acceleration_rate],
            normal: [stretch.normal_at(at_s), stretch.normal_rate],
        }
    }
}

/// What slides, and the force of the slider where it does.
#[derive(Clone, Copy)]
pub(super) struct InForce<'a> {
    /// The slider, then the contents.
    pub(super) modes: &'a [Mode],
    /// The force while the slider slides; what springs and stops do at rest, where it does not.
    pub(super) force: SlipForce,
}

/// The motion from an instant on, by powers of the time over `unit_s`.
#[derive(Clone, Debug)]
pub(in crate::solver) struct Expansion {
    /// Where it begins in its sample interval, and its unit.
    pub(super) from_s: f64,
    pub(super) unit_s: f64,
    pub(super) state: State<Polynomial>,
    /// Accelerations with the slope's share: ground, block, floors, contents.
    pub(super) ground: Polynomial,
    pub(super) u: Polynomial,
    pub(super) floors: Vec<Polynomial>,
    pub(super) carried: Vec<Polynomial>,
    /// `1ᵀ(K q + C v)`.
    pub(super) shear: Polynomial,
    /// Force of the ground on the block, all of it and that of friction alone.
    pub(super) slider: Polynomial,
    pub(super) friction: Polynomial,
    /// Normal force on the slider, and on contents over their mass.
    pub(super) normal: Polynomial,
    pub(super) press: Polynomial,
    making: Making,
    /// Part of the unit up to which the series is exact to rounding.
    pub(super) part: f64,
}

/// What its orders are made of.
#[derive(Clone, Debug)]
struct Making {
    /// `e^(−rate |ṡ|)`.
    decay: Polynomial,
    /// Restoring forces on the floors, of one order.
    restoring: Vec<f64>,
    /// Of block and floors: the mass with what is stuck to it, and the force of what slides on it over the
    /// normal force of a unit of mass.
    carriers: Vec<[f64; 2]>,
}

/// `Σ c p`.
pub(super) fn combined(factors: &[f64], of: &[Polynomial]) -> Polynomial {
    let all = || factors.iter().zip(of);
    core::array::from_fn(|k| all().fold(0.0, |sum, (c, p)| sum + c * p[k]))
}

impl Body {
    pub(super) fn new(model: &Model, system: &System) -> Self {
        let frame = model.frame();
        let (n, m) = (frame.masses_kg.len(), &frame.masses_kg);
        let mut damping = vec![0.0; n * n];
        // C = M Φ D Φᵀ M, column by column.
        for j in 0..n {
            let unit: Vec<f64> = (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect();
            let drag = system.drag(&system.coordinates(m, &unit));
            let mut column = vec![0.0; n];
            system.floors(&drag, &mut column);
            for i in 0..n {
                damping[i * n + j] = m[i] * column[i];
            }
        }
        let mut contents: Vec<Contents> = Vec::new();
        let join = |item: &Contents| {
            let alike = |c: &Contents| Contents { mass_kg: item.mass_kg, ..*c } == *item;
            if let Some(part) = contents.iter().position(alike) {
                contents[part].mass_kg += item.mass_kg;
                return part;
            }
            contents.push(*item);
            contents.len() - 1
        };
        let part_of = model.contents().iter().map(join).collect();
        let points = model.structure().map(|structure| {
            let of_point = |i: usize| structure.modes.iter().map(|mode| mode.points[i]).collect();
            let all = 0..structure.points.len();
            (all.clone().map(of_point).collect(), all.map(|i| structure.with_block(i)).collect())
        });
        Self {
            points,
            block_kg: model.block().mass_kg,
            total_kg: model.total_mass_kg(),
            masses_kg: m.clone(),
            stiffnesses_n_per_m: frame.stiffnesses_n_per_m.clone(),
            damping,
            contents,
            part_of,
            rate_rad_per_s: system.slip_rate_rad_per_s,
        }
    }

    pub(super) fn storeys(&self) -> usize {
        self.masses_kg.len()
    }

    /// Points whose motion is told: floors, or those of a structure by its modes.
    pub(super) fn point_count(&self) -> usize {
        self.points.as_ref().map_or(self.storeys(), |(points, _)| points.len())
    }

    /// `K q + C v`, order by order.
    #[inline(always)]
    fn restoring(&self, q: &[Polynomial], v: &[Polynomial], k: usize, out: &mut [f64]) {
        let n = self.storeys();
        let (q, v, out) = (&q[..n], &v[..n], &mut out[..n]);
        let mut below = 0.0;
        for i in 0..n {
            let row = &self.damping[i * n..][..n];
            let drag = row.iter().zip(v).fold(0.0, |sum, (c, v)| sum + c * v[k]);
            let here = q[i][k];
            let force = self.stiffnesses_n_per_m[i] * (here - below);
            out[i] = drag + force;
            if self.points.is_some() {
                continue;
            }
            if i > 0 {
                out[i - 1] -= force;
            }
            below = here;
        }
    }

    /// `1ᵀ(K q + C v)` in a state.
    pub(super) fn shear_n(&self, x: &State) -> f64 {
        let n = self.storeys();
        let [q, v] = [&x.q, &x.v].map(|list| {
            let of = |x: &f64| {
                let mut p = ZERO;
                p[0] = *x;
                p
            };
            list.iter().map(of).collect::<Vec<_>>()
        });
        let mut restoring = vec![0.0; n];
        self.restoring(&q, &v, 0, &mut restoring);
        restoring.iter().sum()
    }

    /// Sum of the sizes of the spring and damper forces on a floor, from 1.
    pub(super) fn restoring_size(&self, x: &State, floor: usize) -> f64 {
        let (n, k) = (self.storeys(), &self.stiffnesses_n_per_m);
        let row = &self.damping[(floor - 1) * n..][..n];
        let dampers = row.iter().zip(&x.v).map(|(c, v)| (c * v).abs()).sum::<f64>();
        let chained = self.points.is_none();
        let below = if floor > 1 && chained { x.q[floor - 2] } else { 0.0 };
        let lower = (k[floor - 1] * (x.q[floor - 1] - below)).abs();
        let upper = if floor < n && chained {
            (k[floor] * (x.q[floor] - x.q[floor - 1])).abs()
        } else {
            0.0
        };
        dampers + lower + upper
    }

    /// Mass of a floor, or of the block, with the contents stuck to it.
    pub(super) fn joined_kg(&self, floor: usize, modes: &[Mode]) -> f64 {
        let own = if floor == 0 { self.block_kg } else { self.masses_kg[floor - 1] };
        let stuck = self.contents.iter().zip(&modes[1..]);
        let on = stuck.filter(|(c, mode)| c.floor == floor && **mode == Mode::Stick);
        on.fold(own, |sum, (contents, _)| sum + contents.mass_kg)
    }

    /// Scratch for a series.
    pub(super) fn scratch(&self) -> Expansion {
        let (n, e) = (self.storeys(), self.contents.len());
        Expansion {
            from_s: 0.0,
            unit_s: 0.0,
            state: State {
                s: ZERO,
                w: ZERO,
                q: vec![ZERO; n],
                v: vec![ZERO; n],
                r: vec![ZERO; e],
                p: vec![ZERO; e],
            },
            ground: ZERO,
            u: ZERO,
            floors: vec![ZERO; n],
            carried: vec![ZERO; e],
            shear: ZERO,
            slider: ZERO,
            friction: ZERO,
            normal: ZERO,
            press: ZERO,
            making: Making {
                decay: ZERO,
                restoring: vec![0.0; n],
                carriers: vec![[0.0; 2]; 1 + n],
            },
            part: 1.0,
        }
    }

    /// The series from a state to the order `orders`, at most [`DEGREE`]; 0 finds accelerations and
    /// forces only.
    pub(super) fn expand(
        &self,
        x: &State,
        in_force: &InForce<'_>,
        loads: &Loads,
        (unit_s, orders): (f64, usize),
        out: &mut Expansion,
    ) {
        if orders > 0 {
            out.clear();
        }
        out.begin(x, loads, unit_s);
        let normal = [out.normal[0], out.normal[1]];
        (out.press[0], out.press[1]) = (normal[0] / self.total_kg, normal[1] / self.total_kg);
        self.load_carriers(in_force.modes, &mut out.making.carriers);
        if let Coefficient::Exponential { rate_s_per_m, .. } = in_force.force.coefficient {
            out.making.decay = ZERO;
            out.making.decay[0] = libm::exp(-rate_s_per_m * x.w.abs());
        }
        // What sticks does not ask for it.
        let pressing = match in_force.modes[0] {
            Mode::Stick => ZERO,
            Mode::Slip(_) => in_force.force.pressing.series(normal),
        };
        let is_linear = matches!(in_force.force.coefficient, Coefficient::Linear { .. });
        let (mut largest, mut sizes) = (0.0_f64, [0.0; DEGREE + 1]);
        for k in 0..=orders.min(DEGREE) {
            self.forces_of_order(in_force, &pressing, k, out);
            if orders == DEGREE {
                sizes[k] = self.momentum(&out.state, k);
                largest = largest.max(sizes[k]);
                // What is a hundred-millionth of the motion keeps its digits.
                if is_linear && k > 4 && sizes[k].max(sizes[k - 1]) <= 1e-6 * NEGLIGIBLE * largest {
                    break;
                }
            }
            // The last order of accelerations would need one more of the state.
            if k == DEGREE || k == orders {
                break;
            }
            self.next_order(in_force, unit_s / (k + 1) as f64, k, out);
        }
        if orders == DEGREE {
            out.part = self.exact_part(in_force, out, (largest, &sizes));
        }
    }

    /// Of block and floors: the mass with what is stuck to it, and the pull of what slides on it.
    fn load_carriers(&self, modes: &[Mode], carriers: &mut [[f64; 2]]) {
        for (floor, carrier) in carriers.iter_mut().enumerate() {
            *carrier = [self.joined_kg(floor, modes), 0.0];
        }
        for (contents, mode) in self.contents.iter().zip(&modes[1..]) {
            carriers[contents.floor][1] +=
                mode.sign() * contents.kinetic_friction * contents.mass_kg;
        }
    }

    /// Forces and accelerations of an order, from the state's coefficients up to it.
    #[inline(always)]
    fn forces_of_order(
        &self,
        in_force: &InForce<'_>,
        pressing: &Polynomial,
        k: usize,
        out: &mut Expansion,
    ) {
        let (n, modes, force) = (self.storeys(), in_force.modes, &in_force.force);
        let Expansion { state: State { s, w, q, v, .. }, floors, carried, making, .. } = out;
        let Making { decay, restoring, carriers } = making;
        // Lengths that the compiler knows to be the same.
        let (q, v, floors) = (&q[..n], &v[..n], &mut floors[..n]);
        let (restoring, carriers) = (&mut restoring[..n], &carriers[..=n]);
        self.restoring(q, v, k, restoring);
        let shear: f64 = restoring.iter().sum();
        let press = out.press[k];
        let [block_kg, pull] = carriers[0];
        let on_block = pull * press;
        for i in 0..n {
            let [mass_kg, pull] = carriers[i + 1];
            floors[i][k] = (pull * press - restoring[i]) / mass_kg;
        }
        out.shear[k] = shear;
        let product = force.of_normal_of_order(k, [out.normal[0], out.normal[1]], s);
        let spring = (force.restraint.stiffness_n_per_m * s[k]
            + force.restraint.damper_n_s_per_m * w[k])
            + (if k == 0 { force.force_n } else { 0.0 } + product);
        if modes[0] == Mode::Stick {
            out.u[k] = out.ground[k];
            out.slider[k] = block_kg * out.ground[k] - shear - on_block;
            out.friction[k] = out.slider[k] + spring;
        } else {
            let sign = modes[0].sign();
            let terms = if force.pressing.is_plain() { k.min(1) } else { k };
            let coefficient = |k: usize| force.coefficient.of_order(k, sign * w[k], decay);
            let resisting = (0..=terms).fold(0.0, |sum, j| sum + pressing[j] * coefficient(k - j));
            out.slider[k] = -sign * resisting - spring;
            let rubbing = if force.is_friction { product } else { 0.0 };
            out.friction[k] = -sign * resisting - rubbing;
            out.u[k] = (out.slider[k] + shear + on_block) / block_kg;
        }
        for ((contents, mode), carried) in self.contents.iter().zip(&modes[1..]).zip(carried) {
            carried[k] = match mode {
                Mode::Stick if contents.floor == 0 => out.u[k],
                Mode::Stick => floors[contents.floor - 1][k],
                Mode::Slip(direction) => -direction.sign() * contents.kinetic_friction * press,
            };
        }
    }

    /// The state's coefficients of the order after `k`, whose forces are known; `step` is the unit over `k + 1`.
    ///
    /// With the coefficient `e_k` of `e^(−α|w|)` that of order `k + 1` is
    /// `(k+1) e_{k+1} = −α σ Σ_{j≤k} (j+1) w_{j+1} e_{k−j}`.
    #[inline(always)]
    fn next_order(&self, in_force: &InForce<'_>, step: f64, k: usize, out: &mut Expansion) {
        let (n, modes) = (self.storeys(), in_force.modes);
        let Expansion { state: State { s, w, q, v, r, p }, u, floors, carried, making, .. } = out;
        let decay = &mut making.decay;
        if modes[0] != Mode::Stick {
            w[k + 1] = step * (u[k] - out.ground[k]);
            s[k + 1] = step * w[k];
            if let Coefficient::Exponential { rate_s_per_m, .. } = in_force.force.coefficient {
                let sum =
                    (0..=k).fold(0.0, |sum, j| sum + (j + 1) as f64 * w[j + 1] * decay[k - j]);
                decay[k + 1] = -rate_s_per_m * modes[0].sign() * sum / (k + 1) as f64;
            }
        }
        let (q, v, floors) = (&mut q[..n], &mut v[..n], &floors[..n]);
        for i in 0..n {
            v[i][k + 1] = step * (floors[i][k] - u[k]);
            q[i][k + 1] = step * v[i][k];
        }
        for (e, contents) in self.contents.iter().enumerate() {
            if modes[1 + e] != Mode::Stick {
                let under = if contents.floor == 0 { u[k] } else { floors[contents.floor - 1][k] };
                p[e][k + 1] = step * (carried[e][k] - under);
                r[e][k + 1] = step * p[e][k];
            }
        }
    }

    /// Size of an order: momenta over √mass, so that all are of one kind.
    #[inline(always)]
    fn momentum(&self, State { w, v, p, .. }: &State<Polynomial>, k: usize) -> f64 {
        let own = |kg: f64, w: f64| kg * w * w;
        let mut sum = own(self.block_kg, w[k]);
        for (kg, v) in self.masses_kg.iter().zip(v) {
            sum += own(*kg, v[k] + w[k]);
        }
        for (contents, p) in self.contents.iter().zip(p) {
            sum += own(contents.mass_kg, p[k]);
        }
        sum.sqrt()
    }

    /// Part of the unit over which the last terms of the series are below rounding, 4 at most.
    fn exact_part(
        &self,
        in_force: &InForce<'_>,
        out: &Expansion,
        (largest, sizes): (f64, &[f64; DEGREE + 1]),
    ) -> f64 {
        let mut part: f64 = 4.0;
        let mut limit = |largest: f64, k: usize, last: f64| {
            if last > NEGLIGIBLE * largest {
                part = part.min(libm::pow(NEGLIGIBLE * largest / last, 1.0 / k as f64));
            }
        };
        if largest.is_finite() {
            for k in [DEGREE - 1, DEGREE] {
                limit(largest, k, sizes[k]);
            }
            let [normal, change, ..] = out.normal;
            let reach = in_force.force.pressing.reach([normal, change]);
            if let Coefficient::Exponential { drop, rate_s_per_m, .. } = in_force.force.coefficient
                && in_force.modes[0] != Mode::Stick
                && drop != 0.0
            {
                for k in [DEGREE - 1, DEGREE] {
                    limit(1.0, k, 0.1 * out.making.decay[k].abs());
                }
                part = fading_part(&out.state.w, rate_s_per_m, part);
            }
            part.min(reach)
        } else {
            0.5
        }
    }
}

impl Expansion {
    /// Takes up a state and the loads from there on.
    fn begin(&mut self, x: &State, loads: &Loads, unit_s: f64) {
        self.unit_s = unit_s;
        self.state.follow(x, |series, x| series[0] = *x);
        let Loads { acceleration: [a, a_rate], normal: [n, n_rate] } = *loads;
        self.ground = ZERO;
        (self.ground[0], self.ground[1]) = (a, a_rate * unit_s);
        (self.normal[0], self.normal[1]) = (n, n_rate * unit_s);
    }

    /// Sets to zero what is not written order by order: normal forces, all that stands still, and the
    /// orders that a series leaves off.
    pub(super) fn clear(&mut self) {
        self.state.lists_mut().into_iter().for_each(|list| list.fill(ZERO));
        (self.u, self.shear, self.slider, self.friction) = (ZERO, ZERO, ZERO, ZERO);
        (self.normal, self.press) = (ZERO, ZERO);
        self.floors.fill(ZERO);
        self.carried.fill(ZERO);
    }

    /// The state at a part of the unit.
    pub(super) fn state_at(&self, part: f64, x: &mut State) {
        x.follow(&self.state, |x, series| *x = value(series, part));
    }

    /// The coefficients of an order of the state's components.
    pub(super) fn order(&self, k: usize, list: &mut [f64]) {
        list.iter_mut().zip(self.state.components()).for_each(|(out, series)| *out = series[k]);
    }
}
