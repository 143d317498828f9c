//! The mock-ups and records of the paper, and models and motions made from them.

use crate::PaperError;
use crate::claims::{self, Facts};
use slipstick::error::{ModelError, MotionError};
use slipstick::input::{self, MotionSource, Scale};
use slipstick::model::{Block, Frame, InitialState, Model, Slider};
use slipstick::motion::{GroundMotion, Sine};
use slipstick::record::{self, Options};
use slipstick::response::Demands;
use slipstick::slider::Friction;
use slipstick::solver;

/// Friction that holds any mock-up on any table: the fixed base.
const HOLDS: f64 = 1e3;

/// Frequency of the oscillator of figure 11, in Hz, which section 6 rounds to 2.65.
pub(crate) const FIGURE_11_HZ: f64 = 2.687;

/// How the table of an experiment moves, without its tail.
#[derive(Clone, Debug, PartialEq)]
pub enum Shake {
    /// A sine, sampled anew for every step.
    Sine(Sine),
    /// A record, already scaled.
    Record(GroundMotion),
}

/// One of the paper's tests as far as the paper describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// Name of its model file without the ending.
    pub id: String,
    /// What the model file calls it.
    pub name: String,
    /// The mock-up.
    pub model: Model,
    /// The table.
    pub shake: Shake,
    /// Free vibration after the motion, in s.
    pub tail_s: f64,
}

/// All mock-ups and records, and what the paper claims.
#[derive(Clone, Debug, PartialEq)]
pub struct Library {
    experiments: Vec<Experiment>,
    records: Vec<(String, GroundMotion)>,
    claims: Vec<Facts>,
}

impl Library {
    /// Reads models and records.
    ///
    /// `models` are pairs of a name and the text of a model file; `records` pairs of a file name
    /// and its bytes, one value a line in g, 0.01 s apart, as those that the examples run. A model
    /// names its record by a path that ends in the record's name.
    ///
    /// # Errors
    /// [`PaperError`] for the first text that cannot be read.
    pub fn read(models: &[(&str, &str)], records: &[(&str, &[u8])]) -> Result<Self, PaperError> {
        let options =
            Options { units: record::Units::parse("g"), dt_s: Some(0.01), ..Options::default() };
        let mut motions = Vec::new();
        for (name, bytes) in records {
            let record = record::read(name, bytes, &options)?;
            let motion = record.channels.first().and_then(|channel| channel.motion());
            motions.push(((*name).to_owned(), motion.ok_or_else(|| missing(name))??));
        }
        let mut experiments = Vec::new();
        for (id, text) in models {
            let analysis = input::parse(id, text, &[])?;
            let shake = match analysis.required_motion()? {
                MotionSource::Sine(sine) => Shake::Sine(*sine),
                MotionSource::Record(source) => {
                    let named = |(name, _): &&(String, GroundMotion)| source.path.ends_with(name);
                    let found = motions.iter().find(named);
                    let (_, motion) = found.ok_or_else(|| missing(&source.path))?;
                    Shake::Record(match source.scale {
                        Scale::Factor(factor) => motion.scaled(factor)?,
                        Scale::Peak(peak) => motion.scaled_to_peak(peak)?,
                    })
                }
                _ => return Err(missing(&format!("a sine or a record in {id}"))),
            };
            let name = analysis.name.clone().unwrap_or_else(|| (*id).to_owned());
            let tail_s = analysis.tail_s;
            let id = (*id).to_owned();
            experiments.push(Experiment { id, name, model: analysis.model, shake, tail_s });
        }
        Ok(Self { experiments, records: motions, claims: claims::facts()? })
    }

    /// All experiments, in the order given.
    #[must_use]
    pub fn experiments(&self) -> &[Experiment] {
        &self.experiments
    }

    /// The experiment of a name.
    pub(crate) fn experiment(&self, id: &str) -> Result<&Experiment, PaperError> {
        self.experiments.iter().find(|e| e.id == id).ok_or_else(|| missing(id))
    }

    /// The experiment of a name as a figure shows it: that of figure 11 with its own frequency.
    pub(crate) fn drawn(&self, id: &str) -> Result<Experiment, PaperError> {
        let mut experiment = self.experiment(id)?.clone();
        if id == "section6-201kg-2_65hz-sine" {
            experiment.model = with_frequency(&experiment.model, FIGURE_11_HZ)?;
            experiment.name = experiment.name.replace("2.65 Hz", "2.687 Hz");
        }
        Ok(experiment)
    }

    /// All records as they stand, with their names, in the order given.
    #[must_use]
    pub fn records(&self) -> &[(String, GroundMotion)] {
        &self.records
    }

