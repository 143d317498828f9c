//! Gauss collocation of the equations of motion over one step.
//!
//! With the nodes `c_i` of Gauss's rule on (0, 1) and `F_i = ẍ(c_i h)`,
//!
//! ```text
//! v_i = v_0 + h Σ_j A_ij F_j        x_i = x_0 + c_i h v_0 + h² Σ_j (A²)_ij F_j
//! v_1 = v_0 + h Σ_j b_j F_j         x_1 = x_0 + h v_0 + h² Σ_j b_j (1 − c_j) F_j
//! ```
//!
//! which is solved by iterating `F_i ← ẍ(x_i, v_i)`. For eight nodes the end of a step of a mode of
//! rate λ is the (8, 8) Padé approximant of `exp(λ h)`, its error 2.2e-19 (λh)¹⁷; inside, where the
//! order is 8, it is below 2e-10 (λh)⁹. Steps with λh ≤ [`MAX_TURN`] = 1/2 keep the two below 1e-23
//! and 4e-13 of the amplitude.

use std::sync::LazyLock;

/// Nodes of the rule.
pub(super) const NODES: usize = 8;
/// Nodes and both ends.
pub(super) const POINTS: usize = NODES + 2;
/// Largest rate times step.
pub(super) const MAX_TURN: f64 = 0.5;
/// Most passes of the iteration.
pub(super) const MOST_PASSES: usize = 100;
/// Changes below this part of the accelerations may be rounding.
pub(super) const ROUNDING: f64 = 1e-12;

/// Values at some instants.
pub(super) type Column<const N: usize> = [f64; N];

/// Adds a multiple of a column.
#[inline(always)]
pub(super) fn add<const N: usize>(to: &mut Column<N>, factor: f64, column: &Column<N>) {
    *to = core::array::from_fn(|i| to[i] + factor * column[i]);
}

/// `Σ a_i b_i`, of columns.
#[inline(always)]
pub(super) fn combined<const N: usize>(columns: &[Column<N>], factors: &[f64]) -> Column<N> {
    let mut sum = [0.0; N];
    for (column, factor) in columns.iter().zip(factors) {
        add(&mut sum, *factor, column);
    }
    sum
}

/// The largest size in a column; what is not a number is none.
#[inline(always)]
pub(super) fn most<const N: usize>(column: &Column<N>) -> f64 {
    column.iter().fold(0.0, |most, x| if x.abs() > most { x.abs() } else { most })
}

/// Nodes, weights and integrals of the rule, and what interpolates between its points.
pub(super) struct Rule {
    /// Nodes.
    pub(super) c: [f64; NODES],
    /// Weights `b`.
    pub(super) weights: [f64; NODES],
    /// `A` and its square, column by column: what `ẍ` at a node does at all.
    a: [Column<NODES>; NODES],
    aa: [Column<NODES>; NODES],
    /// 0, the nodes, 1.
    pub(super) points: [f64; POINTS],
    barycentric: [f64; POINTS],
}

