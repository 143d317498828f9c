//! The structure on the block, by its modes.

use core::f64::consts::TAU;

use super::build::mass_kg;
use super::motion;
use super::reader::Values;
use crate::error::InputError;
use crate::model::{
    ACROSS, ModeInPlane, ROUNDED_ACROSS, ROUNDED_MASS, Structure, StructureMode, StructurePoint,
    largest_mass_kg,
};
use crate::numerics::algebra::{dot, solution};

/// Part of 1 by which the shape at the point of the normalisation may differ from it.
const ROUNDED_UNIT: f64 = 1e-6;

/// What modes are normalised to.
#[derive(Clone, Copy)]
enum Normalisation {
    /// Unit modal mass: participations `L = φᵀ M 1` in √kg, shapes in 1/√kg.
    Mass,
    /// Unit displacement at a point.
    Point(usize),
}

/// The structure of a model file; `None` where it has none, or storeys.
pub(super) fn structure(
    values: &Values,
    gravity_m_per_s2: f64,
) -> Result<Option<Structure>, InputError> {
    if !values.has("structure") {
        return Ok(None);
    }
    refuse_beside(values)?;
    let mass_kg = mass_kg(values, "structure", gravity_m_per_s2)?;
    let points = points(values)?;
    let normalisation = normalisation(values, &points)?;
    let factor = values.number("structure.period_factor").unwrap_or(1.0);
    let count = values.count("structure.mode");
    if count == 0 {
        let path = if values.has("structure.modes") { "structure.modes" } else { "structure" };
        let expected = "modes: a table [[structure.mode]] for each, or modes = \"modes.csv\" beside a \
                        model file";
        return Err(values.error(path, expected, "none that can be read here"));
    }
    let shapes_y = shapes_y(values, count, points.len())?;
    let shapes = match shapes_y {
        // What takes no part along x has no shape there.
        Some(_) if !is_along_x(values, count) => vec![vec![0.0; points.len()]; count],
        _ => shapes(values, "shape", count, points.len())?,
    };
    let factors = match normalisation {
        Normalisation::Mass => None,
        Normalisation::Point(at) => Some(factors(values, &points, &shapes, at)?),
    };
    let (mut modes, mut sums_kg, mut longest_s) = (Vec::new(), [0.0; 2], f64::INFINITY);
    let mut across_kg = [[0.0; 2]; 2];
    // None where one of the modes is not known along y.
    let mut in_plane = is_along_y(values, count).then(Vec::new);
    for (j, shape) in shapes.iter().enumerate() {
        let table = format!("structure.mode.{}", j + 1);
        let (path, period_s) = period(values, &table)?;
        if period_s > longest_s {
            let expected = format!(
                "a period of at most {longest_s} s, that of the mode before: modes stand in order of \
                 period, the longest first"
            );
            return Err(values.wrong(&path, expected));
        }
        longest_s = period_s;
        let masses_kg = effective_masses(values, &table, (mass_kg, &mut sums_kg), normalisation)?;
        let effective_mass_kg = masses_kg[0];
        let of_oscillator = match &factors {
            Some(factors) => factors[j],
            // L, with the sign of the shape: Σ m φ.
            None => match values.number(&format!("{table}.participation")) {
                Some(participation) => participation,
                None => effective_mass_kg.sqrt().copysign(momentum(&points, shape)),
            },
        };
        let damping_ratio = damping_ratio(values, &table)?;
        let frequency_rad_per_s = TAU / (period_s * factor);
        let plane = shapes_y.as_ref().and_then(|shapes_y| {
            let along_y = values.number(&format!("{table}.participation_y"));
            let factor = factors.as_ref().map(|factors| factors[j]);
            let along_x = factor.or_else(|| values.number(&format!("{table}.participation")));
            let given = [along_x, along_y];
            let unit = factor.map_or(1.0, |factor| effective_mass_kg.sqrt() / factor.abs());
            let both = [shape.as_slice(), &shapes_y[j]];
            let (participation, points) = of_unit_mass(masses_kg, given, (&points, both), unit)?;
            Some(ModeInPlane { frequency_rad_per_s, damping_ratio, participation, points })
        });
        if let Some(ModeInPlane { participation: [x, y], .. }) = &plane {
            for (sum, of) in across_kg.iter_mut().flatten().zip([x * x, x * y, x * y, y * y]) {
                *sum += of;
            }
            if largest_mass_kg(across_kg) > mass_kg * (1.0 + ROUNDED_ACROSS) {
                let found = format!("{} kg with this mode", largest_mass_kg(across_kg));
                return Err(values.error(&table, ACROSS, found));
            }
        }
        in_plane = in_plane.zip(plane).map(|(mut all, plane)| {
            all.push(plane);
            all
        });
        // A mode that takes no part moves nothing.
        if effective_mass_kg > 0.0 {
            modes.push(StructureMode {
                frequency_rad_per_s,
                damping_ratio,
                effective_mass_kg,
                points: shape.iter().map(|shape| shape * of_oscillator).collect(),
            });
        }
    }
    let in_plane = match as_x(values, count)? {
        true => modes.iter().flat_map(StructureMode::along_both).collect(),
        false => in_plane.unwrap_or_default(),
    };
    if in_plane.is_empty() && motion::in_plane(values) {
        return Err(unknown_in_plane(values, count));
    }
    if modes.is_empty() && in_plane.iter().all(|mode| mode.participation == [0.0; 2]) {
        let expected = "a mode with an effective mass or a participation that is not 0";
        return Err(values.error("structure.mode", expected, "none"));
    }
    Ok(Some(Structure { mass_kg, modes, in_plane, points }))
}

