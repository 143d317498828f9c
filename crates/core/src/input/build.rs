//! Checked values to an analysis: what no key can say alone.

use core::f64::consts::TAU;

use super::frame;
use super::motion::{self, MotionSource};
use super::reader::Values;
use super::structure;
use super::{Analysis, FrictionBounds, Names};
use crate::error::{InputError, ModelError};
use crate::model::{Block, Contents, InitialState, Model, Slider, Stop};
use crate::response::Method;
use crate::slider::{
    Bearing, Direction, Ends, Friction, PressureLaw, RateCurve, RateLaw, Restoring, Surface,
    SurfacesInSeries,
};
use crate::units::{LARGEST, STANDARD_GRAVITY_M_PER_S2};

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
    let structure = structure::structure(values, gravity_m_per_s2)?;
    let contents = contents(values, frame.masses_kg.len(), gravity_m_per_s2)?;
    let own_kg = block.mass_kg + structure.as_ref().map_or(0.0, |structure| structure.mass_kg);
    let floors_kg = frame.masses_kg.iter().fold(own_kg, |sum, m| sum + m);
    let total_kg = contents.iter().fold(floors_kg, |sum, contents| sum + contents.mass_kg);
    let slider = slider(values, &block, total_kg, gravity_m_per_s2)?;
    let [initial, initial_y] = initial(values, frame.masses_kg.len())?;
    let key = key_of_y(values, frame.masses_kg.len());
    let along_y = frame::along_y(values, &frame, initial_y, key.as_deref())?;
    if along_y.is_some() {
        refuse_in_plane(values)?;
    }
    let model = match structure {
        Some(structure) => Model::with_modes(block, slider, structure, gravity_m_per_s2, initial),
        None => Model::new(block, slider, frame, gravity_m_per_s2, initial),
    };
    let model = model
        .and_then(|model| model.with_contents(contents))
        .and_then(|model| match along_y {
            Some(along_y) => model.with_along_y(along_y),
            None => Ok(model),
        })
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
        names: names(&values),
        model,
        friction_bounds,
        motion,
        method,
        tail_s,
        values,
    })
}

/// What the model calls its block, its storeys and its points.
pub(super) fn names(values: &Values) -> Names {
    let name = |part: String| values.text(&format!("{part}.name")).map(str::to_owned);
    let points =
        (1..=values.count("structure.point")).filter_map(|i| name(format!("structure.point.{i}")));
    Names {
        block: name("block".to_owned()),
        storeys: (1..=values.count("storey")).map(|i| name(format!("storey.{i}"))).collect(),
        points: points.collect(),
    }
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
    total_mass_kg: f64,
    gravity_m_per_s2: f64,
) -> Result<Slider, InputError> {
    let [tilt_rad, tilt_y_rad] =
        ["slider.tilt", "slider.tilt_y"].map(|path| values.number(path).unwrap_or(0.0));
    let bearing = match series(values)? {
        Some(series) => Bearing::InSeries(series),
        None => Bearing::Surface {
            friction: friction(values)?,
            restoring: restoring(values, total_mass_kg)?,
        },
    };
    let ends = match stop(values, block)? {
        Some(stop) => Ends::Stop(stop),
        None => Ends::Open { gap_m: values.number("slider.gap") },
    };
    let slider = Slider { bearing, damper_n_s_per_m: 0.0, tilt_rad, tilt_y_rad, ends };
    let normal_n = total_mass_kg * (gravity_m_per_s2 * slider.slope_cosine());
    let stiffness_n_per_m = slider.stiffness_n_per_m(normal_n);
    if slider.radius_m().is_some() {
        derived(values, "slider.radius", "stiffness M_tot g cos θ / R", stiffness_n_per_m)?;
    }
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
    Ok(Slider { damper_n_s_per_m, ..slider })
}

fn restoring(values: &Values, total_mass_kg: f64) -> Result<Restoring, InputError> {
    if let Some(radius_m) = values.number("slider.radius") {
        return Ok(Restoring::Pendulum { radius_m });
    }
    if let Some(period_s) = values.number("slider.period") {
        let stiffness = total_mass_kg * (TAU / period_s) * (TAU / period_s);
        let what = "stiffness M_tot (2 π / T)²";
        let stiffness_n_per_m = derived(values, "slider.period", what, stiffness)?;
        return Ok(Restoring::Spring { stiffness_n_per_m });
    }
    let spring = values.number("slider.spring");
    Ok(spring.map_or(Restoring::None, |stiffness_n_per_m| Restoring::Spring { stiffness_n_per_m }))
}

