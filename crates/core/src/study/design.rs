//! Samples of the varied values: points of the unit cube and what they stand for.

use super::hash::Stream;
use super::sobol::Coordinate;
use super::{latin, normal};
use crate::error::InputError;
use crate::input::Variation;
use crate::input::plan::{Distribution, Method, Plan, Varied};

/// What random numbers are used for; each use has its own.
mod purpose {
    pub(super) const SCRAMBLE: u64 = 0;
    pub(super) const ORDER: u64 = 1;
    pub(super) const JITTER: u64 = 2;
}

/// The samples of a plan, each found by its index alone.
#[derive(Clone, Debug)]
pub struct Design {
    vary: Vec<Varied>,
    /// For each path what its drawn number multiplies; `None` where it is the value itself.
    factor_of: Vec<Option<Base>>,
    /// Paths in an order in which each comes after the one it is a factor of.
    order: Vec<usize>,
    count: u64,
    points: Points,
    correlation: Option<Vec<f64>>,
}

#[derive(Clone, Copy, Debug)]
enum Base {
    /// The value of another varied path.
    Varied(usize),
    /// A value of the model.
    Fixed(f64),
}

#[derive(Clone, Debug)]
enum Points {
    Single,
    Grid,
    Latin { seed: u64 },
    Sobol { seed: u64, coordinates: Vec<Coordinate> },
}

impl Design {
    /// The samples of a plan for a model.
    ///
    /// # Errors
    /// [`InputError`] for a factor of a value that the model does not have, and for a truncated
    /// distribution of which nothing is left.
    pub fn new(plan: &Plan, model: &Variation) -> Result<Self, InputError> {
        let vary = plan.vary.clone();
        let mut factor_of = Vec::with_capacity(vary.len());
        for varied in &vary {
            let Some(of) = &varied.factor_of else {
                factor_of.push(None);
                continue;
            };
            let other = vary.iter().position(|other| other.path == *of).map(Base::Varied);
            let base = other.or_else(|| model.number(of).map(Base::Fixed)).ok_or_else(|| {
                let place = format!("vary.{}.factor_of", varied.path);
                let expected = "a path that the model or the plan gives one number";
                plan.error_at(&place, expected, format!("\"{of}\""))
            })?;
            factor_of.push(Some(base));
        }
        for varied in &vary {
            if !drawn(&varied.distribution, 0.5).is_finite() {
                let place = format!("vary.{}.truncated", varied.path);
                let expected = "limits between which the distribution has some probability";
                return Err(plan.error_at(&place, expected, "none"));
            }
        }
        let sampling = plan.sampling.as_ref();
        let seed = sampling.and_then(|sampling| sampling.seed).unwrap_or(0);
        let points = match sampling.map(|sampling| sampling.method) {
            None => Points::Single,
            Some(Method::Grid) => Points::Grid,
            Some(Method::LatinHypercube) => Points::Latin { seed },
            Some(Method::Sobol) => {
                let coordinates = (0..vary.len()).filter_map(Coordinate::new).collect();
                Points::Sobol { seed, coordinates }
            }
        };
        Ok(Self {
            order: order(&factor_of),
            count: plan.samples(),
            correlation: sampling.and_then(|sampling| sampling.correlation.clone()),
            vary,
            factor_of,
            points,
        })
    }

    /// Number of samples.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// What is varied, in the order of the values.
    #[must_use]
    pub fn vary(&self) -> &[Varied] {
        &self.vary
    }

    /// The values of the sample of an index below [`Design::count`], in SI.
    #[must_use]
    pub fn values(&self, index: u64) -> Vec<f64> {
        let mut values = self.drawn(index);
        for &i in &self.order {
            let Some(base) = self.factor_of.get(i).copied().flatten() else { continue };
            let base = match base {
                Base::Varied(other) => values[other],
                Base::Fixed(value) => value,
            };
            values[i] *= base;
        }
        values
    }

