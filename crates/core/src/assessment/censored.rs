//! Maximum likelihood for a normal variable that is known exactly, from above or from below.
//!
//! One fit serves every fragility of this library. A variable is `y = α + b x + σ ε` with `ε`
//! standard normal; each observation gives `y` itself, or only that it is at most or at least some
//! value. In Olsen's parameters `δ = α/σ`, `γ = b/σ`, `h = 1/σ` and with `z = h y − δ − γ x`
//!
//! ```text
//! ln L = Σ exact w [ln h − z²/2 − ln √(2π)] + Σ at most w ln Φ(z) + Σ at least w ln Φ(−z)
//! ```
//!
//! which is concave (R. J. Olsen, *Econometrica* 46, 1978): Newton's iteration finds its only
//! maximum. Counts of exceedances are the case in which nothing is known exactly (the probit model);
//! capacities without bounds are the ordinary fit of a normal distribution; regression with
//! censoring is Tobin's.

use crate::error::FitError;
use crate::numerics::distribution::{
    bisect, ln_normal_cdf, ln_normal_density, normal_hazard, normal_quantile,
};

/// What is known of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// The value itself.
    Exactly,
    /// That it is no larger.
    AtMost,
    /// That it is no smaller.
    AtLeast,
}

/// One observation, or several equal ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// The covariate `x`; 0 throughout where there is none.
    pub x: f64,
    /// The value `y`, or its bound.
    pub y: f64,
    /// What `y` is.
    pub known: Known,
    /// How many such observations, > 0.
    pub weight: f64,
}

/// Parameters `[δ, γ, h]`.
pub(crate) type Parameters = [f64; 3];

/// A fitted model.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    data: Vec<Observation>,
    /// The shift and scale of x and y under which the iteration works.
    scaling: Scaling,
    /// Estimates in the scaled variables.
    estimate: Parameters,
    slope: bool,
    covariance: [[f64; 3]; 3],
    log_likelihood: f64,
}

/// `y = shift + scale y'`, and the same for x.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scaling {
    x: [f64; 2],
    y: [f64; 2],
}

/// σ below this share of the spread of the data is a line through points, not a distribution.
const LEAST_SPREAD: f64 = 1e-7;
const MOST_STEPS: usize = 200;

impl Fit {
    /// Fits `α`, `σ` and, with `slope`, `b`.
    ///
    /// # Errors
    /// [`FitError::NoMaximum`] where the likelihood grows without end: the data lie on a line, or
    /// do not determine all parameters.
    pub fn new(data: &[Observation], slope: bool) -> Result<Self, FitError> {
        let scaling = Scaling {
            x: shift_and_scale(data, |o| o.x, slope),
            y: shift_and_scale(data, |o| o.y, true),
        };
        let data: Vec<Observation> = data
            .iter()
            .map(|o| Observation {
                x: (o.x - scaling.x[0]) / scaling.x[1],
                y: (o.y - scaling.y[0]) / scaling.y[1],
                ..*o
            })
            .collect();
        let free: &[Parameters] = if slope { &AXES } else { &[AXES[0], AXES[2]] };
        let found = maximise(&data, [0.0, 0.0, 1.0], free)?;
        let covariance = invert(&found.information).ok_or(FitError::NoMaximum)?;
        let mut full = [[0.0; 3]; 3];
        for (i, a) in free.iter().enumerate() {
            for (j, b) in free.iter().enumerate() {
                for k in 0..3 {
                    for l in 0..3 {
                        full[k][l] += a[k] * covariance[i][j] * b[l];
                    }
                }
            }
        }
        let exact: f64 = data.iter().filter(|o| o.known == Known::Exactly).map(|o| o.weight).sum();
        // The density of y is that of y' over the scale.
        let log_likelihood = found.value - exact * libm::log(scaling.y[1]);
        Ok(Self { data, scaling, estimate: found.at, slope, covariance: full, log_likelihood })
    }

    /// The intercept `α`.
    #[must_use]
    pub fn intercept(&self) -> f64 {
        let [delta, _, h] = self.parameters();
        delta / h
    }

    /// The slope `b`, 0 where none was fitted.
    #[must_use]
    pub fn slope(&self) -> f64 {
        let [_, gamma, h] = self.parameters();
        gamma / h
    }

