//! Lognormal fragility: the probability that a demand exceeds its limit, over intensity.
//!
//! ```text
//! P(exceedance | x) = Φ(ln(x/θ) / β)       θ median, β dispersion
//! ```
//!
//! by maximum likelihood from three kinds of data, each a case of [`super::censored`]:
//!
//! - counts at levels (stripes): `k` of `n` runs at `x` exceed, that is, their capacities lie below
//!   `x`, and `n − k` above (J. W. Baker, *Earthquake Spectra* 31, 2015, eq. (11));
//! - capacities (incremental dynamic analysis): each record's level is known, or is known to lie
//!   above the last level tried;
//! - a cloud: `ln D = a + b ln x + σ ε`, demands below a floor or above a cap known only as such; then
//!   `ln θ = (ln L − a)/b` and `β = σ/b` (F. Jalayer and C. A. Cornell, 2003, with Tobin's
//!   likelihood).
//!
//! Runs of one record are not independent of each other: a record that asks much does so at every
//! level and of every design. Where records have several observations, standard errors and intervals
//! are clustered by record ([`Certainty`]).

use super::censored::{Fit, Known, Observation, Parameters};
use crate::error::{FitError, Stopped};
use crate::numerics::distribution::{
    chi_squared_tail, normal_cdf, normal_quantile, student_quantile,
};
use crate::numerics::fractile::{fractile, sorted};
use crate::numerics::random::Random;
use crate::study::engine::Engine;

/// A lognormal curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lognormal {
    /// Median `θ`, in the unit of the intensity measure.
    pub median: f64,
    /// Dispersion `β`: standard deviation of the natural logarithm.
    pub dispersion: f64,
}

impl Lognormal {
    /// Probability of exceedance at an intensity ≥ 0.
    #[must_use]
    pub fn probability(&self, intensity: f64) -> f64 {
        normal_cdf(libm::log(intensity / self.median) / self.dispersion)
    }

    /// Intensity at which the probability of exceedance is `p`.
    #[must_use]
    pub fn intensity(&self, p: f64) -> f64 {
        self.median * libm::exp(self.dispersion * normal_quantile(p))
    }

    /// Fit of capacities by the method of moments: `ln θ` the mean of their logarithms, `β` their
    /// standard deviation with `n − 1`.
    ///
    /// # Errors
    /// [`FitError`] for fewer than two capacities, or one that is not finite and > 0.
    pub fn of_moments(capacities: &[f64]) -> Result<Self, FitError> {
        let n = capacities.len();
        if n < 2 {
            return Err(FitError::TooFew { what: "capacities", expected: 2, found: n });
        }
        let logs = capacities.iter().map(|&c| positive("capacity", c).map(libm::log));
        let logs = logs.collect::<Result<Vec<f64>, _>>()?;
        let mean = logs.iter().sum::<f64>() / n as f64;
        let square = logs.iter().map(|l| (l - mean) * (l - mean)).sum::<f64>();
        Ok(Self { median: libm::exp(mean), dispersion: (square / (n - 1) as f64).sqrt() })
    }
}

/// Runs at one intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripe {
    /// Intensity, > 0.
    pub level: f64,
    /// Number of runs, > 0.
    pub runs: u64,
    /// How many of them exceed the limit.
    pub exceeded: u64,
}

/// Level at which a record reaches the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capacity {
    /// The intensity, > 0.
    pub level: f64,
    /// Whether the limit is reached there; else only that it is not reached up to there.
    pub reached: bool,
}

/// A run of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudPoint {
    /// Intensity, > 0.
    pub level: f64,
    /// Demand, > 0; where it is a bound, the floor or the cap.
    pub demand: f64,
    /// Whether the demand is known, or only that it lies below the floor or above the cap.
    pub known: Known,
}

/// A fitted fragility with what its data say of its certainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Fragility {
    curve: Lognormal,
    fit: Fit,
    kind: Kind,
    /// The record of each observation of the fit, numbered from 0; empty where all are independent.
    records: Vec<usize>,
    certainty: Certainty,
}

