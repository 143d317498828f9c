//! What is asked of models on the records of suites, and of one motion over a parameter.

use super::fields::{Request, quantity, wrong};
use super::{Answer, AtHazard, Kind, On, Results, of_measure};
use crate::assessment::code::{
    Code, Judged, Judgement, Plan, PropertyFactors, bounds_of, judge, named,
};
use crate::assessment::grid::levels;
use crate::assessment::histories::{Histories, Kept, ModelOn, bounds, lateral, run_histories};
use crate::assessment::lateral::LateralForce;
use crate::assessment::models::Models;
use crate::assessment::suite::{Scaling, times};
use crate::assessment::sweep::Sweep;
use crate::assessment::{AssessmentError, refuse};
use crate::error::ChoiceError;
use crate::input::{Analysis, Bound, Override};
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
        let code = self.code()?;
        let factors = self.property_factors()?.map(|factors| limited(factors, code.as_ref()));
        let plan = self.given("eccentricity").map(Plan::parse).transpose()?;
        // Factors take the place of the model's own bounds, and those of a code stand where there are none.
        let bounded = |on: &On<'_>| {
            let mut analysis = on.analysis.clone();
            let of_code = code.as_ref().and_then(bounds_of);
            let own = analysis.friction_bounds;
            analysis.friction_bounds = factors.map(|f| f.bounds()).or(own).or(of_code);
            analysis
        };
        let analyses: Vec<Analysis> = models.iter().map(bounded).collect();
        let (scaling, scaled) = self.scaling_by(target, &analyses, code.as_ref())?;
        if code.is_none() {
            warnings.extend(self.assumed_code(&scaling, &analyses));
        }
        let pairs = models.iter().zip(&analyses);
        let on: Vec<ModelOn<'_>> = pairs
            .map(|(on, analysis)| ModelOn { name: on.name, analysis, suite: on.suite })
            .collect();
        let histories_of: Vec<&str> = self.all("history-of").collect();
        let floor_spectra = self.given("floor-spectrum").is_some();
        let without_certificates = !self.certifies;
        let kept = Kept { floor_spectra, histories_of: &histories_of, without_certificates };
        let at = |scaling: &Scaling, hazard: Option<&str>, further: bool, kept: Kept<'_>| {
            let mut histories = run_histories(&on, scaling, kept, engine)?;
            let judged = code.as_ref().map(|code| {
                let besides = Besides { code, plan, hazard, further };
                judgements(&mut histories, &analyses, scaling, &besides)
            });
            Ok::<_, AssessmentError>((histories, judged.unwrap_or_default()))
        };
        let hazards = self.hazards()?;
        let (first, rest) =
            hazards.split_first().map_or((None, &[][..]), |(one, rest)| (Some(one), rest));
        let (histories, judgements) = at(&scaling, first.map(|(name, _)| *name), false, kept)?;
        let other = |(name, factor): &(&str, f64)| {
            let kept = Kept { histories_of: &[], ..kept };
            let (histories, judgements) = at(&scaling.times(*factor), Some(name), true, kept)?;
            Ok(AtHazard { name: (*name).to_owned(), factor: *factor, histories, judgements })
        };
        let others: Vec<AtHazard> =
            rest.iter().map(other).collect::<Result<_, AssessmentError>>()?;
        let names: Vec<&str> = models.iter().map(|on| on.name).collect();
        let hashes: Vec<String> = models.iter().map(|on| on.analysis.hash()).collect();
        Ok(Answer {
            name: names.join(", "),
            model_hash: Some(hashes.join(", ")),
            records: models.first().map_or_else(Vec::new, |on| on.suite.recorded()),
            scaled: if models.iter().all(|on| on.suite.made) { String::new() } else { scaled },
            warnings,
            title: ["project", "author", "date"]
                .into_iter()
                .filter_map(|name| Some((name, self.given(name)?.to_owned())))
                .collect(),
            found: Results::Suite {
                histories,
                hazard: first.map(|(name, _)| (*name).to_owned()),
                factors,
                plan,
                judgements,
                others,
            },
        })
    }

    /// The intensities in their order, each with the factor on what the records are scaled to; that of the first is 1.
    fn hazards(&self) -> Result<Vec<(&str, f64)>, ChoiceError> {
        let expected = "a name, and after the first a factor on it: MCE_R, DE=0.6667";
        let mut hazards: Vec<(&str, f64)> = Vec::new();
        for text in self.all("hazard") {
            let refused = || wrong("hazard", expected, text);
            let (name, factor) = match text.split_once('=') {
                None => (text.trim(), 1.0),
                Some((name, factor)) => {
                    let factor = factor.trim().parse().ok();
                    let factor = factor.filter(|f: &f64| f.is_finite() && *f > 0.0);
                    (name.trim(), factor.ok_or_else(refused)?)
                }
            };
            let is_first = hazards.is_empty();
            let alike = hazards.iter().any(|(known, _)| *known == name);
            if name.is_empty() || alike || is_first == text.contains('=') {
                return Err(refused());
            }
            hazards.push((name, factor));
        }
        Ok(hazards)
    }

    /// The code that is asked for, and what it is given besides the model.
    fn code(&self) -> Result<Option<Code>, AssessmentError> {
        let texts: Vec<&str> = self.all("code-values").collect();
        match (self.given("code"), texts.first()) {
            (Some(name), _) => Ok(Some(Code::named(name)?.with_values(&texts)?)),
            (None, Some(text)) => Err(wrong("code-values", "`code` beside them", text).into()),
            (None, None) => Ok(None),
        }
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
        self.scaling_by(target, analyses, None)
    }

    /// The same by the range of periods of a code; without one by that of ASCE/SEI 7.
    fn scaling_by(
        &self,
        target: Option<(&str, TargetSpectrum)>,
        analyses: &[Analysis],
        by: Option<&Code>,
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
        let assumed = if by.is_none() { Some(Code::assumed()?) } else { None };
        let Some(by) = by.or(assumed.as_ref()) else { return self.level() };
        let [least, most] = by.periods;
        let range_s = effective_periods(analyses, &spectrum, by).ok_or_else(|| {
            let expected = format!(
                "the range of periods beside the spectrum, 0.6 s..3.8 s: the model has no effective period by hand, of \
                 which it would be {least} to {most}"
            );
            refuse("periods", expected, "nothing")
        })?;
        let [from, to] = range_s.map(|period_s| format!("{period_s:.3}"));
        let effective = if by.is_asce() { "T_M" } else { "T_eff" };
        let words =
            format!(" scaled to {words} from {from} s to {to} s ({least} to {most} {effective})");
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
        let models = match self.kind() {
            Kind::Sweep => self.swept(on.source, on.text, on.set)?,
            _ => self.models(on, over)?,
        };
        let listed = |texts: &[String]| format!("[{}]", texts.join(", "));
        let quoted = |text: &str| format!("{text:?}");
        let mut plan = format!("name = {}\nmodel = \"{}\"\n", quoted(on.name), on.source);
        let bounds = match self.kind() {
            // A sweep follows the model as it stands.
            Kind::Sweep => on.analysis.friction_bounds.map(|_| Bound::NOMINAL.name),
            _ => self.given("bounds"),
        };
        if let Some(bound) = bounds {
            plan.push_str(&format!("bounds = {}\n", quoted(bound)));
        }
        // Without files it is a study of the model's own motion, which has its factor in the model.
        let scaled = ["scale", "scale-to"].into_iter().find(|name| self.given(name).is_some());
        if let Some(field) = scaled.filter(|_| files.is_empty() && !on.suite.made) {
            let expected = "records to scale, which a plan names";
            return Err(refuse(field, expected, "the model's own record"));
        }
        if !files.is_empty() {
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

    /// Prepares a sweep of a model with keys set, whose text errors call `source`, on a motion with its tail.
    ///
    /// # Errors
    /// [`AssessmentError`], a choice by the name of its field.
    pub fn sweep(
        &self,
        source: &str,
        text: &str,
        set: &[Override],
        motion: GroundMotion,
    ) -> Result<Sweep, AssessmentError> {
        Ok(Sweep::new(self.swept(source, text, set)?, motion))
    }

    /// The models of a sweep.
    fn swept(&self, source: &str, text: &str, set: &[Override]) -> Result<Models, AssessmentError> {
        let over = self.one("over");
        if over.is_empty() {
            return Err(refuse(
                "over",
                "a path and its values, slider.radius=1..5m:200",
                "nothing",
            ));
        }
        Models::new(source, text, set, &[("over", over.to_owned())], true)
    }
}

/// The range in which a code compares pairs with the spectrum, in s: from a part of the effective period with the stiffest
/// bound to a part of that with the softest; none where a model has none.
fn effective_periods(
    analyses: &[Analysis],
    spectrum: &TargetSpectrum,
    by: &Code,
) -> Option<[f64; 2]> {
    let of = |analysis: &Analysis| -> Vec<_> {
        let with = |bound: Bound| by.lateral(&bound.of(&analysis.model), spectrum);
        bounds(analysis).into_iter().map(with).collect()
    };
    let all: Option<Vec<LateralForce>> = analyses.iter().flat_map(of).collect();
    let periods_s = || all.iter().flatten().map(|found| found.period_s);
    let (shortest_s, longest_s) = (periods_s().reduce(f64::min)?, periods_s().reduce(f64::max)?);
    let [least, most] = by.periods;
    Some([least * shortest_s, most * longest_s])
}

/// Property factors with the limits of a code, unless these or qualification tests are stated.
fn limited(factors: PropertyFactors, code: Option<&Code>) -> PropertyFactors {
    let of_code = code.filter(|code| !code.is_given("qualification_tests"));
    let of_code = of_code.and_then(|code| code.limits);
    PropertyFactors { limits: factors.limits.or(of_code), ..factors }
}

/// What a code is asked with besides models and runs.
struct Besides<'a> {
    code: &'a Code,
    plan: Option<Plan>,
    hazard: Option<&'a str>,
    further: bool,
}

