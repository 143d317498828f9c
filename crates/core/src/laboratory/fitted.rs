//! From estimates to a model: the keys that they set.

use super::estimate::{Estimate, Outcome};
use crate::input::Override;
use crate::response::Warning;

/// Significant digits of a fitted value in a model: far more than any test tells.
const DIGITS: usize = 6;

/// The keys of a model that estimates set, and what had to be decided.
///
/// - Friction is one number where the intervals of both directions overlap, else one a direction.
/// - Static friction that the data do not tell, or that lies below the kinetic one, is taken as
///   large as the kinetic one.
/// - A spring or damper whose interval reaches below 0 is left out.
/// - What the data do not tell is left as the model has it.
#[must_use]
pub fn overrides(estimates: &[Estimate]) -> (Vec<Override>, Vec<Warning>) {
    let mut set = Vec::new();
    let mut warnings = Vec::new();
    let mut warn = |kind, message| warnings.push(Warning { kind, time_s: None, message });
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
        let rounded = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
        if let Ok(key) = Override::number(path, rounded) {
            set.push(key);
        }
    };
    for way in &ways {
        let [kinetic, limit] = both.map(|path| format!("{path}{way}"));
        let (kinetic_told, static_told) = (told(&kinetic), told(&limit));
        if let Some(kinetic_value) = kinetic_told {
            push(&kinetic, kinetic_value);
            match static_told {
                Some(value) if value >= kinetic_value => push(&limit, value),
                _ if here(&limit) => {
                    push(&limit, kinetic_value);
                    let why = if static_told.is_some() { "lies below" } else { "is not told from" };
                    let message = format!(
                        "{limit} {why} the kinetic friction: taken as large in the fitted model"
                    );
                    warn("static_taken_as_kinetic", message);
                }
                _ => {}
            }
        } else if let Some(value) = static_told {
            if here(&kinetic) {
                let message = format!(
                    "{limit} is told and the kinetic friction is not: both are left as the model \
                     has them"
                );
                warn("kinetic_not_told", message);
            } else {
                push(&limit, value);
            }
        }
    }
    for estimate in estimates {
        let Outcome::Told { value, low, .. } = estimate.outcome else { continue };
        if both.iter().any(|path| estimate.path.starts_with(path)) {
            continue;
        }
        let elastic = ["slider.spring", "slider.damper"].contains(&estimate.path.as_str());
        if elastic && (low < 0.0 || value <= 0.0) {
            let message =
                format!("{} is not clear of 0: left out of the fitted model", estimate.path);
            warn("not_clear_of_zero", message);
            continue;
        }
        push(&estimate.path, value);
    }
    (set, warnings)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(estimates: &[Estimate]) -> (Vec<String>, Vec<&'static str>) {
        let (set, warnings) = overrides(estimates);
        let text = set.iter().map(|o| o.path().to_owned()).collect();
        (text, warnings.iter().map(|w| w.kind).collect())
    }

    #[test]
    fn exact_what_is_set_and_what_is_not() {
        let told = |path: &str, value: f64, low: f64| Estimate::told(path, "", value, [low, 1.0]);
        let refused = |path: &str| Estimate::refused(path, "", "because");
        let (set, warnings) = paths(&[
            told("slider.kinetic_friction", 0.15, 0.14),
            Estimate::told("slider.kinetic_friction.positive", "", 0.16, [0.155, 0.165]),
            Estimate::told("slider.kinetic_friction.negative", "", 0.14, [0.135, 0.145]),
            refused("slider.static_friction"),
            refused("slider.static_friction.positive"),
            told("slider.static_friction.negative", 0.17, 0.13),
            Estimate::told("slider.spring", "N/m", 3.0, [-1.0, 7.0]),
            Estimate::told("slider.damper", "N s/m", 3.0, [0.0, 7.0]),
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
        // Where the directions agree, one number is enough.
        let near = |way: &str| {
            Estimate::told(format!("slider.kinetic_friction{way}"), "", 0.1, [0.09, 0.11])
        };
        let (set, _) = paths(&[near(""), near(".positive"), near(".negative")]);
        assert_eq!(set, ["slider.kinetic_friction"]);
        // Static friction that was not asked for stays as the model has it.
        let (set, warnings) = paths(&[told("slider.kinetic_friction", 0.1, 0.0)]);
        assert_eq!((set.len(), warnings.len()), (1, 0));
    }
}