    /// The standard deviation `σ`; negative where counts fall instead of rising.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        self.parameters()[2].recip()
    }

    /// Whether `y` can be told to depend on anything: of counts that do not change with intensity `h`
    /// is 0 but for rounding.
    pub(crate) fn rises(&self) -> bool {
        self.estimate[2] > 1e-9
    }

    /// Largest value of `ln L`; for exact values that of densities of `y`.
    #[must_use]
    pub fn log_likelihood(&self) -> f64 {
        self.log_likelihood
    }

    /// Estimates of `[δ, γ, h]`.
    pub(crate) fn parameters(&self) -> Parameters {
        self.unscaled(self.estimate)
    }

    fn unscaled(&self, [delta, gamma, h]: Parameters) -> Parameters {
        let Scaling { x, y } = self.scaling;
        let (gamma, h) = (gamma / x[1], h / y[1]);
        [delta + h * y[0] - gamma * x[0], gamma, h]
    }

    /// A linear form `c·[δ, γ, h]` as one of the scaled parameters.
    fn scaled_form(&self, c: Parameters) -> Parameters {
        let Scaling { x, y } = self.scaling;
        [c[0], (c[1] - c[0] * x[0]) / x[1], (c[2] + c[0] * y[0]) / y[1]]
    }

    /// Standard error of a linear form `c·[δ, γ, h]`, from the observed information.
    pub(crate) fn standard_error(&self, c: Parameters) -> f64 {
        let c = self.scaled_form(c);
        let variance: f64 =
            (0..3).map(|i| (0..3).map(|j| c[i] * self.covariance[i][j] * c[j]).sum::<f64>()).sum();
        variance.max(0.0).sqrt()
    }

    /// Number of observations, equal ones counted once.
    pub(crate) fn observations(&self) -> usize {
        self.data.len()
    }

    /// Number of observations, equal ones counted each.
    pub(crate) fn weight(&self) -> f64 {
        self.data.iter().map(|o| o.weight).sum()
    }

    /// Replaces the covariance by that which is robust to dependence within clusters, one number for
    /// each observation as given to [`Fit::new`]:
    ///
    /// ```text
    /// V = G/(G − 1) · (n − 1)/(n − k) · A⁻¹ (Σ_g s_g s_gᵀ) A⁻¹
    /// ```
    ///
    /// with the observed information `A`, the score `s_g` of a cluster, `G` clusters, `n`
    /// observations and `k` parameters (K.-Y. Liang and S. L. Zeger, *Biometrika* 73, 1986).
    pub(crate) fn cluster(&mut self, clusters: &[usize]) {
        let count = clusters.iter().max().map_or(0, |last| last + 1);
        let mut scores = vec![[0.0; 3]; count];
        for (o, &cluster) in self.data.iter().zip(clusters) {
            let (gradient, _) = slopes(core::slice::from_ref(o), self.estimate);
            for i in 0..3 {
                scores[cluster][i] += gradient[i];
            }
        }
        let n = self.weight();
        let k = if self.slope { 3.0 } else { 2.0 };
        let groups = count as f64;
        let correction = groups / (groups - 1.0) * (n - 1.0) / (n - k);
        let a = self.covariance;
        let mut v = [[0.0; 3]; 3];
        for score in &scores {
            let step = a.map(|row| row.iter().zip(score).map(|(a, s)| a * s).sum::<f64>());
            for i in 0..3 {
                for j in 0..3 {
                    v[i][j] += correction * step[i] * step[j];
                }
            }
        }
        self.covariance = v;
    }

    /// Estimates of `[δ, γ, h]` from the same observations in other numbers: each counted `times` as
    /// often, by its index.
    pub(crate) fn resampled(&self, times: impl Fn(usize) -> u32) -> Result<Parameters, FitError> {
        let counted = |(i, o): (usize, &Observation)| {
            let times = times(i);
            (times > 0).then(|| Observation { weight: o.weight * f64::from(times), ..*o })
        };
        let data: Vec<Observation> = self.data.iter().enumerate().filter_map(counted).collect();
        if data.iter().all(|o| o.known != Known::Exactly) {
            // Without an overlap the likelihood has no maximum.
            let ends = |known: Known, from: f64, better: fn(f64, f64) -> f64| {
                let of = data.iter().filter(|o| o.known == known).map(|o| o.y);
                of.fold(from, better)
            };
            let first_beyond = ends(Known::AtMost, f64::INFINITY, f64::min);
            let last_within = ends(Known::AtLeast, f64::NEG_INFINITY, f64::max);
            if first_beyond >= last_within {
                return Err(FitError::NoMaximum);
            }
        }
        let free: &[Parameters] = if self.slope { &AXES } else { &[AXES[0], AXES[2]] };
        let found = maximise(&data, self.estimate, free)?;
        Ok(self.unscaled(found.at))
    }

    /// Where `2 (ln L_max − ln L)` of the best fit under the condition `form(v)·[δ, γ, h] = rhs(v)`
    /// reaches the square of the normal quantile of `confidence`: the ends of the interval of `v`
    /// by profile likelihood. `step` is a first guess of its half width. `None`: open on that side.
    pub(crate) fn profile(
        &self,
        estimate: f64,
        step: f64,
        confidence: f64,
        condition: impl Fn(f64) -> (Parameters, f64),
    ) -> [Option<f64>; 2] {
        let z = normal_quantile(0.5 + 0.5 * confidence);
        let exact: f64 =
            self.data.iter().filter(|o| o.known == Known::Exactly).map(|o| o.weight).sum();
        let most = self.log_likelihood + exact * libm::log(self.scaling.y[1]);
        let inside = |v: f64| {
            let (form, right) = condition(v);
            let best = self.constrained(self.scaled_form(form), right);
            best.is_some_and(|value| 2.0 * (most - value) < z * z)
        };
        [-1.0, 1.0].map(|side| {
            let mut near = estimate;
            let mut reach = step;
            for _ in 0..40 {
                let far = estimate + side * reach;
                if !far.is_finite() {
                    return None;
                }
                if !inside(far) {
                    let along = |t: f64| near + t * (far - near);
                    return Some(along(bisect(0.0, 1.0, |t| inside(along(t)))));
                }
                near = far;
                reach *= 2.0;
            }
            None
        })
    }

    /// Largest `ln L` in the scaled variables under `c·p = d`.
    fn constrained(&self, c: Parameters, d: f64) -> Option<f64> {
        let usable: &[usize] = if self.slope { &[0, 1, 2] } else { &[0, 2] };
        let pivot = *usable.iter().max_by(|&&i, &&j| c[i].abs().total_cmp(&c[j].abs()))?;
        let free: Vec<Parameters> = usable
            .iter()
            .filter(|&&i| i != pivot)
            .map(|&i| {
                let mut direction = AXES[i];
                direction[pivot] = -c[i] / c[pivot];
                direction
            })
            .collect();
        // The nearest point to the estimate along the pivot.
        let mut start = self.estimate;
        let held: f64 = usable.iter().filter(|&&i| i != pivot).map(|&i| c[i] * start[i]).sum();
        start[pivot] = (d - held) / c[pivot];
        let needs_scale = self.data.iter().any(|o| o.known == Known::Exactly);
        if needs_scale && !(start[2] > 0.0) {
            // Go along a free direction that raises h until it is positive.
            let up = free.iter().find(|direction| direction[2] != 0.0)?;
            let by = (self.estimate[2] - start[2]) / up[2];
            for i in 0..3 {
                start[i] += by * up[i];
            }
        }
        maximise(&self.data, start, &free).ok().map(|found| found.value)
    }
}

