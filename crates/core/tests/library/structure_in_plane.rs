//! Structures by their modes in two horizontal directions: a shear frame given as its modes answers as the frame, a
//! structure that is turned with its motion gives turned vectors, and what modes lack of the mass moves with the block.

// Helpers of tests may panic as tests do; the numbers of a run are for people who look for them with --nocapture.
#![allow(clippy::expect_used, clippy::disallowed_macros)]

use crate::common::eigen::modes_of;
use crate::common::in_plane::{cases, model as model_of_case, motion as motion_of_case};
use slipstick::check::check;
use slipstick::model::{
    AlongY, Block, Damping, Frame, InitialState, ModeInPlane, Model, Slider, Structure,
    StructureMode, StructurePoint,
};
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, Response};
use slipstick::slider::Friction;
use slipstick::solver::exact;

/// Largest difference of a figure over its size: that of rounding.
const AGREED: f64 = 1e-10;

/// A structure of such modes; along x alone those that take part there.
fn structure(mass_kg: f64, in_plane: Vec<ModeInPlane>, points: Vec<StructurePoint>) -> Structure {
    let along_x = in_plane.iter().filter(|mode| mode.participation[0] != 0.0);
    let modes = along_x.map(|mode| StructureMode {
        frequency_rad_per_s: mode.frequency_rad_per_s,
        damping_ratio: mode.damping_ratio,
        effective_mass_kg: mode.participation[0] * mode.participation[0],
        points: mode.points.iter().map(|shape| shape[0] * mode.participation[0]).collect(),
    });
    Structure { mass_kg, modes: modes.collect(), in_plane, points }
}

/// The same model with its frame as modes.
fn by_modes(model: &Model) -> Model {
    let (frame, y) = (model.frame(), model.along_y());
    let m = &frame.masses_kg;
    let axes = [
        (&frame.stiffnesses_n_per_m, &frame.damping, model.initial().clone()),
        (&y.stiffnesses_n_per_m, &y.damping, y.initial.clone()),
    ];
    let mut all = Vec::new();
    for (axis, (k, damping, initial)) in axes.into_iter().enumerate() {
        for (omega, shape) in modes_of(m, k) {
            let l: f64 = shape.iter().zip(m).map(|(phi, m)| phi * m).sum();
            let damping_ratio = match damping {
                Damping::Ratio(ratio) => *ratio,
                Damping::Dampers(c) => c[0] / (2.0 * m[0] * omega),
            };
            let along = |x: f64| if axis == 0 { [x, 0.0] } else { [0.0, x] };
            let amplitude = |x: &Option<Vec<f64>>| -> f64 {
                let given = x.iter().flatten().zip(&shape).zip(m);
                given.map(|((x, phi), m)| x * phi * m).sum::<f64>() / l.abs()
            };
            let start = [&initial.storey_displacement_m, &initial.storey_velocity_m_per_s];
            let mode = ModeInPlane {
                frequency_rad_per_s: omega,
                damping_ratio,
                participation: along(l),
                points: shape.iter().map(|phi| along(*phi)).collect(),
            };
            all.push((mode, start.map(amplitude)));
        }
    }
    all.sort_by(|a, b| a.0.frequency_rad_per_s.total_cmp(&b.0.frequency_rad_per_s));
    let mut height_m = 0.0;
    let points = (0..m.len()).map(|i| StructurePoint {
        name: format!("floor {}", i + 1),
        height_m: frame.heights_m.as_ref().map(|heights_m| {
            height_m += heights_m[i];
            height_m
        }),
        mass_kg: Some(m[i]),
    });
    let points = points.collect();
    let start = |which: usize| Some(all.iter().map(|(_, start)| start[which]).collect());
    let initial_y = InitialState {
        storey_displacement_m: start(0),
        storey_velocity_m_per_s: start(1),
        ..y.initial.clone()
    };
    let in_plane = all.into_iter().map(|(mode, _)| mode).collect();
    let structure = structure(m.iter().sum(), in_plane, points);
    let initial = InitialState {
        storey_displacement_m: None,
        storey_velocity_m_per_s: None,
        ..model.initial().clone()
    };
    with_structure(model, structure, initial, initial_y)
}

fn with_structure(
    like: &Model,
    structure: Structure,
    initial: InitialState,
    initial_y: InitialState,
) -> Model {
    let along_y = AlongY {
        stiffnesses_n_per_m: Vec::new(),
        damping: Damping::Ratio(0.0),
        width_m: like.along_y().width_m,
        initial: initial_y,
    };
    let block = Block { mass_kg: like.bare_block_kg(), ..*like.block() };
    Model::with_modes(block, like.slider().clone(), structure, like.gravity_m_per_s2(), initial)
        .and_then(|model| model.with_along_y(along_y))
        .expect("a structure")
}

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

/// Modes that move along x and y at once: those of the frame at an angle, of which some are cut, so that what moves
/// with the block is not as much along x as along y and joins both.
fn cut_and_turned(model: &Model, kept: usize, angle: f64) -> Model {
    let whole = by_modes(model);
    let mut structure = whole.structure().expect("modes").clone();
    structure.in_plane.truncate(kept);
    let turn = turned(angle);
    for mode in &mut structure.in_plane {
        mode.participation = turn(mode.participation);
        mode.points.iter_mut().for_each(|shape| *shape = turn(*shape));
    }
    let structure = self::structure(structure.mass_kg, structure.in_plane, structure.points);
    with_structure(&whole, structure, InitialState::rest(), InitialState::rest())
}

fn turned(angle: f64) -> impl Fn([f64; 2]) -> [f64; 2] {
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    move |[x, y]| [cosine * x - sine * y, sine * x + cosine * y]
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
