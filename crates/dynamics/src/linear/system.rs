//! The equations of motion in modal coordinates.

use fearless_simd::f64x4;
use fearless_simd::prelude::*;

use super::frame::shear_frame_modes;
use super::lanes::{Four, dot, four, sum_of_lanes};

/// Block, spring, damper and structure in the structure's fixed-base modes `η`, `q = Φ η`.
///
/// With `L = Φᵀ M 1`, `f = D η̇ + Ω η` and `u = s̈ + a` eqs (9)–(12) read
///
/// ```text
/// structure   η̈ = −f − L u              (so floor i accelerates by −Φ_i f)
/// slip        u = (T − c ṡ − k s + L·f) / M1
/// stick       u = a,  T = M1 a + k s − L·f
/// ```
///
/// Ω is diagonal, and so is D where damping is a ratio. A rigid block has one coordinate that nothing
/// moves and that moves nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// Number of storeys.
    pub storeys: usize,
    /// Mass of the block `M1` in kg.
    pub block_mass_kg: f64,
    /// `1 / M1`: a product is cheaper than a division.
    pub per_block_mass: f64,
    /// `1/√M1`, the energy norm of what a unit of force on the block does.
    pub per_root_block: f64,
    /// `√M_tot`, the energy norm of what a unit of acceleration does.
    pub root_total_mass: f64,
    /// `√Σ m_i`, the same of the structure alone.
    pub root_storey_mass: f64,
    /// Stiffness between ground and block in N/m.
    pub stiffness_n_per_m: f64,
    /// Damper between ground and block in N s/m.
    pub damper_n_s_per_m: f64,
    /// `L` in kg^(1/2).
    pub participation: Vec<f64>,
    /// `Ω = ω²` in s⁻².
    pub omega2: Vec<f64>,
    /// `D` in s⁻¹, row by row where the modes are coupled, else its diagonal.
    damping: Vec<f64>,
    coupled: bool,
    /// Where they are not, Ω, D and L of four modes at a time.
    by_four: Vec<Modes>,
    /// `Φ` in kg^(−1/2), row by row: floor `i`, mode `j` at `i * n + j`.
    shapes: Vec<f64>,
    /// Drift of storey `i` in mode `j`, in the same way.
    drifts: Vec<f64>,
    /// Points of a structure by its modes.
    points: Option<Points>,
    /// Bound on the rates of stick in rad/s: of `‖A x‖` over `‖x‖` in the energy norm.
    pub stick_rate_rad_per_s: f64,
    /// Bound on the rates of slip in rad/s, not below that of stick.
    pub slip_rate_rad_per_s: f64,
}

/// Points of a structure by its modes.
#[derive(Clone, Debug, PartialEq)]
struct Points {
    /// Displacements in kg^(−1/2), and differences from the point before: point `i`, mode `j` at `i * n + j`.
    shapes: Vec<f64>,
    drifts: Vec<f64>,
    /// What of each point's motion is the block's.
    with_block: Vec<f64>,
}

/// Four numbers of a padded list from a place on, zeros beyond its end.
#[inline(always)]
fn four_from<S: Simd>(simd: S, x: &[f64], at: usize) -> f64x4<S> {
    if let Some(x) = x.get(at..at + 4) {
        return f64x4::from_slice(simd, x);
    }
    let (last, zero) = (f64x4::from_slice(simd, &x[x.len() - 4..]), four(simd, 0.0));
    match x.len() - at {
        3 => simd.slide_f64x4::<1>(last, zero),
        2 => simd.slide_f64x4::<2>(last, zero),
        _ => simd.slide_f64x4::<3>(last, zero),
    }
}

/// Ω, D and L of four modes that nothing couples, zeros beyond the last.
pub type Modes = [Four; 3];

/// Damping of the storeys, as [`System::new`] takes it.
#[derive(Clone, Copy, Debug)]
pub enum StoreyDamping<'a> {
    /// One ratio of critical damping for every fixed-base mode.
    Ratio(f64),
    /// Dampers between neighbouring floors in N s/m, from the block up.
    Dampers(&'a [f64]),
}

