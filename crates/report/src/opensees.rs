//! A model as a script for OpenSees: what engineers use today, with the number that stick needs there.

use core::fmt::Write;

use slipstick::error::ChoiceError;
use slipstick::model::{Damping, Frame, InitialState, Model, StopKind};
use slipstick::motion::GroundMotion;
use slipstick::slider::{Direction, RateCurve, Surface, SurfacesInSeries};
use slipstick::solver::shear_frame_modes;

// Functions of the script, below the model's numbers: those of the slider, of what presses it down, of
// stops and contents, and of the analysis.
const CONSTANT: &str = include_str!("opensees/constant.py");
const BEARING: &str = include_str!("opensees/bearing.py");
const TRIPLE: &str = include_str!("opensees/triple.py");
const WEIGHT: &str = include_str!("opensees/weight.py");
const ELASTIC_STOP: &str = include_str!("opensees/elastic_stop.py");
const RIGID_STOP: &str = include_str!("opensees/rigid_stop.py");
const CONTENTS: &str = include_str!("opensees/contents.py");
const CONTENTS_BEARING: &str = include_str!("opensees/contents_bearing.py");
const ANALYSIS: &str = include_str!("opensees/analysis.py");

/// Coefficient of friction of a surface that never slides.
const STUCK: f64 = 10.0;

/// Travel without an end in m, and speed that is not reached in m/s.
const ENDLESS: f64 = 1e3;

/// What stands for the slider.
enum SliderElement {
    /// Friction of constant force: a uniaxial material.
    Constant,
    /// Friction that follows speed or normal force: `singleFPBearing` or `flatSliderBearing`.
    Bearing,
    /// Pendulums in series: `TripleFrictionPendulum`.
    Triple,
}

/// Displacement over which friction builds up in a script where nobody says another, in m.
const YIELD_M: f64 = 1e-5;

/// `μ_s N/10 µm`: the stiffness that stands for stick where nobody says another, in N/m.
#[must_use]
pub fn stiffness_n_per_m(model: &Model) -> f64 {
    let [positive, negative] = model.static_friction();
    positive.max(negative) * model.normal_n() / YIELD_M
}

