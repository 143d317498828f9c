//! The equations of motion in two horizontal directions.

use super::mass::{Mass, Matrix, times};
use super::rows::Rows;
use super::vector::{apart, inner, norm};
use crate::error::SolveError;
use crate::linear;
use crate::model::{Model, OscillatorInPlane, Structure};
use crate::numerics::algebra::dot;
use crate::slider::{Contact, Disc, IsotropicFriction, Ring};
use crate::solver::outputs::Arms;
use crate::solver::tables::system_of;

/// Part of a structure's mass, and of a point's motion, below which what moves with the block beside what does
/// along x and y alike is the rounding of the modes.
const ROUNDED: f64 = 2e-14;

/// Block, spring, damper and structure in the structure's fixed-base modes `η`, each with a participation `L_j`
/// along x and one along y: nothing assumes that a mode moves along one of them alone.
///
/// With `g = D η̇ + Ω η`, the block's total acceleration `b = ẇ + a` and `f = μ_k N/M1`
///
/// ```text
/// structure   η̈ = −g − Lᵀ b             (so floor i accelerates by −Φ_i g)
/// pull        P = (L g − C1 w − (K1 + N/R) s)/M1,   push  p = P − a
/// stick       w = 0, b = a              slip   b = P − f u,  ẇ = p − f u,  u = w/|w|
/// ```
///
/// Ω is diagonal, and so is D where damping is a ratio; dampers between floors couple the modes by a full D.
///
/// What modes that are not given lack of the mass moves with the block, as much as it may be along x, along y and
/// across: where that is no multiple of the identity the block has a [`Mass`].
#[derive(Clone, Debug)]
pub(in crate::solver) struct System {
    /// Number of points whose motion is told: floors, or points of a structure by its modes.
    pub(super) points: usize,
    /// `M1` in kg.
    pub(super) block_kg: f64,
    pub(super) mass: Option<Mass>,
    /// `K1` in N/m without that of a pendulum, and `C1` in N s/m.
    pub(super) stiffness_n_per_m: f64,
    pub(super) damper_n_s_per_m: f64,
    /// `1/R` in 1/m, 0 where there is no pendulum.
    pub(super) per_radius: f64,
    /// The stop around the block.
    pub(super) ring: Option<Ring>,
    /// `g sin θ` along x and y in m/s²: part of all accelerations `a` and `b`, not of what is told of them.
    pub(super) slope: [f64; 2],
    /// The accelerations that friction holds, `μ_s N/M1`, and `μ_k/M1`: times `N` that which it takes.
    pub(super) hold: Disc,
    pub(super) kinetic_per_kg: IsotropicFriction,
    omega2: Vec<f64>,
    /// `D`, row by row where the modes are coupled, else its diagonal.
    damping: Vec<f64>,
    coupled: bool,
    /// `L` along x and y.
    pub(super) participation: [Vec<f64>; 2],
    /// `Φ` along x and y, and what of it the drift from the point before is.
    pub(super) floors: [Rows; 2],
    pub(super) drifts: [Rows; 2],
    /// What `g` adds to the shear between each point and the one before it along x and y, where the points have masses, and
    /// what of the block's acceleration takes from it, where something does.
    pub(super) shears: Option<[Rows; 2]>,
    pub(super) shears_with_block: Vec<Matrix>,
    /// What of each point's acceleration is the block's; none where nothing is.
    pub(super) with_block: Vec<Matrix>,
    /// Of oscillators along their directions, `1/|L|`; none of a frame.
    pub(super) oscillators: Vec<f64>,
    /// What the modes and the block add to the overturning moment along x and y, where it is asked for.
    pub(super) overturning: [Option<(Rows, [f64; 2])>; 2],
    /// One over the moment along x and y that the weight resists about an edge, in 1/(N m); none where one of both is not
    /// asked for.
    pub(super) per_resisted: Option<[f64; 2]>,
    /// Bound on the rates in rad/s.
    pub(in crate::solver) rate_rad_per_s: f64,
}

/// Friction of a block with a mass in each direction also pushes it towards the stop.
const RIGID_WITH_MASS: &str = "a rigid stop under a structure whose left-out modes move with the block differently \
                               along x and y";

fn refused(what: &'static str) -> SolveError {
    SolveError::NotTaken { method: "two horizontal directions", what }
}