/// What standard errors, intervals and band follow from.
#[derive(Clone, Debug, PartialEq)]
pub enum Certainty {
    /// Independent observations: the observed information and the profile likelihood.
    Independent,
    /// Observations of one record depend on each other: the sandwich of scores summed by record, with
    /// Student's distribution on `records − 1` degrees of freedom.
    Clustered {
        /// Number of records.
        records: usize,
    },
    /// Fits to records drawn with replacement: fractiles of their curves.
    Bootstrap {
        /// Number of records.
        records: usize,
        /// The curves of the draws that could be fitted.
        curves: Vec<Lognormal>,
        /// Number of draws without a fit, which are left out.
        failed: usize,
    },
}

/// How `θ` and `β` follow from the parameters `δ, γ, h` of the fit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// `ln θ = δ/h`, `β = 1/h`.
    Capacity,
    /// `ln θ = (h ln L − δ)/γ`, `β = 1/γ`, with this `ln L`.
    Cloud(f64),
}

impl Fragility {
    /// From counts at levels; stripes of one level are added up.
    ///
    /// # Errors
    /// [`FitError`] for counts that do not fit, for a level that is not > 0, and where the counts
    /// cannot tell a curve: none or all exceed, one level only, the two separated, or a share that
    /// falls with intensity.
    pub fn of_stripes(stripes: &[Stripe]) -> Result<Self, FitError> {
        Self::of_stripes_by_record(stripes, &[])
    }

    /// The same with the record of each stripe, by which its certainty is clustered; records are
    /// numbers from 0, none left out.
    ///
    /// # Errors
    /// As [`Fragility::of_stripes`], and [`FitError::TooFew`] for a single record.
    pub fn of_stripes_by_record(stripes: &[Stripe], records: &[usize]) -> Result<Self, FitError> {
        let mut data = Vec::new();
        let mut clusters = Vec::new();
        for (i, stripe) in stripes.iter().enumerate() {
            let y = libm::log(positive("level", stripe.level)?);
            if stripe.runs == 0 || stripe.exceeded > stripe.runs {
                return Err(FitError::OutOfRange {
                    quantity: "exceedances of a stripe",
                    expected: "at most its number of runs, which is at least 1",
                    found: stripe.exceeded as f64,
                });
            }
            let counts =
                [(Known::AtMost, stripe.exceeded), (Known::AtLeast, stripe.runs - stripe.exceeded)];
            for (known, count) in counts.into_iter().filter(|(_, count)| *count > 0) {
                data.push(Observation { x: 0.0, y, known, weight: count as f64 });
                clusters.extend(records.get(i));
            }
        }
        if data.is_empty() {
            return Err(FitError::TooFew { what: "stripes", expected: 2, found: 0 });
        }
        refuse_separated(stripes)?;
        Self::of_capacity_fit(Fit::new(&data, false)?, clusters)
    }

    /// From capacities, those not reached being known only from below.
    ///
    /// # Errors
    /// [`FitError`] for fewer than two capacities that are reached, for levels that are not > 0, and
    /// where the values do not scatter.
    pub fn of_capacities(capacities: &[Capacity]) -> Result<Self, FitError> {
        Self::of_capacities_by_record(capacities, &[])
    }

    /// The same with the record of each capacity, as in [`Fragility::of_stripes_by_record`].
    ///
    /// # Errors
    /// As [`Fragility::of_capacities`], and [`FitError::TooFew`] for a single record.
    pub fn of_capacities_by_record(
        capacities: &[Capacity],
        records: &[usize],
    ) -> Result<Self, FitError> {
        let mut data = Vec::with_capacity(capacities.len());
        for capacity in capacities {
            let y = libm::log(positive("capacity", capacity.level)?);
            let known = if capacity.reached { Known::Exactly } else { Known::AtLeast };
            data.push(Observation { x: 0.0, y, known, weight: 1.0 });
        }
        let reached = capacities.iter().filter(|capacity| capacity.reached).count();
        if reached == 0 && !capacities.is_empty() {
            let highest = capacities.iter().map(|c| c.level).fold(0.0, f64::max);
            return Err(FitError::NoneExceeds { runs: capacities.len() as u64, highest });
        }
        if reached < 2 {
            let what = "capacities that are reached";
            return Err(FitError::TooFew { what, expected: 2, found: reached });
        }
        Self::of_capacity_fit(Fit::new(&data, false)?, records.to_vec())
    }