/// What a code makes of each model and its runs. The hand calculation beside the runs is that of ASCE/SEI 7: under
/// another code it stands among the values of the code alone.
fn judgements(
    histories: &mut Histories,
    analyses: &[Analysis],
    scaling: &Scaling,
    besides: &Besides<'_>,
) -> Vec<Judgement> {
    let Besides { code, plan, hazard, further } = besides;
    let (hazard, further) = (*hazard, *further);
    let (spectrum, range_s) = match scaling {
        Scaling::Target(spectrum, range_s) => (Some(spectrum), Some(*range_s)),
        _ => (None, None),
    };
    let of = histories.models.iter().zip(analyses).map(|(histories_of, analysis)| {
        let judged = Judged {
            analysis,
            histories: histories_of,
            spectrum,
            range_s,
            matched: histories.matched.as_ref().map(|(matched, _)| matched),
            hazard,
            further,
            plan: plan.as_ref(),
        };
        judge(code, judged)
    });
    let judgements = of.collect();
    if !code.is_asce() {
        histories.models.iter_mut().for_each(|model| model.lateral.clear());
    }
    judgements
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
            let files: &[&str] = if kind == Kind::Sweep { &[] } else { &["a.txt", "b.txt"] };
            asked.plan(&on, files, &[("units", "g"), ("dt", "0.01 s")])
        };
        let plan_of = |kind, given: &[(&'static str, &str)]| asked(kind, given).unwrap();
        let spectrum =
            plan_of(Kind::Spectrum, &[("friction", "0.02, 0.05"), ("scale-to", "1, 2 m/s2")]);
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
        let design = plan_of(
            Kind::Design,
            &[("vary", "slider.radius=1..2m:3"), ("friction-factors", "0.8,1.2")],
        );
        assert!(
            Plan::parse("plan.toml", &design).is_ok() && design.contains("scale = [1.0]"),
            "{design}"
        );
        assert!(Plan::parse("plan.toml", &plan_of(Kind::Ida, &[("bounds", "lower")])).is_ok());
        // A sweep is a study of the model's own motion, and a plan cannot scale that.
        let sweep = plan_of(Kind::Sweep, &[("over", "slider.kinetic_friction=0.02..0.05:4")]);
        let plan = Plan::parse("plan.toml", &sweep).unwrap();
        assert!(plan.records.is_none() && plan.bound.is_none(), "{sweep}");
        let paths: Vec<&str> = plan.vary.iter().map(|varied| varied.path.as_str()).collect();
        assert_eq!(paths, ["slider.kinetic_friction", "slider.static_friction"]);
        let alone = Request::new(Kind::Spectrum, [("scale-to", "1 m/s2".to_owned())]).unwrap();
        let error = alone.plan(&on, &[], &[]).unwrap_err().to_string();
        assert!(error.contains("expected records to scale, which a plan names"), "{error}");
    }
}