/// The model as it is along y: as along x but for what [`Model::along_y`] says.
pub(super) fn along_y(model: &Model) -> Model {
    model.turned_to_y()
}

impl System {
    /// Of a model whose slider is the same in all directions.
    ///
    /// # Errors
    /// [`SolveError::NotTaken`] that names what is not.
    pub(in crate::solver) fn new(model: &Model) -> Result<Self, SolveError> {
        let slider = model.slider().isotropic(model.normal_n()).map_err(refused)?;
        if !model.contents().is_empty() {
            return Err(refused("contents"));
        }
        if let Some(structure) = model.structure() {
            return Self::of_modes(model, structure);
        }
        let turned = along_y(model);
        let models = [model, &turned];
        let axes = models.map(system_of);
        let n = model.storeys();
        let modes = 2 * n;
        let place = |axis: usize, row: &[f64]| {
            let mut placed = vec![0.0; modes];
            placed[axis * n..][..n].copy_from_slice(&row[..n]);
            placed
        };
        let rows = |of: &dyn Fn(usize, usize) -> Vec<f64>| {
            [0, 1].map(|k| Rows::new(&(0..n).map(|i| of(k, i)).collect::<Vec<_>>()))
        };
        let coupled = n > 0 && axes.iter().any(|axis| axis.uncoupled_modes().is_none());
        let per_kg = 1.0 / model.block().mass_kg;
        Ok(Self {
            points: n,
            block_kg: model.block().mass_kg,
            mass: None,
            stiffness_n_per_m: slider.stiffness_n_per_m,
            damper_n_s_per_m: model.slider().damper_n_s_per_m,
            per_radius: slider.per_radius,
            ring: slider.ring,
            slope: model.slope_in_plane_m_per_s2(),
            hold: slider.hold.times(per_kg),
            kinetic_per_kg: slider.kinetic.times(per_kg),
            omega2: if n == 0 {
                Vec::new()
            } else {
                axes.iter().flat_map(|a| a.omega2.clone()).collect()
            },
            damping: damping(&axes, n, coupled),
            coupled,
            participation: [0, 1].map(|k| place(k, &axes[k].participation)),
            floors: rows(&|k, i| place(k, axes[k].floor(i))),
            drifts: rows(&|k, i| place(k, axes[k].drift(i))),
            shears: {
                let masses_kg = &model.frame().masses_kg;
                let floors =
                    |k: usize| (0..n).map(|i| place(k, axes[k].floor(i))).collect::<Vec<_>>();
                Some([0, 1].map(|k| Rows::new(&above(&floors(k), masses_kg))))
            },
            shears_with_block: Vec::new(),
            with_block: Vec::new(),
            oscillators: Vec::new(),
            overturning: [0, 1].map(|k| {
                let (arm, block) = Arms::new(models[k], &[])?.by_modes(&axes[k]);
                let along = if k == 0 { [block, 0.0] } else { [0.0, block] };
                Some((Rows::new(&[place(k, if n == 0 { &[] } else { &arm })]), along))
            }),
            per_resisted: model.per_resisted_moment_in_plane(),
            rate_rad_per_s: axes.iter().fold(0.0, |rate: f64, a| rate.max(a.slip_rate_rad_per_s)),
        })
    }

    /// This system under the friction of a model that [has it](Model::has_system_of).
    ///
    /// # Errors
    /// [`SolveError::NotTaken`] where friction is not the same in all directions.
    pub(in crate::solver) fn under_friction_of(&self, model: &Model) -> Result<Self, SolveError> {
        let slider = model.slider().isotropic(model.normal_n()).map_err(refused)?;
        let per_kg = 1.0 / self.block_kg;
        let (hold, kinetic_per_kg) = (slider.hold.times(per_kg), slider.kinetic.times(per_kg));
        Ok(Self { hold, kinetic_per_kg, ..self.clone() })
    }