/// Gaps of a stop towards +x and −x, in m.
fn stop_gaps_m(values: &Values) -> [Option<f64>; 2] {
    match values.number("slider.stop.gap") {
        Some(gap_m) => [Some(gap_m); 2],
        None => {
            ["positive", "negative"].map(|side| values.number(&format!("slider.stop.gap.{side}")))
        }
    }
}

fn stop(values: &Values, block: &Block) -> Result<Option<Stop>, InputError> {
    if !values.has("slider.stop") {
        return Ok(None);
    }
    let gap_m = stop_gaps_m(values);
    if let Some(restitution) = values.number("slider.stop.restitution") {
        if restitution > 1.0 {
            return Err(values.wrong("slider.stop.restitution", "a number from 0 to 1"));
        }
        return Ok(Some(Stop::rigid(gap_m, restitution)));
    }
    let stiffness_n_per_m = values.required("slider.stop.stiffness")?;
    let damper_n_s_per_m = match values.number("slider.stop.damping_ratio") {
        Some(ratio) => {
            let damper = 2.0 * ratio * (stiffness_n_per_m * block.mass_kg).sqrt();
            derived(values, "slider.stop.damping_ratio", "damper 2 ξ √(k M1)", damper)?
        }
        None => values.number("slider.stop.damper").unwrap_or(0.0),
    };
    Ok(Some(Stop::elastic(gap_m, stiffness_n_per_m, damper_n_s_per_m)))
}

/// A number computed from keys, which rounding may have driven out of range.
pub(super) fn derived(
    values: &Values,
    path: &str,
    what: &str,
    value: f64,
) -> Result<f64, InputError> {
    if value.abs() <= LARGEST {
        return Ok(value);
    }
    Err(values.wrong(path, format!("a value whose {what} is at most {LARGEST:e} in SI")))
}

/// What is needed where there are no surfaces in series.
const FRICTION: &str = "a finite number ≥ 0 or a table of positive and negative";

fn friction(values: &Values) -> Result<Friction, InputError> {
    for path in ["slider.static_friction", "slider.kinetic_friction"] {
        if !values.has(path) {
            return Err(values.error(path, FRICTION, "nothing"));
        }
    }
    let statics = both_directions(values, "slider.static_friction")?;
    let by_speed = rate(values)?;
    let kinetics = match &by_speed {
        Some(law) => {
            let path = match law.curve() {
                RateCurve::Exponential { .. } => "slider.kinetic_friction.slow",
                RateCurve::Pieces { .. } => "slider.kinetic_friction.coefficient.1",
            };
            Direction::BOTH.map(|direction| Coefficient {
                coefficient: law.at(0.0, direction),
                path: path.to_owned(),
            })
        }
        None => both_directions(values, "slider.kinetic_friction")?,
    };
    for (kinetic, limit) in kinetics.iter().zip(&statics) {
        if kinetic.coefficient > limit.coefficient {
            let expected = format!("at most the static friction {}", limit.coefficient);
            return Err(values.wrong(&kinetic.path, expected));
        }
    }
    let fixed = statics.map(|s| s.coefficient);
    let pressure = pressure(values)?;
    match by_speed {
        Some(law) => Friction::by_speed(fixed, law),
        None => Friction::by_direction(fixed, kinetics.map(|k| k.coefficient)),
    }
    .and_then(|friction| match pressure {
        Some(law) => friction.under_pressure(law),
        None => Ok(friction),
    })
    .map_err(|error| model_error(values, &error))
}

/// How friction follows the pressure.
fn pressure(values: &Values) -> Result<Option<PressureLaw>, InputError> {
    if !values.has("slider.pressure") {
        return Ok(None);
    }
    let number = |key: &str| values.required(&format!("slider.pressure.{key}"));
    let (at_rest_pa, reference_pa) = (number("at_rest")?, number("reference")?);
    let exponent = number("exponent")?;
    if exponent >= 1.0 {
        return Err(values.wrong("slider.pressure.exponent", "a number from 0 to below 1"));
    }
    let law = PressureLaw::new(at_rest_pa, reference_pa, exponent);
    law.map(Some).map_err(|error| model_error(values, &error))
}

