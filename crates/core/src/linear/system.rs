//! The equations of motion in coordinates in which they are cheap.

use super::frame::shear_frame_modes;

/// One value a storey: an array where their number is known when compiling, else a vector.
///
/// The same source then serves the rigid block, one storey (both held in registers) and frames.
pub trait PerStorey: Clone + core::fmt::Debug + AsRef<[f64]> + AsMut<[f64]> {
    /// Storage of [`Tracked`](Self::Tracked) quantities: six of the system and three a storey.
    type Tracked: Clone + core::fmt::Debug + AsRef<[f64]> + AsMut<[f64]>;

    /// Storage of a [`State`](super::State): two values of the block and two a storey.
    type Flat: Clone + core::fmt::Debug + PartialEq + AsRef<[f64]> + AsMut<[f64]>;

    /// Storage of a matrix over the storeys.
    type Square: Clone + core::fmt::Debug + AsRef<[f64]> + AsMut<[f64]>;

    /// Storage of a matrix over states, column by column.
    type Columns: Clone + core::fmt::Debug + AsRef<[Self::Flat]> + AsMut<[Self::Flat]>;

    /// Zeros for `n` storeys.
    fn zeros(n: usize) -> Self;

    /// Zeros for the state of `n` storeys.
    fn flat_zeros(n: usize) -> Self::Flat;

    /// The same value for all tracked quantities of `n` storeys.
    fn tracked(n: usize, value: f64) -> Self::Tracked;

    /// A matrix of zeros over `n` storeys.
    fn square_zeros(n: usize) -> Self::Square;

    /// A matrix of zeros over the states of `n` storeys.
    fn columns_zeros(n: usize) -> Self::Columns;
}

impl PerStorey for [f64; 0] {
    type Tracked = [f64; 6];
    type Flat = [f64; 2];
    type Square = [f64; 0];
    type Columns = [[f64; 2]; 2];

    fn zeros(_: usize) -> Self {
        []
    }

    fn flat_zeros(_: usize) -> Self::Flat {
        [0.0; 2]
    }

    fn tracked(_: usize, value: f64) -> Self::Tracked {
        [value; 6]
    }

    fn square_zeros(_: usize) -> Self::Square {
        []
    }

    fn columns_zeros(_: usize) -> Self::Columns {
        [[0.0; 2]; 2]
    }
}

impl PerStorey for [f64; 1] {
    type Tracked = [f64; 9];
    type Flat = [f64; 4];
    type Square = [f64; 1];
    type Columns = [[f64; 4]; 4];

    fn zeros(_: usize) -> Self {
        [0.0]
    }

    fn flat_zeros(_: usize) -> Self::Flat {
        [0.0; 4]
    }

    fn tracked(_: usize, value: f64) -> Self::Tracked {
        [value; 9]
    }

    fn square_zeros(_: usize) -> Self::Square {
        [0.0]
    }

    fn columns_zeros(_: usize) -> Self::Columns {
        [[0.0; 4]; 4]
    }
}

impl PerStorey for Vec<f64> {
    type Tracked = Self;
    type Flat = Self;
    type Square = Self;
    type Columns = Vec<Self>;

    fn zeros(n: usize) -> Self {
        vec![0.0; n]
    }

    fn flat_zeros(n: usize) -> Self::Flat {
        vec![0.0; 2 + 2 * n]
    }

    fn tracked(n: usize, value: f64) -> Self::Tracked {
        vec![value; 6 + 3 * n]
    }

    fn square_zeros(n: usize) -> Self::Square {
        vec![0.0; n * n]
    }

    fn columns_zeros(n: usize) -> Self::Columns {
        vec![vec![0.0; 2 + 2 * n]; 2 + 2 * n]
    }
}

