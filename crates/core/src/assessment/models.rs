//! The models of a grid of values.

use super::grid::Grid;
use super::{AssessmentError, ChoiceError, refuse};
use crate::error::{InputError, RunError, similar};
use crate::input::{self, Override, Parts, Variation};
use crate::response::{DemandColumn, DemandShape};
use crate::study::engine::Engine;
use crate::units::STANDARD_GRAVITY_M_PER_S2;

/// A model and the paths of it that are varied.
#[derive(Clone, Debug)]
pub struct Models {
    variation: Variation,
    grid: Grid,
    /// Paths that follow another: static friction keeps its ratio to the kinetic one.
    follows: Vec<(usize, usize, f64)>,
    /// Axes that are isolator periods, of which the model takes the radius.
    periods: Vec<usize>,
    gravity_m_per_s2: f64,
}

/// The period `2π √(R/g)` of a block on pendulum sliders of radius `R`: an axis that is no path.
pub const ISOLATOR_PERIOD: &str = "isolator.period";

/// Most runs of one analysis over a suite.
const MOST_RUNS: usize = 100_000_000;

/// The path that an isolator period sets.
const RADIUS: &str = "slider.radius";

/// A path that takes a time > 0.
const PERIOD_LIKE: &str = "frame.period";

/// The path of the kinetic coefficient, and the one that may follow it.
const KINETIC: &str = "slider.kinetic_friction";
const STATIC: &str = "slider.static_friction";

impl Models {
    /// Reads a model text with keys set, whose paths of the grid take its values.
    ///
    /// What is varied is written as [`Grid::parse`] reads it, `(what errors call it, PATH=VALUES)`.
    /// With `coupled_friction` the static friction follows the kinetic one in the model's own ratio.
    ///
    /// # Errors
    /// [`AssessmentError`] for a model or values that cannot be understood.
    pub fn new(
        name: &str,
        text: &str,
        set: &[Override],
        varied: &[(&str, String)],
        coupled_friction: bool,
    ) -> Result<Self, AssessmentError> {
        let mut shown_as = varied.to_vec();
        let mut all = varied.to_vec();
        let mut periods = Vec::new();
        for (i, (_, given)) in varied.iter().enumerate() {
            if let Some((path, values)) = given.split_once('=')
                && path.trim() == ISOLATOR_PERIOD
            {
                // Read as another time; of the model it sets the radius.
                shown_as[i].1 = format!("{PERIOD_LIKE}={values}");
                all[i].1 = format!("{RADIUS}=1 m");
                periods.push(i);
            }
        }
        let mut shown = Grid::parse(&shown_as)?;
        for &i in &periods {
            shown.rename(i, ISOLATOR_PERIOD);
        }
        let mut follows = Vec::new();
        let kinetic = shown.axes().iter().position(|axis| axis.path == KINETIC);
        if coupled_friction && let Some(kinetic) = kinetic {
            let base = input::parse(name, text, set)?;
            let number = |path| base.value(path).filter(|value: &f64| *value > 0.0);
            let [Some(kinetic_value), Some(static_value)] = [number(KINETIC), number(STATIC)]
            else {
                let expected = "a model whose two friction coefficients are one number each, > 0";
                return Err(refuse("friction", expected, "directions or 0"));
            };
            // The value set here is replaced in every model.
            all.push(("friction", format!("{STATIC}={static_value:?}")));
            follows.push((varied.len(), kinetic, static_value / kinetic_value));
        }
        let variation = Variation::with(name, text, set, Grid::parse(&all)?.varied())?;
        let gravity_m_per_s2 =
            variation.number("analysis.gravity").unwrap_or(STANDARD_GRAVITY_M_PER_S2);
        Ok(Self { variation, grid: shown, follows, periods, gravity_m_per_s2 })
    }

    /// The same for motions in two horizontal directions.
    #[must_use]
    pub fn in_plane(self) -> Self {
        Self { variation: self.variation.in_plane(), ..self }
    }

    /// The grid, without what follows another path.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// What the models have that demands are asked of.
    #[must_use]
    pub fn shape(&self) -> DemandShape {
        self.variation.shape()
    }