/// A structure that a motion in two directions needs to be known along both.
fn unknown_in_plane(values: &Values, modes: usize) -> InputError {
    let keys = ["motion.record_y", "motion.sine_y"];
    let path = keys.into_iter().find(|path| values.has(path)).unwrap_or("structure.mode");
    let expected = "modes that say what they do along y: participation_y of each mode, and the shape \
                    NAME_y beside NAME_x at every point";
    let has = |j: usize, axis: &str| {
        let keys = ["effective_mass", "effective_mass_ratio"];
        keys.iter().any(|key| values.has(&format!("structure.mode.{j}.{key}{axis}")))
    };
    let mut points = 1..=values.count("structure.point");
    let is_known = is_along_y(values, modes)
        && points.all(|i| values.has(&format!("structure.point.{i}.shape_y")));
    let found = match (1..=modes).find(|j| has(*j, "") || has(*j, "_y")) {
        Some(j) if is_known => format!(
            "an effective mass of mode {j}, which does not tell the sign of its participations along x and y"
        ),
        _ => "a structure known along x alone".to_owned(),
    };
    values.error(path, expected, found)
}

/// Whether the structure is along y as along x, of which nothing else may be said then.
fn as_x(values: &Values, modes: usize) -> Result<bool, InputError> {
    if !values.has("structure.along_y") {
        return Ok(false);
    }
    let points = 1..=values.count("structure.point");
    let of_points = points.map(|i| format!("structure.point.{i}.shape_y"));
    match keys_of_y(modes).chain(of_points).find(|path| values.has(path)) {
        Some(path) => {
            let expected = "nothing of y in modes and points, which are along y as along x by structure.along_y";
            Err(values.error(&path, expected, &path))
        }
        None => Ok(true),
    }
}

/// Whether a mode says what it does along y.
fn is_along_y(values: &Values, modes: usize) -> bool {
    keys_of_y(modes).any(|path| values.has(&path))
}

/// The keys by which modes say what they do along y.
fn keys_of_y(modes: usize) -> impl Iterator<Item = String> {
    let keys = ["participation_y", "effective_mass_y", "effective_mass_ratio_y"];
    (1..=modes).flat_map(move |j| keys.map(|key| format!("structure.mode.{j}.{key}")))
}

/// Whether a mode or a point says what it does along x.
fn is_along_x(values: &Values, modes: usize) -> bool {
    let keys = ["participation", "effective_mass", "effective_mass_ratio"];
    let of_mode = |j: usize, key: &&str| values.has(&format!("structure.mode.{j}.{key}"));
    let points = 1..=values.count("structure.point");
    (1..=modes).any(|j| keys.iter().any(|key| of_mode(j, key)))
        || points.into_iter().any(|i| values.has(&format!("structure.point.{i}.shape")))
}

/// Effective masses of a mode along x and y, added to the sums, which the mass of the structure bounds.
fn effective_masses(
    values: &Values,
    table: &str,
    (mass_kg, sums_kg): (f64, &mut [f64; 2]),
    normalisation: Normalisation,
) -> Result<[f64; 2], InputError> {
    let mut masses_kg = [0.0; 2];
    let mut is_given = false;
    for (k, axis) in ["", "_y"].into_iter().enumerate() {
        let found = effective_mass(values, (table, axis), mass_kg, normalisation)?;
        let Some((path, effective_mass_kg)) = found else { continue };
        (is_given, masses_kg[k]) = (true, effective_mass_kg);
        sums_kg[k] += effective_mass_kg;
        if sums_kg[k] > mass_kg * (1.0 + ROUNDED_MASS) {
            let expected =
                format!("effective masses that sum to at most the structure's {mass_kg} kg");
            return Err(values.error(&path, expected, format!("{} kg with this mode", sums_kg[k])));
        }
    }
    if !is_given {
        return Err(none_of_mode(values, (table, ""), normalisation));
    }
    Ok(masses_kg)
}

