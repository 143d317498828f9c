//! A stop around the block in two horizontal directions: closed forms, what one direction does, what turning must not
//! change, and what a certificate says.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use crate::common::random_in_plane::{Random, System};
use crate::plane::{agree, all_agree, turned};
use slipstick::check::check;
use slipstick::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::response::{Contact, EventKind, Response};
use slipstick::slider::{Friction, Stop};
use slipstick::solver::exact;

fn certified(seed: u64, system: &System) -> Response {
    let (model, motion) = (system.model(), system.motion());
    let response = exact(&model, &motion).expect("a response");
    let certificate = check(&model, &motion, &response);
    assert!(certificate.holds(), "seed {seed}: {certificate:?}");
    response
}

/// A ring that is not reached changes no bit.
#[test]
fn a_ring_that_is_not_reached_changes_nothing() {
    for seed in 0..12 {
        let free = System::random(seed, false);
        let mut within = free.clone();
        let own = free.response();
        let gap_m = [Some(1.001 * own.demands.peak_sliding_displacement_m + 1e-6); 2];
        for ring in [Stop::elastic(gap_m, 1e6, 1e3), Stop::rigid(gap_m, 0.3)] {
            within.ring = Some(ring);
            let ringed = certified(seed, &within);
            let stop = ringed.demands.stop.expect("a stop");
            assert_eq!((stop.contact_count, stop.impact_count, stop.peak_force_n), (0, 0, 0.0));
            assert_eq!(agree(&own, &ringed), Ok(0.0), "seed {seed}");
            let s = |r: &Response| r.history.as_ref().map(|h| h.sliding_displacement_m.clone());
            assert_eq!(s(&own), s(&ringed), "seed {seed}");
        }
    }
}

/// A block of 250 kg on a table that stands still, within a ring, from a place with a velocity along x and along y.
fn thrown(ring: Stop, friction: f64, from: [[f64; 2]; 2]) -> Response {
    let start = |[s, w]: [f64; 2]| InitialState {
        sliding_displacement_m: s,
        sliding_velocity_m_per_s: w,
        ..InitialState::rest()
    };
    let friction = Friction::new(friction, friction).expect("friction");
    let slider = Slider { ends: ring.into(), ..Slider::new(friction) };
    let block = Block { mass_kg: 250.0, width_m: None, height_m: None };
    let along_y = AlongY {
        stiffnesses_n_per_m: Vec::new(),
        damping: Damping::Ratio(0.0),
        width_m: None,
        initial: start(from[1]),
    };
    let model = Model::new(block, slider, Frame::none(), 9.81, start(from[0]))
        .and_then(|model| model.with_along_y(along_y))
        .expect("a model");
    let still = || vec![0.0; 200];
    let motion = GroundMotion::evenly_spaced(0.01, still(), None)
        .and_then(|motion| motion.with_y(still()))
        .expect("a motion");
    let response = exact(&model, &motion).expect("a response");
    let certificate = check(&model, &motion, &response);
    assert!(certificate.holds(), "{certificate:?}");
    response
}

