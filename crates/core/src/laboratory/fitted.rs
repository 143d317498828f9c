//! From estimates to a model: the keys that they set.

use super::cyclic::PressureFit;
use super::estimate::{Estimate, Outcome};
use crate::error::InputError;
use crate::input::Override;
use crate::notice::{Notice, NoticeKind};

/// Significant digits of a fitted value in a model: far more than any test tells.
const DIGITS: usize = 6;

/// The key of the exponent of the pressure.
const EXPONENT: &str = "slider.pressure.exponent";

/// A value with the digits of a model.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

/// The keys of a model by which friction follows the pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureKeys {
    exponent: f64,
    reference: String,
    /// `None` where no model is known.
    at_rest: Option<String>,
}

impl PressureKeys {
    /// Those of a law that was fitted, with the pressure under the weight of the model in Pa; `None` where it was not
    /// determined, a notice where the exponent is not clear of 0.
    ///
    /// # Errors
    /// [`Notice`] that the law is left out of the fitted model.
    pub fn new(fit: &PressureFit, at_rest_pa: Option<f64>) -> Result<Option<Self>, Notice> {
        let Some((value, [low, _])) = fit.exponent.value().zip(fit.exponent.interval()) else {
            return Ok(None);
        };
        if low <= 0.0 {
            let message = format!(
                "{EXPONENT} is not clear of 0: the fitted model has the coefficients of the reference pressure at all \
                 pressures"
            );
            return Err(Notice::new(NoticeKind::NotClearOfZero, message));
        }
        let megapascals = |pa: f64| format!("{:?} MPa", rounded(1e-6 * pa));
        Ok(Some(Self {
            exponent: rounded(value),
            reference: megapascals(fit.reference_pa),
            at_rest: at_rest_pa.map(megapascals),
        }))
    }

    /// What sets them in a model.
    ///
    /// # Errors
    /// [`InputError`] for a path that no model has.
    pub fn overrides(&self) -> Result<Vec<Override>, InputError> {
        let key =
            |name: &str, text: &str| Override::text_value(&format!("slider.pressure.{name}"), text);
        let at_rest = self.at_rest.as_ref().map(|text| key("at_rest", text));
        let reference = key("reference", &self.reference);
        at_rest.into_iter().chain([reference, Override::number(EXPONENT, self.exponent)]).collect()
    }

    /// The table `[slider.pressure]` of a model.
    fn text(&self) -> String {
        let at_rest = match &self.at_rest {
            Some(text) => format!("at_rest = \"{text}\""),
            None => "# at_rest = the pressure under the weight of the model alone".to_owned(),
        };
        let Self { exponent, reference, .. } = self;
        format!(
            "\n[slider.pressure]\n{at_rest}\nreference = \"{reference}\"\nexponent = {exponent:?}\n"
        )
    }
}

