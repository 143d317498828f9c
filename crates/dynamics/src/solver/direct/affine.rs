//! The motion between two events as an affine system over whole samples.
//!
//! Under a constant normal force and a force of the slider that is linear in `s` and `ṡ`, or where all sticks, it is
//! `ẋ = A x + b a + g` in one assignment of modes. What [`Body::expand`](super::body::Body::expand) makes of units is its
//! matrices, and every output `c·x + d a + e`. In the energy norm of block, floors and what is stuck
//! to them
//!
//! ```text
//! ‖x‖² = k s² + M1 ṡ² + Σ k_i (q_i − q_{i−1})² + Σ m_i (v_i + ṡ)²
//! ```
//!
//! `ẍ` does not grow within a sample, as sliding contents do no more than a constant force; their own velocity
//! has `p̈ = −(v̈_i + s⃛ + ȧ)`.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::course::WalkState;
use super::super::ground::Normal;
use super::super::phase::Phase;
use super::Direct;
use super::body::Loads;
use crate::linear::lanes::eight;
use crate::linear::{BATCH, MAX_RATE_STEP, Row, UnitResponses, Window};
use crate::numerics::instructions::vectorize;
use crate::response::Mode;
use crate::slider::Memory;

/// Most series to a step: beyond, samples are as well stepped through one by one.
const MOST_PARTS: f64 = 16.0;

/// Most components of a state, and most configurations that are kept: beyond, the matrices are larger than
/// the work that they save.
const MOST_COMPONENTS: usize = 64;
const MOST_CONFIGURATIONS: usize = 128;

/// What a unit is taken as, so that constant forces beside it are below rounding: 2^100.
const LARGE: f64 = f64::from_bits((1023 + 100) << 52);

/// A number at a sample and at the eight after it.
pub(super) type Nine = [f64; BATCH + 1];

/// One assignment of modes, on one branch of the slider's law.
pub(super) struct Configuration {
    pub(super) modes: Vec<Mode>,
    pub(super) memory: Memory,
    /// How often it was in force before it had matrices.
    asked: usize,
    /// None as long as it has none, and where it is too fast for the step.
    pub(super) affine: Option<Affine>,
}

/// Its motion over the samples of a batch.
pub(super) struct Affine {
    pub(super) dt_s: f64,
    /// The components of the state that move.
    pub(super) moving: Vec<(usize, Row)>,
    /// In the order of [`Direct::values_at`].
    pub(super) outputs: Vec<Number>,
    /// Numbers of which `‖ẍ‖²` at the start of a sample is the sum of the squares.
    pub(super) second: Vec<Number>,
    /// What the energy norm can grow by over a sample: friction that falls with the speed feeds it.
    pub(super) growth: f64,
}

/// A number `c·x + d a + e ȧ + constant`, of which `|ÿ| ≤ norm ‖ẍ‖ + of_jerk |ȧ|` within a sample.
pub(super) struct Number {
    of_state: Vec<(usize, f64)>,
    of_a: f64,
    of_rate: f64,
    constant: f64,
    pub(super) norm: f64,
    pub(super) of_jerk: f64,
}

impl Number {
    /// Of a state under an acceleration.
    pub(super) fn at(&self, x: &[f64], a: f64) -> f64 {
        let start = self.constant + self.of_a * a;
        self.of_state.iter().fold(start, |sum, (i, c)| sum + c * x[*i])
    }

    /// At eight samples from the `k`-th of a batch on, with `ȧ` after each.
    #[inline(always)]
    pub(super) fn values<S: Simd>(
        &self,
        simd: S,
        states: &[Nine],
        (a, k): (&Window, usize),
        rate: f64x8<S>,
    ) -> f64x8<S> {
        let a = f64x8::from_slice(simd, &a[k..k + BATCH]);
        let loads = eight(simd, self.of_a) * a + eight(simd, self.of_rate) * rate;
        let mut sum = eight(simd, self.constant) + loads;
        for (i, c) in &self.of_state {
            sum += eight(simd, *c) * f64x8::from_slice(simd, &states[*i][k..k + BATCH]);
        }
        sum
    }
}

/// `A` by columns, `b` and `g`.
struct Matrices {
    stride: usize,
    a: Vec<f64>,
    b: Vec<f64>,
    g: Vec<f64>,
}

