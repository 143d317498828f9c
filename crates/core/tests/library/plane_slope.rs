//! A surface that is tilted along both axes, under motions in two horizontal directions: closed forms, what turning
//! must not change, and what a certificate says.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use crate::common::random_in_plane::{System, in_plane, libm_sin};
use crate::plane::{agree, all_agree, is_on_a_line, turned};
use slipstick::check::check;
use slipstick::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::notice::NoticeKind;
use slipstick::response::Response;
use slipstick::slider::Friction;
use slipstick::solver::exact;

const G: f64 = 9.80665;

fn certified(model: &Model, motion: &GroundMotion) -> Response {
    let response = exact(model, motion).expect("a response");
    let certificate = check(model, motion, &response);
    assert!(certificate.holds(), "{certificate:?}");
    response
}

/// A table that stands for so many samples of 0.01 s.
fn still(samples: usize) -> GroundMotion {
    let zeros = || vec![0.0; samples];
    let x = GroundMotion::evenly_spaced(0.01, zeros(), None).expect("a motion");
    x.with_y(zeros()).expect("a motion")
}

/// A block on a surface whose axes rise by these sines, with a start.
fn block(friction: Friction, slope: [f64; 2], velocity: [f64; 2]) -> Model {
    let [tilt_rad, tilt_y_rad] = slope.map(libm::asin);
    let slider = Slider { tilt_rad, tilt_y_rad, ..Slider::new(friction) };
    let start = |axis: usize| InitialState {
        sliding_velocity_m_per_s: velocity[axis],
        ..InitialState::rest()
    };
    let along_y = AlongY {
        stiffnesses_n_per_m: Vec::new(),
        damping: Damping::Ratio(0.0),
        width_m: None,
        initial: start(1),
    };
    let block = Block { mass_kg: 300.0, width_m: None, height_m: None };
    Model::new(block, slider, Frame::none(), G, start(0))
        .and_then(|model| model.with_along_y(along_y))
        .expect("a model")
}

/// Both axes lie in the surface: `cos² θ = 1 − sin² θ_x − sin² θ_y`, and down the slope `s = −½ g (sin θ − μ cos θ) t²`.
#[test]
fn slides_straight_down_a_slope() {
    let (slope, mu) = ([0.12, -0.16], 0.09);
    let model = block(Friction::new(0.1, mu).expect("friction"), slope, [0.0; 2]);
    let response = certified(&model, &still(201));
    let sine = libm::hypot(slope[0], slope[1]);
    let cosine = (1.0 - sine * sine).sqrt();
    assert!((model.normal_n() - 300.0 * G * cosine).abs() <= 1e-12 * model.normal_n());
    let path = 0.5 * G * (sine - mu * cosine) * 4.0;
    let plane = response.in_plane.as_deref().expect("two directions");
    for (axis, part) in plane.axes.iter().zip(slope) {
        let (found, expected) = (axis.residual_sliding_displacement_m, -path * part / sine);
        assert!((found - expected).abs() <= 1e-13 * path, "{found} {expected}");
    }
    // Its acceleration is that over the ground, without the slope's share.
    let found = response.demands.peak_block_acceleration_m_per_s2;
    assert!((found - G * (sine - mu * cosine)).abs() <= 1e-13 * G, "{found}");
    let told = response.warnings.iter().find(|w| w.kind == NoticeKind::SlideNeedNotStop);
    let told = told.expect("a warning").message.clone();
    assert!(told.starts_with("the slope 0.2041 is above the kinetic friction 0.09"), "{told}");
}

/// Launched across a slope that friction just holds: the speed loses what the speed downhill gains.
#[test]
fn speed_and_speed_downhill_add_up_to_what_they_were() {
    let slope = [0.06, 0.08];
    let mu = 0.1 / (1.0 - 0.01_f64).sqrt();
    let model = block(Friction::new(mu, mu).expect("friction"), slope, [0.8, -0.6]);
    let response = certified(&model, &still(401));
    let x = response.history.as_ref().expect("a history");
    let y = response.in_plane.as_ref().and_then(|plane| plane.history.as_ref()).expect("along y");
    for (w_x, w_y) in x.sliding_velocity_m_per_s.iter().zip(&y.sliding_velocity_m_per_s) {
        let downhill = -(w_x * slope[0] + w_y * slope[1]) / 0.1;
        assert!((libm::hypot(*w_x, *w_y) + downhill - 1.0).abs() <= 1e-13, "{w_x} {w_y}");
    }
    let last = |list: &[f64]| *list.last().expect("a knot");
    let [w_x, w_y] = [last(&x.sliding_velocity_m_per_s), last(&y.sliding_velocity_m_per_s)];
    // After 4 s it is on its way straight down, at half its speed.
    assert!((libm::hypot(w_x, w_y) - 0.5).abs() < 0.01, "{w_x} {w_y}");
}

