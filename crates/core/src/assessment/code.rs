//! What a code asks beside the model, as people write it: property modification factors and the plan of the
//! building (ASCE/SEI 7, chapter 17); and what codes require of a model and its runs, judged row by row.

mod formula;
mod judgement;
mod quantities;
mod rules;

pub use judgement::{
    Compared, FoundValue, JudgedRule, Judgement, LevelForces, Side, judge, verdict,
};
pub use quantities::Judged;
pub(crate) use quantities::bounds_of;
pub use rules::{CODES, Code, CodeUnit};

use super::lateral::LEAST_TOTAL;
use crate::error::ChoiceError;
use crate::input::FrictionBounds;
use crate::units::{Dimension, parse_quantity};

/// The part of the factor for aging that is taken: not all extremes come together (17.2.8.4).
const AGING_SHARE: f64 = 0.75;

/// Property modification factors on friction, least and largest of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PropertyFactors {
    /// `λ_test`: of heating, speed and cycling, from prototype tests.
    pub test: [f64; 2],
    /// `λ_ae`: of aging and environment.
    pub aging: [f64; 2],
    /// `λ_spec`: of the tolerance that the specification allows.
    pub specification: [f64; 2],
    /// What the products are taken to at least: the least at most the first, the largest at least the second.
    pub limits: Option<[f64; 2]>,
}

impl PropertyFactors {
    /// The limits on the products of section 17.2.8.4: `λ_min` is at most 0.60, `λ_max` at least 1.8.
    pub const CODE_LIMITS: [f64; 2] = [0.6, 1.8];

    /// The factors as people write them: `test = 0.9..1.2, aging = 1..1.3, specification = 0.85..1.15`; those
    /// left out are 1. With `limits = 0.6..1.8` the products reach these limits at least.
    ///
    /// # Errors
    /// [`ChoiceError`] for `property-factors` unless each has a least value of at most 1, above 0, and a
    /// largest of at least 1.
    pub fn parse(text: &str) -> Result<Self, ChoiceError> {
        let expected = "factors from below 1 to above it: test = 0.9..1.2, aging = 1..1.3, \
                        specification = 0.85..1.15, limits = 0.6..1.8";
        let wrong = || refused("property-factors", expected, text);
        let given = named(text, ["test", "aging", "specification", "limits"]).ok_or_else(wrong)?;
        let limited = given[3].is_some();
        let range = |text: Option<&str>| -> Option<[f64; 2]> {
            let Some(text) = text else { return Some([1.0; 2]) };
            let (from, to) = text.split_once("..")?;
            let [least, most] = [from.trim().parse::<f64>().ok()?, to.trim().parse::<f64>().ok()?];
            (0.0 < least && least <= 1.0 && 1.0 <= most && most.is_finite())
                .then_some([least, most])
        };
        let [Some(test), Some(aging), Some(specification), Some(limits)] = given.map(range) else {
            return Err(wrong());
        };
        Ok(Self { test, aging, specification, limits: limited.then_some(limits) })
    }

    /// `λ = (1 + 0.75 (λ_ae − 1)) λ_test λ_spec`, of the least factors and of the largest
    /// (equations 17.2-1 and 17.2-2).
    #[must_use]
    pub fn products(&self) -> [f64; 2] {
        [0, 1].map(|i| {
            (1.0 + AGING_SHARE * (self.aging[i] - 1.0)) * self.test[i] * self.specification[i]
        })
    }

    /// The products, at least as far apart as their limits where these are given.
    #[must_use]
    pub fn bounds(&self) -> FrictionBounds {
        let [lower, upper] = self.products();
        let [least, most] = self.limits.unwrap_or([lower, upper]);
        FrictionBounds { lower: lower.min(least), upper: upper.max(most) }
    }
}

/// The plan of an isolated building, for what eccentricity adds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// `e`: actual eccentricity and 5 % of the dimension across the force, in m.
    pub eccentricity_m: f64,
    /// `y`: from the centre of rigidity to the element of interest, across the force, in m.
    pub distance_m: f64,
    /// `b` and `d`: the shortest and the longest dimension of the plan, in m.
    pub sides_m: [f64; 2],
    /// `P_T`: translational over torsional period of the isolation, at least 1.
    pub period_ratio: f64,
}