impl Matrices {
    /// The rate `c·ẋ` of `c·x`: `c A`, `c·b`, `c·g`.
    fn rate(&self, c: &[f64]) -> (Vec<f64>, f64, f64) {
        let dot = |column: &[f64]| c.iter().zip(column).map(|(c, x)| c * x).sum::<f64>();
        (self.a.chunks_exact(self.stride).map(dot).collect(), dot(&self.b), dot(&self.g))
    }
}

/// The rows of some components of the state over a step of so many series.
#[inline(always)]
fn rows_of<S: Simd>(
    simd: S,
    Matrices { stride, a, b, g }: &Matrices,
    step: (f64, usize),
    components: impl Iterator<Item = usize>,
) -> Vec<(usize, Row)> {
    let units = UnitResponses::affine(a, b, g, step);
    let (mut rows, mut unit) = (Vec::new(), vec![0.0; *stride]);
    for i in components {
        unit[i] = 1.0;
        rows.push((i, units.row(simd, &unit, 0.0, 0.0)));
        unit[i] = 0.0;
    }
    rows
}

/// What is not zero of a row.
fn terms(row: &[f64]) -> Vec<(usize, f64)> {
    row.iter().copied().enumerate().filter(|(_, c)| *c != 0.0).collect()
}

impl<'a> Direct<'a> {
    /// The place of the present configuration, if its motion is affine.
    pub(super) fn configuration(&mut self, course: &WalkState<'a>) -> Option<usize> {
        let dt_s = self.ground.sampling.dt_s?;
        let normal_n = self.normal_within()?;
        let count = self.x.count();
        if !course.slider.law.repeats(self.modes[0] != Mode::Stick) || count > MOST_COMPONENTS {
            return None;
        }
        let (all, memory) = (&self.ahead.configurations, &course.slider.memory);
        let place = all.iter().position(|c| c.modes == self.modes && c.memory == *memory);
        let place = match place {
            Some(place) => place,
            None if all.len() < MOST_CONFIGURATIONS => {
                let (modes, memory) = (self.modes.clone(), memory.clone());
                let new = Configuration { modes, memory, asked: 0, affine: None };
                self.ahead.configurations.push(new);
                self.ahead.configurations.len() - 1
            }
            None => return None,
        };
        let configuration = &mut self.ahead.configurations[place];
        if configuration.affine.is_none() {
            // The matrices of a large system cost as much as many samples.
            configuration.asked += 1;
            if 32 * configuration.asked >= count * count {
                self.ahead.configurations[place].affine = self.affine(course, dt_s, normal_n);
            }
        }
        self.ahead.configurations[place].affine.is_some().then_some(place)
    }

    /// The normal force that a configuration knows of: one that is constant, or none where it varies and all is stuck,
    /// as it moves nothing then.
    fn normal_within(&self) -> Option<f64> {
        match self.ground.normal {
            Normal::Constant(normal_n) => Some(normal_n).filter(|normal_n| *normal_n > 0.0),
            Normal::Varying(_) => self.modes.iter().all(|mode| *mode == Mode::Stick).then_some(0.0),
        }
    }

    fn affine(&mut self, course: &WalkState<'a>, dt_s: f64, normal_n: f64) -> Option<Affine> {
        let restraint = self.force.affine(normal_n).restraints.all;
        let (k, c) = (restraint.stiffness_n_per_m, restraint.damper_n_s_per_m);
        let block_kg = self.body.joined_kg(0, &self.modes);
        let rate = self.body.rate_rad_per_s + (k / block_kg).sqrt() + c.abs() / block_kg;
        let parts = (rate * dt_s / MAX_RATE_STEP).ceil().max(1.0);
        if !(parts <= MOST_PARTS) {
            return None;
        }
        let (matrices, outputs) = self.units(course, normal_n);
        let components = (0..self.x.count()).filter(|&i| self.moves(i));
        let step = (dt_s, parts as usize);
        let moving =
            vectorize!(self.instructions, simd => rows_of(simd, &matrices, step, components));
        let second = |row: &Vec<f64>| {
            let (once, of_rate, _) = matrices.rate(row);
            let (twice, of_a, constant) = matrices.rate(&once);
            Number { of_state: terms(&twice), of_a, of_rate, constant, norm: 0.0, of_jerk: 0.0 }
        };
        let second = self.momenta(k).iter().map(second).collect();
        let outputs = outputs.into_iter().map(|(row, of_a, constant)| {
            let [norm, of_jerk] = self.dual_norm(&row, k);
            Number { of_state: terms(&row), of_a, of_rate: 0.0, constant, norm, of_jerk }
        });
        let outputs = outputs.collect();
        let growth = libm::exp((-c).max(0.0) / block_kg * dt_s);
        Some(Affine { dt_s, moving, outputs, second, growth })
    }