    /// Of a structure by its modes, each of which may move along both axes.
    fn of_modes(model: &Model, structure: &Structure) -> Result<Self, SolveError> {
        let slider = model.slider().isotropic(model.normal_n()).map_err(refused)?;
        if structure.in_plane.is_empty() {
            return Err(refused("a structure whose modes do not say what they do along y"));
        }
        let modes = structure.oscillators_in_plane();
        let n = structure.points.len();
        let sizes: Vec<f64> = modes.iter().map(|mode| mode.mass_kg.sqrt()).collect();
        let of_modes =
            |of: &dyn Fn(&OscillatorInPlane) -> f64| -> Vec<f64> { modes.iter().map(of).collect() };
        let participation =
            [0, 1].map(|k| of_modes(&|mode| mode.mass_kg.sqrt() * mode.direction[k]));
        let rows = |k: usize| -> Vec<Vec<f64>> {
            let shape = |i: usize| of_modes(&|mode| mode.points[i][k] / mode.mass_kg.sqrt());
            (0..n).map(shape).collect()
        };
        let floors = [rows(0), rows(1)];
        let drifts = floors.each_ref().map(|rows| {
            let below = |i: usize, j: usize| if i == 0 { 0.0 } else { rows[i - 1][j] };
            let drift = |(i, row): (usize, &Vec<f64>)| -> Vec<f64> {
                row.iter().enumerate().map(|(j, x)| x - below(i, j)).collect()
            };
            Rows::new(&rows.iter().enumerate().map(drift).collect::<Vec<_>>())
        });
        let (block_kg, mass, with_block) = mass_of_block(model, structure, modes.len());
        if mass.is_some() && slider.ring.is_some_and(|ring| ring.restitution.is_some()) {
            return Err(refused(RIGID_WITH_MASS));
        }
        let masses_kg = model.point_masses_kg();
        let overturning =
            [0, 1].map(|k| moment_of_modes(model, structure, (k, &floors[k], &with_block)));
        let per_kg = 1.0 / block_kg;
        let omega2 = of_modes(&|mode| mode.frequency_rad_per_s * mode.frequency_rad_per_s);
        let damping = of_modes(&|mode| 2.0 * mode.damping_ratio * mode.frequency_rad_per_s);
        // As of a system in one direction, over the least mass of the block.
        let least_kg = block_kg / mass.as_ref().map_or(1.0, Mass::compliance);
        let pulled = |list: &[f64]| {
            let of = sizes.iter().zip(list).map(|(l, x)| l * l * x);
            of.sum::<f64>() / least_kg
        };
        let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(*x));
        let spring = model.slider_stiffness_n_per_m() / least_kg;
        let damper_n_s_per_m = model.slider().damper_n_s_per_m;
        let rate_rad_per_s = (most(&omega2) + (spring + pulled(&omega2))).sqrt()
            + most(&damping)
            + (damper_n_s_per_m / least_kg + pulled(&damping));
        Ok(Self {
            points: n,
            block_kg,
            mass,
            stiffness_n_per_m: slider.stiffness_n_per_m,
            damper_n_s_per_m,
            per_radius: slider.per_radius,
            ring: slider.ring,
            slope: model.slope_in_plane_m_per_s2(),
            hold: slider.hold.times(per_kg),
            kinetic_per_kg: slider.kinetic.times(per_kg),
            omega2,
            damping,
            coupled: false,
            participation,
            shears: masses_kg
                .as_ref()
                .map(|kg| floors.each_ref().map(|rows| Rows::new(&above(rows, kg)))),
            shears_with_block: masses_kg
                .as_ref()
                .map_or_else(Vec::new, |kg| matrices_above(&with_block, kg)),
            floors: floors.map(|rows| Rows::new(&rows)),
            drifts,
            with_block,
            oscillators: sizes.iter().map(|size| 1.0 / size).collect(),
            overturning,
            per_resisted: model.per_resisted_moment_in_plane(),
            rate_rad_per_s,
        })
    }

    /// As much of a time as a series in it takes.
    pub(super) fn within_reach(&self, left_s: f64) -> f64 {
        left_s.min(4.0 / self.rate_rad_per_s)
    }

    pub(super) fn modes(&self) -> usize {
        self.omega2.len()
    }

    /// `Ω` and `D`, where no damper couples the modes.
    pub(super) fn uncoupled(&self) -> Option<[&[f64]; 2]> {
        (!self.coupled).then_some([&self.omega2, &self.damping])
    }

    /// The slope's pull along the direction of an oscillator.
    pub(super) fn slope_along(&self, oscillator: usize) -> f64 {
        self.oscillators[oscillator] * inner(self.participation_of(oscillator), self.slope)
    }

    /// `L` of a mode.
    #[inline(always)]
    pub(super) fn participation_of(&self, mode: usize) -> [f64; 2] {
        [self.participation[0][mode], self.participation[1][mode]]
    }

    /// `p` from `P` and the acceleration of the table: what a block at rest is asked for.
    #[inline(always)]
    pub(super) fn push(&self, pull: [f64; 2], table: [f64; 2]) -> [f64; 2] {
        let carried = self.required_friction(table);
        [pull[0] - carried[0], pull[1] - carried[1]]
    }

    /// The force over `M1` that an acceleration asks for.
    #[inline(always)]
    pub(super) fn required_friction(&self, acceleration: [f64; 2]) -> [f64; 2] {
        self.mass.as_ref().map_or(acceleration, |mass| times(&mass.relative, acceleration))
    }

    /// The acceleration that a force over `M1` gives.
    #[inline(always)]
    pub(super) fn moved(&self, force: [f64; 2]) -> [f64; 2] {
        self.mass.as_ref().map_or(force, |mass| times(&mass.inverse, force))
    }

    /// The direction in which a block at rest leaves under a push that friction does not hold.
    pub(super) fn departure(&self, push: [f64; 2], friction: f64) -> [f64; 2] {
        let along = match &self.mass {
            Some(mass) => mass.departure(push, friction).0,
            None => push,
        };
        let size = norm(along);
        along.map(|x| x / size)
    }

    /// Bounds on how much longer than a force over `M1` the acceleration is that it gives, and the other way.
    pub(super) fn stretches(&self) -> [f64; 2] {
        self.mass.as_ref().map_or([1.0; 2], |mass| [mass.compliance(), mass.inertia()])
    }

    /// `g = D η̇ + Ω η`.
    #[inline(always)]
    pub(super) fn restoring(&self, eta: &[f64], rate: &[f64], g: &mut [f64]) {
        let n = g.len();
        if self.coupled {
            for (j, (g, row)) in g.iter_mut().zip(self.damping.chunks_exact(n)).enumerate() {
                *g = self.omega2[j] * eta[j] + dot(row, rate);
            }
        } else {
            for j in 0..n {
                g[j] = self.omega2[j] * eta[j] + self.damping[j] * rate[j];
            }
        }
    }

    /// `L g`: the force of the structure on the block in N.
    #[inline(always)]
    pub(super) fn shear_n(&self, g: &[f64]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (sum, row) in sums.iter_mut().zip(&self.participation) {
            for (l, g) in row.iter().zip(g) {
                *sum += l * g;
            }
        }
        sums
    }

    /// `P` from the shear, `s`, `w` and `N s`, which is asked for of a pendulum.
    #[inline(always)]
    pub(super) fn pull(&self, shear_n: f64, s: f64, w: f64, pressed: f64) -> f64 {
        let springs = self.stiffness_n_per_m * s + pressed * self.per_radius;
        ((shear_n - self.damper_n_s_per_m * w) - springs) / self.block_kg
    }

    /// The stop around the block, where that does not give way and the block bears on it.
    pub(super) fn bears_on(&self, contact: Contact) -> Option<&Ring> {
        let is_borne = matches!(contact, Contact::Pressed(_));
        self.ring.as_ref().filter(|ring| is_borne && ring.restitution.is_some())
    }

    /// What the stop around the block takes of a force on it, over `M1`; of one that does not give way nothing, as
    /// that hangs on all other forces.
    pub(super) fn stopped(&self, state: &State) -> [f64; 2] {
        match (&self.ring, state.contact) {
            (Some(ring), Contact::Pressed(_)) => {
                ring.force_n(state.s, state.w).map(|force_n| force_n / self.block_kg)
            }
            _ => [0.0; 2],
        }
    }

    /// Stiffness and damper of the stop where it is pressed, each over `M1`.
    pub(super) fn stop_per_kg(&self, contact: Contact) -> [f64; 2] {
        match (&self.ring, contact) {
            (Some(Ring { restraint, .. }), Contact::Pressed(_)) => {
                [restraint.stiffness_n_per_m, restraint.damper_n_s_per_m].map(|x| x / self.block_kg)
            }
            _ => [0.0; 2],
        }
    }

    /// The mass-normalised amplitudes of displacements or velocities of the floors; of oscillators those along
    /// their directions are the second list.
    pub(super) fn amplitudes(&self, masses_kg: &[f64], of_floors: [&[f64]; 2]) -> Vec<f64> {
        if !self.oscillators.is_empty() {
            let own = of_floors[1].iter().copied().chain(core::iter::repeat(0.0));
            return self.oscillators.iter().zip(own).map(|(per, d)| d / per).collect();
        }
        let of_mode = |j: usize| {
            let axes = [0, 1].iter().map(|&k| {
                let floors = (0..self.points)
                    .map(|i| self.floors[k].of_mode(i, j) * masses_kg[i] * of_floors[k][i]);
                floors.sum::<f64>()
            });
            axes.sum()
        };
        (0..self.modes()).map(of_mode).collect()
    }
}