    /// From a cloud of intensities and demands, for a limit on the demand in its unit.
    ///
    /// # Errors
    /// [`FitError`] for fewer than three demands that are known, for values that are not > 0, for a
    /// single intensity, for points on a line, and for demands that do not grow with intensity.
    pub fn of_cloud(points: &[CloudPoint], limit: f64) -> Result<Self, FitError> {
        Self::of_cloud_by_record(points, limit, &[])
    }

    /// The same with the record of each point, as in [`Fragility::of_stripes_by_record`].
    ///
    /// # Errors
    /// As [`Fragility::of_cloud`], and [`FitError::TooFew`] for a single record.
    pub fn of_cloud_by_record(
        points: &[CloudPoint],
        limit: f64,
        records: &[usize],
    ) -> Result<Self, FitError> {
        let ln_limit = libm::log(positive("limit", limit)?);
        let mut data = Vec::with_capacity(points.len());
        for point in points {
            let x = libm::log(positive("level", point.level)?);
            let y = libm::log(positive("demand", point.demand)?);
            data.push(Observation { x, y, known: point.known, weight: 1.0 });
        }
        let known = points.iter().filter(|point| point.known == Known::Exactly).count();
        if known < 3 {
            let what = "demands between floor and cap";
            return Err(FitError::TooFew { what, expected: 3, found: known });
        }
        if points.iter().all(|point| point.level == points[0].level) {
            return Err(FitError::OneLevel { level: points[0].level });
        }
        Self::of_fit(Fit::new(&data, true)?, Kind::Cloud(ln_limit), records.to_vec())
    }

    fn of_capacity_fit(fit: Fit, records: Vec<usize>) -> Result<Self, FitError> {
        if !fit.rises() {
            return Err(FitError::Falls);
        }
        Self::of_fit(fit, Kind::Capacity, records)
    }

    /// Clustered where a record has more than one observation.
    fn of_fit(mut fit: Fit, kind: Kind, mut records: Vec<usize>) -> Result<Self, FitError> {
        let curve = kind.curve(fit.parameters()).ok_or(FitError::Falls)?;
        let count = records.iter().max().map_or(0, |last| last + 1);
        if count as f64 == fit.weight() {
            records.clear();
        }
        let certainty = match (records.is_empty(), count) {
            (true, _) => Certainty::Independent,
            (_, 1) => {
                let what = "records, whose scatter tells the certainty";
                return Err(FitError::TooFew { what, expected: 2, found: 1 });
            }
            _ => {
                fit.cluster(&records);
                Certainty::Clustered { records: count }
            }
        };
        Ok(Self { curve, fit, kind, records, certainty })
    }

