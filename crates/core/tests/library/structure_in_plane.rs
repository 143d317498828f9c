//! Structures by their modes in two horizontal directions: a shear frame given as its modes answers as the frame, a
//! structure that is turned with its motion gives turned vectors, and what modes lack of the mass moves with the block.

// Helpers of tests may panic as tests do; the numbers of a run are for people who look for them with --nocapture.
#![allow(clippy::expect_used, clippy::disallowed_macros)]

use crate::common::by_modes::{by_modes, cut_and_turned, structure_of, turned, with_structure};
use crate::common::in_plane::{cases, model as model_of_case, motion as motion_of_case, taft};
use slipstick::check::check;
use slipstick::input::{self, Override};
use slipstick::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, Response};
use slipstick::slider::Friction;
use slipstick::solver::exact;

/// Largest difference of a figure over its size: that of rounding.
const AGREED: f64 = 1e-10;

/// The figures of a response or of an axis, each with the size over which it is compared.
fn figures(d: &Demands, root: &Demands) -> Vec<(String, f64, f64)> {
    let slide = root.peak_sliding_displacement_m;
    let mut all = vec![
        ("peak sliding", d.peak_sliding_displacement_m, slide),
        ("largest", d.max_sliding_displacement_m, slide),
        ("least", d.min_sliding_displacement_m, slide),
        ("residual", d.residual_sliding_displacement_m, slide),
        ("path", d.sliding_path_m, root.sliding_path_m),
        ("time", d.sliding_time_s, root.sliding_time_s),
        ("velocity", d.peak_sliding_velocity_m_per_s, root.peak_sliding_velocity_m_per_s),
        ("block", d.peak_block_acceleration_m_per_s2, root.peak_block_acceleration_m_per_s2),
        ("base shear", d.peak_base_shear_n, root.peak_base_shear_n),
        ("friction", d.peak_friction_force_n, root.peak_friction_force_n),
        ("slider", d.peak_slider_force_n, root.peak_slider_force_n),
        ("overturning", d.overturning_ratio.unwrap_or(0.0), 1.0),
    ];
    let of = |d: &Demands| if d.points.is_empty() { d.storeys.clone() } else { d.points.clone() };
    for (point, whole) in of(d).iter().zip(of(root)) {
        let ratio = point.peak_drift_ratio.unwrap_or(0.0);
        all.extend([
            ("acceleration", point.peak_acceleration_m_per_s2, whole.peak_acceleration_m_per_s2),
            ("displacement", point.peak_displacement_m, whole.peak_displacement_m),
            ("drift", point.peak_drift_m, whole.peak_drift_m),
            (
                "drift velocity",
                point.peak_drift_velocity_m_per_s,
                whole.peak_drift_velocity_m_per_s,
            ),
            ("drift ratio", ratio, whole.peak_drift_ratio.unwrap_or(1.0)),
        ]);
    }
    all.into_iter().map(|(what, value, size)| (what.to_owned(), value, size)).collect()
}

/// Compares all figures of both; the worst.
fn assert_alike(name: &str, a: &Response, b: &Response) -> f64 {
    let kinds = |r: &Response| r.events.iter().map(|event| event.kind).collect::<Vec<_>>();
    assert_eq!(kinds(a), kinds(b), "{name}");
    let planes = [a, b].map(|r| r.in_plane.as_deref().expect("two directions"));
    let of = |part: usize, which: usize| match part {
        0 => [a, b][which].demands.clone(),
        axis => planes[which].axes[axis - 1].clone(),
    };
    let mut worst = (0.0, String::new());
    for part in 0..3 {
        let [x, y] = [0, 1].map(|which| figures(&of(part, which), &of(0, which)));
        assert_eq!(x.len(), y.len(), "{name}");
        for ((what, x, size), (_, y, _)) in x.into_iter().zip(y) {
            let error = if x == y { 0.0 } else { (x - y).abs() / size };
            if !(error <= worst.0) {
                worst = (error, format!("{what} of part {part}: {x} {y}"));
            }
        }
    }
    for (x, y) in a.events.iter().zip(&b.events) {
        assert!((x.time_s - y.time_s).abs() < 1e-10, "{name}: {x:?} {y:?}");
    }
    println!("{name}: {:.1e} ({})", worst.0, worst.1);
    assert!(worst.0 <= AGREED, "{name}: {worst:?}");
    worst.0
}

