//! A shear frame given as its modes answers as the frame: every verification case with storeys, and frames of
//! one, five and twenty storeys on sliders of several kinds.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use crate::common::cases::all;
use crate::common::eigen::modes_of;
use slipstick::check::check;
use slipstick::model::{
    Block, Damping, Frame, InitialState, Model, Slider, Stop, Structure, StructureMode,
    StructurePoint,
};
use slipstick::motion::GroundMotion;
use slipstick::response::Response;
use slipstick::slider::Friction;
use slipstick::solver::exact;

/// Largest difference of a figure over its size: that of rounding, which long motions of twenty modes add up.
const AGREED: f64 = 1e-10;

/// The same model with its frame as modes.
fn by_modes(model: &Model) -> Model {
    let frame = model.frame();
    let (m, k) = (&frame.masses_kg, &frame.stiffnesses_n_per_m);
    let n = m.len();
    let (mut modes, mut q, mut v) = (Vec::new(), Vec::new(), Vec::new());
    let (q0, v0) = (model.initial_storey_displacement_m(), model.initial_storey_velocity_m_per_s());
    for (omega, shape) in modes_of(m, k) {
        let l: f64 = shape.iter().zip(m).map(|(phi, m)| phi * m).sum();
        let damping_ratio = match &frame.damping {
            Damping::Ratio(ratio) => *ratio,
            Damping::Dampers(c) => c[0] / (2.0 * m[0] * omega),
        };
        let points = shape.iter().map(|phi| phi * l).collect();
        modes.push(StructureMode {
            frequency_rad_per_s: omega,
            damping_ratio,
            effective_mass_kg: l * l,
            points,
        });
        let amplitude = |x: &[f64]| -> f64 {
            let all = shape.iter().zip(m).zip(x);
            all.map(|((phi, m), x)| phi * m * x).sum::<f64>() / l
        };
        q.push(amplitude(&q0));
        v.push(amplitude(&v0));
    }
    let mut height_m = 0.0;
    let point = |i: usize| StructurePoint {
        name: format!("floor {}", i + 1),
        height_m: frame.heights_m.as_ref().map(|heights_m| {
            height_m += heights_m[i];
            height_m
        }),
        mass_kg: Some(m[i]),
    };
    let points = (0..n).map(point).collect();
    let structure = Structure { mass_kg: m.iter().sum(), modes, in_plane: Vec::new(), points };
    let initial = InitialState {
        storey_displacement_m: Some(q),
        storey_velocity_m_per_s: Some(v),
        ..model.initial().clone()
    };
    let (block, slider) = (*model.block(), model.slider().clone());
    Model::with_modes(block, slider, structure, model.gravity_m_per_s2(), initial).expect("modes")
}

/// Compares all figures of both, over the sizes that matter.
fn assert_alike(name: &str, frame: &Response, modes: &Response) {
    let (a, b) = (&frame.demands, &modes.demands);
    assert_eq!(
        (a.slip_count, a.stick_count, a.reversal_count),
        (b.slip_count, b.stick_count, b.reversal_count),
        "{name}"
    );
    assert!(b.storeys.is_empty() && a.storeys.len() == b.points.len(), "{name}");
    let slide = a.peak_sliding_displacement_m;
    let mut worst: (f64, &str) = (0.0, "");
    let mut same = |what: &'static str, x: f64, y: f64, size: f64| {
        let error = if x == y { 0.0 } else { (x - y).abs() / size };
        if !(error <= worst.0) {
            worst = (error, what);
        }
    };
    same("peak sliding", slide, b.peak_sliding_displacement_m, slide);
    let residual = [a, b].map(|d| d.residual_sliding_displacement_m);
    same("residual", residual[0], residual[1], slide);
    same("path", a.sliding_path_m, b.sliding_path_m, a.sliding_path_m);
    for (what, of) in [
        (
            "velocity",
            (|d| d.peak_sliding_velocity_m_per_s) as fn(&slipstick::response::Demands) -> f64,
        ),
        ("block", |d| d.peak_block_acceleration_m_per_s2),
        ("base shear", |d| d.peak_base_shear_n),
        ("friction", |d| d.peak_friction_force_n),
        ("slider", |d| d.peak_slider_force_n),
        ("overturning", |d| d.overturning_ratio.unwrap_or(0.0)),
    ] {
        same(what, of(a), of(b), of(a));
    }
    for (x, y) in a.storeys.iter().zip(&b.points) {
        let size = x.peak_acceleration_m_per_s2;
        same("acceleration", size, y.peak_acceleration_m_per_s2, size);
        same("displacement", x.peak_displacement_m, y.peak_displacement_m, x.peak_displacement_m);
        same("drift", x.peak_drift_m, y.peak_drift_m, x.peak_drift_m);
        let [fast, other] = [x, y].map(|storey| storey.peak_drift_velocity_m_per_s);
        same("drift velocity", fast, other, fast);
        let ratio = |d: &slipstick::response::StoreyDemands| d.peak_drift_ratio.unwrap_or(0.0);
        same("drift ratio", ratio(x), ratio(y), ratio(x));
    }
    assert!(worst.0 <= AGREED, "{name}: {worst:?}");
}

fn run_both(name: &str, model: &Model, motion: &GroundMotion) {
    let modes = by_modes(model);
    let [frame, of_modes] = [model, &modes].map(|model| exact(model, motion).expect("a response"));
    assert_alike(name, &frame, &of_modes);
    let certificate = check(&modes, motion, &of_modes);
    assert!(certificate.holds(), "{name}: {certificate:?}");
}

