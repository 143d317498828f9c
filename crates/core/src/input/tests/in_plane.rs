//! Motions in two horizontal directions.

use super::*;
use crate::input::{MotionSource, PairOf, RecordAlongY, Scale};
use crate::model::Damping;

const BLOCK: &str =
    "[block]\nmass = \"300 kg\"\n[slider]\nstatic_friction = 0.06\nkinetic_friction = 0.05\n";
const PAIR: &str = "[motion]\nrecord = \"x.at2\"\nrecord_y = \"y.at2\"\n";

fn message(text: &str) -> String {
    parse("m.toml", text, &[]).unwrap_err().to_string()
}

/// A storey and a frame are along y as along x but for what is given with `_y`.
#[test]
fn frame_along_y() {
    let storey = "[[storey]]\nmass = \"40 kg\"\nstiffness = \"36 kN/m\"\ndamping_ratio = 0.02\n";
    let along_y = |more: &str, frame: &str| {
        let text = format!("{BLOCK}{storey}{more}{frame}{PAIR}");
        parse("m.toml", &text, &[]).unwrap().model.along_y()
    };
    assert_eq!(along_y("", "").stiffnesses_n_per_m, [36e3]);
    assert_eq!(along_y("", "").damping, Damping::Ratio(0.02));
    let own = along_y("stiffness_y = \"52 kN/m\"\ndamping_ratio_y = 0.03\n", "");
    assert_eq!((own.stiffnesses_n_per_m, own.damping), (vec![52e3], Damping::Ratio(0.03)));
    let damper = along_y("damper_y = \"2 kN s/m\"\n", "");
    assert_eq!(damper.damping, Damping::Dampers(vec![2e3]));
    // k = m (2π f)²
    let omega = core::f64::consts::TAU * 2.0;
    let k = 40.0 * omega * omega;
    for key in ["frequency_y = \"2 Hz\"\n", "period_y = \"0.5 s\"\n"] {
        assert!((along_y(key, "").stiffnesses_n_per_m[0] - k).abs() < 1e-10);
    }
    let frame = "[frame]\nperiod = \"0.6 s\"\nperiod_y = \"0.5 s\"\n";
    assert!((along_y("", frame).stiffnesses_n_per_m[0] - k).abs() < 1e-10);
    let same = "[frame]\nperiod = \"0.5 s\"\n";
    assert!((along_y("", same).stiffnesses_n_per_m[0] - k).abs() < 1e-10);
}

/// A surface may rise along both axes, but not stand upright.
#[test]
fn slope_along_y() {
    let tilted = |keys: &str| parse("m.toml", &format!("{BLOCK}{keys}{PAIR}"), &[]);
    let slider = tilted("tilt = \"1 mrad\"\ntilt_y = \"-2 mrad\"\n").unwrap();
    let tilts = [slider.model.slider().tilt_rad, slider.model.slider().tilt_y_rad];
    assert_eq!(tilts, [0.001, -0.002]);
    let error = tilted("tilt = \"60 deg\"\ntilt_y = \"50 deg\"\n").unwrap_err().to_string();
    assert!(
        error.contains("slider.tilt_y: expected tilts of a surface that is not upright"),
        "{error}"
    );
}

/// Everything of the second record, which else is read as the first.
#[test]
fn pair_of_records() {
    let source = |more: &str| {
        let analysis = parse("m.toml", &format!("{BLOCK}{PAIR}{more}"), &[]).unwrap();
        let Some(MotionSource::Record(record)) = analysis.motion else { panic!("no record") };
        record.along_y.unwrap()
    };
    let plain = RecordAlongY {
        path: "y.at2".to_owned(),
        units: None,
        dt_s: None,
        channel: None,
        pair: PairOf { scale_y: 1.0, rotate_rad: 0.0 },
    };
    assert_eq!(source(""), plain);
    assert_eq!(source("dt = \"0.01 s\"\n").dt_s, Some(0.01));
    let own = source("dt_y = \"0.02 s\"\nchannel_y = 2\nscale_y = -1.5\nrotate = \"90 deg\"\n");
    assert_eq!((own.dt_s, own.channel.as_deref()), (Some(0.02), Some("2")));
    assert_eq!((own.pair.scale_y, own.pair.rotate_rad.to_degrees()), (-1.5, 90.0));
    let both = parse("m.toml", &format!("{BLOCK}{PAIR}scale_to = \"0.3 g\"\n"), &[]).unwrap();
    let Some(MotionSource::Record(record)) = both.motion else { panic!("no record") };
    assert!(matches!(record.scale, Scale::Peak(_)));
}