/// Participations and shapes of unit modal mass along x and y. `L` is the root of the effective mass with the sign
/// of the participation that is given, else of the momentum `Σ m φ` of the points' masses; without both it is positive
/// for a mode that moves along one axis alone, and `None` for one that moves along both, whose signs belong together.
/// `None` too where the unit of the shapes is not known.
fn of_unit_mass(
    masses_kg: [f64; 2],
    given: [Option<f64>; 2],
    (points, shapes): (&[StructurePoint], [&[f64]; 2]),
    unit: f64,
) -> Option<([f64; 2], Vec<[f64; 2]>)> {
    let all_have_mass = !points.is_empty() && points.iter().all(|point| point.mass_kg.is_some());
    let along = |axis: usize| {
        if masses_kg[axis] == 0.0 {
            return Some(0.0);
        }
        let by_masses = || all_have_mass.then(|| momentum(points, shapes[axis]));
        let alone = (masses_kg[1 - axis] == 0.0).then_some(1.0);
        Some(masses_kg[axis].sqrt().copysign(given[axis].or_else(by_masses).or(alone)?))
    };
    let participation = [along(0)?, along(1)?];
    let of_points = shapes[0].iter().zip(shapes[1]).map(|(x, y)| [x / unit, y / unit]);
    (unit.is_finite() && unit > 0.0).then(|| (participation, of_points.collect()))
}

/// Refuses what a structure by its modes cannot have.
fn refuse_beside(values: &Values) -> Result<(), InputError> {
    let refuse = |path: &str, expected: &str| Err(values.error(path, expected, path));
    for path in ["initial.storey_displacement", "initial.storey_velocity"] {
        if values.has(path) {
            return refuse(path, "no state of storeys: a structure by its modes starts at rest");
        }
    }
    if values.text("analysis.method") == Some("stepwise") {
        let expected = "the exact method, which a structure by its modes needs";
        return refuse("analysis.method", expected);
    }
    Ok(())
}

fn points(values: &Values) -> Result<Vec<StructurePoint>, InputError> {
    let mut points: Vec<StructurePoint> = Vec::new();
    for i in 1..=values.count("structure.point") {
        let path = |key: &str| format!("structure.point.{i}.{key}");
        let name = values.text(&path("name")).unwrap_or_default().to_owned();
        if points.iter().any(|point| point.name.to_lowercase() == name.to_lowercase()) {
            return Err(values.wrong(&path("name"), "a name that no other point has"));
        }
        let [height_m, mass_kg] = ["height", "mass"].map(|key| values.number(&path(key)));
        points.push(StructurePoint { name, height_m, mass_kg });
    }
    Ok(points)
}

fn normalisation(values: &Values, points: &[StructurePoint]) -> Result<Normalisation, InputError> {
    let path = "structure.normalisation";
    let Some(name) = values.text(path).filter(|name| *name != "mass") else {
        return Ok(Normalisation::Mass);
    };
    let is_named = |point: &StructurePoint| point.name.to_lowercase() == name.to_lowercase();
    match points.iter().position(is_named) {
        Some(place) => Ok(Normalisation::Point(place)),
        None => Err(values.wrong(path, "\"mass\" or the name of a point")),
    }
}

/// Shapes along y, mode by mode; `None` unless every point has one.
fn shapes_y(
    values: &Values,
    modes: usize,
    points: usize,
) -> Result<Option<Vec<Vec<f64>>>, InputError> {
    let given = (1..=points).filter(|i| values.has(&format!("structure.point.{i}.shape_y")));
    if given.count() < points {
        return Ok(None);
    }
    shapes(values, "shape_y", modes, points).map(Some)
}

/// Shapes by a key of the points, mode by mode.
fn shapes(
    values: &Values,
    key: &str,
    modes: usize,
    points: usize,
) -> Result<Vec<Vec<f64>>, InputError> {
    let mut shapes = vec![Vec::with_capacity(points); modes];
    for i in 1..=points {
        let path = format!("structure.point.{i}.{key}");
        let of_modes = values.numbers(&path).unwrap_or_default();
        if of_modes.len() != modes {
            let expected = format!("one value a mode, {modes} in all");
            return Err(values.error(&path, expected, of_modes.len().to_string()));
        }
        shapes.iter_mut().zip(of_modes).for_each(|(shape, value)| shape.push(value));
    }
    Ok(shapes)
}

fn period(values: &Values, table: &str) -> Result<(String, f64), InputError> {
    let path = format!("{table}.period");
    if let Some(period_s) = values.number(&path) {
        return Ok((path, period_s));
    }
    let path = format!("{table}.frequency");
    values.required(&path).map(|frequency_hz| (path, 1.0 / frequency_hz))
}

