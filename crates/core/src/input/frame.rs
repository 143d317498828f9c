//! The structure on the block, from its storeys.

use core::f64::consts::TAU;

use super::build::{derived, mass_kg};
use super::motion;
use super::reader::Values;
use crate::error::InputError;
use crate::model::shear_frame_frequencies;
use crate::model::{AlongY, Damping, Frame, InitialState};

/// One of the two horizontal directions. A key along y is that along x with `_y` behind it; where it is not
/// given, y is as x.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    X,
    Y,
}

impl Axis {
    /// What the keys of a table have behind their names: `_y` along y where one of these is given there.
    fn suffix(self, values: &Values, table: &str, names: &[&str]) -> &'static str {
        let has_own = || names.iter().any(|name| values.has(&format!("{table}.{name}_y")));
        if self == Self::Y && has_own() { "_y" } else { "" }
    }
}

const STIFFNESS: [&str; 3] = ["frequency", "period", "stiffness"];
const DAMPING: [&str; 2] = ["damping_ratio", "damper"];

pub(super) fn frame(values: &Values, gravity_m_per_s2: f64) -> Result<Frame, InputError> {
    let storeys = values.count("storey");
    if storeys == 0 {
        let period = ["frame.period", "frame.period_y"].into_iter().find(|key| values.has(key));
        if let Some(key) = period {
            let expected = "storeys whose stiffnesses it scales";
            return Err(values.error(key, expected, "no storey"));
        }
        return Ok(Frame::none());
    }
    let masses_kg = each(storeys, |i| mass_kg(values, &table(i), gravity_m_per_s2))?;
    Ok(Frame {
        stiffnesses_n_per_m: stiffnesses(values, Axis::X, &masses_kg)?,
        damping: damping(values, Axis::X, storeys)?,
        heights_m: heights(values, storeys)?,
        masses_kg,
    })
}

/// A key that speaks of y alone.
pub(super) fn key_of_y(values: &Values, storeys: usize) -> Option<String> {
    let of_storey =
        |i| STIFFNESS.iter().chain(&DAMPING).map(move |name| key(i, &format!("{name}_y")));
    let all = ["block.width_y", "slider.tilt_y", "frame.period_y"].into_iter().map(str::to_owned);
    all.chain((1..=storeys).flat_map(of_storey)).find(|path| values.has(path))
}

/// What is along y, of which `key` speaks; `None` where the table moves along x alone, where none may.
pub(super) fn along_y(
    values: &Values,
    frame: &Frame,
    initial: InitialState,
    key: Option<&str>,
) -> Result<Option<AlongY>, InputError> {
    let masses_kg = &frame.masses_kg;
    if !motion::in_plane(values) {
        match key {
            None => return Ok(None),
            Some(path) if values.has("motion") => return Err(motion::only_in_plane(values, path)),
            // Without a motion of its own the text waits for one.
            Some(_) => {}
        }
    }
    Ok(Some(AlongY {
        stiffnesses_n_per_m: match masses_kg.len() {
            0 => Vec::new(),
            _ => stiffnesses(values, Axis::Y, masses_kg)?,
        },
        damping: match masses_kg.len() {
            0 => Damping::Ratio(0.0),
            n => damping(values, Axis::Y, n)?,
        },
        width_m: values
            .number("block.width_y")
            .or_else(|| values.number("block.width").filter(|_| values.has("structure.along_y"))),
        initial,
    }))
}

/// The path of the storey of that number, from 1.
fn table(storey: usize) -> String {
    format!("storey.{storey}")
}

/// The path of one of its keys.
fn key(storey: usize, name: &str) -> String {
    format!("storey.{storey}.{name}")
}

fn each<T>(
    storeys: usize,
    value: impl FnMut(usize) -> Result<T, InputError>,
) -> Result<Vec<T>, InputError> {
    (1..=storeys).map(value).collect()
}

