//! Friction by straight lines of the speed in two horizontal directions: what a damper does, what one direction does, what
//! turning must not change, and what a certificate says.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use crate::common::random_in_plane::{Random, Restoring, System};
use crate::plane::{agree, all_agree, turned};
use slipstick::check::check;
use slipstick::response::Response;
use slipstick::solver::exact;

/// The response, and whether its certificate holds.
fn certified(seed: u64, system: &System) -> Response {
    let (model, motion, response) = (system.model(), system.motion(), system.response());
    let certificate = check(&model, &motion, &response);
    assert!(certificate.holds(), "seed {seed}: {certificate:?}");
    response
}

/// Friction in proportion to the speed is a damper: nothing turns, and the motion is linear.
#[test]
fn friction_in_proportion_to_the_speed_is_a_damper() {
    for seed in 0..12 {
        let mut system = System::random(seed, false);
        (system.by_speed, system.vertical) = (None, None);
        let mut damped = system.clone();
        system.friction = [0.0; 2];
        system.corners = vec![[50.0, 3.0]];
        damped.friction = [0.0; 2];
        damped.damper += 3.0 / 50.0 * damped.model().normal_n();
        let (found, expected) = (certified(seed, &system), damped.response());
        let peak = |of: fn(&slipstick::response::Demands) -> f64| {
            let [found, expected] = [&found, &expected].map(|response| of(&response.demands));
            assert!((found - expected).abs() <= 1e-11 * expected, "{seed}: {found} {expected}");
        };
        peak(|d| d.peak_sliding_displacement_m);
        peak(|d| d.residual_sliding_displacement_m);
        peak(|d| d.sliding_path_m);
        peak(|d| d.peak_sliding_velocity_m_per_s);
        peak(|d| d.peak_block_acceleration_m_per_s2);
    }
}

/// A corner on a straight line, and one beyond all speeds, change nothing.
#[test]
fn corners_without_a_bend_change_nothing() {
    for seed in 0..12 {
        let mut system = System::random(seed, false).with_lines(seed);
        let own = certified(seed, &system);
        let [speed, mu] = system.corners[0];
        let kinetic = system.friction[1];
        let between = |part: f64| [part * speed, kinetic + part * (mu - kinetic)];
        system.corners.splice(0..0, [between(0.3), between(0.6)]);
        let last = *system.corners.last().expect("a corner");
        system.corners.push([last[0] + 100.0, last[1]]);
        let other = certified(seed, &system);
        assert!(agree(&own, &other).is_ok(), "{seed}: {:?}", agree(&own, &other));
    }
}

/// Beside a line by next to nothing the motion is solved in two directions, and is that of one.
#[test]
fn prop_beside_a_line_is_one_direction() {
    all_agree("beside a line", true, |seed, system| {
        let mut beside = system.with_lines(seed).along_a_line(0.0);
        let straight = beside.along_x();
        beside.table[1] = beside.table[0].iter().map(|x| 1e-14 * x * x).collect();
        (straight, beside.response())
    });
}

#[test]
fn prop_turning_all_vectors_turns_the_response() {
    all_agree("lines turned", true, |seed, system| {
        let system = system.with_lines(seed);
        (system.response(), system.changed(turned(0.1 + 0.7 * seed as f64)).response())
    });
}

/// Many short lines come to the curve that they are chords of, an error of the square of their length.
#[test]
fn short_lines_come_to_the_exponential_curve() {
    let mut system = System::random(9, false);
    (system.friction, system.vertical, system.slider) = ([0.03; 2], None, Restoring::Pendulum(2.0));
    system.by_speed = Some([0.08, 12.0]);
    let exact_m = system.response().demands.peak_sliding_displacement_m;
    system.by_speed = None;
    let errors = [20, 40].map(|count| {
        let at = |i: u32| 0.8 * f64::from(i) / f64::from(count);
        let mu = |speed: f64| 0.03 - 0.05 * libm::expm1(-12.0 * speed);
        system.corners = (1..=count).map(|i| [at(i), mu(at(i))]).collect();
        let found = certified(u64::from(count), &system).demands.peak_sliding_displacement_m;
        (found - exact_m).abs() / exact_m
    });
    let ratio = errors[0] / errors[1];
    assert!(errors[0] < 0.01 && (3.0..5.0).contains(&ratio), "{errors:?}");
}

fn drawn_are_certified(seeds: core::ops::Range<u64>) {
    for seed in seeds {
        let system = System::random(seed, false).with_lines(seed);
        let sloped = Random::new(seed).chance(0.2);
        let system = if sloped { system.on_a_slope(seed) } else { system };
        let (model, motion) = (system.model(), system.motion());
        let certificate = check(&model, &motion, &exact(&model, &motion).expect("a response"));
        assert!(certificate.holds(), "seed {seed}: {certificate:?}");
    }
}

#[test]
fn prop_random_systems_are_certified() {
    drawn_are_certified(0..80);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn prop_many_random_systems_are_certified() {
    drawn_are_certified(0..2000);
}