/// The keys of a model that estimates set, and what had to be decided.
///
/// - Friction is one number where the intervals of both directions overlap, else one a direction.
/// - Friction that follows the speed is set where slow, fast and rate are all told.
/// - Static friction that the data do not tell, or that lies below the kinetic one, is taken as
///   large as the kinetic one, the slow one where it follows the speed.
/// - A spring or damper whose interval reaches below 0 is left out.
/// - What the data do not tell is left as the model has it.
/// - The exponent of the pressure is set by [`PressureKeys`].
#[must_use]
pub fn overrides(estimates: &[Estimate]) -> (Vec<Override>, Vec<Notice>) {
    let mut set = Vec::new();
    let mut warnings = Vec::new();
    let mut warn = |kind, message| warnings.push(Notice::new(kind, message));
    let told = |path: &str| estimates.iter().find(|e| e.path == path).and_then(Estimate::value);
    let here = |path: &str| estimates.iter().any(|e| e.path == path);
    let both = ["slider.kinetic_friction", "slider.static_friction"];
    let ways: Vec<String> = {
        let by_way = |what: &str| {
            let of = |way: &str| {
                let path = format!("{what}{way}");
                estimates.iter().find(|e| e.path == path).and_then(Estimate::interval)
            };
            of(".positive").zip(of(".negative"))
        };
        let differ = |what: &&str| by_way(what).is_some_and(|(a, b)| a[1] < b[0] || b[1] < a[0]);
        let one = told(both[0]).is_some() && !both.iter().any(differ);
        if by_way(both[0]).is_some() && !one {
            vec![".positive".to_owned(), ".negative".to_owned()]
        } else {
            vec![String::new()]
        }
    };
    let mut push = |path: &str, value: f64| {
        if let Ok(key) = Override::number(path, rounded(value)) {
            set.push(key);
        }
    };
    let by_speed = ["slow", "fast", "rate"].map(|key| format!("{}.{key}", both[0]));
    let followed: Vec<&String> = by_speed.iter().filter(|path| here(path)).collect();
    let all_told = followed.iter().all(|path| told(path).is_some());
    for way in &ways {
        let [kinetic, limit] = match followed.as_slice() {
            [] => both.map(|path| format!("{path}{way}")),
            _ => [by_speed[0].clone(), both[1].to_owned()],
        };
        let (kinetic_told, static_told) = (told(&kinetic).filter(|_| all_told), told(&limit));
        if let Some(kinetic_value) = kinetic_told {
            push(&kinetic, kinetic_value);
        }
        for (path, value) in followed.iter().filter_map(|path| Some((path, told(path)?))) {
            if all_told && **path != kinetic {
                push(path, value);
            }
        }
        if let Some(kinetic_value) = kinetic_told {
            match static_told {
                Some(value) if value >= kinetic_value => push(&limit, value),
                _ if here(&limit) => {
                    push(&limit, kinetic_value);
                    let why = if static_told.is_some() {
                        "lies below"
                    } else {
                        "cannot be distinguished from"
                    };
                    let message = format!(
                        "{limit} {why} the kinetic friction: taken as large in the fitted model"
                    );
                    warn(NoticeKind::StaticTakenAsKinetic, message);
                }
                _ => {}
            }
        } else if let Some(value) = static_told {
            if here(&kinetic) {
                let message = format!(
                    "{limit} is determined and the kinetic friction is not: both are left as the model \
                     has them"
                );
                warn(NoticeKind::KineticNotTold, message);
            } else {
                push(&limit, value);
            }
        }
    }
    for estimate in estimates {
        let Outcome::Told { value, low, .. } = estimate.outcome else { continue };
        let of_friction = |path: &&str| {
            let way = estimate.path.strip_prefix(path);
            way.is_some_and(|way| ["", ".positive", ".negative"].contains(&way))
        };
        let is_set_elsewhere = by_speed.contains(&estimate.path) || estimate.path == EXPONENT;
        if both.iter().any(of_friction) || is_set_elsewhere {
            continue;
        }
        let elastic = ["slider.spring", "slider.damper"].contains(&estimate.path.as_str());
        if elastic && (low < 0.0 || value <= 0.0) {
            let message =
                format!("{} is not clear of 0: left out of the fitted model", estimate.path);
            warn(NoticeKind::NotClearOfZero, message);
            continue;
        }
        push(&estimate.path, value);
    }
    (set, warnings)
}