/// Kinetic friction by sliding speed.
fn rate(values: &Values) -> Result<Option<RateLaw>, InputError> {
    let path = "slider.kinetic_friction";
    let curve = if let Some(slow) = values.number(&format!("{path}.slow")) {
        let fast = values.required(&format!("{path}.fast"))?;
        let rate = format!("{path}.rate");
        let expected = "a rate by speed with its unit, such as \"25 s/m\"";
        let rate_s_per_m =
            values.number(&rate).ok_or_else(|| values.error(&rate, expected, "nothing"))?;
        RateCurve::Exponential { slow, fast, rate_s_per_m }
    } else if let Some(speeds_m_per_s) = values.numbers(&format!("{path}.velocity")) {
        let coefficients = values.numbers(&format!("{path}.coefficient")).unwrap_or_default();
        if speeds_m_per_s.first().is_none_or(|first| *first != 0.0) {
            let expected = "velocities from 0 on";
            return Err(match speeds_m_per_s.is_empty() {
                true => values.error(&format!("{path}.velocity"), expected, "an empty list"),
                false => values.wrong(&format!("{path}.velocity.1"), expected),
            });
        }
        for (i, pair) in speeds_m_per_s.windows(2).enumerate() {
            if !(pair[1] > pair[0]) {
                let path = format!("{path}.velocity.{}", i + 2);
                return Err(values.wrong(&path, "velocities that increase"));
            }
        }
        if coefficients.len() != speeds_m_per_s.len() {
            let expected = format!("one coefficient a velocity, {} in all", speeds_m_per_s.len());
            let found = coefficients.len().to_string();
            return Err(values.error(&format!("{path}.coefficient"), expected, found));
        }
        RateCurve::Pieces { speeds_m_per_s, coefficients }
    } else {
        return Ok(None);
    };
    RateLaw::new(curve, [1.0; 2]).map(Some).map_err(|error| model_error(values, &error))
}

/// Surfaces in series.
fn series(values: &Values) -> Result<Option<SurfacesInSeries>, InputError> {
    let surfaces = if values.has("slider.triple") {
        triple(values)?
    } else if values.has("slider.surface") {
        let count = values.count("slider.surface");
        if count == 0 {
            return Err(values.error("slider.surface", "one surface at least", "none"));
        }
        (1..=count)
            .map(|i| {
                let at = |key: &str| format!("slider.surface.{i}.{key}");
                let friction = values.number(&at("friction")).ok_or_else(|| {
                    let expected = "a number > 0: friction by direction or speed on surfaces in \
                                    series is a differential-algebraic system, which is not solved";
                    values.error(&at("friction"), expected, "a table")
                })?;
                let (radius_m, travel_m) =
                    (values.number(&at("radius")), values.number(&at("travel")));
                Ok(Surface { radius_m, friction, travel_m })
            })
            .collect::<Result<Vec<_>, InputError>>()?
    } else {
        if values.has("slider.static_ratio") {
            let expected = "surfaces in series, of which it is the ratio; else static_friction";
            return Err(values.error("slider.static_ratio", expected, "none"));
        }
        return Ok(None);
    };
    let static_ratio = values.number("slider.static_ratio").unwrap_or(1.0);
    if static_ratio < 1.0 {
        return Err(values.wrong("slider.static_ratio", "a number of at least 1"));
    }
    SurfacesInSeries::new(surfaces, static_ratio)
        .map(Some)
        .map_err(|error| model_error(values, &error))
}