const AXES: [Parameters; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Weighted mean and standard deviation; `[0, 1]` where there is no covariate.
fn shift_and_scale(data: &[Observation], pick: fn(&Observation) -> f64, wanted: bool) -> [f64; 2] {
    if !wanted {
        return [0.0, 1.0];
    }
    let total: f64 = data.iter().map(|o| o.weight).sum();
    let mean = data.iter().map(|o| o.weight * pick(o)).sum::<f64>() / total;
    let square = |o: &Observation| o.weight * (pick(o) - mean) * (pick(o) - mean);
    let spread = (data.iter().map(square).sum::<f64>() / total).sqrt();
    [mean, if spread > 0.0 { spread } else { 1.0 }]
}

/// A maximum, with the information matrix along the free directions.
struct Maximum {
    at: Parameters,
    value: f64,
    information: Vec<Vec<f64>>,
}

/// Newton's iteration with halved steps, from `start` along the directions `free`.
fn maximise(
    data: &[Observation],
    start: Parameters,
    free: &[Parameters],
) -> Result<Maximum, FitError> {
    let mut at = start;
    let mut value = log_likelihood(data, at);
    for _ in 0..MOST_STEPS {
        let (right, projected) = along(free, slopes(data, at));
        let inverse = invert(&projected).ok_or(FitError::NoMaximum)?;
        let step: Vec<f64> =
            inverse.iter().map(|row| row.iter().zip(&right).map(|(a, b)| a * b).sum()).collect();
        // Twice what the next step can gain, by the quadratic model.
        let decrement: f64 = step.iter().zip(&right).map(|(a, b)| a * b).sum();
        let moved = |by: f64| {
            let mut to = at;
            for (direction, length) in free.iter().zip(&step) {
                for i in 0..3 {
                    to[i] += by * length * direction[i];
                }
            }
            to
        };
        if decrement < 1e-13 * (1.0 + value.abs()) {
            // Convergence is quadratic: the last step takes the error from its square root to itself.
            let last = moved(1.0);
            let (_, information) = along(free, slopes(data, last));
            return Ok(Maximum { at: last, value: log_likelihood(data, last), information });
        }
        let halves = (0..60).scan(1.0, |by, _| {
            let now = *by;
            *by *= 0.5;
            Some(now)
        });
        let better = halves
            .map(|by| (moved(by), log_likelihood(data, moved(by))))
            .find(|(_, candidate)| *candidate > value);
        let Some((to, candidate)) = better else {
            return Err(FitError::NoMaximum);
        };
        (at, value) = (to, candidate);
        if at[2].abs() * LEAST_SPREAD > 1.0 {
            return Err(FitError::NoMaximum);
        }
    }
    Err(FitError::NoMaximum)
}

/// Gradient and information along the free directions.
fn along(
    free: &[Parameters],
    (gradient, information): (Parameters, [[f64; 3]; 3]),
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let slope = |v: &Parameters| (0..3).map(|i| v[i] * gradient[i]).sum::<f64>();
    let bend = |a: &Parameters, b: &Parameters| -> f64 {
        (0..3).map(|i| (0..3).map(|j| a[i] * information[i][j] * b[j]).sum::<f64>()).sum()
    };
    let row = |a: &Parameters| free.iter().map(|b| bend(a, b)).collect();
    (free.iter().map(slope).collect(), free.iter().map(row).collect())
}

fn z(o: &Observation, [delta, gamma, h]: Parameters) -> f64 {
    h * o.y - delta - gamma * o.x
}

fn log_likelihood(data: &[Observation], p: Parameters) -> f64 {
    data.iter().fold(0.0, |sum, o| {
        let z = z(o, p);
        sum + o.weight
            * match o.known {
                // NaN for h ≤ 0 is never larger.
                Known::Exactly => libm::log(p[2]) + ln_normal_density(z),
                Known::AtMost => ln_normal_cdf(z),
                Known::AtLeast => ln_normal_cdf(-z),
            }
    })
}

/// Gradient of `ln L` and its negative second derivatives.
fn slopes(data: &[Observation], p: Parameters) -> (Parameters, [[f64; 3]; 3]) {
    let mut gradient = [0.0; 3];
    let mut information = [[0.0; 3]; 3];
    for o in data {
        let z = z(o, p);
        let dz = [-1.0, -o.x, o.y];
        let (first, second) = match o.known {
            Known::Exactly => {
                gradient[2] += o.weight / p[2];
                information[2][2] += o.weight / (p[2] * p[2]);
                (-z, 1.0)
            }
            Known::AtMost => {
                let hazard = normal_hazard(z);
                (hazard, hazard * (hazard + z))
            }
            Known::AtLeast => {
                let hazard = normal_hazard(-z);
                (-hazard, hazard * (hazard - z))
            }
        };
        for i in 0..3 {
            gradient[i] += o.weight * first * dz[i];
            for j in 0..3 {
                information[i][j] += o.weight * second * dz[i] * dz[j];
            }
        }
    }
    (gradient, information)
}

/// Inverse of a small symmetric positive matrix by Gauss and Jordan; `None` where a pivot is lost.
fn invert(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = matrix.len();
    let unit = |i: usize| (0..n).map(move |j| f64::from(u8::from(i == j)));
    let mut rows: Vec<Vec<f64>> =
        (0..n).map(|i| matrix[i].iter().copied().chain(unit(i)).collect()).collect();
    for i in 0..n {
        let pivot = rows[i][i];
        // What elimination leaves of a pivot that should be 0 is rounding of its first size.
        if !(pivot > 1e-13 * matrix[i][i]) {
            return None;
        }
        for value in &mut rows[i] {
            *value /= pivot;
        }
        for k in (0..n).filter(|k| *k != i) {
            let factor = rows[k][i];
            for j in 0..2 * n {
                rows[k][j] -= factor * rows[i][j];
            }
        }
    }
    Some(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}
