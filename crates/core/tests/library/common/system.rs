//! The equations of motion of a model in double-double numbers, and their Taylor series.
//!
//! In physical coordinates, with `α` the true accelerations plus `g sin θ`, `f = K q + C q̇` the
//! forces of the structure on its floors and `b = Ü + g sin θ`:
//!
//! ```text
//! m_i α_i = −f_i        M1 α_0 = T − C1 ṡ − K1 s + Σ f_i        s̈ = α_0 − b        q̈_i = α_i − α_0
//! stick: s̈ = 0, T = M1 b + K1 s − Σ f_i        slip: T = −μ_k N sgn ṡ
//! ```

use std::sync::OnceLock;

use slipstick::model::{Damping, Model};

use super::bernstein::{DEGREE, Poly};
use super::dd::{Dd, ONE, ZERO};

/// Matrices and friction of a model.
pub struct System {
    pub n: usize,
    pub block_kg: Dd,
    pub total_kg: Dd,
    pub masses: Vec<Dd>,
    /// One over the masses, the block's first.
    inverses: Vec<Dd>,
    /// Rows of the stiffness and damping matrices.
    pub stiffness: Vec<Vec<Dd>>,
    pub damping: Vec<Vec<Dd>>,
    pub spring: Dd,
    pub damper: Dd,
    /// Friction for sliding towards +x and −x.
    pub static_friction: [Dd; 2],
    pub kinetic_friction: [Dd; 2],
    pub slope: Dd,
    pub normal_gravity: Dd,
    /// Bound on the rate of the fastest motion, in 1/s.
    pub rate: f64,
}

/// Sliding displacement and velocity, storey displacements and velocities.
#[derive(Clone, Debug)]
pub struct State {
    pub s: Dd,
    pub w: Dd,
    pub q: Vec<Dd>,
    pub v: Vec<Dd>,
}

/// Accelerations `b` and `N / M_tot` of the table, linear over a step: value and increment.
#[derive(Clone, Copy)]
pub struct Load {
    pub b: [Dd; 2],
    pub normal: [Dd; 2],
}

impl Load {
    /// Over a step between acceleration and normal force over mass at its ends.
    pub fn between(from: [Dd; 2], to: [Dd; 2]) -> Self {
        let [b, normal] = [0, 1].map(|i| [from[i], to[i] - from[i]]);
        Self { b, normal }
    }
}

/// Taylor coefficients of one phase over one step, in the unit of the step.
pub struct Series {
    pub s: Poly<Dd>,
    pub w: Poly<Dd>,
    pub q: Vec<Poly<Dd>>,
    pub v: Vec<Poly<Dd>>,
    /// `α_0` and `α_i`.
    pub block: Poly<Dd>,
    pub floors: Vec<Poly<Dd>>,
    /// Friction force `T` and the force `Σ f_i` of the structure on the block.
    pub friction: Poly<Dd>,
    pub shear: Poly<Dd>,
}

impl Series {
    /// Makes `[0, to]` the unit interval.
    pub fn cut(&mut self, to: Dd) {
        let single =
            [&mut self.s, &mut self.w, &mut self.block, &mut self.friction, &mut self.shear];
        let lists = [&mut self.q, &mut self.v, &mut self.floors];
        let all = lists.into_iter().flatten().chain(single);
        for p in all {
            let mut power = ONE;
            for c in p {
                *c = *c * power;
                power = power * to;
            }
        }
    }
}

impl System {
    pub fn new(model: &Model) -> Self {
        let frame = model.frame();
        let n = model.storeys();
        let dd = |values: &[f64]| values.iter().map(|&x| Dd::from(x)).collect::<Vec<_>>();
        let masses = dd(&frame.masses_kg);
        let stiffness = chain(&dd(&frame.stiffnesses_n_per_m));
        let damping = match &frame.damping {
            Damping::Dampers(c) => chain(&dd(c)),
            Damping::Ratio(ratio) => modal_damping(&masses, &stiffness, *ratio),
        };
        let slider = model.slider();
        let block_kg = Dd::from(model.block().mass_kg);
        let mut system = Self {
            n,
            block_kg,
            inverses: [block_kg].iter().chain(&masses).map(|&m| ONE / m).collect(),
            total_kg: masses.iter().fold(block_kg, |sum, &m| sum + m),
            masses,
            stiffness,
            damping,
            spring: Dd::from(model.slider_stiffness_n_per_m()),
            damper: Dd::from(slider.damper_n_s_per_m),
            static_friction: model.static_friction().map(Dd::from),
            kinetic_friction: model.kinetic_friction().map(Dd::from),
            slope: Dd::from(model.slope_m_per_s2()),
            normal_gravity: Dd::from(model.normal_gravity_m_per_s2()),
            rate: 0.0,
        };
        system.rate = system.fastest();
        system
    }

    /// √‖K‖ + ‖C‖ with the largest row sums of the matrices over the masses: no motion of the
    /// system has a larger rate.
    fn fastest(&self) -> f64 {
        let norm = |matrix: &[Vec<Dd>], link: Dd| {
            let row = |r: &Vec<Dd>| r.iter().fold(0.0, |sum, x| sum + x.abs().value());
            let column = |j: usize| matrix.iter().fold(ZERO, |sum, r| sum + r[j]).abs().value();
            let all: f64 = (0..self.n).map(column).sum();
            let block = (link.value() + all) / self.block_kg.value();
            let rows = matrix.iter().zip(&self.masses).map(|(r, m)| row(r) / m.value());
            block + rows.fold(0.0, f64::max)
        };
        norm(&self.stiffness, self.spring).sqrt() + norm(&self.damping, self.damper)
    }