fn solved(name: &str, model: &Model, motion: &GroundMotion) -> Response {
    let response = exact(model, motion).expect("a response");
    let certificate = check(model, motion, &response);
    println!(
        "{name}: {:.1e} {:.1e} {:.1e} {:.1e}",
        certificate.equilibrium_residual,
        certificate.friction_excess,
        certificate.energy_balance_error,
        certificate.demands_error
    );
    assert!(certificate.holds(), "{name}: {certificate:?}");
    response
}

fn run_both(name: &str, model: &Model, motion: &GroundMotion) {
    let frame = exact(model, motion).expect("a response");
    assert_alike(name, &frame, &solved(name, &by_modes(model), motion));
}

#[test]
fn verification_cases_with_storeys_run_both_ways() {
    let mut runs = 0;
    for case in cases() {
        let model = model_of_case(&case);
        if model.storeys() > 0 {
            run_both(case["id"].as_str().expect("a name"), &model, &motion_of_case(&case));
            runs += 1;
        }
    }
    assert_eq!(runs, 7);
}

fn table(samples: u32) -> [Vec<f64>; 2] {
    let of = |terms: [[f64; 2]; 2]| {
        let sample = |i: u32| {
            let t = 0.01 * f64::from(i);
            terms.iter().map(|[a, omega]| a * libm::sin(omega * t)).sum()
        };
        (0..samples).map(sample).collect()
    };
    [of([[2.5, 6.1], [1.5, 19.3]]), of([[2.1, 7.3], [-1.2, 15.7]])]
}

fn motion([x, y]: [Vec<f64>; 2]) -> GroundMotion {
    GroundMotion::evenly_spaced(0.01, x, None)
        .and_then(|motion| motion.with_y(y))
        .expect("a motion")
}

/// A frame that is not the same along y.
fn frame(n: usize, slider: Slider) -> Model {
    let grade = |i: usize| 1.0 + 0.3 * libm::sin(i as f64 * 1.7);
    let stiffness = |k: f64, shift: usize| -> Vec<f64> {
        (0..n).map(|i| k * n as f64 * grade(i + shift)).collect()
    };
    let frame = Frame {
        masses_kg: (0..n).map(|i| 4e4 * grade(i)).collect(),
        stiffnesses_n_per_m: stiffness(3e7, 3),
        damping: Damping::Ratio(0.03),
        heights_m: Some(vec![3.5; n]),
    };
    let block = Block { mass_kg: 1e5, width_m: Some(12.0), height_m: Some(1.0) };
    let along_y = AlongY {
        stiffnesses_n_per_m: stiffness(2e7, 5),
        damping: Damping::Ratio(0.02),
        width_m: Some(9.0),
        initial: InitialState::rest(),
    };
    Model::new(block, slider, frame, 9.80665, InitialState::rest())
        .and_then(|model| model.with_along_y(along_y))
        .expect("a model")
}