    /// The same library with more records, for the table of sliding against friction.
    #[must_use]
    pub fn with_records(mut self, records: Vec<(String, GroundMotion)>) -> Self {
        self.records.extend(records);
        self
    }

    /// The record of a name.
    pub(crate) fn record(&self, name: &str) -> Result<&GroundMotion, PaperError> {
        let found = self.records.iter().find(|(n, _)| n == name);
        found.map(|(_, motion)| motion).ok_or_else(|| missing(name))
    }

    /// The fixed facts of all claims.
    pub(crate) fn claims(&self) -> &[Facts] {
        &self.claims
    }

    /// The facts of one claim.
    pub(crate) fn claim(&self, id: &str) -> Result<&Facts, PaperError> {
        self.claims.iter().find(|facts| facts.id == id).ok_or_else(|| missing(id))
    }

    /// The number that the paper prints for a claim.
    pub(crate) fn printed(&self, id: &str) -> Result<f64, PaperError> {
        self.claim(id)?.paper.ok_or_else(|| missing(id))
    }

    /// The mock-ups with an oscillator (section 6), as their sine experiments.
    pub(crate) fn oscillators(&self) -> impl Iterator<Item = &Experiment> {
        let sine = |e: &&Experiment| matches!(e.shake, Shake::Sine(_));
        self.experiments.iter().filter(|e| e.model.storeys() == 1).filter(sine)
    }
}

fn missing(what: &str) -> PaperError {
    PaperError::Missing { what: what.to_owned() }
}

impl Experiment {
    /// The motion as it stands, with its tail.
    pub(crate) fn motion(&self) -> Result<GroundMotion, MotionError> {
        match &self.shake {
            Shake::Sine(sine) => sine.motion(),
            Shake::Record(motion) => Ok(motion.clone()),
        }?
        .with_tail(self.tail_s)
    }

    /// The motion at another step, with its tail: a sine sampled anew, a record subdivided by
    /// straight lines or thinned.
    pub(crate) fn motion_at(&self, dt_s: f64) -> Result<GroundMotion, MotionError> {
        match &self.shake {
            Shake::Sine(sine) => Sine { dt_s, ..*sine }.motion(),
            Shake::Record(motion) => resampled(motion, dt_s),
        }?
        .with_tail(self.tail_s)
    }

    /// The sine of a sine experiment.
    pub(crate) fn sine(&self) -> Result<Sine, PaperError> {
        match &self.shake {
            Shake::Sine(sine) => Ok(*sine),
            Shake::Record(_) => Err(missing(&format!("a sine in {}", self.id))),
        }
    }

    /// Whether the table follows a record.
    pub(crate) fn is_record(&self) -> bool {
        matches!(self.shake, Shake::Record(_))
    }

    /// The same test of another mock-up.
    pub(crate) fn with_model(&self, model: Model) -> Self {
        Self { model, ..self.clone() }
    }

    /// Exact peaks and counts.
    pub(crate) fn demands(&self) -> Result<Demands, PaperError> {
        Ok(solver::exact_demands(&self.model, &self.motion()?)?.demands)
    }
}

/// An evenly spaced motion at a step that divides its own or is a multiple of it.
fn resampled(motion: &GroundMotion, dt_s: f64) -> Result<GroundMotion, MotionError> {
    let a = motion.horizontal_m_per_s2();
    let own_s = motion.dt_s().unwrap_or(dt_s);
    if own_s >= dt_s {
        let parts = libm::round(own_s / dt_s) as usize;
        let mut values = Vec::with_capacity(parts * a.len());
        for pair in a.windows(2) {
            let part = |j: usize| pair[0] + (pair[1] - pair[0]) * (j as f64 / parts as f64);
            values.extend((0..parts).map(part));
        }
        values.extend(a.last());
        GroundMotion::evenly_spaced(own_s / parts as f64, values, None)
    } else {
        let stride = libm::round(dt_s / own_s) as usize;
        let values = a.iter().step_by(stride).copied().collect();
        GroundMotion::evenly_spaced(own_s * stride as f64, values, None)
    }
}

/// The same mock-up with another block, bearing or structure.
fn changed(
    model: &Model,
    change: impl FnOnce(&mut Block, &mut Slider, &mut Frame),
) -> Result<Model, ModelError> {
    let (mut block, mut slider, mut frame) =
        (*model.block(), model.slider().clone(), model.frame().clone());
    change(&mut block, &mut slider, &mut frame);
    Model::new(block, slider, frame, model.gravity_m_per_s2(), model.initial().clone())
}

/// The same mock-up with other coefficients of friction, equal in both directions.
pub(crate) fn with_friction(
    model: &Model,
    static_friction: f64,
    kinetic_friction: f64,
) -> Result<Model, ModelError> {
    Ok(model.with_friction(coulomb([static_friction; 2], [kinetic_friction; 2])?))
}