    /// The same fit with its certainty from so many draws of all records with replacement, each fitted
    /// anew; where observations are independent, they are drawn themselves.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn bootstrapped(
        mut self,
        draws: u32,
        seed: u64,
        engine: &Engine<'_>,
    ) -> Result<Self, Stopped> {
        let own: Vec<usize> = (0..self.fit.observations()).collect();
        let records = if self.records.is_empty() { &own } else { &self.records };
        let count = records.iter().max().map_or(0, |last| last + 1);
        let mut random = Random::new(seed);
        let mut curves = Vec::with_capacity(draws as usize);
        let mut times = vec![0_u32; count];
        engine.plan(u64::from(draws));
        for _ in 0..draws {
            engine.done(1)?;
            times.fill(0);
            for _ in 0..count {
                times[random.below(count)] += 1;
            }
            let found = self.fit.resampled(|i| times[records[i]]).ok();
            curves.extend(found.and_then(|parameters| self.kind.curve(parameters)));
        }
        let failed = draws as usize - curves.len();
        self.certainty = Certainty::Bootstrap { records: count, curves, failed };
        Ok(self)
    }

    /// What standard errors, intervals and band follow from.
    #[must_use]
    pub fn certainty(&self) -> &Certainty {
        &self.certainty
    }

    /// How many standard errors an interval of that confidence reaches to either side.
    fn reach(&self, confidence: f64) -> f64 {
        match self.certainty {
            Certainty::Clustered { records } => student_quantile(confidence, (records - 1) as f64),
            _ => normal_quantile(0.5 + 0.5 * confidence),
        }
    }

    /// The curve.
    #[must_use]
    pub fn curve(&self) -> Lognormal {
        self.curve
    }

    /// The fit behind it: of a cloud, its line and scatter.
    #[must_use]
    pub fn fit(&self) -> &Fit {
        &self.fit
    }

    /// The form of `[δ, γ, h]` that is `ln(x/θ)/β`.
    fn form(&self, ln_x: f64) -> Parameters {
        match self.kind {
            Kind::Capacity => [-1.0, 0.0, ln_x],
            Kind::Cloud(ln_limit) => [1.0, ln_x, -ln_limit],
        }
    }

    /// Confidence band of the probability at an intensity > 0, pointwise: `ln(x/θ)/β` is linear in
    /// the parameters, so `Φ(η ± z se(η))` with its standard error (the delta method on the scale of the
    /// probit); of a bootstrap the fractiles of its curves.
    #[must_use]
    pub fn band(&self, intensity: f64, confidence: f64) -> [f64; 2] {
        if let Certainty::Bootstrap { curves, .. } = &self.certainty {
            return middle(curves.iter().map(|c| c.probability(intensity)), confidence)
                .map(|end| end.unwrap_or(f64::NAN));
        }
        let form = self.form(libm::log(intensity));
        let [delta, gamma, h] = self.fit.parameters();
        let eta = form[0] * delta + form[1] * gamma + form[2] * h;
        let half = self.reach(confidence) * self.fit.standard_error(form);
        [normal_cdf(eta - half), normal_cdf(eta + half)]
    }

    /// Confidence interval of the median; `None` where it is open. By profile likelihood where
    /// observations are independent, `θ exp(± t se(ln θ))` where they are clustered.
    #[must_use]
    pub fn median_interval(&self, confidence: f64) -> [Option<f64>; 2] {
        let ln_median = libm::log(self.curve.median);
        match &self.certainty {
            Certainty::Independent => {}
            Certainty::Clustered { .. } => {
                let half = self.reach(confidence) * self.standard_errors()[0];
                return [-half, half].map(|by| Some(libm::exp(ln_median + by)));
            }
            Certainty::Bootstrap { curves, .. } => {
                return middle(curves.iter().map(|curve| curve.median), confidence);
            }
        }
        // d ln θ = −β dη at the median.
        let se = self.curve.dispersion * self.fit.standard_error(self.form(ln_median));
        let ends = self.fit.profile(ln_median, se.max(1e-9), confidence, |v| (self.form(v), 0.0));
        ends.map(|end| end.map(libm::exp))
    }

    /// Confidence interval of the dispersion, as [`Fragility::median_interval`]: clustered it is
    /// `β exp(± t se(β)/β)`.
    #[must_use]
    pub fn dispersion_interval(&self, confidence: f64) -> [Option<f64>; 2] {
        match &self.certainty {
            Certainty::Independent => {}
            Certainty::Clustered { .. } => {
                let beta = self.curve.dispersion;
                let half = self.reach(confidence) * self.standard_errors()[1] / beta;
                return [-half, half].map(|by| Some(beta * libm::exp(by)));
            }
            Certainty::Bootstrap { curves, .. } => {
                return middle(curves.iter().map(|curve| curve.dispersion), confidence);
            }
        }
        let rate = match self.kind {
            Kind::Capacity => [0.0, 0.0, 1.0],
            Kind::Cloud(_) => [0.0, 1.0, 0.0],
        };
        let se = self.fit.standard_error(rate) * self.curve.dispersion;
        let ln_dispersion = libm::log(self.curve.dispersion);
        let condition = |v: f64| (rate, libm::exp(-v));
        let ends = self.fit.profile(ln_dispersion, se.max(1e-9), confidence, condition);
        ends.map(|end| end.map(libm::exp))
    }

    /// Standard errors of `ln θ` and `β`, by the delta method; of a bootstrap the standard deviations of
    /// its curves.
    #[must_use]
    pub fn standard_errors(&self) -> [f64; 2] {
        if let Certainty::Bootstrap { curves, .. } = &self.certainty {
            return [
                deviation(curves.iter().map(|curve| libm::log(curve.median))),
                deviation(curves.iter().map(|curve| curve.dispersion)),
            ];
        }
        let beta = self.curve.dispersion;
        let of_median = beta * self.fit.standard_error(self.form(libm::log(self.curve.median)));
        let rate = match self.kind {
            Kind::Capacity => [0.0, 0.0, 1.0],
            Kind::Cloud(_) => [0.0, 1.0, 0.0],
        };
        [of_median, beta * beta * self.fit.standard_error(rate)]
    }
}