fn sliders() -> [(&'static str, Slider); 2] {
    let friction = |fixed| Friction::new(fixed, 0.06).expect("friction");
    [
        ("spring", Slider::sprung(friction(0.08), 1e6)),
        ("pendulum", Slider::pendulum(friction(0.06), 2.0)),
    ]
}

#[test]
fn frames_of_1_5_and_20_storeys_run_both_ways() {
    for n in [1, 5, 20] {
        for (kind, slider) in sliders() {
            run_both(&format!("{n} storeys, {kind}"), &frame(n, slider), &motion(table(800)));
        }
    }
}

/// A structure turned with its motion gives turned vectors.
#[test]
fn a_turned_structure_gives_turned_vectors() {
    for (kind, slider) in sliders() {
        for kept in [3, 10] {
            let name = format!("{kind}, {kept} modes");
            let model = frame(5, slider.clone());
            let plain = solved(&name, &cut_and_turned(&model, kept, 0.0), &motion(table(800)));
            let turn = turned(0.7);
            let [x, y] = table(800);
            let both: Vec<[f64; 2]> = x.iter().zip(&y).map(|(x, y)| turn([*x, *y])).collect();
            let axis = |k: usize| both.iter().map(|a| a[k]).collect();
            let by_turn = motion([axis(0), axis(1)]);
            let other = solved(&name, &cut_and_turned(&model, kept, 0.7), &by_turn);
            let (a, b) = (&plain.demands, &other.demands);
            assert_eq!((a.slip_count, a.stick_count), (b.slip_count, b.stick_count), "{name}");
            let mut worst: f64 = 0.0;
            // Along one axis only: what is of an axis turns, resultants do not.
            let by_axis = ["largest", "least", "overturning"];
            for ((what, x, size), (_, y, _)) in figures(a, a).into_iter().zip(figures(b, b)) {
                if !by_axis.contains(&what.as_str()) && size != 0.0 {
                    worst = worst.max((x - y).abs() / size);
                }
            }
            let last = |r: &Response| {
                let y = r.in_plane.as_ref().and_then(|plane| plane.history.as_ref());
                let (x, y) = (r.history.as_ref().expect("a history"), y.expect("along y"));
                let k = x.len() - 1;
                let s = [x.sliding_displacement_m[k], y.sliding_displacement_m[k]];
                let top = x.storeys.min(5) - 1;
                let top = top.min(y.point_count(x) - 1);
                [s, y.point_displacement(x, k, top), y.point_acceleration(x, k, top)]
            };
            let sizes = [
                a.peak_sliding_displacement_m,
                a.points[4].peak_displacement_m,
                a.points[4].peak_acceleration_m_per_s2,
            ];
            for ((x, y), size) in last(&plain).into_iter().zip(last(&other)).zip(sizes) {
                let [p, q] = turn(x);
                worst = worst.max((p - y[0]).abs() / size).max((q - y[1]).abs() / size);
            }
            println!("{name}: {worst:.1e}");
            assert!(worst <= 1e-11, "{name}: {worst:.1e}");
        }
    }
}

/// A building of the examples of which the first modes are given, in two directions.
fn building(modes: usize) -> Model {
    let text = include_str!("../../../../examples/structures/building.toml");
    let table = include_str!("../../../../examples/structures/building-modes.csv");
    let rows: Vec<&str> = table.lines().take(1 + modes).collect();
    let modes = Override::modes("building-modes.csv", &rows.join("\n"));
    let record_y = Override::parse("motion.record_y=taft-111.txt").expect("a key");
    input::parse("building.toml", text, &[modes, record_y]).expect("a model").model
}

/// While a block comes to rest the direction of friction turns on to its limit, however slow the block is by then: a
/// peak at a stop may be there.
#[test]
fn peaks_at_a_stop_count_all_directions_up_to_the_last() {
    let motion = taft(0.5, 1150);
    for modes in [3, 7] {
        solved(&format!("{modes} modes"), &building(modes), &motion);
    }
    let response = solved("all modes", &building(9), &motion);
    let [_, y] = &response.in_plane.as_ref().expect("two directions").axes;
    // By the limit of the equation of the last approach, at the stop at 11.1577 s.
    let found = y.peak_block_acceleration_m_per_s2;
    assert!((found - 3.660966).abs() < 5e-7, "{found}");
}

/// A structure with all its modes, of which the digits are rounded: what moves with the block is a multiple of the
/// identity but for rounding, and the answer that of the frame.
#[test]
fn rounded_participations_change_no_answer() {
    let whole = frame(3, sliders()[0].1.clone());
    let motion = motion(table(800));
    let exact_modes = solved("all digits", &by_modes(&whole), &motion);
    for part in [1e-15, 1e-13, 1e-11] {
        let mut structure = by_modes(&whole).structure().expect("modes").clone();
        for (j, mode) in structure.in_plane.iter_mut().enumerate() {
            let factor = 1.0 - part * (1 + j % 3) as f64;
            mode.participation = mode.participation.map(|l| factor * l);
        }
        let rounded = structure_of(structure.mass_kg, structure.in_plane, structure.points);
        let model = with_structure(&whole, rounded, InitialState::rest(), InitialState::rest());
        let name = format!("rounded by {part:e}");
        assert_alike(&name, &exact_modes, &solved(&name, &model, &motion));
    }
}

/// A model of a block of 300 t on a pendulum with a structure of 500 t, under Taft.
fn on_pendulum(structure: &str, overrides: &[Override]) -> Model {
    let text = format!(
        "[block]\nmass = \"300 t\"\n[slider]\nstatic_friction = 0.06\nkinetic_friction = 0.05\n\
         radius = \"2.5 m\"\n[structure]\nmass = \"500 t\"\n{structure}\n"
    );
    input::parse("m.toml", &text, overrides).expect("a model").model
}

/// A mode along y alone needs no key along x: one alone, by any of its keys and in a table, moves as the same mode
/// along x under the exchanged motion.
#[test]
fn modes_along_y_alone_are_modes() {
    let mode = |key: &str| {
        format!("[[structure.mode]]\nperiod = \"0.4 s\"\ndamping_ratio = 0.03\n{key}\n")
    };
    let pair = taft(0.3, 800);
    let y = pair.horizontal_y_m_per_s2().expect("y").to_vec();
    let exchanged = GroundMotion::evenly_spaced(0.01, y, None)
        .and_then(|motion| motion.with_y(pair.horizontal_m_per_s2().to_vec()))
        .expect("a pair");
    let along_x = on_pendulum(&mode("participation = 700\nparticipation_y = 0"), &[]);
    let expected = solved("along x", &along_x, &exchanged);
    for key in
        ["participation_y = 700", "effective_mass_y = \"490 t\"", "effective_mass_ratio_y = 0.98"]
    {
        let pair_of_records = Override::parse("motion.record_y=y.txt").expect("a key");
        let record = Override::parse("motion.record=x.txt").expect("a key");
        let model = on_pendulum(&mode(key), &[record, pair_of_records]);
        let found = solved(key, &model, &pair);
        let [a, b] = [&expected, &found].map(|r| &r.demands);
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-10 * b;
        assert!(near(a.peak_sliding_displacement_m, b.peak_sliding_displacement_m), "{key}");
        assert!(near(a.peak_base_shear_n, b.peak_base_shear_n), "{key}");
        // Nothing of it moves along x alone.
        let alone = GroundMotion::evenly_spaced(0.01, pair.horizontal_m_per_s2().to_vec(), None);
        let refused = exact(&on_pendulum(&mode(key), &[]), &alone.expect("a motion"));
        assert_eq!(
            refused.expect_err("one direction").to_string(),
            "one horizontal direction: expected a model without a structure whose modes all move along y"
        );
    }
    let table = "period_s,damping_ratio,effective_mass_ratio_y,roof_y\n0.4,0.03,0.98,0.0015\n";
    let modes = [Override::modes("modes.csv", table)];
    let model = on_pendulum("modes = \"modes.csv\"", &modes);
    let found = solved("table", &model, &pair);
    let [a, b] = [&expected, &found].map(|r| r.demands.peak_sliding_displacement_m);
    assert!((a - b).abs() <= 1e-10 * b);
    let [x, y] = &found.in_plane.as_ref().expect("two directions").axes;
    assert!(y.points[0].peak_displacement_m > 0.0 && x.points[0].peak_displacement_m == 0.0);
}

/// A printed figure of a point or of an axis that is not so is found, and so is a state.
#[test]
fn tampered_points_are_found() {
    let [(_, slider), _] = sliders();
    let model = cut_and_turned(&frame(3, slider), 4, 0.3);
    let motion = motion(table(400));
    let response = solved("three storeys, four modes", &model, &motion);
    let is_found = |tampered: &Response| !check(&model, &motion, tampered).holds();
    for part in 0..3 {
        for i in 0..3 {
            for which in 0..3 {
                let mut tampered = response.clone();
                let demands = match part {
                    0 => &mut tampered.demands,
                    axis => &mut tampered.in_plane.as_mut().expect("a plane").axes[axis - 1],
                };
                let point = &mut demands.points[i];
                let value = match which {
                    0 => &mut point.peak_acceleration_m_per_s2,
                    1 => &mut point.peak_displacement_m,
                    _ => &mut point.peak_drift_m,
                };
                *value *= 1.0 + 1e-8;
                assert!(is_found(&tampered), "part {part}, point {i}, figure {which}");
            }
        }
    }
    for which in 0..5 {
        let mut tampered = response.clone();
        let h = tampered.history.as_mut().expect("a history");
        let middle = h.len() / 2;
        let y = tampered.in_plane.as_mut().and_then(|plane| plane.history.as_mut()).expect("y");
        let place = middle * h.storeys + 1;
        let value = match which {
            0 => &mut h.storey_displacement_m[place],
            1 => &mut h.storey_velocity_m_per_s[place],
            2 => &mut h.storey_acceleration_m_per_s2[place],
            3 => &mut y.sliding_displacement_m[middle],
            _ => &mut y.block_acceleration_m_per_s2[middle],
        };
        *value += 1e-6 * (1.0 + value.abs());
        assert!(is_found(&tampered), "state {which}");
    }
}

/// A round tank is the same in every direction: under components in proportion its resultants are those of one
/// direction, turned records give turned answers, and y alone is x alone.
#[test]
fn prop_a_round_tank_is_the_same_in_every_direction() {
    let text = "[block]\nmass = \"402 t\"\nwidth = \"21 m\"\n[slider]\nstatic_friction = 0.07\n\
                kinetic_friction = 0.05\nradius = \"3 m\"\n[structure]\nmass = \"2513.27 t\"\n\
                along_y = \"as-x\"\n[[structure.mode]]\nperiod = \"4.9306 s\"\ndamping_ratio = 0.005\n\
                effective_mass_ratio = 0.517476\n[[structure.mode]]\nperiod = \"0.12 s\"\n\
                damping_ratio = 0.02\neffective_mass_ratio = 0.449888\n[[structure.point]]\n\
                name = \"Impulsive\"\nheight = \"7.891 m\"\nmass = \"1130.69 t\"\n\
                shape = [0, 9.404332e-4]\n[[structure.point]]\nname = \"Sloshing\"\nheight = \"7.253 m\"\n\
                mass = \"1300.56 t\"\nshape = [8.768695e-4, 0]\n";
    let motion_of_file = "[motion]\nrecord = \"x.txt\"\nrecord_y = \"y.txt\"\n";
    let parsed = input::parse("tank.toml", &format!("{text}{motion_of_file}"), &[]);
    let model = parsed.expect("a tank").model;
    assert_eq!(model.along_y().width_m, Some(21.0));
    let pair = taft(0.5, 3000);
    let alone = pair.along_x();
    let line = solved("one direction", &model, &alone);
    assert!(line.demands.peak_sliding_displacement_m > 0.05, "it slides");
    let [cos, sin] = [0.8, 0.6];
    let along = |x: f64, y: f64| {
        let values = |factor: f64| alone.horizontal_m_per_s2().iter().map(|a| factor * a).collect();
        let motion = GroundMotion::new(alone.times_s().to_vec(), values(x), None);
        motion.and_then(|motion| motion.with_y(values(y))).expect("a motion")
    };
    for [x, y] in [[cos, sin], [0.0, 1.0], [-1.0, 0.0]] {
        let both = solved("in proportion", &model, &along(x, y));
        // The ratio of overturning is one of each axis alone.
        let of_root = |d: &Demands| Demands { overturning_ratio: None, ..d.clone() };
        let (a, b) = (of_root(&both.demands), of_root(&line.demands));
        for ((what, a, size), (_, b, _)) in figures(&a, &b).iter().zip(&figures(&b, &b)) {
            let by_axis = ["largest", "least", "residual"].contains(&what.as_str());
            assert!(by_axis || (a - b).abs() <= AGREED * size, "{x}, {y}: {what} {a} {b}");
        }
    }
    // Two records at once, and both turned by a right angle.
    let turned_pair = pair.turned(1.0, core::f64::consts::FRAC_PI_2).expect("a motion");
    let [first, second] = [&pair, &turned_pair].map(|motion| solved("a pair", &model, motion));
    let whole = |r: &Response| figures(&r.demands, &first.demands);
    for ((what, a, size), (_, b, _)) in whole(&first).into_iter().zip(whole(&second)) {
        let by_axis = ["largest", "least"].contains(&what.as_str());
        assert!(by_axis || (a - b).abs() <= AGREED * size, "turned: {what} {a} {b}");
    }
    let refused =
        text.replace("shape = [8.768695e-4, 0]", "shape = [8.768695e-4, 0]\nshape_y = [1e-4, 0]");
    let message = input::parse("tank.toml", &refused, &[]).expect_err("two shapes").to_string();
    assert!(
        message.contains("structure.point.2.shape_y") && message.contains("along_y"),
        "{message}"
    );
}