/// A triple pendulum as three elements in series (Fenz and Constantinou 2008).
fn triple(values: &Values) -> Result<Vec<Surface>, InputError> {
    let four = |key: &str| -> Result<[f64; 4], InputError> {
        let path = format!("slider.triple.{key}");
        let list = values.numbers(&path).unwrap_or_default();
        let found = list.len().to_string();
        list.try_into().map_err(|_| {
            values.error(&path, "four values, one a surface from the bottom up", found)
        })
    };
    let [r1, r2, r3, r4] = four("effective_radius")?;
    let [mu1, mu2, mu3, mu4] = four("friction")?;
    let [d1, d2, d3, d4] = four("travel")?;
    if mu2 != mu3 {
        let expected = format!("{mu2}, the friction of the other inner surface");
        return Err(values.wrong("slider.triple.friction.3", expected));
    }
    for (i, outer, inner) in [(1, r1, r2), (4, r4, r3)] {
        if !(outer > inner) {
            let path = format!("slider.triple.effective_radius.{i}");
            return Err(values.wrong(&path, "more than the effective radius of the inner surface"));
        }
    }
    let (bottom_m, top_m) = (d1 * (1.0 - r2 / r1), d4 * (1.0 - r3 / r4));
    let inner_m = (d1 + d2 + d3 + d4) - bottom_m - top_m;
    let element = |radius_m: f64, friction: f64, travel_m: f64| Surface {
        radius_m: Some(radius_m),
        friction,
        travel_m: Some(travel_m),
    };
    Ok(vec![
        element(r2 + r3, mu2, inner_m),
        element(r1 - r2, mu1, bottom_m),
        element(r4 - r3, mu4, top_m),
    ])
}