fn damping_ratio(values: &Values, table: &str) -> Result<f64, InputError> {
    match values.number("structure.damping_ratio") {
        Some(ratio) => Ok(ratio),
        None => values.required(&format!("{table}.damping_ratio")),
    }
}

/// The effective mass of a mode along x, or with `_y` along y, and the path of the key that gives it; `None`
/// where no key does.
fn effective_mass(
    values: &Values,
    (table, axis): (&str, &str),
    mass_kg: f64,
    normalisation: Normalisation,
) -> Result<Option<(String, f64)>, InputError> {
    let of = |key: &str| {
        let path = format!("{table}.{key}{axis}");
        values.number(&path).map(|number| (path, number))
    };
    let direct = of("effective_mass")
        .or_else(|| of("effective_mass_ratio").map(|(path, ratio)| (path, ratio * mass_kg)));
    let participation = of("participation");
    match (direct, participation, normalisation) {
        (Some(_), Some((path, _)), Normalisation::Mass) => {
            let expected = "only one of effective_mass, effective_mass_ratio, participation where \
                            modes have unit mass";
            Err(values.wrong(&path, expected))
        }
        (None, Some((path, l)), Normalisation::Mass) => Ok(Some((path, l * l))),
        (None, Some(_), _) => Err(none_of_mode(values, (table, axis), normalisation)),
        (found, ..) => Ok(found),
    }
}

/// A mode of which no key says how it takes part along an axis.
fn none_of_mode(
    values: &Values,
    (table, axis): (&str, &str),
    normalisation: Normalisation,
) -> InputError {
    let expected = match normalisation {
        Normalisation::Mass => {
            "one of the keys effective_mass, effective_mass_ratio, participation".to_owned()
        }
        Normalisation::Point(_) => format!("effective_mass{axis} or effective_mass_ratio{axis}"),
    };
    values.error(table, expected, "none")
}

/// `Σ m φ` over the points, where all have a mass; else 1.
fn momentum(points: &[StructurePoint], shape: &[f64]) -> f64 {
    let masses_kg: Option<Vec<f64>> = points.iter().map(|point| point.mass_kg).collect();
    masses_kg.filter(|m| !m.is_empty()).map_or(1.0, |m| dot(&m, shape))
}

/// Participation factors `Γ` of shapes that are 1 at a point: as given; from the points' masses,
/// `Γ = Σ m φ/Σ m φ²`; or from `Σ Γ φ = 1` at every point, where no mode is missing.
fn factors(
    values: &Values,
    points: &[StructurePoint],
    shapes: &[Vec<f64>],
    at: usize,
) -> Result<Vec<f64>, InputError> {
    for (j, shape) in shapes.iter().enumerate() {
        if (shape[at] - 1.0).abs() > ROUNDED_UNIT {
            let path = format!("structure.point.{}.shape.{}", at + 1, j + 1);
            return Err(values.wrong(&path, "1, to which modes are normalised at this point"));
        }
    }
    let given = |j: usize| values.number(&format!("structure.mode.{}.participation", j + 1));
    if let Some(factors) = (0..shapes.len()).map(given).collect() {
        return Ok(factors);
    }
    let masses_kg: Option<Vec<f64>> = points.iter().map(|point| point.mass_kg).collect();
    if let Some(m) = masses_kg {
        let of = |shape: &Vec<f64>| {
            let weighted: Vec<f64> = m.iter().zip(shape).map(|(m, shape)| m * shape).collect();
            weighted.iter().sum::<f64>() / dot(&weighted, shape)
        };
        return Ok(shapes.iter().map(of).collect());
    }
    // Rows of Φᵀ; where there are more points than modes, ΦᵀΦ Γ = Φᵀ1.
    let square = shapes.len() == points.len();
    let matrix = (0..shapes.len()).map(|i| match square {
        true => shapes.iter().map(|shape| shape[i]).collect(),
        false => shapes.iter().map(|shape| dot(&shapes[i], shape)).collect(),
    });
    let right = shapes.iter().map(|shape| if square { 1.0 } else { shape.iter().sum() });
    let solved = solution(matrix.collect(), right.collect()).filter(|factors| {
        (0..points.len()).all(|i| {
            let sum: f64 = factors.iter().zip(shapes).map(|(factor, of)| factor * of[i]).sum();
            (sum - 1.0).abs() < ROUNDED_UNIT
        })
    });
    solved.ok_or_else(|| {
        let expected = "beside it the mass of every point or the participation factor of every mode, \
                        since the points do not show all modes";
        values.error("structure.normalisation", expected, "neither")
    })
}