/// Without friction, between walls that give everything back, a block goes along chords of one length; walls that give
/// nothing back turn it along them at once, for ever.
#[test]
fn walls_around_a_block_without_friction_are_a_billiard() {
    let from = [[0.05, 1.2], [-0.1, 0.9]];
    let radial = (2.25_f64 - (0.165 / 0.2) * (0.165 / 0.2)).sqrt();
    let response = thrown(Stop::rigid([Some(0.2); 2], 1.0), 0.0, from);
    let stop = response.demands.stop.expect("a stop");
    let times_s: Vec<f64> = response.events.iter().map(|event| event.time_s).collect();
    assert!(response.events.iter().all(|event| event.kind == EventKind::Impact));
    assert!(stop.impact_count > 8 && stop.peak_force_n == 0.0, "{stop:?}");
    assert!((stop.peak_impact_speed_m_per_s - radial).abs() <= 1e-14, "{stop:?}");
    // 2 √(d² − (L/v)²)/v, with the moment L about the centre.
    let chord_s = 2.0 * (0.04_f64 - (0.165 / 1.5) * (0.165 / 1.5)).sqrt() / 1.5;
    for pair in times_s.windows(2) {
        assert!((pair[1] - pair[0] - chord_s).abs() <= 1e-14, "{pair:?} {chord_s}");
    }
    let response = thrown(Stop::rigid([Some(0.2); 2], 0.0), 0.0, from);
    let stop = response.demands.stop.expect("a stop");
    assert_eq!((stop.contact_count, stop.impact_count), (1, 0));
    // With the velocity along it that is left, for ever.
    let speed: f64 = 0.165 / 0.2;
    assert!((stop.peak_force_n - 250.0 * speed * speed / 0.2).abs() <= 1e-11, "{stop:?}");
    let first_s = response.events[0].time_s;
    assert!((stop.contact_time_s - (1.99 - first_s)).abs() <= 1e-13, "{stop:?}");
    let (x, y) = places(&response);
    let turned = libm::atan2(y[199], x[199]) - libm::atan2(y[100], x[100]);
    let full = 2.0 * core::f64::consts::PI;
    let off = (turned - speed * 0.99 / 0.2) / full;
    assert!((off - off.round()).abs() <= 1e-13, "{off}");
}

/// Along walls a block with friction goes as far as along a line, and is at rest there.
#[test]
fn along_walls_friction_slows_a_block_down_as_on_a_line() {
    let response = thrown(Stop::rigid([Some(0.25); 2], 0.4), 0.05, [[0.25, 0.0], [0.0, 0.6]]);
    let (demands, (x, y)) = (&response.demands, places(&response));
    let stop = demands.stop.expect("a stop");
    let slowing = 0.05 * 9.81;
    let path_m = 0.36 / (2.0 * slowing);
    assert!(
        (demands.sliding_path_m - path_m).abs() <= 1e-14,
        "{} {path_m}",
        demands.sliding_path_m
    );
    assert!((stop.peak_force_n - 250.0 * 0.36 / 0.25).abs() <= 1e-11, "{stop:?}");
    let (last, angle) = (x.len() - 1, path_m / 0.25);
    let end = [0.25 * libm::cos(angle), 0.25 * libm::sin(angle)];
    assert!(libm::hypot(x[last] - end[0], y[last] - end[1]) <= 1e-14, "{} {}", x[last], y[last]);
    assert!((demands.sliding_time_s - 0.6 / slowing).abs() <= 1e-13);
    assert!(!demands.sliding_at_end);
}

/// `s` along x and y at the samples.
fn places(response: &Response) -> (Vec<f64>, Vec<f64>) {
    let x = response.history.as_ref().expect("a history");
    let y = response.in_plane.as_ref().and_then(|plane| plane.history.as_ref()).expect("along y");
    let at = |list: &[f64]| x.rows.iter().map(|row| list[*row]).collect();
    (at(&x.sliding_displacement_m), at(&y.sliding_displacement_m))
}

/// A block without friction that flies into a ring keeps its energy and its moment about the centre, and leaves as fast
/// as it came, along the mirrored path.
#[test]
fn a_ring_without_friction_and_damper_is_a_mirror() {
    let ring = Stop::elastic([Some(0.2); 2], 4e5, 0.0);
    let response = thrown(ring, 0.0, [[0.05, 1.2], [-0.1, 0.9]]);
    let x = response.history.as_ref().expect("a history");
    let y = response.in_plane.as_ref().and_then(|plane| plane.history.as_ref()).expect("along y");
    let mut contacts = 0;
    for k in 0..x.len() {
        let (s_x, s_y) = (x.sliding_displacement_m[k], y.sliding_displacement_m[k]);
        let (w_x, w_y) = (x.sliding_velocity_m_per_s[k], y.sliding_velocity_m_per_s[k]);
        let moment = s_x * w_y - s_y * w_x;
        assert!((moment - (0.05 * 0.9 + 0.1 * 1.2)).abs() <= 1e-13, "{moment}");
        let depth = libm::hypot(s_x, s_y) - 0.2;
        let pressed = x.contact[k] != Contact::Free;
        contacts += u32::from(pressed);
        let stored = if pressed { 4e5 * depth * depth / 250.0 } else { 0.0 };
        let energy = w_x * w_x + w_y * w_y + stored;
        assert!((energy - 2.25).abs() <= 2e-13, "{energy}");
        assert!(pressed == (depth > 0.0) || depth.abs() <= 1e-15, "{depth}");
    }
    let stop = response.demands.stop.expect("a stop");
    assert!(contacts > 20 && stop.contact_count >= 4, "{contacts} {stop:?}");
    // The radial speed of each impact is what the moment leaves of the speed.
    let radial = (2.25_f64 - (0.165 / 0.2) * (0.165 / 0.2)).sqrt();
    assert!((stop.peak_impact_speed_m_per_s - radial).abs() <= 1e-13, "{stop:?}");
    let leaves = response.events.iter().filter(|event| event.kind == EventKind::Leave).count();
    assert!(leaves as u64 + 1 >= stop.contact_count);
}

