//! A model as a script for OpenSees: what engineers use today, with the number that stick needs there.

use core::fmt::Write;

use slipstick::error::ChoiceError;
use slipstick::linear::shear_frame_modes;
use slipstick::model::{Damping, Frame, InitialState, Model};
use slipstick::motion::GroundMotion;

/// The functions of the script, below the model's numbers.
const FUNCTIONS: &str = include_str!("opensees.py");

/// A script for OpenSeesPy, with stick as an elastic spring of stiffness `k_init_n_per_m` in series with
/// the friction, which is what its uniaxial material knows.
///
/// Run as a program it prints peak and residual sliding displacement; its function `analyse` returns times
/// and sliding displacements at the samples of the motion. Springs, pendulums and dampers are linear;
/// damping by ratio is that of every fixed-base mode, as dashpots between all floors. A jump of the motion
/// is its right side.
///
/// # Errors
/// [`ChoiceError`] for what such a model cannot express: static friction above the kinetic one,
/// friction of 0 or by sliding speed, surfaces in series, stops, contents, a slope, an initial state,
/// vertical motion; and unless the stiffness is finite and > 0.
pub fn script(
    name: &str,
    model: &Model,
    motion: &GroundMotion,
    k_init_n_per_m: f64,
) -> Result<String, ChoiceError> {
    expressible(model, motion)?;
    if !(k_init_n_per_m.is_finite() && k_init_n_per_m > 0.0) {
        return Err(refused("k_init", "a stiffness > 0 N/m", &format!("{k_init_n_per_m} N/m")));
    }
    let (slider, frame) = (model.slider(), model.frame());
    let [positive_n, negative_n] = model.kinetic_friction().map(|mu| mu * model.weight_n());
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
    line(format_args!("FRICTION = [{positive_n:?}, {negative_n:?}]  # N, towards +x and -x"));
    line(format_args!(
        "SPRING, DAMPER = {:?}, {:?}  # of the slider, N/m and N s/m",
        slider.stiffness_n_per_m, slider.damper_n_s_per_m
    ));
    line(format_args!("MASSES = {:?}  # kg: the block, then the floors", masses(model)));
    line(format_args!("STOREYS = {:?}  # N/m", frame.stiffnesses_n_per_m));
    line(format_args!("# Dashpots between two of the masses, N s/m\nDASHPOTS = ["));
    for (i, j, c) in dashpots(frame) {
        line(format_args!("    ({i}, {j}, {c:?}),"));
    }
    line(format_args!("]"));
    let (times_s, values) = right_sides(motion);
    match motion.dt_s() {
        Some(dt_s) => {
            line(format_args!("TIMES = [i * {dt_s:?} for i in range({})]  # s", times_s.len()))
        }
        None => line(format_args!("TIMES = [{}]  # s", listed(&times_s))),
    }
    line(format_args!("ACCELERATION = [{}]  # of the ground, m/s2", listed(&values)));
    text.push_str(FUNCTIONS);
    Ok(text)
}

/// Masses of block and floors in kg.
fn masses(model: &Model) -> Vec<f64> {
    let block = core::iter::once(model.block().mass_kg);
    block.chain(model.frame().masses_kg.iter().copied()).collect()
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

/// Times and values with the right side of every jump alone.
fn right_sides(motion: &GroundMotion) -> (Vec<f64>, Vec<f64>) {
    let (times_s, values) = (motion.times_s(), motion.horizontal_m_per_s2());
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

/// # Errors
/// [`ChoiceError`] for the first thing that the script's model does not have.
fn expressible(model: &Model, motion: &GroundMotion) -> Result<(), ChoiceError> {
    let (slider, devices) = (model.slider(), model.devices());
    let (fixed, kinetic) = (model.static_friction(), model.kinetic_friction());
    let no = |what: &str, expected: &str, found: &str| Err(refused(what, expected, found));
    if devices.series.is_some() {
        return no(
            "slider.surfaces",
            "one surface, which is what OpenSees' material has",
            "several",
        );
    }
    if devices.rate.is_some() {
        return no("slider.rate", "friction that does not follow the speed", "a rate law");
    }
    if fixed != kinetic {
        let expected = "as much as kinetic_friction: OpenSees' material has one coefficient";
        return no("slider.static_friction", expected, &format!("{} and {}", fixed[0], kinetic[0]));
    }
    if !kinetic.iter().all(|mu| *mu > 0.0) {
        return no("slider.kinetic_friction", "more than 0", &format!("{kinetic:?}"));
    }
    if slider.stop.is_some() {
        return no(
            "slider.stop",
            "none: its damper cannot pull, which no material of OpenSees is",
            "a stop",
        );
    }
    if !devices.contents.is_empty() {
        return no("contents", "none", "contents");
    }
    if slider.tilt_rad != 0.0 {
        return no("slider.tilt", "a level surface", &format!("{} rad", slider.tilt_rad));
    }
    if *model.initial() != InitialState::rest() {
        return no("initial", "a start at rest", "an initial state");
    }
    if motion.vertical_m_per_s2().is_some() {
        let expected = "no vertical component: the spring's yield force does not follow it";
        return no("motion", expected, "one");
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
    fn exact_dashpots_damp_every_mode_by_its_ratio() {
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
    fn exact_script_has_the_numbers_of_the_model() {
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
    }

    #[test]
    fn exact_what_cannot_be_expressed_is_refused() {
        let block =
            "[block]\nmass = \"1 t\"\n[slider]\nkinetic_friction = 0.05\nstatic_friction = ";
        for (more, part) in [
            ("0.06", "slider.static_friction: expected as much as kinetic_friction"),
            ("0.05\ntilt = \"1 mrad\"", "slider.tilt: expected a level surface"),
            ("0.05\nstop = { gap = \"0.1 m\", stiffness = \"1 kN/mm\" }", "slider.stop"),
            (
                "0.05\n[initial]\nsliding_displacement = \"1 mm\"",
                "initial: expected a start at rest",
            ),
            (
                "0.05\n[[contents]]\nfloor = 0\nmass = \"1 kg\"\nstatic_friction = 1\nkinetic_friction = 1",
                "contents: expected none",
            ),
        ] {
            let model = input::parse("m", &format!("{block}{more}"), &[]).expect(more).model;
            let error = script("m", &model, &motion(), 1e7).expect_err(more).to_string();
            assert!(error.contains(part), "{error}");
        }
        let model = input::parse("m", &format!("{block}0.05"), &[]).expect("a model").model;
        assert!(script("m", &model, &motion(), 0.0).is_err());
        let lifted = GroundMotion::evenly_spaced(0.1, vec![0.0; 3], Some(vec![0.0; 3]));
        assert!(script("m", &model, &lifted.expect("a motion"), 1e7).is_err());
    }
}