/// A script for OpenSeesPy, with stick as an elastic spring of stiffness `k_init_n_per_m` in series with
/// the friction, which is what its materials and elements know.
///
/// Run as a program it prints peak and residual sliding displacement; its function `analyse` returns times
/// and sliding displacements at the samples of the motion. A jump of the motion is its right side.
///
/// - Constant friction: `ElasticPP` beside a linear spring, pendulum and damper. Damping by ratio is that
///   of every fixed-base mode, as dashpots between all floors.
/// - Two horizontal directions: the same bearings with `Coulomb` in three dimensions.
/// - Friction by speed: `VelDependent` or `VelDepMultiLinear` in a `singleFPBearing` with a radius, else in
///   a `flatSliderBearing`; under vertical motion `Coulomb` in these, with the true `N(t)/R`.
/// - Two or three pendulums in series: `TripleFrictionPendulum`, which yields at `k_init_n_per_m` too.
/// - Elastic stops: `ElasticPPGap`. Rigid ones have no counterpart; `ViscoelasticGap` of the stiffness
///   `k_init_n_per_m` with the damper of their restitution tends to them.
/// - Contents: `ElasticPP`, under vertical motion `flatSliderBearing`.
///
/// # Errors
/// [`ChoiceError`] for what such a model cannot express: static friction above the kinetic one at rest,
/// friction of 0, friction by pressure under vertical motion, friction by speed or under vertical motion that is not alike both ways, flat surfaces or
/// more than three in series, stops with a damper that cannot pull, a slope, an initial state, vertical
/// motion that lifts the block; and unless the stiffness is finite and > 0.
pub fn script(
    name: &str,
    model: &Model,
    motion: &GroundMotion,
    k_init_n_per_m: f64,
) -> Result<String, ChoiceError> {
    let element = expressible(model, motion)?;
    if !(k_init_n_per_m.is_finite() && k_init_n_per_m > 0.0) {
        return Err(refused("k_init", "a stiffness > 0 N/m", &format!("{k_init_n_per_m} N/m")));
    }
    let (slider, frame) = (model.slider(), model.frame());
    let vertical = motion.vertical_m_per_s2();
    let along_y = motion.horizontal_y_m_per_s2();
    let (times_s, values) = right_sides(motion, motion.horizontal_m_per_s2());
    let mut text = String::new();
    let title: String = name.chars().filter(|c| !c.is_control() && !"\"\\".contains(*c)).collect();
    let mut line = |args: core::fmt::Arguments<'_>| {
        // Writing to a string cannot fail.
        let _ = text.write_fmt(args);
        text.push('\n');
    };
    line(format_args!("\"\"\"{title}: the sliding model in OpenSeesPy, SI units."));
    line(format_args!(
        "\nStick is an elastic spring of the stiffness K_INIT, a number that physics does not have:\n\
         the answer depends on it, and the larger it is the less readily the steps converge.\n\"\"\"\n"
    ));
    line(format_args!("import openseespy.opensees as ops\n"));
    line(format_args!("K_INIT = {k_init_n_per_m:?}  # N/m, stands for stick"));
    match element {
        SliderElement::Constant => constant(model, &mut line),
        SliderElement::Bearing => {
            bearing(model, [vertical, along_y].map(|a| a.is_some()), &mut line)
        }
        SliderElement::Triple => triple(slider.series(), &mut line),
    }
    let pendulum = slider.pendulum_radius_m(vertical.is_some() || along_y.is_some()).is_some();
    let stiffness_n_per_m = if pendulum { 0.0 } else { model.slider_stiffness_n_per_m() };
    line(format_args!(
        "SPRING, DAMPER = {stiffness_n_per_m:?}, {:?}  # of the slider, N/m and N s/m",
        slider.damper_n_s_per_m
    ));
    let mut functions = String::new();
    functions.push_str(match element {
        SliderElement::Constant => CONSTANT,
        SliderElement::Bearing => BEARING,
        SliderElement::Triple => TRIPLE,
    });
    let mut parts = Vec::new();
    if let Some(stop) = model.stop() {
        let [positive, negative] = stop.gap_m;
        let gaps = [positive.map(|gap_m| (1, gap_m)), negative.map(|gap_m| (-1, gap_m))];
        let gaps: Vec<(i32, f64)> = gaps.into_iter().flatten().collect();
        line(format_args!("STOPS = {gaps:?}  # side, gap in m"));
        functions.push_str(match stop.kind {
            StopKind::Elastic { stiffness_n_per_m, .. } => {
                line(format_args!("STOP = {stiffness_n_per_m:?}  # N/m"));
                ELASTIC_STOP
            }
            StopKind::Rigid { restitution } => {
                let ratio = rebound_damping(restitution);
                line(format_args!(
                    "STOP_DAMPING = {ratio:?}  # of critical: restitution {restitution:?}"
                ));
                RIGID_STOP
            }
        });
        parts.push("stops");
    }
    if !model.contents().is_empty() {
        line(format_args!("CONTENTS = [  # floor, kg, friction"));
        for contents in model.contents() {
            let (floor, mass_kg) = (contents.floor, contents.mass_kg);
            line(format_args!("    ({floor}, {mass_kg:?}, {:?}),", contents.kinetic_friction));
        }
        line(format_args!("]"));
        functions.push_str(if vertical.is_some() { CONTENTS_BEARING } else { CONTENTS });
        parts.push("contents");
    }
    line(format_args!("GRAVITY = {:?}  # m/s2", model.gravity_m_per_s2()));
    line(format_args!("MASSES = {:?}  # kg: the block, then the floors", masses(model)));
    let frames = match along_y {
        None => vec![frame.clone()],
        Some(_) => vec![frame.clone(), frame_along_y(model)],
    };
    let directions: Vec<usize> = (1..=frames.len()).collect();
    line(format_args!("HORIZONTAL = {directions:?}  # directions of the motion: x, perhaps y"));
    let stiffnesses: Vec<&[f64]> = frames.iter().map(|f| &f.stiffnesses_n_per_m[..]).collect();
    line(format_args!("STOREYS = {stiffnesses:?}  # along each, N/m"));
    line(format_args!("# Dashpots along each between two of the masses, N s/m\nDASHPOTS = ["));
    for frame in &frames {
        line(format_args!("    ["));
        for (i, j, c) in dashpots(frame) {
            line(format_args!("        ({i}, {j}, {c:?}),"));
        }
        line(format_args!("    ],"));
    }
    line(format_args!("]"));
    if !matches!(element, SliderElement::Constant) {
        // The weight of contents without vertical motion is the block's to carry.
        let own = model.contents().iter().filter(|_| vertical.is_some());
        let own: Vec<f64> = own.map(|contents| contents.mass_kg).collect();
        let first = 2 + masses(model).len();
        let mut pressed = vec![(2, model.total_mass_kg())];
        pressed.extend(own.into_iter().enumerate().map(|(i, mass_kg)| (first + i, mass_kg)));
        line(format_args!("PRESSED = {pressed:?}  # node, kg that press on what it stands on"));
        line(format_args!("WEIGHT = GRAVITY * PRESSED[0][1]  # N"));
        let values = vertical.map_or_else(String::new, |a| listed(&right_sides(motion, a).1));
        line(format_args!("VERTICAL = [{values}]  # of the ground, m/s2"));
        functions.push_str(WEIGHT);
    }
    match motion.dt_s() {
        Some(dt_s) => {
            line(format_args!("TIMES = [i * {dt_s:?} for i in range({})]  # s", times_s.len()))
        }
        None => line(format_args!("TIMES = [{}]  # s", listed(&times_s))),
    }
    line(format_args!("ACCELERATION = [  # of the ground, m/s2, along each"));
    let along_y = along_y.map(|y| right_sides(motion, y).1);
    for values in core::iter::once(&values).chain(&along_y) {
        line(format_args!("[{}],", listed(values)));
    }
    line(format_args!("]"));
    text.push_str(&functions);
    let _ = write!(text, "\n\nPARTS = [{}]\n", parts.join(", "));
    text.push_str(ANALYSIS);
    Ok(text)
}