#[test]
fn prop_verification_cases_with_storeys_run_both_ways() {
    let mut runs = 0;
    for case in all().iter().filter(|case| case.is_history() && !case.field("initial").is_null()) {
        let model = case.model();
        if model.storeys() > 0 {
            run_both(&case.id, &model, &case.motion(1000, false));
            runs += 1;
        }
    }
    assert!(runs >= 5, "{runs} cases");
}

/// A frame under two sines that beat.
fn frame(n: usize, slider: Slider) -> (Model, GroundMotion) {
    let grade = |i: usize| 1.0 + 0.3 * libm::sin(i as f64 * 1.7);
    let frame = Frame {
        masses_kg: (0..n).map(|i| 4e4 * grade(i)).collect(),
        stiffnesses_n_per_m: (0..n).map(|i| 3e7 * n as f64 * grade(i + 3)).collect(),
        damping: Damping::Ratio(0.03),
        heights_m: Some(vec![3.5; n]),
    };
    let block = Block { mass_kg: 1e5, width_m: Some(12.0), height_m: Some(1.0) };
    let model = Model::new(block, slider, frame, 9.80665, InitialState::rest()).expect("a model");
    let sample = |i: u32| {
        let t = 0.01 * f64::from(i);
        2.5 * libm::sin(6.1 * t) + 1.5 * libm::sin(19.3 * t)
    };
    let motion =
        GroundMotion::evenly_spaced(0.01, (0..1500).map(sample).collect(), None).expect("a motion");
    (model, motion)
}

#[test]
fn prop_frames_of_1_5_and_20_storeys_run_both_ways() {
    for n in [1, 5, 20] {
        let friction = Friction::new(0.08, 0.06).expect("friction");
        let stop = Stop::elastic([Some(0.03); 2], 5e7, 1e5);
        for (kind, slider) in [
            ("spring", Slider::sprung(friction.clone(), 1e6)),
            ("stop", Slider { ends: stop.into(), ..Slider::sprung(friction.clone(), 1e6) }),
            (
                "rigid stop",
                Slider {
                    ends: Stop::rigid([Some(0.02); 2], 0.4).into(),
                    tilt_rad: 0.004,
                    ..Slider::sprung(friction.clone(), 1e6)
                },
            ),
        ] {
            let (model, motion) = frame(n, slider);
            run_both(&format!("{n} storeys, {kind}"), &model, &motion);
        }
    }
}

/// What one mode lacks of the mass, or two, moves with the block: a point on a rigid frame is the block. One mode has more
/// points than eight outputs tell.
#[test]
fn mass_without_a_mode_moves_with_the_block() {
    for modes in [1, 2] {
        let friction = Friction::new(0.08, 0.06).expect("friction");
        let (model, motion) = frame(5, Slider::sprung(friction, 1e6));
        let whole = by_modes(&model);
        let mut structure = whole.structure().expect("modes").clone();
        structure.modes.truncate(modes);
        let block = Block { mass_kg: whole.bare_block_kg(), ..*whole.block() };
        let (slider, initial) = (whole.slider().clone(), InitialState::rest());
        let cut = Model::with_modes(block, slider, structure, 9.80665, initial).expect("modes");
        let (total, missing_kg) =
            (cut.total_mass_kg(), cut.structure().expect("modes").missing_mass_kg());
        assert!((total / whole.total_mass_kg() - 1.0).abs() < 1e-14 && missing_kg > 0.0);
        let response = exact(&cut, &motion).expect("a response");
        assert!(check(&cut, &motion, &response).holds());
        let history = response.history.as_ref().expect("a history");
        // Σ φ q̈ + (1 − Σ φ L) u is the printed acceleration: its largest at knots is below the peak.
        for (i, point) in response.demands.points.iter().enumerate() {
            let largest = (0..history.len())
                .map(|k| history.point_acceleration(k, i).abs())
                .fold(0.0, f64::max);
            let peak = point.peak_acceleration_m_per_s2;
            assert!(
                largest <= peak * (1.0 + 1e-12) && largest > 0.9 * peak,
                "{i}: {largest} {peak}"
            );
        }
        // Truncated modes against all: close, not the same.
        let all = exact(&whole, &motion).expect("a response").demands;
        let ratio = response.demands.peak_sliding_displacement_m / all.peak_sliding_displacement_m;
        assert!((ratio - 1.0).abs() < 0.2 && ratio != 1.0, "{ratio}");
    }
}

/// A printed figure of a point that is not so is found.
#[test]
fn prop_tampered_points_are_found() {
    let friction = Friction::new(0.08, 0.06).expect("friction");
    let (model, motion) = frame(5, Slider::sprung(friction, 1e6));
    let model = by_modes(&model);
    let response = exact(&model, &motion).expect("a response");
    for i in 0..5 {
        for which in 0..3 {
            let mut tampered = response.clone();
            let point = &mut tampered.demands.points[i];
            let value = match which {
                0 => &mut point.peak_acceleration_m_per_s2,
                1 => &mut point.peak_displacement_m,
                _ => &mut point.peak_drift_m,
            };
            *value *= 1.0 + 1e-8;
            assert!(!check(&model, &motion, &tampered).holds(), "point {i}, figure {which}");
        }
    }
}