    /// What is drawn: values, and factors of others.
    fn drawn(&self, index: u64) -> Vec<f64> {
        if let Points::Grid = self.points {
            let mut rest = index;
            let mut values = vec![0.0; self.vary.len()];
            for (value, varied) in values.iter_mut().zip(&self.vary).rev() {
                if let Distribution::List(list) = &varied.distribution {
                    *value = list.get(rest % list.len());
                    rest /= list.len();
                }
            }
            return values;
        }
        let point = self.correlated(self.point(index));
        self.vary.iter().zip(point).map(|(varied, u)| drawn(&varied.distribution, u)).collect()
    }

    /// A point of the open unit cube.
    fn point(&self, index: u64) -> Vec<f64> {
        let dimensions = self.vary.len();
        match &self.points {
            Points::Single | Points::Grid => vec![0.5; dimensions],
            Points::Latin { seed } => (0..dimensions as u64)
                .map(|dimension| {
                    let order = Stream::new(*seed, purpose::ORDER, dimension);
                    let jitter = Stream::new(*seed, purpose::JITTER, dimension);
                    latin::coordinate(index, self.count, order, jitter)
                })
                .collect(),
            Points::Sobol { seed, coordinates } => coordinates
                .iter()
                .enumerate()
                .map(|(dimension, coordinate)| {
                    let random = Stream::new(*seed, purpose::SCRAMBLE, dimension as u64);
                    coordinate.scrambled(index as u32, random)
                })
                .collect(),
        }
    }

    /// The Gaussian copula: normal scores of the point, correlated, and their probabilities.
    fn correlated(&self, point: Vec<f64>) -> Vec<f64> {
        let Some(lower) = &self.correlation else { return point };
        let n = point.len();
        let scores: Vec<f64> = point.iter().map(|&u| normal::inverse(u)).collect();
        let of_row = |(i, &u): (usize, &f64)| {
            let row = &lower[i * n..i * n + i];
            if row.iter().all(|l| *l == 0.0) {
                // Nothing before it is correlated with it: as it was, to the last bit.
                return u;
            }
            let score: f64 = row.iter().zip(&scores).map(|(l, z)| l * z).sum();
            let u = normal::probability(score + lower[i * n + i] * scores[i]);
            u.clamp(f64::EPSILON / 4.0, 1.0 - f64::EPSILON / 2.0)
        };
        point.iter().enumerate().map(of_row).collect()
    }
}

/// The value of a distribution at a probability, 0 < u < 1; NaN where none is left.
fn drawn(distribution: &Distribution, u: f64) -> f64 {
    let score = |limits: Option<[f64; 2]>| match limits {
        None => Some(normal::inverse(u)),
        Some(limits) => normal::inverse_between(u, limits),
    };
    match distribution {
        Distribution::List(list) => list.get((u * list.len() as f64) as u64),
        Distribution::Uniform([lo, hi]) => (lo + u * (hi - lo)).clamp(*lo, *hi),
        Distribution::Normal { mean, deviation, truncated } => {
            let limits = truncated.map(|ends| ends.map(|end| (end - mean) / deviation));
            let value = score(limits).map_or(f64::NAN, |z| mean + deviation * z);
            truncated.map_or(value, |[lo, hi]| value.clamp(lo, hi))
        }
        Distribution::Lognormal { median, sigma_ln, truncated } => {
            let limits =
                truncated.map(|ends| ends.map(|end| libm::log(end.max(0.0) / median) / sigma_ln));
            let value = score(limits).map_or(f64::NAN, |z| median * libm::exp(sigma_ln * z));
            truncated.map_or(value, |[lo, hi]| value.clamp(lo, hi))
        }
    }
}

/// Each after the one it is a factor of; the plan has refused circles.
fn order(factor_of: &[Option<Base>]) -> Vec<usize> {
    let mut order = Vec::with_capacity(factor_of.len());
    let depth = |mut i: usize| {
        let mut depth = 0;
        while let Some(Some(Base::Varied(other))) = factor_of.get(i)
            && depth < factor_of.len()
        {
            i = *other;
            depth += 1;
        }
        depth
    };
    order.extend(0..factor_of.len());
    order.sort_by_key(|&i| depth(i));
    order
}