/// Beside a line by next to nothing the motion is solved in two directions, and is that of one with the same stop. (Without
/// kinetic friction a block beside the line passes rest where one on it is held.)
#[test]
fn prop_struck_head_on_is_one_direction() {
    let mut struck = 0;
    all_agree("beside a line", true, |seed, system| {
        let mut system = system.clone();
        system.friction[1] = system.friction[1].max(0.5 * system.friction[0]);
        let mut beside = system.along_a_line(0.0).with_ring(seed);
        let straight = beside.along_x();
        beside.table[1] = beside.table[0].iter().map(|x| 1e-15 * x * x).collect();
        (straight, beside.response())
    });
    for seed in 0..12 {
        let line = System::random(seed, true).along_a_line(0.0);
        for system in [line.with_ring(seed), line.with_wall(seed)] {
            let [one, both] = [system.along_x(), certified(seed, &system)];
            let stops = [one, both].map(|r| r.demands.stop.expect("a stop"));
            assert_eq!(stops[0], stops[1], "seed {seed}");
            struck += stops[0].contact_count + stops[0].impact_count;
        }
    }
    assert!(struck > 24, "{struck}");
}

#[test]
fn prop_turning_all_vectors_turns_the_response() {
    all_agree("turned within a ring", true, |seed, system| {
        let system = system.with_ring(seed);
        (system.response(), system.changed(turned(0.3 + 0.7 * seed as f64)).response())
    });
    for seed in 0..12 {
        let system = System::random(seed, true).with_wall(seed);
        let turned = system.changed(turned(0.3 + 0.7 * seed as f64));
        agree(&system.response(), &turned.response()).unwrap_or_else(|off| panic!("{seed}: {off}"));
    }
}

/// One of many, not yet with a ring or walls around it.
fn drawn(seed: u64) -> System {
    let system = System::random(seed, false);
    let mut r = Random::new(seed);
    let system = if r.chance(0.2) { system.with_lines(seed) } else { system };
    if r.chance(0.2) { system.on_a_slope(seed) } else { system }
}

fn drawn_are_certified(seeds: core::ops::Range<u64>, walls_each: u64) {
    let mut struck = 0;
    let all = seeds.end - seeds.start;
    for seed in seeds {
        let system = drawn(seed);
        // Hundreds of bounces take their time.
        let walled = (seed % walls_each == 0).then(|| system.with_wall(seed));
        for system in walled.into_iter().chain([system.with_ring(seed)]) {
            let stop = certified(seed, &system).demands.stop.expect("a stop");
            struck += u64::from(stop.contact_count + stop.impact_count > 0);
        }
    }
    assert!(2 * struck > all, "{struck}");
}

/// Near rest along a stop: a block that stops against a push beyond friction, one whose direction is rounding, steps of no
/// time to tell, a corner of friction, minima that slack hides, an impact that lasts no time.
#[test]
fn walls_that_once_raised_an_alarm_raise_none() {
    for seed in [67, 382, 392, 449, 502, 628, 1262] {
        certified(seed, &drawn(seed).with_wall(seed));
    }
}

#[test]
fn prop_random_systems_are_certified() {
    drawn_are_certified(0..40, 4);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn prop_many_random_systems_are_certified() {
    drawn_are_certified(0..2000, 1);
}