impl System {
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
        let slider = (block_mass_kg, stiffness_n_per_m, damper_n_s_per_m);
        let mut system = Self::unfinished(slider, masses_kg);
        if !masses_kg.is_empty() {
            system.set_modes(masses_kg, stiffnesses_n_per_m);
            system.set_damping(damping);
        }
        system.finished()
    }

    /// A block with oscillators that stand each on it: modes by their effective masses. To every
    /// point each adds its displacement times a factor; the rest of the point's motion is the block's.
    #[must_use]
    pub fn of_oscillators(
        slider: (f64, f64, f64),
        (masses_kg, stiffnesses_n_per_m, dampers): (&[f64], &[f64], &[f64]),
        points: &[Vec<f64>],
    ) -> Self {
        let n = masses_kg.len();
        let mut system = Self::unfinished(slider, masses_kg);
        let roots: Vec<f64> = masses_kg.iter().map(|m| m.sqrt()).collect();
        let over = |list: &[f64]| list.iter().zip(masses_kg).map(|(x, m)| x / m).collect();
        (system.omega2, system.damping) = (over(stiffnesses_n_per_m), over(dampers));
        system.shapes = vec![0.0; n * n];
        for (j, root) in roots.iter().enumerate() {
            system.shapes[j * n + j] = 1.0 / root;
        }
        let shape = |factors: &Vec<f64>| -> Vec<f64> {
            factors.iter().zip(&roots).map(|(factor, root)| factor / root).collect()
        };
        let still = vec![0.0; n];
        let below = core::iter::once(&still).chain(points);
        let drift = |(here, below): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
            shape(&here.iter().zip(below).map(|(here, below)| here - below).collect())
        };
        system.points = Some(Points {
            shapes: points.iter().flat_map(shape).collect(),
            drifts: points.iter().zip(below).flat_map(drift).collect(),
            with_block: points.iter().map(|of| of.iter().fold(1.0, |rest, x| rest - x)).collect(),
        });
        system.participation = roots;
        system.finished()
    }

    /// A system without its modes.
    fn unfinished(
        (block_mass_kg, stiffness_n_per_m, damper_n_s_per_m): (f64, f64, f64),
        masses_kg: &[f64],
    ) -> Self {
        let total_kg = masses_kg.iter().fold(block_mass_kg, |sum, m| sum + m);
        Self {
            storeys: masses_kg.len(),
            block_mass_kg,
            per_block_mass: 1.0 / block_mass_kg,
            per_root_block: 1.0 / block_mass_kg.sqrt(),
            root_total_mass: total_kg.sqrt(),
            root_storey_mass: masses_kg.iter().sum::<f64>().sqrt(),
            stiffness_n_per_m,
            damper_n_s_per_m,
            participation: vec![0.0],
            omega2: vec![1.0],
            damping: vec![0.0],
            coupled: false,
            by_four: Vec::new(),
            shapes: Vec::new(),
            drifts: Vec::new(),
            points: None,
            stick_rate_rad_per_s: 0.0,
            slip_rate_rad_per_s: 0.0,
        }
    }

    /// What follows from the modes.
    fn finished(mut self) -> Self {
        if !self.coupled {
            let lists = [&self.omega2, &self.damping, &self.participation];
            self.by_four = (0..self.modes())
                .step_by(4)
                .map(|first| lists.map(|list| Four::new(&list[first..])))
                .collect();
        }
        self.set_rates();
        self
    }

    /// This structure on another spring and damper.
    #[must_use]
    pub fn restrained(&self, stiffness_n_per_m: f64, damper_n_s_per_m: f64) -> Self {
        let mut system = Self { stiffness_n_per_m, damper_n_s_per_m, ..self.clone() };
        system.set_rates();
        system
    }

    fn set_modes(&mut self, masses_kg: &[f64], stiffnesses_n_per_m: &[f64]) {
        let n = masses_kg.len();
        if n == 1 {
            // Without the detour through the frequency, which costs two roundings.
            self.omega2 = vec![stiffnesses_n_per_m[0] / masses_kg[0]];
            self.shapes = vec![1.0 / masses_kg[0].sqrt()];
            self.drifts = self.shapes.clone();
        } else {
            let modes = shear_frame_modes(masses_kg, stiffnesses_n_per_m);
            self.omega2 = modes.frequencies_rad_per_s.iter().map(|omega| omega * omega).collect();
            self.shapes = modes.shapes;
            // A storey carries the inertia above it: k_i (Φ_i − Φ_{i−1}) = ω² Σ_{l ≥ i} m_l Φ_l,
            // without the cancellation of the difference.
            self.drifts = vec![0.0; n * n];
            for j in 0..n {
                let mut carried = 0.0;
                for i in (0..n).rev() {
                    carried += masses_kg[i] * self.shapes[i * n + j];
                    self.drifts[i * n + j] = self.omega2[j] * carried / stiffnesses_n_per_m[i];
                }
            }
        }
        self.participation = (0..n)
            .map(|j| (0..n).fold(0.0, |sum, i| sum + self.shapes[i * n + j] * masses_kg[i]))
            .collect();
    }

    fn set_damping(&mut self, damping: StoreyDamping<'_>) {
        let n = self.storeys;
        match damping {
            StoreyDamping::Ratio(ratio) => {
                self.damping =
                    self.omega2.iter().map(|omega2| 2.0 * ratio * omega2.sqrt()).collect();
            }
            StoreyDamping::Dampers(dampers) => {
                self.coupled = n > 1;
                self.damping = vec![0.0; n * n];
                for (c, drift) in dampers.iter().zip(self.drifts.chunks_exact(n)) {
                    for (row, of_row) in self.damping.chunks_exact_mut(n).zip(drift) {
                        for (entry, of_column) in row.iter_mut().zip(drift) {
                            *entry += c * of_row * of_column;
                        }
                    }
                }
            }
        }
    }

    /// Bounds on the rates. With the mass matrix `[[M_tot, Lᵀ], [L, 1]]` the largest eigenvalue of
    /// the slip system is at most that of Ω plus `(k + Lᵀ Ω L) / M1` (Weyl), likewise for D, which
    /// is bounded by its largest row sum (Gershgorin).
    fn set_rates(&mut self) {
        let (l, n) = (&self.participation, self.participation.len());
        let rigid = self.storeys == 0;
        let omega2 = if rigid { 0.0 } else { self.omega2.iter().fold(0.0, |a: f64, b| a.max(*b)) };
        let width = if self.coupled { n } else { 1 };
        let row_sum = |row: &[f64]| row.iter().fold(0.0, |sum, d| sum + d.abs());
        let decay = self.damping.chunks_exact(width).map(row_sum).fold(0.0, f64::max);
        let zeros = vec![0.0; n];
        let [mut elastic, mut drag] = [zeros.clone(), zeros.clone()];
        self.restoring(l, &zeros, &mut elastic);
        self.restoring(&zeros, l, &mut drag);
        let per_mass = self.per_block_mass;
        let [pull, drag] = [dot(l, &elastic), dot(l, &drag)].map(|x| x * per_mass);
        let (spring, damper) =
            (self.stiffness_n_per_m * per_mass, self.damper_n_s_per_m.abs() * per_mass);
        self.stick_rate_rad_per_s = omega2.sqrt() + decay;
        self.slip_rate_rad_per_s = (omega2 + (spring + pull)).sqrt() + decay + (damper + drag);
    }

    /// Coordinates of the structure, one at least.
    #[inline(always)]
    #[must_use]
    pub fn modes(&self) -> usize {
        self.participation.len()
    }

    /// The modes by four, unless their damping couples them.
    #[inline(always)]
    #[must_use]
    pub fn uncoupled_modes(&self) -> Option<&[Modes]> {
        (!self.coupled).then_some(&self.by_four)
    }

    /// Row of `Φ`: what the coordinates do to one floor.
    #[must_use]
    pub fn floor(&self, floor: usize) -> &[f64] {
        &self.shapes[floor * self.storeys..][..self.storeys]
    }

    /// Number of points whose motion is told: floors, or the points of a structure by its modes.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points.as_ref().map_or(self.storeys, |points| points.with_block.len())
    }

    /// Whether the structure is given by its modes.
    #[must_use]
    pub fn is_by_modes(&self) -> bool {
        self.points.is_some()
    }

    /// What the coordinates do to one point.
    #[must_use]
    pub fn point(&self, point: usize) -> &[f64] {
        self.points.as_ref().map_or_else(|| self.floor(point), |of| self.row(&of.shapes, point))
    }

    /// What the coordinates do to the drift of one point from the one before it.
    #[must_use]
    pub fn point_drift(&self, point: usize) -> &[f64] {
        self.points.as_ref().map_or_else(|| self.drift(point), |of| self.row(&of.drifts, point))
    }

    /// What of a point's motion is the block's.
    #[must_use]
    pub fn with_block(&self, point: usize) -> f64 {
        self.points.as_ref().map_or(0.0, |points| points.with_block[point])
    }

    fn row<'a>(&self, rows: &'a [f64], row: usize) -> &'a [f64] {
        &rows[row * self.storeys..][..self.storeys]
    }

    /// What the coordinates do to the drift of one storey.
    #[must_use]
    pub fn drift(&self, storey: usize) -> &[f64] {
        &self.drifts[storey * self.storeys..][..self.storeys]
    }

    /// `f = D η̇ + Ω η`: what springs and dampers of the structure do to each coordinate.
    #[inline(always)]
    pub fn restoring(&self, x: &[f64], v: &[f64], f: &mut [f64]) {
        let n = f.len();
        let (x, v, k) = (&x[..n], &v[..n], &self.omega2[..n]);
        if self.coupled {
            for (j, (f, row)) in f.iter_mut().zip(self.damping.chunks_exact(n)).enumerate() {
                *f = k[j] * x[j] + dot(row, v);
            }
        } else {
            let d = &self.damping[..n];
            for j in 0..n {
                f[j] = k[j] * x[j] + d[j] * v[j];
            }
        }
    }

    /// `D v`.
    #[must_use]
    pub fn drag(&self, v: &[f64]) -> Vec<f64> {
        let mut f = vec![0.0; v.len()];
        self.restoring(&vec![0.0; v.len()], v, &mut f);
        f
    }

    /// Acceleration `u` of the block in slip under a force on it and a base shear `L·f`.
    #[inline(always)]
    #[must_use]
    pub fn block_acceleration(&self, s: f64, w: f64, shear_n: f64, force_n: f64) -> f64 {
        ((force_n - self.damper_n_s_per_m * w) + (shear_n - self.stiffness_n_per_m * s))
            * self.per_block_mass
    }

    /// Energy norm of a state `s, ṡ, η, η̇`, in N^(1/2) m^(1/2).
    ///
    /// `‖x‖² = k s² + M1 ṡ² + ηᵀ Ω η + |η̇ + L ṡ|²`, twice the energy.
    #[inline(always)]
    #[must_use]
    pub fn energy_norm(&self, x: &[f64]) -> f64 {
        let n = x.len() / 2 - 1;
        let (s, w, eta, rest) = (x[0], x[1], &x[2..2 + n], &x[2 + n..2 + 2 * n]);
        let (l, k) = (&self.participation[..n], &self.omega2[..n]);
        let mut sums = [0.0; 4];
        for j in 0..n {
            let momentum = rest[j] + l[j] * w;
            sums[j % 4] += k[j] * (eta[j] * eta[j]) + momentum * momentum;
        }
        let of_block = self.stiffness_n_per_m * (s * s) + self.block_mass_kg * (w * w);
        (of_block + ((sums[0] + sums[1]) + (sums[2] + sums[3]))).sqrt()
    }

    /// Number of [amplitudes](System::amplitudes): those of several modes come in whole fours.
    #[must_use]
    pub fn amplitude_count(&self) -> usize {
        if self.has_modes(false) { self.padded_modes() } else { 1 }
    }

    /// Amplitudes of the structure in stick: `√(ω² η² + η̇²)` of each mode, or the energy norm of all
    /// where damping couples them. Undriven they do not grow.
    #[inline(always)]
    pub fn amplitudes<S: Simd>(&self, simd: S, x: &[f64], out: &mut [f64]) {
        if out.len() > 1 {
            for m in 0..self.by_four.len() {
                let omega2 = self.by_four[m][0].load(simd);
                let [eta, rate] = self.four_modes(simd, x, m);
                let square = omega2 * (eta * eta) + rate * rate;
                square.sqrt().store_slice(&mut out[4 * m..][..4]);
            }
            return;
        }
        let n = if x.len() > 4 { self.modes() } else { 1 };
        let (eta, rate, k) = (&x[2..2 + n], &x[2 + n..2 + 2 * n], &self.omega2[..n]);
        let mut square = 0.0;
        for j in 0..n {
            square += k[j] * (eta[j] * eta[j]) + rate[j] * rate[j];
        }
        out[0] = square.sqrt();
    }

    /// What a unit of `∫|a| dt` adds to each amplitude at most: `|L_j|`, or `|L|`.
    #[must_use]
    pub fn amplitudes_of_impulse(&self) -> Vec<f64> {
        if self.coupled {
            return vec![self.root_storey_mass];
        }
        self.participation.iter().map(|l| l.abs()).collect()
    }

    /// What a unit of each amplitude does at most to the row `c` in stick: `√(c_η²/ω² + c_η̇²)`.
    #[must_use]
    pub fn dual_amplitudes(&self, c: &[f64]) -> Vec<f64> {
        if self.coupled {
            return vec![self.dual_norm(false, c)];
        }
        let n = self.modes();
        let of = |j: usize| c[2 + j] * c[2 + j] / self.omega2[j] + c[2 + n + j] * c[2 + n + j];
        let mut of_modes: Vec<f64> = (0..n).map(|j| of(j).sqrt()).collect();
        of_modes.resize(self.amplitude_count(), 0.0);
        of_modes
    }

    /// How much the energy norm can grow over a length of time: a damper `c < 0` feeds
    /// `d‖x‖²/dt = −2 c ṡ² ≤ 2 (|c| / M1) ‖x‖²`.
    #[must_use]
    pub fn growth(&self, length_s: f64) -> f64 {
        libm::exp((-self.damper_n_s_per_m).max(0.0) * self.per_block_mass * length_s)
    }

    /// Largest value on states of energy norm 1 of the row `c`, in stick on those at `s = ṡ = 0`.
    /// Infinite where a row asks for `s` that nothing restrains.
    #[must_use]
    pub fn dual_norm(&self, slip: bool, c: &[f64]) -> f64 {
        let n = self.modes();
        let (of_eta, of_rate) = (&c[2..2 + n], &c[2 + n..2 + 2 * n]);
        let mut square = dot(of_rate, of_rate);
        for (c, omega2) in of_eta.iter().zip(&self.omega2) {
            square += c * c / omega2;
        }
        if slip {
            square += if c[0] == 0.0 { 0.0 } else { c[0] * c[0] / self.stiffness_n_per_m };
            let momentum = c[1] - dot(of_rate, &self.participation);
            square += momentum * momentum * self.per_block_mass;
        }
        square.sqrt()
    }

    /// Modes that nothing couples, in whole fours.
    #[inline(always)]
    #[must_use]
    pub fn padded_modes(&self) -> usize {
        4 * self.by_four.len()
    }

    /// Whether the modes of stick have amplitudes of their own.
    #[inline(always)]
    #[must_use]
    pub fn has_modes(&self, slip: bool) -> bool {
        !slip && !self.coupled && self.storeys > 1
    }

    /// How far each mode of stick departs at most from chords of several lengths `H`, given as `H²/8`, from
    /// a state under an acceleration with its rate: with the sums `Σ|Δȧ|` of the kinks after it and `∫|a| dt`,
    ///
    /// ```text
    /// min(H²/8 (‖ẍ_j‖ + |L_j| Σ|Δȧ|), 2 (‖x_j‖ + |L_j| ∫|a| dt))
    /// ```
    ///
    /// in units of its amplitude. Chord after chord, those of each padded to fours.
    #[inline(always)]
    pub fn departures<S: Simd, const N: usize>(
        &self,
        simd: S,
        x: &[f64],
        [a, jerk]: [f64; 2],
        [kinks, impulse]: [f64; 2],
        reaches: [f64; N],
        out: &mut [f64],
    ) {
        let stride = self.padded_modes();
        let [a, jerk, kinks, impulse] = [a, jerk, kinks, impulse].map(|x| four(simd, x));
        for m in 0..self.by_four.len() {
            let [omega2, damping, l] = self.by_four[m].each_ref().map(|x| x.load(simd));
            let [eta, rate] = self.four_modes(simd, x, m);
            let eta2 = -(omega2 * eta + damping * rate + l * a);
            let eta3 = omega2 * rate + damping * eta2 + l * jerk;
            let second = (omega2 * (eta2 * eta2) + eta3 * eta3).sqrt() + l.abs() * kinks;
            let most = (omega2 * (eta * eta) + rate * rate).sqrt() + l.abs() * impulse;
            let twice = most + most;
            for i in 0..N {
                let departure = second * four(simd, reaches[i]);
                let departure = twice.simd_lt(departure).select(twice, departure);
                departure.store_slice(&mut out[i * stride + 4 * m..][..4]);
            }
        }
    }

    /// Energy norms of `ẋ` and `ẍ` in a state under an acceleration and a force on the block, each
    /// with its rate.
    ///
    /// While the loads are linear in time `ẍ` follows the unloaded system, whose energy dampers can
    /// only spend: the norm at the start bounds it throughout, and with it the second derivative of
    /// every linear function of the state by that function's [dual norm](System::dual_norm).
    #[inline(always)]
    #[must_use]
    pub fn derivative_norms<S: Simd>(
        &self,
        simd: S,
        slip: bool,
        x: &[f64],
        [a, jerk]: [f64; 2],
        [force_n, force_rate]: [f64; 2],
        [f, eta2]: [&mut [f64]; 2],
    ) -> [f64; 2] {
        let n = f.len();
        if n > 1 && !self.coupled {
            let (load, force) = ([a, jerk], [force_n, force_rate]);
            return self.derivative_norms_by_four(simd, slip, x, load, force);
        }
        let (eta, rate) = (&x[2..2 + n], &x[2 + n..2 + 2 * n]);
        let (l, k) = (&self.participation[..n], &self.omega2[..n]);
        let (mut first, mut second) = ([0.0; 4], [0.0; 4]);
        self.restoring(eta, rate, f);
        let u = if slip { self.block_acceleration(x[0], x[1], dot(l, f), force_n) } else { a };
        for j in 0..n {
            eta2[j] = -(f[j] + l[j] * u);
            // η̈ + L s̈ = −f − L a
            let momentum = f[j] + l[j] * a;
            first[j % 4] += k[j] * (rate[j] * rate[j]) + momentum * momentum;
        }
        self.restoring(rate, eta2, f);
        for j in 0..n {
            // η‴ + L s‴ = −f′ − L ȧ
            let momentum = f[j] + l[j] * jerk;
            second[j % 4] += k[j] * (eta2[j] * eta2[j]) + momentum * momentum;
        }
        let squares = [first, second].map(|sums| (sums[0] + sums[1]) + (sums[2] + sums[3]));
        let block = slip.then(|| [x[1], u - a, dot(l, f)]);
        self.norms_with_block(squares, block, [jerk, force_rate])
    }

    /// Norms of `ẋ` and `ẍ` from the squares of the structure's parts, in slip with those of the block at
    /// `ṡ`, `s̈` and a rate of the base shear.
    #[inline(always)]
    fn norms_with_block(
        &self,
        [mut first, mut second]: [f64; 2],
        block: Option<[f64; 3]>,
        [jerk, force_rate]: [f64; 2],
    ) -> [f64; 2] {
        if let Some([w, s2, shear_rate]) = block {
            let s3 = self.block_acceleration(w, s2, shear_rate, force_rate) - jerk;
            first += self.stiffness_n_per_m * (w * w) + self.block_mass_kg * (s2 * s2);
            second += self.stiffness_n_per_m * (s2 * s2) + self.block_mass_kg * (s3 * s3);
        }
        [first.sqrt(), second.sqrt()]
    }

    /// Norms of the first and second derivative where nothing couples the modes, four modes at a time.
    #[inline(always)]
    fn derivative_norms_by_four<S: Simd>(
        &self,
        simd: S,
        slip: bool,
        x: &[f64],
        [a, jerk]: [f64; 2],
        [force_n, force_rate]: [f64; 2],
    ) -> [f64; 2] {
        let mut u = a;
        if slip {
            let mut shear = four(simd, 0.0);
            for m in 0..self.by_four.len() {
                let [omega2, damping, l] = self.by_four[m].each_ref().map(|x| x.load(simd));
                let [eta, rate] = self.four_modes(simd, x, m);
                shear += l * (omega2 * eta + damping * rate);
            }
            u = self.block_acceleration(x[0], x[1], sum_of_lanes(shear), force_n);
        }
        let [mut first, mut second, mut shear] = [four(simd, 0.0); 3];
        let [of_a, of_u, of_jerk] = [a, u, jerk].map(|x| four(simd, x));
        for m in 0..self.by_four.len() {
            let [omega2, damping, l] = self.by_four[m].each_ref().map(|x| x.load(simd));
            let [eta, rate] = self.four_modes(simd, x, m);
            let f = omega2 * eta + damping * rate;
            let eta2 = -(f + l * of_u);
            let momentum = f + l * of_a;
            first += omega2 * (rate * rate) + momentum * momentum;
            let f = omega2 * rate + damping * eta2;
            let momentum = f + l * of_jerk;
            second += omega2 * (eta2 * eta2) + momentum * momentum;
            shear += l * f;
        }
        let squares = [first, second].map(sum_of_lanes);
        let block = slip.then(|| [x[1], u - a, sum_of_lanes(shear)]);
        self.norms_with_block(squares, block, [jerk, force_rate])
    }

    /// Four modes of a padded state and their rates. Beyond the last mode stands what multiplies zeros.
    #[inline(always)]
    fn four_modes<S: Simd>(&self, simd: S, x: &[f64], m: usize) -> [f64x4<S>; 2] {
        let n = self.participation.len();
        let (eta_at, rate_at) = (2 + 4 * m, 2 + n + 4 * m);
        [four_from(simd, x, eta_at), four_from(simd, x, rate_at)]
    }

    /// Floor values `Φ η` of coordinates `η`.
    #[inline(always)]
    pub fn floors(&self, eta: &[f64], out: &mut [f64]) {
        let n = self.storeys;
        for (out, row) in out[..n].iter_mut().zip(self.shapes.chunks_exact(n.max(1))) {
            *out = dot(row, &eta[..n]);
        }
    }

    /// Coordinates `η = Φᵀ M q` of floor values `q`.
    #[must_use]
    pub fn coordinates(&self, masses_kg: &[f64], floors: &[f64]) -> Vec<f64> {
        let n = self.storeys;
        let mut eta = vec![0.0; self.modes()];
        for (j, eta) in eta[..n].iter_mut().enumerate() {
            *eta =
                (0..n).fold(0.0, |sum, i| sum + self.shapes[i * n + j] * masses_kg[i] * floors[i]);
        }
        eta
    }

    /// Derivative of a state under an acceleration and a force on the block.
    #[inline(always)]
    pub fn derivative(&self, slip: bool, x: &[f64], a: f64, force_n: f64, out: &mut [f64]) {
        let n = self.modes();
        let (head, tail) = out[..2 + 2 * n].split_at_mut(2 + n);
        let (eta, rate) = (&x[2..2 + n], &x[2 + n..2 + 2 * n]);
        self.restoring(eta, rate, tail);
        let l = &self.participation[..n];
        let u = if slip { self.block_acceleration(x[0], x[1], dot(l, tail), force_n) } else { a };
        (head[0], head[1]) = if slip { (x[1], u - a) } else { (0.0, 0.0) };
        head[2..].copy_from_slice(rate);
        for j in 0..n {
            tail[j] = -(tail[j] + l[j] * u);
        }
    }
}