/// Block, spring, damper and structure in mass-normalised storey coordinates `η`, `q = Φ η`.
///
/// With `L = Φᵀ M 1`, `f = D η̇ + Ω η` and `u = s̈ + a` eqs (9)–(12) read
///
/// ```text
/// structure   η̈ = −f − L u              (so floor i accelerates by −Φ_i f)
/// slip        u = (T − C1 ṡ − K1 s + L·f) / M1
/// stick       u = a,  T = M1 a + K1 s − L·f
/// ```
///
/// `η` are the fixed-base modes where damping is a ratio (Ω and D diagonal), else the floors
/// themselves (Ω and D tridiagonal): either way neighbours couple at most.
#[derive(Clone, Debug)]
pub struct System<V: PerStorey> {
    /// Mass of the block `M1` in kg.
    pub block_mass_kg: f64,
    /// `1 / M1`: a product is cheaper than a division.
    pub per_block_mass: f64,
    /// Stiffness `K1` in N/m.
    pub stiffness_n_per_m: f64,
    /// Damper `C1` in N s/m.
    pub damper_n_s_per_m: f64,
    /// `L` in kg^(1/2).
    pub participation: V,
    /// `Ω L / M1` and `D L / M1`: what `η` and `η̇` do to the block's acceleration.
    block_rows: [V; 2],
    /// `K1 / M1` and `C1 / M1`: what `s` and `ṡ` take from it.
    block_own: [f64; 2],
    /// `Φ` in kg^(−1/2), column by column: floor `i`, coordinate `j` at `i + j * n`.
    pub shapes: V::Square,
    /// Bound on the rates of stick in rad/s: of `‖A x‖` over `‖x‖` in the energy norm.
    pub stick_rate_rad_per_s: f64,
    /// Bound on the rates of slip in rad/s, not below that of stick.
    pub slip_rate_rad_per_s: f64,
    stiffness: V,
    stiffness_next: V,
    damping: V,
    damping_next: V,
    coupled: bool,
}

/// Damping of the storeys, as [`System::new`] takes it.
#[derive(Clone, Copy, Debug)]
pub enum StoreyDamping<'a> {
    /// The same ratio of critical damping in every fixed-base mode.
    Ratio(f64),
    /// Dampers between neighbouring floors in N s/m, from the block up.
    Dampers(&'a [f64]),
}

impl<V: PerStorey> System<V> {
    /// The system of a block of `block_mass_kg` on a spring and damper, with a shear frame whose
    /// floors and storeys are listed from the block up.
    #[must_use]
    pub fn new(
        block_mass_kg: f64,
        stiffness_n_per_m: f64,
        damper_n_s_per_m: f64,
        masses_kg: &[f64],
        stiffnesses_n_per_m: &[f64],
        damping: StoreyDamping<'_>,
    ) -> Self {
        let n = masses_kg.len();
        let mut system = Self {
            block_mass_kg,
            per_block_mass: 1.0 / block_mass_kg,
            stiffness_n_per_m,
            damper_n_s_per_m,
            participation: V::zeros(n),
            block_rows: [V::zeros(n), V::zeros(n)],
            block_own: [0.0; 2],
            shapes: V::square_zeros(n),
            stick_rate_rad_per_s: 0.0,
            slip_rate_rad_per_s: 0.0,
            stiffness: V::zeros(n),
            stiffness_next: V::zeros(n),
            damping: V::zeros(n),
            damping_next: V::zeros(n),
            coupled: false,
        };
        match damping {
            StoreyDamping::Ratio(ratio) => {
                system.in_modes(masses_kg, stiffnesses_n_per_m, ratio);
            }
            StoreyDamping::Dampers(dampers) => {
                system.in_floors(masses_kg, stiffnesses_n_per_m, dampers);
            }
        }
        let (participation, shapes) = (system.participation.as_mut(), system.shapes.as_ref());
        for (j, l) in participation.iter_mut().enumerate() {
            *l = dot(&shapes[j * n..(j + 1) * n], masses_kg);
        }
        let (l, zero) = (system.participation.clone(), V::zeros(n));
        let pull = system.restoring(l.as_ref(), zero.as_ref());
        let drag = system.restoring(zero.as_ref(), l.as_ref());
        for (row, force) in system.block_rows.iter_mut().zip([&pull, &drag]) {
            for (row, force) in row.as_mut().iter_mut().zip(force.as_ref()) {
                *row = force * system.per_block_mass;
            }
        }
        system.set_rates();
        system
    }

    /// Fixed-base modes as coordinates: Ω = diag ω², D = diag 2 ξ ω.
    fn in_modes(&mut self, masses_kg: &[f64], stiffnesses_n_per_m: &[f64], ratio: f64) {
        let n = masses_kg.len();
        if n == 1 {
            // Without the detour through the frequency, which costs two roundings.
            self.stiffness.as_mut()[0] = stiffnesses_n_per_m[0] / masses_kg[0];
            self.damping.as_mut()[0] = 2.0 * ratio * (stiffnesses_n_per_m[0] / masses_kg[0]).sqrt();
            self.shapes.as_mut()[0] = 1.0 / masses_kg[0].sqrt();
            return;
        }
        let modes = shear_frame_modes(masses_kg, stiffnesses_n_per_m);
        for (j, omega) in modes.frequencies_rad_per_s.iter().enumerate() {
            self.stiffness.as_mut()[j] = omega * omega;
            self.damping.as_mut()[j] = 2.0 * ratio * omega;
        }
        let shapes = self.shapes.as_mut();
        for i in 0..n {
            for j in 0..n {
                shapes[i + j * n] = modes.shapes[i * n + j];
            }
        }
    }