/// Numbers of a slider of constant friction force.
fn constant(model: &Model, line: &mut impl FnMut(core::fmt::Arguments<'_>)) {
    let [positive_n, negative_n] = model.kinetic_friction().map(|mu| mu * model.weight_n());
    line(format_args!("NDM, NDF, TOLERANCE = 1, 1, 1e-11"));
    line(format_args!("FRICTION = [{positive_n:?}, {negative_n:?}]  # N, towards +x and -x"));
}

/// Numbers of a bearing.
fn bearing(
    model: &Model,
    [vertical, in_plane]: [bool; 2],
    line: &mut impl FnMut(core::fmt::Arguments<'_>),
) {
    let [ndm, ndf] = if in_plane { [3, 6] } else { [2, 3] };
    line(format_args!("NDM, NDF, TOLERANCE = {ndm}, {ndf}, 1e-11"));
    match model.slider().rate().map(|rate| (rate.curve(), rate.factor(Direction::Positive))) {
        None => line(format_args!("FRICTION = \"Coulomb\", 1, {:?}", model.kinetic_friction()[0])),
        Some((RateCurve::Exponential { slow, fast, rate_s_per_m }, factor)) => {
            let [slow, fast] = [slow, fast].map(|mu| factor * mu);
            line(format_args!(
                "FRICTION = \"VelDependent\", 1, {slow:?}, {fast:?}, {rate_s_per_m:?}  # slow, fast, s/m"
            ));
        }
        Some((RateCurve::Pieces { speeds_m_per_s, coefficients }, factor)) => {
            let mut coefficients: Vec<f64> = coefficients.iter().map(|mu| factor * mu).collect();
            let mut speeds = speeds_m_per_s.clone();
            // Beyond the last point the line would go on.
            speeds.push(ENDLESS + speeds.last().copied().unwrap_or(0.0));
            coefficients.extend(coefficients.last().copied());
            line(format_args!("SPEEDS = {speeds:?}  # m/s"));
            line(format_args!("COEFFICIENTS = {coefficients:?}"));
            line(format_args!(
                "FRICTION = \"VelDepMultiLinear\", 1, \"-vel\", *SPEEDS, \"-frn\", *COEFFICIENTS"
            ));
        }
    }
    match model.slider().pendulum_radius_m(vertical || in_plane) {
        Some(radius_m) => line(format_args!(
            "BEARING = \"singleFPBearing\", 1, 1, 2, 1, {radius_m:?}  # radius in m"
        )),
        None => line(format_args!("BEARING = \"flatSliderBearing\", 1, 1, 2, 1")),
    }
}

/// Numbers of pendulums in series, the one that slides first being the element's inner ones; a third that
/// is not there never slides.
///
/// The element's effective lengths are `L1 = R/2` of the first and `R + L1` of the others, and its ends
/// of travel `2 (d1 + d3 L1/L3)`, `d2 (1 − L1/L2)` and `d3 (1 − L1/L3)`.
fn triple(series: Option<&SurfacesInSeries>, line: &mut impl FnMut(core::fmt::Arguments<'_>)) {
    let surfaces = series.map_or(&[][..], SurfacesInSeries::surfaces);
    let of =
        |s: &Surface| [s.friction, s.radius_m.unwrap_or(ENDLESS), s.travel_m.unwrap_or(ENDLESS)];
    let mut all: Vec<[f64; 3]> = surfaces.iter().map(of).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all.resize(3, [STUCK, 1.0, 1.0]);
    let l1 = 0.5 * all[0][1];
    let [l2, l3] = [all[1][1] + l1, all[2][1] + l1];
    let [d2, d3] = [all[1][2] / (1.0 - l1 / l2), all[2][2] / (1.0 - l1 / l3)];
    let d1 = 0.5 * all[0][2] - d3 * l1 / l3;
    line(format_args!("NDM, NDF, TOLERANCE = 3, 6, 1e-9"));
    line(format_args!(
        "FRICTION = {:?}  # inner, then outer surfaces",
        [0, 1, 2].map(|i| all[i][0])
    ));
    line(format_args!("LENGTHS = {:?}  # m", [l1, l2, l3]));
    line(format_args!("TRAVELS = {:?}  # m", [d1, d2, d3]));
}

/// Damping ratio of a spring and a damper off which a mass rebounds with a restitution, where both push
/// and pull until it is back: `e = exp(−π ξ/√(1 − ξ²))`.
fn rebound_damping(restitution: f64) -> f64 {
    if restitution == 0.0 {
        return 1.0;
    }
    let decrement = restitution.ln().abs();
    decrement / core::f64::consts::PI.hypot(decrement)
}

/// Masses of block and floors in kg.
fn masses(model: &Model) -> Vec<f64> {
    let block = core::iter::once(model.block().mass_kg);
    block.chain(model.frame().masses_kg.iter().copied()).collect()
}

/// The frame along y.
fn frame_along_y(model: &Model) -> Frame {
    let along_y = model.along_y();
    let (stiffnesses_n_per_m, damping) = (along_y.stiffnesses_n_per_m, along_y.damping);
    Frame { stiffnesses_n_per_m, damping, ..model.frame().clone() }
}

/// Dashpots that make the frame's damping: between masses `i < j`, 0 the block, in N s/m.
///
/// For relative floor velocities the matrix is `C = M Φ diag(2ξω) Φᵀ M`: a dashpot `−C_ij` between two
/// floors, and `Σ_j C_ij` between a floor and the block.
fn dashpots(frame: &Frame) -> Vec<(usize, usize, f64)> {
    let n = frame.masses_kg.len();
    let all = match &frame.damping {
        Damping::Dampers(dampers) => {
            dampers.iter().enumerate().map(|(i, c)| (i, i + 1, *c)).collect::<Vec<_>>()
        }
        Damping::Ratio(ratio) => {
            let modes = shear_frame_modes(&frame.masses_kg, &frame.stiffnesses_n_per_m);
            let c = |i: usize, j: usize| -> f64 {
                let of = |k: usize| {
                    2.0 * ratio
                        * modes.frequencies_rad_per_s[k]
                        * modes.shapes[i * n + k]
                        * modes.shapes[j * n + k]
                };
                (0..n).map(of).sum::<f64>() * frame.masses_kg[i] * frame.masses_kg[j]
            };
            let to_block = (0..n).map(|i| (0, i + 1, (0..n).map(|j| c(i, j)).sum::<f64>()));
            let between = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            let between = between.map(|(i, j)| (i + 1, j + 1, -c(i, j)));
            to_block.chain(between).collect()
        }
    };
    all.into_iter().filter(|(_, _, c)| *c != 0.0).collect()
}

/// Times and values of a component with the right side of every jump alone.
fn right_sides(motion: &GroundMotion, values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let times_s = motion.times_s();
    let last = |i: &usize| times_s.get(i + 1).is_none_or(|next| *next > times_s[*i]);
    (0..times_s.len()).filter(last).map(|i| (times_s[i], values[i])).unzip()
}

/// Numbers that read back as the same.
fn listed(values: &[f64]) -> String {
    let mut text = String::new();
    for row in values.chunks(6) {
        text.push_str("\n    ");
        for value in row {
            let _ = write!(text, "{value:?}, ");
        }
        text.truncate(text.trim_end().len());
    }
    text.push('\n');
    text
}

fn refused(what: &str, expected: &str, found: &str) -> ChoiceError {
    let [what, expected, found] = [what, expected, found].map(str::to_owned);
    ChoiceError { what, expected, found, nearest: None }
}

/// What stands for the slider.
///
/// # Errors
/// [`ChoiceError`] for the first thing that the script's model does not have.
fn expressible(model: &Model, motion: &GroundMotion) -> Result<SliderElement, ChoiceError> {
    let slider = model.slider();
    let vertical = motion.vertical_m_per_s2();
    let no = |what: &str, expected: &str, found: &str| Err(refused(what, expected, found));
    if let Some(exponent) = slider.pressure_exponent(vertical.is_some()) {
        let expected =
            "0 under vertical motion: OpenSees' friction models follow the pressure by other laws";
        return no("slider.pressure.exponent", expected, &exponent.to_string());
    }
    let element = if let Some(series) = slider.series() {
        in_series(series)?;
        SliderElement::Triple
    } else {
        one_coefficient(model)?;
        let in_plane = motion.horizontal_y_m_per_s2().is_some();
        if slider.rate().is_some() || vertical.is_some() || in_plane {
            let [positive, negative] = model.kinetic_friction();
            let rate = slider.rate();
            let sides = [Direction::Positive, Direction::Negative];
            let [one, other] =
                rate.map_or([positive, negative], |rate| sides.map(|d| rate.factor(d)));
            if one != other {
                let expected = "alike both ways: OpenSees' friction models have no direction";
                return no("slider.kinetic_friction", expected, &format!("{one} and {other}"));
            }
            SliderElement::Bearing
        } else {
            SliderElement::Constant
        }
    };
    if let Some(stop) = model.stop()
        && let StopKind::Elastic { damper_n_s_per_m, .. } = stop.kind
        && damper_n_s_per_m > 0.0
    {
        return no(
            "slider.stop.damper",
            "none: a damper behind a gap pulls in OpenSees, where a pad lets go",
            &format!("{damper_n_s_per_m} N s/m"),
        );
    }
    for (i, contents) in model.contents().iter().enumerate() {
        let (fixed, kinetic) = (contents.static_friction, contents.kinetic_friction);
        if fixed != kinetic {
            let expected = "as much as kinetic_friction: OpenSees' material has one coefficient";
            let what = format!("contents.{}.static_friction", i + 1);
            return no(&what, expected, &format!("{fixed} and {kinetic}"));
        }
        if !(kinetic > 0.0) {
            let what = format!("contents.{}.kinetic_friction", i + 1);
            return no(&what, "more than 0", &kinetic.to_string());
        }
    }
    if !model.contents().is_empty() && vertical.is_some() && slider.series().is_some() {
        let expected = "none beside surfaces in series under vertical motion";
        return no("contents", expected, "contents");
    }
    for (key, tilt_rad) in [("slider.tilt", slider.tilt_rad), ("slider.tilt_y", slider.tilt_y_rad)]
    {
        if tilt_rad != 0.0 {
            return no(key, "a level surface", &format!("{tilt_rad} rad"));
        }
    }
    let start_y = model.along_y().initial;
    let rests = motion.horizontal_y_m_per_s2().is_none() || start_y == InitialState::rest();
    if *model.initial() != InitialState::rest() || !rests {
        return no("initial", "a start at rest", "an initial state");
    }
    let least = vertical.map_or(0.0, |a| a.iter().copied().fold(0.0, f64::min));
    if !(least > -model.gravity_m_per_s2()) {
        let expected =
            "a vertical component that does not lift the block, which leaves a bearing loose";
        return no("motion", expected, &format!("{least} m/s2"));
    }
    Ok(element)
}

/// # Errors
/// [`ChoiceError`] for surfaces that `TripleFrictionPendulum` does not have.
fn in_series(series: &SurfacesInSeries) -> Result<(), ChoiceError> {
    let no = |what: &str, expected: &str, found: &str| Err(refused(what, expected, found));
    if series.static_ratio() != 1.0 {
        let expected = "1: OpenSees' friction models have no static friction";
        return no("slider.static_ratio", expected, &series.static_ratio().to_string());
    }
    let surfaces = series.surfaces();
    if surfaces.len() > 3 {
        let expected = "at most three, as in TripleFrictionPendulum";
        return no("slider.surface", expected, &surfaces.len().to_string());
    }
    match surfaces.iter().position(|surface| surface.radius_m.is_none()) {
        None => Ok(()),
        Some(i) => {
            let expected = "a radius: TripleFrictionPendulum has no flat surface";
            no(&format!("slider.surface.{}", i + 1), expected, "a flat surface")
        }
    }
}

/// # Errors
/// [`ChoiceError`] for friction of which OpenSees needs a second coefficient.
fn one_coefficient(model: &Model) -> Result<(), ChoiceError> {
    let no = |what: &str, expected: &str, found: &str| Err(refused(what, expected, found));
    let (fixed, kinetic) = (model.static_friction(), model.kinetic_friction());
    let rate = model.slider().rate();
    let at_rest = rate.map_or(kinetic, |rate| {
        [Direction::Positive, Direction::Negative].map(|direction| rate.at(0.0, direction))
    });
    if fixed != at_rest {
        let expected = match rate {
            None => "as much as kinetic_friction: OpenSees' material has one coefficient",
            Some(_) => {
                "as much as kinetic_friction at rest: OpenSees' friction models have no other"
            }
        };
        return no("slider.static_friction", expected, &format!("{} and {}", fixed[0], at_rest[0]));
    }
    if !at_rest.iter().all(|mu| *mu > 0.0) {
        return no("slider.kinetic_friction", "more than 0", &format!("{at_rest:?}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipstick::input;

    const TOWER: &str = "[block]\nmass = \"10 t\"\n[slider]\nstatic_friction = 0.05\nkinetic_friction = 0.05\n\
        radius = \"2 m\"\n[[storey]]\nmass = \"8 t\"\nstiffness = \"9 kN/mm\"\ndamping_ratio = 0.02\n\
        [[storey]]\nmass = \"6 t\"\nstiffness = \"7 kN/mm\"\ndamping_ratio = 0.02\n";

    fn motion() -> GroundMotion {
        let times_s = vec![0.0, 0.1, 0.1, 0.3];
        GroundMotion::new(times_s, vec![0.0, 1.0, -2.0, 0.5], None).expect("a motion")
    }

    /// Dashpots between all masses add up to `C`: a mode of the frame on a still block is damped by 2ξω.
    #[test]
    fn dashpots_damp_every_mode_by_its_ratio() {
        let model = input::parse("tower", TOWER, &[]).expect("a model").model;
        let (frame, dashpots) = (model.frame(), dashpots(model.frame()));
        let modes = shear_frame_modes(&frame.masses_kg, &frame.stiffnesses_n_per_m);
        for mode in 0..2 {
            let shape = [0.0, modes.shapes[mode], modes.shapes[2 + mode]];
            let power: f64 = dashpots
                .iter()
                .map(|&(i, j, c)| c * (shape[j] - shape[i]) * (shape[j] - shape[i]))
                .sum();
            let expected = 2.0 * 0.02 * modes.frequencies_rad_per_s[mode];
            assert!((power / expected - 1.0).abs() < 1e-12, "{power} {expected}");
        }
    }

    #[test]
    fn script_has_the_numbers_of_the_model() {
        let model = input::parse("tower", TOWER, &[]).expect("a model").model;
        let text = script("A \"tower\"", &model, &motion(), 1e7).expect("a script");
        assert!(text.starts_with("\"\"\"A tower: "), "{text}");
        let friction = 0.05 * 24_000.0 * 9.80665;
        assert!(text.contains("K_INIT = 10000000.0  # N/m"), "{text}");
        assert!(text.contains(&format!("FRICTION = [{friction:?}, {friction:?}]")), "{text}");
        assert!(text.contains("MASSES = [10000.0, 8000.0, 6000.0]"), "{text}");
        assert!(
            text.contains("0.0, 0.1, 0.3,\n]  # s") && text.contains("0.0, -2.0, 0.5,"),
            "{text}"
        );
        assert!(text.contains("\"ElasticPP\", k_init, FRICTION[0] / k_init"), "{text}");
        assert!(!text.contains("weight") || !text.contains("PRESSED"), "{text}");
    }

    const BLOCK: &str = "[block]\nmass = \"1 t\"\n[slider]\n";

    /// The script of a slider with constant friction of 0.05, if nothing else is said.
    fn of(keys: &str, vertical: bool) -> Result<String, ChoiceError> {
        let friction = "static_friction = 0.05\nkinetic_friction = 0.05\n";
        let own = keys.contains("friction = ") && !keys.contains("[[contents]]");
        let text = format!("{BLOCK}{}{keys}", if own { "" } else { friction });
        let model = input::parse("m", &text, &[]).expect(keys).model;
        let vertical = vertical.then(|| vec![0.0, 1.0, 0.5]);
        let motion = GroundMotion::evenly_spaced(0.1, vec![0.0, 2.0, 0.0], vertical);
        script("m", &model, &motion.expect("a motion"), 1e7)
    }

    #[test]
    fn scripts_of_devices_have_their_numbers() {
        let stop = "[slider.stop]\ngap = { positive = \"40 mm\", negative = \"30 mm\" }\n";
        let exponential = "static_friction = 0.03\nkinetic_friction = { slow = 0.03, fast = 0.055, \
                           rate = \"30 s/m\" }\n";
        let pieces = "static_friction = 0.03\nkinetic_friction = { velocity = [\"0 m/s\", \"0.1 m/s\"], \
                      coefficient = [0.03, 0.05] }\n";
        let contents = "[[contents]]\nfloor = 0\nmass = \"50 kg\"\nstatic_friction = 0.1\n\
                        kinetic_friction = 0.1\n";
        let surface = |radius_m: f64, mu: f64, travel_m: f64| {
            format!(
                "[[slider.surface]]\nradius = \"{radius_m} m\"\nfriction = {mu}\ntravel = \"{travel_m} m\"\n"
            )
        };
        let triple = "[slider.triple]\neffective_radius = [\"1 m\", \"0.2 m\", \"0.2 m\", \"2 m\"]\n\
                      friction = [0.04, 0.02, 0.02, 0.08]\ntravel = [\"0.1 m\", \"0.05 m\", \"0.05 m\", \"0.3 m\"]\n";
        let radius = "radius = \"2 m\"\n";
        for (keys, vertical, parts) in [
            (
                format!("{stop}stiffness = \"2 kN/mm\"\n"),
                false,
                vec![
                    "STOPS = [(1, 0.04), (-1, 0.03)]",
                    "STOP = 2000000.0",
                    "\"ElasticPPGap\", STOP, side * 1e9 * STOP, side * gap",
                    "PARTS = [stops]",
                ],
            ),
            // ξ = −ln e/√(π² + ln² e)
            (
                format!("{stop}restitution = 0.5\n"),
                false,
                vec!["STOP_DAMPING = 0.21545", "\"ViscoelasticGap\", k_init, damper, -gap"],
            ),
            (format!("{stop}restitution = 0\n"), false, vec!["STOP_DAMPING = 1.0 "]),
            (format!("{stop}restitution = 1\n"), false, vec!["STOP_DAMPING = 0.0 "]),
            (
                format!("{exponential}{radius}"),
                false,
                vec![
                    "FRICTION = \"VelDependent\", 1, 0.03, 0.055, 30.0",
                    "BEARING = \"singleFPBearing\", 1, 1, 2, 1, 2.0",
                    "SPRING, DAMPER = 0.0, 0.0",
                    "PRESSED = [(2, 1000.0)]",
                    "VERTICAL = []",
                ],
            ),
            (
                format!("{exponential}spring = \"3 kN/m\"\n"),
                false,
                vec![
                    "BEARING = \"flatSliderBearing\", 1, 1, 2, 1\n",
                    "SPRING, DAMPER = 3000.0, 0.0",
                ],
            ),
            (
                pieces.to_owned(),
                false,
                vec![
                    "SPEEDS = [0.0, 0.1, 1000.1]",
                    "COEFFICIENTS = [0.03, 0.05, 0.05]",
                    "\"VelDepMultiLinear\", 1",
                ],
            ),
            (radius.to_owned(), false, vec!["\"ElasticPP\"", "SPRING, DAMPER = 4903.325, 0.0"]),
            (
                radius.to_owned(),
                true,
                vec![
                    "FRICTION = \"Coulomb\", 1, 0.05",
                    "\"singleFPBearing\", 1, 1, 2, 1, 2.0",
                    "VERTICAL = [\n    0.0, 1.0, 0.5,\n]",
                ],
            ),
            (
                surface(0.4, 0.03, 0.06) + &surface(1.6, 0.055, 0.6),
                false,
                vec![
                    "FRICTION = [0.03, 0.055, 10.0]",
                    "LENGTHS = [0.2, 1.8, 1.2]",
                    "\"TripleFrictionPendulum\", 1, 1, 2, 1, 2, 3",
                ],
            ),
            // The four surfaces of the sheet come back, but for the inner travel, which takes the rest.
            (
                triple.to_owned(),
                false,
                vec![
                    "FRICTION = [0.02, 0.04, 0.08]",
                    "LENGTHS = [0.2, 1.0, 2.0]",
                    "TRAVELS = [0.04499",
                ],
            ),
            (
                contents.to_owned(),
                false,
                vec![
                    "CONTENTS = [  # floor, kg, friction\n    (0, 50.0, 0.1),\n]",
                    "PARTS = [contents]",
                ],
            ),
            (
                contents.to_owned(),
                true,
                vec!["PRESSED = [(2, 1050.0), (3, 50.0)]", "bearing = \"flatSliderBearing\""],
            ),
        ] {
            let text = of(&keys, vertical).expect(&keys);
            for part in parts {
                assert!(text.contains(part), "{part} is not in\n{text}");
            }
        }
    }

    /// A mass in free flight after half a period of spring and damper has the restitution.
    #[test]
    fn the_damper_of_a_rigid_stop_gives_its_restitution() {
        for e in [0.05, 0.5, 0.99] {
            let ratio = rebound_damping(e);
            let rebound = (-core::f64::consts::PI * ratio / (1.0 - ratio * ratio).sqrt()).exp();
            assert!((rebound / e - 1.0).abs() < 1e-12, "{rebound} {e}");
        }
    }

    #[test]
    fn what_cannot_be_expressed_is_refused() {
        let flat = "[[slider.surface]]\nfriction = 0.05\n[[slider.surface]]\nradius = \"1 m\"\nfriction = 0.03\n";
        let curved = "[[slider.surface]]\nradius = \"1 m\"\nfriction = 0.03\n";
        let rate = "kinetic_friction = { slow = 0.03, fast = 0.055, rate = \"30 s/m\" }\n";
        for (keys, vertical, part) in [
            (
                "static_friction = 0.06\nkinetic_friction = 0.05",
                false,
                "slider.static_friction: expected as much as kinetic_friction",
            ),
            (
                &format!("static_friction = 0.04\n{rate}"),
                false,
                "slider.static_friction: expected as much as kinetic_friction at rest",
            ),
            ("tilt = \"1 mrad\"", false, "slider.tilt: expected a level surface"),
            (
                "stop = { gap = \"0.1 m\", stiffness = \"1 kN/mm\", damping_ratio = 0.1 }",
                false,
                "slider.stop.damper: expected none: a damper behind a gap pulls",
            ),
            (
                "[initial]\nsliding_displacement = \"1 mm\"",
                false,
                "initial: expected a start at rest",
            ),
            (
                "[[contents]]\nfloor = 0\nmass = \"1 kg\"\nstatic_friction = 1\nkinetic_friction = 0.9",
                false,
                "contents.1.static_friction: expected as much",
            ),
            (
                "static_friction = 0.05\nkinetic_friction = 0.05\nasymmetry = 0.1",
                true,
                "slider.kinetic_friction: expected alike both ways",
            ),
            (flat, false, "slider.surface.1: expected a radius"),
            (&curved.repeat(4), false, "slider.surface: expected at most three"),
            (&format!("static_ratio = 1.1\n{curved}"), false, "slider.static_ratio: expected 1"),
        ] {
            let error = of(keys, vertical).expect_err(keys).to_string();
            assert!(error.contains(part), "{error}");
        }
        let model = input::parse("m", TOWER, &[]).expect("a model").model;
        assert!(script("m", &model, &motion(), 0.0).is_err());
        let lifted = GroundMotion::evenly_spaced(0.1, vec![0.0; 3], Some(vec![0.0, -11.0, 0.0]));
        let error = script("m", &model, &lifted.expect("a motion"), 1e7).expect_err("loose");
        assert!(error.to_string().contains("does not lift the block"), "{error}");
    }
}