impl Kind {
    /// The curve of `[δ, γ, h]`; `None` where it does not rise.
    fn curve(self, [delta, gamma, h]: Parameters) -> Option<Lognormal> {
        let (ln_median, rate) = match self {
            Self::Capacity => (delta / h, h),
            Self::Cloud(ln_limit) => ((h * ln_limit - delta) / gamma, gamma),
        };
        let (median, dispersion) = (libm::exp(ln_median), rate.recip());
        let rises = rate > 0.0 && median.is_finite() && median > 0.0;
        rises.then_some(Lognormal { median, dispersion })
    }
}

/// The fractiles between which the middle of the values lies; `None` without values.
fn middle(values: impl Iterator<Item = f64>, share: f64) -> [Option<f64>; 2] {
    let values = sorted(&values.collect::<Vec<_>>());
    [0.5 - 0.5 * share, 0.5 + 0.5 * share]
        .map(|p| (!values.is_empty()).then(|| fractile(&values, p)))
}

/// Standard deviation with `n − 1`.
fn deviation(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0)).sqrt()
}

/// How far counts lie from the fitted curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountsTest {
    /// Twice the log-likelihood lost against a probability of its own for every level.
    pub deviance: f64,
    /// Pearson's χ².
    pub pearson: f64,
    /// Levels less two.
    pub degrees: usize,
    /// Probability of a deviance as large or larger if the curve is right (χ², asymptotic); `None`
    /// without degrees of freedom.
    pub p_value: Option<f64>,
    /// Least expected number of exceedances or of others at a level; below about 1 at several
    /// levels the p-value is rough.
    pub least_expected: f64,
}

/// Deviance and Pearson's χ² of counts against a curve.
#[must_use]
pub fn test_counts(curve: &Lognormal, stripes: &[Stripe]) -> CountsTest {
    let mut levels: Vec<Stripe> = Vec::new();
    for stripe in stripes {
        match levels.iter_mut().find(|seen| seen.level == stripe.level) {
            Some(seen) => {
                seen.runs += stripe.runs;
                seen.exceeded += stripe.exceeded;
            }
            None => levels.push(*stripe),
        }
    }
    let (mut deviance, mut pearson, mut least_expected) = (0.0, 0.0, f64::INFINITY);
    for stripe in &levels {
        let ln_ratio = libm::log(stripe.level / curve.median) / curve.dispersion;
        let n = stripe.runs as f64;
        for (count, p) in [
            (stripe.exceeded, normal_cdf(ln_ratio)),
            (stripe.runs - stripe.exceeded, normal_cdf(-ln_ratio)),
        ] {
            let (count, expected) = (count as f64, n * p);
            if count > 0.0 {
                deviance += 2.0 * count * libm::log(count / expected);
            }
            if expected > 0.0 {
                pearson += (count - expected) * (count - expected) / expected;
            }
            least_expected = least_expected.min(expected);
        }
    }
    let degrees = levels.len().saturating_sub(2);
    let p_value = (degrees > 0).then(|| chi_squared_tail(deviance, degrees as f64));
    CountsTest { deviance, pearson, degrees, p_value, least_expected }
}

