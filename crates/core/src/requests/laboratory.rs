//! What is asked of tests of a laboratory.

use super::fields::{Request, quantity, wrong};
use super::kinds::Kind;
use crate::error::ChoiceError;
use crate::laboratory::compare::Within;
use crate::laboratory::cyclic::KineticLaw;
use crate::laboratory::identify::{
    CyclicRequest, FreeVibrationRequest, Identified, IdentifyError, ModelText, ShakingTableRequest,
    block_text, cyclic, free_vibration, shaking_table,
};
use crate::laboratory::measured::Measured;
use crate::response::Method;
use crate::study::engine::Engine;
use crate::units::Dimension;

/// What a cyclic test need not have.
const PARTS: [&str; 2] = ["spring", "damper"];

/// What is asked of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparing {
    /// Bounds to keep.
    pub within: Vec<Within>,
    /// The method, where it is not that of the model.
    pub method: Option<Method>,
}

impl Request {
    /// What is said of the columns of a measured file: `QUANTITY=COLUMN`, or a mapping file.
    #[must_use]
    pub fn mapping(&self) -> Vec<String> {
        self.all("mapping").map(str::to_owned).collect()
    }

    /// What is asked of a comparison.
    ///
    /// # Errors
    /// [`ChoiceError`] for a bound that is none.
    pub fn comparing(&self) -> Result<Comparing, ChoiceError> {
        let within = self.all("within").map(Within::parse).collect::<Result<_, _>>()?;
        Ok(Comparing { within, method: self.method() })
    }

    /// Identifies parameters from measured files, of which all but cyclic tests are one; a model takes what is
    /// found.
    ///
    /// # Errors
    /// [`IdentifyError`], a choice by the name of its field.
    pub fn identify(
        &self,
        model: Option<ModelText<'_>>,
        measured: &[Measured],
        engine: &Engine<'_>,
    ) -> Result<Identified, IdentifyError> {
        let none = || wrong("measured", "a measured file", "none");
        let first = measured.first().ok_or_else(none)?;
        match self.kind() {
            Kind::Cyclic => self.cyclic(model, measured),
            Kind::FreeVibration => {
                let [start_s, end_s] = ["start", "end"].map(|n| self.quantity(n, Dimension::Time));
                let span_s =
                    [start_s?.unwrap_or(f64::NEG_INFINITY), end_s?.unwrap_or(f64::INFINITY)];
                let channel = self.given("channel");
                free_vibration(&FreeVibrationRequest { model, channel, span_s }, first)
            }
            Kind::ShakingTable => {
                let (fit, using) = (self.listed("fit"), self.listed("using"));
                if fit.is_empty() {
                    return Err(wrong("fit", "keys of the model, such as slider.spring", "").into());
                }
                let model =
                    model.ok_or_else(|| wrong("model", "a model whose keys are fitted", ""))?;
                let seed = self.seed()?;
                let instruments = self.listed("instrument");
                let request = ShakingTableRequest {
                    model,
                    fit: &fit,
                    using: &using,
                    instruments: &instruments,
                    seed,
                };
                shaking_table(&request, first, engine)
            }
            kind => {
                Err(wrong("kind", "cyclic, free-vibration or shaking-table", kind.name()).into())
            }
        }
    }

    fn cyclic(
        &self,
        model: Option<ModelText<'_>>,
        measured: &[Measured],
    ) -> Result<Identified, IdentifyError> {
        self.quantity("mass", Dimension::Mass)?;
        if self.given("mass").is_some() && model.is_some() {
            return Err(wrong("mass", "a mass or a model", "both").into());
        }
        let without = self.listed("without");
        if let Some(part) = without.iter().find(|part| !PARTS.contains(part)) {
            return Err(wrong("without", "spring or damper", part).into());
        }
        let block = self.given("mass").map(block_text);
        let of_mass = block.as_ref().map(|text| ModelText { name: "mass", text, set: &[] });
        let law = KineticLaw::ALL.into_iter().find(|law| law.name() == self.one("law"));
        let force = |text: &str| quantity("normal-force", text, Dimension::Force);
        let normal_forces_n = self.listed("normal-force").into_iter().map(force);
        let request = CyclicRequest {
            model: model.or(of_mass),
            normal_forces_n: &normal_forces_n.collect::<Result<Vec<f64>, _>>()?,
            area_m2: self.quantity("area", Dimension::Area)?,
            reference_pa: self.quantity("reference-pressure", Dimension::Pressure)?,
            slack_m: self.quantity("slack", Dimension::Length)?,
            spring: !without.contains(&"spring"),
            damper: !without.contains(&"damper"),
            law: law.unwrap_or(KineticLaw::Coulomb),
        };
        cyclic(&request, measured)
    }
}