fn stiffnesses(values: &Values, axis: Axis, masses_kg: &[f64]) -> Result<Vec<f64>, InputError> {
    let storeys = masses_kg.len();
    let suffix = |i: usize| axis.suffix(values, &table(i), &STIFFNESS);
    let frame_period = format!("frame.period{}", axis.suffix(values, "frame", &["period"]));
    let period_s = values.number(&frame_period);
    for (i, name) in (1..=storeys).flat_map(|i| [(i, "frequency"), (i, "period")]) {
        let path = key(i, &format!("{name}{}", suffix(i)));
        if !values.has(&path) || (storeys == 1 && period_s.is_none()) {
            continue;
        }
        let expected = match period_s {
            Some(_) => format!("a stiffness, which {frame_period} scales"),
            None => format!("a stiffness: a {name} belongs to a structure of one storey"),
        };
        return Err(values.wrong(&path, expected));
    }
    if let ([mass_kg], None) = (masses_kg, period_s) {
        return Ok(vec![one_stiffness(values, suffix(1), *mass_kg)?]);
    }
    let path = |i: usize| key(i, &format!("stiffness{}", suffix(i)));
    let relative = each(storeys, |i| values.required(&path(i)))?;
    // Ratios and stiffnesses cannot be told apart once they stand in one list.
    let is_ratio = |i: usize| values.leaf(&path(i)).is_some_and(|k| k.unit.is_empty());
    for i in 1..=storeys {
        if period_s.is_none() && is_ratio(i) {
            let expected = "a stiffness with its unit, such as \"143 kN/m\"";
            return Err(values.wrong(&path(i), expected));
        }
        if is_ratio(i) != is_ratio(1) {
            let expected = "ratios for all storeys or stiffnesses for all";
            return Err(values.wrong(&path(i), expected));
        }
    }
    let Some(period_s) = period_s else { return Ok(relative) };
    let factor = match shear_frame_frequencies(masses_kg, &relative).first() {
        Some(first) => TAU / period_s / first,
        None => f64::NAN,
    };
    let scaled: Vec<f64> = relative.iter().map(|k| k * (factor * factor)).collect();
    if scaled.iter().all(|k| k.is_finite() && *k > 0.0) {
        return Ok(scaled);
    }
    let expected = "a period that gives finite stiffnesses > 0";
    Err(values.wrong(&frame_period, expected))
}

/// The stiffness of a structure of one storey, from whichever key gives it.
fn one_stiffness(values: &Values, suffix: &str, mass_kg: f64) -> Result<f64, InputError> {
    let path = |name: &str| key(1, &format!("{name}{suffix}"));
    let (path, omega) = if let Some(frequency_hz) = values.number(&path("frequency")) {
        (path("frequency"), TAU * frequency_hz)
    } else if let Some(period_s) = values.number(&path("period")) {
        (path("period"), TAU / period_s)
    } else {
        let path = path("stiffness");
        if values.leaf(&path).is_some_and(|leaf| leaf.unit.is_empty()) {
            let expected = "a stiffness with its unit, such as \"143 kN/m\"";
            return Err(values.wrong(&path, expected));
        }
        return values.required(&path);
    };
    derived(values, &path, "stiffness m ω²", mass_kg * omega * omega)
}

fn damping(values: &Values, axis: Axis, storeys: usize) -> Result<Damping, InputError> {
    let path = |i: usize, name: &str| {
        key(i, &format!("{name}{}", axis.suffix(values, &table(i), &DAMPING)))
    };
    let by_ratio = values.has(&path(1, "damping_ratio"));
    let (name, other) =
        if by_ratio { ("damping_ratio", "damper") } else { ("damper", "damping_ratio") };
    let damping = each(storeys, |i| {
        if values.has(&path(i, other)) {
            let expected = format!("a {name}, as for storey 1");
            return Err(values.wrong(&path(i, other), expected));
        }
        values.required(&path(i, name))
    })?;
    if !by_ratio {
        return Ok(Damping::Dampers(damping));
    }
    let first = values.required(&path(1, name))?;
    match damping.iter().position(|ratio| *ratio != first) {
        None => Ok(Damping::Ratio(first)),
        Some(index) => {
            let expected = format!("{first}, the ratio of storey 1: it belongs to every mode");
            Err(values.wrong(&path(index + 1, name), expected))
        }
    }
}

fn heights(values: &Values, storeys: usize) -> Result<Option<Vec<f64>>, InputError> {
    let given = |i: &usize| values.has(&key(*i, "height"));
    let Some(with) = (1..=storeys).find(given) else { return Ok(None) };
    if let Some(without) = (1..=storeys).find(|i| !given(i)) {
        let expected = format!("a height, as for storey {with}, or none at all");
        return Err(values.error(&key(without, "height"), expected, "nothing"));
    }
    Ok(Some(each(storeys, |i| values.required(&key(i, "height")))?))
}