/// The table `[slider]` of a model with what estimates set in it, and how friction follows the pressure where that was
/// fitted; `None` where friction is not told.
#[must_use]
pub fn slider_keys(estimates: &[Estimate], pressure: Option<&PressureKeys>) -> Option<String> {
    let (set, _) = overrides(estimates);
    let mut keys: Vec<(String, Vec<String>)> = Vec::new();
    for (path, value) in set.iter().filter_map(|key| key.text().split_once('=')) {
        let Some(path) = path.strip_prefix("slider.") else { continue };
        let value = match value.split_once(' ') {
            Some(_) => format!("\"{value}\""),
            None => value.to_owned(),
        };
        let (key, inner) = path.split_once('.').unwrap_or((path, ""));
        let entry = if inner.is_empty() { value } else { format!("{inner} = {value}") };
        match keys.iter_mut().find(|(name, _)| name == key) {
            Some((_, entries)) => entries.push(entry),
            None => keys.push((key.to_owned(), vec![entry])),
        }
    }
    // Static friction first, as people write it.
    keys.sort_by_key(|(key, _)| (key != "static_friction", key != "kinetic_friction"));
    let line = |(key, entries): &(String, Vec<String>)| match entries.as_slice() {
        [value] if !value.contains(" = ") => format!("{key} = {value}\n"),
        _ => format!("{key} = {{ {} }}\n", entries.join(", ")),
    };
    let friction = keys.iter().any(|(key, _)| key == "kinetic_friction");
    let pressure = pressure.map_or_else(String::new, PressureKeys::text);
    friction.then(|| format!("[slider]\n{}{pressure}", keys.iter().map(line).collect::<String>()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(estimates: &[Estimate]) -> (Vec<String>, Vec<&'static str>) {
        let (set, warnings) = overrides(estimates);
        let text = set.iter().map(|o| o.path().to_owned()).collect();
        (text, warnings.iter().map(|w| w.kind.name()).collect())
    }

    #[test]
    fn what_is_set_and_what_is_not() {
        let told =
            |path: &str, value: f64, low: f64| Estimate::determined(path, "", value, [low, 1.0]);
        let refused = |path: &str| Estimate::refused(path, "", "because");
        let (set, warnings) = paths(&[
            told("slider.kinetic_friction", 0.15, 0.14),
            Estimate::determined("slider.kinetic_friction.positive", "", 0.16, [0.155, 0.165]),
            Estimate::determined("slider.kinetic_friction.negative", "", 0.14, [0.135, 0.145]),
            refused("slider.static_friction"),
            refused("slider.static_friction.positive"),
            told("slider.static_friction.negative", 0.17, 0.13),
            Estimate::determined("slider.spring", "N/m", 3.0, [-1.0, 7.0]),
            Estimate::determined("slider.damper", "N s/m", 3.0, [0.0, 7.0]),
            refused("slider.tilt"),
        ]);
        assert_eq!(
            set,
            [
                "slider.kinetic_friction.positive",
                "slider.static_friction.positive",
                "slider.kinetic_friction.negative",
                "slider.static_friction.negative",
                "slider.damper"
            ]
        );
        assert_eq!(warnings, ["static_taken_as_kinetic", "not_clear_of_zero"]);
        // Friction that follows the speed: all of it, or none.
        let told = |path: &str, value: f64| Estimate::determined(path, "", value, [0.0, 1.0]);
        let slow_fast = |rate: Estimate| {
            let slow = told("slider.kinetic_friction.slow", 0.05);
            paths(&[slow, told("slider.kinetic_friction.fast", 0.1), rate, told(LIMIT, 0.06)])
        };
        const LIMIT: &str = "slider.static_friction";
        const RATE: &str = "slider.kinetic_friction.rate";
        let (set, warnings) = slow_fast(told(RATE, 20.0));
        let keys = ["slow", "fast", "rate"].map(|key| format!("slider.kinetic_friction.{key}"));
        assert_eq!(set, [&keys[..], &[LIMIT.to_owned()]].concat());
        assert!(warnings.is_empty());
        let (set, warnings) = slow_fast(refused(RATE));
        assert_eq!((set.len(), warnings), (0, vec!["kinetic_not_told"]));
        let all = [
            told("slider.kinetic_friction.slow", 0.05),
            told("slider.kinetic_friction.fast", 0.1),
            Estimate::determined(RATE, "s/m", 20.0, [19.0, 21.0]),
            told(LIMIT, 0.06),
            Estimate::determined("slider.spring", "N/m", 1e4, [9e3, 1.1e4]),
        ];
        let expected = "[slider]\nstatic_friction = 0.06\nkinetic_friction = { slow = 0.05, fast = \
                        0.1, rate = \"20.0 s/m\" }\nspring = \"10000.0 N/m\"\n";
        assert_eq!(slider_keys(&all, None).unwrap(), expected);
        let [_, fast, rate, limit, spring] = all;
        let without = [refused("slider.kinetic_friction.slow"), fast, rate, limit, spring];
        assert_eq!(slider_keys(&without, None), None);
        // Fitted to a shaking-table record one by one.
        for path in [RATE, "slider.kinetic_friction.coefficient.2"] {
            assert_eq!(paths(&[told(path, 0.1)]).0, [path]);
        }
        // Where the directions agree, one number is enough.
        let near = |way: &str| {
            Estimate::determined(format!("slider.kinetic_friction{way}"), "", 0.1, [0.09, 0.11])
        };
        let (set, _) = paths(&[near(""), near(".positive"), near(".negative")]);
        assert_eq!(set, ["slider.kinetic_friction"]);
        // Static friction that was not asked for stays as the model has it.
        let (set, warnings) = paths(&[told("slider.kinetic_friction", 0.1)]);
        assert_eq!((set.len(), warnings.len()), (1, 0));
    }
}
