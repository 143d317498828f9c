//! Checked values to an analysis: what no key can say alone.

use core::f64::consts::TAU;

use super::frame;
use super::motion::{self, MotionSource};
use super::reader::Values;
use super::{Analysis, FrictionBounds, Names};
use crate::error::{InputError, ModelError};
use crate::friction::{Coulomb, Friction};
use crate::model::{Block, Frame, InitialState, Model, Slider, Stop, StopKind};
use crate::response::Method;
use crate::units::STANDARD_GRAVITY_M_PER_S2;

/// What an analysis needs of the values, and what a study draws anew for each of its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// The checked model.
    pub model: Model,
    /// How the table moves; `None` where the file does not say.
    pub motion: Option<MotionSource>,
    /// Free vibration after the motion ends, in s.
    pub tail_s: f64,
}

pub(super) fn parts(values: &Values) -> Result<Parts, InputError> {
    let gravity_m_per_s2 = values.number("analysis.gravity").unwrap_or(STANDARD_GRAVITY_M_PER_S2);
    let block = Block {
        mass_kg: mass_kg(values, "block", gravity_m_per_s2)?,
        width_m: values.number("block.width"),
        height_m: values.number("block.height"),
    };
    let frame = frame::frame(values, gravity_m_per_s2)?;
    let slider = slider(values, &block, &frame, gravity_m_per_s2)?;
    let initial = initial(values, frame.masses_kg.len())?;
    let model = Model::new(block, slider, frame, gravity_m_per_s2, initial)
        .map_err(|error| model_error(values, &error))?;
    let tail_s = values.number("analysis.tail").unwrap_or(0.0);
    Ok(Parts { model, motion: motion::motion(values)?, tail_s })
}

pub(super) fn analysis(values: Values) -> Result<Analysis, InputError> {
    let Parts { model, motion, tail_s } = parts(&values)?;
    let friction_bounds = friction_bounds(&values)?;
    let method = match values.text("analysis.method") {
        Some("stepwise") => Method::Stepwise,
        _ => Method::Exact,
    };
    Ok(Analysis {
        name: values.text("name").map(str::to_owned),
        names: Names {
            block: values.text("block.name").map(str::to_owned),
            storeys: (1..=model.storeys())
                .map(|i| values.text(&format!("storey.{i}.name")).map(str::to_owned))
                .collect(),
        },
        model,
        friction_bounds,
        motion,
        method,
        tail_s,
        values,
    })
}

/// The mass of a part, given as such or as its weight.
pub(super) fn mass_kg(
    values: &Values,
    part: &str,
    gravity_m_per_s2: f64,
) -> Result<f64, InputError> {
    let path = format!("{part}.weight");
    match values.number(&path) {
        Some(weight_n) => derived(values, &path, "mass, weight / g,", weight_n / gravity_m_per_s2),
        None => values.required(&format!("{part}.mass")),
    }
}

fn slider(
    values: &Values,
    block: &Block,
    frame: &Frame,
    gravity_m_per_s2: f64,
) -> Result<Slider, InputError> {
    let total_mass_kg = frame.masses_kg.iter().fold(block.mass_kg, |sum, m| sum + m);
    let (radius_m, period_s) = (values.number("slider.radius"), values.number("slider.period"));
    let stiffness_n_per_m = if let Some(radius_m) = radius_m {
        let stiffness = total_mass_kg * gravity_m_per_s2 / radius_m;
        derived(values, "slider.radius", "stiffness M_tot g / R", stiffness)?
    } else if let Some(period_s) = period_s {
        let stiffness = total_mass_kg * (TAU / period_s) * (TAU / period_s);
        derived(values, "slider.period", "stiffness M_tot (2 π / T)²", stiffness)?
    } else {
        values.number("slider.spring").unwrap_or(0.0)
    };
    let damper_n_s_per_m = match values.number("slider.damping_ratio") {
        Some(_) if stiffness_n_per_m == 0.0 => {
            let expected = "a spring, radius or period > 0 of which to take the critical damping";
            return Err(values.error("slider.damping_ratio", expected, "none"));
        }
        Some(ratio) => {
            let damper = 2.0 * ratio * (stiffness_n_per_m * total_mass_kg).sqrt();
            derived(values, "slider.damping_ratio", "damper 2 ξ √(K1 M_tot)", damper)?
        }
        None => values.number("slider.damper").unwrap_or(0.0),
    };
    Ok(Slider {
        friction: friction(values)?,
        stiffness_n_per_m,
        damper_n_s_per_m,
        tilt_rad: values.number("slider.tilt").unwrap_or(0.0),
        gap_m: values.number("slider.gap"),
        stop: stop(values, block)?,
    })
}

fn stop(values: &Values, block: &Block) -> Result<Option<Stop>, InputError> {
    if !values.has("slider.stop") {
        return Ok(None);
    }
    let side = |side: &str| values.number(&format!("slider.stop.gap.{side}"));
    let gap_m = match values.number("slider.stop.gap") {
        Some(gap_m) => [Some(gap_m); 2],
        None => [side("positive"), side("negative")],
    };
    let stiffness_n_per_m = values.required("slider.stop.stiffness")?;
    let damper_n_s_per_m = match values.number("slider.stop.damping_ratio") {
        Some(ratio) => {
            let damper = 2.0 * ratio * (stiffness_n_per_m * block.mass_kg).sqrt();
            derived(values, "slider.stop.damping_ratio", "damper 2 ξ √(k M1)", damper)?
        }
        None => values.number("slider.stop.damper").unwrap_or(0.0),
    };
    Ok(Some(Stop { gap_m, kind: StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } }))
}

