//! Samples of the varied values: points of the unit cube and what they stand for.

use crate::error::InputError;
use crate::input::Variation;
use crate::input::plan::{Distribution, Method, Plan, Varied};
use crate::numerics::distribution::{normal_cdf, normal_quantile, normal_quantile_between};
use crate::numerics::sort;
use crate::numerics::{Coordinate, Stream, latin_coordinate};

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
            let mut places = vec![0; self.vary.len()];
            for (place, varied) in places.iter_mut().zip(&self.vary).rev() {
                if let (Distribution::List(list), None) = (&varied.distribution, varied.paired_with)
                {
                    *place = rest % list.len();
                    rest /= list.len();
                }
            }
            for (i, (value, varied)) in values.iter_mut().zip(&self.vary).enumerate() {
                if let Distribution::List(list) = &varied.distribution {
                    *value = list.get(places[varied.paired_with.unwrap_or(i)]);
                }
            }
            return values;
        }
        let mut point = self.correlated(self.point(index));
        for (i, varied) in self.vary.iter().enumerate() {
            if let Some(partner) = varied.paired_with {
                point[i] = point[partner];
            }
        }
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
                    latin_coordinate(index, self.count, order, jitter)
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
        let scores: Vec<f64> = point.iter().map(|&u| normal_quantile(u)).collect();
        let of_row = |(i, &u): (usize, &f64)| {
            let row = &lower[i * n..i * n + i];
            if row.iter().all(|l| *l == 0.0) {
                // Nothing before it is correlated with it: as it was, to the last bit.
                return u;
            }
            let score: f64 = row.iter().zip(&scores).map(|(l, z)| l * z).sum();
            let u = normal_cdf(score + lower[i * n + i] * scores[i]);
            u.clamp(f64::EPSILON / 4.0, 1.0 - f64::EPSILON / 2.0)
        };
        point.iter().enumerate().map(of_row).collect()
    }
}