/// The same mock-up with friction times `1 + α` towards +x and `1 − α` towards −x.
pub(crate) fn with_asymmetry(model: &Model, alpha: f64) -> Result<Model, ModelError> {
    let factors = [1.0 + alpha, 1.0 - alpha];
    let of = |mu: [f64; 2]| [mu[0] * factors[0], mu[1] * factors[1]];
    Ok(model.with_friction(coulomb(of(model.static_friction()), of(model.kinetic_friction()))?))
}

fn coulomb(statics: [f64; 2], kinetics: [f64; 2]) -> Result<Friction, ModelError> {
    Friction::by_direction(statics, kinetics)
}

/// The same mock-up on a surface that rises towards +x.
pub(crate) fn with_tilt(model: &Model, tilt_rad: f64) -> Result<Model, ModelError> {
    changed(model, |_, slider, _| slider.tilt_rad = tilt_rad)
}

/// The same mock-up held by the table.
pub(crate) fn fixed(model: &Model) -> Result<Model, ModelError> {
    with_friction(model, HOLDS, HOLDS)
}

/// The same mock-up with its one storey tuned to a fixed-base frequency in Hz.
pub(crate) fn with_frequency(model: &Model, frequency_hz: f64) -> Result<Model, ModelError> {
    let rate = core::f64::consts::TAU * frequency_hz;
    changed(model, |_, _, frame| {
        frame.stiffnesses_n_per_m = frame.masses_kg.iter().map(|m| m * rate * rate).collect();
    })
}

/// The same mock-up with a block of another mass in kg.
pub(crate) fn with_block_mass(model: &Model, mass_kg: f64) -> Result<Model, ModelError> {
    changed(model, |block, _, _| block.mass_kg = mass_kg)
}

/// The same mock-up from another state.
pub(crate) fn with_initial(model: &Model, initial: InitialState) -> Result<Model, ModelError> {
    let gravity = model.gravity_m_per_s2();
    Model::new(*model.block(), model.slider().clone(), model.frame().clone(), gravity, initial)
}

/// Peak storey acceleration in m/s²; 0 without a storey.
pub(crate) fn storey_peak(demands: &Demands) -> f64 {
    demands.storeys.first().map_or(0.0, |storey| storey.peak_acceleration_m_per_s2)
}

/// Mass `M2` in kg and fixed-base frequency in Hz of a one-storey mock-up.
pub(crate) fn storey(model: &Model) -> (f64, f64) {
    let frame = model.frame();
    let mass_kg = frame.masses_kg.first().copied().unwrap_or(0.0);
    let stiffness = frame.stiffnesses_n_per_m.first().copied().unwrap_or(0.0);
    (mass_kg, (stiffness / mass_kg).sqrt() / core::f64::consts::TAU)
}

/// Frequency in Hz of the storey on a block that slides without friction,
/// `f2 √(1 + M2/M1)`.
pub(crate) fn free_free_hz(model: &Model) -> f64 {
    let (mass_kg, frequency_hz) = storey(model);
    frequency_hz * (1.0 + mass_kg / model.block().mass_kg).sqrt()
}

/// Damping ratio of a one-storey mock-up; 0 where it is given by dampers.
pub(crate) fn damping_ratio(model: &Model) -> f64 {
    match model.frame().damping {
        slipstick::model::Damping::Ratio(ratio) => ratio,
        slipstick::model::Damping::Dampers(_) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subdivided_and_thinned() {
        let motion =
            GroundMotion::evenly_spaced(0.01, vec![0.0, 1.0, 3.0, 2.0, 0.0], None).unwrap();
        let fine = resampled(&motion, 0.005).unwrap();
        assert_eq!(fine.horizontal_m_per_s2(), [0.0, 0.5, 1.0, 2.0, 3.0, 2.5, 2.0, 1.0, 0.0]);
        assert_eq!(fine.dt_s(), Some(0.005));
        let coarse = resampled(&motion, 0.02).unwrap();
        assert_eq!(
            (coarse.horizontal_m_per_s2(), coarse.dt_s()),
            (&[0.0, 3.0, 0.0][..], Some(0.02))
        );
        assert_eq!(resampled(&motion, 0.01).unwrap(), motion);
    }

    #[test]
    fn file_a_record_that_is_not_there_is_named() {
        let model = "[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0.2\n\
                     kinetic_friction = 0.1\n[motion]\nrecord = \"a/b.txt\"\n";
        let error = Library::read(&[("model", model)], &[]).unwrap_err();
        let expected = "expected a/b.txt among the mock-ups and records of the paper, found none";
        assert_eq!(error.to_string(), expected);
    }
}