/// Sines along x and y, turned by a quarter: x takes −y, y takes x.
#[test]
fn sines_in_two_directions() {
    let sine = |amplitude: &str| {
        format!(
            "{{ frequency = \"1 Hz\", amplitude = \"{amplitude}\", duration = \"2 s\", dt = \"0.25 s\" }}"
        )
    };
    let text = |rotate: &str| {
        let (x, y) = (sine("1 m/s2"), sine("3 m/s2"));
        format!("{BLOCK}[motion]\nsine = {x}\nsine_y = {y}\n{rotate}")
    };
    let motion = |text: &str| {
        let source = parse("m.toml", text, &[]).unwrap().motion.unwrap();
        source.made().unwrap().unwrap()
    };
    let plain = motion(&text(""));
    assert_eq!(plain.horizontal_m_per_s2()[1], 1.0);
    assert_eq!(plain.horizontal_y_m_per_s2().unwrap()[1], 3.0);
    let turned = motion(&text("rotate = \"90 deg\"\n"));
    assert_eq!(turned.horizontal_m_per_s2()[1], -3.0);
    assert_eq!(turned.horizontal_y_m_per_s2().unwrap()[1], 1.0);
}

/// A start along x, or along both; what is written reads back the same.
#[test]
fn start_in_two_directions() {
    let storeys =
        "[[storey]]\nmass = \"40 kg\"\nstiffness = \"36 kN/m\"\ndamping_ratio = 0.02\n".repeat(2);
    let initial = "[initial]\nsliding_displacement = [\"10 mm\", \"-2 mm\"]\nsliding_velocity = \"0.1 m/s\"\n\
                   storey_displacement = [\"1 mm\", [\"2 mm\", \"3 mm\"]]\n";
    let first = parse("m.toml", &format!("{BLOCK}{storeys}{PAIR}{initial}"), &[]).unwrap();
    let (x, y) = (first.model.initial(), first.model.along_y().initial);
    assert_eq!((x.sliding_displacement_m, y.sliding_displacement_m), (0.01, -0.002));
    assert_eq!((x.sliding_velocity_m_per_s, y.sliding_velocity_m_per_s), (0.1, 0.0));
    assert_eq!(x.storey_displacement_m.as_deref(), Some(&[0.001, 0.002][..]));
    assert_eq!(y.storey_displacement_m.as_deref(), Some(&[0.0, 0.003][..]));
    assert_eq!(y.storey_velocity_m_per_s, None);
    let written = first.to_toml_with_motion();
    let second = parse("m.toml", &written, &[]).unwrap();
    assert_eq!((first.model, first.motion), (second.model, second.motion), "{written}");
}

/// What speaks of y where there is no y, and what is not solved in two directions.
#[test]
fn keys_of_one_direction_or_two() {
    let one = "[motion]\nrecord = \"x.at2\"\n";
    let expected = "expected a motion in two directions, motion.record_y or motion.sine_y, of which this \
                    is, found a motion in one";
    let storey = "[[storey]]\nmass = \"40 kg\"\nstiffness = \"36 kN/m\"\ndamping_ratio = 0.02\n";
    for (text, at) in [
        (format!("{BLOCK}{one}rotate = \"30 deg\"\n"), "8:10: motion.rotate"),
        (format!("{BLOCK}tilt_y = \"1 mrad\"\n{one}"), "6:10: slider.tilt_y"),
        (format!("{BLOCK}{storey}period_y = \"1 s\"\n{one}"), "10:12: storey.1.period_y"),
        (format!("{BLOCK}{storey}damper_y = \"1 N s/m\"\n{one}"), "10:12: storey.1.damper_y"),
        (format!("{BLOCK}{storey}[frame]\nperiod_y = \"1 s\"\n{one}"), "11:12: frame.period_y"),
        (
            format!("{BLOCK}{one}[initial]\nsliding_velocity = [\"1 m/s\", \"0 m/s\"]\n"),
            "9:20: initial.sliding_velocity",
        ),
        (
            format!("{BLOCK}{storey}{one}[initial]\nstorey_velocity = [[\"1 m/s\", \"0 m/s\"]]\n"),
            "13:20: initial.storey_velocity.1",
        ),
    ] {
        assert_eq!(message(&text), format!("m.toml:{at}: {expected}"));
    }
    let alone = message(&format!("{BLOCK}{one}scale_y = 2\n"));
    assert_eq!(
        alone,
        "m.toml:8:1: motion.scale_y: expected this key only beside \"record_y\", found \"scale_y\" alone"
    );
    let three = message(&format!("{BLOCK}{PAIR}[initial]\nsliding_velocity = [\"1 m/s\"]\n"));
    assert!(three.ends_with("expected two values, along x and along y, found 1"), "{three}");
    for (text, key) in [
        (format!("{BLOCK}asymmetry = 0.1\n{PAIR}"), "slider.asymmetry"),
        (
            format!("{BLOCK}stop = {{ gap = \"0 m\", stiffness = \"1 MN/m\" }}\n{PAIR}"),
            "slider.stop.gap",
        ),
        (
            format!(
                "{BLOCK}stop = {{ gap = {{ positive = \"0.1 m\" }}, stiffness = \"1 MN/m\" }}\n{PAIR}"
            ),
            "slider.stop.gap",
        ),
        (format!("{BLOCK}{PAIR}[analysis]\nmethod = \"stepwise\"\n"), "analysis.method"),
        (
            format!(
                "{BLOCK}[[contents]]\nfloor = 0\nmass = \"1 kg\"\nstatic_friction = 0.3\n\
                 kinetic_friction = 0.3\n{PAIR}"
            ),
            "contents",
        ),
        (
            format!("{}{PAIR}", BLOCK.replace("= 0.05", "= { positive = 0.03, negative = 0.05 }")),
            "slider.kinetic_friction.positive",
        ),
    ] {
        let found = message(&text);
        let expected = format!(": {key}: expected a model that is solved in two directions");
        assert!(found.contains(&expected) && found.ends_with(&format!("found {key}")), "{found}");
    }
}