    /// What is varied as the tables `[vary]` and `[sampling]` of a plan; nothing where nothing is.
    #[must_use]
    pub fn plan(&self) -> String {
        let mut text = String::new();
        for (i, axis) in self.grid.axes().iter().enumerate() {
            let of_period = self.periods.contains(&i);
            let (path, unit) =
                if of_period { (RADIUS, "m") } else { (&axis.path[..], &axis.unit[..]) };
            let value = |value: &f64| match (of_period, unit) {
                (true, _) => format!("\"{:?} m\"", self.radius_m(*value)),
                (false, "") => format!("{value:?}"),
                (false, unit) => format!("\"{value:?} {unit}\""),
            };
            let values: Vec<String> = axis.values.iter().map(value).collect();
            text.push_str(&format!("\"{path}\" = {{ values = [{}] }}\n", values.join(", ")));
            let follows = self.follows.iter().filter(|(_, other, _)| *other == i);
            for (.., ratio) in follows {
                let factor = format!("factor_of = \"{path}\", values = [{ratio:?}]");
                text.push_str(&format!("\"{STATIC}\" = {{ {factor} }}\n"));
            }
        }
        match text.as_str() {
            "" => text,
            varied => format!("\n[vary]\n{varied}\n[sampling]\nmethod = \"grid\"\n"),
        }
    }

    /// The radius of a pendulum of a period: `g (T / 2π)²`.
    fn radius_m(&self, period_s: f64) -> f64 {
        let rate = period_s / core::f64::consts::TAU;
        self.gravity_m_per_s2 * rate * rate
    }

    /// The model with these values at the paths of the grid, in SI.
    ///
    /// # Errors
    /// [`InputError`], the one that the model's text gives with the same values.
    pub fn parts(&self, values: &[f64]) -> Result<Parts, InputError> {
        let mut all = values.to_vec();
        for &i in &self.periods {
            all[i] = self.radius_m(all[i]);
        }
        for &(at, other, ratio) in &self.follows {
            debug_assert_eq!(at, all.len());
            // A ratio of 1 stays one: x · 1 is x.
            all.push(values[other] * ratio);
        }
        self.variation.parts(&all)
    }

    /// The models of the grid, in its order; an error where the values make none.
    ///
    /// # Errors
    /// [`AssessmentError::Choice`] where they are more than can be run.
    pub fn all(
        &self,
        runs_each: usize,
        engine: &Engine<'_>,
    ) -> Result<Vec<Result<Parts, RunError>>, AssessmentError> {
        let runs = self.grid.len().saturating_mul(runs_each.max(1));
        if runs > MOST_RUNS {
            let found = format!("{} combinations × {runs_each} runs", self.grid.len());
            return Err(refuse("vary", format!("at most {MOST_RUNS} runs"), found));
        }
        let parts = |i: usize| Ok(self.parts(&self.grid.values(i)).map_err(RunError::from));
        Ok(engine.map(self.grid.len(), parts)?)
    }

    /// The demands of these models, in the order of every run's values.
    #[must_use]
    pub fn columns(&self) -> Vec<DemandColumn> {
        self.shape().columns()
    }

    /// The number of the demand with this name in [`Models::columns`].
    ///
    /// # Errors
    /// [`AssessmentError::Choice`] with the nearest name.
    pub fn column(&self, name: &str) -> Result<usize, AssessmentError> {
        self.shape().find(name).map(|(index, _)| index).ok_or_else(|| {
            let names: Vec<String> = self.columns().iter().map(DemandColumn::name).collect();
            AssessmentError::Choice(ChoiceError {
                what: "demand".to_owned(),
                expected: "the key of a demand, such as peak_sliding_displacement_m".to_owned(),
                found: format!("{name:?}"),
                nearest: similar(name, names.iter().map(String::as_str)).or_else(|| {
                    // `drift` is in `storey1_peak_drift_m`.
                    let has = names.iter().filter(|known| name.len() > 2 && known.contains(name));
                    has.min_by_key(|known| known.len()).cloned()
                }),
            })
        })
    }

    /// The demand to use where none is asked for: the roof's acceleration, or the block's.
    #[must_use]
    pub fn roof_acceleration(&self) -> String {
        self.shape().roof_acceleration().name()
    }
}
