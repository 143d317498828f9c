//! The ground motions of a plan and their levels.

use super::{Levels, Records, Target};
use crate::error::{InputError, MeasureError};
use crate::input::reader::{LeafValue, Values};
use crate::input::schema::{Range, Special};
use crate::input::tree::{Node, Value};
use crate::motion::intensity::LevelMeasure;
use crate::motion::target::TargetSpectrum;
use crate::record::Units;
use crate::units::Dimension;

/// Reads `[records]`, where it is given.
pub(super) fn read(values: &Values) -> Result<Option<Records>, InputError> {
    if !values.has("records") {
        return Ok(None);
    }
    let texts = |path: &str| values.texts(path).unwrap_or_default();
    let files = texts("records.files");
    if files.is_empty() {
        return Err(values.error("records.files", "at least one file or pattern", "none"));
    }
    let leaf = values.leaf("records.units");
    let units = leaf.and_then(|leaf| Units::parse(&leaf.written));
    let plain = leaf.and_then(|leaf| match leaf.given {
        LeafValue::Unit(unit) => Some(unit.name().to_owned()),
        _ => None,
    });
    let unit_name = units.map(|units| {
        plain.filter(|name| Units::parse(name) == Some(units)).unwrap_or(units.to_string())
    });
    Ok(Some(Records {
        files,
        units,
        unit_name,
        dt_s: values.number("records.dt"),
        channel: values.leaf("records.channel").map(|leaf| leaf.written.clone()),
        second: texts("records.second"),
        together: values.text("records.pairs") != Some("separate"),
        target: target(values)?,
        vertical: texts("records.vertical"),
        vertical_scale: values.number("records.vertical_scale"),
        levels: levels(values)?,
    }))
}

/// The spectrum to which pairs are brought, and the periods over which.
fn target(values: &Values) -> Result<Option<(Target, [f64; 2])>, InputError> {
    let place = "records.periods";
    let periods = values.numbers(place);
    let number = |key: &str| values.number(&format!("records.code_spectrum.{key}"));
    let target = match (values.text("records.target"), number("sds"), number("sd1"), number("tl")) {
        (Some(path), ..) => Target::File(path.to_owned()),
        (_, Some(sds_m_per_s2), Some(sd1_m_per_s2), Some(tl_s)) => {
            Target::Shape(TargetSpectrum::Code { sds_m_per_s2, sd1_m_per_s2, tl_s })
        }
        _ if periods.is_some() => {
            let expected = "target or code_spectrum beside periods";
            return Err(values.error(place, expected, "neither"));
        }
        _ => return Ok(None),
    };
    match periods.as_deref() {
        Some([from_s, to_s]) if from_s < to_s => Ok(Some((target, [*from_s, *to_s]))),
        Some(list) => {
            let expected = "two periods, the shorter first";
            Err(values.error(place, expected, format!("{list:?} s")))
        }
        None => {
            let expected = "the first and last period of the range, [\"0.4 s\", \"4 s\"]";
            Err(values.error(place, expected, "nothing"))
        }
    }
}

fn levels(values: &Values) -> Result<Levels, InputError> {
    let Some(measure) = values.text("records.measure") else {
        let factors = match values.numbers("records.scale") {
            Some(factors) if factors.is_empty() => {
                return Err(values.error("records.scale", "at least one factor", "none"));
            }
            Some(factors) => {
                let twice = (1..factors.len()).find(|&i| factors[..i].contains(&factors[i]));
                if let Some(i) = twice {
                    let (expected, found) = ("factors that differ", factors[i].to_string());
                    return Err(values.error("records.scale", expected, format!("{found} twice")));
                }
                factors
            }
            None => vec![1.0],
        };
        return Ok(Levels::Factors(factors));
    };
    let place = "records.measure";
    let parsed = LevelMeasure::parse(measure).map_err(|error| {
        let MeasureError { expected, found, nearest } = error;
        InputError { nearest, ..values.error(place, expected, format!("\"{found}\"")) }
    })?;
    let dimension = match parsed.unit() {
        "m/s2" => Some(Dimension::Acceleration),
        "m/s" => Some(Dimension::Velocity),
        "m" => Some(Dimension::Length),
        _ => None,
    };
    let Some(dimension) = dimension.filter(|_| parsed.scales()) else {
        let expected = "a measure that grows as the motion does, such as PGA or Sa(1.2 s)";
        return Err(values.wrong(place, expected));
    };
    if parsed.rotated.is_some() && !values.has("records.second") {
        let expected = "the other components, second = \"…\", beside a measure of pairs";
        return Err(values.wrong(place, expected));
    }
    let node = values.special("records.levels");
    let Some(Node { value: Value::List(items), .. }) = node else {
        let expected = Special::Levels.expected();
        return Err(match node {
            Some(node) => values.mistyped("records.levels", node, expected),
            None => values.error("records.levels", expected, "nothing"),
        });
    };
    let mut levels = Vec::with_capacity(items.len());
    for (index, item) in items.iter().enumerate() {
        let place = format!("records.levels.{}", index + 1);
        match values.quantity(&place, item, dimension, Range::Positive)? {
            LeafValue::Number(level) if levels.contains(&level) => {
                return Err(values.mistyped(&place, item, "a level that is not named before"));
            }
            LeafValue::Number(level) => levels.push(level),
            _ => return Err(values.mistyped(&place, item, dimension.with_article())),
        }
    }
    if levels.is_empty() {
        return Err(values.error("records.levels", "at least one level", "none"));
    }
    Ok(Levels::Measure { measure: parsed, levels })
}