fn contents(
    values: &Values,
    storeys: usize,
    gravity_m_per_s2: f64,
) -> Result<Vec<Contents>, InputError> {
    (1..=values.count("contents"))
        .map(|i| {
            let part = format!("contents.{i}");
            let floor_path = format!("{part}.floor");
            let floor = values.required(&floor_path)?;
            if floor > storeys as f64 {
                let expected = match storeys {
                    0 => "0, the block: there are no storeys".to_owned(),
                    n => format!("0 for the block, or a storey from 1 to {n}"),
                };
                return Err(values.wrong(&floor_path, expected));
            }
            let static_friction = values.required(&format!("{part}.static_friction"))?;
            let kinetic_path = format!("{part}.kinetic_friction");
            let kinetic_friction = values.required(&kinetic_path)?;
            if kinetic_friction > static_friction {
                let expected = format!("at most the static friction {static_friction}");
                return Err(values.wrong(&kinetic_path, expected));
            }
            Ok(Contents {
                floor: floor as usize,
                mass_kg: mass_kg(values, &part, gravity_m_per_s2)?,
                static_friction,
                kinetic_friction,
            })
        })
        .collect()
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

/// What is given at t = 0.
const START: [&str; 4] = [
    "initial.sliding_displacement",
    "initial.sliding_velocity",
    "initial.storey_displacement",
    "initial.storey_velocity",
];

/// A key that means something in two horizontal directions alone.
pub(super) fn key_of_y(values: &Values, storeys: usize) -> Option<String> {
    let is_pair = |path: &String| values.has(path) && values.number(path).is_none();
    let pair = |path: &str| match path.contains("storey") {
        true => (1..=storeys).map(|i| format!("{path}.{i}")).find(is_pair),
        false => Some(path.to_owned()).filter(is_pair),
    };
    frame::key_of_y(values, storeys).or_else(|| START.into_iter().find_map(pair))
}

/// The state at t = 0 along x and along y.
fn initial(values: &Values, storeys: usize) -> Result<[InitialState; 2], InputError> {
    let list = |path: &str| match values.vectors(path) {
        Some(list) if list.len() != storeys => {
            let expected = format!("one value a storey, {storeys} in all");
            Err(values.error(path, expected, list.len().to_string()))
        }
        list => Ok(list),
    };
    let [s, w, q, v] = START;
    let [s, w] = [s, w].map(|path| values.vector(path).unwrap_or_default());
    let (q, v) = (list(q)?, list(v)?);
    let of = |list: &Option<Vec<[f64; 2]>>, axis: usize| {
        list.as_ref().map(|list| list.iter().map(|pair| pair[axis]).collect())
    };
    Ok([0, 1].map(|axis| InitialState {
        sliding_displacement_m: s[axis],
        sliding_velocity_m_per_s: w[axis],
        storey_displacement_m: of(&q, axis),
        storey_velocity_m_per_s: of(&v, axis),
    }))
}

/// Whether a stop has one gap all around, in which the block can move.
fn has_one_gap(values: &Values) -> bool {
    let [one, other] = stop_gaps_m(values);
    one == other && one.is_some_and(|gap_m| gap_m > 0.0)
}

/// Refuses what is not solved in two directions.
fn refuse_in_plane(values: &Values) -> Result<(), InputError> {
    let mut keys = vec![
        "slider.asymmetry",
        "slider.static_friction.positive",
        "slider.kinetic_friction.positive",
        "slider.surface",
        "slider.triple",
        "contents",
    ];
    if values.text("analysis.method") == Some("stepwise") {
        keys.push("analysis.method");
    }
    if values.has("slider.stop") && !has_one_gap(values) {
        keys.insert(0, "slider.stop.gap");
    }
    match keys.into_iter().find(|path| values.has(path)) {
        Some(path) => {
            let expected = "a model that is solved in two directions: one surface whose \
                            friction is the same in all directions, without contents \
                            or a stop whose gap is not the same all around, by the exact method";
            let apart = ", or the components of pairs run by themselves, pairs = separate";
            let apart = if values.in_plane { apart } else { "" };
            Err(values.error(path, format!("{expected}{apart}"), path))
        }
        None => Ok(()),
    }
}

/// The model's objection at the key that caused it.
fn model_error(values: &Values, error: &ModelError) -> InputError {
    // What the constructors call a quantity, and the keys that it may come from.
    const KEYS: [(&str, &[&str]); 37] = [
        ("block mass_kg", &["block.mass", "block.weight"]),
        ("block width_m", &["block.width"]),
        ("block width_y_m", &["block.width_y"]),
        ("block height_m", &["block.height"]),
        ("slider stiffness_n_per_m", &["slider.spring", "slider.radius", "slider.period"]),
        ("slider damper_n_s_per_m", &["slider.damper", "slider.damping_ratio"]),
        ("slider gap_m", &["slider.gap"]),
        ("stop gap_m", &["slider.stop.gap"]),
        ("stop stiffness_n_per_m", &["slider.stop.stiffness"]),
        ("stop damper_n_s_per_m", &["slider.stop.damper", "slider.stop.damping_ratio"]),
        ("slider tilt_rad", &["slider.tilt"]),
        ("slider tilt_y_rad", &["slider.tilt_y"]),
        ("gravity_m_per_s2", &["analysis.gravity"]),
        ("structure mass_kg", &["structure.mass", "structure.weight"]),
        ("structure mode points", &["structure.point"]),
        ("structure effective_mass_kg", &["structure.mode"]),
        ("storey masses_kg", &["storey"]),
        ("storey stiffnesses_n_per_m", &["storey"]),
        ("storey stiffnesses_y_n_per_m", &["storey"]),
        ("storey damping_ratio_y", &["storey.1.damping_ratio_y", "storey.1.damping_ratio"]),
        ("storey damping_ratio", &["storey.1.damping_ratio"]),
        ("storey dampers_n_s_per_m", &["storey"]),
        ("storey dampers_y_n_s_per_m", &["storey"]),
        ("storey heights_m", &["storey"]),
        ("initial sliding_displacement_m", &["initial.sliding_displacement"]),
        ("initial sliding_velocity_m_per_s", &["initial.sliding_velocity"]),
        ("initial storey_displacement_m", &["initial.storey_displacement"]),
        ("initial storey_velocity_m_per_s", &["initial.storey_velocity"]),
        ("stop restitution", &["slider.stop.restitution"]),
        ("slider radius_m", &["slider.radius"]),
        ("surface friction", &["slider.surface", "slider.triple.friction"]),
        ("surface radius_m", &["slider.surface", "slider.triple.effective_radius"]),
        ("surface travel_m", &["slider.surface", "slider.triple.travel"]),
        ("static_ratio", &["slider.static_ratio"]),
        ("contents", &["contents"]),
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
        ModelError::Quantity { quantity, error } => {
            (*quantity, error.expected.clone(), error.found.clone())
        }
    };
    let paths = KEYS
        .iter()
        .find(|(name, _)| quantity.starts_with(name))
        .map_or(&["block"][..], |(_, paths)| paths);
    let path = paths.iter().find(|path| values.has(path)).or(paths.first()).unwrap_or(&"block");
    values.error(path, expected, found)
}