    /// Mass-weighted floors as coordinates: Ω and D tridiagonal.
    fn in_floors(&mut self, masses_kg: &[f64], stiffnesses_n_per_m: &[f64], dampers: &[f64]) {
        let n = masses_kg.len();
        self.coupled = n > 1;
        for (values, diagonal, next) in [
            (stiffnesses_n_per_m, &mut self.stiffness, &mut self.stiffness_next),
            (dampers, &mut self.damping, &mut self.damping_next),
        ] {
            for i in 0..n {
                let above = values.get(i + 1).copied().unwrap_or(0.0);
                diagonal.as_mut()[i] = (values[i] + above) / masses_kg[i];
                if i + 1 < n {
                    next.as_mut()[i] = -above / (masses_kg[i] * masses_kg[i + 1]).sqrt();
                }
            }
        }
        for i in 0..n {
            self.shapes.as_mut()[i * n + i] = 1.0 / masses_kg[i].sqrt();
        }
    }

    /// Bounds on the rates. With the mass matrix `[[M_tot, Lᵀ], [L, 1]]` the largest eigenvalue of
    /// the slip system is at most that of Ω plus `(K1 + Lᵀ Ω L) / M1` (Weyl), likewise for D; Ω and
    /// D are bounded by their largest row sums (Gershgorin).
    fn set_rates(&mut self) {
        let n = self.participation.as_ref().len();
        let row_sum = |diagonal: &V, next: &V| {
            let (d, e) = (diagonal.as_ref(), next.as_ref());
            (0..n).fold(0.0_f64, |largest, i| {
                let below = if i > 0 { e[i - 1].abs() } else { 0.0 };
                largest.max(d[i] + below + e[i].abs())
            })
        };
        let omega2 = row_sum(&self.stiffness, &self.stiffness_next);
        let decay = row_sum(&self.damping, &self.damping_next);
        let l = self.participation.as_ref();
        let [pull, drag] = self.block_rows.each_ref().map(|row| dot(l, row.as_ref()));
        let [spring, damper] =
            [self.stiffness_n_per_m, self.damper_n_s_per_m].map(|c| c * self.per_block_mass);
        self.block_own = [spring, damper];
        self.stick_rate_rad_per_s = omega2.sqrt() + decay;
        self.slip_rate_rad_per_s = (omega2 + (spring + pull)).sqrt() + decay + (damper + drag);
    }

    /// Number of storeys.
    #[must_use]
    pub fn storeys(&self) -> usize {
        self.participation.as_ref().len()
    }

    /// `f = D η̇ + Ω η`: what springs and dampers of the structure do to each coordinate.
    #[inline(always)]
    #[must_use]
    pub fn restoring(&self, x: &[f64], v: &[f64]) -> V {
        let mut f = V::zeros(x.len());
        self.restoring_into(x, v, f.as_mut());
        f
    }

    /// [`System::restoring`] into a slice.
    #[inline(always)]
    pub fn restoring_into(&self, x: &[f64], v: &[f64], f: &mut [f64]) {
        let (k, d) = (self.stiffness.as_ref(), self.damping.as_ref());
        for (j, f) in f.iter_mut().enumerate() {
            *f = k[j] * x[j] + d[j] * v[j];
        }
        if self.coupled {
            let (k, d) = (self.stiffness_next.as_ref(), self.damping_next.as_ref());
            for j in 0..f.len() - 1 {
                f[j] += k[j] * x[j + 1] + d[j] * v[j + 1];
                f[j + 1] += k[j] * x[j] + d[j] * v[j];
            }
        }
    }

    /// `L·f` in N: the base shear.
    #[inline(always)]
    #[must_use]
    pub fn base_shear_n(&self, f: &[f64]) -> f64 {
        dot(self.participation.as_ref(), f)
    }

    /// Acceleration `u` of the block in slip under a friction force and a base shear.
    #[inline(always)]
    #[must_use]
    pub fn block_acceleration(&self, s: f64, w: f64, shear_n: f64, friction_n: f64) -> f64 {
        ((friction_n - self.damper_n_s_per_m * w) + (shear_n - self.stiffness_n_per_m * s))
            * self.per_block_mass
    }

    /// The force `M1 a + K1 s − L·f` that keeps the block stuck, eqs (8), (14).
    #[inline(always)]
    #[must_use]
    pub fn demand_n(&self, s: f64, shear_n: f64, a: f64) -> f64 {
        (self.block_mass_kg * a + self.stiffness_n_per_m * s) - shear_n
    }

