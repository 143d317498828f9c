//! What is asked of models on the records of suites, and of one motion over a parameter.

use super::fields::{Request, quantity, wrong};
use super::{Answer, On, Results, of_measure};
use crate::assessment::histories::{ModelOn, run_histories};
use crate::assessment::models::Models;
use crate::assessment::suite::{Scaling, times};
use crate::assessment::sweep::Sweep;
use crate::assessment::{AssessmentError, refuse};
use crate::error::ChoiceError;
use crate::motion::GroundMotion;
use crate::motion::intensity::LevelMeasure;
use crate::motion::target::TargetSpectrum;
use crate::notice::Notice;
use crate::study::engine::Engine;
use crate::units::Dimension;

impl Request {
    /// Runs every model on its suite. Pairs may be brought to a target spectrum, given with its name.
    ///
    /// # Errors
    /// [`AssessmentError`], a choice by the name of its field.
    pub fn suite(
        &self,
        models: &[On<'_>],
        target: Option<(&str, TargetSpectrum)>,
        engine: &Engine<'_>,
    ) -> Result<Answer, AssessmentError> {
        let (scaling, scaled) = self.scaling(target)?;
        let mut warnings: Vec<Notice> = Vec::new();
        for warning in models.iter().flat_map(|on| on.suite.noticed()) {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        let on = models.iter().map(|on| ModelOn {
            name: on.name,
            analysis: on.analysis,
            suite: on.suite,
        });
        let on: Vec<ModelOn<'_>> = on.collect();
        let names: Vec<&str> = models.iter().map(|on| on.name).collect();
        let hashes: Vec<String> = models.iter().map(|on| on.analysis.hash()).collect();
        Ok(Answer {
            name: names.join(", "),
            model_hash: Some(hashes.join(", ")),
            records: models.first().map_or_else(Vec::new, |on| on.suite.recorded()),
            scaled: if models.iter().all(|on| on.suite.made) { String::new() } else { scaled },
            warnings,
            found: Results::Suite(run_histories(&on, &scaling, engine)?),
        })
    }

    /// How a suite is scaled, and that in words.
    pub(super) fn scaling(
        &self,
        target: Option<(&str, TargetSpectrum)>,
    ) -> Result<(Scaling, String), AssessmentError> {
        let code = self.given("code-spectrum");
        let of_code =
            |text| Ok::<_, ChoiceError>((format!("the spectrum {text}"), code_spectrum(text)?));
        let spectrum = match (target, code) {
            (Some(_), Some(_)) => {
                return Err(refuse(
                    "code-spectrum",
                    "only one of `target` and `code-spectrum`",
                    "both",
                ));
            }
            (Some((name, spectrum)), None) => Some((name.to_owned(), spectrum)),
            (None, code) => code.map(of_code).transpose()?,
        };
        let range_s = self.given("periods").map(periods).transpose()?;
        let Some((words, spectrum)) = spectrum else {
            if let Some(text) = self.given("periods") {
                return Err(
                    wrong("periods", "`target` or `code-spectrum` beside them", text).into()
                );
            }
            return self.level();
        };
        if let Some(field) =
            ["scale", "scale-to"].into_iter().find(|name| self.given(name).is_some())
        {
            return Err(refuse(
                field,
                "a factor, a level or a spectrum to scale to",
                "two of them",
            ));
        }
        let range_s = range_s.ok_or_else(|| {
            refuse("periods", "the range of periods beside the spectrum, 0.6 s..3.8 s", "nothing")
        })?;
        Ok((Scaling::Target(spectrum, range_s), format!(" scaled to {words}")))
    }

    /// One level of a measure, else a factor.
    fn level(&self) -> Result<(Scaling, String), AssessmentError> {
        let Some(level) = self.given("scale-to") else {
            if let Some(measure) = self.given("measure") {
                return Err(wrong("measure", "`scale-to` beside it", measure).into());
            }
            let factor = self.number("scale", "a factor other than 0", |factor| factor != 0.0)?;
            return Ok((Scaling::Factor(factor), times(factor)));
        };
        if self.given("scale").is_some() {
            return Err(self.two_scales().into());
        }
        let measure = LevelMeasure::parse(self.one("measure")).map_err(of_measure)?;
        let scaling = Scaling::to_level("scale-to", measure, level)?;
        Ok((scaling, format!(" scaled to {measure} = {}", level.trim())))
    }

    /// Prepares a sweep of a model, whose text errors call `source`, on a motion with its tail.
    ///
    /// # Errors
    /// [`AssessmentError`], a choice by the name of its field.
    pub fn sweep(
        &self,
        source: &str,
        text: &str,
        motion: GroundMotion,
    ) -> Result<Sweep, AssessmentError> {
        let over = self.one("over");
        if over.is_empty() {
            return Err(refuse(
                "over",
                "a path and its values, slider.radius=1..5m:200",
                "nothing",
            ));
        }
        let models = Models::new(source, text, &[], &[("over", over.to_owned())], true)?;
        Ok(Sweep::new(models, motion))
    }
}

/// Two periods in s, `0.6 s..3.8 s`.
fn periods(text: &str) -> Result<[f64; 2], ChoiceError> {
    let wrong = || wrong("periods", "two periods, the shorter first: 0.6 s..3.8 s", text);
    let (from, to) = text.split_once("..").ok_or_else(wrong)?;
    let of = |text: &str| quantity("periods", text.trim(), Dimension::Time);
    let range_s = [of(from)?, of(to)?];
    if 0.0 < range_s[0] && range_s[0] < range_s[1] { Ok(range_s) } else { Err(wrong()) }
}

/// The shape of a code from its three parameters, `sds = 1.2 g, sd1 = 0.8 g, tl = 8 s`.
fn code_spectrum(text: &str) -> Result<TargetSpectrum, ChoiceError> {
    let expected = "three parameters: sds = 1.2 g, sd1 = 0.8 g, tl = 8 s";
    let wrong = || wrong("code-spectrum", expected, text);
    let mut values = [None; 3];
    for part in text.split(',') {
        let (key, value) = part.split_once('=').ok_or_else(wrong)?;
        let place = ["sds", "sd1", "tl"].iter().position(|name| *name == key.trim());
        let place = place.ok_or_else(wrong)?;
        let dimension = if place == 2 { Dimension::Time } else { Dimension::Acceleration };
        let value = quantity("code-spectrum", value.trim(), dimension)?;
        if !(value.is_finite() && value > 0.0) || values[place].is_some() {
            return Err(wrong());
        }
        values[place] = Some(value);
    }
    let [Some(sds_m_per_s2), Some(sd1_m_per_s2), Some(tl_s)] = values else { return Err(wrong()) };
    Ok(TargetSpectrum::Code { sds_m_per_s2, sd1_m_per_s2, tl_s })
}
