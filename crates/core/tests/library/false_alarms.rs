//! What an engineer would write is answered, and the answer is certified; so is anything else with all devices.

// The numbers of a run are for people who look for them with --nocapture; helpers of tests may panic as
// tests do; a seed from outside to look for more.
#![allow(clippy::disallowed_macros, clippy::disallowed_methods, clippy::expect_used)]

use std::ops::Range;

use crate::common::random_in_plane::in_plane;
use crate::common::sensible::{lifted, seeds, system};
use slipstick::check::check;
use slipstick::error::SolveError;
use slipstick::input;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::solver::exact;

/// Why a seed's answer does not stand, if it does not.
fn alarm(seed: u64) -> Option<String> {
    let (model, motion) = system(seed).build();
    alarm_of(&model, &motion)
}

/// Why the answer of a model does not stand, if it does not.
fn alarm_of(model: &Model, motion: &GroundMotion) -> Option<String> {
    let response = match exact(model, motion) {
        Ok(response) => response,
        // Surfaces without a stop may run out of travel.
        Err(SolveError::EndOfTravel { .. }) => return None,
        Err(error) => return Some(format!("{error}")),
    };
    let certificate = check(model, motion, &response);
    (!certificate.holds())
        .then(|| format!("{:?}, bound {:.1e}", certificate.defects(), certificate.bound))
}

fn no_alarm(seeds: Range<u64>) {
    none_of(seeds, alarm);
}

/// Fails with all alarms of some seeds.
fn none_of(seeds: Range<u64>, mut alarm: impl FnMut(u64) -> Option<String>) {
    let count = seeds.end - seeds.start;
    let failures: Vec<String> = seeds
        .filter_map(|seed| {
            let failure = format!("{seed}: {}", alarm(seed)?);
            println!("{failure}");
            Some(failure)
        })
        .collect();
    println!("{} of {count} alarmed", failures.len());
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
}

/// A slip that fills one interval has a velocity between its knots, and none at them.
#[test]
fn a_slip_between_two_knots_raises_no_alarm() {
    let surface = |radius: &str, friction: &str| {
        format!("[[slider.surface]]\nradius = \"{radius}\"\nfriction = {friction}\n")
    };
    let slider = surface("0.84 m", "0.074") + &surface("0.91 m", "0.07");
    let text = format!(
        "[block]\nmass = \"100 kg\"\n[slider]\n{slider}[initial]\nsliding_displacement = \"0.12 m\"\n"
    );
    let model = input::parse("m.toml", &text, &[]).expect("a model").model;
    for a in [0.0, 1e-3] {
        let times_s = vec![0.0, 1.0, 2.0];
        let motion = GroundMotion::new(times_s, vec![0.0, a, 0.0], None).expect("a motion");
        let response = exact(&model, &motion).expect("a response");
        assert_eq!(response.demands.slip_count, 1);
        assert!(check(&model, &motion, &response).holds(), "{a} m/s²");
    }
}

/// A jump that asks less after it than before, a last pass that changed a rate by 1e-10, a block held
/// because its contents slide, friction that had faded and came back within a series, bounces 1e-12 s
/// apart, and surfaces whose springs add to the force at rest.
#[test]
fn systems_that_once_raised_an_alarm_raise_none() {
    for seed in [453, 979, 5731, 5945, 7556, 7650, 11095, 18775, 19146, 25664, 28686, 33625] {
        assert_eq!(alarm(seed), None, "{seed}");
    }
}

#[test]
fn prop_sensible_models_raise_no_alarm() {
    no_alarm(0..300);
}

/// The same of three thousand of either kind; `SLIPSTICK_SEEDS=0..20000` takes others.
#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn prop_many_sensible_models_raise_no_alarm() {
    no_alarm(seeds(0..6000));
}

/// Two directions, half of the models structures by their modes: an answer that the check confirms.
fn alarm_in_plane(seed: u64) -> Option<String> {
    let (model, motion) = in_plane(seed);
    alarm_of(&model, &motion)
}

/// What passes rest slower than rounding tells, and turned to a direction on the way; slips that are one step from rest to
/// rest, whose last velocity has no direction; a push that friction exceeds by a part of 4e-4; a last turn of a structure by
/// its modes, and one of a frame with stiff dampers, that took so long that the push changed; a direction between the nodes
/// of a slow slip.
#[test]
fn models_in_two_directions_that_once_raised_an_alarm_raise_none() {
    for seed in [63, 535, 594, 1052, 2099, 5934, 6488, 7504, 8067] {
        assert_eq!(alarm_in_plane(seed), None, "{seed}");
    }
}

#[test]
fn prop_models_in_two_directions_raise_no_alarm() {
    none_of(0..80, alarm_in_plane);
}

/// The same of ten thousand; `SLIPSTICK_SEEDS=0..500` takes others.
#[test]
#[ignore = "an hour: cargo xtask nightly"]
fn prop_many_models_in_two_directions_raise_no_alarm() {
    none_of(seeds(0..10_000), alarm_in_plane);
}

/// Contents and a vertical motion: an answer that the check confirms, and no end in events without end.
fn alarm_lifted(seed: u64) -> Option<String> {
    let (model, motion) = lifted(seed).build();
    alarm_of(&model, &motion)
}

#[test]
fn prop_lifted_contents_raise_no_alarm() {
    none_of(0..300, alarm_lifted);
}

/// Of ten thousand none ends at the limit of events, or in any other error; alarms of the check are counted and printed.
/// `SLIPSTICK_SEEDS=0..500` takes others.
#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn prop_many_lifted_contents_end() {
    let mut alarms = 0;
    none_of(seeds(0..10_000), |seed| {
        let (model, motion) = lifted(seed).build();
        if let Err(error) = exact(&model, &motion)
            && !matches!(error, SolveError::EndOfTravel { .. })
        {
            return Some(format!("{error}"));
        }
        if let Some(alarm) = alarm_of(&model, &motion) {
            println!("{seed}: {alarm}");
            alarms += 1;
        }
        None
    });
    println!("{alarms} alarms");
}