    /// What the series makes of nothing, of units of the state and of a unit of acceleration: the matrices,
    /// and each output as a row with its factor of the acceleration and its constant.
    fn units(
        &mut self,
        course: &WalkState<'a>,
        normal_n: f64,
    ) -> (Matrices, Vec<(Vec<f64>, f64, f64)>) {
        let count = self.x.count();
        let stride = count.next_multiple_of(4);
        let here = self.x.clone();
        let mut unit = vec![0.0; count + 1];
        let nothing = self.respond(course, &unit, normal_n, stride);
        let mut units = Vec::with_capacity(count + 1);
        for i in 0..=count {
            // Half the difference, which knows no side.
            unit[i] = LARGE;
            let mut response = self.respond(course, &unit, normal_n, stride);
            unit[i] = -LARGE;
            let opposite = self.respond(course, &unit, normal_n, stride);
            unit[i] = 0.0;
            let half = 0.5 / LARGE;
            response.iter_mut().zip(opposite).for_each(|(x, other)| *x = half * (*x - other));
            units.push(response);
        }
        self.x = here;
        self.update_branch(course);
        let mut a = vec![0.0; stride * stride];
        // What stands still moves nothing: only rows of outputs ask for it.
        for i in (0..count).filter(|&i| self.moves(i)) {
            a[i * stride..][..stride].copy_from_slice(&units[i][..stride]);
        }
        let (b, g) = (units[count][..stride].to_vec(), nothing[..stride].to_vec());
        let row = |j: usize| (0..count).map(|i| units[i][j]).collect();
        let rows = (stride..nothing.len()).map(|j| (row(j), units[count][j], nothing[j]));
        (Matrices { stride, a, b, g }, rows.collect())
    }

    /// Derivative, padded, and outputs of a state and an acceleration.
    fn respond(
        &mut self,
        course: &WalkState<'a>,
        state: &[f64],
        normal_n: f64,
        stride: usize,
    ) -> Vec<f64> {
        self.x.set(state);
        // At rest springs push by where the block is.
        self.update_branch(course);
        let acceleration = [state[self.x.count()], 0.0];
        self.look_at_orders(1, &Loads { acceleration, normal: [normal_n, 0.0] });
        let mut response = vec![0.0; stride];
        self.instant.order(1, &mut response);
        response.extend(self.values_at(&self.instant));
        // Instants have no more than one order.
        self.instant.clear();
        response
    }

    /// Whether a component of the state moves.
    fn moves(&self, i: usize) -> bool {
        let structure = 2 + 2 * self.body.storeys();
        let contents = self.body.contents.len();
        match i {
            0 | 1 => self.modes[0] != Mode::Stick,
            i if i < structure => true,
            i if i < structure + 2 * contents => {
                self.modes[1 + (i - structure) % contents] != Mode::Stick
            }
            _ => false,
        }
    }

    /// Rows of which the energy norm squared is the sum of the squares, the slider on a spring `k`.
    fn momenta(&self, k: f64) -> Vec<Vec<f64>> {
        let (body, n) = (&self.body, self.body.storeys());
        let stride = self.x.count().next_multiple_of(4);
        let row = |factor: f64, components: &[(usize, f64)]| {
            let mut row = vec![0.0; stride];
            components.iter().for_each(|(i, c)| row[*i] = factor * c);
            row
        };
        let mut all = Vec::with_capacity(2 + 2 * n);
        if self.modes[0] != Mode::Stick {
            all.push(row(k.sqrt(), &[(0, 1.0)]));
            all.push(row(body.joined_kg(0, &self.modes).sqrt(), &[(1, 1.0)]));
        }
        for i in 0..n {
            let root = body.stiffnesses_n_per_m[i].sqrt();
            let drift = [(2 + i, 1.0), (1 + i, -1.0)];
            all.push(row(root, &drift[..if i == 0 { 1 } else { 2 }]));
            let root = body.joined_kg(1 + i, &self.modes).sqrt();
            all.push(row(root, &[(2 + n + i, 1.0), (1, 1.0)]));
        }
        all
    }

