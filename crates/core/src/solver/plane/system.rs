//! The equations of motion in two horizontal directions.

use crate::error::SolveError;
use crate::linear;
use crate::model::Model;
use crate::numerics::algebra::dot;
use crate::slider::Kinetic;
use crate::solver::outputs::overturning;
use crate::solver::tables::system_of;

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
pub(in crate::solver) struct System {
    pub(super) storeys: usize,
    /// `M1` in kg.
    pub(super) block_kg: f64,
    /// `K1` in N/m without that of a pendulum, and `C1` in N s/m.
    pub(super) stiffness_n_per_m: f64,
    pub(super) damper_n_s_per_m: f64,
    /// `1/R` in 1/m, 0 where there is no pendulum.
    pub(super) per_radius: f64,
    /// `μ_s/M1` and `μ_k/M1`: times `N` the accelerations that friction holds and takes.
    pub(super) static_per_kg: f64,
    pub(super) kinetic_per_kg: Kinetic,
    omega2: Vec<f64>,
    /// `D`, row by row where the modes are coupled, else its diagonal.
    damping: Vec<f64>,
    coupled: bool,
    /// `L` along x and y.
    pub(super) participation: [Vec<f64>; 2],
    /// `Φ` along x and y: floor `i`, mode `j` at `i * modes + j`; drifts of the storeys in the same way.
    floors: [Vec<f64>; 2],
    drifts: [Vec<f64>; 2],
    /// What the modes and the block add to the overturning moment along x and y, where it is asked for.
    pub(super) overturning: [Option<(Vec<f64>, f64)>; 2],
    /// Bound on the rates in rad/s.
    pub(in crate::solver) rate_rad_per_s: f64,
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
        let refused = |what| SolveError::NotTaken { method: "two horizontal directions", what };
        let slider = model.slider().isotropic().map_err(refused)?;
        if !model.contents().is_empty() {
            return Err(refused("contents"));
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
        let each_axis = |of: &dyn Fn(usize) -> Vec<f64>| [of(0), of(1)];
        let coupled = n > 0 && axes.iter().any(|axis| axis.uncoupled_modes().is_none());
        let per_kg = 1.0 / model.block().mass_kg;
        Ok(Self {
            storeys: n,
            block_kg: model.block().mass_kg,
            stiffness_n_per_m: slider.stiffness_n_per_m,
            damper_n_s_per_m: model.slider().damper_n_s_per_m,
            per_radius: slider.per_radius,
            static_per_kg: slider.fixed * per_kg,
            kinetic_per_kg: slider.kinetic.times(per_kg),
            omega2: if n == 0 {
                Vec::new()
            } else {
                axes.iter().flat_map(|a| a.omega2.clone()).collect()
            },
            damping: damping(&axes, n, coupled),
            coupled,
            participation: each_axis(&|k| place(k, &axes[k].participation)),
            floors: each_axis(&|k| (0..n).flat_map(|i| place(k, axes[k].floor(i))).collect()),
            drifts: each_axis(&|k| (0..n).flat_map(|i| place(k, axes[k].drift(i))).collect()),
            overturning: [0, 1].map(|k| {
                let found = overturning(models[k], &axes[k])?;
                let (arm, block) = found.all();
                Some((place(k, if n == 0 { &[] } else { arm }), block))
            }),
            rate_rad_per_s: axes.iter().fold(0.0, |rate: f64, a| rate.max(a.slip_rate_rad_per_s)),
        })
    }

    pub(super) fn modes(&self) -> usize {
        self.omega2.len()
    }

    /// `Φ_i` of a floor along an axis.
    pub(super) fn floor(&self, axis: usize, floor: usize) -> &[f64] {
        &self.floors[axis][floor * self.modes()..][..self.modes()]
    }

    /// What the modes do to the drift of a storey along an axis.
    pub(super) fn drift(&self, axis: usize, storey: usize) -> &[f64] {
        &self.drifts[axis][storey * self.modes()..][..self.modes()]
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

    /// The overturning moments along x and y without friction, of `P` and `g`; 0 where they are not asked for.
    pub(super) fn moments(&self, pull: [f64; 2], g: &[f64]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let of = self.overturning[axis].as_ref();
            of.map_or(0.0, |(arm, block)| block * pull[axis] - dot(arm, g))
        })
    }

    /// `P` from the shear, `s`, `w` and `N s`, which is asked for of a pendulum.
    #[inline(always)]
    pub(super) fn pull(&self, shear_n: f64, s: f64, w: f64, pressed: f64) -> f64 {
        let springs = self.stiffness_n_per_m * s + pressed * self.per_radius;
        ((shear_n - self.damper_n_s_per_m * w) - springs) / self.block_kg
    }

    /// The mass-normalised amplitudes of displacements or velocities of the floors.
    pub(super) fn amplitudes(&self, masses_kg: &[f64], of_floors: [&[f64]; 2]) -> Vec<f64> {
        let of_mode = |j: usize| {
            let axes = [0, 1].iter().map(|&k| {
                let floors =
                    (0..self.storeys).map(|i| self.floor(k, i)[j] * masses_kg[i] * of_floors[k][i]);
                floors.sum::<f64>()
            });
            axes.sum()
        };
        (0..self.modes()).map(of_mode).collect()
    }
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
}

/// Accelerations of the table along x and y and the normal force, each with its rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loads {
    pub(super) table: [[f64; 2]; 2],
    pub(super) normal: [f64; 2],
}

impl State {
    /// At t = 0.
    pub(super) fn initial(system: &System, model: &Model) -> Self {
        let turned = along_y(model);
        let start = [model.initial(), turned.initial()];
        let q = [model, &turned].map(Model::initial_storey_displacement_m);
        let v = [model, &turned].map(Model::initial_storey_velocity_m_per_s);
        let masses_kg = &model.frame().masses_kg;
        Self {
            s: start.map(|start| start.sliding_displacement_m),
            w: start.map(|start| start.sliding_velocity_m_per_s),
            eta: system.amplitudes(masses_kg, [&q[0], &q[1]]),
            rate: system.amplitudes(masses_kg, [&v[0], &v[1]]),
        }
    }

    /// `P`, leaving `g` behind.
    pub(super) fn pull(&self, system: &System, normal_n: f64, g: &mut [f64]) -> [f64; 2] {
        system.restoring(&self.eta, &self.rate, g);
        let shear_n = system.shear_n(g);
        [0, 1].map(|k| system.pull(shear_n[k], self.s[k], self.w[k], normal_n * self.s[k]))
    }
}

impl Loads {
    /// `p` from `P` at the start.
    pub(super) fn push(&self, pull: [f64; 2]) -> [f64; 2] {
        [pull[0] - self.table[0][0], pull[1] - self.table[1][0]]
    }

    /// The same so much later.
    pub(super) fn after(&self, t: f64) -> Self {
        let later = |[value, rate]: [f64; 2]| [value + rate * t, rate];
        Self { table: self.table.map(later), normal: later(self.normal) }
    }
}

/// Length of a vector.
#[inline(always)]
pub(super) fn norm([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// Scalar product.
#[inline(always)]
pub(super) fn inner(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// `a × b`.
#[inline(always)]
pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
