//! Shears of storeys: what springs say of them, what moves the mass above, and the same in one direction and in two, with
//! contents and by modes.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use crate::common::by_modes::by_modes;
use crate::common::random_in_plane::{Random, System, in_plane};
use slipstick::check::check;
use slipstick::model::{Contents, Frame, Model};
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, Response, StoreyDemands};
use slipstick::solver::exact;

fn certified(model: &Model, motion: &GroundMotion) -> Response {
    let response = exact(model, motion).expect("a response");
    let certificate = check(model, motion, &response);
    assert!(certificate.holds(), "{certificate:?}");
    response
}

fn shear_n(storey: &StoreyDemands) -> f64 {
    storey.peak_shear_n.expect("a shear")
}

/// Without dampers the shear of a storey is that of its spring; the first is the base shear, the last moves the top.
fn are_of_springs(demands: &Demands, frame: &Frame, what: &str) {
    let near = |found: f64, expected: f64| {
        let scale = demands.peak_base_shear_n;
        assert!((found - expected).abs() <= 1e-11 * scale, "{what}: {found} {expected}");
    };
    for (storey, k) in demands.storeys.iter().zip(&frame.stiffnesses_n_per_m) {
        near(shear_n(storey), k * storey.peak_drift_m);
    }
    near(shear_n(&demands.storeys[0]), demands.peak_base_shear_n);
}

fn undamped(seed: u64) -> System {
    let mut system = System::random(seed, false);
    let mut r = Random::new(seed);
    let storeys = 2 + (r.unit() * 4.0) as usize;
    system.floors_kg = (0..storeys).map(|_| r.between(200.0, 900.0)).collect();
    let floors_kg = system.floors_kg.clone();
    system.stiffnesses =
        [0; 2].map(|_| floors_kg.iter().map(|m| m * r.between(200.0, 2500.0)).collect());
    (system.dampers, system.damping, system.vertical) = (false, [0.0; 2], None);
    system
}

#[test]
fn without_dampers_they_are_those_of_the_springs() {
    for seed in 0..12 {
        let system = undamped(seed);
        let (model, motion) = (system.model(), system.motion());
        let plane = certified(&model, &motion);
        for (axis, k) in plane.in_plane.iter().flat_map(|p| &p.axes).zip(&system.stiffnesses) {
            let frame = Frame { stiffnesses_n_per_m: k.clone(), ..model.frame().clone() };
            are_of_springs(axis, &frame, "along an axis");
        }
        let line = system.along_a_line(0.0).model();
        let along_x = GroundMotion::new(system.times_s.clone(), system.table[0].clone(), None);
        let along_x = along_x.expect("a motion");
        are_of_springs(&certified(&line, &along_x).demands, line.frame(), "along x");
        let item =
            Contents { floor: 2, mass_kg: 90.0, static_friction: 0.04, kinetic_friction: 0.03 };
        let with = line.clone().with_contents(vec![item, Contents { floor: 0, ..item }]);
        let with = with.expect("a model");
        let response = certified(&with, &along_x);
        assert!(response.demands.contents[0].slip_count > 0, "seed {seed}: contents that slide");
        are_of_springs(&response.demands, with.frame(), "with contents");
    }
}

/// A frame by its modes, whose points have its masses, has its shears.
#[test]
fn by_modes_they_are_those_of_the_frame() {
    for seed in 0..12 {
        let mut system = undamped(seed);
        system.damping = [0.03, 0.05];
        let (model, motion) = (system.model(), system.motion());
        let (frame, modes) = (exact(&model, &motion), certified(&by_modes(&model), &motion));
        let frame = frame.expect("a response");
        for (storey, point) in frame.demands.storeys.iter().zip(&modes.demands.points) {
            let (found, expected) = (shear_n(point), shear_n(storey));
            assert!((found - expected).abs() <= 1e-10 * frame.demands.peak_base_shear_n, "{seed}");
        }
    }
}

/// Of modes that leave out a part of the mass, which then moves with the block, the check finds the same shears.
#[test]
fn of_cut_modes_they_are_certified() {
    let mut with_shears = 0;
    for seed in 0..40 {
        let (model, motion) = in_plane(seed);
        let response = certified(&model, &motion);
        let points = response.demands.points.iter().chain(&response.demands.storeys);
        with_shears += points.filter(|point| point.peak_shear_n.is_some_and(|n| n > 0.0)).count();
    }
    assert!(with_shears > 40, "{with_shears}");
}
