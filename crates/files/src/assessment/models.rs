//! The models of a grid of values, and their runs.

use slipstick::error::InputError;
use slipstick::input::{MotionSource, Override, Parts, Variation};
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::response::Demands;
use slipstick::solver;
use slipstick::study::{Column, demand_columns, demand_values};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use super::axis::Grid;
use super::suite::Suite;
use super::{AssessmentError, refuse, threads};

/// A model text and the paths of it that are varied.
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
const ISOLATOR_PERIOD: &str = "isolator.period";

/// Most runs of one analysis over a suite.
const MOST_RUNS: usize = 100_000_000;

/// A path that takes a time > 0.
const PERIOD_LIKE: &str = "frame.period";

/// The path of `--friction`, and the one that follows it.
const KINETIC: &str = "slider.kinetic_friction";
const STATIC: &str = "slider.static_friction";

impl Models {
    /// Reads a model text with keys set, whose paths of the grid take its values.
    ///
    /// Options are those of [`Grid::parse`], as `(option, PATH=VALUES)`. With `coupled_friction` the
    /// static friction follows the kinetic one in the model's own ratio.
    ///
    /// # Errors
    /// [`AssessmentError`] for a model or an option that cannot be understood.
    pub fn new(
        name: &str,
        text: &str,
        set: &[Override],
        options: &[(&str, String)],
        coupled_friction: bool,
    ) -> Result<Self, AssessmentError> {
        let mut shown_as = options.to_vec();
        let mut all = options.to_vec();
        let mut periods = Vec::new();
        for (i, (_, given)) in options.iter().enumerate() {
            if let Some((path, values)) = given.split_once('=')
                && path.trim() == ISOLATOR_PERIOD
            {
                // Read as another time; of the model it sets the radius.
                shown_as[i].1 = format!("{PERIOD_LIKE}={values}");
                all[i].1 = "slider.radius=1 m".to_owned();
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
            let base = slipstick::input::parse(name, text, set)?;
            let number = |path| base.value(path).filter(|value: &f64| *value > 0.0);
            let [Some(kinetic_value), Some(static_value)] = [number(KINETIC), number(STATIC)]
            else {
                let expected = "a model whose two friction coefficients are one number each, > 0";
                return Err(refuse("--friction", expected, "directions or 0"));
            };
            // The value set here is replaced in every model.
            all.push(("--friction", format!("{STATIC}={static_value:?}")));
            follows.push((options.len(), kinetic, static_value / kinetic_value));
        }
        let variation = Variation::with(name, text, set, Grid::parse(&all)?.varied())?;
        let gravity_m_per_s2 =
            variation.number("analysis.gravity").unwrap_or(STANDARD_GRAVITY_M_PER_S2);
        Ok(Self { variation, grid: shown, follows, periods, gravity_m_per_s2 })
    }

    /// The grid, without what follows another path.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Number of storeys.
    #[must_use]
    pub fn storeys(&self) -> usize {
        self.variation.storeys()
    }

    /// The model with these values at the paths of the grid, in SI.
    ///
    /// # Errors
    /// [`InputError`], the one that `slipstick run` gives for the same values.
    pub fn parts(&self, values: &[f64]) -> Result<Parts, InputError> {
        let mut all = values.to_vec();
        for &i in &self.periods {
            let rate = all[i] / core::f64::consts::TAU;
            all[i] = self.gravity_m_per_s2 * rate * rate;
        }
        for &(at, other, ratio) in &self.follows {
            debug_assert_eq!(at, all.len());
            // A ratio of 1 stays one: x · 1 is x.
            all.push(values[other] * ratio);
        }
        self.variation.clone().parts(&all)
    }

    /// The models of the grid, in its order; a message where the values make none.
    ///
    /// # Errors
    /// [`AssessmentError::Option`] where they are more than can be run.
    pub fn all(&self, runs_each: usize) -> Result<Vec<Result<Parts, String>>, AssessmentError> {
        let runs = self.grid.len().saturating_mul(runs_each.max(1));
        if runs > MOST_RUNS {
            let found = format!("{} combinations × {runs_each} runs", self.grid.len());
            return Err(refuse("--vary", format!("at most {MOST_RUNS} runs"), found));
        }
        let parts = |i: usize| {
            let values = self.grid.values(i);
            self.parts(&values).map_err(|error| InputError::to_string(&error))
        };
        Ok(threads::map(self.grid.len(), parts))
    }

    /// The columns of demands of these models.
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        demand_columns(self.storeys())
    }

    /// The number of the column with this key.
    ///
    /// # Errors
    /// [`AssessmentError::Option`] of `--demand`, with the nearest key.
    pub fn column(&self, key: &str) -> Result<usize, AssessmentError> {
        let columns = self.columns();
        columns.iter().position(|column| column.name == key).ok_or_else(|| {
            let names = columns.iter().map(|column| column.name.as_str());
            AssessmentError::Option {
                option: "--demand".to_owned(),
                expected: "the key of a demand, such as peak_sliding_displacement_m".to_owned(),
                found: format!("{key:?}"),
                nearest: slipstick::error::similar(key, names),
            }
        })
    }

    /// The demand to use where none is asked for: the roof's acceleration, or the block's.
    #[must_use]
    pub fn roof_acceleration(&self) -> String {
        match self.storeys() {
            0 => "block.peak_acceleration_m_per_s2".to_owned(),
            n => format!("storey{n}_peak_acceleration_m_per_s2"),
        }
    }
}

/// One run: demands in the order of [`demand_columns`], or why there are none.
pub(super) fn demands(model: &Model, motion: &GroundMotion) -> Result<Vec<f64>, String> {
    match solver::exact_demands(model, motion) {
        Ok(response) => Ok(demand_values(&response.demands)),
        Err(error) => Err(error.to_string()),
    }
}

/// The roof's peak total acceleration, or the block's, in m/s².
pub(super) fn roof_acceleration(demands: &Demands) -> f64 {
    demands
        .storeys
        .last()
        .map_or(demands.peak_block_acceleration_m_per_s2, |s| s.peak_acceleration_m_per_s2)
}

/// The motion of a run: a record of the suite with the model's tail, or the model's own.
pub(super) fn motion_of(
    suite: &Suite,
    record: usize,
    factor: f64,
    parts: &Parts,
) -> Result<GroundMotion, String> {
    let made = match (&parts.motion, suite.made) {
        (Some(MotionSource::Sine(sine)), true) => sine.motion(),
        (Some(MotionSource::Sweep(sweep)), true) => sweep.motion(),
        (Some(MotionSource::Pulse(pulse)), true) => pulse.motion(),
        _ => return suite.motion(record, factor, parts.tail_s).map_err(|error| error.to_string()),
    };
    let with_tail = made.and_then(|motion| {
        let motion = if factor == 1.0 { motion } else { motion.scaled(factor)? };
        if parts.tail_s == 0.0 { Ok(motion) } else { motion.with_tail(parts.tail_s) }
    });
    with_tail.map_err(|error| error.to_string())
}
