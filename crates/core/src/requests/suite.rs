//! What is asked of models on the records of suites, and of one motion over a parameter.

use super::fields::{Request, quantity, wrong};
use super::{Answer, Kind, On, Results, of_measure};
use crate::assessment::code::{Plan, named};
use crate::assessment::grid::levels;
use crate::assessment::histories::{Kept, ModelOn, lateral, run_histories};
use crate::assessment::lateral::LateralForce;
use crate::assessment::models::Models;
use crate::assessment::suite::{Scaling, times};
use crate::assessment::sweep::Sweep;
use crate::assessment::{AssessmentError, refuse};
use crate::error::ChoiceError;
use crate::input::Analysis;
use crate::motion::GroundMotion;
use crate::motion::intensity::LevelMeasure;
use crate::motion::target::TargetSpectrum;
use crate::notice::{Notice, NoticeKind};
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
        let together = models.iter().map(|on| self.together(on));
        let together = together.collect::<Result<Vec<_>, AssessmentError>>()?;
        let models: Vec<On<'_>> = models
            .iter()
            .zip(&together)
            .map(|(on, together)| match together {
                Some((analysis, suite)) => On { analysis, suite, ..*on },
                None => *on,
            })
            .collect();
        let mut warnings: Vec<Notice> = Vec::new();
        for warning in models.iter().flat_map(|on| on.suite.noticed()) {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        let factors = self.property_factors()?;
        let plan = self.given("eccentricity").map(Plan::parse).transpose()?;
        // Factors take the place of the model's own bounds.
        let bounded = |on: &On<'_>| {
            let mut analysis = on.analysis.clone();
            analysis.friction_bounds = factors.map(|f| f.bounds()).or(analysis.friction_bounds);
            analysis
        };
        let analyses: Vec<Analysis> = models.iter().map(bounded).collect();
        let (scaling, scaled) = self.scaling(target, &analyses)?;
        warnings.extend(self.assumed_code(&scaling, &analyses));
        let pairs = models.iter().zip(&analyses);
        let on: Vec<ModelOn<'_>> = pairs
            .map(|(on, analysis)| ModelOn { name: on.name, analysis, suite: on.suite })
            .collect();
        let histories_of: Vec<&str> = self.all("history-of").collect();
        let floor_spectra = self.given("floor-spectrum").is_some();
        let kept = Kept { floor_spectra, histories_of: &histories_of };
        let names: Vec<&str> = models.iter().map(|on| on.name).collect();
        let hashes: Vec<String> = models.iter().map(|on| on.analysis.hash()).collect();
        Ok(Answer {
            name: names.join(", "),
            model_hash: Some(hashes.join(", ")),
            records: models.first().map_or_else(Vec::new, |on| on.suite.recorded()),
            scaled: if models.iter().all(|on| on.suite.made) { String::new() } else { scaled },
            warnings,
            found: Results::Suite {
                histories: run_histories(&on, &scaling, kept, engine)?,
                hazard: self.given("hazard").map(str::to_owned),
                factors,
                plan,
            },
        })
    }

    /// What is taken from ASCE/SEI 7 under a target spectrum of which nobody says after which code it is.
    fn assumed_code(&self, scaling: &Scaling, analyses: &[Analysis]) -> Option<Notice> {
        let Scaling::Target(spectrum @ TargetSpectrum::Points { .. }, _) = scaling else {
            return None;
        };
        let range = self.given("periods").is_none();
        let by_hand = analyses.iter().flat_map(|analysis| lateral(analysis, spectrum));
        let factor = by_hand.flatten().next().is_some();
        let taken = match (range, factor) {
            (false, false) => return None,
            (false, true) => "the damping factor B_M of the equivalent lateral force is that",
            (true, _) => {
                "the range of periods, 0.75 to 1.25 T_M, and the damping factor B_M are those"
            }
        };
        let message = format!(
            "the target spectrum is a table, and {taken} of ASCE/SEI 7: under another code, such as EN 1998 with 0.2 T to \
             2 T and η = √(10/(5 + ξ)), give its range as `periods` and do not use B_M"
        );
        Some(Notice::new(NoticeKind::CodeAssumed, message))
    }

    /// How a suite is scaled for these analyses, and that in words.
    pub(super) fn scaling(
        &self,
        target: Option<(&str, TargetSpectrum)>,
        analyses: &[Analysis],
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
        if let Some(range_s) = range_s {
            return Ok((Scaling::Target(spectrum, range_s), format!(" scaled to {words}")));
        }
        let range_s = effective_periods(analyses, &spectrum).ok_or_else(|| {
            let expected = "the range of periods beside the spectrum, 0.6 s..3.8 s: the model has no \
                            effective period by hand, of which it would be 0.75 to 1.25";
            refuse("periods", expected, "nothing")
        })?;
        let [from, to] = range_s.map(|period_s| format!("{period_s:.3}"));
        let words = format!(" scaled to {words} from {from} s to {to} s (0.75 to 1.25 T_M)");
        Ok((Scaling::Target(spectrum, range_s), words))
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

    /// The plan of a study of what is varied, on records by the names of their files; `read` is what the files
    /// do not say, as keys of its table.
    ///
    /// # Errors
    /// [`AssessmentError`], a choice by the name of its field.
    pub fn plan(
        &self,
        on: &On<'_>,
        files: &[&str],
        read: &[(&str, &str)],
    ) -> Result<String, AssessmentError> {
        let over = Some(self.one("over")).filter(|over| !over.is_empty());
        let models = self.models(on, over)?;
        let listed = |texts: &[String]| format!("[{}]", texts.join(", "));
        let quoted = |text: &str| format!("{text:?}");
        let mut plan = format!("name = {}\nmodel = \"{}\"\n", quoted(on.name), on.source);
        // Those of a design are factors.
        if let Some(bound) = self.given("bounds").filter(|_| self.kind() != Kind::Design) {
            plan.push_str(&format!("bounds = {}\n", quoted(bound)));
        }
        if !on.suite.made {
            let files: Vec<String> = files.iter().map(|name| quoted(name)).collect();
            plan.push_str(&format!("\n[records]\nfiles = {}\n", listed(&files)));
            for (key, text) in read {
                plan.push_str(&format!("{key} = {}\n", quoted(text)));
            }
            plan.push_str(&match self.given("scale-to") {
                Some(text) => {
                    let measure = LevelMeasure::parse(self.one("measure")).map_err(of_measure)?;
                    let values = levels("scale-to", text, &measure.measure)?;
                    let level = |value: &f64| format!("\"{value:?} {}\"", measure.unit());
                    let levels: Vec<String> = values.iter().map(level).collect();
                    format!("measure = \"{measure}\"\nlevels = {}\n", listed(&levels))
                }
                None => match self.given("scale") {
                    Some(factor) => format!("scale = [{}]\n", factor.trim()),
                    None => "scale = [1.0]\n".to_owned(),
                },
            });
        }
        Ok(plan + &models.plan())
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

/// The range in which chapter 17 of ASCE/SEI 7 compares pairs with the spectrum, in s: from 0.75 of the
/// effective period with the stiffest bound to 1.25 of it with the softest; none where a model has none.
fn effective_periods(analyses: &[Analysis], spectrum: &TargetSpectrum) -> Option<[f64; 2]> {
    let of = |analysis: &Analysis| lateral(analysis, spectrum);
    let all: Option<Vec<LateralForce>> = analyses.iter().flat_map(of).collect();
    let periods_s = || all.iter().flatten().map(|found| found.period_s);
    let (shortest_s, longest_s) = (periods_s().reduce(f64::min)?, periods_s().reduce(f64::max)?);
    Some([0.75 * shortest_s, 1.25 * longest_s])
}

/// Two periods in s, `0.6 s..3.8 s`.
///
/// # Errors
/// [`ChoiceError`] for what is none.
pub fn periods(text: &str) -> Result<[f64; 2], ChoiceError> {
    let wrong = || wrong("periods", "two periods, the shorter first: 0.6 s..3.8 s", text);
    let (from, to) = text.split_once("..").ok_or_else(wrong)?;
    let of = |text: &str| quantity("periods", text.trim(), Dimension::Time);
    let range_s = [of(from)?, of(to)?];
    if 0.0 < range_s[0] && range_s[0] < range_s[1] { Ok(range_s) } else { Err(wrong()) }
}

/// The shape of a code from its three parameters, `sds = 1.2 g, sd1 = 0.8 g, tl = 8 s`.
///
/// # Errors
/// [`ChoiceError`] for what is none.
pub fn code_spectrum(text: &str) -> Result<TargetSpectrum, ChoiceError> {
    let expected = "three parameters: sds = 1.2 g, sd1 = 0.8 g, tl = 8 s";
    let wrong = || wrong("code-spectrum", expected, text);
    let Some([Some(sds), Some(sd1), Some(tl)]) = named(text, ["sds", "sd1", "tl"]) else {
        return Err(wrong());
    };
    let positive = |text: &str, dimension| {
        let value = quantity("code-spectrum", text, dimension)?;
        if value.is_finite() && value > 0.0 { Ok(value) } else { Err(wrong()) }
    };
    let sds_m_per_s2 = positive(sds, Dimension::Acceleration)?;
    let sd1_m_per_s2 = positive(sd1, Dimension::Acceleration)?;
    let tl_s = positive(tl, Dimension::Time)?;
    Ok(TargetSpectrum::Code { sds_m_per_s2, sd1_m_per_s2, tl_s })
}

#[cfg(test)]
mod tests {
    use crate::assessment::suite::Suite;
    use crate::input;
    use crate::input::plan::Plan;
    use crate::requests::{Kind, On, Request};

    /// The plan of a request is one that a study reads: a period sets the radius, static friction keeps its ratio.
    #[test]
    fn the_plan_of_a_request_is_a_plan() {
        let text = "[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0.06\nkinetic_friction = 0.05\n\
                    radius = \"2 m\"\n";
        let analysis = input::parse("model.toml", text, &[]).unwrap();
        let suite = Suite::default();
        let on = On {
            name: "A \"block\"",
            source: "model.toml",
            text,
            set: &[],
            analysis: &analysis,
            suite: &suite,
        };
        let asked = |kind, given: &[(&'static str, &str)]| {
            let given = given.iter().map(|(name, text)| (*name, (*text).to_owned()));
            let asked = Request::new(kind, given).unwrap();
            asked.plan(&on, &["a.txt", "b.txt"], &[("units", "g"), ("dt", "0.01 s")]).unwrap()
        };
        let spectrum =
            asked(Kind::Spectrum, &[("friction", "0.02, 0.05"), ("scale-to", "1, 2 m/s2")]);
        let plan = Plan::parse("plan.toml", &spectrum).unwrap();
        assert_eq!(plan.name.as_deref(), Some("A \"block\""));
        let paths: Vec<&str> = plan.vary.iter().map(|varied| varied.path.as_str()).collect();
        assert_eq!(paths, ["slider.kinetic_friction", "slider.static_friction", "slider.radius"]);
        let records = plan.records.unwrap();
        assert_eq!((records.files.len(), records.dt_s, records.levels.len()), (2, Some(0.01), 2));
        let radius = spectrum.split("\"slider.radius\" = { values = [\"").nth(1).unwrap();
        let radius_m: f64 = radius.split(' ').next().unwrap().parse().unwrap();
        let rate = 1.0 / core::f64::consts::TAU;
        assert_eq!(radius_m, 9.80665 * rate * rate);
        let design =
            asked(Kind::Design, &[("vary", "slider.radius=1..2m:3"), ("bounds", "0.8,1.2")]);
        assert!(
            Plan::parse("plan.toml", &design).is_ok() && design.contains("scale = [1.0]"),
            "{design}"
        );
        assert!(Plan::parse("plan.toml", &asked(Kind::Ida, &[("bounds", "lower")])).is_ok());
    }
}