/// A frame at rest on a slope that friction holds: it leans as its springs do, and nothing of it is an acceleration.
#[test]
fn a_frame_at_rest_on_a_slope_leans_and_does_not_move() {
    let mut system = System::random(3, false);
    system.floors_kg = vec![400.0];
    system.stiffnesses = [vec![4e4], vec![9e4]];
    system.by_speed = None;
    (system.friction, system.vertical, system.initial) = ([0.08, 0.07], None, [[0.0; 2]; 2]);
    system.slope = [0.03, -0.05];
    system.table.iter_mut().for_each(|a| a.fill(0.0));
    let (model, motion) = (system.model(), system.motion());
    let response = certified(&model, &motion);
    assert!(response.events.is_empty());
    let plane = response.in_plane.as_deref().expect("two directions");
    for (axis, (slope, k)) in plane.axes.iter().zip([(0.03, 4e4), (0.05, 9e4)]) {
        let leans_m = 400.0 * G * slope / k;
        let storey = &axis.storeys[0];
        assert!((storey.peak_displacement_m - leans_m).abs() <= 1e-13 * leans_m);
        assert!(storey.peak_acceleration_m_per_s2 <= 1e-13 * G);
        assert!(axis.peak_block_acceleration_m_per_s2 == 0.0);
        let held_n = model.total_mass_kg() * G * slope;
        assert!((axis.peak_friction_force_n - held_n).abs() <= 1e-13 * held_n);
    }
}

#[test]
fn prop_turning_a_slope_with_all_vectors_turns_the_response() {
    all_agree("turned on a slope", true, |seed, system| {
        let system = system.on_a_slope(seed);
        let by = turned(0.2 + 0.7 * seed as f64);
        (system.response(), system.changed(by).response())
    });
}

#[test]
fn prop_a_slope_along_the_line_of_a_motion_is_one_direction() {
    all_agree("along a line up a slope", true, |seed, system| {
        let (system, angle) = (system.on_a_slope(seed), 0.3 + 0.9 * seed as f64);
        let along = system.along_a_line(angle);
        let (model, motion, response) = (along.model(), along.motion(), along.response());
        let certificate = check(&model, &motion, &response);
        assert!(certificate.holds(), "seed {seed}: {certificate:?}");
        let (sine, cosine) = (libm_sin(angle), libm_sin(angle + core::f64::consts::FRAC_PI_2));
        is_on_a_line(seed, &response, [cosine, sine]);
        (system.along_x(), response)
    });
}

/// A slope along x under a motion along x has the bits of one direction, and one that rises along y alone has not.
#[test]
fn nothing_along_y_gives_the_bits_of_one_direction_on_a_slope() {
    let mut differ = 0;
    for seed in 0..12 {
        let mut system = System::random(seed, true).on_a_slope(seed).along_a_line(0.0);
        let (plane, straight) = (system.response(), system.along_x());
        assert_eq!(agree(&plane, &straight), Ok(0.0), "seed {seed}");
        let h = |response: &Response| response.history.clone().expect("a history");
        assert_eq!(h(&plane).sliding_displacement_m, h(&straight).sliding_displacement_m);
        assert_eq!(
            h(&plane).storey_acceleration_m_per_s2,
            h(&straight).storey_acceleration_m_per_s2
        );
        system.slope = [0.0, system.slope[0]];
        let (model, motion, response) = (system.model(), system.motion(), system.response());
        let certificate = check(&model, &motion, &response);
        assert!(certificate.holds(), "seed {seed}: {certificate:?}");
        differ += usize::from(agree(&response, &straight).is_err());
    }
    assert!(differ > 9, "{differ}");
}

/// The start of a structure by its modes is that of the frame whose modes they are.
fn drawn(seed: u64) -> (Model, GroundMotion) {
    let slope = System::random(seed, false).on_a_slope(seed).slope;
    let (model, motion) = in_plane(seed);
    let [tilt_rad, tilt_y_rad] = slope.map(libm::asin);
    let slider = Slider { tilt_rad, tilt_y_rad, ..model.slider().clone() };
    let (block, initial) = (*model.block(), model.initial().clone());
    let tilted = match model.structure() {
        None => Model::new(block, slider, model.frame().clone(), G, initial),
        Some(structure) => {
            let block = Block { mass_kg: model.bare_block_kg(), ..block };
            Model::with_modes(block, slider, structure.clone(), G, initial)
        }
    };
    let tilted = tilted.and_then(|tilted| tilted.with_along_y(model.along_y()));
    (tilted.expect("a model"), motion)
}

fn drawn_are_certified(seeds: core::ops::Range<u64>) {
    for seed in seeds {
        let (model, motion) = drawn(seed);
        let certificate = check(&model, &motion, &exact(&model, &motion).expect("a response"));
        assert!(certificate.holds(), "seed {seed}: {certificate:?}");
    }
}

#[test]
fn prop_random_systems_on_slopes_are_certified() {
    drawn_are_certified(0..80);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn prop_many_random_systems_on_slopes_are_certified() {
    drawn_are_certified(0..2000);
}