/// The value of a distribution at a probability, 0 < u < 1; NaN where none is left.
fn drawn(distribution: &Distribution, u: f64) -> f64 {
    let score = |limits: Option<[f64; 2]>| match limits {
        None => Some(normal_quantile(u)),
        Some(limits) => normal_quantile_between(u, limits),
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
    sort(&mut order, |&i, &j| depth(i).cmp(&depth(j)));
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0.2\n\
                         kinetic_friction = 0.1\nradius = \"2 m\"\n";

    fn design(vary: &str, sampling: &str) -> Result<Design, String> {
        let text = format!("model = \"m.toml\"\n[vary]\n{vary}\n[sampling]\n{sampling}\n");
        let plan = Plan::parse("p.toml", &text).map_err(|error| error.to_string())?;
        let model = Variation::new("m.toml", MODEL, &plan.vary).map_err(|e| e.to_string())?;
        Design::new(&plan, &model).map_err(|error| error.to_string())
    }

    const SOBOL: &str = "method = \"sobol\"\ncount = 4096\nseed = 3";
    const LATIN: &str = "method = \"latin-hypercube\"\ncount = 4096\nseed = 3";

    fn column(design: &Design, i: usize) -> Vec<f64> {
        (0..design.count()).map(|index| design.values(index)[i]).collect()
    }

    #[test]
    fn grid_counts_the_last_path_fastest() {
        let vary = "slider.radius = { values = [\"1 m\", \"2 m\"] }\n\
                    slider.gap = { linspace = [\"1 m\", \"3 m\", 3] }";
        let design = design(vary, "method = \"grid\"").unwrap();
        let all: Vec<_> = (0..design.count()).map(|index| design.values(index)).collect();
        let expected = [[1.0, 1.0], [1.0, 2.0], [1.0, 3.0], [2.0, 1.0], [2.0, 2.0], [2.0, 3.0]];
        assert_eq!(all, expected);
    }

    #[test]
    fn pairs_stay_together() {
        let vary = "slider.radius = { values = [\"1 m\", \"2 m\", \"3 m\"] }\n\
                    slider.gap = { values = [\"10 m\", \"20 m\", \"30 m\"], \
                    paired_with = \"slider.radius\" }\n\
                    slider.tilt = { values = [\"0 rad\", \"0.1 rad\"] }";
        for sampling in ["method = \"grid\"", SOBOL, LATIN] {
            let design = design(vary, sampling).unwrap();
            let mut seen = std::collections::BTreeSet::new();
            for index in 0..design.count() {
                let values = design.values(index);
                assert_eq!(values[1], 10.0 * values[0]);
                seen.insert(values[0] as u64);
            }
            assert_eq!(seen.len(), 3);
        }
        assert_eq!(design(vary, "method = \"grid\"").unwrap().count(), 6);
    }

    #[test]
    fn factors_multiply_drawn_and_fixed_values() {
        let vary = "slider.static_friction = { factor_of = \"slider.kinetic_friction\", \
                    values = [1, 1.5] }\n\
                    slider.kinetic_friction = { values = [0.1, 0.2] }\n\
                    slider.gap = { factor_of = \"slider.radius\", values = [0.25] }";
        let design = design(vary, "method = \"grid\"").unwrap();
        let all: Vec<_> = (0..design.count()).map(|index| design.values(index)).collect();
        let pairs = [[1.0, 0.1], [1.0, 0.2], [1.5, 0.1], [1.5, 0.2]];
        assert_eq!(all, pairs.map(|[factor, base]| [factor * base, base, 0.5]));
        let error = self::design(
            "slider.gap = { factor_of = \"slider.spring\", values = [1] }",
            "method = \"grid\"",
        );
        assert!(error.unwrap_err().contains("expected the path of a length"));
        let error = self::design(
            "slider.gap = { factor_of = \"block.width\", values = [1] }",
            "method = \"grid\"",
        );
        assert_eq!(
            error.unwrap_err(),
            "p.toml:3:28: vary.slider.gap.factor_of: expected a path that the model or the plan \
             gives one number, found \"block.width\""
        );
    }

    /// Sample quantiles of each distribution are those of theory: 4096 points of a net lie within
    /// one rank of it, 1/4096 of probability.
    #[test]
    fn quantiles_of_distributions() {
        let vary = "slider.kinetic_friction = { normal = [0.1, 0.01] }\n\
                    slider.radius = { lognormal = [\"2 m\", 0.5], truncated = [\"1 m\", \"4 m\"] }\n\
                    slider.gap = { uniform = [\"1 m\", \"3 m\"] }";
        for sampling in [SOBOL, LATIN] {
            let design = design(vary, sampling).unwrap();
            let quantile = |i: usize, p: f64| {
                let mut all = column(&design, i);
                all.sort_by(f64::total_cmp);
                all[(p * all.len() as f64) as usize]
            };
            // Φ⁻¹(0.84) = 0.994458; the density there makes 1/4096 worth 0.001 standard deviations.
            assert!((quantile(0, 0.84) - 0.109_944_6).abs() < 2e-5);
            assert!((quantile(0, 0.5) - 0.1).abs() < 1e-5);
            // ln 2 is 1.386 standard deviations from the median either way: symmetric.
            assert!((quantile(1, 0.5) - 2.0).abs() < 2e-3);
            let all = column(&design, 1);
            assert!(all.iter().all(|radius| (1.0..=4.0).contains(radius)));
            assert!(quantile(1, 0.0) < 1.001 && quantile(1, 0.9999) > 3.99);
            assert!((quantile(2, 0.25) - 1.5).abs() < 1e-3);
        }
    }

    /// The rank correlation of a Gaussian copula is 6/π asin(ρ/2), whatever the margins.
    #[test]
    fn copula_has_its_rank_correlation() {
        let vary = "slider.kinetic_friction = { lognormal = [0.1, 0.3] }\n\
                    slider.radius = { uniform = [\"1 m\", \"2 m\"] }\n\
                    slider.gap = { uniform = [\"1 m\", \"2 m\"] }";
        let pairs = "correlation = [[\"slider.kinetic_friction\", \"slider.radius\", -0.7]]";
        let design = design(vary, &format!("{SOBOL}\n{pairs}")).unwrap();
        let plain = self::design(vary, SOBOL).unwrap();
        let ranks = |values: &[f64]| -> Vec<f64> {
            let mut order: Vec<usize> = (0..values.len()).collect();
            sort(&mut order, |&a, &b| values[a].total_cmp(&values[b]));
            let mut ranks = vec![0.0; values.len()];
            for (rank, index) in order.into_iter().enumerate() {
                ranks[index] = (rank as f64 + 0.5) / values.len() as f64 - 0.5;
            }
            ranks
        };
        let spearman = |i: usize, j: usize| -> f64 {
            let (a, b) = (ranks(&column(&design, i)), ranks(&column(&design, j)));
            12.0 * a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>() / a.len() as f64
        };
        let expected = 6.0 / core::f64::consts::PI * libm::asin(-0.35);
        assert!((spearman(0, 1) - expected).abs() < 0.01, "{} {expected}", spearman(0, 1));
        assert!(spearman(0, 2).abs() < 0.01);
        // What is correlated with nothing before it is left as it was, to the last bit.
        assert_eq!(column(&design, 0), column(&plain, 0));
        assert_eq!(column(&design, 2), column(&plain, 2));
    }

    /// Another seed, other samples; the same seed, the same ones, whatever was asked before.
    #[test]
    fn samples_follow_from_seed_and_index_alone() {
        let vary = "slider.radius = { uniform = [\"1 m\", \"2 m\"] }";
        for sampling in [SOBOL, LATIN] {
            let (a, b) = (design(vary, sampling).unwrap(), design(vary, sampling).unwrap());
            let backwards: Vec<_> = (0..4096).rev().map(|index| a.values(index)[0]).collect();
            assert!(backwards.into_iter().rev().eq(column(&b, 0)));
            let other = design(vary, &sampling.replace("seed = 3", "seed = 4")).unwrap();
            let same =
                column(&other, 0).iter().zip(column(&b, 0)).filter(|(x, y)| **x == *y).count();
            assert!(same < 3);
        }
    }

    /// The samples of today, so that those of tomorrow are the same on every machine.
    #[test]
    fn the_first_samples_stay() {
        let vary = "slider.radius = { lognormal = [\"2 m\", 0.5] }";
        let first = |sampling| design(vary, sampling).unwrap().values(1)[0];
        assert_eq!(first(SOBOL).to_bits(), 4_609_994_163_610_663_763);
        assert_eq!(first(LATIN).to_bits(), 4_607_355_239_749_235_389);
    }

    #[test]
    fn truncation_that_leaves_nothing_is_refused() {
        let vary =
            "slider.radius = { normal = [\"1 m\", \"1 mm\"], truncated = [\"2 m\", \"3 m\"] }";
        let error = design(vary, SOBOL).unwrap_err();
        assert!(
            error.contains("expected limits between which the distribution has some"),
            "{error}"
        );
    }
}