impl Rule {
    /// The rule, made once.
    pub(super) fn get() -> &'static Self {
        static RULE: LazyLock<Rule> = LazyLock::new(Rule::new);
        &RULE
    }

    fn new() -> Self {
        let mut c = [0.0; NODES];
        let mut weights = [0.0; NODES];
        for i in 0..NODES {
            let angle = core::f64::consts::PI * ((NODES - i) as f64 - 0.25) / (NODES as f64 + 0.5);
            let mut z = libm::cos(angle);
            let mut slope = 0.0;
            for _ in 0..8 {
                let (mut p, mut before) = (1.0, 0.0);
                for k in 1..=NODES {
                    let k = k as f64;
                    (p, before) = (((2.0 * k - 1.0) * z * p - (k - 1.0) * before) / k, p);
                }
                slope = NODES as f64 * (z * p - before) / (z * z - 1.0);
                z -= p / slope;
            }
            c[i] = 0.5 * (1.0 + z);
            weights[i] = 1.0 / ((1.0 - z * z) * slope * slope);
        }
        // The integral of Lagrange's polynomial over (0, c_i), by the rule itself: exact.
        let integral = |i: usize, j: usize| {
            c[i] * (0..NODES).map(|k| weights[k] * lagrange(&c, j, c[i] * c[k])).sum::<f64>()
        };
        let a: [Column<NODES>; NODES] =
            core::array::from_fn(|j| core::array::from_fn(|i| integral(i, j)));
        let square = |i: usize, j: usize| (0..NODES).map(|k| a[k][i] * a[j][k]).sum();
        let aa = core::array::from_fn(|j| core::array::from_fn(|i| square(i, j)));
        let points: [f64; POINTS] = core::array::from_fn(|i| match i {
            0 => 0.0,
            i if i <= NODES => c[i - 1],
            _ => 1.0,
        });
        let barycentric = core::array::from_fn(|i| {
            let gaps = (0..POINTS).filter(|&k| k != i).map(|k| points[i] - points[k]);
            1.0 / gaps.product::<f64>()
        });
        Self { c, weights, a, aa, points, barycentric }
    }

    /// The polynomial that is 1 at a node and 0 at all others, at `t`.
    pub(super) fn lagrange(&self, node: usize, t: f64) -> f64 {
        lagrange(&self.c, node, t)
    }

    /// `x` and `v` at the nodes of a step of a length, from those at its start and `ẍ` at the nodes.
    #[inline(always)]
    pub(super) fn inside(
        &self,
        h: f64,
        [x0, v0]: [f64; 2],
        rates: &Column<NODES>,
    ) -> [Column<NODES>; 2] {
        let (dx, dv) = (combined(&self.aa, rates), combined(&self.a, rates));
        let x = core::array::from_fn(|i| x0 + h * (v0 * self.c[i] + h * dx[i]));
        [x, dv.map(|dv| v0 + h * dv)]
    }

    /// `x` and `v` at the end of the step.
    #[inline(always)]
    pub(super) fn end(&self, h: f64, [x0, v0]: [f64; 2], rates: &Column<NODES>) -> [f64; 2] {
        let (mut dx, mut dv) = (0.0, 0.0);
        for (i, rate) in rates.iter().enumerate() {
            let share = rate * self.weights[i];
            dx += share * (1.0 - self.c[i]);
            dv += share;
        }
        [x0 + h * (v0 + h * dx), v0 + h * dv]
    }

    /// The integral over a step of a length of a polynomial with these values at the points.
    #[inline(always)]
    pub(super) fn integral(&self, h: f64, values: &Column<POINTS>) -> f64 {
        h * self.weights.iter().zip(&values[1..]).map(|(b, value)| b * value).sum::<f64>()
    }

    /// The polynomial through `values` at the points, at `t` in [0, 1].
    pub(super) fn interpolate(&self, values: &[f64; POINTS], t: f64) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        for ((&p, &w), &value) in self.points.iter().zip(&self.barycentric).zip(values) {
            if t == p {
                return value;
            }
            let share = w / (t - p);
            above += share * value;
            below += share;
        }
        above / below
    }

    /// Factors of the values at the points in the polynomial through them, at `t` beside the points.
    pub(super) fn shares(&self, t: f64) -> [f64; POINTS] {
        let shares: [f64; POINTS] =
            core::array::from_fn(|i| self.barycentric[i] / (t - self.points[i]));
        let sum: f64 = shares.iter().sum();
        shares.map(|share| share / sum)
    }

    /// The smallest value of `cost(t, value(t))` next to the point `middle`, by golden section.
    pub(super) fn least(
        &self,
        values: &[f64; POINTS],
        middle: usize,
        cost: impl Fn(f64, f64) -> f64,
    ) -> (f64, f64) {
        let at_point = cost(self.points[middle], values[middle]);
        self.least_of((middle, at_point), |t| cost(t, self.interpolate(values, t)))
    }

    /// The smallest value of `at(t)` next to the point `middle`, where its value is known.
    pub(super) fn least_of(
        &self,
        (middle, at_point): (usize, f64),
        at: impl Fn(f64) -> f64,
    ) -> (f64, f64) {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let mut low = self.points[middle.saturating_sub(1)];
        let mut high = self.points[(middle + 1).min(POINTS - 1)];
        let mut left = high - GOLDEN * (high - low);
        let mut right = low + GOLDEN * (high - low);
        let (mut at_left, mut at_right) = (at(left), at(right));
        // Sixteen sections leave 5e-4 of the bracket, three parabolas through the best three points
        // its square again and again.
        for _ in 0..16 {
            if at_left <= at_right {
                (high, right, at_right) = (right, left, at_left);
                left = high - GOLDEN * (high - low);
                at_left = at(left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + GOLDEN * (high - low);
                at_right = at(right);
            }
        }
        let mut found = if at_left <= at_right { (left, at_left) } else { (right, at_right) };
        let mut width = 0.5 * (high - low);
        for _ in 0..3 {
            let t = found.0;
            let (below, above) = (at(t - width), at(t + width));
            let bend = below - 2.0 * found.1 + above;
            let shift = 0.5 * width * (below - above) / bend;
            if !(bend > 0.0 && shift.abs() <= width) {
                break;
            }
            let inside = (t + shift).clamp(low, high);
            let there = (inside, at(inside));
            if there.1 <= found.1 {
                found = there;
            }
            width *= 0.1;
        }
        let node = (self.points[middle], at_point);
        if node.1 <= found.1 { node } else { found }
    }
}

/// Lagrange's polynomial of a node.
fn lagrange(c: &[f64; NODES], j: usize, t: f64) -> f64 {
    (0..NODES).filter(|&k| k != j).map(|k| (t - c[k]) / (c[j] - c[k])).product()
}

/// Legendre's polynomial `P_l(z)`.
pub(super) fn legendre(l: usize, z: f64) -> f64 {
    let (mut p, mut before) = (1.0, 0.0);
    for k in 1..=l {
        let k = k as f64;
        (p, before) = (((2.0 * k - 1.0) * z * p - (k - 1.0) * before) / k, p);
    }
    p
}