    /// Largest value of a row on states of energy norm 1, and its size as a factor of `ȧ`, where the second
    /// derivative is asked for.
    ///
    /// ```text
    /// |c|*² = c_s²/k + (c_w − Σ c_v)²/M1 + Σ c_v²/m + Σ_i (Σ_{j≥i} c_q)²/k_i
    /// ```
    fn dual_norm(&self, row: &[f64], k: f64) -> [f64; 2] {
        let (body, n) = (&self.body, self.body.storeys());
        let slides = self.modes[0] != Mode::Stick;
        let [mut of_s, mut of_w] = if slides { [row[0], row[1]] } else { [0.0; 2] };
        let mut of_v = row[2 + n..2 + 2 * n].to_vec();
        let mut of_jerk = 0.0;
        let of_p = &row[2 + 2 * n + body.contents.len()..];
        for (i, (contents, of_p)) in body.contents.iter().zip(of_p).enumerate() {
            if self.modes[1 + i] == Mode::Stick {
                continue;
            }
            of_jerk += of_p.abs();
            of_w -= of_p;
            if contents.floor > 0 {
                of_v[contents.floor - 1] -= of_p;
            }
        }
        let mut square = 0.0;
        if slides {
            of_w -= of_v.iter().sum::<f64>();
            square = of_w * of_w / body.joined_kg(0, &self.modes);
            of_s = if of_s == 0.0 { 0.0 } else { of_s * of_s / k };
            square += of_s;
        }
        let (mut of_drift, of_q) = (0.0, &row[2..2 + n]);
        for i in (0..n).rev() {
            of_drift += of_q[i];
            square += of_drift * of_drift / body.stiffnesses_n_per_m[i];
            square += of_v[i] * of_v[i] / body.joined_kg(1 + i, &self.modes);
        }
        [square.sqrt(), of_jerk]
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::ground::{Ground, Sampling};
    use super::super::start;
    use super::*;
    use crate::model::{Block, Contents, Damping, Frame, InitialState, Model, Slider};
    use crate::motion::GroundMotion;
    use crate::numerics::InstructionSet;
    use crate::progress::{NEVER_CANCELLED, Pulse};
    use crate::slider::{Direction, Friction};

    /// Two storeys with contents on the block, and two on the floors.
    fn model(damper_n_s_per_m: f64) -> Model {
        let friction = Friction::new(0.06, 0.05).expect("friction");
        let slider = Slider { damper_n_s_per_m, ..Slider::sprung(friction, 3e3) };
        let frame = Frame {
            masses_kg: vec![200.0, 150.0],
            stiffnesses_n_per_m: vec![5e4, 3e4],
            damping: Damping::Dampers(vec![damper_n_s_per_m; 2]),
            heights_m: None,
        };
        let block = Block { mass_kg: 400.0, width_m: None, height_m: None };
        let item =
            |floor| Contents { floor, mass_kg: 60.0, static_friction: 0.2, kinetic_friction: 0.1 };
        let contents = vec![item(0), item(1), item(2)];
        Model::new(block, slider, frame, 9.81, InitialState::rest())
            .and_then(|model| model.with_contents(contents))
            .expect("a model")
    }

    /// Looks at every assignment of modes of a model.
    fn each(model: &Model, look: impl for<'a> Fn(&mut Direct<'a>, &WalkState<'a>)) {
        let motion = GroundMotion::evenly_spaced(0.01, vec![0.0; 20], None).expect("a motion");
        let (sampling, law) = (Sampling::new(&motion), model.law(false));
        let ground = Ground {
            times_s: motion.times_s(),
            table: motion.horizontal_m_per_s2(),
            acceleration: motion.horizontal_m_per_s2(),
            normal: Normal::Constant(model.normal_n()),
            sampling: &sampling,
        };
        for assignment in 0..16_u32 {
            let how = (false, Pulse::new(NEVER_CANCELLED));
            let mut walk = start(model, &law, ground, InstructionSet::best(), how);
            for i in (0..walk.course.interfaces()).filter(|i| assignment & (1 << i) != 0) {
                walk.course.interface_mut(i).mode = Mode::Slip(Direction::Positive);
            }
            walk.phase.update_branch(&walk.course);
            look(&mut walk.phase, &walk.course);
        }
    }

    fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    /// States of the structure whose numbers are anything.
    fn states(stride: usize, count: usize) -> Vec<Vec<f64>> {
        let mut x = 1_u32;
        let mut next = |_| {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(x >> 8) / f64::from(1 << 23) - 1.0
        };
        (0..count).map(|_| (0..stride).map(&mut next).collect()).collect()
    }

    /// Proof (o): unloaded, what is stuck and what slides feed nothing; without dampers nothing is lost.
    #[test]
    fn energy_norm_does_not_grow_in_any_assignment() {
        for damper in [0.0, 300.0] {
            let model = model(damper);
            let k = model.slider_stiffness_n_per_m();
            each(&model, |run, course| {
                let (matrices, _) = run.units(course, model.normal_n());
                let rows = run.momenta(k);
                for mut x in states(matrices.stride, 50) {
                    if run.modes[0] == Mode::Stick {
                        x[..2].fill(0.0);
                    }
                    let (mut power, mut size) = (0.0, 0.0);
                    for row in &rows {
                        let (rate, ..) = matrices.rate(row);
                        power += dot(row, &x) * dot(&rate, &x);
                        size += (dot(row, &x) * dot(&rate, &x)).abs();
                    }
                    assert!(power <= 1e-12 * size, "{:?}: {power} of {size}", run.modes);
                    assert!(damper > 0.0 || power >= -1e-12 * size, "{:?}: {power}", run.modes);
                }
            });
        }
    }

    /// Proof (o): no state of energy norm 1 makes an output larger than its dual norm, and one reaches it.
    #[test]
    fn dual_norms_of_outputs_hold_and_are_reached() {
        let model = model(50.0);
        let k = model.slider_stiffness_n_per_m();
        each(&model, |run, course| {
            let (n, slides) = (run.body.storeys(), run.modes[0] != Mode::Stick);
            let (_, rows) = run.units(course, model.normal_n());
            let momenta = run.momenta(k);
            for (mut row, ..) in rows {
                let [norm, _] = run.dual_norm(&row, k);
                // The second derivative of the velocity of contents is that of what carries them.
                let of_p = row.split_off(2 + 2 * n + run.body.contents.len());
                row.truncate(2 + 2 * n);
                for (i, of_p) in of_p.iter().enumerate() {
                    if run.modes[1 + i] != Mode::Stick {
                        let floor = run.body.contents[i].floor;
                        row[1] -= of_p;
                        if floor > 0 {
                            row[1 + n + floor] -= of_p;
                        }
                    }
                }
                if !slides {
                    (row[0], row[1]) = (0.0, 0.0);
                }
                let size = |x: &[f64]| {
                    momenta.iter().map(|row| dot(row, x)).map(|x| x * x).sum::<f64>().sqrt()
                };
                for x in states(2 + 2 * n, 50) {
                    let x = if slides { x } else { [&[0.0; 2], &x[2..]].concat() };
                    assert!(dot(&row, &x).abs() <= norm * size(&x) * (1.0 + 1e-12));
                }
                // What is proportional to the row in the coordinates of the norm.
                let mut worst = vec![0.0; 2 + 2 * n];
                if slides {
                    let of_v: f64 = row[2 + n..].iter().sum();
                    worst[0] = row[0] / k;
                    worst[1] = (row[1] - of_v) / run.body.joined_kg(0, &run.modes);
                }
                for i in 0..n {
                    let drift = row[2 + i..2 + n].iter().sum::<f64>();
                    let below = if i > 0 { worst[1 + i] } else { 0.0 };
                    worst[2 + i] = below + drift / run.body.stiffnesses_n_per_m[i];
                    let momentum = row[2 + n + i] / run.body.joined_kg(1 + i, &run.modes);
                    worst[2 + n + i] = momentum - worst[1];
                }
                let reached = dot(&row, &worst) - norm * size(&worst);
                assert!(reached.abs() <= 1e-12 * norm * norm, "{:?}: {reached}", run.modes);
            }
        });
    }
}