/// A number computed from keys, which rounding may have driven out of range.
pub(super) fn derived(
    values: &Values,
    path: &str,
    what: &str,
    value: f64,
) -> Result<f64, InputError> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(values.wrong(path, format!("a value whose {what} is a finite number")))
}

fn friction(values: &Values) -> Result<Friction, InputError> {
    let statics = both_directions(values, "slider.static_friction")?;
    let kinetics = both_directions(values, "slider.kinetic_friction")?;
    for (kinetic, limit) in kinetics.iter().zip(&statics) {
        if kinetic.coefficient > limit.coefficient {
            let expected = format!("at most the static friction {}", limit.coefficient);
            return Err(values.wrong(&kinetic.path, expected));
        }
    }
    Coulomb::new(statics.map(|s| s.coefficient), kinetics.map(|k| k.coefficient))
        .map(Friction::Coulomb)
        .map_err(|error| model_error(values, &error))
}

struct Coefficient {
    coefficient: f64,
    path: String,
}

/// The coefficients for sliding towards +x and −x, and the paths they come from.
fn both_directions(values: &Values, path: &str) -> Result<[Coefficient; 2], InputError> {
    if let Some(mu) = values.number(path) {
        let alpha = values.number("slider.asymmetry").unwrap_or(0.0);
        let path = path.to_owned();
        return Ok([
            Coefficient { coefficient: mu * (1.0 + alpha), path: path.clone() },
            Coefficient { coefficient: mu * (1.0 - alpha), path },
        ]);
    }
    let of = |direction: &str| -> Result<Coefficient, InputError> {
        let path = format!("{path}.{direction}");
        Ok(Coefficient { coefficient: values.required(&path)?, path })
    };
    Ok([of("positive")?, of("negative")?])
}

pub(super) fn friction_bounds(values: &Values) -> Result<Option<FrictionBounds>, InputError> {
    let (Some(lower), Some(upper)) =
        (values.number("slider.bounds.lower"), values.number("slider.bounds.upper"))
    else {
        return Ok(None);
    };
    if upper < lower {
        let expected = format!("at least the lower bound {lower}");
        return Err(values.wrong("slider.bounds.upper", expected));
    }
    Ok(Some(FrictionBounds { lower, upper }))
}

fn initial(values: &Values, storeys: usize) -> Result<InitialState, InputError> {
    let list = |path: &str| match values.numbers(path) {
        Some(list) if list.len() != storeys => {
            let expected = format!("one value a storey, {storeys} in all");
            Err(values.error(path, expected, list.len().to_string()))
        }
        list => Ok(list),
    };
    Ok(InitialState {
        sliding_displacement_m: values.number("initial.sliding_displacement").unwrap_or(0.0),
        sliding_velocity_m_per_s: values.number("initial.sliding_velocity").unwrap_or(0.0),
        storey_displacement_m: list("initial.storey_displacement")?,
        storey_velocity_m_per_s: list("initial.storey_velocity")?,
    })
}

/// The model's objection at the key that caused it.
fn model_error(values: &Values, error: &ModelError) -> InputError {
    // What the constructors call a quantity, and the keys that it may come from.
    const KEYS: [(&str, &[&str]); 22] = [
        ("block mass_kg", &["block.mass", "block.weight"]),
        ("block width_m", &["block.width"]),
        ("block height_m", &["block.height"]),
        ("slider stiffness_n_per_m", &["slider.spring", "slider.radius", "slider.period"]),
        ("slider damper_n_s_per_m", &["slider.damper", "slider.damping_ratio"]),
        ("slider gap_m", &["slider.gap"]),
        ("stop gap_m", &["slider.stop.gap"]),
        ("stop stiffness_n_per_m", &["slider.stop.stiffness"]),
        ("stop damper_n_s_per_m", &["slider.stop.damper", "slider.stop.damping_ratio"]),
        ("slider tilt_rad", &["slider.tilt"]),
        ("gravity_m_per_s2", &["analysis.gravity"]),
        ("storey masses_kg", &["storey"]),
        ("storey stiffnesses_n_per_m", &["storey"]),
        ("storey damping_ratio", &["storey.1.damping_ratio"]),
        ("storey dampers_n_s_per_m", &["storey"]),
        ("storey heights_m", &["storey"]),
        ("initial sliding_displacement_m", &["initial.sliding_displacement"]),
        ("initial sliding_velocity_m_per_s", &["initial.sliding_velocity"]),
        ("initial storey_displacement_m", &["initial.storey_displacement"]),
        ("initial storey_velocity_m_per_s", &["initial.storey_velocity"]),
        ("static_friction", &["slider.static_friction"]),
        ("kinetic_friction", &["slider.kinetic_friction"]),
    ];
    let (quantity, expected, found) = match error {
        ModelError::OutOfRange { quantity, expected, found } => {
            (*quantity, (*expected).to_owned(), found.to_string())
        }
        ModelError::Missing { quantity, expected } => {
            (*quantity, (*expected).to_owned(), "none".to_owned())
        }
        ModelError::WrongCount { quantity, expected, found } => {
            (*quantity, format!("{expected} values, one a storey"), found.to_string())
        }
    };
    let paths = KEYS
        .iter()
        .find(|(name, _)| quantity.starts_with(name))
        .map_or(&["block"][..], |(_, paths)| paths);
    let path = paths.iter().find(|path| values.has(path)).or(paths.first()).unwrap_or(&"block");
    values.error(path, expected, found)
}