    /// The same, coefficient by coefficient in a series, under a friction force over `M1`.
    #[inline(always)]
    #[must_use]
    pub fn block_response(
        &self,
        s: f64,
        w: f64,
        eta: &[f64],
        eta_dot: &[f64],
        friction: f64,
    ) -> f64 {
        let [of_eta, of_eta_dot] = self.block_rows.each_ref().map(AsRef::as_ref);
        let [of_s, of_w] = self.block_own;
        ((friction - of_s * s) + dot(of_eta, eta)) + (dot(of_eta_dot, eta_dot) - of_w * w)
    }

    /// `ẍ`'s size: the energy norm of the second derivative of the state, in N^(1/2) m^(1/2) s⁻².
    ///
    /// `‖x‖² = K1 s² + M1 ṡ² + ηᵀ Ω η + |η̇ + L ṡ|²`, twice the energy. While the loads are linear
    /// in time `ẍ` follows the unloaded system, whose energy dampers can only spend: the norm at the
    /// start of an interval bounds it throughout, and with it the second derivative of every
    /// linear function of the state by that function's [dual norm](System::dual_norm).
    #[inline(always)]
    #[must_use]
    pub fn energy_norm(&self, s: f64, w: f64, eta: &[f64], eta_dot: &[f64]) -> f64 {
        let l = self.participation.as_ref();
        let mut f = V::zeros(eta.len());
        self.elastic_into(eta, f.as_mut());
        let mut twice = self.stiffness_n_per_m * s * s + self.block_mass_kg * w * w;
        for (j, f) in f.as_ref().iter().enumerate() {
            let momentum = eta_dot[j] + l[j] * w;
            twice += f * eta[j] + momentum * momentum;
        }
        // Rounding can leave a hair below zero where floors are the coordinates.
        twice.max(0.0).sqrt()
    }

    /// Largest value on states of energy norm 1 of
    /// the row `s · s + w · ṡ + yᵀ Ω η + eta_dot · η̇`.
    #[must_use]
    pub fn dual_norm(&self, s: f64, w: f64, y: &[f64], eta_dot: &[f64]) -> f64 {
        let mut square = if s == 0.0 { 0.0 } else { s * s / self.stiffness_n_per_m };
        let momentum = w - dot(eta_dot, self.participation.as_ref());
        square += momentum * momentum / self.block_mass_kg + dot(eta_dot, eta_dot);
        let mut elastic = V::zeros(y.len());
        self.elastic_into(y, elastic.as_mut());
        square += dot(y, elastic.as_ref()).max(0.0);
        square.sqrt()
    }

    /// `Ω η`.
    #[inline(always)]
    fn elastic_into(&self, eta: &[f64], f: &mut [f64]) {
        let k = self.stiffness.as_ref();
        for (j, f) in f.iter_mut().enumerate() {
            *f = k[j] * eta[j];
        }
        if self.coupled {
            let k = self.stiffness_next.as_ref();
            for j in 0..f.len() - 1 {
                f[j] += k[j] * eta[j + 1];
                f[j + 1] += k[j] * eta[j];
            }
        }
    }

    /// `D v`.
    #[must_use]
    pub fn drag(&self, v: &[f64]) -> V {
        self.restoring(V::zeros(v.len()).as_ref(), v)
    }

    /// Floor values `Φ η` of coordinates `η`.
    #[inline(always)]
    pub fn floors(&self, eta: &[f64], out: &mut [f64]) {
        let (n, shapes) = (eta.len(), self.shapes.as_ref());
        for (j, eta) in eta.iter().enumerate() {
            for (out, shape) in out.iter_mut().zip(&shapes[j * n..(j + 1) * n]) {
                *out = if j == 0 { shape * eta } else { *out + shape * eta };
            }
        }
    }

    /// Row of `Φ`: what the coordinates do to one floor.
    #[must_use]
    pub fn floor(&self, floor: usize) -> V {
        let n = self.storeys();
        let mut row = V::zeros(n);
        for (j, row) in row.as_mut().iter_mut().enumerate() {
            *row = self.shapes.as_ref()[floor + j * n];
        }
        row
    }

    /// Coordinates `η = Φᵀ M q` of floor values `q`.
    #[must_use]
    pub fn coordinates(&self, masses_kg: &[f64], floors: &[f64]) -> V {
        let n = self.storeys();
        let mut eta = V::zeros(n);
        for (j, eta) in eta.as_mut().iter_mut().enumerate() {
            let shape = &self.shapes.as_ref()[j * n..(j + 1) * n];
            *eta = (0..n).fold(0.0, |sum, i| sum + shape[i] * masses_kg[i] * floors[i]);
        }
        eta
    }
}

/// Sum of products in order, from the first.
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut products = a.iter().zip(b).map(|(x, y)| x * y);
    let Some(first) = products.next() else { return 0.0 };
    products.fold(first, |sum, product| sum + product)
}