    /// Series from a state over `h` seconds; `sign` is that of the sliding velocity, 0 in stick.
    pub fn series(&self, state: &State, load: Load, h: Dd, sign: i32) -> Series {
        let n = self.n;
        let zero = [ZERO; DEGREE + 1];
        let mut x = Series {
            s: zero,
            w: zero,
            q: vec![zero; n],
            v: vec![zero; n],
            block: zero,
            floors: vec![zero; n],
            friction: zero,
            shear: zero,
        };
        (x.s[0], x.w[0]) = (state.s, state.w);
        for i in 0..n {
            (x.q[i][0], x.v[i][0]) = (state.q[i], state.v[i]);
        }
        let kinetic = self.kinetic_friction[usize::from(sign < 0)] * self.total_kg;
        for k in 0..=DEGREE {
            let input = |pair: [Dd; 2]| if k < 2 { pair[k] } else { ZERO };
            let mut shear = ZERO;
            for i in 0..n {
                let mut force = ZERO;
                for j in 0..n {
                    force += self.stiffness[i][j] * x.q[j][k] + self.damping[i][j] * x.v[j][k];
                }
                x.floors[i][k] = -(force * self.inverses[i + 1]);
                shear += force;
            }
            x.shear[k] = shear;
            let link = self.spring * x.s[k];
            if sign == 0 {
                x.block[k] = input(load.b);
                x.friction[k] = self.block_kg * input(load.b) + link - shear;
            } else {
                x.friction[k] = kinetic * input(load.normal) * f64::from(-sign);
                let force = x.friction[k] - link - self.damper * x.w[k] + shear;
                x.block[k] = force * self.inverses[0];
            }
            if k == DEGREE {
                break;
            }
            let step = h * reciprocals()[k];
            if sign != 0 {
                x.s[k + 1] = x.w[k] * step;
                x.w[k + 1] = (x.block[k] - input(load.b)) * step;
            }
            for i in 0..n {
                x.q[i][k + 1] = x.v[i][k] * step;
                x.v[i][k + 1] = (x.floors[i][k] - x.block[k]) * step;
            }
        }
        x
    }
}

/// `1/(k + 1)`.
fn reciprocals() -> &'static Poly<Dd> {
    static RECIPROCALS: OnceLock<Poly<Dd>> = OnceLock::new();
    RECIPROCALS.get_or_init(|| std::array::from_fn(|k| ONE / Dd::from((k + 1) as f64)))
}

/// Matrix of springs (or dampers) between neighbouring floors.
fn chain(links: &[Dd]) -> Vec<Vec<Dd>> {
    let n = links.len();
    let mut matrix = vec![vec![ZERO; n]; n];
    for (i, &link) in links.iter().enumerate() {
        matrix[i][i] += link;
        if i > 0 {
            matrix[i - 1][i - 1] += link;
            matrix[i - 1][i] = -link;
            matrix[i][i - 1] = -link;
        }
    }
    matrix
}

/// `C = M Φ diag(2ξω) Φᵀ M = 2ξ M (M⁻¹ K)^½`: the square root by Denman and Beavers' iteration
/// `Y ← (Y + Z⁻¹)/2, Z ← (Z + Y⁻¹)/2` from `Y = M⁻¹ K, Z = 1`, without any modes.
fn modal_damping(masses: &[Dd], stiffness: &[Vec<Dd>], ratio: f64) -> Vec<Vec<Dd>> {
    let n = masses.len();
    if n == 0 || ratio == 0.0 {
        return vec![vec![ZERO; n]; n];
    }
    let each = |f: &dyn Fn(usize, usize) -> Dd| -> Vec<Vec<Dd>> {
        (0..n).map(|i| (0..n).map(|j| f(i, j)).collect()).collect()
    };
    // Scaled to a size near 1, where the iteration converges fastest.
    let size = Dd::from(stiffness[0][0].value() / masses[0].value());
    let mut y = each(&|i, j| stiffness[i][j] / masses[i] / size);
    let mut z = each(&|i, j| if i == j { ONE } else { ZERO });
    for _ in 0..60 {
        let (y_inverse, z_inverse) = (inverse(&y), inverse(&z));
        let next = each(&|i, j| (y[i][j] + z_inverse[i][j]).half());
        z = each(&|i, j| (z[i][j] + y_inverse[i][j]).half());
        y = next;
    }
    // √size, by one Newton step from the double.
    let guess = Dd::from(size.value().sqrt());
    let root = (guess + size / guess).half();
    each(&|i, j| masses[i] * y[i][j] * root * (2.0 * ratio))
}

/// Inverse of a matrix whose leading minors are positive, by Gauss and Jordan without pivoting.
fn inverse(matrix: &[Vec<Dd>]) -> Vec<Vec<Dd>> {
    let n = matrix.len();
    let mut a = matrix.to_vec();
    for p in 0..n {
        let pivot = ONE / a[p][p];
        a[p][p] = ONE;
        for x in &mut a[p] {
            *x = *x * pivot;
        }
        for i in 0..n {
            if i != p {
                let factor = a[i][p];
                a[i][p] = ZERO;
                for j in 0..n {
                    let change = factor * a[p][j];
                    a[i][j] = a[i][j] - change;
                }
            }
        }
    }
    a
}