/// What the modes and the block add to the overturning moment along an axis, where it is asked for.
fn moment_of_modes(
    model: &Model,
    structure: &Structure,
    (axis, floors, with_block): (usize, &[Vec<f64>], &[Matrix]),
) -> Option<(Rows, [f64; 2])> {
    structure.shares()?;
    [model.block().width_m, model.along_y().width_m][axis]?;
    let modes = floors.first().map_or(0, Vec::len);
    let (mut arm, mut along) = (vec![0.0; modes], [0.0; 2]);
    along[axis] = 0.5 * model.block().height_m.unwrap_or(0.0) * model.bare_block_kg();
    for (i, [mass_kg, above_m]) in model.lever_arms()?.iter().enumerate() {
        let lever = mass_kg * above_m;
        arm.iter_mut().zip(&floors[i]).for_each(|(arm, phi)| *arm += lever * phi);
        if let Some(with_block) = with_block.get(i) {
            along.iter_mut().zip(with_block[axis]).for_each(|(a, part)| *a += lever * part);
        }
    }
    Some((Rows::new(&[arm]), along))
}

/// What moves with the block of a structure by so many modes: its mass in kg, the same in each direction where it is not a
/// multiple of the identity, and what of each point's motion is the block's, where something is.
fn mass_of_block(
    model: &Model,
    structure: &Structure,
    modes: usize,
) -> (f64, Option<Mass>, Vec<Matrix>) {
    // What moves with the block: M_tot I − Σ L Lᵀ.
    let [[x, across], [_, y]] = structure.mass_in_plane_kg();
    let total_kg = model.total_mass_kg();
    let own = [[total_kg - x, -across], [-across, total_kg - y]];
    let with_block: Vec<Matrix> =
        (0..structure.points.len()).map(|i| structure.with_block_in_plane(i)).collect();
    let is_rounding = |x: f64| x.abs() <= ROUNDED * (1.0 + (modes as f64).sqrt());
    let block_kg = 0.5 * (own[0][0] + own[1][1]);
    let all_there = is_rounding(0.5 * (own[0][0] - own[1][1]) / total_kg)
        && is_rounding(across / total_kg)
        && with_block.iter().flatten().flatten().all(|x| is_rounding(*x));
    let mass = if all_there { None } else { Some(Mass::new(own, block_kg)) };
    let with_block = if all_there { Vec::new() } else { with_block };
    (block_kg, mass, with_block)
}