const TABLE: &str = "period_s,damping_ratio,participation_x,participation_y,roof_x,roof_y\n\
                     0.8,0.02,200,-60,0.004,-0.0012\n0.5,0.02,60,200,0.0011,0.004\n";

fn structure(keys: &str, table: &str) -> Result<crate::model::Structure, String> {
    let text = format!("{BLOCK}[structure]\nmass = \"100 t\"\nmodes = \"modes.csv\"\n{keys}");
    let modes = [Override::modes("modes.csv", table)];
    let parsed = parse("m.toml", &text, &modes).map_err(|error| error.to_string())?;
    Ok(parsed.model.structure().unwrap().clone())
}

/// Participations and shapes along y are kept with their signs, those of a mode along y alone too.
#[test]
fn modes_keep_what_they_do_along_y() {
    let found = structure("period_factor = 2.0\n", TABLE).unwrap();
    let mode = &found.in_plane[0];
    assert_eq!((mode.participation, mode.points[0]), ([200.0, -60.0], [0.004, -0.0012]));
    let longer = core::f64::consts::TAU / (0.8 * 2.0);
    assert_eq!((mode.frequency_rad_per_s, mode.damping_ratio), (longer, 0.02));
    // Σ L Lᵀ
    assert_eq!(found.mass_in_plane_kg(), [[43600.0, 0.0], [0.0, 43600.0]]);
    // A mode along y alone is none of the motion along x.
    let alone = structure("", &TABLE.replace(",60,200,", ",0,200,")).unwrap();
    assert_eq!((alone.modes.len(), alone.in_plane.len()), (1, 2));
    assert_eq!(alone.in_plane[1].participation, [0.0, 200.0]);
    // Effective masses have the sign of the momentum Σ m φ, where it is known.
    let masses = TABLE
        .replace("participation_x,participation_y", "effective_mass_x_kg,effective_mass_y_kg")
        .replace(",200,-60,", ",40000,3600,")
        .replace(",60,200,", ",3600,40000,");
    assert!(structure("", &masses).unwrap().in_plane.is_empty());
    let point = "[[structure.point]]\nname = \"Roof\"\nmass = \"40 t\"\n";
    let found = structure(point, &masses).unwrap();
    assert_eq!(found.in_plane[0].participation, [200.0, -60.0]);
    // Shapes that are 1 at a point: those of unit modal mass are φ/√M, √M = √m_x/Γ_x.
    let unit = masses.replace("0.004,-0.0012", "1,-0.3").replace("0.0011,0.004", "1,4");
    let found = structure(&format!("normalisation = \"roof\"\n{point}"), &unit).unwrap();
    assert_eq!(found.in_plane[0].points[0], [1.0 / 200.0, -0.3 / 200.0]);
    // Nothing along y, or not at every point.
    for (from, to) in [(",participation_y", ",effective_mass_ratio_y"), (",roof_y", ",top_y")] {
        let table =
            TABLE.replace(from, to).replace(",-60,", ",0.036,").replace(",200,0.0", ",0.4,0.0");
        let found = structure("", &table);
        assert!(found.map_or(true, |found| found.in_plane.is_empty()), "{to}");
    }
}