impl Plan {
    /// The plan as people write it: `e = 1.2 m, y = 9 m, b = 18 m, d = 24 m, pt = 1.1`; `pt` is 1 where it is
    /// left out.
    ///
    /// # Errors
    /// [`ChoiceError`] for `eccentricity` where a length is missing or out of range.
    pub fn parse(text: &str) -> Result<Self, ChoiceError> {
        let expected = "four lengths and perhaps a ratio of at least 1: e = 1.2 m, y = 9 m, b = 18 m, \
                        d = 24 m, pt = 1.1";
        let wrong = || refused("eccentricity", expected, text);
        let [e, y, b, d, pt] = named(text, ["e", "y", "b", "d", "pt"]).ok_or_else(wrong)?;
        let length = |text: Option<&str>| -> Option<f64> {
            let length_m = parse_quantity(text?, Dimension::Length).ok()?;
            (length_m.is_finite() && length_m >= 0.0).then_some(length_m)
        };
        let ratio = pt.map_or(Some(1.0), |text| text.parse().ok());
        let ratio = ratio.filter(|ratio: &f64| ratio.is_finite() && *ratio >= 1.0);
        match (length(e), length(y), length(b), length(d), ratio) {
            (Some(eccentricity_m), Some(distance_m), Some(b), Some(d), Some(period_ratio))
                if b > 0.0 && d > 0.0 =>
            {
                Ok(Self { eccentricity_m, distance_m, sides_m: [b, d], period_ratio })
            }
            _ => Err(wrong()),
        }
    }

    /// `D_TM/D_M = 1 + (y/P_T²) 12 e/(b² + d²)`, at least 1.15 (equation 17.5-3).
    #[must_use]
    pub fn total_over_displacement(&self) -> f64 {
        let Self { eccentricity_m: e, distance_m: y, sides_m: [b, d], period_ratio } = *self;
        let torsion = y / (period_ratio * period_ratio) * 12.0 * e / (b * b + d * d);
        (1.0 + torsion).max(LEAST_TOTAL)
    }
}

fn refused(what: &str, expected: &str, found: &str) -> ChoiceError {
    let (what, expected) = (what.to_owned(), expected.to_owned());
    ChoiceError { what, expected, found: format!("{found:?}"), nearest: None }
}

/// The values of a text `key = value, …`, in the order of the keys; none for another or a repeated key.
pub fn named<'a, const N: usize>(text: &'a str, keys: [&str; N]) -> Option<[Option<&'a str>; N]> {
    let mut values = [None; N];
    for part in text.split(',') {
        let (key, value) = part.split_once('=')?;
        let place = keys.iter().position(|known| *known == key.trim())?;
        if values[place].replace(value.trim()).is_some() {
            return None;
        }
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: (1 + 0.75 · 0.4) · 1.1 · 1.15 = 1.6445 and (1 − 0.75 · 0.1) · 0.8 · 0.85 = 0.629.
    #[test]
    fn three_quarters_of_aging_are_taken() {
        let text = "aging = 0.9..1.4, test = 0.8..1.1, specification = 0.85..1.15";
        let bounds = PropertyFactors::parse(text).unwrap().bounds();
        assert!((bounds.upper - 1.6445).abs() < 1e-15 && (bounds.lower - 0.629).abs() < 1e-15);
        let alone = PropertyFactors::parse("test=0.9..1.2").unwrap().bounds();
        assert_eq!((alone.lower, alone.upper), (0.9, 1.2));
        let limited = PropertyFactors::parse("test=0.5..1.2, limits=0.6..1.8").unwrap();
        let bounds = limited.bounds();
        assert_eq!((bounds.lower, bounds.upper), (0.5, 1.8));
        assert_eq!(limited.products(), [0.5, 1.2]);
        for wrong in
            ["", "test = 1.1..1.2", "test = 0..1", "tests = 0.9..1", "test = 0.9..1, test = 1..1"]
        {
            let error = PropertyFactors::parse(wrong).unwrap_err().to_string();
            assert!(error.starts_with("property-factors: expected factors"), "{error}");
        }
    }

    /// By hand: 1 + 9/1.21 · 12 · 1.2/(18² + 24²) = 1.119008… is below the least; with e = 2.4 m, 1.238017.
    #[test]
    fn eccentricity_adds_at_least_15_percent() {
        let plan = |e: &str| {
            Plan::parse(&format!("e = {e}, y = 9 m, b = 18 m, d = 24 m, pt = 1.1")).unwrap()
        };
        assert_eq!(plan("1.2 m").total_over_displacement(), 1.15);
        let total = plan("2.4 m").total_over_displacement();
        assert!((total - (1.0 + 9.0 * 12.0 * 2.4 / (1.21 * 900.0))).abs() < 1e-15, "{total}");
        for wrong in
            ["e = 1 m, y = 9 m, b = 18 m", "e = 1 m, y = 9 m, b = 18 m, d = 24 m, pt = 0.9"]
        {
            let error = Plan::parse(wrong).unwrap_err().to_string();
            assert!(error.starts_with("eccentricity: expected four lengths"), "{error}");
        }
    }
}
