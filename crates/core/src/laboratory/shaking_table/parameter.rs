//! What is fitted: keys of a model, each with a range.

use crate::error::{ChoiceError, InputError, cut};
use crate::input::{self, Analysis, Override, dimension_of};
use crate::model::Model;
use crate::units::{Dimension, parse_quantity};

/// A key of the model to be fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its path, such as `slider.kinetic_friction`.
    pub path: String,
    /// Its SI unit, empty for a ratio.
    pub unit: &'static str,
    /// Least value tried, in SI.
    pub low: f64,
    /// Largest value tried, in SI.
    pub high: f64,
    /// Whether the ends of the range are those of nature (a damper of 0, kinetic friction as large
    /// as static), so that an interval may end there.
    pub natural: [bool; 2],
}

impl Parameter {
    /// Reads `PATH` or `PATH=LEAST..MOST`, the ends with their units.
    ///
    /// Without a range: friction, spring and masses from a fifth of the model's value to five
    /// times it, frequencies and periods from half to twice, damping ratios 0 to 0.3, the tilt
    /// ± 20 mrad, the asymmetry ± 0.6, a damper of the slider up to critical damping of its spring
    /// (without one, up to 5 s⁻¹ of the mass). Kinetic friction goes up to the static one where
    /// that is not fitted, static friction down to the kinetic one.
    ///
    /// # Errors
    /// [`ChoiceError`] for a path that no model has, a range that is none, or a value of 0
    /// without a range.
    pub fn parse(text: &str, analysis: &Analysis, all: &[&str]) -> Result<Self, ChoiceError> {
        let (path, range) = match text.split_once('=') {
            Some((path, range)) => (path.trim(), Some(range)),
            None => (text.trim(), None),
        };
        let what = || format!("fit {}", cut(text));
        let dimension = dimension_of(path).map_err(|error| {
            let InputError { expected, found, nearest, .. } = error;
            ChoiceError { what: what(), expected, found, nearest }
        })?;
        let fault = |expected: &str, found: &str| ChoiceError {
            what: what(),
            expected: expected.to_owned(),
            found: format!("\"{}\"", cut(found)),
            nearest: None,
        };
        let [low, high] = match range {
            Some(range) => {
                let (low, high) =
                    range.split_once("..").ok_or_else(|| fault("PATH=LEAST..MOST", range))?;
                [
                    end(low, dimension).map_err(|e| fault(&e, low))?,
                    end(high, dimension).map_err(|e| fault(&e, high))?,
                ]
            }
            None => default_range(path, analysis).ok_or_else(|| {
                let expected = format!(
                    "a range, since the model gives no value other than 0: {path}=LEAST..MOST"
                );
                fault(&expected, path)
            })?,
        };
        if !(low < high) {
            return Err(fault("LEAST below MOST", range.unwrap_or("")));
        }
        let mut this = Self {
            path: path.to_owned(),
            unit: dimension.map_or("", Dimension::si_unit),
            low,
            high,
            natural: [low == 0.0, false],
        };
        this.within_friction(analysis, all);
        Ok(this)
    }

    /// Kinetic friction is at most the static one.
    fn within_friction(&mut self, analysis: &Analysis, all: &[&str]) {
        let of =
            |path: &str| all.iter().any(|text| text.split('=').next().unwrap_or("").trim() == path);
        let other = |from: &str, to: &str| {
            let path = self.path.replace(from, to);
            if path == self.path || of(&path) { None } else { written(analysis, &path) }
        };
        if let Some(limit) = other("kinetic_friction", "static_friction").filter(|l| *l > self.low)
            && limit <= self.high
        {
            (self.high, self.natural[1]) = (limit, true);
        }
        if let Some(limit) = other("static_friction", "kinetic_friction").filter(|l| *l < self.high)
            && limit >= self.low
        {
            (self.low, self.natural[0]) = (limit, true);
        }
        if self.path.starts_with("slider.static_friction") {
            self.natural[0] = true;
        }
    }
}

fn end(text: &str, dimension: Option<Dimension>) -> Result<f64, String> {
    let text = text.trim();
    match dimension {
        Some(dimension) => parse_quantity(text, dimension).map_err(|error| error.expected),
        None => {
            let number = text.parse::<f64>().ok().filter(|value| value.is_finite());
            number.ok_or_else(|| "a number".to_owned())
        }
    }
}

/// The value at a path; friction for both ways stands also for each of them, and that towards +x
/// for both.
fn written(analysis: &Analysis, path: &str) -> Option<f64> {
    let parent = path.strip_suffix(".positive").or(path.strip_suffix(".negative"));
    let one_way = || analysis.value(&format!("{path}.positive"));
    analysis.value(path).or_else(|| analysis.value(parent?)).or_else(one_way)
}

/// The range of a key that was given none.
fn default_range(path: &str, analysis: &Analysis) -> Option<[f64; 2]> {
    let name = path.rsplit('.').next().unwrap_or(path);
    let model = &analysis.model;
    let value = written(analysis, path).filter(|value| *value > 0.0);
    let times = |least: f64, most: f64| value.map(|value| [least * value, most * value]);
    match name {
        "tilt" => Some([-0.02, 0.02]),
        "asymmetry" => Some([-0.6, 0.6]),
        "damping_ratio" => Some([0.0, 0.3]),
        "frequency" | "period" => times(0.5, 2.0),
        "damper" if path == "slider.damper" => {
            let mass_kg = model.total_mass_kg();
            let spring = model.slider_stiffness_n_per_m();
            let most = if spring > 0.0 { 2.0 * (spring * mass_kg).sqrt() } else { 5.0 * mass_kg };
            Some([0.0, most])
        }
        "damper" => times(0.0, 10.0),
        _ => times(0.2, 5.0),
    }
}

/// Makes models from a model file and the values of some of its keys.
#[derive(Clone, Debug)]
pub struct Builder<'a> {
    name: &'a str,
    text: &'a str,
    set: Vec<Override>,
    paths: Vec<String>,
}

impl<'a> Builder<'a> {
    /// Of a model's text with keys set from outside, and the paths to be varied.
    #[must_use]
    pub fn new(name: &'a str, text: &'a str, set: &[Override], parameters: &[Parameter]) -> Self {
        let paths = parameters.iter().map(|parameter| parameter.path.clone()).collect();
        Self { name, text, set: set.to_vec(), paths }
    }

    /// The analysis with some values. Where static friction would be below the kinetic one of the
    /// same path, it is as large.
    ///
    /// # Errors
    /// [`InputError`] where they make no model.
    pub fn analysis(&self, values: &[f64]) -> Result<Analysis, InputError> {
        let mut set = self.set.clone();
        for (path, value) in self.paths.iter().zip(values) {
            let kinetic = path.replace("slider.static_friction", "slider.kinetic_friction");
            let least = self.paths.iter().zip(values).find(|(other, _)| **other == kinetic);
            let least = least.filter(|_| kinetic != *path).map_or(f64::NEG_INFINITY, |(_, v)| *v);
            set.push(Override::number(path, value.max(least))?);
        }
        input::parse(self.name, self.text, &set)
    }

    /// The model with some values, where they make one.
    #[must_use]
    pub fn model(&self, values: &[f64]) -> Option<Model> {
        self.analysis(values).ok().map(|analysis| analysis.model)
    }
}