/// Modes that move along y alone need nothing along x, in a table and in the model file; an effective mass is then
/// enough, for its sign is that of nothing else.
#[test]
fn modes_along_y_alone() {
    let header = "period_s,damping_ratio,";
    for (columns, row) in [
        ("participation_y,roof_y", "-300,0.002"),
        ("effective_mass_y_kg,roof_y", "90000,0.002"),
        ("effective_mass_ratio_y,roof_y", "0.9,0.002"),
        ("effective_mass_ratio_y", "0.9"),
        ("effective_mass_ratio,effective_mass_ratio_y", "0,0.9"),
    ] {
        let found = structure("", &format!("{header}{columns}\n0.5,0.02,{row}\n")).unwrap();
        let [mode] = found.in_plane.as_slice() else { panic!("{columns}") };
        let l = if row.starts_with('-') { -300.0 } else { 300.0 };
        assert_eq!(mode.participation, [0.0, l], "{columns}");
        assert_eq!((found.modes.len(), found.missing_mass_kg()), (0, 1e5), "{columns}");
    }
    // One along each axis, by effective masses.
    let both = "effective_mass_ratio,effective_mass_ratio_y\n0.8,0.02,0.9,0\n0.5,0.02,0,0.8\n";
    let found = structure("", &format!("{header}{both}")).unwrap();
    let all: Vec<[f64; 2]> = found.in_plane.iter().map(|mode| mode.participation).collect();
    assert_eq!(all, [[300.0, 0.0], [0.0, 80_000.0_f64.sqrt()]]);
    // None that moves.
    let error = structure("", &format!("{header}participation_y\n0.5,0.02,0\n")).unwrap_err();
    assert!(error.contains("expected a mode with an effective mass or a participation"), "{error}");
}

/// Effective masses of a mode that moves along both axes do not tell whether it does so to one side or to the other.
#[test]
fn effective_masses_along_both_axes_do_not_tell_signs() {
    let table =
        "period_s,damping_ratio,effective_mass_ratio_x,effective_mass_ratio_y\n0.5,0.02,0.5,0.4\n";
    let text = format!("{BLOCK}[structure]\nmass = \"100 t\"\nmodes = \"modes.csv\"\n{PAIR}");
    let error = parse("m.toml", &text, &[Override::modes("modes.csv", table)]).unwrap_err();
    let found = "found an effective mass of mode 1, which does not tell the sign of its participations along x \
                 and y";
    assert!(error.to_string().ends_with(found), "{error}");
}

/// What is wrong along y is said with its place.
#[test]
fn modes_wrong_along_y() {
    for (from, to, expected) in [
        (
            ",60,200,",
            ",60,400,",
            "modes.csv:3:13: structure.mode.2.participation_y: expected effective masses that sum to \
             at most the structure's 100000 kg, found 163600 kg with this mode",
        ),
        (",-0.0012", ",x", "modes.csv:2:24: expected a finite number, found \"x\""),
        (
            "roof_y",
            "roof_x",
            "modes.csv:1:63: expected each column once, found a second column \"roof_x\"",
        ),
    ] {
        let error = structure("", &TABLE.replace(from, to)).unwrap_err();
        assert_eq!(error, expected, "{to}");
    }
}

/// Participations that no structure of this mass has between x and y, though along each of both it may.
#[test]
fn participations_of_other_signs_are_refused() {
    let table = TABLE.replace(",200,-60,", ",220,-200,").replace(",60,200,", ",220,-200,");
    let error = structure("", &table).unwrap_err();
    let expected = "modes.csv:3:1: structure.mode.2: expected participations along x and y whose squares sum to \
                    at most the mass of the structure in every direction between them: do their signs belong to \
                    the same shapes?, found ";
    assert!(error.starts_with(expected) && error.ends_with("kg with this mode"), "{error}");
}

/// Two directions ask for modes that are known along both.
#[test]
fn modes_along_x_alone_are_refused_in_two_directions() {
    let refused = |motion: &str, table: &str| {
        let text = format!("{BLOCK}[structure]\nmass = \"100 t\"\nmodes = \"modes.csv\"\n{motion}");
        let modes = [Override::modes("modes.csv", table)];
        parse("m.toml", &text, &modes).map(|_| ()).map_err(|error| error.to_string())
    };
    let along_x = "period_s,damping_ratio,participation_x,roof_x\n0.8,0.02,200,0.004\n";
    let no_shape = TABLE.replace("roof_y", "top_x");
    for table in [along_x, &no_shape] {
        let error = refused(PAIR, table).unwrap_err();
        let expected = "motion.record_y: expected modes that say what they do along y: participation_y of each \
                        mode, and the shape NAME_y beside NAME_x at every point, found a structure known along \
                        x alone";
        assert!(error.starts_with("m.toml:") && error.ends_with(expected), "{error}");
    }
    assert_eq!(refused(PAIR, TABLE), Ok(()));
}
