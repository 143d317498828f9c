//! The structure on the block, from its storeys.

use core::f64::consts::TAU;

use super::build::{derived, mass_kg};
use super::reader::Values;
use crate::error::InputError;
use crate::linear::shear_frame_frequencies;
use crate::model::{Damping, Frame};

pub(super) fn frame(values: &Values, gravity_m_per_s2: f64) -> Result<Frame, InputError> {
    let storeys = values.count("storey");
    if storeys == 0 {
        if values.has("frame.period") {
            let expected = "storeys whose stiffnesses it scales";
            return Err(values.error("frame.period", expected, "no storey"));
        }
        return Ok(Frame::none());
    }
    let masses_kg = each(storeys, |i| mass_kg(values, &format!("storey.{i}"), gravity_m_per_s2))?;
    let stiffnesses_n_per_m = stiffnesses(values, &masses_kg)?;
    Ok(Frame {
        damping: damping(values, storeys)?,
        heights_m: heights(values, storeys)?,
        masses_kg,
        stiffnesses_n_per_m,
    })
}

/// The path of a key of the storey of that number, from 1.
fn key(storey: usize, name: &str) -> String {
    format!("storey.{storey}.{name}")
}

fn each<T>(
    storeys: usize,
    value: impl FnMut(usize) -> Result<T, InputError>,
) -> Result<Vec<T>, InputError> {
    (1..=storeys).map(value).collect()
}

fn stiffnesses(values: &Values, masses_kg: &[f64]) -> Result<Vec<f64>, InputError> {
    let storeys = masses_kg.len();
    let frame_period = values.number("frame.period");
    for (i, name) in (1..=storeys).flat_map(|i| [(i, "frequency"), (i, "period")]) {
        let path = key(i, name);
        if !values.has(&path) || (storeys == 1 && frame_period.is_none()) {
            continue;
        }
        let expected = match frame_period {
            Some(_) => "a stiffness, which frame.period scales".to_owned(),
            None => format!("a stiffness: a {name} belongs to a structure of one storey"),
        };
        return Err(values.wrong(&path, expected));
    }
    if let ([mass_kg], None) = (masses_kg, frame_period) {
        return Ok(vec![one_stiffness(values, *mass_kg)?]);
    }
    let relative = each(storeys, |i| values.required(&key(i, "stiffness")))?;
    // Ratios and stiffnesses cannot be told apart once they stand in one list.
    let is_ratio = |i: usize| values.leaf(&key(i, "stiffness")).is_some_and(|k| k.unit.is_empty());
    for i in 1..=storeys {
        if frame_period.is_none() && is_ratio(i) {
            let expected = "a stiffness with its unit, such as \"143 kN/m\"";
            return Err(values.wrong(&key(i, "stiffness"), expected));
        }
        if is_ratio(i) != is_ratio(1) {
            let expected = "ratios for all storeys or stiffnesses for all";
            return Err(values.wrong(&key(i, "stiffness"), expected));
        }
    }
    let Some(period_s) = frame_period else { return Ok(relative) };
    let factor = match shear_frame_frequencies(masses_kg, &relative).first() {
        Some(first) => TAU / period_s / first,
        None => f64::NAN,
    };
    let scaled: Vec<f64> = relative.iter().map(|k| k * (factor * factor)).collect();
    if scaled.iter().all(|k| k.is_finite() && *k > 0.0) {
        return Ok(scaled);
    }
    let expected = "a period that gives finite stiffnesses > 0";
    Err(values.wrong("frame.period", expected))
}

/// The stiffness of a structure of one storey, from whichever key gives it.
fn one_stiffness(values: &Values, mass_kg: f64) -> Result<f64, InputError> {
    let (name, omega) = if let Some(frequency_hz) = values.number(&key(1, "frequency")) {
        ("frequency", TAU * frequency_hz)
    } else if let Some(period_s) = values.number(&key(1, "period")) {
        ("period", TAU / period_s)
    } else {
        let path = key(1, "stiffness");
        if values.leaf(&path).is_some_and(|leaf| leaf.unit.is_empty()) {
            let expected = "a stiffness with its unit, such as \"143 kN/m\"";
            return Err(values.wrong(&path, expected));
        }
        return values.required(&path);
    };
    derived(values, &key(1, name), "stiffness m ω²", mass_kg * omega * omega)
}

fn damping(values: &Values, storeys: usize) -> Result<Damping, InputError> {
    let by_ratio = values.has(&key(1, "damping_ratio"));
    let (name, other) =
        if by_ratio { ("damping_ratio", "damper") } else { ("damper", "damping_ratio") };
    let damping = each(storeys, |i| {
        if values.has(&key(i, other)) {
            let expected = format!("a {name}, as for storey 1");
            return Err(values.wrong(&key(i, other), expected));
        }
        values.required(&key(i, name))
    })?;
    if !by_ratio {
        return Ok(Damping::Dampers(damping));
    }
    let first = values.required(&key(1, name))?;
    match damping.iter().position(|ratio| *ratio != first) {
        None => Ok(Damping::Ratio(first)),
        Some(index) => {
            let expected = format!("{first}, the ratio of storey 1: it belongs to every mode");
            Err(values.wrong(&key(index + 1, name), expected))
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