/// Of rows a point each, the sums of masses times those of a point and all after it.
fn above(rows: &[Vec<f64>], masses_kg: &[f64]) -> Vec<Vec<f64>> {
    let mut sums: Vec<Vec<f64>> = Vec::with_capacity(rows.len());
    for (row, kg) in rows.iter().zip(masses_kg).rev() {
        let over = sums.last();
        let sum = |(j, x): (usize, &f64)| kg * x + over.map_or(0.0, |over| over[j]);
        sums.push(row.iter().enumerate().map(sum).collect());
    }
    sums.reverse();
    sums
}

/// Of matrices a point each, likewise.
fn matrices_above(matrices: &[Matrix], masses_kg: &[f64]) -> Vec<Matrix> {
    let rows: Vec<Vec<f64>> =
        matrices.iter().map(|[[a, b], [c, d]]| vec![*a, *b, *c, *d]).collect();
    let matrix = |row: &Vec<f64>| [[row[0], row[1]], [row[2], row[3]]];
    above(&rows, masses_kg).iter().map(matrix).collect()
}

/// `D` of the modes of both axes.
fn damping(axes: &[linear::System; 2], n: usize, coupled: bool) -> Vec<f64> {
    let mut all = vec![0.0; if coupled { 4 * n * n } else { 2 * n }];
    let mut unit = vec![0.0; n];
    for (k, axis) in axes.iter().enumerate() {
        for j in 0..n {
            unit[j] = 1.0;
            let column = axis.drag(&unit);
            unit[j] = 0.0;
            if coupled {
                for (i, d) in column.iter().enumerate() {
                    all[(k * n + i) * 2 * n + k * n + j] = *d;
                }
            } else {
                all[k * n + j] = column[j];
            }
        }
    }
    all
}