/// How far a sample lies from the normal distribution with its own mean and standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalityTest {
    /// Anderson and Darling's A².
    pub anderson_darling: f64,
    /// Probability of an A² as large or larger of a normal sample (M. A. Stephens, with the formulas
    /// of R. B. D'Agostino and M. A. Stephens, *Goodness-of-Fit Techniques*, 1986, table 4.9).
    pub p_value: f64,
    /// Largest difference between the empirical and the fitted distribution (Lilliefors' D).
    pub largest_difference: f64,
}

/// Anderson–Darling test of logarithms of capacities, or of residuals, against the normal
/// distribution with the sample's mean and standard deviation (with `n − 1`); `None` for fewer than
/// eight values, where its p-value is not known, and for values that do not scatter.
#[must_use]
pub fn test_normality(values: &[f64]) -> Option<NormalityTest> {
    let n = values.len();
    if n < 8 || values.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = n as f64;
    let mean = sorted.iter().sum::<f64>() / count;
    let square = sorted.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
    let deviation = (square / (count - 1.0)).sqrt();
    if !(deviation > 0.0) {
        return None;
    }
    let z: Vec<f64> = sorted.iter().map(|v| (v - mean) / deviation).collect();
    let (mut sum, mut largest_difference) = (0.0, 0.0_f64);
    for i in 0..n {
        let rank = (2 * i + 1) as f64;
        sum += rank
            * (crate::numerics::distribution::ln_normal_cdf(z[i])
                + crate::numerics::distribution::ln_normal_cdf(-z[n - 1 - i]));
        let p = normal_cdf(z[i]);
        let (below, above) = (p - i as f64 / count, (i + 1) as f64 / count - p);
        largest_difference = largest_difference.max(below).max(above);
    }
    let anderson_darling = -count - sum / count;
    let a = anderson_darling * (1.0 + 0.75 / count + 2.25 / (count * count));
    let p_value = if a >= 0.6 {
        libm::exp(1.2937 - 5.709 * a + 0.0186 * a * a)
    } else if a > 0.34 {
        libm::exp(0.9177 - 4.279 * a - 1.38 * a * a)
    } else if a > 0.2 {
        1.0 - libm::exp(-8.318 + 42.796 * a - 59.938 * a * a)
    } else {
        1.0 - libm::exp(-13.436 + 101.14 * a - 223.73 * a * a)
    };
    Some(NormalityTest { anderson_darling, p_value: p_value.clamp(0.0, 1.0), largest_difference })
}

/// Refuses counts from which the likelihood has no maximum (M. J. Silvapulle, *Journal of the Royal
/// Statistical Society B* 43, 1981): exceedances and the rest must overlap in intensity.
fn refuse_separated(stripes: &[Stripe]) -> Result<(), FitError> {
    let range = |pick: fn(&Stripe) -> u64| {
        let levels = stripes.iter().filter(|stripe| pick(stripe) > 0).map(|stripe| stripe.level);
        levels.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), l| (low.min(l), high.max(l)))
    };
    let runs: u64 = stripes.iter().map(|stripe| stripe.runs).sum();
    let (first_beyond, last_beyond) = range(|stripe| stripe.exceeded);
    let (first_within, last_within) = range(|stripe| stripe.runs - stripe.exceeded);
    if first_beyond > last_beyond {
        return Err(FitError::NoneExceeds { runs, highest: last_within });
    }
    if first_within > last_within {
        return Err(FitError::AllExceed { runs, lowest: first_beyond });
    }
    let all = [first_beyond, last_beyond, first_within, last_within];
    if all.iter().all(|level| *level == all[0]) {
        return Err(FitError::OneLevel { level: all[0] });
    }
    if first_beyond >= last_within {
        return Err(FitError::Separated { below: last_within, above: first_beyond });
    }
    if first_within >= last_beyond {
        return Err(FitError::Falls);
    }
    Ok(())
}

fn positive(quantity: &'static str, found: f64) -> Result<f64, FitError> {
    if found.is_finite() && found > 0.0 {
        return Ok(found);
    }
    Err(FitError::OutOfRange { quantity, expected: "a finite value > 0", found })
}