/// The state between two events.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) s: [f64; 2],
    pub(super) w: [f64; 2],
    pub(super) eta: Vec<f64>,
    pub(super) rate: Vec<f64>,
    /// With the stop around the block.
    pub(super) contact: Contact,
}

/// Accelerations of the table along x and y, with the slope's pull, and the normal force, each with its rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loads {
    pub(super) table: [[f64; 2]; 2],
    pub(super) normal: [f64; 2],
}

impl State {
    /// One that no stop touches.
    pub(super) fn free(s: [f64; 2], w: [f64; 2], eta: Vec<f64>, rate: Vec<f64>) -> Self {
        Self { s, w, eta, rate, contact: Contact::Free }
    }

    /// At t = 0.
    pub(super) fn initial(system: &System, model: &Model) -> Self {
        let turned = along_y(model);
        let start = [model.initial(), turned.initial()];
        let (q, v) = match model.structure() {
            Some(_) => {
                let of_modes = [
                    model.initial_oscillators_in_plane_m(),
                    turned.initial().storey_velocity_m_per_s.clone().unwrap_or_default(),
                ];
                let [q, v] = of_modes.map(|list| [Vec::new(), list]);
                (q, v)
            }
            None => (
                [model, &turned].map(Model::initial_storey_displacement_m),
                [model, &turned].map(Model::initial_storey_velocity_m_per_s),
            ),
        };
        let masses_kg = &model.frame().masses_kg;
        let s = start.map(|start| start.sliding_displacement_m);
        let w = start.map(|start| start.sliding_velocity_m_per_s);
        Self {
            s,
            w,
            contact: system.ring.map_or(Contact::Free, |ring| ring.contact_at_start(s, w)),
            eta: system.amplitudes(masses_kg, [&q[0], &q[1]]),
            rate: system.amplitudes(masses_kg, [&v[0], &v[1]]),
        }
    }

    /// `P` under loads, leaving `g` behind.
    pub(super) fn pull(&self, system: &System, loads: &Loads, g: &mut [f64]) -> [f64; 2] {
        let pull = self.pull_off_stop(system, loads, g);
        if system.bears_on(self.contact).is_none() {
            return pull;
        }
        apart(pull, self.borne(system, loads.push(system, pull)))
    }

    /// `P` without a stop that does not give way.
    fn pull_off_stop(&self, system: &System, loads: &Loads, g: &mut [f64]) -> [f64; 2] {
        system.restoring(&self.eta, &self.rate, g);
        let (shear_n, stopped) = (system.shear_n(g), system.stopped(self));
        [0, 1].map(|k| {
            let pressed = loads.normal[0] * self.s[k];
            system.pull(shear_n[k], self.s[k], self.w[k], pressed) - stopped[k]
        })
    }

    /// What a stop that does not give way takes over `M1` where the block bears on it, from `p` without it.
    fn borne(&self, system: &System, push: [f64; 2]) -> [f64; 2] {
        let Some(ring) = system.bears_on(self.contact) else { return [0.0; 2] };
        let per_m = ring.bears_per_kg(self.s, self.w, push) / norm(self.s);
        self.s.map(|s| per_m * s)
    }

    /// The same under loads, leaving `g` behind.
    pub(super) fn borne_under(&self, system: &System, loads: &Loads, g: &mut [f64]) -> [f64; 2] {
        let pull = self.pull_off_stop(system, loads, g);
        self.borne(system, loads.push(system, pull))
    }
}

impl Loads {
    /// `p` from `P` at the start.
    pub(super) fn push(&self, system: &System, pull: [f64; 2]) -> [f64; 2] {
        system.push(pull, [self.table[0][0], self.table[1][0]])
    }

    /// These loads from `t` later on.
    pub(super) fn after(&self, t: f64) -> Self {
        let later = |[value, rate]: [f64; 2]| [value + rate * t, rate];
        Self { table: self.table.map(later), normal: later(self.normal) }
    }
}
